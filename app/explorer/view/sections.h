/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_SECTIONS_H
#define GM_APP_EXPLORER_VIEW_SECTIONS_H

#include "app/explorer/view/screen.h"

/* What the files of the side panel share. Every section draws from a row on and returns the one after it. */

/* The rows of the sections. */
struct gm_side_plan {
    bool lanes;     /* they are listed */
    int schemes;    /* rows of schemes without a lane, the last one perhaps "more" */
    int parameters; /* rows */
    bool sparks;
    bool stacked;    /* an observable's name has a row of its own */
    int observables; /* rows, sparks included */
    int gap;         /* blank rows before a section */
    bool more;       /* schemes than rows */
};

void gm_side_heading(const struct gm_sheet *sheet, int row, const char *text);
int gm_side_schemes(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                    const struct gm_side_plan *plan);
int gm_side_observables(const struct gm_sheet *sheet, int row, const struct gm_shot *shot,
                        const struct gm_side_plan *plan);
/* The rows of observables that there are: those of the scene and, where time was turned, the way back. */
int gm_side_observable_count(const struct gm_shot *shot);

/* A lane's colour, and its line as three cells of text. */
enum gm_role gm_side_role(const struct gm_shot_lane *lane);
const char *gm_side_dash(const struct gm_shot_lane *lane);

/* A number as short as can be, with a true minus sign. */
void gm_side_number(double value, char *text, size_t size);

int gm_side_formula_rows(const struct gm_scheme *scheme);
void gm_side_formula(const struct gm_sheet *sheet, int row, const struct gm_scheme *scheme);

#endif
