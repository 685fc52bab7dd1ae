/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contents of a system, found by their names. */
#include "core/model/system.h"

#include <stdlib.h>
#include <string.h>

void gm_system_close(struct gm_user_system *system)
{
    for (size_t i = 0; i < system->variable_count; i++) {
        free(system->variables[i].name);
        free(system->variables[i].text);
        free(system->variables[i].meaning);
        free(system->variables[i].unit);
    }
    for (size_t i = 0; i < system->item_count; i++) {
        struct gm_system_item *item = &system->items[i];
        for (size_t k = 0; k < item->option_count; k++) {
            free(item->options[k].text);
            free(item->options[k].numbers);
        }
        free(item->options);
        free(item->name);
        free(item->words);
        free(item->text);
        free(item->nodes);
    }
    for (size_t i = 0; i < GM_WORDS; i++) {
        free(system->texts[i]);
    }
    free(system->source);
    free(system->variables);
    free(system->items);
    free(system->rates);
    free(system->momenta);
    free(system->mass.entries);
    free(system->bracket);
    free(system->matrices);
    free(system->matrix_places);
    free(system->facets);
    free(system->parts);
    gm_formula_close(&system->graph);
    *system = (struct gm_user_system){0};
}

static const char *variable_name(size_t number, const void *data)
{
    return ((const struct gm_user_system *)data)->variables[number].name;
}

static const char *part_name(gm_node_id node, const void *data)
{
    const struct gm_user_system *system = data;
    return node < system->part_count ? system->parts[node] : NULL;
}

bool gm_system_place(struct gm_user_system *system, gm_node_id *nodes, size_t count)
{
    const size_t variables = system->velocities + 1;
    gm_node_id *others = malloc(variables * sizeof *others);
    for (size_t i = 0; others && i < variables; i++) {
        others[i] = GM_NO_NODE;
    }
    if (others) {
        others[system->velocities] = gm_formula_variable(&system->graph, 0);
        others[system->n] = gm_formula_variable(&system->graph, 1);
    }
    const bool good = others && gm_formula_substitute(&system->graph, nodes, count, others, variables);
    free(others);
    return good;
}

const struct gm_system_item *gm_system_item_of(const struct gm_user_system *system, enum gm_system_word word,
                                               size_t number)
{
    for (size_t i = 0; i < system->item_count; i++) {
        if (system->items[i].word == word && number-- == 0) {
            return &system->items[i];
        }
    }
    return NULL;
}

const struct gm_system_option *gm_system_option(const struct gm_system_item *item,
                                                enum gm_system_option_word word)
{
    for (size_t i = 0; i < item->option_count; i++) {
        if (item->options[i].word == word) {
            return &item->options[i];
        }
    }
    return NULL;
}

const char *gm_system_option_text(const struct gm_system_item *item, enum gm_system_option_word word,
                                  const char *otherwise)
{
    const struct gm_system_option *option = gm_system_option(item, word);
    return option ? option->text : otherwise;
}

double gm_system_option_number(const struct gm_system_item *item, enum gm_system_option_word word,
                               double otherwise)
{
    const struct gm_system_option *option = gm_system_option(item, word);
    return option ? option->numbers[0] : otherwise;
}

struct gm_naming gm_system_naming(const struct gm_user_system *system)
{
    return (struct gm_naming){.variable = variable_name, .part = part_name, .data = system};
}

gm_node_id gm_system_derivative(struct gm_user_system *system, gm_node_id node, size_t variable)
{
    gm_node_id *direction = malloc((system->variable_count + 1) * sizeof *direction), result = GM_NO_NODE;
    for (size_t i = 0; direction && i < system->variable_count; i++) {
        direction[i] = gm_formula_constant(&system->graph, i == variable);
    }
    if (direction && node != GM_NO_NODE) {
        result = gm_derivative_along(&system->graph, node, direction, system->variable_count);
    }
    system->graph.failed |= result == GM_NO_NODE;
    free(direction);
    return result;
}
