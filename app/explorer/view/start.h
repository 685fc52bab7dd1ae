/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_START_H
#define GM_APP_EXPLORER_VIEW_START_H

#include "app/explorer/surface/screen.h"
#include "app/tours/tour.h"

/* The screen at the start: the scenes found, and behind them the tours. */

struct gm_start_entry {
    const struct gm_scene *scene; /* one of the two is NULL; both: a system of one's own */
    const struct gm_tour *tour;
};
#define GM_START_OWN "your own system"
enum { GM_START_ENTRIES = 128 };
struct gm_start {
    struct gm_start_entry found[GM_START_ENTRIES];
    size_t count, choice;
    size_t scenes;               /* so many of them are scenes, or one's own system */
    int ranks[GM_START_ENTRIES]; /* how well each answers what was typed */
    char typed[GM_TYPED];
};

/* With `choice` marked; `shot` is a look at that scene, or NULL where there is none yet, `fresh` says that
   its picture is a new one, and `said` why it cannot be looked at, or "". */
void gm_screen_draw_start(struct gm_screen *screen, struct gm_face *face, const struct gm_start *start,
                          const struct gm_shot *shot, bool fresh, const char *said);

#endif
