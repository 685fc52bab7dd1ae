/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Local laws of the box for any multisymplectic form: Razafindralandy et al. (2018), eqs. 35 and 36; B. Moore & S.
   Reich, Numer. Math. 95 (2003) 625. */
#include "core/field/families/laws/form.h"

#include <stdlib.h>

#include "core/basics.h"
#include "core/field/families/boxes/collocation.h"
#include "core/field/families/families.h"

/* s at a node of one level, or of both in the middle, further by the jump around the ring. */
static void at_node(const struct gm_problem *problem, const double *y, const double *other, size_t i,
                    double *s)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    const size_t points = problem->line.points, node = i < points ? i : i - points;
    for (size_t c = 0; c < form->dimension; c++) {
        s[c] = (y[c * points + node] + other[c * points + node]) / 2 +
               (i < points || !form->jump ? 0 : form->jump[c]);
    }
}

/* Its mean in a cell, and its slope. */
static void in_cell(const struct gm_problem *problem, const double *y, size_t i, double *mean, double *slope)
{
    double right[GM_MOST_OF_FORM];
    at_node(problem, y, y, i, mean);
    at_node(problem, y, y, i + 1, right);
    for (size_t c = 0; c < gm_field_of(problem)->form->dimension; c++) {
        slope[c] = (right[c] - mean[c]) / problem->line.dx;
        mean[c] = (mean[c] + right[c]) / 2;
    }
}

/* At a node, with its slope by differences of order 8. */
static void at_place(const struct gm_problem *problem, const double *y, size_t i, double *s, double *slope)
{
    static const double weights[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    const struct gm_form *form = gm_field_of(problem)->form;
    const long points = (long)problem->line.points;
    for (size_t c = 0; c < form->dimension; c++) {
        const double *u = y + c * problem->line.points, jump = form->jump ? form->jump[c] : 0;
        s[c] = u[i];
        slope[c] = 0;
        for (long by = 1; by <= (long)GM_COUNT(weights); by++) {
            const long right = (long)i + by, left = (long)i - by + 4 * points;
            const double rise =
                u[right % points] - u[left % points] + jump * (double)(right / points - left / points + 4);
            slope[c] += weights[by - 1] * rise / problem->line.dx;
        }
    }
}

/* A box knows means in cells, whose integrals are of order 2; boxes of more stages have nodes of a higher one. */
static void here(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y, size_t i,
                 double *s, double *slope)
{
    const struct gm_collocation_tableau *tableau =
        scheme->family == &gm_family_any_form ? scheme->coefficients : NULL;
    if (tableau && tableau->r > 1) {
        at_place(problem, y, i, s, slope);
    } else {
        in_cell(problem, y, i, s, slope);
    }
}

static double product(const double *matrix, size_t d, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < d; i++) {
        for (size_t k = 0; k < d; k++) {
            sum += a[i] * matrix[i * d + k] * b[k];
        }
    }
    return sum;
}

double gm_form_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    double sum = 0, s[GM_MOST_OF_FORM], slope[GM_MOST_OF_FORM];
    for (size_t i = 0; i < problem->line.points; i++) {
        here(problem, scheme, y, i, s, slope);
        sum += form->function(problem->parameters, s) - product(form->k, form->dimension, s, slope) / 2;
    }
    return problem->line.dx * sum;
}

double gm_form_momentum(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    double sum = 0, s[GM_MOST_OF_FORM], slope[GM_MOST_OF_FORM];
    for (size_t i = 0; i < problem->line.points; i++) {
        here(problem, scheme, y, i, s, slope);
        sum += product(form->m, form->dimension, s, slope) / 2;
    }
    return problem->line.dx * sum;
}

/* The level after a step; NULL: memory is short, or it fails. */
static double *next_level(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                          const double *y)
{
    const struct gm_family *family = scheme->family;
    const size_t size = family->memory(problem, scheme);
    double *next = malloc(problem->n * sizeof *next), *memory = calloc(2 * size, sizeof *memory);
    void *work = family->workspace_open(problem, scheme);
    struct gm_task task = {
        .problem = problem,
        .scheme = scheme,
        .dt = dt,
        .steps = 1,
        .limit = INFINITY,
        .y = y,
        .out = next,
        .memory_out = memory,
        .workspace = work,
    };
    bool good = next && memory && work && family->start(&task) == GM_OK;
    if (good) {
        task.memory = memory;
        task.memory_out = memory + size;
        good = family->loop(&task).status == GM_OK;
    }
    if (work) {
        family->workspace_close(work);
    }
    free(memory);
    if (!good) {
        free(next);
    }
    return good ? next : NULL;
}

bool gm_form_laws(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                  const double *y, enum gm_local_law law, double *residual)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    const size_t d = form->dimension;
    if (scheme->family != &gm_family_any_form || law == GM_LAW_OF_CONTENT ||
        ((const struct gm_collocation_tableau *)scheme->coefficients)->r != 1) {
        return false;
    }
    double *next = next_level(problem, scheme, dt, y);
    for (size_t i = 0; next && i < problem->line.points; i++) {
        double a[GM_MOST_OF_FORM], b[GM_MOST_OF_FORM], middle[GM_MOST_OF_FORM], slope[GM_MOST_OF_FORM];
        if (law == GM_LAW_OF_ENERGY) {
            in_cell(problem, y, i, a, slope);
            in_cell(problem, next, i, b, slope);
        } else {
            at_node(problem, y, next, i, a);
            at_node(problem, y, next, i + 1, b);
        }
        for (size_t c = 0; c < d; c++) {
            middle[c] = (a[c] + b[c]) / 2;
        }
        form->gradient(problem->parameters, middle, slope);
        residual[i] = form->function(problem->parameters, b) - form->function(problem->parameters, a);
        for (size_t c = 0; c < d; c++) {
            residual[i] -= (b[c] - a[c]) * slope[c];
        }
        residual[i] /= law == GM_LAW_OF_ENERGY ? dt : problem->line.dx;
    }
    const bool good = next != NULL;
    free(next);
    return good;
}
