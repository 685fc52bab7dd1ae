/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The common part of the commands that measure: diagrams and tables by options, and, for the explorer's
   studies, everything but the printing. */

#include <stdio.h>
#include <stdlib.h>

#include "app/base/interrupt.h"
#include "app/base/pool.h"
#include "app/commands/commands.h"
#include "app/output/printer.h"
#include "app/output/provenance.h"
#include "app/output/say.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/memory.h"

/* "stability kepler dt=0.1": the words for `again`. */
static const char *command_line(const char *command, const struct gm_options *options)
{
    struct gm_arena *arena = options->arena;
    const struct {
        const char *name, *value;
    } rows[] = {{"--measure", options->measure},
                {"--region", options->region},
                {"--judge", options->judge},
                {"--values", options->values},
                {"--at", options->place}};
    struct gm_arguments *all = gm_arguments_in(arena);
    if (options->on) {
        gm_arguments_append(all, (char *[]){GM_ON, (char *)options->on}, 2);
    }
    gm_arena_need(arena, gm_arguments_append(all, options->arguments.words, options->arguments.count));
    const char *words = gm_arena_keep(arena, gm_arguments_join(command, all), free);
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        words = rows[i].value ? gm_arena_print(arena, "%s %s %s", words, rows[i].name, rows[i].value) : words;
    }
    return words;
}

int gm_command_chart(const struct gm_options *options, const char *command, struct gm_chart *chart)
{
    char message[GM_MESSAGE];
    chart->path = options->output;
    chart->folder = options->out;
    chart->name = options->name ? options->name : chart->name;
    chart->command = command_line(command, options);
    chart->print = (struct gm_print){.format = options->format, .look = options->look};
    if (!gm_chart_write(chart, message)) {
        return gm_printer_fail(options->output, message);
    }
    gm_printer_report(&chart->print, chart->write ? chart->csv : "");
    return GM_EXIT_OK;
}

int gm_command_study(const struct gm_options *options, enum gm_study_kind kind)
{
    char message[GM_MESSAGE], name[128];
    const struct gm_study_row *study = gm_study_rows[kind];
    struct gm_grid *grid = gm_arena_take(options->arena, 1, sizeof *grid);
    if (!gm_grid_open(grid, kind, &options->arguments, options->judge ? options->judge : options->measure,
                      message)) {
        gm_command_end(options, gm_request_refusal(&grid->request), "%s", message);
    }
    gm_arena_keep(options->arena, grid, gm_grid_close);
    gm_command_confirm(options, &grid->request);
    grid->jobs = options->jobs > 0 ? (size_t)options->jobs : gm_pool_cores();
    gm_catch_interrupts();
    int status = GM_EXIT_OK;
    const bool measured = gm_grid_measure(grid, &gm_terminal_listener, message);
    gm_terminal_listener_clear();
    if (gm_memory_was_short()) {
        gm_command_end(options, GM_EXIT_MEMORY, "not enough memory to measure what was asked for");
    } else if (measured) {
        if (options->json || !gm_options_take_stdout(options)) {
            gm_grid_print(grid, options->json);
        }
        snprintf(name, sizeof name, "%s-%s", grid->request.scene->name, study->name);
        status = gm_command_chart(
            options, study->name,
            &(struct gm_chart){.name = name, .data = grid, .draw = gm_grid_draw, .write = gm_grid_write});
    } else if (!gm_interrupted) {
        status = gm_give_up(study->refusal, "%s", message);
    }
    return gm_interrupted ? GM_EXIT_INTERRUPTED : status;
}

int gm_command_backward(const struct gm_options *options)
{
    return gm_command_study(options, GM_STUDY_BACKWARD);
}

int gm_command_work_precision(const struct gm_options *options)
{
    return gm_command_study(options, GM_STUDY_WORK);
}
