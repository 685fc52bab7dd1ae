/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Waves in a potential that somebody wrote, on moving meshes. The mean of V over a linear element is taken by
   Gauss's formula with nodes s_k in (-1, 1) and weights g_k that add up to 1,
       w(m, r) = sum_k g_k V(m + s_k r / 2),   w_m = sum_k g_k V'(..),   w_r = sum_k g_k s_k / 2 V'(..),
   and all derivatives are those of this sum: schemes are of one Lagrangian, whatever it leaves of the
   integral. */
#include "core/mesh/user/potential.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_integration.h>

#include "core/basics.h"
#include "core/memory.h"
#include "core/user/line.h"

enum { MOST_NODES = 10, ROOM = 160, SAMPLES = 4096, EXAMINED = 1024 /* places of the start */ };
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
    struct gm_tape means /* V, V' */, bend /* V'' */;
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

static void drift(const void *parameters, const double *x, size_t count, double *rate)
{
    double of[OF_START];
    for (size_t i = 0; i < count; i++) {
        gm_tape_values(&((const struct own *)parameters)->line.start, x + i, of, 1);
        rate[i] = of[DRIFT];
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

/* The start: the total variation of u, its largest slope, and the largest force. */
struct extent {
    double variation, slope, force;
};

static struct extent extent_of(const struct own *self)
{
    const struct gm_grid1 grid = cells_of(&self->mesh, SAMPLES);
    struct extent of = {0};
    double values[GM_LINE_BLOCK], before = self->mesh.left, at[2];
    for (size_t from = 0, some; from < grid.points; from += some) {
        some = gm_user_line_block(&self->line, &grid, from, values);
        for (size_t i = 0; i < some; i++) {
            gm_tape_values(&self->means, &values[i], at, 1);
            of.variation += fabs(values[i] - before);
            of.slope = fmax(of.slope, fabs(values[2 * some + i]));
            of.force = fmax(of.force, fabs(at[1]));
            before = values[i];
        }
    }
    return of;
}

/* Sets the numbers of densities, by the file's line alpha:, or else as steep as the start is. */
static bool weigh(struct own *self, const struct gm_user_mesh *chosen, const double *values)
{
    const struct gm_user_system *system = self->line.system;
    const struct gm_system_item *item = gm_system_item_of(system, GM_WORD_ALPHA, 0);
    const struct gm_system_option *steepest = item ? gm_system_option(item, GM_OPTION_STEEPEST) : NULL,
                                  *bend = item ? gm_system_option(item, GM_OPTION_BEND) : NULL;
    double alpha = NAN, slope = NAN, curvature = NAN;
    if (!steepest || !bend) {
        const struct extent of = extent_of(self);
        /* 3/2 makes cells 1.8 times closer at the steepest point. The bound, which keeps many waves from
           drawing all nodes at once, is half of Tyranowski and Desbrun's choice for one soliton, 2.5 for a
           rise of 2 pi in a box of 25 */
        alpha = of.variation > 0 && of.slope > 0
                    ? fmin(1.5 / of.slope, M_PI / 10 * self->mesh.length / of.variation)
                    : 0;
        slope = of.slope > 0 ? of.slope : 1;
        curvature = of.force > 0 ? of.slope * of.slope / of.force : 0;
    }
    if ((item && !gm_user_line_numbers(system, item->nodes, 1, values, &alpha)) ||
        (steepest && !gm_user_line_numbers(system, &steepest->node, 1, values, &slope)) ||
        (bend && !gm_user_line_numbers(system, &bend->node, 1, values, &curvature))) {
        return false;
    }
    self->names.alpha = isnan(chosen->alpha) ? alpha : chosen->alpha;
    self->names.steepest = slope;
    self->names.bend = curvature;
    return true;
}

static void open_problem(struct gm_arena *arena, void *data)
{
    const struct gm_line_opening *opening = data;
    const struct gm_user_wave *wave = opening->formulas;
    const struct gm_user_mesh *chosen = opening->more;
    const double *values = opening->values;
    struct own *self = gm_user_line_take(arena, opening->problem, wave->system, sizeof *self);
    const struct gm_user_line *line = &self->line;
    const struct gm_system_item *held = gm_system_item_of(wave->system, GM_WORD_ENDS, 0);
    const gm_node_id means
        [] = {wave->system->energy, wave->by_u[0]},
   begin[OF_START] = {
       [U] = wave->start[0], [RATE] = wave->start[1], [SLOPE] = wave->start_slope, [DRIFT] = wave->drift};
    self->functions = (struct gm_potential){.name = "own", .first = first, .second = second};
    self->mesh =
        (struct gm_mesh){.points = (size_t)chosen->points,
                         .first = chosen->first,
                         .length = chosen->length,
                         .potential = wave->sine_gordon ? &gm_potential_sine_gordon : &self->functions};
    self->nodes = gm_user_mesh_order(wave);
    gm_arena_need(arena, gm_memory_guard_gsl(set_rule, self));
    gm_user_line_tape(line, &self->means, means, GM_COUNT(means), 1, values);
    gm_user_line_tape(line, &self->bend, &wave->by_u[1], 1, 1, values);
    if (wave->exact_while != GM_NO_NODE) {
        gm_user_line_tape(line, &self->known, &wave->exact_while, 1, 2, values);
    }
    gm_user_line_open(&self->line, begin, wave->drift == GM_NO_NODE ? DRIFT : OF_START, &wave->exact, values);
    gm_arena_keep(arena, &self->formulas, gm_mesh_formulas_close); /* they are opened below */
    const double places[] = {chosen->first, chosen->first + chosen->length};
    double ends[2], slopes[2], rates[2];
    start(self, places, GM_COUNT(places), ends, slopes, rates);
    gm_arena_need(arena,
                  !held || gm_user_line_numbers(wave->system, held->nodes, GM_COUNT(ends), values, ends));
    self->mesh.left = ends[0];
    self->mesh.right = ends[1];
    self->mesh.density = &self->formulas.density;
    self->mesh.alone = wave->system->alone;
    self->mesh.drift = wave->drift == GM_NO_NODE ? NULL : drift;
    self->mesh.relax = chosen->relax;
    self->mesh.t = self->line.begin;
    self->until = chosen->until;
    self->names = (struct gm_mesh_names){.wave = wave, .values = values};
    /* a formula that is refused is reported by gm_user_mesh_rests */
    struct gm_mesh_formulas *formulas = &self->formulas;
    gm_arena_need(arena,
                  weigh(self, chosen, values) && gm_mesh_formulas_open(formulas, &self->names, chosen));
    self->mesh.map = formulas->map.places ? &formulas->map : NULL;
    self->mesh.cell = formulas->cell.first ? &formulas->cell : NULL;
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
    const struct gm_mesh_formulas *formulas = &((const struct own *)problem->parameters)->formulas;
    gm_tape_values(&formulas->tapes[GM_TAPE_BETWEEN], at, velocity, m);
}

const struct gm_mesh_names *gm_user_mesh_names(const struct gm_problem *problem)
{
    return &((const struct own *)problem->parameters)->names;
}

bool gm_user_mesh_rests(const struct gm_problem *problem, struct gm_fault *fault)
{
    const struct own *self = problem->parameters;
    char *const sentence = fault->sentence;
    const size_t size = sizeof fault->sentence;
    const struct gm_grid1 grid = cells_of(&self->mesh, EXAMINED);
    const char *name = self->line.system->variables[0].name;
    double largest = 0, ends[2] = {0}, values[GM_LINE_BLOCK], before = self->mesh.first;
    if (self->formulas.refused[0]) {
        snprintf(sentence, size, "%s", self->formulas.refused);
        return false;
    }
    if (self->mesh.map && (!gm_mesh_map_suits(&self->mesh, self->mesh.t, sentence, size) ||
                           !gm_mesh_map_suits(&self->mesh, self->until, sentence, size))) {
        return false;
    }
    for (size_t k = 0; self->mesh.listed && k < self->mesh.points; k++) {
        const double x = self->formulas.listed[k], end = self->mesh.first + self->mesh.length;
        if (!(x > before && x < end)) {
            snprintf(sentence, size, "nodes: %.6g follows %.6g, and places grow, between %.6g and %.6g", x,
                     before, self->mesh.first, end);
            return false;
        }
        before = x;
    }
    for (size_t from = 0, some; from < grid.points; from += some) {
        some = gm_user_line_block(&self->line, &grid, from, values);
        for (size_t i = 0; i < some; i++) {
            const double u = values[i], rate = values[some + i], slope = values[2 * some + i],
                         drift = self->mesh.drift ? values[DRIFT * some + i] : 0;
            const bool moves = isfinite(drift);
            if (!moves || !isfinite(u) || !isfinite(slope) || !isfinite(rate)) {
                snprintf(sentence, size, "%.60s%s at the start is not finite where x = %.6g",
                         moves ? name : "X",
                         !moves             ? "_t"
                         : !isfinite(u)     ? ""
                         : !isfinite(slope) ? "_x"
                                            : "_t",
                         gm_grid1_node(&grid, from + i));
                return false;
            }
            const double at[] = {slope, u, gm_grid1_node(&grid, from + i)};
            double rho;
            gm_tape_values(&self->formulas.tapes[GM_TAPE_RHO], at, &rho, 1);
            if (!(rho >= 0 && isfinite(rho))) {
                snprintf(sentence, size,
                         "density: is %.6g at the start where x = %.6g, and lies between 0 and infinity", rho,
                         at[2]);
                return false;
            }
            largest = fmax(largest, fabs(rate));
            ends[from + i > 0] = rate;
        }
    }
    if (!isfinite(self->mesh.left) || !isfinite(self->mesh.right)) {
        snprintf(sentence, size, "ends: %.60s would be %g at one and %g at the other", name, self->mesh.left,
                 self->mesh.right);
        return false;
    }
    if (!(self->names.alpha >= 0 && self->names.alpha <= 1e6)) {
        snprintf(sentence, size, "alpha: is %g with these values, and lies between 0 and 1e6",
                 self->names.alpha);
        return false;
    }
    if (!gm_system_item_of(self->line.system, GM_WORD_ENDS, 0) &&
        fmax(fabs(ends[0]), fabs(ends[1])) > 1e-3 * largest) {
        snprintf(
            sentence, size,
            "%.60s is held at both ends of a moving mesh, and %.60s_t at the start is %.4g at one and %.4g at "
            "the other",
            name, name, ends[0], ends[1]);
        return false;
    }
    return true;
}
