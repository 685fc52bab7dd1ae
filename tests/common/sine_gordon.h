/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_SINE_GORDON_H
#define GM_TESTS_COMMON_SINE_GORDON_H

#include "core/problem.h"

/* Exact solutions of u_tt - u_xx + sin u = 0 on the line, and on a ring as long as their tails are small. */

enum gm_sine_gordon_initial {
    GM_BREATHER,       /* 4 atan [g sin(w t) / (w cosh(g x))], g = sqrt(1 - w^2) */
    GM_KINK,           /* 4 atan exp[g (x - x0 - c t)], g = 1 / sqrt(1 - c^2) */
    GM_ANTIKINK,       /* 4 atan exp[-g (x - x0 - c t)] */
    GM_KINK_ANTIKINK,  /* 4 atan [sinh(c g t) / (c cosh(g x))]: they leave x = 0 at t = 0 */
    GM_KINK_COLLISION, /* the same from t = -|x0| / c on: an antikink and a kink meet, and part */
};

struct gm_sine_gordon {
    int initial;
    double frequency; /* w of the breather, 0 < w < 1 */
    double velocity;  /* c, |c| < 1 */
    double position;  /* x0 */
};

/* u(x, t) on the ring x in [-half_length, half_length): a travelling kink comes back 2 pi higher, and two
   that separate meet again on the other side. */
double gm_sine_gordon_exact(const struct gm_sine_gordon *solution, double half_length, double x, double t);

/* Returns true if gm_sine_gordon_exact solves the equation on the ring, up to tails of a thousandth of the
   height, and if images change the velocity of two kinks by at most one part in 10^4. */
bool gm_sine_gordon_is_known(const struct gm_sine_gordon *solution, double half_length, double t);

/* u(x + 2 half_length) - u(x) */
double gm_sine_gordon_jump(const struct gm_sine_gordon *solution);

/* Writes the levels t and t + gap and the gap as the state of a wave problem, whose parameters are a solution. */
void gm_sine_gordon_levels(const struct gm_problem *problem, double t, double gap, double *y);

#endif
