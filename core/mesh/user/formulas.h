/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of a mesh equation, which are keys as well: formulas in the field, the nodes and what the file names, in a
   graph of their own. */
#ifndef GM_CORE_MESH_USER_FORMULAS_H
#define GM_CORE_MESH_USER_FORMULAS_H

#include "core/mesh/moving_mesh.h"
#include "core/model/recognition.h"

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

/* Returns true if the text has places, and is not NULL, empty or "density". */
bool gm_mesh_lists_nodes(const char *text);

/* The words for densities, NULL-terminated. */
extern const char *const gm_user_densities[];

enum { GM_DENSITY_INPUTS = 3, GM_BETWEEN_INPUTS = 4, GM_MOST_LISTED = 128 };

/* The formulas of a mesh equation; tapes of lines that are not there have no outputs. */
struct gm_mesh_formulas {
    struct gm_density density;   /* first */
    struct gm_tape squared, rho; /* of s, u, x: P and its derivatives (enum gm_density_value), and rho */
    struct gm_tape map;          /* of a label x and t: the place and its rate */
    struct gm_mesh_cell cell;
    struct gm_tape between; /* of s from 0 to 1, the distance d of two nodes, their velocities v0 and v1 */
    double listed[GM_MOST_LISTED];   /* places of nodes alone */
    size_t listed_count;             /* 0: by the density */
    char refused[GM_FAULT_SENTENCE]; /* why a formula is refused; "": all are good */
};

/* Reads the formulas, until one is refused. False when out of memory; the caller closes them in any case. */
bool gm_mesh_formulas_open(struct gm_mesh_formulas *formulas, const struct gm_mesh_names *names,
                           const struct gm_user_mesh *chosen);
void gm_mesh_formulas_close(void *formulas);

#endif
