/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The kinds of studies, as rows of functions. */
#include "app/grid/kinds/study.h"

#include <string.h>

/* ---- work-precision ---- */

static bool open_work(void *table, const struct gm_arguments *arguments, const char *measure, char *message)
{
    return gm_work_open(table, arguments, measure, message);
}

static bool measure_work(void *table, const struct gm_listener *listener, char *message)
{
    return gm_work_measure(table, listener, message);
}

static void draw_work(const void *table, struct gm_picture *picture)
{
    gm_work_draw(table, picture);
}

static bool write_work(const void *table, const char *path)
{
    return gm_work_write(table, path);
}

static void close_work(void *table)
{
    gm_work_close(table);
}

/* ---- stability ---- */

static bool open_stability(void *table, const struct gm_arguments *arguments, const char *measure,
                           char *message)
{
    return gm_stability_open(table, arguments, measure, message);
}

static bool measure_stability(void *table, const struct gm_listener *listener, char *message)
{
    return gm_stability_measure(table, listener, message);
}

static void draw_stability(const void *table, struct gm_picture *picture)
{
    gm_stability_draw(table, picture);
}

static bool write_stability(const void *table, const char *path)
{
    return gm_stability_write(table, path);
}

static void close_stability(void *table)
{
    gm_stability_close(table);
}

/* ---- backward error ---- */

static bool open_backward(void *table, const struct gm_arguments *arguments, const char *measure,
                          char *message)
{
    (void)measure;
    return gm_backward_open(table, arguments, message);
}

static bool measure_backward(void *table, const struct gm_listener *listener, char *message)
{
    return gm_backward_measure(table, listener, message);
}

static void draw_backward(const void *table, struct gm_picture *picture)
{
    gm_backward_draw(table, picture);
}

static bool write_backward(const void *table, const char *path)
{
    return gm_backward_write(table, path);
}

static void close_backward(void *table)
{
    gm_backward_close(table);
}

/* ---- sweeps ---- */

static bool open_sweep(void *table, const struct gm_arguments *arguments, const char *measure, char *message)
{
    (void)measure;
    return gm_sweep_study_open(table, arguments, message);
}

static bool measure_sweep(void *table, const struct gm_listener *listener, char *message)
{
    return gm_sweep_study_measure(table, listener, message);
}

static void draw_sweep(const void *table, struct gm_picture *picture)
{
    gm_sweep_study_draw(table, picture);
}

static bool write_sweep(const void *table, const char *path)
{
    return gm_sweep_study_write(table, path);
}

static void close_sweep(void *table)
{
    gm_sweep_study_close(table);
}

static char *pick_run(const void *table, size_t panel, double x, double y)
{
    const struct gm_sweep_study *study = table;
    static const char command[] = "run ";
    size_t run;
    char *words = gm_sweep_pick(&study->sweep, panel, x, y, &run) ? gm_sweep_words(&study->sweep, run) : NULL;
    if (words) {
        memmove(words, words + strlen(command), strlen(words) - strlen(command) + 1);
    }
    return words;
}

/* ---- all ---- */

const struct gm_study_row gm_study_rows[GM_STUDY_COUNT] = {
    [GM_STUDY_WORK] = {"work-precision", GM_EXIT_NUMERICAL, open_work, measure_work, draw_work, write_work,
                       close_work, NULL},
    [GM_STUDY_STABILITY] = {"stability", GM_EXIT_USAGE, open_stability, measure_stability, draw_stability,
                            write_stability, close_stability, NULL},
    [GM_STUDY_BACKWARD] = {"backward", GM_EXIT_USAGE, open_backward, measure_backward, draw_backward,
                           write_backward, close_backward, NULL},
    [GM_STUDY_SWEEP] = {"sweep", GM_EXIT_USAGE, open_sweep, measure_sweep, draw_sweep, write_sweep,
                        close_sweep, pick_run},
};

enum gm_study_kind gm_study_find(const char *name)
{
    int kind = GM_STUDY_COUNT - 1;
    while (kind > GM_STUDY_NONE && strcmp(gm_study_rows[kind].name, name) != 0) {
        kind--;
    }
    return (enum gm_study_kind)kind;
}
