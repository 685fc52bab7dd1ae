/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Points and filled polygons of the raster beneath the character cells. */
#include "render/cells/cover.h"

#include <math.h>
#include <stdlib.h>

/* ---- points ---- */

void gm_raster_points(struct gm_raster *raster, const struct gm_frame *frame, const struct gm_mark *mark)
{
    double radius = 0.5 * mark->style.width * raster->scale;
    double radius_x = gm_larger(radius / raster->unit_x, 0.5),
           radius_y = gm_larger(radius / raster->unit_y, 0.5);
    for (size_t i = 0; i < mark->count; i++) {
        struct gm_raster_place middle = gm_raster_place(raster, frame, &mark->points[2 * i]);
        if (!gm_raster_is_place(middle) || middle.x < raster->clip_left - radius_x ||
            middle.y < raster->clip_top - radius_y || middle.x > raster->clip_right + radius_x ||
            middle.y > raster->clip_bottom + radius_y) {
            continue;
        }
        gm_raster_cover(raster, (int)floor(middle.x), (int)floor(middle.y), 1);
        for (int y = (int)floor(middle.y - radius_y); y <= middle.y + radius_y; y++) {
            for (int x = (int)floor(middle.x - radius_x); x <= middle.x + radius_x; x++) {
                double dx = (x + 0.5 - middle.x) / radius_x, dy = (y + 0.5 - middle.y) / radius_y;
                double inside = (1 - sqrt(dx * dx + dy * dy)) * gm_smaller(radius_x, radius_y) + 0.5;
                if (inside > 0) {
                    gm_raster_cover(raster, x, y, inside);
                }
            }
        }
    }
}

/* ---- polygons ---- */

/* Scan lines a sub-pixel, at most: the smoothness of a polygon's upper and lower edges. */
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

/* A polygon's outline crossing the scan lines. */
struct scan {
    struct crossing *crossings;
    size_t count, capacity;
    int fine; /* scan lines a sub-pixel */
    bool failed;
};

static void add_edge(const struct gm_raster *raster, struct scan *scan, struct gm_raster_place a,
                     struct gm_raster_place b)
{
    double low = gm_smaller(a.y, b.y) * scan->fine - 0.5, high = gm_larger(a.y, b.y) * scan->fine - 0.5;
    int first = gm_clamp(ceil(low), raster->clip_top * scan->fine, raster->clip_bottom * scan->fine);
    int end = gm_clamp(ceil(high), raster->clip_top * scan->fine, raster->clip_bottom * scan->fine);
    if (first >= end || scan->failed) {
        return;
    }
    size_t wanted = scan->count + (size_t)(end - first);
    if (wanted > scan->capacity) {
        struct crossing *more = realloc(scan->crossings, 2 * wanted * sizeof *more);
        if (!more) {
            scan->failed = true;
            return;
        }
        scan->crossings = more;
        scan->capacity = 2 * wanted;
    }
    double slope = (b.x - a.x) / (b.y - a.y);
    for (int i = first; i < end; i++) {
        double y = (i + 0.5) / scan->fine;
        scan->crossings[scan->count++] = (struct crossing){i, a.x + (y - a.y) * slope};
    }
}

static void add_span(struct gm_raster *raster, double *row, double from, double to, double weight)
{
    from = gm_larger(from, raster->clip_left);
    to = gm_smaller(to, raster->clip_right);
    for (int x = (int)floor(from); x < to; x++) {
        row[x] += gm_larger(0, gm_smaller(to, x + 1) - gm_larger(from, x)) * weight;
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
                left = gm_smaller(left, crossings[i].x);
                right = gm_larger(right, crossings[i + 1].x);
                i++;
            }
        }
        int end = gm_clamp(ceil(right), raster->clip_left, raster->clip_right);
        for (int x = gm_clamp(floor(left), raster->clip_left, raster->clip_right); x < end; x++) {
            if (row[x] > 0) {
                gm_raster_cover(raster, x, y, row[x]);
            }
            row[x] = 0;
        }
    }
}

bool gm_raster_polygon(struct gm_raster *raster, const struct gm_frame *frame, const struct gm_mark *mark)
{
    double *row = calloc((size_t)raster->width + 1, sizeof *row);
    struct scan scan = {.fine = raster->sharp ? 1 : SCANS};
    struct gm_raster_place first = {NAN, NAN}, before = first;
    if (!row) {
        return false;
    }
    for (size_t i = 0; i < mark->count; i++) {
        struct gm_raster_place now = gm_raster_place(raster, frame, &mark->points[2 * i]);
        if (!gm_raster_is_place(now)) {
            continue;
        }
        if (!gm_raster_is_place(before)) {
            first = now;
        } else if (fabs(now.x - before.x) + fabs(now.y - before.y) < 0.2) {
            continue;
        } else {
            add_edge(raster, &scan, before, now);
        }
        before = now;
    }
    if (gm_raster_is_place(before)) {
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
