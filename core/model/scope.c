/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The lines of a system, their names, and formulas with such names. */
#include "core/model/scope.h"

#include <math.h>
#include <stdarg.h>
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
    ROOM = 1 << GM_ROOM,
    NODES = 1 << GM_SYSTEM_KINDS, /* nodes alone */
    IN_BLOCKS = 1 << (GM_SYSTEM_KINDS + 1),
    FREE = ROOM | IN_BLOCKS,
    LINE = FIELD | EVOLUTION | MATRICES,
    MOTION = CANONICAL | LAGRANGIAN | RATES | POISSON,
    OBSERVED = MOTION | LINE | FORMS,
    ANY = OBSERVED | NODES
};

const struct gm_line_word gm_system_words[GM_WORDS] = {
#define GM_WORD(constant, word, identity, kinds, reader) {word, (enum gm_line_identity)identity, kinds},
#include "core/model/words.def"
#undef GM_WORD
};

static const struct gm_line_words words = {"a system", gm_system_words, GM_WORDS,
                                           "; docs/systems.md names them", ANY},
                                  words_of_rooms = {
                                      "a room", gm_system_words, GM_WORDS,
                                      "; geomint list office --source prints a room with its lines", ROOM};

void gm_reading_refuse_second(struct gm_reading *reading, size_t place, const struct gm_entry *first)
{
    reading->system->fault->earlier = first->place;
    gm_system_refuse(reading->system, place, "%.60s is defined twice", first->name);
}

void gm_reading_lines(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    const bool room = gm_system_is_room(system);
    reading->words = room ? &words_of_rooms : &words;
    struct gm_read_lines lines = {.arena = system->arena,
                                  .fault = system->fault,
                                  .words = reading->words,
                                  .choices = &system->choices,
                                  .inside = room ? IN_BLOCKS : ~0u,
                                  .text = reading->text,
                                  .span = {0, reading->length}};
    gm_choices_read(&lines);
    for (size_t i = 0; i < reading->value_count; i++) {
        gm_choices_take(&system->choices, reading->values[i].name, reading->values[i].text);
    }
    gm_lines_read(&lines);
    reading->lines = lines.list;
    reading->line_count = lines.count;
}

char *gm_reading_text(struct gm_reading *reading, struct gm_span span)
{
    return gm_arena_keep(reading->system->arena, gm_span_words(reading->text, span), free);
}

struct gm_span gm_reading_between(const struct gm_reading *reading, size_t begin, size_t end)
{
    return gm_span_trimmed(reading->text, (struct gm_span){begin, end});
}

struct gm_span gm_reading_word(const struct gm_reading *reading, struct gm_span *rest)
{
    const size_t end = rest->begin + strcspn(reading->text + rest->begin, " \t\r\n");
    const struct gm_span word = {rest->begin, end < rest->end ? end : rest->end};
    *rest = gm_reading_between(reading, word.end, rest->end);
    return word;
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
        if (!entry || (entry->indexed == indexed && entry->index == index &&
                       gm_text_same(entry->name, entry->length, name, length))) {
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

struct gm_entry *gm_reading_named(const struct gm_reading *reading, struct gm_span name)
{
    return gm_reading_entry(reading, reading->text + name.begin, name.end - name.begin, false, 0);
}

/* Finds an element of a list of that name, and the bounds of the list. */
static const struct gm_entry *list_of(const struct gm_reading *reading, const char *name, size_t length,
                                      long *low, long *high)
{
    const struct gm_entry *found = NULL;
    for (size_t i = 0; i < reading->entry_count; i++) {
        const struct gm_entry *entry = &reading->entries[i];
        if (entry->indexed && gm_text_same(entry->name, entry->length, name, length)) {
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
        "shape",     "newmark_beta", "trails", "portrait", "window",      NULL};
    return reserved[gm_span_among(name, (struct gm_span){0, length}, reserved)] ||
           gm_formula_reserves(name, length);
}

/* True for keys of a ring, unless the reader has added them with their values. */
static bool is_of_ring(const struct gm_reading *reading, const struct gm_entry *entry)
{
    static const char *const keys[] = {"half_length", "points", "space", "boundary", NULL};
    return gm_system_is_field(reading->system) && !entry->read &&
           keys[gm_span_among(entry->name, (struct gm_span){0, entry->length}, keys)];
}

/* True for the place of a field, unless the reader has added it. */
static bool is_place(const struct gm_reading *reading, const struct gm_entry *entry)
{
    return gm_system_is_field(reading->system) && entry->role != GM_ENTRY_VELOCITY && entry->length == 1 &&
           entry->name[0] == 'x';
}

const char *const gm_room_variables[GM_ROOM_VARIABLES + 1] = {
    "x", "y", "", "s", "perimeter", "area", "inlet_length", "until", NULL};

/* True for a name that a room reserves: of its variables, and all that systems reserve, except show. */
static bool is_of_room(const struct gm_entry *entry)
{
    const struct gm_span name = {0, entry->length};
    return entry->role != GM_ENTRY_VELOCITY && entry->role != GM_ENTRY_TIME &&
           entry->role != GM_ENTRY_COMPONENT &&
           (gm_room_variables[gm_span_among(entry->name, name, gm_room_variables)] ||
            (gm_reading_reserves(entry->name, entry->length) && !gm_span_is(entry->name, name, "show")));
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
    while (i < GM_FORM_OPERATORS && !gm_span_is(name, (struct gm_span){0, length}, form_operators[i].name)) {
        i++;
    }
    return (enum gm_form_operator)i;
}

/* Doubles the capacity of entries and of their table. */
static void grow(struct gm_reading *reading)
{
    const size_t capacity = reading->entry_capacity ? 2 * reading->entry_capacity : 32;
    struct gm_entry *entries = gm_arena_resize(reading->scratch, reading->entries, capacity, sizeof *entries);
    uint32_t *table = gm_arena_take(reading->scratch, 4 * capacity, sizeof *table);
    gm_arena_need(reading->system->arena, entries && table);
    reading->entries = entries;
    reading->table = table;
    reading->entry_capacity = capacity;
    reading->slots = 4 * capacity;
    for (size_t i = 0; i < reading->entry_count; i++) {
        const struct gm_entry *entry = &entries[i];
        *slot_of(reading, entry->name, entry->length, entry->indexed, entry->index) = (uint32_t)i + 1;
    }
}

void gm_reading_add(struct gm_reading *reading, struct gm_entry entry)
{
    gm_system_refuse_if(reading->system, is_place(reading, &entry), entry.place,
                        "x is the place in a field: take another name");
    const size_t word = gm_line_word(&words, entry.name, (struct gm_span){0, entry.length});
    /* a choice between starts may be called so */
    const bool is_word = entry.role == GM_ENTRY_CHOICE && word < GM_WORDS && word != GM_WORD_START,
               room = gm_system_is_room(reading->system);
    gm_system_refuse_if(
        reading->system,
        room ? is_of_room(&entry)
             : is_word || is_of_ring(reading, &entry) ||
                   (gm_system_is_form(reading->system) &&
                    operator_of(entry.name, entry.length) < GM_FORM_OPERATORS) ||
                   (entry.role != GM_ENTRY_TIME && gm_reading_reserves(entry.name, entry.length)),
        entry.place, "the name %.*s" GM_RESERVED, gm_brief_length(entry.length), entry.name);
    if (reading->entry_count == reading->entry_capacity) {
        grow(reading);
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
        gm_reading_refuse_second(reading, entry.place, other);
    }
    entry.name = gm_arena_print(reading->scratch, "%.*s", (int)entry.length, entry.name);
    gm_arena_need(reading->system->arena, entry.name != NULL);
    reading->entries[reading->entry_count] = entry;
    *slot = (uint32_t)++reading->entry_count;
}

static const char *known(size_t i, const void *data)
{
    const struct gm_reading *reading = data;
    return i < reading->entry_count ? reading->entries[i].name : NULL;
}

__attribute__((format(printf, 2, 3))) static enum gm_meaning refuse(char *sentence, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, GM_FAULT_SENTENCE, format, arguments);
    va_end(arguments);
    return GM_REFUSED;
}

/* A name without an entry: another index of a list, a list without an index, or no list. */
static enum gm_meaning refuse_index(const struct gm_reading *reading, const struct gm_name *name,
                                    char *sentence)
{
    const int brief = gm_brief_length(name->length);
    const char *text = name->text;
    long low = 0, high = 0;
    const bool is_list = list_of(reading, text, name->length, &low, &high) != NULL;
    if (name->indexed && is_list) {
        return refuse(sentence, "%.*s[%ld] lies outside of %.*s[%ld] .. %.*s[%ld]", brief, text, name->index,
                      brief, text, low, brief, text, high);
    }
    if (is_list) {
        return refuse(sentence, "%.*s is a list: an index was expected, %.*s[%ld] .. %.*s[%ld]", brief, text,
                      brief, text, low, brief, text, high);
    }
    return gm_reading_entry(reading, text, name->length, false, 0)
               ? refuse(sentence, "%.*s is not a list", brief, text)
               : GM_UNKNOWN;
}

/* The function of that name, or NULL. */
static struct gm_definition *definition_of(void *data, const char *name, size_t length)
{
    const struct gm_reading *reading = data;
    for (size_t i = 0; i < reading->definition_count; i++) {
        const struct gm_span other = reading->definitions[i].name;
        if (gm_text_same(reading->text + other.begin, other.end - other.begin, name, length)) {
            return &reading->definitions[i];
        }
    }
    return NULL;
}

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    struct gm_reading *reading = data;
    struct gm_user_system *system = reading->system;
    const int brief = gm_brief_length(name->length);
    const bool room = gm_system_is_room(system), fixed = name->fixed || reading->context.fixed;
    struct gm_entry *entry = gm_reading_entry(reading, name->text, name->length, name->indexed, name->index);
    if (!entry && reading->along && gm_text_same(name->text, name->length, "s", 1)) {
        *node = gm_formula_variable(&system->graph, system->velocities + GM_FORM_PLACES - 1);
        return GM_KNOWN;
    }
    if (!entry) {
        return refuse_index(reading, name, sentence);
    }
    if (room && entry->role == GM_ENTRY_PARAMETER && isnan(system->graph.nodes[entry->node].value)) {
        return refuse(sentence, "%s is a word, not a number", entry->name);
    }
    if (entry->role == GM_ENTRY_CHOICE) {
        return refuse(sentence, "%s is a choice of words: write lines below \"when: %s = ...\"", entry->name,
                      entry->name);
    }
    if (entry->role == GM_ENTRY_FUNCTION) {
        const size_t count = definition_of(reading, name->text, name->length)->count;
        return refuse(sentence, "%.*s is a function of %zu argument%s", brief, name->text, count,
                      gm_plural((double)count));
    }
    if (name->initial && entry->role == GM_ENTRY_COMPONENT && gm_system_is_field(system)) {
        return refuse(sentence, "%.*s is a field: its start is not a number", brief, name->text);
    }
    if ((fixed && entry->role != GM_ENTRY_PARAMETER) ||
        ((name->initial || name->exact) && entry->role != GM_ENTRY_COMPONENT)) {
        const char *lacks =
            name->exact ? "component: it has no exact solution" : "component: it has no value at the start";
        return refuse(sentence, "%.*s is not a %s", brief, name->text,
                      fixed ? "parameter: its value is not known here" : lacks);
    }
    if (!entry->read && (entry->role >= GM_ENTRY_NAMED || (entry->role == GM_ENTRY_PARAMETER && fixed))) {
        reading->wanted = (uint32_t)(entry - reading->entries);
        return GM_POSTPONED;
    }
    const size_t first[] = {[GM_ENTRY_COMPONENT] =
                                (name->initial ? system->initial : 0) + (name->exact ? system->exact : 0),
                            [GM_ENTRY_VELOCITY] = system->velocities,
                            [GM_ENTRY_PARAMETER] = system->parameters,
                            [GM_ENTRY_TIME] = system->n};
    if (entry->role >= GM_ENTRY_NAMED) {
        *node = entry->node;
    } else if (entry->role == GM_ENTRY_PARAMETER && (fixed || room)) {
        system->variables[system->parameters + entry->number].fixed |= name->fixed || reading->structural;
        *node = entry->node;
    } else {
        *node = gm_formula_variable(&system->graph, first[entry->role] + entry->number);
    }
    const char *why = reading->withheld ? reading->withheld(reading, *node) : NULL;
    return why ? refuse(sentence, "%s", why) : GM_KNOWN;
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
        return refuse(sentence, "%s takes %s", form_operators[operator].name,
                      operator== GM_FORM_FORM               ? "two or three formulas"
                      : operator== GM_FORM_INTEGRAL        ? "a form, after a part of the boundary if it is a 1-form"
                      : operator== GM_FORM_AT              ? "a form and two or three coordinates"
                      : form_operators[operator].most == 2 ? "two forms"
                                                            : "one form");
    }
    if (!system->calls) {
        return refuse(sentence, "a parameter holds no forms");
    }
    while (i < system->call_count &&
           (system->calls[i].operator!= operator|| system->calls[i].count != count ||
            memcmp(system->calls[i].operands, operands, count * sizeof *operands) != 0)) {
        i++;
    }
    if (i == GM_MOST_FORM_CALLS) {
        return refuse(sentence, "a system has at most %d operators of forms", GM_MOST_FORM_CALLS);
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

/* The part of the boundary in integral(PART, a), as its number. */
static bool is_part(void *data, const struct gm_name *called, const struct gm_name *word, gm_node_id *node)
{
    struct gm_user_system *system = ((struct gm_reading *)data)->system;
    const char *name;
    if (operator_of(called->text, called->length) != GM_FORM_INTEGRAL) {
        return false;
    }
    size_t i = 0;
    while (i < system->boundary_count &&
           !gm_span_is(word->text, (struct gm_span){0, word->length}, system->boundaries[i])) {
        i++;
    }
    if (i == system->boundary_count) {
        name = gm_arena_print(system->arena, "%.*s", (int)word->length, word->text);
        system->boundaries = gm_arena_grown(system->arena, system->boundaries, i, sizeof *system->boundaries);
        system->boundaries[system->boundary_count++] = name;
    }
    *node = gm_formula_constant(&system->graph, (double)i);
    return true;
}

static struct gm_scope scope_of(struct gm_reading *reading)
{
    const bool form = gm_system_is_form(reading->system), room = gm_system_is_room(reading->system),
               calls = (form || (room && !reading->without_forms)) && !reading->context.fixed;
    return (struct gm_scope){.find = find,
                             .known = known,
                             .definition = definition_of,
                             .calls = calls ? is_operator : NULL,
                             .call = calls ? call : NULL,
                             .word = calls && form ? is_part : NULL,
                             .data = reading,
                             .lines = true,
                             .initial = !form && !room,
                             .exact = reading->context.exact};
}

/* Refuses the text after an attempt that failed, unless another name must be read first. */
static void need_postponed(const struct gm_reading *reading, const struct gm_fault *fault)
{
    gm_system_need_graph(reading->system);
    gm_system_refuse_if(reading->system, fault->sentence[0], fault->offset, "%s", fault->sentence);
}

/* Makes one attempt; GM_NO_NODE if another name must be read first. */
static gm_node_id attempt(struct gm_reading *reading, struct gm_span span, bool is_condition)
{
    struct gm_scope scope = scope_of(reading);
    const struct gm_index *const indices[] = {&reading->context.element, &reading->context.repeated};
    scope.is_condition = is_condition;
    for (int i = 0; i < 2; i++) {
        if (indices[i]->length > 0) {
            scope.indices[scope.index_count++] = *indices[i];
        }
    }
    struct gm_fault fault;
    gm_node_id node;
    if (!gm_formula_read(&reading->system->graph, reading->text, span.begin, span.end, &scope, &node,
                         &fault)) {
        need_postponed(reading, &fault);
        node = GM_NO_NODE;
    }
    return node;
}

void gm_reading_check(struct gm_reading *reading, struct gm_definition *definition)
{
    const struct gm_scope scope = scope_of(reading);
    struct gm_fault fault;
    if (!gm_formula_check(&reading->system->graph, reading->text, definition, &scope, &fault)) {
        need_postponed(reading, &fault);
    }
}

/* Refuses names of the stack that need each other in a circle. */
static void refuse_circle(struct gm_reading *reading, const uint32_t *stack, size_t depth)
{
    size_t first = 0, used = 0;
    while (first < depth && stack[first] != reading->wanted) {
        first++;
    }
    if (first == depth) {
        return;
    }
    char names[200] = "";
    for (size_t i = first; i < depth && used + 70 < sizeof names; i++) {
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%.50s",
                                 i > first ? ", which needs " : "", reading->entries[stack[i]].name);
    }
    gm_system_refuse(reading->system, reading->entries[stack[first]].place,
                     depth - first == 1 ? "%s needs itself" : "a circle: %s, which needs the first again",
                     names);
}

void gm_reading_define(struct gm_reading *reading, uint32_t number)
{
    uint32_t *stack = NULL;
    size_t depth = 0;
    stack = gm_arena_grown(reading->system->arena, stack, depth, sizeof *stack);
    stack[depth++] = number;
    while (depth > 0) {
        struct gm_entry *entry = &reading->entries[stack[depth - 1]];
        const struct gm_reading_context outer = reading->context;
        reading->context = (struct gm_reading_context){.fixed = entry->role == GM_ENTRY_PARAMETER,
                                                       .exact = entry->role == GM_ENTRY_OBSERVED &&
                                                                gm_reading_has_solution(reading)};
        const gm_node_id node = attempt(reading, entry->value, false);
        reading->context = outer;
        if (node != GM_NO_NODE) {
            entry->node = node;
            entry->read = true;
            depth--;
        } else {
            refuse_circle(reading, stack, depth);
            stack = gm_arena_grown(reading->system->arena, stack, depth, sizeof *stack);
            stack[depth++] = reading->wanted;
        }
    }
}

/* Reads a formula or a condition, after all names that it needs. */
static gm_node_id read_after_names(struct gm_reading *reading, struct gm_span span, bool is_condition)
{
    gm_node_id node;
    while ((node = attempt(reading, span, is_condition)) == GM_NO_NODE) {
        gm_reading_define(reading, reading->wanted);
    }
    return node;
}

gm_node_id gm_reading_formula(struct gm_reading *reading, struct gm_span span)
{
    return read_after_names(reading, span, false);
}

gm_node_id gm_reading_formula_of_exact(struct gm_reading *reading, struct gm_span span)
{
    reading->context.exact = true;
    const gm_node_id node = gm_reading_formula(reading, span);
    reading->context.exact = false;
    return node;
}

gm_node_id gm_reading_condition(struct gm_reading *reading, struct gm_span span)
{
    return read_after_names(reading, span, true);
}

double gm_reading_number(struct gm_reading *reading, struct gm_span span)
{
    const bool was_fixed = reading->context.fixed;
    reading->context.fixed = true;
    const gm_node_id node = gm_reading_formula(reading, span);
    reading->context.fixed = was_fixed;
    return reading->system->graph.nodes[node].value;
}

double gm_reading_finite(struct gm_reading *reading, struct gm_span span)
{
    const double number = gm_reading_number(reading, span);
    gm_system_refuse_if(reading->system, !isfinite(number), span.begin, "this is not a finite number");
    return number;
}

/* Reads a whole number on which the graph depends. */
static double read_whole(struct gm_reading *reading, struct gm_span span)
{
    reading->structural = true;
    const double number = gm_reading_number(reading, span);
    reading->structural = false;
    gm_system_refuse_if(reading->system, number != floor(number), span.begin,
                        "an index has to be a whole number, not %g", number);
    return number;
}

long gm_reading_whole(struct gm_reading *reading, struct gm_span span)
{
    const double number = read_whole(reading, span);
    gm_system_refuse_if(reading->system, fabs(number) > GM_LARGEST_INDEX, span.begin,
                        "an index lies between -%d and %d, and this is %g", GM_LARGEST_INDEX,
                        GM_LARGEST_INDEX, number);
    return (long)number;
}

struct gm_target gm_reading_target(struct gm_reading *reading, struct gm_span *rest)
{
    *rest = gm_span_trimmed(reading->text, *rest);
    const size_t length = gm_name_length(reading->text + rest->begin, rest->end - rest->begin);
    struct gm_target target = {.name = {rest->begin, rest->begin + length}};
    if (length == 0) {
        const char c = rest->begin < rest->end ? reading->text[rest->begin] : '\0';
        gm_system_refuse(reading->system, rest->begin,
                         c == '\'' || c == '/' ? "the left side is a name alone: rate: x = -x gives x' = -x"
                                               : "a name was expected");
    }
    *rest = gm_reading_between(reading, rest->begin + length, rest->end);
    if (rest->begin < rest->end && reading->text[rest->begin] == '[') {
        const struct gm_span inside = {rest->begin + 1, rest->end};
        const size_t close = gm_span_until(reading->text, inside, "]");
        gm_system_refuse_if(reading->system, close == rest->end, rest->begin, "this bracket is not closed");
        target.index = gm_reading_between(reading, inside.begin, close);
        rest->begin = close + 1;
        gm_system_refuse_if(reading->system, target.index.begin == target.index.end, close,
                            "an index was expected");
    }
    return target;
}

struct gm_target gm_reading_assignment(struct gm_reading *reading, struct gm_span span)
{
    struct gm_target target = gm_reading_target(reading, &span);
    span = gm_span_trimmed(reading->text, span);
    gm_system_refuse_if(reading->system, span.begin == span.end || reading->text[span.begin] != '=',
                        span.begin, "= was expected");
    target.value = gm_reading_between(reading, span.begin + 1, span.end);
    gm_system_refuse_if(reading->system, target.value.begin == target.value.end, span.begin + 1,
                        "a formula was expected");
    return target;
}

struct gm_entry gm_reading_entry_for(const struct gm_reading *reading, const struct gm_target *target,
                                     enum gm_entry_role role)
{
    return (struct gm_entry){.name = reading->text + target->name.begin,
                             .length = target->name.end - target->name.begin,
                             .place = target->name.begin,
                             .role = role,
                             .value = target->value};
}

bool gm_reading_bounds(struct gm_reading *reading, struct gm_span span, const char *what, long *low,
                       long *high)
{
    const size_t dots = gm_span_until(reading->text, span, "..");
    if (dots == span.end) {
        return false;
    }
    const struct gm_span first = {span.begin, dots}, last = gm_reading_between(reading, dots + 2, span.end);
    const double lowest = read_whole(reading, first), highest = read_whole(reading, last);
    gm_system_refuse_if(reading->system, highest - lowest >= GM_MOST_COMPONENTS, span.begin,
                        "%g .. %g are too many: there are at most %d %s", lowest, highest, GM_MOST_COMPONENTS,
                        what);
    gm_system_refuse_if(reading->system, highest < lowest - 1, span.begin,
                        "%g .. %g runs downwards: the lower end comes first", lowest, highest);
    *low = gm_reading_whole(reading, first);
    *high = gm_reading_whole(reading, last);
    return true;
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
    gm_system_refuse_if(reading->system, find(reading, &used, &node, sentence) == GM_REFUSED,
                        target->name.begin, "%s", sentence);
    snprintf(word, sizeof word, "%.*s", gm_brief_length(used.length), used.text);
    const char *near = gm_nearest(word, reading->entry_count, known, reading);
    gm_system_refuse(reading->system, target->name.begin, "there is no name %s%s%s", word,
                     near ? "; did you mean " : "", near ? near : "");
}

void gm_reading_elements(struct gm_reading *reading, const struct gm_target *target,
                         void (*each)(struct gm_reading *reading, struct gm_entry *entry,
                                      const struct gm_target *target, gm_node_id node, void *data),
                         void *data)
{
    const char *name = reading->text + target->name.begin;
    const size_t length = target->name.end - target->name.begin;
    const struct gm_span index = target->index;
    const struct gm_index *repeated = &reading->context.repeated;
    const char *name_of_index = reading->text + index.begin;
    const size_t letters = gm_name_length(name_of_index, index.end - index.begin);
    const bool all = letters > 0 && index.begin + letters == index.end &&
                     !gm_text_same(name_of_index, letters, repeated->text, repeated->length) &&
                     !gm_reading_named(reading, index);
    const bool indexed = index.begin < index.end;
    long low = 0, high = 0;
    gm_system_refuse_if(reading->system, all && !list_of(reading, name, length, &low, &high),
                        target->name.begin, "there is no list %.*s", gm_brief_length(length), name);
    if (!all) {
        low = high = indexed ? gm_reading_whole(reading, index) : 0;
    }
    for (long i = low; i <= high; i++) {
        const struct gm_entry *entry = gm_reading_entry(reading, name, length, indexed, i);
        if (all && entry && entry->role == GM_ENTRY_NAMED) {
            continue; /* a wall, q[0] = 0 */
        }
        entry = entry ? entry : gm_reading_sought(reading, target, i);
        const size_t number = (size_t)(entry - reading->entries);
        reading->context.element = (struct gm_index){name_of_index, all ? letters : 0, i};
        const gm_node_id node = gm_reading_formula(reading, target->value);
        reading->context.element.length = 0;
        each(reading, &reading->entries[number], target, node, data);
    }
}

const struct gm_read_line *gm_reading_line(const struct gm_reading *reading, enum gm_system_word word)
{
    for (size_t i = 0; i < reading->line_count; i++) {
        if (reading->lines[i].word == word) {
            return &reading->lines[i];
        }
    }
    return NULL;
}

struct gm_written_range gm_reading_range(struct gm_reading *reading, struct gm_span rest)
{
    struct gm_span ends = {0, 0};
    struct gm_written_range range = {.low = NAN, .high = NAN};
    (void)(gm_span_take(reading->text, &rest, ";", &ends) &&
           gm_span_take(reading->text, &rest, ";", &range.meaning) &&
           gm_span_take(reading->text, &rest, ";", &range.unit));
    const size_t dots = gm_span_until(reading->text, ends, "..");
    if (ends.begin == ends.end) {
        return range;
    }
    gm_system_refuse_if(reading->system, dots == ends.end, ends.begin, "a range was expected, low .. high");
    range.low = gm_reading_number(reading, gm_reading_between(reading, ends.begin, dots));
    range.high = gm_reading_number(reading, gm_reading_between(reading, dots + 2, ends.end));
    gm_system_refuse_if(reading->system, !(range.low <= range.high), ends.begin,
                        "a range's lower end comes first, and %g is above %g", range.low, range.high);
    return range;
}
