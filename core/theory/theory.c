/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Order, with Phi_i of a tree with branches u, v, ... (Butcher's product of weights):
       Phi_i = prod_(branches u) sum_j a_ij Phi_j(u),   condition   sum_i b_i Phi_i = 1 / gamma
   a and b being those of the side of u, of the tree. Structure, sigma i = s + 1 - i being the stages backwards:
       symplectic    b_i c_ij + d_j a_ji = b_i d_j,   b = d where f_q, f_p know both
       symmetric     a_(sigma i, sigma j) + a_ij = b_j = b_(sigma j), on both sides
   E. Hairer, C. Lubich & G. Wanner, Geometric Numerical Integration (2006), II.1, III.1, III.2, V.2, VI.4, VI.7.2,
   IX.8. */
#include "core/theory/theory.h"

#include <math.h>
#include <stdlib.h>

#include "core/theory/stability.h"
#include "core/theory/trees.h"

/* Every tree's weights of the stages, stages balls, and behind them sum_j a_ij of these, where it is a branch. */
struct weights {
    struct gm_ball *of;
    int stages;
};

static struct gm_ball *inner(const struct weights *weights, int tree)
{
    return weights->of + (size_t)tree * 2 * (size_t)weights->stages;
}

static struct gm_ball *outer(const struct weights *weights, int tree)
{
    return inner(weights, tree) + weights->stages;
}

/* x' y */
static struct gm_ball product(const struct gm_ball *x, const struct gm_ball *y, int count)
{
    struct gm_ball sum = gm_ball_of(0);
    for (int i = 0; i < count; i++) {
        sum = gm_ball_add(sum, gm_ball_multiply(x[i], y[i]));
    }
    return sum;
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
    for (int i = 0; i < stages; i++) {
        outer(weights, tree)[i] =
            product(coefficients->a[this->side] + (size_t)i * (size_t)stages, inner(weights, tree), stages);
    }
}

static struct gm_ball residual(const struct gm_coefficients *coefficients, const struct gm_trees *trees,
                               const struct weights *weights, int tree)
{
    const struct gm_tree *this = &trees->trees[tree];
    return gm_ball_subtract(product(coefficients->b[this->side], inner(weights, tree), coefficients->stages),
                            gm_ball_ratio(1, (long)gm_tree_density(this)));
}

/* The conditions of one order; false, with what fails, where one does. */
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
        if (!gm_ball_may_vanish(defect)) {
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

/* b(u o v) + b(v o u) = b(u) b(v), u o v being u with the branch v, for all trees with `order` vertices together */
static bool is_symplectic_to(const struct gm_coefficients *coefficients, const struct gm_trees *trees,
                             const struct weights *weights, int order)
{
    const int stages = coefficients->stages;
    const struct gm_ball *b = coefficients->b[0];
    for (int u = 0; u < trees->first[order]; u++) {
        const int rest = order - trees->trees[u].order;
        for (int v = trees->first[rest]; v < trees->first[rest + 1] && v <= u; v++) {
            struct gm_ball defect = gm_ball_multiply(product(b, inner(weights, u), stages),
                                                     product(b, inner(weights, v), stages));
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

/* Order by order to the first failure. False: out of memory. */
static bool find_order(const struct gm_coefficients *coefficients, struct gm_theory *theory)
{
    struct gm_trees trees;
    struct weights weights = {.stages = coefficients->stages};
    const size_t each = 2 * (size_t)coefficients->stages * sizeof *weights.of;
    const bool plain = coefficients->equations == GM_EQUATIONS_PLAIN;
    bool good = true, searching = true;
    theory->error_constant = NAN;
    gm_trees_open(&trees, coefficients->equations);
    for (int order = 1; good && searching && order <= most_orders(coefficients->equations); order++) {
        good = gm_trees_grow(&trees);
        struct gm_ball *grown =
            good ? realloc(weights.of, (size_t)trees.first[trees.orders + 1] * each) : NULL;
        good = grown != NULL;
        if (!good) {
            break;
        }
        weights.of = grown;
        for (int tree = trees.first[order]; tree < trees.first[order + 1]; tree++) {
            weigh(coefficients, &trees, &weights, tree);
        }
        searching = holds(coefficients, &trees, &weights, theory);
    }
    theory->at_least = searching;
    bool symplectic = plain && !theory->symplectic;
    for (int order = 2; good && symplectic && order <= trees.orders; order++) {
        symplectic = is_symplectic_to(coefficients, &trees, &weights, order);
        theory->pseudo_symplectic = symplectic ? order : theory->pseudo_symplectic;
    }
    free(weights.of);
    gm_trees_close(&trees);
    return good;
}

static struct gm_ball at(const struct gm_coefficients *coefficients, int side, int i, int j)
{
    return coefficients->a[side][i * coefficients->stages + j];
}

static bool is_symplectic(const struct gm_coefficients *coefficients)
{
    const int s = coefficients->stages, other = gm_coefficients_sides(coefficients) - 1;
    for (int i = 0; i < s; i++) {
        const struct gm_ball b = coefficients->b[0][i];
        for (int j = 0; j < s; j++) {
            const struct gm_ball d = coefficients->b[other][j];
            const struct gm_ball sum = gm_ball_add(gm_ball_multiply(b, at(coefficients, other, i, j)),
                                                   gm_ball_multiply(d, at(coefficients, 0, j, i)));
            if (!gm_ball_may_vanish(gm_ball_subtract(sum, gm_ball_multiply(b, d)))) {
                return false;
            }
        }
        if (coefficients->equations == GM_EQUATIONS_PARTITIONED &&
            !gm_ball_may_vanish(gm_ball_subtract(b, coefficients->b[other][i]))) {
            return false;
        }
    }
    return true;
}

/* Whether a stage's value on this side is ever asked for: where functions know the other side alone, only if the
   other function is taken there. */
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

static bool is_symmetric(const struct gm_coefficients *coefficients)
{
    const int s = coefficients->stages;
    for (int side = 0; side < gm_coefficients_sides(coefficients); side++) {
        const struct gm_ball *b = coefficients->b[side];
        for (int j = 0; j < s; j++) {
            if (!gm_ball_may_vanish(gm_ball_subtract(b[j], b[s - 1 - j]))) {
                return false;
            }
            for (int i = 0; i < s; i++) {
                const struct gm_ball sum =
                    gm_ball_add(at(coefficients, side, s - 1 - i, s - 1 - j), at(coefficients, side, i, j));
                if (is_asked_for(coefficients, side, i) && !gm_ball_may_vanish(gm_ball_subtract(sum, b[j]))) {
                    return false;
                }
            }
        }
    }
    return true;
}

/* The simplifying assumptions, with c_i = sum_j a_ij:
       B(k)   sum_i b_i c_i^(k-1) = 1/k
       C(k)   sum_j a_ij c_j^(k-1) = c_i^k / k
       D(k)   sum_i b_i c_i^(k-1) a_ij = b_j (1 - c_j^k) / k
   False: out of memory. */
static bool find_simplifying(const struct gm_coefficients *coefficients, struct gm_theory *theory)
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
    for (int k = 1; k <= 2 * s && (in_b || in_c || in_d); k++) {
        const struct gm_ball part = gm_ball_ratio(1, k);
        in_b = in_b && gm_ball_may_vanish(gm_ball_subtract(product(b, power, s), part));
        for (int j = 0; j < s; j++) {
            struct gm_ball row = gm_ball_of(0), column = gm_ball_of(0);
            for (int i = 0; i < s; i++) {
                row = gm_ball_add(row, gm_ball_multiply(at(coefficients, 0, j, i), power[i]));
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
        theory->c = in_c ? k : theory->c;
        theory->d = in_d ? k : theory->d;
    }
    free(c);
    return true;
}

struct gm_theory gm_theory_of(const struct gm_coefficients *coefficients)
{
    struct gm_theory theory = {
        .symplectic = is_symplectic(coefficients),
        .symmetric = is_symmetric(coefficients),
    };
    theory.known =
        find_order(coefficients, &theory) &&
        (coefficients->equations != GM_EQUATIONS_PLAIN || find_simplifying(coefficients, &theory)) &&
        gm_theory_stability_of(coefficients, theory.symmetric, &theory.stability);
    return theory;
}
