/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is observed of waves in a potential, u_tt = u_xx - V'(u). */
#include "scenes/field/wave_observables.h"

#include <math.h>

#include "core/field/families/laws/wave.h"

/* Between walls half of the ring's, whose other half is the mirror image. */
static double seen(const struct gm_view *view, double of_ring)
{
    return view->problem->line.walls ? of_ring / 2 : of_ring;
}

double gm_view_energy(const struct gm_view *view)
{
    return seen(view, gm_wave_energy(view->problem, view->state));
}

double gm_view_own_energy(const struct gm_view *view)
{
    return seen(view, gm_wave_own_energy(view->problem, view->scheme, view->state, view->memory));
}

double gm_view_momentum(const struct gm_view *view)
{
    return view->problem->line.walls ? NAN : gm_wave_momentum(view->problem, view->state);
}

double gm_view_amplitude(const struct gm_view *view)
{
    double largest = 0;
    for (size_t i = 0; i < view->problem->line.points; i++) {
        largest = fmax(largest, fabs(view->state[i]));
    }
    return largest;
}

/* A breather has none, a kink of the sine-Gordon equation that of its mass 8 at its velocity. */
double gm_unit_momentum(const void *parameters)
{
    return (void)parameters, 1;
}

const char *const gm_wave_schemes[] = {
    "leapfrog",   "energy-conserving", "box",          "euler-box",        "midpoint-box",
    "gauss-box3", "lobatto-box2",      "lobatto-box4", "lobatto-nystrom4", NULL};
