/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A running study: results go to the screen as looks, orders from the screen come as flags. */
#include "app/explorer/background/background.h"

#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/output/folder.h"
#include "app/output/printer.h"
#include "render/clock.h"

enum { NICE = 10 };

/* seconds between two looks, at least */
static const double look_seconds = 0.1;

/* ---- the thread ---- */

__attribute__((format(printf, 2, 3))) static void say(struct gm_study *study, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    vsnprintf(study->now.message, sizeof study->now.message, format, values);
    va_end(values);
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
    pthread_mutex_lock(&study->job.lock);
    study->ready = true;
    pthread_mutex_unlock(&study->job.lock);
    if (study->wake >= 0) {
        eventfd_write(study->wake, 1); /* if the counter is full, its reader will take the look */
    }
}

static void save(struct gm_study *study, enum gm_theme theme)
{
    char kind[96], name[128], message[GM_MESSAGE] = "not enough memory";
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
        say(study, "Saved %s.png and %s.csv.", name, name);
    } else {
        say(study, "Not saved: %.400s", message);
    }
}

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
        say(study, "%s", message);
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

/* ---- the screen ---- */

static void free_study(struct gm_study *study)
{
    gm_picture_close(study->looks[0].picture);
    gm_picture_close(study->looks[1].picture);
    gm_arguments_close(&study->arguments);
    free(study->words);
    free(study);
}

static bool start(struct gm_study *study, char *message)
{
    if (!study->words || !study->looks[0].picture || !study->looks[1].picture ||
        !gm_arguments_split(&study->arguments, study->words)) {
        return gm_refuse(message, "There is not enough memory.");
    }
    if (!gm_grid_open(&study->grid, study->kind, &study->arguments, NULL, message)) {
        return false;
    }
    if (!gm_job_open(&study->job, work, NULL, study, -1, message)) {
        gm_grid_close(&study->grid);
        return false;
    }
    gm_job_begin(&study->job);
    return true;
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
    if (!start(study, message)) {
        free_study(study);
        study = NULL;
    }
    return study;
}

void gm_study_close(struct gm_study *study)
{
    if (study) {
        gm_job_tell(&study->job, &study->leave);
        gm_job_close(&study->job);
        gm_grid_close(&study->grid);
        free_study(study);
    }
}

bool gm_study_take(struct gm_study *study)
{
    pthread_mutex_lock(&study->job.lock);
    const bool ready = study->ready;
    if (ready) {
        study->look = &study->looks[study->filled];
        study->filled = 1 - study->filled;
        study->ready = false;
    }
    pthread_mutex_unlock(&study->job.lock);
    if (ready) {
        gm_job_begin(&study->job);
    }
    return ready;
}
