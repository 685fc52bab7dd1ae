/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss-Legendre collocation on a ring, mode by mode: the frequencies of D (gauss.c says which), a step,
   and the ways between values at the nodes and at the stages. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>

#include "core/field/families/boxes/modes.h"
#include "core/linear/settled.h"

void gm_gauss_close(void *workspace)
{
    struct gm_gauss_work *work = workspace;
    gm_fourier_close(work->fourier);
    free(work->branches);
    free(work->memory);
    free(work);
}

void *gm_gauss_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_collocation_tableau *tableau = scheme->coefficients;
    const size_t points = problem->line.points, r = tableau->r, q = r * r, modes = points / 2 + 1;
    struct gm_gauss_work *work = calloc(1, sizeof *work);
    if (!work) {
        return NULL;
    }
    /* counted in doubles; what is complex comes first */
    const size_t complexes = (2 * r + q) * points;
    work->points = points;
    work->tableau = tableau;
    work->memory = calloc(2 * complexes + (4 * r + 2 * q) * points, sizeof(double));
    work->branches = calloc(modes * r, sizeof *work->branches);
    work->fourier = gm_fourier_open(points);
    if (!work->memory || !work->branches || !work->fourier) {
        gm_gauss_close(work);
        return NULL;
    }
    work->hat_u = (double complex *)(void *)work->memory;
    work->hat_v = work->hat_u + r * points;
    work->hat = work->hat_v + r * points;
    work->u = work->memory + 2 * complexes;
    work->v = work->u + r * points;
    work->next_u = work->v + r * points;
    work->next_v = work->next_u + r * points;
    work->stages = work->next_v + r * points;
    work->force = work->stages + q * points;
    return work;
}

void gm_gauss_forward(struct gm_gauss_work *work, const double *values, double complex *hat)
{
    for (size_t i = 0; i < work->points; i++) {
        hat[i] = values[i];
    }
    gm_fourier_forward(work->fourier, hat);
}

void gm_gauss_backward(struct gm_gauss_work *work, double complex *hat, double *values)
{
    gm_fourier_inverse(work->fourier, hat);
    for (size_t i = 0; i < work->points; i++) {
        values[i] = creal(hat[i]);
    }
}

double gm_gauss_angle(size_t mode, size_t points)
{
    const double turns = (double)mode / (double)points;
    return 2 * M_PI * (2 * mode > points ? turns - 1 : turns);
}

/* sum_k a[j][k] a[k][l] */
static double square(const struct gm_collocation_tableau *tableau, size_t j, size_t l)
{
    double sum = 0;
    for (size_t k = 0; k < tableau->r; k++) {
        sum += tableau->a[j][k] * tableau->a[k][l];
    }
    return sum;
}

/* Frequency and vector of branch e; angle in [0, pi]. */
static struct gm_gauss_branch branch_at(size_t r, size_t e, double angle, bool straight, double dx)
{
    if (r == 1) {
        return (struct gm_gauss_branch){.frequency = straight ? INFINITY : 2 * tan(angle / 2) / dx,
                                        .vector = {1}};
    }
    const double a = 2 * GM_ROOT3, beta = straight ? 0 : 6 / tan(angle / 2);
    const double low = angle == 0 ? 0 : 2 * a * a / (beta + sqrt(beta * beta + 4 * a * a));
    if (angle == 0 && e == 1) {
        return (struct gm_gauss_branch){.frequency = INFINITY, .vector = {-M_SQRT1_2, M_SQRT1_2}};
    }
    const double omega = e == 0 ? low : -a * a / low, length = sqrt(2 * (a * a + omega * omega));
    return (struct gm_gauss_branch){.frequency = omega / dx,
                                    .vector = {(a - I * omega) / length, (a + I * omega) / length}};
}

void gm_gauss_prepare(struct gm_gauss_work *work, double dx, double dt)
{
    const struct gm_collocation_tableau *tableau = work->tableau;
    const size_t r = tableau->r;
    if (work->dt == dt) {
        return;
    }
    for (size_t at = 0; at < (work->points / 2 + 1) * r; at++) {
        const size_t mode = at / r;
        struct gm_gauss_branch *branch = &work->branches[at];
        *branch = branch_at(r, at % r, gm_gauss_angle(mode, work->points), 2 * mode == work->points, dx);
        if (isinf(branch->frequency)) {
            continue;
        }
        const double z = dt * branch->frequency * (dt * branch->frequency);
        if (r == 1) {
            branch->inverse[0][0] = 1 / (1 + z * square(tableau, 0, 0));
            continue;
        }
        const double m00 = 1 + z * square(tableau, 0, 0), m01 = z * square(tableau, 0, 1);
        const double m10 = z * square(tableau, 1, 0), m11 = 1 + z * square(tableau, 1, 1);
        const double determinant = m00 * m11 - m01 * m10;
        branch->inverse[0][0] = m11 / determinant;
        branch->inverse[0][1] = -m01 / determinant;
        branch->inverse[1][0] = -m10 / determinant;
        branch->inverse[1][1] = m00 / determinant;
    }
    work->dt = dt;
}

double complex gm_gauss_amplitude(const struct gm_gauss_branch *branch, size_t r, size_t points, size_t mode,
                                  const double complex *hat)
{
    double complex sum = 0;
    for (size_t m = 0; m < r; m++) {
        sum += conj(branch->vector[m]) * hat[m * points + mode];
    }
    return sum;
}

/* From the transforms of the force (work->hat) at all stages those of u''. */
static void solve_modes(struct gm_gauss_work *work)
{
    const struct gm_collocation_tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->r;
    for (size_t mode = 0; mode <= points / 2; mode++) {
        double complex solution[GM_GAUSS_STAGES][GM_GAUSS_STAGES] = {{0}};
        for (size_t e = 0; e < r; e++) {
            const struct gm_gauss_branch *branch = &work->branches[mode * r + e];
            if (isinf(branch->frequency)) {
                continue;
            }
            const double pull = branch->frequency * branch->frequency;
            const double complex u = gm_gauss_amplitude(branch, r, points, mode, work->hat_u);
            const double complex v = gm_gauss_amplitude(branch, r, points, mode, work->hat_v);
            for (size_t l = 0; l < r; l++) {
                const double complex force =
                    gm_gauss_amplitude(branch, r, points, mode, work->hat + l * r * points);
                const double complex right = -pull * (u + work->dt * tableau->c[l] * v) - force;
                for (size_t j = 0; j < r; j++) {
                    for (size_t m = 0; m < r; m++) {
                        solution[j][m] += branch->inverse[j][l] * right * branch->vector[m];
                    }
                }
            }
        }
        for (size_t row = 0; row < r * r; row++) {
            const double complex value = solution[row / r][row % r];
            work->hat[row * points + mode] = value;
            if (mode > 0 && 2 * mode < points) {
                work->hat[row * points + points - mode] = conj(value);
            }
        }
    }
}

double gm_gauss_slant(const struct gm_grid1 *grid, const struct gm_collocation_tableau *tableau, size_t m,
                      size_t i)
{
    return grid->jump * ((double)i + (m < tableau->r ? tableau->c[m] : 0)) / (double)grid->points;
}

void gm_gauss_forces(struct gm_gauss_work *work, const struct gm_problem *problem, const double *curvature)
{
    const struct gm_collocation_tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->r, q = r * r;
    for (size_t row = 0; row < q; row++) {
        double *force = work->force + row * points;
        const double *stage = work->stages + row * points;
        if (curvature) {
            for (size_t i = 0; i < points; i++) {
                force[i] = curvature[row * points + i] * stage[i];
            }
            continue;
        }
        for (size_t i = 0; i < points; i++) {
            force[i] = stage[i] + gm_gauss_slant(&problem->line, tableau, row % r, i);
        }
        gm_field_of(problem)->wave->slopes(problem, force, force, points);
    }
}

enum gm_status gm_gauss_step(struct gm_gauss_work *work, const struct gm_problem *problem, double dt,
                             const double *curvature, struct gm_progress *progress)
{
    enum { MOST = 200 };
    const struct gm_collocation_tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->r, q = r * r;
    gm_gauss_prepare(work, problem->line.dx, dt);
    for (size_t m = 0; m < r; m++) {
        gm_gauss_forward(work, work->u + m * points, work->hat_u + m * points);
        gm_gauss_forward(work, work->v + m * points, work->hat_v + m * points);
    }
    for (size_t row = 0; row < q; row++) {
        for (size_t i = 0; i < points; i++) {
            const size_t at = row % r * points + i;
            work->stages[row * points + i] = work->u[at] + dt * tableau->c[row / r] * work->v[at];
        }
    }
    double last = INFINITY;
    for (int k = 0; k < MOST; k++) {
        gm_gauss_forces(work, problem, curvature);
        for (size_t row = 0; row < q; row++) {
            gm_gauss_forward(work, work->force + row * points, work->hat + row * points);
        }
        solve_modes(work);
        for (size_t row = 0; row < q; row++) {
            gm_gauss_backward(work, work->hat + row * points, work->force + row * points);
        }
        progress->evaluations += r;
        progress->solves++;
        progress->iterations++;
        double change = 0;
        for (size_t row = 0; row < q; row++) {
            for (size_t i = 0; i < points; i++) {
                const size_t at = row % r * points + i;
                double value = work->u[at] + dt * tableau->c[row / r] * work->v[at];
                for (size_t l = 0; l < r; l++) {
                    value +=
                        dt * dt * square(tableau, row / r, l) * work->force[(l * r + row % r) * points + i];
                }
                const double size = fabs(value - work->stages[row * points + i]);
                change = size > change || isnan(size) ? size : change;
                work->stages[row * points + i] = value;
            }
        }
        if (!isfinite(change)) {
            return GM_BLOW_UP;
        }
        if (gm_is_settled_within(change, 1e-15, 1e-11, &last)) {
            for (size_t at = 0; at < r * points; at++) {
                double du = dt * work->v[at], dv = 0;
                for (size_t l = 0; l < r; l++) {
                    double weight = 0;
                    for (size_t j = 0; j < r; j++) {
                        weight += tableau->b[j] * tableau->a[j][l];
                    }
                    du += dt * dt * weight * work->force[l * r * points + at];
                    dv += dt * tableau->b[l] * work->force[l * r * points + at];
                }
                work->next_u[at] = work->u[at] + du;
                work->next_v[at] = work->v[at] + dv;
            }
            return GM_OK;
        }
    }
    return GM_NO_CONVERGENCE;
}

void gm_gauss_to_nodes(struct gm_gauss_work *work, const struct gm_grid1 *grid, const double *stages,
                       double *nodes)
{
    const struct gm_collocation_tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->r;
    for (size_t m = 0; m < r; m++) {
        gm_gauss_forward(work, stages + m * points, work->hat + m * points);
    }
    for (size_t mode = 0; mode < points; mode++) {
        const double angle = gm_gauss_angle(mode, points);
        double complex *first = &work->hat[mode], second = work->hat[(r - 1) * points + mode];
        if (r == 1) {
            *first = 2 * mode == points ? 0 : 2 * *first / (cexp(I * angle) + 1);
        } else if (mode > 0) {
            /* two waves that the nodes do not tell apart */
            const double other = angle > 0 ? angle - 2 * M_PI : angle + 2 * M_PI;
            const double complex a1 = cexp(I * angle * tableau->c[0]), a2 = cexp(I * angle * tableau->c[1]);
            const double complex b1 = cexp(I * other * tableau->c[0]), b2 = cexp(I * other * tableau->c[1]);
            *first = ((b2 - a2) * *first + (a1 - b1) * second) / (a1 * b2 - b1 * a2);
        }
    }
    gm_gauss_backward(work, work->hat, nodes);
    for (size_t i = 0; i < points; i++) {
        nodes[i] += gm_gauss_slant(grid, tableau, r, i);
    }
}

void gm_gauss_share_mean(double *stages, size_t points)
{
    double mean[GM_GAUSS_STAGES] = {0};
    for (size_t at = 0; at < GM_GAUSS_STAGES * points; at++) {
        mean[at / points] += stages[at] / (double)points;
    }
    for (size_t at = 0; at < GM_GAUSS_STAGES * points; at++) {
        stages[at] += (mean[0] + mean[1]) / 2 - mean[at / points];
    }
}

void gm_gauss_to_stages(struct gm_gauss_work *work, const struct gm_grid1 *grid, const double *nodes,
                        double *stages, double *second)
{
    const struct gm_collocation_tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->r;
    double *scratch = work->force;
    for (size_t i = 0; i < points; i++) {
        scratch[i] = nodes[i] - gm_gauss_slant(grid, tableau, r, i);
    }
    gm_gauss_forward(work, scratch, work->hat_u);
    for (size_t m = 0; m < r; m++) {
        for (size_t which = 0; which < 2; which++) {
            for (size_t mode = 0; mode < points; mode++) {
                const double angle = gm_gauss_angle(mode, points);
                const double complex turn = r == 1               ? (1 + cexp(I * angle)) / 2
                                            : 2 * mode == points ? cos(M_PI * tableau->c[m])
                                                                 : cexp(I * angle * tableau->c[m]);
                work->hat[mode] =
                    work->hat_u[mode] * turn * (which ? -angle * angle / (grid->dx * grid->dx) : 1);
            }
            gm_gauss_backward(work, work->hat, (which ? second : stages) + m * points);
        }
    }
    if (r == 2) {
        gm_gauss_share_mean(stages, points);
        gm_gauss_share_mean(second, points);
    }
}
