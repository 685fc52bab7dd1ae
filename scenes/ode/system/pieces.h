/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the scene of somebody's system is put together with: the lines of its file, texts and tapes of its own,
   values at the start. */
#ifndef GM_SCENES_ODE_SYSTEM_PIECES_H
#define GM_SCENES_ODE_SYSTEM_PIECES_H

#include "scenes/ode/system/look.h"

/* How many items a word made. */
size_t gm_system_count_items(const struct gm_user_system *system, enum gm_system_word word);

/* Values of all variables at the start, of those rows that are `given`, or of all rows: NULL. malloc'ed; NULL:
   out of memory. */
double *gm_system_start_values(const struct gm_system_lane *lane, const char *given);

/* A text that lives as long as the scene; NULL: out of memory. */
__attribute__((format(printf, 2, 3))) const char *gm_system_kept_text(struct gm_system_scene *system_scene,
                                                                      const char *format, ...);

/* A tape whose inputs are all variables, so that lanes with different parameters share it. False: out of
   memory. */
bool gm_system_open_tape(struct gm_system_scene *system_scene, struct gm_tape *tape, const gm_node_id *nodes,
                         size_t count);

#endif
