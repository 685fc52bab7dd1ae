/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of a mesh equation, which are keys as well: formulas in the field, the nodes and what the file names, in a
   graph of their own. */
#ifndef GM_CORE_MESH_USER_FORMULAS_H
#define GM_CORE_MESH_USER_FORMULAS_H

#include "core/mesh/moving_mesh.h"
#include "core/model/recognition.h"
#include "core/tape.h"

/* Meanings of names in formulas: the system, values of its variables, of which the parameters are used, and of alpha,
   steepest and bend. */
struct gm_mesh_names {
    const struct gm_user_wave *wave;
    const double *values;
    double alpha, steepest, bend;
};

/* The values of a mesh's keys. */
struct gm_user_mesh {
    double first, length; /* first <= x <= first + length */
    long points;          /* nodes between the ends */
    double alpha;         /* NaN: the file's, or else one that the start allows for */
    const char *density;  /* a word of gm_user_densities, or a formula */
    const char *map;      /* X = F, of a known mesh; NULL: nodes are at their labels */
    const char *cell;     /* the Lagrangian of a cell; NULL or "0": none */
    const char
        *nodes; /* of nodes alone: their places at the start, instead of `points`; NULL or "density": by it */
    const char *between; /* of nodes alone: the velocity between them */
    double relax, until;
};

/* The words for densities, NULL-terminated. */
extern const char *const gm_user_densities[];

enum gm_mesh_tape {
    GM_TAPE_P,         /* of s, u, x: P and its derivatives, in the order of enum gm_density_value */
    GM_TAPE_RHO,       /* of s, u, x */
    GM_TAPE_PLACES,    /* of x and t: the place and its rate */
    GM_TAPE_CELL,      /* of d, d_t, m_t, u_x: the Lagrangian and its derivatives */
    GM_TAPE_BENT_CELL, /* the second ones */
    GM_TAPE_BETWEEN,   /* of s from 0 to 1, the distance d of two nodes, their velocities v0 and v1 */
    GM_TAPE_NODE,      /* scratch */
    GM_MESH_TAPES
};
enum { GM_BETWEEN_INPUTS = 4, GM_MOST_LISTED = 128 };

/* The formulas of a mesh equation. */
struct gm_mesh_formulas {
    struct gm_density density; /* first */
    struct gm_mesh_map map;    /* without a function: nodes are at their labels */
    struct gm_mesh_cell cell;  /* without functions: cells have no Lagrangian */
    struct gm_tape tapes[GM_MESH_TAPES];
    double listed[GM_MOST_LISTED];   /* places of nodes alone */
    size_t listed_count;             /* 0: by the density */
    char refused[GM_FAULT_SENTENCE]; /* why a formula is refused; "": all are good */
};

/* Reads the formulas, until one is refused. False when out of memory; the caller closes them in any case. */
bool gm_mesh_formulas_open(struct gm_mesh_formulas *formulas, const struct gm_mesh_names *names,
                           const struct gm_user_mesh *chosen);
void gm_mesh_formulas_close(void *formulas);

/* False with a sentence if the mesh's map moves an end at time t, or does not grow with x. */
bool gm_mesh_map_suits(const struct gm_mesh *mesh, double t, char *sentence, size_t size);

#endif
