/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sums of the exponent and of MEGNO, taken after every step; the vector is given the length 1 again each
   time. */
#include "core/ode/indicators/growth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/ode/indicators/tangent.h"
#include "core/ode/kernel/members.h"
#include "core/ode/ode.h"

enum { RECORDS = 128, BLOCK = 128 /* steps */ };

struct sums {
    double time;    /* since the start */
    double growth;  /* ln(d(t) / d(0)) */
    double moment;  /* int_0^t s d'/d ds */
    double average; /* int_0^t Y ds */
};

struct gm_growth {
    struct gm_problem problem;
    struct gm_run *run;
    struct gm_tangent *tangent;
    double *v;
    bool failed;
    double *frame;  /* n vectors, orthonormal in their n first numbers, then a Jacobian; NULL: no volume */
    void *snapshot; /* the run before a step, which is repeated for each vector */
    struct gm_run *half; /* makes steps of half the length */
    double log_volume, divergence;
    struct sums sums;
    /* the sums after 0, every, 2 every ... steps; when all are full every other one goes */
    struct sums records[RECORDS];
    size_t recorded;
    int64_t every;
};

/* Returns true if the last component is the time: neighbouring orbits have the same. */
static bool has_time(const struct gm_problem *problem)
{
    const char *names = gm_ode_of(problem)->components, *last = names ? strrchr(names, ' ') : NULL;
    return last && strcmp(last, " t") == 0;
}

/* Fills v with a unit vector whose components all differ: fractions of multiples of the golden mean lie
   evenly. */
static void choose_direction(double *v, size_t n)
{
    const double golden = 0.6180339887498949;
    double square = 0;
    for (size_t i = 0; i < n; i++) {
        const double part = golden * (double)(i + 1);
        v[i] = part - floor(part) - 0.5;
        square += v[i] * v[i];
    }
    for (size_t i = 0; i < n; i++) {
        v[i] /= sqrt(square);
    }
}

struct gm_growth *gm_growth_open(const struct gm_problem *problem, const struct gm_scheme *scheme,
                                 const struct gm_settings *settings, double t0, double dt, const double *y0)
{
    struct gm_growth *growth = calloc(1, sizeof *growth);
    if (!growth) {
        return NULL;
    }
    growth->problem = *problem;
    growth->problem.n -= 2 * problem->passive;
    growth->problem.passive = 0;
    growth->problem.m = 1;
    growth->every = 1;
    growth->recorded = 1;
    growth->run = gm_run_open(&growth->problem, scheme, settings, t0, dt, y0);
    growth->tangent = growth->run ? gm_tangent_open(growth->run) : NULL;
    growth->v = growth->tangent ? calloc(gm_tangent_size(growth->tangent), sizeof *growth->v) : NULL;
    if (!growth->v) {
        gm_growth_close(growth);
        return NULL;
    }
    choose_direction(growth->v, growth->problem.n - (has_time(&growth->problem) ? 1 : 0));
    growth->failed = !gm_tangent_begin(growth->tangent, growth->v);
    return growth;
}

void gm_growth_close(struct gm_growth *growth)
{
    if (!growth) {
        return;
    }
    free(growth->v);
    free(growth->frame);
    free(growth->snapshot);
    gm_run_close(growth->half);
    gm_tangent_close(growth->tangent);
    gm_run_close(growth->run);
    free(growth);
}

static void record(struct gm_growth *growth, int64_t steps)
{
    if (steps % growth->every != 0) {
        return;
    }
    if (growth->recorded == RECORDS) {
        for (size_t i = 0; i < RECORDS / 2; i++) {
            growth->records[i] = growth->records[2 * i];
        }
        growth->recorded = RECORDS / 2;
        growth->every *= 2;
    }
    growth->records[growth->recorded++] = growth->sums;
}

/* Adds a step of this length in time, in which the vector has grown by the factor `length`. */
static void add(struct gm_growth *growth, double step, double length)
{
    struct sums *sums = &growth->sums;
    const double ratio = log(length);
    sums->growth += ratio;
    sums->moment += (sums->time + step / 2) * ratio;
    sums->time += step;
    sums->average += sums->time > 0 ? 2 * sums->moment / sums->time * step : 0;
}

/* ---- volume ---- */

bool gm_growth_follow_volume(struct gm_growth *growth)
{
    const struct gm_run *run = growth->run;
    const size_t n = growth->problem.n, size = gm_tangent_size(growth->tangent);
    growth->frame = calloc(n * (size + n), sizeof *growth->frame);
    growth->snapshot = malloc(gm_run_snapshot_size(run));
    growth->half =
        gm_run_open(&growth->problem, run->scheme, &run->settings, run->t0, run->dt / 2, gm_run_state(run));
    for (size_t i = 0; growth->frame && i < n; i++) {
        growth->frame[i * size + i] = 1;
        growth->failed = growth->failed || !gm_tangent_begin(growth->tangent, growth->frame + i * size);
    }
    return growth->frame && growth->snapshot && growth->half;
}

/* Makes the vectors orthonormal, one after the other. Returns the logarithm of the volume that they spanned. */
static double orthonormalise(const struct gm_growth *growth)
{
    const size_t n = growth->problem.n, size = gm_tangent_size(growth->tangent);
    double logarithm = 0;
    for (double *v = growth->frame; v < growth->frame + n * size; v += size) {
        double square = 0;
        for (const double *u = growth->frame; u < v; u += size) {
            double along = 0;
            for (size_t c = 0; c < n; c++) {
                along += u[c] * v[c];
            }
            for (size_t c = 0; c < size; c++) {
                v[c] -= along * u[c];
            }
        }
        for (size_t c = 0; c < n; c++) {
            square += v[c] * v[c];
        }
        if (square == 0) {
            return -INFINITY;
        }
        for (size_t c = 0; c < size; c++) {
            v[c] /= sqrt(square);
        }
        logarithm += log(square) / 2;
    }
    return logarithm;
}

static double divergence_at(const struct gm_growth *growth, const struct gm_run *run)
{
    const size_t n = growth->problem.n;
    double *jacobian = growth->frame + n * gm_tangent_size(growth->tangent), sum = 0;
    const bool known = gm_jacobian(&growth->problem, gm_run_state(run), jacobian);
    for (size_t c = 0; c < n; c++) {
        sum += jacobian[c * n + c];
    }
    return known ? sum : NAN;
}

/* Makes a step of the run, from the same state for each vector. */
static bool step_volume(struct gm_growth *growth)
{
    struct gm_run *run = growth->run;
    const size_t n = growth->problem.n, size = gm_tangent_size(growth->tangent);
    if (growth->log_volume == -INFINITY) { /* it stays 0 */
        return gm_run_advance(run, 1) == GM_OK;
    }
    const double t = run->t, before = divergence_at(growth, run);
    gm_run_set_state(growth->half, gm_run_state(run), NULL);
    const double middle =
        gm_run_advance(growth->half, 1) == GM_OK ? divergence_at(growth, growth->half) : NAN;
    gm_run_save(run, growth->snapshot);
    bool good = true;
    for (size_t i = 0; good && i < n; i++) {
        good = (i == 0 || gm_run_load(run, growth->snapshot)) &&
               gm_tangent_step(growth->tangent, growth->frame + i * size);
    }
    growth->log_volume += orthonormalise(growth);
    growth->divergence += (run->t - t) / 6 * (before + 4 * middle + divergence_at(growth, run));
    return good;
}

/* ---- advancing ---- */

bool gm_growth_to(struct gm_growth *growth, int64_t steps)
{
    struct gm_stretch made[BLOCK];
    const struct gm_run *run = growth->run;
    while (growth->frame && !growth->failed && run->steps < steps) {
        growth->failed = !step_volume(growth);
    }
    while (!growth->failed && run->steps < steps) {
        const int64_t before = run->steps, left = steps - before;
        const size_t block = left < BLOCK ? (size_t)left : BLOCK;
        double t = run->t;
        const size_t count = gm_tangent_advance(growth->tangent, growth->v, block, made);
        for (size_t i = 0; i < count; i++) {
            add(growth, fabs(made[i].t - t), made[i].length);
            record(growth, before + (int64_t)i + 1);
            t = made[i].t;
        }
        growth->failed = count < block;
    }
    return !growth->failed;
}

bool gm_growth_grazes(const struct gm_growth *growth)
{
    return gm_tangent_grazes(growth->tangent);
}

const struct gm_run *gm_growth_run(const struct gm_growth *growth)
{
    return growth->run;
}

struct gm_growth_values gm_growth_values(const struct gm_growth *growth)
{
    if (growth->frame) { /* a volume has no records */
        return (struct gm_growth_values){.log_volume = growth->log_volume, .divergence = growth->divergence};
    }
    const struct sums *now = &growth->sums;
    const struct sums *half = &growth->records[growth->run->steps / 2 / growth->every];
    const double exponent = now->growth / now->time, megno = now->average / now->time;
    return (struct gm_growth_values){
        .exponent = exponent,
        .megno = megno,
        .exponent_change = exponent - half->growth / half->time,
        .megno_change = megno - half->average / half->time,
    };
}
