/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reading the texts in the metadata of an SVG, as svg.c writes them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/files/regular_file.h"
#include "render/message.h"
#include "render/vector/vector.h"

enum { MOST_BYTES = 1 << 28 };

/* Undoes the escapes of a text, in place. */
static void unescape(char *text)
{
    static const char *const escapes[][2] = {{"&amp;", "&"}, {"&lt;", "<"}, {"&gt;", ">"}};
    char *to = text;
    while (*text) {
        size_t taken = 1;
        *to = *text;
        for (size_t i = 0; i < sizeof escapes / sizeof escapes[0]; i++) {
            if (strncmp(text, escapes[i][0], strlen(escapes[i][0])) == 0) {
                *to = escapes[i][1][0];
                taken = strlen(escapes[i][0]);
            }
        }
        text += taken;
        to++;
    }
    *to = '\0';
}

/* Returns the text of a key between two places, which the caller frees; NULL without it. */
static char *text_of(const char *from, const char *to, const char *key)
{
    char front[128];
    snprintf(front, sizeof front, "<geomint:text key=\"%s\">", key);
    const char *start = strstr(from, front);
    const char *end = start && start < to ? strstr(start, "</geomint:text>") : NULL;
    if (!end || end > to) {
        return NULL;
    }
    start += strlen(front);
    char *text = strndup(start, (size_t)(end - start));
    if (text) {
        unescape(text);
    }
    return text;
}

bool gm_svg_read_texts(const char *path, const char *const *keys, char **texts, size_t count, char *message)
{
    char reason[GM_REGULAR_REASON];
    size_t size = 0;
    char *bytes = gm_regular_read(path, MOST_BYTES, &size, reason);
    if (!bytes) {
        snprintf(message, GM_MESSAGE, "%.300s could not be read: %s", path, reason);
        return false;
    }
    const char *from = strstr(bytes, "<metadata"), *to = from ? strstr(from, "</metadata>") : NULL;
    for (size_t i = 0; i < count; i++) {
        texts[i] = to ? text_of(from, to, keys[i]) : NULL;
    }
    free(bytes);
    return true;
}
