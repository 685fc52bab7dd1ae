/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_CERTIFY_QUANTITIES_H
#define GM_CORE_FIELD_CERTIFY_QUANTITIES_H

#include "core/quantity.h"

/* The field at the nodes of `grid`, and what else a state holds: u; the level of another time, u_other,
   and that time less the current one, other_time; of a complex field its parts psi_re and psi_im; of
   Burgers' equation in a moving frame the nodes' places x, and the companion u_companion. */
size_t gm_field_quantities(const struct gm_run *run, struct gm_quantity *quantities);

#endif
