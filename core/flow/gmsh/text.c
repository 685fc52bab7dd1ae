/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text of a Gmsh file: words, numbers, counts. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/flow/gmsh/reader.h"

bool gm_gmsh_fail(struct gm_gmsh_reader *reader, enum gm_triangulation_fault_kind kind, const char *text)
{
    *reader->fault = (struct gm_triangulation_fault){.kind = kind, .line = reader->line};
    snprintf(reader->fault->text, sizeof reader->fault->text, "%.*s", (int)sizeof reader->fault->text - 1,
             text);
    return false;
}

bool gm_gmsh_fail_at_node(struct gm_gmsh_reader *reader, enum gm_triangulation_fault_kind kind, long line,
                          long node)
{
    *reader->fault = (struct gm_triangulation_fault){.kind = kind, .line = line, .nodes = {node}};
    return false;
}

void gm_gmsh_skip_blanks(struct gm_gmsh_reader *reader)
{
    while (reader->at < reader->end && isspace((unsigned char)*reader->at)) {
        reader->line += *reader->at == '\n';
        reader->at++;
    }
}

bool gm_gmsh_take_word(struct gm_gmsh_reader *reader, char *word, size_t size)
{
    gm_gmsh_skip_blanks(reader);
    size_t length = 0;
    while (reader->at < reader->end && !isspace((unsigned char)*reader->at)) {
        if (length + 1 >= size) {
            return false;
        }
        word[length++] = *reader->at++;
    }
    word[length] = '\0';
    return length > 0;
}

bool gm_gmsh_at_end(struct gm_gmsh_reader *reader)
{
    gm_gmsh_skip_blanks(reader);
    return reader->at >= reader->end;
}

bool gm_gmsh_take_number(struct gm_gmsh_reader *reader, double *value, const char *what)
{
    char word[64], *rest = NULL;
    if (gm_gmsh_at_end(reader)) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    if (!gm_gmsh_take_word(reader, word, sizeof word)) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, what);
    }
    *value = strtod(word, &rest);
    return (*rest == '\0' && isfinite(*value)) || gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, what);
}

bool gm_gmsh_take_whole(struct gm_gmsh_reader *reader, long *value, const char *what)
{
    char word[32], *rest = NULL;
    if (gm_gmsh_at_end(reader)) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    if (!gm_gmsh_take_word(reader, word, sizeof word) || strlen(word) > 18) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, what);
    }
    *value = strtol(word, &rest, 10);
    return *rest == '\0' || gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, what);
}

bool gm_gmsh_take_count(struct gm_gmsh_reader *reader, long *value, const char *what)
{
    if (!gm_gmsh_take_whole(reader, value, what)) {
        return false;
    }
    if (*value < 0) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, what);
    }
    if (*value > GM_GMSH_MOST) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_HUGE, what);
    }
    if (*value > (reader->end - reader->at) / 2 + 1) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    return true;
}

bool gm_gmsh_expect_end(struct gm_gmsh_reader *reader)
{
    char wanted[44], word[44];
    snprintf(wanted, sizeof wanted, "$End%s", reader->section + 1);
    if (gm_gmsh_at_end(reader)) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    return (gm_gmsh_take_word(reader, word, sizeof word) && strcmp(word, wanted) == 0) ||
           gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, wanted);
}
