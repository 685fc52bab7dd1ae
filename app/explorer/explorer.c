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
#include "app/explorer/display.h"
#include "app/explorer/guide.h"
#include "app/explorer/keys.h"
#include "app/explorer/measure.h"
#include "app/explorer/modes.h"
#include "app/explorer/mouse.h"
#include "app/explorer/studies.h"

enum { FRAME_MILLISECONDS = 33, LOOK_MILLISECONDS = 66, FIRST_SCHEMES = 3, LOOK_SCHEMES = 2 };

/* The choice in the list of scenes rests for this long before it is looked at. */
enum { REST_MILLISECONDS = 150 };

struct explorer {
    struct gm_terminal terminal;
    struct gm_face face;
    struct gm_screen screen;
    struct gm_display display;
    int wake; /* the worker's shots and all signals are announced here */
    struct gm_worker *worker;
    const struct gm_scene *scene; /* the worker's */
    struct gm_shot *shot;         /* NULL: it has given none yet */
    bool at_start;                /* the list of scenes is shown, and the worker is a look at one */
    struct gm_start start;
    char said[GM_MESSAGE]; /* why that look failed, or "" */
    bool kept;             /* that look is a scene that was left and can be gone back to */
    int64_t look_due;      /* when the chosen scene is looked at; -1: it is */
    struct gm_mouse mouse;
    struct gm_hit held; /* what the button went down on */
    bool holding;
    struct gm_measure measure;
    struct gm_guide guide; /* without a tour: none */
    struct gm_studies studies;
    bool dirty;         /* the screen has to be composed again */
    bool fresh;         /* with a new picture */
    bool asked;         /* for a shot */
    unsigned long told; /* number of the last command line that was shown */
    int64_t next_shot;  /* in milliseconds: no shot is asked for earlier */
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

/* A new worker owes its first shot. */
static void expect_shot(struct explorer *explorer)
{
    explorer->shot = NULL;
    explorer->told = 0;
    explorer->asked = true;
    explorer->next_shot = 0;
}

/* `first` is the worker's first order; NULL: it has none. */
static bool open_request(struct explorer *explorer, const struct gm_request *request,
                         const struct gm_order *first)
{
    explorer->worker =
        gm_worker_open(request, explorer->face.theme, explorer->wake, first, explorer->message);
    explorer->scene = request->scene;
    expect_shot(explorer);
    return explorer->worker != NULL;
}

static void abandon(struct explorer *explorer)
{
    gm_display_finish(&explorer->display); /* it may be painting a picture of this worker's */
    if (explorer->guide.tour) {
        gm_worker_close(explorer->worker); /* the tour does not outlive it otherwise */
    } else if (explorer->worker) {
        gm_worker_abandon(explorer->worker);
    }
    explorer->worker = NULL;
    explorer->scene = NULL;
    explorer->said[0] = '\0';
    expect_shot(explorer);
}

static void open_scene(struct explorer *explorer, const struct gm_scene *scene, bool preview)
{
    abandon(explorer);
    explorer->worker = gm_worker_open_scene(scene, preview ? LOOK_SCHEMES : FIRST_SCHEMES, preview,
                                            explorer->face.theme, explorer->wake, explorer->message);
    explorer->scene = scene;
    if (!explorer->worker) {
        leave(explorer, GM_EXIT_USAGE);
    }
}

/* ---- the list of scenes ---- */

static const struct gm_scene *chosen_scene(const struct explorer *explorer)
{
    const struct gm_start *start = &explorer->start;
    return start->choice < start->count ? start->found[start->choice] : NULL;
}

/* The chosen scene is looked at in a while, unless it is open already. */
static void look_soon(struct explorer *explorer)
{
    explorer->look_due = chosen_scene(explorer) == explorer->scene ? -1 : milliseconds() + REST_MILLISECONDS;
    explorer->dirty = true;
}

static void look(struct explorer *explorer)
{
    const struct gm_scene *scene = chosen_scene(explorer);
    explorer->look_due = -1;
    if (scene) {
        explorer->kept = false;
        open_scene(explorer, scene, true);
    }
}

static void find_scenes(struct explorer *explorer)
{
    struct gm_start *start = &explorer->start;
    const struct gm_scene *before = chosen_scene(explorer);
    start->count = start->choice = 0;
    for (size_t i = 0; i < gm_scene_count() && start->count < GM_START_SCENES; i++) {
        const struct gm_scene *scene = gm_scene_at(i);
        const char *texts[] = {scene->name, scene->title, scene->blurb ? scene->blurb : "",
                               scene->watch ? scene->watch : "", NULL};
        if (gm_is_found(start->typed, texts)) {
            start->choice = scene == before ? start->count : start->choice;
            start->found[start->count++] = scene;
        }
    }
    look_soon(explorer);
}

static void show_start(struct explorer *explorer)
{
    explorer->at_start = true;
    explorer->start.typed[0] = '\0';
    find_scenes(explorer);
    for (size_t i = 0; i < explorer->start.count; i++) {
        if (explorer->start.found[i] == explorer->scene) {
            explorer->start.choice = i;
        }
    }
    explorer->kept = explorer->scene != NULL;
    look_soon(explorer);
}

/* Opens the chosen scene, or goes back to it where it was left. */
static void enter(struct explorer *explorer)
{
    const struct gm_scene *scene = chosen_scene(explorer);
    if (!scene) {
        return;
    }
    explorer->at_start = false;
    explorer->look_due = -1;
    explorer->face.parameter = 0;
    if (scene != explorer->scene || !explorer->kept) {
        open_scene(explorer, scene, false);
    }
    explorer->dirty = explorer->fresh = true;
}

/* ---- tours and studies ---- */

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
    abandon(explorer);
    begin_study(explorer);
    explorer->at_start = explorer->kept = false;
    explorer->look_due = -1;
    explorer->face.parameter = 0;
    return open_request(explorer, &guide->tour->steps[gm_tour_first(guide->tour, guide->step)].request,
                        &first);
}

static void press_in_tour(struct explorer *explorer, int key)
{
    if (!explorer->guide.tour) {
        return;
    }
    explorer->dirty = true;
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
    }
}

static void resize(struct explorer *explorer)
{
    int columns, rows;
    gm_terminal_size(&columns, &rows);
    if (!gm_screen_resize(&explorer->screen, columns, rows)) {
        leave(explorer, GM_EXIT_USAGE);
    }
    gm_display_forget(&explorer->display);
    gm_terminal_cell(&explorer->terminal.cell_width, &explorer->terminal.cell_height);
    if (explorer->face.pixels) {
        gm_writer_tell(&explorer->display.writer, GM_ASK_CELL); /* letters may have another size too */
    }
    explorer->dirty = explorer->fresh = true;
}

/* ---- input ---- */

static void press_at_start(struct explorer *explorer, int key)
{
    struct gm_start *start = &explorer->start;
    size_t count = start->count;
    explorer->dirty = true;
    if (gm_key_is_enter(key)) {
        enter(explorer);
    } else if (gm_key_is_escape(key)) {
        start->typed[0] = '\0';
        find_scenes(explorer);
    } else if (key == 'q' && !start->typed[0]) {
        leave(explorer, GM_EXIT_OK);
    } else if ((key == KEY_UP || key == KEY_DOWN) && count > 0) {
        start->choice = (start->choice + (key == KEY_UP ? count - 1 : 1)) % count;
        look_soon(explorer);
    } else if ((key == KEY_HOME || key == KEY_END) && count > 0) {
        start->choice = key == KEY_HOME ? 0 : count - 1;
        look_soon(explorer);
    } else if (gm_typed_key(start->typed, key)) {
        find_scenes(explorer);
    }
}

/* In other colours, or none. */
static void repaint(struct explorer *explorer)
{
    struct gm_writer *writer = &explorer->display.writer;
    writer->theme = explorer->face.theme;
    writer->colours = explorer->face.monochrome ? GM_COLOURS_NONE : explorer->terminal.colours;
    gm_display_forget(&explorer->display);
    explorer->dirty = explorer->fresh = true;
}

static void next_graphics(struct explorer *explorer)
{
    struct gm_face *face = &explorer->face;
    struct gm_graphics graphics =
        gm_graphics_next(&explorer->terminal, (struct gm_graphics){face->pixels, face->blocks});
    face->pixels = graphics.pixels;
    face->blocks = graphics.blocks;
    explorer->dirty = true;
}

static void press(struct explorer *explorer, int key)
{
    if (explorer->at_start) {
        press_at_start(explorer, key);
        return;
    }
    if (!explorer->shot) { /* before the first picture there is only leaving */
        if (key == 'q') {
            leave(explorer, GM_EXIT_OK);
        } else if (key == 'l') {
            show_start(explorer);
        } else if (key == 'n' || key == 'N' || key == 'a') {
            press_in_tour(explorer, key);
        }
        return;
    }
    const struct gm_face *face = &explorer->face;
    const bool plain =
        face->page == GM_PAGE_SCENE && face->choosing == GM_CHOOSE_NOTHING && face->prompt == GM_PROMPT_NONE;
    if (plain && gm_studies_press(&explorer->studies, key, face->theme)) {
        explorer->dirty = true;
        return;
    }
    const struct gm_press one = {key, &explorer->face, explorer->shot, explorer->worker};
    switch (gm_key_press(&one)) {
    case GM_KEY_LEAVE:
        leave(explorer, GM_EXIT_OK);
        break;
    case GM_KEY_BLOCKS:
        next_graphics(explorer);
        break;
    case GM_KEY_REPAINT:
        resize(explorer);
        break;
    case GM_KEY_THEME:
        repaint(explorer);
        break;
    case GM_KEY_SCENES:
        explorer->studies.shown = GM_STUDY_NONE;
        show_start(explorer);
        break;
    case GM_KEY_STUDY:
        gm_studies_begin(&explorer->studies, key, explorer->shot, explorer->wake);
        explorer->dirty = true;
        break;
    case GM_KEY_TOUR:
        press_in_tour(explorer, key);
        break;
    case GM_KEY_FACE:
    case GM_KEY_ORDER:
        explorer->dirty = true;
        break;
    case GM_KEY_IGNORED:
        break;
    }
}

/* ---- the mouse ---- */

/* The part of a hit's width that a column stands for, 0 to 1. */
static double part_of(const struct gm_hit *hit, int column)
{
    double part = hit->width > 1 ? (double)(column - hit->column) / (hit->width - 1) : 0;
    return part < 0 ? 0 : part > 1 ? 1 : part;
}

/* Sliders follow the button while it is down. */
static void drag(struct explorer *explorer, int column)
{
    const struct gm_shot *shot = explorer->shot;
    struct gm_order order = {.value = part_of(&explorer->held, column)};
    if (!shot) {
        return;
    }
    if (explorer->held.kind == GM_HIT_PAST) {
        order.kind = GM_ORDER_VISIT;
        order.value *= shot->reach;
    } else if (explorer->held.kind == GM_HIT_SLIDER && explorer->held.index < shot->parameter_count) {
        order.kind = GM_ORDER_SLIDE;
        order.row = shot->parameters[explorer->held.index].row;
        order.of_scheme = shot->parameters[explorer->held.index].of_scheme;
    } else {
        return;
    }
    gm_worker_order(explorer->worker, order);
}

static void click_scheme(struct explorer *explorer, const struct gm_scheme *scheme)
{
    bool fork = explorer->face.choosing == GM_CHOOSE_FORK;
    explorer->face.choosing = GM_CHOOSE_NOTHING;
    gm_worker_order(explorer->worker,
                    (struct gm_order){.kind = fork ? GM_ORDER_FORK : GM_ORDER_SWITCH, .scheme = scheme});
}

/* A choice has no slider: a click takes the next one. */
static void click_parameter(struct explorer *explorer, size_t index)
{
    const struct gm_shot_parameter *parameter = &explorer->shot->parameters[index];
    bool again = explorer->face.parameter == index;
    explorer->face.parameter = index;
    explorer->face.explaining = true;
    if (again && parameter->position < 0) {
        gm_worker_order(explorer->worker, (struct gm_order){.kind = GM_ORDER_MOVE,
                                                            .amount = 1,
                                                            .row = parameter->row,
                                                            .of_scheme = parameter->of_scheme});
    }
}

static void click_picture(struct explorer *explorer, const struct gm_mouse_event *event)
{
    struct gm_order order = {.kind = GM_ORDER_POINT};
    const struct gm_screen *screen = &explorer->screen;
    if (!explorer->shot->scene->point) {
        return;
    }
    struct gm_picture *picture = explorer->shot->picture;
    const struct gm_panel *panel =
        screen->pixels.columns > 0
            ? gm_display_locate(&explorer->display, picture, event->column, event->row, &order.x, &order.y)
            : gm_cells_locate(&screen->picture, picture, screen->blocks,
                              event->column - screen->picture_column, event->row - screen->picture_row,
                              &order.x, &order.y);
    if (panel) {
        gm_worker_order(explorer->worker, order);
    }
}

static void click(struct explorer *explorer, const struct gm_mouse_event *event)
{
    const struct gm_hit *hit = gm_hits_at(&explorer->screen.hits, event->column, event->row);
    explorer->holding = hit != NULL;
    if (!hit) {
        return;
    }
    explorer->held = *hit;
    if (hit->kind == GM_HIT_KEY) {
        press(explorer, (int)hit->index);
        return;
    }
    if (hit->kind == GM_HIT_SCENE) {
        if (explorer->start.choice == hit->index) {
            enter(explorer);
        } else {
            explorer->start.choice = hit->index;
            look_soon(explorer);
        }
        return;
    }
    if (explorer->at_start || !explorer->shot) {
        return;
    }
    explorer->face.read = explorer->shot->message_number;
    switch (hit->kind) {
    case GM_HIT_LANE:
        gm_worker_order(explorer->worker,
                        (struct gm_order){.kind = GM_ORDER_SELECT, .value = (double)hit->index});
        break;
    case GM_HIT_SCHEME:
        click_scheme(explorer, hit->scheme);
        break;
    case GM_HIT_SLIDER:
        explorer->face.parameter = hit->index;
        explorer->face.explaining = true;
        drag(explorer, event->column);
        break;
    case GM_HIT_PARAMETER:
        click_parameter(explorer, hit->index);
        break;
    case GM_HIT_PAST:
        drag(explorer, event->column);
        break;
    case GM_HIT_PICTURE:
        click_picture(explorer, event);
        break;
    case GM_HIT_KEY:
    case GM_HIT_SCENE:
        break;
    }
}

static void point(struct explorer *explorer, const struct gm_mouse_event *event)
{
    bool lists = explorer->at_start || explorer->face.page != GM_PAGE_SCENE ||
                 explorer->face.choosing != GM_CHOOSE_NOTHING;
    explorer->dirty = true;
    switch (event->kind) {
    case GM_MOUSE_PRESS:
        click(explorer, event);
        break;
    case GM_MOUSE_DRAG:
        if (explorer->holding && !explorer->at_start) {
            drag(explorer, event->column);
        }
        break;
    case GM_MOUSE_RELEASE:
        explorer->holding = false;
        break;
    case GM_MOUSE_UP:
        press(explorer, lists ? KEY_UP : ']');
        break;
    case GM_MOUSE_DOWN:
        press(explorer, lists ? KEY_DOWN : '[');
        break;
    }
}

/* Letters may have changed their size, which the system does not always know. */
static void read_cell_size(struct explorer *explorer)
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

static void read_keys(struct explorer *explorer)
{
    for (int key; !explorer->leave && (key = gm_console_key()) >= 0;) {
        struct gm_mouse_event event;
        enum gm_mouse_result result = gm_mouse_feed(&explorer->mouse, key, &event);
        if (result == GM_MOUSE_NOT) {
            press(explorer, key);
        } else if (result == GM_MOUSE_EVENT) {
            point(explorer, &event);
        }
    }
}

/* Whether there is something to read; if not, the terminal that seemed to have it is gone. */
static bool has_keys(void)
{
    int waiting = 0;
    return ioctl(STDIN_FILENO, FIONREAD, &waiting) != 0 || waiting > 0;
}

static void suspend(struct explorer *explorer)
{
    gm_display_rest(&explorer->display);
    gm_console_stop();
    resize(explorer);
}

static void read_picture(struct explorer *explorer)
{
    if (!gm_display_read(&explorer->display)) {
        return;
    }
    explorer->dirty = true;
    if (explorer->display.failed) { /* there is no GL: blocks do not need it */
        explorer->terminal.can_pixels[GM_INLINE_KITTY] = explorer->terminal.can_pixels[GM_INLINE_SIXEL] =
            false;
        explorer->face.pixels = GM_INLINE_NONE;
    }
}

/* A command line that was asked for is shown, and offered to the clipboard. */
static void read_command(struct explorer *explorer)
{
    const struct gm_shot *shot = explorer->shot;
    if (shot->command_number == explorer->told) {
        return;
    }
    explorer->told = shot->command_number;
    explorer->face.page = GM_PAGE_COMMAND;
    explorer->face.scroll = 0;
    if (shot->command) {
        gm_writer_copy(&explorer->display.writer, shot->command);
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
    read_picture(explorer);
    explorer->dirty = gm_studies_look(&explorer->studies) || explorer->dirty;
    struct gm_shot *shot = explorer->worker ? gm_worker_take(explorer->worker) : NULL;
    if (shot) {
        explorer->shot = shot;
        read_command(explorer);
        explorer->asked = false;
        explorer->next_shot = milliseconds() + (explorer->at_start ? LOOK_MILLISECONDS : FRAME_MILLISECONDS);
        explorer->dirty = true;
        explorer->fresh = explorer->fresh || shot->drawn;
        if (shot->drawn) {
            gm_display_renew(&explorer->display);
        }
    } else if (explorer->worker && !explorer->shot && !explorer->said[0] &&
               gm_worker_failed(explorer->worker, explorer->said)) {
        explorer->dirty = true;
        if (!explorer->at_start) {
            show_start(explorer);
        }
    }
}

/* ---- output ---- */

/* A page about a scheme wants it measured. */
static void ask_measure(struct explorer *explorer)
{
    struct gm_face *face = &explorer->face;
    if (face->page == GM_PAGE_HELP) {
        face->explained = explorer->shot->lanes[explorer->shot->selected].scheme;
    }
    if (face->page == GM_PAGE_HELP || face->page == GM_PAGE_SCHEME) {
        gm_measure_ask(&explorer->measure, face->explained);
        face->measured = gm_measure_text(&explorer->measure);
    }
}

static void draw(struct explorer *explorer)
{
    struct gm_screen *screen = &explorer->screen;
    struct gm_picture *picture = explorer->shot ? explorer->shot->picture : NULL;
    if (explorer->at_start) {
        bool looked = chosen_scene(explorer) == explorer->scene;
        gm_screen_draw_start(screen, &explorer->face, &explorer->start, looked ? explorer->shot : NULL,
                             explorer->fresh, looked ? explorer->said : "");
    } else if (explorer->shot) {
        ask_measure(explorer);
        gm_screen_draw(screen, &explorer->face, explorer->shot, explorer->fresh);
    } else {
        return;
    }
    explorer->fresh = false;
    explorer->dirty = !gm_display_show(&explorer->display, screen, &explorer->face, picture);
}

/* Composes and sends as the terminal takes it: a slow one loses frames, never model time. Returns how long to
   wait for input, in milliseconds; -1: as long as it takes. */
static int output(struct explorer *explorer)
{
    int64_t now = milliseconds();
    if (explorer->at_start && explorer->look_due >= 0 && explorer->look_due <= now) {
        look(explorer);
    }
    bool good = gm_display_send(&explorer->display);
    if (explorer->dirty && gm_display_takes(&explorer->display)) {
        draw(explorer);
        good = good && gm_display_send(&explorer->display);
    }
    if (!good) {
        leave(explorer, GM_EXIT_FILE);
    }
    if (explorer->at_start && explorer->look_due >= 0) {
        return (int)(explorer->look_due - now);
    }
    if (!gm_display_takes(&explorer->display)) {
        return gm_display_patience(&explorer->display);
    }
    if (!explorer->worker || explorer->asked || explorer->dirty) {
        return -1;
    }
    int64_t wait = explorer->next_shot - now;
    if (wait > 0) {
        return (int)wait;
    }
    gm_worker_want(explorer->worker);
    explorer->asked = true;
    return -1;
}

static void run(struct explorer *explorer)
{
    enum { KEYS, NEWS, SCREEN, MEASURE, COUNT };
    const struct gm_writer *writer = &explorer->display.writer;
    resize(explorer);
    while (!explorer->leave) {
        int wait = output(explorer);
        struct pollfd watched[COUNT] = {
            [KEYS] = {.fd = STDIN_FILENO, .events = POLLIN},
            [NEWS] = {.fd = explorer->wake, .events = POLLIN},
            [SCREEN] = {.fd = gm_writer_idle(writer) ? -1 : writer->fd, .events = POLLOUT},
            [MEASURE] = {.fd = explorer->measure.fd, .events = POLLIN},
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
        if (watched[MEASURE].revents && gm_measure_read(&explorer->measure)) {
            explorer->dirty = true;
        }
        if (watched[KEYS].revents & POLLIN ? has_keys() : patience >= 0 && !watched[KEYS].revents) {
            read_keys(explorer);
            read_cell_size(explorer);
        } else if (watched[KEYS].revents) {
            leave(explorer, GM_EXIT_OK);
        }
    }
}

/* A request or a tour, or neither: the list of scenes. */
static int explore(const struct gm_request *request, const struct gm_tour *tour,
                   const struct gm_overrides *overrides)
{
    struct explorer explorer = {.wake = -1, .look_due = -1, .measure = {.fd = -1}};
    if (!gm_terminal_detect(&explorer.terminal, overrides, explorer.message) ||
        !gm_terminal_serves(&explorer.terminal, explorer.message)) {
        fprintf(stderr, "geomint: %s\n", explorer.message);
        return GM_EXIT_USAGE;
    }
    explorer.face = (struct gm_face){.blocks = explorer.terminal.graphics.blocks,
                                     .pixels = explorer.terminal.graphics.pixels,
                                     .theme = explorer.terminal.theme,
                                     .few_colours = explorer.terminal.colours < GM_COLOURS_256,
                                     .monochrome = explorer.terminal.colours == GM_COLOURS_NONE,
                                     .only_monochrome = explorer.terminal.colours == GM_COLOURS_NONE,
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
        ok = open_request(&explorer, request, NULL);
    } else {
        show_start(&explorer);
    }
    ok = ok && gm_console_open(explorer.wake, &explorer.terminal, explorer.message);
    int number = 0;
    if (ok && gm_display_open(&explorer.display, &explorer.terminal, explorer.wake)) {
        run(&explorer);
        number = gm_console_leaving();
        gm_display_rest(&explorer.display);
        gm_display_close(&explorer.display);
    }
    gm_console_close();
    gm_measure_close(&explorer.measure);
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

int gm_explorer(const struct gm_request *request, const struct gm_overrides *overrides)
{
    return explore(request, NULL, overrides);
}

int gm_explorer_tour(const struct gm_tour *tour, const struct gm_overrides *overrides)
{
    return explore(NULL, tour, overrides);
}
