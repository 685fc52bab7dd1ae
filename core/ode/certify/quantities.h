/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_CERTIFY_QUANTITIES_H
#define GM_CORE_ODE_CERTIFY_QUANTITIES_H

#include "core/quantity.h"

/* The components of a system by their names (struct gm_ode), and its tracers. */
size_t gm_ode_quantities(const struct gm_run *run, struct gm_quantity *quantities);

#endif
