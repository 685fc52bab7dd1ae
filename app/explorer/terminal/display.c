/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Composed screens to the terminal, with the picture of pixels that a screen leaves room for. */
#include "app/explorer/terminal/display.h"

#include <errno.h>
#include <poll.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "app/explorer/terminal/console.h"
#include "render/clock.h"
#include "render/message.h"

bool gm_display_open(struct gm_display *display, struct gm_terminal *terminal, int wake)
{
    *display = (struct gm_display){.terminal = terminal, .wake = wake, .lost = true};
    return gm_writer_open(&display->writer, terminal);
}

void gm_display_close(struct gm_display *display)
{
    gm_pixels_close(display->painter);
    gm_writer_close(&display->writer);
    display->painter = NULL;
}

static bool painting(const struct gm_display *display)
{
    return display->painter && gm_pixels_busy(display->painter);
}

bool gm_display_takes(struct gm_display *display)
{
    return !painting(display) && gm_writer_takes(&display->writer, display->terminal->answers.ready);
}

bool gm_display_send(struct gm_display *display)
{
    return gm_writer_send(&display->writer);
}

int gm_display_patience(const struct gm_display *display)
{
    return gm_writer_patience(&display->writer);
}

void gm_display_renew(struct gm_display *display)
{
    display->stale = true;
}

void gm_display_forget(struct gm_display *display)
{
    gm_writer_forget(&display->writer);
    display->lost = true;
}

bool gm_display_read(struct gm_display *display)
{
    char message[GM_MESSAGE];
    if (!display->painter || !gm_pixels_take(display->painter, &display->bytes, &display->size, message)) {
        return false;
    }
    display->painted = display->bytes != NULL;
    display->failed = !display->painted;
    return true;
}

void gm_display_finish(struct gm_display *display)
{
    while (painting(display) && !gm_display_read(display)) {
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
}

static void remove_picture(struct gm_display *display)
{
    gm_writer_tell(&display->writer, gm_inline_removal(display->shown));
    display->shown = GM_INLINE_NONE;
    display->lost = true;
}

static bool same_kind(const struct gm_pixels_job *a, const struct gm_pixels_job *b)
{
    return a->kind == b->kind && memcmp(&a->place, &b->place, sizeof a->place) == 0;
}

/* Begins the picture that the screen leaves room for, unless it is there. */
static bool begin(struct gm_display *display, const struct gm_composed *screen)
{
    char message[GM_MESSAGE];
    const struct gm_terminal *terminal = display->terminal;
    struct gm_pixels_job job = {
        .kind = screen->pixels,
        .theme = screen->theme,
        .place = screen->room,
        .most_width = terminal->answers.most_width,
        .most_height = terminal->answers.most_height,
    };
    job.place.cell_width = terminal->cell_width;
    job.place.cell_height = terminal->cell_height;
    if (!same_kind(&job, &display->job)) {
        remove_picture(display);
    }
    display->lost = display->lost || job.theme != display->job.theme;
    if (!display->lost && (display->painted || !display->stale)) {
        return false;
    }
    if (!display->painter) {
        display->painter = gm_pixels_open(display->wake, message);
        if (!display->painter) {
            display->failed = true;
            return false;
        }
    }
    job.whole = display->lost;
    display->job = job;
    display->painted = display->stale = display->lost = false;
    gm_pixels_paint(display->painter, screen->picture, &job);
    return true;
}

bool gm_display_show(struct gm_display *display, const struct gm_composed *screen)
{
    bool pixels = screen->room.columns > 0 && screen->picture;
    if (pixels && begin(display, screen)) {
        return false;
    }
    if (!pixels && display->shown) {
        remove_picture(display);
    }
    bool new = pixels && display->painted;
    const struct gm_writer_image image = {.bytes = display->bytes, .size = display->size};
    gm_writer_draw(&display->writer, screen->cells, new ? &image : NULL);
    if (new) {
        display->shown = display->job.kind;
        display->painted = false;
    }
    return true;
}

const struct gm_panel *gm_display_locate(struct gm_display *display, struct gm_picture *picture, int column,
                                         int row, double *x, double *y)
{
    const struct gm_inline_place *place = &display->job.place;
    if (!display->painter) {
        return NULL;
    }
    gm_display_finish(display);
    return gm_pixels_locate(display->painter, picture, (column - place->column + 0.5) * place->cell_width,
                            (row - place->row + 0.5) * place->cell_height, x, y);
}

/* Sends what is queued and waits for what the terminal was asked, for a while. */
static void drain(struct gm_display *display)
{
    enum { PATIENCE = 1000 };
    struct gm_writer *writer = &display->writer;
    int64_t until = gm_clock_milliseconds() + PATIENCE;
    for (int64_t left = PATIENCE; left > 0; left = until - gm_clock_milliseconds()) {
        bool good = gm_writer_send(writer);
        gm_writer_takes(writer, display->terminal->answers.ready);
        if (!good || (gm_writer_idle(writer) && gm_writer_patience(writer) < 0)) {
            return;
        }
        struct pollfd watched[] = {
            {.fd = STDIN_FILENO, .events = POLLIN},
            {.fd = gm_writer_idle(writer) ? -1 : writer->fd, .events = POLLOUT},
        };
        if (poll(watched, 2, (int)left) < 0) {
            if (errno != EINTR) {
                return;
            }
        } else if (watched[0].revents & ~POLLIN) {
            return; /* the terminal is gone */
        } else {
            gm_console_key();
        }
    }
}

void gm_display_rest(struct gm_display *display)
{
    gm_display_finish(display);
    drain(display);
    gm_writer_cut(&display->writer);
    remove_picture(display);
    drain(display);
    gm_writer_cut(&display->writer);
}
