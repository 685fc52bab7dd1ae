/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The display of a fault's place in a text. */
#include "app/base/files.h"

#include <stdio.h>
#include <string.h>

#include "app/base/arguments.h"
#include "core/expression/reader.h"
#include "render/message.h"

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
