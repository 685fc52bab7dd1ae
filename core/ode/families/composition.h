/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_COMPOSITION_H
#define GM_CORE_ODE_FAMILIES_COMPOSITION_H

#include "core/scheme.h"

/* The coefficients of a composition: in each step these schemes make steps of these fractions of h, one after
   the other. They have no memory between steps, and a given step size. */
struct gm_substeps {
    int count;
    struct gm_substep {
        const struct gm_scheme *scheme;
        double fraction;
    } at[];
};

/* Returns true if a scheme may be a part of a composition. */
bool gm_scheme_composes(const struct gm_scheme *scheme);
bool gm_scheme_is_composition(const struct gm_scheme *scheme);
/* Returns the number of the loop over kernels that a scheme's steps, or those of its base, call, or GM_OVER_ALL if the
   parts of a composition call several. */
int gm_scheme_over_kernels(const struct gm_scheme *scheme);

/* The family of compositions whose schemes all advance a passive block. */
extern const struct gm_family gm_family_composition_carrying;

#endif
