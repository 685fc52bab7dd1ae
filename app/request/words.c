/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The words behind a scene's name: keys with lists of values, and their product. */
#include "app/request/words.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/request/arguments.h"
#include "core/formula/nearest.h"
#include "render/cells/text.h"
#include "render/message.h"

__attribute__((format(printf, 2, 3))) static bool refuse(char *message, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, GM_MESSAGE, format, arguments);
    va_end(arguments);
    return false;
}

const struct gm_common_key gm_common_keys[] = {
    {"scheme", "NAME,...", "a scheme or several; without it the scene's preferred ones", {NULL}},
    {"steps", "N", "instead of until: so many steps", {NULL}},
    {"zip", "yes", "lists of equal length are paired, instead of multiplied", {"no", "yes", NULL}},
    {"overlay", "yes", "all lanes in one panel", {"no", "yes", NULL}},
    {"equal",
     "cost",
     "every lane's dt is scaled so that all use as many evaluations as the first scheme",
     {"no", "cost", NULL}},
};
const size_t gm_common_key_count = sizeof gm_common_keys / sizeof gm_common_keys[0];

const struct gm_common_key *gm_common_key_find(const char *name)
{
    for (size_t i = 0; i < gm_common_key_count; i++) {
        if (strcmp(gm_common_keys[i].name, name) == 0) {
            return &gm_common_keys[i];
        }
    }
    return NULL;
}

static const char *key_name(size_t i, const void *data)
{
    const struct gm_scene *scene = data;
    if (i < scene->parameter_count) {
        return scene->parameters[i].key;
    }
    i -= scene->parameter_count;
    return i < gm_common_key_count ? gm_common_keys[i].name
                                   : gm_settings_parameters[i - gm_common_key_count].key;
}

void gm_words_close(struct gm_words *words)
{
    for (size_t i = 0; i < words->count; i++) {
        free(words->list[i].key);
        for (size_t k = 0; k < words->list[i].count; k++) {
            free(words->list[i].values[k]);
        }
    }
    words->count = 0;
}

static bool add_value(struct gm_word *list, const char *text, size_t length, char *message)
{
    if (length == 0) {
        return refuse(message, "%s= has an empty value", list->key);
    }
    if (list->count == GM_MOST_VALUES) {
        return refuse(message, "%s= has more than %d values", list->key, GM_MOST_VALUES);
    }
    list->values[list->count] = strndup(text, length);
    if (!list->values[list->count]) {
        return refuse(message, "not enough memory");
    }
    list->count++;
    return true;
}

static bool has_digits_alone(const char *text)
{
    return text[strspn(text, "0123456789")] == '\0';
}

/* Nobody writes a number of a list as 05. */
static bool begins_with_zero(const char *text)
{
    return text[0] == '0' && text[1] != '\0' && has_digits_alone(text);
}

bool gm_words_decimal_comma(const struct gm_word *list, size_t index, char *number, size_t size)
{
    const size_t first = index > 0 ? index - 1 : 0;
    if (first + 1 >= list->count) {
        return false;
    }
    const char *before = list->values[first] + (list->values[first][0] == '-');
    const char *behind = list->values[first + 1];
    if (!has_digits_alone(before) || !has_digits_alone(behind) ||
        (strcmp(before, "0") != 0 && !begins_with_zero(behind))) {
        return false;
    }
    snprintf(number, size, "%.20s.%.20s", list->values[first], behind);
    return true;
}

static bool known_key(const struct gm_scene *scene, const char *key)
{
    return gm_common_key_find(key) || gm_scene_parameter(scene, key) || gm_setting_find(key);
}

/* Whether a terminal would obey some of it. Bytes that are no UTF-8 (U+FFFD here) are not among that: a file
   may be called so. */
static bool has_orders(const char *word)
{
    for (uint32_t code; (code = gm_text_next(&word)) != 0;) {
        if (code != 0xFFFD && !gm_text_is_shown(code)) {
            return true;
        }
    }
    return false;
}

static bool read_word(struct gm_words *words, const struct gm_scene *scene, const char *word, char *message)
{
    const char *equals = strchr(word, '=');
    if (!equals || equals == word) {
        return refuse(message, "\"%.60s\" is not of the form key=value", word);
    }
    if (has_orders(word)) {
        return refuse(message, "\"%.60s\" holds a character that cannot be shown", word);
    }
    if (words->count == GM_MOST_WORDS) {
        return refuse(message, "more than %d keys", GM_MOST_WORDS);
    }
    struct gm_word *list = &words->list[words->count];
    *list = (struct gm_word){.key = strndup(word, (size_t)(equals - word))};
    if (!list->key) {
        return refuse(message, "not enough memory");
    }
    words->count++;
    if (!known_key(scene, list->key)) {
        const size_t names = gm_common_key_count + scene->parameter_count + gm_settings_parameter_count;
        const char *near = gm_nearest(list->key, names, key_name, scene);
        return refuse(message, "scene %s has no parameter \"%.40s\"%s%s", scene->name, list->key,
                      near ? "; did you mean " : "; see geomint list ", near ? near : scene->name);
    }
    for (size_t i = 0; i + 1 < words->count; i++) {
        if (strcmp(words->list[i].key, list->key) == 0) {
            return refuse(message, "%s= is given twice", list->key);
        }
    }
    const char *at = equals + 1;
    for (;;) {
        const char *comma = strchr(at, ',');
        if (!add_value(list, at, comma ? (size_t)(comma - at) : strlen(at), message)) {
            return false;
        }
        char number[48];
        if (begins_with_zero(list->values[list->count - 1]) &&
            gm_words_decimal_comma(list, list->count - 1, number, sizeof number)) {
            return refuse(message, "%s=%.60s: " GM_DECIMAL_POINT, list->key, equals + 1, number);
        }
        if (!comma) {
            return true;
        }
        at = comma + 1;
    }
}

const struct gm_word *gm_words_find(const struct gm_words *words, const char *key)
{
    for (size_t i = 0; i < words->count; i++) {
        if (strcmp(words->list[i].key, key) == 0) {
            return &words->list[i];
        }
    }
    return NULL;
}

size_t gm_words_choice(const struct gm_words *words, size_t i, size_t lane)
{
    if (words->list[i].count == 1) {
        return 0;
    }
    if (words->zip) {
        return lane;
    }
    for (size_t k = words->count - 1; k > i; k--) {
        lane /= words->list[k].count;
    }
    return lane % words->list[i].count;
}

bool gm_words_lanes(const struct gm_words *words, size_t *lanes, char *message)
{
    *lanes = 1;
    for (size_t i = 0; i < words->count; i++) {
        const size_t count = words->list[i].count;
        if (count == 1) {
            continue;
        }
        if (words->zip && *lanes > 1 && *lanes != count) {
            return refuse(message, "zip=yes pairs lists of equal length; %s= has %zu values, not %zu",
                          words->list[i].key, count, *lanes);
        }
        *lanes = words->zip ? count : *lanes * count;
        if (*lanes > GM_MOST_REQUESTED) {
            return refuse(message, "that makes more than %d lanes", GM_MOST_REQUESTED);
        }
    }
    return true;
}

/* The first `schemes` of the scene's preferred ones, as if they had been typed in front. */
static bool prefer(struct gm_words *words, const struct gm_scene *scene, size_t schemes, char *message)
{
    if (gm_words_find(words, "scheme")) {
        return true;
    }
    if (words->count == GM_MOST_WORDS) {
        return refuse(message, "more than %d keys", GM_MOST_WORDS);
    }
    struct gm_word list = {.key = strdup("scheme")};
    bool good = list.key != NULL;
    for (size_t i = 0; good && i < schemes && scene->schemes[i]; i++) {
        good = add_value(&list, scene->schemes[i], strlen(scene->schemes[i]), message);
    }
    memmove(&words->list[1], &words->list[0], words->count * sizeof words->list[0]);
    words->list[0] = list;
    words->count++;
    return good || refuse(message, "not enough memory");
}

/* Those of the common keys that are not the lane's have one value, of their choices. */
static bool check_choices(const struct gm_words *words, char *message)
{
    for (size_t i = 0; i < gm_common_key_count; i++) {
        const struct gm_common_key *key = &gm_common_keys[i];
        const struct gm_word *word = key->choices[0] ? gm_words_find(words, key->name) : NULL;
        if (word && (word->count > 1 || (strcmp(word->values[0], key->choices[0]) != 0 &&
                                         strcmp(word->values[0], key->choices[1]) != 0))) {
            return refuse(message, "%s= is one of: %s, %s", key->name, key->choices[0], key->choices[1]);
        }
    }
    return true;
}

bool gm_words_chosen(const struct gm_words *words, const char *key)
{
    const struct gm_word *word = gm_words_find(words, key);
    return word && strcmp(word->values[0], gm_common_key_find(key)->choices[1]) == 0;
}

bool gm_words_read(struct gm_words *words, const struct gm_scene *scene, int count, char *const typed[],
                   size_t schemes, char *message)
{
    memset(words, 0, sizeof *words);
    for (int i = 0; i < count; i++) {
        if (!read_word(words, scene, typed[i], message)) {
            return false;
        }
    }
    if (!check_choices(words, message) || !prefer(words, scene, schemes, message)) {
        return false;
    }
    words->zip = gm_words_chosen(words, "zip");
    return true;
}

char *gm_words_join(const struct gm_scene *scene, const struct gm_words *words)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    fputs(scene->name, stream);
    for (size_t i = 0; i < words->count; i++) {
        fprintf(stream, " %s=", words->list[i].key);
        for (size_t k = 0; k < words->list[i].count; k++) {
            fputs(k ? "," : "", stream);
            gm_arguments_put(stream, words->list[i].values[k]);
        }
    }
    fclose(stream);
    return text;
}
