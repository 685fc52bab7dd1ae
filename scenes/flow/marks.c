/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Marks over the field of a flow: streamlines, walls, the mesh, tracers, arrows, names. */
#include "scenes/common/graph.h"
#include "scenes/flow/look.h"

#include <math.h>
#include <string.h>

enum { MOST_LEVELS = 64 };

static const struct gm_flow *flow_of(const struct gm_lane *lane)
{
    return gm_flow_of(&lane->problem);
}

bool gm_flow_is_signed(int show)
{
    return show == GM_SHOW_VORTICITY || show == GM_SHOW_PRESSURE;
}

void gm_flow_draw_streamlines(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                              const struct gm_flow_sheet *sheet, const struct gm_look *look)
{
    const struct gm_flows *flows = lane->parameters;
    const bool over = flows->show != GM_SHOW_NONE && !gm_flow_is_signed(flows->show);
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
void gm_flow_draw_walls(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow)
{
    const struct gm_complex *complex = flow->complex;
    double *points = gm_picture_memory(picture, 6 * (complex->boundary + 1) * sizeof *points);
    size_t count = 0;
    for (size_t b = 0; points && b < complex->boundary; b++) {
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
    if (points) {
        gm_mark_line(picture, panel, (struct gm_style){GM_INK, 1, 2.2, GM_SOLID}, points, count, false);
    }
}

void gm_flow_draw_grid(struct gm_picture *picture, struct gm_panel *panel, const struct gm_complex *complex,
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

void gm_flow_draw_tracers(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
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
    const enum gm_role role = over ? GM_OVER : GM_INK;
    gm_mark_line(picture, panel, (struct gm_style){role, 0.55, 1.5, GM_SOLID}, tails, 3 * met, false);
    gm_mark_points(picture, panel, (struct gm_style){.role = role, .alpha = 0.85, .width = 2.4}, dots, met);
}

void gm_flow_draw_arrows(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
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
        const double arrow[2] = {velocities[2 * v] / speed * cell * 0.9,
                                 velocities[2 * v + 1] / speed * cell * 0.9};
        gm_arrow(x, z, arrow, lines + 2 * count);
        count += 7;
    }
    gm_mark_line(picture, panel, (struct gm_style){over ? GM_OVER : GM_INK, 0.9, 1.3, GM_SOLID}, lines, count,
                 false);
}

void gm_flow_opening_outward(const struct gm_flow *flow, const struct gm_opening *opening, double outward[2],
                             double middle[2])
{
    const struct gm_complex *complex = flow->complex;
    size_t e = opening->first;
    for (size_t k = 0; k < opening->count; k++) {
        e = gm_complex_next(complex, e);
    }
    /* outside is on the right of the opening's direction */
    const double *a = complex->point + 2 * complex->boundary_vertex[opening->first],
                 *b = complex->point + 2 * complex->boundary_vertex[e];
    outward[0] = b[1] - a[1];
    outward[1] = a[0] - b[0];
    middle[0] = (a[0] + b[0]) / 2;
    middle[1] = (a[1] + b[1]) / 2;
}

void gm_flow_name_openings(struct gm_picture *picture, struct gm_panel *panel, const struct gm_flow *flow,
                           const char *const *names, double size)
{
    const struct gm_style style = {.role = GM_INK, .alpha = 1, .width = 1};
    for (size_t i = 0; i < flow->openings; i++) {
        const struct gm_opening *opening = &flow->opening[i];
        double outward[2], middle[2];
        gm_flow_opening_outward(flow, opening, outward, middle);
        const double x = outward[0], z = outward[1];
        const bool upright = fabs(x) >= fabs(z);
        const double away = (upright ? 0.012 : 0.028) * size / hypot(x, z);
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
