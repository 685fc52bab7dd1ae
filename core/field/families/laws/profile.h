/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_LAWS_PROFILE_H
#define GM_CORE_FIELD_FAMILIES_LAWS_PROFILE_H

#include "core/field/field.h"

/* A field on a ring as a scheme represents it, for integrals: `points` values, then `points` slopes. For
   cells, means and differences; for Fourier modes, their polynomial at the nodes; for nodes, the values
   and their differences. The caller frees it; NULL when out of memory. */
double *gm_field_profile(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *u);

#endif
