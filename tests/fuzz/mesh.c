/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reader of Gmsh files against any bytes: a mesh whose parts agree, or a fault that says why. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "core/form/gmsh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool holds)
{
    if (!holds) {
        abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct gm_triangulation mesh;
    struct gm_triangulation_fault fault;
    if (!gm_triangulation_read((const char *)data, size, GM_STAR_AUTO, &mesh, &fault)) {
        require(fault.kind != GM_TRIANGULATION_OK && mesh.complex == NULL);
        return 0;
    }
    const struct gm_complex *complex = mesh.complex;
    double cells = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        require(complex->star0[v] > 0);
        cells += complex->star0[v];
    }
    require(fabs(cells - complex->total_area) <= 1e-9 * complex->total_area);
    for (size_t t = 0; t < 3 * complex->triangles; t++) {
        require(complex->triangle[t] >= 0 && (size_t)complex->triangle[t] < complex->vertices);
        require(complex->triangle_edge[t] >= 0 && (size_t)complex->triangle_edge[t] < complex->edges);
    }
    gm_triangulation_close(&mesh);
    return 0;
}
