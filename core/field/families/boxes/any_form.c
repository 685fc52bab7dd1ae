/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The boxes of every order for any M s_t + K s_x = grad S(s) whose state is s at the nodes, and for waves,
   whose state is u at two levels: Gauss-Legendre collocation in space and time,
       r = 1   M D_t A_x s + K A_t D_x s = grad S(A_t A_x s),
               A f = (f_i + f_{i+1})/2,   D f = (f_{i+1} - f_i)/dx
   S. Reich, J. Comput. Phys. 157 (2000) 473; T.J. Bridges & S. Reich, Phys. Lett. A 284 (2001) 184. The
   memory is s at the stages of the cells, and the stages of three steps, of which the next step's are
   guessed. What the form calls M and K are the K and L of a system's file, and of the formulas that users
   read.

   Values at the nodes are found of those at the stages, and the other way round at the start: of one stage
   they are means, so that on an odd number of cells a step is the box's of nodes to the last digits. On an
   even number no mean shows the part that alternates from node to node; it is left out.

   M and K have any rank. With the tableau (A, b, c) of r stages across a cell and as many across a step, s =
   Z_jm at stage j in time and m in space,
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
#include "core/field/families/boxes/any_form.h"

#include <complex.h>
#include <stdint.h>

#include "core/arena.h"
#include "core/field/families/family.h"
#include "core/functions/complex.h"
#include "core/functions/functions.h"
#include "core/linear/extrapolation.h"
#include "core/linear/fourier.h"
#include "core/linear/iteration.h"
#include "core/linear/ring/blocks.h"
#include "core/linear/ring/ring.h"

enum { PAST = 3 };

/* The factors of linear equations of a step: the equations of a cell solved for its stages, and the
   equations between the sides of cells. All cells share them if the coefficients are constant. */
struct factors {
    double *cells;  /* [cell][row][column], rows and columns of a cell */
    size_t *pivots; /* [cell][column] */
    double *scales; /* [cell][row]: factor of the equations of sides, whose entries are then at most 1 */
    struct gm_ring_band sides;
    bool opened, shared, good; /* shared: one set of factors serves all cells */
    bool recursive;            /* the sides are solved by recursions, with `blocks` */
    struct gm_ring_blocks blocks;
};

/* The workspace. Every `points` numbers of an array hold one quantity in all cells. */
struct work {
    const struct gm_problem *problem;
    const struct gm_collocation_tableau *tableau;
    bool runs;                    /* else it has tangents alone */
    size_t points, d, r, rank;    /* rank: of K */
    size_t state;                 /* components that the state has at the nodes: all, or u of a wave */
    size_t stages, sides;         /* numbers of a cell: d r r and r rank */
    double jump[GM_MOST_OF_FORM]; /* s(x + the ring) - s(x) */
    double basis[GM_MOST_OF_FORM]
                [GM_MOST_OF_FORM]; /* [component][k], k < rank: of the range of K, orthonormal */
    double slopes[GM_MOST_OF_FORM][GM_MOST_OF_FORM];                  /* K basis */
    size_t held[GM_MOST_OF_FORM * GM_COLLOCATION_STAGES], held_count; /* sides of potentials */
    double inverse[GM_COLLOCATION_STAGES][GM_COLLOCATION_STAGES],
        sums[GM_COLLOCATION_STAGES];             /* A^-1, A^-1 1 */
    double weights[GM_COLLOCATION_STAGES], rest; /* b' A^-1, and 1 - b' A^-1 1 */
    double *low, *high; /* s at the stages of the cells, before and after a step: [component][space stage] */
    double *z;          /* s at all stages: [component][time stage][space stage] */
    double *y;          /* basis' s at the left sides of the cells: [time stage][k] */
    double *past_z[PAST], *past_y[PAST]; /* z and y of previous steps, the last one first */
    double *first_z, *first_y;           /* z and y at the start of an iteration */
    double *gradient, *hessian;          /* [component][stage]; [row][column][stage] */
    double *linear, linear_dt;           /* the equations of a cell but for S'', for this dt; 0: not made */
    double *right;          /* [row]: what is left of the equations of a cell, then what changes */
    double _Complex *waves; /* r * points */
    struct gm_fourier *fourier;
    struct factors constant, newton; /* S'' at s = 0; at z */
    double constant_dt;              /* 0: `constant` is not made */
    bool needs_newton;               /* `constant` did not serve a step; for steps of their own memory */
    double *scratch;                 /* [side], and two more */
    struct gm_arena *arena;          /* owner of all arrays */
};

/* ---- the workspace ---- */

/* Takes zeros that begin on a line of the cache: rows of all cells are added to each other. Returns NULL when out of memory;
   leaves the body while a workspace is opened. */
static double *take(const struct work *work, size_t count)
{
    enum { LINE = 64 };
    char *block = gm_arena_take(work->arena, count * sizeof(double) + LINE, 1);
    return block ? (double *)(void *)(block + (LINE - (uintptr_t)block % LINE)) : NULL;
}

static bool open_factors(const struct work *work, struct factors *factors, bool shared)
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

void gm_any_form_close(void *workspace)
{
    struct work *work = workspace;
    struct factors *const factors[] = {&work->constant, &work->newton};
    for (size_t i = 0; i < GM_COUNT(factors); i++) {
        if (factors[i]->opened) {
            gm_ring_band_close(&factors[i]->sides);
        }
    }
    gm_arena_close(work->arena);
}

/* An orthonormal basis of the range of K, from its longest rows on, by Gram and Schmidt; potentials come
   first, each by itself. */
static void find_range(struct work *work, const struct gm_form *form)
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
static void find_held(struct work *work, const struct gm_form *form)
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

static void invert(struct work *work)
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

/* Takes the memory of steps; tangents do not need it. */
static void open_steps(struct work *work)
{
    const size_t points = work->points, stages = work->stages * points, sides = work->sides * points;
    work->first_z = take(work, stages);
    work->first_y = take(work, sides);
    for (size_t k = 0; k < PAST; k++) {
        work->past_z[k] = take(work, stages);
        work->past_y[k] = take(work, sides);
    }
    work->waves = gm_arena_take(work->arena, work->r * points, sizeof *work->waves);
    work->fourier = gm_arena_keep(work->arena, gm_fourier_open(points), close_fourier);
    /* a run needs these, or its numbers would depend on memory; the factors of Newton's method are many */
    if (gm_field_of(work->problem)->form->potential_count == 0 &&
        !open_factors(work, &work->constant, true)) {
        gm_arena_leave(work->arena);
    }
}

static void open_arrays(struct gm_arena *arena, void *data)
{
    struct work *work = data;
    const size_t points = work->points, level = work->d * work->r * points;
    const size_t stages = work->stages * points, sides = work->sides * points;
    (void)arena;
    work->low = take(work, level);
    work->high = take(work, level);
    work->z = take(work, stages);
    work->y = take(work, sides);
    work->gradient = take(work, stages);
    work->hessian = take(work, work->d * stages);
    work->right = take(work, stages + sides);
    work->linear = take(work, (work->stages + work->sides) * (work->stages + 2 * work->sides));
    work->scratch = take(work, sides + 2 * points);
    if (work->runs) {
        open_steps(work);
    }
}

void *gm_any_form_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const struct gm_field *field = gm_field_of(problem);
    const struct gm_form *form = field->form;
    struct gm_arena *arena = gm_arena_open();
    struct work *work = arena ? gm_arena_take(arena, 1, sizeof *work) : NULL;
    if (!work) {
        gm_arena_close(arena);
        return NULL;
    }
    work->arena = arena;
    work->problem = problem;
    work->tableau = scheme->coefficients;
    work->runs = scheme->family != NULL;
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

/* grad S at `count` points, [component * count + point]. Of s = (u, v, w) it is (V', v, -w) for a wave, whose form does not
   state it at many points. */
static void find_gradients(const struct work *work, const double *s, double *gradient, size_t count)
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

static void find_hessians(const struct work *work, const double *s, double *hessian, size_t count)
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

static const double *stage_of(const struct work *work, const double *z, size_t c, size_t j, size_t m)
{
    return z + ((c * work->r + j) * work->r + m) * work->points;
}

/* The factor that makes equations of sides as large as the equations of stages. */
static double weight_of_sides(const struct work *work)
{
    return 1 / work->problem->line.dx;
}

static double jump_of(const struct work *work, size_t a)
{
    double sum = 0;
    for (size_t c = 0; c < work->d; c++) {
        sum += work->basis[c][a] * work->jump[c];
    }
    return sum;
}

/* The matrix of a cell's equations but for S'', rows as those of `right`, columns its stages, the left y, the
   right y. */
static const double *find_linear(struct work *work, double dt)
{
    double *const matrix = work->linear;
    if (work->linear_dt == dt) {
        return matrix;
    }
    work->linear_dt = dt;
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
    return matrix;
}

/* right := grad S - M T - K X, and what closes the sides; with work->gradient as the gradient. */
static void find_right(struct work *work, double dt, bool tangent)
{
    const struct gm_form *form = gm_field_of(work->problem)->form;
    const size_t points = work->points, d = work->d, r = work->r, stages = work->stages, sides = work->sides;
    const size_t rows = stages + sides, columns = rows + sides;
    const double *matrix = find_linear(work, dt);
    memcpy(work->right, work->gradient, stages * points * sizeof(double));
    memset(work->right + stages * points, 0, sides * points * sizeof(double));
    for (size_t at = 0; at < stages * d; at++) {
        const size_t row = at / d, e = at % d, j = row / r % r, m = row % r;
        const double in_time = form->m[row / (r * r) * d + e] / dt;
        if (in_time != 0) {
            add(work->right + row * points, work->low + (e * r + m) * points, in_time * work->sums[j],
                points);
        }
    }
    for (size_t at = 0; at < rows * columns; at++) {
        const size_t column = at % columns, side = column < stages ? 0 : (column - stages) % sides;
        double *to = work->right + at / columns * points;
        if (matrix[at] != 0 && column < rows) {
            add(to, column < stages ? work->z + column * points : work->y + side * points, -matrix[at],
                points);
        } else if (matrix[at] != 0) {
            add_next(to, work->y + side * points, -matrix[at], tangent ? 0 : jump_of(work, side % work->rank),
                     points);
        }
    }
}

static void subtract_hessian(const struct work *work, const double *hessian, double *matrix)
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
static void hold_potentials(const struct work *work, double *matrix)
{
    const size_t columns = work->stages + 2 * work->sides;
    for (size_t h = 0; h < work->held_count; h++) {
        double *row = matrix + (work->stages + work->held[h]) * columns;
        memset(row, 0, columns * sizeof *row);
        row[work->stages + work->sides + work->held[h]] = weight_of_sides(work);
    }
}

static void hold_right(struct work *work)
{
    for (size_t h = 0; h < work->held_count; h++) {
        work->right[(work->stages + work->held[h]) * work->points + work->points - 1] = 0;
    }
}

/* Eliminates the stages in place, with the factors below the diagonal. Returns false if they are not
   determined. */
static bool eliminate(const struct work *work, double *matrix, size_t *pivots)
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
static bool make_blocks(const struct work *work, struct factors *factors)
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
static bool factor(struct work *work, struct factors *factors, bool shared, double dt)
{
    const size_t rows = work->stages + work->sides, columns = rows + work->sides;
    if (!open_factors(work, factors, shared)) {
        return false;
    }
    const double *linear = find_linear(work, dt);
    gm_ring_band_clear(&factors->sides);
    factors->good = true;
    for (size_t i = 0; i < work->points && factors->good; i++) {
        const size_t place = shared ? 0 : i;
        double *matrix = factors->cells + place * rows * columns;
        if (!shared || i == 0) {
            memcpy(matrix, linear, rows * columns * sizeof *linear);
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
static void solve_shared(struct work *work, struct factors *factors)
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

static void solve_each(struct work *work, struct factors *factors)
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
static bool make_constant(struct work *work, double dt)
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

static void add_changes(struct work *work)
{
    add(work->z, work->right, 1, work->stages * work->points);
    add(work->y, work->right + work->stages * work->points, 1, work->sides * work->points);
}

/* Makes one iteration. Returns the largest change of a stage, NAN if one is not finite. */
static double iterate(struct work *work, double dt, bool newton, bool anew, double *left,
                      struct gm_progress *progress)
{
    const size_t points = work->points, q = work->r * work->r;
    find_gradients(work, work->z, work->gradient, q * points);
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
static enum gm_status solve(struct work *work, double dt, bool newton, struct gm_progress *progress)
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
static void find_high(struct work *work)
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

/* One step from `low` to `high`, with the guess in z and y, which become the solution. GM_NO_CONVERGENCE. */
static enum gm_status collocate(struct work *work, double dt, struct gm_progress *progress)
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

/* Linearises the equations at z, for steps of tangents from `low` to `high`, z and y. Returns false if
   they are singular, or when out of memory. */
static bool linearise(struct work *work, double dt)
{
    find_hessians(work, work->z, work->hessian, work->r * work->r * work->points);
    return factor(work, &work->newton, false, dt);
}

static void advance_tangent(struct work *work, double dt)
{
    memset(work->z, 0, work->stages * work->points * sizeof(double));
    memset(work->y, 0, work->sides * work->points * sizeof(double));
    memset(work->gradient, 0, work->stages * work->points * sizeof(double));
    find_right(work, dt, true);
    solve_each(work, &work->newton);
    add_changes(work);
    find_high(work);
}

/* From [component][stage][cell] to a face. */
static void to_face(const struct work *work, const double *stages, double *face)
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

/* Fills in the faces of a step of tangents. */
static void find_faces(const struct work *work, struct gm_faces *faces)
{
    const size_t points = work->points, d = work->d, r = work->r;
    to_face(work, work->low, faces->lower);
    to_face(work, work->high, faces->upper);
    for (size_t i = 0; i <= points; i++) {
        for (size_t j = 0; j < r; j++) {
            double *side = faces->sides + (i * r + j) * d;
            for (size_t c = 0; c < d; c++) {
                side[c] = 0;
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
static double slant(const struct work *work, size_t c, size_t i, double part)
{
    return work->jump[c] * ((double)i + part) / (double)work->points;
}

static double angle_of(size_t mode, size_t points)
{
    const double turns = (double)mode / (double)points;
    return 2 * M_PI * (2 * mode > points ? turns - 1 : turns);
}

/* basis' s at the nodes, as a guess of y. */
static void guess_sides(struct work *work, const double *nodes)
{
    memset(work->y, 0, work->sides * work->points * sizeof(double));
    for (size_t at = 0; at < work->sides; at++) {
        for (size_t c = 0; c < work->state; c++) {
            add(work->y + at * work->points, nodes + c * work->points, work->basis[c][at % work->rank],
                work->points);
        }
    }
}

/* From values of the state's components at the nodes, [component * points + node], to those at the stages of cells, or to
   their second derivatives there, where a cell has several: one stage is the mean of both ends of a cell; of several the
   wave through the nodes has its values. */
static void to_stages(struct work *work, const double *nodes, bool second, double *stages)
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
            work->waves[mode] *= 2 * mode == points ? gm_cos(M_PI * part) : gm_cexp(I * angle * part);
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
static void node_weights(const struct work *work, size_t mode, double complex *weights)
{
    const size_t points = work->points, r = work->r;
    const double angle = angle_of(mode, points), *c = work->tableau->c;
    for (size_t m = 0; m < r; m++) {
        weights[m] = 0;
    }
    if (r == 1) {
        weights[0] = 2 * mode == points ? 0 : gm_cdivide(2, gm_cexp(I * angle) + 1);
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
            matrix[k][m] = gm_cexp(I * angles[k] * c[m * apart]);
        }
        matrix[k][waves] = 1;
    }
    for (size_t p = 0; p < waves; p++) {
        for (size_t k = 0; k < waves; k++) {
            const double complex factor = k == p ? 0 : gm_cdivide(matrix[k][p], matrix[p][p]);
            for (size_t m = p; m <= waves; m++) {
                matrix[k][m] -= factor * matrix[p][m];
            }
        }
    }
    for (size_t m = 0; m < waves; m++) {
        weights[m * apart] = gm_cdivide(matrix[m][waves], matrix[m][m]);
    }
}

/* The weights of stage values for the left side of a cell; its right side is the next cell's left one. A
   free part of the sides is chosen without a part in slopes. */
static void side_weights(const struct work *work, size_t mode, double complex *weights)
{
    const double complex rise = gm_cexp(I * angle_of(mode, work->points)) - work->rest;
    const bool free = gm_cabs(rise) < 1e-12;
    double complex whole = free ? 0 : rise;
    for (size_t m = 0; m < work->r; m++) {
        weights[m] = free ? 0 : work->weights[m];
        for (size_t l = 0; free && l < work->r; l++) {
            weights[m] += work->weights[l] * work->inverse[l][m];
        }
        whole += free ? weights[m] : 0;
    }
    for (size_t m = 0; m < work->r; m++) {
        weights[m] = gm_cdivide(weights[m], whole);
    }
}

/* Values at a place of every cell, node or left side, from those at the stages. */
static void combine(struct work *work, const double *stages, double *values,
                    void (*weigh)(const struct work *work, size_t mode, double complex *weights))
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

/* The slopes of values at the stages, there. */
static void find_slopes(struct work *work, const double *stages, double *slopes)
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

/* ---- runs ---- */

static const struct gm_collocation_tableau midpoint = {1, {{0.5}}, {1}, {0.5}};

#define ROOT3 1.7320508075688772935
const struct gm_collocation_tableau gm_collocation_gauss4 = {
    2,
    {{0.25, 0.25 - ROOT3 / 6}, {0.25 + ROOT3 / 6, 0.25}},
    {0.5, 0.5},
    {0.5 - ROOT3 / 6, 0.5 + ROOT3 / 6},
};

#define ROOT15 3.8729833462074168852
static const struct gm_collocation_tableau gauss6 = {
    3,
    {{5.0 / 36, 2.0 / 9 - ROOT15 / 15, 5.0 / 36 - ROOT15 / 30},
     {5.0 / 36 + ROOT15 / 24, 2.0 / 9, 5.0 / 36 - ROOT15 / 24},
     {5.0 / 36 + ROOT15 / 30, 2.0 / 9 + ROOT15 / 15, 5.0 / 36}},
    {5.0 / 18, 4.0 / 9, 5.0 / 18},
    {0.5 - ROOT15 / 10, 0.5, 0.5 + ROOT15 / 10},
};

/* The stored memory: 1 + the number of steps with stored stages (0: nothing yet), a flag for Newton's
   method, s at the stages of the level, and the stages and sides of the last steps. */
enum { KNOWN, NEWTON, ARRAYS };

static size_t of_level(const struct work *work)
{
    return work->d * work->r * work->points;
}

size_t gm_any_form_memory(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    const size_t r = ((const struct gm_collocation_tableau *)scheme->coefficients)->r,
                 d = gm_field_of(problem)->form->dimension;
    /* sides of full rank, at most */
    return ARRAYS + (d * r + PAST * (d * r * r + d * r)) * problem->line.points;
}

/* Copies between the memory and the workspace. */
static void exchange_memory(struct work *work, double *to, const double *from)
{
    struct {
        double *array;
        size_t size;
    } arrays[1 + 2 * PAST] = {{work->low, of_level(work)}};
    for (size_t k = 0; k < PAST; k++) {
        arrays[1 + 2 * k].array = work->past_z[k];
        arrays[1 + 2 * k].size = work->stages * work->points;
        arrays[2 + 2 * k].array = work->past_y[k];
        arrays[2 + 2 * k].size = work->sides * work->points;
    }
    for (size_t i = 0, at = ARRAYS; i < GM_COUNT(arrays); at += arrays[i++].size) {
        if (to) {
            memcpy(to + at, arrays[i].array, arrays[i].size * sizeof *to);
        } else {
            memcpy(arrays[i].array, from + at, arrays[i].size * sizeof *from);
        }
    }
}

static void remember(struct work *work, size_t known, double *memory)
{
    memory[KNOWN] = (double)known;
    memory[NEWTON] = work->needs_newton;
    exchange_memory(work, memory, NULL);
}

static size_t recall(struct work *work, const double *memory)
{
    work->needs_newton = memory[NEWTON] != 0;
    exchange_memory(work, NULL, memory);
    return (size_t)memory[KNOWN];
}

/* Potentials from their slopes, cell after cell by collocation, as the stages of every step have them:
   from values at the nodes they would differ by an error of the grid, which would change its sign at every
   step. */
static void integrate_potentials(struct work *work, double *level)
{
    const struct gm_form *form = gm_field_of(work->problem)->form;
    const struct gm_collocation_tableau *tableau = work->tableau;
    const size_t points = work->points, r = work->r, d = work->d;
    const double dx = work->problem->line.dx;
    if (form->potential_count > 0) {
        find_gradients(work, level, work->gradient, r * points);
    }
    for (size_t p = 0; p < form->potential_count; p++) {
        const size_t component = form->potentials[p].component, row = form->potentials[p].row;
        const double *slope = work->gradient + row * r * points, over = 1 / form->k[row * d + component];
        double *to = level + component * r * points, left = 0;
        for (size_t k = 0; k < work->rank; k++) {
            left += work->basis[component][k] * work->y[k * points];
        }
        for (size_t i = 0; i < points; i++) {
            double rise = 0;
            for (size_t m = 0; m < r; m++) {
                to[m * points + i] = left;
                for (size_t l = 0; l < r; l++) {
                    to[m * points + i] += dx * tableau->a[m][l] * over * slope[l * points + i];
                }
                rise += dx * tableau->b[m] * over * slope[m * points + i];
            }
            left += rise;
        }
    }
}

/* Nothing determines the constant of a potential: on the first side it stays what it was. */
static void anchor(struct work *work)
{
    const struct gm_form *form = gm_field_of(work->problem)->form;
    const size_t points = work->points, r = work->r;
    for (size_t at = 0; at < form->potential_count * work->sides; at++) {
        const size_t c = form->potentials[at / work->sides].component, side = at % work->sides;
        const double part = work->basis[c][side % work->rank];
        double *y = work->y + side * points, *z = work->z + (c * r + side / work->rank) * r * points;
        const double by = part != 0 ? work->past_y[0][side * points] - y[0] : 0;
        for (size_t i = 0; i < points && by != 0; i++) {
            y[i] += by;
        }
        for (size_t i = 0; i < r * points && by != 0; i++) {
            z[i] += by * part;
        }
    }
}

/* z and y of the step to come, from those of `known` - 1 before. */
static void guess(struct work *work, size_t known)
{
    const size_t points = work->points, r = work->r, steps = known > 1 ? known - 1 : 1;
    gm_extrapolate((const double *const *)work->past_y, steps, work->y, work->sides * points);
    gm_extrapolate((const double *const *)work->past_z, steps, work->z, work->stages * points);
    for (size_t at = 0; at < work->d * r * r && known == 1; at++) {
        memcpy(work->z + at * points, work->low + (at / (r * r) * r + at % r) * points,
               points * sizeof(double));
    }
    anchor(work);
}

/* If a potential ties components without a rate to rates of others, waves of the branches that no smooth
   field has are too fast for a step: two stages leave them unchanged, three change their sign, and such a
   component is 1/dt of them, which two stages add up step after step. This removes them from the start:
   the stages of a step forward and of one back have almost nothing of them, and the polynomial through
   both, even in time, is s at the start up to dt^(2 r). */
static void settle(struct work *work, double dt)
{
    const size_t points = work->points, r = work->r;
    const double *c = work->tableau->c;
    double *sum = work->past_z[1]; /* there are no steps before */
    memset(sum, 0, of_level(work) * sizeof *sum);
    for (int way = -1; way <= 1; way += 2) {
        struct gm_progress uncounted = {.status = GM_OK};
        guess(work, 1);
        if (collocate(work, way * dt, &uncounted) != GM_OK) {
            return;
        }
        for (size_t j = 0; j < r; j++) {
            double weight = 0.5;
            for (size_t k = 0; k < r; k++) {
                weight *= k == j ? 1 : c[k] * c[k] / (c[k] * c[k] - c[j] * c[j]);
            }
            for (size_t at = 0; at < work->d * r; at++) {
                const double *stage = work->z + ((at / r * r + j) * r + at % r) * points;
                for (size_t i = 0; i < points; i++) {
                    sum[at * points + i] += weight * stage[i];
                }
            }
        }
    }
    memcpy(work->low, sum, of_level(work) * sizeof *sum);
}

/* The mean over the ring of both stages of v: where they differ, no slope of w moves them. */
static void share_mean(double *stages, size_t points)
{
    double means[2] = {0};
    for (size_t at = 0; at < 2 * points; at++) {
        means[at / points] += stages[at] / (double)points;
    }
    for (size_t at = 0; at < 2 * points; at++) {
        stages[at] += (means[0] + means[1]) / 2 - means[at / points];
    }
}

/* u and v of a wave at two stages, from the two levels of its state: by the first terms of Taylor's series,
       v = [u(t + g) - u(t)]/g - g [2 u''(t) + u''(t + g)]/6 + O(g^3),
   then corrected so that a step leads to the other level as well as to the order of the scheme. */
static void start_wave(struct work *work, const double *levels)
{
    enum { TIMES = 2 };
    const struct gm_problem *problem = work->problem;
    const struct gm_wave *wave = gm_field_of(problem)->wave;
    const size_t points = work->points, count = work->r * points;
    const double gap = levels[2 * points], *other_level = levels + points;
    /* there are no steps before */
    double *u = work->low, *v = u + count, *other = work->past_z[1], *second = other + count,
           *force = second + count;
    memset(v, 0, 2 * count * sizeof *v);
    for (size_t k = 0; k < 2; k++) {
        const double weight = k == 0 ? 2 : 1;
        to_stages(work, k == 0 ? levels : other_level, false, other);
        to_stages(work, k == 0 ? levels : other_level, true, second);
        wave->slopes(problem, other, force, count);
        for (size_t at = 0; at < count; at++) {
            v[at] += (k == 0 ? -1 : 1) * other[at] / gap - gap * weight * (second[at] - force[at]) / 6;
            u[at] = k == 0 ? other[at] : u[at];
        }
    }
    share_mean(v, points);
    for (int k = 0; k < TIMES; k++) {
        struct gm_progress uncounted = {.status = GM_OK};
        guess(work, 1);
        if (collocate(work, gap, &uncounted) != GM_OK) {
            return;
        }
        for (size_t at = 0; at < count; at++) {
            v[at] += (other[at] - work->high[at]) / gap;
        }
    }
}

/* s at the stages, once; for another dt the steps before are forgotten. */
enum gm_status gm_any_form_start(const struct gm_task *task)
{
    struct work *work = task->workspace;
    if (task->memory_out[KNOWN] > 0) {
        task->memory_out[KNOWN] = 1;
        task->memory_out[NEWTON] = 0;
        return GM_OK;
    }
    work->needs_newton = false;
    guess_sides(work, task->y);
    memcpy(work->past_y[0], work->y, work->sides * work->points * sizeof(double));
    if (gm_field_of(work->problem)->wave) {
        start_wave(work, task->y);
        remember(work, 1, task->memory_out);
        return GM_OK;
    }
    to_stages(work, task->y, false, work->low);
    integrate_potentials(work, work->low);
    if (work->r > 1 && gm_field_of(work->problem)->form->potential_count > 0) {
        settle(work, task->dt);
    }
    remember(work, 1, task->memory_out);
    return GM_OK;
}

const double *gm_any_form_stages(const double *memory)
{
    return memory + ARRAYS;
}

/* The solution becomes the first of the past ones. */
static void shift(double **now, double **past)
{
    double *oldest = past[PAST - 1];
    for (size_t k = PAST - 1; k > 0; k--) {
        past[k] = past[k - 1];
    }
    past[0] = *now;
    *now = oldest;
}

/* The state at the nodes; of a wave u at the level before as well, which `work->high` holds. */
static void find_state(struct work *work, double dt, double *state)
{
    combine(work, work->low, state, node_weights);
    if (gm_field_of(work->problem)->wave) {
        combine(work, work->high, state + work->points, node_weights);
        state[2 * work->points] = -dt;
    }
}

struct gm_progress gm_any_form_advance(const struct gm_task *task)
{
    struct work *work = task->workspace;
    struct gm_progress progress = {.status = GM_OK};
    size_t known = recall(work, task->memory);
    for (int64_t k = 0; k < task->steps; k++) {
        guess(work, known);
        progress.status = collocate(work, task->dt, &progress);
        if (!gm_field_stepped(task, &progress, work->high, work->state * work->r * work->points)) {
            return progress;
        }
        double *low = work->low;
        work->low = work->high;
        work->high = low;
        shift(&work->z, work->past_z);
        shift(&work->y, work->past_y);
        known = known <= PAST ? known + 1 : known;
    }
    remember(work, known, task->memory_out);
    find_state(work, task->dt, task->out);
    return progress;
}

double gm_any_form_integral(const struct gm_problem *problem, const struct gm_scheme *scheme,
                            const double *remembered,
                            double (*density)(const struct gm_problem *problem, const double *s,
                                              const double *slope))
{
    struct work *work = remembered ? gm_any_form_open(problem, scheme) : NULL;
    if (!work) {
        return NAN;
    }
    const size_t count = work->r * work->points;
    const double *stages = gm_any_form_stages(remembered);
    double sum = 0, s[GM_MOST_OF_FORM], slope[GM_MOST_OF_FORM];
    find_slopes(work, stages, work->high);
    for (size_t at = 0; at < count; at++) {
        for (size_t c = 0; c < work->d; c++) {
            s[c] = stages[c * count + at];
            slope[c] = work->high[c * count + at];
        }
        sum += work->tableau->b[at / work->points] * density(problem, s, slope);
    }
    gm_any_form_close(work);
    return problem->line.dx * sum;
}

static double product(const double *matrix, size_t d, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < d; i++) {
        for (size_t k = 0; k < d; k++) {
            sum += a[i] * matrix[i * d + k] * b[k];
        }
    }
    return sum;
}

static double energy_density(const struct gm_problem *problem, const double *s, const double *slope)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    return form->function(problem->parameters, s) - product(form->k, form->dimension, s, slope) / 2;
}

static double momentum_density(const struct gm_problem *problem, const double *s, const double *slope)
{
    const struct gm_form *form = gm_field_of(problem)->form;
    return product(form->m, form->dimension, s, slope) / 2;
}

double gm_form_energy(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *memory)
{
    return gm_any_form_integral(problem, scheme, memory, energy_density);
}

double gm_form_momentum(const struct gm_problem *problem, const struct gm_scheme *scheme,
                        const double *memory)
{
    return gm_any_form_integral(problem, scheme, memory, momentum_density);
}

/* ---- the discrete multisymplectic law ---- */

static void differentiate(const struct gm_law *law, const double *tangent, double *next)
{
    const size_t n = law->problem->n, low = of_level(law->work) * sizeof *next;
    const size_t size = n + gm_any_form_memory(law->problem, law->scheme);
    double *direction = gm_arena_take(law->arena, 2 * size, sizeof *direction), *slope = direction + size;
    memcpy(direction + n + ARRAYS, tangent, low);
    gm_law_differentiate(law, law->y, law->memory, direction, slope);
    memcpy(next, slope + n + ARRAYS, low);
}

/* Advances tangents from s at the stages. */
static void advance_tangents(const struct gm_law *law, struct gm_faces faces[2])
{
    struct work *work = law->work;
    const size_t low = of_level(work), points = work->points, r = work->r;
    double *tangents = gm_arena_take(law->arena, 4 * low, sizeof *tangents), *next = tangents + 2 * low;
    for (size_t at = 0; at < 2 * work->d * r; at++) {
        const size_t k = at / (work->d * r), row = at % (work->d * r);
        const double waves = 2 + (double)k;
        gm_tangent_start(tangents + at * points, points, waves,
                         0.3 + 0.4 * (double)k + (double)(row / r) +
                             2 * M_PI * waves * work->tableau->c[row % r] / (double)points);
    }
    for (size_t k = 0; k < 2 && law->by_differences; k++) {
        differentiate(law, tangents + k * low, next + k * low);
    }
    struct gm_progress uncounted = {.status = GM_OK};
    guess(work, recall(work, law->memory));
    if (collocate(work, law->dt, &uncounted) != GM_OK || !linearise(work, law->dt)) {
        gm_arena_leave(law->arena);
    }
    for (size_t k = 0; k < 2; k++) {
        memcpy(work->low, tangents + k * low, low * sizeof *tangents);
        advance_tangent(work, law->dt);
        if (law->by_differences) {
            memcpy(work->high, next + k * low, low * sizeof *next);
        }
        find_faces(work, &faces[k]);
    }
}

double gm_any_form_law(const struct gm_law *law)
{
    const struct work *work = law->work;
    const struct gm_collocation_tableau *tableau = work->tableau;
    const struct gm_lattice cells = {work->points,          work->r, work->r, tableau->b, tableau->b,
                                     law->problem->line.dx, law->dt};
    return gm_lattice_law(law, &cells, advance_tangents);
}

/* ---- tangents of boxes of one stage whose state is a part of s ---- */

struct gm_box_tangents {
    struct work work; /* first */
};

struct gm_box_tangents *gm_box_linearise(const struct gm_law *law, const double *cells)
{
    static const struct gm_scheme box = {.coefficients = &midpoint}; /* without a family it never runs */
    struct work *work = gm_arena_keep(law->arena, gm_any_form_open(law->problem, &box), gm_any_form_close);
    const struct gm_form *form = gm_field_of(law->problem)->form;
    memcpy(work->z + form->first * work->points, cells, form->kept * work->points * sizeof *cells);
    if (!linearise(work, law->dt)) {
        gm_arena_leave(law->arena);
    }
    return (struct gm_box_tangents *)work;
}

/* The means of nodes in the cells, with the potentials that follow. */
static void find_level(struct work *work, const double *nodes, double *level)
{
    const struct gm_form *form = gm_field_of(work->problem)->form;
    memset(level, 0, of_level(work) * sizeof *level);
    for (size_t part = 0; part < form->kept; part++) {
        double *to = level + (form->first + part) * work->points;
        add(to, nodes + part * work->points, 0.5, work->points);
        add_next(to, nodes + part * work->points, 0.5, 0, work->points);
    }
    integrate_potentials(work, level);
}

void gm_box_advance_tangent(struct gm_box_tangents *box, double dt, const double *now, const double *next,
                            struct gm_faces *faces)
{
    struct work *work = &box->work;
    memset(work->y, 0, work->sides * work->points * sizeof *work->y);
    find_level(work, now, work->low);
    advance_tangent(work, dt);
    if (next) {
        find_level(work, next, work->high);
    }
    find_faces(work, faces);
}

#define OF_ANY_FORM .family = &gm_family_any_form, .needs = GM_NEEDS_ALL

static const struct gm_scheme schemes[] = {
    {GM_TEXTS_box_of_all_components, OF_ANY_FORM, .coefficients = &midpoint},
    {GM_TEXTS_gauss_box3_of_all_components, OF_ANY_FORM, .coefficients = &gm_collocation_gauss4},
    {GM_TEXTS_gauss_box4, OF_ANY_FORM, .coefficients = &gauss6},
};

const struct gm_family gm_family_any_form = {
    .title = "multisymplectic boxes of all components",
    GM_FIELD_FAMILY,
    .loop = gm_any_form_advance,
    .memory = gm_any_form_memory,
    .start = gm_any_form_start,
    .workspace_open = gm_any_form_open,
    .workspace_close = gm_any_form_close,
    .form = gm_any_form_law,
};
