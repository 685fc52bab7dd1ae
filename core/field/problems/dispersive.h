/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equations of first order in time, Korteweg-de Vries and the nonlinear Schroedinger equation: parameters,
   exact solutions, invariants. */
#ifndef GM_CORE_FIELD_PROBLEMS_DISPERSIVE_H
#define GM_CORE_FIELD_PROBLEMS_DISPERSIVE_H

#include "core/field/field.h"
#include "core/field/problems/moving_frames.h"

/* Korteweg-de Vries, u_t + eta u u_x + mu u_xxx = 0, with the state of a wave problem, and its frames of
   reference,
       (t, x, u) -> (t, x + lambda t, u + lambda/eta) */
enum gm_kdv_initial {
    /* u = 3 c/eta sech^2(sqrt(c/mu)/2 (x - x0 - c t)) */
    GM_KDV_SOLITON,
    /* u = 12 mu/eta (ln F)_xx,   F = 1 + e1 + e2 + ((k1 - k2)/(k1 + k2))^2 e1 e2,
       ei = exp(ki (x - xi) - mu ki^3 t),   k = 1.2, .8,   x1 = -30, x2 = -15;
       on the ring they meet again and again */
    GM_KDV_TWO,
    /* u = cos(pi x) at t = 0 (Zabusky & Kruskal 1965); no exact solution */
    GM_KDV_COSINE,
};
struct gm_kdv {
    int initial;
    double eta, mu, velocity, position;
    double lambda;
    int frame; /* enum gm_frame_nodes */
};
static inline const struct gm_kdv *gm_kdv_of(const struct gm_problem *problem)
{
    return problem->parameters;
}
/* At the place x of the frame, NaN for the cosine at t > 0; the formulas above are those for lambda = 0. */
double gm_kdv_exact(const struct gm_kdv *kdv, const struct gm_grid1 *grid, double x, double t);
/* Returns true if gm_kdv_exact solves the equation on the ring too, up to tails of a thousandth of a
   soliton's height. */
bool gm_kdv_is_known(const struct gm_kdv *kdv, const struct gm_grid1 *grid, double t);
/* The levels 0 and dt on nodes at rest in the frame, and dt; for the cosine the second is an Euler step with
   exact derivatives. */
void gm_kdv_levels(const struct gm_problem *problem, double dt, double *y);

/* Integrals in the original frame:  dx sum u;  dx sum v^2;  dx sum [mu s^2 / 2 - eta v^3 / 6], with the
   values v and then the slopes s of a profile (gm_field_profile). */
double gm_kdv_mass(const struct gm_problem *problem, const double *y);
double gm_kdv_square(const struct gm_problem *problem, const double *profile);
double gm_kdv_energy(const struct gm_problem *problem, const double *profile);

/* Nonlinear Schroedinger, i psi_t + psi_xx + |psi|^2 psi = 0; the state is Re psi, then Im psi. */
enum gm_nls_initial {
    GM_NLS_SOLITON,   /* sqrt(2) a sech(a (x - x0 - c t)) exp i[c (x - x0)/2 + (a^2 - c^2/4) t] */
    GM_NLS_COLLISION, /* one from x0 with c and one from -x0 with -c; no exact solution */
};
struct gm_nls {
    int initial;
    double amplitude, velocity, position;
};
static inline const struct gm_nls *gm_nls_of(const struct gm_problem *problem)
{
    return problem->parameters;
}
/* NaN for a collision at t > 0. */
void gm_nls_exact(const struct gm_nls *nls, const struct gm_grid1 *grid, double x, double t, double *re,
                  double *im);
/* Returns true if the exact solution holds on the ring too, up to tails of a thousandth of the amplitude. */
bool gm_nls_is_known(const struct gm_nls *nls, const struct gm_grid1 *grid, double t);

/* dx sum |A psi|^2;  dx sum [|s|^2 - |v|^4 / 2], of the profiles of both parts;  dx sum |psi|^2 */
double gm_nls_charge(const struct gm_problem *problem, const double *y);
double gm_nls_energy(const struct gm_problem *problem, const double *re, const double *im);
double gm_nls_node_charge(const struct gm_problem *problem, const double *y);

/* The caller sets line, n (kdv: gm_wave_size, nls: 2 points) and parameters (struct gm_kdv or gm_nls). */
extern const struct gm_problem gm_problem_kdv, gm_problem_nls;

#endif
