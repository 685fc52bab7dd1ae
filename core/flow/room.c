/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms of files: lines to sides of a mesh's boundary, sources, a start and probes. */
#include "core/flow/room.h"
#include "core/basics.h"
#include "core/memory.h"
#include "core/model/scope.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const keys[GM_ROOM_KEYS] = {
    "speed", "flow", "scalar",    "temperature",     "tangential", "heat",    "rate",           "x",
    "y",     "slip", "vorticity", "stream_function", "speed_x",    "speed_y", "total_pressure", "centre"};

#define CARRIED (1u << GM_ROOM_SCALAR | 1u << GM_ROOM_TEMPERATURE)
#define ENTERING (1u << GM_ROOM_SPEED | 1u << GM_ROOM_FLOW | 1u << GM_ROOM_CENTRE)
#define PLACE (1u << GM_ROOM_X | 1u << GM_ROOM_Y)
#define MOTION (1u << GM_ROOM_STREAM_FUNCTION | 1u << GM_ROOM_SPEED_X | 1u << GM_ROOM_SPEED_Y)

/* The lines that hold pairs key = formula: the keys they may have, those that they must, and those of which
   they need one; and of what they are the only one of their name. */
static const struct {
    unsigned may, must, some;
    enum { SIDE, THING, START, EXACT } names; /* the last two have none */
} pairs[] = {
    [GM_ROOM_INLET] = {ENTERING | CARRIED, 0, ENTERING, SIDE},
    [GM_ROOM_OUTLET] = {1u << GM_ROOM_FLOW, 0, 0, SIDE},
    [GM_ROOM_WALL] = {CARRIED | 1u << GM_ROOM_TANGENTIAL | 1u << GM_ROOM_HEAT | 1u << GM_ROOM_SLIP, 0, 0,
                      SIDE},
    [GM_ROOM_BOUNDARY] = {MOTION | CARRIED, 1u << GM_ROOM_STREAM_FUNCTION, 0, SIDE},
    [GM_ROOM_SOURCE] = {1u << GM_ROOM_RATE | PLACE, 1u << GM_ROOM_RATE, 0, THING},
    [GM_ROOM_PROBE] = {PLACE, PLACE, 0, THING},
    [GM_ROOM_START] = {CARRIED | 1u << GM_ROOM_VORTICITY, 0, CARRIED | 1u << GM_ROOM_VORTICITY, START},
    [GM_ROOM_EXACT] = {MOTION | 1u << GM_ROOM_SCALAR | 1u << GM_ROOM_TOTAL_PRESSURE, 0,
                       1u << GM_ROOM_STREAM_FUNCTION, EXACT},
};
enum { PAIRS = GM_COUNT(pairs), PARAMETER = PAIRS };

/* All lines; those with pairs first, in the order of enum gm_room_word. FREE: also in a block of a choice. */
enum { FREE = 1 };
static const char reference[] = "reference-temperature";
static const struct gm_line_word words[] = {
    {"inlet", GM_LINE_ADDED, FREE},      {"outlet", GM_LINE_ADDED, FREE}, {"wall", GM_LINE_ADDED, FREE},
    {"boundary", GM_LINE_ADDED, FREE},   {"source", GM_LINE_ADDED, FREE}, {"probe", GM_LINE_ADDED, FREE},
    {"start", GM_LINE_ONCE, FREE},       {"exact", GM_LINE_ONCE, FREE},   {"parameter", GM_LINE_ADDED, 0},
    {"geomint", GM_LINE_ONCE, 0},        {"title", GM_LINE_ONCE, 0},      {"about", GM_LINE_ONCE, 0},
    {"watch", GM_LINE_ONCE, 0},          {"reference", GM_LINE_ONCE, 0},  {"units", GM_LINE_ONCE, 0},
    {"scalar", GM_LINE_ONCE, 0},         {"time", GM_LINE_ONCE, FREE},    {"subtitle", GM_LINE_ONCE, FREE},
    {"caption", GM_LINE_ONCE, FREE},     {"mesh", GM_LINE_ONCE, FREE},    {"viscosity", GM_LINE_ONCE, 0},
    {"diffusivity", GM_LINE_ONCE, 0},    {"reynolds", GM_LINE_ONCE, 0},   {"schmidt", GM_LINE_ONCE, 0},
    {"buoyancy", GM_LINE_ONCE, 0},       {reference, GM_LINE_ONCE, 0},    {"dt", GM_LINE_ONCE, 0},
    {"until", GM_LINE_ONCE, 0},          {"colours", GM_LINE_ONCE, FREE}, {"levels", GM_LINE_ONCE, FREE},
    {"exact-while", GM_LINE_ONCE, FREE}, {"schemes", GM_LINE_ONCE, 0},    {"lanes", GM_LINE_ONCE, 0},
    {"work", GM_LINE_ONCE, 0},           {"stability", GM_LINE_ONCE, 0},  {"graph", GM_LINE_ADDED, FREE},
    {"table", GM_LINE_ADDED, 0},         {"figure", GM_LINE_ADDED, 0},    {"side", GM_LINE_NAMED, FREE},
    {"observe", GM_LINE_NAMED, 0},       {"profile", GM_LINE_NAMED, 0}};
static const struct gm_line_words line_words = {
    "a room", words, GM_COUNT(words), "; geomint list office --source prints a room with its lines"};

/* The variables of formulas. */
enum { PART, X, Y, TIME, VARIABLES };
static const char *const variables[VARIABLES] = {"s", "x", "y", "t"};

static const char *const measures[GM_ROOM_MEASURES] = {"perimeter", "area", "inlet_length", "until"};

/* A formula that is read, and the variables that it may hold. */
struct reading {
    const struct gm_room *room;
    struct gm_formula *graph;
    unsigned may;
    bool timed; /* it holds t */
};

/* A flow is that of a whole side, a place is one; s runs along inlets, and what the boundary gives, and the
   exact solution, may change in time. */
static unsigned may_hold(enum gm_room_word word, enum gm_room_key key)
{
    const unsigned along = 1u << X | 1u << Y | (word == GM_ROOM_INLET ? 1u << PART : 0),
                   changes = word <= GM_ROOM_BOUNDARY || word == GM_ROOM_EXACT ? 1u << TIME : 0;
    return key == GM_ROOM_SLIP                            ? 0
           : key == GM_ROOM_FLOW || key == GM_ROOM_CENTRE ? changes
           : key == GM_ROOM_X || key == GM_ROOM_Y         ? 0
                                                          : along | changes;
}

const struct gm_room_parameter *gm_room_parameter(const struct gm_room *room, const char *name)
{
    for (size_t i = 0; i < room->parameter_count; i++) {
        if (strcmp(room->parameters[i].name, name) == 0) {
            return &room->parameters[i];
        }
    }
    return NULL;
}

static const char *known(size_t i, const void *data)
{
    const struct gm_room *room = ((const struct reading *)data)->room;
    return i < VARIABLES                           ? variables[i]
           : i - VARIABLES < room->parameter_count ? room->parameters[i - VARIABLES].name
                                                   : NULL;
}

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    struct reading *reading = data;
    char whole[GM_ROOM_NAME];
    snprintf(whole, sizeof whole, "%.*s", (int)(name->length < sizeof whole ? name->length : 0), name->text);
    const struct gm_room_parameter *parameter = gm_room_parameter(reading->room, whole);
    if (parameter ? isnan(parameter->value) : gm_choice_named(&reading->room->choices, whole) != NULL) {
        snprintf(sentence, GM_FAULT_SENTENCE, "%s is a word, not a number", whole);
        return GM_REFUSED;
    }
    if (parameter && !name->indexed && !name->initial) {
        *node = gm_formula_constant(reading->graph, parameter->value);
        return GM_KNOWN;
    }
    for (size_t i = 0; i < GM_ROOM_MEASURES; i++) {
        if (strcmp(whole, measures[i]) == 0 && !isnan(reading->room->measures[i])) {
            *node = gm_formula_constant(reading->graph, reading->room->measures[i]);
            return GM_KNOWN;
        }
    }
    for (size_t i = 0; i < VARIABLES; i++) {
        if (strcmp(whole, variables[i]) != 0 || name->initial) {
            continue;
        }
        if (name->indexed) {
            snprintf(sentence, GM_FAULT_SENTENCE, "%s is one number, and has no index", variables[i]);
            return GM_REFUSED;
        }
        if (!(reading->may >> i & 1)) {
            snprintf(sentence, GM_FAULT_SENTENCE, "%s",
                     i == TIME
                         ? "what a room's boundary gives may change in time: no start, no source and no place"
                     : i == PART
                         ? "s runs along an inlet; only the inlet's formulas may contain it"
                         : "a flow is that of a whole side, and a place is two numbers: neither holds "
                           "x and y");
            return GM_REFUSED;
        }
        reading->timed = reading->timed || i == TIME;
        *node = gm_formula_variable(reading->graph, i);
        return GM_KNOWN;
    }
    return GM_UNKNOWN;
}

static bool read_node(struct reading *reading, struct gm_span span, gm_node_id *node, struct gm_fault *fault)
{
    const struct gm_scope scope = {.find = find, .known = known, .data = reading, .lines = true};
    return gm_formula_read(reading->graph, reading->room->text, span.begin, span.end, &scope, node, fault);
}

void gm_room_refuse(const struct gm_room *room, size_t place, const char *format, ...)
{
    char sentence[GM_FAULT_SENTENCE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(sentence, sizeof sentence, format, arguments);
    va_end(arguments);
    gm_fail(room->fault, place, "%s", sentence);
    gm_arena_refuse(room->arena, "%s", sentence);
}

void gm_room_need(const struct gm_room *room, bool good)
{
    const char *sentence = room->fault->sentence;
    if (!good) {
        gm_arena_refuse(room->arena, "%s", sentence[0] ? sentence : "not enough memory");
    }
}

/* Returns true if a text is a number, which it reads. Leaves the body if memory for its value is refused. */
static bool read_number(const struct gm_room *room, const char *text, double *number)
{
    const unsigned long refusals = gm_memory_refusals();
    const bool is_read = gm_number_parse(text, number);
    gm_room_need(room, gm_memory_refusals() == refusals);
    return is_read;
}

char *gm_room_keep(const struct gm_room *room, struct gm_span span)
{
    return gm_arena_keep(room->arena, gm_span_words(room->text, span), free);
}

static void read_formula(struct gm_room *room, struct gm_span span, enum gm_room_word word,
                         enum gm_room_key key, struct gm_room_formula *value)
{
    struct reading reading = {room, &room->graph, may_hold(word, key), false};
    gm_node_id node = 0;
    gm_room_need(room, read_node(&reading, span, &node, room->fault));
    room->timed = room->timed || (reading.timed && word <= GM_ROOM_BOUNDARY);
    value->place = span.begin;
    value->part = gm_arena_keep(room->arena, gm_formula_parts(&room->graph, node, &value->parts), free);
}

double gm_room_value(const struct gm_room *room, const struct gm_room_line *line, enum gm_room_key key,
                     const double at[VARIABLES], double standard)
{
    const struct gm_room_formula *value = line ? &line->value[key] : NULL;
    if (!value || value->place == 0) {
        return standard;
    }
    gm_formula_evaluate_parts(&room->graph, value->part, value->parts, at, room->scratch);
    return room->scratch[value->part[value->parts - 1]];
}

/* The value of a formula at a place. */
static bool read_value(const struct gm_room *room, struct gm_span span, unsigned may,
                       const double at[VARIABLES], double *value, struct gm_fault *fault)
{
    struct gm_formula graph;
    struct reading reading = {room, &graph, may, false};
    gm_node_id node = 0;
    gm_formula_open(&graph);
    bool good = read_node(&reading, span, &node, fault);
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

bool gm_room_number(const struct gm_room *room, struct gm_span span, double *number, struct gm_fault *fault)
{
    const double origin[VARIABLES] = {0};
    return read_value(room, span, 0, origin, number, fault) &&
           (isfinite(*number) || gm_fail(fault, span.begin, "this is not a finite number"));
}

bool gm_room_range_of(const struct gm_room *room, struct gm_span span, struct gm_room_range *range,
                      struct gm_fault *fault)
{
    const size_t dots = gm_span_until(room->text, span, "..");
    if (dots == span.end) {
        return gm_fail(fault, span.begin, "a range was expected, low .. high");
    }
    return gm_room_number(room, (struct gm_span){span.begin, dots}, &range->least, fault) &&
           gm_room_number(room, (struct gm_span){dots + 2, span.end}, &range->most, fault) &&
           (range->least < range->most || gm_fail(fault, span.begin, "a range's lower end comes first"));
}

static const struct gm_read_line *find_line(const struct gm_room *room, const char *word, size_t number)
{
    for (size_t i = 0; i < room->said_count; i++) {
        if (strcmp(words[room->said[i].word].word, word) == 0 && number-- == 0) {
            return &room->said[i];
        }
    }
    return NULL;
}

bool gm_room_said(const struct gm_room *room, const char *word, size_t number, struct gm_span *value)
{
    const struct gm_read_line *line = find_line(room, word, number);
    *value = line ? line->value : (struct gm_span){0, 0};
    return line;
}

/* Takes the first word of a span off its front. */
static struct gm_span take_word(const struct gm_room *room, struct gm_span *rest)
{
    struct gm_span word = {rest->begin, rest->begin};
    while (word.end < rest->end && !strchr(" \t\r\n", room->text[word.end])) {
        word.end++;
    }
    *rest = gm_span_trimmed(room->text, (struct gm_span){word.end, rest->end});
    return word;
}

bool gm_room_option(const struct gm_room *room, struct gm_span pieces, const char *word,
                    struct gm_span *value)
{
    while (gm_span_take(room->text, &pieces, ";", value)) {
        if (gm_span_is(room->text, take_word(room, value), word)) {
            return true;
        }
    }
    return false;
}

void gm_room_point(const struct gm_room *room, const struct gm_room_line *line, double point[2])
{
    const double origin[VARIABLES] = {0};
    point[0] = gm_room_value(room, line, GM_ROOM_X, origin, 0);
    point[1] = gm_room_value(room, line, GM_ROOM_Y, origin, 0);
}

const struct gm_room_line *gm_room_line(const struct gm_room *room, enum gm_room_word word)
{
    size_t i = 0;
    while (i < room->count && room->lines[i].word != word) {
        i++;
    }
    return i < room->count ? &room->lines[i] : NULL;
}

/* The start of the next "key =" in a span, or its end; "=" in parentheses belongs to the index of a sum. */
static size_t next_key(const char *text, struct gm_span span)
{
    int depth = 0;
    for (size_t at = span.begin; at < span.end; at++) {
        depth += (text[at] == '(') - (text[at] == ')');
        const size_t length = gm_name_length(text + at, span.end - at);
        size_t behind = at + length;
        while (behind < span.end && (text[behind] == ' ' || text[behind] == '\t')) {
            behind++;
        }
        if (length > 0 && depth <= 0 && behind < span.end && text[behind] == '=') {
            return at;
        }
        at += length > 0 ? length - 1 : 0;
    }
    return span.end;
}

/* "speed =, flow =" of the keys in a set. */
static const char *list_keys(unsigned set, const char *between, char *list, size_t size)
{
    list[0] = '\0';
    for (size_t k = 0, used = 0; k < GM_ROOM_KEYS; k++) {
        if (set >> k & 1) {
            used += (size_t)snprintf(list + used, size - used, "%s%s =", used ? between : "", keys[k]);
        }
    }
    return list;
}

static void read_pairs(struct gm_room *room, struct gm_room_line *line, struct gm_span rest)
{
    const enum gm_room_word word = line->word;
    unsigned given = 0;
    char list[160];
    while (rest.begin < rest.end) {
        const size_t length = gm_name_length(room->text + rest.begin, rest.end - rest.begin);
        int key = GM_ROOM_KEYS - 1;
        while (key >= 0 &&
               (strncmp(room->text + rest.begin, keys[key], length) != 0 || keys[key][length] != '\0')) {
            key--;
        }
        if (length == 0 || key < 0 || !(pairs[word].may >> key & 1)) {
            gm_room_refuse(room, rest.begin, "%s: takes %s%s", words[word].word,
                           list_keys(pairs[word].may, ", ", list, sizeof list),
                           given || pairs[word].names >= START ? ""
                                                               : "; a name with blanks is in double quotes");
        }
        size_t equals = rest.begin + length;
        equals += strspn(room->text + equals, " \t\r\n");
        if (equals >= rest.end || room->text[equals] != '=') {
            gm_room_refuse(room, equals < rest.end ? equals : rest.begin, "%s: needs = and a value",
                           keys[key]);
        }
        equals++;
        const size_t end = next_key(room->text, (struct gm_span){equals, rest.end});
        if (given >> key & 1) {
            gm_room_refuse(room, rest.begin, "%s = is given twice", keys[key]);
        }
        const struct gm_span formula = gm_span_trimmed(room->text, (struct gm_span){equals, end});
        read_formula(room, formula, word, (enum gm_room_key)key, &line->value[key]);
        given |= 1u << key;
        rest.begin = end;
    }
    const unsigned missing = pairs[word].must & ~given;
    if (missing) {
        gm_room_refuse(room, line->place, "%s: needs %s", words[word].word,
                       list_keys(missing & -missing, "", list, sizeof list));
    }
    if (given >> GM_ROOM_TEMPERATURE & given >> GM_ROOM_HEAT & 1) {
        gm_room_refuse(room, line->place, "wall: holds its temperature = or gives heat =, not both");
    }
    if (given & PLACE && (given & PLACE) != PLACE) {
        gm_room_refuse(room, line->place, "%s: has x = and y =, or neither", words[word].word);
    }
    if (pairs[word].some && !(given & pairs[word].some)) {
        gm_room_refuse(room, line->place, "%s: needs %s", words[word].word,
                       list_keys(pairs[word].some, " or ", list, sizeof list));
    }
}

static void read_line(struct gm_room *room, const struct gm_read_line *said)
{
    const enum gm_room_word word = (enum gm_room_word)said->word;
    struct gm_span value = said->value;
    room->lines = gm_arena_resize(room->arena, room->lines, room->count + 1, sizeof *room->lines);
    struct gm_room_line *line = &room->lines[room->count];
    *line = (struct gm_room_line){.word = word, .place = value.begin};
    if (pairs[word].names < START) {
        const bool quoted = value.begin < value.end && room->text[value.begin] == '"';
        struct gm_span name = {value.begin + quoted, value.begin + quoted};
        while (name.end < value.end &&
               (quoted ? room->text[name.end] != '"' : !strchr(" \t\r\n", room->text[name.end]))) {
            name.end++;
        }
        const size_t length = name.end - name.begin;
        if (quoted && name.end == value.end) {
            gm_room_refuse(room, value.begin, "%s: the name has no closing quote", words[word].word);
        }
        if (length == 0 || length >= GM_ROOM_NAME) {
            gm_room_refuse(room, line->place, "%s: needs a name, of at most 63 bytes", words[word].word);
        }
        memcpy(line->name, room->text + name.begin, length);
        value = gm_span_trimmed(room->text, (struct gm_span){name.end + quoted, value.end});
    }
    for (size_t i = 0; i < room->count; i++) {
        if (pairs[room->lines[i].word].names == pairs[word].names &&
            strcmp(room->lines[i].name, line->name) == 0) {
            gm_room_refuse(room, line->place, "%.63s%s",
                           pairs[word].names >= START ? words[word].word : line->name,
                           pairs[word].names >= START ? ": is given twice" : " is named twice");
        }
    }
    room->count++;
    read_pairs(room, line, value);
}

/* rectangle; width F; height F; edges KEY; strips KEY; along y; irregular F; multiple F; keep x, y; ...,
   or flat-torus; ... Returns false if the line names a file. */
static bool read_rectangle(struct gm_room *room, struct gm_span rest)
{
    struct gm_rectangle *rectangle = &room->rectangle;
    const size_t place = rest.begin;
    struct gm_span value, piece;
    double edges = 0, strips = 0, multiple = 0;
    const struct {
        const char *word;
        double *number;
        struct gm_room_range range;
        char *key; /* key of a whole number; NULL: any number */
    } options[] = {{"width", &rectangle->width, {1e-9, 1e9}, NULL},
                   {"height", &rectangle->height, {1e-9, 1e9}, NULL},
                   {"irregular", &rectangle->irregular, {0, 0.45}, NULL},
                   {"edges", &edges, {1, 100000}, room->edges},
                   {"strips", &strips, {0, 100000}, room->strips},
                   {"multiple", &multiple, {1, 100000}, (char[GM_ROOM_NAME]){0}}};
    gm_span_take(room->text, &rest, ";", &value);
    rectangle->torus = gm_span_is(room->text, value, "flat-torus");
    room->rectangular = rectangle->torus || gm_span_is(room->text, value, "rectangle");
    rectangle->fixed = room->fixed;
    while (room->rectangular && gm_span_take(room->text, &rest, ";", &value)) {
        const struct gm_span word = take_word(room, &value);
        size_t i = 0;
        while (i < GM_COUNT(options) && !gm_span_is(room->text, word, options[i].word)) {
            i++;
        }
        if (i < GM_COUNT(options)) {
            const struct gm_room_range range = options[i].range;
            double *number = options[i].number;
            gm_room_need(room, gm_room_number(room, value, number, room->fault));
            if (*number < range.least || *number > range.most ||
                (options[i].key && *number != floor(*number))) {
                gm_room_refuse(room, value.begin, "%s: is a %snumber from %g to %g", options[i].word,
                               options[i].key ? "whole " : "", range.least, range.most);
            }
            if (options[i].key) {
                snprintf(options[i].key, GM_ROOM_NAME, "%.*s", (int)(value.end - value.begin),
                         room->text + value.begin);
            }
        } else if (gm_span_is(room->text, word, "along") && gm_span_is(room->text, value, "y")) {
            rectangle->transposed = true;
        } else if (gm_span_is(room->text, word, "keep") &&
                   rectangle->fixed_count * 2 < GM_COUNT(room->fixed)) {
            double *at = room->fixed + 2 * rectangle->fixed_count++;
            for (int c = 0; c < 2; c++) {
                gm_span_take(room->text, &value, ",", &piece);
                gm_room_need(room, gm_room_number(room, piece, &at[c], room->fault));
            }
            if (value.begin < value.end) {
                gm_room_refuse(room, value.begin, "keep: has two numbers, x, y");
            }
        } else {
            gm_room_refuse(room, word.begin,
                           "a rectangle has width, height, edges, strips, irregular, multiple, along y, and "
                           "up to %zu keep",
                           GM_COUNT(room->fixed) / 2);
        }
    }
    rectangle->edges = (long)edges;
    rectangle->strips = (long)strips;
    room->multiple = (long)multiple;
    if (room->rectangular && !(rectangle->width > 0 && rectangle->height > 0 && edges > 0)) {
        gm_room_refuse(room, place, "a rectangle has a width, a height and a number of edges");
    }
    return room->rectangular;
}

/* Refuses a name with another meaning in formulas, on a command line (except `show`) or in tables. */
static void check_free(const struct gm_room *room, const char *name, size_t place)
{
    bool reserved = strcmp(name, "show") != 0 && gm_reading_reserves(name, strlen(name));
    for (size_t i = 0; i < VARIABLES; i++) {
        reserved |= strcmp(name, variables[i]) == 0;
    }
    for (size_t i = 0; i < GM_ROOM_MEASURES; i++) {
        reserved |= strcmp(name, measures[i]) == 0;
    }
    if (reserved) {
        gm_room_refuse(room, place, "the name %.60s" GM_RESERVED, name);
    }
}

/* NAME = VALUE; low .. high; meaning */
static void read_parameter(struct gm_room *room, struct gm_span rest, const struct gm_room_input *input)
{
    struct gm_span head, piece, after;
    struct gm_room_range range = {NAN, NAN};
    room->parameters =
        gm_arena_resize(room->arena, room->parameters, room->parameter_count + 1, sizeof *room->parameters);
    struct gm_room_parameter *parameter = &room->parameters[room->parameter_count++];
    *parameter = (struct gm_room_parameter){.value = NAN, .place = rest.begin};
    gm_span_take(room->text, &rest, ";", &head);
    const size_t equals = gm_span_until(room->text, head, "=");
    const struct gm_span value = {equals < head.end ? equals + 1 : equals, head.end};
    after = rest;
    if (gm_span_take(room->text, &after, ";", &piece) && gm_span_until(room->text, piece, "..") < piece.end) {
        gm_room_need(room, gm_room_range_of(room, piece, &range, room->fault));
        rest = after;
    }
    parameter->low = range.least;
    parameter->high = range.most;
    parameter->name = gm_room_keep(room, (struct gm_span){head.begin, equals});
    parameter->text = gm_room_keep(room, value);
    parameter->meaning = gm_room_keep(room, rest);
    const size_t letters = strlen(parameter->name);
    if (gm_room_parameter(room, parameter->name) != parameter || letters == 0 || letters >= GM_ROOM_NAME ||
        gm_choice_named(&room->choices, parameter->name) ||
        gm_name_length(parameter->name, letters) != letters) {
        gm_room_refuse(room, head.begin, "parameter: needs a new name, for example height = 1");
    }
    for (size_t i = 0; i < input->count; i++) {
        if (strcmp(input->given[i].name, parameter->name) == 0) {
            parameter->text = gm_arena_print(room->arena, "%s", input->given[i].text);
        }
    }
    read_number(room, parameter->text, &parameter->value);
    check_free(room, parameter->name, head.begin);
}

/* Returns true if the values of two lines begin with the same name. */
static bool share_name(const char *one, const char *other)
{
    const size_t letters = strcspn(one, "; \t\r\n");
    return letters == strcspn(other, "; \t\r\n") && memcmp(one, other, letters) == 0;
}

/* Refuses a line that is named like one before it with the same word. */
static void check_name(const struct gm_room *room, size_t i)
{
    const struct gm_read_line *line = &room->said[i];
    for (size_t k = 0; k < i && words[line->word].identity == GM_LINE_NAMED; k++) {
        if (room->said[k].word == line->word &&
            share_name(room->text + room->said[k].value.begin, room->text + line->value.begin)) {
            gm_room_refuse(room, line->place, "%s: is given twice", words[line->word].word);
        }
    }
}

/* Reads a line with a single value; other lines are read by the room's scene. */
static void read_single(struct gm_room *room, const struct gm_read_line *line)
{
    const struct gm_room_range any = {-DBL_MAX, DBL_MAX}, positive = {DBL_MIN, DBL_MAX},
                               reynolds = {1 / gm_room_viscosity.most, 1 / gm_room_viscosity.least};
    const struct {
        const char *word;
        char **text;
        double *number;
        struct gm_room_range range;
    } rows[] = {
        {"title", &room->title, NULL, any},
        {"about", &room->about, NULL, any},
        {"mesh", &room->mesh, NULL, any},
        {"units", &room->units, NULL, any},
        {"scalar", &room->scalar, NULL, any},
        {"viscosity", NULL, &room->viscosity, gm_room_viscosity},
        {"diffusivity", NULL, &room->diffusivity, positive},
        {"reynolds", NULL, &room->reynolds, reynolds},
        {"schmidt", NULL, &room->schmidt, gm_room_schmidt},
        {"buoyancy", NULL, &room->buoyancy, any},
        {reference, NULL, &room->reference_temperature, any},
        {"dt", NULL, &room->dt, gm_room_dt},
        {"until", NULL, &room->until, gm_room_until},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_span value = line->value, rest = line->value, piece;
        if (strcmp(words[line->word].word, rows[i].word) != 0) {
            continue;
        }
        if (rows[i].text) {
            const bool rectangle = rows[i].text == &room->mesh && read_rectangle(room, value);
            *rows[i].text = rectangle ? NULL : gm_room_keep(room, value);
            return;
        }
        char number[64];
        gm_span_take(room->text, &rest, ";", &value);
        snprintf(number, sizeof number, "%.*s", (int)(value.end - value.begin), room->text + value.begin);
        const double least = rows[i].range.least, most = rows[i].range.most;
        if (!read_number(room, number, rows[i].number) || !isfinite(*rows[i].number) ||
            (least >= 0 && !(*rows[i].number > 0))) {
            gm_room_refuse(room, value.begin, "%s: is a %s number", rows[i].word,
                           least >= 0 ? "positive" : "finite");
        }
        if (rows[i].number == &room->dt && gm_span_take(room->text, &rest, ";", &piece)) {
            gm_room_need(room, gm_room_range_of(room, piece, &room->dt_range, room->fault));
        }
        if (!(*rows[i].number >= least && *rows[i].number <= most)) {
            gm_room_refuse(room, value.begin, "%s: lies between %g and %g", rows[i].word, least, most);
        }
        return;
    }
}

/* The start of the first line with this word; 0: none. */
static size_t place_of(const struct gm_room *room, const char *word)
{
    const struct gm_read_line *line = find_line(room, word, 0);
    return line ? line->place : 0;
}

/* Completes values, and refuses missing ones and those that are given twice. */
static void complete(struct gm_room *room, const struct gm_room_input *input)
{
    const struct {
        const char *name;
        double *number;
    } numbers[] = {
        {"viscosity", &room->viscosity}, {"reynolds", &room->reynolds}, {"schmidt", &room->schmidt}};
    for (size_t i = 0; i < GM_COUNT(numbers); i++) {
        const struct gm_room_parameter *parameter = gm_room_parameter(room, numbers[i].name);
        if (parameter && !isnan(*numbers[i].number)) {
            gm_room_refuse(room, place_of(room, numbers[i].name),
                           "%s: is given twice, here and as a parameter", numbers[i].name);
        }
        if (parameter && !(parameter->value > 0 || (i == 0 && parameter->value == 0))) {
            gm_room_refuse(room, parameter->place, "%s: is a positive number", numbers[i].name);
        }
        *numbers[i].number = parameter ? parameter->value : *numbers[i].number;
    }
    if (!isnan(room->viscosity) && !isnan(room->reynolds)) {
        gm_room_refuse(room, place_of(room, "reynolds"),
                       "viscosity: and reynolds: say the same; a room has one of them");
    }
    if (!isnan(room->diffusivity) && !isnan(room->schmidt)) {
        gm_room_refuse(room, place_of(room, "schmidt"),
                       "diffusivity: and schmidt: say the same; a room has one of them");
    }
    for (size_t k = 0; k < input->count; k++) {
        for (size_t i = 0; i < GM_COUNT(numbers) && !gm_room_parameter(room, input->given[k].name); i++) {
            if (strcmp(input->given[k].name, numbers[i].name) == 0) {
                room->reynolds = i == 0 ? NAN : room->reynolds;
                read_number(room, input->given[k].text, numbers[i].number);
            }
        }
    }
    struct gm_span side;
    if (!room->rectangular && gm_room_said(room, "side", 0, &side)) {
        gm_room_refuse(room, side.begin, "side: is of a rectangle; a mesh of Gmsh has physical groups");
    }
    room->viscosity = isnan(room->reynolds) ? room->viscosity : 1 / room->reynolds;
    if (!(room->mesh || room->rectangular) || isnan(room->viscosity)) {
        gm_room_refuse(room, 0, "a room needs a line %s",
                       room->mesh || room->rectangular ? "viscosity: (or reynolds:)" : "mesh:");
    }
    room->diffusivity = !isnan(room->schmidt)      ? room->viscosity / room->schmidt
                        : isnan(room->diffusivity) ? room->viscosity
                                                   : room->diffusivity;
    const double ratio = room->viscosity / room->diffusivity;
    if (!(ratio >= gm_room_schmidt.least && ratio <= gm_room_schmidt.most) && room->viscosity > 0) {
        gm_room_refuse(room, place_of(room, "diffusivity"),
                       "viscosity / diffusivity is %.4g; it lies between %g and %g", ratio,
                       gm_room_schmidt.least, gm_room_schmidt.most);
    }
    size_t warm = 0, place = 0;
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_formula *value = room->lines[i].value;
        const size_t here = value[GM_ROOM_TEMPERATURE].place + value[GM_ROOM_HEAT].place; /* one is 0 */
        warm += here > 0;
        place = here > 0 ? here : place;
    }
    if (warm > 0 && isnan(room->buoyancy)) {
        gm_room_refuse(
            room, place,
            "a temperature or heat needs a line buoyancy: (g beta; 0 where warm air does not rise)");
    }
    if (warm == 0 && !(isnan(room->buoyancy) && isnan(room->reference_temperature))) {
        const char *word = isnan(room->buoyancy) ? reference : "buoyancy";
        gm_room_refuse(room, place_of(room, word),
                       "%s: needs a temperature = of a wall, an inlet or the start, or heat = of a wall",
                       word);
    }
    room->reference_temperature =
        isnan(room->reference_temperature) && warm > 0 ? 0 : room->reference_temperature;
}

/* Reads the lines that hold for the given words of choices. */
static void read_lines(struct gm_room *room, const struct gm_room_input *input)
{
    struct gm_written_choices *choices = &room->choices;
    struct gm_read_lines lines = {.words = &line_words,
                                  .choices = choices,
                                  .inside = FREE,
                                  .text = room->text,
                                  .span = {0, room->length}};
    gm_room_need(room, gm_choices_read(choices, room->text, room->length, room->fault));
    for (size_t i = 0; i < choices->count; i++) {
        check_free(room, choices->list[i].name, choices->list[i].place);
    }
    for (size_t i = 0; i < input->count; i++) {
        gm_choices_take(choices, input->given[i].name, input->given[i].text);
    }
    gm_room_need(room, gm_lines_read(&lines, room->fault));
    room->said = gm_arena_keep(room->arena, lines.list, free);
    room->said_count = lines.count;
}

static void close_graph(void *graph)
{
    gm_formula_close(graph);
}

void gm_room_read(struct gm_arena *arena, struct gm_room *room, const struct gm_room_input *input,
                  struct gm_fault *fault)
{
    *room = (struct gm_room){.arena = arena,
                             .fault = fault,
                             .text = gm_arena_take(arena, input->length + 1, 1),
                             .length = input->length,
                             .viscosity = NAN,
                             .diffusivity = NAN,
                             .reynolds = NAN,
                             .schmidt = NAN,
                             .buoyancy = NAN,
                             .reference_temperature = NAN,
                             .dt = NAN,
                             .until = NAN,
                             .dt_range = gm_room_dt,
                             .outlet = GM_VERTEX_SOFT,
                             .measures = {NAN, NAN, NAN, NAN}};
    struct gm_span value;
    double holds = 1;
    *fault = (struct gm_fault){0};
    gm_formula_open(&room->graph);
    gm_arena_keep(arena, &room->graph, close_graph);
    memcpy(room->text, input->text, room->length);
    gm_room_need(room, gm_lines_are_text(room->text, room->length, fault));
    read_lines(room, input);
    for (size_t i = 0; gm_room_said(room, words[PARAMETER].word, i, &value); i++) {
        read_parameter(room, value, input);
    }
    for (size_t i = 0; i < room->said_count; i++) {
        check_name(room, i);
        if (room->said[i].word < PAIRS) {
            read_line(room, &room->said[i]);
        } else {
            read_single(room, &room->said[i]);
        }
    }
    gm_room_need(room, !room->graph.failed);
    if (gm_room_said(room, "geomint", 0, &value) && !gm_span_is(room->text, value, "1")) {
        gm_room_refuse(room, value.begin, "this program reads files of format 1, not %.*s",
                       (int)(value.end - value.begin < 40 ? value.end - value.begin : 40),
                       room->text + value.begin);
    }
    if (gm_room_said(room, "exact-while", 0, &value)) {
        gm_room_need(room, gm_room_number(room, value, &holds, fault));
    }
    room->unsolved = !(holds > 0);
    room->scratch = gm_arena_take(arena, room->graph.count + (size_t)1, sizeof *room->scratch);
    complete(room, input);
}

/* A room while it is opened. */
struct opening {
    const struct gm_room_input *input;
    struct gm_fault *fault;
    struct gm_room *room;
};

static void open_room(struct gm_arena *arena, void *data)
{
    struct opening *opening = data;
    opening->room = gm_arena_take(arena, 1, sizeof *opening->room);
    gm_room_read(arena, opening->room, opening->input, opening->fault);
}

struct gm_room *gm_room_open(const struct gm_room_input *input, struct gm_fault *fault)
{
    struct opening opening = {input, fault, NULL};
    struct gm_arena *arena = gm_arena_open();
    *fault = (struct gm_fault){0};
    if (!gm_arena_run(arena, open_room, &opening)) {
        gm_arena_close(arena);
        return NULL;
    }
    return opening.room;
}

void gm_room_close(struct gm_room *room)
{
    if (room) {
        gm_arena_close(room->arena);
    }
}

/* The values along a side; the first place with a value that is not finite is stored. */
struct profile {
    const struct gm_room *room;
    const struct gm_room_line *line;
    struct bad *bad;
    double t, reference; /* reference: the default temperature */
};

struct bad {
    const struct gm_room_line *line; /* NULL: all values are finite */
    enum gm_room_key key;
    double at[2];
};

static double value_at(const struct profile *profile, enum gm_room_key key, double standard, double s,
                       const double at[2])
{
    const double place[VARIABLES] = {s, at[0], at[1], profile->t},
                 value = gm_room_value(profile->room, profile->line, key, place, standard);
    if (!isfinite(value) && !profile->bad->line) {
        *profile->bad = (struct bad){profile->line, key, {at[0], at[1]}};
    }
    return value;
}

static double speed_at(const void *data, double s, const double at[2])
{
    return value_at(data, GM_ROOM_SPEED, 0, s, at);
}

static double varying_at(const void *data, enum gm_given what, double s, const double at[2])
{
    static const enum gm_room_key key[] = {[GM_GIVEN_THETA] = GM_ROOM_SCALAR,
                                           [GM_GIVEN_TEMPERATURE] = GM_ROOM_TEMPERATURE,
                                           [GM_GIVEN_TANGENTIAL] = GM_ROOM_TANGENTIAL,
                                           [GM_GIVEN_HEAT] = GM_ROOM_HEAT};
    const struct profile *profile = data;
    return value_at(profile, key[what], what == GM_GIVEN_TEMPERATURE ? profile->reference : 0, s, at);
}

/* The triangle that a point is in, with its barycentric coordinates; false outside. */
static bool locate(const struct gm_complex *complex, const double at[2], size_t *triangle, double w[3])
{
    for (size_t t = 0; t < complex->triangles; t++) {
        double p[6];
        gm_complex_corners(complex, t, p);
        for (int k = 0; k < 3; k++) {
            const double *b = p + 2 * ((k + 1) % 3), *c = p + 2 * ((k + 2) % 3);
            w[k] =
                ((b[0] - at[0]) * (c[1] - at[1]) - (c[0] - at[0]) * (b[1] - at[1])) / (2 * complex->area[t]);
        }
        if (w[0] >= -1e-12 && w[1] >= -1e-12 && w[2] >= -1e-12) {
            *triangle = t;
            return true;
        }
    }
    return false;
}

/* A quantity at a vertex, which has to be finite. */
static double value_at_vertex(const struct gm_room *room, const struct gm_room_line *line,
                              enum gm_room_key key, const double *point)
{
    const double at[VARIABLES] = {0, point[0], point[1], 0}, value = gm_room_value(room, line, key, at, 0);
    if (!isfinite(value)) {
        gm_room_refuse(room, line->value[key].place, "the %s is not finite at (%.4g, %.4g)", keys[key],
                       point[0], point[1]);
    }
    return value;
}

/* A carried quantity at the start, at vertices that do not hold it. */
static void start_carried(const struct gm_room *room, const struct gm_room_line *line, enum gm_room_key key,
                          const struct gm_complex *complex, const bool *fixed, double *value)
{
    for (size_t v = 0; v < complex->vertices && line->value[key].place > 0; v++) {
        const double here = value_at_vertex(room, line, key, complex->point + 2 * v);
        value[v] = fixed[v] ? value[v] : here;
    }
}

/* A source or a probe, which must lie in the room. */
static void place_thing(const struct gm_room *room, const struct gm_room_line *line, struct gm_flow *flow)
{
    const struct gm_complex *complex = flow->complex;
    double at[2], w[3];
    size_t triangle = 0;
    gm_room_point(room, line, at);
    const double place[VARIABLES] = {0, at[0], at[1], 0},
                 rate = gm_room_value(room, line, GM_ROOM_RATE, place, 0);
    if (!locate(complex, at, &triangle, w)) {
        gm_room_refuse(room, line->place, "%.63s at (%.4g, %.4g) is not in the room", line->name, at[0],
                       at[1]);
    }
    if (!isfinite(rate)) {
        gm_room_refuse(room, line->value[GM_ROOM_RATE].place, "the rate is not finite");
    }
    if (line->word == GM_ROOM_SOURCE) {
        flow->smoking[flow->smoking_count++] = (struct gm_flow_place){{at[0], at[1]}, (int)triangle};
    }
    for (int k = 0; k < 3; k++) {
        flow->source[complex->triangle[3 * triangle + (size_t)k]] += w[k] * rate;
    }
}

/* Sources, probes, and what is carried at the start. */
static void place_things(const struct gm_room *room, struct gm_flow *flow)
{
    const struct gm_complex *complex = flow->complex;
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_line *line = &room->lines[i];
        if (line->word == GM_ROOM_START) {
            start_carried(room, line, GM_ROOM_SCALAR, complex, flow->theta_fixed, flow->theta);
            start_carried(room, line, GM_ROOM_TEMPERATURE, complex, flow->temperature_fixed,
                          flow->temperature);
        } else if (line->word == GM_ROOM_PROBE ||
                   (line->word == GM_ROOM_SOURCE && line->value[GM_ROOM_X].place > 0)) {
            place_thing(room, line, flow);
        }
        /* a source without a place: its rate is that of a unit of area, everywhere */
        for (size_t v = 0;
             line->word == GM_ROOM_SOURCE && line->value[GM_ROOM_X].place == 0 && v < complex->vertices;
             v++) {
            flow->source[v] +=
                complex->star0[v] * value_at_vertex(room, line, GM_ROOM_RATE, complex->point + 2 * v);
        }
    }
}

/* Evaluates the conditions of a line `side:`, as in x = 0, y > 4, at a place. */
static bool holds_at(const struct gm_room *room, struct gm_span rest, const double at[VARIABLES])
{
    const double size = fmax(room->rectangle.width, room->rectangle.height);
    struct gm_span condition;
    bool holds = true;
    while (gm_span_take(room->text, &rest, ",", &condition)) {
        size_t sign = condition.begin;
        while (sign + 1 < condition.end && !strchr("=<>", room->text[sign])) {
            sign++;
        }
        const struct gm_span sides[2] = {{condition.begin, sign}, {sign + 1, condition.end}};
        double value[2];
        if (!strchr("=<>", room->text[sign])) {
            gm_room_refuse(room, condition.begin, "a condition was expected, x = 0");
        }
        for (int k = 0; k < 2; k++) {
            gm_room_need(room, read_value(room, sides[k], 1u << X | 1u << Y, at, &value[k], room->fault));
        }
        const double above = value[0] - value[1];
        holds &= room->text[sign] == '<'   ? above < 0
                 : room->text[sign] == '>' ? above > 0
                                           : fabs(above) <= 1e-9 * size;
    }
    return holds;
}

/* Returns true if a name means the edges that no line before names: unless a mesh that the room itself
   names has such a group. */
static bool is_rest(const struct gm_room *room, const struct gm_triangulation *mesh, const char *name)
{
    return strcmp(name, "all") == 0 && (room->rectangular || gm_triangulation_group(mesh, name) == 0);
}

/* The conditions of the line `side:` of that name; false if it is missing. */
static bool find_side(const struct gm_room *room, const char *side, struct gm_span *conditions)
{
    struct gm_span name;
    for (size_t i = 0; gm_room_said(room, "side", i, conditions); i++) {
        if (gm_span_take(room->text, conditions, ";", &name) && gm_span_is(room->text, name, side)) {
            return true;
        }
    }
    return false;
}

/* The groups of a line, which the parameter of its name lists. */
static const char *groups_of(const struct gm_room *room, const struct gm_room_line *line)
{
    const struct gm_room_parameter *other = gm_room_parameter(room, line->name);
    return other ? other->text : line->name;
}

/* A boundary edge becomes one of line number `i`, from 0, unless it belongs to another line. */
static void take_edge(const struct gm_room *room, unsigned char *side, size_t i)
{
    const struct gm_room_line *line = &room->lines[i];
    if (*side != 0 && *side != i + 1) {
        gm_room_refuse(room, line->place, "curves of the group %.63s have a line already: %.63s",
                       groups_of(room, line), groups_of(room, &room->lines[*side - 1]));
    }
    *side = (unsigned char)(i + 1);
}

/* The edges of a line's groups, of which each is on the boundary, and listed once. */
static void name_groups(const struct gm_room *room, const struct gm_triangulation *mesh, size_t i,
                        unsigned char *side_of)
{
    const struct gm_room_line *line = &room->lines[i];
    const char *list = groups_of(room, line);
    char name[256], names[160];
    for (const char *at = list; *at; at += strlen(name), at += *at == ',') {
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at, list == line->name ? "" : ","), at);
        const long tag = gm_triangulation_group(mesh, name);
        bool met = false;
        for (size_t b = 0; tag != 0 && b < mesh->complex->boundary; b++) {
            if (gm_triangulation_has(mesh, (size_t)mesh->complex->boundary_edge[b], tag)) {
                met = true;
                take_edge(room, &side_of[b], i);
            }
        }
        if (!met) {
            gm_room_refuse(room, line->place,
                           tag != 0
                               ? "no edge of the mesh's boundary belongs to \"%.60s\""
                               : "the mesh has no physical group \"%.60s\" on its boundary (there are: %s)",
                           name, gm_triangulation_group_names(mesh, names, sizeof names));
        }
        for (const char *before = list; before < at; before += strcspn(before, ",") + 1) {
            if (strncmp(before, name, strlen(name)) == 0 && before[strlen(name)] == ',') {
                gm_room_refuse(room, line->place, "the group \"%.60s\" is named twice", name);
            }
        }
    }
}

/* The side of each boundary edge: 0 a wall without a name, else 1 + the line's number. */
static void name_sides(const struct gm_room *room, const struct gm_triangulation *mesh,
                       unsigned char *side_of)
{
    const struct gm_complex *complex = mesh->complex;
    for (size_t i = 0; i < room->count && complex->boundary > 0; i++) {
        const struct gm_room_line *line = &room->lines[i];
        const bool all = is_rest(room, mesh, line->name);
        struct gm_span conditions;
        if (line->word > GM_ROOM_BOUNDARY) {
            continue;
        }
        if (!all && (!room->rectangular || room->from_file)) {
            name_groups(room, mesh, i, side_of);
            continue;
        }
        const bool conditional = !all && find_side(room, line->name, &conditions);
        bool met = all;
        for (size_t b = 0; b < complex->boundary && (all || conditional); b++) {
            double middle[VARIABLES] = {0};
            gm_complex_middle(complex, (size_t)complex->boundary_edge[b], middle + X);
            if (all ? side_of[b] == 0 : holds_at(room, conditions, middle)) {
                take_edge(room, &side_of[b], i);
                met = true;
            }
        }
        if (!met) {
            gm_room_refuse(room, line->place,
                           "no edge of the rectangle is called %.63s: it needs a line side: %.63s; x = 0",
                           line->name, line->name);
        }
    }
}

/* The speed of a free fall over the room's size with the largest difference of temperature that there is:
   the Reynolds number of that is the root of Grashof's. */
static double fall(const struct gm_flow *flow)
{
    const double *range = flow->temperature_range;
    return sqrt(fabs(flow->buoyancy) * (range[1] - range[0]) * sqrt(flow->complex->total_area));
}

/* A side from the room's lines at a time. */
static struct gm_side side_from(const struct profile *profile)
{
    const struct gm_room_line *line = profile->line;
    if (!line || line->word > GM_ROOM_BOUNDARY) {
        return (struct gm_side){.flow = NAN, .theta_free = true, .temperature_free = true};
    }
    const double at[VARIABLES] = {[TIME] = profile->t};
    const bool inlet = line->word == GM_ROOM_INLET;
    const double slip = gm_room_value(profile->room, line, GM_ROOM_SLIP, at, 0);
    if (slip != 0 && slip != 1) {
        gm_room_refuse(profile->room, line->value[GM_ROOM_SLIP].place,
                       "slip is 1, or 0 where the wall holds the air");
    }
    const struct gm_side side = {.kind = inlet                                        ? GM_EDGE_INLET
                                         : line->word == GM_ROOM_OUTLET               ? GM_EDGE_OUTLET
                                         : line->value[GM_ROOM_TANGENTIAL].place != 0 ? GM_EDGE_LID
                                         : slip == 1                                  ? GM_EDGE_SLIP
                                                                                      : GM_EDGE_WALL,
                                 .flow = gm_room_value(profile->room, line, GM_ROOM_FLOW, at, NAN),
                                 .speed = gm_room_value(profile->room, line, GM_ROOM_CENTRE, at, 0),
                                 .theta_free = !inlet && line->value[GM_ROOM_SCALAR].place == 0,
                                 .temperature_free = !inlet && line->value[GM_ROOM_TEMPERATURE].place == 0,
                                 .heats = line->value[GM_ROOM_HEAT].place != 0,
                                 .profile = line->value[GM_ROOM_SPEED].place != 0 ? speed_at : NULL,
                                 .varying = varying_at,
                                 .data = profile};
    if (line->value[GM_ROOM_FLOW].place != 0 && !(side.flow >= 0 && isfinite(side.flow))) {
        gm_room_refuse(profile->room, line->value[GM_ROOM_FLOW].place,
                       "a flow is a number that is not negative");
    }
    return side;
}

/* Refuses a boundary: flows that do not balance at the last of the outlets, whose flow is one too many. */
_Noreturn static void refuse_boundary(const struct gm_room *room, const struct gm_flow *flow,
                                      enum gm_boundary_fault fault)
{
    static const char *const sentences[] = {
        [GM_BOUNDARY_NO_INLET] = "the mesh has an outlet but no inlet",
        [GM_BOUNDARY_NO_OUTLET] = "the mesh has an inlet but no outlet",
        [GM_BOUNDARY_SHORT] =
            "a piece of an inlet or an outlet is a single edge; it needs two at least (refine=2 halves edges)",
        [GM_BOUNDARY_WHOLE] = "the whole boundary is inlet or outlet",
        [GM_BOUNDARY_IN_HOLE] =
            "an inlet or an outlet is on the wall of a hole; they must be in the outer wall",
        [GM_BOUNDARY_PROFILE] = "no more enters by the profile of an inlet than leaves by it",
        [GM_BOUNDARY_BACKWARDS] = "the outlets with a given flow take more than enters",
        [GM_BOUNDARY_OVERFLOW] = "what enters or leaves is too much for a number",
    };
    if (fault != GM_BOUNDARY_UNBALANCED) {
        gm_room_refuse(room, flow->faulty > 0 ? room->lines[flow->faulty - 1].place : GM_ROOM_NOWHERE, "%s",
                       sentences[fault]);
    }
    double in = 0, out = 0;
    size_t place = 0;
    for (size_t i = 0; i < room->count; i++) {
        place = room->lines[i].word == GM_ROOM_OUTLET ? room->lines[i].value[GM_ROOM_FLOW].place : place;
    }
    for (size_t i = 0; i < flow->openings; i++) {
        *(flow->opening[i].inlet ? &in : &out) += flow->opening[i].flow;
    }
    gm_room_refuse(room, place, "all flows are given, and what enters does not leave: %.6g in, %.6g out", in,
                   out);
}

/* A side that gives the stream function and the speed along it: both cells at an edge turn with that. */
static void give_motion(const struct profile *profiles, const unsigned char *side_of, struct gm_flow *flow)
{
    const struct gm_complex *complex = flow->complex;
    for (size_t b = 0; b < complex->boundary; b++) {
        const struct profile *profile = &profiles[side_of[b]];
        if (!profile->line || profile->line->word != GM_ROOM_BOUNDARY) {
            continue;
        }
        const int end[2] = {complex->boundary_vertex[b],
                            complex->boundary_vertex[gm_complex_next(complex, b)]};
        const double *p = complex->point + 2 * end[0], *q = complex->point + 2 * end[1];
        double middle[2];
        gm_complex_middle(complex, (size_t)complex->boundary_edge[b], middle);
        const double along = value_at(profile, GM_ROOM_SPEED_X, 0, 0, middle) * (q[0] - p[0]) +
                             value_at(profile, GM_ROOM_SPEED_Y, 0, 0, middle) * (q[1] - p[1]);
        for (int k = 0; k < 2; k++) {
            const double *at = k == 0 ? p : q;
            flow->sheet[end[k]] += along / 2;
            flow->psi[end[k]] = value_at(profile, GM_ROOM_STREAM_FUNCTION, 0, 0, at);
            flow->speed = fmax(flow->speed, hypot(value_at(profile, GM_ROOM_SPEED_X, 0, 0, at),
                                                  value_at(profile, GM_ROOM_SPEED_Y, 0, 0, at)));
        }
    }
}

/* Sets the flow's boundary from the room's lines at the time t. */
static void set_sides(const struct gm_room *room, const unsigned char *side_of, double t,
                      struct gm_flow *flow)
{
    struct bad bad = {0};
    struct gm_side sides[GM_ROOM_SIDES];
    struct profile profiles[GM_ROOM_SIDES];
    for (size_t i = 0; i <= room->count; i++) {
        profiles[i] =
            (struct profile){room, i > 0 ? &room->lines[i - 1] : NULL, &bad, t, flow->reference_temperature};
        sides[i] = side_from(&profiles[i]);
    }
    const enum gm_boundary_fault fault = gm_flow_set_sides(flow, side_of, sides, room->outlet);
    give_motion(profiles, side_of, flow);
    if (bad.line) {
        gm_room_refuse(room, bad.line->value[bad.key].place,
                       bad.key == GM_ROOM_TANGENTIAL ? "the %s speed is not finite at (%.4g, %.4g)"
                                                     : "the %s is not finite at (%.4g, %.4g)",
                       keys[bad.key], bad.at[0], bad.at[1]);
    }
    if (fault != GM_BOUNDARY_OK) {
        refuse_boundary(room, flow, fault);
    }
}

/* A boundary at a time. */
struct moment {
    const struct gm_flow *flow;
    double t;
    struct gm_flow *now;
};

static void set_moment(struct gm_arena *arena, void *data)
{
    (void)arena;
    const struct moment *moment = data;
    set_sides(moment->flow->given_by, moment->flow->side_of, moment->t, moment->now);
}

/* Sets the boundary of a moment; false with a fault. */
static bool give_with(struct moment moment, struct gm_fault *fault)
{
    struct gm_room *room = (struct gm_room *)(uintptr_t)moment.flow->given_by;
    struct gm_fault *const before = room->fault;
    room->fault = fault;
    const bool good = gm_arena_run(room->arena, set_moment, &moment);
    room->fault = before;
    return good;
}

static bool give(const struct gm_flow *flow, double t, struct gm_flow *now)
{
    struct gm_fault fault;
    return give_with((struct moment){flow, t, now}, &fault);
}

void gm_room_fault(const struct gm_room *room, const struct gm_flow *flow, double t, struct gm_fault *fault)
{
    *fault = (struct gm_fault){0};
    struct gm_flow *now = room->timed ? gm_flow_open_now(flow) : NULL;
    if (now) {
        give_with((struct moment){flow, t, now}, fault);
    }
    gm_flow_close(now);
}

/* Extends a flow's ranges by the values of one moment. */
static void widen(struct gm_flow *flow, const struct gm_flow *now)
{
    double low = flow->reference_temperature, high = low, least = 0, most = 0;
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        flow->theta_high = fmax(flow->theta_high, now->theta[v]);
        if (flow->heat) {
            low = fmin(low, now->temperature[v]);
            high = fmax(high, now->temperature[v]);
            least = fmin(least, now->heating[v]);
            most = fmax(most, now->heating[v]);
        }
    }
    const double heated = gm_flow_heated(now);
    flow->temperature_range[0] = fmin(flow->temperature_range[0], low - (least < 0 ? heated : 0));
    flow->temperature_range[1] = fmax(flow->temperature_range[1], high + (most > 0 ? heated : 0));
}

static void close_flow(void *flow)
{
    gm_flow_close(flow);
}

/* A boundary that changes: pictures and the time unit go by the largest speeds and values up to the end,
   sampled at some moments. */
static void look_ahead(const struct gm_room *room, struct gm_flow *flow)
{
    enum { MOMENTS = 64 };
    const double until = isnan(room->until) ? 10 : room->until;
    struct gm_flow *now = gm_arena_keep(room->arena, gm_flow_open_now(flow), close_flow);
    flow->give = give;
    for (int k = 1; k <= MOMENTS; k++) {
        if (give(flow, until * k / MOMENTS, now)) { /* else the run reports it at that time */
            flow->speed = fmax(flow->speed, now->speed);
            widen(flow, now);
        }
    }
    gm_arena_drop(room->arena, now);
}

/* A flow while it is made on its mesh. */
struct making {
    struct gm_room *room;
    struct gm_triangulation *mesh;
    struct gm_flow *flow;
};

static void make_flow(struct gm_arena *arena, void *data)
{
    struct making *making = data;
    struct gm_room *room = making->room;
    struct gm_flow *flow = making->flow =
        gm_arena_keep(arena, gm_flow_open(making->mesh->complex), close_flow);
    const struct gm_complex *complex = flow->complex;
    flow->given_by = room;
    flow->side_of = gm_arena_take(arena, complex->boundary + 1, 1);
    flow->source = gm_arena_take(arena, complex->vertices, sizeof *flow->source);
    flow->smoking = gm_arena_take(arena, room->count + 1, sizeof *flow->smoking);
    if (!isnan(room->buoyancy)) {
        gm_flow_carry_heat(flow, room->buoyancy, room->reference_temperature);
    }
    if (room->count >= GM_ROOM_SIDES) {
        gm_room_refuse(room, 0, "a room has at most %d lines with names", GM_ROOM_SIDES - 1);
    }
    name_sides(room, making->mesh, flow->side_of);
    set_sides(room, flow->side_of, 0, flow);
    place_things(room, flow);
    const struct gm_room_parameter *reynolds = gm_room_parameter(room, "reynolds");
    const double scale = reynolds && flow->inlet_length > 0 ? flow->inlet_length : 1;
    flow->viscosity = room->viscosity * scale;
    flow->diffusivity = room->diffusivity * scale;
    flow->temperature_range[0] = flow->temperature_range[1] = flow->reference_temperature;
    widen(flow, flow);
    if (room->timed) {
        look_ahead(room, flow);
    }
    room->measures[GM_ROOM_PERIMETER] = 0;
    for (size_t b = 0; b < complex->boundary; b++) {
        room->measures[GM_ROOM_PERIMETER] += complex->length[complex->boundary_edge[b]];
    }
    room->measures[GM_ROOM_AREA] = complex->total_area;
    room->measures[GM_ROOM_INLET_LENGTH] = flow->inlet_length;
    if (reynolds) {
        flow->reynolds = reynolds->value;
    } else if (room->viscosity > 0) {
        flow->reynolds =
            flow->speed * fmax(flow->inlet_length, sqrt(complex->total_area) / 10) / room->viscosity;
        flow->reynolds = fmax(flow->reynolds, fall(flow) * sqrt(complex->total_area) / room->viscosity);
    }
    flow->scalar = !room->scalar || strcmp(room->scalar, "none") != 0;
}

struct gm_flow *gm_room_flow(struct gm_room *room, struct gm_triangulation *mesh, struct gm_fault *fault)
{
    struct making making = {.room = room, .mesh = mesh};
    *fault = (struct gm_fault){0};
    room->fault = fault;
    const bool good = gm_arena_run(room->arena, make_flow, &making);
    mesh->complex = NULL;
    return good ? making.flow : NULL;
}

const char *gm_room_hole(const struct gm_triangulation *mesh, const struct gm_complex *complex, size_t hole,
                         char *name, size_t size)
{
    size_t met = 0;
    snprintf(name, size, "hole%zu", hole);
    for (size_t loop = 0; loop < complex->loops; loop++) {
        met += gm_complex_loop_area(complex, loop) < 0;
        if (met != hole) {
            continue;
        }
        const int group =
            gm_triangulation_first(mesh, (size_t)complex->boundary_edge[complex->loop_start[loop]]);
        for (size_t i = 0; i < mesh->groups; i++) {
            if (group != 0 && mesh->group[i].tag == group && mesh->group[i].name[0]) {
                snprintf(name, size, "%s", mesh->group[i].name);
            }
        }
        break;
    }
    return name;
}
