/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Waves in a potential that somebody wrote, on moving meshes. The mean of V over a linear element is taken by
   Gauss's formula with nodes s_k in (-1, 1) and weights g_k that add up to 1,
       w(m, r) = sum_k g_k V(m + s_k r / 2),   w_m = sum_k g_k V'(..),   w_r = sum_k g_k s_k / 2 V'(..),
   and all derivatives are those of this sum: schemes are of one Lagrangian, whatever it leaves of the
   integral. */
#include "core/mesh/user/potential.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_integration.h>

#include "core/basics.h"
#include "core/memory.h"
#include "core/mesh/element.h"
#include "core/user/line.h"

enum { MOST_NODES = 10, ROOM = 160, SAMPLES = 4096, PLACES = 1025 /* where a start is examined */ };
enum { U, RATE, SLOPE, DRIFT, OF_START };

struct own {
    struct gm_user_line line; /* first; starts are u, u_t, u_x, and X_t if the file gives it */
    struct gm_potential functions;
    struct gm_mesh mesh;
    struct gm_mesh_names names;
    struct gm_mesh_formulas formulas;
    double until;
    size_t nodes;
    double place[MOST_NODES], weight[MOST_NODES];
    struct gm_tape means /* V, V' */, bend /* V'' */, drift /* X_t at the start */;
    struct gm_tape
        known; /* of x and t: above 0 where the exact solution holds; without outputs if it always does */
};

static const struct own *own_of(const struct gm_potential *potential)
{
    return (const struct own *)((const char *)potential - offsetof(struct own, functions));
}

size_t gm_user_mesh_order(const struct gm_user_wave *wave)
{
    /* exact to degree 2 n - 1; V has one degree more than V' */
    return wave->degree + 1 <= 2 * MOST_NODES - 1 ? ((size_t)wave->degree + 3) / 2 : MOST_NODES;
}

/* Gauss's nodes, and weights that add up to 1, which GSL has in tables. Returns false when out of memory. */
static bool set_rule(void *data)
{
    struct own *self = data;
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(self->nodes);
    for (size_t k = 0; table && k < self->nodes; k++) {
        gsl_integration_glfixed_point(-1, 1, k, &self->place[k], &self->weight[k], table);
        self->weight[k] /= 2;
    }
    gsl_integration_glfixed_table_free(table);
    return table != NULL;
}

static void first(const struct gm_potential *potential, const double *middle, const double *rise, size_t n,
                  double *w, double *w_m, double *w_r)
{
    const struct own *self = own_of(potential);
    const size_t nodes = self->nodes, most = ROOM / nodes;
    double at[ROOM], values[2 * ROOM];
    for (size_t from = 0; from < n; from += most) {
        const size_t some = n - from < most ? n - from : most;
        for (size_t k = 0; k < nodes; k++) {
            for (size_t e = 0; e < some; e++) {
                at[k * some + e] = middle[from + e] + self->place[k] * (rise[from + e] / 2);
            }
        }
        gm_tape_values(&self->means, at, values, some * nodes);
        for (size_t e = 0; e < some; e++) {
            double sum = 0, by_m = 0, by_r = 0;
            for (size_t k = 0; k < nodes; k++) {
                const double slope = self->weight[k] * values[some * nodes + k * some + e];
                sum += self->weight[k] * values[k * some + e];
                by_m += slope;
                by_r += slope * self->place[k] / 2;
            }
            w[from + e] = sum;
            w_m[from + e] = by_m;
            w_r[from + e] = by_r;
        }
    }
}

static void second(const struct gm_potential *potential, double middle, double rise, double *w_mm,
                   double *w_mr, double *w_rr)
{
    const struct own *self = own_of(potential);
    double at[MOST_NODES], values[MOST_NODES];
    for (size_t k = 0; k < self->nodes; k++) {
        at[k] = middle + self->place[k] * (rise / 2);
    }
    gm_tape_values(&self->bend, at, values, self->nodes);
    *w_mm = *w_mr = *w_rr = 0;
    for (size_t k = 0; k < self->nodes; k++) {
        const double bend = self->weight[k] * values[k], half = self->place[k] / 2;
        *w_mm += bend;
        *w_mr += bend * half;
        *w_rr += bend * half * half;
    }
}

static void describe(const struct gm_problem *problem, struct gm_mesh *mesh)
{
    *mesh = ((const struct own *)problem->parameters)->mesh;
}

static void start(const void *parameters, const double *x, size_t count, double *value, double *slope,
                  double *rate)
{
    double of[OF_START * GM_LINE_ROOM];
    for (size_t from = 0, some; from < count; from += some) {
        some = count - from < GM_LINE_ROOM ? count - from : GM_LINE_ROOM;
        gm_tape_values(&((const struct own *)parameters)->line.start, x + from, of, some);
        memcpy(value + from, of, some * sizeof *of);
        memcpy(rate + from, of + RATE * some, some * sizeof *of);
        memcpy(slope + from, of + SLOPE * some, some * sizeof *of);
    }
}

static double exact(const void *parameters, double x, double t)
{
    const struct gm_tape *known = &((const struct own *)parameters)->known;
    const double place[] = {x, t};
    double holds = 1;
    if (known->outputs > 0) {
        gm_tape_values(known, place, &holds, 1);
    }
    return holds > 0 ? gm_user_line_exact(parameters, 0, x, t) : NAN;
}

static const struct gm_moving_mesh facets = {.describe = describe, .start = start, .exact = exact};

/* The line as a grid of this many cells from end to end. */
static struct gm_grid1 cells_of(const struct gm_mesh *mesh, size_t count)
{
    return (struct gm_grid1){.points = count + 1, .dx = mesh->length / (double)count, .first = mesh->first};
}

/* Sets the numbers of densities so that they suit the start: its largest slope and force, and its total variation. */
static void weigh(struct gm_arena *arena, struct own *self)
{
    const struct gm_grid1 grid = cells_of(&self->mesh, SAMPLES);
    const size_t mark = gm_arena_mark(arena);
    double *values = gm_arena_take_unset(arena, grid.points * self->line.start.outputs, sizeof *values),
           at[2];
    double variation = 0, steepest = 0, force = 0, before = self->mesh.left;
    gm_user_line_start(&self->line, &grid, values);
    for (size_t i = 0; i < grid.points; i++) {
        gm_tape_values(&self->means, &values[i], at, 1);
        variation += fabs(values[i] - before);
        steepest = fmax(steepest, fabs(values[SLOPE * grid.points + i]));
        force = fmax(force, fabs(at[1]));
        before = values[i];
    }
    gm_arena_release(arena, mark);
    /* 3/2 makes cells 1.8 times closer at the steepest point. The bound, which keeps many waves from drawing all nodes at
       once, is half of Tyranowski and Desbrun's choice for one soliton, 2.5 for a rise of 2 pi in a box of 25 */
    self->names.alpha =
        variation > 0 && steepest > 0 ? fmin(1.5 / steepest, M_PI / 10 * self->mesh.length / variation) : 0;
    self->names.steepest = steepest > 0 ? steepest : 1;
    self->names.bend = force > 0 ? steepest * steepest / force : 0;
}

/* Sets them by the file's line alpha:, or else as the start is, and alpha by its key. */
static void choose_numbers(struct gm_arena *arena, struct own *self, const double *values,
                           const struct gm_user_mesh *chosen)
{
    const struct gm_user_system *system = self->line.system;
    const struct gm_system_item *item = gm_system_item_of(system, GM_WORD_ALPHA, 0);
    const struct gm_system_option *steepest = item ? gm_system_option(item, GM_OPTION_STEEPEST) : NULL,
                                  *bend = item ? gm_system_option(item, GM_OPTION_BEND) : NULL;
    const gm_node_id *const given[] = {item ? item->nodes : NULL, steepest ? &steepest->node : NULL,
                                       bend ? &bend->node : NULL};
    double *const numbers[] = {&self->names.alpha, &self->names.steepest, &self->names.bend};
    if (!steepest || !bend) {
        weigh(arena, self);
    }
    for (size_t i = 0; i < GM_COUNT(given); i++) {
        gm_arena_need(arena, !given[i] || gm_user_line_numbers(system, given[i], 1, values, numbers[i]));
    }
    if (!isnan(chosen->alpha)) {
        self->names.alpha = chosen->alpha;
    }
}

/* Writes the start at places all over the line, and the density there. */
static void examine(const struct own *self, double values[OF_START * PLACES], double density[PLACES])
{
    const struct gm_grid1 grid = cells_of(&self->mesh, PLACES - 1);
    double at[GM_DENSITY_INPUTS * PLACES];
    gm_user_line_start(&self->line, &grid, values);
    for (size_t i = 0; i < PLACES; i++) {
        at[i] = values[SLOPE * PLACES + i];
        at[PLACES + i] = values[U * PLACES + i];
        at[2 * PLACES + i] = gm_grid1_node(&grid, i);
    }
    gm_tape_values(&self->formulas.rho, at, density, PLACES);
}

/* Returns a power of 2 near the least P at the start, or a billionth of its mean where it vanishes. */
static double level_of(const struct own *self)
{
    double values[OF_START * PLACES], density[PLACES], least = INFINITY, sum = 0;
    int exponent;
    examine(self, values, density);
    for (size_t i = 0; i < PLACES; i++) {
        least = fmin(least, density[i] * density[i]);
        sum += density[i] * density[i];
    }
    frexp(fmax(least, 1e-9 * sum / PLACES), &exponent);
    return sum > 0 && isfinite(sum) ? ldexp(1, exponent - 1) : 1;
}

static void open_problem(struct gm_arena *arena, void *data)
{
    const struct gm_line_opening *opening = data;
    const struct gm_user_wave *wave = opening->formulas;
    const struct gm_user_mesh *chosen = opening->more;
    const double *values = opening->values, places[] = {chosen->first, chosen->first + chosen->length};
    struct own *self = gm_user_line_take(arena, opening->problem, wave->system, sizeof *self);
    struct gm_mesh_formulas *formulas = &self->formulas;
    const struct gm_user_line *line = &self->line;
    const struct gm_system_item *held = gm_system_item_of(wave->system, GM_WORD_ENDS, 0);
    const bool drifts = wave->drift != GM_NO_NODE;
    const gm_node_id means[] = {wave->system->energy, wave->by_u[0]};
    const gm_node_id begin[OF_START] = {
        [U] = wave->start[0], [RATE] = wave->start[1], [SLOPE] = wave->start_slope, [DRIFT] = wave->drift};
    double ends[2], slopes[2], rates[2];
    self->functions = (struct gm_potential){.name = "own", .first = first, .second = second};
    self->nodes = gm_user_mesh_order(wave);
    gm_arena_need(arena, gm_memory_guard_gsl(set_rule, self));
    gm_user_line_tape(line, &self->means, means, GM_COUNT(means), 1, values);
    gm_user_line_tape(line, &self->bend, &wave->by_u[1], 1, 1, values);
    if (wave->exact_while != GM_NO_NODE) {
        gm_user_line_tape(line, &self->known, &wave->exact_while, 1, 2, values);
    }
    if (drifts) {
        gm_user_line_tape(line, &self->drift, &wave->drift, 1, 1, values);
    }
    gm_user_line_open(&self->line, begin, drifts ? OF_START : DRIFT, &wave->exact, values);
    start(self, places, GM_COUNT(places), ends, slopes, rates);
    gm_arena_need(arena,
                  !held || gm_user_line_numbers(wave->system, held->nodes, GM_COUNT(ends), values, ends));
    self->mesh = (struct gm_mesh){
        .points = (size_t)chosen->points,
        .alone = wave->system->alone,
        .first = chosen->first,
        .length = chosen->length,
        .left = ends[0],
        .right = ends[1],
        .density = &formulas->density,
        .relax = chosen->relax,
        .t = line->begin,
        .drift = drifts ? &self->drift : NULL,
        .potential = wave->sine_gordon ? &gm_potential_sine_gordon : &self->functions,
    };
    self->until = chosen->until;
    self->names = (struct gm_mesh_names){.wave = wave, .values = values};
    choose_numbers(arena, self, values, chosen);
    gm_arena_keep(arena, formulas, gm_mesh_formulas_close);
    /* a formula that is refused is reported by gm_user_mesh_rests */
    gm_arena_need(arena, gm_mesh_formulas_open(formulas, &self->names, chosen));
    self->mesh.level = formulas->refused[0] ? 1 : level_of(self);
    self->mesh.map = formulas->map.outputs > 0 ? &formulas->map : NULL;
    self->mesh.cell = formulas->cell.first.outputs > 0 ? &formulas->cell : NULL;
    self->mesh.listed = formulas->listed_count > 0 ? formulas->listed : NULL;
    self->mesh.points = self->mesh.listed ? formulas->listed_count : self->mesh.points;
    opening->problem->n = (self->mesh.alone ? 2 : 4) * self->mesh.points;
}

bool gm_user_mesh_open(struct gm_problem *problem, const struct gm_user_wave *wave, const double *values,
                       const struct gm_user_mesh *chosen)
{
    *problem = (struct gm_problem){.name = "wave equation", .m = 1, .kind = &gm_kind_mesh, .facets = &facets};
    return gm_user_line_problem(open_problem, &(struct gm_line_opening){problem, wave, values, chosen});
}

void gm_user_mesh_between(const struct gm_problem *problem, const double *at, double *velocity, size_t m)
{
    gm_tape_values(&((const struct own *)problem->parameters)->formulas.between, at, velocity, m);
}

const struct gm_mesh_names *gm_user_mesh_names(const struct gm_problem *problem)
{
    return &((const struct own *)problem->parameters)->names;
}

/* Fails if the mesh's map moves an end at time t, or does not grow with x. */
static bool map_suits(const struct gm_mesh *mesh, double t, struct gm_fault *fault)
{
    enum { CELLS = 256 };
    double label[CELLS + 1], x[CELLS + 1], rate[CELLS + 1];
    for (size_t i = 0; i <= CELLS; i++) {
        label[i] = mesh->first + mesh->length * (double)i / CELLS;
    }
    gm_mesh_places(mesh, label, CELLS + 1, t, x, rate);
    for (size_t i = 0; i <= CELLS; i += CELLS) {
        if (!(fabs(x[i] - label[i]) <= 1e-9 * mesh->length)) {
            return gm_fail(fault, 0, "mesh: X is %.6g at the end x = %.6g at t = %.6g, and has to stay there",
                           x[i], label[i], t);
        }
    }
    for (size_t i = 0; i < CELLS; i++) {
        if (!(x[i + 1] > x[i])) {
            return gm_fail(fault, 0, "mesh: X does not grow with x at x = %.6g, t = %.6g", label[i], t);
        }
    }
    return true;
}

static bool places_grow(const struct gm_mesh *mesh, struct gm_fault *fault)
{
    const double end = mesh->first + mesh->length;
    double before = mesh->first;
    for (size_t k = 0; mesh->listed && k < mesh->points; k++) {
        if (!(mesh->listed[k] > before && mesh->listed[k] < end)) {
            return gm_fail(fault, 0, "nodes: %.6g follows %.6g, and places grow, between %.6g and %.6g",
                           mesh->listed[k], before, mesh->first, end);
        }
        before = mesh->listed[k];
    }
    return true;
}

bool gm_user_mesh_rests(const struct gm_problem *problem, struct gm_fault *fault)
{
    static const size_t numbers[] = {DRIFT, U, SLOPE, RATE};
    static const char *const suffixes[] = {"_t", "", "_x", "_t"};
    const struct own *self = problem->parameters;
    const struct gm_mesh *mesh = &self->mesh;
    const struct gm_grid1 grid = cells_of(mesh, PLACES - 1);
    const bool held = gm_system_item_of(self->line.system, GM_WORD_ENDS, 0);
    const char *name = self->line.system->variables[0].name;
    double values[OF_START * PLACES], density[PLACES], largest = 0, highest = 0;
    if (self->formulas.refused[0]) {
        return gm_fail(fault, 0, "%s", self->formulas.refused);
    }
    /* round-off in g moves nodes by g/E; with this it does so a million times slower than light */
    const double shortest = 1e6 * DBL_EPSILON * mesh->length * (double)(mesh->points + 1);
    if (mesh->relax > 0 && mesh->relax < shortest) {
        return gm_fail(fault, 0,
                       "relax: is %g, and round-off would move %zu nodes: it is 0, or %.2g or longer",
                       mesh->relax, mesh->points, shortest);
    }
    if ((mesh->map && (!map_suits(mesh, mesh->t, fault) || !map_suits(mesh, self->until, fault))) ||
        !places_grow(mesh, fault)) {
        return false;
    }
    examine(self, values, density);
    for (size_t i = 0; i < PLACES; i++) {
        const double x = gm_grid1_node(&grid, i), *at = values + i, rho = density[i];
        for (size_t k = 0; k < GM_COUNT(numbers); k++) {
            if (numbers[k] < self->line.start.outputs && !isfinite(at[numbers[k] * PLACES])) {
                return gm_fail(fault, 0, "%.60s%s at the start is not finite where x = %.6g",
                               numbers[k] == DRIFT ? "X" : name, suffixes[k], x);
            }
        }
        if (!(rho >= 0 && isfinite(rho))) {
            return isnan(rho)
                       ? gm_fail(fault, 0, "density: is not a number at the start where x = %.6g", x)
                       : gm_fail(
                             fault, 0,
                             "density: is %.6g at the start where x = %.6g, and lies between 0 and infinity",
                             rho, x);
        }
        highest = fmax(highest, rho);
        largest = fmax(largest, fabs(at[RATE * PLACES]));
    }
    if (!(highest > 0)) {
        return gm_fail(fault, 0,
                       "density: is 0 everywhere at the start; a constant above 0 makes a uniform mesh");
    }
    if (!isfinite(mesh->left) || !isfinite(mesh->right)) {
        return gm_fail(fault, 0, "ends: %.60s would be %g at one and %g at the other", name, mesh->left,
                       mesh->right);
    }
    if (!(self->names.alpha >= 0 && self->names.alpha <= 1e6)) {
        return gm_fail(fault, 0, "alpha: is %g with these values, and lies between 0 and 1e6",
                       self->names.alpha);
    }
    const double left = values[RATE * PLACES], right = values[(RATE + 1) * PLACES - 1];
    return held || fmax(fabs(left), fabs(right)) <= 1e-3 * largest ||
           gm_fail(fault, 0,
                   "%.60s is held at both ends of a moving mesh, and %.60s_t at the start is %.4g at one and "
                   "%.4g at the other",
                   name, name, left, right);
}
