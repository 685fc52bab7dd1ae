/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The explorer without a terminal: words press keys and let time pass, and the last screen becomes a file.
   The clock moves by frames and everything waits for everything else, so the bytes are always the same. */
#include <curses.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <time.h>

#include "app/base/arguments.h"
#include "app/explorer/events.h"
#include "app/output/folder.h"
#include "app/output/printer.h"
#include "core/basics.h"
#include "render/cells/text.h"
#include "render/clock.h"
#include "render/drawing/pen.h"
#include "render/files/temporary.h"

enum { FRAMES = 30 /* per second */, LONGEST = 600 /* seconds of a word */ };

/* ---- the words ---- */

/* Returns the key that a word of several letters names; 0: its letters are typed. */
static int key_of(const char *word)
{
    return word[0] && word[1] ? gm_key_named(word, strlen(word)) : 0;
}

/* Returns true for a word that is written like the name of a key: DEL, F2, Ctrl-C. */
static bool is_like_a_key(const char *word)
{
    static const char *const modifiers[] = {"ctrl-", "alt-", "meta-", "shift-"};
    for (size_t i = 0; i < GM_COUNT(modifiers); i++) {
        if (strncasecmp(word, modifiers[i], strlen(modifiers[i])) == 0) {
            return true;
        }
    }
    return word[0] && word[1] &&
           (word[strspn(word, "ABCDEFGHIJKLMNOPQRSTUVWXYZ")] == '\0' ||
            (word[0] == 'F' && word[1 + strspn(word + 1, "0123456789")] == '\0'));
}

/* Returns true for a time such as "2s" or "0.5s", and sets its frames. */
static bool read_time(const char *word, int *frames)
{
    char *end = NULL;
    const double seconds = word[0] >= '0' && word[0] <= '9' ? strtod(word, &end) : 0;
    *frames = seconds <= LONGEST ? (int)(FRAMES * seconds + 0.5) : -1;
    return end && strcmp(end, "s") == 0;
}

static bool check_words(const struct gm_arguments *words, char *message)
{
    for (int i = 0; i < words->count; i++) {
        const char *word = words->words[i];
        int frames = 0;
        if (read_time(word, &frames) && frames < 0) {
            return gm_refuse(message, "--keys %.40s is too long: a word lasts at most %d s", word, LONGEST);
        }
        if (is_like_a_key(word) && !key_of(word)) {
            gm_refuse(message, "--keys has no key %.40s; its keys are", word);
            for (size_t k = 0; gm_key_name(k); k++) {
                gm_append(message, GM_MESSAGE, "%s %s", k ? "," : "", gm_key_name(k));
            }
            return false;
        }
    }
    return true;
}

/* ---- playing ---- */

/* Waits for what has no clock: background diagrams, the check of a typed line, and the measurement of a
   scheme. Returns true if one of them has a result. */
static bool wait_for_others(struct gm_explorer *explorer)
{
    struct gm_check *check = &explorer->check;
    bool came = false;
    while ((check->open && gm_job_is_busy(&check->job)) || gm_studies_are_busy(&explorer->open.studies) ||
           explorer->measure.fd >= 0) {
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
        came = (explorer->measure.fd >= 0 && gm_measure_read(&explorer->measure)) || came;
    }
    const struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    return gm_studies_look(&explorer->open.studies) || came ||
           (prompt->kind != GM_TYPED_NONE && !prompt->checked);
}

/* Lets a frame pass. One that is seen has all that happens at its time, and a screen. */
static void pass(struct gm_explorer *explorer, long *frame, bool seen)
{
    gm_clock_hold((double)++*frame / FRAMES);
    for (bool news = true; news && !explorer->leave;) {
        struct gm_open *open = &explorer->open;
        gm_explorer_look_if_due(explorer);
        gm_explorer_check_typed(explorer);
        gm_explorer_take(explorer, open->worker ? gm_worker_play(open->worker, seen) : NULL);
        news = seen && gm_explorer_compose(explorer) && wait_for_others(explorer);
    }
}

static void play(struct gm_explorer *explorer, const struct gm_arguments *words)
{
    long frame = 0;
    pass(explorer, &frame, true);
    for (int i = 0; i < words->count; i++) {
        const char *word = words->words[i];
        const int key = key_of(word);
        int frames = 0;
        if (read_time(word, &frames)) {
            for (; frames > 0 && !explorer->leave; frames--) {
                pass(explorer, &frame, frames == 1);
            }
            continue;
        }
        for (const char *letter = word; *letter && !explorer->leave; letter += key ? strlen(letter) : 1) {
            gm_explorer_key(explorer, key ? key : (unsigned char)*letter);
            pass(explorer, &frame, true);
        }
    }
}

/* ---- the file ---- */

static bool write_text(const struct gm_cells *cells, const char *path, char *message)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    for (int i = 0; stream && i < cells->rows * cells->columns; i++) {
        char bytes[GM_TEXT_BYTES];
        const uint32_t glyph = cells->cells[i].glyph;
        fwrite(bytes, 1, gm_text_put(glyph ? glyph : ' ', bytes), stream);
        if ((i + 1) % cells->columns == 0) {
            putc('\n', stream);
        }
    }
    const bool made = (stream && fclose(stream) == 0) || gm_refuse(message, "There is not enough memory.");
    const bool placed = made && gm_folder_make_for(path, message);
    const int error = placed ? gm_temporary_write(path, text, size) : 0;
    free(text);
    return placed && (error == 0 || gm_temporary_refuse(message, path, strerror(error)));
}

static void name_picture(const void *data, struct gm_picture *picture)
{
    (void)data;
    picture->title = "geomint";
}

static bool write_picture(struct gm_explorer *explorer, const struct gm_overrides *overrides,
                          enum gm_format format, char *message)
{
    struct gm_cells *cells = &explorer->screen.cells;
    struct gm_chart chart = {.path = overrides->shot,
                             .command = overrides->words,
                             .draw = name_picture,
                             .print = {.format = format,
                                       .look = {.width = GM_CELL_WIDTH * cells->columns,
                                                .height = GM_CELL_HEIGHT * cells->rows,
                                                .theme = explorer->face.theme,
                                                .live = true,
                                                .screen = cells}}};
    for (int i = 0; explorer->face.monochrome && i < cells->rows * cells->columns; i++) {
        cells->cells[i].foreground = gm_theme_colour(explorer->face.theme, GM_INK);
        cells->cells[i].background = gm_theme_colour(explorer->face.theme, GM_PAPER);
    }
    return gm_chart_write(&chart, message);
}

bool gm_script_check(const struct gm_overrides *overrides, char *message)
{
    struct gm_arguments words = {0};
    enum gm_format format;
    const char *path = overrides->shot, *dot = strrchr(path, '.');
    const bool known =
        (gm_format_of(path, &format) && format != GM_FORMAT_PDF) || (dot && strcmp(dot, ".txt") == 0);
    const bool fits = (known || gm_refuse(message, "--shot %.300s is not a .txt, .svg or .png file", path)) &&
                      (gm_arguments_split(&words, overrides->keys ? overrides->keys : "") ||
                       gm_refuse(message, "There is not enough memory.")) &&
                      check_words(&words, message);
    gm_arguments_close(&words);
    return fits;
}

int gm_script_play(struct gm_explorer *explorer, const struct gm_overrides *overrides)
{
    struct gm_arguments words = {0};
    enum gm_format format;
    if (!gm_screen_resize(&explorer->screen, explorer->terminal.columns, explorer->terminal.rows) ||
        !gm_arguments_split(&words, overrides->keys ? overrides->keys : "")) {
        gm_arguments_close(&words);
        gm_refuse(explorer->message, "There is not enough memory.");
        return GM_EXIT_MEMORY;
    }
    play(explorer, &words);
    gm_arguments_close(&words);
    if (explorer->leave && explorer->status != GM_EXIT_OK) {
        return explorer->status;
    }
    const bool written = gm_format_of(overrides->shot, &format)
                             ? write_picture(explorer, overrides, format, explorer->message)
                             : write_text(&explorer->screen.cells, overrides->shot, explorer->message);
    return written ? GM_EXIT_OK : GM_EXIT_FILE;
}
