/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_VORTICES_DRAW_H
#define GM_SCENES_ODE_VORTICES_DRAW_H

#include "scenes/common/scene.h"

/* Point vortices as the parameters of scenes/ode/vortices.c arrange them, and their pictures. */

enum { GM_REDUCED, GM_SQUARE, GM_TWO_TURNED, GM_ONE_TURNED, GM_RANDOM, GM_VORTEX_COLLISION, GM_PATCHES };

struct gm_vortices {
    struct gm_timing timing;
    int configuration;
    double angle, strength, multipole, distance; /* strength and multipole are a problem's parameters */
    long count, tracers, seed;
    int show;
    char trails[GM_TEXT_SIZE];
};

/* Returns the number of vortices in the state: two of the reduced system, whose images are z -> -z. */
static inline size_t gm_vortices_carried(const struct gm_vortices *vortices)
{
    return vortices->configuration == GM_REDUCED ? 2 : (size_t)vortices->count;
}

/* tracks: radii of vortex 1 in the section; positions, x and y in turn, recent ones and all since the
   start */
enum { GM_SECTION, GM_TRAIL, GM_PAST };

void gm_vortices_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
