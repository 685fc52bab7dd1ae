/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_SCHEMES_H
#define GM_CORE_SCHEMES_H

#include "core/kind.h"

/* All schemes of all kinds, in the order of core/kinds.def and of each kind's list of families. */

size_t gm_scheme_count(void);
const struct gm_scheme *gm_scheme_at(size_t index);
/* Of that name, or with that word; NULL if there is none. Of schemes that were brought along under one name
   it is the last. */
const struct gm_scheme *gm_scheme_find(const char *name);
/* The row of that name that fits the problem, where one name has rows for several facets; a row that does not
   fit if there is none that does; NULL if there is no scheme of that name. */
const struct gm_scheme *gm_scheme_find_for(const char *name, const struct gm_problem *problem);

/* The scheme of another name whose steps on this problem are the same ones; NULL: none is known. */
const struct gm_scheme *gm_scheme_same_as(const struct gm_scheme *scheme, const struct gm_problem *problem);

/* The name here of a scheme that others call `word`; NULL if there is none. */
const char *gm_scheme_known_as(const char *word);
/* That, or the name that is nearest to the word; NULL if none is near. */
const char *gm_scheme_near(const char *word);

/* Takes a scheme that was brought along among those that are found by their name, or by their word: it stays
   for good. False: out of memory. */
bool gm_scheme_bring(const struct gm_scheme *scheme);
/* The word that means it wherever a name may stand, also where nobody has brought it along before. */
const char *gm_scheme_word(const struct gm_scheme *scheme);

#endif
