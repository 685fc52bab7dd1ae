/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Random formulas by a second evaluator, which descends through the text and computes as it goes: the same
   bits from the graph, and from its tape for one state and for blocks of them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/expression/derivative.h"
#include "core/expression/reader.h"
#include "core/functions/functions.h"
#include "core/tape.h"
#include "tests/common/random_formula.h"

enum { VARIABLES = 4, POINTS = 141, FORMULAS = 3000, DEEPEST = 5 };
static const char variable_names[] = "xyzw";

/* -- the second evaluator
   ---------------------------------------------------------------------------------- */

/* A value, and whether it is one whatever the variables are. */
struct value {
    double number;
    bool constant;
};

struct descent {
    const char *at;
    const double *variables;
};

static struct value read_sum(struct descent *descent);

static double chain(double x, int n)
{
    const double root = n < 2 ? 1 : chain(x, n / 2);
    return n == 0 ? 1 : n == 1 ? x : n % 2 ? root * root * x : root * root;
}

static double raise_to(double x, struct value exponent)
{
    const double n = exponent.number;
    if (!exponent.constant || n != rint(n) || fabs(n) > 16) {
        return gm_pow(x, n);
    }
    return n < 0 ? 1 / chain(x, (int)-n) : chain(x, (int)n);
}

static double modulo(double a, double b)
{
    double rest = fmod(a, b);
    if ((rest > 0 && b < 0) || (rest < 0 && b > 0)) {
        rest += b;
    }
    return rest;
}

static double apply_function(const char *name, double a, double b)
{
    static const struct {
        const char *name;
        double (*function)(double);
    } singles[] = {{"sqrt", sqrt},    {"exp", gm_exp},   {"log", gm_log},   {"sin", gm_sin},
                   {"cos", gm_cos},   {"tan", gm_tan},   {"asin", gm_asin}, {"acos", gm_acos},
                   {"atan", gm_atan}, {"sinh", gm_sinh}, {"cosh", gm_cosh}, {"tanh", gm_tanh},
                   {"erfc", gm_erfc}, {"abs", fabs}};
    for (size_t i = 0; i < GM_COUNT(singles); i++) {
        if (strcmp(singles[i].name, name) == 0) {
            return singles[i].function(a);
        }
    }
    return strcmp(name, "atan2") == 0 ? gm_atan2(a, b)
           : strcmp(name, "mod") == 0 ? modulo(a, b)
           : strcmp(name, "min") == 0 ? (a < b ? a : b)
                                      : (a > b ? a : b);
}

static struct value read_primary(struct descent *descent)
{
    struct value result = {0, true};
    if (*descent->at == '(') {
        descent->at++;
        result = read_sum(descent);
        descent->at++;
    } else if (strchr("0123456789.", *descent->at)) {
        char *end;
        result.number = strtod(descent->at, &end);
        descent->at = end;
    } else if (descent->at[1] < 'a' || descent->at[1] > 'z') {
        result =
            (struct value){descent->variables[strchr(variable_names, *descent->at) - variable_names], false};
        descent->at++;
    } else {
        char name[8] = "";
        for (size_t i = 0; *descent->at != '('; i++) {
            name[i] = *descent->at++;
        }
        descent->at++;
        const struct value a = read_sum(descent);
        struct value b = {0, true};
        if (*descent->at == ',') {
            descent->at++;
            b = read_sum(descent);
        }
        descent->at++;
        result = (struct value){apply_function(name, a.number, b.number), a.constant && b.constant};
    }
    return result;
}

/* a sign, or a base with its exponent */
static struct value read_power(struct descent *descent)
{
    if (*descent->at == '-') {
        descent->at++;
        const struct value of = read_power(descent);
        return (struct value){-of.number, of.constant};
    }
    struct value base = read_primary(descent);
    if (*descent->at == '^') {
        descent->at++;
        const struct value exponent = read_power(descent);
        base = (struct value){raise_to(base.number, exponent), base.constant && exponent.constant};
    }
    return base;
}

static struct value read_product(struct descent *descent)
{
    struct value left = read_power(descent);
    while (*descent->at == '*' || *descent->at == '/') {
        const char sign = *descent->at++;
        const struct value right = read_power(descent);
        left.number = sign == '*' ? left.number * right.number : left.number / right.number;
        left.constant = left.constant && right.constant;
    }
    return left;
}

static struct value read_sum(struct descent *descent)
{
    struct value left = read_product(descent);
    while (*descent->at == '+' || *descent->at == '-') {
        const char sign = *descent->at++;
        const struct value right = read_product(descent);
        left.number = sign == '+' ? left.number + right.number : left.number - right.number;
        left.constant = left.constant && right.constant;
    }
    return left;
}

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    (void)sentence;
    *node = gm_formula_variable(data, (size_t)(strchr(variable_names, name->text[0]) - variable_names));
    return GM_KNOWN;
}

static bool same(double a, double b)
{
    return (isnan(a) && isnan(b)) || memcmp(&a, &b, sizeof a) == 0;
}

static void bits_are_those_of_the_text(void **unused)
{
    (void)unused;
    static const double special[] = {0, -0.0, 1, -1, INFINITY, -INFINITY, NAN, M_PI_2, 1e-310, 1e308};
    enum { SPECIAL = GM_COUNT(special) };
    static double points[VARIABLES][POINTS], values[POINTS];
    srand(11);
    for (int trial = 0; trial < FORMULAS; trial++) {
        char *text = NULL;
        size_t size = 0;
        FILE *out = open_memstream(&text, &size);
        assert_non_null(out);
        gm_random_formula(out, variable_names, 1 + trial % DEEPEST);
        fclose(out);
        struct gm_formula graph;
        struct gm_fault fault;
        struct gm_tape tape;
        gm_node_id node;
        gm_formula_open(&graph);
        const struct gm_scope scope = {.find = find, .data = &graph};
        if (!gm_formula_read(&graph, text, 0, size, &scope, &node, &fault)) {
            fail_msg("%s: %s", text, fault.sentence);
        }
        for (int i = 0; i < POINTS; i++) {
            for (int k = 0; k < VARIABLES; k++) {
                points[k][i] = i % 7 == 0 ? special[rand() % SPECIAL] : 4. * rand() / RAND_MAX - 2;
            }
        }
        double *nodes = malloc(graph.count * sizeof *nodes);
        assert_non_null(nodes);
        assert_true(gm_tape_open(&tape, &graph, &node, 1, VARIABLES, special));
        gm_tape_values(&tape, points[0], values, POINTS);
        for (int i = 0; i < POINTS; i++) {
            const double at[VARIABLES] = {points[0][i], points[1][i], points[2][i], points[3][i]};
            struct descent descent = {text, at};
            const double wanted = read_sum(&descent).number;
            double alone;
            assert_true(*descent.at == '\0');
            gm_formula_evaluate(&graph, graph.count, at, nodes);
            gm_tape_values(&tape, at, &alone, 1);
            if (!same(nodes[node], wanted) || !same(alone, wanted) || !same(values[i], wanted)) {
                fail_msg("%s at %.17g %.17g %.17g %.17g is %.17g; graph %.17g, tape %.17g, in a block %.17g",
                         text, at[0], at[1], at[2], at[3], wanted, nodes[node], alone, values[i]);
            }
        }
        free(nodes);
        gm_tape_close(&tape);
        gm_formula_close(&graph);
        free(text);
    }
}

/* -- sums over lists
   --------------------------------------------------------------------------------------- */

enum { BODIES = 40, STATES = 9 };

static enum gm_meaning find_body(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    (void)sentence;
    *node = name->indexed ? gm_formula_variable(data, (size_t)name->index) : 0;
    return name->indexed ? GM_KNOWN : GM_UNKNOWN;
}

/* Of a sum over pairs and its gradient: the graph's bits, by code that is a loop again. */
static void sums_are_loops_with_the_bits_of_the_graph(void **unused)
{
    (void)unused;
    static const char *const sums[] = {
        "sum(i = 0 .. 39, j = i+1 .. 39, 1/sqrt((x[i] - x[j])^2 + 0.01))",
        "sum(i = 0 .. 39, j = 0 .. 39, cos(x[i])*x[j]^3/(i + 1)) - x[3]*x[7]",
        "sum(i = 0 .. 39, x[i]^-2 + x[i]^3 + x[i]^-5 + x[i]^16 + x[i]^7) + sum(i = 0 .. 38, (x[i] - x[i+1])^4)",
        "sum(i = 0 .. 39, j = i+1 .. 39, min(x[i], x[j])*exp(-abs(x[i] - x[mod(7*j, 40)])))",
        /* terms of either sign, and of sums that end one after the other */
        "sum(i = 0 .. 39, j = i+1 .. 39, cos(3*i + 5*j^2)*x[i]*x[j])",
        "sum(i = 0 .. 39, j = 0 .. 39 - i, x[i]*x[j]^3) - sum(i = 1 .. 30, j = i .. 39, x[j]*x[j-i])",
        "prod(i = 0 .. 19, 1 + x[i]/9) + sum(i = 0 .. 39, j = i+1 .. 39, (x[i] - 2)*(x[j] - 2)^2*x[5])",
        /* so short that they are loops for one state alone */
        "sum(i = 0 .. 7, j = i+1 .. 7, 1/((x[i] - x[j])^2 + 0.1)^6 - 1/((x[i] - x[j])^2 + 0.1)^3)",
        "sum(i = 0 .. 8, j = i+1 .. 8, (i + 1)*(j + 2)/sqrt((x[i] - x[j])^2 + (x[i+20] - x[j+20])^2))",
    };
    static double states[BODIES * STATES], block[(BODIES + 1) * STATES], alone[BODIES + 1], state[BODIES];
    bool marked[BODIES];
    memset(marked, true, sizeof marked);
    srand(3);
    for (size_t k = 0; k < GM_COUNT(sums); k++) {
        struct gm_formula graph;
        struct gm_fault fault;
        struct gm_tape tape;
        gm_node_id nodes[BODIES + 1];
        gm_formula_open(&graph);
        const struct gm_scope scope = {.find = find_body, .data = &graph};
        assert_true(gm_formula_read(&graph, sums[k], 0, strlen(sums[k]), &scope, &nodes[BODIES], &fault));
        assert_true(gm_gradient(&graph, nodes[BODIES], marked, BODIES, nodes));
        assert_true(gm_tape_open(&tape, &graph, nodes, BODIES + 1, BODIES, NULL));
        const size_t length = tape.rows ? tape.rows->length : tape.length;
        if (length > graph.count / 2) {
            fail_msg("%s: %zu instructions for %u nodes", sums[k], length, graph.count);
        }
        for (size_t i = 0; i < BODIES * STATES; i++) {
            const size_t member = i % STATES; /* two are all zeros, of either sign */
            states[i] = i == 11       ? 0
                        : i == 17     ? INFINITY
                        : member == 6 ? 0
                        : member == 7 ? -0.0
                                      : 4. * rand() / RAND_MAX - 2;
        }
        gm_tape_values(&tape, states, block, STATES);
        double *values = malloc(graph.count * sizeof *values);
        assert_non_null(values);
        for (size_t member = 0; member < STATES; member++) {
            for (size_t i = 0; i < BODIES; i++) {
                state[i] = states[i * STATES + member];
            }
            gm_formula_evaluate(&graph, graph.count, state, values);
            gm_tape_values(&tape, state, alone, 1);
            for (size_t i = 0; i <= BODIES; i++) {
                if (!same(values[nodes[i]], alone[i]) ||
                    !same(values[nodes[i]], block[i * STATES + member])) {
                    fail_msg("%s, output %zu: %.17g; tape %.17g, in a block %.17g", sums[k], i,
                             values[nodes[i]], alone[i], block[i * STATES + member]);
                }
            }
        }
        free(values);
        gm_tape_close(&tape);
        gm_formula_close(&graph);
    }
}

/* Powers of one number share the products that they are made of: x^2, x^3, x^4, x^5 and x^6 are five in all. */
static void powers_share_products(void **unused)
{
    (void)unused;
    static const char text[] = "x[0]^6 + x[0]^5 + x[0]^3 + x[0]^2";
    struct gm_formula graph;
    struct gm_fault fault;
    struct gm_tape tape;
    gm_node_id node;
    gm_formula_open(&graph);
    const struct gm_scope scope = {.find = find_body, .data = &graph};
    assert_true(gm_formula_read(&graph, text, 0, strlen(text), &scope, &node, &fault));
    assert_true(gm_tape_open(&tape, &graph, &node, 1, 1, NULL));
    int products = 0;
    for (size_t i = 0; i < tape.length; i++) {
        products += tape.code[i].operation == GM_OPERATION_MULTIPLY;
    }
    assert_int_equal(products, 5);
    gm_tape_close(&tape);
    gm_formula_close(&graph);
}

/* The force on either body of a pair has the other one's with the other sign: one quotient, and the same bits. */
static void a_quotient_of_both_signs_is_computed_once(void **unused)
{
    (void)unused;
    static const char text[] = "sum(i = 0 .. 39, j = i+1 .. 39, 3/sqrt((x[i] - x[j])^2 + 0.01))";
    enum { PAIRS = BODIES * (BODIES - 1) / 2 };
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id before[BODIES], after[BODIES], energy;
    double state[BODIES];
    bool marked[BODIES];
    memset(marked, true, sizeof marked);
    gm_formula_open(&graph);
    const struct gm_scope scope = {.find = find_body, .data = &graph};
    assert_true(gm_formula_read(&graph, text, 0, strlen(text), &scope, &energy, &fault));
    assert_true(gm_gradient(&graph, energy, marked, BODIES, before));
    memcpy(after, before, sizeof after);
    assert_true(gm_formula_quicken(&graph, after, BODIES));
    const struct {
        const gm_node_id *nodes;
        size_t quotients;
    } counts[] = {{before, (size_t)2 * PAIRS}, {after, PAIRS}};
    for (size_t k = 0; k < GM_COUNT(counts); k++) {
        size_t size = 0, quotients = 0;
        gm_node_id *parts = gm_formula_parts_of(&graph, counts[k].nodes, BODIES, &size);
        assert_non_null(parts);
        for (size_t i = 0; i < size; i++) {
            quotients += graph.nodes[parts[i]].operation == GM_OPERATION_DIVIDE;
        }
        assert_int_equal(quotients, counts[k].quotients);
        free(parts);
    }
    double *values = malloc(graph.count * sizeof *values);
    assert_non_null(values);
    srand(4);
    for (int round = 0; round < 20; round++) {
        for (size_t i = 0; i < BODIES; i++) {
            state[i] = round == 0 ? 0 : 4. * rand() / RAND_MAX - 2;
        }
        gm_formula_evaluate(&graph, graph.count, state, values);
        for (size_t i = 0; i < BODIES; i++) {
            if (!same(values[before[i]], values[after[i]])) {
                fail_msg("force %zu: %.17g, quickened %.17g", i, values[before[i]], values[after[i]]);
            }
        }
    }
    free(values);
    gm_formula_close(&graph);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bits_are_those_of_the_text),
                                       cmocka_unit_test(powers_share_products),
                                       cmocka_unit_test(a_quotient_of_both_signs_is_computed_once),
                                       cmocka_unit_test(sums_are_loops_with_the_bits_of_the_graph)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
