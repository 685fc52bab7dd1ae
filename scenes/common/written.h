/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_WRITTEN_H
#define GM_SCENES_COMMON_WRITTEN_H

#include "core/model/system.h"
#include "scenes/common/scene.h"

/* Common parts of scenes made from a user's text. */

/* Texts that live as long as their scene. */
struct gm_kept_texts {
    char **list;
    size_t count;
};
/* Adds a malloc'ed text as the last of the list, which then owns it. Returns it; NULL for NULL, and when out
   of memory. */
const char *gm_kept_texts_add(struct gm_kept_texts *texts, char *text);
void gm_kept_texts_close(struct gm_kept_texts *texts);

/* Returns the name with a checksum of the text, to distinguish equal names. The caller frees; NULL when out
   of memory. */
char *gm_written_mark(const char *name, const char *text);

/* A number as it would be typed: the text `given` if it is this number (NULL: no text). Owned by `texts`. */
const char *gm_kept_number(struct gm_kept_texts *texts, double value, const char *given);
/* The row of a system's parameter, or of a start value, with this default; `usual` is its help if it has no
   meaning. */
struct gm_parameter gm_written_row(struct gm_kept_texts *texts, const struct gm_system_variable *variable,
                                   double value, const char *usual, size_t offset);
/* Sets the rows of dt and until: these defaults, and ranges and meanings from the system's lines. Returns
   false when out of memory. */
bool gm_written_timing(struct gm_kept_texts *texts, const struct gm_user_system *system, double dt,
                       double until, struct gm_parameter *dt_row, struct gm_parameter *until_row);

/* Takes the next word of a list separated by blanks or commas, cut off at `size`, and moves *list past it.
   Returns false at its end, or for NULL. */
bool gm_listed_word(const char **list, char *word, size_t size);

/* Applies the options of a system's line to its observable: title, unit, angle, log, missing. */
void gm_written_options(struct gm_observable *observable, const struct gm_system_item *item);

/* Reads the schemes of a list separated by blanks or commas, at most `most`; *count is their number, 0 if the
   text is NULL. Returns false with a sentence if one is unknown or does not fit. */
bool gm_written_schemes(const char *text, const struct gm_problem *problem, const char **schemes, size_t most,
                        size_t *count, char *sentence);

/* 1, 2 or 5 times a power of ten, the nearest in the logarithm: the default of a step or an end. */
double gm_written_rounded(double value);

#endif
