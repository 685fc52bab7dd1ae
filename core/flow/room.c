/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms of files: lines to sides of a mesh's boundary, sources, a start and probes. */
#include "core/flow/room.h"
#include "core/basics.h"
#include "core/expression/nearest.h"

#include <float.h>
#include <math.h>
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

/* The lines that hold pairs key = formula: the keys they may have, those that they must, and those of which they need
   one; and of what they are the only one of their name. */
static const struct {
    const char *word;
    unsigned may, must, some;
    enum { SIDE, THING, START, EXACT } names; /* the last two have none */
} words[] = {
    [GM_ROOM_INLET] = {"inlet", ENTERING | CARRIED, 0, ENTERING, SIDE},
    [GM_ROOM_OUTLET] = {"outlet", 1u << GM_ROOM_FLOW, 0, 0, SIDE},
    [GM_ROOM_WALL] = {"wall", CARRIED | 1u << GM_ROOM_TANGENTIAL | 1u << GM_ROOM_HEAT | 1u << GM_ROOM_SLIP, 0,
                      0, SIDE},
    [GM_ROOM_BOUNDARY] = {"boundary", MOTION | CARRIED, 1u << GM_ROOM_STREAM_FUNCTION, 0, SIDE},
    [GM_ROOM_SOURCE] = {"source", 1u << GM_ROOM_RATE | PLACE, 1u << GM_ROOM_RATE, 0, THING},
    [GM_ROOM_PROBE] = {"probe", PLACE, PLACE, 0, THING},
    [GM_ROOM_START] = {"start", CARRIED | 1u << GM_ROOM_VORTICITY, 0, CARRIED | 1u << GM_ROOM_VORTICITY,
                       START},
    [GM_ROOM_EXACT] = {"exact", MOTION | 1u << GM_ROOM_SCALAR | 1u << GM_ROOM_TOTAL_PRESSURE, 0,
                       1u << GM_ROOM_STREAM_FUNCTION, EXACT},
};
enum { WORDS = GM_COUNT(words) };

/* A flow is that of a whole side, a place is one; s runs along inlets, and what the boundary gives, and the exact
   solution, may change in time. */
static unsigned may_hold(enum gm_room_word word, enum gm_room_key key)
{
    const bool varies = key != GM_ROOM_FLOW && key != GM_ROOM_CENTRE && key != GM_ROOM_SLIP &&
                        key != GM_ROOM_X && key != GM_ROOM_Y,
               changes = (word <= GM_ROOM_BOUNDARY || word == GM_ROOM_EXACT) && key != GM_ROOM_SLIP;
    return (varies ? 1u << GM_ROOM_AT_X | 1u << GM_ROOM_AT_Y : 0) |
           (varies && word == GM_ROOM_INLET ? 1u << GM_ROOM_AT_S : 0) | (changes ? 1u << GM_ROOM_AT_T : 0);
}

static bool read_formula(struct gm_room *room, struct gm_span span, enum gm_room_word word,
                         enum gm_room_key key, struct gm_room_formula *value, struct gm_fault *fault)
{
    gm_node_id node = 0;
    bool timed;
    if (!gm_room_read_formula(&room->names, span, may_hold(word, key), &room->graph, &node, &timed, fault)) {
        return false;
    }
    room->timed = room->timed || (timed && word <= GM_ROOM_BOUNDARY);
    value->place = span.begin;
    value->part = gm_formula_parts(&room->graph, node, &value->parts);
    return value->part != NULL;
}

double gm_room_value(const struct gm_room *room, const struct gm_room_line *line, enum gm_room_key key,
                     const double at[GM_ROOM_AT], double standard)
{
    const struct gm_room_formula *value = line ? &line->value[key] : NULL;
    if (!value || value->place == 0) {
        return standard;
    }
    gm_formula_evaluate_parts(&room->graph, value->part, value->parts, at, room->scratch);
    return room->scratch[value->part[value->parts - 1]];
}

void gm_room_point(const struct gm_room *room, const struct gm_room_line *line, double point[2])
{
    const double origin[GM_ROOM_AT] = {0};
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

/* Where the next "key =" begins in a span, or its end; in parentheses stands the index of a sum. */
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

static bool read_pairs(struct gm_room *room, struct gm_room_line *line, struct gm_span rest,
                       struct gm_fault *fault)
{
    const enum gm_room_word word = line->word;
    unsigned given = 0;
    char list[160];
    while (rest.begin < rest.end) {
        const size_t length = gm_name_length(room->names.text + rest.begin, rest.end - rest.begin);
        int key = GM_ROOM_KEYS - 1;
        while (key >= 0 && (strncmp(room->names.text + rest.begin, keys[key], length) != 0 ||
                            keys[key][length] != '\0')) {
            key--;
        }
        if (length == 0 || key < 0 || !(words[word].may >> key & 1)) {
            return gm_fail(fault, rest.begin, "%s: takes %s%s", words[word].word,
                           list_keys(words[word].may, ", ", list, sizeof list),
                           given || words[word].names >= START ? ""
                                                               : "; a name with blanks is in double quotes");
        }
        size_t equals = rest.begin + length;
        equals += strspn(room->names.text + equals, " \t\r\n");
        if (equals >= rest.end || room->names.text[equals] != '=') {
            return gm_fail(fault, equals < rest.end ? equals : rest.begin, "%s: needs = and a value",
                           keys[key]);
        }
        equals++;
        const size_t end = next_key(room->names.text, (struct gm_span){equals, rest.end});
        if (given >> key & 1) {
            return gm_fail(fault, rest.begin, "%s = is given twice", keys[key]);
        }
        const struct gm_span formula = gm_span_trimmed(room->names.text, (struct gm_span){equals, end});
        if (!read_formula(room, formula, word, (enum gm_room_key)key, &line->value[key], fault)) {
            return false;
        }
        given |= 1u << key;
        rest.begin = end;
    }
    const unsigned missing = words[word].must & ~given;
    if (missing) {
        return gm_fail(fault, line->place, "%s: needs %s", words[word].word,
                       list_keys(missing & -missing, "", list, sizeof list));
    }
    if (given >> GM_ROOM_TEMPERATURE & given >> GM_ROOM_HEAT & 1) {
        return gm_fail(fault, line->place, "wall: holds its temperature = or gives heat =, not both");
    }
    if (given & PLACE && (given & PLACE) != PLACE) {
        return gm_fail(fault, line->place, "%s: has x = and y =, or neither", words[word].word);
    }
    return !words[word].some || given & words[word].some ||
           gm_fail(fault, line->place, "%s: needs %s", words[word].word,
                   list_keys(words[word].some, " or ", list, sizeof list));
}

static bool read_line(struct gm_room *room, enum gm_room_word word, struct gm_text_line text_line,
                      struct gm_fault *fault)
{
    struct gm_span value = text_line.value;
    struct gm_room_line *more = realloc(room->lines, (room->count + 1) * sizeof *more);
    if (!more) {
        return false;
    }
    room->lines = more;
    struct gm_room_line *line = &more[room->count];
    *line = (struct gm_room_line){.word = word,
                                  .place = value.begin < value.end ? value.begin : text_line.word.begin};
    if (words[word].names < START) {
        const bool quoted = value.begin < value.end && room->names.text[value.begin] == '"';
        struct gm_span name = {value.begin + quoted, value.begin + quoted};
        while (name.end < value.end && (quoted ? room->names.text[name.end] != '"'
                                               : !strchr(" \t\r\n", room->names.text[name.end]))) {
            name.end++;
        }
        const size_t length = name.end - name.begin;
        if (quoted && name.end == value.end) {
            return gm_fail(fault, line->place, "%s: the name has no closing quote", words[word].word);
        }
        if (length == 0 || length >= GM_ROOM_NAME) {
            return gm_fail(fault, line->place, "%s: needs a name, of at most 63 bytes", words[word].word);
        }
        memcpy(line->name, room->names.text + name.begin, length);
        value = gm_span_trimmed(room->names.text, (struct gm_span){name.end + quoted, value.end});
    }
    for (size_t i = 0; i < room->count; i++) {
        if (words[more[i].word].names == words[word].names && strcmp(more[i].name, line->name) == 0) {
            return words[word].names >= START
                       ? gm_fail(fault, line->place, "%s: is given twice", words[word].word)
                       : gm_fail(fault, line->place, "%.63s is named twice", line->name);
        }
    }
    room->count++;
    return read_pairs(room, line, value, fault);
}

/* Lines that hold for other words of a choice become comments. */
static bool choose_lines(struct gm_room *room, struct gm_fault *fault)
{
    char *text = room->names.text;
    struct gm_text_line line;
    bool holds = true, always = true;
    for (size_t at = 0; gm_lines_next(text, room->length, &at, &line, fault);) {
        const enum gm_statement_word said = gm_statement_word_of(&room->names, line);
        if (said == GM_LINE_WHEN) {
            struct gm_span rest = line.value, word;
            char name[GM_ROOM_NAME];
            gm_span_take(text, &rest, "=", &word);
            snprintf(name, sizeof name, "%.*s", (int)(word.end - word.begin), text + word.begin);
            const struct gm_room_parameter *choice = gm_room_parameter(&room->names, name);
            holds = always = strcmp(name, "always") == 0;
            if (!always && !(choice && choice->words[0])) {
                return gm_fail(fault, line.value.begin, "when: needs a choice and its word: domain = box");
            }
            while (gm_span_take(text, &rest, ",", &word)) {
                if (always || !gm_room_is_listed(&room->names, choice->words, word)) {
                    return gm_fail(fault, word.begin, "%s has no such word", name);
                }
                holds = holds || gm_room_is_word(&room->names, word, choice->text);
            }
        } else if (!always && gm_statement_is_fixed(said)) {
            return gm_fail(
                fault, line.word.begin,
                "%s: says the same for every word of a choice; put it before when:", gm_statement_name(said));
        }
        for (size_t i = line.word.begin; (said == GM_LINE_WHEN || !holds) && i < line.value.end; i++) {
            text[i] = (char)(text[i] == '\n' || text[i] == '\r' ? text[i] : '#');
        }
    }
    return !fault->sentence[0];
}

/* rectangle; width F; height F; ... */
static void make_rectangle(struct gm_room *room)
{
    const struct gm_statement *mesh = gm_statement(&room->said, GM_LINE_RECTANGLE, 0);
    struct gm_rectangle *rectangle = &room->rectangle;
    room->rectangular = mesh != NULL;
    room->multiple = (long)gm_statement_number(mesh, GM_LINE_RECTANGLE_MULTIPLE, 0);
    *rectangle = (struct gm_rectangle){
        .width = gm_statement_number(mesh, GM_LINE_RECTANGLE_WIDTH, 0),
        .height = gm_statement_number(mesh, GM_LINE_RECTANGLE_HEIGHT, 0),
        .edges = (long)gm_statement_number(mesh, GM_LINE_RECTANGLE_EDGES, 0),
        .strips = (long)gm_statement_number(mesh, GM_LINE_RECTANGLE_STRIPS, 0),
        .transposed = gm_statement_piece(mesh, GM_LINE_RECTANGLE_ALONG) != NULL,
        .torus = mesh && strcmp(mesh->pieces[0].text, "flat-torus") == 0,
        .irregular = gm_statement_number(mesh, GM_LINE_RECTANGLE_IRREGULAR, 0),
        .fixed = room->fixed,
    };
    for (size_t i = 0; mesh && i < mesh->count; i++) {
        if (mesh->pieces[i].row == GM_LINE_RECTANGLE_KEEP) {
            memcpy(room->fixed + 2 * rectangle->fixed_count++, mesh->pieces[i].numbers,
                   2 * sizeof *room->fixed);
        }
    }
}

/* The parameter that stands for a line. */
static const struct gm_room_parameter *parameter_of(const struct gm_room *room, enum gm_statement_word word)
{
    return word == GM_LINE_DIFFUSIVITY ? NULL : gm_room_parameter(&room->names, gm_statement_name(word));
}

/* Where a number is said, by a line or a parameter of that name; false: it is not. */
static bool find_number(const struct gm_room *room, enum gm_statement_word word, size_t *place)
{
    const struct gm_statement *line = gm_statement(&room->said, word, 0);
    const struct gm_room_parameter *parameter = parameter_of(room, word);
    *place = line ? line->place : parameter ? parameter->place : 0;
    return line || parameter;
}

/* That number, or the one that is given in its place; NAN: it is not said. */
static bool take_number(const struct gm_room *room, enum gm_statement_word word,
                        const struct gm_room_given *given, size_t count, double *number,
                        struct gm_fault *fault)
{
    const char *name = gm_statement_name(word);
    const struct gm_statement *line = gm_statement(&room->said, word, 0);
    const struct gm_room_parameter *parameter = parameter_of(room, word);
    const struct gm_room_range range = gm_statement_range(word);
    *number = parameter ? parameter->value : gm_statement_value(&room->said, word, NAN);
    if (parameter && line) {
        return gm_fail(fault, line->place, "%s: is given twice, here and as a parameter", name);
    }
    if (parameter && !(*number >= range.least && *number <= range.most) &&
        !(*number == 0 && word == GM_LINE_VISCOSITY)) {
        return gm_fail(fault, parameter->place, "%s: lies between %g and %g", name, range.least, range.most);
    }
    for (size_t k = 0; k < count && !parameter; k++) {
        *number = strcmp(given[k].name, name) == 0 ? given[k].value : *number;
    }
    return true;
}

/* What is said in one of two ways, and whether all is said. */
static bool complete(struct gm_room *room, const struct gm_room_given *given, size_t count,
                     struct gm_fault *fault)
{
    static const enum gm_statement_word alike[][2] = {{GM_LINE_VISCOSITY, GM_LINE_REYNOLDS},
                                                      {GM_LINE_DIFFUSIVITY, GM_LINE_SCHMIDT}};
    double numbers[2][2];
    size_t place = 0;
    for (size_t i = 0; i < GM_COUNT(alike); i++) {
        for (size_t k = 0; k < 2; k++) {
            if (!take_number(room, alike[i][k], given, count, &numbers[i][k], fault)) {
                return false;
            }
        }
        if (find_number(room, alike[i][0], &place) && find_number(room, alike[i][1], &place)) {
            return gm_fail(fault, place, "%s: and %s: say the same; a room has one of them",
                           gm_statement_name(alike[i][0]), gm_statement_name(alike[i][1]));
        }
    }
    const struct gm_statement *side = gm_statement(&room->said, GM_LINE_SIDE, 0);
    const bool meshed = room->rectangular || gm_statement(&room->said, GM_LINE_MESH, 0);
    room->unsolved = !(gm_statement_value(&room->said, GM_LINE_EXACT_WHILE, 1) > 0);
    room->viscosity = isnan(numbers[0][0]) ? 1 / numbers[0][1] : numbers[0][0];
    if (!meshed || isnan(room->viscosity)) {
        return gm_fail(fault, 0, "a room needs a line %s", meshed ? "viscosity: (or reynolds:)" : "mesh:");
    }
    if (side && !room->rectangular) {
        return gm_fail(fault, side->place, "side: is of a rectangle; a mesh of Gmsh has physical groups");
    }
    room->diffusivity = !isnan(numbers[1][1])  ? room->viscosity / numbers[1][1]
                        : isnan(numbers[1][0]) ? room->viscosity
                                               : numbers[1][0];
    const struct gm_room_range schmidt = gm_statement_range(GM_LINE_SCHMIDT);
    const double ratio = room->viscosity / room->diffusivity;
    if (!(ratio >= schmidt.least && ratio <= schmidt.most) && room->viscosity > 0) {
        find_number(room, GM_LINE_DIFFUSIVITY, &place);
        return gm_fail(fault, place, "viscosity / diffusivity is %.4g; it lies between %g and %g", ratio,
                       schmidt.least, schmidt.most);
    }
    const struct gm_statement *buoyancy = gm_statement(&room->said, GM_LINE_BUOYANCY, 0),
                              *reference = gm_statement(&room->said, GM_LINE_REFERENCE_TEMPERATURE, 0);
    size_t warm = 0;
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_formula *value = room->lines[i].value;
        const size_t here = value[GM_ROOM_TEMPERATURE].place + value[GM_ROOM_HEAT].place; /* one is 0 */
        warm = here > 0 ? here : warm;
    }
    if (warm > 0 && !buoyancy) {
        return gm_fail(
            fault, warm,
            "a temperature or heat needs a line buoyancy: (g beta; 0 where warm air does not rise)");
    }
    if (warm == 0 && (buoyancy || reference)) {
        return gm_fail(fault, (buoyancy ? buoyancy : reference)->place,
                       "%s: needs a temperature = of a wall, an inlet or the start, or heat = of a wall",
                       gm_statement_name((buoyancy ? buoyancy : reference)->word));
    }
    room->buoyancy = gm_statement_value(&room->said, GM_LINE_BUOYANCY, NAN);
    room->reference_temperature =
        gm_statement_value(&room->said, GM_LINE_REFERENCE_TEMPERATURE, warm > 0 ? 0 : NAN);
    return true;
}

static const char *line_word(size_t i, const void *data)
{
    (void)data;
    return i < WORDS ? words[i].word : gm_statement_name(i - WORDS);
}

/* A line that declares no parameter. */
static bool read_any(struct gm_room *room, struct gm_text_line line, struct gm_fault *fault)
{
    const char *text = room->names.text;
    const enum gm_statement_word said = gm_statement_word_of(&room->names, line);
    if (said < GM_LINES) {
        return said == GM_LINE_PARAMETER || said == GM_LINE_CHOICE ||
               gm_statement_read(&room->said, &room->names, said, line, fault);
    }
    for (int i = 0; i < WORDS; i++) {
        if (gm_room_is_word(&room->names, line.word, words[i].word)) {
            return read_line(room, (enum gm_room_word)i, line, fault);
        }
    }
    char name[41];
    const size_t letters = line.word.end - line.word.begin;
    snprintf(name, sizeof name, "%.*s", (int)(letters < 40 ? letters : 40), text + line.word.begin);
    const char *near = gm_nearest(name, WORDS + GM_LINES, line_word, NULL);
    return near ? gm_fail(fault, line.word.begin, "a room has no line %s:; did you mean %s:", name, near)
                : gm_fail(fault, line.word.begin,
                          "a room has no line %s:; geomint list office --source prints one that is good",
                          name);
}

bool gm_room_read(struct gm_room *room, const char *text, size_t length, const struct gm_room_given *given,
                  size_t count, struct gm_fault *fault)
{
    struct gm_room_names *names = &room->names;
    *room = (struct gm_room){.names = {.text = malloc(length + 1), .measures = {NAN, NAN, NAN, NAN}},
                             .length = length,
                             .outlet = GM_VERTEX_SOFT};
    *fault = (struct gm_fault){0};
    gm_formula_open(&room->graph);
    if (!names->text) {
        return false;
    }
    memcpy(names->text, text, length);
    names->text[length] = '\0';
    if (!gm_lines_are_text(text, length, fault)) {
        return false;
    }
    struct gm_text_line line;
    for (size_t at = 0; gm_lines_next(names->text, length, &at, &line, fault);) {
        const enum gm_statement_word word = gm_statement_word_of(names, line);
        if ((word == GM_LINE_CHOICE || word == GM_LINE_PARAMETER) &&
            !gm_room_declare(names, line.value, word == GM_LINE_CHOICE, given, count, fault)) {
            return false;
        }
    }
    if (fault->sentence[0] || !choose_lines(room, fault)) {
        return false;
    }
    for (size_t at = 0; gm_lines_next(names->text, length, &at, &line, fault);) {
        if (!read_any(room, line, fault)) {
            return false;
        }
    }
    const struct gm_statement *format = gm_statement(&room->said, GM_LINE_GEOMINT, 0);
    if (!fault->sentence[0] && format && format->pieces[0].numbers[0] != 1) {
        gm_fail(fault, format->pieces[0].span.begin, "this program reads files of format 1, not %.40s",
                format->pieces[0].text);
    }
    if (fault->sentence[0] || room->graph.failed) {
        return false;
    }
    room->scratch = malloc((room->graph.count + 1) * sizeof *room->scratch);
    make_rectangle(room);
    return room->scratch && complete(room, given, count, fault);
}

void gm_room_close(struct gm_room *room)
{
    gm_formula_close(&room->graph);
    for (size_t i = 0; i < room->count; i++) {
        for (int key = 0; key < GM_ROOM_KEYS; key++) {
            free(room->lines[i].value[key].part);
        }
    }
    free(room->scratch);
    free(room->lines);
    gm_statements_close(&room->said);
    gm_room_names_close(&room->names);
    *room = (struct gm_room){0};
}

/* What a side gives at its places; where that is no number, the first such place is kept. */
struct profile {
    const struct gm_room *room;
    const struct gm_room_line *line;
    struct bad *bad;
    double t, reference; /* the temperature where none is given */
};

struct bad {
    const struct gm_room_line *line; /* NULL: all are numbers */
    enum gm_room_key key;
    double at[2];
};

static double value_at(const struct profile *profile, enum gm_room_key key, double standard, double s,
                       const double at[2])
{
    const double place[GM_ROOM_AT] = {s, at[0], at[1], profile->t},
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

/* A carried quantity at the start, where it is not held. */
static bool start_carried(const struct gm_room *room, const struct gm_room_line *line, enum gm_room_key key,
                          const struct gm_complex *complex, const bool *fixed, double *value,
                          struct gm_fault *fault)
{
    for (size_t v = 0; v < complex->vertices && line->value[key].place > 0; v++) {
        const double *p = complex->point + 2 * v, at[GM_ROOM_AT] = {0, p[0], p[1], 0},
                     here = gm_room_value(room, line, key, at, 0);
        value[v] = fixed[v] ? value[v] : here;
        if (!isfinite(here)) {
            return gm_fail(fault, line->value[key].place, "the %s is not finite at (%.4g, %.4g)", keys[key],
                           p[0], p[1]);
        }
    }
    return true;
}

/* A place where tracers come in; false: out of memory. */
static bool add_smoking(struct gm_flow *flow, struct gm_flow_place place)
{
    struct gm_flow_place *more = realloc(flow->smoking, (flow->smoking_count + 1) * sizeof *more);
    if (more) {
        flow->smoking = more;
        more[flow->smoking_count++] = place;
    }
    return more != NULL;
}

/* A source without a place: its rate is that of a unit of area, everywhere. */
static bool spread_source(const struct gm_room *room, const struct gm_room_line *line, struct gm_flow *flow,
                          struct gm_fault *fault)
{
    const struct gm_complex *complex = flow->complex;
    for (size_t v = 0; v < complex->vertices; v++) {
        const double place[GM_ROOM_AT] = {0, complex->point[2 * v], complex->point[2 * v + 1], 0},
                     rate = gm_room_value(room, line, GM_ROOM_RATE, place, 0);
        if (!isfinite(rate)) {
            return gm_fail(fault, line->value[GM_ROOM_RATE].place, "the rate is not finite at (%.4g, %.4g)",
                           place[GM_ROOM_AT_X], place[GM_ROOM_AT_Y]);
        }
        flow->source[v] += complex->star0[v] * rate;
    }
    return true;
}

/* Sources, probes that must lie in the room, and what is carried at the start. */
static bool place_things(const struct gm_room *room, struct gm_flow *flow, struct gm_fault *fault)
{
    const struct gm_complex *complex = flow->complex;
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_line *line = &room->lines[i];
        if (line->word < GM_ROOM_SOURCE || line->word == GM_ROOM_EXACT) {
            continue;
        }
        if (line->word == GM_ROOM_START) {
            if (!start_carried(room, line, GM_ROOM_SCALAR, complex, flow->theta_fixed, flow->theta, fault) ||
                !start_carried(room, line, GM_ROOM_TEMPERATURE, complex, flow->temperature_fixed,
                               flow->temperature, fault)) {
                return false;
            }
            continue;
        }
        if (line->value[GM_ROOM_X].place == 0) {
            if (!spread_source(room, line, flow, fault)) {
                return false;
            }
            continue;
        }
        double at[2], w[3];
        gm_room_point(room, line, at);
        const double place[GM_ROOM_AT] = {0, at[0], at[1], 0},
                     rate = gm_room_value(room, line, GM_ROOM_RATE, place, 0);
        size_t triangle = 0;
        if (!locate(complex, at, &triangle, w)) {
            return gm_fail(fault, line->place, "%.63s at (%.4g, %.4g) is not in the room", line->name, at[0],
                           at[1]);
        }
        if (!isfinite(rate)) {
            return gm_fail(fault, line->value[GM_ROOM_RATE].place, "the rate is not finite");
        }
        if (line->word == GM_ROOM_SOURCE &&
            !add_smoking(flow, (struct gm_flow_place){{at[0], at[1]}, (int)triangle})) {
            return false;
        }
        for (int k = 0; k < 3; k++) {
            flow->source[complex->triangle[3 * triangle + (size_t)k]] += w[k] * rate;
        }
    }
    return true;
}

/* Whether conditions of a line `side:`, as in x = 0, y > 4, hold at a place. */
static bool holds_at(const struct gm_room *room, struct gm_span rest, const double at[GM_ROOM_AT],
                     bool *holds, struct gm_fault *fault)
{
    const double size = fmax(room->rectangle.width, room->rectangle.height);
    struct gm_span condition, sides[2];
    *holds = true;
    while (gm_span_take(room->names.text, &rest, ",", &condition)) {
        const char sign = gm_condition_sign(room->names.text, condition, sides);
        double value[2];
        for (int k = 0; k < 2; k++) {
            if (!gm_room_value_of(&room->names, sides[k], 1u << GM_ROOM_AT_X | 1u << GM_ROOM_AT_Y, at,
                                  &value[k], fault)) {
                return false;
            }
        }
        const double above = value[0] - value[1];
        *holds &= sign == '<' ? above < 0 : sign == '>' ? above > 0 : fabs(above) <= 1e-9 * size;
    }
    return true;
}

/* Whether a name means the edges that no line before names: unless a mesh that the room itself names has such a group. */
static bool is_rest(const struct gm_room *room, const struct gm_triangulation *mesh, const char *name)
{
    return strcmp(name, "all") == 0 && (room->rectangular || gm_triangulation_group(mesh, name) == 0);
}

/* The conditions of the line `side:` of that name; NULL: there is none. */
static const struct gm_piece *find_side(const struct gm_room *room, const char *name)
{
    const struct gm_statement *side;
    for (size_t i = 0; (side = gm_statement(&room->said, GM_LINE_SIDE, i)); i++) {
        if (strcmp(side->pieces[0].text, name) == 0) {
            return gm_statement_piece(side, GM_LINE_SIDE_CONDITIONS);
        }
    }
    return NULL;
}

/* The groups of a line: those that the parameter of its name lists. */
static const char *groups_of(const struct gm_room *room, const struct gm_room_line *line)
{
    const struct gm_room_parameter *other = gm_room_parameter(&room->names, line->name);
    return other ? other->text : line->name;
}

/* Whether a boundary edge is of a line's group, or of one of those that the parameter of its name lists. */
static bool is_in_group(const struct gm_room *room, const struct gm_room_line *line,
                        const struct gm_triangulation *mesh, size_t e)
{
    const struct gm_room_parameter *other = gm_room_parameter(&room->names, line->name);
    char name[256];
    bool is_in = false;
    for (const char *at = other ? other->text : line->name; *at; at += strcspn(at, ","), at += *at == ',') {
        snprintf(name, sizeof name, "%.*s", (int)strcspn(at, other ? "," : ""), at);
        const long tag = gm_triangulation_group(mesh, name);
        is_in |= tag != 0 && gm_triangulation_has(mesh, e, tag);
    }
    return is_in;
}

/* The side of each boundary edge: 0 a wall without a name, else 1 + the line's number. */
static bool name_sides(const struct gm_room *room, const struct gm_triangulation *mesh,
                       unsigned char *side_of, struct gm_fault *fault)
{
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_line *line = &room->lines[i];
        const bool all = is_rest(room, mesh, line->name);
        const bool grouped = !all && (!room->rectangular || room->from_file);
        const struct gm_piece *conditions = all || grouped ? NULL : find_side(room, line->name);
        bool met = false;
        for (size_t b = 0; line->word <= GM_ROOM_BOUNDARY && b < mesh->complex->boundary; b++) {
            const size_t e = (size_t)mesh->complex->boundary_edge[b];
            double middle[GM_ROOM_AT] = {0};
            gm_complex_middle(mesh->complex, e, middle + GM_ROOM_AT_X);
            bool is_on = all || (grouped && is_in_group(room, line, mesh, e));
            if (conditions && !holds_at(room, conditions->span, middle, &is_on, fault)) {
                return false;
            }
            if (is_on && side_of[b] != 0 && !all) {
                return gm_fail(fault, line->place, "curves of the group %.63s have a line already: %.63s",
                               groups_of(room, line), groups_of(room, &room->lines[side_of[b] - 1]));
            }
            side_of[b] = is_on && side_of[b] == 0 ? (unsigned char)(i + 1) : side_of[b];
            met = met || is_on;
        }
        if (line->word <= GM_ROOM_BOUNDARY && !met && mesh->complex->boundary > 0) {
            char names[160];
            if (!grouped) {
                return gm_fail(fault, line->place,
                               "no edge of the rectangle is called %.63s: it needs a line side: %.63s; x = 0",
                               line->name, line->name);
            }
            return gm_fail(fault, line->place,
                           gm_triangulation_group(mesh, line->name) != 0
                               ? "the curves \"%.40s\" are not on the mesh's boundary"
                               : "the mesh has no physical group \"%.40s\" on its boundary (there are: %s)",
                           line->name, gm_triangulation_group_names(mesh, names, sizeof names));
        }
    }
    return true;
}

/* The speed of a free fall over the room's size with the largest difference of temperature that there is:
   the Reynolds number of that is the root of Grashof's. */
static double fall(const struct gm_flow *flow)
{
    const double *range = flow->temperature_range;
    return sqrt(fabs(flow->buoyancy) * (range[1] - range[0]) * sqrt(flow->complex->total_area));
}

/* What the room's lines say of a side at a time. */
static bool make_side(struct profile *profile, struct gm_side *side, struct gm_fault *fault)
{
    const struct gm_room_line *line = profile->line;
    const double at[GM_ROOM_AT] = {[GM_ROOM_AT_T] = profile->t};
    const bool inlet = line->word == GM_ROOM_INLET;
    const double slip = gm_room_value(profile->room, line, GM_ROOM_SLIP, at, 0);
    if (slip != 0 && slip != 1) {
        return gm_fail(fault, line->value[GM_ROOM_SLIP].place,
                       "slip is 1, or 0 where the wall holds the air");
    }
    side->kind = inlet                                        ? GM_EDGE_INLET
                 : line->word == GM_ROOM_OUTLET               ? GM_EDGE_OUTLET
                 : line->value[GM_ROOM_TANGENTIAL].place != 0 ? GM_EDGE_LID
                 : slip == 1                                  ? GM_EDGE_SLIP
                                                              : GM_EDGE_WALL;
    side->flow = gm_room_value(profile->room, line, GM_ROOM_FLOW, at, NAN);
    side->speed = gm_room_value(profile->room, line, GM_ROOM_CENTRE, at, 0);
    side->theta_free = !inlet && line->value[GM_ROOM_SCALAR].place == 0;
    side->temperature_free = !inlet && line->value[GM_ROOM_TEMPERATURE].place == 0;
    side->heats = line->value[GM_ROOM_HEAT].place != 0;
    side->profile = line->value[GM_ROOM_SPEED].place != 0 ? speed_at : NULL;
    side->varying = varying_at;
    side->data = profile;
    return line->value[GM_ROOM_FLOW].place == 0 || (side->flow >= 0 && isfinite(side->flow)) ||
           gm_fail(fault, line->value[GM_ROOM_FLOW].place, "a flow is a number that is not negative");
}

/* At the last of the outlets, whose flow is one too many. */
static void tell_balance(const struct gm_room *room, const struct gm_flow *flow, struct gm_fault *fault)
{
    double in = 0, out = 0;
    size_t place = 0;
    for (size_t i = 0; i < room->count; i++) {
        place = room->lines[i].word == GM_ROOM_OUTLET ? room->lines[i].value[GM_ROOM_FLOW].place : place;
    }
    for (size_t i = 0; i < flow->openings; i++) {
        *(flow->opening[i].inlet ? &in : &out) += flow->opening[i].flow;
    }
    gm_fail(fault, place, "all flows are given, and what enters does not leave: %.6g in, %.6g out", in, out);
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

/* Has the flow's boundary give what the room says at a time. */
static bool set_sides(const struct gm_room *room, const unsigned char *side_of, double t,
                      struct gm_flow *flow, struct gm_fault *fault, enum gm_boundary_fault *boundary)
{
    struct bad bad = {0};
    struct gm_side *sides = calloc(room->count + 1, sizeof *sides);
    struct profile *profiles = calloc(room->count + 1, sizeof *profiles);
    bool good = sides && profiles;
    for (size_t i = 0; good && i <= room->count; i++) {
        const struct gm_room_line *line = i > 0 ? &room->lines[i - 1] : NULL;
        sides[i] = (struct gm_side){.flow = NAN, .theta_free = true, .temperature_free = true};
        profiles[i] = (struct profile){room, line, &bad, t, flow->reference_temperature};
        good = !line || line->word > GM_ROOM_BOUNDARY || make_side(&profiles[i], &sides[i], fault);
    }
    if (good) {
        *boundary = gm_flow_set_sides(flow, side_of, sides, room->outlet);
        give_motion(profiles, side_of, flow);
        good = *boundary == GM_BOUNDARY_OK;
        fault->offset = !good && flow->faulty > 0 ? room->lines[flow->faulty - 1].place : 0;
        if (*boundary == GM_BOUNDARY_UNBALANCED) {
            tell_balance(room, flow, fault);
        }
        if (bad.line) {
            good = gm_fail(fault, bad.line->value[bad.key].place,
                           bad.key == GM_ROOM_TANGENTIAL ? "the %s speed is not finite at (%.4g, %.4g)"
                                                         : "the %s is not finite at (%.4g, %.4g)",
                           keys[bad.key], bad.at[0], bad.at[1]);
        }
    }
    free(sides);
    free(profiles);
    return good;
}

static bool give(const struct gm_flow *flow, double t, struct gm_flow *now)
{
    struct gm_fault fault = {0};
    enum gm_boundary_fault boundary = GM_BOUNDARY_OK;
    return set_sides(flow->given_by, flow->side_of, t, now, &fault, &boundary);
}

void gm_room_fault(const struct gm_room *room, const struct gm_flow *flow, double t, struct gm_fault *fault,
                   enum gm_boundary_fault *boundary)
{
    *fault = (struct gm_fault){0};
    *boundary = GM_BOUNDARY_OK;
    struct gm_flow *now = room->timed ? gm_flow_open_now(flow) : NULL;
    if (now) {
        set_sides(room, flow->side_of, t, now, fault, boundary);
    }
    gm_flow_close_now(now);
}

/* How far what is given at a moment goes. */
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

/* A boundary that changes: pictures and the time unit go by the largest speeds and values up to the end, as
   far as some moments tell. */
static bool look_ahead(const struct gm_room *room, struct gm_flow *flow)
{
    enum { MOMENTS = 64 };
    const double until = gm_statement_value(&room->said, GM_LINE_UNTIL, 10);
    struct gm_flow *now = gm_flow_open_now(flow);
    bool good = now != NULL;
    flow->give = give;
    for (int k = 1; good && k <= MOMENTS; k++) {
        if (give(flow, until * k / MOMENTS, now)) { /* else the run tells when it is there */
            flow->speed = fmax(flow->speed, now->speed);
            widen(flow, now);
        }
    }
    gm_flow_close_now(now);
    return good;
}

struct gm_flow *gm_room_flow(struct gm_room *room, struct gm_triangulation *mesh, struct gm_fault *fault,
                             enum gm_boundary_fault *boundary)
{
    *fault = (struct gm_fault){0};
    *boundary = GM_BOUNDARY_OK;
    struct gm_flow *flow = gm_flow_open(mesh->complex);
    if (!flow) {
        mesh->complex = NULL;
        return NULL;
    }
    const struct gm_complex *complex = flow->complex;
    flow->given_by = room;
    flow->side_of = calloc(complex->boundary + 1, 1);
    flow->source = calloc(complex->vertices, sizeof *flow->source);
    bool good = flow->side_of && flow->source;
    good = good &&
           (isnan(room->buoyancy) || gm_flow_carry_heat(flow, room->buoyancy, room->reference_temperature));
    good = good && (room->count < GM_ROOM_SIDES ||
                    gm_fail(fault, 0, "a room has at most %d lines with names", GM_ROOM_SIDES - 1));
    good = good && name_sides(room, mesh, flow->side_of, fault) &&
           set_sides(room, flow->side_of, 0, flow, fault, boundary) && place_things(room, flow, fault);
    const struct gm_room_parameter *reynolds = gm_room_parameter(&room->names, "reynolds");
    const double scale = reynolds && flow->inlet_length > 0 ? flow->inlet_length : 1;
    flow->viscosity = room->viscosity * scale;
    flow->diffusivity = room->diffusivity * scale;
    flow->temperature_range[0] = flow->temperature_range[1] = flow->reference_temperature;
    if (good) {
        widen(flow, flow);
        good = !room->timed || look_ahead(room, flow);
    }
    mesh->complex = NULL;
    if (!good) {
        gm_flow_close(flow);
        return NULL;
    }
    room->names.measures[GM_ROOM_PERIMETER] = 0;
    for (size_t b = 0; b < complex->boundary; b++) {
        room->names.measures[GM_ROOM_PERIMETER] += complex->length[complex->boundary_edge[b]];
    }
    room->names.measures[GM_ROOM_AREA] = complex->total_area;
    room->names.measures[GM_ROOM_INLET_LENGTH] = flow->inlet_length;
    if (reynolds) {
        flow->reynolds = reynolds->value;
    } else if (room->viscosity > 0) {
        flow->reynolds =
            flow->speed * fmax(flow->inlet_length, sqrt(complex->total_area) / 10) / room->viscosity;
        flow->reynolds = fmax(flow->reynolds, fall(flow) * sqrt(complex->total_area) / room->viscosity);
    }
    const char *scalar = gm_statement_text(&room->said, GM_LINE_SCALAR);
    flow->scalar = !scalar || strcmp(scalar, "none") != 0;
    return flow;
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
        const int group = mesh->edge_group[complex->boundary_edge[complex->loop_start[loop]]];
        for (size_t i = 0; i < mesh->groups; i++) {
            if (group != 0 && mesh->group[i].tag == group && mesh->group[i].name[0]) {
                snprintf(name, size, "%s", mesh->group[i].name);
            }
        }
        break;
    }
    return name;
}
