/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The formulas of a mesh equation: their names, and the derivatives that elements need of them. */
#include "core/mesh/user/formulas.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/expression/lines.h"
#include "core/model/scope.h"

enum { MOST_INPUTS = 4 };

/* A line of the file: the names of its inputs, which hide those of the file, and the inputs that it is smooth in. */
struct line {
    enum gm_system_word word;
    const char *inputs[MOST_INPUTS + 1];
    bool smooth[MOST_INPUTS];
};
enum { SLOPE, FIELD, PLACE, OF_DENSITY = GM_DENSITY_INPUTS };
enum { LABEL, TIME, OF_MAP };
static const struct line density_line = {GM_WORD_DENSITY, {"u_x", "u", "x"}, {true, true}},
                         map_line = {GM_WORD_MESH, {"x", "t"}, {[TIME] = true}},
                         cell_line = {GM_WORD_CELL, {"d", "d_t", "m_t", "u_x"}, {true, true, true, true}},
                         between_line = {GM_WORD_BETWEEN, {"s", "d", "v0", "v1"}, {false}},
                         nodes_line = {GM_WORD_NODES, {NULL}, {false}};

/* The lines while they are read, one after the other; a refusal leaves the body of the arena. The inputs of a line are
   variables 0, 1 .. of the graph. */
struct reading {
    struct gm_arena *arena;
    struct gm_mesh_formulas *formulas;
    const struct gm_mesh_names *names;
    const struct gm_user_mesh *chosen;
    const struct line *line;
    const char *text;
    struct gm_formula graph;
    gm_node_id
        *of_system; /* the system's variables: inputs, constants, and NaN for what the line does not hold */
};

/* Begins a line with this text, some of whose inputs are these variables of the system. */
static void begin(struct reading *reading, const struct line *line, const char *text, const size_t *variables,
                  size_t count)
{
    const struct gm_user_system *system = reading->names->wave->system;
    gm_formula_close(&reading->graph);
    gm_formula_open(&reading->graph);
    reading->line = line;
    reading->text = text;
    for (size_t i = 0; i < system->variable_count; i++) {
        const bool fixed = i >= system->parameters && i < system->velocities;
        reading->of_system[i] = gm_formula_constant(&reading->graph, fixed ? reading->names->values[i] : NAN);
    }
    for (size_t k = 0; k < count; k++) {
        reading->of_system[variables[k]] = gm_formula_variable(&reading->graph, k);
    }
}

static bool is_called(const struct gm_name *name, const char *text)
{
    return text && !name->indexed && strlen(text) == name->length &&
           strncmp(text, name->text, name->length) == 0;
}

/* Returns a formula of the system in the inputs. */
static gm_node_id taken(struct reading *reading, gm_node_id node)
{
    const struct gm_user_system *system = reading->names->wave->system;
    node = gm_formula_graft(&reading->graph, &system->graph, node, system->variable_count, NULL);
    reading->graph.failed =
        reading->graph.failed ||
        !gm_formula_substitute(&reading->graph, &node, 1, reading->of_system, system->variable_count);
    return node;
}

/* Returns true if the line holds a variable of the system. */
static bool holds(const struct reading *reading, size_t variable)
{
    const struct gm_node *meant = &reading->graph.nodes[reading->of_system[variable]];
    return meant->operation != GM_CONSTANT || !isnan(meant->value);
}

/* Returns a variable that a formula of the system holds and the line does not, or the number of variables. */
static size_t find_lacking(struct reading *reading, gm_node_id node)
{
    const struct gm_user_system *system = reading->names->wave->system;
    size_t count = 0, lacking = system->variable_count;
    gm_node_id *parts = gm_formula_parts(&system->graph, node, &count);
    reading->graph.failed |= !parts;
    for (size_t k = 0; parts && k < count; k++) {
        const struct gm_node *part = &system->graph.nodes[parts[k]];
        lacking = part->operation == GM_VARIABLE && !holds(reading, part->a) ? part->a : lacking;
    }
    free(parts);
    return lacking;
}

/* The density of nodes alone depends on the place alone. */
static size_t first_input(const struct reading *reading)
{
    return reading->line == &density_line && reading->names->wave->system->alone ? PLACE : 0;
}

const char *const gm_user_densities[] = {"arclength", "curvature", "mix", "limited", "tempered", NULL};

static const char *const named[] = {
    "sqrt(1 + alpha^2*u_x^2)",
    "sqrt(sqrt(1 + (bend*alpha^2*V_u)^2))",
    "sqrt(alpha^2*u_x^2/2 + sqrt(1 + (bend*alpha^2*V_u/2)^2))",
    "sqrt(1 + alpha^2*u_x^2/(1 + (u_x/steepest)^2))",
    "sqrt(1 + 2*alpha^2*u_x^2/(1 + sqrt(1 + (u_x/steepest)^2)))",
};

/* The names that all lines but the map have besides their inputs. */
static const char *const own_words[] = {"alpha", "steepest", "bend", "V_u"};

/* Returns the meaning of a name that the line has of its own, whatever the field is called, or GM_NO_NODE. */
static gm_node_id find_own(struct reading *reading, const struct gm_name *name)
{
    for (size_t k = first_input(reading); reading->line->inputs[k]; k++) {
        if (is_called(name, reading->line->inputs[k])) {
            return gm_formula_variable(&reading->graph, k);
        }
    }
    const struct gm_mesh_names *names = reading->names;
    const double values[] = {names->alpha, names->steepest, names->bend};
    size_t i = 0;
    while (i < GM_COUNT(own_words) && !is_called(name, own_words[i])) {
        i++;
    }
    if (reading->line == &map_line || i == GM_COUNT(own_words)) {
        return GM_NO_NODE;
    }
    return i < GM_COUNT(values) ? gm_formula_constant(&reading->graph, values[i])
                                : taken(reading, names->wave->by_u[0]);
}

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    struct reading *reading = data;
    const struct gm_user_system *system = reading->names->wave->system;
    const struct gm_system_item *let;
    const gm_node_id own = *node = find_own(reading, name);
    size_t number = 0, i = 0;
    while (number < system->variable_count && !is_called(name, system->variables[number].name)) {
        number++;
    }
    while ((let = gm_system_item_of(system, GM_WORD_LET, i)) && !is_called(name, let->name)) {
        i++;
    }
    const bool fixed = number >= system->parameters && number < system->velocities;
    if (own != GM_NO_NODE) {
        if (fixed || let) {
            snprintf(sentence, GM_FAULT_SENTENCE,
                     "%.*s has a meaning here, and a %s of that name needs another one", (int)name->length,
                     name->text, let ? "let" : "parameter");
        }
        return fixed || let ? GM_REFUSED : GM_KNOWN;
    }
    if (!let && number == system->variable_count) {
        return GM_UNKNOWN;
    }
    const size_t lacking = let                      ? find_lacking(reading, let->nodes[0])
                           : holds(reading, number) ? system->variable_count
                                                    : number;
    if (lacking < system->variable_count) {
        snprintf(sentence, GM_FAULT_SENTENCE, "it does not hold %s%s%s", system->variables[lacking].name,
                 let ? ", and holds it through " : "", let ? let->name : "");
        return GM_REFUSED;
    }
    *node = let ? taken(reading, let->nodes[0]) : reading->of_system[number];
    return GM_KNOWN;
}

/* Returns a name that the line has of its own, for proposals: its inputs, its words, and a density's, which is the
   whole text; NULL after the last. */
static const char *own_name(const struct reading *reading, size_t i)
{
    const bool density = reading->line == &density_line, alone = first_input(reading) > 0,
               word = density && strspn(reading->text, "abcdefghijklmnopqrstuvwxyz") == strlen(reading->text);
    const char *const *inputs = reading->line->inputs + first_input(reading);
    size_t count = 0;
    while (inputs[count] && count < i) {
        count++;
    }
    if (inputs[count] || alone || reading->line == &map_line) {
        return inputs[count];
    }
    i -= count;
    return i < GM_COUNT(own_words)                             ? own_words[i]
           : word && i < GM_COUNT(own_words) + GM_COUNT(named) ? gm_user_densities[i - GM_COUNT(own_words)]
                                                               : NULL;
}

/* Returns a name for proposals: the line's own names, then the parameters. */
static const char *known(size_t i, const void *data)
{
    const struct reading *reading = data;
    const struct gm_user_system *system = reading->names->wave->system;
    size_t count = 0;
    while (count < i && own_name(reading, count)) {
        count++;
    }
    const char *own = own_name(reading, count);
    const size_t number = system->parameters + i - count;
    return own ? own : number < system->velocities ? system->variables[number].name : NULL;
}

/* Refuses the line with a sentence about byte `offset` of its text. */
_Noreturn static void refuse(const struct reading *reading, size_t offset, const char *about)
{
    size_t line, column;
    gm_text_place(reading->text, offset, &line, &column);
    snprintf(reading->formulas->refused, GM_FAULT_SENTENCE, "%s: %s, at column %zu of %s",
             gm_system_words[reading->line->word].word, about, column, reading->text);
    gm_arena_leave(reading->arena);
}

/* Reads a part of the text. A corner is refused, which would end Newton's method. */
static gm_node_id read_formula(struct reading *reading, struct gm_span span)
{
    const struct gm_scope scope = {.find = find, .known = known, .data = reading};
    struct gm_fault fault = {0};
    gm_node_id node;
    const bool good =
        gm_formula_read(&reading->graph, reading->text, span.begin, span.end, &scope, &node, &fault);
    if (!good && fault.sentence[0]) {
        const bool unknown = strstr(fault.sentence, "there is no name ") && !strchr(fault.sentence, ';');
        const char *name;
        for (size_t k = 0; unknown && (name = own_name(reading, k)); k++) {
            const size_t end = strlen(fault.sentence);
            snprintf(fault.sentence + end, sizeof fault.sentence - end, "%s%s",
                     k == 0 ? "; names are " : ", ", name);
        }
        refuse(reading, fault.offset, fault.sentence);
    }
    gm_arena_need(reading->arena, good);
    const gm_node_id kink = gm_formula_kink(&reading->graph, node, reading->line->smooth, MOST_INPUTS);
    gm_arena_need(reading->arena, !reading->graph.failed);
    if (kink != GM_NO_NODE) {
        const uint32_t place = gm_formula_origin(&reading->graph, kink);
        snprintf(fault.sentence, sizeof fault.sentence, "it has to be smooth, and %s is not",
                 gm_operation_rows[reading->graph.nodes[kink].operation].name);
        refuse(reading, place == GM_NO_PLACE ? 0 : place, fault.sentence);
    }
    return node;
}

static gm_node_id read_text(struct reading *reading)
{
    return read_formula(reading, (struct gm_span){0, strlen(reading->text)});
}

static void differentiate(struct reading *reading, gm_node_id node, size_t inputs, gm_node_id *gradient)
{
    gm_arena_need(reading->arena, gm_gradient(&reading->graph, node, NULL, inputs, gradient));
}

static void open_tape(const struct reading *reading, struct gm_tape *tape, const gm_node_id *nodes,
                      size_t count, size_t inputs)
{
    gm_arena_need(reading->arena,
                  !reading->graph.failed && gm_tape_open(tape, &reading->graph, nodes, count, inputs, NULL));
}

static void values(const struct gm_density *density, const double *at, double *values, size_t m)
{
    const struct gm_mesh_formulas *formulas = (const struct gm_mesh_formulas *)density; /* its first member */
    gm_tape_values(&formulas->squared, at, values, m);
}

/* P = rho^2 with its derivatives, and rho */
static void read_density(struct reading *reading)
{
    static const bool at_end[OF_DENSITY] = {[FIELD] = true, [PLACE] = true};
    const size_t x = reading->names->wave->system->velocities, variables[OF_DENSITY] = {x + 1, 0, x};
    struct gm_formula *graph = &reading->graph;
    struct gm_mesh_formulas *formulas = reading->formulas;
    const char *text = reading->chosen->density;
    gm_node_id by[OF_DENSITY], of[OF_DENSITY][OF_DENSITY];
    for (size_t i = 0; gm_user_densities[i]; i++) {
        text = strcmp(gm_user_densities[i], text) == 0 ? named[i] : text;
    }
    begin(reading, &density_line, text, variables, OF_DENSITY);
    const gm_node_id rho = read_text(reading), p = gm_product(graph, rho, rho);
    differentiate(reading, p, OF_DENSITY, by);
    for (size_t i = 0; i < OF_DENSITY; i++) {
        differentiate(reading, by[i], OF_DENSITY, of[i]);
    }
    const gm_node_id nodes[GM_DENSITY_VALUES] = {
        [GM_P] = p,
        [GM_P_S] = by[SLOPE],
        [GM_P_SS] = of[SLOPE][SLOPE],
        [GM_P_U] = by[FIELD],
        [GM_P_X] = by[PLACE],
        [GM_P_SU] = of[SLOPE][FIELD],
        [GM_P_SX] = of[SLOPE][PLACE],
        [GM_P_UU] = of[FIELD][FIELD],
        [GM_P_UX] = of[FIELD][PLACE],
        [GM_P_XX] = of[PLACE][PLACE],
    };
    const bool local = formulas->density.local = gm_formula_holds(graph, p, at_end, OF_DENSITY);
    formulas->density.values = values;
    open_tape(reading, &formulas->squared, nodes, local ? GM_DENSITY_VALUES : GM_DENSITY_OF_SLOPE,
              local ? OF_DENSITY : 1);
    open_tape(reading, &formulas->rho, &rho, 1, OF_DENSITY);
}

/* X = F, and dF/dt */
static void read_map(struct reading *reading)
{
    const struct gm_user_system *system = reading->names->wave->system;
    const size_t variables[OF_MAP] = {[LABEL] = system->velocities, [TIME] = system->n};
    const char *text = reading->chosen->map;
    const size_t word = strspn(text, " "),
                 equals = text[word] ? word + 1 + strspn(text + word + 1, " ") : word;
    gm_node_id nodes[2], by[OF_MAP];
    begin(reading, &map_line, text, variables, OF_MAP);
    if (text[word] != 'X' || text[equals] != '=') {
        refuse(reading, 0, "it is X = and a formula in x and t, as in X = x + 0.1*sin(pi*x)*sin(t)");
    }
    nodes[0] = read_formula(reading, (struct gm_span){equals + 1, strlen(text)});
    differentiate(reading, nodes[0], OF_MAP, by);
    nodes[1] = by[TIME];
    open_tape(reading, &reading->formulas->map, nodes, GM_COUNT(nodes), OF_MAP);
}

static void read_cell(struct reading *reading)
{
    enum { INPUTS = GM_CELL_INPUTS };
    struct gm_mesh_cell *cell = &reading->formulas->cell;
    gm_node_id first[1 + INPUTS], second[INPUTS][INPUTS];
    begin(reading, &cell_line, reading->chosen->cell, NULL, 0);
    first[0] = read_text(reading);
    differentiate(reading, first[0], INPUTS, first + 1);
    for (size_t i = 0; i < INPUTS; i++) {
        differentiate(reading, first[1 + i], INPUTS, second[i]);
    }
    open_tape(reading, &cell->first, first, 1 + INPUTS, INPUTS);
    open_tape(reading, &cell->second, second[0], (size_t)INPUTS * INPUTS, INPUTS);
}

static void read_between(struct reading *reading)
{
    begin(reading, &between_line, reading->chosen->between, NULL, 0);
    const gm_node_id node = read_text(reading);
    open_tape(reading, &reading->formulas->between, &node, 1, GM_BETWEEN_INPUTS);
}

bool gm_mesh_lists_nodes(const char *text)
{
    return text && text[0] && strcmp(text, "density") != 0;
}

/* Formulas of parameters separated by commas. */
static void read_nodes(struct reading *reading)
{
    struct gm_mesh_formulas *formulas = reading->formulas;
    struct gm_span rest = {0, strlen(reading->chosen->nodes)}, piece;
    begin(reading, &nodes_line, reading->chosen->nodes, NULL, 0);
    for (size_t *count = &formulas->listed_count;
         *count < GM_MOST_LISTED && gm_span_take(reading->text, &rest, ",", &piece); ++*count) {
        const gm_node_id node = read_formula(reading, piece);
        struct gm_tape tape = {0};
        open_tape(reading, &tape, &node, 1, 0);
        gm_tape_values(&tape, NULL, &formulas->listed[*count], 1);
        gm_tape_close(&tape);
    }
}

static void read_lines(struct gm_arena *arena, void *data)
{
    struct reading *reading = data;
    const struct gm_user_mesh *chosen = reading->chosen;
    reading->arena = arena;
    reading->of_system =
        gm_arena_take(arena, reading->names->wave->system->variable_count, sizeof(gm_node_id));
    if (gm_mesh_lists_nodes(chosen->nodes)) {
        read_nodes(reading);
    }
    read_density(reading);
    if (chosen->between && chosen->between[0]) {
        read_between(reading);
    }
    if (chosen->map && chosen->map[0]) {
        read_map(reading);
    }
    if (chosen->cell && strcmp(chosen->cell, "0") != 0) {
        read_cell(reading);
    }
}

bool gm_mesh_formulas_open(struct gm_mesh_formulas *formulas, const struct gm_mesh_names *names,
                           const struct gm_user_mesh *chosen)
{
    struct reading reading = {.formulas = formulas, .names = names, .chosen = chosen};
    *formulas = (struct gm_mesh_formulas){0};
    const bool good = gm_arena_run_once(read_lines, &reading);
    gm_formula_close(&reading.graph);
    return good || formulas->refused[0];
}

void gm_mesh_formulas_close(void *data)
{
    struct gm_mesh_formulas *formulas = data;
    struct gm_tape *const tapes[] = {&formulas->squared,    &formulas->rho,         &formulas->map,
                                     &formulas->cell.first, &formulas->cell.second, &formulas->between};
    for (size_t i = 0; i < GM_COUNT(tapes); i++) {
        gm_tape_close(tapes[i]);
    }
}
