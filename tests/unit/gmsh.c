/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is read of Gmsh files, and what is refused and how. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "tests/common/meshes.h"

static struct gm_triangulation_fault fault_of(const char *text, size_t size)
{
    struct gm_triangulation mesh;
    struct gm_triangulation_fault fault;
    assert_false(gm_triangulation_read(text, size, GM_STAR_CIRCUMCENTRIC, &mesh, &fault));
    assert_null(mesh.complex);
    return fault;
}

static struct gm_triangulation_fault fault_in(const char *file)
{
    size_t size = 0;
    char *text = mesh_text(file, &size);
    const struct gm_triangulation_fault fault = fault_of(text, size);
    free(text);
    return fault;
}

static void broken_files(void **unused)
{
    (void)unused;
    struct gm_triangulation_fault fault = fault_in("truncated.msh");
    assert_int_equal(fault.kind, GM_TRIANGULATION_TRUNCATED);
    assert_string_equal(fault.text, "$Elements");
    fault = fault_in("nonmanifold.msh");
    assert_int_equal(fault.kind, GM_TRIANGULATION_EDGE_OF_THREE);
    assert_int_equal(fault.nodes[0], 15);
    assert_int_equal(fault.nodes[1], 16);
    fault = fault_in("obtuse.msh");
    assert_int_equal(fault.kind, GM_TRIANGULATION_NOT_DELAUNAY);
    assert_true(fault.value > 117.2829 && fault.value < 117.2830);
    assert_true(fault.triangle > 0 && fault.line > 0);
    assert_int_equal(fault.nodes[0] + fault.nodes[1] + fault.nodes[2], 6 + 7 + 17);
}

static void good_files(void **unused)
{
    (void)unused;
    struct gm_triangulation mesh = mesh_of("room-small.msh");
    assert_int_equal(mesh.complex->vertices, 162);
    assert_int_equal(mesh.complex->edges, 449);
    assert_int_equal(mesh.groups, 3);
    size_t counts[4] = {0};
    for (size_t e = 0; e < mesh.complex->edges; e++) {
        counts[gm_triangulation_first(&mesh, e)]++;
    }
    assert_int_equal(counts[1], 28);
    assert_int_equal(counts[2], 3);
    assert_int_equal(counts[3], 3);
    gm_triangulation_close(&mesh);
    mesh = mesh_of("lshape.msh"); /* obtuse, but Delaunay */
    assert_true(mesh.complex->largest_angle > 92);
    gm_triangulation_close(&mesh);
}

/* One mesh in the four formats. */
static void formats(void **unused)
{
    (void)unused;
    struct gm_triangulation first = mesh_of("hole.msh");
    static const char *const others[] = {"hole-binary.msh", "hole-2.2.msh", "hole-2.2-binary.msh"};
    assert_int_equal(first.complex->loops, 2);
    assert_int_equal(gm_triangulation_group(&first, "pillar"), 5);
    for (size_t i = 0; i < 3; i++) {
        struct gm_triangulation mesh = mesh_of(others[i]);
        const size_t vertices = mesh.complex->vertices, triangles = mesh.complex->triangles;
        assert_int_equal(vertices, first.complex->vertices);
        assert_int_equal(triangles, first.complex->triangles);
        assert_int_equal(mesh.groups, first.groups);
        for (size_t v = 0; v < 2 * vertices; v++) { /* 2.2 writes 16 digits */
            assert_true(fabs(mesh.complex->point[v] - first.complex->point[v]) < 1e-14);
        }
        assert_memory_equal(mesh.complex->triangle, first.complex->triangle, 3 * triangles * sizeof(int));
        for (size_t e = 0; e < mesh.complex->edges; e++) {
            assert_int_equal(gm_triangulation_first(&mesh, e), gm_triangulation_first(&first, e));
        }
        gm_triangulation_close(&mesh);
    }
    gm_triangulation_close(&first);
}

/* Triangles that are not Delaunay have cells of thirds, and operators that are those of linear elements. */
static void stars(void **unused)
{
    (void)unused;
    struct gm_triangulation mesh = mesh_of("obtuse.msh");
    const struct gm_complex *complex = mesh.complex;
    assert_int_equal(complex->star, GM_STAR_BARYCENTRIC);
    assert_true(complex->star_least < 0 && complex->obtuse > 0);
    double *cell = calloc(complex->vertices, sizeof *cell);
    for (size_t k = 0; k < 3 * complex->triangles; k++) {
        const double *a = complex->point + 2 * complex->triangle[k / 3 * 3],
                     *b = complex->point + 2 * complex->triangle[k / 3 * 3 + 1],
                     *c = complex->point + 2 * complex->triangle[k / 3 * 3 + 2];
        cell[complex->triangle[k]] += ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 6;
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        assert_true(fabs(cell[v] - complex->star0[v]) < 1e-15);
    }
    free(cell);
    gm_triangulation_close(&mesh);
    mesh = mesh_of("lshape.msh"); /* obtuse, but Delaunay */
    assert_int_equal(mesh.complex->star, GM_STAR_CIRCUMCENTRIC);
    gm_triangulation_close(&mesh);
}

#define HEAD "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
#define OLD "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
#define OLD_SQUARE "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1.1 1 0\n4 0 1.2 0\n$EndNodes\n"
#define SQUARE "$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1.1 1 0\n0 1.2 0\n$EndNodes\n"
#define ELEMENTS(text) "$Elements\n" text "$EndElements\n"

/* Of five triangles around node 1 the last has the angle 90 + atan(7/23) degrees there, which faces the boundary. That
   of 125 degrees in the first one is larger, but it faces an edge whose dual is positive: the mesh is Delaunay there. */
static void largest_angle_of_a_bad_edge(void **unused)
{
    (void)unused;
    static const char text[] = HEAD
        "$Nodes\n1 6 1 6\n2 1 0 6\n1\n2\n3\n4\n5\n6\n0 0 0\n0 1.3 0\n-.3 .4 0\n-1.4 .1 0\n-.7 -2.3 0\n"
        "2.3 -.7 0\n$EndNodes\n" ELEMENTS("1 5 1 5\n2 1 2 5\n1 3 1 2\n2 4 5 1\n3 3 4 1\n4 1 5 6\n5 2 1 6\n");
    const struct gm_triangulation_fault fault = fault_of(text, strlen(text));
    assert_int_equal(fault.kind, GM_TRIANGULATION_NOT_DELAUNAY);
    assert_int_equal(fault.triangle, 5);
    assert_true(fabs(fault.value - (90 + atan(7. / 23) * 180 / M_PI)) < 1e-12);
}

static void sentences(void **unused)
{
    (void)unused;
    static const struct {
        const char *text;
        enum gm_triangulation_fault_kind kind;
        long line;
    } cases[] = {
        {"", GM_TRIANGULATION_NOT_GMSH, 1},
        {"solid cube", GM_TRIANGULATION_NOT_GMSH, 1},
        {"$MeshFormat\n3.0 0 8\n$EndMeshFormat\n", GM_TRIANGULATION_VERSION, 2},
        {"$MeshFormat\n4.1 2 8\n", GM_TRIANGULATION_SYNTAX, 2},
        {"$MeshFormat\n4.1 0 4\n", GM_TRIANGULATION_SYNTAX, 2},
        {"$MeshFormat\n4.1 1 8\n", GM_TRIANGULATION_TRUNCATED, 0},
        {"$MeshFormat\n4.1 1 8\n\1\1\1\1", GM_TRIANGULATION_BYTES, 0},
        {OLD, GM_TRIANGULATION_EMPTY, 0},
        {OLD "$Nodes\n9\n1 0 0 0\n", GM_TRIANGULATION_TRUNCATED, 5},
        {OLD OLD_SQUARE "$Elements\n1\n1 3 2 1 1 1 2 3 4\n$EndElements\n", GM_TRIANGULATION_ELEMENT, 13},
        {OLD OLD_SQUARE "$Elements\n1\n1 9 2 1 1 1 2 3 4 5\n$EndElements\n", GM_TRIANGULATION_SYNTAX, 14},
        {OLD OLD_SQUARE "$Elements\n1\n1 2 2 1 1 1 2 7\n$EndElements\n", GM_TRIANGULATION_UNKNOWN_NODE, 13},
        {OLD OLD_SQUARE "$Elements\n2\n1 2 2 1 1 1 2 3\n$EndElements\n", GM_TRIANGULATION_SYNTAX, 14},
        {HEAD, GM_TRIANGULATION_EMPTY, 0},
        {HEAD SQUARE, GM_TRIANGULATION_EMPTY, 0},
        {HEAD "$Nodes\n1 99999999 1 4\n", GM_TRIANGULATION_HUGE, 5},
        {HEAD "$Nodes\n1 4000000 1 4\n", GM_TRIANGULATION_TRUNCATED, 5},
        {HEAD "$Nodes\n1 99999999999999999999 1 4\n", GM_TRIANGULATION_SYNTAX, 5},
        {HEAD "$Nodes\n1 2 1 4\n2 1 0 2\n1\n1\n0 0 0\n1 1 0\n$EndNodes\n", GM_TRIANGULATION_REPEATED_NODE, 8},
        {HEAD "$Nodes\n1 2 1 4\n2 1 0 2\n1\n2\n0 nan 0\n1 1 0\n$EndNodes\n", GM_TRIANGULATION_SYNTAX, 9},
        {HEAD "$Nodes\n1 2 1 4\n2 1 0 2\n1\n2\n0 x 0\n1 1 0\n$EndNodes\n", GM_TRIANGULATION_SYNTAX, 9},
        {HEAD SQUARE ELEMENTS("1 1 1 1\n2 1 3 1\n1 1 2 3 4\n"), GM_TRIANGULATION_ELEMENT, 18},
        {HEAD SQUARE ELEMENTS("1 1 1 1\n2 1 2 1\n1 1 2 9\n"), GM_TRIANGULATION_UNKNOWN_NODE, 19},
        {HEAD SQUARE ELEMENTS("1 1 1 1\n2 1 2 1\n1 1 2 2\n"), GM_TRIANGULATION_DEGENERATE, 19},
        {HEAD SQUARE ELEMENTS("1 2 1 2\n2 1 2 2\n1 1 2 3\n2 1 2 4\n"), GM_TRIANGULATION_OVERLAP, 20},
        {HEAD SQUARE ELEMENTS("1 1 1 1\n2 1 2 1\n1 1 2\n3\n"), GM_TRIANGULATION_SYNTAX, 20},
        {HEAD SQUARE ELEMENTS("1 2 1 2\n2 1 2 1\n1 1 2 3\n"), GM_TRIANGULATION_SYNTAX, 19},
        {HEAD "$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n.5 1 .3\n.5 -1 .3\n$EndNodes\n" ELEMENTS(
             "1 2 1 2\n2 1 2 2\n1 1 2 3\n2 1 4 2\n"),
         GM_TRIANGULATION_THREE_D, 9},
        {HEAD
         "$Nodes\n1 5 1 5\n2 1 0 5\n1\n2\n3\n4\n5\n0 0 0\n1 0 0\n.5 1 0\n-1 0 0\n-.5 -1 0\n$EndNodes\n" ELEMENTS(
             "1 2 1 2\n2 1 2 2\n1 1 2 3\n2 1 4 5\n"),
         GM_TRIANGULATION_PINCHED, 0},
        {HEAD
         "$Nodes\n1 6 1 6\n2 1 0 6\n1\n2\n3\n4\n5\n6\n0 0 0\n1 0 0\n.5 1 0\n5 0 0\n6 0 0\n5.5 1 0\n$EndNodes\n" ELEMENTS(
             "1 2 1 2\n2 1 2 2\n1 1 2 3\n2 4 5 6\n"),
         GM_TRIANGULATION_PIECES, 0},
        {HEAD "$Comments\nnever ends\n", GM_TRIANGULATION_TRUNCATED, 6},
        {HEAD "Nodes\n", GM_TRIANGULATION_SYNTAX, 4},
        {HEAD "$PhysicalNames\n1\n1 1 wall\n", GM_TRIANGULATION_SYNTAX, 6},
    };
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        const struct gm_triangulation_fault fault = fault_of(cases[i].text, strlen(cases[i].text));
        if (fault.kind != cases[i].kind || (cases[i].line && fault.line != cases[i].line)) {
            fail_msg("case %zu: fault %d in line %ld", i, (int)fault.kind, fault.line);
        }
    }
}

/* Cut anywhere, a file is refused or read; never more than that. */
static void cut_anywhere(void **unused)
{
    (void)unused;
    static const char *const files[] = {"square-small.msh", "hole-2.2.msh", "hole-binary.msh",
                                        "hole-2.2-binary.msh"};
    for (int file = 0; file < 4; file++) {
        size_t size = 0, read = 0;
        char *text = mesh_text(files[file], &size);
        for (size_t end = 0; end < size; end += 1 + (file > 0) * 7) {
            char *part = malloc(end + 1); /* so that an overrun is seen */
            struct gm_triangulation mesh;
            struct gm_triangulation_fault fault;
            memcpy(part, text, end);
            if (gm_triangulation_read(part, end, GM_STAR_AUTO, &mesh, &fault)) {
                read++;
                gm_triangulation_close(&mesh);
            }
            free(part);
        }
        assert_true(read <= 2); /* without its last line end */
        free(text);
    }
}

/* The length of the boundary that carries a group. */
static double length_of(const struct gm_triangulation *mesh, long group)
{
    double length = 0;
    for (size_t b = 0; b < mesh->complex->boundary; b++) {
        const int e = mesh->complex->boundary_edge[b];
        length += gm_triangulation_first(mesh, e) == group ? mesh->complex->length[e] : 0;
    }
    return length;
}

/* The same two squares as Gmsh writes them: a triangle for each of its surfaces, nodes with parameters, in parts, in
   the plane of x and z. */
static void as_written(void **unused)
{
    (void)unused;
    static const char *const files[] = {"groups-2.2.msh", "parametric-2.2.msh", "parametric-2.2-binary.msh",
                                        "parts.msh", "upright.msh"};
    size_t triangles = 0;
    for (size_t i = 0; i < GM_COUNT(files); i++) {
        struct gm_triangulation mesh = mesh_of(files[i]);
        triangles = i == 0 ? mesh.complex->triangles : triangles;
        assert_int_equal(mesh.complex->triangles, triangles);
        assert_true(fabs(mesh.complex->total_area - 2) < 1e-12);
        const long in = gm_triangulation_group(&mesh, "in"), all = gm_triangulation_group(&mesh, "all");
        double length[2] = {0};
        for (size_t b = 0; b < mesh.complex->boundary; b++) {
            const size_t e = (size_t)mesh.complex->boundary_edge[b];
            length[0] += gm_triangulation_has(&mesh, e, in) ? mesh.complex->length[e] : 0;
            length[1] += gm_triangulation_has(&mesh, e, all) ? mesh.complex->length[e] : 0;
        }
        assert_true(fabs(length[0] - 1) < 1e-12 && fabs(length[1] - 6) < 1e-12);
        gm_triangulation_close(&mesh);
    }
    struct gm_triangulation mesh = mesh_of("unnamed.msh");
    char names[128];
    assert_string_equal(gm_triangulation_group_names(&mesh, names, sizeof names), "7, 8");
    assert_int_equal(gm_triangulation_group(&mesh, "8"), 8);
    assert_int_equal(gm_triangulation_group(&mesh, "9"), 0);
    gm_triangulation_close(&mesh);
}

/* Triangles of the second order are their corners, lines their ends, and what is there twice counts once. */
static void second_order_and_twice(void **unused)
{
    (void)unused;
    static const char *const texts[] = {
        HEAD SQUARE ELEMENTS("1 3 1 3\n2 1 2 3\n1 1 2 3\n2 1 3 4\n3 3 1 2\n"),
        HEAD "$Nodes\n1 9 1 9\n2 1 0 9\n1\n2\n3\n4\n5\n6\n7\n8\n9\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n.5 -.1 0\n"
             ".5 .5 0\n0 .5 0\n1 .5 0\n.5 1 0\n$EndNodes\n" ELEMENTS(
                 "2 3 1 3\n1 1 8 1\n3 1 2 5\n2 1 9 2\n1 1 2 3 5 6 7\n2 2 4 3 8 9 6\n")};
    for (size_t i = 0; i < GM_COUNT(texts); i++) {
        struct gm_triangulation mesh;
        struct gm_triangulation_fault fault;
        if (!gm_triangulation_read(texts[i], strlen(texts[i]), GM_STAR_AUTO, &mesh, &fault)) {
            fail_msg("text %zu: fault %d in line %ld", i, (int)fault.kind, fault.line);
        }
        assert_int_equal(mesh.complex->triangles, 2);
        assert_int_equal(mesh.complex->vertices, 4);
        assert_true(fabs(mesh.complex->total_area - (i == 0 ? 1.16 : 1)) < 1e-15);
        gm_triangulation_close(&mesh);
    }
}

/* Halved, a mesh is the same polygon with the same angles, names and vertices. */
static void halves(void **unused)
{
    (void)unused;
    struct gm_triangulation mesh = mesh_of("hole.msh"), fine = mesh_of("hole.msh");
    struct gm_triangulation_fault fault;
    assert_false(gm_triangulation_halve(&fine, GM_STAR_CIRCUMCENTRIC, &fault)); /* it has obtuse triangles */
    assert_int_equal(fault.kind, GM_TRIANGULATION_NOT_DELAUNAY);
    assert_int_equal(fine.complex->triangles, mesh.complex->triangles);
    assert_true(gm_triangulation_halve(&fine, GM_STAR_AUTO, &fault));
    const struct gm_complex *a = mesh.complex, *b = fine.complex;
    assert_int_equal(b->vertices, a->vertices + a->edges);
    assert_int_equal(b->triangles, 4 * a->triangles);
    assert_int_equal(b->boundary, 2 * a->boundary);
    assert_int_equal(b->loops, a->loops);
    assert_memory_equal(b->point, a->point, 2 * a->vertices * sizeof *a->point);
    assert_true(fabs(b->total_area - a->total_area) < 1e-13);
    assert_true(fabs(b->largest_angle - a->largest_angle) < 1e-9);
    assert_int_equal(b->obtuse, 4 * a->obtuse);
    for (size_t i = 0; i < mesh.groups; i++) {
        const long tag = mesh.group[i].tag;
        assert_true(length_of(&mesh, tag) > 0);
        assert_true(fabs(length_of(&fine, tag) - length_of(&mesh, tag)) < 1e-13);
    }
    for (size_t v = 1; v < b->vertices; v++) {
        assert_true(fine.tags[v] > fine.tags[v - 1]);
    }
    gm_triangulation_close(&mesh);
    gm_triangulation_close(&fine);
}

/* Boundaries that make no room. */
static void boundaries(void **unused)
{
    (void)unused;
    struct gm_triangulation mesh = mesh_of("room-small.msh");
    const struct gm_complex *complex = mesh.complex;
    unsigned char *sides = sides_of(&mesh);
    struct gm_flow *flow = gm_flow_open(mesh.complex);
    const size_t n = complex->boundary;
    size_t inlet = 0;
    while (sides[inlet] != GM_EDGE_INLET || sides[(inlet + n - 1) % n] == GM_EDGE_INLET) {
        inlet++;
    }
    sides[(inlet + 1) % n] = GM_EDGE_WALL;
    assert_int_equal(set_boundary(flow, sides, 1, GM_VERTEX_SOFT, 1), GM_BOUNDARY_SHORT);
    sides[(inlet + 2) % n] = GM_EDGE_WALL;
    assert_int_equal(set_boundary(flow, sides, 1, GM_VERTEX_SOFT, 1), GM_BOUNDARY_SHORT);
    sides[inlet] = GM_EDGE_WALL;
    assert_int_equal(set_boundary(flow, sides, 1, GM_VERTEX_SOFT, 1), GM_BOUNDARY_NO_INLET);
    memset(sides, GM_EDGE_OUTLET, n);
    assert_int_equal(set_boundary(flow, sides, 1, GM_VERTEX_SOFT, 1), GM_BOUNDARY_WHOLE);
    memset(sides, GM_EDGE_WALL, n);
    sides[0] = sides[1] = GM_EDGE_INLET;
    assert_int_equal(set_boundary(flow, sides, 1, GM_VERTEX_SOFT, 1), GM_BOUNDARY_NO_OUTLET);
    free(sides);
    mesh.complex = NULL;
    gm_triangulation_close(&mesh);
    gm_flow_close(flow);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(good_files),
        cmocka_unit_test(broken_files),
        cmocka_unit_test(largest_angle_of_a_bad_edge),
        cmocka_unit_test(sentences),
        cmocka_unit_test(cut_anywhere),
        cmocka_unit_test(boundaries),
        cmocka_unit_test(formats),
        cmocka_unit_test(stars),
        cmocka_unit_test(halves),
        cmocka_unit_test(second_order_and_twice),
        cmocka_unit_test(as_written),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
