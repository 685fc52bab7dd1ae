/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Texts as cells of CSV (RFC 4180). */
#include "app/output/csv.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

void gm_csv_put_quoted(FILE *stream, const char *text)
{
    fputc('"', stream);
    for (; *text; text++) {
        fputs(*text == '"' ? "\"" : "", stream);
        fputc(*text, stream);
    }
    fputc('"', stream);
}

void gm_csv_put_text(FILE *stream, const char *text)
{
    if (strpbrk(text, ",\"")) {
        gm_csv_put_quoted(stream, text);
    } else {
        fputs(text, stream);
    }
}

const char *gm_csv_cell(const char *row, size_t index)
{
    for (bool quoted = false; index > 0; row++) {
        if (*row == '\0') {
            return row;
        }
        quoted ^= *row == '"';
        index -= !quoted && *row == ',';
    }
    return row;
}

const char *gm_csv_next(struct gm_csv_lines *lines)
{
    const ssize_t length = lines->stream ? getline(&lines->line, &lines->room, lines->stream) : -1;
    if (length > 0 && lines->line[length - 1] == '\n') {
        return lines->line;
    }
    if (length <= 0 && lines->line) {
        lines->line[0] = '\0';
    }
    return NULL;
}

void gm_csv_close(struct gm_csv_lines *lines)
{
    if (lines->stream) {
        fclose(lines->stream);
    }
    free(lines->line);
    *lines = (struct gm_csv_lines){0};
}
