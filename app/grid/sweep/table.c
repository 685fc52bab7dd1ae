/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of a sweep: rows are appended with one write each; existing rows are read, checked and kept. */
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/base/interrupt.h"
#include "app/base/pool.h"
#include "app/grid/sweep.h"
#include "app/output/folder.h"
#include "app/output/row.h"
#include "core/arena.h"
#include "core/expression/reader.h"
#include "render/clock.h"

struct gm_sweep_table {
    struct gm_arena *arena; /* closes the table */
    const struct gm_sweep *sweep;
    const char *path;        /* NULL: standard output */
    int fd;                  /* the file of new rows */
    bool unheard;            /* the output has no reader */
    off_t size;              /* size of the whole rows, in bytes */
    size_t there;            /* number of rows: the first runs of the shard */
    struct gm_csv_lines old; /* the table before this run; its stream has the lock too */
    /* the file PATH.part, if rows are recomputed: it gets all rows in their order */
    const char *part;
    size_t *again; /* the numbers of these rows */
    size_t again_count;
    size_t copied; /* rows of `old` that were copied to the other file, or recomputed */
};

static bool refuse_writing(char *message, const char *path)
{
    return gm_refuse(message, "%.360s could not be written: %s; the rows before are there", path,
                     strerror(errno));
}

const char *gm_sweep_shard_path(struct gm_arena *arena, const char *path, size_t shard, size_t shards)
{
    const size_t front = strlen(path) - (gm_word_ends(path, ".csv") ? strlen(".csv") : 0);
    return shards == 1 ? gm_arena_print(arena, "%s", path)
                       : gm_arena_print(arena, "%.*s.%zu-of-%zu.csv", (int)front, path, shard, shards);
}

/* ---- existing rows ---- */

/* The commas between the cells of all lines. */
static size_t commas_of(const char *lines)
{
    size_t commas = 0;
    while (*(lines = gm_csv_cell(lines, 1))) {
        commas++;
    }
    return commas;
}

static size_t lines_of(const char *rows)
{
    size_t lines = 0;
    for (; *rows; rows++) {
        lines += *rows == '\n';
    }
    return lines;
}

/* The length of the front of a run's rows: each begins with the run's front, and they have as many cells as that
   number of heads; 0: they are not that run's. */
static size_t front_of(const struct gm_sweep *sweep, size_t run, const char *rows)
{
    size_t front = commas_of(rows) == lines_of(rows) * commas_of(sweep->head) ? 1 : 0;
    for (const char *row = rows; *row && front > 0; row = strchr(row, '\n') + 1) {
        front = gm_sweep_front(sweep, run, row);
    }
    return front;
}

/* Returns true if a run with several rows has all of them, as far as can be seen: a killed program may leave some. */
static bool is_whole(const struct gm_sweep *sweep, const char *rows, size_t front)
{
    return !sweep->values || lines_of(rows) == sweep->kept || strncmp(rows + front, "ok,", 3) != 0;
}

/* Returns true if the cells after a front have this status, or any warning, which is the next cell. */
static bool has_status(const char *cells, const char *status)
{
    const char *warning = gm_csv_cell(cells, 1);
    return (strncmp(cells, status, strlen(status)) == 0 && cells[strlen(status)] == ',') ||
           (strcmp(status, "warning") == 0 && *warning && *warning != ',');
}

/* Returns true if a head differs only by the column of warnings, which older tables do not have. */
static bool is_older_head(const char *line, const char *head)
{
    static const char column[] = "warning,";
    const char *at = strstr(head, ",status,");
    const size_t before = at ? (size_t)(at - head) + strlen(",status,") : 0;
    return at && strncmp(line, head, before) == 0 &&
           strcmp(line + before, head + before + sizeof column - 1) == 0;
}

/* A row that is not that of the next run: of a later one in a table that was joined before its shards had all
   rows, else of another sweep. */
static void refuse_row(const struct gm_sweep_table *table, const char *line)
{
    const struct gm_sweep *sweep = table->sweep;
    const size_t runs = gm_sweep_shard_runs(sweep), row = table->there;
    size_t later = row;
    while (later < runs && front_of(sweep, gm_sweep_run(sweep, later), line) == 0) {
        later++;
    }
    gm_arena_refuse_if(
        table->arena, later < runs,
        "%.200s misses rows: its row %zu is that of run %zu; it is left as it is (a sweep of shards "
        "gets its rows by its shards and --join)",
        table->path, row + 1, gm_sweep_run(sweep, later));
    gm_arena_refuse(
        table->arena,
        "%.300s is not a table of this sweep: its row %zu is not that of run %zu%s%.60s%s%s; it is left as it is",
        table->path, row + 1, gm_sweep_run(sweep, row), sweep->values ? " with --values " : "",
        sweep->values ? sweep->values : "", sweep->values ? " --at " : "", sweep->values ? sweep->at : "");
}

/* Reads the head; an empty table or an incomplete head has none. Refuses another head. */
static void read_head(struct gm_sweep_table *table)
{
    const char *head = table->sweep->head;
    const char *line = gm_csv_next(&table->old), *torn = table->old.line ? table->old.line : "";
    if (line && strcmp(line, head) == 0) {
        table->size = (off_t)strlen(head);
    } else if (line || strncmp(torn, head, strlen(torn)) != 0) {
        gm_arena_refuse(table->arena, "%.360s is not a table of this sweep: %s; it is left as it is",
                        table->path,
                        is_older_head(torn, head) ? "it has no column warning, so another geomint made it"
                                                  : "its columns are others");
    }
}

/* Reads the existing rows, and notes their number, the end of the last one, and those to recompute. Refuses a line
   that is not a row. */
static void read_rows(struct gm_sweep_table *table, const char *retry)
{
    const size_t runs = gm_sweep_shard_runs(table->sweep);
    read_head(table);
    for (const char *line; (line = gm_csv_next(&table->old)); table->there++) {
        const size_t front = front_of(table->sweep, gm_sweep_run(table->sweep, table->there), line);
        if (table->there == runs || front == 0) {
            refuse_row(table, line);
        }
        if (!table->old.is_ahead && !is_whole(table->sweep, line, front)) {
            break; /* it is the last one */
        }
        if (retry && has_status(line + front, retry)) {
            table->again =
                gm_arena_resize(table->arena, table->again, table->again_count + 1, sizeof *table->again);
            table->again[table->again_count++] = table->there;
        }
        table->size += (off_t)strlen(line);
    }
}

/* A row, or the head, whole or not at all. */
static bool append(struct gm_sweep_table *table, const char *text, char *message)
{
    const char *path = table->part ? table->part : table->path ? table->path : "standard output";
    const size_t length = strlen(text);
    size_t sent = 0;
    while (sent <
           length) { /* a file takes all of it at once, unless the disk is full; a pipe may take parts */
        const ssize_t written = write(table->fd, text + sent, length - sent);
        if (written < 0 && errno != EINTR) {
            table->unheard = errno == EPIPE;
            refuse_writing(message, path);
            if (table->path && ftruncate(table->fd, table->size) != 0) {
                /* the last row stays incomplete, and is cut off when the table is opened again */
            }
            return false;
        }
        sent += written > 0 ? (size_t)written : 0;
    }
    table->size += (off_t)length;
    return true;
}

/* Begins the other file for a table with recomputed rows; in the end it replaces the table. Returns false with a
   sentence. */
static bool begin_anew(struct gm_sweep_table *table, char *message)
{
    table->part = gm_arena_print(table->arena, "%s.part", table->path);
    const int part = open(table->part, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
    if (part < 0) {
        return refuse_writing(message, table->part);
    }
    close(table->fd);
    table->fd = part;
    table->size = 0;
    rewind(table->old.stream);
    table->old.is_ahead = false;
    return gm_csv_next(&table->old) && append(table, table->sweep->head, message);
}

/* The file, locked, read and made ready for the next row. */
static void open_file(struct gm_sweep_table *table, const char *retry)
{
    char message[GM_MESSAGE];
    gm_arena_check(table->arena, gm_folder_make_for(table->path, message), message);
    table->fd = open(table->path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    struct stat found = {0};
    if (table->fd < 0 || fstat(table->fd, &found) != 0) {
        gm_arena_refuse(table->arena, "%.360s could not be written: %s", table->path, strerror(errno));
    }
    gm_arena_refuse_if(table->arena, !S_ISREG(found.st_mode), "%.360s is not a regular file", table->path);
    gm_arena_refuse_if(table->arena, flock(table->fd, LOCK_EX | LOCK_NB) != 0,
                       "%.360s is being written by another process", table->path);
    const int copy = dup(table->fd);
    table->old.stream = copy >= 0 ? fdopen(copy, "r") : NULL;
    table->old.group = table->sweep->index;
    if (!table->old.stream) {
        close(copy);
        gm_arena_need(table->arena, false);
    }
    read_rows(table, retry);
    if (table->again_count > 0) {
        gm_arena_check(table->arena, begin_anew(table, message), message);
    } else if (table->size < found.st_size && ftruncate(table->fd, table->size) != 0) {
        gm_arena_check(table->arena, refuse_writing(message, table->path), message);
    } else if (table->size == 0) {
        gm_arena_check(table->arena, append(table, table->sweep->head, message), message);
    }
}

static void close_table(void *data)
{
    struct gm_sweep_table *table = data;
    gm_csv_close(&table->old);
    if (table->path && table->fd >= 0) {
        close(table->fd);
    }
}

struct gm_sweep_table *gm_sweep_table_open(struct gm_arena *arena, const struct gm_sweep *sweep,
                                           const char *path, const char *retry)
{
    struct gm_sweep_table *table = gm_arena_take(arena, 1, sizeof *table);
    *table = (struct gm_sweep_table){.arena = arena, .sweep = sweep, .fd = path ? -1 : STDOUT_FILENO};
    gm_arena_keep(arena, table, close_table);
    fflush(stdout);
    if (path) {
        table->path = gm_sweep_shard_path(arena, path, sweep->shard, sweep->shards);
        open_file(table, retry);
    }
    return table;
}

/* ---- filling ---- */

/* Rows that may wait for an earlier one. A killed program loses the work after a long run, at most as much
   as that run; the number only bounds the memory. */
enum { WINDOW = 1024 };

struct filling {
    struct gm_sweep_table *table;
    struct gm_sweep_chart *chart;
    const struct gm_listener *listener;
    struct gm_sweep_sum *sum;
    char *message;
    bool failed;
    double heard; /* when */
    struct gm_sweep_row slots[WINDOW];
};

/* The row of the pool's piece `index`: recomputed rows come before missing ones. */
static size_t row_of(const struct gm_sweep_table *table, size_t index)
{
    return index < table->again_count ? table->again[index] : table->there + index - table->again_count;
}

static void make(void *self, size_t index, size_t slot)
{
    struct filling *filling = self;
    const struct gm_sweep_table *table = filling->table;
    gm_sweep_make(table->sweep, gm_sweep_run(table->sweep, row_of(table, index)), &filling->slots[slot]);
}

static bool fills_no_more(void *self)
{
    return gm_listener_stops(((struct filling *)self)->listener);
}

static void hear(struct filling *filling, size_t k)
{
    const double often = 0.1, now = gm_clock_seconds();
    if (now - filling->heard > often) {
        filling->heard = now;
        gm_listener_hears(filling->listener, "runs", k + 1, gm_sweep_shard_runs(filling->table->sweep));
    }
}

/* Copies the existing rows before `k`, and skips row `k`. */
static bool copy_old(struct gm_sweep_table *table, size_t k, char *message)
{
    while (table->part && table->copied < table->there && table->copied <= k) {
        const char *line = gm_csv_next(&table->old);
        if (!line) {
            return gm_refuse(message, "%.360s could not be read again", table->path);
        }
        if (table->copied++ < k && !append(table, line, message)) {
            return false;
        }
    }
    return true;
}

static void count_row(struct gm_sweep_sum *sum, size_t run, const struct gm_sweep_row *row)
{
    sum->made++;
    sum->failed += !row->ok;
    if (!row->ok && row->sentence[0] && !sum->refusal[0]) {
        memcpy(sum->refusal, row->sentence, sizeof sum->refusal);
    }
    if (row->ok && row->sentence[0] && sum->warned++ == 0) {
        sum->first_warned = run;
        memcpy(sum->warning, row->sentence, sizeof sum->warning);
    }
}

static bool take(void *self, size_t index, size_t slot)
{
    struct filling *filling = self;
    struct gm_sweep_table *table = filling->table;
    const size_t k = row_of(table, index);
    hear(filling, k);
    struct gm_sweep_row *row = &filling->slots[slot];
    if (!row->text) {
        filling->failed = !gm_interrupted;
        return gm_refuse(filling->message, "a row could not be made: not enough memory");
    }
    filling->failed = !copy_old(table, k, filling->message) || !append(table, row->text, filling->message);
    if (!filling->failed) {
        count_row(filling->sum, gm_sweep_run(table->sweep, k), row);
    }
    if (!filling->failed && filling->chart) {
        gm_sweep_chart_take(filling->chart, gm_sweep_run(table->sweep, k), row->text);
    }
    free(row->text);
    row->text = NULL;
    return !filling->failed;
}

bool gm_sweep_table_fill(struct gm_sweep_table *table, size_t jobs, struct gm_sweep_chart *chart,
                         const struct gm_listener *listener, struct gm_sweep_sum *sum, char *message)
{
    struct filling *filling = calloc(1, sizeof *filling);
    *sum = (struct gm_sweep_sum){0};
    if (!filling) {
        return gm_refuse(message, "%.360s is not filled: not enough memory",
                         table->path ? table->path : "standard output");
    }
    filling->table = table;
    filling->chart = chart;
    filling->listener = listener;
    filling->sum = sum;
    filling->message = message;
    const struct gm_pool pool = {.count =
                                     table->again_count + gm_sweep_shard_runs(table->sweep) - table->there,
                                 .jobs = jobs,
                                 .window = WINDOW,
                                 .work = make,
                                 .take = take,
                                 .stopped = fills_no_more,
                                 .self = filling};
    filling->failed = !table->path && !append(table, table->sweep->head, message);
    if (!filling->failed) {
        gm_pool_run(&pool);
    }
    /* after an interruption the remaining existing rows follow the new ones */
    filling->failed = filling->failed || !copy_old(table, SIZE_MAX, message);
    sum->unheard = table->unheard;
    const bool filled = !filling->failed;
    for (size_t i = 0; i < WINDOW; i++) {
        free(filling->slots[i].text);
    }
    free(filling);
    if (table->part && !filled) {
        unlink(table->part);
    } else if (table->part && (fsync(table->fd) != 0 || rename(table->part, table->path) != 0)) {
        return refuse_writing(message, table->path);
    }
    return filled;
}

bool gm_sweep_table_close(struct gm_sweep_table *table, char *message)
{
    const bool synced = !table->path || fsync(table->fd) == 0 || refuse_writing(message, table->path);
    gm_arena_drop(table->arena, table);
    return synced;
}
