/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_GUIDE_H
#define GM_APP_EXPLORER_VIEW_GUIDE_H

#include "app/explorer/surface/sheet.h"
#include "app/tours/tour.h"

/* Leads through a tour in the explorer: where it is, what is told below the picture, its keys. */

struct gm_guide {
    const struct gm_tour *tour;
    size_t step;
    bool answered; /* the step's question is, or it has none */
};

enum gm_guide_result {
    GM_GUIDE_OPEN, /* a step is to be shown from its start */
    GM_GUIDE_RUN,  /* its question is answered: let it run */
    GM_GUIDE_END,  /* there is no step there */
};

/* A tour at the start of its first step. */
struct gm_guide gm_guide_open(const struct gm_tour *tour);

/* What a key of the tour does: n answers or goes on, N goes back, a shows the step again. */
enum gm_guide_result gm_guide_press(struct gm_guide *guide, int key);

/* How many rows below the picture the texts take on a screen of this size. */
int gm_guide_rows(const struct gm_sheet *screen, const struct gm_guide *guide);
/* Writes them into a sheet of so many rows. */
void gm_guide_draw(const struct gm_sheet *sheet, const struct gm_guide *guide);

#endif
