/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A finer mesh of the same polygon. Vertices keep their numbers, followed by the middles of the edges in
   their order. Each triangle becomes four similar ones, so that angles are preserved. */
#include "core/flow/gmsh.h"

#include <stdlib.h>
#include <string.h>

/* The edge of the complex between two vertices. */
static size_t edge_between(const struct gm_complex *complex, int a, int b)
{
    int k = complex->ring_start[a];
    while (complex->ring_vertex[k] != b) {
        k++;
    }
    return (size_t)complex->ring_edge[k];
}

static void place_vertices(const struct gm_complex *coarse, const long *coarse_tags, double *points,
                           long *tags)
{
    const size_t n = coarse->vertices;
    memcpy(points, coarse->point, 2 * n * sizeof *points);
    memcpy(tags, coarse_tags, n * sizeof *tags);
    for (size_t e = 0; e < coarse->edges; e++) {
        const int *end = coarse->edge + 2 * e;
        for (int k = 0; k < 2; k++) {
            points[2 * (n + e) + (size_t)k] =
                (coarse->point[2 * end[0] + k] + coarse->point[2 * end[1] + k]) / 2;
        }
        tags[n + e] = coarse_tags[n - 1] + 1 + (long)e;
    }
}

static void divide_triangles(const struct gm_complex *coarse, int *corners)
{
    for (size_t t = 0; t < coarse->triangles; t++) {
        const int *vertex = coarse->triangle + 3 * t;
        int middle[3]; /* middle of the edge from corner k to the next one */
        for (int k = 0; k < 3; k++) {
            middle[k] = (int)coarse->vertices + coarse->triangle_edge[3 * t + (size_t)k];
        }
        const int four[4][3] = {{vertex[0], middle[0], middle[2]},
                                {middle[0], vertex[1], middle[1]},
                                {middle[2], middle[1], vertex[2]},
                                {middle[0], middle[1], middle[2]}};
        memcpy(corners + 12 * t, four, sizeof four);
    }
}

bool gm_triangulation_halve(struct gm_triangulation *mesh, enum gm_star star,
                            struct gm_triangulation_fault *fault)
{
    const struct gm_complex *coarse = mesh->complex;
    const size_t n = coarse->vertices, finer = n + coarse->edges;
    struct gm_triangulation halved = *mesh;
    double *points = malloc(2 * finer * sizeof *points);
    long *tags = malloc(finer * sizeof *tags);
    int *corners = malloc(12 * coarse->triangles * sizeof *corners);
    struct gm_complex *fine = NULL;
    *fault = (struct gm_triangulation_fault){.kind = GM_TRIANGULATION_MEMORY};
    if (points && tags && corners) {
        place_vertices(coarse, mesh->tags, points, tags);
        divide_triangles(coarse, corners);
        fine = gm_complex_open(&(struct gm_triangles){.points = points,
                                                      .vertices = finer,
                                                      .corners = corners,
                                                      .count = 4 * coarse->triangles,
                                                      .period = {coarse->period[0], coarse->period[1]},
                                                      .star = star,
                                                      .tags = tags},
                               fault);
    }
    if (fine) {
        fine->origin = coarse->origin;
    }
    halved.complex = fine;
    halved.edge_group = fine ? calloc(fine->edges, sizeof *halved.edge_group) : NULL;
    halved.more = NULL;
    halved.more_count = 0;
    free(points);
    free(corners);
    bool good = fine && halved.edge_group;
    for (size_t e = 0; good && e < coarse->edges; e++) {
        for (int k = 0; good && k < 2; k++) {
            const int *end = coarse->edge + 2 * e;
            good =
                gm_triangulation_add(&halved, edge_between(fine, end[k], (int)(n + e)), mesh->edge_group[e]);
        }
    }
    for (size_t i = 0; good && i < 2 * mesh->more_count; i++) {
        const struct gm_triangulation_member *member = &mesh->more[i / 2];
        const int end = coarse->edge[2 * member->edge + (int)(i % 2)];
        good = gm_triangulation_add(&halved, edge_between(fine, end, (int)n + member->edge), member->tag);
    }
    if (!good) {
        *fault = fine ? (struct gm_triangulation_fault){.kind = GM_TRIANGULATION_MEMORY} : *fault;
        gm_complex_close(fine);
        free(halved.edge_group);
        free(halved.more);
        free(tags);
        return false;
    }
    gm_triangulation_sort(&halved);
    halved.tags = tags;
    gm_complex_close(mesh->complex);
    free(mesh->tags);
    free(mesh->edge_group);
    free(mesh->more);
    *mesh = halved;
    return true;
}
