/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rates of a system, their Jacobian, and what is known of both. */
#include "core/ode/user/model.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/model/equations.h"
#include "core/ode/kernel/members.h"
#include "core/quantity.h"

bool gm_user_model_is_forced(const struct gm_user_model *model)
{
    bool forced = false;
    for (size_t i = 0; i < model->system->n; i++) {
        forced |= model->system->variables[i].force != GM_NO_NODE;
    }
    return forced;
}

bool gm_user_model_holds(const struct gm_user_model *model, const double *values, enum gm_fact fact)
{
    const struct gm_user_system *system = model->system;
    const struct gm_finding *finding = &model->findings[fact];
    bool same = true;
    for (size_t i = system->parameters; i < system->velocities; i++) {
        same = same && values[i] == system->variables[i].value;
    }
    return finding->asked && finding->holds && (same || finding->how == GM_ZERO_PROVED);
}

/* In the words of struct gm_ode; "": too many or too long to be told apart there. */
static char *names_of(const struct gm_user_system *system)
{
    char *names = NULL;
    size_t size;
    FILE *stream = open_memstream(&names, &size);
    if (!stream) {
        return NULL;
    }
    /* lists are named as such where they have one length, else all by their own names, as far as there is
       room */
    const size_t n = system->n + system->timed;
    size_t lists = 0, scalars = 0, longest = 0, shortest = SIZE_MAX, length = 0;
    bool fit = true;
    for (size_t i = 0; i < n; i++) {
        const char *name = system->variables[i].name;
        const size_t letters = strcspn(name, "[");
        fit = fit && letters < sizeof((struct gm_quantity *)0)->name;
        if (name[letters] == '\0') {
            scalars++;
            continue;
        }
        const char *next = i + 1 < n ? system->variables[i + 1].name : "";
        length++;
        if (strncmp(name, next, letters + 1) != 0) {
            longest = length > longest ? length : longest;
            shortest = length < shortest ? length : shortest;
            length = 0;
            lists++;
        }
    }
    fit = fit && (lists == 0 || longest == shortest) && lists + scalars <= GM_QUANTITIES;
    for (size_t i = 0; i < n && fit; i++) {
        const char *name = system->variables[i].name;
        const size_t letters = strcspn(name, "[");
        const bool goes_on =
            i > 0 && name[letters] && strncmp(name, system->variables[i - 1].name, letters + 1) == 0;
        if (!goes_on) {
            fprintf(stream, "%s%.*s%s", i > 0 ? " " : "", (int)letters, name, name[letters] ? "[]" : "");
        }
    }
    fclose(stream);
    return names;
}

/* The monitor's node and those of its gradient; false: out of memory. */
static bool open_slopes(struct gm_user_model *model, struct gm_user_system *system, bool *marked)
{
    const size_t n = model->components;
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == GM_WORD_MONITOR) {
            model->monitor = system->items[i].nodes[0];
            model->slopes = malloc((system->variable_count + 1) * sizeof *model->slopes);
            memset(marked, false, system->variable_count * sizeof *marked);
            memset(marked, true, n * sizeof *marked);
            return model->slopes &&
                   gm_gradient(&system->graph, model->monitor, marked, system->variable_count, model->slopes);
        }
    }
    return true;
}

/* Room for the rates for all parameters, and for those that lines `compile:` give a value. False: out of memory. */
static bool open_rates(struct gm_user_model *model, struct gm_user_system *system)
{
    const size_t n = model->components;
    model->rates = calloc(system->item_count + 1, sizeof *model->rates);
    for (size_t i = 0; model->rates && i <= system->item_count; i++) {
        const struct gm_system_item *item = i > 0 ? &system->items[i - 1] : NULL;
        if (item && item->word != GM_WORD_COMPILE) {
            continue;
        }
        struct gm_user_rates *rates = &model->rates[model->rate_count++];
        rates->parameter = item ? item->variable : SIZE_MAX;
        rates->value = item ? item->value : 0;
        rates->nodes = malloc((n + 1) * sizeof *rates->nodes);
        if (!rates->nodes) {
            return false;
        }
        memcpy(rates->nodes, system->rates, system->n * sizeof *rates->nodes);
        if (system->timed) {
            rates->nodes[system->n] = gm_formula_constant(&system->graph, 1);
        }
    }
    return model->rates != NULL;
}

/* The graph with the value in the parameter's place. False: out of memory. */
static bool put_value(struct gm_user_system *system, struct gm_user_rates *rates, size_t n)
{
    gm_node_id *replacement = malloc(system->variable_count * sizeof *replacement);
    for (size_t i = 0; replacement && i < system->variable_count; i++) {
        replacement[i] = GM_NO_NODE;
    }
    if (replacement) {
        replacement[rates->parameter] = gm_formula_constant(&system->graph, rates->value);
    }
    const bool good = replacement && gm_formula_substitute(&system->graph, rates->nodes, n, replacement,
                                                           system->variable_count);
    free(replacement);
    return good;
}

bool gm_user_model_open(struct gm_user_model *model, struct gm_user_system *system)
{
    *model = (struct gm_user_model){.system = system, .components = system->n + system->timed};
    const size_t n = model->components;
    if (!gm_facts_find(system, model->findings)) {
        return false;
    }
    model->names = names_of(system);
    bool *marked = calloc(system->variable_count, sizeof *marked);
    if (!open_rates(model, system) || !model->names || !marked) {
        free(marked);
        return false;
    }
    model->has_jacobian = n <= GM_NEWTON_LARGEST;
    bool good = gm_user_constraints_model_open(&model->constraints, system);
    if (system->kind == GM_LAGRANGIAN) {
        gm_user_lagrangian_model_open(&model->lagrangian, system);
    } else {
        memset(marked, true, n);
        for (size_t i = 0; i < model->rate_count && good; i++) {
            struct gm_user_rates *rates = &model->rates[i];
            good = (i == 0 || put_value(system, rates, n)) &&
                   (!model->has_jacobian || gm_sparse_jacobian(&system->graph, rates->nodes, n, marked,
                                                               system->variable_count, &rates->jacobian));
        }
    }
    if (good) {
        good = open_slopes(model, system, marked) && gm_user_bracket_model_open(&model->bracket, system);
    }
    free(marked);
    for (size_t i = 0; i < model->rate_count && good && system->kind != GM_LAGRANGIAN; i++) {
        good = gm_formula_quicken(&system->graph, model->rates[i].nodes, n);
    }
    return good && !system->graph.failed;
}

const struct gm_user_rates *gm_user_model_rates(const struct gm_user_model *model, const double *values)
{
    size_t i = model->rate_count;
    while (i > 1 && values[model->rates[i - 1].parameter] != model->rates[i - 1].value) {
        i--;
    }
    return &model->rates[i > 1 ? i - 1 : 0];
}

void gm_user_model_close(struct gm_user_model *model)
{
    gm_user_lagrangian_model_close(&model->lagrangian);
    gm_user_constraints_model_close(&model->constraints);
    gm_user_bracket_model_close(&model->bracket);
    for (size_t i = 0; i < model->rate_count; i++) {
        free(model->rates[i].nodes);
        free(model->rates[i].jacobian.entries);
    }
    free(model->rates);
    free(model->slopes);
    free(model->names);
    *model = (struct gm_user_model){0};
}

bool gm_user_model_has_action(const struct gm_user_model *model)
{
    const enum gm_system_kind kind = model->system->kind;
    return model->has_jacobian &&
           (kind == GM_LAGRANGIAN || (kind == GM_CANONICAL && model->findings[GM_FACT_NYSTROM].holds));
}

bool gm_user_model_splits(const struct gm_user_model *model, const double *values)
{
    return model->system->kind <= GM_LAGRANGIAN && !gm_user_model_is_forced(model) &&
           model->constraints.count == 0 && gm_user_model_holds(model, values, GM_FACT_SEPARABLE);
}

const char *gm_user_model_refuses_kernels(const struct gm_user_model *model)
{
    return model->system->kind == GM_LAGRANGIAN
               ? "the velocities of a Lagrangian are found by an iteration, which is not compiled"
           : model->constraints.count > 0
               ? "the multipliers of constraints are found by an iteration, which is not compiled"
               : NULL;
}

const char *gm_user_model_lacks(const struct gm_user_model *model)
{
    if (model->constraints.count == 0) {
        return "";
    }
    return model->system->timed               ? "with constraints the time may not occur"
           : !model->has_jacobian             ? "with constraints there may be at most 64 components"
           : !gm_user_model_has_action(model) ? "constraints take L, or H = T(p) + V(q) with a quadratic T"
                                              : "";
}
