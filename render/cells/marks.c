/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The raster beneath the character cells: sub-pixels with the level and role of their mark; and marks on it. */
#include "render/cells/grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/grow.h"

bool gm_raster_open(struct gm_raster *raster)
{
    const size_t width = (size_t)raster->width, height = (size_t)raster->height;
    raster->at = malloc(width * height * sizeof *raster->at);
    raster->mask = calloc(width * height, 1);
    raster->left = raster->clip_right = raster->width;
    raster->top = raster->clip_bottom = raster->height;
    if (!raster->at || !raster->mask) {
        gm_raster_close(raster);
        return false;
    }
    struct gm_subpixel paper = {gm_theme_colour(raster->theme, GM_PAPER), GM_LEVEL_PAPER, GM_PAPER};
    for (size_t i = 0; i < width; i++) {
        raster->at[i] = paper;
    }
    for (size_t row = 1; row < height; row++) {
        memcpy(&raster->at[row * width], raster->at, width * sizeof paper);
    }
    return true;
}

void gm_raster_close(struct gm_raster *raster)
{
    free(raster->at);
    free(raster->mask);
    raster->at = NULL;
    raster->mask = NULL;
}

/* Clips marks to this box of the surface. */
static void clip_to(struct gm_raster *raster, const struct gm_box *box)
{
    /* A sub-pixel belongs to the box if its middle does. The one after the end belongs too, so that a mark on
       the edge is visible. */
    raster->clip_left = gm_clamp(floor(box->x / raster->unit_x), 0, raster->width);
    raster->clip_top = gm_clamp(floor(box->y / raster->unit_y), 0, raster->height);
    raster->clip_right = gm_clamp(floor((box->x + box->width) / raster->unit_x) + 1, 0, raster->width);
    raster->clip_bottom = gm_clamp(floor((box->y + box->height) / raster->unit_y) + 1, 0, raster->height);
}

/* A place on the raster, in sub-pixels. */
struct place {
    double x, y;
};

/* Returns the place of a point (x, y) of the panel. */
static struct place place_at(const struct gm_raster *raster, const struct gm_axes *axes, const double *point)
{
    return (struct place){gm_axes_x(axes, point[0]) / raster->unit_x,
                          gm_axes_y(axes, point[1]) / raster->unit_y};
}

static bool is_place(struct place place)
{
    return isfinite(place.x) && isfinite(place.y);
}

/* ---- the mask ---- */

/* Covers a sub-pixel of the mask to at least `coverage` (0 to 1), if it is within the clip box. */
static void cover(struct gm_raster *raster, int x, int y, double coverage)
{
    if (x < raster->clip_left || x >= raster->clip_right || y < raster->clip_top ||
        y >= raster->clip_bottom) {
        return;
    }
    uint8_t value = (uint8_t)(255 * (coverage < 1 ? coverage : 1));
    uint8_t *mask = &raster->mask[(size_t)y * (size_t)raster->width + (size_t)x];
    if (value > *mask) {
        *mask = value;
    }
    raster->left = x < raster->left ? x : raster->left;
    raster->top = y < raster->top ? y : raster->top;
    raster->right = x + 1 > raster->right ? x + 1 : raster->right;
    raster->bottom = y + 1 > raster->bottom ? y + 1 : raster->bottom;
}

static uint8_t mix(uint8_t from, uint8_t to, unsigned weight)
{
    return (uint8_t)((from * (255 - weight) + to * weight + 127) / 255);
}

static void blend(struct gm_subpixel *at, struct gm_rgb colour, unsigned weight, enum gm_level level,
                  enum gm_role role)
{
    at->colour = (struct gm_rgb){mix(at->colour.r, colour.r, weight), mix(at->colour.g, colour.g, weight),
                                 mix(at->colour.b, colour.b, weight)};
    if (level == GM_LEVEL_PAPER) { /* the mark covers too little of it */
        return;
    }
    at->level = (uint8_t)(level == GM_LEVEL_LINE && at->level >= GM_LEVEL_FIELD ? GM_LEVEL_OVER : level);
    at->role = (uint8_t)role;
}

/* Lays the mask over the raster in one colour and empties it, so that a mark that meets itself counts
   once. */
static void settle(struct gm_raster *raster, struct gm_rgb colour, double alpha, enum gm_level level,
                   enum gm_role role)
{
    unsigned opacity = (unsigned)(255 * (alpha < 0 ? 0 : alpha < 1 ? alpha : 1));
    for (int y = raster->top; y < raster->bottom; y++) {
        size_t row = (size_t)y * (size_t)raster->width;
        for (int x = raster->left; x < raster->right; x++) {
            uint8_t *mask = &raster->mask[row + (size_t)x];
            if (!*mask) {
                continue;
            }
            unsigned coverage = *mask;
            *mask = 0;
            if (raster->sharp) {
                coverage = coverage >= 128 ? 255 : 0;
            }
            unsigned weight = coverage * opacity / 255;
            if (weight > 0) {
                blend(&raster->at[row + (size_t)x], colour, weight, coverage >= 64 ? level : GM_LEVEL_PAPER,
                      role);
            }
        }
    }
    raster->left = raster->width;
    raster->top = raster->height;
    raster->right = raster->bottom = 0;
}

/* fmin and fmax are calls, because they handle NaN; no NaN comes here. */
static double smaller(double a, double b)
{
    return a < b ? a : b;
}
static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* ---- lines ---- */

/* Lengths of stroke and gap, alternately. They are in sub-pixels, not in units of the picture, because a dash
   must survive the coarsest raster. */
static const int dashes[GM_DASH_COUNT][6] = {
    [GM_SOLID] = {0},
    [GM_LONG_DASH] = {6, 3, 6, 3, 6, 3},
    [GM_DOTS] = {1, 2, 1, 2, 1, 2},
    [GM_DASH_DOT] = {6, 2, 1, 2, 6, 2},
    [GM_SHORT_DASH] = {3, 2, 3, 2, 3, 2},
    [GM_DASH_DOT_DOT] = {6, 2, 1, 2, 1, 2},
};

static bool dash_on(enum gm_dash dash, double length)
{
    const int *pattern = dashes[dash];
    if (!pattern[0]) {
        return true;
    }
    /* DASH_DOT repeats after four entries, the others after any even number */
    int entries = dash == GM_DASH_DOT ? 4 : 6, period = 0;
    for (int i = 0; i < entries; i++) {
        period += pattern[i];
    }
    int at = (int)fmod(length, period);
    for (int i = 0; i < entries; i++) {
        if (at < pattern[i]) {
            return i % 2 == 0;
        }
        at -= pattern[i];
    }
    return false;
}

/* A straight piece of a line, and the part of it that is left. */
struct piece {
    double x0, y0, x1, y1;
    double start, end; /* fractions of the whole piece, 0 to 1 */
};

/* Cuts a piece to the clip box widened by `margin` (Liang and Barsky). Returns false if nothing is left. */
static bool clip_piece(const struct gm_raster *raster, double margin, struct piece *piece)
{
    const double dx = piece->x1 - piece->x0, dy = piece->y1 - piece->y0;
    const double p[4] = {-dx, dx, -dy, dy};
    const double q[4] = {piece->x0 - (raster->clip_left - margin), raster->clip_right + margin - piece->x0,
                         piece->y0 - (raster->clip_top - margin), raster->clip_bottom + margin - piece->y0};
    double low = 0, high = 1;
    for (int i = 0; i < 4; i++) {
        if (p[i] == 0) {
            if (q[i] < 0) {
                return false;
            }
        } else if (p[i] < 0) {
            low = larger(low, q[i] / p[i]);
        } else {
            high = smaller(high, q[i] / p[i]);
        }
    }
    *piece = (struct piece){.x0 = piece->x0 + low * dx,
                            .y0 = piece->y0 + low * dy,
                            .x1 = piece->x0 + high * dx,
                            .y1 = piece->y0 + high * dy,
                            .start = low,
                            .end = high};
    return low <= high;
}

/* Covers the sub-pixels across a line of the given width at one place of its long direction. */
static void cover_across(struct gm_raster *raster, bool steep, int along, double middle, double width)
{
    if (raster->sharp) {
        int count = (int)larger(1, round(width));
        int first = (int)floor(middle - 0.5 * (count - 1));
        for (int i = 0; i < count; i++) {
            cover(raster, steep ? first + i : along, steep ? along : first + i, 1);
        }
        return;
    }
    double low = middle - 0.5 * width, high = middle + 0.5 * width;
    for (int i = (int)floor(low); i < high; i++) {
        double part = smaller(high, i + 1) - larger(low, i);
        if (part > 0) {
            cover(raster, steep ? i : along, steep ? along : i, part);
        }
    }
}

/* *length is the length so far, for the dash. */
static void draw_piece(struct gm_raster *raster, struct piece piece, double width, enum gm_dash dash,
                       double *length)
{
    const double whole = larger(fabs(piece.x1 - piece.x0), fabs(piece.y1 - piece.y0)), begun = *length;
    *length += whole;
    if (!clip_piece(raster, width + 1, &piece)) {
        return;
    }
    const double x0 = piece.x0, y0 = piece.y0, x1 = piece.x1, y1 = piece.y1;
    bool steep = fabs(y1 - y0) > fabs(x1 - x0);
    double from = steep ? y0 : x0, to = steep ? y1 : x1;
    double across = steep ? x0 : y0, slope = to == from ? 0 : ((steep ? x1 : y1) - across) / (to - from);
    int step = to >= from ? 1 : -1, last = (int)floor(to);
    for (int along = (int)floor(from);; along += step) {
        /* the ends are met exactly, the sub-pixels between in their middle */
        double at = along + 0.5;
        at = step > 0 ? smaller(larger(at, from), to) : larger(smaller(at, from), to);
        if (dash_on(dash, begun + piece.start * whole + fabs(at - from))) {
            cover_across(raster, steep, along, across + slope * (at - from), width);
        }
        if (along == last) {
            break;
        }
    }
}

static void draw_line(struct gm_raster *raster, const struct gm_axes *axes, const struct gm_mark *mark)
{
    double thickness = mark->style.width * raster->scale / smaller(raster->unit_x, raster->unit_y);
    double width = raster->sharp ? round(0.7 * thickness) : larger(1, thickness), length = 0;
    size_t count = mark->count + (mark->closed && mark->count > 1 ? 1 : 0);
    struct place before = {NAN, NAN};
    for (size_t i = 0; i < count; i++) {
        struct place now = place_at(raster, axes, &mark->points[2 * (i % mark->count)]);
        if (is_place(before) && is_place(now)) {
            /* a point within a quarter of a sub-pixel adds only work */
            if (i + 1 < count && fabs(now.x - before.x) + fabs(now.y - before.y) < 0.25) {
                continue;
            }
            draw_piece(raster, (struct piece){before.x, before.y, now.x, now.y, 0, 1}, width,
                       mark->style.dash, &length);
        }
        before = now;
    }
}

/* ---- points ---- */

static void draw_points(struct gm_raster *raster, const struct gm_axes *axes, const struct gm_mark *mark)
{
    double radius = 0.5 * mark->style.width * raster->scale;
    double radius_x = larger(radius / raster->unit_x, 0.5), radius_y = larger(radius / raster->unit_y, 0.5);
    for (size_t i = 0; i < mark->count; i++) {
        struct place middle = place_at(raster, axes, &mark->points[2 * i]);
        if (!is_place(middle) || middle.x < raster->clip_left - radius_x ||
            middle.y < raster->clip_top - radius_y || middle.x > raster->clip_right + radius_x ||
            middle.y > raster->clip_bottom + radius_y) {
            continue;
        }
        cover(raster, (int)floor(middle.x), (int)floor(middle.y), 1);
        for (int y = (int)floor(middle.y - radius_y); y <= middle.y + radius_y; y++) {
            for (int x = (int)floor(middle.x - radius_x); x <= middle.x + radius_x; x++) {
                double dx = (x + 0.5 - middle.x) / radius_x, dy = (y + 0.5 - middle.y) / radius_y;
                double inside = (1 - sqrt(dx * dx + dy * dy)) * smaller(radius_x, radius_y) + 0.5;
                if (inside > 0) {
                    cover(raster, x, y, inside);
                }
            }
        }
    }
}

/* ---- polygons ---- */

/* Most scan lines per sub-pixel: the smoothness of a polygon's upper and lower edges. */
enum { SCANS = 4 };

struct crossing {
    int scan;
    double x;
};

static int by_place(const void *a, const void *b)
{
    const struct crossing *one = a, *other = b;
    if (one->scan != other->scan) {
        return one->scan < other->scan ? -1 : 1;
    }
    return (one->x > other->x) - (one->x < other->x);
}

/* The crossings of a polygon's outline with the scan lines. */
struct scan {
    struct crossing *crossings;
    size_t count, capacity;
    int fine; /* scan lines per sub-pixel */
    bool failed;
};

static void add_edge(const struct gm_raster *raster, struct scan *scan, struct place a, struct place b)
{
    double low = smaller(a.y, b.y) * scan->fine - 0.5, high = larger(a.y, b.y) * scan->fine - 0.5;
    int first = gm_clamp(ceil(low), raster->clip_top * scan->fine, raster->clip_bottom * scan->fine);
    int end = gm_clamp(ceil(high), raster->clip_top * scan->fine, raster->clip_bottom * scan->fine);
    if (first >= end || scan->failed) {
        return;
    }
    if (!gm_grow(&scan->crossings, &scan->capacity, scan->count + (size_t)(end - first),
                 sizeof *scan->crossings)) {
        scan->failed = true;
        return;
    }
    double slope = (b.x - a.x) / (b.y - a.y);
    for (int i = first; i < end; i++) {
        double y = (i + 0.5) / scan->fine;
        scan->crossings[scan->count++] = (struct crossing){i, a.x + (y - a.y) * slope};
    }
}

static void add_span(struct gm_raster *raster, double *row, double from, double to, double weight)
{
    from = larger(from, raster->clip_left);
    to = smaller(to, raster->clip_right);
    for (int x = (int)floor(from); x < to; x++) {
        row[x] += larger(0, smaller(to, x + 1) - larger(from, x)) * weight;
    }
}

static void fill_crossings(struct gm_raster *raster, const struct scan *scan, double *row)
{
    const struct crossing *crossings = scan->crossings;
    size_t i = 0;
    while (i < scan->count) {
        int y = crossings[i].scan / scan->fine;
        double left = raster->clip_right, right = raster->clip_left;
        for (; i < scan->count && crossings[i].scan / scan->fine == y; i++) {
            /* even-odd: the crossings of a scan line come in pairs, as the outline is closed */
            if (i + 1 < scan->count && crossings[i + 1].scan == crossings[i].scan) {
                add_span(raster, row, crossings[i].x, crossings[i + 1].x, 1.0 / scan->fine);
                left = smaller(left, crossings[i].x);
                right = larger(right, crossings[i + 1].x);
                i++;
            }
        }
        int end = gm_clamp(ceil(right), raster->clip_left, raster->clip_right);
        for (int x = gm_clamp(floor(left), raster->clip_left, raster->clip_right); x < end; x++) {
            if (row[x] > 0) {
                cover(raster, x, y, row[x]);
            }
            row[x] = 0;
        }
    }
}

static bool draw_polygon(struct gm_raster *raster, const struct gm_axes *axes, const struct gm_mark *mark)
{
    double *row = calloc((size_t)raster->width + 1, sizeof *row);
    struct scan scan = {.fine = raster->sharp ? 1 : SCANS};
    struct place first = {NAN, NAN}, before = first;
    if (!row) {
        return false;
    }
    for (size_t i = 0; i < mark->count; i++) {
        struct place now = place_at(raster, axes, &mark->points[2 * i]);
        if (!is_place(now)) {
            continue;
        }
        if (!is_place(before)) {
            first = now;
        } else if (fabs(now.x - before.x) + fabs(now.y - before.y) < 0.2) {
            continue;
        } else {
            add_edge(raster, &scan, before, now);
        }
        before = now;
    }
    if (is_place(before)) {
        add_edge(raster, &scan, before, first);
    }
    if (scan.count > 0 && !scan.failed) {
        qsort(scan.crossings, scan.count, sizeof *scan.crossings, by_place);
        fill_crossings(raster, &scan, row);
    }
    free(scan.crossings);
    free(row);
    return !scan.failed;
}

/* ---- fields ---- */

static void set_field(struct gm_raster *raster, int x, int y, struct gm_rgb colour)
{
    raster->at[(size_t)y * (size_t)raster->width + (size_t)x] =
        (struct gm_subpixel){colour, GM_LEVEL_FIELD, GM_INK};
}

static void put_value(void *self, const struct gm_mark *mark, int x, int y, double value, double light)
{
    struct gm_raster *raster = self;
    const double place = mark->high > mark->low ? (value - mark->low) / (mark->high - mark->low) : 0.5;
    set_field(raster, x, y, gm_rgb_lit(gm_colour_map_at(mark->map, raster->theme, place), light));
}

static void draw_mesh(struct gm_raster *raster, const struct gm_axes *axes, const struct gm_mark *mark)
{
    const struct gm_pixel_grid pixels = {
        .across = 1 / raster->unit_x,
        .down = 1 / raster->unit_y,
        .clip = {raster->clip_left, raster->clip_top, raster->clip_right, raster->clip_bottom}};
    gm_mesh_walk(axes, mark, &pixels, put_value, raster);
}

static void draw_image(struct gm_raster *raster, const struct gm_axes *axes, const struct gm_mark *mark)
{
    struct place low = place_at(raster, axes, &mark->points[0]);
    struct place high = place_at(raster, axes, &mark->points[2]);
    if (mark->rows == 0 || mark->columns == 0 || !is_place(low) || !is_place(high) || low.x == high.x ||
        low.y == high.y) {
        return;
    }
    for (int y = raster->clip_top; y < raster->clip_bottom; y++) {
        double v = (y + 0.5 - low.y) / (high.y - low.y);
        if (v < 0 || v > 1) {
            continue;
        }
        size_t row = (size_t)gm_clamp(v * (double)mark->rows, 0, (int)mark->rows - 1);
        for (int x = raster->clip_left; x < raster->clip_right; x++) {
            double u = (x + 0.5 - low.x) / (high.x - low.x);
            if (u < 0 || u > 1) {
                continue;
            }
            size_t column = (size_t)gm_clamp(u * (double)mark->columns, 0, (int)mark->columns - 1);
            double value = mark->values[row * mark->columns + column];
            if (isfinite(value)) {
                put_value(raster, mark, x, y, value, 1);
            }
        }
    }
}

/* ---- all marks, and the axes ---- */

bool gm_marks_draw(struct gm_raster *raster, const struct gm_axes *axes, const struct gm_mark *mark,
                   bool outline)
{
    struct gm_rgb colour = gm_theme_colour(raster->theme, mark->style.role);
    if (mark->count == 0 ||
        !gm_mark_is_shown(mark, axes->box.width / raster->unit_x, axes->box.height / raster->unit_y)) {
        return true;
    }
    clip_to(raster, &axes->box);
    enum gm_level level = outline ? GM_LEVEL_FILL : GM_LEVEL_LINE;
    bool ok = true;
    switch (mark->kind) {
    case GM_MARK_LINE:
        draw_line(raster, axes, mark);
        break;
    case GM_MARK_POINTS:
        draw_points(raster, axes, mark);
        level = GM_LEVEL_LINE;
        break;
    case GM_MARK_POLYGON:
        ok = draw_polygon(raster, axes, mark);
        level = GM_LEVEL_FILL;
        break;
    case GM_MARK_MESH:
        draw_mesh(raster, axes, mark);
        break;
    case GM_MARK_IMAGE:
        draw_image(raster, axes, mark);
        break;
    case GM_MARK_TEXT:
        break;
    }
    settle(raster, colour, mark->style.alpha, level, mark->style.role);
    return ok;
}

void gm_marks_rule(struct gm_raster *raster, const double from_to[4], enum gm_role role, int gap)
{
    const double x0 = from_to[0], y0 = from_to[1], x1 = from_to[2], y1 = from_to[3];
    raster->clip_left = raster->clip_top = 0;
    raster->clip_right = raster->width;
    raster->clip_bottom = raster->height;
    bool upright = fabs(x1 - x0) / raster->unit_x < fabs(y1 - y0) / raster->unit_y;
    double unit = upright ? raster->unit_y : raster->unit_x;
    int from = (int)floor((upright ? smaller(y0, y1) : smaller(x0, x1)) / unit);
    int to = (int)floor((upright ? larger(y0, y1) : larger(x0, x1)) / unit);
    int across = (int)floor(upright ? x0 / raster->unit_x : y0 / raster->unit_y);
    for (int along = from; along <= to; along++) {
        if (along % gap == 0) {
            cover(raster, upright ? across : along, upright ? along : across, 1);
        }
    }
    settle(raster, gm_theme_colour(raster->theme, role), 1, GM_LEVEL_GRID, role);
}

void gm_marks_bar(struct gm_raster *raster, const struct gm_box *box, enum gm_colour_map map)
{
    clip_to(raster, box);
    for (int y = raster->clip_top; y < raster->clip_bottom; y++) {
        double position = 1 - ((y + 0.5) * raster->unit_y - box->y) / box->height;
        for (int x = raster->clip_left; x < raster->clip_right; x++) {
            set_field(raster, x, y, gm_colour_map_at(map, raster->theme, position));
        }
    }
}
