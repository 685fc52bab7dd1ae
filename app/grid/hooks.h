/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_STUDIES_HOOKS_H
#define GM_APP_STUDIES_HOOKS_H

#include "app/grid/grid.h"

/* What the kinds of grids share, and their functions. */

/* ---- layout ---- */

/* The parameters that all lanes share. */
struct gm_timing *gm_grid_timing(const struct gm_grid *grid);

/* Makes room for `most` values of an axis, and for `count` lines; false with a sentence: memory is short. */
bool gm_axis_open(struct gm_grid_axis *axis, size_t most, char *message);
bool gm_grid_lines(struct gm_grid *grid, size_t count, char *message);
/* Adds a value that is not there yet. */
void gm_axis_add(struct gm_grid_axis *axis, double value);
/* Adds a line with room for so many cells; NULL with a sentence. */
struct gm_grid_line *gm_grid_add(struct gm_grid *grid, const struct gm_scheme *scheme, size_t most,
                                 char *message);

/* ---- runs ---- */

/* A lane at its start in these parameters, which it takes: malloc'ed, NULL where memory is short. NULL with a sentence. */
struct gm_lane *gm_grid_start(const struct gm_grid *grid, const struct gm_lane_spec *spec,
                              struct gm_timing *parameters, const struct gm_scheme *scheme, char *message);

/* The lane of a cell at its start, in parameters of its own; settles the cell's dt. NULL with a sentence. */
struct gm_lane *gm_grid_open_lane(const struct gm_grid *grid, const struct gm_scheme *scheme,
                                  struct gm_grid_cell *cell, char *message);

/* Whether a lane is on its way to so many steps, or its end, and nobody stops it. */
bool gm_grid_goes_on(const struct gm_grid *grid, const struct gm_lane *lane, int64_t steps);

/* Makes steps up to so many in all, or to the end of a scheme that chooses them, in bursts that answer an
   interruption; gives up after `most` seconds of the processor. Returns the seconds that it took. */
double gm_grid_advance(const struct gm_grid *grid, struct gm_lane *lane, int64_t steps, double most);

/* Notes how a run ended, and what it cost but for the time. */
void gm_grid_take_end(const struct gm_lane *lane, struct gm_grid_cell *cell);

size_t gm_grid_cells(const struct gm_grid *grid);

/* ---- functions of the rows, each as grid.h says of its place ---- */

bool gm_cells_open(struct gm_grid *grid, const struct gm_arguments *typed, const char *measure,
                   char *message);
bool gm_cells_measure(struct gm_grid *grid, const struct gm_listener *listener, char *message);
bool gm_cells_write(const struct gm_grid *grid, const char *path);
void gm_cells_close(struct gm_grid *grid);

char *gm_work_usual(const struct gm_scene *scene, char *message);
bool gm_work_edit(struct gm_grid *grid, struct gm_arguments *words, char *message);
bool gm_work_lay_out(struct gm_grid *grid, const struct gm_arguments *words, const struct gm_arguments *typed,
                     const char *measure, char *message);
bool gm_work_prepare(struct gm_grid *grid, char *message);
bool gm_work_is_needless(const struct gm_grid *grid, const struct gm_grid_line *line, size_t cell);
void gm_work_run(const struct gm_grid *grid, struct gm_lane *lane, struct gm_grid_cell *cell, char *message);
void gm_work_put(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_cell *cell, int number);
void gm_work_draw(const struct gm_grid *grid, struct gm_picture *picture);

char *gm_stability_usual(const struct gm_scene *scene, char *message);
bool gm_stability_lay_out(struct gm_grid *grid, const struct gm_arguments *words,
                          const struct gm_arguments *typed, const char *judge, char *message);
void gm_stability_run(const struct gm_grid *grid, struct gm_lane *lane, struct gm_grid_cell *cell,
                      char *message);
void gm_stability_put(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_cell *cell,
                      int number);
void gm_stability_draw(const struct gm_grid *grid, struct gm_picture *picture);

char *gm_backward_usual(const struct gm_scene *scene, char *message);
bool gm_backward_lay_out(struct gm_grid *grid, const struct gm_arguments *words,
                         const struct gm_arguments *typed, const char *measure, char *message);
void gm_backward_run(const struct gm_grid *grid, struct gm_lane *lane, struct gm_grid_cell *cell,
                     char *message);
void gm_backward_put(struct gm_row *row, const struct gm_grid *grid, const struct gm_grid_cell *cell,
                     int number);
void gm_backward_draw(const struct gm_grid *grid, struct gm_picture *picture);

bool gm_sweep_grid_open(struct gm_grid *grid, const struct gm_arguments *typed, const char *measure,
                        char *message);
bool gm_sweep_grid_measure(struct gm_grid *grid, const struct gm_listener *listener, char *message);
void gm_sweep_grid_draw(const struct gm_grid *grid, struct gm_picture *picture);
bool gm_sweep_grid_write(const struct gm_grid *grid, const char *path);
void gm_sweep_grid_close(struct gm_grid *grid);
char *gm_sweep_grid_pick(const struct gm_grid *grid, size_t panel, double x, double y);

#endif
