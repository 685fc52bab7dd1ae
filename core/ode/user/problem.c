/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The facets of a formula's problem, each a function that interprets a tape. */
#include "core/ode/user/problem.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/model/equations.h"
#include "core/ode/families/splitting/kepler.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/ode/trace_free.h"
#include "core/ode/user/conserved.h"
#include "core/ode/user/kernel.h"
#include "core/ode/user/lazy_tape.h"
#include "core/ode/user/parts.h"
#include "core/ode/variational/manifold.h"
#include "core/quantity.h"
#include "core/tape.h"

/* The data that a problem's `parameters` and `facets` point to. */
struct own {
    const double *constants[GM_KERNEL_FUNCTIONS]; /* the constants of compiled kernels */
    struct gm_ode ode;
    struct gm_loops loops, interpreted, free; /* free: without constraints */
    const struct gm_loops *taken; /* the source of compiled functions in `loops`; NULL: all are interpreted */
    void *note;                   /* the compiler's note */
    struct gm_split split;
    struct gm_hamiltonian hamiltonian;
    struct gm_volume volume;
    struct gm_magnetic magnetic;
    struct gm_parts parts;
    struct gm_tape drift, turning; /* functions of places and of the time */
    struct gm_fast_linear fast_linear;
    struct gm_kepler_split kepler_split;
    struct gm_lagrangian one_degree;
    struct gm_late_tape slow_force;                     /* a function of q alone */
    struct gm_tape attraction, perturbation, potential; /* functions of q alone */
    double *frequencies;                                /* one per coordinate */
    struct gm_late_tape field, velocity, force, energy, jacobian;
    struct gm_late_tape *pieces; /* the rates, one by one, where each component alone has an exact flow */
    struct gm_user_lagrangian lagrangian;
    struct gm_user_constraints constraints;
    struct gm_action action;
    double friction;
    struct gm_tape density, slopes; /* the monitor's Q, and Q with dQ/dy */
    struct gm_monitor monitor;
    struct gm_user_bracket bracket;
    struct gm_poisson poisson;
    double matrix[9]; /* the matrix of a linear field of three components without divergence */
    double *values;   /* values of the system's variables */
    const struct gm_user_model *model;
    const struct gm_user_rates *rates; /* of the model */
    struct gm_arena *arena;            /* owns all of this */
};

/* Not constant: tapes are made later (core/ode/user/lazy_tape.h). */
static struct own *own_of(const struct gm_problem *problem)
{
    return (struct own *)problem->parameters;
}

static bool energy_formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    const struct own *self = own_of(problem);
    const struct gm_user_system *system = self->model->system;
    *node = gm_formula_graft(graph, &system->graph, system->energy, problem->n, self->values);
    return *node != GM_NO_NODE;
}

/* A function of a facet: the values of a tape, of a component of the problem's own data. */
#define VALUES_OF(tape)                                                                                      \
    static void tape(const struct gm_problem *problem, const double *y, double *values, size_t m)            \
    {                                                                                                        \
        gm_late_tape_values(&own_of(problem)->tape, y, values, m);                                           \
    }
VALUES_OF(field)
VALUES_OF(velocity)
VALUES_OF(force)
VALUES_OF(energy)
VALUES_OF(slow_force)

static void jacobian(const struct gm_problem *problem, const double *y, double *matrix)
{
    struct own *self = own_of(problem);
    const struct gm_sparse *entries = &self->rates->jacobian;
    double values[GM_NEWTON_LARGEST * GM_NEWTON_LARGEST];
    gm_late_tape_values(&self->jacobian, y, values, 1);
    memset(matrix, 0, problem->n * problem->n * sizeof *matrix);
    for (size_t i = 0; i < entries->count; i++) {
        matrix[entries->entries[i].row * problem->n + entries->entries[i].column] = values[i];
    }
}

/* The same of a Lagrangian. */
#define VALUES_OF_LAGRANGIAN(name)                                                                           \
    static void lagrangian_##name(const struct gm_problem *problem, const double *y, double *values,         \
                                  size_t m)                                                                  \
    {                                                                                                        \
        gm_user_lagrangian_##name(&own_of(problem)->lagrangian, y, values, m);                               \
    }
VALUES_OF_LAGRANGIAN(field)
VALUES_OF_LAGRANGIAN(velocity)
VALUES_OF_LAGRANGIAN(force)
VALUES_OF_LAGRANGIAN(energy)

static void lagrangian_jacobian(const struct gm_problem *problem, const double *y, double *matrix)
{
    gm_user_lagrangian_jacobian(&own_of(problem)->lagrangian, y, matrix);
}

static void motion(const struct gm_problem *problem, const double *at, const struct gm_motion *motion)
{
    gm_user_lagrangian_motion(&own_of(problem)->lagrangian, at, motion);
}

static void constrain(const struct gm_problem *problem, const double *q, const double *multipliers, double *g,
                      double *slopes, double *curvature)
{
    gm_user_constraints_values(&own_of(problem)->constraints, q, multipliers, g, slopes, curvature);
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

static void trace_free_flow(const struct gm_problem *problem, size_t piece, double h, double *y, size_t m)
{
    gm_trace_free_flow(own_of(problem)->matrix, piece, h, y, m);
}

static void density(const struct gm_problem *problem, const double *y, double *value, double *gradient)
{
    const struct own *self = own_of(problem);
    if (!gradient) {
        gm_tape_values(&self->density, y, value, 1);
        return;
    }
    gm_tape_values(&self->slopes, y, gradient, 1);
    gm_tape_values(&self->density, y, value, 1);
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
    gm_user_bracket_flow(&own_of(problem)->bracket, piece, h, y);
}

/* Makes tapes before the first step, so that it takes no longer than others. */
static void prepare(const struct gm_problem *problem, unsigned needs)
{
    struct own *self = own_of(problem);
    if (needs & (GM_NEEDS_SPLIT | GM_NEEDS_NYSTROM | GM_NEEDS_ATTRACTION)) {
        gm_late_tape(&self->velocity);
        gm_late_tape(&self->force);
    } else if (needs & GM_NEEDS_FAST_LINEAR) {
        gm_late_tape(&self->slow_force);
    } else if (needs & GM_NEEDS_VOLUME) {
        for (size_t i = 0; self->pieces && i < problem->n; i++) {
            gm_late_tape(&self->pieces[i]);
        }
    } else {
        gm_late_tape(&self->field);
        if (self->model->has_jacobian) {
            gm_late_tape(&self->jacobian);
        }
    }
}

static void drift(const struct gm_problem *problem, const double *y, double *values)
{
    gm_tape_values(&own_of(problem)->drift, y, values, 1);
}

static void turning(const struct gm_problem *problem, const double *y, double *values)
{
    gm_tape_values(&own_of(problem)->turning, y, values, 1);
}

static gm_node_id conserved(const struct gm_problem *problem, const char *name, struct gm_formula *graph,
                            char *lacks)
{
    return gm_user_conserved(own_of(problem)->model, own_of(problem)->values, name, graph, lacks);
}

static double frequency(const struct gm_problem *problem, size_t i)
{
    return own_of(problem)->frequencies[i];
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

static bool part_rates(const struct gm_problem *problem, const char *name, struct gm_formula *graph,
                       gm_node_id *rates)
{
    const struct own *self = own_of(problem);
    return gm_user_part_rates(self->model, self->values, name, graph, rates);
}

static const char *parts_differ(const struct gm_problem *problem, const char *const *names, size_t count,
                                struct gm_arena *arena)
{
    const struct own *self = own_of(problem);
    return gm_user_parts_differ(self->model, self->values, names, count, arena);
}

static struct gm_late_tape late_tape(const struct own *self, const gm_node_id *nodes, size_t count,
                                     size_t inputs)
{
    return (struct gm_late_tape){.graph = &self->model->system->graph,
                                 .nodes = nodes,
                                 .count = count,
                                 .inputs = inputs,
                                 .values = self->values};
}

static void kepler_solution(const struct gm_problem *problem, double t, const double *y0, double *y, size_t m)
{
    (void)problem;
    for (size_t i = 0; i < m; i++) {
        double one[4] = {y0[i], y0[m + i], y0[2 * m + i], y0[3 * m + i]};
        const bool found = gm_kepler_flow(t, one);
        for (size_t c = 0; c < 4; c++) {
            y[c * m + i] = found ? one[c] : NAN;
        }
    }
}

/* Returns true if the forces at two nodes vanish for all states, with these values of the parameters. */
static bool vanish(struct gm_arena *arena, const struct gm_user_system *system, const gm_node_id nodes[2],
                   const double *values)
{
    double *fixed = gm_arena_take(arena, system->variable_count, sizeof *fixed);
    bool zero = true;
    for (size_t i = 0; i < system->variable_count; i++) {
        fixed[i] = i >= system->parameters && i < system->velocities ? values[i] : NAN;
    }
    for (int k = 0; k < 2 && zero; k++) {
        const enum gm_identity identity =
            gm_identity_of(&system->graph, nodes[k], fixed, system->variable_count);
        zero = identity == GM_ZERO_PROVED || identity == GM_ZERO_TESTED;
    }
    return zero;
}

/* A tape of the problem's graph and values. */
static void open_tape(struct own *self, struct gm_tape *tape, const gm_node_id *nodes, size_t count,
                      size_t inputs)
{
    gm_tape_keep(self->arena, tape,
                 gm_tape_open(tape, &self->model->system->graph, nodes, count, inputs, self->values));
}

/* The values of nodes that hold no component. */
static void find_constants(struct own *self, const gm_node_id *nodes, size_t count, double *constants)
{
    struct gm_tape *tape = gm_arena_take(self->arena, 1, sizeof *tape);
    open_tape(self, tape, nodes, count, 0);
    gm_tape_values(tape, NULL, constants, 1);
}

/* The facets of H = |p|^2/2 + V(q). */
static void open_mechanical(struct own *self, struct gm_problem *problem)
{
    const struct gm_user_model *model = self->model;
    const struct gm_finding *findings = model->findings;
    const size_t half = model->system->n / 2;
    if (gm_user_model_holds(model, self->values, GM_FACT_FAST_LINEAR)) {
        const gm_node_id *nodes = findings[GM_FACT_FAST_LINEAR].nodes;
        bool real = true;
        self->frequencies = gm_arena_take(self->arena, half, sizeof *self->frequencies);
        find_constants(self, nodes, half, self->frequencies);
        self->slow_force = late_tape(self, nodes + half, half, half);
        for (size_t i = 0; i < half; i++) {
            real = real && isfinite(self->frequencies[i]);
        }
        self->fast_linear = (struct gm_fast_linear){.frequency = frequency, .slow_force = slow_force};
        self->ode.fast_linear = real ? &self->fast_linear : NULL;
    }
    if (gm_user_model_holds(model, self->values, GM_FACT_KEPLER_SPLIT)) {
        const gm_node_id *nodes = findings[GM_FACT_KEPLER_SPLIT].nodes;
        open_tape(self, &self->attraction, nodes, 1, 2);
        open_tape(self, &self->perturbation, nodes + 1, 2, 2);
        self->kepler_split =
            (struct gm_kepler_split){.potential = attraction, .perturbing_force = perturbing_force};
        self->ode.kepler_split = &self->kepler_split;
        static const struct gm_exact kepler = {.solution = kepler_solution};
        problem->exact = vanish(self->arena, model->system, nodes + 1, self->values) ? &kepler : NULL;
    }
    if (gm_user_model_holds(model, self->values, GM_FACT_LAGRANGIAN)) {
        open_tape(self, &self->potential, findings[GM_FACT_LAGRANGIAN].nodes, 3, 1);
        self->one_degree.potential = potential;
        self->ode.lagrangian = &self->one_degree;
    }
}

/* Opens the facet of motions in a magnetic field. */
static void open_magnetic(struct own *self)
{
    const struct gm_user_model *model = self->model;
    const size_t half = model->system->n / 2;
    const gm_node_id *nodes = model->findings[GM_FACT_MAGNETIC].nodes;
    if (!gm_user_model_holds(model, self->values, GM_FACT_MAGNETIC)) {
        return;
    }
    self->magnetic = (struct gm_magnetic){
        .canonical = model->system->kind == GM_CANONICAL, .drift = drift, .forces = turning};
    find_constants(self, nodes + (2 + half) * half, 1, &self->magnetic.c);
    open_tape(self, &self->drift, nodes, half, model->components);
    open_tape(self, &self->turning, nodes + half, half + half * half, model->components);
    self->ode.magnetic = self->magnetic.c != 0 ? &self->magnetic : NULL;
}

/* Opens the facet of variational schemes. */
static void open_action(struct own *self)
{
    const struct gm_user_model *model = self->model;
    const bool constrained = model->constraints.count > 0;
    if (!gm_user_model_has_action(model) ||
        (model->system->kind == GM_CANONICAL && !gm_user_model_holds(model, self->values, GM_FACT_NYSTROM))) {
        return;
    }
    self->action = (struct gm_action){.motion = model->system->kind == GM_LAGRANGIAN ? motion : NULL,
                                      .free = constrained ? &self->free : NULL,
                                      .constraints = model->constraints.count,
                                      .constrain = constrain};
    self->ode.action = &self->action;
    if (constrained) {
        gm_user_constraints_open(self->arena, &self->constraints, &model->constraints, self->values);
    }
    if (gm_user_model_holds(model, self->values, GM_FACT_CONFORMAL)) {
        find_constants(self, model->findings[GM_FACT_CONFORMAL].nodes, 1, &self->friction);
        self->action.friction = friction;
    }
}

/* The moments of inertia of a body that nothing turns: slopes that are linear, each of its own component. */
static void find_moments(struct own *self, const struct gm_problem *problem)
{
    struct gm_poisson *poisson = &self->poisson;
    double at[3] = {0}, slopes[3];
    if (self->model->system->n != 3 || poisson->turning == 0 || !poisson->axes || !self->ode.quadratic) {
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

/* Opens the facet of schemes for brackets. */
static void open_poisson(struct own *self, const struct gm_problem *problem)
{
    const struct gm_user_bracket_model *model = &self->model->bracket;
    if (!model->gradient) {
        return;
    }
    self->poisson = (struct gm_poisson){.energy = energy_of_bracket,
                                        .gradient = gradient,
                                        .bracket = bracket,
                                        .turning = model->turning,
                                        .spins = model->spins,
                                        .axes = model->axes,
                                        .pieces = model->piece_count,
                                        .flow = flow_of_piece};
    self->ode.poisson = &self->poisson;
    gm_user_bracket_open(self->arena, &self->bracket, model, self->values);
    find_moments(self, problem);
}

/* Opens the facet of adaptive schemes. */
static void open_monitor(struct own *self)
{
    const struct gm_user_model *model = self->model;
    if (!model->slopes) {
        return;
    }
    self->monitor = (struct gm_monitor){.density = density, .of_places = true};
    for (size_t i = model->system->n / 2; i < model->components; i++) {
        self->monitor.of_places =
            self->monitor.of_places && gm_is_constant(&model->system->graph, model->slopes[i], 0);
    }
    self->ode.monitor = &self->monitor;
    open_tape(self, &self->density, &model->monitor, 1, model->components);
    open_tape(self, &self->slopes, model->slopes, model->components, model->components);
}

static bool is_unit_mass(const struct own *self)
{
    const struct gm_user_model *model = self->model;
    const size_t half = model->system->n / 2;
    bool unit = true;
    for (size_t i = 0; i < half; i++) {
        const struct gm_node *rate = &model->system->graph.nodes[self->rates->nodes[i]];
        unit = unit && rate->operation == GM_VARIABLE && rate->a == half + i;
    }
    return unit;
}

static void close_late(void *tape)
{
    gm_late_tape_close(tape);
}

static void open_tapes(struct own *self)
{
    const struct gm_user_model *model = self->model;
    const struct gm_user_rates *rates = self->rates;
    const struct gm_user_system *system = model->system;
    const size_t n = model->components, half = system->n / 2;
    struct gm_late_tape *const late[] = {&self->field,  &self->velocity, &self->force,
                                         &self->energy, &self->jacobian, &self->slow_force};
    for (size_t i = 0; i < GM_COUNT(late); i++) {
        gm_arena_keep(self->arena, late[i], close_late);
    }
    if (system->kind == GM_LAGRANGIAN) {
        gm_user_lagrangian_open(self->arena, &self->lagrangian, &model->lagrangian, self->values);
        return;
    }
    self->field = late_tape(self, rates->nodes, n, n);
    self->velocity = late_tape(self, rates->nodes, half, n);
    self->force = late_tape(self, rates->nodes + half, half, n);
    self->energy = late_tape(self, &system->energy, 1, n);
    self->jacobian = late_tape(self, rates->slopes, rates->jacobian.count, n);
    if (self->ode.volume) {
        self->pieces = gm_arena_take(self->arena, n, sizeof *self->pieces);
        for (size_t i = 0; i < n; i++) {
            self->pieces[i] = late_tape(self, &rates->nodes[i], 1, n);
            gm_arena_keep(self->arena, &self->pieces[i], close_late);
        }
    }
}

/* Returns true if the energy at rest is negative at the start that these values give. A Hamiltonian's formula
   itself is evaluated: no tape is made for one number. */
static bool attracts(const struct own *self, const struct gm_problem *problem)
{
    const struct gm_user_system *system = self->model->system;
    const gm_node_id energy = system->energy;
    const size_t places = problem->n / 2;
    size_t count = 0;
    double *rest = gm_arena_take(self->arena, system->variable_count, sizeof *rest);
    memcpy(rest, self->values, system->variable_count * sizeof *rest);
    memset(rest + places, 0, (problem->n - places) * sizeof *rest);
    if (system->kind == GM_LAGRANGIAN) {
        return gm_energy(problem, rest) < 0;
    }
    const gm_node_id *parts =
        gm_arena_keep(self->arena, gm_formula_parts(&system->graph, energy, &count), free);
    /* filled at the parts only */
    double *at = gm_arena_keep(self->arena, malloc((energy + (size_t)1) * sizeof *at), free);
    gm_formula_evaluate_parts(&system->graph, parts, count, rest, at);
    const bool negative = at[energy] < 0;
    gm_arena_drop(self->arena, at);
    return negative;
}

/* Returns true if the rates are A y in three dimensions with tr A = 0, to round-off; notes A. */
static bool is_trace_free(struct own *self, const struct gm_problem *problem)
{
    const double origin[3] = {0}, *a = self->matrix;
    double rates[3];
    if (problem->n != 3) {
        return false;
    }
    self->loops.jacobian(problem, origin, self->matrix);
    self->loops.field(problem, origin, rates, 1);
    return rates[0] == 0 && rates[1] == 0 && rates[2] == 0 &&
           fabs(a[0] + a[4] + a[8]) <= 1e-15 * (fabs(a[0]) + fabs(a[4]) + fabs(a[8]));
}

struct opening {
    struct gm_problem *problem;
    const struct gm_user_model *model;
    const double *values;
};

static void open_problem(struct gm_arena *arena, void *data)
{
    const struct opening *opening = data;
    const struct gm_user_model *model = opening->model;
    const struct gm_user_system *system = model->system;
    struct gm_problem *problem = opening->problem;
    struct own *self = gm_arena_take(arena, 1, sizeof *self);
    const double *values = self->values = gm_arena_take(arena, system->variable_count, sizeof *self->values);
    memcpy(self->values, opening->values, system->variable_count * sizeof *values);
    self->arena = arena;
    self->model = model;
    self->rates = gm_user_model_rates(model, values);
    problem->parameters = self;
    problem->facets = &self->ode;
    const bool lagrangian = system->kind == GM_LAGRANGIAN;
    self->loops = (struct gm_loops){.field = lagrangian ? lagrangian_field : field,
                                    .jacobian = !model->has_jacobian ? NULL
                                                : lagrangian         ? lagrangian_jacobian
                                                                     : jacobian};
    const bool constrained = model->constraints.count > 0;
    if (constrained) {
        self->free = self->loops;
        self->loops = (struct gm_loops){.field = gm_manifold_field};
    }
    self->ode =
        (struct gm_ode){.written = true,
                        .components = model->names[0] ? model->names : NULL,
                        .quadratic = !constrained && gm_user_model_holds(model, values, GM_FACT_QUADRATIC),
                        .linear = !constrained && gm_user_model_holds(model, values, GM_FACT_LINEAR) &&
                                  gm_user_model_holds(model, values, GM_FACT_AUTONOMOUS),
                        .rough = !gm_user_model_holds(model, values, GM_FACT_SMOOTH),
                        .conserved = conserved,
                        .prepare = lagrangian ? NULL : prepare};
    for (int isa = 0; isa < GM_ISA_COUNT; isa++) {
        self->ode.loops[isa] = &self->loops;
    }
    self->ode.forced = system->kind <= GM_LAGRANGIAN && gm_user_model_is_forced(model);
    if (system->kind <= GM_LAGRANGIAN && !self->ode.forced) {
        /* a Hamiltonian with the time generates no field of the whole state: it only splits */
        self->split.nystrom = gm_user_model_holds(model, values, GM_FACT_NYSTROM);
        self->split.unit_mass = !lagrangian && is_unit_mass(self);
        self->hamiltonian.energy = lagrangian ? lagrangian_energy : energy;
        self->hamiltonian.partial = system->tangents > 0;
        self->hamiltonian.formula = lagrangian || constrained ? NULL : energy_formula;
        self->ode.split = gm_user_model_splits(model, values) ? &self->split : NULL;
        self->ode.hamiltonian = system->timed ? NULL : &self->hamiltonian;
        self->loops.velocity = !self->ode.split ? NULL : lagrangian ? lagrangian_velocity : velocity;
        self->loops.force = !self->ode.split ? NULL : lagrangian ? lagrangian_force : force;
    }
    if (gm_user_model_holds(model, values, GM_FACT_SECOND_ORDER)) {
        self->split = (struct gm_split){.nystrom = true, .unit_mass = true, .no_potential = true};
        self->ode.split = &self->split;
        self->loops.velocity = velocity;
        self->loops.force = force;
    }
    if (!constrained && gm_user_model_holds(model, values, GM_FACT_VOLUME)) {
        self->volume = (struct gm_volume){.pieces = model->components, .flow = flow};
        self->ode.volume = &self->volume;
    }
    self->interpreted = self->loops;
    open_tapes(self);
    open_mechanical(self, problem);
    open_magnetic(self);
    open_action(self);
    open_monitor(self);
    open_poisson(self, problem);
    self->parts = (struct gm_parts){.rates = part_rates, .differ = parts_differ};
    if (system->tangents == 0 && !constrained && gm_user_parts_open(arena, model, values, &self->parts)) {
        self->ode.parts = &self->parts;
    }
    if (self->ode.linear && !self->ode.volume && is_trace_free(self, problem)) {
        self->volume = (struct gm_volume){.pieces = GM_TRACE_FREE_PIECES, .flow = trace_free_flow};
        self->ode.volume = &self->volume;
    }
    self->split.attracts =
        self->ode.split && self->ode.hamiltonian && system->tangents == 0 && attracts(self, problem);
}

bool gm_user_problem_open(struct gm_problem *problem, const struct gm_user_model *model, const double *values)
{
    struct gm_arena *arena = gm_arena_open();
    *problem = (struct gm_problem){.name = "system", .kind = &gm_kind_ode, .n = model->components, .m = 1};
    const bool opened = gm_arena_run(arena, open_problem, &(struct opening){problem, model, values});
    if (!opened) {
        gm_arena_close(arena);
        *problem = (struct gm_problem){0};
    }
    return opened;
}

static void close_motion(void *data)
{
    struct gm_user_motion *motion = data;
    gm_user_problem_close(&motion->problem);
    gm_user_model_close(&motion->model);
    gm_system_close(&motion->system);
}

const struct gm_user_motion *gm_user_problem_motion(struct gm_arena *arena, const struct gm_problem *problem)
{
    const struct own *self = own_of(problem);
    const struct gm_user_system *whole = self->model->system;
    if (whole->tangents == 0) {
        return NULL;
    }
    struct gm_user_motion *motion = gm_arena_take(arena, 1, sizeof *motion);
    gm_arena_keep(arena, motion, close_motion);
    motion->whole = whole;
    gm_user_system_again(arena, whole, self->values, true, &motion->system);
    gm_arena_need(arena, gm_user_model_open(&motion->model, &motion->system));
    double *start = gm_arena_keep(arena, gm_equations_start(&motion->system, NULL), free);
    gm_arena_need(arena, gm_user_problem_open(&motion->problem, &motion->model, start));
    motion->problem.name = problem->name;
    return motion;
}

/* Makes the tapes from which kernels are written; NULL: a missing one. Returns false when out of memory. */
static bool tapes_of_kernels(struct own *self, const struct gm_tape *tapes[GM_KERNEL_FUNCTIONS])
{
    struct gm_late_tape *const late[GM_KERNEL_FUNCTIONS] = {
        [GM_KERNEL_FIELD] = &self->field,
        [GM_KERNEL_VELOCITY] = self->ode.split ? &self->velocity : NULL,
        [GM_KERNEL_FORCE] = self->ode.split ? &self->force : NULL,
        [GM_KERNEL_JACOBIAN] = self->model->has_jacobian ? &self->jacobian : NULL};
    bool good = true;
    for (size_t i = 0; i < GM_KERNEL_FUNCTIONS; i++) {
        tapes[i] = late[i] ? gm_late_tape(late[i]) : NULL;
        good = good && (tapes[i] || !late[i]);
    }
    return good;
}

char *gm_user_problem_kernel(const struct gm_problem *problem, int over, const char **lacks)
{
    struct own *self = own_of(problem);
    *lacks = gm_user_model_refuses_kernels(self->model);
    if (*lacks) {
        return NULL;
    }
    struct gm_kernel_source source = {.components = problem->n,
                                      .jacobian = &self->rates->jacobian,
                                      .jacobian_wanted =
                                          over != GM_OVER_EXPLICIT && over != GM_OVER_SPLITTING};
    return tapes_of_kernels(self, source.tapes) ? gm_kernel_text(&source, lacks) : NULL;
}

void **gm_user_problem_note(const struct gm_problem *problem)
{
    return &own_of(problem)->note;
}

void gm_user_problem_take(struct gm_problem *problem, const struct gm_loops *loops)
{
    struct own *self = own_of(problem);
    const struct gm_tape *tapes[GM_KERNEL_FUNCTIONS];
    loops = loops && tapes_of_kernels(self, tapes) ? loops : NULL;
    self->loops = self->interpreted;
    self->volume.flow = self->pieces ? flow : self->volume.flow;
    self->taken = loops;
    if (loops) {
        for (size_t i = 0; i < GM_KERNEL_FUNCTIONS; i++) {
            self->constants[i] = tapes[i] ? tapes[i]->constants : NULL;
        }
        self->loops.field = loops->field;
        self->volume.flow = loops->shear && self->pieces ? loops->shear : self->volume.flow;
        self->loops.jacobian = loops->jacobian ? loops->jacobian : self->interpreted.jacobian;
        memcpy(self->loops.over_kernels, loops->over_kernels, sizeof self->loops.over_kernels);
    }
}

void gm_user_problem_take_compiled(struct gm_problem *problem, int over)
{
    const char *lacks;
    char *text = gm_compiled_has(problem->n) ? gm_user_problem_kernel(problem, over, &lacks) : NULL;
    const struct gm_loops *loops = text ? gm_compiled_loops(text, problem->m) : NULL;
    if (loops) {
        gm_user_problem_take(problem, loops);
    }
    free(text);
}

const struct gm_loops *gm_user_problem_taken(const struct gm_problem *problem)
{
    return own_of(problem)->taken;
}

void gm_user_problem_close(struct gm_problem *problem)
{
    if (problem->parameters) {
        gm_arena_close(own_of(problem)->arena);
    }
    *problem = (struct gm_problem){0};
}
