/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Texts of words and values, split into lines. */
#include "core/expression/lines.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/nearest.h"

static bool is_blank(char character)
{
    return character == ' ' || character == '\t' || character == '\n' || character == '\r';
}

struct gm_span gm_span_trimmed(const char *text, struct gm_span span)
{
    while (span.begin < span.end && (is_blank(text[span.begin]) || text[span.begin] == '#')) {
        if (text[span.begin] == '#') {
            const char *newline = memchr(text + span.begin, '\n', span.end - span.begin);
            span.begin = newline ? (size_t)(newline - text) : span.end;
        } else {
            span.begin++;
        }
    }
    while (span.end > span.begin && is_blank(text[span.end - 1])) {
        span.end--;
    }
    return span;
}

bool gm_lines_are_text(const char *text, size_t length, struct gm_fault *fault)
{
    const size_t valid = gm_text_valid(text, length);
    if (valid < length) {
        return gm_fail(fault, valid,
                       text[valid] ? "the byte 0x%02x is not UTF-8" : "a byte is 0: this is not text",
                       (unsigned char)text[valid]);
    }
    for (size_t i = 0; i + 1 < length; i++) {
        if (text[i] == '\r' && text[i + 1] != '\n' && text[i + 1] != '\r') {
            return gm_fail(fault, i, "a carriage return alone ends no line: lines end with a newline");
        }
    }
    return true;
}

/* Refuses a line without a colon, in the notation of other programs if it is in one: x' = -x, dx/dt = -x,
   wiener w, global 1 x {y = 0}. */
static bool refuse(const char *text, struct gm_span span, size_t place, struct gm_fault *fault)
{
    const size_t equals = gm_span_until(text, span, "=");
    const char *line = text + span.begin, *newline = memchr(line, '\n', span.end - span.begin);
    const int length = (int)((newline ? newline : text + span.end) - line);
    const struct gm_span left = gm_span_trimmed(text, (struct gm_span){span.begin, equals});
    const bool ratio =
                   left.end - left.begin > 4 && line[0] == 'd' && memcmp(text + left.end - 3, "/dt", 3) == 0,
               dash = left.end - left.begin > 1 && text[left.end - 1] == '\'';
    const struct gm_span name = {left.begin + ratio, left.end - (ratio ? 3 : 1)};
    char word[16];
    snprintf(word, sizeof word, "%.*s", (int)gm_name_length(line, (size_t)length), line);
    if (equals < span.end && (ratio || dash) &&
        gm_name_length(text + name.begin, name.end - name.begin) == name.end - name.begin) {
        const char *formula = text + equals;
        const int rest = (int)(line + length - formula);
        return gm_fail(fault, span.begin, "%.*s is written rate: %.*s %.*s", length < 100 ? length : 100,
                       line, (int)(name.end - name.begin), text + name.begin, rest < 100 ? rest : 100,
                       formula);
    }
    if (gm_is_random(word)) {
        return gm_fail(fault, span.begin, "%s", GM_NO_NOISE);
    }
    if (strcmp(word, "global") == 0) {
        return gm_fail(fault, span.begin,
                       "global is an event of other programs, which is written event: x = 0; y = ...");
    }
    return dash ? gm_fail(fault, span.begin, "x' = -x is written rate: x = -x")
                : gm_fail(fault, place,
                          "a line needs a word and a colon, or a blank in front to continue another");
}

static bool split(const char *text, struct gm_span span, struct gm_text_line *line, struct gm_fault *fault)
{
    size_t colon = span.begin;
    while (colon < span.end && text[colon] != ':' && !is_blank(text[colon]) && text[colon] != '#') {
        colon++;
    }
    if (colon == span.end || text[colon] != ':') {
        return refuse(text, span, colon, fault);
    }
    line->word = (struct gm_span){span.begin, colon};
    line->value = gm_span_trimmed(text, (struct gm_span){colon + 1, span.end});
    return true;
}

bool gm_lines_next(const char *text, size_t length, size_t *at, struct gm_text_line *line,
                   struct gm_fault *fault)
{
    *fault = (struct gm_fault){0};
    *at += *at == 0 && gm_text_has_mark(text, length) ? GM_TEXT_MARK : 0;
    while (*at < length) {
        const size_t begin = *at;
        size_t end = begin, next = begin;
        /* a line, and those behind it that begin with a blank, with empty lines and comments between them */
        do {
            const bool more = next == begin || text[next] == ' ' || text[next] == '\t';
            const char *newline = memchr(text + next, '\n', length - next);
            next = newline ? (size_t)(newline - text) + 1 : length;
            end = more ? next : end;
        } while (next < length && strchr(" \t\r\n#", text[next]));
        const struct gm_span span = gm_span_trimmed(text, (struct gm_span){begin, end});
        *at = span.begin == span.end ? next : end;
        if (span.begin == span.end) {
            continue;
        }
        if (span.begin > begin && (text[begin] == ' ' || text[begin] == '\t')) {
            return gm_fail(fault, span.begin, "this line continues another, but it is the first");
        }
        return split(text, (struct gm_span){span.begin, end}, line, fault);
    }
    return false;
}

/* The word number `i`; "" if it is of another kind. */
static const char *word_at(size_t i, const void *data)
{
    const struct gm_line_words *words = data;
    return words->kinds == 0 || words->kinds & words->list[i].kinds ? words->list[i].word : "";
}

size_t gm_line_word(const struct gm_line_words *words, const char *text, struct gm_span word)
{
    size_t i = 0;
    while (i < words->count && !gm_span_is(text, word, word_at(i, words))) {
        i++;
    }
    return i;
}

bool gm_line_find(const struct gm_line_words *words, const char *text, const struct gm_text_line *line,
                  size_t *word, struct gm_fault *fault)
{
    const size_t letters = line->word.end - line->word.begin;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)(letters < 60 ? letters : 60), text + line->word.begin);
    *word = gm_line_word(words, text, line->word);
    if (*word == words->count && gm_is_random(name)) {
        return gm_fail(fault, line->word.begin, "%s", GM_NO_NOISE);
    }
    if (*word == words->count) {
        const char *near = gm_nearest(name, words->count, word_at, words);
        return gm_fail(fault, line->word.begin, "%s has no line \"%s\"%s%s", words->kind, name,
                       near ? "; did you mean " : words->help, near ? near : "");
    }
    return line->value.begin < line->value.end ||
           gm_fail(fault, line->word.end + 1, "%s: has no value", name);
}

bool gm_span_is(const char *text, struct gm_span span, const char *word)
{
    return span.end - span.begin == strlen(word) && memcmp(text + span.begin, word, strlen(word)) == 0;
}

size_t gm_span_until(const char *text, struct gm_span span, const char *separator)
{
    int depth = 0;
    const size_t width = strlen(separator);
    for (size_t i = span.begin; i < span.end; i++) {
        const char here = text[i];
        if (here == '#') {
            const char *newline = memchr(text + i, '\n', span.end - i);
            i = newline ? (size_t)(newline - text) : span.end - 1;
        } else if (depth == 0 && i + width <= span.end && memcmp(text + i, separator, width) == 0) {
            return i;
        }
        depth += (here == '(' || here == '[') - (here == ')' || here == ']');
    }
    return span.end;
}

bool gm_span_take(const char *text, struct gm_span *rest, const char *separator, struct gm_span *piece)
{
    if (rest->begin >= rest->end) {
        *piece = (struct gm_span){rest->begin, rest->begin};
        return false;
    }
    const size_t end = gm_span_until(text, *rest, separator);
    *piece = gm_span_trimmed(text, (struct gm_span){rest->begin, end});
    rest->begin = end < rest->end ? end + strlen(separator) : end;
    return true;
}

size_t gm_span_among(const char *text, struct gm_span span, const char *const *words)
{
    size_t k = 0;
    while (words[k] && !gm_span_is(text, span, words[k])) {
        k++;
    }
    return k;
}

char *gm_span_words(const char *text, struct gm_span span)
{
    char *words = malloc(span.end - span.begin + 1), *out = words;
    if (!words) {
        return NULL;
    }
    for (struct gm_span rest = gm_span_trimmed(text, span); rest.begin < rest.end;
         rest = gm_span_trimmed(text, rest)) {
        while (rest.begin < rest.end && !is_blank(text[rest.begin]) && text[rest.begin] != '#') {
            *out++ = text[rest.begin++];
        }
        *out++ = ' ';
    }
    out[out > words ? -1 : 0] = '\0';
    return words;
}
