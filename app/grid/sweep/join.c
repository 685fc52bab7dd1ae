/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shares of a sweep: what it was is noted beside them, and their rows become one table. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/grid/sweep.h"
#include "app/output/folder.h"
#include "core/memory.h"

static char *note_path(const char *path)
{
    char *text = NULL;
    return asprintf(&text, "%s.sweep", path) < 0 ? NULL : text;
}

/* ---- the note ---- */

/* As gm_arguments_split reads it. */
static char *note_text(const struct gm_sweep *sweep)
{
    char *text = NULL;
    return asprintf(&text, "geomint: 1\nsweep: %s\nmeasure: %s\nshares: %zu\n", sweep->arguments,
                    sweep->measure ? sweep->measure : "", sweep->shards) < 0
               ? NULL
               : text;
}

/* The lines of a note behind their words; malloc'ed, to be freed in any case. */
struct note {
    char *sweep, *measure;
    size_t shares;
};

static void free_note(struct note *note)
{
    free(note->sweep);
    free(note->measure);
}

static bool read_note(const char *path, struct note *note)
{
    char *line = NULL;
    size_t capacity = 0, version = 0;
    FILE *stream = fopen(path, "r");
    *note = (struct note){0};
    while (stream && getline(&line, &capacity, stream) > 0) {
        line[strcspn(line, "\n")] = '\0';
        char *colon = strstr(line, ": ");
        if (!colon) {
            break;
        }
        *colon = '\0';
        if (strcmp(line, "sweep") == 0 && !note->sweep) {
            note->sweep = strdup(colon + 2);
        } else if (strcmp(line, "measure") == 0 && !note->measure) {
            note->measure = strdup(colon + 2);
        } else if (strcmp(line, "shares") == 0) {
            note->shares = strtoul(colon + 2, NULL, 10);
        } else if (strcmp(line, "geomint") == 0) {
            version = strtoul(colon + 2, NULL, 10);
        }
    }
    if (stream) {
        fclose(stream);
    }
    free(line);
    return version == 1 && note->sweep && note->measure && note->shares > 0;
}

/* Whether the file holds just this text. */
static bool holds(const char *path, const char *text)
{
    FILE *stream = fopen(path, "r");
    bool same = stream != NULL;
    for (; same && *text; text++) {
        same = fgetc(stream) == (unsigned char)*text;
    }
    same = same && fgetc(stream) == EOF;
    if (stream) {
        fclose(stream);
    }
    return same;
}

/* Written aside under a name of this process and linked: of all that try at once one has made it, whole. */
static bool put_note(const char *path, const char *text, char *message)
{
    char *aside = NULL;
    if (asprintf(&aside, "%s.%ld", path, (long)getpid()) < 0) {
        return gm_refuse(message, "%.360s could not be written: not enough memory", path);
    }
    FILE *stream = fopen(aside, "w");
    bool good = stream && fputs(text, stream) >= 0;
    if (stream) {
        good = fclose(stream) == 0 && good;
    }
    good = good && (link(aside, path) == 0 || errno == EEXIST);
    if (!good) {
        snprintf(message, GM_MESSAGE, "%.360s could not be written: %s", path, strerror(errno));
    }
    unlink(aside);
    free(aside);
    return good;
}

bool gm_sweep_note(const struct gm_sweep *sweep, const char *path, char *message)
{
    char *note = note_path(path), *text = note_text(sweep);
    bool good = note && text;
    if (!good) {
        gm_refuse(message, "%.360s could not be opened: not enough memory", path);
    } else if (!gm_folder_make_for(path, message)) {
        good = false;
    } else if (!holds(note, text)) {
        good = access(note, F_OK) != 0 && put_note(note, text, message);
        if (!good && access(note, F_OK) == 0) {
            gm_refuse(message, "%.360s tells of another sweep; its tables are left as they are", note);
        }
        good = good && (holds(note, text) || gm_refuse(message, "%.360s tells of another sweep", note));
    }
    free(note);
    free(text);
    return good;
}

bool gm_sweep_recall(struct gm_sweep *sweep, const char *path, char *message)
{
    bool unreadable = false;
    struct note note = {0};
    struct gm_arguments arguments = {0};
    char *name = note_path(path);
    *sweep = (struct gm_sweep){0};
    bool good = name && read_note(name, &note);
    if (!good) {
        snprintf(message, GM_MESSAGE,
                 "%.300s.sweep, which tells what the shares are of, could not be read%s%s", path,
                 errno ? ": " : "", errno ? strerror(errno) : "");
    } else if (!gm_arguments_split(&arguments, note.sweep)) {
        good = gm_refuse(message, "%.360s could not be read: not enough memory", name);
    } else {
        good = gm_sweep_open(sweep, &arguments, note.measure[0] ? note.measure : NULL, &unreadable, message);
        sweep->shards = note.shares;
    }
    gm_arguments_close(&arguments);
    free_note(&note);
    free(name);
    return good;
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

/* Opens the share behind its head. A share that is not there has no rows; one that is being written, or that
   is of another sweep, is refused. */
static bool open_share(const struct gm_sweep *sweep, const char *path, size_t shard, const char *head,
                       FILE **share, char *message)
{
    char *name = gm_sweep_share_path(path, shard, sweep->shards), *line = NULL;
    size_t capacity = 0;
    bool good = name != NULL;
    *share = name ? fopen(name, "r") : NULL;
    if (!name) {
        gm_refuse(message, "%.360s could not be joined: not enough memory", path);
    } else if (!*share && errno != ENOENT) {
        snprintf(message, GM_MESSAGE, "%.360s could not be read: %s", name, strerror(errno));
        good = false;
    } else if (*share && flock(fileno(*share), LOCK_SH | LOCK_NB) != 0) {
        good = gm_refuse(message, "%.360s is being written by another process", name);
    } else if (*share) {
        good = getline(&line, &capacity, *share) <= 0 || strcmp(line, head) == 0 ||
               gm_refuse(message, "%.360s is not a share of this sweep: its columns are others", name);
    }
    free(line);
    free(name);
    return good;
}

/* The next row of a share, which has to be that of the run; NULL where the share has ended. */
static const char *next_row(const struct gm_sweep *sweep, size_t run, FILE **share, char **line,
                            size_t *capacity, bool *good)
{
    const ssize_t length = *share ? getline(line, capacity, *share) : 0;
    if (length <= 0 || (*line)[length - 1] != '\n') { /* a torn row is none */
        if (*share) {
            fclose(*share);
        }
        *share = NULL;
        return NULL;
    }
    char *front = gm_sweep_front(sweep, run);
    *good = front && strncmp(*line, front, strlen(front)) == 0;
    free(front);
    return *good ? *line : NULL;
}

/* The shares' rows in turn. */
static bool merge(const struct gm_sweep *sweep, FILE **shares, FILE *table,
                  void (*missing)(size_t run, const char *words), size_t *missing_count, char *message)
{
    char *line = NULL;
    size_t capacity = 0;
    bool good = true;
    for (size_t run = 0; run < sweep->count && good; run++) {
        const size_t shard = run % sweep->shards;
        const char *row = next_row(sweep, run, &shares[shard], &line, &capacity, &good);
        if (row) {
            fputs(row, table);
        } else if (good) {
            enum { TOLD = 10 };
            char *words = *missing_count < TOLD ? gm_sweep_words(sweep, run) : NULL;
            if (words) {
                missing(run, words);
            }
            free(words);
            (*missing_count)++;
        } else {
            snprintf(message, GM_MESSAGE, "share %zu has a row that is not that of run %zu", shard + 1, run);
        }
    }
    free(line);
    return good;
}

/* Takes the table's place if that is one of this sweep, or none. */
static bool replace(const char *part, const char *path, const char *head, char *message)
{
    char *line = NULL;
    size_t capacity = 0;
    FILE *before = fopen(path, "r");
    const bool other = before && getline(&line, &capacity, before) > 0 && strcmp(line, head) != 0;
    if (before) {
        fclose(before);
    }
    free(line);
    if (other) {
        return gm_refuse(message, "%.360s is the table of another sweep; it is left as it is", path);
    }
    if (rename(part, path) != 0) {
        return gm_refuse(message, "%.360s could not be written: %s", path, strerror(errno));
    }
    return true;
}

bool gm_sweep_join(const struct gm_sweep *sweep, const char *path,
                   void (*missing)(size_t run, const char *words), size_t *missing_count, char *message)
{
    char *head = gm_sweep_head(sweep), *part = NULL;
    FILE **shares = calloc(sweep->shards, sizeof *shares);
    *missing_count = 0;
    allow_files();
    bool good = head && shares && asprintf(&part, "%s.part", path) >= 0;
    if (!good) {
        gm_refuse(message, "%.360s could not be joined: not enough memory", path);
    }
    for (size_t i = 0; good && i < sweep->shards; i++) {
        good = open_share(sweep, path, i + 1, head, &shares[i], message);
    }
    FILE *table = good ? fopen(part, "w") : NULL;
    if (table) {
        fputs(head, table);
        good = merge(sweep, shares, table, missing, missing_count, message);
        const bool failed = ferror(table) != 0;
        if ((fclose(table) != 0 || failed) && good) {
            snprintf(message, GM_MESSAGE, "%.360s could not be written: %s", part, strerror(errno));
            good = false;
        }
        good = good && replace(part, path, head, message);
        if (!good) {
            unlink(part);
        }
    } else if (good) {
        snprintf(message, GM_MESSAGE, "%.360s could not be written: %s", part, strerror(errno));
        good = false;
    }
    for (size_t i = 0; shares && i < sweep->shards; i++) {
        if (shares[i]) {
            fclose(shares[i]);
        }
    }
    free(shares);
    free(head);
    free(part);
    return good;
}
