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

#include <gsl/gsl_integration.h>

#include "core/basics.h"
#include "core/memory.h"
#include "core/user/line.h"

enum { MOST_NODES = 10, ROOM = 160, SAMPLES = 4096 };

struct own {
    struct gm_user_line line; /* first; starts are u, u_t, u_x */
    struct gm_potential functions;
    struct gm_mesh mesh;
    double alpha;
    size_t nodes;
    double place[MOST_NODES], weight[MOST_NODES];
    struct gm_tape means /* V, V' */, bend /* V'' */, forces /* V', V'', V''' */;
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

static void force(const struct gm_potential *potential, double phi, double force[3])
{
    gm_tape_values(&own_of(potential)->forces, &phi, force, 1);
}

static void describe(const struct gm_problem *problem, struct gm_mesh *mesh)
{
    *mesh = ((const struct own *)problem->parameters)->mesh;
}

static void start(const void *parameters, double x, double *value, double *slope, double *rate)
{
    double of[3];
    gm_tape_values(&((const struct own *)parameters)->line.start, &x, of, 1);
    *value = of[0];
    *rate = of[1];
    *slope = of[2];
}

static double exact(const void *parameters, double x, double t)
{
    return gm_user_line_exact(parameters, 0, x, t);
}

static const struct gm_moving_mesh facets = {.describe = describe, .start = start, .exact = exact};

/* The density of the mesh, as steep as the start is. */
static void weigh(struct own *self, const struct gm_user_mesh *chosen)
{
    struct gm_mesh *mesh = &self->mesh;
    double variation = 0, steepest = 0, strongest = 0, before = mesh->left;
    for (int i = 0; i <= SAMPLES; i++) {
        double u, slope, rate, at[3];
        start(self, mesh->first + mesh->length * i / SAMPLES, &u, &slope, &rate);
        force(&self->functions, u, at);
        variation += fabs(u - before);
        steepest = fmax(steepest, fabs(slope));
        strongest = fmax(strongest, fabs(at[0]));
        before = u;
    }
    /* 3/2 makes cells 1.8 times closer at the steepest point. The bound, which keeps many waves from
       drawing all nodes at once, is half of Tyranowski and Desbrun's choice for one soliton, 2.5 for a
       rise of 2 pi in a box of 25 */
    const double usual =
        variation > 0 && steepest > 0 ? fmin(1.5 / steepest, M_PI / 10 * mesh->length / variation) : 0;
    self->alpha = isnan(chosen->alpha) ? usual : chosen->alpha;
    gm_mesh_weigh(mesh, chosen->density, self->alpha, steepest > 0 ? steepest : 1,
                  strongest > 0 ? steepest * steepest / strongest : 0);
}

bool gm_user_mesh_open(struct gm_problem *problem, const struct gm_user_wave *wave, const double *values,
                       const struct gm_user_mesh *chosen)
{
    struct own *self = calloc(1, sizeof *self);
    *problem = (struct gm_problem){.name = "wave equation",
                                   .n = 4 * (size_t)chosen->points,
                                   .m = 1,
                                   .kind = &gm_kind_mesh,
                                   .facets = &facets,
                                   .parameters = self};
    if (!self) {
        return false;
    }
    const struct gm_formula *graph = &wave->system->graph;
    const gm_node_id means[] = {wave->system->energy, wave->by_u[0]},
                     begin[] = {wave->start[0], wave->start[1], wave->start_slope};
    self->functions = (struct gm_potential){.name = "own", .first = first, .second = second, .force = force};
    self->mesh = (struct gm_mesh){.points = (size_t)chosen->points,
                                  .first = -chosen->half_length,
                                  .length = 2 * chosen->half_length,
                                  .potential = &self->functions};
    self->nodes = gm_user_mesh_order(wave);
    if (!gm_memory_guard_gsl(set_rule, self) ||
        !gm_tape_open(&self->means, graph, means, GM_COUNT(means), 1, values) ||
        !gm_tape_open(&self->bend, graph, &wave->by_u[1], 1, 1, values) ||
        !gm_tape_open(&self->forces, graph, wave->by_u, GM_COUNT(wave->by_u), 1, values) ||
        !gm_user_line_open(&self->line, wave->system, begin, GM_COUNT(begin), &wave->exact, values)) {
        return false;
    }
    double slope, rate;
    start(self, self->mesh.first, &self->mesh.left, &slope, &rate);
    start(self, chosen->half_length, &self->mesh.right, &slope, &rate);
    weigh(self, chosen);
    return true;
}

double gm_user_mesh_alpha(const struct gm_problem *problem)
{
    return ((const struct own *)problem->parameters)->alpha;
}

void gm_user_mesh_close(struct gm_problem *problem)
{
    struct own *self = (struct own *)problem->parameters;
    if (self) {
        struct gm_tape *const tapes[] = {&self->means, &self->bend, &self->forces};
        gm_user_line_close(&self->line);
        for (size_t i = 0; i < GM_COUNT(tapes); i++) {
            gm_tape_close(tapes[i]);
        }
    }
    free(self);
    problem->parameters = NULL;
}

bool gm_user_mesh_rests(const struct gm_problem *problem, char *sentence, size_t size)
{
    const struct own *self = problem->parameters;
    const struct gm_mesh *mesh = &self->mesh;
    const char *name = self->line.system->variables[0].name;
    double largest = 0, ends[2] = {0};
    for (int i = 0; i <= SAMPLES; i++) {
        const double x = mesh->first + mesh->length * i / SAMPLES;
        double u, slope, rate;
        start(problem->parameters, x, &u, &slope, &rate);
        if (!isfinite(u) || !isfinite(slope) || !isfinite(rate)) {
            snprintf(sentence, size, "%.60s%s at the start is not finite where x = %.6g", name,
                     !isfinite(u)       ? ""
                     : !isfinite(slope) ? "_x"
                                        : "_t",
                     x);
            return false;
        }
        largest = fmax(largest, fabs(rate));
        ends[i > 0] = rate;
    }
    if (fmax(fabs(ends[0]), fabs(ends[1])) > 1e-3 * largest) {
        snprintf(
            sentence, size,
            "%.60s is held at both ends of a moving mesh, and %.60s_t at the start is %.4g at one and %.4g at "
            "the other",
            name, name, ends[0], ends[1]);
        return false;
    }
    return true;
}
