/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas that are typed become lines of a system's file. */
#include "app/words/typed_file.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/words/words.h"
#include "core/basics.h"
#include "core/memory.h"
#include "core/model/scope.h"
#include "render/message.h"

enum { FORMULA_H, FORMULA_L, FORMULA_RATE, FORMULA_COORDINATES };
const char *const gm_typed_keys[] = {"H", "L", "rate", "coordinates", "momenta", NULL};
const char *const gm_replacing_keys[] = {"H", "L", "V", "rate", "bracket", "S", "K-matrix", "L-matrix", NULL};

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

bool gm_typed_is_formula(const char *word)
{
    const char *value;
    return key_of(word, gm_typed_keys, &value) < FORMULA_COORDINATES;
}

/* ---- words that replace lines of a file ---- */

/* Returns true if a word replaces a line: it has its key and, for a rate or a bracket, the same names
   before the =. */
static bool replaces(const char *word, const char *key, const char *value)
{
    const char *typed = gm_word_after(word, key);
    char one = typed ? ' ' : '\0', other = one;
    while (typed && (key[0] == 'r' || key[0] == 'b') && one && one == other) {
        typed += strspn(typed, " \t");
        value += strspn(value, " \t");
        one = (char)(*typed == '=' ? '\0' : *typed++);
        other = (char)(*value == '=' ? '\0' : *value++);
    }
    return typed && one == other;
}

bool gm_typed_file_replace(struct gm_typed_file *file)
{
    char *text = NULL;
    size_t size = 0, at = 0, from = 0;
    struct gm_text_line line;
    struct gm_fault fault;
    FILE *stream = open_memstream(&text, &size);
    while (stream && gm_lines_next(file->text, file->length, &at, &line, &fault)) {
        const char *key = gm_replacing_keys[gm_span_among(file->text, line.word, gm_replacing_keys)];
        int i = 1;
        while (key && i < file->count && !replaces(file->words[i], key, file->text + line.value.begin)) {
            i++;
        }
        if (key && i < file->count) {
            fwrite(file->text + from, 1, line.word.begin - from, stream);
            fprintf(stream, "%s: %s\n", key, gm_word_after(file->words[i], key));
            from = at;
        }
    }
    if (stream) {
        fputs(file->text + from, stream);
        fclose(stream);
        free(file->text);
        file->text = text;
        file->length = size;
    }
    return text != NULL;
}

bool gm_typed_file_has(const struct gm_typed_file *file, const char *word)
{
    size_t at = 0;
    struct gm_text_line line;
    struct gm_fault fault;
    const char *value;
    bool has = !file->path && gm_typed_keys[key_of(word, gm_typed_keys, &value)];
    while (file->path && !has && gm_lines_next(file->text, file->length, &at, &line, &fault)) {
        const char *key = gm_replacing_keys[gm_span_among(file->text, line.word, gm_replacing_keys)];
        has = key && replaces(word, key, file->text + line.value.begin);
    }
    return has;
}

bool gm_typed_file_formulas(const char *text, struct gm_arguments *words)
{
    size_t at = 0;
    struct gm_text_line line;
    struct gm_fault fault;
    bool good = true;
    while (good && gm_lines_next(text, strlen(text), &at, &line, &fault)) {
        const char *key = gm_replacing_keys[gm_span_among(text, line.word, gm_replacing_keys)];
        char *value = key ? gm_span_words(text, line.value) : NULL, *word = NULL;
        good = !key || (value && asprintf(&word, "%s=%s", key, value) >= 0 && gm_arguments_add(words, word));
        free(value);
        free(word);
    }
    return good;
}

/* ---- faults ---- */

static void word_fault(const char *word, size_t at, const char *sentence, char *message)
{
    const size_t key = strcspn(word, "=") + 1, inside = at >= key ? at - key : 0;
    gm_refuse(message, "in %.*s, column %zu: %.200s", (int)key, word, inside + 1, sentence);
    gm_place_show(word + key, strlen(word + key), inside, message);
}

static bool is_rest_of_line(const char *text, const char *rest, size_t length)
{
    return strncmp(text, rest, length) == 0 && text[length] == '\n';
}

/* The place of a byte of the text in the word that wrote its line, as "KEY: VALUE" or as "start: KEY = VALUE". */
static struct gm_word_place place_in_words(const struct gm_typed_file *file, size_t offset)
{
    const char *text = file->text;
    size_t begin = offset;
    while (begin > 0 && (text[begin - 1] != '\n' || text[begin] == ' ' || text[begin] == '\t')) {
        begin--;
    }
    const size_t value = begin + strcspn(text + begin, ":") + 2, column = offset - value;
    for (int i = 1; i < file->count && offset >= value; i++) {
        const char *word = file->words[i], *typed = strchr(word, '=');
        const size_t key = typed ? (size_t)(typed++ - word) : 0;
        if (!typed) {
            continue;
        }
        if (begin + key + 2 == value && strncmp(text + begin, word, key) == 0 &&
            is_rest_of_line(text + value, typed, strlen(typed))) {
            return (struct gm_word_place){i, key + 1 + column};
        }
        if (!file->path && (column <= key || column >= key + 3) && strncmp(text + value, word, key) == 0 &&
            strncmp(text + value + key, " = ", 3) == 0 &&
            is_rest_of_line(text + value + key + 3, typed, gm_word_first(typed))) {
            return (struct gm_word_place){i, column <= key ? column : column - 2};
        }
    }
    return (struct gm_word_place){-1, 0};
}

int gm_typed_file_fault(const struct gm_typed_file *file, const struct gm_fault *fault,
                        struct gm_word_place *place, char *message)
{
    if (!fault->sentence[0]) {
        gm_refuse(message, "%.300s: not enough memory", file->path ? file->path : "system");
        return GM_EXIT_MEMORY;
    }
    const bool shown = fault->offset < file->length && file->length <= GM_LARGEST_SYSTEM;
    const struct gm_word_place none = {-1, 0}, typed = shown && fault->offset > 0
                                                           ? place_in_words(file, fault->offset)
                                                           : none;
    if (typed.word > 0) {
        *place = typed;
        word_fault(file->words[place->word], place->offset, fault->sentence, message);
    } else if (!file->path) {
        gm_refuse(message, "system: %.200s", fault->sentence);
    } else {
        gm_place_report(file->path, file->text, fault, message);
        if (shown) {
            gm_place_show(file->text, file->length, fault->offset, message);
        }
    }
    return GM_EXIT_USAGE;
}

/* ---- a file of words alone ---- */

struct name {
    const char *text;
    size_t length;
};

enum { MOST_NAMES = 256 };

struct names {
    struct name list[MOST_NAMES];
    size_t count;
};

/* The typed words, to be written as the lines of a file. */
struct typing {
    const struct gm_typed_file *file;
    struct gm_formula *graph;      /* a formula that is read before its names have values */
    struct gm_fault fault;         /* the first fault */
    struct gm_word_place wrong;    /* the place of the fault */
    struct names names;            /* names in the formulas */
    struct names parts;            /* components of the state */
    struct names given;            /* names with a value, or that need none: the indices of sums */
    bool has[FORMULA_COORDINATES]; /* true for those of H, L and rate that are given */
    bool usual;                    /* the coordinates are q or q1, q2, as none are given */
    bool velocities;               /* they are called v, or v1, v2 */
    char lines[16 * MOST_NAMES];   /* the lines of the default coordinates */
};

static bool is_name(const struct name *name, const char *text, size_t length)
{
    return name->length == length && memcmp(name->text, text, length) == 0;
}

static bool holds(const struct names *names, const char *text, size_t length)
{
    size_t i = 0;
    while (i < names->count && !is_name(&names->list[i], text, length)) {
        i++;
    }
    return i < names->count;
}

__attribute__((format(printf, 2, 3))) static bool holds_written(const struct names *names, const char *format,
                                                                ...)
{
    char name[64];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(name, sizeof name, format, arguments);
    va_end(arguments);
    return holds(names, name, strlen(name));
}

static void note(struct names *names, const char *text, size_t length)
{
    if (names->count < MOST_NAMES && !holds(names, text, length)) {
        names->list[names->count++] = (struct name){text, length};
    }
}

/* The names that `size` letters of a text hold, but for functions and the indices of sums. */
static void collect(struct names *names, struct names *indices, const char *text, size_t size)
{
    const char *last = text + size;
    while (text < last) {
        const size_t length = gm_name_length(text, (size_t)(last - text));
        if (length == 0) {
            /* digits take their exponent with them: 1e-3 */
            char *end = NULL;
            strtod(text, &end);
            text = (*text >= '0' && *text <= '9') && end > text ? end : text + 1;
            continue;
        }
        const char *behind = text + length + strspn(text + length, " \t");
        if (*behind == '=') {
            note(indices, text, length);
        } else if (*behind != '(' &&
                   !gm_formula_reserves(text, length)) { /* a called name is not a variable */
            note(names, text, length);
        }
        text += length;
    }
}

static enum gm_meaning find_unvalued(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    (void)sentence;
    const struct typing *typing = data;
    *node = gm_formula_constant(typing->graph, 1);
    return holds(&typing->names, name->text, name->length) && !holds(&typing->given, name->text, name->length)
               ? GM_KNOWN
               : GM_UNKNOWN;
}

static const char *no_name(size_t i, const void *data)
{
    (void)i;
    (void)data;
    return NULL;
}

/* Notes the names in H, L or the right side of a rate, and faults that do not depend on them. */
static void add_formula(struct typing *typing, int word, const char *text, size_t length)
{
    struct gm_formula graph;
    const struct gm_scope scope = {.find = find_unvalued, .known = no_name, .data = typing};
    gm_node_id node;
    collect(&typing->names, &typing->given, text, length);
    if (typing->fault.sentence[0]) {
        return;
    }
    gm_formula_open(&graph);
    typing->graph = &graph;
    if (!gm_formula_read(&graph, text, 0, length, &scope, &node, &typing->fault)) {
        typing->wrong.word = word;
        typing->wrong.offset = (size_t)(text - typing->file->words[word]) + typing->fault.offset;
    }
    gm_formula_close(&graph);
}

/* Rates, x = y, y = -x: the left sides are parts of the state. */
static void add_rates(struct typing *typing, int word, const char *text)
{
    while (*(text += strspn(text, " \t"))) {
        const size_t length = gm_word_first(text), left = gm_name_length(text, length);
        const char *equals = memchr(text, '=', length);
        const size_t before = equals ? (size_t)(equals + 1 - text) : length;
        if (left > 0) {
            note(&typing->parts, text, left);
        }
        collect(&typing->names, &typing->given, text + left, before - left);
        if (equals) {
            add_formula(typing, word, text + before, length - before);
        }
        text += length + (text[length] != '\0');
    }
}

static void put_formulas(struct typing *typing, FILE *stream)
{
    for (int i = 1; i < typing->file->count; i++) {
        const char *value;
        const size_t key = key_of(typing->file->words[i], gm_typed_keys, &value);
        if (!gm_typed_keys[key]) {
            continue;
        }
        fprintf(stream, "%s: %s\n", gm_typed_keys[key], value);
        if (key == FORMULA_RATE) {
            add_rates(typing, i, value);
        } else if (key < FORMULA_COORDINATES) {
            add_formula(typing, i, value, strlen(value));
        } else {
            collect(&typing->parts, &typing->given, value, strlen(value));
        }
        if (key < FORMULA_COORDINATES) {
            typing->has[key] = true;
        }
        typing->usual = typing->usual && key != FORMULA_RATE && key != FORMULA_COORDINATES;
    }
}

/* Writes "coordinates: q1 q2", as far as such names occur, or q alone, their momenta and, for names v1,
   v2, their velocities. */
static void put_usual_coordinates(struct typing *typing, FILE *stream)
{
    static const char *const lists[] = {"coordinates", "momenta", "velocities"};
    const struct names *names = &typing->names;
    int n = 1;
    while (holds_written(names, "q%d", n) || holds_written(names, "p%d", n)) {
        n++;
    }
    typing->velocities =
        typing->has[FORMULA_L] && (holds(names, "q1", 2) ? holds(names, "v1", 2) : holds(names, "v", 1));
    char *at = typing->lines, *end = at + sizeof typing->lines;
    for (int list = 0; list < 2 + typing->velocities; list++) {
        at += snprintf(at, (size_t)(end - at), "%s:", lists[list]);
        for (int i = 1; i < n + (n == 1); i++) {
            const char *name = at + 1;
            at += snprintf(at, (size_t)(end - at), " %c", "qpv"[list]);
            at += n > 1 ? snprintf(at, (size_t)(end - at), "%d", i) : 0;
            note(&typing->parts, name, (size_t)(at - name));
        }
        *at++ = '\n';
    }
    fputs(typing->lines, stream);
}

/* Returns true if it is a component, or the momentum or the velocity of one: p_q, v_q. */
static bool is_part(const struct typing *typing, const char *name, size_t length)
{
    return holds(&typing->parts, name, length) ||
           (length > 2 && (name[0] == 'p' || name[0] == 'v') && name[1] == '_' &&
            holds(&typing->parts, name + 2, length - 2));
}

/* The words that give a component its value at the start, or the others, which are parameters. */
static void put_starts_or_parameters(struct typing *typing, bool starts, FILE *stream)
{
    const char *formula;
    for (int i = 1; i < typing->file->count; i++) {
        const char *word = typing->file->words[i], *equals = strchr(word, '=');
        const size_t plain = strcspn(word, "[=");
        const bool part = is_part(typing, word, plain);
        if (!equals || gm_typed_keys[key_of(word, gm_typed_keys, &formula)] || part != starts ||
            (!part && !holds(&typing->names, word, plain))) {
            continue;
        }
        fprintf(stream, "%s: %.*s = %.*s\n", starts ? "start" : "parameter", (int)(equals - word), word,
                (int)gm_word_first(equals + 1), equals + 1);
        note(&typing->given, word, plain);
    }
}

/* Returns true if a name needs no value. */
static bool needs_none(const struct typing *typing, const struct name *name, bool part)
{
    const struct names *given = &typing->given;
    if (is_name(name, "t", 1) || holds(given, name->text, name->length)) {
        return true;
    }
    const int digits = (int)name->length - 1; /* p1 is not needed if v_q1 or v1 is given */
    if (typing->usual && typing->has[FORMULA_L] && name->text[0] == 'p' && digits < 30 &&
        (holds_written(given, "v_q%.*s", digits, name->text + 1) ||
         holds_written(given, "v%.*s", digits, name->text + 1))) {
        return true;
    }
    return part ? typing->velocities && name->text[0] == 'v' /* else the momentum is given */
                : is_part(typing, name->text, name->length);
}

/* The place of a collected name; word -1: no word has it. */
static struct gm_word_place place_of(const struct gm_typed_file *file, const char *name)
{
    for (int i = 0; i < file->count; i++) {
        if (name >= file->words[i] && name <= file->words[i] + strlen(file->words[i])) {
            return (struct gm_word_place){i, (size_t)(name - file->words[i])};
        }
    }
    return (struct gm_word_place){-1, 0};
}

/* Writes the names of H that have values as coordinates and momenta, " coordinates=x momenta=y", if none of them
   is a default one and they make pairs; else "". A momentum begins with p, or is in the second half. */
static void put_pairs(const struct typing *typing, char *text, size_t size)
{
    size_t count = 0, with_p = 0;
    const struct name *names[MOST_NAMES];
    text[0] = '\0';
    for (size_t i = 0; i < typing->names.count; i++) {
        const struct name *name = &typing->names.list[i];
        if (holds(&typing->parts, name->text, name->length)) {
            return;
        }
        if (holds(&typing->given, name->text, name->length)) {
            names[count++] = name;
            with_p += name->text[0] == 'p';
        }
    }
    for (int momenta = 0; momenta < 2 && typing->has[FORMULA_H] && count > 0 && count % 2 == 0; momenta++) {
        const char *before = momenta ? " momenta=" : " coordinates=";
        for (size_t i = 0; i < count; i++) {
            const bool is_momentum = 2 * with_p == count ? names[i]->text[0] == 'p' : i >= count / 2;
            const size_t used = strlen(text);
            if (is_momentum == (momenta > 0)) {
                snprintf(text + used, size - used, "%s%.*s", before, (int)names[i]->length, names[i]->text);
                before = ",";
            }
        }
    }
}

/* Checks that every name is given: the components at the start, all others as parameters. */
static bool are_given(const struct typing *typing, struct gm_word_place *place, char *message)
{
    char missing[160] = "";
    bool file_momenta = false; /* momenta are named as in a file, and with coordinates= */
    for (int parameters = 0; parameters < 2; parameters++) {
        const struct names *needed = parameters ? &typing->names : &typing->parts;
        for (size_t i = 0; i < needed->count; i++) {
            const struct name *name = &needed->list[i];
            const int brief = (int)(name->length < 40 ? name->length : 40);
            file_momenta = file_momenta || (parameters && strncmp(name->text, "p_q", 3) == 0);
            if (needs_none(typing, name, !parameters)) {
                continue;
            }
            const size_t used = strlen(missing);
            const bool reserved = gm_reading_reserves(name->text, name->length);
            *place = used && !reserved ? *place : place_of(typing->file, name->text);
            if (reserved) {
                return gm_refuse(message, "the name %.*s is reserved", brief, name->text);
            }
            snprintf(missing + used, sizeof missing - used, "%s%.*s=", used ? " " : "", brief, name->text);
        }
    }
    if (missing[0] && typing->fault.sentence[0]) {
        *place = typing->wrong;
        word_fault(typing->file->words[place->word], place->offset, typing->fault.sentence, message);
    } else if (missing[0]) {
        char pairs[160];
        put_pairs(typing, pairs, sizeof pairs);
        gm_refuse(message, "the formula needs values that are not given: %s%s%s%s", missing,
                  file_momenta ? "; without coordinates= a momentum is p, not p_q" : "",
                  pairs[0] ? "; for other names type" : "", pairs);
    }
    return !missing[0];
}

/* ---- words of another form ---- */

/* Writes "H = p^2/2, q = 1" as words, "H='p^2/2' q=1". Returns their number, 0 for another text. */
static size_t put_assignments(const char *text, FILE *stream)
{
    size_t count = 0;
    for (const char *at = text; *at; count++) {
        at += strspn(at, " ");
        const size_t length = gm_word_first(at), name = gm_name_length(at, length);
        const char *end = at + length, *value = at + name + strspn(at + name, " ");
        if (name == 0 || *value != '=') {
            return 0;
        }
        value += 1 + strspn(value + 1, " ");
        while (end > value && end[-1] == ' ') {
            end--;
        }
        const bool plain = strspn(value, "0123456789.+-eE") >= (size_t)(end - value);
        fprintf(stream, "%s%.*s=%s%.*s%s", count > 0 ? " " : "", (int)name, at, plain ? "" : "'",
                (int)(end - value), value, plain ? "" : "'");
        at += length + (at[length] != '\0');
    }
    return count;
}

/* Writes "x'=y" as a word, "rate='x = y'". Returns 1, or 0 for another word. */
static size_t put_rate(const char *word, const char *before, FILE *stream)
{
    const size_t name = gm_name_length(word, strlen(word)), equals = name + strspn(word + name, "' ");
    if (name == 0 || word[name] != '\'' || word[equals] != '=') {
        return 0;
    }
    const char *value = word + equals + 1;
    fprintf(stream, "%srate='%.*s = %s'", before, (int)name, word, value + strspn(value, " "));
    return 1;
}

/* Refuses words without a formula, with the words that were probably meant. Returns false. */
static bool refuse_words(const struct gm_typed_file *file, char *message)
{
    static const char *const numbers[] = {"one word", "two words", "three words", "four words", "five words"};
    char *text = NULL;
    size_t size = 0, words = 0, rates = 0;
    FILE *stream = open_memstream(&text, &size);
    for (int i = 1; stream && i < file->count && words == 0; i++) {
        const size_t name = strcspn(file->words[i], " =");
        words = file->words[i][name] == ' ' && rates == 0 ? put_assignments(file->words[i], stream) : 0;
        rates += put_rate(file->words[i], rates > 0 ? " " : "", stream);
    }
    const bool written = stream && fclose(stream) == 0;
    if (written && words > 0) {
        gm_refuse(message, "a formula and each value are words of their own, here %s: %.300s",
                  words <= GM_COUNT(numbers) ? numbers[words - 1] : "these", text);
    } else if (written && rates > 0) {
        gm_refuse(message, "a derivative is typed as a rate: %.300s", text);
    } else {
        gm_refuse(message,
                  "scene system needs a formula: H='p^2/2 + q^4/4', or L=, or rate='x = -x' for each "
                  "component");
    }
    free(text);
    return false;
}

/* Writes the lines of the system, and notes the names with a value at the start. */
static bool put_typed(struct typing *typing, FILE *stream, struct gm_word_place *place, char *message)
{
    static const char *const of_files[] = {"bracket", "V", "K-matrix", "L-matrix", NULL};
    const char *value;
    typing->usual = true;
    put_formulas(typing, stream);
    for (int i = 1; i < typing->file->count; i++) {
        const char *key = of_files[key_of(typing->file->words[i], of_files, &value)];
        if (key) {
            *place = (struct gm_word_place){i, 0};
            return gm_refuse(message,
                             "%s= replaces a line of a system's file; a system that is typed without one has "
                             "H=, L= or rate=",
                             key);
        }
    }
    if (!typing->has[FORMULA_H] && !typing->has[FORMULA_L] && !typing->has[FORMULA_RATE]) {
        return refuse_words(typing->file, message);
    }
    if (typing->usual) {
        put_usual_coordinates(typing, stream);
    }
    put_starts_or_parameters(typing, false, stream);
    put_starts_or_parameters(typing, true, stream);
    return are_given(typing, place, message);
}

bool gm_typed_file_write(struct gm_typed_file *file, struct gm_word_place *place, char *message)
{
    const unsigned long refusals = gm_memory_refusals();
    struct typing *typing = calloc(1, sizeof *typing);
    FILE *stream = typing ? open_memstream(&file->text, &file->length) : NULL;
    bool good = false;
    if (stream) {
        typing->file = file;
        good = put_typed(typing, stream, place, message);
        fclose(stream);
    }
    free(typing);
    return gm_memory_refusals() == refusals ? good : gm_refuse(message, "not enough memory");
}
