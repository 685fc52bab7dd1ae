/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Partitioned Runge-Kutta methods for Hamiltonians that do not separate, (q, p)' = (f_q, f_p):
       Q_i = q0 + h sum_j a_ij f_q(Q_j, P_j),   P_i = p0 + h sum_j c_ij f_p(Q_j, P_j)
       q1  = q0 + h sum_i b_i  f_q(Q_i, P_i),   p1  = p0 + h sum_i d_i  f_p(Q_i, P_i)
   symplectic if b = d and b_i c_ij + b_j a_ji = b_i b_j: the Lobatto IIIA-IIIB pairs, the symplectic Euler
   methods. Solved to round-off by fixed-point iteration, and where that does not contract by Newton's method.
   Hairer, Lubich & Wanner (2006), sections VI.3, VI.4, II.2. */
#include "core/ode/families/runge_kutta/partitioned.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/ode/families/families.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/theory/coefficients.h"

enum { PICARD_ITERATIONS = 150, NEWTON_ITERATIONS = 50 };

/* The scratch: increments z and slopes f of the stages, one stage, then the right-hand side and the
   matrix. */
struct scratch {
    double *z, *f, *stage, *right, *matrix, *jacobian;
};

static struct scratch scratch_of(const struct gm_members *members, size_t stages)
{
    const size_t n = members->n;
    double *at = members->scratch;
    return (struct scratch){
        .z = at,
        .f = at + stages * n,
        .stage = at + 2 * stages * n,
        .right = at + (2 * stages + 1) * n,
        .jacobian = at + (3 * stages + 1) * n,
        .matrix = at + (3 * stages + 1) * n + n * n,
    };
}

/* Slopes at y + z_i; returns the 1-norm of all that is added. */
static double slopes(const struct gm_task *task, const struct gm_members *members,
                     const struct scratch *scratch, size_t stages, struct gm_progress *progress)
{
    const size_t n = members->n;
    double size = 0;
    for (size_t i = 0; i < stages; i++) {
        for (size_t c = 0; c < n; c++) {
            scratch->stage[c] = members->y[c] + scratch->z[i * n + c];
            size += fabs(members->y[c]) + fabs(scratch->z[i * n + c]);
        }
        gm_field(task->problem, scratch->stage, scratch->f + i * n, 1);
    }
    progress->evaluations += stages;
    progress->iterations++;
    return size;
}

static double coefficient(const struct gm_partitioned_row *tableau, size_t i, size_t j, bool momentum)
{
    return momentum ? tableau->c[i][j] : tableau->a[i][j];
}

/* right := h (a | c) f - z; returns its 1-norm */
static double residual(const struct gm_partitioned_row *tableau, const struct scratch *scratch, size_t n,
                       double h)
{
    double change = 0;
    for (size_t i = 0; i < tableau->stages; i++) {
        for (size_t c = 0; c < n; c++) {
            double next = 0;
            for (size_t j = 0; j < tableau->stages; j++) {
                next += h * coefficient(tableau, i, j, c >= n / 2) * scratch->f[j * n + c];
            }
            scratch->right[i * n + c] = next - scratch->z[i * n + c];
            change += fabs(scratch->right[i * n + c]);
        }
    }
    return change;
}

static bool by_fixed_point(const struct gm_task *task, struct gm_members *members,
                           const struct gm_partitioned_row *tableau, struct gm_progress *progress)
{
    const struct scratch scratch = scratch_of(members, tableau->stages);
    const size_t size = tableau->stages * members->n;
    const bool newton = gm_matrix_size(task->problem) > 0;
    double previous = INFINITY, before_previous = INFINITY;
    memset(scratch.z, 0, size * sizeof(double));
    for (int iteration = 0; iteration < PICARD_ITERATIONS; iteration++) {
        const double scale = slopes(task, members, &scratch, tableau->stages, progress);
        const double change = residual(tableau, &scratch, members->n, task->dt);
        const double roundoff = 8 * GM_EPSILON * scale, before = previous;
        progress->unsolved = gm_unsolved_by(change, scale);
        if (!(change < 1e100)) {
            return false;
        }
        for (size_t i = 0; i < size; i++) {
            scratch.z[i] += scratch.right[i];
        }
        if (gm_is_settled(change, roundoff, &previous)) {
            return true;
        }
        if (newton && !GM_SWEEPS_CONTRACT(change, before_previous, roundoff)) {
            return false;
        }
        before_previous = before;
    }
    return false;
}

/* matrix := I - h (a | c) J of the stages; false where there is no Jacobian. */
static bool linearise(const struct gm_task *task, const struct gm_members *members,
                      const struct gm_partitioned_row *tableau, const struct scratch *scratch)
{
    const size_t n = members->n, size = tableau->stages * n;
    for (size_t j = 0; j < tableau->stages; j++) {
        for (size_t c = 0; c < n; c++) {
            scratch->stage[c] = members->y[c] + scratch->z[j * n + c];
        }
        if (!gm_jacobian(task->problem, scratch->stage, scratch->jacobian)) {
            return false;
        }
        for (size_t i = 0; i < tableau->stages; i++) {
            for (size_t r = 0; r < n; r++) {
                const double factor = task->dt * coefficient(tableau, i, j, r >= n / 2);
                for (size_t c = 0; c < n; c++) {
                    scratch->matrix[(i * n + r) * size + j * n + c] =
                        (i == j && r == c ? 1 : 0) - factor * scratch->jacobian[r * n + c];
                }
            }
        }
    }
    return true;
}

static bool by_newton(const struct gm_task *task, struct gm_members *members,
                      const struct gm_partitioned_row *tableau, struct gm_progress *progress)
{
    const struct scratch scratch = scratch_of(members, tableau->stages);
    const size_t n = members->n, size = tableau->stages * n;
    double previous = INFINITY;
    memset(scratch.z, 0, size * sizeof(double));
    for (int iteration = 0; iteration < NEWTON_ITERATIONS; iteration++) {
        const double scale = slopes(task, members, &scratch, tableau->stages, progress);
        residual(tableau, &scratch, n, task->dt);
        if (!linearise(task, members, tableau, &scratch)) {
            return false;
        }
        progress->solves++;
        const double rounding = gm_rounding_decides(scale, previous)
                                    ? gm_rounding_of_stages(size, n, scratch.matrix, members->y, scratch.z)
                                    : 0;
        if (!gm_eliminate(size, scratch.matrix, scratch.right)) {
            progress->unsolved.obstacle = gm_obstacle_of(size * size, scratch.matrix);
            return false;
        }
        double change = 0;
        for (size_t i = 0; i < size; i++) {
            change += fabs(scratch.right[i]);
            scratch.z[i] += scratch.right[i];
        }
        if (gm_newton_is_settled(size, change, scale, rounding, &previous)) {
            return true;
        }
        progress->unsolved = gm_unsolved_by(change, scale);
        if (!isfinite(change)) {
            return false;
        }
    }
    return false;
}

/* y += sum w_k z_k after Newton's method, where a side has such weights; else y += h sum b_i f_i. */
static enum gm_status step(const struct gm_task *task, struct gm_members *members,
                           struct gm_progress *progress)
{
    const struct gm_partitioned_row *tableau = task->scheme->coefficients;
    const size_t n = members->n, stages = tableau->stages;
    const struct scratch scratch = scratch_of(members, stages);
    bool from_z[2] = {false, false};
    double weights[2][GM_PARTITIONED_STAGES];
    if (gm_ode_of(task->problem)->stiff || !by_fixed_point(task, members, tableau, progress)) {
        if (!by_newton(task, members, tableau, progress)) {
            return GM_NO_CONVERGENCE;
        }
        from_z[0] = gm_weights_of_stages(stages, tableau->a, tableau->b, weights[0]);
        from_z[1] = gm_weights_of_stages(stages, tableau->c, tableau->d, weights[1]);
        slopes(task, members, &scratch, stages, progress);
    }
    for (size_t c = 0; c < n; c++) {
        const size_t side = c < n / 2 ? 0 : 1;
        double increment = 0;
        for (size_t i = 0; i < stages; i++) {
            increment += from_z[side]
                             ? weights[side][i] * scratch.z[i * n + c]
                             : task->dt * (side == 0 ? tableau->b : tableau->d)[i] * scratch.f[i * n + c];
        }
        members->y[c] += increment;
    }
    return GM_OK;
}

static struct gm_progress loop(const struct gm_task *task)
{
    return gm_members_advance(task, step);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const size_t stages = ((const struct gm_partitioned_row *)scheme->coefficients)->stages;
    const size_t matrices = (1 + stages * stages) * gm_matrix_size(problem);
    return gm_members_open(problem, 0, (3 * stages + 1) * problem->n + matrices);
}

static const struct gm_partitioned_row symplectic_euler = {
    .stages = 1, .a = {{0}}, .c = {{1}}, .b = {1}, .d = {1}};
static const struct gm_partitioned_row symplectic_euler_adjoint = {
    .stages = 1, .a = {{1}}, .c = {{0}}, .b = {1}, .d = {1}};
static const struct gm_partitioned_row lobatto2 = {
    .stages = 2, .a = {{0, 0}, {0.5, 0.5}}, .c = {{0.5, 0}, {0.5, 0}}, .b = {0.5, 0.5}, .d = {0.5, 0.5}};
static const struct gm_partitioned_row lobatto4 = {
    .stages = 3,
    .a = {{0, 0, 0}, {5. / 24, 1. / 3, -1. / 24}, {1. / 6, 2. / 3, 1. / 6}},
    .c = {{1. / 6, -1. / 6, 0}, {1. / 6, 1. / 3, 0}, {1. / 6, 5. / 6, 0}},
    .b = {1. / 6, 2. / 3, 1. / 6},
    .d = {1. / 6, 2. / 3, 1. / 6},
};

#define PARTITIONED .family = &gm_family_partitioned
#define INSEPARABLE PARTITIONED, .needs = GM_NEEDS_HAMILTONIAN | GM_NEEDS_INSEPARABLE

static const struct gm_scheme schemes[] = {
    {
        .name = "symplectic-euler",
        .title = "symplectic Euler",
        .formula = "p₁ = p₀ − h ∂H/∂q(q₀, p₁),  q₁ = q₀ + h ∂H/∂p(q₀, p₁)",
        .reference = "R. de Vogelaere (1956); Razafindralandy et al. (2018), eq. 24",
        .coefficients = &symplectic_euler,
        .order = 1,
        .claims = GM_SYMPLECTIC | GM_KEEPS_LINEAR | GM_KEEPS_BILINEAR,
        INSEPARABLE,
    },
    {
        .name = "symplectic-euler-adjoint",
        .title = "symplectic Euler (adjoint)",
        .formula = "q₁ = q₀ + h ∂H/∂p(q₁, p₀),  p₁ = p₀ − h ∂H/∂q(q₁, p₀)",
        .reference = "Hairer, Lubich & Wanner (2006), VI.3",
        .coefficients = &symplectic_euler_adjoint,
        .order = 1,
        .claims = GM_SYMPLECTIC | GM_KEEPS_LINEAR | GM_KEEPS_BILINEAR,
        INSEPARABLE,
    },
    {
        .name = "lobatto2",
        .title = "Lobatto IIIA-IIIB 2",
        .formula = "p½ = p₀ − h/2 ∂H/∂q(q₀, p½),  q₁ = q₀ + h/2 [∂H/∂p(q₀, p½) + ∂H/∂p(q₁, p½)],\n"
                   "p₁ = p½ − h/2 ∂H/∂q(q₁, p½)",
        .reference = "G. Sun, J. Comput. Math. 11 (1993) 365; Hairer, Lubich & Wanner (2006), VI.3.4",
        .coefficients = &lobatto2,
        .order = 2,
        .claims = GM_SYMPLECTIC | GM_SYMMETRIC | GM_REVERSIBLE | GM_KEEPS_LINEAR | GM_KEEPS_BILINEAR,
        INSEPARABLE,
    },
    {
        .name = "lobatto4",
        .title = "Lobatto IIIA-IIIB 4",
        .formula = "Qᵢ = q₀ + h Σⱼ aᵢⱼ ∂H/∂p(Qⱼ, Pⱼ),  Pᵢ = p₀ − h Σⱼ âᵢⱼ ∂H/∂q(Qⱼ, Pⱼ),  nodes 0, 1/2, 1",
        .reference = "G. Sun, J. Comput. Math. 11 (1993) 365; Hairer, Lubich & Wanner (2006), VI.4",
        .coefficients = &lobatto4,
        .order = 4,
        .needs = GM_NEEDS_HAMILTONIAN,
        .claims = GM_SYMPLECTIC | GM_SYMMETRIC | GM_REVERSIBLE | GM_KEEPS_LINEAR | GM_KEEPS_BILINEAR,
        PARTITIONED,
    },
};

static bool coefficients_open(const struct gm_scheme *scheme, struct gm_coefficients *coefficients)
{
    const struct gm_partitioned_row *tableau = scheme->coefficients;
    const size_t stages = tableau->stages;
    if (!gm_coefficients_open(coefficients, GM_EQUATIONS_PARTITIONED, (int)stages)) {
        return false;
    }
    for (size_t i = 0; i < stages; i++) {
        for (size_t j = 0; j < stages; j++) {
            coefficients->a[GM_SIDE_Q][i * stages + j] = gm_ball_written(tableau->a[i][j]);
            coefficients->a[GM_SIDE_P][i * stages + j] = gm_ball_written(tableau->c[i][j]);
        }
        coefficients->b[GM_SIDE_Q][i] = gm_ball_written(tableau->b[i]);
        coefficients->b[GM_SIDE_P][i] = gm_ball_written(tableau->d[i]);
    }
    return true;
}

const struct gm_family gm_family_partitioned = {
    .kind = &gm_kind_ode,
    .title = "partitioned Runge-Kutta",
    .coefficients_open = coefficients_open,
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .loop = loop,
    .workspace_open = workspace_open,
    .workspace_close = free,
};
