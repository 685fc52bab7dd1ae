/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Local laws of the box for any multisymplectic form: Razafindralandy et al. (2018), eqs. 35 and 36; B. Moore
   & S. Reich, Numer. Math. 95 (2003) 625. */
#include "core/field/families/laws/form.h"

#include <stdlib.h>

#include "core/field/families/boxes/any_form.h"
#include "core/field/families/families.h"
#include "core/theory/certify.h"

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

/* The mean of s in a cell, and the slope of s. */
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

static double energy_density(const struct gm_problem *problem, const double *s, const double *slope)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    return form->function(problem->parameters, s) - product(form->k, form->dimension, s, slope) / 2;
}

static double momentum_density(const struct gm_problem *problem, const double *s, const double *slope)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    return product(form->m, form->dimension, s, slope) / 2;
}

double gm_form_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *memory)
{
    return gm_any_form_integral(problem, scheme, memory, energy_density);
}

double gm_form_momentum(const struct gm_problem *problem, const struct gm_scheme *scheme,
                        const double *memory)
{
    return gm_any_form_integral(problem, scheme, memory, momentum_density);
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
    static const struct gm_settings no_settings;
    const struct gm_trial trial = {problem, scheme, &no_settings, dt, 1};
    double *next = malloc(problem->n * sizeof *next);
    const bool good = next && gm_trial_advance(&trial, y, next);
    for (size_t i = 0; good && i < problem->line.points; i++) {
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
        form->gradients(problem->parameters, middle, slope, 1);
        residual[i] = form->function(problem->parameters, b) - form->function(problem->parameters, a);
        for (size_t c = 0; c < d; c++) {
            residual[i] -= (b[c] - a[c]) * slope[c];
        }
        residual[i] /= law == GM_LAW_OF_ENERGY ? dt : problem->line.dx;
    }
    free(next);
    return good;
}
