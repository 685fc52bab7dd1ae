/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The names of keys, typed words, and the search. */
#include "app/explorer/surface/surface.h"

#include <ctype.h>
#include <curses.h>
#include <limits.h>
#include <stdbool.h>
#include <string.h>
#include <strings.h>
#include <wchar.h>

#include "core/basics.h"
#include "render/cells/text.h"

/* The words of scripts and, below them, the other labels of hints. */
static const struct {
    const char *name;
    int key;
} named[] = {{"ENTER", '\n'},     {"ESC", GM_KEY_ESCAPE}, {"TAB", '\t'},
             {"SPACE", ' '},      {"UP", KEY_UP},         {"DOWN", KEY_DOWN},
             {"LEFT", KEY_LEFT},  {"RIGHT", KEY_RIGHT},   {"BACKSPACE", KEY_BACKSPACE},
             {"PGUP", KEY_PPAGE}, {"PGDN", KEY_NPAGE},    {"HOME", KEY_HOME},
             {"END", KEY_END},    {"F1", KEY_F(1)},       {"CTRL-U", 'U' - '@'},
             {"↑", KEY_UP},       {"↓", KEY_DOWN},        {"←", KEY_LEFT},
             {"→", KEY_RIGHT},    {"⌫", KEY_BACKSPACE}};

int gm_key_named(const char *word, size_t length)
{
    for (size_t i = 0; length > 0 && i < GM_COUNT(named); i++) {
        if (strlen(named[i].name) == length && strncasecmp(word, named[i].name, length) == 0) {
            return named[i].key;
        }
    }
    return length == 1 ? word[0] : 0;
}

const char *gm_key_name(size_t index)
{
    return index < GM_COUNT(named) && (unsigned char)named[index].name[0] < 0x80 ? named[index].name : NULL;
}

bool gm_typed_key(char *typed, int key)
{
    size_t length = strlen(typed);
    if (key == KEY_BACKSPACE) {
        typed[length > 0 ? length - 1 : 0] = '\0';
        return true;
    }
    if (key < ' ' || key > '~' || length + 1 >= GM_TYPED) {
        return key >= ' ' && key <= '~';
    }
    typed[length] = (char)key;
    typed[length + 1] = '\0';
    return true;
}

/* ---- searching ---- */

/* The place of a word in a text, the best first. */
enum { EXACT, PREFIX, WORD_START, ANYWHERE, NOWHERE };

static int place_in(const char *text, const char *word, size_t length)
{
    int best = NOWHERE;
    for (const char *at = text; *at && best > WORD_START; at++) {
        if (strncasecmp(at, word, length) == 0) {
            const bool start = at == text || !isalnum((unsigned char)at[-1]);
            best = at == text ? (at[length] ? PREFIX : EXACT) : start ? WORD_START : ANYWHERE;
        }
    }
    return best;
}

int gm_search_rank(const char *typed, const char *const *texts)
{
    int worst = 0;
    while (*typed) {
        const size_t length = strcspn(typed, " ");
        int best = length == 0 ? 0 : INT_MAX;
        for (int i = 0; length > 0 && texts[i]; i++) {
            const int place = place_in(texts[i], typed, length);
            /* among equal places the first text, the name, ranks first */
            const int rank = place == NOWHERE ? INT_MAX : place * GM_SEARCH_TEXTS + i;
            best = rank < best ? rank : best;
        }
        worst = best > worst ? best : worst;
        typed += length + (typed[length] == ' ');
    }
    return worst == INT_MAX ? -1 : worst;
}

size_t gm_search_place(int *ranks, size_t first, size_t count, int rank)
{
    size_t at = count;
    for (; at > first && ranks[at - 1] > rank; at--) {
        ranks[at] = ranks[at - 1];
    }
    ranks[at] = rank;
    return at;
}

/* ---- a line of text that is edited ---- */

enum { TO_BEGIN = 'A' - '@', TO_END = 'E' - '@', CLEAR = 'U' - '@', CUT = 'K' - '@' };

static bool is_inside(const struct gm_edit *line, size_t at)
{
    return ((unsigned char)line->text[at] & 0xC0) == 0x80;
}

static size_t before(const struct gm_edit *line, size_t at)
{
    do {
        at -= at > 0;
    } while (at > 0 && is_inside(line, at));
    return at;
}

static size_t behind(const struct gm_edit *line, size_t at)
{
    do {
        at += at < line->length;
    } while (at < line->length && is_inside(line, at));
    return at;
}

void gm_edit_set(struct gm_edit *line, const char *text, size_t at)
{
    line->length = strnlen(text, GM_EDIT - 1);
    line->refused = strlen(text) - line->length;
    memcpy(line->text, text, line->length);
    line->text[line->length] = '\0';
    line->at = at < line->length ? at : line->length;
}

static void cut(struct gm_edit *line, size_t from, size_t to)
{
    memmove(line->text + from, line->text + to, line->length + 1 - to);
    line->length -= to - from;
    line->at = from;
    line->refused = 0;
}

bool gm_edit_press(struct gm_edit *line, int key)
{
    switch (key) {
    case KEY_BACKSPACE:
        cut(line, before(line, line->at), line->at);
        return true;
    case KEY_LEFT:
        line->at = before(line, line->at);
        return true;
    case KEY_RIGHT:
        line->at = behind(line, line->at);
        return true;
    case KEY_HOME:
    case TO_BEGIN:
        line->at = 0;
        return true;
    case KEY_END:
    case TO_END:
        line->at = line->length;
        return true;
    case KEY_DC:
        cut(line, line->at, behind(line, line->at));
        return true;
    case CLEAR:
        cut(line, 0, line->length);
        return true;
    case CUT:
        cut(line, line->at, line->length);
        return true;
    default:
        break;
    }
    key = key == '\t' ? ' ' : key;
    if (key < ' ' || key == 127 || key > 255) {
        return key >= 0 && key <= 127;
    }
    if (line->length + 1 >= GM_EDIT) {
        line->refused++;
        return true;
    }
    memmove(line->text + line->at + 1, line->text + line->at, line->length + 1 - line->at);
    line->text[line->at++] = (char)key;
    line->length++;
    return true;
}

/* ---- drawing ---- */

static const uint32_t cursor = 0x258F; /* a bar at the left of its cell, which no formula has */

/* Returns the code, or '?' for control characters and those that do not take one cell. */
static uint32_t shown(uint32_t code)
{
    const bool plain = gm_text_is_shown(code) && (code < 0x300 || wcwidth((wchar_t)code) == 1);
    return plain && (code < 0x300 || code >= 0x370) ? code : '?';
}

static int cells_before(const struct gm_edit *line, size_t at)
{
    const char *text = line->text;
    int cells = 0;
    while (text < line->text + at && gm_text_next(&text) != 0) {
        cells++;
    }
    return cells;
}

/* Returns the first visible cell of `width`: the cursor is two thirds along if text follows. */
static int first_cell(const struct gm_edit *line, int width)
{
    const int all = cells_before(line, line->length) + 1, at = cells_before(line, line->at);
    const int first = at - 2 * width / 3, last = all - width;
    return first < 0 || last <= 0 ? 0 : first < last ? first : last;
}

void gm_edit_draw(const struct gm_sheet *sheet, int row, const struct gm_edit *line)
{
    const int first = first_cell(line, sheet->width), at = cells_before(line, line->at);
    const char *text = line->text;
    for (int cell = 0; cell < first + sheet->width; cell++) {
        const uint32_t code = cell == at ? cursor : gm_text_next(&text);
        if (code == 0) {
            return;
        }
        if (cell >= first) {
            const bool more =
                (cell == first && first > 0) || (cell + 1 == first + sheet->width && *text && cell != at);
            gm_sheet_glyph(sheet, cell - first, row,
                           more         ? 0x2026
                           : cell == at ? code
                                        : shown(code),
                           more ? GM_SECONDARY : GM_INK, cell == at);
        }
    }
}

int gm_edit_column(const struct gm_sheet *sheet, const struct gm_edit *line, size_t at)
{
    const int first = first_cell(line, sheet->width), last = sheet->width - 1;
    const int cell = cells_before(line, at) + (at >= line->at && at < line->length) - first;
    return cell < 0 ? 0 : cell > last ? last : cell;
}
