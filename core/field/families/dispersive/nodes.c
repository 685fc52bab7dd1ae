/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The multisymplectic schemes of nodes for equations of first order in time, all but the field eliminated
   (D_+, D_-, D_0 forward, backward and centred differences in x, d2 = D_+ D_-).

   Korteweg-de Vries, f = mu d2 u + eta u^2/2, centred f = mu D_0^2 u + eta u^2/2:
       Euler box   (u_i^{n+1} - u_i^n + u_{i+1}^n - u_{i+1}^{n-1}) / (2 dt) + D_+ f_i = 0
                   where dt < 0 the triangles the other way round, and with them x;
                   stable for dt < dx^3/(4 mu)
       midpoint    (u^{n+1} - u^{n-1}) / (2 dt) + D_0 f = 0
                   stable for dt < dx^3/mu
   Nonlinear Schroedinger: schroedinger_nodes.c has its Euler box, and here is the law of both.
   B. Moore & S. Reich, Numer. Math. 95 (2003) 625; Razafindralandy et al. (2018). */
#include "core/field/families/dispersive/box.h"
#include "core/field/families/family.h"
#include "core/field/families/two_step.h"
#include "core/field/multisymplectic.h"
#include "core/field/problems/dispersive.h"

static size_t shifted(size_t i, long by, size_t points)
{
    return (i + (size_t)((long)points + by)) % points;
}

static double second(const double *u, size_t i, long reach, const struct gm_grid1 *grid)
{
    const double step = (double)reach * grid->dx;
    return (u[shifted(i, reach, grid->points)] - 2 * u[i] + u[shifted(i, -reach, grid->points)]) /
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

/* Korteweg-de Vries: the level at t + dt from those at t and t - dt; with `base`, a level of a solution at t,
   of the linearised scheme. All arrays have `points` numbers; flux is scratch. */
static void kdv_nodes_step(const struct gm_problem *problem, bool centred, double dt, const double *base,
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
                               double dt, struct gm_progress *progress)
{
    double *const *level = work->level;
    kdv_nodes_step(problem, centred, dt, NULL, level[0], level[1], level[2], work->force);
    progress->evaluations++;
    return GM_OK;
}

static enum gm_status kdv_euler(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                                struct gm_progress *progress)
{
    return kdv_step(work, problem, false, dt, progress);
}

static enum gm_status kdv_centred(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                                  struct gm_progress *progress)
{
    return kdv_step(work, problem, true, dt, progress);
}

/* An Euler step: once, so that the order stays 2. */
static void kdv_start(struct gm_two_step_work *work, const struct gm_problem *problem, double dt, double gap)
{
    (void)gap;
    const double *now = work->level[1];
    double *next = work->level[2];
    const size_t points = problem->line.points;
    find_flux(problem, 1, NULL, now, work->force);
    for (size_t i = 0; i < points; i++) {
        next[i] = now[i] - dt / (2 * problem->line.dx) *
                               (work->force[shifted(i, 1, points)] - work->force[shifted(i, -1, points)]);
    }
}

/* Schroedinger: a tangent of the solution p^{n-1}, q^n becomes that of p^n, q^{n+1}. */
static void nls_nodes_tangent(const struct gm_problem *problem, double dt, const double *p_new,
                              const double *q, double *tangent_p, double *tangent_q)
{
    const struct gm_grid1 *grid = &problem->line;
    const double k = gm_nls_of(problem)->k;
    for (size_t i = 0; i < grid->points; i++) {
        const double p = p_new[i];
        tangent_p[i] = (tangent_p[i] -
                        dt * (second(tangent_q, i, 1, grid) + k * (p * p + 3 * q[i] * q[i]) * tangent_q[i])) /
                       (1 + 2 * dt * k * q[i] * p);
    }
    for (size_t i = 0; i < grid->points; i++) {
        const double p = p_new[i];
        tangent_q[i] += dt * (second(tangent_p, i, 1, grid) + k * (3 * p * p + q[i] * q[i]) * tangent_p[i] +
                              2 * k * q[i] * p * tangent_q[i]);
    }
}

static const struct gm_two_step_row kdv_rows[] = {
    {.step = kdv_euler, .start = kdv_start, .law = GM_LAW_NODES},
    {.step = kdv_centred, .start = kdv_start, .law = GM_LAW_CENTRED},
};

/* The multisymplectic law of the schemes of nodes for equations of first order in time: two tangents are
   advanced by a step, and what elimination left out follows from the other equations, linearised at the
   solution m:
       Korteweg-de Vries   D_- phi = u,   v = mu D_- u,   w = D_t^- phi/2 + D_+ v + eta m u
       Schroedinger        v = D_- p,   w = D_- q
   with centred differences for the midpoint scheme. phi of every level is free up to a constant, which its
   differences do not see; the tangents have no mean, so that it is periodic. */

/* A solution, u or Schroedinger's p^{n-1} and q^n. */
struct base {
    const struct gm_law *law; /* ahead in time */
    bool kdv, centred;
    double *past, *now;
};

/* A tangent at three levels: u and phi, or of Schroedinger's equation p, p, - and -, q, q. */
struct tangent {
    const struct base *base;
    double *first[3], *second[3];
};

/* phi from D u = ..., around the ring, or both rings of every other node. */
static void integrate(const struct base *base, const double *u, double *phi)
{
    const struct gm_grid1 *grid = &base->law->problem->line;
    const size_t points = grid->points, stride = base->centred ? 2 : 1;
    const size_t rings = base->centred && points % 2 == 0 ? 2 : 1;
    for (size_t ring = 0; ring < rings; ring++) {
        size_t at = ring;
        phi[at] = 0;
        for (size_t k = 1; k < points / rings; k++) {
            const size_t next = (at + stride) % points, slope = base->centred ? (at + 1) % points : next;
            phi[next] = phi[at] + (double)stride * grid->dx * u[slope];
            at = next;
        }
    }
}

static void advance_kdv(const struct base *base, double phase, double waves, const struct tangent *a)
{
    const size_t points = base->law->problem->line.points;
    double *const *u = a->first, *const *phi = a->second;
    gm_tangent_start(u[0], points, waves, phase);
    gm_tangent_start(u[1], points, waves, 2 * phase - M_PI / 2);
    if (base->law->by_differences) {
        const double *const from[] = {base->now, base->past}, *const along[] = {u[1], u[0]};
        gm_law_differentiate_levels(base->law, 2, from, along, (double *const[]){u[2], NULL});
    } else {
        kdv_nodes_step(base->law->problem, base->centred, base->law->dt, base->now, u[0], u[1], u[2], phi[0]);
    }
    for (size_t n = 0; n < 3; n++) {
        integrate(base, u[n], phi[n]);
    }
}

static void complete_kdv(const void *tangent, size_t node, double *levels)
{
    enum { PHI, U, V, W, DIMENSION };
    const struct tangent *a = tangent;
    const struct gm_problem *problem = a->base->law->problem;
    const struct gm_kdv *kdv = gm_kdv_of(problem);
    const bool centred = a->base->centred;
    const size_t points = problem->line.points, r = (node + 1) % points, l = (node + points - 1) % points;
    const double dx = problem->line.dx, dt = a->base->law->dt;
    const double *u = a->first[1];
    for (size_t n = 0; n < 3; n++) {
        levels[n * DIMENSION + PHI] = a->second[n][node];
        levels[n * DIMENSION + U] = a->first[n][node];
        levels[n * DIMENSION + V] = levels[n * DIMENSION + W] = 0; /* needed at the middle level alone */
    }
    const double rise = a->second[centred ? 2 : 1][node] - a->second[0][node];
    const size_t l2 = (l + points - 1) % points, r2 = (r + 1) % points;
    const double bend =
        centred ? (u[r2] - 2 * u[node] + u[l2]) / (4 * dx * dx) : (u[r] - 2 * u[node] + u[l]) / (dx * dx);
    levels[DIMENSION + V] = kdv->mu * (centred ? (u[r] - u[l]) / (2 * dx) : (u[node] - u[l]) / dx);
    levels[DIMENSION + W] =
        rise / ((centred ? 4 : 2) * dt) + kdv->mu * bend + kdv->eta * a->base->now[node] * u[node];
}

static void advance_nls(const struct base *base, double phase, double waves, const struct tangent *a)
{
    const size_t points = base->law->problem->line.points, size = points * sizeof(double);
    double *const *p = a->first, *const *q = a->second;
    gm_tangent_start(p[0], points, waves, phase);
    gm_tangent_start(q[1], points, waves, phase + 1);
    if (base->law->by_differences) {
        const double *const from[] = {base->past, base->now}, *const along[] = {p[0], q[1]};
        gm_law_differentiate_levels(base->law, 2, from, along, (double *const[]){p[1], q[2]});
        return;
    }
    double *from = gm_arena_take(base->law->arena, 4 * points, sizeof *from), *made = from + 2 * points;
    memcpy(from, base->past, size);
    memcpy(from + points, base->now, size);
    memcpy(p[1], p[0], size);
    memcpy(q[2], q[1], size);
    if (!gm_law_step(base->law, 1, from, NULL, made, NULL)) { /* p^n comes first */
        gm_arena_leave(base->law->arena);
    }
    nls_nodes_tangent(base->law->problem, base->law->dt, made, base->now, p[1], q[2]);
}

static void complete_nls(const void *tangent, size_t node, double *levels)
{
    enum { P, Q, V, W, DIMENSION };
    const struct tangent *a = tangent;
    const size_t points = a->base->law->problem->line.points, l = (node + points - 1) % points;
    const double dx = a->base->law->problem->line.dx, *p = a->first[1], *q = a->second[1];
    memset(levels, 0, 3 * DIMENSION * sizeof *levels);
    levels[P] = a->first[0][node];
    levels[DIMENSION + P] = p[node];
    levels[DIMENSION + Q] = q[node];
    levels[DIMENSION + V] = (p[node] - p[l]) / dx;
    levels[DIMENSION + W] = (q[node] - q[l]) / dx;
    levels[2 * DIMENSION + Q] = a->second[2][node];
}

/* Backwards in time the schemes are those forwards in the mirror. */
static void mirror(double *u, size_t points)
{
    for (size_t i = 0; i < points / 2; i++) {
        const double held = u[i];
        u[i] = u[points - 1 - i];
        u[points - 1 - i] = held;
    }
}

double gm_nodes_form(const struct gm_law *law)
{
    const struct gm_problem *problem = law->problem;
    const size_t points = problem->line.points, size = points * sizeof(double);
    const bool kdv = gm_field_of(problem)->equation == GM_NEEDS_KDV;
    const bool has_past = kdv && law->y[2 * points] == -law->dt;
    const struct gm_two_step_row *row = law->scheme->coefficients;
    if (kdv && fabs(law->y[2 * points]) != fabs(law->dt)) {
        return NAN; /* no level of the scheme lies before or after */
    }
    struct gm_law ahead = *law;
    ahead.dt = kdv ? fabs(law->dt) : law->dt;
    double *past = gm_arena_take(law->arena, 14 * points, sizeof *past);
    double *now = past + points, *levels = past + 2 * points;
    const struct base base = {
        .law = &ahead,
        .kdv = kdv,
        .centred = kdv && row->law == GM_LAW_CENTRED,
        .past = past,
        .now = now,
    };
    memcpy(past, has_past ? law->y + points : law->y, size);
    memcpy(now, has_past ? law->y : law->y + points, size);
    if (kdv && law->dt < 0) {
        mirror(past, points);
        mirror(now, points);
    }
    struct tangent tangents[2] = {{.base = &base}, {.base = &base}};
    for (size_t t = 0; t < 2; t++) {
        for (size_t k = 0; k < 3; k++) {
            tangents[t].first[k] = levels + (2 * k + t) * points;
            tangents[t].second[k] = levels + (6 + 2 * k + t) * points;
        }
        (kdv ? advance_kdv : advance_nls)(&base, 0.3 + 0.4 * (double)t, 2 + (double)t, &tangents[t]);
    }
    return gm_nodes_law(&ahead, base.centred, kdv ? complete_kdv : complete_nls, &tangents[0], &tangents[1]);
}

#define OF_NODES .family = &gm_family_nodes, .needs = GM_NEEDS_FORM | GM_NEEDS_KDV

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_euler_box_of_korteweg, OF_NODES, .coefficients = &kdv_rows[0]},
    {GM_TEXTS_midpoint_box_of_korteweg, OF_NODES, .coefficients = &kdv_rows[1]},
};

const struct gm_family gm_family_nodes = {
    .title = "multisymplectic schemes of nodes",
    GM_FIELD_FAMILY,
    GM_TWO_STEP_LOOP,
    .form = gm_nodes_form,
};
