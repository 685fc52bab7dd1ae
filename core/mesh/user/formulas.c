/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The formulas of a mesh equation: their names, and the derivatives that elements need of them. */
#include "core/mesh/user/formulas.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/model/scope.h"

/* A formula while it is read, in variables of the system and new ones. */
struct reading {
    const struct gm_mesh_names *names;
    struct gm_formula *graph;
};

static bool is_called(const struct gm_name *name, const char *text)
{
    return strlen(text) == name->length && strncmp(text, name->text, name->length) == 0;
}

/* alpha, steepest, bend and the force V'(u) */
static bool find_weight(struct reading *reading, const struct gm_name *name, gm_node_id *node)
{
    static const char *const words[] = {"alpha", "steepest", "bend", "V_u"};
    const struct gm_mesh_names *names = reading->names;
    const struct gm_user_wave *wave = names->wave;
    const double values[] = {names->alpha, names->steepest, names->bend};
    for (size_t i = 0; names->weighs && i < GM_COUNT(words); i++) {
        if (is_called(name, words[i])) {
            *node = i < GM_COUNT(values)
                        ? gm_formula_constant(reading->graph, values[i])
                        : gm_formula_graft(reading->graph, &wave->system->graph, wave->by_u[0],
                                           wave->system->variable_count, NULL);
            return true;
        }
    }
    return false;
}

static enum gm_meaning find(void *data, const struct gm_name *name, gm_node_id *node, char *sentence)
{
    struct reading *reading = data;
    const struct gm_mesh_names *names = reading->names;
    const struct gm_user_system *system = names->wave->system;
    *node = GM_NO_NODE;
    for (size_t i = 0; i < names->input_count && !name->indexed && *node == GM_NO_NODE; i++) {
        if (is_called(name, names->words[i])) {
            *node = gm_formula_variable(reading->graph, names->inputs[i]);
        }
    }
    const bool own = *node != GM_NO_NODE || (!name->indexed && find_weight(reading, name, node));
    for (size_t i = 0; i < system->variable_count && !name->indexed; i++) {
        if (system->variables[i].name && is_called(name, system->variables[i].name)) {
            if (own && i >= system->parameters && i < system->velocities) {
                snprintf(
                    sentence, GM_FAULT_SENTENCE,
                    "%.*s has a meaning in %s: and is a parameter of the file too, which needs another name",
                    (int)name->length, name->text, gm_system_words[names->word].word);
                return GM_REFUSED;
            }
            *node = own ? *node : gm_formula_variable(reading->graph, i);
            return GM_KNOWN;
        }
    }
    const struct gm_system_item *item;
    for (size_t i = 0; !own && !name->indexed && (item = gm_system_item_of(system, GM_WORD_LET, i)); i++) {
        if (is_called(name, item->name)) {
            *node = gm_formula_graft(reading->graph, &system->graph, item->nodes[0], system->variable_count,
                                     NULL);
            return GM_KNOWN;
        }
    }
    return own ? GM_KNOWN : GM_UNKNOWN;
}

static const char *known(size_t i, const void *data)
{
    const struct gm_mesh_names *names = ((const struct reading *)data)->names;
    const struct gm_user_system *system = names->wave->system;
    if (i < names->input_count) {
        return names->words[i];
    }
    i -= names->input_count;
    return i < system->velocities - system->parameters ? system->variables[system->parameters + i].name
                                                       : NULL;
}

/* Writes a sentence about byte `offset` of the text. Returns false. */
static bool refuse(const struct gm_mesh_names *names, const char *text, size_t offset, const char *about,
                   char *sentence, size_t size)
{
    size_t line, column;
    gm_text_place(text, offset, &line, &column);
    snprintf(sentence, size, "%s: %s, at column %zu of %s", gm_system_words[names->word].word, about, column,
             text);
    return false;
}

bool gm_mesh_formula_read(const struct gm_mesh_names *names, const char *text, struct gm_formula *graph,
                          gm_node_id *node, char *sentence, size_t size)
{
    const struct gm_user_system *system = names->wave->system;
    struct reading reading = {names, graph};
    const struct gm_scope scope = {.find = find, .known = known, .data = &reading};
    struct gm_fault fault = {0};
    sentence[0] = '\0';
    if (!gm_formula_read(graph, text, 0, strlen(text), &scope, node, &fault)) {
        return fault.sentence[0] ? refuse(names, text, fault.offset, fault.sentence, sentence, size) : false;
    }
    const size_t count = system->variable_count + GM_MOST_MESH_INPUTS;
    gm_node_id *others = malloc(count * sizeof *others);
    size_t part_count = 0, foreign = count;
    for (size_t i = 0; others && i < count; i++) {
        others[i] = i >= system->parameters && i < system->velocities
                        ? gm_formula_constant(graph, names->values[i])
                        : GM_NO_NODE;
    }
    for (size_t k = 0; others && k < names->input_count; k++) {
        others[names->inputs[k]] = gm_formula_variable(graph, k);
    }
    gm_node_id *parts = others ? gm_formula_parts(graph, *node, &part_count) : NULL;
    for (size_t k = 0; parts && k < part_count; k++) {
        const struct gm_node *part = &graph->nodes[parts[k]];
        foreign = part->operation == GM_VARIABLE && others[part->a] == GM_NO_NODE ? part->a : foreign;
    }
    bool good = parts && !graph->failed;
    if (good && foreign < system->variable_count) {
        char about[GM_FAULT_SENTENCE];
        snprintf(about, sizeof about, "it does not hold %.60s", system->variables[foreign].name);
        good = refuse(names, text, 0, about, sentence, size);
    }
    good = good && gm_formula_substitute(graph, node, 1, others, count);
    free(parts);
    free(others);
    return good;
}

bool gm_mesh_formula_is_smooth(const struct gm_mesh_names *names, const char *text, struct gm_formula *graph,
                               gm_node_id node, size_t smooth, char *sentence, size_t size)
{
    bool marked[GM_MOST_MESH_INPUTS] = {false};
    for (size_t k = 0; k < smooth; k++) {
        marked[k] = true;
    }
    const gm_node_id kink = gm_formula_kink(graph, node, marked, smooth);
    if (graph->failed || kink == GM_NO_NODE) {
        return !graph->failed;
    }
    char about[GM_FAULT_SENTENCE];
    const uint32_t place = gm_formula_origin(graph, kink);
    snprintf(about, sizeof about, "it has to be smooth, and %s is not",
             gm_operation_rows[graph->nodes[kink].operation].name);
    return refuse(names, text, place == GM_NO_PLACE ? 0 : place, about, sentence, size);
}

const char *const gm_user_densities[] = {"arclength", "curvature", "mix", "limited", "tempered", NULL};

const char *gm_user_density_formula(const char *text)
{
    static const char *const formulas[] = {
        "sqrt(1 + alpha^2*u_x^2)",
        "sqrt(sqrt(1 + (bend*alpha^2*V_u)^2))",
        "sqrt(alpha^2*u_x^2/2 + sqrt(1 + (bend*alpha^2*V_u/2)^2))",
        "sqrt(1 + alpha^2*u_x^2/(1 + (u_x/steepest)^2))",
        "sqrt(1 + 2*alpha^2*u_x^2/(1 + sqrt(1 + (u_x/steepest)^2)))",
    };
    for (size_t i = 0; gm_user_densities[i]; i++) {
        if (strcmp(gm_user_densities[i], text) == 0) {
            return formulas[i];
        }
    }
    return text;
}

static void values(const struct gm_density *density, const double *at, double *values, size_t m)
{
    gm_tape_values(&((const struct gm_user_density *)density)->tape, at, values, m);
}

bool gm_user_density_open(struct gm_user_density *density, struct gm_mesh_names *names, const char *text,
                          char *sentence, size_t size)
{
    enum { SLOPE, FIELD, PLACE, INPUTS };
    const struct gm_user_system *system = names->wave->system;
    *density = (struct gm_user_density){.density.values = values};
    names->word = GM_WORD_DENSITY;
    names->weighs = true;
    names->inputs[SLOPE] = system->velocities + 1;
    names->inputs[FIELD] = 0;
    names->inputs[PLACE] = system->velocities;
    names->words[SLOPE] = "u_x";
    names->words[FIELD] = "u";
    names->words[PLACE] = "x";
    names->input_count = INPUTS;
    struct gm_formula graph;
    gm_formula_open(&graph);
    const char *formula = gm_user_density_formula(text);
    gm_node_id rho, by[INPUTS], of[INPUTS][INPUTS], p;
    static const bool at_end[INPUTS] = {[FIELD] = true, [PLACE] = true};
    bool good = gm_mesh_formula_read(names, formula, &graph, &rho, sentence, size) &&
                gm_mesh_formula_is_smooth(names, formula, &graph, rho, PLACE, sentence, size);
    if (good) {
        p = gm_product(&graph, rho, rho);
        good = gm_gradient(&graph, p, NULL, INPUTS, by);
        for (size_t i = 0; good && i < INPUTS; i++) {
            good = gm_gradient(&graph, by[i], NULL, INPUTS, of[i]);
        }
    }
    if (good) {
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
        density->density.local = gm_formula_holds(&graph, p, at_end, INPUTS);
        good = gm_tape_open(&density->tape, &graph, nodes,
                            density->density.local ? GM_DENSITY_VALUES : GM_DENSITY_OF_SLOPE,
                            density->density.local ? INPUTS : 1, NULL) &&
               gm_tape_open(&density->itself, &graph, &rho, 1, INPUTS, NULL) && !graph.failed;
    }
    gm_formula_close(&graph);
    return good;
}

void gm_user_density_close(struct gm_user_density *density)
{
    gm_tape_close(&density->tape);
    gm_tape_close(&density->itself);
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

bool gm_user_map_open(struct gm_user_map *map, struct gm_mesh_names *names, const char *text, char *sentence,
                      size_t size)
{
    const struct gm_user_system *system = names->wave->system;
    *map = (struct gm_user_map){.map.places = places};
    names->word = GM_WORD_MESH;
    names->weighs = false;
    names->inputs[LABEL] = system->velocities;
    names->inputs[TIME] = system->n;
    names->words[LABEL] = "x";
    names->words[TIME] = "t";
    names->input_count = OF_MAP;
    const size_t named = strspn(text, " "),
                 equals = named + 1 + strspn(text + named + (text[named] != 0), " ");
    if (text[named] != 'X' || text[equals] != '=') {
        return refuse(names, text, 0,
                      "it is X = and a formula in x and t, as in X = x + 0.1*sin(pi*x)*sin(t)", sentence,
                      size);
    }
    struct gm_formula graph;
    gm_formula_open(&graph);
    gm_node_id node, by[OF_MAP];
    bool good = gm_mesh_formula_read(names, text + equals + 1, &graph, &node, sentence, size) &&
                gm_gradient(&graph, node, NULL, OF_MAP, by);
    if (good) {
        const gm_node_id nodes[] = {node, by[TIME]};
        good = gm_tape_open(&map->tape, &graph, nodes, GM_COUNT(nodes), OF_MAP, NULL) && !graph.failed;
    }
    gm_formula_close(&graph);
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
