/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_LOADER_LIBRARY_H
#define GM_LOADER_LIBRARY_H

#include <pthread.h>
#include <stdbool.h>
#include <stddef.h>

/* Shared libraries that are opened when they are needed: a run needs none of those that draw, write or prove. */

typedef void (*gm_library_function)(void);

/* Opens the first of these libraries that exists; the list ends with NULL. On failure returns NULL with the
   reason: "libEGL.so.1 is not installed", for the first name, or the loader's message. */
void *gm_library_open(const char *const *names, char *message, size_t size);

/* Finds functions and variables: their names, each ended by 0 and all by another one, and pointers to them in the
   same order. Returns false if one is lacking. */
bool gm_library_find(void *library, const char *names, void *pointers);
#define GM_LIBRARY_NAME(name) #name "\0"
#define GM_LIBRARY_POINTER(name) __typeof__(name) *name;

/* Opens a library and fills the table of its functions, or ends the program, with one sentence and status 3, or 5 for
   lack of memory. */
void gm_library_require(const char *file, const char *names, void *pointers);

/* Declare and define `const struct tag *tag(void)`, which returns the table, filled at the first call, of the
   library's functions in NAMES(F) F(one) F(two): tag()->one(...). */
#define GM_LIBRARY_TABLE(tag, NAMES)                                                                         \
    const struct tag {                                                                                       \
        NAMES(GM_LIBRARY_POINTER)                                                                            \
    } * tag(void)
#define GM_LIBRARY(tag, file, NAMES)                                                                         \
    static struct tag table_of_##tag;                                                                        \
    static void fill_##tag(void)                                                                             \
    {                                                                                                        \
        gm_library_require(file, NAMES(GM_LIBRARY_NAME), &table_of_##tag);                                   \
    }                                                                                                        \
    const struct tag *tag(void)                                                                              \
    {                                                                                                        \
        static pthread_once_t once = PTHREAD_ONCE_INIT;                                                      \
        pthread_once(&once, fill_##tag);                                                                     \
        return &table_of_##tag;                                                                              \
    }

#endif
