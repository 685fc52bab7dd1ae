/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The appearance of schemes and lanes in lists. */
#include "app/explorer/view/view.h"

#include <stdio.h>
#include <string.h>

/* ---- claims ---- */

unsigned gm_schemes_claims(const struct gm_shot *shot)
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

/* Writes the claims' letters in their columns, or if `close` without spaces. */
static void claims_text(unsigned claims, unsigned columns, bool close, char *text, size_t size)
{
    text[0] = '\0';
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (claims >> bit & 1) {
            gm_append(text, size, "%s", gm_claim_letter(bit));
        } else if ((columns >> bit & 1) && text[0] && !close) {
            gm_append(text, size, " ");
        }
    }
}

void gm_schemes_heading(const struct gm_sheet *sheet, int row, const char *text)
{
    gm_sheet_text(sheet, 0, row, text, GM_SECONDARY, true);
    gm_sheet_right(sheet, sheet->width, row, sheet->width > 34 ? "claims order" : "order", GM_SECONDARY,
                   false);
}

bool gm_schemes_narrow(const struct gm_sheet *sheet)
{
    return sheet->width < 40;
}

int gm_schemes_facts(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme, int title_end,
                     unsigned columns, bool give_way, enum gm_role role)
{
    char text[64], order[16];
    snprintf(order, sizeof order, "%d", scheme->order);
    const int right = sheet->width - (gm_schemes_narrow(sheet) ? 0 : 2);
    int end = right - (gm_schemes_narrow(sheet) ? 3 : 4);
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

void gm_schemes_row(const struct gm_sheet *sheet, int column, int row, const struct gm_shot *shot,
                    const struct gm_scheme *scheme, enum gm_role role, bool bold)
{
    size_t at = 0;
    while (at < shot->scheme_count && shot->schemes[at] != scheme) {
        at++;
    }
    const struct gm_scheme *same = at < shot->scheme_count ? shot->same[at] : NULL;
    char title[128];
    snprintf(title, sizeof title, "%s%s%s", scheme->title, same ? " = " : "", same ? same->title : "");
    const int title_end = column + gm_sheet_width(sheet, title);
    const int end = gm_schemes_facts(sheet, row, scheme, title_end, gm_schemes_claims(shot), false, role);
    const struct gm_sheet left = gm_sheet_part(sheet, 0, 0, end, sheet->height);
    gm_sheet_cut(&left, column, row, title, role, bold);
}

/* ---- the formula ---- */

int gm_schemes_formula_rows(const struct gm_sheet *sheet, const struct gm_scheme *scheme)
{
    const struct gm_sheet nothing = gm_sheet_part(sheet, 0, 0, sheet->width, 0);
    return gm_sheet_wrapped(&nothing, 0, 0, 100, scheme->formula, GM_INK) + 1;
}

void gm_schemes_formula(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme)
{
    row += gm_sheet_wrapped(sheet, 0, row, sheet->height - row - 1, scheme->formula, GM_INK);
    gm_sheet_cut(sheet, 0, row, scheme->reference ? scheme->reference : "", GM_SECONDARY, false);
}
