/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is open: begun, left, and ended; and the list of what there is, found, chosen and looked at. */
#include "app/explorer/events.h"

#include <curses.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/files.h"
#include "app/explorer/surface/search.h"
#include "app/explorer/view/pages.h"
#include "render/cells/text.h"
#include "render/clock.h"

enum { FIRST_SCHEMES = 3, LOOK_SCHEMES = 2 };

/* A new worker, or NULL, which owes its first shot; of a scene, or of one that it makes by that name. */
static bool take_over(struct gm_open *open, struct gm_worker *worker, const struct gm_scene *scene,
                      const char *name)
{
    open->worker = worker;
    open->scene = scene;
    snprintf(open->name, sizeof open->name, "%s",
             !scene         ? name
             : scene->words ? scene->words[0]
                            : scene->name);
    open->shot = NULL;
    open->told = 0;
    open->asked = true;
    open->next_shot = 0;
    open->said[0] = '\0';
    return worker != NULL;
}

/* Keeps a line for the shell. */
static void keep_parting(struct gm_open *open, const char *line)
{
    char *before = open->partings, *longer = NULL;
    if (line[0] && asprintf(&longer, "%sgeomint: %s\n", before ? before : "", line) > 0) {
        open->partings = longer;
        free(before);
    }
}

void gm_open_leave(struct gm_open *open)
{
    char parting[GM_MESSAGE] = "";
    gm_display_finish(open->display);
    if (open->touring) {
        gm_worker_close(open->worker, parting); /* the tour does not outlive it otherwise */
    } else if (open->worker) {
        gm_worker_abandon(open->worker, parting);
    }
    open->worker = NULL;
    open->touring = false;
    keep_parting(open, gm_text_tame(parting));
}

bool gm_open_request(struct gm_open *open, const struct gm_request *request, char *message)
{
    gm_open_leave(open);
    return take_over(open, gm_worker_open(request, open->wake, NULL, message), request->scene, NULL);
}

bool gm_open_line(struct gm_open *open, const char *line, struct gm_typed_fault *fault)
{
    struct gm_request request;
    if (!gm_typed_request(&request, line, FIRST_SCHEMES, fault)) {
        return false;
    }
    struct gm_worker *worker = gm_worker_open(&request, open->wake, NULL, fault->sentence);
    if (worker) {
        gm_open_leave(open);
        take_over(open, worker, request.scene, NULL);
    }
    gm_request_close(&request);
    return worker != NULL;
}

/* A scene, a system or a room as its name alone gives it; a preview is for the list of them. */
static bool open_named(struct gm_open *open, const char *name, bool preview, char *message)
{
    gm_open_leave(open);
    const size_t schemes = preview ? LOOK_SCHEMES : FIRST_SCHEMES;
    return take_over(open, gm_worker_open_named(name, schemes, preview, open->wake, message), NULL, name);
}

void gm_open_take(struct gm_open *open, struct gm_shot *shot)
{
    open->shot = shot;
    open->scene = shot->scene;
    open->asked = false;
}

void gm_open_study(struct gm_open *open)
{
    const struct gm_guide *guide = &open->guide;
    const struct gm_tour_step *step = &guide->tour->steps[guide->step];
    open->studies.shown = GM_STUDY_NONE;
    if (step->study != GM_STUDY_NONE && guide->answered) {
        const struct gm_request *request =
            &guide->tour->steps[gm_tour_first(guide->tour, guide->step)].request;
        gm_studies_open(&open->studies, step->study, request->scene, step->study_words, open->wake);
    }
}

bool gm_open_step(struct gm_open *open, char *message)
{
    const struct gm_guide *guide = &open->guide;
    const struct gm_order first = {
        .kind = GM_ORDER_TOUR, .amount = !guide->answered, .tour = guide->tour, .step = guide->step};
    const struct gm_request *request = &guide->tour->steps[gm_tour_first(guide->tour, guide->step)].request;
    gm_open_leave(open);
    gm_open_study(open);
    open->touring = true;
    return take_over(open, gm_worker_open(request, open->wake, &first, message), request->scene, NULL);
}

/* ---- the list ---- */

/* The choice in the list of scenes rests for this long before it is looked at. */
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

/* One that memory is too short for is not offered, nor a name that a terminal cannot show. */
static void add_file(struct gm_list *list, enum gm_start_group group, const struct gm_listed *listed)
{
    struct gm_start_entry *longer = NULL;
    char *name = NULL, *title = NULL;
    if (!is_listed(list, listed->name) && !gm_scene_find(listed->name) && gm_text_is_plain(listed->name)) {
        longer = realloc(list->files, (list->file_count + 1) * sizeof *longer);
        list->files = longer ? longer : list->files;
        name = strdup(listed->name);
        title = strdup(listed->title);
    }
    if (longer && name && title) {
        list->files[list->file_count++] =
            (struct gm_start_entry){.group = group, .name = name, .title = gm_text_tame(title)};
    } else {
        free(name);
        free(title);
    }
}

static void add_system(const struct gm_listed *listed, const void *list)
{
    add_file(*(struct gm_list *const *)list, GM_START_SYSTEMS, listed);
}

static void add_room(const struct gm_listed *listed, const void *list)
{
    add_file(*(struct gm_list *const *)list, GM_START_ROOMS, listed);
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

/* ---- what is chosen ---- */

/* Whether the worker is that of this entry. */
static bool is_open(const struct gm_explorer *explorer, const struct gm_start_entry *entry)
{
    const struct gm_open *open = &explorer->open;
    if (entry->tour) {
        return open->touring && strcmp(entry->name, open->guide.tour->name) == 0;
    }
    if (gm_start_is_user(entry)) { /* or by a file that is in no list */
        return !open->touring && open->scene && open->scene->text && !is_listed(&explorer->list, open->name);
    }
    return !open->touring && open->worker && strcmp(entry->name, open->name) == 0;
}

/* Whether it has a live look. */
static bool can_be_looked_at(const struct gm_start_entry *entry)
{
    return entry && !entry->tour && !gm_start_is_user(entry);
}

bool gm_explorer_is_looked_at(const struct gm_explorer *explorer)
{
    const struct gm_start_entry *entry = chosen(explorer);
    return can_be_looked_at(entry) && is_open(explorer, entry);
}

void gm_explorer_look_soon(struct gm_explorer *explorer)
{
    const struct gm_start_entry *entry = chosen(explorer);
    bool due = can_be_looked_at(entry) && !is_open(explorer, entry);
    explorer->list.look_due = due ? gm_clock_milliseconds() + REST_MILLISECONDS : -1;
    explorer->dirty = true;
}

void gm_explorer_look(struct gm_explorer *explorer)
{
    explorer->list.look_due = -1;
    explorer->list.kept = false;
    if (!open_named(&explorer->open, chosen(explorer)->name, true, explorer->message)) {
        gm_explorer_leave(explorer, GM_EXIT_USAGE);
    }
}

/* Takes what is found into the list, from place `first` on: the best answer to what was typed comes first. */
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

/* What was chosen before stays so unless something else answers better. */
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
    gm_explorer_look_soon(explorer);
}

void gm_explorer_show_start(struct gm_explorer *explorer)
{
    char message[GM_MESSAGE]; /* what cannot be read is for `geomint list` to tell */
    if (!explorer->list.tours) {
        explorer->list.tours = gm_tours_read(&explorer->list.tour_count, message);
    }
    struct gm_list *list = &explorer->list;
    close_files(list);
    gm_files_each(GM_FILE_SYSTEM, add_system, &list, message);
    gm_files_each(GM_FILE_ROOM, add_room, &list, message);
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
    gm_explorer_look_soon(explorer);
}

/* A tour that was left goes on with the step where it was. */
static bool enter_tour(struct gm_explorer *explorer, const struct gm_tour *tour)
{
    struct gm_guide *guide = &explorer->open.guide;
    if (!guide->tour || strcmp(guide->tour->name, tour->name) != 0) {
        *guide = gm_guide_open(tour);
        explorer->face.guide = guide;
    }
    return gm_open_step(&explorer->open, explorer->message);
}

static bool enter_named(struct gm_explorer *explorer, const char *name)
{
    explorer->open.guide.tour = NULL;
    explorer->face.guide = NULL;
    return open_named(&explorer->open, name, false, explorer->message);
}

void gm_explorer_enter(struct gm_explorer *explorer)
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

void gm_explorer_press_in_list(struct gm_explorer *explorer, int key)
{
    struct gm_start *start = &explorer->list.start;
    size_t count = start->count;
    explorer->dirty = true;
    if (explorer->face.page != GM_PAGE_SCENE) {
        if (gm_pages_press(key, &explorer->face) == GM_KEY_LEAVE) {
            gm_explorer_leave(explorer, GM_EXIT_OK);
        }
    } else if (key == '?') {
        explorer->face.page = GM_PAGE_START;
        explorer->face.scroll = 0;
    } else if (gm_key_is_enter(key)) {
        gm_explorer_enter(explorer);
    } else if (gm_key_is_escape(key)) {
        start->typed[0] = '\0';
        find_all(explorer);
    } else if (key == 'q' && !start->typed[0]) {
        gm_explorer_leave(explorer, GM_EXIT_OK);
    } else if ((key == KEY_UP || key == KEY_DOWN) && count > 0) {
        start->choice = (start->choice + (key == KEY_UP ? count - 1 : 1)) % count;
        gm_explorer_look_soon(explorer);
    } else if ((key == KEY_HOME || key == KEY_END) && count > 0) {
        start->choice = key == KEY_HOME ? 0 : count - 1;
        gm_explorer_look_soon(explorer);
    } else if (key == '\t' || key == KEY_BTAB) {
        start->choice = gm_start_next_group(start);
        gm_explorer_look_soon(explorer);
    } else if (key == '/' && !start->typed[0]) {
        /* what is typed is looked for anyway */
    } else if (gm_typed_key(start->typed, key)) {
        find_all(explorer);
    }
}
