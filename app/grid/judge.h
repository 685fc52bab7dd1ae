/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_GRID_JUDGE_H
#define GM_APP_GRID_JUDGE_H

#include "app/grid/grid.h"

/* What the cells of a grid say together. */

/* ---- stability ---- */

/* What is asked: "bounded" or "accurate"; and in a sentence, "accurate to 0.01 (position_error)". */
const char *gm_stability_judge(const struct gm_grid *grid);
const char *gm_stability_question(const struct gm_grid *grid, char *text, size_t size);

/* That word, "lost", ... or the status' name; and a letter for the map. */
const char *gm_cell_word(const struct gm_grid *grid, const struct gm_grid_cell *cell);
char gm_cell_letter(const struct gm_grid_cell *cell);

/* The letters in use, but that of what is asked: "W wrong, M mesh-crossing". Returns text. */
const char *gm_stability_letters(const struct gm_grid *grid, char *text, size_t size);

/* The largest step, in the plan's unit, up to which a scheme is as asked for all values; 0: none. NAN
   where cells that were not tried leave it open. */
double gm_stability_limit(const struct gm_grid *grid, const struct gm_grid_line *line);

/* ---- work-precision ---- */

double gm_work_cost(const struct gm_grid_cell *cell, enum gm_cost cost);

/* Copies to `best`, of `count` places, the cells that are cheaper than all that are as accurate, by rising
   cost. Returns their number. */
size_t gm_work_keep_best(const struct gm_grid_cell *cells, size_t count, enum gm_cost cost,
                         struct gm_grid_cell *best);

/* The cells that a line is drawn and priced by. */
const struct gm_grid_cell *gm_work_front(const struct gm_grid_line *line, enum gm_cost cost, size_t *count);

/* The second cost that schemes are compared by, beside the run time; and what an error costs so, as it is printed. */
enum gm_cost gm_work_second_cost(const struct gm_grid *grid);
double gm_work_second_price(const struct gm_grid *grid, const struct gm_grid_line *line, double error);

/* What a scheme pays for this error, interpolated between two cells of its front; NAN if it does not reach
   it. */
double gm_work_price(const struct gm_grid_line *line, double error, enum gm_cost cost);

/* The line that is cheapest at this error; NULL if none reaches it. */
const struct gm_grid_line *gm_work_cheapest(const struct gm_grid *grid, double error, enum gm_cost cost);

/* "Cheapest by run time: ..." */
const char *gm_work_sentence(const struct gm_grid *grid, char *text, size_t size);

#endif
