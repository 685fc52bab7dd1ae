/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_NATIVE_CACHE_H
#define GM_APP_NATIVE_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <time.h>

#include "core/ode/kernel/digest.h"

/* The folder of compiled code: $XDG_CACHE_HOME/geomint, or ~/.cache/geomint. It is used only if other
   users cannot read it. An entry is a shared library that ends with its checksum, named by its key; it is
   written under another name and then renamed, so that a reader sees a whole one or none. */

enum { GM_KEY_TEXT = 33, GM_CACHE_PATH = 4096 };

/* The digest of an entry's sources, as 32 hexadecimal digits. */
struct gm_cache_key {
    char text[GM_KEY_TEXT];
};
struct gm_cache_key gm_digest_key(const struct gm_digest *digest);

/* The folder, which is made if it is missing. Returns false with a sentence (GM_MESSAGE bytes). */
bool gm_cache_folder(char path[GM_CACHE_PATH], char *sentence);

/* The entry, open for reading, if it is whole, else -1; the caller closes it. A damaged entry is removed.
   The checked file is the open one, even if another process exchanges it. */
int gm_cache_find(const char *folder, const struct gm_cache_key *key);
/* Removes an entry that was found. */
void gm_cache_drop(const char *folder, const struct gm_cache_key *key);
/* Makes an entry from a library in the folder, by renaming it; the oldest are removed if there are too
   many. Returns false with a sentence if it could not be written. */
bool gm_cache_keep(const char *folder, const char *library, const struct gm_cache_key *key, char *sentence);
/* Removes files in the folder that are not entries and older than an hour: a killed program has left them. */
void gm_cache_sweep(const char *folder);

struct gm_cache_entry {
    struct gm_cache_key key;
    size_t size;
    time_t used; /* the time of its making or last use */
};
/* The entries, the last used one first; malloc'ed, possibly NULL without entries. Returns false with errno if the
   folder cannot be read. */
bool gm_cache_list(const char *folder, struct gm_cache_entry **entries, size_t *count);
/* Removes all entries, *count of them. Returns false with a sentence if something stays, such as a folder
   with an entry's name that is not empty. */
bool gm_cache_clear(const char *folder, size_t *count, char *sentence);

/* The system's C compiler, as a child process: no shell, fixed arguments. It may take ten seconds of CPU
   time, or those of GEOMINT_COMPILER_SECONDS, and hangs if it takes no CPU time for as long by the clock. */

/* The program with that name in the absolute folders of PATH; false if there is no such program. */
bool gm_program_find(const char *name, char path[GM_CACHE_PATH], struct stat *about);

/* The first of cc, gcc and clang in the absolute folders of PATH; data that identify it and its version
   are added to a digest. Returns false if there is no compiler. */
bool gm_compiler_find(char path[GM_CACHE_PATH], struct gm_digest *digest);

/* One compilation. */
struct gm_compilation {
    pid_t process;       /* 0: not running */
    double begin, seen;  /* clock times, in seconds, of the start and of the last check for a hang */
    unsigned long ticks; /* CPU time at that check, in ticks */
    int complaints;      /* a file in memory, safe from a full disk */
};
enum gm_compiled { GM_COMPILED, GM_COMPILES, GM_COMPILES_NOT };

/* Starts the compiler in this folder with these arguments, which begin with the program and end with NULL.
   Returns false with a sentence. */
bool gm_compilation_start(struct gm_compilation *compilation, const char *folder,
                          const char *const *arguments, char *sentence);
/* The state of the compilation; after a failure with a sentence. */
enum gm_compiled gm_compilation_look(struct gm_compilation *compilation, char *sentence);
/* Ends the compilation if it runs. */
void gm_compilation_stop(struct gm_compilation *compilation);

/* The folder with core/ode and the sources of loops: GEOMINT_KERNEL's, or next to the installed program,
   or the installed one. Returns path. */
const char *gm_kernel_folder(char *path, size_t size);

#endif
