/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_CERTIFY_CERTIFY_H
#define GM_CORE_ODE_CERTIFY_CERTIFY_H

#include "core/certify.h"

/* Measures the order of a scheme against GSL, and the defects of its steps and short runs. */
void gm_certify_ode(const struct gm_scheme *scheme, struct gm_certificate *certificate);

#endif
