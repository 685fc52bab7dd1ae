/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The formulas of a user-defined system between breaks, with its switches frozen. */
#include <stdlib.h>
#include <string.h>

#include "core/model/breaks.h"
#include "core/ode/user/formulas.h"
#include "core/ode/user/model.h"

static void close_system(void *data)
{
    gm_system_close(&((struct gm_user_frozen *)data)->system);
}

/* Reads the system again, with the same values. */
static void read_again(struct gm_arena *arena, const struct gm_user_system *system,
                       struct gm_user_frozen *frozen)
{
    double *values = gm_arena_take(arena, system->variable_count, sizeof *values);
    for (size_t i = 0; i < system->variable_count; i++) {
        values[i] = system->variables[i].value;
    }
    gm_arena_keep(arena, frozen, close_system);
    gm_user_system_again(arena, system, values, system->tangents == 0, &frozen->system);
    gm_arena_need(arena, gm_user_model_open_smooth(&frozen->model, &frozen->system));
}

/* Freezes the switches of the rates in all formulas that schemes are made of. */
static void freeze_all(struct gm_arena *arena, struct gm_user_frozen *frozen)
{
    struct gm_user_system *system = &frozen->system;
    struct gm_user_model *model = &frozen->model;
    bool *varying = gm_arena_take(arena, system->variable_count, sizeof *varying);
    memset(varying, true, system->parameters);
    struct gm_system_variable *variables =
        gm_arena_take(arena, system->variable_count + GM_MOST_BREAKS, sizeof *variables);
    memcpy(variables, system->variables, system->variable_count * sizeof *variables);
    for (size_t i = 0; i < GM_MOST_BREAKS; i++) {
        variables[system->variable_count + i] =
            (struct gm_system_variable){.name = "", .start = GM_NO_NODE, .force = GM_NO_NODE};
    }
    system->variables = variables;
    struct gm_freezing freezing = {.system = system,
                                   .list = frozen->list,
                                   .varying = gm_arena_keep(arena,
                                                            gm_formula_dependent(&system->graph, varying,
                                                                                 system->variable_count),
                                                            free),
                                   .node_count = system->graph.count};
    gm_breaks_freeze(arena, &freezing, system->rates, system->n);
    freezing.closed = true;
    for (size_t i = 0; i < model->rate_count; i++) {
        gm_breaks_freeze(arena, &freezing, model->rates[i].nodes, model->components);
        gm_breaks_freeze(arena, &freezing, model->rates[i].slopes, model->rates[i].jacobian.count);
    }
    gm_breaks_freeze(arena, &freezing, system->facets, 2 * system->n + 19);
    gm_breaks_freeze(arena, &freezing, &system->energy, system->kind == GM_CANONICAL);
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_PART || item->word == GM_WORD_LET) {
            gm_breaks_freeze(arena, &freezing, item->nodes, item->count);
        }
    }
    frozen->count = freezing.full ? 0 : freezing.count;
}

void gm_user_breaks_derive(struct gm_arena *arena, struct gm_user_model *model)
{
    struct gm_user_frozen *frozen = gm_arena_take(arena, 1, sizeof *frozen);
    frozen->list = gm_arena_take(arena, GM_MOST_BREAKS, sizeof *frozen->list);
    read_again(arena, model->system, frozen);
    freeze_all(arena, frozen);
    struct gm_user_system *system = &frozen->system;
    const size_t count = frozen->count;
    bool *marked = gm_arena_take(arena, system->variable_count, sizeof *marked);
    memset(marked, true, system->n + 1);
    frozen->surfaces = gm_arena_take(arena, 2 * count + 1, sizeof *frozen->surfaces);
    frozen->events = gm_arena_take(arena, count + 1, sizeof *frozen->events);
    for (size_t i = 0; i < count; i++) {
        const struct gm_break *one = &frozen->list[i];
        struct gm_user_event *event = &frozen->events[i];
        frozen->surfaces[i] = one->surface;
        frozen->surfaces[count + i] = one->whole == GM_NO_NODE ? one->surface : one->whole;
        event->slopes =
            gm_sparse_jacobian(arena, &system->graph, &one->surface, 1, marked, system->variable_count);
        event->slope_nodes = gm_sparse_nodes(arena, NULL, 0, &event->slopes);
    }
    gm_arena_need(arena, !system->graph.failed);
    model->frozen = count > 0 ? frozen : NULL;
}
