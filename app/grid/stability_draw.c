/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stability maps: one panel a scheme, a cell for every step and value, with a letter, so that colour is not
 * needed. */
#include <math.h>

#include "app/grid/edges.h"
#include "app/grid/stability.h"
#include "scenes/common/graph.h"

enum { MOST_EDGES = 64 };

static struct gm_style style_of(const struct gm_map_cell *cell)
{
    switch (cell->verdict) {
    case GM_LOST:
        return (struct gm_style){.role = gm_lane_role(0), .alpha = 0.55};
    case GM_GAINED:
        return (struct gm_style){.role = gm_lane_role(1), .alpha = 0.6};
    case GM_WRONG:
        return (struct gm_style){.role = gm_lane_role(3), .alpha = 0.4};
    case GM_FAILED:
        return (struct gm_style){.role = GM_SECONDARY, .alpha = cell->status == GM_BLOW_UP ? 0.85 : 0.5};
    default:
        return (struct gm_style){.role = gm_lane_role(2), .alpha = cell->verdict == GM_BOUNDED ? 0.22 : 0};
    }
}

static void draw_map(const struct gm_stability_table *table, const struct gm_stability_map *map,
                     struct gm_picture *picture)
{
    const struct gm_stability *plan = table->plan;
    const bool logarithmic = table->parameter->logarithmic;
    double x[MOST_EDGES + 1], y[MOST_EDGES + 1];
    gm_edges_of(plan->values, plan->value_count, logarithmic, x);
    gm_edges_of(plan->steps, plan->step_count, true, y);
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, map->scheme->title);
    panel->axes = true;
    panel->title_role = GM_INK;
    const double limit = gm_stability_limit(table, map);
    panel->note =
        limit > 0 ? gm_picture_text(picture, "%s up to %.3g", gm_stability_judge(table), limit) : "";
    panel->x = (struct gm_axis){.label = table->parameter->key,
                                .scale = logarithmic ? GM_LOG : GM_LINEAR,
                                .low = x[0],
                                .high = x[plan->value_count],
                                .least_tick = plan->values[0],
                                .largest_tick = plan->values[plan->value_count - 1]};
    panel->y = (struct gm_axis){.label = plan->label,
                                .scale = GM_LOG,
                                .low = y[0],
                                .high = y[plan->step_count],
                                .least_tick = plan->steps[0],
                                .largest_tick = plan->steps[plan->step_count - 1]};
    for (size_t s = 0; s < plan->step_count; s++) {
        for (size_t v = 0; v < plan->value_count; v++) {
            const struct gm_map_cell *cell = &map->cells[s * plan->value_count + v];
            const double corners[] = {x[v], y[s], x[v + 1], y[s], x[v + 1], y[s + 1], x[v], y[s + 1]};
            gm_mark_polygon(picture, panel, style_of(cell), corners, 4);
        }
    }
    /* one letter for all that end alike, above one another */
    for (size_t v = 0; v < plan->value_count; v++) {
        size_t next = 0;
        for (size_t s = 0; s < plan->step_count; s = next) {
            const char letter = gm_cell_letter(&map->cells[s * plan->value_count + v]);
            for (next = s + 1; next < plan->step_count; next++) {
                if (gm_cell_letter(&map->cells[next * plan->value_count + v]) != letter) {
                    break;
                }
            }
            if (letter != '.') {
                gm_mark_text(picture, panel, (struct gm_style){.role = GM_INK, .alpha = 1, .width = 1},
                             logarithmic ? sqrt(x[v] * x[v + 1]) : (x[v] + x[v + 1]) / 2,
                             sqrt(y[s] * y[next]), GM_ANCHOR_CENTRE, gm_picture_text(picture, "%c", letter))
                    ->fixed = true;
            }
        }
    }
}

void gm_stability_draw(const struct gm_stability_table *table, struct gm_picture *picture)
{
    const struct gm_timing *timing = table->request.lanes[0].parameters;
    char letters[128], question[GM_TEXT_SIZE];
    picture->title = gm_picture_text(picture, "%s: which step is %s", table->request.scene->title,
                                     gm_stability_question(table, question, sizeof question));
    picture->subtitle = gm_picture_text(picture, "up: %s;  after t = %s", table->plan->label,
                                        gm_step_text(picture, timing->until));
    gm_stability_letters(table, letters, sizeof letters);
    picture->caption = gm_picture_text(picture, "Without a letter: %s.  %s%s", gm_stability_judge(table),
                                       letters, letters[0] ? "." : "");
    picture->clock = "";
    for (size_t i = 0; i < table->count; i++) {
        draw_map(table, &table->maps[i], picture);
    }
}
