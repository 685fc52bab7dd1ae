/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_GRID_CERTIFIED_LANE_H
#define GM_APP_GRID_CERTIFIED_LANE_H

#include "core/certify.h"

/* Certifies a scheme on a scene or a system with `count` of key=value, from the start of the first member.
   The certificate's names live as long as the program. Returns false with a sentence (GM_MESSAGE bytes)
   and an exit status. */
bool gm_certify_words(const char *scheme, const char *system, int count, const char *const words[],
                      struct gm_certificate *certificate, int *status, char *message);

#endif
