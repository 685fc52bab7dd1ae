/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shards of a sweep: a note beside them has the sweep's words, and their rows become one table. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/grid/sweep.h"
#include "app/output/folder.h"
#include "app/output/row.h"
#include "app/output/say.h"
#include "core/arena.h"
#include "core/basics.h"
#include "render/files/regular_file.h"
#include "render/files/temporary.h"

enum { LONGEST_NOTE = 1 << 20 };

void gm_sweep_note(const struct gm_sweep *sweep, const char *path)
{
    size_t size;
    char reason[GM_REGULAR_REASON], message[GM_MESSAGE];
    const char *note = gm_arena_print(sweep->arena, "%s.sweep", path);
    /* the words as gm_arguments_split reads them */
    const char *text = gm_arena_print(
        sweep->arena, "geomint: 1\nsweep: %s\nmeasure: %s\nshares: %zu\n%s%s%s%s%s", sweep->arguments,
        sweep->measure ? sweep->measure : "", sweep->shards, sweep->values ? "values: " : "",
        sweep->values ? sweep->values : "", sweep->values ? "\nat: " : "", sweep->values ? sweep->at : "",
        sweep->values ? "\n" : "");
    gm_arena_check(sweep->arena, gm_folder_make_for(path, message), message);
    if (access(note, F_OK) != 0) {
        const int error = gm_temporary_write(note, text, strlen(text));
        gm_arena_refuse_if(sweep->arena, error != 0, "%.360s could not be written: %s", note,
                           strerror(error));
        return;
    }
    char *before = gm_regular_read(note, LONGEST_NOTE, &size, reason);
    const bool same = before && strcmp(before, text) == 0;
    free(before);
    gm_arena_refuse_if(sweep->arena, !same, "%.360s describes another sweep; its tables are left as they are",
                       note);
}

/* The text after a word that begins a line, or NULL. */
static char *find(char *note, const char *word)
{
    char *at = note ? strstr(note, word) : NULL;
    return at ? at + strlen(word) : NULL;
}

void gm_sweep_recall(struct gm_arena *arena, struct gm_sweep *sweep, const char *path)
{
    size_t size;
    int status;
    char reason[GM_REGULAR_REASON];
    char *note = gm_regular_read(gm_arena_print(arena, "%s.sweep", path), LONGEST_NOTE, &size, reason);
    if (note) {
        gm_arena_keep(arena, note, free);
    }
    char *words = find(note, "\nsweep: "), *measure = find(note, "\nmeasure: "),
         *shards = find(note, "\nshares: ");
    gm_arena_refuse_if(arena,
                       !words || !measure || !shards || strncmp(note, "geomint: 1\n", 11) != 0 ||
                           strtoul(shards, NULL, 10) == 0,
                       "%.300s.sweep, which describes the sweep, could not be read%s%s", path,
                       note ? "" : ": ", note ? "" : reason);
    char *values = find(note, "\nvalues: "), *at = find(note, "\nat: ");
    const size_t count = strtoul(shards, NULL, 10);
    char *const texts[] = {words, measure, values, at};
    for (size_t i = 0; i < GM_COUNT(texts); i++) {
        if (texts[i]) {
            texts[i][strcspn(texts[i], "\n")] = '\0';
        }
    }
    gm_sweep_open(arena, sweep, gm_arguments_of(arena, words),
                  &(struct gm_sweep_options){measure[0] ? measure : NULL, values, values ? at : NULL},
                  &status);
    sweep->shards = count;
}

/* ---- joining ---- */

/* Many shards are many open files: as many as the system allows. */
static void allow_files(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) == 0) {
        limit.rlim_cur = limit.rlim_max;
        setrlimit(RLIMIT_NOFILE, &limit);
    }
}

/* Opens a table, which may be missing, after its head. Refuses one that has another head, or is being written. */
static void open_table(const struct gm_sweep *sweep, const char *path, const char *other,
                       struct gm_csv_lines *table)
{
    struct gm_arena *arena = sweep->arena;
    gm_arena_keep(arena, table, gm_csv_close);
    *table = (struct gm_csv_lines){.stream = fopen(path, "r"), .group = sweep->index};
    if (!table->stream && errno != ENOENT) {
        gm_arena_refuse(arena, "%.360s could not be read: %s", path, strerror(errno));
    }
    gm_arena_refuse_if(arena, table->stream && flock(fileno(table->stream), LOCK_SH | LOCK_NB) != 0,
                       "%.360s is being written by another process", path);
    gm_csv_next(table);
    gm_arena_refuse_if(arena, table->line && table->line[0] && strcmp(table->line, sweep->head) != 0,
                       "%.360s is %s", path, other);
}

struct joining {
    const struct gm_sweep *sweep;
    struct gm_csv_lines *shards;
    size_t missing_count, other; /* runs without a row; 1 + the run in whose place there is another's row */
};

static bool merge(FILE *table, const void *context)
{
    enum { NAMED = 10 };
    struct joining *joining = *(struct joining *const *)context;
    const struct gm_sweep *sweep = joining->sweep;
    fputs(sweep->head, table);
    for (size_t run = 0; run < sweep->count; run++) {
        struct gm_csv_lines *shard = &joining->shards[run % sweep->shards];
        const char *row = gm_csv_next(shard); /* an incomplete row does not count */
        if (row && gm_sweep_front(sweep, run, row) == 0) {
            joining->other = 1 + run;
            return false;
        }
        if (row) {
            fputs(row, table);
        } else {
            gm_csv_close(shard);
            char *words = joining->missing_count++ < NAMED ? gm_sweep_words(sweep, run) : NULL;
            if (words) {
                gm_complain("run %zu has no row: geomint %s", run, words);
            }
            free(words);
        }
    }
    return !ferror(table);
}

size_t gm_sweep_join(const struct gm_sweep *sweep, const char *path)
{
    struct gm_arena *arena = sweep->arena;
    struct gm_csv_lines *tables = gm_arena_take(arena, sweep->shards + 1, sizeof *tables);
    struct joining joining = {.sweep = sweep, .shards = tables + 1}, *self = &joining;
    allow_files();
    for (size_t i = 1; i <= sweep->shards; i++) {
        const char *shard = gm_sweep_shard_path(arena, path, i, sweep->shards);
        open_table(sweep, shard, "not a shard of this sweep: its columns are others", &tables[i]);
    }
    open_table(sweep, path, "the table of another sweep; it is left as it is", &tables[0]);
    if (!gm_temporary_make(path, merge, &self)) {
        const int error = errno;
        gm_arena_refuse_if(arena, joining.other > 0, "shard %zu has a row that is not that of run %zu",
                           (joining.other - 1) % sweep->shards + 1, joining.other - 1);
        gm_arena_refuse(arena, "%.360s could not be written: %s", path, strerror(error));
    }
    return joining.missing_count;
}
