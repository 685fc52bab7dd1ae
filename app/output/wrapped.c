/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Text on standard output, wrapped to its width. */
#include "app/output/wrapped.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

enum { NARROWEST = 20, ROOM = 24, LEAST_INDENT = 4 };

int gm_output_columns(void)
{
    const char *told = getenv("COLUMNS");
    const long columns = told ? strtol(told, NULL, 10) : 0;
    struct winsize size;
    if (columns >= NARROWEST && columns < 10000) {
        return (int)columns;
    }
    if (isatty(STDOUT_FILENO) && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col >= NARROWEST) {
        return size.ws_col;
    }
    return 0;
}

static int letters_of(const char *text, size_t bytes)
{
    int letters = 0;
    for (size_t i = 0; i < bytes; i++) {
        letters += ((unsigned char)text[i] & 0xC0) != 0x80;
    }
    return letters;
}

void gm_print_wrapped(const char *text, int before, int indent)
{
    const int columns = gm_output_columns();
    int at = before;
    if (columns > 0 && indent > columns - ROOM) {
        indent = LEAST_INDENT;
    }
    const char *blank = "";
    while (*text) {
        const size_t bytes = strcspn(text, " ");
        const int letters = letters_of(text, bytes);
        if (columns > 0 && at + (int)strlen(blank) + letters > columns && at > indent) {
            printf("\n%*s", indent, "");
            at = indent;
            blank = "";
        }
        printf("%s%.*s", blank, (int)bytes, text);
        at += (int)strlen(blank) + letters;
        blank = " ";
        text += bytes;
        text += strspn(text, " ");
    }
    putchar('\n');
}
