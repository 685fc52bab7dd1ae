/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The N-th power of a method is a method, whose elementary weight of a tree, Phi^N, is a polynomial of N of
   the degree |tree| without a constant. It is the flow after the time N dt of the modified equation, whose
   coefficient b(tree) is therefore its derivative at N = 0: of the polynomial through N = 0 .. n
       b = sum_(N = 1 .. n) (-1)^(N+1) binomial(n, N) Phi^N / N.
   With Phi_i of step k and W_k = sum_i b_i Phi_ki, a branch u of a stage of step k counts
       sum_(l < k) W_l(u) + sum_j a_ij Phi_kj(u). */
#include "core/theory/modified.h"

#include "core/arena.h"
#include "core/theory/theory.h"

/* Phi of every tree for each number of steps and each stage, and its value as a branch. */
struct powers {
    struct gm_ball *of;
    int steps, stages;
};

static struct gm_ball *inner(const struct powers *powers, int tree, int step)
{
    return powers->of + (((size_t)tree * 2) * (size_t)powers->steps + (size_t)step) * (size_t)powers->stages;
}

static struct gm_ball *outer(const struct powers *powers, int tree, int step)
{
    return inner(powers, tree, step) + powers->steps * powers->stages;
}

/* b(tree); the trees before it are known */
static struct gm_ball equation_of(const struct gm_coefficients *coefficients, const struct gm_trees *trees,
                                  const struct powers *powers, int tree)
{
    const struct gm_tree *this = &trees->trees[tree];
    const struct gm_ball *a = coefficients->a[this->side], *b = coefficients->b[this->side];
    const int stages = powers->stages;
    struct gm_ball weight = gm_ball_of(0), sum = weight;
    long binomial = 1;
    for (int step = 0; step < powers->steps; step++) {
        struct gm_ball *phi = inner(powers, tree, step), *branch = outer(powers, tree, step);
        for (int i = 0; i < stages; i++) {
            phi[i] = this->last < 0 ? gm_ball_of(1)
                                    : gm_ball_multiply(inner(powers, this->without, step)[i],
                                                       outer(powers, this->last, step)[i]);
        }
        for (int i = 0; i < stages; i++) {
            branch[i] = gm_ball_add(weight, gm_ball_dot(a + (size_t)i * (size_t)stages, phi, stages));
        }
        weight = gm_ball_add(weight, gm_ball_dot(b, phi, stages));
        const int power = step + 1;
        binomial = binomial * (this->order - step) / power; /* 0 beyond the tree's order */
        const struct gm_ball factor = gm_ball_ratio(power % 2 ? binomial : -binomial, power);
        sum = gm_ball_add(sum, gm_ball_multiply(factor, weight));
    }
    return sum;
}

struct gm_ball *gm_modified_equation(const struct gm_trees *trees, const struct gm_coefficients *coefficients)
{
    const int count = trees->first[trees->orders + 1];
    struct powers powers = {.steps = trees->orders, .stages = coefficients->stages};
    struct gm_ball *equation = gm_arena_take(trees->arena, (size_t)count, sizeof *equation);
    const size_t mark = gm_arena_mark(trees->arena);
    powers.of = gm_arena_take(trees->arena, (size_t)count * 2 * (size_t)powers.steps * (size_t)powers.stages,
                              sizeof *powers.of);
    for (int tree = 0; tree < count; tree++) {
        equation[tree] = equation_of(coefficients, trees, &powers, tree);
    }
    gm_arena_release(trees->arena, mark);
    return equation;
}

/* The most vertices that a branch of the root has. */
static int largest_branch(const struct gm_trees *trees, int tree)
{
    int largest = 0;
    for (const struct gm_tree *at = &trees->trees[tree]; at->last >= 0; at = &trees->trees[at->without]) {
        const int order = trees->trees[at->last].order;
        largest = order > largest ? order : largest;
    }
    return largest;
}

struct gm_modified gm_modified_of(struct gm_arena *arena, const struct gm_coefficients *coefficients,
                                  int order)
{
    const bool split =
        coefficients->equations == GM_EQUATIONS_SEPARABLE || coefficients->equations == GM_EQUATIONS_NYSTROM;
    struct gm_modified modified = {
        .trees = gm_trees_open(arena, split ? GM_EQUATIONS_SEPARABLE : coefficients->equations)};
    const struct gm_trees *trees = &modified.trees;
    while (trees->orders < order) {
        gm_trees_grow(&modified.trees);
    }
    const struct gm_ball *equation = gm_modified_equation(trees, coefficients);
    const int count = trees->first[trees->orders + 1];
    modified.terms = gm_arena_take(arena, (size_t)count, sizeof *modified.terms);
    for (int tree = 0; tree < count; tree++) {
        const struct gm_tree *this = &trees->trees[tree];
        const int twice = 2 * largest_branch(trees, tree);
        /* where H does not split, sides are those of branches */
        const bool counted = split || this->side == GM_SIDE_Q;
        if (counted && twice <= this->order && !gm_ball_may_vanish(equation[tree])) {
            const double share = twice == this->order ? 0.5 : 1;
            modified.terms[modified.count++] = (struct gm_modified_term){
                .tree = tree, .weight = share * gm_ball_midpoint(equation[tree]) / this->symmetry};
        }
    }
    return modified;
}
