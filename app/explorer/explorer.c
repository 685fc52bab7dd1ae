/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/explorer/explorer.h"

#include <curses.h>
#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "app/explorer/console.h"
#include "app/explorer/guide.h"
#include "app/explorer/keys.h"
#include "app/explorer/studies.h"
#include "app/explorer/writer.h"

enum { FRAME_MILLISECONDS = 33, FIRST_SCHEMES = 3 };

struct explorer {
    struct gm_terminal terminal;
    struct gm_face face;
    struct gm_screen screen;
    struct gm_writer writer;
    int wake;                 /* the worker's shots and all signals are announced here */
    struct gm_worker *worker; /* NULL: the list of scenes is shown */
    struct gm_shot *shot;
    struct gm_guide guide;
    struct gm_studies studies;
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

static bool open_scene(struct explorer *explorer, const struct gm_request *request,
                       const struct gm_order *first)
{
    explorer->worker =
        gm_worker_open(request, explorer->terminal.theme, explorer->wake, first, explorer->message);
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
    bool ok = open_scene(explorer, &request, NULL);
    gm_request_close(&request);
    return ok;
}

/* ---- a tour ---- */

static void begin_study(struct explorer *explorer)
{
    const struct gm_guide *guide = &explorer->guide;
    const struct gm_tour_step *step = &guide->tour->steps[guide->step];
    explorer->studies.shown = GM_STUDY_NONE;
    if (step->study != GM_STUDY_NONE && guide->answered) {
        gm_studies_open(&explorer->studies, step->study, step->study_words, explorer->wake);
    }
}

/* The scene of the present step, from its start, in place of what was there. */
static bool open_step(struct explorer *explorer)
{
    const struct gm_guide *guide = &explorer->guide;
    const struct gm_order first = {
        .kind = GM_ORDER_TOUR, .amount = !guide->answered, .tour = guide->tour, .step = guide->step};
    gm_worker_close(explorer->worker);
    explorer->shot = NULL;
    begin_study(explorer);
    return open_scene(explorer, &guide->tour->steps[gm_tour_first(guide->tour, guide->step)].request, &first);
}

static bool press_in_tour(struct explorer *explorer, int key)
{
    if (!explorer->guide.tour || explorer->face.help || explorer->face.choosing) {
        return false;
    }
    switch (gm_guide_press(&explorer->guide, key)) {
    case GM_GUIDE_OPEN:
        if (!open_step(explorer)) {
            leave(explorer, GM_EXIT_USAGE);
        }
        break;
    case GM_GUIDE_RUN:
        begin_study(explorer);
        gm_worker_order(explorer->worker, (struct gm_order){.kind = GM_ORDER_RUN});
        break;
    case GM_GUIDE_END:
        break;
    case GM_GUIDE_IGNORED:
        return false;
    }
    explorer->dirty = true;
    return true;
}

static bool press_in_studies(struct explorer *explorer, int key)
{
    if (explorer->face.help || explorer->face.choosing) {
        return false;
    }
    const bool taken =
        gm_studies_press(&explorer->studies, key, explorer->shot, explorer->terminal.theme, explorer->wake);
    explorer->dirty = explorer->dirty || taken;
    return taken;
}

static void resize(struct explorer *explorer)
{
    int columns, rows;
    gm_terminal_size(&columns, &rows);
    if (!gm_screen_resize(&explorer->screen, columns, rows)) {
        leave(explorer, GM_EXIT_USAGE);
    }
    gm_writer_forget(&explorer->writer);
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

static void press(struct explorer *explorer, int key)
{
    if (!explorer->worker) {
        press_at_start(explorer, key);
        return;
    }
    if (!explorer->shot) { /* before the first picture there is only leaving, or another step */
        if (key == 'q') {
            leave(explorer, GM_EXIT_OK);
        } else {
            press_in_tour(explorer, key);
        }
        return;
    }
    if (press_in_tour(explorer, key) || press_in_studies(explorer, key)) {
        return;
    }
    switch (gm_key_press(key, &explorer->face, explorer->shot, explorer->worker, explorer->terminal.utf8)) {
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

static void read_keys(struct explorer *explorer)
{
    int waiting = 0;
    if (ioctl(STDIN_FILENO, FIONREAD, &waiting) == 0 && waiting == 0) {
        leave(explorer, GM_EXIT_OK); /* readable, yet nothing to read: the terminal is gone */
        return;
    }
    for (int key; !explorer->leave && (key = gm_console_key()) >= 0;) {
        press(explorer, key);
    }
}

static void suspend(struct explorer *explorer)
{
    while (!gm_writer_idle(&explorer->writer) && gm_writer_send(&explorer->writer)) {
        poll(&(struct pollfd){.fd = explorer->writer.fd, .events = POLLOUT}, 1, -1);
    }
    gm_console_stop();
    resize(explorer);
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
    explorer->dirty = gm_studies_look(&explorer->studies) || explorer->dirty;
    struct gm_shot *shot = explorer->worker ? gm_worker_take(explorer->worker) : NULL;
    if (shot) {
        explorer->shot = shot;
        explorer->asked = false;
        explorer->next_shot = milliseconds() + FRAME_MILLISECONDS;
        explorer->dirty = explorer->fresh = true;
    }
}

/* ---- output ---- */

static void draw(struct explorer *explorer)
{
    if (!explorer->worker) {
        gm_screen_draw_start(&explorer->screen, &explorer->face, explorer->choice);
    } else if (explorer->shot) {
        gm_screen_draw(&explorer->screen, &explorer->face, explorer->shot, explorer->fresh);
    } else {
        return;
    }
    explorer->dirty = explorer->fresh = false;
    gm_writer_draw(&explorer->writer, &explorer->screen.cells);
}

/* Composes and sends as the terminal takes it: a slow one loses frames, never model time. Returns how long to
   wait for input, in milliseconds; -1: as long as it takes. */
static int output(struct explorer *explorer)
{
    if (gm_writer_idle(&explorer->writer) && explorer->dirty) {
        draw(explorer);
    }
    if (!gm_writer_send(&explorer->writer)) {
        leave(explorer, GM_EXIT_FILE);
    }
    if (!explorer->worker || explorer->asked || !gm_writer_idle(&explorer->writer)) {
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
        if (poll(watched, COUNT, wait) < 0) {
            if (errno != EINTR) {
                leave(explorer, GM_EXIT_USAGE);
            }
            continue; /* a signal's news is on its way */
        }
        if (watched[NEWS].revents) {
            read_news(explorer);
        }
        if (watched[KEYS].revents & POLLIN) {
            read_keys(explorer);
        } else if (watched[KEYS].revents) {
            leave(explorer, GM_EXIT_OK);
        }
    }
}

/* A request or a tour, or neither: the list of scenes. */
static int explore(const struct gm_request *request, const struct gm_tour *tour)
{
    struct explorer explorer = {.wake = -1};
    if (!gm_terminal_detect(&explorer.terminal, explorer.message) ||
        !gm_terminal_serves(&explorer.terminal, explorer.message)) {
        fprintf(stderr, "geomint: %s\n", explorer.message);
        return GM_EXIT_USAGE;
    }
    explorer.face = (struct gm_face){.blocks = explorer.terminal.blocks,
                                     .theme = explorer.terminal.theme,
                                     .few_colours = explorer.terminal.colours < GM_COLOURS_256,
                                     .studies = &explorer.studies};
    explorer.wake = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    /* The lanes are opened before the terminal is taken over: a mistake is best read in the shell. */
    bool ok = explorer.wake >= 0;
    if (!ok) {
        snprintf(explorer.message, GM_MESSAGE, "The system has no eventfd to spare.");
    } else if (tour) {
        explorer.guide = gm_guide_open(tour);
        explorer.face.guide = &explorer.guide;
        ok = open_step(&explorer);
    } else if (request && request->scene) {
        ok = open_scene(&explorer, request, NULL);
    } else if (gm_scene_count() == 1) {
        ok = open_by_name(&explorer, gm_scene_at(0));
    }
    ok = ok && gm_console_open(explorer.wake, explorer.message);
    int number = 0;
    if (ok && gm_writer_open(&explorer.writer, &explorer.terminal)) {
        run(&explorer);
        number = gm_console_leaving();
        gm_writer_close(&explorer.writer);
    }
    gm_console_close();
    gm_worker_close(explorer.worker);
    gm_studies_close(&explorer.studies);
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

int gm_explorer(const struct gm_request *request)
{
    return explore(request, NULL);
}

int gm_explorer_tour(const struct gm_tour *tour)
{
    return explore(NULL, tour);
}
