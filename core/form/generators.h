/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of triangles by a word and its numbers: rectangle flat-torus disc annulus sphere torus strip. */
#ifndef GM_CORE_FORM_GENERATORS_H
#define GM_CORE_FORM_GENERATORS_H

#include "core/expression/reader.h"
#include "core/form/gmsh.h"

/* An acute triangulation of a rectangle, or of a torus. The vertices on the walls have exactly the
   coordinates 0, width and height, whatever the numbers of edges and strips. */
struct gm_rectangle {
    double width, height;
    long edges;      /* N: on each of the two walls that the strips run along */
    long strips;     /* M, even */
    bool transposed; /* strips run along y (N edges on the walls x = 0 and x = width) instead of along x */
    bool torus;      /* opposite sides are one */
    /* Every vertex is moved at random by at most this part of its shortest edge, below 1/2. */
    double irregular;
    const double *fixed; /* [fixed_count][2], points that do not move (corners never do) */
    size_t fixed_count;
    enum gm_star star; /* GM_STAR_AUTO: circumcentric, which the pattern allows */
};

/* Returns true if the pattern is acute: the strips' height h and base a satisfy a/2 < h < a. */
bool gm_rectangle_is_acute(const struct gm_rectangle *rectangle);

/* The even number of strips whose triangles are best for this number of edges. */
long gm_rectangle_strips(double width, double height, long edges, bool transposed);
/* The number of edges, at least 4, that is best for the rectangle's number of strips. */
long gm_rectangle_edges(const struct gm_rectangle *rectangle);

/* NULL with a fault when it cannot be made. */
struct gm_complex *gm_rectangle_open(const struct gm_rectangle *rectangle,
                                     struct gm_triangulation_fault *fault);

enum { GM_GENERATOR_NUMBERS = 5 }; /* the most */

/* rectangle W H N [M [irregular]], flat-torus the same, disc R n, annulus R1 R2 N [m], sphere R level, torus R r N [M],
   strip L n. A
   generator checks its numbers: false with a fault at that place of a text. */
bool gm_generator_check(const char *word, const double *numbers, size_t count, size_t place,
                        struct gm_fault *fault);

/* The mesh of a word and numbers that were checked; the parts of its boundary are groups: left right bottom top, rim,
   inner outer. False with a fault of the star, or when out of memory. */
bool gm_generator_open(const char *word, const double *numbers, size_t count, enum gm_star star,
                       struct gm_triangulation *mesh, struct gm_triangulation_fault *fault);

#endif
