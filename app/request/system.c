/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Systems of files and of formulas on the command line: where they are, the scenes that are made of them, and
   what is said where one is wrong. */
#include "app/request/system.h"

#include <errno.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/request/arguments.h"
#include "app/request/exit.h"
#include "app/request/place.h"
#include "app/request/room.h"
#include "app/request/share.h"
#include "core/count.h"
#include "core/formula/equations.h"
#include "core/formula/nearest.h"
#include "core/formula/reader.h"
#include "core/memory.h"
#include "render/files/regular_file.h"
#include "render/message.h"
#include "scenes/field/own.h"
#include "scenes/ode/system.h"

static const char ending[] = ".system";

/* The user's own folder; "" if there is none. */
static const char *own_folder(char *folder, size_t size)
{
    const char *own = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    const bool known = own && *own;
    snprintf(folder, size, "%s%s",
             known  ? own
             : home ? home
                    : "",
             known  ? "/geomint"
             : home ? "/.config/geomint"
                    : "");
    return folder;
}

bool gm_system_path(const char *word, char *path, size_t size)
{
    char folder[4096];
    if (gm_word_ends(word, ending)) {
        return snprintf(path, size, "%s", word) < (int)size;
    }
    if (strchr(word, '/') || word[0] == '\0') {
        return false;
    }
    return gm_share_find(gm_share_folder("systems", "GEOMINT_SYSTEMS", folder, sizeof folder), word, ending,
                         path, size) ||
           (own_folder(folder, sizeof folder)[0] && gm_share_find(folder, word, ending, path, size));
}

void gm_system_each(void (*each)(const char *name, const void *data), const void *data)
{
    char folder[4096];
    gm_share_each(gm_share_folder("systems", "GEOMINT_SYSTEMS", folder, sizeof folder), ending, each, data);
    gm_share_each(own_folder(folder, sizeof folder), ending, each, data);
}

static void add_to(const char *name, const void *names)
{
    /* one that memory was too short for is not proposed */
    gm_arguments_add(*(struct gm_arguments *const *)names, name);
}

static const char *name_at(size_t i, const void *names)
{
    return ((const struct gm_arguments *)names)->words[i];
}

const char *gm_system_near(const char *word, char near[GM_NEAR])
{
    struct gm_arguments names = {0}, *list = &names;
    for (size_t i = 0; i < gm_scene_count(); i++) {
        add_to(gm_scene_at(i)->name, &list);
    }
    gm_system_each(add_to, &list);
    gm_room_each(add_to, &list);
    const char *found = gm_nearest(word, (size_t)names.count, name_at, &names);
    snprintf(near, GM_NEAR, "%s", found ? found : "");
    gm_arguments_close(&names);
    return near[0] ? near : NULL;
}

/* The whole of a regular file, or of one that is too large nothing but its length; NULL with a sentence. */
static char *read_file(const char *path, size_t *length, char *message)
{
    char reason[GM_REGULAR_REASON];
    FILE *file = gm_regular_open(path, SIZE_MAX, length, reason);
    if (!file) {
        gm_refuse(message, "%.300s could not be read: %s", path, reason);
        return NULL;
    }
    const bool large = *length > GM_LARGEST_SYSTEM;
    char *text = malloc(large ? 1 : *length + 1);
    if (text && !large) {
        *length = fread(text, 1, *length, file);
        text[*length] = '\0';
    }
    if (!text || ferror(file)) {
        gm_refuse(message, "%.300s could not be read: %s", path,
                  text ? strerror(errno) : "not enough memory");
        free(text);
        text = NULL;
    }
    fclose(file);
    return text;
}

/* A part of a text that is one of some words: `length` bytes from `begin` on. */
struct origin {
    size_t begin, length;
    int word;
    size_t offset; /* in the word */
};

/* A system as lines: those of a file, of words, or of a file whose formulas words replace. */
struct written {
    const char *path; /* NULL: of words alone */
    char *text;
    size_t length;
    struct origin *origins;
    size_t origin_count;
};

static void close_written(struct written *written)
{
    free(written->text);
    free(written->origins);
    *written = (struct written){0};
}

static void put(struct written *written, FILE *lines, const char *text, size_t length)
{
    fwrite(text, 1, length, lines);
    written->length += length;
}

/* Puts a part of a word, and notes whose it is. */
static void put_word(struct written *written, FILE *lines, char *const words[], int word, size_t offset,
                     size_t length)
{
    struct origin *more = realloc(written->origins, (written->origin_count + 1) * sizeof *more);
    if (more) { /* else a place is told less well */
        written->origins = more;
        more[written->origin_count++] = (struct origin){written->length, length, word, offset};
    }
    put(written, lines, words[word] + offset, length);
}

static const struct origin *origin_of(const struct written *written, size_t offset)
{
    for (size_t i = 0; i < written->origin_count; i++) {
        const struct origin *origin = &written->origins[i];
        if (offset >= origin->begin && offset <= origin->begin + origin->length) {
            return origin;
        }
    }
    return NULL;
}

/* What is wrong with a text: where, a sentence, and the place; `words` are those that parts of it were made
   of. */
static int tell_fault(const struct written *written, char *const words[], const struct gm_fault *fault,
                      struct gm_word_place *place, char *message)
{
    const char *name = written->path ? written->path : "system", *text = written->text;
    const size_t length = written->length;
    if (!fault->sentence[0]) {
        gm_refuse(message, "%.300s: not enough memory", name);
        return GM_EXIT_MEMORY;
    }
    const bool placed = fault->offset > 0 && fault->offset < length;
    const struct origin *origin = placed ? origin_of(written, fault->offset) : NULL;
    if (origin) {
        const char *word = words[origin->word];
        const size_t key = strcspn(word, "=") + 1, at = origin->offset + fault->offset - origin->begin;
        place->word = origin->word;
        place->offset = at;
        gm_refuse(message, "in %.*s, column %zu: %.200s", (int)key, word, at >= key ? at - key + 1 : 1,
                  fault->sentence);
        gm_place_show(word + key, strlen(word + key), at >= key ? at - key : 0, message);
        return GM_EXIT_USAGE;
    }
    if (written->path) {
        size_t line, column;
        gm_text_place(text, length <= GM_LARGEST_SYSTEM ? fault->offset : 0, &line, &column);
        gm_refuse(message, "%.150s:%zu:%zu: %.200s", written->path, line, column, fault->sentence);
    } else {
        gm_refuse(message, "system: %.200s", fault->sentence);
    }
    if (placed && written->path) {
        gm_place_show(text, length, fault->offset, message);
    }
    return GM_EXIT_USAGE;
}

int gm_system_open(struct gm_own_system *system, const char *path, const struct gm_system_value *values,
                   size_t count, char *message)
{
    size_t length = 0;
    const unsigned long refusals = gm_memory_refusals();
    char *text = read_file(path, &length, message);
    *system = (struct gm_own_system){0};
    if (!text) {
        return gm_memory_refusals() != refusals ? GM_EXIT_MEMORY : GM_EXIT_FILE;
    }
    struct gm_fault fault;
    struct gm_word_place place;
    struct written written = {.path = path, .text = text, .length = length};
    const int status = gm_equations_open(system, text, length, values, count, &fault)
                           ? GM_EXIT_OK
                           : tell_fault(&written, NULL, &fault, &place, message);
    close_written(&written);
    return status;
}

/* ---- a formula on the command line becomes the lines of a file ---- */

enum { FORMULA_H, FORMULA_L, FORMULA_RATE, FORMULA_COORDINATES };
static const char *const formula_keys[] = {"H", "L", "rate", "coordinates", "momenta", NULL};

/* The value of a word that sets this key; NULL if it sets another one. */
static const char *value_of(const char *word, const char *key, size_t length)
{
    return strncmp(word, key, length) == 0 && word[length] == '=' ? word + length + 1 : NULL;
}

/* The first value of a list, or the first of a range. */
static size_t first_value(const char *value)
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
        const size_t length = first_value(text), left = gm_name_length(text, length);
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
            if (value_of(words[i], keys[k], strlen(keys[k]))) {
                *place = (struct gm_word_place){i, 0};
                return keys[k];
            }
        }
    }
    return NULL;
}

/* What is typed, on its way to the lines of a file. */
struct typing {
    struct written *written;
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
    put(typing->written, typing->lines, key, strlen(key));
    put(typing->written, typing->lines, ": ", 2);
    put_word(typing->written, typing->lines, typing->words, word, (size_t)(value - typing->words[word]),
             strlen(value));
    put(typing->written, typing->lines, "\n", 1);
}

/* Which formula a word is, an index into formula_keys, and where it begins; -1: none. */
static int formula_of(const char *word, const char **value)
{
    for (int k = 0; formula_keys[k]; k++) {
        if ((*value = value_of(word, formula_keys[k], strlen(formula_keys[k])))) {
            return k;
        }
    }
    return -1;
}

static void put_formulas(struct typing *typing)
{
    for (int i = 1; i < typing->count; i++) {
        const char *value;
        const int key = formula_of(typing->words[i], &value);
        if (key < 0) {
            continue;
        }
        put_line(typing, formula_keys[key], value, i);
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
    put(typing->written, typing->lines, *text, strlen(*text));
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
        put(typing->written, typing->lines, key, strlen(key));
        put_word(typing->written, typing->lines, typing->words, i, 0, length);
        put(typing->written, typing->lines, " = ", 3);
        put_word(typing->written, typing->lines, typing->words, i, length + 1, first_value(equals + 1));
        put(typing->written, typing->lines, "\n", 1);
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
            const size_t used = strlen(missing);
            *place = used ? *place : place_in(typing->count, typing->words, name->text);
            snprintf(missing + used, sizeof missing - used, "%s%.*s=", used ? " " : "",
                     (int)(name->length < 40 ? name->length : 40), name->text);
        }
    }
    return !missing[0] || gm_refuse(message, "the formula needs values that are not given: %s", missing);
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

static bool write_typed(struct written *written, int count, char *const words[], struct gm_word_place *place,
                        char *message)
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

/* ---- words that take the place of a file's formulas ---- */

static const char *const replacing_keys[] = {"H", "L",        "V",        "rate", "bracket",
                                             "S", "K-matrix", "L-matrix", NULL};

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
        const char *typed = value_of(words[i], key, strlen(key));
        if (typed) {
            subject_of(key, typed, strlen(typed), subject, sizeof subject);
            if (strcmp(subject, wanted) == 0) {
                return i;
            }
        }
    }
    return -1;
}

/* A file's line with those that go on it: ends at the returned place, behind its newline. */
static const char *end_of_line(const char *line)
{
    do {
        line += strcspn(line, "\n");
        line += *line == '\n';
    } while (*line == ' ' || *line == '\t');
    return line;
}

/* The key of a line, of those that words replace; NULL: it has another one. */
static const char *key_of_line(const char *line)
{
    for (size_t k = 0; replacing_keys[k]; k++) {
        const size_t length = strlen(replacing_keys[k]);
        if (strncmp(line, replacing_keys[k], length) == 0 &&
            line[length + strspn(line + length, " \t")] == ':') {
            return replacing_keys[k];
        }
    }
    return NULL;
}

/* Whether a word is a formula in place of one of the file's lines. */
static bool is_replacing(const char *text, const char *word)
{
    for (const char *line = text; *line; line = end_of_line(line)) {
        const char *key = key_of_line(line);
        if (key && value_of(word, key, strlen(key))) {
            const char *value = strchr(line, ':') + 1;
            char *const words[] = {NULL, (char *)word};
            if (replacing_word(2, words, key, value, (size_t)(end_of_line(line) - value)) == 1) {
                return true;
            }
        }
    }
    return false;
}

/* Puts formulas that were typed where the file has its own; other lines stay. */
static bool replace_lines(struct written *written, int count, char *const words[])
{
    char *text = NULL, *before = written->text;
    size_t size = 0;
    FILE *lines = open_memstream(&text, &size);
    written->length = 0;
    for (const char *line = before, *next; lines && *line; line = next) {
        next = end_of_line(line);
        const char *key = key_of_line(line), *value = key ? strchr(line, ':') + 1 : NULL;
        const int word = key ? replacing_word(count, words, key, value, (size_t)(next - value)) : -1;
        if (word < 0) {
            put(written, lines, line, (size_t)(next - line));
            continue;
        }
        put(written, lines, key, strlen(key));
        put(written, lines, ": ", 2);
        put_word(written, lines, words, word, strlen(key) + 1, strlen(words[word]) - strlen(key) - 1);
        put(written, lines, "\n", 1);
    }
    if (!lines || fclose(lines) != 0) {
        free(text);
        return false;
    }
    free(before);
    written->text = text;
    return true;
}

const char gm_system_typed[] = "system";

int gm_system_open_typed(struct gm_own_system *system, int count, char *const words[], char *message)
{
    struct written written = {0};
    struct gm_word_place place;
    struct gm_fault fault;
    int status = GM_EXIT_OK;
    const unsigned long refusals = gm_memory_refusals();
    *system = (struct gm_own_system){0};
    if (!write_typed(&written, count, words, &place, message)) {
        status = gm_memory_refusals() != refusals ? GM_EXIT_MEMORY : GM_EXIT_USAGE;
    } else if (!gm_equations_open(system, written.text, written.length, NULL, 0, &fault)) {
        status = tell_fault(&written, words, &fault, &place, message);
    }
    system->typed = true;
    close_written(&written);
    return status;
}

/* ---- scenes ---- */

/* A scene that was made, and what of; or a text that a word means. They live as long as the program. */
struct gm_made_system {
    struct gm_made_system *next;
    char *key; /* the words and the text; of a text the word */
    char *text;
    struct gm_arguments words;
    char *name;
    const struct gm_scene *scene;
    void (*close)(const struct gm_scene *scene);
};
static struct gm_made_system *all_made, *all_texts;
static pthread_mutex_t making = PTHREAD_MUTEX_INITIALIZER;

static const struct gm_made_system *find_made(const struct gm_made_system *list, const char *key)
{
    while (list && strcmp(list->key, key) != 0) {
        list = list->next;
    }
    return list;
}

static void free_made(struct gm_made_system *made)
{
    if (made) {
        gm_arguments_close(&made->words);
        free(made->key);
        free(made->text);
        free(made->name);
        free(made);
    }
}

bool gm_system_recall(const char *word, const char *text)
{
    struct gm_made_system *made = calloc(1, sizeof *made);
    if (!made || !(made->key = strdup(word)) || !(made->text = strdup(text))) {
        free_made(made);
        return false;
    }
    made->next = all_texts;
    all_texts = made;
    return true;
}

bool gm_system_is(const char *word)
{
    char path[4096];
    return strcmp(word, gm_system_typed) == 0 || find_made(all_texts, word) || gm_room_is(word) ||
           gm_system_path(word, path, sizeof path);
}

/* The file's name, without what no file's name should have. */
static char *name_of(const char *word)
{
    const char *slash = strrchr(word, '/');
    char *name = strdup(slash ? slash + 1 : word);
    if (name && gm_word_ends(name, ending)) {
        name[strlen(name) - (sizeof ending - 1)] = '\0';
    }
    for (char *at = name; at && *at; at++) {
        const bool usual =
            (*at >= '0' && *at <= '9') || (*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z');
        *at = usual || strchr("-_.", *at) ? *at : '_';
    }
    return name;
}

/* Of the words those that the scene is made of: formulas, and values that the graph is built on. */
static bool choose_words(struct gm_made_system *made, const struct gm_own_system *system, bool typed,
                         int count, char *const words[], struct gm_system_value *values, size_t *value_count,
                         struct gm_word_place *place, char *message)
{
    bool good = gm_arguments_add(&made->words, words[0]);
    for (int i = 1; i < count && good; i++) {
        const size_t length = strcspn(words[i], "=");
        for (size_t k = 0; formula_keys[k] && typed && good; k++) {
            if (value_of(words[i], formula_keys[k], strlen(formula_keys[k]))) {
                good = gm_arguments_add(&made->words, words[i]);
            }
        }
        if (!typed && is_replacing(system->source, words[i])) {
            good = gm_arguments_add(&made->words, words[i]);
        }
        for (size_t k = system->parameters; k < system->velocities && good && words[i][length]; k++) {
            const struct gm_system_variable *variable = &system->variables[k];
            if (!variable->fixed || !value_of(words[i], variable->name, strlen(variable->name))) {
                continue;
            }
            const char *value = words[i] + length + 1;
            if (first_value(value) < strlen(value)) {
                *place = (struct gm_word_place){i, length + 1};
                return gm_refuse(message,
                                 "%s= takes one value: it is in an index, and the equations are built on it",
                                 variable->name);
            }
            values[*value_count] = (struct gm_system_value){variable->name, value};
            ++*value_count;
            good = gm_arguments_add(&made->words, words[i]);
        }
    }
    return good || gm_refuse(message, "not enough memory");
}

/* Where the text has the line that a sentence "word: what is wrong" is about: the next word of the sentence in
   it, or its value; 0: nowhere. */
static size_t line_told(const char *text, const char *sentence)
{
    const size_t word = strcspn(sentence, ": ") + 1;
    const char *line = sentence[word - 1] == ':' ? text : NULL;
    while (line && strncmp(line, sentence, word) != 0) {
        line = strchr(line, '\n');
        line += line != NULL;
    }
    if (!line) {
        return 0;
    }
    const char *value = line + word + strspn(line + word, " \t");
    const char *wrong = sentence + word + strspn(sentence + word, " ");
    const size_t length = strcspn(wrong, " "), room = strcspn(value, "\n");
    for (size_t i = 0; length > 0 && i + length <= room; i++) {
        if (strncmp(value + i, wrong, length) == 0) {
            return (size_t)(value + i - text);
        }
    }
    return (size_t)(value - text);
}

/* Makes a scene of the lines, or finds the one that was kept. */
static bool make(struct gm_made_system *made, const struct written *written, int count, char *const words[],
                 struct gm_system_trial *trial, char *message)
{
    struct gm_own_system first, system;
    struct gm_fault fault;
    const bool typed = !written->path;
    const unsigned long refusals = gm_memory_refusals();
    struct gm_system_value *values = calloc((size_t)count, sizeof *values);
    size_t value_count = 0;
    if (!values) {
        trial->status = GM_EXIT_MEMORY;
        return gm_refuse(message, "not enough memory");
    }
    if (!gm_system_read(&first, written->text, written->length, NULL, 0, &fault)) {
        trial->status = tell_fault(written, words, &fault, &trial->place, message);
    } else if (choose_words(made, &first, typed, count, words, values, &value_count, &trial->place,
                            message)) {
        char *all = gm_arguments_join("", &made->words);
        if (!all || asprintf(&made->key, "%s\n%s", all, written->text) < 0) {
            made->key = NULL;
        }
        free(all);
        const struct gm_made_system *known = made->key ? find_made(all_made, made->key) : NULL;
        made->name = name_of(words[0]);
        if (known) {
            trial->scene = known->scene;
        } else if (!made->key || !made->name) {
            gm_refuse(message, "not enough memory");
        } else if (!gm_equations_open(&system, written->text, written->length, values, value_count, &fault)) {
            trial->status = tell_fault(written, words, &fault, &trial->place, message);
            gm_system_close(&system);
        } else if (gm_arguments_end(&made->words)) {
            const char *const *own = (const char *const *)made->words.words;
            const bool field = gm_system_is_field(&system);
            made->close = field ? gm_own_field_close : gm_system_scene_close;
            trial->scene = made->scene = field
                                             ? gm_own_field_open(&system, made->name, own, message)
                                             : gm_system_scene_open(&system, made->name, own, typed, message);
            fault.offset = trial->scene || typed ? 0 : line_told(written->text, message);
            if (fault.offset > 0) {
                snprintf(fault.sentence, sizeof fault.sentence, "%s", message);
                trial->status = tell_fault(written, words, &fault, &trial->place, message);
            }
        } else {
            gm_system_close(&system);
            trial->status = GM_EXIT_MEMORY;
            gm_refuse(message, "not enough memory");
        }
    }
    gm_system_close(&first);
    free(values);
    if (gm_memory_refusals() != refusals) { /* whatever else was blamed, and what is only there in part */
        if (made->scene) {
            made->close(made->scene);
        }
        trial->scene = made->scene = NULL;
        trial->status = GM_EXIT_MEMORY;
        gm_refuse(message, "not enough memory");
    }
    return trial->scene != NULL;
}

/* The lines that the words mean. */
static bool write_lines(struct written *written, char *path, size_t size, int count, char *const words[],
                        struct gm_system_trial *trial, char *message)
{
    const struct gm_made_system *recalled = find_made(all_texts, words[0]);
    if (strcmp(words[0], gm_system_typed) == 0) {
        return write_typed(written, count, words, &trial->place, message);
    }
    written->path = path;
    if (recalled) {
        written->text = strdup(recalled->text);
        written->length = strlen(recalled->text);
        snprintf(path, size, "%s", words[0]);
    } else if (gm_system_path(words[0], path, size)) {
        trial->status = GM_EXIT_FILE;
        written->text = read_file(path, &written->length, message);
    } else {
        return gm_refuse(message, "there is no system \"%.60s\"", words[0]);
    }
    if (!written->text) {
        return recalled ? gm_refuse(message, "not enough memory") : false;
    }
    if (written->length > GM_LARGEST_SYSTEM) {
        return gm_refuse(message, "%.300s is larger than %d bytes", path, GM_LARGEST_SYSTEM);
    }
    if (gm_text_valid(written->text, written->length) < written->length) {
        /* a byte that is no text ends it for what reads strings; the reader says which */
        struct gm_own_system system;
        struct gm_fault fault;
        if (!gm_system_read(&system, written->text, written->length, NULL, 0, &fault)) {
            trial->status = tell_fault(written, words, &fault, &trial->place, message);
        }
        gm_system_close(&system);
        return false;
    }
    return replace_lines(written, count, words) || gm_refuse(message, "not enough memory");
}

bool gm_system_try(struct gm_system_trial *trial, int count, char *const words[], char *message)
{
    char path[4096];
    struct written written = {0};
    *trial = (struct gm_system_trial){.status = GM_EXIT_USAGE, .place = {.word = -1}};
    if (gm_room_is(words[0]) && !gm_system_path(words[0], path, sizeof path)) {
        trial->scene = gm_room_scene(words[0], &trial->status, message);
        return trial->scene != NULL;
    }
    struct gm_made_system *made = calloc(1, sizeof *made);
    trial->made = made;
    bool good = made || gm_refuse(message, "not enough memory");
    good = good && write_lines(&written, path, sizeof path, count, words, trial, message);
    if (good) {
        trial->status = GM_EXIT_USAGE;
        pthread_mutex_lock(&making);
        good = make(made, &written, count, words, trial, message);
        pthread_mutex_unlock(&making);
    }
    close_written(&written);
    return good;
}

void gm_system_trial_close(struct gm_system_trial *trial)
{
    if (trial->made && trial->made->scene) {
        trial->made->close(trial->made->scene);
    }
    free_made(trial->made);
    *trial = (struct gm_system_trial){0};
}

void gm_system_trial_keep(struct gm_system_trial *trial)
{
    if (!trial->made || !trial->made->scene) {
        return;
    }
    pthread_mutex_lock(&making);
    trial->made->next = all_made;
    all_made = trial->made;
    pthread_mutex_unlock(&making);
    trial->made = NULL;
}

const struct gm_scene *gm_system_scene(int count, char *const words[], int *status, char *message)
{
    struct gm_system_trial trial;
    gm_system_try(&trial, count, words, message);
    const struct gm_scene *scene = trial.scene;
    *status = trial.status;
    gm_system_trial_keep(&trial);
    gm_system_trial_close(&trial);
    return scene;
}

/* ---- a system as it is now, for a file ---- */

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
    for (const char *line = text; *line; line = end_of_line(line)) {
        if (strncmp(line, word, letters) == 0 && line[letters] == ':') {
            return true;
        }
    }
    return false;
}

char *gm_system_text(const struct gm_scene *scene, const void *parameters)
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
        next = end_of_line(line);
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
        bool replaced = false;
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

/* ---- the formulas of a system as words ---- */

const char *const *gm_system_keys(const char *word)
{
    return strcmp(word, gm_system_typed) == 0 ? formula_keys : replacing_keys;
}

bool gm_system_formulas(const char *text, struct gm_arguments *words)
{
    bool good = true;
    for (const char *line = text; good && *line; line = end_of_line(line)) {
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
        for (const char *at = strchr(line, ':') + 1, *end = end_of_line(line); stream && at < end; at++) {
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
