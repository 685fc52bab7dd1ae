/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The screen for an open scene: its layout, and the status line, which has the most important of its
   texts; and the prompt. */
#include "app/explorer/view/view.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/basics.h"
#include "render/clock.h"

/* ---- the prompt for a user-defined system or scheme, or a map ---- */

/* The prompt has the line, its caret, rows for LETTERS letters of the fault, and on taller screens a rule
   with the question. The scene, the keys, the line and its caret have priority. */
enum { LETTERS = 150, FEW_ROWS = 2, FEW_SCREEN_ROWS = 16, SCREEN_ROWS = 7 };

static const char *const questions[GM_TYPED_KINDS] = {
    [GM_TYPED_SYSTEM] = " Your own system: a formula with its values, a file, or a name ",
    [GM_TYPED_SWITCH] = " Your own scheme for this lane: coefficients, or a file ",
    [GM_TYPED_MAP] = " A map of runs: two keys with ranges a..b:n, and measure=what it shows, as megno ",
    [GM_TYPED_FORK] = " Your own scheme for one more lane: coefficients, or a file ",
};

/* Returns the rows for a fault, at most. */
static int rows_told(int columns)
{
    const int width = columns > 2 ? columns - 2 : 1, rows = (LETTERS + width - 1) / width;
    return rows > 2 ? rows : 2;
}

/* Returns the prompt's rows on a screen of this size, in cells; 0: it is closed. */
static int rows_of(const struct gm_typed_prompt *prompt, int columns, int rows)
{
    if (!prompt || prompt->kind == GM_TYPED_NONE || rows < 4) {
        return 0;
    }
    const int told = rows_told(columns), room = rows - SCREEN_ROWS;
    return room < 1 ? FEW_ROWS : room < told ? 2 + room : 2 + told + (rows >= FEW_SCREEN_ROWS);
}

static void verdict(const struct gm_typed_prompt *prompt, char *text, size_t size)
{
    if (prompt->line.refused > 0) {
        snprintf(text, size,
                 "A line has room for %d bytes, and the last %zu that came were left out: a file has more.",
                 GM_EDIT - 1, prompt->line.refused);
    } else if (!prompt->checked) {
        snprintf(text, size, "%s", prompt->entered ? "It is read …" : prompt->fault.sentence);
    } else if (prompt->fault.sentence[0]) {
        snprintf(text, size, "%s", prompt->fault.sentence);
    } else {
        snprintf(text, size, "That is right: enter takes it.");
    }
}

int gm_typed_prompt_draw(const struct gm_sheet *whole, const struct gm_typed_prompt *prompt)
{
    static const char hints[] = "enter:take it|esc:back|← →:move|ctrl-U:clear";
    char text[GM_MESSAGE + 128];
    const int rows = rows_of(prompt, whole->width, whole->height);
    if (rows == 0) {
        return 0;
    }
    const struct gm_sheet sheet = gm_sheet_part(whole, 0, whole->height - 1 - rows, whole->width, rows);
    const struct gm_sheet last = gm_sheet_part(whole, 0, whole->height - 1, whole->width, 1);
    const bool rule = rows > 2 + rows_told(sheet.width), caret = rows > FEW_ROWS,
               wrong = prompt->fault.sentence[0] != '\0';
    const int below = rule + 1 + caret;
    const struct gm_sheet line = gm_sheet_part(&sheet, 1, rule, sheet.width - 2, 1);
    const struct gm_sheet told = gm_sheet_part(&sheet, 1, below, sheet.width - 2, rows - below);
    for (int i = 0; rule && i < sheet.width; i++) {
        gm_sheet_glyph(&sheet, i, 0, 0x2500, GM_GRID, false);
    }
    if (rule) {
        gm_sheet_cut(&sheet, 1, 0, questions[prompt->kind], GM_INK, true);
    }
    gm_edit_draw(&line, 0, &prompt->line);
    if (caret && prompt->checked && wrong && prompt->fault.at >= 0) {
        gm_sheet_glyph(&sheet, 1 + gm_edit_column(&line, &prompt->line, (size_t)prompt->fault.at), rule + 1,
                       '^', GM_INITIAL, true);
    }
    verdict(prompt, text, sizeof text);
    gm_sheet_wrapped(&told, 0, 0, told.height, text, prompt->checked && wrong ? GM_INITIAL : GM_SECONDARY);
    gm_sheet_hints(&last, 1, prompt->checked && !wrong ? hints : strchr(hints, '|') + 1);
    return rows + 1;
}

/* ---- the status line ---- */

enum { FIRST_HINT = 14 };

/* Returns the rows below a scene: on most screens a rule, a row for messages and one for keys. */
static int rows_below(const struct gm_sheet *whole)
{
    return whole->height >= GM_SCREEN_ROWS_OF_KEYS ? 3 : gm_screen_rows_below(whole->cells);
}

/* Returns the column where hints begin after a text: `from`, but at most `most`, which is raised to `least`. */
static int hint_column(int from, int most, int least)
{
    const int last = most > least ? most : least;
    return from < last ? from : last;
}

/* Writes the hints of the table of keys, by rank. */
static void key_hints(const struct gm_shot *shot, char *hints, size_t size)
{
    static const struct {
        const char *keys, *word;
        int rank;
    } rows[] = {
#define GM_KEYS(label, hint, rank, ...) {label, hint, rank},
#define GM_ORDER_KEYS GM_KEYS
#include "app/runs/keys.def"
#undef GM_ORDER_KEYS
#undef GM_KEYS
    };
    hints[0] = '\0';
    for (int rank = 1; rank <= (int)GM_COUNT(rows); rank++) {
        for (size_t i = 0; i < GM_COUNT(rows); i++) {
            const bool go = rank == 1 && shot->paused;
            if (rows[i].rank == rank) {
                gm_append(hints, size, "%s%s:%s", hints[0] ? "|" : "", rows[i].keys,
                          go ? "resume" : rows[i].word);
            }
        }
    }
}

/* steps per second below which single steps are visible, and below which the picture seems to stand still */
static const double slow_motion = 20, standstill = 0.1;

/* Writes the speed, the state of the clock, and the length of a movie. */
static void status_speed(const struct gm_shot *shot, char *text, size_t size)
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

/* Explains a parameter: its help, range, and whether a change restarts the run; with its value if no panel
   shows it. */
static void explain(const struct gm_shot_parameter *parameter, bool valued, char *text, size_t size)
{
    const struct gm_parameter *row = parameter->row;
    char low[32], high[32];
    gm_number_format(row->lowest, low, sizeof low);
    gm_number_format(row->highest, high, sizeof high);
    bool ranged = row->type == GM_REAL || row->type == GM_INTEGER;
    snprintf(text, size, "%s%s%s: %s%s%s%s%s; %s", row->key, valued ? " = " : "",
             valued ? parameter->value : "", row->help, ranged ? ", " : "", ranged ? low : "",
             ranged ? " to " : "", ranged ? high : "",
             row->live && !parameter->of_scheme ? "acts at once" : "starts again");
}

/* Writes the sentences of a text that fit into two rows above the last one, or if not even one fits, its words. */
static void few_sentences(const struct gm_sheet *whole, const char *all, char *text, size_t size)
{
    const struct gm_sheet nothing = gm_sheet_part(whole, 1, 0, whole->width - 2, 0);
    size_t sentences = 0, words = 0;
    for (size_t i = strcspn(all, " "); i > words; i += all[i] ? 1 + strcspn(all + i + 1, " ") : 0) {
        const bool ends = all[i - 1] == '.' || !all[i];
        snprintf(text, size, "%.*s%s", (int)i, all, ends ? "" : "…");
        if (gm_sheet_wrapped(&nothing, 0, 0, 3, text, GM_INK) > 2) {
            break;
        }
        words = i;
        sentences = ends ? i : sentences;
    }
    snprintf(text, size, "%.*s%s", (int)(sentences ? sentences : words), all, sentences ? "" : "…");
}

/* Shows the end of a long typed text, where letters are added; the help needs the rest. */
static void prompt_text(const struct gm_face *face, const struct gm_shot *shot, char *text, size_t size)
{
    enum { SHOWN = 40 };
    const size_t length = strlen(face->typed);
    const char *before = length > SHOWN ? "…" : "";
    const char *typed = face->typed + (length > SHOWN ? length - SHOWN : 0);
    if (face->prompt == GM_PROMPT_AHEAD) {
        snprintf(text, size, "Run ahead to t = %s%s_   (enter alone: %.6g)", before, typed, shot->ahead);
    } else {
        const struct gm_parameter *row = shot->parameters[face->parameter].row;
        snprintf(text, size, "%s = %s%s_   (%s)", row->key, before, typed, row->help);
    }
}

/* Writes the text at the left of the status line. */
static void say(const struct gm_sheet *whole, const struct gm_shot *shot, bool side, char *text, size_t size)
{
    const struct gm_face *face = whole->face;
    /* a tour has its own text */
    const bool watched = shot->scene->watch && !face->guide && gm_clock_milliseconds() < face->watch_until;
    text[0] = '\0';
    const char *alias = gm_chooser_alias(face), *lane = shot->lanes[shot->selected].scheme->title;
    const struct gm_shot_parameter *parameter =
        face->parameter < shot->parameter_count ? &shot->parameters[face->parameter] : NULL;
    if (shot->running_ahead) {
        snprintf(text, size, "Running ahead: %.0f %%", 100 * shot->progress);
    } else if (face->choosing != GM_CHOOSE_NOTHING && alias) {
        snprintf(text, size, "%s: %s", alias, face->choice->name);
    } else if (face->choosing == GM_CHOOSE_SWITCH) {
        snprintf(text, size, "Another scheme for %s, from its current state on", lane);
    } else if (face->choosing == GM_CHOOSE_FORK) {
        snprintf(text, size, "%s continues, and another scheme starts from its current state", lane);
    } else if (face->prompt == GM_PROMPT_AHEAD || (face->prompt == GM_PROMPT_VALUE && parameter)) {
        prompt_text(face, shot, text, size);
    } else if (shot->message[0] && shot->message_number != face->read) {
        snprintf(text, size, "%s", shot->message);
    } else if (gm_clock_milliseconds() < face->hint_until) {
        snprintf(text, size, "%s", face->hint);
    } else if (face->explaining && parameter) {
        explain(parameter, !side, text, size);
    } else if (watched) {
        few_sentences(whole, shot->scene->watch, text, size);
    } else if (!shot->paused && shot->pace < standstill) {
        snprintf(text, size, "%.1g steps per second: press %s to shorten dt", shot->pace,
                 parameter && strcmp(parameter->row->key, "dt") == 0 ? "←" : "↑ until dt is chosen, then ←");
    }
}

/* Draws the status line; it has the speed if there is no panel (`side` columns; 0: none). */
static void draw_status(const struct gm_sheet *whole, const struct gm_shot *shot, int side)
{
    const struct gm_face *face = whole->face;
    const bool apart = rows_below(whole) == 3;
    const struct gm_sheet last = gm_sheet_part(whole, 0, whole->height - 1, whole->width, 1),
                          sheet = gm_sheet_part(whole, 0, whole->height - 1 - apart, whole->width, 1);
    char text[GM_MESSAGE], keys[GM_MESSAGE];
    int column = 1;
    if (!side) { /* the side panel shows it otherwise */
        status_speed(shot, text, sizeof text);
        column += gm_sheet_text(&sheet, column, 0, text, GM_INK, true) + 2;
    }
    say(whole, shot, side > 0, text, sizeof text);
    key_hints(shot, keys, sizeof keys);
    bool asks = face->prompt != GM_PROMPT_NONE;
    bool news = asks || shot->running_ahead || (shot->message[0] && shot->message_number != face->read);
    const char *hints = shot->running_ahead                   ? "any key:stop"
                        : face->choosing != GM_CHOOSE_NOTHING ? "enter:take it|↑↓:choose|?:formula|esc:back"
                        : asks                                ? "enter:do|esc:back"
                        : face->explaining && !news ? "enter:type|← →:change|↑ ↓:choose|?:help|esc:back|- "
                                                      "+:finely|⌫:default"
                                                    : keys;
    if (shot->running_ahead) {
        gm_sheet_hit(&last, 0, 0, last.width, (struct gm_hit){.kind = GM_HIT_KEY, .index = ' '});
    }
    const int reserved = apart ? 1 : FIRST_HINT;
    if (text[0] && rows_below(whole) >= 2 && column + gm_sheet_width(&sheet, text) + reserved > sheet.width) {
        gm_screen_say_above(whole, text);
        text[0] = '\0';
    }
    /* the first hint has priority over the text */
    int from = column + gm_sheet_width(&sheet, text) + 3, most = sheet.width - FIRST_HINT;
    int begin = gm_sheet_hints(&last, apart ? 1 : hint_column(from, most, column), hints);
    if (apart) {
        gm_sheet_cut(&sheet, column, 0, text, news ? GM_INK : GM_SECONDARY, news);
    } else if (begin > column) {
        const struct gm_sheet left = gm_sheet_part(&sheet, 0, 0, begin - 2, 1);
        gm_sheet_cut(&left, column, 0, text, news ? GM_INK : GM_SECONDARY, news);
    }
}

/* ---- a tour: its keys, and its texts below the picture ---- */

enum { MOST_ROWS = 100, LEAST_HEIGHT = 8 };

struct gm_guide gm_guide_at(const struct gm_tour *tour, size_t step)
{
    return (struct gm_guide){.tour = tour,
                             .step = step,
                             .answered = !tour->steps[step].ask || tour->steps[step].expectation_count > 0};
}

/* Draws a mark such as "Watch:" before a text (NULL: neither); returns the rows. */
static int draw_marked(const struct gm_sheet *sheet, int row, const char *mark, const char *text)
{
    if (!text) {
        return 0;
    }
    gm_sheet_text(sheet, 0, row, mark, GM_INK, true);
    return gm_sheet_wrapped(sheet, gm_sheet_width(sheet, mark) + 1, row, MOST_ROWS, text, GM_INK);
}

/* Draws the paragraphs of an exercise from a row on; returns the row after them. */
static int draw_exercise(const struct gm_sheet *sheet, int row, const struct gm_guide *guide,
                         const struct gm_shot *shot)
{
    const struct gm_tour_step *step = &guide->tour->steps[guide->step];
    const char *mark = shot->passed ? "Passed" : "Not passed:";
    const char *verdict = shot->verdict[0] ? shot->verdict + strlen(mark) + 1 : NULL;
    row += draw_marked(sheet, row, "Task:", step->ask);
    row += draw_marked(sheet, row, mark, verdict);
    row += draw_marked(sheet, row, "Hint:", guide->hinted && !shot->passed ? step->hint : NULL);
    return row + draw_marked(sheet, row, "Answer:", shot->passed ? step->answer : NULL);
}

/* Draws the paragraphs below row 0; returns the row after them. */
static int draw_texts(const struct gm_sheet *sheet, const struct gm_guide *guide, const struct gm_shot *shot)
{
    const struct gm_tour_step *step = &guide->tour->steps[guide->step];
    if (step->expectation_count > 0) {
        const int row = 1 + gm_sheet_wrapped(sheet, 0, 1, MOST_ROWS, step->say, GM_INK);
        return draw_exercise(sheet, row, guide, shot);
    }
    const char *first = step->ask && guide->answered ? step->answer : step->say;
    int row = 1;
    row += gm_sheet_wrapped(sheet, 0, row, MOST_ROWS, first, GM_INK);
    if (!guide->answered) {
        return row + draw_marked(sheet, row, "Predict:", step->ask);
    }
    row += draw_marked(sheet, row, "Watch:", step->watch);
    row += draw_marked(sheet, row, "Try:", step->attempt);
    return row;
}

/* Draws the tour's keys at the right of the rule; returns their first column. */
static int draw_guide_keys(const struct gm_sheet *sheet, const struct gm_guide *guide)
{
    char hints[64];
    const bool on = !guide->answered || guide->step + 1 < guide->tour->count;
    const char *forward = guide->answered ? "n:next|" : "n:answer|";
    const struct gm_tour_step *step = &guide->tour->steps[guide->step];
    const bool exercise = step->expectation_count > 0;
    snprintf(hints, sizeof hints, "%s%s%s%s", on ? forward : "", guide->step > 0 ? "N:back|" : "",
             exercise && step->hint ? "H:hint|" : "", exercise ? "r:restart|S:save" : "a:again");
    const struct gm_sheet nothing = gm_sheet_part(sheet, 0, 0, sheet->width, 0);
    for (int i = gm_sheet_hints(&nothing, 1, hints) - 2; i < sheet->width; i++) {
        gm_sheet_glyph(sheet, i, 0, ' ', GM_GRID, false);
    }
    return gm_sheet_hints(sheet, 1, hints);
}

static void draw_guide(const struct gm_sheet *sheet, const struct gm_guide *guide, const struct gm_shot *shot)
{
    const struct gm_tour *tour = guide->tour;
    char text[256];
    if (sheet->height < 1) {
        return;
    }
    for (int i = 0; i < sheet->width; i++) {
        gm_sheet_glyph(sheet, i, 0, 0x2500, GM_GRID, false);
    }
    const int begin = draw_guide_keys(sheet, guide);
    snprintf(text, sizeof text, " %.80s %zu/%zu: %.120s ", tour->title, guide->step + 1, tour->count,
             tour->steps[guide->step].title);
    const struct gm_sheet head = gm_sheet_part(sheet, 0, 0, begin > 1 ? begin - 1 : 0, 1);
    gm_sheet_text(&head, 1, 0, text, GM_INK, true);
    const struct gm_sheet body = gm_sheet_part(sheet, 1, 0, sheet->width - 2, sheet->height);
    if (draw_texts(&body, guide, shot) > sheet->height) {
        gm_sheet_text(&body, body.width - 1, body.height - 1, "…", GM_INK, true);
    }
}

/* ---- the screen ---- */

enum { SIDE_LEAST = 31, SIDE_MOST = 58 };

/* Returns the columns of the panel. On a small screen it appears alone, on request. */
static int side_columns(const struct gm_cells *cells, const struct gm_face *face)
{
    const bool choosing = face->choosing != GM_CHOOSE_NOTHING;
    if (cells->columns < GM_SCREEN_COLUMNS || cells->rows < GM_SCREEN_ROWS) {
        const bool asked = choosing || (face->side != GM_SIDE_ALL && face->side != GM_SIDE_NONE);
        return asked ? cells->columns : 0;
    }
    if (face->side == GM_SIDE_NONE && !choosing) {
        return 0;
    }
    int columns = cells->columns * 2 / 5;
    return columns < SIDE_LEAST ? SIDE_LEAST : columns > SIDE_MOST ? SIDE_MOST : columns;
}

static void draw_head(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    char text[64];
    status_speed(shot, text, sizeof text);
    gm_sheet_text(sheet, 0, 0, "geomint", GM_INK, true);
    gm_sheet_hit(sheet, 0, 0, 7, (struct gm_hit){.kind = GM_HIT_KEY, .index = 'l'});
    gm_sheet_right(sheet, sheet->width, 0, text, GM_INK, shot->paused);
    gm_sheet_hit(sheet, sheet->width / 2, 0, sheet->width / 2,
                 (struct gm_hit){.kind = GM_HIT_KEY, .index = ' '});
}

/* Draws the past on the rule below the picture, with a mark at the lanes' time. */
static void draw_past(const struct gm_sheet *whole, const struct gm_shot *shot, int width)
{
    const struct gm_sheet sheet = gm_sheet_part(whole, 1, whole->height - rows_below(whole), width - 2, 1);
    if (sheet.width < 1) {
        return;
    }
    if (shot->reach > 0 && shot->paused) {
        gm_sheet_slider(&sheet, 0, sheet.width, 0, shot->gone / shot->reach, false);
    }
    gm_sheet_hit(&sheet, 0, 0, sheet.width, (struct gm_hit){.kind = GM_HIT_PAST});
}

/* Draws a study in `rows` rows of full width, and its progress. */
static void draw_study(const struct gm_sheet *whole, int rows)
{
    const int below = gm_screen_rows_below(whole->cells);
    char text[GM_MESSAGE];
    struct gm_studies *studies = whole->face->studies;
    const struct gm_sheet diagram = gm_sheet_part(whole, 0, 0, whole->width, rows);
    gm_studies_draw(&diagram, studies);
    gm_sheet_hit(&diagram, 0, 0, diagram.width, (struct gm_hit){.kind = GM_HIT_PICTURE, .height = rows});
    struct gm_sheet last = gm_screen_foot(whole);
    if (below > 0) {
        gm_studies_status(studies, text, sizeof text);
        const int from = 1 + gm_sheet_width(&last, text) + 3, most = last.width - 10;
        last.width =
            gm_sheet_hints(&last, hint_column(from, most, 1), "esc:back|x:stop|p:save|b:blocks|q:quit") - 2;
        if (1 + gm_sheet_width(&last, text) > last.width && below == 2) {
            gm_screen_say_above(whole, text);
        } else {
            gm_sheet_cut(&last, 1, 0, text, GM_INK, false);
        }
    }
}

/* Draws the progress of hidden studies on the rule above the last row. */
static void draw_news(const struct gm_sheet *whole, const struct gm_scene *scene)
{
    char text[GM_MESSAGE] = "", framed[GM_MESSAGE + 2];
    if (whole->face->studies) {
        gm_studies_news(whole->face->studies, scene, text, sizeof text);
    }
    if (text[0]) {
        snprintf(framed, sizeof framed, " %s ", text);
        gm_sheet_text(whole, 2, whole->height - rows_below(whole), framed, GM_INK, true);
    }
}

void gm_screen_draw_scene(struct gm_screen *screen, struct gm_face *face, const struct gm_shot *shot,
                          bool fresh)
{
    struct gm_cells *cells = &screen->cells;
    const struct gm_sheet whole = gm_screen_clear(screen, face);
    int below = rows_below(&whole), rows = cells->rows - below;
    if (fresh) {
        screen->picture.fresh = false;
    }
    if (face->page != GM_PAGE_SCENE) {
        gm_screen_draw_page(&whole, face, shot);
        return;
    }
    const int asked = gm_typed_prompt_draw(&whole, face->typed_prompt);
    rows = asked ? cells->rows - asked : rows;
    if (face->guide && !asked) {
        const struct gm_sheet nothing = gm_sheet_part(&whole, 0, 0, whole.width - 2, 0);
        const int wanted = draw_texts(&nothing, face->guide, shot), most = whole.height * 2 / 5;
        const int told = whole.height < LEAST_HEIGHT ? 0 : wanted < most ? wanted : most;
        const struct gm_sheet panel = gm_sheet_part(&whole, 0, rows - told, cells->columns, told);
        draw_guide(&panel, face->guide, shot);
        rows -= told;
    }
    if (face->studies && face->studies->shown != GM_STUDY_NONE) {
        draw_study(&whole, rows + below - gm_screen_rows_below(cells));
        return;
    }
    int side = side_columns(cells, face), width = cells->columns - side;
    const struct gm_sheet picture = gm_sheet_part(&whole, 0, 0, width, rows);
    gm_screen_picture(screen, &picture, shot);
    gm_sheet_hit(&whole, 0, 0, width, (struct gm_hit){.kind = GM_HIT_PICTURE, .height = rows});
    if (below >= 2 && !asked) {
        gm_screen_rule(&whole, below, face->guide ? 0 : side);
        draw_past(&whole, shot, width);
        draw_news(&whole, shot->scene);
    }
    if (side) {
        const struct gm_sheet sheet = gm_sheet_part(&whole, width + 2, 0, side - 3, rows);
        const struct gm_sheet body = gm_sheet_part(&sheet, 0, 1, sheet.width, rows - 1);
        draw_head(&sheet, shot);
        if (face->choosing != GM_CHOOSE_NOTHING) {
            gm_chooser_draw(&body, shot);
        } else {
            gm_side_draw(&body, shot);
        }
    }
    if (!asked && below > 0) {
        draw_status(&whole, shot, side);
    }
}
