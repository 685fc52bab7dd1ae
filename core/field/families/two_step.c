/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes of two steps for u_tt - u_xx + V'(u) = 0, d2 u = (u_{i+1} - 2 u_i + u_{i-1}) / dx^2:
       leapfrog            (u^{n+1} - 2 u^n + u^{n-1}) / dt^2 = d2 u^n - V'(u^n)
       energy-conserving   (u^{n+1} - 2 u^n + u^{n-1}) / dt^2 = d2 u^n - [V(u^{n+1}) - V(u^{n-1})]
                                                                         / (u^{n+1} - u^{n-1})
       Euler box           M+ D_t^+ s - M+' D_t^- s + K+ D_x^+ s - K+' D_x^- s = grad S(s)
   In the Euler box M = M+ - M+', K = K+ - K+' are split into triangles; with v and w eliminated it is
   leapfrog, so leapfrog is multisymplectic as well. B. Moore & S. Reich, Numer. Math. 95 (2003) 625.
   Energy-conserving: W. Strauss & L. Vazquez, J. Comput. Phys. 28 (1978) 271. Stable where, with V'' at the
   solution,
       leapfrog            4/dt^2        >= 4/dx^2 + V''
       energy-conserving   4/dt^2 + V''  >= 4/dx^2 */
#include "core/field/families/two_step.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/clones.h"
#include "core/field/families/families.h"
#include "core/field/families/wave_form.h"

void *gm_two_step_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    enum { ARRAYS = 8 };
    const size_t points = problem->line.points, length = points + 2;
    struct gm_two_step_work *work = calloc(1, sizeof *work);
    double *memory = calloc(ARRAYS * length, sizeof *memory);
    if (!work || !memory) {
        free(work);
        free(memory);
        return NULL;
    }
    work->points = points;
    work->memory = memory;
    double **const arrays[ARRAYS] = {&work->level[0], &work->level[1], &work->level[2], &work->force,
                                     &work->right,    &work->guess,    &work->cells,    &work->change};
    for (size_t i = 0; i < ARRAYS; i++) {
        *arrays[i] = memory + i * length + 1;
    }
    return work;
}

void gm_two_step_close(void *workspace)
{
    struct gm_two_step_work *work = workspace;
    gm_ring_newton_close(&work->newton);
    free(work->memory);
    free(work);
}

GM_CLONES static void explicit_step(const double *restrict past, const double *restrict now,
                                    const double *restrict force, double *restrict next, size_t points,
                                    double ratio, double square)
{
    for (size_t i = 1; i <= points; i++) {
        const double curvature = now[i + 1] - 2 * now[i] + now[i - 1];
        next[i] = 2 * now[i] - past[i] + ratio * curvature - square * force[i];
    }
}

GM_CLONES static bool within(const double *level, size_t points, double limit)
{
    long outside = 0;
    for (size_t i = 0; i < points; i++) {
        outside += !(fabs(level[i]) <= limit);
    }
    return outside == 0;
}

static enum gm_status leapfrog(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                               const double *past, const double *now, double *next,
                               struct gm_progress *progress)
{
    const double dx = problem->line.dx;
    gm_field_of(problem)->wave->slopes(now, work->force, work->points);
    explicit_step(past - 1, now - 1, work->force - 1, next - 1, work->points, dt * dt / (dx * dx), dt * dt);
    progress->evaluations++;
    return GM_OK;
}

/* c + dt^2 Q(now + c, past) = right, from the guess c; NaN if Newton's method does not settle */
static double solve_node(const struct gm_wave *wave, double square, double past, double now, double right,
                         double c, unsigned long *iterations)
{
    enum { MOST = 50 };
    double last = INFINITY;
    for (int k = 0; k < MOST; k++) {
        const double x = now + c;
        const double change =
            (c + square * wave->quotient(x, past) - right) / (1 + square * wave->quotient_slope(x, past));
        const double size = fabs(change);
        ++*iterations;
        if (size >= last && size <= 1e-14 * fmax(1, fabs(x))) {
            return c;
        }
        c -= change;
        if (!(size > 1e-17 * fabs(x))) {
            return c;
        }
        last = size;
    }
    return NAN;
}

/* Solved for the change from level to level, which is kept apart from the levels: there it would be rounded
   as they are, and the energy would wander twenty times as far. */
static enum gm_status energy_conserving(struct gm_two_step_work *work, const struct gm_problem *problem,
                                        double dt, const double *past, const double *now, double *next,
                                        struct gm_progress *progress)
{
    const double square = dt * dt, ratio = square / (problem->line.dx * problem->line.dx);
    for (size_t i = 0; i < work->points; i++) {
        const double before = work->change[i];
        const double curvature = ((now + i)[1] - now[i]) - (now[i] - (now + i)[-1]);
        const double right = before + ratio * curvature;
        work->change[i] = solve_node(gm_field_of(problem)->wave, square, past[i], now[i], right, before,
                                     &progress->iterations);
        next[i] = now[i] + work->change[i];
        if (isnan(next[i])) {
            return isfinite(right) ? GM_NO_CONVERGENCE : GM_BLOW_UP;
        }
    }
    progress->evaluations++;
    return GM_OK;
}

/* M+ D_t^+ s - M+' D_t^- s + K+ D_x^+ s - K+' D_x^- s = grad S(s) with the upper triangles M+, K+: here
       v = D_t^- u,   w = D_x^- u,   -D_t^+ v + D_x^+ w = V'(u) */
static enum gm_status euler_box(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                                const double *past, const double *now, double *next,
                                struct gm_progress *progress)
{
    const double dx = problem->line.dx;
    double *v = work->right, *w = work->guess;
    gm_field_of(problem)->wave->slopes(now, work->force, work->points);
    for (size_t i = 0; i <= work->points; i++) {
        w[i] = (now[i] - (now + i)[-1]) / dx;
    }
    for (size_t i = 0; i < work->points; i++) {
        v[i] = (now[i] - past[i]) / dt;
        next[i] = now[i] + dt * (v[i] + dt * ((w[i + 1] - w[i]) / dx - work->force[i]));
    }
    progress->evaluations++;
    return GM_OK;
}

/* The other level of the state lies at neither t + dt nor t - dt: the level at t + dt by the velocity at t,
   to second order from both sides, so that a change of dt costs no order. */
void gm_wave_start(struct gm_two_step_work *work, const struct gm_problem *problem, double dt, double gap,
                   const double *now, const double *other, double *next)
{
    const double over = 1 / (problem->line.dx * problem->line.dx);
    gm_field_of(problem)->wave->slopes(now, work->force, work->points);
    for (size_t i = 0; i < work->points; i++) {
        const double acceleration = over * ((now + i)[1] - 2 * now[i] + (now + i)[-1]) - work->force[i];
        const double velocity = (other[i] - now[i]) / gap - gap / 2 * acceleration;
        next[i] = now[i] + dt * (velocity + dt / 2 * acceleration);
    }
}

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_two_step_row *row = scheme->coefficients;
    return row->keeps_change ? problem->line.points : 0;
}

static void subtract(double *change, const double *level, const double *before, size_t points)
{
    for (size_t i = 0; i < points; i++) {
        change[i] = level[i] - before[i];
    }
}

/* Of no use to a first step that is none of the scheme's own, which begins the change anew. */
static enum gm_status start(const struct gm_task *task)
{
    const size_t points = task->problem->line.points;
    if (memory(task->problem, task->scheme) > 0) {
        subtract(task->memory_out, task->y, task->y + points, points);
    }
    return GM_OK;
}

static double *rotate(double *level[3])
{
    double *past = level[0];
    level[0] = level[1];
    level[1] = level[2];
    return level[2] = past;
}

enum gm_wave_law gm_wave_law_of(const struct gm_scheme *scheme)
{
    const struct gm_two_step_row *row = scheme->coefficients;
    const struct gm_scheme *rows = scheme->family->schemes;
    const bool has_row = rows == gm_family_two_step.schemes || rows == gm_family_box.schemes ||
                         rows == gm_family_midpoint_box.schemes;
    return has_row ? row->law : GM_LAW_NONE;
}

struct gm_progress gm_two_step_advance(const struct gm_task *task)
{
    const struct gm_two_step_row *row = task->scheme->coefficients;
    struct gm_two_step_work *work = task->workspace;
    const size_t points = work->points, size = points * sizeof(double);
    const double jump = task->problem->line.jump, gap = task->y[2 * points];
    struct gm_progress progress = {.status = GM_OK};
    double *next = work->level[2];
    memcpy(work->level[1], task->y, size);
    memcpy(work->level[0], task->y + points, size);
    gm_line_close(work->level[1], points, jump);
    gm_line_close(work->level[0], points, jump);
    const bool regular = gap == -task->dt, remembers = row->keeps_change && task->memory;
    if (remembers) {
        memcpy(work->change, task->memory, size);
    } else if (row->keeps_change) {
        subtract(work->change, task->y, task->y + points, points);
    }
    for (long k = 0; k < task->steps; k++) {
        if (k > 0 || regular) {
            progress.status =
                row->step(work, task->problem, task->dt, work->level[0], work->level[1], next, &progress);
        } else {
            if (gap == task->dt) {
                memcpy(next, work->level[0], size);
            } else {
                row->start(work, task->problem, task->dt, gap, work->level[1], work->level[0], next);
            }
            if (row->keeps_change) {
                subtract(work->change, next, work->level[1], points);
            }
        }
        if (progress.status == GM_OK && !within(next, points, task->limit)) {
            progress.status = GM_BLOW_UP;
        }
        if (progress.status != GM_OK) {
            return progress;
        }
        gm_line_close(next, points, jump);
        next = rotate(work->level);
        progress.done++;
    }
    memcpy(task->out, work->level[1], size);
    memcpy(task->out + points, work->level[0], size);
    task->out[2 * points] = -task->dt;
    if (remembers) {
        memcpy(task->memory_out, work->change, size);
    }
    return progress;
}

static const struct gm_two_step_row rows[] = {
    {.step = leapfrog, .start = gm_wave_start, .law = GM_LAW_NODES},
    {.step = energy_conserving,
     .start = gm_wave_start,
     .law = GM_LAW_NODES,
     .average = true,
     .keeps_change = true},
    {.step = euler_box, .start = gm_wave_start, .law = GM_LAW_NODES},
};

static const struct gm_scheme schemes[] = {
    {
        .name = "leapfrog",
        .title = "leapfrog",
        .formula = "(uⁿ⁺¹ − 2uⁿ + uⁿ⁻¹)/Δt² = (uᵢ₊₁ − 2uᵢ + uᵢ₋₁)/Δx² − V′(uⁿ)",
        .reference =
            "multisymplectic Euler scheme with the triangular splitting: Moore & Reich, Numer. Math. 95 (2003) "
            "625; Razafindralandy et al. (2018) call it not multisymplectic, which it is",
        .family = &gm_family_two_step,
        .coefficients = &rows[0],
        .order = 2,
        .needs = GM_NEEDS_WAVE,
        .claims = GM_MULTISYMPLECTIC | GM_SYMMETRIC,
    },
    {
        .name = "energy-conserving",
        .title = "energy-conserving",
        .formula = "(uⁿ⁺¹ − 2uⁿ + uⁿ⁻¹)/Δt² = (uᵢ₊₁ − 2uᵢ + uᵢ₋₁)/Δx² − [V(uⁿ⁺¹) − V(uⁿ⁻¹)]/(uⁿ⁺¹ − uⁿ⁻¹)",
        .reference = "W. Strauss & L. Vázquez, J. Comput. Phys. 28 (1978) 271",
        .family = &gm_family_two_step,
        .coefficients = &rows[1],
        .order = 2,
        .needs = GM_NEEDS_WAVE,
        .claims = GM_KEEPS_ENERGY | GM_SYMMETRIC,
    },
    {
        .name = "euler-box",
        .title = "Euler box",
        .formula =
            "M₊Dₜ⁺s + M₋Dₜ⁻s + K₊Dₓ⁺s + K₋Dₓ⁻s = ∇S(s),  M₊, K₊ the upper triangles:  leapfrog in (u, v, w)",
        .reference = "B. Moore & S. Reich, Numer. Math. 95 (2003) 625",
        .family = &gm_family_two_step,
        .coefficients = &rows[2],
        .order = 2,
        .needs = GM_NEEDS_WAVE,
        .claims = GM_MULTISYMPLECTIC | GM_SYMMETRIC,
    },
};

const struct gm_family gm_family_two_step = {
    .kind = &gm_kind_field,
    .title = "two-step wave schemes",
    .schemes = schemes,
    .count = sizeof schemes / sizeof schemes[0],
    .loop = gm_two_step_advance,
    .memory = memory,
    .start = start,
    .workspace_open = gm_two_step_open,
    .workspace_close = gm_two_step_close,
    .form = gm_wave_form,
};
