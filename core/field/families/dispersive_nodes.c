/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The multisymplectic schemes of nodes for equations of first order in time, all but the field eliminated
   (D_+, D_-, D_0 forward, backward and centred differences in x, d2 = D_+ D_-).

   Korteweg-de Vries, f = mu d2 u + eta u^2/2, centred f = mu D_0^2 u + eta u^2/2:
       Euler box   (u_i^{n+1} - u_i^n + u_{i+1}^n - u_{i+1}^{n-1}) / (2 dt) + D_+ f_i = 0
                   where dt < 0 the triangles the other way round, and with them x;
                   stable for dt < dx^3/(4 mu)
       midpoint    (u^{n+1} - u^{n-1}) / (2 dt) + D_0 f = 0
                   stable for dt < dx^3/mu
   Nonlinear Schroedinger, psi = p + i q, the state p^{n-1} and q^n:
       Euler box   (p^n - p^{n-1})/dt + d2 q^n + (p^n p^n + q^n q^n) q^n = 0,   a quadratic equation for p^n
                   (q^{n+1} - q^n)/dt - d2 p^n - (p^n p^n + q^n q^n) p^n = 0
                   stable for dt < dx^2/2
   B. Moore & S. Reich, Numer. Math. 95 (2003) 625; Razafindralandy et al. (2018). There is no midpoint scheme
   for Schroedinger's equation: its second solution, of alternating sign in time, grows, and a soliton of
   amplitude 1 on 400 points blows up at t = 34 with dt = 0.4 dx^2, where 1 dx^2 is the limit of linear
   theory. */
#include "core/field/families/dispersive_nodes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/field/families/families.h"
#include "core/field/families/two_step.h"
#include "core/field/problems/dispersive.h"

static size_t shifted(size_t i, long by, size_t points)
{
    return (i + (size_t)((long)points + by)) % points;
}

static double second(const double *u, size_t i, long reach, const struct gm_line *line)
{
    const double step = (double)reach * line->dx;
    return (u[shifted(i, reach, line->points)] - 2 * u[i] + u[shifted(i, -reach, line->points)]) /
           (step * step);
}

/* f, or with `base` its derivative there along u. */
static void find_flux(const struct gm_problem *problem, long reach, const double *base, const double *u,
                      double *flux)
{
    const struct gm_kdv *kdv = gm_kdv_of(problem);
    for (size_t i = 0; i < problem->line.points; i++) {
        flux[i] =
            kdv->mu * second(u, i, reach, &problem->line) + kdv->eta * u[i] * (base ? base[i] : u[i] / 2);
    }
}

void gm_kdv_nodes_step(const struct gm_problem *problem, bool centred, double dt, const double *base,
                       const double *past, const double *now, double *next, double *flux)
{
    const size_t points = problem->line.points;
    const double dx = problem->line.dx;
    const long ahead = dt > 0 ? 1 : -1;
    find_flux(problem, centred ? 2 : 1, base, now, flux);
    for (size_t i = 0; i < points; i++) {
        const size_t right = shifted(i, ahead, points), left = shifted(i, -ahead, points);
        next[i] = centred ? past[i] - fabs(dt) / dx * (flux[right] - flux[left])
                          : now[i] - now[right] + past[right] - 2 * fabs(dt) / dx * (flux[right] - flux[i]);
    }
}

static enum gm_status kdv_step(struct gm_two_step_work *work, const struct gm_problem *problem, bool centred,
                               double dt, const double *past, const double *now, double *next,
                               struct gm_progress *progress)
{
    gm_kdv_nodes_step(problem, centred, dt, NULL, past, now, next, work->force);
    progress->evaluations++;
    return GM_OK;
}

static enum gm_status kdv_euler(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                                const double *past, const double *now, double *next,
                                struct gm_progress *progress)
{
    return kdv_step(work, problem, false, dt, past, now, next, progress);
}

static enum gm_status kdv_centred(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                                  const double *past, const double *now, double *next,
                                  struct gm_progress *progress)
{
    return kdv_step(work, problem, true, dt, past, now, next, progress);
}

/* An Euler step: once, so that the order stays 2. */
static void kdv_start(struct gm_two_step_work *work, const struct gm_problem *problem, double dt, double gap,
                      const double *now, const double *other, double *next)
{
    (void)gap;
    (void)other;
    const size_t points = problem->line.points;
    find_flux(problem, 1, NULL, now, work->force);
    for (size_t i = 0; i < points; i++) {
        next[i] = now[i] - dt / (2 * problem->line.dx) *
                               (work->force[shifted(i, 1, points)] - work->force[shifted(i, -1, points)]);
    }
}

/* p := p - dt [d2 q + (p'^2 + q^2) q] with the new p' inside; false where no real p' is left. */
static bool nls_first(const struct gm_line *line, double dt, double *p, const double *q)
{
    for (size_t i = 0; i < line->points; i++) {
        const double free = p[i] - dt * (second(q, i, 1, line) + q[i] * q[i] * q[i]);
        const double discriminant = 1 + 4 * dt * q[i] * free;
        if (discriminant < 0) {
            return false;
        }
        p[i] = 2 * free / (1 + sqrt(discriminant));
    }
    return true;
}

static void nls_second(const struct gm_line *line, double dt, const double *p, double *q)
{
    for (size_t i = 0; i < line->points; i++) {
        q[i] += dt * (second(p, i, 1, line) + (p[i] * p[i] + q[i] * q[i]) * p[i]);
    }
}

void gm_nls_nodes_tangent(const struct gm_problem *problem, double dt, const double *p_new, const double *q,
                          double *tangent_p, double *tangent_q)
{
    const struct gm_line *line = &problem->line;
    for (size_t i = 0; i < line->points; i++) {
        const double p = p_new[i];
        tangent_p[i] =
            (tangent_p[i] - dt * (second(tangent_q, i, 1, line) + (p * p + 3 * q[i] * q[i]) * tangent_q[i])) /
            (1 + 2 * dt * q[i] * p);
    }
    for (size_t i = 0; i < line->points; i++) {
        const double p = p_new[i];
        tangent_q[i] += dt * (second(tangent_p, i, 1, line) + (3 * p * p + q[i] * q[i]) * tangent_p[i] +
                              2 * q[i] * p * tangent_q[i]);
    }
}

static struct gm_progress nls_advance(const struct gm_task *task)
{
    const struct gm_line *line = &task->problem->line;
    double *p = task->out, *q = p + line->points;
    struct gm_progress progress = {.status = GM_OK};
    memcpy(p, task->y, 2 * line->points * sizeof *p);
    for (long k = 0; k < task->steps; k++) {
        progress.iterations++;
        if (!nls_first(line, task->dt, p, q)) {
            progress.status = GM_NO_CONVERGENCE;
            return progress;
        }
        nls_second(line, task->dt, p, q);
        progress.evaluations++;
        if (!gm_field_within(p, 2 * line->points, task->limit)) {
            progress.status = GM_BLOW_UP;
            return progress;
        }
        progress.done++;
    }
    return progress;
}

static struct gm_progress advance(const struct gm_task *task)
{
    return gm_field_of(task->problem)->equation == GM_NEEDS_KDV ? gm_two_step_advance(task)
                                                                : nls_advance(task);
}

static const struct gm_two_step_row kdv_rows[] = {
    {.step = kdv_euler, .start = kdv_start, .law = GM_LAW_NODES},
    {.step = kdv_centred, .start = kdv_start, .law = GM_LAW_CENTRED},
};

static const struct gm_scheme schemes[] = {
    {
        .name = "euler-box",
        .title = "Euler box",
        .formula = "(uᵢⁿ⁺¹ − uᵢⁿ + uᵢ₊₁ⁿ − uᵢ₊₁ⁿ⁻¹)/2Δt + Dₓ⁺[μ Dₓ⁺Dₓ⁻u + ηu²/2] = 0,  Δt < Δx³/4μ",
        .reference = "B. Moore & S. Reich, Numer. Math. 95 (2003) 625",
        .family = &gm_family_dispersive_nodes,
        .coefficients = &kdv_rows[0],
        .order = 2,
        .needs = GM_NEEDS_FORM | GM_NEEDS_KDV,
        .claims = GM_MULTISYMPLECTIC | GM_SYMMETRIC | GM_KEEPS_LINEAR,
    },
    {
        .name = "midpoint-box",
        .title = "midpoint box",
        .formula = "(uⁿ⁺¹ − uⁿ⁻¹)/2Δt + Dₓ⁰[μ Dₓ⁰Dₓ⁰u + ηu²/2] = 0,  Δt < Δx³/μ",
        .reference = "Razafindralandy et al. (2018), multisymplectic midpoint scheme",
        .family = &gm_family_dispersive_nodes,
        .coefficients = &kdv_rows[1],
        .order = 2,
        .needs = GM_NEEDS_FORM | GM_NEEDS_KDV,
        .claims = GM_MULTISYMPLECTIC | GM_SYMMETRIC | GM_KEEPS_LINEAR,
    },
    {
        .name = "euler-box",
        .title = "Euler box",
        .formula = "Dₜ⁻p + Dₓ⁺Dₓ⁻q + |ψ|²q = 0,  Dₜ⁺q − Dₓ⁺Dₓ⁻p − |ψ|²p = 0,  Δt < Δx²/2",
        .reference = "B. Moore & S. Reich, Numer. Math. 95 (2003) 625",
        .family = &gm_family_dispersive_nodes,
        .order = 1,
        .needs = GM_NEEDS_FORM | GM_NEEDS_NLS,
        .claims = GM_MULTISYMPLECTIC,
    },
};

const struct gm_family gm_family_dispersive_nodes = {
    .kind = &gm_kind_field,
    .title = "multisymplectic schemes of nodes",
    .schemes = schemes,
    .count = sizeof schemes / sizeof schemes[0],
    .loop = advance,
    .workspace_open = gm_two_step_open,
    .workspace_close = gm_two_step_close,
    .form = gm_dispersive_nodes_form,
};
