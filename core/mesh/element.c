/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The element Lagrangian, the constraint and their derivatives, as core/mesh/element.h states them. */
#include "core/mesh/element.h"
#include "core/basics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool gm_elements_open(struct gm_elements *stage, const struct gm_mesh *mesh)
{
    double **const arrays[] = {
        &stage->y,           &stage->x,        &stage->u,        &stage->v,       &stage->middle,
        &stage->rise,        &stage->width,    &stage->slope,    &stage->w,       &stage->w_m,
        &stage->w_r,         &stage->force_y0, &stage->force_y1, &stage->force_d, &stage->momentum_u0,
        &stage->momentum_u1, &stage->ell,      &stage->ell_y0,   &stage->ell_y1,  &stage->ell_d,
        &stage->rate,        &stage->bend_y0,  &stage->bend_y1,  &stage->bend_d,
    };
    const size_t count = GM_COUNT(arrays), length = mesh->points + 2;
    *stage = (struct gm_elements){.count = mesh->points + 1};
    stage->memory = calloc(count * length, sizeof *stage->memory);
    if (!stage->memory) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        *arrays[i] = stage->memory + i * length;
    }
    stage->y[0] = mesh->left;
    stage->y[length - 1] = mesh->right;
    stage->x[0] = mesh->first;
    stage->x[length - 1] = mesh->first + mesh->length;
    return true;
}

void gm_elements_close(struct gm_elements *stage)
{
    free(stage->memory);
    *stage = (struct gm_elements){0};
}

void gm_elements_place(struct gm_elements *stage, const double *state)
{
    const size_t points = stage->count - 1, size = points * sizeof(double);
    memcpy(stage->y + 1, state, size);
    memcpy(stage->x + 1, state + points, size);
    memcpy(stage->u + 1, state + 2 * points, size);
    memcpy(stage->v + 1, state + 3 * points, size);
}

/* Geometry of the elements; the least width, NaN if one is NaN. */
static double shape(struct gm_elements *stage)
{
    const size_t count = stage->count;
    const double *restrict y = stage->y, *restrict x = stage->x;
    double *restrict middle = stage->middle, *restrict rise = stage->rise, *restrict width = stage->width;
    double *restrict slope = stage->slope;
    for (size_t e = 0; e < count; e++) {
        middle[e] = (y[e] + y[e + 1]) / 2;
        rise[e] = y[e + 1] - y[e];
        width[e] = x[e + 1] - x[e];
        slope[e] = rise[e] / width[e];
    }
    double least = width[0];
    for (size_t e = 1; e < count; e++) {
        least = width[e] >= least ? least : width[e];
    }
    return least;
}

bool gm_elements_evaluate(struct gm_elements *stage, const struct gm_mesh *mesh)
{
    if (!(shape(stage) > 0)) {
        return false;
    }
    const size_t count = stage->count;
    mesh->potential->first(mesh->potential, stage->middle, stage->rise, count, stage->w, stage->w_m,
                           stage->w_r);
    const double *restrict u = stage->u, *restrict v = stage->v, *restrict width = stage->width;
    const double *restrict rise = stage->rise, *restrict slope = stage->slope;
    const double *restrict w = stage->w, *restrict w_m = stage->w_m, *restrict w_r = stage->w_r;
    double *restrict force_y0 = stage->force_y0, *restrict force_y1 = stage->force_y1;
    double *restrict force_d = stage->force_d;
    double *restrict momentum_u0 = stage->momentum_u0, *restrict momentum_u1 = stage->momentum_u1;
    double sum = 0;
    for (size_t e = 0; e < count; e++) {
        const double u0 = u[e], u1 = u[e + 1], v0 = v[e], v1 = v[e + 1], d = width[e], r = rise[e],
                     g = slope[e];
        const double a0 = 2 * u0 + u1, a1 = u0 + 2 * u1, b0 = 2 * v0 + v1, b1 = v0 + 2 * v1;
        const double kuu = (u0 * a0 + u1 * a1) / 2, kuv = u0 * b0 + u1 * b1, kvv = (v0 * b0 + v1 * b1) / 2;
        const double l_m = -d * w_m[e];
        const double l_r = (2 * g * kvv - kuv) * (1. / 6) - g - d * w_r[e];
        force_y0[e] = l_m / 2 - l_r;
        force_y1[e] = l_m / 2 + l_r;
        force_d[e] = (kuu - g * g * kvv) * (1. / 6) + g * g / 2 - w[e];
        momentum_u0[e] = (d * a0 - r * b0) * (1. / 6);
        momentum_u1[e] = (d * a1 - r * b1) * (1. / 6);
        sum += force_d[e];
    }
    return isfinite(sum);
}

/* q = sqrt(1 + curvature^2 (W'(y0)^2 + W'(y1)^2) / 2) with its derivatives by y0 and y1. */
struct bending {
    double q, by[2], twice[2][2];
};

static struct bending bending(const struct gm_mesh *mesh, const double y[2])
{
    const double square = mesh->curvature * mesh->curvature;
    double sum = 1, slope[2], bend[2];
    for (size_t i = 0; i < 2; i++) {
        double f[3];
        mesh->potential->force(mesh->potential, y[i], f);
        sum += square * f[0] * f[0] / 2;
        slope[i] = square * f[0] * f[1];
        bend[i] = square * (f[1] * f[1] + f[0] * f[2]);
    }
    struct bending made = {.q = sqrt(sum)};
    for (size_t i = 0; i < 2; i++) {
        made.by[i] = slope[i] / (2 * made.q);
    }
    for (size_t i = 0; i < 2; i++) {
        for (size_t k = 0; k < 2; k++) {
            made.twice[i][k] = (i == k ? bend[i] / (2 * made.q) : 0) - made.by[i] * made.by[k] / made.q;
        }
    }
    return made;
}

/* alpha^2 R with its derivatives by r and d. */
struct reach {
    double value, by_r, by_d, rr, rd, dd;
};

static struct reach limited(double square, double limit, double r, double d)
{
    /* s = d^2 + r^2 / steepest^2 */
    const double r2 = r * r, d2 = d * d, s = d2 + limit * r2;
    const double front = 2 * square / (s * s), last = front / s;
    return (struct reach){
        .value = square * r2 * d2 / s,
        .by_r = front * r * d2 * d2,
        .by_d = front * limit * d * r2 * r2,
        .rr = last * d2 * d2 * (d2 - 3 * limit * r2),
        .rd = 4 * last * limit * r2 * r * d2 * d,
        .dd = last * limit * r2 * r2 * (limit * r2 - 3 * d2),
    };
}

static struct reach tempered(double square, double limit, double r, double d)
{
    const double r2 = r * r, d2 = d * d, q = sqrt(1 + limit * r2 / d2), q3 = q * q * q;
    const double deep = limit * r2 * r2 / (d2 * (q + 1) * (q + 1));
    return (struct reach){
        .value = 2 * square * r2 / (q + 1),
        .by_r = 2 * square * r / q,
        .by_d = 2 * square * deep / (d * q),
        .rr = 2 * square / q3,
        .rd = 2 * square * limit * r2 * r / (d2 * d * q3),
        .dd = -2 * square * deep * (2 * q + 1) / (d2 * q3),
    };
}

static struct reach reach(const struct gm_mesh *mesh, double r, double d)
{
    const double square = mesh->alpha * mesh->alpha;
    if (mesh->reach == GM_REACH_FULL) {
        return (struct reach){.value = square * r * r, .by_r = 2 * square * r, .rr = 2 * square};
    }
    const double limit = 1 / (mesh->steepest * mesh->steepest);
    return mesh->reach == GM_REACH_LIMITED ? limited(square, limit, r, d) : tempered(square, limit, r, d);
}

/* Subtracts the regularisation from the part of ell that grows with the rise. */
static void regularise(struct gm_elements *stage, const struct gm_mesh *mesh)
{
    const double square = mesh->alpha * mesh->alpha;
    const double *u = stage->u, *v = stage->v;
    for (size_t e = 0; e < stage->count; e++) {
        const double d = stage->width[e], r = stage->rise[e], r_rate = u[e + 1] - u[e],
                     d_rate = v[e + 1] - v[e];
        const struct reach at = reach(mesh, r, d);
        const double by_r = at.by_r - 2 * square * r, rr = at.rr - 2 * square;
        stage->ell[e] += at.value - square * r * r;
        stage->ell_y1[e] += by_r;
        stage->ell_y0[e] -= by_r;
        stage->ell_d[e] += at.by_d;
        stage->rate[e] += by_r * r_rate + at.by_d * d_rate;
        stage->bend_y1[e] += rr * r_rate + at.rd * d_rate;
        stage->bend_y0[e] -= rr * r_rate + at.rd * d_rate;
        stage->bend_d[e] += at.rd * r_rate + at.dd * d_rate;
    }
}

void gm_elements_constrain(struct gm_elements *stage, const struct gm_mesh *mesh)
{
    const size_t count = stage->count;
    const double *restrict u = stage->u, *restrict v = stage->v, *restrict width = stage->width;
    const double *restrict rise = stage->rise;
    double *restrict ell = stage->ell, *restrict ell_y0 = stage->ell_y0, *restrict ell_y1 = stage->ell_y1;
    double *restrict ell_d = stage->ell_d, *restrict rate = stage->rate, *restrict bend_y0 = stage->bend_y0;
    double *restrict bend_y1 = stage->bend_y1, *restrict bend_d = stage->bend_d;
    const double square = mesh->alpha * mesh->alpha;
    for (size_t e = 0; e < count; e++) {
        const double d = width[e], r = rise[e], r_rate = u[e + 1] - u[e], d_rate = v[e + 1] - v[e];
        ell[e] = square * r * r + d * d;
        ell_y1[e] = 2 * square * r;
        ell_y0[e] = -ell_y1[e];
        ell_d[e] = 2 * d;
        rate[e] = 2 * (square * r * r_rate + d * d_rate);
        bend_y1[e] = 2 * square * r_rate;
        bend_y0[e] = -bend_y1[e];
        bend_d[e] = 2 * d_rate;
    }
    if (mesh->reach != GM_REACH_FULL) {
        regularise(stage, mesh);
    }
    if (mesh->curvature == 0) {
        return;
    }
    for (size_t e = 0; e < count; e++) {
        const struct bending bent = bending(mesh, &stage->y[e]);
        const double d = width[e], d_rate = v[e + 1] - v[e], u0 = u[e], u1 = u[e + 1];
        const double q_rate = bent.by[0] * u0 + bent.by[1] * u1;
        ell[e] += d * d * (bent.q - 1);
        ell_y0[e] += d * d * bent.by[0];
        ell_y1[e] += d * d * bent.by[1];
        ell_d[e] += 2 * d * (bent.q - 1);
        rate[e] += d * d * q_rate + 2 * d * (bent.q - 1) * d_rate;
        bend_y0[e] += d * d * (bent.twice[0][0] * u0 + bent.twice[0][1] * u1) + 2 * d * bent.by[0] * d_rate;
        bend_y1[e] += d * d * (bent.twice[1][0] * u0 + bent.twice[1][1] * u1) + 2 * d * bent.by[1] * d_rate;
        bend_d[e] += 2 * d * q_rate + 2 * (bent.q - 1) * d_rate;
    }
}

bool gm_elements_measure(struct gm_elements *stage, const struct gm_mesh *mesh)
{
    const bool good = shape(stage) > 0;
    gm_elements_constrain(stage, mesh);
    return good;
}

/* The symmetric form with these second derivatives by (m, r, d), carried over to z. */
static void spread(double mm, double mr, double md, double rr, double rd, double dd, double form[4][4])
{
    static const double to[3][4] = {{0.5, 0, 0.5, 0}, {-1, 0, 1, 0}, {0, -1, 0, 1}};
    const double core[3][3] = {{mm, mr, md}, {mr, rr, rd}, {md, rd, dd}};
    double half[3][4] = {{0}};
    for (size_t i = 0; i < 3; i++) {
        for (size_t k = 0; k < 3; k++) {
            for (size_t b = 0; b < 4; b++) {
                half[i][b] += core[i][k] * to[k][b];
            }
        }
    }
    for (size_t a = 0; a < 4; a++) {
        for (size_t b = 0; b < 4; b++) {
            form[a][b] = to[0][a] * half[0][b] + to[1][a] * half[1][b] + to[2][a] * half[2][b];
        }
    }
}

void gm_elements_mass(const struct gm_elements *stage, size_t e, double mass[4][4])
{
    const double d = stage->width[e], r = stage->rise[e], g = stage->slope[e];
    for (size_t i = 0; i < 2; i++) {
        for (size_t j = 0; j < 2; j++) {
            const double share = i == j ? 1. / 3 : 1. / 6;
            mass[2 * i][2 * j] = d * share;
            mass[2 * i][2 * j + 1] = mass[2 * i + 1][2 * j] = -r * share;
            mass[2 * i + 1][2 * j + 1] = r * g * share;
        }
    }
}

void gm_elements_gradient(const struct gm_elements *stage, size_t e, double gradient[4])
{
    gradient[0] = stage->ell_y0[e];
    gradient[1] = -stage->ell_d[e];
    gradient[2] = stage->ell_y1[e];
    gradient[3] = stage->ell_d[e];
}

void gm_elements_matrices(const struct gm_elements *stage, const struct gm_mesh *mesh, size_t e,
                          bool constrained, struct gm_element_matrices *matrices)
{
    const double d = stage->width[e], r = stage->rise[e], g = stage->slope[e];
    const double u[2] = {stage->u[e], stage->u[e + 1]}, v[2] = {stage->v[e], stage->v[e + 1]};
    const double kvv = v[0] * v[0] + v[0] * v[1] + v[1] * v[1], k = (kvv / 3 - 1) / d;
    double w_mm, w_mr, w_rr;
    mesh->potential->second(mesh->potential, stage->middle[e], r, &w_mm, &w_mr, &w_rr);
    spread(-d * w_mm, -d * w_mr, -stage->w_m[e], k - d * w_rr, -stage->w_r[e] - g * k, g * g * k,
           matrices->stiff);
    for (size_t i = 0; i < 2; i++) {
        const double a = (u[0] + u[1] + u[i]) / 6, b = (v[0] + v[1] + v[i]) / 6;
        const double by_r[2] = {-b, 2 * g * b - a}, by_d[2] = {a, -g * g * b};
        for (size_t which = 0; which < 2; which++) {
            double *row = matrices->mixed[2 * i + which];
            row[0] = -by_r[which];
            row[1] = -by_d[which];
            row[2] = by_r[which];
            row[3] = by_d[which];
        }
    }
    gm_elements_mass(stage, e, matrices->mass);
    if (!constrained) {
        return;
    }
    const struct reach ell = reach(mesh, r, d);
    spread(0, 0, 0, ell.rr, ell.rd, 2 + ell.dd, matrices->hessian);
    if (mesh->curvature != 0) {
        const struct bending bent = bending(mesh, &stage->y[e]);
        static const double sign[2] = {-1, 1};
        for (size_t i = 0; i < 2; i++) {
            for (size_t j = 0; j < 2; j++) {
                matrices->hessian[2 * i][2 * j] += d * d * bent.twice[i][j];
                matrices->hessian[2 * i][2 * j + 1] += 2 * d * bent.by[i] * sign[j];
                matrices->hessian[2 * i + 1][2 * j] += 2 * d * bent.by[j] * sign[i];
                matrices->hessian[2 * i + 1][2 * j + 1] += 2 * (bent.q - 1) * sign[i] * sign[j];
            }
        }
    }
    const double bend[4] = {stage->bend_y0[e], -stage->bend_d[e], stage->bend_y1[e], stage->bend_d[e]};
    gm_elements_gradient(stage, e, matrices->gradient);
    memcpy(matrices->bend, bend, sizeof bend);
}
