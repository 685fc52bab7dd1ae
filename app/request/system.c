/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Systems of files: where they are, and what is said where one is wrong. */
#include "app/request/system.h"

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/request/drive.h"
#include "app/request/share.h"
#include "core/memory.h"
#include "render/files/regular_file.h"

static const char ending[] = ".system";

static bool is_path(const char *word)
{
    const size_t length = strlen(word), wanted = sizeof ending - 1;
    return length > wanted && strcmp(word + length - wanted, ending) == 0;
}

static bool lies_in(const char *folder, const char *word, char *path, size_t size)
{
    return snprintf(path, size, "%s/%s%s", folder, word, ending) < (int)size && access(path, F_OK) == 0;
}

bool gm_system_path(const char *word, char *path, size_t size)
{
    char folder[4096];
    if (is_path(word)) {
        return snprintf(path, size, "%s", word) < (int)size;
    }
    if (strchr(word, '/') || word[0] == '\0') {
        return false;
    }
    if (lies_in(gm_share_folder("systems", "GEOMINT_SYSTEMS", folder, sizeof folder), word, path, size)) {
        return true;
    }
    const char *own = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    const bool known = own && *own;
    snprintf(folder, sizeof folder, "%s%s/geomint", known ? own : home ? home : "", known ? "" : "/.config");
    return (known || home) && lies_in(folder, word, path, size);
}

/* The whole of a regular file, or of one that is too large nothing but its length; NULL with a complaint. */
static char *read_file(const char *path, size_t *length)
{
    char reason[GM_REGULAR_REASON];
    FILE *file = gm_regular_open(path, SIZE_MAX, length, reason);
    if (!file) {
        gm_complain("%.300s could not be read: %s", path, reason);
        return NULL;
    }
    const bool large = *length > GM_LARGEST_SYSTEM;
    char *text = malloc(large ? 1 : *length + 1);
    if (text && !large) {
        *length = fread(text, 1, *length, file);
    }
    if (!text || ferror(file)) {
        gm_complain("%.300s could not be read: %s", path, text ? strerror(errno) : "not enough memory");
        free(text);
        text = NULL;
    }
    fclose(file);
    return text;
}

/* The line with a caret below what is wrong. Only what is ASCII is shown as it is. */
static void show_place(const char *text, size_t length, size_t offset)
{
    enum { BEFORE = 60, WIDTH = 100 };
    size_t begin = offset;
    while (begin > 0 && text[begin - 1] != '\n' && offset - begin < BEFORE) {
        begin--;
    }
    while (begin < offset && ((unsigned char)text[begin] & 0xc0) == 0x80) {
        begin++;
    }
    int columns = 0;
    fputs("    ", stderr);
    for (size_t i = begin; i < length && text[i] != '\n' && i - begin < WIDTH; i++) {
        const unsigned char byte = (unsigned char)text[i];
        if ((byte & 0xc0) != 0x80) {
            fputc(byte == '\t' ? ' ' : byte < ' ' || byte > '~' ? '?' : byte, stderr);
            columns += i < offset;
        }
    }
    fprintf(stderr, "\n    %*s^\n", columns, "");
}

int gm_system_open(struct gm_own_system *system, const char *path, const struct gm_system_value *values,
                   size_t count)
{
    size_t length = 0;
    char *text = read_file(path, &length);
    *system = (struct gm_own_system){0};
    if (!text) {
        return gm_memory_was_short() ? GM_EXIT_MEMORY : GM_EXIT_FILE;
    }
    struct gm_fault fault;
    int status = GM_EXIT_OK;
    if (!gm_equations_open(system, text, length, values, count, &fault)) {
        size_t line, column;
        status = fault.sentence[0] ? GM_EXIT_USAGE : GM_EXIT_MEMORY;
        gm_text_place(text, fault.sentence[0] && length <= GM_LARGEST_SYSTEM ? fault.offset : 0, &line,
                      &column);
        if (status == GM_EXIT_MEMORY) {
            gm_complain("%.300s: not enough memory", path);
        } else {
            gm_complain("%.300s:%zu:%zu: %s", path, line, column, fault.sentence);
        }
        if (status == GM_EXIT_USAGE && fault.offset > 0 && fault.offset < length) {
            show_place(text, length, fault.offset);
        }
    }
    free(text);
    return status;
}
