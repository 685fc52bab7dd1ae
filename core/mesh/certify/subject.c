/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The soliton that schemes on meshes are certified on. */
#include "core/mesh/certify/subject.h"

#include <math.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/linear/differences.h"
#include "core/mesh/nodes.h"
#include "core/theory/certify.h"

static const struct gm_settings settings = {0};

/* One sine-Gordon soliton in the middle of a box, 4 arctan(exp(gamma (x - v t))). */
static const double velocity = 0.5, length = 12;

static double lorentz(void)
{
    return 1 / sqrt((1 - velocity) * (1 + velocity));
}

static void profile(const void *unused, const double *x, size_t count, double *value, double *slope,
                    double *rate)
{
    const double gamma = lorentz();
    (void)unused;
    for (size_t i = 0; i < count; i++) {
        const double from_middle = gamma * (x[i] - length / 2);
        value[i] = 4 * gm_atan(gm_exp(from_middle));
        slope[i] = 2 * gamma / gm_cosh(from_middle);
        rate[i] = -velocity * slope[i];
    }
}

/* generalised arclength with alpha = 1 */
static void arclength(const struct gm_density *unused, const double *slope, double *values, size_t m)
{
    (void)unused;
    for (size_t i = 0; i < m; i++) {
        values[GM_P * m + i] = 1 + slope[i] * slope[i];
        values[GM_P_S * m + i] = 2 * slope[i];
        values[GM_P_SS * m + i] = 2;
    }
}

/* A mesh that swings. */
static void places(const struct gm_mesh_map *unused, const double *label, size_t count, double t, double *x,
                   double *rate)
{
    const double amplitude = 0.8, frequency = 1.1, phase = frequency * t + 0.3;
    (void)unused;
    for (size_t i = 0; i < count; i++) {
        const double shape = amplitude * gm_sin(M_PI * label[i] / length);
        x[i] = label[i] + shape * gm_sin(phase);
        rate[i] = frequency * shape * gm_cos(phase);
    }
}

/* Inertia between nodes, (d_t/d)^2/20, with which free nodes have a regular mass matrix. */
static void inertia(const struct gm_mesh_cell *unused, const double *at, double *values, size_t m)
{
    (void)unused;
    for (size_t e = 0; e < m; e++) {
        const double d = at[e], rate = at[m + e] / d;
        values[e] = rate * rate / 20;
        values[m + e] = -rate * rate / (10 * d);
        values[2 * m + e] = rate / (10 * d);
        values[3 * m + e] = values[4 * m + e] = 0;
    }
}

static void bent_inertia(const struct gm_mesh_cell *unused, const double *at, double values[4][4])
{
    const double d = at[0], rate = at[1] / d;
    (void)unused;
    memset(values, 0, 16 * sizeof(double));
    values[0][0] = 3 * rate * rate / (10 * d * d);
    values[0][1] = values[1][0] = -rate / (5 * d * d);
    values[1][1] = 1 / (10 * d * d);
}

static void describe(const struct gm_problem *problem, struct gm_mesh *mesh)
{
    static const struct gm_density density = {.values = arclength};
    static const struct gm_mesh_map map = {places};
    static const struct gm_mesh_cell cell = {inertia, bent_inertia};
    *mesh = (struct gm_mesh){.points = problem->n / 4,
                             .length = length,
                             .right = 2 * M_PI,
                             .density = &density,
                             .map = &map,
                             .cell = &cell,
                             .potential = &gm_potential_sine_gordon};
}

struct gm_problem gm_mesh_soliton(size_t points)
{
    static const struct gm_moving_mesh soliton = {.describe = describe, .start = profile};
    return (struct gm_problem){
        .name = "soliton", .n = 4 * points, .m = 1, .kind = &gm_kind_mesh, .facets = &soliton};
}

bool gm_mesh_subject_open(struct gm_mesh_subject *subject, const struct gm_scheme *scheme,
                          const struct gm_problem *problem, double dt)
{
    const struct gm_moving_mesh *moving = gm_moving_mesh_of(problem);
    struct gm_mesh *mesh = &subject->mesh;
    subject->trial = (struct gm_trial){problem, scheme, &settings, dt, 1};
    subject->kind = gm_scheme_mesh(scheme);
    moving->describe(problem, mesh);
    mesh->cell = subject->kind == GM_MESH_FREE ? mesh->cell : NULL;
    return mesh->points <= GM_MESH_SUBJECT_POINTS && (!mesh->alone || subject->kind == GM_MESH_FREE) &&
           gm_mesh_start(mesh, subject->kind, moving->start, problem->parameters, subject->start);
}

bool gm_mesh_subject_advance(const struct gm_mesh_subject *subject, int64_t steps, const double *from,
                             double *end)
{
    struct gm_trial trial = subject->trial;
    trial.steps = steps;
    return gm_trial_advance(&trial, from, end);
}

bool gm_mesh_subject_shift(const struct gm_mesh_subject *subject, const double *by, double *state)
{
    const size_t points = subject->mesh.points;
    memcpy(state, subject->start, subject->trial.problem->n * sizeof *state);
    for (size_t i = 0; i < 2 * points && subject->mesh.alone; i++) {
        state[i] += by[i];
    }
    for (size_t i = 0; i < points && !subject->mesh.alone; i++) {
        state[i] += by[i];
        state[2 * points + i] += by[points + i];
        if (subject->kind == GM_MESH_FREE) { /* nodes move by other shares of the same directions */
            state[points + i] += by[points - 1 - i] / 4;
            state[3 * points + i] += by[2 * points - 1 - i] / 4 - by[i] / 8;
        }
    }
    if (subject->kind != GM_MESH_MOVING) {
        return true;
    }
    struct gm_elements stage = {0};
    struct gm_banded matrix = {0};
    double change[GM_MESH_SUBJECT_POINTS];
    bool good = gm_elements_open(&stage, &subject->mesh) && gm_banded_open(&matrix, points, 1);
    if (good) {
        gm_elements_place(&stage, state);
        good = gm_nodes_equidistribute(&stage, &subject->mesh, NULL, NULL, &matrix, change);
    }
    if (good) {
        /* dX/dt for dy/dt given: no slope, the rate is dy/dt */
        memcpy(state + points, stage.x + 1, points * sizeof *state);
        memcpy(stage.v + 1, state + 2 * points, points * sizeof *state);
        memset(stage.u, 0, (points + 2) * sizeof *stage.u);
        good = gm_nodes_set_in_motion(&stage, &matrix, state + 3 * points);
    }
    gm_banded_close(&matrix);
    gm_elements_close(&stage);
    return good;
}

bool gm_mesh_derive(const struct gm_map *map, size_t direction, double *derivative)
{
    const double start[2 * GM_MESH_SUBJECT_POINTS] = {0};
    double along[2 * GM_MESH_SUBJECT_POINTS] = {0};
    along[direction] = 1;
    return gm_differentiate(map, start, along, derivative);
}
