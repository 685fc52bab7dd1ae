/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scenes/mesh/picture.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_sort.h>

#include "core/expression/number.h"
#include "core/functions/functions.h"
#include "core/mesh/user/potential.h"
#include "scenes/common/graph.h"
#include "scenes/mesh/observed.h"

enum { EXACT_POINTS = 1500 };

const char *const gm_mesh_views[] = {"all",         "field",        "mesh",    "energy",
                                     "convergence", "energy-order", "inertia", NULL};
const char *const gm_node_views[] = {"all", "field", "mesh", "energy", NULL};

static void field_axes(struct gm_panel *panel, const struct gm_mesh *mesh, const struct gm_mesh_look *look)
{
    const double scratch = 0.16 * (look->high - look->low);
    panel->axes = true;
    panel->x = (struct gm_axis){
        .label = "X", .scale = GM_LINEAR, .low = mesh->first, .high = mesh->first + mesh->length};
    panel->y = (struct gm_axis){
        .label = look->name, .scale = look->scale, .low = look->low - scratch, .high = look->high + scratch};
}

static void draw_exact(struct gm_picture *picture, struct gm_panel *panel, const struct gm_view *view,
                       const struct gm_mesh *mesh)
{
    double *points = gm_picture_memory(picture, 2 * EXACT_POINTS * sizeof *points);
    for (size_t i = 0; i < EXACT_POINTS; i++) {
        const double x = mesh->first + mesh->length * (double)i / (EXACT_POINTS - 1);
        points[2 * i] = x;
        points[2 * i + 1] = gm_mesh_exact(view, x, view->t);
    }
    gm_mark_line(picture, panel, (struct gm_style){GM_EXACT, 1, 2.4, GM_SOLID}, points, EXACT_POINTS, false);
}

/* The nodes with both ends, as points of a line: the field, or of nodes alone their velocity. */
static double *nodes_of(struct gm_picture *picture, const struct gm_mesh *mesh, const double *state)
{
    const size_t points = mesh->points, place = gm_mesh_place(mesh), value = mesh->alone ? points : 0;
    double *nodes = gm_picture_memory(picture, 2 * (points + 2) * sizeof *nodes);
    nodes[0] = mesh->first;
    nodes[1] = mesh->left;
    for (size_t k = 0; k < points; k++) {
        nodes[2 * k + 2] = state[place + k];
        nodes[2 * k + 3] = state[value + k];
    }
    nodes[2 * points + 2] = mesh->first + mesh->length;
    nodes[2 * points + 3] = mesh->right;
    return nodes;
}

/* Draws a line through the nodes; between nodes alone it is the file's. */
static void draw_line(struct gm_picture *picture, struct gm_panel *panel, const struct gm_view *view,
                      struct gm_style style, const double *nodes)
{
    enum { PARTS = 16 };
    const struct gm_mesh mesh = gm_mesh_of(view);
    const size_t cells = mesh.points + 1;
    double *line = gm_picture_memory(picture, mesh.alone ? 2 * (cells * PARTS + 1) * sizeof *line : 1);
    if (!mesh.alone) {
        gm_mark_line(picture, panel, style, nodes, cells + 1, false);
        return;
    }
    for (size_t e = 0; e < cells; e++) {
        const double *left = nodes + 2 * e, d = left[2] - left[0];
        double at[GM_BETWEEN_INPUTS][PARTS + 1], velocity[PARTS + 1];
        for (size_t i = 0; i <= PARTS; i++) {
            at[0][i] = (1 - gm_cos(M_PI * (double)i / PARTS)) / 2; /* closer where a long cell bends */
            at[1][i] = d;
            at[2][i] = left[1];
            at[3][i] = left[3];
        }
        gm_user_mesh_between(view->problem, at[0], velocity, PARTS + 1);
        for (size_t i = 0; i <= PARTS; i++) {
            line[2 * (e * PARTS + i)] = left[0] + at[0][i] * d;
            line[2 * (e * PARTS + i) + 1] = velocity[i];
        }
    }
    gm_mark_line(picture, panel, style, line, cells * PARTS + 1, false);
}

/* The axes of the ellipse dq^T A dq = 1 of displacements dq = (dy, dX), the long one first; false if A has rank 1. A is
   a diagonal block of the mass matrix with n columns. */
static bool find_axes(const double *block, size_t n, double axes[2][2])
{
    const double mean = (block[0] + block[n + 1]) / 2, half = (block[0] - block[n + 1]) / 2,
                 apart = gm_hypot(half, block[1]),
                 angle = gm_atan2(block[1], half) / 2; /* of the stiff direction */
    const double least = mean - apart, largest = mean + apart;
    axes[0][0] = -gm_sin(angle) / sqrt(least);
    axes[0][1] = gm_cos(angle) / sqrt(least);
    axes[1][0] = gm_cos(angle) / sqrt(largest);
    axes[1][1] = gm_sin(angle) / sqrt(largest);
    return least > 1e-9 * largest;
}

/* Tyranowski and Desbrun's figure 1 for every node: displacements of one kinetic energy, the same for all nodes, with
   which half of the ellipses are wider than a 35th of the panel. Halves that would pass a neighbour end there. Along the
   field a straight node has a segment, whose displacements have no energy. */
static void draw_inertia(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                         const double *nodes)
{
    enum { AROUND = 96 };
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_mesh mesh = gm_mesh_of(&view);
    const double width = panel->x.high - panel->x.low, height = panel->y.high - panel->y.low;
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    const size_t n = mesh.points <= GM_DENSE_POINTS ? 2 * mesh.points : 0, next = 2 * (n + 1);
    double *mass = gm_picture_memory(picture, (n * n + 1) * sizeof *mass),
           *sizes = gm_picture_memory(picture, mesh.points * sizeof *sizes), around[2 * AROUND], axes[2][2];
    size_t count = 0;
    if (!gm_mesh_mass_matrix(&mesh, view.state, mass)) {
        return;
    }
    for (size_t k = 0; k < mesh.points; k++) {
        if (find_axes(mass + k * next, n, axes)) {
            sizes[count++] = gm_hypot(axes[1][1] / width, axes[1][0] / height);
        }
    }
    gsl_sort(sizes, 1, count);
    const double scale = count > 0 ? 1. / 70 / sizes[count / 2] : 0;
    for (size_t k = 0; k < mesh.points; k++) {
        const double *node = nodes + 2 * k + 2;
        if (!find_axes(mass + k * next, n, axes)) {
            gm_mark_line(picture, panel, (struct gm_style){GM_INITIAL, 1, 2.4, GM_SOLID}, node - 2, 3, false);
            continue;
        }
        const double reach = scale * axes[0][1], left = fmin(1, (node[0] - node[-2]) / reach),
                     right = fmin(1, (node[2] - node[0]) / reach);
        for (size_t i = 0; i < AROUND; i++) {
            const double angle = 2 * M_PI * (double)i / AROUND, along = gm_cos(angle),
                         c = scale * along * (along < 0 ? left : right), s = scale * gm_sin(angle);
            around[2 * i] = node[0] + c * axes[0][1] + s * axes[1][1];
            around[2 * i + 1] = node[1] + c * axes[0][0] + s * axes[1][0];
        }
        gm_mark_polygon(picture, panel, (struct gm_style){.role = role, .alpha = 0.25}, around, AROUND);
        gm_mark_line(picture, panel, (struct gm_style){role, 1, 1.4, GM_SOLID}, around, AROUND, true);
    }
}

static void draw_field(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                       enum gm_mesh_view show)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_mesh mesh = gm_mesh_of(&view);
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    const bool inertia = show == GM_MESH_INERTIA;
    double *nodes = nodes_of(picture, &mesh, view.start);
    if (view.t != view.t0 && !inertia) {
        draw_line(picture, panel, &view, (struct gm_style){GM_INITIAL, 0.35, 1.2, GM_SOLID}, nodes);
    }
    nodes = nodes_of(picture, &mesh, view.state);
    draw_line(picture, panel, &view, (struct gm_style){role, inertia ? 0.4 : 1, 1.6, GM_SOLID}, nodes);
    if (inertia) {
        draw_inertia(picture, panel, lane, nodes);
    }
    if (mesh.points <= 400) {
        const double size = inertia ? 4 : mesh.points <= 40 ? 6 : mesh.points <= 130 ? 4.5 : 3;
        gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 1, .width = size}, nodes,
                       mesh.points + 2);
    }
}

static const char *error_text(struct gm_picture *picture, const struct gm_lane *lane)
{
    const int error_of = gm_scene_observable(lane->scene, "solution_error");
    const double error = error_of < 0 ? NAN : gm_lane_observe(lane, (size_t)error_of);
    return isfinite(error) ? gm_picture_text(picture, "solution error %.3f", error) : "";
}

static void draw_fields(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        const struct gm_mesh_look *look)
{
    struct gm_panel *panel = NULL;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        if (walk.first) {
            const struct gm_view view = gm_lane_view(walk.lane);
            const struct gm_mesh mesh = gm_mesh_of(&view);
            panel = gm_walk_panel(picture, &walk, error_text(picture, walk.lane));
            field_axes(panel, &mesh, look);
            if (look->show != GM_MESH_INERTIA) {
                draw_exact(picture, panel, &view, &mesh);
            }
        }
        draw_field(picture, panel, walk.lane, look->show);
    }
}

static void draw_paths(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                       bool crowded)
{
    const struct gm_entries *entries = &lane->entries[0];
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_mesh mesh = gm_mesh_of(&view);
    const size_t rows = entries->count + 1;
    const size_t stride = (mesh.points + entries->width - 1) / entries->width; /* nodes from path to path */
    const struct gm_style style = {gm_lane_role(lane->shown.colour), crowded ? 0.6 : 0.9, crowded ? 0.8 : 1.2,
                                   GM_SOLID};
    double *path = gm_picture_memory(picture, 2 * rows * sizeof *path);
    for (size_t k = 0; k < entries->width; k++) {
        for (size_t i = 0; i < entries->count; i++) {
            path[2 * i] = entries->values[i * entries->width + k];
            path[2 * i + 1] = entries->times[i];
        }
        path[2 * rows - 2] = view.state[gm_mesh_place(&mesh) + k * stride];
        path[2 * rows - 1] = view.t;
        gm_mark_line(picture, panel, style, path, rows, false);
    }
}

static void draw_meshes(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        bool named)
{
    struct gm_panel *panel = NULL;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        const struct gm_view view = gm_lane_view(walk.lane);
        const struct gm_timing *timing = view.parameters;
        const struct gm_entries *paths = &walk.lane->entries[0];
        if (walk.first) {
            const struct gm_mesh mesh = gm_mesh_of(&view);
            panel = named ? gm_walk_panel(picture, &walk, error_text(picture, walk.lane))
                          : gm_panel_add(picture, GM_PLACE_STATE, "");
            panel->title_role = gm_lane_role(walk.lane->shown.colour);
            panel->axes = true;
            panel->x = (struct gm_axis){.label = "X", .low = mesh.first, .high = mesh.first + mesh.length};
            panel->y = (struct gm_axis){.label = "t", .low = 0, .high = 0};
        }
        panel->y.low = fmin(panel->y.low, fmin(paths->times[0], view.t));
        panel->y.high = fmax(panel->y.high, fmax(timing->until, view.t));
        if (!(panel->y.high > panel->y.low)) {
            panel->y.high = panel->y.low + 1; /* the axis needs a height */
        }
        draw_paths(picture, panel, walk.lane, paths->width > 40);
    }
}

/* Returns the largest distance of a lane's series from a value. */
static double farthest(const struct gm_lane *lane, size_t series, double from)
{
    const struct gm_history *history = &lane->history;
    double largest = 0;
    for (size_t b = 0; b < history->count; b++) {
        const struct gm_bin *bin = &history->bins[b * history->series + series];
        largest = fmax(largest, fmax(bin->high - from, from - bin->low));
    }
    return largest;
}

/* The largest error so far against the number of elements, or that of the energy against the step, a line for each
   scheme. */
static void draw_convergence(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                             bool of_energy)
{
    const int error = gm_scene_observable(lanes[0]->scene, of_energy ? "energy_error" : "solution_error");
    const struct gm_axis empty = {.label = "", .scale = GM_LOG, .low = 1, .high = 0};
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_GRAPH,
                                          of_energy    ? "largest error of the energy"
                                          : error >= 0 ? "largest error at any node and step"
                                                       : "no error: the file has no exact solution, exact:");
    panel->axes = true;
    panel->x = panel->y = empty;
    panel->x.label = of_energy ? "Δt" : "elements";
    size_t series = 0;
    for (size_t i = 0; error >= 0 && i < count; i++) {
        double *line = gm_picture_memory(picture, 2 * count * sizeof *line);
        size_t made = 0, first = 0;
        while (lanes[first]->scheme != lanes[i]->scheme) {
            first++;
        }
        for (size_t k = i; first == i && k < count; k++) {
            const bool counts = lanes[k]->scheme == lanes[i]->scheme && lanes[k]->run->status == GM_OK;
            const double largest = counts ? farthest(lanes[k], (size_t)error, 0) : NAN;
            if (isfinite(largest)) {
                line[2 * made] = of_energy ? fabs(lanes[k]->run->dt) : (double)(lanes[k]->problem.n / 4 + 1);
                line[2 * made + 1] = largest;
                gm_range_add(&panel->x.low, &panel->x.high, line[2 * made]);
                gm_range_add(&panel->y.low, &panel->y.high, line[2 * made++ + 1]);
            }
        }
        if (made > 0) {
            gm_chart_line(picture, panel, gm_chart_style(series++), line, made, lanes[i]->scheme->title);
        }
    }
    gm_range_round(&panel->y.low, &panel->y.high, GM_LOG);
    panel->x.low /= 1.3;
    panel->x.high *= 1.3;
}

static const char *subtitle(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                            const struct gm_mesh_look *look)
{
    const struct gm_view view = gm_lane_view(lanes[0]);
    const struct gm_mesh mesh = gm_mesh_of(&view);
    const bool named = look->show != GM_MESH_CONVERGENCE;
    bool one_size = true, one_scheme = lanes[0]->shown.panel_name[0] && named;
    for (size_t i = 1; i < count; i++) {
        one_size &= lanes[i]->problem.n == lanes[0]->problem.n;
        one_scheme &= strcmp(lanes[i]->schemes, lanes[0]->schemes) == 0;
    }
    const bool fields = look->show == GM_MESH_ALL || look->show == GM_MESH_FIELD;
    const bool exact = isfinite(gm_mesh_exact(&view, mesh.first, view.t0)),
               later = lanes[0]->run->t != lanes[0]->t0;
    return gm_picture_text(
        picture, "%s%s%s%s%s%s%s%s%s%s", look->front,
        one_size ? gm_picture_text(picture, "%s%zu node%s", look->front[0] ? ",  " : "", mesh.points,
                                   gm_plural((double)mesh.points))
                 : "",
        gm_shared_step(picture, lanes, count), one_scheme ? ",  " : "", one_scheme ? lanes[0]->schemes : "",
        fields && (exact || later) ? ";" : "", fields && exact ? "  grey: exact" : "",
        fields && exact && later ? "," : "", fields && later ? "  red: at the start" : "",
        look->show == GM_MESH_INERTIA ? ";  ellipses: equal kinetic energy,  red: none" : "");
}

/* Draws each panel's lanes in graphs of their own, one above another, all on one scale. */
static void draw_energies(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    const int energy = gm_asked_series(picture, lanes[0]->scene, "energy");
    if (energy < 0) {
        return;
    }
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && lanes[i]->shown.panel == lanes[i - 1]->shown.panel) {
            continue;
        }
        const struct gm_graph graph = {
            .observable = "energy", .title = gm_lane_title(lanes[i]), .panel_of = lanes[i]};
        gm_draw_graphs(picture, lanes, count, &graph, 1);
        struct gm_panel *panel = picture->last;
        panel->place = GM_PLACE_STATE;
        panel->title_role = gm_lane_role(lanes[i]->shown.colour);
        panel->note =
            lanes[i]->run->status == GM_OK
                ? gm_picture_text(picture, "changes by at most %s",
                                  gm_power_text(picture, farthest(lanes[i], (size_t)energy,
                                                                  gm_start_of(lanes[i], (size_t)energy))))
                : gm_lane_failure(picture, lanes[i]);
    }
    picture->state_columns = gm_panel_count(lanes, count) > 3 ? 2 : 1;
}

void gm_mesh_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                  const struct gm_mesh_look *look)
{
    const enum gm_mesh_view show = look->show;
    picture->subtitle = subtitle(picture, lanes, count, look);
    gm_draw_clock(picture, lanes, count);
    const size_t panels = gm_panel_count(lanes, count);
    if (show == GM_MESH_CONVERGENCE || show == GM_MESH_ENERGY_ORDER) {
        draw_convergence(picture, lanes, count, show == GM_MESH_ENERGY_ORDER);
        return;
    }
    /* with many lanes only the paths are shown, the subject of the scene */
    const bool all = show == GM_MESH_ALL, both = all && panels <= 4;
    if (both || show == GM_MESH_FIELD || show == GM_MESH_INERTIA) {
        draw_fields(picture, lanes, count, look);
    }
    if (all || show == GM_MESH_PATHS) {
        draw_meshes(picture, lanes, count, !both);
    }
    /* three side by side leave no gap */
    if (both || (panels == 3 && !all)) {
        picture->state_columns = panels;
    }
    if (show == GM_MESH_ENERGY) {
        draw_energies(picture, lanes, count);
    }
    if (all) {
        picture->graphs_below = true;
        const struct gm_graph below[] = {{.observable = "energy",
                                          .title = "energy / initial energy",
                                          .relative = true,
                                          .calm_low = 0.99,
                                          .calm_high = 1.01},
                                         {.observable = "momentum_error",
                                          .highest = true,
                                          .scale = GM_LOG,
                                          .calm_low = 1e-16,
                                          .calm_high = 1e-2},
                                         {.observable = "solution_error",
                                          .scale = GM_LOG,
                                          .calm_low = 1e-4,
                                          .calm_high = 10,
                                          .floor = 1e-4}};
        for (size_t i = 0; i < GM_COUNT(below); i++) {
            if (gm_scene_observable(lanes[0]->scene, below[i].observable) >= 0) {
                gm_draw_graphs(picture, lanes, count, &below[i], 1);
            }
        }
    }
}
