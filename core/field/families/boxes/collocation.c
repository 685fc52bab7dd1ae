/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gauss-Legendre collocation on a ring of cells for M s_t + K s_x = grad S(s), M and K skew, of any rank.
   With the tableau (A, b, c) of r stages across a cell and as many across a step, s = Z_jm at stage j in time
   and m in space,
       M T_jm + K X_jm = grad S(Z_jm)
       T_jm = sum_k (A^-1)_jk (Z_km - s_m)/dt       X_jm = sum_l (A^-1)_ml (Z_jl - y_j)/dx
       s_m+ = (1 - rho) s_m + sum_k w_k Z_km        y_j+ = (1 - rho) y_j + sum_l w_l Z_jl
       w = b' A^-1,   rho = b' A^-1 1
   s_m before and s_m+ after the step, y_j on the left side of the cell and y_j+ on its right one, which is
   the left one of the next. Of s only M s counts, of y only K y, so that y is kept in a basis of the range of
   K.

   The unknowns of a cell, Z, are eliminated from its equations with exchanges of rows, which leave equations
   between the y of neighbours: a block for the left and one for the right side, folded to a band. With S'' =
   S''(0) this is the same in every cell, and made once. The equations are iterated with it, or by Newton's
   method if that is slow. */
#include "core/field/families/boxes/collocation.h"

#include <complex.h>
#include <math.h>
#include <string.h>

#include "core/basics.h"
#include "core/linear/iteration.h"
#include "core/scheme.h"

/* ---- the workspace ---- */

/* Returns NULL when out of memory; leaves the body while a workspace is opened. */
static double *take(const struct gm_collocation *work, size_t count)
{
    return gm_arena_take(work->arena, count, sizeof(double));
}

static bool open_factors(const struct gm_collocation *work, struct gm_collocation_factors *factors,
                         bool shared)
{
    const size_t rows = work->stages + work->sides, columns = rows + work->sides;
    const size_t cells = shared ? 1 : work->points;
    if (!factors->opened) {
        factors->shared = shared;
        factors->cells = take(work, cells * rows * columns);
        factors->pivots = gm_arena_take(work->arena, cells * work->stages, sizeof *factors->pivots);
        factors->scales = take(work, cells * work->sides);
        factors->opened = factors->cells && factors->pivots && factors->scales &&
                          gm_ring_band_open(&factors->sides, work->points, work->sides, 1);
    }
    return factors->opened;
}

void gm_collocation_close(void *workspace)
{
    struct gm_collocation *work = workspace;
    struct gm_collocation_factors *const factors[] = {&work->constant, &work->newton};
    for (size_t i = 0; i < GM_COUNT(factors); i++) {
        if (factors[i]->opened) {
            gm_ring_band_close(&factors[i]->sides);
        }
    }
    gm_arena_close(work->arena);
}

/* An orthonormal basis of the range of K, from its longest rows on, by Gram and Schmidt; potentials come
   first, each by itself. */
static void find_range(struct gm_collocation *work, const struct gm_form *form)
{
    const size_t d = work->d;
    const double *k = form->k;
    double rows[GM_MOST_OF_FORM][GM_MOST_OF_FORM], largest = 0;
    bool first[GM_MOST_OF_FORM] = {false};
    for (size_t p = 0; p < form->potential_count; p++) {
        first[form->potentials[p].row] = true;
    }
    for (size_t i = 0; i < d; i++) {
        for (size_t j = 0; j < d; j++) {
            rows[i][j] = k[i * d + j];
            largest = fmax(largest, fabs(rows[i][j]));
        }
    }
    for (work->rank = 0; work->rank < d; work->rank++) {
        size_t longest = 0;
        double square = 0;
        for (size_t i = 0; i < 2 * d; i++) {
            double sum = 0;
            for (size_t j = 0; j < d; j++) {
                sum += rows[i % d][j] * rows[i % d][j];
            }
            if (first[i % d] == (i < d) && sum > square && (i < d || square <= 1e-24 * largest * largest)) {
                longest = i % d;
                square = sum;
            }
        }
        if (!(sqrt(square) > 1e-12 * largest)) {
            break;
        }
        double unit[GM_MOST_OF_FORM];
        for (size_t j = 0; j < d; j++) {
            unit[j] = rows[longest][j] / sqrt(square);
            work->basis[j][work->rank] = unit[j];
        }
        for (size_t i = 0; i < d; i++) {
            double along = 0;
            for (size_t j = 0; j < d; j++) {
                along += rows[i][j] * unit[j];
            }
            for (size_t j = 0; j < d; j++) {
                rows[i][j] -= along * unit[j];
            }
        }
    }
    for (size_t i = 0; i < d; i++) {
        for (size_t a = 0; a < work->rank; a++) {
            for (size_t j = 0; j < d; j++) {
                work->slopes[i][a] += k[i * d + j] * work->basis[j][a];
            }
        }
    }
}

/* The sides of potentials, each of which is one vector of the basis that has no other component. */
static void find_held(struct gm_collocation *work, const struct gm_form *form)
{
    for (size_t at = 0; at < form->potential_count * work->r; at++) {
        const double *row = work->basis[form->potentials[at / work->r].component];
        size_t place = 0;
        for (size_t a = 0; a < work->rank; a++) {
            place = fabs(row[a]) > fabs(row[place]) ? a : place;
        }
        work->held[work->held_count++] = at % work->r * work->rank + place;
    }
}

static void invert(struct gm_collocation *work)
{
    enum { MOST = GM_COLLOCATION_STAGES * GM_COLLOCATION_STAGES };
    const size_t r = work->r;
    double a[MOST], inverse[MOST] = {0};
    for (size_t i = 0; i < r; i++) {
        memcpy(a + i * r, work->tableau->a[i], r * sizeof *a);
        inverse[i * r + i] = 1;
    }
    gm_eliminate_columns(r, a, r, inverse);
    work->rest = 1;
    for (size_t i = 0; i < r; i++) {
        for (size_t j = 0; j < r; j++) {
            work->inverse[i][j] = inverse[j * r + i];
            work->sums[i] += inverse[j * r + i];
            work->weights[j] += work->tableau->b[i] * inverse[j * r + i];
            work->rest -= work->tableau->b[i] * inverse[j * r + i];
        }
    }
    /* 1 - rho is (-1)^r, and has to be that to the last digit */
    work->rest = round(work->rest);
}

static void close_fourier(void *fourier)
{
    gm_fourier_close(fourier);
}

static void open_arrays(struct gm_arena *arena, void *data)
{
    struct gm_collocation *work = data;
    const size_t points = work->points, level = work->d * work->r * points;
    const size_t stages = work->stages * points, sides = work->sides * points;
    work->low = take(work, level);
    work->high = take(work, level);
    work->z = take(work, stages);
    work->first_z = take(work, stages);
    work->y = take(work, sides);
    work->first_y = take(work, sides);
    for (size_t k = 0; k < GM_COLLOCATION_PAST; k++) {
        work->past_z[k] = take(work, stages);
        work->past_y[k] = take(work, sides);
    }
    work->gradient = take(work, stages);
    work->hessian = take(work, work->d * stages);
    work->right = take(work, stages + sides);
    work->scratch = take(work, sides + 2 * points);
    work->waves = gm_arena_take(arena, work->r * points, sizeof *work->waves);
    work->fourier = gm_arena_keep(arena, gm_fourier_open(points), close_fourier);
    /* a run needs these, or its numbers would depend on memory; the factors of Newton's method are many */
    if (gm_field_of(work->problem)->form->potential_count == 0 &&
        !open_factors(work, &work->constant, true)) {
        gm_arena_leave(arena);
    }
}

void *gm_collocation_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_field *field = gm_field_of(problem);
    const struct gm_form *form = field->form;
    struct gm_arena *arena = gm_arena_open();
    struct gm_collocation *work = arena ? gm_arena_take(arena, 1, sizeof *work) : NULL;
    if (!work) {
        gm_arena_close(arena);
        return NULL;
    }
    work->arena = arena;
    work->problem = problem;
    work->tableau = scheme->coefficients;
    work->points = problem->line.points;
    work->d = form->dimension;
    work->state = field->wave ? 1 : work->d;
    work->r = work->tableau->r;
    work->jump[0] = problem->line.jump;
    for (size_t c = 0; form->jump && c < work->d; c++) {
        work->jump[c] = form->jump[c];
    }
    find_range(work, form);
    find_held(work, form);
    invert(work);
    work->stages = work->d * work->r * work->r;
    work->sides = work->r * work->rank;
    if (!gm_arena_run(arena, open_arrays, work)) {
        gm_arena_close(arena);
        return NULL;
    }
    return work;
}

/* ---- the equations ---- */

/* grad S of s = (u, v, w) is (V', v, -w) for a wave, whose form does not state it at many points. */
void gm_collocation_gradients(const struct gm_collocation *work, const double *s, double *gradient,
                              size_t count)
{
    const struct gm_field *field = gm_field_of(work->problem);
    if (!field->wave) {
        field->form->gradients(work->problem->parameters, s, gradient, count);
        return;
    }
    field->wave->slopes(work->problem, s, gradient, count);
    memcpy(gradient + count, s + count, count * sizeof *s);
    for (size_t i = 2 * count; i < 3 * count; i++) {
        gradient[i] = -s[i];
    }
}

static void find_hessians(const struct gm_collocation *work, const double *s, double *hessian, size_t count)
{
    const struct gm_field *field = gm_field_of(work->problem);
    if (!field->wave) {
        field->form->hessians(work->problem->parameters, s, hessian, count);
        return;
    }
    memset(hessian, 0, 9 * count * sizeof *hessian);
    for (size_t i = 0; i < count; i++) {
        hessian[i] = field->wave->curvature(work->problem, s[i]);
        hessian[4 * count + i] = 1;
        hessian[8 * count + i] = -1;
    }
}

/* to += factor from */
GM_CLONES static void add(double *restrict to, const double *restrict from, double factor, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        to[i] += factor * from[i];
    }
}

/* to += factor times `from` of the next cell; after the last cell comes the first, plus the jump */
static void add_next(double *restrict to, const double *restrict from, double factor, double jump,
                     size_t points)
{
    add(to, from + 1, factor, points - 1);
    to[points - 1] += factor * (from[0] + jump);
}

static const double *stage_of(const struct gm_collocation *work, const double *z, size_t c, size_t j,
                              size_t m)
{
    return z + ((c * work->r + j) * work->r + m) * work->points;
}

static double *row_of(const struct gm_collocation *work, size_t c, size_t j, size_t m)
{
    return work->right + ((c * work->r + j) * work->r + m) * work->points;
}

/* The factor that makes equations of sides as large as the equations of stages. */
static double weight_of_sides(const struct gm_collocation *work)
{
    return 1 / work->problem->line.dx;
}

static double jump_of(const struct gm_collocation *work, size_t a)
{
    double sum = 0;
    for (size_t c = 0; c < work->d; c++) {
        sum += work->basis[c][a] * work->jump[c];
    }
    return sum;
}

/* right := grad S - M T - K X, and what closes the sides; with work->gradient as the gradient. */
static void find_right(struct gm_collocation *work, double dt, bool tangent)
{
    const struct gm_form *form = gm_field_of(work->problem)->form;
    const size_t points = work->points, d = work->d, r = work->r;
    const double dx = work->problem->line.dx;
    memcpy(work->right, work->gradient, work->stages * points * sizeof(double));
    for (size_t c = 0; c < d; c++) {
        for (size_t row = 0; row < r * r; row++) {
            const size_t j = row / r, m = row % r;
            double *to = row_of(work, c, j, m);
            for (size_t e = 0; e < d; e++) {
                const double in_time = form->m[c * d + e] / dt, in_space = form->k[c * d + e] / dx;
                for (size_t k = 0; k < r && in_time != 0; k++) {
                    add(to, stage_of(work, work->z, e, k, m), -in_time * work->inverse[j][k], points);
                }
                if (in_time != 0) {
                    add(to, work->low + (e * r + m) * points, in_time * work->sums[j], points);
                }
                for (size_t l = 0; l < r && in_space != 0; l++) {
                    add(to, stage_of(work, work->z, e, j, l), -in_space * work->inverse[m][l], points);
                }
            }
            for (size_t a = 0; a < work->rank; a++) {
                if (work->slopes[c][a] != 0) {
                    add(to, work->y + (j * work->rank + a) * points, work->slopes[c][a] * work->sums[m] / dx,
                        points);
                }
            }
        }
    }
    const double weight = weight_of_sides(work);
    for (size_t j = 0; j < r; j++) {
        for (size_t a = 0; a < work->rank; a++) {
            const double *y = work->y + (j * work->rank + a) * points;
            double *to = work->right + (work->stages + j * work->rank + a) * points;
            memset(to, 0, points * sizeof *to);
            add_next(to, y, -weight, tangent ? 0 : jump_of(work, a), points);
            add(to, y, weight * work->rest, points);
            for (size_t c = 0; c < d; c++) {
                for (size_t l = 0; l < r && work->basis[c][a] != 0; l++) {
                    add(to, stage_of(work, work->z, c, j, l), weight * work->weights[l] * work->basis[c][a],
                        points);
                }
            }
        }
    }
}

/* The matrix of a cell's equations but for S'', rows as those of `right`, columns its stages, the left y, the
   right y. */
static void cell_matrix(const struct gm_collocation *work, double dt, double *matrix)
{
    const struct gm_form *form = gm_field_of(work->problem)->form;
    const size_t d = work->d, r = work->r, q = r * r, rank = work->rank, stages = work->stages;
    const size_t columns = stages + 2 * work->sides;
    const double dx = work->problem->line.dx, weight = weight_of_sides(work);
    memset(matrix, 0, (stages + work->sides) * columns * sizeof *matrix);
    for (size_t c = 0; c < d; c++) {
        for (size_t at = 0; at < q; at++) {
            const size_t j = at / r, m = at % r;
            double *row = matrix + (c * q + at) * columns;
            for (size_t e = 0; e < d; e++) {
                for (size_t k = 0; k < r; k++) {
                    row[e * q + k * r + m] += form->m[c * d + e] * work->inverse[j][k] / dt;
                    row[e * q + j * r + k] += form->k[c * d + e] * work->inverse[m][k] / dx;
                }
            }
            for (size_t a = 0; a < rank; a++) {
                row[stages + j * rank + a] = -work->slopes[c][a] * work->sums[m] / dx;
            }
        }
    }
    for (size_t j = 0; j < r; j++) {
        for (size_t a = 0; a < rank; a++) {
            double *row = matrix + (stages + j * rank + a) * columns;
            row[stages + work->sides + j * rank + a] = weight;
            row[stages + j * rank + a] = -weight * work->rest;
            for (size_t c = 0; c < d; c++) {
                for (size_t l = 0; l < r; l++) {
                    row[c * q + j * r + l] = -weight * work->weights[l] * work->basis[c][a];
                }
            }
        }
    }
}

static void subtract_hessian(const struct gm_collocation *work, const double *hessian, double *matrix)
{
    const size_t d = work->d, q = work->r * work->r, columns = work->stages + 2 * work->sides;
    for (size_t row = 0; row < work->stages; row++) {
        for (size_t e = 0; e < d; e++) {
            matrix[row * columns + e * q + row % q] -=
                hessian[((row / q * d + e) * q + row % q) * work->points];
        }
    }
}

/* The constant of a potential is free, and its closure around the ring follows from the other equations.
   Instead of that equation, the first side in the last cell keeps the guess. */
static void hold_potentials(const struct gm_collocation *work, double *matrix)
{
    const size_t columns = work->stages + 2 * work->sides;
    for (size_t h = 0; h < work->held_count; h++) {
        double *row = matrix + (work->stages + work->held[h]) * columns;
        memset(row, 0, columns * sizeof *row);
        row[work->stages + work->sides + work->held[h]] = weight_of_sides(work);
    }
}

static void hold_right(struct gm_collocation *work)
{
    for (size_t h = 0; h < work->held_count; h++) {
        work->right[(work->stages + work->held[h]) * work->points + work->points - 1] = 0;
    }
}

/* Eliminates the stages in place, with the factors below the diagonal. Returns false if they are not
   determined. */
static bool eliminate(const struct gm_collocation *work, double *matrix, size_t *pivots)
{
    const size_t rows = work->stages + work->sides, columns = rows + work->sides;
    for (size_t p = 0; p < work->stages; p++) {
        size_t best = p;
        for (size_t i = p + 1; i < rows; i++) {
            best = fabs(matrix[i * columns + p]) > fabs(matrix[best * columns + p]) ? i : best;
        }
        double *pivot = matrix + p * columns;
        pivots[p] = best;
        for (size_t j = p; j < columns && best != p; j++) { /* factors stay in the order of their exchanges */
            const double held = pivot[j];
            pivot[j] = matrix[best * columns + j];
            matrix[best * columns + j] = held;
        }
        if (!isfinite(pivot[p]) || pivot[p] == 0) {
            return false;
        }
        for (size_t i = p + 1; i < rows; i++) {
            double *row = matrix + i * columns;
            if (row[p] != 0) {
                const double factor = row[p] /= pivot[p];
                for (size_t j = p + 1; j < columns; j++) {
                    row[j] -= factor * pivot[j];
                }
            }
        }
    }
    return true;
}

/* Makes the recursions of the blocks of the sides. Returns false if a band solves them better. */
static bool make_blocks(const struct gm_collocation *work, struct gm_collocation_factors *factors)
{
    const size_t sides = work->sides, columns = work->stages + 2 * sides;
    double left[GM_RING_BLOCKS_MOST * GM_RING_BLOCKS_MOST], right[GM_RING_BLOCKS_MOST * GM_RING_BLOCKS_MOST];
    if (sides > GM_RING_BLOCKS_MOST) {
        return false;
    }
    for (size_t a = 0; a < sides; a++) {
        const double *row = factors->cells + (work->stages + a) * columns + work->stages;
        for (size_t b = 0; b < sides; b++) {
            left[a * sides + b] = factors->scales[a] * row[b];
            right[a * sides + b] = factors->scales[a] * row[sides + b];
        }
    }
    return gm_ring_blocks_make(&factors->blocks, work->points, sides, left, right);
}

/* S'' at all stages is in work->hessian; of `shared` ones at one point. */
static bool factor(struct gm_collocation *work, struct gm_collocation_factors *factors, bool shared,
                   double dt)
{
    const size_t rows = work->stages + work->sides, columns = rows + work->sides;
    if (!open_factors(work, factors, shared)) {
        return false;
    }
    /* the last cell holds the matrix that all cells share until its own turn */
    double *const last = factors->cells + (shared ? 0 : work->points - 1) * rows * columns;
    cell_matrix(work, dt, last);
    gm_ring_band_clear(&factors->sides);
    factors->good = true;
    for (size_t i = 0; i < work->points && factors->good; i++) {
        const size_t place = shared ? 0 : i;
        double *matrix = factors->cells + place * rows * columns;
        if (!shared || i == 0) {
            if (matrix != last) {
                memcpy(matrix, last, rows * columns * sizeof *last);
            }
            subtract_hessian(work, work->hessian + place, matrix);
            if (!shared && i + 1 == work->points) {
                hold_potentials(work, matrix);
            }
            factors->good = eliminate(work, matrix, factors->pivots + place * work->stages);
        }
        for (size_t a = 0; a < work->sides && factors->good; a++) {
            const double *row = matrix + (work->stages + a) * columns + work->stages;
            double most = 0;
            for (size_t b = 0; b < 2 * work->sides; b++) {
                most = fmax(most, fabs(row[b]));
            }
            const double scale = factors->scales[place * work->sides + a] = most > 0 ? 1 / most : 1;
            for (size_t b = 0; b < work->sides; b++) {
                gm_ring_band_add(&factors->sides, i, a, 0, b, scale * row[b]);
                gm_ring_band_add(&factors->sides, i, a, 1, b, scale * row[work->sides + b]);
            }
        }
    }
    factors->recursive = shared && factors->good && make_blocks(work, factors);
    factors->good = factors->good && (factors->recursive || gm_ring_band_factor(&factors->sides));
    return factors->good;
}

GM_CLONES static void exchange(double *restrict a, double *restrict b, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const double held = a[i];
        a[i] = b[i];
        b[i] = held;
    }
}

/* right := the changes of stages and of sides; all cells have one matrix */
static void solve_shared(struct gm_collocation *work, struct gm_collocation_factors *factors)
{
    const size_t points = work->points, stages = work->stages, sides = work->sides;
    const size_t rows = stages + sides, columns = rows + sides;
    double *const right = work->right, *const y = right + stages * points;
    for (size_t p = 0; p < stages; p++) {
        if (factors->pivots[p] != p) {
            exchange(right + p * points, right + factors->pivots[p] * points, points);
        }
        for (size_t i = p + 1; i < rows; i++) {
            if (factors->cells[i * columns + p] != 0) {
                add(right + i * points, right + p * points, -factors->cells[i * columns + p], points);
            }
        }
    }
    for (size_t a = 0; a < sides; a++) {
        for (size_t i = 0; i < points; i++) {
            y[a * points + i] *= factors->scales[a];
        }
    }
    if (factors->recursive) {
        gm_ring_blocks_solve(&factors->blocks, y, work->scratch);
    } else {
        gm_ring_band_solve(&factors->sides, y);
    }
    for (size_t p = stages; p-- > 0;) {
        const double *row = factors->cells + p * columns, over = 1 / row[p];
        double *to = right + p * points;
        for (size_t e = p + 1; e < stages; e++) {
            if (row[e] != 0) {
                add(to, right + e * points, -row[e], points);
            }
        }
        for (size_t b = 0; b < sides; b++) {
            if (row[stages + b] != 0) {
                add(to, y + b * points, -row[stages + b], points);
            }
            if (row[rows + b] != 0) {
                add_next(to, y + b * points, -row[rows + b], 0, points);
            }
        }
        for (size_t i = 0; i < points; i++) {
            to[i] *= over;
        }
    }
}

static void solve_each(struct gm_collocation *work, struct gm_collocation_factors *factors)
{
    const size_t points = work->points, stages = work->stages, sides = work->sides;
    const size_t rows = stages + sides, columns = rows + sides;
    double *const right = work->right, *const y = right + stages * points;
    hold_right(work);
    for (size_t i = 0; i < points; i++) {
        const double *matrix = factors->cells + i * rows * columns;
        for (size_t p = 0; p < stages; p++) {
            const size_t other = factors->pivots[i * stages + p];
            const double value = right[other * points + i];
            right[other * points + i] = right[p * points + i];
            right[p * points + i] = value;
            for (size_t k = p + 1; k < rows; k++) {
                right[k * points + i] -= matrix[k * columns + p] * value;
            }
        }
        for (size_t a = 0; a < sides; a++) {
            y[a * points + i] *= factors->scales[i * sides + a];
        }
    }
    gm_ring_band_solve(&factors->sides, y);
    for (size_t i = 0; i < points; i++) {
        const double *matrix = factors->cells + i * rows * columns;
        const size_t next = i + 1 < points ? i + 1 : 0;
        for (size_t p = stages; p-- > 0;) {
            const double *row = matrix + p * columns;
            double value = right[p * points + i];
            for (size_t e = p + 1; e < stages; e++) {
                value -= row[e] * right[e * points + i];
            }
            for (size_t b = 0; b < sides; b++) {
                value -= row[stages + b] * y[b * points + i] + row[rows + b] * y[b * points + next];
            }
            right[p * points + i] = value / row[p];
        }
    }
}

/* The largest magnitude; NAN if one is not finite. */
GM_CLONES static double largest(const double *values, size_t count)
{
    double most[8] = {0}, none[8] = {0};
    size_t i = 0;
    for (; i + 8 <= count; i += 8) {
        for (size_t k = 0; k < 8; k++) {
            const double size = fabs(values[i + k]);
            none[k] += size * 0;
            most[k] = size > most[k] ? size : most[k];
        }
    }
    for (; i < count; i++) {
        none[0] += values[i] * 0;
        most[0] = fmax(most[0], fabs(values[i]));
    }
    for (size_t k = 1; k < 8; k++) {
        none[0] += none[k];
        most[0] = fmax(most[0], most[k]);
    }
    return none[0] == 0 ? most[0] : NAN;
}

/* ---- a step ---- */

/* S''(0), which all cells share */
static bool make_constant(struct gm_collocation *work, double dt)
{
    const struct gm_form *form = gm_field_of(work->problem)->form;
    const size_t d = work->d, q = work->r * work->r;
    const double zero[GM_MOST_OF_FORM] = {0};
    double hessian[GM_MOST_OF_FORM * GM_MOST_OF_FORM];
    if (work->constant_dt != dt) {
        work->constant_dt = dt;
        /* the last cell of a potential is not as the others */
        work->constant.good = form->potential_count == 0;
        find_hessians(work, zero, hessian, 1);
        for (size_t i = 0; i < d * d; i++) {
            work->constant.good &= isfinite(hessian[i]);
            for (size_t at = 0; at < q; at++) {
                work->hessian[(i * q + at) * work->points] = hessian[i];
            }
        }
        work->constant.good = work->constant.good && factor(work, &work->constant, true, dt);
    }
    return work->constant.good;
}

static void add_changes(struct gm_collocation *work)
{
    add(work->z, work->right, 1, work->stages * work->points);
    add(work->y, work->right + work->stages * work->points, 1, work->sides * work->points);
}

/* Makes one iteration. Returns the largest change of a stage, NAN if one is not finite. */
static double iterate(struct gm_collocation *work, double dt, bool newton, bool anew, double *left,
                      struct gm_progress *progress)
{
    const size_t points = work->points, q = work->r * work->r;
    gm_collocation_gradients(work, work->z, work->gradient, q * points);
    find_right(work, dt, false);
    progress->evaluations++;
    progress->iterations++;
    progress->solves++;
    if (left) {
        *left = largest(work->right, (work->stages + work->sides) * points);
    }
    if (newton) {
        if (anew) {
            find_hessians(work, work->z, work->hessian, q * points);
            if (!factor(work, &work->newton, false, dt)) {
                return NAN;
            }
        }
        solve_each(work, &work->newton);
    } else {
        solve_shared(work, &work->constant);
    }
    add_changes(work);
    return largest(work->right, work->stages * points);
}

/* Iterates with S''(0), or by Newton's method, whose matrix stays as long as it serves. */
static enum gm_status solve(struct gm_collocation *work, double dt, bool newton, struct gm_progress *progress)
{
    enum { MOST = 60 };
    const size_t count = work->stages * work->points;
    const double least = 1e-3, dx = work->problem->line.dx;
    const double size = fmax(largest(work->z, count), least), terms = size * (1 / fabs(dt) + 1 / dx);
    double last = INFINITY, left = 0;
    bool anew = true;
    for (int k = 0; k < MOST; k++) {
        const bool near = last <= 1e-7 * size;
        const double change = iterate(work, dt, newton, anew, near ? &left : NULL, progress);
        if (!isfinite(change)) {
            return GM_NO_CONVERGENCE;
        }
        /* the change by further iterations, if they contract like the last one */
        const double rate = change / last, rest = k > 0 && rate < 0.5 ? change * rate / (1 - rate) : INFINITY;
        /* or what is left of the equations is rounding: a component without a rate still moves by 1/dt of
           that */
        const bool still = change >= last / 4 && (change <= 1e-11 * size || (near && left <= 1e-13 * terms));
        if (rest <= 5e-17 * size || still) {
            /* a potential that does not close leaves the equation in whose place its constant was held */
            return near && left > 1e-5 * terms ? GM_NO_CONVERGENCE : GM_OK;
        }
        if ((!newton && change > last / 4) || (k > 20 && change > last)) {
            return GM_NO_CONVERGENCE;
        }
        anew = change > last / 16;
        last = change;
    }
    return GM_NO_CONVERGENCE;
}

/* s after the step, from s before it and the stages */
static void find_high(struct gm_collocation *work)
{
    const size_t points = work->points, r = work->r;
    for (size_t at = 0; at < work->d * r; at++) {
        double *high = work->high + at * points;
        memset(high, 0, points * sizeof *high);
        add(high, work->low + at * points, work->rest, points);
        for (size_t k = 0; k < r; k++) {
            add(high, stage_of(work, work->z, at / r, k, at % r), work->weights[k], points);
        }
    }
}

enum gm_status gm_collocation_step(struct gm_collocation *work, double dt, struct gm_progress *progress)
{
    const size_t z_size = work->stages * work->points * sizeof(double),
                 y_size = work->sides * work->points * sizeof(double);
    enum gm_status status = GM_NO_CONVERGENCE;
    if (!work->needs_newton && make_constant(work, dt)) {
        memcpy(work->first_z, work->z, z_size);
        memcpy(work->first_y, work->y, y_size);
        status = solve(work, dt, false, progress);
        if (status != GM_OK) {
            memcpy(work->z, work->first_z, z_size);
            memcpy(work->y, work->first_y, y_size);
        }
    }
    if (status != GM_OK) {
        work->needs_newton = true;
        status = solve(work, dt, true, progress);
    }
    find_high(work);
    return status;
}

bool gm_collocation_linearise(struct gm_collocation *work, double dt)
{
    find_hessians(work, work->z, work->hessian, work->r * work->r * work->points);
    return factor(work, &work->newton, false, dt);
}

void gm_collocation_tangent(struct gm_collocation *work, double dt)
{
    const size_t d = work->d, count = work->r * work->r * work->points;
    memset(work->z, 0, work->stages * work->points * sizeof(double));
    memset(work->y, 0, work->sides * work->points * sizeof(double));
    for (int again = 0; again < 2; again++) {
        /* solved again for what rounding leaves */
        for (size_t c = 0; c < d; c++) {
            double *gradient = work->gradient + c * count;
            memset(gradient, 0, count * sizeof *gradient);
            for (size_t e = 0; e < d; e++) {
                const double *bend = work->hessian + (c * d + e) * count, *z = work->z + e * count;
                for (size_t i = 0; i < count; i++) {
                    gradient[i] += bend[i] * z[i];
                }
            }
        }
        find_right(work, dt, true);
        solve_each(work, &work->newton);
        add_changes(work);
    }
    find_high(work);
}

/* From [component][stage][cell] to a face. */
static void to_face(const struct gm_collocation *work, const double *stages, double *face)
{
    const size_t r = work->r, d = work->d, points = work->points;
    for (size_t i = 0; i < points; i++) {
        for (size_t m = 0; m < r; m++) {
            for (size_t c = 0; c < d; c++) {
                face[(i * r + m) * d + c] = stages[(c * r + m) * points + i];
            }
        }
    }
}

void gm_collocation_faces(const struct gm_collocation *work, struct gm_faces *faces)
{
    const size_t points = work->points, d = work->d, r = work->r;
    to_face(work, work->low, faces->lower);
    to_face(work, work->high, faces->upper);
    for (size_t i = 0; i <= points; i++) {
        for (size_t j = 0; j < r; j++) {
            double *side = faces->sides + (i * r + j) * d;
            for (size_t c = 0; c < d; c++) {
                for (size_t a = 0; a < work->rank; a++) {
                    side[c] +=
                        work->basis[c][a] * work->y[(j * work->rank + a) * points + (i < points ? i : 0)];
                }
            }
        }
    }
}

/* ---- nodes and stages ---- */

/* jump x / length, `part` of a cell after node i: s without it is periodic. */
static double slant(const struct gm_collocation *work, size_t c, size_t i, double part)
{
    return work->jump[c] * ((double)i + part) / (double)work->points;
}

static double angle_of(size_t mode, size_t points)
{
    const double turns = (double)mode / (double)points;
    return 2 * M_PI * (2 * mode > points ? turns - 1 : turns);
}

void gm_collocation_guess_sides(struct gm_collocation *work, const double *nodes)
{
    memset(work->y, 0, work->sides * work->points * sizeof(double));
    for (size_t at = 0; at < work->sides; at++) {
        for (size_t c = 0; c < work->state; c++) {
            add(work->y + at * work->points, nodes + c * work->points, work->basis[c][at % work->rank],
                work->points);
        }
    }
}

/* One stage is the mean of both ends of a cell; of several the wave through the nodes has its values. */
void gm_collocation_to_stages(struct gm_collocation *work, const double *nodes, bool second, double *stages)
{
    const size_t points = work->points, r = work->r;
    for (size_t at = 0; at < work->state * r; at++) {
        const size_t c = at / r;
        const double *from = nodes + c * points, part = work->tableau->c[at % r];
        double *to = stages + at * points;
        if (r == 1) {
            for (size_t i = 0; i < points; i++) {
                to[i] = (from[i] + (i + 1 < points ? from[i + 1] : from[0] + work->jump[c])) / 2;
            }
            continue;
        }
        for (size_t i = 0; i < points; i++) {
            work->waves[i] = from[i] - slant(work, c, i, 0);
        }
        gm_fourier_forward(work->fourier, work->waves);
        for (size_t mode = 0; mode < points; mode++) {
            const double angle = angle_of(mode, points), slope = angle / work->problem->line.dx;
            work->waves[mode] *= 2 * mode == points ? cos(M_PI * part) : cexp(I * angle * part);
            work->waves[mode] *= second ? -slope * slope : 1;
        }
        gm_fourier_inverse(work->fourier, work->waves);
        for (size_t i = 0; i < points; i++) {
            to[i] = creal(work->waves[i]) + (second ? 0 : slant(work, c, i, part));
        }
    }
}

/* The weights that turn stage values into the value at the node, exact for waves that are equal at the
   nodes: waves of the angles angle, angle -+ 2 pi .. are 1 there. The alternating wave has two angles. */
static void node_weights(const struct gm_collocation *work, size_t mode, double complex *weights)
{
    const size_t points = work->points, r = work->r;
    const double angle = angle_of(mode, points), *c = work->tableau->c;
    for (size_t m = 0; m < r; m++) {
        weights[m] = 0;
    }
    if (r == 1) {
        weights[0] = 2 * mode == points ? 0 : 2 / (cexp(I * angle) + 1);
        return;
    }
    if (mode == 0 && r == 2) {
        weights[0] = weights[1] = 0.5;
        return;
    }
    const size_t waves = 2 * mode == points ? 2 : r, apart = waves == 2 && r == 3 ? 2 : 1;
    const double turn = angle > 0 ? -2 * M_PI : 2 * M_PI, angles[] = {angle, angle + turn, angle - turn};
    double complex matrix[GM_COLLOCATION_STAGES][GM_COLLOCATION_STAGES + 1];
    for (size_t k = 0; k < waves; k++) {
        for (size_t m = 0; m < waves; m++) {
            matrix[k][m] = cexp(I * angles[k] * c[m * apart]);
        }
        matrix[k][waves] = 1;
    }
    for (size_t p = 0; p < waves; p++) {
        for (size_t k = 0; k < waves; k++) {
            const double complex factor = k == p ? 0 : matrix[k][p] / matrix[p][p];
            for (size_t m = p; m <= waves; m++) {
                matrix[k][m] -= factor * matrix[p][m];
            }
        }
    }
    for (size_t m = 0; m < waves; m++) {
        weights[m * apart] = matrix[m][waves] / matrix[m][m];
    }
}

/* The weights of stage values for the left side of a cell; its right side is the next cell's left one. A
   free part of the sides is chosen without a part in slopes. */
static void side_weights(const struct gm_collocation *work, size_t mode, double complex *weights)
{
    const double complex rise = cexp(I * angle_of(mode, work->points)) - work->rest;
    const bool free = cabs(rise) < 1e-12;
    double complex whole = free ? 0 : rise;
    for (size_t m = 0; m < work->r; m++) {
        weights[m] = free ? 0 : work->weights[m];
        for (size_t l = 0; free && l < work->r; l++) {
            weights[m] += work->weights[l] * work->inverse[l][m];
        }
        whole += free ? weights[m] : 0;
    }
    for (size_t m = 0; m < work->r; m++) {
        weights[m] /= whole;
    }
}

/* Values at a place of every cell, node or left side, from those at the stages. */
static void combine(struct gm_collocation *work, const double *stages, double *values,
                    void (*weigh)(const struct gm_collocation *work, size_t mode, double complex *weights))
{
    const size_t points = work->points, r = work->r;
    for (size_t c = 0; c < work->state; c++) {
        const double *from = stages + c * r * points;
        for (size_t m = 0; m < r; m++) {
            double complex *waves = work->waves + m * points;
            for (size_t i = 0; i < points; i++) {
                waves[i] = from[m * points + i] - slant(work, c, i, work->tableau->c[m]);
            }
            gm_fourier_forward(work->fourier, waves);
        }
        for (size_t mode = 0; mode < points; mode++) {
            double complex weights[GM_COLLOCATION_STAGES], sum = 0;
            weigh(work, mode, weights);
            for (size_t m = 0; m < r; m++) {
                sum += weights[m] * work->waves[m * points + mode];
            }
            work->waves[mode] = sum;
        }
        gm_fourier_inverse(work->fourier, work->waves);
        for (size_t i = 0; i < points; i++) {
            values[c * points + i] = creal(work->waves[i]) + slant(work, c, i, 0);
        }
    }
}

void gm_collocation_to_nodes(struct gm_collocation *work, const double *stages, double *nodes)
{
    combine(work, stages, nodes, node_weights);
}

void gm_collocation_slopes(struct gm_collocation *work, const double *stages, double *slopes)
{
    const size_t points = work->points, r = work->r;
    const double over = 1 / work->problem->line.dx;
    double *sides = work->gradient;
    combine(work, stages, sides, side_weights);
    for (size_t at = 0; at < work->state * r; at++) {
        double *slope = slopes + at * points;
        memset(slope, 0, points * sizeof *slope);
        add(slope, sides + at / r * points, -over * work->sums[at % r], points);
        for (size_t l = 0; l < r; l++) {
            add(slope, stages + (at / r * r + l) * points, over * work->inverse[at % r][l], points);
        }
    }
}
