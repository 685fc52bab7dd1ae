/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rates of fields on a ring, by tapes over all nodes. Whatever is linear - derivatives by waves, the mass,
   the part L of the rates - multiplies waves exp(i k x): a derivative of order j by
       differences of order 2   i sin(a)/dx,  2 (cos(a) - 1)/dx^2,  and products of these,  a = k dx
       waves                    (i k)^j, odd ones without the wave that alternates from node to node
   What a call needs beside its arguments is lent to it, so that threads may share the problem. */
#include "core/ode/own/evolution.h"

#include <complex.h>
#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/count.h"
#include "core/linear/modes.h"
#include "core/ode/kernel/loops.h"
#include "core/system/equations.h"
#include "core/tape.h"

enum {
    ROOM = 64 /* places that are computed together */,
    ORDERS = GM_MOST_DERIVATIVES + 1,
    MOST_INPUTS = GM_MOST_FIELDS * ORDERS + 2
};

/* What a call works in. */
struct room {
    struct gm_modes modes;
    double *inputs;                 /* of the tapes, [input * points + node] */
    double *state, *rates;          /* fields * points: of one member */
    double complex *waves, *slopes; /* likewise */
};

struct own {
    struct gm_ode facets;
    struct gm_semilinear semilinear;
    struct gm_loops loops;
    const struct gm_own_evolution *evolution;
    struct gm_line line;
    enum gm_derivatives space;
    size_t fields, inputs;
    char *names; /* "u[] v[]" */
    bool massive;
    /* Between walls: 1 of a field that its mirror image goes on with, -1 of one whose negative does; 0: of none. */
    double mirrored[GM_MOST_FIELDS];
    bool needed[ORDERS * GM_MOST_FIELDS]; /* which derivatives occur */
    struct gm_tape rates, rests, starts, exact, *densities;
    double complex *symbols; /* of L, [mode][row][column] */
    double complex *masses;  /* [mode][field] */
    struct room *_Atomic idle;
};

static struct own *own_of(const struct gm_problem *problem)
{
    return (struct own *)problem->parameters;
}

/* ---- what is derived ---- */

static bool renumber(struct gm_own_system *system, gm_node_id *nodes, size_t count)
{
    const size_t n = system->n, inputs = n * ORDERS + 2;
    gm_node_id *others = malloc(system->variable_count * sizeof *others);
    for (size_t i = 0; others && i < system->variable_count; i++) {
        others[i] = GM_NO_NODE;
    }
    if (!others) {
        return false;
    }
    others[n] = gm_formula_variable(&system->graph, inputs - 1);
    others[system->velocities] = gm_formula_variable(&system->graph, inputs - 2);
    for (size_t i = 0; i < n * GM_MOST_DERIVATIVES; i++) {
        others[system->velocities + 1 + i] = gm_formula_variable(&system->graph, n + i);
    }
    for (size_t i = system->parameters; i < system->velocities; i++) {
        others[i] = gm_formula_variable(&system->graph, inputs + i - system->parameters);
    }
    const bool good = gm_formula_substitute(&system->graph, nodes, count, others, system->variable_count);
    free(others);
    return good && !system->graph.failed;
}

static bool split(struct gm_own_evolution *evolution, struct gm_own_system *system)
{
    bool good = true;
    for (size_t i = 0; i < system->n && good; i++) {
        good = gm_system_linear_part(system, system->rates[i], &evolution->linear[i], &evolution->rests[i]);
        evolution->lines[i] = evolution->linear[i];
    }
    return good && renumber(system, evolution->lines, system->n) &&
           renumber(system, evolution->rests, system->n);
}

static bool find_kink(struct gm_own_evolution *evolution, struct gm_own_system *system)
{
    bool *marked = calloc(system->variable_count, sizeof *marked);
    evolution->kink = GM_NO_NODE;
    for (size_t i = 0; marked && i < system->n; i++) {
        marked[i] = true;
        for (size_t k = 0; k < GM_MOST_DERIVATIVES; k++) {
            marked[system->velocities + 1 + i * GM_MOST_DERIVATIVES + k] = true;
        }
    }
    for (size_t i = 0; marked && i < system->n && evolution->kink == GM_NO_NODE; i++) {
        evolution->kink = gm_formula_kink(&system->graph, system->rates[i], marked, system->variable_count);
        evolution->kinked = i;
    }
    const bool good = marked && !system->graph.failed;
    free(marked);
    return good;
}

bool gm_own_evolution_derive(struct gm_own_evolution *evolution, struct gm_own_system *system)
{
    const size_t n = system->n;
    *evolution = (struct gm_own_evolution){
        .system = system, .densities = malloc((system->item_count + 1) * sizeof *evolution->densities)};
    bool good = evolution->densities != NULL, told = true;
    for (size_t i = 0; i < n; i++) {
        evolution->rates[i] = system->rates[i];
        evolution->starts[i] = system->variables[i].start;
        evolution->exact[i] = system->variables[i].exact;
        evolution->masses[i] = gm_formula_variable(&system->graph, i);
        told &= evolution->exact[i] != GM_NO_NODE;
    }
    for (size_t i = 0; good && i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_INVARIANT || item->word == GM_WORD_OBSERVE) {
            evolution->densities[evolution->density_count++] = item->nodes[0];
        }
    }
    good = good && renumber(system, evolution->rates, n) && renumber(system, evolution->starts, n) &&
           renumber(system, evolution->densities, evolution->density_count) &&
           (!told || renumber(system, evolution->exact, n));
    evolution->exact[0] = told ? evolution->exact[0] : GM_NO_NODE;
    for (size_t i = 0; good && i < system->item_count; i++) {
        if (system->items[i].word == GM_WORD_MASS) {
            gm_node_id mass = system->items[i].nodes[0];
            const size_t field = gm_system_mass_field(system, mass);
            good = renumber(system, &mass, 1);
            evolution->masses[field] = mass;
        }
    }
    return good && find_kink(evolution, system) && split(evolution, system);
}

void gm_own_evolution_close(struct gm_own_evolution *evolution)
{
    free(evolution->densities);
    evolution->densities = NULL;
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

static struct room *room_open(const struct own *own)
{
    const size_t points = own->line.points, n = own->fields * points;
    struct room *room = calloc(1, sizeof *room);
    if (!room) {
        return NULL;
    }
    room->inputs = calloc(own->inputs * points + 2 * n, sizeof *room->inputs);
    room->waves = malloc(2 * n * sizeof *room->waves);
    if (!gm_modes_open(&room->modes, points, own->fields) || !room->inputs || !room->waves) {
        room_close(room);
        return NULL;
    }
    room->state = room->inputs + own->inputs * points;
    room->rates = room->state + n;
    room->slopes = room->waves + n;
    double *x = room->inputs + (own->inputs - 2) * points;
    for (size_t i = 0; i < points; i++) {
        x[i] = gm_line_node(&own->line, i);
    }
    return room;
}

static struct room *borrow(struct own *own)
{
    struct room *room = atomic_exchange(&own->idle, NULL);
    return room ? room : room_open(own);
}

static void give_back(struct own *own, struct room *room)
{
    room_close(atomic_exchange(&own->idle, room));
}

/* ---- derivatives ---- */

/* What the derivative of that order multiplies the wave by. */
static double complex factor_of(const struct own *own, size_t order, size_t mode)
{
    const double points = (double)own->line.points, dx = own->line.dx,
                 angle = 2 * M_PI * (double)mode / points;
    const bool alternating = 2 * mode == own->line.points;
    if (own->space == GM_SPACE_FOURIER) {
        const double complex once = I * angle / dx;
        double complex factor = 1;
        for (size_t k = 0; k < order; k++) {
            factor *= once;
        }
        return alternating && order % 2 ? 0 : factor;
    }
    const double half = sin(angle / 2), twice = -4 * half * half / (dx * dx);
    const double complex first = alternating ? 0 : I * sin(angle) / dx;
    const double complex factors[ORDERS] = {1, first, twice, first * twice, twice * twice};
    return factors[order];
}

static void differences(const struct own *own, const double *u, size_t order, double *to)
{
    const size_t n = own->line.points;
    const double dx = own->line.dx;
    for (size_t i = 0; i < n; i++) {
        const size_t r = i + 1 < n ? i + 1 : 0, r2 = r + 1 < n ? r + 1 : 0, l = i > 0 ? i - 1 : n - 1,
                     l2 = l > 0 ? l - 1 : n - 1;
        to[i] = order == 1   ? (u[r] - u[l]) / (2 * dx)
                : order == 2 ? (u[r] - 2 * u[i] + u[l]) / (dx * dx)
                : order == 3 ? (u[r2] - 2 * u[r] + 2 * u[l] - u[l2]) / (2 * dx * dx * dx)
                             : (u[r2] - 4 * u[r] + 6 * u[i] - 4 * u[l] + u[l2]) / (dx * dx * dx * dx);
    }
}

/* The inputs of tapes from a state. */
static void derive(const struct own *own, struct room *room, const double *y)
{
    const size_t points = own->line.points, n = own->fields * points, half = gm_modes_half(points);
    const struct gm_modes one = {points, 1, room->modes.fourier};
    memcpy(room->inputs, y, n * sizeof *y);
    bool known = false;
    for (size_t k = own->fields; k < own->fields * ORDERS; k++) {
        const size_t order = k / own->fields, field = k % own->fields;
        double *to = room->inputs + k * points;
        if (!own->needed[k]) {
            continue;
        }
        if (own->space == GM_SPACE_DIFFERENCES) {
            differences(own, y + field * points, order, to);
            continue;
        }
        if (!known) {
            gm_modes_forward(&room->modes, y, room->waves);
            known = true;
        }
        for (size_t mode = 0; mode < half; mode++) {
            room->slopes[mode] = room->waves[field * points + mode] * factor_of(own, order, mode);
        }
        gm_modes_back(&one, room->slopes, to);
    }
}

/* The rates, or what is left of them without L, of one member. */
static void evaluate(struct own *own, const struct gm_tape *tape, const double *y, double *rates)
{
    const size_t points = own->line.points, n = own->fields * points, half = gm_modes_half(points);
    struct room *room = borrow(own);
    for (size_t i = 0; !room && i < n; i++) {
        rates[i] = NAN;
    }
    if (!room) {
        return;
    }
    derive(own, room, y);
    gm_tape_block(tape, room->inputs, points, rates, points, points);
    if (own->massive) {
        gm_modes_forward(&room->modes, rates, room->waves);
        for (size_t field = 0; field < own->fields; field++) {
            for (size_t mode = 0; mode < half; mode++) {
                room->waves[field * points + mode] /= own->masses[mode * own->fields + field];
            }
        }
        gm_modes_back(&room->modes, room->waves, rates);
    }
    give_back(own, room);
}

static void field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    struct own *own = own_of(problem);
    if (m == 1) {
        evaluate(own, &own->rates, y, f);
        return;
    }
    const size_t n = problem->n;
    double *one = malloc(2 * n * sizeof *one);
    for (size_t member = 0; member < m; member++) {
        for (size_t c = 0; one && c < n; c++) {
            one[c] = y[c * m + member];
        }
        if (one) {
            evaluate(own, &own->rates, one, one + n);
        }
        for (size_t c = 0; c < n; c++) {
            f[c * m + member] = one ? one[n + c] : NAN;
        }
    }
    free(one);
}

static void nonlinear(const struct gm_problem *problem, const double *y, double *rest)
{
    struct own *own = own_of(problem);
    evaluate(own, &own->rests, y, rest);
}

static void symbol(const struct gm_problem *problem, size_t mode, double complex *matrix)
{
    const struct own *own = own_of(problem);
    const size_t size = own->fields * own->fields;
    memcpy(matrix, own->symbols + mode * size, size * sizeof *matrix);
}

/* ---- the problem ---- */

/* The coefficients of what is linear: its values where one input is 1 and the others are 0. */
static bool coefficients_of(const struct own *own, const gm_node_id *nodes, const double *values,
                            double *coefficients)
{
    const size_t n = own->fields;
    struct gm_tape tape;
    const bool good = gm_tape_open(&tape, &own->evolution->system->graph, nodes, n, own->inputs, values);
    for (size_t k = 0; good && k < n * ORDERS; k++) {
        double inputs[MOST_INPUTS] = {0}, outputs[GM_MOST_FIELDS];
        inputs[k] = 1;
        gm_tape_values(&tape, inputs, outputs, 1);
        for (size_t i = 0; i < n; i++) {
            coefficients[i * n * ORDERS + k] = outputs[i];
        }
    }
    gm_tape_close(&tape);
    return good;
}

static bool make_symbols(struct own *own, const double *values)
{
    const size_t n = own->fields, half = gm_modes_half(own->line.points);
    double linear[GM_MOST_FIELDS * GM_MOST_FIELDS * ORDERS], mass[GM_MOST_FIELDS * GM_MOST_FIELDS * ORDERS];
    own->symbols = malloc(half * n * n * sizeof *own->symbols);
    own->masses = malloc(half * n * sizeof *own->masses);
    if (!own->symbols || !own->masses || !coefficients_of(own, own->evolution->lines, values, linear) ||
        !coefficients_of(own, own->evolution->masses, values, mass)) {
        return false;
    }
    for (size_t mode = 0; mode < half; mode++) {
        for (size_t i = 0; i < n; i++) {
            double complex of_mass = 0, row[GM_MOST_FIELDS] = {0};
            for (size_t k = 0; k < n * ORDERS; k++) {
                const double complex factor = factor_of(own, k / n, mode);
                row[k % n] += linear[i * n * ORDERS + k] * factor;
                of_mass += mass[i * n * ORDERS + k] * factor;
            }
            own->masses[mode * n + i] = of_mass;
            own->massive |= of_mass != 1;
            for (size_t j = 0; j < n; j++) {
                own->symbols[(mode * n + i) * n + j] = row[j] / of_mass;
            }
        }
    }
    return true;
}

/* Whether a mirrored field, of those signs, has the mirrored rate, at places that are as good as any. */
static bool is_mirrored(const struct own *own, const double *signs)
{
    enum { TRIALS = 5 };
    const size_t n = own->fields;
    double here[MOST_INPUTS], there[MOST_INPUTS], rate[GM_MOST_FIELDS], other[GM_MOST_FIELDS];
    for (size_t trial = 0; trial < TRIALS; trial++) {
        for (size_t k = 0; k < own->inputs; k++) {
            const double sign = k < n * ORDERS ? signs[k % n] * (k / n % 2 ? -1 : 1) : 1;
            here[k] = 0.6 + 0.35 * sin(1 + 7 * (double)k + 2.3 * (double)trial);
            there[k] = sign * here[k];
        }
        gm_tape_values(&own->rates, here, rate, 1);
        gm_tape_values(&own->rates, there, other, 1);
        for (size_t i = 0; i < n; i++) {
            if (!(fabs(other[i] - signs[i] * rate[i]) <= 1e-9 * fmax(1, fabs(rate[i])))) {
                return false;
            }
        }
    }
    for (size_t i = 0; i < gm_modes_half(own->line.points) * n; i++) {
        if (fabs(cimag(own->masses[i])) > 1e-9 * cabs(own->masses[i])) {
            return false;
        }
    }
    return true;
}

/* Of each field the sign of its mirror image: 1 of the first where it can be, then of the second .. */
static void find_mirror(struct own *own)
{
    for (size_t odd = 0; odd < (size_t)1 << own->fields; odd++) {
        double signs[GM_MOST_FIELDS];
        for (size_t i = 0; i < own->fields; i++) {
            signs[i] = odd >> (own->fields - 1 - i) & 1 ? -1 : 1;
        }
        if (is_mirrored(own, signs)) {
            memcpy(own->mirrored, signs, sizeof signs);
            return;
        }
    }
}

/* Which derivatives the rates and densities hold. */
static bool find_needed(struct own *own)
{
    const struct gm_own_evolution *evolution = own->evolution;
    const struct gm_formula *graph = &evolution->system->graph;
    for (size_t i = 0; i < own->fields + evolution->density_count; i++) {
        const gm_node_id node = i < own->fields ? evolution->rates[i] : evolution->densities[i - own->fields];
        size_t count = 0;
        gm_node_id *parts = gm_formula_parts(graph, node, &count);
        for (size_t k = 0; parts && k < count; k++) {
            const struct gm_node *part = &graph->nodes[parts[k]];
            if (part->operation == GM_VARIABLE && part->a < own->fields * ORDERS) {
                own->needed[part->a] = true;
            }
        }
        free(parts);
        if (!parts) {
            return false;
        }
    }
    return true;
}

static bool name_fields(struct own *own)
{
    size_t length = 1;
    for (size_t i = 0; i < own->fields; i++) {
        length += strlen(own->evolution->system->variables[i].name) + 3;
    }
    own->names = calloc(length, 1);
    for (size_t i = 0; own->names && i < own->fields; i++) {
        strcat(strcat(strcat(own->names, i ? " " : ""), own->evolution->system->variables[i].name), "[]");
    }
    return own->names != NULL;
}

/* The values of all variables in their new order. malloc'ed. */
static double *renumbered(const struct own *own, const double *values)
{
    const struct gm_own_system *system = own->evolution->system;
    const size_t parameters = system->velocities - system->parameters;
    double *made = calloc(own->inputs + parameters, sizeof *made);
    if (made) {
        memcpy(made + own->inputs, values + system->parameters, parameters * sizeof *made);
    }
    return made;
}

static bool open_tapes(struct own *own, const double *values)
{
    const struct gm_own_evolution *evolution = own->evolution;
    const struct gm_formula *graph = &evolution->system->graph;
    const size_t n = own->fields, inputs = own->inputs;
    own->densities = calloc(evolution->density_count + 1, sizeof *own->densities);
    bool good = own->densities && gm_tape_open(&own->rates, graph, evolution->rates, n, inputs, values) &&
                gm_tape_open(&own->rests, graph, evolution->rests, n, inputs, values) &&
                gm_tape_open(&own->starts, graph, evolution->starts, n, inputs, values) &&
                (evolution->exact[0] == GM_NO_NODE ||
                 gm_tape_open(&own->exact, graph, evolution->exact, n, inputs, values));
    for (size_t i = 0; good && i < evolution->density_count; i++) {
        good = gm_tape_open(&own->densities[i], graph, &evolution->densities[i], 1, inputs, values);
    }
    return good;
}

bool gm_own_evolution_open(struct gm_problem *problem, const struct gm_own_evolution *evolution,
                           const double *values, const struct gm_line *line, enum gm_derivatives space)
{
    struct own *own = calloc(1, sizeof *own);
    *problem = (struct gm_problem){.name = "evolution", .kind = &gm_kind_ode, .m = 1, .line = *line};
    if (!own) {
        return false;
    }
    own->evolution = evolution;
    own->line = *line;
    own->space = space;
    own->fields = evolution->system->n;
    own->inputs = own->fields * ORDERS + 2;
    problem->n = own->fields * line->points;
    problem->parameters = own;
    problem->facets = &own->facets;
    double *ordered = renumbered(own, values);
    const bool good = ordered && open_tapes(own, ordered) && make_symbols(own, ordered) && find_needed(own) &&
                      name_fields(own);
    free(ordered);
    if (good && line->walls) {
        find_mirror(own);
    }
    own->semilinear = (struct gm_semilinear){own->fields, symbol, nonlinear};
    own->loops = (struct gm_loops){.field = field};
    own->facets = (struct gm_ode){
        .components = own->names,
        .rough = evolution->kink != GM_NO_NODE,
        .semilinear = &own->semilinear,
        .loops = {&own->loops, &own->loops, &own->loops},
    };
    return good;
}

void gm_own_evolution_shut(struct gm_problem *problem)
{
    struct own *own = own_of(problem);
    if (own) {
        struct gm_tape *const tapes[] = {&own->rates, &own->rests, &own->starts, &own->exact};
        for (size_t i = 0; i < GM_COUNT(tapes); i++) {
            gm_tape_close(tapes[i]);
        }
        for (size_t i = 0; own->densities && i < own->evolution->density_count; i++) {
            gm_tape_close(&own->densities[i]);
        }
        room_close(atomic_exchange(&own->idle, NULL));
        free(own->densities);
        free(own->symbols);
        free(own->masses);
        free(own->names);
    }
    free(own);
    problem->parameters = problem->facets = NULL;
}

/* ---- what is asked of it ---- */

/* The fields at the start at so many places, at most ROOM: [field * count + place]. */
static void starts_at(const struct own *own, const double *x, size_t count, double *values)
{
    double inputs[MOST_INPUTS * ROOM] = {0};
    memcpy(inputs + (own->inputs - 2) * count, x, count * sizeof *x);
    gm_tape_values(&own->starts, inputs, values, count);
}

void gm_own_evolution_start(const struct gm_problem *problem, double *y)
{
    const struct own *own = own_of(problem);
    const size_t points = own->line.points;
    double x[ROOM], values[GM_MOST_FIELDS * ROOM];
    for (size_t first = 0, some; first < points; first += some) {
        some = points - first < ROOM ? points - first : ROOM;
        for (size_t i = 0; i < some; i++) {
            x[i] = gm_line_node(&own->line, first + i);
        }
        starts_at(own, x, some, values);
        for (size_t c = 0; c < own->fields; c++) {
            for (size_t i = 0; i < some; i++) {
                const double sign = first + i < gm_line_seen(&own->line) ? 1 : own->mirrored[c];
                y[c * points + first + i] = sign * values[c * some + i];
            }
        }
    }
}

double gm_own_evolution_exact(const struct gm_problem *problem, size_t field, double x, double t)
{
    const struct own *own = own_of(problem);
    double inputs[MOST_INPUTS] = {0}, values[GM_MOST_FIELDS];
    inputs[own->inputs - 2] = x;
    inputs[own->inputs - 1] = t;
    if (own->evolution->exact[0] == GM_NO_NODE) {
        return NAN;
    }
    gm_tape_values(&own->exact, inputs, values, 1);
    return values[field];
}

double gm_own_evolution_integral(const struct gm_problem *problem, size_t density, bool magnitude,
                                 const double *y)
{
    struct own *own = own_of(problem);
    const size_t points = own->line.points;
    struct room *room = borrow(own);
    if (!room) {
        return NAN;
    }
    derive(own, room, y);
    gm_tape_block(&own->densities[density], room->inputs, points, room->rates, points, points);
    double sum = 0;
    for (size_t i = 0; i < gm_line_seen(&own->line); i++) {
        sum += gm_line_share(&own->line, i) * (magnitude ? fabs(room->rates[i]) : room->rates[i]);
    }
    give_back(own, room);
    return sum * own->line.dx;
}

/* u: that field of the state at the start */
static bool field_closes(const struct own *own, size_t field, const double *u, char *sentence, size_t size)
{
    const struct gm_line *line = &own->line;
    const char *name = own->evolution->system->variables[field].name;
    double low = INFINITY, high = -INFINITY, values[2 * GM_MOST_FIELDS];
    for (size_t i = 0; i < line->points; i++) {
        if (!isfinite(u[i])) {
            snprintf(sentence, size, "%.60s at the start is not finite where x = %.6g", name,
                     gm_line_node(line, i));
            return false;
        }
        low = fmin(low, u[i]);
        high = fmax(high, u[i]);
    }
    starts_at(own, (const double[]){line->first, -line->first}, 2, values);
    const double left = values[2 * field], right = values[2 * field + 1];
    if (line->walls && own->mirrored[field] < 0 &&
        !(fabs(left) + fabs(right) <= 1e-3 * fmax(fabs(low), fabs(high)))) {
        snprintf(
            sentence, size,
            "%.60s is 0 at walls, where it changes its sign in the mirror, and at the start it is %.6g at one and "
            "%.6g at the other",
            name, left, right);
        return false;
    }
    if (!line->walls &&
        !(fabs(right - left) <= 1e-3 * fmax(high - low, 1e-12 * fmax(fabs(low), fabs(high))))) {
        snprintf(sentence, size,
                 "%.60s at the start does not close on the ring: it is %.6g at one end and %.6g at the other",
                 name, left, right);
        return false;
    }
    return true;
}

static bool has_masses(const struct own *own, char *sentence, size_t size)
{
    for (size_t i = 0; i < gm_modes_half(own->line.points) * own->fields; i++) {
        const size_t mode = i / own->fields;
        if (!(cabs(own->masses[i]) > 1e-12)) {
            snprintf(sentence, size,
                     "the mass of %.60s is 0 for the wave of wave number %.6g, whose rate is not known",
                     own->evolution->system->variables[i % own->fields].name,
                     2 * M_PI * (double)mode / ((double)own->line.points * own->line.dx));
            return false;
        }
    }
    return true;
}

static bool has_rates(const struct own *own, const double *rates, char *sentence, size_t size)
{
    const size_t points = own->line.points;
    for (size_t i = 0; i < own->fields * points; i++) {
        if (!isfinite(rates[i])) {
            snprintf(sentence, size, "the rate of %.60s at the start is not finite where x = %.6g",
                     own->evolution->system->variables[i / points].name,
                     gm_line_node(&own->line, i % points));
            return false;
        }
    }
    return true;
}

bool gm_own_evolution_closes(const struct gm_problem *problem, char *sentence, size_t size)
{
    const struct own *own = own_of(problem);
    if (own->line.walls && own->mirrored[0] == 0) {
        snprintf(
            sentence, size,
            "there are no walls for these rates: a mirrored field has other ones, as odd derivatives (u_x, u_xxx) "
            "change their sign in the mirror");
        return false;
    }
    double *y = malloc(2 * problem->n * sizeof *y), *rates = y ? y + problem->n : NULL;
    bool good = y != NULL;
    if (good) {
        gm_own_evolution_start(problem, y);
    } else {
        snprintf(sentence, size, "not enough memory");
    }
    for (size_t i = 0; i < own->fields && good; i++) {
        good = field_closes(own, i, y + i * own->line.points, sentence, size);
    }
    good = good && has_masses(own, sentence, size);
    if (good) {
        field(problem, y, rates, 1);
        good = has_rates(own, rates, sentence, size);
    }
    free(y);
    return good;
}
