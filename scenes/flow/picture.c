/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of flows: a field of colours, streamlines as level lines of the stream function (the very paths of
   the discrete velocity), tracers with short tails, the walls, and graphs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/common/graph.h"
#include "scenes/flow/picture.h"

enum { SMOOTH = 4000 /* triangles */, MOST_BESIDE_GRAPHS = 4 };

static const struct gm_flow *flow_of(const struct gm_lane *lane)
{
    return gm_flow_of(&lane->problem);
}

/* Returns the field that is shown, at the vertices; may be NULL. */
static const double *field_of(struct gm_picture *picture, const struct gm_lane *lane)
{
    const struct gm_flows *flows = lane->parameters;
    const struct gm_flow *flow = flow_of(lane);
    const struct gm_complex *complex = flow->complex;
    const double *y = gm_run_state(lane->run);
    const size_t n = complex->vertices;
    if (flows->show == GM_SHOW_SCALAR) {
        return gm_flow_block(flow, y, GM_FLOW_THETA);
    }
    if (flows->show == GM_SHOW_VORTICITY) {
        return gm_flow_block(flow, y, GM_FLOW_OMEGA);
    }
    if (flows->show == GM_SHOW_TEMPERATURE) {
        return flow->heat ? gm_flow_block(flow, y, GM_FLOW_TEMPERATURE) : NULL;
    }
    double *values = gm_picture_memory(picture, 3 * n * sizeof *values);
    double *scratch = gm_picture_memory(picture, 3 * n * sizeof *scratch);
    if (!values || !scratch) {
        return NULL;
    }
    if (flows->show == GM_SHOW_SPEED) {
        gm_flow_vertex_velocities(complex, y, scratch);
        for (size_t v = 0; v < n; v++) {
            values[v] = hypot(scratch[2 * v], scratch[2 * v + 1]);
        }
        return values;
    }
    double *pressure = gm_picture_memory(picture, complex->triangles * sizeof *pressure);
    if (flows->show != GM_SHOW_PRESSURE || !pressure || !gm_flow_pressure(flow, y, pressure)) {
        return NULL;
    }
    memset(values, 0, n * sizeof *values);
    memset(scratch, 0, n * sizeof *scratch);
    for (size_t k = 0; k < 3 * complex->triangles; k++) {
        values[complex->triangle[k]] += complex->area[k / 3] * pressure[k / 3];
        scratch[complex->triangle[k]] += complex->area[k / 3];
    }
    for (size_t v = 0; v < n; v++) {
        values[v] /= scratch[v];
    }
    return values;
}

/* Sets the ends of the colours, the same for all lanes. */
static void colour_range(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                         const struct gm_look *look, double *low, double *high)
{
    const struct gm_flows *flows = lanes[0]->parameters;
    *low = 0;
    *high = flows->show == GM_SHOW_SPEED ? look->speed_high : look->scalar_high;
    if (flows->show == GM_SHOW_TEMPERATURE) {
        *low = look->temperature[0];
        *high = look->temperature[1];
    }
    if (flows->show == GM_SHOW_VORTICITY) {
        *high = look->vorticity_range;
        *low = -*high;
    }
    if (flows->show == GM_SHOW_PRESSURE) {
        double lowest = 1, highest = 0;
        for (size_t i = 0; i < count; i++) {
            const double *values = field_of(picture, lanes[i]);
            for (size_t v = 0; values && v < flow_of(lanes[i])->complex->vertices; v++) {
                gm_range_add(&lowest, &highest, values[v]);
            }
        }
        gm_range_round(&lowest, &highest, GM_LINEAR);
        *high = fmax(fabs(lowest), fabs(highest));
        *low = -*high;
    }
}

static const char *title_of(struct gm_picture *picture, const struct gm_lane *lane)
{
    const char *colour = lane->shown.colour_name, *panel = gm_lane_title(lane);
    return colour[0] ? gm_picture_text(picture, "%s, %s", panel, colour) : panel;
}

static struct gm_panel *draw_state(struct gm_picture *picture, const struct gm_lane *lane,
                                   const struct gm_look *look, double low, double high, bool titled,
                                   bool named)
{
    const struct gm_flows *flows = lane->parameters;
    const struct gm_flow *flow = flow_of(lane);
    const struct gm_complex *complex = flow->complex;
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, titled ? title_of(picture, lane) : "");
    double box[4] = {INFINITY, -INFINITY, INFINITY, -INFINITY};
    for (size_t v = 0; v < complex->vertices; v++) {
        for (int c = 0; c < 2; c++) {
            box[2 * c] = fmin(box[2 * c], complex->point[2 * v + (size_t)c]);
            box[2 * c + 1] = fmax(box[2 * c + 1], complex->point[2 * v + (size_t)c]);
        }
    }
    for (int c = 0; c < 2; c++) {
        if (complex->period[c] > 0) {
            box[2 * c] = 0;
            box[2 * c + 1] = complex->period[c];
        }
    }
    const double size = fmax(box[1] - box[0], box[3] - box[2]),
                 edge = complex->boundary > 0 ? 0.006 * size : 0;
    const double beside = flow->inflow.count > 0 && named && !look->sides ? 0.15 * size : edge;
    /* names of openings are outside, and need their width in small pictures too */
    double aside[2] = {beside, beside};
    bool stands[2] = {false, false};
    for (size_t i = 0; named && i < flow->openings; i++) {
        double outward[2], middle[2];
        gm_flow_opening_outward(flow, &flow->opening[i], outward, middle);
        if (fabs(outward[0]) < fabs(outward[1])) {
            stands[outward[1] > 0] = true;
        } else if (look->sides) {
            const double letters = (double)strlen(look->sides[flow->opening[i].side]);
            double *room = &aside[outward[0] > 0];
            *room = fmax(*room, fmin(0.04 * letters, 0.3) * size);
        }
    }
    panel->x = (struct gm_axis){.label = "", .low = box[0] - aside[0], .high = box[1] + aside[1]};
    panel->y = (struct gm_axis){.label = "",
                                .low = box[2] - (stands[0] ? 0.06 * size : edge),
                                .high = box[3] + (stands[1] ? 0.06 * size : edge)};
    panel->equal = true;
    panel->axes = look->axes[0] && named;
    if (panel->axes) {
        panel->x.label = look->axes[0];
        panel->y.label = look->axes[1];
    }
    panel->note = gm_lane_failure(picture, lane);
    const bool coloured = flows->show <= GM_SHOW_PRESSURE || flows->show == GM_SHOW_TEMPERATURE,
               over = coloured && !gm_flow_is_signed(flows->show);
    const double *field = coloured ? field_of(picture, lane) : NULL;
    /* colours of fine meshes are smooth already, and four times the triangles cost three times the time */
    const bool plain = complex->boundary > 0 && complex->triangles > SMOOTH;
    struct gm_flow_sheet sheet;
    if (!gm_flow_sheet_make(picture, complex, gm_run_state(lane->run), plain ? NULL : field, &sheet)) {
        return panel;
    }
    if (field) {
        gm_mark_mesh(picture, panel, gm_flow_is_signed(flows->show) ? GM_MAP_DIVERGING : GM_MAP_SEQUENTIAL,
                     low, high, plain ? complex->point : sheet.points, plain ? field : sheet.field,
                     plain ? complex->vertices : sheet.vertices, plain ? complex->triangle : sheet.triangles,
                     plain ? complex->triangles : sheet.count);
        panel->colour_bar = true;
        panel->colour_bar_label = look->names[flows->show];
    }
    if (flows->grid) {
        gm_flow_draw_grid(picture, panel, complex, over);
    }
    if (flows->streamlines) {
        gm_flow_draw_streamlines(picture, panel, lane, &sheet, look);
    }
    if (flows->arrows) {
        gm_flow_draw_arrows(picture, panel, lane, over, look->speed_high);
    }
    gm_flow_draw_tracers(picture, panel, lane, over, size);
    gm_flow_draw_walls(picture, panel, flow);
    if (named) {
        gm_flow_name_openings(picture, panel, flow, look->sides, size);
    }
    return panel;
}

static bool is_common(const struct gm_lane *const *lanes, size_t count, size_t offset)
{
    bool common = true;
    for (size_t i = 1; i < count; i++) {
        common &= memcmp((const char *)lanes[0]->parameters + offset,
                         (const char *)lanes[i]->parameters + offset, sizeof(double)) == 0;
    }
    return common;
}

/* ", 2 % obtuse, circumcentric star ≥ 0.05" of a mesh from a file: its least entry. */
static const char *told_star(struct gm_picture *picture, const struct gm_lane *lane)
{
    const struct gm_complex *complex = flow_of(lane)->complex;
    const struct gm_flows *flows = lane->parameters;
    if (flows->mesh[0] == '\0' || strcmp(flows->mesh, "none") == 0) {
        return "";
    }
    const char *star = gm_flows_stars[complex->star];
    return complex->star == GM_STAR_CIRCUMCENTRIC
               ? gm_picture_text(picture, ", %.2g %% obtuse, %s star ≥ %.2g",
                                 100 * (double)complex->obtuse / (double)complex->triangles, star,
                                 complex->star_least)
               : gm_picture_text(picture, ", %.2g %% obtuse, %s star",
                                 100 * (double)complex->obtuse / (double)complex->triangles, star);
}

/* "6600 triangles,  semi-implicit"; the scheme if it is the same in all lanes */
static const char *mesh_and_scheme(struct gm_picture *picture, const struct gm_lane *const *lanes,
                                   size_t count)
{
    size_t fewest = flow_of(lanes[0])->complex->triangles, most = fewest;
    bool one_scheme = true;
    for (size_t i = 1; i < count; i++) {
        const size_t triangles = flow_of(lanes[i])->complex->triangles;
        fewest = triangles < fewest ? triangles : fewest;
        most = triangles > most ? triangles : most;
        one_scheme &= strcmp(lanes[i]->schemes, lanes[0]->schemes) == 0;
    }
    const char *mesh = fewest == most ? gm_picture_text(picture, "%zu triangles%s", most,
                                                        count == 1 ? told_star(picture, lanes[0]) : "")
                                      : gm_picture_text(picture, "%zu to %zu triangles", fewest, most);
    return one_scheme ? gm_picture_text(picture, "%s,  %s", mesh, lanes[0]->schemes) : mesh;
}

static const char *subtitle(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                            const struct gm_look *look)
{
    const char *told = "";
    for (size_t i = 0; i < GM_COUNT(look->told) && look->told[i].name; i++) {
        const size_t offset = look->told[i].offset;
        double value = 0;
        memcpy(&value, (const char *)lanes[0]->parameters + offset, sizeof value);
        if (is_common(lanes, count, offset) && !(look->told[i].nonzero && value == 0)) {
            const char *unit = look->told[i].unit ? look->told[i].unit : "";
            told = gm_picture_text(picture, "%s%s %.6g%s%s,  ", told, look->told[i].name, value,
                                   unit[0] ? " " : "", unit);
        }
    }
    return gm_picture_text(picture, "%s%s%s", told, mesh_and_scheme(picture, lanes, count),
                           look->remark ? look->remark : "");
}

/* Returns true if all lanes seek a steady state, which has no time. */
static bool is_steady(const struct gm_lane *const *lanes, size_t count)
{
    bool steady = true;
    for (size_t i = 0; i < count; i++) {
        steady &= lanes[i]->scheme->steady;
    }
    return steady;
}

/* Draws errors against the mean edge length, a point for each lane. */
static void draw_convergence(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    static const struct {
        const char *observable, *name;
    } errors[] = {{"psi_error", "ψ"},
                  {"theta_error", "θ"},
                  {"flux_error", "flux"},
                  {"velocity_error", "velocity"},
                  {"pressure_error", "total pressure"}};
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
    panel->axes = true;
    panel->x = (struct gm_axis){.label = "mean edge length", .scale = GM_LOG, .low = 1, .high = 0};
    panel->y = (struct gm_axis){.label = "relative error", .scale = GM_LOG, .low = 1, .high = 0};
    double *points = gm_picture_memory(picture, 2 * (count + 1) * sizeof *points);
    for (int drawn = 0; points && drawn < 2; drawn++) {
        for (size_t k = 0; k < GM_COUNT(errors); k++) {
            if (gm_scene_observable(lanes[0]->scene, errors[k].observable) < 0) {
                continue;
            }
            const int series = gm_asked_series(picture, lanes[0]->scene, errors[k].observable);
            size_t made = 0;
            for (size_t i = 0; series >= 0 && i < count; i++) {
                const double x = gm_flow_of(&lanes[i]->problem)->complex->mean_edge,
                             e = gm_lane_observe(lanes[i], (size_t)series);
                if (!(e > 0)) {
                    continue;
                }
                points[2 * made] = x;
                points[2 * made++ + 1] = e;
                if (!drawn) {
                    gm_range_add(&panel->x.low, &panel->x.high, x);
                    gm_range_add(&panel->y.low, &panel->y.high, e);
                }
            }
            if (!drawn || made == 0) {
                continue;
            }
            const struct gm_style style = {gm_lane_role(k), 1, 2, gm_lane_dash(k)};
            gm_mark_line(picture, panel, style, points, made, false);
            gm_mark_points(picture, panel, (struct gm_style){.role = gm_lane_role(k), .alpha = 1, .width = 6},
                           points, made);
            const double *first = points, *last = points + 2 * (made - 1);
            const double slope = made > 1 ? log(first[1] / last[1]) / log(first[0] / last[0]) : NAN;
            const char *name =
                made > 1 ? gm_picture_text(picture, "%s, order %.2f", errors[k].name, slope) : errors[k].name;
            gm_mark_text(picture, panel, (struct gm_style){.role = gm_lane_role(k), .alpha = 1, .width = 1},
                         first[0] * 1.04, first[1], GM_ANCHOR_LEFT, name);
        }
        if (!drawn) {
            gm_range_round(&panel->y.low, &panel->y.high, GM_LOG);
            panel->x.low *= 0.8;
            panel->x.high *= 2.6; /* space for the names on the right */
        }
    }
}

static bool is_logarithmic(const struct gm_scene *scene, const char *key)
{
    const int observable = gm_scene_observable(scene, key);
    return observable >= 0 && scene->observables[observable].logarithmic;
}

static void draw_graphs(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        const struct gm_look *look)
{
    /* a steady state has no time: its corrections are counted */
    const bool steady = is_steady(lanes, count);
    const char *unit =
        strchr(look->clock_unit, '/') ? gm_picture_text(picture, "(%s)", look->clock_unit) : look->clock_unit;
    const char *time = unit[0] ? gm_picture_text(picture, "t / %s", unit) : "t";
    for (size_t i = 0; i < 2 && look->graphs[i]; i++) {
        const struct gm_graph graph = {
            .observable = look->graphs[i],
            .scale = is_logarithmic(lanes[0]->scene, look->graphs[i]) ? GM_LOG : GM_LINEAR,
            .calm_low = look->graph_low[i],
            .calm_high = look->graph_high[i],
            .time_label = steady ? "corrections" : time,
            .time_unit = steady ? fabs(lanes[0]->run->dt) : 0,
        };
        gm_draw_graphs(picture, lanes, count, &graph, 1);
    }
}

/* Draws the clock, except for steady states, which have no time. */
static void draw_clock(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                       const struct gm_look *look)
{
    gm_draw_clock(picture, lanes, count);
    if (is_steady(lanes, count)) {
        picture->clock = "";
    } else if (look->clock_unit[0]) {
        picture->clock = gm_picture_text(picture, "%s %s", picture->clock, look->clock_unit);
    }
}

void gm_flows_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                   const struct gm_look *look)
{
    const struct gm_flows *flows = lanes[0]->parameters;
    picture->title = lanes[0]->scene->title;
    picture->subtitle = subtitle(picture, lanes, count, look);
    picture->graphs_below = true;
    draw_clock(picture, lanes, count, look);
    if (flows->show == GM_SHOW_CONVERGENCE && gm_room_line(gm_room_of(&lanes[0]->problem), GM_ROOM_EXACT)) {
        draw_convergence(picture, lanes, count);
        return;
    }
    if (flows->show == GM_SHOW_PROFILES && look->profiles) {
        gm_room_draw_profiles(lanes, count, picture, GM_PLACE_STATE);
        return;
    }
    if (flows->show == GM_SHOW_DIVERGENCE) {
        const struct gm_graph graph = {.observable = "divergence",
                                       .scale = GM_LOG,
                                       .calm_low = 1e-18,
                                       .calm_high = 1e-15,
                                       .named = true};
        gm_draw_graphs(picture, lanes, count, &graph, 1);
        return;
    }
    double low = 0, high = 1;
    colour_range(picture, lanes, count, look, &low, &high);
    const bool graphs = count <= MOST_BESIDE_GRAPHS && flows->show != GM_SHOW_NONE;
    for (size_t i = 0; i < count; i++) {
        struct gm_panel *panel = draw_state(picture, lanes[i], look, low, high, count > 1, count == 1);
        panel->title_role = graphs ? gm_lane_role(lanes[i]->shown.colour) : GM_INK;
        panel->colour_bar &= i + 1 == count; /* all panels have the same colours */
    }
    if (graphs && look->graphs[0]) {
        draw_graphs(picture, lanes, count, look);
    } else if (graphs && look->profiles_below) {
        gm_room_draw_profiles(lanes, count, picture, GM_PLACE_GRAPH);
    }
}
