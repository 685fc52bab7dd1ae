/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Split-step Fourier method for i psi_t + psi_xx + k |psi|^2 psi = 0: both parts exactly,
       psi   := exp(i k |psi|^2 dt/2) psi
       psi_m := exp(-i m^2 dt) psi_m
       psi   := exp(i k |psi|^2 dt/2) psi
   R.H. Hardin & F.D. Tappert, SIAM Rev. 15 (1973) 423; J.A.C. Weideman & B.M. Herbst, SIAM J. Numer. Anal. 23
   (1986) 485: stable for dt < dx^2/pi on a plane wave's background. */
#include <complex.h>

#include "core/field/families/family.h"
#include "core/field/problems/problems.h"
#include "core/functions/functions.h"
#include "core/functions/rows.h"
#include "core/linear/fourier.h"

struct work {
    size_t points;
    struct gm_fourier *fourier;
    double *psi;                      /* pairs of real and imaginary part */
    double *turns;                    /* exp(-i m^2 dt), pairs */
    double *angles, *sines, *cosines; /* of the nonlinear part */
};

static void workspace_close(void *workspace)
{
    gm_fourier_close(((struct work *)workspace)->fourier);
    free(workspace);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    const size_t points = problem->line.points;
    struct work *work = calloc(1, sizeof *work + 7 * points * sizeof(double));
    struct gm_fourier *fourier = work ? gm_fourier_open(points) : NULL;
    if (!fourier) {
        free(work);
        return NULL;
    }
    *work = (struct work){.points = points, .fourier = fourier, .psi = (double *)(work + 1)};
    work->turns = work->psi + 2 * points;
    work->angles = work->turns + 2 * points;
    work->sines = work->angles + points;
    work->cosines = work->sines + points;
    return work;
}

static void turn(double *psi, double re, double im)
{
    const double old = psi[0];
    psi[0] = re * old - im * psi[1];
    psi[1] = re * psi[1] + im * old;
}

static void nonlinear_half(const struct work *work, double half)
{
    double *psi = work->psi;
    for (size_t i = 0; i < work->points; i++) {
        work->angles[i] = half * (psi[2 * i] * psi[2 * i] + psi[2 * i + 1] * psi[2 * i + 1]);
    }
    gm_function_rows()->sine_and_cosine(work->sines, work->cosines, work->angles, work->points);
    for (size_t i = 0; i < work->points; i++) {
        turn(psi + 2 * i, work->cosines[i], work->sines[i]);
    }
}

static struct gm_progress advance(const struct gm_task *task)
{
    struct work *work = task->workspace;
    const size_t points = work->points;
    const double period = task->problem->line.dx * (double)points;
    double *psi = work->psi;
    const double half = gm_nls_of(task->problem)->k * (task->dt / 2);
    struct gm_progress progress = {.status = GM_OK};
    for (size_t i = 0; i < points; i++) {
        const double k = 2 * M_PI / period * (i <= points / 2 ? (double)i : (double)i - (double)points);
        work->turns[2 * i] = gm_cos(k * k * task->dt);
        work->turns[2 * i + 1] = -gm_sin(k * k * task->dt);
        psi[2 * i] = task->y[i];
        psi[2 * i + 1] = task->y[points + i];
    }
    for (int64_t step = 0; step < task->steps; step++) {
        nonlinear_half(work, half);
        gm_fourier_forward(work->fourier, (double complex *)(void *)psi);
        for (size_t i = 0; i < points; i++) {
            turn(psi + 2 * i, work->turns[2 * i], work->turns[2 * i + 1]);
        }
        gm_fourier_inverse(work->fourier, (double complex *)(void *)psi);
        nonlinear_half(work, half);
        progress.evaluations++;
        if (!gm_field_stepped(task, &progress, psi, 2 * points)) {
            return progress;
        }
    }
    for (size_t i = 0; i < points; i++) {
        task->out[i] = psi[2 * i];
        task->out[points + i] = psi[2 * i + 1];
    }
    return progress;
}

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_split_step2, .family = &gm_family_split_step, .needs = GM_NEEDS_NLS, .in_modes = true},
};

const struct gm_family gm_family_split_step = {
    .title = "split-step Fourier",
    GM_FIELD_FAMILY,
    .loop = advance,
    .workspace_open = workspace_open,
    .workspace_close = workspace_close,
};
