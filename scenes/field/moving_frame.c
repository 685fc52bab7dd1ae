/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Invariant schemes in their moving frames: how far these travel, what a symmetry leaves of a step, and a picture. */
#include "core/functions/functions.h"
#include "scenes/field/frames.h"

#include <math.h>

enum { STENCIL = 5 /* nodes, the one that is stepped in the middle */, MIDDLE = STENCIL / 2 };

/* Points of the picture, as the lane sees them and as the frame carries them, relative to the node in the middle, which its
   translations carry to t = x = 0: the nodes at the current level, then at the next one, in units of h and k, and the values
   at the current level. */
struct stencil {
    bool known; /* there is a frame */
    double nodes[2][4 * STENCIL], values[2][2 * STENCIL];
};

/* Texts and properties of one equation. */
struct look {
    unsigned equation;
    const char *title, *note; /* the picture's title, and the end of its subtitle */
    const char *value;        /* the name of u, "u" */
    const char *carried;      /* the name of the carried u, "û" */
    /* the cross-sections that define frames of the usual kind, some special ones among them, and special ones alone
       (gm_frames.are_special); without `some` the first lane decides */
    const char *usual, *some, *special;
    bool scaled;      /* a scaling makes the carried nodes of all lanes equally far apart */
    bool logarithmic; /* values are logarithms, relative to the one in the middle */
};
static const struct look looks[] = {
    {
        .equation = GM_NEEDS_KDV,
        .title = "The moving frame at a node of the Korteweg-de Vries equation",
        .note = ",  and ĥ = h",
        .value = "u",
        .carried = "û",
        .usual = "ûⱼ₋₁ + ûⱼ + ûⱼ₊₁ = 0",
        .some = "ûⱼ₋₁ + ûⱼ + ûⱼ₊₁ = 0, or û + v̂ⱼ = 0 where it arrives",
        .special = "û + v̂ⱼ = 0 where the node arrives",
        .scaled = true,
    },
    {
        .equation = GM_NEEDS_HEAT,
        .title = "The moving frame at a node of the heat equation",
        .note = "",
        .value = "ln u/uⱼ",
        .carried = "ln û/ûⱼ",
        .usual = "ûⱼ₋₁ = ûⱼ₊₁",
        .some = "ûⱼ₋₁ = ûⱼ₊₁, by projections = ûⱼ",
        .special = "ûⱼ₋₁ = ûⱼ = ûⱼ₊₁",
        .logarithmic = true,
    },
    {
        .equation = GM_NEEDS_BURGERS,
        .title = "The moving frame at a node of Burgers' equation",
        .note = "",
        .value = "u",
        .carried = "û",
        .usual = "ûⱼ = 0,  D₀û = 0",
        .special = "a ûⱼ₊₁ + (1 + a) ûⱼ₋₁ = (1 + 2a) ûⱼ,  ûⱼ = d h² D₂û",
    },
};

static const char *section_of(const struct look *look, const struct gm_lane *const *lanes, size_t count)
{
    size_t special = 0;
    for (size_t i = 0; i < count; i++) {
        special += gm_moving_frames_of(&lanes[i]->problem)->are_special(lanes[i]->scheme);
    }
    if (special == 0 || special == count) {
        return special ? look->special : look->usual;
    }
    return look->some ? look->some : section_of(look, lanes, 1);
}

/* The units of x and t, and what is drawn. */
struct drawn {
    const struct look *look;
    const struct stencil *stencils;
    const char *section;
    double h, k;
};

/* Returns the defect of a step under a symmetry. */
static double defect(const struct gm_view *view, struct gm_point_symmetry symmetry)
{
    return gm_moving_frames_of(view->problem)
        ->defect(view->problem, view->scheme, view->dt, &symmetry, view->state);
}

double gm_boost_defect(const struct gm_view *view)
{
    return defect(view, (struct gm_point_symmetry){.boost = 0.5, .scale = 1});
}

double gm_projection_defect(const struct gm_view *view)
{
    return defect(view, (struct gm_point_symmetry){.projection = 0.5, .scale = 1});
}

double gm_scaling_defect(const struct gm_view *view)
{
    return defect(view, (struct gm_point_symmetry){.scale = 1.3});
}

double gm_frame_travel(const struct gm_view *view)
{
    const struct gm_framed *framed = gm_framed_of(view->problem);
    return gm_frame_rests(framed, view->scheme) ? framed->lambda * (view->t - framed->line.begin) : 0;
}

/* Returns the place of the node that is shown; 0 if the file has no parameter `at`. */
static double place_of(const struct gm_lane *lane)
{
    const struct gm_parameter *row = gm_scene_parameter(lane->scene, "at");
    return row ? gm_parameter_get(row, lane->parameters) : 0;
}

/* Returns the number of the node nearest to the place that has its stencil inside the line; a ring has no ends. */
static size_t middle_node(const struct gm_lane *lane, const struct gm_view *view)
{
    const struct gm_grid1 *grid = &view->problem->line;
    const bool is_ring = gm_field_of(view->problem)->equation == GM_NEEDS_KDV;
    const double length = grid->dx * (double)grid->points, place = place_of(lane) + gm_frame_travel(view),
                 turns = is_ring ? floor((place - grid->first) / length) : 0;
    const double nearest = round((place - turns * length - grid->first) / grid->dx),
                 last = (double)grid->points - 1 - MIDDLE;
    return (size_t)fmax(MIDDLE, fmin(last, nearest));
}

static struct stencil stencil_of(const struct gm_lane *lane, const struct look *look, double h, double k)
{
    const struct gm_view view = gm_lane_view(lane);
    const struct gm_framed *framed = gm_framed_of(view.problem);
    const double sigma = gm_frame_rests(framed, view.scheme) ? 0 : framed->lambda * view.dt;
    const size_t j = middle_node(lane, &view);
    const struct gm_moving_frames *frames = gm_moving_frames_of(view.problem);
    struct gm_point_symmetry frame;
    struct stencil made = {.known = frames->find(view.problem, view.scheme, view.dt, view.state, j, &frame)};
    frame.scale = look->scaled ? h / view.problem->line.dx : frame.scale;
    for (size_t e = 0; e < 2 * STENCIL; e++) {
        const size_t i = j + e % STENCIL - MIDDLE;
        const bool next = e >= STENCIL;
        const struct gm_event seen = {
            .t = next ? view.dt : 0,
            .x = ((double)i - (double)j) * view.problem->line.dx + (next ? sigma : 0),
            .u = view.state[i] / (look->logarithmic ? view.state[j] : 1),
        };
        const struct gm_event both[2] = {seen, frames->carry(framed, &frame, seen)};
        for (size_t c = 0; c < 2; c++) {
            made.nodes[c][2 * e] = both[c].x / h;
            made.nodes[c][2 * e + 1] = both[c].t / k;
            if (!next) { /* at the next level only positions count */
                made.values[c][2 * e] = both[c].x / h;
                made.values[c][2 * e + 1] = look->logarithmic ? gm_log(both[c].u) : both[c].u;
            }
        }
    }
    return made;
}

/* Widens an axis by a part of its range on both sides. */
static void finish(struct gm_axis *axis, double part)
{
    const double range = axis->high > axis->low ? axis->high - axis->low : 1;
    axis->low -= part * range;
    axis->high += part * range;
}

static struct gm_panel *add(struct gm_picture *picture, const char *title, const char *x, const char *y)
{
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, title);
    panel->axes = true;
    panel->x = (struct gm_axis){.label = x, .low = INFINITY, .high = -INFINITY};
    panel->y = (struct gm_axis){.label = y, .low = INFINITY, .high = -INFINITY};
    return panel;
}

static void hold(struct gm_panel *panel, const double *points, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        gm_range_add(&panel->x.low, &panel->x.high, points[2 * i]);
        gm_range_add(&panel->y.low, &panel->y.high, points[2 * i + 1]);
    }
}

/* Later lanes are thinner, so that coinciding lanes are all seen. */
static struct gm_style line_style(const struct gm_lane *lane, size_t i, size_t count)
{
    return gm_lane_style(lane, 1, 2 + 6 * (double)(count - 1 - i) / (double)count);
}

/* The grid around the node, its stencil as points. */
static void draw_nodes(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                       const struct drawn *drawn, bool carried)
{
    const struct stencil *stencils = drawn->stencils;
    struct gm_panel *panel =
        carried ? add(picture, "the same nodes, carried by the frame", "x̂ / h", "t̂ / k")
                : add(picture, "a node and its neighbours, from each frame", "(x − xⱼ) / h", "(t − tⁿ) / k");
    for (size_t i = 0; i < count; i++) {
        hold(panel, stencils[i].nodes[carried], stencils[i].known ? (size_t)2 * STENCIL : 0);
    }
    if (!(panel->x.high > panel->x.low)) {
        panel->x = (struct gm_axis){.label = panel->x.label, .low = -2, .high = 2};
        panel->y = (struct gm_axis){.label = panel->y.label, .low = 0, .high = 1};
        panel->note = "there is no such frame here";
    }
    finish(&panel->x, 0.08);
    finish(&panel->y, 0.2);
    for (size_t i = 0; i < count; i++) {
        const double *points = stencils[i].nodes[carried];
        if (!stencils[i].known) {
            continue;
        }
        const struct gm_style style = line_style(lanes[i], i, count);
        gm_mark_line(picture, panel, style, points, STENCIL, false);
        gm_mark_line(picture, panel, style, points + 2 * STENCIL, STENCIL, false);
        for (size_t e = 0; e < STENCIL; e++) {
            const double *lower = &points[2 * e], *upper = &points[2 * (STENCIL + e)];
            const double world[] = {lower[0], lower[1], upper[0], upper[1]};
            gm_mark_line(picture, panel, style, world, 2, false);
        }
        struct gm_style dots = style;
        dots.width = 7 + style.width;
        gm_mark_points(picture, panel, dots, points + 2 * (MIDDLE - 1), 3);
        gm_mark_points(picture, panel, dots, points + 2 * (STENCIL + MIDDLE), 1);
    }
}

/* Draws the values around the node at the current level. */
static void draw_values(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                        const struct drawn *drawn, bool carried)
{
    const struct stencil *stencils = drawn->stencils;
    const struct look *look = drawn->look;
    struct gm_panel *panel =
        carried ? add(picture, "the same values, carried", "x̂ / h", look->carried)
                : add(picture, "the values there, from each frame", "(x − xⱼ) / h", look->value);
    gm_range_add(&panel->x.low, &panel->x.high, -MIDDLE);
    gm_range_add(&panel->x.low, &panel->x.high, MIDDLE);
    for (size_t i = 0; i < count; i++) {
        hold(panel, stencils[i].values[carried], stencils[i].known ? STENCIL : 0);
    }
    finish(&panel->x, 0.08);
    if (!(panel->y.high >= panel->y.low)) {
        panel->y.low = panel->y.high = 0;
    }
    finish(&panel->y, 0.15);
    if (carried) {
        panel->note = gm_picture_text(picture, "cross-section  %s", drawn->section);
        const double section[] = {panel->x.low, 0, panel->x.high, 0};
        gm_mark_line(picture, panel, (struct gm_style){GM_EXACT, 1, 1.5, GM_LONG_DASH}, section, 2, false);
    }
    for (size_t i = 0; i < count; i++) {
        const double *points = stencils[i].values[carried];
        if (!stencils[i].known) {
            continue;
        }
        const struct gm_style style = line_style(lanes[i], i, count);
        gm_mark_line(picture, panel, style, points, STENCIL, false);
        struct gm_style dots = style;
        dots.width = 7 + style.width;
        gm_mark_points(picture, panel, dots, points + 2 * (MIDDLE - 1), 3);
        if (!carried) {
            const char *typed = lanes[i]->shown.colour_name, *title = gm_lane_title(lanes[i]);
            const char *whole = !typed[0] ? title
                                : gm_panel_count(lanes, count) == 1
                                    ? typed
                                    : gm_picture_text(picture, "%s, %s", title, typed);
            gm_panel_key(picture, panel, gm_lane_style(lanes[i], 1, 2.2), whole);
        }
    }
}

void gm_draw_moving_frame(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    const struct look *look = looks;
    while (look->equation != gm_field_of(&lanes[0]->problem)->equation) {
        look++;
    }
    struct stencil *stencils = gm_picture_memory(picture, count * sizeof *stencils);
    const struct drawn drawn = {look, stencils, section_of(look, lanes, count), lanes[0]->problem.line.dx,
                                lanes[0]->run->dt};
    const double viscosity = gm_framed_of(&lanes[0]->problem)->viscosity;
    const char *constant =
        look->equation == GM_NEEDS_KDV ? "" : gm_picture_text(picture, ",  ν = %g", viscosity);
    gm_draw_clock(picture, lanes, count);
    picture->title = look->title;
    picture->subtitle =
        gm_picture_text(picture, "the node nearest to x = %g%s,  h = %.3g,  k = %s%s", place_of(lanes[0]),
                        constant, drawn.h, gm_step_text(picture, drawn.k), look->note);
    for (size_t i = 0; i < count; i++) {
        stencils[i] = stencil_of(lanes[i], look, drawn.h, drawn.k);
    }
    picture->state_columns = 2;
    draw_nodes(picture, lanes, count, &drawn, false);
    draw_nodes(picture, lanes, count, &drawn, true);
    draw_values(picture, lanes, count, &drawn, false);
    draw_values(picture, lanes, count, &drawn, true);
}
