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
        &stage->momentum_u1, &stage->ell,      &stage->rate,
    };
    /* of the gradient, of bend, and of a density at all ends */
    const size_t of_density = mesh->density && mesh->density->local ? 2 * (3 + GM_DENSITY_VALUES) : 0;
    const size_t count = GM_COUNT(arrays), length = mesh->points + 2,
                 of_cells = mesh->cell ? 2 * GM_CELL_INPUTS + 3 : 0;
    *stage = (struct gm_elements){.count = mesh->points + 1};
    stage->memory =
        calloc((count + 8 + GM_DENSITY_OF_SLOPE + of_density + of_cells) * length, sizeof *stage->memory);
    if (!stage->memory) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        *arrays[i] = stage->memory + i * length;
    }
    for (size_t a = 0; a < 4; a++) {
        stage->gradient[a] = stage->memory + (count + a) * length;
        stage->bend[a] = stage->memory + (count + 4 + a) * length;
    }
    stage->density = stage->memory + (count + 8) * length;
    if (of_cells > 0) {
        stage->cells = stage->density + (GM_DENSITY_OF_SLOPE + of_density) * length;
        stage->cell_v0 = stage->cells + (2 * GM_CELL_INPUTS + 1) * length;
        stage->cell_v1 = stage->cell_v0 + length;
    }
    stage->ends = of_density ? stage->density + 2 * GM_DENSITY_VALUES * length : NULL;
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
    const double *y = stage->y, *x = stage->x, *width = stage->width;
    GM_NO_OVERLAP
    for (size_t e = 0; e < count; e++) {
        const double r = y[e + 1] - y[e], d = x[e + 1] - x[e];
        stage->middle[e] = (y[e] + y[e + 1]) / 2;
        stage->rise[e] = r;
        stage->width[e] = d;
        stage->slope[e] = r / d;
    }
    double least = width[0];
    for (size_t e = 1; e < count; e++) {
        least = width[e] >= least ? least : width[e];
    }
    return least;
}

static void cell_at(const struct gm_elements *stage, size_t e, double at[GM_CELL_INPUTS])
{
    at[0] = stage->width[e];
    at[1] = stage->v[e + 1] - stage->v[e];
    at[2] = (stage->v[e] + stage->v[e + 1]) / 2;
    at[3] = stage->slope[e];
}

/* Adds the cells' forces and momenta; their sum. */
static double add_cells(struct gm_elements *stage, const struct gm_mesh_cell *cell)
{
    const size_t count = stage->count;
    double *at = stage->cells, *by = at + (GM_CELL_INPUTS + 1) * count, one[GM_CELL_INPUTS], sum = 0;
    for (size_t e = 0; e < count; e++) {
        cell_at(stage, e, one);
        for (size_t i = 0; i < GM_CELL_INPUTS; i++) {
            at[i * count + e] = one[i];
        }
    }
    gm_tape_values(&cell->first, at, at + GM_CELL_INPUTS * count, count);
    for (size_t e = 0; e < count; e++) {
        const double pull = by[3 * count + e] / stage->width[e];
        stage->force_y1[e] += pull;
        stage->force_y0[e] -= pull;
        stage->force_d[e] += by[e] - stage->slope[e] * pull;
        stage->cell_v0[e] = by[2 * count + e] / 2 - by[count + e];
        stage->cell_v1[e] = by[2 * count + e] / 2 + by[count + e];
        sum += stage->force_d[e] + stage->cell_v0[e] + stage->cell_v1[e];
    }
    return sum;
}

bool gm_elements_evaluate(struct gm_elements *stage, const struct gm_mesh *mesh)
{
    if (!(shape(stage) > 0)) {
        return false;
    }
    const size_t count = stage->count;
    mesh->potential->first(mesh->potential, stage->middle, stage->rise, count, stage->w, stage->w_m,
                           stage->w_r);
    const double *u = stage->u, *v = stage->v;
    double sum = 0;
    GM_NO_OVERLAP
    for (size_t e = 0; e < count; e++) {
        const double u0 = u[e], u1 = u[e + 1], v0 = v[e], v1 = v[e + 1];
        const double d = stage->width[e], r = stage->rise[e], g = stage->slope[e];
        const double a0 = 2 * u0 + u1, a1 = u0 + 2 * u1, b0 = 2 * v0 + v1, b1 = v0 + 2 * v1;
        const double kuu = (u0 * a0 + u1 * a1) / 2, kuv = u0 * b0 + u1 * b1, kvv = (v0 * b0 + v1 * b1) / 2;
        const double l_m = -d * stage->w_m[e];
        const double l_r = (2 * g * kvv - kuv) * (1. / 6) - g - d * stage->w_r[e];
        const double l_d = (kuu - g * g * kvv) * (1. / 6) + g * g / 2 - stage->w[e];
        stage->force_y0[e] = l_m / 2 - l_r;
        stage->force_y1[e] = l_m / 2 + l_r;
        stage->force_d[e] = l_d;
        stage->momentum_u0[e] = (d * a0 - r * b0) * (1. / 6);
        stage->momentum_u1[e] = (d * a1 - r * b1) * (1. / 6);
        sum += l_d;
    }
    sum += mesh->cell ? add_cells(stage, mesh->cell) : 0;
    return isfinite(sum);
}

bool gm_elements_open_at(struct gm_elements *stage, const struct gm_mesh *mesh, const double *state)
{
    if (!gm_elements_open(stage, mesh)) {
        return false;
    }
    if (mesh->alone) {
        memcpy(stage->x + 1, state, mesh->points * sizeof *state);
        memcpy(stage->v + 1, state + mesh->points, mesh->points * sizeof *state);
    } else {
        gm_elements_place(stage, state);
    }
    return gm_elements_evaluate(stage, mesh);
}

/* Evaluates the density, or what the homotopy has in its place. */
static void weigh(struct gm_elements *stage, const struct gm_mesh *mesh)
{
    const struct gm_density *density = mesh->density;
    const size_t count = stage->count, size = count * sizeof(double), m = density->local ? 2 * count : count,
                 values = (density->local ? GM_DENSITY_VALUES : GM_DENSITY_OF_SLOPE) * m;
    const double *const at_ends[] = {stage->slope, stage->slope, stage->y,
                                     stage->y + 1, stage->x,     stage->x + 1};
    for (size_t i = 0; density->local && i < GM_COUNT(at_ends); i++) {
        memcpy(stage->ends + i * count, at_ends[i], size);
    }
    density->values(density, density->local ? stage->ends : stage->slope, stage->density, m);
    const double share = (1 - mesh->even) / mesh->level;
    for (size_t i = 0; share != 1 && i < values; i++) {
        stage->density[i] = share * stage->density[i] + (i < m ? mesh->even : 0);
    }
}

/* The parts of the derivatives of ell that one end has alone: by (y, X) there, by these and r or d, and twice
   by these. */
struct end {
    double by[2], by_r[2], by_d[2], twice[2][2];
};

static inline struct end end_of(const struct gm_elements *stage, size_t e, size_t side)
{
    const size_t count = 2 * stage->count;
    const double *P = stage->density + side * stage->count + e;
    const double d = stage->width[e], half = d * d / 2, g = stage->slope[e] / 2;
    const double s[2] = {P[GM_P_SU * count], P[GM_P_SX * count]};
    return (struct end){
        .by = {half * P[GM_P_U * count], half * P[GM_P_X * count]},
        .by_r = {d / 2 * s[0], d / 2 * s[1]},
        .by_d = {d * (P[GM_P_U * count] - g * s[0]), d * (P[GM_P_X * count] - g * s[1])},
        .twice = {{half * P[GM_P_UU * count], half * P[GM_P_UX * count]},
                  {half * P[GM_P_UX * count], half * P[GM_P_XX * count]}},
    };
}

/* It is compiled for each kind of density. */
static inline __attribute__((always_inline)) void constrain(struct gm_elements *stage, bool local)
{
    /* values at the other end lie `far` behind those at one: a constant 0 if they are the same */
    const size_t count = stage->count, far = local ? count : 0, m = count + far;
    const double *P = stage->density, *u = stage->u, *v = stage->v;
    GM_NO_OVERLAP
    for (size_t e = 0; e < count; e++) {
        const double d = stage->width[e], g = stage->slope[e], z[4] = {u[e], v[e], u[e + 1], v[e + 1]},
                     r_rate = z[2] - z[0], d_rate = z[3] - z[1];
        const double sum = P[e] + P[far + e], s = (P[m + e] + P[m + far + e]) / 2,
                     rr = (P[2 * m + e] + P[2 * m + far + e]) / 2;
        const double rd = s - g * rr, dd = sum - g * (s + rd), by_r = d * s, by_d = d * (sum - g * s);
        double rate = by_r * r_rate + by_d * d_rate, bend_r = rr * r_rate + rd * d_rate,
               bend_d = rd * r_rate + dd * d_rate, by[4] = {-by_r, -by_d, by_r, by_d}, bend[4] = {0};
        if (local) {
#pragma GCC unroll 4
            for (size_t a = 0; a < 4; a++) {
                const struct end end = end_of(stage, e, a / 2);
                const size_t c = a % 2;
                by[a] += end.by[c];
                rate += end.by[c] * z[a];
                bend_r += end.by_r[c] * z[a];
                bend_d += end.by_d[c] * z[a];
                bend[a] = end.by_r[c] * r_rate + end.by_d[c] * d_rate + end.twice[c][0] * z[a - c] +
                          end.twice[c][1] * z[a - c + 1];
            }
        }
        stage->ell[e] = d * d * (sum / 2);
        stage->rate[e] = rate;
        for (size_t a = 0; a < 4; a++) {
            const double along = a % 2 == 0 ? bend_r : bend_d;
            stage->gradient[a][e] = by[a];
            stage->bend[a][e] = a < 2 ? bend[a] - along : bend[a] + along;
        }
    }
}

void gm_elements_constrain(struct gm_elements *stage, const struct gm_mesh *mesh)
{
    weigh(stage, mesh);
    if (mesh->density->local) {
        constrain(stage, true);
    } else {
        constrain(stage, false);
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

static void bend_of_ell(const struct gm_elements *stage, const struct gm_mesh *mesh, size_t e,
                        double hessian[4][4])
{
    static const double sign[2] = {-1, 1};
    const size_t far = mesh->density->local ? stage->count : 0, m = stage->count + far;
    const double *P = stage->density + e, g = stage->slope[e];
    const double sum = P[0] + P[far], s = (P[m] + P[m + far]) / 2, rr = (P[2 * m] + P[2 * m + far]) / 2;
    spread(0, 0, 0, rr, s - g * rr, sum - g * (2 * s - g * rr), hessian);
    for (size_t side = 0; far > 0 && side < 2; side++) {
        const struct end end = end_of(stage, e, side);
        for (size_t c = 0; c < 2; c++) {
            const size_t a = 2 * side + c;
            for (size_t b = 0; b < 2; b++) {
                hessian[a][2 * side + b] += end.twice[c][b];
                hessian[a][2 * b] += sign[b] * end.by_r[c];
                hessian[2 * b][a] += sign[b] * end.by_r[c];
                hessian[a][2 * b + 1] += sign[b] * end.by_d[c];
                hessian[2 * b + 1][a] += sign[b] * end.by_d[c];
            }
        }
    }
}

/* Adds the second derivatives of the cell's Lagrangian, of which d, d_t, m_t are linear in z and zdot. */
static void add_cell(const struct gm_elements *stage, const struct gm_mesh_cell *cell, size_t e,
                     struct gm_element_matrices *matrices)
{
    static const double width[4] = {0, -1, 0, 1}, middle[4] = {0, 0.5, 0, 0.5};
    const double d = stage->width[e], g = stage->slope[e],
                 *by = stage->cells + (GM_CELL_INPUTS + 1) * stage->count;
    const double slope[4] = {-1 / d, g / d, 1 / d, -g / d}, pull = by[3 * stage->count + e] / (d * d);
    double at[GM_CELL_INPUTS], of[4][4], bent[4][4];
    cell_at(stage, e, at);
    gm_tape_values(&cell->second, at, of[0], 1);
    spread(0, 0, 0, 0, -pull, 2 * g * pull, bent); /* LC_s times the second derivatives of the slope */
    for (size_t a = 0; a < 4; a++) {
        for (size_t b = 0; b < 4; b++) {
            matrices->mass[a][b] += width[a] * (of[1][1] * width[b] + of[1][2] * middle[b]) +
                                    middle[a] * (of[1][2] * width[b] + of[2][2] * middle[b]);
            matrices->mixed[a][b] += width[a] * (of[1][0] * width[b] + of[1][3] * slope[b]) +
                                     middle[a] * (of[2][0] * width[b] + of[2][3] * slope[b]);
            matrices->stiff[a][b] += width[a] * (of[0][0] * width[b] + of[0][3] * slope[b]) +
                                     slope[a] * (of[3][0] * width[b] + of[3][3] * slope[b]) + bent[a][b];
        }
    }
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
    if (mesh->cell) {
        add_cell(stage, mesh->cell, e, matrices);
    }
    if (!constrained) {
        return;
    }
    bend_of_ell(stage, mesh, e, matrices->hessian);
    for (size_t a = 0; a < 4; a++) {
        matrices->gradient[a] = stage->gradient[a][e];
        matrices->bend[a] = stage->bend[a][e];
    }
}
