/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A system as it is now, with the values that its keys have. */
#include "app/words/current_values.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/words/lines.h"
#include "core/basics.h"
#include "core/expression/reader.h"
#include "scenes/common/scene.h"

static bool is_changed(const struct gm_parameter *row, const void *parameters)
{
    char value[GM_TEXT_SIZE];
    return strcmp(gm_parameter_format(row, parameters, value, sizeof value), row->standard) != 0;
}

/* The elements of a list as they are now, "x[1] = 2, x[2] = 3", or "2, 3" of one whose text names them;
   false, and nothing, where they are as the text has them. */
static bool put_list(FILE *stream, const char *name, size_t length, bool named, const struct gm_scene *scene,
                     const void *parameters)
{
    bool changed = false;
    const char *before = "";
    for (int pass = 0; pass < 1 + changed; pass++) {
        for (size_t i = 0; i < scene->parameter_count; i++) {
            const struct gm_parameter *row = &scene->parameters[i];
            if (strncmp(row->key, name, length) != 0 || row->key[length] != '[') {
                continue;
            }
            changed = changed || is_changed(row, parameters);
            if (pass == 1) {
                char value[GM_TEXT_SIZE];
                fprintf(stream, "%s%s%s%s", before, named ? "" : row->key, named ? "" : " = ",
                        gm_parameter_format(row, parameters, value, sizeof value));
                before = ", ";
            }
        }
    }
    return changed;
}

/* Puts "NAME = formula" pairs, with the value in place of the formula where it is another one than usual. */
static void put_values(FILE *stream, const char *text, size_t length, const struct gm_scene *scene,
                       const void *parameters)
{
    static const char blanks[] = " \t\r\n";
    for (size_t at = 0; at < length;) {
        const size_t blank = strspn(text + at, blanks),
                     name = gm_name_length(text + at + blank, length - at - blank), begin = at + blank;
        const size_t index = text[begin + name] == '[' ? strcspn(text + begin + name, "]") + 1 : 0,
                     equals = begin + name + index + strspn(text + begin + name + index, blanks);
        /* "m[1..N] = 1, 2, 3" holds its commas */
        const bool is_list = index > 0 && memmem(text + begin + name, index, "..", 2);
        size_t end = is_list ? length : at;
        for (int depth = 0; end < length && (depth > 0 || text[end] != ','); end++) {
            depth += (text[end] == '(' || text[end] == '[') - (text[end] == ')' || text[end] == ']');
        }
        end += end < length;
        char key[64], value[GM_TEXT_SIZE];
        snprintf(key, sizeof key, "%.*s", (int)(name + index), text + begin);
        const struct gm_parameter *row = name > 0 ? gm_scene_parameter(scene, key) : NULL;
        fwrite(text + at, 1, blank, stream);
        if (name > 0 && equals < length && text[equals] == '=' && row && is_changed(row, parameters)) {
            fprintf(stream, "%s = %s%s", key, gm_parameter_format(row, parameters, value, sizeof value),
                    text[end - 1] == ',' ? "," : "");
        } else if (is_list) {
            fwrite(text + begin, 1, equals + 1 - begin, stream);
            fputc(' ', stream);
            if (!put_list(stream, text + begin, name, true, scene, parameters)) {
                fwrite(text + equals + 1, 1, end - equals - 1, stream);
            }
        } else if (row || index == 0 || !put_list(stream, text + begin, name, false, scene, parameters)) {
            fwrite(text + begin, 1, end - begin, stream);
        } else if (text[end - 1] == ',') {
            fputc(',', stream);
        }
        at = end;
    }
}

static bool has_line(const char *text, const char *word)
{
    const size_t letters = strlen(word);
    for (const char *line = text; *line; line = gm_system_lines_end(line)) {
        if (strncmp(line, word, letters) == 0 && line[letters] == ':') {
            return true;
        }
    }
    return false;
}

char *gm_system_now(const struct gm_scene *scene, const void *parameters)
{
    static const char *const valued[] = {"parameter:", "start:", NULL};
    static const char *const lines[] = {"dt", "until", "members", "half_length",
                                        "points"}; /* of one number, which a key sets */
    enum { LINES = GM_COUNT(lines) };
    char *text = NULL, numbers[LINES][GM_TEXT_SIZE];
    bool other[LINES] = {false};
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    for (size_t i = 0; i < LINES; i++) {
        const struct gm_parameter *row = gm_scene_parameter(scene, lines[i]);
        other[i] =
            row && (strcmp(gm_parameter_format(row, parameters, numbers[i], sizeof numbers[i]),
                           row->standard) != 0 ||
                    (i == 0 && !has_line(scene->text, lines[i]))); /* dt of a word, or by the formula */
    }
    if (stream && !strstr(scene->text, "geomint:")) {
        fputs("geomint: 1\n", stream);
    }
    for (const char *line = scene->text, *next; stream && *line; line = next) {
        next = gm_system_lines_end(line);
        size_t k = 0;
        while (valued[k] && strncmp(line, valued[k], strlen(valued[k])) != 0) {
            k++;
        }
        const size_t key = valued[k] ? strlen(valued[k]) : 0, length = (size_t)(next - line);
        size_t values = key > 0 ? strcspn(line, ";#") : 0;
        values = values < length ? values : length;
        while (values > key && strchr(" \t\r\n", line[values - 1])) {
            values--;
        }
        bool replaced = strncmp(line, "lanes:", strlen("lanes:")) == 0; /* these words are one lane's */
        for (size_t i = 0; i < LINES; i++) {
            const size_t letters = strlen(lines[i]);
            replaced |= other[i] && strncmp(line, lines[i], letters) == 0 && line[letters] == ':';
        }
        if (replaced) {
            continue;
        }
        fwrite(line, 1, key, stream);
        put_values(stream, line + key, values - key, scene, parameters);
        fwrite(line + values, 1, length - values, stream);
    }
    for (size_t i = 0; stream && i < LINES; i++) {
        if (other[i]) {
            fprintf(stream, "%s: %s\n", lines[i], numbers[i]);
        }
    }
    return stream && fclose(stream) == 0 ? text : NULL;
}
