/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_SCHEMES_H
#define GM_CORE_SCHEMES_H

#include "core/kind.h"

/* All schemes of all kinds, in the order of core/kinds.def and of each kind's list of families. */

size_t gm_scheme_count(void);
const struct gm_scheme *gm_scheme_at(size_t index);
/* The scheme with that name or word, else with that alias or with the name in another letter case, or NULL; the
   last of several user-defined schemes with one name. */
const struct gm_scheme *gm_scheme_find(const char *name);
/* The row of that name that fits the problem, if one name has rows for several facets, else the fitting scheme
   with that alias; without one, a scheme that does not fit; NULL without a scheme of that name. */
const struct gm_scheme *gm_scheme_find_for(const char *name, const struct gm_problem *problem);

/* The scheme of another name that makes the same steps on this problem; NULL: not known. */
const struct gm_scheme *gm_scheme_same_as(const struct gm_scheme *scheme, const struct gm_problem *problem);

/* The name of the scheme that an unknown word probably means, among these (NULL: among all of the program): a row of
   aliases.def, else the nearest name, else a name, title or alias that contains the word; or NULL. */
const char *gm_scheme_near(const char *word, const struct gm_scheme *const *among, size_t count);

/* Adds a user-defined scheme, which is then found by its name or its word. It must never be freed. Returns
   false when out of memory. */
bool gm_scheme_bring(const struct gm_scheme *scheme);
/* The word for a scheme that can replace a name, even before the scheme is added. */
const char *gm_scheme_word(const struct gm_scheme *scheme);

#endif
