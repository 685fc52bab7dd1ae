/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The picture of a user-defined system: bodies and rods, or the phase plane, with the past faint behind the
   present; the section; conserved and observed quantities. */
#include <math.h>
#include <string.h>

#include "scenes/common/graph.h"
#include "scenes/common/symbol.h"
#include "scenes/common/system/texts.h"
#include "scenes/ode/system/optional.h"
#include "scenes/ode/system/parts.h"

enum { MOST_GRAPHS = 3, TOLD_PARAMETERS = 4 };

/* A path of many points with a longer mean chord, relative to the panel, is drawn as dots: it is not known
   between them. */
static const double longest_chord = 0.05;

static const struct gm_system_lane *own_of(const struct gm_lane *lane)
{
    return lane->parameters;
}

/* Returns a panel's name, "k_1 = 2, Verlet", with typeset keys and titles of schemes. */
static const char *typeset_name(struct gm_picture *picture, const char *name)
{
    const char *text = "";
    while (name && *name) {
        const size_t length = strcspn(name, ","), key = strcspn(name, "=");
        const char *comma = name[length] ? "," : "";
        if (key < length) {
            text = gm_picture_text(picture, "%s%s%.*s%s", text,
                                   gm_typeset(picture, gm_picture_text(picture, "%.*s", (int)key, name)),
                                   (int)(length - key), name + key, comma);
        } else {
            text = gm_picture_text(picture, "%s%.*s%s", text, (int)length, name, comma);
        }
        name += length + (name[length] == ',');
    }
    return text;
}

/* ---- the range that is shown ---- */

static const struct gm_seen nothing = {{1, 1, 1}, {0, 0, 0}, 0, false};

static void hold(struct gm_seen *seen, const double *points, size_t count, size_t dimensions)
{
    for (size_t i = 0; i < count; i++) {
        double square = 0;
        for (size_t k = 0; k < dimensions; k++) {
            const double x = points[i * dimensions + k];
            gm_range_add(&seen->low[k], &seen->high[k], x);
            square += x * x;
        }
        seen->far = isfinite(square) ? fmax(seen->far, sqrt(square)) : seen->far;
    }
}

static double extent(const struct gm_seen *seen)
{
    return fmax(fmax(seen->high[0] - seen->low[0], seen->high[1] - seen->low[1]),
                seen->high[2] - seen->low[2]);
}

/* Returns the range of all that a lane has shown up to now, without its levels. */
static struct gm_seen lane_range(const struct gm_lane *lane, const struct gm_paths *paths, double *numbers)
{
    const struct gm_sight *sight = paths->sight;
    struct gm_seen range = nothing;
    const struct gm_view view = gm_lane_view(lane);
    const size_t dimensions = sight->dimensions;
    hold(&range, paths->past.points, paths->past.count * sight->bodies, dimensions);
    hold(&range, paths->trail.points, paths->trail.count * sight->bodies, dimensions);
    for (size_t i = 0; i < paths->member_count; i++) {
        hold(&range, paths->members[i].points, paths->members[i].count * sight->bodies, dimensions);
    }
    if (gm_system_is_disc(lane, sight)) {
        const struct gm_entries *shapes = &lane->entries[GM_TRACK_SHAPES];
        hold(&range, shapes->values, shapes->count * shapes->width / 2, 2);
    }
    const size_t m = view.problem->m, stride = 1 + m / 512;
    for (size_t member = 0; member < m; member += stride) {
        gm_sight_values(sight, &view, m - 1 - member, numbers);
        hold(&range, numbers, gm_sight_numbers(sight) / dimensions, dimensions);
    }
    if (sight->over_time) {
        range.low[0] = range.high[0] = 0; /* its axis is the one of all times */
    }
    return range;
}

static void hold_range(struct gm_seen *range, const struct gm_seen *other)
{
    for (size_t k = 0; k < 3 && other->low[k] <= other->high[k]; k++) {
        gm_range_add(&range->low[k], &range->high[k], other->low[k]);
        gm_range_add(&range->low[k], &range->high[k], other->high[k]);
    }
    range->far = fmax(range->far, other->far);
}

/* Returns true if two lanes have the same system from the same start. */
static bool is_same(const struct gm_lane *a, const struct gm_lane *b)
{
    const struct gm_system_lane *one = own_of(a), *other = own_of(b);
    return one->owner == other->owner && one->members == other->members && one->spread == other->spread &&
           one->shape == other->shape &&
           memcmp(one->values, other->values,
                  (one->owner->row_count - GM_SYSTEM_ROWS) * sizeof *one->values) == 0;
}

/* Returns true if two lanes have the same levels. */
static bool have_same_levels(const struct gm_lane *a, const struct gm_lane *b)
{
    return gm_lane_view(a).t == gm_lane_view(b).t && is_same(a, b) &&
           memcmp(a->start, b->start, gm_active_count(&a->problem) * sizeof *a->start) == 0;
}

/* Adds the closed levels around its start to the range of each lane. */
static void hold_levels(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        const struct gm_paths *paths, struct gm_seen *ranges)
{
    struct gm_seen *levels = gm_picture_memory(picture, count * sizeof *levels);
    for (size_t i = 0; i < count; i++) {
        const struct gm_sight *sight = paths[i].sight;
        size_t like = 0;
        while (like < i && !(paths[like].sight == sight && have_same_levels(lanes[like], lanes[i]))) {
            like++;
        }
        levels[i] = like < i ? levels[like] : nothing;
        if (like == i && sight->dimensions == 2) {
            gm_system_hold_levels(picture, lanes[i], sight, &levels[i]);
        }
        hold_range(&ranges[i], &levels[i]);
    }
}

/* A lane has left if its range exceeds the smallest one of its system by this factor: its panel follows it on
   a scale of its own, and the others are drawn without it. */
static const double farthest = 2;

static void find_left(const struct gm_lane *const *lanes, size_t count, struct gm_seen *ranges)
{
    for (size_t i = 0; i < count; i++) {
        double least = extent(&ranges[i]);
        for (size_t k = 0; k < count; k++) {
            const bool ended = lanes[k]->run->status != GM_OK && i != k; /* it has shown less */
            const bool seen = ranges[k].high[0] >= ranges[k].low[0] && !ended;
            least = seen && is_same(lanes[k], lanes[i]) ? fmin(least, extent(&ranges[k])) : least;
        }
        ranges[i].left = extent(&ranges[i]) > fmax(farthest * least, 1e-9);
    }
}

/* Returns the common range of all lanes of the system of lane `like`, so that growth and decay are seen side
   by side; its own range if it has left. */
static struct gm_seen range_like(const struct gm_lane *const *lanes, size_t count, size_t like,
                                 const struct gm_seen *ranges)
{
    struct gm_seen all = ranges[like];
    for (size_t i = 0; i < count && !all.left; i++) {
        if (!ranges[i].left && is_same(lanes[i], lanes[like])) {
            hold_range(&all, &ranges[i]);
        }
    }
    return all;
}

/* Lanes of different systems, or starts, share a scale, unless their ranges differ by a larger factor. */
static const double largest_ratio = 4;

/* Replaces the range of every lane by the range of its panel. */
static void set_ranges(const struct gm_lane *const *lanes, size_t count, struct gm_seen *ranges)
{
    struct gm_seen *seen = ranges + count, all = nothing;
    double least = INFINITY, most = 0;
    bool alike = true;
    find_left(lanes, count, ranges);
    for (size_t i = 0; i < count; i++) {
        alike = alike && own_of(lanes[i])->owner == own_of(lanes[0])->owner;
        seen[i] = range_like(lanes, count, i, ranges);
        if (!seen[i].left) {
            hold_range(&all, &seen[i]);
            least = fmin(least, extent(&seen[i]));
            most = fmax(most, extent(&seen[i]));
        }
    }
    for (size_t i = 0; i < count; i++) {
        bool left = true; /* all lanes of the panel */
        for (size_t k = 0; k < count; k++) {
            left = left && (seen[k].left || lanes[k]->shown.panel != lanes[i]->shown.panel);
        }
        ranges[i] = left || !alike || most > largest_ratio * least ? nothing : all;
        ranges[i].left = left;
        for (size_t k = 0; k < count; k++) {
            if (lanes[k]->shown.panel == lanes[i]->shown.panel && seen[k].left == left) {
                hold_range(&ranges[i], &seen[k]);
            }
        }
    }
}

/* Sets bounds that move outwards in steps of an eighth of the range, about. */
static void set_axis(struct gm_picture *picture, struct gm_axis *axis, const char *label, bool angle,
                     double low, double high)
{
    const double size = fmax(fabs(low), fabs(high)), round_off = 1e-12 * size;
    /* a state at rest has no width of its own */
    const double width = high - low > round_off ? 1.06 * (high - low) : size > 0 ? size : 1;
    const double step = ldexp(1, ilogb(width)) / 8, margin = (width - (high - low)) / 2;
    *axis = (struct gm_axis){.label = label ? gm_typeset(picture, label) : "",
                             .low = step * floor((low - margin) / step),
                             .high = step * ceil((high + margin) / step)};
    if (angle) {
        *axis = (struct gm_axis){.label = axis->label, .scale = GM_PI, .low = -M_PI, .high = M_PI};
    }
}

static void wrap(const struct gm_sight *sight, double *point)
{
    for (size_t k = 0; k < 2; k++) {
        point[k] -= sight->angles[k] ? 2 * M_PI * round(point[k] / (2 * M_PI)) : 0;
    }
}

/* ---- paths ---- */

/* The panel of a lane: a plane, or a view of space. */
struct stage {
    struct gm_picture *picture;
    struct gm_panel *panel;
    const struct gm_space *space; /* NULL: a plane */
};

/* The opacity and width of what moves, in a plane and in space, where the distance fades and thins it. */
enum { FAINT, BRIGHT, DOTS, FEW_DOTS, RECENT, START, ROD, BODY, BODY_OF_ROD, LOOKS };
static const struct {
    double alpha, width;
} looks[2][LOOKS] = {
    {{0.3, 1.1}, {0.95, 2.2}, {0.25, 1.6}, {0.8, 3.6}, {0.95, 2}, {0.9, 5}, {0.8, 3}, {1, 10}, {1, 13}},
    {{0.55, 1.4}, {0.95, 2.6}, {0.4, 1.8}, {0.8, 4.2}, {0.95, 2.6}, {0.9, 6}, {0.9, 3.6}, {1, 12}, {1, 15}}};

static struct gm_style style_of(const struct stage *stage, enum gm_role role, int look)
{
    const int in_space = stage->space ? 1 : 0;
    return (struct gm_style){role, looks[in_space][look].alpha, looks[in_space][look].width, GM_SOLID};
}

static void put_line(const struct stage *stage, struct gm_style style, bool fades, const double *points,
                     size_t count)
{
    if (stage->space) {
        const struct gm_stroke_in_space stroke = {.style = style, .fades = fades};
        gm_space_line(stage->picture, stage->panel, stage->space, stroke, points, count);
    } else if (fades) {
        gm_draw_trail(stage->picture, stage->panel, style, points, count);
    } else {
        gm_mark_line(stage->picture, stage->panel, style, points, count, false);
    }
}

static void put_points(const struct stage *stage, struct gm_style style, const double *points, size_t count)
{
    if (stage->space) {
        gm_space_points(stage->picture, stage->panel, stage->space, style, points, count);
    } else {
        gm_mark_points(stage->picture, stage->panel, style, points, count);
    }
}

/* Writes the path of a body from entry `first` on, and its current point; broken at jumps, also of an angle.
   Returns the number of points, at most twice the entries and two. */
static size_t path_of(const struct gm_path *path, const struct gm_sight *sight, size_t body, size_t first,
                      const double *now, double *points)
{
    const size_t dimensions = sight->dimensions;
    size_t count = 0;
    for (size_t i = first; i <= path->count; i++) {
        double point[3];
        memcpy(point, (i < path->count ? path->points + i * path->width : now) + dimensions * body,
               dimensions * sizeof *point);
        wrap(sight, point);
        if (i > first && i < path->count && path->times[i] == path->times[i - 1]) {
            for (size_t k = 0; k < dimensions; k++) {
                points[dimensions * count + k] = NAN;
            }
            count++;
        }
        for (size_t k = 0; k < 2 && count > 0; k++) {
            if (sight->angles[k] && fabs(point[k] - points[2 * count - 2 + k]) > M_PI) {
                points[2 * count] = points[2 * count + 1] = NAN;
                count++;
                break;
            }
        }
        memcpy(points + dimensions * count, point, dimensions * sizeof *point);
        count++;
    }
    return count;
}

/* Writes a chord relative to the panel and returns its length; NAN at a jump. */
static double chord_before(const struct stage *stage, const double *points, size_t i, double chord[3])
{
    const struct gm_axis *x = &stage->panel->x, *y = &stage->panel->y;
    const size_t dimensions = stage->space ? 3 : 2;
    const double deep = stage->space ? stage->space->front - stage->space->back : 1;
    const double sizes[] = {stage->space ? deep : x->high - x->low, stage->space ? deep : y->high - y->low,
                            deep};
    double square = 0;
    chord[2] = 0;
    for (size_t k = 0; k < dimensions; k++) {
        chord[k] = (points[dimensions * i + k] - points[dimensions * (i - 1) + k]) / sizes[k];
        square += chord[k] * chord[k];
    }
    return isfinite(square) ? sqrt(square) : NAN;
}

/* A path of fewer points is drawn as a line if it turns little, else as points that are seen one by one. */
enum { FEW = 60 };

/* Returns true if no chord turns by more than 30 degrees from the one before, as in a flow with long steps. */
static bool turns_little(const struct stage *stage, const double *points, size_t count)
{
    double before[3] = {0}, length_before = 0;
    bool little = true;
    for (size_t i = 1; i < count; i++) {
        double chord[3];
        const double length = chord_before(stage, points, i, chord),
                     along = before[0] * chord[0] + before[1] * chord[1] + before[2] * chord[2];
        little = little && !(along < 0.866 * length * length_before);
        memcpy(before, chord, sizeof before);
        length_before = length;
    }
    return little;
}

/* Returns true if chords are short enough to be seen as a curve. */
static bool is_dense(const struct stage *stage, const double *points, size_t count)
{
    double sum = 0;
    size_t chords = 0;
    for (size_t i = 1; i < count; i++) {
        double chord[3];
        const double length = chord_before(stage, points, i, chord);
        sum += isfinite(length) ? length : 0;
        chords += isfinite(length);
    }
    return chords == 0 || sum < longest_chord * (double)(stage->space ? count : chords);
}

/* Returns the first entry of the past where the path is bright: a part of the whole run. */
static size_t bright_from(const struct gm_lane *lane)
{
    const double bright = 0.15;
    const struct gm_entries *past = &lane->entries[GM_TRACK_PAST];
    const struct gm_timing *timing = lane->parameters;
    const double whole = timing->until < GM_NEVER ? timing->until - lane->t0 : lane->run->t - lane->t0;
    size_t first = past->count;
    while (first > 0 && past->times[first - 1] > lane->run->t - bright * whole) {
        first--;
    }
    return past->count - first < 24 ? (past->count > 24 ? past->count - 24 : 0) : first;
}

/* Returns the first entry of a track that trails= lets be drawn. */
static size_t trail_from(const struct gm_lane *lane, size_t track)
{
    return gm_trails_from(own_of(lane)->trails, &lane->entries[track], lane->run->t);
}

static void draw_path(const struct stage *stage, const struct gm_lane *lane, const struct gm_paths *paths,
                      size_t body, const double *now)
{
    const struct gm_sight *sight = paths->sight;
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    const size_t past = trail_from(lane, GM_TRACK_PAST),
                 bright = bright_from(lane) > past ? bright_from(lane) : past;
    const size_t most = paths->past.count > paths->trail.count ? paths->past.count : paths->trail.count;
    double *points = gm_picture_memory(stage->picture, 3 * (2 * most + 4) * sizeof *points);
    const size_t count = path_of(&paths->past, sight, body, past, now, points);
    if (is_dense(stage, points, count) || (count < FEW && turns_little(stage, points, count))) {
        put_line(stage, style_of(stage, role, FAINT), false, points, count);
        const size_t end = path_of(&paths->past, sight, body, bright, now, points);
        put_line(stage, style_of(stage, role, BRIGHT), true, points, end);
        return;
    }
    put_points(stage, style_of(stage, role, count < FEW ? FEW_DOTS : DOTS), points, count);
    const size_t trail = trail_from(lane, GM_TRACK_TRAIL), half = paths->trail.count / 2;
    const size_t recent = path_of(&paths->trail, sight, body, trail > half ? trail : half, now, points);
    if (is_dense(stage, points, recent)) {
        put_line(stage, style_of(stage, role, RECENT), true, points, recent);
    }
}

/* Draws all members, if they are not a disc. */
static void draw_members(const struct stage *stage, const struct gm_lane *lane, const struct gm_sight *sight,
                         double *numbers)
{
    const struct gm_view view = gm_lane_view(lane);
    const size_t m = view.problem->m, shown = m - 1 < 4096 ? m - 1 : 4096, dimensions = sight->dimensions;
    const struct gm_style style = {gm_lane_role(lane->shown.colour), 0.6, shown > 400 ? 2 : 4, GM_SOLID};
    double *points = gm_picture_memory(stage->picture, dimensions * (shown + 1) * sizeof *points);
    for (size_t body = 0; body < sight->bodies; body++) {
        for (size_t i = 0; i < shown; i++) {
            gm_sight_values(sight, &view, i * (m - 1) / shown, numbers);
            wrap(sight, numbers + dimensions * body);
            memcpy(points + dimensions * i, numbers + dimensions * body, dimensions * sizeof *points);
        }
        put_points(stage, style, points, shown);
    }
}

/* Draws the bodies that are at rest, or those that move. */
static void draw_bodies(const struct stage *stage, const struct gm_sight *sight, struct gm_style style,
                        bool fixed, const double *numbers)
{
    const size_t dimensions = sight->dimensions;
    double *points = gm_picture_memory(stage->picture, (dimensions * sight->bodies + 1) * sizeof *points);
    size_t count = 0;
    for (size_t body = 0; body < sight->bodies; body++) {
        if (sight->fixed[body] == fixed) {
            double *point = points + dimensions * count++;
            memcpy(point, numbers + dimensions * body, dimensions * sizeof *points);
            wrap(sight, point);
        }
    }
    put_points(stage, style, points, count);
}

static void draw_lane(const struct stage *stage, const struct gm_lane *lane, const struct gm_paths *paths,
                      double *numbers)
{
    const struct gm_sight *sight = paths->sight;
    const struct gm_view view = gm_lane_view(lane);
    struct gm_view before = view;
    before.state = view.start;
    before.t = view.t0;
    const enum gm_role role = gm_lane_role(lane->shown.colour);
    if (gm_system_is_disc(lane, sight)) {
        gm_system_draw_shapes(stage->picture, stage->panel, lane);
        return;
    }
    if (lane->problem.m > 1) {
        draw_members(stage, lane, sight, numbers);
    }
    gm_sight_values(sight, &before, gm_system_centre(&before), numbers);
    draw_bodies(stage, sight, style_of(stage, GM_INITIAL, START), false, numbers);
    gm_sight_values(sight, &view, gm_system_centre(&view), numbers);
    for (size_t body = 0; body < sight->bodies; body++) {
        if (!sight->fixed[body]) {
            draw_path(stage, lane, paths, body, numbers);
        }
    }
    for (size_t rod = 0; rod < sight->rods; rod++) {
        const double *ends = numbers + sight->dimensions * (sight->bodies + 2 * rod);
        if (stage->space) {
            gm_space_segment(stage->picture, stage->panel, stage->space, style_of(stage, GM_INK, ROD), ends,
                             ends + 3);
        } else {
            put_line(stage, style_of(stage, GM_INK, ROD), false, ends, 2);
        }
    }
    const int look = sight->rods > 0 ? BODY_OF_ROD : BODY; /* bodies that move are in front */
    draw_bodies(stage, sight, style_of(stage, GM_SECONDARY, look), true, numbers);
    draw_bodies(stage, sight, style_of(stage, role, look), false, numbers);
}

/* Returns true if both axes are positions, or nearly of one size, and so have one unit. */
static bool is_equal(const struct gm_sight *sight, const struct gm_panel *panel)
{
    const double wide = panel->x.high - panel->x.low, tall = panel->y.high - panel->y.low;
    const bool around = (sight->angles[0] && wide == 2 * M_PI) || (sight->angles[1] && tall == 2 * M_PI);
    return !sight->over_time && !around &&
           (strcmp(sight->name, "view") == 0 || (wide > 0.4 * tall && wide < 2.5 * tall));
}

static void set_plane(struct gm_picture *picture, struct gm_panel *panel, const struct gm_walk *walk,
                      const struct gm_sight *sight, const struct gm_seen *range)
{
    const bool is_wide = gm_system_has_portrait(walk->lane->parameters, sight);
    for (size_t k = 0; k < 2; k++) {
        const double margin = is_wide ? (range->high[k] - range->low[k]) / 8 : 0;
        struct gm_axis *axis = k ? &panel->y : &panel->x;
        const bool part = gm_system_is_disc(walk->lane, sight) && range->low[k] > -3 && range->high[k] < 3;
        set_axis(picture, axis, sight->labels[k], sight->angles[k] && !part, range->low[k] - margin,
                 range->high[k] + margin);
        axis->scale = sight->angles[k] ? GM_PI : axis->scale;
    }
    if (sight->over_time) {
        gm_time_axis(&panel->x, walk->lanes, walk->count);
    }
    struct gm_window window;
    if (gm_system_window(walk->lane->parameters, sight, &window)) {
        for (size_t k = 0; k < 2; k++) {
            struct gm_axis *axis = k ? &panel->y : &panel->x;
            axis->low = window.low[k];
            axis->high = window.high[k];
        }
    }
    panel->axes = sight->labels[0] != NULL;
    panel->equal = is_equal(sight, panel);
}

/* Adds the panel of the walk; a panel of all lanes has the name of their scheme. */
static struct gm_panel *add_panel(struct gm_picture *picture, const struct gm_walk *walk, const char *note)
{
    struct gm_panel *panel = gm_walk_panel(picture, walk, note);
    const bool all = walk->count > 1 && gm_panel_count(walk->lanes, walk->count) == 1;
    panel->title = all && gm_one_scheme(walk->lanes, walk->count) ? walk->lane->scheme->title
                                                                  : typeset_name(picture, panel->title);
    return panel;
}

/* Returns the current value of the first graph, if that shows the greatest of every stretch of time, or its ratio to
   the start's, if it shows that. */
static const char *value_now(struct gm_picture *picture, const struct gm_lane *lane)
{
    const struct gm_system_item *item = gm_system_item_of(&own_of(lane)->owner->system, GM_WORD_GRAPH, 0);
    const bool relative = item && gm_system_option(item, GM_OPTION_RELATIVE);
    if (!item || (!relative && !gm_system_option(item, GM_OPTION_HIGHEST))) {
        return "";
    }
    const size_t series = (size_t)gm_scene_observable(lane->scene, item->name);
    const struct gm_observable *observable = gm_scene_observable_at(lane->scene, series);
    const double value = gm_lane_observe(lane, series);
    if (isnan(value)) {
        return relative && observable->of_members ? "edge not resolved" : "";
    }
    return relative ? gm_picture_text(picture, "%s × %.3f", gm_typeset(picture, observable->key),
                                      value / gm_start_of(lane, series))
                    : gm_picture_text(picture, "%s now %s", observable->title, gm_power_text(picture, value));
}

/* Returns the sight and the paths of a lane. */
static struct gm_paths paths_of(struct gm_picture *picture, const struct gm_lane *lane)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_sight *sight = gm_system_curves(picture, lane);
    const size_t followed = sight->over_time ? gm_system_followed(&view) : 0;
    struct gm_path *members = gm_picture_memory(picture, (followed + 1) * sizeof *members);
    for (size_t i = 0; i < followed; i++) {
        members[i] = gm_system_path(picture, lane, GM_TRACK_MEMBERS, i, sight);
    }
    return (struct gm_paths){.sight = sight,
                             .past = gm_system_path(picture, lane, GM_TRACK_PAST, 0, sight),
                             .trail = gm_system_path(picture, lane, GM_TRACK_TRAIL, 0, sight),
                             .members = members,
                             .member_count = followed};
}

/* The levels that a panel shows, as marks. */
struct shown_levels {
    const struct gm_lane *lane;
    const struct gm_sight *sight;
    const struct gm_panel *panel;
    const struct gm_mark *first, *last;
};

static bool has_same_axes(const struct gm_panel *a, const struct gm_panel *b)
{
    return a->x.low == b->x.low && a->x.high == b->x.high && a->y.low == b->y.low && a->y.high == b->y.high;
}

/* Draws the levels of a lane, or repeats those of a panel before. */
static void draw_levels(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                        const struct gm_sight *sight, struct shown_levels *shown)
{
    const struct gm_mark *before = panel->last;
    if (shown->sight == sight && has_same_axes(shown->panel, panel) && have_same_levels(shown->lane, lane)) {
        gm_marks_repeat(picture, panel, shown->first, shown->last);
        return;
    }
    gm_system_draw_levels(picture, panel, lane, sight);
    *shown = (struct shown_levels){lane, sight, panel, before ? before->next : panel->first, panel->last};
}

static void draw_states(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    size_t most = 0;
    struct gm_seen *ranges = gm_picture_memory(picture, 2 * count * sizeof *ranges);
    struct gm_paths *paths = gm_picture_memory(picture, count * sizeof *paths);
    for (size_t i = 0; i < count; i++) {
        paths[i] = paths_of(picture, lanes[i]);
        const size_t own = gm_sight_numbers(paths[i].sight);
        most = own > most ? own : most;
    }
    double *numbers = gm_picture_memory(picture, (most + 1) * sizeof *numbers);
    for (size_t i = 0; i < count; i++) {
        ranges[i] = lane_range(lanes[i], &paths[i], numbers);
    }
    hold_levels(picture, lanes, count, paths, ranges);
    set_ranges(lanes, count, ranges);
    struct gm_panel *panel = NULL;
    const struct gm_lane *leader = NULL; /* the first lane of the panel */
    struct shown_levels levels = {0};
    struct gm_space space;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        const size_t lane = walk.next - 1;
        const struct gm_sight *sight = paths[lane].sight;
        const struct gm_view view = gm_lane_view(walk.lane);
        if (walk.first) {
            const struct gm_seen range = ranges[lane];
            panel = add_panel(picture, &walk,
                              range.left ? "on a scale of its own" : value_now(picture, walk.lane));
            if (sight->dimensions == 3) {
                const char *names[3];
                for (size_t k = 0; k < 3; k++) {
                    names[k] = gm_typeset(picture, sight->labels[k]);
                }
                space = gm_system_space(picture, panel, walk.lane, &range, names);
            } else {
                set_plane(picture, panel, &walk, sight, &range);
            }
        }
        if (walk.first && gm_system_has_portrait(walk.lane->parameters, sight)) {
            gm_system_draw_portrait(picture, panel, walk.lane);
        }
        if (sight->dimensions == 2 && (walk.first || !is_same(walk.lane, leader))) {
            draw_levels(picture, panel, walk.lane, sight, &levels);
        }
        leader = walk.first ? walk.lane : leader;
        if (sight->dimensions == 3) {
            gm_system_take_surfaces(picture, walk.lane, &space);
            draw_lane(&(struct stage){picture, panel, &space}, walk.lane, &paths[lane], numbers);
        } else if (sight->over_time) {
            gm_sight_values(sight, &view, gm_system_centre(&view), numbers);
            gm_system_draw_curves(picture, panel, &walk, &paths[lane], numbers);
        } else {
            draw_lane(&(struct stage){picture, panel, NULL}, walk.lane, &paths[lane], numbers);
        }
    }
}

/* ---- section and graphs ---- */

static void set_section(struct gm_picture *picture, struct gm_panel *panel,
                        const struct gm_lane *const *lanes, size_t count)
{
    const struct gm_sight *sight = &own_of(lanes[0])->owner->section;
    struct gm_seen range = nothing;
    for (size_t i = 0; i < count; i++) {
        gm_system_hold_levels(picture, lanes[i], sight, &range);
    }
    const bool bounded = range.low[0] <= range.high[0]; /* a lane beyond the level has left */
    for (size_t i = 0; i < count && !bounded; i++) {
        const struct gm_entries *crossings = &lanes[i]->entries[GM_TRACK_SECTION];
        hold(&range, crossings->values, crossings->count, 2);
    }
    for (size_t k = 0; k < 2; k++) {
        const bool empty = range.low[k] > range.high[k];
        set_axis(picture, k ? &panel->y : &panel->x, sight->labels[k], sight->angles[k],
                 empty ? -1 : range.low[k], empty ? 1 : range.high[k]);
    }
    panel->axes = true;
    panel->equal = gm_system_has_level(own_of(lanes[0])->owner, sight) && is_equal(sight, panel);
}

static void draw_crossings(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane)
{
    const struct gm_sight *sight = &own_of(lane)->owner->section;
    const struct gm_entries *crossings = &lane->entries[GM_TRACK_SECTION];
    double *points = gm_picture_memory(picture, 2 * (crossings->count + 1) * sizeof *points);
    for (size_t i = 0; i < crossings->count; i++) {
        memcpy(points + 2 * i, crossings->values + 2 * i, 2 * sizeof *points);
        wrap(sight, points + 2 * i);
    }
    const double width = crossings->count < 60 ? 5 : crossings->count < 1000 ? 3.2 : 2.2;
    gm_mark_points(picture, panel, (struct gm_style){gm_lane_role(lane->shown.colour), 0.75, width, GM_SOLID},
                   points, crossings->count);
}

static void draw_section(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    const bool driven = own_of(lanes[0])->owner->stroboscopic;
    struct gm_panel *panel =
        gm_panel_add(picture, GM_PLACE_GRAPH, driven ? "Stroboscopic section" : "Poincaré section");
    panel->title_role = GM_INK;
    set_section(picture, panel, lanes, count);
    gm_system_draw_levels(picture, panel, lanes[0], &own_of(lanes[0])->owner->section);
    for (size_t i = 0; i < count; i++) {
        draw_crossings(picture, panel, lanes[i]);
    }
}

static void draw_sections(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    struct gm_panel *panel = NULL;
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        if (walk.first) {
            panel = add_panel(picture, &walk, "");
            set_section(picture, panel, lanes, count);
            gm_system_draw_levels(picture, panel, walk.lane, &own_of(walk.lane)->owner->section);
        }
        draw_crossings(picture, panel, walk.lane);
    }
}

/* Draws the graph of an observable; `item` is its line graph:, or NULL. */
static void draw_number(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        const struct gm_observable *observable, const struct gm_system_item *item)
{
    const bool log = observable->error || observable->logarithmic;
    struct gm_graph graph = {
        .observable = observable->key, .scale = log ? GM_LOG : GM_LINEAR, .highest = log};
    graph.title = log ? NULL : gm_typeset(picture, observable->title);
    graph.calm_low = log ? 1e-8 : 0;
    graph.calm_high = log ? 1e-4 : 0;
    if (item) {
        const bool unit = !observable->error && observable->unit[0];
        graph.title =
            unit ? gm_picture_text(picture, "%s, %s", observable->title, observable->unit) : graph.title;
        gm_system_graph(item, &graph);
    }
    gm_draw_graphs(picture, lanes, count, &graph, 1);
}

/* Draws the graphs that the file names, or else conserved quantities first, then others. */
static void draw_numbers(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                         size_t most)
{
    const struct gm_scene *scene = lanes[0]->scene;
    const struct gm_user_system *system = &own_of(lanes[0])->owner->system;
    const struct gm_system_item *item;
    for (size_t i = 0; (item = gm_system_item_of(system, GM_WORD_GRAPH, i)); i++) {
        const int series = gm_scene_observable(scene, item->name);
        draw_number(picture, lanes, count, gm_scene_observable_at(scene, (size_t)series), item);
        most = 0;
    }
    const bool disc = lanes[0]->problem.m > 3 && own_of(lanes[0])->shape == GM_SHAPE_DISC;
    const struct gm_events *events = lanes[0]->problem.events;
    for (int kept = 1; kept >= 0; kept--) {
        for (size_t i = 0; i < scene->observable_count && most > 0; i++) {
            const struct gm_observable *observable = &scene->observables[i];
            const bool of_disc = strncmp(observable->key, "area", 4) == 0;
            const bool swings = strcmp(observable->key, "energy") == 0; /* it does not compare schemes */
            const bool repeats = events && events->written == 1 &&
                                 strncmp(observable->key, "events_", 7) == 0; /* the number of all events */
            if (observable->kept != (kept == 1) || (of_disc && (!disc || !observable->kept)) || swings ||
                repeats) {
                continue;
            }
            draw_number(picture, lanes, count, observable, NULL);
            most--;
        }
    }
}

/* Draws the graph that show= names alone, in a panel for each lane. */
static void draw_alone(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                       const struct gm_system_item *item)
{
    const size_t series = (size_t)gm_scene_observable(lanes[0]->scene, item->name);
    struct gm_graph graph = {.observable = item->name, .named = true};
    gm_system_graph(item, &graph);
    const char *title = graph.title ? graph.title : gm_error_title(picture, lanes, count, series);
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        if (walk.first) {
            graph.title = gm_picture_text(picture, "%s: %s", gm_lane_title(walk.lane), title);
            graph.panel_of = walk.lane;
            gm_draw_graphs(picture, lanes, count, &graph, 1);
        }
    }
}

/* "m = 1,  Δt = 0.01": the values that all lanes share. */
static const char *told(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    const struct gm_system_scene *system_scene = own_of(lanes[0])->owner;
    const char *text = "";
    char number[64];
    size_t shown = 0;
    for (size_t row = 0; row < system_scene->row_count && shown < TOLD_PARAMETERS; row++) {
        const struct gm_parameter *parameter = &system_scene->rows[row];
        const double value = gm_parameter_get(parameter, lanes[0]->parameters);
        bool same = gm_system_is_parameter(system_scene, row);
        for (size_t i = 1; i < count; i++) {
            same &= value == gm_parameter_get(parameter, lanes[i]->parameters);
        }
        if (same) {
            gm_number_format(value, number, sizeof number);
            const bool plain = value == 0 || (fabs(value) >= 1e-3 && fabs(value) < 1e6);
            if (strlen(number) > 12 && plain) {
                snprintf(number, sizeof number, "%.6g", value);
            }
            text = gm_picture_text(
                picture, "%s%s%s = %s%s%s", text, shown ? ",  " : "", gm_typeset(picture, parameter->key),
                strlen(number) > 12 ? gm_power_text(picture, value) : gm_typeset(picture, number),
                parameter->unit[0] ? " " : "", parameter->unit);
            shown++;
        }
    }
    if (gm_one_step(lanes, count)) {
        text = gm_picture_text(picture, "%s%sΔt = %s", text, shown ? ",  " : "",
                               gm_step_text(picture, lanes[0]->run->dt));
    }
    return text;
}

/* Returns the line whose picture the lane's show= names alone; NULL: it names none. */
static const struct gm_system_item *alone_of(const struct gm_system_lane *lane)
{
    const struct gm_user_system *system = &lane->owner->system;
    size_t i = 0;
    while (i < system->item_count &&
           strcmp(gm_system_option_text(&system->items[i], GM_OPTION_SHOW, ""), lane->show) != 0) {
        i++;
    }
    return i < system->item_count ? &system->items[i] : NULL;
}

void gm_system_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct gm_system_lane *lane = own_of(lanes[0]);
    const struct gm_system_scene *system_scene = lane->owner;
    const struct gm_system_item *alone = alone_of(lane);
    const bool graph_alone = alone && alone->word == GM_WORD_GRAPH;
    const bool one_scheme = gm_one_scheme(lanes, count);
    const bool only_section =
        system_scene->has_section && strcmp(lane->show, system_scene->section.name) == 0;
    const char *name = gm_system_title(&system_scene->system)
                           ? system_scene->scene.title
                           : gm_typeset(picture, system_scene->scene.title);
    if (gm_draw_modified(lanes, count, picture)) {
        return;
    }
    picture->title = gm_system_shown_text(picture, lanes, count, GM_WORD_TITLE, NULL);
    const struct gm_system_item *title = gm_system_item_of(&system_scene->system, GM_WORD_TITLE, 0);
    if (!picture->title || !strstr(title->text, "{schemes}")) {
        picture->title =
            gm_picture_text(picture, "%s, by %s", picture->title ? picture->title : name,
                            one_scheme ? lanes[0]->scheme->title : gm_counted_schemes(lanes, count));
    }
    picture->subtitle = gm_picture_text(
        picture, "%s%s",
        gm_system_shown_text(picture, lanes, count, GM_WORD_SUBTITLE, told(picture, lanes, count)),
        graph_alone ? "" : gm_system_level_text(picture, lanes, count));
    picture->caption =
        gm_system_shown_text(picture, lanes, count, GM_WORD_CAPTION, system_scene->scene.watch);
    if (gm_system_has_portrait(lane, gm_system_sight(lane))) {
        picture->caption = ""; /* the portrait adds its legend */
    }
    picture->graphs_below = true;
    gm_draw_clock(picture, lanes, count);
    if (graph_alone) {
        draw_alone(picture, lanes, count, alone);
        return;
    }
    if (only_section) {
        draw_sections(picture, lanes, count);
    } else {
        draw_states(picture, lanes, count);
    }
    if (alone) {
        return;
    }
    /* if there is space for one graph only, it is the section of driven motion or at events, else a conserved quantity */
    const bool section =
                   system_scene->has_section && strcmp(lane->show, system_scene->shows[GM_SHOW_ALL]) == 0,
               section_first = system_scene->stroboscopic || system_scene->at_event;
    if (section && section_first) {
        draw_section(picture, lanes, count);
    }
    draw_numbers(picture, lanes, count, MOST_GRAPHS - (system_scene->has_section && !only_section ? 1 : 0));
    if (section && !section_first) {
        draw_section(picture, lanes, count);
    }
}
