/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_DISPERSIVE_FORM_H
#define GM_CORE_FIELD_FAMILIES_DISPERSIVE_FORM_H

#include "core/field/field.h"

/* gm_family.form of the box for equations of first order in time. */
double gm_dispersive_form(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                          const double *y, bool by_differences);

#endif
