/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sends composed screens to the terminal. A thread paints and encodes their picture of pixels. */
#include "app/explorer/terminal/device.h"

#include <errno.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/explorer/background/background.h"
#include "app/explorer/surface/surface.h"
#include "render/clock.h"
#include "render/message.h"
#include "render/pixels/canvas.h"

/* ---- the thread that paints ---- */

struct gm_pixels {
    struct gm_job painting;
    bool busy; /* a picture was started and not yet taken */

    /* owned by the caller, or by the thread while it paints */
    struct gm_picture *picture;
    struct gm_pixels_job job;
    struct gm_writer_image made;

    /* owned by the thread */
    struct gm_pixels_job made_for; /* the settings of the canvas and the image */
    struct gm_canvas *canvas;
    struct gm_inline *image;
};

static void forget(void *self)
{
    struct gm_pixels *pixels = self;
    gm_canvas_close(pixels->canvas);
    gm_inline_close(pixels->image);
    pixels->canvas = NULL;
    pixels->image = NULL;
}

static bool same_kind(const struct gm_pixels_job *a, const struct gm_pixels_job *b)
{
    return a->kind == b->kind && memcmp(&a->place, &b->place, sizeof a->place) == 0;
}

/* Opens a canvas of the right size, unless it is open. */
static bool prepare(struct gm_pixels *pixels)
{
    const struct gm_pixels_job *job = &pixels->job;
    struct gm_appearance look = {.theme = job->theme, .live = true};
    char message[GM_MESSAGE];
    if (pixels->canvas && same_kind(job, &pixels->made_for) && job->theme == pixels->made_for.theme) {
        return true;
    }
    forget(pixels);
    pixels->made_for = *job;
    gm_inline_size(&job->place, job->kind, &look.width, &look.height);
    pixels->canvas = gm_canvas_open(&look, message);
    if (!pixels->canvas) {
        return false;
    }
    pixels->image = gm_inline_open(job->kind, &job->place, job->most_width, job->most_height);
    return pixels->image;
}

static void paint(void *self)
{
    struct gm_pixels *pixels = self;
    pixels->made = (struct gm_writer_image){0};
    const unsigned char *rgb =
        prepare(pixels) ? gm_canvas_paint(pixels->canvas, pixels->picture, NULL) : NULL;
    if (!rgb ||
        !gm_inline_encode(pixels->image, rgb, pixels->job.whole, &pixels->made.bytes, &pixels->made.size)) {
        pixels->made.bytes = NULL;
        forget(pixels);
    } else if (!pixels->made.bytes) {
        pixels->made.bytes = ""; /* nothing changed */
    }
}

static struct gm_pixels *open_pixels(int wake)
{
    char message[GM_MESSAGE];
    struct gm_pixels *pixels = calloc(1, sizeof *pixels);
    /* the thread owns an OpenGL context and closes it */
    if (pixels && !gm_job_open(&pixels->painting, paint, forget, pixels, wake, message)) {
        free(pixels);
        pixels = NULL;
    }
    return pixels;
}

/* ---- screens ---- */

bool gm_display_open(struct gm_display *display, struct gm_terminal *terminal, int wake)
{
    *display = (struct gm_display){.terminal = terminal, .wake = wake, .lost = true};
    return gm_writer_open(&display->writer, terminal);
}

void gm_display_close(struct gm_display *display)
{
    if (display->painter) {
        gm_job_close(&display->painter->painting);
        free(display->painter);
    }
    gm_writer_close(&display->writer);
    display->painter = NULL;
}

static bool painting(const struct gm_display *display)
{
    return display->painter && display->painter->busy;
}

bool gm_display_takes(struct gm_display *display)
{
    return !painting(display) && gm_writer_takes(&display->writer, display->terminal->answers.ready);
}

void gm_display_forget(struct gm_display *display)
{
    display->writer.known = false;
    display->lost = true;
}

bool gm_display_read(struct gm_display *display)
{
    struct gm_pixels *painter = display->painter;
    if (!painting(display) || gm_job_is_busy(&painter->painting)) {
        return false;
    }
    painter->busy = false;
    display->painted = painter->made.bytes != NULL;
    display->failed = !display->painted;
    return true;
}

void gm_display_finish(struct gm_display *display)
{
    if (painting(display)) {
        gm_job_wait(&display->painter->painting);
        gm_display_read(display);
    }
}

static void remove_picture(struct gm_display *display)
{
    gm_writer_tell(&display->writer, gm_inline_removal(display->shown));
    display->shown = GM_INLINE_NONE;
    display->lost = true;
}

/* Starts a picture; returns false if it is current or cannot be painted. */
static bool begin(struct gm_display *display, const struct gm_screen *screen, const struct gm_face *face,
                  struct gm_picture *picture)
{
    const struct gm_terminal *terminal = display->terminal;
    struct gm_pixels_job job = {.kind = face->pixels,
                                .theme = face->theme,
                                .place = screen->pixels,
                                .most_width = terminal->answers.most_width,
                                .most_height = terminal->answers.most_height};
    job.place.cell_width = terminal->cell_width;
    job.place.cell_height = terminal->cell_height;
    if (!same_kind(&job, &display->job)) {
        remove_picture(display);
    }
    display->lost = display->lost || job.theme != display->job.theme;
    if (!display->lost && (display->painted || !display->stale)) {
        return false;
    }
    display->painter = display->painter ? display->painter : open_pixels(display->wake);
    if (!display->painter) {
        display->failed = true;
        return false;
    }
    job.whole = display->lost;
    display->job = job;
    display->painted = display->stale = display->lost = false;
    display->painter->picture = picture;
    display->painter->job = job;
    display->painter->busy = true;
    gm_job_begin(&display->painter->painting);
    return true;
}

bool gm_display_show(struct gm_display *display, const struct gm_screen *screen, const struct gm_face *face,
                     struct gm_picture *picture)
{
    bool pixels = screen->pixels.columns > 0 && picture;
    if (pixels && begin(display, screen, face, picture)) {
        return false;
    }
    if (!pixels && display->shown) {
        remove_picture(display);
    }
    bool new = pixels && display->painted;
    gm_writer_draw(&display->writer, &screen->cells, new ? &display->painter->made : NULL);
    if (new) {
        display->shown = display->job.kind;
        display->painted = false;
    }
    return true;
}

struct gm_spot gm_display_locate(struct gm_display *display, struct gm_picture *picture, int column, int row)
{
    const struct gm_inline_place *place = &display->job.place;
    gm_display_finish(display);
    if (!display->painter || !display->painter->canvas) {
        return (struct gm_spot){NULL, 0, 0};
    }
    return gm_canvas_locate(display->painter->canvas, picture,
                            (column - place->column + 0.5) * place->cell_width,
                            (row - place->row + 0.5) * place->cell_height);
}

/* Sends queued bytes and awaits the answers, for at most PATIENCE milliseconds. */
static void drain(struct gm_display *display)
{
    enum { PATIENCE = 1000 };
    struct gm_writer *writer = &display->writer;
    int64_t until = gm_clock_milliseconds() + PATIENCE;
    for (int64_t left = PATIENCE; left > 0; left = until - gm_clock_milliseconds()) {
        const bool sent = gm_writer_send(writer);
        gm_writer_takes(writer, display->terminal->answers.ready);
        if (!sent || (gm_writer_idle(writer) && gm_writer_patience(writer) < 0)) {
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
