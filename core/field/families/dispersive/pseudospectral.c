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

/* Complex numbers are pairs of doubles, one of each wave 0 .. points / 2. */
struct work {
    size_t points;
    struct gm_modes modes;
    double *u, *stage, *sum, *rate[4];   /* waves */
    double *turn;                        /* e */
    double *number;                      /* k; 0 for the mode that alternates */
    double *level[2], *nodes, *products; /* points of each */
};

static void workspace_close(void *workspace)
{
    gm_modes_close(&((struct work *)workspace)->modes);
    free(workspace);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    enum { ARRAYS = 13 };
    const size_t points = problem->line.points, size = 2 * gm_modes_half(points);
    struct work *work = calloc(1, sizeof *work + ARRAYS * size * sizeof(double));
    if (!work) {
        return NULL;
    }
    double *next = (double *)(work + 1);
    double **const arrays[ARRAYS] = {&work->u,       &work->stage,    &work->rate[0],  &work->rate[1],
                                     &work->rate[2], &work->rate[3],  &work->turn,     &work->sum,
                                     &work->number,  &work->level[0], &work->level[1], &work->nodes,
                                     &work->products};
    for (size_t i = 0; i < ARRAYS; i++, next += size) {
        *arrays[i] = next;
    }
    work->points = points;
    if (!gm_modes_open(&work->modes, points, 1)) {
        free(work);
        return NULL;
    }
    return work;
}

/* to := u^2 at the nodes */
GM_CLONES static void square_nodes(const double *u, double *restrict to, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        to[i] = u[i] * u[i];
    }
}

/* The derivative of the waves of u^2 times -eta/2. */
GM_CLONES static void differentiate(double *restrict rate, const double *number, double half_eta,
                                    size_t count)
{
    for (size_t k = 0; k < count; k++) {
        const double factor = half_eta * number[k], real = rate[2 * k];
        rate[2 * k] = factor * rate[2 * k + 1];
        rate[2 * k + 1] = -(factor * real);
    }
}

/* N of the field at the nodes. */
static void find_rate(struct work *work, double half_eta, const double *nodes, double *rate)
{
    square_nodes(nodes, work->products, work->points);
    gm_modes_forward(&work->modes, work->products, (double complex *)(void *)rate);
    differentiate(rate, work->number, half_eta, gm_modes_half(work->points));
}

static void find_stage_rate(struct work *work, double half_eta, double *rate)
{
    gm_modes_back(&work->modes, (double complex *)(void *)work->stage, work->nodes);
    find_rate(work, half_eta, work->nodes, rate);
}

/* to := e (u + a rate). No clones: gcc 12 fuses the multiplications and additions of such pairs where the processor can,
   in spite of -ffp-contract=off. */
static void turn_sum(const double *e, const double *u, double a, const double *rate, double *restrict to,
                     size_t count)
{
    for (size_t k = 0; k < 2 * count; k += 2) {
        const double re = u[k] + a * rate[k], im = u[k + 1] + a * rate[k + 1];
        to[k] = e[k] * re - e[k + 1] * im;
        to[k + 1] = e[k] * im + e[k + 1] * re;
    }
}

/* to := u + a rate */
GM_CLONES static void add_multiple(const double *u, double a, const double *rate, double *restrict to,
                                   size_t count)
{
    for (size_t k = 0; k < 2 * count; k++) {
        to[k] = u[k] + a * rate[k];
    }
}

static void prepare(struct work *work, const struct gm_problem *problem, double dt)
{
    const double period = problem->line.dx * (double)work->points, mu = gm_kdv_of(problem)->mu;
    for (size_t k = 0; k < gm_modes_half(work->points); k++) {
        work->number[k] = 2 * k == work->points ? 0 : 2 * M_PI / period * (double)k;
        const double angle = mu * work->number[k] * work->number[k] * work->number[k] * dt / 2;
        work->turn[2 * k] = gm_cos(angle);
        work->turn[2 * k + 1] = gm_sin(angle);
    }
}

/* The sums are factored: e^2 u + dt e c = e (e u + dt c). */
static void step(struct work *work, const struct gm_problem *problem, double dt, const double *now,
                 double *next)
{
    const size_t count = gm_modes_half(work->points);
    const double half_eta = gm_kdv_of(problem)->eta / 2;
    const double *e = work->turn, *u = work->u;
    double *stage = work->stage, *sum = work->sum, *const *rate = work->rate;
    gm_modes_forward(&work->modes, now, (double complex *)(void *)work->u);
    find_rate(work, half_eta, now, rate[0]);
    turn_sum(e, u, dt / 2, rate[0], stage, count);
    find_stage_rate(work, half_eta, rate[1]);
    turn_sum(e, u, 0, u, sum, count);
    add_multiple(sum, dt / 2, rate[1], stage, count);
    find_stage_rate(work, half_eta, rate[2]);
    turn_sum(e, sum, dt, rate[2], stage, count);
    find_stage_rate(work, half_eta, rate[3]);
    turn_sum(e, u, dt / 6, rate[0], stage, count);
    add_multiple(stage, dt / 3, rate[1], sum, count);
    turn_sum(e, sum, dt / 3, rate[2], stage, count);
    add_multiple(stage, dt / 6, rate[3], sum, count);
    gm_modes_back(&work->modes, (double complex *)(void *)sum, next);
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
