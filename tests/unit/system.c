/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Systems: the structure of tests/reference/formulas.test, the equations of the eight that the program brings
   against equations written by hand, and what is refused. */
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
#include "core/model/equations.h"
#include "core/model/facts.h"
#include "tests/common/reference.h"

static bool open_text(struct gm_user_system *system, const char *text, struct gm_fault *fault)
{
    return gm_equations_open(system, text, strlen(text), NULL, 0, fault);
}

/* Lines of a system from one line, with a start for each of its variables. */
static char *lines_of(const char *line)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    assert_non_null(out);
    for (const char *at = line; *at; at++) {
        if (*at == ';' && at[1] == ' ') {
            fputc('\n', out);
            at++;
        } else if (*at != ' ' || at[1] != ';') {
            fputc(*at, out);
        }
    }
    static const char *const starts[][2] = {
        {"coordinates: q[1..3]", "q[i] = i, p_q[i] = 1"},
        {"coordinates: q ", "q = 1, p_q = 2"},
        {"coordinates: a b c d", "a = 1, b = 2, c = -1, d = 0, p_a = 3, "
                                 "p_b = 4, p_c = 0, p_d = 1"},
        {"coordinates: x[1..3]", "x[i] = i, y[i] = i^2, p_x[i] = 1, p_y[i] = 0"},
        {"coordinates: a b", "a = 1, b = 2, p_a = 3, p_b = 4"},
        {"rate: z", "x = 1, y = 2, z = 3"},
        {"rate: x", "x = 1, y = 2"}};
    for (size_t i = 0; i < GM_COUNT(starts); i++) {
        if (strstr(line, starts[i][0])) {
            fprintf(out, "\nstart: %s\n", starts[i][1]);
            break;
        }
    }
    fclose(out);
    return text;
}

static void expect_facts(const char *line, char *words, const char *term)
{
    struct gm_user_system system;
    struct gm_fault fault;
    struct gm_finding findings[GM_FACTS];
    char *text = lines_of(line), *rest = NULL;
    if (!open_text(&system, text, &fault)) {
        fail_msg("%s: %s", line, fault.sentence);
    }
    assert_true(gm_facts_find(&system, findings));
    const struct gm_finding *last = NULL;
    for (char *word = strtok_r(words, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        enum gm_fact fact = 0;
        while (fact < GM_FACTS && strcmp(gm_fact_word(fact), word + (word[0] == '-')) != 0) {
            fact++;
        }
        assert_true(fact < GM_FACTS);
        char *reason = gm_fact_reason(&system, fact, &findings[fact]);
        if (!findings[fact].asked || findings[fact].holds != (word[0] != '-')) {
            fail_msg("%s: %s? %s", line, word, reason);
        }
        last = findings[fact].holds ? last : &findings[fact];
        free(reason);
    }
    struct gm_naming naming = gm_system_naming(&system);
    naming.part = NULL;
    char *found = last && term[0] ? gm_formula_text(&system.graph, last->term, &naming) : NULL;
    if (term[0] && (!found || strcmp(found, term) != 0)) {
        fail_msg("%s: %s, not %s", line, found, term);
    }
    free(found);
    gm_system_close(&system);
    free(text);
}

/* The nodes that make a facet, as text. */
static void expect_nodes(const char *line, const char *word, const char *expected)
{
    struct gm_user_system system;
    struct gm_fault fault;
    struct gm_finding findings[GM_FACTS];
    char *text = lines_of(line), *found = NULL;
    size_t size = 0;
    if (!open_text(&system, text, &fault)) {
        fail_msg("%s: %s", line, fault.sentence);
    }
    assert_true(gm_facts_find(&system, findings));
    enum gm_fact fact = 0;
    while (fact < GM_FACTS && strcmp(gm_fact_word(fact), word) != 0) {
        fact++;
    }
    assert_true(fact < GM_FACTS && findings[fact].holds && findings[fact].nodes);
    const size_t count = fact == GM_FACT_FAST_LINEAR ? system.n : fact == GM_FACT_CONFORMAL ? 1 : 3;
    const struct gm_naming naming = gm_system_naming(&system);
    FILE *out = open_memstream(&found, &size);
    assert_non_null(out);
    for (size_t i = 0; i < count; i++) {
        char *node = gm_formula_text(&system.graph, findings[fact].nodes[i], &naming);
        assert_non_null(node);
        fprintf(out, "%s%s", i == 0 ? "" : "; ", node);
        free(node);
    }
    fclose(out);
    if (strcmp(found, expected) != 0) {
        fail_msg("%s: %s is %s, not %s", line, word, found, expected);
    }
    free(found);
    gm_system_close(&system);
    free(text);
}

static void structure_is_recognised(void **unused)
{
    (void)unused;
    char line[1000];
    int count = 0;
    FILE *file = reference_file("formulas.test");
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = '\0';
        const bool is_facts = strncmp(line, "facts | ", 8) == 0;
        if (!is_facts && strncmp(line, "nodes | ", 8) != 0) {
            continue;
        }
        char *words = strstr(line + 8, " | "), *term = NULL;
        assert_non_null(words);
        *words = '\0';
        words += 3;
        term = strstr(words, " |");
        assert_non_null(term);
        *term = '\0';
        term += 2 + strspn(term + 2, " ");
        is_facts ? expect_facts(line + 8, words, term) : expect_nodes(line + 8, words, term);
        count++;
    }
    fclose(file);
    assert_true(count >= 80);
}

/* -- equations by hand; p: the parameters in the order of the file
   ----------------------------------------- */

static void double_pendulum(const double *p, double t, const double *y, double *f)
{
    (void)t;
    const double m = p[0], l = p[1], g = p[2], c = cos(y[0] - y[1]), s = sin(y[0] - y[1]);
    const double D = 1 + m * s * s;
    const double k1 = y[2] * y[3] * s / (l * D);
    const double k2 = (m * l * l * y[2] * y[2] + (1 + m) * y[3] * y[3] - 2 * m * l * y[2] * y[3] * c) *
                      sin(2 * (y[0] - y[1])) / (2 * l * l * D * D);
    f[0] = (l * y[2] - y[3] * c) / (l * D);
    f[1] = ((1 + m) * y[3] - m * l * y[2] * c) / (m * l * l * D);
    f[2] = -(1 + m) * g * sin(y[0]) - k1 + k2;
    f[3] = -m * g * l * sin(y[1]) + k1 - k2;
}

static void figure_eight(const double *p, double t, const double *y, double *f)
{
    (void)p;
    (void)t;
    for (int i = 0; i < 3; i++) {
        f[i] = y[6 + i];
        f[3 + i] = y[9 + i];
        f[6 + i] = f[9 + i] = 0;
        for (int j = 0; j < 3; j++) {
            const double dx = y[j] - y[i], dy = y[3 + j] - y[3 + i], r = hypot(dx, dy);
            f[6 + i] += i == j ? 0 : dx / (r * r * r);
            f[9 + i] += i == j ? 0 : dy / (r * r * r);
        }
    }
}

static void restricted_three_body(const double *p, double t, const double *y, double *f)
{
    (void)t;
    const double mu = p[0], a = y[0] + mu, b = y[0] - 1 + mu;
    const double r1 = pow(hypot(a, y[1]), -3), r2 = pow(hypot(b, y[1]), -3);
    f[0] = y[2] + y[1];
    f[1] = y[3] - y[0];
    f[2] = y[3] - (1 - mu) * a * r1 - mu * b * r2;
    f[3] = -y[2] - (1 - mu) * y[1] * r1 - mu * y[1] * r2;
}

static void toda(const double *p, double t, const double *y, double *f)
{
    (void)t;
    const int n = (int)p[0];
    for (int i = 0; i < n; i++) {
        f[i] = y[n + i];
        f[n + i] = exp(y[(i + n - 1) % n] - y[i]) - exp(y[i] - y[(i + 1) % n]);
    }
}

static void lotka_volterra(const double *p, double t, const double *y, double *f)
{
    (void)t;
    f[0] = y[0] * (p[0] - p[1] * y[1]);
    f[1] = y[1] * (p[3] * y[0] - p[2]);
}

static void rigid_body(const double *p, double t, const double *y, double *f)
{
    (void)t;
    f[0] = (1 / p[2] - 1 / p[1]) * y[1] * y[2];
    f[1] = (1 / p[0] - 1 / p[2]) * y[2] * y[0];
    f[2] = (1 / p[1] - 1 / p[0]) * y[0] * y[1];
}

static void lorenz(const double *p, double t, const double *y, double *f)
{
    (void)t;
    f[0] = p[0] * (y[1] - y[0]);
    f[1] = p[1] * y[0] - y[0] * y[2] - y[1];
    f[2] = y[0] * y[1] - p[2] * y[2];
}

static void driven_pendulum(const double *p, double t, const double *y, double *f)
{
    f[0] = y[1];
    f[1] = -(1 + p[0] * cos(p[1] * t)) * sin(y[0]);
}

static char *system_text(const char *name, size_t *length)
{
    char path[200];
    snprintf(path, sizeof path, "../../share/systems/%s.system", name);
    FILE *file = reference_file(path);
    char *text = malloc(100000);
    assert_non_null(text);
    *length = fread(text, 1, 100000, file);
    fclose(file);
    return text;
}

static void equations_are_those_by_hand(void **unused)
{
    (void)unused;
    static const struct {
        const char *name;
        void (*field)(const double *p, double t, const double *y, double *f);
        size_t n, kept; /* invariants, Casimirs and symmetries */
    } eight[] = {{"double-pendulum", double_pendulum, 4, 0},
                 {"figure-eight", figure_eight, 12, 4},
                 {"restricted-three-body", restricted_three_body, 4, 0},
                 {"toda", toda, 10, 5},
                 {"lotka-volterra", lotka_volterra, 2, 0},
                 {"rigid-body", rigid_body, 3, 1},
                 {"lorenz", lorenz, 3, 0},
                 {"driven-pendulum", driven_pendulum, 2, 0}};
    for (size_t k = 0; k < GM_COUNT(eight); k++) {
        struct gm_user_system system;
        struct gm_fault fault;
        size_t length = 0, kept = 0;
        char *text = system_text(eight[k].name, &length);
        if (!gm_equations_open(&system, text, length, NULL, 0, &fault)) {
            fail_msg("%s: %s", eight[k].name, fault.sentence);
        }
        assert_int_equal(system.n, eight[k].n);
        double *variables = gm_equations_start(&system, NULL);
        double *values = malloc(system.graph.count * sizeof *values);
        assert_true(variables && values);
        srand(3);
        for (int trial = 0; trial < 20; trial++) {
            double field[12], size = 0;
            for (size_t i = 0; i <= system.n && trial > 0; i++) {
                variables[i] = .5 + (double)rand() / RAND_MAX + (double)i / 7; /* t among them */
            }
            gm_formula_evaluate(&system.graph, system.graph.count, variables, values);
            eight[k].field(variables + system.parameters, variables[system.n], variables, field);
            for (size_t i = 0; i < system.n; i++) {
                size = fmax(size, fabs(field[i]));
            }
            for (size_t i = 0; i < system.n; i++) {
                const double derived = values[system.rates[i]];
                if (!(fabs(derived - field[i]) <= 2e-14 * size * (1 + (double)system.n))) {
                    fail_msg("%s: component %zu is %.17g, by hand %.17g", eight[k].name, i, derived,
                             field[i]);
                }
            }
        }
        for (size_t i = 0; i < system.item_count; i++) {
            const struct gm_system_item *item = &system.items[i];
            if (item->word == GM_WORD_INVARIANT || item->word == GM_WORD_CASIMIR ||
                item->word == GM_WORD_SYMMETRY) {
                assert_true(item->check == GM_ZERO_PROVED);
                kept++;
            }
        }
        assert_int_equal(kept, eight[k].kept);
        free(values);
        free(variables);
        free(text);
        gm_system_close(&system);
    }
}

/* A Lagrangian gives the momenta and rates that its Hamiltonian gives. */
static void lagrangians_are_transformed(void **unused)
{
    (void)unused;
    static const char text[] = "coordinates: a b\nparameter: m = 2\n"
                               "L: m*(v_a^2 + a^2*v_b^2)/2 - a^3\nforce: a = -0.5*v_a\n"
                               "symmetry: b = 1\nstart: a = 2, b = 1, v_a = 3, v_b = 0.25\n";
    struct gm_user_system system;
    struct gm_fault fault;
    if (!open_text(&system, text, &fault)) {
        fail_msg("%s", fault.sentence);
    }
    double *variables = gm_equations_start(&system, NULL);
    double *values = malloc(system.graph.count * sizeof *values);
    assert_true(variables && values);
    gm_formula_evaluate(&system.graph, system.graph.count, variables, values);
    assert_true(variables[2] == 6 && variables[3] == 2); /* p_a = m v_a, p_b = m a^2 v_b */
    assert_true(values[system.momenta[0]] == 6 && values[system.momenta[1]] == 2);
    assert_true(fabs(values[system.rates[2]] - (2 * 2 * .25 * .25 - 12 - 1.5)) < 1e-14);
    assert_true(values[system.rates[3]] == 0);
    assert_true(system.items[0].check == GM_ZERO_PROVED && values[system.items[0].nodes[2]] == 2);
    free(values);
    free(variables);
    gm_system_close(&system);
}

/* What a Lagrangian keeps is proved with dL/dv in place of the momenta; velocities are found from momenta. */
static void lagrangians_are_checked(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        size_t checked, proved;
        double velocity; /* of the first coordinate at the start */
    } rows[] = {
        {"coordinates: a b\nL: (v_a^2 + v_b^2)/2 - (a^2 + b^2)^2\ninvariant: l = a*p_b - b*p_a\n"
         "invariant: E = (p_a^2 + p_b^2)/2 + (a^2 + b^2)^2\nsymmetry: a = -b, b = a\n"
         "start: a = 1, b = 2, p_a = 3, p_b = 4\n",
         3, 3, 3},
        /* a mass that depends on the place; of the velocities one is given */
        {"coordinates: r phi\nparameter: m = 2\nL: m*(v_r^2 + r^2*v_phi^2)/2 + 1/r\n"
         "invariant: l = p_phi\ninvariant: E = p_r^2/(2*m) + p_phi^2/(2*m*r^2) - 1/r\n"
         "start: r = 2, phi = 0, p_r = 0.5, v_phi = 0.25\n",
         2, 2, .25},
        /* relativistic: v = p / sqrt(1 + p^2 / 100) */
        {"coordinates: q\nL: -100*sqrt(1 - v_q^2/100)\ninvariant: p = p_q\nstart: q = 1, p_q = 24\n", 1, 1,
         24 / 2.6},
        {"coordinates: q\nL: exp(v_q)\ninvariant: p = p_q\nstart: q = 1, p_q = 5\n", 1, 1,
         1.60943791243410037},
        {"coordinates: a b\nL: v_a^2/2 + v_a*v_b + v_b^2 + b*v_a\ninvariant: p = p_a\n"
         "start: a = 1, b = 2, p_a = 3, p_b = 4\n",
         1, 1, -2}, /* v_a + v_b + 2 = 3, v_a + 2 v_b = 4 */
        /* how velocities change is not known to the graph */
        {"coordinates: q\nL: v_q^2/2\ninvariant: v = v_q\nstart: q = 1, p_q = 5\n", 1, 0, 5},
    };
    for (size_t k = 0; k < GM_COUNT(rows); k++) {
        struct gm_user_system system;
        struct gm_fault fault;
        size_t checked = 0, proved = 0;
        if (!open_text(&system, rows[k].text, &fault)) {
            fail_msg("%s: %s", rows[k].text, fault.sentence);
        }
        for (size_t i = 0; i < system.item_count; i++) {
            const enum gm_system_word word = system.items[i].word;
            checked += word == GM_WORD_INVARIANT || word == GM_WORD_SYMMETRY;
            proved += (word == GM_WORD_INVARIANT || word == GM_WORD_SYMMETRY) &&
                      system.items[i].check == GM_ZERO_PROVED;
        }
        double *start = gm_equations_start(&system, NULL);
        assert_non_null(start);
        if (checked != rows[k].checked || proved != rows[k].proved ||
            !(fabs(start[system.velocities] - rows[k].velocity) <= 4e-16 * fabs(rows[k].velocity))) {
            fail_msg("%s: %zu of %zu proved, velocity %.17g", rows[k].text, proved, checked,
                     start[system.velocities]);
        }
        free(start);
        gm_system_close(&system);
    }
}

/* A line with a counter says what as many lines say. */
static void lines_are_counted(void **unused)
{
    (void)unused;
    static const char *const texts[2] = {
        "parameter: N = 3\ncomponents: x[1..N] y[1..N] z[1..N]\n"
        "bracket: i = 1 .. N; x[i] y[i] = -z[i], y[i] z[i] = -x[i], z[i] x[i] = -y[i]\n"
        "H: sum(i = 1 .. N, i*x[i]^2 + y[i]*y[mod(i, N) + 1])\nlet: far[2] = 2*x[1]\n"
        "casimir: i = 1 .. N; length[i] = x[i]^2 + y[i]^2 + z[i]^2; scale i\n"
        "rod: i = 2 .. N; x[i-1], y[i-1], far[2]; x[i], y[i], z[i]\n"
        "start: x[i] = i, y[i] = 1, z[i] = i^2\n",
        "components: x[1..3] y[1..3] z[1..3]\nbracket: x[1] y[1] = -z[1], y[1] z[1] = -x[1]\n"
        "bracket: z[1] x[1] = -y[1], x[2] y[2] = -z[2], y[2] z[2] = -x[2], z[2] x[2] = -y[2]\n"
        "bracket: x[3] y[3] = -z[3], y[3] z[3] = -x[3], z[3] x[3] = -y[3]\n"
        "H: x[1]^2 + y[1]*y[2] + 2*x[2]^2 + y[2]*y[3] + 3*x[3]^2 + y[3]*y[1]\nlet: far[2] = 2*x[1]\n"
        "casimir: length1 = x[1]^2 + y[1]^2 + z[1]^2; scale 1\n"
        "casimir: length2 = x[2]^2 + y[2]^2 + z[2]^2; scale 2\n"
        "casimir: length3 = x[3]^2 + y[3]^2 + z[3]^2; scale 3\n"
        "rod: x[1], y[1], far[2]; x[2], y[2], z[2]\nrod: x[2], y[2], far[2]; x[3], y[3], z[3]\n"
        "start: x[1] = 1, y[1] = 1, z[1] = 1, x[2] = 2, y[2] = 1, z[2] = 4, x[3] = 3, y[3] = 1, z[3] = 9\n"};
    struct gm_user_system systems[2];
    double *values[2];
    for (int k = 0; k < 2; k++) {
        struct gm_fault fault;
        if (!gm_equations_open(&systems[k], texts[k], strlen(texts[k]), NULL, 0, &fault)) {
            fail_msg("%s at %zu", fault.sentence, fault.offset);
        }
        double *start = gm_equations_start(&systems[k], NULL);
        values[k] = malloc(systems[k].graph.count * sizeof *values[k]);
        assert_true(start && values[k]);
        gm_formula_evaluate(&systems[k].graph, systems[k].graph.count, start, values[k]);
        free(start);
    }
    assert_true(systems[0].n == 9 && systems[1].n == 9 && systems[0].item_count == systems[1].item_count);
    for (size_t i = 0; i < 9; i++) {
        assert_float_equal(values[0][systems[0].rates[i]], values[1][systems[1].rates[i]], 1e-13);
    }
    for (size_t i = 0; i < systems[0].item_count; i++) {
        const struct gm_system_item *one = &systems[0].items[i], *other = &systems[1].items[i];
        assert_string_equal(one->name, other->name);
        assert_true(one->word == other->word && one->count == other->count);
        assert_true(gm_system_option_number(one, GM_OPTION_SCALE, 0) ==
                    gm_system_option_number(other, GM_OPTION_SCALE, 0));
        for (size_t k = 0; k < one->count; k++) {
            assert_true(values[0][one->nodes[k]] == values[1][other->nodes[k]]);
        }
    }
    for (int k = 0; k < 2; k++) {
        free(values[k]);
        gm_system_close(&systems[k]);
    }
}

#define CANONICAL "coordinates: q\nstart: q = 1, p_q = 0\n"
#define THREE "components: x y z\nstart: x = 1, y = 1, z = 1\n"
#define SPACE "rate: x = y\nrate: y = -x\nrate: z = x\nview: x, y, z\n" /* four lines */

static const struct {
    const char *text;
    size_t line, column;
    const char *sentence;
} refused[] = {
    {"", 1, 1, "no equation"},
    {"# nothing\n\n", 1, 1, "no equation"},
    {"H p^2", 1, 2, "a line needs a word and a colon"},
    {"  H: q", 1, 3, "continues another"},
    {"titel: x\n", 1, 1, "no line \"titel\"; did you mean title"},
    {"H:\n", 1, 3, "has no value"},
    {"H: q\nH: q\n", 2, 1, "given twice"},
    {"H: q\nL: q\n", 1, 1, "a system with L has no line \"H\""},
    {"H: q\nrate: q = 1\n", 1, 1, "a system with rates has no line \"H\""},
    {"bracket: x y = 1\n", 1, 1, "needs H"},
    {"H: q^2\n", 1, 1, "needs a line \"coordinates\""},
    {CANONICAL "H: p_q^2 + qq\n", 3, 12, "no name qq; did you mean q"},
    {CANONICAL "H: p_q^2 + 2q\n", 3, 13, "2*q"},
    {CANONICAL "H: q\ndt: -1\n", 4, 5, "dt is -1, and has to be above 0"},
    {CANONICAL "H: q\nuntil: 0 - 3\n", 4, 8, "until is -3, and has to be 0 or more"},
    {CANONICAL "H: q\nparameter: k = 5; 10 .. 1\n", 4, 19, "10 is above 1"},
    {CANONICAL "H: q\nsection: every -1; q, p_q\n", 4, 16, "has to be above 0"},
    {CANONICAL "H: q\nview: q, 0\nview: q, 0, 0\n", 5, 7,
     "3 coordinates, and those of the lines before are 2"},
    {CANONICAL "H: p_q^2 + coz(q)\n", 3, 12, "did you mean cos"},
    {CANONICAL "H: p_q^2\n  + sin(q\n", 4, 10, "ends where ) was expected"},
    {"geomint: 2\n" CANONICAL "H: p_q^2\n", 1, 10, "format 1, not 2"},
    {"coordinates: q q\nH: q\n", 1, 16, "q is defined twice"},
    {"coordinates: sin\nH: q\n", 1, 14, "the name sin is reserved"},
    {"coordinates: dt\nH: q\n", 1, 14, "the name dt is reserved"},
    {"coordinates: q\nparameter: until = 2\nH: q\n", 2, 12, "the name until is reserved"},
    {"coordinates: q\nH: q\nobserve: status = q\nstart: q = 1, p_q = 0\n", 3, 10,
     "the name status is reserved"},
    {"\xef\xbb\xbf"
     "coordinates: dt\nH: q\n",
     1, 14, "the name dt is reserved"},
    {"coordinates: q\nparameter: q = 2\nH: q\n", 1, 14, "q is defined twice"},
    {"coordinates: q\nmomenta: a b\nH: q\n", 2, 1, "2 momenta for 1 coordinate"},
    {"coordinates: q\nH: q^2 + p_q^2\nstart: q = 1\n", 3, 8, "p_q has no value at the start"},
    {"coordinates: q\nH: p_q^2\nstart: q = 1, r = 2\n", 3, 15, "no name r"},
    {"coordinates: q\nH: p_q^2\nstart: q = 1, q = 2\n", 3, 15, "start: q is given twice"},
    {"coordinates: q\nH: p_q^2\nstart: q 1\n", 3, 10, "= was expected"},
    {CANONICAL "let: a = b\nlet: b = a\nH: a\n", 3, 6, "a circle"},
    {CANONICAL "let: a = a + 1\nH: a\n", 3, 6, "a needs itself"},
    {CANONICAL "let: a = 1\nlet: a = 2\nH: a\n", 4, 6, "a is defined twice"},
    {CANONICAL "parameter: a = 3; 0 .. 2\nH: a*q\n", 3, 12, "outside of its range"},
    {CANONICAL "parameter: a = q\nH: a*q\n", 3, 16, "no name q"},
    {CANONICAL "parameter: a = b\nparameter: b = a\nH: a*q\n", 3, 12, "a circle"},
    {CANONICAL "parameter: a = 1/0\nH: a*q\n", 3, 12, "not a finite number"},
    {CANONICAL "parameter: m[1..3] = 1, 2\nH: q\n", 3, 22, "3 values were expected"},
    {"coordinates: q[1..1e9]\nH: 1\n", 1, 16, "at most 100000 elements"},
    {"coordinates: q[3..1]\nH: 1\n", 1, 16, "3 .. 1 runs downwards"},
    {"coordinates: q[1..0]\nH: 1\n", 1, 16, "at least one element"},
    {"coordinates: q[N]\nH: 1\n", 1, 16, "the bounds of a list"},
    {CANONICAL "parameter: a = 1, b[1..2] = 2\nH: q\n", 3, 21, "a list needs a line of its own"},
    {"coordinates: q[1..2]\nH: q[3]\n", 2, 4, "q[3] lies outside of q[1] .. q[2]"},
    {CANONICAL "H: p_q^2/2 + 1/(q - 1)\n", 3, 14, "not finite at the start"},
    {CANONICAL "H: p_q^2/2\nconstraint: q - 2\n", 4, 13, "breaks this constraint"},
    {CANONICAL "H: p_q^2/2\nconstraint: q^2 + p_q\n", 4, 13, "a constraint holds coordinates and parameters"},
    {"coordinates: x y\nH: (p_x^2 + p_y^2)/2\nconstraint: x^2 + y^2 - 1\n"
     "start: x = 1, y = 0, p_x = 0.5, p_y = 1\n",
     3, 13, "its rate of change is 1, not 0"},
    {"coordinates: x y\nL: (v_x^2 + v_y^2)/2\nconstraint: x^2 + y^2 - 1\n"
     "start: x = 1, y = 0, v_x = 0.5, v_y = 1\n",
     3, 13, "its rate of change is 1, not 0"},
    {"coordinates: x y z\nH: (p_x^2 + p_y^2 + p_z^2)/2\nconstraint: x^2 + y^2 - 1\nconstraint: 3*(x^2 + y^2) - 3\n"
     "start: x = 1, y = 0, z = 0, p_x = 0, p_y = 1, p_z = 0\n",
     4, 13, "the derivatives of 2 have the rank 1"},
    {"coordinates: x y\nH: (p_x^2 + p_y^2)/2\nconstraint: x^2 + 2*y^2 - 1\nsymmetry: x = -y, y = x\n"
     "start: x = 1, y = 0, p_x = 0, p_y = 1\n",
     4, 11, "this is not a symmetry: it changes a constraint, at the rate 1 at x = 0.5, y = 1"},
    {CANONICAL "H: p_q^2/2\ninvariant: a = q\n", 4, 12, "a is not an invariant"},
    {CANONICAL "H: p_q^2/2\nview: q = 1 .. 2; q, 0\n", 4, 7, "q is a name of the system"},
    {CANONICAL "H: p_q^2/2\nview: i = 1 .. 1e12; q, i\n", 4, 11,
     "1 .. 1e+12 are too many: there are at most 100000 values of an index"},
    {CANONICAL "H: p_q^2/2\nview: i = 3 .. 1; q, i\n", 4, 11, "3 .. 1 runs downwards"},
    {CANONICAL "H: p_q^2/2 + sum(i = 1 .. 1e12, q)\n", 3, 27, "a bound lies between"},
    {"components: x[1..2] y[1..2]\nbracket: i = 1 .. 2; x[i] y[i+1] = 1\nH: x[1]\n", 2, 27,
     "y[3] lies outside of y[1] .. y[2]"},
    {CANONICAL "H: p_q^2/2\nview: i = 1 .. q; q, i\n", 4, 16, "q is not a parameter"},
    {CANONICAL "H: p_q^2/2\nview: i = 1 .. 2; q, k\n", 4, 22, "there is no name k"},
    {CANONICAL "H: p_q^2/2\nobserve: i = 1 .. 2; twice = q\n", 4, 22, "twice is given twice"},
    {CANONICAL "H: p_q^2/2\nobserve: i = -1 .. 2; near[i] = q\n", 4, 28, "the index of a name is 0 or more"},
    {CANONICAL "H: p_q^2/2\nlet: q1 = q\nobserve: i = 1 .. 2; q[i] = q\n", 5, 22, "q1 is defined twice"},
    {CANONICAL "H: p_q^2/2 + q^2\nsymmetry: q = 1\n", 4, 11,
     "not a symmetry: it changes H, at the rate 1 at q = 0.5"},
    {CANONICAL "H: p_q^2/2\nforce: p_q = 1\n", 4, 8, "a force acts on a coordinate"},
    {CANONICAL "H: p_q^2/2\nangle: p_q\n", 4, 8, "one of the coordinates"},
    {CANONICAL "H: p_q^2/2\nview: q\n", 4, 7, "two or three coordinates"},
    {CANONICAL "H: p_q^2/2\nrod: 0, 0\n", 4, 6, "a rod has two ends"},
    {THREE SPACE "surface: cube; 1\n", 7, 10, "a sphere or an ellipsoid"},
    {THREE SPACE "surface: sphere\n", 7, 16, "a sphere has one radius"},
    {THREE SPACE "surface: sphere; 1, 2\n", 7, 18, "a sphere has one radius"},
    {THREE SPACE "surface: ellipsoid; 1, 2\n", 7, 21, "three half axes"},
    {THREE SPACE "surface: sphere; 0\n", 7, 10, "the size of a surface is 0"},
    {THREE SPACE "surface: ellipsoid; 1, -2, 1\n", 7, 10, "the size of a surface is -2"},
    {THREE SPACE "surface: sphere; 2 + x\n", 7, 10, "a surface does not move"},
    {THREE SPACE "surface: sphere; 1 + t\n", 7, 10, "a surface does not move"},
    {THREE SPACE "parameter: zoom = 1\n", 7, 12, "the name zoom is reserved"},
    {THREE SPACE "observe: azimuth = x\n", 7, 10, "the name azimuth is reserved"},
    {THREE "rate: x = y\nrate: y = z\nrate: z = x\nview: x, y\nsurface: sphere; 1\n", 7, 10,
     "a surface needs bodies in space"},
    {CANONICAL "H: p_q^2/2\nsection: q\n", 4, 10, "a section is where g = h"},
    {CANONICAL "H: p_q^2/2\nsection: q = 0\n", 4, 15, "shows two values"},
    {CANONICAL "H: p_q^2/2\nsection: 1 = 0; q, p_q\n", 4, 10, "it holds no component, and no t"},
    {CANONICAL "H: p_q^2/2\nparameter: a = 1\nsection: a - 1 = 0; q, p_q\n", 5, 10, "it holds no component"},
    {CANONICAL "H: p_q^2/2\nobserve: q[1] = 0\n", 4, 12, "no index"},
    {CANONICAL "H: p_q^2/2\nobserve: q = 0\n", 4, 10, "q is defined twice"},
    {CANONICAL "H: p_q^2/2\nobserve: r = q\nobserve: r = 1\n", 5, 10, "r is defined twice"},
    {CANONICAL "H: p_q^2/2\nobserve: r = 1 - r\n", 4, 10, "r needs itself"},
    {CANONICAL "H: p_q^2/2\nstop: r - 1\nobserve: r = q; 1\n", 5, 17, "observe: has no option \"1\""},
    {CANONICAL "H: p_q^2/2\nobserve: r = q; titel x\n", 4, 17, "no option \"titel\"; did you mean title"},
    {CANONICAL "H: p_q^2/2\nobserve: r = q; angle 2\n", 4, 23, "nothing follows the option angle"},
    {CANONICAL "H: p_q^2/2\nobserve: r = q; log; title\n", 4, 22, "the option title needs a value"},
    {CANONICAL "H: p_q^2/2\nobserve: r = q; log; log\n", 4, 22, "log is given twice"},
    {CANONICAL "H: p_q^2/2\nobserve: r = q; scale 1\n", 4, 17, "no option \"scale\""},
    {CANONICAL "H: p_q^2/2\ninvariant: r = p_q; angle\n", 4, 21, "no option \"angle\""},
    {CANONICAL "H: p_q^2/2\ninvariant: r = p_q; scale q\n", 4, 27, "q is not a parameter"},
    {CANONICAL "H: p_q^2/2\nobserve: r = q; while qq\n", 4, 23, "no name qq"},
    {"field: u\nV: u^2\nstart: u = 0, u_t = 0\nobserve: r = u; while u\n", 4, 17, "no option \"while\""},
    {CANONICAL "H: p_q^2/2\nobserve: r = exact(sin(q))\n", 4, 20, "sin is not a component"},
    {CANONICAL "H: p_q^2/2\nparameter: k = 1\nobserve: r = exact(k)\n", 5, 20, "it has no exact solution"},
    {CANONICAL "H: p_q^2/2\nobserve: r = exact()\n", 4, 20, "a component, as in exact(x), was expected"},
    {CANONICAL "H: p_q^2/2\nobserve: r = exact(q\n", 4, 21, "ends where ) was expected"},
    {CANONICAL "H: p_q^2/2\nlet: r = exact(q)\n", 4, 10, "no function exact"},
    {CANONICAL "H: p_q^2/2 + q(t - 17)\n", 3, 15,
     "q(t - 17) is a delay; delay equations are not solved; a product is written with *: q*("},
    {CANONICAL "H: p_q^2/2 + q( 3 )\n", 3, 15, "q(3): only q(0), the start, is known"},
    {CANONICAL "H: p_q^2/2 + q(q)\n", 3, 15, "q(q): q is not a function; a product is written with *: q*(q)"},
    {CANONICAL "H: p_q^2/2 + q(-t)\n", 3, 15, "q(-t) is a delay"},
    {CANONICAL "H: p_q^2/2 + (q > 1)\n", 3, 17,
     "a comparison is a condition, not a number; if(a > b, 1, 0) is one"},
    {CANONICAL "H: p_q^2/2 + t(0)\n", 3, 14, "t is not a component: it has no value at the start"},
    {CANONICAL "H: p_q^2/2 + k(2)\nparameter: k = 1\n", 3, 15, "k is not a function"},
    {CANONICAL "H: p_q^2/2 + randn(1)*q\n", 3, 14, "the equations are deterministic; noise is not known"},
    {CANONICAL "H: p_q^2/2\nnoise: q = 1\n", 4, 1, "the equations are deterministic; noise is not known"},
    {CANONICAL "H: p_q^2/2\nwiener w\n", 4, 1, "the equations are deterministic; noise is not known"},
    {CANONICAL "H: p_q^2/2\nglobal 1 q {q = 1}\n", 4, 1, "is written event: x = 0; y = ..."},
    {"q' = -q + 1\n", 1, 1, "q' = -q + 1 is written rate: q = -q + 1"},
    {"dq/dt = -q\n", 1, 1, "dq/dt = -q is written rate: q = -q"},
    {"q'' = -q\n", 1, 1, "x' = -x is written rate: x = -x"},
    {"field: u\nrate: u = u_xx + u(0)\n", 2, 18, "u is a field: its start is not a number"},
    {CANONICAL "H: p_q^2/2\nrequire: q\n", 4, 11, "a sentence was expected"},
    {CANONICAL "H: p_q^2/2\nrequire: q; no {qq}\n", 4, 17, "no name qq"},
    {CANONICAL "H: p_q^2/2\nname: a\ntitle: a {q\n", 5, 10, "this brace has no counterpart"},
    {CANONICAL "H: p_q^2/2\ncaption: a q}\n", 4, 13, "this brace has no counterpart"},
    {CANONICAL "H: p_q^2/2\ncaption: a {q:e}\n", 4, 15, "a value is written as {x}"},
    {CANONICAL "H: p_q^2/2\ntitle: a {q}\n", 4, 1, "needs a line \"name\""},
    {CANONICAL "H: p_q^2/2\nlevel: q\n", 4, 9, "a text was expected"},
    {CANONICAL "H: p_q^2/2\nlevel: section; q; grey\n", 4, 8, "there is no line \"section\""},
    {CANONICAL "H: p_q^2/2\nlevel: q; grey; dark\n", 4, 17, "level: has no option \"dark\""},
    {CANONICAL "H: p_q^2/2\ngraph: energy_error; 2 .. 1\n", 4, 22, "lower end comes first"},
    {CANONICAL "H: p_q^2/2\ngraph: energy_error; range 2\n", 4, 28, "a range was expected"},
    {CANONICAL "H: p_q^2/2\nfigure: a; q; text\n", 4, 12, "q is not of the form key=value"},
    {CANONICAL "H: p_q^2/2\nfigure: a; q=1\n", 4, 15, "a statement was expected"},
    {CANONICAL "H: p_q^2/2\nwork: coarsest 1\n", 4, 7, "coarsest 1 is not of the form key=value"},
    {CANONICAL "H: p_q^2/2\nwork: until=1; errors 1, 1/0\n", 4, 26, "not a finite number"},
    {CANONICAL "H: p_q^2/2\nstability: until=1; q 0, 1; p_q 0\n", 4, 29, "no option \"p_q\""},
    {CANONICAL "H: p_q^2/2\nstability: until=1; q 0, 1; unit 1\n", 4, 34, "a unit has a name"},
    {"field: u\nV: u^2\nstart: u = 0, u_t = 0\nstop: 1\n", 4, 1, "has no line \"stop\""},
    {CANONICAL "H: p_q^2/2\ndt: q\n", 4, 5, "q is not a parameter"},
    {"rate: x = -x\nstart: x = 1\nsection: ; x, x\n", 3, 10, "a section is where g = h"},
    {"coordinates: q\nL: v_q*q\nstart: q = 1\n", 2, 4, "singular: 1 coordinate is an odd number"},
    {"coordinates: q\nL: v_q*q\nstart: q = 1, v_q = 0\n", 3, 15, "v_q follows from the coordinates"},
    {"coordinates: a b\nL: (v_a + v_b)^2\nstart: a = 1, b = 0.5, p_a = 1, p_b = 1\n", 2, 4,
     "singular at the start, a = 1, b = 0.5: momenta"},
    {"coordinates: a b\nL: (v_a^2 + sin(a)^2*v_b^2)/2\nstart: a = pi, b = 0, v_a = 0, v_b = 1\n", 2, 4,
     "singular at the start, a = 3.14159, b = 0: momenta"},
    {"coordinates: q\nL: v_q^2/2 - q^2\nstart: q = 1, v_q = 0\ninvariant: a = p_q\n", 4, 12,
     "a is not an invariant"},
    {"coordinates: q\nL: v_q^2/2 - q^2\nstart: q = 1, v_q = 0\nsymmetry: q = 1\n", 4, 11, "it changes L"},
    {THREE "rate: x = y\nrate: y = z\n", 3, 7, "there is no rate of z"},
    {THREE "rate: x = y\nrate: x = z\n", 4, 7, "rate: x is given twice"},
    {THREE "bracket: x y = z\nbracket: y z = x*y\nbracket: z x = y*z\nH: x\n", 5, 10,
     "breaks Jacobi's identity for x, y and z"},
    {THREE "bracket: x y = z\nbracket: y z = x\nbracket: z x = y\nH: x\ncasimir: C = x\n", 7, 10,
     "C is not a Casimir"},
    {THREE "bracket: x x = 1\nH: x\n", 3, 10, "with itself is 0"},
    {THREE "bracket: x y = 1\nbracket: y x = 1\nH: x\n", 4, 10, "given twice"},
    {CANONICAL "H: \xff\n", 3, 4, "0xff is not UTF-8"},
    {"coordinates: q\rH: p_q^2/2\rstart: q = 1, p_q = 0\r", 1, 15, "a carriage return alone ends no line"},
    {"coordinates: q\r\nH: q\r\r\nstart: q = 1, p_q = 0, r = 1\r", 3, 24, "no name r"},
    {CANONICAL "H: p_q^2/2 + 1e308*q^2\n", 3, 4, "the rate of p_q is not finite at the start"},
    {CANONICAL "H: p_q^2/2\nstop: sqrt(-2 - q)\n", 4, 7, "what ends the run is not finite at the start"},
    {CANONICAL "H: p_q^2/2\ninvariant: a = log(-2 - q)*0 + p_q\n", 4, 12, "a is not finite at the start"},
    {"coordinates: q\nH: p_q^2/2\nstart: q = p_q, p_q = q\n", 3, 8, "the start of q needs that of p_q"},
    {"coordinates: q\nH: p_q^2/2\nstart: p_q = 0, q = r\nlet: r = 2*q\n", 3, 17,
     "the start of q needs that of q"},
    {"coordinates: q\nH: p_q^2/2\nstart: q = p_q, p_q = sqrt(-1)\n", 3, 23, "p_q is not finite at the start"},
    {CANONICAL "H: p_q^2 + f(q, 1)\nlet: f(v) = v\n", 3, 12, "f takes 1 argument, not 2"},
    {CANONICAL "H: p_q^2 + f()\nlet: f(v) = v\n", 3, 12, "f takes 1 argument, not 0"},
    {CANONICAL "H: p_q^2 + f\nlet: f(v) = v\n", 3, 12, "f is a function of 1 argument"},
    {CANONICAL "H: p_q^2 + f(q,)\nlet: f(v, w) = v\n", 3, 16, "a value was expected, not \")\""},
    {CANONICAL "H: p_q^2 + f(q, r)\nlet: f(v, w) = v\n", 3, 17, "no name r"},
    {CANONICAL "H: p_q^2\nlet: f(q) = f(q) + 1\n", 4, 13, "f is defined by itself"},
    {CANONICAL "H: p_q^2 + f(q)\nlet: f(v) = g(v)\nlet: g(w) = f(w)\n", 5, 13, "f is defined by itself"},
    {CANONICAL "H: p_q^2\nlet: sin(q) = q\n", 4, 6, "sin is a function of the program"},
    {CANONICAL "H: p_q^2\nlet: f(v, v) = v\n", 4, 11, "v is an argument twice"},
    {CANONICAL "H: p_q^2\nlet: q(v) = v\n", 4, 6, "q is a component (q(0) is its start)"},
    {CANONICAL "H: p_q^2\nlet: f(a, b, c, d, e, g, h, i, j) = a\n", 4, 32, "at most 8 arguments"},
    {CANONICAL "H: p_q^2\nlet: f() = 1\n", 4, 8, "the name of an argument was expected"},
    {CANONICAL "H: p_q^2\nlet: f(v) + 1 = v\n", 4, 9, "= was expected"},
    {CANONICAL "H: p_q^2\nlet: f(v) = v\nlet: f(w) = w\n", 5, 6, "f is defined twice"},
    {CANONICAL "H: p_q^2\nlet: f(v) = v + r\n", 4, 17, "no name r"},
    {CANONICAL "H: p_q^2\nlet: f(v) = sum(v = 1 .. 2, v)\n", 4, 17, "cannot be the index of a loop"},
    {CANONICAL "H: p_q^2 + sum(i = 1 .. 2, f(i))\nlet: f(v) = v*i\n", 4, 15, "no name i"},
};

/* Of a name that is defined twice the first place is told, too; what is wrong in itself has none. */
static void first_places_are_told(void **unused)
{
    static const struct {
        const char *text;
        size_t line, column;
    } twice[] = {
        {"coordinates: q q\nH: q\n", 1, 14},
        {"coordinates: q\nparameter: q = 2\nH: q\n", 2, 12},
        {CANONICAL "let: a = 1\nlet: a = 2\nH: a\n", 3, 6},
        {CANONICAL "H: p_q^2/2\nobserve: q = 0\n", 1, 14},
    };
    struct gm_user_system system;
    struct gm_fault fault;
    (void)unused;
    for (size_t i = 0; i < GM_COUNT(twice); i++) {
        size_t line, column;
        assert_false(open_text(&system, twice[i].text, &fault));
        gm_text_place(twice[i].text, fault.earlier, &line, &column);
        assert_int_equal(line, twice[i].line);
        assert_int_equal(column, twice[i].column);
        gm_system_close(&system);
    }
    assert_false(open_text(&system, CANONICAL "H: qq\n", &fault));
    assert_int_equal(fault.earlier, 0);
    gm_system_close(&system);
}

/* A call makes the rates of its body written out, and arguments are indices where the body has them in one. */
static void calls_are_written_out(void **unused)
{
    static const char *const pairs[][2] = {
        {"rate: x = f(y - x) + f(x), y = -f(f(x*y))/9\nlet: f(v) = a*v*exp(-v^2) + x\nparameter: a = 2\n",
         "rate: x = (a*(y - x)*exp(-(y - x)^2) + x) + (a*x*exp(-x^2) + x),\n"
         "  y = -(a*(a*(x*y)*exp(-(x*y)^2) + x)*exp(-(a*(x*y)*exp(-(x*y)^2) + x)^2) + x)/9\n"
         "parameter: a = 2\n"},
        {"coordinates: x[1..3]\nparameter: N = 3\nlet: d(i, j) = (x[i] - x[j])^2 + c(i)/j\nlet: c(n) = "
         "sum(k = 1 .. n, k)\nH: sum(i = 1 .. N, j = i+1 .. N, 1/d(i, j) + d(1, N))\n",
         "coordinates: x[1..3]\nparameter: N = 3\nH: sum(i = 1 .. N, j = i+1 .. N, 1/((x[i] - x[j])^2 +\n"
         "  sum(k = 1 .. i, k)/j) + ((x[1] - x[N])^2 + sum(k = 1 .. 1, k)/N))\n"},
    };
    (void)unused;
    for (size_t i = 0; i < GM_COUNT(pairs); i++) {
        struct gm_user_system systems[2];
        double values[2][400], variables[40];
        for (size_t v = 0; v < GM_COUNT(variables); v++) {
            variables[v] = 0.3 + 0.17 * (double)v;
        }
        for (size_t k = 0; k < 2; k++) {
            struct gm_fault fault;
            char text[500];
            snprintf(text, sizeof text, "%sstart: %s\n", pairs[i][k],
                     i == 0 ? "x = 1, y = 2" : "x[i] = i, p_x[i] = 0");
            if (!open_text(&systems[k], text, &fault)) {
                fail_msg("%s: %s", text, fault.sentence);
            }
            assert_true(systems[k].graph.count <= GM_COUNT(values[k]));
            gm_formula_evaluate(&systems[k].graph, systems[k].graph.count, variables, values[k]);
        }
        assert_int_equal(systems[0].n, systems[1].n);
        for (size_t c = 0; c < systems[0].n; c++) {
            const double one = values[0][systems[0].rates[c]], other = values[1][systems[1].rates[c]];
            assert_true(isfinite(one) && memcmp(&one, &other, sizeof one) == 0);
        }
        gm_system_close(&systems[0]);
        gm_system_close(&systems[1]);
    }
}

/* Other lines, also those before, may name what is observed, as they name a let. */
static void observed_names_are_known(void **unused)
{
    static const char text[] = CANONICAL "H: p_q^2/2 + far\nstop: far - 2\nobserve: far = sqrt(near)\n"
                                         "observe: near = q^2 + 1\n";
    struct gm_user_system system;
    struct gm_fault fault;
    size_t found = 0;
    (void)unused;
    assert_true(open_text(&system, text, &fault));
    const struct gm_naming naming = gm_system_naming(&system);
    for (size_t i = 0; i < system.item_count; i++) {
        const struct gm_system_item *item = &system.items[i];
        char *formula = gm_formula_text(&system.graph, item->nodes[0], &naming);
        assert_non_null(formula);
        assert_string_equal(formula, item->word == GM_WORD_STOP       ? "sqrt(q^2 + 1) - 2"
                                     : strcmp(item->name, "far") == 0 ? "sqrt(q^2 + 1)"
                                                                      : "q^2 + 1");
        free(formula);
        found++;
    }
    assert_int_equal(found, 3);
    gm_system_close(&system);
}

static void what_is_wrong_is_named(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < GM_COUNT(refused); i++) {
        struct gm_user_system system;
        struct gm_fault fault;
        size_t line, column;
        if (open_text(&system, refused[i].text, &fault)) {
            fail_msg("%s was read", refused[i].text);
        }
        gm_text_place(refused[i].text, fault.offset, &line, &column);
        if (line != refused[i].line || column != refused[i].column ||
            !strstr(fault.sentence, refused[i].sentence)) {
            fail_msg("%s: %zu:%zu: %s", refused[i].text, line, column, fault.sentence);
        }
        gm_system_close(&system);
    }
    struct gm_user_system system;
    struct gm_fault fault;
    assert_false(gm_equations_open(&system, "H: \0", 4, NULL, 0, &fault));
    assert_true(fault.offset == 3 && strstr(fault.sentence, "not text"));
    gm_system_close(&system);
    assert_false(gm_equations_open(&system, "", (size_t)GM_LARGEST_SYSTEM + 1, NULL, 0, &fault));
    assert_non_null(strstr(fault.sentence, "100 MB"));
    gm_system_close(&system);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(structure_is_recognised),     cmocka_unit_test(equations_are_those_by_hand),
        cmocka_unit_test(lagrangians_are_transformed), cmocka_unit_test(lagrangians_are_checked),
        cmocka_unit_test(lines_are_counted),           cmocka_unit_test(first_places_are_told),
        cmocka_unit_test(calls_are_written_out),       cmocka_unit_test(observed_names_are_known),
        cmocka_unit_test(what_is_wrong_is_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
