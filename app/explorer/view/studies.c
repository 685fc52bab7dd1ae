/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Studies that run in the background: their threads, the shown one with its keys and its picture, and the progress of
   the others. */
#include "app/explorer/view/view.h"

#include <ctype.h>
#include <curses.h>
#include <math.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/resource.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/explorer/background/background.h"
#include "app/explorer/surface/surface.h"
#include "app/output/folder.h"
#include "app/output/printer.h"
#include "render/clock.h"

/* A diagram measured in the background, by a thread of low priority. Only the thread touches its table;
   the screen receives looks. */

struct look {
    struct gm_picture *picture;
    char what[64]; /* the run being measured */
    size_t done, all;
    bool finished;            /* measuring is complete or was stopped */
    bool impossible;          /* nothing can be measured, for the reason in message */
    char message[GM_MESSAGE]; /* the last message; its number counts messages */
    unsigned long message_number;
};

struct gm_study {
    enum gm_study_kind kind;
    char *words; /* the command's, the scene first */
    int wake;
    struct gm_job job;

    /* owned by the screen */
    const struct gm_scene *scene; /* the scene that is open at its start; it may be freed */
    struct look *look;            /* the last look taken; NULL before the first */
    int64_t until;                /* time (ms) at which the notice of its end disappears */

    /* shared, under the job's lock */
    bool stop; /* measuring stops; finished results remain */
    bool save; /* the results go to PNG and CSV in the working directory; the next look names them */
    bool leave;
    enum gm_theme theme; /* of a saved picture */
    bool ready;          /* looks[filled] is finished and not yet taken */
    int filled;          /* index of the look that the thread fills; the screen has the other one */
    struct look looks[2];

    /* owned by the thread */
    struct gm_arguments arguments; /* the words, split */
    struct gm_grid grid;
    struct look now;    /* the current look without its picture */
    double looked;      /* time of the last look, in seconds */
    unsigned long told; /* number of that look's message */
};

enum { NICE = 10 };

/* seconds between two looks, at least */
static const double look_seconds = 0.1;

/* ---- the thread of a study: results go to the screen as looks, orders from it come as flags ---- */

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
    struct look *look = study->ready ? NULL : &study->looks[study->filled];
    pthread_mutex_unlock(&study->job.lock);
    if (!look) {
        return;
    }
    struct gm_picture *picture = look->picture;
    *look = study->now;
    look->picture = picture;
    gm_picture_clear(picture);
    gm_picture_draw(picture, gm_grid_draw, &study->grid);
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

/* ---- studies on the screen ---- */

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

/* Starts to measure; close_study frees the study. `wake` is an eventfd, written when there is a new look.
   Returns NULL on failure and fills message (GM_MESSAGE bytes). */
static struct gm_study *open_study(enum gm_study_kind kind, const char *words, int wake, char *message)
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

/* Abandons unfinished runs and frees the study; ignores NULL. */
static void close_study(struct gm_study *study)
{
    if (study) {
        gm_job_tell(&study->job, &study->leave);
        gm_job_close(&study->job);
        gm_grid_close(&study->grid);
        free_study(study);
    }
}

/* Takes a look that is new since the last call; returns false without one. The caller may read it and lay out
   its picture until the next call. */
static bool take_look(struct gm_study *study)
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

enum { NOTICE_MILLISECONDS = 20000 };

/* the keys of the studies; 0: only a tour shows it */
static const char keys[GM_STUDY_COUNT] = {
    [GM_STUDY_WORK] = 'w', [GM_STUDY_STABILITY] = 'm', [GM_STUDY_SWEEP] = 'M'};

void gm_studies_close(struct gm_studies *studies)
{
    for (int i = 0; i < GM_STUDY_COUNT; i++) {
        close_study(studies->studies[i]);
    }
    free(studies->painting.cells.cells);
    *studies = (struct gm_studies){0};
}

bool gm_studies_open(struct gm_studies *studies, enum gm_study_kind kind, const struct gm_scene *scene,
                     const char *words, int wake)
{
    struct gm_study *present = studies->studies[kind];
    if (!present || strcmp(present->words, words) != 0) {
        struct gm_study *study = open_study(kind, words, wake, studies->notice);
        if (!study) {
            return false;
        }
        close_study(present);
        studies->studies[kind] = study;
    }
    studies->studies[kind]->scene = scene;
    studies->shown = kind;
    studies->painting.fresh = false;
    return true;
}

static bool is_standard(const struct gm_scene *scene, const struct gm_shot_parameter *parameter)
{
    void *owner =
        calloc(1, scene->size > sizeof(struct gm_settings) ? scene->size : sizeof(struct gm_settings));
    bool standard = true;
    if (owner) {
        char usual[GM_TEXT_SIZE];
        gm_parameter_set(parameter->row, owner, parameter->row->standard);
        gm_parameter_format(parameter->row, owner, usual, sizeof usual);
        standard = strcmp(parameter->value, usual) == 0;
    }
    free(owner);
    return standard;
}

/* Omits dt, which the study varies. */
char *gm_studies_words(const struct gm_shot *shot)
{
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    if (!stream) {
        return NULL;
    }
    gm_arguments_put_scene(stream, shot->scene);
    for (size_t i = 0; i < shot->parameter_count; i++) {
        const struct gm_shot_parameter *parameter = &shot->parameters[i];
        if (strcmp(parameter->row->key, "dt") == 0 ||
            (is_standard(shot->scene, parameter) && !parameter->row->required)) {
            continue;
        }
        char word[64 + GM_TEXT_SIZE];
        snprintf(word, sizeof word, "%s=%s", parameter->row->key, parameter->value);
        fputc(' ', stream);
        gm_arguments_put(stream, word);
    }
    return gm_stream_end(&writing);
}

void gm_studies_begin(struct gm_studies *studies, enum gm_study_kind kind, const struct gm_shot *shot,
                      int wake)
{
    char *words = gm_studies_words(shot);
    if (words) {
        gm_studies_open(studies, kind, shot->scene, words, wake);
    }
    free(words);
}

char *gm_studies_pick(const struct gm_studies *studies, enum gm_blocks blocks, int column, int row)
{
    const struct gm_study *study = studies->studies[studies->shown];
    const struct look *look = study ? study->look : NULL;
    struct gm_spot spot = {NULL, 0, 0};
    size_t number = 0;
    if (look && studies->painting.fresh) {
        spot = gm_cells_locate(&studies->painting.cells, look->picture, blocks, column, row);
    }
    for (const struct gm_panel *panel = spot.panel ? look->picture->first : NULL;
         panel && panel != spot.panel; panel = panel->next) {
        number++;
    }
    const struct gm_study_row *kind = gm_study_rows[studies->shown];
    return spot.panel && kind->pick ? kind->pick(&study->grid, number, spot.x, spot.y) : NULL;
}

bool gm_studies_press(struct gm_studies *studies, int key, enum gm_theme theme)
{
    static const char others[] = "qbtlnNa?";
    studies->notice[0] = '\0';
    if (studies->shown == GM_STUDY_NONE) {
        return false;
    }
    struct gm_study *study = studies->studies[studies->shown];
    if (key == GM_KEY_ESCAPE || key == KEY_BACKSPACE || key == keys[studies->shown]) {
        studies->shown = GM_STUDY_NONE;
        return true;
    }
    switch (key) {
    case 'x':
        gm_job_tell(&study->job, &study->stop);
        return true;
    case 'p':
        pthread_mutex_lock(&study->job.lock);
        study->theme = theme;
        pthread_mutex_unlock(&study->job.lock);
        gm_job_tell(&study->job, &study->save);
        return true;
    case 'w':
    case 'm':
    case GM_KEY_REDRAW:
        return false;
    default:
        return key <= ' ' || key > '~' || !strchr(others, key);
    }
}

bool gm_studies_are_busy(const struct gm_studies *studies)
{
    bool busy = false;
    for (int i = 0; i < GM_STUDY_COUNT; i++) {
        busy = busy || (studies->studies[i] && gm_job_is_busy(&studies->studies[i]->job));
    }
    return busy;
}

int64_t gm_studies_end(const struct gm_studies *studies, int64_t now)
{
    int64_t first = 0;
    for (int i = 0; i < GM_STUDY_COUNT; i++) {
        const int64_t end = studies->studies[i] ? studies->studies[i]->until : 0;
        first = end > now && (first == 0 || end < first) ? end : first;
    }
    return first;
}

void gm_studies_leave(struct gm_studies *studies)
{
    studies->shown = GM_STUDY_NONE;
    for (int i = 0; i < GM_STUDY_COUNT; i++) {
        if (studies->studies[i]) {
            studies->studies[i]->until = 0;
        }
    }
}

bool gm_studies_look(struct gm_studies *studies)
{
    bool news = false;
    for (int i = 0; i < GM_STUDY_COUNT; i++) {
        struct gm_study *study = studies->studies[i];
        const bool finished = study && study->look && study->look->finished;
        if (study && take_look(study)) {
            const bool first = study->look->finished && !finished;
            study->until = first ? gm_clock_milliseconds() + NOTICE_MILLISECONDS : study->until;
            studies->painting.fresh = studies->painting.fresh && studies->shown != (enum gm_study_kind)i;
            news = true;
        }
    }
    return news;
}

/* ---- drawing ---- */

void gm_studies_draw(const struct gm_sheet *sheet, struct gm_studies *studies)
{
    struct look *look = studies->studies[studies->shown]->look;
    if (sheet->width < 1 || sheet->height < 1) {
        return;
    }
    if (!look) {
        gm_sheet_text(sheet, 1, 0, "measuring", GM_SECONDARY, false);
    } else if (look->impossible) {
        const struct gm_sheet page = gm_sheet_part(sheet, 2, 1, sheet->width - 4, sheet->height - 1);
        char reason[GM_MESSAGE + 1];
        snprintf(reason, sizeof reason, "%c%s.", toupper((unsigned char)look->message[0]),
                 look->message[0] ? look->message + 1 : "");
        gm_sheet_text(&page, 0, 0, look->picture->title ? look->picture->title : "", GM_INK, true);
        gm_sheet_wrapped(&page, 0, 2, page.height - 2, reason, GM_INK);
    } else {
        gm_sheet_paint(sheet, &studies->painting, look->picture);
    }
}

static int percent(const struct look *look)
{
    return look && look->all > 0 ? (int)(100 * look->done / look->all) : 0;
}

void gm_studies_status(const struct gm_studies *studies, char *text, size_t size)
{
    const struct look *look = studies->studies[studies->shown]->look;
    const char *name = gm_study_rows[studies->shown]->name;
    if (studies->notice[0]) {
        snprintf(text, size, "%s", studies->notice);
    } else if (!look) {
        snprintf(text, size, "%s: begins", name);
    } else if (look->impossible) {
        snprintf(text, size, "%s: not possible here", name);
    } else {
        snprintf(text, size, "%s %d %%: %s", name, percent(look),
                 look->message[0] ? look->message : look->what);
    }
}

void gm_studies_news(const struct gm_studies *studies, const struct gm_scene *scene, char *text, size_t size)
{
    snprintf(text, size, "%s", studies->notice);
    for (int i = GM_STUDY_WORK; i < GM_STUDY_COUNT && !text[0]; i++) {
        const struct gm_study *study = studies->studies[i];
        const struct look *look = study ? study->look : NULL;
        if (!study || study->scene != scene || studies->shown == (enum gm_study_kind)i ||
            (look && (look->impossible || (look->finished && gm_clock_milliseconds() >= study->until)))) {
            continue;
        }
        const char *words = study->words; /* the scene is the first word */
        const int length = (int)strcspn(words, " ");
        if (look && look->finished) {
            snprintf(text, size, keys[i] ? "%s of %.*s is ready: %c shows it" : "%s of %.*s is ready",
                     gm_study_rows[i]->name, length, words, keys[i]);
        } else {
            snprintf(text, size, "%s of %.*s %d %%", gm_study_rows[i]->name, length, words, percent(look));
        }
    }
}
