/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/files/generated.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

char *gm_input_read(const char *path, size_t *length)
{
    char *text = NULL, part[4096];
    FILE *in = fopen(path, "r"), *memory = in ? open_memstream(&text, length) : NULL;
    for (size_t count; memory && (count = fread(part, 1, sizeof part, in)) > 0;) {
        fwrite(part, 1, count, memory);
    }
    bool good = memory && !ferror(in);
    good = memory && fclose(memory) == 0 && good;
    if (in) {
        fclose(in);
    }
    if (!good) {
        free(text);
    }
    return good ? text : NULL;
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
