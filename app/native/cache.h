/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_NATIVE_CACHE_H
#define GM_APP_NATIVE_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/stat.h>
#include <sys/types.h>
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

/* The system's C compiler, as a process beside this one: no shell, fixed arguments. It may take ten seconds of a
   processor, or those of GEOMINT_COMPILER_SECONDS, and hangs where it takes nothing of one for as long by the clock. */

/* A program of that name in the absolute folders of PATH; false: there is none. */
bool gm_program_find(const char *name, char path[GM_CACHE_PATH], struct stat *about);

/* The first of cc, gcc and clang in the absolute folders of PATH; what tells it from another one or another
   version of it is added to a digest. False: there is none. */
bool gm_compiler_find(char path[GM_CACHE_PATH], struct gm_digest *digest);

/* One compilation. */
struct gm_compilation {
    pid_t process;       /* 0: none runs */
    double begin, seen;  /* by the clock: since when, and when it was last looked whether it hangs */
    unsigned long ticks; /* of a processor that it had taken then */
    int complaints;      /* a file in memory, which a full disk does not lose */
};
enum gm_compiled { GM_COMPILED, GM_COMPILES, GM_COMPILES_NOT };

/* Starts it with these arguments, which begin with the program and end with NULL, in this folder. False with a
   sentence. */
bool gm_compilation_start(struct gm_compilation *compilation, const char *folder,
                          const char *const *arguments, char *sentence);
/* How it goes; where it has failed, a sentence. */
enum gm_compiled gm_compilation_look(struct gm_compilation *compilation, char *sentence);
/* Ends it where it runs. */
void gm_compilation_stop(struct gm_compilation *compilation);

/* The folder that holds core/ode with the sources of loops: that of GEOMINT_KERNEL, or beside the installed program, or
   where it was installed to. Returns path. */
const char *gm_kernel_folder(char *path, size_t size);

#endif
