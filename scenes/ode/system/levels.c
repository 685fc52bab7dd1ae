/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Curves F = 0 of the values of F at the corners of a grid. The range of a curve is the range of its closed
   part around the start: the search follows cells with the curve from the start's cell, or, if the start is
   inside, cells of one sign up to them. */
#include "scenes/ode/system/parts.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/common/system/pieces.h"

enum {
    SOUGHT = 63, /* cells per side while the range is sought: odd, so that the middle is in a cell */
    DRAWN = 120,
    DOUBLINGS = 12
};

/* A level of a lane on a grid: the variables of F beside the two components, and F at the corners. */
struct level {
    const struct gm_tape *tape;
    const double *variables;
    size_t variable_count;
    const struct gm_sight *sight;
    double *row, *outputs, *corners;
};

/* Returns the next level of the plane or section that a sight shows; NULL after the last. */
static const struct gm_system_item *next_level(const struct gm_system_scene *system_scene,
                                               const struct gm_sight *sight, size_t *number)
{
    const struct gm_sight *first = &system_scene->sights[0];
    const bool in_section = sight == &system_scene->section,
               in_plane = !in_section && sight->components[0] == first->components[0] &&
                          sight->components[1] == first->components[1];
    const struct gm_system_item *item;
    while ((item = gm_system_item_of(&system_scene->system, GM_WORD_LEVEL, (*number)++))) {
        if (sight->components[0] >= 0 && sight->components[1] >= 0 &&
            (item->in_section ? in_section : in_plane)) {
            return item;
        }
    }
    return NULL;
}

bool gm_system_has_level(const struct gm_system_scene *system_scene, const struct gm_sight *sight)
{
    size_t number = 0;
    return next_level(system_scene, sight, &number) != NULL;
}

void gm_system_check_levels(struct gm_system_scene *system_scene)
{
    struct gm_arena *arena = system_scene->arena;
    const struct gm_user_system *system = &system_scene->system;
    const struct gm_system_item *item;
    for (size_t i = 0; (item = gm_system_item_of(system, GM_WORD_LEVEL, i)); i++) {
        const struct gm_sight *sight = item->in_section ? &system_scene->section : &system_scene->sights[0];
        if (sight->components[0] < 0 || sight->components[1] < 0) {
            gm_arena_refuse(arena, "level: a curve is drawn in a plane of two components");
        }
        size_t count = 0;
        const gm_node_id *parts =
            gm_arena_keep(arena, gm_formula_parts(&system->graph, item->nodes[0], &count), free);
        for (size_t k = 0; k < count; k++) {
            const struct gm_node *node = &system->graph.nodes[parts[k]];
            const bool moves =
                node->operation == GM_VARIABLE &&
                (node->a <= system->n || (node->a >= system->velocities && node->a < system->initial));
            if (moves && (long)node->a != sight->components[0] && (long)node->a != sight->components[1]) {
                gm_arena_refuse(arena, "level: %s is not shown: a curve holds %s and %s",
                                system->variables[node->a].name, system->variables[sight->components[0]].name,
                                system->variables[sight->components[1]].name);
            }
        }
    }
}

static const struct gm_system_scene *scene_of(const struct gm_lane *lane)
{
    return ((const struct gm_system_lane *)lane->parameters)->owner;
}

static struct level level_of(struct gm_picture *picture, const struct gm_lane *lane,
                             const struct gm_sight *sight)
{
    const struct gm_view view = gm_lane_view(lane);
    const size_t variables = gm_system_scene_of(&view)->system.variable_count, most = DRAWN + 1;
    double *all = gm_picture_memory(picture, (variables * (most + 1) + 2 * most + most * most) * sizeof *all);
    double *row = all + variables, *outputs = row + variables * most;
    gm_system_variables(&view, gm_system_centre(&view), true, all);
    return (struct level){.variables = all,
                          .variable_count = variables,
                          .sight = sight,
                          .row = row,
                          .outputs = outputs,
                          .corners = outputs + 2 * most};
}

/* Takes the next level that is drawn of a lane; false after the last. */
static bool take_level(struct level *level, const struct gm_lane *lane, size_t *number)
{
    const struct gm_system_scene *system_scene = scene_of(lane);
    const struct gm_system_item *item;
    while ((item = next_level(system_scene, level->sight, number))) {
        double values[2] = {0, 1};
        level->tape = &system_scene->of_items[item - system_scene->system.items];
        gm_tape_values(level->tape, level->variables, values, 1);
        if (values[1] > 0) {
            return true;
        }
    }
    return false;
}

static double corner(const struct gm_window *box, int axis, size_t i, size_t cells)
{
    return box->low[axis] + (box->high[axis] - box->low[axis]) * (double)i / (double)cells;
}

/* Writes F at the (cells + 1)^2 corners, row by row. */
static void fill_grid(const struct level *level, const struct gm_window *box, size_t cells)
{
    const size_t width = cells + 1;
    for (size_t v = 0; v < level->variable_count; v++) {
        for (size_t i = 0; i < width; i++) {
            level->row[v * width + i] = level->variables[v];
        }
    }
    for (size_t i = 0; i < width; i++) {
        level->row[(size_t)level->sight->components[0] * width + i] = corner(box, 0, i, cells);
    }
    for (size_t j = 0; j < width; j++) {
        const double up = corner(box, 1, j, cells);
        for (size_t i = 0; i < width; i++) {
            level->row[(size_t)level->sight->components[1] * width + i] = up;
        }
        gm_tape_values(level->tape, level->row, level->outputs, width);
        memcpy(level->corners + j * width, level->outputs, width * sizeof *level->corners);
    }
}

/* Returns the number of corners of a cell above 0; -1 if F is not finite at one of them. */
static int above(const struct level *level, size_t cells, size_t i, size_t j)
{
    const double *low = level->corners + j * (cells + 1) + i, *high = low + cells + 1;
    const double sum = low[0] + low[1] + high[0] + high[1];
    return isfinite(sum) ? (low[0] > 0) + (low[1] > 0) + (high[0] > 0) + (high[1] > 0) : -1;
}

/* Writes the cells of the curve around the middle of the grid to `found`. False without a curve that is
   closed in the box. */
static bool follow(const struct level *level, struct gm_window *found, const struct gm_window *box)
{
    enum { CELLS = SOUGHT, ALL = CELLS * CELLS };
    bool seen[ALL] = {false};
    size_t waiting[ALL], count = 1;
    waiting[0] = ALL / 2;
    seen[ALL / 2] = true;
    const int middle = above(level, CELLS, CELLS / 2, CELLS / 2);
    const bool inside = middle == 0 || middle == 4;
    bool some = false;
    for (size_t next = 0; next < count; next++) {
        const size_t i = waiting[next] % CELLS, j = waiting[next] / CELLS;
        const int here = above(level, CELLS, i, j);
        const bool crosses = here > 0 && here < 4;
        if (here < 0 || i == 0 || j == 0 || i == CELLS - 1 || j == CELLS - 1) {
            return false;
        }
        if (crosses) {
            for (int axis = 0; axis < 2; axis++) {
                gm_range_add(&found->low[axis], &found->high[axis], corner(box, axis, axis ? j : i, CELLS));
                gm_range_add(&found->low[axis], &found->high[axis],
                             corner(box, axis, (axis ? j : i) + 1, CELLS));
            }
            some = true;
        }
        if (crosses == inside) {
            continue; /* at the edge of the inside, or beside the curve */
        }
        for (size_t k = 0; k < 9; k++) {
            const size_t to = (j + k / 3 - 1) * CELLS + i + k % 3 - 1;
            if (!seen[to]) {
                seen[to] = true;
                waiting[count++] = to;
            }
        }
    }
    return some;
}

void gm_system_hold_levels(struct gm_picture *picture, const struct gm_lane *lane,
                           const struct gm_sight *sight, struct gm_seen *range)
{
    if (sight->over_time || !gm_system_has_level(scene_of(lane), sight)) {
        return;
    }
    struct level level = level_of(picture, lane, sight);
    for (size_t number = 0; take_level(&level, lane, &number);) {
        const struct gm_view view = gm_lane_view(lane);
        const size_t m = lane->problem.m, centre = gm_system_centre(&view);
        double reach[2], middle[2];
        for (int axis = 0; axis < 2; axis++) {
            middle[axis] = lane->start[(size_t)sight->components[axis] * m + centre];
            reach[axis] = fmax(fabs(middle[axis]), 0.1);
        }
        const double size = fmax(reach[0], reach[1]);
        for (int k = 0; k < DOUBLINGS; k++) {
            const double half = ldexp(size, k);
            const struct gm_window box = {{middle[0] - half, middle[1] - half},
                                          {middle[0] + half, middle[1] + half}};
            struct gm_window found = {{1, 1}, {0, 0}};
            fill_grid(&level, &box, SOUGHT);
            if (follow(&level, &found, &box)) {
                for (int axis = 0; axis < 2; axis++) {
                    gm_range_add(&range->low[axis], &range->high[axis], found.low[axis]);
                    gm_range_add(&range->low[axis], &range->high[axis], found.high[axis]);
                }
                break;
            }
        }
    }
}

void gm_system_draw_zeros(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                          const double *values, const size_t cells[2])
{
    static const double zero = 0;
    const struct gm_window box = {{panel->x.low, panel->y.low}, {panel->x.high, panel->y.high}};
    const size_t width = cells[0] + 1, corners = width * (cells[1] + 1);
    double *points = gm_picture_memory(picture, 2 * corners * sizeof *points);
    int *triangles = gm_picture_memory(picture, 6 * cells[0] * cells[1] * sizeof *triangles);
    uint8_t *signs = gm_picture_memory(picture, corners); /* 1: above 0; 2: below; 0: neither */
    for (size_t i = 0; i < corners; i++) {
        signs[i] = (uint8_t)((values[i] > 0) | (values[i] < 0) << 1);
    }
    size_t crossed = 0; /* cells whose corners are not all above 0, or all below */
    for (size_t j = 0; j < cells[1]; j++) {
        for (size_t i = 0; i < cells[0]; i++) {
            const int here = (int)(j * width + i), over = here + (int)width,
                      around[4] = {here, here + 1, over, over + 1};
            if (signs[here] & signs[here + 1] & signs[over] & signs[over + 1]) {
                continue;
            }
            for (size_t k = 0; k < 4; k++) {
                points[2 * around[k]] = corner(&box, 0, i + k % 2, cells[0]);
                points[2 * around[k] + 1] = corner(&box, 1, j + k / 2, cells[1]);
            }
            memcpy(triangles + 6 * crossed++, (const int[]){here, here + 1, over + 1, here, over + 1, over},
                   6 * sizeof *triangles);
        }
    }
    gm_mark_level_lines(picture, panel, style, points, values, corners, triangles, 2 * crossed, &zero, 1);
}

void gm_system_draw_levels(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                           const struct gm_sight *sight)
{
    static const size_t cells[2] = {DRAWN, DRAWN};
    const struct gm_window box = {{panel->x.low, panel->y.low}, {panel->x.high, panel->y.high}};
    if (!gm_system_has_level(scene_of(lane), sight)) {
        return;
    }
    struct level level = level_of(picture, lane, sight);
    for (size_t number = 0; take_level(&level, lane, &number);) {
        fill_grid(&level, &box, DRAWN);
        gm_system_draw_zeros(picture, panel, (struct gm_style){GM_EXACT, 1, 1.4, GM_SOLID}, level.corners,
                             cells);
    }
}

/* Returns true if a level is drawn of one of these lanes. */
static bool is_drawn(const struct gm_system_scene *system_scene, const struct gm_system_item *item,
                     const struct gm_lane *const *lanes, size_t count)
{
    double values[2] = {0, 1};
    for (size_t i = 0; i < count; i++) {
        const struct gm_view view = gm_lane_view(lanes[i]);
        if (gm_system_scene_of(&view) != system_scene) {
            continue;
        }
        gm_system_values(&system_scene->of_items[item - system_scene->system.items], &view,
                         gm_system_centre(&view), values);
        if (values[1] > 0) {
            return true;
        }
    }
    return false;
}

const char *gm_system_level_text(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    const struct gm_system_lane *lane = lanes[0]->parameters;
    const struct gm_system_scene *system_scene = lane->owner;
    const bool both = system_scene->has_section && strcmp(lane->show, system_scene->shows[GM_SHOW_ALL]) == 0;
    const struct gm_sight *const sights[] = {gm_system_sight(lane), &system_scene->section};
    const char *text = "";
    for (size_t k = 0; k < (both ? 2 : 1); k++) {
        const struct gm_system_item *item;
        for (size_t number = 0; (item = next_level(system_scene, sights[k], &number));) {
            if (is_drawn(system_scene, item, lanes, count)) {
                text = gm_picture_text(picture, "%s%s%s", text, text[0] ? ", " : ";  grey: ", item->text);
            }
        }
    }
    return text;
}
