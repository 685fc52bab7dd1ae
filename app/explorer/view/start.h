/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_START_H
#define GM_APP_EXPLORER_VIEW_START_H

#include "app/explorer/surface/screen.h"
#include "app/tours/tour.h"

/* The screen at the start: what was found of what there is, group by group. */

enum gm_start_group {
    GM_START_SCENES, /* and a system of one's own, last */
    GM_START_TOURS,
    GM_START_SYSTEMS, /* of files */
    GM_START_ROOMS,
    GM_START_GROUPS
};
struct gm_start_entry {
    enum gm_start_group group;
    const char *name, *title;
    const struct gm_scene *scene; /* NULL: it is made of a file, or typed */
    const struct gm_tour *tour;   /* NULL: it is none */
};
#define GM_START_OWN "your own system"
#define GM_START_OWN_TITLE "A formula that you type, or a file"
enum { GM_START_ENTRIES = 512 };
struct gm_start {
    struct gm_start_entry found[GM_START_ENTRIES];
    size_t count, choice;
    int ranks[GM_START_ENTRIES]; /* how well each answers what was typed */
    char typed[GM_TYPED];
};

/* Whether it is what somebody types. */
bool gm_start_is_user(const struct gm_start_entry *entry);
/* The place of the first of the next group that something was found of, after that of the choice, or of the
   first; the choice where there is one group alone. */
size_t gm_start_next_group(const struct gm_start *start);

/* With `choice` marked; `shot` is a look at that scene, or NULL where there is none yet, `fresh` says that
   its picture is a new one, and `said` why it cannot be looked at, or "". */
void gm_screen_draw_start(struct gm_screen *screen, struct gm_face *face, const struct gm_start *start,
                          const struct gm_shot *shot, bool fresh, const char *said);

#endif
