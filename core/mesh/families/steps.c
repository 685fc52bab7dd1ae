/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The schemes on meshes: what moves the nodes, and coefficients. core/mesh/equations.c has the equations of all. */
#include "core/mesh/families/families.h"
#include "core/mesh_scheme_texts.h"

#define ROW(name, stages_of, ...)                                                                            \
    {                                                                                                        \
        GM_TEXTS_##name, .family = &gm_family_steps, .coefficients = &(const struct gm_mesh_row)             \
        {                                                                                                    \
            .tableau = &gm_tableau_##stages_of, __VA_ARGS__                                                  \
        }                                                                                                    \
    }
#define UNIFORM(stages_of) ROW(uniform_##stages_of, stages_of, .kind = GM_MESH_UNIFORM)
#define GIVEN(stages_of) ROW(given_##stages_of, stages_of, .kind = GM_MESH_GIVEN)
#define FREE(stages_of) ROW(free_##stages_of, stages_of, .kind = GM_MESH_FREE)
#define CONTROL(stages_of) ROW(control_##stages_of, stages_of, .kind = GM_MESH_MOVING)
#define MULTIPLIED(name, stages_of, ...)                                                                     \
    ROW(multiplier_##name, stages_of, .kind = GM_MESH_MOVING, .multiplied = true, __VA_ARGS__)

/* clang-format off */
static const struct gm_scheme schemes[] = {
    UNIFORM(gauss2), UNIFORM(gauss4), UNIFORM(lobatto2), UNIFORM(lobatto4),
    GIVEN(gauss2), GIVEN(gauss4), GIVEN(lobatto2), GIVEN(lobatto4),
    FREE(gauss2), FREE(gauss4),
    CONTROL(gauss2), CONTROL(gauss4), CONTROL(lobatto2), CONTROL(lobatto4), CONTROL(radau3), CONTROL(radau5),
    MULTIPLIED(lobatto2, lobatto2,), MULTIPLIED(lobatto4, lobatto4,),
    MULTIPLIED(trapezoidal, lobatto2, .one_velocity = true),
};
/* clang-format on */

const struct gm_family gm_family_steps = {.title = "moving meshes", GM_MESH_FAMILY};
