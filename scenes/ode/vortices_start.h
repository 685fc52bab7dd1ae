/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_VORTICES_START_H
#define GM_SCENES_ODE_VORTICES_START_H

#include "scenes/common/scene.h"

/* Point vortices as the parameters of scenes/ode/vortices.c arrange them. */

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
size_t gm_vortices_carried(const struct gm_vortices *vortices);

/* Returns true if two vortices start at one point, where they would have no velocity. */
bool gm_vortices_coincide(const struct gm_vortices *vortices);

/* Sets the start of struct gm_scene: vortices as configured, tracers spread over a disc. */
void gm_vortices_start(const void *parameters, const struct gm_problem *problem, double *y);

#endif
