/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of names that people know from elsewhere. */
#include "core/aliases.h"

#include <string.h>
#include <strings.h>

#include "core/basics.h"

#define GM_NEAR(...)
#define GM_ALIAS(...) {__VA_ARGS__},
const struct gm_alias gm_aliases[] = {
#include "core/aliases.def"
};
#undef GM_ALIAS
#undef GM_NEAR
const size_t gm_alias_count = GM_COUNT(gm_aliases);

#define GM_ALIAS(...)
#define GM_NEAR(kind, ...) {GM_NEAR_##kind, __VA_ARGS__},
static const struct gm_near near_rows[] = {
#include "core/aliases.def"
};
#undef GM_ALIAS
#undef GM_NEAR

const char *gm_alias_meaning(const char *word)
{
    for (size_t i = 0; i < gm_alias_count; i++) {
        if (strcasecmp(gm_aliases[i].typed, word) == 0) {
            return gm_aliases[i].scheme;
        }
    }
    return NULL;
}

const char *gm_alias_of(const char *scheme, size_t index)
{
    for (size_t i = 0; i < gm_alias_count; i++) {
        if (strcmp(gm_aliases[i].scheme, scheme) == 0 && index-- == 0) {
            return gm_aliases[i].typed;
        }
    }
    return NULL;
}

const struct gm_near *gm_near_find(enum gm_near_kind kind, const char *word, size_t index)
{
    for (size_t i = 0; i < GM_COUNT(near_rows); i++) {
        const char *typed = near_rows[i].typed;
        /* the case of a key counts: T is a time, H is a Hamiltonian */
        const bool same = (kind == GM_NEAR_KEY ? strcmp(typed, word) : strcasecmp(typed, word)) == 0;
        if (near_rows[i].kind == kind && same && index-- == 0) {
            return &near_rows[i];
        }
    }
    return NULL;
}
