/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Order, with Phi_i of a tree with branches u, v, ... (Butcher's product of weights):
       Phi_i = prod_(branches u) sum_j a_ij Phi_j(u),   condition   sum_i b_i Phi_i = 1 / gamma
   a and b being those of the side of u, of the tree. Structure, sigma i = s + 1 - i being the stages
   backwards:
       symplectic    b_i c_ij + d_j a_ji = b_i d_j,   b = d where f_q, f_p know both
       symmetric     a_(sigma i, sigma j) + a_ij = b_j = b_(sigma j), on both sides
   E. Hairer, C. Lubich & G. Wanner, Geometric Numerical Integration (2006), II.1, III.1, III.2, V.2, VI.4,
   VI.7.2, IX.8. */
#include "core/theory/theory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/arena.h"
#include "core/functions/functions.h"
#include "core/theory/stability.h"
#include "core/theory/trees.h"

bool gm_scheme_coefficients_open(struct gm_arena *arena, const struct gm_scheme *scheme,
                                 struct gm_coefficients *coefficients)
{
    if (scheme->exact) {
        gm_coefficients_copy(arena, coefficients, scheme->exact);
    } else if (scheme->family->coefficients_open) {
        scheme->family->coefficients_open(arena, scheme, coefficients);
    }
    return gm_scheme_has_coefficients(scheme);
}

/* The weights of each tree at the stages, `stages` balls, followed by sum_j a_ij of them for its use as a branch.
   A row of a composition begins like the one before it, and the sums of these entries are shared. */
struct weights {
    const struct gm_coefficients *method;
    struct gm_ball *of;
    struct gm_ball *sums; /* sums of a row up to each of its entries */
    struct row {
        int same, end; /* number of entries equal to the previous row; entries from `end` on are 0 */
    } * rows[GM_SIDES];
};

static void weights_open(struct gm_arena *arena, struct weights *weights,
                         const struct gm_coefficients *coefficients)
{
    const int stages = coefficients->stages;
    *weights = (struct weights){.method = coefficients};
    weights->sums = gm_arena_take(arena, (size_t)stages + 1, sizeof *weights->sums);
    for (int side = 0; side < gm_coefficients_sides(coefficients); side++) {
        struct row *rows = weights->rows[side] = gm_arena_take(arena, (size_t)stages, sizeof *rows);
        for (int i = 0; i < stages; i++) {
            const struct gm_ball *row = coefficients->a[side] + i * stages, *before = row - stages;
            while (i > 0 && rows[i].same < stages &&
                   gm_ball_is_same(&row[rows[i].same], &before[rows[i].same])) {
                rows[i].same++;
            }
            for (rows[i].end = stages; rows[i].end > 0 && gm_ball_is_zero(&row[rows[i].end - 1]);) {
                rows[i].end--;
            }
        }
    }
}

static struct gm_ball *inner(const struct weights *weights, int tree)
{
    return weights->of + (size_t)tree * 2 * (size_t)weights->method->stages;
}

static struct gm_ball *outer(const struct weights *weights, int tree)
{
    return inner(weights, tree) + weights->method->stages;
}

static void weigh(const struct gm_trees *trees, const struct weights *weights, int tree)
{
    const int stages = weights->method->stages;
    const struct gm_tree *this = &trees->trees[tree];
    for (int i = 0; i < stages; i++) {
        inner(weights, tree)[i] = this->last < 0 ? gm_ball_of(1)
                                                 : gm_ball_multiply(inner(weights, this->without)[i],
                                                                    outer(weights, this->last)[i]);
    }
    weights->sums[0] = gm_ball_of(0);
    for (int i = 0, summed = 0; i < stages; i++) {
        const struct row *row = &weights->rows[this->side][i];
        const struct gm_ball *a = weights->method->a[this->side] + i * stages;
        for (summed = row->same < summed ? row->same : summed; summed < row->end; summed++) {
            weights->sums[summed + 1] =
                gm_ball_add(weights->sums[summed], gm_ball_multiply(a[summed], inner(weights, tree)[summed]));
        }
        outer(weights, tree)[i] = weights->sums[row->end];
    }
}

static struct gm_ball residual(const struct gm_trees *trees, const struct weights *weights, int tree)
{
    const struct gm_tree *this = &trees->trees[tree];
    return gm_ball_subtract(
        gm_ball_dot(weights->method->b[this->side], inner(weights, tree), weights->method->stages),
        gm_ball_ratio(1, (long)gm_tree_density(this)));
}

/* Returns true if a residual exceeds the uncertainty of the decimals, the sum of the effects of half a unit of
   each, plus the uncertainty of the rows next to them. weights[k + 1] belongs to moved[k], in which decimals
   are exact, so the radius of its residual is the uncertainty of the rows. Round-off counts as 0. */
static bool is_beyond_doubt(const struct gm_trees *trees, const struct weights *weights, int tree,
                            struct gm_ball defect)
{
    const int count = weights->method->moved_count;
    const double rounding = 1e-60, size = fabs(gm_ball_midpoint(defect));
    double doubt = 0, of_rows = rounding;
    for (int k = 0; k < count && doubt + of_rows < size; k++) {
        const struct gm_ball moved = residual(trees, &weights[k + 1], tree);
        doubt += 1.001 * fabs(gm_ball_midpoint(gm_ball_subtract(moved, defect)));
        of_rows = fmax(of_rows, moved.radius);
    }
    return count > 0 && size > doubt + of_rows;
}

/* Checks the conditions of one order. Returns false if one fails, with the failing one in *theory. */
static bool holds(const struct gm_trees *trees, const struct weights *weights, struct gm_theory *theory)
{
    const int first = trees->first[trees->orders], last = trees->first[trees->orders + 1];
    double norm = 0;
    int failing = 0;
    for (int tree = first; tree < last; tree++) {
        const struct gm_ball defect = residual(trees, weights, tree);
        const double size = fabs(gm_ball_midpoint(defect));
        norm = gm_hypot(norm, size / trees->trees[tree].symmetry);
        if (!gm_ball_may_vanish(defect) || is_beyond_doubt(trees, weights, tree, defect)) {
            failing++;
            if (size > fabs(theory->residual)) {
                theory->residual = gm_ball_midpoint(defect);
                gm_tree_print(trees, tree, theory->condition, sizeof theory->condition);
            }
        }
    }
    if (failing == 0) {
        theory->order = trees->orders;
        theory->conditions = last;
        return true;
    }
    theory->failing = failing;
    theory->of = last - first;
    theory->error_constant = norm * gm_pow(weights->method->evaluations, theory->order);
    return false;
}

/* b(u o v) + b(v o u) = b(u) b(v), u o v being u with the branch v, for all trees with `order` vertices
   together */
static bool is_symplectic_to(const struct gm_trees *trees, const struct weights *weights, int order)
{
    const int stages = weights->method->stages;
    const struct gm_ball *b = weights->method->b[0];
    for (int u = 0; u < trees->first[order]; u++) {
        const int rest = order - trees->trees[u].order;
        for (int v = trees->first[rest]; v < trees->first[rest + 1] && v <= u; v++) {
            struct gm_ball defect = gm_ball_multiply(gm_ball_dot(b, inner(weights, u), stages),
                                                     gm_ball_dot(b, inner(weights, v), stages));
            for (int i = 0; i < stages; i++) {
                const struct gm_ball both =
                    gm_ball_add(gm_ball_multiply(inner(weights, u)[i], outer(weights, v)[i]),
                                gm_ball_multiply(inner(weights, v)[i], outer(weights, u)[i]));
                defect = gm_ball_subtract(defect, gm_ball_multiply(b[i], both));
            }
            if (!gm_ball_may_vanish(defect)) {
                return false;
            }
        }
    }
    return true;
}

/* Up to which order conditions are asked for. */
static int most_orders(enum gm_equations equations)
{
    return equations == GM_EQUATIONS_PARTITIONED ? 8 : GM_TREES_ORDER;
}

/* The weights of the last order's trees. */
static void weigh_order(const struct gm_trees *trees, struct weights *weights)
{
    const size_t each = 2 * (size_t)weights->method->stages * sizeof *weights->of;
    weights->of = gm_arena_resize(trees->arena, weights->of, (size_t)trees->first[trees->orders + 1], each);
    for (int tree = trees->first[trees->orders]; tree < trees->first[trees->orders + 1]; tree++) {
        weigh(trees, weights, tree);
    }
}

/* Order by order to the first failure. */
static void find_order(struct gm_arena *arena, const struct gm_coefficients *coefficients,
                       struct gm_theory *theory)
{
    struct gm_trees trees = gm_trees_open(arena, coefficients->equations);
    const bool plain = coefficients->equations == GM_EQUATIONS_PLAIN;
    const int moved = coefficients->moved_count;
    struct weights *weights = gm_arena_take(arena, (size_t)moved + 1, sizeof *weights);
    bool searching = true;
    for (int k = 0; k <= moved; k++) {
        weights_open(arena, &weights[k], k == 0 ? coefficients : &coefficients->moved[k - 1]);
    }
    theory->error_constant = NAN;
    for (int order = 1; searching && order <= most_orders(coefficients->equations); order++) {
        gm_trees_grow(&trees);
        for (int k = 0; k <= moved; k++) {
            weigh_order(&trees, &weights[k]);
        }
        searching = holds(&trees, weights, theory);
    }
    theory->at_least = searching;
    bool symplectic = plain && !theory->symplectic;
    for (int order = 2; symplectic && order <= trees.orders; order++) {
        symplectic = is_symplectic_to(&trees, &weights[0], order);
        theory->pseudo_symplectic = symplectic ? order : theory->pseudo_symplectic;
    }
}

static struct gm_ball at(const struct gm_coefficients *coefficients, int side, int i, int j)
{
    return coefficients->a[side][i * coefficients->stages + j];
}

/* Residuals of conditions, which all vanish where these hold. */
struct residuals {
    struct gm_arena *arena;
    struct gm_ball *at;
    size_t count;
};

static void take(struct residuals *all, struct gm_ball residual)
{
    all->at = gm_arena_grown(all->arena, all->at, all->count, sizeof *all->at);
    all->at[all->count++] = residual;
}

static void take_symplecticity(const struct gm_coefficients *coefficients, struct residuals *all)
{
    const int s = coefficients->stages, other = gm_coefficients_sides(coefficients) - 1;
    for (int i = 0; i < s; i++) {
        const struct gm_ball b = coefficients->b[0][i];
        for (int j = 0; j < s; j++) {
            const struct gm_ball d = coefficients->b[other][j];
            const struct gm_ball sum = gm_ball_add(gm_ball_multiply(b, at(coefficients, other, i, j)),
                                                   gm_ball_multiply(d, at(coefficients, 0, j, i)));
            take(all, gm_ball_subtract(sum, gm_ball_multiply(b, d)));
        }
        if (coefficients->equations == GM_EQUATIONS_PARTITIONED) {
            take(all, gm_ball_subtract(b, coefficients->b[other][i]));
        }
    }
}

/* Returns true if a stage's value on this side is used. If each function depends on the other side alone, it is used
   only if the other function is evaluated at this stage. */
static bool is_asked_for(const struct gm_coefficients *coefficients, int side, int stage)
{
    if (coefficients->equations == GM_EQUATIONS_PLAIN ||
        coefficients->equations == GM_EQUATIONS_PARTITIONED) {
        return true;
    }
    bool taken = !gm_ball_may_vanish(coefficients->b[1 - side][stage]);
    for (int i = 0; i < coefficients->stages && !taken; i++) {
        taken = !gm_ball_may_vanish(at(coefficients, 1 - side, i, stage));
    }
    return taken;
}

/* Numbers of each stage that do not depend on how the stages are counted: b_i, (b' A)_i, and with c = A 1 the rows of c,
   A c, A c^2 and A A c; of the method or, `back`, of its adjoint's a_ij = b_j - a_ij. */
enum { MARKS = 6 };

static void mark_stages(const struct gm_coefficients *coefficients, bool back, double (*marks)[MARKS])
{
    const int s = coefficients->stages;
    for (int pass = 0; pass < 3; pass++) {
        for (int i = 0; i < s; i++) {
            for (int j = 0; j < s; j++) {
                const double b = gm_ball_midpoint(coefficients->b[0][j]),
                             forth = gm_ball_midpoint(at(coefficients, 0, i, j)),
                             a = back ? b - forth : forth, c = marks[j][2];
                marks[j][0] = b;
                if (pass == 0) {
                    marks[j][1] += gm_ball_midpoint(coefficients->b[0][i]) * a;
                    marks[i][2] += a;
                } else if (pass == 1) {
                    marks[i][3] += a * c;
                    marks[i][4] += a * c * c;
                } else {
                    marks[i][5] += a * marks[j][3];
                }
            }
        }
    }
}

static double apart(const double *a, const double *b)
{
    double largest = 0;
    for (int k = 0; k < MARKS; k++) {
        largest = fmax(largest, fabs(a[k] - b[k]));
    }
    return largest;
}

/* Returns the stage of the method that each stage of its adjoint is, by the numbers nearest to its own: stages of a
   Runge-Kutta method may be written in any order. Of functions that are split the pieces have theirs, which is
   reversed. */
static int *pair_stages(struct gm_arena *arena, const struct gm_coefficients *coefficients)
{
    const int s = coefficients->stages;
    int *pair = gm_arena_take(arena, (size_t)s, sizeof *pair);
    bool *taken = gm_arena_take(arena, (size_t)s, sizeof *taken);
    double(*forth)[MARKS] = gm_arena_take(arena, (size_t)s, sizeof *forth),
    (*back)[MARKS] = gm_arena_take(arena, (size_t)s, sizeof *back);
    const bool plain = coefficients->equations == GM_EQUATIONS_PLAIN;
    mark_stages(coefficients, false, forth);
    mark_stages(coefficients, true, back);
    for (int i = 0; i < s; i++) {
        double nearest = INFINITY;
        for (int j = s - 1; j >= 0 && plain; j--) {
            const double distance = apart(back[i], forth[j]);
            if (!taken[j] && distance < nearest) {
                nearest = distance;
                pair[i] = j;
            }
        }
        pair[i] = plain ? pair[i] : s - 1 - i;
        taken[pair[i]] = true;
    }
    return pair;
}

/* b_(sigma i) = b_i,  a_(sigma i, sigma j) + a_ij = b_j */
static void take_symmetry(const struct gm_coefficients *coefficients, struct residuals *all)
{
    const int s = coefficients->stages, *sigma = pair_stages(all->arena, coefficients);
    bool *asked = gm_arena_take(all->arena, (size_t)s, sizeof *asked);
    for (int side = 0; side < gm_coefficients_sides(coefficients); side++) {
        const struct gm_ball *b = coefficients->b[side];
        for (int i = 0; i < s; i++) {
            asked[i] = is_asked_for(coefficients, side, i);
        }
        for (int j = 0; j < s; j++) {
            take(all, gm_ball_subtract(b[j], b[sigma[j]]));
            for (int i = 0; i < s; i++) {
                const struct gm_ball sum =
                    gm_ball_add(at(coefficients, side, sigma[i], sigma[j]), at(coefficients, side, i, j));
                if (asked[i]) {
                    take(all, gm_ball_subtract(sum, b[j]));
                }
            }
        }
    }
}

/* From a stage of a Nystrom method to its end, e - c, of which c - 1 and e - 1 are coefficients. */
static struct gm_ball rest_of(const struct gm_coefficients *coefficients, int stage)
{
    const int start = coefficients->nystrom;
    return gm_ball_subtract(coefficients->b[GM_SIDE_Q][start], at(coefficients, GM_SIDE_Q, stage, start));
}

/* The conditions of a Nystrom method (Y.B. Suris, 1989; M.P. Calvo & J.M. Sanz-Serna, 1993), with sigma i = s + 1 - i
   and e = 1:
       symplectic    b_i = bv_i (e - c_i),   bv_i (b_j - a_ij) = bv_j (b_i - a_ji)
       symmetric     c_(sigma i) + c_i = e,   bv_(sigma i) = bv_i,   b_(sigma i) + b_i = e bv_i,
                     a_(sigma i, sigma j) = a_ij + (e - c_i) bv_j - b_j */
static void take_nystrom_symplecticity(const struct gm_coefficients *coefficients, struct residuals *all)
{
    const int s = coefficients->nystrom, end = s + 1;
    const struct gm_ball *bv = coefficients->b[GM_SIDE_P];
    for (int i = 0; i < s; i++) {
        const struct gm_ball b = at(coefficients, GM_SIDE_P, end, i);
        take(all, gm_ball_subtract(b, gm_ball_multiply(bv[i], rest_of(coefficients, i))));
        for (int j = 0; j < s; j++) {
            const struct gm_ball there =
                gm_ball_subtract(at(coefficients, GM_SIDE_P, end, j), at(coefficients, GM_SIDE_P, i, j));
            const struct gm_ball back = gm_ball_subtract(b, at(coefficients, GM_SIDE_P, j, i));
            take(all, gm_ball_subtract(gm_ball_multiply(bv[i], there), gm_ball_multiply(bv[j], back)));
        }
    }
}

static void take_nystrom_symmetry(const struct gm_coefficients *coefficients, struct residuals *all)
{
    const int s = coefficients->nystrom, end = s + 1;
    const struct gm_ball *bv = coefficients->b[GM_SIDE_P];
    const struct gm_ball length = gm_ball_add(coefficients->b[GM_SIDE_Q][s], gm_ball_of(1));
    for (int i = 0; i < s; i++) {
        const int k = s - 1 - i;
        const struct gm_ball rest = rest_of(coefficients, i);
        const struct gm_ball both =
            gm_ball_add(at(coefficients, GM_SIDE_P, end, i), at(coefficients, GM_SIDE_P, end, k));
        take(all, gm_ball_subtract(gm_ball_add(rest, rest_of(coefficients, k)), length));
        take(all, gm_ball_subtract(bv[i], bv[k]));
        take(all, gm_ball_subtract(both, gm_ball_multiply(length, bv[i])));
        for (int j = 0; j < s; j++) {
            const struct gm_ball mine = gm_ball_subtract(
                gm_ball_add(at(coefficients, GM_SIDE_P, i, j), gm_ball_multiply(rest, bv[j])),
                at(coefficients, GM_SIDE_P, end, j));
            take(all, gm_ball_subtract(at(coefficients, GM_SIDE_P, k, s - 1 - j), mine));
        }
    }
}

/* The simplifying assumptions, with c_i = sum_j a_ij:
       B(k)   sum_i b_i c_i^(k-1) = 1/k
       C(k)   sum_j a_ij c_j^(k-1) = c_i^k / k
       D(k)   sum_i b_i c_i^(k-1) a_ij = b_j (1 - c_j^k) / k
   asked for k <= 2 s + 1, s and s: more no method has but Euler's, whose C holds for every k. Returns the residual
   that first keeps B from holding. */
static double find_simplifying(struct gm_arena *arena, const struct gm_coefficients *coefficients,
                               struct gm_theory *theory)
{
    const int s = coefficients->stages;
    struct gm_ball *c = gm_arena_take(arena, 2 * (size_t)s, sizeof *c), *power = c + s;
    const struct gm_ball *b = coefficients->b[0];
    double residual = NAN;
    for (int i = 0; i < s; i++) {
        c[i] = gm_ball_of(0);
        for (int j = 0; j < s; j++) {
            c[i] = gm_ball_add(c[i], at(coefficients, 0, i, j));
        }
        power[i] = gm_ball_of(1);
    }
    bool in_b = true, in_c = true, in_d = true;
    for (int k = 1; k <= 2 * s + 1 && (in_b || in_c || in_d); k++) {
        const struct gm_ball part = gm_ball_ratio(1, k);
        const struct gm_ball defect = gm_ball_subtract(gm_ball_dot(b, power, s), part);
        residual = in_b ? gm_ball_midpoint(defect) : residual;
        in_b = in_b && gm_ball_may_vanish(defect);
        for (int j = 0; j < s; j++) {
            const struct gm_ball row = gm_ball_dot(coefficients->a[0] + j * s, power, s);
            struct gm_ball column = gm_ball_of(0);
            for (int i = 0; i < s; i++) {
                column = gm_ball_add(
                    column, gm_ball_multiply(gm_ball_multiply(b[i], power[i]), at(coefficients, 0, i, j)));
            }
            const struct gm_ball next = gm_ball_multiply(power[j], c[j]);
            in_c = in_c && gm_ball_may_vanish(gm_ball_subtract(row, gm_ball_multiply(next, part)));
            const struct gm_ball rest =
                gm_ball_multiply(gm_ball_multiply(b[j], part), gm_ball_subtract(gm_ball_of(1), next));
            in_d = in_d && gm_ball_may_vanish(gm_ball_subtract(column, rest));
        }
        for (int j = 0; j < s; j++) {
            power[j] = gm_ball_multiply(power[j], c[j]);
        }
        theory->b = in_b ? k : theory->b;
        theory->c = in_c && k <= s ? k : theory->c;
        theory->d = in_d && k <= s ? k : theory->d;
    }
    return residual;
}

static void take_structure(const struct gm_coefficients *coefficients, bool symplectic, bool symmetric,
                           struct residuals *all)
{
    const bool nystrom = coefficients->nystrom > 0;
    if (symplectic) {
        (nystrom ? take_nystrom_symplecticity : take_symplecticity)(coefficients, all);
    }
    if (symmetric) {
        (nystrom ? take_nystrom_symmetry : take_symmetry)(coefficients, all);
    }
}

static bool has_structure(struct gm_arena *arena, const struct gm_coefficients *coefficients, bool symplectic,
                          bool symmetric)
{
    const size_t mark = gm_arena_mark(arena);
    struct residuals all = {.arena = arena};
    bool vanish = true;
    take_structure(coefficients, symplectic, symmetric, &all);
    for (size_t i = 0; i < all.count; i++) {
        vanish = vanish && gm_ball_may_vanish(all.at[i]);
    }
    gm_arena_release(arena, mark);
    return vanish;
}

bool gm_theory_is_symplectic(struct gm_arena *arena, const struct gm_coefficients *coefficients)
{
    return has_structure(arena, coefficients, true, false);
}

bool gm_theory_is_symmetric(struct gm_arena *arena, const struct gm_coefficients *coefficients)
{
    return has_structure(arena, coefficients, false, true);
}

/* Beyond the trees that are asked: B(p), C(k), D(l) with p <= k + l + 1, p <= 2 k + 2 make the order p
   (Butcher 1964), and without B(p) none is. */
static void simplify(struct gm_arena *arena, const struct gm_coefficients *coefficients,
                     struct gm_theory *theory)
{
    const double residual = find_simplifying(arena, coefficients, theory);
    if (theory->at_least) {
        int order = theory->b;
        order = order < theory->c + theory->d + 1 ? order : theory->c + theory->d + 1;
        order = order < 2 * theory->c + 2 ? order : 2 * theory->c + 2;
        theory->order = order > theory->order ? order : theory->order;
        theory->at_least = theory->order < theory->b;
        theory->at_most = theory->b;
    }
    if (theory->order == theory->b && theory->at_most > 0) {
        theory->residual = residual;
        snprintf(theory->condition, sizeof theory->condition, "B(%d)", theory->b + 1);
    }
}

/* The fewest significant digits to which a coefficient is known, but for those that sums of what is written have
   lost; 0: they are exact, but for the rounding of the arithmetic. */
static int digits_of(const struct gm_coefficients *coefficients)
{
    static const double rounding = 1e-40, lost = 2;
    const int s = coefficients->stages;
    double fewest = INFINITY, most = -INFINITY;
    for (int side = 0; side < gm_coefficients_sides(coefficients); side++) {
        for (int i = 0; i < s * s + s; i++) {
            const struct gm_ball ball =
                i < s * s ? coefficients->a[side][i] : coefficients->b[side][i - s * s];
            const double size = fabs(gm_ball_midpoint(ball));
            if (size > 0 && ball.radius > rounding * size) {
                const double digits = 1 + floor(gm_log10(size)) - gm_log10(2 * ball.radius);
                fewest = fmin(fewest, digits);
                most = fmax(most, digits);
            }
        }
    }
    return isfinite(fewest) ? (int)fmax(1, round(fewest > most - lost ? most : fewest)) : 0;
}

static bool is_plain(const struct gm_coefficients *coefficients)
{
    const int s = coefficients->stages;
    bool plain = true;
    for (int i = 0; i < s * s + s && coefficients->equations != GM_EQUATIONS_PLAIN; i++) {
        const bool in_a = i < s * s;
        struct gm_ball *const *table = in_a ? coefficients->a : coefficients->b;
        const int k = in_a ? i : i - s * s;
        plain = plain && gm_ball_may_vanish(gm_ball_subtract(table[GM_SIDE_Q][k], table[GM_SIDE_P][k]));
    }
    return plain || coefficients->nystrom > 0;
}

struct gm_theory gm_theory_of(struct gm_arena *arena, const struct gm_coefficients *coefficients)
{
    const size_t mark = gm_arena_mark(arena);
    struct gm_theory theory = {.known = true};
    struct gm_coefficients reduced; /* all stages are different and needed */
    gm_coefficients_copy(arena, &reduced, coefficients);
    gm_coefficients_reduce(&reduced);
    theory.symplectic = gm_theory_is_symplectic(arena, &reduced);
    theory.symmetric = gm_theory_is_symmetric(arena, &reduced);
    theory.plain = is_plain(&reduced);
    theory.digits = digits_of(&reduced);
    find_order(arena, &reduced, &theory);
    if (reduced.equations == GM_EQUATIONS_PLAIN) {
        simplify(arena, &reduced, &theory);
    }
    theory.stability = gm_theory_stability_of(arena, &reduced, theory.symmetric);
    gm_arena_release(arena, mark);
    return theory;
}

/* The body of an arena: the residuals of an order and of a structure, malloc'ed at the end. */
struct asking {
    const struct gm_coefficients *coefficients;
    int order;
    bool symplectic, symmetric;
    struct gm_ball *found;
    size_t count;
};

static void find_residuals(struct gm_arena *arena, void *data)
{
    struct asking *asking = data;
    const struct gm_coefficients *coefficients = asking->coefficients;
    struct residuals all = {.arena = arena};
    struct gm_trees trees = gm_trees_open(arena, coefficients->equations);
    struct weights weights;
    const int most = most_orders(coefficients->equations);
    weights_open(arena, &weights, coefficients);
    while (trees.orders < (asking->order < most ? asking->order : most)) {
        gm_trees_grow(&trees);
        weigh_order(&trees, &weights);
        for (int tree = trees.first[trees.orders]; tree < trees.first[trees.orders + 1]; tree++) {
            take(&all, residual(&trees, &weights, tree));
        }
    }
    take_structure(coefficients, asking->symplectic, asking->symmetric, &all);
    asking->found = malloc((all.count + 1) * sizeof *asking->found);
    gm_arena_need(arena, asking->found);
    memcpy(asking->found, all.at, all.count * sizeof *all.at);
    asking->count = all.count;
}

struct gm_ball *gm_theory_residuals(const struct gm_coefficients *coefficients, int order, bool symplectic,
                                    bool symmetric, size_t *count)
{
    struct asking asking = {coefficients, order, symplectic, symmetric, NULL, 0};
    gm_arena_run_once(find_residuals, &asking);
    *count = asking.count;
    return asking.found;
}
