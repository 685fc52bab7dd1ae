/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The keys of a system's scene: dt and until, choices, parameters, starts, and what all such scenes have. */
#ifndef GM_SCENES_COMMON_SYSTEM_ROWS_H
#define GM_SCENES_COMMON_SYSTEM_ROWS_H

#include "scenes/common/system/variants.h"

/* Makes the rows: `timing`, which are dt and until, then the system's own, then `count` common ones. If
   `typed`, the values of the system's own have no defaults. */
void gm_system_make_rows(struct gm_system_scene *system_scene, const struct gm_parameter *timing,
                         const struct gm_parameter *common, size_t count, bool typed);
/* Opens the formulas of dt, until and steps, and sets their values, NaN without a line. */
void gm_system_open_timing(struct gm_system_scene *system_scene, double numbers[GM_SYSTEM_TIMES]);

/* Chooses a lane's system, and derives values that were not given from those that were, by the file's
   formulas. False with a sentence. */
bool gm_system_settle(void *parameters, const char *const *keys, size_t count, char *sentence);
/* Returns the scene of a lane's system. */
const struct gm_scene *gm_system_variant(const void *parameters);
/* Returns why a key has no effect in a lane's system; NULL: it has one. */
const char *gm_system_idle(const void *parameters, const char *key);

#endif
