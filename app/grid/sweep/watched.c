/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep that is looked at while it is made, in the explorer and in tours: its picture grows with its table. */

#include <errno.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "app/grid/grid.h"
#include "core/arena.h"
#include "render/message.h"

enum { MOST_RUNS = 100000 };

static void close_table(void *grid)
{
    close(((const struct gm_grid *)grid)->table);
}

static void open_grid(struct gm_grid *grid)
{
    const struct gm_arguments *typed = grid->typed;
    const char *measure = grid->requested;
    int status;
    struct gm_arguments *others = gm_arguments_in(grid->arena);
    for (int i = 0; i < typed->count; i++) { /* --measure LIST is among the words */
        if (strcmp(typed->words[i], "--measure") == 0 && i + 1 < typed->count) {
            measure = typed->words[++i];
        } else {
            gm_arena_need(grid->arena, gm_arguments_add(others, typed->words[i]));
        }
    }
    gm_sweep_open(grid->arena, &grid->sweep, others, &(struct gm_sweep_options){.measure = measure}, &status);
    grid->chart = gm_sweep_chart_open(grid->arena, &grid->sweep);
    gm_arena_refuse_if(grid->arena, grid->sweep.count > MOST_RUNS,
                       "these are %zu runs, and %d are the most here: `geomint sweep` makes them",
                       grid->sweep.count, MOST_RUNS);
    grid->table = memfd_create("sweep", MFD_CLOEXEC);
    gm_arena_refuse_if(grid->arena, grid->table < 0, "no room for a table: %s", strerror(errno));
    gm_arena_keep(grid->arena, grid, close_table);
}

static void measure(struct gm_grid *grid)
{
    char path[32], message[GM_MESSAGE];
    struct gm_sweep_sum sum;
    snprintf(path, sizeof path, "/proc/self/fd/%d", grid->table); /* the process itself has it by this path */
    struct gm_sweep_table *table = gm_sweep_table_open(grid->arena, &grid->sweep, path, NULL);
    gm_arena_check(grid->arena,
                   gm_sweep_table_fill(table, 0, grid->chart, grid->listener, &sum, message) &&
                       gm_sweep_table_close(table, message),
                   message);
}

static void draw(const struct gm_grid *grid, struct gm_picture *picture)
{
    gm_sweep_chart_draw(grid->chart, picture);
}

static bool write_table(const struct gm_grid *grid, FILE *file)
{
    char block[1 << 14];
    ssize_t got = 0;
    for (off_t at = 0; (got = pread(grid->table, block, sizeof block, at)) > 0; at += got) {
        fwrite(block, 1, (size_t)got, file);
    }
    return got == 0;
}

static char *pick(const struct gm_grid *grid, size_t panel, double x, double y)
{
    static const char command[] = "run ";
    size_t run;
    char *words = gm_sweep_pick(grid->chart, panel, x, y, &run) ? gm_sweep_words(&grid->sweep, run) : NULL;
    if (words) {
        memmove(words, words + strlen(command), strlen(words) - strlen(command) + 1);
    }
    return words;
}

const struct gm_study_row gm_study_sweep = {.name = "sweep",
                                            .refusal = GM_EXIT_USAGE,
                                            .open = open_grid,
                                            .measure = measure,
                                            .draw = draw,
                                            .write = write_table,
                                            .pick = pick};
