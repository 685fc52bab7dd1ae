/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint certify: the claims against what is measured, and against what theory says of the coefficients. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/commands/commands.h"
#include "app/commands/reference/theory.h"
#include "app/cores/pool.h"
#include "app/output/json.h"
#include "app/request/drive.h"
#include "app/request/nearest.h"
#include "app/studies/listener.h"
#include "core/certify.h"
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

/* The schemes that are certified, and what came of them. */
struct certifying {
    const struct gm_scheme **schemes;
    const struct gm_options *options;
    struct gm_certificate *certificates; /* a place for each scheme, as there are few */
    bool *lost;                          /* for want of memory */
    size_t count, certified, broken;
};

static void certify(void *self, size_t index, size_t slot)
{
    struct certifying *all = self;
    const unsigned long refusals = gm_memory_refusals();
    all->certificates[slot] = gm_certify(all->schemes[index]);
    all->lost[slot] = gm_memory_refusals() != refusals;
}

static bool tell(void *self, size_t index, size_t slot)
{
    struct certifying *all = self;
    gm_terminal_listener_clear();
    if (all->lost[slot]) {
        gm_complain("not enough memory to certify %s", all->schemes[index]->name);
        return false;
    }
    if (all->options->json) {
        print_json(&all->certificates[slot]);
    } else {
        print_text(&all->certificates[slot]);
    }
    all->certified++;
    all->broken += all->certificates[slot].holds ? 0 : 1;
    if (all->certified < all->count) {
        fflush(stdout);
        gm_listener_hears(&gm_terminal_listener, all->schemes[index + 1]->name, all->certified, all->count);
    }
    return true;
}

static int command_certify(const struct gm_options *options)
{
    if (options->arguments.count != 1) {
        gm_complain("certify which scheme? A name, or all");
        return GM_EXIT_USAGE;
    }
    const char *name = options->arguments.words[0];
    const bool every = strcmp(name, "all") == 0;
    const struct gm_scheme *found = gm_scheme_find(name);
    if (!every && !found) {
        const char *near = gm_nearest(name, gm_scheme_count(), scheme_name, NULL);
        gm_complain("there is no scheme \"%.40s\"%s%s", name,
                    near ? "; did you mean " : "; see geomint list schemes", near ? near : "");
        return GM_EXIT_USAGE;
    }
    const size_t most = gm_scheme_count();
    struct certifying all = {.schemes = calloc(most, sizeof *all.schemes),
                             .options = options,
                             .certificates = calloc(most, sizeof *all.certificates),
                             .lost = calloc(most, sizeof *all.lost)};
    int status = GM_EXIT_MEMORY;
    if (all.schemes && all.certificates && all.lost) {
        for (size_t i = 0; i < most; i++) {
            const struct gm_scheme *scheme = gm_scheme_at(i);
            if (every || strcmp(scheme->name, found->name) == 0) {
                all.schemes[all.count++] = scheme;
            }
        }
        const struct gm_pool pool = {
            .count = all.count, .window = most, .work = certify, .take = tell, .self = &all};
        gm_listener_hears(&gm_terminal_listener, all.schemes[0]->name, 0, all.count);
        if (gm_pool_run(&pool) == all.count) {
            if (!options->json) {
                printf("%zu certified, %zu broken\n", all.certified, all.broken);
            }
            status = all.broken ? GM_EXIT_CLAIM : GM_EXIT_OK;
        }
    }
    free(all.schemes);
    free(all.certificates);
    free(all.lost);
    return gm_finish(status);
}

const struct gm_command_row gm_command_certify = {
    .name = "certify",
    .synopsis = "SCHEME|all",
    .help = "the claims against measurements and theory",
    .bit = GM_CERTIFY,
    .function = command_certify,
};
