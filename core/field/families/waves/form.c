/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The multisymplectic law of schemes for u_tt - u_xx + V'(u) = 0, s = (u, v, w), v = u_t, w = u_x. The
   schemes have u alone, or u and v; what else the law asks for follows from their equations, linearised:
       Euler box   v = D_t^- u,   w = D_x^- u
       midpoint    w = D_0 u
       box         A_x W = D_x A_t u                           W = A_t w, at the sides of the cells
                   A_t V = D_t A_x u   in the first row        V = A_x v, at the levels
                   D_t V = D_x W - V'' u   in both rows
   In the box V at the last level is right only if the step was one of the box. */
#include "core/field/families/waves/form.h"

#include <math.h>
#include <string.h>

#include "core/field/families/two_step.h"
#include "core/field/multisymplectic.h"
#include "core/linear/ring/ring.h"

/* Makes a step to get three levels: the state holds only two. */
struct gm_levels gm_levels_of(const struct gm_law *law)
{
    const struct gm_two_step_row *row = law->scheme->coefficients;
    const size_t points = law->problem->line.points, size = gm_wave_size(points);
    const bool at_start = law->y[2 * points] != -law->dt, centred = row->law == GM_LAW_CENTRED;
    double *out = gm_arena_take(law->arena, size + 2 * points, sizeof *out), *v = out + size;
    if (!gm_law_step(law, at_start ? 2 : 1, law->y, centred ? law->memory : NULL, out, centred ? v : NULL)) {
        gm_arena_leave(law->arena);
    }
    struct gm_levels levels = {.past = at_start ? law->y : law->y + points, .now = out + points, .next = out};
    if (centred) {
        levels.v_past = at_start ? law->memory : law->memory + points;
        levels.v_now = v + points;
        levels.v_next = v;
    }
    return levels;
}

enum { U, V, W, DIMENSION };

/* A tangent at three levels: u, and u_t where the scheme keeps it. */
struct tangent {
    double *past, *now, *next, *v_past, *v_now, *v_next;
};

struct base {
    const struct gm_law *law;
    struct gm_levels levels;
    double *earlier, *later; /* V'' in the cells of both rows */
};

static size_t left_of(size_t i, size_t points)
{
    return i ? i - 1 : points - 1;
}

static size_t right_of(size_t i, size_t points)
{
    return i + 1 < points ? i + 1 : 0;
}

static void linearised_nodes(const struct base *base, const struct tangent *a)
{
    const struct gm_wave *wave = gm_field_of(base->law->problem)->wave;
    const struct gm_two_step_row *row = base->law->scheme->coefficients;
    const struct gm_levels *levels = &base->levels;
    const size_t points = base->law->problem->line.points;
    const double dt = base->law->dt, ratio = dt / base->law->problem->line.dx;
    for (size_t i = 0; i < points; i++) {
        const double change = a->now[right_of(i, points)] - 2 * a->now[i] + a->now[left_of(i, points)];
        const double free_motion = 2 * a->now[i] + ratio * ratio * change;
        if (row->average) {
            const double both[] = {levels->next[i], levels->past[i], levels->next[i]};
            double quotients[2], slopes[2];
            wave->quotients(base->law->problem, both, both + 1, quotients, slopes, 2);
            a->next[i] = (free_motion - (1 + dt * dt * slopes[1]) * a->past[i]) / (1 + dt * dt * slopes[0]);
        } else {
            a->next[i] = free_motion - a->past[i] -
                         dt * dt * wave->curvature(base->law->problem, levels->now[i]) * a->now[i];
        }
    }
}

static void linearised_centred(const struct base *base, const struct tangent *a)
{
    const size_t points = base->law->problem->line.points;
    const double dt = base->law->dt, dx = base->law->problem->line.dx;
    for (size_t i = 0; i < points; i++) {
        const size_t right = right_of(right_of(i, points), points),
                     left = left_of(left_of(i, points), points);
        const double second = (a->now[right] - 2 * a->now[i] + a->now[left]) / (4 * dx * dx);
        const double force =
            gm_field_of(base->law->problem)->wave->curvature(base->law->problem, base->levels.now[i]) *
            a->now[i];
        a->next[i] = a->past[i] + 2 * dt * a->v_now[i];
        a->v_next[i] = a->v_past[i] + 2 * dt * (second - force);
    }
}

/* The linearised nine-point scheme at node i: A_x' D_t A_x and D_x' A_t D_x of three levels, and V'' in four
   cells. */
static double nine_points(const struct base *base, const struct tangent *a, size_t i)
{
    const size_t points = base->law->problem->line.points, l = left_of(i, points), r = right_of(i, points);
    const double dt = base->law->dt, dx = base->law->problem->line.dx;
    const double *p = a->past, *n = a->now, *f = a->next;
    const double in_time = f[r] + 2 * f[i] + f[l] - 2 * (n[r] + 2 * n[i] + n[l]) + p[r] + 2 * p[i] + p[l];
    const double in_space = f[r] - 2 * f[i] + f[l] + 2 * (n[r] - 2 * n[i] + n[l]) + p[r] - 2 * p[i] + p[l];
    const double force =
        base->later[i] * (n[i] + n[r] + f[i] + f[r]) + base->later[l] * (n[i] + n[l] + f[i] + f[l]) +
        base->earlier[i] * (p[i] + p[r] + n[i] + n[r]) + base->earlier[l] * (p[i] + p[l] + n[i] + n[l]);
    return in_time / (4 * dt * dt) - in_space / (4 * dx * dx) + force / 16;
}

/* The next level is the solution of a linear system, which is solved again for what rounding leaves. */
static void linearised_box(const struct base *base, const struct tangent *a)
{
    const size_t points = base->law->problem->line.points;
    const double dt = base->law->dt, dx = base->law->problem->line.dx;
    const double in_time = 1 / (4 * dt * dt), in_space = 1 / (4 * dx * dx);
    double *right = a->v_next; /* no scheme of cells keeps u_t */
    struct gm_ring_band *band = gm_arena_take(base->law->arena, 1, sizeof *band);
    gm_arena_need(base->law->arena, gm_ring_band_open(band, points, 1, 1));
    gm_arena_keep(base->law->arena, band, gm_ring_band_close);
    for (size_t i = 0; i < points; i++) {
        const double before = base->later[left_of(i, points)] / 16, after = base->later[i] / 16;
        gm_ring_band_add(band, i, 0, -1, 0, in_time - in_space + before);
        gm_ring_band_add(band, i, 0, 0, 0, 2 * (in_time + in_space) + before + after);
        gm_ring_band_add(band, i, 0, 1, 0, in_time - in_space + after);
    }
    if (!gm_ring_band_factor(band)) {
        gm_arena_leave(base->law->arena);
    }
    for (int k = 0; k < 3; k++) {
        for (size_t i = 0; i < points; i++) {
            right[i] = -nine_points(base, a, i);
        }
        gm_ring_band_solve(band, right);
        for (size_t i = 0; i < points; i++) {
            a->next[i] += right[i];
        }
    }
}

static void by_own_steps(const struct base *base, const struct tangent *a)
{
    const struct gm_levels *of = &base->levels;
    const double *const from[] = {of->now, of->past, of->v_now, of->v_past};
    const double *const along[] = {a->now, a->past, a->v_now, a->v_past};
    double *const to[] = {a->next, NULL, a->v_next, NULL};
    gm_law_differentiate_levels(base->law, of->v_now ? 4 : 2, from, along, to);
}

struct nodes {
    const struct gm_grid1 *line;
    double dt;
    bool centred;
    const struct tangent *tangent;
};

static void complete_node(const void *tangent, size_t node, double *levels)
{
    const struct nodes *nodes = tangent;
    const struct tangent *a = nodes->tangent;
    const double *u[3] = {a->past, a->now, a->next}, *v[3] = {a->v_past, a->v_now, a->v_next};
    const size_t points = nodes->line->points;
    for (size_t n = 0; n < 3; n++) {
        double *s = levels + n * DIMENSION;
        const double left = u[n][left_of(node, points)], right = u[n][right_of(node, points)];
        s[U] = u[n][node];
        /* v of the first level occurs in no flux */
        s[V] = nodes->centred ? v[n][node] : n ? (u[n][node] - u[n - 1][node]) / nodes->dt : 0;
        s[W] =
            nodes->centred ? (right - left) / (2 * nodes->line->dx) : (u[n][node] - left) / nodes->line->dx;
    }
}

/* W at the sides of the cells between two levels. On an even number of points A_x W = D_x A_t u leaves its
   alternating part free; the acceleration, which like A_t V = D_t A_x u has none, determines it. */
static void side_slopes(const struct gm_grid1 *grid, const double *before, const double *after,
                        const double *curvature, double *w)
{
    const size_t points = grid->points;
    double alternating = 0;
    for (size_t i = 0; i < points; i++) {
        const size_t r = right_of(i, points);
        const double force = curvature[i] * (before[i] + before[r] + after[i] + after[r]) / 4;
        w[i] = (before[r] + after[r] - before[i] - after[i]) / (2 * grid->dx);
        alternating += i % 2 ? -force : force;
    }
    gm_ring_unaverage(w, points);
    for (size_t i = 0; points % 2 == 0 && i < points; i++) {
        const double part = grid->dx / 2 * alternating / (double)points;
        w[i] -= i % 2 ? -part : part;
    }
}

/* D_t V in cell i */
static double acceleration(const struct gm_grid1 *grid, const double *before, const double *after,
                           const double *curvature, const double *w, size_t i)
{
    const size_t r = right_of(i, grid->points);
    return (w[r] - w[i]) / grid->dx - curvature[i] * (before[i] + before[r] + after[i] + after[r]) / 4;
}

static void complete_cells(const struct base *base, const struct tangent *a, struct gm_faces *faces)
{
    const struct gm_grid1 *grid = &base->law->problem->line;
    const size_t points = grid->points;
    const double dt = base->law->dt;
    double *w = a->v_past, *w_later = a->v_now; /* no scheme of cells keeps u_t */
    side_slopes(grid, a->past, a->now, base->earlier, w);
    side_slopes(grid, a->now, a->next, base->later, w_later);
    for (size_t i = 0; i < points; i++) {
        const size_t r = right_of(i, points);
        double *lower = faces->lower + i * DIMENSION, *upper = faces->upper + i * DIMENSION;
        lower[U] = (a->now[i] + a->now[r]) / 2;
        upper[U] = (a->next[i] + a->next[r]) / 2;
        lower[V] = (lower[U] - (a->past[i] + a->past[r]) / 2) / dt +
                   dt / 2 * acceleration(grid, a->past, a->now, base->earlier, w, i);
        upper[V] = lower[V] + dt * acceleration(grid, a->now, a->next, base->later, w_later, i);
    }
    for (size_t i = 0; i <= points; i++) {
        const size_t at = i < points ? i : 0;
        double *side = faces->sides + i * DIMENSION;
        side[U] = (a->now[at] + a->next[at]) / 2;
        side[W] = w_later[at];
    }
}

/* V'' in the cells between two levels. */
static void cell_curvatures(const struct gm_problem *problem, const double *p, const double *q,
                            double *curvature)
{
    const struct gm_grid1 *grid = &problem->line;
    for (size_t i = 0; i < grid->points; i++) {
        const size_t r = right_of(i, grid->points);
        const double jump = r == 0 ? grid->jump : 0;
        curvature[i] =
            gm_field_of(problem)->wave->curvature(problem, (p[i] + p[r] + q[i] + q[r] + 2 * jump) / 4);
    }
}

static enum gm_wave_law law_of(const struct gm_law *law)
{
    return ((const struct gm_two_step_row *)law->scheme->coefficients)->law;
}

static struct base base_of(const struct gm_law *law)
{
    const struct gm_problem *problem = law->problem;
    const size_t points = problem->line.points;
    struct base base = {.law = law, .levels = gm_levels_of(law)};
    base.earlier = gm_arena_take(law->arena, 2 * points, sizeof *base.earlier);
    base.later = base.earlier + points;
    if (law_of(law) == GM_LAW_CELLS) {
        cell_curvatures(problem, base.levels.past, base.levels.now, base.earlier);
        cell_curvatures(problem, base.levels.now, base.levels.next, base.later);
    }
    return base;
}

/* Tangent 0 or 1, a step ahead. */
static struct tangent tangent_of(const struct base *base, size_t which)
{
    const enum gm_wave_law kind = law_of(base->law);
    const size_t points = base->law->problem->line.points;
    const double waves = 2 + (double)which, phase = 0.3 + 0.4 * (double)which;
    double *u = gm_arena_take(base->law->arena, 6 * points, sizeof *u), *v = u + 3 * points;
    const struct tangent a = {u, u + points, u + 2 * points, v, v + points, v + 2 * points};
    gm_tangent_start(a.past, points, waves, phase);
    gm_tangent_start(a.now, points, waves, 2 * phase - M_PI / 2);
    if (kind == GM_LAW_CENTRED) {
        gm_tangent_start(a.v_past, points, waves, 3 * phase);
        gm_tangent_start(a.v_now, points, waves, 5 * phase);
    }
    if (base->law->by_differences) {
        by_own_steps(base, &a);
    } else if (kind == GM_LAW_CELLS) {
        linearised_box(base, &a);
    } else if (kind == GM_LAW_CENTRED) {
        linearised_centred(base, &a);
    } else {
        linearised_nodes(base, &a);
    }
    return a;
}

static void advance_tangents(const struct gm_law *law, struct gm_faces faces[2])
{
    const struct base base = base_of(law);
    for (size_t k = 0; k < 2; k++) {
        const struct tangent a = tangent_of(&base, k);
        complete_cells(&base, &a, &faces[k]);
    }
}

double gm_wave_form(const struct gm_law *law)
{
    static const double one = 1;
    const struct gm_grid1 *grid = &law->problem->line;
    if (law_of(law) == GM_LAW_CELLS) {
        const struct gm_lattice cells = {grid->points, 1, 1, &one, &one, grid->dx, law->dt};
        return gm_lattice_law(law, &cells, advance_tangents);
    }
    const bool centred = law_of(law) == GM_LAW_CENTRED;
    const struct base base = base_of(law);
    const struct tangent a = tangent_of(&base, 0), b = tangent_of(&base, 1);
    const struct nodes of_a = {grid, law->dt, centred, &a}, of_b = {grid, law->dt, centred, &b};
    return gm_nodes_law(law, centred, complete_node, &of_a, &of_b);
}
