/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The words after a scene's name: keys with lists of values, which may be ranges, and their product. */
#include "app/words/words.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/words/names.h"
#include "core/aliases.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/expression/nearest.h"
#include "core/functions/functions.h"
#include "core/model/scope.h"
#include "core/parameter.h"
#include "core/schemes.h"
#include "render/cells/text.h"
#include "render/message.h"

size_t gm_word_first(const char *value)
{
    int depth = 0;
    size_t length = 0;
    for (; value[length]; length++) {
        const char here = value[length];
        depth += (here == '(' || here == '[') - (here == ')' || here == ']');
        if (depth == 0 && (here == ',' || (here == '.' && value[length + 1] == '.'))) {
            break;
        }
    }
    return length;
}

static double to_15_digits(double value)
{
    char text[32];
    snprintf(text, sizeof text, "%.15g", value);
    return strtod(text, NULL);
}

/* Value `index`, 0 <= index < count. The ends are as typed; between them 0.3 is the double read from
   "0.3", not its neighbour, and values by equal factors have 15 digits: a printed value can be typed. */
static double value_in(const struct gm_range *range, size_t index)
{
    const double last = (double)(range->count - 1), at = (double)index;
    if (index == 0 || index + 1 == range->count) {
        return index == 0 ? range->first : range->last;
    }
    if (range->logarithmic) {
        return to_15_digits(range->first * gm_pow(range->last / range->first, at / last));
    }
    const double value = (range->first * (last - at) + range->last * at) / last;
    const double shorter = to_15_digits(value);
    return shorter == nextafter(value, shorter) ? shorter : value;
}

/* A piece of the text as a finite number. */
static bool read_end(const char *from, const char *to, double *value)
{
    char text[256];
    const size_t length = (size_t)(to - from);
    if (length >= sizeof text) {
        return false;
    }
    memcpy(text, from, length);
    text[length] = '\0';
    return gm_number_parse(text, value) && isfinite(*value);
}

static const char *fault_of(const struct gm_range *range, bool whole)
{
    if (!(range->first < range->last)) {
        return "a range ends above its start";
    }
    if (range->logarithmic && !(range->first > 0 || range->last < 0)) {
        return "a range of equal factors does not lead through 0";
    }
    if (whole) {
        /* evenly, all are whole if two neighbours are; by equal factors, few can be */
        const size_t tried = range->logarithmic ? range->count : 2;
        for (size_t i = 0; i < tried; i++) {
            const double value = value_in(range, i);
            if (value != floor(value)) {
                return "not all values of this range are whole numbers";
            }
        }
    }
    return NULL;
}

/* Reads "END..END:COUNT" or "END..END:logCOUNT" with ends for gm_number_parse, or leaves the body. `whole`:
   its values must be whole numbers. */
static void parse_range(struct gm_arena *arena, struct gm_range *range, const char *key, const char *text,
                        bool whole)
{
    const char *between = strstr(text, ".."), *colon = strrchr(text, ':');
    const char *fault = "a range is START..END:COUNT, or START..END:logCOUNT for equal factors";
    double count = NAN;
    *range = (struct gm_range){0};
    if (between && colon && colon > between) {
        range->logarithmic = strncmp(colon + 1, "log", 3) == 0;
        const char *number = colon + 1 + (range->logarithmic ? 3 : 0);
        if (!read_end(text, between, &range->first) || !read_end(between + 2, colon, &range->last)) {
            fault = "the ends of a range are numbers";
        } else if (!gm_number_parse(number, &count) || !(count >= 2 && count <= 1e15) ||
                   count != floor(count)) {
            fault = "a range has a whole number of values, from 2 to 1e15";
        } else {
            range->count = (size_t)count;
            fault = fault_of(range, whole);
        }
    }
    gm_arena_refuse_if(arena, fault, "%s=%.80s: %s", key, text, fault);
}

const struct gm_common_key gm_common_keys[] = {
    {"scheme", "NAME,...", "a scheme or several; without it the scene's preferred ones", {NULL}},
    {"steps", "N", "number of steps, instead of until", {NULL}},
    {"zip", "yes", "lists of equal length are paired, instead of multiplied", {"no", "yes", NULL}},
    {"overlay", "yes", "all lanes in one panel", {"no", "yes", NULL}},
    {"equal",
     "cost",
     "every lane's dt is scaled so that all use as many evaluations as the first scheme",
     {"no", "cost", NULL}},
};
const size_t gm_common_key_count = GM_COUNT(gm_common_keys);

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
    gm_arena_close(words->arena);
    *words = (struct gm_words){0};
}

static void add_value(struct gm_arena *arena, struct gm_word *list, const char *text, size_t length)
{
    const size_t blanks = strspn(text, " "); /* scheme='rk4, verlet' */
    text += blanks < length ? blanks : length;
    length -= blanks < length ? blanks : length;
    gm_arena_refuse_if(arena, length == 0, "%s= has an empty value", list->key);
    if (list->piece_count == GM_MOST_PIECES) {
        gm_arena_refuse(arena, "%s= has more than %d values; a range, 0..1:%d, has any number", list->key,
                        GM_MOST_PIECES, 2 * GM_MOST_PIECES);
    }
    list->pieces[list->piece_count++] =
        (struct gm_word_piece){.text = gm_arena_print(arena, "%.*s", (int)length, text)};
    list->count++;
}

const struct gm_parameter *gm_word_parameter(const struct gm_scene *scene, const char *key)
{
    const struct gm_parameter *row = gm_scene_parameter(scene, key);
    return row ? row : gm_setting_find(key);
}

bool gm_word_is_number(const struct gm_scene *scene, const char *key)
{
    const struct gm_parameter *row = gm_word_parameter(scene, key);
    return strcmp(key, "steps") == 0 || (row && (row->type == GM_REAL || row->type == GM_INTEGER));
}

/* Replaces the last piece of a list of numbers by its values, if it is a range. */
static void read_range(struct gm_arena *arena, struct gm_word *list, const struct gm_scene *scene)
{
    struct gm_word_piece *piece = &list->pieces[list->piece_count - 1];
    /* ".." has precedence over numbers */
    if (piece->text[gm_word_first(piece->text)] == '.' && gm_word_is_number(scene, list->key)) {
        const struct gm_parameter *row = gm_word_parameter(scene, list->key);
        const bool whole = !row || row->type == GM_INTEGER; /* steps= has no row */
        parse_range(arena, &piece->range, list->key, piece->text, whole);
        list->count += piece->range.count - 1;
    }
}

/* The piece that value `index` belongs to, and the index within it. */
static const struct gm_word_piece *piece_of(const struct gm_word *list, size_t *index)
{
    const struct gm_word_piece *piece = list->pieces;
    for (;; piece++) {
        const size_t count = piece->range.count ? piece->range.count : 1;
        if (*index < count) {
            return piece;
        }
        *index -= count;
    }
}

const char *gm_word_value(const struct gm_word *list, size_t index, char *text)
{
    const struct gm_word_piece *piece = piece_of(list, &index);
    if (piece->range.count == 0) {
        return piece->text;
    }
    const double value = value_in(&piece->range, index);
    for (int digits = 15; digits <= 17; digits++) { /* most have 15 */
        snprintf(text, GM_TEXT_SIZE, "%.*g", digits, value);
        if (strtod(text, NULL) == value) {
            break;
        }
    }
    return text;
}

const char *gm_word_name(const struct gm_word *list, size_t index, char *text)
{
    enum { SHORT = 8 };
    const char *word = gm_word_value(list, index, text);
    const double value = strtod(word, NULL);
    if (word == text && strlen(gm_number_format(value, text, GM_TEXT_SIZE)) > SHORT) { /* one of a range */
        snprintf(text, GM_TEXT_SIZE, "%.6g", value);
    }
    return word;
}

static bool has_digits_alone(const char *text)
{
    return text[strspn(text, "0123456789")] == '\0';
}

/* Returns true for 05 and similar, which lists do not have. */
static bool begins_with_zero(const char *text)
{
    return text[0] == '0' && text[1] != '\0' && has_digits_alone(text);
}

bool gm_words_decimal_comma(const struct gm_word *list, size_t index, char *number, size_t size)
{
    const size_t first = index > 0 ? index - 1 : 0;
    if (first + 1 >= list->piece_count) {
        return false;
    }
    const char *typed = list->pieces[first].text;
    const char *before = typed + (typed[0] == '-');
    const char *behind = list->pieces[first + 1].text;
    if (!has_digits_alone(before) || !has_digits_alone(behind) ||
        (strcmp(before, "0") != 0 && !begins_with_zero(behind))) {
        return false;
    }
    snprintf(number, size, "%.20s.%.20s", typed, behind);
    return true;
}

static bool known_key(const struct gm_scene *scene, const char *key)
{
    return gm_common_key_find(key) || gm_word_parameter(scene, key);
}

/* Returns true if a terminal would obey a part of the word. Bytes that are not UTF-8 (U+FFFD here) are
   allowed: file names may have them. */
static bool has_orders(const char *word)
{
    for (uint32_t code; (code = gm_text_next(&word)) != 0;) {
        if (code != 0xFFFD && !gm_text_is_shown(code)) {
            return true;
        }
    }
    return false;
}

/* The next comma outside of parentheses; NULL. */
static const char *next_comma(const char *text)
{
    int depth = 0;
    for (; *text; text++) {
        depth += (*text == '(') - (*text == ')');
        if (*text == ',' && depth <= 0) {
            return text;
        }
    }
    return NULL;
}

/* Returns true if the scene was already built with that word. */
static bool is_of_scene(const struct gm_scene *scene, const char *word)
{
    for (const char *const *own = scene->words; own && *own; own++) {
        if (strcmp(*own, word) == 0) {
            return true;
        }
    }
    return false;
}

/* Returns true if commas in the value do not separate values. */
static bool is_whole(const struct gm_parameter *row, const char *value)
{
    bool choices = row && row->choices;
    for (const char *at = value; choices && at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL) {
        const size_t length = strcspn(at, ",");
        bool met = false;
        for (size_t i = 0; row->choices[i]; i++) {
            met |= strncmp(row->choices[i], at, length) == 0 && strlen(row->choices[i]) == length;
        }
        choices = met;
    }
    return row && row->names && !choices;
}

/* The key, or the option, that an unknown key probably means; NULL: none. */
static const char *key_meant(const struct gm_scene *scene, const char *key)
{
    const struct gm_near *row;
    for (size_t i = 0; (row = gm_near_find(GM_NEAR_KEY, key, i)); i++) {
        if (known_key(scene, row->meant) || strncmp(row->meant, "--", 2) == 0) {
            return row->meant;
        }
    }
    const size_t names = gm_common_key_count + scene->parameter_count + gm_settings_parameter_count;
    return gm_nearest(key, names, key_name, scene);
}

void gm_words_assignment(const struct gm_scene *scene, const char *key, const char *value, char *text,
                         size_t size)
{
    const bool known = known_key(scene, key), named = gm_near_find(GM_NEAR_KEY, key, 0);
    const char *meant = known ? key : named ? key_meant(scene, key) : NULL;
    text[0] = '\0';
    if (meant) {
        snprintf(text, size, "; did you mean %.40s=%.40s", meant, value ? value : "");
    } else if (gm_scheme_find(key)) {
        snprintf(text, size, "; did you mean scheme=%.40s", key);
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

/* A list of values for a key, behind the others. */
static struct gm_word *new_list(struct gm_words *words, const char *key)
{
    gm_arena_refuse_if(words->arena, words->count == GM_MOST_WORDS, "more than %d keys", GM_MOST_WORDS);
    snprintf(words->refused, sizeof words->refused, "%s", key);
    words->list[words->count] = (struct gm_word){.key = key};
    return &words->list[words->count++];
}

/* Returns true for the word of lines of a system's file of which there may be many. */
static bool is_line(const char *key)
{
    size_t i = 0;
    while (i < GM_WORDS && strcmp(gm_system_words[i].word, key) != 0) {
        i++;
    }
    return i < GM_WORDS && gm_system_words[i].identity != GM_LINE_ONCE;
}

/* `next`: the word after it, or NULL. */
static void read_word(struct gm_words *words, const struct gm_scene *scene, const char *word,
                      const char *next)
{
    struct gm_arena *arena = words->arena;
    const char *equals = strchr(word, '=');
    if (!equals || equals == word) {
        char meant[128];
        gm_words_assignment(scene, word, next && !strchr(next, '=') ? next : NULL, meant, sizeof meant);
        gm_arena_refuse(arena, "\"%.60s\" is not of the form key=value%s", word, meant);
    }
    gm_arena_refuse_if(arena, has_orders(word), "\"%.60s\" holds a character that cannot be shown", word);
    struct gm_word *list = new_list(words, gm_arena_print(arena, "%.*s", (int)(equals - word), word));
    if (!known_key(scene, list->key)) {
        gm_arena_refuse_if(arena, scene->lacking && strcmp(scene->lacking, list->key) == 0, "%s",
                           scene->lacking_why);
        gm_arena_refuse_if(arena, is_line(list->key), "%.40s: is a line of a system's file, not a key",
                           list->key);
        const char *near = key_meant(scene, list->key);
        char typed[256];
        gm_arguments_tell_scene(scene, typed, sizeof typed);
        gm_arena_refuse(arena, "scene %s has no parameter \"%.40s\"%s%s", scene->name, list->key,
                        near ? "; did you mean " : "; see geomint list ", near ? near : typed);
    }
    gm_arena_refuse_if(arena, gm_words_find(words, list->key) != list, "%s= is given twice", list->key);
    const bool whole = is_whole(gm_scene_parameter(scene, list->key), equals + 1);
    for (const char *at = equals + 1, *comma = equals; comma; at = comma + 1) {
        comma = whole ? NULL : next_comma(at);
        add_value(arena, list, at, comma ? (size_t)(comma - at) : strlen(at));
        char number[48];
        const size_t last = list->piece_count - 1;
        gm_arena_refuse_if(arena,
                           begins_with_zero(list->pieces[last].text) &&
                               gm_words_decimal_comma(list, last, number, sizeof number),
                           "%s=%.60s: " GM_DECIMAL_POINT, list->key, equals + 1, number);
        read_range(arena, list, scene);
        if (!comma) {
            break;
        }
    }
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

bool gm_words_count(const struct gm_words *words, size_t most, size_t *runs, char *message)
{
    *runs = 1;
    for (size_t i = 0; i < words->count; i++) {
        const size_t count = words->list[i].count;
        if (count == 1) {
            continue;
        }
        if (words->zip && *runs > 1 && *runs != count) {
            return gm_refuse(message, "zip=yes pairs lists of equal length; %s= has %zu values, not %zu",
                             words->list[i].key, count, *runs);
        }
        if (count > most || (!words->zip && *runs > most / count)) {
            return gm_refuse(message, "that makes more than %zu %s", most,
                             most == GM_MOST_REQUESTED ? "lanes; geomint sweep takes any number" : "runs");
        }
        *runs = words->zip ? count : *runs * count;
    }
    return true;
}

/* The schemes that a scene prefers if these words are typed. */
static const struct gm_preference *preferred(const struct gm_scene *scene, int count, char *const typed[])
{
    for (const struct gm_preference *row = scene->preferences; row && row->word; row++) {
        for (int i = 0; i < count; i++) {
            if (strcmp(row->word, typed[i]) == 0) {
                return row;
            }
        }
    }
    return NULL;
}

/* Returns true if the typed words make a default word ineffective, such as rows with a mesh file. */
static bool is_idle(const struct gm_scene *scene, const struct gm_arguments *typed, const char *word)
{
    char key[64];
    void *self = gm_scene_defaults(scene);
    bool idle = strncmp(word, "scheme=", 7) == 0 && preferred(scene, typed->count, typed->words);
    for (int i = 1; self && i < typed->count; i++) {
        const char *value = strchr(typed->words[i], '=');
        snprintf(key, sizeof key, "%.*s", (int)strcspn(typed->words[i], "="), typed->words[i]);
        const struct gm_parameter *row = gm_scene_parameter(scene, key);
        if (row && value) {
            gm_parameter_set(row, self, value + 1); /* a list, or nonsense, is the request's to judge */
        }
    }
    snprintf(key, sizeof key, "%.*s", (int)strcspn(word, "="), word);
    idle |= self && gm_scene_idle(scene, self, key);
    free(self);
    return idle;
}

bool gm_words_complete(struct gm_arguments *words, const struct gm_scene *scene,
                       const struct gm_arguments *typed, const char *usual)
{
    struct gm_arguments arguments = {0};
    gm_arguments_split(&arguments, usual);
    gm_arguments_add(words, typed->words[0]);
    /* what the usual words pair with their schemes fits no others */
    const bool apart = gm_arguments_have(&arguments, "zip=yes") && gm_arguments_have(typed, "scheme=");
    for (int i = 0; i < arguments.count; i++) {
        const char *one = arguments.words[i], *word = gm_arguments_find(typed, one);
        const bool pair = strchr(one, ',') || strncmp(one, "zip=", 4) == 0;
        if (word || !(is_idle(scene, typed, one) || (apart && pair))) {
            gm_arguments_add(words, word ? word : one);
        }
    }
    for (int i = 1; i < typed->count; i++) { /* typed words without a place, or given twice */
        if (!gm_arguments_have(&arguments, typed->words[i]) ||
            gm_arguments_find(typed, typed->words[i]) != typed->words[i]) {
            gm_arguments_add(words, typed->words[i]);
        }
    }
    words->failed = words->failed || arguments.failed;
    gm_arguments_close(&arguments);
    return !words->failed;
}

/* Checks that each common key that is not a lane's has one value, one of its choices. */
static void check_choices(const struct gm_words *words)
{
    for (size_t i = 0; i < gm_common_key_count; i++) {
        const struct gm_common_key *key = &gm_common_keys[i];
        const struct gm_word *word = key->choices[0] ? gm_words_find(words, key->name) : NULL;
        gm_arena_refuse_if(words->arena,
                           word && (word->count > 1 || (strcmp(word->pieces[0].text, key->choices[0]) != 0 &&
                                                        strcmp(word->pieces[0].text, key->choices[1]) != 0)),
                           "%s= is one of: %s, %s", key->name, key->choices[0], key->choices[1]);
    }
}

bool gm_words_chosen(const struct gm_words *words, const char *key)
{
    const struct gm_word *word = gm_words_find(words, key);
    return word && strcmp(word->pieces[0].text, gm_common_key_find(key)->choices[1]) == 0;
}

/* Typed words while they are read. */
struct typing {
    struct gm_words *words;
    const struct gm_scene *scene;
    int count;
    char *const *typed;
    size_t schemes;
};

static void read_words(struct gm_arena *arena, void *data)
{
    const struct typing *typing = data;
    struct gm_words *words = typing->words;
    const struct gm_scene *scene = typing->scene;
    const struct gm_preference *preference = preferred(scene, typing->count, typing->typed);
    (void)arena;
    for (int i = 0; i < typing->count; i++) {
        if (!is_of_scene(scene, typing->typed[i])) {
            read_word(words, scene, typing->typed[i], i + 1 < typing->count ? typing->typed[i + 1] : NULL);
        }
    }
    struct gm_word *names = (struct gm_word *)gm_words_find(words, "scheme");
    for (size_t k = 0; names && k < names->piece_count; k++) {
        const char *name = gm_scheme_own_name(scene, names->pieces[k].text);
        names->pieces[k].text = gm_arena_print(words->arena, "%s", name);
    }
    check_choices(words);
    if (!names) { /* the preferred ones, as if they had been typed in front */
        const char *const *schemes = preference ? preference->schemes : scene->schemes;
        struct gm_word list = *new_list(words, "scheme");
        for (size_t i = 0; i < typing->schemes && schemes[i]; i++) {
            add_value(words->arena, &list, schemes[i], strlen(schemes[i]));
        }
        memmove(&words->list[1], &words->list[0], (words->count - 1) * sizeof words->list[0]);
        words->list[0] = list;
    }
    words->zip = gm_words_chosen(words, "zip");
}

bool gm_words_read(struct gm_words *words, const struct gm_scene *scene, int count, char *const typed[],
                   size_t schemes, char *message)
{
    struct typing typing = {words, scene, count, typed, schemes};
    memset(words, 0, sizeof *words);
    words->arena = gm_arena_open();
    message[0] = '\0';
    return gm_arena_run(words->arena, read_words, &typing) ||
           gm_refuse(message, "%s", gm_arena_reason(words->arena));
}

char *gm_words_join(const struct gm_scene *scene, const struct gm_words *words)
{
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    if (!stream) {
        return NULL;
    }
    gm_arguments_put_scene(stream, scene);
    for (size_t i = 0; i < words->count; i++) {
        const bool is_scheme = strcmp(words->list[i].key, "scheme") == 0;
        fprintf(stream, " %s=", words->list[i].key);
        for (size_t k = 0; k < words->list[i].piece_count; k++) {
            fputs(k ? "," : "", stream);
            const char *typed = words->list[i].pieces[k].text;
            const struct gm_scheme *scheme = is_scheme ? gm_scheme_find(typed) : NULL;
            gm_arguments_put(stream, scheme ? gm_scheme_word(scheme) : typed);
        }
    }
    return gm_stream_end(&writing);
}
