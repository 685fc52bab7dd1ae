/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Room for the coefficients of a method. */
#include "core/theory/coefficients.h"

#include <stdlib.h>

bool gm_coefficients_open(struct gm_coefficients *coefficients, enum gm_equations equations, int stages)
{
    const size_t s = (size_t)stages;
    *coefficients = (struct gm_coefficients){.equations = equations, .stages = stages, .evaluations = stages};
    bool good = true;
    for (int side = 0; side < gm_coefficients_sides(coefficients); side++) {
        struct gm_ball *room = malloc((s * s + s) * sizeof *room);
        coefficients->a[side] = room;
        coefficients->b[side] = room ? room + s * s : NULL;
        good = good && room;
        for (size_t i = 0; room && i < s * s + s; i++) {
            room[i] = gm_ball_of(0);
        }
    }
    if (!good) {
        gm_coefficients_close(coefficients);
    }
    return good;
}

void gm_coefficients_close(struct gm_coefficients *coefficients)
{
    for (int side = 0; side < GM_SIDES; side++) {
        free(coefficients->a[side]);
        coefficients->a[side] = coefficients->b[side] = NULL;
    }
}
