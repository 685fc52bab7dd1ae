/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The multisymplectic law of schemes for u_tt - u_xx + V'(u) = 0, s = (u, v, w), v = u_t, w = u_x. The
   schemes have u alone, or u and v; what else the law asks for follows from their equations, linearised:
       Euler box   v = D_t^- u,   w = D_x^- u
       midpoint    w = D_0 u
   The box has the tangents of all components (gm_box_linearise). */
#include "core/field/families/waves/form.h"

#include <math.h>
#include <string.h>

#include "core/field/families/two_step.h"
#include "core/field/multisymplectic.h"

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

static enum gm_wave_law law_of(const struct gm_law *law)
{
    return ((const struct gm_two_step_row *)law->scheme->coefficients)->law;
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
    } else if (kind == GM_LAW_CENTRED) {
        linearised_centred(base, &a);
    } else {
        linearised_nodes(base, &a);
    }
    return a;
}

/* The means of u in the cells between two levels, and zeros for v. */
static const double *cells_of(const struct gm_law *law, const double *p, const double *q)
{
    const struct gm_grid1 *grid = &law->problem->line;
    double *cells = gm_arena_take(law->arena, 2 * grid->points, sizeof *cells);
    for (size_t i = 0; i < grid->points; i++) {
        const size_t r = right_of(i, grid->points);
        cells[i] = (p[i] + p[r] + q[i] + q[r] + (r == 0 ? 2 * grid->jump : 0)) / 4;
    }
    return cells;
}

/* Advances tangents of the box of all components. They are compared with differences of the scheme's own steps from the
   level before, which a step back of the box gives, with A_t V = D_t A_x u. */
static void advance_tangents(const struct gm_law *law, struct gm_faces faces[2])
{
    const size_t points = law->problem->line.points;
    const struct gm_levels levels = gm_levels_of(law);
    struct gm_law back = *law;
    back.dt = -law->dt;
    struct gm_box_tangents *ahead = gm_box_linearise(law, cells_of(law, levels.now, levels.next)),
                           *before = law->by_differences
                                         ? gm_box_linearise(&back, cells_of(law, levels.past, levels.now))
                                         : NULL;
    double *now = gm_arena_take(law->arena, 4 * points, sizeof *now), *past = now + 2 * points,
           *next = past + points;
    const double *const from[] = {levels.now, levels.past}, *const along[] = {now, past};
    for (size_t k = 0; k < 2; k++) {
        const double waves = 2 + (double)k, phase = 0.3 + 0.4 * (double)k;
        gm_tangent_start(now, points, waves, phase);
        gm_tangent_start(now + points, points, waves, 3 * phase);
        if (before) {
            gm_box_advance_tangent(before, -law->dt, now, NULL, &faces[k]);
        }
        for (size_t i = 0; i < points; i++) {
            past[i] = 2 * faces[k].sides[i * DIMENSION + U] - now[i];
        }
        gm_box_advance_tangent(ahead, law->dt, now, NULL, &faces[k]);
        if (before) {
            gm_law_differentiate_levels(law, 2, from, along, (double *const[]){next, NULL});
        }
        for (size_t i = 0; before && i < points; i++) {
            const double *lower = faces[k].lower + i * DIMENSION;
            double *upper = faces[k].upper + i * DIMENSION;
            upper[U] = (next[i] + next[right_of(i, points)]) / 2;
            upper[V] = 2 / law->dt * (upper[U] - lower[U]) - lower[V];
        }
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
    const struct base base = {law, gm_levels_of(law)};
    const struct tangent a = tangent_of(&base, 0), b = tangent_of(&base, 1);
    const struct nodes of_a = {grid, law->dt, centred, &a}, of_b = {grid, law->dt, centred, &b};
    return gm_nodes_law(law, centred, complete_node, &of_a, &of_b);
}
