/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A running study: results go to the screen as looks, orders from the screen come as flags. */
#include "app/explorer/background/background.h"

#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/grid/grid.h"
#include "app/output/folder.h"
#include "app/output/printer.h"
#include "render/clock.h"

enum { NICE = 10 };

/* seconds between two looks, at least */
static const double look_seconds = 0.1;

struct gm_study {
    enum gm_study_kind kind;
    char *words;
    int wake;
    struct gm_job job;

    /* shared, under the job's lock */
    bool stop, leave, save;
    enum gm_theme theme;
    bool ready; /* looks[filled] is finished and not yet taken */
    int filled; /* index of the look that the thread fills; the screen has the other one */
    struct gm_study_look looks[2];

    /* owned by the thread */
    struct gm_arguments arguments; /* the words, split */
    struct gm_grid grid;
    struct gm_study_look now; /* the current look without its picture */
    double looked;            /* time of the last look, in seconds */
    unsigned long told;       /* number of that look's message */
};

const char *gm_study_words(const struct gm_study *study)
{
    return study->words;
}

/* ---- the thread ---- */

static void say(struct gm_study *study, const char *sentence)
{
    snprintf(study->now.message, sizeof study->now.message, "%s", sentence);
    study->now.message_number++;
}

/* Passes a look to the screen if the last one was taken. */
static void show(struct gm_study *study)
{
    pthread_mutex_lock(&study->job.lock);
    struct gm_study_look *look = study->ready ? NULL : &study->looks[study->filled];
    pthread_mutex_unlock(&study->job.lock);
    if (!look) {
        return;
    }
    struct gm_picture *picture = look->picture;
    *look = study->now;
    look->picture = picture;
    gm_picture_clear(picture);
    gm_grid_draw(&study->grid, picture);
    study->looked = gm_clock_seconds();
    study->told = study->now.message_number;
    const uint64_t one = 1;
    pthread_mutex_lock(&study->job.lock);
    study->ready = true;
    pthread_mutex_unlock(&study->job.lock);
    if (study->wake >= 0 && write(study->wake, &one, sizeof one) < 0) {
        return; /* the counter is full: its reader will take the look */
    }
}

static void save(struct gm_study *study, enum gm_theme theme)
{
    char kind[96], name[128], message[GM_MESSAGE] = "not enough memory", sentence[GM_MESSAGE];
    const char *study_name = gm_study_rows[study->kind]->name;
    char *command = gm_arguments_join(study_name, &study->arguments);
    struct gm_chart chart = {.name = name,
                             .command = command,
                             .print.look = {.width = 1920, .height = 1080, .theme = theme},
                             .data = &study->grid,
                             .draw = gm_grid_draw,
                             .write = gm_grid_write};
    snprintf(kind, sizeof kind, "%.60s-%s", study->arguments.words[0], study_name);
    gm_folder_free_file(kind, ".png", name, sizeof name);
    name[strlen(name) - strlen(".png")] = '\0';
    const bool saved = command && gm_chart_write(&chart, message);
    free(command);
    if (saved) {
        snprintf(sentence, sizeof sentence, "Saved %s.png and %s.csv.", name, name);
    } else {
        snprintf(sentence, sizeof sentence, "Not saved: %.400s", message);
    }
    say(study, sentence);
}

/* Saves if requested. */
static void save_if_wanted(struct gm_study *study)
{
    pthread_mutex_lock(&study->job.lock);
    const bool wanted = study->save && !study->leave;
    const enum gm_theme theme = study->theme;
    study->save = false;
    pthread_mutex_unlock(&study->job.lock);
    if (wanted) {
        save(study, theme);
        study->looked = -INFINITY;
    }
}

static bool is_stopped(void *self)
{
    struct gm_study *study = self;
    pthread_mutex_lock(&study->job.lock);
    const bool stop = study->stop || study->leave;
    pthread_mutex_unlock(&study->job.lock);
    return stop;
}

static void hear(void *self, const char *what, size_t done, size_t all)
{
    struct gm_study *study = self;
    snprintf(study->now.what, sizeof study->now.what, "%s", what);
    study->now.done = done;
    study->now.all = all;
    save_if_wanted(study);
    if (gm_clock_seconds() - study->looked >= look_seconds) {
        show(study);
    }
}

static void measure(struct gm_study *study)
{
    char message[GM_MESSAGE] = "";
    const struct gm_listener listener = {.stopped = is_stopped, .report = hear, .self = study};
    setpriority(PRIO_PROCESS, (id_t)gettid(), NICE); /* on Linux this affects only this thread */
    const bool measured = gm_grid_measure(&study->grid, &listener, message);
    study->now.finished = true;
    if (is_stopped(study)) {
        say(study, "Stopped; what is finished stays.");
    } else if (!measured) {
        study->now.impossible = study->now.done == 0;
        say(study, message);
    } else {
        study->now.done = study->now.all;
        say(study, "Done.");
    }
}

/* Measures at the first call, then carries out orders. Shows the result once the last look was taken. */
static void work(void *self)
{
    struct gm_study *study = self;
    if (!study->now.finished) {
        measure(study);
    }
    save_if_wanted(study);
    if (study->told != study->now.message_number) {
        show(study);
    }
}

static void close_grid(void *self)
{
    struct gm_study *study = self;
    gm_grid_close(&study->grid);
}

/* ---- orders ---- */

static bool open_grid(struct gm_study *study, char *message)
{
    if (!study->words || !study->looks[0].picture || !study->looks[1].picture ||
        !gm_arguments_split(&study->arguments, study->words)) {
        return gm_refuse(message, "There is not enough memory.");
    }
    return gm_grid_open(&study->grid, study->kind, &study->arguments, NULL, message);
}

static void free_study(struct gm_study *study)
{
    gm_picture_close(study->looks[0].picture);
    gm_picture_close(study->looks[1].picture);
    gm_arguments_close(&study->arguments);
    free(study->words);
    free(study);
}

struct gm_study *gm_study_open(enum gm_study_kind kind, const char *words, int wake, char *message)
{
    struct gm_study *study = calloc(1, sizeof *study);
    if (!study) {
        gm_refuse(message, "There is not enough memory.");
        return NULL;
    }
    study->kind = kind;
    study->wake = wake;
    study->words = strdup(words);
    study->looks[0].picture = gm_picture_open();
    study->looks[1].picture = gm_picture_open();
    study->looked = -INFINITY;
    if (!open_grid(study, message)) {
        free_study(study);
        return NULL;
    }
    if (!gm_job_open(&study->job, work, close_grid, study, -1, message)) {
        close_grid(study);
        free_study(study);
        return NULL;
    }
    gm_job_begin(&study->job);
    return study;
}

void gm_study_close(struct gm_study *study)
{
    if (!study) {
        return;
    }
    gm_job_tell(&study->job, &study->leave);
    gm_job_close(&study->job);
    free_study(study);
}

bool gm_study_is_busy(struct gm_study *study)
{
    return gm_job_is_busy(&study->job);
}

struct gm_study_look *gm_study_take(struct gm_study *study)
{
    struct gm_study_look *look = NULL;
    pthread_mutex_lock(&study->job.lock);
    if (study->ready) {
        look = &study->looks[study->filled];
        study->filled = 1 - study->filled;
        study->ready = false;
    }
    pthread_mutex_unlock(&study->job.lock);
    if (look) {
        gm_job_begin(&study->job);
    }
    return look;
}

char *gm_study_pick(const struct gm_study *study, size_t panel, double x, double y)
{
    const struct gm_study_row *row = gm_study_rows[study->kind];
    return row->pick ? row->pick(&study->grid, panel, x, y) : NULL;
}

void gm_study_stop(struct gm_study *study)
{
    gm_job_tell(&study->job, &study->stop);
}

void gm_study_save(struct gm_study *study, enum gm_theme theme)
{
    pthread_mutex_lock(&study->job.lock);
    study->theme = theme;
    pthread_mutex_unlock(&study->job.lock);
    gm_job_tell(&study->job, &study->save);
}
