/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What a certificate looks like: a text, and the diagram of its order. */
#include "app/commands/measuring/certificate.h"

#include <math.h>
#include <stdio.h>

#include "app/commands/reference/theory.h"
#include "app/grid/chart.h"
#include "app/output/csv.h"
#include "app/output/scheme_json.h"
#include "core/schemes.h"

void gm_certificate_print(const struct gm_certificate *certificate)
{
    const struct gm_scheme *scheme = certificate->scheme;
    const struct gm_theory *theory = &certificate->theory;
    const char *broken = certificate->order_holds ? "" : "  BROKEN";
    printf("%s (%s, for %s)\n", scheme->name, scheme->family->title, gm_scheme_problems(scheme));
    if (scheme->order == 0) {
        printf("  order of its own choice, error ~ tolerance^%.3f (%s)%s\n", certificate->order,
               certificate->order_problem, broken);
    } else {
        printf("  order %d, measured ", scheme->order);
        if (isnan(certificate->order)) {
            printf("nowhere: %s%s\n",
                   certificate->order_reason ? certificate->order_reason
                                             : "no errors stand clear of round-off",
                   broken);
        } else {
            printf("%.3f (%s)%s%s%s\n", certificate->order, certificate->order_problem,
                   !certificate->order_holds                                       ? "  BROKEN"
                   : theory->known && !(certificate->order > 0.95 * scheme->order) ? "  inconclusive"
                                                                                   : "",
                   certificate->order_reason ? ": " : "",
                   certificate->order_reason ? certificate->order_reason : "");
        }
    }
    if (theory->known) {
        if (scheme->order > 0 && certificate->order > 1.05 * theory->order) {
            printf("  what is measured above the order by theory is special to that problem\n");
        }
        printf("  by theory%s:\n", certificate->theory_holds ? "" : "  BROKEN");
        gm_theory_print(theory, "    ");
        printf("\n");
    } else if (scheme->word) {
        printf(
            "  theory is not asked: the parts are no tableaus, splittings or Nystrom methods of one kind, or they have "
            "more than 256 stages\n");
    }
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *measure = &certificate->claims[bit];
        const char *reason = measure->reason;
        if (!measure->claimed && !measure->measured && !measure->undecided &&
            !(reason && GM_CERTIFIED_ON_SYSTEMS >> bit & 1)) {
            continue;
        }
        const char *verdict = !measure->claimed              ? "not claimed"
                              : measure->holds               ? "holds"
                              : measure->measured            ? "BROKEN"
                              : measure->undecided && reason ? "not decided"
                              : measure->undecided           ? "inconclusive"
                              : reason                       ? "not measured"
                                                             : "BROKEN: it could not be measured";
        printf("  %s %-28s %-12s", gm_claim_letter(bit), gm_claim_word(bit), verdict);
        if (measure->measured && isfinite(measure->defect)) {
            printf(" defect %.1e (%s)", measure->defect, measure->problem);
        } else if (measure->measured) {
            printf(" a step failed (%s)", measure->problem);
        } else if (reason) {
            printf(" %s", reason);
        } else if (measure->undecided) {
            printf(" no step, however short, tells it from round-off (%s)", measure->problem);
        }
        printf("\n");
    }
}

/* ---- the diagram of the order ---- */

bool gm_orders_are_known(const struct gm_orders *orders)
{
    size_t points = 0;
    for (size_t i = 0; i < orders->count; i++) {
        points += orders->certificates[i].ladder.count;
    }
    return points > 0;
}

/* Where the line of the claimed order begins: that part of the largest step's error, where it hides nothing. */
static const double part_below = 0.3;

static void find_axes(const struct gm_orders *orders, struct gm_axis *steps, struct gm_axis *errors)
{
    *steps = (struct gm_axis){.label = "Δt", .scale = GM_LOG, .low = 1, .high = 0};
    *errors = (struct gm_axis){.label = "error", .scale = GM_LOG, .low = 1, .high = 0};
    for (size_t i = 0; i < orders->count; i++) {
        const struct gm_ladder *ladder = &orders->certificates[i].ladder;
        for (size_t k = 0; k < ladder->count; k++) {
            gm_range_add(&steps->low, &steps->high, ladder->dt[k]);
            gm_range_add(&errors->low, &errors->high, ladder->error[k]);
            gm_range_add(&errors->low, &errors->high, part_below * ladder->error[k]);
        }
    }
    steps->low /= 1.2;
    steps->high *= 1.2;
    gm_range_round(&errors->low, &errors->high, GM_LOG);
}

/* The line of the claimed order. */
static void draw_claim(struct gm_picture *picture, struct gm_panel *panel, const struct gm_ladder *ladder,
                       int order)
{
    const size_t last = ladder->count - 1;
    const double below = part_below * ladder->error[0];
    const double points[] = {ladder->dt[0], below, ladder->dt[last],
                             below * pow(ladder->dt[last] / ladder->dt[0], order)};
    const struct gm_style style = {GM_SECONDARY, 1, 1.6, GM_SHORT_DASH};
    gm_mark_line(picture, panel, style, points, 2, false);
    gm_panel_key(picture, panel, style, gm_picture_text(picture, "order %d", order));
}

static void draw_ladder(const struct gm_certificate *certificate, size_t lane, struct gm_picture *picture,
                        struct gm_panel *panel)
{
    const struct gm_ladder *ladder = &certificate->ladder;
    double points[2 * GM_LADDER];
    for (size_t k = 0; k < ladder->count; k++) {
        points[2 * k] = ladder->dt[k];
        points[2 * k + 1] = ladder->error[k];
    }
    gm_chart_line(picture, panel, gm_chart_style(lane), points, ladder->count,
                  isnan(certificate->order)
                      ? gm_picture_text(picture, "measured on %s", certificate->order_problem)
                      : gm_picture_text(picture, "measured %.2f on %s", certificate->order,
                                        certificate->order_problem));
}

void gm_orders_draw(const void *data, struct gm_picture *picture)
{
    const struct gm_orders *orders = data;
    const struct gm_certificate *first = &orders->certificates[0];
    const struct gm_theory *theory = &first->theory;
    struct gm_axis steps, errors;
    find_axes(orders, &steps, &errors);
    picture->title = gm_picture_text(picture, "%s: the order", first->scheme->title);
    picture->subtitle = !theory->known
                            ? "error against the time step"
                            : gm_picture_text(picture, "error against the time step; by theory %s%d",
                                              theory->at_least ? "at least " : "", theory->order);
    picture->clock = "";
    struct gm_panel *panel = gm_chart_panel(picture, GM_PLACE_GRAPH, "", &steps, &errors);
    for (size_t i = 0; i < orders->count; i++) {
        const struct gm_certificate *certificate = &orders->certificates[i];
        if (certificate->ladder.count > 0) {
            draw_claim(picture, panel, &certificate->ladder, certificate->scheme->order);
            draw_ladder(certificate, i, picture, panel);
        }
    }
}

bool gm_orders_write(const void *data, const char *path)
{
    const struct gm_orders *orders = data;
    FILE *file = fopen(path, "w");
    if (!file) {
        return false;
    }
    fprintf(file, "scheme,for,problem,order,dt,error\n");
    for (size_t i = 0; i < orders->count; i++) {
        const struct gm_certificate *certificate = &orders->certificates[i];
        for (size_t k = 0; k < certificate->ladder.count; k++) {
            gm_csv_put_text(file, certificate->scheme->name);
            fputc(',', file);
            gm_csv_put_text(file, gm_scheme_problems(certificate->scheme));
            fputc(',', file);
            gm_csv_put_text(file, certificate->order_problem);
            fprintf(file, ",%d,%.17g,%.17g\n", certificate->scheme->order, certificate->ladder.dt[k],
                    certificate->ladder.error[k]);
        }
    }
    const bool good = !ferror(file);
    return fclose(file) == 0 && good;
}
