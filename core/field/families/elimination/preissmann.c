/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The box scheme of Preissmann: the implicit midpoint rule in time and in space for M s_t + K s_x = grad
   S(s),
       M D_t A_x s + K A_t D_x s = grad S(A_t A_x s),   A f = (f_i + f_{i+1})/2,   D f = (f_{i+1} - f_i)/dx
   with all but the field eliminated. For u_tt - u_xx + V'(u) = 0 nine points are left:
         [a u^{n+1} - 2 a u^n + a u^{n-1}] / dt^2
       - [d u^{n+1} + 2 d u^n + d u^{n-1}] / (4 dx^2)
       + 1/4 sum over the four cells around the node of V'(mean of the four corners) = 0
       a f = (f_{i+1} + 2 f_i + f_{i-1})/4,   d f = f_{i+1} - 2 f_i + f_{i-1}
   T.J. Bridges & S. Reich, Phys. Lett. A 284 (2001) 184. (The form printed in Razafindralandy et al. (2018)
   lacks the averages.) For equations of first order in time see families/dispersive/box.c.

   The linear part is circulant; it is inverted by two sweeps and the rest is iterated, which contracts by
   dt^2/4 max |V''|. If that is slow, Newton's method continues. The matrix of the equations of a step,
       A_x' (1/dt^2 + V''/4) A_x + D_x' D_x/4,
   is the Hessian of a minimum: with |V''| <= 1 there is one solution for dt <= 2, and at least
   one beyond. */
#include "core/field/families/dispersive/box.h"
#include "core/field/families/family.h"
#include "core/field/families/two_step.h"
#include "core/field/families/waves/form.h"
#include "core/linear/settled.h"

GM_CLONES static void cell_means(const double *restrict a, const double *restrict b, double *restrict cells,
                                 size_t count)
{
    for (size_t i = 0; i < count; i++) {
        cells[i] = ((a[i] + a[i + 1]) + (b[i] + b[i + 1])) / 4;
    }
}

GM_CLONES static void linear_part(const double *restrict past, const double *restrict now,
                                  const double *restrict force, double *restrict right, size_t points,
                                  double in_time, double in_space)
{
    for (size_t i = 1; i <= points; i++) {
        const double now_ends = now[i + 1] + now[i - 1], past_ends = past[i + 1] + past[i - 1];
        right[i] = in_time * (2 * (now_ends + 2 * now[i]) - (past_ends + 2 * past[i])) +
                   in_space * (2 * (now_ends - 2 * now[i]) + (past_ends - 2 * past[i])) -
                   (force[i - 1] + force[i]) / 4;
    }
}

GM_CLONES static void subtract_force(const double *restrict right, const double *restrict force,
                                     double *restrict out, size_t points)
{
    for (size_t i = 1; i <= points; i++) {
        out[i] = right[i] - (force[i - 1] + force[i]) / 4;
    }
}

GM_CLONES static double largest_change(const double *restrict a, const double *restrict b, size_t points)
{
    double largest[8] = {0};
    size_t i = 0;
    for (; i + 8 <= points; i += 8) {
        for (size_t l = 0; l < 8; l++) {
            const double change = fabs(a[i + l] - b[i + l]);
            largest[l] = change > largest[l] ? change : largest[l];
        }
    }
    for (; i < points; i++) {
        const double change = fabs(a[i] - b[i]);
        largest[0] = change > largest[0] ? change : largest[0];
    }
    for (size_t l = 1; l < 8; l++) {
        largest[0] = largest[l] > largest[0] ? largest[l] : largest[0];
    }
    return largest[0];
}

/* The equations of a step: F = C u + V' - right with the circulant C, the force of the cells around a node
   and the contribution of the past levels. */
struct equations {
    struct gm_two_step_work *work;
    const struct gm_problem *problem;
    const double *now;
    double diagonal, off; /* entries of C */
};

static void residual_at(void *context, const double *u, double *residual)
{
    const struct equations *equations = context;
    struct gm_two_step_work *work = equations->work;
    const size_t points = work->points;
    double *closed = work->guess;
    memcpy(closed, u, points * sizeof *u);
    gm_grid1_close(closed, points, equations->problem->line.jump);
    cell_means(equations->now - 1, closed - 1, work->cells - 1, points + 1);
    gm_field_of(equations->problem)
        ->wave->slopes(equations->problem, work->cells - 1, work->force - 1, points + 1);
    for (size_t i = 0; i < points; i++) {
        /* the right side holds the jumps */
        const double left = u[i ? i - 1 : points - 1], right = u[i + 1 < points ? i + 1 : 0];
        residual[i] = work->right[i] - ((work->force + i)[-1] + work->force[i]) / 4 -
                      (equations->diagonal * u[i] + equations->off * (left + right));
    }
}

static void jacobian(void *context, struct gm_ring_band *matrix)
{
    const struct equations *equations = context;
    const double *cells = equations->work->cells, off = equations->off;
    const struct gm_problem *problem = equations->problem;
    double (*const curvature)(const struct gm_problem *, double) = gm_field_of(problem)->wave->curvature;
    double before = curvature(problem, cells[-1]) / 16;
    for (size_t i = 0; i < equations->work->points; i++) {
        const double after = curvature(problem, cells[i]) / 16;
        gm_ring_band_add(matrix, i, 0, -1, 0, off + before);
        gm_ring_band_add(matrix, i, 0, 0, 0, equations->diagonal + before + after);
        gm_ring_band_add(matrix, i, 0, 1, 0, off + after);
        before = after;
    }
}

static enum gm_status box_step(struct gm_two_step_work *work, const struct gm_problem *problem, double dt,
                               struct gm_progress *progress)
{
    const double *past = work->level[0], *now = work->level[1];
    double *next = work->level[2];
    enum { MOST = 30 }; /* sweeps, at the cost of Newton's method, 5 solves: reached for dt > 1 */
    const size_t points = work->points;
    const double dx = problem->line.dx, jump = problem->line.jump;
    const double in_time = 1 / (4 * dt * dt), in_space = 1 / (4 * dx * dx);
    const double diagonal = 2 * (in_time + in_space), off = in_time - in_space;
    const struct gm_wave *wave = gm_field_of(problem)->wave;
    work->ring = gm_ring_make(points, diagonal, off);

    /* cell i lies between the nodes i and i + 1; the first is -1 */
    cell_means(past - 1, now - 1, work->cells - 1, points + 1);
    wave->slopes(problem, work->cells - 1, work->force - 1, points + 1);
    linear_part(past - 1, now - 1, work->force - 1, work->right - 1, points, in_time, in_space);
    work->right[0] += off * jump;
    work->right[points - 1] -= off * jump;
    progress->evaluations++;

    double *guess = work->guess;
    for (size_t i = 0; i < points; i++) {
        guess[i] = 2 * now[i] - past[i];
    }
    double last = INFINITY;
    for (int k = 0; k < MOST; k++) {
        gm_grid1_close(guess, points, jump);
        cell_means(now - 1, guess - 1, work->cells - 1, points + 1);
        wave->slopes(problem, work->cells - 1, work->force - 1, points + 1);
        subtract_force(work->right - 1, work->force - 1, next - 1, points);
        gm_ring_solve(&work->ring, next);
        progress->evaluations++;
        progress->iterations++;
        progress->solves++;
        const double change = largest_change(next, guess, points);
        if (!isfinite(change)) {
            return GM_BLOW_UP;
        }
        if (gm_is_settled_within(change, 1e-15, 1e-12, &last)) {
            return GM_OK;
        }
        for (size_t i = 0; i < points; i++) {
            guess[i] = next[i];
        }
    }
    struct equations self = {work, problem, now, diagonal, off};
    const struct gm_ring_equations equations = {&self, residual_at, jacobian};
    return gm_ring_newton_solve(&work->newton, &equations, next, progress);
}

static const struct gm_two_step_row row = {.step = box_step, .start = gm_wave_start, .law = GM_LAW_CELLS};

static bool is_wave(const struct gm_problem *problem)
{
    return gm_field_of(problem)->wave != NULL;
}

static struct gm_progress advance(const struct gm_task *task)
{
    return is_wave(task->problem) ? gm_two_step_advance(task) : gm_dispersive_advance(task);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    if (!is_wave(problem)) {
        return gm_dispersive_open(problem);
    }
    struct gm_two_step_work *work = gm_two_step_open(problem, scheme);
    if (work && !gm_ring_newton_open(&work->newton, work->points, 1, 1)) {
        free(work);
        return NULL;
    }
    return work;
}

static double form(const struct gm_law *law)
{
    return is_wave(law->problem) ? gm_wave_form(law) : gm_dispersive_form(law);
}

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_box_of_a_field, .family = &gm_family_preissmann, .needs = GM_NEEDS_FORM, .in_cells = true,
     .coefficients = &row},
};

const struct gm_family gm_family_preissmann = {
    .title = "multisymplectic box",
    GM_FIELD_FAMILY,
    .loop = advance,
    .workspace_open = workspace_open,
    .form = form,
    .workspace_close = gm_two_step_close, /* both kinds of work are closed alike */
};
