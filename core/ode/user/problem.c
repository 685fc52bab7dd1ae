/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The facets of a formula's problem, each a function that interprets a tape. */
#include "core/ode/user/problem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/model/equations.h"
#include "core/ode/families/splitting/kepler.h"
#include "core/ode/kernel/members.h"
#include "core/ode/trace_free.h"
#include "core/ode/user/data.h"
#include "core/ode/variational/manifold.h"
#include "core/user/line.h"

static bool energy_formula(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *node)
{
    const struct gm_user_data *self = gm_user_data_of(problem);
    const struct gm_user_system *system = self->model->system;
    *node = gm_formula_graft(graph, &system->graph, system->energy, problem->n, self->values);
    return *node != GM_NO_NODE;
}

/* A function of a facet: the values of a tape, for m members or for one. */
#define VALUES_OF(name, formula)                                                                             \
    static void name(const struct gm_problem *problem, const double *y, double *values, size_t m)            \
    {                                                                                                        \
        gm_user_values(problem, formula, y, values, m);                                                      \
    }
#define VALUES_OF_ONE(name, formula)                                                                         \
    static void name(const struct gm_problem *problem, const double *y, double *values)                      \
    {                                                                                                        \
        gm_user_values(problem, formula, y, values, 1);                                                      \
    }
VALUES_OF(field, GM_KERNEL_FIELD)
VALUES_OF(velocity, GM_KERNEL_VELOCITY)
VALUES_OF(force, GM_KERNEL_FORCE)
VALUES_OF(energy, GM_KERNEL_ENERGY)
VALUES_OF(slow_force, GM_USER_SLOW_FORCE)
VALUES_OF(attraction, GM_USER_ATTRACTION)
VALUES_OF(perturbing_force, GM_USER_PERTURBATION)
VALUES_OF_ONE(drift, GM_USER_DRIFT)
VALUES_OF_ONE(turning, GM_USER_TURNING)

static void jacobian(const struct gm_problem *problem, const double *y, double *matrix)
{
    const struct gm_sparse *entries = &gm_user_data_of(problem)->formulas->jacobian;
    double values[GM_NEWTON_LARGEST * GM_NEWTON_LARGEST];
    gm_user_values(problem, GM_KERNEL_JACOBIAN, y, values, 1);
    memset(matrix, 0, problem->n * problem->n * sizeof *matrix);
    for (size_t i = 0; i < entries->count; i++) {
        matrix[entries->entries[i].row * problem->n + entries->entries[i].column] = values[i];
    }
}

static void potential(const struct gm_problem *problem, double q, double values[3])
{
    gm_user_values(problem, GM_KERNEL_POTENTIAL, &q, values, 1);
}

/* The constraints, or theta and H: their values, slopes, and the second derivatives of their sum with these weights.
   NaN when out of memory, which is noted. */
static void evaluate(const struct gm_problem *problem, enum gm_user_formula formula, const double *q,
                     const double *weights, double *const results[3])
{
    enum { FEW = 2048 }; /* more values are allocated */
    const struct gm_user_data *self = gm_user_data_of(problem);
    const struct gm_user_functions *functions =
        formula == GM_USER_ONE_FORM ? &self->model->one_form : &self->model->constraints;
    double *g = results[0], *slopes = results[1], *curvature = results[2];
    const size_t n = functions->coordinates, count = self->tapes[formula].count;
    double few[FEW], *values = count <= FEW ? few : malloc(count * sizeof *values);
    memset(slopes, 0, functions->count * n * sizeof *slopes);
    memset(curvature, 0, n * n * sizeof *curvature);
    for (size_t k = 0; !values && k < functions->count; k++) {
        g[k] = NAN;
    }
    if (!values) {
        return;
    }
    gm_user_values(problem, formula, q, values, 1);
    memcpy(g, values, functions->count * sizeof *g);
    const double *next = values + functions->count;
    for (size_t i = 0; i < functions->slopes.count; i++) {
        slopes[functions->slopes.entries[i].row * n + functions->slopes.entries[i].column] = *next++;
    }
    for (size_t i = 0; i < functions->second.count; i++) {
        const struct gm_sparse_entry *entry = &functions->second.entries[i],
                                     *slope = &functions->slopes.entries[entry->row];
        curvature[slope->column * n + entry->column] += weights[slope->row] * *next++;
    }
    if (values != few) {
        free(values);
    }
}

/* gm_action.constrain */
static void constrain(const struct gm_problem *problem, const double *q, const double *multipliers, double *g,
                      double *slopes, double *curvature)
{
    evaluate(problem, GM_USER_CONSTRAINTS, q, multipliers, (double *[]){g, slopes, curvature});
}

/* gm_degenerate.functions */
static void one_form(const struct gm_problem *problem, const double *q, const double *weights, double *values,
                     double *slopes, double *curvature)
{
    evaluate(problem, GM_USER_ONE_FORM, q, weights, (double *[]){values, slopes, curvature});
}

/* x_piece := x_piece + h rate(the others) */
static void flow(const struct gm_problem *problem, size_t piece, double h, double *y, size_t m)
{
    enum { BLOCK = 128 };
    double rate[BLOCK];
    for (size_t first = 0; first < m; first += BLOCK) {
        const size_t count = m - first < BLOCK ? m - first : BLOCK;
        gm_late_tape_block(&gm_user_data_of(problem)->rates[piece], y + first, m, rate, BLOCK, count);
        for (size_t l = 0; l < count; l++) {
            y[piece * m + first + l] += h * rate[l];
        }
    }
}

static void trace_free_flow(const struct gm_problem *problem, size_t piece, double h, double *y, size_t m)
{
    gm_trace_free_flow(gm_user_data_of(problem)->matrix, piece, h, y, m);
}

static void density(const struct gm_problem *problem, const double *y, double *value, double *gradient)
{
    if (gradient) {
        gm_user_values(problem, GM_USER_DENSITY_SLOPES, y, gradient, 1);
    }
    gm_user_values(problem, GM_USER_DENSITY, y, value, 1);
}

/* Makes tapes before the first step, so that it takes no longer than others. */
static void prepare(const struct gm_problem *problem, unsigned needs)
{
    struct gm_user_data *self = gm_user_data_of(problem);
    if (needs & (GM_NEEDS_SPLIT | GM_NEEDS_NYSTROM | GM_NEEDS_ATTRACTION)) {
        gm_late_tape(&self->tapes[GM_KERNEL_VELOCITY]);
        gm_late_tape(&self->tapes[GM_KERNEL_FORCE]);
    } else if (needs & GM_NEEDS_FAST_LINEAR) {
        gm_late_tape(&self->tapes[GM_USER_SLOW_FORCE]);
    } else if (needs & GM_NEEDS_VOLUME) {
        for (size_t i = 0; self->rates && i < problem->n; i++) {
            gm_late_tape(&self->rates[i]);
        }
    } else {
        gm_late_tape(&self->tapes[GM_KERNEL_FIELD]);
        if (self->model->has_jacobian) {
            gm_late_tape(&self->tapes[GM_KERNEL_JACOBIAN]);
        }
    }
}

static double frequency(const struct gm_problem *problem, size_t i)
{
    return gm_user_data_of(problem)->frequencies[i];
}

static void kepler_solution(const struct gm_problem *problem, double t, const double *y0, double *y, size_t m)
{
    (void)problem;
    for (size_t i = 0; i < m; i++) {
        double one[4] = {y0[i], y0[m + i], y0[2 * m + i], y0[3 * m + i]};
        const bool found = gm_kepler_flow(2, 1, t, one, one + 2);
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

static bool holds(const struct gm_user_data *self, enum gm_fact fact)
{
    return gm_user_model_holds(self->model, self->values, fact);
}

/* The values of nodes that hold no component. */
static void find_constants(const struct gm_user_data *self, const gm_node_id *nodes, size_t count,
                           double *constants)
{
    gm_arena_need(self->arena,
                  gm_user_line_numbers(self->model->system, nodes, count, self->values, constants));
}

/* The facets of H = |p|^2/2 + V(q). */
static void open_mechanical(struct gm_user_data *self, struct gm_problem *problem)
{
    static const struct gm_exact kepler = {.solution = kepler_solution};
    const struct gm_finding *findings = self->model->findings;
    const struct gm_user_system *system = self->model->system;
    const size_t half = system->n / 2;
    struct gm_late_tape *tapes = self->tapes;
    if (holds(self, GM_FACT_FAST_LINEAR)) {
        const gm_node_id *nodes = findings[GM_FACT_FAST_LINEAR].nodes;
        bool real = true;
        self->frequencies = gm_arena_take(self->arena, half, sizeof *self->frequencies);
        find_constants(self, nodes, half, self->frequencies);
        gm_user_compile(self, &tapes[GM_USER_SLOW_FORCE], nodes + half, half, half);
        for (size_t i = 0; i < half; i++) {
            real = real && isfinite(self->frequencies[i]);
        }
        self->fast_linear = (struct gm_fast_linear){.frequency = frequency, .slow_force = slow_force};
        self->ode.fast_linear = real ? &self->fast_linear : NULL;
    }
    if (holds(self, GM_FACT_KEPLER_SPLIT)) {
        const gm_node_id *nodes = findings[GM_FACT_KEPLER_SPLIT].nodes;
        gm_user_compile(self, &tapes[GM_USER_ATTRACTION], nodes, 1, 2);
        gm_user_compile(self, &tapes[GM_USER_PERTURBATION], nodes + 1, 2, 2);
        self->kepler_split =
            (struct gm_kepler_split){.potential = attraction, .perturbing_force = perturbing_force};
        self->ode.kepler_split = &self->kepler_split;
        problem->exact = vanish(self->arena, system, nodes + 1, self->values) ? &kepler : NULL;
    }
    if (holds(self, GM_FACT_LAGRANGIAN)) {
        gm_user_compile(self, &tapes[GM_KERNEL_POTENTIAL], findings[GM_FACT_LAGRANGIAN].nodes, 3, 1);
        self->one_degree.potential = potential;
        self->ode.lagrangian = &self->one_degree;
    }
}

/* The square of the distance of two bodies at the start. */
static double square_distance(const struct gm_user_data *self, const gm_node_id *one, const gm_node_id *other)
{
    const struct gm_formula *graph = &self->model->system->graph;
    double square = 0;
    for (size_t c = 0; c < self->gravity.dimensions; c++) {
        const double apart = self->values[graph->nodes[one[c]].a] - self->values[graph->nodes[other[c]].a];
        square += apart * apart;
    }
    return square;
}

/* Opens the facet of bodies that attract each other, unless a mass is not positive. */
static void open_gravity(struct gm_user_data *self)
{
    struct gm_gravity *gravity = &self->gravity;
    if (!holds(self, GM_FACT_GRAVITY)) {
        return;
    }
    const struct gm_formula *graph = &self->model->system->graph;
    const gm_node_id *nodes = self->model->findings[GM_FACT_GRAVITY].nodes, *coordinates = nodes + 1;
    const size_t half = self->model->system->n / 2, d = (size_t)graph->nodes[nodes[0]].value,
                 count = half / d;
    double *inverses = gm_arena_take(self->arena, 3 * count, sizeof *inverses);
    size_t *order = gm_arena_take(self->arena, count + half, sizeof *order);
    *gravity = (struct gm_gravity){count, d, order + count, inverses + count, inverses + 2 * count, 0};
    find_constants(self, coordinates + half, count, inverses);
    find_constants(self, coordinates + half + count, 1, &gravity->G);
    bool real = gravity->G >= 0 && isfinite(gravity->G);
    for (size_t i = 0; i < count; i++) {
        order[i] = i;
    }
    for (size_t i = 0; i < count; i++) {
        for (size_t j = i + 1; j < count; j++) {
            const gm_node_id *first = coordinates + order[0] * d;
            const size_t one = order[i], other = order[j];
            if (i == 0 ? inverses[other] < inverses[one]
                       : square_distance(self, coordinates + other * d, first) <
                             square_distance(self, coordinates + one * d, first)) {
                order[i] = other;
                order[j] = one;
            }
        }
        const double mass = gravity->masses[i] = 1 / inverses[order[i]];
        gravity->sums[i] = mass + (i > 0 ? gravity->sums[i - 1] : 0);
        real = real && mass > 0 && isfinite(mass);
        for (size_t c = 0; c < d; c++) {
            gravity->places[i * d + c] = graph->nodes[coordinates[order[i] * d + c]].a;
        }
    }
    self->ode.gravity = real ? gravity : NULL;
}

/* Opens the facet of motions in a magnetic field. */
static void open_magnetic(struct gm_user_data *self)
{
    const struct gm_user_model *model = self->model;
    const size_t half = model->system->n / 2;
    const gm_node_id *nodes = model->findings[GM_FACT_MAGNETIC].nodes;
    if (holds(self, GM_FACT_MAGNETIC)) {
        self->magnetic = (struct gm_magnetic){
            .canonical = model->system->kind == GM_CANONICAL, .drift = drift, .forces = turning};
        find_constants(self, nodes + (2 + half) * half, 1, &self->magnetic.c);
        gm_user_compile(self, &self->tapes[GM_USER_DRIFT], nodes, half, model->components);
        gm_user_compile(self, &self->tapes[GM_USER_TURNING], nodes + half, half + half * half,
                        model->components);
        self->ode.magnetic = self->magnetic.c != 0 ? &self->magnetic : NULL;
    }
}

/* Opens the facet of variational schemes. */
static void open_action(struct gm_user_data *self)
{
    const struct gm_user_model *model = self->model;
    const struct gm_user_functions *constraints = &model->constraints;
    const enum gm_system_kind kind = model->system->kind;
    if (!gm_user_model_has_action(model) || (kind == GM_CANONICAL && !holds(self, GM_FACT_NYSTROM))) {
        return;
    }
    self->action = (struct gm_action){.motion = kind == GM_LAGRANGIAN ? gm_user_lagrangian_motion : NULL,
                                      .free = constraints->count > 0 ? &self->free : NULL,
                                      .constraints = constraints->count,
                                      .constrain = constrain};
    self->ode.action = &self->action;
    if (constraints->count > 0) {
        gm_user_compile(self, &self->tapes[GM_USER_CONSTRAINTS], constraints->nodes,
                        constraints->count + constraints->slopes.count + constraints->second.count,
                        constraints->coordinates);
    }
    if (holds(self, GM_FACT_CONFORMAL)) {
        find_constants(self, model->findings[GM_FACT_CONFORMAL].nodes, 1, &self->friction);
        self->action.friction = &self->friction;
    }
}

/* Opens the facet of Lagrangians linear in the velocities. */
static void open_degenerate(struct gm_user_data *self)
{
    const struct gm_user_functions *functions = &self->model->one_form;
    if (functions->count > 0) {
        self->degenerate =
            (struct gm_degenerate){.half_gauge = holds(self, GM_FACT_HALF_GAUGE), .functions = one_form};
        self->ode.degenerate = &self->degenerate;
        gm_user_compile(self, &self->tapes[GM_USER_ONE_FORM], functions->nodes,
                        functions->count + functions->slopes.count + functions->second.count,
                        functions->coordinates);
    }
}

/* Opens the facet of adaptive schemes. */
static void open_monitor(struct gm_user_data *self)
{
    const struct gm_user_model *model = self->model;
    const size_t n = model->components;
    if (!model->slopes) {
        return;
    }
    self->monitor = (struct gm_monitor){.density = density, .of_places = true};
    for (size_t i = model->system->n / 2; i < n; i++) {
        self->monitor.of_places &= gm_is_constant(&model->system->graph, model->slopes[i], 0);
    }
    self->ode.monitor = &self->monitor;
    gm_user_compile(self, &self->tapes[GM_USER_DENSITY], &model->monitor, 1, n);
    gm_user_compile(self, &self->tapes[GM_USER_DENSITY_SLOPES], model->slopes, n, n);
}

static bool is_unit_mass(const struct gm_user_data *self)
{
    const struct gm_user_model *model = self->model;
    const size_t half = model->system->n / 2;
    bool unit = true;
    for (size_t i = 0; i < half; i++) {
        const struct gm_node *rate = &model->system->graph.nodes[self->formulas->nodes[i]];
        unit = unit && rate->operation == GM_VARIABLE && rate->a == half + i;
    }
    return unit;
}

static void name_tapes(struct gm_user_data *self)
{
    const struct gm_user_rates *formulas = self->formulas;
    const struct gm_user_system *system = self->model->system;
    const size_t n = self->model->components, half = system->n / 2;
    struct gm_late_tape *tapes = self->tapes;
    if (system->kind == GM_LAGRANGIAN) {
        gm_user_lagrangian_open(self);
        return;
    }
    gm_user_compile(self, &tapes[GM_KERNEL_FIELD], formulas->nodes, n, n);
    gm_user_compile(self, &tapes[GM_KERNEL_VELOCITY], formulas->nodes, half, n);
    gm_user_compile(self, &tapes[GM_KERNEL_FORCE], formulas->nodes + half, half, n);
    gm_user_compile(self, &tapes[GM_KERNEL_ENERGY], &system->energy, 1, n);
    gm_user_compile(self, &tapes[GM_KERNEL_JACOBIAN], formulas->slopes, formulas->jacobian.count, n);
    if (self->ode.volume) {
        self->rates = gm_arena_take(self->arena, n, sizeof *self->rates);
        for (size_t i = 0; i < n; i++) {
            gm_user_compile(self, &self->rates[i], &formulas->nodes[i], 1, n);
        }
    }
}

/* Returns true if the energy at rest is negative at the start that these values give. A Hamiltonian's formula
   itself is evaluated: no tape of all states is made for one number. */
static bool attracts(const struct gm_user_data *self, const struct gm_problem *problem)
{
    const struct gm_user_system *system = self->model->system;
    const size_t places = problem->n / 2;
    double *rest = gm_arena_take(self->arena, system->variable_count, sizeof *rest), value;
    memcpy(rest, self->values, system->variable_count * sizeof *rest);
    memset(rest + places, 0, (problem->n - places) * sizeof *rest);
    if (system->kind == GM_LAGRANGIAN) {
        return gm_energy(problem, rest) < 0;
    }
    gm_arena_need(self->arena, gm_user_line_numbers(system, &system->energy, 1, rest, &value));
    return value < 0;
}

/* Returns true if the rates are A y in three dimensions with tr A = 0, to round-off; notes A. */
static bool is_trace_free(struct gm_user_data *self, const struct gm_problem *problem)
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

static const struct gm_problem *freeze(const struct gm_problem *problem, void **frozen, const double *modes);
static void melt(void *frozen);
static bool watches(const struct gm_problem *motion);

struct opening {
    struct gm_problem *problem;
    const struct gm_user_model *model;
    const double *values;
};

static void open_problem(struct gm_arena *arena, void *data)
{
    static const struct gm_loops tapes = {
        .field = field, .velocity = velocity, .force = force, .jacobian = jacobian};
    const struct opening *opening = data;
    const struct gm_user_model *model = opening->model;
    const struct gm_user_system *system = model->system;
    struct gm_problem *problem = opening->problem;
    struct gm_user_data *self = gm_arena_take(arena, 1, sizeof *self);
    const double *values = self->values = gm_arena_take(arena, system->variable_count, sizeof *self->values);
    memcpy(self->values, opening->values, system->variable_count * sizeof *values);
    self->arena = arena;
    self->model = model;
    self->formulas = gm_user_model_rates(model, values);
    problem->parameters = self;
    problem->facets = &self->ode;
    const bool lagrangian = system->kind == GM_LAGRANGIAN, constrained = model->constraints.count > 0;
    const struct gm_loops *all = lagrangian ? &gm_user_lagrangian_loops : &tapes;
    self->loops =
        (struct gm_loops){.field = all->field, .jacobian = model->has_jacobian ? all->jacobian : NULL};
    if (constrained) {
        self->free = self->loops;
        self->loops = (struct gm_loops){.field = gm_manifold_field};
    }
    bool *angles = gm_arena_take(arena, system->n + 1, sizeof *angles);
    for (size_t i = 0; i < system->n; i++) {
        angles[i] = system->variables[i].angle;
    }
    self->ode = (struct gm_ode){.written = true,
                                .components = model->names[0] ? model->names : NULL,
                                .angles = angles,
                                .energy_jumps = model->energy_jumps,
                                .quadratic = !constrained && holds(self, GM_FACT_QUADRATIC),
                                .linear = !constrained && holds(self, GM_FACT_LINEAR) &&
                                          holds(self, GM_FACT_AUTONOMOUS),
                                .rough = !holds(self, GM_FACT_SMOOTH),
                                .conserved = gm_user_conserved,
                                .prepare = lagrangian ? NULL : prepare};
    for (int isa = 0; isa < GM_ISA_COUNT; isa++) {
        self->ode.loops[isa] = &self->loops;
    }
    self->ode.forced = system->kind <= GM_LAGRANGIAN && gm_user_model_is_forced(model);
    if (system->kind <= GM_LAGRANGIAN && !self->ode.forced) {
        /* a Hamiltonian with the time generates no field of the whole state: it only splits */
        self->split.nystrom = holds(self, GM_FACT_NYSTROM);
        self->split.unit_mass = !lagrangian && is_unit_mass(self);
        self->hamiltonian.energy = lagrangian ? gm_user_lagrangian_energy : energy;
        self->hamiltonian.partial = system->tangents > 0;
        self->hamiltonian.formula = lagrangian || constrained ? NULL : energy_formula;
        self->ode.split = gm_user_model_splits(model, values) ? &self->split : NULL;
        self->ode.hamiltonian = system->timed ? NULL : &self->hamiltonian;
    }
    if (holds(self, GM_FACT_SECOND_ORDER)) {
        self->split = (struct gm_split){.nystrom = true, .unit_mass = true, .no_potential = true};
        self->ode.split = &self->split;
    }
    if (self->ode.split) {
        self->loops.velocity = all->velocity;
        self->loops.force = all->force;
    }
    if (!constrained && holds(self, GM_FACT_VOLUME)) {
        self->volume = (struct gm_volume){.pieces = model->components, .flow = flow};
        self->ode.volume = &self->volume;
    }
    self->interpreted = self->loops;
    name_tapes(self);
    open_mechanical(self, problem);
    open_gravity(self);
    open_magnetic(self);
    open_action(self);
    open_degenerate(self);
    open_monitor(self);
    gm_user_bracket_open(problem);
    gm_user_events_open(problem);
    self->events.freeze = freeze;
    self->events.melt = melt;
    self->events.watches = watches;
    if (system->tangents == 0 && !constrained) {
        gm_user_parts_open(problem);
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
    *problem = (struct gm_problem){.name = "system", .kind = &gm_kind_ode, .n = model->components, .m = 1};
    const bool opened = gm_arena_made(open_problem, &(struct opening){problem, model, values});
    if (!opened) {
        *problem = (struct gm_problem){0};
    }
    return opened;
}

/* ---- problems with frozen switches ---- */

enum { KEPT = 8 };

/* Problems with frozen switches, the last ones that were asked for. */
struct frozen_problems {
    size_t latest, next;
    struct gm_problem list[KEPT]; /* without components: none */
    double modes[KEPT][GM_MOST_BREAKS];
};

/* Opens a problem with these switches. */
static bool open_frozen(const struct gm_problem *problem, const double *modes, struct gm_problem *opened)
{
    const struct gm_user_data *data = gm_user_data_of(problem);
    const struct gm_user_frozen *frozen = data->model->frozen;
    const size_t own = data->model->system->variable_count;
    double *values = malloc(frozen->system.variable_count * sizeof *values);
    if (!values) {
        return false;
    }
    memcpy(values, data->values, own * sizeof *values);
    memset(values + own, 0, (frozen->system.variable_count - own) * sizeof *values);
    memcpy(values + own, modes, frozen->breaks * sizeof *values);
    const bool good = gm_user_problem_open(opened, &frozen->model, values);
    free(values);
    if (good) {
        opened->name = problem->name;
        opened->bound = problem->bound;
        opened->events = NULL;
        struct gm_user_data *self = gm_user_data_of(opened);
        gm_user_compile(self, &self->tapes[GM_KERNEL_SURFACES], frozen->inside, frozen->breaks, opened->n);
    }
    return good;
}

static const struct gm_problem *freeze(const struct gm_problem *problem, void **frozen, const double *modes)
{
    const struct gm_loops *loops = gm_user_data_of(problem)->frozen_loops;
    const size_t size = gm_user_data_of(problem)->model->frozen->breaks * sizeof *modes;
    struct frozen_problems *kept = *frozen = *frozen ? *frozen : calloc(1, sizeof *kept);
    size_t i = 0;
    while (kept && i < KEPT && (kept->list[i].n == 0 || memcmp(kept->modes[i], modes, size) != 0)) {
        i++;
    }
    if (kept && i == KEPT) {
        i = kept->next = (kept->next + 1 + ((kept->next + 1) % KEPT == kept->latest)) % KEPT; /* not in use */
        gm_user_problem_close(&kept->list[i]);
        memcpy(kept->modes[i], modes, size);
    }
    if (!kept || (kept->list[i].n == 0 && !open_frozen(problem, modes, &kept->list[i]))) {
        return NULL;
    }
    if (gm_user_data_of(&kept->list[i])->taken != loops) {
        gm_user_problem_take(&kept->list[i], loops);
    }
    return &kept->list[kept->latest = i];
}

static bool watches(const struct gm_problem *motion)
{
    const struct gm_loops *taken = gm_user_data_of(motion)->taken;
    return taken && taken->watches;
}

static void melt(void *frozen)
{
    struct frozen_problems *kept = frozen;
    for (size_t i = 0; kept && i < KEPT; i++) {
        gm_user_problem_close(&kept->list[i]);
    }
    free(kept);
}

/* ---- motions and kernels ---- */

static void close_motion(void *data)
{
    struct gm_user_motion *motion = data;
    gm_user_problem_close(&motion->problem);
    gm_system_close(&motion->system);
}

const struct gm_user_motion *gm_user_problem_motion(struct gm_arena *arena, const struct gm_problem *problem)
{
    const struct gm_user_data *self = gm_user_data_of(problem);
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
static bool tapes_of_kernels(struct gm_user_data *self, const struct gm_tape *tapes[GM_KERNEL_FUNCTIONS])
{
    const bool splits = self->ode.split != NULL,
               has[GM_KERNEL_FUNCTIONS] = {[GM_KERNEL_FIELD] = true,
                                           [GM_KERNEL_VELOCITY] = splits,
                                           [GM_KERNEL_FORCE] = splits,
                                           [GM_KERNEL_JACOBIAN] = self->model->has_jacobian,
                                           [GM_KERNEL_SURFACES] = self->tapes[GM_KERNEL_SURFACES].count > 0};
    for (size_t i = 0; i < GM_KERNEL_FUNCTIONS; i++) {
        tapes[i] = has[i] ? gm_late_tape(&self->tapes[i]) : NULL;
        if (has[i] && !tapes[i]) {
            return false;
        }
    }
    return true;
}

char *gm_user_problem_kernel(const struct gm_problem *problem, int over, const char **lacks)
{
    struct gm_user_data *self = gm_user_data_of(problem);
    *lacks = gm_user_model_refuses_kernels(self->model);
    if (*lacks) {
        return NULL;
    }
    struct gm_kernel_source source = {.components = problem->n,
                                      .jacobian = &self->formulas->jacobian,
                                      .jacobian_wanted =
                                          over != GM_OVER_EXPLICIT && over != GM_OVER_SPLITTING};
    return tapes_of_kernels(self, source.tapes) ? gm_kernel_text(&source, lacks) : NULL;
}

void **gm_user_problem_note(const struct gm_problem *problem)
{
    return &gm_user_data_of(problem)->note;
}

void gm_user_problem_take(struct gm_problem *problem, const struct gm_loops *loops)
{
    struct gm_user_data *self = gm_user_data_of(problem);
    const struct gm_tape *tapes[GM_KERNEL_FUNCTIONS];
    loops = loops && tapes_of_kernels(self, tapes) ? loops : NULL;
    self->loops = self->interpreted;
    self->volume.flow = self->rates ? flow : self->volume.flow;
    self->taken = loops;
    if (loops) {
        for (size_t i = 0; i < GM_KERNEL_FUNCTIONS; i++) {
            self->constants[i] = tapes[i] ? tapes[i]->constants : NULL;
        }
        self->loops.field = loops->field;
        self->volume.flow = loops->shear && self->rates ? loops->shear : self->volume.flow;
        self->loops.jacobian = loops->jacobian ? loops->jacobian : self->interpreted.jacobian;
        memcpy(self->loops.over_kernels, loops->over_kernels, sizeof self->loops.over_kernels);
    }
}

void gm_user_problem_take_frozen(struct gm_problem *problem, const struct gm_loops *loops)
{
    gm_user_data_of(problem)->frozen_loops = loops;
}

void gm_user_problem_take_compiled(struct gm_problem *problem, int over)
{
    const char *lacks;
    char *text = gm_compiled_has(problem->n) ? gm_user_problem_kernel(problem, over, &lacks) : NULL;
    const struct gm_loops *loops = text ? gm_compiled_loops(gm_kernel_digest(text), problem->m) : NULL;
    if (loops) {
        gm_user_problem_take(problem, loops);
    }
    free(text);
}

const struct gm_loops *gm_user_problem_taken(const struct gm_problem *problem)
{
    return gm_user_data_of(problem)->taken;
}

void gm_user_problem_close(struct gm_problem *problem)
{
    if (problem->parameters) {
        gm_arena_close(gm_user_data_of(problem)->arena);
    }
    *problem = (struct gm_problem){0};
}
