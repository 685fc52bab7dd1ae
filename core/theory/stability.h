/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_STABILITY_H
#define GM_CORE_THEORY_STABILITY_H

#include "core/theory/coefficients.h"

/* Where |R(z)| <= 1, for the stability function R with y1 = R(h lambda) y0 of y' = lambda y. Of splittings on
   the oscillator: where the trace of the step lies between -2 and 2. */
struct gm_theory_stability {
    bool known;      /* not of partitioned methods that are no splittings */
    bool oscillator; /* of a splitting: only `imaginary` is known, the largest omega h */
    double real,
        imaginary; /* stable for real z in [-real, 0] and for z in i [0, imaginary]; INFINITY: for all */
    bool a_stable, l_stable;
};

/* What the stability function says of a method that is symmetric, or not; false: out of memory. */
bool gm_theory_stability_of(const struct gm_coefficients *coefficients, bool symmetric,
                            struct gm_theory_stability *stability);

#endif
