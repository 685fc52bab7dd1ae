/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The multisymplectic law of schemes for u_tt - u_xx + V'(u) = 0, s = (u, v, w), v = u_t, w = u_x. The
   schemes have u alone, or u and v; what else the law asks for follows from their equations, linearised:
       Euler box   v = D_t^- u,   w = D_x^- u
       midpoint    w = D_0 u
   The box is collocation at one point (boxes/collocation.c), which has all of them. */
#include "core/field/families/waves/form.h"

#include <math.h>
#include <string.h>

#include "core/field/families/boxes/any_form.h"
#include "core/field/families/two_step.h"
#include "core/field/multisymplectic.h"
#include "core/linear/differences.h"

/* Where the state holds two levels, a step is made aside. */
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

/* A solution, and arrays of a step aside. */
struct base {
    const struct gm_law *law;
    struct gm_levels levels;
    double *y, *memory_out;
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
            const double in_next = wave->quotient_slope(base->law->problem, levels->next[i], levels->past[i]);
            const double in_past = wave->quotient_slope(base->law->problem, levels->past[i], levels->next[i]);
            a->next[i] = (free_motion - (1 + dt * dt * in_past) * a->past[i]) / (1 + dt * dt * in_next);
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

/* gm_map: u at two levels, with u_t if the scheme keeps it, to the next level of the same. */
static bool one_step(const void *context, const double *from, double *to)
{
    const struct base *base = context;
    const size_t points = base->law->problem->line.points, size = points * sizeof *to;
    const bool keeps = base->levels.v_now != NULL;
    double *out = base->y + gm_wave_size(points);
    memcpy(base->y, from, 2 * size);
    base->y[2 * points] = -base->law->dt;
    const bool good = gm_law_step(base->law, 1, base->y, keeps ? from + 2 * points : NULL, out,
                                  keeps ? base->memory_out : NULL);
    memcpy(to, out, size);
    memcpy(to + points, base->memory_out, keeps ? size : 0);
    return good;
}

static void by_own_steps(const struct base *base, const struct tangent *a)
{
    const struct gm_levels *of = &base->levels;
    const size_t points = base->law->problem->line.points, size = points * sizeof(double);
    const size_t levels = of->v_now ? 4 : 2;
    const double *const from_levels[] = {of->now, of->past, of->v_now, of->v_past};
    const double *const directions[] = {a->now, a->past, a->v_now, a->v_past};
    double *from = gm_arena_take(base->law->arena, (2 * levels + 2) * points, sizeof *from);
    double *direction = from + levels * points, *slope = direction + levels * points;
    for (size_t k = 0; k < levels; k++) {
        memcpy(from + k * points, from_levels[k], size);
        memcpy(direction + k * points, directions[k], size);
    }
    if (!gm_differentiate(one_step, base, levels * points, from, direction, levels / 2 * points, slope)) {
        gm_arena_leave(base->law->arena);
    }
    memcpy(a->next, slope, size);
    memcpy(a->v_next, slope + points, levels == 4 ? size : 0);
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
        /* that of the first level occurs in no flux */
        s[V] = nodes->centred ? v[n][node] : n ? (u[n][node] - u[n - 1][node]) / nodes->dt : 0;
        s[W] =
            nodes->centred ? (right - left) / (2 * nodes->line->dx) : (u[n][node] - left) / nodes->line->dx;
    }
}

static enum gm_wave_law law_of(const struct gm_law *law)
{
    return ((const struct gm_two_step_row *)law->scheme->coefficients)->law;
}

static struct base base_of(const struct gm_law *law)
{
    const size_t points = law->problem->line.points;
    double *memory_out = gm_arena_take(law->arena, 2 * points + 2 * gm_wave_size(points), sizeof *memory_out);
    return (struct base){law, gm_levels_of(law), memory_out + 2 * points, memory_out};
}

static struct tangent tangent_on(const struct gm_law *law)
{
    const size_t points = law->problem->line.points;
    double *u = gm_arena_take(law->arena, 6 * points, sizeof *u), *v = u + 3 * points;
    return (struct tangent){u, u + points, u + 2 * points, v, v + points, v + 2 * points};
}

/* Tangent 0 or 1 of a scheme of nodes, a step ahead. */
static struct tangent tangent_of(const struct base *base, size_t which)
{
    const struct gm_law *law = base->law;
    const bool centred = law_of(law) == GM_LAW_CENTRED;
    const size_t points = law->problem->line.points;
    const double waves = 2 + (double)which, phase = 0.3 + 0.4 * (double)which;
    const struct tangent a = tangent_on(law);
    gm_tangent_start(a.past, points, waves, phase);
    gm_tangent_start(a.now, points, waves, 2 * phase - M_PI / 2);
    if (centred) {
        gm_tangent_start(a.v_past, points, waves, 3 * phase);
        gm_tangent_start(a.v_now, points, waves, 5 * phase);
    }
    if (law->by_differences) {
        by_own_steps(base, &a);
    } else if (centred) {
        linearised_centred(base, &a);
    } else {
        linearised_nodes(base, &a);
    }
    return a;
}

/* The means of two levels in the cells between them. */
static void find_means(size_t points, double jump, const double *p, const double *q, double *means)
{
    for (size_t i = 0; i < points; i++) {
        const size_t r = right_of(i, points);
        means[i] = (p[i] + p[r] + q[i] + q[r] + (r == 0 ? 2 * jump : 0)) / 4;
    }
}

/* A step of the box as collocation at one point, from `low` of a tangent, between two levels of the solution. */
static void step_in_cells(const struct gm_law *law, struct gm_collocation *work, const double *p,
                          const double *q)
{
    find_means(work->points, law->problem->line.jump, p, q, work->z);
    if (!gm_collocation_tangent(work, law->dt)) {
        gm_arena_leave(law->arena);
    }
}

/* A tangent of the box: a step finds its second level of nodes, the next one its faces. */
static void advance_tangent(const struct gm_law *law, size_t which, struct gm_faces *faces)
{
    const struct base base = base_of(law);
    const struct gm_levels *levels = &base.levels;
    const struct tangent a = tangent_on(law);
    const size_t points = law->problem->line.points;
    const double waves = 2 + (double)which, phase = 0.3 + 0.4 * (double)which;
    struct gm_collocation *work = gm_any_form_box(law);
    gm_tangent_start(a.past, points, waves, phase);
    find_means(points, 0, a.past, a.past, work->low + U * points);
    gm_tangent_start(work->low + V * points, points, waves, 2 * phase - M_PI / 2);
    step_in_cells(law, work, levels->past, levels->now);
    for (size_t i = 0; i < points; i++) {
        a.now[i] = -a.past[i];
        for (size_t k = 0; k < work->rank; k++) {
            a.now[i] += 2 * work->basis[U][k] * work->y[k * points + i];
        }
    }
    memcpy(work->low, work->high, DIMENSION * points * sizeof(double));
    step_in_cells(law, work, levels->now, levels->next);
    if (law->by_differences) {
        by_own_steps(&base, &a);
        find_means(points, 0, a.next, a.next, work->high + U * points);
    }
    gm_collocation_faces(work, faces);
}

double gm_wave_form(const struct gm_law *law)
{
    static const double one = 1;
    const struct gm_grid1 *grid = &law->problem->line;
    if (law_of(law) == GM_LAW_CELLS) {
        const struct gm_lattice cells = {grid->points, 1, 1, &one, &one, grid->dx, law->dt};
        return gm_lattice_law(law, &cells, advance_tangent);
    }
    const bool centred = law_of(law) == GM_LAW_CENTRED;
    const struct base base = base_of(law);
    const struct tangent a = tangent_of(&base, 0), b = tangent_of(&base, 1);
    const struct nodes of_a = {grid, law->dt, centred, &a}, of_b = {grid, law->dt, centred, &b};
    return gm_nodes_law(law, centred, complete_node, &of_a, &of_b);
}
