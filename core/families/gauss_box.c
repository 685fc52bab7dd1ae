/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss-Legendre collocation in space and time for M s_t + K s_x = grad S(s): r stages across a cell, s
   stages across a step, multisymplectic (S. Reich, J. Comput. Phys. 157 (2000) 473); r = s = 1 is the box.
   For u_tt - u_xx + V'(u) = 0 the memory is u and v = u_t at the r stages of every cell. With tableaux (A, b,
   c) around a ring, z = e^(i theta) the shift by a cell, the derivative of stage values is circulant, D(z) =
   [A^-1 - A^-1 1 b' A^-1 / (z - 1 + rho)] / dx,     rho = b' A^-1 1 = 2 (r = 1), 0 (r = 2), and skew: each
   mode has r branches, on which D is i omega, r = 1:  omega dx = 2 tan(theta/2), r = 2:  omega dx = [-beta +-
   sqrt(beta^2 + 4 a^2)] / 2,  a = 2 sqrt 3,  beta = 6 cot(theta/2), stage values (a - i omega dx, a + i omega
   dx). A step is that of the s-stage Gauss method for u'' = D^2 u - V'(u): solved for the stages of u'',
   branch by branch but for V', and iterated, which contracts by dt^2/4. A branch of infinite frequency (r =
   1, z = -1: an even number of cells; r = 2, z = 1) is 0, which the slope of w forces.

   From values at the nodes the stages are found by averaging (r = 1) or by trigonometric interpolation (r =
   2), and the other way round: the nodes' own values of the collocation polynomials lose an order if they do
   not start as part of a discrete solution. */
#include <complex.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/differences.h"
#include "core/families/families.h"
#include "core/fourier.h"
#include "core/multisymplectic.h"

enum { STAGES = 2, BLOCK = STAGES * STAGES };

struct tableau {
    size_t n;
    double a[STAGES][STAGES], b[STAGES], c[STAGES];
};

#define ROOT3 1.7320508075688772935
static const struct tableau midpoint = {1, {{0.5}}, {1}, {0.5}};
static const struct tableau gauss4 = {
    2,
    {{0.25, 0.25 - ROOT3 / 6}, {0.25 + ROOT3 / 6, 0.25}},
    {0.5, 0.5},
    {0.5 - ROOT3 / 6, 0.5 + ROOT3 / 6},
};

/* A branch of a mode: stage values vector * amplitude, |vector| = 1. */
struct branch {
    double frequency; /* INFINITY: it is 0 */
    double complex vector[STAGES];
    double inverse[STAGES][STAGES]; /* (1 + dt^2 frequency^2 A^2)^-1 */
};

struct work {
    size_t points;
    const struct tableau *tableau; /* the same in space and time */
    double dt;                     /* what the branches were made for */
    struct branch *branches;       /* [mode * r], modes 0 .. points/2 */
    struct gm_fourier *fourier;
    double *u, *v, *next_u, *next_v;     /* [stage * points + cell] */
    double *stages, *force;              /* [(time stage * r + stage) * points + cell] */
    double complex *hat_u, *hat_v, *hat; /* transforms of u, v, and of force or u'' */
    double *memory;
};

static void workspace_close(void *workspace)
{
    struct work *work = workspace;
    gm_fourier_close(work->fourier);
    free(work->branches);
    free(work->memory);
    free(work);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct tableau *tableau = scheme->coefficients;
    const size_t points = problem->line.points, r = tableau->n, q = r * r, modes = points / 2 + 1;
    struct work *work = calloc(1, sizeof *work);
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
        workspace_close(work);
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

static void forward(struct work *work, const double *values, double complex *hat)
{
    for (size_t i = 0; i < work->points; i++) {
        hat[i] = values[i];
    }
    gm_fourier_forward(work->fourier, hat);
}

/* The transform is left as the values. */
static void backward(struct work *work, double complex *hat, double *values)
{
    gm_fourier_inverse(work->fourier, hat);
    for (size_t i = 0; i < work->points; i++) {
        values[i] = creal(hat[i]);
    }
}

/* The angle of z for a mode, in (-pi, pi]. */
static double angle_of(size_t mode, size_t points)
{
    const double turns = (double)mode / (double)points;
    return 2 * M_PI * (2 * mode > points ? turns - 1 : turns);
}

/* sum_k a[j][k] a[k][l] */
static double square(const struct tableau *tableau, size_t j, size_t l)
{
    double sum = 0;
    for (size_t k = 0; k < tableau->n; k++) {
        sum += tableau->a[j][k] * tableau->a[k][l];
    }
    return sum;
}

/* Frequency and vector of branch e; angle in [0, pi]. */
static struct branch branch_at(size_t r, size_t e, double angle, bool straight, double dx)
{
    if (r == 1) {
        return (struct branch){.frequency = straight ? INFINITY : 2 * tan(angle / 2) / dx, .vector = {1}};
    }
    const double a = 2 * ROOT3, beta = straight ? 0 : 6 / tan(angle / 2);
    const double low = angle == 0 ? 0 : 2 * a * a / (beta + sqrt(beta * beta + 4 * a * a));
    if (angle == 0 && e == 1) {
        return (struct branch){.frequency = INFINITY, .vector = {-M_SQRT1_2, M_SQRT1_2}};
    }
    const double omega = e == 0 ? low : -a * a / low, length = sqrt(2 * (a * a + omega * omega));
    return (struct branch){.frequency = omega / dx,
                           .vector = {(a - I * omega) / length, (a + I * omega) / length}};
}

static void prepare(struct work *work, double dx, double dt)
{
    const struct tableau *tableau = work->tableau;
    const size_t r = tableau->n;
    if (work->dt == dt) {
        return;
    }
    for (size_t at = 0; at < (work->points / 2 + 1) * r; at++) {
        const size_t mode = at / r;
        struct branch *branch = &work->branches[at];
        *branch = branch_at(r, at % r, angle_of(mode, work->points), 2 * mode == work->points, dx);
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

/* The amplitude of a branch in the transforms of stage values, r arrays of `points`. */
static double complex amplitude(const struct branch *branch, size_t r, size_t points, size_t mode,
                                const double complex *hat)
{
    double complex sum = 0;
    for (size_t m = 0; m < r; m++) {
        sum += conj(branch->vector[m]) * hat[m * points + mode];
    }
    return sum;
}

/* From the transforms of the force (work->hat) at all stages those of u''. */
static void solve_modes(struct work *work)
{
    const struct tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->n;
    for (size_t mode = 0; mode <= points / 2; mode++) {
        double complex solution[STAGES][STAGES] = {{0}};
        for (size_t e = 0; e < r; e++) {
            const struct branch *branch = &work->branches[mode * r + e];
            if (isinf(branch->frequency)) {
                continue;
            }
            const double pull = branch->frequency * branch->frequency;
            const double complex u = amplitude(branch, r, points, mode, work->hat_u);
            const double complex v = amplitude(branch, r, points, mode, work->hat_v);
            for (size_t l = 0; l < r; l++) {
                const double complex force = amplitude(branch, r, points, mode, work->hat + l * r * points);
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

/* u - jump x / length is periodic; that of stage m of cell i. */
static double slanted(const struct gm_line *line, const struct tableau *tableau, size_t m, size_t i)
{
    return line->jump * ((double)i + (m < tableau->n ? tableau->c[m] : 0)) / (double)line->points;
}

/* V' at all stages; of a tangent, V'' at those of the solution times the tangent. */
static void find_forces(struct work *work, const struct gm_problem *problem, const double *curvature)
{
    const struct tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->n, q = r * r;
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
            force[i] = stage[i] + slanted(&problem->line, tableau, row % r, i);
        }
        problem->wave->slopes(force, force, points);
    }
}

/* One step from u, v to next_u, next_v, which leaves u at the stages in time as well. */
static enum gm_status make_step(struct work *work, const struct gm_problem *problem, double dt,
                                const double *curvature, struct gm_progress *progress)
{
    enum { MOST = 200 };
    const struct tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->n, q = r * r;
    prepare(work, problem->line.dx, dt);
    for (size_t m = 0; m < r; m++) {
        forward(work, work->u + m * points, work->hat_u + m * points);
        forward(work, work->v + m * points, work->hat_v + m * points);
    }
    for (size_t row = 0; row < q; row++) {
        for (size_t i = 0; i < points; i++) {
            const size_t at = row % r * points + i;
            work->stages[row * points + i] = work->u[at] + dt * tableau->c[row / r] * work->v[at];
        }
    }
    double last = INFINITY;
    for (int k = 0; k < MOST; k++) {
        find_forces(work, problem, curvature);
        for (size_t row = 0; row < q; row++) {
            forward(work, work->force + row * points, work->hat + row * points);
        }
        solve_modes(work);
        for (size_t row = 0; row < q; row++) {
            backward(work, work->hat + row * points, work->force + row * points);
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
        if (change <= 1e-15 || (change >= last && change <= 1e-11)) {
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
        last = change;
    }
    return GM_NO_CONVERGENCE;
}

/* Values at the nodes from those at the stages. */
static void to_nodes(struct work *work, const struct gm_line *line, const double *stages, double *nodes)
{
    const struct tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->n;
    for (size_t m = 0; m < r; m++) {
        forward(work, stages + m * points, work->hat + m * points);
    }
    for (size_t mode = 0; mode < points; mode++) {
        const double angle = angle_of(mode, points);
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
    backward(work, work->hat, nodes);
    for (size_t i = 0; i < points; i++) {
        nodes[i] += slanted(line, tableau, r, i);
    }
}

/* Takes out the branch without a derivative of two stages: both get the same mean over the ring. */
static void share_mean(double *stages, size_t points)
{
    double mean[STAGES] = {0};
    for (size_t at = 0; at < STAGES * points; at++) {
        mean[at / points] += stages[at] / (double)points;
    }
    for (size_t at = 0; at < STAGES * points; at++) {
        stages[at] += (mean[0] + mean[1]) / 2 - mean[at / points];
    }
}

/* Values at the stages from those at the nodes, and with `second` their second derivatives in space. */
static void to_stages(struct work *work, const struct gm_line *line, const double *nodes, double *stages,
                      double *second)
{
    const struct tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->n;
    double *scratch = work->force;
    for (size_t i = 0; i < points; i++) {
        scratch[i] = nodes[i] - slanted(line, tableau, r, i);
    }
    forward(work, scratch, work->hat_u);
    for (size_t m = 0; m < r; m++) {
        for (size_t which = 0; which < 2; which++) {
            for (size_t mode = 0; mode < points; mode++) {
                const double angle = angle_of(mode, points);
                const double complex turn = r == 1               ? (1 + cexp(I * angle)) / 2
                                            : 2 * mode == points ? cos(M_PI * tableau->c[m])
                                                                 : cexp(I * angle * tableau->c[m]);
                work->hat[mode] =
                    work->hat_u[mode] * turn * (which ? -angle * angle / (line->dx * line->dx) : 1);
            }
            backward(work, work->hat, (which ? second : stages) + m * points);
        }
    }
    if (r == 2) {
        share_mean(stages, points);
        share_mean(second, points);
    }
}

static size_t memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    return 2 * ((const struct tableau *)scheme->coefficients)->n * problem->line.points + 1;
}

/* Corrects v so that a step leads to the other level as well as to the order of the scheme. */
static void correct(struct work *work, const struct gm_problem *problem, double gap, const double *u,
                    double *v, const double *other_nodes)
{
    enum { TIMES = 2 };
    const size_t count = work->tableau->n * work->points, size = count * sizeof *u;
    struct gm_progress uncounted = {.status = GM_OK};
    double *other = malloc(2 * size);
    for (int k = 0; other && k < TIMES; k++) {
        to_stages(work, &problem->line, other_nodes, other, other + count);
        memcpy(work->u, u, size);
        memcpy(work->v, v, size);
        if (make_step(work, problem, gap, NULL, &uncounted) != GM_OK) {
            break;
        }
        for (size_t at = 0; at < count; at++) {
            v[at] += (other[at] - work->next_u[at]) / gap;
        }
    }
    free(other);
}

/* u and v at the stages, from the two levels: for r = 1 so that the first step leads from one to the other,
   for r = 2 by the first terms of Taylor's series, v = [u(t + g) - u(t)]/g - g [2 u''(t) + u''(t + g)]/6 +
   O(g^3). The last number of the memory says that it is filled, and is not to be filled anew for another dt.
 */
static enum gm_status start(const struct gm_task *task)
{
    const struct gm_problem *problem = task->problem;
    const struct gm_line *line = &problem->line;
    const struct tableau *tableau = task->scheme->coefficients;
    const size_t points = line->points, r = tableau->n, count = r * points;
    const double gap = task->y[2 * points];
    double *u = task->memory_out, *v = u + count, *filled = v + count;
    struct work *work = task->workspace;
    if (*filled == 1) {
        return GM_OK;
    }
    double *second = work->next_u, *other = work->v, *second_other = work->next_v;
    to_stages(work, line, task->y, u, second);
    to_stages(work, line, task->y + points, other, second_other);
    if (r == 1) {
        memcpy(work->u, u, count * sizeof *u);
        for (size_t i = 0; i < points; i++) {
            work->stages[i] = (u[i] + other[i]) / 2;
        }
        find_forces(work, problem, NULL);
        prepare(work, line->dx, gap);
        forward(work, work->force, work->hat);
        forward(work, work->stages, work->hat_u);
        for (size_t mode = 0; mode < points; mode++) {
            const double frequency = work->branches[2 * mode > points ? points - mode : mode].frequency;
            work->hat[mode] =
                isinf(frequency) ? 0 : -frequency * frequency * work->hat_u[mode] - work->hat[mode];
        }
        backward(work, work->hat, work->force);
        for (size_t i = 0; i < points; i++) {
            v[i] = (other[i] - u[i]) / gap - gap / 2 * work->force[i];
        }
    } else {
        for (size_t at = 0; at < count; at++) {
            const double slant = slanted(line, tableau, at / points, at % points);
            const double here = second[at] - problem->wave->slope(u[at] + slant);
            const double there = second_other[at] - problem->wave->slope(other[at] + slant);
            v[at] = (other[at] - u[at]) / gap - gap * (2 * here + there) / 6;
        }
        share_mean(v, points);
        correct(work, problem, gap, u, v, task->y + points);
    }
    *filled = 1;
    return GM_OK;
}

static bool within(const double *u, size_t count, double limit)
{
    for (size_t i = 0; i < count; i++) {
        if (!(fabs(u[i]) <= limit)) {
            return false;
        }
    }
    return true;
}

static struct gm_progress advance(const struct gm_task *task)
{
    struct work *work = task->workspace;
    const struct gm_line *line = &task->problem->line;
    const size_t points = work->points, count = work->tableau->n * points, size = count * sizeof(double);
    struct gm_progress progress = {.status = GM_OK};
    memcpy(work->next_u, task->memory, size);
    memcpy(work->next_v, task->memory + count, size);
    for (long k = 0; k < task->steps; k++) {
        memcpy(work->u, work->next_u, size);
        memcpy(work->v, work->next_v, size);
        progress.status = make_step(work, task->problem, task->dt, NULL, &progress);
        if (progress.status == GM_OK && !within(work->next_u, count, task->limit)) {
            progress.status = GM_BLOW_UP;
        }
        if (progress.status != GM_OK) {
            return progress;
        }
        progress.done++;
    }
    memcpy(task->memory_out, work->next_u, size);
    memcpy(task->memory_out + count, work->next_v, size);
    task->memory_out[2 * count] = 1;
    to_nodes(work, line, work->next_u, task->out);
    to_nodes(work, line, work->u, task->out + points);
    task->out[2 * points] = -task->dt;
    return progress;
}

/* What the law needs of one tangent, which work holds before and after its step: u and v at the stages of the
   cells, and u and w at their sides, at the stages in time. Where a branch has infinite frequency the force
   on it (work->hat_v holds its part at the first stage) is balanced by w. */
static void find_faces(struct work *work, double dx, const double *curvature, struct gm_faces *faces)
{
    enum { U, V, W, DIMENSION };
    const struct tableau *tableau = work->tableau;
    const size_t points = work->points, r = tableau->n;
    for (size_t i = 0; i < points; i++) {
        for (size_t m = 0; m < r; m++) {
            double *lower = faces->lower + (i * r + m) * DIMENSION;
            double *upper = faces->upper + (i * r + m) * DIMENSION;
            lower[U] = work->u[m * points + i];
            lower[V] = work->v[m * points + i];
            upper[U] = work->next_u[m * points + i];
            upper[V] = work->next_v[m * points + i];
        }
    }
    for (size_t j = 0; j < r; j++) {
        const double *stages = work->stages + j * r * points, *bend = curvature + j * r * points;
        for (size_t m = 0; m < r; m++) {
            for (size_t i = 0; i < points; i++) {
                work->force[i] = bend[m * points + i] * stages[m * points + i];
            }
            forward(work, work->force, work->hat_v + m * points);
            forward(work, stages + m * points, work->hat_u + m * points);
        }
        for (size_t mode = 0; mode <= points / 2; mode++) {
            const double angle = angle_of(mode, points);
            double complex of_u = 0, of_w = 0;
            for (size_t e = 0; e < r; e++) {
                const struct branch *branch = &work->branches[mode * r + e];
                /* b' A^-1 of the vector / (z - 1 + rho) */
                const double complex side =
                    r == 1      ? 2 / (cexp(I * angle) + 1)
                    : mode == 0 ? branch->vector[0]
                                : ROOT3 * (branch->vector[1] - branch->vector[0]) / (cexp(I * angle) - 1);
                if (isinf(branch->frequency)) {
                    const double complex push = amplitude(branch, r, points, mode, work->hat_v);
                    /* -dx A of the balancing slope of w */
                    of_w -= dx * push *
                            (r == 1 ? tableau->a[0][0]
                                    : tableau->a[0][0] * branch->vector[0] +
                                          tableau->a[0][1] * branch->vector[1]);
                    continue;
                }
                const double complex u = amplitude(branch, r, points, mode, work->hat_u);
                of_u += side * u;
                of_w += side * I * branch->frequency * u;
            }
            work->hat[mode] = of_u;
            work->hat[points + mode] = of_w;
            if (mode > 0 && 2 * mode < points) {
                work->hat[points - mode] = conj(of_u);
                work->hat[2 * points - mode] = conj(of_w);
            }
        }
        backward(work, work->hat, work->force);
        for (size_t i = 0; i <= points; i++) {
            faces->sides[(i * r + j) * DIMENSION + U] = work->force[i < points ? i : 0];
        }
        backward(work, work->hat + points, work->force);
        for (size_t i = 0; i <= points; i++) {
            faces->sides[(i * r + j) * DIMENSION + W] = work->force[i < points ? i : 0];
        }
    }
}

/* A step of the loop, as gm_map: u and v at the stages of the cells to the same. */
struct base {
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    double dt;
    struct work *work;
    const double *y;
};

static bool one_step(const void *context, const double *from, double *to)
{
    const struct base *base = context;
    const size_t count = 2 * base->work->tableau->n * base->work->points;
    double *memory = malloc((base->problem->n + 2 * (count + 1)) * sizeof *memory);
    if (!memory) {
        return false;
    }
    double *given = memory + base->problem->n, *made = given + count + 1;
    memcpy(given, from, count * sizeof *given);
    const struct gm_task task = {
        .problem = base->problem,
        .scheme = base->scheme,
        .dt = base->dt,
        .steps = 1,
        .limit = INFINITY,
        .y = base->y,
        .out = memory,
        .memory = given,
        .memory_out = made,
        .workspace = base->work,
    };
    const bool good = base->scheme->family->loop(&task).status == GM_OK;
    memcpy(to, made, count * sizeof *to);
    free(memory);
    return good;
}

/* Advances a tangent from u and v of its start (count numbers) and finds its faces. */
static bool advance_tangent(const struct base *base, const double *memory, const double *curvature,
                            bool by_differences, const double *start, struct gm_faces *faces)
{
    struct work *work = base->work;
    const size_t half = work->tableau->n * work->points, size = half * sizeof(double);
    struct gm_problem straight = *base->problem;
    straight.line.jump = 0;
    struct gm_progress uncounted = {.status = GM_OK};
    double *end = malloc(2 * size);
    bool good = end != NULL;
    good =
        good && (!by_differences || gm_differentiate(one_step, base, 2 * half, memory, start, 2 * half, end));
    memcpy(work->u, start, size);
    memcpy(work->v, start + half, size);
    good = good && make_step(work, &straight, base->dt, curvature, &uncounted) == GM_OK;
    if (good && by_differences) {
        memcpy(work->next_u, end, size);
        memcpy(work->next_v, end + half, size);
    }
    if (good) {
        find_faces(work, base->problem->line.dx, curvature, faces);
    }
    free(end);
    return good;
}

static double form(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                   const double *y, const double *memory, bool by_differences)
{
    const struct tableau *tableau = scheme->coefficients;
    const size_t points = problem->line.points, r = tableau->n, half = r * points, q = r * r;
    const struct gm_cells cells = {points, r, r, tableau->b, tableau->b, problem->line.dx, dt};
    struct work *work = workspace_open(problem, scheme);
    struct gm_faces faces[2] = {{0}};
    double *arrays = malloc((q * points + 2 * half) * sizeof *arrays), residual = NAN;
    const struct base base = {problem, scheme, dt, work, y};
    struct gm_progress uncounted = {.status = GM_OK};
    bool good = work && arrays;
    for (size_t k = 0; k < 2; k++) {
        good &= gm_faces_open(&faces[k], problem->field, &cells);
    }
    if (good) {
        double *curvature = arrays, *start = arrays + q * points;
        memcpy(work->u, memory, half * sizeof *arrays);
        memcpy(work->v, memory + half, half * sizeof *arrays);
        good = make_step(work, problem, dt, NULL, &uncounted) == GM_OK;
        for (size_t at = 0; at < q * points; at++) {
            const double slant = slanted(&problem->line, tableau, at / points % r, at % points);
            curvature[at] = problem->wave->curvature(work->stages[at] + slant);
        }
        for (size_t k = 0; good && k < 2; k++) {
            for (size_t m = 0; m < 2 * r; m++) {
                const double shift = tableau->c[m % r];
                gm_tangent_start(start + m * points, points, 2 + (double)k,
                                 0.3 + 0.4 * (double)k + (double)(m / r) +
                                     2 * M_PI * (2 + (double)k) * shift / (double)points);
            }
            good = advance_tangent(&base, memory, curvature, by_differences, start, &faces[k]);
        }
        if (good) {
            residual = gm_cells_law(problem->field, &cells, &faces[0], &faces[1]);
        }
    }
    gm_faces_close(&faces[0]);
    gm_faces_close(&faces[1]);
    free(arrays);
    if (work) {
        workspace_close(work);
    }
    return residual;
}

static const struct gm_scheme schemes[] = {
    {
        .name = "gauss-box2",
        .alias = "gauss-box",
        .title = "Gauss box, r = s = 1",
        .formula =
            "u″ = D²u − V′(u),  D(z) = [A⁻¹ − A⁻¹1bᵀA⁻¹/(z − 1 + bᵀA⁻¹1)]/Δx,  midpoint rule in x and t",
        .reference = "S. Reich, J. Comput. Phys. 157 (2000) 473: the box, by Fourier modes",
        .family = &gm_family_gauss_box,
        .coefficients = &midpoint,
        .order = 2,
        .needs = GM_NEEDS_WAVE,
        .claims = GM_MULTISYMPLECTIC | GM_SYMMETRIC,
    },
    {
        .name = "gauss-box3",
        .title = "Gauss box, r = s = 2",
        .formula = "u″ = D²u − V′(u),  D(z) = [A⁻¹ − A⁻¹1bᵀA⁻¹/(z − 1)]/Δx,  two stages of Gauss in x and t",
        .reference = "S. Reich, J. Comput. Phys. 157 (2000) 473; the order is that of the stages",
        .family = &gm_family_gauss_box,
        .coefficients = &gauss4,
        .order = 3,
        .needs = GM_NEEDS_WAVE,
        .claims = GM_MULTISYMPLECTIC | GM_SYMMETRIC,
    },
};

const struct gm_family gm_family_gauss_box = {
    .id = GM_FAMILY_gauss_box,
    .title = "multisymplectic Gauss collocation",
    .schemes = schemes,
    .count = sizeof schemes / sizeof schemes[0],
    .loop = advance,
    .memory = memory,
    .start = start,
    .workspace_open = workspace_open,
    .workspace_close = workspace_close,
    .form = form,
};
