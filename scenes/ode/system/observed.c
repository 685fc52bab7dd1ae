/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Observables of a user-defined system: its energy, the quantities that its file names, the area of a disc of
   members, the distance from the exact solution. */
#include "scenes/common/system/hook.h"
#include "scenes/ode/system/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/events.h"
#include "core/model/scope.h"
#include "core/ode/families/adaptive/variational_time.h"
#include "core/ode/families/families.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/ode/variational/manifold.h"
#include "core/schemes.h"
#include "scenes/common/rows.h"
#include "scenes/common/system/pieces.h"
#include "scenes/ode/system/optional.h"

/* ---- formulas during the run ---- */

/* The jumps that events have made in a conserved quantity; 0 for other observables. */
static double booked(const struct gm_view *view)
{
    const size_t quantity = gm_system_measure_of(view)->booked;
    return view->booked && quantity > 0 ? gm_events_booked(view->problem, view->booked, quantity - 1) : 0;
}

/* Returns an observable's formula while its condition, if any, holds; else NaN. */
static double observed(const struct gm_view *view)
{
    double values[2] = {0, 1};
    gm_system_values(gm_system_measure_of(view)->formula, view, gm_system_centre(view), values);
    return values[1] > 0 ? values[0] - booked(view) : NAN;
}

static double terms(const struct gm_view *view)
{
    double value;
    gm_system_values(gm_system_measure_of(view)->terms, view, gm_system_centre(view), &value);
    return value;
}

/* Returns p q' - L of a Lagrangian system, whose formulas hold velocities, or the magnitudes of its terms. */
static double legendre(const struct gm_view *view, bool magnitudes)
{
    const size_t n = view->problem->n, m = view->problem->m;
    double *centre = malloc(2 * n * sizeof *centre), value = NAN, sum = 0, size = 0;
    if (centre) {
        gm_member_take(view->state, centre, n, m, gm_system_centre(view));
        value = gm_energy(view->problem, centre);
    }
    if (centre && magnitudes) {
        gm_field(view->problem, centre, centre + n, 1);
        for (size_t i = 0; i < n / 2; i++) {
            sum += centre[n / 2 + i] * centre[n + i];
            size += fabs(centre[n / 2 + i] * centre[n + i]);
        }
        value = size + fabs(sum - value);
    }
    free(centre);
    return value;
}

static double legendre_energy(const struct gm_view *view)
{
    return legendre(view, false) - booked(view);
}

static double legendre_terms(const struct gm_view *view)
{
    return legendre(view, true);
}

/* Returns the residuals of the constraints, of the last member. */
static struct gm_manifold_defects defects_of(const struct gm_view *view)
{
    const size_t n = view->problem->n, m = view->problem->m;
    struct gm_manifold_defects defects = {NAN, NAN};
    double *centre = malloc(n * sizeof *centre);
    if (centre) {
        gm_member_take(view->state, centre, n, m, gm_system_centre(view));
        defects = gm_manifold_defects(view->problem, centre);
    }
    free(centre);
    return defects;
}

static double constraint_defect(const struct gm_view *view)
{
    return defects_of(view).constraint;
}

static double hidden_defect(const struct gm_view *view)
{
    return defects_of(view).hidden;
}

/* Returns the largest distance of a component from the exact solution in the file. */
static double solution_error(const struct gm_view *view)
{
    const struct gm_system_scene *system_scene = gm_system_scene_of(view);
    const size_t n = system_scene->system.n, m = view->problem->m;
    double *exact = malloc(n * sizeof *exact), error = exact ? 0 : NAN;
    if (exact) {
        gm_system_values(&system_scene->exact, view, gm_system_centre(view), exact);
    }
    for (size_t i = 0; exact && i < n; i++) {
        const double away = fabs(view->state[i * m + gm_system_centre(view)] - exact[i]);
        if (system_scene->system.variables[i].exact != GM_NO_NODE) {
            error = away > error || isnan(away) ? away : error;
        }
    }
    free(exact);
    return error;
}

/* Returns the mean area of the first two tangents, the sum over coordinates with their momenta. */
static double area_tangent(const struct gm_view *view)
{
    const struct gm_user_system *system = &gm_system_scene_of(view)->system;
    const size_t m = view->problem->m, pairs = gm_system_motion(system) / 2;
    double sum = 0;
    for (size_t c = 0; c < pairs; c++) {
        const double *q[2], *p[2];
        for (size_t k = 0; k < 2; k++) {
            q[k] = view->state + gm_system_component(system, c, 1 + k) * m;
            p[k] = view->state + gm_system_component(system, pairs + c, 1 + k) * m;
        }
        for (size_t i = 0; i < m; i++) {
            sum += q[0][i] * p[1][i] - q[1][i] * p[0][i];
        }
    }
    return sum / (double)m;
}

static const char events_key[] = "events";

/* Returns how often all events have happened, or the one that the observable names. */
static double happened(const struct gm_view *view)
{
    const struct gm_events *events = view->problem->events;
    const char *name = view->observable->key + strlen(events_key);
    size_t event = name[0] ? 0 : events->count;
    while (event < events->count && strcmp(events->names[event], name + 1) != 0) {
        event++;
    }
    return view->booked ? gm_events_happened(view->problem, view->booked, event) : 0;
}

/* Returns the energy that events have added. */
static double event_work(const struct gm_view *view)
{
    return view->booked ? gm_events_booked(view->problem, view->booked, view->problem->events->quantities - 1)
                        : 0;
}

/* ---- the rows of the scene ---- */

void gm_system_check_exact(struct gm_system_scene *system_scene, const struct gm_problem *problem)
{
    struct gm_arena *arena = system_scene->arena;
    const size_t n = system_scene->exact.outputs;
    struct gm_problem alone = *problem;
    if (n == 0) {
        return;
    }
    const double *start = gm_arena_keep(arena, gm_system_start_values(system_scene->initial, NULL), free);
    double *exact = gm_arena_take(arena, n, sizeof *exact);
    alone.m = 1;
    gm_system_values(
        &system_scene->exact,
        &(struct gm_view){
            .parameters = system_scene->initial, .problem = &alone, .state = start, .start = start},
        0, exact);
    for (size_t i = 0; i < n; i++) {
        const struct gm_system_variable *variable = &system_scene->system.variables[i];
        const double most = 1e-9 * fmax(1, fabs(start[i]));
        if (variable->exact != GM_NO_NODE && variable->start != GM_NO_NODE &&
            !(fabs(exact[i] - start[i]) <= most)) {
            gm_arena_refuse(arena, "exact: %.60s would begin at %.10g, and it starts at %.10g",
                            variable->name, exact[i], start[i]);
        }
    }
}

/* Returns a node with the magnitudes of its terms, and of their factors, instead of these. */
static gm_node_id sizes_of(struct gm_system_scene *system_scene, gm_node_id root)
{
    struct gm_arena *arena = system_scene->arena;
    struct gm_formula *graph = &system_scene->system.graph;
    size_t count = 0;
    const gm_node_id *parts = gm_arena_keep(arena, gm_formula_parts(graph, root, &count), free);
    gm_node_id *sizes = gm_arena_take(arena, (size_t)root + 1, sizeof *sizes);
    for (size_t k = 0; k < count; k++) {
        const gm_node_id i = parts[k];
        const struct gm_node node = graph->nodes[i];
        switch (node.operation) {
        case GM_OPERATION_ADD:
        case GM_OPERATION_SUBTRACT:
            sizes[i] = gm_sum(graph, sizes[node.a], sizes[node.b]);
            break;
        case GM_OPERATION_NEGATE:
            sizes[i] = sizes[node.a];
            break;
        case GM_OPERATION_MULTIPLY:
            sizes[i] = gm_product(graph, sizes[node.a], sizes[node.b]);
            break;
        case GM_OPERATION_DIVIDE:
            sizes[i] = gm_simplified(graph, GM_OPERATION_DIVIDE, sizes[node.a],
                                     gm_simplified(graph, GM_OPERATION_ABS, node.b, node.b));
            break;
        default:
            sizes[i] = gm_simplified(graph, GM_OPERATION_ABS, i, i);
        }
    }
    gm_arena_need(arena, !graph->failed);
    return sizes[root];
}

/* Adds an observable: node `node` while node `condition` is above 0; GM_NO_NODE: a function of its own,
   always. */
static void add_observable(struct gm_system_scene *system_scene, struct gm_observable row, gm_node_id node,
                           gm_node_id condition)
{
    const size_t i = system_scene->observable_count++;
    const gm_node_id nodes[2] = {node, condition};
    system_scene->observables[i] = row;
    if (node == GM_NO_NODE) {
        return;
    }
    struct gm_system_measure *measure = &system_scene->measures[i];
    measure->formula = gm_system_take_tape(system_scene, nodes, condition == GM_NO_NODE ? 1 : 2);
    if (row.error) {
        const gm_node_id sizes = sizes_of(system_scene, node);
        system_scene->observables[i].terms = terms;
        measure->terms = gm_system_take_tape(system_scene, &sizes, 1);
    }
}

/* Adds a function of its own. */
static void add_function(struct gm_system_scene *system_scene, struct gm_observable row)
{
    add_observable(system_scene, row, GM_NO_NODE, GM_NO_NODE);
}

static bool is_forced(const struct gm_user_system *system)
{
    for (size_t i = 0; i < system->n; i++) {
        if (system->variables[i].force != GM_NO_NODE) {
            return true;
        }
    }
    return false;
}

/* Returns the scale of a symmetry's momentum map: its terms at the start, which may cancel. */
static double momentum_scale(struct gm_system_scene *system_scene, const struct gm_system_item *item)
{
    struct gm_arena *arena = system_scene->arena;
    const size_t half = system_scene->system.n / 2, mark = gm_arena_mark(arena);
    const struct gm_tape *tape = gm_system_take_tape(system_scene, item->nodes, half);
    const double *values = gm_arena_keep(arena, gm_system_start_values(system_scene->initial, NULL), free);
    double *generator = gm_arena_take(arena, half, sizeof *generator), sum = 0;
    gm_tape_values(tape, values, generator, 1);
    for (size_t i = 0; i < half; i++) {
        sum += fabs(generator[i] * values[half + i]);
    }
    gm_arena_release(arena, mark);
    return isfinite(sum) ? sum : 0;
}

/* Returns "NAME error", with blanks for underscores. */
static const char *error_title(struct gm_arena *arena, const char *name)
{
    char *text = gm_arena_print(arena, "%s error", name);
    for (char *at = text; *at; at++) {
        *at = *at == '_' ? ' ' : *at;
    }
    return text;
}

/* Adds the counts of events, and their work. */
static void add_events(struct gm_system_scene *system_scene, const struct gm_problem *problem)
{
    const struct gm_events *events = problem->events;
    if (!events || !events->changes) {
        return;
    }
    add_function(system_scene, (struct gm_observable)GM_OBSERVABLE(events_key, happened, "number of events"));
    for (size_t i = 0; i < events->count; i++) {
        if (events->names[i][0]) {
            add_function(system_scene,
                         (struct gm_observable)GM_OBSERVABLE(
                             gm_arena_print(system_scene->arena, "%s_%s", events_key, events->names[i]),
                             happened,
                             gm_arena_print(system_scene->arena, "number of events %s", events->names[i])));
        }
    }
    if (events->has_energy) {
        add_function(system_scene, (struct gm_observable)GM_OBSERVABLE("event_work", event_work,
                                                                       "energy that events have added"));
    }
}

/* Lets the last observable be measured against the start with the jumps of this quantity. */
static void book(struct gm_system_scene *system_scene, const struct gm_problem *problem, size_t quantity)
{
    if (problem->events && problem->events->changes) {
        system_scene->measures[system_scene->observable_count - 1].booked = 1 + quantity;
    }
}

static void add_energy(struct gm_system_scene *system_scene, const struct gm_problem *problem)
{
    const struct gm_user_system *system = &system_scene->system;
    const bool lagrangian = system->kind == GM_LAGRANGIAN, kept = !system->timed && !is_forced(system);
    if (system->kind == GM_RATES || (lagrangian && !gm_ode_of(problem)->hamiltonian)) {
        return;
    }
    struct gm_observable energy =
        kept ? (struct gm_observable)GM_KEPT_OBSERVABLE("energy_error", observed, "H", "energy error")
             : (struct gm_observable)GM_OBSERVABLE("energy", observed, "energy, which is not constant");
    const struct gm_system_item *line = gm_system_item_of(system, GM_WORD_HAMILTONIAN, 0);
    if (kept && line) {
        energy.least = gm_system_option_number(line, GM_OPTION_SCALE, 0);
        energy.scale_text = gm_arena_print(system_scene->arena, "%.3g", energy.least);
    }
    if (lagrangian) {
        energy.evaluate = legendre_energy;
        energy.terms = kept ? legendre_terms : NULL;
    }
    add_observable(system_scene, energy, lagrangian ? GM_NO_NODE : system->energy, GM_NO_NODE);
    if (kept && problem->events) {
        book(system_scene, problem, problem->events->quantities - 1);
    }
}

/* Returns a short name of an invariant for formulas: its own or its let's. */
static const char *symbol_of(const struct gm_system_scene *system_scene, const struct gm_system_item *item,
                             const char *name)
{
    enum { SHORT = 2 };
    const struct gm_naming naming = gm_system_naming(&system_scene->system);
    const char *part = item->word == GM_WORD_SYMMETRY ? NULL : naming.part(item->nodes[0], naming.data);
    if (strlen(name) <= SHORT) {
        return name;
    }
    return part && strlen(part) <= SHORT ? part : "I";
}

/* Adds the error of an invariant, of a Casimir, or of a symmetry's momentum, with this number among those
   without a name. */
static void add_invariant(struct gm_system_scene *system_scene, const struct gm_system_item *item,
                          size_t nameless)
{
    const bool symmetry = item->word == GM_WORD_SYMMETRY;
    const char *name =
        item->name[0] ? item->name : gm_arena_print(system_scene->arena, "momentum%zu", nameless);
    const double scale =
        symmetry ? momentum_scale(system_scene, item) : gm_system_option_number(item, GM_OPTION_SCALE, 0);
    struct gm_observable row = GM_KEPT_OBSERVABLE(
        gm_arena_print(system_scene->arena, "%s_error", name), observed, symbol_of(system_scene, item, name),
        error_title(system_scene->arena, name), .least = scale,
        .scale_text = scale > 0 ? gm_arena_print(system_scene->arena, "%.3g", scale) : NULL);
    gm_written_options(&row, item);
    row.kept = item->check != GM_NOT_ZERO; /* else forces change it, for every scheme */
    add_observable(system_scene, row, gm_system_conserved(&system_scene->system, item), GM_NO_NODE);
}

enum { FOLLOWED = 64 };

static void add_observed(struct gm_system_scene *system_scene, const struct gm_system_item *item)
{
    struct gm_observable row = GM_OBSERVABLE(item->name, observed, item->name);
    const struct gm_system_option *condition = gm_system_option(item, GM_OPTION_WHILE);
    gm_written_options(&row, item);
    row.symbol = gm_system_option_text(item, GM_OPTION_ERROR, NULL);
    row.error = row.symbol != NULL;
    row.logarithmic |= row.error;
    if (row.period > 0 && system_scene->scene.follow == 0) {
        system_scene->scene.follow = FOLLOWED; /* an angle must be seen in every part of a turn */
    }
    add_observable(system_scene, row, item->nodes[0], condition ? condition->node : GM_NO_NODE);
}

/* Returns the step that the discrete energy balance determines, or dt with other schemes. */
static double tau(const struct gm_view *view)
{
    const bool chosen = view->scheme->family->parameters == gm_settings_of_variational_time;
    return view->memory && chosen ? view->memory[GM_VARIATIONAL_TAU] : view->dt;
}

static double restarts(const struct gm_view *view)
{
    const bool counted = view->scheme->family == &gm_family_variational_time;
    return view->memory && counted ? view->memory[GM_VARIATIONAL_RESTARTS] : 0;
}

/* Adds the step of the file's schemes, if one of them determines it. */
static void add_steps(struct gm_system_scene *system_scene)
{
    const char *list = system_scene->system.texts[GM_WORD_SCHEMES];
    char name[64];
    bool chosen = false;
    while (gm_listed_word(&list, name, sizeof name)) {
        const struct gm_scheme *scheme = gm_scheme_find(name);
        chosen = chosen || (scheme && scheme->family->parameters == gm_settings_of_variational_time);
    }
    if (chosen) {
        add_function(system_scene, (struct gm_observable)GM_LOG_OBSERVABLE("tau", tau, "time step τ"));
        add_function(system_scene, (struct gm_observable)GM_OBSERVABLE("restarts", restarts, "restarts"));
    }
}

/* Adds the quantities in the file: observe:, invariant:, casimir:, symmetry:. */
static void add_named(struct gm_system_scene *system_scene, const struct gm_problem *problem)
{
    const struct gm_user_system *system = &system_scene->system;
    size_t nameless = 0, quantity = 0;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        nameless += item->word == GM_WORD_SYMMETRY && !item->name[0];
        if (item->word == GM_WORD_OBSERVE) {
            add_observed(system_scene, item);
        } else if (gm_system_conserved(system, item) != GM_NO_NODE) {
            add_invariant(system_scene, item, nameless);
            book(system_scene, problem, quantity++);
        }
    }
}

static void add_defects(struct gm_system_scene *system_scene, const struct gm_problem *problem)
{
    if (gm_action_constraints(problem) > 0) {
        add_function(system_scene, (struct gm_observable)GM_LOG_OBSERVABLE(
                                       "constraint_defect", constraint_defect, "the largest |g|"));
        add_function(system_scene, (struct gm_observable)GM_LOG_OBSERVABLE("hidden_defect", hidden_defect,
                                                                           "the largest |dg/dt|"));
    }
}

/* Adds the distance from exact:, for the components given there. */
static void add_solution_error(struct gm_system_scene *system_scene)
{
    const struct gm_user_system *system = &system_scene->system;
    gm_node_id *exact = gm_arena_take(system_scene->arena, system->n, sizeof *exact);
    bool told = false;
    for (size_t i = 0; i < system->n; i++) {
        const gm_node_id node = system->variables[i].exact;
        told |= node != GM_NO_NODE;
        exact[i] = node != GM_NO_NODE ? node : 0;
    }
    if (told) {
        gm_system_open_tape(system_scene, &system_scene->exact, exact, system->n);
        add_function(system_scene, (struct gm_observable)GM_LOG_OBSERVABLE(
                                       "solution_error", solution_error, "distance from the exact solution"));
        system_scene->work.measure = "solution_error";
    }
}

/* Adds the area of a disc of members, in the plane, and that of two tangents: of coordinates with their momenta,
   or in a plane. */
static void add_areas(struct gm_system_scene *system_scene)
{
    const struct gm_user_system *system = &system_scene->system;
    const bool plane = gm_system_motion(system) == 2;
    if (plane) {
        add_function(system_scene,
                     (struct gm_observable)GM_OBSERVABLE("area", gm_ring_area, "area of the disc of members",
                                                         .why = gm_ring_why, .of_members = true));
    }
    if (plane && system->kind <= GM_LAGRANGIAN && !is_forced(system)) {
        add_function(system_scene,
                     (struct gm_observable)GM_KEPT_OBSERVABLE("area_error", gm_ring_area, "A", "area error",
                                                              .why = gm_ring_why, .of_members = true));
    }
    if (system->tangents >= 2 && (system->kind == GM_CANONICAL || plane)) {
        add_function(system_scene, (struct gm_observable)GM_OBSERVABLE(
                                       "area_tangent", area_tangent,
                                       "determinant of the tangent map, mean over the members"));
    }
}

/* Refuses the line that makes a second observable of that name. */
static void refuse_twice(const struct gm_system_scene *system_scene, const char *key)
{
    for (size_t i = system_scene->system.item_count; i-- > 0;) {
        const struct gm_system_item *item = &system_scene->system.items[i];
        const size_t length = item->name ? strlen(item->name) : 0;
        const char *ending = item->word == GM_WORD_OBSERVE ? "" : "_error";
        if (gm_system_is_observed(item) && length > 0 && strncmp(key, item->name, length) == 0 &&
            strcmp(key + length, ending) == 0) {
            gm_arena_refuse(system_scene->arena, "%s: %s makes two observables %s",
                            gm_system_words[item->word].word, item->name, key);
        }
    }
    gm_arena_refuse(system_scene->arena, "there are two observables %s", key);
}

void gm_system_make_observables(struct gm_system_scene *system_scene, const struct gm_problem *problem)
{
    const struct gm_hook *hook = system_scene->hook;
    const size_t of_hook = hook ? hook->observable_count : 0;
    gm_system_take_observables(system_scene, 2 * system_scene->system.item_count + 12 + of_hook);
    for (size_t i = 0; i < of_hook; i++) {
        add_function(system_scene, hook->observables[i]);
    }
    const bool carried = system_scene->system.tangents > 0; /* then the areas come first */
    if (carried) {
        add_areas(system_scene);
    }
    add_energy(system_scene, problem);
    add_steps(system_scene);
    add_named(system_scene, problem);
    add_events(system_scene, problem);
    add_defects(system_scene, problem);
    add_solution_error(system_scene);
    if (!carried) {
        add_areas(system_scene);
    }
    system_scene->scene.observable_count = system_scene->observable_count;
    for (size_t i = 0; i < system_scene->observable_count; i++) {
        for (size_t k = 0; k < i; k++) {
            const char *key = system_scene->observables[i].key, *other = system_scene->observables[k].key;
            if (gm_observables_clash(key, other)) {
                refuse_twice(system_scene, strlen(key) < strlen(other) ? other : key);
            }
        }
    }
}
