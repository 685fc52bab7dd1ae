/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of a sweep: rows at its end, one write each; what is there is read again, checked and kept. */
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
#include "app/output/csv.h"
#include "app/output/folder.h"
#include "core/memory.h"
#include "render/clock.h"

struct gm_sweep_table {
    const struct gm_sweep *sweep;
    char *path;   /* NULL: standard output */
    int fd;       /* where rows go */
    bool unheard; /* nobody reads what goes there */
    off_t size;   /* of the whole rows there */
    size_t there; /* rows: of the first runs of the share */
    /* where rows are made anew: they go to PATH.part, in their order with those that are kept, which are read
       from `old` */
    char *part;
    FILE *old;
    unsigned char *again; /* a bit for each row that is there: whether it is made anew */
};

static bool refuse_writing(char *message, const char *path)
{
    snprintf(message, GM_MESSAGE, "%.360s could not be written: %s; the rows before are there", path,
             strerror(errno));
    return false;
}

char *gm_sweep_share_path(const char *path, size_t shard, size_t shards)
{
    char *text = NULL;
    const size_t length = strlen(path);
    const bool ends = length > 4 && strcmp(path + length - 4, ".csv") == 0;
    if (shards == 1) {
        return strdup(path);
    }
    return asprintf(&text, "%.*s.%zu-of-%zu.csv", (int)(length - (ends ? 4 : 0)), path, shard, shards) < 0
               ? NULL
               : text;
}

/* ---- what is there ---- */

static size_t commas_of(const char *line)
{
    size_t commas = 0;
    while (*(line = gm_csv_cell(line, 1))) {
        commas++;
    }
    return commas;
}

/* Whether a line is the row of a run: it begins as that does, and has as many cells as the head. */
static bool is_row_of(const struct gm_sweep *sweep, size_t run, const char *line, size_t commas)
{
    char *front = gm_sweep_front(sweep, run);
    const bool same = front && strncmp(line, front, strlen(front)) == 0;
    free(front);
    return same && commas_of(line) == commas;
}

/* Whether a row has this status, behind the front, or any warning, which comes next. */
static bool has_status(const struct gm_sweep *sweep, size_t run, const char *line, const char *status)
{
    char *front = gm_sweep_front(sweep, run);
    const char *cell = front ? line + strlen(front) : "", *warning = gm_csv_cell(cell, 1);
    const bool has = strncmp(cell, status, strlen(status)) == 0 && cell[strlen(status)] == ',';
    free(front);
    return has || (strcmp(status, "warning") == 0 && *warning && *warning != ',');
}

/* Whether a head is this one but for the column of warnings, which older tables have not. */
static bool is_older_head(const char *line, const char *head)
{
    static const char column[] = "warning,";
    const char *at = strstr(head, ",status,");
    const size_t before = at ? (size_t)(at - head) + strlen(",status,") : 0;
    return at && strncmp(line, head, before) == 0 &&
           strcmp(line + before, head + before + sizeof column - 1) == 0;
}

/* A row that is not that of the next run: of a later one in a table that was joined before its shares had all
   rows, else of another sweep. */
static bool refuse_row(const struct gm_sweep_table *table, const char *line, size_t commas, char *message)
{
    const size_t runs = gm_sweep_share(table->sweep), row = table->there;
    size_t later = row;
    while (later < runs && !is_row_of(table->sweep, gm_sweep_run(table->sweep, later), line, commas)) {
        later++;
    }
    if (later < runs) {
        snprintf(message, GM_MESSAGE,
                 "%.200s misses rows: its row %zu is that of run %zu; it is left as it is (a sweep of shares "
                 "gets its rows by its shares and --join)",
                 table->path, row + 1, gm_sweep_run(table->sweep, later));
    } else {
        snprintf(
            message, GM_MESSAGE,
            "%.300s is not a table of this sweep: its row %zu is not that of run %zu; it is left as it is",
            table->path, row + 1, gm_sweep_run(table->sweep, row));
    }
    return false;
}

/* What is there, line by line: how many rows of the sweep, and where the last one ends. False with a sentence
   if a line is none. */
static bool read_rows(struct gm_sweep_table *table, FILE *stream, const char *head, const char *retry,
                      char *message)
{
    const size_t commas = commas_of(head), runs = gm_sweep_share(table->sweep);
    char *line = NULL;
    size_t capacity = 0;
    ssize_t length = getline(&line, &capacity, stream);
    bool good = length <= 0 || strcmp(line, head) == 0;
    const bool torn = length > 0 && line[length - 1] != '\n' && strncmp(line, head, (size_t)length) == 0;
    if (!good && !torn) {
        gm_refuse(message, "%.360s is not a table of this sweep: %s; it is left as it is", table->path,
                  is_older_head(line, head) ? "it has no column warning, so another geomint made it"
                                            : "its columns are others");
    }
    table->size = good && length > 0 ? length : 0;
    while (good && (length = getline(&line, &capacity, stream)) > 0 && line[length - 1] == '\n') {
        const size_t run = gm_sweep_run(table->sweep, table->there);
        if (table->there == runs || !is_row_of(table->sweep, run, line, commas)) {
            refuse_row(table, line, commas, message);
            good = false;
        } else {
            if (retry && has_status(table->sweep, run, line, retry)) {
                table->again[table->there / 8] |= (unsigned char)(1u << table->there % 8);
                table->old = stream;
            }
            table->size += length;
            table->there++;
        }
    }
    free(line);
    return good || torn;
}

static bool is_made_anew(const struct gm_sweep_table *table, size_t k)
{
    return table->again && (table->again[k / 8] >> k % 8 & 1);
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
                /* its last row stays torn, and is cut off when the table is opened again */
            }
            return false;
        }
        sent += written > 0 ? (size_t)written : 0;
    }
    table->size += (off_t)length;
    return true;
}

/* Where rows are made anew, all go to another file, which takes the table's place in the end. */
static bool begin_anew(struct gm_sweep_table *table, const char *head, char *message)
{
    if (asprintf(&table->part, "%s.part", table->path) < 0) {
        table->part = NULL;
        return gm_refuse(message, "%.360s could not be opened: not enough memory", table->path);
    }
    const int part = open(table->part, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
    if (part < 0) {
        return refuse_writing(message, table->part);
    }
    close(table->fd); /* the stream has the lock as well */
    table->fd = part;
    table->size = 0;
    char *line = NULL;
    size_t capacity = 0;
    rewind(table->old);
    const bool good = getline(&line, &capacity, table->old) > 0 && append(table, head, message);
    free(line);
    return good;
}

/* The file, locked, read and made ready for the next row. */
static bool open_file(struct gm_sweep_table *table, const char *head, const char *retry, char *message)
{
    if (!gm_folder_make_for(table->path, message)) {
        return false;
    }
    table->fd = open(table->path, O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
    struct stat found = {0};
    if (table->fd < 0 || fstat(table->fd, &found) != 0) {
        return gm_refuse(message, "%.360s could not be written: %s", table->path, strerror(errno));
    }
    if (!S_ISREG(found.st_mode)) {
        return gm_refuse(message, "%.360s is not a regular file", table->path);
    }
    if (flock(table->fd, LOCK_EX | LOCK_NB) != 0) {
        return gm_refuse(message, "%.360s is being written by another process", table->path);
    }
    const size_t rows = (size_t)found.st_size / (commas_of(head) + 1);
    table->again = retry ? calloc(rows / 8 + 1, 1) : NULL;
    const int copy = dup(table->fd);
    FILE *stream = copy >= 0 ? fdopen(copy, "r") : NULL;
    const bool memory = stream && (table->again || !retry);
    if (!memory) {
        gm_refuse(message, "%.360s could not be read: not enough memory", table->path);
    }
    bool good = memory && read_rows(table, stream, head, retry, message);
    if (good && table->old) {
        return begin_anew(table, head, message); /* which keeps the stream, and the lock with it */
    }
    table->old = NULL; /* rows that are not of this sweep are made anew no more than others */
    if (stream) {
        fclose(stream);
    } else if (copy >= 0) {
        close(copy);
    }
    if (good && table->size < found.st_size && ftruncate(table->fd, table->size) != 0) {
        good = refuse_writing(message, table->path);
    }
    return good && (table->size > 0 || append(table, head, message));
}

static void free_table(struct gm_sweep_table *table)
{
    if (table->old) {
        fclose(table->old);
    }
    if (table->path && table->fd >= 0) {
        close(table->fd);
    }
    free(table->again);
    free(table->part);
    free(table->path);
    free(table);
}

struct gm_sweep_table *gm_sweep_table_open(const struct gm_sweep *sweep, const char *path, const char *retry,
                                           char *message)
{
    struct gm_sweep_table *table = calloc(1, sizeof *table);
    char *head = gm_sweep_head(sweep);
    bool good = table && head;
    if (good) {
        *table = (struct gm_sweep_table){.sweep = sweep, .fd = path ? -1 : STDOUT_FILENO};
        table->path = path ? gm_sweep_share_path(path, sweep->shard, sweep->shards) : NULL;
        good = !path || table->path;
    }
    if (!good) {
        gm_refuse(message, "%.360s could not be opened: not enough memory", path ? path : "standard output");
    } else {
        fflush(stdout);
        good = !path || open_file(table, head, retry, message);
    }
    free(head);
    if (!good && table) {
        free_table(table);
        table = NULL;
    }
    return table;
}

const char *gm_sweep_table_path(const struct gm_sweep_table *table)
{
    return table->path;
}

/* ---- filling ---- */

/* Rows that may wait for an earlier one: as the work behind a run that takes long is lost when the program is
   killed, as much as that of the run itself, the number only bounds the memory. */
enum { WINDOW = 1024 };

struct filling {
    struct gm_sweep_table *table;
    const struct gm_listener *listener;
    struct gm_sweep_sum *sum;
    char *message;
    size_t first; /* piece 0 of the pool is this run of the share */
    bool failed;
    double told;
    char *kept; /* the line of the row that is kept */
    size_t capacity;
    struct gm_sweep_row slots[WINDOW];
};

static void make(void *self, size_t index, size_t slot)
{
    struct filling *filling = self;
    const struct gm_sweep_table *table = filling->table;
    const size_t k = filling->first + index;
    if (k >= table->there || is_made_anew(table, k)) {
        gm_sweep_make(table->sweep, gm_sweep_run(table->sweep, k), &filling->slots[slot]);
    }
}

static bool fills_no_more(void *self)
{
    return gm_listener_stops(((struct filling *)self)->listener);
}

static void hear(struct filling *filling, size_t k)
{
    const double often = 0.1, now = gm_clock_seconds();
    if (now - filling->told > often) {
        filling->told = now;
        gm_listener_hears(filling->listener, "runs", k + 1, gm_sweep_share(filling->table->sweep));
    }
}

static bool keep_old(struct filling *filling)
{
    struct gm_sweep_table *table = filling->table;
    if (getline(&filling->kept, &filling->capacity, table->old) <= 0) {
        gm_refuse(filling->message, "%.360s could not be read again", table->path);
        return false;
    }
    return append(table, filling->kept, filling->message);
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
    const size_t k = filling->first + index;
    hear(filling, k);
    const bool anew = is_made_anew(table, k);
    if (k < table->there && !anew) {
        filling->failed = !keep_old(filling);
        return !filling->failed;
    }
    struct gm_sweep_row *row = &filling->slots[slot];
    if (!row->text) {
        if (!gm_interrupted) {
            filling->failed = true;
            gm_refuse(filling->message, "a row could not be made: not enough memory");
        }
        return false;
    }
    if (anew && getline(&filling->kept, &filling->capacity, table->old) <= 0) {
        filling->failed = true;
        return gm_refuse(filling->message, "%.360s could not be read again", table->path);
    }
    const bool good = append(table, row->text, filling->message);
    if (good) {
        count_row(filling->sum, gm_sweep_run(table->sweep, k), row);
    }
    free(row->text);
    row->text = NULL;
    filling->failed = !good;
    return good;
}

bool gm_sweep_table_fill(struct gm_sweep_table *table, size_t jobs, const struct gm_listener *listener,
                         struct gm_sweep_sum *sum, char *message)
{
    struct filling *filling = calloc(1, sizeof *filling);
    char *head = table->path ? NULL : gm_sweep_head(table->sweep);
    *sum = (struct gm_sweep_sum){0};
    if (!filling || !(head || table->path)) {
        free(filling);
        free(head);
        return gm_refuse(message, "%.360s is not filled: not enough memory",
                         table->path ? table->path : "standard output");
    }
    filling->table = table;
    filling->listener = listener;
    filling->sum = sum;
    filling->message = message;
    filling->first = table->part ? 0 : table->there;
    const struct gm_pool pool = {.count = gm_sweep_share(table->sweep) - filling->first,
                                 .jobs = jobs,
                                 .window = WINDOW,
                                 .work = make,
                                 .take = take,
                                 .stopped = fills_no_more,
                                 .self = filling};
    /* where that was interrupted, rows that are there stay, behind those that were made */
    filling->failed = head && !append(table, head, message);
    const size_t taken = filling->failed ? 0 : gm_pool_run(&pool);
    free(head);
    for (size_t k = filling->first + taken; k < table->there && !filling->failed; k++) {
        filling->failed = !keep_old(filling);
    }
    sum->unheard = table->unheard;
    const bool good = !filling->failed;
    for (size_t i = 0; i < WINDOW; i++) {
        free(filling->slots[i].text);
    }
    free(filling->kept);
    free(filling);
    if (table->part && !good) {
        unlink(table->part);
    } else if (table->part && (fsync(table->fd) != 0 || rename(table->part, table->path) != 0)) {
        return refuse_writing(message, table->path);
    }
    return good;
}

bool gm_sweep_table_close(struct gm_sweep_table *table, char *message)
{
    bool good = !table->path || fsync(table->fd) == 0;
    if (!good) {
        refuse_writing(message, table->path);
    }
    free_table(table);
    return good;
}
