/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures of rooms: their fields, graphs over time, profiles, and errors over the mesh. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/functions/functions.h"
#include "scenes/common/graph.h"
#include "scenes/flow/room_scene.h"

enum { MOST_BESIDE_GRAPHS = 4 };

static const struct gm_flow *flow_of(const struct gm_lane *lane)
{
    return gm_flow_of(&lane->problem);
}

/* A real parameter in the subtitle, by its offset in struct gm_flows; if all lanes share it, else panels show it. */
struct told {
    const char *name, *unit;
    size_t offset;
    bool nonzero; /* it is left out if it is 0 */
};

/* Returns "viscosity 0.01 m²/s,  ", or "". */
static const char *tell(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        struct told told)
{
    double value = 0;
    memcpy(&value, (const char *)lanes[0]->parameters + told.offset, sizeof value);
    bool shown = !(told.nonzero && value == 0);
    for (size_t i = 1; i < count; i++) {
        shown &= memcmp(&value, (const char *)lanes[i]->parameters + told.offset, sizeof value) == 0;
    }
    return shown ? gm_picture_text(picture, "%s %.6g%s%s,  ", told.name, value, told.unit[0] ? " " : "",
                                   told.unit)
                 : "";
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

/* Reads the next value in braces: the text before it, and its key. Returns false after the last; the text is
   the rest. */
static bool take_brace(const char *text, struct gm_span *rest, struct gm_span *before, struct gm_span *key,
                       bool *nonzero)
{
    const size_t open = gm_span_until(text, *rest, "{"),
                 close = gm_span_until(text, (struct gm_span){open, rest->end}, "}"),
                 colon = gm_span_until(text, (struct gm_span){open, close}, ":");
    *before = (struct gm_span){rest->begin, open};
    *key = (struct gm_span){open < close ? open + 1 : open, colon};
    *nonzero = colon < close;
    rest->begin = close < rest->end ? close + 1 : close;
    return open < close;
}

/* Returns a part of a room's text. */
static const char *text_of(struct gm_picture *picture, const struct gm_room *room, struct gm_span span)
{
    return gm_picture_text(picture, "%.*s", (int)(span.end - span.begin), room->system.source + span.begin);
}

/* subtitle: TEXT {key}, TEXT {key:nonzero}, and a remark after mesh and scheme, with values in braces; else what a room
   is made of. */
static const char *subtitle(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    enum { MOST_TOLD = 2 };
    const struct gm_room *room = gm_room_of(&lanes[0]->problem);
    const struct gm_user_room *user_room = gm_user_room_of(lanes[0]->parameters);
    const struct gm_system_item *item = gm_system_item_of(&room->system, GM_WORD_SUBTITLE, 0);
    const struct gm_read_line *line = gm_room_said(room, GM_WORD_SUBTITLE);
    const char *told = "", *remark = "", *source = room->system.source;
    char unit[GM_ROOM_UNIT];
    if (!line && gm_scene_parameter(&user_room->of_file.scene, "viscosity")) {
        gm_room_unit(user_room, (struct gm_powers){{2, -1, 0}}, unit);
        told = tell(picture, lanes, count,
                    (struct told){"viscosity", unit, offsetof(struct gm_flows, viscosity), false});
        told = gm_picture_text(
            picture, "%s%s", told,
            tell(picture, lanes, count,
                 (struct told){"Schmidt number", "", offsetof(struct gm_flows, schmidt), false}));
    }
    struct gm_span rest = line ? line->value : (struct gm_span){0, 0}, before, key;
    for (size_t i = 0; rest.begin < rest.end; i++) {
        bool nonzero;
        const bool filled = take_brace(source, &rest, &before, &key, &nonzero);
        const struct gm_parameter *row =
            gm_scene_parameter(&user_room->of_file.scene, text_of(picture, room, key));
        if (i < MOST_TOLD && row && row->type == GM_REAL && !remark[0]) {
            before.begin += strspn(source + before.begin, ", ");
            const char *name = text_of(picture, room, gm_span_trimmed(source, before));
            told =
                gm_picture_text(picture, "%s%s", told,
                                tell(picture, lanes, count, (struct told){name, "", row->offset, nonzero}));
        } else {
            remark = gm_picture_text(picture, "%s%s", remark, text_of(picture, room, before));
            if (filled && item->nodes[i] != GM_NO_NODE) {
                remark = gm_picture_text(picture, "%s%.4g", remark, gm_room_evaluate(room, item->nodes[i]));
            }
        }
    }
    return gm_picture_text(picture, "%s%s%s", told, mesh_and_scheme(picture, lanes, count), remark);
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
    double *points[GM_COUNT(errors)];
    size_t made[GM_COUNT(errors)] = {0};
    for (size_t k = 0; k < GM_COUNT(errors); k++) {
        const int series = gm_scene_observable(lanes[0]->scene, errors[k].observable);
        points[k] = gm_picture_memory(picture, 2 * count * sizeof *points[k]);
        for (size_t i = 0; series >= 0 && i < count; i++) {
            const double x = flow_of(lanes[i])->complex->mean_edge,
                         e = gm_lane_observe(lanes[i], (size_t)series);
            if (e > 0) {
                points[k][2 * made[k]] = x;
                points[k][2 * made[k]++ + 1] = e;
                gm_range_add(&panel->x.low, &panel->x.high, x);
                gm_range_add(&panel->y.low, &panel->y.high, e);
            }
        }
    }
    gm_range_round(&panel->y.low, &panel->y.high, GM_LOG);
    panel->x.low *= 0.8;
    panel->x.high *= 2.6; /* space for the names on the right */
    for (size_t k = 0; k < GM_COUNT(errors); k++) {
        if (made[k] == 0) {
            continue;
        }
        const struct gm_style style = {gm_lane_role(k), 1, 2, gm_lane_dash(k)};
        gm_mark_line(picture, panel, style, points[k], made[k], false);
        gm_mark_points(picture, panel, (struct gm_style){.role = gm_lane_role(k), .alpha = 1, .width = 6},
                       points[k], made[k]);
        const double *first = points[k], *last = points[k] + 2 * (made[k] - 1);
        const double slope = made[k] > 1 ? gm_log(first[1] / last[1]) / gm_log(first[0] / last[0]) : NAN;
        const char *name =
            made[k] > 1 ? gm_picture_text(picture, "%s, order %.2f", errors[k].name, slope) : errors[k].name;
        gm_mark_text(picture, panel, (struct gm_style){.role = gm_lane_role(k), .alpha = 1, .width = 1},
                     first[0] * 1.04, first[1], GM_ANCHOR_LEFT, name);
    }
}

/* The unit of the clock: the first word after the formula of a line time:, or else the room's unit of time. */
static const char *clock_unit(struct gm_picture *picture, const struct gm_lane *lane)
{
    const struct gm_user_system *system = &gm_room_of(&lane->problem)->system;
    const char *text = system->texts[GM_WORD_TIME];
    char unit[GM_ROOM_UNIT];
    if (!text) {
        gm_room_unit(gm_user_room_of(lane->parameters), (struct gm_powers){{0, 1, 0}}, unit);
        return gm_picture_text(picture, "%s", unit);
    }
    return gm_picture_text(picture, "%.*s",
                           gm_system_item_of(system, GM_WORD_TIME, 0) ? (int)strcspn(text, ", ") : 0, text);
}

/* Chooses graph number i: of the file's lines graph:, or else what is usual. Returns false without it. */
static bool choose_graph(struct gm_picture *picture, const struct gm_lane *lane, size_t i,
                         struct gm_graph *graph)
{
    const struct gm_room *room = gm_room_of(&lane->problem);
    const struct gm_user_room *user_room = gm_user_room_of(lane->parameters);
    const struct gm_scene *scene = lane->scene;
    if (gm_room_said(room, GM_WORD_GRAPH)) {
        const struct gm_system_item *item = gm_system_item_of(&room->system, GM_WORD_GRAPH, i);
        graph->observable = item ? gm_picture_text(picture, "%s", item->name) : "";
        graph->calm_low = item && item->count > 0 ? gm_room_evaluate(room, item->nodes[0]) : 0;
        graph->calm_high = item && item->count > 0 ? gm_room_evaluate(room, item->nodes[1]) : 0;
        if (!item || (item->count > 0 && !(graph->calm_low < graph->calm_high))) {
            return false;
        }
    } else {
        const bool heat = flow_of(lane)->heat, named = user_room->room.system.texts[GM_WORD_SCALAR];
        const char *const usual[] = {heat    ? "temperature_mean"
                                     : named ? "scalar_mean"
                                             : "scalar_total",
                                     heat ? "kinetic_energy" : "scalar_outflow"};
        graph->observable = !heat && user_room->forces[i] ? user_room->forces[i] : usual[i];
    }
    const int observable = gm_scene_observable(scene, graph->observable);
    graph->scale = observable >= 0 && scene->observables[observable].logarithmic ? GM_LOG : GM_LINEAR;
    return observable >= 0;
}

static void draw_graphs(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    /* a steady state has no time: its corrections are counted */
    const bool steady = is_steady(lanes, count);
    const char *plain = clock_unit(picture, lanes[0]),
               *unit = strchr(plain, '/') ? gm_picture_text(picture, "(%s)", plain) : plain;
    struct gm_graph graph = {
        .time_label = steady    ? "corrections"
                      : unit[0] ? gm_picture_text(picture, "t / %s", unit)
                                : "t",
        .time_unit = steady ? fabs(lanes[0]->run->dt) : 0,
    };
    for (size_t i = 0; i < 2 && choose_graph(picture, lanes[0], i, &graph); i++) {
        gm_draw_graphs(picture, lanes, count, &graph, 1);
    }
}

/* Draws the clock, except for steady states, which have no time. */
static void draw_clock(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    const char *unit = clock_unit(picture, lanes[0]);
    gm_draw_clock(picture, lanes, count);
    if (is_steady(lanes, count)) {
        picture->clock = "";
    } else if (unit[0]) {
        picture->clock = gm_picture_text(picture, "%s %s", picture->clock, unit);
    }
}

/* Returns about the largest scalar that sources produce: twice its value in the air that leaves. */
static double enriched(const struct gm_flow *flow)
{
    double sum = 0, through = 0;
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        sum += flow->source[v];
    }
    for (size_t i = 0; i < flow->openings; i++) {
        through += flow->opening[i].inlet ? flow->opening[i].flow : 0;
    }
    return through > 0 ? 2 * sum / through : 0;
}

/* Sets what the field of lane 0 and those beside it look like: by its flow, and by lines of its file. */
static void choose_look(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        struct gm_look *look)
{
    const struct gm_user_room *user_room = gm_user_room_of(lanes[0]->parameters);
    const struct gm_flow *flow = flow_of(lanes[0]);
    const struct gm_room *room = gm_room_of(&lanes[0]->problem);
    static const struct {
        int show;
        const char *name;
        struct gm_powers powers;
    } shown[] = {{GM_SHOW_VORTICITY, "vorticity ω", {{0, -1, 0}}},
                 {GM_SHOW_SPEED, "speed |u|", {{1, -1, 0}}},
                 {GM_SHOW_PRESSURE, "total pressure", {{2, -2, 0}}},
                 {GM_SHOW_TEMPERATURE, "temperature", {{0, 0, 1}}}};
    char unit[GM_ROOM_UNIT + 8];
    const double *range = flow->temperature_range,
                 warm[2] = {range[0], range[1] > range[0] ? range[1] : range[0] + 1};
    const char *scalar = user_room->room.system.texts[GM_WORD_SCALAR];
    double high = 0;
    for (size_t k = 0; k < count; k++) {
        const struct gm_flow *other = flow_of(lanes[k]);
        high = fmax(high, fmax(other->theta_high, enriched(other)));
    }
    /* a quarter of the speed of free fall by buoyancy: the largest of convection in a closed room */
    const double size = sqrt(flow->complex->total_area),
                 speed = fmax(flow->speed, sqrt(fabs(flow->buoyancy) * (warm[1] - warm[0]) * size) / 4);
    const bool named = !room->rectangular;
    const char **sides = named ? gm_picture_memory(picture, (room->count + 1) * sizeof *sides) : NULL;
    for (size_t i = 0; sides && i < room->count; i++) {
        sides[i + 1] = gm_picture_text(picture, "%s", room->lines[i].name);
    }
    const struct gm_system_item *item = gm_system_item_of(&room->system, GM_WORD_LEVELS, 0);
    *look = (struct gm_look){
        .sides = sides,
        .scalar_high = high > 0 ? high : 1,
        .temperature = {warm[0], warm[1]},
        .names = {[GM_SHOW_SCALAR] = scalar ? scalar : "concentration θ"},
        .vorticity_range = 6 * speed / fmax(flow->inlet_length, size / 10),
        .speed_high = 1.2 * speed,
        .levels = item ? item->options->numbers : NULL,
        .level_count = item ? item->options->count : 0,
    };
    for (size_t c = 0; c < 2 && (named || user_room->room.system.texts[GM_WORD_UNITS]); c++) {
        gm_room_beside_unit(user_room, (struct gm_powers){{1, 0, 0}}, unit);
        look->axes[c] = gm_picture_text(picture, "%c%s", "xy"[c], unit);
    }
    for (size_t i = 0; i < GM_COUNT(shown); i++) {
        gm_room_beside_unit(user_room, shown[i].powers, unit);
        look->names[shown[i].show] = gm_picture_text(picture, "%s%s", shown[i].name, unit);
    }
    for (size_t i = 0; (item = gm_system_item_of(&room->system, GM_WORD_COLOURS, i)); i++) {
        *(strcmp(item->name, "speed") == 0 ? &look->speed_high : &look->vorticity_range) = item->value;
    }
}

/* Returns true if the room has profiles of a quantity. */
static bool has_profiles(const struct gm_room *room)
{
    const struct gm_system_item *item;
    bool drawn = false;
    for (size_t i = 0; (item = gm_system_item_of(&room->system, GM_WORD_PROFILE, i)); i++) {
        drawn |= item->words[0] != 0;
    }
    return drawn;
}

void gm_room_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_flows *flows = lanes[0]->parameters;
    const struct gm_room *room = gm_room_of(&lanes[0]->problem);
    const bool profiles = has_profiles(&flows->room->room);
    struct gm_look look;
    picture->title = lanes[0]->scene->title;
    picture->subtitle = subtitle(picture, lanes, count);
    picture->graphs_below = true;
    draw_clock(picture, lanes, count);
    if (flows->show == GM_SHOW_CONVERGENCE && gm_room_line(room, GM_ROOM_EXACT)) {
        draw_convergence(picture, lanes, count);
        return;
    }
    if (flows->show == GM_SHOW_PROFILES && profiles) {
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
    const bool graphs = count <= MOST_BESIDE_GRAPHS && flows->show != GM_SHOW_NONE;
    choose_look(picture, lanes, count, &look);
    gm_flow_draw_fields(picture, lanes, count, &look, graphs);
    if (graphs && profiles && room->rectangular && !gm_room_said(room, GM_WORD_GRAPH)) {
        gm_room_draw_profiles(lanes, count, picture, GM_PLACE_GRAPH);
    } else if (graphs) {
        draw_graphs(picture, lanes, count);
    }
}
