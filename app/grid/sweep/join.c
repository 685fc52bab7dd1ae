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
#include "core/arena.h"
#include "render/files/regular_file.h"
#include "render/files/temporary.h"

enum { LONGEST_NOTE = 1 << 20 };

void gm_sweep_note(const struct gm_sweep *sweep, const char *path)
{
    size_t size;
    char reason[GM_REGULAR_REASON], message[GM_MESSAGE];
    const char *note = gm_arena_print(sweep->arena, "%s.sweep", path);
    /* the words as gm_arguments_split reads them */
    const char *text = gm_arena_print(sweep->arena, "geomint: 1\nsweep: %s\nmeasure: %s\nshares: %zu\n",
                                      sweep->arguments, sweep->measure ? sweep->measure : "", sweep->shards);
    if (!gm_folder_make_for(path, message)) {
        gm_arena_refuse(sweep->arena, "%s", message);
    }
    if (access(note, F_OK) != 0) {
        const int error = gm_temporary_write(note, text, strlen(text));
        if (error != 0) {
            gm_arena_refuse(sweep->arena, "%.360s could not be written: %s", note, strerror(error));
        }
        return;
    }
    char *before = gm_regular_read(note, LONGEST_NOTE, &size, reason);
    const bool same = before && strcmp(before, text) == 0;
    free(before);
    if (!same) {
        gm_arena_refuse(sweep->arena, "%.360s describes another sweep; its tables are left as they are",
                        note);
    }
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
    struct gm_arguments *arguments = gm_arguments_in(arena);
    char *note = gm_regular_read(gm_arena_print(arena, "%s.sweep", path), LONGEST_NOTE, &size, reason);
    if (note) {
        gm_arena_keep(arena, note, free);
    }
    char *words = find(note, "\nsweep: "), *measure = find(note, "\nmeasure: "),
         *shares = find(note, "\nshares: ");
    if (!words || !measure || !shares || strncmp(note, "geomint: 1\n", 11) != 0 ||
        strtoul(shares, NULL, 10) == 0) {
        gm_arena_refuse(arena, "%.300s.sweep, which describes the sweep, could not be read%s%s", path,
                        note ? "" : ": ", note ? "" : reason);
    }
    words[strcspn(words, "\n")] = measure[strcspn(measure, "\n")] = '\0';
    gm_arena_need(arena, gm_arguments_split(arguments, words));
    gm_sweep_open(arena, sweep, arguments, measure[0] ? measure : NULL, &status);
    sweep->shards = strtoul(shares, NULL, 10);
}

/* ---- joining ---- */

/* Many shares are many open files: as many as the system allows. */
static void allow_files(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_NOFILE, &limit) == 0) {
        limit.rlim_cur = limit.rlim_max;
        setrlimit(RLIMIT_NOFILE, &limit);
    }
}

/* Opens the shard after its head. A missing shard has no rows; one that is being written, or another
   sweep's, is refused. */
static bool open_share(const struct gm_sweep *sweep, const char *path, size_t shard,
                       struct gm_csv_lines *share, char *message)
{
    char *name = gm_sweep_share_path(path, shard, sweep->shards);
    bool good = name || gm_refuse(message, "%.360s could not be joined: not enough memory", path);
    share->stream = name ? fopen(name, "r") : NULL;
    if (name && !share->stream && errno != ENOENT) {
        good = gm_refuse(message, "%.360s could not be read: %s", name, strerror(errno));
    } else if (share->stream && flock(fileno(share->stream), LOCK_SH | LOCK_NB) != 0) {
        good = gm_refuse(message, "%.360s is being written by another process", name);
    } else if (share->stream) {
        gm_csv_next(share);
        good = !share->line || !share->line[0] || strcmp(share->line, sweep->head) == 0 ||
               gm_refuse(message, "%.360s is not a share of this sweep: its columns are others", name);
    }
    free(name);
    return good;
}

/* The shares' rows in turn. */
static bool merge(const struct gm_sweep *sweep, struct gm_csv_lines *shares, FILE *table,
                  void (*missing)(size_t run, const char *words), size_t *missing_count, char *message)
{
    enum { NAMED = 10 };
    for (size_t run = 0; run < sweep->count; run++) {
        struct gm_csv_lines *share = &shares[run % sweep->shards];
        const char *row = gm_csv_next(share); /* an incomplete row does not count */
        if (row && gm_sweep_front(sweep, run, row) == 0) {
            return gm_refuse(message, "share %zu has a row that is not that of run %zu",
                             run % sweep->shards + 1, run);
        }
        if (row) {
            fputs(row, table);
        } else {
            gm_csv_close(share);
            char *words = (*missing_count)++ < NAMED ? gm_sweep_words(sweep, run) : NULL;
            if (words) {
                missing(run, words);
            }
            free(words);
        }
    }
    return true;
}

/* Takes the table's place if that is one of this sweep, or none. */
static bool replace(const char *part, const char *path, const char *head, char *message)
{
    struct gm_csv_lines before = {.stream = fopen(path, "r")};
    gm_csv_next(&before);
    const bool other = before.line && before.line[0] && strcmp(before.line, head) != 0;
    gm_csv_close(&before);
    if (other) {
        return gm_refuse(message, "%.360s is the table of another sweep; it is left as it is", path);
    }
    return rename(part, path) == 0 ||
           gm_refuse(message, "%.360s could not be written: %s", path, strerror(errno));
}

bool gm_sweep_join(const struct gm_sweep *sweep, const char *path,
                   void (*missing)(size_t run, const char *words), size_t *missing_count, char *message)
{
    char *part = gm_text("%s.part", path);
    struct gm_csv_lines *shares = calloc(sweep->shards, sizeof *shares);
    *missing_count = 0;
    allow_files();
    bool good = shares && part;
    if (!good) {
        gm_refuse(message, "%.360s could not be joined: not enough memory", path);
    }
    for (size_t i = 0; good && i < sweep->shards; i++) {
        good = open_share(sweep, path, i + 1, &shares[i], message);
    }
    FILE *table = good ? fopen(part, "w") : NULL;
    if (table) {
        fputs(sweep->head, table);
        good = merge(sweep, shares, table, missing, missing_count, message);
        const bool failed = ferror(table) != 0;
        if ((fclose(table) != 0 || failed) && good) {
            good = gm_refuse(message, "%.360s could not be written: %s", part, strerror(errno));
        }
        good = good && replace(part, path, sweep->head, message);
        if (!good) {
            unlink(part);
        }
    } else if (good) {
        good = gm_refuse(message, "%.360s could not be written: %s", part, strerror(errno));
    }
    for (size_t i = 0; shares && i < sweep->shards; i++) {
        gm_csv_close(&shares[i]);
    }
    free(shares);
    free(part);
    return good;
}
