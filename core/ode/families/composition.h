/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_COMPOSITION_H
#define GM_CORE_ODE_FAMILIES_COMPOSITION_H

#include "core/scheme.h"

/* The coefficients of a composition: in each step these schemes make steps of these fractions of h, one after
   the other. They remember nothing from step to step, and take the step that they are given. */
struct gm_substeps {
    int count;
    struct gm_substep {
        const struct gm_scheme *scheme;
        double fraction;
    } at[];
};

/* Whether a scheme may be a part of one. */
bool gm_scheme_composes(const struct gm_scheme *scheme);

/* The same, of schemes that all know what to do with a passive block. */
extern const struct gm_family gm_family_composition_carrying;

#endif
