/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Splitting of a field f = f_1 + ... + f_s into parts of zero divergence with exact flows F_i:
       volume-splitting1 = F_s(h) ... F_2(h) F_1(h)
       volume-splitting2 = F_1(h/2) ... F_s(h) ... F_1(h/2)
   K. Feng & Z.-J. Shang, Numer. Math. 71 (1995) 451; H. Ammari, lecture 5. */
#include <string.h>

#include "core/basics.h"
#include "core/ode/families/families.h"
#include "core/ode_scheme_texts.h"

enum form { SIMPLE, PALINDROME };
static const enum form simple = SIMPLE, palindrome = PALINDROME;

static void pass(const struct gm_task *task, double *y)
{
    const struct gm_problem *problem = task->problem;
    const struct gm_volume *volume = gm_ode_of(problem)->volume;
    const enum form form = *(const enum form *)task->scheme->coefficients;
    const double h = form == SIMPLE ? task->dt : task->dt / 2;
    for (size_t piece = 0; piece + (form == PALINDROME) < volume->pieces; piece++) {
        volume->flow(problem, piece, h, y, problem->m);
    }
    if (form == PALINDROME) {
        volume->flow(problem, volume->pieces - 1, task->dt, y, problem->m);
        for (size_t piece = volume->pieces - 1; piece-- > 0;) {
            volume->flow(problem, piece, h, y, problem->m);
        }
    }
}

/* a NaN compares false */
static bool is_within(const double *y, size_t count, double limit)
{
    bool good = true;
    for (size_t i = 0; i < count; i++) {
        good &= y[i] <= limit && y[i] >= -limit;
    }
    return good;
}

static struct gm_progress loop(const struct gm_task *task)
{
    const size_t count = task->problem->n * task->problem->m;
    struct gm_progress progress = {.done = task->steps, .status = GM_OK};
    memcpy(task->out, task->y, count * sizeof(double));
    for (int64_t done = 0; done < progress.done; done++) {
        pass(task, task->out);
        if (!is_within(task->out, count, task->limit)) {
            progress.done = done;
            progress.status = GM_BLOW_UP;
        }
    }
    progress.evaluations = (unsigned long)progress.done * task->problem->m;
    return progress;
}

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_volume_splitting1, .family = &gm_family_volume, .coefficients = &simple,
     .needs = GM_NEEDS_VOLUME},
    {GM_TEXTS_volume_splitting2, .family = &gm_family_volume, .coefficients = &palindrome,
     .needs = GM_NEEDS_VOLUME},
};

const struct gm_family gm_family_volume = {
    .kind = &gm_kind_ode,
    .title = "volume-preserving splitting",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = loop,
};
