/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The multisymplectic law of the box for equations of first order in time: two tangents are advanced by a
   step, and the variables that elimination left out follow from the box equations that hold them
   (gm_dispersive). */
#include "core/field/families/dispersive_form.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/field/families/dispersive_box.h"
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

double gm_dispersive_form(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                          const double *y, bool by_differences)
{
    enum { ARRAYS = 7 };
    const size_t size = 2 * problem->line.points;
    double *memory = calloc(ARRAYS * size, sizeof *memory), residual = NAN;
    struct base base = {
        .problem = problem,
        .scheme = scheme,
        .dt = dt,
        .work = scheme->family->workspace_open(problem, scheme),
    };
    if (memory && base.work) {
        base.now = memory;
        base.next = memory + size;
        base.cells = memory + 2 * size;
        double *const tangent[2][2] = {{memory + 3 * size, memory + 4 * size},
                                       {memory + 5 * size, memory + 6 * size}};
        memcpy(base.now, y, parts_of(problem) * problem->line.points * sizeof *y);
        if (one_step(&base, base.now, base.next)) {
            cell_means(&base);
            residual = law(&base, by_differences, tangent);
        }
    }
    if (base.work) {
        scheme->family->workspace_close(base.work);
    }
    free(memory);
    return residual;
}
