/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_LOOK_H
#define GM_SCENES_FLOW_LOOK_H

#include "render/picture/picture.h"
#include "scenes/flow/room_scene.h"

/* The parts of a room's picture. */

/* The look of the field of a flow. */
struct gm_look {
    const char *axes[2];   /* labels of x and y of the field, if one lane is shown; NULL: none are drawn */
    double scalar_high;    /* the scalar's range */
    double temperature[2]; /* the range of the temperature */
    const char *names[GM_SHOW_TEMPERATURE + 1]; /* labels of the colours */
    double vorticity_range;                     /* the end of the colours */
    double speed_high;
    const char *const *sides; /* names of openings, by the number of their side; NULL: "inlet", "outlet" */
    const double *levels;     /* levels of psi; NULL: they are chosen by the flow through */
    size_t level_count;
};

/* Adds a panel of each lane, all with the same colours; `graphs`: graphs have the lanes' colours. */
void gm_flow_draw_fields(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                         const struct gm_look *look, bool graphs);

/* Draws a panel for each quantity of the profiles, the exact one broad and grey, published points in red. */
void gm_room_draw_profiles(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                           enum gm_place place);

#endif
