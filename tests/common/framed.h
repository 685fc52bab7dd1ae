/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_FRAMED_H
#define GM_TESTS_COMMON_FRAMED_H

#include "core/field/problems/problems.h"
#include "core/field/user/equation.h"

/* Exact solutions of the heat equation and of Burgers' equation from frames of reference, and the problems of the built-in files
   with the same values. */

/* All are made of kernels K(x, s) = exp(-x^2/(4 nu s)) / sqrt(s), whose age s is t + `age`. */
enum heat_start {
    HEAT_KERNEL, /* K(x, s) sqrt(age): of the height 1 at t = 0 */
    HEAT_TWO,    /* a kernel at -1.5, and one at 1.5 of the height 0.6 and three times the age */
    HEAT_FRONT,  /* 0.1 + 0.45 erfc(x / sqrt(4 nu s)): from 1 down to a tenth */
};
struct heat_solution {
    int start, frame; /* enum gm_frame_nodes */
    double diffusivity, lambda, age;
};

enum burgers_test {
    BURGERS_FRONT, /* -sinh(x/2nu) / (cosh(x/2nu) + exp(-t/4nu)), from t = 0 */
    BURGERS_SHOCK, /* (x - tanh(x / (2 nu t))) / t, from t = 1 */
};
struct burgers_solution {
    int test, frame, printed; /* enum gm_frame_nodes */
    double viscosity, lambda, a, d;
};

/* The value at time t, in the new frame, at the node that was at x at the start and rests there (fixed) or moves. */
double heat_exact(const struct heat_solution *solution, bool fixed, double x, double t);
double burgers_exact(const struct burgers_solution *solution, bool fixed, double x, double t);
double burgers_begin(const struct burgers_solution *solution);

struct framed {
    struct gm_user_system system;
    struct gm_user_equation equation;
    struct gm_problem problem;
};
void heat_open(struct framed *framed, const struct heat_solution *solution, struct gm_grid1 line);
void burgers_open(struct framed *framed, const struct burgers_solution *solution, struct gm_grid1 line);
void framed_close(struct framed *framed);

#endif
