/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_GRID_HOOKS_H
#define GM_APP_GRID_HOOKS_H

#include "app/grid/grid.h"

/* The common functions of the kinds of grids, and the kinds. */

/* ---- layout ---- */

/* Adds a value that is not there yet. */
void gm_axis_add(struct gm_grid_axis *axis, double value);
/* The line of a scheme, or NULL. */
struct gm_grid_line *gm_grid_find(const struct gm_grid *grid, const struct gm_scheme *scheme);
/* Adds a line with room for `most` cells. */
struct gm_grid_line *gm_grid_add(struct gm_grid *grid, const struct gm_scheme *scheme, size_t most);

/* ---- runs ---- */

/* A lane at its start, which takes the malloc'ed parameters, or NULL when out of memory. Returns NULL with
   a sentence. */
struct gm_lane *gm_grid_start(const struct gm_grid *grid, const struct gm_lane_spec *spec,
                              struct gm_timing *parameters, const struct gm_scheme *scheme, char *message);

/* The lane of a cell at its start, with its own parameters; sets the cell's dt. Returns NULL with a
   sentence. */
struct gm_lane *gm_grid_open_lane(const struct gm_grid *grid, const struct gm_scheme *scheme,
                                  struct gm_grid_cell *cell, char *message);

/* Returns true if a lane has reached neither `steps` steps nor its end, and no stop is requested. */
bool gm_grid_goes_on(const struct gm_grid *grid, const struct gm_lane *lane, int64_t steps);

/* Advances to `steps` steps in all, or to the end of an adaptive scheme, in bursts that answer an
   interruption; gives up after `most` seconds of CPU time. Returns the seconds used. */
double gm_grid_advance(const struct gm_grid *grid, struct gm_lane *lane, int64_t steps, double most);

/* Notes the end of a run, and its costs except the time. */
void gm_grid_take_end(const struct gm_lane *lane, struct gm_grid_cell *cell);

size_t gm_grid_cells(const struct gm_grid *grid);

/* ---- the kinds ---- */

extern const struct gm_study_row gm_study_work, gm_study_stability, gm_study_backward, gm_study_sweep;

/* The functions of kinds that have cells; grid.h describes them. */
void gm_cells_open(struct gm_grid *grid);
void gm_cells_measure(struct gm_grid *grid);
bool gm_cells_write(const struct gm_grid *grid, FILE *csv);

/* ---- tables ---- */

/* Prints a cell of a table, with a dash as wide as the number for one that is not finite. */
__attribute__((format(printf, 1, 0))) void gm_print_number(const char *format, int width, double value);

/* ---- work-precision ---- */

double gm_work_cost(const struct gm_grid_cell *cell, enum gm_cost cost);
/* The cells that make up a line's curve and costs. */
const struct gm_grid_cell *gm_work_front(const struct gm_grid_line *line, enum gm_cost cost, size_t *count);
/* The second cost for comparing schemes, after the run time. */
enum gm_cost gm_work_second_cost(const struct gm_grid *grid);
/* "Cheapest by run time: ..." */
const char *gm_work_sentence(const struct gm_grid *grid, char *text, size_t size);

void gm_work_draw(const struct gm_grid *grid, struct gm_picture *picture);
void gm_work_print(const struct gm_grid *grid);
void gm_work_put_front(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line);
void gm_work_put_end(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_line *line);

#endif
