/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_VORTICES_H
#define GM_SCENES_ODE_VORTICES_H

#include "scenes/frame/graph.h"

/* What scenes/ode/vortices.c, scenes/ode/vortices_start.c (where they start) and scenes/ode/vortices_draw.c
   share. */

enum { GM_REDUCED, GM_SQUARE, GM_TWO_TURNED, GM_ONE_TURNED, GM_RANDOM, GM_COLLISION };

/* tracks: radii of vortex 1 in the section; positions, x and y in turn, lately and since the start */
enum { GM_SECTION, GM_TRAIL, GM_PAST };

struct gm_vortices {
    struct gm_timing timing;
    int configuration;
    double angle, strength, distance;
    long count, tracers, seed;
};

/* How many vortices the state holds: of the reduced system two, and their images are z -> -z. */
size_t gm_vortices_carried(const struct gm_vortices *own);

/* Whether two vortices start in one place, where they would have no velocity. */
bool gm_vortices_coincide(const struct gm_vortices *own);

/* The start of struct gm_scene: vortices as configured, tracers spread over a disc. */
void gm_vortices_start(const void *parameters, const struct gm_problem *problem, double *y);

void gm_vortices_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
