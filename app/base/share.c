/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the data are that the program brings. */
#include "app/base/share.h"

#include <dirent.h>
#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/expression/reader.h"
#include "render/files/regular_file.h"

/* The program or the library that this is part of. */
static bool find_self(char self[4096])
{
    static const char part = 0;
    Dl_info here;
    const bool library = dladdr(&part, &here) && strstr(here.dli_fname, "libgeomint.so");
    char *found = realpath(library ? here.dli_fname : "/proc/self/exe", NULL);
    const bool known = found && snprintf(self, 4096, "%s", found) < 4096;
    free(found);
    return known;
}

/* bin/geomint, lib/libgeomint.so or lib/MACHINE/libgeomint.so beside share/geomint, wherever they have been
   moved together. */
static bool beside_program(const char *name, char *path, size_t size)
{
    char self[4096];
    if (!find_self(self)) {
        return false;
    }
    char *slash = strrchr(self, '/');
    for (int up = 0; slash && up < 3; up++) {
        *slash = '\0';
        const int wanted = snprintf(path, size, "%s/share/geomint/%s", self, name);
        if (up > 0 && wanted < (int)size && access(path, R_OK) == 0) {
            return true;
        }
        slash = strrchr(self, '/');
    }
    return false;
}

const char *gm_share_folder(const char *name, const char *variable, char *path, size_t size)
{
    const char *own = getenv(variable);
    if (own && *own) {
        snprintf(path, size, "%s", own);
    } else if (!beside_program(name, path, size)) {
        snprintf(path, size, "%s/%s", GM_SHARE, name);
    }
    return path;
}

bool gm_share_find(const char *folder, const char *name, const char *ending, char *path, size_t size)
{
    return snprintf(path, size, "%s/%s%s", folder, name, ending) < (int)size && access(path, F_OK) == 0;
}

void gm_share_each(const char *folder, const char *ending, void (*each)(const char *name, const void *data),
                   const void *data)
{
    struct dirent **entries = NULL;
    const int count = folder[0] ? scandir(folder, &entries, NULL, alphasort) : 0;
    for (int i = 0; i < count; i++) {
        char *name = entries[i]->d_name;
        if (gm_word_ends(name, ending)) {
            name[strlen(name) - strlen(ending)] = '\0';
            each(name, data);
        }
        free(entries[i]);
    }
    free(entries);
}

void gm_share_title(const char *path, char *title, size_t size)
{
    static const char word[] = "title:";
    char reason[GM_REGULAR_REASON], line[512];
    size_t length;
    title[0] = '\0';
    FILE *file = gm_regular_open(path, SIZE_MAX, &length, reason);
    while (file && !title[0] && fgets(line, sizeof line, file)) {
        if (strncmp(line, word, sizeof word - 1) == 0) {
            const char *text = line + sizeof word - 1 + strspn(line + sizeof word - 1, " \t");
            snprintf(title, size, "%.*s", (int)strcspn(text, "\r\n"), text);
        }
    }
    if (file) {
        fclose(file);
    }
}
