/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of Burgers' equation: the profiles, drawn at rest, and their errors over time; for several
   schemes in several frames, over the velocity of the frame. */
#include <math.h>
#include <string.h>

#include "scenes/common/graph.h"
#include "scenes/field/burgers_draw.h"

enum { DRAWN = 1600 /* most points of a profile */, TOLD = 60 /* most nodes that are seen apart */ };

static double lambda_of(const struct gm_lane *lane)
{
    return gm_burgers_of(&lane->problem)->lambda;
}

/* Writes the nodes inside the panel, in the original frame: at most DRAWN and a little more. Returns their
   number. */
static size_t profile(const struct gm_panel *panel, const struct gm_view *view, double *points)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const struct gm_burgers *burgers = gm_burgers_of(view->problem);
    const double travelled =
        gm_burgers_fixed(burgers, view->scheme) ? burgers->lambda * (view->t - view->t0) : 0;
    const size_t stride = (grid->points + DRAWN - 1) / DRAWN;
    size_t count = 0;
    for (size_t j = 0; j < grid->points; j += stride) {
        const double x = gm_grid1_node(grid, j) - travelled, reach = (double)stride * grid->dx;
        if (x > panel->x.low - reach && x < panel->x.high + reach) {
            points[2 * count] = x;
            points[2 * count + 1] = view->state[j] - burgers->lambda;
            count++;
        }
    }
    return count;
}

/* Draws the exact profile at the view's time in the original frame. */
static void draw_exact(struct gm_picture *picture, struct gm_panel *panel, const struct gm_view *view,
                       struct gm_style style, double *points)
{
    struct gm_burgers burgers = *gm_burgers_of(view->problem);
    burgers.lambda = 0;
    for (size_t i = 0; i < DRAWN; i++) {
        points[2 * i] = panel->x.low + (panel->x.high - panel->x.low) * (double)i / (DRAWN - 1);
        points[2 * i + 1] = gm_burgers_exact(&burgers, true, points[2 * i], view->t);
    }
    gm_mark_line(picture, panel, style, points, DRAWN, false);
}

static struct gm_panel *add_panel(struct gm_picture *picture, const struct gm_lane *lane, bool alone)
{
    const struct gm_burgers_scene *scene = lane->parameters;
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, gm_lane_title(lane));
    const double reach = scene->burgers.test == GM_BURGERS_SHOCK ? 1 : 0.25;
    panel->axes = true;
    panel->title_role = alone ? gm_lane_role(lane->shown.colour) : GM_INK;
    panel->x = (struct gm_axis){.label = "x", .low = -reach, .high = reach};
    panel->y = (struct gm_axis){.label = "", .low = -1.6, .high = 1.6};
    panel->note = alone ? gm_lane_failure(picture, lane) : "";
    return panel;
}

/* Names a lane of several under the panel's title; the first panel has the names of all. */
static void name_lane(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                      bool first)
{
    const char *name = lane->shown.colour_name, *failure = gm_lane_failure(picture, lane);
    if (first || failure[0]) {
        gm_panel_key(picture, panel, gm_lane_style(lane, 1, 2.2),
                     failure[0] ? gm_picture_text(picture, "%s, %s", name, failure) : name);
    }
}

static size_t count_in_panel(const struct gm_lane *const *lanes, size_t count, size_t panel)
{
    size_t sharing = 0;
    for (size_t i = 0; i < count; i++) {
        sharing += lanes[i]->shown.panel == panel;
    }
    return sharing;
}

static void draw_panels(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        double *points)
{
    struct gm_panel *panel = NULL;
    size_t sharing = 0;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        const struct gm_lane *lane = walk.lane;
        const struct gm_view view = gm_lane_view(lane);
        if (walk.first) {
            sharing = count_in_panel(lanes, count, walk.panel);
            panel = add_panel(picture, lane, sharing == 1);
            struct gm_view before = view;
            before.t = view.t0;
            before.state = view.start;
            draw_exact(picture, panel, &before, (struct gm_style){GM_INITIAL, 0.5, 1.2, GM_SOLID}, points);
            draw_exact(picture, panel, &view, (struct gm_style){GM_EXACT, 0.8, 4, GM_SOLID}, points);
        }
        const size_t made = profile(panel, &view, points);
        struct gm_style style = gm_lane_style(lane, lane->run->status != GM_OK ? 0.55 : 1, 2.2);
        gm_mark_line(picture, panel, style, points, made, false);
        if (sharing == 1 && made < TOLD) {
            style.width = 5;
            gm_mark_points(picture, panel, style, points, made);
        }
        if (sharing > 1) {
            name_lane(picture, panel, lane, walk.panel == 0);
        }
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
            const double part = log(panel->y.high / before[1]) / log(point[1] / before[1]);
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
                             const char *observable, const char *title, double low, double high)
{
    struct curve *curves = gm_picture_memory(picture, count * sizeof *curves);
    double *points = gm_picture_memory(picture, 2 * count * sizeof *points);
    const int asked = gm_asked_series(picture, lanes[0]->scene, observable);
    if (asked < 0) {
        return;
    }
    const size_t series = (size_t)asked;
    size_t made = 0;
    double least = INFINITY, most = -INFINITY;
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_GRAPH, title);
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
    panel->title_role = GM_INK;
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
            curves[made].at = log(curves[made].end[1]);
            made++;
        }
    }
    part_names(curves, made, log(low), log(high), 0.13 * log(high / low));
    for (size_t i = 0; i < made; i++) {
        gm_mark_text(picture, panel, (struct gm_style){.role = curves[i].role, .alpha = 1, .width = 1},
                     curves[i].end[0] + 0.03 * (panel->x.high - panel->x.low), exp(curves[i].at),
                     GM_ANCHOR_LEFT, curves[i].scheme->title);
    }
}

static void draw_graphs(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        bool boosted)
{
    if (go_over_frames(lanes, count)) {
        draw_over_frames(picture, lanes, count, "sup_error", "largest error so far, over λ", 1e-2, 1);
        draw_over_frames(picture, lanes, count, "galilean_defect", "difference from the run at λ = 0", 1e-16,
                         1e3);
        return;
    }
    const struct gm_graph error = {
        .observable = "sup_error", .scale = GM_LOG, .calm_low = 1e-2, .calm_high = 1};
    const struct gm_graph defect = {
        .observable = "galilean_defect", .scale = GM_LOG, .calm_low = 1e-16, .calm_high = 1};
    gm_draw_graphs(picture, lanes, count, &error, 1);
    if (boosted) {
        gm_draw_graphs(picture, lanes, count, &defect, 1);
    }
}

/* Returns the moving frame at a node, also of schemes that rest in a frame. */
static struct gm_moving_frame moving_frame(const struct gm_lane *lane)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_burgers_scene *scene = lane->parameters;
    const struct gm_grid1 *grid = &view.problem->line;
    const bool fixed = gm_burgers_fixed(&scene->burgers, view.scheme);
    const double lambda = scene->burgers.lambda, k = view.dt, sigma = fixed ? 0 : lambda * k;
    const size_t j = gm_stencil_node(grid, scene->at + (fixed ? lambda * (view.t - view.t0) : 0));
    const struct gm_burgers_symmetry frame =
        gm_burgers_frame(view.scheme, &scene->burgers, grid->dx, view.state + j - 1);
    struct gm_moving_frame made = {.known = frame.a4 * k < 1};
    for (size_t e = 0; made.known && e < 2 * GM_STENCIL; e++) {
        const size_t i = j + e % GM_STENCIL - GM_STENCIL / 2;
        const bool next = e >= GM_STENCIL;
        made.seen[e] = (struct gm_event){.t = next ? k : 0,
                                         .x = ((double)i - (double)j) * grid->dx + (next ? sigma : 0),
                                         .u = view.state[i]};
        made.carried[e] = gm_burgers_carried(&frame, made.seen[e]);
    }
    return made;
}

static void draw_frame(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    const struct gm_burgers_scene *scene = lanes[0]->parameters;
    struct gm_moving_frame *made = gm_picture_memory(picture, count * sizeof *made);
    for (size_t i = 0; made && i < count; i++) {
        made[i] = moving_frame(lanes[i]);
    }
    picture->title = "The moving frame at a node of Burgers' equation";
    picture->subtitle =
        gm_picture_text(picture, "the node nearest to x = %g,  ν = %g,  h = %g,  k = %s", scene->at,
                        scene->burgers.viscosity, scene->dx, gm_step_text(picture, lanes[0]->run->dt));
    const struct gm_burgers_row *row = lanes[0]->scheme->coefficients;
    const struct gm_axes_style look = {
        .h = scene->dx,
        .k = lanes[0]->run->dt,
        .value = "u",
        .carried = "û",
        .section = row->family ? "a ûⱼ₊₁ + (1 + a) ûⱼ₋₁ = (1 + 2a) ûⱼ,  ûⱼ = d h² D₂û" : "ûⱼ = 0,  D₀û = 0"};
    if (made) {
        gm_draw_moving_frame(picture, lanes, count, made, &look);
    }
}

void gm_burgers_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_burgers_scene *scene = lanes[0]->parameters;
    if (scene->show == GM_FRAME_SHOWN) {
        gm_draw_clock(picture, lanes, count);
        draw_frame(picture, lanes, count);
        return;
    }
    const size_t panels = gm_panel_count(lanes, count);
    double *points = gm_picture_memory(picture, 2 * (DRAWN + 3) * sizeof *points);
    if (!points) {
        return;
    }
    bool boosted = false;
    for (size_t i = 0; i < count; i++) {
        boosted |= lambda_of(lanes[i]) != 0;
    }
    picture->title = scene->burgers.test == GM_BURGERS_SHOCK ? "A viscous shock of Burgers' equation"
                     : boosted ? "Burgers' front from moving frames, drawn at rest"
                               : "A front of Burgers' equation";
    picture->subtitle = gm_picture_text(
        picture, "ν = %g,  Δx = %g,  Courant number %.4g,  exact solution in grey, start in red",
        scene->burgers.viscosity, scene->dx, lanes[0]->run->dt / scene->dx);
    picture->state_columns = scene->burgers.test == GM_BURGERS_FRONT && panels > 4 ? 3 : 0;
    picture->graphs_below = panels <= 3;
    gm_draw_clock(picture, lanes, count);
    draw_panels(picture, lanes, count, points);
    draw_graphs(picture, lanes, count, boosted);
}
