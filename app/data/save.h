/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_SAVE_H
#define GM_APP_DATA_SAVE_H

#include <stdint.h>

#include "app/words/request.h"
#include "core/run.h"

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

#endif
