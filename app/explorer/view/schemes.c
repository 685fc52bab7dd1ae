/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The appearance of schemes in lists, and the list to choose from. */
#include "app/explorer/view/view.h"

#include <stdio.h>
#include <string.h>

#include "app/explorer/surface/surface.h"
#include "core/aliases.h"

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
            gm_append(text, size, "%s", gm_claims[bit].letter);
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

static int formula_rows(const struct gm_sheet *sheet, const struct gm_scheme *scheme)
{
    const struct gm_sheet nothing = gm_sheet_part(sheet, 0, 0, sheet->width, 0);
    return gm_sheet_wrapped(&nothing, 0, 0, 100, scheme->formula, GM_INK) + 1;
}

void gm_schemes_formula(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme)
{
    row += gm_sheet_wrapped(sheet, 0, row, sheet->height - row - 1, scheme->formula, GM_INK);
    gm_sheet_cut(sheet, 0, row, scheme->reference ? scheme->reference : "", GM_SECONDARY, false);
}

/* ---- the list of schemes, with a search ---- */

const struct gm_scheme gm_chooser_user = {
    .name = "own",
    .title = "your own scheme",
    .formula = "composition(rk4; 1/2, 1/2)\nstrang(kinetic, potential)\nprojected(rk4; H)\nrelaxed(rk4; H)\n"
               "adjoint(rk4)\nrunge-kutta(a; b)\npartitioned(a; b; ah; bh)\nsplitting(drifts; kicks)\n"
               "or a file: ./my.scheme",
};

size_t gm_chooser_find(const struct gm_face *face, const struct gm_shot *shot,
                       const struct gm_scheme *found[GM_SHOT_SCHEMES])
{
    int ranks[GM_SHOT_SCHEMES];
    size_t count = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        const struct gm_scheme *scheme = shot->schemes[i];
        enum { ALIASES = 8 };
        const char *texts[4 + ALIASES + 1] = {scheme->name, scheme->title, scheme->family->title,
                                              scheme->reference ? scheme->reference : ""};
        for (size_t k = 0; k < ALIASES; k++) {
            texts[4 + k] = gm_alias_of(scheme->name, k);
        }
        const int rank = gm_search_rank(face->typed, texts);
        if (rank < 0) {
            continue;
        }
        const size_t at = gm_search_place(ranks, 0, count, rank);
        memmove(&found[at + 1], &found[at], (count++ - at) * sizeof *found);
        found[at] = scheme;
    }
    const char *own[] = {gm_chooser_user.name, gm_chooser_user.title, gm_chooser_user.formula, NULL};
    if (count < GM_SHOT_SCHEMES && gm_search_rank(face->typed, own) >= 0) {
        found[count++] = &gm_chooser_user;
    }
    return count;
}

const char *gm_chooser_alias(const struct gm_face *face)
{
    const struct gm_scheme *choice = face->typed[0] ? face->choice : NULL;
    if (!choice ||
        gm_search_rank(face->typed, (const char *const[]){choice->name, choice->title, NULL}) >= 0) {
        return NULL;
    }
    const char *alias;
    size_t k = 0;
    do {
        alias = gm_alias_of(choice->name, k++);
    } while (alias && gm_search_rank(face->typed, (const char *const[]){alias, NULL}) < 0);
    return alias;
}

void gm_chooser_draw(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    const struct gm_face *face = sheet->face;
    const struct gm_scheme *found[GM_SHOT_SCHEMES];
    int count = (int)gm_chooser_find(face, shot, found), row = 0, at = 0;
    for (int i = 0; i < count; i++) {
        at = found[i] == face->choice ? i : at;
    }
    /* the formula has the rows that the list leaves, and those beyond a list of LIST rows */
    enum { LIST = 15, LEAST = 3 };
    const int most = sheet->height - 2 - (count < LIST ? count : LIST);
    int below = face->choice ? 1 + formula_rows(sheet, face->choice) : 0;
    below = most < LEAST ? 0 : below < most ? below : most;
    const int rows = sheet->height - 2 - below;
    int first = at >= rows ? at - rows + 1 : 0;
    char text[GM_TYPED + 16];
    gm_schemes_heading(sheet, row++, face->choosing == GM_CHOOSE_FORK ? "FORK WITH" : "SWITCH TO");
    snprintf(text, sizeof text, face->typed[0] ? "search: %s_" : "type to search%s", face->typed);
    gm_sheet_text(sheet, 4, row++, text, face->typed[0] ? GM_INK : GM_SECONDARY, false);
    if (count == 0) {
        char message[GM_MESSAGE];
        gm_scheme_refuse_among(shot->schemes, shot->scheme_count, face->typed,
                               "backspace takes a letter back", message);
        row += gm_sheet_wrapped(sheet, 4, row, rows, message, GM_INK);
    }
    for (int i = first; i < count && i < first + rows; i++, row++) {
        bool chosen = found[i] == face->choice;
        enum gm_role role = chosen ? GM_INK : GM_SECONDARY;
        if (chosen) {
            gm_sheet_text(sheet, 0, row, "▸", GM_INK, true);
        }
        for (size_t k = 0; k < shot->lane_count; k++) {
            if (shot->lanes[k].scheme == found[i]) {
                role = gm_lane_role(shot->lanes[k].shown.colour);
                gm_sheet_text(sheet, 2, row, "●", role, false);
                break;
            }
        }
        gm_sheet_hit(sheet, 0, row, sheet->width, (struct gm_hit){.kind = GM_HIT_SCHEME, .scheme = found[i]});
        if (found[i] == &gm_chooser_user) {
            gm_sheet_text(sheet, 4, row, found[i]->title, role, chosen);
        } else {
            gm_schemes_row(sheet, 4, row, shot, found[i], role, chosen);
        }
    }
    if (below > 0) {
        gm_schemes_formula(sheet, row + 1, face->choice);
    }
}
