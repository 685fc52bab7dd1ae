/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A sweep as a study of the explorer and of tours, whose picture grows with its table. */
#include "app/grid/kinds/sweep.h"

#include <errno.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "render/message.h"

enum { MOST_RUNS = 100000, PATH = 32 };

/* The table by the path that the process itself has to it. */
static const char *path_of(const struct gm_sweep_study *study, char path[PATH])
{
    snprintf(path, PATH, "/proc/self/fd/%d", study->table);
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

bool gm_sweep_study_open(struct gm_sweep_study *study, const struct gm_arguments *arguments, char *message)
{
    struct gm_arguments others = {0};
    const char *measure;
    bool unreadable;
    *study = (struct gm_sweep_study){.table = -1};
    bool good = take_measure(arguments, &others, &measure) || gm_refuse(message, "not enough memory");
    good = good && gm_sweep_open(&study->sweep, &others, measure, &unreadable, message) &&
           gm_sweep_is_drawable(&study->sweep, message);
    gm_arguments_close(&others);
    if (good && study->sweep.count > MOST_RUNS) {
        good = gm_refuse(message, "these are %zu runs, and %d are the most here: `geomint sweep` makes them",
                         study->sweep.count, MOST_RUNS);
    }
    if (good) {
        study->table = memfd_create("sweep", MFD_CLOEXEC);
        good = study->table >= 0 || gm_refuse(message, "no room for a table: %s", strerror(errno));
    }
    if (good) {
        message[0] = '\0'; /* of a corner of the map in which there is no run */
    } else {
        gm_sweep_study_close(study);
    }
    return good;
}

/* Who listens, and what is read before that. */
struct relay {
    struct gm_sweep_study *study;
    const struct gm_listener *listener;
};

static bool is_stopped(void *self)
{
    return gm_listener_stops(((const struct relay *)self)->listener);
}

static void pass_on(void *self, const char *what, size_t done, size_t all)
{
    const struct relay *relay = self;
    if (relay->study->chart) {
        gm_sweep_chart_read(relay->study->chart);
    }
    gm_listener_hears(relay->listener, what, done, all);
}

bool gm_sweep_study_measure(struct gm_sweep_study *study, const struct gm_listener *listener, char *message)
{
    char path[PATH], unwritten[GM_MESSAGE];
    struct relay relay = {study, listener};
    const struct gm_listener self = {.stopped = is_stopped, .report = pass_on, .self = &relay};
    struct gm_sweep_sum sum;
    struct gm_sweep_table *table = gm_sweep_table_open(&study->sweep, path_of(study, path), NULL, message);
    study->chart = table ? gm_sweep_chart_open(&study->sweep, path, message) : NULL;
    bool good = study->chart && gm_sweep_table_fill(table, 0, &self, &sum, message);
    if (table) {
        good = gm_sweep_table_close(table, unwritten) && good;
    }
    if (study->chart) {
        gm_sweep_chart_read(study->chart);
    }
    return good;
}

void gm_sweep_study_draw(const struct gm_sweep_study *study, struct gm_picture *picture)
{
    if (study->chart) {
        gm_sweep_chart_draw(study->chart, picture);
    }
}

bool gm_sweep_study_write(const struct gm_sweep_study *study, const char *path)
{
    char from[PATH], block[1 << 14];
    FILE *table = fopen(path_of(study, from), "r"), *file = table ? fopen(path, "w") : NULL;
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

void gm_sweep_study_close(struct gm_sweep_study *study)
{
    gm_sweep_chart_close(study->chart);
    gm_sweep_close(&study->sweep);
    if (study->table >= 0) {
        close(study->table);
    }
}
