/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The triangles of a mesh as they are seen. A surface in space is seen by parallel light: triangles are sorted
   by the depth of their middles, which is right where no triangle crosses another, and the light on a corner is
       0.45 + 0.55 (1 + n.l)/2,    n the mean normal of the triangles there, l the direction of the lamp.
   Of closed surfaces the far side is left out; the back of an open one is darker. What lies on a hidden triangle
   is found on a raster of depths. */
#include <math.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/linear/vectors.h"
#include "scenes/common/graph.h"
#include "scenes/form/form.h"

/* Sorts triangles by classes of depth, the farthest first; one class is 1/16384 of the whole depth. */
static void sort_by_depth(const double *depths, const size_t *triangles, size_t count, const double range[2],
                          size_t *sorted)
{
    enum { CLASSES = 1 << 14 };
    size_t first[CLASSES + 1] = {0};
    const double scale = range[1] > range[0] ? (CLASSES - 1) / (range[1] - range[0]) : 0;
    for (size_t i = 0; i < count; i++) {
        first[1 + (size_t)((depths[i] - range[0]) * scale)]++;
    }
    for (size_t k = 1; k <= CLASSES; k++) {
        first[k] += first[k - 1];
    }
    for (size_t i = 0; i < count; i++) {
        sorted[first[(size_t)((depths[i] - range[0]) * scale)]++] = triangles[i];
    }
}

/* Twice the area of a triangle on the panel: positive of its front. */
static double facing(const double p[6])
{
    return (p[2] - p[0]) * (p[5] - p[1]) - (p[4] - p[0]) * (p[3] - p[1]);
}

/* The mean normals at vertices. */
static void find_normals(const struct gm_complex *complex, double *normals)
{
    memset(normals, 0, 3 * complex->vertices * sizeof *normals);
    for (size_t t = 0; t < complex->triangles; t++) {
        double p[9], n[3];
        gm_complex_corners_in_space(complex, t, p);
        gm_triangle_normal(p, n);
        for (size_t k = 0; k < 9; k++) {
            normals[3 * (size_t)complex->triangle[3 * t + k / 3] + k % 3] += n[k % 3];
        }
    }
}

static double light_on(const struct gm_space *sight, const double normal[3], bool front)
{
    double along = 0;
    for (size_t c = 0; c < 3; c++) {
        along += normal[c] * (0.75 * sight->towards[c] + 0.5 * sight->up[c] - 0.43 * sight->right[c]);
    }
    const double length = gm_dot(normal, normal);
    const double cosine = length > 0 ? fmin(1, fmax(-1, along / sqrt(length))) : 0;
    return front ? 0.45 + 0.275 * (1 + cosine) : 0.8 * (0.45 + 0.275 * (1 - cosine));
}

/* Finds which triangles are before all others at their middles, up to the depth of their own slope. */
static void find_hidden(const struct gm_form_sheet *sheet)
{
    enum { CELLS = 256 };
    const struct gm_panel *panel = sheet->panel;
    double *nearest = gm_picture_memory(sheet->picture, (size_t)CELLS * CELLS * sizeof *nearest);
    double *depth = gm_picture_memory(sheet->picture, 3 * sheet->count * sizeof *depth), place[2];
    const double scale[2] = {CELLS / (panel->x.high - panel->x.low), CELLS / (panel->y.high - panel->y.low)};
    const double origin[2] = {panel->x.low, panel->y.low};
    for (size_t i = 0; i < (size_t)CELLS * CELLS; i++) {
        nearest[i] = -INFINITY;
    }
    for (size_t i = 0; i < sheet->count; i++) {
        const double *p = sheet->places + 6 * i, area = facing(p);
        double low[2] = {CELLS, CELLS}, high[2] = {-1, -1};
        for (size_t k = 0; k < 6; k++) {
            const double cell = floor((p[k] - origin[k % 2]) * scale[k % 2]);
            low[k % 2] = fmax(0, fmin(low[k % 2], cell));
            high[k % 2] = fmin(CELLS - 1, fmax(high[k % 2], cell));
        }
        for (size_t k = 0; k < 3; k++) {
            depth[3 * i + k] = gm_space_place(&sheet->sight, sheet->corners + 9 * i + 3 * k, place);
        }
        for (int row = (int)low[1]; row <= (int)high[1] && area != 0; row++) {
            for (int column = (int)low[0]; column <= (int)high[0]; column++) {
                const double x = origin[0] + (column + 0.5) / scale[0] - p[0],
                             y = origin[1] + (row + 0.5) / scale[1] - p[1];
                const double b = (x * (p[5] - p[1]) - (p[4] - p[0]) * y) / area,
                             c = ((p[2] - p[0]) * y - x * (p[3] - p[1])) / area;
                const double here = depth[3 * i] + b * (depth[3 * i + 1] - depth[3 * i]) +
                                    c * (depth[3 * i + 2] - depth[3 * i]);
                double *at = &nearest[row * CELLS + column];
                *at = b >= 0 && c >= 0 && b + c <= 1 ? fmax(*at, here) : *at;
            }
        }
    }
    for (size_t i = 0; i < sheet->count; i++) {
        const double *p = sheet->places + 6 * i, *z = depth + 3 * i, middle = (z[0] + z[1] + z[2]) / 3;
        const double column = floor(((p[0] + p[2] + p[4]) / 3 - origin[0]) * scale[0]),
                     row = floor(((p[1] + p[3] + p[5]) / 3 - origin[1]) * scale[1]);
        const double slope = fmax(z[0], fmax(z[1], z[2])) - fmin(z[0], fmin(z[1], z[2])) + 4 / scale[0];
        const bool within = column >= 0 && column < CELLS && row >= 0 && row < CELLS;
        sheet->hidden[i] = within && middle < nearest[(int)row * CELLS + (int)column] - slope;
    }
}

/* The numbers of the corners of the last triangle's places: of a vertex, or of its image on a torus. */
static void number_images(struct gm_form_sheet *sheet, size_t triangle)
{
    const struct gm_complex *complex = sheet->complex;
    for (size_t k = 0; k < 3; k++) {
        const int v = complex->triangle[3 * triangle + k];
        int image = 0;
        for (size_t c = 2; c-- > 0 && complex->period[0] > 0;) {
            const double away = sheet->places[6 * sheet->count + 2 * k + c] -
                                complex->point[complex->coordinates * (size_t)v + c];
            image = 3 * image + 1 + (int)round(away / complex->period[c]);
        }
        sheet->point[3 * sheet->count + k] = v + image * (int)complex->vertices;
    }
}

/* Adds the images of a triangle that reach into the periods of a torus, or the triangle. */
static void add_flat(struct gm_form_sheet *sheet, size_t triangle)
{
    const double *period = sheet->complex->period;
    double p[9];
    gm_complex_corners_in_space(sheet->complex, triangle, p);
    for (int image = 0; image < 9; image++) {
        const double shift[2] = {period[0] * (image % 3 - 1), period[1] * (image / 3 - 1)};
        bool within = image == 4;
        for (size_t c = 0; c < 2 && period[0] > 0; c++) {
            const double a = p[c] + shift[c], b = p[3 + c] + shift[c], d = p[6 + c] + shift[c];
            within = (c == 0 || within) && fmax(a, fmax(b, d)) > 0 && fmin(a, fmin(b, d)) < period[c];
        }
        for (size_t k = 0; k < 6 && within; k++) {
            sheet->places[6 * sheet->count + k] = p[3 * (k / 2) + k % 2] + shift[k % 2];
        }
        if (within) {
            number_images(sheet, triangle);
            sheet->triangle[sheet->count++] = triangle;
        }
    }
}

static void place_in_space(struct gm_form_sheet *sheet, const struct gm_camera *camera)
{
    const struct gm_complex *complex = sheet->complex;
    struct gm_picture *picture = sheet->picture;
    struct gm_panel *panel = sheet->panel;
    const struct gm_space *sight = &sheet->sight;
    double *depths = gm_picture_memory(picture, complex->triangles * sizeof *depths);
    size_t *order = gm_picture_memory(picture, complex->triangles * sizeof *order);
    double *normals = gm_picture_memory(picture, 3 * complex->vertices * sizeof *normals), place[6], p[9];
    sheet->light = gm_picture_memory(picture, 3 * complex->triangles * sizeof *sheet->light);
    /* the scale is the same for all azimuths */
    double across = 0, along = 0, centre[3], middle[2], range[2] = {INFINITY, -INFINITY};
    for (size_t c = 0; c < 3; c++) {
        centre[c] = (sight->low[c] + sight->high[c]) / 2;
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        gm_complex_vertex(complex, v, p);
        const double away = gm_hypot(p[0] - centre[0], p[1] - centre[1]);
        across = fmax(across, away);
        along = fmax(along, fabs(sight->towards[2]) * away + fabs(sight->up[2] * (p[2] - centre[2])));
    }
    gm_space_place(sight, centre, middle);
    const double room = 1.03 / camera->zoom;
    panel->x =
        (struct gm_axis){.label = "", .low = middle[0] - room * across, .high = middle[0] + room * across};
    panel->y =
        (struct gm_axis){.label = "", .low = middle[1] - room * along, .high = middle[1] + room * along};
    find_normals(complex, normals);
    size_t count = 0;
    for (size_t t = 0; t < complex->triangles; t++) {
        gm_complex_corners_in_space(complex, t, p);
        order[count] = t;
        depths[count] = 0;
        for (size_t k = 0; k < 3; k++) {
            depths[count] += gm_space_place(sight, p + 3 * k, place + 2 * k);
        }
        if (facing(place) > 0 || complex->closed < complex->pieces) {
            gm_range_add(&range[0], &range[1], depths[count++]);
        }
    }
    sort_by_depth(depths, order, count, range, sheet->triangle);
    for (size_t i = 0; i < count; i++) {
        const size_t t = sheet->triangle[i];
        gm_complex_corners_in_space(complex, t, sheet->corners + 9 * i);
        for (size_t k = 0; k < 3; k++) {
            gm_space_place(sight, sheet->corners + 9 * i + 3 * k, sheet->places + 6 * i + 2 * k);
        }
        for (size_t k = 0; k < 3; k++) {
            sheet->point[3 * i + k] = complex->triangle[3 * t + k];
            sheet->light[3 * i + k] = light_on(sight, normals + 3 * (size_t)complex->triangle[3 * t + k],
                                               facing(sheet->places + 6 * i) > 0);
        }
    }
    sheet->count = count;
    find_hidden(sheet);
}

void gm_form_sheet_make(struct gm_picture *picture, struct gm_panel *panel, const struct gm_complex *complex,
                        const struct gm_camera *camera, double t, struct gm_form_sheet *sheet)
{
    const size_t most = (complex->period[0] > 0 ? 4 : 1) * complex->triangles;
    *sheet = (struct gm_form_sheet){
        .picture = picture,
        .panel = panel,
        .complex = complex,
        .sight = {.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}},
        .triangle = gm_picture_memory(picture, most * sizeof *sheet->triangle),
        .corners = gm_picture_memory(picture, 9 * most * sizeof *sheet->corners),
        .places = gm_picture_memory(picture, 6 * most * sizeof *sheet->places),
        .points = (complex->period[0] > 0 ? 9 : 1) * complex->vertices,
        .point = gm_picture_memory(picture, 3 * most * sizeof *sheet->point),
        .hidden = gm_picture_memory(picture, most * sizeof *sheet->hidden)};
    memset(sheet->hidden, 0, most * sizeof *sheet->hidden);
    struct gm_space *sight = &sheet->sight;
    for (size_t v = 0; v < complex->vertices; v++) {
        double p[3];
        gm_complex_vertex(complex, v, p);
        for (size_t c = 0; c < 3; c++) {
            gm_range_add(&sight->low[c], &sight->high[c], p[c]);
        }
    }
    panel->equal = true;
    sheet->flat = sight->low[2] == 0 && sight->high[2] == 0;
    if (!sheet->flat) {
        gm_space_turn(sight, camera, t);
        place_in_space(sheet, camera);
        return;
    }
    for (size_t c = 0; c < 2 && complex->period[0] > 0; c++) {
        sight->low[c] = 0;
        sight->high[c] = complex->period[c];
    }
    panel->x = (struct gm_axis){.label = "x", .low = sight->low[0], .high = sight->high[0]};
    panel->y = (struct gm_axis){.label = "y", .low = sight->low[1], .high = sight->high[1]};
    panel->axes = true;
    for (size_t i = 0; i < complex->triangles; i++) {
        add_flat(sheet, i);
    }
}

struct gm_form_surface gm_form_surface_of(const struct gm_form_sheet *sheet, const double *values)
{
    struct gm_form_surface surface = {
        .points = gm_picture_memory(sheet->picture, 2 * sheet->points * sizeof *surface.points),
        .values = gm_picture_memory(sheet->picture, sheet->points * sizeof *surface.values),
        .triangles = gm_picture_memory(sheet->picture, 3 * sheet->count * sizeof *surface.triangles),
        .count = sheet->points};
    for (size_t i = 0; i < sheet->count; i++) {
        for (size_t k = 3 * i; k < 3 * i + 3 && !sheet->hidden[i]; k++) {
            const int at = sheet->point[k];
            memcpy(surface.points + 2 * at, sheet->places + 2 * k, 2 * sizeof *surface.points);
            surface.values[at] = values[3 * sheet->triangle[i] + k % 3];
            surface.triangles[3 * surface.triangle_count + k % 3] = at;
        }
        surface.triangle_count += !sheet->hidden[i];
    }
    return surface;
}

/* ---- lines on the sheet ---- */

void gm_form_draw_grid(const struct gm_form_sheet *sheet, struct gm_style style, bool outline)
{
    const struct gm_complex *complex = sheet->complex;
    const bool torus =
        complex->period[0] > 0; /* its images of an edge are drawn by the triangle on its left */
    double *lines = gm_picture_memory(sheet->picture, 18 * sheet->count * sizeof *lines);
    unsigned char *sides = gm_picture_memory(sheet->picture, complex->edges);
    size_t count = 0;
    memset(sides, torus ? 2 : 0, complex->edges);
    for (size_t i = 0; i < 3 * sheet->count && !torus; i++) {
        sides[complex->triangle_edge[3 * sheet->triangle[i / 3] + i % 3]]++;
    }
    for (size_t i = 0; i < 3 * sheet->count; i++) {
        const size_t corner = 3 * sheet->triangle[i / 3] + i % 3, e = (size_t)complex->triangle_edge[corner];
        const double *p = sheet->places + 6 * (i / 3), *from = p + 2 * (i % 3), *to = p + 2 * ((i + 1) % 3);
        if (!sheet->hidden[i / 3] && (outline ? sides[e] == 1
                                      : torus ? complex->triangle_sign[corner] > 0
                                              : sides[e] > 0)) {
            sides[e] = outline ? sides[e] : 0; /* once */
            memcpy(lines + 2 * count, (const double[]){from[0], from[1], to[0], to[1], NAN, NAN},
                   6 * sizeof *lines);
            count += 3;
        }
    }
    gm_mark_line(sheet->picture, sheet->panel, style, lines, count, false);
}

void gm_form_draw_arrows(const struct gm_form_sheet *sheet, struct gm_style style, const double *vectors,
                         double length)
{
    enum { ACROSS = 26 };
    const struct gm_panel *panel = sheet->panel;
    const double width = panel->x.high - panel->x.low, height = panel->y.high - panel->y.low;
    const double cell = fmax(fmax(width, height) / ACROSS, 0.8 * sheet->complex->mean_edge);
    const size_t columns = (size_t)(width / cell) + 1, rows = (size_t)(height / cell) + 1;
    double *nearest = gm_picture_memory(sheet->picture, columns * rows * sizeof *nearest);
    double *lines = gm_picture_memory(sheet->picture, 14 * columns * rows * sizeof *lines);
    for (size_t i = 0; i < columns * rows; i++) {
        nearest[i] = INFINITY;
    }
    /* in each cell of a grid that of the triangle nearest to its middle */
    for (size_t i = 0; i < sheet->count; i++) {
        const double *p = sheet->places + 6 * i, *v = vectors + 3 * sheet->triangle[i];
        const double x = (p[0] + p[2] + p[4]) / 3, y = (p[1] + p[3] + p[5]) / 3;
        const double column = floor((x - panel->x.low) / cell), row = floor((y - panel->y.low) / cell);
        if (sheet->hidden[i] ||
            !(column >= 0 && row >= 0 && column < (double)columns && row < (double)rows)) {
            continue;
        }
        const size_t place = (size_t)row * columns + (size_t)column;
        const double away =
            gm_hypot((x - panel->x.low) / cell - column - 0.5, (y - panel->y.low) / cell - row - 0.5);
        if (away < nearest[place]) {
            double d[2] = {v[0], v[1]};
            if (!sheet->flat) {
                gm_space_place(&sheet->sight, v, d);
            }
            const double arrow[2] = {0.9 * cell * d[0] / length, 0.9 * cell * d[1] / length};
            gm_arrow(x, y, arrow, lines + 14 * place);
            nearest[place] = away;
        }
    }
    for (size_t i = 0; i < 14 * columns * rows; i++) {
        lines[i] = isfinite(nearest[i / 14]) ? lines[i] : NAN;
    }
    gm_mark_line(sheet->picture, sheet->panel, style, lines, 7 * columns * rows, false);
}

void gm_form_dual_place(const struct gm_form_sheet *sheet, size_t i, double place[2])
{
    const double *w = sheet->complex->weight + 3 * sheet->triangle[i], *p = sheet->places + 6 * i;
    for (size_t c = 0; c < 2; c++) {
        place[c] = w[0] * p[c] + w[1] * p[2 + c] + w[2] * p[4 + c];
    }
}

void gm_form_draw_dual(const struct gm_form_sheet *sheet, struct gm_style style)
{
    double *lines = gm_picture_memory(sheet->picture, 18 * sheet->count * sizeof *lines);
    double *dots = gm_picture_memory(sheet->picture, 2 * sheet->count * sizeof *dots);
    size_t count = 0, met = 0;
    for (size_t i = 0; i < sheet->count; i++) {
        const double *p = sheet->places + 6 * i;
        double *dot = dots + 2 * met;
        gm_form_dual_place(sheet, i, dot);
        for (size_t k = 0; k < 3 && !sheet->hidden[i]; k++) {
            const double *a = p + 2 * k, *b = p + 2 * ((k + 1) % 3);
            const double piece[6] = {dot[0], dot[1], (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, NAN, NAN};
            memcpy(lines + 2 * count, piece, sizeof piece);
            count += 3;
        }
        met += !sheet->hidden[i];
    }
    gm_mark_line(sheet->picture, sheet->panel, style, lines, count, false);
    style.width *= 2.6;
    gm_mark_points(sheet->picture, sheet->panel, style, dots, met);
}
