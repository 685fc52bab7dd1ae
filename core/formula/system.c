/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads systems: lines, then names, then formulas; a name that needs another one first waits for it. */
#include "core/formula/system.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/formula/lines.h"
#include "core/formula/nearest.h"
#include "core/formula/number.h"

enum {
    ONCE = 0,
    OFTEN = 1,
    CANONICAL = 1 << GM_CANONICAL,
    LAGRANGIAN = 1 << GM_LAGRANGIAN,
    RATES = 1 << GM_RATES,
    POISSON = 1 << GM_POISSON,
    FIELD = 1 << GM_FIELD,
    EVOLUTION = 1 << GM_EVOLUTION,
    MATRICES = 1 << GM_MATRICES,
    LINE = FIELD | EVOLUTION | MATRICES,
    MOTION = CANONICAL | LAGRANGIAN | RATES | POISSON,
    ANY = MOTION | LINE
};

static const struct {
    const char *word;
    bool repeated;
    unsigned kinds;
} words[GM_WORDS] = {
#define GM_WORD(constant, word, often, kinds) {word, often, kinds},
#include "core/formula/words.def"
#undef GM_WORD
};

struct line {
    enum gm_system_word word;
    size_t place;
    struct gm_span value;
};

enum role { COMPONENT, VELOCITY, PARAMETER, TIME, NAMED };

/* A name of the system, or an element of a list. */
struct entry {
    char *name;                   /* its own, closed by a NUL, once it is among the entries */
    size_t length, place, number; /* the number among those of its role */
    bool indexed;
    long index;
    enum role role;
    enum { UNREAD, READING, READ } state; /* of parameters and lets */
    struct gm_span value;                 /* their formula */
    long element;                         /* the index that is bound in it; LONG_MIN: none */
    struct gm_span bound;
    gm_node_id node;
};

struct reading {
    struct gm_own_system *system;
    const char *text;
    size_t length;
    struct line *lines;
    size_t line_count;
    struct entry *entries;
    size_t entry_count, entry_capacity;
    uint32_t *table; /* open addressing, number + 1 */
    size_t slots;
    uint32_t wanted; /* the entry that has to be read first */
    bool fixed;      /* parameters are constants in what is read */
    bool structural; /* and the graph depends on their values */
    bool initial;
    struct gm_span counter; /* the index that a line is repeated with, and its value; empty: there is none */
    long counted;
    size_t component_count, velocity_count, parameter_count;
    const struct gm_system_value *values;
    size_t value_count;
    struct gm_fault *fault;
    bool failed, no_memory;
};

__attribute__((format(printf, 3, 4))) static bool fail(struct reading *reading, size_t place,
                                                       const char *format, ...)
{
    if (!reading->failed) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(reading->fault->sentence, sizeof reading->fault->sentence, format, arguments);
        va_end(arguments);
        reading->fault->offset = place;
        reading->failed = true;
    }
    return false;
}

static bool no_memory(struct reading *reading)
{
    if (!reading->failed) {
        *reading->fault = (struct gm_fault){0};
    }
    reading->failed = reading->no_memory = true;
    return false;
}

/* memory for `count` more of an array that grows by doubling */
static bool reserve(struct reading *reading, void **array, size_t count, size_t size)
{
    if ((count & (count - 1)) == 0) {
        void *more = realloc(*array, (count ? 2 * count : 1) * size);
        if (!more) {
            return no_memory(reading);
        }
        *array = more;
    }
    return true;
}

/* -- lines
   ------------------------------------------------------------------------------------------------- */

static const char *word_at(size_t i, const void *data)
{
    (void)data;
    return words[i].word;
}

static size_t line_of(const struct reading *reading, size_t place)
{
    size_t line, column;
    gm_text_place(reading->text, place, &line, &column);
    return line;
}

static bool read_line(struct reading *reading, const struct gm_text_line *text_line)
{
    const size_t place = text_line->word.begin, letters = text_line->word.end - place;
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)(letters < 60 ? letters : 60), reading->text + place);
    enum gm_system_word word = 0;
    while (word < GM_WORDS && strcmp(words[word].word, name) != 0) {
        word++;
    }
    if (word == GM_WORDS) {
        const char *near = gm_nearest(name, GM_WORDS, word_at, NULL);
        return fail(reading, place, "a system has no line \"%s\"%s%s", name, near ? "; did you mean " : "",
                    near ? near : "");
    }
    for (size_t i = 0; i < reading->line_count && !words[word].repeated; i++) {
        if (reading->lines[i].word == word) {
            return fail(reading, place, "%s is said twice", name);
        }
    }
    if (!reserve(reading, (void **)&reading->lines, reading->line_count, sizeof *reading->lines)) {
        return false;
    }
    const struct gm_span value = text_line->value;
    reading->lines[reading->line_count++] = (struct line){word, place, value};
    return value.begin < value.end || fail(reading, place + letters + 1, "%s: says nothing", name);
}

static bool read_lines(struct reading *reading)
{
    struct gm_text_line line;
    struct gm_fault fault;
    for (size_t at = 0; gm_lines_next(reading->text, reading->length, &at, &line, &fault);) {
        if (!read_line(reading, &line)) {
            return false;
        }
    }
    return !fault.sentence[0] || fail(reading, fault.offset, "%s", fault.sentence);
}

/* Words with one blank between them; malloc'ed. */
static char *text_of(struct reading *reading, struct gm_span span)
{
    char *text = gm_span_words(reading->text, span);
    if (!text) {
        no_memory(reading);
    }
    return text;
}

/* -- names
   ------------------------------------------------------------------------------------------------- */

static uint32_t *slot_of(const struct reading *reading, const char *name, size_t length, bool indexed,
                         long index)
{
    uint64_t hash = indexed ? (uint64_t)index * 2 + 1 : 0;
    for (size_t i = 0; i < length; i++) {
        hash = (hash ^ (unsigned char)name[i]) * UINT64_C(0x100000001b3);
    }
    hash ^= hash >> 29;
    for (size_t slot = (size_t)hash & (reading->slots - 1);; slot = (slot + 1) & (reading->slots - 1)) {
        const uint32_t number = reading->table[slot];
        const struct entry *entry = number ? &reading->entries[number - 1] : NULL;
        if (!entry || (entry->length == length && entry->indexed == indexed && entry->index == index &&
                       memcmp(entry->name, name, length) == 0)) {
            return &reading->table[slot];
        }
    }
}

static struct entry *entry_of(const struct reading *reading, const char *name, size_t length, bool indexed,
                              long index)
{
    const uint32_t number =
        reading->slots ? *slot_of(reading, name, length, indexed, indexed ? index : 0) : 0;
    return number ? &reading->entries[number - 1] : NULL;
}

/* Any element of a list of that name. */
static const struct entry *list_of(const struct reading *reading, const char *name, size_t length, long *low,
                                   long *high)
{
    const struct entry *found = NULL;
    for (size_t i = 0; i < reading->entry_count; i++) {
        const struct entry *entry = &reading->entries[i];
        if (entry->indexed && entry->length == length && memcmp(entry->name, name, length) == 0) {
            *low = found && *low < entry->index ? *low : entry->index;
            *high = found && *high > entry->index ? *high : entry->index;
            found = entry;
        }
    }
    return found;
}

static bool is_reserved(const char *name, size_t length)
{
    /* keys of a command line, and columns of tables */
    static const char *const reserved[] = {
        "dt",      "until",   "steps",     "scheme", "schemes",     "zip",    "overlay",
        "equal",   "show",    "members",   "t",      "lane",        "meta",   "compensated",
        "binding", "tau0",    "tolerance", "spread", "scene",       "status", "evaluations",
        "solves",  "seconds", "stopped",   "shape",  "newmark_beta"};
    for (size_t i = 0; i < sizeof reserved / sizeof *reserved; i++) {
        if (strlen(reserved[i]) == length && memcmp(reserved[i], name, length) == 0) {
            return true;
        }
    }
    return gm_formula_reserves(name, length);
}

/* keys of a ring */
static bool is_of_ring(const struct reading *reading, const struct entry *entry)
{
    static const char *const keys[] = {"half_length", "points", "space", "boundary"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys && gm_system_is_field(reading->system); i++) {
        if (entry->length == strlen(keys[i]) && memcmp(entry->name, keys[i], entry->length) == 0) {
            return true;
        }
    }
    return false;
}

static bool add_entry(struct reading *reading, struct entry entry)
{
    const int brief = (int)(entry.length < 60 ? entry.length : 60);
    if (is_of_ring(reading, &entry) || (entry.role != TIME && is_reserved(entry.name, entry.length))) {
        return fail(reading, entry.place, "the name %.*s is reserved", brief, entry.name);
    }
    if (reading->entry_count == reading->entry_capacity) {
        const size_t capacity = reading->entry_capacity ? 2 * reading->entry_capacity : 32;
        struct entry *more = realloc(reading->entries, capacity * sizeof *more);
        reading->entries = more ? more : reading->entries;
        uint32_t *table = calloc(4 * capacity, sizeof *table);
        if (!more || !table) {
            free(table);
            return no_memory(reading);
        }
        free(reading->table);
        reading->table = table;
        reading->entry_capacity = capacity;
        reading->slots = 4 * capacity;
        for (size_t i = 0; i < reading->entry_count; i++) {
            *slot_of(reading, more[i].name, more[i].length, more[i].indexed, more[i].index) = (uint32_t)i + 1;
        }
    }
    const struct entry *other = entry_of(reading, entry.name, entry.length, !entry.indexed, 0);
    uint32_t *slot = slot_of(reading, entry.name, entry.length, entry.indexed, entry.index);
    long low = 0, high = 0;
    if (*slot) {
        other = &reading->entries[*slot - 1];
    } else if (!entry.indexed) {
        other = list_of(reading, entry.name, entry.length, &low, &high);
    }
    if (other) {
        return fail(reading, entry.place, "%.*s is defined twice, first in line %zu", brief, entry.name,
                    line_of(reading, other->place));
    }
    char *name = strndup(entry.name, entry.length);
    if (!name) {
        return no_memory(reading);
    }
    entry.name = name;
    reading->entries[reading->entry_count] = entry;
    *slot = (uint32_t)++reading->entry_count;
    return true;
}

static const char *known(size_t i, const void *data)
{
    const struct reading *reading = data;
    return i < reading->entry_count ? reading->entries[i].name : NULL;
}

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    struct reading *reading = data;
    struct gm_own_system *system = reading->system;
    const int brief = (int)(name->length < 60 ? name->length : 60);
    const bool fixed = name->fixed || reading->fixed;
    struct entry *entry = entry_of(reading, name->text, name->length, name->indexed, name->index);
    if (!entry) {
        long low = 0, high = 0;
        const bool is_scalar = entry_of(reading, name->text, name->length, false, 0) != NULL;
        const bool is_list = list_of(reading, name->text, name->length, &low, &high) != NULL;
        if (name->indexed && is_list) {
            snprintf(sentence, GM_FAULT_SENTENCE, "%.*s[%ld] lies outside of %.*s[%ld] .. %.*s[%ld]", brief,
                     name->text, name->index, brief, name->text, low, brief, name->text, high);
        } else if (is_list) {
            snprintf(sentence, GM_FAULT_SENTENCE,
                     "%.*s is a list: an index was expected, %.*s[%ld] .. %.*s[%ld]", brief, name->text,
                     brief, name->text, low, brief, name->text, high);
        } else if (is_scalar) {
            snprintf(sentence, GM_FAULT_SENTENCE, "%.*s is no list", brief, name->text);
        } else {
            return GM_UNKNOWN;
        }
        return GM_REFUSED;
    }
    if ((fixed && entry->role != PARAMETER) || (name->initial && entry->role != COMPONENT)) {
        snprintf(sentence, GM_FAULT_SENTENCE, "%.*s is no %s", brief, name->text,
                 fixed ? "parameter: its value is not known here"
                       : "component: it has no value at the start");
        return GM_REFUSED;
    }
    if (entry->state != READ && (entry->role == NAMED || (entry->role == PARAMETER && fixed))) {
        reading->wanted = (uint32_t)(entry - reading->entries);
        return GM_POSTPONED;
    }
    switch (entry->role) {
    case NAMED:
        *node = entry->node;
        break;
    case PARAMETER:
        if (fixed) {
            system->variables[system->parameters + entry->number].fixed |= name->fixed || reading->structural;
            *node = entry->node;
        } else {
            *node = gm_formula_variable(&system->graph, system->parameters + entry->number);
        }
        break;
    case COMPONENT:
        *node = gm_formula_variable(&system->graph, entry->number + (name->initial ? system->initial : 0));
        break;
    case TIME:
        *node = gm_formula_variable(&system->graph, system->n);
        break;
    case VELOCITY:
        *node = gm_formula_variable(&system->graph, system->velocities + entry->number);
        break;
    }
    return GM_KNOWN;
}

/* -- formulas
   ---------------------------------------------------------------------------------------------- */

/* One attempt; false without a fault where another name has to be read first. */
static bool attempt(struct reading *reading, struct gm_span span, const struct gm_span *bound, long element,
                    gm_node_id *node, bool *postponed)
{
    struct gm_scope scope = {
        .find = find, .known = known, .data = reading, .lines = true, .initial = reading->initial};
    if (bound && bound->begin < bound->end) {
        scope.indices[scope.index_count++] =
            (struct gm_index){reading->text + bound->begin, bound->end - bound->begin, element};
    }
    if (reading->counter.begin < reading->counter.end) {
        scope.indices[scope.index_count++] =
            (struct gm_index){reading->text + reading->counter.begin,
                              reading->counter.end - reading->counter.begin, reading->counted};
    }
    struct gm_fault fault;
    *postponed = false;
    if (gm_formula_read(&reading->system->graph, reading->text, span.begin, span.end, &scope, node, &fault)) {
        return true;
    }
    if (reading->system->graph.failed) {
        return no_memory(reading);
    }
    *postponed = fault.sentence[0] == '\0';
    return *postponed ? false : fail(reading, fault.offset, "%s", fault.sentence);
}

static bool is_circle(struct reading *reading, const uint32_t *stack, size_t depth)
{
    size_t first = 0, used = 0;
    while (first < depth && stack[first] != reading->wanted) {
        first++;
    }
    if (first == depth) {
        return false;
    }
    char names[200] = "";
    for (size_t i = first; i < depth && used + 70 < sizeof names; i++) {
        const struct entry *entry = &reading->entries[stack[i]];
        used +=
            (size_t)snprintf(names + used, sizeof names - used, "%s%.*s", i > first ? ", which needs " : "",
                             (int)(entry->length < 50 ? entry->length : 50), entry->name);
    }
    const struct entry *entry = &reading->entries[stack[first]];
    fail(reading, entry->place,
         depth - first == 1 ? "%s needs itself" : "a circle: %s, which needs the first again", names);
    return true;
}

/* Reads a parameter or a let, and first what it needs. */
static bool define(struct reading *reading, uint32_t number)
{
    uint32_t *stack = NULL;
    size_t depth = 0;
    if (!reserve(reading, (void **)&stack, depth, sizeof *stack)) {
        return false;
    }
    stack[depth++] = number;
    while (depth > 0 && !reading->failed) {
        struct entry *entry = &reading->entries[stack[depth - 1]];
        const bool was_fixed = reading->fixed;
        const struct gm_span counter = reading->counter;
        bool postponed = false;
        gm_node_id node = 0;
        reading->fixed = entry->role == PARAMETER;
        reading->counter = (struct gm_span){0, 0};
        const bool good = attempt(reading, entry->value, &entry->bound, entry->element, &node, &postponed);
        reading->fixed = was_fixed;
        reading->counter = counter;
        if (good) {
            entry->node = node;
            entry->state = READ;
            depth--;
        } else if (postponed && !is_circle(reading, stack, depth) &&
                   reserve(reading, (void **)&stack, depth, sizeof *stack)) {
            stack[depth++] = reading->wanted;
        }
    }
    free(stack);
    return !reading->failed;
}

static bool read_bound(struct reading *reading, struct gm_span span, const struct gm_span *bound,
                       long element, gm_node_id *node)
{
    bool postponed = true;
    while (!reading->failed && postponed) {
        if (attempt(reading, span, bound, element, node, &postponed)) {
            return true;
        }
        if (postponed) {
            define(reading, reading->wanted);
        }
    }
    return false;
}

static bool read_formula(struct reading *reading, struct gm_span span, gm_node_id *node)
{
    return read_bound(reading, span, NULL, 0, node);
}

/* A number that parameters alone make. */
static bool read_number(struct reading *reading, struct gm_span span, double *value)
{
    gm_node_id node;
    const bool was_fixed = reading->fixed;
    reading->fixed = true;
    const bool good = read_formula(reading, span, &node);
    reading->fixed = was_fixed;
    *value = good ? reading->system->graph.nodes[node].value : NAN;
    return good;
}

static bool read_whole(struct reading *reading, struct gm_span span, long *value)
{
    double number;
    reading->structural = true;
    const bool good = read_number(reading, span, &number);
    reading->structural = false;
    if (!good) {
        return false;
    }
    if (number != floor(number) || fabs(number) > 1e9) {
        return fail(reading, span.begin, "an index has to be a whole number, not %g", number);
    }
    *value = (long)number;
    return true;
}

/* NAME, NAME[low .. high], NAME[index] */
struct target {
    struct gm_span name, index; /* empty: there is none */
    struct gm_span value;       /* behind the = */
};

static bool read_target(struct reading *reading, struct gm_span *rest, struct target *target)
{
    *rest = gm_span_trimmed(reading->text, *rest);
    const size_t length = gm_name_length(reading->text + rest->begin, rest->end - rest->begin);
    *target = (struct target){.name = {rest->begin, rest->begin + length}};
    if (length == 0) {
        return fail(reading, rest->begin, "a name was expected");
    }
    rest->begin += length;
    *rest = gm_span_trimmed(reading->text, *rest);
    if (rest->begin < rest->end && reading->text[rest->begin] == '[') {
        const struct gm_span inside = {rest->begin + 1, rest->end};
        const size_t close = gm_span_until(reading->text, inside, "]");
        if (close == rest->end) {
            return fail(reading, rest->begin, "this bracket is not closed");
        }
        target->index = gm_span_trimmed(reading->text, (struct gm_span){inside.begin, close});
        rest->begin = close + 1;
        if (target->index.begin == target->index.end) {
            return fail(reading, close, "an index was expected");
        }
    }
    return true;
}

/* NAME = formula */
static bool read_assignment(struct reading *reading, struct gm_span span, struct target *target)
{
    if (!read_target(reading, &span, target)) {
        return false;
    }
    span = gm_span_trimmed(reading->text, span);
    if (span.begin == span.end || reading->text[span.begin] != '=') {
        return fail(reading, span.begin, "= was expected");
    }
    target->value = gm_span_trimmed(reading->text, (struct gm_span){span.begin + 1, span.end});
    return target->value.begin < target->value.end || fail(reading, span.begin + 1, "a formula was expected");
}

static struct entry entry_for(const struct reading *reading, const struct target *target, enum role role)
{
    return (struct entry){.name = (char *)reading->text + target->name.begin,
                          .length = target->name.end - target->name.begin,
                          .place = target->name.begin,
                          .role = role,
                          .value = target->value};
}

/* low .. high; false where it is none. */
static bool read_bounds(struct reading *reading, struct gm_span span, long *low, long *high)
{
    const size_t dots = gm_span_until(reading->text, span, "..");
    return dots < span.end && read_whole(reading, (struct gm_span){span.begin, dots}, low) &&
           read_whole(reading, gm_span_trimmed(reading->text, (struct gm_span){dots + 2, span.end}), high);
}

static bool is_same(const struct reading *reading, struct gm_span a, struct gm_span b)
{
    return a.end - a.begin == b.end - b.begin &&
           memcmp(reading->text + a.begin, reading->text + b.begin, a.end - a.begin) == 0;
}

/* Calls `each` for the elements that a target names: one, or, where the index is a free name, all of a
   list. */
static bool for_elements(struct reading *reading, const struct target *target,
                         bool (*each)(struct reading *reading, struct entry *entry,
                                      const struct target *target, gm_node_id node, void *data),
                         void *data)
{
    const char *name = reading->text + target->name.begin;
    const size_t length = target->name.end - target->name.begin;
    const int brief = (int)(length < 60 ? length : 60);
    const size_t letters =
        gm_name_length(reading->text + target->index.begin, target->index.end - target->index.begin);
    const bool all = letters > 0 && target->index.begin + letters == target->index.end &&
                     !is_same(reading, target->index, reading->counter) &&
                     !entry_of(reading, reading->text + target->index.begin, letters, false, 0);
    const bool indexed = target->index.begin < target->index.end;
    long low = 0, high = 0;
    gm_node_id node;
    if (all && !list_of(reading, name, length, &low, &high)) {
        return fail(reading, target->name.begin, "there is no list %.*s", brief, name);
    }
    if (!all && indexed && !read_whole(reading, target->index, &low)) {
        return false;
    }
    high = all ? high : low;
    for (long i = low; i <= high && !reading->failed; i++) {
        struct entry *entry = entry_of(reading, name, length, indexed, i);
        if (all && entry && entry->role == NAMED) {
            continue; /* a wall, q[0] = 0 */
        }
        if (!entry) {
            const struct gm_name used = {.text = name, .length = length, .indexed = indexed, .index = i};
            char sentence[GM_FAULT_SENTENCE] = "";
            if (find(reading, &used, &node, sentence) == GM_REFUSED) {
                return fail(reading, target->name.begin, "%s", sentence);
            }
            char word[64];
            snprintf(word, sizeof word, "%.*s", brief, name);
            const char *near = gm_nearest(word, reading->entry_count, known, reading);
            return fail(reading, target->name.begin, "there is no name %s%s%s", word,
                        near ? "; did you mean " : "", near ? near : "");
        }
        const size_t number = (size_t)(entry - reading->entries);
        if (read_bound(reading, target->value, all ? &target->index : NULL, i, &node)) {
            each(reading, &reading->entries[number], target, node, data);
        }
    }
    return !reading->failed;
}

/* -- variables
   --------------------------------------------------------------------------------------------- */

static struct gm_system_variable *add_variable(struct reading *reading, const struct entry *entry)
{
    struct gm_own_system *system = reading->system;
    if (!reserve(reading, (void **)&system->variables, system->variable_count, sizeof *system->variables)) {
        return NULL;
    }
    struct gm_system_variable *variable = &system->variables[system->variable_count];
    *variable = (struct gm_system_variable){.value = NAN,
                                            .low = NAN,
                                            .high = NAN,
                                            .start = GM_NO_NODE,
                                            .force = GM_NO_NODE,
                                            .exact = GM_NO_NODE,
                                            .jump = GM_NO_NODE};
    const int made =
        entry->indexed ? asprintf(&variable->name, "%.*s[%ld]", (int)entry->length, entry->name, entry->index)
                       : asprintf(&variable->name, "%.*s", (int)entry->length, entry->name);
    if (made < 0) {
        variable->name = NULL;
        no_memory(reading);
        return NULL;
    }
    system->variable_count++;
    return variable;
}

/* A name, or all elements of a list, in a role; they are numbered on from *count. */
static bool add_names(struct reading *reading, const struct target *target, enum role role, size_t *count)
{
    struct entry entry = entry_for(reading, target, role);
    long low = 0, high = 0;
    entry.indexed = target->index.begin < target->index.end;
    if (entry.indexed && !read_bounds(reading, target->index, &low, &high)) {
        return fail(reading, target->index.begin, "the bounds of a list were expected, as in %.*s[1..3]",
                    (int)(entry.length < 60 ? entry.length : 60), entry.name);
    }
    if (entry.indexed && (high < low || high - low >= GM_MOST_COMPONENTS)) {
        return fail(reading, target->index.begin,
                    high < low ? "a list has at least one element" : "a list has at most %d elements",
                    GM_MOST_COMPONENTS);
    }
    for (long i = low; i <= high && !reading->failed; i++) {
        entry.index = i;
        entry.number = (*count)++;
        if (add_entry(reading, entry)) {
            add_variable(reading, &entry);
        }
    }
    return !reading->failed;
}

static const struct line *line_with(const struct reading *reading, enum gm_system_word word)
{
    for (size_t i = 0; i < reading->line_count; i++) {
        if (reading->lines[i].word == word) {
            return &reading->lines[i];
        }
    }
    return NULL;
}

/* Names that are separated by blanks or commas. */
static bool add_all_names(struct reading *reading, struct gm_span rest, enum role role, size_t *count)
{
    for (rest = gm_span_trimmed(reading->text, rest); rest.begin < rest.end && !reading->failed;
         rest = gm_span_trimmed(reading->text, rest)) {
        struct target target;
        if (reading->text[rest.begin] == ',') {
            rest.begin++;
        } else if (read_target(reading, &rest, &target)) {
            add_names(reading, &target, role, count);
        }
    }
    return !reading->failed;
}

/* p_NAME or v_NAME for every coordinate, or NAME_t of a field */
static bool add_derived(struct reading *reading, const char *before, const char *behind, enum role role,
                        size_t *count, size_t n)
{
    for (size_t i = 0, made = 0; made < n && !reading->failed; i++) {
        struct entry entry = reading->entries[i];
        if (entry.role != COMPONENT) {
            continue;
        }
        char *name = NULL;
        if (asprintf(&name, "%s%s%s", before, entry.name, behind) < 0) {
            return no_memory(reading);
        }
        entry.name = name;
        entry.length = strlen(name);
        entry.role = role;
        entry.number = (*count)++;
        if (add_entry(reading, entry)) {
            add_variable(reading, &entry);
        }
        free(name);
        made++;
    }
    return !reading->failed;
}

/* parameter: NAME = value; low .. high; meaning; unit */
static bool add_parameter(struct reading *reading, const struct line *line, bool lists)
{
    struct gm_span rest = line->value, piece, range = {0, 0}, meaning = {0, 0}, unit = {0, 0};
    struct target target;
    gm_span_take(reading->text, &rest, ";", &piece);
    if (!read_assignment(reading, piece, &target)) {
        return false;
    }
    const bool is_list = target.index.begin < target.index.end;
    if (is_list != lists) {
        return true;
    }
    (void)(gm_span_take(reading->text, &rest, ";", &range) &&
           gm_span_take(reading->text, &rest, ";", &meaning) &&
           gm_span_take(reading->text, &rest, ";", &unit));
    const size_t first = reading->parameter_count, entries = reading->entry_count;
    if (!add_names(reading, &target, PARAMETER, &reading->parameter_count)) {
        return false;
    }
    struct gm_span values = target.value, value = values;
    size_t pieces = 0;
    for (size_t i = first; i < reading->parameter_count && !reading->failed; i++) {
        struct entry *entry = &reading->entries[entries + i - first];
        struct gm_system_variable *variable = &reading->system->variables[i];
        pieces += is_list && gm_span_take(reading->text, &values, ",", &value);
        entry->value = value;
        variable->meaning = text_of(reading, meaning);
        variable->unit = text_of(reading, unit);
    }
    if (is_list &&
        (values.begin < values.end || (pieces != 1 && pieces != reading->parameter_count - first))) {
        return fail(reading, target.value.begin, "%zu values were expected, or one for all",
                    reading->parameter_count - first);
    }
    const size_t dots = gm_span_until(reading->text, range, "..");
    if (range.begin < range.end && dots == range.end) {
        return fail(reading, range.begin, "a range was expected, low .. high");
    }
    if (range.begin < range.end) {
        double low, high;
        if (!read_number(reading, gm_span_trimmed(reading->text, (struct gm_span){range.begin, dots}),
                         &low) ||
            !read_number(reading, gm_span_trimmed(reading->text, (struct gm_span){dots + 2, range.end}),
                         &high)) {
            return false;
        }
        if (!(low <= high)) {
            return fail(reading, range.begin, "a range's lower end comes first, and %g is above %g", low,
                        high);
        }
        for (size_t i = first; i < reading->parameter_count; i++) {
            reading->system->variables[i].low = low;
            reading->system->variables[i].high = high;
        }
    }
    return !reading->failed;
}

/* Values that were given take the place of those in the file. */
static void give(struct reading *reading)
{
    for (size_t i = 0; i < reading->entry_count && !reading->failed; i++) {
        struct entry *entry = &reading->entries[i];
        const char *name = reading->system->variables[entry->number].name;
        double given = NAN;
        for (size_t k = 0; k < reading->value_count && entry->state == UNREAD; k++) {
            if (strcmp(reading->values[k].name, name) == 0 &&
                gm_number_parse(reading->values[k].text, &given)) {
                entry->node = gm_formula_constant(&reading->system->graph, given);
                entry->state = READ;
                entry->value.end = entry->value.begin;
                if (entry->node == GM_NO_NODE) {
                    no_memory(reading);
                }
            }
        }
    }
}

/* Lists after the numbers that say how long they are; then all formulas, which may hold both. */
static bool add_parameters(struct reading *reading)
{
    for (int lists = 0; lists < 2; lists++) {
        for (size_t i = 0; i < reading->line_count && !reading->failed; i++) {
            if (reading->lines[i].word == GM_WORD_PARAMETER) {
                add_parameter(reading, &reading->lines[i], lists);
            }
        }
        give(reading);
    }
    for (size_t i = 0; i < reading->entry_count && !reading->failed; i++) {
        const struct entry *entry = &reading->entries[i];
        struct gm_system_variable *variable = &reading->system->variables[entry->number];
        if (entry->state == READ || define(reading, (uint32_t)i)) {
            variable->value = reading->system->graph.nodes[reading->entries[i].node].value;
        }
        if (!reading->failed && !isfinite(variable->value)) {
            fail(reading, entry->place, "%s is no finite number", variable->name);
        } else if (!reading->failed &&
                   (variable->value < variable->low || variable->value > variable->high)) {
            fail(reading, entry->place, "%s = %g lies outside of its range, %g .. %g", variable->name,
                 variable->value, variable->low, variable->high);
        }
    }
    return !reading->failed;
}

static bool find_kind(struct reading *reading)
{
    const struct line *energy = line_with(reading, GM_WORD_HAMILTONIAN),
                      *lagrange = line_with(reading, GM_WORD_LAGRANGE),
                      *rate = line_with(reading, GM_WORD_RATE),
                      *bracket = line_with(reading, GM_WORD_BRACKET),
                      *field = line_with(reading, GM_WORD_FIELD),
                      *potential = line_with(reading, GM_WORD_POTENTIAL),
                      *matrix = line_with(reading, GM_WORD_K_MATRIX);
    enum gm_system_kind kind = matrix                        ? GM_MATRICES
                               : field && rate && !potential ? GM_EVOLUTION
                               : field                       ? GM_FIELD
                               : lagrange                    ? GM_LAGRANGIAN
                               : rate                        ? GM_RATES
                               : bracket                     ? GM_POISSON
                                                             : GM_CANONICAL;
    static const char *const called[] = {"with H",         "with L",       "with rates",
                                         "with a bracket", "with a field", "with a field and its rate",
                                         "with K-matrix"};
    if (!matrix && (line_with(reading, GM_WORD_L_MATRIX) || line_with(reading, GM_WORD_S_FUNCTION))) {
        return fail(reading, 0, "K z_t + L z_x = grad S(z) needs lines \"K-matrix\", \"L-matrix\" and \"S\"");
    }
    if (!matrix && !energy && !lagrange && !rate && !bracket && !field && !potential) {
        return fail(reading, 0,
                    "the file has no equation: H, L, rate, bracket and H, field and V or rate, "
                    "or K-matrix, L-matrix and S");
    }
    if (!field != !potential && kind != GM_EVOLUTION && kind != GM_MATRICES) {
        return field ? fail(reading, field->place,
                            "a field needs V, as in u_tt = u_xx - V'(u), or its rate, as in rate: u = -u_x")
                     : fail(reading, potential->place, "V is of a field, which a line \"field\" names");
    }
    if (kind == GM_POISSON && !energy) {
        return fail(reading, bracket->place, "a system with a bracket needs H");
    }
    for (size_t i = 0; i < reading->line_count; i++) {
        const struct line *line = &reading->lines[i];
        if (!(words[line->word].kinds & 1u << kind)) {
            return fail(reading, line->place, "a system %s has no line \"%s\"", called[kind],
                        words[line->word].word);
        }
    }
    static const enum gm_system_word needed[] = {GM_WORD_COMPONENTS, GM_WORD_L_MATRIX, GM_WORD_S_FUNCTION};
    for (size_t i = 0; i < sizeof needed / sizeof *needed && kind == GM_MATRICES; i++) {
        if (!line_with(reading, needed[i])) {
            return fail(reading, matrix->place, "a system with K-matrix needs a line \"%s\"",
                        words[needed[i]].word);
        }
    }
    if (kind <= GM_LAGRANGIAN && !line_with(reading, GM_WORD_COORDINATES)) {
        return fail(reading, (kind ? lagrange : energy)->place, "a system %s needs a line \"coordinates\"",
                    called[kind]);
    }
    reading->system->kind = kind;
    return true;
}

/* The components that stand on the left side of a rate or a bracket and are new. */
static bool add_components_of(struct reading *reading, struct gm_span piece)
{
    struct gm_span rest = {piece.begin, gm_span_until(reading->text, piece, "=")};
    for (rest = gm_span_trimmed(reading->text, rest); rest.begin < rest.end;
         rest = gm_span_trimmed(reading->text, rest)) {
        struct target target;
        if (!read_target(reading, &rest, &target)) {
            return false;
        }
        if (target.index.begin < target.index.end) {
            return fail(reading, target.name.begin, "a system with lists needs a line \"components\"");
        }
        if (!entry_of(reading, reading->text + target.name.begin, target.name.end - target.name.begin, false,
                      0)) {
            add_names(reading, &target, COMPONENT, &reading->component_count);
        }
    }
    return !reading->failed;
}

/* Components in the order in which rates and brackets name them. */
static bool add_components_in_order(struct reading *reading, enum gm_system_word word)
{
    for (size_t i = 0; i < reading->line_count && !reading->failed; i++) {
        struct gm_span rest = reading->lines[i].value, piece;
        while (reading->lines[i].word == word && !reading->failed &&
               gm_span_take(reading->text, &rest, ",", &piece)) {
            add_components_of(reading, piece);
        }
    }
    return !reading->failed;
}

/* variables: parameters, components, velocities as they were met become components, t, parameters,
   velocities, components at the start */
static bool arrange(struct reading *reading)
{
    struct gm_own_system *system = reading->system;
    const size_t n = reading->component_count, p = reading->parameter_count, v = reading->velocity_count;
    struct gm_system_variable *all = calloc(2 * n + 1 + p + v, sizeof *all), *met = system->variables;
    char *t = strdup("t");
    if (!all || !t) {
        free(all);
        free(t);
        return no_memory(reading);
    }
    all[n] = (struct gm_system_variable){.name = t,
                                         .value = NAN,
                                         .low = NAN,
                                         .high = NAN,
                                         .start = GM_NO_NODE,
                                         .force = GM_NO_NODE,
                                         .exact = GM_NO_NODE,
                                         .jump = GM_NO_NODE};
    /* a text that declares nothing has met nothing, and its sentence comes later */
    if (met) {
        memcpy(all, met + p, n * sizeof *all);
        memcpy(all + n + 1, met, p * sizeof *all);
        memcpy(all + n + 1 + p, met + p + n, v * sizeof *all);
        free(met);
    }
    system->variables = all;
    system->n = n;
    system->parameters = n + 1;
    system->velocities = n + 1 + p;
    system->initial = system->velocities + v;
    system->variable_count = system->initial;
    for (size_t i = 0; i < n; i++) {
        struct gm_system_variable *initial = &all[system->initial + i];
        *initial = all[n];
        if (asprintf(&initial->name, "%s(0)", all[i].name) < 0) {
            initial->name = NULL;
            return no_memory(reading);
        }
        system->variable_count++;
    }
    return true;
}

/* Fields, x, and their derivatives over it */
static bool add_fields(struct reading *reading, const struct line *field)
{
    char x[] = "x";
    static const char *const derivatives[GM_MOST_DERIVATIVES] = {"_x", "_xx", "_xxx", "_xxxx"};
    const struct entry place = {
        .name = x, .length = 1, .place = field->place, .role = VELOCITY, .number = reading->velocity_count++};
    if (!add_all_names(reading, field->value, COMPONENT, &reading->component_count)) {
        return false;
    }
    const size_t n = reading->component_count;
    if (n == 0 || n > GM_MOST_FIELDS) {
        return fail(reading, field->value.begin, "there are 1 to %d fields, as in field: u v",
                    GM_MOST_FIELDS);
    }
    if (!add_entry(reading, place) || !add_variable(reading, &place)) {
        return false;
    }
    for (size_t k = 0; k < GM_MOST_DERIVATIVES; k++) {
        if (!add_derived(reading, "", derivatives[k], VELOCITY, &reading->velocity_count, n)) {
            return false;
        }
    }
    return true;
}

/* The components of a system of matrices, and x */
static bool add_components(struct reading *reading, const struct line *components)
{
    char x[] = "x";
    const struct entry place = {.name = x,
                                .length = 1,
                                .place = components->place,
                                .role = VELOCITY,
                                .number = reading->velocity_count++};
    if (!add_all_names(reading, components->value, COMPONENT, &reading->component_count)) {
        return false;
    }
    const size_t n = reading->component_count;
    if (n < 2 || n > GM_MOST_OF_MATRICES) {
        return fail(reading, components->value.begin, "there are 2 to %d components, as in components: u v w",
                    GM_MOST_OF_MATRICES);
    }
    return add_entry(reading, place) && add_variable(reading, &place);
}

/* u and u_t, and what densities may hold beside them: x and u_x */
static bool add_field(struct reading *reading, const struct line *field)
{
    char x[] = "x";
    const struct entry place = {
        .name = x, .length = 1, .place = field->place, .role = VELOCITY, .number = reading->velocity_count++};
    if (!add_all_names(reading, field->value, COMPONENT, &reading->component_count)) {
        return false;
    }
    if (reading->component_count != 1) {
        return fail(reading, field->value.begin, "a field has one name, as in field: u");
    }
    return add_derived(reading, "", "_t", COMPONENT, &reading->component_count, 1) &&
           add_entry(reading, place) && add_variable(reading, &place) &&
           add_derived(reading, "", "_x", VELOCITY, &reading->velocity_count, 1);
}

static bool add_state(struct reading *reading)
{
    struct gm_own_system *system = reading->system;
    const struct line *coordinates = line_with(reading, GM_WORD_COORDINATES),
                      *momenta = line_with(reading, GM_WORD_MOMENTA),
                      *velocities = line_with(reading, GM_WORD_VELOCITIES),
                      *components = line_with(reading, GM_WORD_COMPONENTS);
    if (coordinates) {
        add_all_names(reading, coordinates->value, COMPONENT, &reading->component_count);
        const size_t n = reading->component_count;
        if (momenta && add_all_names(reading, momenta->value, COMPONENT, &reading->component_count) &&
            reading->component_count != 2 * n) {
            fail(reading, momenta->place, "%zu momenta for %zu coordinates", reading->component_count - n, n);
        }
        if (!momenta) {
            add_derived(reading, "p_", "", COMPONENT, &reading->component_count, n);
        }
        if (system->kind == GM_LAGRANGIAN && velocities) {
            add_all_names(reading, velocities->value, VELOCITY, &reading->velocity_count);
        } else if (system->kind == GM_LAGRANGIAN) {
            add_derived(reading, "v_", "", VELOCITY, &reading->velocity_count, n);
        }
        if (!reading->failed && system->kind == GM_LAGRANGIAN && reading->velocity_count != n) {
            fail(reading, velocities->place, "%zu velocities for %zu coordinates", reading->velocity_count,
                 n);
        }
    } else if (system->kind == GM_FIELD) {
        add_field(reading, line_with(reading, GM_WORD_FIELD));
    } else if (system->kind == GM_EVOLUTION) {
        add_fields(reading, line_with(reading, GM_WORD_FIELD));
    } else if (system->kind == GM_MATRICES) {
        add_components(reading, components);
    } else if (components) {
        add_all_names(reading, components->value, COMPONENT, &reading->component_count);
    } else {
        add_components_in_order(reading, system->kind == GM_RATES ? GM_WORD_RATE : GM_WORD_BRACKET);
    }
    if (!reading->failed && reading->component_count > GM_MOST_COMPONENTS) {
        fail(reading, 0, "a system has at most %d components", GM_MOST_COMPONENTS);
    }
    char t[] = "t";
    const struct entry time = {.name = t, .length = 1, .role = TIME};
    return !reading->failed && arrange(reading) && add_entry(reading, time);
}

/* How parameters follow from others, now that these have their numbers. */
static bool relate_parameters(struct reading *reading)
{
    struct gm_own_system *system = reading->system;
    for (size_t i = 0; i < reading->entry_count && !reading->failed; i++) {
        const struct entry *entry = &reading->entries[i];
        gm_node_id node;
        if (entry->role == PARAMETER && entry->value.begin < entry->value.end &&
            read_bound(reading, entry->value, &entry->bound, entry->element, &node)) {
            system->variables[system->parameters + entry->number].start = node;
        }
    }
    return !reading->failed;
}

static bool add_lets(struct reading *reading)
{
    for (size_t i = 0; i < reading->line_count && !reading->failed; i++) {
        struct target target;
        if (reading->lines[i].word != GM_WORD_LET ||
            !read_assignment(reading, reading->lines[i].value, &target)) {
            continue;
        }
        struct entry entry = entry_for(reading, &target, NAMED);
        entry.indexed = target.index.begin < target.index.end;
        if (!entry.indexed || read_whole(reading, target.index, &entry.index)) {
            add_entry(reading, entry);
        }
    }
    for (uint32_t i = 0; i < reading->entry_count && !reading->failed; i++) {
        if (reading->entries[i].role == NAMED && reading->entries[i].state != READ) {
            define(reading, i);
        }
    }
    return !reading->failed;
}

/* -- what lines say
   ---------------------------------------------------------------------------------------- */

static struct gm_system_item *add_item(struct reading *reading, const struct line *line, struct gm_span name)
{
    struct gm_own_system *system = reading->system;
    if (!reserve(reading, (void **)&system->items, system->item_count, sizeof *system->items)) {
        return NULL;
    }
    struct gm_system_item *item = &system->items[system->item_count];
    *item = (struct gm_system_item){
        .word = line->word, .place = line->value.begin, .name = text_of(reading, name)};
    system->item_count += item->name != NULL;
    return item->name ? item : NULL;
}

static bool add_node(struct reading *reading, struct gm_system_item *item, gm_node_id node)
{
    if (!reserve(reading, (void **)&item->nodes, item->count, sizeof *item->nodes)) {
        return false;
    }
    item->nodes[item->count++] = node;
    return true;
}

static bool add_formula(struct reading *reading, struct gm_system_item *item, struct gm_span span)
{
    gm_node_id node;
    return read_formula(reading, span, &node) && add_node(reading, item, node);
}

/* formulas that are separated by commas */
static bool add_formulas(struct reading *reading, struct gm_system_item *item, struct gm_span rest)
{
    struct gm_span piece;
    while (!reading->failed && gm_span_take(reading->text, &rest, ",", &piece)) {
        add_formula(reading, item, piece);
    }
    return !reading->failed;
}

/* where a component keeps what a line assigns to it */
static bool assign(struct reading *reading, struct entry *entry, const struct target *target, gm_node_id node,
                   void *data)
{
    struct gm_own_system *system = reading->system;
    const enum gm_system_word word = *(const enum gm_system_word *)data;
    const bool is_velocity =
        entry->role == VELOCITY && word == GM_WORD_START && system->kind == GM_LAGRANGIAN;
    if (entry->role != COMPONENT && !is_velocity) {
        return fail(reading, target->name.begin, "%.*s is no component",
                    (int)(entry->length < 60 ? entry->length : 60), entry->name);
    }
    struct gm_system_variable *variable =
        &system->variables[(is_velocity ? system->velocities : 0) + entry->number];
    gm_node_id *place = word == GM_WORD_START   ? &variable->start
                        : word == GM_WORD_FORCE ? &variable->force
                        : word == GM_WORD_EXACT ? &variable->exact
                        : word == GM_WORD_JUMP  ? &variable->jump
                                                : &system->rates[entry->number];
    if (word == GM_WORD_FORCE && entry->number >= system->n / 2) {
        return fail(reading, target->name.begin, "a force acts on a coordinate, not on %s", variable->name);
    }
    if (*place != GM_NO_NODE) {
        return fail(reading, target->name.begin, "%s: %s is said twice", words[word].word, variable->name);
    }
    *place = node;
    return true;
}

static bool read_assignments(struct reading *reading, const struct line *line)
{
    struct gm_span rest = line->value, piece;
    enum gm_system_word word = line->word;
    while (!reading->failed && gm_span_take(reading->text, &rest, ",", &piece)) {
        struct target target;
        reading->initial = word == GM_WORD_EXACT;
        if (read_assignment(reading, piece, &target)) {
            for_elements(reading, &target, assign, &word);
        }
        reading->initial = false;
    }
    return !reading->failed;
}

/* x y = z */
static bool read_bracket(struct reading *reading, struct gm_span piece)
{
    struct gm_own_system *system = reading->system;
    struct gm_span rest = piece;
    size_t pair[2];
    for (int i = 0; i < 2; i++) {
        struct target target;
        long index = 0;
        if (!read_target(reading, &rest, &target)) {
            return false;
        }
        const bool indexed = target.index.begin < target.index.end;
        if (indexed && !read_whole(reading, target.index, &index)) {
            return false;
        }
        const struct entry *entry = entry_of(reading, reading->text + target.name.begin,
                                             target.name.end - target.name.begin, indexed, index);
        if (!entry || entry->role != COMPONENT) {
            return fail(reading, target.name.begin, "a bracket is of two components: bracket: x y = z");
        }
        pair[i] = entry->number;
    }
    rest = gm_span_trimmed(reading->text, rest);
    if (rest.begin == rest.end || reading->text[rest.begin] != '=') {
        return fail(reading, rest.begin, "= was expected");
    }
    rest.begin++;
    gm_node_id node, *entry = &system->bracket[pair[0] * system->n + pair[1]],
                     *opposite = &system->bracket[pair[1] * system->n + pair[0]];
    if (pair[0] == pair[1]) {
        return fail(reading, piece.begin, "the bracket of %s with itself is 0",
                    system->variables[pair[0]].name);
    }
    if (!read_formula(reading, rest, &node)) {
        return false;
    }
    if (*entry != GM_NO_NODE) {
        return fail(reading, piece.begin, "the bracket of %s and %s is said twice",
                    system->variables[pair[0]].name, system->variables[pair[1]].name);
    }
    *entry = node;
    system->bracket_place = piece.begin;
    system->graph.simplifies = true;
    *opposite = gm_formula_apply(&system->graph, GM_OPERATION_NEGATE, node, node);
    system->graph.simplifies = false;
    return true;
}

static bool read_brackets(struct reading *reading, const struct line *line)
{
    struct gm_span rest = line->value, piece;
    while (!reading->failed && gm_span_take(reading->text, &rest, ",", &piece)) {
        read_bracket(reading, piece);
    }
    return !reading->failed;
}

static bool generate(struct reading *reading, struct entry *entry, const struct target *target,
                     gm_node_id node, void *data)
{
    const struct gm_own_system *system = reading->system;
    struct gm_system_item *item = data;
    if (entry->role != COMPONENT || entry->number >= item->count) {
        return fail(reading, target->name.begin, "a symmetry moves %s, not %.*s",
                    system->kind <= GM_LAGRANGIAN ? "coordinates" : "components",
                    (int)(entry->length < 60 ? entry->length : 60), entry->name);
    }
    item->nodes[entry->number] = node;
    return true;
}

/* symmetry: [name;] x = -y, y = x */
static bool read_symmetry(struct reading *reading, const struct line *line)
{
    struct gm_own_system *system = reading->system;
    struct gm_span rest = line->value, name = {0, 0}, piece;
    if (gm_span_until(reading->text, rest, ";") < rest.end) {
        gm_span_take(reading->text, &rest, ";", &name);
    }
    struct gm_system_item *item = add_item(reading, line, name);
    const size_t size = system->kind <= GM_LAGRANGIAN ? system->n / 2 : system->n;
    const gm_node_id zero = gm_formula_constant(&system->graph, 0);
    for (size_t i = 0; item && i < size && !reading->failed; i++) {
        add_node(reading, item, zero);
    }
    while (item && !reading->failed && gm_span_take(reading->text, &rest, ",", &piece)) {
        struct target target;
        if (read_assignment(reading, piece, &target)) {
            for_elements(reading, &target, generate, item);
        }
    }
    return !reading->failed;
}

/* An index of a name becomes its last digits: length[2] is length2. */
static bool number_item(struct reading *reading, struct gm_system_item *item, struct gm_span index)
{
    char *name;
    long number = 0;
    if (!read_whole(reading, index, &number)) {
        return false;
    }
    if (number < 0) {
        return fail(reading, index.begin, "the index of a name is 0 or more, not %ld", number);
    }
    if (asprintf(&name, "%s%ld", item->name, number) < 0) {
        return no_memory(reading);
    }
    free(item->name);
    item->name = name;
    return true;
}

/* NAME = formula; scale 1 */
static bool read_named(struct reading *reading, const struct line *line)
{
    struct gm_span rest = line->value, piece, scale;
    struct target target;
    gm_span_take(reading->text, &rest, ";", &piece);
    if (!read_assignment(reading, piece, &target)) {
        return false;
    }
    const bool indexed = target.index.begin < target.index.end;
    if (indexed && reading->counter.begin == reading->counter.end) {
        return fail(reading, target.index.begin, "this name has no index");
    }
    struct gm_system_item *item = add_item(reading, line, target.name);
    if (!item || (indexed && !number_item(reading, item, target.index))) {
        return false;
    }
    const size_t length = strlen(item->name);
    if (is_reserved(item->name, length)) {
        return fail(reading, target.name.begin, "the name %.60s is reserved", item->name);
    }
    const struct entry *other = entry_of(reading, item->name, length, false, 0);
    if (other) {
        return fail(reading, target.name.begin, "%s is defined twice, first in line %zu", other->name,
                    line_of(reading, other->place));
    }
    if (!add_formula(reading, item, target.value)) {
        return false;
    }
    for (size_t i = 0; i + 1 < reading->system->item_count; i++) {
        if (strcmp(reading->system->items[i].name, item->name) == 0) {
            return fail(reading, target.name.begin, "%.60s is said twice", item->name);
        }
    }
    if (gm_span_take(reading->text, &rest, ";", &scale)) {
        if (line->word == GM_WORD_OBSERVE || scale.end - scale.begin < 7 ||
            memcmp(reading->text + scale.begin, "scale ", 6) != 0) {
            return fail(reading, scale.begin,
                        line->word == GM_WORD_OBSERVE ? "nothing follows an observable"
                                                      : "scale was expected, as in \"; scale 1\"");
        }
        scale.begin += 6;
        return read_number(reading, scale, &item->scale);
    }
    return true;
}

/* section: y = 0, p_y > 0; x, p_x   or   section: every T; x, p_x */
static bool read_section(struct reading *reading, const struct line *line)
{
    struct gm_span rest = line->value, where, piece;
    struct gm_system_item *item = add_item(reading, line, (struct gm_span){0, 0});
    gm_span_take(reading->text, &rest, ";", &where);
    if (!item) {
        return false;
    }
    item->periodic = where.end - where.begin > 6 && memcmp(reading->text + where.begin, "every ", 6) == 0;
    where.begin += item->periodic ? 6 : 0;
    struct gm_span condition;
    gm_span_take(reading->text, &where, ",", &condition);
    if (!item->periodic) {
        const size_t equals = gm_span_until(reading->text, condition, "=");
        const struct gm_span right =
            gm_span_trimmed(reading->text, (struct gm_span){equals + 1, condition.end});
        if (equals == condition.end || right.end - right.begin != 1 || reading->text[right.begin] != '0') {
            return fail(reading, condition.begin, "a section is where something is 0, x = 0, or every T");
        }
        condition.end = equals;
    }
    double period = 1;
    if (!add_formula(reading, item, condition) ||
        (item->periodic && !read_number(reading, condition, &period))) {
        return false;
    }
    if (!(period > 0)) {
        return fail(reading, condition.begin, "the time between two looks is %g, and has to be above 0",
                    period);
    }
    if (rest.begin == rest.end || !add_formulas(reading, item, rest) || item->count != 3) {
        return fail(reading, rest.begin, "a section shows two values: ; x, p_x");
    }
    while (!reading->failed && gm_span_take(reading->text, &where, ",", &piece)) {
        const size_t more = gm_span_until(reading->text, piece, ">"),
                     less = gm_span_until(reading->text, piece, "<"), sign = more < less ? more : less;
        if (sign == piece.end) {
            return fail(reading, piece.begin, "a condition was expected, p_x > 0");
        }
        gm_node_id left, right;
        if (read_formula(reading, (struct gm_span){piece.begin, sign}, &left) &&
            read_formula(reading, (struct gm_span){sign + 1, piece.end}, &right)) {
            add_node(reading, item,
                     gm_formula_apply(&reading->system->graph, GM_OPERATION_SUBTRACT,
                                      sign == more ? left : right, sign == more ? right : left));
        }
    }
    return !reading->failed;
}

/* one body, or both ends of a rod, in two or three dimensions */
static bool read_view(struct reading *reading, const struct line *line)
{
    struct gm_system_item *item = add_item(reading, line, (struct gm_span){0, 0});
    struct gm_span rest = line->value, piece;
    size_t ends = 0, dimensions = 0;
    bool equal = true;
    while (item && !reading->failed && gm_span_take(reading->text, &rest, ";", &piece)) {
        const size_t before = item->count;
        add_formulas(reading, item, piece);
        equal = equal && (ends == 0 || item->count - before == dimensions);
        dimensions = item->count - before;
        ends++;
    }
    if (!reading->failed &&
        (!equal || dimensions < 2 || dimensions > 3 || ends != (line->word == GM_WORD_ROD ? 2 : 1))) {
        return fail(reading, line->value.begin,
                    line->word == GM_WORD_ROD ? "a rod has two ends: 0, 0; x, y"
                                              : "a body stands at two or three coordinates: x, y");
    }
    const struct gm_own_system *system = reading->system;
    for (size_t i = 0; i + 1 < system->item_count && !reading->failed; i++) {
        const struct gm_system_item *other = &system->items[i];
        const size_t of_other = other->word == GM_WORD_VIEW  ? other->count
                                : other->word == GM_WORD_ROD ? other->count / 2
                                                             : dimensions;
        if (of_other != dimensions) {
            return fail(reading, line->value.begin, "%zu coordinates, and those of the lines before are %zu",
                        dimensions, of_other);
        }
    }
    return !reading->failed;
}

/* surface: sphere; r   or   surface: ellipsoid; a, b, c */
static bool read_surface(struct reading *reading, const struct line *line)
{
    struct gm_span rest = line->value, shape;
    struct gm_system_item *item = add_item(reading, line, (struct gm_span){0, 0});
    gm_span_take(reading->text, &rest, ";", &shape);
    const char *word = reading->text + shape.begin;
    const size_t length = shape.end - shape.begin;
    const bool sphere = length == 6 && memcmp(word, "sphere", 6) == 0;
    if (!item || (!sphere && (length != 9 || memcmp(word, "ellipsoid", 9) != 0))) {
        return fail(reading, shape.begin, "a surface is a sphere or an ellipsoid: sphere; 1");
    }
    rest = gm_span_trimmed(reading->text, rest);
    if (rest.begin == rest.end || !add_formulas(reading, item, rest) || item->count != (sphere ? 1 : 3)) {
        return fail(reading, rest.begin,
                    sphere ? "a sphere has one radius: sphere; 1"
                           : "an ellipsoid has three half axes: ellipsoid; 1, 2, 3");
    }
    const gm_node_id radius = item->nodes[0];
    return !sphere || (add_node(reading, item, radius) && add_node(reading, item, radius));
}

/* What is seen in space has a camera, whose keys are no names of the system's own; and surfaces are. */
static bool check_space(struct reading *reading)
{
    static const char *const keys[] = {"azimuth", "elevation", "zoom", "turn"};
    static const char taken[] = "the name %s is reserved: it is how a system in space is looked at";
    const struct gm_own_system *system = reading->system;
    bool in_space = false;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        in_space |= (item->word == GM_WORD_VIEW && item->count == 3) ||
                    (item->word == GM_WORD_ROD && item->count == 6);
    }
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_SURFACE && !in_space) {
            return fail(reading, item->place, "a surface stands in space, among bodies: view: x, y, z");
        }
        for (size_t k = 0; k < sizeof keys / sizeof *keys && in_space; k++) {
            if (strcmp(item->name, keys[k]) == 0) {
                return fail(reading, item->place, taken, keys[k]);
            }
        }
    }
    for (size_t k = 0; k < sizeof keys / sizeof *keys && in_space; k++) {
        const struct entry *entry = entry_of(reading, keys[k], strlen(keys[k]), false, 0);
        if (entry) {
            return fail(reading, entry->place, taken, keys[k]);
        }
    }
    return true;
}

static bool read_angles(struct reading *reading, const struct line *line)
{
    struct gm_own_system *system = reading->system;
    for (struct gm_span rest = gm_span_trimmed(reading->text, line->value);
         rest.begin < rest.end && !reading->failed; rest = gm_span_trimmed(reading->text, rest)) {
        struct target target;
        long index = 0;
        if (reading->text[rest.begin] == ',') {
            rest.begin++;
            continue;
        }
        if (!read_target(reading, &rest, &target)) {
            return false;
        }
        const bool indexed = target.index.begin < target.index.end;
        if (indexed && !read_whole(reading, target.index, &index)) {
            return false;
        }
        const struct entry *entry = entry_of(reading, reading->text + target.name.begin,
                                             target.name.end - target.name.begin, indexed, index);
        if (!entry || entry->role != COMPONENT || entry->number >= system->n / 2) {
            return fail(reading, target.name.begin, "an angle is one of the coordinates");
        }
        system->variables[entry->number].angle = true;
    }
    return !reading->failed;
}

/* A number of a ring: half its length, the points of its grid, by how much the field differs at its ends. */
static bool read_ring(struct reading *reading, const struct line *line)
{
    static const struct {
        double low, high;
        const char *told;
    } ranges[] = {{0.1, 1e5, "a number from 0.1 to 1e5"},
                  {3, 1e7, "a whole number from 3 to 1e7"},
                  {-1e6, 1e6, "a number"}};
    const size_t row = (size_t)line->word - GM_WORD_HALF_LENGTH;
    double number;
    struct gm_system_item *item;
    if (!read_number(reading, line->value, &number)) {
        return false;
    }
    if (!(number >= ranges[row].low && number <= ranges[row].high) ||
        (line->word == GM_WORD_POINTS && number != floor(number))) {
        return fail(reading, line->value.begin, "%s is %g, and has to be %s", words[line->word].word, number,
                    ranges[row].told);
    }
    item = add_item(reading, line, (struct gm_span){0, 0});
    return item && add_formula(reading, item, line->value);
}

/* Rows with | between them, and commas between their entries. */
static bool read_matrix(struct reading *reading, const struct line *line)
{
    struct gm_own_system *system = reading->system;
    const char *word = words[line->word].word;
    const size_t n = system->n, first = line->word == GM_WORD_K_MATRIX ? 0 : n * n;
    struct gm_span rest = line->value, row, entry;
    size_t rows = 0;
    for (; gm_span_take(reading->text, &rest, "|", &row); rows++) {
        size_t columns = 0;
        const size_t begin = row.begin;
        for (; gm_span_take(reading->text, &row, ",", &entry); columns++) {
            const size_t at = first + rows * n + columns;
            if (rows < n && columns < n) {
                system->matrix_places[at] = entry.begin;
                if (!read_formula(reading, entry, &system->matrices[at])) {
                    return false;
                }
            }
        }
        if (columns != n) {
            return fail(reading, begin, "row %zu of %s has %zu entries for %zu components", rows + 1, word,
                        columns, n);
        }
    }
    return rows == n || fail(reading, line->value.begin, "%s has %zu rows for %zu components", word, rows, n);
}

/* One of two words. */
static bool read_choice(struct reading *reading, const struct line *line, const char *one, const char *other)
{
    char *text = reading->system->texts[line->word] = text_of(reading, line->value);
    return text && (strcmp(text, one) == 0 || strcmp(text, other) == 0 ||
                    fail(reading, line->value.begin, "%s is %s or %s, not %.60s", words[line->word].word, one,
                         other, text));
}

static bool read_what_is_said(struct reading *reading, const struct line *line)
{
    struct gm_own_system *system = reading->system;
    double number;
    struct gm_system_item *item;
    switch (line->word) {
    case GM_WORD_GEOMINT:
        return read_number(reading, line->value, &number) &&
               (number == 1 ||
                fail(reading, line->value.begin, "this program reads files of format 1, not %g", number));
    case GM_WORD_DT:
    case GM_WORD_UNTIL:
    case GM_WORD_STEPS:
        if (!read_number(reading, line->value, &number)) {
            return false;
        }
        if (!(isfinite(number) && (line->word == GM_WORD_DT ? number > 0 : number >= 0))) {
            return fail(reading, line->value.begin, "%s is %g, and has to be %s", words[line->word].word,
                        number, line->word == GM_WORD_DT ? "above 0" : "0 or more");
        }
        system->texts[line->word] = text_of(reading, line->value);
        item = add_item(reading, line, (struct gm_span){0, 0});
        return item && add_formula(reading, item, line->value);
    case GM_WORD_TITLE:
    case GM_WORD_ABOUT:
    case GM_WORD_WATCH:
    case GM_WORD_REFERENCE:
    case GM_WORD_SCHEMES:
    case GM_WORD_MEMBERS:
        system->texts[line->word] = text_of(reading, line->value);
        return true;
    case GM_WORD_SPACE:
        return read_choice(reading, line, "differences", "fourier");
    case GM_WORD_BOUNDARY:
        return read_choice(reading, line, "ring", "walls");
    case GM_WORD_HALF_LENGTH:
    case GM_WORD_POINTS:
        return read_ring(reading, line);
    case GM_WORD_JUMP:
        return system->kind == GM_MATRICES ? read_assignments(reading, line) : read_ring(reading, line);
    case GM_WORD_K_MATRIX:
    case GM_WORD_L_MATRIX:
        return read_matrix(reading, line);
    case GM_WORD_HAMILTONIAN:
    case GM_WORD_LAGRANGE:
    case GM_WORD_POTENTIAL:
    case GM_WORD_S_FUNCTION:
        return read_formula(reading, line->value, &system->energy);
    case GM_WORD_RATE:
    case GM_WORD_START:
    case GM_WORD_FORCE:
    case GM_WORD_EXACT:
        return read_assignments(reading, line);
    case GM_WORD_BRACKET:
        return read_brackets(reading, line);
    case GM_WORD_ANGLE:
        return read_angles(reading, line);
    case GM_WORD_INVARIANT:
    case GM_WORD_CASIMIR:
    case GM_WORD_OBSERVE:
        return read_named(reading, line);
    case GM_WORD_SYMMETRY:
        return read_symmetry(reading, line);
    case GM_WORD_SECTION:
        return read_section(reading, line);
    case GM_WORD_VIEW:
    case GM_WORD_ROD:
        return read_view(reading, line);
    case GM_WORD_SURFACE:
        return read_surface(reading, line);
    case GM_WORD_CONSTRAINT:
    case GM_WORD_STOP:
    case GM_WORD_MONITOR:
    case GM_WORD_MASS:
        item = add_item(reading, line, (struct gm_span){0, 0});
        return item && add_formula(reading, item, line->value);
    default: /* names, which were read before */
        return true;
    }
}

/* i = low .. high; what is said for each i, in turn. A line without a counter is said once. */
static bool read_counted(struct reading *reading, const struct line *line)
{
    struct gm_span rest = line->value, head;
    const size_t name = gm_name_length(reading->text + rest.begin, rest.end - rest.begin);
    long low = 0, high = 0;
    gm_span_take(reading->text, &rest, ";", &head);
    const size_t equals = gm_span_until(reading->text, head, "=");
    const struct gm_span counter = gm_span_trimmed(reading->text, (struct gm_span){head.begin, equals}),
                         bounds = gm_span_trimmed(reading->text, (struct gm_span){equals + 1, head.end});
    if (!words[line->word].repeated || head.end == line->value.end || equals == head.end || name == 0 ||
        counter.end != counter.begin + name || gm_span_until(reading->text, bounds, "..") == bounds.end) {
        return read_what_is_said(reading, line);
    }
    if (entry_of(reading, reading->text + counter.begin, name, false, 0)) {
        return fail(reading, counter.begin, "%.*s is a name of the system: an index is another one",
                    (int)(name < 60 ? name : 60), reading->text + counter.begin);
    }
    if (!read_bounds(reading, bounds, &low, &high)) {
        return fail(reading, bounds.begin, "the bounds of an index were expected, as in i = 1 .. 3");
    }
    if (high - low >= GM_MOST_COMPONENTS) {
        return fail(reading, bounds.begin, "an index has at most %d values", GM_MOST_COMPONENTS);
    }
    const struct line one = {line->word, line->place, gm_span_trimmed(reading->text, rest)};
    reading->counter = counter;
    for (reading->counted = low; reading->counted <= high && !reading->failed; reading->counted++) {
        read_what_is_said(reading, &one);
    }
    reading->counter = (struct gm_span){0, 0};
    return !reading->failed;
}

static bool all_nodes(struct reading *reading, gm_node_id **nodes, size_t count)
{
    *nodes = malloc((count + 1) * sizeof **nodes);
    for (size_t i = 0; *nodes && i < count; i++) {
        (*nodes)[i] = GM_NO_NODE;
    }
    return *nodes || no_memory(reading);
}

static bool is_complete(struct reading *reading)
{
    struct gm_own_system *system = reading->system;
    const gm_node_id zero = gm_formula_constant(&system->graph, 0);
    const bool rates = system->kind == GM_RATES || system->kind == GM_EVOLUTION;
    for (size_t i = 0; i < system->n && rates; i++) {
        if (system->rates[i] == GM_NO_NODE) {
            return fail(reading, 0, "there is no rate of %s", system->variables[i].name);
        }
    }
    for (size_t i = 0; i < system->n * system->n && system->kind == GM_POISSON; i++) {
        system->bracket[i] = system->bracket[i] == GM_NO_NODE ? zero : system->bracket[i];
    }
    for (size_t i = 0; i < system->n; i++) {
        const bool by_velocity =
            system->kind == GM_LAGRANGIAN && i >= system->n / 2 &&
            system->variables[system->velocities + i - system->n / 2].start != GM_NO_NODE;
        if (system->variables[i].start == GM_NO_NODE && !by_velocity) {
            const struct line *start = line_with(reading, GM_WORD_START);
            return fail(reading, start ? start->value.begin : reading->length, "%s has no value at the start",
                        system->variables[i].name);
        }
        if (system->variables[i].start != GM_NO_NODE && by_velocity) {
            return fail(reading, reading->length, "%s and its velocity are both given at the start",
                        system->variables[i].name);
        }
    }
    return true;
}

/* Lets give their names to nodes that have none. */
static bool name_parts(struct reading *reading)
{
    struct gm_own_system *system = reading->system;
    system->part_count = system->graph.count;
    system->parts = calloc(system->part_count + 1, sizeof *system->parts);
    for (size_t i = 0; system->parts && i < reading->entry_count && !reading->failed; i++) {
        const struct entry *entry = &reading->entries[i];
        const struct line line = {.word = GM_WORD_LET, .place = entry->place, .value = entry->value};
        if (entry->role != NAMED) {
            continue;
        }
        struct gm_system_item *item =
            add_item(reading, &line, (struct gm_span){entry->place, entry->place + entry->length});
        char *element = NULL;
        if (item && entry->indexed && asprintf(&element, "%s[%ld]", item->name, entry->index) >= 0) {
            free(item->name);
            item->name = element;
        }
        if (item && add_node(reading, item, entry->node) &&
            system->graph.nodes[entry->node].operation > GM_VARIABLE) {
            system->parts[entry->node] = item->name;
        }
    }
    return (system->parts && !reading->failed) || no_memory(reading);
}

static bool read_system(struct reading *reading)
{
    struct gm_own_system *system = reading->system;
    if (reading->length > GM_LARGEST_SYSTEM) {
        return fail(reading, 0, "a system has at most 100 MB");
    }
    struct gm_fault fault;
    if (!gm_lines_are_text(reading->text, reading->length, &fault)) {
        return fail(reading, fault.offset, "%s", fault.sentence);
    }
    if (!read_lines(reading) || !find_kind(reading) || !add_parameters(reading) || !add_state(reading) ||
        !relate_parameters(reading) || !all_nodes(reading, &system->rates, system->n)) {
        return false;
    }
    if (system->kind == GM_POISSON &&
        (system->n > 2000 ? !fail(reading, 0, "a system with a bracket has at most 2000 components")
                          : !all_nodes(reading, &system->bracket, system->n * system->n))) {
        return false;
    }
    if (system->kind == GM_MATRICES) {
        system->matrix_places = calloc(2 * system->n * system->n, sizeof *system->matrix_places);
        if (!system->matrix_places || !all_nodes(reading, &system->matrices, 2 * system->n * system->n)) {
            return no_memory(reading);
        }
    }
    if (!add_lets(reading)) {
        return false;
    }
    for (size_t i = 0; i < reading->line_count; i++) {
        if (!read_counted(reading, &reading->lines[i])) {
            return reading->failed ? false : no_memory(reading);
        }
    }
    return check_space(reading) && is_complete(reading) && name_parts(reading);
}

bool gm_system_read(struct gm_own_system *system, const char *text, size_t length,
                    const struct gm_system_value *values, size_t count, struct gm_fault *fault)
{
    struct reading reading = {.system = system,
                              .text = text,
                              .length = length,
                              .values = values,
                              .value_count = count,
                              .fault = fault};
    *system = (struct gm_own_system){0};
    *fault = (struct gm_fault){0};
    gm_formula_open(&system->graph);
    system->source = length <= GM_LARGEST_SYSTEM ? malloc(length + 1) : NULL;
    if (system->source) {
        memcpy(system->source, text, length);
        system->source[length] = '\0';
        system->length = length;
    }
    const bool good = (system->source || length > GM_LARGEST_SYSTEM) && read_system(&reading);
    for (size_t i = 0; i < reading.entry_count; i++) {
        free(reading.entries[i].name);
    }
    free(reading.lines);
    free(reading.entries);
    free(reading.table);
    return good;
}

void gm_system_close(struct gm_own_system *system)
{
    for (size_t i = 0; i < system->variable_count; i++) {
        free(system->variables[i].name);
        free(system->variables[i].meaning);
        free(system->variables[i].unit);
    }
    for (size_t i = 0; i < system->item_count; i++) {
        free(system->items[i].name);
        free(system->items[i].nodes);
    }
    for (size_t i = 0; i < GM_WORDS; i++) {
        free(system->texts[i]);
    }
    free(system->source);
    free(system->variables);
    free(system->items);
    free(system->rates);
    free(system->momenta);
    free(system->mass.entries);
    free(system->bracket);
    free(system->matrices);
    free(system->matrix_places);
    free(system->facets);
    free(system->parts);
    gm_formula_close(&system->graph);
    *system = (struct gm_own_system){0};
}

static const char *variable_name(size_t number, const void *data)
{
    return ((const struct gm_own_system *)data)->variables[number].name;
}

static const char *part_name(gm_node_id node, const void *data)
{
    const struct gm_own_system *system = data;
    return node < system->part_count ? system->parts[node] : NULL;
}

bool gm_system_place(struct gm_own_system *system, gm_node_id *nodes, size_t count)
{
    const size_t variables = system->velocities + 1;
    gm_node_id *others = malloc(variables * sizeof *others);
    for (size_t i = 0; others && i < variables; i++) {
        others[i] = GM_NO_NODE;
    }
    if (others) {
        others[system->velocities] = gm_formula_variable(&system->graph, 0);
        others[system->n] = gm_formula_variable(&system->graph, 1);
    }
    const bool good = others && gm_formula_substitute(&system->graph, nodes, count, others, variables);
    free(others);
    return good;
}

const struct gm_system_item *gm_system_item_of(const struct gm_own_system *system, enum gm_system_word word,
                                               size_t number)
{
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == word && number-- == 0) {
            return &system->items[i];
        }
    }
    return NULL;
}

struct gm_naming gm_system_naming(const struct gm_own_system *system)
{
    return (struct gm_naming){.variable = variable_name, .part = part_name, .data = system};
}
