/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_STABILITY_H
#define GM_CORE_THEORY_STABILITY_H

#include "core/theory/coefficients.h"

/* The region with |R(z)| <= 1, for the stability function R with y1 = R(h lambda) y0 of y' = lambda y. For
   splittings: the steps on the oscillator whose trace is between -2 and 2. */
struct gm_theory_stability {
    bool known;      /* false for partitioned methods other than splittings */
    bool oscillator; /* a splitting: only `imaginary` is known, the largest omega h */
    double real,
        imaginary; /* stable for real z in [-real, 0] and for z in i [0, imaginary]; INFINITY: for all */
    bool a_stable, l_stable;
};

/* Returns the stability of a method, which is symmetric or not; in an arena's body. */
struct gm_theory_stability gm_theory_stability_of(struct gm_arena *arena,
                                                  const struct gm_coefficients *coefficients, bool symmetric);

#endif
