/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The triangles that are drawn, from a mesh and values at its vertices. */
#include "scenes/flow/picture.h"

#include <math.h>
#include <string.h>

/* Meshes up to this size are refined once for the picture: a cubic along every edge, from the gradients at
   its ends. */
enum { REFINED = 12000 };

/* Gradients at the vertices: x and y for each, the mean over the triangles around. */
static void gradients(const struct gm_complex *complex, const double *values, double *gradient)
{
    /* the velocity of psi = values is its gradient turned */
    gm_flow_vertex_velocities(complex, values, gradient);
    for (size_t v = 0; v < complex->vertices; v++) {
        const double u = gradient[2 * v], w = gradient[2 * v + 1];
        gradient[2 * v] = -w;
        gradient[2 * v + 1] = u;
    }
}

static double *refine(struct gm_picture *picture, const struct gm_complex *complex, const double *values)
{
    const size_t n = complex->vertices;
    double *fine = gm_picture_memory(picture, (n + complex->edges) * sizeof *fine);
    double *gradient = gm_picture_memory(picture, 3 * n * sizeof *gradient);
    if (!fine || !gradient) {
        return NULL;
    }
    gradients(complex, values, gradient);
    memcpy(fine, values, n * sizeof *fine);
    for (size_t e = 0; e < complex->edges; e++) {
        const int a = complex->edge[2 * e], b = complex->edge[2 * e + 1];
        double bend = 0;
        for (int c = 0; c < 2; c++) {
            bend += (gradient[2 * a + c] - gradient[2 * b + c]) *
                    (complex->point[2 * b + c] - complex->point[2 * a + c]);
        }
        const double middle = (values[a] + values[b]) / 2, widest = fabs(values[a] - values[b]) / 2;
        /* at most the bend of a monotonic cubic, if the ends differ */
        fine[n + e] =
            middle + fmin(fmax(bend / 8, -fmax(widest, fabs(bend) / 8)), fmax(widest, fabs(bend) / 8));
    }
    return fine;
}

/* A torus is drawn unfolded: vertices come nine times, shifted by the periods, and triangles that stick out
   at one side come again at the other. */
static bool unfold(struct gm_picture *picture, const struct gm_complex *complex, const double *psi,
                   const double *field, struct gm_flow_sheet *sheet)
{
    enum { COPIES = 9 };
    const size_t n = complex->vertices;
    double *points = gm_picture_memory(picture, 2 * COPIES * n * sizeof *points);
    double *own_psi = gm_picture_memory(picture, COPIES * n * sizeof *own_psi);
    double *user_field = gm_picture_memory(picture, COPIES * n * sizeof *user_field);
    int *triangles = gm_picture_memory(picture, 3 * 4 * complex->triangles * sizeof *triangles);
    if (!points || !own_psi || !user_field || !triangles) {
        return false;
    }
    for (size_t i = 0; i < COPIES * n; i++) {
        const size_t v = i % n, copy = i / n;
        points[2 * i] = complex->point[2 * v] + complex->period[0] * ((double)(copy % 3) - 1);
        points[2 * i + 1] = complex->point[2 * v + 1] + complex->period[1] * ((double)(copy / 3) - 1);
        own_psi[i] = psi[v];
        user_field[i] = field ? field[v] : 0;
    }
    size_t count = 0;
    for (size_t t = 0; t < complex->triangles; t++) {
        double p[6];
        gm_complex_corners(complex, t, p);
        for (int copy = 0; copy < COPIES; copy++) {
            int corners[3];
            double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
            bool there = true;
            for (int k = 0; k < 3; k++) {
                const int v = complex->triangle[3 * t + (size_t)k];
                int shift[2];
                for (int c = 0; c < 2; c++) {
                    const double period = complex->period[c], moved = (c ? copy / 3 : copy % 3) - 1;
                    const double x = p[2 * k + c] + period * moved;
                    shift[c] = (int)round((x - complex->point[2 * v + c]) / period) + 1;
                    there &= shift[c] >= 0 && shift[c] < 3;
                    low[c] = fmin(low[c], x / period);
                    high[c] = fmax(high[c], x / period);
                }
                corners[k] = v + (int)n * (shift[0] + 3 * shift[1]);
            }
            if (there && low[0] < 1 && low[1] < 1 && high[0] > 0 && high[1] > 0 &&
                count < 4 * complex->triangles) {
                memcpy(triangles + 3 * count++, corners, sizeof corners);
            }
        }
    }
    *sheet = (struct gm_flow_sheet){points, own_psi, field ? user_field : NULL, triangles, COPIES * n, count};
    return true;
}

bool gm_flow_sheet_make(struct gm_picture *picture, const struct gm_complex *complex, const double *psi,
                        const double *field, struct gm_flow_sheet *sheet)
{
    if (complex->boundary == 0) {
        return unfold(picture, complex, psi, field, sheet);
    }
    if (complex->triangles > REFINED) {
        *sheet = (struct gm_flow_sheet){complex->point,    psi, field, complex->triangle, complex->vertices,
                                        complex->triangles};
        return true;
    }
    const size_t n = complex->vertices;
    double *points = gm_picture_memory(picture, 2 * (n + complex->edges) * sizeof *points);
    int *triangles = gm_picture_memory(picture, 12 * complex->triangles * sizeof *triangles);
    if (!points || !triangles) {
        return false;
    }
    gm_complex_quarter(complex, points, triangles);
    *sheet = (struct gm_flow_sheet){.points = points,
                                    .psi = refine(picture, complex, psi),
                                    .field = field ? refine(picture, complex, field) : NULL,
                                    .triangles = triangles,
                                    .vertices = n + complex->edges,
                                    .count = 4 * complex->triangles};
    return sheet->psi && (sheet->field || !field);
}
