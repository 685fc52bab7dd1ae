/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_STABILITY_H
#define GM_CORE_THEORY_STABILITY_H

#include "core/theory/theory.h"

/* What the stability function says of a method that is symmetric, or not; false: out of memory. */
bool gm_theory_stability_of(const struct gm_coefficients *coefficients, bool symmetric,
                            struct gm_theory_stability *stability);

#endif
