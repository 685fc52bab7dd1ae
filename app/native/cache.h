/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_NATIVE_CACHE_H
#define GM_APP_NATIVE_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <time.h>

#include "core/ode/kernel/digest.h"

/* The folder of loops that were compiled: $XDG_CACHE_HOME/geomint, or ~/.cache/geomint. Nobody but its owner
   may look into it, else it is not used. An entry is a shared library that ends with its checksum, named by
   its key; it is written aside and then renamed, so that whoever looks sees a whole one or none. */

enum { GM_KEY_TEXT = 33, GM_CACHE_PATH = 4096 };

/* What an entry was made of, as 32 hexadecimal digits. */
struct gm_cache_key {
    char text[GM_KEY_TEXT];
};
struct gm_cache_key gm_digest_key(const struct gm_digest *digest);

/* The folder, which is made if it is not there. False with a sentence (GM_MESSAGE bytes). */
bool gm_cache_folder(char path[GM_CACHE_PATH], char *sentence);

/* The entry, open for reading, where there is a whole one, to be closed; -1: there is none. One that is not
   whole is removed. What was looked at is what is open, whoever exchanges the file meanwhile. */
int gm_cache_find(const char *folder, const struct gm_cache_key *key);
/* Of an entry that was found: it goes. */
void gm_cache_drop(const char *folder, const struct gm_cache_key *key);
/* Makes an entry of a library in the folder, which is renamed; the oldest go where there are too many. False:
   it could not be written, the sentence says why. */
bool gm_cache_keep(const char *folder, const char *library, const struct gm_cache_key *key, char *sentence);
/* What is no entry in the folder and older than an hour: left by a program that was killed. */
void gm_cache_sweep(const char *folder);

struct gm_cache_entry {
    struct gm_cache_key key;
    size_t size;
    time_t used; /* when it was made or asked for last */
};
/* The entries, the one used last first; malloc'ed, NULL where there are none. False, with errno, where the
   folder cannot be read. */
bool gm_cache_list(const char *folder, struct gm_cache_entry **entries, size_t *count);
/* Removes all, *count of them. False, with a sentence: something stays, as a folder in the place of an entry that is
   not empty. */
bool gm_cache_clear(const char *folder, size_t *count, char *sentence);

#endif
