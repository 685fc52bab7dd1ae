/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The modified Hamiltonian H~ = H + dt H_1 + dt^2 H_2 + ... that a symplectic scheme solves all but exactly,
   in a state: backward error analysis. docs/theory.md describes the computation. */
#ifndef GM_CORE_ODE_BACKWARD_MODIFIED_ENERGY_H
#define GM_CORE_ODE_BACKWARD_MODIFIED_ENERGY_H

#include "core/scheme.h"

enum {
    GM_MODIFIED_POWER = 6, /* the highest computed power of dt */
    GM_MODIFIED_WHY = 192, /* size of a reason, in bytes */
};

/* A problem with its constants, and a scheme that fits it. Not to be shared between threads. */
struct gm_modified_energy;

/* Computes the terms up to dt^power, power <= GM_MODIFIED_POWER. Returns NULL with the reason if the scheme
   is not symplectic or not made of coefficients, if H is not a formula or not smooth, or when out of memory.
   Neither the problem nor the scheme has to outlive it. */
struct gm_modified_energy *gm_modified_energy_open(const struct gm_problem *problem,
                                                   const struct gm_scheme *scheme, int power,
                                                   char why[GM_MODIFIED_WHY]);
void gm_modified_energy_close(struct gm_modified_energy *energy);

/* Writes terms[k] = H_k in the state y of one member, k = 0 .. power; NaN when out of memory, which is noted
   (core/memory.h). */
void gm_modified_energy_terms(struct gm_modified_energy *energy, const double *y, double *terms);

#endif
