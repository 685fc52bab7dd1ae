/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint certify: measured order and properties against the claims. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/commands.h"
#include "app/drive.h"
#include "app/nearest.h"
#include "core/certify.h"

static const char *scheme_name(size_t i, const void *data)
{
    return (void)data, gm_scheme_at(i)->name;
}

static void print_json(const struct gm_certificate *certificate)
{
    printf("{\"scheme\":\"%s\",\"order\":%d,\"measured_order\":", certificate->scheme->name,
           certificate->scheme->order);
    if (isfinite(certificate->order)) {
        printf("%.6g", certificate->order);
    } else {
        printf("null");
    }
    printf(",\"holds\":%s,\"properties\":{", certificate->holds ? "true" : "false");
    const char *comma = "";
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_measure *measure = &certificate->claims[bit];
        if (measure->claimed || measure->measured) {
            printf(
                "%s\"%s\":{\"claimed\":%s,\"measured\":%s,\"defect\":%.6g,\"tolerance\":%g,\"problem\":\"%s\"}",
                comma, gm_claim_word(bit), measure->claimed ? "true" : "false",
                measure->measured ? "true" : "false", measure->measured ? measure->defect : 0,
                measure->tolerance, measure->problem);
            comma = ",";
        }
    }
    printf("}}\n");
}

static void print_text(const struct gm_certificate *certificate)
{
    const char *broken = certificate->order_holds ? "" : "  BROKEN";
    if (certificate->scheme->order == 0) {
        printf("%-30s order of its own choice, error ~ tolerance^%.3f (%s)%s\n", certificate->scheme->name,
               certificate->order, certificate->order_problem, broken);
    } else {
        printf("%-30s order %d, measured %.3f (%s)%s\n", certificate->scheme->name,
               certificate->scheme->order, certificate->order, certificate->order_problem, broken);
    }
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_measure *measure = &certificate->claims[bit];
        if (!measure->claimed && !measure->measured) {
            continue;
        }
        const char *verdict = !measure->claimed   ? "not claimed"
                              : measure->holds    ? "holds"
                              : measure->measured ? "BROKEN"
                                                  : "BROKEN: it could not be measured";
        printf("  %s %-28s %-12s", gm_claim_letter(bit), gm_claim_word(bit), verdict);
        if (measure->measured) {
            printf(" defect %.1e (%s)", measure->defect, measure->problem);
        }
        printf("\n");
    }
}

int gm_command_certify(const struct gm_options *options)
{
    if (options->word_count != 1) {
        gm_complain("certify which scheme? A name, or all");
        return GM_EXIT_USAGE;
    }
    const char *name = options->words[0];
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
