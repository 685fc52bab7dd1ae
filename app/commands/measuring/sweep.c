/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint sweep: a run for every combination of values, on all cores, and a table of them. */
#include <string.h>

#include "app/base/interrupt.h"
#include "app/base/pool.h"
#include "app/commands/commands.h"
#include "app/grid/sweep.h"
#include "app/output/say.h"
#include "app/words/drive.h"
#include "core/arena.h"
#include "core/expression/number.h"

/* More runs than these are made if that is confirmed. */
static const double many = 1e6;

static size_t cores_of(const struct gm_options *options)
{
    return options->jobs > 0 ? (size_t)options->jobs : gm_pool_cores();
}

/* Ends the command unless the user agrees to the runs. */
static void confirm(const struct gm_sweep *sweep, const struct gm_options *options)
{
    const size_t runs = gm_sweep_shard_runs(sweep);
    if (options->yes || ((double)runs <= many && gm_sweep_total(sweep, gm_request_steps) <= gm_many_steps)) {
        return;
    }
    char duration[64];
    gm_put_duration(gm_sweep_total(sweep, gm_drive_seconds) / (double)cores_of(options), duration,
                    sizeof duration);
    gm_command_end(options, GM_EXIT_USAGE,
                   "these are %zu run%s, which take about %s with %zu at once; --yes makes them", runs,
                   gm_plural((double)runs), duration, cores_of(options));
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

static bool is_drawn(const struct gm_options *options)
{
    return options->out || options->output;
}

static void check(const struct gm_options *options)
{
    gm_command_end_if(options, options->retry && !is_status(options->retry), GM_EXIT_USAGE,
                      "--retry %.60s is none of: %s", options->retry, gm_sweep_statuses);
    gm_command_end_if(options, options->table && strcmp(options->table, "-") == 0, GM_EXIT_USAGE,
                      "--table - is not a file; without --table the rows go to standard output");
    const bool streamed = gm_options_take_stdout(options);
    const bool named = options->table || (is_drawn(options) && !streamed);
    gm_command_end_if(options, (options->retry || options->pace.shards || streamed) && !named, GM_EXIT_USAGE,
                      "%s needs a table: --table FILE.csv",
                      options->retry         ? "--retry"
                      : options->pace.shards ? "--shard"
                                             : "--output -");
}

/* The table: as given, or beside the picture. */
static const char *path_of(const struct gm_options *options, const struct gm_sweep *sweep)
{
    if (options->table) {
        return options->table;
    }
    if (options->output) {
        const int stem = (int)(strrchr(options->output, '.') - options->output);
        return gm_arena_print(options->arena, "%.*s.csv", stem, options->output);
    }
    return gm_arena_print(options->arena, "%s/%s%s.csv", options->out,
                          options->name ? options->name : sweep->scene->name, options->name ? "" : "-sweep");
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
        gm_complain("%zu of %zu run%s made now, %zu of them not ok", sum->made, gm_sweep_shard_runs(sweep),
                    gm_plural((double)gm_sweep_shard_runs(sweep)), sum->failed);
        gm_complain("wrote %s", path);
    }
}

/* The picture of a table that is complete; its words are those of the sweep. */
static int paint(const struct gm_sweep *sweep, const struct gm_options *options, const char *path)
{
    char message[GM_MESSAGE];
    const struct gm_arguments *words = gm_arguments_of(options->arena, sweep->arguments);
    *options->end = GM_EXIT_FILE;
    struct gm_sweep_chart *chart = gm_sweep_chart_open(options->arena, sweep);
    gm_command_end_if(options, !gm_sweep_chart_read(chart, path, message), GM_EXIT_FILE, "%s", message);
    struct gm_options told = *options;
    told.arguments = *words;
    told.measure = sweep->measure;
    told.values = sweep->values;
    told.place = sweep->at;
    return gm_command_chart(
        &told, "sweep",
        &(struct gm_chart){.name = gm_arena_print(options->arena, "%.80s-sweep", sweep->scene->name),
                           .data = chart,
                           .draw = gm_sweep_chart_draw});
}

static int make(const struct gm_sweep *sweep, const struct gm_options *options, const char *path)
{
    char message[GM_MESSAGE];
    *options->end = GM_EXIT_FILE;
    if (options->pace.shards) {
        gm_sweep_note(sweep, path);
    }
    struct gm_sweep_table *table = gm_sweep_table_open(options->arena, sweep, path, options->retry);
    struct gm_sweep_sum sum;
    gm_catch_interrupts();
    bool filled = gm_sweep_table_fill(table, cores_of(options), NULL, &gm_terminal_listener, &sum, message);
    gm_terminal_listener_clear();
    const int status = sum.unheard ? GM_EXIT_PIPE : GM_EXIT_FILE;
    if (filled) {
        tell(sweep, &sum,
             path ? gm_sweep_shard_path(options->arena, path, sweep->shard, sweep->shards) : NULL);
    } else if (status != GM_EXIT_PIPE) {
        gm_complain("%s", message);
    }
    char unwritten[GM_MESSAGE];
    if (!gm_sweep_table_close(table, unwritten) && filled) {
        gm_complain("%s", unwritten);
        filled = false;
    }
    if (gm_interrupted || !filled) {
        return gm_interrupted ? GM_EXIT_INTERRUPTED : status;
    }
    return is_drawn(options) && !options->pace.shards ? paint(sweep, options, path) : GM_EXIT_OK;
}

static int join(const struct gm_options *options, struct gm_sweep *sweep)
{
    if (options->arguments.count > 0) {
        return gm_give_up(GM_EXIT_USAGE, "--join needs no scene: %s.sweep describes the sweep",
                          options->join);
    }
    *options->end = GM_EXIT_FILE;
    gm_sweep_recall(options->arena, sweep, options->join);
    const size_t missing = gm_sweep_join(sweep, options->join);
    if (missing > 0) {
        return gm_give_up(
            GM_EXIT_FILE, "%s has %zu of %zu row%s; run the incomplete shards again, then join again",
            options->join, sweep->count - missing, sweep->count, gm_plural((double)sweep->count));
    }
    gm_complain("wrote %s", options->join);
    return is_drawn(options) ? paint(sweep, options, options->join) : GM_EXIT_OK;
}

int gm_command_sweep(const struct gm_options *options)
{
    char message[GM_MESSAGE];
    struct gm_sweep *sweep = gm_arena_take(options->arena, 1, sizeof *sweep);
    if (options->join) {
        return join(options, sweep);
    }
    check(options);
    gm_sweep_open(options->arena, sweep, &options->arguments,
                  &(struct gm_sweep_options){options->measure, options->values, options->place},
                  options->end);
    sweep->shard = options->pace.shards ? (size_t)options->pace.shard : 1;
    sweep->shards = options->pace.shards ? (size_t)options->pace.shards : 1;
    const char *path = options->table || is_drawn(options) ? path_of(options, sweep) : NULL;
    gm_command_end_if(options,
                      is_drawn(options) && !options->pace.shards && !gm_sweep_is_drawable(sweep, message),
                      GM_EXIT_USAGE, "%s; --table FILE.csv alone makes none", message);
    confirm(sweep, options);
    return make(sweep, options, path);
}
