/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Backward error drawn: for every scheme the errors against dt, a line for every power after which H~ is cut
   off; and, of the first, against that power, a line for every dt. */
#include <math.h>

#include "app/grid/chart.h"
#include "app/grid/hooks.h"

static const char *const powers[GM_POWERS] = {"H", "to Δt", "to Δt²", "to Δt³", "to Δt⁴", "to Δt⁵", "to Δt⁶"};

/* What a logarithmic axis can show of an error. */
static bool is_drawn(const struct gm_grid_cell *cell, int k)
{
    return cell->tried && cell->errors[k] > 1e-18 && cell->errors[k] < 1e3;
}

static void range_of(const struct gm_grid *grid, struct gm_axis *steps, struct gm_axis *errors)
{
    *steps = (struct gm_axis){.label = "Δt", .scale = GM_LOG, .low = 1, .high = 0};
    *errors = (struct gm_axis){.label = "", .scale = GM_LOG, .low = 1, .high = 0};
    for (size_t i = 0; i < grid->count; i++) {
        const struct gm_grid_line *line = &grid->lines[i];
        for (size_t p = 0; p < line->count; p++) {
            for (int k = 0; k < GM_POWERS; k++) {
                if (line->shown[k] && is_drawn(&line->cells[p], k)) {
                    gm_range_add(&steps->low, &steps->high, line->cells[p].dt);
                    gm_range_add(&errors->low, &errors->high, line->cells[p].errors[k]);
                }
            }
        }
    }
    if (errors->low > errors->high) { /* there is nothing but round-off */
        *steps = (struct gm_axis){.label = "Δt", .scale = GM_LOG, .low = 0.1, .high = 1};
        errors->low = 1e-16;
        errors->high = 1;
    }
    steps->low /= 1.2;
    steps->high *= 1.2;
    gm_range_round(&errors->low, &errors->high, GM_LOG);
}

static void draw_line(const struct gm_grid_line *line, const struct gm_axis *steps,
                      const struct gm_axis *errors, struct gm_picture *picture, double *points)
{
    struct gm_panel *panel = gm_chart_panel(picture, GM_PLACE_STATE, line->scheme->title, steps, errors);
    if (line->reason[0]) {
        panel->note = gm_picture_text(picture, "%s", line->reason);
    }
    size_t colour = 0;
    for (int k = 0; k < GM_POWERS; k++) {
        size_t count = 0;
        for (size_t p = 0; p < line->count; p++) {
            if (is_drawn(&line->cells[p], k)) {
                points[2 * count] = line->cells[p].dt;
                points[2 * count + 1] = line->cells[p].errors[k];
                count++;
            }
        }
        if (line->shown[k]) {
            const struct gm_style ink = {GM_INK, 1, 2.4, GM_SOLID};
            gm_chart_line(picture, panel, k == 0 ? ink : gm_chart_style(colour++), points, count, powers[k]);
        }
    }
}

/* Against the power: where it is best to cut off. */
static void draw_cuts(const struct gm_grid_line *line, const struct gm_axis *errors,
                      struct gm_picture *picture, double *points)
{
    const struct gm_axis x = {.label = "cut off after this power of Δt", .low = 0, .high = GM_MODIFIED_POWER};
    struct gm_panel *panel =
        gm_chart_panel(picture, GM_PLACE_GRAPH,
                       gm_picture_text(picture, "%s: where to cut off", line->scheme->title), &x, errors);
    for (size_t p = 0; p < line->count && p < GM_LANE_COLOURS; p++) {
        size_t count = 0;
        for (int k = 0; k < GM_POWERS; k++) {
            if (line->shown[k] && is_drawn(&line->cells[p], k)) {
                points[2 * count] = k;
                points[2 * count + 1] = line->cells[p].errors[k];
                count++;
            }
        }
        gm_chart_line(picture, panel, gm_chart_style(p), points, count,
                      gm_step_text(picture, line->cells[p].dt));
    }
}

void gm_backward_draw(const struct gm_grid *grid, struct gm_picture *picture)
{
    const struct gm_timing *timing = grid->request.lanes[0].parameters;
    struct gm_axis steps, errors;
    range_of(grid, &steps, &errors);
    picture->title =
        gm_picture_text(picture, "%s: what the scheme really solves", grid->request.scene->title);
    picture->subtitle = gm_picture_text(picture, "errors of H + Δt H₁ + Δt² H₂ + …, cut off, up to t = %s",
                                        gm_step_text(picture, timing->until));
    picture->caption =
        "The steeper the line, the more of the modified Hamiltonian is taken: that one the scheme keeps.";
    picture->clock = "";
    picture->graphs_below = true;
    double *points = gm_picture_memory(picture, 2 * (grid->request.count + GM_POWERS) * sizeof *points);
    for (size_t i = 0; points && i < grid->count; i++) {
        draw_line(&grid->lines[i], &steps, &errors, picture, points);
    }
    size_t first = 0;
    while (first + 1 < grid->count && grid->lines[first].reason[0]) {
        first++;
    }
    if (points) {
        draw_cuts(&grid->lines[first], &errors, picture, points);
    }
}
