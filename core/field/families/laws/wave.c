/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Energy and momentum of u_tt - u_xx + V'(u) = 0 on a grid, and by how much a scheme's step fails their local
   laws. */
#include "core/field/families/laws/wave.h"

#include <math.h>

#include "core/field/families/families.h"
#include "core/field/families/two_step.h"
#include "core/field/families/waves/form.h"

static double d2(const struct gm_grid1 *grid, const double *level, size_t i)
{
    return (gm_grid1_value(grid, level, i, 1) - 2 * level[i] + gm_grid1_value(grid, level, i, -1)) /
           (grid->dx * grid->dx);
}

/* Adds a term to a sum and keeps what rounding would lose (Neumaier 1974): invariants are looked at to the
   last digit. */
struct exact_sum {
    double sum, lost;
};

static void add(struct exact_sum *total, double term)
{
    const double sum = total->sum + term;
    total->lost += fabs(total->sum) >= fabs(term) ? (total->sum - sum) + term : (term - sum) + total->sum;
    total->sum = sum;
}

double gm_wave_energy(const struct gm_problem *problem, const double *y)
{
    const struct gm_grid1 *grid = &problem->line;
    const double *u = y, *o = y + grid->points, gap = y[2 * grid->points];
    struct exact_sum total = {0};
    for (size_t i = 0; i < grid->points; i++) {
        const double rate = (u[i] - o[i]) / gap;
        const double slope = (gm_grid1_value(grid, u, i, 1) - u[i]) * (gm_grid1_value(grid, o, i, 1) - o[i]) /
                             (grid->dx * grid->dx);
        add(&total, (rate * rate + slope) / 2 + (gm_field_of(problem)->wave->potential(problem, u[i]) +
                                                 gm_field_of(problem)->wave->potential(problem, o[i])) /
                                                    2);
    }
    return grid->dx * (total.sum + total.lost);
}

double gm_wave_cell_energy(const struct gm_problem *problem, const double *y)
{
    const struct gm_grid1 *grid = &problem->line;
    const double *u = y, *o = y + grid->points, gap = y[2 * grid->points];
    double sum = 0;
    for (size_t i = 0; i < grid->points; i++) {
        const double u_next = gm_grid1_value(grid, u, i, 1), o_next = gm_grid1_value(grid, o, i, 1);
        const double rate = (u[i] + u_next - o[i] - o_next) / (2 * gap);
        const double slope = (u_next - u[i] + o_next - o[i]) / (2 * grid->dx);
        sum += (rate * rate + slope * slope) / 2 +
               gm_field_of(problem)->wave->potential(problem, (u[i] + u_next + o[i] + o_next) / 4);
    }
    return grid->dx * sum;
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

double gm_wave_own_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y,
                          const double *memory)
{
    if (scheme->family->wave_energy) {
        return memory ? scheme->family->wave_energy(problem, scheme, y, memory) : NAN;
    }
    return scheme->in_cells ? gm_wave_cell_energy(problem, y) : gm_wave_energy(problem, y);
}

double gm_wave_momentum(const struct gm_problem *problem, const double *y)
{
    const struct gm_grid1 *grid = &problem->line;
    const double *u = y, *o = y + grid->points, gap = y[2 * grid->points];
    double sum = 0;
    for (size_t i = 0; i < grid->points; i++) {
        /* gap is the other time minus the current one */
        sum += (o[i] - u[i]) / gap *
               (gm_grid1_value(grid, u, i, 1) - gm_grid1_value(grid, u, i, -1) +
                gm_grid1_value(grid, o, i, 1) - gm_grid1_value(grid, o, i, -1)) /
               4;
    }
    return -sum;
}

/* u_tt - d2 u + [V(a) - V(b)] / (a - b): what multiplies u_t in the law of energy, u_x in that of momentum */
static double node_law(const struct gm_problem *problem, const struct gm_levels *levels, double dt, size_t i,
                       double a, double b)
{
    return (levels->next[i] - 2 * levels->now[i] + levels->past[i]) / (dt * dt) -
           d2(&problem->line, levels->now, i) + gm_field_of(problem)->wave->quotient(problem, a, b);
}

/* The law of the nodes that is measured, and its residual at each node. */
struct node_laws {
    enum gm_local_law law;
    double *residual;
};

static double cell_law(const struct gm_problem *problem, double a, double b, double step)
{
    const struct gm_wave *wave = gm_field_of(problem)->wave;
    const double middle = (a + b) / 2;
    double slope;
    wave->slopes(problem, &middle, &slope, 1);
    return (b - a) / step * (wave->quotient(problem, a, b) - slope);
}

static void cell_laws(const struct gm_problem *problem, double dt, const double *y, enum gm_local_law law,
                      double *residual)
{
    const struct gm_grid1 *grid = &problem->line;
    const double *u = y, *o = y + grid->points;
    for (size_t i = 0; i < grid->points; i++) {
        if (law == GM_LAW_OF_ENERGY) {
            const double a = (o[i] + gm_grid1_value(grid, o, i, 1)) / 2,
                         b = (u[i] + gm_grid1_value(grid, u, i, 1)) / 2;
            residual[i] = cell_law(problem, a, b, dt);
        } else {
            const double a = (o[i] + u[i]) / 2,
                         b = (gm_grid1_value(grid, o, i, 1) + gm_grid1_value(grid, u, i, 1)) / 2;
            residual[i] = cell_law(problem, a, b, grid->dx);
        }
    }
}

static void node_laws(const struct gm_law *of, void *data)
{
    const struct gm_problem *problem = of->problem;
    const struct gm_grid1 *grid = &problem->line;
    const struct gm_levels levels = gm_levels_of(of);
    const struct node_laws *laws = data;
    for (size_t i = 0; i < grid->points; i++) {
        if (laws->law == GM_LAW_OF_ENERGY) {
            const double rate = (levels.next[i] - levels.past[i]) / (2 * of->dt);
            laws->residual[i] = rate * node_law(problem, &levels, of->dt, i, levels.next[i], levels.past[i]);
        } else {
            const double a = gm_grid1_value(grid, levels.now, i, 1),
                         b = gm_grid1_value(grid, levels.now, i, -1);
            laws->residual[i] = (a - b) / (2 * grid->dx) * node_law(problem, &levels, of->dt, i, a, b);
        }
    }
}

bool gm_wave_laws(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                  const double *y, enum gm_local_law law, double *residual)
{
    const enum gm_wave_law kind = law_of(scheme);
    struct gm_law of = {problem, scheme, dt, y, NULL, .by_differences = false};
    struct node_laws nodes = {law, residual};
    if (kind == GM_LAW_CELLS) {
        cell_laws(problem, dt, y, law, residual);
    }
    return kind == GM_LAW_CELLS || (kind == GM_LAW_NODES && gm_law_measure(&of, node_laws, &nodes));
}
