/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas of rooms: names, parameters, numbers. */
#include "core/flow/names.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/expression/number.h"
#include "core/model/scope.h"

static const char *const variables[GM_ROOM_AT] = {"s", "x", "y", "t"};
static const char *const measures[GM_ROOM_MEASURES] = {"perimeter", "area", "inlet_length", "until"};

/* A formula that is read, and the variables that it may hold. */
struct reading {
    const struct gm_room_names *names;
    struct gm_formula *graph;
    unsigned may;
    bool timed;
};

const struct gm_room_parameter *gm_room_parameter(const struct gm_room_names *names, const char *name)
{
    for (size_t i = 0; i < names->count; i++) {
        if (strcmp(names->parameters[i].name, name) == 0) {
            return &names->parameters[i];
        }
    }
    return NULL;
}

bool gm_room_is_word(const struct gm_room_names *names, struct gm_span span, const char *word)
{
    return gm_span_among(names->text, span, (const char *const[]){word, NULL}) == 0;
}

bool gm_room_is_listed(const struct gm_room_names *names, const char *words, struct gm_span word)
{
    bool listed = false;
    for (const char *at = words; *(at += strspn(at, ", ")); at += strcspn(at, ", ")) {
        const size_t length = strcspn(at, ", ");
        listed |= length == word.end - word.begin && strncmp(at, names->text + word.begin, length) == 0;
    }
    return listed;
}

static const char *known(size_t i, const void *data)
{
    const struct gm_room_names *names = ((const struct reading *)data)->names;
    return i < GM_ROOM_AT                  ? variables[i]
           : i - GM_ROOM_AT < names->count ? names->parameters[i - GM_ROOM_AT].name
                                           : NULL;
}

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    struct reading *reading = data;
    char whole[GM_ROOM_NAME];
    snprintf(whole, sizeof whole, "%.*s", (int)(name->length < sizeof whole ? name->length : 0), name->text);
    const struct gm_room_parameter *parameter = gm_room_parameter(reading->names, whole);
    if (parameter && !name->indexed && !name->initial) {
        if (isnan(parameter->value)) {
            snprintf(sentence, GM_FAULT_SENTENCE, "%s is a word, and no number", parameter->name);
            return GM_REFUSED;
        }
        *node = gm_formula_constant(reading->graph, parameter->value);
        return GM_KNOWN;
    }
    for (size_t i = 0; i < GM_ROOM_MEASURES; i++) {
        if (strcmp(whole, measures[i]) == 0 && !isnan(reading->names->measures[i])) {
            *node = gm_formula_constant(reading->graph, reading->names->measures[i]);
            return GM_KNOWN;
        }
    }
    for (size_t i = 0; i < GM_ROOM_AT; i++) {
        if (strcmp(whole, variables[i]) != 0 || name->initial) {
            continue;
        }
        if (name->indexed) {
            snprintf(sentence, GM_FAULT_SENTENCE, "%s is one number, and has no index", variables[i]);
            return GM_REFUSED;
        }
        if (!(reading->may >> i & 1)) {
            snprintf(sentence, GM_FAULT_SENTENCE, "%s",
                     i == GM_ROOM_AT_T
                         ? "what a room's boundary gives may change in time: no start, no source and no place"
                     : i == GM_ROOM_AT_S
                         ? "s runs along an inlet, and stands in what that gives at a place"
                         : "a flow is that of a whole side, and a place is two numbers: neither holds "
                           "x and y");
            return GM_REFUSED;
        }
        reading->timed = reading->timed || i == GM_ROOM_AT_T;
        *node = gm_formula_variable(reading->graph, i);
        return GM_KNOWN;
    }
    return GM_UNKNOWN;
}

bool gm_room_read_formula(const struct gm_room_names *names, struct gm_span span, unsigned may,
                          struct gm_formula *graph, gm_node_id *node, bool *timed, struct gm_fault *fault)
{
    struct reading reading = {names, graph, may, false};
    const struct gm_scope scope = {.find = find, .known = known, .data = &reading, .lines = true};
    const bool good = gm_formula_read(graph, names->text, span.begin, span.end, &scope, node, fault);
    *timed = reading.timed;
    return good;
}

bool gm_room_value_of(const struct gm_room_names *names, struct gm_span span, unsigned may,
                      const double at[GM_ROOM_AT], double *value, struct gm_fault *fault)
{
    struct gm_formula graph;
    gm_node_id node = 0;
    bool timed;
    gm_formula_open(&graph);
    bool good = gm_room_read_formula(names, span, may, &graph, &node, &timed, fault);
    double *values = good ? malloc((graph.count + 1) * sizeof *values) : NULL;
    good = values != NULL;
    if (good) {
        gm_formula_evaluate(&graph, node + 1, at, values);
        *value = values[node];
    }
    free(values);
    gm_formula_close(&graph);
    return good;
}

bool gm_room_number(const struct gm_room_names *names, struct gm_span span, double *number,
                    struct gm_fault *fault)
{
    const double origin[GM_ROOM_AT] = {0};
    return gm_room_value_of(names, span, 0, origin, number, fault) &&
           (isfinite(*number) || gm_fail(fault, span.begin, "this is no finite number"));
}

bool gm_room_range_of(const struct gm_room_names *names, struct gm_span span, struct gm_room_range *range,
                      struct gm_fault *fault)
{
    const size_t dots = gm_span_until(names->text, span, "..");
    if (dots == span.end) {
        return gm_fail(fault, span.begin, "a range was expected, low .. high");
    }
    return gm_room_number(names, (struct gm_span){span.begin, dots}, &range->least, fault) &&
           gm_room_number(names, (struct gm_span){dots + 2, span.end}, &range->most, fault) &&
           (range->least < range->most || gm_fail(fault, span.begin, "a range's lower end comes first"));
}

/* Whether a name means something else: in formulas, on a command line but for what the picture shows, or in tables. */
static bool is_reserved(const char *name)
{
    bool reserved = strcmp(name, "show") != 0 && gm_reading_reserves(name, strlen(name));
    for (size_t i = 0; i < GM_ROOM_AT; i++) {
        reserved |= strcmp(name, variables[i]) == 0;
    }
    for (size_t i = 0; i < GM_ROOM_MEASURES; i++) {
        reserved |= strcmp(name, measures[i]) == 0;
    }
    return reserved;
}

/* NAME = VALUE; low .. high; meaning, or NAME = WORD of WORD, WORD; meaning */
bool gm_room_declare(struct gm_room_names *names, struct gm_span rest, bool choice,
                     const struct gm_room_given *given, size_t count, struct gm_fault *fault)
{
    struct gm_room_parameter *more = realloc(names->parameters, (names->count + 1) * sizeof *more);
    struct gm_span head, piece;
    if (!more) {
        return false;
    }
    names->parameters = more;
    struct gm_room_parameter *parameter = &more[names->count++];
    *parameter = (struct gm_room_parameter){.value = NAN, .low = NAN, .high = NAN, .place = rest.begin};
    gm_span_take(names->text, &rest, ";", &head);
    const size_t equals = gm_span_until(names->text, head, "=");
    const struct gm_span value = {equals < head.end ? equals + 1 : equals, head.end};
    const size_t of = choice ? gm_span_until(names->text, value, " of ") : value.end;
    struct gm_span after = rest;
    if (!choice && gm_span_take(names->text, &after, ";", &piece) &&
        gm_span_until(names->text, piece, "..") < piece.end) {
        struct gm_room_range range;
        if (!gm_room_range_of(names, piece, &range, fault)) {
            return false;
        }
        parameter->low = range.least;
        parameter->high = range.most;
        rest = after;
    }
    const struct {
        char **text;
        struct gm_span span;
    } parts[] = {{&parameter->name, {head.begin, equals}},
                 {&parameter->text, {value.begin, of}},
                 {&parameter->words, {of < value.end ? of + 4 : of, value.end}},
                 {&parameter->meaning, rest}};
    for (size_t i = 0; i < GM_COUNT(parts); i++) {
        *parts[i].text = gm_span_words(names->text, parts[i].span);
        if (!*parts[i].text) {
            return false;
        }
    }
    gm_number_parse(parameter->text, &parameter->value);
    const size_t letters = strlen(parameter->name);
    if (gm_room_parameter(names, parameter->name) != parameter || letters == 0 || letters >= GM_ROOM_NAME ||
        gm_name_length(parameter->name, letters) != letters || (choice && !parameter->words[0])) {
        return gm_fail(fault, head.begin, "%s",
                       choice ? "choice: needs a name and words: domain = torus of torus, box"
                              : "parameter: needs a name that is no other: height = 1");
    }
    if (is_reserved(parameter->name)) {
        return gm_fail(fault, head.begin, "the name %s is reserved", parameter->name);
    }
    const struct gm_span usual = gm_span_trimmed(names->text, (struct gm_span){value.begin, of});
    if (choice && !gm_room_is_listed(names, parameter->words, usual)) {
        return gm_fail(fault, value.begin, "%s = %.60s is none of its words: %.160s", parameter->name,
                       parameter->text, parameter->words);
    }
    if (parameter->value < parameter->low || parameter->value > parameter->high) {
        return gm_fail(fault, value.begin, "%s = %g lies outside of its range, %g .. %g", parameter->name,
                       parameter->value, parameter->low, parameter->high);
    }
    for (size_t i = 0; i < count; i++) {
        if (strcmp(given[i].name, parameter->name) == 0) {
            char *text = given[i].text ? strdup(given[i].text) : parameter->text;
            if (given[i].text) {
                free(parameter->text);
            }
            parameter->text = text;
            parameter->value = given[i].text ? NAN : given[i].value;
        }
    }
    return parameter->text != NULL;
}

void gm_room_names_close(struct gm_room_names *names)
{
    for (size_t i = 0; i < names->count; i++) {
        free(names->parameters[i].name);
        free(names->parameters[i].text);
        free(names->parameters[i].words);
        free(names->parameters[i].meaning);
    }
    free(names->parameters);
    free(names->text);
}
