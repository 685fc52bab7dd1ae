/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A diagram that is measured in the background, in a thread of its own. */
#include "app/explorer/view/study.h"

#include <math.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/output/chart.h"
#include "app/request/arguments.h"
#include "app/request/clock.h"
#include "app/studies/study.h"
#include "render/files/thread.h"

enum { NICE = 10 };

/* A look is worth its while after so many seconds. */
static const double look_seconds = 0.1;

struct gm_study {
    enum gm_study_kind kind;
    char *words;
    int wake;
    pthread_t thread;

    /* shared, under the lock */
    pthread_mutex_t lock;
    pthread_cond_t news;
    bool stop, leave, save;
    enum gm_theme theme;
    bool ready; /* looks[filled] is finished and not yet taken */
    int filled; /* the look that the thread fills; the screen has the other one */
    struct gm_study_look looks[2];

    /* the thread's own */
    struct gm_arguments arguments; /* the words, cut up */
    union gm_study_table table;
    struct gm_study_look now; /* all but the picture */
    double looked;            /* when the last look was handed over */
};

const char *gm_study_name(enum gm_study_kind kind)
{
    return gm_study_rows[kind].name;
}

enum gm_study_kind gm_study_kind_of(const struct gm_study *study)
{
    return study->kind;
}

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

/* Hands a look over if the last one was taken. */
static void show(struct gm_study *study)
{
    pthread_mutex_lock(&study->lock);
    struct gm_study_look *look = study->ready ? NULL : &study->looks[study->filled];
    pthread_mutex_unlock(&study->lock);
    if (!look) {
        return;
    }
    struct gm_picture *picture = look->picture;
    *look = study->now;
    look->picture = picture;
    gm_picture_clear(picture);
    gm_study_rows[study->kind].draw(&study->table, picture);
    study->looked = gm_wall_seconds();
    const uint64_t one = 1;
    pthread_mutex_lock(&study->lock);
    study->ready = true;
    pthread_mutex_unlock(&study->lock);
    if (write(study->wake, &one, sizeof one) < 0) {
        return; /* the counter is full: whoever reads it will look */
    }
}

/* The first name of the kind that is free, as it is without a number. */
static void free_name(const struct gm_study *study, char *name, size_t size)
{
    char path[160];
    int number = 1;
    do {
        snprintf(name, size, "%.60s-%s-%04d", study->arguments.words[0], gm_study_name(study->kind), number);
        snprintf(path, sizeof path, "%.120s.png", name);
    } while (access(path, F_OK) == 0 && number++ < 9999);
}

static void save(struct gm_study *study, enum gm_theme theme)
{
    char name[128], message[GM_MESSAGE] = "not enough memory", sentence[GM_MESSAGE];
    const struct gm_study_row *row = &gm_study_rows[study->kind];
    char *command = gm_arguments_join(row->name, &study->arguments);
    struct gm_chart chart = {.name = name, .command = command, .width = 1920, .height = 1080, .theme = theme};
    free_name(study, name, sizeof name);
    const bool good = command && gm_chart_write(&chart, &study->table, row->draw, row->write, message);
    free(command);
    if (good) {
        snprintf(sentence, sizeof sentence, "Saved %s.png and %s.csv.", name, name);
    } else {
        snprintf(sentence, sizeof sentence, "Not saved: %.400s", message);
    }
    say(study, sentence);
}

/* Saves if that was asked for. */
static void save_if_wanted(struct gm_study *study)
{
    pthread_mutex_lock(&study->lock);
    const bool wanted = study->save;
    const enum gm_theme theme = study->theme;
    study->save = false;
    pthread_mutex_unlock(&study->lock);
    if (wanted) {
        save(study, theme);
        study->looked = -INFINITY;
    }
}

static bool is_stopped(void *self)
{
    struct gm_study *study = self;
    pthread_mutex_lock(&study->lock);
    const bool stop = study->stop || study->leave;
    pthread_mutex_unlock(&study->lock);
    return stop;
}

static void hear(void *self, const char *what, size_t done, size_t all)
{
    struct gm_study *study = self;
    snprintf(study->now.what, sizeof study->now.what, "%s", what);
    study->now.done = done;
    study->now.all = all;
    save_if_wanted(study);
    if (gm_wall_seconds() - study->looked >= look_seconds) {
        show(study);
    }
}

static void *measure(void *self)
{
    struct gm_study *study = self;
    char message[GM_MESSAGE] = "";
    const struct gm_listener listener = {.stopped = is_stopped, .report = hear, .self = study};
    setpriority(PRIO_PROCESS, (id_t)gettid(), NICE); /* of this thread alone */
    const bool good = gm_study_rows[study->kind].measure(&study->table, &listener, message);
    study->now.finished = true;
    if (is_stopped(study)) {
        say(study, "Stopped; what is finished stays.");
    } else if (!good) {
        study->now.impossible = study->now.done == 0;
        say(study, message);
    } else {
        study->now.done = study->now.all;
        say(study, "Done.");
    }
    unsigned long shown = 0;
    pthread_mutex_lock(&study->lock);
    while (!study->leave) {
        if (study->save) {
            pthread_mutex_unlock(&study->lock);
            save_if_wanted(study);
            pthread_mutex_lock(&study->lock);
        } else if (shown != study->now.message_number && !study->ready) {
            pthread_mutex_unlock(&study->lock);
            shown = study->now.message_number;
            show(study);
            pthread_mutex_lock(&study->lock);
        } else {
            pthread_cond_wait(&study->news, &study->lock);
        }
    }
    pthread_mutex_unlock(&study->lock);
    return NULL;
}

/* ---- orders ---- */

static bool open_table(struct gm_study *study, char *message)
{
    if (!gm_arguments_split(&study->arguments, study->words)) {
        snprintf(message, GM_MESSAGE, "There is not enough memory.");
        return false;
    }
    return gm_study_rows[study->kind].open(&study->table, &study->arguments, message);
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
        snprintf(message, GM_MESSAGE, "There is not enough memory.");
        return NULL;
    }
    study->kind = kind;
    study->wake = wake;
    study->words = strdup(words);
    study->looks[0].picture = gm_picture_open();
    study->looks[1].picture = gm_picture_open();
    study->looked = -INFINITY;
    if (!study->words || !study->looks[0].picture || !study->looks[1].picture) {
        snprintf(message, GM_MESSAGE, "There is not enough memory.");
        free_study(study);
        return NULL;
    }
    if (!open_table(study, message)) {
        free_study(study);
        return NULL;
    }
    pthread_mutex_init(&study->lock, NULL);
    pthread_cond_init(&study->news, NULL);
    const int error = gm_thread_start(&study->thread, measure, study);
    if (error != 0) {
        snprintf(message, GM_MESSAGE, "No thread could be started: %s.", strerror(error));
        gm_study_rows[study->kind].close(&study->table);
        free_study(study);
        return NULL;
    }
    return study;
}

static void wake_thread(struct gm_study *study)
{
    pthread_cond_signal(&study->news);
    pthread_mutex_unlock(&study->lock);
}

void gm_study_close(struct gm_study *study)
{
    if (!study) {
        return;
    }
    pthread_mutex_lock(&study->lock);
    study->leave = true;
    wake_thread(study);
    pthread_join(study->thread, NULL);
    pthread_cond_destroy(&study->news);
    pthread_mutex_destroy(&study->lock);
    gm_study_rows[study->kind].close(&study->table);
    free_study(study);
}

struct gm_study_look *gm_study_take(struct gm_study *study)
{
    struct gm_study_look *look = NULL;
    pthread_mutex_lock(&study->lock);
    if (study->ready) {
        look = &study->looks[study->filled];
        study->filled = 1 - study->filled;
        study->ready = false;
    }
    wake_thread(study);
    return look;
}

void gm_study_stop(struct gm_study *study)
{
    pthread_mutex_lock(&study->lock);
    study->stop = true;
    wake_thread(study);
}

void gm_study_save(struct gm_study *study, enum gm_theme theme)
{
    pthread_mutex_lock(&study->lock);
    study->save = true;
    study->theme = theme;
    wake_thread(study);
}
