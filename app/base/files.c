/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Files that are part of the program, and those of the user's folders. */
#include "app/base/files.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "core/expression/reader.h"
#include "core/memory.h"
#include "render/files/regular_file.h"
#include "render/message.h"

static const char *const variables[GM_FILE_MESH] = {"GEOMINT_SYSTEMS", "GEOMINT_ROOMS", "GEOMINT_SCHEMES",
                                                    "GEOMINT_TOURS"};

/* A file that is larger is listed by its name alone. */
enum { LARGEST_DESCRIBED = 1 << 24 };

/* The folders that are searched, in this order. */
enum { OF_THE_ENVIRONMENT, OF_THE_USER, FOLDERS };

/* Returns folder, "" if the kind has none. */
static const char *find_folder(enum gm_file_kind kind, int which, char folder[4096])
{
    const char *named = getenv(variables[kind]), *config = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    folder[0] = '\0';
    if (which == OF_THE_ENVIRONMENT) {
        snprintf(folder, 4096, "%s", named ? named : "");
    } else if (config && *config) {
        snprintf(folder, 4096, "%s/geomint", config);
    } else if (home) {
        snprintf(folder, 4096, "%s/.config/geomint", home);
    }
    return folder;
}

bool gm_file_find(enum gm_file_kind kind, const char *word, struct gm_file *file)
{
    char folder[4096];
    *file = (struct gm_file){0};
    if (gm_word_ends(word, gm_file_endings[kind])) {
        snprintf(file->path, sizeof file->path, "%s", word); /* no file has a path that is longer */
        return true;
    }
    if (strchr(word, '/') || word[0] == '\0') {
        return false;
    }
    file->built_in = gm_built_in_find(kind, word);
    if (file->built_in) {
        snprintf(file->path, sizeof file->path, "%s", file->built_in->path);
    }
    bool found = file->built_in != NULL;
    for (int which = 0; which < FOLDERS && !found; which++) {
        found = find_folder(kind, which, folder)[0] &&
                snprintf(file->path, sizeof file->path, "%s/%s%s", folder, word, gm_file_endings[kind]) <
                    (int)sizeof file->path &&
                access(file->path, F_OK) == 0;
    }
    return found;
}

bool gm_file_is(enum gm_file_kind kind, const char *word)
{
    struct gm_file file;
    return gm_file_find(kind, word, &file);
}

char *gm_file_read(const struct gm_file *file, size_t most, size_t *length, char *message)
{
    char reason[GM_REGULAR_REASON];
    const struct gm_built_in *inside = file->built_in;
    char *text = inside ? malloc(inside->length + 1) : gm_regular_read(file->path, most, length, reason);
    if (!text) {
        gm_refuse(message, "%.300s could not be read: %s", file->path, inside ? strerror(ENOMEM) : reason);
    } else if (inside) {
        *length = inside->length;
        memcpy(text, inside->text, *length + 1);
    }
    return text;
}

bool gm_files_folder_opens(enum gm_file_kind kind, char *message)
{
    char folder[4096];
    return !find_folder(kind, OF_THE_ENVIRONMENT, folder)[0] || access(folder, R_OK | X_OK) == 0 ||
           gm_refuse(message, "the folder %.300s of %s could not be opened: %s", folder, variables[kind],
                     strerror(errno));
}

static void list_file(const char *name, const struct gm_file *file,
                      void (*each)(const struct gm_listed *listed, const void *data), const void *data)
{
    char reason[GM_REGULAR_REASON];
    size_t length = 0;
    const unsigned long refusals = gm_memory_refusals();
    char *text = gm_regular_read(file->path, LARGEST_DESCRIBED, &length, reason),
         *title = gm_file_title(text ? text : "", length),
         *about = gm_file_line(text ? text : "", length, "about");
    if (gm_memory_refusals() == refusals) {
        each(&(struct gm_listed){name, title, about, file}, data);
    }
    free(text);
    free(title);
    free(about);
}

/* Calls `each` for the files of a folder whose names neither an earlier folder nor the program has. */
static void each_of_folder(enum gm_file_kind kind, const char *folder,
                           void (*each)(const struct gm_listed *listed, const void *data), const void *data)
{
    struct dirent **entries = NULL;
    const int count = folder[0] ? scandir(folder, &entries, NULL, alphasort) : 0;
    if (count < 0 && errno == ENOMEM) {
        gm_memory_refused();
    }
    for (int i = 0; i < count; i++) {
        char *name = entries[i]->d_name;
        const size_t length = strlen(name);
        struct gm_file file;
        if (gm_word_ends(name, gm_file_endings[kind])) {
            name[length - strlen(gm_file_endings[kind])] = '\0';
            if (gm_file_find(kind, name, &file) && !file.built_in &&
                strncmp(file.path, folder, strlen(folder)) == 0 &&
                strlen(file.path) == strlen(folder) + 1 + length) {
                list_file(name, &file, each, data);
            }
        }
        free(entries[i]);
    }
    free(entries);
}

bool gm_files_each(enum gm_file_kind kind, void (*each)(const struct gm_listed *listed, const void *data),
                   const void *data, char *message)
{
    char folder[4096];
    for (size_t i = 0; i < gm_built_in_count; i++) {
        const struct gm_built_in *built_in = &gm_built_in_files[i];
        if (built_in->kind == kind) {
            struct gm_file file = {.built_in = built_in};
            snprintf(file.path, sizeof file.path, "%s", built_in->path);
            each(&(struct gm_listed){built_in->name, built_in->title, built_in->about, &file}, data);
        }
    }
    for (int which = 0; which < FOLDERS; which++) {
        each_of_folder(kind, find_folder(kind, which, folder), each, data);
    }
    return gm_files_folder_opens(kind, message);
}

/* ---- the place of a fault in a text ---- */

void gm_place_report(const char *path, const char *text, const struct gm_fault *fault, char *message)
{
    size_t line, column, other, behind;
    char first[48] = "";
    gm_text_place(text, fault->offset, &line, &column);
    if (fault->earlier > 0) {
        gm_text_place(text, fault->earlier, &other, &behind);
        snprintf(first, sizeof first, ", first in line %zu", other);
    }
    gm_refuse(message, "%.150s:%zu:%zu: %.250s%s", path, line, column, fault->sentence, first);
}

void gm_place_show(const char *text, size_t length, size_t offset, char *message)
{
    enum { BEFORE = 60, WIDTH = 100 };
    size_t begin = offset;
    while (begin > 0 && text[begin - 1] != '\n' && offset - begin < BEFORE) {
        begin--;
    }
    while (begin < offset && ((unsigned char)text[begin] & 0xc0) == 0x80) {
        begin++;
    }
    char line[WIDTH + 1];
    int shown = 0, columns = 0;
    for (size_t i = begin; i < length && text[i] != '\n' && i - begin < WIDTH; i++) {
        const unsigned char byte = (unsigned char)text[i];
        if ((byte & 0xc0) != 0x80) {
            line[shown++] = (char)(byte == '\t' ? ' ' : byte < ' ' || byte > '~' ? '?' : byte);
            columns += i < offset;
        }
    }
    gm_append(message, GM_MESSAGE, "\n    %.*s\n    %*s^", shown, line, columns, "");
}

/* ---- pages that the program completes ---- */

const char *gm_page_text(const char *name)
{
    return gm_built_in_find(GM_FILE_PAGE, name)->text;
}

bool gm_page_next(FILE *page, const char **text, char slot[GM_PAGE_SLOT])
{
    const char *open = strstr(*text, "{{"), *close = open ? strstr(open, "}}") : NULL;
    if (!close) {
        fputs(*text, page);
        return false;
    }
    fwrite(*text, 1, (size_t)(open - *text), page);
    snprintf(slot, GM_PAGE_SLOT, "%.*s", (int)(close - open) - 2, open + 2);
    const bool alone = open[-1] == '\n' && close[2] == '\n'; /* a page does not begin with a slot */
    *text = close + (alone ? 3 : 2);
    return true;
}
