/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A system as it is now, with the values that its keys have. */
#include "app/words/system.h"

#include <stdio.h>
#include <string.h>

#include "core/expression/lines.h"
#include "scenes/common/scene.h"

static bool is_changed(const struct gm_parameter *row, const void *parameters)
{
    char value[GM_TEXT_SIZE];
    return strcmp(gm_parameter_format(row, parameters, value, sizeof value), row->standard) != 0;
}

/* Puts the elements of a row's list, "x[1] = 2, x[2] = 3", or "2, 3" if the text has no indices; without a
   stream nothing. Returns true if a value differs from the text. */
static bool put_list(FILE *stream, const char *name, size_t length, bool named, const struct gm_scene *scene,
                     const void *parameters)
{
    bool changed = false;
    const char *before = "";
    for (size_t i = 0; i < scene->parameter_count; i++) {
        const struct gm_parameter *row = &scene->parameters[i];
        char value[GM_TEXT_SIZE];
        if (strncmp(row->key, name, length) != 0 || row->key[length] != '[') {
            continue;
        }
        changed = changed || is_changed(row, parameters);
        if (stream) {
            fprintf(stream, "%s%s%s%s", before, named ? "" : row->key, named ? "" : " = ",
                    gm_parameter_format(row, parameters, value, sizeof value));
            before = ", ";
        }
    }
    return changed;
}

/* Puts "NAME = formula" pairs, with the value instead of the formula if it is not the default. Returns
   their end. */
static size_t put_values(FILE *stream, const char *text, struct gm_span pairs, const struct gm_scene *scene,
                         const void *parameters)
{
    struct gm_span piece;
    size_t from = pairs.begin;
    for (struct gm_span rest = pairs; gm_span_take(text, &rest, ",", &piece);) {
        const char *pair = text + piece.begin;
        const size_t name = gm_name_length(pair, piece.end - piece.begin);
        const size_t index = pair[name] == '[' ? strcspn(pair + name, "]") + 1 : 0;
        const bool is_list = index > 0 && memmem(pair + name, index, "..", 2);
        if (is_list) { /* "m[1..N] = 1, 2, 3" holds its commas */
            piece.end = pairs.end;
            rest.begin = rest.end;
        }
        char key[64], value[GM_TEXT_SIZE];
        snprintf(key, sizeof key, "%.*s", (int)(name + index), pair);
        const struct gm_parameter *row = name > 0 ? gm_scene_parameter(scene, key) : NULL;
        const bool one = row && is_changed(row, parameters);
        const bool all = !row && index > 0 && put_list(NULL, pair, name, is_list, scene, parameters);
        fwrite(text + from, 1, (one || all ? piece.begin : piece.end) - from, stream);
        if (one || (all && is_list)) {
            fprintf(stream, "%s = %s", key,
                    one ? gm_parameter_format(row, parameters, value, sizeof value) : "");
        }
        if (all) {
            put_list(stream, pair, name, is_list, scene, parameters);
        }
        from = piece.end;
    }
    return from;
}

char *gm_system_now(const struct gm_scene *scene, const void *parameters)
{
    /* before lanes: of one number, which a key sets; after them: of values */
    enum { DT, MEMBERS = 2, LANES = 5, PARAMETER, START, SPREAD };
    static const char *const lines[] = {"dt",    "until",     "members", "half_length", "points",
                                        "lanes", "parameter", "start",   "spread",      NULL};
    const struct gm_parameter *rows[LANES];
    bool put[LANES];
    char *text = NULL, number[GM_TEXT_SIZE];
    size_t size = 0, at = 0, from = 0;
    struct gm_text_line line;
    struct gm_fault fault;
    FILE *stream = open_memstream(&text, &size);
    for (size_t i = 0; i < LANES; i++) {
        rows[i] = gm_scene_parameter(scene, lines[i]);
        put[i] = rows[i] && is_changed(rows[i], parameters);
    }
    bool has_dt = !rows[DT]; /* a step size from a word or the formula has no line */
    if (stream && !strstr(scene->text, "geomint:")) {
        fputs("geomint: 1\n", stream);
    }
    while (stream && gm_lines_next(scene->text, strlen(scene->text), &at, &line, &fault)) {
        const size_t i = gm_span_among(scene->text, line.word, lines);
        const size_t values = line.value.begin + strcspn(scene->text + line.value.begin, ";#");
        const struct gm_span value =
            gm_span_trimmed(scene->text, (struct gm_span){line.value.begin,
                                                          values < line.value.end ? values : line.value.end});
        has_dt = has_dt || i == DT;
        if (i == LANES) { /* the words of lanes are one lane's */
            fwrite(scene->text + from, 1, line.word.begin - from, stream);
            from = at;
        } else if (i == PARAMETER || i == START ||
                   ((i == MEMBERS || i == SPREAD) &&
                    memchr(scene->text + value.begin, '=', value.end - value.begin))) {
            fwrite(scene->text + from, 1, value.begin - from, stream);
            from = put_values(stream, scene->text, value, scene, parameters);
            const size_t length = gm_name_length(scene->text + value.begin, value.end - value.begin);
            const struct gm_span key = {value.begin, value.begin + length};
            const size_t called = gm_span_among(scene->text, key, lines);
            if (called < LANES) {
                put[called] = false; /* a key of the system, called as the line of a field */
            }
        } else if (i < LANES && put[i]) { /* the range stays */
            fwrite(scene->text + from, 1, value.begin - from, stream);
            fputs(gm_parameter_format(rows[i], parameters, number, sizeof number), stream);
            from = value.end;
            put[i] = false;
        }
    }
    if (stream) {
        fputs(scene->text + from, stream);
    }
    for (size_t i = 0; stream && i < LANES; i++) {
        if (put[i] || (i == DT && !has_dt)) {
            fprintf(stream, "%s: %s\n", lines[i],
                    gm_parameter_format(rows[i], parameters, number, sizeof number));
        }
    }
    return stream && fclose(stream) == 0 ? text : NULL;
}
