/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_CERTIFY_H
#define GM_CORE_FLOW_CERTIFY_H

#include "core/certify.h"

/* Measures a scheme for flows on complexes: fills the certificate's order and claims. */
void gm_certify_flow(const struct gm_scheme *scheme, struct gm_certificate *certificate);

#endif
