/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A formula on the command line becomes the lines of a file. */
#include "app/words/worded.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/place.h"
#include "core/basics.h"
#include "core/expression/reader.h"
#include "core/model/scope.h"
#include "render/message.h"

enum { FORMULA_H, FORMULA_L, FORMULA_RATE, FORMULA_COORDINATES };
const char *const gm_worded_keys[] = {"H", "L", "rate", "coordinates", "momenta", NULL};

struct name {
    const char *text;
    size_t length;
};

static bool is_name(const struct name *name, const char *text, size_t length)
{
    return name->length == length && memcmp(name->text, text, length) == 0;
}

enum { MOST_NAMES = 256 };

struct names {
    struct name list[MOST_NAMES];
    size_t count;
};

static bool holds(const struct names *names, const char *text, size_t length)
{
    for (size_t i = 0; i < names->count; i++) {
        if (is_name(&names->list[i], text, length)) {
            return true;
        }
    }
    return false;
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
                   !gm_formula_reserves(text, length)) { /* what is called is a function, or none */
            note(names, text, length);
        }
        text += length;
    }
}

/* The names in rates, x = y, y = -x: what stands on the left is a part of the state. */
static void collect_rates(struct names *parts, struct names *names, struct names *indices, const char *text)
{
    while (*(text += strspn(text, " \t"))) {
        const size_t length = gm_word_first(text), left = gm_name_length(text, length);
        if (left > 0) {
            note(parts, text, left);
        }
        collect(names, indices, text + left, length - left);
        text += length + (text[length] != '\0');
    }
}

/* "coordinates: q1 q2", as far as such names occur, or q alone, their momenta and, where they are called
   v1, v2, their velocities; malloc'ed. */
static char *default_coordinates(const struct names *names, bool velocities)
{
    static const char *const lists[] = {"coordinates", "momenta", "velocities"};
    char *text = NULL, name[32], prime[32];
    size_t size = 0;
    int n = 0;
    do {
        n++;
        snprintf(name, sizeof name, "q%d", n);
        snprintf(prime, sizeof prime, "p%d", n);
    } while (holds(names, name, strlen(name)) || holds(names, prime, strlen(prime)));
    FILE *lines = open_memstream(&text, &size);
    for (int list = 0; lines && list < 2 + velocities; list++) {
        fprintf(lines, "%s:", lists[list]);
        for (int i = 1; i < n; i++) {
            fprintf(lines, " %c%d", "qpv"[list], i);
        }
        if (n == 1) {
            fprintf(lines, " %c", "qpv"[list]);
        }
        fputs("\n", lines);
    }
    return lines && fclose(lines) == 0 ? text : NULL;
}

/* The momentum or the velocity of a part: p_q, v_q. */
static bool is_derived(const struct names *parts, const char *name, size_t length)
{
    return length > 2 && (name[0] == 'p' || name[0] == 'v') && name[1] == '_' &&
           holds(parts, name + 2, length - 2);
}

/* Whether a usual momentum, p1, need not be given: the velocity is, v_q1 or v1. */
static bool has_velocity(const struct names *given, const struct name *momentum)
{
    char written[40], called[40];
    const int digits = (int)momentum->length - 1;
    snprintf(written, sizeof written, "v_q%.*s", digits, momentum->text + 1);
    snprintf(called, sizeof called, "v%.*s", digits, momentum->text + 1);
    return momentum->text[0] == 'p' && momentum->length < 30 &&
           (holds(given, written, strlen(written)) || holds(given, called, strlen(called)));
}

/* Which of the words a place in them belongs to. */
static struct gm_word_place place_in(int count, char *const words[], const char *at)
{
    for (int i = 0; i < count; i++) {
        if (at >= words[i] && at <= words[i] + strlen(words[i])) {
            return (struct gm_word_place){i, (size_t)(at - words[i])};
        }
    }
    return (struct gm_word_place){-1, 0};
}

/* The key of a word that only a file's equations have; NULL if there is none. */
static const char *line_of_files(int count, char *const words[], struct gm_word_place *place)
{
    static const char *const keys[] = {"bracket", "V", "K-matrix", "L-matrix"};
    for (int i = 1; i < count; i++) {
        for (size_t k = 0; k < GM_COUNT(keys); k++) {
            if (gm_word_after(words[i], keys[k], strlen(keys[k]))) {
                *place = (struct gm_word_place){i, 0};
                return keys[k];
            }
        }
    }
    return NULL;
}

/* What is typed, on its way to the lines of a file. */
struct typing {
    struct gm_system_lines *written;
    FILE *lines;
    int count;
    char *const *words;
    struct names names; /* in the formulas of H and L, and on the right of rates */
    struct names parts; /* components of the state */
    struct names given; /* which have a value, and those that need none: the indices of sums */
    bool energy, lagrange, rate, coordinates; /* which keys there are */
    bool usual;                               /* the coordinates are q or q1, q2, as nothing else is said */
    bool velocities;                          /* they are called v, or v1, v2 */
};

static void put_line(const struct typing *typing, const char *key, const char *value, int word)
{
    gm_system_lines_put(typing->written, typing->lines, key, strlen(key));
    gm_system_lines_put(typing->written, typing->lines, ": ", 2);
    gm_system_lines_put_word(typing->written, typing->lines, typing->words, word,
                             (size_t)(value - typing->words[word]), strlen(value));
    gm_system_lines_put(typing->written, typing->lines, "\n", 1);
}

/* Which formula a word is, an index into gm_worded_keys, and where it begins; -1: none. */
static int formula_of(const char *word, const char **value)
{
    for (int k = 0; gm_worded_keys[k]; k++) {
        if ((*value = gm_word_after(word, gm_worded_keys[k], strlen(gm_worded_keys[k])))) {
            return k;
        }
    }
    return -1;
}

bool gm_worded_is_formula(const char *word)
{
    const char *value;
    const int key = formula_of(word, &value);
    return key >= 0 && key < FORMULA_COORDINATES;
}

static void put_formulas(struct typing *typing)
{
    for (int i = 1; i < typing->count; i++) {
        const char *value;
        const int key = formula_of(typing->words[i], &value);
        if (key < 0) {
            continue;
        }
        put_line(typing, gm_worded_keys[key], value, i);
        typing->energy |= key == FORMULA_H;
        typing->lagrange |= key == FORMULA_L;
        typing->rate |= key == FORMULA_RATE;
        typing->coordinates |= key == FORMULA_COORDINATES;
        if (key == FORMULA_RATE) {
            collect_rates(&typing->parts, &typing->names, &typing->given, value);
        } else {
            const bool energy = key == FORMULA_H || key == FORMULA_L;
            collect(energy ? &typing->names : &typing->parts, &typing->given, value, strlen(value));
        }
    }
}

/* Without coordinates= the usual ones; `text`, malloc'ed, holds their names. False: out of memory. */
static bool put_usual_coordinates(struct typing *typing, char **text)
{
    if (typing->rate || typing->coordinates) {
        return true;
    }
    const struct names *names = &typing->names;
    typing->velocities =
        typing->lagrange && (holds(names, "q1", 2) ? holds(names, "v1", 2) : holds(names, "v", 1));
    *text = default_coordinates(names, typing->velocities);
    if (!*text) {
        return false;
    }
    typing->usual = true;
    const char *list = strchr(*text, ':');
    collect(&typing->parts, &typing->given, list, strlen(list));
    note(&typing->given, "momenta", strlen("momenta"));
    note(&typing->given, "velocities", strlen("velocities"));
    gm_system_lines_put(typing->written, typing->lines, *text, strlen(*text));
    return true;
}

static bool is_part(const struct typing *typing, const char *name, size_t length)
{
    return holds(&typing->parts, name, length) || is_derived(&typing->parts, name, length);
}

/* The words that give a component its value at the start, or the others, which are parameters. */
static void put_starts_or_parameters(struct typing *typing, bool starts)
{
    const char *key = starts ? "start: " : "parameter: ", *formula;
    for (int i = 1; i < typing->count; i++) {
        const char *word = typing->words[i], *equals = strchr(word, '=');
        const size_t plain = strcspn(word, "[=");
        const bool part = is_part(typing, word, plain);
        if (!equals || formula_of(word, &formula) >= 0 || part != starts ||
            (!part && !holds(&typing->names, word, plain))) {
            continue;
        }
        const size_t length = (size_t)(equals - word);
        gm_system_lines_put(typing->written, typing->lines, key, strlen(key));
        gm_system_lines_put_word(typing->written, typing->lines, typing->words, i, 0, length);
        gm_system_lines_put(typing->written, typing->lines, " = ", 3);
        gm_system_lines_put_word(typing->written, typing->lines, typing->words, i, length + 1,
                                 gm_word_first(equals + 1));
        gm_system_lines_put(typing->written, typing->lines, "\n", 1);
        note(&typing->given, word, plain);
    }
}

/* Whether a name may stand without a value. */
static bool needs_none(const struct typing *typing, const struct name *name, bool part)
{
    if (is_name(name, "t", 1) || holds(&typing->given, name->text, name->length)) {
        return true;
    }
    if (typing->usual && typing->lagrange && has_velocity(&typing->given, name)) {
        return true;
    }
    return part ? typing->velocities && name->text[0] == 'v' /* else the momentum is given */
                : is_part(typing, name->text, name->length);
}

/* A formula while nobody has said yet what its names are worth. */
struct unvalued {
    struct gm_formula graph;
    struct names names, indices;
};

static enum gm_meaning find_unvalued(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    (void)sentence;
    struct unvalued *formula = data;
    *node = gm_formula_constant(&formula->graph, 1);
    return holds(&formula->names, name->text, name->length) &&
                   !holds(&formula->indices, name->text, name->length)
               ? GM_KNOWN
               : GM_UNKNOWN;
}

static const char *no_name(size_t i, const void *data)
{
    (void)i;
    (void)data;
    return NULL;
}

/* Whether text[0 .. length) in words[word] is a formula, whatever its names are. */
static bool is_formula(char *const words[], int word, const char *text, size_t length,
                       struct gm_word_place *place, char *message)
{
    struct unvalued formula = {.names = {.count = 0}};
    gm_formula_open(&formula.graph);
    collect(&formula.names, &formula.indices, text, length);
    const struct gm_scope scope = {.find = find_unvalued, .known = no_name, .data = &formula};
    gm_node_id node;
    struct gm_fault fault = {0};
    const bool good = gm_formula_read(&formula.graph, text, 0, length, &scope, &node, &fault);
    gm_formula_close(&formula.graph);
    if (good || !fault.sentence[0]) {
        return true; /* what memory was too short for is said where it is needed */
    }
    *place = (struct gm_word_place){word, (size_t)(text - words[word]) + fault.offset};
    gm_system_word_fault(words[word], place->offset, fault.sentence, message);
    return false;
}

/* Whether H, L and what stands on the right of rates can be read, before anybody asks for values. */
static bool are_formulas(const struct typing *typing, struct gm_word_place *place, char *message)
{
    for (int i = 1; i < typing->count; i++) {
        const char *text;
        const int key = formula_of(typing->words[i], &text);
        if ((key == FORMULA_H || key == FORMULA_L) &&
            !is_formula(typing->words, i, text, strlen(text), place, message)) {
            return false;
        }
        while (key == FORMULA_RATE && *text) {
            const size_t length = gm_word_first(text);
            const char *equals = memchr(text, '=', length);
            if (equals && !is_formula(typing->words, i, equals + 1, length - (size_t)(equals + 1 - text),
                                      place, message)) {
                return false;
            }
            text += length + (text[length] != '\0');
        }
    }
    return true;
}

/* Whether a formula has p_q, as momenta are called in a file, and with coordinates=. */
static bool means_momenta(const struct typing *typing)
{
    bool found = false;
    for (size_t i = 0; i < typing->names.count; i++) {
        found = found || strncmp(typing->names.list[i].text, "p_q", 3) == 0;
    }
    return found;
}

/* Every name has to be given: the components at the start, all others as parameters. */
static bool are_given(const struct typing *typing, struct gm_word_place *place, char *message)
{
    char missing[160] = "";
    for (int parameters = 0; parameters < 2; parameters++) {
        const struct names *needed = parameters ? &typing->names : &typing->parts;
        for (size_t i = 0; i < needed->count; i++) {
            const struct name *name = &needed->list[i];
            if (needs_none(typing, name, !parameters)) {
                continue;
            }
            if (gm_reading_reserves(name->text, name->length)) {
                *place = place_in(typing->count, typing->words, name->text);
                return gm_refuse(message, "the name %.*s is reserved",
                                 (int)(name->length < 40 ? name->length : 40), name->text);
            }
            const size_t used = strlen(missing);
            *place = used ? *place : place_in(typing->count, typing->words, name->text);
            snprintf(missing + used, sizeof missing - used, "%s%.*s=", used ? " " : "",
                     (int)(name->length < 40 ? name->length : 40), name->text);
        }
    }
    if (!missing[0]) {
        return true;
    }
    struct gm_word_place wrong;
    if (!are_formulas(typing, &wrong, message)) {
        *place = wrong;
        return false;
    }
    return gm_refuse(message, "the formula needs values that are not given: %s%s", missing,
                     means_momenta(typing) ? "; without coordinates= a momentum is p, not p_q" : "");
}

/* What the system is made of: its lines, and which names have a value at the start. */
static bool put_typed(struct typing *typing, char **coordinates, struct gm_word_place *place, char *message)
{
    put_formulas(typing);
    const char *const of_files = line_of_files(typing->count, typing->words, place);
    if (of_files) {
        return gm_refuse(message,
                         "%s= takes the place of a line in a system's file; what is typed without one has "
                         "H=, L= or rate=",
                         of_files);
    }
    if (!typing->energy && !typing->lagrange && !typing->rate) {
        return gm_refuse(message,
                         "scene system needs a formula: H='p^2/2 + q^4/4', or L=, or rate='x = -x' for each "
                         "component");
    }
    if (!put_usual_coordinates(typing, coordinates)) {
        return gm_refuse(message, "not enough memory");
    }
    put_starts_or_parameters(typing, false);
    put_starts_or_parameters(typing, true);
    return are_given(typing, place, message);
}

bool gm_worded_write(struct gm_system_lines *written, int count, char *const words[],
                     struct gm_word_place *place, char *message)
{
    size_t size = 0;
    char *coordinates = NULL;
    struct typing *typing = calloc(1, sizeof *typing);
    FILE *lines = open_memstream(&written->text, &size);
    bool good = typing && lines;
    if (good) {
        typing->written = written;
        typing->lines = lines;
        typing->count = count;
        typing->words = words;
        good = put_typed(typing, &coordinates, place, message);
    } else {
        gm_refuse(message, "not enough memory");
    }
    free(typing);
    free(coordinates);
    return (!lines || fclose(lines) == 0) && good;
}
