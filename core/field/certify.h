/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_CERTIFY_H
#define GM_CORE_FIELD_CERTIFY_H

#include "core/certify.h"

/* Measures the claims of a scheme for fields on a line, on every equation that it fits: order against exact
   solutions (Burgers: in time, by itself), the multisymplectic law, energy, mass and charge, return after a
   reversed step, equivariance under boosts and projections. */
void gm_certify_field(const struct gm_scheme *scheme, struct gm_certificate *certificate);

#endif
