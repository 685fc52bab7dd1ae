/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The facets of a formula's problem, each a function that interprets a tape. */
#include "core/ode/own/own.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/ode/own/kernel.h"
#include "core/ode/own/late.h"
#include "core/ode/variational/manifold.h"
#include "core/quantity.h"
#include "core/system/equations.h"
#include "core/tape.h"

/* What a problem's `parameters` and `facets` point to. */
struct own {
    const double *constants[GM_KERNEL_FUNCTIONS]; /* where compiled kernels look for them */
    struct gm_ode ode;
    struct gm_loops loops, interpreted, free; /* free: without constraints */
    const struct gm_loops *taken;             /* whose some of `loops` are; NULL: all are interpreted */
    void *note;                               /* of whoever compiles it */
    struct gm_split split;
    struct gm_hamiltonian hamiltonian;
    struct gm_volume volume;
    struct gm_fast_linear fast_linear;
    struct gm_kepler_split kepler_split;
    struct gm_lagrangian one_degree;
    struct gm_late_tape slow_force;                     /* of q alone, and */
    struct gm_tape attraction, perturbation, potential; /* as well */
    double *frequencies;                                /* of coordinates */
    struct gm_late_tape field, velocity, force, energy, jacobian;
    struct gm_late_tape *pieces; /* the rates, one by one, where each component alone has an exact flow */
    gm_node_id *slopes_of_rates; /* the nodes of the Jacobian */
    struct gm_own_lagrangian lagrangian;
    struct gm_own_constraints constraints;
    struct gm_action action;
    double friction;
    struct gm_tape density, slopes; /* of the monitor: Q, and Q with dQ/dy */
    struct gm_monitor monitor;
    struct gm_own_bracket bracket;
    struct gm_poisson poisson;
    double *values; /* of the system's variables */
    const struct gm_own_model *model;
};

/* Not constant: tapes are made later (core/ode/own/late.h). */
static struct own *own_of(const struct gm_problem *problem)
{
    return (struct own *)problem->parameters;
}

static bool energy_formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    const struct own *own = own_of(problem);
    const struct gm_own_system *system = own->model->system;
    *node = gm_formula_graft(graph, &system->graph, system->energy, problem->n, own->values);
    return *node != GM_NO_NODE;
}

static bool is_forced(const struct gm_own_system *system)
{
    bool forced = false;
    for (size_t i = 0; i < system->n; i++) {
        forced |= system->variables[i].force != GM_NO_NODE;
    }
    return forced;
}

/* In the words of struct gm_ode; "": too many or too long to be told apart there. */
static char *names_of(const struct gm_own_system *system)
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
static bool open_slopes(struct gm_own_model *model, struct gm_own_system *system, bool *marked)
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

bool gm_own_model_open(struct gm_own_model *model, struct gm_own_system *system)
{
    *model = (struct gm_own_model){.system = system, .components = system->n + system->timed};
    const size_t n = model->components;
    if (!gm_facts_find(system, model->findings)) {
        return false;
    }
    model->rates = malloc((n + 1) * sizeof *model->rates);
    model->names = names_of(system);
    bool *marked = calloc(system->variable_count, sizeof *marked);
    if (!model->rates || !model->names || !marked) {
        free(marked);
        return false;
    }
    memcpy(model->rates, system->rates, system->n * sizeof *model->rates);
    if (system->timed) {
        model->rates[system->n] = gm_formula_constant(&system->graph, 1);
    }
    model->has_jacobian = n <= GM_NEWTON_LARGEST;
    bool good = gm_own_constraints_model_open(&model->constraints, system);
    if (system->kind == GM_LAGRANGIAN) {
        gm_own_lagrangian_model_open(&model->lagrangian, system);
    } else if (model->has_jacobian) {
        memset(marked, true, n);
        gm_sparse_jacobian(&system->graph, model->rates, n, marked, system->variable_count, &model->jacobian);
    }
    if (good) {
        good = open_slopes(model, system, marked) && gm_own_bracket_model_open(&model->bracket, system);
    }
    free(marked);
    const bool has_rates = system->kind != GM_LAGRANGIAN;
    return good && (!has_rates || gm_formula_quicken(&system->graph, model->rates, n)) &&
           !system->graph.failed;
}

void gm_own_model_close(struct gm_own_model *model)
{
    gm_own_lagrangian_model_close(&model->lagrangian);
    gm_own_constraints_model_close(&model->constraints);
    gm_own_bracket_model_close(&model->bracket);
    free(model->rates);
    free(model->jacobian.entries);
    free(model->slopes);
    free(model->names);
    *model = (struct gm_own_model){0};
}

/* Whether variational schemes know what to do with it. */
static bool has_action(const struct gm_own_model *model)
{
    const enum gm_system_kind kind = model->system->kind;
    return model->has_jacobian &&
           (kind == GM_LAGRANGIAN || (kind == GM_CANONICAL && model->findings[GM_FACT_NYSTROM].holds));
}

const char *gm_own_model_lacks(const struct gm_own_model *model)
{
    if (model->constraints.count == 0) {
        return "";
    }
    return model->system->timed   ? "with constraints the time may not occur"
           : !model->has_jacobian ? "with constraints there may be at most 64 components"
           : !has_action(model)   ? "constraints take L, or H = T(p) + V(q) with a quadratic T"
                                  : "";
}

static void field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    gm_late_tape_values(&own_of(problem)->field, y, f, m);
}

static void velocity(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    gm_late_tape_values(&own_of(problem)->velocity, y, f, m);
}

static void force(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    gm_late_tape_values(&own_of(problem)->force, y, f, m);
}

static void energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    gm_late_tape_values(&own_of(problem)->energy, y, value, m);
}

static void jacobian(const struct gm_problem *problem, const double *y, double *matrix)
{
    struct own *own = own_of(problem);
    const struct gm_sparse *entries = &own->model->jacobian;
    double values[GM_NEWTON_LARGEST * GM_NEWTON_LARGEST];
    gm_late_tape_values(&own->jacobian, y, values, 1);
    memset(matrix, 0, problem->n * problem->n * sizeof *matrix);
    for (size_t i = 0; i < entries->count; i++) {
        matrix[entries->entries[i].row * problem->n + entries->entries[i].column] = values[i];
    }
}

static void lagrangian_field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    gm_own_lagrangian_field(&own_of(problem)->lagrangian, y, f, m);
}

static void lagrangian_velocity(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    gm_own_lagrangian_velocity(&own_of(problem)->lagrangian, y, f, m);
}

static void lagrangian_force(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    gm_own_lagrangian_force(&own_of(problem)->lagrangian, y, f, m);
}

static void lagrangian_energy(const struct gm_problem *problem, const double *y, double *value, size_t m)
{
    gm_own_lagrangian_energy(&own_of(problem)->lagrangian, y, value, m);
}

static void lagrangian_jacobian(const struct gm_problem *problem, const double *y, double *matrix)
{
    gm_own_lagrangian_jacobian(&own_of(problem)->lagrangian, y, matrix);
}

static void motion(const struct gm_problem *problem, const double *at, const struct gm_motion *motion)
{
    gm_own_lagrangian_motion(&own_of(problem)->lagrangian, at, motion);
}

static void constrain(const struct gm_problem *problem, const double *q, const double *multipliers, double *g,
                      double *slopes, double *curvature)
{
    gm_own_constraints_values(&own_of(problem)->constraints, q, multipliers, g, slopes, curvature);
}

static double friction(const struct gm_problem *problem)
{
    return own_of(problem)->friction;
}

/* x_piece := x_piece + h rate(the others) */
static void flow(const struct gm_problem *problem, size_t piece, double h, double *y, size_t m)
{
    enum { BLOCK = 128 };
    double rate[BLOCK];
    for (size_t first = 0; first < m; first += BLOCK) {
        const size_t count = m - first < BLOCK ? m - first : BLOCK;
        gm_late_tape_block(&own_of(problem)->pieces[piece], y + first, m, rate, BLOCK, count);
        for (size_t l = 0; l < count; l++) {
            y[piece * m + first + l] += h * rate[l];
        }
    }
}

static void density(const struct gm_problem *problem, const double *y, double *value, double *gradient)
{
    const struct own *own = own_of(problem);
    if (!gradient) {
        gm_tape_values(&own->density, y, value, 1);
        return;
    }
    gm_tape_values(&own->slopes, y, gradient, 1);
    gm_tape_values(&own->density, y, value, 1);
}

static double energy_of_bracket(const struct gm_problem *problem, const double *y)
{
    double value;
    gm_tape_values(&own_of(problem)->bracket.energy, y, &value, 1);
    return value;
}

static void gradient(const struct gm_problem *problem, const double *y, double *slope)
{
    gm_tape_values(&own_of(problem)->bracket.gradient, y, slope, 1);
}

static void bracket(const struct gm_problem *problem, const double *y, double *matrix)
{
    gm_tape_values(&own_of(problem)->bracket.matrix, y, matrix, 1);
}

static void flow_of_piece(const struct gm_problem *problem, size_t piece, double h, double *y)
{
    gm_own_bracket_flow(&own_of(problem)->bracket, piece, h, y);
}

/* So that the first step takes no longer than others. */
static void prepare(const struct gm_problem *problem, unsigned needs)
{
    struct own *own = own_of(problem);
    if (needs & (GM_NEEDS_SPLIT | GM_NEEDS_NYSTROM | GM_NEEDS_ATTRACTION)) {
        gm_late_tape(&own->velocity);
        gm_late_tape(&own->force);
    } else if (needs & GM_NEEDS_FAST_LINEAR) {
        gm_late_tape(&own->slow_force);
    } else if (needs & GM_NEEDS_VOLUME) {
        for (size_t i = 0; i < problem->n; i++) {
            gm_late_tape(&own->pieces[i]);
        }
    } else {
        gm_late_tape(&own->field);
        if (own->model->has_jacobian) {
            gm_late_tape(&own->jacobian);
        }
    }
}

static double frequency(const struct gm_problem *problem, size_t i)
{
    return own_of(problem)->frequencies[i];
}

static void slow_force(const struct gm_problem *problem, const double *q, double *force, size_t m)
{
    gm_late_tape_values(&own_of(problem)->slow_force, q, force, m);
}

static void attraction(const struct gm_problem *problem, const double *q, double *potential, size_t m)
{
    gm_tape_values(&own_of(problem)->attraction, q, potential, m);
}

static void perturbing_force(const struct gm_problem *problem, const double *q, double *force, size_t m)
{
    gm_tape_values(&own_of(problem)->perturbation, q, force, m);
}

static void potential(const struct gm_problem *problem, double q, double values[3])
{
    gm_tape_values(&own_of(problem)->potential, &q, values, 1);
}

/* What was tested, not proved, holds for the parameters that it was tested with. */
static bool holds(const struct gm_own_model *model, const double *values, enum gm_fact fact)
{
    const struct gm_own_system *system = model->system;
    const struct gm_finding *finding = &model->findings[fact];
    bool same = true;
    for (size_t i = system->parameters; i < system->velocities; i++) {
        same = same && values[i] == system->variables[i].value;
    }
    return finding->asked && finding->holds && (same || finding->how == GM_ZERO_PROVED);
}

static struct gm_late_tape late_tape(const struct own *own, const gm_node_id *nodes, size_t count,
                                     size_t inputs)
{
    return (struct gm_late_tape){.graph = &own->model->system->graph,
                                 .nodes = nodes,
                                 .count = count,
                                 .inputs = inputs,
                                 .values = own->values};
}

/* The facets of H = |p|^2/2 + V(q). False: out of memory. */
static bool open_mechanical(struct own *own, const double *values)
{
    const struct gm_own_model *model = own->model;
    const struct gm_formula *graph = &model->system->graph;
    const struct gm_finding *findings = model->findings;
    const size_t half = model->system->n / 2;
    bool good = true;
    if (holds(model, values, GM_FACT_FAST_LINEAR)) {
        struct gm_tape tape;
        const gm_node_id *nodes = findings[GM_FACT_FAST_LINEAR].nodes;
        bool real = true;
        own->frequencies = calloc(half, sizeof *own->frequencies);
        good = gm_tape_open(&tape, graph, nodes, half, 0, values) && own->frequencies;
        own->slow_force = late_tape(own, nodes + half, half, half);
        if (good) {
            gm_tape_values(&tape, NULL, own->frequencies, 1);
        }
        gm_tape_close(&tape);
        for (size_t i = 0; good && i < half; i++) {
            real = real && isfinite(own->frequencies[i]);
        }
        own->fast_linear = (struct gm_fast_linear){.frequency = frequency, .slow_force = slow_force};
        own->ode.fast_linear = real ? &own->fast_linear : NULL;
    }
    if (holds(model, values, GM_FACT_KEPLER_SPLIT)) {
        const gm_node_id *nodes = findings[GM_FACT_KEPLER_SPLIT].nodes;
        good = good && gm_tape_open(&own->attraction, graph, nodes, 1, 2, values) &&
               gm_tape_open(&own->perturbation, graph, nodes + 1, 2, 2, values);
        own->kepler_split =
            (struct gm_kepler_split){.potential = attraction, .perturbing_force = perturbing_force};
        own->ode.kepler_split = &own->kepler_split;
    }
    if (holds(model, values, GM_FACT_LAGRANGIAN)) {
        good = good && gm_tape_open(&own->potential, graph, findings[GM_FACT_LAGRANGIAN].nodes, 3, 1, values);
        own->one_degree.potential = potential;
        own->ode.lagrangian = &own->one_degree;
    }
    return good;
}

/* What variational schemes need. False: out of memory. */
static bool open_action(struct own *own, const double *values)
{
    const struct gm_own_model *model = own->model;
    const bool constrained = model->constraints.count > 0;
    if (!has_action(model) ||
        (model->system->kind == GM_CANONICAL && !holds(model, values, GM_FACT_NYSTROM))) {
        return true;
    }
    own->action = (struct gm_action){.motion = model->system->kind == GM_LAGRANGIAN ? motion : NULL,
                                     .free = constrained ? &own->free : NULL,
                                     .constraints = model->constraints.count,
                                     .constrain = constrain};
    own->ode.action = &own->action;
    bool good = !constrained || gm_own_constraints_open(&own->constraints, &model->constraints, values);
    if (holds(model, values, GM_FACT_CONFORMAL)) {
        struct gm_tape tape;
        const gm_node_id *nodes = model->findings[GM_FACT_CONFORMAL].nodes;
        good = good && gm_tape_open(&tape, &model->system->graph, nodes, 1, 0, values);
        if (good) {
            gm_tape_values(&tape, NULL, &own->friction, 1);
            own->action.friction = friction;
        }
        gm_tape_close(&tape);
    }
    return good;
}

/* The moments of inertia of a body that nothing turns: slopes that are linear, each of its own component. */
static void find_moments(struct own *own, const struct gm_problem *problem)
{
    struct gm_poisson *poisson = &own->poisson;
    double at[3] = {0}, slopes[3];
    if (own->model->system->n != 3 || poisson->turning == 0 || !poisson->axes || !own->ode.quadratic) {
        return;
    }
    poisson->gradient(problem, at, slopes);
    bool linear = slopes[0] == 0 && slopes[1] == 0 && slopes[2] == 0;
    double moments[3];
    for (int i = 0; i < 3; i++) {
        at[i] = 1;
        poisson->gradient(problem, at, slopes);
        moments[i] = 1 / slopes[i];
        linear = linear && slopes[i] != 0 && isfinite(moments[i]);
    }
    if (linear) {
        memcpy(poisson->moments, moments, sizeof moments);
    }
}

/* What schemes for brackets need. False: out of memory. */
static bool open_poisson(struct own *own, const struct gm_problem *problem, const double *values)
{
    const struct gm_own_bracket_model *model = &own->model->bracket;
    if (!model->gradient) {
        return true;
    }
    own->poisson = (struct gm_poisson){.energy = energy_of_bracket,
                                       .gradient = gradient,
                                       .bracket = bracket,
                                       .turning = model->turning,
                                       .spins = model->spins,
                                       .axes = model->axes,
                                       .pieces = model->piece_count,
                                       .flow = flow_of_piece};
    own->ode.poisson = &own->poisson;
    const bool good = gm_own_bracket_open(&own->bracket, model, values);
    if (good) {
        find_moments(own, problem);
    }
    return good;
}

/* What schemes need that choose their step. False: out of memory. */
static bool open_monitor(struct own *own, const double *values)
{
    const struct gm_own_model *model = own->model;
    const struct gm_formula *graph = &model->system->graph;
    if (!model->slopes) {
        return true;
    }
    own->monitor = (struct gm_monitor){.density = density, .of_places = true};
    for (size_t i = model->system->n / 2; i < model->components; i++) {
        own->monitor.of_places = own->monitor.of_places && gm_is_constant(graph, model->slopes[i], 0);
    }
    own->ode.monitor = &own->monitor;
    return gm_tape_open(&own->density, graph, &model->monitor, 1, model->components, values) &&
           gm_tape_open(&own->slopes, graph, model->slopes, model->components, model->components, values);
}

static bool is_unit_mass(const struct gm_own_model *model)
{
    const size_t half = model->system->n / 2;
    bool unit = true;
    for (size_t i = 0; i < half; i++) {
        const struct gm_node *rate = &model->system->graph.nodes[model->rates[i]];
        unit = unit && rate->operation == GM_VARIABLE && rate->a == half + i;
    }
    return unit;
}

static bool open_tapes(struct own *own, const double *values)
{
    const struct gm_own_model *model = own->model;
    const struct gm_own_system *system = model->system;
    const size_t n = model->components, half = system->n / 2;
    if (system->kind == GM_LAGRANGIAN) {
        return gm_own_lagrangian_open(&own->lagrangian, &model->lagrangian, values);
    }
    own->field = late_tape(own, model->rates, n, n);
    own->velocity = late_tape(own, model->rates, half, n);
    own->force = late_tape(own, model->rates + half, half, n);
    own->energy = late_tape(own, &system->energy, 1, n);
    if (model->has_jacobian) {
        gm_node_id *nodes = own->slopes_of_rates = malloc((model->jacobian.count + 1) * sizeof *nodes);
        for (size_t i = 0; nodes && i < model->jacobian.count; i++) {
            nodes[i] = model->jacobian.entries[i].node;
        }
        own->jacobian = late_tape(own, nodes, model->jacobian.count, n);
    }
    if (own->ode.volume) {
        own->pieces = malloc(n * sizeof *own->pieces);
        for (size_t i = 0; own->pieces && i < n; i++) {
            own->pieces[i] = late_tape(own, &model->rates[i], 1, n);
        }
    }
    return (own->slopes_of_rates || !model->has_jacobian) && (own->pieces || !own->ode.volume);
}

/* Whether the energy of rest is negative where these values of all variables have it start. Of a Hamiltonian the
   formula itself is asked: no tape is made for one number. */
static bool attracts(const struct gm_problem *problem, const double *values)
{
    const struct gm_own_system *system = own_of(problem)->model->system;
    const gm_node_id energy = system->energy;
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(&system->graph, energy, &count);
    double *rest = malloc(system->variable_count * sizeof *rest),
           *at = malloc((energy + (size_t)1) * sizeof *at); /* of the parts alone */
    bool negative = false;
    if (parts && rest && at) {
        memcpy(rest, values, system->variable_count * sizeof *rest);
        memset(rest + problem->n / 2, 0, (problem->n - problem->n / 2) * sizeof *rest);
        gm_formula_evaluate_parts(&system->graph, parts, count, rest, at);
        negative = (system->kind == GM_LAGRANGIAN ? gm_energy(problem, rest) : at[energy]) < 0;
    }
    free(parts);
    free(rest);
    free(at);
    return negative;
}

bool gm_own_problem_open(struct gm_problem *problem, const struct gm_own_model *model, const double *values)
{
    const struct gm_own_system *system = model->system;
    struct own *own = calloc(1, sizeof *own);
    *problem = (struct gm_problem){
        .name = "system", .kind = &gm_kind_ode, .n = model->components, .m = 1, .parameters = own};
    if (!own) {
        return false;
    }
    problem->facets = &own->ode;
    own->model = model;
    own->values = malloc((system->variable_count + 1) * sizeof *own->values);
    if (!own->values) {
        return false;
    }
    memcpy(own->values, values, system->variable_count * sizeof *values);
    const bool lagrangian = system->kind == GM_LAGRANGIAN;
    own->loops = (struct gm_loops){.field = lagrangian ? lagrangian_field : field,
                                   .jacobian = !model->has_jacobian ? NULL
                                               : lagrangian         ? lagrangian_jacobian
                                                                    : jacobian};
    const bool constrained = model->constraints.count > 0;
    if (constrained) {
        own->free = own->loops;
        own->loops = (struct gm_loops){.field = gm_manifold_field};
    }
    own->ode = (struct gm_ode){.written = true,
                               .components = model->names[0] ? model->names : NULL,
                               .quadratic = !constrained && holds(model, values, GM_FACT_QUADRATIC),
                               .rough = !holds(model, values, GM_FACT_SMOOTH),
                               .prepare = lagrangian ? NULL : prepare};
    for (int isa = 0; isa < GM_ISA_COUNT; isa++) {
        own->ode.loops[isa] = &own->loops;
    }
    own->ode.forced = system->kind <= GM_LAGRANGIAN && is_forced(system);
    if (system->kind <= GM_LAGRANGIAN && !own->ode.forced) {
        /* what moves with the time generates no field of the whole state: it splits, and that is all */
        own->split.nystrom = holds(model, values, GM_FACT_NYSTROM);
        own->split.unit_mass = !lagrangian && is_unit_mass(model);
        own->hamiltonian.energy = lagrangian ? lagrangian_energy : energy;
        own->hamiltonian.formula = lagrangian || constrained ? NULL : energy_formula;
        own->ode.split = !constrained && holds(model, values, GM_FACT_SEPARABLE) ? &own->split : NULL;
        own->ode.hamiltonian = system->timed ? NULL : &own->hamiltonian;
        own->loops.velocity = !own->ode.split ? NULL : lagrangian ? lagrangian_velocity : velocity;
        own->loops.force = !own->ode.split ? NULL : lagrangian ? lagrangian_force : force;
    }
    if (!constrained && holds(model, values, GM_FACT_VOLUME)) {
        own->volume = (struct gm_volume){.pieces = model->components, .flow = flow};
        own->ode.volume = &own->volume;
    }
    own->interpreted = own->loops;
    if (!open_tapes(own, values) || !open_mechanical(own, values) || !open_action(own, values) ||
        !open_monitor(own, values) || !open_poisson(own, problem, values)) {
        return false;
    }
    own->split.attracts = own->ode.split && own->ode.hamiltonian && attracts(problem, values);
    return true;
}

/* The tapes of which kernels are written; NULL: there is none. False: out of memory. */
static bool tapes_of_kernels(struct own *own, const struct gm_tape *tapes[GM_KERNEL_FUNCTIONS])
{
    struct gm_late_tape *const late[GM_KERNEL_FUNCTIONS] = {
        [GM_KERNEL_FIELD] = &own->field,
        [GM_KERNEL_VELOCITY] = own->ode.split ? &own->velocity : NULL,
        [GM_KERNEL_FORCE] = own->ode.split ? &own->force : NULL,
        [GM_KERNEL_JACOBIAN] = own->model->has_jacobian ? &own->jacobian : NULL};
    bool good = true;
    for (size_t i = 0; i < GM_KERNEL_FUNCTIONS; i++) {
        tapes[i] = late[i] ? gm_late_tape(late[i]) : NULL;
        good = good && (tapes[i] || !late[i]);
    }
    return good;
}

char *gm_own_problem_kernel(const struct gm_problem *problem, int over, const char **lacks)
{
    struct own *own = own_of(problem);
    if (own->model->system->kind == GM_LAGRANGIAN) {
        *lacks = "the velocities of a Lagrangian are found by an iteration, which is not compiled";
        return NULL;
    }
    if (own->model->constraints.count > 0) {
        *lacks = "the multipliers of constraints are found by an iteration, which is not compiled";
        return NULL;
    }
    struct gm_kernel_source source = {.components = problem->n,
                                      .jacobian = &own->model->jacobian,
                                      .jacobian_wanted = over == GM_OVER_NONE || over == GM_OVER_IMPLICIT};
    *lacks = NULL;
    return tapes_of_kernels(own, source.tapes) ? gm_kernel_text(&source, lacks) : NULL;
}

void **gm_own_problem_note(const struct gm_problem *problem)
{
    return &own_of(problem)->note;
}

void gm_own_problem_take(struct gm_problem *problem, const struct gm_loops *loops)
{
    struct own *own = own_of(problem);
    const struct gm_tape *tapes[GM_KERNEL_FUNCTIONS];
    loops = loops && tapes_of_kernels(own, tapes) ? loops : NULL;
    own->loops = own->interpreted;
    own->taken = loops;
    if (loops) {
        for (size_t i = 0; i < GM_KERNEL_FUNCTIONS; i++) {
            own->constants[i] = tapes[i] ? tapes[i]->constants : NULL;
        }
        own->loops.field = loops->field;
        own->loops.jacobian = loops->jacobian ? loops->jacobian : own->interpreted.jacobian;
        memcpy(own->loops.over_kernels, loops->over_kernels, sizeof own->loops.over_kernels);
    }
}

const struct gm_loops *gm_own_problem_taken(const struct gm_problem *problem)
{
    return own_of(problem)->taken;
}

void gm_own_problem_close(struct gm_problem *problem)
{
    struct own *own = (struct own *)problem->parameters;
    if (own) {
        for (size_t i = 0; own->pieces && i < problem->n; i++) {
            gm_late_tape_close(&own->pieces[i]);
        }
        gm_late_tape_close(&own->field);
        gm_late_tape_close(&own->velocity);
        gm_late_tape_close(&own->force);
        gm_late_tape_close(&own->energy);
        gm_late_tape_close(&own->jacobian);
        gm_own_lagrangian_close(&own->lagrangian);
        gm_own_constraints_close(&own->constraints);
        gm_late_tape_close(&own->slow_force);
        gm_tape_close(&own->attraction);
        gm_tape_close(&own->perturbation);
        gm_tape_close(&own->potential);
        gm_tape_close(&own->density);
        gm_tape_close(&own->slopes);
        gm_own_bracket_close(&own->bracket);
        free(own->frequencies);
        free(own->pieces);
        free(own->slopes_of_rates);
        free(own->values);
        free(own);
    }
    *problem = (struct gm_problem){0};
}
