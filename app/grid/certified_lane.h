/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_GRID_CERTIFIED_LANE_H
#define GM_APP_GRID_CERTIFIED_LANE_H

#include "app/base/arguments.h"
#include "core/theory/certify.h"

/* Certifies a scheme, the first of the typed words, on a scene or a system with the others, key=value, from the
   start of the first member. Called in a body of the arena, which closes what the certificate points to; leaves it
   with a sentence and an exit status. */
struct gm_certificate gm_certify_words(struct gm_arena *arena, const char *system,
                                       const struct gm_arguments *typed, int *status);

#endif
