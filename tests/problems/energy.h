/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_PROBLEMS_ENERGY_H
#define GM_TESTS_PROBLEMS_ENERGY_H

#include "core/ode/ode.h"

/* Declares the functions that tests/problems/over_energy.c makes of the H in a problem's file:
   gm_energy_NAME, gm_formula_NAME if the file has no parameters, and, for H = p^2/2 + V(q) with one q,
   gm_potential_NAME. */
#define GM_ENERGY_DECLARE(name) GM_ENERGY_DECLARE_(name)
#define GM_ENERGY_DECLARE_(name)                                                                             \
    void gm_energy_##name(const struct gm_problem *problem, const double *y, double *energy, size_t m);      \
    bool gm_formula_##name(const struct gm_problem *problem, struct gm_formula *graph, gm_node_id *energy);  \
    void gm_potential_##name(const struct gm_problem *problem, double q, double values[3]);

#endif
