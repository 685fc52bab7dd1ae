/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stability maps: one panel a scheme, a cell for every step and value, with a letter, so that colour is not
 * needed. */
#include <math.h>

#include "app/grid/chart.h"
#include "app/grid/hooks.h"
#include "app/grid/judge.h"
#include "core/expression/number.h"

enum { MOST_EDGES = 64 };

static struct gm_style style_of(const struct gm_grid_cell *cell)
{
    if (!cell->tried) {
        return (struct gm_style){.role = gm_lane_role(2), .alpha = 0};
    }
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
        return (struct gm_style){.role = gm_lane_role(2), .alpha = 0.22};
    }
}

static void draw_map(const struct gm_grid *grid, const struct gm_grid_line *line, struct gm_picture *picture)
{
    const struct gm_grid_axis *steps = &grid->steps, *values = &grid->values;
    const bool logarithmic = grid->parameter->logarithmic;
    double x[MOST_EDGES + 1], y[MOST_EDGES + 1];
    const struct gm_axis across =
        gm_chart_edges(grid->parameter->key, values->values, values->count, logarithmic, x);
    const struct gm_axis up = gm_chart_edges(grid->plan->label, steps->values, steps->count, true, y);
    struct gm_panel *panel = gm_chart_panel(picture, GM_PLACE_STATE, line->scheme->title, &across, &up);
    const double limit = gm_stability_limit(grid, line);
    panel->note = limit > 0 ? gm_picture_text(picture, "%s up to %.3g", gm_stability_judge(grid), limit) : "";
    for (size_t s = 0; s < steps->count; s++) {
        for (size_t v = 0; v < values->count; v++) {
            const struct gm_grid_cell *cell = &line->cells[s * values->count + v];
            const double corners[] = {x[v], y[s], x[v + 1], y[s], x[v + 1], y[s + 1], x[v], y[s + 1]};
            gm_mark_polygon(picture, panel, style_of(cell), corners, 4);
        }
    }
    /* one letter for all that end alike, above one another */
    for (size_t v = 0; v < values->count; v++) {
        size_t next = 0;
        for (size_t s = 0; s < steps->count; s = next) {
            const char letter = gm_cell_letter(&line->cells[s * values->count + v]);
            for (next = s + 1; next < steps->count; next++) {
                if (gm_cell_letter(&line->cells[next * values->count + v]) != letter) {
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

void gm_stability_draw(const struct gm_grid *grid, struct gm_picture *picture)
{
    const struct gm_timing *timing = grid->request.lanes[0].parameters;
    char letters[128], question[GM_TEXT_SIZE];
    picture->title = gm_picture_text(picture, "%s: which step is %s", grid->request.scene->title,
                                     gm_stability_question(grid, question, sizeof question));
    picture->subtitle = gm_picture_text(picture, "up: %s;  after t = %s", grid->plan->label,
                                        gm_step_text(picture, timing->until));
    gm_stability_letters(grid, letters, sizeof letters);
    picture->caption = gm_picture_text(picture, "Without a letter: %s.  %s%s", gm_stability_judge(grid),
                                       letters, letters[0] ? "." : "");
    picture->clock = "";
    for (size_t i = 0; i < grid->count; i++) {
        draw_map(grid, &grid->lines[i], picture);
    }
}
