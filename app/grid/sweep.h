/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_GRID_SWEEP_H
#define GM_APP_GRID_SWEEP_H

#include <stdbool.h>
#include <stddef.h>

#include "app/base/arguments.h"
#include "app/words/names.h"
#include "app/words/request.h"
#include "app/words/words.h"

/* A listener of long work gets its progress, and may stop it. */
struct gm_listener {
    bool (*stopped)(void *self); /* NULL: never */
    /* `what` is running, `done` of `all` parts are finished and readable; NULL: no report */
    void (*report)(void *self, const char *what, size_t done, size_t all);
    void *self;
};

/* Returns true if the listener or a signal requests a stop. `listener` may be NULL. */
bool gm_listener_stops(const struct gm_listener *listener);
void gm_listener_hears(const struct gm_listener *listener, const char *what, size_t done, size_t all);

/* The listener of commands: a line on standard error if that is a terminal; gm_terminal_listener_clear
   removes it. */
extern const struct gm_listener gm_terminal_listener;
void gm_terminal_listener_clear(void);

/* A sweep: a run for every combination of the values of its keys, and a row of a table for every run. Runs
   are numbered from 0, the first list changes slowest, and made from their number alone, without
   storage. The table has this order: a row's position is its key, and its cells up to `status`, in full
   precision, must be those of the run with this number. */

/* The places of a run that have a value (--at). */
enum gm_sweep_place { GM_AT_STEP, GM_AT_SECTION, GM_AT_MAXIMUM };

struct gm_sweep {
    struct gm_arena *arena; /* owns the texts */
    const struct gm_scene *scene;
    struct gm_words words;
    char *arguments;      /* "SCENE key=value ...", which gives the same sweep */
    char *head;           /* the names of the columns, as a line */
    size_t status, index; /* the numbers of the cells with the status and with a value's index; 0: none has */
    char *measure;        /* the list of observables, if it was given; else NULL */
    size_t count;         /* runs */
    size_t shard, shards; /* the shard to make: runs shard - 1, shard - 1 + shards, ...; 1, 1: all */
    struct gm_chosen chosen; /* observables, one column each */
    /* --values: a run has a row for each of its last `kept` values, else one row */
    const char *values, *at; /* "x:100", and the word of `place`; NULL: one row */
    const char *name;        /* "x" */
    size_t number, kept;     /* a component or, after these, an observable */
    enum gm_sweep_place place;
};

/* The options of a sweep; NULL: not given. */
struct gm_sweep_options {
    const char *measure, *values, *at;
};

/* Reads a scene and its key=value, and the list of observables, by default all, or none with values. Called in a body
   of the arena, which closes the sweep; leaves it with a sentence and an exit status. */
void gm_sweep_open(struct gm_arena *arena, struct gm_sweep *sweep, const struct gm_arguments *arguments,
                   const struct gm_sweep_options *options, int *status);

enum { GM_SWEEP_COSTS = 7 }; /* cells before the observables: status, warning, t, steps, ... */

/* The number of runs of the shard, and the number of its k-th run. */
size_t gm_sweep_shard_runs(const struct gm_sweep *sweep);
size_t gm_sweep_run(const struct gm_sweep *sweep, size_t k);

/* The length of a line's front, if it is that of the run's row; 0: it differs, or out of memory. */
size_t gm_sweep_front(const struct gm_sweep *sweep, size_t run, const char *line);

/* The arguments of `geomint run` for this run. malloc'ed. Returns NULL when out of memory. */
char *gm_sweep_words(const struct gm_sweep *sweep, size_t run);

/* A run's row, or its rows, malloc'ed; NULL if it was interrupted, or when out of memory. */
struct gm_sweep_row {
    char *text;
    bool ok;
    char sentence[GM_MESSAGE]; /* the warning for status ok, the reason for status `refused`, else "" */
};

/* Makes a run. In any thread. */
void gm_sweep_make(const struct gm_sweep *sweep, size_t run, struct gm_sweep_row *row);

/* The sum of a number over all runs of the shard. `of` finds it for a request; only some runs are asked. */
double gm_sweep_total(const struct gm_sweep *sweep,
                      double (*of)(const struct gm_request *request, size_t index));

/* The list of a row's possible statuses, and `warning`, for a row with status ok and a warning. */
extern const char gm_sweep_statuses[];

/* ---- the table ---- */

struct gm_sweep_table;

/* Opens the table to append rows: FILE.csv, for a shard FILE.I-of-N.csv, or standard output if `path` is
   NULL. An incomplete last row of a killed program is cut off. With `retry`, rows with this status are
   recomputed. Called in a body of the arena; leaves it with a sentence, and the table untouched, if that is
   another sweep's or another process writes it. */
struct gm_sweep_table *gm_sweep_table_open(struct gm_arena *arena, const struct gm_sweep *sweep,
                                           const char *path, const char *retry);

struct gm_sweep_sum {
    size_t made, failed;      /* new rows, and those among them whose status is not ok */
    bool unheard;             /* standard output is a pipe without a reader */
    char refusal[GM_MESSAGE]; /* the message of the first refused run, or "" */
    size_t warned;            /* new rows with status ok and a warning */
    size_t first_warned;      /* the run that is the first of them, and its warning */
    char warning[GM_MESSAGE];
};

struct gm_sweep_chart;

/* Makes the runs without a row, `jobs` at once (0: one per core), and appends their rows, also to the
   chart unless it is NULL. Returns false with a sentence if a row could not be written; the rows before it
   are complete. */
bool gm_sweep_table_fill(struct gm_sweep_table *table, size_t jobs, struct gm_sweep_chart *chart,
                         const struct gm_listener *listener, struct gm_sweep_sum *sum, char *message);
bool gm_sweep_table_close(struct gm_sweep_table *table, char *message);

/* "FILE.csv" of the table FILE.csv; "FILE.I-of-N.csv" of its shard I of N. In a body of the arena. */
const char *gm_sweep_shard_path(struct gm_arena *arena, const char *path, size_t shard, size_t shards);

/* ---- shards ---- */

/* Writes the sweep of a table's shards to FILE.csv.sweep, so that they can be joined, in a body of the sweep's
   arena; refuses a file with another sweep. */
void gm_sweep_note(const struct gm_sweep *sweep, const char *path);
/* Opens the sweep of the note FILE.csv.sweep, as gm_sweep_open does. */
void gm_sweep_recall(struct gm_arena *arena, struct gm_sweep *sweep, const char *path);
/* Joins the shards' rows in the order of the runs to FILE.csv, names runs without a row, and returns their number.
   Called in a body of the sweep's arena. */
size_t gm_sweep_join(const struct gm_sweep *sweep, const char *path);

/* ---- the picture ---- */

/* The data of a table's picture: bounded, for any number of rows. One key with several numbers makes a
   graph, two a map; another number of them leaves the body of the arena with a sentence. */
struct gm_sweep_chart *gm_sweep_chart_open(struct gm_arena *arena, const struct gm_sweep *sweep);
bool gm_sweep_is_drawable(const struct gm_sweep *sweep, char *message);
/* Takes the row of a run, or the rows of a table; false with a sentence if that cannot be read. */
void gm_sweep_chart_take(struct gm_sweep_chart *chart, size_t run, const char *row);
bool gm_sweep_chart_read(struct gm_sweep_chart *chart, const char *path, char *message);
void gm_sweep_chart_draw(const void *chart, struct gm_picture *picture);

/* The run that a map shows at (x, y), in the units of its axes; `map` is the panel's number. Returns false
   if the panel does not show a map. */
bool gm_sweep_pick(const struct gm_sweep_chart *chart, size_t map, double x, double y, size_t *run);

#endif
