/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The box scheme, all but the field eliminated, for equations of first order in time,
       a A^p (f^{n+1} - f^n)/dt + b D^p (f^{n+1} + f^n)/2 + Q g(A (f^{n+1} + f^n)/2) = 0,
   A f = (f_i + f_{i+1})/2, D f = (f_{i+1} - f_i)/dx:
                               p   a   b    Q     g             points
       Korteweg-de Vries       3   1   mu   A D   eta u^2/2     8
       Schroedinger            2   i   1    A     |psi|^2 psi   6
   U. Ascher & R.I. McLachlan, Appl. Numer. Math. 48 (2004) 255; A.L. Islas, D.A. Karpeev & C.M. Schober,
   J. Comput. Phys. 173 (2001) 116. The linear part is circulant and inverted by recursions; the rest is
   iterated to round-off, and solved by Newton's method if that is slow or diverges. */
#include "core/field/families/dispersive/box.h"

#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/field/families/two_step.h"
#include "core/functions/functions.h"
#include "core/linear/settled.h"

/* Arrays of real parts, each followed by its imaginary parts, after the workspace. */
static double *array(const struct gm_two_step_work *work, size_t which)
{
    return (double *)(void *)(work + 1) + 2 * which * work->points;
}

enum { NOW, NEXT, RIGHT, MEAN, FORCE, GUESS, SLOPES, ARRAYS = SLOPES + 2 };

/* 1 of a real field, 2 of a complex one */
static size_t parts_of(const struct gm_problem *problem)
{
    return gm_field_of(problem)->form->kept;
}

void *gm_dispersive_open(const struct gm_problem *problem)
{
    const struct gm_dispersive *equation = gm_field_of(problem)->dispersive;
    const size_t points = problem->line.points;
    struct gm_two_step_work *work = calloc(1, sizeof *work + 2 * ARRAYS * points * sizeof(double));
    /* The equation of node i, which reaches from i to i + power, is row i + 1: so the band has equally much
       on both sides, or one point more on the right. */
    if (!work ||
        !gm_ring_newton_open(&work->newton, points, parts_of(problem), (size_t)equation->power - 1)) {
        free(work);
        return NULL;
    }
    work->points = points;
    return work;
}

/* binomial(p, k) sign^(p - k) */
static double power_weight(int power, int k, double sign)
{
    static const double binomial[4][4] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}};
    return binomial[power][k] * ((power - k) % 2 ? sign : 1);
}

/* out += (c0 + i c1) sum_k binomial(p, k) sign^(p - k) f_{i+k}, around the ring */
static void add_power(double *out, const double *f, size_t points, int power, double sign, double c0,
                      double c1)
{
    double weight[4];
    for (int k = 0; k <= power; k++) {
        weight[k] = power_weight(power, k, sign);
    }
    for (size_t i = 0; i < points; i++) {
        double re = 0, im = 0;
        size_t at = i;
        for (int k = 0; k <= power; k++) {
            re += weight[k] * f[at];
            im += weight[k] * f[points + at];
            at = at + 1 < points ? at + 1 : 0;
        }
        out[i] += c0 * re - c1 * im;
        out[points + i] += c0 * im + c1 * re;
    }
}

/* The equations of a step, or of one of the linearised scheme: a A^p f/dt + b D^p f/2 + Q g = right. */
struct equations {
    const struct gm_two_step_work *work;
    const struct gm_problem *problem;
    double mean[2], difference; /* a/(2^p dt), real and imaginary part, and b/(2 dx^p) */
};

static struct equations equations_of(const struct gm_two_step_work *work, const struct gm_problem *problem,
                                     double dt)
{
    const struct gm_dispersive *equation = gm_field_of(problem)->dispersive;
    const double half = gm_pow(0.5, equation->power) / dt;
    return (struct equations){
        .work = work,
        .problem = problem,
        .mean = {half * equation->factor[0], half * equation->factor[1]},
        .difference = equation->dispersion(problem) / (2 * gm_pow(problem->line.dx, equation->power)),
    };
}

/* MEAN := RIGHT - Q g at the means of NOW and `next`, which overwrites FORCE. */
static void explicit_part(const struct equations *equations, const double *next)
{
    const struct gm_two_step_work *work = equations->work;
    const struct gm_problem *problem = equations->problem;
    const size_t points = work->points;
    double *mean = array(work, MEAN), *force = array(work, FORCE);
    memset(mean, 0, 2 * points * sizeof *mean);
    add_power(mean, array(work, NOW), points, 1, 1, 0.25, 0);
    add_power(mean, next, points, 1, 1, 0.25, 0);
    gm_field_of(problem)->dispersive->nonlinear(problem, mean, mean + points, force, force + points, points);
    memcpy(mean, array(work, RIGHT), 2 * points * sizeof *mean);
    if (gm_field_of(problem)->dispersive->derivative) {
        /* A D: (f_{i+2} - f_i) / (2 dx) */
        const double over = -0.5 / problem->line.dx;
        add_power(mean, force, points, 2, 1, over, 0);
        add_power(mean, force, points, 1, 1, -2 * over, 0);
    } else {
        add_power(mean, force, points, 1, 1, -0.5, 0);
    }
}

/* gm_ring_equations: row i + 1 is the equation of node i, and of a real field there is no imaginary part. */
static void residual_at(void *context, const double *u, double *residual)
{
    const struct equations *equations = context;
    const struct gm_two_step_work *work = equations->work;
    const struct gm_dispersive *equation = gm_field_of(equations->problem)->dispersive;
    const size_t points = work->points, parts = parts_of(equations->problem);
    double *next = array(work, NEXT), *rest = array(work, MEAN);
    memcpy(next, u, parts * points * sizeof *u);
    memset(next + parts * points, 0, (2 - parts) * points * sizeof *u);
    explicit_part(equations, next);
    add_power(rest, next, points, equation->power, 1, -equations->mean[0], -equations->mean[1]);
    add_power(rest, next, points, equation->power, -1, -equations->difference, 0);
    for (size_t part = 0; part < parts; part++) {
        memcpy(residual + part * points + 1, rest + part * points, (points - 1) * sizeof *residual);
        residual[part * points] = rest[part * points + points - 1];
    }
}

/* Adds `weight` times the derivative of g in cell i + k, slopes[column][part * points + cell], to row i + 1:
   g depends on the mean of both ends of a cell, half of which is at the next level. */
static void add_slope(const struct equations *equations, struct gm_ring_band *matrix, size_t i, size_t k,
                      double weight, double *const slopes[2])
{
    const size_t points = equations->work->points, parts = parts_of(equations->problem);
    const size_t cell = (i + k) % points, row = i + 1 < points ? i + 1 : 0;
    for (size_t part = 0; part < parts; part++) {
        for (size_t column = 0; column < parts; column++) {
            const double entry = weight / 4 * slopes[column][part * points + cell];
            gm_ring_band_add(matrix, row, part, (long)k - 1, column, entry);
            gm_ring_band_add(matrix, row, part, (long)k, column, entry);
        }
    }
}

static void jacobian(void *context, struct gm_ring_band *matrix)
{
    const struct equations *equations = context;
    const struct gm_two_step_work *work = equations->work;
    const struct gm_problem *problem = equations->problem;
    const struct gm_dispersive *equation = gm_field_of(problem)->dispersive;
    const size_t points = work->points, parts = parts_of(problem);
    const int p = equation->power;
    const struct gm_form *form = gm_field_of(problem)->form;
    double *at = array(work, MEAN), *const slopes[2] = {array(work, SLOPES), array(work, SLOPES + 1)};
    memset(at, 0, 2 * points * sizeof *at);
    add_power(at, array(work, NOW), points, 1, 1, 0.25, 0);
    add_power(at, array(work, NEXT), points, 1, 1, 0.25, 0);
    for (size_t i = 0; i < points; i++) {
        double s[GM_LARGEST_FORM] = {0}, hessian[GM_LARGEST_FORM * GM_LARGEST_FORM];
        for (size_t part = 0; part < parts; part++) {
            s[form->first + part] = at[part * points + i];
        }
        form->hessians(problem->parameters, s, hessian, 1);
        for (size_t part = 0; part < parts * parts; part++) {
            slopes[part % parts][part / parts * points + i] =
                hessian[(form->first + part / parts) * form->dimension + form->first + part % parts];
        }
    }
    for (size_t i = 0; i < points; i++) {
        const size_t row = i + 1 < points ? i + 1 : 0;
        for (int k = 0; k <= p; k++) {
            const double re =
                power_weight(p, k, 1) * equations->mean[0] + power_weight(p, k, -1) * equations->difference;
            const double im = power_weight(p, k, 1) * equations->mean[1];
            for (size_t part = 0; part < parts; part++) {
                gm_ring_band_add(matrix, row, part, k - 1, part, re);
                if (parts == 2) {
                    gm_ring_band_add(matrix, row, part, k - 1, 1 - part, part == 0 ? -im : im);
                }
            }
        }
        if (equation->derivative) {
            const double over = 0.5 / problem->line.dx;
            add_slope(equations, matrix, i, 2, over, slopes);
            add_slope(equations, matrix, i, 0, -over, slopes);
        } else {
            add_slope(equations, matrix, i, 0, 0.5, slopes);
            add_slope(equations, matrix, i, 1, 0.5, slopes);
        }
    }
}

/* One step from NOW to NEXT. */
static enum gm_status make_step(struct gm_two_step_work *work, const struct gm_problem *problem,
                                const struct gm_ring_roots *ring, double dt, struct gm_progress *progress)
{
    enum { MOST = 40 }; /* Newton's method costs about 25 of them for a real field, 80 for a complex one */
    const struct gm_dispersive *equation = gm_field_of(problem)->dispersive;
    const size_t points = work->points, count = 2 * points;
    const int p = equation->power;
    struct equations self = equations_of(work, problem, dt);
    double *now = array(work, NOW), *next = array(work, NEXT), *right = array(work, RIGHT);
    double *mean = array(work, MEAN);
    memset(right, 0, count * sizeof *right);
    add_power(right, now, points, p, 1, self.mean[0], self.mean[1]);
    add_power(right, now, points, p, -1, -self.difference, 0);
    memcpy(next, now, count * sizeof *next);
    double last = INFINITY;
    for (int k = 0; k < MOST; k++) {
        explicit_part(&self, next);
        gm_ring_roots_solve(ring, mean, mean + points, array(work, FORCE));
        double change = 0, largest = 0;
        for (size_t i = 0; i < count; i++) {
            const double size = fabs(mean[i] - next[i]);
            change = size > change || isnan(size) ? size : change;
            largest = fmax(largest, fabs(mean[i]));
        }
        progress->evaluations++;
        progress->solves++;
        progress->iterations++;
        const bool grows = change >= last, settled = gm_is_settled_within(change, 1e-16 * largest,
                                                                          1e-12 * fmax(largest, 1e-3), &last);
        if (!isfinite(change) || (grows && !settled)) {
            memcpy(next, now, count * sizeof *next); /* the iteration diverges, not the solution */
            break;
        }
        memcpy(next, mean, count * sizeof *next);
        if (settled) {
            return GM_OK;
        }
    }
    const size_t size = parts_of(problem) * points * sizeof *next;
    const struct gm_ring_equations equations = {&self, residual_at, jacobian};
    double *guess = array(work, GUESS);
    memcpy(guess, next, size);
    const enum gm_status status = gm_ring_newton_solve(&work->newton, &equations, guess, progress);
    memset(next, 0, count * sizeof *next);
    memcpy(next, guess, size);
    return status;
}

/* The circulant part of the scheme. */
static bool make_ring(struct gm_ring_roots *ring, const struct gm_problem *problem, double dt)
{
    const struct gm_dispersive *equation = gm_field_of(problem)->dispersive;
    return gm_ring_roots_make(ring, problem->line.points, equation->power,
                              (equation->factor[0] + I * equation->factor[1]) / dt,
                              equation->dispersion(problem) / 2, problem->line.dx);
}

struct gm_progress gm_dispersive_advance(const struct gm_task *task)
{
    struct gm_two_step_work *work = task->workspace;
    const size_t points = work->points, size = points * sizeof(double), parts = parts_of(task->problem);
    struct gm_progress progress = {.status = GM_OK};
    double *now = array(work, NOW), *next = array(work, NEXT);
    struct gm_ring_roots ring;
    if (!make_ring(&ring, task->problem, task->dt)) {
        progress.status = GM_NO_CONVERGENCE;
        return progress;
    }
    memset(next, 0, 2 * size);
    memcpy(next, task->y, parts * size);
    for (int64_t k = 0; k < task->steps; k++) {
        memcpy(now, next, 2 * size);
        progress.status = make_step(work, task->problem, &ring, task->dt, &progress);
        memset(next + parts * points, 0, (2 - parts) * size); /* of a real field it is rounding */
        if (!gm_field_stepped(task, &progress, next, 2 * points)) {
            return progress;
        }
    }
    if (parts == 2) {
        memcpy(task->out, next, 2 * size);
    } else {
        gm_wave_write(task, next, now);
    }
    return progress;
}

/* ---- its laws ---- */

/* A solution, real parts and then imaginary ones: the level of the state, the next, and the means in the cells between. */
struct base {
    double *now, *next, *cells;
};

static struct base base_of(const struct gm_law *law)
{
    const size_t points = law->problem->line.points, size = 2 * points,
                 field = parts_of(law->problem) * points * sizeof(double);
    double *now = gm_arena_take(law->arena, 3 * size + law->problem->n, sizeof *now), *after = now + 3 * size;
    const struct base base = {now, now + size, now + 2 * size};
    if (!gm_law_step(law, 1, law->y, NULL, after, NULL)) {
        gm_arena_leave(law->arena);
    }
    memcpy(now, law->y, field);
    memcpy(base.next, after, field);
    add_power(base.cells, now, points, 1, 1, 0.25, 0);
    add_power(base.cells, base.next, points, 1, 1, 0.25, 0);
    return base;
}

static void advance_tangents(const struct gm_law *law, struct gm_faces faces[2])
{
    const size_t points = law->problem->line.points, field = parts_of(law->problem) * points;
    const struct base base = base_of(law);
    double *now = gm_arena_take(law->arena, 4 * points + 2, sizeof *now), *next = now + 2 * points + 1;
    struct gm_box_tangents *box = gm_box_linearise(law, base.cells);
    for (size_t k = 0; k < 2; k++) {
        for (size_t at = 0; at < field; at += points) {
            gm_tangent_start(now + at, points, 2 + (double)k, 0.3 + 0.4 * (double)k + (double)(at / points));
        }
        if (law->by_differences) {
            gm_law_differentiate(law, law->y, NULL, now, next);
        }
        gm_box_advance_tangent(box, law->dt, now, law->by_differences ? next : NULL, &faces[k]);
    }
}

double gm_dispersive_form(const struct gm_law *law)
{
    static const double one = 1;
    const struct gm_lattice cells = {law->problem->line.points, 1,      1, &one, &one,
                                     law->problem->line.dx,     law->dt};
    return gm_lattice_law(law, &cells, advance_tangents);
}

void gm_dispersive_content(const struct gm_law *law, void *residual)
{
    const struct base base = base_of(law);
    gm_field_of(law->problem)
        ->dispersive->content(law->problem, law->dt, base.cells, base.now, base.next,
                              gm_arena_take(law->arena, law->problem->line.points, sizeof(double)), residual);
}
