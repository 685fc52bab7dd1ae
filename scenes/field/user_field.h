/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FIELD_USER_FIELD_H
#define GM_SCENES_FIELD_USER_FIELD_H

#include "core/model/system.h"

/* Returns how many of these schemes, separated by blanks or commas, or NULL, need a field `elsewhere` (struct gm_system_origin); *others: the
   number of the rest. */
size_t gm_user_field_elsewhere(const struct gm_user_system *system, const char *schemes, size_t *others);

#endif
