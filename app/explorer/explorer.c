/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The explorer's start and end, the loop that waits for keys and events, and scripts, which need no terminal. */
#include "app/explorer/explorer.h"

#include <curses.h>
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/explorer/events.h"
#include "app/explorer/terminal/device.h"
#include "app/explorer/view/view.h"
#include "app/output/folder.h"
#include "app/output/printer.h"
#include "app/output/say.h"
#include "core/basics.h"
#include "render/cells/text.h"
#include "render/clock.h"
#include "render/drawing/pen.h"
#include "render/files/temporary.h"

/* ---- output ---- */

/* Returns the time (ms) at which the first of the texts that are shown for some seconds ends, or 0. */
static int64_t first_end(const struct gm_explorer *explorer)
{
    const struct gm_face *face = &explorer->face;
    const int64_t now = gm_clock_milliseconds(), ends[] = {face->watch_until, face->hint_until};
    int64_t first = gm_studies_end(&explorer->open.studies, now);
    for (size_t i = 0; i < GM_COUNT(ends); i++) {
        first = ends[i] > now && (first == 0 || ends[i] < first) ? ends[i] : first;
    }
    return first;
}

/* Composes and sends as fast as the terminal accepts: a slow one loses frames, never model time. Returns
   the milliseconds to wait for input; -1: without limit. */
static int put_out(struct gm_explorer *explorer)
{
    int64_t now = gm_clock_milliseconds();
    gm_explorer_look_if_due(explorer);
    if (explorer->end > 0 && explorer->end <= now) {
        explorer->dirty = true;
        explorer->end = 0; /* the loop waits for a slow terminal, not for a time that has passed */
    }
    bool sent = gm_writer_send(&explorer->display.writer);
    if (explorer->dirty && gm_display_takes(&explorer->display)) {
        const double begun = gm_clock_seconds();
        explorer->dirty = gm_explorer_compose(explorer) &&
                          !gm_display_show(&explorer->display, &explorer->screen, &explorer->face,
                                           explorer->open.shot ? explorer->open.shot->picture : NULL);
        explorer->end = first_end(explorer);
        explorer->draw_cost = gm_clock_seconds() - begun;
        sent = sent && gm_writer_send(&explorer->display.writer);
    }
    if (!sent) {
        gm_explorer_leave(explorer, GM_EXIT_FILE);
    }
    if (explorer->list.shown && explorer->list.look_due >= 0) {
        return (int)(explorer->list.look_due - now);
    }
    if (!gm_display_takes(&explorer->display)) {
        return gm_writer_patience(&explorer->display.writer);
    }
    if (!explorer->open.worker || explorer->open.asked || explorer->dirty) {
        return -1;
    }
    int64_t wait = explorer->open.next_shot - now;
    if (wait > 0) {
        return (int)wait;
    }
    gm_worker_want(explorer->open.worker);
    explorer->open.asked = true;
    return -1;
}

/* ---- input ---- */

/* The font's size may have changed, which the system does not always report. */
static void read_cell_size(struct gm_explorer *explorer)
{
    struct gm_terminal *terminal = &explorer->terminal;
    int width = terminal->answers.cell_width, height = terminal->answers.cell_height;
    gm_terminal_cell(&width, &height);
    if (width > 0 && height > 0 && (width != terminal->cell_width || height != terminal->cell_height)) {
        terminal->cell_width = width;
        terminal->cell_height = height;
        explorer->dirty = true;
    }
}

/* Uses answers that come after a second or more: asks the terminal for its limits, then decides again how
   to show pictures, unless the user has chosen. */
static void read_late_answers(struct gm_explorer *explorer)
{
    struct gm_terminal *terminal = &explorer->terminal;
    struct gm_face *face = &explorer->face;
    if (explorer->late == 0 || !terminal->answers.attributes || !gm_writer_idle(&explorer->display.writer)) {
        return;
    }
    if (--explorer->late > 0 && (terminal->answers.sixel || terminal->answers.kitty)) {
        terminal->answers.attributes = false;
        gm_writer_tell(&explorer->display.writer, GM_ASK_LIMITS);
        return;
    }
    const struct gm_graphics before = terminal->graphics;
    gm_terminal_reconsider(terminal);
    explorer->late = 0;
    if (face->pixels == before.pixels && face->blocks == before.blocks) {
        face->pixels = terminal->graphics.pixels;
        face->blocks = terminal->graphics.blocks;
        explorer->dirty = true;
    }
}

/* Returns the milliseconds for which typed keys must wait, for a scene or text that the worker has not yet
   delivered; 0: they are read. A tour accepts keys without its picture. */
static int hold_keys(struct gm_explorer *explorer)
{
    enum { LONGEST = 500 }; /* milliseconds; a long step does not block the keys further */
    const int64_t now = gm_clock_milliseconds();
    const struct gm_open *open = &explorer->open;
    if (!explorer->face.awaited &&
        (!open->worker || open->shot || open->said[0] || open->touring || explorer->list.shown)) {
        explorer->held_until = 0;
        return 0;
    }
    explorer->held_until = explorer->held_until ? explorer->held_until : now + LONGEST;
    if (now >= explorer->held_until) {
        explorer->face.awaited = false;
        return 0;
    }
    return (int)(explorer->held_until - now);
}

/* Reads keys, including those that the console already has. */
static void read_keys(struct gm_explorer *explorer)
{
    while (!explorer->leave) {
        explorer->behind = hold_keys(explorer) > 0;
        const int key = explorer->behind ? -1 : gm_console_key();
        if (key < 0) {
            return;
        }
        struct gm_mouse_event event;
        enum gm_mouse_result result = gm_mouse_feed(&explorer->pointer.mouse, key, &event);
        if (result == GM_MOUSE_NOT && key != KEY_RESIZE) { /* a change of size does not close a page */
            gm_explorer_key(explorer, key);
        } else if (result == GM_MOUSE_EVENT) {
            gm_explorer_point(explorer, &event);
        }
    }
}

/* Returns true if the terminal is gone: input is ready but has no bytes. It is polled again, as the system
   discards bytes typed before a second Ctrl-Z. */
static bool is_gone(void)
{
    struct pollfd keys = {.fd = STDIN_FILENO, .events = POLLIN};
    int waiting = 0;
    return poll(&keys, 1, 0) > 0 && (ioctl(STDIN_FILENO, FIONREAD, &waiting) != 0 || waiting == 0);
}

static void read_news(struct gm_explorer *explorer)
{
    uint64_t count;
    if (read(explorer->wake, &count, sizeof count) < 0 && errno != EAGAIN && errno != EINTR) {
        gm_explorer_leave(explorer, GM_EXIT_USAGE);
    }
    const bool stops = gm_console_stopping();
    if (stops) {
        gm_display_rest(&explorer->display);
        gm_console_stop();
    }
    if (gm_console_leaving()) {
        gm_interrupts_seen();
        gm_explorer_leave(explorer, GM_EXIT_INTERRUPTED);
    }
    if (gm_console_resized() || stops) {
        gm_explorer_resize(explorer);
    }
    const bool painted = gm_display_read(&explorer->display);
    if (painted && explorer->display.failed) { /* without a font only blocks work */
        explorer->terminal.can_pixels[GM_INLINE_KITTY] = explorer->terminal.can_pixels[GM_INLINE_SIXEL] =
            false;
        explorer->face.pixels = GM_INLINE_NONE;
    }
    explorer->dirty = gm_studies_look(&explorer->open.studies) || explorer->dirty || painted;
    gm_explorer_take(explorer, explorer->open.worker ? gm_worker_take(explorer->open.worker) : NULL);
}

static void run(struct gm_explorer *explorer)
{
    enum { KEYS, NEWS, SCREEN, MEASURE, COUNT };
    const struct gm_writer *writer = &explorer->display.writer;
    gm_explorer_resize(explorer);
    while (!explorer->leave) {
        read_late_answers(explorer);
        int wait = put_out(explorer);
        const int64_t left = explorer->end - gm_clock_milliseconds();
        if (explorer->end > 0 && (wait < 0 || left < wait)) {
            wait = left > 0 ? (int)left : 0;
        }
        const int hold = hold_keys(explorer);
        struct pollfd watched[COUNT] = {
            [KEYS] = {.fd = hold > 0 ? -1 : STDIN_FILENO, .events = POLLIN},
            [NEWS] = {.fd = explorer->wake, .events = POLLIN},
            [SCREEN] = {.fd = gm_writer_idle(writer) ? -1 : writer->fd, .events = POLLOUT},
            [MEASURE] = {.fd = explorer->measure.fd, .events = POLLIN},
        };
        if (explorer->leave) {
            break;
        }
        const int patience = hold > 0 ? hold : explorer->behind ? 0 : gm_console_patience();
        if (patience >= 0 && (wait < 0 || patience < wait)) {
            wait = patience;
        }
        if (poll(watched, COUNT, wait) < 0) {
            if (errno != EINTR) {
                gm_explorer_leave(explorer, GM_EXIT_USAGE);
            }
            continue; /* a signal's handler wakes the loop */
        }
        if (watched[NEWS].revents) {
            read_news(explorer);
        }
        if (watched[MEASURE].revents && gm_measure_read(&explorer->measure)) {
            explorer->dirty = true;
        }
        gm_explorer_check_typed(explorer);
        if (hold > 0) {
            continue;
        }
        if (watched[KEYS].revents && is_gone()) {
            gm_explorer_leave(explorer, GM_EXIT_OK);
        } else if (watched[KEYS].revents || patience >= 0) {
            read_keys(explorer);
            gm_explorer_check_typed(explorer);
            read_cell_size(explorer);
        }
    }
}

/* ---- a script: words press keys and let time pass, and the last screen becomes a file ---- */

/* The clock moves by frames and everything waits for everything else, so the bytes are always the same. */

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
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    for (int i = 0; stream && i < cells->rows * cells->columns; i++) {
        char bytes[GM_TEXT_BYTES];
        const uint32_t glyph = cells->cells[i].glyph;
        fwrite(bytes, 1, gm_text_put(glyph ? glyph : ' ', bytes), stream);
        if ((i + 1) % cells->columns == 0) {
            putc('\n', stream);
        }
    }
    char *text = gm_stream_end(&writing);
    const bool made = text || gm_refuse(message, "There is not enough memory.");
    const bool placed = made && gm_folder_make_for(path, message);
    const int error = placed ? gm_temporary_write(path, text, writing.size) : 0;
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

/* Reads the keys of the options. Returns true if these and the file can be understood; else fills message. */
static bool check_script(const struct gm_overrides *overrides, struct gm_arguments *words, char *message)
{
    enum gm_format format;
    const char *path = overrides->shot, *dot = strrchr(path, '.');
    const bool known =
        (gm_format_of(path, &format) && format != GM_FORMAT_PDF) || (dot && strcmp(dot, ".txt") == 0);
    return (known || gm_refuse(message, "--shot %.300s is not a .txt, .svg or .png file", path)) &&
           (gm_arguments_split(words, overrides->keys ? overrides->keys : "") ||
            gm_refuse(message, "There is not enough memory.")) &&
           check_words(words, message);
}

/* Plays the script on the explorer's open scene or list, and writes the screen. Returns the exit status, and
   fills the explorer's message unless that is 0. */
static int play_script(struct gm_explorer *explorer, const struct gm_overrides *overrides,
                       const struct gm_arguments *words)
{
    enum gm_format format;
    if (!gm_screen_resize(&explorer->screen, explorer->terminal.columns, explorer->terminal.rows)) {
        gm_refuse(explorer->message, "There is not enough memory.");
        return GM_EXIT_MEMORY;
    }
    play(explorer, words);
    if (explorer->leave && explorer->status != GM_EXIT_OK) {
        return explorer->status;
    }
    const bool written = gm_format_of(overrides->shot, &format)
                             ? write_picture(explorer, overrides, format, explorer->message)
                             : write_text(&explorer->screen.cells, overrides->shot, explorer->message);
    return written ? GM_EXIT_OK : GM_EXIT_FILE;
}

/* ---- start and end ---- */

int gm_explorer(const struct gm_request *request, const struct gm_tour *tour,
                const struct gm_overrides *overrides)
{
    struct gm_explorer explorer = {.wake = -1, .list = {.look_due = -1}, .measure = {.fd = -1}};
    const bool scripted = overrides->shot != NULL;
    struct gm_arguments words = {0};
    if (scripted ? !gm_terminal_imagine(&explorer.terminal, overrides, explorer.message) ||
                       !check_script(overrides, &words, explorer.message)
                 : !gm_terminal_detect(&explorer.terminal, overrides, explorer.message) ||
                       !gm_terminal_serves(&explorer.terminal, explorer.message)) {
        gm_arguments_close(&words);
        return gm_give_up(GM_EXIT_USAGE, "%s", explorer.message);
    }
    explorer.face = (struct gm_face){.blocks = explorer.terminal.graphics.blocks,
                                     .pixels = explorer.terminal.graphics.pixels,
                                     .theme = explorer.terminal.theme,
                                     .few_colours = explorer.terminal.colours < GM_COLOURS_256,
                                     .monochrome = explorer.terminal.colours == GM_COLOURS_NONE,
                                     .only_monochrome = explorer.terminal.colours == GM_COLOURS_NONE,
                                     .studies = &explorer.open.studies};
    explorer.late = explorer.terminal.asked >= 0 && !explorer.terminal.answers.attributes ? 2 : 0;
    explorer.face.typed_prompt = &explorer.typed_prompt;
    explorer.display.writer.fd = -1;
    if (scripted) {
        gm_clock_hold(0);
    } else {
        explorer.wake = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    }
    explorer.open.wake = explorer.wake;
    explorer.open.display = &explorer.display;
    /* Opens the lanes before the terminal is taken over: an error is easier to read in the shell. */
    bool ok = explorer.wake >= 0 || scripted;
    if (!ok) {
        gm_refuse(explorer.message, "The system has no eventfd to spare.");
    } else if (tour) {
        explorer.open.guide = gm_guide_at(tour, 0);
        explorer.face.guide = &explorer.open.guide;
        ok = gm_open_step(&explorer.open, explorer.message);
    } else if (request && request->scene) {
        ok = gm_open_request(&explorer.open, request, explorer.message);
    } else {
        gm_explorer_show_start(&explorer);
    }
    int number = 0;
    if (ok && scripted) {
        explorer.status = play_script(&explorer, overrides, &words);
        gm_display_close(&explorer.display);
    } else if (ok) {
        ok = gm_console_open(explorer.wake, &explorer.terminal, explorer.message) &&
             gm_display_open(&explorer.display, &explorer.terminal, explorer.wake);
    }
    if (ok && !scripted) {
        run(&explorer);
        number = gm_console_leaving();
        gm_display_rest(&explorer.display);
        gm_display_close(&explorer.display);
    }
    gm_console_close();
    gm_measure_close(&explorer.measure);
    gm_explorer_close_typed(&explorer);
    gm_open_leave(&explorer.open);
    gm_studies_close(&explorer.open.studies);
    gm_screen_close(&explorer.screen);
    gm_explorer_close_list(&explorer.list);
    gm_arguments_close(&words);
    fputs(explorer.open.partings ? explorer.open.partings : "", stderr);
    free(explorer.open.partings);
    gm_console_release(); /* the eventfd stays open: an abandoned worker may still write to it */
    if (!ok || explorer.status == GM_EXIT_USAGE || (scripted && explorer.status != GM_EXIT_OK)) {
        return gm_give_up(ok ? explorer.status : GM_EXIT_USAGE, "%s",
                          explorer.message[0] ? explorer.message : "There is not enough memory.");
    }
    if (number != 0 && number != SIGINT) {
        signal(number, SIG_DFL);
        raise(number);
    }
    return explorer.status;
}
