/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Words that take the place of a file's formulas, and such formulas as words. */
#include "app/words/replacing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"

const char *const gm_replacing_keys[] = {"H", "L", "V", "rate", "bracket", "S", "K-matrix", "L-matrix", NULL};

/* What a formula is of: "x" of a rate, "x y" of a bracket, nothing of H and L, without blanks. */
static void subject_of(const char *key, const char *value, size_t length, char *subject, size_t size)
{
    size_t used = 0;
    const bool has_one = key[0] == 'r' || key[0] == 'b';
    for (size_t i = 0; has_one && i < length && value[i] != '=' && used + 1 < size; i++) {
        if (value[i] != ' ' && value[i] != '\t') {
            subject[used++] = value[i];
        }
    }
    subject[used] = '\0';
}

/* The word that takes the place of a line of this key and value; -1: none. */
static int replacing_word(int count, char *const words[], const char *key, const char *value, size_t length)
{
    char wanted[128], subject[128];
    subject_of(key, value, length, wanted, sizeof wanted);
    for (int i = 1; i < count; i++) {
        const char *typed = gm_word_after(words[i], key, strlen(key));
        if (typed) {
            subject_of(key, typed, strlen(typed), subject, sizeof subject);
            if (strcmp(subject, wanted) == 0) {
                return i;
            }
        }
    }
    return -1;
}

/* The key of a line, of those that words replace; NULL: it has another one. */
static const char *key_of_line(const char *line)
{
    for (size_t k = 0; gm_replacing_keys[k]; k++) {
        const size_t length = strlen(gm_replacing_keys[k]);
        if (strncmp(line, gm_replacing_keys[k], length) == 0 &&
            line[length + strspn(line + length, " \t")] == ':') {
            return gm_replacing_keys[k];
        }
    }
    return NULL;
}

bool gm_replacing_has(const char *text, const char *word)
{
    for (const char *line = text; *line; line = gm_system_lines_end(line)) {
        const char *key = key_of_line(line);
        if (key && gm_word_after(word, key, strlen(key))) {
            const char *value = strchr(line, ':') + 1;
            char *const words[] = {NULL, (char *)word};
            if (replacing_word(2, words, key, value, (size_t)(gm_system_lines_end(line) - value)) == 1) {
                return true;
            }
        }
    }
    return false;
}

bool gm_replacing_lines(struct gm_system_lines *written, int count, char *const words[])
{
    char *text = NULL, *before = written->text;
    size_t size = 0;
    FILE *lines = open_memstream(&text, &size);
    written->length = 0;
    for (const char *line = before, *next; lines && *line; line = next) {
        next = gm_system_lines_end(line);
        const char *key = key_of_line(line), *value = key ? strchr(line, ':') + 1 : NULL;
        const int word = key ? replacing_word(count, words, key, value, (size_t)(next - value)) : -1;
        if (word < 0) {
            gm_system_lines_put(written, lines, line, (size_t)(next - line));
            continue;
        }
        gm_system_lines_put(written, lines, key, strlen(key));
        gm_system_lines_put(written, lines, ": ", 2);
        gm_system_lines_put_word(written, lines, words, word, strlen(key) + 1,
                                 strlen(words[word]) - strlen(key) - 1);
        gm_system_lines_put(written, lines, "\n", 1);
    }
    if (!lines || fclose(lines) != 0) {
        free(text);
        return false;
    }
    free(before);
    written->text = text;
    return true;
}

bool gm_replacing_words(const char *text, struct gm_arguments *words)
{
    bool good = true;
    for (const char *line = text; good && *line; line = gm_system_lines_end(line)) {
        const char *key = key_of_line(line);
        if (!key) {
            continue;
        }
        char *word = NULL;
        size_t size = 0;
        FILE *stream = open_memstream(&word, &size);
        bool blank = false, some = false, comment = false;
        if (stream) {
            fprintf(stream, "%s=", key);
        }
        for (const char *at = strchr(line, ':') + 1, *end = gm_system_lines_end(line); stream && at < end;
             at++) {
            comment = *at == '#' || (comment && *at != '\n');
            if (*at == ' ' || *at == '\t' || *at == '\n' || comment) {
                blank = true;
                continue;
            }
            if (blank && some) {
                fputc(' ', stream);
            }
            fputc(*at, stream);
            blank = false;
            some = true;
        }
        good = stream && fclose(stream) == 0 && gm_arguments_add(words, word);
        free(word);
    }
    return good;
}
