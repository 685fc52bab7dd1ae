/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of user-defined fields, with the colours, texts and graphs of their files: the profiles now over the exact
   one, and every lane's field so far as a surface over space and time. */
#include <math.h>
#include <string.h>

#include "scenes/common/system/pieces.h"
#include "scenes/common/system/texts.h"
#include "scenes/field/frames.h"
#include "scenes/mesh/picture.h"

enum { DRAWN = 1600 /* most points of a profile */ };

static double end_of(const struct gm_grid1 *grid)
{
    return grid->first + grid->dx * (double)(grid->walls ? grid->points / 2 : grid->points);
}

static const char *law_name(const struct gm_field_look *look)
{
    const char *const names[] = {"energy", "momentum", look->content};
    return names[look->show - 1];
}

/* Returns true if the surface over space and time has values. */
static bool has_surface(const struct gm_lane *lane)
{
    const struct gm_entries *rows = &lane->entries[0];
    return rows->count > 0 && !isnan(rows->values[0]);
}

/* Returns the colours of a law's residuals, symmetric, up to the largest of this lane. Residuals differ by
   orders from scheme to scheme; on a common scale the small ones would be blank. */
static struct gm_field_look look_of_law(struct gm_picture *picture, const struct gm_lane *lane,
                                        const struct gm_field_look *look)
{
    double low = 0, high = 1e-16;
    const struct gm_entries *rows = &lane->entries[0];
    for (size_t k = 0; has_surface(lane) && k < rows->count * rows->width; k++) {
        high = fmax(high, fabs(rows->values[k]));
    }
    gm_range_round(&low, &high, GM_LINEAR);
    struct gm_field_look field_look = *look;
    field_look.name = gm_picture_text(picture, "residual of the local %s law", law_name(look));
    field_look.low = -high;
    field_look.high = high;
    field_look.map = GM_MAP_DIVERGING;
    return field_look;
}

/* Draws a panel for every lane: the surface so far. */
static void draw_surfaces(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                          const struct gm_field_look *shown)
{
    const bool law = shown->show != GM_SHOW_FIELD;
    for (size_t i = 0; i < count; i++) {
        const struct gm_lane *lane = lanes[i];
        const struct gm_field_look field_look = law ? look_of_law(picture, lane, shown) : *shown,
                                   *look = &field_look;
        const struct gm_entries *rows = &lane->entries[0];
        const struct gm_timing *timing = lane->parameters;
        const struct gm_grid1 *grid = &lane->problem.line;
        const char *name =
            lane->shown.colour_name[0]
                ? gm_picture_text(picture, "%s, %s", gm_lane_title(lane), lane->shown.colour_name)
                : gm_lane_title(lane);
        struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, name);
        panel->axes = true;
        panel->title_role = gm_lane_role(lane->shown.colour);
        panel->x = (struct gm_axis){.label = "x", .low = grid->first, .high = end_of(grid)};
        panel->y = (struct gm_axis){.label = "t", .low = lane->t0, .high = fmax(timing->until, lane->run->t)};
        if (!(panel->y.high > panel->y.low)) {
            panel->y.high = panel->y.low + 1;
        }
        panel->note = gm_lane_failure(picture, lane);
        if (!has_surface(lane)) {
            if (!panel->note[0] && rows->count > 0) {
                /* the note is in the empty surface: small pictures have no other line for it */
                gm_mark_text(picture, panel, (struct gm_style){.role = GM_SECONDARY, .alpha = 1},
                             (panel->x.low + panel->x.high) / 2, (panel->y.low + panel->y.high) / 2,
                             GM_ANCHOR_CENTRE, "the scheme has no such law");
            }
            continue;
        }
        panel->colour_bar = law || i + 1 == count;
        panel->colour_bar_label = look->name;
        /* the start is seen as a thin strip */
        const double thin = (panel->y.high - panel->y.low) / 200;
        const double reached = rows->times[rows->count - 1];
        const double corners[] = {grid->first, lane->t0, end_of(grid),
                                  reached > lane->t0 ? reached : lane->t0 + thin};
        gm_mark_image(picture, panel, look->map, look->low, look->high, corners, rows->values, rows->count,
                      rows->width);
        gm_mark_switches(picture, panel, lane, true);
    }
}

static void hold(struct gm_axis *axis, const double *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        gm_range_add(&axis->low, &axis->high, points[2 * i + 1]);
    }
}

/* The profile of a lane, closed by its first point a period later. */
static size_t profile(const struct gm_lane *lane, const struct gm_field_look *look, double *points)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_grid1 *grid = &lane->problem.line;
    const size_t seen = gm_grid1_seen(grid), stride = (seen + DRAWN - 1) / DRAWN;
    size_t count = 0;
    for (size_t i = 0; i < seen; i += stride, count++) {
        points[2 * count] = grid->first + grid->dx * (double)i;
        points[2 * count + 1] = look->value(&view, i);
    }
    return count;
}

static size_t exact_profile(const struct gm_lane *lane, const struct gm_field_look *look, double *points)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_grid1 *grid = &lane->problem.line;
    const size_t count = 800;
    for (size_t i = 0; i < count; i++) {
        points[2 * i] = grid->first + (end_of(grid) - grid->first) * (double)i / (double)count;
        points[2 * i + 1] = look->exact(&view, points[2 * i]);
    }
    return count;
}

/* Returns the lane whose time the clock shows. */
static const struct gm_lane *farthest(const struct gm_lane *const *lanes, size_t count)
{
    const struct gm_lane *ahead = lanes[0];
    for (size_t i = 1; i < count; i++) {
        ahead = lanes[i]->run->t > ahead->run->t ? lanes[i] : ahead;
    }
    return ahead;
}

/* Returns true if a profile goes far beyond the least range. Others then have the graph first. */
static bool is_wild(const struct gm_field_look *look, const double *points, size_t count)
{
    const double most = 0.5 * (look->high - look->low);
    bool wild = false;
    for (size_t i = 0; i < count; i++) {
        const double value = points[2 * i + 1];
        wild |= !(value >= look->low - most && value <= look->high + most);
    }
    return wild;
}

/* Draws a profile that jumps from point to point as the band that it sweeps: its line would hide all
   others. */
static void draw_band(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                      const double *points, size_t count)
{
    enum { PLACES = 160 };
    double band[4 * PLACES];
    const size_t places = count / 2 < PLACES ? count / 2 : PLACES;
    for (size_t p = 0; p < places; p++) {
        const size_t first = p * (count - 1) / places, last = (p + 1) * (count - 1) / places;
        double low = INFINITY, high = -INFINITY;
        for (size_t i = first; i <= last; i++) {
            gm_range_add(&low, &high, points[2 * i + 1]);
        }
        const double x = 0.5 * (points[2 * first] + points[2 * last]);
        double *above = &band[2 * p], *below = &band[2 * (2 * places - 1 - p)];
        above[0] = below[0] = x;
        above[1] = fmin(high, panel->y.high);
        below[1] = fmax(low, panel->y.low);
    }
    gm_mark_polygon(picture, panel, style, band, 2 * places);
}

/* Draws one graph: the current profiles of all lanes, over the exact one. A lane that froze is left out. */
static void draw_profiles(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                          const struct gm_field_look *look)
{
    const struct gm_lane *ahead = farthest(lanes, count);
    const struct gm_grid1 *grid = &ahead->problem.line;
    double *points = gm_picture_memory(picture, 2 * (DRAWN + 1) * sizeof *points);
    struct gm_panel *panel =
        gm_panel_add(picture, GM_PLACE_GRAPH,
                     gm_picture_text(picture, "%s at t = %s%s", look->name,
                                     gm_time_text(picture, ahead->run->t, ahead->run->dt),
                                     look->exact ? ", exact in grey" : ""));
    panel->axes = true;
    panel->x = (struct gm_axis){.label = "x", .low = grid->first, .high = end_of(grid)};
    panel->y = (struct gm_axis){.label = "", .low = look->low, .high = look->high};
    const double most = 0.5 * (look->high - look->low);
    for (size_t i = 0; i < count; i++) {
        if (lanes[i]->run->status == GM_OK || lanes[i] == ahead) {
            hold(&panel->y, points, profile(lanes[i], look, points));
        }
    }
    /* a profile far outside is shown in part, so that it does not flatten the others */
    panel->y.low = fmax(panel->y.low, look->low - most);
    panel->y.high = fmin(panel->y.high, look->high + most);
    gm_range_round(&panel->y.low, &panel->y.high, GM_LINEAR);
    if (look->exact) {
        const size_t made = exact_profile(ahead, look, points);
        gm_mark_line(picture, panel, (struct gm_style){GM_EXACT, 0.9, 4, GM_SOLID}, points, made, false);
    }
    for (int tame = 0; tame <= 1; tame++) {
        for (size_t i = 0; i < count; i++) {
            const size_t made = profile(lanes[i], look, points);
            const bool here = lanes[i]->run->status == GM_OK || lanes[i] == ahead;
            if (here && !is_wild(look, points, made) == tame) {
                if (tame) {
                    gm_mark_line(picture, panel, gm_lane_style(lanes[i], 1, 2), points, made, false);
                } else {
                    draw_band(picture, panel, gm_lane_style(lanes[i], 0.3, 1), points, made);
                }
            }
        }
    }
}

/* Draws the whole picture but its titles: the clock, the surfaces from track 0, the profiles and
   `graph_count` graphs over time; if a law is shown, its residual replaces the second graph. */
static void draw_field(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                       const struct gm_field_look *look, const struct gm_graph *graphs, size_t graph_count)
{
    picture->graphs_below = true;
    gm_draw_clock(picture, lanes, count);
    draw_surfaces(picture, lanes, count, look);
    if (look->show == GM_SHOW_FIELD) {
        draw_profiles(picture, lanes, count, look);
        gm_draw_graphs(picture, lanes, count, graphs, graph_count);
        return;
    }
    const struct gm_graph residual = {
        .observable = gm_picture_text(picture, "local_%s_residual", law_name(look)),
        .highest = true,
        .scale = GM_LOG,
        .calm_low = 1e-16,
        .calm_high = 1e-2,
    };
    draw_profiles(picture, lanes, count, look);
    gm_draw_graphs(picture, lanes, count, graphs, 1);
    gm_draw_graphs(picture, lanes, count, &residual, 1);
}

/* Widens a range to values, except those far beyond `most`. */
static void widen(double *low, double *high, double most, const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (fabs(values[i]) <= most) {
            gm_range_add(low, high, values[i]);
        }
    }
}

static double highest_of(const struct gm_user_field *field)
{
    return fmax(fabs(field->low), fabs(field->high));
}

/* Sets the graphs: the error, if an exact solution is known, and conserved quantities. Returns their
   number. */
static size_t graphs_of(const struct gm_user_field *field, struct gm_graph *graphs)
{
    const struct gm_graph kept = {.highest = true, .scale = GM_LOG, .calm_low = 1e-16, .calm_high = 1e-2};
    const char *const *usual = field->kind->graphs[field->solved];
    const struct gm_system_item *item;
    size_t count = 0;
    for (; count < GM_MOST_FIELD_GRAPHS &&
           (item = gm_system_item_of(&field->of_file.system, GM_WORD_GRAPH, count));
         count++) {
        graphs[count] = (struct gm_graph){.observable = item->name};
        gm_system_graph(item, &graphs[count]);
    }
    if (count > 0) {
        return count;
    }
    for (size_t i = 0; i < GM_MOST_FIELD_GRAPHS && usual[i]; i++) {
        graphs[count] = kept;
        graphs[count++].observable = usual[i];
    }
    if (field->solved) {
        graphs[0].calm_low = 1e-3;
        graphs[0].calm_high = 1;
    }
    for (size_t i = 0; i < field->of_file.observable_count && count < field->kind->graph_count; i++) {
        const struct gm_observable *observable = &field->of_file.observables[i];
        if (observable->kept && observable->evaluate == gm_field_integral) {
            graphs[count] = kept;
            graphs[count++].observable = observable->key;
        }
    }
    if (count == 0) {
        graphs[count++] = (struct gm_graph){.observable = "amplitude", .highest = true};
    }
    return count;
}

/* Returns the part of the line that a picture of profiles shows. */
static double shown_of(const struct gm_user_system *system)
{
    const struct gm_system_item *item = gm_system_item_of(system, GM_WORD_HALF_LENGTH, 0);
    return item ? gm_system_option_number(item, GM_OPTION_SHOWN, 1) : 1;
}

/* Writes the ends of the colours that the file gives; false if it gives none. */
static bool colours_of(const struct gm_user_field *field, const struct gm_view *view, double ends[2])
{
    const struct gm_system_scene *of_file = &field->of_file;
    const struct gm_system_item *colours = gm_system_item_of(&of_file->system, GM_WORD_COLOURS, 0);
    if (colours) {
        gm_system_values(&of_file->of_items[colours - of_file->system.items], view, 0, ends);
    }
    return colours != NULL;
}

void gm_field_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_system_lane *lane = lanes[0]->parameters;
    const struct gm_user_field *field = gm_user_field_of(lane);
    const struct gm_system_scene *of_file = &field->of_file;
    const struct gm_view first = gm_lane_view(lanes[0]);
    double ends[2] = {field->low, field->high};
    if (field->kind->frame_shown && lane->grid.show == field->kind->frame_shown) {
        gm_draw_moving_frame(lanes, count, picture);
        return;
    }
    const bool colours = colours_of(field, &first, ends);
    /* of colours that the file names only symmetric ones are those of signs */
    const bool crosses = field->kind->by_matrices || ends[0] <= (colours ? -1 : -0.2) * ends[1];
    const double most = fmax(fabs(ends[0]), fabs(ends[1])), margin = colours ? 0 : 0.1 * (ends[1] - ends[0]);
    struct gm_field_look look = {
        .value = field->kind->value,
        .exact = field->solved && gm_field_is_known(&first) ? field->kind->exact : NULL,
        .name = field->kind->name ? field->kind->name : of_file->system.variables[0].name,
        .content = field->kind->content,
        .low = crosses ? -most - margin : ends[0] - margin,
        .high = crosses ? most + margin : ends[1] + margin,
        .map = crosses ? GM_MAP_DIVERGING : GM_MAP_SEQUENTIAL,
        .show = lane->grid.show,
        .reach = gm_system_half_length(lane) * shown_of(&of_file->system),
    };
    const char *beyond = "";
    bool boosted = false;
    for (size_t i = 0; i < count; i++) {
        const struct gm_view view = gm_lane_view(lanes[i]);
        boosted |= field->kind->frame_shown && gm_framed_of(view.problem)->lambda != 0;
        if (lanes[i]->problem.line.walls && lane->grid.show == GM_SHOW_FIELD) {
            const struct gm_entries *rows = &lanes[i]->entries[0];
            /* a kink that comes back from a wall leads to other values than it came from */
            widen(&look.low, &look.high, 5 * most, rows->values, rows->count * rows->width);
        }
        const double longest = gm_field_longest_step(&view);
        if (fabs(view.dt) > longest) {
            beyond = gm_picture_text(picture, ",  %s is unstable beyond Δt = %.3g", lanes[i]->scheme->title,
                                     longest);
        }
    }
    const char *subtitle = gm_system_shown_text(picture, lanes, count, GM_WORD_SUBTITLE, "");
    picture->title = gm_system_shown_text(picture, lanes, count, GM_WORD_TITLE, of_file->scene.title);
    if (boosted) {
        picture->title = gm_picture_text(picture, "%s, drawn at rest", picture->title);
    }
    picture->subtitle = gm_picture_text(
        picture, "%s%s%ld points,  Δx = %g%s%s", subtitle, subtitle[0] ? ",  " : "", lane->grid.points,
        lanes[0]->problem.line.dx, gm_shared_step(picture, lanes, count), beyond);
    struct gm_graph graphs[GM_MOST_FIELD_GRAPHS];
    const size_t graph_count = graphs_of(field, graphs);
    if (field->kind->paint) {
        picture->subtitle = subtitle;
        field->kind->paint(picture, lanes, count, &look, graphs, graph_count);
    } else {
        draw_field(picture, lanes, count, &look, graphs, graph_count);
    }
}

void gm_field_draw_mesh(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    static const char *const titles[] = {[GM_MESH_ALL] = "%s",
                                         [GM_MESH_FIELD] = "%s",
                                         [GM_MESH_PATHS] = "%s: the paths",
                                         [GM_MESH_ENERGY] = "%s: the energy",
                                         [GM_MESH_CONVERGENCE] = "%s: what moving the mesh gains",
                                         [GM_MESH_ENERGY_ORDER] = "%s: the energy over steps",
                                         [GM_MESH_INERTIA] = "%s: the inertia of nodes"};
    const struct gm_user_field *field = gm_user_field_of(lanes[0]->parameters);
    const enum gm_mesh_view show =
        (enum gm_mesh_view)((const struct gm_system_lane *)lanes[0]->parameters)->grid.show;
    const bool alone = field->of_file.system.alone;
    const struct gm_view first = gm_lane_view(lanes[0]);
    const char *subtitle = gm_system_shown_text(picture, lanes, count, GM_WORD_SUBTITLE, ""),
               *means = field->wave.sine_gordon
                            ? "exact means of V"
                            : gm_picture_text(picture, "means of V by %zu of Gauss’s points",
                                              gm_user_mesh_order(&field->wave));
    double ends[2] = {field->low, field->high};
    const bool given = colours_of(field, &first, ends);
    struct gm_mesh_look look = {
        .show = show,
        .front = subtitle[0] || alone ? subtitle : means,
        .name = alone ? "v" : field->of_file.system.variables[0].name,
        .scale = field->wave.sine_gordon ? GM_PI : GM_LINEAR,
        .low = alone && !given ? 0 : ends[0],
        .high = alone && !given ? 0 : ends[1],
    };
    for (size_t i = 0; i < count && !given && alone; i++) {
        const struct gm_view view = gm_lane_view(lanes[i]);
        const size_t points = view.problem->n / 2;
        widen(&look.low, &look.high, INFINITY, view.start + points, points);
        widen(&look.low, &look.high, INFINITY, view.state + points, points);
    }
    look.high = look.high > look.low ? look.high : look.low + 1;
    for (size_t i = 0; i < count && !given && !alone; i++) {
        widen(&look.low, &look.high, 5 * highest_of(field), gm_lane_view(lanes[i]).state,
              lanes[i]->problem.n / 4);
    }
    const char *title =
        gm_system_shown_text(picture, lanes, count, GM_WORD_TITLE, field->of_file.scene.title);
    picture->title = gm_picture_text(picture, titles[show], title);
    gm_mesh_draw(lanes, count, picture, &look);
}
