/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Reads systems: lines, then declarations, then their formulas. */
#include "core/model/reader.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/number.h"
#include "core/model/declarations.h"
#include "core/model/options.h"

static struct gm_system_item *add_item(struct gm_reading *reading, const struct gm_system_line *line,
                                       struct gm_span name)
{
    struct gm_user_system *system = reading->system;
    if (!gm_reading_reserve(reading, (void **)&system->items, system->item_count, sizeof *system->items)) {
        return NULL;
    }
    struct gm_system_item *item = &system->items[system->item_count];
    *item = (struct gm_system_item){.word = line->word,
                                    .place = line->value.begin,
                                    .low = NAN,
                                    .high = NAN,
                                    .name = gm_reading_text(reading, name)};
    system->item_count += item->name != NULL;
    return item->name ? item : NULL;
}

static bool add_node(struct gm_reading *reading, struct gm_system_item *item, gm_node_id node)
{
    if (!gm_reading_reserve(reading, (void **)&item->nodes, item->count, sizeof *item->nodes)) {
        return false;
    }
    item->nodes[item->count++] = node;
    return true;
}

static bool add_formula(struct gm_reading *reading, struct gm_system_item *item, struct gm_span span)
{
    gm_node_id node;
    return gm_reading_formula(reading, span, &node) && add_node(reading, item, node);
}

/* adds formulas separated by commas */
static bool add_formulas(struct gm_reading *reading, struct gm_system_item *item, struct gm_span rest)
{
    struct gm_span piece;
    while (!reading->fault.failed && gm_span_take(reading->text, &rest, ",", &piece)) {
        add_formula(reading, item, piece);
    }
    return !reading->fault.failed;
}

/* The word of an assignment, its range and meaning, or the mark of derived starts. */
struct assignment {
    enum gm_system_word word;
    struct gm_written_range range;
    bool derived;
};

/* stores the assigned node in its component */
static bool assign(struct gm_reading *reading, struct gm_entry *entry, const struct gm_target *target,
                   gm_node_id node, void *data)
{
    struct gm_user_system *system = reading->system;
    const struct assignment *assignment = data;
    const enum gm_system_word word = assignment->word;
    const bool is_velocity =
        entry->role == GM_ENTRY_VELOCITY && word == GM_WORD_START && system->kind == GM_LAGRANGIAN;
    if (entry->role == GM_ENTRY_TIME && word == GM_WORD_START && system->kind == GM_EVOLUTION) {
        const struct gm_node *time = &system->graph.nodes[node];
        system->variables[system->n].value = time->operation == GM_CONSTANT ? time->value : NAN;
        return isfinite(system->variables[system->n].value) ||
               gm_fail_first(&reading->fault, target->value.begin, "the time of the start is a number");
    }
    if (entry->role != GM_ENTRY_COMPONENT && !is_velocity) {
        return gm_fail_first(&reading->fault, target->name.begin, "%.*s is not a component",
                             (int)(entry->length < 60 ? entry->length : 60), entry->name);
    }
    struct gm_system_variable *variable =
        &system->variables[(is_velocity ? system->velocities : 0) + entry->number];
    if (gm_system_is_tangent(system, entry->number) && !is_velocity) {
        return gm_fail_first(&reading->fault, target->name.begin,
                             "%s is of a tangent, whose start and rate follow from the system",
                             variable->name);
    }
    gm_node_id *place = word == GM_WORD_START   ? &variable->start
                        : word == GM_WORD_FORCE ? &variable->force
                        : word == GM_WORD_EXACT ? &variable->exact
                        : word == GM_WORD_JUMP  ? &variable->jump
                                                : &system->rates[entry->number];
    if (word == GM_WORD_FORCE && entry->number >= system->n / 2) {
        return gm_fail_first(&reading->fault, target->name.begin, "a force acts on a coordinate, not on %s",
                             variable->name);
    }
    if (*place != GM_NO_NODE) {
        return gm_fail_first(&reading->fault, target->name.begin, "%s: %s is given twice",
                             gm_system_words[word].word, variable->name);
    }
    *place = node;
    if (word == GM_WORD_START) {
        variable->start_place = target->name.begin;
        variable->low = assignment->range.low;
        variable->high = assignment->range.high;
        variable->derived = assignment->derived;
        variable->meaning = gm_reading_text(reading, assignment->range.meaning);
        variable->unit = gm_reading_text(reading, assignment->range.unit);
    }
    return word != GM_WORD_START || (variable->meaning && variable->unit);
}

static bool read_assignments(struct gm_reading *reading, const struct gm_system_line *line)
{
    const enum gm_system_word word = line->word;
    struct gm_span all = line->value, rest = all, piece;
    struct assignment assignment = {.word = word, .range = {.low = NAN, .high = NAN}};
    const bool form = gm_system_is_form(reading->system);
    if (word == GM_WORD_START && !gm_system_is_field(reading->system) && !form) {
        gm_span_take(reading->text, &all, ";", &rest);
        all = gm_span_trimmed(reading->text, all);
        assignment.derived = gm_span_among(reading->text, all, (const char *const[]){"derived", NULL}) == 0;
        if (!assignment.derived) {
            gm_reading_range(reading, all, &assignment.range);
        }
    }
    while (!reading->fault.failed && gm_span_take(reading->text, &rest, ",", &piece)) {
        struct gm_target target;
        reading->exact = word == GM_WORD_START && !gm_system_is_field(reading->system) && !form;
        if (gm_reading_assignment(reading, piece, &target)) {
            gm_reading_elements(reading, &target, assign, &assignment);
        }
        reading->exact = false;
    }
    return !reading->fault.failed;
}

/* Takes a name, or an element of a list, off the front of `rest`. NULL with a fault. */
static const struct gm_entry *take_entry(struct gm_reading *reading, struct gm_span *rest)
{
    struct gm_target target;
    long index = 0;
    if (!gm_reading_target(reading, rest, &target) ||
        (target.index.begin < target.index.end && !gm_reading_whole(reading, target.index, &index))) {
        return NULL;
    }
    return gm_reading_sought(reading, &target, index);
}

/* x y = z */
static bool read_bracket(struct gm_reading *reading, struct gm_span piece)
{
    struct gm_user_system *system = reading->system;
    struct gm_span rest = piece;
    size_t pair[2];
    for (int i = 0; i < 2; i++) {
        rest = gm_span_trimmed(reading->text, rest);
        const size_t place = rest.begin;
        const struct gm_entry *entry = take_entry(reading, &rest);
        if (!entry) {
            return false;
        }
        if (entry->role != GM_ENTRY_COMPONENT) {
            return gm_fail_first(&reading->fault, place, "a bracket is of two components: bracket: x y = z");
        }
        pair[i] = entry->number;
    }
    rest = gm_span_trimmed(reading->text, rest);
    if (rest.begin == rest.end || reading->text[rest.begin] != '=') {
        return gm_fail_first(&reading->fault, rest.begin, "= was expected");
    }
    rest.begin++;
    gm_node_id node, *entry = &system->bracket[pair[0] * system->n + pair[1]],
                     *opposite = &system->bracket[pair[1] * system->n + pair[0]];
    if (pair[0] == pair[1]) {
        return gm_fail_first(&reading->fault, piece.begin, "the bracket of %s with itself is 0",
                             system->variables[pair[0]].name);
    }
    if (!gm_reading_formula(reading, rest, &node)) {
        return false;
    }
    if (*entry != GM_NO_NODE) {
        return gm_fail_first(&reading->fault, piece.begin, "the bracket of %s and %s is given twice",
                             system->variables[pair[0]].name, system->variables[pair[1]].name);
    }
    *entry = node;
    system->bracket_place = piece.begin;
    *opposite = gm_negative(&system->graph, node);
    return true;
}

static bool read_brackets(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_span rest = line->value, piece;
    while (!reading->fault.failed && gm_span_take(reading->text, &rest, ",", &piece)) {
        read_bracket(reading, piece);
    }
    return !reading->fault.failed;
}

static bool generate(struct gm_reading *reading, struct gm_entry *entry, const struct gm_target *target,
                     gm_node_id node, void *data)
{
    const struct gm_user_system *system = reading->system;
    struct gm_system_item *item = data;
    if (entry->role != GM_ENTRY_COMPONENT || entry->number >= item->count) {
        return gm_fail_first(&reading->fault, target->name.begin, "a %s moves %s, not %.*s",
                             gm_system_words[item->word].word,
                             system->kind <= GM_LAGRANGIAN ? "coordinates" : "components",
                             (int)(entry->length < 60 ? entry->length : 60), entry->name);
    }
    item->nodes[entry->number] = node;
    return true;
}

/* symmetry: [name;] x = -y, y = x */
static bool read_symmetry(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_user_system *system = reading->system;
    struct gm_span rest = line->value, name = {0, 0}, piece;
    if (gm_span_until(reading->text, rest, ";") < rest.end) {
        gm_span_take(reading->text, &rest, ";", &name);
    }
    struct gm_system_item *item = add_item(reading, line, name);
    const size_t size = system->kind <= GM_LAGRANGIAN ? system->n / 2 : system->n;
    const gm_node_id zero = gm_formula_constant(&system->graph, 0);
    for (size_t i = 0; item && i < size && !reading->fault.failed; i++) {
        add_node(reading, item, zero);
    }
    while (item && !reading->fault.failed && gm_span_take(reading->text, &rest, ",", &piece)) {
        struct gm_target target;
        if (gm_reading_assignment(reading, piece, &target)) {
            gm_reading_elements(reading, &target, generate, item);
        }
    }
    return !reading->fault.failed;
}

/* Appends the index of a name as its last digits: length[2] is length2. */
static bool number_item(struct gm_reading *reading, struct gm_system_item *item, struct gm_span index)
{
    long number = 0;
    if (!gm_reading_whole(reading, index, &number)) {
        return false;
    }
    if (number < 0) {
        return gm_fail_first(&reading->fault, index.begin, "the index of a name is 0 or more, not %ld",
                             number);
    }
    item->name = gm_arena_print(reading->system->arena, "%s%ld", item->name, number);
    return item->name || gm_fail_memory(&reading->fault);
}

/* NAME = formula; options */
static bool read_named(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_span rest = line->value, piece;
    struct gm_target target;
    gm_span_take(reading->text, &rest, ";", &piece);
    if (!gm_reading_assignment(reading, piece, &target)) {
        return false;
    }
    const bool indexed = target.index.begin < target.index.end;
    if (indexed && reading->counter.begin == reading->counter.end) {
        return gm_fail_first(&reading->fault, target.index.begin, "this name has no index");
    }
    struct gm_system_item *item = add_item(reading, line, target.name);
    if (!item || (indexed && !number_item(reading, item, target.index))) {
        return false;
    }
    const size_t length = strlen(item->name);
    if (gm_reading_reserves(item->name, length)) {
        return gm_fail_first(&reading->fault, target.name.begin, "the name %.60s" GM_RESERVED, item->name);
    }
    const struct gm_entry *named = gm_reading_entry(reading, item->name, length, false, 0);
    if (named && named->place != target.name.begin) {
        return gm_reading_fail_twice(reading, target.name.begin, named);
    }
    reading->exact = line->word == GM_WORD_OBSERVE && !gm_system_is_field(reading->system) &&
                     !gm_system_is_form(reading->system);
    const bool good = named ? add_node(reading, item, named->node) : add_formula(reading, item, target.value);
    reading->exact = false;
    if (!good) {
        return false;
    }
    for (size_t i = 0; i + 1 < reading->system->item_count; i++) {
        const struct gm_system_item *other = &reading->system->items[i];
        if ((gm_system_is_observed(other) || other->word == GM_WORD_PART) &&
            strcmp(other->name, item->name) == 0) {
            return gm_fail_first(&reading->fault, target.name.begin, "%.60s is given twice", item->name);
        }
    }
    return gm_options_read(reading, item, rest);
}

/* part: A = formula, B = formula; of rates: A; x = formula, y = formula */
static bool read_part(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_span rest = line->value, piece;
    const bool rates = reading->system->kind == GM_RATES;
    if (rates && gm_span_until(reading->text, rest, ";") == rest.end) {
        return gm_fail_first(&reading->fault, rest.begin,
                             "a part of rates is a name, a semicolon and its rates");
    }
    while (!rates && !reading->fault.failed && gm_span_take(reading->text, &rest, ",", &piece)) {
        read_named(reading, &(struct gm_system_line){line->word, line->place, piece});
    }
    return rates ? read_symmetry(reading, line) : !reading->fault.failed;
}

/* require: F; sentence */
static bool read_requirement(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_span rest = line->value, formula;
    struct gm_system_item *item = add_item(reading, line, (struct gm_span){0, 0});
    gm_span_take(reading->text, &rest, ";", &formula);
    rest = gm_span_trimmed(reading->text, rest);
    if (item && rest.begin == rest.end) {
        return gm_fail_first(&reading->fault, formula.end, "a sentence was expected: %s: F; it says why not",
                             gm_system_words[line->word].word);
    }
    return item && add_formula(reading, item, formula) && gm_text_read(reading, item, rest);
}

/* level: [section;] F; text; options */
static bool read_level(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_span rest = line->value, piece;
    struct gm_system_item *item = add_item(reading, line, (struct gm_span){0, 0});
    gm_span_take(reading->text, &rest, ";", &piece);
    if (!item) {
        return false;
    }
    item->in_section = gm_span_is(reading->text, piece, "section");
    if (item->in_section) {
        gm_span_take(reading->text, &rest, ";", &piece);
    }
    const struct gm_system_line *section = gm_reading_line(reading, GM_WORD_SECTION);
    if (item->in_section && !section) {
        return gm_fail_first(&reading->fault, line->value.begin, "there is no line \"section\"");
    }
    reading->exact = true;
    const bool good = add_formula(reading, item, piece);
    reading->exact = false;
    if (good && !gm_span_take(reading->text, &rest, ";", &piece)) {
        return gm_fail_first(&reading->fault, piece.end, "a text was expected: level: F; the exact orbit");
    }
    item->text = good ? gm_reading_text(reading, piece) : NULL;
    return item->text && gm_options_read(reading, item, rest);
}

/* Takes the next piece as words key=value. */
static char *take_words(struct gm_reading *reading, struct gm_span *rest)
{
    struct gm_span piece;
    gm_span_take(reading->text, rest, ";", &piece);
    char *words = gm_reading_text(reading, piece);
    const bool none = words && strcmp(words, "none") == 0;
    for (const char *word = words; word && *word && !none; word += strcspn(word, " "), word += *word == ' ') {
        if (strcspn(word, "=") >= strcspn(word, " ")) {
            gm_fail_first(&reading->fault, piece.begin, "%.60s is not of the form key=value: until=100",
                          word);
            break;
        }
    }
    return words;
}

/* graph: KEY; options, figure: NAME; WORDS; statement, work: WORDS; options, stability: WORDS; KEY values; options */
static bool read_optional(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_span rest = line->value, name = {0, 0};
    const bool named = line->word == GM_WORD_GRAPH || line->word == GM_WORD_FIGURE;
    if (named) {
        gm_span_take(reading->text, &rest, ";", &name);
    }
    struct gm_system_item *item = add_item(reading, line, name);
    if (item && line->word != GM_WORD_GRAPH) {
        item->words = take_words(reading, &rest);
    }
    if (item && line->word == GM_WORD_FIGURE) {
        rest = gm_span_trimmed(reading->text, rest);
        item->text = gm_reading_text(reading, rest);
        return item->text &&
               (rest.begin < rest.end ||
                gm_fail_first(&reading->fault, rest.begin,
                              "a statement was expected: figure: NAME; scheme=rk4; what it shows"));
    }
    return item && !reading->fault.failed && gm_options_read(reading, item, rest);
}

/* section: y = 0, p_y > 0; x, p_x   or   section: every T; x, p_x */
static bool read_section(struct gm_reading *reading, const struct gm_system_line *line)
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
            return gm_fail_first(&reading->fault, condition.begin,
                                 "a section is where something is 0, x = 0, or every T");
        }
        condition.end = equals;
    }
    double period = 1;
    if (!add_formula(reading, item, condition) ||
        (item->periodic && !gm_reading_number(reading, condition, &period))) {
        return false;
    }
    if (!(period > 0)) {
        return gm_fail_first(&reading->fault, condition.begin,
                             "the time between two looks is %g, and has to be above 0", period);
    }
    gm_span_take(reading->text, &rest, ";", &piece);
    if (piece.begin == piece.end || !add_formulas(reading, item, piece) || item->count != 3) {
        return gm_fail_first(&reading->fault, piece.begin, "a section shows two values: ; x, p_x");
    }
    rest = gm_span_trimmed(reading->text, rest);
    item->alone = gm_span_is(reading->text, rest, "alone");
    if (rest.begin < rest.end && !item->alone) {
        return gm_fail_first(&reading->fault, rest.begin,
                             "\"alone\" was expected: the section is the usual picture");
    }
    while (!reading->fault.failed && gm_span_take(reading->text, &where, ",", &piece)) {
        gm_node_id holds;
        if (gm_reading_condition(reading, piece, &holds)) {
            add_node(reading, item, holds);
        }
    }
    return !reading->fault.failed;
}

/* Reads one body, or both ends of a rod, in two or three dimensions. */
static bool read_view(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_system_item *item = add_item(reading, line, (struct gm_span){0, 0});
    struct gm_span rest = line->value, piece;
    const size_t wanted = line->word == GM_WORD_ROD ? 2 : 1;
    size_t ends = 0, dimensions = 0;
    bool equal = true;
    while (item && !reading->fault.failed && ends < wanted &&
           gm_span_take(reading->text, &rest, ";", &piece)) {
        const size_t before = item->count;
        add_formulas(reading, item, piece);
        equal = equal && (ends == 0 || item->count - before == dimensions);
        dimensions = item->count - before;
        ends++;
    }
    if (!reading->fault.failed && (!equal || dimensions < 2 || dimensions > 3 || ends < wanted)) {
        return gm_fail_first(&reading->fault, line->value.begin,
                             line->word == GM_WORD_ROD ? "a rod has two ends: 0, 0; x, y"
                                                       : "a body has two or three coordinates: x, y");
    }
    if (item && !reading->fault.failed) {
        gm_options_read(reading, item, rest);
    }
    const struct gm_user_system *system = reading->system;
    for (size_t i = 0; i + 1 < system->item_count && !reading->fault.failed; i++) {
        const struct gm_system_item *other = &system->items[i];
        const size_t of_other = other->word == GM_WORD_VIEW  ? other->count
                                : other->word == GM_WORD_ROD ? other->count / 2
                                                             : dimensions;
        if (of_other != dimensions) {
            return gm_fail_first(&reading->fault, line->value.begin,
                                 "%zu coordinate%s, and those of the lines before are %zu", dimensions,
                                 gm_plural((double)dimensions), of_other);
        }
    }
    return !reading->fault.failed;
}

/* surface: sphere; r   or   surface: ellipsoid; a, b, c */
static bool read_surface(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_span rest = line->value, shape;
    struct gm_system_item *item = add_item(reading, line, (struct gm_span){0, 0});
    gm_span_take(reading->text, &rest, ";", &shape);
    const char *word = reading->text + shape.begin;
    const size_t length = shape.end - shape.begin;
    const bool sphere = length == 6 && memcmp(word, "sphere", 6) == 0;
    if (!item || (!sphere && (length != 9 || memcmp(word, "ellipsoid", 9) != 0))) {
        return gm_fail_first(&reading->fault, shape.begin,
                             "a surface is a sphere or an ellipsoid: sphere; 1");
    }
    rest = gm_span_trimmed(reading->text, rest);
    if (rest.begin == rest.end || !add_formulas(reading, item, rest) || item->count != (sphere ? 1 : 3)) {
        return gm_fail_first(&reading->fault, rest.begin,
                             sphere ? "a sphere has one radius: sphere; 1"
                                    : "an ellipsoid has three half axes: ellipsoid; 1, 2, 3");
    }
    const gm_node_id radius = item->nodes[0];
    return !sphere || (add_node(reading, item, radius) && add_node(reading, item, radius));
}

/* The keys of a camera are reserved in space, and never a choice; surfaces need space. */
static bool check_space(struct gm_reading *reading)
{
    static const char *const keys[] = {"azimuth", "elevation", "zoom", "turn"};
    static const char taken[] = "the name %s is reserved: it is how a system in space is looked at";
    const struct gm_user_system *system = reading->system;
    bool in_space = false;
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        in_space |= (item->word == GM_WORD_VIEW && item->count == 3) ||
                    (item->word == GM_WORD_ROD && item->count == 6);
    }
    for (size_t i = 0; i < system->item_count; i++) {
        const struct gm_system_item *item = &system->items[i];
        if (item->word == GM_WORD_SURFACE && !in_space) {
            return gm_fail_first(&reading->fault, item->place,
                                 "a surface needs bodies in space: view: x, y, z");
        }
        for (size_t k = 0; k < sizeof keys / sizeof *keys && in_space; k++) {
            if (strcmp(item->name, keys[k]) == 0) {
                return gm_fail_first(&reading->fault, item->place, taken, keys[k]);
            }
        }
    }
    for (size_t k = 0; k < sizeof keys / sizeof *keys; k++) {
        const struct gm_entry *entry = gm_reading_entry(reading, keys[k], strlen(keys[k]), false, 0);
        if (entry && (in_space || entry->role == GM_ENTRY_CHOICE)) {
            return gm_fail_first(&reading->fault, entry->place, taken, keys[k]);
        }
    }
    return true;
}

static bool read_angles(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_user_system *system = reading->system;
    for (struct gm_span rest = gm_span_trimmed(reading->text, line->value);
         rest.begin < rest.end && !reading->fault.failed; rest = gm_span_trimmed(reading->text, rest)) {
        const size_t place = rest.begin;
        if (reading->text[rest.begin] == ',') {
            rest.begin++;
            continue;
        }
        const struct gm_entry *entry = take_entry(reading, &rest);
        if (!entry) {
            return false;
        }
        if (entry->role != GM_ENTRY_COMPONENT ||
            (system->kind != GM_RATES && entry->number >= system->n / 2)) {
            return gm_fail_first(&reading->fault, place, "an angle is one of the coordinates");
        }
        system->variables[entry->number].angle = true;
    }
    return !reading->fault.failed;
}

/* Reads a number of a ring: half its length, the points of its grid, the jump of the field at its ends. */
static bool read_ring(struct gm_reading *reading, const struct gm_system_line *line)
{
    static const struct {
        double low, high;
        const char *told;
    } ranges[] = {{0.01, 1e5, "a number from 0.01 to 1e5"},
                  {3, 1e7, "a whole number from 3 to 1e7"},
                  {-1e6, 1e6, "a number"}};
    const size_t row = (size_t)line->word - GM_WORD_HALF_LENGTH;
    double number;
    struct gm_system_item *item;
    struct gm_span rest = line->value, value;
    gm_span_take(reading->text, &rest, ";", &value);
    if (!gm_reading_number(reading, value, &number)) {
        return false;
    }
    if (!(number >= ranges[row].low && number <= ranges[row].high) ||
        (line->word == GM_WORD_POINTS && number != floor(number) &&
         !gm_system_points_follow(reading->system))) {
        return gm_fail_first(&reading->fault, line->value.begin, "%s is %g, and has to be %s",
                             gm_system_words[line->word].word, number, ranges[row].told);
    }
    item = add_item(reading, line, (struct gm_span){0, 0});
    return item && add_formula(reading, item, value) && gm_options_read(reading, item, rest);
}

/* mesh: sphere 1 level: a word, and numbers separated by blanks, which may be formulas without blanks */
static bool read_generator(struct gm_reading *reading, const struct gm_system_line *line)
{
    size_t at = line->value.begin, words = 0;
    struct gm_system_item *item = NULL;
    while (at < line->value.end && !reading->fault.failed) {
        const size_t end = at + strcspn(reading->text + at, " \t\r\n");
        const struct gm_span word = {at, end < line->value.end ? end : line->value.end};
        if (words++ == 0) {
            item = add_item(reading, line, word);
        } else if (item) {
            add_formula(reading, item, word);
        }
        at = word.end + strspn(reading->text + word.end, " \t\r\n");
    }
    return item && !reading->fault.failed;
}

static bool read_star(struct gm_reading *reading, const struct gm_system_line *line)
{
    static const char *const words[] = {"auto",     "circumcentric", "barycentric",
                                        "galerkin", "incentric",     NULL};
    reading->system->texts[line->word] = gm_reading_text(reading, line->value);
    return reading->system->texts[line->word] &&
           (words[gm_span_among(reading->text, line->value, words)] ||
            gm_fail_first(&reading->fault, line->value.begin,
                          "star: is auto, circumcentric, barycentric, galerkin or incentric"));
}

/* equation: NAME; left = right */
static bool read_equation(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_user_system *system = reading->system;
    struct gm_span rest = line->value, name;
    gm_span_take(reading->text, &rest, ";", &name);
    rest = gm_span_trimmed(reading->text, rest);
    const struct gm_entry *entry =
        gm_reading_entry(reading, reading->text + name.begin, name.end - name.begin, false, 0);
    const size_t equals = gm_span_until(reading->text, rest, "=");
    if (!entry || entry->role != GM_ENTRY_COMPONENT || !system->forms[entry->number].unknown) {
        return gm_fail_first(&reading->fault, name.begin,
                             "an equation begins with its unknown, as in equation: u; laplace(u) = 0");
    }
    struct gm_form_declared *form = &system->forms[entry->number];
    if (form->left != GM_NO_NODE) {
        return gm_fail_first(&reading->fault, name.begin, "%s has two equations", entry->name);
    }
    if (equals == rest.end) {
        return gm_fail_first(&reading->fault, rest.begin, "= was expected");
    }
    return gm_reading_formula(reading, (struct gm_span){rest.begin, equals}, &form->left) &&
           gm_reading_formula(reading, (struct gm_span){equals + 1, rest.end}, &form->right);
}

/* Reads rows separated by |, with commas between entries. */
static bool read_matrix(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_user_system *system = reading->system;
    const char *word = gm_system_words[line->word].word;
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
                if (!gm_reading_formula(reading, entry, &system->matrices[at])) {
                    return false;
                }
            }
        }
        if (columns != n) {
            return gm_fail_first(&reading->fault, begin, "row %zu of %s has %zu entries for %zu components",
                                 rows + 1, word, columns, n);
        }
    }
    return rows == n || gm_fail_first(&reading->fault, line->value.begin,
                                      "%s has %zu rows for %zu components", word, rows, n);
}

/* Reads one of two words. */
static bool read_choice(struct gm_reading *reading, const struct gm_system_line *line, const char *one,
                        const char *other)
{
    char *text = reading->system->texts[line->word] = gm_reading_text(reading, line->value);
    return text && (strcmp(text, one) == 0 || strcmp(text, other) == 0 ||
                    gm_fail_first(&reading->fault, line->value.begin, "%s is %s or %s, not %.60s",
                                  gm_system_words[line->word].word, one, other, text));
}

/* Reads a graph for compiled kernels: `yes`, the graph of the file; N = 3 .. 5, for a parameter in an index;
   or KEY = VALUE, with that value of the parameter. */
static bool read_compiled(struct gm_reading *reading, const struct gm_system_line *line, struct gm_span piece)
{
    struct gm_user_system *system = reading->system;
    const char *text = reading->text;
    const size_t equals = gm_span_until(text, piece, "=");
    const struct gm_span name = gm_span_trimmed(text, (struct gm_span){piece.begin, equals}),
                         value = {equals + 1, piece.end};
    const struct gm_entry *entry =
        gm_reading_entry(reading, text + name.begin, name.end - name.begin, false, 0);
    double number;
    long low, high;
    if (equals == piece.end && gm_span_is(text, name, "yes")) {
        return true;
    }
    if (equals < piece.end && entry && entry->role == GM_ENTRY_CHOICE) {
        struct gm_written_choices tried = system->choices;
        char *word = gm_reading_text(reading, value);
        if (word && !gm_choices_take(&tried, entry->name, word)) {
            gm_fail_first(&reading->fault, piece.begin, "compile: %s has no word %.60s", entry->name, word);
        }
        return !reading->fault.failed;
    }
    if (equals == piece.end || !entry || entry->role != GM_ENTRY_PARAMETER) {
        return gm_fail_first(&reading->fault, piece.begin,
                             "compile: says yes, or gives values to a parameter, as in N = 3 .. 5");
    }
    const size_t variable = system->parameters + entry->number;
    if (gm_reading_bounds(reading, value, "graphs", &low, &high) || reading->fault.failed ||
        !gm_reading_number(reading, value, &number)) {
        return !reading->fault.failed;
    }
    struct gm_system_item *item = add_item(reading, line, name);
    if (item) {
        item->value = number;
        item->variable = variable;
    }
    return item != NULL;
}

static bool read_compile(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_span rest = line->value, piece;
    bool good = true;
    while (good && gm_span_take(reading->text, &rest, ";", &piece)) {
        good = read_compiled(reading, line, piece);
    }
    return good;
}

/* F; scale: the least divisor of its error */
static bool read_energy(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_span rest = line->value, energy;
    gm_span_take(reading->text, &rest, ";", &energy);
    rest = gm_span_trimmed(reading->text, rest);
    struct gm_system_item *item =
        rest.begin < rest.end ? add_item(reading, line, (struct gm_span){0, 0}) : NULL;
    return (rest.begin == rest.end || (item && gm_options_read(reading, item, rest))) &&
           gm_reading_formula(reading, energy, &reading->system->energy);
}

/* Takes the name of a key off the front of NAME = F; an empty one without it. False with a fault. */
static bool take_key(struct gm_reading *reading, struct gm_span *value, struct gm_span *key)
{
    struct gm_target target;
    *key = (struct gm_span){0, 0};
    if (gm_span_until(reading->text, *value, "=") == value->end) {
        return true;
    }
    if (!gm_reading_assignment(reading, *value, &target)) {
        return false;
    }
    const char *name = reading->text + target.name.begin;
    const size_t length = target.name.end - target.name.begin;
    *key = target.name;
    *value = target.value;
    return (target.index.begin == target.index.end && !gm_reading_reserves(name, length) &&
            !gm_reading_entry(reading, name, length, false, 0)) ||
           gm_fail_first(&reading->fault, key->begin, "the name %.*s is taken",
                         (int)(length < 60 ? length : 60), name);
}

/* F; low .. high; meaning; of members and spread also KEY = F */
static bool read_timing(struct gm_reading *reading, const struct gm_system_line *line)
{
    const char *word = gm_system_words[line->word].word;
    const bool counts = line->word == GM_WORD_MEMBERS, spreads = line->word == GM_WORD_SPREAD;
    struct gm_span rest = line->value, value, key = {0, 0};
    struct gm_written_range range;
    double number;
    gm_span_take(reading->text, &rest, ";", &value);
    if (((counts || spreads) && !take_key(reading, &value, &key)) ||
        !gm_reading_number(reading, value, &number) || !gm_reading_range(reading, rest, &range)) {
        return false;
    }
    if (!(isfinite(number) && (line->word == GM_WORD_DT ? number > 0 : number >= 0))) {
        return gm_fail_first(&reading->fault, value.begin, "%s is %g, and has to be %s", word, number,
                             line->word == GM_WORD_DT ? "above 0" : "0 or more");
    }
    if ((counts && (number < 1 || number != floor(number))) || ((counts || spreads) && number > 1e6)) {
        return gm_fail_first(&reading->fault, value.begin, "%s is %g, and has to be a %s to 1e6", word,
                             number, counts ? "whole number from 1" : "number from 0");
    }
    if (number < range.low || number > range.high) {
        return gm_fail_first(&reading->fault, value.begin, "%s is %g, and its range is from %g to %g", word,
                             number, range.low, range.high);
    }
    reading->system->texts[line->word] = gm_reading_text(reading, value);
    struct gm_system_item *item = add_item(reading, line, key);
    if (!item || !add_formula(reading, item, value)) {
        return false;
    }
    item->value = number;
    item->low = range.low;
    item->high = range.high;
    item->text = gm_reading_text(reading, range.meaning);
    return item->text != NULL;
}

/* dt = KEY*F: either of the step and a parameter follows from the other; F has no such parameter. */
static bool read_tie(struct gm_reading *reading, const struct gm_system_line *line)
{
    const char *text = reading->text;
    const size_t equals = gm_span_until(text, line->value, "="), end = line->value.end;
    const struct gm_span step = gm_span_trimmed(text, (struct gm_span){line->value.begin, equals}),
                         product = gm_span_trimmed(text, (struct gm_span){equals + (equals < end), end});
    const size_t length = gm_name_length(text + product.begin, product.end - product.begin),
                 times = product.begin + length;
    const struct gm_entry *entry = gm_reading_entry(reading, text + product.begin, length, false, 0);
    if (!gm_span_is(text, step, "dt") || times >= product.end || text[times] != '*' || !entry ||
        entry->role != GM_ENTRY_PARAMETER) {
        return gm_fail_first(&reading->fault, line->value.begin,
                             "tie: is the step as a multiple of a parameter, as in dt = courant*dx");
    }
    struct gm_system_item *item =
        add_item(reading, line, (struct gm_span){product.begin, product.begin + length});
    if (item) {
        item->variable = reading->system->parameters + entry->number;
    }
    return item && add_formula(reading, item, (struct gm_span){times + 1, product.end});
}

/* geomint: 1 */
static bool read_version(struct gm_reading *reading, const struct gm_system_line *line)
{
    double number;
    return gm_reading_number(reading, line->value, &number) &&
           (number == 1 || gm_fail_first(&reading->fault, line->value.begin,
                                         "this program reads files of format 1, not %g", number));
}

static bool read_text(struct gm_reading *reading, const struct gm_system_line *line)
{
    return (reading->system->texts[line->word] = gm_reading_text(reading, line->value)) != NULL;
}

/* mesh: a triangulation of forms, or X = F of a field */
static bool read_mesh(struct gm_reading *reading, const struct gm_system_line *line)
{
    return gm_system_is_form(reading->system) ? read_generator(reading, line) : read_text(reading, line);
}

/* Reads a text that may contain values. */
static bool read_shown_text(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_system_item *item =
        read_text(reading, line) ? add_item(reading, line, (struct gm_span){0, 0}) : NULL;
    return item && gm_text_read(reading, item, line->value) &&
           (line->word != GM_WORD_TITLE || item->count == 0 || gm_reading_line(reading, GM_WORD_NAME) ||
            gm_fail_first(&reading->fault, line->place,
                          "a title with values needs a line \"name\" for lists"));
}

static bool read_space(struct gm_reading *reading, const struct gm_system_line *line)
{
    return read_choice(reading, line, "differences", "fourier");
}

/* boundary: PART NAME = formula, of forms */
static bool read_held(struct gm_reading *reading, const struct gm_system_line *line)
{
    const char *text = reading->text;
    const size_t end = line->value.begin + strcspn(text + line->value.begin, " \t\r\n");
    const struct gm_span part = {line->value.begin, end < line->value.end ? end : line->value.end};
    struct gm_target target;
    if (!gm_reading_assignment(reading, gm_span_trimmed(text, (struct gm_span){part.end, line->value.end}),
                               &target)) {
        return false;
    }
    const struct gm_entry *entry = gm_reading_sought(reading, &target, 0);
    struct gm_system_item *item = entry ? add_item(reading, line, part) : NULL;
    if (!item || !add_formula(reading, item, target.value)) {
        return false;
    }
    item->variable = entry->number;
    return entry->role == GM_ENTRY_COMPONENT ||
           (entry->role == GM_ENTRY_NAMED
                ? add_node(reading, item, entry->node)
                : gm_fail_first(&reading->fault, target.name.begin,
                                "a boundary is given for a form: a field, an unknown or a let"));
}

static bool read_boundary(struct gm_reading *reading, const struct gm_system_line *line)
{
    if (gm_system_is_form(reading->system)) {
        return read_held(reading, line);
    }
    if (reading->system->texts[GM_WORD_BOUNDARY]) {
        return gm_fail_first(&reading->fault, line->place, "boundary is given twice");
    }
    return read_choice(reading, line, "ring", "walls");
}

static bool read_jump(struct gm_reading *reading, const struct gm_system_line *line)
{
    const bool jumps = reading->system->kind == GM_MATRICES;
    return jumps ? read_assignments(reading, line) : read_ring(reading, line);
}

/* Reads L, V or S. */
static bool read_function(struct gm_reading *reading, const struct gm_system_line *line)
{
    return gm_reading_formula(reading, line->value, &reading->system->energy);
}

static bool read_formula(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_system_item *item = add_item(reading, line, (struct gm_span){0, 0});
    return item && add_formula(reading, item, line->value);
}

/* The values at both ends, of the colours or of the line. */
static bool read_pair(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_system_item *item = add_item(reading, line, (struct gm_span){0, 0});
    const char *word = gm_system_words[line->word].word;
    return item && add_formulas(reading, item, line->value) &&
           (item->count == 2 || gm_fail_first(&reading->fault, line->value.begin,
                                              "%s: are two values, as in %s: -1, 1", word, word));
}

/* The weight of the slope in the density of a moving mesh. */
static bool read_weight(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_system_item *item = add_item(reading, line, (struct gm_span){0, 0});
    struct gm_span rest = line->value, value;
    gm_span_take(reading->text, &rest, ";", &value);
    return item && add_formula(reading, item, value) && gm_options_read(reading, item, rest);
}

/* Names were read before. */
static bool read_declared(struct gm_reading *reading, const struct gm_system_line *line)
{
    return reading && line;
}

static bool (*const readers[GM_WORDS])(struct gm_reading *reading, const struct gm_system_line *line) = {
#define GM_WORD(constant, word, identity, kinds, reader) read_##reader,
#include "core/model/words.def"
#undef GM_WORD
};

/* Reads i = low .. high; line, for each i in turn. A line without a counter is read once. */
static bool read_counted(struct gm_reading *reading, const struct gm_system_line *line)
{
    struct gm_span rest = line->value, head;
    const size_t name = gm_name_length(reading->text + rest.begin, rest.end - rest.begin);
    long low = 0, high = 0;
    gm_span_take(reading->text, &rest, ";", &head);
    const size_t equals = gm_span_until(reading->text, head, "=");
    const struct gm_span counter = gm_span_trimmed(reading->text, (struct gm_span){head.begin, equals}),
                         bounds = gm_span_trimmed(reading->text, (struct gm_span){equals + 1, head.end});
    if (gm_system_words[line->word].identity == GM_LINE_ONCE || head.end == line->value.end ||
        equals == head.end || name == 0 || counter.end != counter.begin + name ||
        gm_span_until(reading->text, bounds, "..") == bounds.end) {
        return readers[line->word](reading, line);
    }
    if (gm_reading_entry(reading, reading->text + counter.begin, name, false, 0)) {
        return gm_fail_first(&reading->fault, counter.begin,
                             "%.*s is a name of the system: an index is another one",
                             (int)(name < 60 ? name : 60), reading->text + counter.begin);
    }
    if (!gm_reading_bounds(reading, bounds, "values of an index", &low, &high)) {
        return gm_fail_first(&reading->fault, bounds.begin,
                             "the bounds of an index were expected, as in i = 1 .. 3");
    }
    const struct gm_system_line one = {line->word, line->place, gm_span_trimmed(reading->text, rest)};
    reading->counter = counter;
    for (reading->counted = low; reading->counted <= high && !reading->fault.failed; reading->counted++) {
        readers[line->word](reading, &one);
    }
    reading->counter = (struct gm_span){0, 0};
    return !reading->fault.failed;
}

/* Gives the names of lets to nodes without a name. */
static bool name_parts(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    system->part_count = system->graph.count;
    system->parts = gm_arena_take(system->arena, system->part_count + (size_t)1, sizeof *system->parts);
    for (size_t i = 0; system->parts && i < reading->entry_count && !reading->fault.failed; i++) {
        const struct gm_entry *entry = &reading->entries[i];
        const struct gm_system_line line = {
            .word = GM_WORD_LET, .place = entry->place, .value = entry->value};
        if (entry->role != GM_ENTRY_NAMED) {
            continue;
        }
        struct gm_system_item *item =
            add_item(reading, &line, (struct gm_span){entry->place, entry->place + entry->length});
        if (item && entry->indexed) {
            item->name = gm_arena_print(system->arena, "%s[%ld]", item->name, entry->index);
        }
        if (item && !item->name) {
            return gm_fail_memory(&reading->fault);
        }
        if (item && add_node(reading, item, entry->node) &&
            system->graph.nodes[entry->node].operation > GM_VARIABLE) {
            system->parts[entry->node] = item->name;
        }
    }
    return (system->parts && !reading->fault.failed) || gm_fail_memory(&reading->fault);
}

enum { MOST_OF_BRACKET = 2000 }; /* limits the size of the matrix of nodes */

static bool all_nodes(struct gm_reading *reading, gm_node_id **nodes, size_t count)
{
    *nodes = gm_system_no_nodes(reading->system, count);
    return *nodes || gm_fail_memory(&reading->fault);
}

/* A field without a start starts with its exact solution. */
static bool start_exactly(struct gm_user_system *system)
{
    gm_node_id *values = gm_system_no_nodes(system, system->variable_count);
    if (values) {
        values[system->n] = gm_formula_constant(&system->graph, system->variables[system->n].value);
    }
    for (size_t i = 0; values && i < system->n; i++) {
        const bool is_rate = system->kind == GM_FIELD && i == 1;
        gm_node_id node = system->variables[is_rate ? 0 : i].exact, *start = &system->variables[i].start;
        if (*start != GM_NO_NODE || node == GM_NO_NODE) {
            continue;
        }
        node = is_rate ? gm_system_derivative(system, node, system->n) : node;
        if (system->graph.failed ||
            !gm_formula_substitute(&system->graph, &node, 1, values, system->variable_count)) {
            break;
        }
        *start = node;
    }
    return values && !system->graph.failed;
}

/* True if a tangent starts along a component: the first along the first coordinate, the next along its momentum. */
static bool is_along(const struct gm_user_system *system, size_t component, size_t tangent)
{
    const size_t half = gm_system_motion(system) / 2, k = tangent - 1;
    return component == (system->kind == GM_CANONICAL ? k % 2 * half + k / 2 : k);
}

/* Moves the formulas of forms to their declarations. Fields have a rate and a start, unknowns an equation. */
static bool are_complete_forms(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    for (size_t i = 0; i < system->n; i++) {
        struct gm_form_declared *form = &system->forms[i];
        struct gm_system_variable *variable = &system->variables[i];
        const bool lacks_rate = system->rates[i] == GM_NO_NODE, lacks_equation = form->left == GM_NO_NODE;
        form->start = variable->start != GM_NO_NODE ? variable->start : variable->exact;
        form->exact = variable->exact;
        variable->start = variable->exact = GM_NO_NODE;
        if (form->unknown ? lacks_equation || !lacks_rate : lacks_rate) {
            return gm_fail_first(&reading->fault, form->place, "%s has no %s", variable->name,
                                 !form->unknown   ? "rate"
                                 : lacks_equation ? "equation"
                                                  : "rate: it is an unknown");
        }
        if (!form->unknown && form->start == GM_NO_NODE) {
            return gm_fail_first(&reading->fault, form->place, "%s has no value at the start",
                                 variable->name);
        }
    }
    return true;
}

static bool is_complete(struct gm_reading *reading)
{
    if (gm_system_is_form(reading->system)) {
        return are_complete_forms(reading);
    }
    struct gm_user_system *system = reading->system;
    const gm_node_id zero = gm_formula_constant(&system->graph, 0);
    const bool rates = system->kind == GM_RATES || system->kind == GM_EVOLUTION;
    const struct gm_system_line *start = gm_reading_line(reading, GM_WORD_START);
    if (gm_system_is_field(system) && !start_exactly(system)) {
        return gm_fail_memory(&reading->fault);
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
            return gm_fail_first(&reading->fault, gm_reading_line(reading, GM_WORD_RATE)->value.begin,
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
        if (system->variables[i].start == GM_NO_NODE && !by_velocity) {
            return gm_fail_first(&reading->fault, start ? start->value.begin : reading->length,
                                 "%s has no value at the start", system->variables[i].name);
        }
        if (system->variables[i].start != GM_NO_NODE && by_velocity) {
            return gm_fail_first(&reading->fault, start->value.begin,
                                 "%s and its velocity are both given at the start",
                                 system->variables[i].name);
        }
    }
    return true;
}

static bool read_system(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    if (reading->length > GM_LARGEST_SYSTEM) {
        return gm_fail_first(&reading->fault, 0, "a system has at most 100 MB");
    }
    struct gm_fault fault;
    if (!gm_lines_are_text(reading->text, reading->length, &fault)) {
        return gm_fail_first(&reading->fault, fault.offset, "%s", fault.sentence);
    }
    if (!gm_reading_lines(reading) || !gm_declared_kind(reading) || !gm_declared_functions(reading) ||
        !gm_declared_parameters(reading) || !gm_declared_state(reading) || !gm_declared_relations(reading) ||
        !all_nodes(reading, &system->rates, system->n)) {
        return false;
    }
    if (system->kind == GM_POISSON) {
        const struct gm_system_line *components = gm_reading_line(reading, GM_WORD_COMPONENTS);
        if (system->n > MOST_OF_BRACKET) {
            return gm_fail_first(&reading->fault, components ? components->value.begin : 0,
                                 "a system with a bracket has at most %d components", MOST_OF_BRACKET);
        }
        if (!all_nodes(reading, &system->bracket, system->n * system->n)) {
            return false;
        }
    }
    if (system->kind == GM_MATRICES) {
        system->matrix_places =
            gm_arena_take(system->arena, 2 * system->n * system->n, sizeof *system->matrix_places);
        if (!system->matrix_places || !all_nodes(reading, &system->matrices, 2 * system->n * system->n)) {
            return gm_fail_memory(&reading->fault);
        }
    }
    if (!gm_declared_lets(reading)) {
        return false;
    }
    for (size_t i = 0; i < reading->line_count; i++) {
        if (!read_counted(reading, &reading->lines[i])) {
            return reading->fault.failed ? false : gm_fail_memory(&reading->fault);
        }
    }
    for (size_t i = 0; i < reading->definition_count; i++) {
        if (!reading->definitions[i].called && !gm_reading_check(reading, &reading->definitions[i])) {
            return false;
        }
    }
    return check_space(reading) && is_complete(reading) && name_parts(reading);
}

bool gm_system_read(struct gm_user_system *system, const char *text, size_t length,
                    const struct gm_system_value *values, size_t count, struct gm_fault *fault)
{
    struct gm_reading reading = {.system = system,
                                 .text = text,
                                 .length = length,
                                 .values = values,
                                 .value_count = count,
                                 .fault = {.fault = fault}};
    for (size_t i = 0; i < count; i++) {
        reading.without_tangents |= strcmp(values[i].name, GM_WITHOUT_TANGENTS) == 0;
    }
    *system = (struct gm_user_system){0};
    *fault = (struct gm_fault){0};
    gm_formula_open(&system->graph);
    system->arena = gm_arena_open();
    if (system->arena && length <= GM_LARGEST_SYSTEM) {
        system->source = gm_arena_take(system->arena, length + 1, 1);
    }
    if (system->source) {
        memcpy(system->source, text, length);
        system->length = length;
        reading.text = system->source; /* it ends with a zero */
    }
    const bool good = (system->source || length > GM_LARGEST_SYSTEM) && read_system(&reading);
    gm_reading_close(&reading);
    return good;
}
