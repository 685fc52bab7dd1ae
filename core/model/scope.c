/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of a system, their names, and formulas with such names. */
#include "core/model/scope.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/nearest.h"
#include "core/expression/number.h"

enum {
    ONCE = GM_LINE_ONCE,
    NAMED = GM_LINE_NAMED,
    OFTEN = GM_LINE_ADDED,
    CANONICAL = 1 << GM_CANONICAL,
    LAGRANGIAN = 1 << GM_LAGRANGIAN,
    RATES = 1 << GM_RATES,
    POISSON = 1 << GM_POISSON,
    FIELD = 1 << GM_FIELD,
    EVOLUTION = 1 << GM_EVOLUTION,
    MATRICES = 1 << GM_MATRICES,
    FORMS = 1 << GM_FORMS,
    LINE = FIELD | EVOLUTION | MATRICES,
    MOTION = CANONICAL | LAGRANGIAN | RATES | POISSON,
    ANY = MOTION | LINE | FORMS
};

const struct gm_line_word gm_system_words[GM_WORDS] = {
#define GM_WORD(constant, word, identity, kinds, reader) {word, (enum gm_line_identity)identity, kinds},
#include "core/model/words.def"
#undef GM_WORD
};

static const struct gm_line_words words = {"a system", gm_system_words, GM_WORDS,
                                           "; docs/systems.md names them"};

void gm_reading_close(struct gm_reading *reading)
{
    for (size_t i = 0; i < reading->entry_count; i++) {
        free(reading->entries[i].name);
    }
    free(reading->entries);
    free(reading->table);
}

bool gm_reading_reserve(struct gm_reading *reading, void **array, size_t count, size_t size)
{
    if ((count & (count - 1)) == 0) {
        void *more = gm_arena_resize(reading->system->arena, *array, count ? 2 * count : 1, size);
        if (!more) {
            return gm_fail_memory(&reading->fault);
        }
        *array = more;
    }
    return true;
}

bool gm_reading_fail_twice(struct gm_reading *reading, size_t place, const struct gm_entry *first)
{
    if (!reading->fault.failed) {
        gm_fail_first(&reading->fault, place, "%.60s is defined twice", first->name);
        reading->fault.fault->earlier = first->place;
    }
    return false;
}

bool gm_reading_lines(struct gm_reading *reading)
{
    struct gm_written_choices *choices = &reading->system->choices;
    struct gm_read_lines lines = {.words = &words,
                                  .choices = choices,
                                  .inside = ~0u,
                                  .text = reading->text,
                                  .span = {0, reading->length}};
    struct gm_fault fault = {0};
    bool good = gm_choices_read(choices, reading->text, reading->length, &fault);
    for (size_t i = 0; good && i < reading->value_count; i++) {
        gm_choices_take(choices, reading->values[i].name, reading->values[i].text);
    }
    good = good && gm_lines_read(&lines, &fault);
    reading->lines =
        good ? gm_arena_take(reading->system->arena, lines.count + 1, sizeof *reading->lines) : NULL;
    for (size_t i = 0; reading->lines && i < lines.count; i++) {
        const struct gm_read_line *line = &lines.list[i];
        reading->lines[reading->line_count++] =
            (struct gm_system_line){(enum gm_system_word)line->word, line->place, line->value};
    }
    free(lines.list);
    return reading->lines ||
           (fault.sentence[0] ? gm_fail_first(&reading->fault, fault.offset, "%s", fault.sentence)
                              : gm_fail_memory(&reading->fault));
}

char *gm_reading_text(struct gm_reading *reading, struct gm_span span)
{
    char *text = gm_arena_keep(reading->system->arena, gm_span_words(reading->text, span), free);
    if (!text) {
        gm_fail_memory(&reading->fault);
    }
    return text;
}

static uint32_t *slot_of(const struct gm_reading *reading, const char *name, size_t length, bool indexed,
                         long index)
{
    uint64_t hash = indexed ? (uint64_t)index * 2 + 1 : 0;
    for (size_t i = 0; i < length; i++) {
        hash = (hash ^ (unsigned char)name[i]) * UINT64_C(0x100000001b3);
    }
    hash ^= hash >> 29;
    for (size_t slot = (size_t)hash & (reading->slots - 1);; slot = (slot + 1) & (reading->slots - 1)) {
        const uint32_t number = reading->table[slot];
        const struct gm_entry *entry = number ? &reading->entries[number - 1] : NULL;
        if (!entry || (entry->length == length && entry->indexed == indexed && entry->index == index &&
                       memcmp(entry->name, name, length) == 0)) {
            return &reading->table[slot];
        }
    }
}

struct gm_entry *gm_reading_entry(const struct gm_reading *reading, const char *name, size_t length,
                                  bool indexed, long index)
{
    const uint32_t number =
        reading->slots ? *slot_of(reading, name, length, indexed, indexed ? index : 0) : 0;
    return number ? &reading->entries[number - 1] : NULL;
}

/* Finds an element of a list of that name, and the bounds of the list. */
static const struct gm_entry *list_of(const struct gm_reading *reading, const char *name, size_t length,
                                      long *low, long *high)
{
    const struct gm_entry *found = NULL;
    for (size_t i = 0; i < reading->entry_count; i++) {
        const struct gm_entry *entry = &reading->entries[i];
        if (entry->indexed && entry->length == length && memcmp(entry->name, name, length) == 0) {
            *low = found && *low < entry->index ? *low : entry->index;
            *high = found && *high > entry->index ? *high : entry->index;
            found = entry;
        }
    }
    return found;
}

bool gm_reading_reserves(const char *name, size_t length)
{
    /* keys of a command line, and columns of tables */
    static const char *const reserved[] = {
        "dt",        "until",        "steps",  "scheme",   "schemes",     "zip",         "overlay", "equal",
        "show",      "members",      "t",      "lane",     "meta",        "compensated", "binding", "tau0",
        "tolerance", "spread",       "scene",  "status",   "evaluations", "solves",      "seconds", "stopped",
        "shape",     "newmark_beta", "trails", "portrait", "window"};
    for (size_t i = 0; i < sizeof reserved / sizeof *reserved; i++) {
        if (strlen(reserved[i]) == length && memcmp(reserved[i], name, length) == 0) {
            return true;
        }
    }
    return gm_formula_reserves(name, length);
}

/* True for keys of a ring, unless the reader has added them with their values. */
static bool is_of_ring(const struct gm_reading *reading, const struct gm_entry *entry)
{
    static const char *const keys[] = {"half_length", "points", "space", "boundary"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys && gm_system_is_field(reading->system) && !entry->read;
         i++) {
        if (entry->length == strlen(keys[i]) && memcmp(entry->name, keys[i], entry->length) == 0) {
            return true;
        }
    }
    return false;
}

/* True for the place of a field, unless the reader has added it. */
static bool is_place(const struct gm_reading *reading, const struct gm_entry *entry)
{
    return gm_system_is_field(reading->system) && entry->role != GM_ENTRY_VELOCITY && entry->length == 1 &&
           entry->name[0] == 'x';
}

static enum gm_form_operator operator_of(const char *name, size_t length);

bool gm_reading_add(struct gm_reading *reading, struct gm_entry entry)
{
    const int brief = (int)(entry.length < 60 ? entry.length : 60);
    if (is_place(reading, &entry)) {
        return gm_fail_first(&reading->fault, entry.place, "x is the place in a field: take another name");
    }
    const size_t word = gm_line_word(&words, entry.name, (struct gm_span){0, entry.length});
    /* a choice between starts may be called so */
    const bool is_word = entry.role == GM_ENTRY_CHOICE && word < GM_WORDS && word != GM_WORD_START;
    if (is_word || is_of_ring(reading, &entry) ||
        (gm_system_is_form(reading->system) && operator_of(entry.name, entry.length) < GM_FORM_OPERATORS) ||
        (entry.role != GM_ENTRY_TIME && gm_reading_reserves(entry.name, entry.length))) {
        return gm_fail_first(&reading->fault, entry.place, "the name %.*s" GM_RESERVED, brief, entry.name);
    }
    if (reading->entry_count == reading->entry_capacity) {
        const size_t capacity = reading->entry_capacity ? 2 * reading->entry_capacity : 32;
        struct gm_entry *more = realloc(reading->entries, capacity * sizeof *more);
        reading->entries = more ? more : reading->entries;
        uint32_t *table = calloc(4 * capacity, sizeof *table);
        if (!more || !table) {
            free(table);
            return gm_fail_memory(&reading->fault);
        }
        free(reading->table);
        reading->table = table;
        reading->entry_capacity = capacity;
        reading->slots = 4 * capacity;
        for (size_t i = 0; i < reading->entry_count; i++) {
            *slot_of(reading, more[i].name, more[i].length, more[i].indexed, more[i].index) = (uint32_t)i + 1;
        }
    }
    const struct gm_entry *other = gm_reading_entry(reading, entry.name, entry.length, !entry.indexed, 0);
    uint32_t *slot = slot_of(reading, entry.name, entry.length, entry.indexed, entry.index);
    long low = 0, high = 0;
    if (*slot) {
        other = &reading->entries[*slot - 1];
    } else if (!entry.indexed) {
        other = list_of(reading, entry.name, entry.length, &low, &high);
    }
    if (other) {
        return gm_reading_fail_twice(reading, entry.place, other);
    }
    char *name = strndup(entry.name, entry.length);
    if (!name) {
        return gm_fail_memory(&reading->fault);
    }
    entry.name = name;
    reading->entries[reading->entry_count] = entry;
    *slot = (uint32_t)++reading->entry_count;
    return true;
}

static const char *known(size_t i, const void *data)
{
    const struct gm_reading *reading = data;
    return i < reading->entry_count ? reading->entries[i].name : NULL;
}

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    struct gm_reading *reading = data;
    struct gm_user_system *system = reading->system;
    const int brief = (int)(name->length < 60 ? name->length : 60);
    const bool fixed = name->fixed || reading->fixed;
    struct gm_entry *entry = gm_reading_entry(reading, name->text, name->length, name->indexed, name->index);
    if (!entry) {
        long low = 0, high = 0;
        const bool is_scalar = gm_reading_entry(reading, name->text, name->length, false, 0) != NULL;
        const bool is_list = list_of(reading, name->text, name->length, &low, &high) != NULL;
        if (name->indexed && is_list) {
            snprintf(sentence, GM_FAULT_SENTENCE, "%.*s[%ld] lies outside of %.*s[%ld] .. %.*s[%ld]", brief,
                     name->text, name->index, brief, name->text, low, brief, name->text, high);
        } else if (is_list) {
            snprintf(sentence, GM_FAULT_SENTENCE,
                     "%.*s is a list: an index was expected, %.*s[%ld] .. %.*s[%ld]", brief, name->text,
                     brief, name->text, low, brief, name->text, high);
        } else if (is_scalar) {
            snprintf(sentence, GM_FAULT_SENTENCE, "%.*s is not a list", brief, name->text);
        } else {
            return GM_UNKNOWN;
        }
        return GM_REFUSED;
    }
    if (entry->role == GM_ENTRY_CHOICE) {
        snprintf(sentence, GM_FAULT_SENTENCE, "%s is a choice of words: write lines below \"when: %s = ...\"",
                 entry->name, entry->name);
        return GM_REFUSED;
    }
    if (entry->role == GM_ENTRY_FUNCTION) {
        const size_t count = gm_reading_definition(reading, name->text, name->length)->count;
        snprintf(sentence, GM_FAULT_SENTENCE, "%.*s is a function of %zu argument%s", brief, name->text,
                 count, gm_plural((double)count));
        return GM_REFUSED;
    }
    if (name->initial && entry->role == GM_ENTRY_COMPONENT && gm_system_is_field(system)) {
        snprintf(sentence, GM_FAULT_SENTENCE, "%.*s is a field: its start is not a number", brief,
                 name->text);
        return GM_REFUSED;
    }
    if ((fixed && entry->role != GM_ENTRY_PARAMETER) ||
        ((name->initial || name->exact) && entry->role != GM_ENTRY_COMPONENT)) {
        const char *lacks =
            name->exact ? "component: it has no exact solution" : "component: it has no value at the start";
        snprintf(sentence, GM_FAULT_SENTENCE, "%.*s is not a %s", brief, name->text,
                 fixed ? "parameter: its value is not known here" : lacks);
        return GM_REFUSED;
    }
    if (!entry->read && (entry->role >= GM_ENTRY_NAMED || (entry->role == GM_ENTRY_PARAMETER && fixed))) {
        reading->wanted = (uint32_t)(entry - reading->entries);
        return GM_POSTPONED;
    }
    switch (entry->role) {
    case GM_ENTRY_NAMED:
    case GM_ENTRY_OBSERVED:
        *node = entry->node;
        break;
    case GM_ENTRY_PARAMETER:
        if (fixed) {
            system->variables[system->parameters + entry->number].fixed |= name->fixed || reading->structural;
            *node = entry->node;
        } else {
            *node = gm_formula_variable(&system->graph, system->parameters + entry->number);
        }
        break;
    case GM_ENTRY_COMPONENT:
        *node = gm_formula_variable(&system->graph, entry->number + (name->initial ? system->initial : 0) +
                                                        (name->exact ? system->exact : 0));
        break;
    case GM_ENTRY_TIME:
        *node = gm_formula_variable(&system->graph, system->n);
        break;
    default:
        *node = gm_formula_variable(&system->graph, system->velocities + entry->number);
        break;
    }
    return GM_KNOWN;
}

struct gm_definition *gm_reading_definition(const struct gm_reading *reading, const char *name, size_t length)
{
    for (size_t i = 0; i < reading->definition_count; i++) {
        const struct gm_span other = reading->definitions[i].name;
        if (other.end - other.begin == length && memcmp(reading->text + other.begin, name, length) == 0) {
            return &reading->definitions[i];
        }
    }
    return NULL;
}

static struct gm_definition *definition_of(void *data, const char *name, size_t length)
{
    return gm_reading_definition(data, name, length);
}

static const struct {
    const char *name;
    size_t least, most;
} form_operators[] = {
#define GM_FORM_OPERATOR(constant, ...) {__VA_ARGS__},
#include "core/model/form_operators.def"
#undef GM_FORM_OPERATOR
};

/* The operator of that name, or GM_FORM_OPERATORS. */
static enum gm_form_operator operator_of(const char *name, size_t length)
{
    size_t i = 0;
    while (i < GM_FORM_OPERATORS &&
           (strlen(form_operators[i].name) != length || memcmp(form_operators[i].name, name, length) != 0)) {
        i++;
    }
    return (enum gm_form_operator)i;
}

static bool is_operator(const void *data, const struct gm_name *name)
{
    (void)data;
    return operator_of(name->text, name->length) < GM_FORM_OPERATORS;
}

/* Makes the node of an operator of forms, the same one for the same operands. */
static enum gm_meaning call(void *data, const struct gm_name *name, const gm_node_id *operands, size_t count,
                            gm_node_id *node, char *sentence)
{
    struct gm_user_system *system = ((struct gm_reading *)data)->system;
    const enum gm_form_operator operator= operator_of(name->text, name->length);
    size_t i = 0;
    if (count < form_operators[operator].least || count > form_operators[operator].most) {
        snprintf(sentence, GM_FAULT_SENTENCE, "%s takes %s", form_operators[operator].name,
                 operator== GM_FORM_FORM               ? "two or three formulas"
                 : form_operators[operator].most == 2 ? "two forms"
                                                       : "one form");
        return GM_REFUSED;
    }
    if (!system->calls) {
        snprintf(sentence, GM_FAULT_SENTENCE, "a parameter holds no forms");
        return GM_REFUSED;
    }
    while (i < system->call_count &&
           (system->calls[i].operator!= operator|| system->calls[i].count != count ||
            memcmp(system->calls[i].operands, operands, count * sizeof *operands) != 0)) {
        i++;
    }
    if (i == GM_MOST_FORM_CALLS) {
        snprintf(sentence, GM_FAULT_SENTENCE, "a system has at most %d operators of forms",
                 GM_MOST_FORM_CALLS);
        return GM_REFUSED;
    }
    if (i == system->call_count) {
        struct gm_form_call *made = &system->calls[system->call_count++];
        made->operator= operator;
        made->count = count;
        memcpy(made->operands, operands, count * sizeof *operands);
    }
    *node = gm_formula_variable(&system->graph, system->first_call + i);
    return GM_KNOWN;
}

static struct gm_scope scope_of(struct gm_reading *reading)
{
    const bool form = gm_system_is_form(reading->system), calls = form && !reading->fixed;
    return (struct gm_scope){.find = find,
                             .known = known,
                             .definition = definition_of,
                             .calls = calls ? is_operator : NULL,
                             .call = calls ? call : NULL,
                             .data = reading,
                             .lines = true,
                             .initial = !form,
                             .exact = reading->exact,
                             .is_condition = reading->is_condition};
}

/* Ends an attempt that failed; true if another name must be read first. */
static bool is_postponed(struct gm_reading *reading, const struct gm_fault *fault)
{
    if (reading->system->graph.failed) {
        return gm_fail_memory(&reading->fault);
    }
    return fault->sentence[0] == '\0' || gm_fail_first(&reading->fault, fault->offset, "%s", fault->sentence);
}

/* Makes one attempt; false without a fault if another name must be read first. */
static bool attempt(struct gm_reading *reading, struct gm_span span, const struct gm_span *bound,
                    long element, gm_node_id *node, bool *postponed)
{
    struct gm_scope scope = scope_of(reading);
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
    const bool good =
        gm_formula_read(&reading->system->graph, reading->text, span.begin, span.end, &scope, node, &fault);
    *postponed = !good && is_postponed(reading, &fault);
    return good;
}

bool gm_reading_check(struct gm_reading *reading, struct gm_definition *definition)
{
    const struct gm_scope scope = scope_of(reading);
    struct gm_fault fault;
    return gm_formula_check(&reading->system->graph, reading->text, definition, &scope, &fault) ||
           is_postponed(reading, &fault);
}

static bool is_circle(struct gm_reading *reading, const uint32_t *stack, size_t depth)
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
        const struct gm_entry *entry = &reading->entries[stack[i]];
        used +=
            (size_t)snprintf(names + used, sizeof names - used, "%s%.*s", i > first ? ", which needs " : "",
                             (int)(entry->length < 50 ? entry->length : 50), entry->name);
    }
    const struct gm_entry *entry = &reading->entries[stack[first]];
    gm_fail_first(&reading->fault, entry->place,
                  depth - first == 1 ? "%s needs itself" : "a circle: %s, which needs the first again",
                  names);
    return true;
}

bool gm_reading_define(struct gm_reading *reading, uint32_t number)
{
    uint32_t *stack = NULL;
    size_t depth = 0;
    if (!gm_reading_reserve(reading, (void **)&stack, depth, sizeof *stack)) {
        return false;
    }
    stack[depth++] = number;
    while (depth > 0 && !reading->fault.failed) {
        struct gm_entry *entry = &reading->entries[stack[depth - 1]];
        const bool was_fixed = reading->fixed, was_exact = reading->exact;
        const struct gm_span counter = reading->counter;
        bool postponed = false;
        gm_node_id node = 0;
        reading->fixed = entry->role == GM_ENTRY_PARAMETER;
        reading->exact = entry->role == GM_ENTRY_OBSERVED && !gm_system_is_field(reading->system) &&
                         !gm_system_is_form(reading->system);
        reading->counter = (struct gm_span){0, 0};
        const bool good = attempt(reading, entry->value, &entry->bound, entry->element, &node, &postponed);
        reading->fixed = was_fixed;
        reading->exact = was_exact;
        reading->counter = counter;
        if (good) {
            entry->node = node;
            entry->read = true;
            depth--;
        } else if (postponed && !is_circle(reading, stack, depth) &&
                   gm_reading_reserve(reading, (void **)&stack, depth, sizeof *stack)) {
            stack[depth++] = reading->wanted;
        }
    }
    return !reading->fault.failed;
}

bool gm_reading_bound(struct gm_reading *reading, struct gm_span span, const struct gm_span *bound,
                      long element, gm_node_id *node)
{
    bool postponed = true;
    while (!reading->fault.failed && postponed) {
        if (attempt(reading, span, bound, element, node, &postponed)) {
            return true;
        }
        if (postponed) {
            gm_reading_define(reading, reading->wanted);
        }
    }
    return false;
}

bool gm_reading_formula(struct gm_reading *reading, struct gm_span span, gm_node_id *node)
{
    return gm_reading_bound(reading, span, NULL, 0, node);
}

bool gm_reading_condition(struct gm_reading *reading, struct gm_span span, gm_node_id *node)
{
    bool postponed = true, good = false;
    while (!reading->fault.failed && !good && postponed) {
        reading->is_condition = true;
        good = attempt(reading, span, NULL, 0, node, &postponed);
        reading->is_condition = false;
        if (postponed) {
            gm_reading_define(reading, reading->wanted);
        }
    }
    return good;
}

bool gm_reading_number(struct gm_reading *reading, struct gm_span span, double *value)
{
    gm_node_id node;
    const bool was_fixed = reading->fixed;
    reading->fixed = true;
    const bool good = gm_reading_formula(reading, span, &node);
    reading->fixed = was_fixed;
    *value = good ? reading->system->graph.nodes[node].value : NAN;
    return good;
}

/* Reads a whole number on which the graph depends. */
static bool read_whole(struct gm_reading *reading, struct gm_span span, double *number)
{
    reading->structural = true;
    const bool good = gm_reading_number(reading, span, number);
    reading->structural = false;
    return good &&
           (*number == floor(*number) ||
            gm_fail_first(&reading->fault, span.begin, "an index has to be a whole number, not %g", *number));
}

bool gm_reading_whole(struct gm_reading *reading, struct gm_span span, long *value)
{
    double number;
    if (!read_whole(reading, span, &number)) {
        return false;
    }
    if (fabs(number) > GM_LARGEST_INDEX) {
        return gm_fail_first(&reading->fault, span.begin, "an index lies between -%d and %d, and this is %g",
                             GM_LARGEST_INDEX, GM_LARGEST_INDEX, number);
    }
    *value = (long)number;
    return true;
}

bool gm_reading_target(struct gm_reading *reading, struct gm_span *rest, struct gm_target *target)
{
    *rest = gm_span_trimmed(reading->text, *rest);
    const size_t length = gm_name_length(reading->text + rest->begin, rest->end - rest->begin);
    *target = (struct gm_target){.name = {rest->begin, rest->begin + length}};
    if (length == 0) {
        const char c = rest->begin < rest->end ? reading->text[rest->begin] : '\0';
        return gm_fail_first(&reading->fault, rest->begin,
                             c == '\'' || c == '/'
                                 ? "the left side is a name alone: rate: x = -x gives x' = -x"
                                 : "a name was expected");
    }
    rest->begin += length;
    *rest = gm_span_trimmed(reading->text, *rest);
    if (rest->begin < rest->end && reading->text[rest->begin] == '[') {
        const struct gm_span inside = {rest->begin + 1, rest->end};
        const size_t close = gm_span_until(reading->text, inside, "]");
        if (close == rest->end) {
            return gm_fail_first(&reading->fault, rest->begin, "this bracket is not closed");
        }
        target->index = gm_span_trimmed(reading->text, (struct gm_span){inside.begin, close});
        rest->begin = close + 1;
        if (target->index.begin == target->index.end) {
            return gm_fail_first(&reading->fault, close, "an index was expected");
        }
    }
    return true;
}

bool gm_reading_assignment(struct gm_reading *reading, struct gm_span span, struct gm_target *target)
{
    if (!gm_reading_target(reading, &span, target)) {
        return false;
    }
    span = gm_span_trimmed(reading->text, span);
    if (span.begin == span.end || reading->text[span.begin] != '=') {
        return gm_fail_first(&reading->fault, span.begin, "= was expected");
    }
    target->value = gm_span_trimmed(reading->text, (struct gm_span){span.begin + 1, span.end});
    return target->value.begin < target->value.end ||
           gm_fail_first(&reading->fault, span.begin + 1, "a formula was expected");
}

struct gm_entry gm_reading_entry_for(const struct gm_reading *reading, const struct gm_target *target,
                                     enum gm_entry_role role)
{
    return (struct gm_entry){.name = (char *)reading->text + target->name.begin,
                             .length = target->name.end - target->name.begin,
                             .place = target->name.begin,
                             .role = role,
                             .value = target->value};
}

bool gm_reading_bounds(struct gm_reading *reading, struct gm_span span, const char *what, long *low,
                       long *high)
{
    const size_t dots = gm_span_until(reading->text, span, "..");
    const struct gm_span last = gm_span_trimmed(reading->text, (struct gm_span){dots + 2, span.end});
    double first, end;
    if (dots == span.end || !read_whole(reading, (struct gm_span){span.begin, dots}, &first) ||
        !read_whole(reading, last, &end)) {
        return false;
    }
    if (end - first >= GM_MOST_COMPONENTS) {
        return gm_fail_first(&reading->fault, span.begin, "%g .. %g are too many: there are at most %d %s",
                             first, end, GM_MOST_COMPONENTS, what);
    }
    if (end < first - 1) {
        return gm_fail_first(&reading->fault, span.begin,
                             "%g .. %g runs downwards: the lower end comes first", first, end);
    }
    return gm_reading_whole(reading, (struct gm_span){span.begin, dots}, low) &&
           gm_reading_whole(reading, last, high);
}

struct gm_entry *gm_reading_sought(struct gm_reading *reading, const struct gm_target *target, long index)
{
    const struct gm_name used = {.text = reading->text + target->name.begin,
                                 .length = target->name.end - target->name.begin,
                                 .indexed = target->index.begin < target->index.end,
                                 .index = index};
    struct gm_entry *entry = gm_reading_entry(reading, used.text, used.length, used.indexed, index);
    if (entry) {
        return entry;
    }
    gm_node_id node;
    char sentence[GM_FAULT_SENTENCE] = "", word[64];
    if (find(reading, &used, &node, sentence) == GM_REFUSED) {
        gm_fail_first(&reading->fault, target->name.begin, "%s", sentence);
        return NULL;
    }
    snprintf(word, sizeof word, "%.*s", (int)(used.length < 60 ? used.length : 60), used.text);
    const char *near = gm_nearest(word, reading->entry_count, known, reading);
    gm_fail_first(&reading->fault, target->name.begin, "there is no name %s%s%s", word,
                  near ? "; did you mean " : "", near ? near : "");
    return NULL;
}

static bool is_same(const struct gm_reading *reading, struct gm_span a, struct gm_span b)
{
    return a.end - a.begin == b.end - b.begin &&
           memcmp(reading->text + a.begin, reading->text + b.begin, a.end - a.begin) == 0;
}

bool gm_reading_elements(struct gm_reading *reading, const struct gm_target *target,
                         bool (*each)(struct gm_reading *reading, struct gm_entry *entry,
                                      const struct gm_target *target, gm_node_id node, void *data),
                         void *data)
{
    const char *name = reading->text + target->name.begin;
    const size_t length = target->name.end - target->name.begin;
    const int brief = (int)(length < 60 ? length : 60);
    const size_t letters =
        gm_name_length(reading->text + target->index.begin, target->index.end - target->index.begin);
    const bool all = letters > 0 && target->index.begin + letters == target->index.end &&
                     !is_same(reading, target->index, reading->counter) &&
                     !gm_reading_entry(reading, reading->text + target->index.begin, letters, false, 0);
    const bool indexed = target->index.begin < target->index.end;
    long low = 0, high = 0;
    gm_node_id node;
    if (all && !list_of(reading, name, length, &low, &high)) {
        return gm_fail_first(&reading->fault, target->name.begin, "there is no list %.*s", brief, name);
    }
    if (!all && indexed && !gm_reading_whole(reading, target->index, &low)) {
        return false;
    }
    high = all ? high : low;
    for (long i = low; i <= high && !reading->fault.failed; i++) {
        struct gm_entry *entry = gm_reading_entry(reading, name, length, indexed, i);
        if (all && entry && entry->role == GM_ENTRY_NAMED) {
            continue; /* a wall, q[0] = 0 */
        }
        if (!entry && !(entry = gm_reading_sought(reading, target, i))) {
            return false;
        }
        const size_t number = (size_t)(entry - reading->entries);
        if (gm_reading_bound(reading, target->value, all ? &target->index : NULL, i, &node)) {
            each(reading, &reading->entries[number], target, node, data);
        }
    }
    return !reading->fault.failed;
}

const struct gm_system_line *gm_reading_line(const struct gm_reading *reading, enum gm_system_word word)
{
    for (size_t i = 0; i < reading->line_count; i++) {
        if (reading->lines[i].word == word) {
            return &reading->lines[i];
        }
    }
    return NULL;
}

bool gm_reading_range(struct gm_reading *reading, struct gm_span rest, struct gm_written_range *range)
{
    struct gm_span ends = {0, 0};
    *range = (struct gm_written_range){.low = NAN, .high = NAN};
    (void)(gm_span_take(reading->text, &rest, ";", &ends) &&
           gm_span_take(reading->text, &rest, ";", &range->meaning) &&
           gm_span_take(reading->text, &rest, ";", &range->unit));
    const size_t dots = gm_span_until(reading->text, ends, "..");
    if (ends.begin == ends.end) {
        return true;
    }
    if (dots == ends.end) {
        return gm_fail_first(&reading->fault, ends.begin, "a range was expected, low .. high");
    }
    const struct gm_span low = {ends.begin, dots}, high = {dots + 2, ends.end};
    if (!gm_reading_number(reading, gm_span_trimmed(reading->text, low), &range->low) ||
        !gm_reading_number(reading, gm_span_trimmed(reading->text, high), &range->high)) {
        return false;
    }
    return range->low <= range->high ||
           gm_fail_first(&reading->fault, ends.begin, "a range's lower end comes first, and %g is above %g",
                         range->low, range->high);
}
