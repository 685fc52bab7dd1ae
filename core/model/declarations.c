/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The declarations of a system: its kind, its parameters, the names of its state, its lets. */
#include "core/model/declarations.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
    if (!gm_reading_reserve(reading, (void **)&system->variables, system->variable_count,
                            sizeof *system->variables)) {
        return NULL;
    }
    struct gm_system_variable *variable = &system->variables[system->variable_count];
    *variable = unsaid;
    char index[32] = "";
    if (entry->indexed) {
        snprintf(index, sizeof index, "[%ld]", entry->index);
    }
    variable->name = gm_arena_print(system->arena, "%.*s%s", (int)entry->length, entry->name, index);
    system->variable_count += variable->name != NULL;
    return variable->name || gm_fail_memory(&reading->fault) ? variable : NULL;
}

/* Adds a name, or all elements of a list, in a role, numbered from *count. */
static bool add_names(struct gm_reading *reading, const struct gm_target *target, enum gm_entry_role role,
                      size_t *count)
{
    struct gm_entry entry = gm_reading_entry_for(reading, target, role);
    long low = 0, high = 0;
    entry.indexed = target->index.begin < target->index.end;
    if (entry.indexed && !gm_reading_bounds(reading, target->index, "elements of a list", &low, &high)) {
        return gm_fail_first(&reading->fault, target->index.begin,
                             "the bounds of a list were expected, as in %.*s[1..3]",
                             (int)(entry.length < 60 ? entry.length : 60), entry.name);
    }
    if (high < low) {
        return gm_fail_first(&reading->fault, target->index.begin, "a list has at least one element");
    }
    for (long i = low; i <= high && !reading->fault.failed; i++) {
        entry.index = i;
        entry.number = (*count)++;
        if (gm_reading_add(reading, entry)) {
            add_variable(reading, &entry);
        }
    }
    return !reading->fault.failed;
}

/* Adds names separated by blanks or commas. */
static bool add_all_names(struct gm_reading *reading, struct gm_span rest, enum gm_entry_role role,
                          size_t *count)
{
    for (rest = gm_span_trimmed(reading->text, rest); rest.begin < rest.end && !reading->fault.failed;
         rest = gm_span_trimmed(reading->text, rest)) {
        struct gm_target target;
        if (reading->text[rest.begin] == ',') {
            rest.begin++;
        } else if (gm_reading_target(reading, &rest, &target)) {
            add_names(reading, &target, role, count);
        }
    }
    return !reading->fault.failed;
}

/* Adds p_NAME or v_NAME for every coordinate, or NAME_t of a field. */
static bool add_derived(struct gm_reading *reading, const char *before, const char *behind,
                        enum gm_entry_role role, size_t *count, size_t n)
{
    for (size_t i = 0, made = 0; made < n && !reading->fault.failed; i++) {
        struct gm_entry entry = reading->entries[i];
        if (entry.role != GM_ENTRY_COMPONENT) {
            continue;
        }
        entry.name = gm_arena_print(reading->system->arena, "%s%s%s", before, entry.name, behind);
        if (!entry.name) {
            return gm_fail_memory(&reading->fault);
        }
        entry.length = strlen(entry.name);
        entry.role = role;
        entry.number = (*count)++;
        if (gm_reading_add(reading, entry)) {
            add_variable(reading, &entry);
        }
        made++;
    }
    return !reading->fault.failed;
}

/* parameter: NAME = value; low .. high; meaning; unit */
static bool add_parameter(struct gm_reading *reading, const struct gm_system_line *line, bool lists)
{
    struct gm_span rest = line->value, piece;
    struct gm_written_range range;
    struct gm_target target;
    gm_span_take(reading->text, &rest, ";", &piece);
    if (!gm_reading_assignment(reading, piece, &target)) {
        return false;
    }
    const bool is_list = target.index.begin < target.index.end;
    if (is_list != lists) {
        return true;
    }
    const size_t first = reading->parameter_count, entries = reading->entry_count;
    if (!add_names(reading, &target, GM_ENTRY_PARAMETER, &reading->parameter_count)) {
        return false;
    }
    struct gm_span values = target.value, value = values;
    size_t pieces = 0;
    for (size_t i = first; i < reading->parameter_count && !reading->fault.failed; i++) {
        struct gm_entry *entry = &reading->entries[entries + i - first];
        struct gm_system_variable *variable = &reading->system->variables[i];
        pieces += is_list && gm_span_take(reading->text, &values, ",", &value);
        entry->value = value;
        variable->start_place = entry->place;
        variable->text = gm_reading_text(reading, value);
    }
    if (is_list &&
        (values.begin < values.end || (pieces != 1 && pieces != reading->parameter_count - first))) {
        return gm_fail_first(&reading->fault, target.value.begin, "%zu values were expected, or one for all",
                             reading->parameter_count - first);
    }
    if (!gm_reading_range(reading, rest, &range)) {
        return false;
    }
    for (size_t i = first; i < reading->parameter_count; i++) {
        struct gm_system_variable *variable = &reading->system->variables[i];
        variable->low = range.low;
        variable->high = range.high;
        variable->meaning = gm_reading_text(reading, range.meaning);
        variable->unit = gm_reading_text(reading, range.unit);
    }
    return !reading->fault.failed;
}

/* Replaces values of the file by the given ones. */
static void give(struct gm_reading *reading)
{
    for (size_t i = reading->system->choices.count; i < reading->entry_count && !reading->fault.failed; i++) {
        struct gm_entry *entry = &reading->entries[i];
        const char *name = reading->system->variables[entry->number].name;
        double given = NAN;
        for (size_t k = 0; k < reading->value_count && !entry->read; k++) {
            if (strcmp(reading->values[k].name, name) == 0 &&
                gm_number_parse(reading->values[k].text, &given)) {
                entry->node = gm_formula_constant(&reading->system->graph, given);
                entry->read = true;
                entry->value.end = entry->value.begin;
                if (reading->system->graph.failed) {
                    gm_fail_memory(&reading->fault);
                }
            }
        }
    }
}

/* Adds half the length of a field's line and the points of its grid, as the last parameters. */
static bool add_ring(struct gm_reading *reading)
{
    static const struct {
        enum gm_system_word word;
        double usual;
        const char *meaning;
    } rows[GM_RING_PARAMETERS] = {{GM_WORD_HALF_LENGTH, 20, "half the length of the line"},
                                  {GM_WORD_POINTS, 400, "of the grid"}};
    for (size_t i = 0; i < GM_RING_PARAMETERS; i++) {
        const struct gm_system_line *line = gm_reading_line(reading, rows[i].word);
        struct gm_entry entry = {.name = (char *)gm_system_words[rows[i].word].word,
                                 .length = strlen(gm_system_words[rows[i].word].word),
                                 .role = GM_ENTRY_PARAMETER,
                                 .number = reading->parameter_count++,
                                 .read = true};
        double number = rows[i].usual;
        if (line) {
            struct gm_span rest = line->value;
            entry.place = line->place;
            gm_span_take(reading->text, &rest, ";", &entry.value);
            if (!gm_reading_number(reading, entry.value, &number)) {
                return false;
            }
        }
        entry.node = gm_formula_constant(&reading->system->graph, number);
        struct gm_system_variable *variable =
            gm_reading_add(reading, entry) ? add_variable(reading, &entry) : NULL;
        if (!variable) {
            return false;
        }
        variable->derived = rows[i].word == GM_WORD_POINTS; /* a whole number: a row of the scene */
        variable->text = line ? gm_reading_text(reading, entry.value) : NULL;
        variable->meaning = gm_arena_print(reading->system->arena, "%s", rows[i].meaning);
        variable->unit = gm_reading_text(reading, (struct gm_span){0, 0});
        if (!variable->meaning) {
            return gm_fail_memory(&reading->fault);
        }
    }
    return !reading->fault.failed;
}

/* Lists follow the numbers that give their lengths; then all formulas are read, which may hold both. */
bool gm_declared_parameters(struct gm_reading *reading)
{
    const struct gm_written_choices *choices = &reading->system->choices;
    for (size_t i = 0; i < choices->count; i++) {
        gm_reading_add(reading, (struct gm_entry){.name = (char *)choices->list[i].name,
                                                  .length = strlen(choices->list[i].name),
                                                  .place = choices->list[i].place,
                                                  .role = GM_ENTRY_CHOICE});
    }
    for (int lists = 0; lists < 2; lists++) {
        for (size_t i = 0; i < reading->line_count && !reading->fault.failed; i++) {
            if (reading->lines[i].word == GM_WORD_PARAMETER) {
                add_parameter(reading, &reading->lines[i], lists);
            }
        }
        give(reading);
    }
    if (gm_system_is_field(reading->system) && !reading->fault.failed && !add_ring(reading)) {
        return false;
    }
    for (size_t i = choices->count; i < reading->entry_count && !reading->fault.failed; i++) {
        const struct gm_entry *entry = &reading->entries[i];
        struct gm_system_variable *variable = &reading->system->variables[entry->number];
        if (entry->read || gm_reading_define(reading, (uint32_t)i)) {
            variable->value = reading->system->graph.nodes[reading->entries[i].node].value;
        }
        if (!reading->fault.failed && !isfinite(variable->value)) {
            gm_fail_first(&reading->fault, entry->place, "%s is not a finite number", variable->name);
        } else if (!reading->fault.failed &&
                   (variable->value < variable->low || variable->value > variable->high)) {
            gm_fail_first(&reading->fault, entry->place, "%s = %g lies outside of its range, %g .. %g",
                          variable->name, variable->value, variable->low, variable->high);
        }
    }
    return !reading->fault.failed;
}

/* Returns the line of a triangulation; NULL without one, and for mesh: X = F, which moves nodes. */
static const struct gm_system_line *mesh_of(const struct gm_reading *reading)
{
    const struct gm_system_line *line = gm_reading_line(reading, GM_WORD_MESH);
    return line && gm_span_until(reading->text, line->value, "=") < line->value.end ? NULL : line;
}

bool gm_declared_kind(struct gm_reading *reading)
{
    const struct gm_system_line *energy = gm_reading_line(reading, GM_WORD_HAMILTONIAN),
                                *lagrange = gm_reading_line(reading, GM_WORD_LAGRANGE),
                                *rate = gm_reading_line(reading, GM_WORD_RATE),
                                *bracket = gm_reading_line(reading, GM_WORD_BRACKET),
                                *field = gm_reading_line(reading, GM_WORD_FIELD),
                                *potential = gm_reading_line(reading, GM_WORD_POTENTIAL),
                                *matrix = gm_reading_line(reading, GM_WORD_K_MATRIX),
                                *mesh = mesh_of(reading);
    enum gm_system_kind kind = mesh                          ? GM_FORMS
                               : matrix                      ? GM_MATRICES
                               : field && rate && !potential ? GM_EVOLUTION
                               : field                       ? GM_FIELD
                               : lagrange                    ? GM_LAGRANGIAN
                               : rate                        ? GM_RATES
                               : bracket                     ? GM_POISSON
                                                             : GM_CANONICAL;
    static const char *const called[] = {"with H",         "with L",       "with rates",
                                         "with a bracket", "with a field", "with a field and its rate",
                                         "with K-matrix",  "of forms"};
    if (!matrix &&
        (gm_reading_line(reading, GM_WORD_L_MATRIX) || gm_reading_line(reading, GM_WORD_S_FUNCTION))) {
        return gm_fail_first(&reading->fault, 0,
                             "K z_t + L z_x = grad S(z) needs lines \"K-matrix\", \"L-matrix\" and \"S\"");
    }
    if (!matrix && !energy && !lagrange && !rate && !bracket && !field && !potential && !mesh) {
        return gm_fail_first(&reading->fault, 0,
                             "the file has no equation: H, L, rate, bracket and H, field and V or rate, "
                             "or K-matrix, L-matrix and S");
    }
    if (field && !mesh && gm_span_until(reading->text, field->value, "=") < field->value.end) {
        return gm_fail_first(&reading->fault, field->place,
                             "a field with a degree needs a line \"mesh\", as in mesh: sphere 1 3");
    }
    if (!field != !potential && kind != GM_EVOLUTION && kind != GM_MATRICES && kind != GM_FORMS) {
        return field ? gm_fail_first(
                           &reading->fault, field->place,
                           "a field needs V, as in u_tt = u_xx - V'(u), or its rate, as in rate: u = -u_x")
                     : gm_fail_first(&reading->fault, potential->place,
                                     "V is of a field, which a line \"field\" names");
    }
    if (kind == GM_POISSON && !energy) {
        return gm_fail_first(&reading->fault, bracket->place, "a system with a bracket needs H");
    }
    for (size_t i = 0; i < reading->line_count; i++) {
        const struct gm_system_line *line = &reading->lines[i];
        if (!(gm_system_words[line->word].kinds & 1u << kind)) {
            return gm_fail_first(&reading->fault, line->place, "a system %s has no line \"%s\"", called[kind],
                                 gm_system_words[line->word].word);
        }
    }
    static const enum gm_system_word needed[] = {GM_WORD_COMPONENTS, GM_WORD_L_MATRIX, GM_WORD_S_FUNCTION};
    for (size_t i = 0; i < sizeof needed / sizeof *needed && kind == GM_MATRICES; i++) {
        if (!gm_reading_line(reading, needed[i])) {
            return gm_fail_first(&reading->fault, matrix->place, "a system with K-matrix needs a line \"%s\"",
                                 gm_system_words[needed[i]].word);
        }
    }
    if (kind <= GM_LAGRANGIAN && !gm_reading_line(reading, GM_WORD_COORDINATES)) {
        return gm_fail_first(&reading->fault, (kind ? lagrange : energy)->place,
                             "a system %s needs a line \"coordinates\"", called[kind]);
    }
    reading->system->kind = kind;
    return true;
}

/* Adds the new components on the left side of a rate or a bracket. */
static bool add_components_of(struct gm_reading *reading, struct gm_span piece)
{
    struct gm_span rest = {piece.begin, gm_span_until(reading->text, piece, "=")};
    for (rest = gm_span_trimmed(reading->text, rest); rest.begin < rest.end;
         rest = gm_span_trimmed(reading->text, rest)) {
        struct gm_target target;
        if (!gm_reading_target(reading, &rest, &target)) {
            return false;
        }
        if (target.index.begin < target.index.end) {
            return gm_fail_first(&reading->fault, target.name.begin,
                                 "a system with lists needs a line \"components\"");
        }
        if (!gm_reading_entry(reading, reading->text + target.name.begin, target.name.end - target.name.begin,
                              false, 0)) {
            add_names(reading, &target, GM_ENTRY_COMPONENT, &reading->component_count);
        }
    }
    return !reading->fault.failed;
}

/* Adds components in the order of rates and brackets. */
static bool add_components_in_order(struct gm_reading *reading, enum gm_system_word word)
{
    for (size_t i = 0; i < reading->line_count && !reading->fault.failed; i++) {
        struct gm_span rest = reading->lines[i].value, piece;
        while (reading->lines[i].word == word && !reading->fault.failed &&
               gm_span_take(reading->text, &rest, ",", &piece)) {
            add_components_of(reading, piece);
        }
    }
    return !reading->fault.failed;
}

/* Returns the number of the component that a text names; SIZE_MAX for another text. */
static size_t component_named(struct gm_reading *reading, struct gm_span name)
{
    name = gm_span_trimmed(reading->text, name);
    const struct gm_entry *entry =
        gm_reading_entry(reading, reading->text + name.begin, name.end - name.begin, false, 0);
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
            const size_t x = component_named(reading, (struct gm_span){piece.begin, equals}),
                         v = component_named(reading, (struct gm_span){equals + 1, piece.end});
            const bool damped =
                n == 2 && v == SIZE_MAX && names(reading, (struct gm_span){equals + 1, piece.end}, x);
            if (equals == piece.end || x == SIZE_MAX || damped) {
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
static bool put_places_first(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    const size_t n = reading->component_count, first = system->variable_count - n;
    size_t *order = gm_arena_take(system->arena, n + 1, sizeof *order);
    struct gm_system_variable *moved = gm_arena_take(system->arena, n + 1, sizeof *moved);
    if (!order || !moved) {
        return gm_fail_memory(&reading->fault);
    }
    memset(order, 0xff, n * sizeof *order);
    if ((n == 2 && gm_system_is_field(system)) || !pair_components(reading, order)) {
        return true;
    }
    for (size_t i = 0; i < n; i++) {
        moved[order[i]] = system->variables[first + i];
    }
    memcpy(system->variables + first, moved, n * sizeof *moved);
    for (size_t i = 0; i < reading->entry_count; i++) {
        struct gm_entry *entry = &reading->entries[i];
        entry->number = entry->role == GM_ENTRY_COMPONENT ? order[entry->number] : entry->number;
    }
    return true;
}

/* Adds the tangents of all components: xi1_q, xi2_q. */
static bool add_tangents(struct gm_reading *reading)
{
    const struct gm_system_line *line = gm_reading_line(reading, GM_WORD_TANGENTS);
    const size_t n = reading->component_count;
    long count = 0;
    if (!line || reading->without_tangents) {
        return true;
    }
    if (!gm_reading_whole(reading, line->value, &count)) {
        return false;
    }
    if (count < 1 || count > GM_MOST_TANGENTS || (size_t)count > n) {
        return gm_fail_first(&reading->fault, line->value.begin,
                             "tangents is %ld: there are 1 to %zu tangents of %zu component%s", count,
                             n < GM_MOST_TANGENTS ? n : GM_MOST_TANGENTS, n, gm_plural((double)n));
    }
    if (gm_reading_line(reading, GM_WORD_CONSTRAINT)) {
        return gm_fail_first(&reading->fault, line->place, "a system with constraints has no tangents");
    }
    for (long k = 1; k <= count && !reading->fault.failed; k++) {
        char before[32];
        snprintf(before, sizeof before, "xi%ld_", k);
        add_derived(reading, before, "", GM_ENTRY_COMPONENT, &reading->component_count, n);
    }
    reading->system->tangents = (size_t)count;
    return !reading->fault.failed;
}

/* Reorders variables: parameters, components, velocities become components, t, parameters, velocities,
   components at the start, components of the exact solution. Tangents move behind what they belong to. */
static bool arrange(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    const size_t n = reading->component_count, p = reading->parameter_count, v = reading->velocity_count;
    const size_t solutions = gm_system_is_field(system) ? 0 : n; /* of forms they are not used */
    struct gm_system_variable *all = gm_arena_take(system->arena, 2 * n + 1 + p + v + solutions, sizeof *all),
                              *met = system->variables;
    char *t = gm_arena_print(system->arena, "t");
    if (!all || !t) {
        return gm_fail_memory(&reading->fault);
    }
    all[n] = unsaid;
    all[n].name = t;
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
        if (!other->name) {
            return gm_fail_memory(&reading->fault);
        }
        system->variable_count++;
    }
    if (gm_system_is_form(system)) {
        system->first_call = system->velocities + GM_FORM_PLACES;
        system->calls = gm_arena_take(system->arena, GM_MOST_FORM_CALLS, sizeof *system->calls);
        if (!system->calls) {
            return gm_fail_memory(&reading->fault);
        }
    }
    all[n].value = 0; /* unless the start names another time */
    return true;
}

/* Adds the place x, which is not a component, with the offset of that line. */
static bool add_place(struct gm_reading *reading, const struct gm_system_line *line)
{
    char x[] = "x";
    const struct gm_entry place = {.name = x,
                                   .length = 1,
                                   .place = line->place,
                                   .role = GM_ENTRY_VELOCITY,
                                   .number = reading->velocity_count++};
    return gm_reading_add(reading, place) && add_variable(reading, &place);
}

/* Adds names, and reports it if there are not `least` to `most`. */
static bool add_counted(struct gm_reading *reading, struct gm_span names, size_t least, size_t most,
                        const char *sentence)
{
    if (!add_all_names(reading, names, GM_ENTRY_COMPONENT, &reading->component_count)) {
        return false;
    }
    const size_t n = reading->component_count;
    return (n >= least && n <= most) ||
           gm_fail_first(&reading->fault, names.begin, "there are %zu to %zu %s", least, most, sentence);
}

/* Adds fields, x, and their derivatives over x. */
static bool add_fields(struct gm_reading *reading, const struct gm_system_line *field)
{
    static const char *const derivatives[GM_MOST_DERIVATIVES] = {"_x", "_xx", "_xxx", "_xxxx"};
    if (!add_counted(reading, field->value, 1, GM_MOST_FIELDS, "fields, as in field: u v") ||
        !add_place(reading, field)) {
        return false;
    }
    const size_t n = reading->component_count;
    for (size_t k = 0; k < GM_MOST_DERIVATIVES; k++) {
        if (!add_derived(reading, "", derivatives[k], GM_ENTRY_VELOCITY, &reading->velocity_count, n)) {
            return false;
        }
    }
    return true;
}

/* Adds the components of a system of matrices, and x. */
static bool add_components(struct gm_reading *reading, const struct gm_system_line *components)
{
    return add_counted(reading, components->value, 2, GM_MOST_OF_MATRICES,
                       "components, as in components: u v w") &&
           add_place(reading, components);
}

/* Adds u and u_t, and the variables of densities: x and u_x. */
static bool add_field(struct gm_reading *reading, const struct gm_system_line *field)
{
    if (!add_all_names(reading, field->value, GM_ENTRY_COMPONENT, &reading->component_count)) {
        return false;
    }
    if (reading->component_count != 1) {
        return gm_fail_first(&reading->fault, field->value.begin, "a field has one name, as in field: u");
    }
    return add_derived(reading, "", "_t", GM_ENTRY_COMPONENT, &reading->component_count, 1) &&
           add_place(reading, field) &&
           add_derived(reading, "", "_x", GM_ENTRY_VELOCITY, &reading->velocity_count, 1);
}

/* NAME = k-form, NAME = dual k-form, .. */
static bool add_forms(struct gm_reading *reading, enum gm_system_word word)
{
    static const char *const degrees[] = {"0-form",      "1-form",      "2-form", "dual 0-form",
                                          "dual 1-form", "dual 2-form", NULL};
    const struct gm_system_line *line = gm_reading_line(reading, word);
    struct gm_span rest = line ? line->value : (struct gm_span){0, 0}, piece;
    struct gm_user_system *system = reading->system;
    while (!reading->fault.failed && gm_span_take(reading->text, &rest, ",", &piece)) {
        struct gm_span name = {piece.begin, gm_span_until(reading->text, piece, "=")};
        struct gm_target target;
        const size_t end = piece.end, equals = name.end;
        name = gm_span_trimmed(reading->text, name);
        const char *text = gm_reading_text(
            reading, gm_span_trimmed(reading->text, (struct gm_span){equals + (equals < end), end}));
        size_t degree = 0;
        while (text && degrees[degree] && strcmp(degrees[degree], text) != 0) {
            degree++;
        }
        if (!degrees[degree]) {
            const int length = (int)(name.end - name.begin < 60 ? name.end - name.begin : 60);
            return equals == end ? gm_fail_first(&reading->fault, name.begin,
                                                 "%.*s has no degree: write %s: %.*s = 0-form", length,
                                                 reading->text + name.begin, gm_system_words[word].word,
                                                 length, reading->text + name.begin)
                                 : gm_fail_first(&reading->fault, equals + 1,
                                                 "a form is a 0-form, 1-form or 2-form, or a dual one: dual "
                                                 "0-form, dual 1-form, dual 2-form");
        }
        if (!gm_reading_reserve(reading, (void **)&system->forms, reading->component_count,
                                sizeof *system->forms)) {
            return false;
        }
        system->forms[reading->component_count] = (struct gm_form_declared){
            (int)(degree % 3), degree >= 3, word == GM_WORD_UNKNOWN, name.begin, GM_NO_NODE, GM_NO_NODE,
            GM_NO_NODE,        GM_NO_NODE};
        if (gm_reading_target(reading, &name, &target)) {
            add_names(reading, &target, GM_ENTRY_COMPONENT, &reading->component_count);
        }
    }
    return !reading->fault.failed;
}

/* Adds forms, the place, and room for operators. */
static bool add_places(struct gm_reading *reading)
{
    static char places[GM_FORM_PLACES][2] = {"x", "y", "z"};
    for (size_t i = 0; i < GM_FORM_PLACES; i++) {
        const struct gm_entry place = {
            .name = places[i], .length = 1, .role = GM_ENTRY_VELOCITY, .number = reading->velocity_count++};
        if (!gm_reading_add(reading, place) || !add_variable(reading, &place)) {
            return false;
        }
    }
    for (size_t i = 0; i < GM_MOST_FORM_CALLS; i++) {
        const struct gm_entry unnamed = {.name = places[0], .length = 0};
        reading->velocity_count++;
        if (!add_variable(reading, &unnamed)) {
            return false;
        }
    }
    return true;
}

bool gm_declared_state(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    const struct gm_system_line *coordinates = gm_reading_line(reading, GM_WORD_COORDINATES),
                                *momenta = gm_reading_line(reading, GM_WORD_MOMENTA),
                                *velocities = gm_reading_line(reading, GM_WORD_VELOCITIES),
                                *components = gm_reading_line(reading, GM_WORD_COMPONENTS);
    if (coordinates) {
        add_all_names(reading, coordinates->value, GM_ENTRY_COMPONENT, &reading->component_count);
        const size_t n = reading->component_count;
        if (momenta &&
            add_all_names(reading, momenta->value, GM_ENTRY_COMPONENT, &reading->component_count) &&
            reading->component_count != 2 * n) {
            gm_fail_first(&reading->fault, momenta->place, "%zu momenta for %zu coordinate%s",
                          reading->component_count - n, n, gm_plural((double)n));
        }
        if (!momenta) {
            add_derived(reading, "p_", "", GM_ENTRY_COMPONENT, &reading->component_count, n);
        }
        if (system->kind == GM_LAGRANGIAN && velocities) {
            add_all_names(reading, velocities->value, GM_ENTRY_VELOCITY, &reading->velocity_count);
        } else if (system->kind == GM_LAGRANGIAN) {
            add_derived(reading, "v_", "", GM_ENTRY_VELOCITY, &reading->velocity_count, n);
        }
        if (!reading->fault.failed && system->kind == GM_LAGRANGIAN && reading->velocity_count != n) {
            gm_fail_first(&reading->fault, velocities->place, "%zu velocities for %zu coordinates",
                          reading->velocity_count, n);
        }
    } else if (system->kind == GM_FIELD) {
        add_field(reading, gm_reading_line(reading, GM_WORD_FIELD));
    } else if (system->kind == GM_EVOLUTION) {
        add_fields(reading, gm_reading_line(reading, GM_WORD_FIELD));
    } else if (system->kind == GM_MATRICES) {
        add_components(reading, components);
    } else if (system->kind == GM_FORMS) {
        if (add_forms(reading, GM_WORD_FIELD) && add_forms(reading, GM_WORD_UNKNOWN)) {
            add_places(reading);
        }
    } else if (components) {
        add_all_names(reading, components->value, GM_ENTRY_COMPONENT, &reading->component_count);
    } else {
        const bool rates = system->kind == GM_RATES;
        if (add_components_in_order(reading, rates ? GM_WORD_RATE : GM_WORD_BRACKET) && rates) {
            put_places_first(reading);
        }
    }
    if (!reading->fault.failed && reading->component_count > GM_MOST_COMPONENTS) {
        const struct gm_system_line *list = coordinates ? coordinates : components;
        gm_fail_first(&reading->fault, list ? list->value.begin : 0, "a system has at most %d components",
                      GM_MOST_COMPONENTS);
    }
    char t[] = "t";
    const struct gm_entry time = {.name = t, .length = 1, .role = GM_ENTRY_TIME};
    return !reading->fault.failed && add_tangents(reading) && arrange(reading) &&
           gm_reading_add(reading, time);
}

bool gm_declared_relations(struct gm_reading *reading)
{
    struct gm_user_system *system = reading->system;
    for (size_t i = 0; i < reading->entry_count && !reading->fault.failed; i++) {
        const struct gm_entry *entry = &reading->entries[i];
        gm_node_id node;
        if (entry->role == GM_ENTRY_PARAMETER && entry->value.begin < entry->value.end &&
            gm_reading_bound(reading, entry->value, &entry->bound, entry->element, &node)) {
            struct gm_system_variable *variable = &system->variables[system->parameters + entry->number];
            variable->start = node;
            /* half the length of the line is a key unless it follows from others */
            variable->derived |= system->parameters + entry->number == system->velocities - 2 &&
                                 gm_system_is_field(system) &&
                                 system->graph.nodes[node].operation != GM_CONSTANT;
        }
    }
    return !reading->fault.failed;
}

/* True if a line defines a function. */
static bool is_function(struct gm_reading *reading, const struct gm_system_line *line)
{
    const size_t name = line->value.begin + gm_name_length(reading->text + line->value.begin,
                                                           line->value.end - line->value.begin);
    return line->word == GM_WORD_LET && name > line->value.begin &&
           reading->text[gm_span_trimmed(reading->text, (struct gm_span){name, line->value.end}).begin] ==
               '(';
}

/* NAME(argument, ...) = body */
static bool add_function(struct gm_reading *reading, struct gm_span rest)
{
    struct gm_target target;
    struct gm_span left, argument;
    if (!gm_reading_reserve(reading, (void **)&reading->definitions, reading->definition_count,
                            sizeof *reading->definitions) ||
        !gm_reading_target(reading, &rest, &target) || !gm_span_take(reading->text, &rest, "=", &left)) {
        return false;
    }
    struct gm_definition *definition = &reading->definitions[reading->definition_count];
    *definition = (struct gm_definition){.name = target.name, .body = gm_span_trimmed(reading->text, rest)};
    const size_t close = gm_span_until(reading->text, (struct gm_span){left.begin + 1, left.end}, ")");
    if (close + 1 != left.end || definition->body.begin == definition->body.end) {
        return gm_fail_first(&reading->fault, close, "%s was expected",
                             close >= left.end      ? ")"
                             : close + 1 < left.end ? "="
                                                    : "a formula");
    }
    left = gm_span_trimmed(reading->text, (struct gm_span){left.begin + 1, close});
    while (gm_span_take(reading->text, &left, ",", &argument)) {
        const char *name = reading->text + argument.begin;
        const size_t length = gm_name_length(name, argument.end - argument.begin);
        const int brief = (int)(length < 60 ? length : 60);
        bool twice = false;
        for (size_t i = 0; i < definition->count; i++) {
            const struct gm_span other = definition->arguments[i];
            twice |=
                other.end - other.begin == length && memcmp(reading->text + other.begin, name, length) == 0;
        }
        if (length == 0 || argument.begin + length < argument.end || gm_formula_reserves(name, length)) {
            return gm_fail_first(&reading->fault, argument.begin, "the name of an argument was expected");
        }
        if (twice) {
            return gm_fail_first(&reading->fault, argument.begin, "%.*s is an argument twice", brief, name);
        }
        if (definition->count == GM_MOST_ARGUMENTS) {
            return gm_fail_first(&reading->fault, argument.begin, "a function has at most %d arguments",
                                 GM_MOST_ARGUMENTS);
        }
        definition->arguments[definition->count++] = argument;
    }
    if (definition->count == 0) {
        return gm_fail_first(&reading->fault, close, "the name of an argument was expected");
    }
    reading->definition_count++;
    return true;
}

bool gm_declared_functions(struct gm_reading *reading)
{
    for (size_t i = 0; i < reading->line_count && !reading->fault.failed; i++) {
        if (is_function(reading, &reading->lines[i])) {
            add_function(reading, reading->lines[i].value);
        }
    }
    return !reading->fault.failed;
}

/* Adds the names of functions. */
static bool add_functions(struct gm_reading *reading)
{
    for (size_t i = 0; i < reading->definition_count && !reading->fault.failed; i++) {
        const struct gm_target target = {.name = reading->definitions[i].name};
        const struct gm_entry entry = gm_reading_entry_for(reading, &target, GM_ENTRY_FUNCTION),
                              *other = gm_reading_entry(reading, entry.name, entry.length, false, 0);
        const int brief = (int)(entry.length < 60 ? entry.length : 60);
        if (gm_formula_reserves(entry.name, entry.length)) {
            gm_fail_first(&reading->fault, entry.place, "%.*s is a function of the program", brief,
                          entry.name);
        } else if (other && other->role == GM_ENTRY_COMPONENT) {
            gm_fail_first(&reading->fault, entry.place, "%.*s is a component (%.*s(0) is its start)", brief,
                          entry.name, brief, entry.name);
        } else {
            gm_reading_add(reading, entry);
        }
    }
    return !reading->fault.failed;
}

bool gm_declared_lets(struct gm_reading *reading)
{
    if (!add_functions(reading)) {
        return false;
    }
    for (size_t i = 0; i < reading->line_count && !reading->fault.failed; i++) {
        const bool observed = reading->lines[i].word == GM_WORD_OBSERVE;
        struct gm_target target;
        struct gm_span value = reading->lines[i].value;
        value.end = observed ? gm_span_until(reading->text, value, ";") : value.end;
        if ((reading->lines[i].word != GM_WORD_LET && !observed) ||
            is_function(reading, &reading->lines[i]) ||
            (observed && gm_span_until(reading->text, value, "..") < value.end) || /* a line with a counter */
            !gm_reading_assignment(reading, value, &target) ||
            (observed && target.index.begin < target.index.end)) {
            continue;
        }
        struct gm_entry entry =
            gm_reading_entry_for(reading, &target, observed ? GM_ENTRY_OBSERVED : GM_ENTRY_NAMED);
        entry.indexed = target.index.begin < target.index.end;
        if (!entry.indexed || gm_reading_whole(reading, target.index, &entry.index)) {
            gm_reading_add(reading, entry);
        }
    }
    for (uint32_t i = 0; i < reading->entry_count && !reading->fault.failed; i++) {
        if (reading->entries[i].role >= GM_ENTRY_NAMED && !reading->entries[i].read) {
            gm_reading_define(reading, i);
        }
    }
    return !reading->fault.failed;
}
