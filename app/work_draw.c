/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The work-precision diagram: every scheme a line; the few that matter coloured and named, the others grey.
 */
#include <math.h>
#include <string.h>

#include "app/work.h"

enum { NAMED = GM_LANE_COLOURS };

static bool holds(const struct gm_work_line *const *chosen, size_t count, const struct gm_work_line *line)
{
    for (size_t i = 0; i < count; i++) {
        if (chosen[i] == line) {
            return true;
        }
    }
    return false;
}

/* The cheapest at each error by either cost, then the scene's preferred ones. */
static size_t choose(const struct gm_work_table *table, const struct gm_work_line *chosen[NAMED])
{
    size_t count = 0;
    for (size_t i = 0; table->line_count <= NAMED && i < table->line_count; i++) {
        chosen[count++] = &table->lines[i];
    }
    const enum gm_work_cost costs[] = {GM_COST_SECONDS, gm_work_second_cost(table)};
    for (int which = 0; which < 2; which++) {
        for (size_t i = 0; i < 3 && count < NAMED; i++) {
            const struct gm_work_line *line = gm_work_cheapest(table, table->errors[i], costs[which]);
            if (line && !holds(chosen, count, line)) {
                chosen[count++] = line;
            }
        }
    }
    const char *const *preferred = table->request.scene->schemes;
    for (; *preferred && count < NAMED; preferred++) {
        for (size_t i = 0; i < table->line_count && count < NAMED; i++) {
            if (strcmp(table->lines[i].scheme->name, *preferred) == 0 && table->lines[i].count > 1 &&
                !holds(chosen, count, &table->lines[i])) {
                chosen[count++] = &table->lines[i];
            }
        }
    }
    return count;
}

static size_t points_of(const struct gm_work_line *line, enum gm_work_cost cost, double *points)
{
    size_t count = 0, all;
    const struct gm_work_point *front = gm_work_front(line, cost, &all);
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

/* Where a name stands: beside the point of its line that is farthest from the names that stand already. */
static size_t free_point(const struct gm_panel *panel, const double *points, size_t count,
                         const double *taken, size_t taken_count)
{
    const double wide = log(panel->x.high / panel->x.low), tall = log(panel->y.high / panel->y.low);
    size_t best = count - 1;
    double most = -1;
    for (size_t k = count; k-- > 0;) {
        /* room for the text to the right, and above the axis */
        if (log(panel->x.high / points[2 * k]) < 0.3 * wide ||
            log(points[2 * k + 1] / panel->y.low) < 0.04 * tall) {
            continue;
        }
        double least = 1;
        for (size_t i = 0; i < taken_count; i++) {
            const double right = log(points[2 * k] / taken[2 * i]) / wide;
            const double up = log(points[2 * k + 1] / taken[2 * i + 1]) / tall;
            /* names are wide and low */
            least = fmin(least, hypot(right / 4, up));
        }
        if (least > most + 1e-9) {
            most = least;
            best = k;
        }
    }
    return best;
}

static void draw_cost(const struct gm_work_table *table, struct gm_picture *picture, enum gm_work_cost cost,
                      const struct gm_work_line *const *chosen, size_t chosen_count)
{
    const char *finer = gm_picture_text(picture, "%s%s", table->smaller_is_finer ? "1/" : "",
                                        table->resolution ? table->resolution->key : "");
    const char *const titles[] = {"error against run time", "error against evaluations",
                                  gm_picture_text(picture, "error against %s", finer)};
    const char *const labels[] = {"processor time, s", "evaluations of f or force", finer};
    double *points =
        gm_picture_memory(picture, 2 * table->step_count * table->resolution_count * sizeof *points);
    if (!points) {
        return;
    }
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_GRAPH, titles[cost]);
    panel->axes = true;
    panel->title_role = GM_INK;
    panel->x = (struct gm_axis){.label = labels[cost], .scale = GM_LOG, .low = 1, .high = 0};
    panel->y = (struct gm_axis){.label = "", .scale = GM_LOG, .low = 1, .high = 0};
    for (size_t i = 0; i < table->line_count; i++) {
        const size_t count = points_of(&table->lines[i], cost, points);
        for (size_t k = 0; k < count; k++) {
            gm_range_add(&panel->x.low, &panel->x.high, points[2 * k]);
            /* an error above 10 says no more than 10 does */
            gm_range_add(&panel->y.low, &panel->y.high, fmin(points[2 * k + 1], 10));
        }
    }
    gm_range_round(&panel->x.low, &panel->x.high, GM_LOG);
    gm_range_round(&panel->y.low, &panel->y.high, GM_LOG);
    for (size_t i = 0; i < table->line_count; i++) {
        if (!holds(chosen, chosen_count, &table->lines[i])) {
            const size_t count = points_of(&table->lines[i], cost, points);
            gm_mark_line(picture, panel, (struct gm_style){GM_SECONDARY, 0.35, 1.1, GM_SOLID}, points, count,
                         false);
        }
    }
    double taken[2 * NAMED];
    size_t taken_count = 0;
    for (size_t i = 0; i < chosen_count; i++) {
        const size_t count = points_of(chosen[i], cost, points);
        if (count == 0) {
            continue;
        }
        const struct gm_style style = {gm_lane_role(i), 1, 2.4, gm_lane_dash(i)};
        gm_mark_line(picture, panel, style, points, count, false);
        gm_mark_points(picture, panel, (struct gm_style){.role = style.role, .alpha = 1, .width = 6}, points,
                       count);
        const size_t at = free_point(panel, points, count, taken, taken_count);
        taken[2 * taken_count] = points[2 * at];
        taken[2 * taken_count + 1] = points[2 * at + 1];
        taken_count++;
        /* a little to the right of its point */
        gm_mark_text(picture, panel, (struct gm_style){.role = style.role, .alpha = 1, .width = 1},
                     points[2 * at] * pow(panel->x.high / panel->x.low, 0.015),
                     points[2 * at + 1] * pow(panel->y.high / panel->y.low, 0.02), GM_ANCHOR_LEFT,
                     chosen[i]->scheme->title);
    }
}

void gm_work_draw(const struct gm_work_table *table, struct gm_picture *picture)
{
    const struct gm_work_line *chosen[NAMED] = {NULL};
    const size_t count = choose(table, chosen);
    const struct gm_scene *scene = table->request.scene;
    char sentence[512];
    picture->title = gm_picture_text(picture, "%s: what an accuracy costs", scene->title);

    picture->subtitle =
        gm_picture_text(picture, "%s at t = %.6g, %zu schemes%s", table->measure_title,
                        ((const struct gm_timing *)table->request.lanes[0].parameters)->until,
                        table->line_count, count < table->line_count ? ";  grey: those without a name" : "");

    picture->clock = "";
    picture->caption = gm_picture_text(picture, "%s", gm_work_sentence(table, sentence, sizeof sentence));
    draw_cost(table, picture, GM_COST_SECONDS, chosen, count);
    draw_cost(table, picture, gm_work_second_cost(table), chosen, count);
}
