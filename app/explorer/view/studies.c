/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The shown study, its keys and its picture, and the progress of hidden studies. */
#include "app/explorer/view/view.h"

#include <ctype.h>
#include <curses.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/explorer/surface/surface.h"
#include "render/clock.h"

enum { NOTICE_MILLISECONDS = 20000 };

/* the keys of the studies; 0: only a tour shows it */
static const char keys[GM_STUDY_COUNT] = {
    [GM_STUDY_WORK] = 'w', [GM_STUDY_STABILITY] = 'm', [GM_STUDY_SWEEP] = 'M'};

void gm_studies_close(struct gm_studies *studies)
{
    for (int i = 0; i < GM_STUDY_COUNT; i++) {
        gm_study_close(studies->studies[i]);
    }
    free(studies->painting.cells.cells);
    *studies = (struct gm_studies){0};
}

bool gm_studies_open(struct gm_studies *studies, enum gm_study_kind kind, const struct gm_scene *scene,
                     const char *words, int wake)
{
    struct gm_study *present = studies->studies[kind];
    if (!present || strcmp(present->words, words) != 0) {
        struct gm_study *study = gm_study_open(kind, words, wake, studies->notice);
        if (!study) {
            return false;
        }
        gm_study_close(present);
        studies->studies[kind] = study;
    }
    studies->studies[kind]->scene = scene;
    studies->shown = kind;
    studies->painting.fresh = false;
    return true;
}

/* Returns true if a parameter has its default value. */
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
    char *words = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&words, &size);
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
    return fclose(stream) == 0 ? words : NULL;
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
    const struct gm_study_look *look = study ? study->look : NULL;
    double x, y;
    size_t number = 0;
    const struct gm_panel *hit =
        look && studies->painting.fresh
            ? gm_cells_locate(&studies->painting.cells, look->picture, blocks, column, row, &x, &y)
            : NULL;
    for (const struct gm_panel *panel = hit ? look->picture->first : NULL; panel && panel != hit;
         panel = panel->next) {
        number++;
    }
    const struct gm_study_row *kind = gm_study_rows[studies->shown];
    return hit && kind->pick ? kind->pick(&study->grid, number, x, y) : NULL;
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
        if (study && gm_study_take(study)) {
            const bool first = study->look->finished && !finished;
            study->until = first ? gm_clock_milliseconds() + NOTICE_MILLISECONDS : study->until;
            studies->painting.fresh = studies->painting.fresh && studies->shown != (enum gm_study_kind)i;
            news = true;
        }
    }
    return news;
}

/* ---- drawing ---- */

/* Draws the reason why there is no diagram. */
static void draw_reason(const struct gm_sheet *sheet, const struct gm_study_look *look)
{
    const struct gm_sheet page = gm_sheet_part(sheet, 2, 1, sheet->width - 4, sheet->height - 1);
    char sentence[GM_MESSAGE + 1];
    snprintf(sentence, sizeof sentence, "%c%s.", toupper((unsigned char)look->message[0]),
             look->message[0] ? look->message + 1 : "");
    gm_sheet_text(&page, 0, 0, look->picture->title ? look->picture->title : "", GM_INK, true);
    gm_sheet_wrapped(&page, 0, 2, page.height - 2, sentence, GM_INK);
}

void gm_studies_draw(const struct gm_sheet *sheet, struct gm_studies *studies)
{
    struct gm_study_look *look = studies->studies[studies->shown]->look;
    if (sheet->width < 1 || sheet->height < 1) {
        return;
    }
    if (!look) {
        gm_sheet_text(sheet, 1, 0, "measuring", GM_SECONDARY, false);
    } else if (look->impossible) {
        draw_reason(sheet, look);
    } else {
        gm_sheet_paint(sheet, &studies->painting, look->picture);
    }
}

static int percent(const struct gm_study_look *look)
{
    return look && look->all > 0 ? (int)(100 * look->done / look->all) : 0;
}

void gm_studies_status(const struct gm_studies *studies, char *text, size_t size)
{
    const struct gm_study_look *look = studies->studies[studies->shown]->look;
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
        const struct gm_study_look *look = study ? study->look : NULL;
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
