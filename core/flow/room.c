/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Rooms of files: the lines that systems do not have, and what they say to sides of a mesh's boundary. */
#include "core/flow/room.h"

#include "core/basics.h"
#include "core/expression/number.h"
#include "core/flow/observed.h"
#include "core/functions/functions.h"
#include "core/memory.h"
#include "core/model/scope.h"

#include <float.h>
#include <math.h>
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
    enum gm_system_word word;
    unsigned may, must, some;
    enum { SIDE, THING, START, EXACT } names; /* the last two have none */
} pairs[] = {
    [GM_ROOM_INLET] = {GM_WORD_INLET, ENTERING | CARRIED, 0, ENTERING, SIDE},
    [GM_ROOM_OUTLET] = {GM_WORD_OUTLET, 1u << GM_ROOM_FLOW, 0, 0, SIDE},
    [GM_ROOM_WALL] = {GM_WORD_WALL,
                      CARRIED | 1u << GM_ROOM_TANGENTIAL | 1u << GM_ROOM_HEAT | 1u << GM_ROOM_SLIP, 0, 0,
                      SIDE},
    [GM_ROOM_BOUNDARY] = {GM_WORD_BOUNDARY, MOTION | CARRIED, 1u << GM_ROOM_STREAM_FUNCTION, 0, SIDE},
    [GM_ROOM_SOURCE] = {GM_WORD_SOURCE, 1u << GM_ROOM_RATE | PLACE, 1u << GM_ROOM_RATE, 0, THING},
    [GM_ROOM_PROBE] = {GM_WORD_PROBE, PLACE, PLACE, 0, THING},
    [GM_ROOM_START] = {GM_WORD_ROOM_START, CARRIED | 1u << GM_ROOM_VORTICITY, 0,
                       CARRIED | 1u << GM_ROOM_VORTICITY, START},
    [GM_ROOM_EXACT] = {GM_WORD_ROOM_EXACT, MOTION | 1u << GM_ROOM_SCALAR | 1u << GM_ROOM_TOTAL_PRESSURE, 0,
                       1u << GM_ROOM_STREAM_FUNCTION, EXACT},
};

/* The variables that a formula may hold, by their numbers among a room's; the time and all forms follow. */
enum {
    TIME = GM_ROOM_VARIABLES,
    FORMS,
    AT = 1u << GM_ROOM_AT_X | 1u << GM_ROOM_AT_Y,
    MEASURES =
        1u << GM_ROOM_PERIMETER | 1u << GM_ROOM_AREA | 1u << GM_ROOM_INLET_LENGTH | 1u << GM_ROOM_UNTIL,
    ALL = (2u << FORMS) - 1
};

/* A room while it is read, and the variables that the formula may hold that is read now. */
struct room_reading {
    struct gm_reading reading; /* first */
    struct gm_room *room;
    unsigned may;
    bool timed; /* it holds t */
};

/* A flow is that of a whole side, a place is one; s runs along inlets, and what the boundary gives, and the
   exact solution, may change in time. */
static unsigned may_hold(enum gm_room_word word, enum gm_room_key key)
{
    const unsigned along = AT | (word == GM_ROOM_INLET ? 1u << GM_ROOM_PART : 0),
                   changes = word <= GM_ROOM_BOUNDARY || word == GM_ROOM_EXACT ? 1u << TIME : 0;
    return key == GM_ROOM_SLIP                            ? 0
           : key == GM_ROOM_FLOW || key == GM_ROOM_CENTRE ? changes
           : key == GM_ROOM_X || key == GM_ROOM_Y         ? 0
                                                          : along | changes;
}

static const char *withheld(struct gm_reading *reading, gm_node_id part)
{
    struct room_reading *here = (struct room_reading *)reading;
    const struct gm_user_system *system = reading->system;
    size_t count = 0;
    gm_node_id *parts = gm_formula_parts(&system->graph, part, &count);
    unsigned held = 0;
    for (size_t i = 0; parts && i < count; i++) {
        const struct gm_node *node = &system->graph.nodes[parts[i]];
        if (node->operation == GM_VARIABLE) {
            const bool form = node->a < system->n || node->a >= system->first_call;
            held |= 1u << (form ? FORMS : node->a == system->n ? TIME : node->a - system->velocities);
        }
    }
    free(parts);
    gm_arena_need(system->arena, parts != NULL);
    here->timed |= held >> TIME & 1;
    held &= ~here->may;
    return held >> FORMS & 1 ? "forms of the flow, such as psi, are for the lines let: and observe:"
           : held >> TIME & 1
               ? "what a room's boundary gives may change in time: no start, no source and no place"
           : held >> GM_ROOM_PART & 1 ? "s runs along an inlet; only the inlet's formulas may contain it"
           : held & AT ? "a flow is that of a whole side, and a place is two numbers: neither holds x and y"
           : held      ? "measures of the flow are for the lines time:, graph: and subtitle:"
                       : NULL;
}

const struct gm_system_variable *gm_room_parameter(const struct gm_room *room, const char *name)
{
    const struct gm_user_system *system = &room->system;
    for (size_t i = system->parameters; i < system->velocities; i++) {
        if (strcmp(system->variables[i].name, name) == 0) {
            return &system->variables[i];
        }
    }
    return NULL;
}

const struct gm_read_line *gm_room_said(const struct gm_room *room, enum gm_system_word word)
{
    size_t i = 0;
    while (i < room->said_count && room->said[i].word != word) {
        i++;
    }
    return i < room->said_count ? &room->said[i] : NULL;
}

double gm_room_evaluate(const struct gm_room *room, gm_node_id node)
{
    gm_formula_evaluate(&room->system.graph, node + 1, room->values, room->scratch);
    return room->scratch[node];
}

static void put_place(const struct gm_room *room, const double at[4])
{
    const struct gm_user_system *system = &room->system;
    double *place = room->values + system->velocities;
    place[GM_ROOM_PART] = at[0];
    place[GM_ROOM_AT_X] = at[1];
    place[GM_ROOM_AT_Y] = at[2];
    room->values[system->n] = at[3];
}

double gm_room_value(const struct gm_room *room, const struct gm_room_line *line, enum gm_room_key key,
                     const double at[4], double standard)
{
    const struct gm_room_formula *value = line ? &line->value[key] : NULL;
    if (!value || value->place == 0) {
        return standard;
    }
    put_place(room, at);
    gm_formula_evaluate_parts(&room->system.graph, value->part, value->parts, room->values, room->scratch);
    return room->scratch[value->part[value->parts - 1]];
}

void gm_room_point(const struct gm_room *room, const struct gm_room_line *line, double point[2])
{
    const double origin[4] = {0};
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

/* ---- pairs key = formula ---- */

static const char *word_of(enum gm_room_word word)
{
    return gm_system_words[pairs[word].word].word;
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

static void read_formula(struct room_reading *here, struct gm_span span, enum gm_room_word word,
                         enum gm_room_key key, struct gm_room_formula *value)
{
    struct gm_room *room = here->room;
    here->may = may_hold(word, key);
    here->timed = false;
    const gm_node_id node = gm_reading_formula(&here->reading, span);
    room->timed = room->timed || (here->timed && word <= GM_ROOM_BOUNDARY);
    value->place = span.begin;
    value->part =
        gm_arena_keep(room->system.arena, gm_formula_parts(&room->system.graph, node, &value->parts), free);
}

static void read_pairs(struct room_reading *here, struct gm_room_line *line, struct gm_span rest)
{
    const struct gm_user_system *room = here->reading.system;
    const char *text = here->reading.text;
    const enum gm_room_word word = line->word;
    unsigned given = 0;
    char list[160];
    while (rest.begin < rest.end) {
        const size_t length = gm_name_length(text + rest.begin, rest.end - rest.begin);
        int key = GM_ROOM_KEYS - 1;
        while (key >= 0 &&
               (strncmp(text + rest.begin, keys[key], length) != 0 || keys[key][length] != '\0')) {
            key--;
        }
        if (length == 0 || key < 0 || !(pairs[word].may >> key & 1)) {
            gm_system_refuse(
                room, rest.begin, "%s: takes %s%s", word_of(word),
                list_keys(pairs[word].may, ", ", list, sizeof list),
                given || pairs[word].names >= START ? "" : "; a name with blanks is in double quotes");
        }
        size_t equals = rest.begin + length;
        equals += strspn(text + equals, " \t\r\n");
        gm_system_refuse_if(room, equals >= rest.end || text[equals] != '=',
                            equals < rest.end ? equals : rest.begin, "%s: needs = and a value", keys[key]);
        equals++;
        const size_t end = next_key(text, (struct gm_span){equals, rest.end});
        gm_system_refuse_if(room, given >> key & 1, rest.begin, "%s = is given twice", keys[key]);
        const struct gm_span formula = gm_span_trimmed(text, (struct gm_span){equals, end});
        read_formula(here, formula, word, (enum gm_room_key)key, &line->value[key]);
        given |= 1u << key;
        rest.begin = end;
    }
    const unsigned missing = pairs[word].must & ~given;
    gm_system_refuse_if(room, missing, line->place, "%s: needs %s", word_of(word),
                        list_keys(missing & -missing, "", list, sizeof list));
    gm_system_refuse_if(room, given >> GM_ROOM_TEMPERATURE & given >> GM_ROOM_HEAT & 1, line->place,
                        "wall: holds its temperature = or gives heat =, not both");
    gm_system_refuse_if(room, given & PLACE && (given & PLACE) != PLACE, line->place,
                        "%s: has x = and y =, or neither", word_of(word));
    gm_system_refuse_if(room, pairs[word].some && !(given & pairs[word].some), line->place, "%s: needs %s",
                        word_of(word), list_keys(pairs[word].some, " or ", list, sizeof list));
}

/* The rest of a line that has a name in front, which may be in double quotes. */
static struct gm_span take_name(const struct gm_reading *reading, struct gm_room_line *line,
                                struct gm_span value)
{
    const char *text = reading->text;
    const bool quoted = value.begin < value.end && text[value.begin] == '"';
    struct gm_span name = {value.begin + quoted, value.begin + quoted};
    while (name.end < value.end && (quoted ? text[name.end] != '"' : !strchr(" \t\r\n", text[name.end]))) {
        name.end++;
    }
    const size_t length = name.end - name.begin;
    gm_system_refuse_if(reading->system, quoted && name.end == value.end, value.begin,
                        "%s: the name has no closing quote", word_of(line->word));
    gm_system_refuse_if(reading->system, length == 0 || length >= GM_ROOM_NAME, line->place,
                        "%s: needs a name, of at most 63 bytes", word_of(line->word));
    memcpy(line->name, text + name.begin, length);
    return gm_reading_between(reading, name.end + quoted, value.end);
}

static void read_line(struct room_reading *here, const struct gm_read_line *said, enum gm_room_word word)
{
    struct gm_room *room = here->room;
    room->lines = gm_arena_grown(here->reading.system->arena, room->lines, room->count, sizeof *room->lines);
    struct gm_room_line *line = &room->lines[room->count];
    *line = (struct gm_room_line){.word = word, .place = said->value.begin};
    const bool named = pairs[word].names < START;
    const struct gm_span rest = named ? take_name(&here->reading, line, said->value) : said->value;
    for (size_t i = 0; i < room->count; i++) {
        gm_system_refuse_if(&room->system,
                            pairs[room->lines[i].word].names == pairs[word].names &&
                                strcmp(room->lines[i].name, line->name) == 0,
                            line->place, "%.63s is named twice", line->name);
    }
    room->count++;
    read_pairs(here, line, rest);
}

/* ---- the mesh ---- */

/* keep x, y */
static void read_kept(struct gm_reading *reading, struct gm_room *room, struct gm_span value)
{
    double *at = room->fixed + 2 * room->rectangle.fixed_count++;
    struct gm_span piece;
    for (int c = 0; c < 2; c++) {
        gm_span_take(reading->text, &value, ",", &piece);
        at[c] = gm_reading_finite(reading, piece);
    }
    gm_system_refuse_if(reading->system, value.begin < value.end, value.begin, "keep: has two numbers, x, y");
}

/* rectangle; width F; height F; edges KEY; strips KEY; along y; irregular F; multiple F; keep x, y; ..., or
   rectangle F F KEY KEY; ..., or flat-torus; ...; or a file */
static void read_mesh(struct room_reading *here, const struct gm_read_line *line)
{
    struct gm_reading *reading = &here->reading;
    struct gm_room *room = here->room;
    struct gm_rectangle *rectangle = &room->rectangle;
    struct gm_mesh_line mesh;
    double edges = 0, strips = 0, multiple = 0;
    const struct {
        const char *word;
        double *number, least, most;
        char **key; /* key of a whole number; NULL: any number */
    } options[] = {{"width", &rectangle->width, 1e-9, 1e9, NULL},
                   {"height", &rectangle->height, 1e-9, 1e9, NULL},
                   {"edges", &edges, 1, 100000, &room->edges},
                   {"strips", &strips, 0, 100000, &room->strips},
                   {"irregular", &rectangle->irregular, 0, 0.45, NULL},
                   {"multiple", &multiple, 1, 100000, &(char *){NULL}}};
    const struct gm_span kind = gm_mesh_begin(reading, line, &mesh);
    rectangle->torus = gm_span_is(reading->text, kind, "flat-torus");
    room->rectangular = rectangle->torus || gm_span_is(reading->text, kind, "rectangle");
    rectangle->fixed = room->fixed;
    room->edges = room->strips = gm_reading_text(reading, (struct gm_span){0, 0});
    if (!room->rectangular) {
        room->system.texts[GM_WORD_MESH] = gm_reading_text(reading, line->value);
        return;
    }
    while (gm_mesh_next(reading, &mesh)) {
        const size_t i = mesh.number;
        struct gm_span value = mesh.value,
                       word = i < GM_MESH_NUMBERS ? value : gm_reading_word(reading, &value);
        if (i < GM_MESH_NUMBERS ||
            (i == GM_MESH_NUMBERS && gm_span_is(reading->text, word, options[i].word))) {
            const double number = *options[i].number = gm_reading_finite(reading, value);
            gm_system_refuse_if(&room->system,
                                number < options[i].least || number > options[i].most ||
                                    (options[i].key && number != floor(number)),
                                value.begin, "%s: is a %snumber from %g to %g", options[i].word,
                                options[i].key ? "whole " : "", options[i].least, options[i].most);
            if (options[i].key) {
                *options[i].key = gm_reading_text(reading, value);
            }
        } else if (gm_span_is(reading->text, word, "along") && gm_span_is(reading->text, value, "y")) {
            rectangle->transposed = true;
        } else if (gm_span_is(reading->text, word, "keep") &&
                   rectangle->fixed_count * 2 < GM_COUNT(room->fixed)) {
            read_kept(reading, room, value);
        } else {
            gm_system_refuse(
                &room->system, word.begin,
                "a rectangle has width, height, edges, strips, irregular, multiple, along y, and "
                "up to %zu keep",
                GM_COUNT(room->fixed) / 2);
        }
    }
    rectangle->edges = (long)edges;
    rectangle->strips = (long)strips;
    room->multiple = (long)multiple;
    gm_system_refuse_if(&room->system, !(rectangle->width > 0 && rectangle->height > 0 && edges > 0),
                        line->value.begin, "a rectangle has a width, a height and a number of edges");
}

/* ---- items: their nodes are described in core/flow/room.h ---- */

/* Adds a formula that may hold some of the variables. */
static void add_formula(struct room_reading *here, struct gm_system_item *item, struct gm_span span,
                        unsigned may)
{
    here->may = may;
    gm_item_add(&here->reading, item, gm_reading_formula(&here->reading, span));
}

/* graph: KEY; low .. high */
static void read_graph(struct room_reading *here, const struct gm_read_line *line)
{
    struct gm_span rest = line->value, piece;
    gm_span_take(here->reading.text, &rest, ";", &piece);
    struct gm_system_item *item = gm_reading_item(&here->reading, line, piece);
    if (!gm_span_take(here->reading.text, &rest, ";", &piece)) {
        return;
    }
    const size_t dots = gm_span_until(here->reading.text, piece, "..");
    gm_system_refuse_if(here->reading.system, dots == piece.end, piece.begin,
                        "a range was expected, low .. high");
    add_formula(here, item, (struct gm_span){piece.begin, dots}, MEASURES);
    add_formula(here, item, (struct gm_span){dots + 2, piece.end}, MEASURES);
    const struct gm_node *nodes = here->room->system.graph.nodes, *low = &nodes[item->nodes[0]],
                         *high = &nodes[item->nodes[1]];
    gm_system_refuse_if(here->reading.system,
                        low->operation == GM_CONSTANT && high->operation == GM_CONSTANT &&
                            !(low->value < high->value),
                        piece.begin, "a range's lower end comes first");
}

/* side: NAME; x = 0, y > 4 */
static void read_side(struct room_reading *here, const struct gm_read_line *line)
{
    const char *text = here->reading.text;
    struct gm_user_system *system = here->reading.system;
    struct gm_span rest = line->value, condition;
    gm_span_take(text, &rest, ";", &condition);
    struct gm_system_item *item = gm_reading_item(&here->reading, line, condition);
    char *signs = item->text = gm_arena_take(system->arena, rest.end - rest.begin + 1, 1);
    while (gm_span_take(text, &rest, ",", &condition)) {
        size_t sign = condition.begin;
        while (sign < condition.end && !strchr("=<>", text[sign])) {
            sign++;
        }
        gm_system_refuse_if(system, sign == condition.end, condition.begin,
                            "a condition was expected, x = 0");
        add_formula(here, item, (struct gm_span){condition.begin, sign}, AT);
        add_formula(here, item, (struct gm_span){sign + 1, condition.end}, AT);
        *signs++ = text[sign];
    }
}

/* time: F; unit, meaning, or the unit alone */
static void read_time(struct room_reading *here, const struct gm_read_line *line)
{
    struct gm_span rest = line->value, unit;
    gm_span_take(here->reading.text, &rest, ";", &unit);
    rest = gm_span_trimmed(here->reading.text, rest);
    here->room->system.texts[GM_WORD_TIME] =
        gm_reading_text(&here->reading, rest.begin < rest.end ? rest : line->value);
    if (rest.begin < rest.end) {
        add_formula(here, gm_reading_item(&here->reading, line, (struct gm_span){0, 0}), unit, MEASURES);
    }
}

/* colours: vorticity F, speed F */
static void read_colours(struct room_reading *here, const struct gm_read_line *line)
{
    static const char *const words[] = {"vorticity", "speed", NULL};
    struct gm_span rest = line->value, piece;
    while (gm_span_take(here->reading.text, &rest, ",", &piece)) {
        const size_t place = piece.begin;
        const struct gm_span word = gm_reading_word(&here->reading, &piece);
        struct gm_system_item *item = gm_reading_item(&here->reading, line, word);
        const bool known = words[gm_span_among(here->reading.text, word, words)];
        item->value = known ? gm_reading_finite(&here->reading, piece) : 0;
        gm_system_refuse_if(here->reading.system, !(item->value > 0), place,
                            "colours: end at positive numbers: vorticity 5, speed 1");
    }
}

static void read_levels(struct room_reading *here, const struct gm_read_line *line)
{
    gm_item_numbers(&here->reading, gm_reading_item(&here->reading, line, (struct gm_span){0, 0}),
                    line->value);
}

/* profile: NAME QUANTITIES; x, y; x, y; points; low .. high; label */
static void read_profile(struct room_reading *here, const struct gm_read_line *line)
{
    static const char *const quantities[] = {"u", "v", "scalar", NULL};
    static const size_t numbers[] = {2, 4, 5};
    struct gm_reading *reading = &here->reading;
    struct gm_span rest = line->value, head, piece;
    gm_span_take(reading->text, &rest, ";", &head);
    char *letters = gm_arena_take(reading->system->arena, head.end - head.begin + 1, 1);
    struct gm_system_item *item = gm_reading_item(reading, line, gm_reading_word(reading, &head));
    item->words = letters;
    while (head.begin < head.end) {
        const struct gm_span word = gm_reading_word(reading, &head);
        gm_system_refuse_if(reading->system, !quantities[gm_span_among(reading->text, word, quantities)],
                            line->value.begin, "a profile shows u, v or scalar");
        *letters++ = reading->text[word.begin];
    }
    for (size_t i = 0; i < GM_COUNT(numbers); i++) {
        gm_span_take(reading->text, &rest, ";", &piece);
        gm_system_refuse_if(reading->system, gm_item_numbers(reading, item, piece) != numbers[i],
                            line->value.begin,
                            "a profile has a name and quantities, two places and a number of points");
    }
    gm_span_take(reading->text, &rest, ";", &piece);
    const struct gm_written_range range = gm_reading_range(reading, piece);
    item->low = range.low;
    item->high = range.high;
    item->text = rest.begin < rest.end ? gm_reading_text(reading, rest) : NULL;
}

/* table: NAME PROFILE; KEY = VALUE; position value, position value ... */
static void read_table(struct room_reading *here, const struct gm_read_line *line)
{
    struct gm_reading *reading = &here->reading;
    struct gm_span rest = line->value, head, value, piece;
    gm_span_take(reading->text, &rest, ";", &head);
    gm_span_take(reading->text, &rest, ";", &value);
    gm_span_take(reading->text, &value, "=", &piece);
    struct gm_system_item *item = gm_reading_item(reading, line, gm_reading_word(reading, &head));
    item->words = gm_reading_text(reading, head);
    item->text = gm_reading_text(reading, piece);
    item->value = gm_reading_finite(reading, value);
    while (gm_span_take(reading->text, &rest, ",", &piece)) {
        gm_item_numbers(reading, item, gm_reading_word(reading, &piece));
        if (gm_item_numbers(reading, item, piece) % 2 == 1) {
            gm_item_number(reading, item, NAN);
        }
    }
}

/* observe: KEY; title TEXT; missing TEXT; along PROFILE, or NAME = formula; title TEXT */
static void read_observed(struct room_reading *here, const struct gm_read_line *line)
{
    struct gm_reading *reading = &here->reading;
    struct gm_span rest = line->value, key, name;
    gm_span_take(reading->text, &rest, ";", &key);
    const bool formula = gm_span_until(reading->text, key, "=") < key.end;
    gm_span_take(reading->text, &key, "=", &name);
    struct gm_system_item *item = gm_reading_item(reading, line, name);
    if (formula) {
        reading->without_forms = false;
        add_formula(here, item, key, AT | 1u << TIME | 1u << FORMS);
    }
    gm_options_read(reading, item, rest);
}

static void read_validity(struct room_reading *here, const struct gm_read_line *line)
{
    here->room->unsolved = !(gm_reading_finite(&here->reading, line->value) > 0);
}

/* Texts in which braces have no meaning. */
static void read_text(struct room_reading *here, const struct gm_read_line *line)
{
    here->room->system.texts[line->word] = gm_reading_text(&here->reading, line->value);
}

/* True if the text is a number, which is read. */
static bool read_number(const struct gm_room *room, const char *text, double *number)
{
    const unsigned long refusals = gm_memory_refusals();
    const bool is_read = gm_number_parse(text, number);
    gm_arena_need(room->system.arena, gm_memory_refusals() == refusals);
    return is_read;
}

/* Reads a line with a single number. */
static void read_single(struct room_reading *here, const struct gm_read_line *line)
{
    struct gm_room *room = here->room;
    const struct gm_room_range any = {-DBL_MAX, DBL_MAX}, positive = {DBL_MIN, DBL_MAX},
                               reynolds = {1 / gm_room_viscosity.most, 1 / gm_room_viscosity.least};
    const struct {
        enum gm_system_word word;
        double *number;
        struct gm_room_range range;
    } rows[] = {
        {GM_WORD_VISCOSITY, &room->viscosity, gm_room_viscosity},
        {GM_WORD_DIFFUSIVITY, &room->diffusivity, positive},
        {GM_WORD_REYNOLDS, &room->reynolds, reynolds},
        {GM_WORD_SCHMIDT, &room->schmidt, gm_room_schmidt},
        {GM_WORD_BUOYANCY, &room->buoyancy, any},
        {GM_WORD_REFERENCE_TEMPERATURE, &room->reference_temperature, any},
    };
    size_t i = 0;
    while (rows[i].word != line->word) {
        i++;
    }
    const double least = rows[i].range.least, most = rows[i].range.most;
    double *number = rows[i].number;
    const char *word = gm_system_words[line->word].word, *text = gm_reading_text(&here->reading, line->value);
    gm_system_refuse_if(&room->system,
                        !read_number(room, text, number) || !isfinite(*number) ||
                            (least >= 0 && !(*number > 0)),
                        line->value.begin, "%s: is a %s number", word, least >= 0 ? "positive" : "finite");
    gm_system_refuse_if(&room->system, !(*number >= least && *number <= most), line->value.begin,
                        "%s: lies between %g and %g", word, least, most);
}

/* True if the values of two lines begin with the same name. */
static bool share_name(const char *one, const char *other)
{
    const size_t letters = strcspn(one, "; \t\r\n");
    return letters == strcspn(other, "; \t\r\n") && memcmp(one, other, letters) == 0;
}

/* Refuses a line that is named like one before it with the same word. */
static void check_name(const struct gm_reading *reading, const struct gm_read_line *line)
{
    for (const struct gm_read_line *other = reading->lines; other->place < line->place; other++) {
        gm_system_refuse_if(reading->system,
                            other->word == line->word && share_name(reading->text + other->value.begin,
                                                                    reading->text + line->value.begin),
                            line->place, "%s: is given twice", gm_system_words[line->word].word);
    }
}

/* Reads a line that systems do not have, or with another meaning. */
static bool read_own(struct gm_reading *reading, const struct gm_read_line *line)
{
    static const struct {
        enum gm_system_word word;
        void (*read)(struct room_reading *here, const struct gm_read_line *line);
    } rows[] = {{GM_WORD_TITLE, read_text},       {GM_WORD_CAPTION, read_text},
                {GM_WORD_TIME, read_time},        {GM_WORD_MESH, read_mesh},
                {GM_WORD_SIDE, read_side},        {GM_WORD_EXACT_WHILE, read_validity},
                {GM_WORD_VISCOSITY, read_single}, {GM_WORD_DIFFUSIVITY, read_single},
                {GM_WORD_REYNOLDS, read_single},  {GM_WORD_SCHMIDT, read_single},
                {GM_WORD_BUOYANCY, read_single},  {GM_WORD_REFERENCE_TEMPERATURE, read_single},
                {GM_WORD_OBSERVE, read_observed}, {GM_WORD_PROFILE, read_profile},
                {GM_WORD_TABLE, read_table},      {GM_WORD_GRAPH, read_graph},
                {GM_WORD_COLOURS, read_colours},  {GM_WORD_LEVELS, read_levels}};
    struct room_reading *here = (struct room_reading *)reading;
    reading->without_forms = true; /* but in lets, which were read before */
    if (gm_system_words[line->word].identity == GM_LINE_NAMED) {
        check_name(reading, line);
    }
    for (size_t i = 0; i < GM_COUNT(pairs); i++) {
        if (pairs[i].word == line->word) {
            read_line(here, line, (enum gm_room_word)i);
            return true;
        }
    }
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        if (rows[i].word == line->word) {
            rows[i].read(here, line);
            return true;
        }
    }
    here->may = MEASURES; /* of texts */
    return false;
}

/* ---- the whole ---- */

/* The start of the first line with this word; 0: none. */
static size_t place_of(const struct gm_room *room, enum gm_system_word word)
{
    const struct gm_read_line *line = gm_room_said(room, word);
    return line ? line->place : 0;
}

double gm_room_timing(const struct gm_room *room, enum gm_system_word word, double otherwise)
{
    const struct gm_system_item *item = gm_system_item_of(&room->system, word, 0);
    return item ? item->value : otherwise;
}

/* Viscosity and diffusivity, from numbers, parameters and given values. */
static void complete_numbers(struct gm_room *room, const struct gm_room_input *input)
{
    const struct gm_user_system *system = &room->system;
    const struct {
        enum gm_system_word word;
        double *number;
    } numbers[] = {{GM_WORD_VISCOSITY, &room->viscosity},
                   {GM_WORD_REYNOLDS, &room->reynolds},
                   {GM_WORD_SCHMIDT, &room->schmidt}};
    for (size_t i = 0; i < GM_COUNT(numbers); i++) {
        const char *name = gm_system_words[numbers[i].word].word;
        const struct gm_system_variable *parameter = gm_room_parameter(room, name);
        gm_system_refuse_if(system, parameter && !isnan(*numbers[i].number), place_of(room, numbers[i].word),
                            "%s: is given twice, here and as a parameter", name);
        gm_system_refuse_if(system, parameter && !(parameter->value > 0 || (i == 0 && parameter->value == 0)),
                            parameter ? parameter->start_place : 0, "%s: is a positive number", name);
        *numbers[i].number = parameter ? parameter->value : *numbers[i].number;
    }
    gm_system_refuse_if(system, !isnan(room->viscosity) && !isnan(room->reynolds),
                        place_of(room, GM_WORD_REYNOLDS),
                        "viscosity: and reynolds: say the same; a room has one of them");
    gm_system_refuse_if(system, !isnan(room->diffusivity) && !isnan(room->schmidt),
                        place_of(room, GM_WORD_SCHMIDT),
                        "diffusivity: and schmidt: say the same; a room has one of them");
    for (size_t k = 0; k < input->count; k++) {
        for (size_t i = 0; i < GM_COUNT(numbers) && !gm_room_parameter(room, input->given[k].name); i++) {
            if (strcmp(input->given[k].name, gm_system_words[numbers[i].word].word) == 0) {
                room->reynolds = i == 0 ? NAN : room->reynolds;
                read_number(room, input->given[k].text, numbers[i].number);
            }
        }
    }
    const bool meshed = system->texts[GM_WORD_MESH] || room->rectangular;
    room->viscosity = isnan(room->reynolds) ? room->viscosity : 1 / room->reynolds;
    gm_system_refuse_if(system, !meshed || isnan(room->viscosity), 0, "a room needs a line %s",
                        meshed ? "viscosity: (or reynolds:)" : "mesh:");
    room->diffusivity = !isnan(room->schmidt)      ? room->viscosity / room->schmidt
                        : isnan(room->diffusivity) ? room->viscosity
                                                   : room->diffusivity;
    const double ratio = room->viscosity / room->diffusivity;
    gm_system_refuse_if(
        system, !(ratio >= gm_room_schmidt.least && ratio <= gm_room_schmidt.most) && room->viscosity > 0,
        place_of(room, GM_WORD_DIFFUSIVITY), "viscosity / diffusivity is %.4g; it lies between %g and %g",
        ratio, gm_room_schmidt.least, gm_room_schmidt.most);
}

/* Heat needs buoyancy, and the other way round. */
static void complete_heat(struct gm_room *room)
{
    size_t warm = 0, place = 0;
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_formula *value = room->lines[i].value;
        const size_t here = value[GM_ROOM_TEMPERATURE].place + value[GM_ROOM_HEAT].place; /* one is 0 */
        warm += here > 0;
        place = here > 0 ? here : place;
    }
    const enum gm_system_word word = isnan(room->buoyancy) ? GM_WORD_REFERENCE_TEMPERATURE : GM_WORD_BUOYANCY;
    gm_system_refuse_if(
        &room->system, warm > 0 && isnan(room->buoyancy), place,
        "a temperature or heat needs a line buoyancy: (g beta; 0 where warm air does not rise)");
    gm_system_refuse_if(&room->system,
                        warm == 0 && !(isnan(room->buoyancy) && isnan(room->reference_temperature)),
                        place_of(room, word),
                        "%s: needs a temperature = of a wall, an inlet or the start, or heat = of a wall",
                        gm_system_words[word].word);
    room->reference_temperature =
        isnan(room->reference_temperature) && warm > 0 ? 0 : room->reference_temperature;
}

/* Completes values, and refuses missing ones and those that are given twice. */
static void complete(struct gm_room *room, const struct gm_room_input *input)
{
    const struct gm_system_item *side = gm_system_item_of(&room->system, GM_WORD_SIDE, 0);
    gm_system_refuse_if(&room->system, side && !room->rectangular, side ? side->place : 0,
                        "side: is of a rectangle; a mesh of Gmsh has physical groups");
    for (int i = 0; i < 2; i++) {
        const struct gm_room_range range = i == 0 ? gm_room_dt : gm_room_until;
        const enum gm_system_word word = i == 0 ? GM_WORD_DT : GM_WORD_UNTIL;
        const struct gm_system_item *item = gm_system_item_of(&room->system, word, 0);
        gm_system_refuse_if(&room->system, item && !(item->value >= range.least && item->value <= range.most),
                            item ? item->place : 0, "%s: lies between %g and %g", gm_system_words[word].word,
                            range.least, range.most);
    }
    complete_numbers(room, input);
    complete_heat(room);
}

/* Compiles the observables that lines observe: define. */
static void compile_observed(struct gm_room *room)
{
    struct gm_user_system *system = &room->system;
    struct gm_form_root *roots = gm_arena_take(system->arena, system->item_count + 1, sizeof *roots);
    struct gm_fault fault;
    size_t count = 0;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_OBSERVE && item->count > 0) {
            roots[count++] = (struct gm_form_root){
                .node = item->nodes[0], .type = {GM_FORM_NUMBER, false}, .place = item->place};
        }
    }
    if (!gm_form_compile(&room->observed, system, roots, count, false, &fault)) {
        gm_arena_need(system->arena, fault.sentence[0]);
        gm_system_refuse(system, fault.offset, "%s", fault.sentence);
    }
}

static void close_arena(void *arena)
{
    gm_arena_close(arena);
}

void gm_room_read(struct gm_arena *arena, struct gm_room *room, const struct gm_room_input *input,
                  struct gm_fault *fault)
{
    *room = (struct gm_room){.system = {.arena = arena, .fault = fault, .kind = GM_ROOM},
                             .viscosity = NAN,
                             .diffusivity = NAN,
                             .reynolds = NAN,
                             .schmidt = NAN,
                             .buoyancy = NAN,
                             .reference_temperature = NAN,
                             .outlet = GM_VERTEX_SOFT};
    const unsigned long refusals = gm_memory_refusals();
    struct gm_user_system *system = &room->system;
    gm_formula_open(&system->graph);
    gm_arena_keep(arena, &system->graph, gm_formula_close);
    struct room_reading here = {.reading = {.system = system,
                                            .text = input->text,
                                            .length = input->length,
                                            .values = input->given,
                                            .value_count = input->count,
                                            .line = read_own,
                                            .withheld = withheld,
                                            .scratch = gm_arena_keep(arena, gm_arena_open(), close_arena)},
                                .room = room,
                                .may = ALL};
    gm_reading_read(&here.reading);
    gm_arena_need(arena, gm_memory_refusals() == refusals); /* a number was read as a word */
    gm_arena_drop(arena, here.reading.scratch);
    room->said = here.reading.lines;
    room->said_count = here.reading.line_count;
    room->values = gm_arena_take(arena, system->variable_count, sizeof *room->values);
    room->scratch = gm_arena_take(arena, system->graph.count + (size_t)1, sizeof *room->scratch);
    for (size_t i = 0; i < system->variable_count; i++) {
        room->values[i] = NAN;
    }
    complete(room, input);
    compile_observed(room);
    gm_system_need_graph(system);
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
    *fault = (struct gm_fault){0};
    return gm_arena_made(open_room, &opening) ? opening.room : NULL;
}

void gm_room_close(struct gm_room *room)
{
    if (room) {
        gm_arena_close(room->system.arena);
    }
}

/* ---- the flow on its mesh ---- */

/* The value of a key at the part s of a side, the point x, y and the time t, which has to be finite. */
static double finite_value(const struct gm_room *room, const struct gm_room_line *line, enum gm_room_key key,
                           const double at[4], double standard)
{
    const double value = gm_room_value(room, line, key, at, standard);
    gm_system_refuse_if(&room->system, !isfinite(value), line ? line->value[key].place : 0,
                        "the %s%s is not finite at (%.4g, %.4g)", keys[key],
                        key == GM_ROOM_TANGENTIAL ? " speed" : "", at[1], at[2]);
    return value;
}

/* The values along a side at a time. */
struct profile {
    const struct gm_room *room;
    const struct gm_room_line *line;
    double t, reference; /* reference: the default temperature */
};

static double value_at(const struct profile *profile, enum gm_room_key key, double standard, double s,
                       const double at[2])
{
    const double place[4] = {s, at[0], at[1], profile->t};
    return finite_value(profile->room, profile->line, key, place, standard);
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
        gm_complex_coordinates(complex, t, at, w);
        if (w[0] >= -1e-12 && w[1] >= -1e-12 && w[2] >= -1e-12) {
            *triangle = t;
            return true;
        }
    }
    return false;
}

/* A quantity of a line at the vertices that do not hold it; NULL: at all. */
static void put_values(const struct gm_room *room, const struct gm_room_line *line, enum gm_room_key key,
                       const struct gm_complex *complex, const bool *fixed, double *value)
{
    for (size_t v = 0; v < complex->vertices && line->value[key].place > 0; v++) {
        const double at[4] = {0, complex->point[2 * v], complex->point[2 * v + 1], 0},
                     here = finite_value(room, line, key, at, 0);
        value[v] = fixed && fixed[v] ? value[v] : here;
    }
}

/* A source or a probe, which must lie in the room. */
static void place_thing(const struct gm_room *room, const struct gm_room_line *line, struct gm_flow *flow)
{
    const struct gm_complex *complex = flow->complex;
    double at[2], w[3] = {0};
    size_t triangle = 0;
    gm_room_point(room, line, at);
    const double place[4] = {0, at[0], at[1], 0}, rate = gm_room_value(room, line, GM_ROOM_RATE, place, 0);
    gm_system_refuse_if(&room->system, !locate(complex, at, &triangle, w), line->place,
                        "%.63s at (%.4g, %.4g) is not in the room", line->name, at[0], at[1]);
    gm_system_refuse_if(&room->system, !isfinite(rate), line->value[GM_ROOM_RATE].place,
                        "the rate is not finite");
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
        /* a source without a place: its rate is that of a unit of area, everywhere */
        const bool spread = line->word == GM_ROOM_SOURCE && line->value[GM_ROOM_X].place == 0;
        if (line->word == GM_ROOM_START) {
            put_values(room, line, GM_ROOM_SCALAR, complex, flow->theta_fixed, flow->theta);
            put_values(room, line, GM_ROOM_TEMPERATURE, complex, flow->temperature_fixed, flow->temperature);
            flow->vorticity = line->value[GM_ROOM_VORTICITY].place > 0
                                  ? gm_arena_take(room->system.arena, complex->vertices, sizeof(double))
                                  : NULL;
            put_values(room, line, GM_ROOM_VORTICITY, complex, NULL, flow->vorticity);
        } else if (line->word == GM_ROOM_PROBE || (line->word == GM_ROOM_SOURCE && !spread)) {
            place_thing(room, line, flow);
        }
        for (size_t v = 0; spread && v < complex->vertices; v++) {
            const double at[4] = {0, complex->point[2 * v], complex->point[2 * v + 1], 0};
            flow->source[v] += complex->star0[v] * finite_value(room, line, GM_ROOM_RATE, at, 0);
        }
    }
}

/* True if the conditions of a line `side:` hold at a place. */
static bool holds_at(const struct gm_room *room, const struct gm_system_item *side, const double at[4])
{
    const double size = fmax(room->rectangle.width, room->rectangle.height);
    bool holds = true;
    put_place(room, at);
    for (size_t i = 0; i < side->count; i += 2) {
        const double above =
            gm_room_evaluate(room, side->nodes[i]) - gm_room_evaluate(room, side->nodes[i + 1]);
        holds &= side->text[i / 2] == '<'   ? above < 0
                 : side->text[i / 2] == '>' ? above > 0
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

/* The groups of a line, which the parameter of its name lists. */
static const char *groups_of(const struct gm_room *room, const struct gm_room_line *line)
{
    const struct gm_system_variable *other = gm_room_parameter(room, line->name);
    return other ? other->text : line->name;
}

/* A boundary edge becomes one of line number `i`, from 0, unless it belongs to another line. */
static void take_edge(const struct gm_room *room, unsigned char *side, size_t i)
{
    const struct gm_room_line *line = &room->lines[i];
    const struct gm_room_line *other = *side != 0 ? &room->lines[*side - 1] : line;
    gm_system_refuse_if(&room->system, other != line, line->place,
                        "curves of the group %.63s have a line already: %.63s", groups_of(room, line),
                        groups_of(room, other));
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
        gm_triangulation_group_names(mesh, names, sizeof names);
        gm_system_refuse_if(&room->system, !met, line->place,
                            tag != 0
                                ? "no edge of the mesh's boundary belongs to \"%.60s\""
                                : "the mesh has no physical group \"%.60s\" on its boundary (there are: %s)",
                            name, names);
        for (const char *before = list; before < at; before += strcspn(before, ",") + 1) {
            gm_system_refuse_if(&room->system,
                                strncmp(before, name, strlen(name)) == 0 && before[strlen(name)] == ',',
                                line->place, "the group \"%.60s\" is named twice", name);
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
        if (line->word > GM_ROOM_BOUNDARY) {
            continue;
        }
        if (!all && (!room->rectangular || room->from_file)) {
            name_groups(room, mesh, i, side_of);
            continue;
        }
        const struct gm_system_item *side =
            all ? NULL : gm_system_item_named(&room->system, GM_WORD_SIDE, line->name);
        bool met = all;
        for (size_t b = 0; b < complex->boundary && (all || side); b++) {
            double middle[4] = {0};
            gm_complex_middle(complex, (size_t)complex->boundary_edge[b], middle + 1);
            if (all ? side_of[b] == 0 : holds_at(room, side, middle)) {
                take_edge(room, &side_of[b], i);
                met = true;
            }
        }
        gm_system_refuse_if(&room->system, !met, line->place,
                            "no edge of the rectangle is called %.63s: it needs a line side: %.63s; x = 0",
                            line->name, line->name);
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
    const double at[4] = {[3] = profile->t};
    const bool inlet = line->word == GM_ROOM_INLET;
    const double slip = gm_room_value(profile->room, line, GM_ROOM_SLIP, at, 0);
    gm_system_refuse_if(&profile->room->system, slip != 0 && slip != 1, line->value[GM_ROOM_SLIP].place,
                        "slip is 1, or 0 where the wall holds the air");
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
    gm_system_refuse_if(&profile->room->system,
                        line->value[GM_ROOM_FLOW].place != 0 && !(side.flow >= 0 && isfinite(side.flow)),
                        line->value[GM_ROOM_FLOW].place, "a flow is a number that is not negative");
    return side;
}

/* Returns the place of the last outlet's flow that is given, as a number or by a profile. */
static size_t last_outflow(const struct gm_room *room)
{
    size_t place = GM_ROOM_NOWHERE;
    for (size_t i = 0; i < room->count; i++) {
        const struct gm_room_line *line = &room->lines[i];
        const size_t flow = line->value[GM_ROOM_FLOW].place, speed = line->value[GM_ROOM_SPEED].place;
        if (line->word == GM_ROOM_OUTLET && (flow != 0 || speed != 0)) {
            place = flow != 0 ? flow : speed;
        }
    }
    return place;
}

/* Refuses a boundary. Flows that do not balance, and outlets that take too much, are refused at the last outlet
   whose flow is given. */
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
        const size_t own = flow->faulty > 0 ? room->lines[flow->faulty - 1].place : GM_ROOM_NOWHERE;
        gm_system_refuse(&room->system, fault == GM_BOUNDARY_BACKWARDS ? last_outflow(room) : own, "%s",
                         sentences[fault]);
    }
    const size_t place = last_outflow(room);
    double in = 0, out = 0;
    for (size_t i = 0; i < flow->openings; i++) {
        *(flow->opening[i].inlet ? &in : &out) += flow->opening[i].flow;
    }
    gm_system_refuse(&room->system, place,
                     "all flows are given, and what enters does not leave: %.6g in, %.6g out", in, out);
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
            flow->speed = fmax(flow->speed, gm_hypot(value_at(profile, GM_ROOM_SPEED_X, 0, 0, at),
                                                     value_at(profile, GM_ROOM_SPEED_Y, 0, 0, at)));
        }
    }
}

/* Sets the flow's boundary from the room's lines at the time t. */
static void set_sides(const struct gm_room *room, const unsigned char *side_of, double t,
                      struct gm_flow *flow)
{
    struct gm_side sides[GM_ROOM_SIDES];
    struct profile profiles[GM_ROOM_SIDES];
    for (size_t i = 0; i <= room->count; i++) {
        profiles[i] =
            (struct profile){room, i > 0 ? &room->lines[i - 1] : NULL, t, flow->reference_temperature};
        sides[i] = side_from(&profiles[i]);
    }
    const enum gm_boundary_fault fault = gm_flow_set_sides(flow, side_of, sides, room->outlet);
    give_motion(profiles, side_of, flow);
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
    struct gm_fault *const before = room->system.fault;
    room->system.fault = fault;
    const bool valid = gm_arena_run(room->system.arena, set_moment, &moment);
    room->system.fault = before;
    return valid;
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

/* A boundary that changes: pictures and the time unit go by the largest speeds and values up to the end,
   sampled at some moments. */
static void look_ahead(const struct gm_room *room, struct gm_flow *flow)
{
    enum { MOMENTS = 64 };
    const double until = gm_room_timing(room, GM_WORD_UNTIL, 10);
    struct gm_flow *now = gm_arena_keep(room->system.arena, gm_flow_open_now(flow), gm_flow_close);
    flow->give = give;
    for (int k = 1; k <= MOMENTS; k++) {
        if (give(flow, until * k / MOMENTS, now)) { /* else the run reports it at that time */
            flow->speed = fmax(flow->speed, now->speed);
            widen(flow, now);
        }
    }
    gm_arena_drop(room->system.arena, now);
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
        gm_arena_keep(arena, gm_flow_open(making->mesh->complex), gm_flow_close);
    const struct gm_complex *complex = flow->complex;
    flow->given_by = room;
    flow->side_of = gm_arena_take(arena, complex->boundary + 1, 1);
    flow->source = gm_arena_take(arena, complex->vertices, sizeof *flow->source);
    flow->smoking = gm_arena_take(arena, room->count + 1, sizeof *flow->smoking);
    if (!isnan(room->buoyancy)) {
        gm_flow_carry_heat(flow, room->buoyancy, room->reference_temperature);
    }
    gm_system_refuse_if(&room->system, room->count >= GM_ROOM_SIDES, 0,
                        "a room has at most %d lines with names", GM_ROOM_SIDES - 1);
    name_sides(room, making->mesh, flow->side_of);
    set_sides(room, flow->side_of, 0, flow);
    place_things(room, flow);
    const struct gm_system_variable *reynolds = gm_room_parameter(room, "reynolds");
    const double scale = reynolds && flow->inlet_length > 0 ? flow->inlet_length : 1;
    flow->viscosity = room->viscosity * scale;
    flow->diffusivity = room->diffusivity * scale;
    flow->temperature_range[0] = flow->temperature_range[1] = flow->reference_temperature;
    widen(flow, flow);
    if (room->timed) {
        look_ahead(room, flow);
    }
    double *measures = room->values + room->system.velocities;
    measures[GM_ROOM_PERIMETER] = 0;
    for (size_t b = 0; b < complex->boundary; b++) {
        measures[GM_ROOM_PERIMETER] += complex->length[complex->boundary_edge[b]];
    }
    measures[GM_ROOM_AREA] = complex->total_area;
    measures[GM_ROOM_INLET_LENGTH] = flow->inlet_length;
    if (reynolds) {
        flow->reynolds = reynolds->value;
    } else if (room->viscosity > 0) {
        flow->reynolds =
            flow->speed * fmax(flow->inlet_length, sqrt(complex->total_area) / 10) / room->viscosity;
        flow->reynolds = fmax(flow->reynolds, fall(flow) * sqrt(complex->total_area) / room->viscosity);
    }
    if (room->observed.root_count > 0) {
        room->forms = gm_flow_forms_open(arena, &room->observed, &room->system, room->values, flow);
    }
    const char *scalar = room->system.texts[GM_WORD_SCALAR];
    flow->scalar = !scalar || strcmp(scalar, "none") != 0;
}

struct gm_flow *gm_room_flow(struct gm_room *room, struct gm_triangulation *mesh, struct gm_fault *fault)
{
    struct making making = {.room = room, .mesh = mesh};
    *fault = (struct gm_fault){0};
    room->system.fault = fault;
    const bool made = gm_arena_run(room->system.arena, make_flow, &making);
    mesh->complex = NULL;
    return made ? making.flow : NULL;
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
