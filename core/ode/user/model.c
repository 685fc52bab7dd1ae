/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rates of a system, their Jacobian, and the facts about both. */
#include "core/ode/user/model.h"

#include <stdlib.h>
#include <string.h>

#include "core/model/breaks.h"
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

/* Returns the names in the format of struct gm_ode; "": too many or too long to be distinguished there. */
static const char *names_of(struct gm_arena *arena, const struct gm_user_system *system)
{
    /* lists have one name each if their lengths agree, else every component has its own, if there is room */
    const size_t n = system->n + system->timed;
    enum { MOST_NAMES = 16 };
    size_t lists = 0, scalars = 0, longest = 0, shortest = SIZE_MAX, length = 0;
    const char *names = "";
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
    fit = fit && (lists == 0 || longest == shortest) && lists + scalars <= MOST_NAMES;
    for (size_t i = 0; i < n && fit; i++) {
        const char *name = system->variables[i].name;
        const size_t letters = strcspn(name, "[");
        const bool goes_on =
            i > 0 && name[letters] && strncmp(name, system->variables[i - 1].name, letters + 1) == 0;
        if (!goes_on) {
            names = gm_arena_print(arena, "%s%s%.*s%s", names, i > 0 ? " " : "", (int)letters, name,
                                   name[letters] ? "[]" : "");
        }
    }
    return names;
}

struct opening {
    struct gm_user_model *model;
    struct gm_user_system *system;
    bool *marked; /* the components */
    bool whole;   /* with the formulas whose switches are frozen */
};

/* The monitor's node and those of its gradient. */
static void open_slopes(struct gm_arena *arena, const struct opening *opening)
{
    struct gm_user_model *model = opening->model;
    struct gm_user_system *system = opening->system;
    for (size_t i = 0; i < system->item_count && !model->slopes; i++) {
        if (system->items[i].word == GM_WORD_MONITOR) {
            model->monitor = system->items[i].nodes[0];
            model->slopes = gm_arena_take(arena, system->variable_count + 1, sizeof *model->slopes);
            gm_arena_need(arena, gm_gradient(&system->graph, model->monitor, opening->marked,
                                             system->variable_count, model->slopes));
        }
    }
}

/* The rates for all parameters, or for the value that a line `compile:` gives to one, and their Jacobian. */
static void open_rates(struct gm_arena *arena, const struct opening *opening,
                       const struct gm_system_item *compiled)
{
    struct gm_user_model *model = opening->model;
    struct gm_user_system *system = opening->system;
    const size_t n = model->components, variables = system->variable_count;
    struct gm_user_rates *rates = &model->rates[model->rate_count++];
    rates->parameter = compiled ? compiled->variable : SIZE_MAX;
    rates->value = compiled ? compiled->value : 0;
    rates->nodes = gm_arena_take(arena, n + 1, sizeof *rates->nodes);
    memcpy(rates->nodes, system->rates, system->n * sizeof *rates->nodes);
    if (system->timed) {
        rates->nodes[system->n] = gm_formula_constant(&system->graph, 1);
    }
    if (system->kind == GM_LAGRANGIAN) {
        return;
    }
    if (compiled) {
        gm_node_id *replacement = gm_arena_take(arena, variables, sizeof *replacement);
        for (size_t i = 0; i < variables; i++) {
            replacement[i] =
                i == rates->parameter ? gm_formula_constant(&system->graph, rates->value) : GM_NO_NODE;
        }
        gm_arena_need(arena, gm_formula_substitute(&system->graph, rates->nodes, n, replacement, variables));
    }
    if (model->has_jacobian) {
        rates->jacobian =
            gm_sparse_jacobian(arena, &system->graph, rates->nodes, n, opening->marked, variables);
        rates->slopes = gm_sparse_nodes(arena, NULL, 0, &rates->jacobian);
    }
}

/* Derives functions of the first coordinates, whose nodes these are. */
static void open_functions(struct gm_arena *arena, struct gm_user_system *system,
                           struct gm_user_functions *functions, gm_node_id *nodes)
{
    const size_t variables = system->variable_count, count = functions->count;
    bool *coordinates = gm_arena_take(arena, variables, sizeof *coordinates);
    memset(coordinates, true, functions->coordinates * sizeof *coordinates);
    struct gm_sparse *slopes = &functions->slopes, *second = &functions->second;
    *slopes = gm_sparse_jacobian(arena, &system->graph, nodes, count, coordinates, variables);
    nodes = gm_sparse_nodes(arena, nodes, count, slopes);
    *second = gm_sparse_jacobian(arena, &system->graph, nodes + count, slopes->count, coordinates, variables);
    functions->nodes = gm_sparse_nodes(arena, nodes, count + slopes->count, second);
}

static void open_constraints(struct gm_arena *arena, const struct opening *opening)
{
    struct gm_user_system *system = opening->system;
    struct gm_user_functions *constraints = &opening->model->constraints;
    gm_node_id *nodes = gm_arena_take(arena, system->item_count + 1, sizeof *nodes);
    constraints->coordinates = system->n / 2;
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == GM_WORD_CONSTRAINT) {
            nodes[constraints->count++] = system->items[i].nodes[0];
        }
    }
    open_functions(arena, system, constraints, nodes);
}

static void open_one_form(struct gm_arena *arena, const struct opening *opening)
{
    struct gm_user_system *system = opening->system;
    struct gm_user_functions *one_form = &opening->model->one_form;
    const size_t n = system->n;
    if (system->theta && !system->timed && opening->model->has_jacobian) {
        gm_node_id *nodes = gm_arena_take(arena, n + 1, sizeof *nodes);
        memcpy(nodes, system->theta, n * sizeof *nodes);
        nodes[n] = system->energy;
        *one_form = (struct gm_user_functions){.coordinates = n, .count = n + 1};
        open_functions(arena, system, one_form, nodes);
    }
}

/* Returns true if a function with these slopes changes only by jumps, its own ones or those of components without a
   rate at events. */
static bool only_jumps(const struct gm_user_system *system, const struct gm_sparse *slopes)
{
    bool jumps = true;
    for (size_t i = 0; i < slopes->count; i++) {
        const size_t c = slopes->entries[i].column;
        jumps &=
            c < system->n && system->kind == GM_RATES && gm_is_constant(&system->graph, system->rates[c], 0);
    }
    return jumps;
}

static void open_event(struct gm_arena *arena, const struct opening *opening,
                       const struct gm_system_item *item, struct gm_user_event *event)
{
    struct gm_user_system *system = opening->system;
    const size_t n = system->n, first = item->ends ? 1 : 1 + n;
    bool *marked = gm_arena_take(arena, system->variable_count, sizeof *marked);
    gm_node_id *nodes = gm_arena_take(arena, n + 1, sizeof *nodes);
    memset(marked, true, (n + 1) * sizeof *marked);
    event->item = item;
    const struct gm_sparse own =
        gm_sparse_jacobian(arena, &system->graph, item->nodes, 1, marked, system->variable_count);
    event->form = only_jumps(system, &own) ? GM_AT_JUMP : GM_AT_ZERO;
    event->conditions = item->count - first;
    event->components = gm_arena_take(arena, n + 1, sizeof *event->components);
    event->switches =
        gm_formula_kink(&system->graph, item->nodes[0], marked, system->variable_count) != GM_NO_NODE;
    nodes[0] = item->nodes[0];
    for (size_t c = 0; c < n && !item->ends; c++) {
        const struct gm_node *node = &system->graph.nodes[item->nodes[1 + c]];
        if (node->operation != GM_VARIABLE || node->a != c) {
            event->components[event->changed++] = c;
            nodes[event->changed] = item->nodes[1 + c];
        }
    }
    event->nodes = gm_arena_take(arena, event->conditions + event->changed + 1, sizeof *event->nodes);
    memcpy(event->nodes, item->nodes + first, event->conditions * sizeof *nodes);
    memcpy(event->nodes + event->conditions, nodes + 1, event->changed * sizeof *nodes);
    event->slopes =
        gm_sparse_jacobian(arena, &system->graph, nodes, 1 + event->changed, marked, system->variable_count);
    event->slope_nodes = gm_sparse_nodes(arena, NULL, 0, &event->slopes);
}

static void open_events(struct gm_arena *arena, const struct opening *opening)
{
    struct gm_user_model *model = opening->model;
    struct gm_user_system *system = opening->system;
    model->events = gm_arena_take(arena, system->item_count + 1, sizeof *model->events);
    model->surfaces = gm_arena_take(arena, system->item_count + 1, sizeof *model->surfaces);
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_EVENT || item->word == GM_WORD_STOP) {
            open_event(arena, opening, item, &model->events[model->event_count]);
            model->surfaces[model->event_count++] = item->nodes[0];
        }
    }
}

static bool open_all(struct gm_user_model *model, struct gm_user_system *system, bool whole);

/* ---- frozen switches ---- */

enum { MOST_SWITCHES = 2 * GM_MOST_BREAKS };

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
    gm_arena_need(arena, open_all(&frozen->model, &frozen->system, false));
}

/* Freezes the switches of the rates in all formulas that schemes are made of, if breaks are located, and those of
   events. */
static void freeze_all(struct gm_arena *arena, struct gm_user_frozen *frozen, bool locates)
{
    struct gm_user_system *system = &frozen->system;
    struct gm_user_model *model = &frozen->model;
    bool *varying = gm_arena_take(arena, system->variable_count, sizeof *varying);
    memset(varying, true, system->parameters);
    struct gm_system_variable *variables =
        gm_arena_take(arena, system->variable_count + MOST_SWITCHES, sizeof *variables);
    memcpy(variables, system->variables, system->variable_count * sizeof *variables);
    for (size_t i = 0; i < MOST_SWITCHES; i++) {
        variables[system->variable_count + i] =
            (struct gm_system_variable){.name = "", .start = GM_NO_NODE, .force = GM_NO_NODE};
    }
    system->variables = variables;
    struct gm_freezing freezing = {
        .system = system,
        .list = frozen->list,
        .most = GM_MOST_BREAKS,
        .varying =
            gm_arena_keep(arena, gm_formula_dependent(&system->graph, varying, system->variable_count), free),
        .node_count = system->graph.count};
    gm_breaks_freeze(arena, &freezing, system->rates, locates ? system->n : 0);
    frozen->breaks = freezing.full ? 0 : freezing.count;
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
    freezing.closed = freezing.full = false;
    freezing.most = MOST_SWITCHES;
    gm_breaks_freeze(arena, &freezing, model->surfaces, model->event_count);
    freezing.closed = true;
    for (size_t i = 0; i < model->event_count; i++) {
        struct gm_user_event *event = &model->events[i];
        size_t own = 0; /* the slopes of g come first */
        while (own < event->slopes.count && event->slopes.entries[own].row == 0) {
            own++;
        }
        gm_breaks_freeze(arena, &freezing, event->slope_nodes, own);
    }
    frozen->count = freezing.count;
}

/* s g, or (g - k)(k + 1 - g). */
static gm_node_id inside(struct gm_formula *graph, const struct gm_break *one)
{
    const gm_node_id mode = gm_formula_variable(graph, one->variable), g = one->surface;
    if (!one->whole) {
        return gm_formula_apply(graph, GM_OPERATION_MULTIPLY, mode, g);
    }
    const gm_node_id next = gm_formula_apply(graph, GM_OPERATION_ADD, mode, gm_formula_constant(graph, 1));
    return gm_formula_apply(graph, GM_OPERATION_MULTIPLY,
                            gm_formula_apply(graph, GM_OPERATION_SUBTRACT, g, mode),
                            gm_formula_apply(graph, GM_OPERATION_SUBTRACT, next, g));
}

static void open_frozen(struct gm_arena *arena, struct gm_user_model *model)
{
    struct gm_user_frozen *frozen = gm_arena_take(arena, 1, sizeof *frozen);
    frozen->list = gm_arena_take(arena, MOST_SWITCHES, sizeof *frozen->list);
    read_again(arena, model->system, frozen);
    freeze_all(arena, frozen, gm_system_locates_breaks(model->system));
    struct gm_user_system *system = &frozen->system;
    const size_t count = frozen->count, written = model->event_count;
    bool *marked = gm_arena_take(arena, system->variable_count, sizeof *marked);
    memset(marked, true, system->n + 1);
    frozen->surfaces = gm_arena_take(arena, written + count, sizeof *frozen->surfaces);
    memcpy(frozen->surfaces, frozen->model.surfaces, written * sizeof *frozen->surfaces);
    frozen->inner = gm_arena_take(arena, count + 1, sizeof *frozen->inner);
    frozen->inside = gm_arena_take(arena, count + 1, sizeof *frozen->inside);
    frozen->events = gm_arena_take(arena, count + 1, sizeof *frozen->events);
    for (size_t i = 0; i < count; i++) {
        struct gm_break *one = &frozen->list[i];
        struct gm_user_event *event = &frozen->events[i];
        const struct gm_naming naming = gm_system_naming(system);
        char *text = gm_formula_text(&system->graph, one->surface, &naming);
        one->text = gm_arena_print(arena, "%.120s", text ? text : "a long term");
        system->variables[one->variable].name =
            gm_arena_print(arena, "%s(%s)", one->whole ? "floor" : "sign", one->text);
        free(text);
        frozen->surfaces[written + i] = one->surface;
        bool *mode = gm_arena_take(arena, system->variable_count, sizeof *mode);
        mode[one->variable] = true;
        for (size_t k = 0; k < written; k++) {
            frozen->inner[i] |=
                gm_formula_holds(&system->graph, frozen->surfaces[k], mode, system->variable_count);
        }
        frozen->inside[i] = inside(&system->graph, one);
        event->slopes =
            gm_sparse_jacobian(arena, &system->graph, &one->surface, 1, marked, system->variable_count);
        event->slope_nodes = gm_sparse_nodes(arena, NULL, 0, &event->slopes);
    }
    gm_arena_need(arena, !system->graph.failed);
    model->frozen = count > 0 ? frozen : NULL;
}

static void open_model(struct gm_arena *arena, void *data)
{
    struct opening *opening = data;
    struct gm_user_model *model = opening->model;
    struct gm_user_system *system = opening->system;
    const size_t n = model->components;
    gm_arena_need(arena, gm_facts_find(system, model->findings));
    model->names = names_of(arena, system);
    model->rates = gm_arena_take(arena, system->item_count + 1, sizeof *model->rates);
    model->has_jacobian = n <= GM_NEWTON_LARGEST;
    opening->marked = gm_arena_take(arena, system->variable_count, sizeof *opening->marked);
    memset(opening->marked, true, n * sizeof *opening->marked);
    open_constraints(arena, opening);
    open_one_form(arena, opening);
    if (system->kind == GM_LAGRANGIAN) {
        gm_user_lagrangian_derive(arena, &model->lagrangian, system);
    }
    open_rates(arena, opening, NULL);
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == GM_WORD_COMPILE) {
            open_rates(arena, opening, &system->items[i]);
        }
    }
    open_slopes(arena, opening);
    open_events(arena, opening);
    gm_user_bracket_derive(arena, &model->bracket, system);
    for (size_t i = 0; i < model->rate_count && system->kind != GM_LAGRANGIAN; i++) {
        gm_arena_need(arena, gm_formula_quicken(&system->graph, model->rates[i].nodes, n));
    }
    gm_arena_need(arena, !system->graph.failed);
    const bool energy = system->kind == GM_CANONICAL || system->kind == GM_POISSON;
    gm_node_id at = GM_NO_NODE;
    model->energy_jumps =
        opening->whole && energy && !model->findings[GM_FACT_SMOOTH].holds &&
        gm_breaks_pass(arena, system, &system->energy, 1, system->rates, n, &at) == GM_NOT_ZERO;
    bool switches = gm_system_locates_breaks(system);
    for (size_t i = 0; i < model->event_count; i++) {
        switches |= model->events[i].switches;
    }
    if (opening->whole && switches) {
        open_frozen(arena, model);
    }
}

static bool open_all(struct gm_user_model *model, struct gm_user_system *system, bool whole)
{
    *model = (struct gm_user_model){.system = system, .components = system->n + system->timed};
    return gm_arena_run(system->arena, open_model, &(struct opening){model, system, NULL, whole});
}

bool gm_user_model_open(struct gm_user_model *model, struct gm_user_system *system)
{
    return open_all(model, system, true);
}

void gm_user_system_again(struct gm_arena *arena, const struct gm_user_system *system, const double *values,
                          bool without_tangents, struct gm_user_system *again)
{
    const size_t choices = system->choices.count, count = choices + system->velocities - system->parameters;
    struct gm_system_value *chosen = gm_arena_take(arena, count + 1, sizeof *chosen);
    for (size_t i = 0; i < count; i++) {
        const struct gm_written_choice *choice = &system->choices.list[i];
        const size_t number = system->parameters + i - choices;
        chosen[i] = i < choices ? (struct gm_system_value){choice->name, choice->words[choice->chosen]}
                                : (struct gm_system_value){system->variables[number].name,
                                                           gm_arena_print(arena, "%.17g", values[number])};
        gm_arena_need(arena, chosen[i].text != NULL);
    }
    chosen[count] = (struct gm_system_value){GM_WITHOUT_TANGENTS, ""};
    struct gm_fault fault;
    gm_arena_need(arena, gm_equations_open(again, system->source, system->length, chosen,
                                           count + without_tangents, &fault));
}

const struct gm_user_rates *gm_user_model_rates(const struct gm_user_model *model, const double *values)
{
    size_t i = model->rate_count;
    while (i > 1 && values[model->rates[i - 1].parameter] != model->rates[i - 1].value) {
        i--;
    }
    return &model->rates[i > 1 ? i - 1 : 0];
}

bool gm_user_model_has_action(const struct gm_user_model *model)
{
    const enum gm_system_kind kind = model->system->kind;
    return model->has_jacobian &&
           (kind == GM_LAGRANGIAN || (kind == GM_CANONICAL && model->findings[GM_FACT_NYSTROM].holds));
}

bool gm_user_model_splits(const struct gm_user_model *model, const double *values)
{
    return !gm_user_model_is_forced(model) && model->constraints.count == 0 &&
           (gm_user_model_holds(model, values, GM_FACT_SEPARABLE) ||
            gm_user_model_holds(model, values, GM_FACT_SECOND_ORDER));
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
