/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the commands that are studies of the explorer too have in common: all but how they print. */
#include "app/commands/measuring/studied.h"

#include <stdio.h>

#include "app/base/interrupt.h"
#include "app/base/pool.h"
#include "app/commands/confirmed.h"
#include "app/commands/measuring/charted.h"
#include "app/output/say.h"
#include "core/memory.h"

static void print_json(const struct gm_grid *grid, const struct gm_study_printer *printer)
{
    for (size_t i = 0; i < grid->begun; i++) {
        struct gm_row row = gm_row_begin(stdout);
        gm_row_text(&row, "scene", grid->request.scene->name);
        gm_row_text(&row, "scheme", grid->lines[i].scheme->name);
        if (grid->row->ordered) {
            gm_row_count(&row, "order", grid->lines[i].scheme->order);
        }
        printer->put_front(&row, grid, &grid->lines[i]);
        gm_grid_put_cells(grid, &grid->lines[i], printer->cells, &row);
        if (printer->put_end) {
            printer->put_end(&row, grid, &grid->lines[i]);
        }
        gm_row_close(&row);
        putchar('\n');
    }
}

int gm_command_study(const struct gm_options *options, enum gm_study_kind kind,
                     const struct gm_study_printer *printer)
{
    char message[GM_MESSAGE], name[128];
    const struct gm_study_row *study = &gm_study_rows[kind];
    struct gm_grid grid;
    if (!gm_grid_open(&grid, kind, &options->arguments, options->judge ? options->judge : options->measure,
                      message)) {
        gm_complain("%s", message);
        return gm_request_refusal(&grid.request);
    }
    if (!gm_command_confirmed(options, &grid.request)) {
        gm_grid_close(&grid);
        return GM_EXIT_USAGE;
    }
    grid.jobs = options->jobs > 0 ? (size_t)options->jobs : gm_pool_cores();
    gm_catch_interrupts();
    int status = GM_EXIT_OK;
    const bool measured = gm_grid_measure(&grid, &gm_terminal_listener, message);
    gm_terminal_listener_clear();
    if (gm_memory_was_short()) {
        gm_complain("not enough memory to measure what was asked for");
        status = GM_EXIT_MEMORY;
    } else if (measured) {
        if (options->json) {
            print_json(&grid, printer);
        } else if (!gm_options_take_stdout(options)) {
            printer->print(&grid);
        }
        snprintf(name, sizeof name, "%s-%s", grid.request.scene->name, study->name);
        status = gm_command_chart(options, study->name, name, &grid, gm_grid_draw, gm_grid_write);
    } else if (!gm_interrupted) {
        gm_complain("%s", message);
        status = study->refusal;
    }
    gm_grid_close(&grid);
    return gm_finish(gm_interrupted ? GM_EXIT_INTERRUPTED : status);
}
