/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fourier pseudo-spectral method for u_t + eta u u_x + mu u_xxx = 0: derivatives by Fourier modes u_k,
   products at the nodes, the linear part exactly and the rest by the classical Runge-Kutta method for exp(-i
   mu k^3 t) u_k,
       N(u)_k = -i k eta/2 (u^2)_k,   e = exp(i mu k^3 dt/2)
       a = N(u),   b = N(e (u + dt/2 a)),   c = N(e u + dt/2 b),   d = N(e^2 u + dt e c)
       u := e^2 u + dt/6 (e^2 a + 2 e (b + c) + d).
   J.D. Lawson, SIAM J. Numer. Anal. 4 (1967) 372; B. Fornberg & G.B. Whitham, Phil. Trans. R. Soc. A 289
   (1978) 373. It is not symplectic and has no local laws; its error in space falls faster than every power of
   dx while the nodes resolve the field; finer parts are aliased to coarse
   waves. D. Dutykh, M. Chhay & F. Fedele, Comput. Math. Math. Phys. 53 (2013) 221, compare such a method with
   the box. */
#include <complex.h>

#include "core/field/families/family.h"
#include "core/field/problems/problems.h"
#include "core/functions/functions.h"
#include "core/linear/fourier.h"

struct work {
    size_t points;
    struct gm_fourier *fourier;
    /* arrays of `points` numbers, one per mode */
    double complex *modes, *turn, *square, *stage, *rate[4];
    double *number; /* k; 0 for the mode that alternates */
    double *level[2];
};

static void workspace_close(void *workspace)
{
    gm_fourier_close(((struct work *)workspace)->fourier);
    free(workspace);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    enum { COMPLEX = 8, REAL = 3 };
    const size_t points = problem->line.points;
    struct work *work =
        calloc(1, sizeof *work + points * (COMPLEX * sizeof(double complex) + REAL * sizeof(double)));
    struct gm_fourier *fourier = work ? gm_fourier_open(points) : NULL;
    if (!fourier) {
        free(work);
        return NULL;
    }
    double complex *next = (double complex *)(void *)(work + 1);
    double complex **const arrays[] = {&work->modes,   &work->turn,    &work->square,  &work->stage,
                                       &work->rate[0], &work->rate[1], &work->rate[2], &work->rate[3]};
    for (size_t i = 0; i < COMPLEX; i++, next += points) {
        *arrays[i] = next;
    }
    work->points = points;
    work->fourier = fourier;
    work->number = (double *)next;
    work->level[0] = work->number + points;
    work->level[1] = work->level[0] + points;
    return work;
}

/* N of the modes; they are left alone. */
static void find_rate(struct work *work, double half_eta, const double complex *modes, double complex *rate)
{
    const size_t points = work->points;
    memcpy(rate, modes, points * sizeof *rate);
    gm_fourier_inverse(work->fourier, rate);
    for (size_t i = 0; i < points; i++) {
        rate[i] = creal(rate[i]) * creal(rate[i]);
    }
    gm_fourier_forward(work->fourier, rate);
    for (size_t k = 0; k < points; k++) {
        const double factor = half_eta * work->number[k];
        rate[k] = factor * cimag(rate[k]) - I * (factor * creal(rate[k]));
    }
}

static void prepare(struct work *work, const struct gm_problem *problem, double dt)
{
    const size_t points = work->points;
    const double period = problem->line.dx * (double)points, mu = gm_kdv_of(problem)->mu;
    for (size_t k = 0; k < points; k++) {
        const double number = k <= points / 2 ? (double)k : (double)k - (double)points;
        work->number[k] = 2 * k == points ? 0 : 2 * M_PI / period * number;
        const double angle = mu * work->number[k] * work->number[k] * work->number[k] * dt / 2;
        work->turn[k] = gm_cos(angle) + I * gm_sin(angle);
        work->square[k] = gm_cos(2 * angle) + I * gm_sin(2 * angle);
    }
}

static void step(struct work *work, const struct gm_problem *problem, double dt, const double *now,
                 double *next)
{
    const size_t points = work->points;
    const double half_eta = gm_kdv_of(problem)->eta / 2;
    double complex *u = work->modes, *stage = work->stage, *const *rate = work->rate;
    const double complex *e = work->turn, *e2 = work->square;
    for (size_t i = 0; i < points; i++) {
        u[i] = now[i];
    }
    gm_fourier_forward(work->fourier, u);
    find_rate(work, half_eta, u, rate[0]);
    for (size_t k = 0; k < points; k++) {
        stage[k] = e[k] * (u[k] + dt / 2 * rate[0][k]);
    }
    find_rate(work, half_eta, stage, rate[1]);
    for (size_t k = 0; k < points; k++) {
        stage[k] = e[k] * u[k] + dt / 2 * rate[1][k];
    }
    find_rate(work, half_eta, stage, rate[2]);
    for (size_t k = 0; k < points; k++) {
        stage[k] = e2[k] * u[k] + dt * e[k] * rate[2][k];
    }
    find_rate(work, half_eta, stage, rate[3]);
    for (size_t k = 0; k < points; k++) {
        u[k] =
            e2[k] * u[k] + dt / 6 * (e2[k] * rate[0][k] + 2 * e[k] * (rate[1][k] + rate[2][k]) + rate[3][k]);
    }
    gm_fourier_inverse(work->fourier, u);
    for (size_t i = 0; i < points; i++) {
        next[i] = creal(u[i]);
    }
}

static struct gm_progress advance(const struct gm_task *task)
{
    struct work *work = task->workspace;
    const size_t size = work->points * sizeof(double);
    struct gm_progress progress = {.status = GM_OK};
    prepare(work, task->problem, task->dt);
    double *now = work->level[0], *other = work->level[1];
    memcpy(now, task->y, size);
    memcpy(other, task->y + work->points, size);
    for (int64_t k = 0; k < task->steps; k++) {
        step(work, task->problem, task->dt, now, other);
        progress.evaluations += 4;
        if (!gm_field_stepped(task, &progress, other, work->points)) {
            return progress;
        }
        double *past = now;
        now = other;
        other = past;
    }
    gm_wave_write(task, now, other);
    return progress;
}

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_fourier_rk4, .family = &gm_family_pseudospectral, .needs = GM_NEEDS_KDV, .in_modes = true},
};

const struct gm_family gm_family_pseudospectral = {
    .title = "Fourier pseudo-spectral",
    GM_FIELD_FAMILY,
    .loop = advance,
    .workspace_open = workspace_open,
    .workspace_close = workspace_close,
};
