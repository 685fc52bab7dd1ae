/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_GRID_CERTIFIED_LANE_H
#define GM_APP_GRID_CERTIFIED_LANE_H

#include "core/certify.h"
#include "scenes/common/lane.h"

/* Certifies the lane's scheme on its system, of the first member; false with a sentence (GM_MESSAGE
   bytes). */
bool gm_certify_lane(const struct gm_lane *lane, struct gm_certificate *certificate, char *message);

/* The same of the one lane that words ask for: a scheme, a scene or a system, and `count` of key=value. What
   the certificate names lives as long as the program. False with a sentence and an exit status. */
bool gm_certify_words(const char *scheme, const char *system, int count, const char *const words[],
                      struct gm_certificate *certificate, int *status, char *message);

#endif
