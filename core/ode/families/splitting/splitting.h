/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row of a splitting method, which its loop over kernels reads at run time. The build merges the neighbouring kicks
   of compositions of Verlet's method. */
#ifndef GM_CORE_ODE_FAMILIES_SPLITTING_SPLITTING_H
#define GM_CORE_ODE_FAMILIES_SPLITTING_SPLITTING_H

#include <stdbool.h>

struct gm_problem;

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

/* Returns true if the system itself gives a part of that name. */
bool gm_part_is_given(const struct gm_problem *problem, const char *name);

#endif
