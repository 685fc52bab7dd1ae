/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The three levels that the laws of a wave problem speak of, where the state holds two: a step is made
   aside. */
#include "core/field/families/waves/levels.h"

#include "core/field/families/two_step.h"

struct gm_levels gm_levels_of(const struct gm_law *law)
{
    const struct gm_two_step_row *row = law->scheme->coefficients;
    const size_t points = law->problem->line.points, size = gm_wave_size(points);
    const bool at_start = law->y[2 * points] != -law->dt, centred = row->law == GM_LAW_CENTRED;
    double *out = gm_arena_take(law->arena, size + 2 * points, sizeof *out), *v = out + size;
    if (!gm_law_step(law, at_start ? 2 : 1, law->y, centred ? law->memory : NULL, out, centred ? v : NULL)) {
        gm_arena_leave(law->arena);
    }
    struct gm_levels levels = {.past = at_start ? law->y : law->y + points, .now = out + points, .next = out};
    if (centred) {
        levels.v_past = at_start ? law->memory : law->memory + points;
        levels.v_now = v + points;
        levels.v_next = v;
    }
    return levels;
}
