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

/* A formula while it is read. Its inputs are variables 0, 1 .. of the graph. */
struct reading {
    const struct gm_mesh_names *names;
    enum gm_system_word word;  /* the line */
    const char *const *inputs; /* names of inputs, which hide those of the file; NULL-terminated */
    struct gm_formula graph;
    gm_node_id
        *of_system; /* the system's variables: inputs, constants, and NaN for what the line does not hold */
};

static bool open_reading(struct reading *reading, const size_t *inputs, size_t count)
{
    const struct gm_user_system *system = reading->names->wave->system;
    gm_formula_open(&reading->graph);
    reading->names->sentence[0] = '\0';
    reading->of_system = malloc(system->variable_count * sizeof *reading->of_system);
    for (size_t i = 0; reading->of_system && i < system->variable_count; i++) {
        const bool fixed = i >= system->parameters && i < system->velocities;
        reading->of_system[i] = gm_formula_constant(&reading->graph, fixed ? reading->names->values[i] : NAN);
    }
    for (size_t k = 0; reading->of_system && k < count; k++) {
        reading->of_system[inputs[k]] = gm_formula_variable(&reading->graph, k);
    }
    return reading->of_system != NULL;
}

static void close_reading(struct reading *reading)
{
    gm_formula_close(&reading->graph);
    free(reading->of_system);
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

/* Writes a sentence about byte `offset` of the text. Returns false. */
static bool refuse(const struct reading *reading, const char *text, size_t offset, const char *about)
{
    size_t line, column;
    gm_text_place(text, offset, &line, &column);
    snprintf(reading->names->sentence, reading->names->size, "%s: %s, at column %zu of %s",
             gm_system_words[reading->word].word, about, column, text);
    return false;
}

static bool read_span(struct reading *reading, const char *text, struct gm_span span, gm_node_id *node)
{
    const struct gm_scope scope = {.find = find, .known = known, .data = reading};
    struct gm_fault fault = {0};
    return gm_formula_read(&reading->graph, text, span.begin, span.end, &scope, node, &fault) ||
           (fault.sentence[0] && refuse(reading, text, fault.offset, fault.sentence));
}

static bool read_formula(struct reading *reading, const char *text, gm_node_id *node)
{
    return read_span(reading, text, (struct gm_span){0, strlen(text)}, node);
}

static bool open_tape(const struct reading *reading, struct gm_tape *tape, const gm_node_id *nodes,
                      size_t count, size_t inputs)
{
    return !reading->graph.failed && gm_tape_open(tape, &reading->graph, nodes, count, inputs, NULL);
}

/* A corner would end Newton's method. */
static bool is_smooth(struct reading *reading, const char *text, gm_node_id node, const bool *marked,
                      size_t inputs)
{
    const gm_node_id kink = gm_formula_kink(&reading->graph, node, marked, inputs);
    if (kink == GM_NO_NODE) {
        return !reading->graph.failed;
    }
    const uint32_t place = gm_formula_origin(&reading->graph, kink);
    char about[GM_FAULT_SENTENCE];
    snprintf(about, sizeof about, "it has to be smooth, and %s is not",
             gm_operation_rows[reading->graph.nodes[kink].operation].name);
    return refuse(reading, text, place == GM_NO_PLACE ? 0 : place, about);
}

const char *const gm_user_densities[] = {"arclength", "curvature", "mix", "limited", "tempered", NULL};

static const char *const formulas[] = {
    "sqrt(1 + alpha^2*u_x^2)",
    "sqrt(sqrt(1 + (bend*alpha^2*V_u)^2))",
    "sqrt(alpha^2*u_x^2/2 + sqrt(1 + (bend*alpha^2*V_u/2)^2))",
    "sqrt(1 + alpha^2*u_x^2/(1 + (u_x/steepest)^2))",
    "sqrt(1 + 2*alpha^2*u_x^2/(1 + sqrt(1 + (u_x/steepest)^2)))",
};

static void values(const struct gm_density *density, const double *at, double *values, size_t m)
{
    gm_tape_values(&((const struct gm_user_density *)density)->tape, at, values, m);
}

/* P = rho^2 with its derivatives, and rho */
static bool derive_density(struct reading *reading, const char *text, struct gm_user_density *density)
{
    enum { SLOPE, FIELD, PLACE, INPUTS };
    static const bool at_end[INPUTS] = {[FIELD] = true, [PLACE] = true},
                      smooth[INPUTS] = {[SLOPE] = true, [FIELD] = true};
    struct gm_formula *graph = &reading->graph;
    gm_node_id rho, by[INPUTS], of[INPUTS][INPUTS];
    if (!read_formula(reading, text, &rho)) {
        return false;
    }
    const gm_node_id p = gm_product(graph, rho, rho);
    if (!is_smooth(reading, text, rho, smooth, INPUTS)) {
        return false;
    }
    bool good = !graph->failed && gm_gradient(graph, p, NULL, INPUTS, by);
    for (size_t i = 0; good && i < INPUTS; i++) {
        good = gm_gradient(graph, by[i], NULL, INPUTS, of[i]);
    }
    if (!good) {
        return false;
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
    const bool local = density->density.local = gm_formula_holds(graph, p, at_end, INPUTS);
    return open_tape(reading, &density->tape, nodes, local ? GM_DENSITY_VALUES : GM_DENSITY_OF_SLOPE,
                     local ? INPUTS : 1) &&
           open_tape(reading, &density->itself, &rho, 1, INPUTS);
}

bool gm_user_density_open(struct gm_user_density *density, const struct gm_mesh_names *names,
                          const char *text)
{
    static const char *const words[] = {"u_x", "u", "x", NULL};
    const size_t x = names->wave->system->velocities, inputs[] = {x + 1, 0, x};
    struct reading reading = {.names = names, .word = GM_WORD_DENSITY, .inputs = words};
    *density = (struct gm_user_density){.density.values = values};
    for (size_t i = 0; gm_user_densities[i]; i++) {
        text = strcmp(gm_user_densities[i], text) == 0 ? formulas[i] : text;
    }
    const bool good =
        open_reading(&reading, inputs, GM_COUNT(inputs)) && derive_density(&reading, text, density);
    close_reading(&reading);
    return good;
}

enum { LABEL, TIME, OF_MAP, ROOM = 128 };

static void places(const struct gm_mesh_map *map, const double *label, size_t count, double t, double *x,
                   double *rate)
{
    double at[OF_MAP * ROOM], made[2 * ROOM];
    for (size_t from = 0, some; from < count; from += some) {
        some = count - from < ROOM ? count - from : ROOM;
        for (size_t i = 0; i < some; i++) {
            at[LABEL * some + i] = label[from + i];
            at[TIME * some + i] = t;
        }
        gm_tape_values(&((const struct gm_user_map *)map)->tape, at, made, some);
        memcpy(x + from, made, some * sizeof *x);
        memcpy(rate + from, made + some, some * sizeof *rate);
    }
}

/* X = F, and dF/dt */
static bool derive_map(struct reading *reading, const char *text, struct gm_user_map *map)
{
    const size_t word = strspn(text, " "),
                 equals = text[word] ? word + 1 + strspn(text + word + 1, " ") : word;
    gm_node_id nodes[2], by[OF_MAP];
    if (text[word] != 'X' || text[equals] != '=') {
        return refuse(reading, text, 0,
                      "it is X = and a formula in x and t, as in X = x + 0.1*sin(pi*x)*sin(t)");
    }
    if (!read_formula(reading, text + equals + 1, &nodes[0]) ||
        !gm_gradient(&reading->graph, nodes[0], NULL, OF_MAP, by)) {
        return false;
    }
    nodes[1] = by[TIME];
    return open_tape(reading, &map->tape, nodes, GM_COUNT(nodes), OF_MAP);
}

bool gm_user_map_open(struct gm_user_map *map, const struct gm_mesh_names *names, const char *text)
{
    const struct gm_user_system *system = names->wave->system;
    const size_t inputs[OF_MAP] = {[LABEL] = system->velocities, [TIME] = system->n};
    static const char *const words[] = {"x", "t", NULL};
    struct reading reading = {.names = names, .word = GM_WORD_MESH, .inputs = words};
    *map = (struct gm_user_map){.map.places = places};
    const bool good = open_reading(&reading, inputs, OF_MAP) && derive_map(&reading, text, map);
    close_reading(&reading);
    return good;
}

bool gm_user_map_suits(const struct gm_user_map *map, const struct gm_mesh *mesh, double t, char *sentence,
                       size_t size)
{
    enum { CELLS = 256 };
    double label[CELLS + 1], x[CELLS + 1], rate[CELLS + 1];
    for (size_t i = 0; i <= CELLS; i++) {
        label[i] = mesh->first + mesh->length * (double)i / CELLS;
    }
    map->map.places(&map->map, label, CELLS + 1, t, x, rate);
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

static void cell_first(const struct gm_mesh_cell *cell, const double *at, double *values, size_t m)
{
    gm_tape_values(&((const struct gm_user_cell *)cell)->by_first, at, values, m);
}

static void cell_second(const struct gm_mesh_cell *cell, const double *at, double values[4][4])
{
    gm_tape_values(&((const struct gm_user_cell *)cell)->by_second, at, values[0], 1);
}

static bool derive_cell(struct reading *reading, const char *text, struct gm_user_cell *cell)
{
    enum { INPUTS = GM_CELL_INPUTS };
    static const bool smooth[INPUTS] = {true, true, true, true};
    gm_node_id first[1 + INPUTS], second[INPUTS][INPUTS];
    bool good = read_formula(reading, text, first) && is_smooth(reading, text, first[0], smooth, INPUTS) &&
                gm_gradient(&reading->graph, first[0], NULL, INPUTS, first + 1);
    for (size_t i = 0; good && i < INPUTS; i++) {
        good = gm_gradient(&reading->graph, first[1 + i], NULL, INPUTS, second[i]);
    }
    return good && open_tape(reading, &cell->by_first, first, 1 + INPUTS, INPUTS) &&
           open_tape(reading, &cell->by_second, second[0], (size_t)INPUTS * INPUTS, INPUTS);
}

bool gm_user_cell_open(struct gm_user_cell *cell, const struct gm_mesh_names *names, const char *text)
{
    static const char *const words[] = {"d", "d_t", "m_t", "u_x", NULL};
    struct reading reading = {.names = names, .word = GM_WORD_CELL, .inputs = words};
    *cell = (struct gm_user_cell){.cell = {cell_first, cell_second}};
    const bool good = open_reading(&reading, NULL, 0) && derive_cell(&reading, text, cell);
    close_reading(&reading);
    return good;
}

bool gm_user_between_open(struct gm_tape *between, const struct gm_mesh_names *names, const char *text)
{
    static const char *const words[] = {"s", "d", "v0", "v1", NULL};
    struct reading reading = {.names = names, .word = GM_WORD_BETWEEN, .inputs = words};
    gm_node_id node;
    const bool good = open_reading(&reading, NULL, 0) && read_formula(&reading, text, &node) &&
                      open_tape(&reading, between, &node, 1, GM_BETWEEN_INPUTS);
    close_reading(&reading);
    return good;
}

bool gm_user_places_read(const struct gm_mesh_names *names, const char *text, double *places, size_t most,
                         size_t *count)
{
    static const char *const words[] = {NULL};
    struct reading reading = {.names = names, .word = GM_WORD_NODES, .inputs = words};
    struct gm_span rest = {0, strlen(text)}, piece;
    struct gm_tape tape = {0};
    bool good = open_reading(&reading, NULL, 0);
    for (*count = 0; good && *count < most && gm_span_take(text, &rest, ",", &piece); ++*count) {
        gm_node_id node;
        good = read_span(&reading, text, piece, &node) && open_tape(&reading, &tape, &node, 1, 0);
        if (good) {
            gm_tape_values(&tape, NULL, &places[*count], 1);
        }
        gm_tape_close(&tape);
    }
    close_reading(&reading);
    return good;
}
