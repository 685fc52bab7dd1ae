/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_BENCH_ENSEMBLES_H
#define GM_TESTS_BENCH_ENSEMBLES_H

#include "core/problem.h"

/* Ensembles that are measured, and that no scene has: Kepler's problem and the oscillator. Gives the problem loops
   over registers of members, which are compiled for the measurement alone. */
void gm_bench_ensemble(struct gm_problem *problem);

#endif
