/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_CERTIFY_FIELD_H
#define GM_CORE_CERTIFY_FIELD_H

#include "core/certify.h"

/* Measures the claims of a scheme for fields on a line, on every equation that it fits: order against exact
   solutions (Burgers: in time, by itself), the multisymplectic law, energy, mass and charge, return after a
   reversed step, equivariance under boosts and projections. *farthest: how far a measured order has been from
   the claimed one. */
void gm_certify_field(struct gm_certificate *certificate, double *farthest);

#endif
