/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Panels, lines and cells of the pictures of grids. */
#include "app/grid/grid.h"

#include <math.h>

struct gm_panel *gm_chart_panel(struct gm_picture *picture, enum gm_place place, const char *title,
                                const struct gm_axis *x, const struct gm_axis *y)
{
    struct gm_panel *panel = gm_panel_add(picture, place, title);
    panel->axes = true;
    panel->title_role = GM_INK;
    panel->x = *x;
    panel->y = *y;
    return panel;
}

struct gm_style gm_chart_style(size_t index)
{
    return (struct gm_style){gm_lane_role(index), 1, 2.4, gm_lane_dash(index)};
}

void gm_chart_line(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                   const double *points, size_t count, const char *name)
{
    if (count > 0) {
        gm_mark_line(picture, panel, style, points, count, false);
        gm_mark_points(picture, panel, (struct gm_style){.role = style.role, .alpha = 1, .width = 6}, points,
                       count);
        gm_panel_key(picture, panel, style, name);
    }
}

static double on_scale(double value, bool logarithmic)
{
    return logarithmic ? log(value) : value;
}

struct gm_axis gm_chart_edges(const char *label, const double *values, size_t count, bool logarithmic,
                              double *edges)
{
    const double start = on_scale(values[0], logarithmic), end = on_scale(values[count - 1], logarithmic);
    /* a single value has no neighbour that sets the width of its cell */
    const double first = count > 1 ? on_scale(values[1], logarithmic) - start : 1;
    const double last = count > 1 ? end - on_scale(values[count - 2], logarithmic) : 1;
    for (size_t i = 0; i <= count; i++) {
        const double before = i > 0 ? on_scale(values[i - 1], logarithmic) : start - first;
        const double after = i < count ? on_scale(values[i], logarithmic) : end + last;
        const double edge = (before + after) / 2;
        edges[i] = logarithmic ? exp(edge) : edge;
    }
    return (struct gm_axis){.label = label,
                            .scale = logarithmic ? GM_LOG : GM_LINEAR,
                            .low = edges[0],
                            .high = edges[count],
                            .least_tick = values[0],
                            .largest_tick = values[count - 1]};
}
