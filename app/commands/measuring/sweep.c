/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint sweep: a run for every combination of values, on all cores, and a table of them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/interrupt.h"
#include "app/base/pool.h"
#include "app/commands/commands.h"
#include "app/commands/measuring/measuring.h"
#include "app/grid/sweep.h"
#include "app/output/say.h"
#include "app/words/drive.h"
#include "core/basics.h"
#include "core/expression/number.h"
#include "core/memory.h"

/* More runs than these are made if that is confirmed. */
static const double many = 1e6;

static size_t cores_of(const struct gm_options *options)
{
    return options->jobs > 0 ? (size_t)options->jobs : gm_pool_cores();
}

static bool is_confirmed(const struct gm_sweep *sweep, const struct gm_options *options)
{
    const size_t runs = gm_sweep_share(sweep);
    if (options->yes || ((double)runs <= many && gm_sweep_total(sweep, gm_request_steps) <= gm_many_steps)) {
        return true;
    }
    char duration[64];
    gm_put_duration(gm_sweep_total(sweep, gm_drive_seconds) / (double)cores_of(options), duration,
                    sizeof duration);
    gm_complain("these are %zu run%s, which take about %s with %zu at once; --yes makes them", runs,
                gm_plural((double)runs), duration, cores_of(options));
    return false;
}

static bool is_status(const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = gm_sweep_statuses; at; at = strchr(at, ' ')) {
        at += *at == ' ';
        if (strcspn(at, ",") == length && strncmp(at, word, length) == 0) {
            return true;
        }
    }
    return false;
}

/* Whether a picture is asked for. */
static bool is_drawn(const struct gm_options *options)
{
    return options->out || options->output;
}

/* Whether the options go together. */
static bool check(const struct gm_options *options)
{
    if (options->retry && !is_status(options->retry)) {
        gm_complain("--retry %.60s is none of: %s", options->retry, gm_sweep_statuses);
        return false;
    }
    if (options->table && strcmp(options->table, "-") == 0) {
        gm_complain("--table - is no file; without --table the rows go to standard output");
        return false;
    }
    const bool streamed = options->output && strcmp(options->output, "-") == 0;
    const bool named = options->table || (is_drawn(options) && !streamed);
    if ((options->retry || options->shards || streamed) && !named) {
        gm_complain("%s needs a table: --table FILE.csv", options->retry    ? "--retry"
                                                          : options->shards ? "--shard"
                                                                            : "--output -");
        return false;
    }
    return true;
}

/* The table: as given, or beside the picture. malloc'ed; NULL: out of memory. */
static char *path_of(const struct gm_options *options, const struct gm_sweep *sweep)
{
    char *text = NULL;
    if (options->table) {
        return strdup(options->table);
    }
    if (options->output) {
        const int stem = (int)(strrchr(options->output, '.') - options->output);
        return asprintf(&text, "%.*s.csv", stem, options->output) < 0 ? NULL : text;
    }
    if (asprintf(&text, "%s/%s%s.csv", options->out, options->name ? options->name : sweep->scene->name,
                 options->name ? "" : "-sweep") < 0) {
        return NULL;
    }
    return text;
}

static void tell(const struct gm_sweep *sweep, const struct gm_sweep_sum *sum, const char *path)
{
    if (sum->refusal[0]) {
        gm_complain("a run was refused: %s", sum->refusal);
    }
    if (sum->warned > 0) {
        gm_complain("%zu of %zu run%s made now %s ok, but with a warning; the first, run %zu: %s",
                    sum->warned, sum->made, gm_plural((double)sum->made), sum->warned == 1 ? "is" : "are",
                    sum->first_warned, sum->warning);
    }
    if (path) {
        gm_complain("%zu of %zu run%s made now, %zu of them not ok", sum->made, gm_sweep_share(sweep),
                    gm_plural((double)gm_sweep_share(sweep)), sum->failed);
        gm_complain("wrote %s", path);
    }
}

static void draw(const void *chart, struct gm_picture *picture)
{
    gm_sweep_chart_draw(chart, picture);
}

/* The picture of a table that is complete; its words are those of the sweep. */
static int paint(const struct gm_sweep *sweep, const struct gm_options *options, const char *path)
{
    char message[GM_MESSAGE] = "not enough memory", name[128];
    struct gm_options told = *options;
    struct gm_sweep_chart *chart = NULL;
    told.arguments = (struct gm_arguments){0};
    told.measure = sweep->measure;
    int status = GM_EXIT_FILE;
    if (gm_arguments_split(&told.arguments, sweep->arguments) &&
        (chart = gm_sweep_chart_open(sweep, message)) && gm_sweep_chart_read(chart, path, message)) {
        snprintf(name, sizeof name, "%.80s-sweep", sweep->scene->name);
        status = gm_command_chart(&told, "sweep", name, chart, draw, NULL);
    } else {
        gm_complain("%s", message);
    }
    gm_sweep_chart_close(chart);
    gm_arguments_close(&told.arguments);
    return status;
}

static int make(const struct gm_sweep *sweep, const struct gm_options *options, const char *path)
{
    char message[GM_MESSAGE];
    if (options->shards && !gm_sweep_note(sweep, path, message)) {
        return gm_give_up(GM_EXIT_FILE, "%s", message);
    }
    struct gm_sweep_table *table = gm_sweep_table_open(sweep, path, options->retry, message);
    if (!table) {
        return gm_give_up(GM_EXIT_FILE, "%s", message);
    }
    struct gm_sweep_sum sum;
    gm_catch_interrupts();
    bool good = gm_sweep_table_fill(table, cores_of(options), NULL, &gm_terminal_listener, &sum, message);
    gm_terminal_listener_clear();
    const int status = sum.unheard ? GM_EXIT_PIPE : GM_EXIT_FILE;
    if (good) {
        tell(sweep, &sum, gm_sweep_table_path(table));
    } else if (status != GM_EXIT_PIPE) {
        gm_complain("%s", message);
    }
    char unwritten[GM_MESSAGE];
    if (!gm_sweep_table_close(table, unwritten) && good) {
        gm_complain("%s", unwritten);
        good = false;
    }
    if (gm_interrupted || !good) {
        return gm_interrupted ? GM_EXIT_INTERRUPTED : status;
    }
    return is_drawn(options) && !options->shards ? paint(sweep, options, path) : GM_EXIT_OK;
}

static void name_missing(size_t run, const char *words)
{
    gm_complain("run %zu has no row: geomint %s", run, words);
}

static int join(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    struct gm_sweep sweep;
    size_t missing = 0;
    if (options->arguments.count > 0) {
        return gm_give_up(GM_EXIT_USAGE, "--join needs no scene: %s.sweep tells of the sweep", options->join);
    }
    const bool good = gm_sweep_recall(&sweep, options->join, message) &&
                      gm_sweep_join(&sweep, options->join, name_missing, &missing, message);
    if (!good) {
        gm_complain("%s", message);
    } else if (missing > 0) {
        gm_complain("%s has %zu of %zu row%s; give the shares that end early again, and join once more",
                    options->join, sweep.count - missing, sweep.count, gm_plural((double)sweep.count));
    } else {
        gm_complain("wrote %s", options->join);
    }
    int status = good && missing == 0 ? GM_EXIT_OK : GM_EXIT_FILE;
    if (status == GM_EXIT_OK && is_drawn(options)) {
        status = paint(&sweep, options, options->join);
    }
    gm_sweep_close(&sweep);
    return status;
}

int gm_command_sweep(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    struct gm_sweep sweep;
    if (options->join) {
        return gm_finish(join(options));
    }
    if (!check(options)) {
        return GM_EXIT_USAGE;
    }
    int status = GM_EXIT_USAGE;
    if (!gm_sweep_open(&sweep, &options->arguments, options->measure, message)) {
        status = gm_give_up(sweep.unreadable ? GM_EXIT_FILE : GM_EXIT_USAGE, "%s", message);
    } else {
        sweep.shard = options->shards ? (size_t)options->shard : 1;
        sweep.shards = options->shards ? (size_t)options->shards : 1;
        const bool named = options->table || is_drawn(options);
        char *path = named ? path_of(options, &sweep) : NULL;
        if (named && !path) {
            status = gm_give_up(GM_EXIT_MEMORY, "not enough memory");
        } else if (is_drawn(options) && !options->shards && !gm_sweep_is_drawable(&sweep, message)) {
            gm_complain("%s; --table FILE.csv alone makes none", message);
        } else if (is_confirmed(&sweep, options)) {
            status = make(&sweep, options, path);
        }
        free(path);
    }
    gm_sweep_close(&sweep);
    return gm_finish(status);
}
