/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sights of a user-defined system: bodies and rods from its file, the planes of two components, the
   section; names of their axes, and which of them are angles. */
#include "scenes/ode/system/parts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/common/system/pieces.h"

/* Returns true if a formula turns with an angle: 2 pi more of that changes it by 2 pi or -2 pi. */
static bool is_angle(struct gm_system_scene *system_scene, gm_node_id node)
{
    const struct gm_user_system *system = &system_scene->system;
    bool angles = false, found = false;
    for (size_t i = 0; i < system->n; i++) {
        angles |= system->variables[i].angle;
    }
    if (!angles) {
        return false;
    }
    struct gm_arena *arena = system_scene->arena;
    const size_t mark = gm_arena_mark(arena);
    const struct gm_tape *tape = gm_system_take_tape(system_scene, &node, 1);
    double *values = gm_arena_keep(arena, gm_system_start_values(system_scene->initial, NULL), free), before,
           after;
    gm_tape_values(tape, values, &before, 1);
    for (size_t i = 0; i < system->n && !found; i++) {
        if (system->variables[i].angle) {
            values[i] += 2 * M_PI;
            gm_tape_values(tape, values, &after, 1);
            values[i] -= 2 * M_PI;
            found = fabs(fabs(after - before) - 2 * M_PI) < 1e-9;
        }
    }
    gm_arena_release(arena, mark);
    return found;
}

/* Describes an axis: its name, and if it is an angle or a component. */
static void describe_axis(struct gm_system_scene *system_scene, struct gm_sight *sight, size_t k,
                          gm_node_id node)
{
    const struct gm_user_system *system = &system_scene->system;
    const struct gm_node *at = &system->graph.nodes[node];
    const struct gm_naming naming = gm_system_naming(system);
    if (k < 2) {
        sight->components[k] = at->operation == GM_VARIABLE && at->a < system->n ? (long)at->a : -1;
        sight->angles[k] = is_angle(system_scene, node);
    }
    sight->labels[k] =
        gm_arena_keep(system_scene->arena, gm_formula_text(&system->graph, node, &naming), free);
}

/* A plane of two formulas. */
static void open_plane(struct gm_system_scene *system_scene, struct gm_sight *sight, gm_node_id x,
                       gm_node_id y)
{
    const gm_node_id nodes[] = {x, y};
    sight->dimensions = 2;
    sight->bodies = 1;
    sight->fixed = gm_arena_take(system_scene->arena, 1, sizeof *sight->fixed);
    describe_axis(system_scene, sight, 0, x);
    describe_axis(system_scene, sight, 1, y);
    gm_system_open_tape(system_scene, &sight->tape, nodes, 2);
}

/* Copies the formulas of all lines of a word; returns their end. */
static gm_node_id *copy_nodes(const struct gm_user_system *system, enum gm_system_word word, gm_node_id *to)
{
    const struct gm_system_item *item;
    for (size_t i = 0; (item = gm_system_item_of(system, word, i)); i++) {
        memcpy(to, item->nodes, item->count * sizeof *to);
        to += item->count;
    }
    return to;
}

/* Finds the bodies at rest. */
static void find_fixed(const struct gm_system_scene *system_scene, struct gm_sight *sight,
                       const gm_node_id *nodes)
{
    struct gm_arena *arena = system_scene->arena;
    const struct gm_user_system *system = &system_scene->system;
    bool *marked = gm_arena_take(arena, system->variable_count, sizeof *marked);
    for (size_t i = 0; i <= system->n; i++) {
        marked[i] = true;
    }
    const bool *moves =
        gm_arena_keep(arena, gm_formula_dependent(&system->graph, marked, system->variable_count), free);
    for (size_t i = 0; i < sight->bodies; i++) {
        sight->fixed[i] = true;
        for (size_t k = 0; k < sight->dimensions; k++) {
            sight->fixed[i] = sight->fixed[i] && !moves[nodes[i * sight->dimensions + k]];
        }
    }
}

/* Returns the name of axis k of space, x for bodies that are members of lists, x[1], x[2]. NULL if they have
   no common name. */
static const char *common_name(struct gm_system_scene *system_scene, size_t k)
{
    const struct gm_user_system *system = &system_scene->system;
    const char *common = NULL;
    size_t length = 0;
    const struct gm_system_item *item;
    for (size_t i = 0; (item = gm_system_item_of(system, GM_WORD_VIEW, i)); i++) {
        const struct gm_node *at = &system->graph.nodes[item->nodes[k]];
        if (at->operation != GM_VARIABLE || at->a >= system->n) {
            continue;
        }
        const char *name = system->variables[at->a].name;
        if (common && (strcspn(name, "[") != length || strncmp(name, common, length) != 0)) {
            return NULL;
        }
        common = name;
        length = strcspn(name, "[");
    }
    return common ? gm_arena_print(system_scene->arena, "%.*s", (int)length, common) : NULL;
}

/* Names the axes: in a plane by the variables of its one body, and then clicks are starts; in space x, y and
   z, unless the bodies have one common other name. */
static void name_axes(struct gm_system_scene *system_scene, struct gm_sight *sight)
{
    const struct gm_user_system *system = &system_scene->system;
    static const char *const usual[] = {"x", "y", "z"};
    const struct gm_system_item *first = gm_system_item_of(system, GM_WORD_VIEW, 0);
    const bool in_space = sight->dimensions == 3;
    bool told = first && (in_space || sight->rods == 0);
    for (size_t k = 0; told && k < sight->dimensions; k++) {
        const struct gm_node *at = &system->graph.nodes[first->nodes[k]];
        told = at->operation == GM_VARIABLE && at->a <= system->n;
        sight->over_time = sight->over_time || (told && k == 0 && !in_space && at->a == system->n);
        if (told) {
            const bool several = in_space && sight->bodies > 1;
            const char *common = several ? common_name(system_scene, k) : system->variables[at->a].name;
            sight->labels[k] = common ? common : usual[k];
            sight->components[k % 2] = in_space ? -1 : (long)at->a;
            sight->angles[k % 2] = !in_space && sight->bodies == 1 && system->variables[at->a].angle;
        }
    }
    for (size_t k = 0; k < 3 && !told; k++) {
        sight->labels[k] = in_space ? usual[k] : k == 0 && sight->over_time ? "t" : NULL;
    }
    if (sight->bodies > 1 && sight->components[0] >= 0 && !sight->over_time) {
        sight->labels[0] = sight->labels[1] = NULL; /* the names belong to one body only */
        for (size_t i = 1; i < sight->bodies; i++) {
            if (!sight->fixed[i]) {
                sight->components[0] = sight->components[1] = -1;
            }
        }
    }
}

/* Returns the number of items of a word. */
static size_t count_items(const struct gm_user_system *system, enum gm_system_word word)
{
    size_t count = 0;
    while (gm_system_item_of(system, word, count)) {
        count++;
    }
    return count;
}

/* Opens the sight of `view` and `rod` lines. */
static void open_view(struct gm_system_scene *system_scene, struct gm_sight *sight)
{
    const struct gm_user_system *system = &system_scene->system;
    const size_t views = count_items(system, GM_WORD_VIEW), rods = count_items(system, GM_WORD_ROD);
    const size_t dimensions = views > 0 ? gm_system_item_of(system, GM_WORD_VIEW, 0)->count
                                        : gm_system_item_of(system, GM_WORD_ROD, 0)->count / 2;
    *sight = (struct gm_sight){
        .name = "view", .dimensions = dimensions, .bodies = views, .rods = rods, .components = {-1, -1}};
    gm_node_id *nodes = gm_arena_take(system_scene->arena, gm_sight_numbers(sight), sizeof *nodes);
    sight->fixed = gm_arena_take(system_scene->arena, views + 1, sizeof *sight->fixed);
    copy_nodes(system, GM_WORD_ROD, copy_nodes(system, GM_WORD_VIEW, nodes));
    find_fixed(system_scene, sight, nodes);
    gm_system_open_tape(system_scene, &sight->tape, nodes, gm_sight_numbers(sight));
    name_axes(system_scene, sight);
}

void gm_system_open_surfaces(struct gm_system_scene *system_scene)
{
    gm_node_id nodes[3 * GM_MOST_SURFACES];
    const size_t count = count_items(&system_scene->system, GM_WORD_SURFACE);
    if (count > GM_MOST_SURFACES) {
        gm_arena_refuse(system_scene->arena, "a system has at most %d surfaces; this has %zu",
                        GM_MOST_SURFACES, count);
    }
    copy_nodes(&system_scene->system, GM_WORD_SURFACE, nodes);
    if (count > 0) {
        gm_system_open_tape(system_scene, &system_scene->surfaces, nodes, 3 * count);
    }
}

static void add_pair(struct gm_system_scene *system_scene, size_t a, size_t b)
{
    struct gm_user_system *system = &system_scene->system;
    if (system_scene->sight_count == GM_MOST_SIGHTS) {
        return;
    }
    struct gm_sight *sight = &system_scene->sights[system_scene->sight_count++];
    system_scene->pair_count++;
    sight->name =
        gm_arena_print(system_scene->arena, "%s:%s", system->variables[a].name, system->variables[b].name);
    open_plane(system_scene, sight, gm_formula_variable(&system->graph, a),
               gm_formula_variable(&system->graph, b));
}

void gm_system_make_sights(struct gm_system_scene *system_scene)
{
    const struct gm_user_system *system = &system_scene->system;
    const size_t n = gm_system_motion(system), half = n / 2;
    const struct gm_system_item *items = system->items;
    system_scene->sights = gm_arena_take(system_scene->arena, GM_MOST_SIGHTS, sizeof *system_scene->sights);
    system_scene->shows = gm_arena_take(system_scene->arena, GM_MOST_SIGHTS + 5 + system->item_count,
                                        sizeof *system_scene->shows);
    if (count_items(system, GM_WORD_VIEW) > 0 || count_items(system, GM_WORD_ROD) > 0) {
        open_view(system_scene, &system_scene->sights[system_scene->sight_count++]);
    }
    if (n == 1) {
        add_pair(system_scene, 1, 0); /* the component over time */
    }
    for (size_t i = 0; system->kind <= GM_LAGRANGIAN && i < half; i++) {
        add_pair(system_scene, i, gm_system_component(system, half + i, 0));
    }
    const size_t planar = system->kind <= GM_LAGRANGIAN ? half : n;
    for (size_t i = 0; i < planar && n > 1; i++) {
        for (size_t k = i + 1; k < planar && system_scene->sight_count < GM_MOST_SIGHTS; k++) {
            add_pair(system_scene, i, k);
        }
    }
    const struct gm_sight *first = &system_scene->sights[0];
    system_scene->disc[1] =
        n == 1 ? 0 : gm_system_component(system, system->kind <= GM_LAGRANGIAN ? half : 1, 0);
    if (first->components[0] >= 0 && first->components[1] >= 0 && n > 1 && !first->over_time) {
        system_scene->disc[0] = (size_t)first->components[0];
        system_scene->disc[1] = (size_t)first->components[1];
    }
    const struct gm_system_item *section_item = gm_system_item_of(system, GM_WORD_SECTION, 0);
    if (section_item) {
        gm_node_id nodes[1 + GM_MOST_CONDITIONS] = {section_item->nodes[0]};
        system_scene->has_section = true;
        system_scene->stroboscopic = section_item->periodic;
        system_scene->at_event = section_item->at_event;
        system_scene->conditions =
            section_item->count - 3 < GM_MOST_CONDITIONS ? section_item->count - 3 : GM_MOST_CONDITIONS;
        memcpy(nodes + 1, section_item->nodes + 3, system_scene->conditions * sizeof *nodes);
        system_scene->turns =
            !system_scene->stroboscopic && !system_scene->at_event && is_angle(system_scene, nodes[0]);
        system_scene->section.name = "section";
        open_plane(system_scene, &system_scene->section, section_item->nodes[1], section_item->nodes[2]);
        gm_system_open_tape(system_scene, &system_scene->where, nodes, 1 + system_scene->conditions);
    }
    size_t shows = 0;
    system_scene->shows[shows++] = "all";
    if (system_scene->has_section) {
        system_scene->shows[shows++] = "section";
    }
    for (size_t i = 0; i < system->item_count; i++) {
        system_scene->shows[shows] = gm_system_option_text(&items[i], GM_OPTION_SHOW, NULL);
        shows += system_scene->shows[shows] != NULL;
    }
    if (n > 1 && system->n <= GM_MOST_OVER_TIME) {
        system_scene->shows[shows++] = GM_SHOW_OVER_TIME "all";
    }
    for (size_t i = system_scene->sight_count - system_scene->pair_count; i < system_scene->sight_count;
         i++) {
        system_scene->shows[shows++] = system_scene->sights[i].name;
    }
}
