/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws of the box for equations of first order in time. The multisymplectic one: two tangents are
   advanced by a step, and the variables that elimination left out follow from the box equations that hold
   them (gm_dispersive). The laws of energy and momentum (Razafindralandy et al. (2018), eqs. 35 and 36):
   the product of the scheme's equation with D_t A_x s, or D_x A_t s, is a difference in time and one in
   space but for S, and of S but for what is not quadratic in it, V. */
#include "core/field/families/dispersive/form.h"

#include <math.h>
#include <string.h>

#include "core/field/families/dispersive/box.h"
#include "core/field/multisymplectic.h"

/* A solution, real parts and then imaginary ones. */
struct base {
    const struct gm_law *law;
    double *now, *next, *cells; /* the means are those of the cells between both levels */
};

static size_t field_of(const struct gm_problem *problem)
{
    return (gm_field_of(problem)->dispersive->complex_valued ? 2 : 1) * problem->line.points;
}

static void cell_means(const struct base *base)
{
    const size_t points = base->law->problem->line.points;
    for (size_t part = 0; part < 2; part++) {
        const double *now = base->now + part * points, *next = base->next + part * points;
        for (size_t i = 0; i < points; i++) {
            const size_t r = i + 1 < points ? i + 1 : 0;
            base->cells[part * points + i] = (now[i] + now[r] + next[i] + next[r]) / 4;
        }
    }
}

/* The level of the state and the next, with the means between. */
static struct base base_of(const struct gm_law *law)
{
    const size_t size = 2 * law->problem->line.points, field = field_of(law->problem) * sizeof(double);
    double *now = gm_arena_take(law->arena, 3 * size + law->problem->n, sizeof *now), *after = now + 3 * size;
    const struct base base = {law, now, now + size, now + 2 * size};
    if (!gm_law_step(law, 1, law->y, NULL, after, NULL)) {
        gm_arena_leave(law->arena);
    }
    memcpy(now, law->y, field);
    memcpy(base.next, after, field);
    cell_means(&base);
    return base;
}

static void advance_tangents(const struct gm_law *law, struct gm_faces faces[2])
{
    const struct gm_problem *problem = law->problem;
    const size_t points = problem->line.points, field = field_of(problem);
    const struct base base = base_of(law);
    double *now = gm_arena_take(law->arena, 4 * points + 2, sizeof *now), *next = now + 2 * points + 1;
    for (size_t k = 0; k < 2; k++) {
        for (size_t at = 0; at < field; at += points) {
            gm_tangent_start(now + at, points, 2 + (double)k, 0.3 + 0.4 * (double)k + (double)(at / points));
        }
        if (law->by_differences) {
            gm_law_differentiate(law, law->y, NULL, now, next);
        } else if (gm_dispersive_tangent(law->work, problem, law->dt, base.cells, now, next) != GM_OK) {
            gm_arena_leave(law->arena);
        }
        gm_field_of(problem)->dispersive->complete(problem, law->dt, base.cells, now, next, &faces[k]);
    }
}

static struct gm_lattice cells_of(const struct gm_law *law)
{
    static const double one = 1;
    return (struct gm_lattice){law->problem->line.points, 1, 1, &one, &one, law->problem->line.dx, law->dt};
}

double gm_dispersive_form(const struct gm_law *law)
{
    const struct gm_lattice cells = cells_of(law);
    return gm_lattice_law(law, &cells, advance_tangents);
}

/* [V(b) - V(a) - (b - a) V'((a + b)/2)] / step */
static double beyond_quadratic(const struct gm_problem *problem, const double a[2], const double b[2],
                               double step)
{
    const struct gm_dispersive *equation = gm_field_of(problem)->dispersive;
    const double re = (a[0] + b[0]) / 2, im = (a[1] + b[1]) / 2;
    double g[2];
    equation->nonlinear(problem, &re, &im, &g[0], &g[1], 1);
    const double change = equation->potential(problem, b[0], b[1]) - equation->potential(problem, a[0], a[1]);
    return (change - (b[0] - a[0]) * g[0] - (b[1] - a[1]) * g[1]) / step;
}

/* The law that is measured, and its residual in each cell. */
struct local {
    enum gm_local_law law;
    double *residual;
};

static void find_residual(const struct gm_law *law, void *data)
{
    const struct local *local = data;
    const struct gm_problem *problem = law->problem;
    const struct base base = base_of(law);
    const size_t points = problem->line.points;
    const bool energy = local->law == GM_LAW_OF_ENERGY;
    if (local->law == GM_LAW_OF_CONTENT) {
        const struct gm_lattice cells = cells_of(law);
        struct gm_faces faces = gm_faces_of(law, &cells);
        gm_field_of(problem)->dispersive->content(problem, law->dt, base.cells, base.now, base.next, &faces,
                                                  local->residual);
        return;
    }
    for (size_t i = 0; i < points; i++) {
        const size_t r = i + 1 < points ? i + 1 : 0;
        double a[2], b[2];
        for (size_t part = 0; part < 2; part++) {
            const double *f = base.now + part * points, *g = base.next + part * points;
            a[part] = (f[i] + (energy ? f[r] : g[i])) / 2;
            b[part] = ((energy ? g[i] : f[r]) + g[r]) / 2;
        }
        local->residual[i] = beyond_quadratic(problem, a, b, energy ? law->dt : problem->line.dx);
    }
}

bool gm_dispersive_laws(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                        const double *y, enum gm_local_law law, double *residual)
{
    struct gm_law of = {problem, scheme, dt, y, NULL, .by_differences = false};
    struct local local = {law, residual};
    return gm_law_measure(&of, find_residual, &local);
}
