/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Objects in space as marks of a plane: lines cut where they pass behind a surface or change depth, discs by
   their depth, ellipsoids with their circles, a box or axes that show the direction of view. */
#include "scenes/common/space.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/linear/vectors.h"

/* Numbers of classes of depth and age of a line, of pieces of a segment, of pieces of a circle. */
enum { DEPTHS = 6, AGES = 16, PIECES = 32, CIRCLE = 96 };

/* Factors of the opacity behind a surface, of a line and of a body, which must stay visible. */
static const double behind = 0.4, veiled = 0.75;

/* Factors of the opacity and of the width at the back of the box. */
static const double palest = 0.45, thinnest = 0.6;

/* A body keeps its opacity unless it is hidden; only its size shows the distance. */
static struct gm_style at_depth(struct gm_style style, double nearness, bool hidden, bool body)
{
    style.alpha *= body ? (hidden ? veiled : 1) : (palest + (1 - palest) * nearness) * (hidden ? behind : 1);
    style.width *= thinnest + (1 - thinnest) * nearness;
    return style;
}

/* The class of a piece between two points: adjacent pieces of one class are one line. */
static int kind_of(const struct gm_space *space, const double *points, size_t i, const bool *hidden,
                   size_t count, bool fades)
{
    double place[2];
    const double depth =
        0.5 * (gm_space_place(space, points, place) + gm_space_place(space, points + 3, place));
    const int band = (int)(gm_space_nearness(space, depth) * (DEPTHS - 1e-9));
    const int age = fades ? (int)(i * AGES / count) : AGES - 1;
    return (age * DEPTHS + band) * 2 + (hidden[i] && hidden[i + 1] ? 1 : 0);
}

void gm_space_line(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                   struct gm_stroke_in_space stroke, const double *points, size_t count)
{
    double *places = gm_picture_memory(picture, 2 * (count + 1) * sizeof *places);
    bool *hidden = gm_picture_memory(picture, (count + 1) * sizeof *hidden);
    for (size_t i = 0; i < count; i++) {
        gm_space_place(space, points + 3 * i, places + 2 * i);
        hidden[i] = gm_space_hides(space, points + 3 * i, stroke.on);
    }
    for (size_t first = 0; first + 1 < count;) {
        const int kind = kind_of(space, points + 3 * first, first, hidden, count, stroke.fades);
        size_t last = first + 1;
        while (last + 1 < count &&
               kind_of(space, points + 3 * last, last, hidden, count, stroke.fades) == kind) {
            last++;
        }
        const double nearness = (kind / 2 % DEPTHS + 0.5) / DEPTHS;
        const double age = (double)(kind / 2 / DEPTHS + 1) / AGES;
        struct gm_style style = at_depth(stroke.style, nearness, kind % 2 == 1, false);
        style.alpha *= 0.06 + 0.94 * age * age;
        gm_mark_line(picture, panel, style, places + 2 * first, last - first + 1, false);
        first = last;
    }
}

void gm_space_segment(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                      struct gm_style style, const double from[3], const double to[3])
{
    double points[3 * (PIECES + 1)];
    for (size_t i = 0; i <= PIECES; i++) {
        for (size_t k = 0; k < 3; k++) {
            points[3 * i + k] = from[k] + (double)i / PIECES * (to[k] - from[k]);
        }
    }
    gm_space_line(picture, panel, space, (struct gm_stroke_in_space){.style = style}, points, PIECES + 1);
}

struct disc {
    double depth, place[2];
    size_t number;
};

static int by_depth(const void *a, const void *b)
{
    const struct disc *one = a, *other = b;
    if (one->depth != other->depth) {
        return one->depth < other->depth ? -1 : 1;
    }
    return (one->number > other->number) - (one->number < other->number);
}

void gm_space_points(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                     struct gm_style style, const double *points, size_t count)
{
    struct disc *discs = gm_picture_memory(picture, (count + 1) * sizeof *discs);
    double *places = gm_picture_memory(picture, 2 * (count + 1) * sizeof *places);
    size_t shown = 0;
    for (size_t i = 0; i < count; i++) {
        discs[shown].depth = gm_space_place(space, points + 3 * i, discs[shown].place);
        discs[shown].number = i;
        shown += isfinite(discs[shown].depth) ? 1 : 0;
    }
    if (shown > 0) {
        qsort(discs, shown, sizeof *discs, by_depth);
    }
    for (size_t first = 0, last; first < shown; first = last) { /* equal discs are one mark */
        struct gm_style kind = {0};
        for (last = first; last < shown; last++) {
            const double nearness =
                (floor(gm_space_nearness(space, discs[last].depth) * (DEPTHS - 1e-9)) + 0.5) / DEPTHS;
            const bool hidden = gm_space_hides(space, points + 3 * discs[last].number, NULL);
            const struct gm_style self = at_depth(style, nearness, hidden, true);
            if (last > first && (self.alpha != kind.alpha || self.width != kind.width)) {
                break;
            }
            kind = self;
            memcpy(places + 2 * last, discs[last].place, sizeof discs[last].place);
        }
        gm_mark_points(picture, panel, kind, places + 2 * first, last - first);
    }
}

/* ---- surfaces ---- */

/* Draws a circle of the unit sphere, at a latitude about an axis, mapped to the ellipsoid. */
static void draw_circle(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                        struct gm_stroke_in_space stroke, const double across[3], const double along[3],
                        const double centre[3])
{
    double points[3 * (CIRCLE + 1)];
    for (size_t i = 0; i <= CIRCLE; i++) {
        const double c = gm_cos(2 * M_PI * (double)i / CIRCLE), s = gm_sin(2 * M_PI * (double)i / CIRCLE);
        for (size_t k = 0; k < 3; k++) {
            points[3 * i + k] = stroke.on->axes[k] * (centre[k] + c * across[k] + s * along[k]);
        }
    }
    gm_space_line(picture, panel, space, stroke, points, CIRCLE + 1);
}

/* Draws the outline of an ellipsoid, on which the line of sight is tangent: x.d = 0 in units of the half
   axes. Its points are slightly in front, so that the ellipsoid does not hide them. */
static void draw_outline(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                         const struct gm_ellipsoid *surface, struct gm_style style)
{
    double d[3], across[3], along[3], points[3 * (CIRCLE + 1)], places[2 * (CIRCLE + 1)];
    for (size_t k = 0; k < 3; k++) {
        d[k] = space->towards[k] / surface->axes[k];
        across[k] = space->right[k] * surface->axes[k]; /* right.towards = 0 */
    }
    const double d_size = sqrt(gm_dot(d, d)), size = sqrt(gm_dot(across, across));
    for (size_t k = 0; k < 3; k++) {
        d[k] /= d_size;
        across[k] /= size;
    }
    gm_cross(d, across, along);
    for (size_t i = 0; i <= CIRCLE; i++) {
        const double c = gm_cos(2 * M_PI * (double)i / CIRCLE), s = gm_sin(2 * M_PI * (double)i / CIRCLE);
        for (size_t k = 0; k < 3; k++) {
            points[3 * i + k] = surface->axes[k] * (c * across[k] + s * along[k] + 1e-3 * d[k]);
        }
        gm_space_place(space, points + 3 * i, places + 2 * i);
    }
    gm_mark_polygon(picture, panel, (struct gm_style){.role = style.role, .alpha = 0.07}, places, CIRCLE);
    gm_space_line(picture, panel, space, (struct gm_stroke_in_space){.style = style, .on = surface}, points,
                  CIRCLE + 1);
}

/* Draws circles every 30 degrees of latitude and longitude. */
static void draw_grid(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                      const struct gm_ellipsoid *surface, struct gm_style style)
{
    enum { SPACING = 30 };
    const struct gm_stroke_in_space stroke = {.style = style, .on = surface};
    const double up[3] = {0, 0, 1}, middle[3] = {0, 0, 0};
    for (int degrees = -90 + SPACING; degrees < 90; degrees += SPACING) {
        const double c = gm_cos(degrees * M_PI / 180), s = gm_sin(degrees * M_PI / 180);
        draw_circle(picture, panel, space, stroke, (const double[]){c, 0, 0}, (const double[]){0, c, 0},
                    (const double[]){0, 0, s});
    }
    for (int degrees = 0; degrees < 180; degrees += SPACING) {
        const double c = gm_cos(degrees * M_PI / 180), s = gm_sin(degrees * M_PI / 180);
        draw_circle(picture, panel, space, stroke, (const double[]){c, s, 0}, up, middle);
    }
}

/* Draws the intersection of two ellipsoids. The squares u = (x^2, y^2, z^2) solve u.f = 1 and u.g = 1, f and
   g the squares of 1 / half axes: a line u = p + s q, q = f x g, while all squares are positive. Each octant
   has a piece of the curve; the cosine of an angle spaces its points evenly at the ends. */
static void draw_meeting(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                         struct gm_style style)
{
    const struct gm_ellipsoid *one = &space->surfaces[0], *other = &space->surfaces[1];
    double f[3], g[3], q[3], p[3] = {0}, low = -INFINITY, high = INFINITY;
    size_t main = 0;
    for (size_t k = 0; k < 3; k++) {
        f[k] = 1 / (one->axes[k] * one->axes[k]);
        g[k] = 1 / (other->axes[k] * other->axes[k]);
    }
    gm_cross(f, g, q);
    for (size_t k = 0; k < 3; k++) {
        main = fabs(q[k]) > fabs(q[main]) ? k : main;
    }
    if (!(fabs(q[main]) > 1e-9 * f[0] * g[0])) {
        return; /* similar ellipsoids meet everywhere or nowhere */
    }
    const size_t i = (main + 1) % 3, j = (main + 2) % 3;
    p[i] = (g[j] - f[j]) / q[main];
    p[j] = (f[i] - g[i]) / q[main];
    for (size_t k = 0; k < 3; k++) {
        if (q[k] == 0 && p[k] < 0) {
            return;
        }
        low = q[k] > 0 ? fmax(low, -p[k] / q[k]) : low;
        high = q[k] < 0 ? fmin(high, -p[k] / q[k]) : high;
    }
    for (int octant = 0; octant < 8 && low < high && isfinite(low) && isfinite(high); octant++) {
        double points[3 * (PIECES + 1)];
        for (size_t n = 0; n <= PIECES; n++) {
            const double s = 0.5 * (low + high) - 0.5 * (high - low) * gm_cos(M_PI * (double)n / PIECES);
            for (size_t k = 0; k < 3; k++) {
                points[3 * n + k] = (octant >> k & 1 ? -1 : 1) * sqrt(fmax(0, p[k] + s * q[k]));
            }
        }
        gm_space_line(picture, panel, space, (struct gm_stroke_in_space){.style = style}, points, PIECES + 1);
    }
}

/* Draws the surfaces with circles of latitude and longitude, and the intersection of the first two. */
static void draw_surfaces(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space)
{
    for (size_t i = 0; i < space->surface_count; i++) {
        const enum gm_role role = i == 0 ? GM_SECONDARY : GM_INK;
        draw_grid(picture, panel, space, &space->surfaces[i], (struct gm_style){role, 0.42, 0.9, GM_SOLID});
        draw_outline(picture, panel, space, &space->surfaces[i], (struct gm_style){role, 0.8, 1.2, GM_SOLID});
    }
    if (space->surface_count > 1) {
        draw_meeting(picture, panel, space, (struct gm_style){GM_EXACT, 1, 2, GM_SOLID});
    }
}

/* ---- axes and box ---- */

static const struct gm_style frame_style = {GM_SECONDARY, 0.7, 1.1, GM_SOLID};

static void draw_name(struct gm_picture *picture, struct gm_panel *panel, double x, double y,
                      enum gm_role role, const char *text)
{
    gm_mark_text(picture, panel, (struct gm_style){.role = role, .alpha = 1, .width = 1}, x, y,
                 GM_ANCHOR_CENTRE, text);
}

/* Draws the three axes from the surfaces up to `reach`. */
static void draw_axes(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                      double reach, const char *const *names)
{
    for (size_t k = 0; k < 3; k++) {
        double surface = 0;
        for (size_t i = 0; i < space->surface_count; i++) {
            surface = fmax(surface, space->surfaces[i].axes[k]);
        }
        for (int side = -1; side <= 1; side += 2) {
            double from[3] = {0}, to[3] = {0}, name[2];
            from[k] = side * surface;
            to[k] = side * reach;
            gm_space_segment(picture, panel, space, frame_style, from, to);
            if (side > 0) {
                to[k] += 0.07 * reach;
                gm_space_place(space, to, name);
                draw_name(picture, panel, name[0], name[1], GM_INK, names[k]);
            }
        }
    }
}

/* A corner of the box: bit k of `which` is set if its coordinate k is high. */
static void corner(const struct gm_space *space, int which, double point[3])
{
    for (size_t k = 0; k < 3; k++) {
        point[k] = which >> k & 1 ? space->high[k] : space->low[k];
    }
}

/* The edge along k with the name: the lower of two outline edges, the left one if they are upright. */
static int named_edge(const struct gm_space *space, int nearest, size_t k)
{
    int chosen = -1;
    double best = INFINITY;
    for (size_t n = 1; n <= 2; n++) {
        const int which = (nearest ^ 1 << (k + n) % 3) & ~(1 << k);
        double point[3], place[2];
        corner(space, which, point);
        point[k] = 0.5 * (space->low[k] + space->high[k]);
        gm_space_place(space, point, place);
        const double rank = k == 2 ? place[0] : place[1];
        chosen = rank < best ? which : chosen;
        best = fmin(best, rank);
    }
    return chosen;
}

/* Writes the name or the ends of an edge, outside of the box. */
static void name_edge(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                      int which, size_t k, const char *name, bool numbers)
{
    double centre[3], middle[2], from[3], to[3], a[2], b[2];
    for (size_t i = 0; i < 3; i++) {
        centre[i] = 0.5 * (space->low[i] + space->high[i]);
    }
    corner(space, which, from);
    corner(space, which | 1 << k, to);
    gm_space_place(space, centre, middle);
    gm_space_place(space, from, a);
    gm_space_place(space, to, b);
    const double x = 0.5 * (a[0] + b[0]) - middle[0], y = 0.5 * (a[1] + b[1]) - middle[1];
    const double far = gm_hypot(x, y),
                 size = 0.5 * fmin(panel->x.high - panel->x.low, panel->y.high - panel->y.low);
    const double off = far > 0 ? 0.075 * size / far : 0;
    if (!numbers) {
        draw_name(picture, panel, 0.5 * (a[0] + b[0]) + 1.2 * off * x, 0.5 * (a[1] + b[1]) + 1.2 * off * y,
                  GM_INK, name);
    }
    for (int end = 0; end < 2 && numbers; end++) {
        const double value = end ? space->high[k] : space->low[k], part = end ? 0.93 : 0.07;
        draw_name(picture, panel, a[0] + part * (b[0] - a[0]) + off * x,
                  a[1] + part * (b[1] - a[1]) + off * y, GM_SECONDARY,
                  gm_picture_text(picture, "%s%.4g", value < 0 ? "−" : "", fabs(value)));
    }
}

/* Draws the edges of the box that do not cover its contents, with numbers at their ends, and the names of its
   axes. */
static void draw_box(struct gm_picture *picture, struct gm_panel *panel, const struct gm_space *space,
                     const char *const *names)
{
    int nearest = 0;
    for (size_t k = 0; k < 3; k++) {
        nearest |= space->towards[k] > 0 ? 1 << k : 0;
    }
    for (int which = 0; which < 8; which++) {
        for (size_t k = 0; k < 3; k++) {
            double from[3], to[3];
            const int other = which | 1 << k;
            corner(space, which, from);
            corner(space, other, to);
            if (other != which && which != nearest && other != nearest) {
                gm_space_segment(picture, panel, space, frame_style, from, to);
            }
        }
    }
    for (int numbers = 0; numbers < 2; numbers++) { /* names have priority if there is little room */
        for (size_t k = 0; k < 3; k++) {
            const int edge = space->high[k] > space->low[k] ? named_edge(space, nearest, k) : -1;
            if (edge >= 0) {
                name_edge(picture, panel, space, edge, k, names[k], numbers == 1);
            }
        }
    }
}

void gm_space_draw_frame(struct gm_picture *picture, struct gm_panel *panel, struct gm_space *space,
                         const struct gm_camera *camera, double far, const char *const names[3])
{
    const double beyond = 1.18; /* the least length of axes, as a multiple of the longest half axis */
    double size = 0;
    for (size_t i = 0; i < 3 * space->surface_count; i++) {
        size = fmax(size, space->surfaces[i / 3].axes[i % 3]);
    }
    const double step = size / 8, reach = beyond * fmax(size, step * ceil((far - 0.02 * size) / step));
    if (space->surface_count == 0) {
        gm_space_fit(space, camera, 0, panel);
        draw_box(picture, panel, space, names);
        return;
    }
    gm_space_fit(space, camera, reach, panel);
    draw_surfaces(picture, panel, space);
    draw_axes(picture, panel, space, reach, names);
}
