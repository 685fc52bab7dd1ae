/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint certify: the claims against what is measured, and against what theory says of the coefficients. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/base/pool.h"
#include "app/commands/commands.h"
#include "app/commands/measuring/certificate.h"
#include "app/commands/measuring/charted.h"
#include "app/grid/certified_lane.h"
#include "app/grid/listener.h"
#include "app/output/folder.h"
#include "app/output/row.h"
#include "app/output/say.h"
#include "app/output/scheme_json.h"
#include "app/words/scheme.h"
#include "core/certify.h"
#include "core/expression/number.h"
#include "core/memory.h"
#include "core/schemes.h"
#include "render/files/temporary.h"

/* As a text or as JSON; `system` is what it was measured on, NULL: the problems that schemes are certified
   on. What - is written to gets nothing else. */
static void show(const struct gm_options *options, const struct gm_certificate *certificate,
                 const char *system)
{
    if (options->json) {
        gm_certificate_put(stdout, certificate, system);
        printf("\n");
    } else if (!gm_options_take_stdout(options)) {
        gm_certificate_print(certificate);
    }
}

/* The diagram, where it is asked for; `status` says what the certificates came to. */
static int chart(const struct gm_options *options, const struct gm_certificate *certificates, size_t count,
                 int status)
{
    if (!options->output && !options->out) {
        return status;
    }
    const struct gm_orders orders = {certificates, count};
    if (!gm_orders_are_known(&orders)) {
        gm_complain("there is no diagram: the order of %s is not measured by a ladder of time steps",
                    certificates[0].scheme->name);
        return GM_EXIT_USAGE;
    }
    /* `again` needs no file of the scheme */
    struct gm_options told = *options;
    const char *const word = certificates[0].scheme->word;
    told.arguments = (struct gm_arguments){0};
    int written = GM_EXIT_MEMORY;
    bool good = gm_arguments_add(&told.arguments, word ? word : options->arguments.words[0]);
    for (int i = 1; good && i < options->arguments.count; i++) {
        good = gm_arguments_add(&told.arguments, options->arguments.words[i]);
    }
    if (good) {
        written = gm_command_chart(&told, "certify", "order", &orders, gm_orders_draw, gm_orders_write);
    }
    gm_arguments_close(&told.arguments);
    return written == GM_EXIT_OK ? status : written;
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
    show(all->options, &all->certificates[slot], NULL);
    all->certified++;
    all->broken += all->certificates[slot].holds ? 0 : 1;
    if (all->certified < all->count) {
        fflush(stdout);
        gm_listener_hears(&gm_terminal_listener, all->schemes[index + 1]->name, all->certified, all->count);
    }
    return true;
}

static bool is_interrupted(void *self)
{
    (void)self;
    return gm_interrupted;
}

/* ---- on one system ---- */

/* The scheme is the first word, the others say more of the system. */
static int certify_on(const struct gm_options *options)
{
    const struct gm_arguments *typed = &options->arguments;
    const char *const *words = (const char *const *)typed->words;
    char message[GM_MESSAGE];
    struct gm_certificate certificate;
    int status = GM_EXIT_USAGE;
    if (gm_certify_words(words[0], options->on, typed->count - 1, words + 1, &certificate, &status,
                         message)) {
        show(options, &certificate, options->on);
        status = chart(options, &certificate, 1, certificate.holds ? GM_EXIT_OK : GM_EXIT_CLAIM);
    } else {
        gm_complain("%s", message);
    }
    return gm_finish(gm_memory_was_short() ? GM_EXIT_MEMORY : status);
}

/* ---- with decimals that satisfy the conditions ---- */

static bool write_text(const char *path, const char *text, char *message)
{
    if (!gm_folder_make_for(path, message)) {
        return false;
    }
    const int error = gm_temporary_write(path, text, strlen(text));
    return error == 0 || gm_refuse(message, "%.300s could not be written: %s", path, strerror(error));
}

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
    const bool written = write_text(out, text, message);
    free(text);
    if (!written) {
        gm_complain("%s", message);
        return GM_EXIT_FILE;
    }
    if (options->json) {
        struct gm_row row = gm_row_begin(stdout);
        gm_row_text(&row, "scheme", name);
        gm_row_text(&row, "polished", out);
        gm_row_count(&row, "order", polish.order);
        gm_row_count(&row, "conditions", (double)polish.conditions);
        gm_row_count(&row, "decimals", (double)polish.decimals);
        gm_row_number(&row, "residual_before", polish.before, 17);
        gm_row_number(&row, "residual", polish.after, 17);
        gm_row_number(&row, "change", polish.change, 17);
        printf("}\n");
    } else {
        printf("%zu condition%s of order %d and of what is claimed: the largest residual was %.1e, is %.1e\n"
               "%zu decimal%s, moved by at most %.1e\n",
               polish.conditions, gm_plural((double)polish.conditions), polish.order, polish.before,
               polish.after, polish.decimals, gm_plural((double)polish.decimals), polish.change);
    }
    gm_complain("wrote %s", out);
    return gm_finish(GM_EXIT_OK);
}

static int command_certify(const struct gm_options *options)
{
    if (options->polish && (options->on || options->output || options->arguments.count != 1)) {
        gm_complain("--polish takes one scheme, a file or a word, and nothing else");
        return GM_EXIT_USAGE;
    }
    if (options->polish) {
        return polish(options);
    }
    if (options->on && options->arguments.count > 0 && strcmp(options->arguments.words[0], "all") == 0) {
        gm_complain("--on measures one scheme: name it");
        return GM_EXIT_USAGE;
    }
    if (options->on && options->arguments.count > 0) {
        return certify_on(options);
    }
    if (options->arguments.count != 1) {
        gm_complain("certify which scheme? A name, or all");
        return GM_EXIT_USAGE;
    }
    const char *name = options->arguments.words[0];
    const bool every = strcmp(name, "all") == 0;
    if (every && (options->output || options->out)) {
        gm_complain("--output and --out are for the diagram of one scheme: name it");
        return GM_EXIT_USAGE;
    }
    char message[GM_MESSAGE] = "";
    int status = GM_EXIT_MEMORY;
    const struct gm_scheme *found = every ? NULL : gm_scheme_sought(name, &status, message);
    if (!every && !found) {
        gm_complain("%s", message);
        return status;
    }
    const size_t most = gm_scheme_count();
    struct certifying all = {.schemes = calloc(most, sizeof *all.schemes),
                             .options = options,
                             .certificates = calloc(most, sizeof *all.certificates),
                             .lost = calloc(most, sizeof *all.lost)};
    status = GM_EXIT_MEMORY;
    if (all.schemes && all.certificates && all.lost) {
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
        if (gm_pool_run(&pool) == all.count) {
            if (!options->json && !gm_options_take_stdout(options)) {
                printf("%zu certified, %zu broken\n", all.certified, all.broken);
            }
            status = chart(options, all.certificates, all.count, all.broken ? GM_EXIT_CLAIM : GM_EXIT_OK);
        } else if (gm_interrupted) {
            gm_terminal_listener_clear();
            status = GM_EXIT_INTERRUPTED;
        }
    }
    free(all.schemes);
    free(all.certificates);
    free(all.lost);
    return gm_finish(status);
}

const struct gm_command_row gm_command_certify = {
    .name = "certify",
    .synopsis = "SCHEME|FILE.scheme|all [--on SYSTEM [KEY=VALUE ...]] [--polish OUT.scheme]",
    .help = "the claims against measurements and theory",
    .bit = GM_CERTIFY,
    .function = command_certify,
};
