/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Discrete forms on small meshes whose numbers are known, and the identities of their operators: d d = 0, Stokes'
   theorem, delta is the adjoint of d, and D0' M1 D0 is the matrix of cotangents. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/form/generators.h"
#include "core/form/space.h"

/* A space that owns its complex. */
static struct gm_form_space space_on(struct gm_complex *complex)
{
    struct gm_form_space space;
    assert_true(gm_form_space_open(&space, complex));
    assert_non_null(gm_arena_keep(space.arena, complex, gm_complex_close));
    return space;
}

static struct gm_form_space space_of(const double *points, size_t vertices, const int *corners, size_t count,
                                     enum gm_star star)
{
    const struct gm_triangles from = {.points = points,
                                      .in_space = true,
                                      .vertices = vertices,
                                      .corners = corners,
                                      .count = count,
                                      .star = star};
    struct gm_triangulation_fault fault;
    struct gm_complex *complex = gm_complex_open(&from, &fault);
    assert_non_null(complex);
    return space_on(complex);
}

static struct gm_form_space generated(const char *word, const double *numbers, size_t count,
                                      enum gm_star star)
{
    struct gm_fault wrong;
    struct gm_triangulation_fault fault;
    assert_true(gm_generator_check(word, numbers, count, 0, &wrong));
    struct gm_triangulation mesh;
    assert_true(gm_generator_open(word, numbers, count, star, &mesh, &fault));
    const struct gm_form_space space = space_on(mesh.complex);
    mesh.complex = NULL; /* the space has it */
    gm_triangulation_close(&mesh);
    return space;
}

static double entry(const struct gm_matrix *a, int row, int column)
{
    double value = 0;
    for (int k = a->start[row]; k < a->start[row + 1]; k++) {
        value += a->column[k] == column ? a->value[k] : 0;
    }
    return value;
}

static void near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance)) {
        print_error("%.17g, and %.17g was expected\n", value, expected);
    }
    assert_true(fabs(value - expected) <= tolerance);
}

static double at_random(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed / 4294967296.0 - 0.5;
}

/* Two equilateral triangles, 123 and 243. */
static void two_triangles(void **unused)
{
    (void)unused;
    const double h = sqrt(3) / 2, points[] = {0, 0, 0, 1, 0, 0, 0.5, h, 0, 1.5, h, 0};
    const int corners[] = {0, 1, 2, 1, 3, 2};
    const double star1[] = {0.2886751345948129, 0.2886751345948129, 0.5773502691896258, 0.2886751345948129,
                            0.2886751345948129},
                 star0[] = {0.1443375672974064, 0.2886751345948129, 0.2886751345948129, 0.1443375672974064},
                 d1[2][5] = {{1, -1, 1, 0, 0}, {0, 0, -1, 1, -1}},
                 mass[] = {0.240562612162344, 0.0481125224324688, -0.0481125224324688, 0, 0},
                 transfer[5][5] = {{0, 1, 1, 0, 0},
                                   {-1, 0, 1, 0, 0},
                                   {-1, -1, 0, -1, -1},
                                   {0, 0, 1, 0, -1},
                                   {0, 0, 1, 1, 0}};
    struct gm_form_space space = space_of(points, 4, corners, 2, GM_STAR_AUTO);
    assert_int_equal(space.complex->star, GM_STAR_CIRCUMCENTRIC);
    assert_int_equal(space.complex->pieces, 1);
    assert_int_equal(space.complex->closed, 0);
    gm_form_space_need(&space, space.arena, GM_MATRIX_TRANSFER);
    for (int e = 0; e < 5; e++) {
        near(entry(&space.matrix[GM_MATRIX_STAR1], e, e), star1[e], 1e-15);
        for (int t = 0; t < 2; t++) {
            near(entry(&space.matrix[GM_MATRIX_D1], t, e), d1[t][e], 0);
        }
        for (int f = 0; f < 5; f++) {
            near(6 * entry(&space.matrix[GM_MATRIX_TRANSFER], e, f), transfer[e][f], 1e-14);
        }
    }
    for (int v = 0; v < 4; v++) {
        near(entry(&space.matrix[GM_MATRIX_STAR0], v, v), star0[v], 1e-15);
    }
    gm_form_space_close(&space);
    space = space_of(points, 4, corners, 2, GM_STAR_BARYCENTRIC);
    for (int f = 0; f < 5; f++) {
        near(entry(&space.matrix[GM_MATRIX_STAR1], 0, f), mass[f], 1e-14);
    }
    gm_form_space_close(&space);
}

/* A closed surface whose triangles are written in both orientations encloses a positive volume. */
static void tetrahedron(void **unused)
{
    (void)unused;
    const double points[] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
    const int corners[] = {0, 1, 2, 0, 1, 3, 0, 2, 3, 1, 2, 3};
    struct gm_form_space space = space_of(points, 4, corners, 4, GM_STAR_AUTO);
    const struct gm_complex *complex = space.complex;
    double volume = 0;
    for (size_t t = 0; t < 4; t++) {
        const double *p = points + 3 * complex->triangle[3 * t],
                     *q = points + 3 * complex->triangle[3 * t + 1],
                     *r = points + 3 * complex->triangle[3 * t + 2];
        volume += (p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) +
                   p[2] * (q[0] * r[1] - q[1] * r[0])) /
                  6;
    }
    near(volume, 8.0 / 3, 1e-14);
    near(entry(&space.matrix[GM_MATRIX_STAR1], 3, 3), 0.5773502691896258, 1e-15);
    near(entry(&space.matrix[GM_MATRIX_STAR0], 2, 2), 3.4641016151377544, 1e-14);
    /* x is one of three waves of -laplace = 2/3 */
    double x[4], y[4];
    for (size_t v = 0; v < 4; v++) {
        x[v] = points[3 * v];
    }
    gm_matrix_apply(&space.matrix[GM_MATRIX_LAPLACE], x, y);
    for (size_t v = 0; v < 4; v++) {
        near(y[v], -2.0 / 3 * x[v], 1e-15);
    }
    assert_int_equal(gm_form_betti(complex, 0), 1);
    assert_int_equal(gm_form_betti(complex, 1), 0);
    assert_int_equal(gm_form_betti(complex, 2), 1);
    gm_form_space_close(&space);
}

/* The square 2 x 1: a diagonal of right angles has no dual edge; circles inside have other cells. */
static void square(void **unused)
{
    (void)unused;
    const double points[] = {0, 0, 0, 2, 0, 0, 0, 1, 0, 2, 1, 0};
    const int corners[] = {0, 1, 3, 0, 3, 2};
    struct gm_form_space space = space_of(points, 4, corners, 2, GM_STAR_AUTO);
    assert_int_equal(space.complex->star, GM_STAR_BARYCENTRIC);
    gm_form_space_close(&space);
    space = space_of(points, 4, corners, 2, GM_STAR_INCENTRIC);
    near(space.complex->star0[0], 0.7135254915624211, 1e-14);
    near(space.complex->star0[1], 0.2864745084375788, 1e-14);
    gm_form_space_close(&space);
}

static void one_sided(void **unused)
{
    (void)unused;
    enum { STRIPS = 7 };
    double points[6 * STRIPS];
    int corners[6 * STRIPS];
    for (int i = 0; i < STRIPS; i++) {
        for (int side = 0; side < 2; side++) {
            const double a = 2 * M_PI * i / STRIPS, r = 1 + (side ? 0.3 : -0.3) * cos(a / 2);
            double *p = points + 3 * (2 * i + side);
            p[0] = r * cos(a);
            p[1] = r * sin(a);
            p[2] = (side ? 0.3 : -0.3) * sin(a / 2);
        }
        const int next = (i + 1) % STRIPS, turned = i + 1 == STRIPS;
        const int pair[6] = {2 * i,     2 * i + 1,          2 * next + turned,
                             2 * i + 1, 2 * next + !turned, 2 * next + turned};
        memcpy(corners + 6 * i, pair, sizeof pair);
    }
    const struct gm_triangles from = {
        .points = points, .in_space = true, .vertices = 2 * STRIPS, .corners = corners, .count = 2 * STRIPS};
    struct gm_triangulation_fault fault;
    assert_null(gm_complex_open(&from, &fault));
    assert_int_equal(fault.kind, GM_TRIANGULATION_ONE_SIDED);
    assert_true(fault.nodes[0] != fault.nodes[1] && fault.nodes[0] > 0 && fault.nodes[1] > 0);
}

static const struct {
    const char *word;
    double numbers[4];
    size_t count, vertices, edges, triangles;
    double area, least;
    long betti[3];
} meshes[] = {
    {"sphere", {1, 2}, 2, 162, 480, 320, 12.329848595234669, 0.3673242828514, {1, 0, 1}},
    {"disc", {1, 6}, 2, 127, 342, 216, 3.125667198004746, 0.0951395043782, {1, 0, 0}},
    {"annulus", {1, 2, 24, 3}, 4, 96, 240, 144, 9.317485623690747, 0.2137256728510, {1, 1, 0}},
    {"torus", {2, 0.8, 24, 12}, 4, 288, 864, 576, 62.037707178986, 0.1116918866584, {1, 2, 1}},
    {"flat-torus", {1, 1, 8}, 3, 80, 240, 160, 1, NAN, {1, 2, 1}},
    {"rectangle", {2, 1, 8}, 3, 59, 150, 92, 2, NAN, {1, 0, 0}},
    {"strip", {1, 2}, 2, 4, 5, 2, 0.8660254037844386, 0.2886751345948129, {1, 0, 0}},
    {"strip", {2, 5}, 2, 7, 11, 5, 8.660254037844386, 0.2886751345948129, {1, 0, 0}},
};

static void generators(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < GM_COUNT(meshes); i++) {
        struct gm_form_space space =
            generated(meshes[i].word, meshes[i].numbers, meshes[i].count, GM_STAR_AUTO);
        const struct gm_complex *complex = space.complex;
        if (!isnan(meshes[i].least)) {
            assert_int_equal(complex->vertices, meshes[i].vertices);
            assert_int_equal(complex->edges, meshes[i].edges);
            assert_int_equal(complex->triangles, meshes[i].triangles);
            near(complex->star_least, meshes[i].least, 1e-12);
        }
        near(complex->total_area, meshes[i].area, 1e-11);
        assert_int_equal(complex->star, GM_STAR_CIRCUMCENTRIC);
        for (int k = 0; k < 3; k++) {
            assert_int_equal(gm_form_betti(complex, k), meshes[i].betti[k]);
        }
        gm_form_space_close(&space);
    }
    struct gm_form_space space = generated("annulus", (const double[]){1, 2, 12}, 3, GM_STAR_AUTO);
    assert_int_equal(space.complex->star, GM_STAR_BARYCENTRIC);
    gm_form_space_close(&space);
}

static void identities(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < GM_COUNT(meshes); i++) {
        for (int star = GM_STAR_CIRCUMCENTRIC; star <= GM_STAR_INCENTRIC; star++) {
            struct gm_form_space space =
                generated(meshes[i].word, meshes[i].numbers, meshes[i].count, (enum gm_star)star);
            struct gm_arena *arena = space.arena;
            const struct gm_matrix *m = space.matrix,
                                   *pairs[2][2] = {{&m[GM_MATRIX_D1], &m[GM_MATRIX_D0]},
                                                   {&m[GM_MATRIX_DUAL_D1], &m[GM_MATRIX_DUAL_D0]}};
            for (int dual = 0; dual < 2; dual++) { /* d d = 0, entry by entry */
                const struct gm_matrix dd = gm_matrix_product(arena, pairs[dual][0], pairs[dual][1]);
                for (int k = 0; k < dd.start[dd.rows]; k++) {
                    assert_true(dd.value[k] == 0);
                }
            }
            /* D0' STAR1 D0 = -STAR0 LAPLACE, the matrix of cotangents */
            const struct gm_matrix flux = gm_matrix_product(arena, &m[GM_MATRIX_STAR1], &m[GM_MATRIX_D0]),
                                   stiff = gm_matrix_product(arena, &m[GM_MATRIX_DUAL_D1], &flux),
                                   cells =
                                       gm_matrix_product(arena, &m[GM_MATRIX_STAR0], &m[GM_MATRIX_LAPLACE]),
                                   difference = gm_matrix_sum(arena, 1, &stiff, -1, &cells);
            for (int k = 0; k < difference.start[difference.rows]; k++) {
                near(difference.value[k], 0, 1e-12);
            }
            /* Stokes: the sum of d a over all triangles is the sum of a along the boundary */
            const struct gm_complex *complex = space.complex;
            unsigned seed = 7;
            double *a = malloc(complex->edges * sizeof *a), *da = malloc(complex->triangles * sizeof *da);
            assert_true(a && da);
            double inside = 0, around = 0;
            for (size_t e = 0; e < complex->edges; e++) {
                a[e] = at_random(&seed);
            }
            gm_matrix_apply(&m[GM_MATRIX_D1], a, da);
            for (size_t t = 0; t < complex->triangles; t++) {
                inside += da[t];
            }
            for (size_t e = 0; e < complex->edges; e++) {
                const int *pair = complex->edge_triangle + 2 * e;
                around += pair[1] < 0 ? a[e] : pair[0] < 0 ? -a[e] : 0;
            }
            near(inside, around, 1e-12);
            free(a);
            free(da);
            gm_form_space_close(&space);
        }
    }
}

/* Integrals: of x^2 + y by the seven points on a triangle, exactly; of a closed form around a triangle, 0; of
   dx along an edge, the difference of x. */
static void integrals(void **unused)
{
    (void)unused;
    struct gm_form_space space = generated("disc", (const double[]){1, 4}, 2, GM_STAR_AUTO);
    const struct gm_complex *complex = space.complex;
    const struct gm_form_points faces =
                                    *gm_form_points_of(&space, space.arena, (struct gm_form_type){2, false}),
                                edges =
                                    *gm_form_points_of(&space, space.arena, (struct gm_form_type){1, false}),
                                duals =
                                    *gm_form_points_of(&space, space.arena, (struct gm_form_type){1, true});
    double area = 0, fifth = 0;
    for (size_t i = 0; i < faces.count; i++) {
        const double x = faces.point[i], y = faces.point[faces.count + i];
        area += faces.weight[i];
        fifth += faces.weight[i] * (pow(x, 4) * y + pow(x, 2));
    }
    near(area, complex->total_area, 1e-13);
    double exact = 0; /* of x^2: area/6 times the sum of x_i x_j over i <= j; x^4 y is odd */
    for (size_t t = 0; t < complex->triangles; t++) {
        double p[9];
        gm_complex_corners_in_space(complex, t, p);
        exact += complex->area[t] / 6 *
                 (p[0] * p[0] + p[3] * p[3] + p[6] * p[6] + p[0] * p[3] + p[3] * p[6] + p[6] * p[0]);
    }
    near(fifth, exact, 1e-14);
    for (size_t e = 0; e < complex->edges; e++) {
        double dx = 0, across = 0;
        for (size_t i = 0; i < edges.each; i++) {
            dx += edges.vector[e * edges.each + i];
        }
        const int *pair = complex->edge + 2 * e;
        near(dx, complex->point[3 * pair[1]] - complex->point[3 * pair[0]], 1e-15);
        /* a dual edge is the edge turned by 90 degrees, times star1 */
        for (size_t i = 0; i < duals.each; i++) {
            across += duals.vector[duals.count + e * duals.each + i];
        }
        near(across, complex->star1[e] * dx, 1e-13);
    }
    gm_form_space_close(&space);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_triangles), cmocka_unit_test(tetrahedron), cmocka_unit_test(square),
        cmocka_unit_test(one_sided),     cmocka_unit_test(generators),  cmocka_unit_test(identities),
        cmocka_unit_test(integrals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
