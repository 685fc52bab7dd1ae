/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_OBSERVABLES_H
#define GM_SCENES_FLOW_OBSERVABLES_H

#include "scenes/flow/room_scene.h"

/* Returns the observable of flows with this key, or of a profile if `along`; NULL if the key is unknown. */
const struct gm_observable *gm_room_observable(const char *key, bool along);
/* Returns the exact value at a point; NAN if it is not known. */
double gm_room_exact(const struct gm_view *view, enum gm_room_key key, const double at[2]);

/* The value and the key of a quantity: u, v or s (the scalar). */
static inline double gm_room_quantity(const struct gm_sample *sample, char quantity)
{
    return quantity == 'u' ? sample->u : quantity == 'v' ? sample->v : sample->theta;
}
static inline enum gm_room_key gm_room_key_of(char quantity)
{
    return quantity == 'u' ? GM_ROOM_SPEED_X : quantity == 'v' ? GM_ROOM_SPEED_Y : GM_ROOM_SCALAR;
}

#endif
