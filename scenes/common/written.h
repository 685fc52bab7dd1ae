/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_WRITTEN_H
#define GM_SCENES_COMMON_WRITTEN_H

#include "core/model/system.h"
#include "scenes/common/scene.h"

/* What scenes that are made of somebody's own text have in common. */

/* Texts that are made for a scene, and last as long. */
struct gm_kept_texts {
    char **list;
    size_t count;
};
/* Keeps a malloc'ed text, as the last of the list. NULL stays NULL; so is one for which memory is short. */
const char *gm_kept_texts_add(struct gm_kept_texts *texts, char *text);
void gm_kept_texts_close(struct gm_kept_texts *texts);

/* The name with a checksum of the text, which tells two of one name apart; malloc'ed, NULL: no memory. */
char *gm_written_mark(const char *name, const char *text);

/* A number as it would be typed: the given text where that is this number, NULL: there is none. */
const char *gm_kept_number(struct gm_kept_texts *texts, double value, const char *given);
/* The row of a system's parameter, or of where it starts, with this default; without a meaning of its own it is the
   usual one. */
struct gm_parameter gm_written_row(struct gm_kept_texts *texts, const struct gm_system_variable *variable,
                                   double value, const char *usual, size_t offset);
/* The rows of dt and until with these defaults, and what a system's lines say of their ranges and meanings. */
bool gm_written_timing(struct gm_kept_texts *texts, const struct gm_user_system *system, double dt,
                       double until, struct gm_parameter *dt_row, struct gm_parameter *until_row);

/* The next word of a list by blanks or commas, cut off where it is longer than the room for it, and the list goes on
   behind it; false at its end, or of NULL. */
bool gm_listed_word(const char **list, char *word, size_t size);

/* What the options of a line of a system say of its observable: title, unit, angle, log, missing. */
void gm_written_options(struct gm_observable *observable, const struct gm_system_item *item);

/* The schemes that a text names, by blanks or commas, at most `most`; their number is *count, 0 where the
   text is NULL. False with a sentence where one is unknown or does not fit. */
bool gm_written_schemes(const char *text, const struct gm_problem *problem, const char **schemes, size_t most,
                        size_t *count, char *sentence);

/* 1, 2 or 5 times a power of ten, the nearest in the logarithm: what a step, or an end, is where nothing
   tells one. */
double gm_written_rounded(double value);

#endif
