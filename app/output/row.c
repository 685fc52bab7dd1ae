/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Cells one after the other: tables in CSV (RFC 4180), and JSON. */
#include "app/output/row.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/cells/text.h"

/* A string of JSON. */
static void put_text(FILE *stream, const char *text)
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

/* A number that is not finite is null. */
static void put_number(FILE *stream, double value)
{
    if (isfinite(value)) {
        fprintf(stream, "%.17g", value);
    } else {
        fputs("null", stream);
    }
}

static struct gm_row *outermost_of(struct gm_row *row)
{
    return row->outermost ? row->outermost : row;
}

/* Ends what is open in a row. */
static void end_inner(struct gm_row *row)
{
    struct gm_row *outermost = outermost_of(row);
    while (outermost->open > row->depth) {
        fputc(outermost->ends[--outermost->open], row->stream);
    }
}

static void begin(struct gm_row *row, const char *key)
{
    end_inner(row);
    fputs(row->begun ? "," : "", row->stream);
    row->begun = true;
    if (row->form == GM_ROW_HEAD) {
        fputs(key, row->stream);
    } else if (row->form == GM_ROW_JSON && key) {
        put_text(row->stream, key);
        fputc(':', row->stream);
    }
}

/* A cell of CSV that is a text, in quotes if it needs them. */
static void put_cell(FILE *stream, const char *text)
{
    if (strpbrk(text, ",\"")) {
        gm_csv_put_quoted(stream, text);
    } else {
        fputs(text, stream);
    }
}

void gm_row_text(struct gm_row *row, const char *key, const char *text)
{
    begin(row, key);
    if (!text) {
        fputs("null", row->stream);
    } else if (row->form == GM_ROW_JSON) {
        put_text(row->stream, text);
    } else if (row->form == GM_ROW_CSV) {
        put_cell(row->stream, text);
    }
}

void gm_row_number(struct gm_row *row, const char *key, double value, int digits)
{
    begin(row, key);
    if (row->form == GM_ROW_JSON) {
        put_number(row->stream, value);
    } else if (row->form == GM_ROW_CSV && !isnan(value)) {
        fprintf(row->stream, "%.*g", digits, value);
    }
}

void gm_row_put(struct gm_row *row, const char *format, ...)
{
    va_list values;
    va_start(values, format);
    while (*format) {
        char key[64];
        const int length = (int)strcspn(format, " ");
        const char *conversion = format + length + strlen(" %");
        snprintf(key, sizeof key, "%.*s", length, format);
        format = conversion + strcspn(conversion, ",");
        const char kind = format[-1];
        format += strspn(format, ", ");
        if (kind == 's') {
            gm_row_text(row, key, va_arg(values, const char *));
        } else if (kind == 'g') {
            gm_row_number(row, key, va_arg(values, double), atoi(conversion + 1));
        } else {
            const double count = kind == 'f' ? va_arg(values, double) : va_arg(values, int);
            begin(row, key);
            if (kind == 'd') {
                fputs(count > 0 ? "true" : "false", row->stream);
            } else if (row->form != GM_ROW_HEAD) {
                fprintf(row->stream, "%.0f", count);
            }
        }
    }
    va_end(values);
}

void gm_row_list(struct gm_row *row, const char *key, const double *values, size_t count)
{
    begin(row, key);
    for (size_t i = 0; i < count; i++) {
        fputc(i ? ',' : '[', row->stream);
        put_number(row->stream, values[i]);
    }
    fputc(']', row->stream);
}

struct gm_row gm_row_begin(FILE *stream)
{
    fputc('{', stream);
    return (struct gm_row){.stream = stream, .form = GM_ROW_JSON};
}

struct gm_row gm_row_open(struct gm_row *row, const char *key, char end)
{
    struct gm_row *outermost = outermost_of(row);
    begin(row, key);
    fputc(end == '}' ? '{' : '[', row->stream);
    outermost->ends[outermost->open++] = end;
    return (struct gm_row){
        .stream = row->stream, .form = GM_ROW_JSON, .depth = outermost->open, .outermost = outermost};
}

void gm_row_close(struct gm_row *outermost, const char *after)
{
    end_inner(outermost);
    fprintf(outermost->stream, "}%s", after);
}

void gm_csv_put_quoted(FILE *stream, const char *text)
{
    fputc('"', stream);
    for (; *text; text++) {
        fputs(*text == '"' ? "\"" : "", stream);
        fputc(*text, stream);
    }
    fputc('"', stream);
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

/* Appends the lines that belong to the last one, whose length it is. Returns false when out of memory. */
static bool take_group(struct gm_csv_lines *lines, size_t length)
{
    for (ssize_t more; (more = getline(&lines->ahead, &lines->ahead_room, lines->stream)) > 0;) {
        if (lines->ahead[more - 1] != '\n') {
            return true; /* it ends the table, as if it were not there */
        }
        if (!(strtod(gm_csv_cell(lines->ahead, lines->group), NULL) > 0)) {
            lines->is_ahead = true;
            return true;
        }
        const size_t whole = length + (size_t)more + 1;
        char *longer = whole > lines->room ? realloc(lines->line, 2 * whole) : lines->line;
        if (!longer) {
            return false;
        }
        lines->room = whole > lines->room ? 2 * whole : lines->room;
        lines->line = longer;
        memcpy(longer + length, lines->ahead, (size_t)more + 1);
        length += (size_t)more;
    }
    return true;
}

/* Reads a line, or takes the one that was read ahead. Returns its length; -1: none. */
static ssize_t take_line(struct gm_csv_lines *lines)
{
    if (!lines->is_ahead) {
        return lines->stream ? getline(&lines->line, &lines->room, lines->stream) : -1;
    }
    char *line = lines->ahead;
    const size_t room = lines->ahead_room;
    lines->ahead = lines->line;
    lines->ahead_room = lines->room;
    lines->line = line;
    lines->room = room;
    lines->is_ahead = false;
    return (ssize_t)strlen(line);
}

const char *gm_csv_next(struct gm_csv_lines *lines)
{
    const ssize_t length = take_line(lines);
    if (length > 0 && lines->line[length - 1] == '\n') {
        return lines->group == 0 || take_group(lines, (size_t)length) ? lines->line : NULL;
    }
    if (length <= 0 && lines->line) {
        lines->line[0] = '\0';
    }
    return NULL;
}

void gm_csv_close(void *data)
{
    struct gm_csv_lines *lines = data;
    if (lines->stream) {
        fclose(lines->stream);
    }
    free(lines->line);
    free(lines->ahead);
    *lines = (struct gm_csv_lines){0};
}
