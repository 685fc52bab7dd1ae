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

/* A density as a formula. */
struct gm_user_density {
    struct gm_density density; /* first */
    struct gm_tape tape;       /* of s, u, x: P and its derivatives, in the order of enum gm_density_value */
    struct gm_tape itself;     /* rho */
};
/* The words for densities, NULL-terminated. */
extern const char *const gm_user_densities[];

/* A known mesh as a formula. */
struct gm_user_map {
    struct gm_mesh_map map; /* first */
    struct gm_tape tape;    /* of x and t: the place and its rate */
};
/* Opens the mesh of a text X = F; false as gm_user_density_open. */
bool gm_user_map_open(struct gm_user_map *map, const struct gm_mesh_names *names, const char *text,
                      char *sentence, size_t size);
/* False with a sentence if it moves an end of the mesh at time t, or does not grow with x. */
bool gm_user_map_suits(const struct gm_user_map *map, const struct gm_mesh *mesh, double t, char *sentence,
                       size_t size);

/* The Lagrangian of a cell as a formula. */
struct gm_user_cell {
    struct gm_mesh_cell cell;           /* first */
    struct gm_tape by_first, by_second; /* of d, d_t, m_t, u_x */
};
/* Opens the cells of a text; false as gm_user_density_open. */
bool gm_user_cell_open(struct gm_user_cell *cell, const struct gm_mesh_names *names, const char *text,
                       char *sentence, size_t size);

/* The velocity between two nodes as a formula. */
enum { GM_BETWEEN_INPUTS = 4 }; /* s from 0 to 1, the distance d of the nodes, their velocities v0 and v1 */
bool gm_user_between_open(struct gm_tape *between, const struct gm_mesh_names *names, const char *text,
                          char *sentence, size_t size);

/* Places of nodes, formulas of parameters separated by commas: writes at most `most` of them, and their number. */
bool gm_user_places_read(const struct gm_mesh_names *names, const char *text, double *places, size_t most,
                         size_t *count, char *sentence, size_t size);

/* Opens the density of a word or a formula; false with a sentence, which is empty when out of memory. The caller closes both tapes
   in both cases. */
bool gm_user_density_open(struct gm_user_density *density, const struct gm_mesh_names *names,
                          const char *text, char *sentence, size_t size);

#endif
