/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A line of text that is edited. */
#include "app/explorer/surface/surface.h"

#include <curses.h>
#include <string.h>
#include <wchar.h>

#include "render/cells/text.h"

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
