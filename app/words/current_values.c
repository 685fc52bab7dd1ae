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

/* The number of the word that a line begins with, or `count`. */
static size_t word_of(const char *line, const char *const *words, size_t count)
{
    size_t i = 0;
    while (i < count && (strncmp(line, words[i], strlen(words[i])) != 0 || line[strlen(words[i])] != ':')) {
        i++;
    }
    return i;
}

char *gm_system_now(const struct gm_scene *scene, const void *parameters)
{
    static const char *const words[] = {"dt",          "until",  "members",
                                        "half_length", "points", /* one number, */
                                        "parameter",   "start",  "lanes"};
    enum { NUMBERS = 5, VALUED = 7, DT = 0 };
    char *text = NULL;
    bool given[NUMBERS] = {false};
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (stream && !strstr(scene->text, "geomint:")) {
        fputs("geomint: 1\n", stream);
    }
    for (const char *line = scene->text, *next; stream && *line; line = next) {
        next = gm_system_lines_end(line);
        const size_t word = word_of(line, words, GM_COUNT(words)), length = (size_t)(next - line);
        const size_t key = word < VALUED ? strlen(words[word]) + 1 : 0;
        size_t values = key > 0 ? strcspn(line, ";#") : 0;
        values = values < length ? values : length;
        while (values > key && strchr(" \t\r\n", line[values - 1])) {
            values--;
        }
        const struct gm_parameter *row = word < NUMBERS ? gm_scene_parameter(scene, words[word]) : NULL;
        char number[GM_TEXT_SIZE];
        if (word == VALUED) {
            continue; /* these words are one lane's */
        }
        fwrite(line, 1, key, stream);
        if (row && is_changed(row, parameters)) {
            fprintf(stream, " %s", gm_parameter_format(row, parameters, number, sizeof number));
        } else if (word < NUMBERS) {
            fwrite(line + key, 1, values - key, stream);
        } else {
            put_values(stream, line + key, values - key, scene, parameters);
        }
        fwrite(line + values, 1, length - values, stream);
        if (word < NUMBERS) {
            given[word] = true;
        }
    }
    for (size_t i = 0; stream && i < NUMBERS; i++) {
        const struct gm_parameter *row = gm_scene_parameter(scene, words[i]);
        char number[GM_TEXT_SIZE];
        /* dt of a word, or by the formula */
        if (row && !given[i] && (i == DT || is_changed(row, parameters))) {
            fprintf(stream, "%s: %s\n", words[i],
                    gm_parameter_format(row, parameters, number, sizeof number));
        }
    }
    return stream && fclose(stream) == 0 ? text : NULL;
}
