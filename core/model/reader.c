/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads systems: lines, then declarations, then their formulas. */
#include "core/model/scope.h"

#include <math.h>
#include <string.h>

#include "core/basics.h"
#include "core/expression/linear_part.h"
#include "core/expression/number.h"

static const struct gm_span nameless = {0, 0};

struct gm_system_item *gm_reading_item(struct gm_reading *reading, const struct gm_read_line *line,
                                       struct gm_span name)
{
    struct gm_user_system *system = reading->system;
    system->items = gm_arena_grown(system->arena, system->items, system->item_count, sizeof *system->items);
    struct gm_system_item *item = &system->items[system->item_count++];
    *item = (struct gm_system_item){.word = (enum gm_system_word)line->word,
                                    .place = line->value.begin,
                                    .low = NAN,
                                    .high = NAN,
                                    .name = gm_reading_text(reading, name)};
    return item;
}

static void add_formula(struct gm_reading *reading, struct gm_system_item *item, struct gm_span span)
{
    gm_item_add(reading, item, gm_reading_formula(reading, span));
}

/* Takes the piece before the next semicolon. */
static struct gm_span take_piece(const struct gm_reading *reading, struct gm_span *rest)
{
    struct gm_span piece;
    gm_span_take(reading->text, rest, ";", &piece);
    return piece;
}

static const char *word_of(const struct gm_read_line *line)
{
    return gm_system_words[line->word].word;
}

/* The word of an assignment, its range and meaning, or the mark of derived starts. */
struct assignment {
    enum gm_system_word word;
    struct gm_written_range range;
    bool derived;
};

/* Stores the assigned node in its component. */
static void assign(struct gm_reading *reading, struct gm_entry *entry, const struct gm_target *target,
                   gm_node_id node, void *data)
{
    struct gm_user_system *system = reading->system;
    const struct assignment *assignment = data;
    const enum gm_system_word word = assignment->word;
    const bool is_velocity =
        entry->role == GM_ENTRY_VELOCITY && word == GM_WORD_START && system->kind == GM_LAGRANGIAN;
    if (entry->role == GM_ENTRY_TIME && word == GM_WORD_START && system->kind == GM_EVOLUTION) {
        const struct gm_node *time = &system->graph.nodes[node];
        gm_system_refuse_if(system, time->operation != GM_CONSTANT || !isfinite(time->value),
                            target->value.begin, "the time of the start is a number");
        system->variables[system->n].value = time->value;
        return;
    }
    gm_system_refuse_if(
        system, entry->role == GM_ENTRY_VELOCITY && reading->degenerate, target->name.begin,
        "%.60s follows from the coordinates, as L is linear in the velocities: it has no start", entry->name);
    gm_system_refuse_if(system, entry->role != GM_ENTRY_COMPONENT && !is_velocity, target->name.begin,
                        "%.60s is not a component", entry->name);
    struct gm_system_variable *variable =
        &system->variables[(is_velocity ? system->velocities : 0) + entry->number];
    gm_system_refuse_if(system, gm_system_is_tangent(system, entry->number) && !is_velocity,
                        target->name.begin, "%s is of a tangent, whose start and rate follow from the system",
                        variable->name);
    gm_node_id *place = word == GM_WORD_START   ? &variable->start
                        : word == GM_WORD_FORCE ? &variable->force
                        : word == GM_WORD_EXACT ? &variable->exact
                        : word == GM_WORD_JUMP  ? &variable->jump
                                                : &system->rates[entry->number];
    gm_system_refuse_if(system, word == GM_WORD_FORCE && entry->number >= system->n / 2, target->name.begin,
                        "a force acts on a coordinate, not on %s", variable->name);
    gm_system_refuse_if(system, *place != GM_NO_NODE, target->name.begin, "%s: %s is given twice",
                        gm_system_words[word].word, variable->name);
    *place = node;
    if (word == GM_WORD_START) {
        variable->start_place = target->name.begin;
        variable->low = assignment->range.low;
        variable->high = assignment->range.high;
        variable->derived = assignment->derived;
        variable->meaning = gm_reading_text(reading, assignment->range.meaning);
        variable->unit = gm_reading_text(reading, assignment->range.unit);
    }
}

static void read_assignments(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_span all = line->value, rest = all, piece;
    struct assignment assignment = {.word = (enum gm_system_word)line->word,
                                    .range = {.low = NAN, .high = NAN}};
    const bool ranged = line->word == GM_WORD_START && gm_reading_has_solution(reading);
    if (ranged) {
        rest = take_piece(reading, &all);
        all = gm_span_trimmed(reading->text, all);
        assignment.derived = gm_span_is(reading->text, all, "derived");
        if (!assignment.derived) {
            assignment.range = gm_reading_range(reading, all);
        }
    }
    reading->context.exact = ranged;
    while (gm_span_take(reading->text, &rest, ",", &piece)) {
        const struct gm_target target = gm_reading_assignment(reading, piece);
        if (line->word == GM_WORD_START && reading->system->kind == GM_FIELD &&
            gm_span_is(reading->text, target.name, "X_t")) {
            gm_system_refuse_if(reading->system, reading->system->drift != GM_NO_NODE, target.name.begin,
                                "start: X_t is given twice");
            reading->system->drift = gm_reading_formula(reading, target.value);
            continue;
        }
        gm_reading_elements(reading, &target, assign, &assignment);
    }
    reading->context.exact = false;
}

/* Takes a name, or an element of a list, off the front of `rest`. */
static const struct gm_entry *take_entry(struct gm_reading *reading, struct gm_span *rest)
{
    const struct gm_target target = gm_reading_target(reading, rest);
    const bool indexed = target.index.begin < target.index.end;
    return gm_reading_sought(reading, &target, indexed ? gm_reading_whole(reading, target.index) : 0);
}

/* x y = z */
static void read_bracket(struct gm_reading *reading, struct gm_span piece)
{
    struct gm_user_system *system = reading->system;
    struct gm_span rest = piece;
    size_t pair[2];
    for (int i = 0; i < 2; i++) {
        rest = gm_span_trimmed(reading->text, rest);
        const size_t place = rest.begin;
        const struct gm_entry *entry = take_entry(reading, &rest);
        gm_system_refuse_if(system, entry->role != GM_ENTRY_COMPONENT, place,
                            "a bracket is of two components: bracket: x y = z");
        pair[i] = entry->number;
    }
    rest = gm_span_trimmed(reading->text, rest);
    gm_system_refuse_if(system, rest.begin == rest.end || reading->text[rest.begin] != '=', rest.begin,
                        "= was expected");
    rest.begin++;
    const char *const names[] = {system->variables[pair[0]].name, system->variables[pair[1]].name};
    gm_node_id *entry = &system->bracket[pair[0] * system->n + pair[1]],
               *opposite = &system->bracket[pair[1] * system->n + pair[0]];
    gm_system_refuse_if(system, pair[0] == pair[1], piece.begin, "the bracket of %s with itself is 0",
                        names[0]);
    const gm_node_id node = gm_reading_formula(reading, rest);
    gm_system_refuse_if(system, *entry != GM_NO_NODE, piece.begin, "the bracket of %s and %s is given twice",
                        names[0], names[1]);
    *entry = node;
    system->bracket_place = piece.begin;
    *opposite = gm_negative(&system->graph, node);
}

static void read_brackets(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_span rest = line->value, piece;
    while (gm_span_take(reading->text, &rest, ",", &piece)) {
        read_bracket(reading, piece);
    }
}

static void generate(struct gm_reading *reading, struct gm_entry *entry, const struct gm_target *target,
                     gm_node_id node, void *data)
{
    const struct gm_user_system *system = reading->system;
    struct gm_system_item *item = data;
    gm_system_refuse_if(system, entry->role != GM_ENTRY_COMPONENT || entry->number >= item->count,
                        target->name.begin, "a %s moves %s, not %.60s", gm_system_words[item->word].word,
                        system->kind <= GM_LAGRANGIAN ? "coordinates" : "components", entry->name);
    item->nodes[entry->number] = node;
}

/* symmetry: [name;] x = -y, y = x */
static void read_symmetry(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_user_system *system = reading->system;
    struct gm_span rest = line->value, piece;
    const bool named = gm_span_until(reading->text, rest, ";") < rest.end;
    struct gm_system_item *item =
        gm_reading_item(reading, line, named ? take_piece(reading, &rest) : nameless);
    const size_t size = system->kind <= GM_LAGRANGIAN ? system->n / 2 : system->n;
    for (size_t i = 0; i < size; i++) {
        gm_item_add(reading, item, gm_formula_constant(&system->graph, 0));
    }
    while (gm_span_take(reading->text, &rest, ",", &piece)) {
        const struct gm_target target = gm_reading_assignment(reading, piece);
        gm_reading_elements(reading, &target, generate, item);
    }
}

/* Appends the index of a name as its last digits: length[2] is length2. */
static void number_item(struct gm_reading *reading, struct gm_system_item *item, struct gm_span index)
{
    const long number = gm_reading_whole(reading, index);
    gm_system_refuse_if(reading->system, number < 0, index.begin, "the index of a name is 0 or more, not %ld",
                        number);
    item->name = gm_arena_print(reading->system->arena, "%s%ld", item->name, number);
}

/* NAME = formula; options */
static void read_named(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_user_system *system = reading->system;
    struct gm_span rest = line->value;
    const struct gm_target target = gm_reading_assignment(reading, take_piece(reading, &rest));
    const bool indexed = target.index.begin < target.index.end;
    gm_system_refuse_if(system, indexed && reading->context.repeated.length == 0, target.index.begin,
                        "this name has no index");
    struct gm_system_item *item = gm_reading_item(reading, line, target.name);
    if (indexed) {
        number_item(reading, item, target.index);
    }
    const size_t length = strlen(item->name);
    const bool whole = item->word == GM_WORD_PART && strcmp(item->name, "H") == 0;
    gm_system_refuse_if(system, whole || gm_reading_reserves(item->name, length), target.name.begin,
                        "the name %.60s" GM_RESERVED, item->name);
    const struct gm_entry *named = gm_reading_entry(reading, item->name, length, false, 0);
    if (named && named->place != target.name.begin) {
        gm_reading_refuse_second(reading, target.name.begin, named);
    }
    const bool exact = line->word == GM_WORD_OBSERVE && gm_reading_has_solution(reading);
    gm_item_add(reading, item,
                named   ? named->node
                : exact ? gm_reading_formula_of_exact(reading, target.value)
                        : gm_reading_formula(reading, target.value));
    for (size_t i = 0; i + 1 < system->item_count; i++) {
        const struct gm_system_item *other = &system->items[i];
        if ((gm_system_is_observed(other) || other->word == GM_WORD_PART) &&
            strcmp(other->name, item->name) == 0) {
            gm_system_refuse(system, target.name.begin, "%.60s is given twice", item->name);
        }
    }
    gm_options_read(reading, item, rest);
}

/* part: A = formula, B = formula; of rates: A; x = formula, y = formula */
static void read_part(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_span rest = line->value, piece;
    if (reading->system->kind != GM_RATES) {
        while (gm_span_take(reading->text, &rest, ",", &piece)) {
            read_named(reading, &(struct gm_read_line){line->word, line->place, piece});
        }
        return;
    }
    gm_system_refuse_if(reading->system, gm_span_until(reading->text, rest, ";") == rest.end, rest.end,
                        "a part of rates is a name, a semicolon and its rates");
    read_symmetry(reading, line);
}

/* require: F; sentence */
static void read_requirement(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_span rest = line->value;
    const struct gm_span formula = take_piece(reading, &rest);
    struct gm_system_item *item = gm_reading_item(reading, line, nameless);
    rest = gm_span_trimmed(reading->text, rest);
    gm_system_refuse_if(reading->system, rest.begin == rest.end, formula.end,
                        "a sentence was expected: %s: F; it says why not", word_of(line));
    add_formula(reading, item, formula);
    gm_text_read(reading, item, rest);
}

/* level: [section;] F; text; options */
static void read_level(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_span rest = line->value, piece = take_piece(reading, &rest);
    struct gm_system_item *item = gm_reading_item(reading, line, nameless);
    item->in_section = gm_span_is(reading->text, piece, "section");
    if (item->in_section) {
        piece = take_piece(reading, &rest);
    }
    gm_system_refuse_if(reading->system, item->in_section && !gm_reading_line(reading, GM_WORD_SECTION),
                        line->value.begin, "there is no line \"section\"");
    gm_item_add(reading, item, gm_reading_formula_of_exact(reading, piece));
    if (!gm_span_take(reading->text, &rest, ";", &piece)) {
        gm_system_refuse(reading->system, piece.end, "a text was expected: level: F; the exact orbit");
    }
    item->text = gm_reading_text(reading, piece);
    gm_options_read(reading, item, rest);
}

/* Takes the next piece as words key=value. */
static char *take_words(struct gm_reading *reading, struct gm_span *rest)
{
    const struct gm_span piece = take_piece(reading, rest);
    char *words = gm_reading_text(reading, piece);
    const bool none = strcmp(words, "none") == 0;
    for (const char *word = words; *word && !none; word += strcspn(word, " "), word += *word == ' ') {
        gm_system_refuse_if(reading->system, strcspn(word, "=") >= strcspn(word, " "), piece.begin,
                            "%.60s is not of the form key=value: until=100", word);
    }
    return words;
}

/* graph: KEY; options, figure: NAME; WORDS; statement, work: WORDS; options, stability: WORDS; KEY values; options */
static void read_optional(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_span rest = line->value;
    const bool named = line->word == GM_WORD_GRAPH || line->word == GM_WORD_FIGURE;
    struct gm_system_item *item =
        gm_reading_item(reading, line, named ? take_piece(reading, &rest) : nameless);
    if (line->word != GM_WORD_GRAPH) {
        item->words = take_words(reading, &rest);
    }
    if (line->word != GM_WORD_FIGURE) {
        gm_options_read(reading, item, rest);
        return;
    }
    rest = gm_span_trimmed(reading->text, rest);
    item->text = gm_reading_text(reading, rest);
    gm_system_refuse_if(reading->system, rest.begin == rest.end, rest.begin,
                        "a statement was expected: figure: NAME; scheme=rk4; what it shows");
}

static gm_node_id difference(struct gm_formula *graph, gm_node_id left, gm_node_id right)
{
    return gm_is_constant(graph, right, 0) ? left
                                           : gm_formula_apply(graph, GM_OPERATION_SUBTRACT, left, right);
}

/* Adds g - h of g = h, where an event happens or a section is. */
static void add_surface(struct gm_reading *reading, struct gm_system_item *item, struct gm_span surface,
                        const char *sentence)
{
    const size_t equals = gm_span_until(reading->text, surface, "=");
    gm_system_refuse_if(reading->system, equals == surface.end, surface.begin, "%s", sentence);
    const gm_node_id left = gm_reading_formula(reading, gm_reading_between(reading, surface.begin, equals)),
                     right =
                         gm_reading_formula(reading, gm_reading_between(reading, equals + 1, surface.end));
    gm_item_add(reading, item, difference(&reading->system->graph, left, right));
}

/* Sets the value of a component after an event. */
static void replace(struct gm_reading *reading, struct gm_entry *entry, const struct gm_target *target,
                    gm_node_id node, void *data)
{
    const struct gm_user_system *system = reading->system;
    struct gm_system_item *item = data;
    gm_system_refuse_if(
        system, entry->role == GM_ENTRY_PARAMETER, target->name.begin,
        "%.60s is a parameter, which no event changes: a component with rate: %.60s = 0 is a memory",
        entry->name, entry->name);
    gm_system_refuse_if(
        system, entry->role != GM_ENTRY_COMPONENT, target->name.begin, "an event changes %s, not %.60s",
        system->kind <= GM_LAGRANGIAN ? "coordinates and momenta" : "components", entry->name);
    gm_system_refuse_if(system, gm_system_is_tangent(system, entry->number), target->name.begin,
                        "%.60s is of a tangent, whose change follows from the event", entry->name);
    gm_node_id *after = &item->nodes[1 + entry->number];
    gm_system_refuse_if(system, *after != gm_formula_variable(&reading->system->graph, entry->number),
                        target->name.begin, "%.60s is changed twice by this event", entry->name);
    *after = node;
}

/* The first event of that name, or NULL. */
static const struct gm_system_item *event_named(const struct gm_user_system *system, const char *name)
{
    const struct gm_system_item *event;
    size_t i = 0;
    while ((event = gm_system_item_of(system, GM_WORD_EVENT, i)) && strcmp(event->name, name) != 0) {
        i++;
    }
    return event;
}

/* Returns true if an event gives some component another value than it has where g is 0. */
static bool changes(const struct gm_system_item *event, struct gm_user_system *system)
{
    struct gm_formula *graph = &system->graph;
    bool other = false;
    for (size_t i = 0; i < system->n; i++) {
        const gm_node_id before = gm_formula_variable(graph, i), after = event->nodes[1 + i];
        other = other || (after != before && difference(graph, before, after) != event->nodes[0] &&
                          difference(graph, after, before) != event->nodes[0]);
    }
    return other;
}

/* event: [name;] g = h, conditions; x = F, y = G   or   ...; stop */
static void read_event(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_user_system *system = reading->system;
    struct gm_span rest = line->value, piece = take_piece(reading, &rest), name = nameless, surface;
    const char *const text = reading->text;
    const struct gm_read_line *held = gm_reading_line(reading, GM_WORD_CONSTRAINT);
    gm_system_refuse_if(system, held, line->place,
                        "an event does not go together with a line \"constraint\"");
    if (gm_name_length(text + piece.begin, piece.end - piece.begin) == piece.end - piece.begin &&
        gm_span_until(text, rest, ";") < rest.end) {
        name = piece;
        piece = take_piece(reading, &rest);
    }
    struct gm_system_item *item = gm_reading_item(reading, line, name);
    gm_system_refuse_if(system, item->name[0] && event_named(system, item->name) != item, name.begin,
                        "the event %.60s is given twice", item->name);
    gm_span_take(text, &piece, ",", &surface);
    add_surface(
        reading, item, surface,
        "an event needs an =, where it happens: event: q = 0; p = -p, or with a name event: hit; q = 0; p = -p");
    rest = gm_span_trimmed(text, rest);
    gm_system_refuse_if(system, rest.begin == rest.end, surface.end,
                        "what happens is missing: event: q = 0; p = -p, or event: q = 0; stop");
    item->ends = gm_span_is(text, rest, "stop");
    for (size_t i = 0; i < system->n && !item->ends; i++) {
        gm_item_add(reading, item, gm_formula_variable(&system->graph, i));
    }
    struct gm_span change;
    while (!item->ends && gm_span_take(text, &rest, ",", &change)) {
        const struct gm_target target = gm_reading_assignment(reading, change);
        gm_reading_elements(reading, &target, replace, item);
    }
    gm_system_refuse_if(
        system, !item->ends && !changes(item, system), rest.begin,
        "this event changes nothing: its components have these values there; p = -p turns a motion "
        "back, stop ends it");
    while (gm_span_take(text, &piece, ",", &surface)) {
        gm_item_add(reading, item, gm_reading_condition(reading, surface));
    }
}

/* stop: g, the event g = 0 that ends the run */
static void read_stop(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_system_item *item = gm_reading_item(reading, line, nameless);
    item->ends = true;
    add_formula(reading, item, line->value);
}

/* section: y = 0, p_y > 0; x, p_x   or   section: every T; x, p_x   or   section: at EVENT; x, p_x */
static void read_section(struct gm_reading *reading, const struct gm_read_line *line)
{
    const char *text = reading->text;
    struct gm_span rest = line->value, where = take_piece(reading, &rest), condition, piece;
    struct gm_system_item *item = gm_reading_item(reading, line, nameless);
    item->periodic = where.end - where.begin > 6 && memcmp(text + where.begin, "every ", 6) == 0;
    where.begin += item->periodic ? 6 : 0;
    item->at_event = where.end - where.begin > 3 && memcmp(text + where.begin, "at ", 3) == 0;
    gm_span_take(text, &where, ",", &condition);
    if (item->at_event) {
        condition.begin += 3;
        item->name = gm_reading_text(reading, gm_span_trimmed(text, condition));
    }
    if (item->periodic || item->at_event) {
        gm_item_add(reading, item,
                    item->at_event ? gm_formula_constant(&reading->system->graph, 0)
                                   : gm_reading_formula(reading, condition));
    } else {
        add_surface(reading, item, condition, "a section is where g = h, as x = 0, or every T, or at EVENT");
    }
    const double period = item->periodic ? gm_reading_number(reading, condition) : 1;
    gm_system_refuse_if(reading->system, !(period > 0), condition.begin,
                        "the time between two looks is %g, and has to be above 0", period);
    const struct gm_span shown = take_piece(reading, &rest);
    gm_item_add_formulas(reading, item, shown);
    gm_system_refuse_if(reading->system, item->count != 3, shown.begin,
                        "a section shows two values: ; x, p_x");
    rest = gm_span_trimmed(text, rest);
    item->alone = gm_span_is(text, rest, "alone");
    gm_system_refuse_if(reading->system, rest.begin < rest.end && !item->alone, rest.begin,
                        "\"alone\" was expected: the section is the usual picture");
    while (gm_span_take(text, &where, ",", &piece)) {
        gm_item_add(reading, item, gm_reading_condition(reading, piece));
    }
}

/* The number of coordinates of a body or of the ends of a rod; 0 for another item. */
static size_t dimensions_of(const struct gm_system_item *item)
{
    return item->word == GM_WORD_VIEW ? item->count : item->word == GM_WORD_ROD ? item->count / 2 : 0;
}

/* Reads one body, or both ends of a rod, in two or three dimensions. */
static void read_view(struct gm_reading *reading, const struct gm_read_line *line)
{
    const struct gm_user_system *system = reading->system;
    struct gm_system_item *item = gm_reading_item(reading, line, nameless);
    struct gm_span rest = line->value;
    const size_t ends = line->word == GM_WORD_ROD ? 2 : 1;
    gm_item_add_formulas(reading, item, take_piece(reading, &rest));
    const size_t dimensions = item->count;
    if (ends == 2) {
        gm_item_add_formulas(reading, item, take_piece(reading, &rest));
    }
    gm_system_refuse_if(system, item->count != ends * dimensions || dimensions < 2 || dimensions > 3,
                        line->value.begin,
                        line->word == GM_WORD_ROD ? "a rod has two ends: 0, 0; x, y"
                                                  : "a body has two or three coordinates: x, y");
    gm_options_read(reading, item, rest);
    for (size_t i = 0; i + 1 < system->item_count; i++) {
        const size_t of_other = dimensions_of(&system->items[i]);
        gm_system_refuse_if(system, of_other > 0 && of_other != dimensions, line->value.begin,
                            "%zu coordinate%s, and those of the lines before are %zu", dimensions,
                            gm_plural((double)dimensions), of_other);
    }
}

/* surface: sphere; r   or   surface: ellipsoid; a, b, c */
static void read_surface(struct gm_reading *reading, const struct gm_read_line *line)
{
    static const char *const shapes[] = {"sphere", "ellipsoid", NULL};
    struct gm_span rest = line->value;
    struct gm_system_item *item = gm_reading_item(reading, line, nameless);
    const struct gm_span word = take_piece(reading, &rest);
    const size_t shape = gm_span_among(reading->text, word, shapes);
    const bool sphere = shape == 0;
    gm_system_refuse_if(reading->system, !shapes[shape], word.begin,
                        "a surface is a sphere or an ellipsoid: sphere; 1");
    rest = gm_span_trimmed(reading->text, rest);
    gm_item_add_formulas(reading, item, rest);
    gm_system_refuse_if(reading->system, item->count != (sphere ? 1 : 3), rest.begin,
                        sphere ? "a sphere has one radius: sphere; 1"
                               : "an ellipsoid has three half axes: ellipsoid; 1, 2, 3");
    while (item->count < 3) {
        gm_item_add(reading, item, item->nodes[0]);
    }
}

/* A section may be at an event that has this name. */
static void check_section(const struct gm_user_system *system)
{
    const struct gm_system_item *section = gm_system_item_of(system, GM_WORD_SECTION, 0);
    if (section && section->at_event && !event_named(system, section->name)) {
        gm_system_refuse(system, section->place, "there is no event %.60s: event: %.60s; q = 0; p = -p",
                         section->name, section->name);
    }
}

/* The keys of a camera are reserved in space, and never a choice; surfaces need space. */
static void check_space(struct gm_reading *reading)
{
    static const char *const keys[] = {"azimuth", "elevation", "zoom", "turn"};
    static const char taken[] = "the name %s is reserved: it is how a system in space is looked at";
    const struct gm_user_system *system = reading->system;
    bool in_space = false;
    for (size_t i = 0; i < system->item_count; i++) {
        in_space |= dimensions_of(&system->items[i]) == 3;
    }
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        gm_system_refuse_if(system, item->word == GM_WORD_SURFACE && !in_space, item->place,
                            "a surface needs bodies in space: view: x, y, z");
        for (size_t k = 0; k < GM_COUNT(keys) && in_space; k++) {
            gm_system_refuse_if(system, strcmp(item->name, keys[k]) == 0, item->place, taken, keys[k]);
        }
    }
    for (size_t k = 0; k < GM_COUNT(keys); k++) {
        const struct gm_entry *entry = gm_reading_entry(reading, keys[k], strlen(keys[k]), false, 0);
        if (entry && (in_space || entry->role == GM_ENTRY_CHOICE)) {
            gm_system_refuse(system, entry->place, taken, keys[k]);
        }
    }
}

static void read_angles(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_user_system *system = reading->system;
    for (struct gm_span rest = line->value; rest.begin < rest.end;
         rest = gm_span_trimmed(reading->text, rest)) {
        const size_t place = rest.begin;
        if (reading->text[rest.begin] == ',') {
            rest.begin++;
            continue;
        }
        const struct gm_entry *entry = take_entry(reading, &rest);
        gm_system_refuse_if(system,
                            entry->role != GM_ENTRY_COMPONENT ||
                                (system->kind != GM_RATES && entry->number >= system->n / 2),
                            place, "an angle is one of the coordinates");
        system->variables[entry->number].angle = true;
    }
}

/* F; options */
static void read_weight(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_span rest = line->value;
    struct gm_system_item *item = gm_reading_item(reading, line, nameless);
    add_formula(reading, item, take_piece(reading, &rest));
    gm_options_read(reading, item, rest);
}

/* Reads a number of a ring: half its length, the points of its grid, the jump of the field at its ends. */
static void read_ring(struct gm_reading *reading, const struct gm_read_line *line)
{
    static const struct {
        double low, high;
        const char *printed;
    } ranges[] = {{0.01, 1e5, "a number from 0.01 to 1e5"},
                  {3, 1e7, "a whole number from 3 to 1e7"},
                  {-1e6, 1e6, "a number"}};
    const size_t row = line->word - GM_WORD_HALF_LENGTH;
    struct gm_span rest = line->value;
    const double number = gm_reading_number(reading, take_piece(reading, &rest));
    gm_system_refuse_if(reading->system,
                        !(number >= ranges[row].low && number <= ranges[row].high) ||
                            (line->word == GM_WORD_POINTS && number != floor(number) &&
                             !gm_system_points_follow(reading->system)),
                        line->value.begin, "%s is %g, and has to be %s", word_of(line), number,
                        ranges[row].printed);
    read_weight(reading, line);
}

struct gm_span gm_mesh_begin(struct gm_reading *reading, const struct gm_read_line *line,
                             struct gm_mesh_line *mesh)
{
    *mesh = (struct gm_mesh_line){.options = line->value};
    gm_span_take(reading->text, &mesh->options, ";", &mesh->numbers);
    return gm_reading_word(reading, &mesh->numbers);
}

bool gm_mesh_next(struct gm_reading *reading, struct gm_mesh_line *mesh)
{
    static const char *const names[GM_MESH_NUMBERS + 1] = {"width", "height", "edges", "strips", "irregular"};
    if (mesh->numbers.begin < mesh->numbers.end) {
        mesh->value = gm_reading_word(reading, &mesh->numbers);
        mesh->number = mesh->count++;
        return true;
    }
    if (!gm_span_take(reading->text, &mesh->options, ";", &mesh->value)) {
        return false;
    }
    struct gm_span value = mesh->value;
    mesh->number = gm_span_among(reading->text, gm_reading_word(reading, &value), names);
    mesh->value = mesh->number < GM_MESH_NUMBERS ? value : mesh->value;
    return true;
}

/* mesh: sphere 1 level: a word, and numbers separated by blanks, which may be formulas without blanks; a rectangle's
   may have their names */
static void read_generator(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_mesh_line mesh;
    struct gm_system_item *item = gm_reading_item(reading, line, gm_mesh_begin(reading, line, &mesh));
    struct gm_span numbers[GM_MESH_NUMBERS] = {{0, 0}};
    const bool named = mesh.options.begin < mesh.options.end;
    size_t count = 0;
    while (gm_mesh_next(reading, &mesh)) {
        gm_system_refuse_if(
            reading->system,
            mesh.number >= GM_MESH_NUMBERS ||
                (named && strcmp(item->name, "rectangle") != 0 && strcmp(item->name, "flat-torus") != 0),
            mesh.value.begin,
            "a mesh has at most five numbers, and a rectangle alone names them: width, "
            "height, edges, strips, irregular");
        numbers[mesh.number] = mesh.value;
        count = mesh.number >= count ? mesh.number + 1 : count;
    }
    for (size_t i = 0; i < count; i++) { /* what lies between is 0 */
        if (numbers[i].begin < numbers[i].end) {
            add_formula(reading, item, numbers[i]);
        } else {
            gm_item_add(reading, item, gm_formula_constant(&reading->system->graph, 0));
        }
    }
}

static void read_text(struct gm_reading *reading, const struct gm_read_line *line)
{
    reading->system->texts[line->word] = gm_reading_text(reading, line->value);
}

/* equation: NAME; left = right */
static void read_equation(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_user_system *system = reading->system;
    struct gm_span rest = line->value;
    const struct gm_span name = take_piece(reading, &rest);
    const struct gm_entry *entry = gm_reading_named(reading, name);
    rest = gm_span_trimmed(reading->text, rest);
    const size_t equals = gm_span_until(reading->text, rest, "=");
    gm_system_refuse_if(system,
                        !entry || entry->role != GM_ENTRY_COMPONENT || !system->forms[entry->number].unknown,
                        name.begin, "an equation begins with its unknown, as in equation: u; laplace(u) = 0");
    struct gm_form_declared *form = &system->forms[entry->number];
    gm_system_refuse_if(system, form->left != GM_NO_NODE, name.begin, "%s has two equations", entry->name);
    gm_system_refuse_if(system, equals == rest.end, rest.begin, "= was expected");
    form->equation = rest.begin;
    form->left = gm_reading_formula(reading, (struct gm_span){rest.begin, equals});
    form->right = gm_reading_formula(reading, (struct gm_span){equals + 1, rest.end});
}

/* Reads rows separated by |, with commas between entries. */
static void read_matrix(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_user_system *system = reading->system;
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
                system->matrices[at] = gm_reading_formula(reading, entry);
            }
        }
        gm_system_refuse_if(system, columns != n, begin, "row %zu of %s has %zu entries for %zu components",
                            rows + 1, word_of(line), columns, n);
    }
    gm_system_refuse_if(system, rows != n, line->value.begin, "%s has %zu rows for %zu components",
                        word_of(line), rows, n);
}

bool gm_system_locates_breaks(const struct gm_user_system *system)
{
    return gm_choice_named(&system->choices, GM_BREAKS_KEY) && !system->ignores_breaks;
}

const char *const *gm_system_choices(enum gm_system_word word)
{
    enum { MOST = 6 };
    static const char *const words[GM_WORDS][MOST] = {
        [GM_WORD_SPACE] = {"differences", "fourier"},
        [GM_WORD_BOUNDARY] = {"ring", "walls"},
        [GM_WORD_STAR] = {"auto", "circumcentric", "barycentric", "galerkin", "incentric"},
        [GM_WORD_INTERIOR] = {"dual", "whitney", "upwind"}};
    return words[word];
}

size_t gm_system_chosen(const struct gm_user_system *system, enum gm_system_word word)
{
    const char *text = system->texts[word], *const *among = gm_system_choices(word);
    size_t k = 0;
    while (text && among[k] && strcmp(among[k], text) != 0) {
        k++;
    }
    return k;
}

/* Reads one of a few words. */
static void read_choice(struct gm_reading *reading, const struct gm_read_line *line)
{
    const char *const *among = gm_system_choices(line->word);
    read_text(reading, line);
    const bool wrong = !among[gm_system_chosen(reading->system, line->word)];
    gm_system_refuse_if(reading->system, wrong && among[2], line->value.begin, "%s: is %s", word_of(line),
                        line->word == GM_WORD_STAR ? "auto, circumcentric, barycentric, galerkin or incentric"
                                                   : "dual, whitney or upwind");
    gm_system_refuse_if(reading->system, wrong, line->value.begin, "%s is %s or %s, not %.60s", word_of(line),
                        among[0], among[1], reading->system->texts[line->word]);
}

/* Reads a graph for compiled kernels: `yes`, the graph of the file; N = 3 .. 5, for a parameter in an index;
   or KEY = VALUE, with that value of the parameter. */
static void read_compiled(struct gm_reading *reading, const struct gm_read_line *line, struct gm_span piece)
{
    struct gm_user_system *system = reading->system;
    const size_t equals = gm_span_until(reading->text, piece, "=");
    const struct gm_span name = gm_reading_between(reading, piece.begin, equals),
                         value = {equals + 1, piece.end};
    const struct gm_entry *entry = gm_reading_named(reading, name);
    long low, high;
    if (equals == piece.end && gm_span_is(reading->text, name, "yes")) {
        return;
    }
    if (equals < piece.end && entry && entry->role == GM_ENTRY_CHOICE) {
        struct gm_written_choices tried = system->choices;
        const char *word = gm_reading_text(reading, value);
        gm_system_refuse_if(system, !gm_choices_take(&tried, entry->name, word), piece.begin,
                            "compile: %s has no word %.60s", entry->name, word);
        return;
    }
    gm_system_refuse_if(system, equals == piece.end || !entry || entry->role != GM_ENTRY_PARAMETER,
                        piece.begin, "compile: says yes, or gives values to a parameter, as in N = 3 .. 5");
    const size_t variable = system->parameters + entry->number;
    if (!gm_reading_bounds(reading, value, "graphs", &low, &high)) {
        const double number = gm_reading_number(reading, value);
        struct gm_system_item *item = gm_reading_item(reading, line, name);
        item->value = number;
        item->variable = variable;
    }
}

static void read_compile(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_span rest = line->value, piece;
    while (gm_span_take(reading->text, &rest, ";", &piece)) {
        read_compiled(reading, line, piece);
    }
}

/* F; scale: the least divisor of its error */
static void read_energy(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_span rest = line->value;
    const struct gm_span energy = take_piece(reading, &rest);
    rest = gm_span_trimmed(reading->text, rest);
    if (rest.begin < rest.end) {
        gm_options_read(reading, gm_reading_item(reading, line, nameless), rest);
    }
    reading->system->energy = gm_reading_formula(reading, energy);
}

/* Takes the name of a key off the front of NAME = F; an empty one without it. */
static struct gm_span take_key(struct gm_reading *reading, struct gm_span *value)
{
    if (gm_span_until(reading->text, *value, "=") == value->end) {
        return nameless;
    }
    const struct gm_target target = gm_reading_assignment(reading, *value);
    const char *name = reading->text + target.name.begin;
    const size_t length = target.name.end - target.name.begin;
    *value = target.value;
    gm_system_refuse_if(reading->system,
                        target.index.begin < target.index.end || gm_reading_reserves(name, length) ||
                            gm_reading_named(reading, target.name),
                        target.name.begin, "the name %.*s is taken", gm_brief_length(length), name);
    return target.name;
}

/* F; low .. high; meaning; of members and spread also KEY = F */
static void read_timing(struct gm_reading *reading, const struct gm_read_line *line)
{
    const bool counts = line->word == GM_WORD_MEMBERS, spreads = line->word == GM_WORD_SPREAD;
    struct gm_span rest = line->value, value = take_piece(reading, &rest);
    const struct gm_span key = counts || spreads ? take_key(reading, &value) : nameless;
    const double number = gm_reading_number(reading, value);
    const struct gm_written_range range = gm_reading_range(reading, rest);
    gm_system_refuse_if(reading->system,
                        !(isfinite(number) && (line->word == GM_WORD_DT ? number > 0 : number >= 0)),
                        value.begin, "%s is %g, and has to be %s", word_of(line), number,
                        line->word == GM_WORD_DT ? "above 0" : "0 or more");
    gm_system_refuse_if(reading->system,
                        (counts && (number < 1 || number != floor(number))) ||
                            ((counts || spreads) && number > 1e6),
                        value.begin, "%s is %g, and has to be a %s to 1e6", word_of(line), number,
                        counts ? "whole number from 1" : "number from 0");
    gm_system_refuse_if(reading->system, number < range.low || number > range.high, value.begin,
                        "%s is %g, and its range is from %g to %g", word_of(line), number, range.low,
                        range.high);
    reading->system->texts[line->word] = gm_reading_text(reading, value);
    struct gm_system_item *item = gm_reading_item(reading, line, key);
    add_formula(reading, item, value);
    item->value = number;
    item->low = range.low;
    item->high = range.high;
    item->text = gm_reading_text(reading, range.meaning);
}

/* dt = KEY*F: either of the step and a parameter follows from the other; F has no such parameter. */
static void read_tie(struct gm_reading *reading, const struct gm_read_line *line)
{
    const char *text = reading->text;
    const size_t equals = gm_span_until(text, line->value, "="), end = line->value.end;
    const struct gm_span step = gm_reading_between(reading, line->value.begin, equals),
                         product = gm_reading_between(reading, equals + (equals < end), end);
    const size_t times = product.begin + gm_name_length(text + product.begin, product.end - product.begin);
    const struct gm_span key = {product.begin, times};
    const struct gm_entry *entry = gm_reading_named(reading, key);
    gm_system_refuse_if(reading->system,
                        !gm_span_is(text, step, "dt") || times >= product.end || text[times] != '*' ||
                            !entry || entry->role != GM_ENTRY_PARAMETER,
                        line->value.begin,
                        "tie: is the step as a multiple of a parameter, as in dt = courant*dx");
    const size_t variable = reading->system->parameters + entry->number;
    struct gm_system_item *item = gm_reading_item(reading, line, key);
    item->variable = variable;
    add_formula(reading, item, (struct gm_span){times + 1, product.end});
}

/* geomint: 1 */
static void read_version(struct gm_reading *reading, const struct gm_read_line *line)
{
    const double number = gm_reading_number(reading, line->value);
    gm_system_refuse_if(reading->system, number != 1, line->value.begin,
                        "this program reads files of format 1, not %g", number);
}

/* mesh: a triangulation of forms, or X = F of a field */
static void read_mesh(struct gm_reading *reading, const struct gm_read_line *line)
{
    (gm_system_is_form(reading->system) ? read_generator : read_text)(reading, line);
}

/* Reads a text that may contain values. */
static void read_shown_text(struct gm_reading *reading, const struct gm_read_line *line)
{
    read_text(reading, line);
    struct gm_system_item *item = gm_reading_item(reading, line, nameless);
    gm_text_read(reading, item, line->value);
    gm_system_refuse_if(reading->system,
                        line->word == GM_WORD_TITLE && item->count > 0 &&
                            !gm_reading_line(reading, GM_WORD_NAME),
                        line->place, "a title with values needs a line \"name\" for lists");
}

/* Refuses a let whose formula another let has as well: both are one node, and would have one boundary. */
static void refuse_twin(struct gm_reading *reading, const struct gm_entry *let, size_t place)
{
    for (size_t i = 0; i < reading->entry_count; i++) {
        const struct gm_entry *other = &reading->entries[i];
        gm_system_refuse_if(
            reading->system, other != let && other->role == GM_ENTRY_NAMED && other->node == let->node, place,
            "%.*s has the same formula, so it would get this boundary, too: use one let for both",
            gm_brief_length(other->length), reading->text + other->place);
    }
}

/* boundary: PART NAME = formula, of forms */
static void read_held(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_span rest = line->value;
    const struct gm_span part = gm_reading_word(reading, &rest);
    const struct gm_target target = gm_reading_assignment(reading, rest);
    const struct gm_entry *entry = gm_reading_sought(reading, &target, 0);
    struct gm_system_item *item = gm_reading_item(reading, line, part);
    reading->along = true;
    add_formula(reading, item, target.value);
    reading->along = false;
    item->variable = entry->number;
    if (entry->role == GM_ENTRY_NAMED) {
        refuse_twin(reading, entry, target.name.begin);
        gm_item_add(reading, item, entry->node);
    } else if (entry->role != GM_ENTRY_COMPONENT) {
        gm_system_refuse(reading->system, target.name.begin,
                         "a boundary is given for a form: a field, an unknown or a let");
    }
}

static void read_boundary(struct gm_reading *reading, const struct gm_read_line *line)
{
    if (gm_system_is_form(reading->system)) {
        read_held(reading, line);
        return;
    }
    gm_system_refuse_if(reading->system, reading->system->texts[GM_WORD_BOUNDARY], line->place,
                        "boundary is given twice");
    read_choice(reading, line);
}

static void read_jump(struct gm_reading *reading, const struct gm_read_line *line)
{
    (reading->system->kind == GM_MATRICES ? read_assignments : read_ring)(reading, line);
}

/* Reads L, V or S. The text is left at an L that is linear in the velocities, unless that is known. */
static void read_function(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_user_system *system = reading->system;
    system->energy = gm_reading_formula(reading, line->value);
    if (system->kind != GM_LAGRANGIAN) {
        return;
    }
    const size_t mark = gm_arena_mark(system->arena);
    bool *marked = gm_arena_take(system->arena, system->variable_count, sizeof *marked);
    memset(marked + system->velocities, true, system->n / 2 * sizeof *marked);
    reading->degenerate = gm_is_affine(&system->graph, system->energy, marked, system->variable_count);
    gm_system_need_graph(system);
    if (reading->degenerate) {
        gm_arena_leave(system->arena);
    }
    gm_arena_release(system->arena, mark);
}

static void read_formula(struct gm_reading *reading, const struct gm_read_line *line)
{
    add_formula(reading, gm_reading_item(reading, line, nameless), line->value);
}

/* The values at both ends, of the colours or of the line. */
static void read_pair(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_system_item *item = gm_reading_item(reading, line, nameless);
    gm_item_add_formulas(reading, item, line->value);
    gm_system_refuse_if(reading->system, item->count != 2, line->value.begin,
                        "%s: are two values, as in %s: -1, 1", word_of(line), word_of(line));
}

/* Names were read before. */
static void read_declared(struct gm_reading *reading, const struct gm_read_line *line)
{
    (void)reading;
    (void)line;
}

static void (*const readers[GM_WORDS])(struct gm_reading *reading, const struct gm_read_line *line) = {
#define GM_WORD(constant, word, identity, kinds, reader) read_##reader,
#include "core/model/words.def"
#undef GM_WORD
};

/* Reads i = low .. high; line, for each i in turn. A line without a counter is read once. */
static void read_counted(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_span rest = line->value;
    const size_t name = gm_name_length(reading->text + rest.begin, rest.end - rest.begin);
    const struct gm_span head = take_piece(reading, &rest);
    long low = 0, high = 0;
    const size_t equals = gm_span_until(reading->text, head, "=");
    const struct gm_span counter = gm_reading_between(reading, head.begin, equals),
                         bounds = gm_reading_between(reading, equals + 1, head.end);
    if (gm_system_words[line->word].identity == GM_LINE_ONCE || head.end == line->value.end ||
        equals == head.end || name == 0 || counter.end != counter.begin + name ||
        gm_span_until(reading->text, bounds, "..") == bounds.end) {
        if (!(reading->line && reading->line(reading, line))) {
            readers[line->word](reading, line);
        }
        return;
    }
    gm_system_refuse_if(reading->system, gm_reading_named(reading, counter), counter.begin,
                        "%.*s is a name of the system: an index is another one", gm_brief_length(name),
                        reading->text + counter.begin);
    gm_reading_bounds(reading, bounds, "values of an index", &low, &high);
    const struct gm_read_line one = {line->word, line->place, gm_span_trimmed(reading->text, rest)};
    struct gm_index *repeated = &reading->context.repeated;
    *repeated = (struct gm_index){reading->text + counter.begin, name, low};
    for (; repeated->value <= high; repeated->value++) {
        readers[line->word](reading, &one);
    }
    repeated->length = 0;
}

/* Gives the names of lets to nodes without a name. */
static void name_parts(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    system->part_count = system->graph.count;
    system->parts = gm_arena_take(system->arena, system->part_count + (size_t)1, sizeof *system->parts);
    for (size_t i = 0; i < reading->entry_count; i++) {
        const struct gm_entry *entry = &reading->entries[i];
        if (entry->role != GM_ENTRY_NAMED) {
            continue;
        }
        const struct gm_read_line line = {GM_WORD_LET, entry->place, entry->value};
        struct gm_system_item *item =
            gm_reading_item(reading, &line, (struct gm_span){entry->place, entry->place + entry->length});
        if (entry->indexed) {
            item->name = gm_arena_print(system->arena, "%s[%ld]", item->name, entry->index);
        }
        gm_item_add(reading, item, entry->node);
        if (system->graph.nodes[entry->node].operation > GM_VARIABLE) {
            system->parts[entry->node] = item->name;
        }
    }
}

enum { MOST_OF_BRACKET = 2000 }; /* limits the size of the matrix of nodes */

/* A field without a start starts with its exact solution. */
static void start_exactly(struct gm_user_system *system)
{
    gm_node_id *values = gm_system_no_nodes(system, system->variable_count);
    values[system->n] = gm_formula_constant(&system->graph, system->variables[system->n].value);
    for (size_t i = 0; i < system->n; i++) {
        const bool is_rate = system->kind == GM_FIELD && i == 1;
        gm_node_id node = system->variables[is_rate ? 0 : i].exact, *start = &system->variables[i].start;
        if (*start != GM_NO_NODE || node == GM_NO_NODE) {
            continue;
        }
        node = is_rate ? gm_system_derivative(system, node, system->n) : node;
        gm_system_need_graph(system);
        gm_formula_substitute(&system->graph, &node, 1, values, system->variable_count);
        gm_system_need_graph(system);
        *start = node;
    }
}

/* True if a tangent starts along a component: the first along the first coordinate, the next along its momentum. */
static bool is_along(const struct gm_user_system *system, size_t component, size_t tangent)
{
    const size_t half = gm_system_motion(system) / 2, k = tangent - 1;
    return component == (system->kind == GM_CANONICAL ? k % 2 * half + k / 2 : k);
}

/* Moves the formulas of forms to their declarations. Fields have a rate and a start, unknowns an equation. */
static void complete_forms(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    bool started = false;
    for (size_t i = 0; i < system->n; i++) {
        struct gm_form_declared *form = &system->forms[i];
        struct gm_system_variable *variable = &system->variables[i];
        const bool lacks_rate = system->rates[i] == GM_NO_NODE, lacks_equation = form->left == GM_NO_NODE;
        form->start = variable->start != GM_NO_NODE ? variable->start : variable->exact;
        form->exact = variable->exact;
        variable->start = variable->exact = GM_NO_NODE;
        gm_system_refuse_if(system, form->unknown ? lacks_equation || !lacks_rate : lacks_rate, form->place,
                            "%s has no %s", variable->name,
                            !form->unknown   ? "rate"
                            : lacks_equation ? "equation"
                                             : "rate: it is an unknown");
        started |= form->start != GM_NO_NODE;
    }
    for (size_t i = 0; i < system->n; i++) { /* what is not given is 0, if something is given */
        struct gm_form_declared *form = &system->forms[i];
        gm_system_refuse_if(system, !form->unknown && !started, form->place, "%s has no value at the start",
                            system->variables[i].name);
        form->start = form->start == GM_NO_NODE ? gm_formula_constant(&system->graph, 0) : form->start;
    }
}

/* Starts of tangents and of fields that have none, brackets that are 0; every rate and every start is given. */
static void complete(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    const gm_node_id zero = gm_formula_constant(&system->graph, 0);
    const bool rates = system->kind == GM_RATES || system->kind == GM_EVOLUTION;
    const struct gm_read_line *start = gm_reading_line(reading, GM_WORD_START);
    if (gm_system_is_field(system)) {
        start_exactly(system);
    }
    if (system->alone) {
        system->energy = system->variables[0].start = system->variables[1].start = zero;
        gm_system_refuse_if(system, system->drift == GM_NO_NODE, start ? start->value.begin : reading->length,
                            "the nodes have no velocity at the start, as in start: X_t = exp(-x^2)");
    }
    for (size_t k = 1; k <= system->tangents; k++) {
        for (size_t c = 0; c < gm_system_motion(system); c++) {
            struct gm_system_variable *variable = &system->variables[gm_system_component(system, c, k)];
            variable->start = gm_formula_constant(&system->graph, is_along(system, c, k));
            variable->derived = true;
        }
    }
    for (size_t i = 0; i < system->n && rates; i++) {
        if (system->rates[i] == GM_NO_NODE && !gm_system_is_tangent(system, i)) {
            gm_system_refuse(system, gm_reading_line(reading, GM_WORD_RATE)->value.begin,
                             "there is no rate of %s", system->variables[i].name);
        }
    }
    for (size_t i = 0; i < system->n * system->n && system->kind == GM_POISSON; i++) {
        system->bracket[i] = system->bracket[i] == GM_NO_NODE ? zero : system->bracket[i];
    }
    for (size_t i = 0; i < system->n; i++) {
        const bool by_velocity =
            system->kind == GM_LAGRANGIAN && i >= system->n / 2 &&
            system->variables[system->velocities + i - system->n / 2].start != GM_NO_NODE;
        gm_system_refuse_if(system, system->variables[i].start == GM_NO_NODE && !by_velocity,
                            start ? start->value.begin : reading->length, "%s has no value at the start",
                            system->variables[i].name);
        if (system->variables[i].start != GM_NO_NODE && by_velocity) {
            gm_system_refuse(system, start->value.begin, "%s and its velocity are both given at the start",
                             system->variables[i].name);
        }
    }
}

void gm_reading_read(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    struct gm_arena *arena = system->arena;
    gm_system_refuse_if(system, reading->length > GM_LARGEST_SYSTEM, 0, "a system has at most 100 MB");
    system->source = gm_arena_take(arena, reading->length + 1, 1); /* it ends with a zero */
    system->length = reading->length;
    reading->text = memcpy(system->source, reading->text, reading->length);
    if (!gm_lines_are_text(reading->text, reading->length, system->fault)) {
        gm_arena_leave(arena);
    }
    gm_reading_lines(reading);
    if (system->kind != GM_ROOM) {
        gm_declared_kind(reading);
    }
    gm_declared_functions(reading);
    gm_declared_parameters(reading);
    gm_declared_state(reading);
    gm_declared_relations(reading);
    const size_t n = system->n;
    system->rates = gm_system_no_nodes(system, n);
    if (system->kind == GM_POISSON) {
        const struct gm_read_line *components = gm_reading_line(reading, GM_WORD_COMPONENTS);
        gm_system_refuse_if(system, n > MOST_OF_BRACKET, components ? components->value.begin : 0,
                            "a system with a bracket has at most %d components", MOST_OF_BRACKET);
        system->bracket = gm_system_no_nodes(system, n * n);
    }
    if (reading->degenerate) {
        system->theta = gm_system_no_nodes(system, n);
        system->omega = gm_system_no_nodes(system, n * n);
    }
    if (system->kind == GM_MATRICES) {
        system->matrix_places = gm_arena_take(arena, 2 * n * n, sizeof *system->matrix_places);
        system->matrices = gm_system_no_nodes(system, 2 * n * n);
    }
    gm_declared_lets(reading);
    for (size_t i = 0; i < reading->line_count; i++) {
        read_counted(reading, &reading->lines[i]);
    }
    for (size_t i = 0; i < reading->definition_count; i++) {
        if (!reading->definitions[i].called) {
            gm_reading_check(reading, &reading->definitions[i]);
        }
    }
    if (system->kind != GM_ROOM) {
        check_space(reading);
        check_section(system);
        (gm_system_is_form(system) ? complete_forms : complete)(reading);
    }
    name_parts(reading);
}

static void read_system(struct gm_arena *arena, void *data)
{
    (void)arena;
    gm_reading_read(data);
}

/* Reads the text once; reading->degenerate is set if it has to be read again so. */
static bool read_once(struct gm_user_system *system, struct gm_reading *reading, struct gm_fault *fault)
{
    *system = (struct gm_user_system){.arena = gm_arena_open(), .fault = fault, .drift = GM_NO_NODE};
    gm_formula_open(&system->graph);
    system->ignores_breaks = reading->ignores_breaks;
    reading->system = system;
    reading->scratch = gm_arena_open();
    const bool whole = reading->scratch && gm_arena_run(system->arena, read_system, reading);
    gm_arena_close(reading->scratch);
    if (!whole) { /* all else is closed */
        *system = (struct gm_user_system){
            .arena = system->arena, .graph = system->graph, .choices = system->choices};
    }
    return whole;
}

bool gm_system_read(struct gm_user_system *system, const char *text, size_t length,
                    const struct gm_system_value *values, size_t count, struct gm_fault *fault)
{
    struct gm_reading first = {.text = text, .length = length, .values = values, .value_count = count},
                      second;
    for (size_t i = 0; i < count; i++) {
        first.without_tangents |= strcmp(values[i].name, GM_WITHOUT_TANGENTS) == 0;
        first.ignores_breaks |=
            strcmp(values[i].name, GM_BREAKS_KEY) == 0 && strcmp(values[i].text, "ignored") == 0;
    }
    second = first;
    second.degenerate = true;
    *fault = (struct gm_fault){0};
    if (read_once(system, &first, fault)) {
        return true;
    }
    if (!first.degenerate) {
        return false;
    }
    gm_system_close(system);
    return read_once(system, &second, fault);
}
