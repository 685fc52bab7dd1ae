/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint certify: the claims against measurements, and against the theory of the coefficients. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/base/pool.h"
#include "app/commands/commands.h"
#include "app/commands/reference/reference.h"
#include "app/grid/grid.h"
#include "app/grid/sweep.h"
#include "app/output/folder.h"
#include "app/output/row.h"
#include "app/output/say.h"
#include "app/output/scheme_json.h"
#include "app/words/names.h"
#include "core/arena.h"
#include "core/expression/number.h"
#include "core/memory.h"
#include "core/ode/ode.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "render/files/temporary.h"
#include "render/picture/picture.h"

/* ---- the display of a certificate ---- */

static void print_given_up(const struct gm_certificate *certificate)
{
    const struct gm_scheme *scheme = certificate->scheme;
    const unsigned lost = gm_certificate_given_up(certificate);
    char text[512];
    if (lost) {
        printf("  given up: %s (of %s)\n", gm_catalogue_claims(lost, false, text, sizeof text),
               scheme->base->name);
    }
}

static void print_certificate(const struct gm_certificate *certificate)
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
                   certificate->order_reason ? certificate->order_reason : "no errors exceed round-off",
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
            if (fabs(theory->residual) < 1e-4) {
                printf(
                    "  the condition that fails by theory is missed by %.1e: too little to be seen in these "
                    "steps\n",
                    fabs(theory->residual));
            } else {
                printf("  what is measured above the order by theory is special to that problem\n");
            }
        }
        printf("  by theory%s:\n", certificate->theory_holds ? "" : "  BROKEN");
        gm_theory_print(theory, "    ");
        printf("\n");
    } else if (scheme->word) {
        printf("  theory does not apply: %s\n",
               scheme->base ? "the way back to an invariant has no coefficients"
               : scheme->needs & GM_NEEDS_PARTS
                   ? "it splits into parts with names, and not into T and V"
                   : "a part has no coefficients, or they have more than 256 stages");
    }
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *measure = &certificate->claims[bit];
        const char *reason = measure->reason;
        const bool refuted = certificate->refuted >> bit & 1;
        if (!measure->claimed && !measure->measured && !measure->undecided &&
            !(reason && GM_CERTIFIED_ON_SYSTEMS >> bit & 1)) {
            continue;
        }
        const char *verdict = !measure->claimed              ? "not claimed"
                              : measure->holds               ? "holds"
                              : measure->measured || refuted ? "BROKEN"
                              : measure->undecided && reason ? "not decided"
                              : measure->undecided           ? "inconclusive"
                              : reason                       ? "not measured"
                                                             : "BROKEN: it could not be measured";
        printf("  %s %-30s %-12s", gm_claims[bit].letter, gm_claims[bit].word, verdict);
        if (measure->measured && isfinite(measure->defect)) {
            printf(" defect %.1e (%s)", measure->defect, measure->problem);
        } else if (measure->measured) {
            printf(" a step failed (%s)", measure->problem);
        } else if (reason) {
            printf(" %s", reason);
        } else if (measure->undecided) {
            printf(certificate->ladder.fails ? " the run fails before its end (%s)"
                                             : " no step, however short, separates it from round-off (%s)",
                   measure->problem);
        }
        printf("%s\n", refuted ? "; refuted by theory" : "");
    }
    for (size_t i = 0; i < certificate->held_count; i++) {
        const struct gm_held_verdict *held = &certificate->held[i];
        const struct gm_verdict *measure = &held->verdict;
        printf("  conserves %-22s %-12s", held->name,
               !measure->measured ? "not measured"
               : measure->holds   ? "holds"
                                  : "BROKEN");
        if (measure->measured && isfinite(measure->defect)) {
            printf(" defect %.1e (%s)", measure->defect, measure->problem);
        }
        printf("\n");
    }
    print_given_up(certificate);
    for (size_t i = 0; i < certificate->followed_count; i++) {
        const struct gm_followed *followed = &certificate->followed[i];
        printf("  in 4000 steps %-30s %-12s change %.1e", followed->name, followed->verdict,
               followed->defect);
        if (followed->status != GM_OK) {
            printf(" in %" PRId64 " steps, then %s", followed->steps, gm_status_name(followed->status));
        }
        putchar('\n');
    }
    const struct gm_sameness *same = &certificate->same;
    if (same->other) {
        const char *refuted = same->undecided ? "not decided" : "BROKEN";
        printf("  the same steps as %s: %s, largest difference %.1e (%s)\n", same->other->name,
               same->holds ? "holds" : refuted, same->difference, same->problem);
    }
}

/* ---- the diagram of the order ---- */

/* Errors against dt, with lines of the claimed order; each row of a shared name has its line. */
struct orders {
    const struct gm_certificate *certificates;
    size_t count;
};

static bool are_known(const struct orders *orders)
{
    size_t points = 0;
    for (size_t i = 0; i < orders->count; i++) {
        points += orders->certificates[i].ladder.count;
    }
    return points > 0;
}

/* The start of the claimed order's line, as a part of the error at the largest step; it hides no points. */
static const double part_below = 0.3;

static void find_axes(const struct orders *orders, struct gm_axis *steps, struct gm_axis *errors)
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

static void draw_orders(const void *data, struct gm_picture *picture)
{
    const struct orders *orders = data;
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

static bool write_orders(const void *data, FILE *csv)
{
    const struct orders *orders = data;
    fprintf(csv, "scheme,for,problem,order,dt,error\n");
    for (size_t i = 0; i < orders->count; i++) {
        const struct gm_certificate *certificate = &orders->certificates[i];
        for (size_t k = 0; k < certificate->ladder.count; k++) {
            struct gm_row row = {.stream = csv, .form = GM_ROW_CSV};
            gm_row_put(&row, "scheme %s, for %s, problem %s, order %i, dt %.17g, error %.17g",
                       certificate->scheme->name, gm_scheme_problems(certificate->scheme),
                       certificate->order_problem, certificate->scheme->order, certificate->ladder.dt[k],
                       certificate->ladder.error[k]);
            fputc('\n', csv);
        }
    }
    return true;
}

/* ---- the command ---- */

/* Prints text or JSON. `system`: the system of the measurement; NULL: the problems for certificates. A
   stream that an output option claims with - gets nothing else. */
static void show(const struct gm_options *options, const struct gm_certificate *certificate,
                 const char *system)
{
    if (options->json) {
        gm_certificate_put(stdout, certificate, system);
        printf("\n");
    } else if (!gm_options_take_stdout(options)) {
        print_certificate(certificate);
    }
}

/* Writes the diagram if it was requested; `status`: the verdict of the certificates. */
static int chart(const struct gm_options *options, const struct gm_certificate *certificates, size_t count,
                 int status)
{
    if (!options->output && !options->out) {
        return status;
    }
    const struct orders orders = {certificates, count};
    if (!are_known(&orders)) {
        return gm_give_up(GM_EXIT_USAGE,
                          "there is no diagram: the order of %s is not measured by a ladder of time steps",
                          certificates[0].scheme->name);
    }
    /* `again` needs no file of the scheme */
    struct gm_options told = *options;
    const char *const word = certificates[0].scheme->word;
    struct gm_arguments *words = gm_arguments_in(options->arena);
    gm_arguments_add(words, word ? word : options->arguments.words[0]);
    gm_arena_need(options->arena,
                  gm_arguments_append(words, options->arguments.words + 1, options->arguments.count - 1));
    told.arguments = *words;
    const int written = gm_command_chart(
        &told, "certify",
        &(struct gm_chart){.name = "order", .data = &orders, .draw = draw_orders, .write = write_orders});
    return written == GM_EXIT_OK ? status : written;
}

/* The schemes to certify, and their results. */
struct certifying {
    const struct gm_scheme **schemes;
    const struct gm_options *options;
    struct gm_certificate *certificates; /* a place for each scheme, as there are few */
    bool *lost;                          /* true if memory was short */
    size_t count, told, empty, broken;
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
    show(all->options, &all->certificates[slot], NULL);
    all->told++;
    const struct gm_certificate *certificate = &all->certificates[slot];
    all->empty += all->schemes[index]->word && (!certificate->order_problem[0] || certificate->ladder.fails);
    all->broken += all->certificates[slot].holds ? 0 : 1;
    if (all->told < all->count) {
        fflush(stdout);
        gm_listener_hears(&gm_terminal_listener, all->schemes[index + 1]->name, all->told, all->count);
    }
    return true;
}

static bool is_interrupted(void *self)
{
    (void)self;
    return gm_interrupted;
}

/* ---- with decimals that satisfy the conditions ---- */

static int polish(const struct gm_options *options)
{
    const char *name = options->arguments.words[0], *out = options->polish;
    char message[GM_MESSAGE] = "";
    struct gm_polish polish;
    bool unreadable = false;
    char *text = gm_scheme_polished(name, &polish, &unreadable, message);
    if (!text) {
        gm_complain("%s", message);
        return gm_memory_was_short() ? GM_EXIT_MEMORY : unreadable ? GM_EXIT_FILE : GM_EXIT_USAGE;
    }
    gm_arena_keep(options->arena, text, free);
    gm_command_end_if(options, !gm_folder_make_for(out, message), GM_EXIT_FILE, "%s", message);
    const int error = gm_temporary_write(out, text, strlen(text));
    gm_command_end_if(options, error != 0, GM_EXIT_FILE, "%.300s could not be written: %s", out,
                      strerror(error));
    if (options->json) {
        struct gm_row row = gm_row_begin(stdout);
        gm_row_put(
            &row,
            "scheme %s, polished %s, order %i, conditions %.0f, decimals %.0f, residual_before %.17g, residual %.17g, change %.17g",
            name, out, polish.order, (double)polish.conditions, (double)polish.decimals, polish.before,
            polish.after, polish.change);
        gm_row_close(&row, "\n");
    } else {
        printf("%zu condition%s of order %d and of what is claimed: the largest residual was %.1e, is %.1e\n"
               "%zu decimal%s, moved by at most %.1e\n",
               polish.conditions, gm_plural((double)polish.conditions), polish.order, polish.before,
               polish.after, polish.decimals, gm_plural((double)polish.decimals), polish.change);
    }
    gm_complain("wrote %s", out);
    return GM_EXIT_OK;
}

int gm_command_certify(const struct gm_options *options)
{
    gm_command_end_if(options,
                      options->polish && (options->on || options->output || options->arguments.count != 1),
                      GM_EXIT_USAGE, "--polish takes one scheme, a file or a word, and nothing else");
    if (options->polish) {
        return polish(options);
    }
    gm_command_end_if(options,
                      options->on && options->arguments.count > 0 &&
                          strcmp(options->arguments.words[0], "all") == 0,
                      GM_EXIT_USAGE, "--on measures one scheme: name it");
    if (options->on && options->arguments.count > 0) { /* the other words describe the system */
        const struct gm_certificate certificate =
            gm_certify_words(options->arena, options->on, &options->arguments, options->end);
        show(options, &certificate, options->on);
        return chart(options, &certificate, 1, certificate.holds ? GM_EXIT_OK : GM_EXIT_CLAIM);
    }
    gm_command_end_if(options, options->arguments.count != 1, GM_EXIT_USAGE,
                      "certify which scheme? A name, or all");
    const char *name = options->arguments.words[0];
    const bool every = strcmp(name, "all") == 0;
    gm_command_end_if(options, every && (options->output || options->out), GM_EXIT_USAGE,
                      "--output and --out are for the diagram of one scheme: name it");
    char message[GM_MESSAGE] = "";
    int status = GM_EXIT_MEMORY;
    const struct gm_scheme *found = every ? NULL : gm_scheme_sought(name, &status, message);
    gm_command_end_if(options, !every && !found, status, "%s", message);
    const size_t most = gm_scheme_count();
    struct certifying all = {.schemes = gm_arena_take(options->arena, most, sizeof *all.schemes),
                             .options = options,
                             .certificates = gm_arena_take(options->arena, most, sizeof *all.certificates),
                             .lost = gm_arena_take(options->arena, most, sizeof *all.lost)};
    if (found && found->word) {
        all.schemes[all.count++] = found;
    }
    for (size_t i = 0; i < most; i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (every || strcmp(scheme->name, found->name) == 0) {
            all.schemes[all.count++] = scheme;
        }
    }
    const struct gm_pool pool = {.count = all.count,
                                 .window = most,
                                 .work = certify,
                                 .take = tell,
                                 .stopped = is_interrupted,
                                 .self = &all};
    gm_catch_interrupts();
    gm_listener_hears(&gm_terminal_listener, all.schemes[0]->name, 0, all.count);
    status = GM_EXIT_MEMORY;
    if (gm_pool_run(&pool) == all.count) {
        if (!options->json && !gm_options_take_stdout(options)) {
            printf("%zu certified, %zu broken%s\n", all.told - all.empty, all.broken,
                   all.empty ? ": nothing was measured; name a system that the scheme fits, --on SYSTEM"
                             : "");
        }
        status = chart(options, all.certificates, all.count, all.broken ? GM_EXIT_CLAIM : GM_EXIT_OK);
    } else if (gm_interrupted) {
        gm_terminal_listener_clear();
        status = GM_EXIT_INTERRUPTED;
    }
    return status;
}
