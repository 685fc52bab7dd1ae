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

/* Whether there is a format of this file's ending, and these lanes go into one file of it; false with a
   sentence (GM_MESSAGE bytes). */
bool gm_save_fits(const char *path, const struct gm_request *request, char *message);

/* Begins a file of `lanes` lanes or, with go_on, one that was interrupted; resumable: it can be gone on with
   later from what it is made of. NULL with a sentence. */
struct gm_save *gm_save_open(const char *path, size_t lanes, bool go_on, bool resumable, char *message);

/* The number of what the file is made of, which stays while it is gone on with, and that no other making of a
   file has; 0: it is not resumable. */
uint64_t gm_save_identity(const struct gm_save *save);

/* Lane `index` begins, with its first `rows` rows already there; lanes come in their order, and may be left
   out. expected: how many rows it will have, or 0; where that turns out otherwise it only costs time. meta:
   about how many bytes gm_save_end will be given, which are to have room on a disk that is full by then. False
   with a sentence; so are the following. */
bool gm_save_begin(struct gm_save *save, size_t index, const struct gm_run *run, uint64_t rows,
                   uint64_t expected, size_t meta, char *message);
/* A row: the state now. */
bool gm_save_row(struct gm_save *save, const struct gm_run *run, char *message);
/* Whether the present lane takes many rows at once, and these: times and states, as gm_drive_to leaves them.
   A row by itself costs more than a short step. */
bool gm_save_takes_many(const struct gm_save *save);
bool gm_save_rows(struct gm_save *save, const struct gm_run *run, const double *rows, size_t count,
                  char *message);
/* The rows of the present lane, safe on the disk: what gm_save_begin goes on from. */
bool gm_save_sync(struct gm_save *save, uint64_t *rows, char *message);
/* The lane is over; meta: JSON that says what it was. */
bool gm_save_end(struct gm_save *save, const char *meta, char *message);

/* There is a checkpoint that counts the rows which were made safe: the file can be gone on with. */
void gm_save_keep(struct gm_save *save);
/* Whether a row could not be written, of a file that cannot be gone on with: it will have those that could,
   once this lane has ended, and gm_save_close says so. */
bool gm_save_is_cut(const struct gm_save *save);

/* Makes the file if `complete` and any lane has begun, and frees; what it was made of stays with `keep`, to
   be gone on with. */
bool gm_save_close(struct gm_save *save, bool complete, bool keep, char *message);

/* After which steps a run's history and states have a row, beside its start and its end. */
struct gm_rows {
    int64_t every;   /* every so many steps; 0: see interval */
    double interval; /* the steps next to its multiples of model time, or, where the scheme chooses its step,
                        the first ones that reach them; NAN: every step, unless `every` says otherwise */
};

/* Whether every step has one. */
bool gm_rows_all(const struct gm_rows *rows, const struct gm_run *run);

/* The step of the next row, after the present one. */
int64_t gm_rows_next(const struct gm_rows *rows, const struct gm_run *run);

/* How many rows there will be from the start of the run to its step `last`, both with a row, if nothing comes
   between; 0: the scheme chooses its steps, and nobody knows. */
uint64_t gm_rows_expected(const struct gm_rows *rows, const struct gm_run *run, int64_t last);

/* Whether the present step has a row; `before` is the time before it. */
bool gm_rows_due(const struct gm_rows *rows, const struct gm_run *run, double before);

/* What was run, as JSON. */

/* "parameters":{"key":value,...}: every parameter of the lane, those at their defaults too, and of its scheme. */
void gm_meta_parameters(struct gm_row *row, const struct gm_lane *lane);

/* "system":TEXT or "room":TEXT: what the scene was made of, where it was made of a text. */
void gm_meta_source(struct gm_row *row, const struct gm_scene *scene);

/* {"scene":...}: scene, scheme, parameters, how it ended (a status word and a sentence), t, steps, version,
   and the unit of time, the only one that there is; malloc'ed, NULL when memory is short. */
char *gm_meta_text(const struct gm_lane *lane, const char *status, const char *sentence);

/* What lanes have recorded on their way (trails, crossings of a section ...) as an .npz file: of each track
   the entries, NAME with an axis of entries and one of numbers, and the times, NAME_t. */

struct gm_tracks;

/* Whether the file ends in .npz and the scene has tracks; false with a sentence (GM_MESSAGE bytes). */
bool gm_tracks_knows(const char *path, const struct gm_scene *scene, char *message);

/* Begins a file of `lanes` lanes; NULL with a sentence. */
struct gm_tracks *gm_tracks_open(const char *path, size_t lanes, char *message);
/* Adds lane `index`, and what was run (gm_meta_text). False with a sentence; so is the following. */
bool gm_tracks_add(struct gm_tracks *tracks, size_t index, const struct gm_lane *lane, const char *meta,
                   char *message);
/* Puts the file in its place if it is `complete`, and frees. */
bool gm_tracks_close(struct gm_tracks *tracks, bool complete, char *message);

/* The state of a field on a line, a row of CSV a node: x, and each quantity that the nodes have. */

/* Whether the run's state is such a field. */
bool gm_profile_is_there(const struct gm_run *run);

/* "x,u,..." */
void gm_profile_columns(const struct gm_run *run, FILE *stream);

/* The rows, each beginning with `front`. False when memory is short. */
bool gm_profile_write(const struct gm_run *run, const char *front, FILE *stream);

#endif
