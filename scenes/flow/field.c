/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The field of a flow in colours, and the marks over it: streamlines as level lines of the stream function (the very paths
   of the discrete velocity), walls, the mesh, tracers with short tails, arrows, names. */
#include "core/functions/functions.h"
#include "scenes/common/graph.h"
#include "scenes/flow/room_scene.h"
#include "scenes/form/form.h"

#include <math.h>
#include <string.h>

enum { MOST_LEVELS = 64, SMOOTH = 4000 /* triangles */ };

static const struct gm_flow *flow_of(const struct gm_lane *lane)
{
    return gm_flow_of(&lane->problem);
}

/* A mesh as it is drawn: refined if it is coarse, unfolded if it is a torus. */
struct sheet {
    const double *points, *psi, *field; /* field: NULL for none */
    const int *triangles;
    size_t vertices, count;
};

/* Meshes up to this size are refined once for the picture: a cubic along every edge, from the gradients at
   its ends. */
enum { REFINED = 12000 };

/* Gradients at the vertices: x and y for each, the mean over the triangles around. */
static void gradients(const struct gm_complex *complex, const double *values, double *gradient)
{
    /* the velocity of psi = values is its gradient turned */
    gm_flow_vertex_velocities(complex, values, gradient);
    for (size_t v = 0; v < complex->vertices; v++) {
        const double u = gradient[2 * v], w = gradient[2 * v + 1];
        gradient[2 * v] = -w;
        gradient[2 * v + 1] = u;
    }
}

static double *refine(struct gm_picture *picture, const struct gm_complex *complex, const double *values)
{
    const size_t n = complex->vertices;
    double *fine = gm_picture_memory(picture, (n + complex->edges) * sizeof *fine);
    double *gradient = gm_picture_memory(picture, 3 * n * sizeof *gradient);
    gradients(complex, values, gradient);
    memcpy(fine, values, n * sizeof *fine);
    for (size_t e = 0; e < complex->edges; e++) {
        const int a = complex->edge[2 * e], b = complex->edge[2 * e + 1];
        double bend = 0;
        for (int c = 0; c < 2; c++) {
            bend += (gradient[2 * a + c] - gradient[2 * b + c]) *
                    (complex->point[2 * b + c] - complex->point[2 * a + c]);
        }
        const double middle = (values[a] + values[b]) / 2, widest = fabs(values[a] - values[b]) / 2;
        /* at most the bend of a monotonic cubic, if the ends differ */
        fine[n + e] =
            middle + fmin(fmax(bend / 8, -fmax(widest, fabs(bend) / 8)), fmax(widest, fabs(bend) / 8));
    }
    return fine;
}

/* Values at vertices, as those of the corners of triangles. */
static const double *at_corners(struct gm_picture *picture, const struct gm_complex *complex,
                                const double *values)
{
    double *corners = gm_picture_memory(picture, 3 * complex->triangles * sizeof *corners);
    for (size_t i = 0; i < 3 * complex->triangles; i++) {
        corners[i] = values[complex->triangle[i]];
    }
    return corners;
}

/* Makes the sheet in the picture's arena; psi and field are values at the vertices. */
static struct sheet sheet_of(const struct gm_form_sheet *plane, const double *psi, const double *field)
{
    struct gm_picture *picture = plane->picture;
    const struct gm_complex *complex = plane->complex;
    if (complex->boundary == 0) {
        const struct gm_form_surface flow = gm_form_surface_of(plane, at_corners(picture, complex, psi)),
                                     shown = gm_form_surface_of(
                                         plane, at_corners(picture, complex, field ? field : psi));
        return (struct sheet){flow.points,    flow.values, field ? shown.values : NULL,
                              flow.triangles, flow.count,  flow.triangle_count};
    }
    if (complex->triangles > REFINED) {
        return (struct sheet){complex->point,    psi, field, complex->triangle, complex->vertices,
                              complex->triangles};
    }
    const size_t n = complex->vertices;
    double *points = gm_picture_memory(picture, 2 * (n + complex->edges) * sizeof *points);
    int *triangles = gm_picture_memory(picture, 12 * complex->triangles * sizeof *triangles);
    gm_complex_quarter(complex, points, triangles);
    return (struct sheet){.points = points,
                          .psi = refine(picture, complex, psi),
                          .field = field ? refine(picture, complex, field) : NULL,
                          .triangles = triangles,
                          .vertices = n + complex->edges,
                          .count = 4 * complex->triangles};
}

/* Returns true if the field that is shown has both signs. */
static bool is_signed(int show)
{
    return show == GM_SHOW_VORTICITY || show == GM_SHOW_PRESSURE;
}

/* Draws level lines of psi: at equal parts of the flow that passes through, and at the same distance in
   closed eddies. */
static void draw_streamlines(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                             const struct sheet *sheet, const struct gm_look *look)
{
    const struct gm_flows *flows = lane->parameters;
    const bool over = flows->show != GM_SHOW_NONE && !is_signed(flows->show);
    const struct gm_style passing = {over ? GM_OVER : GM_INK, over ? 0.6 : 0.5, 1.1, GM_SOLID};
    const struct gm_style turning = {over ? GM_OVER : GM_INK, over ? 0.38 : 0.5, 1.0, GM_SOLID};
    const struct gm_flow *flow = flow_of(lane);
    const struct gm_complex *complex = flow->complex;
    double levels[MOST_LEVELS], low = INFINITY, high = -INFINITY, through = 0, base = 0;
    size_t count = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        low = fmin(low, gm_run_state(lane->run)[v]);
        high = fmax(high, gm_run_state(lane->run)[v]);
    }
    for (size_t b = 0; b < complex->boundary; b++) {
        through = fmax(through, flow->psi[complex->boundary_vertex[b]]);
        base = fmin(base, flow->psi[complex->boundary_vertex[b]]);
    }
    through -= base;
    for (int i = 1; i < 10 && through > 0 && !look->levels; i++) {
        levels[count++] = base + through * i / 10;
    }
    if (count > 0) {
        gm_mark_level_lines(picture, panel, passing, sheet->points, sheet->psi, sheet->vertices,
                            sheet->triangles, sheet->count, levels, count);
        count = 0;
    }
    const double apart = through > 0 ? through / 10 : (high - low) / 17;
    for (int i = 0; apart > 0 && i < MOST_LEVELS / 2; i++) {
        const double below = (through > 0 ? base : (low + high) / 2) - apart * (i + 0.5);
        const double above = (through > 0 ? base + through : (low + high) / 2) + apart * (i + 0.5);
        if (below > low) {
            levels[count++] = below;
        }
        if (above < high) {
            levels[count++] = above;
        }
    }
    gm_mark_level_lines(picture, panel, turning, sheet->points, sheet->psi, sheet->vertices, sheet->triangles,
                        sheet->count, look->levels ? look->levels : levels,
                        look->levels ? look->level_count : count);
}

/* Draws edges along the boundary in one go: walls bold, openings not at all. */
static void draw_walls(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow)
{
    const struct gm_complex *complex = flow->complex;
    double *points = gm_picture_memory(picture, 6 * (complex->boundary + 1) * sizeof *points);
    size_t count = 0;
    for (size_t b = 0; b < complex->boundary; b++) {
        const int v = complex->boundary_vertex[b];
        const int *edge = complex->edge + 2 * complex->boundary_edge[b];
        const int w = edge[0] == v ? edge[1] : edge[0];
        const bool open = flow->open[v] != GM_OPEN_NOT || flow->open[w] != GM_OPEN_NOT ||
                          (flow->openings == 0 && (!flow->theta_fixed[v] || !flow->theta_fixed[w]));
        if (open) {
            if (count > 0) {
                points[2 * count] = points[2 * count + 1] = NAN;
                count++;
            }
            continue;
        }
        memcpy(points + 2 * count++, complex->point + 2 * v, 2 * sizeof *points);
        memcpy(points + 2 * count++, complex->point + 2 * w, 2 * sizeof *points);
        if (b + 1 < complex->boundary && complex->boundary_vertex[b + 1] != w) { /* another loop: a hole's */
            points[2 * count] = points[2 * count + 1] = NAN;
            count++;
        }
    }
    gm_mark_line(picture, panel, (struct gm_style){GM_INK, 1, 2.2, GM_SOLID}, points, count, false);
}

/* Draws tracers: a dot each, and a tail to its position a short time ago. `size`: the longer side of the domain. */
static void draw_tracers(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                         enum gm_role role, double size)
{
    const struct gm_flow *flow = flow_of(lane);
    const double *y = gm_run_state(lane->run);
    const size_t count = flow->tracers;
    double *tails = gm_picture_memory(picture, 6 * (count + 1) * sizeof *tails);
    double *dots = gm_picture_memory(picture, 2 * (count + 1) * sizeof *dots);
    if (count == 0) {
        return;
    }
    const double lag = 0.012 * size; /* the length of a tail at speed 1 */
    size_t met = 0;
    for (size_t k = 0; k < count; k++) {
        const double *tracer = gm_flow_tracer(flow, y, k);
        if (tracer[GM_TRACER_AGE] < 0) {
            continue;
        }
        const size_t i = met++;
        double u[2];
        gm_flow_velocity(flow->complex, y, (size_t)tracer[GM_TRACER_TRIANGLE], u);
        dots[2 * i] = tails[6 * i] = tracer[GM_TRACER_X];
        dots[2 * i + 1] = tails[6 * i + 1] = tracer[GM_TRACER_Y];
        tails[6 * i + 2] = tracer[GM_TRACER_X] - lag * u[0];
        tails[6 * i + 3] = tracer[GM_TRACER_Y] - lag * u[1];
        tails[6 * i + 4] = tails[6 * i + 5] = NAN;
    }
    gm_mark_line(picture, panel, (struct gm_style){role, 0.55, 1.5, GM_SOLID}, tails, 3 * met, false);
    gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 0.85, .width = 2.4}, dots, met);
}

/* Draws arrows of velocity; one of `speed` is as long as their distance. */
static void draw_arrows(const struct gm_form_sheet *plane, struct gm_style style, const double *psi,
                        double speed)
{
    const struct gm_complex *complex = plane->complex;
    double *vectors = gm_picture_memory(plane->picture, 3 * complex->triangles * sizeof *vectors);
    for (size_t t = 0; t < complex->triangles; t++) {
        gm_flow_velocity(complex, psi, t, vectors + 3 * t);
    }
    gm_form_draw_arrows(plane, style, vectors, speed);
}

/* Sets `outward` to the way out through an opening, with its length, and `middle`. */
static void find_outward(const struct gm_flow *flow, const struct gm_opening *opening, double outward[2],
                         double middle[2])
{
    const struct gm_complex *complex = flow->complex;
    /* outside is on the right of the opening's direction */
    const double *a = complex->point + 2 * complex->boundary_vertex[opening->first],
                 *b = complex->point + 2 * complex->boundary_vertex[opening->end];
    outward[0] = b[1] - a[1];
    outward[1] = a[0] - b[0];
    middle[0] = (a[0] + b[0]) / 2;
    middle[1] = (a[1] + b[1]) / 2;
}

/* Writes the names of openings, or "inlet" and "outlet", outside the walls. */
static void name_openings(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow,
                          const char *const *names, double size)
{
    const struct gm_style style = {.role = GM_INK, .alpha = 1, .width = 1};
    for (size_t i = 0; i < flow->openings; i++) {
        const struct gm_opening *opening = &flow->opening[i];
        double outward[2], middle[2];
        find_outward(flow, opening, outward, middle);
        const double x = outward[0], z = outward[1];
        const bool upright = fabs(x) >= fabs(z);
        const double away = (upright ? 0.012 : 0.028) * size / gm_hypot(x, z);
        struct gm_mark *name = gm_mark_text(picture, panel, style, middle[0] + away * x, middle[1] + away * z,
                                            upright && x < 0 ? GM_ANCHOR_RIGHT
                                            : upright        ? GM_ANCHOR_LEFT
                                                             : GM_ANCHOR_CENTRE,
                                            names            ? names[opening->side]
                                            : opening->inlet ? "inlet"
                                                             : "outlet");
        if (name) {
            name->fixed = true; /* a name without space outside must not cover the field */
        }
    }
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
    if (flows->show == GM_SHOW_SPEED) {
        gm_flow_vertex_velocities(complex, y, scratch);
        for (size_t v = 0; v < n; v++) {
            values[v] = gm_hypot(scratch[2 * v], scratch[2 * v + 1]);
        }
        return values;
    }
    double *pressure = gm_picture_memory(picture, complex->triangles * sizeof *pressure);
    if (flows->show != GM_SHOW_PRESSURE || !gm_flow_pressure(flow, y, pressure)) {
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
                         const struct gm_look *look, double range[2])
{
    const struct gm_flows *flows = lanes[0]->parameters;
    range[0] = 0;
    range[1] = flows->show == GM_SHOW_SPEED ? look->speed_high : look->scalar_high;
    if (flows->show == GM_SHOW_TEMPERATURE) {
        range[0] = look->temperature[0];
        range[1] = look->temperature[1];
    }
    if (flows->show == GM_SHOW_VORTICITY) {
        range[1] = look->vorticity_range;
        range[0] = -range[1];
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
        range[1] = fmax(fabs(lowest), fabs(highest));
        range[0] = -range[1];
    }
}

static const char *title_of(struct gm_picture *picture, const struct gm_lane *lane)
{
    const char *colour = lane->shown.colour_name, *panel = gm_lane_title(lane);
    return colour[0] ? gm_picture_text(picture, "%s, %s", panel, colour) : panel;
}

static struct gm_panel *draw_state(struct gm_picture *picture, const struct gm_lane *lane,
                                   const struct gm_look *look, const double range[2], bool alone)
{
    const struct gm_flows *flows = lane->parameters;
    const struct gm_flow *flow = flow_of(lane);
    const struct gm_complex *complex = flow->complex;
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, alone ? "" : title_of(picture, lane));
    struct gm_form_sheet plane;
    gm_form_sheet_make(picture, panel, complex, NULL, 0, &plane);
    const double *low = plane.sight.low, *high = plane.sight.high,
                 size = fmax(high[0] - low[0], high[1] - low[1]),
                 edge = complex->boundary > 0 ? 0.006 * size : 0;
    const double beside = flow->inflow.count > 0 && alone && !look->sides ? 0.15 * size : edge;
    /* names of openings are outside, and need their width in small pictures too */
    double aside[2] = {beside, beside};
    bool stands[2] = {false, false};
    for (size_t i = 0; alone && i < flow->openings; i++) {
        double outward[2], middle[2];
        find_outward(flow, &flow->opening[i], outward, middle);
        if (fabs(outward[0]) < fabs(outward[1])) {
            stands[outward[1] > 0] = true;
        } else if (look->sides) {
            const double letters = (double)strlen(look->sides[flow->opening[i].side]);
            double *room = &aside[outward[0] > 0];
            *room = fmax(*room, fmin(0.04 * letters, 0.3) * size);
        }
    }
    panel->axes = look->axes[0] && alone;
    panel->x = (struct gm_axis){
        .label = panel->axes ? look->axes[0] : "", .low = low[0] - aside[0], .high = high[0] + aside[1]};
    panel->y = (struct gm_axis){.label = panel->axes ? look->axes[1] : "",
                                .low = low[1] - (stands[0] ? 0.06 * size : edge),
                                .high = high[1] + (stands[1] ? 0.06 * size : edge)};
    panel->note = gm_lane_failure(picture, lane);
    const bool coloured = flows->show <= GM_SHOW_PRESSURE || flows->show == GM_SHOW_TEMPERATURE,
               over = coloured && !is_signed(flows->show);
    const double *field = coloured ? field_of(picture, lane) : NULL;
    /* colours of fine meshes are smooth already, and four times the triangles cost three times the time */
    const bool plain = complex->boundary > 0 && complex->triangles > SMOOTH;
    const struct sheet sheet = sheet_of(&plane, gm_run_state(lane->run), plain ? NULL : field);
    const enum gm_role role = over ? GM_OVER : GM_INK;
    if (field) {
        gm_mark_mesh(picture, panel, is_signed(flows->show) ? GM_MAP_DIVERGING : GM_MAP_SEQUENTIAL, range[0],
                     range[1], plain ? complex->point : sheet.points, plain ? field : sheet.field,
                     plain ? complex->vertices : sheet.vertices, plain ? complex->triangle : sheet.triangles,
                     plain ? complex->triangles : sheet.count);
        panel->colour_bar = true;
        panel->colour_bar_label = look->names[flows->show];
    }
    if (flows->grid) {
        gm_form_draw_grid(&plane,
                          (struct gm_style){over ? GM_OVER : GM_SECONDARY, over ? 0.25 : 0.8, 0.8, GM_SOLID},
                          false);
    }
    if (flows->streamlines) {
        draw_streamlines(picture, panel, lane, &sheet, look);
    }
    if (flows->arrows) {
        draw_arrows(&plane, (struct gm_style){role, 0.9, 1.3, GM_SOLID}, gm_run_state(lane->run),
                    look->speed_high);
    }
    draw_tracers(picture, panel, lane, role, size);
    draw_walls(picture, panel, flow);
    if (alone) {
        name_openings(picture, panel, flow, look->sides, size);
    }
    return panel;
}

void gm_flow_draw_fields(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                         const struct gm_look *look, bool graphs)
{
    double range[2];
    colour_range(picture, lanes, count, look, range);
    for (size_t i = 0; i < count; i++) {
        struct gm_panel *panel = draw_state(picture, lanes[i], look, range, count == 1);
        panel->title_role = graphs ? gm_lane_role(lanes[i]->shown.colour) : GM_INK;
        panel->colour_bar &= i + 1 == count; /* all panels have the same colours */
    }
}
