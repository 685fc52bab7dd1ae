/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_BALL_H
#define GM_CORE_THEORY_BALL_H

#include <mpfr.h>
#include <stdbool.h>

/* A number that is known within a bound, |x - midpoint| <= radius: exact order conditions are decided with
   these. The midpoint has 256 bits (77 digits); results are rounded, and their bound says by how much. A plain
   value: nothing is allocated, nothing is freed. */
struct gm_ball {
    mp_limb_t limbs[256 / (8 * sizeof(mp_limb_t))];
    mpfr_exp_t exponent;
    int kind; /* of MPFR: zero, regular ..., with the sign */
    double radius;
};

/* Exactly `value`; p / q, rounded (q is not 0). */
struct gm_ball gm_ball_of(double value);
struct gm_ball gm_ball_ratio(long p, long q);
/* A coefficient that a table writes as a decimal: exact where the double is a short dyadic fraction (26 bits:
   1/2, 3/4, -1), else within half a unit of its 15th significant digit. */
struct gm_ball gm_ball_written(double value);

struct gm_ball gm_ball_add(struct gm_ball a, struct gm_ball b);
struct gm_ball gm_ball_subtract(struct gm_ball a, struct gm_ball b);
struct gm_ball gm_ball_multiply(struct gm_ball a, struct gm_ball b);

/* Whether it may be 0. */
bool gm_ball_may_vanish(struct gm_ball a);
/* The midpoint as a double, and the sign of the ball: 0 where it may vanish. */
double gm_ball_midpoint(struct gm_ball a);
int gm_ball_sign(struct gm_ball a);

#endif
