/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The box scheme, all but the field eliminated, for equations of first order in time:
       a A^p (f^{n+1} - f^n)/dt + b D^p (f^{n+1} + f^n)/2 + Q g(A (f^{n+1} + f^n)/2) = 0.
   Korteweg-de Vries, eight points: Ascher & McLachlan, Appl. Numer. Math. 48 (2004) 255. Nonlinear
   Schroedinger, six points: Islas, Karpeev & Schober, J. Comput. Phys. 173 (2001) 116. The linear part is
   circulant and inverted by recursions; the rest is iterated to round-off. */
#include "core/families/dispersive_box.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/families/two_step.h"

/* Arrays of real parts, each followed by its imaginary parts; the first member is the one that closes. */
static double *array(const struct gm_two_step_work *work, size_t which)
{
    return work->memory + 2 * which * work->points;
}

enum { NOW, NEXT, RIGHT, MEAN, FORCE, ARRAYS };

void *gm_dispersive_open(const struct gm_problem *problem)
{
    struct gm_two_step_work *work = calloc(1, sizeof *work);
    double *memory = calloc(2 * ARRAYS * problem->line.points, sizeof *memory);
    if (!work || !memory) {
        free(work);
        free(memory);
        return NULL;
    }
    work->points = problem->line.points;
    work->memory = memory;
    return work;
}

/* out += (c0 + i c1) sum_k binomial(p, k) sign^(p - k) f_{i+k}, around the ring */
static void add_power(double *out, const double *f, size_t points, int power, double sign, double c0,
                      double c1)
{
    static const double binomial[4][4] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}};
    double weight[4];
    for (int k = 0; k <= power; k++) {
        weight[k] = binomial[power][k] * ((power - k) % 2 ? sign : 1);
    }
    for (size_t i = 0; i < points; i++) {
        double re = 0, im = 0;
        size_t at = i;
        for (int k = 0; k <= power; k++) {
            re += weight[k] * f[at];
            im += weight[k] * f[points + at];
            at = at + 1 < points ? at + 1 : 0;
        }
        out[i] += c0 * re - c1 * im;
        out[points + i] += c0 * im + c1 * re;
    }
}

/* One step from NOW to NEXT; with `base`, means of a solution in the cells, of the linearised scheme. */
static enum gm_status make_step(const struct gm_two_step_work *work, const struct gm_problem *problem,
                                const struct gm_ring_roots *ring, double dt, const double *base,
                                struct gm_progress *progress)
{
    enum { MOST = 500 };
    const struct gm_dispersive *equation = problem->dispersive;
    const size_t points = work->points, count = 2 * points;
    const int p = equation->power;
    const double b = equation->dispersion(problem) / pow(problem->line.dx, p), half = pow(0.5, p) / dt;
    double *now = array(work, NOW), *next = array(work, NEXT), *right = array(work, RIGHT);
    double *mean = array(work, MEAN), *force = array(work, FORCE);
    memset(right, 0, count * sizeof *right);
    add_power(right, now, points, p, 1, half * equation->factor[0], half * equation->factor[1]);
    add_power(right, now, points, p, -1, -b / 2, 0);
    memcpy(next, now, count * sizeof *next);
    double last = INFINITY;
    for (int k = 0; k < MOST; k++) {
        memset(mean, 0, count * sizeof *mean);
        add_power(mean, now, points, 1, 1, 0.25, 0);
        add_power(mean, next, points, 1, 1, 0.25, 0);
        if (base) {
            equation->linearised(problem, base, mean, force, points);
        } else {
            equation->nonlinear(problem, mean, mean + points, force, force + points, points);
        }
        memcpy(mean, right, count * sizeof *mean);
        if (equation->derivative) {
            /* A D: (f_{i+2} - f_i) / (2 dx) */
            const double over = -0.5 / problem->line.dx;
            add_power(mean, force, points, 2, 1, over, 0);
            add_power(mean, force, points, 1, 1, -2 * over, 0);
        } else {
            add_power(mean, force, points, 1, 1, -0.5, 0);
        }
        gm_ring_roots_solve(ring, mean, mean + points, force);
        double change = 0, largest = 0;
        for (size_t i = 0; i < count; i++) {
            const double size = fabs(mean[i] - next[i]);
            change = size > change || isnan(size) ? size : change;
            largest = fmax(largest, fabs(mean[i]));
            next[i] = mean[i];
        }
        progress->evaluations++;
        progress->solves++;
        progress->iterations++;
        if (!isfinite(change)) {
            return GM_NO_CONVERGENCE; /* the iteration diverged, not the solution */
        }
        if (change <= 1e-16 * largest || (change >= last && change <= 1e-12 * fmax(largest, 1e-3))) {
            return GM_OK;
        }
        last = change;
    }
    return GM_NO_CONVERGENCE;
}

static bool within(const double *f, size_t count, double limit)
{
    for (size_t i = 0; i < count; i++) {
        if (!(fabs(f[i]) <= limit)) {
            return false;
        }
    }
    return true;
}

/* The circulant part of the scheme. */
static bool make_ring(struct gm_ring_roots *ring, const struct gm_problem *problem, double dt)
{
    const struct gm_dispersive *equation = problem->dispersive;
    return gm_ring_roots_make(ring, problem->line.points, equation->power,
                              (equation->factor[0] + I * equation->factor[1]) / dt,
                              equation->dispersion(problem) / 2, problem->line.dx);
}

enum gm_status gm_dispersive_tangent(struct gm_two_step_work *work, const struct gm_problem *problem,
                                     double dt, const double *base, const double *now, double *next)
{
    const size_t size = 2 * work->points * sizeof(double);
    struct gm_ring_roots ring;
    struct gm_progress progress = {.status = GM_OK};
    if (!make_ring(&ring, problem, dt)) {
        return GM_NO_CONVERGENCE;
    }
    memcpy(array(work, NOW), now, size);
    const enum gm_status status = make_step(work, problem, &ring, dt, base, &progress);
    memcpy(next, array(work, NEXT), size);
    return status;
}

struct gm_progress gm_dispersive_advance(const struct gm_task *task)
{
    const struct gm_two_step_work *work = task->workspace;
    const struct gm_dispersive *equation = task->problem->dispersive;
    const size_t points = work->points, size = points * sizeof(double);
    struct gm_progress progress = {.status = GM_OK};
    double *now = array(work, NOW), *next = array(work, NEXT);
    struct gm_ring_roots ring;
    if (!make_ring(&ring, task->problem, task->dt)) {
        progress.status = GM_NO_CONVERGENCE;
        return progress;
    }
    memcpy(next, task->y, size);
    memset(next + points, 0, size);
    if (equation->complex_valued) {
        memcpy(next + points, task->y + points, size);
    }
    for (long k = 0; k < task->steps; k++) {
        memcpy(now, next, 2 * size);
        progress.status = make_step(work, task->problem, &ring, task->dt, NULL, &progress);
        if (!equation->complex_valued) {
            /* what rounding leaves of an imaginary part */
            memset(next + points, 0, size);
        }
        if (progress.status == GM_OK && !within(next, 2 * points, task->limit)) {
            progress.status = GM_BLOW_UP;
        }
        if (progress.status != GM_OK) {
            return progress;
        }
        progress.done++;
    }
    memcpy(task->out, next, size);
    if (equation->complex_valued) {
        memcpy(task->out + points, next + points, size);
    } else {
        memcpy(task->out + points, now, size);
        task->out[2 * points] = -task->dt;
    }
    return progress;
}
