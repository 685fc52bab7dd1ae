/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The work-precision diagram: every scheme a line; the few that matter coloured and named, the others
   grey. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/grid/chart.h"
#include "app/grid/grid.h"
#include "app/grid/hooks.h"
#include "core/expression/number.h"
#include "render/cells/text.h"

enum { NAMED = GM_LANE_COLOURS };

static bool holds(const struct gm_grid_line *const *chosen, size_t count, const struct gm_grid_line *line)
{
    for (size_t i = 0; i < count; i++) {
        if (chosen[i] == line) {
            return true;
        }
    }
    return false;
}

/* Returns true if more than one run was made. */
static bool is_line(const struct gm_grid_line *line)
{
    return line->count > 1 && line->cells[1].tried;
}

/* Chooses lines to name: the cheapest at each error by either cost, then the scene's preferred schemes,
 * then, if there are few, others. */
static size_t choose(const struct gm_grid *grid, const struct gm_grid_line *chosen[NAMED])
{
    size_t count = 0;
    for (size_t i = 0; grid->begun <= NAMED && i < grid->begun; i++) {
        chosen[count++] = &grid->lines[i];
    }
    const enum gm_cost costs[] = {GM_COST_SECONDS, gm_work_second_cost(grid)};
    for (int which = 0; which < 2; which++) {
        for (size_t i = 0; i < 3 && count < NAMED; i++) {
            const struct gm_grid_line *line = gm_work_cheapest(grid, grid->errors[i], costs[which]);
            if (line && !holds(chosen, count, line)) {
                chosen[count++] = line;
            }
        }
    }
    const char *const *preferred = grid->request.scene->schemes;
    for (; *preferred && count < NAMED; preferred++) {
        for (size_t i = 0; i < grid->begun && count < NAMED; i++) {
            if (strcmp(grid->lines[i].scheme->name, *preferred) == 0 && is_line(&grid->lines[i]) &&
                !holds(chosen, count, &grid->lines[i])) {
                chosen[count++] = &grid->lines[i];
            }
        }
    }
    for (size_t i = 0; grid->begun <= 2 * NAMED && i < grid->begun && count < NAMED; i++) {
        if (is_line(&grid->lines[i]) && !holds(chosen, count, &grid->lines[i])) {
            chosen[count++] = &grid->lines[i];
        }
    }
    return count;
}

static size_t points_of(const struct gm_grid_line *line, enum gm_cost cost, double *points)
{
    size_t count = 0, all;
    const struct gm_grid_cell *front = gm_work_front(line, cost, &all);
    for (size_t k = 0; k < all; k++) {
        const double price = gm_work_cost(&front[k], cost), error = front[k].error;
        if (isfinite(error) && error > 0 && price > 0 && isfinite(price)) {
            points[2 * count] = price;
            points[2 * count + 1] = error;
            count++;
        }
    }
    return count;
}

/* A rectangle for a name, in fractions of the panel's width and height. */
struct place {
    double left, low, right, high;
};

/* A line that the panel shows. */
struct drawn {
    const double *points;
    size_t count;
};

static double across(const struct gm_axis *axis, double value)
{
    return log(value / axis->low) / log(axis->high / axis->low);
}

/* The part of a line that runs through a place, in steps of a hundredth of the panel. */
static double covered(const struct gm_panel *panel, const struct drawn *line, const struct place *place)
{
    double steps = 0;
    for (size_t k = 0; k + 1 < line->count; k++) {
        const double *from = &line->points[2 * k], *to = from + 2;
        const double x = across(&panel->x, from[0]), y = across(&panel->y, from[1]);
        const double dx = across(&panel->x, to[0]) - x, dy = across(&panel->y, to[1]) - y;
        const int pieces = 1 + (int)fmin(100, 100 * hypot(dx, dy));
        for (int i = 0; i <= pieces; i++) {
            const double u = x + dx * i / pieces, v = y + dy * i / pieces;
            steps += u > place->left && u < place->right && v > place->low && v < place->high;
        }
    }
    return steps;
}

/* The coloured lines of a panel, and the places of their names. */
struct names {
    const struct gm_panel *panel;
    struct drawn lines[NAMED];
    size_t line_count;
    struct place taken[NAMED];
    size_t taken_count;
};

/* The place for the name of a line, that covers least and touches no other name: beside one of its points, right
   or left, above or below. */
static struct place name_place(const struct names *names, const struct drawn *own, size_t letters)
{
    const struct gm_panel *panel = names->panel;
    /* a letter, and a line of text, in a picture of usual size */
    const double wide = 0.016 * (double)letters, tall = 0.042, aside = 0.012;
    struct place best = {0};
    double least = INFINITY;
    for (size_t k = 0; k < own->count; k++) {
        const double u = across(&panel->x, own->points[2 * k]);
        const double v = across(&panel->y, own->points[2 * k + 1]);
        for (int side = 0; side < 4; side++) {
            const double left = side & 1 ? u - aside - wide : u + aside;
            const double low = side & 2 ? v - 0.8 * tall : v - 0.2 * tall;
            const struct place place = {left, low, left + wide, low + tall};
            /* later points are lower, and lines separate there */
            double cost = 0.2 * (double)side + 0.5 * (double)(own->count - k) / (double)own->count;
            cost += place.left < 0 || place.right > 1 ? 40 : 0;
            cost += place.low < 0 || place.high > 1.02 ? 40 : 0;
            for (size_t i = 0; i < names->taken_count; i++) {
                const struct place *taken = &names->taken[i];
                const bool apart = place.left > taken->right || place.right < taken->left ||
                                   place.low > taken->high || place.high < taken->low;
                cost += apart ? 0 : 100;
            }
            for (size_t i = 0; i < names->line_count; i++) {
                cost += covered(panel, &names->lines[i], &place);
            }
            if (cost < least) {
                least = cost;
                best = place;
            }
        }
    }
    return best;
}

static int compare(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

/* Values in rising order; NULL: out of memory. */
static const double *rising(struct gm_picture *picture, const double *values, size_t count)
{
    double *sorted = gm_picture_memory(picture, count * sizeof *sorted);
    if (sorted) {
        memcpy(sorted, values, count * sizeof *sorted);
        qsort(sorted, count, sizeof *sorted, compare);
    }
    return sorted;
}

static void draw_cost(const struct gm_grid *grid, struct gm_picture *picture, enum gm_cost cost,
                      const struct gm_grid_line *const *chosen, size_t chosen_count)
{
    const char *finer = gm_picture_text(picture, "%s%s", grid->smaller_is_finer ? "1/" : "",
                                        grid->parameter ? grid->parameter->key : "");
    const char *const titles[] = {"error against run time", "error against evaluations",
                                  gm_picture_text(picture, "error against %s", finer)};
    const char *const labels[] = {"CPU time, s", "evaluations of f or force", finer};
    double *points = gm_picture_memory(picture, 2 * grid->steps.count * grid->values.count * sizeof *points);
    if (!points) {
        return;
    }
    const struct gm_axis x = {.label = labels[cost], .scale = GM_LOG, .low = 1, .high = 0},
                         y = {.label = "", .scale = GM_LOG, .low = 1, .high = 0};
    struct gm_panel *panel = gm_chart_panel(picture, GM_PLACE_GRAPH, titles[cost], &x, &y);
    for (size_t i = 0; i < grid->begun; i++) {
        const size_t count = points_of(&grid->lines[i], cost, points);
        for (size_t k = 0; k < count; k++) {
            gm_range_add(&panel->x.low, &panel->x.high, points[2 * k]);
            /* errors above 10 are drawn as 10 */
            gm_range_add(&panel->y.low, &panel->y.high, fmin(points[2 * k + 1], 10));
        }
    }
    gm_range_round(&panel->x.low, &panel->x.high, GM_LOG);
    if (cost == GM_COST_RESOLUTION && !grid->smaller_is_finer) {
        panel->x.ticks = rising(picture, grid->values.values, grid->values.count);
        panel->x.tick_count = panel->x.ticks ? grid->values.count : 0;
    }
    gm_range_round(&panel->y.low, &panel->y.high, GM_LOG);
    for (size_t i = 0; i < grid->begun; i++) {
        if (!holds(chosen, chosen_count, &grid->lines[i])) {
            const size_t count = points_of(&grid->lines[i], cost, points);
            gm_mark_line(picture, panel, (struct gm_style){GM_SECONDARY, 0.35, 1.1, GM_SOLID}, points, count,
                         false);
        }
    }
    struct names names = {.panel = panel, .line_count = chosen_count};
    struct drawn *lines = names.lines;
    for (size_t i = 0; i < chosen_count; i++) {
        const size_t most = grid->steps.count * grid->values.count;
        double *own = gm_picture_memory(picture, 2 * most * sizeof *own);
        lines[i] = (struct drawn){own, own ? points_of(chosen[i], cost, own) : 0};
        const struct gm_style style = gm_chart_style(i);
        gm_mark_line(picture, panel, style, own, lines[i].count, false);
        gm_mark_points(picture, panel, (struct gm_style){.role = style.role, .alpha = 1, .width = 6}, own,
                       lines[i].count);
    }
    for (size_t i = 0; i < chosen_count; i++) {
        const char *name = chosen[i]->scheme->title;
        if (lines[i].count == 0) {
            continue;
        }
        const struct place place = name_place(&names, &lines[i], (size_t)gm_text_width(name, false));
        names.taken[names.taken_count++] = place;
        gm_mark_text(picture, panel, (struct gm_style){.role = gm_lane_role(i), .alpha = 1, .width = 1},
                     panel->x.low * pow(panel->x.high / panel->x.low, place.left),
                     panel->y.low * pow(panel->y.high / panel->y.low, 0.5 * (place.low + place.high)),
                     GM_ANCHOR_LEFT, name);
    }
}

void gm_work_draw(const struct gm_grid *grid, struct gm_picture *picture)
{
    const struct gm_grid_line *chosen[NAMED] = {NULL};
    const size_t count = choose(grid, chosen);
    const struct gm_scene *scene = grid->request.scene;
    char sentence[512];
    picture->title = gm_picture_text(picture, "%s: what an accuracy costs", scene->title);

    picture->subtitle =
        gm_picture_text(picture, "%s at t = %s,  %s%s%zu scheme%s%s", grid->measure_title,
                        gm_step_text(picture, gm_grid_timing(grid)->until), grid->settings,
                        grid->settings[0] ? ",  " : "", grid->begun, gm_plural((double)grid->begun),
                        count < grid->begun ? ";  grey: those without a name" : "");

    picture->clock = "";
    picture->caption = gm_picture_text(picture, "%s", gm_work_sentence(grid, sentence, sizeof sentence));
    draw_cost(grid, picture, GM_COST_SECONDS, chosen, count);
    draw_cost(grid, picture, gm_work_second_cost(grid), chosen, count);
}
