/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of the folder of references, read as a user's are. */
#include "tests/common/meshes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void require(bool good)
{
    if (!good) {
        abort();
    }
}

char *mesh_text(const char *name, size_t *size)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", GM_MESHES, name);
    FILE *file = fopen(path, "rb");
    require(file != NULL);
    char *text = malloc(1 << 20);
    require(text != NULL);
    *size = fread(text, 1, 1 << 20, file);
    fclose(file);
    return text;
}

struct gm_triangulation mesh_of(const char *name)
{
    struct gm_triangulation mesh;
    struct gm_triangulation_fault fault;
    size_t size = 0;
    char *text = mesh_text(name, &size);
    require(gm_triangulation_read(text, size, GM_STAR_AUTO, &mesh, &fault));
    free(text);
    return mesh;
}

unsigned char *sides_of(const struct gm_triangulation *mesh)
{
    const struct gm_complex *complex = mesh->complex;
    const long lid = gm_triangulation_group(mesh, "lid"), inlet = gm_triangulation_group(mesh, "inlet"),
               outlet = gm_triangulation_group(mesh, "outlet");
    unsigned char *sides = calloc(complex->boundary, 1);
    require(sides != NULL);
    for (size_t b = 0; b < complex->boundary; b++) {
        const long group = gm_triangulation_first(mesh, (size_t)complex->boundary_edge[b]);
        sides[b] = group && group == lid      ? GM_EDGE_LID
                   : group && group == inlet  ? GM_EDGE_INLET
                   : group && group == outlet ? GM_EDGE_OUTLET
                                              : GM_EDGE_WALL;
    }
    return sides;
}

enum gm_boundary_fault set_boundary(struct gm_flow *flow, const unsigned char *kinds, double speed,
                                    enum gm_vertex_kind outlet, double theta)
{
    struct gm_side sides[GM_EDGE_SLIP + 1];
    for (int kind = 0; kind <= GM_EDGE_SLIP; kind++) {
        sides[kind] = (struct gm_side){
            .kind = (enum gm_edge_kind)kind,
            .flow = NAN,
            .speed = kind == GM_EDGE_INLET || kind == GM_EDGE_LID ? speed : 0,
            .theta = kind == GM_EDGE_INLET ? theta : 0,
        };
    }
    return gm_flow_set_sides(flow, kinds, sides, outlet);
}
