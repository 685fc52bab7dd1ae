/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where in a text something is wrong, for people to see. */
#include "app/base/place.h"

#include <stdio.h>
#include <string.h>

#include "render/message.h"

void gm_place_show(const char *text, size_t length, size_t offset, char *message)
{
    enum { BEFORE = 60, WIDTH = 100 };
    size_t begin = offset;
    const size_t used = strlen(message);
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
    snprintf(message + used, GM_MESSAGE - used, "\n    %.*s\n    %*s^", shown, line, columns, "");
}
