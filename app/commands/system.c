/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is known of somebody's own system: its equations as they were derived, its structure with reasons, and the
   schemes that fit it. */
#include "app/commands/system.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands/commands.h"
#include "app/output/json.h"
#include "app/output/wrapped.h"
#include "app/request/drive.h"
#include "app/request/system.h"
#include "core/formula/facts.h"
#include "core/formula/number.h"
#include "core/memory.h"
#include "core/ode/ode.h"
#include "core/schemes.h"

static const char *const kinds[GM_SYSTEM_KINDS] = {"canonical", "lagrangian", "ode", "poisson"};
static const char *const titles[GM_SYSTEM_KINDS] = {"A canonical system", "A Lagrangian system",
                                                    "An ordinary differential equation", "A Poisson system"};

enum { MOST_EQUATIONS = 40 }; /* that are printed; --json has them all */

struct report {
    const struct gm_options *options;
    struct gm_own_system system;
    struct gm_finding findings[GM_FACTS];
    unsigned facets; /* GM_NEEDS_... */
};

/* The facets of the system as a problem. */
static unsigned facets_of(const struct report *report)
{
    const struct gm_own_system *system = &report->system;
    const struct gm_finding *findings = report->findings;
    unsigned facets = 0;
    bool forced = false;
    for (size_t i = 0; i < system->n; i++) {
        forced |= system->variables[i].force != GM_NO_NODE;
    }
    if (system->kind <= GM_LAGRANGIAN && !forced) {
        const bool split = findings[GM_FACT_SEPARABLE].asked && findings[GM_FACT_SEPARABLE].holds;
        facets |= GM_NEEDS_HAMILTONIAN | (split ? GM_NEEDS_SPLIT : GM_NEEDS_INSEPARABLE);
        facets |= split && findings[GM_FACT_NYSTROM].holds ? GM_NEEDS_NYSTROM : 0;
        facets |= system->timed ? 0 : GM_NEEDS_ENERGY;
    }
    facets |= findings[GM_FACT_QUADRATIC].asked && findings[GM_FACT_QUADRATIC].holds ? GM_NEEDS_QUADRATIC : 0;
    facets |= findings[GM_FACT_VOLUME].asked && findings[GM_FACT_VOLUME].holds ? GM_NEEDS_VOLUME : 0;
    return facets;
}

static bool is_constrained(const struct gm_own_system *system)
{
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == GM_WORD_CONSTRAINT) {
            return true;
        }
    }
    return false;
}

static bool fits(const struct report *report, const struct gm_scheme *scheme)
{
    return scheme->family->kind == &gm_kind_ode && (scheme->needs & ~report->facets) == 0 &&
           !is_constrained(&report->system);
}

/* How many operations there are, of a formula that is too long to be read. */
static char *formula_of(const struct report *report, gm_node_id node, bool latex)
{
    const struct gm_naming naming = gm_system_naming(&report->system);
    char *text = latex ? gm_formula_latex(&report->system.graph, node, &naming)
                       : gm_formula_text(&report->system.graph, node, &naming);
    if (!text && !gm_memory_was_short() && asprintf(&text, latex ? "\\ldots" : "(a long formula)") < 0) {
        text = NULL;
    }
    return text;
}

static void print_equation(const struct report *report, const char *left, gm_node_id node)
{
    char *text = formula_of(report, node, false);
    gm_print_wrapped(text ? text : "", printf("  %s = ", left), 6);
    free(text);
}

/* What the rate of component number i is called, and its node; GM_NO_NODE: it has none. */
static gm_node_id equation_of(const struct report *report, size_t i, char *left, size_t size)
{
    const struct gm_own_system *system = &report->system;
    const size_t half = system->n / 2;
    if (system->kind == GM_LAGRANGIAN && i < half) {
        snprintf(left, size, "%.60s", system->variables[half + i].name);
        return system->momenta[i];
    }
    snprintf(left, size, "%.60s'", system->variables[i].name);
    return system->rates[i];
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

/* The name of an invariant; of a momentum map without one its number. */
static void kept_name(const struct gm_own_system *system, const struct gm_system_item *item, char *name,
                      size_t size)
{
    int number = 0;
    for (const struct gm_system_item *other = system->items; other <= item; other++) {
        number += other->word == GM_WORD_SYMMETRY && !other->name[0];
    }
    if (item->name[0]) {
        snprintf(name, size, "%.60s", item->name);
    } else {
        snprintf(name, size, "momentum%d", number);
    }
}

/* Its formula; GM_NO_NODE where a symmetry has no momentum map. */
static gm_node_id kept_node(const struct gm_own_system *system, const struct gm_system_item *item)
{
    return item->word != GM_WORD_SYMMETRY  ? item->nodes[0]
           : system->kind <= GM_LAGRANGIAN ? item->nodes[system->n / 2]
                                           : GM_NO_NODE;
}

static void print_texts(const struct report *report)
{
    const struct gm_own_system *system = &report->system;
    static const enum gm_word order[] = {GM_WORD_TITLE, GM_WORD_ABOUT, GM_WORD_WATCH, GM_WORD_REFERENCE};
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        if (system->texts[order[i]]) {
            gm_print_wrapped(system->texts[order[i]], 0, 0);
        }
    }
    char line[200];
    snprintf(line, sizeof line, "%s of %zu component%s%s", titles[system->kind], system->n,
             system->n == 1 ? "" : "s", system->timed ? " and the time" : "");
    gm_print_wrapped(line, 0, 0);
}

static void print_parameters(const struct report *report)
{
    const struct gm_own_system *system = &report->system;
    double *start = gm_equations_start(system);
    if (system->parameters < system->velocities) {
        printf("\nparameters\n");
    }
    for (size_t i = system->parameters; i < system->velocities; i++) {
        const struct gm_system_variable *row = &system->variables[i];
        char value[64], low[64], high[64], text[512];
        gm_number_format(row->value, value, sizeof value);
        snprintf(text, sizeof text, "%.200s%s%.60s%s%s%s%s%s%s", row->meaning, row->unit[0] ? ", in " : "",
                 row->unit, isnan(row->low) ? "" : " [",
                 isnan(row->low) ? "" : gm_number_format(row->low, low, sizeof low),
                 isnan(row->low) ? "" : " .. ",
                 isnan(row->low) ? "" : gm_number_format(row->high, high, sizeof high),
                 isnan(row->low) ? "" : "]", row->fixed ? " (a whole number that is fixed)" : "");
        gm_print_wrapped(text, printf("  %-14s %-12s ", row->name, value), 30);
    }
    printf("\nstart\n");
    for (size_t i = 0; start && i < system->n && i < MOST_EQUATIONS; i++) {
        printf("  %-14s %.15g%s\n", system->variables[i].name, start[i],
               system->variables[i].angle ? " (an angle)" : "");
    }
    free(start);
}

static void print_equations(const struct report *report)
{
    const struct gm_own_system *system = &report->system;
    printf("\nequations\n");
    if (system->kind != GM_RATES) {
        print_equation(report, system->kind == GM_LAGRANGIAN ? "L" : "H", system->energy);
    }
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == GM_WORD_LET) {
            print_equation(report, system->items[i].name, system->items[i].nodes[0]);
        }
    }
    for (size_t i = 0; i < system->n; i++) {
        char left[80];
        const gm_node_id node = equation_of(report, i, left, sizeof left);
        if (i == MOST_EQUATIONS) {
            printf("  and %zu more\n", system->n - i);
            break;
        }
        print_equation(report, left, node);
    }
}

static void print_kept(const struct report *report)
{
    const struct gm_own_system *system = &report->system;
    bool any = false;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        char name[80];
        if (!is_kept(item)) {
            continue;
        }
        printf("%s", any ? "" : "\ninvariants\n");
        any = true;
        kept_name(system, item, name, sizeof name);
        const gm_node_id node = kept_node(system, item);
        char *text =
                 node == GM_NO_NODE ? strdup("a symmetry of the motion") : formula_of(report, node, false),
             *line = NULL;
        if (asprintf(&line, "%s = %s (%s%s)", name, text ? text : "",
                     item->word == GM_WORD_CASIMIR    ? "a Casimir, "
                     : item->word == GM_WORD_SYMMETRY ? "by symmetry, "
                                                      : "",
                     certainty(item->check)) >= 0) {
            gm_print_wrapped(line, printf("  "), 2);
            free(line);
        }
        free(text);
    }
}

static void print_facts(const struct report *report)
{
    printf("\nstructure\n");
    if (report->system.kind == GM_POISSON) {
        printf("  %-16s yes Jacobi's identity holds (%s)\n", "bracket", certainty(report->system.jacobi));
    }
    for (enum gm_fact fact = 0; fact < GM_FACTS; fact++) {
        const struct gm_finding *finding = &report->findings[fact];
        char *reason = finding->asked ? gm_fact_reason(&report->system, fact, finding) : NULL;
        if (reason) {
            gm_print_wrapped(reason,
                             printf("  %-16s %-4s", gm_fact_word(fact), finding->holds ? "yes" : "no"), 23);
        }
        free(reason);
    }
}

static void print_schemes(const struct report *report)
{
    printf("\nschemes that fit\n");
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    for (size_t i = 0; out && i < gm_scheme_count(); i++) {
        if (fits(report, gm_scheme_at(i))) {
            fprintf(out, "%s ", gm_scheme_at(i)->name);
        }
    }
    if (out && fclose(out) == 0) {
        gm_print_wrapped(is_constrained(&report->system) ? "none: it has constraints" : text, printf("  "),
                         2);
    }
    free(text);
}

static void print_json(const struct report *report)
{
    const struct gm_own_system *system = &report->system;
    const char *comma = "";
    char name[80];
    printf("{");
    gm_json_pair("title", system->texts[GM_WORD_TITLE] ? system->texts[GM_WORD_TITLE] : "");
    printf(",");
    gm_json_pair("kind", kinds[system->kind]);
    printf(",\"timed\":%s,\"parameters\":{", system->timed ? "true" : "false");
    for (size_t i = system->parameters; i < system->velocities; i++, comma = ",") {
        printf("%s", comma);
        gm_json_number_pair(system->variables[i].name, system->variables[i].value);
    }
    double *start = gm_equations_start(system);
    printf("},\"start\":{");
    comma = "";
    for (size_t i = 0; start && i < system->n; i++, comma = ",") {
        printf("%s", comma);
        gm_json_number_pair(system->variables[i].name, start[i]);
    }
    free(start);
    printf("},\"equations\":{");
    comma = "";
    for (size_t i = 0; i < system->n; i++, comma = ",") {
        char *text = formula_of(report, equation_of(report, i, name, sizeof name), false);
        printf("%s", comma);
        gm_json_pair(name, text ? text : "");
        free(text);
    }
    printf("},\"invariants\":{");
    comma = "";
    for (size_t i = 0; i < system->item_count; i++) {
        if (is_kept(&system->items[i])) {
            kept_name(system, &system->items[i], name, sizeof name);
            printf("%s", comma);
            gm_json_pair(name, certainty(system->items[i].check));
            comma = ",";
        }
    }
    printf("},\"structure\":{");
    comma = "";
    for (enum gm_fact fact = 0; fact < GM_FACTS; fact++) {
        const struct gm_finding *finding = &report->findings[fact];
        char *reason = finding->asked ? gm_fact_reason(system, fact, finding) : NULL;
        if (reason) {
            printf("%s\"%s\":{\"holds\":%s,", comma, gm_fact_word(fact), finding->holds ? "true" : "false");
            gm_json_pair("reason", reason);
            printf("}");
            comma = ",";
        }
        free(reason);
    }
    printf("},\"schemes\":[");
    comma = "";
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        if (fits(report, gm_scheme_at(i))) {
            printf("%s\"%s\"", comma, gm_scheme_at(i)->name);
            comma = ",";
        }
    }
    printf("]}\n");
}

static void print_latex(const struct report *report)
{
    const struct gm_own_system *system = &report->system;
    const size_t half = system->n / 2;
    printf("\\begin{align}\n");
    if (system->kind != GM_RATES) {
        char *text = formula_of(report, system->energy, true);
        printf("  %s &= %s \\\\\n", system->kind == GM_LAGRANGIAN ? "L" : "H", text ? text : "");
        free(text);
    }
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == GM_WORD_LET) {
            char *text = formula_of(report, system->items[i].nodes[0], true),
                 *name = gm_name_latex(system->items[i].name);
            printf("  %s &= %s \\\\\n", name ? name : "", text ? text : "");
            free(text);
            free(name);
        }
    }
    for (size_t i = 0; i < system->n; i++) {
        const bool momentum = system->kind == GM_LAGRANGIAN && i < half;
        char *name = gm_name_latex(system->variables[momentum ? half + i : i].name), left[80];
        char *text = formula_of(report, equation_of(report, i, left, sizeof left), true);
        printf(momentum ? "  %s &= %s%s\n" : "  \\dot{%s} &= %s%s\n", name ? name : "", text ? text : "",
               i + 1 < system->n ? " \\\\" : "");
        free(name);
        free(text);
    }
    printf("\\end{align}\n");
}

/* key=value words to values; false with a complaint. */
static bool read_values(const struct gm_options *options, struct gm_system_value *values, size_t *count)
{
    for (int i = 1; i < options->arguments.count; i++) {
        char *word = options->arguments.words[i], *equals = strchr(word, '=');
        double number;
        if (!equals || !gm_number_parse(equals + 1, &number)) {
            gm_complain("list SYSTEM takes parameters with numbers, such as N=3, not \"%.60s\"", word);
            return false;
        }
        *equals = '\0';
        values[(*count)++] = (struct gm_system_value){word, equals + 1};
    }
    return true;
}

/* every value was that of a parameter */
static bool are_known(const struct gm_own_system *system, const struct gm_system_value *values, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        bool known = false;
        for (size_t i = system->parameters; i < system->velocities; i++) {
            known |= strcmp(system->variables[i].name, values[k].name) == 0;
        }
        if (!known) {
            gm_complain("this system has no parameter \"%.60s\"", values[k].name);
            return false;
        }
    }
    return true;
}

int gm_list_system(const struct gm_options *options, const char *path)
{
    struct report report = {.options = options};
    size_t count = 0;
    struct gm_system_value *values = calloc((size_t)options->arguments.count, sizeof *values);
    int status = values && read_values(options, values, &count) ? GM_EXIT_OK : GM_EXIT_USAGE;
    if (status == GM_EXIT_OK) {
        status = gm_system_open(&report.system, path, values, count);
    }
    if (status == GM_EXIT_OK && !are_known(&report.system, values, count)) {
        status = GM_EXIT_USAGE;
    }
    if (status == GM_EXIT_OK && gm_facts_find(&report.system, report.findings)) {
        report.facets = facets_of(&report);
        if (options->json) {
            print_json(&report);
        } else if (options->latex) {
            print_latex(&report);
        } else {
            print_texts(&report);
            print_parameters(&report);
            print_equations(&report);
            print_kept(&report);
            if (options->longer) {
                print_facts(&report);
                print_schemes(&report);
            }
        }
    }
    gm_system_close(&report.system);
    free(values);
    return gm_finish(status);
}
