/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ALIASES_H
#define GM_CORE_ALIASES_H

#include <stdbool.h>
#include <stddef.h>

/* Names that people know from elsewhere: the rows of core/aliases.def. */

struct gm_alias {
    const char *typed, *scheme;
};
extern const struct gm_alias gm_aliases[];
extern const size_t gm_alias_count;

/* The name of the scheme with that alias, in any letter case; NULL: the word is not an alias. */
const char *gm_alias_meaning(const char *word);
/* Alias number `index` of the scheme with that name, or NULL. */
const char *gm_alias_of(const char *scheme, size_t index);

enum gm_near_kind { GM_NEAR_SCHEME, GM_NEAR_KEY, GM_NEAR_COMMAND };

/* A word that is refused, what is probably meant, and for a scheme the reason. */
struct gm_near {
    enum gm_near_kind kind;
    const char *typed, *meant, *why;
};
/* Row number `index` of these with that word, or NULL. */
const struct gm_near *gm_near_find(enum gm_near_kind kind, const char *word, size_t index);

#endif
