/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of flows: a field of colours, streamlines as level lines of the stream function (the very paths of
   the discrete velocity), tracers with short tails, the walls, and graphs. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scenes/flow/marks.h"
#include "scenes/frame/graph.h"

enum { SMOOTH = 4000 /* triangles */, MOST_BESIDE_GRAPHS = 4 };

static const struct gm_flow *flow_of(const struct gm_lane *lane)
{
    return gm_flow_of(&lane->problem);
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

static const char *const bar_labels[] = {"concentration θ", "vorticity ω", "speed |u|", "total pressure"};

static const char *title_of(struct gm_picture *picture, const struct gm_lane *lane)
{
    const struct gm_shown *shown = &lane->shown;
    return shown->panel_name[0] && shown->colour_name[0]
               ? gm_picture_text(picture, "%s, %s", shown->panel_name, shown->colour_name)
               : gm_lane_title(lane);
}

static struct gm_panel *draw_state(struct gm_picture *picture, const struct gm_lane *lane,
                                   const struct gm_look *look, double low, double high, bool titled,
                                   bool named)
{
    const struct gm_flows *own = lane->parameters;
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
    const double side = flow->inflow.count > 0 && named ? 0.1 * size : edge;
    panel->x = (struct gm_axis){.label = "", .low = box[0] - side, .high = box[1] + side};
    panel->y = (struct gm_axis){.label = "", .low = box[2] - edge, .high = box[3] + edge};
    panel->equal = true;
    panel->axes = look->axes[0] && named;
    if (panel->axes) {
        panel->x.label = look->axes[0];
        panel->y.label = look->axes[1];
    }
    panel->note = gm_lane_failure(picture, lane);
    const bool coloured = own->show <= GM_SHOW_PRESSURE, over = coloured && !gm_flow_is_signed(own->show);
    const double *field = coloured ? field_of(picture, lane) : NULL;
    /* colours of fine meshes are smooth as they are, and four times the triangles cost three times the
       time */
    const bool plain = complex->boundary > 0 && complex->triangles > SMOOTH;
    struct gm_flow_sheet sheet;
    if (!gm_flow_sheet_make(picture, complex, gm_run_state(lane->run), plain ? NULL : field, &sheet)) {
        return panel;
    }
    if (field) {
        gm_mark_mesh(picture, panel, gm_flow_is_signed(own->show) ? GM_MAP_DIVERGING : GM_MAP_SEQUENTIAL, low,
                     high, plain ? complex->point : sheet.points, plain ? field : sheet.field,
                     plain ? complex->vertices : sheet.vertices, plain ? complex->triangle : sheet.triangles,
                     plain ? complex->triangles : sheet.count);
        panel->colour_bar = true;
        panel->colour_bar_label =
            own->show == GM_SHOW_SCALAR && look->scalar_name ? look->scalar_name : bar_labels[own->show];
    }
    if (own->grid) {
        gm_flow_draw_grid(picture, panel, complex, over);
    }
    if (own->streamlines) {
        gm_flow_draw_streamlines(picture, panel, lane, &sheet, look);
    }
    if (own->arrows) {
        gm_flow_draw_arrows(picture, panel, lane, over, look->speed_high);
    }
    gm_flow_draw_tracers(picture, panel, lane, over, size);
    gm_flow_draw_walls(picture, panel, flow);
    if (named) {
        gm_flow_name_openings(picture, panel, flow, size);
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

const char *gm_flows_common(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                            const char *name, size_t offset)
{
    double value = 0;
    memcpy(&value, (const char *)lanes[0]->parameters + offset, sizeof value);
    return is_common(lanes, count, offset) ? gm_picture_text(picture, "%s %.6g,  ", name, value) : "";
}

const char *gm_flows_mesh_and_scheme(struct gm_picture *picture, const struct gm_lane *const *lanes,
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
    const char *mesh = fewest == most ? gm_picture_text(picture, "%zu triangles", most)
                                      : gm_picture_text(picture, "%zu to %zu triangles", fewest, most);
    return one_scheme ? gm_picture_text(picture, "%s,  %s", mesh, lanes[0]->schemes) : mesh;
}

bool gm_flow_is_steady(const struct gm_lane *const *lanes, size_t count)
{
    bool steady = true;
    for (size_t i = 0; i < count; i++) {
        steady &= strcmp(lanes[i]->scheme->name, "steady") == 0;
    }
    return steady;
}

/* The clock; none where there is no time: steady states. */
static void draw_clock(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                       const struct gm_look *look)
{
    gm_draw_clock(picture, lanes, count);
    if (gm_flow_is_steady(lanes, count)) {
        picture->clock = "";
    } else if (look->clock_unit[0]) {
        picture->clock = gm_picture_text(picture, "%s %s", picture->clock, look->clock_unit);
    }
}

void gm_flows_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                   const struct gm_look *look)
{
    const struct gm_flows *own = lanes[0]->parameters;
    picture->title = look->title;
    picture->subtitle = look->subtitle(picture, lanes, count);
    picture->graphs_below = true;
    draw_clock(picture, lanes, count, look);
    if (own->show == GM_SHOW_CONVERGENCE && look->errors) {
        gm_flow_draw_convergence(picture, lanes, count, look);
        return;
    }
    if (own->show == GM_SHOW_PROFILES && look->profiles) {
        look->profiles(lanes, count, picture, GM_PLACE_STATE);
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
    const bool graphs = count <= MOST_BESIDE_GRAPHS && own->show != GM_SHOW_NONE;
    for (size_t i = 0; i < count; i++) {
        struct gm_panel *panel = draw_state(picture, lanes[i], look, low, high, count > 1, count == 1);
        panel->title_role = graphs ? gm_lane_role(lanes[i]->shown.colour) : GM_INK;
        panel->colour_bar &= i + 1 == count; /* the colours mean the same in all */
    }
    if (graphs && look->graphs[0]) {
        gm_flow_draw_graphs(picture, lanes, count, look);
    } else if (graphs && look->profiles_below) {
        look->profiles(lanes, count, picture, GM_PLACE_GRAPH);
    }
}
