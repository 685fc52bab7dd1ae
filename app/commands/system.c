/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The report on a user-defined system: its derived equations, its structure with reasons, and the schemes
   that fit it. */
#include "app/commands/commands.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/output/say.h"
#include "app/words/names.h"
#include "app/words/system.h"
#include "app/words/typed_file.h"
#include "app/words/words.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/expression/derivative.h"
#include "core/expression/number.h"
#include "core/field/user/form.h"
#include "core/field/user/potential.h"
#include "core/memory.h"
#include "core/mesh/user/potential.h"
#include "core/model/equations.h"
#include "core/model/facts.h"
#include "core/model/invariants.h"
#include "core/model/recognition.h"
#include "core/ode/families/splitting/parts.h"
#include "core/ode/indicators/stiffness.h"
#include "core/ode/user/evolution.h"
#include "core/ode/user/forms.h"
#include "core/ode/user/problem.h"
#include "core/schemes.h"
#include "render/message.h"

static const struct {
    const char *word, *title, *energy;
} kinds[] = {
    {"canonical", "A canonical system", "H"},
    {"lagrangian", "A Lagrangian system", "L"},
    {"ode", "An ordinary differential equation", ""},
    {"poisson", "A Poisson system", "H"},
    {"field", "A wave equation", "V"},
    {"evolution", "An evolution equation on a line", ""},
    {"multisymplectic", "A multisymplectic equation on a line", "S"},
    {"forms", "Differential forms on triangles", ""},
    {"room", "A room", ""},
    /* behind the kinds: nodes alone; the Poisson system of a Lagrangian that is linear in the velocities */
    {"nodes", "Nodes alone, each", ""},
    {"degenerate", "A degenerate Lagrangian system", "H"},
};

static size_t kind_of(const struct gm_user_system *system)
{
    return system->alone ? GM_SYSTEM_KINDS : system->theta ? GM_SYSTEM_KINDS + 1 : (size_t)system->kind;
}

enum { MOST_EQUATIONS = 40 }; /* the largest number of printed equations; --json has them all */

/* A line of the report, LEFT = formula. */
struct equation {
    enum section { ENERGY, FORM, LET, RATE, CONSTRAINT } section;
    const char *left;
    gm_node_id node;
};

struct report {
    struct gm_arena *arena; /* owns the report's texts */
    struct gm_user_system system;
    struct gm_user_model model;
    struct gm_user_evolution evolution;
    struct gm_recognised recognised;
    struct gm_user_form form;
    struct gm_user_wave wave;
    struct gm_problem problem; /* set up with the file's values; not opened if no scheme can advance it */
    struct equation *equations;
    size_t equation_count;
};

/* The text of a formula; a note for one that is too long to read; -0, a derivative of 0, as 0. */
static const char *formula_of(const struct report *report, gm_node_id node, bool latex)
{
    const struct gm_node *whole = &report->system.graph.nodes[node];
    if (whole->operation == GM_CONSTANT && whole->value == 0) {
        return "0";
    }
    const struct gm_naming naming = gm_system_naming(&report->system);
    char *text = latex ? gm_formula_latex(&report->system.graph, node, &naming)
                       : gm_formula_text(&report->system.graph, node, &naming);
    if (!text && !gm_memory_was_short()) {
        return latex ? "\\ldots" : "(a long formula)";
    }
    return gm_arena_keep(report->arena, text, free);
}

static void print_equation(const struct report *report, const char *left, gm_node_id node)
{
    const char *formula = formula_of(report, node, false); /* it may leave: no half line is printed */
    gm_print_wrapped(formula, printf("  %s = ", left), 6);
}

static const char *name_of(const struct report *report, const char *name, bool latex)
{
    return latex ? gm_arena_keep(report->arena, gm_name_latex(name), free) : name;
}

/* "u_t", or with a mass "(u - u_xx)_t" */
static const char *name_rate(const struct report *report, size_t i, bool latex)
{
    const struct gm_user_system *system = &report->system;
    const char *left = gm_arena_print(report->arena, latex ? "\\partial_t %.60s" : "%.60s_t",
                                      name_of(report, system->variables[i].name, latex));
    for (size_t k = 0; k < system->item_count; k++) {
        const struct gm_system_item *item = &system->items[k];
        if (item->word == GM_WORD_MASS && gm_system_mass_field(system, item->nodes[0]) == i) {
            left = gm_arena_print(report->arena, latex ? "\\partial_t\\left(%.200s\\right)" : "(%.200s)_t",
                                  formula_of(report, item->nodes[0], latex));
        }
    }
    return left;
}

/* A row of K z_t + L z_x, as its entries are written: "-v_t + w_x" */
static const char *name_row(const struct report *report, size_t row, bool latex)
{
    const struct gm_user_system *system = &report->system;
    const size_t n = system->n;
    const char *left = "";
    for (size_t which = 0; which < 2; which++) {
        for (size_t c = 0; c < n; c++) {
            const gm_node_id node = system->matrices[(which * n + row) * n + c];
            if (gm_is_constant(&system->graph, node, 0)) {
                continue;
            }
            const bool one = gm_is_constant(&system->graph, node, 1),
                       minus = gm_is_constant(&system->graph, node, -1);
            const char *sign = minus ? (left[0] ? " - " : "-") : left[0] ? " + " : "", *factor = "";
            if (!one && !minus) {
                factor = gm_arena_print(report->arena, latex ? "\\left(%.80s\\right)\\," : "(%.60s) ",
                                        formula_of(report, node, latex));
            }
            const char *name = name_of(report, system->variables[c].name, latex),
                       *variable = which ? "x" : "t";
            left = latex
                       ? gm_arena_print(report->arena, "%s%s%s\\partial_%s %.60s", left, sign, factor,
                                        variable, name)
                       : gm_arena_print(report->arena, "%s%s%s%.40s_%s", left, sign, factor, name, variable);
        }
    }
    return left[0] ? left : "0";
}

/* The left side of the equation of rate number i. */
static const char *left_of(const struct report *report, size_t i, bool latex)
{
    const struct gm_user_system *system = &report->system;
    const bool momentum = system->kind == GM_LAGRANGIAN && i < system->n / 2;
    if (system->kind == GM_MATRICES) {
        return name_row(report, i, latex);
    }
    if (system->kind == GM_EVOLUTION) {
        return name_rate(report, i, latex);
    }
    if (system->kind == GM_FIELD) {
        const char *name = name_of(report, system->variables[0].name, latex);
        return gm_arena_print(report->arena,
                              latex ? "\\partial_t^2 %.60s - \\partial_x^2 %.60s" : "%.60s_tt - %.60s_xx",
                              name, name);
    }
    return gm_arena_print(report->arena,
                          momentum ? "%.60s"
                          : latex  ? "\\dot{%.60s}"
                                   : "%.60s'",
                          name_of(report, system->variables[momentum ? system->n / 2 + i : i].name, latex));
}

static void add_equation(struct report *report, enum section section, const char *left, gm_node_id node)
{
    report->equations = gm_arena_resize(report->arena, report->equations, report->equation_count + 1,
                                        sizeof *report->equations);
    report->equations[report->equation_count++] = (struct equation){section, left, node};
}

/* Adds the lines of the items with this word, each with its name or a 0 on the left. */
static void add_items(struct report *report, int word, enum section section, bool latex)
{
    for (size_t i = 0; i < report->system.item_count; i++) {
        const struct gm_system_item *item = &report->system.items[i];
        if ((int)item->word == word) {
            add_equation(report, section, section == LET ? name_of(report, item->name, latex) : "0",
                         item->nodes[0]);
        }
    }
}

/* Makes the list of all lines: what text, JSON and LaTeX print. */
static void list_equations(struct report *report, bool latex)
{
    const struct gm_user_system *system = &report->system;
    const char *energy = kinds[kind_of(system)].energy;
    if (energy[0]) {
        add_equation(report, ENERGY, energy, system->energy);
    }
    for (size_t i = 0; i < system->n && system->theta; i++) { /* the form of a degenerate Lagrangian */
        const char *name = name_of(report, system->variables[i].name, latex);
        add_equation(report, FORM,
                     gm_arena_print(report->arena, latex ? "\\theta_{%.60s}" : "theta_%.60s", name),
                     system->theta[i]);
    }
    if (system->theta && gm_system_naming(system).part(system->pfaffian, system)) {
        add_equation(report, FORM, latex ? "\\mathrm{Pf}\\,\\Omega" : "Pf", system->pfaffian);
    }
    add_items(report, GM_WORD_LET, LET, latex);
    /* the first equation of a field only states u_t = u_t */
    for (size_t i = system->kind == GM_FIELD; i < system->n && !system->alone; i++) {
        const bool momentum = system->kind == GM_LAGRANGIAN && i < system->n / 2;
        add_equation(report, RATE, left_of(report, i, latex),
                     momentum ? system->momenta[i] : system->rates[i]);
    }
    add_items(report, GM_WORD_CONSTRAINT, CONSTRAINT, latex);
}

static const char *certainty(enum gm_identity check)
{
    static const char *const words[] = {[GM_NOT_ZERO] = "not kept",
                                        [GM_ZERO_PROVED] = "proved",
                                        [GM_ZERO_TESTED] = "tested at random points",
                                        [GM_UNTESTED] = "not checked"};
    return words[check];
}

static bool is_kept(const struct gm_system_item *item)
{
    return item->word == GM_WORD_INVARIANT || item->word == GM_WORD_CASIMIR || item->word == GM_WORD_SYMMETRY;
}

/* The name of an invariant; a momentum map without a name has its number. */
static const char *kept_name(const struct report *report, const struct gm_system_item *item)
{
    int number = 0;
    for (const struct gm_system_item *other = report->system.items; other <= item; other++) {
        number += other->word == GM_WORD_SYMMETRY && !other->name[0];
    }
    return item->name[0] ? item->name : gm_arena_print(report->arena, "momentum%d", number);
}

static void print_texts(const struct report *report)
{
    const struct gm_user_system *system = &report->system;
    const char *const texts[] = {gm_system_title(system), system->texts[GM_WORD_ABOUT],
                                 system->texts[GM_WORD_WATCH], system->texts[GM_WORD_REFERENCE]};
    for (size_t i = 0; i < GM_COUNT(texts); i++) {
        if (texts[i]) {
            gm_print_wrapped(texts[i], 0, 0);
        }
    }
    gm_print_wrapped(gm_arena_print(report->arena, "%s of %zu component%s%s", kinds[kind_of(system)].title,
                                    system->n, gm_plural((double)system->n),
                                    system->timed ? " and the time" : ""),
                     0, 0);
}

static const double *start_of(const struct report *report)
{
    return gm_arena_keep(report->arena, gm_equations_start(&report->system, NULL), free);
}

static void print_parameters(const struct report *report)
{
    const struct gm_user_system *system = &report->system;
    const double *start = start_of(report);
    if (system->parameters < system->velocities || system->choices.count > 0) {
        printf("\nparameters\n");
    }
    for (size_t i = 0; i < system->choices.count; i++) {
        const struct gm_written_choice *choice = &system->choices.list[i];
        const char *words = "";
        for (size_t k = 0; k < choice->count; k++) {
            words = gm_arena_print(report->arena, "%s%s%s", words, k ? ", " : "one of ", choice->words[k]);
        }
        gm_print_wrapped(words, printf("  %-14s %-12s ", choice->name, choice->words[choice->chosen]), 30);
    }
    for (size_t i = system->parameters; i < system->velocities; i++) {
        const struct gm_system_variable *row = &system->variables[i];
        char value[64], low[64], high[64];
        const char *range = isnan(row->low) ? ""
                                            : gm_arena_print(report->arena, " [%s .. %s]",
                                                             gm_number_format(row->low, low, sizeof low),
                                                             gm_number_format(row->high, high, sizeof high));
        gm_number_format(row->value, value, sizeof value);
        const char *told =
            gm_arena_print(report->arena, "%.200s%s%.60s%s%s", row->meaning, row->unit[0] ? ", in " : "",
                           row->unit, range, row->fixed ? " (a whole number that is fixed)" : "");
        gm_print_wrapped(told, printf("  %-14s %-12s ", row->name, value), 30);
    }
    if (gm_system_is_form(system)) { /* starts are formulas on a mesh */
        return;
    }
    printf("\nstart\n");
    if (system->drift != GM_NO_NODE) {
        print_equation(report, "X_t", system->drift);
    }
    for (size_t i = 0; i < system->n && !system->alone && i < MOST_EQUATIONS; i++) {
        if (gm_system_is_field(system)) {
            print_equation(report, system->variables[i].name, system->variables[i].start);
            continue;
        }
        printf("  %-14s %.15g%s\n", system->variables[i].name, start[i],
               system->variables[i].angle ? " (an angle)" : "");
    }
}

/* The lines of a mesh equation, which are kept as texts, as they are printed. */
static const struct {
    enum gm_system_word word;
    const char *left, *latex;
} mesh_lines[] = {{GM_WORD_DENSITY, "density", "\\rho"},
                  {GM_WORD_MESH, "X", "X"},
                  {GM_WORD_CELL, "cell", "L_{\\mathrm{cell}}"},
                  {GM_WORD_BETWEEN, "v between nodes", "v"}};

/* Returns the formula of a mesh line, behind its X = ; NULL: the file has no such line. */
static const char *mesh_formula(const struct report *report, size_t i)
{
    const char *text = report->system.texts[mesh_lines[i].word],
               *equals = text && mesh_lines[i].word == GM_WORD_MESH ? strchr(text, '=') : NULL;
    return equals ? equals + 1 + strspn(equals + 1, " ") : text;
}

/* Names as variables in the order in which a formula has them. */
enum { MOST_NAMES = 32 };
struct names {
    struct gm_arena *arena;
    struct gm_formula graph;
    const char *name[MOST_NAMES];
    size_t count;
};

static enum gm_meaning find_any(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    struct names *names = data;
    const char *text = gm_arena_print(names->arena, "%.*s", (int)name->length, name->text);
    size_t i = 0;
    while (i < names->count && strcmp(names->name[i], text) != 0) {
        i++;
    }
    if (i == MOST_NAMES) {
        sentence[0] = '\0';
        return GM_REFUSED;
    }
    names->name[i] = text;
    names->count += i == names->count;
    *node = gm_formula_variable(&names->graph, i);
    return GM_KNOWN;
}

static const char *any_name(size_t number, const void *data)
{
    return ((const struct names *)data)->name[number];
}

/* Returns a formula of any names in LaTeX; dots for a long one, or for what cannot be read. */
static const char *latex_of(const struct report *report, const char *text)
{
    struct names names = {.arena = report->arena};
    const struct gm_scope scope = {.find = find_any, .data = &names};
    const struct gm_naming naming = {.variable = any_name, .data = &names};
    struct gm_fault fault = {0};
    gm_node_id node;
    gm_formula_open(&names.graph);
    char *latex = gm_formula_read(&names.graph, text, 0, strlen(text), &scope, &node, &fault)
                      ? gm_formula_latex(&names.graph, node, &naming)
                      : NULL;
    gm_formula_close(&names.graph);
    return latex ? gm_arena_keep(report->arena, latex, free) : "\\ldots";
}

static void print_equations(const struct report *report)
{
    const struct gm_user_system *system = &report->system;
    printf("\nequations\n");
    for (size_t i = 0; i < GM_COUNT(mesh_lines) && system->n > 0; i++) {
        const char *text = mesh_formula(report, i);
        if (text) {
            gm_print_wrapped(text, printf("  %s = ", mesh_lines[i].left), 6);
        }
    }
    for (size_t i = 0, k = 0; i < report->equation_count; i++, k++) {
        const struct equation *line = &report->equations[i];
        k = i > 0 && line[-1].section == line->section ? k : 0; /* its number in its section */
        if (k == MOST_EQUATIONS && line->section == RATE) {
            printf("  and %zu more\n", system->n - k);
        } else if (k == 0 && line->section == CONSTRAINT) {
            printf("\nconstraints, whose forces act on the momenta beside these rates\n");
        }
        if (k < MOST_EQUATIONS || line->section < RATE) {
            print_equation(report, line->left, line->node);
        }
    }
    for (size_t i = 0, k = 1; i < system->item_count && k <= MOST_EQUATIONS; i++) {
        const char *text = system->source + system->items[i].place;
        if (system->items[i].word == GM_WORD_EVENT) {
            printf("%s  %.*s\n", k == 1 ? "\nevents, as the file has them\n" : "", (int)strcspn(text, "\n"),
                   text);
            k++;
        }
    }
}

static void print_kept(const struct report *report)
{
    const struct gm_user_system *system = &report->system;
    bool any = false;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (!is_kept(item)) {
            continue;
        }
        printf("%s", any ? "" : "\ninvariants\n");
        any = true;
        const gm_node_id node = gm_system_conserved(system, item);
        const char *by = item->word == GM_WORD_CASIMIR    ? "a Casimir, "
                         : item->word == GM_WORD_SYMMETRY ? "by symmetry, "
                                                          : "";
        const char *line =
            gm_arena_print(report->arena, "%s = %s (%s%s)", kept_name(report, item),
                           node == GM_NO_NODE ? "a symmetry of the motion" : formula_of(report, node, false),
                           by, certainty(item->check));
        gm_print_wrapped(line, printf("  "), 2);
    }
}

/* The facets of a field: its equation has them. */
static const char *const field_facts[][2] = {
    {"wave", "u_tt = u_xx - V'(u), and V is smooth"},
    {"multisymplectic", "s = (u, u_t, u_x) solves M s_t + K s_x = grad S(s), S = V(u) + u_t^2/2 - u_x^2/2"},
};
enum { FIELD_FACTS = GM_COUNT(field_facts) };
static const char form_fact[] = "K z_t + L z_x = grad S(z), K and L are skew, and S is smooth";

static bool has_linear(const struct report *report, size_t i)
{
    return !gm_is_constant(&report->system.graph, report->evolution.linear[i], 0);
}

/* The linear part of the rate of a field, in words. */
static const char *linear_fact(const struct report *report, size_t i)
{
    const char *line = formula_of(report, report->evolution.linear[i], false),
               *name = report->system.variables[i].name;
    return strcmp(line, "0") == 0 ? gm_arena_print(report->arena, "nothing is linear in the rate of %s", name)
                                  : gm_arena_print(report->arena, "in the rate of %s: %s", name, line);
}

/* "Korteweg-de Vries, eta = 6, mu = 1" */
static const char *equation_fact(const struct report *report)
{
    const struct gm_recognised *of = &report->recognised;
    const struct gm_naming naming = gm_system_naming(&report->system);
    const char *text = of->name;
    for (size_t i = 0; i < GM_EQUATION_CONSTANTS && of->constants[i]; i++) {
        char *value = gm_formula_text(&report->system.graph, of->values[i], &naming);
        text = gm_arena_print(report->arena, "%s, %s = %.80s", text, of->constants[i],
                              value ? (const char *)gm_arena_keep(report->arena, value, free)
                                    : "a long formula");
    }
    return text;
}

/* Puts a fact, of a component or "", into an object of JSON or, with NULL, prints it. */
static void put_fact(struct gm_row *row, const char *word, const char *of, bool holds, const char *reason)
{
    char key[80];
    snprintf(key, sizeof key, *of ? "linear_part_%.60s" : "%.60s", *of ? of : word);
    if (row) {
        struct gm_row fact = gm_row_open(row, key, '}');
        gm_row_put(&fact, "holds %d, reason %s", holds, reason);
    } else {
        gm_print_wrapped(reason, printf("  %-16s %-4s", word, holds ? "yes" : "no"), 23);
    }
}

/* Puts or prints every fact of the structure. */
static void put_facts(const struct report *report, struct gm_row *row)
{
    const struct gm_user_system *system = &report->system;
    for (size_t i = 0; i < system->n && system->kind == GM_EVOLUTION; i++) {
        put_fact(row, "linear part", system->variables[i].name, has_linear(report, i),
                 linear_fact(report, i));
    }
    if (system->kind == GM_MATRICES) {
        put_fact(row, "multisymplectic", "", true, form_fact);
    }
    if (report->recognised.name) {
        put_fact(row, "equation", "", true, equation_fact(report));
    }
    if (system->alone) {
        put_fact(row, "lagrangian", "", true,
                 "the sum of the cells' Lagrangian, which does not depend on the time");
    }
    for (size_t i = 0; i < FIELD_FACTS && system->kind == GM_FIELD && !system->alone; i++) {
        put_fact(row, field_facts[i][0], "", true, field_facts[i][1]);
    }
    for (enum gm_fact fact = 0; fact < GM_FACTS; fact++) {
        const struct gm_finding *finding = &report->model.findings[fact];
        char *reason = finding->asked ? gm_fact_reason(system, fact, finding) : NULL;
        if (gm_memory_was_short()) { /* it may name a part of the places alone */
            free(reason);
            gm_arena_need(report->arena, false);
        }
        if (reason) {
            put_fact(row, gm_fact_word(fact), "", finding->holds, reason);
        }
        free(reason);
    }
    const struct gm_system_item *until = gm_system_item_of(system, GM_WORD_UNTIL, 0);
    if (until && system->kind <= GM_POISSON && report->problem.kind) {
        const struct gm_stiffness stiffness =
            gm_stiffness_of(&report->problem, start_of(report), until->value);
        if (stiffness.stiff) {
            put_fact(row, "stiff", "", true,
                     gm_arena_print(report->arena, "rates %.2g to %.2g", stiffness.slow, stiffness.fast));
        }
    }
}

/* The rates of a part as equations, without those that are 0; parameters have their values. */
static const char *part_equations(const struct report *report, const char *part)
{
    const struct gm_problem *problem = &report->problem;
    const struct gm_naming names = gm_system_naming(&report->system),
                           naming = {.variable = names.variable, .data = names.data};
    struct gm_formula *graph = gm_arena_take(report->arena, 1, sizeof *graph);
    gm_node_id *rates = gm_arena_take(report->arena, problem->n + 1, sizeof *rates);
    const size_t most = 160; /* letters, after which the others are left out */
    const char *text = "";
    gm_formula_open(graph);
    gm_arena_keep(report->arena, graph, gm_formula_close);
    gm_ode_of(problem)->parts->rates(report->arena, problem, part, graph, rates);
    for (size_t i = 0; i < report->system.n && strlen(text) < most; i++) {
        const gm_node_id tidied = gm_formula_tidied(graph, rates[i], &naming);
        gm_arena_need(report->arena, tidied != GM_NO_NODE);
        if (gm_is_constant(graph, tidied, 0)) {
            continue;
        }
        char *rate = gm_formula_text(graph, tidied, &naming);
        rate = rate ? rate : gm_formula_text(graph, rates[i], &naming);
        text = gm_arena_print(report->arena, "%s%s %s' = %s", text, text[0] ? "," : "",
                              report->system.variables[i].name, rate ? rate : "a long formula");
        free(rate);
    }
    return strlen(text) < most ? text[0] ? text : " it is 0 here"
                               : gm_arena_print(report->arena, "%.*s ...", (int)most, text);
}

/* Puts or prints every part that has a name, with the way in which its flow is computed, and its equations. */
static void put_parts(const struct report *report, struct gm_row *row)
{
    const struct gm_ode *ode = gm_system_is_field(&report->system) ? NULL : gm_ode_of(&report->problem);
    bool headed = row != NULL;
    for (const char *const *name = ode && ode->parts ? ode->parts->names : NULL; name && *name; name++) {
        const char *flow = gm_part_flow(&report->problem, *name);
        if (!flow && (size_t)(name - ode->parts->names) >= ode->parts->given) {
            continue;
        }
        const char *told =
            gm_arena_print(report->arena, "%s;%s", flow ? flow : "no flow of its own, a scheme moves it",
                           part_equations(report, *name));
        /* without memory a flow is unknown, or a formula is not that of the part */
        gm_arena_need(report->arena, !gm_memory_was_short());
        if (row) {
            gm_row_text(row, *name, told);
        } else {
            printf(headed ? "" : "\nparts\n");
            headed = true;
            gm_print_wrapped(told, printf("  %-16s ", *name), 19);
        }
    }
}

static void print_facts(const struct report *report)
{
    printf("\nstructure\n");
    if (report->system.kind == GM_POISSON) {
        printf("  %-16s yes Jacobi's identity holds (%s)\n", "bracket", certainty(report->system.jacobi));
    }
    put_facts(report, NULL);
}

/* True for a scheme of the system; nodes alone have those of free nodes. */
static bool fits(const struct report *report, const struct gm_scheme *scheme)
{
    return report->system.alone
               ? scheme->family->kind == &gm_kind_mesh && gm_scheme_mesh(scheme) == GM_MESH_FREE
               : gm_scheme_fits(scheme, &report->problem);
}

/* Prints the fitting schemes, and those of another kind of grid. */
static void print_names(const struct report *report, const struct gm_kind *other)
{
    const char *text = "";
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (other ? scheme->family->kind == other : fits(report, scheme)) {
            const struct gm_scheme *same = other ? NULL : gm_scheme_same_as(scheme, &report->problem);
            text = gm_arena_print(report->arena, same ? "%s%s (= %s) " : "%s%s ", text, scheme->name,
                                  same ? same->name : "");
        }
    }
    gm_arena_need(report->arena, !gm_memory_was_short()); /* a scheme that is not opened would be left out */
    gm_print_wrapped(text, printf("  "), 2);
}

static void print_schemes(const struct report *report)
{
    const char *lacks = gm_system_is_field(&report->system) ? "" : gm_user_model_lacks(&report->model);
    printf("\nschemes that fit\n");
    if (lacks[0]) {
        gm_print_wrapped(lacks, printf("  "), 2);
    } else {
        print_names(report, NULL);
    }
    if (report->system.kind == GM_FIELD && !report->system.alone) {
        if (report->wave.sine_gordon) {
            printf("\nand on a moving mesh, with exact means of V\n");
        } else {
            printf("\nand on a moving mesh, with means of V by %zu of Gauss's points\n",
                   gm_user_mesh_order(&report->wave));
        }
        print_names(report, &gm_kind_mesh);
    }
}

static void put_formula(struct gm_row *row, const char *key, const struct report *report, gm_node_id node)
{
    gm_row_text(row, key, formula_of(report, node, false));
}

static void put_parameters(struct gm_row *row, const struct gm_user_system *system)
{
    struct gm_row parameters = gm_row_open(row, "parameters", '}');
    for (size_t i = 0; i < system->choices.count; i++) {
        const struct gm_written_choice *choice = &system->choices.list[i];
        gm_row_text(&parameters, choice->name, choice->words[choice->chosen]);
    }
    for (size_t i = system->parameters; i < system->velocities; i++) {
        gm_row_number(&parameters, system->variables[i].name, system->variables[i].value, 17);
    }
}

static void put_values(struct gm_row *row, const struct report *report)
{
    const struct gm_user_system *system = &report->system;
    const double *start = start_of(report);
    put_parameters(row, system);
    struct gm_row starts = gm_row_open(row, "start", '}');
    if (system->drift != GM_NO_NODE) {
        put_formula(&starts, "X_t", report, system->drift);
    }
    for (size_t i = 0; i < system->n && !system->alone; i++) {
        if (gm_system_is_field(system)) {
            put_formula(&starts, system->variables[i].name, report, system->variables[i].start);
        } else {
            gm_row_number(&starts, system->variables[i].name, start[i], 17);
        }
    }
}

/* Puts the lines of a section, with their left sides in an object. */
static void put_section(struct gm_row *row, const char *key, const struct report *report,
                        enum section section)
{
    struct gm_row list = gm_row_open(row, key, section == CONSTRAINT ? ']' : '}');
    if (section == RATE && report->system.alone) {
        gm_row_text(&list, "cell", report->system.texts[GM_WORD_CELL]);
    }
    for (size_t i = 0; i < report->equation_count; i++) {
        const struct equation *line = &report->equations[i];
        if (line->section == section) {
            put_formula(&list, section == CONSTRAINT ? NULL : line->left, report, line->node);
        }
    }
}

static void put_equations(struct gm_row *row, const struct report *report)
{
    const struct gm_user_system *system = &report->system;
    put_section(row, "equations", report, RATE);
    if (system->theta) {
        put_section(row, "form", report, FORM);
    }
    put_section(row, "constraints", report, CONSTRAINT);
    struct gm_row invariants = gm_row_open(row, "invariants", '}');
    for (size_t i = 0; i < system->item_count; i++) {
        if (is_kept(&system->items[i])) {
            gm_row_text(&invariants, kept_name(report, &system->items[i]), certainty(system->items[i].check));
        }
    }
}

static void print_json(const struct report *report, const struct gm_file *file)
{
    const struct gm_user_system *system = &report->system;
    struct gm_row row = gm_row_begin(stdout);
    gm_row_put(&row, "title %s, kind %s, timed %d", gm_system_title(system) ? gm_system_title(system) : "",
               kinds[kind_of(system)].word, system->timed);
    put_values(&row, report);
    put_equations(&row, report);
    struct gm_row structure = gm_row_open(&row, "structure", '}');
    put_facts(report, &structure);
    struct gm_row parts = gm_row_open(&row, "parts", '}');
    put_parts(report, &parts);
    const struct gm_scheme *fitting[GM_FITTING_SCHEMES], *same[GM_FITTING_SCHEMES];
    size_t count = 0;
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        if (count < GM_FITTING_SCHEMES && fits(report, gm_scheme_at(i))) {
            same[count] = gm_scheme_same_as(gm_scheme_at(i), &report->problem);
            fitting[count++] = gm_scheme_at(i);
        }
    }
    gm_list_put_schemes(&row, fitting, same, count);
    gm_list_put_file(&row, file, system->source);
    gm_row_close(&row, "\n");
}

/* Simplifies a derived formula for printing; a typed formula stays. */
static void tidy(struct report *report, gm_node_id *node)
{
    const struct gm_naming naming = gm_system_naming(&report->system);
    if (*node != GM_NO_NODE && report->system.graph.places[*node] == GM_NO_PLACE) {
        const gm_node_id tidied = gm_formula_tidied(&report->system.graph, *node, &naming);
        char *text = tidied == GM_NO_NODE ? NULL : gm_formula_text(&report->system.graph, tidied, &naming);
        *node = text ? tidied : *node; /* an expanded formula may be too long to read */
        free(text);
    }
    gm_arena_need(report->arena, !gm_memory_was_short());
}

/* -lambda_k times the derivative of each constraint over a coordinate: the forces that hold them. */
static void print_forces(struct report *report, size_t coordinate)
{
    struct gm_user_system *system = &report->system;
    bool *marked = gm_arena_take(report->arena, system->variable_count, sizeof *marked);
    gm_node_id *gradient = gm_arena_take(report->arena, system->variable_count, sizeof *gradient);
    marked[coordinate] = true;
    for (size_t i = 0, k = 1; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word != GM_WORD_CONSTRAINT) {
            continue;
        }
        if (gm_gradient(&system->graph, item->nodes[0], marked, system->variable_count, gradient) &&
            !gm_is_constant(&system->graph, gradient[coordinate], 0)) {
            tidy(report, &gradient[coordinate]);
            const char *text = formula_of(report, gradient[coordinate], true);
            printf(strpbrk(text, "+-") ? " - \\lambda_{%zu}\\left(%s\\right)" : " - \\lambda_{%zu}\\,%s", k,
                   text);
        }
        k++;
    }
}

static void print_latex(struct report *report)
{
    const size_t half = report->system.n / 2;
    const char *between = "";
    printf("\\begin{align}\n");
    for (size_t i = 0, rate = 0; i < report->equation_count; i++) {
        const struct equation *line = &report->equations[i];
        printf("%s  %s &= %s", between, line->left, formula_of(report, line->node, true));
        between = " \\\\\n";
        rate += line->section == RATE;
        if (line->section == RATE && rate > half && !gm_system_is_field(&report->system)) {
            print_forces(report, rate - 1 - half);
        }
    }
    for (size_t i = 0; i < GM_COUNT(mesh_lines); i++) {
        const char *text = mesh_formula(report, i);
        if (text) {
            printf("%s  %s &= %s", between, mesh_lines[i].latex, latex_of(report, text));
            between = " \\\\\n";
        }
    }
    if (report->system.alone) {
        printf("%s  \\frac{\\mathrm{d}}{\\mathrm{d}t}\\frac{\\partial L}{\\partial\\dot{x}_k} &= "
               "\\frac{\\partial L}{\\partial x_k},\\quad L = \\textstyle\\sum L_{\\mathrm{cell}},\\quad "
               "d = x_{k+1} - x_k,\\quad m = (x_k + x_{k+1})/2",
               between);
    }
    printf("\n\\end{align}\n");
}

static void refuse_value(const struct gm_options *options, const char *name, const char *value)
{
    gm_command_end(
        options, GM_EXIT_USAGE,
        "list SYSTEM takes parameters with numbers, such as N=3, and words of choices, not \"%.60s%s%.60s\"",
        name, value[0] ? "=" : "", value);
}

/* Reads key=value words, each of a parameter or a choice of the system; others replace a line of its file. */
static size_t read_values(const struct gm_options *options, struct gm_system_value *values)
{
    const struct gm_arguments *arguments = &options->arguments;
    size_t count = 0;
    for (int i = 1; i < arguments->count; i++) {
        const char *word = arguments->words[i], *equals = strchr(word, '=');
        if (!equals) {
            refuse_value(options, word, "");
        }
        if (!gm_replacing_key(word)) {
            const char *name = gm_arena_print(options->arena, "%.*s", (int)(equals - word), word);
            values[count++] = (struct gm_system_value){name, equals + 1};
        }
    }
    return count;
}

/* Every value must be that of a parameter, or a word of a choice. */
static void check_values(const struct gm_options *options, const struct gm_user_system *system,
                         const struct gm_system_value *values, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        size_t i = system->parameters;
        while (i < system->velocities && strcmp(system->variables[i].name, values[k].name) != 0) {
            i++;
        }
        double number;
        const struct gm_written_choice *choice = gm_choice_named(&system->choices, values[k].name);
        if (choice && strcmp(choice->words[choice->chosen], values[k].text) == 0) {
            continue;
        }
        if (choice || (i < system->velocities && !gm_number_parse(values[k].text, &number))) {
            refuse_value(options, values[k].name, values[k].text);
        }
        gm_command_end_if(options, i >= system->velocities, GM_EXIT_USAGE,
                          "this system has no parameter \"%.60s\"", values[k].name);
    }
}

/* The equation of a field, and its facets, which are those of every ring. */
static bool open_field(struct report *report, const double *start)
{
    const struct gm_grid1 any = {.points = 6, .dx = 1};
    struct gm_user_evolution *evolution = &report->evolution;
    if (report->system.kind == GM_MATRICES) {
        return gm_user_form_derive(&report->form, &report->system) &&
               gm_user_form_open(&report->problem, &report->form, start, &any);
    }
    if (report->system.kind == GM_FIELD) {
        return gm_user_wave_derive(&report->wave, &report->system) &&
               gm_user_wave_open(&report->problem, &report->wave, start, &any);
    }
    const bool opened =
        gm_equation_recognise(&report->system, &report->recognised) &&
        gm_user_evolution_derive(evolution, &report->system) &&
        gm_user_evolution_open(&report->problem, evolution, start, &any, GM_SPACE_DIFFERENCES);
    const bool smooth = evolution->kink == GM_NO_NODE;
    report->model.findings[GM_FACT_SMOOTH] = (struct gm_finding){.asked = true,
                                                                 .holds = smooth,
                                                                 .how = smooth ? GM_ZERO_PROVED : GM_NOT_ZERO,
                                                                 .term = evolution->kink,
                                                                 .component = evolution->kinked};
    return opened;
}

static bool open_equations(struct report *report, const double *start)
{
    return gm_user_model_open(&report->model, &report->system) &&
           (gm_user_model_lacks(&report->model)[0] ||
            gm_user_problem_open(&report->problem, &report->model, start));
}

/* Derived formulas are only printed after this call. */
static void tidy_all(struct report *report)
{
    struct gm_user_system *system = &report->system;
    for (size_t i = 0; report->recognised.name && i < GM_EQUATION_CONSTANTS; i++) {
        if (report->recognised.constants[i]) {
            tidy(report, &report->recognised.values[i]);
        }
    }
    for (size_t i = 0; i < system->n; i++) {
        tidy(report, &system->rates[i]);
        if (system->kind == GM_LAGRANGIAN && i < system->n / 2) {
            tidy(report, &system->momenta[i]);
        }
    }
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_SYMMETRY && system->kind <= GM_LAGRANGIAN) {
            tidy(report, &item->nodes[system->n / 2]);
        }
    }
}

static void close_report(void *data)
{
    struct report *report = data;
    if (gm_system_is_field(&report->system)) {
        gm_user_line_close(&report->problem);
    } else {
        gm_user_problem_close(&report->problem);
    }
    gm_system_close(&report->system);
}

/* The system of a file with other values, or of words alone: the file is NULL. */
static struct report *open_report(const struct gm_options *options, const struct gm_file *file)
{
    char message[GM_MESSAGE];
    const struct gm_arguments *arguments = &options->arguments;
    struct report *report = gm_arena_take(options->arena, 1, sizeof *report);
    struct gm_system_value *values = gm_arena_take(options->arena, (size_t)arguments->count, sizeof *values);
    const size_t count = file ? read_values(options, values) : 0;
    report->arena = options->arena;
    gm_arena_keep(options->arena, report, close_report);
    const int status = gm_system_open(&report->system, file, arguments, values, count, message);
    gm_command_end_if(options, status != GM_EXIT_OK, status, "%s", message);
    check_values(options, &report->system, values, count);
    return report;
}

/* A system that is listed can be run too: its schemes, members and observables are those of a scene. Words without a
   file, or that replace a line of one, must be keys of it. */
static void check_scene(const struct gm_options *options, bool typed)
{
    char message[GM_MESSAGE] = "not enough memory";
    char *const *words = options->arguments.words;
    const int count = options->arguments.count;
    struct gm_system_trial trial;
    struct gm_words read = {0};
    for (int i = 1; i < count; i++) {
        typed = typed || gm_replacing_key(words[i]);
    }
    const bool known =
        gm_system_try(&trial, count, words, message) &&
        (!typed || gm_words_read(&read, trial.scene, count - 1, words + 1, GM_RUN_SCHEMES, message));
    const int status = trial.scene ? GM_EXIT_USAGE : trial.status;
    gm_words_close(&read);
    gm_system_trial_close(&trial);
    gm_command_end_if(options, !known, status, "%s", message);
}

void gm_list_put_schemes(struct gm_row *row, const struct gm_scheme *const *schemes,
                         const struct gm_scheme *const *same, size_t count)
{
    struct gm_row list = gm_row_open(row, "schemes", ']');
    for (size_t i = 0; i < count; i++) {
        gm_row_text(&list, NULL, schemes[i]->name);
    }
    struct gm_row all = gm_row_open(row, "same_as", '}');
    for (size_t i = 0; i < count; i++) {
        const struct gm_scheme *one = same[i] ? same[i] : schemes[i];
        struct gm_row names = {0};
        for (size_t k = 0; k < count; k++) {
            if (k != i && (schemes[k] == one || same[k] == one)) {
                names = names.begun ? names : gm_row_open(&all, schemes[i]->name, ']');
                gm_row_text(&names, NULL, schemes[k]->name);
            }
        }
    }
}

void gm_list_put_file(struct gm_row *row, const struct gm_file *file, const char *source)
{
    gm_row_put(row, "file %s, source %s", file ? file->path : NULL, file ? source : NULL);
}

/* A formula without names of parts, as it was typed or tidied. */
static const char *written_out(struct report *report, gm_node_id node)
{
    struct gm_formula *graph = &report->system.graph;
    struct gm_naming naming = gm_system_naming(&report->system);
    naming.part = NULL;
    if (graph->places[node] == GM_NO_PLACE) {
        node = gm_formula_tidied(graph, node, &naming);
    }
    char *text = node == GM_NO_NODE ? NULL : gm_formula_text(graph, node, &naming);
    gm_arena_need(report->arena, text || !gm_memory_was_short());
    return text ? gm_arena_keep(report->arena, text, free) : "(a long formula)";
}

/* I1, I2, ... (gm_found_word) if it has no other name, by the number of those before it. */
static const char *found_name(const struct report *report, const struct gm_found_invariants *invariants,
                              size_t number)
{
    const struct gm_found_invariant *list = invariants->list, *invariant = &list[number];
    size_t unnamed = 1;
    for (size_t i = 0; i < number; i++) {
        unnamed += !list[i].item && !list[i].energy;
    }
    return invariant->item ? kept_name(report, invariant->item)
           : invariant->energy
               ? "H"
               : gm_arena_print(report->arena, "%s%zu", gm_found_word(&report->system), unnamed);
}

struct found {
    struct gm_found_invariants invariants;
    struct gm_symmetry *symmetries;
    size_t symmetries_unwritten;
    size_t symmetry_count;
    const char **names, **formulas; /* of the invariants, and then the formulas of the symmetries */
    const char **maps; /* of the symmetries: the names of their momentum maps, or formulas; NULL: none */
};

/* "x = -y, y = x": the components that are not 0 */
static const char *symmetry_formula(struct report *report, const struct gm_symmetry *symmetry)
{
    const char *text = "";
    for (size_t i = 0; i < report->system.n; i++) {
        if (!gm_is_constant(&report->system.graph, symmetry->field[i], 0)) {
            text = gm_arena_print(report->arena, "%s%s%s = %s", text, text[0] ? ", " : "",
                                  report->system.variables[i].name, written_out(report, symmetry->field[i]));
        }
    }
    return text;
}

/* Prepares names and formulas before the first line of them: there may be too little memory for all. */
static void write_found(struct report *report, struct found *found)
{
    const size_t count = found->invariants.count;
    found->names = gm_arena_take(report->arena, count + 1, sizeof *found->names);
    found->formulas =
        gm_arena_take(report->arena, count + found->symmetry_count + 1, sizeof *found->formulas);
    found->maps = gm_arena_take(report->arena, found->symmetry_count + 1, sizeof *found->maps);
    for (size_t i = 0; i < count; i++) {
        found->names[i] = found_name(report, &found->invariants, i);
        found->formulas[i] = written_out(report, found->invariants.list[i].node);
    }
    for (size_t i = 0; i < found->symmetry_count; i++) {
        const struct gm_symmetry *symmetry = &found->symmetries[i];
        found->formulas[count + i] = symmetry_formula(report, symmetry);
        found->maps[i] = symmetry->momentum_map == GM_NO_NODE ? NULL
                         : symmetry->paired < count           ? found->names[symmetry->paired]
                                                              : written_out(report, symmetry->momentum_map);
    }
}

static void print_found(struct report *report, const struct found *found)
{
    const struct gm_found_invariants *invariants = &found->invariants;
    if (invariants->lacks) {
        printf("invariants with a name: %zu; others are not searched: %s\n", invariants->count,
               invariants->lacks);
    } else {
        printf("invariants up to degree %zu, proved: %zu, %zu of them independent\n", invariants->degree,
               invariants->count, invariants->independent);
    }
    if (invariants->lowered) {
        printf("degree %zu has more than %d candidates\n", invariants->degree + 1, GM_MOST_CANDIDATES);
    }
    if (gm_system_item_of(&report->system, GM_WORD_EVENT, 0)) {
        puts("all of this holds between events, which may change it");
    }
    for (size_t i = 0; i < invariants->count; i++) {
        const struct gm_found_invariant *invariant = &invariants->list[i];
        const char *degree =
            invariant->degree > 0
                ? gm_arena_print(report->arena, "degree %zu", invariant->degree)
                : gm_arena_print(report->arena, "%s%s", invariants->lacks ? "" : "of a higher degree, ",
                                 certainty(invariant->proved ? GM_ZERO_PROVED : GM_ZERO_TESTED));
        const char *line =
            gm_arena_print(report->arena, "%s = %s (%s)", found->names[i], found->formulas[i], degree);
        gm_print_wrapped(line, printf("  "), 2);
    }
    if (invariants->unwritten > 0) {
        printf("  and %zu whose coefficients are not short fractions\n", invariants->unwritten);
    }
    if (invariants->lacks) {
        return;
    }
    if (report->system.n > GM_MOST_WITH_SYMMETRIES) {
        printf("affine symmetries are found for up to %d components\n", GM_MOST_WITH_SYMMETRIES);
        return;
    }
    printf("affine symmetries, fields that send motions into motions: %zu\n", found->symmetry_count);
    for (size_t i = 0; i < found->symmetry_count; i++) {
        const char *line =
            gm_arena_print(report->arena, "%s (scaling %g%s%s)", found->formulas[invariants->count + i],
                           found->symmetries[i].scaling, found->maps[i] ? ", momentum map " : "",
                           found->maps[i] ? found->maps[i] : "");
        gm_print_wrapped(line, printf("  "), 4);
    }
    if (found->symmetries_unwritten > 0) {
        printf("  and %zu whose coefficients are not short fractions\n", found->symmetries_unwritten);
    }
}

static void put_found(struct report *report, const struct found *found)
{
    const struct gm_found_invariants *invariants = &found->invariants;
    struct gm_row row = gm_row_begin(stdout);
    gm_row_put(&row, "degree %i, candidates %i, not_searched %s, between_events %d", (int)invariants->degree,
               (int)invariants->candidates, invariants->lacks,
               gm_system_item_of(&report->system, GM_WORD_EVENT, 0) != NULL);
    struct gm_row list = gm_row_open(&row, "invariants_found", ']');
    for (size_t i = 0; i < invariants->count; i++) {
        const struct gm_found_invariant *invariant = &invariants->list[i];
        struct gm_row one = gm_row_open(&list, NULL, '}');
        gm_row_put(&one, "formula %s, degree %.17g, proof %s, name %s", found->formulas[i],
                   invariant->degree > 0 ? (double)invariant->degree : NAN,
                   invariant->proved ? "exact" : certainty(GM_ZERO_TESTED), found->names[i]);
    }
    gm_row_put(&row, "invariants_unwritten %i, invariants_independent %i", (int)invariants->unwritten,
               (int)invariants->independent);
    list = gm_row_open(&row, "symmetries_found", ']');
    for (size_t i = 0; i < found->symmetry_count; i++) {
        struct gm_row one = gm_row_open(&list, NULL, '}');
        gm_row_put(&one, "formula %s, scaling %.17g, momentum_map %s", found->formulas[invariants->count + i],
                   found->symmetries[i].scaling, found->maps[i]);
    }
    gm_row_put(&row, "symmetries_unwritten %i", (int)found->symmetries_unwritten);
    gm_row_close(&row, "\n");
}

static int list_invariants(const struct gm_options *options, struct report *report)
{
    const size_t usual = 4, degree = options->degree ? (size_t)options->degree : usual;
    struct found found = {0};
    gm_invariants_find(&report->system, options->arena, degree, &found.invariants);
    gm_command_end_if(options, found.invariants.lacks && found.invariants.count == 0, GM_EXIT_USAGE,
                      "the invariants of this system are not searched: %s", found.invariants.lacks);
    found.symmetry_count = found.invariants.lacks
                               ? 0
                               : gm_symmetries_find(&report->system, options->arena, &found.invariants,
                                                    &found.symmetries, &found.symmetries_unwritten);
    write_found(report, &found);
    gm_arena_need(options->arena, !gm_memory_was_short());
    (options->json ? put_found : print_found)(report, &found);
    return GM_EXIT_OK;
}

/* A listed system of forms. */
struct listed_forms {
    struct report *report;
    struct gm_form_model model;
    struct gm_problem problem; /* parameters NULL: its mesh is a file, or cannot be made */
    struct gm_form_factor factors[GM_FORM_FACTORS];
    size_t factor_count;
};

static void close_listed(void *listed)
{
    gm_form_problem_close(&((struct listed_forms *)listed)->problem);
}

/* A form, or what is observed: its name, the word of its line, its type, and that of the equation of an unknown. */
struct listed_form {
    const char *name, *word, *type, *equation;
};

/* Row number `i` of all; false after the last. */
static bool listed_form(const struct listed_forms *listed, size_t i, struct listed_form *form)
{
    const struct gm_form_model *model = &listed->model;
    const struct gm_user_system *system = model->system;
    if (i < system->n) {
        const struct gm_form_declared *declared = &system->forms[i];
        *form = (struct listed_form){
            system->variables[i].name, declared->unknown ? "unknown" : "field",
            gm_form_type_text((struct gm_form_type){declared->degree, declared->dual}), NULL};
        for (size_t k = 0; k < model->unknown_count; k++) {
            if (model->unknowns[k] == i) {
                form->equation = gm_form_type_text(model->equation_types[k]);
            }
        }
        return true;
    }
    if (i - system->n >= model->observed_count) {
        return false;
    }
    const struct gm_system_item *item = &system->items[model->observed_item[i - system->n]];
    *form = (struct listed_form){
        item->name,
        item->word == GM_WORD_LET         ? "let"
        : item->word == GM_WORD_INVARIANT ? "invariant"
                                          : "observe",
        gm_form_type_text(model->observed.steps[model->observed.roots[i - system->n]].type), NULL};
    return true;
}

/* Prints for each invariant its rate along the equations: in a list of JSON or, with NULL, in words. */
static void tell_drifts(const struct listed_forms *listed, struct gm_row *list)
{
    const double kept_below = 1e-10; /* a rate that is round-off */
    const struct gm_form_model *model = &listed->model;
    for (size_t i = 0; i < model->observed_count; i++) {
        const struct gm_system_item *item = &model->system->items[model->observed_item[i]];
        const double drift = item->word == GM_WORD_INVARIANT ? gm_form_drift(&listed->problem, i) : NAN;
        if (list && item->word == GM_WORD_INVARIANT) {
            struct gm_row one = gm_row_open(list, NULL, '}');
            gm_row_put(&one, "name %s, kept %d, rate %.17g", item->name, drift < kept_below, drift);
        } else if (item->word == GM_WORD_INVARIANT) {
            printf(
                "%s: the equations on this mesh %s it (its rate along them is %.1e of it, at a random state)\n",
                item->name, drift < kept_below ? "keep" : "change", drift);
        }
    }
}

static void print_mesh(const struct listed_forms *listed)
{
    const struct gm_complex *complex = gm_form_space_of(&listed->problem)->complex;
    printf("\nmesh: %zu vertices, %zu edges, %zu triangles; star %s; Betti numbers %ld %ld %ld\n",
           complex->vertices, complex->edges, complex->triangles,
           gm_system_choices(GM_WORD_STAR)[complex->star], gm_form_betti(complex, 0),
           gm_form_betti(complex, 1), gm_form_betti(complex, 2));
    if (listed->model.field_count > 0) {
        printf("rates: %s\n", gm_ode_of(&listed->problem)->stiff
                                  ? "linear: implicit steps have one Jacobian, which is factorised once"
                                  : "not linear, or of unknowns");
    }
    for (size_t i = 0; i < listed->factor_count; i++) {
        const struct gm_form_factor *factor = &listed->factors[i];
        printf("factor: %s, %s, %zu entries, %.3g MB\n", factor->matrix,
               factor->symmetric ? "Cholesky" : "LU", factor->entries, factor->megabytes);
    }
    tell_drifts(listed, NULL);
}

static void print_forms(const struct listed_forms *listed, bool longer)
{
    const struct gm_user_system *system = listed->model.system;
    const size_t split = listed->model.split;
    struct listed_form form;
    print_texts(listed->report);
    print_parameters(listed->report);
    printf("\nforms\n");
    for (size_t i = 0; listed_form(listed, i, &form); i++) {
        const bool determined = longer && form.equation;
        printf("  %-14s %s%s%s%s\n", form.name, form.type,
               i >= system->n   ? ""
               : !form.equation ? " that evolves"
               : determined     ? " that its equation, "
                                : " that its equation",
               determined ? form.equation : "",
               determined      ? ", determines"
               : form.equation ? " determines"
                               : "");
    }
    for (size_t i = 0; longer && i < system->n && split > 0; i++) {
        printf("%s%s%s",
               i == 0       ? "\nsplits: "
               : i == split ? " | "
                            : " ",
               system->variables[i].name, i + 1 == system->n ? "\n" : "");
    }
    if (longer && listed->problem.parameters) {
        print_mesh(listed);
    }
}

static void put_mesh(struct gm_row *row, const struct listed_forms *listed)
{
    const struct gm_complex *complex = gm_form_space_of(&listed->problem)->complex;
    struct gm_row mesh = gm_row_open(row, "mesh", '}');
    gm_row_put(&mesh, "vertices %i, edges %i, triangles %i, star %s", (int)complex->vertices,
               (int)complex->edges, (int)complex->triangles, gm_system_choices(GM_WORD_STAR)[complex->star]);
    gm_row_list(&mesh, "betti",
                (const double[]){(double)gm_form_betti(complex, 0), (double)gm_form_betti(complex, 1),
                                 (double)gm_form_betti(complex, 2)},
                3);
    struct gm_row list = gm_row_open(row, "factors", ']');
    for (size_t i = 0; i < listed->factor_count; i++) {
        const struct gm_form_factor *factor = &listed->factors[i];
        struct gm_row one = gm_row_open(&list, NULL, '}');
        gm_row_put(&one, "matrix %s, symmetric %d, entries %i, megabytes %.17g", factor->matrix,
                   factor->symmetric, (int)factor->entries, factor->megabytes);
    }
    list = gm_row_open(row, "invariants", ']');
    tell_drifts(listed, &list);
}

static void put_forms(const struct listed_forms *listed, const struct gm_file *file)
{
    const struct gm_user_system *system = listed->model.system;
    struct listed_form form;
    struct gm_row row = gm_row_begin(stdout);
    gm_row_put(&row, "title %s, kind %s, timed %d", gm_system_title(system) ? gm_system_title(system) : "",
               "forms", system->timed);
    put_parameters(&row, system);
    struct gm_row list = gm_row_open(&row, "forms", ']');
    for (size_t i = 0; listed_form(listed, i, &form); i++) {
        struct gm_row one = gm_row_open(&list, NULL, '}');
        gm_row_put(&one, "name %s, line %s, type %s", form.name, form.word, form.type + strlen("a "));
        if (form.equation) {
            gm_row_text(&one, "equation", form.equation + strlen("a "));
        }
    }
    list = gm_row_open(&row, "splits", ']');
    for (size_t i = 0; i < system->n && listed->model.split > 0;) {
        struct gm_row group = gm_row_open(&list, NULL, ']');
        for (const size_t end = i < listed->model.split ? listed->model.split : system->n; i < end; i++) {
            gm_row_text(&group, NULL, system->variables[i].name);
        }
    }
    if (listed->problem.parameters) {
        if (listed->model.field_count > 0) {
            gm_row_put(&row, "linear %d", gm_ode_of(&listed->problem)->stiff);
        }
        put_mesh(&row, listed);
    }
    gm_list_put_file(&row, file, system->source);
    gm_row_close(&row, "\n");
}

/* Lists the type of every form; with --long or --json also how the fields split, the mesh, the factors, and which
   invariants the equations on it keep. */
static int list_forms(const struct gm_options *options, struct report *report, const struct gm_file *file)
{
    struct gm_user_system *system = &report->system;
    struct listed_forms *listed = gm_arena_take(options->arena, 1, sizeof *listed);
    struct gm_fault fault;
    gm_command_end_if(options, options->latex || options->invariants, GM_EXIT_USAGE,
                      "list of a system of forms has neither --latex nor --invariants");
    listed->report = report;
    if (!gm_form_model_open(&listed->model, system, &fault)) {
        return gm_give_up(GM_EXIT_USAGE, "%s", fault.sentence[0] ? fault.sentence : "not enough memory");
    }
    double *values = gm_arena_keep(options->arena, gm_equations_start(system, NULL), free);
    const struct gm_form_choice choice = {(enum gm_star)gm_system_chosen(system, GM_WORD_STAR),
                                          (enum gm_interior)gm_system_chosen(system, GM_WORD_INTERIOR)};
    if ((options->longer || options->json) && !gm_form_reads_mesh(system) &&
        gm_form_problem_open(&listed->problem, &listed->model, choice, values, &fault)) {
        gm_arena_keep(options->arena, listed, close_listed);
        listed->factor_count = gm_form_factors(&listed->problem, listed->factors);
    }
    if (options->json) {
        put_forms(listed, file);
    } else {
        print_forms(listed, options->longer);
    }
    return GM_EXIT_OK;
}

/* Opens the problem and derives what is printed. */
static void open_problem(struct report *report)
{
    const double *start = start_of(report);
    const bool opened = (gm_system_is_field(&report->system) ? open_field : open_equations)(report, start);
    /* a check without memory does not count as unchecked */
    gm_arena_need(report->arena, opened && !gm_memory_was_short());
    tidy_all(report);
}

void gm_list_structure(const struct gm_options *options, const struct gm_file *file)
{
    struct report *report = open_report(options, file);
    if (!gm_system_is_form(&report->system)) {
        open_problem(report);
        print_facts(report);
        put_parts(report, NULL);
    }
}

int gm_list_system(const struct gm_options *options, const struct gm_file *file)
{
    struct report *report = open_report(options, file);
    check_scene(options, !file);
    if (gm_system_is_form(&report->system)) {
        return list_forms(options, report, file);
    }
    if (options->invariants) {
        return list_invariants(options, report);
    }
    open_problem(report);
    list_equations(report, options->latex);
    if (options->json) {
        print_json(report, file);
    } else if (options->latex) {
        print_latex(report);
    } else {
        print_texts(report);
        print_parameters(report);
        print_equations(report);
        print_kept(report);
        if (options->longer) {
            print_facts(report);
            put_parts(report, NULL);
            print_schemes(report);
        }
    }
    gm_arena_need(options->arena,
                  !gm_memory_was_short()); /* nor does a formula without a text count as a long one */
    return GM_EXIT_OK;
}
