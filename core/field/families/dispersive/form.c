/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws of the box for equations of first order in time. The multisymplectic one: two tangents are advanced
   by a step, and the variables that elimination left out follow from the box equations that hold them
   (gm_dispersive). Those of energy and momentum (Razafindralandy et al. (2018), eqs. 35 and 36): the product of
   the scheme's equation with D_t A_x s, or D_x A_t s, is a difference in time and one in space but for S, and
   of S but for what is not quadratic in it, V. */
#include "core/field/families/dispersive/form.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/field/families/dispersive/box.h"
#include "core/field/multisymplectic.h"
#include "core/linear/differences.h"

struct base {
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    double dt;
    void *work;
    double *now, *next, *cells; /* real parts, then imaginary ones */
};

static size_t parts_of(const struct gm_problem *problem)
{
    return gm_field_of(problem)->dispersive->complex_valued ? 2 : 1;
}

/* gm_map: the field to the next level of it. */
static bool one_step(const void *context, const double *from, double *to)
{
    const struct base *base = context;
    const size_t field = parts_of(base->problem) * base->problem->line.points;
    double *y = calloc(2 * base->problem->n, sizeof *y);
    if (!y) {
        return false;
    }
    memcpy(y, from, field * sizeof *y);
    const struct gm_task task = {
        .problem = base->problem,
        .scheme = base->scheme,
        .dt = base->dt,
        .steps = 1,
        .limit = INFINITY,
        .y = y,
        .out = y + base->problem->n,
        .workspace = base->work,
    };
    const bool good = base->scheme->family->loop(&task).status == GM_OK;
    memcpy(to, task.out, field * sizeof *to);
    free(y);
    return good;
}

static bool advance_tangent(const struct base *base, bool by_differences, const double *now, double *next)
{
    const size_t field = parts_of(base->problem) * base->problem->line.points;
    return by_differences
               ? gm_differentiate(one_step, base, field, base->now, now, field, next)
               : gm_dispersive_tangent(base->work, base->problem, base->dt, base->cells, now, next) == GM_OK;
}

static void cell_means(const struct base *base)
{
    const size_t points = base->problem->line.points;
    for (size_t part = 0; part < 2; part++) {
        const double *now = base->now + part * points, *next = base->next + part * points;
        for (size_t i = 0; i < points; i++) {
            const size_t r = i + 1 < points ? i + 1 : 0;
            base->cells[part * points + i] = (now[i] + now[r] + next[i] + next[r]) / 4;
        }
    }
}

static double law(const struct base *base, bool by_differences, double *const tangent[2][2])
{
    static const double one = 1;
    const struct gm_problem *problem = base->problem;
    const size_t points = problem->line.points;
    const struct gm_lattice cells = {points, 1, 1, &one, &one, problem->line.dx, base->dt};
    struct gm_faces faces[2];
    double residual = NAN;
    if (!gm_faces_open(&faces[0], gm_field_of(problem)->form, &cells)) {
        return NAN;
    }
    if (!gm_faces_open(&faces[1], gm_field_of(problem)->form, &cells)) {
        gm_faces_close(&faces[0]);
        return NAN;
    }
    bool good = true;
    for (size_t k = 0; good && k < 2; k++) {
        for (size_t part = 0; part < parts_of(problem); part++) {
            gm_tangent_start(tangent[k][0] + part * points, points, 2 + (double)k,
                             0.3 + 0.4 * (double)k + (double)part);
        }
        good = advance_tangent(base, by_differences, tangent[k][0], tangent[k][1]);
        gm_field_of(problem)->dispersive->complete(problem, base->dt, base->cells, tangent[k][0],
                                                   tangent[k][1], &faces[k]);
    }
    if (good) {
        residual = gm_lattice_law(gm_field_of(problem)->form, &cells, &faces[0], &faces[1]);
    }
    gm_faces_close(&faces[0]);
    gm_faces_close(&faces[1]);
    return residual;
}

enum { LEVELS = 3, ARRAYS = LEVELS + 4 };

static void close_base(struct base *base)
{
    if (base->work) {
        base->scheme->family->workspace_close(base->work);
    }
    free(base->now);
}

/* The level of the state and the next, with the means between and `ARRAYS - LEVELS` more arrays behind; to be
   closed in either case. */
static bool open_base(struct base *base, const struct gm_problem *problem, const struct gm_scheme *scheme,
                      double dt, const double *y)
{
    const size_t size = 2 * problem->line.points;
    *base = (struct base){
        .problem = problem,
        .scheme = scheme,
        .dt = dt,
        .work = scheme->family->workspace_open(problem, scheme),
        .now = calloc(ARRAYS * size, sizeof(double)),
    };
    if (!base->work || !base->now) {
        return false;
    }
    base->next = base->now + size;
    base->cells = base->next + size;
    memcpy(base->now, y, parts_of(problem) * problem->line.points * sizeof *y);
    if (!one_step(base, base->now, base->next)) {
        return false;
    }
    cell_means(base);
    return true;
}

double gm_dispersive_form(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                          const double *y, bool by_differences)
{
    const size_t size = 2 * problem->line.points;
    struct base base;
    double residual = NAN;
    if (open_base(&base, problem, scheme, dt, y)) {
        double *more = base.now + LEVELS * size;
        double *const tangent[2][2] = {{more, more + size}, {more + 2 * size, more + 3 * size}};
        residual = law(&base, by_differences, tangent);
    }
    close_base(&base);
    return residual;
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

static bool content_law(const struct base *base, double *residual)
{
    static const double one = 1;
    const struct gm_problem *problem = base->problem;
    const struct gm_lattice cells = {problem->line.points, 1, 1, &one, &one, problem->line.dx, base->dt};
    struct gm_faces faces;
    if (!gm_faces_open(&faces, gm_field_of(problem)->form, &cells)) {
        return false;
    }
    gm_field_of(problem)->dispersive->content(problem, base->dt, base->cells, base->now, base->next, &faces,
                                              residual);
    gm_faces_close(&faces);
    return true;
}

bool gm_dispersive_laws(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                        const double *y, enum gm_local_law law, double *residual)
{
    const size_t points = problem->line.points;
    struct base base;
    bool good = open_base(&base, problem, scheme, dt, y);
    if (good && law == GM_LAW_OF_CONTENT) {
        good = content_law(&base, residual);
    }
    for (size_t i = 0; good && law != GM_LAW_OF_CONTENT && i < points; i++) {
        const size_t r = i + 1 < points ? i + 1 : 0;
        double a[2], b[2];
        for (size_t part = 0; part < 2; part++) {
            const double *f = base.now + part * points, *g = base.next + part * points;
            a[part] = (f[i] + (law == GM_LAW_OF_ENERGY ? f[r] : g[i])) / 2;
            b[part] = ((law == GM_LAW_OF_ENERGY ? g[i] : f[r]) + g[r]) / 2;
        }
        residual[i] = beyond_quadratic(problem, a, b, law == GM_LAW_OF_ENERGY ? base.dt : problem->line.dx);
    }
    close_base(&base);
    return good;
}
