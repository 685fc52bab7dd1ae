/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The multisymplectic schemes of nodes for the Korteweg-de Vries equation, all but the field eliminated
   (D_+, D_-, D_0 forward, backward and centred differences in x, d2 = D_+ D_-). With f = mu d2 u + eta u^2/2, centred f = mu D_0^2 u + eta u^2/2:
       Euler box   (u_i^{n+1} - u_i^n + u_{i+1}^n - u_{i+1}^{n-1}) / (2 dt) + D_+ f_i = 0
                   where dt < 0 the triangles the other way round, and with them x;
                   stable for dt < dx^3/(4 mu)
       midpoint    (u^{n+1} - u^{n-1}) / (2 dt) + D_0 f = 0
                   stable for dt < dx^3/mu
   B. Moore & S. Reich, Numer. Math. 95 (2003) 625; Razafindralandy et al. (2018). */
#include "core/field/families/family.h"
#include "core/field/families/two_step.h"
#include "core/field/multisymplectic.h"
#include "core/field/problems/problems.h"

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

static const struct gm_two_step_row kdv_rows[] = {
    {.step = kdv_euler, .start = kdv_start, .law = GM_LAW_NODES},
    {.step = kdv_centred, .start = kdv_start, .law = GM_LAW_CENTRED},
};

/* The multisymplectic law: two tangents are advanced by a step, and what elimination left out follows from the other
   equations, linearised at the solution m,
       D_- phi = u,   v = mu D_- u,   w = D_t^- phi/2 + D_+ v + eta m u
   with centred differences for the midpoint scheme. phi of every level is free up to a constant, which its
   differences do not see; the tangents have no mean, so that it is periodic. */

/* A solution. */
struct base {
    const struct gm_law *law; /* ahead in time */
    bool centred;
    double *past, *now;
};

/* A tangent at three levels. */
struct tangent {
    const struct base *base;
    double *u[3], *phi[3];
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

/* Tangent 0 or 1, a step ahead. */
static struct tangent tangent_of(const struct base *base, size_t which)
{
    const size_t points = base->law->problem->line.points;
    const double waves = 2 + (double)which, phase = 0.3 + 0.4 * (double)which;
    double *at = gm_arena_take(base->law->arena, 6 * points, sizeof *at);
    const struct tangent a = {
        base, {at, at + points, at + 2 * points}, {at + 3 * points, at + 4 * points, at + 5 * points}};
    double *const *u = a.u, *const *phi = a.phi;
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
    return a;
}

static void complete(const void *tangent, size_t node, double *levels)
{
    enum { PHI, U, V, W, DIMENSION };
    const struct tangent *a = tangent;
    const struct gm_problem *problem = a->base->law->problem;
    const struct gm_kdv *kdv = gm_kdv_of(problem);
    const bool centred = a->base->centred;
    const size_t points = problem->line.points, r = (node + 1) % points, l = (node + points - 1) % points;
    const double dx = problem->line.dx, dt = a->base->law->dt;
    const double *u = a->u[1];
    for (size_t n = 0; n < 3; n++) {
        levels[n * DIMENSION + PHI] = a->phi[n][node];
        levels[n * DIMENSION + U] = a->u[n][node];
        levels[n * DIMENSION + V] = levels[n * DIMENSION + W] = 0; /* needed at the middle level alone */
    }
    const double rise = a->phi[centred ? 2 : 1][node] - a->phi[0][node];
    const size_t l2 = (l + points - 1) % points, r2 = (r + 1) % points;
    const double bend =
        centred ? (u[r2] - 2 * u[node] + u[l2]) / (4 * dx * dx) : (u[r] - 2 * u[node] + u[l]) / (dx * dx);
    levels[DIMENSION + V] = kdv->mu * (centred ? (u[r] - u[l]) / (2 * dx) : (u[node] - u[l]) / dx);
    levels[DIMENSION + W] =
        rise / ((centred ? 4 : 2) * dt) + kdv->mu * bend + kdv->eta * a->base->now[node] * u[node];
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

static double form(const struct gm_law *law)
{
    const size_t points = law->problem->line.points, size = points * sizeof(double);
    const bool has_past = law->y[2 * points] == -law->dt;
    const struct gm_two_step_row *row = law->scheme->coefficients;
    if (fabs(law->y[2 * points]) != fabs(law->dt)) {
        return NAN; /* no level of the scheme lies before or after */
    }
    struct gm_law ahead = *law;
    ahead.dt = fabs(law->dt);
    double *past = gm_arena_take(law->arena, 2 * points, sizeof *past), *now = past + points;
    const struct base base = {&ahead, row->law == GM_LAW_CENTRED, past, now};
    memcpy(past, has_past ? law->y + points : law->y, size);
    memcpy(now, has_past ? law->y : law->y + points, size);
    if (law->dt < 0) {
        mirror(past, points);
        mirror(now, points);
    }
    const struct tangent a = tangent_of(&base, 0), b = tangent_of(&base, 1);
    return gm_nodes_law(&ahead, base.centred, complete, &a, &b);
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
    .form = form,
};
