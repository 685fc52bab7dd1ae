/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the user does: keys, the mouse, and the lines that are typed for a system or a scheme of one's own or a map of
   many runs. */
#include "app/explorer/events.h"

#include <curses.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/explorer/surface/keystroke.h"
#include "app/explorer/view/chooser.h"
#include "app/explorer/view/keys.h"
#include "app/explorer/view/pages.h"
#include "app/explorer/view/prompt.h"
#include "app/grid/grid.h"
#include "app/words/replacing.h"
#include "core/basics.h"
#include "core/schemes.h"
#include "render/message.h"

static const char example[] = "H=p^2/2 - cos(q) q=2 p=0";

static void open_prompt(struct gm_explorer *explorer, enum gm_typed_kind kind, const char *text, size_t at)
{
    struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    prompt->kind = kind;
    prompt->checked = prompt->entered = false;
    prompt->fault = (struct gm_typed_fault){.at = -1};
    gm_edit_set(&prompt->line, text, at);
    explorer->dirty = explorer->fresh = true;
    gm_explorer_check_typed(explorer);
}

static void close_prompt(struct gm_explorer *explorer)
{
    struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    free(prompt->last[prompt->kind]);
    prompt->last[prompt->kind] = strdup(prompt->line.text);
    prompt->kind = GM_TYPED_NONE;
    explorer->dirty = explorer->fresh = true;
}

/* Three steps of a scheme that fits, of which one goes back, or two stages. */
static const char *scheme_example(const struct gm_shot *shot)
{
    static const char *const examples[][2] = {
        {"verlet", "composition(verlet; 1/(2 - 2^(1/3)), 1 - 2/(2 - 2^(1/3)), 1/(2 - 2^(1/3)))"},
        {"midpoint", "composition(midpoint; 1/(2 - 2^(1/3)), 1 - 2/(2 - 2^(1/3)), 1/(2 - 2^(1/3)))"},
    };
    for (size_t k = 0; k < GM_COUNT(examples); k++) {
        for (size_t i = 0; i < shot->scheme_count; i++) {
            if (strcmp(shot->schemes[i]->name, examples[k][0]) == 0) {
                return examples[k][1];
            }
        }
    }
    return "runge-kutta(0, 0 | 2/3, 0; 1/4, 3/4)";
}

static void ask_scheme(struct gm_explorer *explorer, bool fork)
{
    const enum gm_typed_kind kind = fork ? GM_TYPED_FORK : GM_TYPED_SWITCH;
    const struct gm_shot *shot = explorer->open.shot;
    const struct gm_scheme *present = shot->lanes[shot->selected].scheme;
    const char *last = explorer->typed_prompt.last[kind];
    open_prompt(explorer, kind,
                present->word ? gm_scheme_word(present)
                : last        ? last
                              : scheme_example(shot),
                SIZE_MAX);
}

/* A system of one's own is told first, as a command line, by the thread that runs it. */
void gm_explorer_ask_system(struct gm_explorer *explorer)
{
    const struct gm_open *open = &explorer->open;
    const char *last = explorer->typed_prompt.last[GM_TYPED_SYSTEM];
    if (open->shot && open->scene->text) {
        explorer->editing = explorer->face.awaited = true;
        gm_worker_order(open->worker, (struct gm_order){.kind = GM_ORDER_TELL});
        return;
    }
    const size_t formula = (size_t)(strstr(example, " q=") - example);
    open_prompt(explorer, GM_TYPED_SYSTEM, last ? last : example, last ? SIZE_MAX : formula);
}

void gm_explorer_edit_system(struct gm_explorer *explorer, const char *command)
{
    struct gm_arguments typed = {0}, words = {0};
    bool good = command && gm_typed_split(&typed, command) && typed.count > 1;
    struct gm_arguments formulas = {0};
    explorer->editing = false;
    /* without the program's name; `system` goes without saying, and behind a file's name stand its
       formulas */
    const bool formula = good && strcmp(typed.words[1], "system") == 0;
    good = good && (formula || (gm_arguments_add(&words, typed.words[1]) &&
                                gm_replacing_words(explorer->open.scene->text, &formulas)));
    for (int i = 0; good && i < formulas.count; i++) {
        good = gm_arguments_add(&words, formulas.words[i]);
    }
    for (int i = 2; good && i < typed.count; i++) {
        good = gm_arguments_have(&formulas, typed.words[i]) || gm_arguments_add(&words, typed.words[i]);
    }
    char *text = good ? gm_typed_join(&words) : NULL;
    if (text) { /* the cursor behind the first formula */
        size_t at = words.count > 0 ? strlen(words.words[0]) : 0;
        at += !formula && words.count > 1 ? 1 + strlen(words.words[1]) : 0;
        open_prompt(explorer, GM_TYPED_SYSTEM, text, at);
    }
    free(text);
    gm_arguments_close(&typed);
    gm_arguments_close(&words);
    gm_arguments_close(&formulas);
}

/* ---- maps ---- */

/* A typed line as the words of the command `sweep`; malloc'ed, NULL: no memory. */
static char *sweep_words(const char *line)
{
    static const char measure[] = "measure=";
    struct gm_arguments typed = {0};
    char *text = NULL;
    size_t size = 0;
    FILE *stream = gm_typed_split(&typed, line) ? open_memstream(&text, &size) : NULL;
    if (stream && typed.count > 0 && strchr(typed.words[0], '=')) {
        fputs("system ", stream);
    }
    for (int i = 0; stream && i < typed.count; i++) {
        const char *word = typed.words[i];
        const bool measured = strncmp(word, measure, strlen(measure)) == 0;
        fputs(measured ? "--measure " : "", stream);
        gm_arguments_put(stream, word + (measured ? strlen(measure) : 0));
        fputc(' ', stream);
    }
    gm_arguments_close(&typed);
    return stream && fclose(stream) == 0 ? text : NULL;
}

static bool check_map(const char *line, struct gm_typed_fault *fault)
{
    char *text = sweep_words(line);
    struct gm_arguments words = {0};
    struct gm_grid grid;
    *fault = (struct gm_typed_fault){.at = -1};
    const bool good = text && gm_arguments_split(&words, text)
                          ? gm_grid_open(&grid, GM_STUDY_SWEEP, &words, NULL, fault->sentence)
                          : gm_refuse(fault->sentence, "There is not enough memory.");
    if (good) {
        gm_grid_close(&grid);
    }
    gm_arguments_close(&words);
    free(text);
    return good;
}

/* A number that is swept: by a half of it to both sides. */
static bool range_of(const struct gm_shot_parameter *parameter, char *word, size_t size)
{
    enum { ACROSS = 24 };
    const struct gm_parameter *row = parameter->row;
    double value;
    if (row->type != GM_REAL || row->automatic || parameter->of_scheme || strcmp(row->key, "dt") == 0 ||
        strcmp(row->key, "until") == 0 || !gm_number_parse(parameter->value, &value)) {
        return false;
    }
    const double reach = value != 0 ? 0.5 * fabs(value) : 0.5;
    const bool low = value - reach<row->lowest, high = value + reach> row->highest;
    snprintf(word, size, "%s=%.*g..%.*g:%d", row->key, low ? DBL_DECIMAL_DIG : 4,
             low ? row->lowest : value - reach, high ? DBL_DECIMAL_DIG : 4,
             high ? row->highest : value + reach, ACROSS);
    return true;
}

/* The open scene by the selected lane's scheme, over the chosen parameter and the next one that is a number,
   to be edited. malloc'ed, NULL: no memory. */
static char *map_example(const struct gm_explorer *explorer)
{
    const struct gm_shot *shot = explorer->open.shot;
    struct gm_arguments present = {0}, words = {0};
    char ranges[2][64 + GM_TEXT_SIZE], *said = gm_studies_words(shot), *text = NULL;
    size_t axes = 0;
    for (size_t i = 0; i < shot->parameter_count && axes < 2; i++) {
        const size_t at = (explorer->face.parameter + i) % shot->parameter_count;
        axes += range_of(&shot->parameters[at], ranges[axes], sizeof ranges[axes]);
    }
    bool good = said && gm_arguments_split(&present, said);
    for (int i = 0; good && i < present.count; i++) {
        const size_t key = strcspn(present.words[i], "=") + 1;
        const bool swept = (axes > 0 && strncmp(present.words[i], ranges[0], key) == 0) ||
                           (axes > 1 && strncmp(present.words[i], ranges[1], key) == 0);
        good = swept || gm_arguments_add(&words, present.words[i]);
    }
    char scheme[GM_MESSAGE], measure[GM_MESSAGE];
    snprintf(scheme, sizeof scheme, "scheme=%.400s", gm_scheme_word(shot->lanes[shot->selected].scheme));
    snprintf(measure, sizeof measure, "measure=%.100s",
             shot->scene->observable_count > 0 ? shot->scene->observables[0].key : "");
    good = good && gm_arguments_add(&words, scheme);
    for (size_t i = 0; good && i < axes; i++) {
        good = gm_arguments_add(&words, ranges[i]);
    }
    good = good && gm_arguments_add(&words, measure);
    text = good ? gm_typed_join(&words) : NULL;
    gm_arguments_close(&present);
    gm_arguments_close(&words);
    free(said);
    return text;
}

/* With what was typed before, if that was of the same scene. */
static void ask_map(struct gm_explorer *explorer)
{
    const char *last = explorer->typed_prompt.last[GM_TYPED_MAP];
    char *usual = map_example(explorer);
    const bool same = last && usual && strncmp(last, usual, strcspn(usual, " ") + 1) == 0;
    if (usual) {
        open_prompt(explorer, GM_TYPED_MAP, same ? last : usual, SIZE_MAX);
    }
    free(usual);
}

/* ---- what is typed is taken ---- */

static bool take_map(struct gm_explorer *explorer)
{
    struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    struct gm_open *open = &explorer->open;
    char *words = sweep_words(prompt->line.text);
    const bool good =
        words && gm_studies_open(&open->studies, GM_STUDY_SWEEP, open->scene, words, open->wake);
    if (!good) {
        snprintf(prompt->fault.sentence, sizeof prompt->fault.sentence, "%s",
                 words ? open->studies.notice : "There is not enough memory.");
    }
    free(words);
    return good;
}

/* For the selected lane, or for one more from its state; false: there is none. */
static bool take_scheme(struct gm_explorer *explorer, bool fork, const struct gm_scheme *scheme)
{
    if (scheme) {
        gm_worker_order(explorer->open.worker,
                        (struct gm_order){.kind = fork ? GM_ORDER_FORK : GM_ORDER_SWITCH, .scheme = scheme});
    }
    return scheme != NULL;
}

/* The run of a line takes the place of what is open, if it is right. */
static bool open_line(struct gm_explorer *explorer, const char *line, struct gm_typed_fault *fault)
{
    struct gm_open *open = &explorer->open;
    if (!gm_open_line(open, line, fault)) {
        return false;
    }
    open->guide.tour = NULL;
    open->studies.shown = GM_STUDY_NONE;
    explorer->face.guide = NULL;
    explorer->face.parameter = 0;
    explorer->list.shown = false;
    return true;
}

/* What is typed is right: it takes the place of what runs, or of a lane's scheme. */
static void take(struct gm_explorer *explorer)
{
    struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    prompt->entered = false;
    bool good;
    if (prompt->kind == GM_TYPED_SYSTEM) {
        good = open_line(explorer, prompt->line.text, &prompt->fault);
    } else if (prompt->kind == GM_TYPED_MAP) {
        good = take_map(explorer);
    } else {
        good = take_scheme(explorer, prompt->kind == GM_TYPED_FORK,
                           gm_typed_scheme(prompt->line.text, &prompt->fault));
    }
    if (good) {
        close_prompt(explorer);
    }
}

void gm_explorer_check_typed(struct gm_explorer *explorer)
{
    static gm_line_reader *const readers[GM_TYPED_KINDS] = {[GM_TYPED_SYSTEM] = gm_typed_check,
                                                            [GM_TYPED_SWITCH] = gm_typed_check_scheme,
                                                            [GM_TYPED_FORK] = gm_typed_check_scheme,
                                                            [GM_TYPED_MAP] = check_map};
    struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    if (prompt->kind == GM_TYPED_NONE || prompt->checked) {
        return;
    }
    prompt->checked = gm_check_knows(&explorer->check, readers[prompt->kind], prompt->line.text,
                                     explorer->wake, &prompt->fault);
    explorer->dirty = explorer->dirty || prompt->checked;
    if (prompt->checked && prompt->entered) {
        if (prompt->fault.sentence[0]) {
            prompt->entered = false;
        } else {
            take(explorer);
        }
    }
}

static void press_typed(struct gm_explorer *explorer, int key)
{
    struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    explorer->dirty = true;
    if (gm_key_is_escape(key)) {
        close_prompt(explorer);
    } else if (gm_key_is_enter(key)) {
        prompt->entered = !prompt->checked || !prompt->fault.sentence[0];
        if (prompt->checked && prompt->entered) {
            take(explorer);
        }
    } else {
        if (prompt->entered) { /* more came at once: an end of a line in what was pasted is a blank */
            gm_edit_press(&prompt->line, ' ');
        }
        prompt->entered = false;
        prompt->checked = !gm_edit_press(&prompt->line, key) && prompt->checked;
    }
}

void gm_explorer_close_typed(struct gm_explorer *explorer)
{
    gm_check_close(&explorer->check);
    for (size_t i = 0; i < GM_TYPED_KINDS; i++) {
        free(explorer->typed_prompt.last[i]);
    }
}

/* ---- keys ---- */

/* In other colours, or none. */
static void repaint(struct gm_explorer *explorer)
{
    struct gm_writer *writer = &explorer->display.writer;
    writer->theme = explorer->face.theme;
    writer->colours = explorer->face.monochrome ? GM_COLOURS_NONE : explorer->terminal.colours;
    gm_display_forget(&explorer->display);
    explorer->dirty = explorer->fresh = true;
}

static void next_graphics(struct gm_explorer *explorer)
{
    struct gm_face *face = &explorer->face;
    struct gm_graphics graphics =
        gm_graphics_next(&explorer->terminal, (struct gm_graphics){face->pixels, face->blocks});
    face->pixels = graphics.pixels;
    face->blocks = graphics.blocks;
    explorer->dirty = true;
}

void gm_explorer_copy(struct gm_explorer *explorer)
{
    const char *command = explorer->open.shot->commands[explorer->face.command];
    if (command) {
        gm_writer_copy(&explorer->display.writer, command);
    }
}

/* Another step of the tour, if there is one. */
static void press_in_tour(struct gm_explorer *explorer, int key)
{
    struct gm_open *open = &explorer->open;
    if (!open->guide.tour) {
        return;
    }
    explorer->dirty = true;
    switch (gm_guide_press(&open->guide, key)) {
    case GM_GUIDE_OPEN:
        explorer->face.parameter = 0;
        if (!gm_open_step(open, explorer->message)) {
            gm_explorer_leave(explorer, GM_EXIT_USAGE);
        }
        break;
    case GM_GUIDE_RUN:
        gm_open_study(open);
        gm_worker_order(open->worker, (struct gm_order){.kind = GM_ORDER_RUN});
        break;
    case GM_GUIDE_END:
        break;
    }
}

/* A key of an open scene: it belongs to what is open above it, or is one of the table. */
static enum gm_key_result press_in_scene(const struct gm_keystroke *press)
{
    struct gm_face *face = press->face;
    const bool said = press->shot->message[0] && press->shot->message_number != face->read;
    face->read = press->shot->message_number;
    face->watch_until = 0;
    if (press->key == GM_KEY_REDRAW) {
        return GM_KEY_REPAINT;
    }
    if (press->shot->running_ahead && press->key != 'q') { /* any key stops it */
        return gm_keystroke_order(press, (struct gm_order){.kind = GM_ORDER_HALT});
    }
    if (face->page != GM_PAGE_SCENE) {
        return gm_pages_press(press->key, face);
    }
    if (face->choosing != GM_CHOOSE_NOTHING) {
        return gm_chooser_press(press);
    }
    if (face->prompt != GM_PROMPT_NONE) {
        return gm_prompt_press(press);
    }
    if (gm_key_is_escape(press->key) && (said || face->explaining)) { /* first away with what is said */
        face->explaining = false;
        return GM_KEY_DONE;
    }
    return gm_key_press(press);
}

void gm_explorer_key(struct gm_explorer *explorer, int key)
{
    if (explorer->typed_prompt.kind != GM_TYPED_NONE && key != GM_KEY_REDRAW) {
        press_typed(explorer, key);
        return;
    }
    if (explorer->list.shown) {
        gm_explorer_press_in_list(explorer, key);
        return;
    }
    if (!explorer->open.shot) { /* before the first picture there is only leaving */
        if (key == 'q') {
            gm_explorer_leave(explorer, GM_EXIT_OK);
        } else if (key == 'l' || gm_key_is_escape(key)) {
            gm_explorer_show_start(explorer);
        } else if (key == 'n' || key == 'N' || key == 'a') {
            press_in_tour(explorer, key);
        }
        return;
    }
    const struct gm_face *face = &explorer->face;
    const bool plain =
        face->page == GM_PAGE_SCENE && face->choosing == GM_CHOOSE_NOTHING && face->prompt == GM_PROMPT_NONE;
    if (plain && gm_studies_press(&explorer->open.studies, key, face->theme)) {
        explorer->dirty = true;
        return;
    }
    const struct gm_keystroke one = {key, &explorer->face, explorer->open.shot, explorer->open.worker};
    switch (press_in_scene(&one)) {
    case GM_KEY_LEAVE:
        gm_explorer_leave(explorer, GM_EXIT_OK);
        break;
    case GM_KEY_BLOCKS:
        next_graphics(explorer);
        break;
    case GM_KEY_REPAINT:
        gm_explorer_resize(explorer);
        break;
    case GM_KEY_THEME:
        repaint(explorer);
        break;
    case GM_KEY_SCENES:
        explorer->open.studies.shown = GM_STUDY_NONE;
        gm_explorer_show_start(explorer);
        break;
    case GM_KEY_STUDY:
        gm_studies_begin(&explorer->open.studies, key, explorer->open.shot, explorer->wake);
        explorer->dirty = true;
        break;
    case GM_KEY_MAP:
        ask_map(explorer);
        break;
    case GM_KEY_TYPED: {
        const enum gm_choosing choosing = face->choosing;
        explorer->face.choosing = GM_CHOOSE_NOTHING;
        if (choosing == GM_CHOOSE_NOTHING) {
            gm_explorer_ask_system(explorer);
        } else {
            ask_scheme(explorer, choosing == GM_CHOOSE_FORK);
        }
        break;
    }
    case GM_KEY_TOUR:
        press_in_tour(explorer, key);
        break;
    case GM_KEY_FILE:
        gm_worker_order(explorer->open.worker, (struct gm_order){.kind = GM_ORDER_SYSTEM});
        explorer->dirty = true;
        break;
    case GM_KEY_COPY:
        gm_explorer_copy(explorer);
        explorer->dirty = true;
        break;
    case GM_KEY_DONE:
        explorer->dirty = true;
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
        order.of_scheme = shot->parameters[explorer->pointer.held.index].of_scheme;
    } else {
        return;
    }
    gm_worker_order(explorer->open.worker, order);
}

static void click_scheme(struct gm_explorer *explorer, const struct gm_scheme *scheme)
{
    if (scheme == &gm_chooser_user) {
        explorer->face.choice = scheme;
        gm_explorer_key(explorer, '\n');
        return;
    }
    take_scheme(explorer, explorer->face.choosing == GM_CHOOSE_FORK, scheme);
    explorer->face.choosing = GM_CHOOSE_NOTHING;
}

/* A choice has no slider: a click takes the next one. */
static void click_parameter(struct gm_explorer *explorer, size_t index)
{
    const struct gm_shot_parameter *parameter = &explorer->open.shot->parameters[index];
    bool again = explorer->face.parameter == index;
    explorer->face.parameter = index;
    explorer->face.explaining = true;
    if (again && parameter->position < 0) {
        gm_worker_order(explorer->open.worker, (struct gm_order){.kind = GM_ORDER_MOVE,
                                                                 .amount = 1,
                                                                 .row = parameter->row,
                                                                 .of_scheme = parameter->of_scheme});
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

/* The run that a map has there takes the place of what is open; the map stays behind its key. */
static void click_study(struct gm_explorer *explorer, const struct gm_mouse_event *event)
{
    struct gm_open *open = &explorer->open;
    struct gm_typed_fault fault;
    char *words = gm_studies_pick(&open->studies, explorer->face.blocks, event->column, event->row);
    if (words && !open_line(explorer, words, &fault)) {
        snprintf(open->studies.notice, sizeof open->studies.notice, "%s", fault.sentence);
    }
    free(words);
}

/* Whether a picture lies there that can be gone around. */
static bool is_in_space(const struct gm_explorer *explorer, const struct gm_hit *hit)
{
    return hit && hit->kind == GM_HIT_PICTURE && !explorer->list.shown && explorer->open.shot &&
           explorer->open.shot->in_space && explorer->face.page == GM_PAGE_SCENE &&
           explorer->open.studies.shown == GM_STUDY_NONE;
}

/* What is seen follows the button: half a turn for the width of the screen. A row is as high as two columns are
   wide. */
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

/* The wheel: nearer and further over a picture in space, else through a list, or the speed. */
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
            gm_explorer_enter(explorer);
        } else {
            explorer->list.start.choice = hit->index;
            gm_explorer_look_soon(explorer);
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
