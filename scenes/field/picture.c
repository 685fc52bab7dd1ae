/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The pictures of user-defined fields, with the colours, texts and graphs of their files. */
#include <math.h>
#include <string.h>

#include "scenes/common/system/pieces.h"
#include "scenes/common/system/texts.h"
#include "scenes/field/frames.h"
#include "scenes/mesh/picture.h"

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
        gm_draw_field(picture, lanes, count, &look, graphs, graph_count);
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
               *means = field->wave.known ? "exact means of V"
                                          : gm_picture_text(picture, "means of V by %zu of Gauss’s points",
                                                            gm_user_mesh_order(&field->wave));
    double ends[2] = {field->low, field->high};
    const bool given = colours_of(field, &first, ends);
    struct gm_mesh_look look = {
        .show = show,
        .front = subtitle[0] || alone ? subtitle : means,
        .name = alone ? "v" : field->of_file.system.variables[0].name,
        .scale = field->wave.known == GM_POTENTIAL_SINE_GORDON ? GM_PI : GM_LINEAR,
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
