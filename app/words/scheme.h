/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_SCHEME_H
#define GM_APP_WORDS_SCHEME_H

#include <stdbool.h>

#include "core/ode/user/scheme.h"
#include "render/message.h"

/* The scheme of a name, a path or a word. User-defined schemes are made at the first call and live as long
   as the program. Returns NULL with an empty message if there is no such scheme, else with a sentence and,
   on the next two lines, the place of the fault; `unreadable`: a file is the reason. */
const struct gm_scheme *gm_scheme_named(const char *name, bool *unreadable, char *message);

/* The same for a required scheme: NULL always comes with a sentence, which proposes the nearest name, and
   an exit status. */
const struct gm_scheme *gm_scheme_sought(const char *name, int *status, char *message);

/* The text of a user-defined scheme with decimals that satisfy its order conditions
   (core/ode/user/scheme.h). Returns NULL with a sentence, as gm_scheme_named. */
char *gm_scheme_polished(const char *name, struct gm_polish *polish, bool *unreadable, char *message);

/* A request's word from the file at this path: files after "scheme=" are relative to its folder.
   malloc'ed. Returns NULL when out of memory. */
char *gm_scheme_words_from(const char *path, const char *word);

/* Returns true if the name means a scheme; a word is not stored. Returns false with a sentence, and the
   byte of the fault. */
bool gm_scheme_check(const char *name, size_t *at, char *message);

#endif
