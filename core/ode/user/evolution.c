/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rates of fields on a ring, by tapes over all nodes. Whatever is linear - derivatives by waves, the mass,
   the part L of the rates - multiplies waves exp(i k x): a derivative of order j by
       differences of order 2   i sin(a)/dx,  2 (cos(a) - 1)/dx^2,  and products of these,  a = k dx
       waves                    (i k)^j, odd ones without the wave that alternates from node to node
   What a call needs beside its arguments is lent to it, so that threads may share the problem. */
#include "core/ode/user/evolution.h"

#include <complex.h>
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/functions/complex.h"
#include "core/functions/functions.h"
#include "core/linear/fourier.h"
#include "core/model/equations.h"
#include "core/ode/kernel/loops.h"
#include "core/tape.h"

enum { ORDERS = GM_MOST_DERIVATIVES + 1, MOST_INPUTS = GM_MOST_FIELDS * ORDERS + 2 };

/* The scratch of one call. */
struct room {
    struct gm_modes modes;
    double *inputs;                 /* the tapes' inputs, [input * points + node] */
    double *density;                /* points */
    double complex *waves, *slopes; /* of all fields */
};

struct own {
    struct gm_user_line along; /* first */
    struct gm_ode facets;
    struct gm_semilinear semilinear;
    struct gm_loops loops;
    const struct gm_user_evolution *evolution;
    struct gm_grid1 line;
    enum gm_derivatives space;
    size_t fields, inputs;
    const char *names; /* "u[] v[]" */
    bool massive;
    /* the sign of each field's mirror image between walls: 1 or -1; all 0: the rates are not symmetric */
    double mirrored[GM_MOST_FIELDS];
    bool needed[ORDERS * GM_MOST_FIELDS]; /* derivatives that occur */
    struct gm_tape rates, rests, *densities;
    double complex *symbols; /* the matrices of L, [mode][row][column] */
    double complex *masses;  /* [mode][field] */
    struct room *_Atomic idle;
};

static struct own *own_of(const struct gm_problem *problem)
{
    return (struct own *)problem->parameters;
}

/* ---- what is derived ---- */

struct deriving {
    struct gm_user_evolution *evolution;
    struct gm_user_system *system;
    struct gm_arena *arena;
    gm_node_id *others; /* replacements of the system's variables */
};

static void number_inputs(struct deriving *deriving)
{
    struct gm_user_system *system = deriving->system;
    const size_t n = system->n, inputs = n * ORDERS + 2;
    gm_node_id *others = deriving->others = gm_system_no_nodes(system, system->variable_count);
    others[n] = gm_formula_variable(&system->graph, inputs - 1);
    others[system->velocities] = gm_formula_variable(&system->graph, inputs - 2);
    for (size_t i = 0; i < n * GM_MOST_DERIVATIVES; i++) {
        others[system->velocities + 1 + i] = gm_formula_variable(&system->graph, n + i);
    }
    for (size_t i = system->parameters; i < system->velocities; i++) {
        others[i] = gm_formula_variable(&system->graph, inputs + i - system->parameters);
    }
}

static void renumber(const struct deriving *deriving, gm_node_id *nodes, size_t count)
{
    struct gm_user_system *system = deriving->system;
    gm_arena_need(deriving->arena, gm_formula_substitute(&system->graph, nodes, count, deriving->others,
                                                         system->variable_count));
}

static void split(const struct deriving *deriving)
{
    struct gm_user_evolution *evolution = deriving->evolution;
    struct gm_user_system *system = deriving->system;
    for (size_t i = 0; i < system->n; i++) {
        gm_arena_need(deriving->arena, gm_system_linear_part(system, system->rates[i], &evolution->linear[i],
                                                             &evolution->rests[i]));
        evolution->lines[i] = evolution->linear[i];
    }
    renumber(deriving, evolution->lines, system->n);
    renumber(deriving, evolution->rests, system->n);
}

static void find_kink(const struct deriving *deriving)
{
    struct gm_user_evolution *evolution = deriving->evolution;
    struct gm_user_system *system = deriving->system;
    bool *marked = gm_arena_take(deriving->arena, system->variable_count, sizeof *marked);
    evolution->kink = GM_NO_NODE;
    for (size_t i = 0; i < system->n; i++) {
        marked[i] = true;
        for (size_t k = 0; k < GM_MOST_DERIVATIVES; k++) {
            marked[system->velocities + 1 + i * GM_MOST_DERIVATIVES + k] = true;
        }
    }
    for (size_t i = 0; i < system->n && evolution->kink == GM_NO_NODE; i++) {
        evolution->kink = gm_formula_kink(&system->graph, system->rates[i], marked, system->variable_count);
        evolution->kinked = i;
    }
}

static void derive_all(struct gm_arena *arena, void *data)
{
    struct deriving *deriving = data;
    struct gm_user_evolution *evolution = deriving->evolution;
    struct gm_user_system *system = deriving->system;
    const size_t n = system->n;
    deriving->arena = arena;
    evolution->densities = gm_arena_take(arena, system->item_count + 1, sizeof *evolution->densities);
    for (size_t i = 0; i < n; i++) {
        evolution->rates[i] = system->rates[i];
        evolution->masses[i] = gm_formula_variable(&system->graph, i);
    }
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_INVARIANT || item->word == GM_WORD_OBSERVE) {
            evolution->densities[evolution->density_count++] = item->nodes[0];
        }
    }
    gm_arena_need(arena, gm_line_derive(&evolution->formulas, system));
    number_inputs(deriving);
    renumber(deriving, evolution->rates, n);
    renumber(deriving, evolution->densities, evolution->density_count);
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == GM_WORD_MASS) {
            gm_node_id mass = system->items[i].nodes[0];
            const size_t field = gm_system_mass_field(system, mass);
            renumber(deriving, &mass, 1);
            evolution->masses[field] = mass;
        }
    }
    find_kink(deriving);
    split(deriving);
    gm_arena_need(arena, !system->graph.failed);
}

bool gm_user_evolution_derive(struct gm_user_evolution *evolution, struct gm_user_system *system)
{
    *evolution = (struct gm_user_evolution){.system = system};
    return gm_arena_run(system->arena, derive_all,
                        &(struct deriving){.evolution = evolution, .system = system});
}

/* ---- room ---- */

static void room_close(struct room *room)
{
    if (room) {
        gm_modes_close(&room->modes);
        free(room->inputs);
        free(room->waves);
    }
    free(room);
}

static struct room *room_open(const struct own *self)
{
    const size_t points = self->line.points, n = self->fields * points;
    struct room *room = calloc(1, sizeof *room);
    if (!room) {
        return NULL;
    }
    room->inputs = calloc((self->inputs + 1) * points, sizeof *room->inputs);
    room->waves = malloc(2 * n * sizeof *room->waves);
    if (!gm_modes_open(&room->modes, points, self->fields) || !room->inputs || !room->waves) {
        room_close(room);
        return NULL;
    }
    room->density = room->inputs + self->inputs * points;
    room->slopes = room->waves + n;
    double *x = room->inputs + (self->inputs - 2) * points;
    for (size_t i = 0; i < points; i++) {
        x[i] = gm_grid1_node(&self->line, i);
    }
    return room;
}

static struct room *borrow(struct own *self)
{
    struct room *room = atomic_exchange(&self->idle, NULL);
    return room ? room : room_open(self);
}

static void give_back(struct own *self, struct room *room)
{
    room_close(atomic_exchange(&self->idle, room));
}

/* ---- derivatives ---- */

/* Returns the factor of a wave under a derivative of this order. */
static double complex factor_of(const struct own *self, size_t order, size_t mode)
{
    const double points = (double)self->line.points, dx = self->line.dx,
                 angle = 2 * M_PI * (double)mode / points;
    const bool alternating = 2 * mode == self->line.points;
    if (self->space == GM_SPACE_FOURIER) {
        const double complex once = I * angle / dx;
        double complex factor = 1;
        for (size_t k = 0; k < order; k++) {
            factor *= once;
        }
        return alternating && order % 2 ? 0 : factor;
    }
    const double half = gm_sin(angle / 2), twice = -4 * half * half / (dx * dx);
    const double complex first = alternating ? 0 : I * gm_sin(angle) / dx;
    const double complex factors[ORDERS] = {1, first, twice, first * twice, twice * twice};
    return factors[order];
}

static void differences(const struct own *self, const double *u, size_t order, double *to)
{
    const size_t n = self->line.points;
    const double dx = self->line.dx;
    for (size_t i = 0; i < n; i++) {
        const size_t r = i + 1 < n ? i + 1 : 0, r2 = r + 1 < n ? r + 1 : 0, l = i > 0 ? i - 1 : n - 1,
                     l2 = l > 0 ? l - 1 : n - 1;
        to[i] = order == 1   ? (u[r] - u[l]) / (2 * dx)
                : order == 2 ? (u[r] - 2 * u[i] + u[l]) / (dx * dx)
                : order == 3 ? (u[r2] - 2 * u[r] + 2 * u[l] - u[l2]) / (2 * dx * dx * dx)
                             : (u[r2] - 4 * u[r] + 6 * u[i] - 4 * u[l] + u[l2]) / (dx * dx * dx * dx);
    }
}

/* Writes the inputs of tapes from a state. */
static void derive(const struct own *self, struct room *room, const double *y)
{
    const size_t points = self->line.points, n = self->fields * points, half = gm_modes_half(points);
    const struct gm_modes one = {points, 1, room->modes.fourier};
    memcpy(room->inputs, y, n * sizeof *y);
    bool known = false;
    for (size_t k = self->fields; k < self->fields * ORDERS; k++) {
        const size_t order = k / self->fields, field = k % self->fields;
        double *to = room->inputs + k * points;
        if (!self->needed[k]) {
            continue;
        }
        if (self->space == GM_SPACE_DIFFERENCES) {
            differences(self, y + field * points, order, to);
            continue;
        }
        if (!known) {
            gm_modes_forward(&room->modes, y, room->waves);
            known = true;
        }
        for (size_t mode = 0; mode < half; mode++) {
            room->slopes[mode] = room->waves[field * points + mode] * factor_of(self, order, mode);
        }
        gm_modes_back(&one, room->slopes, to);
    }
}

/* Computes the rates, or their rest without L. */
static void evaluate(struct own *self, const struct gm_tape *tape, const double *y, double *rates)
{
    const size_t points = self->line.points, n = self->fields * points, half = gm_modes_half(points);
    struct room *room = borrow(self);
    for (size_t i = 0; !room && i < n; i++) {
        rates[i] = NAN;
    }
    if (!room) {
        return;
    }
    derive(self, room, y);
    gm_tape_block(tape, room->inputs, points, rates, points, points);
    if (self->massive) {
        gm_modes_forward(&room->modes, rates, room->waves);
        for (size_t field = 0; field < self->fields; field++) {
            for (size_t mode = 0; mode < half; mode++) {
                double complex *wave = &room->waves[field * points + mode];
                *wave = gm_cdivide(*wave, self->masses[mode * self->fields + field]);
            }
        }
        gm_modes_back(&room->modes, room->waves, rates);
    }
    give_back(self, room);
}

/* Fields on a line have one member. */
static void field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    struct own *self = own_of(problem);
    (void)m;
    evaluate(self, &self->rates, y, f);
}

static void nonlinear(const struct gm_problem *problem, const double *y, double *rest)
{
    struct own *self = own_of(problem);
    evaluate(self, &self->rests, y, rest);
}

static void symbol(const struct gm_problem *problem, size_t mode, double complex *matrix)
{
    const struct own *self = own_of(problem);
    const size_t size = self->fields * self->fields;
    memcpy(matrix, self->symbols + mode * size, size * sizeof *matrix);
}

/* ---- the problem ---- */

static void open_tape(const struct own *self, struct gm_tape *tape, const gm_node_id *nodes, size_t count,
                      const double *values)
{
    gm_user_line_tape(&self->along, tape, nodes, count, self->inputs, values);
}

/* Computes the coefficients of a linear formula: its values if one input is 1 and the others are 0. */
static void find_coefficients(const struct own *self, const gm_node_id *nodes, const double *values,
                              double *coefficients)
{
    const size_t n = self->fields;
    struct gm_tape *tape = gm_arena_take(self->along.arena, 1, sizeof *tape);
    open_tape(self, tape, nodes, n, values);
    for (size_t k = 0; k < n * ORDERS; k++) {
        double inputs[MOST_INPUTS] = {0}, outputs[GM_MOST_FIELDS];
        inputs[k] = 1;
        gm_tape_values(tape, inputs, outputs, 1);
        for (size_t i = 0; i < n; i++) {
            coefficients[i * n * ORDERS + k] = outputs[i];
        }
    }
}

static void make_symbols(struct own *self, const double *values)
{
    const size_t n = self->fields, half = gm_modes_half(self->line.points);
    double linear[GM_MOST_FIELDS * GM_MOST_FIELDS * ORDERS], mass[GM_MOST_FIELDS * GM_MOST_FIELDS * ORDERS];
    self->symbols = gm_arena_take(self->along.arena, half * n * n, sizeof *self->symbols);
    self->masses = gm_arena_take(self->along.arena, half * n, sizeof *self->masses);
    find_coefficients(self, self->evolution->lines, values, linear);
    find_coefficients(self, self->evolution->masses, values, mass);
    for (size_t mode = 0; mode < half; mode++) {
        for (size_t i = 0; i < n; i++) {
            double complex of_mass = 0, row[GM_MOST_FIELDS] = {0};
            for (size_t k = 0; k < n * ORDERS; k++) {
                const double complex factor = factor_of(self, k / n, mode);
                row[k % n] += linear[i * n * ORDERS + k] * factor;
                of_mass += mass[i * n * ORDERS + k] * factor;
            }
            self->masses[mode * n + i] = of_mass;
            self->massive |= of_mass != 1;
            for (size_t j = 0; j < n; j++) {
                self->symbols[(mode * n + i) * n + j] = gm_cdivide(row[j], of_mass);
            }
        }
    }
}

/* Returns true if a mirrored field, with those signs, has the mirrored rate, at 5 generic states. */
static bool is_mirrored(const struct own *self, const double *signs)
{
    enum { TRIALS = 5 };
    const size_t n = self->fields;
    double here[MOST_INPUTS], there[MOST_INPUTS], rate[GM_MOST_FIELDS], other[GM_MOST_FIELDS];
    for (size_t trial = 0; trial < TRIALS; trial++) {
        for (size_t k = 0; k < self->inputs; k++) {
            const double sign = k < n * ORDERS ? signs[k % n] * (k / n % 2 ? -1 : 1) : 1;
            here[k] = 0.6 + 0.35 * gm_sin(1 + 7 * (double)k + 2.3 * (double)trial);
            there[k] = sign * here[k];
        }
        gm_tape_values(&self->rates, here, rate, 1);
        gm_tape_values(&self->rates, there, other, 1);
        for (size_t i = 0; i < n; i++) {
            if (!(fabs(other[i] - signs[i] * rate[i]) <= 1e-9 * fmax(1, fabs(rate[i])))) {
                return false;
            }
        }
    }
    for (size_t i = 0; i < gm_modes_half(self->line.points) * n; i++) {
        if (fabs(cimag(self->masses[i])) > 1e-9 * gm_cabs(self->masses[i])) {
            return false;
        }
    }
    return true;
}

/* Finds the sign of each field's mirror image; the first fields are 1 if they can be. */
static void find_mirror(struct own *self)
{
    for (size_t odd = 0; odd < (size_t)1 << self->fields; odd++) {
        double signs[GM_MOST_FIELDS];
        for (size_t i = 0; i < self->fields; i++) {
            signs[i] = odd >> (self->fields - 1 - i) & 1 ? -1 : 1;
        }
        if (is_mirrored(self, signs)) {
            memcpy(self->mirrored, signs, sizeof signs);
            return;
        }
    }
}

/* Marks the derivatives that the rates and densities hold. */
static void find_needed(struct own *self)
{
    const struct gm_user_evolution *evolution = self->evolution;
    const struct gm_formula *graph = &evolution->system->graph;
    for (size_t i = 0; i < self->fields + evolution->density_count; i++) {
        const gm_node_id node =
            i < self->fields ? evolution->rates[i] : evolution->densities[i - self->fields];
        size_t count = 0;
        gm_node_id *parts = gm_arena_keep(self->along.arena, gm_formula_parts(graph, node, &count), free);
        for (size_t k = 0; k < count; k++) {
            const struct gm_node *part = &graph->nodes[parts[k]];
            if (part->operation == GM_VARIABLE && part->a < self->fields * ORDERS) {
                self->needed[part->a] = true;
            }
        }
        gm_arena_drop(self->along.arena, parts);
    }
}

static void name_fields(struct own *self)
{
    self->names = "";
    for (size_t i = 0; i < self->fields; i++) {
        self->names = gm_arena_print(self->along.arena, "%s%s%s[]", self->names, i ? " " : "",
                                     self->evolution->system->variables[i].name);
    }
}

static void open_tapes(struct own *self, const double *values)
{
    const struct gm_user_evolution *evolution = self->evolution;
    const size_t n = self->fields;
    self->densities = gm_arena_take(self->along.arena, evolution->density_count, sizeof *self->densities);
    open_tape(self, &self->rates, evolution->rates, n, values);
    open_tape(self, &self->rests, evolution->rests, n, values);
    for (size_t i = 0; i < evolution->density_count; i++) {
        open_tape(self, &self->densities[i], &evolution->densities[i], 1, values);
    }
}

static void close_idle(void *idle)
{
    room_close(atomic_exchange((struct room * _Atomic *)idle, NULL));
}

static void open_problem(struct gm_arena *arena, void *data)
{
    const struct gm_line_opening *opening = data;
    const struct gm_user_evolution *evolution = opening->formulas;
    const struct gm_user_system *system = evolution->system;
    struct gm_problem *problem = opening->problem;
    const size_t parameters = system->velocities - system->parameters;
    struct own *self = gm_user_line_take(arena, problem, system, sizeof *self);
    gm_arena_keep(arena, &self->idle, close_idle);
    self->evolution = evolution;
    self->line = problem->line;
    self->space = *(const enum gm_derivatives *)opening->more;
    self->fields = system->n;
    self->inputs = self->fields * ORDERS + 2;
    problem->n = self->fields * self->line.points;
    problem->facets = &self->facets;
    gm_user_line_open(&self->along, evolution->formulas.start, self->fields, evolution->formulas.exact,
                      opening->values);
    /* the values of all variables in their new order */
    double *values = gm_arena_take(arena, self->inputs + parameters, sizeof *values);
    memcpy(values + self->inputs, opening->values + system->parameters, parameters * sizeof *values);
    open_tapes(self, values);
    make_symbols(self, values);
    find_needed(self);
    name_fields(self);
    if (self->line.walls) {
        find_mirror(self);
    }
    self->semilinear = (struct gm_semilinear){self->fields, symbol, nonlinear};
    self->loops = (struct gm_loops){.field = field};
    self->facets = (struct gm_ode){
        .components = self->names,
        .rough = self->evolution->kink != GM_NO_NODE,
        .semilinear = &self->semilinear,
        .loops = {&self->loops, &self->loops, &self->loops},
    };
}

bool gm_user_evolution_open(struct gm_problem *problem, const struct gm_user_evolution *evolution,
                            const double *values, const struct gm_grid1 *grid, enum gm_derivatives space)
{
    *problem = (struct gm_problem){.name = "evolution", .kind = &gm_kind_ode, .m = 1, .line = *grid};
    return gm_user_line_problem(open_problem, &(struct gm_line_opening){problem, evolution, values, &space});
}

/* ---- what is asked of it ---- */

void gm_user_evolution_start(const struct gm_problem *problem, double *y)
{
    const struct own *self = own_of(problem);
    const size_t points = self->line.points;
    gm_user_line_start(&self->along, &self->line, y);
    for (size_t c = 0; c < self->fields; c++) {
        for (size_t i = gm_grid1_seen(&self->line); i < points; i++) {
            y[c * points + i] *= self->mirrored[c];
        }
    }
}

double gm_user_evolution_integral(const struct gm_problem *problem, size_t density, bool magnitude,
                                  const double *y)
{
    struct own *self = own_of(problem);
    const size_t points = self->line.points;
    struct room *room = borrow(self);
    if (!room) {
        return NAN;
    }
    derive(self, room, y);
    gm_tape_block(&self->densities[density], room->inputs, points, room->density, points, points);
    double sum = 0;
    for (size_t i = 0; i < gm_grid1_seen(&self->line); i++) {
        sum += gm_grid1_share(&self->line, i) * (magnitude ? fabs(room->density[i]) : room->density[i]);
    }
    give_back(self, room);
    return sum * self->line.dx;
}

static bool field_closes(const struct own *self, size_t field, struct gm_fault *fault)
{
    const struct gm_grid1 *grid = &self->line;
    struct gm_line_ends ends;
    if (!gm_user_line_closes(&self->along, grid, field, 0, &ends, fault)) {
        return false;
    }
    if (grid->walls && self->mirrored[field] < 0 &&
        !(fabs(ends.left) + fabs(ends.right) <= 1e-3 * fmax(fabs(ends.low), fabs(ends.high)))) {
        return gm_fail(
            fault, 0,
            "%.60s is 0 at walls, where it changes its sign in the mirror, and at the start it is %.6g at one and "
            "%.6g at the other",
            self->evolution->system->variables[field].name, ends.left, ends.right);
    }
    return true;
}

static bool has_masses(const struct own *self, struct gm_fault *fault)
{
    for (size_t i = 0; i < gm_modes_half(self->line.points) * self->fields; i++) {
        const size_t mode = i / self->fields;
        if (!(gm_cabs(self->masses[i]) > 1e-12)) {
            return gm_fail(fault, 0,
                           "the mass of %.60s is 0 for the wave of wave number %.6g, whose rate is not known",
                           self->evolution->system->variables[i % self->fields].name,
                           2 * M_PI * (double)mode / ((double)self->line.points * self->line.dx));
        }
    }
    return true;
}

static bool has_rates(const struct own *self, const double *rates, struct gm_fault *fault)
{
    const size_t points = self->line.points;
    for (size_t i = 0; i < self->fields * points; i++) {
        if (!isfinite(rates[i])) {
            return gm_fail(fault, 0, "the rate of %.60s at the start is not finite where x = %.6g",
                           self->evolution->system->variables[i / points].name,
                           gm_grid1_node(&self->line, i % points));
        }
    }
    return true;
}

/* Returns true if fields, masses and rates are finite at the start; else false with a fault. y: room for a state and its
   rates. */
static bool starts(const struct gm_problem *problem, double *y, struct gm_fault *fault)
{
    const struct own *self = own_of(problem);
    gm_user_evolution_start(problem, y);
    for (size_t i = 0; i < self->fields; i++) {
        if (!field_closes(self, i, fault)) {
            return false;
        }
    }
    if (!has_masses(self, fault)) {
        return false;
    }
    field(problem, y, y + problem->n, 1);
    return has_rates(self, y + problem->n, fault);
}

bool gm_user_evolution_closes(const struct gm_problem *problem, struct gm_fault *fault)
{
    const struct own *self = own_of(problem);
    if (self->line.walls && self->mirrored[0] == 0) {
        return gm_fail(
            fault, 0,
            "there are no walls for these rates: a mirrored field has other ones, as odd derivatives (u_x, u_xxx) "
            "change their sign in the mirror");
    }
    double *y = malloc(2 * problem->n * sizeof *y);
    const bool closes = y ? starts(problem, y, fault) : gm_fail(fault, 0, "not enough memory");
    free(y);
    return closes;
}
