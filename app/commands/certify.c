/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint certify: the claims against what is measured, and against what theory says of the coefficients. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/commands/commands.h"
#include "app/commands/reference/theory.h"
#include "app/output/json.h"
#include "app/request/drive.h"
#include "core/certify.h"
#include "core/formula/nearest.h"
#include "core/memory.h"
#include "core/schemes.h"

static const char *scheme_name(size_t i, const void *data)
{
    return (void)data, gm_scheme_at(i)->name;
}

static void print_json(const struct gm_certificate *certificate)
{
    const struct gm_scheme *scheme = certificate->scheme;
    printf("{");
    gm_json_pair("scheme", scheme->name);
    printf(",");
    gm_json_pair("family", scheme->family->title);
    printf(",");
    gm_json_pair("for", gm_scheme_problems(scheme));
    printf(",\"order\":%d,\"measured_order\":", scheme->order);
    gm_json_number(certificate->order);
    printf(",");
    gm_json_pair("order_problem", certificate->order_problem);
    printf(",\"holds\":%s,\"properties\":{", certificate->holds ? "true" : "false");
    const char *comma = "";
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *measure = &certificate->claims[bit];
        if (measure->claimed || measure->measured) {
            printf("%s\"%s\":{\"claimed\":%s,\"measured\":%s,\"defect\":", comma, gm_claim_word(bit),
                   measure->claimed ? "true" : "false", measure->measured ? "true" : "false");
            /* null: it was not measured, or a step of the measurement failed */
            gm_json_number(measure->measured ? measure->defect : NAN);
            printf(",\"tolerance\":%g,", measure->tolerance);
            gm_json_pair("problem", measure->problem);
            printf("}");
            comma = ",";
        }
    }
    printf("},\"theory\":");
    gm_theory_print_json(&certificate->theory);
    printf(",\"measured\":{");
    gm_json_number_pair("order", certificate->order);
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *measure = &certificate->claims[bit];
        if (measure->measured) {
            printf(",");
            gm_json_number_pair(gm_claim_word(bit), measure->defect);
        }
    }
    printf("}}\n");
}

static void print_text(const struct gm_certificate *certificate)
{
    const struct gm_scheme *scheme = certificate->scheme;
    const struct gm_theory *theory = &certificate->theory;
    const char *broken = certificate->order_holds ? "" : "  BROKEN";
    printf("%s (%s, for %s)\n", scheme->name, scheme->family->title, gm_scheme_problems(scheme));
    if (scheme->order == 0) {
        printf("  order of its own choice, error ~ tolerance^%.3f (%s)%s\n", certificate->order,
               certificate->order_problem, broken);
    } else {
        printf("  order %d, measured %.3f (%s)%s\n", scheme->order, certificate->order,
               certificate->order_problem, broken);
    }
    if (theory->known) {
        if (scheme->order > 0 && certificate->order > 1.05 * theory->order) {
            printf("  what is measured above the order by theory is special to that problem\n");
        }
        printf("  by theory%s:\n", certificate->theory_holds ? "" : "  BROKEN");
        gm_theory_print(theory, "    ");
        printf("\n");
    }
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *measure = &certificate->claims[bit];
        if (!measure->claimed && !measure->measured) {
            continue;
        }
        const char *verdict = !measure->claimed   ? "not claimed"
                              : measure->holds    ? "holds"
                              : measure->measured ? "BROKEN"
                                                  : "BROKEN: it could not be measured";
        printf("  %s %-28s %-12s", gm_claim_letter(bit), gm_claim_word(bit), verdict);
        if (measure->measured && isfinite(measure->defect)) {
            printf(" defect %.1e (%s)", measure->defect, measure->problem);
        } else if (measure->measured) {
            printf(" a step failed (%s)", measure->problem);
        }
        printf("\n");
    }
}

static int command_certify(const struct gm_options *options)
{
    if (options->arguments.count != 1) {
        gm_complain("certify which scheme? A name, or all");
        return GM_EXIT_USAGE;
    }
    const char *name = options->arguments.words[0];
    const bool all = strcmp(name, "all") == 0;
    const struct gm_scheme *found = gm_scheme_find(name);
    if (!all && !found) {
        const char *near = gm_nearest(name, gm_scheme_count(), scheme_name, NULL);
        gm_complain("there is no scheme \"%.40s\"%s%s", name,
                    near ? "; did you mean " : "; see geomint list schemes", near ? near : "");
        return GM_EXIT_USAGE;
    }
    size_t certified = 0, broken = 0;
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (!all && strcmp(scheme->name, found->name) != 0) {
            continue;
        }
        const struct gm_certificate certificate = gm_certify(scheme);
        if (gm_memory_was_short()) {
            gm_complain("not enough memory to certify %s", scheme->name);
            return gm_finish(GM_EXIT_MEMORY);
        }
        if (options->json) {
            print_json(&certificate);
        } else {
            print_text(&certificate);
        }
        certified++;
        broken += certificate.holds ? 0 : 1;
    }
    if (!options->json) {
        printf("%zu certified, %zu broken\n", certified, broken);
    }
    return gm_finish(broken ? GM_EXIT_CLAIM : GM_EXIT_OK);
}

const struct gm_command_row gm_command_certify = {
    .name = "certify",
    .synopsis = "SCHEME|all",
    .help = "the claims against measurements and theory",
    .bit = GM_CERTIFY,
    .function = command_certify,
};
