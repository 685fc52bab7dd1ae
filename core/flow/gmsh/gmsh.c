/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gmsh's file format 4.1, ASCII (Geuzaine & Remacle, Int. J. Numer. Meth. Eng. 79 (2009) 1309; Gmsh's
   reference manual, "MSH file format"): from the tables of a file to a complex with names on its edges. */
#include "core/flow/gmsh/gmsh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/flow/gmsh/reader.h"

/* Numbers the nodes of triangles in the order of their tags; writes points, tags and corners. */
static bool number_nodes(struct gm_gmsh_reader *reader, double *points, long *tags, int *corners,
                         size_t *vertices)
{
    for (size_t i = 0; i < reader->node_count; i++) {
        reader->nodes[i].vertex = -1;
    }
    for (size_t t = 0; t < reader->triangle_count; t++) {
        const struct gm_gmsh_element *element = &reader->triangles[t];
        for (int k = 0; k < 3; k++) {
            struct gm_gmsh_node *node = gm_gmsh_find_node(reader, element->nodes[k]);
            if (!node) {
                return gm_gmsh_fail_at_node(reader, GM_TRIANGULATION_UNKNOWN_NODE, element->line,
                                            element->nodes[k]);
            }
            node->vertex = 0;
        }
    }
    double low = INFINITY, high = -INFINITY, plane = 0, extent = 0;
    for (size_t i = 0; i < reader->node_count; i++) {
        struct gm_gmsh_node *node = &reader->nodes[i];
        if (node->vertex < 0) {
            continue;
        }
        plane = *vertices == 0 ? node->z : plane;
        low = fmin(low, fmin(node->x, node->y));
        high = fmax(high, fmax(node->x, node->y));
        extent = high - low;
        points[2 * *vertices] = node->x;
        points[2 * *vertices + 1] = node->y;
        tags[*vertices] = node->tag;
        node->vertex = (int)(*vertices)++;
    }
    for (size_t i = 0; i < reader->node_count; i++) {
        const struct gm_gmsh_node *node = &reader->nodes[i];
        if (node->vertex >= 0 && fabs(node->z - plane) > 1e-9 * extent) {
            return gm_gmsh_fail_at_node(reader, GM_TRIANGULATION_THREE_D, node->line, node->tag);
        }
    }
    for (size_t t = 0; t < reader->triangle_count; t++) {
        for (size_t k = 0; k < 3; k++) {
            corners[3 * t + k] = gm_gmsh_find_node(reader, reader->triangles[t].nodes[k])->vertex;
        }
    }
    return true;
}

static int compare_curves(const void *a, const void *b)
{
    const struct gm_gmsh_curve *p = a, *q = b;
    return (p->tag > q->tag) - (p->tag < q->tag);
}

static long physical_of(const struct gm_gmsh_reader *reader, long entity)
{
    const struct gm_gmsh_curve key = {.tag = entity};
    const struct gm_gmsh_curve *curve =
        reader->curve_count == 0
            ? NULL
            : bsearch(&key, reader->curves, reader->curve_count, sizeof *reader->curves, compare_curves);
    return curve ? curve->physical : 0;
}

static int find_edge(const struct gm_complex *complex, int a, int b)
{
    for (int k = complex->ring_start[a]; k < complex->ring_start[a + 1]; k++) {
        if (complex->ring_vertex[k] == b) {
            return complex->ring_edge[k];
        }
    }
    return -1;
}

/* Lines that are no edge of a triangle name nothing. */
static bool name_edges(struct gm_gmsh_reader *reader, struct gm_triangulation *mesh)
{
    if (reader->curve_count > 0) {
        qsort(reader->curves, reader->curve_count, sizeof *reader->curves, compare_curves);
    }
    for (size_t i = 0; i < reader->line_count; i++) {
        const struct gm_gmsh_element *element = &reader->lines[i];
        const struct gm_gmsh_node *a = gm_gmsh_find_node(reader, element->nodes[0]),
                                  *b = gm_gmsh_find_node(reader, element->nodes[1]);
        if (!a || !b) {
            return gm_gmsh_fail_at_node(reader, GM_TRIANGULATION_UNKNOWN_NODE, element->line,
                                        element->nodes[a ? 1 : 0]);
        }
        const int e = a->vertex >= 0 && b->vertex >= 0 ? find_edge(mesh->complex, a->vertex, b->vertex) : -1;
        if (e >= 0) {
            mesh->edge_group[e] = (int)physical_of(reader, element->entity);
        }
    }
    return true;
}

static bool assemble(struct gm_gmsh_reader *reader, struct gm_triangulation *mesh)
{
    if (reader->triangle_count == 0) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_EMPTY, "");
    }
    const double plane[2] = {0, 0};
    double *points = malloc(2 * (reader->node_count + 1) * sizeof *points);
    int *corners = malloc(3 * reader->triangle_count * sizeof *corners);
    mesh->tags = malloc((reader->node_count + 1) * sizeof *mesh->tags);
    size_t vertices = 0;
    bool good = points && corners && mesh->tags;
    if (!good) {
        gm_gmsh_fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    good = good && number_nodes(reader, points, mesh->tags, corners, &vertices);
    if (good) {
        mesh->complex = gm_complex_open(points, vertices, corners, reader->triangle_count, plane, mesh->tags,
                                        reader->fault);
        good = mesh->complex != NULL;
        if (!good && reader->fault->triangle > 0) {
            reader->fault->line = reader->triangles[reader->fault->triangle - 1].line;
        }
    }
    free(points);
    free(corners);
    if (good) {
        mesh->edge_group = calloc(mesh->complex->edges, sizeof *mesh->edge_group);
        good = mesh->edge_group || gm_gmsh_fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    return good && name_edges(reader, mesh);
}

bool gm_triangulation_read(const char *text, size_t size, struct gm_triangulation *mesh,
                           struct gm_triangulation_fault *fault)
{
    struct gm_gmsh_reader reader = {.at = text, .end = text + size, .line = 1, .fault = fault, .section = ""};
    *mesh = (struct gm_triangulation){0};
    *fault = (struct gm_triangulation_fault){.kind = GM_TRIANGULATION_OK};
    const bool good = gm_gmsh_read_sections(&reader) && assemble(&reader, mesh);
    if (good) {
        mesh->group = reader.groups;
        mesh->groups = reader.group_count;
        reader.groups = NULL;
    } else {
        gm_triangulation_close(mesh);
    }
    free(reader.nodes);
    free(reader.triangles);
    free(reader.lines);
    free(reader.curves);
    free(reader.groups);
    return good;
}

void gm_triangulation_close(struct gm_triangulation *mesh)
{
    gm_complex_close(mesh->complex);
    free(mesh->tags);
    free(mesh->edge_group);
    free(mesh->group);
    *mesh = (struct gm_triangulation){0};
}

long gm_triangulation_group(const struct gm_triangulation *mesh, const char *name)
{
    for (size_t i = 0; i < mesh->groups; i++) {
        if (strcmp(mesh->group[i].name, name) == 0) {
            return mesh->group[i].tag;
        }
    }
    char *rest = NULL;
    const long tag = strtol(name, &rest, 10);
    for (size_t e = 0; rest != name && *rest == '\0' && mesh->complex && e < mesh->complex->edges; e++) {
        if (mesh->edge_group[e] == tag) {
            return tag;
        }
    }
    return 0;
}
