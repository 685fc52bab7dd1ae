/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of flows: a field of colours, streamlines as level lines of the stream function (the very paths of
   the discrete velocity), tracers with short tails, the walls, and graphs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/flow_sheet.h"
#include "scenes/flows.h"
#include "scenes/graph.h"

enum { MOST_LEVELS = 64, SMOOTH = 4000 /* triangles */ };

static const struct gm_flow *flow_of(const struct gm_lane *lane)
{
    return lane->problem.flow;
}

/* The field that is shown, at the vertices; NULL for none. */
static const double *field_of(struct gm_picture *picture, const struct gm_lane *lane)
{
    const struct gm_flows *own = lane->parameters;
    const struct gm_flow *flow = flow_of(lane);
    const struct gm_complex *complex = flow->complex;
    const double *y = gm_run_state(lane->run);
    const size_t n = complex->vertices;
    if (own->show == GM_SHOW_SCALAR) {
        return gm_flow_block(flow, y, GM_FLOW_THETA);
    }
    if (own->show == GM_SHOW_VORTICITY) {
        return gm_flow_block(flow, y, GM_FLOW_OMEGA);
    }
    double *values = gm_picture_memory(picture, 3 * n * sizeof *values);
    double *scratch = gm_picture_memory(picture, 3 * n * sizeof *scratch);
    if (!values || !scratch) {
        return NULL;
    }
    if (own->show == GM_SHOW_SPEED) {
        gm_flow_vertex_velocities(complex, y, scratch);
        for (size_t v = 0; v < n; v++) {
            values[v] = hypot(scratch[2 * v], scratch[2 * v + 1]);
        }
        return values;
    }
    double *pressure = gm_picture_memory(picture, complex->triangles * sizeof *pressure);
    if (own->show != GM_SHOW_PRESSURE || !pressure || !gm_flow_pressure(flow, y, pressure)) {
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

/* The ends of the colours; the same for all lanes. */
static void colour_range(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                         const struct gm_look *look, double *low, double *high)
{
    const struct gm_flows *own = lanes[0]->parameters;
    *low = 0;
    *high = own->show == GM_SHOW_SPEED ? look->speed_high : look->scalar_high;
    if (own->show == GM_SHOW_SCALAR && look->scalar_high == 0) {
        *high = 0;
        for (size_t i = 0; i < count; i++) {
            *high = fmax(*high, ((const struct gm_flows *)lanes[i]->parameters)->inlet_scalar);
        }
        *high = *high > 0 ? *high : 1;
    }
    if (own->show == GM_SHOW_VORTICITY) {
        *high = look->vorticity_range;
        *low = -*high;
    }
    if (own->show == GM_SHOW_PRESSURE) {
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

static bool is_signed(int show)
{
    return show == GM_SHOW_VORTICITY || show == GM_SHOW_PRESSURE;
}

/* Levels of psi: equal parts of the flow that passes through; the same distance in what turns on its own. */
static void draw_streamlines(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                             const struct gm_flow_sheet *sheet, const struct gm_look *look)
{
    const struct gm_flows *own = lane->parameters;
    const bool over = own->show != GM_SHOW_NONE && !is_signed(own->show);
    const struct gm_style passing = {over ? GM_OVER : GM_INK, over ? 0.6 : 0.5, 1.1, GM_SOLID};
    const struct gm_style turning = {over ? GM_OVER : GM_INK, over ? 0.38 : 0.5, 1.0, GM_SOLID};
    const struct gm_flow *flow = flow_of(lane);
    const struct gm_complex *complex = flow->complex;
    double levels[MOST_LEVELS], low = INFINITY, high = -INFINITY, through = 0;
    size_t count = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        low = fmin(low, gm_run_state(lane->run)[v]);
        high = fmax(high, gm_run_state(lane->run)[v]);
    }
    for (size_t b = 0; b < complex->boundary; b++) {
        through = fmax(through, flow->psi[complex->boundary_vertex[b]]);
    }
    if (look->levels) {
        gm_mark_level_lines(picture, panel, turning, sheet->points, sheet->psi, sheet->vertices,
                            sheet->triangles, sheet->count, look->levels, look->level_count);
        return;
    }
    if (through > 0) {
        for (int i = 1; i < 10; i++) {
            levels[count++] = through * i / 10;
        }
        gm_mark_level_lines(picture, panel, passing, sheet->points, sheet->psi, sheet->vertices,
                            sheet->triangles, sheet->count, levels, count);
        count = 0;
    }
    const double apart = through > 0 ? through / 10 : (high - low) / 17;
    for (int i = 0; apart > 0 && i < MOST_LEVELS / 2; i++) {
        const double below = (through > 0 ? 0 : (low + high) / 2) - apart * (i + 0.5);
        const double above = (through > 0 ? through : (low + high) / 2) + apart * (i + 0.5);
        if (below > low) {
            levels[count++] = below;
        }
        if (above < high) {
            levels[count++] = above;
        }
    }
    gm_mark_level_lines(picture, panel, turning, sheet->points, sheet->psi, sheet->vertices, sheet->triangles,
                        sheet->count, levels, count);
}

/* Edges that run along the boundary in one go: walls bold, openings not drawn. */
static void draw_walls(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow)
{
    const struct gm_complex *complex = flow->complex;
    double *points = gm_picture_memory(picture, 4 * (complex->boundary + 1) * sizeof *points);
    size_t count = 0;
    for (size_t b = 0; points && b < complex->boundary; b++) {
        const int v = complex->boundary_vertex[b];
        const int *edge = complex->edge + 2 * complex->boundary_edge[b];
        const int w = edge[0] == v ? edge[1] : edge[0];
        bool open = false;
        for (int k = 0; k < 2; k++) {
            const int end = k ? w : v;
            const bool inlet = flow->inflow.count > 0 && flow->theta_fixed[end] && flow->psi[end] > 0 &&
                               fabs(flow->psi[end] - flow->inflow.psi[0]) > 1e-12 * flow->inflow.psi[0];
            open |= !flow->theta_fixed[end] || inlet;
        }
        if (open) {
            if (count > 0) {
                points[2 * count] = points[2 * count + 1] = NAN;
                count++;
            }
            continue;
        }
        memcpy(points + 2 * count++, complex->point + 2 * v, 2 * sizeof *points);
        if (b + 1 == complex->boundary || complex->boundary_vertex[b + 1] != w) {
            memcpy(points + 2 * count++, complex->point + 2 * w, 2 * sizeof *points);
        } else {
            memcpy(points + 2 * count, complex->point + 2 * w, 2 * sizeof *points);
            count += 1;
        }
    }
    if (points) {
        gm_mark_line(picture, panel, (struct gm_style){GM_INK, 1, 2.2, GM_SOLID}, points, count, false);
    }
}

static void draw_grid(struct gm_picture *picture, struct gm_panel *panel, const struct gm_complex *complex,
                      bool over)
{
    double *points = gm_picture_memory(picture, 6 * complex->edges * sizeof *points);
    for (size_t e = 0; points && e < complex->edges; e++) {
        const double *a = complex->point + 2 * complex->edge[2 * e],
                     *b = complex->point + 2 * complex->edge[2 * e + 1];
        double *line = points + 6 * e;
        memcpy(line, a, 2 * sizeof *line);
        for (int c = 0; c < 2; c++) {
            const double period = complex->period[c];
            line[2 + c] = b[c] - (period > 0 ? period * round((b[c] - a[c]) / period) : 0);
        }
        line[4] = line[5] = NAN;
    }
    if (points) {
        gm_mark_line(picture, panel,
                     (struct gm_style){over ? GM_OVER : GM_SECONDARY, over ? 0.25 : 0.8, 0.8, GM_SOLID},
                     points, 3 * complex->edges, false);
    }
}

/* Tracers: a dot each, and a tail where it was a short time ago. */
static void draw_tracers(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                         bool over, double size)
{
    const struct gm_flow *flow = flow_of(lane);
    const double *y = gm_run_state(lane->run);
    const size_t count = flow->tracers;
    double *tails = gm_picture_memory(picture, 6 * (count + 1) * sizeof *tails);
    double *dots = gm_picture_memory(picture, 2 * (count + 1) * sizeof *dots);
    if (!tails || !dots || count == 0) {
        return;
    }
    const double lag = 0.012 * size; /* over the speed 1 */
    for (size_t i = 0; i < count; i++) {
        const double *tracer = gm_flow_tracer(flow, y, i);
        double u[2];
        gm_flow_velocity(flow->complex, y, (size_t)tracer[GM_TRACER_TRIANGLE], u);
        dots[2 * i] = tails[6 * i] = tracer[GM_TRACER_X];
        dots[2 * i + 1] = tails[6 * i + 1] = tracer[GM_TRACER_Y];
        tails[6 * i + 2] = tracer[GM_TRACER_X] - lag * u[0];
        tails[6 * i + 3] = tracer[GM_TRACER_Y] - lag * u[1];
        tails[6 * i + 4] = tails[6 * i + 5] = NAN;
    }
    const enum gm_role role = over ? GM_OVER : GM_INK;
    gm_mark_line(picture, panel, (struct gm_style){role, 0.55, 1.5, GM_SOLID}, tails, 3 * count, false);
    gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 0.85, .width = 2.4}, dots, count);
}

/* Arrows on an even grid, at the nearest vertices. */
static void draw_arrows(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                        bool over, double speed)
{
    enum { ACROSS = 24 };
    const struct gm_complex *complex = flow_of(lane)->complex;
    double *velocities = gm_picture_memory(picture, 3 * complex->vertices * sizeof *velocities);
    const double width = panel->x.high - panel->x.low, height = panel->y.high - panel->y.low;
    const double cell = fmax(width, height) / ACROSS;
    const size_t columns = (size_t)(width / cell) + 1, rows = (size_t)(height / cell) + 1;
    bool *taken = gm_picture_memory(picture, columns * rows * sizeof *taken);
    double *lines = gm_picture_memory(picture, 14 * columns * rows * sizeof *lines);
    if (!velocities || !taken || !lines) {
        return;
    }
    memset(taken, 0, columns * rows * sizeof *taken);
    gm_flow_vertex_velocities(complex, gm_run_state(lane->run), velocities);
    size_t count = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        const double x = complex->point[2 * v], z = complex->point[2 * v + 1];
        const double at[2] = {(x - panel->x.low) / cell, (z - panel->y.low) / cell};
        const size_t place = (size_t)fmax(at[1], 0) * columns + (size_t)fmax(at[0], 0);
        const bool middle =
            fabs(at[0] - floor(at[0]) - 0.5) < 0.25 && fabs(at[1] - floor(at[1]) - 0.5) < 0.25;
        if (place >= columns * rows || taken[place] || !middle) {
            continue;
        }
        taken[place] = true;
        const double dx = velocities[2 * v] / speed * cell * 0.9,
                     dz = velocities[2 * v + 1] / speed * cell * 0.9;
        const double arrow[14] = {x - dx / 2,
                                  z - dz / 2,
                                  x + dx / 2,
                                  z + dz / 2,
                                  NAN,
                                  NAN,
                                  x + dx / 2 - 0.3 * dx + 0.15 * dz,
                                  z + dz / 2 - 0.3 * dz - 0.15 * dx,
                                  x + dx / 2,
                                  z + dz / 2,
                                  x + dx / 2 - 0.3 * dx - 0.15 * dz,
                                  z + dz / 2 - 0.3 * dz + 0.15 * dx,
                                  NAN,
                                  NAN};
        memcpy(lines + 2 * count, arrow, sizeof arrow);
        count += 7;
    }
    gm_mark_line(picture, panel, (struct gm_style){over ? GM_OVER : GM_INK, 0.9, 1.3, GM_SOLID}, lines, count,
                 false);
}

/* "inlet" and "outlet" outside the walls, where they are on the left and on the right. */
static void name_openings(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow,
                          double size)
{
    const struct gm_style style = {.role = GM_INK, .alpha = 1, .width = 1};
    const struct gm_inflow *inflow = &flow->inflow;
    if (inflow->count == 0) {
        return;
    }
    const double *a = inflow->point, *b = inflow->point + 2 * (inflow->count - 1);
    gm_mark_text(picture, panel, style, (a[0] + b[0]) / 2 - 0.012 * size, (a[1] + b[1]) / 2, GM_ANCHOR_RIGHT,
                 "inlet");
    double x = 0, z = 0;
    size_t count = 0;
    for (size_t i = 0; i < flow->complex->boundary; i++) {
        const int v = flow->complex->boundary_vertex[i];
        if (!flow->theta_fixed[v]) {
            x += flow->complex->point[2 * v];
            z += flow->complex->point[2 * v + 1];
            count++;
        }
    }
    if (count > 0) {
        gm_mark_text(picture, panel, style, x / (double)count + 0.012 * size, z / (double)count,
                     GM_ANCHOR_LEFT, "outlet");
    }
}

static const char *const bar_labels[] = {"concentration θ", "vorticity ω", "speed |u|", "total pressure"};

static void draw_state(struct gm_picture *picture, const struct gm_lane *lane, const struct gm_look *look,
                       double low, double high, bool titled, bool named)
{
    const struct gm_flows *own = lane->parameters;
    const struct gm_flow *flow = flow_of(lane);
    const struct gm_complex *complex = flow->complex;
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, titled ? gm_lane_title(lane) : "");
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
    const double side = flow->inflow.count > 0 && named ? 0.1 * size : edge;
    panel->x = (struct gm_axis){.label = "", .low = box[0] - side, .high = box[1] + side};
    panel->y = (struct gm_axis){.label = "", .low = box[2] - edge, .high = box[3] + edge};
    panel->equal = true;
    panel->axes = false;
    panel->note = gm_lane_failure(picture, lane);
    const bool coloured = own->show <= GM_SHOW_PRESSURE, over = coloured && !is_signed(own->show);
    const double *field = coloured ? field_of(picture, lane) : NULL;
    /* colours of fine meshes are smooth as they are, and four times the triangles cost three times the time
     */
    const bool plain = complex->boundary > 0 && complex->triangles > SMOOTH;
    struct gm_flow_sheet sheet;
    if (!gm_flow_sheet_make(picture, complex, gm_run_state(lane->run), plain ? NULL : field, &sheet)) {
        return;
    }
    if (field) {
        gm_mark_mesh(picture, panel, is_signed(own->show) ? GM_MAP_DIVERGING : GM_MAP_SEQUENTIAL, low, high,
                     plain ? complex->point : sheet.points, plain ? field : sheet.field,
                     plain ? complex->vertices : sheet.vertices, plain ? complex->triangle : sheet.triangles,
                     plain ? complex->triangles : sheet.count);
        panel->colour_bar = true;
        panel->colour_bar_label = bar_labels[own->show];
    }
    if (own->grid) {
        draw_grid(picture, panel, complex, over);
    }
    if (own->streamlines) {
        draw_streamlines(picture, panel, lane, &sheet, look);
    }
    if (own->arrows) {
        draw_arrows(picture, panel, lane, over, look->speed_high);
    }
    draw_tracers(picture, panel, lane, over, size);
    draw_walls(picture, panel, flow);
    if (named) {
        name_openings(picture, panel, flow, size);
    }
}

/* Errors against the mean edge length, a point for each lane. */
static void draw_convergence(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                             const struct gm_look *look)
{
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
    panel->axes = true;
    panel->x = (struct gm_axis){.label = "mean edge length", .scale = GM_LOG, .low = 1, .high = 0};
    panel->y = (struct gm_axis){.label = "relative error", .scale = GM_LOG, .low = 1, .high = 0};
    double *points = gm_picture_memory(picture, 2 * (count + 1) * sizeof *points);
    const struct gm_scene *scene = lanes[0]->scene;
    for (int drawn = 0; points && drawn < 2; drawn++) {
        for (size_t k = 0; look->errors[k].observable; k++) {
            size_t series = 0;
            while (strcmp(scene->observables[series].key, look->errors[k].observable) != 0) {
                series++;
            }
            size_t made = 0;
            for (size_t i = 0; i < count; i++) {
                const double x = flow_of(lanes[i])->complex->mean_edge, e = gm_lane_observe(lanes[i], series);
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
            const char *name = made > 1
                                   ? gm_picture_text(picture, "%s, order %.2f", look->errors[k].name, slope)
                                   : look->errors[k].name;
            gm_mark_text(picture, panel, (struct gm_style){.role = gm_lane_role(k), .alpha = 1, .width = 1},
                         first[0] * 1.04, first[1], GM_ANCHOR_LEFT, name);
        }
        if (!drawn) {
            gm_range_round(&panel->y.low, &panel->y.high, GM_LOG);
            panel->x.low *= 0.8;
            panel->x.high *= 2.6; /* the names stand on the right */
        }
    }
}

void gm_flows_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                   const struct gm_look *look)
{
    const struct gm_flows *own = lanes[0]->parameters;
    picture->title = look->title;
    picture->subtitle = look->subtitle(picture, lanes[0]);
    gm_draw_clock(picture, lanes, count);
    if (look->clock_unit[0]) {
        double latest = lanes[0]->run->t;
        for (size_t i = 1; i < count; i++) {
            latest = fmax(latest, lanes[i]->run->t);
        }
        picture->clock = gm_picture_text(picture, "t = %.2f %s", latest, look->clock_unit);
    }
    if (own->show == GM_SHOW_CONVERGENCE && look->errors) {
        draw_convergence(picture, lanes, count, look);
        return;
    }
    if (own->show == GM_SHOW_PROFILES && look->profiles) {
        look->profiles(lanes, count, picture);
        return;
    }
    if (own->show == GM_SHOW_DIVERGENCE) {
        const struct gm_graph graph = {
            .observable = "divergence", .scale = GM_LOG, .calm_low = 1e-18, .calm_high = 1e-15};
        gm_draw_graph(picture, lanes, count, &graph, -1, true);
        return;
    }
    double low = 0, high = 1;
    colour_range(picture, lanes, count, look, &low, &high);
    for (size_t i = 0; i < count; i++) {
        draw_state(picture, lanes[i], look, low, high, count > 1, count == 1);
    }
    for (int i = 0; i < 2 && count <= 2 && own->show != GM_SHOW_NONE && look->graphs[i]; i++) {
        const struct gm_graph graph = {
            .observable = look->graphs[i], .calm_low = look->graph_low[i], .calm_high = look->graph_high[i]};
        gm_draw_graph(picture, lanes, count, &graph, -1, false);
    }
}
