/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Shared libraries, and the reason why one cannot be opened. */
#include "loader/library.h"

#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef RTLD_DEEPBIND
/* Returns true if malloc is the C library's, not a sanitizer's or another allocator's that precedes it. */
static bool has_own_memory(void)
{
    void *library = dlopen("libc.so.6", RTLD_LAZY | RTLD_NOLOAD);
    void *self = library ? dlsym(library, "malloc") : NULL;
    if (library) {
        dlclose(library);
    }
    return self && self == dlsym(RTLD_DEFAULT, "malloc");
}

/* Mesa and LLVM look up 20 000 symbols while they are loaded. With RTLD_DEEPBIND their own libraries are
   searched before the program's forty, which saves a third of the time. With another allocator it is not
   possible: they would pass it blocks that the C library has allocated. */
static int binding(void)
{
    return has_own_memory() ? RTLD_DEEPBIND : 0;
}
#else
static int binding(void)
{
    return 0;
}
#endif

void *gm_library_open(const char *const *names, char *message, size_t size)
{
    snprintf(message, size, "%s is not installed", names[0]);
    for (size_t i = 0; names[i]; i++) {
        void *library = dlopen(names[i], RTLD_NOW | RTLD_LOCAL | binding());
        if (library) {
            return library;
        }
        /* "NAME: cannot open shared object file: No such file or directory". With another name or reason the
           library exists but cannot be used. */
        const char *reason = dlerror();
        const bool missing =
            strncmp(reason, names[i], strlen(names[i])) == 0 && strstr(reason, strerror(ENOENT)) != NULL;
        if (!missing) {
            snprintf(message, size, "%s", reason);
            return NULL;
        }
    }
    return NULL;
}

bool gm_library_find(void *library, const char *names, void *pointers)
{
    unsigned char *pointer = pointers;
    for (const char *name = names; *name; name += strlen(name) + 1, pointer += sizeof(void *)) {
        /* dlsym returns functions as data pointers; POSIX lets their representation be copied */
        void *found = dlsym(library, name);
        memcpy(pointer, &found, sizeof found);
        if (!found) {
            return false;
        }
    }
    return true;
}

void gm_library_require(const char *file, const char *names, void *pointers)
{
    enum { NO_FILE = 3, NO_MEMORY = 5 }; /* exit statuses */
    char reason[512];
    void *library = gm_library_open((const char *const[]){file, NULL}, reason, sizeof reason);
    if (library && !gm_library_find(library, names, pointers)) {
        snprintf(reason, sizeof reason, "%s is too old", file);
        library = NULL;
    }
    if (!library) {
        const bool short_of_memory = strstr(reason, "memory") != NULL;
        fprintf(stderr, "geomint: a library is needed here, but %s\n", reason);
        exit(short_of_memory ? NO_MEMORY : NO_FILE);
    }
}
