/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The start of point vortices and their tracers: on a polygon, turned, at random, or nearly colliding. */
#include <math.h>
#include <stdint.h>

#include "core/functions/functions.h"

#include "scenes/ode/vortices_start.h"

/* splitmix64 (Steele, Lea & Flood 2014): a number in [0, 1) */
static double next_random(uint64_t *state)
{
    *state += 0x9e3779b97f4a7c15u;
    uint64_t z = *state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static const double golden_angle = 2.3999632297286533; /* fills a disc evenly */

static void place(const struct gm_vortices *vortices, size_t count, double *x, double *y)
{
    uint64_t random = (uint64_t)vortices->seed;
    const double patch = 0.4; /* radius; the pair fits into 1, 3 radii apart; two merge below 3.2 */
    static const double pair_x[] = {0.5, -0.5, 1, -1.2}, pair_y[] = {0, 0, 0.3, 0.1};
    for (size_t i = 0; i < count; i++) {
        double turn = 2 * M_PI * (double)i / (double)count, radius = 1;
        switch (vortices->configuration) {
        case GM_REDUCED:
            turn = i == 0 ? 0 : M_PI / 2 + vortices->angle;
            break;
        case GM_TWO_TURNED:
            turn += i % 2 == 1 ? vortices->angle : 0;
            break;
        case GM_ONE_TURNED:
            turn += i == 1 ? vortices->angle : 0;
            break;
        case GM_RANDOM:
            radius = sqrt(next_random(&random));
            turn = 2 * M_PI * next_random(&random);
            break;
        case GM_PATCHES:
            radius = patch * sqrt(((double)(i / 2) + 0.5) / (double)((count + 1) / 2));
            turn = golden_angle * (double)(i / 2);
            break;
        default:
            break;
        }
        x[i] = radius * gm_cos(turn);
        y[i] = radius * gm_sin(turn);
        if (vortices->configuration == GM_PATCHES) { /* odd ones are opposite to even ones */
            x[i] *= i % 2 == 0 ? 1 : -1;
            y[i] = (i % 2 == 0 ? 1 : -1) * (y[i] + 1 - patch);
        }
        if (vortices->configuration == GM_VORTEX_COLLISION) {
            x[i] = i < 2 ? vortices->distance * pair_x[i] : pair_x[i];
            y[i] = pair_y[i];
        }
    }
}

size_t gm_vortices_carried(const struct gm_vortices *vortices)
{
    return vortices->configuration == GM_REDUCED ? 2 : (size_t)vortices->count;
}

/* Random ones are never so close. */
bool gm_vortices_coincide(const struct gm_vortices *vortices)
{
    double x[4], y[4];
    if (vortices->configuration == GM_RANDOM || vortices->configuration == GM_PATCHES ||
        vortices->configuration == GM_SQUARE) {
        return false;
    }
    const size_t carried = gm_vortices_carried(vortices);
    place(vortices, carried, x, y);
    if (vortices->configuration == GM_REDUCED) {
        for (size_t i = 0; i < 2; i++) {
            x[2 + i] = -x[i];
            y[2 + i] = -y[i];
        }
    }
    bool close = false;
    for (size_t i = 0; i < 4; i++) {
        for (size_t j = i + 1; j < 4; j++) {
            close |= gm_hypot(x[i] - x[j], y[i] - y[j]) < 1e-9;
        }
    }
    return close;
}

void gm_vortices_start(const void *parameters_, const struct gm_problem *problem, double *y)
{
    const struct gm_vortices *vortices = parameters_;
    const size_t carried = gm_vortices_carried(vortices), tracers = problem->passive;
    place(vortices, carried, y, y + carried);
    for (size_t k = 0; k < tracers; k++) {
        const double radius = 1.6 * sqrt(((double)k + 0.5) / (double)tracers),
                     turn = golden_angle * (double)k;
        y[2 * carried + k] = radius * gm_cos(turn);
        y[2 * carried + tracers + k] = radius * gm_sin(turn);
    }
}
