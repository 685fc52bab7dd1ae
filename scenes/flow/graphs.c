/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Graphs of flows: what is measured over time, and errors over meshes. */
#include <math.h>
#include <string.h>

#include "scenes/flow/marks.h"
#include "scenes/frame/graph.h"

/* Errors against the mean edge length, a point for each lane. */
void gm_flow_draw_convergence(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                              const struct gm_look *look)
{
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
    panel->axes = true;
    panel->x = (struct gm_axis){.label = "mean edge length", .scale = GM_LOG, .low = 1, .high = 0};
    panel->y = (struct gm_axis){.label = "relative error", .scale = GM_LOG, .low = 1, .high = 0};
    double *points = gm_picture_memory(picture, 2 * (count + 1) * sizeof *points);
    for (int drawn = 0; points && drawn < 2; drawn++) {
        for (size_t k = 0; look->errors[k].observable; k++) {
            const int series = gm_asked_series(picture, lanes[0]->scene, look->errors[k].observable);
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

static bool is_logarithmic(const struct gm_scene *scene, const char *key)
{
    const int observable = gm_scene_observable(scene, key);
    return observable >= 0 && scene->observables[observable].logarithmic;
}

void gm_flow_draw_graphs(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                         const struct gm_look *look)
{
    /* a steady state has no time: its corrections are counted */
    const bool steady = gm_flow_is_steady(lanes, count);
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
        gm_draw_graph(picture, lanes, count, &graph, -1, false);
    }
}
