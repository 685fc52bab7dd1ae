/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Meshes of the folder of references, read as a user's are. */
#include "tests/common/meshes.h"

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
