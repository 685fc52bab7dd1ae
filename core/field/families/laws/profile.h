/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_LAWS_PROFILE_H
#define GM_CORE_FIELD_FAMILIES_LAWS_PROFILE_H

#include "core/field/field.h"

/* A field on a ring as a scheme has it, for integrals of it: `points` values and then as many slopes. Of cells
   means and differences; of modes of Fourier what their polynomial is at the nodes; of nodes these, and the
   differences between them. malloc'ed, NULL if memory is short. */
double *gm_field_profile(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *u);

#endif
