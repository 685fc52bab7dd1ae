/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Constraints as one tape: their values, slopes, and second derivatives. */
#include "core/ode/user/constraints.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void gm_user_constraints_model_open(struct gm_arena *arena, struct gm_user_constraints_model *model,
                                    struct gm_user_system *system)
{
    const size_t variables = system->variable_count;
    gm_node_id *nodes = gm_arena_take(arena, system->item_count + 1, sizeof *nodes);
    bool *coordinates = gm_arena_take(arena, variables, sizeof *coordinates);
    *model = (struct gm_user_constraints_model){.graph = &system->graph, .half = system->n / 2};
    memset(coordinates, true, model->half * sizeof *coordinates);
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == GM_WORD_CONSTRAINT) {
            nodes[model->count++] = system->items[i].nodes[0];
        }
    }
    gm_sparse_keep(
        arena, &model->slopes,
        gm_sparse_jacobian(&system->graph, nodes, model->count, coordinates, variables, &model->slopes));
    nodes = gm_sparse_nodes(arena, nodes, model->count, &model->slopes);
    gm_sparse_keep(arena, &model->second,
                   gm_sparse_jacobian(&system->graph, nodes + model->count, model->slopes.count, coordinates,
                                      variables, &model->second));
    model->nodes = gm_sparse_nodes(arena, nodes, model->count + model->slopes.count, &model->second);
}

void gm_user_constraints_open(struct gm_arena *arena, struct gm_user_constraints *constraints,
                              const struct gm_user_constraints_model *model, const double *values)
{
    const size_t count = model->count + model->slopes.count + model->second.count;
    *constraints = (struct gm_user_constraints){.model = model};
    gm_tape_keep(arena, &constraints->tape,
                 gm_tape_open(&constraints->tape, model->graph, model->nodes, count, model->half, values));
}

void gm_user_constraints_values(const struct gm_user_constraints *constraints, const double *q,
                                const double *multipliers, double *g, double *slopes, double *curvature)
{
    enum { FEW = 2048 }; /* more values are allocated */
    const struct gm_user_constraints_model *model = constraints->model;
    const size_t half = model->half, count = constraints->tape.outputs;
    double few[FEW], *values = count <= FEW ? few : malloc(count * sizeof *values);
    memset(slopes, 0, model->count * half * sizeof *slopes);
    memset(curvature, 0, half * half * sizeof *curvature);
    if (!values) {
        for (size_t k = 0; k < model->count; k++) {
            g[k] = NAN;
        }
        return;
    }
    gm_tape_values(&constraints->tape, q, values, 1);
    memcpy(g, values, model->count * sizeof *g);
    const double *next = values + model->count;
    for (size_t i = 0; i < model->slopes.count; i++) {
        slopes[model->slopes.entries[i].row * half + model->slopes.entries[i].column] = *next++;
    }
    for (size_t i = 0; i < model->second.count; i++) {
        const struct gm_sparse_entry *slope = &model->slopes.entries[model->second.entries[i].row];
        curvature[slope->column * half + model->second.entries[i].column] +=
            multipliers[slope->row] * *next++;
    }
    if (values != few) {
        free(values);
    }
}
