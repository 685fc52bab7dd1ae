/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The operators of discrete forms on one mesh, as matrices. */
#ifndef GM_CORE_FORM_SPACE_H
#define GM_CORE_FORM_SPACE_H

#include "core/form/complex.h"
#include "core/form/matrix.h"

/* A form has a number for each vertex, edge or triangle. Primal k-forms live on k-simplices, dual ones on the
   dual cells of (2 - k)-simplices. */
struct gm_form_type {
    int degree; /* 0, 1, 2, or one of these: */
    bool dual;
};
enum {
    GM_FORM_NUMBER = -1,  /* a number */
    GM_FORM_PLACE = -2,   /* a formula of the place: a 0-form, primal or dual as it is needed */
    GM_FORM_COVECTOR = -3 /* form(f, g, h): a 1-form, primal or dual */
};

enum gm_form_matrix {
    GM_MATRIX_D0,      /* d of 0-forms: vertices to edges, head - tail */
    GM_MATRIX_D1,      /* d of 1-forms: edges to triangles */
    GM_MATRIX_DUAL_D0, /* D1': left - right */
    GM_MATRIX_DUAL_D1, /* -D0' */
    GM_MATRIX_STAR0,   /* areas of dual cells */
    GM_MATRIX_STAR1,   /* the diagonal |dual edge| / |edge|, or the mass matrix of Whitney's 1-forms */
    GM_MATRIX_STAR2,   /* 1 / area */
    GM_MATRIX_DUAL_STAR0,
    GM_MATRIX_DUAL_STAR1, /* -1/STAR1 if that is diagonal; else it is solved with */
    GM_MATRIX_DUAL_STAR2,
    GM_MATRIX_LAPLACE, /* of 0-forms, -D0' STAR1 D0 / STAR0: the same for all stars */
    GM_MATRIX_MEAN1, /* made by gm_form_space_need, as are all from here on: vertices to edges: the mean of both ends */
    GM_MATRIX_MEAN2,    /* vertices to triangles */
    GM_MATRIX_ACROSS,   /* triangles to edges: the mean of both sides */
    GM_MATRIX_TRANSFER, /* a 1-form along dual edges */
    GM_MATRIX_JUMP1,    /* half of head - tail */
    GM_MATRIX_JUMP2,    /* triangles to edges: half of right - left. Both are 0 unless products are upwind */
    GM_MATRIX_OUT,      /* edges to edges: what flows out through edges of the boundary */
    GM_MATRIX_HALVES,   /* edges to dual cells: a quarter of edges of the boundary; 0 elsewhere */
    GM_MATRIX_CENTRE_X, /* edges to triangles: Whitney's form at the centre of mass, and below */
    GM_MATRIX_CENTRE_Y,
    GM_MATRIX_CENTRE_Z,
    GM_FORM_MATRICES
};

/* Interior products: the value that a flux carries through an edge. */
enum gm_interior {
    GM_INTERIOR_DUAL,    /* the mean of both sides */
    GM_INTERIOR_WHITNEY, /* the same, of the mean of both triangles' Whitney forms: a constant is not kept */
    GM_INTERIOR_UPWIND,  /* the value at the side where it comes from */
};

struct gm_cholesky;

/* The points of integrals and, for 1-forms, vectors; a number of the form is the sum over its
   points of weight times density, or of the vector times the covector. */
struct gm_form_points {
    size_t count, each; /* all points, and those of a number */
    double *point;      /* [5][count]: x, y, z, and room for s and the time */
    double *weight;     /* [count], or NULL for 1-forms */
    double *vector;     /* [3][count], of 1-forms */
};
struct gm_form_space {
    struct gm_arena *arena;
    struct gm_complex *complex; /* taken */
    struct gm_matrix matrix[GM_FORM_MATRICES];
    struct gm_cholesky *mass;            /* the factor of `inner` if STAR1 is not diagonal; else NULL */
    struct gm_matrix inner;              /* STAR1 among the edges that are not held, and 1 on the others */
    const bool *held;                    /* each edge; NULL: none is held */
    enum gm_interior interior;           /* set by the caller before matrices are made for it */
    double *dual_vertex;                 /* 3 a triangle */
    struct gm_form_points *points[2][3]; /* of dual and primal forms; NULL: not needed yet */
};

/* Factors a symmetric matrix, in a body of the arena, which keeps the factor; NULL if it is not positive definite, or
   when out of memory. */
struct gm_cholesky *gm_matrix_factor(struct gm_arena *arena, const struct gm_matrix *a);

/* The complex outlives the space. False when out of memory, and nothing to close. */
bool gm_form_space_open(struct gm_form_space *space, struct gm_complex *complex);
void gm_form_space_close(void *space); /* for arenas too */

/* Makes a matrix, unless it is there, in a body of an arena that the space does not outlive. */
void gm_form_space_need(struct gm_form_space *space, struct gm_arena *arena, enum gm_form_matrix number);

/* Makes the inverse of STAR1 one among 1-forms that are 0 on these edges, of which the space keeps the list.
   Returns false when out of memory. */
bool gm_form_space_hold(struct gm_form_space *space, const bool *held);

/* The count of numbers of a form. */
size_t gm_form_size(const struct gm_complex *complex, struct gm_form_type type);
/* The Betti numbers: pieces, loops that bound nothing, closed pieces. */
long gm_form_betti(const struct gm_complex *complex, int degree);

/* Called in a body of the arena, which outlives the space's use of them. 0-forms and dual 2-forms take their value in one point, primal 2-forms
   in seven (degree 5), 1-forms in five of each straight piece. */
const struct gm_form_points *gm_form_points_of(struct gm_form_space *space, struct gm_arena *arena,
                                               struct gm_form_type type);

#endif
