/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/wave_laws.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/families/two_step.h"

static const struct gm_two_step_row *row_of(const struct gm_scheme *scheme)
{
    return scheme->coefficients;
}

/* Node i + by of a level, around the ring. */
static double at(const struct gm_line *line, const double *level, size_t i, int by)
{
    if (by > 0 && i + 1 == line->points) {
        return level[0] + line->jump;
    }
    if (by < 0 && i == 0) {
        return level[line->points - 1] - line->jump;
    }
    return by > 0 ? level[i + 1] : by < 0 ? level[i - 1] : level[i];
}

static double d2(const struct gm_line *line, const double *level, size_t i)
{
    return (at(line, level, i, 1) - 2 * level[i] + at(line, level, i, -1)) / (line->dx * line->dx);
}

double gm_wave_energy(const struct gm_problem *problem, const double *y)
{
    const struct gm_line *line = &problem->line;
    const double *u = y, *o = y + line->points, gap = y[2 * line->points];
    const double zero = problem->wave->potential(0);
    double sum = 0;
    for (size_t i = 0; i < line->points; i++) {
        const double rate = (u[i] - o[i]) / gap;
        const double slope = (at(line, u, i, 1) - u[i]) * (at(line, o, i, 1) - o[i]) / (line->dx * line->dx);
        sum += (rate * rate + slope) / 2 +
               (problem->wave->potential(u[i]) - zero + problem->wave->potential(o[i]) - zero) / 2;
    }
    return line->dx * sum;
}

double gm_wave_cell_energy(const struct gm_problem *problem, const double *y)
{
    const struct gm_line *line = &problem->line;
    const double *u = y, *o = y + line->points, gap = y[2 * line->points];
    const double zero = problem->wave->potential(0);
    double sum = 0;
    for (size_t i = 0; i < line->points; i++) {
        const double u_next = at(line, u, i, 1), o_next = at(line, o, i, 1);
        const double rate = (u[i] + u_next - o[i] - o_next) / (2 * gap);
        const double slope = (u_next - u[i] + o_next - o[i]) / (2 * line->dx);
        sum += (rate * rate + slope * slope) / 2 +
               (problem->wave->potential((u[i] + u_next + o[i] + o_next) / 4) - zero);
    }
    return line->dx * sum;
}

double gm_wave_own_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *y)
{
    return row_of(scheme)->law == GM_LAW_CELLS ? gm_wave_cell_energy(problem, y) : gm_wave_energy(problem, y);
}

double gm_wave_momentum(const struct gm_problem *problem, const double *y)
{
    const struct gm_line *line = &problem->line;
    const double *u = y, *o = y + line->points, gap = y[2 * line->points];
    double sum = 0;
    for (size_t i = 0; i < line->points; i++) {
        /* gap is the other time minus the present one */
        sum += (o[i] - u[i]) / gap *
               (at(line, u, i, 1) - at(line, u, i, -1) + at(line, o, i, 1) - at(line, o, i, -1)) / 4;
    }
    return -sum;
}

/* Three levels around the last but one: past, middle, next. */
struct levels {
    double *memory;
    const double *past, *now, *next;
};

static void levels_close(struct levels *levels)
{
    free(levels->memory);
}

static bool levels_open(struct levels *levels, const struct gm_problem *problem,
                        const struct gm_scheme *scheme, double dt, const double *y)
{
    const size_t points = problem->line.points, size = gm_wave_size(points);
    const bool at_start = y[2 * points] != -dt;
    levels->memory = malloc(size * sizeof(double));
    void *work = gm_two_step_open(problem, scheme);
    if (!levels->memory || !work) {
        free(levels->memory);
        if (work) {
            gm_two_step_close(work);
        }
        return false;
    }
    const struct gm_task task = {
        .problem = problem,
        .scheme = scheme,
        .dt = dt,
        .steps = at_start ? 2 : 1,
        .limit = INFINITY,
        .y = y,
        .out = levels->memory,
        .workspace = work,
    };
    const struct gm_progress progress = scheme->family->loop(&task);
    gm_two_step_close(work);
    levels->next = levels->memory;
    levels->now = levels->memory + points;
    levels->past = at_start ? y : y + points;
    if (progress.status != GM_OK) {
        free(levels->memory);
        return false;
    }
    return true;
}

/* u_tt - d2 u + [V(a) - V(b)] / (a - b): what multiplies u_t in the law of energy, u_x in that of momentum */
static double node_law(const struct gm_problem *problem, const struct levels *levels, double dt, size_t i,
                       double a, double b)
{
    return (levels->next[i] - 2 * levels->now[i] + levels->past[i]) / (dt * dt) -
           d2(&problem->line, levels->now, i) + problem->wave->quotient(a, b);
}

static double cell_law(const struct gm_wave *wave, double a, double b, double step)
{
    return (b - a) / step * (wave->quotient(a, b) - wave->slope((a + b) / 2));
}

double gm_wave_energy_residual(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                               const double *y)
{
    if (row_of(scheme)->law == GM_LAW_NONE) {
        return NAN;
    }
    const struct gm_line *line = &problem->line;
    double largest = 0;
    if (row_of(scheme)->law == GM_LAW_CELLS) {
        const double *u = y, *o = y + line->points;
        for (size_t i = 0; i < line->points; i++) {
            const double a = (o[i] + at(line, o, i, 1)) / 2, b = (u[i] + at(line, u, i, 1)) / 2;
            largest = fmax(largest, fabs(cell_law(problem->wave, a, b, dt)));
        }
        return largest;
    }
    struct levels levels;
    if (!levels_open(&levels, problem, scheme, dt, y)) {
        return NAN;
    }
    for (size_t i = 0; i < line->points; i++) {
        const double rate = (levels.next[i] - levels.past[i]) / (2 * dt);
        const double law = node_law(problem, &levels, dt, i, levels.next[i], levels.past[i]);
        largest = fmax(largest, fabs(rate * law));
    }
    levels_close(&levels);
    return largest;
}

double gm_wave_momentum_residual(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                                 const double *y)
{
    if (row_of(scheme)->law == GM_LAW_NONE) {
        return NAN;
    }
    const struct gm_line *line = &problem->line;
    double largest = 0;
    if (row_of(scheme)->law == GM_LAW_CELLS) {
        const double *u = y, *o = y + line->points;
        for (size_t i = 0; i < line->points; i++) {
            const double a = (o[i] + u[i]) / 2, b = (at(line, o, i, 1) + at(line, u, i, 1)) / 2;
            largest = fmax(largest, fabs(cell_law(problem->wave, a, b, line->dx)));
        }
        return largest;
    }
    struct levels levels;
    if (!levels_open(&levels, problem, scheme, dt, y)) {
        return NAN;
    }
    for (size_t i = 0; i < line->points; i++) {
        const double a = at(line, levels.now, i, 1), b = at(line, levels.now, i, -1);
        largest = fmax(largest, fabs((a - b) / (2 * line->dx) * node_law(problem, &levels, dt, i, a, b)));
    }
    levels_close(&levels);
    return largest;
}

/* A tangent vector at three levels. */
struct tangent {
    double *past, *now, *next;
};

static void tangent_start(const struct tangent *tangent, size_t points, double waves, double phase)
{
    for (size_t i = 0; i < points; i++) {
        const double angle = 2 * M_PI * waves * (double)i / (double)points;
        tangent->past[i] = cos(angle + phase);
        tangent->now[i] = sin(angle + 2 * phase);
    }
}

/* The tangent at the next level by the linearised scheme of nodes. */
static void tangent_nodes(const struct gm_problem *problem, const struct levels *levels, bool average,
                          double dt, const struct tangent *a)
{
    const struct gm_wave *wave = problem->wave;
    const struct gm_line ring = {problem->line.points, problem->line.dx, 0, 0};
    for (size_t i = 0; i < ring.points; i++) {
        const double free_motion = 2 * a->now[i] + dt * dt * d2(&ring, a->now, i);
        if (average) {
            const double in_next = wave->quotient_slope(levels->next[i], levels->past[i]);
            const double in_past = wave->quotient_slope(levels->past[i], levels->next[i]);
            a->next[i] = (free_motion - (1 + dt * dt * in_past) * a->past[i]) / (1 + dt * dt * in_next);
        } else {
            a->next[i] = free_motion - a->past[i] - dt * dt * wave->curvature(levels->now[i]) * a->now[i];
        }
    }
}

static double form_of_nodes(const struct gm_problem *problem, double dt, const struct tangent *a,
                            const struct tangent *b)
{
    const struct gm_line ring = {problem->line.points, problem->line.dx, 0, 0};
    double largest = 0;
    for (size_t i = 0; i < ring.points; i++) {
        const double later = a->now[i] * b->next[i] - a->next[i] * b->now[i];
        const double earlier = a->past[i] * b->now[i] - a->now[i] * b->past[i];
        const double right = a->now[i] * at(&ring, b->now, i, 1) - at(&ring, a->now, i, 1) * b->now[i];
        const double left = at(&ring, a->now, i, -1) * b->now[i] - a->now[i] * at(&ring, b->now, i, -1);
        largest = fmax(largest, fabs((later - earlier) / (dt * dt) - (right - left) / (ring.dx * ring.dx)));
    }
    return largest;
}

/* V'' in the cells between two levels. */
static void cell_curvatures(const struct gm_problem *problem, const double *p, const double *q,
                            double *curvature)
{
    const struct gm_line *line = &problem->line;
    for (size_t i = 0; i < line->points; i++) {
        curvature[i] = problem->wave->curvature((p[i] + at(line, p, i, 1) + q[i] + at(line, q, i, 1)) / 4);
    }
}

/* dL/du at a corner of a cell, linearised along a; L = (D_t A_x u)^2/2 - (D_x A_t u)^2/2 - V(A_t A_x u).
   `before` and `after` are the values of a at the cell's four corners. */
static double corner(double before_left, double before_right, double after_left, double after_right,
                     double curvature, double dt, double dx, bool after, bool right)
{
    const double rate = (after_left + after_right - before_left - before_right) / (2 * dt);
    const double slope = (after_right + before_right - after_left - before_left) / (2 * dx);
    const double mean = (after_left + after_right + before_left + before_right) / 4;
    return (after ? rate : -rate) / (2 * dt) - (right ? slope : -slope) / (2 * dx) - curvature * mean / 4;
}

/* The four corners that meet in node i: the linearised scheme at this node. */
static double cells_at_node(const struct gm_line *ring, const struct tangent *a, const double *earlier,
                            const double *later, double dt, size_t i)
{
    const size_t left = i ? i - 1 : ring->points - 1, right = i + 1 < ring->points ? i + 1 : 0;
    const double *p = a->past, *n = a->now, *f = a->next;
    return corner(p[i], p[right], n[i], n[right], earlier[i], dt, ring->dx, true, false) +
           corner(p[left], p[i], n[left], n[i], earlier[left], dt, ring->dx, true, true) +
           corner(n[i], n[right], f[i], f[right], later[i], dt, ring->dx, false, false) +
           corner(n[left], n[i], f[left], f[i], later[left], dt, ring->dx, false, true);
}

/* The next level of a tangent so that the sum at every node vanishes: iterated with the circulant part. */
static bool tangent_cells(const struct gm_problem *problem, const double *earlier, const double *later,
                          double dt, const struct tangent *a, double *residual)
{
    enum { MOST = 200 };
    const struct gm_line ring = {problem->line.points, problem->line.dx, 0, 0};
    const double in_time = 1 / (4 * dt * dt), in_space = 1 / (4 * ring.dx * ring.dx);
    const struct gm_ring solver = gm_ring_make(ring.points, 2 * (in_time + in_space), in_time - in_space);
    double last = INFINITY;
    for (size_t i = 0; i < ring.points; i++) {
        a->next[i] = 2 * a->now[i] - a->past[i];
    }
    for (int k = 0; k < MOST; k++) {
        double largest = 0;
        for (size_t i = 0; i < ring.points; i++) {
            residual[i] = cells_at_node(&ring, a, earlier, later, dt, i);
        }
        gm_ring_solve(&solver, residual);
        for (size_t i = 0; i < ring.points; i++) {
            a->next[i] += residual[i];
            largest = fmax(largest, fabs(residual[i]));
        }
        if (largest >= last && largest < 1e-11) {
            return true;
        }
        last = largest;
    }
    return false;
}

/* Fluxes of the form through the corners of every cell add up to nothing in the cell; at a node they must
 * too. */
static double form_of_cells(const struct gm_problem *problem, const double *earlier, const double *later,
                            double dt, const struct tangent *a, const struct tangent *b)
{
    const struct gm_line ring = {problem->line.points, problem->line.dx, 0, 0};
    double largest = 0;
    for (size_t i = 0; i < ring.points; i++) {
        largest = fmax(largest, fabs(a->now[i] * cells_at_node(&ring, b, earlier, later, dt, i) -
                                     b->now[i] * cells_at_node(&ring, a, earlier, later, dt, i)));
    }
    return largest;
}

/* The next level of a tangent by central differences of the scheme's step at four distances, extrapolated. */
static bool tangent_by_differences(const struct gm_problem *problem, const struct gm_scheme *scheme,
                                   double dt, const struct levels *levels, const struct tangent *a)
{
    enum { DISTANCES = 4 };
    const size_t points = problem->line.points, size = gm_wave_size(points);
    double *memory = malloc((2 * size + DISTANCES * points) * sizeof *memory);
    void *work = gm_two_step_open(problem, scheme);
    bool good = memory && work;
    double *y = memory, *out = memory + size, *table = out + size;
    struct gm_task task = {.problem = problem,
                           .scheme = scheme,
                           .dt = dt,
                           .steps = 1,
                           .limit = INFINITY,
                           .y = y,
                           .out = out,
                           .workspace = work};
    for (int k = 0; good && k < DISTANCES; k++) {
        const double distance = ldexp(0.05, -k);
        double *slope = table + (size_t)k * points;
        for (int side = 1; good && side >= -1; side -= 2) {
            for (size_t i = 0; i < points; i++) {
                y[i] = levels->now[i] + side * distance * a->now[i];
                y[points + i] = levels->past[i] + side * distance * a->past[i];
            }
            y[2 * points] = -dt;
            good = scheme->family->loop(&task).status == GM_OK;
            for (size_t i = 0; i < points; i++) {
                slope[i] = (side > 0 ? 0 : slope[i]) + side * out[i] / (2 * distance);
            }
        }
    }
    double power = 4;
    for (int done = 1; good && done < DISTANCES; done++, power *= 4) {
        for (int k = DISTANCES - 1; k >= done; k--) {
            for (size_t i = 0; i < points; i++) {
                double *fine = &table[(size_t)k * points + i];
                *fine += (*fine - table[(size_t)(k - 1) * points + i]) / (power - 1);
            }
        }
    }
    if (good) {
        memcpy(a->next, table + (DISTANCES - 1) * points, points * sizeof *a->next);
    }
    if (work) {
        gm_two_step_close(work);
    }
    free(memory);
    return good;
}

static double form_residual(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                            const double *y, bool by_differences)
{
    const size_t points = problem->line.points;
    const struct gm_two_step_row *row = row_of(scheme);
    if (row->law == GM_LAW_NONE) {
        return NAN;
    }
    struct levels levels;
    double *memory = calloc(9 * points, sizeof *memory);
    if (!memory || !levels_open(&levels, problem, scheme, dt, y)) {
        free(memory);
        return NAN;
    }
    const struct tangent a = {memory, memory + points, memory + 2 * points};
    const struct tangent b = {memory + 3 * points, memory + 4 * points, memory + 5 * points};
    double *earlier = memory + 6 * points, *later = memory + 7 * points, *scratch = memory + 8 * points;
    tangent_start(&a, points, 2, 0.3);
    tangent_start(&b, points, 3, 0.7);
    double residual = NAN;
    const bool nodes = row->law == GM_LAW_NODES;
    cell_curvatures(problem, levels.past, levels.now, earlier);
    cell_curvatures(problem, levels.now, levels.next, later);
    bool good = true;
    if (by_differences) {
        good = tangent_by_differences(problem, scheme, dt, &levels, &a) &&
               tangent_by_differences(problem, scheme, dt, &levels, &b);
    } else if (nodes) {
        tangent_nodes(problem, &levels, row->average, dt, &a);
        tangent_nodes(problem, &levels, row->average, dt, &b);
    } else {
        good = tangent_cells(problem, earlier, later, dt, &a, scratch) &&
               tangent_cells(problem, earlier, later, dt, &b, scratch);
    }
    if (good) {
        residual =
            nodes ? form_of_nodes(problem, dt, &a, &b) : form_of_cells(problem, earlier, later, dt, &a, &b);
    }
    levels_close(&levels);
    free(memory);
    return residual;
}

double gm_wave_form_residual(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                             const double *y)
{
    return form_residual(problem, scheme, dt, y, false);
}

double gm_wave_form_defect(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                           const double *y)
{
    return form_residual(problem, scheme, dt, y, true);
}
