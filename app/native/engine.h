/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_NATIVE_ENGINE_H
#define GM_APP_NATIVE_ENGINE_H

#include "scenes/common/lane.h"

/* The engine that advances user-defined systems. The interpreter does so at once, everywhere. Native loops
   are compiled from the same formulas by the system's C compiler, once for a system and a family of
   schemes, and cached; a lane takes them between two steps, after a block of steps has agreed bit by bit. */

/* The order is that of the option --engine. */
enum gm_engine { GM_ENGINE_AUTO, GM_ENGINE_INTERPRETED, GM_ENGINE_NATIVE };

/* Chooses for the whole program, before lanes are opened. The library never calls this: its lanes take the loops that
   the build compiled, and no compiler is started. `kernels`: the folder with core/ode and the sources of loops; it is
   copied. The callback, unless NULL, gets one sentence per reason for which the interpreter stays although native was
   requested. `interrupted` returns true to wait no longer for a compiler. */
void gm_engine_choose(enum gm_engine engine, const char *kernels, void (*tell)(const char *sentence),
                      bool (*interrupted)(void));

/* A lane that was just opened takes the loops that the build compiled; if native was requested, its loops are compiled. */
void gm_engine_meet(struct gm_lane *lane);

/* Considers the loops of a lane between two steps, for the automatic engine. The lane took `spent` seconds
   since the last call, and may take `left` more. If all lanes together take longer than compiling,
   compiles in parallel, and takes the loops when they are ready. */
void gm_engine_look(struct gm_lane *lane, double spent, double left);

/* "native" or "interpreted"; NULL if the lane's problem is built in. */
const char *gm_engine_of(const struct gm_lane *lane);

#endif
