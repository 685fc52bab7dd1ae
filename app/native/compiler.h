/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_NATIVE_COMPILER_H
#define GM_APP_NATIVE_COMPILER_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/stat.h>
#include <sys/types.h>

#include "app/native/cache.h"

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

#endif
