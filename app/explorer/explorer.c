/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The explorer's start and end, the loop that waits for keys and events, and the screen: shots of the worker are
   taken, and a screen is composed. */
#include "app/explorer/explorer.h"

#include <curses.h>
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "app/base/interrupt.h"
#include "app/explorer/events.h"
#include "app/explorer/terminal/device.h"
#include "app/explorer/view/view.h"
#include "app/output/say.h"
#include "core/basics.h"
#include "render/clock.h"

/* ---- from the state to the screen ---- */

enum { FRAME_MILLISECONDS = 16, SLOW_FRAME_MILLISECONDS = 33, LOOK_MILLISECONDS = 66, LEAST_PAUSE = 5 };
/* the part of a core up to which frames come at full pace */
static const double FRAMES_SHARE = 1.0 / 3;

bool gm_explorer_compose(struct gm_explorer *explorer)
{
    enum { WATCH_MILLISECONDS = 8000 };
    struct gm_screen *screen = &explorer->screen;
    struct gm_face *face = &explorer->face;
    const struct gm_shot *shot = explorer->open.shot;
    if (explorer->list.shown) {
        bool looked = gm_explorer_is_looked_at(explorer);
        gm_screen_draw_start(screen, face, &explorer->list.start, looked ? shot : NULL, explorer->fresh,
                             looked ? explorer->open.said : "");
    } else if (shot) {
        if (face->page == GM_PAGE_HELP) {
            face->explained = shot->lanes[shot->selected].scheme;
        }
        if (face->page == GM_PAGE_HELP || face->page == GM_PAGE_SCHEME) {
            gm_measure_ask(&explorer->measure, face->explained);
            face->measured = gm_measure_text(&explorer->measure);
        }
        if (face->watched != shot->scene) { /* what to watch in a new scene is shown for some seconds */
            face->watched = shot->scene;
            face->watch_until = gm_clock_milliseconds() + WATCH_MILLISECONDS;
        }
        gm_screen_draw_scene(screen, face, shot, explorer->fresh);
    } else {
        return false;
    }
    if (face->loss) {
        gm_screen_ask(screen, face);
    }
    explorer->fresh = false;
    return true;
}

/* ---- shots of the worker ---- */

/* Shows the requested command lines, and offers the first to the clipboard. */
static void read_command(struct gm_explorer *explorer)
{
    const struct gm_shot *shot = explorer->open.shot;
    if (shot->command_number == explorer->open.told) {
        return;
    }
    explorer->open.told = shot->command_number;
    explorer->face.awaited = false;
    if (explorer->editing) {
        gm_explorer_edit_system(explorer, shot->commands[GM_COMMAND_EXPLORER]);
        return;
    }
    explorer->face.page = GM_PAGE_COMMAND;
    explorer->face.scroll = 0;
    explorer->face.command = GM_COMMAND_PICTURE;
    gm_explorer_copy(explorer);
}

/* Returns the milliseconds between frames: costly ones and pictures of pixels come half as often, which
   leaves time for steps and other processes. */
static int period(const struct gm_explorer *explorer, const struct gm_shot *shot)
{
    const double affordable = 1000 * (shot->cost + explorer->draw_cost) / FRAMES_SHARE;
    if (explorer->list.shown) {
        return LOOK_MILLISECONDS;
    }
    if (explorer->face.pixels || affordable > SLOW_FRAME_MILLISECONDS) {
        return SLOW_FRAME_MILLISECONDS;
    }
    return affordable > FRAME_MILLISECONDS ? (int)affordable : FRAME_MILLISECONDS;
}

void gm_explorer_take(struct gm_explorer *explorer, struct gm_shot *shot)
{
    if (shot) {
        explorer->open.shot = shot;
        explorer->open.scene = shot->scene; /* the worker has made the scene by now */
        explorer->open.asked = false;
        read_command(explorer);
        /* at an even pace, with a pause that leaves others time */
        const int64_t next = explorer->open.next_shot + period(explorer, shot);
        const int64_t earliest = gm_clock_milliseconds() + LEAST_PAUSE;
        explorer->open.next_shot = next > earliest ? next : earliest;
        explorer->dirty = true;
        explorer->fresh = explorer->fresh || shot->drawn;
        if (shot->drawn) {
            explorer->display.stale = true;
        }
    } else if (explorer->open.worker && !explorer->open.shot && !explorer->open.said[0] &&
               gm_worker_failed(explorer->open.worker, explorer->open.said)) {
        explorer->dirty = true;
        if (!explorer->list.shown) {
            gm_explorer_show_start(explorer);
        }
    }
}

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

static void read_picture(struct gm_explorer *explorer)
{
    if (!gm_display_read(&explorer->display)) {
        return;
    }
    explorer->dirty = true;
    if (explorer->display.failed) { /* without a font only blocks work */
        explorer->terminal.can_pixels[GM_INLINE_KITTY] = explorer->terminal.can_pixels[GM_INLINE_SIXEL] =
            false;
        explorer->face.pixels = GM_INLINE_NONE;
    }
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
    read_picture(explorer);
    explorer->dirty = gm_studies_look(&explorer->open.studies) || explorer->dirty;
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

int gm_explorer(const struct gm_request *request, const struct gm_tour *tour,
                const struct gm_overrides *overrides)
{
    struct gm_explorer explorer = {.wake = -1, .list = {.look_due = -1}, .measure = {.fd = -1}};
    const bool scripted = overrides->shot != NULL;
    if (scripted ? !gm_terminal_imagine(&explorer.terminal, overrides, explorer.message) ||
                       !gm_script_check(overrides, explorer.message)
                 : !gm_terminal_detect(&explorer.terminal, overrides, explorer.message) ||
                       !gm_terminal_serves(&explorer.terminal, explorer.message)) {
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
        explorer.status = gm_script_play(&explorer, overrides);
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
