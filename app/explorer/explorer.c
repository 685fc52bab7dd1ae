/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/explorer/explorer.h"

#include <curses.h>
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "app/explorer/console.h"
#include "app/explorer/keys.h"
#include "app/explorer/pixels.h"
#include "app/explorer/writer.h"

enum { FRAME_MILLISECONDS = 33, FIRST_SCHEMES = 3 };

/* A picture of pixels on the screen. */
struct picture {
    struct gm_pixels *painter; /* NULL until it is needed */
    bool stale;                /* the shot has a newer one */
    bool lost;                 /* the terminal may have lost parts of it */
    bool painted;              /* `bytes` wait to be shown */
    enum gm_inline_kind shown; /* what the terminal shows */
    size_t covered;            /* cells of it that had a glyph in the last screen */
    struct gm_pixels_job job;  /* the last that was begun */
    const char *bytes;
    size_t size;
};

struct explorer {
    struct gm_terminal terminal;
    struct gm_face face;
    struct gm_screen screen;
    struct gm_writer writer;
    struct picture picture;
    int wake;                 /* the worker's shots and all signals are announced here */
    struct gm_worker *worker; /* NULL: the list of scenes is shown */
    struct gm_shot *shot;
    size_t choice;     /* in the list of scenes */
    bool dirty;        /* the screen has to be composed again */
    bool fresh;        /* with a new picture */
    bool asked;        /* for a shot */
    int64_t next_shot; /* in milliseconds: no shot is asked for earlier */
    bool leave;
    int status;
    char message[GM_MESSAGE]; /* said when the terminal is the shell's again */
};

static int64_t milliseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}

static void leave(struct explorer *explorer, int status)
{
    explorer->leave = true;
    explorer->status = status;
}

static bool open_scene(struct explorer *explorer, const struct gm_request *request)
{
    explorer->worker = gm_worker_open(request, explorer->terminal.theme, explorer->wake, explorer->message);
    explorer->asked = true; /* a new worker owes its first shot */
    explorer->next_shot = 0;
    return explorer->worker != NULL;
}

static bool open_by_name(struct explorer *explorer, const struct gm_scene *scene)
{
    struct gm_request request;
    char *words[] = {(char *)scene->name};
    if (!gm_request_parse(&request, 1, words, FIRST_SCHEMES, explorer->message)) {
        return false;
    }
    bool ok = open_scene(explorer, &request);
    gm_request_close(&request);
    return ok;
}

static void resize(struct explorer *explorer)
{
    int columns, rows;
    gm_terminal_size(&columns, &rows);
    if (!gm_screen_resize(&explorer->screen, columns, rows)) {
        leave(explorer, GM_EXIT_USAGE);
    }
    gm_writer_forget(&explorer->writer);
    int width = explorer->terminal.cell_width;
    gm_terminal_cell(&explorer->terminal.cell_width, &explorer->terminal.cell_height);
    if (width > 0 && explorer->terminal.cell_width == width && explorer->face.pixels &&
        gm_writer_idle(&explorer->writer)) {
        gm_writer_tell(&explorer->writer, GM_ASK_CELL); /* letters may have another size too */
    }
    explorer->picture.lost = true;
    explorer->dirty = explorer->fresh = true;
}

/* ---- input ---- */

static void press_at_start(struct explorer *explorer, int key)
{
    size_t count = gm_scene_count();
    switch (key) {
    case 'q':
        leave(explorer, GM_EXIT_OK);
        break;
    case KEY_UP:
        explorer->choice = (explorer->choice + count - 1) % count;
        break;
    case KEY_DOWN:
        explorer->choice = (explorer->choice + 1) % count;
        break;
    case '\n':
    case '\r':
    case KEY_ENTER:
        if (!open_by_name(explorer, gm_scene_at(explorer->choice))) {
            leave(explorer, GM_EXIT_USAGE);
        }
        break;
    default:
        return;
    }
    explorer->dirty = true;
}

static void show_graphics(struct explorer *explorer, struct gm_graphics graphics)
{
    explorer->face.pixels = graphics.pixels;
    explorer->face.blocks = graphics.blocks;
    explorer->picture.stale = explorer->dirty = true;
}

static void press(struct explorer *explorer, int key)
{
    if (!explorer->worker) {
        press_at_start(explorer, key);
        return;
    }
    if (!explorer->shot) { /* before the first picture there is only leaving */
        if (key == 'q') {
            leave(explorer, GM_EXIT_OK);
        }
        return;
    }
    switch (gm_key_press(key, &explorer->face, explorer->shot, explorer->worker)) {
    case GM_KEY_BLOCKS:
        show_graphics(explorer,
                      gm_graphics_next(&explorer->terminal,
                                       (struct gm_graphics){explorer->face.pixels, explorer->face.blocks}));
        break;
    case GM_KEY_LEAVE:
        leave(explorer, GM_EXIT_OK);
        break;
    case GM_KEY_REPAINT:
        resize(explorer);
        break;
    case GM_KEY_FACE:
    case GM_KEY_ORDER:
        explorer->dirty = true;
        break;
    case GM_KEY_IGNORED:
        break;
    }
}

static void press_all(struct explorer *explorer)
{
    for (int key; !explorer->leave && (key = gm_console_key()) >= 0;) {
        press(explorer, key);
    }
}

/* Letters may have changed their size, which the system does not always know. */
static void read_cell_size(struct explorer *explorer)
{
    struct gm_terminal *terminal = &explorer->terminal;
    const struct gm_answers *answers = &terminal->answers;
    int width = answers->cell_width, height = answers->cell_height;
    gm_terminal_cell(&width, &height);
    if (width > 0 && height > 0 && (width != terminal->cell_width || height != terminal->cell_height)) {
        terminal->cell_width = width;
        terminal->cell_height = height;
        explorer->picture.lost = explorer->dirty = true;
    }
}

static void read_keys(struct explorer *explorer)
{
    int waiting = 0;
    if (ioctl(STDIN_FILENO, FIONREAD, &waiting) == 0 && waiting == 0) {
        leave(explorer, GM_EXIT_OK); /* readable, yet nothing to read: the terminal is gone */
        return;
    }
    press_all(explorer);
    read_cell_size(explorer);
}

/* Before the terminal goes back to the shell: sends what is under way, and awaits the answers, which the
   shell would take for keys. */
static void come_to_rest(struct explorer *explorer)
{
    enum { PATIENCE = 1000 };
    struct gm_writer *writer = &explorer->writer;
    int64_t until = milliseconds() + PATIENCE;
    for (int64_t left = PATIENCE; left > 0; left = until - milliseconds()) {
        bool good = gm_writer_send(writer);
        gm_writer_takes(writer, explorer->terminal.answers.ready);
        if (!good || (gm_writer_idle(writer) && gm_writer_patience(writer) < 0)) {
            return;
        }
        struct pollfd watched[] = {
            {.fd = STDIN_FILENO, .events = POLLIN},
            {.fd = gm_writer_idle(writer) ? -1 : writer->fd, .events = POLLOUT},
        };
        if (poll(watched, 2, (int)left) < 0 || watched[0].revents & ~POLLIN) {
            return; /* a signal, or the terminal is gone */
        }
        gm_console_key();
    }
}

static void suspend(struct explorer *explorer)
{
    come_to_rest(explorer);
    gm_console_stop();
    resize(explorer);
}

static void read_picture(struct explorer *explorer)
{
    struct picture *picture = &explorer->picture;
    char message[GM_MESSAGE];
    if (!picture->painter || !gm_pixels_take(picture->painter, &picture->bytes, &picture->size, message)) {
        return;
    }
    explorer->dirty = true;
    picture->painted = picture->bytes != NULL;
    if (!picture->painted) { /* there is no GL, or no memory for it: blocks need neither */
        explorer->terminal.can_pixels[GM_INLINE_KITTY] = explorer->terminal.can_pixels[GM_INLINE_SIXEL] =
            false;
        explorer->face.pixels = GM_INLINE_NONE;
    }
}

static void read_news(struct explorer *explorer)
{
    uint64_t count;
    if (read(explorer->wake, &count, sizeof count) < 0 && errno != EAGAIN && errno != EINTR) {
        leave(explorer, GM_EXIT_USAGE);
    }
    if (gm_console_leaving()) {
        leave(explorer, GM_EXIT_INTERRUPTED);
    }
    if (gm_console_stopping()) {
        suspend(explorer);
    }
    if (gm_console_resized()) {
        resize(explorer);
    }
    struct gm_shot *shot = explorer->worker ? gm_worker_take(explorer->worker) : NULL;
    if (shot) {
        explorer->shot = shot;
        explorer->asked = false;
        explorer->next_shot = milliseconds() + FRAME_MILLISECONDS;
        explorer->dirty = explorer->fresh = explorer->picture.stale = true;
    }
    read_picture(explorer);
}

/* ---- output ---- */

static void compose(struct explorer *explorer)
{
    if (!explorer->worker) {
        gm_screen_draw_start(&explorer->screen, &explorer->face, explorer->choice);
    } else if (explorer->shot) {
        gm_screen_draw(&explorer->screen, &explorer->face, explorer->shot, explorer->fresh);
    }
    explorer->fresh = false;
}

static size_t covered_cells(const struct gm_screen *screen)
{
    size_t count = 0;
    for (int row = 0; row < screen->pixel_rows; row++) {
        for (int column = 0; column < screen->pixel_columns; column++) {
            count += screen->cells.cells[row * screen->cells.columns + column].glyph != 0;
        }
    }
    return count;
}

static void remove_picture(struct explorer *explorer)
{
    gm_writer_tell(&explorer->writer, gm_inline_removal(explorer->picture.shown));
    explorer->picture.shown = GM_INLINE_NONE;
    explorer->picture.lost = true;
}

/* Begins the picture that the screen leaves room for, unless it is there. */
static bool begin_picture(struct explorer *explorer)
{
    struct picture *picture = &explorer->picture;
    const struct gm_screen *screen = &explorer->screen;
    const struct gm_terminal *terminal = &explorer->terminal;
    struct gm_pixels_job job = {
        .kind = explorer->face.pixels,
        .place = {screen->pixel_columns, screen->pixel_rows, terminal->cell_width, terminal->cell_height},
        .most_width = terminal->answers.most_width,
        .most_height = terminal->answers.most_height,
    };
    size_t covered = covered_cells(screen);
    if (job.kind != picture->job.kind || memcmp(&job.place, &picture->job.place, sizeof job.place) != 0) {
        remove_picture(explorer);
    }
    if (covered < picture->covered) { /* what covered it has overwritten it */
        picture->lost = true;
    }
    picture->covered = covered;
    if (!picture->lost && (picture->painted || !picture->stale)) {
        return false;
    }
    if (!picture->painter) {
        picture->painter = gm_pixels_open(terminal->theme, explorer->wake, explorer->message);
        if (!picture->painter) {
            leave(explorer, GM_EXIT_USAGE);
            return true;
        }
    }
    job.whole = picture->lost;
    picture->job = job;
    picture->painted = picture->stale = picture->lost = false;
    gm_pixels_paint(picture->painter, explorer->shot->picture, &job);
    return true;
}

static bool painting(const struct explorer *explorer)
{
    return explorer->picture.painter && gm_pixels_busy(explorer->picture.painter);
}

/* The picture and what is around it appear together. */
static void draw(struct explorer *explorer)
{
    struct picture *picture = &explorer->picture;
    if (explorer->worker && !explorer->shot) {
        return;
    }
    compose(explorer);
    const struct gm_screen *screen = &explorer->screen;
    bool pixels = screen->pixel_columns > 0;
    if (pixels && begin_picture(explorer)) {
        return;
    }
    if (!pixels && picture->shown) {
        remove_picture(explorer);
    }
    const struct gm_writer_image image = {picture->bytes, picture->size, screen->pixel_columns,
                                          screen->pixel_rows};
    gm_writer_draw(&explorer->writer, &screen->cells, pixels && picture->painted ? &image : NULL);
    if (pixels && picture->painted) {
        picture->shown = picture->job.kind;
        picture->painted = false;
    }
    explorer->dirty = false;
}

/* Composes and sends as the terminal takes it: a slow one loses frames, never model time. Returns how long to
   wait for input, in milliseconds; -1: as long as it takes. */
static int output(struct explorer *explorer)
{
    struct gm_writer *writer = &explorer->writer;
    unsigned long ready = explorer->terminal.answers.ready;
    bool good = gm_writer_send(writer);
    /* while a picture is painted it belongs to the painter */
    if (explorer->dirty && !painting(explorer) && gm_writer_takes(writer, ready)) {
        draw(explorer);
        good = good && gm_writer_send(writer);
    }
    if (!good) {
        leave(explorer, GM_EXIT_FILE);
    }
    if (!gm_writer_takes(writer, ready)) {
        return gm_writer_patience(writer);
    }
    if (!explorer->worker || explorer->asked || explorer->dirty || painting(explorer)) {
        return -1;
    }
    int64_t wait = explorer->next_shot - milliseconds();
    if (wait > 0) {
        return (int)wait;
    }
    gm_worker_want(explorer->worker);
    explorer->asked = true;
    return -1;
}

static void run(struct explorer *explorer)
{
    enum { KEYS, NEWS, SCREEN, COUNT };
    resize(explorer);
    while (!explorer->leave) {
        int wait = output(explorer);
        struct pollfd watched[COUNT] = {
            [KEYS] = {.fd = STDIN_FILENO, .events = POLLIN},
            [NEWS] = {.fd = explorer->wake, .events = POLLIN},
            [SCREEN] = {.fd = gm_writer_idle(&explorer->writer) ? -1 : explorer->writer.fd,
                        .events = POLLOUT},
        };
        if (explorer->leave) {
            break;
        }
        int patience = gm_console_patience();
        if (patience >= 0 && (wait < 0 || patience < wait)) {
            wait = patience;
        }
        if (poll(watched, COUNT, wait) < 0) {
            if (errno != EINTR) {
                leave(explorer, GM_EXIT_USAGE);
            }
            continue; /* a signal's news is on its way */
        }
        if (watched[NEWS].revents) {
            read_news(explorer);
        }
        if (patience >= 0 && !watched[KEYS].revents) {
            press_all(explorer);
        } else if (watched[KEYS].revents & POLLIN) {
            read_keys(explorer);
        } else if (watched[KEYS].revents) {
            leave(explorer, GM_EXIT_OK);
        }
    }
}

int gm_explorer(const struct gm_request *request, const struct gm_overrides *overrides)
{
    struct explorer explorer = {.wake = -1, .picture = {.lost = true}};
    if (!gm_terminal_detect(&explorer.terminal, overrides, explorer.message) ||
        !gm_terminal_serves(&explorer.terminal, explorer.message)) {
        fprintf(stderr, "geomint: %s\n", explorer.message);
        return GM_EXIT_USAGE;
    }
    explorer.face = (struct gm_face){.blocks = explorer.terminal.graphics.blocks,
                                     .pixels = explorer.terminal.graphics.pixels,
                                     .theme = explorer.terminal.theme,
                                     .few_colours = explorer.terminal.colours < GM_COLOURS_256};
    explorer.wake = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    /* The lanes are opened before the terminal is taken over: a mistake is best read in the shell. */
    bool ok = explorer.wake >= 0;
    if (!ok) {
        snprintf(explorer.message, GM_MESSAGE, "The system has no eventfd to spare.");
    } else if (request && request->scene) {
        ok = open_scene(&explorer, request);
    } else if (gm_scene_count() == 1) {
        ok = open_by_name(&explorer, gm_scene_at(0));
    }
    ok = ok && gm_console_open(explorer.wake, &explorer.terminal, explorer.message);
    int number = 0;
    if (ok && gm_writer_open(&explorer.writer, &explorer.terminal)) {
        run(&explorer);
        number = gm_console_leaving();
        remove_picture(&explorer);
        come_to_rest(&explorer);
        gm_writer_close(&explorer.writer);
    }
    gm_console_close();
    gm_pixels_close(explorer.picture.painter);
    gm_worker_close(explorer.worker);
    gm_screen_close(&explorer.screen);
    if (explorer.wake >= 0) {
        close(explorer.wake);
    }
    if (!ok || explorer.status == GM_EXIT_USAGE) {
        fprintf(stderr, "geomint: %s\n",
                explorer.message[0] ? explorer.message : "There is not enough memory.");
        return GM_EXIT_USAGE;
    }
    if (number != 0 && number != SIGINT) {
        signal(number, SIG_DFL);
        raise(number);
    }
    return explorer.status;
}
