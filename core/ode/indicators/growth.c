/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sums of the exponents and of MEGNO, taken after every step, M the derivative of the step: with Q R = M Q by
   modified Gram-Schmidt the sum of number k grows by ln R_kk, and Q are the vectors of the next step. A vector alone
   is given the length 1. */
#include "core/ode/indicators/growth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/functions/functions.h"
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
    double *v; /* the vectors, orthonormal in their n first numbers */
    size_t vectors;
    bool failed;
    double *logarithms; /* the sums of all vectors, if they are n; then n * n numbers of scratch */
    struct sums sums;   /* of the first vector */
    /* the sums after 0, every, 2 every ... steps; when all are full every other one goes */
    struct sums records[RECORDS];
    size_t recorded;
    int64_t every;
};

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
    growth->vectors = 1;
    growth->run = gm_run_open(&growth->problem, scheme, settings, t0, dt, y0);
    growth->tangent = growth->run ? gm_tangent_open(growth->run) : NULL;
    growth->v = growth->tangent ? calloc(gm_tangent_size(growth->tangent), sizeof *growth->v) : NULL;
    if (!growth->v) {
        gm_growth_close(growth);
        return NULL;
    }
    choose_direction(growth->v, growth->problem.n - (gm_has_time(&growth->problem) ? 1 : 0));
    growth->failed = !gm_tangent_begin(growth->tangent, growth->v);
    return growth;
}

void gm_growth_close(struct gm_growth *growth)
{
    if (!growth) {
        return;
    }
    free(growth->v);
    free(growth->logarithms);
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
    const double ratio = gm_log(length);
    sums->growth += ratio;
    sums->moment += (sums->time + step / 2) * ratio;
    sums->time += step;
    sums->average += sums->time > 0 ? 2 * sums->moment / sums->time * step : 0;
}

/* ---- all vectors ---- */

/* Makes the vectors orthonormal in the units of the components, one after the other, and adds the logarithms of what is
   left of their lengths. Returns the first of these lengths. */
static double orthonormalise(const struct gm_growth *growth)
{
    const size_t n = growth->problem.n, size = gm_tangent_size(growth->tangent);
    const double *units = gm_tangent_units(growth->tangent);
    double first = 0;
    for (size_t k = 0; k < growth->vectors; k++) {
        for (size_t c = 0; c < n; c++) {
            growth->v[k * size + c] /= units[c];
        }
        const double square = gm_tangent_orthonormalise(growth->v, k, n, size);
        growth->logarithms[k] += gm_log(square) / 2;
        first = k == 0 ? sqrt(square) : first;
    }
    for (size_t i = 0; i < growth->vectors * size; i++) {
        growth->v[i] *= i % size < n ? units[i % size] : 1;
    }
    return first;
}

bool gm_growth_follow_all(struct gm_growth *growth)
{
    const size_t n = growth->problem.n, size = gm_tangent_size(growth->tangent);
    double *v = calloc(n * size, sizeof *v);
    growth->logarithms = calloc(n + n * n, sizeof *growth->logarithms);
    if (!v || !growth->logarithms) {
        free(v);
        return false;
    }
    free(growth->v);
    growth->v = v;
    growth->vectors = n;
    gm_tangent_follow_volume(growth->tangent, growth->logarithms + n);
    for (size_t k = 0; k < n; k++) {
        v[k * size + k] = gm_tangent_units(growth->tangent)[k];
        growth->failed = growth->failed || !gm_tangent_begin(growth->tangent, v + k * size);
    }
    return true;
}

static double log_volume_of(const struct gm_growth *growth)
{
    double sum = 0;
    for (size_t k = 0; growth->logarithms && k < growth->vectors; k++) {
        sum += growth->logarithms[k];
    }
    return sum;
}

/* Makes a step with all vectors, and fills what it made of the first one. Returns the number of steps made. */
static size_t step_all(struct gm_growth *growth, struct gm_stretch *made)
{
    const bool stepped = gm_tangent_step(growth->tangent, growth->v, growth->vectors);
    *made = (struct gm_stretch){growth->run->t, orthonormalise(growth)};
    return stepped;
}

/* ---- advancing ---- */

const char *gm_growth_to(struct gm_growth *growth, int64_t steps)
{
    struct gm_stretch made[BLOCK];
    const struct gm_run *run = growth->run;
    while (!growth->failed && run->steps < steps) {
        const int64_t before = run->steps, left = steps - before;
        const size_t block = growth->logarithms ? 1 : left < BLOCK ? (size_t)left : BLOCK;
        double t = run->t;
        const size_t count = growth->logarithms ? step_all(growth, made)
                                                : gm_tangent_advance(growth->tangent, growth->v, block, made);
        for (size_t i = 0; i < count; i++) {
            add(growth, fabs(made[i].t - t), made[i].length);
            record(growth, before + (int64_t)i + 1);
            t = made[i].t;
        }
        growth->failed = count < block;
    }
    return !growth->failed ? NULL
           : gm_tangent_grazes(growth->tangent)
               ? "an event there has no tangent: the motion only touches its surface, or another event calls it"
               : "a step beside the orbit fails";
}

const struct gm_run *gm_growth_run(const struct gm_growth *growth)
{
    return growth->run;
}

struct gm_growth_values gm_growth_values(const struct gm_growth *growth)
{
    const struct sums *now = &growth->sums;
    const struct sums *half = &growth->records[growth->run->steps / 2 / growth->every];
    const double exponent = now->growth / now->time, megno = now->average / now->time;
    return (struct gm_growth_values){
        .exponent = exponent,
        .megno = megno,
        .exponent_change = exponent - half->growth / half->time,
        .megno_change = megno - half->average / half->time,
        .log_volume = log_volume_of(growth),
        .divergence = gm_tangent_volume(growth->tangent),
        .time = now->time,
    };
}

static int compare_falling(const void *a, const void *b)
{
    const double first = *(const double *)a, second = *(const double *)b;
    return (first < second) - (first > second);
}

size_t gm_growth_exponents(const struct gm_growth *growth, double *exponents)
{
    for (size_t k = 0; k < growth->vectors; k++) {
        exponents[k] = (growth->logarithms ? growth->logarithms[k] : growth->sums.growth) / growth->sums.time;
    }
    qsort(exponents, growth->vectors, sizeof *exponents, compare_falling);
    return growth->vectors;
}
