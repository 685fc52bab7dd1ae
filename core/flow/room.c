/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms of files: lines to sides of a mesh's boundary, sources, a start and probes. */
#include "core/flow/room.h"
#include "core/basics.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const keys[GM_ROOM_KEYS] = {"speed", "flow", "scalar", "temperature", "tangential", "heat",
                                               "rate",  "x",    "y"};

#define CARRIED (1u << GM_ROOM_SCALAR | 1u << GM_ROOM_TEMPERATURE)

/* The lines that name something, with the keys they may have, and those that they must. */
static const struct {
    const char *word;
    unsigned may, must;
} words[] = {
    [GM_ROOM_INLET] = {"inlet", 1u << GM_ROOM_SPEED | 1u << GM_ROOM_FLOW | CARRIED, 0},
    [GM_ROOM_OUTLET] = {"outlet", 1u << GM_ROOM_FLOW, 0},
    [GM_ROOM_WALL] = {"wall", CARRIED | 1u << GM_ROOM_TANGENTIAL | 1u << GM_ROOM_HEAT, 0},
    [GM_ROOM_SOURCE] = {"source", 1u << GM_ROOM_RATE | 1u << GM_ROOM_X | 1u << GM_ROOM_Y, 1u << GM_ROOM_RATE},
    [GM_ROOM_PROBE] = {"probe", 1u << GM_ROOM_X | 1u << GM_ROOM_Y, 1u << GM_ROOM_X | 1u << GM_ROOM_Y},
    [GM_ROOM_START] = {"start", CARRIED, 0},
};
enum { WORDS = GM_COUNT(words) };

/* The variables of formulas. */
enum { PART, X, Y, TIME, VARIABLES };
static const char *const variables[VARIABLES] = {"s", "x", "y", "t"};

/* A formula that is read, and the variables that it may hold. */
struct reading {
    struct gm_room *room;
    unsigned may;
};

/* A flow is that of a whole side, a place is one; s runs along inlets, and what the boundary gives may change in
   time. */
static unsigned may_hold(enum gm_room_word word, enum gm_room_key key)
{
    const bool varies = key != GM_ROOM_FLOW && key != GM_ROOM_X && key != GM_ROOM_Y;
    return (varies ? 1u << X | 1u << Y : 0) | (varies && word == GM_ROOM_INLET ? 1u << PART : 0) |
           (word <= GM_ROOM_WALL ? 1u << TIME : 0);
}

static const char *known(size_t i, const void *data)
{
    return (void)data, i < VARIABLES ? variables[i] : NULL;
}

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    const struct reading *reading = data;
    for (size_t i = 0; i < VARIABLES; i++) {
        if (name->length != 1 || name->text[0] != variables[i][0] || name->initial) {
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
                         ? "s runs along an inlet, and stands in what that gives at a place"
                         : "a flow is that of a whole side, and a place is two numbers: neither holds "
                           "x and y");
            return GM_REFUSED;
        }
        reading->room->timed = reading->room->timed || i == TIME;
        *node = gm_formula_variable(&reading->room->graph, i);
        return GM_KNOWN;
    }
    return GM_UNKNOWN;
}

static bool read_formula(struct gm_room *room, struct gm_span span, unsigned may,
                         struct gm_room_formula *value, struct gm_fault *fault)
{
    struct reading reading = {room, may};
    const struct gm_scope scope = {.find = find, .known = known, .data = &reading, .lines = true};
    gm_node_id node = 0;
    if (!gm_formula_read(&room->graph, room->text, span.begin, span.end, &scope, &node, fault)) {
        return false;
    }
    value->place = span.begin;
    value->part = gm_formula_parts(&room->graph, node, &value->parts);
    return value->part != NULL;
}

double gm_room_value(const struct gm_room *room, const struct gm_room_line *line, enum gm_room_key key,
                     const double at[VARIABLES], double standard, double *scratch)
{
    const struct gm_room_formula *value = &line->value[key];
    if (value->place == 0) {
        return standard;
    }
    gm_formula_evaluate_parts(&room->graph, value->part, value->parts, at, scratch);
    return scratch[value->part[value->parts - 1]];
}

void gm_room_point(const struct gm_room *room, const struct gm_room_line *line, double *scratch,
                   double point[2])
{
    const double origin[VARIABLES] = {0};
    point[0] = gm_room_value(room, line, GM_ROOM_X, origin, 0, scratch);
    point[1] = gm_room_value(room, line, GM_ROOM_Y, origin, 0, scratch);
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

static bool read_pairs(struct gm_room *room, struct gm_room_line *line, struct gm_span rest,
                       struct gm_fault *fault)
{
    unsigned given = 0;
    while (rest.begin < rest.end) {
        const size_t length = gm_name_length(room->text + rest.begin, rest.end - rest.begin);
        int key = GM_ROOM_KEYS - 1;
        while (key >= 0 &&
               (strncmp(room->text + rest.begin, keys[key], length) != 0 || keys[key][length] != '\0')) {
            key--;
        }
        if (length == 0 || key < 0 || !(words[line->word].may >> key & 1)) {
            char list[96] = "";
            for (size_t k = 0, used = 0; k < GM_ROOM_KEYS; k++) {
                if (words[line->word].may >> k & 1) {
                    used += (size_t)snprintf(list + used, sizeof list - used, "%s%s =", used ? ", " : "",
                                             keys[k]);
                }
            }
            return gm_fail(fault, rest.begin, "%s: takes %s%s", words[line->word].word, list,
                           given || line->word == GM_ROOM_START ? ""
                                                                : "; a name with blanks is in double quotes");
        }
        size_t equals = rest.begin + length;
        equals += strspn(room->text + equals, " \t\r\n");
        if (equals >= rest.end || room->text[equals] != '=') {
            return gm_fail(fault, equals < rest.end ? equals : rest.begin, "%s: needs = and a value",
                           keys[key]);
        }
        equals++;
        const size_t end = next_key(room->text, (struct gm_span){equals, rest.end});
        if (given >> key & 1) {
            return gm_fail(fault, rest.begin, "%s = is given twice", keys[key]);
        }
        const struct gm_span formula = gm_span_trimmed(room->text, (struct gm_span){equals, end});
        if (!read_formula(room, formula, may_hold(line->word, (enum gm_room_key)key), &line->value[key],
                          fault)) {
            return false;
        }
        given |= 1u << key;
        rest.begin = end;
    }
    for (int key = 0; key < GM_ROOM_KEYS; key++) {
        if (words[line->word].must >> key & 1 && !(given >> key & 1)) {
            return gm_fail(fault, line->place, "%s: needs %s =", words[line->word].word, keys[key]);
        }
    }
    if (given >> GM_ROOM_TEMPERATURE & given >> GM_ROOM_HEAT & 1) {
        return gm_fail(fault, line->place, "wall: holds its temperature = or gives heat =, not both");
    }
    const unsigned place = 1u << GM_ROOM_X | 1u << GM_ROOM_Y;
    if (given & place && (given & place) != place) {
        return gm_fail(fault, line->place, "%s: has x = and y =, or neither", words[line->word].word);
    }
    const struct {
        enum gm_room_word word;
        unsigned some;
        const char *sentence;
    } rows[] = {
        {GM_ROOM_INLET, 1u << GM_ROOM_SPEED | 1u << GM_ROOM_FLOW, "inlet: needs speed = or flow ="},
        {GM_ROOM_START, CARRIED, "start: needs scalar = or temperature ="},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        if (line->word == rows[i].word && !(given & rows[i].some)) {
            return gm_fail(fault, line->place, "%s", rows[i].sentence);
        }
    }
    return true;
}

static bool read_line(struct gm_room *room, enum gm_room_word word, struct gm_span value,
                      struct gm_fault *fault)
{
    struct gm_room_line *more = realloc(room->lines, (room->count + 1) * sizeof *more);
    if (!more) {
        return false;
    }
    room->lines = more;
    struct gm_room_line *line = &more[room->count];
    *line = (struct gm_room_line){.word = word, .place = value.begin};
    if (word != GM_ROOM_START) {
        const bool quoted = value.begin < value.end && room->text[value.begin] == '"';
        struct gm_span name = {value.begin + quoted, value.begin + quoted};
        while (name.end < value.end &&
               (quoted ? room->text[name.end] != '"' : !strchr(" \t\r\n", room->text[name.end]))) {
            name.end++;
        }
        const size_t length = name.end - name.begin;
        if (quoted && name.end == value.end) {
            return gm_fail(fault, value.begin, "%s: the name has no closing quote", words[word].word);
        }
        if (length == 0 || length >= GM_ROOM_NAME) {
            return gm_fail(fault, value.begin, "%s: needs a name, of at most 63 bytes", words[word].word);
        }
        memcpy(line->name, room->text + name.begin, length);
        value = gm_span_trimmed(room->text, (struct gm_span){name.end + quoted, value.end});
    }
    for (size_t i = 0; i < room->count; i++) {
        const bool same = (more[i].word <= GM_ROOM_WALL) == (word <= GM_ROOM_WALL) &&
                          (more[i].word == GM_ROOM_START) == (word == GM_ROOM_START);
        if (same && strcmp(more[i].name, line->name) == 0) {
            return word == GM_ROOM_START ? gm_fail(fault, line->place, "start: is given twice")
                                         : gm_fail(fault, line->place, "%.63s is named twice", line->name);
        }
    }
    room->count++;
    return read_pairs(room, line, value, fault);
}

/* A line that says one thing: true where it is known. */
static bool read_single(struct gm_room *room, struct gm_text_line line, bool *met, struct gm_fault *fault)
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
        {"reference-temperature", NULL, &room->reference_temperature, any},
        {"dt", NULL, &room->dt, gm_room_dt},
        {"until", NULL, &room->until, gm_room_until},
    };
    const size_t length = line.word.end - line.word.begin;
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        if (strlen(rows[i].word) != length ||
            memcmp(rows[i].word, room->text + line.word.begin, length) != 0) {
            continue;
        }
        *met = true;
        if (rows[i].text ? *rows[i].text != NULL : !isnan(*rows[i].number)) {
            return gm_fail(fault, line.word.begin, "%s: is given twice", rows[i].word);
        }
        if (line.value.begin == line.value.end) {
            return gm_fail(fault, line.word.begin, "%s: says nothing", rows[i].word);
        }
        if (rows[i].text) {
            *rows[i].text = gm_span_words(room->text, line.value);
            return *rows[i].text != NULL;
        }
        char number[64];
        snprintf(number, sizeof number, "%.*s", (int)(line.value.end - line.value.begin),
                 room->text + line.value.begin);
        const double least = rows[i].range.least, most = rows[i].range.most;
        if (!gm_number_parse(number, rows[i].number) || !isfinite(*rows[i].number) ||
            (least >= 0 && !(*rows[i].number > 0))) {
            return gm_fail(fault, line.value.begin, "%s: is a %s number", rows[i].word,
                           least >= 0 ? "positive" : "finite");
        }
        return (*rows[i].number >= least && *rows[i].number <= most) ||
               gm_fail(fault, line.value.begin, "%s: lies between %g and %g", rows[i].word, least, most);
    }
    return true;
}

/* Where the line begins that says this. */
static size_t place_of(const struct gm_room *room, const char *word)
{
    struct gm_text_line line;
    struct gm_fault fault;
    size_t at = 0;
    while (gm_lines_next(room->text, strlen(room->text), &at, &line, &fault)) {
        if (strlen(word) == line.word.end - line.word.begin &&
            strncmp(room->text + line.word.begin, word, strlen(word)) == 0) {
            return line.word.begin;
        }
    }
    return 0;
}

/* What is said in one of two ways, and whether all is said. */
static bool complete(struct gm_room *room, struct gm_fault *fault)
{
    if (!isnan(room->viscosity) && !isnan(room->reynolds)) {
        return gm_fail(fault, place_of(room, "reynolds"),
                       "viscosity: and reynolds: say the same; a room has one of them");
    }
    if (!isnan(room->diffusivity) && !isnan(room->schmidt)) {
        return gm_fail(fault, place_of(room, "schmidt"),
                       "diffusivity: and schmidt: say the same; a room has one of them");
    }
    room->viscosity = isnan(room->reynolds) ? room->viscosity : 1 / room->reynolds;
    if (!room->mesh || isnan(room->viscosity)) {
        return gm_fail(fault, 0, "a room needs a line %s",
                       room->mesh ? "viscosity: (or reynolds:)" : "mesh:");
    }
    room->diffusivity = !isnan(room->schmidt)      ? room->viscosity / room->schmidt
                        : isnan(room->diffusivity) ? room->viscosity
                                                   : room->diffusivity;
    const double ratio = room->viscosity / room->diffusivity;
    if (!(ratio >= gm_room_schmidt.least && ratio <= gm_room_schmidt.most)) {
        return gm_fail(fault, place_of(room, "diffusivity"),
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
        return gm_fail(
            fault, place,
            "a temperature or heat needs a line buoyancy: (g beta; 0 where warm air does not rise)");
    }
    if (warm == 0 && !(isnan(room->buoyancy) && isnan(room->reference_temperature))) {
        const char *word = isnan(room->buoyancy) ? "reference-temperature" : "buoyancy";
        return gm_fail(fault, place_of(room, word),
                       "%s: needs a temperature = of a wall, an inlet or the start, or heat = of a wall",
                       word);
    }
    room->reference_temperature =
        isnan(room->reference_temperature) && warm > 0 ? 0 : room->reference_temperature;
    return true;
}

bool gm_room_read(struct gm_room *room, const char *text, size_t length, struct gm_fault *fault)
{
    *room = (struct gm_room){.text = malloc(length + 1),
                             .length = length,
                             .viscosity = NAN,
                             .diffusivity = NAN,
                             .reynolds = NAN,
                             .schmidt = NAN,
                             .buoyancy = NAN,
                             .reference_temperature = NAN,
                             .dt = NAN,
                             .until = NAN};
    *fault = (struct gm_fault){0};
    gm_formula_open(&room->graph);
    if (!room->text) {
        return false;
    }
    memcpy(room->text, text, length);
    room->text[length] = '\0';
    if (!gm_lines_are_text(text, length, fault)) {
        return false;
    }
    struct gm_text_line line;
    size_t at = 0;
    while (gm_lines_next(room->text, length, &at, &line, fault)) {
        const char *word = room->text + line.word.begin;
        const size_t letters = line.word.end - line.word.begin;
        bool met = letters == strlen("geomint") && strncmp(word, "geomint", letters) == 0;
        if (met && !(line.value.end == line.value.begin + 1 && room->text[line.value.begin] == '1')) {
            return gm_fail(
                fault, line.value.begin, "this program reads files of format 1, not %.*s",
                (int)(line.value.end - line.value.begin < 40 ? line.value.end - line.value.begin : 40),
                room->text + line.value.begin);
        }
        if (!met && !read_single(room, line, &met, fault)) {
            return false;
        }
        for (int i = 0; i < WORDS && !met; i++) {
            if (strlen(words[i].word) == letters && strncmp(word, words[i].word, letters) == 0) {
                met = true;
                if (!read_line(room, (enum gm_room_word)i, line.value, fault)) {
                    return false;
                }
            }
        }
        if (!met) {
            return gm_fail(
                fault, line.word.begin,
                "a room has no line %.*s:; it has geomint: title: about: mesh: units: scalar: viscosity: "
                "diffusivity: reynolds: schmidt: buoyancy: reference-temperature: dt: until: "
                "inlet: outlet: wall: source: probe: start:",
                (int)(letters < 40 ? letters : 40), word);
        }
    }
    if (fault->sentence[0] || room->graph.failed) {
        return false;
    }
    return complete(room, fault);
}

void gm_room_close(struct gm_room *room)
{
    gm_formula_close(&room->graph);
    for (size_t i = 0; i < room->count; i++) {
        for (int key = 0; key < GM_ROOM_KEYS; key++) {
            free(room->lines[i].value[key].part);
        }
    }
    free(room->text);
    free(room->lines);
    free(room->title);
    free(room->about);
    free(room->mesh);
    free(room->units);
    free(room->scalar);
    *room = (struct gm_room){0};
}

/* What a side gives at its places; where that is no number, the first such place is kept. */
struct profile {
    const struct gm_room *room;
    const struct gm_room_line *line;
    struct bad *bad;
    double t, reference; /* the temperature where none is given */
    double *scratch;
};

struct bad {
    const struct gm_room_line *line; /* NULL: all are numbers */
    enum gm_room_key key;
    double at[2];
};

static double value_at(const struct profile *profile, enum gm_room_key key, double standard, double s,
                       const double at[2])
{
    const double place[VARIABLES] = {s, at[0], at[1], profile->t},
                 value = gm_room_value(profile->room, profile->line, key, place, standard, profile->scratch);
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
                          const struct gm_complex *complex, const bool *fixed, double *value, double *scratch,
                          struct gm_fault *fault)
{
    for (size_t v = 0; v < complex->vertices && line->value[key].place > 0; v++) {
        const double *p = complex->point + 2 * v, at[VARIABLES] = {0, p[0], p[1], 0},
                     here = gm_room_value(room, line, key, at, 0, scratch);
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
                          double *scratch, struct gm_fault *fault)
{
    const struct gm_complex *complex = flow->complex;
    for (size_t v = 0; v < complex->vertices; v++) {
        const double place[VARIABLES] = {0, complex->point[2 * v], complex->point[2 * v + 1], 0},
                     rate = gm_room_value(room, line, GM_ROOM_RATE, place, 0, scratch);
        if (!isfinite(rate)) {
            return gm_fail(fault, line->value[GM_ROOM_RATE].place, "the rate is not finite at (%.4g, %.4g)",
                           place[X], place[Y]);
        }
        flow->source[v] += complex->star0[v] * rate;
    }
    return true;
}

/* Sources, probes that must lie in the room, and what is carried at the start. */
static bool place_things(const struct gm_room *room, struct gm_flow *flow, double *scratch,
                         struct gm_fault *fault)
{
    const struct gm_complex *complex = flow->complex;
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_line *line = &room->lines[i];
        if (line->word < GM_ROOM_SOURCE) {
            continue;
        }
        if (line->word == GM_ROOM_START) {
            if (!start_carried(room, line, GM_ROOM_SCALAR, complex, flow->theta_fixed, flow->theta, scratch,
                               fault) ||
                !start_carried(room, line, GM_ROOM_TEMPERATURE, complex, flow->temperature_fixed,
                               flow->temperature, scratch, fault)) {
                return false;
            }
            continue;
        }
        if (line->value[GM_ROOM_X].place == 0) {
            if (!spread_source(room, line, flow, scratch, fault)) {
                return false;
            }
            continue;
        }
        double at[2], w[3];
        gm_room_point(room, line, scratch, at);
        const double place[VARIABLES] = {0, at[0], at[1], 0},
                     rate = gm_room_value(room, line, GM_ROOM_RATE, place, 0, scratch);
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

/* The side of each boundary edge: 0 a wall without a name, else 1 + the line's number. */
static bool name_sides(const struct gm_room *room, const struct gm_triangulation *mesh,
                       unsigned char *side_of, struct gm_fault *fault)
{
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_line *line = &room->lines[i];
        if (line->word > GM_ROOM_WALL) {
            continue;
        }
        const long tag = gm_triangulation_group(mesh, line->name);
        bool met = false;
        for (size_t b = 0; tag != 0 && b < mesh->complex->boundary; b++) {
            if (gm_triangulation_has(mesh, (size_t)mesh->complex->boundary_edge[b], tag)) {
                if (side_of[b] != 0) {
                    return gm_fail(fault, line->place, "curves of the group %.63s have a line already: %.63s",
                                   line->name, room->lines[side_of[b] - 1].name);
                }
                side_of[b] = (unsigned char)(i + 1);
                met = true;
            }
        }
        if (!met) {
            char names[160];
            return gm_fail(fault, line->place,
                           tag != 0
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
    const double at[VARIABLES] = {[TIME] = profile->t};
    const bool inlet = line->word == GM_ROOM_INLET;
    side->kind = inlet                                        ? GM_EDGE_INLET
                 : line->word == GM_ROOM_OUTLET               ? GM_EDGE_OUTLET
                 : line->value[GM_ROOM_TANGENTIAL].place != 0 ? GM_EDGE_LID
                                                              : GM_EDGE_WALL;
    side->flow = gm_room_value(profile->room, line, GM_ROOM_FLOW, at, NAN, profile->scratch);
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

/* Has the flow's boundary give what the room says at a time. */
static bool set_sides(const struct gm_room *room, const unsigned char *side_of, double t,
                      struct gm_flow *flow, struct gm_fault *fault, enum gm_boundary_fault *boundary)
{
    struct bad bad = {0};
    struct gm_side *sides = calloc(room->count + 1, sizeof *sides);
    struct profile *profiles = calloc(room->count + 1, sizeof *profiles);
    double *scratch = malloc((room->graph.count + 1) * sizeof *scratch);
    bool good = sides && profiles && scratch;
    for (size_t i = 0; good && i <= room->count; i++) {
        const struct gm_room_line *line = i > 0 ? &room->lines[i - 1] : NULL;
        sides[i] = (struct gm_side){.flow = NAN, .theta_free = true, .temperature_free = true};
        profiles[i] = (struct profile){room, line, &bad, t, flow->reference_temperature, scratch};
        good = !line || line->word > GM_ROOM_WALL || make_side(&profiles[i], &sides[i], fault);
    }
    if (good) {
        *boundary = gm_flow_set_sides(flow, side_of, sides, GM_VERTEX_SOFT);
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
    free(scratch);
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
    const double until = isnan(room->until) ? 10 : room->until;
    struct gm_flow *now = gm_flow_open_now(flow);
    bool good = now != NULL;
    flow->give = give;
    flow->given_by = room;
    for (int k = 1; good && k <= MOMENTS; k++) {
        if (give(flow, until * k / MOMENTS, now)) { /* else the run tells when it is there */
            flow->speed = fmax(flow->speed, now->speed);
            widen(flow, now);
        }
    }
    gm_flow_close_now(now);
    return good;
}

struct gm_flow *gm_room_flow(const struct gm_room *room, struct gm_triangulation *mesh,
                             struct gm_fault *fault, enum gm_boundary_fault *boundary)
{
    *fault = (struct gm_fault){0};
    *boundary = GM_BOUNDARY_OK;
    struct gm_flow *flow = gm_flow_open(mesh->complex);
    if (!flow) {
        mesh->complex = NULL;
        return NULL;
    }
    const struct gm_complex *complex = flow->complex;
    double *scratch = malloc((room->graph.count + 1) * sizeof *scratch);
    flow->side_of = calloc(complex->boundary + 1, 1);
    flow->source = calloc(complex->vertices, sizeof *flow->source);
    bool good = flow->side_of && scratch && flow->source;
    good = good &&
           (isnan(room->buoyancy) || gm_flow_carry_heat(flow, room->buoyancy, room->reference_temperature));
    good = good && (room->count < GM_ROOM_SIDES ||
                    gm_fail(fault, 0, "a room has at most %d lines with names", GM_ROOM_SIDES - 1));
    good = good && name_sides(room, mesh, flow->side_of, fault) &&
           set_sides(room, flow->side_of, 0, flow, fault, boundary) &&
           place_things(room, flow, scratch, fault);
    flow->viscosity = room->viscosity;
    flow->diffusivity = room->diffusivity;
    flow->temperature_range[0] = flow->temperature_range[1] = flow->reference_temperature;
    if (good) {
        widen(flow, flow);
        good = !room->timed || look_ahead(room, flow);
    }
    free(scratch);
    mesh->complex = NULL;
    if (!good) {
        gm_flow_close(flow);
        return NULL;
    }
    flow->reynolds = flow->speed * fmax(flow->inlet_length, sqrt(complex->total_area) / 10) / room->viscosity;
    flow->reynolds = fmax(flow->reynolds, fall(flow) * sqrt(complex->total_area) / room->viscosity);
    flow->scalar = true;
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
