/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A finer mesh of the same polygon. Vertices keep their numbers, followed by the middles of the edges in
   their order. Each triangle becomes four similar ones, so that angles are preserved. */
#include "core/form/gmsh.h"

#include <string.h>

/* A mesh, and the halved one while it is made. */
struct halving {
    const struct gm_triangulation *mesh;
    enum gm_star star;
    struct gm_triangulation halved;
    struct gm_triangulation_fault *fault;
};

static void halve(struct gm_arena *arena, void *data)
{
    struct halving *halving = data;
    const struct gm_triangulation *mesh = halving->mesh;
    const struct gm_complex *coarse = mesh->complex;
    struct gm_triangulation *halved = &halving->halved;
    const size_t n = coarse->vertices, finer = n + coarse->edges, members = mesh->members;
    double *points = gm_arena_take(arena, 2 * finer, sizeof *points);
    int *corners = gm_arena_take(arena, 12 * coarse->triangles, sizeof *corners);
    struct gm_triangulation_member *halves = gm_arena_take(arena, 2 * members + 1, sizeof *halves);
    halved->tags = gm_arena_take(arena, finer, sizeof *halved->tags);
    memcpy(halved->tags, mesh->tags, n * sizeof *mesh->tags);
    for (size_t e = 0; e < coarse->edges; e++) {
        halved->tags[n + e] = mesh->tags[n - 1] + 1 + (long)e;
    }
    gm_complex_quarter(coarse, points, corners);
    halved->complex = gm_complex_open(&(struct gm_triangles){.points = points,
                                                             .vertices = finer,
                                                             .corners = corners,
                                                             .count = 4 * coarse->triangles,
                                                             .period = {coarse->period[0], coarse->period[1]},
                                                             .star = halving->star,
                                                             .tags = halved->tags},
                                      halving->fault);
    gm_arena_need(arena, halved->complex);
    halving->fault->kind = GM_TRIANGULATION_MEMORY;
    halved->complex->origin = coarse->origin;
    for (size_t e = 0, count = 0; e < coarse->edges; e++) {
        for (int k = 2 * mesh->member_start[e]; k < 2 * mesh->member_start[e + 1]; k++) {
            const int end = coarse->edge[2 * e + (size_t)k % 2];
            halves[count++] = (struct gm_triangulation_member){
                gm_complex_edge(halved->complex, end, (int)(n + e)), mesh->member[k / 2]};
        }
    }
    gm_triangulation_join(halved, halves, 2 * members);
    halving->fault->kind = GM_TRIANGULATION_OK;
}

bool gm_triangulation_halve(struct gm_triangulation *mesh, enum gm_star star,
                            struct gm_triangulation_fault *fault)
{
    struct halving halving = {mesh, star, *mesh, fault};
    halving.halved.complex = NULL;
    *fault = (struct gm_triangulation_fault){.kind = GM_TRIANGULATION_MEMORY};
    const bool good = gm_arena_run(mesh->arena, halve, &halving);
    gm_complex_close(good ? mesh->complex : halving.halved.complex);
    *mesh = good ? halving.halved : *mesh;
    return good;
}
