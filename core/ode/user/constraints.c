/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Constraints as one tape: themselves, their slopes, and what these change by. */
#include "core/ode/user/constraints.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The nodes of a sparse matrix. */
static gm_node_id *nodes_of(const struct gm_sparse *sparse)
{
    gm_node_id *nodes = malloc((sparse->count + 1) * sizeof *nodes);
    for (size_t i = 0; nodes && i < sparse->count; i++) {
        nodes[i] = sparse->entries[i].node;
    }
    return nodes;
}

bool gm_user_constraints_model_open(struct gm_user_constraints_model *model, struct gm_user_system *system)
{
    *model = (struct gm_user_constraints_model){.graph = &system->graph, .half = system->n / 2};
    model->nodes = malloc((system->item_count + 1) * sizeof *model->nodes);
    for (size_t i = 0; model->nodes && i < system->item_count; i++) {
        if (system->items[i].word == GM_WORD_CONSTRAINT) {
            model->nodes[model->count++] = system->items[i].nodes[0];
        }
    }
    if (model->nodes && model->count == 0) {
        return true;
    }
    bool *coordinates = calloc(system->variable_count, sizeof *coordinates);
    bool good = model->nodes && coordinates;
    if (good) {
        memset(coordinates, true, model->half * sizeof *coordinates);
        good = gm_sparse_jacobian(&system->graph, model->nodes, model->count, coordinates,
                                  system->variable_count, &model->slopes);
    }
    gm_node_id *slopes = good ? nodes_of(&model->slopes) : NULL;
    good = slopes && gm_sparse_jacobian(&system->graph, slopes, model->slopes.count, coordinates,
                                        system->variable_count, &model->second);
    free(slopes);
    free(coordinates);
    return good;
}

void gm_user_constraints_model_close(struct gm_user_constraints_model *model)
{
    free(model->nodes);
    free(model->slopes.entries);
    free(model->second.entries);
    *model = (struct gm_user_constraints_model){0};
}

bool gm_user_constraints_open(struct gm_user_constraints *constraints,
                              const struct gm_user_constraints_model *model, const double *values)
{
    const size_t count = model->count + model->slopes.count + model->second.count;
    *constraints = (struct gm_user_constraints){.model = model};
    gm_node_id *nodes = malloc((count + 1) * sizeof *nodes);
    if (nodes) {
        gm_node_id *next = nodes;
        memcpy(next, model->nodes, model->count * sizeof *nodes);
        next += model->count;
        for (size_t i = 0; i < model->slopes.count; i++) {
            *next++ = model->slopes.entries[i].node;
        }
        for (size_t i = 0; i < model->second.count; i++) {
            *next++ = model->second.entries[i].node;
        }
    }
    const bool good =
        nodes && gm_tape_open(&constraints->tape, model->graph, nodes, count, model->half, values);
    free(nodes);
    return good;
}

void gm_user_constraints_close(struct gm_user_constraints *constraints)
{
    gm_tape_close(&constraints->tape);
}

void gm_user_constraints_values(const struct gm_user_constraints *constraints, const double *q,
                                const double *multipliers, double *g, double *slopes, double *curvature)
{
    enum { FEW = 2048 }; /* of more constraints they are allocated */
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
