/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The volume of a small cell that moves with a flow in three dimensions. The first member is an orbit; the others surround
   it at two distances and give the derivative of the flow by extrapolated differences. */
#include <math.h>

#include "core/functions/functions.h"
#include "scenes/common/rows.h"
#include "scenes/common/system/hook.h"

enum { DIMENSION = 3, MEMBERS = 1 + 4 * DIMENSION };

/* Half the size of the cell, and its largest extent for which differences approximate derivatives. */
static const double small = 2e-5, drawn_out = 4e-3;

static bool suits(const struct gm_user_system *system)
{
    return system->n == DIMENSION && !system->timed && !gm_system_is_field(system);
}

static void place(double *y)
{
    for (size_t c = 0; c < DIMENSION; c++) {
        for (size_t k = 0; k < 4; k++) {
            y[c * MEMBERS + 1 + 4 * c + k] += small * (const double[]){1, -1, 2, -2}[k];
        }
    }
}

/* Returns ln det of the flow's derivative from the start: the log of the cell's volume ratio. */
static double log_volume(const struct gm_view *view)
{
    double d[DIMENSION][DIMENSION];
    for (size_t r = 0; r < DIMENSION; r++) {
        for (size_t c = 0; c < DIMENSION; c++) {
            const double *row = view->state + r * MEMBERS + 1 + 4 * c;
            if (fabs(row[2] - row[3]) > drawn_out) {
                return NAN;
            }
            d[r][c] = (8 * (row[0] - row[1]) - (row[2] - row[3])) / (12 * small);
        }
    }
    return gm_log(d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                  d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                  d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]));
}

static const struct gm_observable observables[] = {
    GM_LOG_OBSERVABLE("log_volume", log_volume, "ln(volume / initial volume)",
                      .missing = "the cell is drawn out too far for differences to measure"),
};

const struct gm_hook gm_hook_cell = {
    .name = "cell",
    .needs = "three components without the time",
    .suits = suits,
    .members = MEMBERS,
    .place = place,
    .observables = observables,
    .observable_count = GM_COUNT(observables),
};
