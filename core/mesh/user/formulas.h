/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of a mesh equation, which are keys as well: formulas in the field, the nodes and what the file names, in a
   graph of their own. */
#ifndef GM_CORE_MESH_USER_FORMULAS_H
#define GM_CORE_MESH_USER_FORMULAS_H

#include "core/mesh/moving_mesh.h"
#include "core/model/potential.h"
#include "core/tape.h"

enum { GM_MOST_MESH_INPUTS = 4 };

/* The names that formulas of a line may hold besides parameters and lets. */
struct gm_mesh_names {
    enum gm_system_word word; /* the line */
    const struct gm_user_wave *wave;
    const double *values; /* of the system's variables: parameters */
    /* The inputs, in the order of the tape, and words for them that hide names of the file. The number of a variable of
       the system; from its variable_count on a new one. */
    size_t inputs[GM_MOST_MESH_INPUTS];
    size_t input_count;
    const char *words[GM_MOST_MESH_INPUTS];
    bool weighs; /* V_u, alpha, steepest and bend are names too, with these values */
    double alpha, steepest, bend;
};

/* Reads a formula into a graph, with input k as variable k. False with a sentence that begins with the line's word. */
bool gm_mesh_formula_read(const struct gm_mesh_names *names, const char *text, struct gm_formula *graph,
                          gm_node_id *node, char *sentence, size_t size);
/* False with a sentence if the formula has a corner in one of the first `smooth` inputs. */
bool gm_mesh_formula_is_smooth(const struct gm_mesh_names *names, const char *text, struct gm_formula *graph,
                               gm_node_id node, size_t smooth, char *sentence, size_t size);

/* A density as a formula. */
struct gm_user_density {
    struct gm_density density; /* first */
    struct gm_tape tape;       /* of s, u, x: P and its derivatives, in the order of enum gm_density_value */
    struct gm_tape itself;     /* rho */
};
/* The words for densities, NULL-terminated, and the formula of a word or of a text. */
extern const char *const gm_user_densities[];
const char *gm_user_density_formula(const char *text);

/* A known mesh as a formula. */
struct gm_user_map {
    struct gm_mesh_map map; /* first */
    struct gm_tape tape;    /* of x and t: the place and its rate */
};
/* Opens the mesh of a text X = F; false as gm_user_density_open. */
bool gm_user_map_open(struct gm_user_map *map, struct gm_mesh_names *names, const char *text, char *sentence,
                      size_t size);
/* False with a sentence if it moves an end of the mesh at time t, or does not grow with x. */
bool gm_user_map_suits(const struct gm_user_map *map, const struct gm_mesh *mesh, double t, char *sentence,
                       size_t size);

/* Opens the density of a text; false with a sentence, which is empty when out of memory. To be closed in both cases. */
bool gm_user_density_open(struct gm_user_density *density, struct gm_mesh_names *names, const char *text,
                          char *sentence, size_t size);
void gm_user_density_close(struct gm_user_density *density);

#endif
