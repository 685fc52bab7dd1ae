/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The status line of a scene: of all there is to say, what matters most. */
#include "app/explorer/view/status.h"

#include <curses.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/explorer/view/keys.h"
#include "app/explorer/view/prompt.h"
#include "render/clock.h"

enum { MOST_HINTS = 40, FIRST_HINT = 14 };

static int by_rank(const void *a, const void *b)
{
    const struct gm_key_row *const *first = a, *const *second = b;
    return (*first)->rank - (*second)->rank;
}

/* The hints of the table of keys. */
static void key_hints(const struct gm_shot *shot, struct gm_hint hints[MOST_HINTS])
{
    const struct gm_key_row *rows[MOST_HINTS];
    size_t count = 0;
    for (size_t i = 0; i < gm_key_row_count && count + 1 < MOST_HINTS; i++) {
        if (gm_key_rows[i].hint) {
            rows[count++] = &gm_key_rows[i];
        }
    }
    qsort(rows, count, sizeof *rows, by_rank);
    for (size_t i = 0; i < count; i++) {
        bool go = rows[i]->keys[0].code == ' ' && shot->paused;
        hints[i] = (struct gm_hint){rows[i]->label, go ? "go on" : rows[i]->hint, rows[i]->keys[0].code};
    }
    hints[count] = (struct gm_hint){NULL, NULL, 0};
}

static const struct gm_hint chooser_hints[] = {{"enter", "take it", '\n'},
                                               {"↑↓", "choose", 0},
                                               {"?", "formula", '?'},
                                               {"esc", "back", 27},
                                               {NULL, NULL, 0}};
/* While a parameter is explained. */
static const struct gm_hint parameter_hints[] = {
    {"enter", "type", '\n'},         {"- +", "finely", 0}, {"← →", "change", 0}, {"↑ ↓", "choose", 0},
    {"⌫", "default", KEY_BACKSPACE}, {"?", "help", '?'},   {NULL, NULL, 0}};
static const struct gm_hint prompt_hints[] = {{"enter", "do", '\n'}, {"esc", "back", 27}, {NULL, NULL, 0}};
static const struct gm_hint ahead_hints[] = {{"any key", "stop", ' '}, {NULL, NULL, 0}};

/* Slower than this, in steps per second, a step can be seen by itself. */
static const double slow_motion = 20;

void gm_status_speed(const struct gm_shot *shot, char *text, size_t size)
{
    char movie[24] = "", pace[32] = "";
    if (shot->recorded >= 0) {
        snprintf(movie, sizeof movie, "● %d:%04.1f  ", (int)(shot->recorded / 60), fmod(shot->recorded, 60));
    } else if (!shot->paused && !shot->behind && shot->pace < slow_motion) {
        snprintf(pace, sizeof pace, "%.2g steps/s  ", shot->pace);
    }
    snprintf(text, size, "%s%s%s %s%g×%s", movie, pace,
             shot->paused      ? "‖"
             : shot->backwards ? "◂"
                               : "▸",
             shot->backwards ? "−" : "", shot->speed,
             shot->paused   ? " paused"
             : shot->behind ? " late"
                            : "");
}

/* What a parameter is, its range, and whether a change starts the run again; with its value where no panel
   shows it. */
static void explain(const struct gm_shot_parameter *parameter, bool valued, char *text, size_t size)
{
    const struct gm_parameter *row = parameter->row;
    char low[32], high[32];
    gm_sheet_number(row->lowest, low, sizeof low);
    gm_sheet_number(row->highest, high, sizeof high);
    bool ranged = row->type == GM_REAL || row->type == GM_INTEGER;
    snprintf(text, size, "%s%s%s: %s%s%s%s%s; %s", row->key, valued ? " = " : "",
             valued ? parameter->value : "", row->help, ranged ? ", " : "", ranged ? low : "",
             ranged ? " to " : "", ranged ? high : "",
             row->live && !parameter->of_scheme ? "acts at once" : "starts again");
}

/* Whether the status line says what to watch; a tour says that itself. */
static bool is_watched(const struct gm_face *face, const struct gm_shot *shot)
{
    return shot->scene->watch && !face->guide && gm_clock_milliseconds() < face->watch_until;
}

/* What stands at the left. */
static void say(const struct gm_face *face, const struct gm_shot *shot, bool side, char *text, size_t size)
{
    const char *lane = shot->lanes[shot->selected].scheme->title;
    const struct gm_shot_parameter *parameter =
        face->parameter < shot->parameter_count ? &shot->parameters[face->parameter] : NULL;
    if (shot->running_ahead) {
        snprintf(text, size, "Running ahead: %.0f %%", 100 * shot->progress);
    } else if (face->choosing == GM_CHOOSE_SWITCH) {
        snprintf(text, size, "Another scheme for %s, from its present state on", lane);
    } else if (face->choosing == GM_CHOOSE_FORK) {
        snprintf(text, size, "%s goes on, and from its present state with another scheme too", lane);
    } else if (face->prompt == GM_PROMPT_AHEAD || (face->prompt == GM_PROMPT_VALUE && parameter)) {
        gm_prompt_text(face, shot, text, size);
    } else if (shot->message[0] && shot->message_number != face->read) {
        snprintf(text, size, "%s", shot->message);
    } else if (face->explaining && parameter) {
        explain(parameter, !side, text, size);
    } else {
        snprintf(text, size, "%s", is_watched(face, shot) ? shot->scene->watch : "");
    }
}

void gm_status_draw(const struct gm_sheet *whole, const struct gm_shot *shot, int side)
{
    const struct gm_face *face = whole->face;
    const struct gm_sheet sheet = gm_sheet_part(whole, 0, whole->height - 1, whole->width, 1);
    struct gm_hint keys[MOST_HINTS];
    char text[GM_MESSAGE];
    int column = 1;
    if (!side) { /* the side panel has it otherwise */
        gm_status_speed(shot, text, sizeof text);
        column += gm_sheet_text(&sheet, column, 0, text, GM_INK, true) + 2;
    }
    say(face, shot, side > 0, text, sizeof text);
    key_hints(shot, keys);
    bool asks = face->prompt != GM_PROMPT_NONE;
    bool news = asks || shot->running_ahead || (shot->message[0] && shot->message_number != face->read);
    const struct gm_hint *hints = shot->running_ahead                   ? ahead_hints
                                  : face->choosing != GM_CHOOSE_NOTHING ? chooser_hints
                                  : asks                                ? prompt_hints
                                  : face->explaining && !news           ? parameter_hints
                                                                        : keys;
    const bool answers =
        news || is_watched(face, shot) || face->choosing != GM_CHOOSE_NOTHING || face->explaining;
    if (answers && gm_screen_rows_below(whole->cells) == 2 &&
        column + gm_sheet_width(&sheet, text) + FIRST_HINT > sheet.width) {
        gm_screen_say_above(whole, text);
        text[0] = '\0';
    }
    /* the first hint is always there if it fits at all */
    int from = column + gm_sheet_width(&sheet, text) + 3, most = sheet.width - FIRST_HINT;
    int begin = gm_sheet_hints(&sheet, from < most ? from : most > column ? most : column, hints);
    if (begin > column) {
        const struct gm_sheet left = gm_sheet_part(&sheet, 0, 0, begin - 2, 1);
        gm_sheet_cut(&left, column, 0, text, news ? GM_INK : GM_SECONDARY, news);
    }
}
