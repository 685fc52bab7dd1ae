/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The user's input: the list of scenes, and the mouse. */
#include "app/explorer/events.h"

#include <curses.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/files.h"
#include "app/explorer/surface/surface.h"
#include "app/explorer/view/view.h"
#include "render/cells/text.h"
#include "render/clock.h"

/* ---- the list ---- */

/* time (ms) before the chosen scene is previewed */
enum { REST_MILLISECONDS = 150 };

static const struct gm_start_entry *chosen(const struct gm_explorer *explorer)
{
    const struct gm_start *start = &explorer->list.start;
    return start->choice < start->count ? &start->found[start->choice] : NULL;
}

/* ---- systems and rooms of files ---- */

static bool is_listed(const struct gm_list *list, const char *name)
{
    for (size_t i = 0; i < list->file_count; i++) {
        if (strcmp(list->files[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

/* The list and group that files are added to. */
struct taking {
    struct gm_list *list;
    enum gm_start_group group;
};

/* Adds a file, unless memory is short or a terminal cannot show its name. */
static void add_file(const struct gm_listed *listed, const void *data)
{
    const struct taking *taking = data;
    struct gm_list *list = taking->list;
    struct gm_start_entry *longer = NULL;
    char *name = NULL, *title = NULL;
    if (!is_listed(list, listed->name) && gm_scene_number(listed->name) == gm_scene_count() &&
        gm_text_is_plain(listed->name)) {
        longer = realloc(list->files, (list->file_count + 1) * sizeof *longer);
        list->files = longer ? longer : list->files;
        name = strdup(listed->name);
        title = strdup(listed->title);
    }
    if (longer && name && title) {
        list->files[list->file_count++] =
            (struct gm_start_entry){.group = taking->group, .name = name, .title = gm_text_tame(title)};
    } else {
        free(name);
        free(title);
    }
}

static void close_files(struct gm_list *list)
{
    for (size_t i = 0; i < list->file_count; i++) {
        free((char *)list->files[i].name);
        free((char *)list->files[i].title);
    }
    free(list->files);
    list->files = NULL;
    list->file_count = list->start.count = 0;
}

void gm_explorer_close_list(struct gm_list *list)
{
    close_files(list);
    gm_tours_close(list->tours, list->tour_count);
}

/* ---- the choice ---- */

/* Returns true if the worker plays this entry. */
static bool is_open(const struct gm_explorer *explorer, const struct gm_start_entry *entry)
{
    const struct gm_open *open = &explorer->open;
    if (entry->tour) {
        return open->touring && strcmp(entry->name, open->guide.tour->name) == 0;
    }
    if (gm_start_is_user(entry)) { /* or an unlisted file */
        return !open->touring && open->scene && open->scene->text && !is_listed(&explorer->list, open->name);
    }
    return !open->touring && open->worker && strcmp(entry->name, open->name) == 0;
}

/* Returns true if the entry has a preview. */
static bool can_be_looked_at(const struct gm_start_entry *entry)
{
    return entry && !entry->tour && !gm_start_is_user(entry);
}

bool gm_explorer_is_looked_at(const struct gm_explorer *explorer)
{
    const struct gm_start_entry *entry = chosen(explorer);
    return can_be_looked_at(entry) && is_open(explorer, entry);
}

/* Schedules the preview of the chosen scene, unless it is open. */
static void look_soon(struct gm_explorer *explorer)
{
    const struct gm_start_entry *entry = chosen(explorer);
    bool due = can_be_looked_at(entry) && !is_open(explorer, entry);
    explorer->list.look_due = due ? gm_clock_milliseconds() + REST_MILLISECONDS : -1;
    explorer->dirty = true;
}

static void choose_entry(struct gm_explorer *explorer, size_t choice)
{
    explorer->list.start.choice = choice;
    look_soon(explorer);
}

void gm_explorer_look_if_due(struct gm_explorer *explorer)
{
    if (!explorer->list.shown || explorer->list.look_due < 0 ||
        explorer->list.look_due > gm_clock_milliseconds()) {
        return;
    }
    explorer->list.look_due = -1;
    explorer->list.kept = false;
    if (!gm_open_named(&explorer->open, chosen(explorer)->name, true, explorer->message)) {
        gm_explorer_leave(explorer, GM_EXIT_USAGE);
    }
}

/* Inserts a matching entry into the list, from index `first` on, the best match first. */
static void find(struct gm_start *start, size_t first, const struct gm_start_entry *entry, const char *more,
                 const char *further)
{
    const char *texts[] = {entry->name, entry->title, more ? more : "", further ? further : "", NULL};
    const int rank = gm_search_rank(start->typed, texts);
    if (rank < 0 || start->count == GM_START_ENTRIES) {
        return;
    }
    const size_t at = gm_search_place(start->ranks, first, start->count, rank);
    memmove(&start->found[at + 1], &start->found[at], (start->count++ - at) * sizeof *entry);
    start->found[at] = *entry;
}

static void find_scenes(struct gm_start *start)
{
    for (size_t i = 0; i < gm_scene_count(); i++) {
        const struct gm_scene *scene = gm_scene_at(i);
        const struct gm_start_entry entry = {
            .group = GM_START_SCENES, .name = scene->name, .title = scene->title, .scene = scene};
        find(start, 0, &entry, scene->blurb, scene->watch);
    }
    const struct gm_start_entry start_entry = {
        .group = GM_START_SCENES, .name = GM_START_OWN, .title = GM_START_OWN_TITLE};
    find(start, 0, &start_entry, NULL, NULL);
}

static void find_tours(struct gm_start *start, const struct gm_list *list)
{
    const size_t first = start->count;
    for (size_t i = 0; i < list->tour_count; i++) {
        const struct gm_tour *tour = &list->tours[i];
        const struct gm_start_entry entry = {
            .group = GM_START_TOURS, .name = tour->name, .title = tour->title, .tour = tour};
        find(start, first, &entry, tour->about, "tour");
    }
}

static void find_files(struct gm_start *start, const struct gm_list *list, enum gm_start_group group)
{
    const size_t first = start->count;
    for (size_t i = 0; i < list->file_count; i++) {
        if (list->files[i].group == group) {
            find(start, first, &list->files[i], NULL, NULL);
        }
    }
}

/* Chooses the best match; the previous choice wins a tie. */
static void choose(struct gm_start *start, const struct gm_start_entry *before)
{
    start->choice = 0;
    for (size_t i = 1; i < start->count && before; i++) {
        const struct gm_start_entry *entry = &start->found[i];
        const bool same = entry->group == before->group && entry->name == before->name;
        const int rank = start->ranks[i], best = start->ranks[start->choice];
        start->choice = rank < best || (rank == best && same) ? i : start->choice;
    }
}

static void find_all(struct gm_explorer *explorer)
{
    struct gm_start *start = &explorer->list.start;
    const struct gm_start_entry *present = chosen(explorer);
    const struct gm_start_entry before = present ? *present : (struct gm_start_entry){0};
    start->count = 0;
    find_scenes(start);
    find_tours(start, &explorer->list);
    find_files(start, &explorer->list, GM_START_SYSTEMS);
    find_files(start, &explorer->list, GM_START_ROOMS);
    choose(start, present ? &before : NULL);
    look_soon(explorer);
}

void gm_explorer_show_start(struct gm_explorer *explorer)
{
    char message[GM_MESSAGE]; /* `geomint list` reports unreadable files */
    if (!explorer->list.tours) {
        explorer->list.tours = gm_tours_read(&explorer->list.tour_count, message);
    }
    close_files(&explorer->list);
    gm_files_each(GM_FILE_SYSTEM, add_file, &(const struct taking){&explorer->list, GM_START_SYSTEMS},
                  message);
    gm_files_each(GM_FILE_ROOM, add_file, &(const struct taking){&explorer->list, GM_START_ROOMS}, message);
    explorer->list.shown = true;
    explorer->editing = false;
    explorer->list.start.typed[0] = '\0';
    find_all(explorer);
    for (size_t i = 0; i < explorer->list.start.count; i++) {
        if (is_open(explorer, &explorer->list.start.found[i])) {
            explorer->list.start.choice = i;
        }
    }
    explorer->list.kept = explorer->open.scene != NULL;
    look_soon(explorer);
}

/* Opens a tour; one that was left is resumed at its step. */
static bool enter_tour(struct gm_explorer *explorer, const struct gm_tour *tour)
{
    struct gm_guide *guide = &explorer->open.guide;
    if (!guide->tour || strcmp(guide->tour->name, tour->name) != 0) {
        *guide = gm_guide_at(tour, 0);
        explorer->face.guide = guide;
    }
    return gm_open_step(&explorer->open, explorer->message);
}

static bool enter_named(struct gm_explorer *explorer, const char *name)
{
    explorer->open.guide.tour = NULL;
    explorer->face.guide = NULL;
    return gm_open_named(&explorer->open, name, false, explorer->message);
}

/* Opens the chosen scene or tour, or returns to it if it is still open. */
static void enter(struct gm_explorer *explorer)
{
    const struct gm_start_entry *entry = chosen(explorer);
    if (!entry) {
        return;
    }
    const bool goes_on = explorer->list.kept && is_open(explorer, entry);
    if (!goes_on && gm_start_is_user(entry)) {
        gm_explorer_ask_system(explorer);
        return;
    }
    if (!goes_on) {
        explorer->face.parameter = 0;
        if (!(entry->tour ? enter_tour(explorer, entry->tour) : enter_named(explorer, entry->name))) {
            gm_explorer_leave(explorer, GM_EXIT_USAGE);
        }
    }
    explorer->list.shown = false;
    explorer->dirty = explorer->fresh = true;
}

void gm_explorer_quit(struct gm_explorer *explorer)
{
    const struct gm_open *open = &explorer->open;
    explorer->dirty = true;
    explorer->face.loss = open->shot && open->shot->recorded >= 0 ? "The recording is not finished"
                          : gm_studies_are_busy(&open->studies)   ? "A diagram is not finished"
                          : open->unsaved                         ? "The formula is not saved"
                                                                  : NULL;
    if (!explorer->face.loss) {
        gm_explorer_leave(explorer, GM_EXIT_OK);
    }
}

void gm_explorer_press_list(struct gm_explorer *explorer, int key)
{
    struct gm_start *start = &explorer->list.start;
    const size_t count = start->count;
    if (key == '?' || key == KEY_F(1)) {
        explorer->face.page = GM_PAGE_START;
        explorer->face.scroll = 0;
    } else if (key == '\n') {
        enter(explorer);
    } else if (key == GM_KEY_ESCAPE) {
        start->typed[0] = '\0';
        find_all(explorer);
    } else if (key == 'q' && !start->typed[0]) {
        gm_explorer_quit(explorer);
    } else if ((key == KEY_UP || key == KEY_DOWN) && count > 0) {
        choose_entry(explorer, (start->choice + (key == KEY_UP ? count - 1 : 1)) % count);
    } else if ((key == KEY_HOME || key == KEY_END) && count > 0) {
        choose_entry(explorer, key == KEY_HOME ? 0 : count - 1);
    } else if (key == '\t' || key == KEY_BTAB) {
        choose_entry(explorer, gm_start_next_group(start));
    } else if ((key != '/' || start->typed[0]) && gm_typed_key(start->typed, key)) {
        find_all(explorer); /* typing searches without a slash */
    }
}

/* ---- the screen ---- */

void gm_explorer_resize(struct gm_explorer *explorer)
{
    int columns, rows;
    gm_terminal_size(&columns, &rows);
    if (!gm_screen_resize(&explorer->screen, columns, rows)) {
        gm_explorer_leave(explorer, GM_EXIT_USAGE);
    }
    gm_display_forget(&explorer->display);
    gm_terminal_cell(&explorer->terminal.cell_width, &explorer->terminal.cell_height);
    if (explorer->face.pixels) {
        gm_writer_tell(&explorer->display.writer, GM_ASK_CELL); /* the font's size may have changed */
    }
    explorer->dirty = explorer->fresh = true;
}

void gm_explorer_copy(struct gm_explorer *explorer)
{
    const char *command = explorer->open.shot->commands[explorer->face.command];
    if (command) {
        gm_writer_copy(&explorer->display.writer, command);
    }
}

/* ---- the mouse ---- */

/* Returns a column's position in a hit, 0 to 1. */
static double part_of(const struct gm_hit *hit, int column)
{
    double part = hit->width > 1 ? (double)(column - hit->column) / (hit->width - 1) : 0;
    return part < 0 ? 0 : part > 1 ? 1 : part;
}

/* Moves a slider with the pressed button. */
static void drag(struct gm_explorer *explorer, int column)
{
    const struct gm_shot *shot = explorer->open.shot;
    struct gm_order order = {.value = part_of(&explorer->pointer.held, column)};
    if (!shot) {
        return;
    }
    if (explorer->pointer.held.kind == GM_HIT_PAST) {
        order.kind = GM_ORDER_VISIT;
        order.value *= shot->reach;
    } else if (explorer->pointer.held.kind == GM_HIT_SLIDER &&
               explorer->pointer.held.index < shot->parameter_count) {
        order.kind = GM_ORDER_SLIDE;
        order.row = shot->parameters[explorer->pointer.held.index].row;
    } else {
        return;
    }
    gm_worker_order(explorer->open.worker, order);
}

/* Chooses a parameter. One without a slider takes its next value at a second click. */
static void click_parameter(struct gm_explorer *explorer, size_t index)
{
    const struct gm_shot_parameter *parameter = &explorer->open.shot->parameters[index];
    bool again = explorer->face.parameter == index;
    explorer->face.parameter = index;
    explorer->face.explaining = true;
    if (again && parameter->position < 0) {
        gm_worker_order(explorer->open.worker,
                        (struct gm_order){.kind = GM_ORDER_MOVE, .amount = 1, .row = parameter->row});
    }
}

static void click_picture(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    struct gm_order order = {.kind = GM_ORDER_POINT};
    const struct gm_screen *screen = &explorer->screen;
    if (!explorer->open.shot->scene->point) {
        return;
    }
    struct gm_picture *picture = explorer->open.shot->picture;
    const struct gm_panel *panel =
        screen->pixels.columns > 0
            ? gm_display_locate(&explorer->display, picture, event->column, event->row, &order.x, &order.y)
            : gm_cells_locate(&screen->picture.cells, picture, screen->picture.blocks,
                              event->column - screen->picture_column, event->row - screen->picture_row,
                              &order.x, &order.y);
    if (panel) {
        gm_worker_order(explorer->open.worker, order);
    }
}

/* Opens the run at a point of a map; the map's key shows the map again. */
static void click_study(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    struct gm_open *open = &explorer->open;
    struct gm_typed_fault fault;
    char *words = gm_studies_pick(&open->studies, explorer->face.blocks, event->column, event->row);
    if (words && !gm_explorer_open_line(explorer, words, &fault)) {
        snprintf(open->studies.notice, sizeof open->studies.notice, "%s", fault.sentence);
    }
    free(words);
}

/* Returns true if the hit is a picture in space. */
static bool is_in_space(const struct gm_explorer *explorer, const struct gm_hit *hit)
{
    return hit && hit->kind == GM_HIT_PICTURE && !explorer->list.shown && explorer->open.shot &&
           explorer->open.shot->in_space && explorer->face.page == GM_PAGE_SCENE &&
           explorer->open.studies.shown == GM_STUDY_NONE;
}

/* Turns the picture with the button: half a turn for the width of the screen. A row is as high as two
   columns are wide. */
static void drag_space(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    struct gm_pointer *pointer = &explorer->pointer;
    const double degrees = 180. / (explorer->screen.cells.columns > 0 ? explorer->screen.cells.columns : 1);
    gm_worker_order(explorer->open.worker, (struct gm_order){.kind = GM_ORDER_LOOK,
                                                             .x = degrees * (pointer->column - event->column),
                                                             .y = 2 * degrees * (event->row - pointer->row),
                                                             .value = 1});
    pointer->column = event->column;
    pointer->row = event->row;
}

/* Handles the wheel: zooms a picture in space, else scrolls a list or changes the speed. */
static void turn_wheel(struct gm_explorer *explorer, const struct gm_mouse_event *event, bool lists)
{
    const bool up = event->kind == GM_MOUSE_UP;
    const bool space =
        !lists && is_in_space(explorer, gm_hits_at(&explorer->screen.hits, event->column, event->row));
    gm_explorer_key(explorer, lists ? (up ? KEY_UP : KEY_DOWN) : space ? (up ? 'z' : 'Z') : up ? ']' : '[');
}

static void click(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    const struct gm_hit *hit = gm_hits_at(&explorer->screen.hits, event->column, event->row);
    if (explorer->face.loss && !(hit && hit->kind == GM_HIT_KEY)) { /* like any key but q */
        explorer->face.loss = NULL;
        return;
    }
    explorer->pointer.holding = hit != NULL;
    if (!hit) {
        return;
    }
    explorer->pointer.held = *hit;
    explorer->pointer.column = event->column;
    explorer->pointer.row = event->row;
    if (hit->kind == GM_HIT_KEY) {
        gm_explorer_key(explorer, (int)hit->index);
        return;
    }
    if (hit->kind == GM_HIT_SCENE) {
        if (explorer->list.start.choice == hit->index) {
            enter(explorer);
        } else {
            choose_entry(explorer, hit->index);
        }
        return;
    }
    if (explorer->list.shown || !explorer->open.shot) {
        return;
    }
    explorer->face.read = explorer->open.shot->message_number;
    switch (hit->kind) {
    case GM_HIT_LANE:
        gm_worker_order(explorer->open.worker,
                        (struct gm_order){.kind = GM_ORDER_SELECT, .value = (double)hit->index});
        break;
    case GM_HIT_SCHEME:
        gm_explorer_choose(explorer, hit->scheme);
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
        if (explorer->open.studies.shown != GM_STUDY_NONE) {
            click_study(explorer, event);
        } else {
            click_picture(explorer, event);
        }
        break;
    case GM_HIT_KEY:
    case GM_HIT_SCENE:
        break;
    }
}

void gm_explorer_point(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    bool lists = explorer->list.shown || explorer->face.page != GM_PAGE_SCENE ||
                 explorer->face.choosing != GM_CHOOSE_NOTHING;
    explorer->dirty = true;
    switch (event->kind) {
    case GM_MOUSE_PRESS:
        click(explorer, event);
        break;
    case GM_MOUSE_DRAG:
        if (explorer->pointer.holding && is_in_space(explorer, &explorer->pointer.held)) {
            drag_space(explorer, event);
        } else if (explorer->pointer.holding && !explorer->list.shown) {
            drag(explorer, event->column);
        }
        break;
    case GM_MOUSE_RELEASE:
        explorer->pointer.holding = false;
        break;
    case GM_MOUSE_UP:
    case GM_MOUSE_DOWN:
        turn_wheel(explorer, event, lists);
        break;
    }
}
