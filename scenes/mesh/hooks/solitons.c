/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solitons on a moving mesh: where the first one is, and how far the energy on the mesh is from that of solitons on the
   whole line, which the file gives as `let: continuum`. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/user/line.h"
#include "scenes/common/system/hook.h"
#include "scenes/common/system/pieces.h"
#include "scenes/mesh/observed.h"

/* Returns the line `let: continuum`; NULL: the file has none. */
static const struct gm_system_item *continuum_of(const struct gm_user_system *system)
{
    return gm_system_item_named(system, GM_WORD_LET, "continuum");
}

static bool suits(const struct gm_user_system *system)
{
    return system->kind == GM_FIELD && continuum_of(system);
}

/* Returns the first place where the field, linear between the nodes, is half the height of a sine-Gordon soliton; NaN
   without one, and of phi^4. */
static double position(const struct gm_view *view)
{
    const struct gm_mesh mesh = gm_mesh_of(view);
    double before = mesh.left - M_PI, x = mesh.first;
    for (size_t k = 0; k <= mesh.points && mesh.potential == &gm_potential_sine_gordon; k++) {
        const bool inner = k < mesh.points;
        const double after = (inner ? view->state[k] : mesh.right) - M_PI,
                     next = inner ? view->state[mesh.points + k] : mesh.first + mesh.length;
        if (before * after <= 0 && before != after) {
            return x + (next - x) * before / (before - after);
        }
        before = after;
        x = next;
    }
    return NAN;
}

static double continuum_error(const struct gm_view *view)
{
    const struct gm_system_lane *lane = view->parameters;
    const struct gm_user_system *system = &lane->owner->system;
    double *values = gm_system_start_values(lane, NULL), continuum = NAN;
    if (values && !gm_user_line_numbers(system, continuum_of(system)->nodes, 1, values, &continuum)) {
        continuum = NAN;
    }
    free(values);
    return fabs(gm_view_mesh_measure(view) - continuum) / continuum;
}

static const struct gm_observable observables[] = {
    GM_OBSERVABLE("position", position, "place of the soliton, u = π", .missing = "the field is nowhere π"),
    GM_LOG_OBSERVABLE("energy_continuum_error", continuum_error, "difference from the solitons' energy"),
};

const struct gm_hook gm_hook_solitons = {
    .name = "solitons",
    .needs = "waves in a potential with their energy in let: continuum",
    .suits = suits,
    .on_moving_mesh = true,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
};
