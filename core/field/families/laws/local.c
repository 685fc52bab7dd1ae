/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The laws of energy and momentum that follow from M s_t + K s_x = grad S(s), in cells: the product of the box scheme's
   equation with D_t A_x s, or D_x A_t s, is a difference in time and one in space but for S, and of S but for what is not
   quadratic in it (Razafindralandy et al. (2018), eqs. 35 and 36; B. Moore & S. Reich, Numer. Math. 95 (2003) 625). At the
   nodes of two-step schemes for waves: the product of their equation with centred differences. */
#include "core/field/families/laws/laws.h"

#include <stdlib.h>

#include "core/field/families/boxes/any_form.h"
#include "core/field/families/dispersive/box.h"
#include "core/field/families/families.h"
#include "core/field/families/two_step.h"
#include "core/field/families/waves/form.h"
#include "core/theory/certify.h"

/* The law that is measured, and its residual at each node or in each cell. */
struct local {
    enum gm_local_law law;
    double *residual;
};

static double d2(const struct gm_grid1 *grid, const double *level, size_t i)
{
    return (gm_grid1_value(grid, level, i, 1) - 2 * level[i] + gm_grid1_value(grid, level, i, -1)) /
           (grid->dx * grid->dx);
}

/* u_tt - d2 u + [V(a) - V(b)] / (a - b): what multiplies u_t in the law of energy, u_x in that of momentum */
static double node_law(const struct gm_problem *problem, const struct gm_levels *levels, double dt, size_t i,
                       double a, double b)
{
    double quotient;
    gm_field_of(problem)->wave->quotients(problem, &a, &b, &quotient, NULL, 1);
    return (levels->next[i] - 2 * levels->now[i] + levels->past[i]) / (dt * dt) -
           d2(&problem->line, levels->now, i) + quotient;
}

static void measure_nodes(const struct gm_law *of, void *data)
{
    const struct gm_problem *problem = of->problem;
    const struct gm_grid1 *grid = &problem->line;
    const struct gm_levels levels = gm_levels_of(of);
    const struct local *local = data;
    for (size_t i = 0; i < grid->points; i++) {
        if (local->law == GM_LAW_OF_ENERGY) {
            const double rate = (levels.next[i] - levels.past[i]) / (2 * of->dt);
            local->residual[i] = rate * node_law(problem, &levels, of->dt, i, levels.next[i], levels.past[i]);
        } else {
            const double a = gm_grid1_value(grid, levels.now, i, 1),
                         b = gm_grid1_value(grid, levels.now, i, -1);
            local->residual[i] = (a - b) / (2 * grid->dx) * node_law(problem, &levels, of->dt, i, a, b);
        }
    }
}

/* [S(b) - S(a) - (b - a)' grad S((a + b)/2)] / step, or the same of the part of S that is not quadratic. */
typedef double beyond_quadratic(const struct gm_problem *problem, const double *a, const double *b,
                                double step);

static double beyond_of_wave(const struct gm_problem *problem, const double *a, const double *b, double step)
{
    const struct gm_wave *wave = gm_field_of(problem)->wave;
    const double middle = (*a + *b) / 2;
    double slope, quotient;
    wave->slopes(problem, &middle, &slope, 1);
    wave->quotients(problem, a, b, &quotient, NULL, 1);
    return (*b - *a) / step * (quotient - slope);
}

static double beyond_of_dispersive(const struct gm_problem *problem, const double *a, const double *b,
                                   double step)
{
    const struct gm_dispersive *equation = gm_field_of(problem)->dispersive;
    const double re = (a[0] + b[0]) / 2, im = (a[1] + b[1]) / 2;
    double g[2];
    equation->nonlinear(problem, &re, &im, &g[0], &g[1], 1);
    const double change = equation->potential(problem, b[0], b[1]) - equation->potential(problem, a[0], a[1]);
    return (change - (b[0] - a[0]) * g[0] - (b[1] - a[1]) * g[1]) / step;
}

static double beyond_of_form(const struct gm_problem *problem, const double *a, const double *b, double step)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    double middle[GM_MOST_OF_FORM], slope[GM_MOST_OF_FORM];
    for (size_t c = 0; c < form->dimension; c++) {
        middle[c] = (a[c] + b[c]) / 2;
    }
    form->gradients(problem->parameters, middle, slope, 1);
    double rest = form->function(problem->parameters, b) - form->function(problem->parameters, a);
    for (size_t c = 0; c < form->dimension; c++) {
        rest -= (b[c] - a[c]) * slope[c];
    }
    return rest / step;
}

/* The law in every cell between two levels, of `components` each. */
static void measure_cells(const struct local *local, const struct gm_trial *trial, const double *now,
                          const double *next, size_t components, beyond_quadratic *beyond)
{
    const struct gm_grid1 *grid = &trial->problem->line;
    const double *jumps = gm_field_of(trial->problem)->form->jump;
    const size_t points = grid->points;
    const bool energy = local->law == GM_LAW_OF_ENERGY;
    for (size_t i = 0; i < points; i++) {
        const size_t r = i + 1 < points ? i + 1 : 0;
        double a[GM_MOST_OF_FORM] = {0}, b[GM_MOST_OF_FORM] = {0};
        for (size_t c = 0; c < components; c++) {
            const double gained = jumps ? jumps[c] : grid->jump, jump = r == 0 ? gained : 0;
            const double *f = now + c * points, *g = next + c * points;
            const double f_right = f[r] + jump, g_right = g[r] + jump;
            a[c] = (f[i] + (energy ? f_right : g[i])) / 2;
            b[c] = ((energy ? g[i] : f_right) + g_right) / 2;
        }
        local->residual[i] = beyond(trial->problem, a, b, energy ? trial->dt : grid->dx);
    }
}

/* GM_LAW_NONE for schemes of other families. */
static enum gm_wave_law law_of(const struct gm_scheme *scheme)
{
    const struct gm_two_step_row *row = scheme->coefficients;
    const struct gm_scheme *rows = scheme->family->schemes;
    const bool has_row = rows == gm_family_leapfrog.schemes || rows == gm_family_preissmann.schemes ||
                         rows == gm_family_midpoint_box.schemes;
    return has_row ? row->law : GM_LAW_NONE;
}

static bool is_box_of_all(const struct gm_scheme *scheme)
{
    return scheme->family == &gm_family_any_form &&
           ((const struct gm_collocation_tableau *)scheme->coefficients)->r == 1;
}

bool gm_local_laws(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                   const double *y, enum gm_local_law law, double *residual)
{
    static const struct gm_settings no_settings;
    const struct gm_trial trial = {problem, scheme, &no_settings, dt, 1};
    const struct gm_field *field = gm_field_of(problem);
    const size_t points = problem->line.points;
    struct gm_law of = {problem, scheme, dt, y, NULL, .by_differences = false};
    struct local local = {law, residual};
    if (field->wave && law_of(scheme) == GM_LAW_CELLS) {
        measure_cells(&local, &trial, y + points, y, 1,
                      beyond_of_wave); /* the last step led from the other level */
        return true;
    }
    if (field->wave) {
        return law_of(scheme) == GM_LAW_NODES && gm_law_measure(&of, measure_nodes, &local);
    }
    const bool all = gm_form_is_state(field->form), content = law == GM_LAW_OF_CONTENT;
    if (all ? content || !is_box_of_all(scheme) : scheme->family != &gm_family_preissmann) {
        return false;
    }
    if (content) {
        return gm_law_measure(&of, gm_dispersive_content, residual);
    }
    double *next = malloc(problem->n * sizeof *next);
    const bool made = next && gm_trial_advance(&trial, y, next);
    if (made && all) {
        measure_cells(&local, &trial, y, next, field->form->dimension, beyond_of_form);
    } else if (made) {
        measure_cells(&local, &trial, y, next, field->form->kept, beyond_of_dispersive);
    }
    free(next);
    return made;
}
