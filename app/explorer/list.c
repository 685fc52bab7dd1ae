/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of scenes, and the screen. */
#include "app/explorer/events.h"

#include <curses.h>
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

/* ---- the entries ---- */

/* Returns true for the name of a system or a room of a file. */
static bool is_listed(const struct gm_list *list, const char *name)
{
    for (size_t i = 0; i < list->count; i++) {
        if (list->entries[i].group >= GM_START_SYSTEMS && strcmp(list->entries[i].name, name) == 0) {
            return true;
        }
    }
    return false;
}

/* Adds an entry; returns false when out of memory. */
static bool add(struct gm_list *list, struct gm_start_entry entry)
{
    struct gm_start_entry *longer =
        entry.name && entry.title ? realloc(list->entries, (list->count + 1) * sizeof *longer) : NULL;
    if (longer) {
        list->entries = longer;
        longer[list->count++] = entry;
    }
    return longer;
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
    if (is_listed(taking->list, listed->name) || gm_scene_number(listed->name) < gm_scene_count() ||
        !gm_text_is_plain(listed->name)) {
        return;
    }
    char *name = strdup(listed->name), *title = strdup(listed->title);
    const char *shown = title ? gm_text_tame(title) : NULL;
    if (!add(taking->list, (struct gm_start_entry){.group = taking->group, .name = name, .title = shown})) {
        free(name);
        free(title);
    }
}

static void close_entries(struct gm_list *list)
{
    for (size_t i = 0; i < list->count; i++) {
        if (list->entries[i].group >= GM_START_SYSTEMS) {
            free((char *)list->entries[i].name);
            free((char *)list->entries[i].title);
        }
    }
    free(list->entries);
    list->entries = NULL;
    list->count = list->start.count = 0;
}

/* Lists the scenes, the typed system, the tours and the files, group by group. */
static void read_entries(struct gm_list *list)
{
    char message[GM_MESSAGE]; /* `geomint list` reports unreadable files */
    close_entries(list);
    for (size_t i = 0; i < gm_scene_count(); i++) {
        const struct gm_scene *scene = gm_scene_at(i);
        add(list, (struct gm_start_entry){.name = scene->name,
                                          .title = scene->title,
                                          .more = {scene->blurb, scene->watch},
                                          .scene = scene});
    }
    add(list, (struct gm_start_entry){.name = GM_START_OWN, .title = GM_START_OWN_TITLE});
    if (!list->tours) {
        list->tours = gm_tours_read(&list->tour_count, message);
    }
    for (size_t i = 0; i < list->tour_count; i++) {
        const struct gm_tour *tour = &list->tours[i];
        add(list, (struct gm_start_entry){.group = GM_START_TOURS,
                                          .name = tour->name,
                                          .title = tour->title,
                                          .more = {tour->about, "tour"},
                                          .tour = tour});
    }
    gm_files_each(GM_FILE_SYSTEM, add_file, &(const struct taking){list, GM_START_SYSTEMS}, message);
    gm_files_each(GM_FILE_ROOM, add_file, &(const struct taking){list, GM_START_ROOMS}, message);
}

void gm_explorer_close_list(struct gm_list *list)
{
    close_entries(list);
    gm_tours_close(list->tours, list->tour_count);
}

/* ---- the choice ---- */

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

static bool can_be_looked_at(const struct gm_start_entry *entry)
{
    return entry && !entry->tour && !gm_start_is_user(entry);
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

/* Finds the entries that match the typed words: of each group the best match first. */
static void find_all(struct gm_explorer *explorer)
{
    const struct gm_list *list = &explorer->list;
    struct gm_start *start = &explorer->list.start;
    const struct gm_start_entry *present = chosen(explorer);
    const struct gm_start_entry before = present ? *present : (struct gm_start_entry){0};
    size_t first = 0;
    start->count = 0;
    for (size_t i = 0; i < list->count && start->count < GM_START_ENTRIES; i++) {
        const struct gm_start_entry *entry = &list->entries[i];
        const char *texts[] = {entry->name, entry->title, entry->more[0] ? entry->more[0] : "",
                               entry->more[1] ? entry->more[1] : "", NULL};
        const int rank = gm_search_rank(start->typed, texts);
        first = i > 0 && entry->group != entry[-1].group ? start->count : first;
        if (rank >= 0) {
            const size_t at = gm_search_place(start->ranks, first, start->count, rank);
            memmove(&start->found[at + 1], &start->found[at], (start->count++ - at) * sizeof *entry);
            start->found[at] = *entry;
        }
    }
    choose(start, present ? &before : NULL);
    look_soon(explorer);
}

void gm_explorer_show_start(struct gm_explorer *explorer)
{
    read_entries(&explorer->list);
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

/* Opens an entry; a tour that was left is resumed at its step. */
static bool open_entry(struct gm_explorer *explorer, const struct gm_start_entry *entry)
{
    struct gm_guide *guide = &explorer->open.guide;
    explorer->face.parameter = 0;
    if (!entry->tour) {
        guide->tour = NULL;
        explorer->face.guide = NULL;
        return gm_open_named(&explorer->open, entry->name, false, explorer->message);
    }
    if (!guide->tour || strcmp(guide->tour->name, entry->tour->name) != 0) {
        *guide = gm_guide_at(entry->tour, 0);
        explorer->face.guide = guide;
    }
    return gm_open_step(&explorer->open, explorer->message);
}

/* Opens the chosen entry, or returns to it if it is still open. */
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
    if (!goes_on && !open_entry(explorer, entry)) {
        gm_explorer_leave(explorer, GM_EXIT_USAGE);
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

void gm_explorer_click_entry(struct gm_explorer *explorer, size_t entry)
{
    if (explorer->list.start.choice == entry) {
        enter(explorer);
    } else {
        choose_entry(explorer, entry);
    }
}

/* ---- the screen: shots of the worker are taken, and a screen is composed ---- */

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
        const struct gm_start_entry *entry = chosen(explorer);
        const bool looked = can_be_looked_at(entry) && is_open(explorer, entry);
        gm_screen_draw_start(screen, face, &explorer->list.start, looked ? shot : NULL, explorer->fresh,
                             looked ? explorer->open.said : "");
    } else if (shot) {
        if (face->page == GM_PAGE_HELP) {
            face->explained = shot->lanes[shot->selected].scheme;
        }
        if (face->page == GM_PAGE_HELP || face->page == GM_PAGE_SCHEME) {
            struct gm_arguments scheme = {.count = 1,
                                          .words = (char *[]){(char *)face->explained->name, NULL}};
            char *words = gm_arguments_join("certify", &scheme);
            gm_measure_ask(&explorer->measure, words ? words : "");
            free(words);
        }
        face->measured = gm_measure_text(&explorer->measure);
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
