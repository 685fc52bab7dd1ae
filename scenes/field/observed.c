/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Observables of fields on a line: the largest residual of local laws, and residuals over space and time; for
   waves in a potential, u_tt = u_xx - V'(u), energies and momentum. */
#include "scenes/field/observed.h"

#include <math.h>
#include <stdlib.h>

#include "core/field/families/dispersive/box.h"
#include "core/field/families/families.h"
#include "core/field/families/laws/form.h"
#include "core/field/families/laws/wave.h"

static bool residuals(const struct gm_view *view, enum gm_local_law law, double *residual)
{
    if (gm_field_of(view->problem)->wave) {
        return gm_wave_laws(view->problem, view->scheme, view->dt, view->state, law, residual);
    }
    if (gm_field_of(view->problem)->form->hessians) {
        return gm_form_laws(view->problem, view->scheme, view->dt, view->state, law, residual);
    }
    return view->scheme->family == &gm_family_preissmann &&
           gm_dispersive_laws(view->problem, view->scheme, view->dt, view->state, law, residual);
}

static double largest(const struct gm_view *view, enum gm_local_law law)
{
    const size_t points = view->problem->line.points;
    double *residual = malloc(points * sizeof *residual), most = NAN;
    if (residual && residuals(view, law, residual)) {
        most = 0;
        for (size_t i = 0; i < points; i++) {
            most = fmax(most, fabs(residual[i]));
        }
    }
    free(residual);
    return most;
}

double gm_view_energy_residual(const struct gm_view *view)
{
    return largest(view, GM_LAW_OF_ENERGY);
}

double gm_view_momentum_residual(const struct gm_view *view)
{
    return largest(view, GM_LAW_OF_MOMENTUM);
}

double gm_view_content_residual(const struct gm_view *view)
{
    return largest(view, GM_LAW_OF_CONTENT);
}

void gm_surface_record_shown(const struct gm_view *view, int show,
                             double (*value)(const struct gm_view *, size_t), double *entry)
{
    if (show == GM_SHOW_FIELD) {
        gm_surface_record(view, value, entry);
        return;
    }
    const size_t seen = gm_grid1_seen(&view->problem->line), columns = gm_surface_width(view);
    double *residual = malloc(view->problem->line.points * sizeof *residual);
    const bool known = residual && residuals(view, (enum gm_local_law)(show - 1), residual);
    for (size_t k = 0; k < columns; k++) {
        entry[k] = known ? residual[k * seen / columns] : NAN;
    }
    free(residual);
}

/* Between walls half of the ring counts: its other half is the mirror image. */
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

/* The scale is 1: the momentum of a breather is 0, of a sine-Gordon kink its mass 8 times its velocity. */
double gm_unit_momentum(const struct gm_view *view)
{
    return (void)view, 1;
}

const char *const gm_wave_schemes[] = {
    "leapfrog",   "energy-conserving", "box",          "euler-box",        "midpoint-box",
    "gauss-box3", "lobatto-box2",      "lobatto-box4", "lobatto-nystrom4", NULL};
