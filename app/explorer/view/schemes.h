/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_SCHEMES_H
#define GM_APP_EXPLORER_VIEW_SCHEMES_H

#include "app/explorer/surface/sheet.h"
#include "app/runs/shot.h"

/* Schemes in the rows of a list: title, claims and order in columns, the formula below. */

/* The colour of a lane, and its line as three cells of text. */
enum gm_role gm_schemes_role(const struct gm_shot_lane *lane);
const char *gm_schemes_dash(const struct gm_shot_lane *lane);

/* The claims that some scheme here makes: only those take a column. */
unsigned gm_schemes_claims(const struct gm_shot *shot);
/* Whether there is no room for air between the columns. */
bool gm_schemes_narrow(const struct gm_sheet *sheet);

/* A heading, with those of the columns. */
void gm_schemes_heading(const struct gm_sheet *sheet, int row, const char *text);
/* What a scheme claims, and its order, right of a title so wide: where that is not whole beside the letters
   in their columns, they stand close, and those of a lane, which its page tells too, give way at last, and
   then its order. Returns where the title's room ends. */
int gm_schemes_facts(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme, int title_end,
                     unsigned columns, bool give_way, enum gm_role role);
/* A scheme's title at a column, and its facts. */
void gm_schemes_row(const struct gm_sheet *sheet, int column, int row, const struct gm_scheme *scheme,
                    unsigned columns, enum gm_role role, bool bold);

/* The formula with its reference, and the rows that it takes. */
int gm_schemes_formula_rows(const struct gm_scheme *scheme);
void gm_schemes_formula(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme);

#endif
