/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_SCHEME_JSON_H
#define GM_APP_OUTPUT_SCHEME_JSON_H

#include <stdio.h>

#include "core/theory/certify.h"

/* Schemes and certificates as JSON: an object without a line's end. */

/* The claims that are relevant for a system, claimed or not. */
enum {
    GM_CERTIFIED_ON_SYSTEMS = GM_SYMPLECTIC | GM_SYMMETRIC | GM_REVERSIBLE | GM_KEEPS_ENERGY |
                              GM_KEEPS_LINEAR | GM_KEEPS_QUADRATIC | GM_KEEPS_BILINEAR | GM_KEEPS_VOLUME
};

void gm_scheme_put(FILE *stream, const struct gm_scheme *scheme);

/* On a system, or NULL: on the problems that schemes are certified on. */
void gm_certificate_put(FILE *stream, const struct gm_certificate *certificate, const char *system);

#endif
