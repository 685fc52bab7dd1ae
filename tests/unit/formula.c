/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas: tests/reference/formulas.test line by line; random graphs, differentiated in two ways, against
   differences of fourth order in extended precision; what hostile text does. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/expression/derivative.h"
#include "core/expression/identity.h"
#include "core/expression/reader.h"
#include "core/expression/writer.h"
#include "core/tape.h"
#include "tests/common/random_formula.h"
#include "tests/common/reference.h"

static const char *const names[] = {"x",     "y",    "z",    "w",    "omega", "p_theta", "x1",
                                    "len_2", "q[1]", "q[2]", "q[3]", "q[4]",  "q[5]"};
static const double numbers[] = {.7, -1.3, 2.5, .125, .9, .4, 3, 8, .3, -1.2, 2.5, .7, 1.1};
enum { NAMES = GM_COUNT(names), FIRST_OF_LIST = 8, LIST = 5 };

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    struct gm_formula *graph = data;
    if (name->length == 1 && name->text[0] == 'N' && !name->indexed) {
        *node = gm_formula_constant(graph, LIST);
        return GM_KNOWN;
    }
    if (name->length == 1 && name->text[0] == 'q') {
        if (name->indexed && name->index >= 1 && name->index <= LIST) {
            *node = gm_formula_variable(graph, (size_t)(FIRST_OF_LIST - 1 + name->index));
            return GM_KNOWN;
        }
        if (name->indexed) {
            snprintf(sentence, GM_FAULT_SENTENCE, "q[%ld] lies outside of q[1] .. q[5]", name->index);
        } else {
            snprintf(sentence, GM_FAULT_SENTENCE, "q is a list: an index was expected, q[1] .. q[5]");
        }
        return GM_REFUSED;
    }
    for (size_t i = 0; i < FIRST_OF_LIST; i++) {
        if (strlen(names[i]) == name->length && memcmp(names[i], name->text, name->length) == 0) {
            *node = gm_formula_variable(graph, i);
            if (name->fixed || name->indexed) {
                snprintf(sentence, GM_FAULT_SENTENCE, "%s is not a %s", names[i],
                         name->fixed ? "parameter" : "list");
                return GM_REFUSED;
            }
            return GM_KNOWN;
        }
    }
    return GM_UNKNOWN;
}

static const char *known(size_t i, const void *data)
{
    (void)data;
    return i < FIRST_OF_LIST ? names[i] : NULL;
}

static const char *variable(size_t number, const void *data)
{
    (void)data;
    return names[number];
}

static const struct gm_naming naming = {.variable = variable};

static bool read_formula(struct gm_formula *graph, const char *text, gm_node_id *node, struct gm_fault *fault)
{
    const struct gm_scope scope = {.find = find, .known = known, .data = graph};
    return gm_formula_read(graph, text, 0, strlen(text), &scope, node, fault);
}

static double value_of(const struct gm_formula *graph, gm_node_id node, const double *variables)
{
    double *values = malloc((node + (size_t)1) * sizeof *values);
    assert_non_null(values);
    gm_formula_evaluate(graph, node + 1, variables, values);
    const double value = values[node];
    free(values);
    return value;
}

static void a_value(const char *formula, const char *expected, const char *unused)
{
    (void)unused;
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id node, again;
    gm_formula_open(&graph);
    if (!read_formula(&graph, formula, &node, &fault)) {
        fail_msg("%s: %s", formula, fault.sentence);
    }
    const double value = value_of(&graph, node, numbers), wanted = strtod(expected, NULL);
    if (!(fabs(value - wanted) <= 4e-16 * fabs(wanted) + 1e-16)) {
        fail_msg("%s is %.17g, not %s", formula, value, expected);
    }
    /* what is written reads the same */
    char *text = gm_formula_text(&graph, node, &naming);
    assert_non_null(text);
    assert_true(read_formula(&graph, text, &again, &fault));
    const double twice = value_of(&graph, again, numbers);
    if (memcmp(&twice, &value, sizeof value) != 0) {
        fail_msg("%s is written as %s", formula, text);
    }
    free(text);
    gm_formula_close(&graph);
}

static void an_error(const char *formula, const char *column, const char *part)
{
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id node;
    size_t line, at;
    gm_formula_open(&graph);
    if (read_formula(&graph, formula, &node, &fault)) {
        fail_msg("\"%s\" was read", formula);
    }
    gm_text_place(formula, fault.offset, &line, &at);
    if (line != 1 || at != strtoul(column, NULL, 10) || !strstr(fault.sentence, part)) {
        fail_msg("\"%s\", column %zu: %s", formula, at, fault.sentence);
    }
    gm_formula_close(&graph);
}

static void expect_text(const char *formula, char *text, const char *expected)
{
    assert_non_null(text);
    if (strcmp(text, expected) != 0) {
        fail_msg("%s is written as %s, not as %s", formula, text, expected);
    }
    free(text);
}

static void a_text(const char *formula, const char *plain, const char *latex)
{
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id node;
    gm_formula_open(&graph);
    assert_true(read_formula(&graph, formula, &node, &fault));
    expect_text(formula, gm_formula_text(&graph, node, &naming), plain);
    expect_text(formula, gm_formula_latex(&graph, node, &naming), latex);
    gm_formula_close(&graph);
}

static void a_slope(const char *formula, const char *expected, const char *unused)
{
    (void)unused;
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id node, gradient[NAMES];
    const bool marked[NAMES] = {true};
    gm_formula_open(&graph);
    assert_true(read_formula(&graph, formula, &node, &fault));
    assert_true(gm_gradient(&graph, node, marked, NAMES, gradient));
    expect_text(formula, gm_formula_text(&graph, gradient[0], &naming), expected);
    gm_formula_close(&graph);
}

/* Derivatives over y = -1.3, where the value that is not chosen has none. */
static void chosen_values_alone_are_finite(void **unused)
{
    static const double x = .7, y = -1.3;
    const struct {
        const char *formula;
        double slope;
    } rows[] = {
        {"x*if(y > 0, log(y)*sqrt(y), y^2)", 2 * x * y},
        {"if(y > 0, log(y), if(y < -2, sqrt(-2 - y), y^3))", 3 * y * y},
        {"sin(if(y > 0, sqrt(y), y) + if(x < 0, log(y), 2*y))", 3 * cos(3 * y)},
        {"sqrt(y^2)*if(y > 0, log(y), 1) + if(not (y > 0 or y < -5), exp(y), sqrt(y))", -1 + exp(y)},
        {"if(x > 0 and y <= 0, y, log(y))/if(y < 0, x, sqrt(y))", 1 / x},
    };
    (void)unused;
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_formula graph;
        struct gm_fault fault;
        gm_node_id node, gradient[NAMES], along[NAMES];
        const bool marked[NAMES] = {false, true};
        gm_formula_open(&graph);
        assert_true(read_formula(&graph, rows[i].formula, &node, &fault));
        assert_true(gm_gradient(&graph, node, marked, NAMES, gradient));
        for (size_t k = 0; k < NAMES; k++) {
            along[k] = gm_formula_constant(&graph, k == 1);
        }
        const double by_gradient = value_of(&graph, gradient[1], numbers),
                     by_vector = value_of(&graph, gm_derivative_along(&graph, node, along, NAMES), numbers);
        if (!(fabs(by_gradient - rows[i].slope) < 1e-14) || !(fabs(by_vector - rows[i].slope) < 1e-14)) {
            fail_msg("%s: %.17g and %.17g, not %.17g", rows[i].formula, by_gradient, by_vector,
                     rows[i].slope);
        }
        gm_formula_close(&graph);
    }
}

/* The value for these numbers, on the scale of the largest part, is that of the formula as it was derived. */
static void same_value(const char *formula, const struct gm_formula *graph, gm_node_id derived,
                       gm_node_id tidied)
{
    double values[2], scale = 1;
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(graph, derived, &count);
    assert_non_null(parts);
    for (size_t i = 0; i < count; i++) {
        const double part = fabs(value_of(graph, parts[i], numbers));
        scale = isfinite(part) ? fmax(scale, part) : scale;
    }
    free(parts);
    values[0] = value_of(graph, derived, numbers);
    values[1] = value_of(graph, tidied, numbers);
    /* where parts are huge, sines of them are any number */
    if (isfinite(values[0]) && scale < 1e4 && !(fabs(values[0] - values[1]) <= 1e-10 * scale)) {
        char *before = gm_formula_text(graph, derived, &naming),
             *after = gm_formula_text(graph, tidied, &naming);
        fail_msg("%s: %s = %.17g is tidied as %s = %.17g", formula, before, values[0], after, values[1]);
    }
}

/* The derivative over x as it is printed. */
static void a_tidy(const char *formula, const char *plain, const char *latex)
{
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id node, gradient[NAMES];
    const bool marked[NAMES] = {true};
    gm_formula_open(&graph);
    assert_true(read_formula(&graph, formula, &node, &fault));
    assert_true(gm_gradient(&graph, node, marked, NAMES, gradient));
    const gm_node_id tidied = gm_formula_tidied(&graph, gradient[0], &naming);
    expect_text(formula, gm_formula_text(&graph, tidied, &naming), plain);
    expect_text(formula, gm_formula_latex(&graph, tidied, &naming), latex);
    same_value(formula, &graph, gradient[0], tidied);
    gm_formula_close(&graph);
}

static const struct {
    const char *word;
    void (*test)(const char *first, const char *second, const char *third);
    int count;
} kinds[] = {{"value", a_value, 100},
             {"error", an_error, 50},
             {"text", a_text, 20},
             {"slope", a_slope, 15},
             {"tidy", a_tidy, 12}};

static void lines_hold(void **unused)
{
    (void)unused;
    int counts[GM_COUNT(kinds)] = {0};
    char line[1000];
    FILE *file = reference_file("formulas.test");
    while (fgets(line, sizeof line, file)) {
        char *parts[4] = {line, "", "", ""};
        line[strcspn(line, "\n")] = '\0';
        for (int i = 1; i < 4; i++) {
            char *bar = strstr(parts[i - 1], " | ");
            if (!bar) {
                break;
            }
            *bar = '\0';
            parts[i] = bar + 3;
        }
        for (size_t k = 0; k < GM_COUNT(kinds); k++) {
            if (strcmp(parts[0], kinds[k].word) == 0) {
                kinds[k].test(parts[1], parts[2], parts[3]);
                counts[k]++;
            }
        }
    }
    fclose(file);
    for (size_t k = 0; k < GM_COUNT(kinds); k++) {
        assert_true(counts[k] >= kinds[k].count);
    }
}

/* A random formula as text, and its values by an evaluator of its own, in 64 bits of precision. */
enum { POINTS = 5 };

struct random {
    FILE *out;
    const long double (*points)[3]; /* x, y, z where it is evaluated */
};

/* Writes a random formula, and its values at the points. */
static void write_random(struct random *random, int depth, long double *values)
{
    long double a[POINTS], b[POINTS];
    const int leaf = rand() % 4, operation = depth == 0 ? 0 : 1 + rand() % 10;
    static const char *const heads[] = {"",     "(",    "(",        "(",         "(",
                                        "sin(", "cos(", "exp(sin(", "log(2 + (", "sqrt(1 + ("};
    static const char *const tails[] = {"", ")", ")", ")", "^2)", ")", ")", "))", ")^2)", ")^2)"};
    static const char *const signs[] = {"", " + ", " - ", "*"};
    if (operation == 0 || operation == 10) {
        const int constant = 1 + rand() % 9;
        if (leaf < 3) {
            fprintf(random->out, "%c", "xyz"[leaf]);
        } else {
            fprintf(random->out, "(%d/8)", constant);
        }
        for (int i = 0; i < POINTS; i++) {
            values[i] = leaf < 3 ? random->points[i][leaf] : (long double)constant / 8;
        }
        return;
    }
    fputs(heads[operation], random->out);
    write_random(random, depth - 1, a);
    if (operation < 4) {
        fputs(signs[operation], random->out);
        write_random(random, depth - 1, b);
    }
    fputs(tails[operation], random->out);
    for (int i = 0; i < POINTS; i++) {
        const long double x = a[i], y = operation < 4 ? b[i] : 0;
        switch (operation) {
        case 1:
            values[i] = x + y;
            break;
        case 2:
            values[i] = x - y;
            break;
        case 3:
            values[i] = x * y;
            break;
        case 4:
            values[i] = x * x;
            break;
        case 5:
        case 6:
            values[i] = operation == 5 ? sinl(x) : cosl(x);
            break;
        case 7:
            values[i] = expl(sinl(x));
            break;
        case 8:
            values[i] = logl(2 + x * x);
            break;
        default:
            values[i] = sqrtl(1 + x * x);
        }
    }
}

static void derivatives_are_exact(void **unused)
{
    (void)unused;
    srand(1);
    int tried = 0;
    for (int trial = 0; trial < 2000 && tried < 200; trial++) {
        const double at[3] = {.3 + rand() % 100 * .007, -.4 + rand() % 100 * .005, .6};
        const double along[3] = {1, -.5, .25}, h = 2e-5;
        long double points[POINTS][3], values[POINTS];
        for (int i = 0; i < POINTS; i++) {
            for (int k = 0; k < 3; k++) {
                points[i][k] = (long double)at[k] + (i - 2) * (long double)h * along[k];
            }
        }
        char *text = NULL;
        size_t size = 0;
        struct random random = {.out = open_memstream(&text, &size),
                                .points = (const long double(*)[3])points};
        assert_non_null(random.out);
        write_random(&random, 5, values);
        fclose(random.out);
        const double value = (double)values[2];
        const double slope =
            (double)((8 * (values[3] - values[1]) - (values[4] - values[0])) / (12 * (long double)h));
        if (size < 20 || !(fabs(value) < 100) || !(fabs(slope) < 30) || !(fabs(slope) > 1e-3)) {
            free(text);
            continue;
        }
        tried++;
        struct gm_formula graph;
        struct gm_fault fault;
        gm_node_id node, gradient[NAMES], direction[3];
        gm_formula_open(&graph);
        if (!read_formula(&graph, text, &node, &fault)) {
            fail_msg("%s: %s", text, fault.sentence);
        }
        for (int k = 0; k < 3; k++) {
            direction[k] = gm_formula_constant(&graph, along[k]);
        }
        const gm_node_id by_direction = gm_derivative_along(&graph, node, direction, 3);
        assert_true(by_direction != GM_NO_NODE);
        const bool marked[NAMES] = {true, true, true};
        assert_true(gm_gradient(&graph, node, marked, NAMES, gradient));
        double by_gradient = 0;
        for (int k = 0; k < 3; k++) {
            by_gradient += along[k] * value_of(&graph, gradient[k], at);
        }
        const double here = value_of(&graph, node, at), by_slope = value_of(&graph, by_direction, at);
        if (!(fabs(here - value) <= 1e-12 * (1 + fabs(value))) ||
            !(fabs(by_slope - slope) <= 1e-12 * (1 + fabs(slope))) ||
            !(fabs(by_gradient - slope) <= 1e-12 * (1 + fabs(slope)))) {
            fail_msg("%s: %.17g %.17g; slope %.17g: %.17g along, %.17g by the gradient", text, value, here,
                     slope, by_slope, by_gradient);
        }
        free(text);
        gm_formula_close(&graph);
    }
    assert_int_equal(tried, 200);
}

static void jacobians_are_sparse(void **unused)
{
    (void)unused;
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id node, gradient[NAMES];
    bool marked[NAMES];
    memset(marked, true, sizeof marked);
    gm_formula_open(&graph);
    assert_true(read_formula(&graph, "sum(i = 1 .. N-1, (q[i] - q[i+1])^4) + x^2/2", &node, &fault));
    assert_true(gm_gradient(&graph, node, marked, NAMES, gradient));
    struct gm_arena *arena = gm_arena_open();
    const struct gm_sparse hessian = gm_sparse_jacobian(arena, &graph, gradient, NAMES, marked, NAMES);
    assert_int_equal(hessian.count, 1 + LIST + 2 * (LIST - 1)); /* x, and a band of three */
    for (size_t i = 0; i < hessian.count; i++) {
        const struct gm_sparse_entry *entry = &hessian.entries[i];
        assert_true(entry->row == entry->column ||
                    (entry->row >= FIRST_OF_LIST && entry->column >= FIRST_OF_LIST));
        for (size_t k = 0; k < hessian.count; k++) { /* symmetric, to rounding */
            if (hessian.entries[k].row == entry->column && hessian.entries[k].column == entry->row) {
                const double a = value_of(&graph, entry->node, numbers);
                const double b = value_of(&graph, hessian.entries[k].node, numbers);
                assert_true(fabs(a - b) <= 1e-14 * fabs(a));
            }
        }
    }
    gm_arena_close(arena);
    gm_formula_close(&graph);
}

static void constants_are_folded_by_the_functions(void **unused)
{
    (void)unused;
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id node, other;
    gm_formula_open(&graph);
    srand(2);
    for (int i = 0; i < 2000; i++) {
        char text[100];
        volatile double x = (double)rand() / RAND_MAX * 4;
        snprintf(text, sizeof text, "sinh(%.17g)", x);
        assert_true(read_formula(&graph, text, &node, &fault));
        assert_true(graph.nodes[node].operation == GM_CONSTANT && graph.nodes[node].value == gm_sinh(x));
        snprintf(text, sizeof text, "%.17g^3", x);
        assert_true(read_formula(&graph, text, &node, &fault));
        assert_true(graph.nodes[node].value == x * x * x);
        snprintf(text, sizeof text, "%.17g^7", x);
        assert_true(read_formula(&graph, text, &node, &fault));
        assert_true(graph.nodes[node].value == (x * x * x) * (x * x * x) * x);
    }
    /* every node once, also the other way round; nothing is simplified as it is read */
    assert_true(read_formula(&graph, "x*y + z", &node, &fault));
    assert_true(read_formula(&graph, "z + y*x", &other, &fault));
    assert_int_equal(node, other);
    assert_true(read_formula(&graph, "0*x + 0", &node, &fault));
    assert_true(isnan(value_of(&graph, node, (const double[NAMES]){INFINITY})));
    gm_formula_close(&graph);
}

/* begin, middle `count` times, end */
static char *repeated(const char *begin, const char *middle, size_t count, const char *end)
{
    const size_t length = strlen(middle);
    char *text = malloc(strlen(begin) + length * count + strlen(end) + 1);
    assert_non_null(text);
    char *at = text + sprintf(text, "%s", begin);
    for (size_t i = 0; i < count; i++) {
        memcpy(at + i * length, middle, length);
    }
    strcpy(at + length * count, end);
    return text;
}

static void hostile_text_is_refused(void **unused)
{
    (void)unused;
    static const struct {
        const char *begin, *middle, *end;
        size_t count;
    } deep[] = {{"", "(", "x", 1000000},    {"", "-", "x", 1000000},  {"", "2^", "x", 1000000},
                {"", "sin(", "x", 1000000}, {"", "q[", "1", 1000000}, {"", "sum(i=1..2,", "i", 100000}};
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id node;
    for (size_t i = 0; i < GM_COUNT(deep); i++) {
        gm_formula_open(&graph);
        char *text = repeated(deep[i].begin, deep[i].middle, deep[i].count, deep[i].end);
        assert_false(read_formula(&graph, text, &node, &fault));
        assert_true(strstr(fault.sentence, "nested") || strstr(fault.sentence, "has a meaning already"));
        free(text);
        gm_formula_close(&graph);
    }
    gm_formula_open(&graph);
    const struct gm_scope scope = {.find = find, .known = known, .data = &graph};
    assert_false(gm_formula_read(&graph, "x + \0y", 0, 6, &scope, &node, &fault));
    assert_true(fault.offset == 4 && strstr(fault.sentence, "0x00"));
    assert_false(gm_formula_read(&graph, "x + \xff", 0, 5, &scope, &node, &fault));
    assert_true(fault.offset == 4 && strstr(fault.sentence, "0xff"));
    gm_formula_close(&graph);
    static const char good[] = "a\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80";
    assert_int_equal(gm_text_valid(good, sizeof good - 1), sizeof good - 1);
    assert_int_equal(gm_text_valid(good, sizeof good - 2), 6);
    assert_int_equal(gm_text_valid("ab\xed\xa0\x80", 5), 2);
    assert_int_equal(gm_text_valid("ab\0c", 4), 2);
}

static void large_formulas_are_differentiated(void **unused)
{
    (void)unused;
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id node, gradient[NAMES];
    bool marked[NAMES];
    memset(marked, true, sizeof marked);
    gm_formula_open(&graph);
    /* terms that differ: sin(i x) y + i z^2 */
    const clock_t start = clock();
    assert_true(read_formula(&graph, "sum(i = 1 .. 17000, sin(i*x)*y + i*z^2)", &node, &fault));
    assert_true(graph.count > 100000);
    assert_true(gm_gradient(&graph, node, marked, NAMES, gradient));
    print_message("%u nodes with the gradient: %.3f s\n", (unsigned)graph.count,
                  (double)(clock() - start) / CLOCKS_PER_SEC);
    const double of_z = value_of(&graph, gradient[2], numbers);
    assert_true(fabs(of_z / (2 * 2.5 * 17000. * 17001 / 2) - 1) < 1e-12);
    gm_formula_close(&graph);
}

static void identities_are_found(void **unused)
{
    (void)unused;
    static const struct {
        const char *formula;
        enum gm_identity identity;
    } cases[] = {
        {"(x + y)^2 - (x^2 + 2*x*y + y^2)", GM_ZERO_PROVED},
        {"sin(x*y)^2 + cos(y*x)^2 - 1", GM_ZERO_PROVED},
        {"cosh(x)^2 - sinh(x)^2 - 1", GM_ZERO_PROVED},
        {"exp(x)*exp(-x) - 1", GM_ZERO_PROVED},
        {"sqrt(x^2 + y^2)^2 - x^2 - y^2", GM_ZERO_PROVED},
        {"sqrt(x)*sqrt(y) - sqrt(x*y)", GM_ZERO_PROVED},
        {"sin(-x) + sin(x)", GM_ZERO_PROVED},
        {"x/y - x*(1/y)", GM_ZERO_PROVED},
        {"exp(x + y) - exp(x)*exp(y)", GM_ZERO_TESTED},
        {"1/(exp(200*x)*exp(y)) - 1/exp(200*x + y)", GM_ZERO_TESTED}, /* at some points exp overflows */
        {"sin(2*x) - 2*sin(x)*cos(x)", GM_ZERO_TESTED},
        {"min(x, y) + max(x, y) - x - y", GM_ZERO_PROVED},
        {"x*(0.1*0.2*3) - 0.06*x", GM_ZERO_PROVED},
        {"1.23456789*3*x - 3*(1.23456789*x)", GM_ZERO_PROVED},
        {"x*sqrt(x) - x^1.5", GM_ZERO_PROVED},
        {"x^(-1/2)*x^20 - sqrt(x)^39", GM_ZERO_PROVED},
        {"2^30*y*2^31 - y", GM_NOT_ZERO},
        {"(x + y)^2 - (x^2 + 2*x*y + y^2) + 1e-17*x", GM_NOT_ZERO},
        {"0.3*x - 0.3000000000001*x", GM_NOT_ZERO},
        {"sqrt(x)*(x + y) - sqrt(x)*x - sqrt(x)*y + 1e-17/x", GM_NOT_ZERO},
        {"sqrt((1 + x^2)^2) - 1 - x^2", GM_ZERO_TESTED},
        {"exp(x + y) - exp(x)*exp(y)*(1 + 1e-13)", GM_NOT_ZERO},
        {"x + y", GM_NOT_ZERO},
        {"x^2 + 1e-9*y", GM_NOT_ZERO},
        {"sin(x)^2 + cos(y)^2 - 1", GM_NOT_ZERO},
        {"exp(x)*exp(y) - 1", GM_NOT_ZERO},
        {"x - sqrt(x^2)", GM_NOT_ZERO},
        {"log(x) - 1e-8*x", GM_NOT_ZERO},
        {"0/0*x", GM_UNTESTED},
    };
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        struct gm_formula graph;
        struct gm_fault fault;
        gm_node_id node;
        gm_formula_open(&graph);
        assert_true(read_formula(&graph, cases[i].formula, &node, &fault));
        const enum gm_identity found = gm_identity_of(&graph, node, NULL, 0);
        if (found != cases[i].identity) {
            fail_msg("%s: %d, not %d", cases[i].formula, (int)found, (int)cases[i].identity);
        }
        gm_formula_close(&graph);
    }
}

static void tidied_formulas_have_their_values(void **unused)
{
    (void)unused;
    const bool marked[NAMES] = {true, true};
    srand(16);
    for (int i = 0; i < 2000; i++) {
        struct gm_formula graph;
        struct gm_fault fault;
        gm_node_id node, gradient[NAMES];
        char *text = NULL;
        size_t size = 0;
        FILE *out = open_memstream(&text, &size);
        gm_random_formula(out, "xyzw", 5);
        fclose(out);
        gm_formula_open(&graph);
        if (read_formula(&graph, text, &node, &fault) && gm_gradient(&graph, node, marked, NAMES, gradient)) {
            for (size_t k = 0; k < 2; k++) {
                same_value(text, &graph, gradient[k], gm_formula_tidied(&graph, gradient[k], &naming));
            }
        }
        gm_formula_close(&graph);
        free(text);
    }
    /* a product that is too long stays, and takes no time */
    struct gm_formula graph;
    struct gm_fault fault;
    gm_node_id node;
    gm_formula_open(&graph);
    assert_true(read_formula(&graph, "prod(i = 1 .. 20000, sin(i*x))", &node, &fault));
    assert_true(gm_formula_tidied(&graph, node, &naming) != GM_NO_NODE);
    gm_formula_close(&graph);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_hold),
        cmocka_unit_test(chosen_values_alone_are_finite),
        cmocka_unit_test(tidied_formulas_have_their_values),
        cmocka_unit_test(derivatives_are_exact),
        cmocka_unit_test(jacobians_are_sparse),
        cmocka_unit_test(constants_are_folded_by_the_functions),
        cmocka_unit_test(hostile_text_is_refused),
        cmocka_unit_test(large_formulas_are_differentiated),
        cmocka_unit_test(identities_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
