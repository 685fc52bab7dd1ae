/* SPDX-License-Identifier: GPL-3.0-or-later */
/* JSON on standard output: strings, numbers, what is no number. */
#include "app/output/json.h"

#include <math.h>
#include <stdio.h>

#include "render/cells/text.h"

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
        } else if (code == 0xFFFD) { /* malformed bytes, too */
            fputs("\\ufffd", stream);
        } else {
            fprintf(stream, "%s%.*s", code == '"' || code == '\\' ? "\\" : "", (int)(text - letter), letter);
        }
    }
    fputc('"', stream);
}

void gm_json_pair(const char *key, const char *text)
{
    gm_json_put_text(stdout, key);
    putchar(':');
    gm_json_put_text(stdout, text);
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

void gm_json_number_pair(const char *key, double value)
{
    gm_json_put_text(stdout, key);
    putchar(':');
    gm_json_number(value);
}
