/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_NATIVE_ENGINE_H
#define GM_APP_NATIVE_ENGINE_H

#include "scenes/common/lane.h"

/* Which engine advances the systems that somebody wrote. The interpreter does at once, everywhere. Native
   loops are compiled of the same formulas by the system's C compiler, once for a system and a family of
   schemes, and kept in a cache; a lane takes them between two steps, after a block of steps has come out the
   same bit by bit. */

enum gm_engine { GM_ENGINE_AUTO, GM_ENGINE_INTERPRETED, GM_ENGINE_NATIVE };

/* By its word; false: there is none. */
bool gm_engine_named(const char *word, enum gm_engine *engine);

/* Chooses for the whole program, before lanes are opened. `kernels` is the folder that holds core/ode with
   the sources of loops; it is copied. `tell` hears, once for each reason, why the interpreter goes on where
   native was asked for; it may be NULL. `interrupted` says whether to wait no longer for a compiler. */
void gm_engine_choose(enum gm_engine engine, const char *kernels, void (*tell)(const char *sentence),
                      bool (*interrupted)(void));

/* Of a lane that was just opened: where native was asked for, its loops are compiled and taken here. */
void gm_engine_meet(struct gm_lane *lane);

/* Where the engine is chosen by itself: asked between two steps of a lane that took `spent` seconds since it
   was asked last, and may take `left` more. Where all lanes together take longer than compiling does,
   compiles beside, and takes the loops when they are there. */
void gm_engine_look(struct gm_lane *lane, double spent, double left);

/* "native" or "interpreted"; NULL where the lane's problem is built in. */
const char *gm_engine_of(const struct gm_lane *lane);

/* Ends what still compiles. */
void gm_engine_stop(void);

#endif
