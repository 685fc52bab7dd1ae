/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas that are typed become lines of a system's file. */
#include "app/words/typed_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/words/words.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/model/scope.h"
#include "render/message.h"

enum { FORMULA_H, FORMULA_L, FORMULA_RATE, FORMULA_PART, FORMULA_COORDINATES, FORMULA_MOMENTA, FORMULAS };
const char *const gm_typed_keys[] = {"H", "L", "rate", "part", "coordinates", "momenta", NULL};
const char *const gm_replacing_keys[] = {"H",        "L",        "V",   "rate", "bracket", "S",
                                         "K-matrix", "L-matrix", "let", "part", "mesh",    NULL};

const char *gm_word_after(const char *word, const char *key)
{
    const size_t length = strlen(key);
    return strncmp(word, key, length) == 0 && word[length] == '=' ? word + length + 1 : NULL;
}

/* The first of some keys that a word sets, or their number, and its value. */
static size_t key_of(const char *word, const char *const *keys, const char **value)
{
    size_t k = 0;
    while (keys[k] && !(*value = gm_word_after(word, keys[k]))) {
        k++;
    }
    return k;
}

static bool is_typed(const char *word)
{
    const char *value;
    return gm_typed_keys[key_of(word, gm_typed_keys, &value)];
}

const char *gm_replacing_key(const char *word)
{
    const char *value;
    return gm_replacing_keys[key_of(word, gm_replacing_keys, &value)];
}

bool gm_typed_is_formula(const char *word)
{
    const char *value;
    return key_of(word, gm_typed_keys, &value) < FORMULA_PART;
}

/* ---- a text and where its parts are from ---- */

/* Calls the body in the text's arena, which the first call opens. */
static bool run(struct gm_typed_file *file, void (*body)(struct gm_arena *arena, void *data), void *data,
                char *message)
{
    file->arena = file->arena ? file->arena : gm_arena_open();
    return gm_arena_run(file->arena, body, data) || gm_refuse(message, "%s", gm_arena_reason(file->arena));
}

void gm_typed_file_close(struct gm_typed_file *file)
{
    gm_arena_close(file->arena);
    free(file->source);
}

/* Adds bytes, of a word or, for word 0, of the file, between two texts of the program; word -1: all are. */
static void put(struct gm_typed_file *file, const char *before, const char *text, size_t length,
                const char *after, struct gm_word_place from)
{
    const size_t begin = file->length, value = begin + strlen(before), end = value + length + strlen(after);
    file->text = gm_arena_resize(file->arena, file->text, end + 1, 1);
    snprintf(file->text + begin, end + 1 - begin, "%s%.*s%s", before, (int)length, text, after);
    file->length = end;
    file->parts = gm_arena_resize(file->arena, file->parts, file->part_count + 1, sizeof *file->parts);
    file->parts[file->part_count++] = (struct gm_text_part){begin, value, length, from};
}

/* Adds "KEY: VALUE" of the word KEY=VALUE. */
static void put_line(struct gm_typed_file *file, const char *word, int number)
{
    const size_t key = strcspn(word, "=");
    put(file, gm_arena_print(file->arena, "%.*s: ", (int)key, word), word + key + 1, strlen(word + key + 1),
        "\n", (struct gm_word_place){number, key + 1});
}

/* The word that wrote a byte of the text, or 0 for the file, and its place there; -1: the program wrote it. */
static struct gm_word_place place_of(const struct gm_typed_file *file, size_t offset)
{
    size_t i = file->part_count;
    while (i > 0 && file->parts[i - 1].begin > offset) {
        i--;
    }
    if (i == 0) {
        return (struct gm_word_place){file->path ? 0 : -1, offset};
    }
    const struct gm_text_part *part = &file->parts[i - 1];
    const size_t inside = offset > part->value ? offset - part->value : 0;
    return (struct gm_word_place){part->from.word,
                                  part->from.offset + (inside < part->length ? inside : part->length)};
}

int gm_typed_file_fault(const struct gm_typed_file *file, const struct gm_fault *fault,
                        struct gm_word_place *place, char *message)
{
    const bool shown = fault->sentence[0] && fault->offset < file->length;
    const struct gm_word_place from =
        shown && fault->offset > 0 ? place_of(file, fault->offset) : (struct gm_word_place){-1, 0};
    if (from.word > 0) {
        const char *word = file->words[from.word];
        const size_t key = strcspn(word, "=") + 1, inside = from.offset >= key ? from.offset - key : 0;
        *place = from;
        gm_refuse(message, "in %.*s, column %zu: %.200s", (int)key, word, inside + 1, fault->sentence);
        gm_place_show(word + key, strlen(word + key), inside, message);
    } else if (file->missing) {
        *place = file->missing_place;
        gm_refuse(message, "%s", file->missing);
    } else if (!fault->sentence[0]) {
        gm_refuse(message, "%.300s: not enough memory", file->path ? file->path : "system");
        return GM_EXIT_MEMORY;
    } else if (!file->path) {
        gm_refuse(message, "system: %.200s", fault->sentence);
    } else {
        struct gm_fault there = *fault;
        const struct gm_word_place earlier = place_of(file, fault->earlier);
        there.offset = from.word == 0 ? from.offset : fault->offset;
        there.earlier = fault->earlier > 0 && earlier.word == 0 ? earlier.offset : 0;
        gm_place_report(file->path, file->source, &there, message);
        if (shown) {
            gm_place_show(file->source, file->size, there.offset, message);
        }
    }
    return GM_EXIT_USAGE;
}

/* ---- words that replace lines of a file ---- */

/* The next character of a name, or 0 where it ends. */
static char next_of_name(const char **text)
{
    *text += strspn(*text, " \t");
    return (char)(**text == '=' || **text == '(' ? '\0' : *(*text)++);
}

/* Returns true if a word replaces a line: it has its key and, for a rate, a bracket, a let or a part, the same names
   before the = or the arguments. */
static bool replaces(const char *word, const char *key, const char *value)
{
    const char *typed = gm_word_after(word, key);
    char one = typed ? ' ' : '\0', other = one;
    while (typed && strchr("rblp", key[0]) && one && one == other) {
        one = next_of_name(&typed);
        other = next_of_name(&value);
    }
    return typed && one == other;
}

bool gm_typed_file_has(const struct gm_typed_file *file, int word)
{
    size_t i = 0;
    while (i < file->part_count && file->parts[i].from.word != word) {
        i++;
    }
    return file->path ? i < file->part_count : is_typed(file->words[word]);
}

/* Writes a file's text with the typed lines instead of its own. */
static void replace_lines(struct gm_arena *arena, void *data)
{
    struct gm_typed_file *file = data;
    struct gm_text_line line;
    struct gm_fault fault;
    size_t at = 0, from = 0;
    (void)arena;
    while (gm_lines_next(file->source, file->size, &at, &line, &fault)) {
        const char *key = gm_replacing_keys[gm_span_among(file->source, line.word, gm_replacing_keys)];
        int i = 1;
        while (key && i < file->count && !replaces(file->words[i], key, file->source + line.value.begin)) {
            i++;
        }
        if (key && i < file->count) {
            put(file, "", file->source + from, line.word.begin - from, "",
                (struct gm_word_place){.offset = from});
            put_line(file, file->words[i], i);
            from = at;
        }
    }
    put(file, "", file->source + from, file->size - from, "", (struct gm_word_place){.offset = from});
    static const char *const naming[] = {"let", "part", NULL};
    for (int i = 1; i < file->count; i++) { /* a new name */
        const char *value;
        if (naming[key_of(file->words[i], naming, &value)] && !gm_typed_file_has(file, i)) {
            put(file, "\n", "", 0, "", (struct gm_word_place){.word = -1});
            put_line(file, file->words[i], i);
        }
    }
}

bool gm_typed_file_replace(struct gm_typed_file *file, char *message)
{
    file->text = NULL;
    file->length = 0;
    return run(file, replace_lines, file, message);
}

bool gm_typed_file_formulas(const char *text, struct gm_arguments *words)
{
    size_t at = 0;
    struct gm_text_line line;
    struct gm_fault fault;
    while (gm_lines_next(text, strlen(text), &at, &line, &fault)) {
        const char *key = gm_replacing_keys[gm_span_among(text, line.word, gm_replacing_keys)];
        char *value = key ? gm_span_words(text, line.value) : NULL;
        words->failed = words->failed || (key && !value);
        if (value) {
            gm_arguments_print(words, "%s=%s", key, value);
        }
        free(value);
    }
    return !words->failed;
}

/* ---- a text of words alone ---- */

/* The typed words, while they become lines. */
struct typing {
    struct gm_typed_file *file;
    struct gm_arena *arena;
    const char **words; /* the typed ones, and those of the default coordinates, from number file->count on */
    int count;
    struct gm_word_place *wrong; /* the place of a refusal */
    bool has[FORMULAS];          /* true for the keys that are given */
    bool usual;                  /* the coordinates are q or q1, q2, as none are given */
    bool velocities;             /* velocities are called v, or v1, v2 */
    bool alone;           /* the coordinates are the state, as of an L that is linear in the velocities */
    const char *needless; /* alone: " v1= p1=", the words that give other values; NULL: none */
};

/* A name in a typed formula, or in a list of components. */
struct use {
    struct gm_word_place at;
    size_t length;
    enum { VARIABLE, COMPONENT, INDEX } role;
};

/* Returns true if a rate begins at this byte of x = y, y = -x. */
static bool begins_rate(const char *rates, size_t at)
{
    size_t begin = 0;
    while (begin <= at && begin + strspn(rates + begin, " \t") != at) {
        begin += gm_word_first(rates + begin) + 1;
    }
    return begin <= at;
}

/* Returns true for the words between conditions, as in if(x > 0 and not y > 1, a, b). */
static bool joins_conditions(const char *text, size_t length)
{
    static const char *const words[] = {"and", "or", "not"};
    bool found = false;
    for (size_t i = 0; i < GM_COUNT(words); i++) {
        found = found || (strlen(words[i]) == length && memcmp(text, words[i], length) == 0);
    }
    return found;
}

/* Moves to the next name; {0} is before the first. Returns false behind the last. */
static bool next_use(const struct typing *typing, struct use *use)
{
    size_t at = use->at.offset + use->length, length;
    for (int i = use->at.word; i < typing->count; i++, at = 0) {
        const char *word = typing->words[i], *value;
        const size_t key = key_of(word, gm_typed_keys, &value), end = strlen(word);
        if (at == 0) {
            at = gm_typed_keys[key] || i >= typing->file->count ? strcspn(word, "=") + 1 : end;
        }
        for (; at < end; at += length) {
            const char *text = word + at;
            length = gm_name_length(text, end - at);
            if (length == 0) { /* digits take their exponent with them: 1e-3 */
                char *last = NULL;
                strtod(text, &last);
                length = (*text >= '0' && *text <= '9') && last > text ? (size_t)(last - text) : 1;
                continue;
            }
            const char behind = text[length + strspn(text + length, " \t")];
            const bool rate = key == FORMULA_RATE && begins_rate(value, (size_t)(text - value)),
                       of_part = key == FORMULA_PART && behind == ';'; /* part='A; x = v' */
            if (of_part || joins_conditions(text, length)) {
                continue;
            }
            if (rate || (behind != '(' && !gm_formula_reserves(text, length))) { /* but for functions */
                *use = (struct use){{i, at},
                                    length,
                                    rate || key >= FORMULA_COORDINATES ? COMPONENT
                                    : behind == '='                    ? INDEX
                                                                       : VARIABLE};
                return true;
            }
        }
    }
    return false;
}

static char *name_of(const struct typing *typing, const struct use *use)
{
    return gm_arena_print(typing->arena, "%.*s", (int)use->length,
                          typing->words[use->at.word] + use->at.offset);
}

static bool is_used(const struct typing *typing, const char *name, int role)
{
    struct use use = {0};
    while (next_use(typing, &use)) {
        const char *text = typing->words[use.at.word] + use.at.offset;
        if ((int)use.role == role && strlen(name) == use.length && memcmp(text, name, use.length) == 0) {
            return true;
        }
    }
    return false;
}

/* Returns true if it is a component, or the momentum or the velocity of one: p_q, v_q. */
static bool is_part(const struct typing *typing, const char *name)
{
    return is_used(typing, name, COMPONENT) ||
           ((name[0] == 'p' || name[0] == 'v') && name[1] == '_' && is_used(typing, name + 2, COMPONENT));
}

/* Returns true if a word gives a component or a variable its value, NAME=formula or NAME[index]=formula. */
static bool has_value(const struct typing *typing, const char *name)
{
    const struct gm_typed_file *file = typing->file;
    const size_t letters = strlen(name);
    int i = 1;
    while (i < file->count &&
           (strncmp(file->words[i], name, letters) != 0 || strcspn(file->words[i], "[=") != letters ||
            !strchr(file->words[i], '=') || is_typed(file->words[i]))) {
        i++;
    }
    return i < file->count && (is_part(typing, name) || is_used(typing, name, VARIABLE));
}

/* Returns true if a formula has the name "q2", or "q" with number 0. */
static bool has_numbered(const struct typing *typing, char letter, int number)
{
    char name[16];
    snprintf(name, sizeof name, number > 0 ? "%c%d" : "%c", letter, number);
    return is_used(typing, name, VARIABLE);
}

/* Adds the words coordinates=q1 q2, as far as such names occur, or q alone, those of their momenta and, for
   names v1, v2, of their velocities. */
static void add_usual_coordinates(struct typing *typing)
{
    static const char *const lists[] = {"coordinates=", "momenta=", "velocities="};
    int degrees = 0;
    while (has_numbered(typing, 'q', degrees + 1) || has_numbered(typing, 'p', degrees + 1)) {
        degrees++;
    }
    typing->velocities = typing->has[FORMULA_L] && has_numbered(typing, 'v', has_numbered(typing, 'q', 1));
    for (int list = 0; list < 2 + typing->velocities; list++) {
        if (list == 1 && typing->alone) {
            continue;
        }
        const char *word =
            gm_arena_print(typing->arena, degrees > 0 ? "%s" : "%s%c", lists[list], "qpv"[list]);
        for (int i = 1; i <= degrees; i++) {
            word = gm_arena_print(typing->arena, "%s%s%c%d", word, i > 1 ? " " : "", "qpv"[list], i);
        }
        typing->words[typing->count++] = word;
        put_line(typing->file, word, -1);
    }
}

/* Returns true for v1, v_q1 or p1 beside a coordinate q1 that is the state alone. */
static bool is_needless(const struct typing *typing, const char *name)
{
    const bool momentum = name[0] == 'p' && !is_used(typing, name, VARIABLE);
    const char *coordinate = name[0] == '\0'  ? ""
                             : name[1] == '_' ? name + 2
                                              : gm_arena_print(typing->arena, "q%s", name + 1);
    return typing->alone && (momentum || name[0] == 'v') && is_used(typing, coordinate, COMPONENT);
}

/* The words that give a component its value at the start, or the others, which are parameters. */
static void put_starts_or_parameters(struct typing *typing, bool starts)
{
    struct gm_typed_file *file = typing->file;
    for (int i = 1; i < file->count; i++) {
        const char *word = file->words[i], *equals = strchr(word, '=');
        const struct gm_word_place at = {.word = i}, value = {i, equals ? (size_t)(equals + 1 - word) : 0};
        const char *name = gm_arena_print(typing->arena, "%.*s", (int)strcspn(word, "[="), word);
        if (starts && equals && !is_typed(word) && is_needless(typing, name)) {
            *typing->wrong = at;
            typing->needless =
                gm_arena_print(typing->arena, "%s %s=", typing->needless ? typing->needless : "", name);
        } else if (equals && !is_typed(word) && has_value(typing, name) && is_part(typing, name) == starts) {
            put(file, starts ? "start: " : "parameter: ", word, value.offset - 1, " = ", at);
            put(file, "", equals + 1, gm_word_first(equals + 1), "\n", value);
        }
    }
}

static bool needs_none(const struct typing *typing, const char *name, bool component)
{
    if (strcmp(name, "t") == 0 || has_value(typing, name) || is_used(typing, name, INDEX)) {
        return true;
    }
    if (typing->usual && typing->has[FORMULA_L] && name[0] == 'p' && /* p1 follows from v_q1 or v1 */
        (has_value(typing, gm_arena_print(typing->arena, "v_q%s", name + 1)) ||
         has_value(typing, gm_arena_print(typing->arena, "v%s", name + 1)))) {
        return true;
    }
    return component ? typing->velocities && name[0] == 'v' /* else the momentum is given */
                     : is_part(typing, name);
}

/* The names that have values as coordinates and momenta of H, or as coordinates of L, "coordinates=x momenta=y", if
   none of them is a default one and they make pairs; else "". A momentum begins with p, or is in the second half; L
   has the velocity v_x of a coordinate x. */
static const char *tell_pairs(const struct typing *typing)
{
    const char *lists[] = {"; for other names type coordinates=", " momenta="}, *between[] = {"", ""};
    const char **names = NULL;
    size_t count = 0, with_p = 0;
    for (struct use use = {0}; next_use(typing, &use);) {
        const char *name = name_of(typing, &use);
        size_t i = 0;
        if (use.role == VARIABLE && is_used(typing, name, COMPONENT)) {
            return "";
        }
        while (i < count && strcmp(names[i], name) != 0) {
            i++;
        }
        const bool moves =
            !typing->has[FORMULA_L] || is_used(typing, gm_arena_print(typing->arena, "v_%s", name), VARIABLE);
        if (use.role == VARIABLE && i == count && has_value(typing, name) && moves) {
            names = gm_arena_resize(typing->arena, names, count + 1, sizeof *names);
            names[count++] = name;
            with_p += name[0] == 'p';
        }
    }
    for (size_t i = 0; i < count; i++) {
        const bool momentum =
            !typing->has[FORMULA_L] && (2 * with_p == count ? names[i][0] == 'p' : i >= count / 2);
        lists[momentum] =
            gm_arena_print(typing->arena, "%s%s%s", lists[momentum], between[momentum], names[i]);
        between[momentum] = ",";
    }
    const bool pairs = count > 0 && (typing->has[FORMULA_L] || (typing->has[FORMULA_H] && count % 2 == 0));
    return pairs ? gm_arena_print(typing->arena, "%s%s", lists[0], typing->has[FORMULA_H] ? lists[1] : "")
                 : "";
}

/* Notes a name without a value, and gives it one, so that faults of the formulas are found first. */
static void need(struct typing *typing, const char *name, struct gm_word_place place, bool component)
{
    struct gm_typed_file *file = typing->file;
    const char *missing = file->missing ? file->missing : "",
               *text = gm_arena_print(typing->arena, " %.40s=", name);
    if (needs_none(typing, name, component) || strstr(missing, text)) {
        return;
    }
    if (gm_reading_reserves(name, strlen(name))) {
        *typing->wrong = place;
        gm_arena_refuse(typing->arena, "the name %.40s" GM_RESERVED, name);
    }
    file->missing_place = file->missing ? file->missing_place : place;
    file->missing = gm_arena_print(typing->arena, "%s%s", missing, text);
    put(file, component ? "start: " : "parameter: ", name, strlen(name), " = 1\n",
        (struct gm_word_place){.word = -1});
}

/* Finds what is missing: components need a value at the start, all other names are parameters. */
static void put_missing(struct typing *typing)
{
    struct gm_typed_file *file = typing->file;
    for (struct use use = {0}; next_use(typing, &use);) {
        if (use.role == COMPONENT) {
            const bool typed = use.at.word < file->count;
            need(typing, name_of(typing, &use), typed ? use.at : (struct gm_word_place){.word = -1}, true);
        }
    }
    for (struct use use = {0}; next_use(typing, &use);) {
        if (use.role == VARIABLE) {
            need(typing, name_of(typing, &use), use.at, false);
        }
    }
    if (file->missing) {
        file->missing =
            gm_arena_print(typing->arena, "the formula needs values that are not given:%.160s%.160s",
                           file->missing, tell_pairs(typing));
    }
    if (file->missing && is_used(typing, "p_q", VARIABLE)) {
        *typing->wrong = file->missing_place;
        gm_arena_refuse(typing->arena, "%s; without coordinates= a momentum is p, not p_q", file->missing);
    }
}

/* ---- words of another form ---- */

/* The length in bytes of value .. end without blanks at its end. */
static int trimmed(const char *value, const char *end)
{
    while (end > value && end[-1] == ' ') {
        end--;
    }
    return (int)(end - value);
}

/* "H = p^2/2, q = 1" as words, "H='p^2/2' q=1", of which there are *count; 0 for another text. */
static const char *as_words(const struct typing *typing, const char *text, size_t *count)
{
    const char *words = "";
    for (*count = 0; *text; ++*count) {
        text += strspn(text, " ");
        const size_t length = gm_word_first(text), name = gm_name_length(text, length);
        const char *value = text + name + strspn(text + name, " ");
        if (name == 0 || *value != '=') {
            *count = 0;
            break;
        }
        value += 1 + strspn(value + 1, " ");
        const int size = trimmed(value, text + length);
        const bool plain = strspn(value, "0123456789.+-eE") >= (size_t)size;
        words = gm_arena_print(typing->arena, "%s%s%.*s=%s%.*s%s", words, *count > 0 ? " " : "", (int)name,
                               text, plain ? "" : "'", size, value, plain ? "" : "'");
        text += length + (text[length] != '\0');
    }
    return words;
}

/* " rate='x = y' ..." for x' = y, dx/dt = y and x'' = f, with commas between them; "" for another text. */
static const char *as_rates(const struct typing *typing, const char *text)
{
    const char *rates = "", *const whole = text;
    while (*text) {
        text += strspn(text, " ");
        const size_t length = gm_word_first(text);
        const char *name = text, *value = text + gm_name_length(text, length);
        size_t order = strspn(value, "'"), size = (size_t)(value - name);
        value += order;
        if (order == 0 && size > 1 && name[0] == 'd' && strncmp(value, "/dt", 3) == 0) {
            name++;
            size--;
            order = 1;
            value += 3;
        }
        value += strspn(value, " ");
        if (size == 0 || order == 0 || order > 2 || *value != '=') {
            return "";
        }
        value += 1 + strspn(value + 1, " ");
        const int given = trimmed(value, text + length);
        if (order == 2) { /* the velocity is a component, too */
            const bool taken = strchr(whole, 'v') != NULL;
            const char *velocity = taken ? gm_arena_print(typing->arena, "v_%.*s", (int)size, name) : "v";
            rates = gm_arena_print(typing->arena, "%s rate='%.*s = %s' rate='%s = %.*s'", rates, (int)size,
                                   name, velocity, velocity, given, value);
        } else {
            rates =
                gm_arena_print(typing->arena, "%s rate='%.*s = %.*s'", rates, (int)size, name, given, value);
        }
        text += length + (text[length] != '\0');
    }
    return rates;
}

/* Refuses a word that is a formula and values, if these are at least `least`. */
static void refuse_values(const struct typing *typing, const char *word, size_t least)
{
    static const char *const numbers[] = {"one word", "two words", "three words", "four words", "five words"};
    size_t count;
    const char *words = as_words(typing, word, &count);
    if (count >= least) {
        gm_arena_refuse(typing->arena, "a formula and each value are words of their own, here %s: %.300s",
                        count <= GM_COUNT(numbers) ? numbers[count - 1] : "these", words);
    }
}

/* Refuses words without a formula, with the words that were probably meant. */
static void refuse_words(const struct typing *typing)
{
    const char *rates = "";
    for (int i = 1; i < typing->file->count; i++) {
        const char *word = typing->file->words[i];
        if (word[strcspn(word, " =")] == ' ' && !rates[0]) {
            refuse_values(typing, word, 1);
        }
        rates = gm_arena_print(typing->arena, "%s%s", rates, as_rates(typing, word));
    }
    gm_arena_refuse_if(typing->arena, rates[0], "a derivative is typed as a rate:%.300s", rates);
    gm_arena_refuse(typing->arena,
                    "scene system needs a formula: H='p^2/2 + q^4/4', or L=, or rate='x = -x' for "
                    "each component");
}

static void put_typed(struct gm_arena *arena, void *data)
{
    static const char *const of_files[] = {"bracket", "V", "K-matrix", "L-matrix", "mesh", "let", NULL};
    struct typing *typing = data;
    struct gm_typed_file *file = typing->file;
    const char *value;
    typing->arena = arena;
    typing->count = file->count;
    typing->words = gm_arena_take(arena, (size_t)file->count + 3, sizeof *typing->words);
    memcpy(typing->words, file->words, (size_t)file->count * sizeof *typing->words);
    for (int i = 1; i < file->count; i++) {
        const size_t key = key_of(file->words[i], gm_typed_keys, &value);
        if (gm_typed_keys[key]) {
            if (key == FORMULA_H || key == FORMULA_L) {
                refuse_values(typing, file->words[i], 2);
            }
            put_line(file, file->words[i], i);
            typing->has[key] = true;
        }
    }
    typing->usual = !typing->has[FORMULA_RATE] && !typing->has[FORMULA_COORDINATES];
    for (int i = 1; i < file->count; i++) {
        const char *key = of_files[key_of(file->words[i], of_files, &value)];
        if (key) {
            *typing->wrong = (struct gm_word_place){i, 0};
            gm_arena_refuse(arena,
                            "%s= replaces a line of a system's file; a system that is typed without one has "
                            "H=, L= or rate=",
                            key);
        }
    }
    if (!typing->has[FORMULA_H] && !typing->has[FORMULA_L] && !typing->has[FORMULA_RATE]) {
        refuse_words(typing);
    }
    if (typing->usual) {
        add_usual_coordinates(typing);
    }
    put_starts_or_parameters(typing, false);
    put_starts_or_parameters(typing, true);
    put_missing(typing);
}

/* Returns true if the text is that of an L which is linear in the velocities. */
static bool is_degenerate(const struct gm_typed_file *file)
{
    struct gm_user_system system;
    struct gm_fault fault;
    const bool found = gm_system_read(&system, file->text, file->length, NULL, 0, &fault) && system.theta;
    gm_system_close(&system);
    return found;
}

bool gm_typed_file_write(struct gm_typed_file *file, struct gm_word_place *place, char *message)
{
    struct typing typing = {.file = file, .wrong = place},
                  alone = {.file = file, .wrong = place, .alone = true};
    if (!run(file, put_typed, &typing, message)) {
        return false;
    }
    if (typing.usual && typing.has[FORMULA_L]) {
        const struct gm_typed_file usual = *file;
        const struct gm_word_place before = *place;
        file->text = NULL;
        file->parts = NULL;
        file->length = file->part_count = 0;
        file->missing = NULL;
        if (!run(file, put_typed, &alone, message) || file->missing || !is_degenerate(file)) {
            *file = usual;
            *place = before;
            message[0] = '\0';
        } else if (alone.needless) {
            gm_refuse(message,
                      "L is linear in the velocities, so its state is the coordinates alone: leave out%s",
                      alone.needless);
            return false;
        }
    }
    return true;
}
