/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/files/generated.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

char *gm_input_read(const char *path, size_t *length)
{
    FILE *in = fopen(path, "r");
    const long size = in && fseek(in, 0, SEEK_END) == 0 ? ftell(in) : -1;
    char *text = size >= 0 ? calloc((size_t)size + 1, 1) : NULL;
    if (text) {
        rewind(in);
        *length = (size_t)size;
    }
    if (text && fread(text, 1, *length, in) < *length) {
        free(text);
        text = NULL;
    }
    if (in) {
        fclose(in);
    }
    return text;
}

void gm_string_put(FILE *out, const char *text, size_t length)
{
    fputs("\"", out);
    for (size_t i = 0; i < length; i++) {
        const unsigned char byte = (unsigned char)text[i];
        if (byte < ' ' || byte > '~' || strchr("\"\\?", byte)) {
            fprintf(out, byte == '\n' ? "\\n\"\n\"" : "\\%03o", byte);
        } else {
            fputc(byte, out);
        }
    }
    fputs("\"", out);
}
