/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_SCHEME_H
#define GM_APP_WORDS_SCHEME_H

#include <stdbool.h>

#include "core/ode/user/polish.h"
#include "render/message.h"

/* The scheme that a name, a path or a word means; those of one's own are made at the first time, and live as
   long as the program. NULL where there is none: the message stays empty where nothing is called so, else it
   is a sentence, with the place that is wrong on the next two lines; `unreadable` says whether because of a
   file. */
const struct gm_scheme *gm_scheme_named(const char *name, bool *unreadable, char *message);

/* The same where there has to be one: NULL always with a sentence, which proposes the nearest name, and an
   exit status. */
const struct gm_scheme *gm_scheme_sought(const char *name, int *status, char *message);

/* The text of a scheme of one's own with decimals that satisfy its order conditions (core/ode/user/polish.h).
   NULL with a sentence, as above. */
char *gm_scheme_polished(const char *name, struct gm_polish *polish, bool *unreadable, char *message);

/* A word of a request as somebody typed it in the file at this path: what is "scheme=..." names files from
   the folder of that one. malloc'ed, NULL: out of memory. */
char *gm_scheme_words_from(const char *path, const char *word);

/* Whether it means one, which is not made for good if it is a word. False with a sentence, and the byte where
   it is wrong. */
bool gm_scheme_check(const char *name, size_t *at, char *message);

#endif
