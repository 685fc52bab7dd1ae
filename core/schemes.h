/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_SCHEMES_H
#define GM_CORE_SCHEMES_H

#include "core/kind.h"

/* All schemes of all kinds, in the order of core/kinds.def and of each kind's list of families. */

size_t gm_scheme_count(void);
const struct gm_scheme *gm_scheme_at(size_t index);
/* NULL if there is no scheme of that name */
const struct gm_scheme *gm_scheme_find(const char *name);
/* The row of that name that fits the problem, where one name has rows for several facets; a row that does not
   fit if there is none that does; NULL if there is no scheme of that name. */
const struct gm_scheme *gm_scheme_find_for(const char *name, const struct gm_problem *problem);

#endif
