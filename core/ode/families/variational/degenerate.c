/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The variational midpoint rule of a Lagrangian that is linear in the velocities, L = theta(q) . q' - H(q), projected
   symmetrically to its momenta p = theta(q), with the factor -1. Without p it is, with z = q_1 - q_0 and
   m = (q_0 + q_1)/2 + lambda,
       theta(q_1) - theta(q_0) + (theta'(q_1) - theta'(q_0))^T lambda = theta'(m)^T z - h grad H(m)
       theta(q_0) + theta(q_1) + (theta'(q_0) + theta'(q_1))^T lambda = 2 theta(m)
   for z and lambda. Where half of theta is 0 it is the midpoint rule in canonical coordinates, and symplectic. With
   the factor +1 it would be unstable. M. Kraus, arXiv:1708.07356 (2017) */
#include "core/ode/families/family.h"
#include "core/ode/kernel/tiles.h"

/* theta and H, their slopes by rows, and the second derivatives of their weighted sum, at one place. */
struct place {
    double *values, *slopes, *curvature;
};

struct step {
    const struct gm_problem *problem;
    struct gm_progress *progress;
    size_t n;
    double h;
    const double *y;
    double *at, *weights; /* n, n + 1 */
    struct place start, end, middle;
};

static size_t place_size(size_t n)
{
    return (n + 1) * (n + 1) + n * n;
}

static struct place lay(size_t n, double **memory)
{
    const struct place place = {*memory, *memory + n + 1, *memory + (n + 1) * (n + 1)};
    *memory += place_size(n);
    return place;
}

static void evaluate(const struct step *step, const struct place *place)
{
    gm_ode_of(step->problem)
        ->degenerate->functions(step->problem, step->at, step->weights, place->values, place->slopes,
                                place->curvature);
}

static void evaluate_all(const struct step *step, const double *z, const double *lambda)
{
    const size_t n = step->n;
    for (size_t i = 0; i < n; i++) {
        step->at[i] = step->y[i] + z[i];
        step->weights[i] = lambda[i];
    }
    step->weights[n] = 0;
    evaluate(step, &step->end);
    for (size_t i = 0; i < n; i++) {
        step->at[i] = step->y[i] + z[i] / 2 + lambda[i];
        step->weights[i] = z[i];
    }
    step->weights[n] = -step->h;
    evaluate(step, &step->middle);
    step->progress->evaluations++;
}

/* gm_implicit_equations.linear, of z and lambda */
static bool linear(void *data, const double *unknowns, double *residual, double *matrix, double *scale)
{
    const struct step *step = data;
    const size_t n = step->n;
    const double *z = unknowns, *lambda = unknowns + n;
    const struct place *start = &step->start, *end = &step->end, *middle = &step->middle;
    evaluate_all(step, z, lambda);
    for (size_t a = 0; a < n; a++) {
        double *first = matrix + 2 * n * a, *second = first + 2 * n * n,
               gain = end->values[a] - start->values[a] + step->h * middle->slopes[n * n + a],
               sum = start->values[a] + end->values[a] - 2 * middle->values[a];
        for (size_t b = 0; b < n; b++) {
            const size_t row = n * a + b, column = n * b + a; /* of theta', and of its transpose */
            gain += (end->slopes[column] - start->slopes[column]) * lambda[b] - middle->slopes[column] * z[b];
            sum += (end->slopes[column] + start->slopes[column]) * lambda[b];
            first[b] =
                end->slopes[row] + end->curvature[row] - middle->slopes[column] - middle->curvature[row] / 2;
            first[n + b] = end->slopes[column] - start->slopes[column] - middle->curvature[row];
            second[b] = end->slopes[row] + end->curvature[row] - middle->slopes[row];
            second[n + b] = start->slopes[column] + end->slopes[column] - 2 * middle->slopes[row];
        }
        residual[a] = -gain;
        residual[n + a] = -sum;
    }
    *scale += gm_sum_of(step->y, n) + gm_sum_of(unknowns, 2 * n);
    return true;
}

static enum gm_status make_step(const struct gm_task *task, struct gm_members *members,
                                struct gm_progress *progress)
{
    const size_t n = members->n;
    double *memory = members->scratch;
    struct step step = {.problem = task->problem,
                        .progress = progress,
                        .n = n,
                        .h = task->dt,
                        .y = members->y,
                        .start = lay(n, &memory),
                        .end = lay(n, &memory),
                        .middle = lay(n, &memory)};
    double *unknowns = memory;
    step.at = unknowns + 2 * n;
    step.weights = step.at + n;
    double *scratch = step.weights + n + 1;
    const struct gm_implicit_equations equations = {.size = 2 * n,
                                                    .data = &step,
                                                    .linear = linear,
                                                    .counted = 2 * n,
                                                    .least = 0x1p-53,
                                                    .roundoff = 0x1p-40,
                                                    .halved = true};
    memset(step.weights, 0, (n + 1) * sizeof *step.weights);
    memcpy(step.at, members->y, n * sizeof *step.at);
    evaluate(&step, &step.start);
    gm_field(task->problem, members->y, unknowns, 1);
    for (size_t i = 0; i < n; i++) {
        unknowns[i] *= task->dt;
        unknowns[n + i] = 0;
    }
    if (!gm_newton_solve(&equations, scratch, unknowns, progress)) {
        return GM_NO_CONVERGENCE;
    }
    gm_tile_add(members->y, 1, unknowns, members->carry, n);
    return GM_OK;
}

static size_t room_of(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const size_t n = problem->n;
    (void)scheme;
    return 3 * place_size(n) + 4 * n + 1 + gm_newton_scratch(2 * n);
}

const struct gm_family gm_family_degenerate = {
    .title = "variational, of Lagrangians linear in the velocities",
    .parameters = gm_settings_of_sums,
    GM_MEMBERS(degenerate, .step = make_step, .room = room_of),
};
