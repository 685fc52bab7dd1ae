/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_WRITTEN_H
#define GM_SCENES_COMMON_WRITTEN_H

#include "core/model/system.h"
#include "scenes/common/scene.h"

/* Common parts of scenes made from a user's text. */

/* Continues a checksum (FNV-1a) with more bytes. */
#define GM_SUM_OF_NOTHING UINT32_C(2166136261)
uint32_t gm_written_sum(uint32_t sum, const void *bytes, size_t size);
/* Returns the name with a checksum of the text, to distinguish equal names. */
const char *gm_written_mark(struct gm_arena *arena, const char *name, const char *text);

/* A number as it would be typed: the text `given` if it is this number (NULL: no text). */
const char *gm_written_number(struct gm_arena *arena, double value, const char *given);
/* The row of a system's parameter, or of a start value, with this default; `usual` is its help if it has no
   meaning. */
struct gm_parameter gm_written_row(struct gm_arena *arena, const struct gm_system_variable *variable,
                                   double value, const char *usual, size_t offset);
/* The row of a system's choice number `i`, whose values are its words. */
struct gm_parameter gm_written_choice(struct gm_arena *arena, const struct gm_user_system *system, size_t i,
                                      const char *usual, size_t offset);
/* Sets the rows of dt and until: these defaults, and ranges and meanings from the system's lines. */
void gm_written_timing(struct gm_arena *arena, const struct gm_user_system *system, double dt, double until,
                       struct gm_parameter *rows);

/* Takes the next word of a list separated by blanks or commas, cut off at `size`, and moves *list past it.
   Returns false at its end, or for NULL. */
bool gm_listed_word(const char **list, char *word, size_t size);

/* Applies the options of a system's line to its observable: title, unit, angle, log, missing. */
void gm_written_options(struct gm_observable *observable, const struct gm_system_item *item);

/* Takes the line work: into a work; what the line leaves out stays. The caller checks the names. */
void gm_written_work(struct gm_work *work, const struct gm_system_item *item);

/* Takes the lines figure: of a system into its scene. */
void gm_written_figures(struct gm_arena *arena, const struct gm_user_system *system, struct gm_scene *scene);

enum { GM_MOST_PREFERRED = 32 };
/* Reads the schemes of a list separated by blanks or commas, at most GM_MOST_PREFERRED. Returns their number,
   0 if the text is NULL. Refuses one that is unknown or does not fit. */
size_t gm_written_schemes(struct gm_arena *arena, const char *text, const struct gm_problem *problem,
                          const char **schemes);

/* 1, 2 or 5 times a power of ten, the nearest in the logarithm: the default of a step or an end. */
double gm_written_rounded(double value);

#endif
