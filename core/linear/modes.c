/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fields on a ring, there and back between nodes and waves. */
#include "core/linear/modes.h"

#include <complex.h>

#include "core/linear/fourier.h"

bool gm_modes_open(struct gm_modes *modes, size_t points, size_t fields)
{
    *modes = (struct gm_modes){.points = points, .fields = fields, .fourier = gm_fourier_open(points)};
    return modes->fourier != NULL;
}

void gm_modes_close(struct gm_modes *modes)
{
    gm_fourier_close(modes->fourier);
    modes->fourier = NULL;
}

void gm_modes_forward(const struct gm_modes *modes, const double *y, double complex *waves)
{
    for (size_t i = 0; i < modes->fields * modes->points; i++) {
        waves[i] = y[i];
    }
    for (size_t field = 0; field < modes->fields; field++) {
        gm_fourier_forward(modes->fourier, waves + field * modes->points);
    }
}

void gm_modes_back(const struct gm_modes *modes, double complex *waves, double *y)
{
    const size_t points = modes->points;
    for (size_t field = 0; field < modes->fields; field++) {
        double complex *own = waves + field * points;
        for (size_t k = gm_modes_half(points); k < points; k++) {
            own[k] = conj(own[points - k]);
        }
        gm_fourier_inverse(modes->fourier, own);
        for (size_t i = 0; i < points; i++) {
            y[field * points + i] = creal(own[i]);
        }
    }
}
