/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_OBSERVABLES_H
#define GM_SCENES_FLOW_OBSERVABLES_H

#include "scenes/flow/room_scene.h"

/* An observable of flows by its key, or of a profile that its subject numbers; NULL: there is none of that key. */
const struct gm_observable *gm_room_observable(const char *key, bool along);
/* What is exact at a place; NAN: it is not known. */
double gm_room_exact(const struct gm_view *view, enum gm_room_key key, const double at[2]);

/* u, v or s, the scalar, and its key. */
static inline double gm_room_quantity(const struct gm_sample *sample, char quantity)
{
    return quantity == 'u' ? sample->u : quantity == 'v' ? sample->v : sample->theta;
}
static inline enum gm_room_key gm_room_key_of(char quantity)
{
    return quantity == 'u' ? GM_ROOM_SPEED_X : quantity == 'v' ? GM_ROOM_SPEED_Y : GM_ROOM_SCALAR;
}

#endif
