/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_KDV_SOLUTIONS_H
#define GM_TESTS_COMMON_KDV_SOLUTIONS_H

#include "core/field/problems/problems.h"

/* Starts of Korteweg and de Vries' equation, with exact solutions but for the cosine. */
enum kdv_initial {
    /* u = 3 c/eta sech^2(sqrt(c/mu)/2 (x - x0 - c t)) */
    KDV_SOLITON,
    /* u = 12 mu/eta (ln F)_xx,   F = 1 + e1 + e2 + ((k1 - k2)/(k1 + k2))^2 e1 e2,
       ei = exp(ki (x - xi) - mu ki^3 t),   k = 1.2, .8,   x1 = -30, x2 = -15;
       on the ring they meet again and again */
    KDV_TWO,
    /* u = cos(pi x) at t = 0 (Zabusky & Kruskal 1965); no exact solution */
    KDV_COSINE,
};
struct kdv_solution {
    struct gm_kdv kdv; /* first, so that a problem's parameters may be a solution */
    int initial;
    double velocity, position;
};

/* At the place x of the frame, NaN for the cosine at t > 0; the formulas above are those for lambda = 0. */
double kdv_exact(const struct kdv_solution *solution, const struct gm_grid1 *grid, double x, double t);
/* Returns true if kdv_exact solves the equation on the ring too, up to tails of a thousandth of a soliton's
   height. */
bool kdv_is_known(const struct kdv_solution *solution, const struct gm_grid1 *grid, double t);
/* The levels 0 and dt on nodes at rest in the frame, and dt; for the cosine the second is an Euler step with
   exact derivatives. The problem's parameters are a solution. */
void kdv_levels(const struct gm_problem *problem, double dt, double *y);

/* Integrals in the original frame:  dx sum u;  dx sum v^2 with the values of a profile (gm_field_profile). */
double kdv_mass(const struct gm_problem *problem, const double *y);
double kdv_square(const struct gm_problem *problem, const double *profile);

#endif
