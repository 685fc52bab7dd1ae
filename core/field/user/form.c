/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A user-defined multisymplectic form: S, its gradient and its second derivatives are formulas. A
   component that S does not contain and whose slope an equation without K gives is a potential: it is
   integrated from the others, and its change around the ring is its jump. */
#include "core/field/user/form.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/tape.h"

struct own {
    struct gm_user_line line; /* first */
    struct gm_field facets;
    struct gm_form form;
    const struct gm_user_form *source;
    double k[GM_MOST_OF_FORM * GM_MOST_OF_FORM], l[GM_MOST_OF_FORM * GM_MOST_OF_FORM];
    double jump[GM_MOST_OF_FORM], told[GM_MOST_OF_FORM]; /* jumps; those in the lines (NAN: none) */
    const char *names[GM_MOST_OF_FORM];
    struct gm_form_potential potentials[GM_MOST_OF_FORM];
    struct gm_tape function, gradient, hessian;
};

static const struct own *own_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

static double function(const void *parameters, const double *s)
{
    const struct own *self = parameters;
    double value;
    gm_tape_values(&self->function, s, &value, 1);
    return value;
}

static void gradients(const void *parameters, const double *s, double *to, size_t count)
{
    gm_tape_values(&((const struct own *)parameters)->gradient, s, to, count);
}

static void hessians(const void *parameters, const double *s, double *to, size_t count)
{
    gm_tape_values(&((const struct own *)parameters)->hessian, s, to, count);
}

/* ---- what is derived ---- */

bool gm_user_form_derive(struct gm_user_form *form, struct gm_user_system *system)
{
    const size_t n = system->n;
    *form = (struct gm_user_form){.system = system};
    for (size_t row = 0; row < n; row++) { /* the components are the first variables */
        gm_gradient(&system->graph, system->rates[row], NULL, n, form->hessian + row * n);
    }
    return !system->graph.failed && gm_line_derive(&form->formulas, system) && !system->graph.failed;
}

/* The potentials, and their jumps. */
static void find_potentials(struct gm_problem *problem, struct own *self)
{
    const struct gm_user_system *system = self->source->system;
    const size_t n = system->n, points = problem->line.points;
    self->form.potentials = self->potentials;
    for (size_t c = 0; c < n; c++) {
        for (size_t row = 0; row < n && gm_is_constant(&system->graph, system->rates[c], 0); row++) {
            bool alone = self->l[row * n + c] != 0;
            for (size_t e = 0; e < n; e++) {
                alone = alone && self->k[row * n + e] == 0 && (e == c || self->l[row * n + e] == 0);
            }
            if (alone) {
                self->potentials[self->form.potential_count++] = (struct gm_form_potential){c, row};
                break;
            }
        }
    }
    if (self->form.potential_count == 0) {
        return;
    }
    double *y = gm_arena_take(self->line.arena, n * points, sizeof *y);
    gm_user_form_start(problem, y);
    for (size_t i = 0; i < points; i++) {
        double s[GM_MOST_OF_FORM], slope[GM_MOST_OF_FORM];
        const size_t right = i + 1 < points ? i + 1 : 0;
        for (size_t c = 0; c < n; c++) {
            s[c] = (y[c * points + i] + y[c * points + right] + (right == 0 ? self->jump[c] : 0)) / 2;
        }
        gradients(self, s, slope, 1);
        for (size_t p = 0; p < self->form.potential_count; p++) {
            const struct gm_form_potential *potential = &self->potentials[p];
            self->jump[potential->component] +=
                (i == 0 ? -self->jump[potential->component] : 0) +
                problem->line.dx * slope[potential->row] / self->l[potential->row * n + potential->component];
        }
    }
}

static void open_problem(struct gm_arena *arena, void *data)
{
    const struct gm_line_opening *opening = data;
    const struct gm_user_form *form = opening->formulas;
    const double *values = opening->values;
    const struct gm_user_system *system = form->system;
    const size_t n = system->n;
    struct own *self = gm_user_line_take(arena, opening->problem, system, sizeof *self);
    opening->problem->facets = &self->facets;
    self->source = form;
    self->form = (struct gm_form){.dimension = n,
                                  .m = self->k,
                                  .k = self->l,
                                  .function = function,
                                  .gradients = gradients,
                                  .hessians = hessians,
                                  .jump = self->jump,
                                  .names = self->names};
    for (size_t c = 0; c < n; c++) {
        self->names[c] = system->variables[c].name;
    }
    self->facets.form = &self->form;
    gm_user_line_tape(&self->line, &self->function, &system->energy, 1, n, values);
    gm_user_line_tape(&self->line, &self->gradient, system->rates, n, n, values);
    gm_user_line_tape(&self->line, &self->hessian, form->hessian, n * n, n, values);
    gm_user_line_open(&self->line, form->formulas.start, n, form->formulas.exact, values);
    double *all = gm_arena_take(arena, system->graph.count + (size_t)1, sizeof *all);
    gm_formula_evaluate(&system->graph, system->graph.count, values, all);
    for (size_t i = 0; i < n * n; i++) {
        self->k[i] = all[system->matrices[i]];
        self->l[i] = all[system->matrices[n * n + i]];
    }
    for (size_t i = 0; i < n; i++) {
        self->told[i] = system->variables[i].jump == GM_NO_NODE ? NAN : all[system->variables[i].jump];
        self->jump[i] = isnan(self->told[i]) ? 0 : self->told[i];
    }
    find_potentials(opening->problem, self);
}

bool gm_user_form_open(struct gm_problem *problem, const struct gm_user_form *form, const double *values,
                       const struct gm_grid1 *grid)
{
    *problem = (struct gm_problem){.name = "multisymplectic equation",
                                   .kind = &gm_kind_field,
                                   .m = 1,
                                   .n = form->system->n * grid->points,
                                   .line = *grid};
    return gm_user_line_problem(open_problem, &(struct gm_line_opening){problem, form, values, NULL});
}

/* ---- the start ---- */

void gm_user_form_start(const struct gm_problem *problem, double *y)
{
    const struct own *self = own_of(problem);
    const size_t n = self->form.dimension, points = problem->line.points;
    double s[GM_MOST_OF_FORM], slope[GM_MOST_OF_FORM];
    gm_user_line_start(&self->line, &problem->line, y);
    /* Gauss's formula of three points in every cell */
    static const double weights[] = {5.0 / 18, 4.0 / 9, 5.0 / 18};
    const double apart = sqrt(0.15);
    for (size_t i = 0; i + 1 < points && self->form.potential_count > 0; i++) {
        for (size_t p = 0; p < self->form.potential_count; p++) {
            double *at = y + self->potentials[p].component * points + i;
            at[1] = at[0];
        }
        for (size_t k = 0; k < GM_COUNT(weights); k++) {
            const double x =
                gm_grid1_node(&problem->line, i) + problem->line.dx * (0.5 + apart * ((double)k - 1));
            gm_tape_values(&self->line.start, &x, s, 1);
            gradients(self, s, slope, 1);
            for (size_t p = 0; p < self->form.potential_count; p++) {
                const struct gm_form_potential *potential = &self->potentials[p];
                y[potential->component * points + i + 1] +=
                    weights[k] * problem->line.dx * slope[potential->row] /
                    self->l[potential->row * n + potential->component];
            }
        }
    }
}

bool gm_user_form_is_potential(const struct gm_problem *problem, size_t component)
{
    const struct own *self = own_of(problem);
    for (size_t p = 0; p < self->form.potential_count; p++) {
        if (self->potentials[p].component == component) {
            return true;
        }
    }
    return false;
}

static bool component_closes(const struct gm_problem *problem, size_t c, struct gm_fault *fault)
{
    const struct own *self = own_of(problem);
    const bool is_potential = gm_user_form_is_potential(problem, c);
    struct gm_line_ends ends;
    if (!gm_user_line_closes(&self->line, &problem->line, c, is_potential ? NAN : self->jump[c], &ends,
                             fault)) {
        return false;
    }
    if (is_potential &&
        fabs(self->told[c] - self->jump[c]) > 1e-3 * fmax(fabs(self->jump[c]), ends.high - ends.low)) {
        return gm_fail(
            fault, 0,
            "%.60s gains %.6g around the ring, which follows from the others at the start, and not %.6g as jump "
            "says",
            self->names[c], self->jump[c], self->told[c]);
    }
    return true;
}

static bool is_zero(const double *matrix, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += fabs(matrix[i]);
    }
    return sum == 0;
}

bool gm_user_form_closes(const struct gm_problem *problem, struct gm_fault *fault)
{
    const struct own *self = own_of(problem);
    const size_t n = self->form.dimension;
    if (is_zero(self->k, n * n) || is_zero(self->l, n * n)) {
        return gm_fail(fault, 0, "%s is 0 with these values, and nothing changes in %s",
                       is_zero(self->k, n * n) ? "K" : "L", is_zero(self->k, n * n) ? "time" : "space");
    }
    for (size_t c = 0; c < n; c++) {
        if (!component_closes(problem, c, fault)) {
            return false;
        }
    }
    for (size_t i = 0; i < problem->line.points; i++) {
        double s[GM_MOST_OF_FORM], here[GM_MOST_OF_FORM], further[GM_MOST_OF_FORM];
        const double x = gm_grid1_node(&problem->line, i);
        gm_tape_values(&self->line.start, &x, s, 1);
        gradients(self, s, here, 1);
        for (size_t c = 0; c < n; c++) {
            s[c] += gm_user_form_is_potential(problem, c) ? 0 : self->jump[c];
        }
        gradients(self, s, further, 1);
        for (size_t c = 0; c < n; c++) {
            if (!isfinite(here[c])) {
                return gm_fail(fault, 0, "the gradient of S is not finite at the start where x = %.6g", x);
            }
            if (!(fabs(further[c] - here[c]) <= 1e-9 * fmax(1, fabs(here[c])))) {
                return gm_fail(fault, 0, "the derivative of S over %.60s does not repeat after the jumps",
                               self->source->system->variables[c].name);
            }
        }
    }
    return true;
}
