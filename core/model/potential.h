/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Waves in a potential that somebody wrote, on whatever nodes. */
#ifndef GM_CORE_MODEL_POTENTIAL_H
#define GM_CORE_MODEL_POTENTIAL_H

#include "core/model/system.h"

/* u and its derivatives over t at the start, as far as levels are made of them; derivatives of V */
enum { GM_TYPED_START = 5, GM_TYPED_DERIVATIVES = 3 };

/* A field's formulas, of its system's graph. */
struct gm_user_wave {
    const struct gm_user_system *system;
    gm_node_id by_u[GM_TYPED_DERIVATIVES]; /* V', V'', V''' */
    double degree;                         /* of V' in u; INFINITY: it is written as no polynomial */
    /* in x, which is variable 0 there, and of the exact solution t, variable 1; GM_NO_NODE: it is not told */
    gm_node_id start[GM_TYPED_START], start_slope /* u_x */, exact;
};

/* Derives them; false where memory was refused. The graph grows. */
bool gm_user_wave_derive(struct gm_user_wave *wave, struct gm_user_system *system);

#endif
