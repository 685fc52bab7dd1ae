/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The schemes in the side panel: those of the lanes, those that fit beside them, and the list to choose from.
 */
#include <stdio.h>
#include <string.h>

#include "app/explorer/view/sections.h"
#include "render/layout/labels.h"

/* ---- schemes ---- */

/* Only the claims that some scheme here makes take a column. */
static unsigned claims_here(const struct gm_shot *shot)
{
    unsigned claims = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        claims |= shot->schemes[i]->claims;
    }
    for (size_t i = 0; i < shot->lane_count; i++) {
        claims |= shot->lanes[i].scheme->claims;
    }
    return claims;
}

/* The letters in their columns from the first one on, or without what stands between them. */
static void claims_text(unsigned claims, unsigned columns, bool close, char *text, size_t size)
{
    size_t at = 0;
    text[0] = '\0';
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT && at + 1 < size; bit++) {
        if (claims >> bit & 1) {
            at += (size_t)snprintf(text + at, size - at, "%s", gm_claim_letter(bit));
        } else if ((columns >> bit & 1) && at > 0 && !close) {
            text[at++] = ' ';
            text[at] = '\0';
        }
    }
}

static bool is_narrow(const struct gm_sheet *sheet)
{
    return sheet->width < 40;
}

/* Where a lane's title begins, after the mark of the selected one and the lane's line. */
static int title_column(const struct gm_sheet *sheet)
{
    return is_narrow(sheet) ? 5 : 6;
}

/* What a scheme claims, and its order, right of a title so wide: where that is not whole beside the letters
   in their columns, they stand close, and those of a lane, which its page tells too, give way at last, and
   then its order. Returns where the title's room ends. */
static int scheme_facts(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme, int title_end,
                        unsigned columns, bool give_way, enum gm_role role)
{
    char text[64], order[16];
    snprintf(order, sizeof order, "%d", scheme->order);
    const int right = sheet->width - (is_narrow(sheet) ? 0 : 2);
    int end = right - (is_narrow(sheet) ? 3 : 4);
    claims_text(scheme->claims, columns, false, text, sizeof text);
    if (title_end >= end - gm_sheet_width(sheet, text)) {
        claims_text(scheme->claims, columns, true, text, sizeof text);
        if (title_end >= end - gm_sheet_width(sheet, text)) {
            end = right - gm_sheet_width(sheet, order) - 1;
        }
        if (give_way && title_end >= end - gm_sheet_width(sheet, text)) {
            snprintf(text, sizeof text, "…");
            if (title_end >= end - gm_sheet_width(sheet, text)) {
                return sheet->width;
            }
        }
    }
    gm_sheet_right(sheet, end, row, text, role, false);
    gm_sheet_right(sheet, right, row, order, role, false);
    return end - gm_sheet_width(sheet, text) - 1;
}

static void scheme_row(const struct gm_sheet *sheet, int column, int row, const struct gm_scheme *scheme,
                       unsigned columns, enum gm_role role, bool bold)
{
    const int title_end = column + gm_sheet_width(sheet, scheme->title);
    const int end = scheme_facts(sheet, row, scheme, title_end, columns, false, role);
    const struct gm_sheet left = gm_sheet_part(sheet, 0, 0, end, sheet->height);
    gm_sheet_cut(&left, column, row, scheme->title, role, bold);
}

/* A name without the scheme's title that it begins with, which stands before it. */
static const char *beyond_title(const char *name, const char *title)
{
    const size_t length = strlen(title);
    if (strncmp(name, title, length) != 0 || (name[length] != '\0' && name[length] != ',')) {
        return name;
    }
    return name[length] ? name + length + 2 : "";
}

/* What tells the lane from others of its scheme. */
static void lane_difference(const struct gm_shot_lane *lane, bool overlaid, char *text, size_t size)
{
    const char *title = lane->first_scheme->title;
    const char *panel = overlaid ? "" : beyond_title(lane->shown.panel_name, title);
    const char *colour = beyond_title(lane->shown.colour_name, title);
    snprintf(text, size, "%s%s%s%s", panel[0] ? ", " : "", panel, colour[0] ? ", " : "", colour);
}

/* Up to a column: where room is short the difference keeps its values alone, and then the scheme's title is
   cut before they are. */
static void lane_title(const struct gm_sheet *sheet, int row, const struct gm_shot_lane *lane,
                       const char *difference, int end, bool bold)
{
    enum { LEAST_TITLE = 5 };
    char text[320], values[256];
    const int column = title_column(sheet), room = end - column;
    const int title = gm_sheet_width(sheet, lane->scheme->title);
    if (title + gm_sheet_width(sheet, difference) > room) {
        gm_name_without_keys(difference, values, sizeof values);
        difference = values;
    }
    const int tail = gm_sheet_width(sheet, difference);
    if (title + tail <= room || room - tail < LEAST_TITLE) {
        const struct gm_sheet left = gm_sheet_part(sheet, 0, 0, end, sheet->height);
        snprintf(text, sizeof text, "%s%s", lane->scheme->title, difference);
        gm_sheet_cut(&left, column, row, text, gm_side_role(lane), bold);
        return;
    }
    const struct gm_sheet front = gm_sheet_part(sheet, 0, 0, end - tail, sheet->height);
    gm_sheet_cut(&front, column, row, lane->scheme->title, gm_side_role(lane), bold);
    gm_sheet_text(sheet, front.width, row, difference, gm_side_role(lane), bold);
}

/* What went wrong with a lane, in as many words as its name leaves room for; the last is the shortest. */
static int lane_trouble(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                        const struct gm_shot_lane *lane, int title_end)
{
    char texts[3][160];
    int way = 0;
    if (lane->status != GM_OK) {
        snprintf(texts[0], sizeof texts[0], "✕ %s, t = %.4g", gm_status_name(lane->status), lane->t);
        snprintf(texts[1], sizeof texts[1], "✕ %s", gm_status_name(lane->status));
        snprintf(texts[2], sizeof texts[2], "✕");
    } else {
        snprintf(texts[0], sizeof texts[0], "! %s %.1g", shot->scene->observables[lane->lost].title,
                 lane->values[lane->lost]);
        snprintf(texts[1], sizeof texts[1], "! lost");
        snprintf(texts[2], sizeof texts[2], "!");
    }
    while (way < 2 && title_end >= sheet->width - gm_sheet_width(sheet, texts[way])) {
        way++;
    }
    gm_sheet_right(sheet, sheet->width, row, texts[way], GM_INITIAL, true);
    return sheet->width - gm_sheet_width(sheet, texts[way]) - 1;
}

static void lane_row(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                     const struct gm_shot_lane *lane, bool selected, unsigned columns)
{
    char difference[2 * sizeof lane->shown.panel_name];
    const enum gm_role role = gm_side_role(lane);
    if (selected) {
        gm_sheet_text(sheet, 0, row, "▸", GM_INK, true);
    }
    gm_sheet_text(sheet, title_column(sheet) - 4, row, gm_side_dash(lane), role, false);
    lane_difference(lane, shot->overlaid, difference, sizeof difference);
    const int title_end =
        title_column(sheet) + gm_sheet_width(sheet, lane->scheme->title) + gm_sheet_width(sheet, difference);
    const int end = lane->status != GM_OK || lane->lost >= 0
                        ? lane_trouble(sheet, row, shot, lane, title_end)
                        : scheme_facts(sheet, row, lane->scheme, title_end, columns, true, GM_INK);
    lane_title(sheet, row, lane, difference, end, selected);
}

int gm_side_schemes(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                    const struct gm_side_plan *plan)
{
    if (!plan->lanes) {
        return row;
    }
    unsigned columns = claims_here(shot);
    char text[64];
    gm_side_heading(sheet, row, "SCHEMES");
    gm_sheet_right(sheet, sheet->width, row, sheet->width > 34 ? "claims order" : "order", GM_SECONDARY,
                   false);
    row++;
    for (size_t i = 0; i < shot->lane_count; i++) {
        gm_sheet_hit(sheet, 0, row, sheet->width, (struct gm_hit){.kind = GM_HIT_LANE, .index = i});
        lane_row(sheet, row++, shot, &shot->lanes[i], i == shot->selected, columns);
    }
    int shown = 0, unused = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        if (gm_shot_uses(shot, shot->schemes[i])) {
            continue;
        }
        unused++;
        if (shown < plan->schemes - plan->more) {
            shown++;
            gm_sheet_hit(sheet, 0, row, sheet->width,
                         (struct gm_hit){.kind = GM_HIT_SCHEME, .scheme = shot->schemes[i]});
            scheme_row(sheet, title_column(sheet), row++, shot->schemes[i], columns, GM_SECONDARY, false);
        }
    }
    if (plan->more && plan->schemes > 0) {
        snprintf(text, sizeof text, "… %d more fit", unused - shown);
        gm_sheet_hit(sheet, 0, row, sheet->width, (struct gm_hit){.kind = GM_HIT_KEY, .index = 's'});
        gm_sheet_text(sheet, title_column(sheet), row++, text, GM_SECONDARY, false);
    }
    return row;
}

/* ---- a scheme's formula ---- */

int gm_side_formula_rows(const struct gm_scheme *scheme)
{
    int rows = 1; /* the reference */
    for (const char *at = scheme->formula; at && *at; rows++) {
        at += strcspn(at, "\n");
        at += *at == '\n';
    }
    return rows;
}

void gm_side_formula(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme)
{
    for (const char *at = scheme->formula; at && *at; row++) {
        char line[256];
        size_t length = strcspn(at, "\n");
        snprintf(line, sizeof line, "%.*s", (int)length, at);
        gm_sheet_text(sheet, 0, row, line, GM_INK, false);
        at += length + (at[length] == '\n');
    }
    gm_sheet_cut(sheet, 0, row, scheme->reference ? scheme->reference : "", GM_SECONDARY, false);
}

/* ---- choosing a scheme ---- */

size_t gm_schemes_found(const struct gm_face *face, const struct gm_shot *shot,
                        const struct gm_scheme *found[GM_SHOT_SCHEMES])
{
    int ranks[GM_SHOT_SCHEMES];
    size_t count = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        const struct gm_scheme *scheme = shot->schemes[i];
        const char *texts[] = {scheme->name,
                               scheme->title,
                               scheme->family->title,
                               scheme->reference ? scheme->reference : "",
                               scheme->alias ? scheme->alias : "",
                               NULL};
        const int rank = gm_search_rank(face->typed, texts);
        if (rank < 0) {
            continue;
        }
        const size_t at = gm_search_place(ranks, 0, count, rank);
        memmove(&found[at + 1], &found[at], (count++ - at) * sizeof *found);
        found[at] = scheme;
    }
    return count;
}

void gm_chooser_draw(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    unsigned columns = claims_here(shot);
    const struct gm_face *face = sheet->face;
    const struct gm_scheme *found[GM_SHOT_SCHEMES];
    int count = (int)gm_schemes_found(face, shot, found), row = 0, at = 0;
    for (int i = 0; i < count; i++) {
        at = found[i] == face->choice ? i : at;
    }
    int below = face->choice ? gm_side_formula_rows(face->choice) + 1 : 0;
    int rows = sheet->height > 16 + below ? sheet->height - 3 - below : sheet->height - 2;
    int first = at >= rows ? at - rows + 1 : 0;
    char text[GM_TYPED + 16];
    gm_side_heading(sheet, row, face->choosing == GM_CHOOSE_FORK ? "FORK WITH" : "SWITCH TO");
    gm_sheet_right(sheet, sheet->width, row++, sheet->width > 34 ? "claims order" : "order", GM_SECONDARY,
                   false);
    snprintf(text, sizeof text, face->typed[0] ? "search: %s_" : "type to search%s", face->typed);
    gm_sheet_text(sheet, 4, row++, text, face->typed[0] ? GM_INK : GM_SECONDARY, false);
    for (int i = first; i < count && i < first + rows; i++, row++) {
        bool chosen = found[i] == face->choice;
        enum gm_role role = chosen ? GM_INK : GM_SECONDARY;
        if (chosen) {
            gm_sheet_text(sheet, 0, row, "▸", GM_INK, true);
        }
        for (size_t k = 0; k < shot->lane_count; k++) {
            if (shot->lanes[k].scheme == found[i]) {
                role = gm_side_role(&shot->lanes[k]);
                gm_sheet_text(sheet, 2, row, "●", role, false);
                break;
            }
        }
        gm_sheet_hit(sheet, 0, row, sheet->width, (struct gm_hit){.kind = GM_HIT_SCHEME, .scheme = found[i]});
        scheme_row(sheet, 4, row, found[i], columns, role, chosen);
    }
    if (face->choice && sheet->height - row >= below) {
        gm_side_formula(sheet, row + 1, face->choice);
    }
}
