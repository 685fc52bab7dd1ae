/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/functions/functions.h"
#include "scenes/field/frames.h"

#include <math.h>
#include <string.h>

enum {
    DRAWN = 1600 /* most points of a profile */,
    EXACT = 600,
    TOLD = 60 /* most nodes that are seen apart */
};

static double lambda_of(const struct gm_lane *lane)
{
    return gm_framed_of(&lane->problem)->lambda;
}

/* Draws the nodes inside the panel, in the original frame; as points too if `apart` and they are few. */
static void draw_profile(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                         const struct gm_field_look *look, bool apart)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_grid1 *grid = &view.problem->line;
    const size_t stride = (grid->points + DRAWN - 1) / DRAWN;
    const double reach = (double)stride * grid->dx, travelled = gm_frame_travel(&view);
    struct gm_style style = gm_lane_style(lane, lane->run->status != GM_OK ? 0.55 : 1, 2.2);
    double *points = gm_picture_memory(picture, 2 * (DRAWN + 1) * sizeof *points);
    size_t count = 0;
    for (size_t j = 0; j < grid->points; j += stride) {
        const double x = gm_grid1_node(grid, j) - travelled;
        if (x > panel->x.low - reach && x < panel->x.high + reach) {
            points[2 * count] = x;
            points[2 * count + 1] = look->value(&view, j);
            count++;
        }
    }
    gm_mark_line(picture, panel, style, points, count, false);
    if (apart && count < TOLD) {
        style.width = 5;
        gm_mark_points(picture, panel, style, points, count);
    }
}

/* Draws the exact profile at the view's time in the original frame. */
static void draw_exact(struct gm_picture *picture, struct gm_panel *panel, const struct gm_view *view,
                       const struct gm_field_look *look, struct gm_style style)
{
    double *points = gm_picture_memory(picture, 2 * EXACT * sizeof *points);
    for (size_t i = 0; i < EXACT; i++) {
        points[2 * i] = panel->x.low + (panel->x.high - panel->x.low) * (double)i / (EXACT - 1);
        points[2 * i + 1] = look->exact(view, points[2 * i]);
    }
    gm_mark_line(picture, panel, style, points, EXACT, false);
}

static void draw_panels(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        const struct gm_field_look *look)
{
    struct gm_panel *panel = NULL;
    bool alone = false;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        if (walk.first) {
            const struct gm_view view = gm_lane_view(walk.lane);
            struct gm_view before = view;
            before.t = view.t0;
            alone = gm_lane_is_alone(lanes, count, walk.lane);
            panel = gm_walk_panel(picture, &walk, "");
            panel->axes = true;
            panel->x = (struct gm_axis){.label = "x", .low = -look->reach, .high = look->reach};
            panel->y = (struct gm_axis){.label = "", .low = look->low, .high = look->high};
            if (look->exact) {
                draw_exact(picture, panel, &before, look, (struct gm_style){GM_INITIAL, 0.5, 1.2, GM_SOLID});
                draw_exact(picture, panel, &view, look, (struct gm_style){GM_EXACT, 0.8, 4, GM_SOLID});
            }
        }
        draw_profile(picture, panel, walk.lane, look, alone);
    }
}

/* Returns true if the lanes are several schemes in several frames each, with no other difference. */
static bool go_over_frames(const struct gm_lane *const *lanes, size_t count)
{
    size_t schemes = 1, frames = 1;
    for (size_t i = 1; i < count; i++) {
        bool new_scheme = true, new_frame = true;
        for (size_t k = 0; k < i; k++) {
            const bool same = lanes[k]->scheme == lanes[i]->scheme,
                       rests = lambda_of(lanes[k]) == lambda_of(lanes[i]);
            if (same && rests) {
                return false;
            }
            new_scheme &= !same;
            new_frame &= !rests;
        }
        schemes += new_scheme;
        frames += new_frame;
    }
    return schemes > 1 && frames > 1;
}

/* Returns the largest value of an observable so far; infinite if the lane failed. */
static double largest(const struct gm_lane *lane, size_t series)
{
    double most = 0;
    for (size_t b = 0; b < lane->history.count; b++) {
        most = fmax(most, lane->history.bins[b * lane->history.series + series].high);
    }
    return lane->run->status == GM_OK ? most : INFINITY;
}

static bool has_values(const struct gm_lane *const *lanes, size_t count, const char *observable)
{
    const int series = gm_scene_observable(lanes[0]->scene, observable);
    bool any = false;
    for (size_t i = 0; i < count; i++) {
        any |= series >= 0 && (lambda_of(lanes[i]) != 0 || largest(lanes[i], (size_t)series) > 0);
    }
    return any;
}

/* One scheme's values over the velocity of the frame. */
struct curve {
    const struct gm_scheme *scheme;
    double end[2]; /* the position of its name: its last point, or its exit from the panel */
    double at;     /* height of the name, in logarithms */
    enum gm_role role;
};

/* Draws the curve of the scheme; false if no point of it is in the panel. */
static bool draw_curve(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *const *lanes,
                       size_t count, size_t series, struct curve *curve, double *points)
{
    size_t made = 0;
    bool one_colour = true, left = false;
    const struct gm_lane *first = NULL;
    for (;;) {
        /* the frames in order of velocity */
        const struct gm_lane *next = NULL;
        for (size_t i = 0; i < count; i++) {
            const double lambda = lambda_of(lanes[i]);
            if (lanes[i]->scheme == curve->scheme && (made == 0 || lambda > points[2 * made - 2]) &&
                (!next || lambda < lambda_of(next))) {
                next = lanes[i];
            }
        }
        if (!next) {
            break;
        }
        first = first ? first : next;
        one_colour &= next->shown.colour == first->shown.colour;
        points[2 * made] = lambda_of(next);
        points[2 * made + 1] = fmin(largest(next, series), 1e3 * panel->y.high);
        made++;
    }
    struct gm_style style = {GM_SECONDARY, 0.7, 1.6, GM_SOLID};
    if (one_colour) {
        style = gm_lane_style(first, 1, 2.2);
    }
    curve->role = one_colour ? style.role : GM_INK;
    for (size_t k = 0; k < made; k++) {
        const double *point = &points[2 * k];
        const double *before = k > 0 ? point - 2 : NULL;
        const bool inside = point[1] <= panel->y.high;
        if (!inside && before && before[1] > 0 && before[1] <= panel->y.high) {
            /* the line ends at the upper edge: the scheme fails there */
            const double part = gm_log(panel->y.high / before[1]) / gm_log(point[1] / before[1]);
            const double line[] = {before[0], before[1], before[0] + part * (point[0] - before[0]),
                                   panel->y.high};
            gm_mark_line(picture, panel, style, line, 2, false);
            memcpy(curve->end, line + 2, sizeof curve->end);
            left = true;
        } else if (inside && before && before[1] <= panel->y.high) {
            gm_mark_line(picture, panel, style, before, 2, false);
        }
    }
    bool any = left;
    for (size_t i = 0; i < count; i++) {
        const double value = largest(lanes[i], series);
        if (lanes[i]->scheme == curve->scheme && value > 0 && value <= panel->y.high) {
            const double point[] = {lambda_of(lanes[i]), value};
            const enum gm_role role = gm_lane_role(lanes[i]->shown.colour);
            gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 1, .width = 7}, point, 1);
            if (!left && (!any || point[0] > curve->end[0])) {
                memcpy(curve->end, point, sizeof point);
            }
            any = true;
        }
    }
    return any;
}

/* Moves overlapping names apart: names at the same end from the top down, then those below the axis
   upwards. */
static void part_names(struct curve *curves, size_t count, double low, double high, double line)
{
    for (size_t i = 1; i < count; i++) { /* sorted by falling height */
        for (size_t k = i; k > 0 && curves[k].at > curves[k - 1].at; k--) {
            const struct curve higher = curves[k];
            curves[k] = curves[k - 1];
            curves[k - 1] = higher;
        }
    }
    for (size_t i = 0; i < count; i++) {
        curves[i].at = fmin(curves[i].at, high - line / 2);
        for (size_t k = 0; k < i; k++) {
            if (curves[k].at - curves[i].at < line) {
                curves[i].at = curves[k].at - line;
            }
        }
    }
    double floor = low + line / 2;
    for (size_t i = count; i-- > 0 && curves[i].at < floor; floor += line) {
        curves[i].at = floor;
    }
}

static void draw_over_frames(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                             const struct gm_graph *graph)
{
    double low = graph->calm_low, high = graph->calm_high;
    struct curve *curves = gm_picture_memory(picture, count * sizeof *curves);
    double *points = gm_picture_memory(picture, 2 * count * sizeof *points);
    const int asked = gm_asked_series(picture, lanes[0]->scene, graph->observable);
    if (asked < 0) {
        return;
    }
    const size_t series = (size_t)asked;
    const struct gm_observable *observable = gm_scene_observable_at(lanes[0]->scene, series);
    size_t made = 0;
    double least = INFINITY, most = -INFINITY;
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_GRAPH,
                                          gm_picture_text(picture, "%s so far, over λ", observable->title));
    for (size_t i = 0; i < count; i++) {
        const double value = largest(lanes[i], series);
        least = fmin(least, lambda_of(lanes[i]));
        most = fmax(most, lambda_of(lanes[i]));
        if (value > 0) { /* a value that has blown up is shown in part */
            gm_range_add(&low, &high, fmin(value, 10));
        }
    }
    gm_range_round(&low, &high, GM_LOG);
    panel->axes = true;
    /* space for the names after the last point */
    panel->x = (struct gm_axis){.label = "λ", .low = least, .high = most + 1.25 * (most - least)};
    panel->y = (struct gm_axis){.label = "", .scale = GM_LOG, .low = low, .high = high};
    for (size_t i = 0; curves && points && i < count; i++) {
        bool seen = false;
        for (size_t k = 0; k < i; k++) {
            seen |= lanes[k]->scheme == lanes[i]->scheme;
        }
        curves[made] = (struct curve){.scheme = lanes[i]->scheme};
        if (!seen && draw_curve(picture, panel, lanes, count, series, &curves[made], points)) {
            curves[made].at = gm_log(curves[made].end[1]);
            made++;
        }
    }
    part_names(curves, made, gm_log(low), gm_log(high), 0.13 * gm_log(high / low));
    for (size_t i = 0; i < made; i++) {
        gm_mark_text(picture, panel, (struct gm_style){.role = curves[i].role, .alpha = 1, .width = 1},
                     curves[i].end[0] + 0.03 * (panel->x.high - panel->x.low), gm_exp(curves[i].at),
                     GM_ANCHOR_LEFT, curves[i].scheme->title);
    }
}

void gm_draw_profiles(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                      const struct gm_field_look *look, const struct gm_graph *graphs, size_t graph_count)
{
    const size_t panels = gm_panel_count(lanes, count);
    picture->state_columns = panels > 4 ? 3 : 0;
    picture->graphs_below = panels <= 3;
    gm_draw_clock(picture, lanes, count);
    draw_panels(picture, lanes, count, look);
    for (size_t i = 0; i < graph_count; i++) {
        if (go_over_frames(lanes, count)) {
            draw_over_frames(picture, lanes, count, &graphs[i]);
        } else if (has_values(lanes, count, graphs[i].observable)) {
            gm_draw_graphs(picture, lanes, count, &graphs[i], 1);
        }
    }
}
