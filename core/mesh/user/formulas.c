/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The formulas of a mesh equation: their names, and the derivatives that elements need of them. */
#include "core/mesh/user/formulas.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/basics.h"
#include "core/expression/lines.h"
#include "core/model/scope.h"

/* The lines while they are read, one after the other; a refusal leaves the body of the arena. The inputs of a line are
   variables 0, 1 .. of the graph. */
struct reading {
    struct gm_arena *arena;
    struct gm_mesh_formulas *formulas;
    const struct gm_mesh_names *names;
    const struct gm_user_mesh *chosen;
    enum gm_system_word word;
    const char *const *inputs; /* names of inputs, which hide those of the file; NULL-terminated */
    struct gm_formula graph;
    gm_node_id
        *of_system; /* the system's variables: inputs, constants, and NaN for what the line does not hold */
};

/* Begins a line, some of whose inputs are these variables of the system. */
static void begin(struct reading *reading, enum gm_system_word word, const char *const *inputs,
                  const size_t *variables, size_t count)
{
    const struct gm_user_system *system = reading->names->wave->system;
    gm_formula_close(&reading->graph);
    gm_formula_open(&reading->graph);
    reading->word = word;
    reading->inputs = inputs;
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

/* Returns the meaning of a name that the line has of its own, whatever the field is called, or GM_NO_NODE. */
static gm_node_id find_own(struct reading *reading, const struct gm_name *name)
{
    static const char *const words[] = {"alpha", "steepest", "bend", "V_u"};
    for (size_t k = 0; reading->inputs[k]; k++) {
        if (is_called(name, reading->inputs[k])) {
            return gm_formula_variable(&reading->graph, k);
        }
    }
    const struct gm_mesh_names *names = reading->names;
    const double values[] = {names->alpha, names->steepest, names->bend};
    size_t i = 0;
    while (i < GM_COUNT(words) && !is_called(name, words[i])) {
        i++;
    }
    if (reading->word == GM_WORD_MESH || i == GM_COUNT(words)) {
        return GM_NO_NODE;
    }
    return i < GM_COUNT(values) ? gm_formula_constant(&reading->graph, values[i])
                                : taken(reading, names->wave->by_u[0]);
}

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    struct reading *reading = data;
    const struct gm_user_system *system = reading->names->wave->system;
    const gm_node_id own = find_own(reading, name);
    for (size_t i = 0; i < system->variable_count; i++) {
        if (!is_called(name, system->variables[i].name)) {
            continue;
        }
        *node = own != GM_NO_NODE ? own : reading->of_system[i];
        const bool foreign = isnan(reading->graph.nodes[*node].value) &&
                             reading->graph.nodes[*node].operation == GM_CONSTANT,
                   twice = own != GM_NO_NODE && i >= system->parameters && i < system->velocities;
        if (foreign || twice) {
            snprintf(sentence, GM_FAULT_SENTENCE,
                     foreign ? "it does not hold %.*s"
                             : "%.*s has a meaning here, and a parameter of that name needs another one",
                     (int)name->length, name->text);
        }
        return foreign || twice ? GM_REFUSED : GM_KNOWN;
    }
    const struct gm_system_item *item;
    *node = own;
    for (size_t i = 0; *node == GM_NO_NODE && (item = gm_system_item_of(system, GM_WORD_LET, i)); i++) {
        *node = is_called(name, item->name) ? taken(reading, item->nodes[0]) : GM_NO_NODE;
    }
    return *node == GM_NO_NODE ? GM_UNKNOWN : GM_KNOWN;
}

static const char *known(size_t i, const void *data)
{
    const struct gm_user_system *system = ((const struct reading *)data)->names->wave->system;
    return i < system->velocities ? system->variables[i].name : NULL;
}

/* Refuses a line with a sentence about byte `offset` of the text. */
_Noreturn static void refuse(const struct reading *reading, const char *text, size_t offset,
                             const char *about)
{
    size_t line, column;
    gm_text_place(text, offset, &line, &column);
    snprintf(reading->formulas->refused, GM_FAULT_SENTENCE, "%s: %s, at column %zu of %s",
             gm_system_words[reading->word].word, about, column, text);
    gm_arena_leave(reading->arena);
}

static gm_node_id read_span(struct reading *reading, const char *text, struct gm_span span)
{
    const struct gm_scope scope = {.find = find, .known = known, .data = reading};
    struct gm_fault fault = {0};
    gm_node_id node;
    const bool good = gm_formula_read(&reading->graph, text, span.begin, span.end, &scope, &node, &fault);
    if (!good && fault.sentence[0]) {
        refuse(reading, text, fault.offset, fault.sentence);
    }
    gm_arena_need(reading->arena, good);
    return node;
}

static gm_node_id read_formula(struct reading *reading, const char *text)
{
    return read_span(reading, text, (struct gm_span){0, strlen(text)});
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

/* Refuses a corner, which would end Newton's method. */
static void need_smooth(struct reading *reading, const char *text, gm_node_id node, const bool *marked,
                        size_t inputs)
{
    const gm_node_id kink = gm_formula_kink(&reading->graph, node, marked, inputs);
    gm_arena_need(reading->arena, !reading->graph.failed);
    if (kink != GM_NO_NODE) {
        const uint32_t place = gm_formula_origin(&reading->graph, kink);
        char about[GM_FAULT_SENTENCE];
        snprintf(about, sizeof about, "it has to be smooth, and %s is not",
                 gm_operation_rows[reading->graph.nodes[kink].operation].name);
        refuse(reading, text, place == GM_NO_PLACE ? 0 : place, about);
    }
}

const char *const gm_user_densities[] = {"arclength", "curvature", "mix", "limited", "tempered", NULL};

static const char *const named[] = {
    "sqrt(1 + alpha^2*u_x^2)",
    "sqrt(sqrt(1 + (bend*alpha^2*V_u)^2))",
    "sqrt(alpha^2*u_x^2/2 + sqrt(1 + (bend*alpha^2*V_u/2)^2))",
    "sqrt(1 + alpha^2*u_x^2/(1 + (u_x/steepest)^2))",
    "sqrt(1 + 2*alpha^2*u_x^2/(1 + sqrt(1 + (u_x/steepest)^2)))",
};

static void values(const struct gm_density *density, const double *at, double *values, size_t m)
{
    const struct gm_mesh_formulas *formulas = (const struct gm_mesh_formulas *)density; /* its first member */
    gm_tape_values(&formulas->tapes[GM_TAPE_P], at, values, m);
}

/* P = rho^2 with its derivatives, and rho */
static void read_density(struct reading *reading)
{
    enum { SLOPE, FIELD, PLACE, INPUTS };
    static const bool at_end[INPUTS] = {[FIELD] = true, [PLACE] = true},
                      smooth[INPUTS] = {[SLOPE] = true, [FIELD] = true};
    static const char *const words[] = {"u_x", "u", "x", NULL};
    const size_t x = reading->names->wave->system->velocities, variables[INPUTS] = {x + 1, 0, x};
    begin(reading, GM_WORD_DENSITY, words, variables, INPUTS);
    struct gm_formula *graph = &reading->graph;
    struct gm_mesh_formulas *formulas = reading->formulas;
    const char *text = reading->chosen->density;
    gm_node_id by[INPUTS], of[INPUTS][INPUTS];
    for (size_t i = 0; gm_user_densities[i]; i++) {
        text = strcmp(gm_user_densities[i], text) == 0 ? named[i] : text;
    }
    const gm_node_id rho = read_formula(reading, text), p = gm_product(graph, rho, rho);
    need_smooth(reading, text, rho, smooth, INPUTS);
    differentiate(reading, p, INPUTS, by);
    for (size_t i = 0; i < INPUTS; i++) {
        differentiate(reading, by[i], INPUTS, of[i]);
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
    const bool local = formulas->density.local = gm_formula_holds(graph, p, at_end, INPUTS);
    formulas->density.values = values;
    open_tape(reading, &formulas->tapes[GM_TAPE_P], nodes, local ? GM_DENSITY_VALUES : GM_DENSITY_OF_SLOPE,
              local ? INPUTS : 1);
    open_tape(reading, &formulas->tapes[GM_TAPE_RHO], &rho, 1, INPUTS);
}

enum { LABEL, TIME, OF_MAP, ROOM = 128 };

static void places(const struct gm_mesh_map *map, const double *label, size_t count, double t, double *x,
                   double *rate)
{
    const struct gm_mesh_formulas *formulas =
        (const struct gm_mesh_formulas *)((const char *)map - offsetof(struct gm_mesh_formulas, map));
    double at[OF_MAP * ROOM], made[2 * ROOM];
    for (size_t from = 0, some; from < count; from += some) {
        some = count - from < ROOM ? count - from : ROOM;
        for (size_t i = 0; i < some; i++) {
            at[LABEL * some + i] = label[from + i];
            at[TIME * some + i] = t;
        }
        gm_tape_values(&formulas->tapes[GM_TAPE_PLACES], at, made, some);
        memcpy(x + from, made, some * sizeof *x);
        memcpy(rate + from, made + some, some * sizeof *rate);
    }
}

/* X = F, and dF/dt */
static void read_map(struct reading *reading)
{
    static const char *const words[] = {"x", "t", NULL};
    const struct gm_user_system *system = reading->names->wave->system;
    const size_t variables[OF_MAP] = {[LABEL] = system->velocities, [TIME] = system->n};
    begin(reading, GM_WORD_MESH, words, variables, OF_MAP);
    const char *text = reading->chosen->map;
    const size_t word = strspn(text, " "),
                 equals = text[word] ? word + 1 + strspn(text + word + 1, " ") : word;
    gm_node_id nodes[2], by[OF_MAP];
    if (text[word] != 'X' || text[equals] != '=') {
        refuse(reading, text, 0, "it is X = and a formula in x and t, as in X = x + 0.1*sin(pi*x)*sin(t)");
    }
    nodes[0] = read_formula(reading, text + equals + 1);
    differentiate(reading, nodes[0], OF_MAP, by);
    nodes[1] = by[TIME];
    reading->formulas->map.places = places;
    open_tape(reading, &reading->formulas->tapes[GM_TAPE_PLACES], nodes, GM_COUNT(nodes), OF_MAP);
}

bool gm_mesh_map_suits(const struct gm_mesh *mesh, double t, char *sentence, size_t size)
{
    enum { CELLS = 256 };
    double label[CELLS + 1], x[CELLS + 1], rate[CELLS + 1];
    for (size_t i = 0; i <= CELLS; i++) {
        label[i] = mesh->first + mesh->length * (double)i / CELLS;
    }
    mesh->map->places(mesh->map, label, CELLS + 1, t, x, rate);
    for (size_t i = 0; i <= CELLS; i += CELLS) {
        if (!(fabs(x[i] - label[i]) <= 1e-9 * mesh->length)) {
            snprintf(sentence, size, "mesh: X is %.6g at the end x = %.6g at t = %.6g, and has to stay there",
                     x[i], label[i], t);
            return false;
        }
    }
    for (size_t i = 0; i < CELLS; i++) {
        if (!(x[i + 1] > x[i])) {
            snprintf(sentence, size, "mesh: X does not grow with x at x = %.6g, t = %.6g", label[i], t);
            return false;
        }
    }
    return true;
}

static const struct gm_mesh_formulas *of_cell(const struct gm_mesh_cell *cell)
{
    return (const struct gm_mesh_formulas *)((const char *)cell - offsetof(struct gm_mesh_formulas, cell));
}

static void cell_first(const struct gm_mesh_cell *cell, const double *at, double *values, size_t m)
{
    gm_tape_values(&of_cell(cell)->tapes[GM_TAPE_CELL], at, values, m);
}

static void cell_second(const struct gm_mesh_cell *cell, const double *at, double values[4][4])
{
    gm_tape_values(&of_cell(cell)->tapes[GM_TAPE_BENT_CELL], at, values[0], 1);
}

static void read_cell(struct reading *reading)
{
    enum { INPUTS = GM_CELL_INPUTS };
    static const bool smooth[INPUTS] = {true, true, true, true};
    static const char *const words[] = {"d", "d_t", "m_t", "u_x", NULL};
    begin(reading, GM_WORD_CELL, words, NULL, 0);
    struct gm_tape *tapes = reading->formulas->tapes;
    gm_node_id first[1 + INPUTS], second[INPUTS][INPUTS];
    first[0] = read_formula(reading, reading->chosen->cell);
    need_smooth(reading, reading->chosen->cell, first[0], smooth, INPUTS);
    differentiate(reading, first[0], INPUTS, first + 1);
    for (size_t i = 0; i < INPUTS; i++) {
        differentiate(reading, first[1 + i], INPUTS, second[i]);
    }
    reading->formulas->cell = (struct gm_mesh_cell){cell_first, cell_second};
    open_tape(reading, &tapes[GM_TAPE_CELL], first, 1 + INPUTS, INPUTS);
    open_tape(reading, &tapes[GM_TAPE_BENT_CELL], second[0], (size_t)INPUTS * INPUTS, INPUTS);
}

static void read_between(struct reading *reading)
{
    static const char *const words[] = {"s", "d", "v0", "v1", NULL};
    begin(reading, GM_WORD_BETWEEN, words, NULL, 0);
    const gm_node_id node = read_formula(reading, reading->chosen->between);
    open_tape(reading, &reading->formulas->tapes[GM_TAPE_BETWEEN], &node, 1, GM_BETWEEN_INPUTS);
}

/* Formulas of parameters separated by commas. */
static void read_nodes(struct reading *reading)
{
    static const char *const words[] = {NULL};
    begin(reading, GM_WORD_NODES, words, NULL, 0);
    struct gm_mesh_formulas *formulas = reading->formulas;
    struct gm_tape *tape = &formulas->tapes[GM_TAPE_NODE];
    const char *text = reading->chosen->nodes;
    struct gm_span rest = {0, strlen(text)}, piece;
    size_t count = 0;
    for (; count < GM_MOST_LISTED && gm_span_take(text, &rest, ",", &piece); count++) {
        const gm_node_id node = read_span(reading, text, piece);
        open_tape(reading, tape, &node, 1, 0);
        gm_tape_values(tape, NULL, &formulas->listed[count], 1);
        gm_tape_close(tape);
    }
    formulas->listed_count = count;
}

static void read_lines(struct gm_arena *arena, void *data)
{
    struct reading *reading = data;
    const struct gm_user_mesh *chosen = reading->chosen;
    reading->arena = arena;
    reading->of_system =
        gm_arena_take(arena, reading->names->wave->system->variable_count, sizeof(gm_node_id));
    if (chosen->nodes && chosen->nodes[0] && strcmp(chosen->nodes, "density") != 0) {
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
    for (size_t i = 0; i < GM_COUNT(formulas->tapes); i++) {
        gm_tape_close(&formulas->tapes[i]);
    }
}
