/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_BENCH_ODE_BY_HAND_H
#define GM_TESTS_BENCH_ODE_BY_HAND_H

#include <stdbool.h>
#include <stddef.h>

/* Yardsticks: one scheme on one problem, written by hand or with Boost's odeint. The state changes in
   place. */

#define GM_HAND_STRENGTH 2.0

#ifdef __cplusplus
extern "C" {
#endif

void gm_hand_kepler_verlet(double *y, double h, long steps);
void gm_hand_kepler_rk4(double *y, double h, long steps);
void gm_hand_vortices_rk4(double *y, double h, long steps);
/* in registers of four */
void gm_hand_vortices_rk4_simd(double *y, double h, long steps);
/* The evaluations of all steps. `alike`: every step begins from nothing and ends as the program's does; otherwise it
   begins from the increments of the last one and ends at 1e-16. */
long gm_hand_vortices_midpoint_simd(double *y, double h, long steps, bool alike);
void gm_hand_ensemble_kepler_verlet(double *y, size_t m, double h, long steps);
void gm_hand_ensemble_oscillator_verlet(double *y, size_t m, double h, long steps);
void gm_hand_ensemble_oscillator_rk4(double *y, size_t m, double h, long steps);

/* Velocities of `count` vortices of strength 2 pi, x of all then y of all: each pair once. */
void gm_hand_pair_sum(const double *state, double *f, size_t count);

void gm_boost_kepler_verlet(double *y, double h, long steps);
void gm_boost_kepler_rk4(double *y, double h, long steps);
void gm_boost_vortices_rk4(double *y, double h, long steps);
/* to the time `until`, by steps that are chosen */
void gm_boost_kepler_rkf78(double *y, double until, double tolerance);

#ifdef __cplusplus
}
#endif

#endif
