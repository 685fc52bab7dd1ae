/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The tables in words, for `list`, the manual, the pages and completion; and the generated docs/schemes.md
   and docs/scenes.md. */
#include "app/commands/reference/reference.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/words/names.h"
#include "core/aliases.h"
#include "core/expression/number.h"
#include "core/schemes.h"
#include "core/theory/certify.h"

char *gm_catalogue_range(const struct gm_parameter *row, char *text, size_t size)
{
    char low[40], high[40];
    if (row->type == GM_CHOICE || (row->type == GM_TEXT && row->choices)) {
        return gm_parameter_choices(row, text, size);
    }
    if (row->type == GM_TEXT || row->type == GM_BOOLEAN) {
        snprintf(text, size, "%s", row->type == GM_TEXT ? "a word" : "no, yes");
    } else {
        snprintf(text, size, "%s to %s", gm_number_format(row->lowest, low, sizeof low),
                 gm_number_format(row->highest, high, sizeof high));
    }
    return text;
}

void gm_catalogue_letters(const struct gm_scheme *scheme, char *letters)
{
    size_t used = 0;
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (scheme->claims >> bit & 1) {
            letters[used++] = gm_claims[bit].letter[0];
        }
    }
    letters[used] = '\0';
}

char *gm_catalogue_claims(unsigned claims, bool letters, char *text, size_t size)
{
    const char *between = "";
    snprintf(text, size, claims ? "" : "none");
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (claims >> bit & 1) {
            gm_append(text, size, "%s%s%s%s", between, letters ? gm_claims[bit].letter : "",
                      letters ? " " : "", gm_claims[bit].word);
            between = ", ";
        }
    }
    return text;
}

/* ---- theory, for certificates and for the documentation of the schemes ---- */

static void print_order(const struct gm_theory *theory)
{
    printf("order %d%s", theory->order, theory->at_least ? " at least" : "");
    if (theory->digits > 0) {
        printf(", to the %d digit%s written", theory->digits, gm_plural(theory->digits));
    }
    printf(": %d condition%s", theory->conditions, theory->conditions == 1 ? " holds" : "s hold");
    if (theory->failing > 0) {
        printf("; of order %d, %d of %d fail, most that of %s, by %.1e; error constant %.3g",
               theory->order + 1, theory->failing, theory->of, theory->condition, fabs(theory->residual),
               theory->error_constant);
    } else if (theory->at_most == theory->order) {
        printf("; by B, C and D no further one is asked for; %s fails, by %.1e", theory->condition,
               fabs(theory->residual));
    }
}

static void print_structure(const struct gm_theory *theory)
{
    if (theory->symplectic) {
        printf("symplectic");
    } else if (theory->pseudo_symplectic > theory->order) {
        printf("symplectic up to dt^%d", theory->pseudo_symplectic);
    } else {
        printf("not symplectic");
    }
    printf(", %ssymmetric", theory->symmetric ? "" : "not ");
    if (theory->b > 0) {
        printf("; B(%d), C(%d), D(%d)", theory->b, theory->c, theory->d);
    }
}

static void print_stability(const struct gm_theory_stability *stability)
{
    if (stability->oscillator && isinf(stability->imaginary)) {
        printf("stable on every oscillator");
    } else if (stability->oscillator) {
        printf("stable on the oscillator up to ω dt = %.6g", stability->imaginary);
    } else if (stability->a_stable) {
        printf("%s", stability->l_stable ? "A-stable and L-stable" : "A-stable, not L-stable");
    } else {
        const double bounds[] = {stability->real, stability->imaginary};
        static const char *const axes[] = {"negative", "imaginary"};
        for (int i = 0; i < 2; i++) {
            printf("%s", i == 0 ? "stable on the " : ", on the ");
            if (bounds[i] == 0) {
                printf("%s axis nowhere", axes[i]);
            } else if (isinf(bounds[i])) {
                printf("whole %s axis", axes[i]);
            } else {
                printf("%s axis up to %.6g", axes[i], bounds[i]);
            }
        }
    }
}

void gm_theory_print(const struct gm_theory *theory, const char *indent)
{
    if (!theory->known) {
        return;
    }
    printf("%s", indent);
    print_order(theory);
    printf(";\n%s", indent);
    print_structure(theory);
    if (theory->stability.known) {
        printf(";\n%s", indent);
        print_stability(&theory->stability);
    }
}

/* ---- the pages of the documentation ---- */

/* A cell of a table: a bar would end it. */
static void put_cell(const char *text)
{
    for (; *text; text++) {
        if (*text == '|') {
            putchar('\\');
        }
        putchar(*text);
    }
}

static void put_meaning(const char *help, const char *unit)
{
    put_cell(help);
    fputs(unit[0] ? ", in " : "", stdout);
    put_cell(unit);
}

/* fits[scene * scheme_count + scheme] */
static void put_scheme(size_t index, const bool *fits)
{
    const struct gm_scheme *scheme = gm_scheme_at(index);
    printf("### %s: `%s`\n\n", scheme->title, scheme->name);
    const char *alias;
    for (size_t i = 0; (alias = gm_alias_of(scheme->name, i)); i++) {
        printf("%s`%s`", i == 0 ? "Also called " : ", ", alias);
    }
    printf("%s", gm_alias_of(scheme->name, 0) ? ". " : "");
    if (scheme->order > 0) {
        printf("Order %d. ", scheme->order);
    }
    char claims[512];
    printf("Claims: %s.\n\n```text\n%s\n```\n\n%s.\n\n",
           gm_catalogue_claims(scheme->claims, false, claims, sizeof claims), scheme->formula,
           scheme->reference);
    const struct gm_theory theory = gm_scheme_theory(scheme);
    if (theory.known) {
        printf("By theory of ");
        gm_theory_print(&theory, "");
        printf(".\n\n");
    }
    const char *comma = "Fits ";
    for (size_t s = 0; s < gm_scene_count(); s++) {
        if (fits[s * gm_scheme_count() + index]) {
            printf("%s[%s](scenes.md#%s)", comma, gm_scene_at(s)->name, gm_scene_at(s)->name);
            comma = ", ";
        }
    }
    printf("%s", strcmp(comma, ", ") == 0 ? ".\n\n" : "Fits no scene at its defaults.\n\n");
}

static bool *make_fits(void)
{
    const struct gm_scheme *fitting[GM_FITTING_SCHEMES];
    bool *fits = calloc(gm_scene_count() * gm_scheme_count(), sizeof *fits);
    for (size_t s = 0; fits && s < gm_scene_count(); s++) {
        const size_t count = gm_fitting_schemes(gm_scene_at(s), fitting);
        for (size_t i = 0; i < gm_scheme_count(); i++) {
            for (size_t k = 0; k < count; k++) {
                fits[s * gm_scheme_count() + i] |= fitting[k] == gm_scheme_at(i);
            }
        }
    }
    return fits;
}

void gm_catalogue_schemes_markdown(void)
{
    bool *fits = make_fits();
    if (!fits) {
        return;
    }
    printf("# Schemes\n\nWritten by `geomint list schemes --markdown`. What a scheme claims is measured by "
           "`geomint certify NAME`; a number at the end of a name is the order.\n\n");
    const struct gm_family *family = NULL;
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        if (gm_scheme_at(i)->family != family) {
            family = gm_scheme_at(i)->family;
            printf("## %s\n\n", family->title);
        }
        put_scheme(i, fits);
    }
    free(fits);
}

static void put_parameter(const struct gm_parameter *row)
{
    char range[256];
    printf("| `%s` | ", row->key);
    put_cell(row->standard);
    printf(" | ");
    put_cell(gm_catalogue_range(row, range, sizeof range));
    printf(" | ");
    put_meaning(row->help, row->unit);
    printf("%s |\n", row->live ? "; live" : "");
}

static void put_scene(const struct gm_scene *scene)
{
    const struct gm_scheme *fitting[GM_FITTING_SCHEMES];
    const size_t count = gm_fitting_schemes(scene, fitting);
    printf("## %s\n\n**%s.** %s %s The unit of time is %s.\n\n", scene->name, scene->title, scene->blurb,
           scene->watch, scene->time);
    printf("| parameter | default | range | meaning |\n|---|---|---|---|\n");
    for (size_t i = 0; i < scene->parameter_count; i++) {
        if (gm_row_is_offered(&scene->parameters[i])) {
            put_parameter(&scene->parameters[i]);
        }
    }
    printf("\n| observable | meaning |\n|---|---|\n");
    const struct gm_observable *observable;
    for (size_t i = 0; (observable = gm_scene_observable_at(scene, i)) != NULL; i++) {
        printf("| `%s` | ", observable->key);
        char title[GM_MESSAGE];
        put_meaning(gm_observable_title(observable, title, sizeof title), observable->unit);
        fputs(i < scene->observable_count ? "" : "; when asked for", stdout);
        printf(" |\n");
    }
    printf("\nSchemes at the defaults:");
    for (size_t i = 0; i < count; i++) {
        printf("%s `%s`", i ? "," : "", fitting[i]->name);
    }
    printf(".\n\n");
    for (size_t i = 0; i < scene->figure_count; i++) {
        printf("%s`%s`", i ? ", " : "Published figures: ", scene->figures[i].name);
    }
    printf("%s", scene->figure_count ? ".\n\n" : "");
}

void gm_catalogue_scenes_markdown(void)
{
    printf(
        "# Scenes\n\nWritten by `geomint list scenes --markdown`. A live parameter acts on the current state when "
        "it is changed in the explorer; a change of any other starts the run again.\n\n");
    for (size_t i = 0; i < gm_scene_count(); i++) {
        put_scene(gm_scene_at(i));
    }
    printf(
        "## Parameters that schemes bring\n\n| parameter | default | range | meaning |\n|---|---|---|---|\n");
    for (size_t i = 0; i < gm_settings_parameter_count; i++) {
        put_parameter(&gm_settings_parameters[i]);
    }
}
