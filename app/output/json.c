/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON on standard output: strings, numbers, what is no number. */
#include "app/output/json.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "render/cells/text.h"

/* Whether a letter of so many bytes is the only way to write this code. */
static bool is_proper(uint32_t code, size_t bytes)
{
    const size_t needed = code < 0x80 ? 1 : code < 0x800 ? 2 : code < 0x10000 ? 3 : 4;
    return bytes == needed && (code < 0xD800 || code > 0xDFFF) && code <= 0x10FFFF;
}

void gm_json_put_text(FILE *stream, const char *text)
{
    fputc('"', stream);
    while (*text) {
        const char *letter = text;
        const uint32_t code = gm_text_next(&text);
        if (code == '\n') {
            fputs("\\n", stream);
        } else if (code < ' ') {
            fprintf(stream, "\\u%04x", (unsigned)code);
        } else if (!is_proper(code, (size_t)(text - letter))) {
            fputs("\\ufffd", stream);
        } else {
            fprintf(stream, "%s%.*s", code == '"' || code == '\\' ? "\\" : "", (int)(text - letter), letter);
        }
    }
    fputc('"', stream);
}

void gm_json_put_pair(FILE *stream, const char *key, const char *text)
{
    gm_json_put_text(stream, key);
    fputc(':', stream);
    gm_json_put_text(stream, text);
}

void gm_json_pair(const char *key, const char *text)
{
    gm_json_put_pair(stdout, key, text);
}

void gm_json_put_number(FILE *stream, double value)
{
    if (isfinite(value)) {
        fprintf(stream, "%.17g", value);
    } else {
        fputs("null", stream);
    }
}

void gm_json_number(double value)
{
    gm_json_put_number(stdout, value);
}

void gm_json_put_number_pair(FILE *stream, const char *key, double value)
{
    gm_json_put_text(stream, key);
    fputc(':', stream);
    gm_json_put_number(stream, value);
}

void gm_json_number_pair(const char *key, double value)
{
    gm_json_put_number_pair(stdout, key, value);
}
