/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FORM_GMSH_H
#define GM_CORE_FORM_GMSH_H

#include "core/arena.h"
#include "core/form/complex.h"

/* A mesh with names on its boundary. */
struct gm_triangulation {
    struct gm_arena *arena; /* holds all but the complex */
    struct gm_complex *complex;
    long *tags;                 /* tags of the vertices, increasing */
    int *member_start, *member; /* the groups of an edge e: member_start[e] .. member_start[e + 1] - 1 */
    size_t members;             /* of all edges */
    size_t groups;              /* physical groups of curves */
    struct gm_triangulation_group {
        long tag;
        char name[64]; /* "" if it is unnamed */
    } * group;
};
struct gm_triangulation_member {
    int edge, tag; /* 0: none */
};

/* Reads a Gmsh file, version 2.2 or 4.1, ASCII or binary: `size` bytes. Only triangles of one plane, and
   the lines that carry physical groups, are read, elements of the second order by their corners. Repeated
   triangles are read once; points and unused nodes are dropped. Returns false with a fault, and nothing to
   close, if the text is not a valid mesh. */
bool gm_triangulation_read(const char *text, size_t size, enum gm_star star, struct gm_triangulation *mesh,
                           struct gm_triangulation_fault *fault);
/* The same with three coordinates of the nodes, on a surface of any number of pieces. */
bool gm_triangulation_read_in_space(const char *text, size_t size, enum gm_star star,
                                    struct gm_triangulation *mesh, struct gm_triangulation_fault *fault);
/* Returns why a mesh was refused; `name` is "the mesh" or the file's. Returns the sentence, or another one. */
enum { GM_TRIANGULATION_SENTENCE = 512 };
const char *gm_triangulation_explain(const char *name, const struct gm_triangulation_fault *fault,
                                     char sentence[GM_TRIANGULATION_SENTENCE]);
/* Cuts every triangle into four by the middles of its sides; vertices keep their numbers and groups their
   edges. Returns false with a fault, and the mesh unchanged, when out of memory or if the star is no
   longer positive. */
bool gm_triangulation_halve(struct gm_triangulation *mesh, enum gm_star star,
                            struct gm_triangulation_fault *fault);
void gm_triangulation_close(void *mesh); /* for arenas too */

/* The physical tag of a group of lines, by its name or its tag; 0 if it is missing. */
long gm_triangulation_group(const struct gm_triangulation *mesh, const char *name);

/* The first group that an edge was put into; 0: none. */
int gm_triangulation_first(const struct gm_triangulation *mesh, size_t edge);
/* Returns true if an edge is in the group of a tag, which is not 0. */
bool gm_triangulation_has(const struct gm_triangulation *mesh, size_t edge, long tag);

/* Puts edges into groups, while the mesh is made in a body of its arena. */
void gm_triangulation_join(struct gm_triangulation *mesh, const struct gm_triangulation_member *members,
                           size_t count);

/* The names of the groups, "door, window", as many as fit; "none". Returns names. */
const char *gm_triangulation_group_names(const struct gm_triangulation *mesh, char *names, size_t size);

#endif
