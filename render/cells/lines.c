/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lines and dashes of the raster beneath the character cells. */
#include "render/cells/cover.h"

#include <math.h>

/* Lengths of stroke and gap in sub-pixels, alternately. Counted in sub-pixels rather than in units of the
   picture because a dash must survive the coarsest raster. */
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

/* The part of a line within the clip box widened by `margin`: Liang and Barsky. */
static bool clip_segment(const struct gm_raster *raster, double margin, double *x0, double *y0, double *x1,
                         double *y1, double *start, double *end)
{
    double dx = *x1 - *x0, dy = *y1 - *y0;
    double p[4] = {-dx, dx, -dy, dy};
    double q[4] = {*x0 - (raster->clip_left - margin), raster->clip_right + margin - *x0,
                   *y0 - (raster->clip_top - margin), raster->clip_bottom + margin - *y0};
    double low = 0, high = 1;
    for (int i = 0; i < 4; i++) {
        if (p[i] == 0) {
            if (q[i] < 0) {
                return false;
            }
        } else if (p[i] < 0) {
            low = gm_larger(low, q[i] / p[i]);
        } else {
            high = gm_smaller(high, q[i] / p[i]);
        }
    }
    if (low > high) {
        return false;
    }
    *start = low;
    *end = high;
    *x1 = *x0 + high * dx;
    *y1 = *y0 + high * dy;
    *x0 += low * dx;
    *y0 += low * dy;
    return true;
}

/* The sub-pixels across a line of the given width at one place of its long direction. */
static void cover_across(struct gm_raster *raster, bool steep, int along, double middle, double width)
{
    if (raster->sharp) {
        int count = (int)gm_larger(1, round(width));
        int first = (int)floor(middle - 0.5 * (count - 1));
        for (int i = 0; i < count; i++) {
            gm_raster_cover(raster, steep ? first + i : along, steep ? along : first + i, 1);
        }
        return;
    }
    double low = middle - 0.5 * width, high = middle + 0.5 * width;
    for (int i = (int)floor(low); i < high; i++) {
        double part = gm_smaller(high, i + 1) - gm_larger(low, i);
        if (part > 0) {
            gm_raster_cover(raster, steep ? i : along, steep ? along : i, part);
        }
    }
}

/* One straight piece; *length is the way so far, for the dash. */
static void line_piece(struct gm_raster *raster, double x0, double y0, double x1, double y1, double width,
                       enum gm_dash dash, double *length)
{
    double whole = gm_larger(fabs(x1 - x0), fabs(y1 - y0)), begun = *length, start, end;
    *length += whole;
    if (!clip_segment(raster, width + 1, &x0, &y0, &x1, &y1, &start, &end)) {
        return;
    }
    bool steep = fabs(y1 - y0) > fabs(x1 - x0);
    double from = steep ? y0 : x0, to = steep ? y1 : x1;
    double across = steep ? x0 : y0, slope = to == from ? 0 : ((steep ? x1 : y1) - across) / (to - from);
    int step = to >= from ? 1 : -1, last = (int)floor(to);
    for (int along = (int)floor(from);; along += step) {
        /* the ends are met exactly, the sub-pixels between in their middle */
        double at = along + 0.5;
        at = step > 0 ? gm_smaller(gm_larger(at, from), to) : gm_larger(gm_smaller(at, from), to);
        if (dash_on(dash, begun + start * whole + fabs(at - from))) {
            cover_across(raster, steep, along, across + slope * (at - from), width);
        }
        if (along == last) {
            break;
        }
    }
}
void gm_raster_line(struct gm_raster *raster, const struct gm_frame *frame, const struct gm_mark *mark)
{
    double thickness = mark->style.width * raster->scale / gm_smaller(raster->unit_x, raster->unit_y);
    double width = raster->sharp ? round(0.7 * thickness) : gm_larger(1, thickness), length = 0;
    size_t count = mark->count + (mark->closed && mark->count > 1 ? 1 : 0);
    struct gm_raster_place before = {NAN, NAN};
    for (size_t i = 0; i < count; i++) {
        struct gm_raster_place now = gm_raster_place(raster, frame, &mark->points[2 * (i % mark->count)]);
        if (gm_raster_is_place(before) && gm_raster_is_place(now)) {
            /* what is nearer than a part of a sub-pixel adds nothing but work */
            if (i + 1 < count && fabs(now.x - before.x) + fabs(now.y - before.y) < 0.25) {
                continue;
            }
            line_piece(raster, before.x, before.y, now.x, now.y, width, mark->style.dash, &length);
        }
        before = now;
    }
}

void gm_raster_rule(struct gm_raster *raster, double x0, double y0, double x1, double y1, enum gm_role role,
                    int gap)
{
    raster->clip_left = raster->clip_top = 0;
    raster->clip_right = raster->width;
    raster->clip_bottom = raster->height;
    bool upright = fabs(x1 - x0) / raster->unit_x < fabs(y1 - y0) / raster->unit_y;
    double unit = upright ? raster->unit_y : raster->unit_x;
    int from = (int)floor((upright ? gm_smaller(y0, y1) : gm_smaller(x0, x1)) / unit);
    int to = (int)floor((upright ? gm_larger(y0, y1) : gm_larger(x0, x1)) / unit);
    int across = (int)floor(upright ? x0 / raster->unit_x : y0 / raster->unit_y);
    for (int along = from; along <= to; along++) {
        if (along % gap == 0) {
            gm_raster_cover(raster, upright ? across : along, upright ? along : across, 1);
        }
    }
    gm_raster_settle(raster, gm_theme_colour(raster->theme, role), 1, GM_LEVEL_GRID, role);
}
