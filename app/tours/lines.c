/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of a tour: "word: text", or more of the text above. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/request/nearest.h"
#include "app/tours/reader.h"
#include "render/cells/text.h"

const char *const gm_tour_word_names[GM_TOUR_WORDS] = {"title", "about",  "place", "step",  "say",
                                                       "ask",   "answer", "show",  "until", "seconds",
                                                       "at",    "study",  "watch", "try"};

bool gm_tour_refuse(struct gm_tour_reader *reader, long line, const char *format, ...)
{
    char sentence[GM_MESSAGE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    snprintf(reader->message, GM_MESSAGE, "%.100s, line %ld: %.380s", reader->name, line, sentence);
    return false;
}

bool gm_tour_short_of_memory(struct gm_tour_reader *reader)
{
    snprintf(reader->message, GM_MESSAGE, "not enough memory");
    return false;
}

static const char *word_name(size_t i, const void *data)
{
    return (void)data, gm_tour_word_names[i];
}

static bool is_blank(char letter)
{
    return letter == ' ' || letter == '\t';
}

/* Letters that a terminal would take for orders, and bytes that are no letters. */
static bool is_readable(const char *text)
{
    for (uint32_t code; (code = gm_text_next(&text)) != 0;) {
        if (code != '\t' && !gm_text_is_shown(code)) {
            return false;
        }
    }
    return true;
}

static bool add_entry(struct gm_tour_reader *reader, enum gm_tour_word word, long line, const char *text)
{
    struct gm_tour_entry *more = realloc(reader->entries, (reader->count + 1) * sizeof *more);
    if (!more) {
        return gm_tour_short_of_memory(reader);
    }
    reader->entries = more;
    more[reader->count] = (struct gm_tour_entry){word, line, strdup(text)};
    return more[reader->count++].text || gm_tour_short_of_memory(reader);
}

/* A line that begins with a blank goes on with the text above. */
static bool continue_entry(struct gm_tour_reader *reader, long line, const char *text)
{
    if (reader->count == 0) {
        return gm_tour_refuse(reader, line,
                              "it begins with a blank, but there is no text above to go on with");
    }
    struct gm_tour_entry *last = &reader->entries[reader->count - 1];
    char *longer = NULL;
    if (asprintf(&longer, "%s%s%s", last->text, last->text[0] ? " " : "", text) < 0) {
        return gm_tour_short_of_memory(reader);
    }
    free(last->text);
    last->text = longer;
    return true;
}

static bool read_line(struct gm_tour_reader *reader, long line, char *text)
{
    size_t length = strlen(text);
    while (length > 0 && (is_blank(text[length - 1]) || text[length - 1] == '\r')) {
        text[--length] = '\0';
    }
    if (!is_readable(text)) {
        return gm_tour_refuse(reader, line, "it holds something that is no letter of UTF-8");
    }
    const char *at = text;
    while (is_blank(*at)) {
        at++;
    }
    if (*at == '\0' || *at == '#') {
        return true;
    }
    if (at > text) {
        return continue_entry(reader, line, at);
    }
    const char *colon = strchr(text, ':');
    if (!colon) {
        return gm_tour_refuse(reader, line,
                              "it is neither \"word: text\" nor, beginning with a blank, more of it");
    }
    char word[32];
    snprintf(word, sizeof word, "%.*s", (int)(colon - text < 31 ? colon - text : 31), text);
    for (size_t i = 0; i < GM_TOUR_WORDS; i++) {
        if (strcmp(gm_tour_word_names[i], word) == 0) {
            at = colon + 1;
            while (is_blank(*at)) {
                at++;
            }
            return add_entry(reader, (enum gm_tour_word)i, line, at);
        }
    }
    const char *near = gm_nearest(word, GM_TOUR_WORDS, word_name, NULL);
    return gm_tour_refuse(reader, line, "a tour has no word \"%s:\"%s%s%s", word,
                          near ? "; did you mean " : "", near ? near : "", near ? ":" : "");
}

bool gm_tour_read_lines(struct gm_tour_reader *reader, const char *text, size_t size)
{
    long line = 1;
    bool good = true;
    while (good && size > 0) {
        const char *end = memchr(text, '\n', size);
        const size_t length = end ? (size_t)(end - text) : size;
        if (memchr(text, '\0', length)) {
            return gm_tour_refuse(reader, line, "it holds a byte 0, so this is no text");
        }
        char *copy = strndup(text, length);
        if (!copy) {
            return gm_tour_short_of_memory(reader);
        }
        good = read_line(reader, line++, copy);
        free(copy);
        text += length + (end != NULL);
        size -= length + (end != NULL);
    }
    return good;
}

bool gm_tour_read_number(struct gm_tour_reader *reader, const struct gm_tour_entry *entry, double *value)
{
    if (!gm_number_parse(entry->text, value) || !isfinite(*value)) {
        return gm_tour_refuse(reader, entry->line, "\"%.60s\" is not a number", entry->text);
    }
    return true;
}

bool gm_tour_take_text(struct gm_tour_reader *reader, const struct gm_tour_entry *entry, char **place)
{
    if (!entry->text[0]) {
        return gm_tour_refuse(reader, entry->line,
                              "there is no text after %s:", gm_tour_word_names[entry->word]);
    }
    if (*place) {
        return gm_tour_refuse(reader, entry->line, "%s: is given twice", gm_tour_word_names[entry->word]);
    }
    *place = strdup(entry->text);
    return *place || gm_tour_short_of_memory(reader);
}
