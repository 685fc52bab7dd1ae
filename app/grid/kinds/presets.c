/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of grids, as rows of functions. */
#include <string.h>

#include "app/grid/grid.h"
#include "core/arena.h"

const struct gm_study_row *const gm_study_rows[GM_STUDY_COUNT] = {[GM_STUDY_WORK] = &gm_study_work,
                                                                  [GM_STUDY_STABILITY] = &gm_study_stability,
                                                                  [GM_STUDY_BACKWARD] = &gm_study_backward,
                                                                  [GM_STUDY_SWEEP] = &gm_study_sweep};

enum gm_study_kind gm_study_find(const char *name)
{
    int kind = GM_STUDY_COUNT - 1;
    while (kind > GM_STUDY_NONE && strcmp(gm_study_rows[kind]->name, name) != 0) {
        kind--;
    }
    return (enum gm_study_kind)kind;
}

static void open(struct gm_arena *arena, void *data)
{
    struct gm_grid *grid = data;
    (void)arena;
    (grid->row->open ? grid->row->open : gm_cells_open)(grid);
}

bool gm_grid_open(struct gm_grid *grid, enum gm_study_kind kind, const struct gm_arguments *arguments,
                  const char *measure, char *message)
{
    *grid = (struct gm_grid){
        .row = gm_study_rows[kind], .arena = gm_arena_open(), .typed = arguments, .requested = measure};
    if (gm_arena_run(grid->arena, open, grid)) {
        return true;
    }
    const int refusal = grid->request.refusal;
    gm_refuse(message, "%s", gm_arena_reason(grid->arena));
    gm_grid_close(grid);
    grid->request.refusal = refusal;
    return false;
}
