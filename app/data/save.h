/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_SAVE_H
#define GM_APP_DATA_SAVE_H

#include <stdint.h>
#include <stdio.h>

#include "app/output/row.h"
#include "app/words/request.h"
#include "core/run.h"
#include "scenes/common/lane.h"

/* The states of lanes, one lane after the other, as a file that other programs read: .npz, .csv, .pvd with
   .vtu files, .xdmf with .bin files. The file appears when it is complete, but for these two, which grow. */

struct gm_save;

/* Returns true if a format has this file's ending, and one file of it can hold these lanes; false with a
   sentence (GM_MESSAGE bytes). */
bool gm_save_fits(const char *path, const struct gm_request *request, char *message);

/* Begins a file of `lanes` lanes or, with go_on, resumes an interrupted one; resumable: its parts can be
   resumed later. Returns NULL with a sentence. */
struct gm_save *gm_save_open(const char *path, size_t lanes, bool go_on, bool resumable, char *message);

/* The identity of the file's parts, unique and unchanged when they are resumed; 0: they cannot be resumed. */
uint64_t gm_save_identity(const struct gm_save *save);

/* The size of a lane. */
struct gm_save_size {
    uint64_t rows;     /* rows that it already has */
    uint64_t expected; /* the expected number of rows, or 0; a wrong one only costs time */
    size_t meta;       /* approximate bytes of gm_save_end's text, which get room before the disk is full */
};

/* Begins lane `index`; lanes come in their order, and may be left out. Returns false with a sentence, as do the
   following functions. */
bool gm_save_begin(struct gm_save *save, size_t index, const struct gm_run *run,
                   const struct gm_save_size *size, char *message);
/* Adds a row: the current state. */
bool gm_save_row(struct gm_save *save, const struct gm_run *run, char *message);
/* Returns true if the current lane takes many rows in one call of gm_save_rows: times and states, as
   gm_drive_to leaves them. One row per call costs more than a short step. */
bool gm_save_takes_many(const struct gm_save *save);
bool gm_save_rows(struct gm_save *save, const struct gm_run *run, const double *rows, size_t count,
                  char *message);
/* Syncs the current lane's rows, and returns their number, from which gm_save_begin resumes. */
bool gm_save_sync(struct gm_save *save, uint64_t *rows, char *message);
/* Ends the lane; meta: JSON that describes its run. */
bool gm_save_end(struct gm_save *save, const char *meta, char *message);

/* Notes a checkpoint that counts the rows on disk: the file can be resumed. */
void gm_save_keep(struct gm_save *save);
/* Returns true if a row could not be written to a file that cannot be resumed. The file will have the
   earlier rows once this lane has ended, and gm_save_close reports it. */
bool gm_save_is_cut(const struct gm_save *save);

/* Makes the file if `complete` and a lane has begun, and frees; with `keep` the parts stay, to be resumed. */
bool gm_save_close(struct gm_save *save, bool complete, bool keep, char *message);

/* The steps whose state is a row of a run's history, in addition to the start and the end. */
struct gm_rows {
    int64_t every;   /* steps per row; 0: see interval */
    double interval; /* model time per row: the step next to each multiple or, for an adaptive scheme, the
                        first one that reaches it; NAN: every step, unless `every` is set */
};

/* Returns true if every step has a row. */
bool gm_rows_all(const struct gm_rows *rows, const struct gm_run *run);

/* The step of the next row, after the current one. */
int64_t gm_rows_next(const struct gm_rows *rows, const struct gm_run *run);

/* The expected number of rows from the start to step `last`, both included; 0: unknown, for an adaptive
   scheme. */
uint64_t gm_rows_expected(const struct gm_rows *rows, const struct gm_run *run, int64_t last);

/* Returns true if the current step has a row; `before`: the time of the previous step. */
bool gm_rows_due(const struct gm_rows *rows, const struct gm_run *run, double before);

/* The description of a run, as JSON. */

/* A parameter as a cell: a number as such, not as "pi/12". */
void gm_meta_parameter(struct gm_row *row, const struct gm_parameter *parameter, const void *owner);

/* "parameters":{"key":value,...}: every parameter of the lane, those at their defaults too, and of its scheme. */
void gm_meta_parameters(struct gm_row *row, const struct gm_lane *lane);

/* "system":TEXT or "room":TEXT: the text on which the scene was built, if there is one. */
void gm_meta_source(struct gm_row *row, const struct gm_scene *scene);

/* {"scene":...}: scene, scheme, parameters, its end (a status word and a sentence), t, steps, version, and
   the unit of time, the only unit; malloc'ed. Returns NULL when out of memory. */
char *gm_meta_text(const struct gm_lane *lane, const char *status, const char *sentence);

/* The tracks of lanes (trails, crossings of a section ...) as an .npz file: for each track the entries,
   NAME with an axis of entries and one of numbers, and the times, NAME_t. */

struct gm_tracks;

/* Returns true if the file ends in .npz and the scene has tracks; false with a sentence (GM_MESSAGE
   bytes). */
bool gm_tracks_knows(const char *path, const struct gm_scene *scene, char *message);

/* Begins a file of `lanes` lanes; NULL with a sentence. */
struct gm_tracks *gm_tracks_open(const char *path, size_t lanes, char *message);
/* Adds lane `index`, and the description of its run (gm_meta_text). Returns false with a sentence; so does
   the following. */
bool gm_tracks_add(struct gm_tracks *tracks, size_t index, const struct gm_lane *lane, const char *meta,
                   char *message);
/* Puts the file in its place if it is `complete`, and frees. */
bool gm_tracks_close(struct gm_tracks *tracks, bool complete, char *message);

/* The state of a field on a line, one row of CSV per node: x, and each quantity of the nodes. */

/* Returns true if the run's state is such a field. */
bool gm_profile_is_there(const struct gm_run *run);

/* "x,u,..." */
void gm_profile_columns(const struct gm_run *run, FILE *stream);

/* The rows, each beginning with `front`. Returns false when out of memory. */
bool gm_profile_write(const struct gm_run *run, const char *front, FILE *stream);

#endif
