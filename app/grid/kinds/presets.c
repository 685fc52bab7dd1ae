/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of grids, as rows of functions. */
#include "app/grid/hooks.h"

#include <string.h>

#include "app/grid/judge.h"

const struct gm_study_row gm_study_rows[GM_STUDY_COUNT] = {
    [GM_STUDY_WORK] = {.name = "work-precision",
                       .refusal = GM_EXIT_NUMERICAL,
                       .open = gm_cells_open,
                       .measure = gm_cells_measure,
                       .draw = gm_work_draw,
                       .write = gm_cells_write,
                       .close = gm_cells_close,
                       .which = "work-precision of which scene? See geomint list scenes",
                       .schemes = 1,
                       .usual = gm_work_usual,
                       .edit = gm_work_edit,
                       .lay_out = gm_work_lay_out,
                       .alone = true,
                       .prepare = gm_work_prepare,
                       .is_needless = gm_work_is_needless,
                       .run = gm_work_run,
                       .conclude = gm_work_conclude,
                       .ordered = true,
                       .rows = 1,
                       .put_cell = gm_work_put},
    [GM_STUDY_STABILITY] = {.name = "stability",
                            .refusal = GM_EXIT_USAGE,
                            .open = gm_cells_open,
                            .measure = gm_cells_measure,
                            .draw = gm_stability_draw,
                            .write = gm_cells_write,
                            .close = gm_cells_close,
                            .which = "stability of which scene? Or --region SCHEME",
                            .schemes = GM_RUN_SCHEMES,
                            .usual = gm_stability_usual,
                            .lay_out = gm_stability_lay_out,
                            .run = gm_stability_run,
                            .rows = 1,
                            .put_cell = gm_stability_put},
    [GM_STUDY_BACKWARD] = {.name = "backward",
                           .refusal = GM_EXIT_USAGE,
                           .open = gm_cells_open,
                           .measure = gm_cells_measure,
                           .draw = gm_backward_draw,
                           .write = gm_cells_write,
                           .close = gm_cells_close,
                           .which = "backward error of which scene?",
                           .schemes = 1,
                           .usual = gm_backward_usual,
                           .lay_out = gm_backward_lay_out,
                           .run = gm_backward_run,
                           .conclude = gm_backward_conclude,
                           .rows = GM_POWERS,
                           .put_cell = gm_backward_put},
    [GM_STUDY_SWEEP] = {.name = "sweep",
                        .refusal = GM_EXIT_USAGE,
                        .open = gm_sweep_grid_open,
                        .measure = gm_sweep_grid_measure,
                        .draw = gm_sweep_grid_draw,
                        .write = gm_sweep_grid_write,
                        .close = gm_sweep_grid_close,
                        .pick = gm_sweep_grid_pick},
};

enum gm_study_kind gm_study_find(const char *name)
{
    int kind = GM_STUDY_COUNT - 1;
    while (kind > GM_STUDY_NONE && strcmp(gm_study_rows[kind].name, name) != 0) {
        kind--;
    }
    return (enum gm_study_kind)kind;
}

bool gm_grid_open(struct gm_grid *grid, enum gm_study_kind kind, const struct gm_arguments *arguments,
                  const char *measure, char *message)
{
    *grid = (struct gm_grid){.row = &gm_study_rows[kind]};
    return grid->row->open(grid, arguments, measure, message);
}

bool gm_grid_measure(struct gm_grid *grid, const struct gm_listener *listener, char *message)
{
    return grid->row->measure(grid, listener, message);
}

void gm_grid_close(struct gm_grid *grid)
{
    grid->row->close(grid);
}

void gm_grid_draw(const void *grid, struct gm_picture *picture)
{
    ((const struct gm_grid *)grid)->row->draw(grid, picture);
}

bool gm_grid_write(const void *grid, const char *path)
{
    return ((const struct gm_grid *)grid)->row->write(grid, path);
}
