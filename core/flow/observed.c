/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/flow/observed.h"

#include "core/form/values.h"

struct gm_flow_forms {
    const struct gm_flow *flow;
    struct gm_form_space space;
    struct gm_form_values values;
    double *slope, *velocity, *circulation, *cold; /* d psi; u; w; a temperature of 0 */
};

struct gm_flow_forms *gm_flow_forms_open(struct gm_arena *arena, const struct gm_form_program *program,
                                         const struct gm_user_system *system, const double *values,
                                         const struct gm_flow *flow)
{
    struct gm_complex *complex = flow->complex;
    struct gm_flow_forms *forms = gm_arena_take(arena, 1, sizeof *forms);
    forms->flow = flow;
    gm_arena_need(arena, gm_form_space_open(&forms->space, complex));
    gm_arena_keep(arena, &forms->space, gm_form_space_close);
    gm_form_values_open(&forms->values, arena, program, &forms->space, system, values);
    forms->slope = gm_arena_take(arena, complex->edges, sizeof(double));
    forms->velocity = gm_arena_take(arena, complex->edges, sizeof(double));
    forms->circulation = gm_arena_take(arena, complex->vertices, sizeof(double));
    forms->cold = gm_arena_take(arena, complex->vertices, sizeof(double));
    return forms;
}

double gm_flow_observed(struct gm_flow_forms *forms, const double *y, double t, size_t root)
{
    const struct gm_flow *flow = forms->flow;
    const struct gm_complex *complex = flow->complex;
    const double *omega = gm_flow_block(flow, y, GM_FLOW_OMEGA);
    gm_matrix_apply(&forms->space.matrix[GM_MATRIX_D0], y, forms->slope);
    gm_matrix_apply(&forms->space.matrix[GM_MATRIX_STAR1], forms->slope, forms->velocity);
    for (size_t e = 0; e < complex->edges; e++) {
        forms->velocity[e] = -forms->velocity[e];
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        forms->circulation[v] = complex->star0[v] * omega[v];
    }
    double *const all[GM_ROOM_FORMS] = {
        [GM_ROOM_PSI] = (double *)(uintptr_t)y,
        [GM_ROOM_W] = forms->circulation,
        [GM_ROOM_U] = forms->velocity,
        [GM_ROOM_THETA] = (double *)(uintptr_t)gm_flow_block(flow, y, GM_FLOW_THETA),
        [GM_ROOM_WARMTH] =
            flow->heat ? (double *)(uintptr_t)gm_flow_block(flow, y, GM_FLOW_TEMPERATURE) : forms->cold};
    gm_form_values_run(&forms->values, t, all);
    return gm_form_values_root(&forms->values, root)[0];
}
