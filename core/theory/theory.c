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

#include "core/theory/stability.h"
#include "core/theory/trees.h"

/* The weights of each tree at the stages, `stages` balls, followed by sum_j a_ij of them for its use as a branch.
   A row of a composition begins like the one before it, and the sums of these entries are shared. */
struct weights {
    struct gm_ball *of;
    int stages;
    struct gm_ball *sums; /* sums of a row up to each of its entries */
    struct row {
        int same, end; /* number of entries equal to the previous row; entries from `end` on are 0 */
    } * rows[GM_SIDES];
};

static void weights_close(struct weights *weights)
{
    free(weights->of);
    free(weights->sums);
    free(weights->rows[GM_SIDE_Q]);
    free(weights->rows[GM_SIDE_P]);
}

/* False: out of memory; to be closed in both cases. */
static bool weights_open(struct weights *weights, const struct gm_coefficients *coefficients)
{
    const int stages = coefficients->stages;
    *weights = (struct weights){.stages = stages};
    weights->sums = malloc(((size_t)stages + 1) * sizeof *weights->sums);
    bool good = weights->sums != NULL;
    for (int side = 0; good && side < gm_coefficients_sides(coefficients); side++) {
        struct row *rows = calloc((size_t)stages, sizeof *rows);
        weights->rows[side] = rows;
        good = rows != NULL;
        for (int i = 0; good && i < stages; i++) {
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
    return good;
}

static struct gm_ball *inner(const struct weights *weights, int tree)
{
    return weights->of + (size_t)tree * 2 * (size_t)weights->stages;
}

static struct gm_ball *outer(const struct weights *weights, int tree)
{
    return inner(weights, tree) + weights->stages;
}

static void weigh(const struct gm_coefficients *coefficients, const struct gm_trees *trees,
                  const struct weights *weights, int tree)
{
    const int stages = coefficients->stages;
    const struct gm_tree *this = &trees->trees[tree];
    for (int i = 0; i < stages; i++) {
        inner(weights, tree)[i] = this->last < 0 ? gm_ball_of(1)
                                                 : gm_ball_multiply(inner(weights, this->without)[i],
                                                                    outer(weights, this->last)[i]);
    }
    weights->sums[0] = gm_ball_of(0);
    for (int i = 0, summed = 0; i < stages; i++) {
        const struct row *row = &weights->rows[this->side][i];
        const struct gm_ball *a = coefficients->a[this->side] + i * stages;
        for (summed = row->same < summed ? row->same : summed; summed < row->end; summed++) {
            weights->sums[summed + 1] =
                gm_ball_add(weights->sums[summed], gm_ball_multiply(a[summed], inner(weights, tree)[summed]));
        }
        outer(weights, tree)[i] = weights->sums[row->end];
    }
}

static struct gm_ball residual(const struct gm_coefficients *coefficients, const struct gm_trees *trees,
                               const struct weights *weights, int tree)
{
    const struct gm_tree *this = &trees->trees[tree];
    return gm_ball_subtract(
        gm_ball_dot(coefficients->b[this->side], inner(weights, tree), coefficients->stages),
        gm_ball_ratio(1, (long)gm_tree_density(this)));
}

/* Returns true if a residual exceeds the uncertainty of the decimals, the sum of the effects of half a unit of
   each, plus the uncertainty of the rows next to them. weights[k + 1] belongs to moved[k], in which decimals
   are exact, so the radius of its residual is the uncertainty of the rows. Round-off counts as 0. */
static bool is_beyond_doubt(const struct gm_coefficients *coefficients, const struct gm_trees *trees,
                            const struct weights *weights, int tree, struct gm_ball defect)
{
    const double rounding = 1e-60, size = fabs(gm_ball_midpoint(defect));
    double doubt = 0, of_rows = rounding;
    for (int k = 0; k < coefficients->moved_count && doubt + of_rows < size; k++) {
        const struct gm_ball moved = residual(&coefficients->moved[k], trees, &weights[k + 1], tree);
        doubt += 1.001 * fabs(gm_ball_midpoint(gm_ball_subtract(moved, defect)));
        of_rows = fmax(of_rows, moved.radius);
    }
    return coefficients->moved_count > 0 && size > doubt + of_rows;
}

/* Checks the conditions of one order. Returns false if one fails, with the failing one in *theory. */
static bool holds(const struct gm_coefficients *coefficients, const struct gm_trees *trees,
                  const struct weights *weights, struct gm_theory *theory)
{
    const int first = trees->first[trees->orders], last = trees->first[trees->orders + 1];
    double norm = 0;
    int failing = 0;
    for (int tree = first; tree < last; tree++) {
        const struct gm_ball defect = residual(coefficients, trees, weights, tree);
        const double size = fabs(gm_ball_midpoint(defect));
        norm = hypot(norm, size / trees->trees[tree].symmetry);
        if (!gm_ball_may_vanish(defect) || is_beyond_doubt(coefficients, trees, weights, tree, defect)) {
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
    theory->error_constant = norm * pow(coefficients->evaluations, theory->order);
    return false;
}

/* b(u o v) + b(v o u) = b(u) b(v), u o v being u with the branch v, for all trees with `order` vertices
   together */
static bool is_symplectic_to(const struct gm_coefficients *coefficients, const struct gm_trees *trees,
                             const struct weights *weights, int order)
{
    const int stages = coefficients->stages;
    const struct gm_ball *b = coefficients->b[0];
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

/* The weights of the last order's trees. False: out of memory. */
static bool weigh_order(const struct gm_coefficients *coefficients, const struct gm_trees *trees,
                        struct weights *weights)
{
    const size_t each = 2 * (size_t)coefficients->stages * sizeof *weights->of;
    struct gm_ball *grown = realloc(weights->of, (size_t)trees->first[trees->orders + 1] * each);
    if (!grown) {
        return false;
    }
    weights->of = grown;
    for (int tree = trees->first[trees->orders]; tree < trees->first[trees->orders + 1]; tree++) {
        weigh(coefficients, trees, weights, tree);
    }
    return true;
}

/* Order by order to the first failure. False: out of memory. */
static bool find_order(const struct gm_coefficients *coefficients, struct gm_theory *theory)
{
    struct gm_trees trees;
    const bool plain = coefficients->equations == GM_EQUATIONS_PLAIN;
    const int moved = coefficients->moved_count;
    struct weights *weights = calloc((size_t)moved + 1, sizeof *weights);
    bool good = weights != NULL, searching = true;
    for (int k = 0; good && k <= moved; k++) {
        good = weights_open(&weights[k], k == 0 ? coefficients : &coefficients->moved[k - 1]);
    }
    theory->error_constant = NAN;
    gm_trees_open(&trees, coefficients->equations);
    for (int order = 1; good && searching && order <= most_orders(coefficients->equations); order++) {
        good = gm_trees_grow(&trees) && weigh_order(coefficients, &trees, &weights[0]);
        for (int k = 1; good && k <= moved; k++) {
            good = weigh_order(&coefficients->moved[k - 1], &trees, &weights[k]);
        }
        searching = good && holds(coefficients, &trees, weights, theory);
    }
    theory->at_least = searching;
    bool symplectic = plain && !theory->symplectic;
    for (int order = 2; good && symplectic && order <= trees.orders; order++) {
        symplectic = is_symplectic_to(coefficients, &trees, &weights[0], order);
        theory->pseudo_symplectic = symplectic ? order : theory->pseudo_symplectic;
    }
    for (int k = 0; weights && k <= moved; k++) {
        weights_close(&weights[k]);
    }
    free(weights);
    gm_trees_close(&trees);
    return good;
}

static struct gm_ball at(const struct gm_coefficients *coefficients, int side, int i, int j)
{
    return coefficients->a[side][i * coefficients->stages + j];
}

/* Takes what has to vanish; false: enough is known. */
typedef bool taker(void *data, struct gm_ball residual);

static bool may_vanish(void *data, struct gm_ball residual)
{
    return (void)data, gm_ball_may_vanish(residual);
}

static bool is_symplectic(const struct gm_coefficients *coefficients, taker *take, void *data)
{
    const int s = coefficients->stages, other = gm_coefficients_sides(coefficients) - 1;
    for (int i = 0; i < s; i++) {
        const struct gm_ball b = coefficients->b[0][i];
        for (int j = 0; j < s; j++) {
            const struct gm_ball d = coefficients->b[other][j];
            const struct gm_ball sum = gm_ball_add(gm_ball_multiply(b, at(coefficients, other, i, j)),
                                                   gm_ball_multiply(d, at(coefficients, 0, j, i)));
            if (!take(data, gm_ball_subtract(sum, gm_ball_multiply(b, d)))) {
                return false;
            }
        }
        if (coefficients->equations == GM_EQUATIONS_PARTITIONED &&
            !take(data, gm_ball_subtract(b, coefficients->b[other][i]))) {
            return false;
        }
    }
    return true;
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

/* The number that each stage has when they are counted by their times, c_i = sum_j a_ij: of a Runge-Kutta method
   they may be written in any order. NULL: out of memory; of functions that are split the pieces have theirs. */
static int *order_stages(const struct gm_coefficients *coefficients)
{
    const int s = coefficients->stages;
    int *order = malloc((size_t)s * sizeof *order);
    double *times = calloc((size_t)s, sizeof *times);
    for (int i = 0; order && times && i < s; i++) {
        int place = i;
        for (int j = 0; j < s && coefficients->equations == GM_EQUATIONS_PLAIN; j++) {
            times[i] += gm_ball_midpoint(at(coefficients, 0, i, j));
        }
        for (; place > 0 && times[order[place - 1]] > times[i] + 1e-9; place--) {
            order[place] = order[place - 1];
        }
        order[place] = i;
    }
    if (!times) {
        free(order);
        order = NULL;
    }
    free(times);
    return order;
}

/* b_(sigma i) = b_i,  a_(sigma i, sigma j) + a_ij = b_j;  sigma i = s + 1 - i, by the times of the stages. */
static bool is_symmetric(const struct gm_coefficients *coefficients, taker *take, void *data)
{
    const int s = coefficients->stages;
    int *order = order_stages(coefficients);
    bool symmetric = order != NULL;
    for (int side = 0; side < gm_coefficients_sides(coefficients) && symmetric; side++) {
        const struct gm_ball *b = coefficients->b[side];
        for (int j = 0; j < s && symmetric; j++) {
            const int here = order[j], there = order[s - 1 - j];
            symmetric = take(data, gm_ball_subtract(b[here], b[there]));
            for (int i = 0; i < s && symmetric; i++) {
                const struct gm_ball sum = gm_ball_add(at(coefficients, side, order[s - 1 - i], there),
                                                       at(coefficients, side, order[i], here));
                symmetric =
                    !is_asked_for(coefficients, side, order[i]) || take(data, gm_ball_subtract(sum, b[here]));
            }
        }
    }
    free(order);
    return symmetric;
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
static bool is_nystrom_symplectic(const struct gm_coefficients *coefficients, taker *take, void *data)
{
    const int s = coefficients->nystrom, end = s + 1;
    const struct gm_ball *bv = coefficients->b[GM_SIDE_P];
    for (int i = 0; i < s; i++) {
        const struct gm_ball b = at(coefficients, GM_SIDE_P, end, i);
        if (!take(data, gm_ball_subtract(b, gm_ball_multiply(bv[i], rest_of(coefficients, i))))) {
            return false;
        }
        for (int j = 0; j < s; j++) {
            const struct gm_ball there =
                gm_ball_subtract(at(coefficients, GM_SIDE_P, end, j), at(coefficients, GM_SIDE_P, i, j));
            const struct gm_ball back = gm_ball_subtract(b, at(coefficients, GM_SIDE_P, j, i));
            if (!take(data,
                      gm_ball_subtract(gm_ball_multiply(bv[i], there), gm_ball_multiply(bv[j], back)))) {
                return false;
            }
        }
    }
    return true;
}

static bool is_nystrom_symmetric(const struct gm_coefficients *coefficients, taker *take, void *data)
{
    const int s = coefficients->nystrom, end = s + 1;
    const struct gm_ball *bv = coefficients->b[GM_SIDE_P];
    const struct gm_ball length = gm_ball_add(coefficients->b[GM_SIDE_Q][s], gm_ball_of(1));
    for (int i = 0; i < s; i++) {
        const int k = s - 1 - i;
        const struct gm_ball rest = rest_of(coefficients, i);
        const struct gm_ball both =
            gm_ball_add(at(coefficients, GM_SIDE_P, end, i), at(coefficients, GM_SIDE_P, end, k));
        if (!take(data, gm_ball_subtract(gm_ball_add(rest, rest_of(coefficients, k)), length)) ||
            !take(data, gm_ball_subtract(bv[i], bv[k])) ||
            !take(data, gm_ball_subtract(both, gm_ball_multiply(length, bv[i])))) {
            return false;
        }
        for (int j = 0; j < s; j++) {
            const struct gm_ball mine = gm_ball_subtract(
                gm_ball_add(at(coefficients, GM_SIDE_P, i, j), gm_ball_multiply(rest, bv[j])),
                at(coefficients, GM_SIDE_P, end, j));
            if (!take(data, gm_ball_subtract(at(coefficients, GM_SIDE_P, k, s - 1 - j), mine))) {
                return false;
            }
        }
    }
    return true;
}

/* The simplifying assumptions, with c_i = sum_j a_ij:
       B(k)   sum_i b_i c_i^(k-1) = 1/k
       C(k)   sum_j a_ij c_j^(k-1) = c_i^k / k
       D(k)   sum_i b_i c_i^(k-1) a_ij = b_j (1 - c_j^k) / k
   asked for k <= 2 s + 1, s and s: more no method has but Euler's, whose C holds for every k. The residual is
   what first keeps B from holding. False: out of memory. */
static bool find_simplifying(const struct gm_coefficients *coefficients, struct gm_theory *theory,
                             double *residual)
{
    const int s = coefficients->stages;
    struct gm_ball *c = malloc(2 * (size_t)s * sizeof *c), *power = c ? c + s : NULL;
    if (!c) {
        return false;
    }
    const struct gm_ball *b = coefficients->b[0];
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
        *residual = in_b ? gm_ball_midpoint(defect) : *residual;
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
    free(c);
    return true;
}

bool gm_theory_is_symplectic(const struct gm_coefficients *coefficients)
{
    return coefficients->nystrom > 0 ? is_nystrom_symplectic(coefficients, may_vanish, NULL)
                                     : is_symplectic(coefficients, may_vanish, NULL);
}

bool gm_theory_is_symmetric(const struct gm_coefficients *coefficients)
{
    return coefficients->nystrom > 0 ? is_nystrom_symmetric(coefficients, may_vanish, NULL)
                                     : is_symmetric(coefficients, may_vanish, NULL);
}

/* Beyond the trees that are asked: B(p), C(k), D(l) with p <= k + l + 1, p <= 2 k + 2 make the order p
   (Butcher 1964), and without B(p) none is. False: out of memory. */
static bool simplify(const struct gm_coefficients *coefficients, struct gm_theory *theory)
{
    double residual = NAN;
    if (!find_simplifying(coefficients, theory, &residual)) {
        return false;
    }
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
    return true;
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
                const double digits = 1 + floor(log10(size)) - log10(2 * ball.radius);
                fewest = fmin(fewest, digits);
                most = fmax(most, digits);
            }
        }
    }
    return isfinite(fewest) ? (int)fmax(1, round(fewest > most - lost ? most : fewest)) : 0;
}

/* Returns the theory of a method whose stages are all different and needed. */
static struct gm_theory theory_of_reduced(const struct gm_coefficients *coefficients)
{
    struct gm_theory theory = {
        .symplectic = gm_theory_is_symplectic(coefficients),
        .symmetric = gm_theory_is_symmetric(coefficients),
    };
    theory.digits = digits_of(coefficients);
    theory.known = find_order(coefficients, &theory) &&
                   (coefficients->equations != GM_EQUATIONS_PLAIN || simplify(coefficients, &theory)) &&
                   gm_theory_stability_of(coefficients, theory.symmetric, &theory.stability);
    return theory;
}

struct gm_theory gm_theory_of(const struct gm_coefficients *coefficients)
{
    struct gm_coefficients reduced;
    if (!gm_coefficients_copy(&reduced, coefficients)) {
        return (struct gm_theory){0};
    }
    gm_coefficients_reduce(&reduced);
    const struct gm_theory theory = theory_of_reduced(&reduced);
    gm_coefficients_close(&reduced);
    return theory;
}

struct residuals {
    struct gm_ball *at;
    size_t count;
};

/* False: out of memory. */
static bool gather(void *data, struct gm_ball residual)
{
    struct residuals *all = data;
    if ((all->count & (all->count - 1)) == 0) {
        struct gm_ball *more = realloc(all->at, (all->count ? 2 * all->count : 1) * sizeof *more);
        if (!more) {
            return false;
        }
        all->at = more;
    }
    all->at[all->count++] = residual;
    return true;
}

struct gm_ball *gm_theory_residuals(const struct gm_coefficients *coefficients, int order, bool symplectic,
                                    bool symmetric, size_t *count)
{
    struct residuals all = {0};
    struct gm_trees trees;
    struct weights weights;
    const bool nystrom = coefficients->nystrom > 0;
    const int most = most_orders(coefficients->equations);
    bool good = weights_open(&weights, coefficients);
    gm_trees_open(&trees, coefficients->equations);
    while (good && trees.orders < (order < most ? order : most)) {
        good = gm_trees_grow(&trees) && weigh_order(coefficients, &trees, &weights);
        for (int tree = trees.first[trees.orders]; good && tree < trees.first[trees.orders + 1]; tree++) {
            good = gather(&all, residual(coefficients, &trees, &weights, tree));
        }
    }
    good = good &&
           (!symplectic || (nystrom ? is_nystrom_symplectic : is_symplectic)(coefficients, gather, &all));
    good =
        good && (!symmetric || (nystrom ? is_nystrom_symmetric : is_symmetric)(coefficients, gather, &all));
    weights_close(&weights);
    gm_trees_close(&trees);
    if (!good) {
        free(all.at);
        return NULL;
    }
    *count = all.count;
    return all.at;
}
