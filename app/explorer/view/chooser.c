/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The list of schemes, with a search. */
#include "app/explorer/view/view.h"

#include <curses.h>
#include <stdio.h>
#include <string.h>

#include "app/explorer/surface/surface.h"
#include "core/aliases.h"

enum { PAGE = 10 };

const struct gm_scheme gm_chooser_user = {
    .name = "own",
    .title = "your own scheme",
    .formula = "composition(verlet; 1/2, 1/2), adjoint(rk4)\nrunge-kutta(a; b), partitioned(a; b; ah; bh)\n"
               "splitting(drifts; kicks), or a file: ./my.scheme",
};

/* Finds the suitable schemes that match the typed words, the best first, and last the one to be typed.
   Returns their number. */
static size_t find_all(const struct gm_face *face, const struct gm_shot *shot,
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

/* ---- keys ---- */

/* Returns the first scheme after the selected lane's that no lane uses. */
static const struct gm_scheme *first_choice(const struct gm_shot *shot)
{
    size_t own = 0;
    for (size_t i = 0; i < shot->scheme_count; i++) {
        if (shot->schemes[i] == shot->lanes[shot->selected].scheme) {
            own = i;
        }
    }
    for (size_t i = 1; i < shot->scheme_count; i++) {
        const struct gm_scheme *scheme = shot->schemes[(own + i) % shot->scheme_count];
        if (!gm_shot_uses(shot, scheme)) {
            return scheme;
        }
    }
    return shot->schemes[own];
}

enum gm_key_result gm_chooser_open(const struct gm_keystroke *press, const struct gm_key_code *key)
{
    press->face->choosing = (enum gm_choosing)key->meaning;
    press->face->typed[0] = '\0';
    press->face->choice = press->shot->scheme_count > 0 ? first_choice(press->shot) : NULL;
    return GM_KEY_DONE;
}

/* Moves the choice up or down in the list. */
static void move_choice(struct gm_face *face, const struct gm_shot *shot, int by)
{
    const struct gm_scheme *found[GM_SHOT_SCHEMES];
    size_t count = find_all(face, shot, found), at = 0;
    if (count == 0) {
        face->choice = NULL;
        return;
    }
    for (size_t i = 0; i < count; i++) {
        at = found[i] == face->choice ? i : at;
    }
    long next = (long)at + by, last = (long)count - 1;
    if (by == 1 || by == -1) {
        next = (next + (long)count) % (long)count;
    }
    face->choice = found[next < 0 ? 0 : next > last ? last : next];
}

/* Chooses the best match; without a typed word the choice stays. */
static void choose_best(struct gm_face *face, const struct gm_shot *shot)
{
    const struct gm_scheme *found[GM_SHOT_SCHEMES];
    const size_t count = find_all(face, shot, found);
    if (face->typed[0] || !face->choice) {
        face->choice = count > 0 ? found[0] : NULL;
    }
}

enum gm_key_result gm_chooser_press(const struct gm_keystroke *press)
{
    struct gm_face *face = press->face;
    if (gm_key_is_escape(press->key) || (gm_key_is_erase(press->key) && !face->typed[0])) {
        face->choosing = GM_CHOOSE_NOTHING;
        return GM_KEY_DONE;
    }
    if (gm_key_is_enter(press->key)) {
        if (!face->choice || face->choice == &gm_chooser_user) {
            return face->choice ? GM_KEY_TYPED : GM_KEY_DONE;
        }
        enum gm_order_kind kind = face->choosing == GM_CHOOSE_FORK ? GM_ORDER_FORK : GM_ORDER_SWITCH;
        face->choosing = GM_CHOOSE_NOTHING;
        return gm_keystroke_order(press, (struct gm_order){.kind = kind, .scheme = face->choice});
    }
    switch (press->key) {
    case KEY_UP:
    case KEY_BTAB:
        move_choice(face, press->shot, -1);
        return GM_KEY_DONE;
    case KEY_DOWN:
    case '\t':
        move_choice(face, press->shot, 1);
        return GM_KEY_DONE;
    case KEY_PPAGE:
        move_choice(face, press->shot, -PAGE);
        return GM_KEY_DONE;
    case KEY_NPAGE:
        move_choice(face, press->shot, PAGE);
        return GM_KEY_DONE;
    case '?':
        return face->choice && face->choice != &gm_chooser_user
                   ? gm_keystroke_page(press, GM_PAGE_SCHEME, face->choice)
                   : GM_KEY_DONE;
    default:
        if (gm_typed_key(face->typed, press->key)) {
            choose_best(face, press->shot);
        }
        return GM_KEY_DONE;
    }
}

/* ---- drawing ---- */

void gm_chooser_draw(const struct gm_sheet *sheet, const struct gm_shot *shot)
{
    const struct gm_face *face = sheet->face;
    const struct gm_scheme *found[GM_SHOT_SCHEMES];
    int count = (int)find_all(face, shot, found), row = 0, at = 0;
    for (int i = 0; i < count; i++) {
        at = found[i] == face->choice ? i : at;
    }
    int below = face->choice ? gm_schemes_formula_rows(face->choice) + 1 : 0;
    int rows = sheet->height > 16 + below ? sheet->height - 3 - below : sheet->height - 2;
    int first = at >= rows ? at - rows + 1 : 0;
    char text[GM_TYPED + 16];
    gm_schemes_heading(sheet, row++, face->choosing == GM_CHOOSE_FORK ? "FORK WITH" : "SWITCH TO");
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
                role = gm_schemes_role(&shot->lanes[k]);
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
    if (face->choice && sheet->height - row >= below) {
        gm_schemes_formula(sheet, row + 1, face->choice);
    }
}
