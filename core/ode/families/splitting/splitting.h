/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row of a splitting method, which its loop over kernels reads at run time. */
#ifndef GM_CORE_ODE_FAMILIES_SPLITTING_SPLITTING_H
#define GM_CORE_ODE_FAMILIES_SPLITTING_SPLITTING_H

#include <stddef.h>

#include "core/ode/families/compositions.h"

enum { GM_SPLITTING_PIECES = 255 };

enum gm_piece { GM_DRIFT, GM_KICK };

/* Exact flows: the pieces in the order in which they act, each with its fraction of h. */
struct gm_splitting {
    int count;
    struct {
        enum gm_piece piece;
        double fraction;
    } pieces[GM_SPLITTING_PIECES];
};

/* Kick, drift, kick: fractions of h. */
struct gm_three {
    double first, drift, last;
};

/* A row of the family: pieces, or a composition of Verlet's method (kick, drift, kick) with neighbouring
   kicks merged. */
struct gm_splitting_row {
    struct gm_splitting splitting;
    const struct gm_composition *of_verlet; /* NULL: the splitting */
};

/* Returns the pieces of a row; a composition's pieces are written to `made`. */
static inline const struct gm_splitting *gm_splitting_of(const struct gm_splitting_row *row,
                                                         struct gm_splitting *made)
{
    if (!row->of_verlet) {
        return &row->splitting;
    }
    const int steps = row->of_verlet->steps;
    double before = 0;
    for (int i = 0; i < steps; i++) {
        const double fraction = gm_composition_fraction(row->of_verlet, i);
        made->pieces[2 * i].piece = GM_KICK;
        made->pieces[2 * i].fraction = (before + fraction) / 2;
        made->pieces[2 * i + 1].piece = GM_DRIFT;
        made->pieces[2 * i + 1].fraction = before = fraction;
    }
    made->pieces[2 * steps].piece = GM_KICK;
    made->pieces[2 * steps].fraction = before / 2;
    made->count = 2 * steps + 1;
    return made;
}

#endif
