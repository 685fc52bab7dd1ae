/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The declarations of a system: its kind, its parameters, the names of its state, its lets. */
#include "core/model/scope.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/basics.h"
#include "core/expression/number.h"

/* A variable without any values. */
static const struct gm_system_variable unsaid = {.value = NAN,
                                                 .low = NAN,
                                                 .high = NAN,
                                                 .start = GM_NO_NODE,
                                                 .force = GM_NO_NODE,
                                                 .exact = GM_NO_NODE,
                                                 .jump = GM_NO_NODE};

static struct gm_system_variable *add_variable(struct gm_reading *reading, const struct gm_entry *entry)
{
    struct gm_user_system *system = reading->system;
    system->variables =
        gm_arena_grown(system->arena, system->variables, system->variable_count, sizeof *system->variables);
    struct gm_system_variable *variable = &system->variables[system->variable_count++];
    *variable = unsaid;
    variable->name = entry->indexed ? gm_arena_print(system->arena, "%.*s[%ld]", (int)entry->length,
                                                     entry->name, entry->index)
                                    : gm_arena_print(system->arena, "%.*s", (int)entry->length, entry->name);
    return variable;
}

/* Adds a name with its variable. */
static struct gm_system_variable *add_name(struct gm_reading *reading, struct gm_entry entry)
{
    gm_reading_add(reading, entry);
    return add_variable(reading, &entry);
}

/* Adds a name, or all elements of a list, in a role, numbered from *count. */
static void add_names(struct gm_reading *reading, const struct gm_target *target, enum gm_entry_role role,
                      size_t *count)
{
    struct gm_entry entry = gm_reading_entry_for(reading, target, role);
    long low = 0, high = 0;
    entry.indexed = target->index.begin < target->index.end;
    gm_system_refuse_if(reading->system,
                        entry.indexed &&
                            !gm_reading_bounds(reading, target->index, "elements of a list", &low, &high),
                        target->index.begin, "the bounds of a list were expected, as in %.*s[1..3]",
                        gm_brief_length(entry.length), entry.name);
    gm_system_refuse_if(reading->system, high < low, target->index.begin, "a list has at least one element");
    for (entry.index = low; entry.index <= high; entry.index++) {
        entry.number = (*count)++;
        add_name(reading, entry);
    }
}

/* Adds names separated by blanks or commas. */
static void add_all_names(struct gm_reading *reading, struct gm_span rest, enum gm_entry_role role,
                          size_t *count)
{
    for (rest = gm_span_trimmed(reading->text, rest); rest.begin < rest.end;
         rest = gm_span_trimmed(reading->text, rest)) {
        if (reading->text[rest.begin] == ',') {
            rest.begin++;
        } else {
            const struct gm_target target = gm_reading_target(reading, &rest);
            add_names(reading, &target, role, count);
        }
    }
}

static void add_components(struct gm_reading *reading, struct gm_span names)
{
    add_all_names(reading, names, GM_ENTRY_COMPONENT, &reading->component_count);
}

/* Adds p_NAME or v_NAME for every coordinate, or NAME_t of a field. */
static void add_derived(struct gm_reading *reading, const char *before, const char *behind,
                        enum gm_entry_role role, size_t n)
{
    size_t *count = role == GM_ENTRY_COMPONENT ? &reading->component_count : &reading->velocity_count;
    for (size_t i = 0, made = 0; made < n; i++) {
        struct gm_entry entry = reading->entries[i];
        if (entry.role != GM_ENTRY_COMPONENT) {
            continue;
        }
        entry.name = gm_arena_print(reading->system->arena, "%s%s%s", before, entry.name, behind);
        entry.length = strlen(entry.name);
        entry.role = role;
        entry.number = (*count)++;
        add_name(reading, entry);
        made++;
    }
}

/* Adds the entries NAME[n] of a list, with n values or one for all. */
static void add_list(struct gm_reading *reading, const struct gm_target *target)
{
    const size_t first = reading->parameter_count, entries = reading->entry_count;
    add_names(reading, target, GM_ENTRY_PARAMETER, &reading->parameter_count);
    struct gm_span values = target->value, value = values;
    size_t pieces = 0;
    for (size_t i = first; i < reading->parameter_count; i++) {
        pieces += gm_span_take(reading->text, &values, ",", &value);
        reading->entries[entries + i - first].value = value;
    }
    gm_system_refuse_if(
        reading->system,
        values.begin < values.end || (pieces != 1 && pieces != reading->parameter_count - first),
        target->value.begin, "%zu values were expected, or one for all", reading->parameter_count - first);
}

/* parameter: NAME = value, ...; low .. high; meaning; unit, or parameter: NAME[n] = value, ...; ... */
static void add_parameters(struct gm_reading *reading, const struct gm_read_line *line, bool lists)
{
    struct gm_span rest = line->value, given, piece;
    gm_span_take(reading->text, &rest, ";", &given);
    const struct gm_target whole = gm_reading_assignment(reading, given);
    const bool is_list = whole.index.begin < whole.index.end;
    if (is_list != lists) {
        return;
    }
    const size_t first = reading->parameter_count, entries = reading->entry_count;
    if (is_list) {
        add_list(reading, &whole);
    }
    while (!is_list && gm_span_take(reading->text, &given, ",", &piece)) {
        const struct gm_target target = gm_reading_assignment(reading, piece);
        gm_system_refuse_if(reading->system, target.index.begin < target.index.end, target.index.begin,
                            "a list needs a line of its own");
        add_names(reading, &target, GM_ENTRY_PARAMETER, &reading->parameter_count);
    }
    const struct gm_written_range range = gm_reading_range(reading, rest);
    for (size_t i = first; i < reading->parameter_count; i++) {
        const struct gm_entry *entry = &reading->entries[entries + i - first];
        struct gm_system_variable *variable = &reading->system->variables[i];
        variable->start_place = entry->place;
        variable->text = gm_reading_text(reading, entry->value);
        variable->low = range.low;
        variable->high = range.high;
        variable->meaning = gm_reading_text(reading, range.meaning);
        variable->unit = gm_reading_text(reading, range.unit);
    }
}

/* parameter: NAME = value; low .. high; meaning, of a room: a number, or a word that formulas cannot hold */
static void add_key(struct gm_reading *reading, const struct gm_read_line *line)
{
    struct gm_user_system *system = reading->system;
    struct gm_span meaning = line->value, after, value, piece;
    gm_span_take(reading->text, &meaning, ";", &value);
    const struct gm_target target = gm_reading_target(reading, &value);
    const bool assigned = value.begin < value.end && reading->text[value.begin] == '=';
    gm_system_refuse_if(system, target.index.begin < target.index.end, target.index.begin,
                        "a room has no lists");
    gm_system_refuse_if(system, value.begin < value.end && !assigned, value.begin, "= was expected");
    value.begin += assigned;
    const size_t other = gm_span_until(reading->text, value, "=");
    gm_system_refuse_if(system, other < value.end, other, "each parameter of a room has a line of its own");
    struct gm_entry entry = gm_reading_entry_for(reading, &target, GM_ENTRY_PARAMETER);
    entry.number = reading->parameter_count++;
    struct gm_system_variable *variable = add_name(reading, entry);
    const char *text = gm_reading_text(reading, value);
    for (size_t i = 0; i < reading->value_count; i++) {
        text = strcmp(reading->values[i].name, variable->name) == 0 ? reading->values[i].text : text;
    }
    gm_number_parse(text, &variable->value); /* else it is NaN */
    variable->text = gm_arena_print(system->arena, "%s", text);
    variable->start_place = entry.place;
    struct gm_entry *added = &reading->entries[reading->entry_count - 1];
    added->node = gm_formula_constant(&system->graph, variable->value);
    gm_system_need_graph(system);
    added->read = true;
    after = meaning;
    if (gm_span_take(reading->text, &after, ";", &piece) &&
        gm_span_until(reading->text, piece, "..") < piece.end) {
        const struct gm_written_range range = gm_reading_range(reading, piece);
        variable->low = range.low;
        variable->high = range.high;
        meaning = after;
    }
    variable->meaning = gm_reading_text(reading, meaning);
}

/* Replaces values of the file by the given ones. */
static void give(struct gm_reading *reading)
{
    for (size_t i = reading->system->choices.count; i < reading->entry_count; i++) {
        struct gm_entry *entry = &reading->entries[i];
        const char *name = reading->system->variables[entry->number].name;
        double given = NAN;
        for (size_t k = 0; k < reading->value_count && !entry->read; k++) {
            if (strcmp(reading->values[k].name, name) == 0 &&
                gm_number_parse(reading->values[k].text, &given)) {
                entry->node = gm_formula_constant(&reading->system->graph, given);
                entry->read = true;
                entry->value.end = entry->value.begin;
                gm_system_need_graph(reading->system);
            }
        }
    }
}

/* Adds half the length of a field's line and the points of its grid, as the last parameters. */
static void add_ring(struct gm_reading *reading)
{
    static const struct {
        enum gm_system_word word;
        double usual;
        const char *meaning;
    } rows[GM_RING_PARAMETERS] = {{GM_WORD_HALF_LENGTH, 20, "half the length of the line"},
                                  {GM_WORD_POINTS, 400, "of the grid"}};
    for (size_t i = 0; i < GM_RING_PARAMETERS; i++) {
        const struct gm_read_line *line = gm_reading_line(reading, rows[i].word);
        struct gm_entry entry = {.name = gm_system_words[rows[i].word].word,
                                 .length = strlen(gm_system_words[rows[i].word].word),
                                 .role = GM_ENTRY_PARAMETER,
                                 .number = reading->parameter_count++,
                                 .read = true};
        double number = rows[i].usual;
        if (line) {
            struct gm_span rest = line->value;
            entry.place = line->place;
            gm_span_take(reading->text, &rest, ";", &entry.value);
            number = gm_reading_number(reading, entry.value);
        }
        entry.node = gm_formula_constant(&reading->system->graph, number);
        struct gm_system_variable *variable = add_name(reading, entry);
        variable->derived = rows[i].word == GM_WORD_POINTS; /* a whole number: a row of the scene */
        variable->text = line ? gm_reading_text(reading, entry.value) : NULL;
        variable->meaning = gm_arena_print(reading->system->arena, "%s", rows[i].meaning);
        variable->unit = gm_reading_text(reading, (struct gm_span){0, 0});
    }
}

/* Lists follow the numbers that give their lengths; then all formulas are read, which may hold both. */
void gm_declared_parameters(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    const struct gm_written_choices *choices = &system->choices;
    for (size_t i = 0; i < choices->count; i++) {
        gm_reading_add(reading, (struct gm_entry){.name = choices->list[i].name,
                                                  .length = strlen(choices->list[i].name),
                                                  .place = choices->list[i].place,
                                                  .role = GM_ENTRY_CHOICE});
    }
    const bool room = gm_system_is_room(system);
    for (int lists = room; lists < 2; lists++) {
        for (size_t i = 0; i < reading->line_count; i++) {
            if (reading->lines[i].word == GM_WORD_PARAMETER && room) {
                add_key(reading, &reading->lines[i]);
            } else if (reading->lines[i].word == GM_WORD_PARAMETER) {
                add_parameters(reading, &reading->lines[i], lists);
            }
        }
        give(reading);
    }
    if (room) {
        return;
    }
    if (gm_system_is_field(system)) {
        add_ring(reading);
    }
    for (size_t i = choices->count; i < reading->entry_count; i++) {
        if (!reading->entries[i].read) {
            gm_reading_define(reading, (uint32_t)i);
        }
        const struct gm_entry *entry = &reading->entries[i];
        struct gm_system_variable *variable = &system->variables[entry->number];
        variable->value = system->graph.nodes[entry->node].value;
        gm_system_refuse_if(system, !isfinite(variable->value), entry->place, "%s is not a finite number",
                            variable->name);
        gm_system_refuse_if(system, variable->value < variable->low || variable->value > variable->high,
                            entry->place, "%s = %g lies outside of its range, %g .. %g", variable->name,
                            variable->value, variable->low, variable->high);
    }
}

/* Returns the line of a triangulation; NULL without one, and for mesh: X = F, which moves nodes. */
static const struct gm_read_line *mesh_of(const struct gm_reading *reading)
{
    const struct gm_read_line *line = gm_reading_line(reading, GM_WORD_MESH);
    return line && gm_span_until(reading->text, line->value, "=") < line->value.end ? NULL : line;
}

/* Lines that a kind of systems cannot lack, beside those by which it is known. */
static const struct {
    enum gm_system_kind kind;
    enum gm_system_word word, known_by; /* known_by: the line that a fault names */
} needed[] = {{GM_MATRICES, GM_WORD_COMPONENTS, GM_WORD_K_MATRIX},
              {GM_MATRICES, GM_WORD_L_MATRIX, GM_WORD_K_MATRIX},
              {GM_MATRICES, GM_WORD_S_FUNCTION, GM_WORD_K_MATRIX},
              {GM_LAGRANGIAN, GM_WORD_COORDINATES, GM_WORD_LAGRANGE},
              {GM_CANONICAL, GM_WORD_COORDINATES, GM_WORD_HAMILTONIAN}};

void gm_declared_kind(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    const struct gm_read_line *energy = gm_reading_line(reading, GM_WORD_HAMILTONIAN),
                              *lagrange = gm_reading_line(reading, GM_WORD_LAGRANGE),
                              *rate = gm_reading_line(reading, GM_WORD_RATE),
                              *bracket = gm_reading_line(reading, GM_WORD_BRACKET),
                              *field = gm_reading_line(reading, GM_WORD_FIELD),
                              *potential = gm_reading_line(reading, GM_WORD_POTENTIAL),
                              *matrix = gm_reading_line(reading, GM_WORD_K_MATRIX), *mesh = mesh_of(reading);
    system->alone = !matrix && !energy && !lagrange && !rate && !bracket && !field && !potential && !mesh;
    enum gm_system_kind kind = mesh                          ? GM_FORMS
                               : matrix                      ? GM_MATRICES
                               : field && rate && !potential ? GM_EVOLUTION
                               : field || system->alone      ? GM_FIELD
                               : lagrange                    ? GM_LAGRANGIAN
                               : rate                        ? GM_RATES
                               : bracket                     ? GM_POISSON
                                                             : GM_CANONICAL;
    static const char *const called[] = {
        "with H",         "with L",       "with rates",
        "with a bracket", "with a field", "with a field and its rate",
        "with K-matrix",  "of forms",     [GM_SYSTEM_KINDS] = "of nodes alone"};
    const unsigned which = system->alone ? GM_SYSTEM_KINDS : kind;
    gm_system_refuse_if(system,
                        !matrix && (gm_reading_line(reading, GM_WORD_L_MATRIX) ||
                                    gm_reading_line(reading, GM_WORD_S_FUNCTION)),
                        0, "K z_t + L z_x = grad S(z) needs lines \"K-matrix\", \"L-matrix\" and \"S\"");
    gm_system_refuse_if(system, system->alone && !gm_reading_line(reading, GM_WORD_CELL), 0,
                        "the file has no equation: H, L, rate, bracket and H, field and V or rate, cell, "
                        "or K-matrix, L-matrix and S");
    if (field && !mesh && gm_span_until(reading->text, field->value, "=") < field->value.end) {
        gm_system_refuse(system, field->place,
                         "a field with a degree needs a line \"mesh\", as in mesh: sphere 1 3");
    }
    if (!field != !potential && kind != GM_EVOLUTION && kind != GM_MATRICES && kind != GM_FORMS) {
        gm_system_refuse(system, (field ? field : potential)->place,
                         field
                             ? "a field needs V, as in u_tt = u_xx - V'(u), or its rate, as in rate: u = -u_x"
                             : "V is of a field, which a line \"field\" names");
    }
    if (kind == GM_POISSON && !energy) {
        gm_system_refuse(system, bracket->place, "a system with a bracket needs H");
    }
    for (size_t i = 0; i < reading->line_count; i++) {
        const struct gm_read_line *line = &reading->lines[i];
        gm_system_refuse_if(system, !(gm_system_words[line->word].kinds & 1u << which), line->place,
                            "a system %s has no line \"%s\"", called[which],
                            gm_system_words[line->word].word);
    }
    for (size_t i = 0; i < reading->line_count && reading->degenerate; i++) {
        const enum gm_system_word word = reading->lines[i].word;
        gm_system_refuse_if(
            system, word == GM_WORD_MOMENTA || word == GM_WORD_FORCE || word == GM_WORD_CONSTRAINT,
            reading->lines[i].place,
            "L is linear in the velocities: its state is the coordinates alone, and it has no line "
            "\"%s\"",
            gm_system_words[word].word);
    }
    for (size_t i = 0; i < GM_COUNT(needed); i++) {
        if (needed[i].kind == kind && !gm_reading_line(reading, needed[i].word)) {
            gm_system_refuse(system, gm_reading_line(reading, needed[i].known_by)->place,
                             "a system %s needs a line \"%s\"", called[kind],
                             gm_system_words[needed[i].word].word);
        }
    }
    system->kind = reading->degenerate ? GM_POISSON : kind;
}

/* Adds the new components on the left side of a rate or a bracket. */
static void add_components_of(struct gm_reading *reading, struct gm_span piece)
{
    struct gm_span rest = {piece.begin, gm_span_until(reading->text, piece, "=")};
    for (rest = gm_span_trimmed(reading->text, rest); rest.begin < rest.end;
         rest = gm_span_trimmed(reading->text, rest)) {
        const struct gm_target target = gm_reading_target(reading, &rest);
        gm_system_refuse_if(reading->system, target.index.begin < target.index.end, target.name.begin,
                            "a system with lists needs a line \"components\"");
        if (!gm_reading_named(reading, target.name)) {
            add_names(reading, &target, GM_ENTRY_COMPONENT, &reading->component_count);
        }
    }
}

/* Adds components in the order of rates and brackets. */
static void add_components_in_order(struct gm_reading *reading, enum gm_system_word word)
{
    for (size_t i = 0; i < reading->line_count; i++) {
        struct gm_span rest = reading->lines[i].value, piece;
        while (reading->lines[i].word == word && gm_span_take(reading->text, &rest, ",", &piece)) {
            add_components_of(reading, piece);
        }
    }
}

/* Returns the number of the component that a text names; SIZE_MAX for another text. */
static size_t component_named(struct gm_reading *reading, struct gm_span name)
{
    const struct gm_entry *entry = gm_reading_named(reading, gm_span_trimmed(reading->text, name));
    return entry && entry->role == GM_ENTRY_COMPONENT ? entry->number : SIZE_MAX;
}

static bool names(struct gm_reading *reading, struct gm_span text, size_t component)
{
    bool found = false;
    for (size_t i = text.begin, end = i; i < text.end && !found; i = end + (end == i)) {
        for (end = i; end < text.end &&
                      (isalnum((unsigned char)reading->text[end]) || strchr("_[]", reading->text[end]));) {
            end++;
        }
        found = component_named(reading, (struct gm_span){i, end}) == component;
    }
    return found;
}

/* Numbers the components of x' = v: x from 0 on, v from n / 2 on, where `order` is SIZE_MAX. Returns false unless
   these are all; and for one pair whose v' names v, which has no use of another order. */
static bool pair_components(struct gm_reading *reading, size_t *order)
{
    const size_t n = reading->component_count;
    size_t places = 0;
    for (size_t i = 0; i < reading->line_count; i++) {
        struct gm_span rest = reading->lines[i].value, piece;
        while (reading->lines[i].word == GM_WORD_RATE && gm_span_take(reading->text, &rest, ",", &piece)) {
            const size_t equals = gm_span_until(reading->text, piece, "=");
            if (equals == piece.end) { /* it is refused when it is read */
                return false;
            }
            const size_t x = component_named(reading, (struct gm_span){piece.begin, equals}),
                         v = component_named(reading, (struct gm_span){equals + 1, piece.end});
            const bool damped =
                n == 2 && v == SIZE_MAX && names(reading, (struct gm_span){equals + 1, piece.end}, x);
            if (x == SIZE_MAX || damped) {
                return false;
            }
            if (v != SIZE_MAX) {
                if (x == v || order[x] != SIZE_MAX || order[v] != SIZE_MAX) {
                    return false;
                }
                order[x] = places++;
                order[v] = n / 2 + order[x];
            }
        }
    }
    return 2 * places == n;
}

/* Reorders the components of x' = v and the rates of v, which may have any order: all x, then all v. The first of two
   fields, which is drawn, stays. */
static void put_places_first(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    const size_t n = reading->component_count, first = system->variable_count - n;
    size_t *order = gm_arena_take(system->arena, n + 1, sizeof *order);
    struct gm_system_variable *moved = gm_arena_take(system->arena, n + 1, sizeof *moved);
    memset(order, 0xff, n * sizeof *order);
    if ((n == 2 && gm_system_is_field(system)) || !pair_components(reading, order)) {
        return;
    }
    for (size_t i = 0; i < n; i++) {
        moved[order[i]] = system->variables[first + i];
    }
    memcpy(system->variables + first, moved, n * sizeof *moved);
    for (size_t i = 0; i < reading->entry_count; i++) {
        struct gm_entry *entry = &reading->entries[i];
        entry->number = entry->role == GM_ENTRY_COMPONENT ? order[entry->number] : entry->number;
    }
}

/* Adds the tangents of all components: xi1_q, xi2_q. */
static void add_tangents(struct gm_reading *reading)
{
    const struct gm_read_line *line = gm_reading_line(reading, GM_WORD_TANGENTS);
    const size_t n = reading->component_count;
    if (!line || reading->without_tangents) {
        return;
    }
    const long count = gm_reading_whole(reading, line->value);
    gm_system_refuse_if(reading->system, count < 1 || count > GM_MOST_TANGENTS || (size_t)count > n,
                        line->value.begin, "tangents is %ld: there are 1 to %zu tangents of %zu component%s",
                        count, n < GM_MOST_TANGENTS ? n : GM_MOST_TANGENTS, n, gm_plural((double)n));
    gm_system_refuse_if(reading->system, gm_reading_line(reading, GM_WORD_CONSTRAINT), line->place,
                        "a system with constraints has no tangents");
    for (long k = 1; k <= count; k++) {
        char before[32];
        snprintf(before, sizeof before, "xi%ld_", k);
        add_derived(reading, before, "", GM_ENTRY_COMPONENT, n);
    }
    reading->system->tangents = (size_t)count;
}

/* Reorders variables: parameters, components, velocities become components, t, parameters, velocities,
   components at the start, components of the exact solution. Tangents move behind what they belong to. */
static void arrange(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    const size_t n = reading->component_count, p = reading->parameter_count, v = reading->velocity_count;
    const size_t solutions = gm_system_is_field(system) ? 0 : n; /* of forms they are not used */
    struct gm_system_variable *all = gm_arena_take(system->arena, 2 * n + 1 + p + v + solutions, sizeof *all),
                              *met = system->variables;
    all[n] = unsaid;
    all[n].name = gm_arena_print(system->arena, "t");
    /* a text without declarations has no variables; its fault comes later */
    if (met) {
        memcpy(all, met + p, n * sizeof *all);
        memcpy(all + n + 1, met, p * sizeof *all);
        memcpy(all + n + 1 + p, met + p + n, v * sizeof *all);
    }
    system->n = n;
    for (size_t i = 0; i < reading->entry_count && system->tangents > 0; i++) {
        struct gm_entry *entry = &reading->entries[i];
        if (entry->role == GM_ENTRY_COMPONENT) {
            const size_t from = entry->number, motion = gm_system_motion(system);
            entry->number = gm_system_component(system, from % motion, from / motion);
            all[entry->number] = met[p + from];
        }
    }
    system->variables = all;
    system->parameters = n + 1;
    system->velocities = n + 1 + p;
    system->initial = system->velocities + v;
    system->variable_count = system->initial;
    system->exact = system->initial + n;
    for (size_t i = 0; i < n + solutions; i++) {
        struct gm_system_variable *other = &all[system->initial + i];
        *other = all[n];
        other->name = gm_arena_print(system->arena, i < n ? "%s(0)" : "exact(%s)", all[i % n].name);
        system->variable_count++;
    }
    if (gm_system_is_form(system) || gm_system_is_room(system)) {
        system->first_call =
            system->velocities + (gm_system_is_room(system) ? GM_ROOM_VARIABLES : GM_FORM_PLACES);
        system->calls = gm_arena_take(system->arena, GM_MOST_FORM_CALLS, sizeof *system->calls);
    }
    all[n].value = 0; /* unless the start names another time */
}

/* Adds a place, x, y or z, which is not a component, with the offset of that line. */
static void add_place(struct gm_reading *reading, const char *name, size_t offset)
{
    add_name(reading, (struct gm_entry){.name = name,
                                        .length = strlen(name),
                                        .place = offset,
                                        .role = GM_ENTRY_VELOCITY,
                                        .number = reading->velocity_count++});
}

/* Adds the components of a line, of which there are `least` to `most`, and x. */
static void add_counted(struct gm_reading *reading, const struct gm_read_line *line, size_t least,
                        size_t most, const char *sentence)
{
    add_components(reading, line->value);
    const size_t n = reading->component_count;
    gm_system_refuse_if(reading->system, n < least || n > most, line->value.begin, "there are %zu to %zu %s",
                        least, most, sentence);
    add_place(reading, "x", line->place);
}

/* Adds u and u_t, and the variables of densities: x and u_x. */
static void add_field(struct gm_reading *reading, const struct gm_read_line *field)
{
    if (!field) { /* nodes alone */
        for (size_t i = 0; i < 2; i++) {
            add_variable(reading, &(struct gm_entry){.name = ""});
            reading->component_count++;
        }
        add_place(reading, "x", 0);
        add_variable(reading, &(struct gm_entry){.name = ""});
        reading->velocity_count++;
        return;
    }
    add_components(reading, field->value);
    gm_system_refuse_if(reading->system, reading->component_count != 1, field->value.begin,
                        "a field has one name, as in field: u");
    add_derived(reading, "", "_t", GM_ENTRY_COMPONENT, 1);
    add_place(reading, "x", field->place);
    add_derived(reading, "", "_x", GM_ENTRY_VELOCITY, 1);
}

/* The form that a line declares with a name and a degree; *name is trimmed. */
static struct gm_form_declared form_of(struct gm_reading *reading, struct gm_span piece,
                                       enum gm_system_word word, struct gm_span *name)
{
    static const char *const degrees[] = {"0-form",      "1-form",      "2-form", "dual 0-form",
                                          "dual 1-form", "dual 2-form", NULL};
    const size_t end = piece.end, equals = gm_span_until(reading->text, piece, "=");
    *name = gm_reading_between(reading, piece.begin, equals);
    const char *text = gm_reading_text(reading, gm_reading_between(reading, equals + (equals < end), end));
    const size_t degree = gm_span_among(text, (struct gm_span){0, strlen(text)}, degrees);
    const int length = gm_brief_length(name->end - name->begin);
    gm_system_refuse_if(reading->system, !degrees[degree] && equals == end, name->begin,
                        "%.*s has no degree: write %s: %.*s = 0-form", length, reading->text + name->begin,
                        gm_system_words[word].word, length, reading->text + name->begin);
    gm_system_refuse_if(reading->system, !degrees[degree], equals + 1,
                        "a form is a 0-form, 1-form or 2-form, or a dual one: dual 0-form, dual 1-form, "
                        "dual 2-form");
    return (struct gm_form_declared){(int)(degree % 3), degree >= 3, word == GM_WORD_UNKNOWN,
                                     name->begin,       GM_NO_NODE,  GM_NO_NODE,
                                     GM_NO_NODE,        GM_NO_NODE,  0};
}

/* NAME = k-form, NAME = dual k-form, .. */
static void add_forms(struct gm_reading *reading, enum gm_system_word word)
{
    const struct gm_read_line *line = gm_reading_line(reading, word);
    struct gm_span rest = line ? line->value : (struct gm_span){0, 0}, piece, name;
    struct gm_user_system *system = reading->system;
    while (gm_span_take(reading->text, &rest, ",", &piece)) {
        const struct gm_form_declared form = form_of(reading, piece, word, &name);
        system->forms =
            gm_arena_grown(system->arena, system->forms, reading->component_count, sizeof *system->forms);
        system->forms[reading->component_count] = form;
        const struct gm_target target = gm_reading_target(reading, &name);
        add_names(reading, &target, GM_ENTRY_COMPONENT, &reading->component_count);
    }
}

/* Adds a variable that no formula finds by a name. */
static void add_unnamed(struct gm_reading *reading, const char *name, size_t *count)
{
    ++*count;
    add_variable(reading, &(struct gm_entry){.name = name});
}

/* Adds the place, and unnamed variables for operators. */
static void add_places(struct gm_reading *reading)
{
    static const char *const places[GM_FORM_PLACES] = {"x", "y", "z", "s"};
    for (size_t i = 0; i + 1 < GM_FORM_PLACES; i++) {
        add_place(reading, places[i], 0);
    }
    for (size_t i = 0; i < 1 + GM_MOST_FORM_CALLS; i++) { /* s is found on parts of the boundary alone */
        add_unnamed(reading, i > 0 ? "" : places[GM_FORM_PLACES - 1], &reading->velocity_count);
    }
}

/* True if the file has a parameter, a choice or a let of that name. */
static bool defines(const struct gm_reading *reading, const char *name)
{
    const size_t length = strlen(name);
    bool found = gm_reading_entry(reading, name, length, false, 0) != NULL;
    for (size_t i = 0; i < reading->line_count && !found; i++) {
        const struct gm_read_line *line = &reading->lines[i];
        const size_t begin = line->value.begin;
        found = line->word == GM_WORD_LET &&
                gm_name_length(reading->text + begin, line->value.end - begin) == length &&
                strncmp(reading->text + begin, name, length) == 0;
    }
    return found;
}

/* Adds the forms of a room's flow, unless the file takes a name for something else, and its other variables. */
static void add_room(struct gm_reading *reading)
{
    static const struct {
        const char *name;
        struct gm_form_declared form;
    } rows[GM_ROOM_FORMS] = {[GM_ROOM_PSI] = {"psi", {.degree = 0}},
                             [GM_ROOM_W] = {"w", {.degree = 2, .dual = true}},
                             [GM_ROOM_U] = {"u", {.degree = 1, .dual = true}},
                             [GM_ROOM_THETA] = {"scalar", {.degree = 0}},
                             [GM_ROOM_WARMTH] = {"temperature", {.degree = 0}}};
    struct gm_user_system *system = reading->system;
    system->forms = gm_arena_take(system->arena, GM_ROOM_FORMS, sizeof *system->forms);
    for (size_t i = 0; i < GM_ROOM_FORMS; i++) {
        const char *name = rows[i].name;
        system->forms[i] = rows[i].form;
        if (defines(reading, name) || (i == GM_ROOM_WARMTH && !gm_reading_line(reading, GM_WORD_BUOYANCY))) {
            add_unnamed(reading, "", &reading->component_count);
        } else {
            add_name(reading, (struct gm_entry){.name = name,
                                                .length = strlen(name),
                                                .role = GM_ENTRY_COMPONENT,
                                                .number = reading->component_count++});
        }
    }
    for (size_t i = 0; i < GM_ROOM_VARIABLES; i++) {
        if (gm_room_variables[i][0]) {
            add_place(reading, gm_room_variables[i], 0);
        } else {
            add_unnamed(reading, "", &reading->velocity_count);
        }
    }
    for (size_t i = 0; i < GM_MOST_FORM_CALLS; i++) {
        add_unnamed(reading, "", &reading->velocity_count);
    }
}

/* Adds coordinates and momenta, and velocities of a Lagrangian. */
static void add_coordinates(struct gm_reading *reading, const struct gm_read_line *coordinates)
{
    struct gm_user_system *system = reading->system;
    const struct gm_read_line *momenta = gm_reading_line(reading, GM_WORD_MOMENTA),
                              *velocities = gm_reading_line(reading, GM_WORD_VELOCITIES);
    add_components(reading, coordinates->value);
    const size_t n = reading->component_count;
    if (momenta) {
        add_components(reading, momenta->value);
    } else if (!reading->degenerate) {
        add_derived(reading, "p_", "", GM_ENTRY_COMPONENT, n);
    }
    if (momenta && reading->component_count != 2 * n) {
        gm_system_refuse(system, momenta->place, "%zu momenta for %zu coordinate%s",
                         reading->component_count - n, n, gm_plural((double)n));
    }
    if (system->kind == GM_CANONICAL) {
        return;
    }
    if (velocities) {
        add_all_names(reading, velocities->value, GM_ENTRY_VELOCITY, &reading->velocity_count);
    } else {
        add_derived(reading, "v_", "", GM_ENTRY_VELOCITY, n);
    }
    if (reading->velocity_count != n) {
        gm_system_refuse(system, velocities->place, "%zu velocities for %zu coordinates",
                         reading->velocity_count, n);
    }
}

void gm_declared_state(struct gm_reading *reading)
{
    static const char *const derivatives[GM_MOST_DERIVATIVES] = {"_x", "_xx", "_xxx", "_xxxx"};
    const struct gm_read_line *coordinates = gm_reading_line(reading, GM_WORD_COORDINATES),
                              *components = gm_reading_line(reading, GM_WORD_COMPONENTS),
                              *field = gm_reading_line(reading, GM_WORD_FIELD),
                              *list = coordinates ? coordinates : components;
    const enum gm_system_kind kind = reading->system->kind;
    if (coordinates) {
        add_coordinates(reading, coordinates);
    } else if (kind == GM_FIELD) {
        add_field(reading, field);
    } else if (kind == GM_EVOLUTION) {
        add_counted(reading, field, 1, GM_MOST_FIELDS, "fields, as in field: u v");
        for (size_t k = 0; k < GM_MOST_DERIVATIVES; k++) {
            add_derived(reading, "", derivatives[k], GM_ENTRY_VELOCITY, reading->component_count);
        }
    } else if (kind == GM_MATRICES) {
        add_counted(reading, components, 2, GM_MOST_OF_MATRICES, "components, as in components: u v w");
    } else if (kind == GM_ROOM) {
        add_room(reading);
    } else if (kind == GM_FORMS) {
        add_forms(reading, GM_WORD_FIELD);
        add_forms(reading, GM_WORD_UNKNOWN);
        add_places(reading);
    } else if (components) {
        add_components(reading, components->value);
    } else {
        add_components_in_order(reading, kind == GM_RATES ? GM_WORD_RATE : GM_WORD_BRACKET);
        if (kind == GM_RATES) {
            put_places_first(reading);
        }
    }
    gm_system_refuse_if(reading->system, reading->component_count > GM_MOST_COMPONENTS,
                        list ? list->value.begin : 0, "a system has at most %d components",
                        GM_MOST_COMPONENTS);
    add_tangents(reading);
    arrange(reading);
    gm_reading_add(reading, (struct gm_entry){.name = "t", .length = 1, .role = GM_ENTRY_TIME});
}

void gm_declared_relations(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    for (size_t i = 0; i < reading->entry_count; i++) {
        const struct gm_entry *entry = &reading->entries[i];
        if (entry->role == GM_ENTRY_PARAMETER && entry->value.begin < entry->value.end) {
            const size_t number = system->parameters + entry->number;
            const gm_node_id node = gm_reading_formula(reading, entry->value);
            system->variables[number].start = node;
            /* half the length of the line is a key unless it follows from others */
            system->variables[number].derived |= number == system->velocities - 2 &&
                                                 gm_system_is_field(system) &&
                                                 system->graph.nodes[node].operation != GM_CONSTANT;
        }
    }
}

/* True if a line defines a function. */
static bool is_function(struct gm_reading *reading, const struct gm_read_line *line)
{
    const size_t name = line->value.begin + gm_name_length(reading->text + line->value.begin,
                                                           line->value.end - line->value.begin);
    return line->word == GM_WORD_LET && name > line->value.begin &&
           reading->text[gm_reading_between(reading, name, line->value.end).begin] == '(';
}

/* NAME(argument, ...) = body */
static void add_function(struct gm_reading *reading, struct gm_span rest)
{
    const struct gm_user_system *system = reading->system;
    struct gm_span left, argument;
    reading->definitions = gm_arena_grown(reading->system->arena, reading->definitions,
                                          reading->definition_count, sizeof *reading->definitions);
    const struct gm_target target = gm_reading_target(reading, &rest);
    gm_span_take(reading->text, &rest, "=", &left);
    struct gm_definition *definition = &reading->definitions[reading->definition_count];
    *definition = (struct gm_definition){.name = target.name, .body = gm_span_trimmed(reading->text, rest)};
    const size_t close = gm_span_until(reading->text, (struct gm_span){left.begin + 1, left.end}, ")");
    gm_system_refuse_if(system, close + 1 != left.end || definition->body.begin == definition->body.end,
                        close, "%s was expected",
                        close >= left.end      ? ")"
                        : close + 1 < left.end ? "="
                                               : "a formula");
    left = gm_reading_between(reading, left.begin + 1, close);
    while (gm_span_take(reading->text, &left, ",", &argument)) {
        const char *name = reading->text + argument.begin;
        const size_t length = gm_name_length(name, argument.end - argument.begin);
        bool twice = false;
        for (size_t i = 0; i < definition->count; i++) {
            const struct gm_span other = definition->arguments[i];
            twice |= gm_text_same(reading->text + other.begin, other.end - other.begin, name, length);
        }
        gm_system_refuse_if(system,
                            length == 0 || argument.begin + length < argument.end ||
                                gm_formula_reserves(name, length),
                            argument.begin, "the name of an argument was expected");
        gm_system_refuse_if(system, twice, argument.begin, "%.*s is an argument twice",
                            gm_brief_length(length), name);
        gm_system_refuse_if(system, definition->count == GM_MOST_ARGUMENTS, argument.begin,
                            "a function has at most %d arguments", GM_MOST_ARGUMENTS);
        definition->arguments[definition->count++] = argument;
    }
    gm_system_refuse_if(system, definition->count == 0, close, "the name of an argument was expected");
    reading->definition_count++;
}

void gm_declared_functions(struct gm_reading *reading)
{
    for (size_t i = 0; i < reading->line_count; i++) {
        if (is_function(reading, &reading->lines[i])) {
            add_function(reading, reading->lines[i].value);
        }
    }
}

/* Adds the names of functions. */
static void add_functions(struct gm_reading *reading)
{
    for (size_t i = 0; i < reading->definition_count; i++) {
        const struct gm_target target = {.name = reading->definitions[i].name};
        const struct gm_entry entry = gm_reading_entry_for(reading, &target, GM_ENTRY_FUNCTION),
                              *other = gm_reading_named(reading, target.name);
        const int brief = gm_brief_length(entry.length);
        gm_system_refuse_if(reading->system, gm_formula_reserves(entry.name, entry.length), entry.place,
                            "%.*s is a function of the program", brief, entry.name);
        gm_system_refuse_if(reading->system, other && other->role == GM_ENTRY_COMPONENT, entry.place,
                            "%.*s is a component (%.*s(0) is its start)", brief, entry.name, brief,
                            entry.name);
        gm_reading_add(reading, entry);
    }
}

void gm_declared_lets(struct gm_reading *reading)
{
    add_functions(reading);
    for (size_t i = 0; i < reading->line_count; i++) {
        const bool observed = reading->lines[i].word == GM_WORD_OBSERVE && reading->system->kind != GM_ROOM;
        struct gm_span value = reading->lines[i].value;
        value.end = observed ? gm_span_until(reading->text, value, ";") : value.end;
        if ((reading->lines[i].word != GM_WORD_LET && !observed) ||
            is_function(reading, &reading->lines[i]) ||
            (observed && gm_span_until(reading->text, value, "..") < value.end)) { /* a line with a counter */
            continue;
        }
        const struct gm_target target = gm_reading_assignment(reading, value);
        struct gm_entry entry =
            gm_reading_entry_for(reading, &target, observed ? GM_ENTRY_OBSERVED : GM_ENTRY_NAMED);
        entry.indexed = target.index.begin < target.index.end;
        if (observed && entry.indexed) {
            continue;
        }
        entry.index = entry.indexed ? gm_reading_whole(reading, target.index) : 0;
        gm_reading_add(reading, entry);
    }
    for (uint32_t i = 0; i < reading->entry_count; i++) {
        if (reading->entries[i].role >= GM_ENTRY_NAMED && !reading->entries[i].read) {
            gm_reading_define(reading, i);
        }
    }
}
