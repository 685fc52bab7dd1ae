/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A user-defined system in space: paths, rods and bodies, before and behind its surfaces. */
#include "scenes/ode/system/space.h"

#include <math.h>
#include <string.h>

#include "core/functions/functions.h"
#include "scenes/common/graph.h"

/* A path with a longer mean chord, relative to the panel, is drawn as dots: it is not known between them. */
static const double longest_chord = 0.05;
/* The length of axes out of a surface, as a multiple of its size. */
static const double axes_reach = 1.18;

static const struct gm_system_lane *own_of(const struct gm_lane *lane)
{
    return lane->parameters;
}

static struct gm_view at_start(const struct gm_lane *lane)
{
    struct gm_view view = gm_lane_view(lane);
    view.state = view.start;
    view.t = view.t0;
    return view;
}

static void take_surfaces(struct gm_picture *picture, const struct gm_lane *lane, struct gm_space *space)
{
    const struct gm_tape *tape = &own_of(lane)->owner->surfaces;
    const struct gm_view before = at_start(lane);
    struct gm_ellipsoid *surfaces = gm_picture_memory(picture, (tape->outputs + 1) * sizeof *surfaces);
    double sizes[3 * GM_MOST_SURFACES];
    space->surface_count = surfaces ? tape->outputs / 3 : 0;
    space->surfaces = surfaces;
    if (space->surface_count > 0) {
        gm_system_values(tape, &before, gm_system_centre(&before), sizes);
    }
    for (size_t i = 0; i < space->surface_count; i++) {
        memcpy(surfaces[i].axes, sizes + 3 * i, sizeof surfaces[i].axes);
    }
}

/* Returns the longest half axis. */
static double size_of(const struct gm_space *space)
{
    double size = 0;
    for (size_t i = 0; i < 3 * space->surface_count; i++) {
        size = fmax(size, space->surfaces[i / 3].axes[i % 3]);
    }
    return size;
}

/* Sets bounds that move outwards in steps of an eighth of the largest range, about; a flat range stays
   flat. */
static void set_box(struct gm_space *space, const struct gm_seen *seen)
{
    double width = 0, size = 0;
    for (size_t k = 0; k < 3; k++) {
        width = fmax(width, seen->high[k] - seen->low[k]);
        size = fmax(size, fmax(fabs(seen->low[k]), fabs(seen->high[k])));
    }
    const bool moves = width > 1e-12 * size;
    width = moves ? 1.06 * width : size > 0 ? size : 1;
    const double step = ldexp(1, (int)floor(gm_log2(width))) / 8, margin = moves ? 0.03 * width : 0.5 * width;
    for (size_t k = 0; k < 3; k++) {
        const bool empty = seen->low[k] > seen->high[k];
        const double low = empty ? 0 : seen->low[k], high = empty ? 0 : seen->high[k];
        const bool flat = moves && high - low < 1e-9 * width;
        space->low[k] = flat ? low : step * floor((low - margin) / step);
        space->high[k] = flat ? low : step * ceil((high + margin) / step);
    }
}

struct gm_space gm_system_space(struct gm_picture *picture, struct gm_panel *panel,
                                const struct gm_lane *lane, const struct gm_seen *seen,
                                const char *const names[3])
{
    const struct gm_camera *camera = &own_of(lane)->camera;
    struct gm_space space = {0};
    take_surfaces(picture, lane, &space);
    set_box(&space, seen);
    gm_space_turn(&space, camera, lane->run->t - lane->t0);
    const double size = size_of(&space), step = size / 8;
    if (space.surface_count == 0) {
        gm_space_fit(&space, camera, 0, panel);
        gm_space_draw_box(picture, panel, &space, names);
        return space;
    }
    const double reach = axes_reach * fmax(size, step * ceil((seen->far - 0.02 * size) / step));
    gm_space_fit(&space, camera, reach, panel);
    gm_space_draw_surfaces(picture, panel, &space);
    gm_space_draw_axes(picture, panel, &space, reach, names);
    return space;
}

/* ---- moving parts ---- */

/* Returns true if chords are short enough in the panel to be seen as a curve. */
static bool is_curve(const struct gm_space *space, const double *points, size_t count)
{
    double sum = 0;
    for (size_t i = 1; i < count; i++) {
        double square = 0;
        for (size_t k = 0; k < 3; k++) {
            const double step = points[3 * i + k] - points[3 * i - 3 + k];
            square += step * step;
        }
        sum += sqrt(square);
    }
    return !(sum >= longest_chord * (space->front - space->back) * (double)count);
}

/* Writes the path of a body from entry `first` on, and its current point. Returns the number of points. */
static size_t path_of(const struct gm_path *path, size_t body, size_t first, const double *now,
                      double *points)
{
    for (size_t i = first; i <= path->count; i++) {
        const double *at = i < path->count ? path->points + i * path->width : now;
        memcpy(points + 3 * (i - first), at + 3 * body, 3 * sizeof *points);
    }
    return path->count + 1 - first;
}

/* Draws the paths of all moving bodies, which are at `now`. */
static void draw_paths(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                       const struct gm_lane *lane, const struct gm_paths *paths, const double *now)
{
    const struct gm_sight *sight = paths->sight;
    const struct gm_path *past = &paths->past, *trail = &paths->trail;
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    const struct gm_stroke_in_space faint = {.style = {role, 0.55, 1.4, GM_SOLID}},
                                    bright = {.style = {role, 0.95, 2.6, GM_SOLID}, .fades = true};
    const size_t most = past->count > trail->count ? past->count : trail->count,
                 faint_from = gm_system_trail_from(lane, GM_TRACK_PAST),
                 bright_from = gm_system_bright_from(lane),
                 from = bright_from > faint_from ? bright_from : faint_from,
                 trail_from = gm_system_trail_from(lane, GM_TRACK_TRAIL);
    double *points = gm_picture_memory(picture, 3 * (most + 1) * sizeof *points);
    for (size_t body = 0; points && past->count > 0 && body < sight->bodies; body++) {
        if (sight->fixed[body]) {
            continue;
        }
        const size_t count = path_of(past, body, faint_from, now, points);
        if (is_curve(space, points, count)) {
            gm_space_line(picture, panel, space, faint, points, count);
            gm_space_line(picture, panel, space, bright, points, path_of(past, body, from, now, points));
            continue;
        }
        gm_space_points(picture, panel, space, (struct gm_style){.role = role, .alpha = 0.4, .width = 1.8},
                        points, count);
        const size_t recent =
            path_of(trail, body, trail_from > trail->count / 2 ? trail_from : trail->count / 2, now, points);
        if (is_curve(space, points, recent)) {
            gm_space_line(picture, panel, space, bright, points, recent);
        }
    }
}

/* Draws all members. */
static void draw_members(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                         const struct gm_lane *lane, const struct gm_sight *sight, double *numbers)
{
    const struct gm_view view = gm_lane_view(lane);
    const size_t m = view.problem->m, shown = m - 1 < 4096 ? m - 1 : 4096;
    double *points = gm_picture_memory(picture, 3 * (shown + 1) * sizeof *points);
    for (size_t body = 0; points && body < sight->bodies; body++) {
        for (size_t i = 0; i < shown; i++) {
            gm_system_values(&sight->tape, &view, i * (m - 1) / shown, numbers);
            memcpy(points + 3 * i, numbers + 3 * body, 3 * sizeof *points);
        }
        gm_space_points(
            picture, panel, space,
            (struct gm_style){gm_lane_role(lane->shown.colour), 0.6, shown > 400 ? 2 : 4, GM_SOLID}, points,
            shown);
    }
}

/* Writes the bodies that are at rest, or those that move. Returns their number. */
static size_t choose_bodies(const struct gm_sight *sight, const double *numbers, bool fixed, double *points)
{
    size_t count = 0;
    for (size_t body = 0; body < sight->bodies; body++) {
        if (sight->fixed[body] == fixed) {
            memcpy(points + 3 * count++, numbers + 3 * body, 3 * sizeof *points);
        }
    }
    return count;
}

void gm_system_draw_in_space(struct gm_picture *picture, struct gm_panel *panel, struct gm_space *space,
                             const struct gm_lane *lane, const struct gm_paths *paths)
{
    const struct gm_sight *sight = paths->sight;
    const struct gm_view view = gm_lane_view(lane), before = at_start(lane);
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    double *points = gm_picture_memory(picture, (3 * sight->bodies + 1) * sizeof *points);
    double *numbers = gm_picture_memory(picture, (gm_sight_numbers(sight) + 1) * sizeof *numbers);
    if (!points || !numbers) {
        return;
    }
    take_surfaces(picture, lane, space);
    if (lane->problem.m > 1) {
        draw_members(picture, panel, space, lane, sight, numbers);
    }
    gm_system_values(&sight->tape, &before, gm_system_centre(&before), numbers);
    gm_space_points(picture, panel, space, (struct gm_style){.role = GM_INITIAL, .alpha = 0.9, .width = 6},
                    points, choose_bodies(sight, numbers, false, points));
    gm_system_values(&sight->tape, &view, gm_system_centre(&view), numbers);
    draw_paths(picture, panel, space, lane, paths, numbers);
    for (size_t rod = 0; rod < sight->rods; rod++) {
        const double *ends = numbers + 3 * sight->bodies + 6 * rod;
        gm_space_segment(picture, panel, space, (struct gm_style){GM_INK, 0.9, 3.6, GM_SOLID}, ends,
                         ends + 3);
    }
    for (int fixed = 1; fixed >= 0; fixed--) { /* bodies that move are in front */
        const struct gm_style style = {fixed ? GM_SECONDARY : role, 1, sight->rods > 0 ? 15 : 12, GM_SOLID};
        const size_t count = choose_bodies(sight, numbers, fixed == 1, points);
        gm_space_points(picture, panel, space, style, points, count);
    }
}
