/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sums of Kirchhoff's equations for very many vortices, and their energy, within a given error, by expansions
   about the centres of cells:

       F(z_i) = sum_{j != i} 1/(z_i - z_j),   E = sum_{i < j} ln |z_i - z_j|

   For two cells at the distance d = c_target - c_source, w = 1/d, with P terms, z_j = c_source + s_j:

       M_k = sum_j s_j^k                                        moments of the source,  k = 0 .. P-1
       b_l = (-1)^l w^(l+1) sum_k C(k+l, l) M_k w^k             F(c_target + t) = sum_l b_l t^l
       E   = n_target n_source ln|d| - Re sum_{k,l} C(k+l, l)/(k+l) (-1)^l w^(k+l) M_k M'_l

   L. Greengard & V. Rokhlin, J. Comput. Phys. 73 (1987) 325; pairs of cells that act on each other:
   W. Dehnen, J. Comput. Phys. 179 (2002) 27. With all s within a and all t within b of their centres and
   D = |d|, what is left out of 1/(d + t - s) is at most

       [(a/(D - b))^P + (b/(D - a))^P] / (D - a - b)

   so that cells with D >= K max(a, b) + min(a, b) have an error of at most 2 K^-P (K + 3)/(K - 1) of
   1/|d + t - s|, and F(z_i) has this part of sum_j 1/|z_i - z_j|: P and K make it the tolerance.

   Moments and expansions are in units of their cell's radius. Part of vortices.loops.c, whose lanes it uses. */
#ifndef GM_CORE_ODE_PROBLEMS_FLUIDS_MULTIPOLE_LOOP_H
#define GM_CORE_ODE_PROBLEMS_FLUIDS_MULTIPOLE_LOOP_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/functions/functions.h"

enum {
    LEAF = 80,      /* the most vortices of a leaf */
    MOST_TERMS = 40 /* the error is then 3e-19 */
};

struct cell {
    double x, y, radius; /* centre of the smallest box around its vortices; all are within the radius */
    size_t first, count; /* the range of its vortices in the order of the tree */
    size_t at;           /* a leaf's first index in the lists that are filled up to whole lanes */
    size_t child;        /* the first of its cells, which are consecutive */
    int children;        /* 0: it is a leaf */
};

struct tree {
    struct cell *cells;
    size_t count, capacity;
    size_t filled; /* the length of the lists */
    double *x, *y; /* vortices */
    size_t *origin;
    double *lists;        /* filled_x, filled_y, sum_x, sum_y: filled each */
    size_t terms;         /* P, a multiple of LANES */
    double apart;         /* K */
    double *coefficients; /* P per cell each: real and imaginary parts of moments, then of b */
    double matrix[MOST_TERMS * MOST_TERMS]; /* C(k+l, l), or C(k+l, l)/(k+l), by k */
    struct logarithms near;                 /* the energy of near pairs */
    double far;
};

/* The least number of terms and then the nearest cells that keep to the tolerance. */
static void choose(struct tree *tree, double tolerance)
{
    const double steps = 1.0 / 64;
    double apart = 3;
    size_t terms = LANES;
    while (terms < MOST_TERMS && 2 * gm_pow(apart, -(double)terms) * 3 > tolerance) {
        terms += LANES;
    }
    while (apart - steps >= 2 &&
           2 * gm_pow(apart - steps, -(double)terms) * (apart - steps + 3) / (apart - steps - 1) <=
               tolerance) {
        apart -= steps;
    }
    tree->terms = terms;
    tree->apart = apart;
}

static void fill_matrix(struct tree *tree, bool of_logarithms)
{
    const size_t terms = tree->terms;
    for (size_t k = 0; k < terms; k++) {
        double binomial = 1;
        for (size_t l = 0; l < terms; l++) {
            const size_t n = k + l;
            tree->matrix[k * terms + l] = !of_logarithms ? binomial : n > 0 ? binomial / (double)n : 0;
            binomial *= (double)(n + 1) / (double)(l + 1);
        }
    }
}

static void exchange(struct tree *tree, size_t i, size_t j)
{
    const double x = tree->x[i], y = tree->y[i];
    const size_t origin = tree->origin[i];
    tree->x[i] = tree->x[j];
    tree->y[i] = tree->y[j];
    tree->origin[i] = tree->origin[j];
    tree->x[j] = x;
    tree->y[j] = y;
    tree->origin[j] = origin;
}

/* Moves the vortices of first .. end - 1 whose coordinate is below the bound to the front; returns where the
   others begin. */
static size_t partition(struct tree *tree, const double *coordinate, double bound, size_t first, size_t end)
{
    while (first < end) {
        if (coordinate[first] < bound) {
            first++;
        } else {
            exchange(tree, first, --end);
        }
    }
    return first;
}

static double middle(double low, double high)
{
    const double half = low + (high - low) / 2;
    return half > low ? half : high;
}

/* Computes a cell's box, radius and cells. Returns false when out of memory, or if a coordinate is not
   finite. */
static bool subdivide(struct tree *tree, size_t index)
{
    struct cell *cell = &tree->cells[index];
    const double *x = tree->x, *y = tree->y;
    const size_t first = cell->first, end = first + cell->count;
    double left = x[first], right = left, low = y[first], high = low, square = 0;
    for (size_t i = first + 1; i < end; i++) {
        left = x[i] < left ? x[i] : left;
        right = x[i] > right ? x[i] : right;
        low = y[i] < low ? y[i] : low;
        high = y[i] > high ? y[i] : high;
    }
    cell->x = middle(left, right);
    cell->y = middle(low, high);
    for (size_t i = first; i < end; i++) {
        const double dx = x[i] - cell->x, dy = y[i] - cell->y, one = dx * dx + dy * dy;
        square = one > square ? one : square;
        if (!isfinite(one)) {
            return false;
        }
    }
    cell->radius = sqrt(square);
    if (cell->count <= LEAF || square == 0) {
        cell->at = tree->filled;
        tree->filled += (cell->count + 2 * LANES - 1) / LANES * LANES; /* whole lanes from any of them on */
        return true;
    }
    if (tree->count + 4 > tree->capacity) {
        struct cell *longer = realloc(tree->cells, 2 * tree->capacity * sizeof *longer);
        if (!longer) {
            return false;
        }
        tree->cells = longer;
        tree->capacity *= 2;
        cell = &tree->cells[index];
    }
    size_t bounds[5] = {first, 0, 0, 0, end};
    bounds[2] = partition(tree, x, cell->x, first, end);
    bounds[1] = partition(tree, y, cell->y, first, bounds[2]);
    bounds[3] = partition(tree, y, cell->y, bounds[2], end);
    cell->child = tree->count;
    for (int i = 0; i < 4; i++) {
        if (bounds[i + 1] > bounds[i]) {
            tree->cells[tree->count++] =
                (struct cell){.first = bounds[i], .count = bounds[i + 1] - bounds[i]};
            cell->children++;
        }
    }
    const size_t child = cell->child, children = (size_t)cell->children;
    for (size_t i = 0; i < children; i++) {
        if (!subdivide(tree, child + i)) {
            return false;
        }
    }
    return true;
}

/* Fills the lists; the filling is so far away that it adds nothing to sums. */
static void fill_lists(struct tree *tree)
{
    const double nowhere = 1e150;
    double *x = tree->lists, *y = x + tree->filled;
    for (size_t i = 0; i < 2 * tree->filled; i++) {
        tree->lists[i] = nowhere;
        tree->lists[2 * tree->filled + i] = 0;
    }
    for (const struct cell *cell = tree->cells; cell < tree->cells + tree->count; cell++) {
        if (cell->children == 0) {
            memcpy(x + cell->at, tree->x + cell->first, cell->count * sizeof *x);
            memcpy(y + cell->at, tree->y + cell->first, cell->count * sizeof *y);
        }
    }
}

static double *moments_of(const struct tree *tree, const struct cell *cell)
{
    return tree->coefficients + (size_t)(cell - tree->cells) * 4 * tree->terms;
}

static double *expansion_of(const struct tree *tree, const struct cell *cell)
{
    return moments_of(tree, cell) + 2 * tree->terms;
}

/* The unit of a cell's coefficients; a cell that is a point has one, too. */
static double unit_of(const struct cell *cell)
{
    return cell->radius > 1e-140 ? cell->radius : 1e-140;
}

static void take_moments(const struct tree *tree, const struct cell *leaf)
{
    const size_t terms = tree->terms;
    const double *x = tree->x + leaf->first, *y = tree->y + leaf->first, unit = 1 / unit_of(leaf);
    double *moments = moments_of(tree, leaf);
    lanes sums_x[MOST_TERMS], sums_y[MOST_TERMS];
    memset(sums_x, 0, terms * sizeof *sums_x);
    memset(sums_y, 0, terms * sizeof *sums_y);
    for (size_t i = 0; i < leaf->count; i += LANES) {
        const size_t members = leaf->count - i < LANES ? leaf->count - i : LANES;
        lanes s_x = leaf->x - (lanes){0}, s_y = leaf->y - (lanes){0}; /* the rest is at the centre */
        memcpy(&s_x, x + i, members * sizeof *x);
        memcpy(&s_y, y + i, members * sizeof *y);
        s_x = (s_x - leaf->x) * unit;
        s_y = (s_y - leaf->y) * unit;
        lanes power_x = s_x, power_y = s_y;
        for (size_t k = 1; k < terms; k++) {
            sums_x[k] += power_x;
            sums_y[k] += power_y;
            const lanes next = power_x * s_x - power_y * s_y;
            power_y = power_x * s_y + power_y * s_x;
            power_x = next;
        }
    }
    for (size_t k = 0; k < terms; k++) {
        moments[k] = k > 0 ? sum_of(sums_x[k]) : (double)leaf->count;
        moments[terms + k] = sum_of(sums_y[k]);
    }
}

/* sum_j C(k, j) eta^(k-j) x_j for every k, of complex x and eta: the moments as seen from eta. */
static void shift_moments(double *x, double *y, double eta_x, double eta_y, size_t terms)
{
    for (size_t first = 1; first < terms; first++) {
        for (size_t k = terms - 1; k >= first; k--) {
            x[k] += eta_x * x[k - 1] - eta_y * y[k - 1];
            y[k] += eta_x * y[k - 1] + eta_y * x[k - 1];
        }
    }
}

/* sum_(l >= k) C(l, k) eta^(l-k) x_l for every k: the expansion about eta. */
static void shift_expansion(double *x, double *y, double eta_x, double eta_y, size_t terms)
{
    for (size_t first = 0; first + 1 < terms; first++) {
        for (size_t l = terms - 1; l-- > first;) {
            x[l] += eta_x * x[l + 1] - eta_y * y[l + 1];
            y[l] += eta_x * y[l + 1] + eta_y * x[l + 1];
        }
    }
}

/* Cells come before their parts, so that moments are gathered from the last on. */
static void gather_moments(const struct tree *tree)
{
    const size_t terms = tree->terms;
    for (size_t i = tree->count; i-- > 0;) {
        const struct cell *cell = &tree->cells[i];
        if (cell->children == 0) {
            take_moments(tree, cell);
            continue;
        }
        double *moments = moments_of(tree, cell);
        for (int c = 0; c < cell->children; c++) {
            const struct cell *child = &tree->cells[cell->child + (size_t)c];
            const double *its = moments_of(tree, child), ratio = unit_of(child) / unit_of(cell);
            double x[MOST_TERMS], y[MOST_TERMS], scale = 1;
            for (size_t k = 0; k < terms; k++) {
                x[k] = its[k] * scale;
                y[k] = its[terms + k] * scale;
                scale *= ratio;
            }
            shift_moments(x, y, (child->x - cell->x) / unit_of(cell), (child->y - cell->y) / unit_of(cell),
                          terms);
            for (size_t k = 0; k < terms; k++) {
                moments[k] += x[k];
                moments[terms + k] += y[k];
            }
        }
    }
}

/* The powers (x + i y)^k, k < terms. */
static inline void take_powers(double *restrict re, double *restrict im, double x, double y, size_t terms)
{
    re[0] = 1;
    im[0] = 0;
    for (size_t k = 1; k < LANES; k++) {
        re[k] = re[k - 1] * x - im[k - 1] * y;
        im[k] = re[k - 1] * y + im[k - 1] * x;
    }
    const double eighth_x = re[LANES - 1] * x - im[LANES - 1] * y;
    const double eighth_y = re[LANES - 1] * y + im[LANES - 1] * x;
    for (size_t k = LANES; k < terms; k += LANES) {
        const lanes before_x = load(re + k - LANES), before_y = load(im + k - LANES);
        store(re + k, before_x * eighth_x - before_y * eighth_y);
        store(im + k, before_x * eighth_y + before_y * eighth_x);
    }
}

/* sums_l = sum_k matrix_kl coefficients_k powers_k, of complex numbers whose imaginary parts lie `terms` behind. */
static inline void multiply_series(const struct tree *tree, const double *coefficients, const double *powers,
                                   double *sums)
{
    const size_t terms = tree->terms;
    double turned[2 * MOST_TERMS];
    for (size_t k = 0; k < terms; k += LANES) {
        const lanes x = load(coefficients + k), y = load(coefficients + terms + k);
        const lanes re = load(powers + k), im = load(powers + terms + k);
        store(turned + k, x * re - y * im);
        store(turned + terms + k, x * im + y * re);
    }
    for (size_t l = 0; l < terms; l += LANES) {
        lanes sum_x = {0}, sum_y = {0};
        for (size_t k = 0; k < terms; k++) {
            const lanes entry = load(tree->matrix + k * terms + l);
            sum_x += entry * turned[k];
            sum_y += entry * turned[terms + k];
        }
        store(sums + l, sum_x);
        store(sums + terms + l, sum_y);
    }
}

/* expansion_l += w powers_l sums_l */
static inline void expand(double *expansion, const double *powers, const double *sums, double w_x, double w_y,
                          size_t terms)
{
    for (size_t l = 0; l < terms; l += LANES) {
        const lanes x = load(sums + l), y = load(sums + terms + l);
        const lanes re = load(powers + l), im = load(powers + terms + l);
        const lanes turned_x = x * re - y * im, turned_y = x * im + y * re;
        store(expansion + l, load(expansion + l) + (turned_x * w_x - turned_y * w_y));
        store(expansion + terms + l, load(expansion + terms + l) + (turned_x * w_y + turned_y * w_x));
    }
}

/* Adds the effects of two distant cells on each other by their moments. */
static void act(struct tree *tree, const struct cell *one, const struct cell *other, bool of_logarithms)
{
    const size_t terms = tree->terms;
    const double dx = one->x - other->x, dy = one->y - other->y, square = dx * dx + dy * dy;
    const double w_x = dx / square, w_y = -dy / square;
    double of_one[2 * MOST_TERMS], of_other[2 * MOST_TERMS], sums[2 * MOST_TERMS];
    take_powers(of_one, of_one + terms, -w_x * unit_of(one), -w_y * unit_of(one), terms);
    take_powers(of_other, of_other + terms, w_x * unit_of(other), w_y * unit_of(other), terms);
    multiply_series(tree, moments_of(tree, other), of_other, sums);
    if (of_logarithms) {
        const double *moments = moments_of(tree, one);
        double sum = (double)one->count * (double)other->count * gm_log(square) / 2;
        for (size_t l = 0; l < terms; l++) {
            const double x = moments[l] * of_one[l] - moments[terms + l] * of_one[terms + l];
            const double y = moments[l] * of_one[terms + l] + moments[terms + l] * of_one[l];
            sum -= x * sums[l] - y * sums[terms + l];
        }
        tree->far += sum;
        return;
    }
    expand(expansion_of(tree, one), of_one, sums, w_x, w_y, terms);
    multiply_series(tree, moments_of(tree, one), of_one, sums);
    expand(expansion_of(tree, other), of_other, sums, -w_x, -w_y, terms);
}

/* Adds the effects of the vortices of two leaves, or of one, on each other one by one. */
static void act_singly(struct tree *tree, const struct cell *one, const struct cell *other,
                       bool of_logarithms)
{
    const double *x = tree->lists, *y = x + tree->filled;
    double *sum_x = tree->lists + 2 * tree->filled, *sum_y = sum_x + tree->filled;
    const size_t end = other->at + other->count;
    for (size_t i = one->at; i < one->at + one->count; i++) {
        const double x_i = x[i], y_i = y[i];
        size_t j = one == other ? i + 1 : other->at;
        if (of_logarithms) {
            add_logarithms(&tree->near, x_i, y_i, x, y, j, end);
            continue;
        }
        lanes mine_x = {0}, mine_y = {0};
        for (; j < end; j += LANES) {
            give(x_i, y_i, x, y, j, &mine_x, &mine_y, sum_x, sum_y);
        }
        sum_x[i] += sum_of(mine_x);
        sum_y[i] += sum_of(mine_y);
    }
}

/* All pairs of vortices, one of each cell, once. */
static void meet(struct tree *tree, const struct cell *one, const struct cell *other, bool of_logarithms)
{
    if (one == other) {
        if (one->children == 0) {
            act_singly(tree, one, one, of_logarithms);
        }
        for (int i = 0; i < one->children; i++) {
            for (int j = i; j < one->children; j++) {
                meet(tree, tree->cells + one->child + i, tree->cells + one->child + j, of_logarithms);
            }
        }
        return;
    }
    const double dx = one->x - other->x, dy = one->y - other->y;
    const bool larger = one->radius > other->radius;
    const double wide = larger ? one->radius : other->radius, narrow = larger ? other->radius : one->radius;
    const double apart = tree->apart * wide + narrow;
    const bool leaves = one->children == 0 && other->children == 0;
    /* few pairs are cheaper one by one */
    if (leaves && one->count * other->count < 8 * tree->terms) {
        act_singly(tree, one, other, of_logarithms);
    } else if (dx * dx + dy * dy >= apart * apart && dx * dx + dy * dy > 0) {
        act(tree, one, other, of_logarithms);
    } else if (leaves) {
        act_singly(tree, one, other, of_logarithms);
    } else {
        const bool split = other->children == 0 || (larger && one->children > 0);
        const struct cell *whole = split ? other : one, *parts = split ? one : other;
        for (int i = 0; i < parts->children; i++) {
            meet(tree, tree->cells + parts->child + i, whole, of_logarithms);
        }
    }
}

/* Shifts expansions down to the leaves, and evaluates them at the vortices there. */
static void spread(const struct tree *tree)
{
    const size_t terms = tree->terms;
    const double *list_x = tree->lists, *list_y = list_x + tree->filled;
    double *sum_x = tree->lists + 2 * tree->filled, *sum_y = sum_x + tree->filled;
    for (const struct cell *cell = tree->cells; cell < tree->cells + tree->count; cell++) {
        const double *expansion = expansion_of(tree, cell), unit = 1 / unit_of(cell);
        for (int c = 0; c < cell->children; c++) {
            const struct cell *child = &tree->cells[cell->child + (size_t)c];
            double x[MOST_TERMS], y[MOST_TERMS], *its = expansion_of(tree, child), scale = 1;
            memcpy(x, expansion, terms * sizeof *x);
            memcpy(y, expansion + terms, terms * sizeof *y);
            shift_expansion(x, y, (child->x - cell->x) * unit, (child->y - cell->y) * unit, terms);
            for (size_t k = 0; k < terms; k++) {
                its[k] += x[k] * scale;
                its[terms + k] += y[k] * scale;
                scale *= unit_of(child) * unit;
            }
        }
        for (size_t i = cell->at; cell->children == 0 && i < cell->at + cell->count; i += LANES) {
            const lanes t_x = (load(list_x + i) - cell->x) * unit, t_y = (load(list_y + i) - cell->y) * unit;
            lanes x = {0}, y = {0};
            for (size_t l = terms; l-- > 0;) {
                const lanes next = x * t_x - y * t_y + expansion[l];
                y = x * t_y + y * t_x + expansion[terms + l];
                x = next;
            }
            store(sum_x + i, load(sum_x + i) + x);
            store(sum_y + i, load(sum_y + i) - y);
        }
    }
}

static void close_tree(struct tree *tree)
{
    free(tree->cells);
    free(tree->x);
    free(tree->origin);
    free(tree->lists);
    free(tree->coefficients);
}

/* Opens a tree. Returns false when out of memory, or if a coordinate is not finite; the caller closes it in
   both cases. */
static bool open_tree(struct tree *tree, const double *state, size_t count, double tolerance,
                      bool of_logarithms)
{
    *tree = (struct tree){.count = 1, .capacity = 64, .near = {.singly = {.product = 1}}};
    tree->cells = malloc(tree->capacity * sizeof *tree->cells);
    tree->x = malloc(2 * count * sizeof *tree->x);
    tree->origin = malloc(count * sizeof *tree->origin);
    if (!tree->cells || !tree->x || !tree->origin) {
        return false;
    }
    tree->y = tree->x + count;
    memcpy(tree->x, state, 2 * count * sizeof *state);
    for (size_t i = 0; i < count; i++) {
        tree->origin[i] = i;
    }
    choose(tree, tolerance);
    fill_matrix(tree, of_logarithms);
    tree->cells[0] = (struct cell){.count = count};
    if (!subdivide(tree, 0)) {
        return false;
    }
    tree->lists = malloc(4 * tree->filled * sizeof *tree->lists);
    tree->coefficients = calloc(tree->count * 4 * tree->terms, sizeof *tree->coefficients);
    if (!tree->lists || !tree->coefficients) {
        return false;
    }
    fill_lists(tree);
    gather_moments(tree);
    meet(tree, tree->cells, tree->cells, of_logarithms);
    return true;
}

/* parameters: strength, tolerance */
static void multipole_field(const struct gm_problem *problem, const double *state, double *f, size_t m)
{
    (void)m;
    const size_t count = (problem->n - 2 * problem->passive) / 2;
    const double factor = factor_of(problem);
    struct tree tree;
    if (open_tree(&tree, state, count, ((const double *)problem->parameters)[1], false)) {
        spread(&tree);
        const double *sum_x = tree.lists + 2 * tree.filled, *sum_y = sum_x + tree.filled;
        for (const struct cell *cell = tree.cells; cell < tree.cells + tree.count; cell++) {
            for (size_t i = 0; cell->children == 0 && i < cell->count; i++) {
                const size_t origin = tree.origin[cell->first + i];
                f[origin] = -factor * sum_y[cell->at + i];
                f[count + origin] = factor * sum_x[cell->at + i];
            }
        }
    } else {
        for (size_t i = 0; i < 2 * count; i++) {
            f[i] = NAN;
        }
    }
    close_tree(&tree);
}

static double multipole_energy(const struct gm_problem *problem, const double *state)
{
    const size_t count = (problem->n - 2 * problem->passive) / 2;
    const double *parameters = problem->parameters;
    struct tree tree;
    const bool opened = open_tree(&tree, state, count, parameters[1], true);
    const double sum = opened ? logarithms_sum(&tree.near) / 2 + tree.far : NAN;
    close_tree(&tree);
    return -parameters[0] * factor_of(problem) * sum;
}

#endif
