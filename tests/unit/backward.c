/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Modified Hamiltonians against what shares nothing with trees: brackets of polynomials by the formula of
   Baker, Campbell & Hausdorff in the free algebra, hand-written derivatives, published coefficients, and the
   flow itself. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/arena.h"
#include "core/basics.h"
#include "core/model/equations.h"
#include "core/ode/backward/modified_energy.h"
#include "core/ode/families/splitting/splitting.h"
#include "core/ode/problems/problems.h"
#include "core/ode/user/problem.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/modified.h"
#include "core/theory/theory.h"
#include "tests/problems/problems.h"

enum { POWER = GM_MODIFIED_POWER, LETTERS = POWER + 1, WORDS = 1 << (LETTERS + 1) };

/* ---- polynomials of q and p, and their brackets ---- */

enum { DEGREE = 40 };
typedef double polynomial[DEGREE][DEGREE]; /* of q^i p^j */

/* to += factor {f, g} */
static void add_bracket(polynomial to, double factor, polynomial f, polynomial g)
{
    for (int i = 0; i < DEGREE; i++) {
        for (int j = 0; j < DEGREE; j++) {
            for (int k = 0; f[i][j] != 0 && k < DEGREE; k++) {
                for (int l = 0; l < DEGREE; l++) {
                    const double share = (double)(i * l - j * k) * f[i][j] * g[k][l];
                    if (share != 0) {
                        assert_true(i + k - 1 < DEGREE && j + l - 1 < DEGREE);
                        to[i + k - 1][j + l - 1] += factor * share;
                    }
                }
            }
        }
    }
}

static double value_of(polynomial f, double q, double p)
{
    double value = 0;
    for (int i = DEGREE; i-- > 0;) {
        double row = 0;
        for (int j = DEGREE; j-- > 0;) {
            row = row * p + f[i][j];
        }
        value = value * q + row;
    }
    return value;
}

/* ---- the free algebra of two letters: a word is its letters as bits behind a leading 1 ---- */

static int length_of(int word)
{
    int length = -1;
    for (; word > 0; word >>= 1) {
        length++;
    }
    return length;
}

static void multiply(double *product, const double *x, const double *y)
{
    static double sum[WORDS];
    memset(sum, 0, sizeof sum);
    for (int u = 1; u < WORDS; u++) {
        for (int v = 1; x[u] != 0 && v < WORDS; v++) {
            const int length = length_of(v);
            if (length_of(u) + length <= LETTERS) {
                sum[(u << length) | (v ^ (1 << length))] += x[u] * y[v];
            }
        }
    }
    memcpy(product, sum, sizeof sum);
}

/* log of the product of exp(fraction letter), the first piece to the left */
static void logarithm_of(double *logarithm, const int *letters, const double *fractions, int count)
{
    static double product[WORDS], factor[WORDS], power[WORDS];
    memset(product, 0, sizeof product);
    product[1] = 1;
    for (int k = 0; k < count; k++) {
        memset(factor, 0, sizeof factor);
        double share = 1;
        for (int word = 1, length = 0; length <= LETTERS; word = (word << 1) | letters[k]) {
            factor[word] = share;
            share *= fractions[k] / ++length;
        }
        multiply(product, product, factor);
    }
    product[1] = 0;
    memset(power, 0, sizeof power);
    memset(logarithm, 0, WORDS * sizeof *logarithm);
    power[1] = 1;
    for (int n = 1; n <= LETTERS; n++) {
        multiply(power, power, product);
        for (int word = 1; word < WORDS; word++) {
            logarithm[word] += (n % 2 ? 1. : -1.) / n * power[word];
        }
    }
}

static polynomial parts[2], bch[LETTERS];

/* bch[k] := H_k by Dynkin's projection, sum over words of their coefficient times [w1, [w2, ...]] / length.
   With L_A f = {f, A} a map that is A's flow, then B's, is exp(h L_A) exp(h L_B) on functions, and [L_A, L_B]
   = L_{B, A}. */
static void find_terms(const int *letters, const double *fractions, int count)
{
    static double logarithm[WORDS];
    static polynomial nested, outer;
    logarithm_of(logarithm, letters, fractions, count);
    memset(bch, 0, sizeof bch);
    for (int word = 2; word < WORDS; word++) {
        const int length = length_of(word);
        if (fabs(logarithm[word]) < 1e-14) {
            continue;
        }
        memcpy(nested, parts[word & 1], sizeof nested);
        for (int k = 1; k < length; k++) {
            memset(outer, 0, sizeof outer);
            add_bracket(outer, 1, nested, parts[(word >> k) & 1]);
            memcpy(nested, outer, sizeof nested);
        }
        for (int i = 0; i < DEGREE; i++) {
            for (int j = 0; j < DEGREE; j++) {
                bch[length - 1][i][j] += logarithm[word] / length * nested[i][j];
            }
        }
    }
}

/* ---- systems and schemes ---- */

struct system {
    struct gm_user_system read;
    struct gm_user_model model;
    struct gm_problem problem;
};

static void open_system(struct system *system, const char *text)
{
    struct gm_fault fault;
    assert_true(gm_equations_open(&system->read, text, strlen(text), NULL, 0, &fault));
    assert_true(gm_user_model_open(&system->model, &system->read));
    double *values = gm_equations_start(&system->read, NULL);
    assert_non_null(values);
    assert_true(gm_user_problem_open(&system->problem, &system->model, values));
    free(values);
}

static void close_system(struct system *system)
{
    gm_user_problem_close(&system->problem);
    gm_system_close(&system->read);
}

static struct gm_modified_energy *open_energy(const struct gm_problem *problem, const char *name, int power)
{
    char why[GM_MODIFIED_WHY];
    const struct gm_scheme *scheme = gm_scheme_find_for(name, problem);
    assert_non_null(scheme);
    struct gm_modified_energy *energy = gm_modified_energy_open(problem, scheme, power, why);
    if (!energy) {
        fail_msg("%s: %s", name, why);
    }
    return energy;
}

static void assert_near(const char *what, double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance * fmax(1, fabs(expected)))) {
        fail_msg("%s: %.17g, expected %.17g", what, value, expected);
    }
}

/* ---- splittings: Baker, Campbell & Hausdorff ---- */

/* T = p^2/2 + p^3/5 - p^4/8, V = q^2/2 + q^3/3 + q^4/7: all derivatives of both count */
static void splittings_by_brackets(void **unused)
{
    (void)unused;
    static const char *const schemes[] = {
        "symplectic-euler", "symplectic-euler-adjoint", "verlet", "verlet-position", "ruth3", "yoshida4",
        "yoshida6"};
    struct system system;
    open_system(&system, "coordinates: q\nmomenta: p\nH: p^2/2 + p^3/5 - p^4/8 + q^2/2 + q^3/3 + q^4/7\n"
                         "start: q = 0.3, p = 0.4\n");
    parts[GM_DRIFT][0][2] = 1. / 2;
    parts[GM_DRIFT][0][3] = 1. / 5;
    parts[GM_DRIFT][0][4] = -1. / 8;
    parts[GM_KICK][2][0] = 1. / 2;
    parts[GM_KICK][3][0] = 1. / 3;
    parts[GM_KICK][4][0] = 1. / 7;
    int tried = 0;
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        const struct gm_scheme *scheme = gm_scheme_find_for(schemes[i], &system.problem);
        if (!scheme) {
            continue;
        }
        const struct gm_splitting *splitting = scheme->coefficients;
        int letters[GM_COUNT(splitting->pieces)];
        double fractions[GM_COUNT(splitting->pieces)];
        for (int k = 0; k < splitting->count; k++) {
            letters[k] = (int)splitting->pieces[k].piece;
            fractions[k] = splitting->pieces[k].fraction;
        }
        find_terms(letters, fractions, splitting->count);
        struct gm_modified_energy *energy = open_energy(&system.problem, schemes[i], POWER);
        const double states[][2] = {{0.3, 0.4}, {-0.7, 0.2}, {0.1, -1.1}};
        for (size_t at = 0; at < GM_COUNT(states); at++) {
            double found[POWER + 1];
            gm_modified_energy_terms(energy, states[at], found);
            for (int k = 0; k <= POWER; k++) {
                char what[64];
                snprintf(what, sizeof what, "%s, H_%d", schemes[i], k);
                assert_near(what, found[k], value_of(bch[k], states[at][0], states[at][1]), 2e-13);
            }
        }
        gm_modified_energy_close(energy);
        tried++;
    }
    assert_true(tried >= 6);
    close_system(&system);
}

/* Of V = -cos q, by hand. */
static void verlet_by_hand(void **unused)
{
    (void)unused;
    struct gm_modified_energy *energy = open_energy(&gm_problem_pendulum, "verlet", POWER);
    for (double q = -3; q < 3; q += 0.7) {
        const double p = 0.4 + q / 5, y[] = {q, p};
        const double v1 = sin(q), v2 = cos(q), v3 = -sin(q), v4 = -cos(q);
        double terms[POWER + 1];
        gm_modified_energy_terms(energy, y, terms);
        assert_near("H", terms[0], p * p / 2 - cos(q), 1e-15);
        assert_near("H_1", terms[1], 0, 0);
        assert_near("H_2", terms[2], p * p * v2 / 12 - v1 * v1 / 24, 1e-15);
        assert_near("H_3", terms[3], 0, 0);
        assert_near("H_4", terms[4],
                    -p * p * p * p * v4 / 720 + p * p * v1 * v3 / 120 + p * p * v2 * v2 / 60 -
                        v1 * v1 * v2 / 240,
                    1e-15);
    }
    gm_modified_energy_close(energy);
}

/* On the oscillator H - dt p q / 2 is kept exactly: of this variant, and of its adjoint with the other
   sign. */
static void symplectic_euler(void **unused)
{
    (void)unused;
    static const char *const schemes[] = {"symplectic-euler", "symplectic-euler-adjoint"};
    const struct gm_problem *problem = &gm_problem_oscillator;
    const double dt = 0.1, y0[] = {0.3, 0.8};
    double signs = 1;
    for (size_t i = 0; i < 2; i++) {
        struct gm_modified_energy *energy = open_energy(problem, schemes[i], 1);
        struct gm_run *run = gm_run_open(problem, gm_scheme_find_for(schemes[i], problem),
                                         &(const struct gm_settings){0}, 0, dt, y0);
        double terms[2], least = INFINITY, most = -INFINITY;
        for (int step = 0; step < 1000; step++) {
            gm_run_advance(run, 1);
            const double *y = gm_run_state(run);
            gm_modified_energy_terms(energy, y, terms);
            least = fmin(least, terms[0] + dt * terms[1]);
            most = fmax(most, terms[0] + dt * terms[1]);
            assert_near(schemes[i], fabs(terms[1]), fabs(y[0] * y[1] / 2), 1e-15);
        }
        assert_true(most - least < 1e-14);
        signs *= terms[1] * gm_run_state(run)[0] * gm_run_state(run)[1] > 0 ? 1 : -1;
        gm_run_close(run);
        gm_modified_energy_close(energy);
    }
    assert_true(signs < 0); /* one has each sign */
}

/* ---- the modified equation of Runge-Kutta methods ---- */

/* y' = y has the trees t[t[t...]], y' = g(t) the trees t[t,t,...]: their coefficients are those of the
   logarithm of the stability function, and of the asymptotic error of the quadrature. */
static void known_series(void **unused)
{
    (void)unused;
    static const struct {
        const char *scheme;
        double tall[8], bushy[8]; /* of so many vertices */
    } known[] = {
        {"midpoint",
         {0, 1, 0, 1. / 12, 0, 1. / 80, 0, 1. / 448},
         {0, 1, 0, -1. / 12, 0, 7. / 240, 0, -31. / 1344}},
        {"gauss4", {0, 1, 0, 0, 0, -1. / 720, 0, -1. / 12096}, {0, 1, 0, 0, 0, -1. / 180, 0, NAN}},
        {"rk4", {0, 1, 0, 0, 0, -1. / 120, 1. / 144, -1. / 336}, {0, 1, 0, 0, 0, 1. / 120, NAN, NAN}},
    };
    for (size_t i = 0; i < GM_COUNT(known); i++) {
        struct gm_coefficients coefficients;
        struct gm_arena *arena = gm_arena_open();
        struct gm_trees trees = gm_trees_open(arena, GM_EQUATIONS_PLAIN);
        assert_true(gm_scheme_coefficients_open(arena, gm_scheme_find(known[i].scheme), &coefficients));
        for (int order = 1; order <= GM_MODIFIED_ORDER; order++) {
            gm_trees_grow(&trees);
        }
        const struct gm_ball *equation = gm_modified_equation(&trees, &coefficients);
        int tall = 0, bushy = 0;
        for (int tree = 0; tree < trees.first[GM_MODIFIED_ORDER + 1]; tree++) {
            const struct gm_tree *this = &trees.trees[tree];
            const double found = gm_ball_midpoint(equation[tree]);
            if (tree == 0 || (this->without == 0 && this->last == tall)) {
                tall = tree;
                assert_near(known[i].scheme, found, known[i].tall[this->order], 1e-14);
            }
            if (tree == 0 || (this->without == bushy && this->last == 0)) {
                bushy = tree;
                if (!isnan(known[i].bushy[this->order])) {
                    assert_near(known[i].scheme, found, known[i].bushy[this->order], 1e-14);
                }
            }
        }
        assert_int_equal(trees.trees[tall].order, GM_MODIFIED_ORDER);
        assert_int_equal(trees.trees[bushy].order, GM_MODIFIED_ORDER);
        gm_arena_close(arena);
    }
}

/* A tree of its own making: the parent of each vertex but the root, 0, which stands before it. */
struct drawn {
    int order, parent[GM_MODIFIED_ORDER];
};

static struct drawn draw(const struct gm_trees *trees, int tree)
{
    struct drawn drawn = {.order = 1};
    for (; trees->trees[tree].last >= 0; tree = trees->trees[tree].without) {
        const struct drawn branch = draw(trees, trees->trees[tree].last);
        for (int i = 0; i < branch.order; i++) {
            drawn.parent[drawn.order + i] = i ? drawn.order + branch.parent[i] : 0;
        }
        drawn.order += branch.order;
    }
    return drawn;
}

/* Whether vertex i is in the part that hangs on vertex `cut`. */
static bool hangs(const struct drawn *drawn, int i, int cut)
{
    while (i > cut) {
        i = drawn->parent[i];
    }
    return i == cut;
}

static struct drawn part_of(const struct drawn *drawn, int cut, bool lower)
{
    struct drawn part = {0};
    int place[GM_MODIFIED_ORDER] = {0};
    for (int i = 0; i < drawn->order; i++) {
        if (hangs(drawn, i, cut) == lower) {
            place[i] = part.order;
            part.parent[part.order++] = i > 0 && i != cut ? place[drawn->parent[i]] : 0;
        }
    }
    return part;
}

static const struct gm_coefficients *method; /* plain */

static void weigh(const struct drawn *drawn, double *weights, int vertex)
{
    const int s = method->stages;
    for (int i = 0; i < s; i++) {
        weights[i] = 1;
    }
    for (int child = vertex + 1; child < drawn->order; child++) {
        double inner[16];
        if (drawn->parent[child] != vertex) {
            continue;
        }
        weigh(drawn, inner, child);
        for (int i = 0; i < s; i++) {
            double sum = 0;
            for (int j = 0; j < s; j++) {
                sum += gm_ball_midpoint(method->a[0][i * s + j]) * inner[j];
            }
            weights[i] *= sum;
        }
    }
}

/* sum_j (1/j!) d_b^(j-1) b = a, where d_b c (tree) = sum over its edges of c(upper part) b(lower part), and
   b(tree) for the tree as a whole. Hairer, Lubich & Wanner (2006), IX.9.1. */
static double coefficient(const struct drawn *drawn);

static double derived(const struct drawn *drawn, int times)
{
    if (times == 0) {
        return coefficient(drawn);
    }
    double sum = 0;
    for (int cut = 1; cut < drawn->order; cut++) {
        const struct drawn lower = part_of(drawn, cut, true), upper = part_of(drawn, cut, false);
        sum += derived(&upper, times - 1) * coefficient(&lower);
    }
    return sum;
}

static double coefficient(const struct drawn *drawn)
{
    double weights[16], sum = 0, factorial = 1;
    weigh(drawn, weights, 0);
    for (int i = 0; i < method->stages; i++) {
        sum += gm_ball_midpoint(method->b[0][i]) * weights[i];
    }
    for (int j = 2; j <= drawn->order; j++) {
        factorial *= j;
        sum -= derived(drawn, j - 1) / factorial;
    }
    return sum;
}

static void runge_kutta_by_recursion(void **unused)
{
    (void)unused;
    enum { ORDER = 6 };
    static const char *const schemes[] = {"midpoint", "gauss4", "gauss6", "rk4", "radau3", "explicit-euler"};
    int tried = 0;
    for (size_t i = 0; i < GM_COUNT(schemes); i++) {
        struct gm_coefficients coefficients;
        if (!gm_scheme_find(schemes[i])) {
            continue;
        }
        struct gm_arena *arena = gm_arena_open();
        struct gm_trees trees = gm_trees_open(arena, GM_EQUATIONS_PLAIN);
        assert_true(gm_scheme_coefficients_open(arena, gm_scheme_find(schemes[i]), &coefficients));
        method = &coefficients;
        for (int order = 1; order <= ORDER; order++) {
            gm_trees_grow(&trees);
        }
        const struct gm_ball *equation = gm_modified_equation(&trees, &coefficients);
        for (int tree = 0; tree < trees.first[ORDER + 1]; tree++) {
            const struct drawn drawn = draw(&trees, tree);
            char what[128];
            gm_tree_print(&trees, tree, what, sizeof what);
            assert_near(what, gm_ball_midpoint(equation[tree]), coefficient(&drawn), 1e-13);
        }
        gm_arena_close(arena);
        tried++;
    }
    assert_true(tried >= 4);
}

/* ---- along runs ---- */

/* The largest error of H~ cut off after dt^power, over the time 10; `spoilt`: with a term H_spoilt that is
   wrong by a percent. */
static double error_of(const struct gm_problem *problem, const char *scheme, const double *y0, double dt,
                       int power, int spoilt)
{
    struct gm_modified_energy *energy = open_energy(problem, scheme, power);
    struct gm_run *run =
        gm_run_open(problem, gm_scheme_find_for(scheme, problem), &(const struct gm_settings){0}, 0, dt, y0);
    double first = 0, error = 0;
    for (long step = 0; step * dt <= 10; step++) {
        double terms[POWER + 1], sum = 0;
        gm_modified_energy_terms(energy, gm_run_state(run), terms);
        terms[spoilt] *= spoilt > 0 ? 1.01 : 1;
        for (int k = power; k >= 0; k--) {
            sum = sum * dt + terms[k];
        }
        first = step == 0 ? sum : first;
        error = fmax(error, fabs(sum - first));
        assert_int_equal(gm_run_advance(run, 1), GM_OK);
    }
    gm_run_close(run);
    gm_modified_energy_close(energy);
    return error;
}

static double slope_of(const struct gm_problem *problem, const char *scheme, const double *y0, double dt,
                       int power, int spoilt)
{
    return log2(error_of(problem, scheme, y0, dt, power, spoilt) /
                error_of(problem, scheme, y0, dt / 2, power, spoilt));
}

static void slopes(void **unused)
{
    (void)unused;
    static const double one = 1;
    const double plane[] = {0.2, 1.3}, galaxy[] = {0.1, -0.2, 0.3, 0.25},
                 ring[] = {1, -0.2, -0.7, 0.1, 0.9, -0.8};
    struct gm_problem vortices = gm_problem_vortices;
    vortices.n = 6;
    vortices.parameters = &one;
    const struct {
        const struct gm_problem *problem;
        const double *y0;
        const char *scheme;
        double dt;
        int power;
        double slope;
    } rows[] = {
        {&gm_problem_pendulum, plane, "verlet", 0.05, 0, 2},
        {&gm_problem_pendulum, plane, "verlet", 0.05, 2, 4},
        {&gm_problem_pendulum, plane, "verlet", 0.05, 4, 6},
        {&gm_problem_pendulum, plane, "verlet", 0.1, 6, 8},
        {&gm_problem_pendulum, plane, "gauss4", 0.2, 4, 6},
        {&gm_problem_pendulum, plane, "midpoint", 0.1, 4, 6},
        {&gm_problem_pendulum, plane, "yoshida4", 0.05, 4, 6},
        {&gm_problem_henon_heiles, galaxy, "midpoint", 0.2, 6, 8},
        {&gm_problem_henon_heiles, galaxy, "yoshida6", 0.2, 6, 8},
        {&gm_problem_henon_heiles, galaxy, "blanes-moan4", 0.2, 4, 6},
        /* where H does not split */
        {&gm_problem_product, plane, "symplectic-euler", 0.01, 1, 2},
        {&gm_problem_product, plane, "symplectic-euler", 0.01, 3, 4},
        {&gm_problem_product, plane, "symplectic-euler", 0.02, 5, 6},
        {&gm_problem_product, plane, "lobatto2", 0.02, 2, 4},
        {&gm_problem_product, plane, "lobatto4", 0.1, 4, 6},
        {&gm_problem_product, plane, "lobatto4", 0.1, 6, 8},
        /* with a weight */
        {&vortices, ring, "midpoint", 0.2, 2, 4},
        {&vortices, ring, "gauss4", 0.4, 4, 6},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        char what[64];
        snprintf(what, sizeof what, "%s on %s, cut off after dt^%d", rows[i].scheme, rows[i].problem->name,
                 rows[i].power);
        const double slope =
            slope_of(rows[i].problem, rows[i].scheme, rows[i].y0, rows[i].dt, rows[i].power, 0);
        if (!(fabs(slope - rows[i].slope) < (i < 3 ? 0.05 : 0.3))) {
            fail_msg("%s: a slope of %.3f, expected %.0f", what, slope, rows[i].slope);
        }
    }
}

/* A coefficient that is wrong by a percent is another method's. */
static void wrong_coefficients(void **unused)
{
    (void)unused;
    const double y0[] = {0.2, 1.3};
    assert_true(slope_of(&gm_problem_pendulum, "verlet", y0, 0.05, 2, 2) < 2.5);
    assert_true(slope_of(&gm_problem_pendulum, "verlet", y0, 0.05, 4, 4) < 4.5);
    assert_true(slope_of(&gm_problem_pendulum, "midpoint", y0, 0.05, 4, 4) < 4.5);
}

static void refusals(void **unused)
{
    (void)unused;
    char why[GM_MODIFIED_WHY];
    const struct gm_problem *problem = &gm_problem_pendulum;
    assert_null(gm_modified_energy_open(problem, gm_scheme_find("rk4"), POWER, why));
    assert_non_null(strstr(why, "not symplectic"));
    assert_null(gm_modified_energy_open(&gm_problem_abc, gm_scheme_find("midpoint"), POWER, why));
    assert_non_null(strstr(why, "no Hamiltonian"));
    struct system system;
    open_system(&system, "coordinates: q\nmomenta: p\nH: p^2/2 + abs(q)\nstart: q = 0.3, p = 0.4\n");
    assert_null(gm_modified_energy_open(&system.problem, gm_scheme_find("midpoint"), POWER, why));
    assert_non_null(strstr(why, "not smooth"));
    close_system(&system);
}

/* What is written once more is what is computed. */
static void formulas(void **unused)
{
    (void)unused;
    static const double one = 0.7, stiff = 30;
    struct gm_problem problems[14] = {gm_problem_oscillator,
                                      gm_problem_pendulum,
                                      gm_problem_henon_heiles,
                                      gm_problem_kepler,
                                      gm_problem_kepler_perturbed,
                                      gm_problem_spring_pendulum,
                                      gm_problem_product,
                                      gm_problem_vortices,
                                      gm_problem_vortices_reduced,
                                      gm_problem_fpu_1,
                                      gm_problem_fpu,
                                      gm_problem_oscillator_tangent,
                                      gm_problem_pendulum_tangent,
                                      gm_problem_fish_eye};
    for (size_t i = 0; i < GM_COUNT(problems); i++) {
        struct gm_problem *problem = &problems[i];
        problem->parameters = i >= 9 || i == 5 ? &stiff : &one;
        double y[20], value, terms[1];
        for (size_t c = 0; c < problem->n; c++) {
            y[c] = sin(3. * (double)c + 1) + 0.2 * (double)c;
        }
        gm_ode_of(problem)->hamiltonian->energy(problem, y, &value, 1);
        struct gm_modified_energy *energy = open_energy(problem, "midpoint", 0);
        gm_modified_energy_terms(energy, y, terms);
        assert_near(problem->name, terms[0], value, 1e-14);
        gm_modified_energy_close(energy);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(splittings_by_brackets),
        cmocka_unit_test(verlet_by_hand),
        cmocka_unit_test(symplectic_euler),
        cmocka_unit_test(known_series),
        cmocka_unit_test(runge_kutta_by_recursion),
        cmocka_unit_test(slopes),
        cmocka_unit_test(wrong_coefficients),
        cmocka_unit_test(refusals),
        cmocka_unit_test(formulas),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
