/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The contents of a system, found by their names. */
#include "core/model/system.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

void gm_system_close(void *data)
{
    struct gm_user_system *system = data;
    gm_arena_close(system->arena);
    gm_formula_close(&system->graph);
    *system = (struct gm_user_system){0};
}

static _Noreturn void refuse(const struct gm_user_system *system, size_t place, const char *format,
                             va_list arguments)
{
    gm_system_need_graph(system); /* values of a graph that failed are not a fault of the text */
    vsnprintf(system->fault->sentence, sizeof system->fault->sentence, format, arguments);
    system->fault->offset = place;
    gm_arena_leave(system->arena);
}

void gm_system_refuse(const struct gm_user_system *system, size_t place, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    refuse(system, place, format, arguments);
}

void gm_system_refuse_if(const struct gm_user_system *system, bool wrong, size_t place, const char *format,
                         ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (wrong) {
        refuse(system, place, format, arguments);
    }
    va_end(arguments);
}

void gm_system_need_graph(const struct gm_user_system *system)
{
    gm_arena_need(system->arena, !system->graph.failed);
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

gm_node_id *gm_system_no_nodes(struct gm_user_system *system, size_t count)
{
    gm_node_id *nodes = gm_arena_take(system->arena, count + 1, sizeof *nodes);
    for (size_t i = 0; nodes && i < count; i++) {
        nodes[i] = GM_NO_NODE;
    }
    return nodes;
}

bool gm_system_place(struct gm_user_system *system, gm_node_id *nodes, size_t count)
{
    gm_node_id *others = gm_system_no_nodes(system, system->variable_count);
    if (!others) {
        return false;
    }
    others[system->velocities] = gm_formula_variable(&system->graph, 0);
    others[system->n] = gm_formula_variable(&system->graph, 1);
    return gm_formula_substitute(&system->graph, nodes, count, others, system->variable_count);
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

const struct gm_system_item *gm_system_item_named(const struct gm_user_system *system,
                                                  enum gm_system_word word, const char *name)
{
    const struct gm_system_item *item;
    size_t i = 0;
    do {
        item = gm_system_item_of(system, word, i++);
    } while (item && strcmp(item->name, name) != 0);
    return item;
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
