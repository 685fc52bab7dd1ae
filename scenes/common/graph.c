/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Parts of the pictures of all scenes: clocks, names of lanes, trails, graphs of observables. */
#include "scenes/common/graph.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/functions/functions.h"

/* True if the step is a simple fraction of pi: then times are written so. */
static bool counts_in_pi(double dt)
{
    for (int denominator = 1; denominator <= 24; denominator++) {
        const double times = fabs(dt) * denominator / M_PI;
        if (times >= 0.5 && fabs(times - round(times)) < 1e-12) {
            return true;
        }
    }
    return false;
}

/* "3π/4"; NULL if t is not such a fraction, or dt is not */
static const char *in_pi(struct gm_picture *picture, double t, double dt)
{
    for (int denominator = 1; counts_in_pi(dt) && denominator <= 24; denominator++) {
        const double times = round(t * denominator / M_PI);
        if (fabs(times) > 9999 || fabs(times * M_PI / denominator - t) > 1e-9 * fmax(1, fabs(t))) {
            continue;
        }
        if (times == 0) {
            return "0";
        }
        const char *sign = times < 0 ? "−" : "";
        const char *front = fabs(times) == 1 ? "" : gm_picture_text(picture, "%.0f", fabs(times));
        const char *under = denominator == 1 ? "" : gm_picture_text(picture, "/%d", denominator);
        return gm_picture_text(picture, "%s%sπ%s", sign, front, under);
    }
    return NULL;
}

const char *gm_step_text(struct gm_picture *picture, double dt)
{
    const char *fraction = in_pi(picture, dt, dt);
    return fraction ? fraction : gm_picture_text(picture, "%s%.4g", dt < 0 ? "−" : "", fabs(dt));
}

const char *gm_shared_step(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    return gm_one_step(lanes, count)
               ? gm_picture_text(picture, ",  Δt = %s", gm_step_text(picture, lanes[0]->run->dt))
               : "";
}

const char *gm_time_text(struct gm_picture *picture, double t, double dt)
{
    const char *fraction = in_pi(picture, t, dt);
    if (fraction) {
        return fraction;
    }
    /* decimals that show a step, so that digits stay while time runs */
    int decimals = (int)ceil(-gm_log10(fabs(dt)) + 0.5);
    decimals = decimals < 1 ? 1 : decimals > 6 ? 6 : decimals;
    const bool below = t < -0.5 * gm_pow(10, -decimals); /* a value that rounds to zero has no sign */
    return gm_picture_text(picture, "%s%.*f", below ? "−" : "", decimals, fabs(t));
}

void gm_draw_clock(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count)
{
    /* the lane that is farthest; running lanes before failed ones */
    const struct gm_lane *ahead = lanes[0];
    for (size_t i = 1; i < count; i++) {
        const bool goes = lanes[i]->run->status == GM_OK, went = ahead->run->status == GM_OK;
        const bool further = fabs(lanes[i]->run->t - lanes[i]->t0) > fabs(ahead->run->t - ahead->t0);
        ahead = goes != went ? (goes ? lanes[i] : ahead) : further ? lanes[i] : ahead;
    }
    picture->clock = gm_picture_text(picture, "t = %s", gm_time_text(picture, ahead->run->t, ahead->run->dt));
}

const char *gm_lane_title(const struct gm_lane *lane)
{
    return lane->shown.panel_name[0] ? lane->shown.panel_name : lane->first_scheme->title;
}

/* The name that distinguishes a lane within its panel. */
static const char *lane_name(const struct gm_lane *lane)
{
    return lane->shown.colour_name[0] ? lane->shown.colour_name : gm_lane_title(lane);
}

const char *gm_lane_failure(struct gm_picture *picture, const struct gm_lane *lane)
{
    const long lost = gm_lane_lost(lane);
    if (lost >= 0) {
        return gm_picture_text(picture, "lost: %s %s", lane->scene->observables[lost].title,
                               gm_power_text(picture, gm_lane_observe(lane, (size_t)lost)));
    }
    if (lane->run->status == GM_OK) {
        return "";
    }
    return gm_picture_text(picture, "%s at t = %s", gm_status_name(lane->run->status),
                           gm_time_text(picture, lane->run->t, lane->run->dt));
}

const char *gm_error_title(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                           size_t series)
{
    const struct gm_observable *observable = gm_scene_observable_at(lanes[0]->scene, series);
    const double divisor = gm_lane_divisor(lanes[0], series);
    for (size_t i = 1; i < count; i++) {
        if (gm_lane_divisor(lanes[i], series) != divisor) {
            char text[GM_MESSAGE];
            return gm_picture_text(picture, "%s", gm_observable_title(observable, text, sizeof text));
        }
    }
    const struct gm_view view = gm_lane_view(lanes[0]);
    const double scale = gm_observable_scale(observable, &view);
    const char *x = observable->symbol;
    const char *front = gm_picture_text(picture, "%s  |%s − %s₀|", observable->title, x, x);
    return divisor == 1      ? front
           : divisor > scale ? gm_picture_text(picture, "%s / |%s₀|", front, x)
                             : gm_picture_text(picture, "%s / %.3g", front, scale);
}

/* Names each lane of panel `p` under its title, in its own colour and dash, instead of a note on one of them. */
static void name_lanes(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *const *lanes,
                       size_t count, size_t p)
{
    for (size_t i = 0; i < count; i++) {
        if (lanes[i]->shown.panel != p) {
            continue;
        }
        panel->title_role = GM_INK;
        panel->note = "";
        const char *failure = gm_lane_failure(picture, lanes[i]);
        gm_panel_key(
            picture, panel, gm_lane_style(lanes[i], 1, 2.4),
            gm_picture_text(picture, "%s%s%s", lane_name(lanes[i]), failure[0] ? ", " : "", failure));
    }
}

struct gm_style gm_lane_style(const struct gm_lane *lane, double alpha, double width)
{
    return (struct gm_style){gm_lane_role(lane->shown.colour), alpha, width, gm_lane_dash(lane->shown.dash)};
}

const char *const gm_trails_words[] = {"yes", "no", NULL};

bool gm_trails_admit(const struct gm_parameter *row, const char *text, char *sentence)
{
    double length = 0;
    const bool is_word = strcmp(text, gm_trails_words[0]) == 0 || strcmp(text, gm_trails_words[1]) == 0;
    return is_word || (gm_number_parse(text, &length) && length > 0 && isfinite(length)) ||
           gm_refuse(sentence, "%s=%.60s is not yes, no or a time above 0", row->key, text);
}

size_t gm_trails_from(const char *text, const struct gm_entries *entries, double t)
{
    double length = INFINITY;
    size_t first = strcmp(text, gm_trails_words[1]) == 0 ? entries->count : 0;
    gm_number_parse(text, &length);
    while (first < entries->count && fabs(t - entries->times[first]) > length) {
        first++;
    }
    return first;
}

void gm_draw_trail(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                   const double *points, size_t count)
{
    enum { PIECES = 16 };
    const double alpha = style.alpha;
    for (size_t i = 0; i < PIECES; i++) {
        const size_t first = i * count / PIECES, last = (i + 1) * count / PIECES;
        const size_t end = last < count ? last + 1 : count; /* pieces meet */
        style.alpha = alpha * (0.06 + 0.94 * gm_pow((double)(i + 1) / PIECES, 2));
        if (end - first > 1) {
            gm_mark_line(picture, panel, style, points + 2 * first, end - first, false);
        }
    }
}

void gm_arrow(double x, double y, const double along[2], double points[14])
{
    const double dx = along[0], dy = along[1], tip[2] = {x + dx / 2, y + dy / 2},
                 back[2] = {tip[0] - 0.3 * dx, tip[1] - 0.3 * dy};
    memcpy(points,
           (const double[14]){x - dx / 2, y - dy / 2, tip[0], tip[1], NAN, NAN, back[0] + 0.15 * dy,
                              back[1] - 0.15 * dx, tip[0], tip[1], back[0] - 0.15 * dy, back[1] + 0.15 * dx,
                              NAN, NAN},
           sizeof(double[14]));
}

const char *gm_power_text(struct gm_picture *picture, double value)
{
    static const char *const digits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    if (value == 0 || !isfinite(value) || (fabs(value) >= 0.01 && fabs(value) < 1000)) {
        return gm_picture_text(picture, "%.2g", value);
    }
    int power = (int)floor(gm_log10(fabs(value)));
    double front = value / gm_pow(10, power);
    if (fabs(front) > 9.95) {
        front /= 10;
        power++;
    }
    const unsigned size = (unsigned)abs(power);
    return gm_picture_text(picture, "%.1f·10%s%s%s%s", front, power < 0 ? "⁻" : "",
                           size > 99 ? digits[size / 100] : "", size > 9 ? digits[size / 10 % 10] : "",
                           digits[size % 10]);
}

const char *gm_counted_schemes(const struct gm_lane *const *lanes, size_t count)
{
    static const char *const words[] = {"no scheme",    "one scheme",   "two schemes", "three schemes",
                                        "four schemes", "five schemes", "six schemes"};
    const struct gm_scheme *seen[GM_COUNT(words)];
    size_t schemes = 0;
    for (size_t i = 0; i < count; i++) {
        for (size_t s = 0; s <= lanes[i]->switch_count && schemes < GM_COUNT(words); s++) {
            size_t k = 0;
            seen[schemes] = gm_lane_scheme_after(lanes[i], s);
            while (seen[k] != seen[schemes]) {
                k++;
            }
            schemes += k == schemes;
        }
    }
    return schemes < GM_COUNT(words) ? words[schemes] : "many schemes";
}

size_t gm_panel_count(const struct gm_lane *const *lanes, size_t count)
{
    size_t panels = 0;
    for (size_t i = 0; i < count; i++) {
        panels = lanes[i]->shown.panel >= panels ? lanes[i]->shown.panel + 1 : panels;
    }
    return panels;
}

bool gm_walk_next(struct gm_walk *walk)
{
    for (; walk->panel < gm_panel_count(walk->lanes, walk->count); walk->panel++) {
        while (walk->next < walk->count) {
            walk->lane = walk->lanes[walk->next++];
            if (walk->lane->shown.panel == walk->panel) {
                walk->first = !walk->begun;
                walk->begun = true;
                return true;
            }
        }
        walk->next = 0;
        walk->begun = false;
    }
    return false;
}

struct gm_panel *gm_walk_panel(struct gm_picture *picture, const struct gm_walk *walk, const char *otherwise)
{
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, gm_lane_title(walk->lane));
    const char *failure = gm_lane_failure(picture, walk->lane);
    panel->title_role = gm_lane_role(walk->lane->shown.colour);
    panel->note = failure[0] ? failure : otherwise;
    if (!gm_lane_is_alone(walk->lanes, walk->count, walk->lane)) {
        name_lanes(picture, panel, walk->lanes, walk->count, walk->panel);
    }
    return panel;
}

bool gm_one_scheme(const struct gm_lane *const *lanes, size_t count)
{
    bool one = true;
    for (size_t i = 1; i < count; i++) {
        one &= lanes[i]->scheme == lanes[0]->scheme;
    }
    return one;
}

bool gm_one_step(const struct gm_lane *const *lanes, size_t count)
{
    bool one = true;
    for (size_t i = 1; i < count; i++) {
        one &= lanes[i]->run->dt == lanes[0]->run->dt;
    }
    return one;
}

/* Writes the history of an observable as points: one per bin while a bin is a step, then its low and high.
   Returns their number. */
static size_t history_points(const struct gm_lane *lane, size_t series, double divisor,
                             const struct gm_graph *graph, double *points)
{
    enum { TOLD_APART = 160 };
    const struct gm_history *history = &lane->history;
    const bool magnitude = graph->magnitude;
    size_t count = 0;
    if (graph->highest && history->count > TOLD_APART) {
        const size_t group = (history->count + TOLD_APART - 1) / TOLD_APART;
        for (size_t b = 0; b < history->count; b += group) {
            double highest = -INFINITY, t = 0;
            for (size_t k = b; k < b + group && k < history->count; k++) {
                const struct gm_bin *bin = &history->bins[k * history->series + series];
                const double low = magnitude ? -bin->low : bin->low;
                highest = fmax(highest, fmax(low, bin->high));
                t = bin->t;
            }
            points[2 * count] = t;
            points[2 * count + 1] = highest / divisor;
            count++;
        }
        return count;
    }
    for (size_t b = 0; b < history->count; b++) {
        const struct gm_bin *bin = &history->bins[b * history->series + series];
        if (history->per_bin == 1) {
            points[2 * count] = bin->t;
            points[2 * count + 1] = (magnitude ? fabs(bin->last) : bin->last) / divisor;
            count++;
            continue;
        }
        /* alternates, so that the line does not run back */
        double low = bin->low, high = bin->high;
        if (magnitude) {
            high = fmax(fabs(bin->low), fabs(bin->high));
            low = bin->low <= 0 && bin->high >= 0 ? 0 : fmin(fabs(bin->low), fabs(bin->high));
        }
        const double first = b % 2 ? high : low, second = b % 2 ? low : high;
        points[2 * count] = points[2 * count + 2] = bin->t;
        points[2 * count + 1] = first / divisor;
        points[2 * count + 3] = second / divisor;
        count += 2;
    }
    return count;
}

void gm_time_axis(struct gm_axis *axis, const struct gm_lane *const *lanes, size_t count)
{
    const struct gm_timing *timing = lanes[0]->parameters;
    double low = lanes[0]->t0, high = lanes[0]->t0;
    for (size_t i = 0; i < count; i++) {
        gm_range_add(&low, &high, lanes[i]->run->t);
        const struct gm_history *history = &lanes[i]->history;
        for (size_t b = 0; b < history->count; b++) {
            gm_range_add(&low, &high, history->bins[b * history->series].t);
        }
    }
    *axis = (struct gm_axis){.label = "t", .scale = counts_in_pi(lanes[0]->run->dt) ? GM_PI : GM_LINEAR};
    const double until = timing->until;
    if (low >= lanes[0]->t0 && until < GM_NEVER && high <= until + fabs(lanes[0]->run->dt) &&
        until > lanes[0]->t0) {
        high = fmax(high, until); /* the last step may end later */
    } else {
        gm_range_round(&low, &high, axis->scale);
    }
    axis->low = low;
    axis->high = high > low ? high : low + 1;
}

void gm_mark_switches(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                      bool upwards)
{
    const struct gm_axis *across = upwards ? &panel->x : &panel->y;
    for (size_t i = 0; i < lane->switch_count; i++) {
        const double t = lane->switches[i].t;
        const double up[] = {t, across->low, t, across->high}, along[] = {across->low, t, across->high, t};
        gm_mark_line(picture, panel, (struct gm_style){gm_lane_role(lane->shown.colour), 0.7, 1.2, GM_SOLID},
                     upwards ? along : up, 2, false);
    }
}

int gm_asked_series(struct gm_picture *picture, const struct gm_scene *scene, const char *key)
{
    const int series = gm_scene_observable(scene, key);
    if (series < 0) {
        gm_panel_add(picture, GM_PLACE_GRAPH, gm_picture_text(picture, GM_NO_OBSERVABLE "%s", key));
    }
    return series;
}

struct gm_style gm_chart_style(size_t index)
{
    return (struct gm_style){gm_lane_role(index), 1, 2.4, gm_lane_dash(index)};
}

void gm_chart_line(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                   const double *points, size_t count, const char *name)
{
    if (count > 0) {
        gm_mark_line(picture, panel, style, points, count, false);
        gm_mark_points(picture, panel, (struct gm_style){style.role, 1, 6, GM_SOLID}, points, count);
        gm_panel_key(picture, panel, style, name);
    }
}

double gm_start_of(const struct gm_lane *lane, size_t series)
{
    const struct gm_observable *observable = gm_scene_observable_at(lane->scene, series);
    struct gm_view view = gm_lane_view(lane);
    view.state = view.start;
    view.t = view.t0;
    return gm_observe(observable, &view);
}

bool gm_lane_is_alone(const struct gm_lane *const *lanes, size_t count, const struct gm_lane *lane)
{
    size_t sharing = 0;
    for (size_t i = 0; i < count; i++) {
        sharing += lanes[i]->shown.panel == lane->shown.panel;
    }
    return sharing == 1;
}

/* The time of the last finite value of any lane; NAN without one. */
static double last_value(const struct gm_lane *const *lanes, size_t count, size_t series)
{
    double last = NAN;
    for (size_t i = 0; i < count; i++) {
        const struct gm_history *history = &lanes[i]->history;
        for (size_t b = 0; b < history->count; b++) {
            const struct gm_bin *bin = &history->bins[b * history->series + series];
            last = isfinite(bin->high) ? fmax(last, bin->t) : last;
        }
    }
    return last;
}

/* Sets the panel's time axis; the title reports an axis that ends before the run. */
static void set_time_axis(struct gm_picture *picture, struct gm_panel *panel,
                          const struct gm_lane *const *lanes, size_t count, size_t series,
                          const struct gm_graph *graph)
{
    struct gm_axis *axis = &panel->x;
    gm_time_axis(axis, lanes, count);
    const double last = graph->to_last ? last_value(lanes, count, series) : NAN;
    if (last > axis->low && last < lanes[0]->run->t) {
        axis->high = last;
        gm_range_round(&axis->low, &axis->high, axis->scale);
        panel->title = gm_picture_text(picture, "%s  measurable up to t = %s", panel->title,
                                       gm_time_text(picture, last, lanes[0]->run->dt));
    }
    if (graph->time_label) {
        axis->label = graph->time_label;
    }
    if (graph->time_unit > 0) {
        axis->low /= graph->time_unit;
        axis->high /= graph->time_unit;
    }
}

/* If lanes of several panels share colours, dashes distinguish the panels: names the dashes. */
static void name_dashes(struct gm_picture *picture, struct gm_panel *panel,
                        const struct gm_lane *const *lanes, size_t count)
{
    bool shared = false;
    for (size_t i = 1; i < count; i++) {
        shared |= lanes[i]->shown.panel != lanes[0]->shown.panel &&
                  lanes[i]->shown.colour == lanes[0]->shown.colour;
    }
    for (size_t i = 0; shared && i < count; i++) {
        if (i == 0 || lanes[i]->shown.panel != lanes[i - 1]->shown.panel) {
            const struct gm_style style = {GM_SECONDARY, 1, 2.4, gm_lane_dash(lanes[i]->shown.dash)};
            gm_panel_key(picture, panel, style, gm_lane_title(lanes[i]));
        }
    }
}

/* Draws a line at round-off, if the panel's range comes near it. */
static void mark_roundoff(struct gm_picture *picture, struct gm_panel *panel)
{
    const double roundoff = 2.220446049250313e-16, high = panel->y.high;
    if (panel->y.scale == GM_LOG && panel->y.low < roundoff && high > roundoff) {
        /* the label is under the line, away from the errors */
        const double low = fmin(panel->y.low, roundoff * gm_pow(high / roundoff, -0.16));
        panel->y.low = low;
        const double line[] = {panel->x.low, roundoff, panel->x.high, roundoff};
        gm_mark_line(picture, panel, (struct gm_style){GM_SECONDARY, 0.6, 1, GM_SHORT_DASH}, line, 2, false);
        gm_mark_text(picture, panel, (struct gm_style){.role = GM_SECONDARY, .alpha = 1, .width = 1},
                     panel->x.high, roundoff * gm_pow(high / low, -0.07), GM_ANCHOR_RIGHT, "round-off");
    }
}

/* The end of a curve's range: the usual one, which shows that a curve has blown up, or the end of a curve
   that lies above it throughout. */
static double most_shown(const double *points, size_t made, double usual)
{
    double least = INFINITY, highest = usual;
    for (size_t k = 0; k < made; k++) {
        if (points[2 * k + 1] > 0) {
            least = fmin(least, points[2 * k + 1]);
            highest = fmax(highest, points[2 * k + 1]);
        }
    }
    return least > usual && isfinite(highest) ? highest : usual;
}

/* Writes the points of a lane's curve, t and value. Returns their number. */
static size_t curve_of(const struct gm_lane *lane, size_t series, const struct gm_graph *graph,
                       double *points)
{
    const size_t made =
        history_points(lane, series, graph->relative ? gm_start_of(lane, series) : 1, graph, points);
    for (size_t i = 0; i < made && graph->floor > 0; i++) { /* a gap of all values below the floor */
        points[2 * i + 1] = points[2 * i + 1] < graph->floor ? NAN : points[2 * i + 1];
    }
    return made;
}

/* Widens a range to the curves of the lanes that have failed, or of the others. On axes that are not logarithmic
   values of failed lanes far beyond the others are left out: beside a blow-up the others would be flat. Returns
   true if all values are exactly 0. */
static bool hold_curves(const struct gm_lane *const *lanes, size_t count, bool failed, size_t series,
                        const struct gm_graph *graph, double *points, double range[2])
{
    const bool all = !failed || graph->scale == GM_LOG || range[0] > range[1];
    const double reach = fmax(range[1] - range[0], 0.1 * fmax(fabs(range[0]), fabs(range[1]))),
                 lowest = all ? -INFINITY : range[0] - reach, highest = all ? INFINITY : range[1] + reach;
    bool exact = true;
    for (size_t i = 0; i < count; i++) {
        if ((lanes[i]->run->status != GM_OK) != failed) {
            continue;
        }
        const size_t made = curve_of(lanes[i], series, graph, points);
        exact = exact && made > 1;
        const double most = graph->highest ? most_shown(points, made, fmax(graph->calm_high, 100)) : INFINITY;
        for (size_t k = 0; k < made; k++) {
            const double value = points[2 * k + 1];
            exact = exact && value == 0;
            if ((graph->scale != GM_LOG || value > 0) && value >= lowest && value <= highest) {
                gm_range_add(&range[0], &range[1], fmin(value, most));
            }
        }
    }
    return exact;
}

/* Gives the panel the range of all curves. Returns true if all are exactly 0, which has no logarithm. */
static bool set_value_axis(struct gm_panel *panel, const struct gm_lane *const *lanes, size_t count,
                           size_t series, const struct gm_graph *graph, double *points)
{
    const bool calm = graph->calm_low != graph->calm_high;
    double range[2] = {calm ? graph->calm_low : 1, calm ? graph->calm_high : 0};
    const bool go = hold_curves(lanes, count, false, series, graph, points, range),
               failed = hold_curves(lanes, count, true, series, graph, points, range);
    gm_range_round(&range[0], &range[1], graph->scale);
    panel->y = (struct gm_axis){.label = "", .scale = graph->scale, .low = range[0], .high = range[1]};
    return lanes[0]->scene->observables[series].error && go && failed;
}

/* Draws a curve. A value between gaps is a dot, as a line without length is hardly seen. */
static void put_curve(struct gm_picture *picture, struct gm_panel *panel, struct gm_style style,
                      const double *points, size_t made)
{
    double *dots = gm_picture_memory(picture, 2 * (made + 1) * sizeof *dots);
    size_t count = 0, length = 0;
    for (size_t k = 0; k <= made; k++) {
        const double value = k < made ? points[2 * k + 1] : NAN;
        if (isfinite(value) && (panel->y.scale != GM_LOG || value > 0)) {
            length++;
            continue;
        }
        if (length == 1) {
            memcpy(dots + 2 * count++, points + 2 * k - 2, 2 * sizeof *dots);
        }
        length = 0;
    }
    gm_mark_line(picture, panel, style, points, made, false);
    if (count > 0) {
        gm_mark_points(picture, panel, (struct gm_style){style.role, 1, 5, GM_SOLID}, dots, count);
    }
}

static void draw_curve(struct gm_picture *picture, struct gm_panel *panel, const struct gm_lane *lane,
                       bool alone, size_t series, const struct gm_graph *graph, double *points)
{
    const size_t made = curve_of(lane, series, graph, points);
    struct gm_style style = gm_lane_style(lane, 1, 2.4);
    style.dash = graph->panel_of && alone ? GM_SOLID : style.dash;
    for (size_t k = 0; k < made && graph->time_unit > 0; k++) {
        points[2 * k] /= graph->time_unit;
    }
    put_curve(picture, panel, style, points, made);
    gm_mark_switches(picture, panel, lane, false);
    if (graph->named) {
        gm_panel_key(picture, panel, style, lane_name(lane));
    }
}

static void draw_graph(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                       const struct gm_graph *graph)
{
    const struct gm_scene *scene = lanes[0]->scene;
    const int asked = gm_asked_series(picture, scene, graph->observable);
    if (asked < 0) {
        return;
    }
    const size_t series = (size_t)asked;
    const struct gm_observable *observable = gm_scene_observable_at(scene, series);
    const char *title = graph->title        ? graph->title
                        : observable->error ? gm_error_title(picture, lanes, count, series)
                        : graph->magnitude  ? gm_picture_text(picture, "|%s|", observable->title)
                                            : observable->title;
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_GRAPH, title);
    panel->axes = true;
    set_time_axis(picture, panel, lanes, count, series, graph);
    double *points = gm_picture_memory(picture, 4 * GM_HISTORY_BINS * sizeof *points);
    if (set_value_axis(panel, lanes, count, series, graph, points) && graph->scale == GM_LOG) {
        gm_mark_text(picture, panel, (struct gm_style){.role = GM_SECONDARY, .alpha = 1, .width = 1},
                     (panel->x.low + panel->x.high) / 2, sqrt(panel->y.low * panel->y.high), GM_ANCHOR_CENTRE,
                     "exactly kept");
    }
    mark_roundoff(picture, panel);
    if (!graph->panel_of && !graph->named) {
        name_dashes(picture, panel, lanes, count);
    }
    for (size_t i = 0; i < count; i++) {
        if (!graph->panel_of || lanes[i]->shown.panel == graph->panel_of->shown.panel) {
            draw_curve(picture, panel, lanes[i], gm_lane_is_alone(lanes, count, lanes[i]), series, graph,
                       points);
        }
    }
}

void gm_draw_graphs(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                    const struct gm_graph *graphs, size_t graph_count)
{
    for (size_t i = 0; i < graph_count; i++) {
        draw_graph(picture, lanes, count, &graphs[i]);
    }
}

/* A graph of an error by its greatest values, if there are too many to distinguish. */
static const struct gm_graph greatest = {.highest = true, .scale = GM_LOG};

/* Draws the graph of the current lane of a walk. */
static void draw_lane_together(struct gm_picture *picture, const struct gm_walk *walk,
                               const struct gm_together *together, size_t together_count,
                               const double range[2], double *points)
{
    const struct gm_lane *lane = walk->lane;
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, gm_lane_title(lane));
    panel->axes = true;
    gm_time_axis(&panel->x, walk->lanes, walk->count);
    panel->y = (struct gm_axis){.label = "", .scale = GM_LOG, .low = range[0], .high = range[1]};
    mark_roundoff(picture, panel);
    const char *missing = NULL;
    for (size_t i = 0; i < together_count; i++) {
        const int series = gm_scene_observable(lane->scene, together[i].observable);
        const size_t made = series < 0 ? 0 : history_points(lane, (size_t)series, 1, &greatest, points);
        size_t values = 0;
        for (size_t k = 0; k < made; k++) {
            values += points[2 * k + 1] >= 0;
        }
        if (values == 0) {
            missing = missing || series < 0 ? missing : gm_lane_missing(lane, (size_t)series);
            continue;
        }
        const struct gm_style style = {gm_lane_role(i), 1, 2.4, gm_lane_dash(i)};
        put_curve(picture, panel, style, points, made);
        if (!missing) {
            gm_panel_key(picture, panel, style, together[i].name);
        }
    }
    gm_mark_switches(picture, panel, lane, false);
    const char *failure = gm_lane_failure(picture, lane);
    if (failure[0] || missing) {
        panel->note = failure[0] ? failure : gm_picture_text(picture, "%s", missing);
        panel->first_key = panel->last_key = NULL;
    }
}

void gm_draw_together(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                      const struct gm_together *together, size_t together_count)
{
    double *points = gm_picture_memory(picture, 4 * GM_HISTORY_BINS * sizeof *points);
    double low = 1e-4, high = 1e-3;
    for (size_t i = 0; i < count * together_count; i++) {
        const struct gm_lane *lane = lanes[i / together_count];
        const int series = gm_scene_observable(lane->scene, together[i % together_count].observable);
        const size_t made = series < 0 ? 0 : history_points(lane, (size_t)series, 1, &greatest, points);
        for (size_t k = 0; k < made; k++) {
            if (points[2 * k + 1] > 0) {
                gm_range_add(&low, &high, fmin(points[2 * k + 1], 100));
            }
        }
    }
    gm_range_round(&low, &high, GM_LOG);
    const double range[2] = {low, high};
    for (struct gm_walk walk = {.lanes = lanes, .count = count}; gm_walk_next(&walk);) {
        draw_lane_together(picture, &walk, together, together_count, range, points);
    }
}
