/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/json.h"

#include <math.h>
#include <stdio.h>

void gm_json_text(const char *text)
{
    putchar('"');
    for (; *text; text++) {
        if (*text == '\n') {
            fputs("\\n", stdout);
        } else if ((unsigned char)*text < ' ') {
            printf("\\u%04x", (unsigned)*text);
        } else {
            if (*text == '"' || *text == '\\') {
                putchar('\\');
            }
            putchar(*text);
        }
    }
    putchar('"');
}

void gm_json_pair(const char *key, const char *text)
{
    gm_json_text(key);
    putchar(':');
    gm_json_text(text);
}

void gm_json_number(double value)
{
    if (isfinite(value)) {
        printf("%.17g", value);
    } else {
        fputs("null", stdout);
    }
}
