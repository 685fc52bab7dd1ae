/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_GRID_SWEEP_H
#define GM_APP_GRID_SWEEP_H

#include <stdbool.h>
#include <stddef.h>

#include "app/base/arguments.h"
#include "app/words/names.h"
#include "app/words/request.h"
#include "app/words/words.h"

/* Long work tells how far it is, and asks whether to go on. */
struct gm_listener {
    bool (*stopped)(void *self); /* NULL: never */
    /* `what` is under way, `done` of `all` parts are finished and may be looked at; NULL: nobody listens */
    void (*report)(void *self, const char *what, size_t done, size_t all);
    void *self;
};

/* Whether to stop: asked for by the listener, or by a signal. `listener` may be NULL. */
bool gm_listener_stops(const struct gm_listener *listener);
void gm_listener_hears(const struct gm_listener *listener, const char *what, size_t done, size_t all);

/* For commands: a line on standard error if that is a terminal, which gm_terminal_listener_clear removes. */
extern const struct gm_listener gm_terminal_listener;
void gm_terminal_listener_clear(void);

/* A sweep: a run for every combination of the values of its keys, and a row of a table for every run. Runs
   are numbered from 0, the first list changes slowest, and made from their number alone: nothing is stored of
   them. In the table they stand in this order, so that a row's key is its place, and its cells up to
   `status`, in full precision, have to be those of the run with this number. */

struct gm_sweep {
    const struct gm_scene *scene;
    struct gm_words words;
    char *arguments;      /* "SCENE key=value ...", which reads as the same sweep */
    char *head;           /* the names of the columns, as a line */
    char *measure;        /* the observables as a list, where they were chosen; else NULL */
    size_t count;         /* runs */
    size_t shard, shards; /* of the share that is made: runs shard - 1, shard - 1 + shards, ...; 1, 1: all */
    bool unreadable;      /* why it is not open: because of a file */
    struct gm_chosen chosen; /* observables, which have a column each */
};

/* Reads a scene and its key=value, and a list of observables, or NULL for all. False with a sentence
   (GM_MESSAGE bytes). To be closed in both cases. */
bool gm_sweep_open(struct gm_sweep *sweep, const struct gm_arguments *arguments, const char *measure,
                   char *message);
void gm_sweep_close(void *sweep);

/* How many runs the share has, and the number of its k-th. */
size_t gm_sweep_share(const struct gm_sweep *sweep);
size_t gm_sweep_run(const struct gm_sweep *sweep, size_t k);

/* How many letters a line begins with as the row of a run does; 0: it begins otherwise, or memory is short. */
size_t gm_sweep_front(const struct gm_sweep *sweep, size_t run, const char *line);

/* How `geomint run` would be asked for the run. malloc'ed, NULL when memory is short. */
char *gm_sweep_words(const struct gm_sweep *sweep, size_t run);

/* A run's row, malloc'ed; NULL where it was interrupted or memory is short. */
struct gm_sweep_row {
    char *text;
    bool ok; /* its status is `ok` */
    char sentence
        [GM_MESSAGE]; /* the warning of one that is ok, why one with the status `refused` cannot be asked
                                  for, else "" */
};

/* Makes a run. In any thread. */
void gm_sweep_make(const struct gm_sweep *sweep, size_t run, struct gm_sweep_row *row);

/* The sum over all runs of the share of a number that `of` finds for a request, judged by some of them. */
double gm_sweep_total(const struct gm_sweep *sweep,
                      double (*of)(const struct gm_request *request, size_t index));

/* The words that a row's status may be, and `warning`, of one that is ok with a warning: as a list. */
extern const char gm_sweep_statuses[];

/* ---- the table ---- */

struct gm_sweep_table;

/* Opens the table for rows at its end: FILE.csv, of a share FILE.I-of-N.csv, or where `path` is NULL standard
   output. What a killed program left of a last row is cut off. With `retry`, rows of this status are made
   anew. NULL with a sentence: it is of another sweep, or another process writes it; it is untouched then. */
struct gm_sweep_table *gm_sweep_table_open(const struct gm_sweep *sweep, const char *path, const char *retry,
                                           char *message);
const char *gm_sweep_table_path(const struct gm_sweep_table *table);

struct gm_sweep_sum {
    size_t made, failed;      /* rows now, and those of them whose status is not ok */
    bool unheard;             /* standard output is a pipe that nobody reads */
    char refusal[GM_MESSAGE]; /* of the first run that was refused; "" */
    size_t warned;            /* rows now that are ok, with a warning */
    size_t first_warned;      /* the run that is the first of them, and its warning */
    char warning[GM_MESSAGE];
};

struct gm_sweep_chart;

/* Makes the runs that the table has no row of, `jobs` at once (0: one a core), and appends their rows, which a chart
   takes, too, where it is not NULL. False with a sentence if a row could not be written; those before it are there. */
bool gm_sweep_table_fill(struct gm_sweep_table *table, size_t jobs, struct gm_sweep_chart *chart,
                         const struct gm_listener *listener, struct gm_sweep_sum *sum, char *message);
bool gm_sweep_table_close(struct gm_sweep_table *table, char *message);

/* "FILE.csv" of a table; of a share "FILE.I-of-N.csv". malloc'ed, NULL when memory is short. */
char *gm_sweep_share_path(const char *path, size_t shard, size_t shards);

/* ---- shares ---- */

/* Notes beside a table which sweep its shares belong to, FILE.csv.sweep, so that they can be joined. False
   with a sentence if it says another one already. */
bool gm_sweep_note(const struct gm_sweep *sweep, const char *path, char *message);
/* Opens the sweep that FILE.csv.sweep tells of. */
bool gm_sweep_recall(struct gm_sweep *sweep, const char *path, char *message);
/* Joins the shares' rows in the order of the runs to FILE.csv; for each run without a row `missing` is told
   how it is asked for. False with a sentence. */
bool gm_sweep_join(const struct gm_sweep *sweep, const char *path,
                   void (*missing)(size_t run, const char *words), size_t *missing_count, char *message);

/* ---- the picture ---- */

/* What a picture needs of a table: bounded, however many rows. One key with several numbers makes a graph, two a map.
   NULL with a sentence where there is another number of them. */
struct gm_sweep_chart *gm_sweep_chart_open(const struct gm_sweep *sweep, char *message);
bool gm_sweep_is_drawable(const struct gm_sweep *sweep, char *message);
/* Takes the row of a run, or those of a table; false with a sentence where that cannot be read. */
void gm_sweep_chart_take(struct gm_sweep_chart *chart, size_t run, const char *row);
bool gm_sweep_chart_read(struct gm_sweep_chart *chart, const char *path, char *message);
void gm_sweep_chart_close(void *chart);
void gm_sweep_chart_draw(const struct gm_sweep_chart *chart, struct gm_picture *picture);

/* The run that a map shows at (x, y), in the units of its axes; `map` is its number among the panels. False
   where that is no map. */
bool gm_sweep_pick(const struct gm_sweep_chart *chart, size_t map, double x, double y, size_t *run);

#endif
