/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of fields on a line: the profiles now over the exact one, and every lane's field so far as a
   surface over space and time. */
#include "scenes/field/field.h"

#include <math.h>

enum { DRAWN = 1600 /* most points of a profile */ };

double gm_field_u(const struct gm_view *view, size_t node)
{
    return view->state[node];
}

static double end_of(const struct gm_grid1 *grid)
{
    return grid->first + grid->dx * (double)(grid->walls ? grid->points / 2 : grid->points);
}

static const char *law_name(const struct gm_field_look *look)
{
    const char *const names[] = {"energy", "momentum", look->content};
    return names[look->show - 1];
}

/* Returns true if the surface over space and time has values. */
static bool has_surface(const struct gm_lane *lane)
{
    const struct gm_entries *rows = &lane->entries[0];
    return rows->count > 0 && !isnan(rows->values[0]);
}

/* Returns the colours of a law's residuals, symmetric, up to the largest of this lane. Residuals differ by
   orders from scheme to scheme; on a common scale the small ones would be blank. */
static struct gm_field_look look_of_law(struct gm_picture *picture, const struct gm_lane *lane,
                                        const struct gm_field_look *look)
{
    double low = 0, high = 1e-16;
    const struct gm_entries *rows = &lane->entries[0];
    for (size_t k = 0; has_surface(lane) && k < rows->count * rows->width; k++) {
        high = fmax(high, fabs(rows->values[k]));
    }
    gm_range_round(&low, &high, GM_LINEAR);
    struct gm_field_look field_look = *look;
    field_look.name = gm_picture_text(picture, "residual of the local %s law", law_name(look));
    field_look.low = -high;
    field_look.high = high;
    field_look.map = GM_MAP_DIVERGING;
    return field_look;
}

/* Draws a panel for every lane: the surface so far. */
static void draw_surfaces(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                          const struct gm_field_look *shown)
{
    const bool law = shown->show != GM_SHOW_FIELD;
    for (size_t i = 0; i < count; i++) {
        const struct gm_lane *lane = lanes[i];
        const struct gm_field_look field_look = law ? look_of_law(picture, lane, shown) : *shown,
                                   *look = &field_look;
        const struct gm_entries *rows = &lane->entries[0];
        const struct gm_timing *timing = lane->parameters;
        const struct gm_grid1 *grid = &lane->problem.line;
        const char *name =
            lane->shown.colour_name[0]
                ? gm_picture_text(picture, "%s, %s", gm_lane_title(lane), lane->shown.colour_name)
                : gm_lane_title(lane);
        struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, name);
        panel->axes = true;
        panel->title_role = gm_lane_role(lane->shown.colour);
        panel->x = (struct gm_axis){.label = "x", .low = grid->first, .high = end_of(grid)};
        panel->y = (struct gm_axis){.label = "t", .low = lane->t0, .high = fmax(timing->until, lane->run->t)};
        if (!(panel->y.high > panel->y.low)) {
            panel->y.high = panel->y.low + 1;
        }
        panel->note = gm_lane_failure(picture, lane);
        if (!has_surface(lane)) {
            if (!panel->note[0] && rows->count > 0) {
                /* the note is in the empty surface: small pictures have no other line for it */
                gm_mark_text(picture, panel, (struct gm_style){.role = GM_SECONDARY, .alpha = 1},
                             (panel->x.low + panel->x.high) / 2, (panel->y.low + panel->y.high) / 2,
                             GM_ANCHOR_CENTRE, "the scheme has no such law");
            }
            continue;
        }
        panel->colour_bar = law || i + 1 == count;
        panel->colour_bar_label = look->name;
        /* the start is seen as a thin strip */
        const double thin = (panel->y.high - panel->y.low) / 200;
        const double reached = rows->times[rows->count - 1];
        const double corners[] = {grid->first, lane->t0, end_of(grid),
                                  reached > lane->t0 ? reached : lane->t0 + thin};
        gm_mark_image(picture, panel, look->map, look->low, look->high, corners, rows->values, rows->count,
                      rows->width);
        gm_mark_switches(picture, panel, lane, true);
    }
}

static void hold(struct gm_axis *axis, const double *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        gm_range_add(&axis->low, &axis->high, points[2 * i + 1]);
    }
}

/* The profile of a lane, closed by its first point a period later. */
static size_t profile(const struct gm_lane *lane, const struct gm_field_look *look, double *points)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_grid1 *grid = &lane->problem.line;
    const size_t seen = gm_grid1_seen(grid), stride = (seen + DRAWN - 1) / DRAWN;
    size_t count = 0;
    for (size_t i = 0; i < seen; i += stride, count++) {
        points[2 * count] = grid->first + grid->dx * (double)i;
        points[2 * count + 1] = look->value(&view, i);
    }
    return count;
}

static size_t exact_profile(const struct gm_lane *lane, const struct gm_field_look *look, double *points)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_grid1 *grid = &lane->problem.line;
    const size_t count = 800;
    for (size_t i = 0; i < count; i++) {
        points[2 * i] = grid->first + (end_of(grid) - grid->first) * (double)i / (double)count;
        points[2 * i + 1] = look->exact(&view, points[2 * i]);
    }
    return count;
}

/* Returns the lane whose time the clock shows. */
static const struct gm_lane *farthest(const struct gm_lane *const *lanes, size_t count)
{
    const struct gm_lane *ahead = lanes[0];
    for (size_t i = 1; i < count; i++) {
        ahead = lanes[i]->run->t > ahead->run->t ? lanes[i] : ahead;
    }
    return ahead;
}

/* Returns true if a profile goes far beyond the least range. Others then have the graph first. */
static bool is_wild(const struct gm_field_look *look, const double *points, size_t count)
{
    const double most = 0.5 * (look->high - look->low);
    bool wild = false;
    for (size_t i = 0; i < count; i++) {
        const double value = points[2 * i + 1];
        wild |= !(value >= look->low - most && value <= look->high + most);
    }
    return wild;
}

/* Draws a profile that jumps from point to point as the band that it sweeps: its line would hide all
   others. */
static void draw_band(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                      const double *points, size_t count)
{
    enum { PLACES = 160 };
    double band[4 * PLACES];
    const size_t places = count / 2 < PLACES ? count / 2 : PLACES;
    for (size_t p = 0; p < places; p++) {
        const size_t first = p * (count - 1) / places, last = (p + 1) * (count - 1) / places;
        double low = INFINITY, high = -INFINITY;
        for (size_t i = first; i <= last; i++) {
            gm_range_add(&low, &high, points[2 * i + 1]);
        }
        const double x = 0.5 * (points[2 * first] + points[2 * last]);
        double *above = &band[2 * p], *below = &band[2 * (2 * places - 1 - p)];
        above[0] = below[0] = x;
        above[1] = fmin(high, panel->y.high);
        below[1] = fmax(low, panel->y.low);
    }
    gm_mark_polygon(picture, panel, style, band, 2 * places);
}

/* Draws one graph: the current profiles of all lanes, over the exact one. A lane that froze is left out. */
static void draw_profiles(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                          const struct gm_field_look *look)
{
    const struct gm_lane *ahead = farthest(lanes, count);
    const struct gm_grid1 *grid = &ahead->problem.line;
    double *points = gm_picture_memory(picture, 2 * (DRAWN + 1) * sizeof *points);
    if (!points) {
        return;
    }
    struct gm_panel *panel =
        gm_panel_add(picture, GM_PLACE_GRAPH,
                     gm_picture_text(picture, "%s at t = %s%s", look->name,
                                     gm_time_text(picture, ahead->run->t, ahead->run->dt),
                                     look->exact ? ", exact in grey" : ""));
    panel->axes = true;
    panel->title_role = GM_INK;
    panel->x = (struct gm_axis){.label = "x", .low = grid->first, .high = end_of(grid)};
    panel->y = (struct gm_axis){.label = "", .low = look->low, .high = look->high};
    const double most = 0.5 * (look->high - look->low);
    for (size_t i = 0; i < count; i++) {
        if (lanes[i]->run->status == GM_OK || lanes[i] == ahead) {
            hold(&panel->y, points, profile(lanes[i], look, points));
        }
    }
    /* a profile far outside is shown in part, so that it does not flatten the others */
    panel->y.low = fmax(panel->y.low, look->low - most);
    panel->y.high = fmin(panel->y.high, look->high + most);
    gm_range_round(&panel->y.low, &panel->y.high, GM_LINEAR);
    if (look->exact) {
        const size_t made = exact_profile(ahead, look, points);
        gm_mark_line(picture, panel, (struct gm_style){GM_EXACT, 0.9, 4, GM_SOLID}, points, made, false);
    }
    for (int tame = 0; tame <= 1; tame++) {
        for (size_t i = 0; i < count; i++) {
            const size_t made = profile(lanes[i], look, points);
            const bool here = lanes[i]->run->status == GM_OK || lanes[i] == ahead;
            if (here && !is_wild(look, points, made) == tame) {
                if (tame) {
                    gm_mark_line(picture, panel, gm_lane_style(lanes[i], 1, 2), points, made, false);
                } else {
                    draw_band(picture, panel, gm_lane_style(lanes[i], 0.3, 1), points, made);
                }
            }
        }
    }
}

void gm_draw_field(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                   const struct gm_field_look *look, const struct gm_graph *graphs, size_t graph_count)
{
    picture->graphs_below = true;
    gm_draw_clock(picture, lanes, count);
    draw_surfaces(picture, lanes, count, look);
    if (look->show == GM_SHOW_FIELD) {
        draw_profiles(picture, lanes, count, look);
        gm_draw_graphs(picture, lanes, count, graphs, graph_count);
        return;
    }
    const struct gm_graph residual = {
        .observable = gm_picture_text(picture, "local_%s_residual", law_name(look)),
        .highest = true,
        .scale = GM_LOG,
        .calm_low = 1e-16,
        .calm_high = 1e-2,
    };
    draw_profiles(picture, lanes, count, look);
    gm_draw_graphs(picture, lanes, count, graphs, 1);
    gm_draw_graphs(picture, lanes, count, &residual, 1);
}

const char *gm_shared_step(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    return gm_one_step(lanes, count)
               ? gm_picture_text(picture, ",  Δt = %s", gm_step_text(picture, lanes[0]->run->dt))
               : "";
}
