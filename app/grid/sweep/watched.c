/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep that is looked at while it is made, in the explorer and in tours: its picture grows with its table. */

#include <errno.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "app/grid/hooks.h"
#include "render/message.h"

enum { MOST_RUNS = 100000, PATH = 32 };

/* The table by the path that the process itself has to it. */
static const char *path_of(const struct gm_grid *grid, char path[PATH])
{
    snprintf(path, PATH, "/proc/self/fd/%d", grid->table);
    return path;
}

/* The words but --measure LIST, which is returned: NULL for none. False: no memory. */
static bool take_measure(const struct gm_arguments *arguments, struct gm_arguments *others,
                         const char **measure)
{
    bool good = true;
    *measure = NULL;
    for (int i = 0; good && i < arguments->count; i++) {
        if (strcmp(arguments->words[i], "--measure") == 0 && i + 1 < arguments->count) {
            *measure = arguments->words[++i];
        } else {
            good = gm_arguments_add(others, arguments->words[i]);
        }
    }
    return good;
}

bool gm_sweep_grid_open(struct gm_grid *grid, const struct gm_arguments *typed, const char *measure,
                        char *message)
{
    struct gm_arguments others = {0};
    bool unreadable;
    grid->table = -1;
    bool good = take_measure(typed, &others, &measure) || gm_refuse(message, "not enough memory");
    good = good && gm_sweep_open(&grid->sweep, &others, measure, &unreadable, message) &&
           (grid->chart = gm_sweep_chart_open(&grid->sweep, message));
    gm_arguments_close(&others);
    if (good && grid->sweep.count > MOST_RUNS) {
        good = gm_refuse(message, "these are %zu runs, and %d are the most here: `geomint sweep` makes them",
                         grid->sweep.count, MOST_RUNS);
    }
    if (good) {
        grid->table = memfd_create("sweep", MFD_CLOEXEC);
        good = grid->table >= 0 || gm_refuse(message, "no room for a table: %s", strerror(errno));
    }
    if (good) {
        message[0] = '\0'; /* of a corner of the map in which there is no run */
    } else {
        gm_sweep_grid_close(grid);
    }
    return good;
}

bool gm_sweep_grid_measure(struct gm_grid *grid, const struct gm_listener *listener, char *message)
{
    char path[PATH], unwritten[GM_MESSAGE];
    struct gm_sweep_sum sum;
    struct gm_sweep_table *table = gm_sweep_table_open(&grid->sweep, path_of(grid, path), NULL, message);
    bool good = table && gm_sweep_table_fill(table, 0, grid->chart, listener, &sum, message);
    if (table) {
        good = gm_sweep_table_close(table, unwritten) && good;
    }
    return good;
}

void gm_sweep_grid_draw(const struct gm_grid *grid, struct gm_picture *picture)
{
    gm_sweep_chart_draw(grid->chart, picture);
}

bool gm_sweep_grid_write(const struct gm_grid *grid, const char *path)
{
    char from[PATH], block[1 << 14];
    FILE *table = fopen(path_of(grid, from), "r"), *file = table ? fopen(path, "w") : NULL;
    size_t got = 0;
    bool good = file != NULL;
    while (good && (got = fread(block, 1, sizeof block, table)) > 0) {
        good = fwrite(block, 1, got, file) == got;
    }
    if (table) {
        fclose(table);
    }
    return file && fclose(file) == 0 && good;
}

void gm_sweep_grid_close(struct gm_grid *grid)
{
    gm_sweep_chart_close(grid->chart);
    gm_sweep_close(&grid->sweep);
    if (grid->table >= 0) {
        close(grid->table);
    }
}

char *gm_sweep_grid_pick(const struct gm_grid *grid, size_t panel, double x, double y)
{
    static const char command[] = "run ";
    size_t run;
    char *words = gm_sweep_pick(grid->chart, panel, x, y, &run) ? gm_sweep_words(&grid->sweep, run) : NULL;
    if (words) {
        memmove(words, words + strlen(command), strlen(words) - strlen(command) + 1);
    }
    return words;
}
