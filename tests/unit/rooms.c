/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flows on triangles of any shape, around holes and through several openings, against exact solutions. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/arena.h"
#include "core/basics.h"
#include "core/flow/boundary.h"
#include "core/form/generators.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/common/meshes.h"

/* A number in [-1, 1] that is the same everywhere. */
static double scatter(unsigned i)
{
    i = (i + 0x9e3779b9u) * 0x85ebca6bu;
    i = (i ^ (i >> 15)) * 0xc2b2ae35u;
    return (double)((i ^ (i >> 13)) & 0xffffu) / 32767.5 - 1;
}

struct points {
    double *at;
    int *corner;
    size_t vertices, triangles;
};

/* A grid of columns by rows cells, each of two triangles; around: its left side is its right one. */
static struct points grid(int columns, int rows, bool around)
{
    const int across = around ? columns : columns + 1;
    struct points points = {malloc(2 * sizeof(double) * (size_t)(across * (rows + 1))),
                            malloc(6 * sizeof(int) * (size_t)(columns * rows)), (size_t)(across * (rows + 1)),
                            (size_t)(2 * columns * rows)};
    assert_true(points.at && points.corner);
    for (int j = 0; j < rows; j++) {
        for (int i = 0; i < columns; i++) {
            const int a = j * across + i, b = j * across + (i + 1) % across, c = b + across, d = a + across;
            const int straight[6] = {a, b, c, a, c, d}, other[6] = {a, b, d, b, c, d};
            memcpy(points.corner + 6 * (j * columns + i), (i + j) % 2 ? other : straight, sizeof other);
        }
    }
    return points;
}

static struct gm_flow *flow_of_points(struct points *points, enum gm_star star)
{
    struct gm_triangulation_fault fault;
    struct gm_complex *complex = gm_complex_open(&(struct gm_triangles){.points = points->at,
                                                                        .vertices = points->vertices,
                                                                        .corners = points->corner,
                                                                        .count = points->triangles,
                                                                        .star = star},
                                                 &fault);
    assert_non_null(complex);
    free(points->at);
    free(points->corner);
    struct gm_flow *flow = gm_flow_open(complex);
    assert_non_null(flow);
    return flow;
}

static struct gm_run *open_run(const struct gm_flow *flow, struct gm_problem *problem, const char *scheme,
                               double dt, const double *start)
{
    const struct gm_settings settings = {0};
    *problem = (struct gm_problem){
        .name = "flow", .n = gm_flow_size(flow), .m = 1, .kind = &gm_kind_flow, .parameters = flow};
    struct gm_run *run = gm_run_open(problem, gm_scheme_find(scheme), &settings, 0, dt, start);
    assert_non_null(run);
    return run;
}

/* L. Kovasznay, Proc. Camb. Phil. Soc. 44 (1948) 58: a steady flow behind a grid, Re = 40. */
static double rate(void)
{
    return 20 - sqrt(400 + 4 * M_PI * M_PI);
}

static double kovasznay_psi(double x, double y)
{
    return y - exp(rate() * x) * sin(2 * M_PI * y) / (2 * M_PI);
}

static void kovasznay_velocity(double x, double y, double u[2])
{
    u[0] = 1 - exp(rate() * x) * cos(2 * M_PI * y);
    u[1] = rate() / (2 * M_PI) * exp(rate() * x) * sin(2 * M_PI * y);
}

/* p + |u|^2 / 2 */
static double kovasznay_pressure(double x, double y)
{
    double u[2];
    kovasznay_velocity(x, y, u);
    return -exp(2 * rate() * x) / 2 + (u[0] * u[0] + u[1] * u[1]) / 2;
}

enum { PSI, VELOCITY, PRESSURE, WALLS /* pressure of the triangles along the boundary */, ERRORS };

/* A mesh of [0, 3/2] x [0, 1]: acute triangles, shaken, or right-angled ones that are shaken until they are
   not even Delaunay. */
static struct gm_flow *open_mesh(int n, bool acute, enum gm_star star)
{
    struct gm_triangulation_fault fault;
    if (acute) {
        const struct gm_rectangle rectangle = {.width = 1.5,
                                               .height = 1,
                                               .edges = 3 * n / 2,
                                               .strips = gm_rectangle_strips(1.5, 1, 3 * n / 2, false),
                                               .irregular = 0.3};
        struct gm_complex *complex = gm_rectangle_open(&rectangle, &fault);
        assert_non_null(complex);
        struct points points = {malloc(2 * complex->vertices * sizeof(double)),
                                malloc(3 * complex->triangles * sizeof(int)), complex->vertices,
                                complex->triangles};
        assert_true(points.at && points.corner);
        memcpy(points.at, complex->point, 2 * complex->vertices * sizeof(double));
        memcpy(points.corner, complex->triangle, 3 * complex->triangles * sizeof(int));
        gm_complex_close(complex);
        return flow_of_points(&points, star);
    }
    const int across = 3 * n / 2 + 1;
    struct points points = grid(3 * n / 2, n, false);
    for (size_t v = 0; v < points.vertices; v++) {
        const int i = (int)v % across, j = (int)v / across;
        const double shaken = i > 0 && i + 1 < across && j > 0 && j < n ? 0.22 / n : 0;
        points.at[2 * v] = (double)i / n + shaken * scatter(2 * (unsigned)v);
        points.at[2 * v + 1] = (double)j / n + shaken * scatter(2 * (unsigned)v + 1);
    }
    return flow_of_points(&points, star);
}

/* The errors of the steady state on [-1/2, 1] x [-1/2, 1/2]. */
static void kovasznay(struct gm_flow *flow, double error[ERRORS])
{
    for (size_t v = 0; v < 2 * flow->complex->vertices; v++) {
        flow->complex->point[v] -= 0.5;
    }
    const struct gm_complex *complex = flow->complex;
    flow->viscosity = 1.0 / 40;
    flow->reynolds = 40;
    for (size_t b = 0; b < complex->boundary; b++) {
        const int v = complex->boundary_vertex[b], w = complex->boundary_vertex[gm_complex_next(complex, b)];
        const double *p = complex->point + 2 * v, *q = complex->point + 2 * w;
        flow->kind[v] = GM_VERTEX_FIXED;
        flow->psi[v] = kovasznay_psi(p[0], p[1]);
        /* the circulation that each half of a boundary edge adds, by Simpson's rule */
        for (int half = 0; half < 2; half++) {
            static const double weight[3] = {1, 4, 1};
            for (int k = 0; k < 3; k++) {
                const double s = half * 0.5 + k * 0.25;
                double u[2];
                kovasznay_velocity(p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1]), u);
                flow->sheet[half ? w : v] += weight[k] / 12 * (u[0] * (q[0] - p[0]) + u[1] * (q[1] - p[1]));
            }
        }
    }
    double *start = malloc(gm_flow_size(flow) * sizeof *start);
    double *pressure = malloc(complex->triangles * sizeof *pressure);
    assert_true(start && pressure && gm_flow_start(flow, NULL, start));
    struct gm_problem problem;
    struct gm_run *run = open_run(flow, &problem, "steady", 1, start);
    gm_run_advance(run, 9);
    assert_int_equal(run->status, GM_OK);
    const double *y = gm_run_state(run);
    assert_true(gm_flow_pressure(flow, y, pressure));
    memset(error, 0, ERRORS * sizeof *error);
    double mean = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        const double *p = complex->point + 2 * v;
        error[PSI] += complex->star0[v] * pow(y[v] - kovasznay_psi(p[0], p[1]), 2);
    }
    for (int pass = 0; pass < 2; pass++) {
        for (size_t t = 0; t < complex->triangles; t++) {
            double c[6], u[2], exact[2], centre[2];
            gm_complex_corners(complex, t, c);
            gm_complex_centre(complex, t, centre);
            gm_flow_velocity(complex, y, t, u);
            kovasznay_velocity((c[0] + c[2] + c[4]) / 3, (c[1] + c[3] + c[5]) / 3, exact);
            const double off = pressure[t] - kovasznay_pressure(centre[0], centre[1]);
            mean += pass ? 0 : complex->area[t] / complex->total_area * off;
            error[PRESSURE] += pass ? complex->area[t] * pow(off - mean, 2) : 0;
            error[VELOCITY] +=
                pass ? complex->area[t] * (pow(u[0] - exact[0], 2) + pow(u[1] - exact[1], 2)) : 0;
        }
    }
    for (size_t b = 0; b < complex->boundary; b++) {
        const int *side = complex->edge_triangle + 2 * complex->boundary_edge[b];
        const size_t t = (size_t)(side[0] < 0 ? side[1] : side[0]);
        const double *p = complex->point + 2 * complex->boundary_vertex[b],
                     *q = complex->point + 2 * complex->boundary_vertex[gm_complex_next(complex, b)];
        double centre[2];
        gm_complex_centre(complex, t, centre);
        error[WALLS] += hypot(q[0] - p[0], q[1] - p[1]) *
                        pow(pressure[t] - kovasznay_pressure(centre[0], centre[1]) - mean, 2);
    }
    for (int k = 0; k < ERRORS; k++) {
        error[k] = sqrt(error[k]);
    }
    gm_run_close(run);
    free(start);
    free(pressure);
    gm_flow_close(flow);
}

/* The same rectangle by Gmsh's MeshAdapt (tests/reference/meshes/meshadapt.geo), coarser: 6, 12 and 24 cells a
   length. */
static struct gm_flow *open_meshadapt(int n, enum gm_star star)
{
    char name[32];
    snprintf(name, sizeof name, "meshadapt-%d.msh", n);
    struct gm_triangulation mesh = mesh_of(name);
    struct points points = {malloc(2 * mesh.complex->vertices * sizeof(double)),
                            malloc(3 * mesh.complex->triangles * sizeof(int)), mesh.complex->vertices,
                            mesh.complex->triangles};
    assert_true(points.at && points.corner);
    memcpy(points.at, mesh.complex->point, 2 * points.vertices * sizeof(double));
    memcpy(points.corner, mesh.complex->triangle, 3 * points.triangles * sizeof(int));
    gm_triangulation_close(&mesh);
    return flow_of_points(&points, star);
}

enum triangles { ACUTE, SHAKEN, MESHADAPT };

/* Orders over three meshes, from 16 to 64 cells a length, of MeshAdapt 6 to 24; with GEOMINT_ORDERS set they
   are printed. */
static void orders(void **unused)
{
    (void)unused;
    static const struct {
        const char *name;
        enum triangles triangles;
        enum gm_star star;
        double least[ERRORS];
    } cases[] = {
        {"acute, circumcentric", ACUTE, GM_STAR_CIRCUMCENTRIC, {1.8, 0.9, 1.7, 1.5}},
        {"acute, barycentric", ACUTE, GM_STAR_BARYCENTRIC, {1.8, 0.9, 1.7, 1.5}},
        {"obtuse, barycentric", SHAKEN, GM_STAR_AUTO, {1.4, 0.9, 0.8, 0.3}},
        {"MeshAdapt, barycentric", MESHADAPT, GM_STAR_AUTO, {1.8, 0.9, 1.4, 1.2}},
    };
    bool good = true;
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        double error[3][ERRORS];
        for (int k = 0; k < 3; k++) {
            const enum triangles triangles = cases[i].triangles;
            struct gm_flow *flow = triangles == MESHADAPT
                                       ? open_meshadapt(6 << k, cases[i].star)
                                       : open_mesh(16 << k, triangles == ACUTE, cases[i].star);
            assert_true(triangles == ACUTE || flow->complex->star == GM_STAR_BARYCENTRIC);
            kovasznay(flow, error[k]);
        }
        for (int k = 0; k < ERRORS; k++) {
            const double order = log2(error[0][k] / error[2][k]) / 2;
            if (getenv("GEOMINT_ORDERS")) {
                printf("%s, error of %s: %.2e %.2e %.2e, order %.2f\n", cases[i].name,
                       (const char *const[]){"psi", "velocity", "pressure", "pressure along the boundary"}[k],
                       error[0][k], error[1][k], error[2][k], order);
            }
            good &= order > cases[i].least[k];
        }
    }
    assert_true(good);
}

/* Air between cylinders of radii 1 and 2, of which the inner one turns with the speed 1: u = a r + b / r. How
   much goes around, psi on the inner one, is what makes the pressure single-valued. */
static double couette(int n, double shaken)
{
    struct points points = grid(6 * n, n, true);
    for (size_t v = 0; v < points.vertices; v++) {
        const int i = (int)v % (6 * n), j = (int)v / (6 * n);
        const bool inside = j > 0 && j < n;
        const double angle = 2 * M_PI * (i + (inside ? shaken * scatter(2 * (unsigned)v) : 0)) / (6 * n),
                     r = 1 + (j + (inside ? shaken * scatter(2 * (unsigned)v + 1) : 0)) / n;
        points.at[2 * v] = r * cos(angle);
        points.at[2 * v + 1] = r * sin(angle);
    }
    struct gm_flow *flow = flow_of_points(&points, GM_STAR_AUTO);
    const struct gm_complex *complex = flow->complex;
    unsigned char *side_of = calloc(complex->boundary, 1);
    assert_non_null(side_of);
    for (size_t b = 0; b < complex->boundary; b++) {
        const double *p = complex->point + 2 * complex->boundary_vertex[b];
        side_of[b] = hypot(p[0], p[1]) < 1.5;
    }
    /* with the air on its right hand the inner cylinder turns counter-clockwise */
    const struct gm_side sides[2] = {{.kind = GM_EDGE_WALL}, {.kind = GM_EDGE_LID, .speed = 1}};
    assert_int_equal(gm_flow_set_sides(flow, side_of, sides, GM_VERTEX_SOFT), GM_BOUNDARY_OK);
    assert_int_equal(flow->holes, 1);
    free(side_of);
    flow->viscosity = 0.1;
    flow->reynolds = 10;
    double *start = malloc(gm_flow_size(flow) * sizeof *start), force[2];
    assert_true(start && gm_flow_start(flow, NULL, start));
    struct gm_problem problem;
    struct gm_run *run = open_run(flow, &problem, "steady", 1, start);
    gm_run_advance(run, 8);
    assert_int_equal(run->status, GM_OK);
    const double *y = gm_run_state(run);
    double inner = NAN, outer = NAN;
    for (size_t v = 0; v < complex->vertices; v++) {
        const double r = hypot(complex->point[2 * v], complex->point[2 * v + 1]);
        inner = r < 1 + 1e-9 ? y[v] : inner;
        outer = r > 2 - 1e-9 ? y[v] : outer;
    }
    gm_flow_force(flow, y, 1, force);
    assert_true(shaken > 0 || hypot(force[0], force[1]) < 1e-10);
    gm_run_close(run);
    free(start);
    gm_flow_close(flow);
    /* u_theta = -psi_r, a = -1/3, b = 4/3: psi(1) - psi(2) */
    return fabs(inner - outer - (-1.0 / 3 * 1.5 + 4.0 / 3 * log(2)));
}

static void circulation_is_found(void **unused)
{
    (void)unused;
    for (int shaken = 0; shaken < 2; shaken++) {
        const double coarse = couette(6, 0.3 * shaken), fine = couette(24, 0.3 * shaken);
        if (!(log2(coarse / fine) / 2 > 1.5)) {
            fail_msg("psi of the inner cylinder: errors %.2e and %.2e", coarse, fine);
        }
    }
}

/* A room with two inlets, two outlets and a pillar. */
static struct gm_flow *open_room(double window)
{
    struct gm_triangulation mesh = mesh_of("hole.msh");
    struct gm_flow *flow = gm_flow_open(mesh.complex);
    unsigned char *side_of = calloc(mesh.complex->boundary, 1);
    assert_true(flow && side_of);
    for (size_t b = 0; b < mesh.complex->boundary; b++) {
        side_of[b] = (unsigned char)gm_triangulation_first(&mesh, (size_t)mesh.complex->boundary_edge[b]);
    }
    const struct gm_side sides[6] = {
        {.kind = GM_EDGE_WALL, .theta_free = true},
        {.kind = GM_EDGE_INLET, .flow = 0.4, .theta = 1},
        {.kind = GM_EDGE_INLET, .flow = NAN, .speed = 0.5, .theta = 3},
        {.kind = GM_EDGE_OUTLET, .flow = window},
        {.kind = GM_EDGE_OUTLET, .flow = NAN},
        {.kind = GM_EDGE_WALL, .theta = 2},
    };
    assert_int_equal(gm_flow_set_sides(flow, side_of, sides, GM_VERTEX_SOFT), GM_BOUNDARY_OK);
    free(side_of);
    mesh.complex = NULL;
    gm_triangulation_close(&mesh);
    flow->viscosity = 0.02;
    flow->diffusivity = 0.03;
    flow->scalar = true;
    return flow;
}

static void flows_are_shared(void **unused)
{
    (void)unused;
    struct gm_flow *flow = open_room(0.15);
    double in = 0, out = 0;
    assert_int_equal(flow->openings, 4);
    for (size_t i = 0; i < flow->openings; i++) {
        const struct gm_opening *opening = &flow->opening[i];
        *(opening->inlet ? &in : &out) += opening->flow;
        assert_true(opening->side != 3 || opening->flow == 0.15);
        assert_true(opening->side != 2 || fabs(opening->flow - 0.8 / 3) < 1e-15);
    }
    assert_true(fabs(in - out) < 1e-15);
    gm_flow_close(flow);
}

/* As many tracers come in as stand for the air that does, those of sources at their place; none is seen before. */
static void smoke_comes_in(void **unused)
{
    (void)unused;
    enum { TRACERS = 400, STEPS = 25 };
    const double dt = 0.04;
    struct gm_flow *flow = open_room(0.15);
    struct gm_flow_place place = {0}, *source = &place;
    for (int k = 0; k < 3; k++) {
        const double *corner = flow->complex->point + 2 * flow->complex->triangle[k];
        source->x[0] += corner[0] / 3;
        source->x[1] += corner[1] / 3;
    }
    flow->tracers = TRACERS;
    flow->smoke = true;
    flow->smoking = source;
    flow->smoking_count = 1;
    double in = 0;
    size_t at_source = 0;
    for (size_t i = 0; i < flow->openings; i++) {
        in += flow->opening[i].inlet ? flow->opening[i].flow : 0;
    }
    double *y = malloc(gm_flow_size(flow) * sizeof *y),
           *velocities = malloc(3 * flow->complex->vertices * sizeof *velocities);
    assert_true(y && velocities && gm_flow_start(flow, NULL, y));
    gm_flow_vertex_velocities(flow->complex, y, velocities);
    for (long step = 0; step <= STEPS; step++) {
        size_t inside = 0;
        for (size_t i = 0; i < TRACERS; i++) {
            const double *tracer = gm_flow_tracer(flow, y, i);
            const bool fresh = tracer[GM_TRACER_AGE] == 0;
            inside += tracer[GM_TRACER_AGE] >= 0;
            at_source += fresh && tracer[GM_TRACER_X] == source->x[0] && tracer[GM_TRACER_Y] == source->x[1];
            assert_true(!fresh || i % 4 != 0 || tracer[GM_TRACER_X] == source->x[0]);
        }
        const double due = TRACERS * in * dt * (double)step / flow->complex->total_area;
        if (!(fabs((double)inside - due) <= 1)) {
            fail_msg("%zu tracers are in after %ld steps, %.2f are due", inside, step, due);
        }
        gm_tracers_carry(flow, velocities, dt, step, y, y);
    }
    const double all = TRACERS * in * dt * STEPS / flow->complex->total_area;
    assert_true(all > 20 && fabs((double)at_source - all / 4) <= 1);
    free(y);
    free(velocities);
    gm_flow_close(flow);
}

static double slanted(const void *data, enum gm_given what, double s, const double at[2])
{
    (void)data, (void)s;
    return what == GM_GIVEN_TANGENTIAL ? at[0] : 1 + 2 * at[0] - 3 * at[1];
}

/* What a wall holds may vary along it: between walls that hold a linear function still air comes to that, on any
   triangles; a wall that moves with the speed x adds the integral of that to the circulation. */
static void walls_vary(void **unused)
{
    (void)unused;
    for (int lid = 0; lid < 2; lid++) {
        struct gm_flow *flow = open_mesh(8, false, GM_STAR_AUTO);
        const struct gm_complex *complex = flow->complex;
        const size_t n = complex->vertices;
        unsigned char *side_of = calloc(complex->boundary, 1);
        assert_non_null(side_of);
        for (size_t b = 0; lid && b < complex->boundary; b++) {
            const double *p = complex->point + 2 * complex->boundary_vertex[b],
                         *q = complex->point + 2 * complex->boundary_vertex[gm_complex_next(complex, b)];
            side_of[b] = p[1] == 1 && q[1] == 1;
        }
        const struct gm_side sides[2] = {
            {.varying = lid ? NULL : slanted},
            {.kind = GM_EDGE_LID, .varying = slanted},
        };
        assert_int_equal(gm_flow_set_sides(flow, side_of, sides, GM_VERTEX_SOFT), GM_BOUNDARY_OK);
        free(side_of);
        double circulation = 0;
        for (size_t v = 0; v < n; v++) {
            circulation += flow->sheet[v];
        }
        assert_true(fabs(circulation + (lid ? 1.5 * 1.5 / 2 : 0)) < 1e-13);
        if (!lid) {
            flow->viscosity = flow->diffusivity = flow->time_unit = 1;
            flow->scalar = true;
            struct gm_problem problem;
            double *start = malloc(gm_flow_size(flow) * sizeof *start);
            assert_true(start && gm_flow_start(flow, NULL, start));
            struct gm_run *run = open_run(flow, &problem, "steady", 1, start);
            assert_int_equal(gm_run_advance(run, 1), GM_OK);
            const double *theta = gm_flow_block(flow, gm_run_state(run), GM_FLOW_THETA);
            for (size_t v = 0; v < n; v++) {
                const double *p = complex->point + 2 * v;
                assert_true(fabs(theta[v] - slanted(NULL, GM_GIVEN_THETA, 0, p)) < 1e-12);
            }
            gm_run_close(run);
            free(start);
        }
        gm_flow_close(flow);
    }
}

static double rises(const void *data, double s, const double at[2])
{
    return (void)data, (void)at, s;
}

static double comes_in(const void *data, enum gm_given what, double s, const double at[2])
{
    return (void)data, (void)at, what == GM_GIVEN_THETA ? s : 0;
}

/* s runs on from one piece of a side to the next: an inlet in two quarters of the left wall, of which the
   upper one is first, has the speed s and lets s of the scalar in, and a flow that is given is parted as that is. */
static void pieces_follow_each_other(void **unused)
{
    (void)unused;
    for (int scaled = 0; scaled < 2; scaled++) {
        struct gm_flow *flow = open_mesh(8, false, GM_STAR_AUTO);
        const struct gm_complex *complex = flow->complex;
        unsigned char *side_of = calloc(complex->boundary, 1);
        assert_non_null(side_of);
        for (size_t b = 0; b < complex->boundary; b++) {
            const double *p = complex->point + 2 * complex->boundary_vertex[b],
                         *q = complex->point + 2 * complex->boundary_vertex[gm_complex_next(complex, b)],
                         middle = (p[1] + q[1]) / 2;
            side_of[b] = p[0] == 1.5 && q[0] == 1.5                           ? 2
                         : p[0] == 0 && q[0] == 0 && fmod(middle, 0.5) < 0.25 ? 1
                                                                              : 0;
        }
        const struct gm_side sides[3] = {
            {.kind = GM_EDGE_WALL},
            {.kind = GM_EDGE_INLET, .flow = scaled ? 1 : NAN, .profile = rises, .varying = comes_in},
            {.kind = GM_EDGE_OUTLET, .flow = NAN},
        };
        assert_int_equal(gm_flow_set_sides(flow, side_of, sides, GM_VERTEX_SOFT), GM_BOUNDARY_OK);
        free(side_of);
        assert_int_equal(flow->openings, 3);
        for (size_t i = 0; i < flow->openings; i++) {
            const struct gm_opening *opening = &flow->opening[i];
            const bool upper = complex->point[2 * complex->boundary_vertex[opening->first] + 1] > 0.5;
            const double speed = upper ? 0.25 : 0.75;
            assert_true(!opening->inlet || fabs(opening->flow - (scaled ? speed : 0.25 * speed)) < 1e-14);
            size_t e = gm_complex_next(complex, opening->first);
            for (size_t k = 1; opening->inlet && k < opening->count; k++, e = gm_complex_next(complex, e)) {
                const int v = complex->boundary_vertex[e];
                const double down = (upper ? 0.75 : 0.25) - complex->point[2 * v + 1];
                assert_true(flow->theta_fixed[v]);
                assert_true(fabs(flow->theta[v] - (upper ? 2 * down : 0.5 + 2 * down)) < 1e-13);
            }
        }
        gm_flow_close(flow);
    }
}

/* The pieces of a side are counted from the lowest of the leftmost points, wherever the boundary's numbers begin: here at
   the opposite corner, as the mesh is turned by half a turn. */
static void pieces_begin_at_the_corner(void **unused)
{
    (void)unused;
    struct gm_flow *flow = open_mesh(8, false, GM_STAR_AUTO);
    const struct gm_complex *complex = flow->complex;
    unsigned char *side_of = calloc(complex->boundary, 1);
    assert_non_null(side_of);
    for (size_t v = 0; v < complex->vertices; v++) {
        complex->point[2 * v] = 1.5 - complex->point[2 * v];
        complex->point[2 * v + 1] = 1 - complex->point[2 * v + 1];
    }
    const double *first = complex->point + 2 * complex->boundary_vertex[0];
    assert_true(first[0] == 1.5 && first[1] == 1);
    for (size_t b = 0; b < complex->boundary; b++) {
        const double *p = complex->point + 2 * complex->boundary_vertex[b],
                     *q = complex->point + 2 * complex->boundary_vertex[gm_complex_next(complex, b)];
        const bool low = p[1] == 0 && q[1] == 0 && fmin(p[0], q[0]) > 0.7,
                   left = p[0] == 0 && q[0] == 0 && fmin(p[1], q[1]) > 0.45;
        side_of[b] = p[0] == 1.5 && q[0] == 1.5 ? 2 : low || left ? 1 : 0;
    }
    const struct gm_side sides[3] = {
        {.kind = GM_EDGE_WALL}, {.kind = GM_EDGE_INLET, .flow = 1}, {.kind = GM_EDGE_OUTLET, .flow = NAN}};
    assert_int_equal(gm_flow_set_sides(flow, side_of, sides, GM_VERTEX_SOFT), GM_BOUNDARY_OK);
    free(side_of);
    assert_int_equal(flow->openings, 3);
    double lengths[2] = {0};
    for (size_t i = 0; i < flow->openings; i++) {
        const struct gm_opening *opening = &flow->opening[i];
        const bool low = complex->point[2 * complex->boundary_vertex[opening->first] + 1] == 0;
        if (opening->inlet) {
            lengths[low] = opening->length;
        }
    }
    assert_true(lengths[0] > 0.4 && lengths[1] > 0.6);
    for (size_t i = 0; i < flow->openings; i++) {
        const struct gm_opening *opening = &flow->opening[i];
        const bool low = complex->point[2 * complex->boundary_vertex[opening->first] + 1] == 0;
        assert_true(!opening->inlet || (opening->before == (low ? 0 : lengths[1]) &&
                                        fabs(opening->side_length - lengths[0] - lengths[1]) < 1e-15));
    }
    gm_flow_close(flow);
}

/* Rectangles with openings: triangles of a grid [0, 3] x [0, 2], on which a wall stands along x = 3/2 but for a door
   from y = 2/3 to y = 4/3; all of them, or those of one half, shaken. `number`: of each vertex in the whole. */
enum { DOOR_COLUMNS = 18, DOOR_ROWS = 12, DOOR_ACROSS = DOOR_COLUMNS + 1 };
enum half { LEFT, RIGHT, WHOLE };

static struct gm_flow *open_part(enum half half, size_t *number)
{
    const int wall = DOOR_COLUMNS / 2, all = DOOR_ACROSS * (DOOR_ROWS + 1);
    struct points cells = grid(DOOR_COLUMNS, DOOR_ROWS, false), points = {0};
    int place[2 * DOOR_ACROSS *
              (DOOR_ROWS + 1)]; /* behind the vertices those of the wall as the right half has them */
    memset(place, -1, sizeof place);
    points.at = malloc(4 * sizeof(double) * cells.vertices);
    points.corner = malloc(3 * sizeof(int) * cells.triangles);
    assert_true(points.at && points.corner);
    for (size_t t = 0; t < cells.triangles; t++) {
        const bool right = (int)t / 2 % DOOR_COLUMNS >= wall;
        for (int k = 0; k < 3 && (half == WHOLE || right == (half == RIGHT)); k++) {
            const int v = cells.corner[3 * t + (size_t)k], i = v % DOOR_ACROSS, j = v / DOOR_ACROSS,
                      name = i == wall && right && (j < DOOR_ROWS / 3 || j > 2 * DOOR_ROWS / 3) ? all + v : v;
            const bool inner = i % wall != 0 && j % DOOR_ROWS != 0;
            if (place[name] < 0) {
                const unsigned at = 2 * (unsigned)v;
                place[name] = (int)points.vertices;
                number[points.vertices] = (size_t)name;
                points.at[2 * points.vertices] = (i + (inner ? 0.2 * scatter(at) : 0)) / 6;
                points.at[2 * points.vertices + 1] = (j + (inner ? 0.2 * scatter(at + 1) : 0)) / 6;
                points.vertices++;
            }
            points.corner[3 * points.triangles + (size_t)k] = place[name];
        }
        points.triangles += half == WHOLE || right == (half == RIGHT);
    }
    free(cells.at);
    free(cells.corner);
    struct gm_flow *flow = flow_of_points(&points, GM_STAR_BARYCENTRIC);
    flow->viscosity = 0.02;
    flow->diffusivity = 0.03;
    flow->reynolds = 20;
    flow->time_unit = 1;
    flow->scalar = true;
    return flow;
}

/* A state of the steady scheme, malloc'ed. */
static double *steady_state(struct gm_flow *flow)
{
    double *y = malloc(gm_flow_size(flow) * sizeof *y);
    assert_true(y && gm_flow_start(flow, NULL, y));
    struct gm_problem problem;
    struct gm_run *run = open_run(flow, &problem, "steady", 1, y);
    gm_run_advance(run, 12);
    assert_int_equal(run->status, GM_OK);
    memcpy(y, gm_run_state(run), gm_flow_size(flow) * sizeof *y);
    gm_run_close(run);
    return y;
}

/* How far the steady state of a half is from that of the whole, relative, if on its boundary, the door too, it is given
   the whole's stream function (times `door` at inner vertices of the door), vorticity and scalar. */
static double apart(enum half half, const struct gm_flow *whole, const double *y, const size_t *whole_number,
                    double door)
{
    size_t number[2 * DOOR_ACROSS * (DOOR_ROWS + 1)], place[2 * DOOR_ACROSS * (DOOR_ROWS + 1)];
    struct gm_flow *flow = open_part(half, number);
    const struct gm_complex *complex = flow->complex;
    double *trace = malloc(complex->vertices * sizeof *trace), worst = 0;
    assert_non_null(trace);
    for (size_t v = 0; v < whole->complex->vertices; v++) {
        place[whole_number[v]] = v;
    }
    for (size_t v = 0; v < complex->vertices; v++) {
        trace[v] = y[place[number[v]]];
    }
    for (size_t b = 0; b < complex->boundary; b++) {
        const int v = complex->boundary_vertex[b];
        const size_t w = place[number[v]];
        const bool walled = whole->kind[w] != GM_VERTEX_FREE;
        flow->kind[v] = GM_VERTEX_FIXED;
        flow->psi[v] = trace[v] * (walled ? 1 : door);
        flow->sheet[v] = gm_flow_block(whole, y, GM_FLOW_OMEGA)[w] * complex->star0[v] -
                         gm_flow_row(complex, trace, (size_t)v);
        flow->theta_fixed[v] = true;
        flow->theta[v] = gm_flow_block(whole, y, GM_FLOW_THETA)[w];
        /* a wall keeps its own cell, so that nothing of it is to be given: no slip */
        const double *p = complex->point + 2 * v;
        if ((p[1] == 0 || p[1] == 2) && p[0] != 1.5) {
            assert_true(fabs(flow->sheet[v]) < 1e-9);
        }
    }
    double *z = steady_state(flow), size[2] = {0, 0};
    for (int k = 0; k < 2; k++) {
        const enum gm_flow_block block = k ? GM_FLOW_THETA : GM_FLOW_PSI;
        const double *of_half = gm_flow_block(flow, z, block), *of_whole = gm_flow_block(whole, y, block);
        for (size_t v = 0; v < whole->complex->vertices; v++) {
            size[k] = fmax(size[k], fabs(of_whole[v]));
        }
        for (size_t v = 0; v < complex->vertices; v++) {
            const double off = fabs(of_half[v] - of_whole[place[number[v]]]) / size[k];
            worst = !(off <= worst) ? off : worst;
        }
    }
    free(z);
    free(trace);
    gm_flow_close(flow);
    return worst;
}

/* Halves that meet in a door, each with what the whole has there, are the whole: nothing but the boundary tells a
   half of the rest. */
static void halves_make_a_whole(void **unused)
{
    (void)unused;
    size_t number[2 * DOOR_ACROSS * (DOOR_ROWS + 1)];
    struct gm_flow *flow = open_part(WHOLE, number);
    const struct gm_complex *complex = flow->complex;
    unsigned char *side_of = calloc(complex->boundary, 1);
    assert_non_null(side_of);
    assert_int_equal(complex->vertices, DOOR_ACROSS * (DOOR_ROWS + 1) + 2 * (DOOR_ROWS / 3));
    for (size_t b = 0; b < complex->boundary; b++) {
        const double *p = complex->point + 2 * complex->boundary_vertex[b],
                     *q = complex->point + 2 * complex->boundary_vertex[gm_complex_next(complex, b)];
        side_of[b] = p[0] == 0 && q[0] == 0 && p[1] + q[1] > 2   ? 1
                     : p[0] == 3 && q[0] == 3 && p[1] + q[1] < 2 ? 2
                                                                 : 0;
    }
    const struct gm_side sides[3] = {{.kind = GM_EDGE_WALL, .theta_free = true},
                                     {.kind = GM_EDGE_INLET, .flow = 0.4, .theta = 1},
                                     {.kind = GM_EDGE_OUTLET, .flow = NAN}};
    assert_int_equal(gm_flow_set_sides(flow, side_of, sides, GM_VERTEX_SOFT), GM_BOUNDARY_OK);
    free(side_of);
    double *y = steady_state(flow);
    for (enum half half = LEFT; half <= RIGHT; half++) {
        const double same = apart(half, flow, y, number, 1), other = apart(half, flow, y, number, 1.01);
        if (!(same < 1e-9) || !(other > 1e-4)) {
            fail_msg("half %d is %.2e from the whole, and %.2e with another flow through its door", (int)half,
                     same, other);
        }
    }
    free(y);
    gm_flow_close(flow);
}

/* Three inlets, of which one has a profile, two outlets, of which one has a given
   flow, and a source: what is in the room is what came and did not leave, to the last digits. */
static void budget_closes(void **unused)
{
    (void)unused;
    static const char *const schemes[] = {"semi-implicit", "crank-nicolson"};
    for (int k = 0; k < 2; k++) {
        struct gm_flow *flow = open_mesh(12, false, GM_STAR_AUTO);
        const struct gm_complex *complex = flow->complex;
        unsigned char *side_of = calloc(complex->boundary, 1);
        flow->source = gm_arena_take(flow->arena, complex->vertices, sizeof *flow->source);
        assert_true(side_of && flow->source);
        for (size_t b = 0; b < complex->boundary; b++) {
            const double *p = complex->point + 2 * complex->boundary_vertex[b],
                         *q = complex->point + 2 * complex->boundary_vertex[gm_complex_next(complex, b)],
                         x = (p[0] + q[0]) / 2, z = (p[1] + q[1]) / 2;
            side_of[b] = x == 0 && z < 0.25                 ? 1
                         : x == 0 && z > 0.5 && z < 0.75    ? 2
                         : z == 0 && x > 0.5 && x < 0.75    ? 3
                         : x == 1.5 && z > 0.25 && z < 0.75 ? 4
                         : z == 1 && x > 1 && x < 1.25      ? 5
                                                            : 0;
        }
        const struct gm_side sides[6] = {
            {.kind = GM_EDGE_WALL, .theta_free = true},
            {.kind = GM_EDGE_INLET, .flow = 0.08, .theta = 1},
            {.kind = GM_EDGE_INLET, .flow = NAN, .speed = 0.3, .theta = 3},
            {.kind = GM_EDGE_INLET, .flow = 0.03, .profile = rises, .theta = 0},
            {.kind = GM_EDGE_OUTLET, .flow = 0.05},
            {.kind = GM_EDGE_OUTLET, .flow = NAN},
        };
        assert_int_equal(gm_flow_set_sides(flow, side_of, sides, GM_VERTEX_SOFT), GM_BOUNDARY_OK);
        free(side_of);
        int inlets = 0;
        for (size_t i = 0; i < flow->openings; i++) {
            inlets += flow->opening[i].inlet;
        }
        assert_true(inlets == 3 && flow->openings == 5);
        for (size_t v = 0; v < complex->vertices; v++) {
            const double *p = complex->point + 2 * v;
            flow->source[v] = hypot(p[0] - 0.8, p[1] - 0.5) < 0.15 ? 0.01 : 0;
        }
        flow->viscosity = 0.01;
        flow->diffusivity = 0.015;
        flow->time_unit = 1;
        flow->scalar = true;
        double *y = malloc(gm_flow_size(flow) * sizeof *y);
        assert_true(y && gm_flow_start(flow, NULL, y));
        struct gm_problem problem;
        struct gm_run *run = open_run(flow, &problem, schemes[k], 0.05, y);
        double before = gm_flow_scalar_total(flow, y);
        for (int step = 0; step < 40; step++) {
            assert_int_equal(gm_run_advance(run, 1), GM_OK);
            const double *state = gm_run_state(run), total = gm_flow_scalar_total(flow, state);
            const struct gm_budget budget = gm_flow_budget(flow, state);
            const double grown =
                (budget.convected + budget.reaction + budget.sourced - budget.outflow) * 0.05;
            if (!(budget.defect < 1e-12) || !(fabs(total - before - grown) < 1e-12) ||
                !(budget.sourced > 0.05) || !(gm_flow_divergence(flow, state) <= 1e-16)) {
                fail_msg("%s, step %d: defect %.2e, %.2e of the total, source %g, divergence %.2e",
                         schemes[k], step, budget.defect, total - before - grown, budget.sourced,
                         gm_flow_divergence(flow, state));
            }
            before = total;
        }
        assert_true(gm_flow_budget(flow, gm_run_state(run)).outflow > 1e-3);
        gm_run_close(run);
        free(y);
        gm_flow_close(flow);
    }
}

/* To what GMRES leaves: the pressure's differences over all inner dual edges are what the momentum equation
   says, not only over those of the tree that it was summed up along: it comes back to itself around the
   pillar, too. */
static void pressure_is_single_valued(void **unused)
{
    (void)unused;
    static const char *const schemes[] = {"semi-implicit", "crank-nicolson"};
    for (int k = 0; k < 2; k++) {
        struct gm_flow *flow = open_room(0.15);
        const struct gm_complex *complex = flow->complex;
        double *y = malloc(gm_flow_size(flow) * sizeof *y),
               *pressure = malloc(complex->triangles * sizeof *pressure);
        assert_true(y && pressure && gm_flow_start(flow, NULL, y));
        struct gm_problem problem;
        struct gm_run *run = open_run(flow, &problem, schemes[k], 0.05, y);
        for (int step = 0; step < 10; step++) {
            gm_run_advance(run, 1);
            assert_int_equal(run->status, GM_OK);
            assert_true(gm_flow_budget(flow, gm_run_state(run)).defect < 1e-12);
            assert_true(gm_flow_divergence(flow, gm_run_state(run)) <= 2.3e-16);
        }
        const double *state = gm_run_state(run), *omega = gm_flow_block(flow, state, GM_FLOW_OMEGA_USED),
                     *half = gm_flow_block(flow, state, GM_FLOW_PSI_HALF),
                     *before = gm_flow_block(flow, state, GM_FLOW_PSI_BEFORE);
        assert_true(gm_flow_pressure(flow, state, pressure));
        double worst = 0, largest = 0;
        for (size_t e = 0; e < complex->edges; e++) {
            const int *side = complex->edge_triangle + 2 * e, *end = complex->edge + 2 * e;
            if (side[0] < 0 || side[1] < 0) {
                continue;
            }
            const double step = -gm_flow_flux(complex, half, e) * (omega[end[0]] + omega[end[1]]) / 2 +
                                0.02 * gm_flow_star(complex, omega, e) +
                                (gm_flow_star(complex, state, e) - gm_flow_star(complex, before, e)) / 0.05;
            worst = fmax(worst, fabs(pressure[side[0]] - pressure[side[1]] - step));
            largest = fmax(largest, fabs(pressure[side[0]]));
        }
        if (!(worst < 1e-11 * largest)) {
            fail_msg("the pressure of case %d is not single-valued: %.2e of %.2e", k, worst, largest);
        }
        gm_run_close(run);
        free(y);
        free(pressure);
        gm_flow_close(flow);
    }
}

/* Kelvin: without viscosity and friction the circulation around a hole stays, whatever passes. */
static void kelvin(void **unused)
{
    (void)unused;
    struct gm_triangulation mesh = mesh_of("hole.msh");
    struct gm_flow *flow = gm_flow_open(mesh.complex);
    const struct gm_complex *complex = flow->complex;
    mesh.complex = NULL;
    gm_triangulation_close(&mesh);
    unsigned char *side_of = calloc(complex->boundary, 1);
    const struct gm_side slip = {.kind = GM_EDGE_SLIP};
    assert_int_equal(gm_flow_set_sides(flow, side_of, &slip, GM_VERTEX_SOFT), GM_BOUNDARY_OK);
    free(side_of);
    double *omega = calloc(complex->vertices, sizeof *omega), *y = malloc(gm_flow_size(flow) * sizeof *y);
    for (size_t v = 0; v < complex->vertices; v++) {
        const double x = complex->point[2 * v] - 1, z = complex->point[2 * v + 1] - 1;
        omega[v] = 20 * exp(-4 * (x * x + z * z));
    }
    assert_true(gm_flow_start(flow, omega, y));
    free(omega);
    size_t wall = 0;
    while (flow->hole[wall] == 0) {
        wall++;
    }
    const double before = gm_flow_circulation(flow, y, 1), psi = y[wall];
    struct gm_problem problem;
    struct gm_run *run = open_run(flow, &problem, "crank-nicolson", 0.02, y);
    gm_run_advance(run, 100);
    assert_int_equal(run->status, GM_OK);
    const double *state = gm_run_state(run);
    assert_true(fabs(state[wall] - psi) > 1e-2); /* what goes around it changes */
    assert_true(fabs(gm_flow_circulation(flow, state, 1) - before) < 1e-12);
    gm_run_close(run);
    free(y);
    gm_flow_close(flow);
}

/* The closed square of G. de Vahl Davis (1983): its walls x = 0 and x = 1 are hot and cold, lengths and times
   those of the diffusion of heat. Sides: 0 the others, 1 hot, 2 cold. */
static struct gm_flow *open_square(int n, double rayleigh, double irregular)
{
    const struct gm_rectangle rectangle = {.width = 1,
                                           .height = 1,
                                           .edges = n,
                                           .strips = gm_rectangle_strips(1, 1, n, false),
                                           .irregular = irregular};
    struct gm_triangulation_fault fault;
    struct gm_flow *flow = gm_flow_open(gm_rectangle_open(&rectangle, &fault));
    assert_non_null(flow);
    gm_flow_carry_heat(flow, 0.71 * rayleigh, 0.5);
    const struct gm_complex *complex = flow->complex;
    unsigned char *side_of = calloc(complex->boundary, 1);
    assert_non_null(side_of);
    for (size_t b = 0; b < complex->boundary; b++) {
        const double x = complex->point[2 * complex->boundary_vertex[b]],
                     next = complex->point[2 * complex->boundary_vertex[gm_complex_next(complex, b)]];
        side_of[b] = x == 0 && next == 0 ? 1 : x == 1 && next == 1 ? 2 : 0;
    }
    const struct gm_side sides[3] = {{.theta_free = true, .temperature_free = true},
                                     {.theta_free = true, .temperature = 1},
                                     {.theta_free = true, .temperature = 0}};
    assert_int_equal(gm_flow_set_sides(flow, side_of, sides, GM_VERTEX_SOFT), GM_BOUNDARY_OK);
    free(side_of);
    flow->viscosity = 0.71;
    flow->diffusivity = 1;
    flow->reynolds = sqrt(rayleigh / 0.71);
    return flow;
}

/* The largest of samples at equal distances, between them by parabolas. */
static double peak(const double *sample, int count)
{
    double largest = 0;
    for (int i = 1; i + 1 < count; i++) {
        if (sample[i] >= sample[i - 1] && sample[i] >= sample[i + 1]) {
            const double slope = (sample[i + 1] - sample[i - 1]) / 2,
                         bend = sample[i + 1] - 2 * sample[i] + sample[i - 1];
            largest = fmax(largest, bend < 0 ? sample[i] - slope * slope / (2 * bend) : sample[i]);
        }
    }
    return largest;
}

/* The largest speed u along x = 1/2 and v along y = 1/2: psi_y over two strips, of the vertices that stand
   there, and -psi_x along the edges that lie there. Every other row of vertices is shifted by half an edge. */
static void extremes(const struct gm_flow *flow, const double *psi, int columns, double largest[2])
{
    const int strips = (int)gm_rectangle_strips(1, 1, columns, false), shifted = strips / 2 % 2;
    double *upright = malloc(((size_t)strips + 1) * sizeof *upright),
           *level = malloc(((size_t)columns + 1) * sizeof *level);
    assert_true(columns % 2 == 0 && upright && level);
    int uprights = 0, levels = 0;
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        const double x = flow->complex->point[2 * v], y = flow->complex->point[2 * v + 1];
        if (fabs(x - 0.5) < 1e-9) {
            upright[lround(y * strips) / 2] = psi[v];
            uprights++;
        }
        if (fabs(y - 0.5) < 1e-9 && (!shifted || (x > 0 && x < 1))) {
            level[lround(x * columns - 0.5 * shifted)] = psi[v];
            levels++;
        }
    }
    assert_int_equal(uprights, strips / 2 + 1);
    assert_int_equal(levels, columns + 1 - shifted);
    for (int i = 0; i + 1 < uprights; i++) {
        upright[i] = (upright[i + 1] - upright[i]) * strips / 2;
    }
    for (int i = 0; i + 1 < levels; i++) {
        level[i] = -(level[i + 1] - level[i]) * columns;
    }
    largest[0] = peak(upright, uprights - 1);
    largest[1] = peak(level, levels - 1);
    free(upright);
    free(level);
}

/* Runs it from `from`, NULL: air at rest; the heat that the hot wall gives is Nusselt's number in the mean over
   the square. end: where the state is copied to, or NULL. */
static double nusselt(struct gm_flow *flow, const char *scheme, double dt, long steps, const double *from,
                      double *end)
{
    const size_t size = gm_flow_size(flow) * sizeof *end;
    double *start = malloc(size);
    assert_true(start && gm_flow_start(flow, NULL, start));
    if (from) {
        memcpy(start, from, size);
    }
    struct gm_problem problem;
    struct gm_run *run = open_run(flow, &problem, scheme, dt, start);
    gm_run_advance(run, steps);
    assert_int_equal(run->status, GM_OK);
    const double *y = gm_run_state(run), hot = gm_flow_heat(flow, y, 1), cold = gm_flow_heat(flow, y, 2);
    const double *before = gm_flow_block(flow, y, GM_FLOW_TEMPERATURE_BEFORE), last = gm_flow_step(flow, y);
    double rate = 0;
    for (size_t v = 0; last != 0 && v < flow->complex->vertices; v++) {
        rate += flow->complex->star0[v] * (gm_flow_block(flow, y, GM_FLOW_TEMPERATURE)[v] - before[v]) / last;
    }
    if (!(fabs(hot + cold - rate) < 1e-11 * fabs(hot))) {
        fail_msg("%s: the walls give %.17g and %.17g, the air takes %.17g", scheme, hot, cold, rate);
    }
    if (end) {
        memcpy(end, y, size);
    }
    gm_run_close(run);
    free(start);
    return hot;
}

/* The benchmark on meshes that tests can afford; tests/numbers has the finer ones. Steps lead to the steady
   state of Newton's method. */
static void air_rises_at_a_hot_wall(void **unused)
{
    (void)unused;
    struct gm_flow *flow = open_square(20, 1e3, 0);
    const double least = nusselt(flow, "steady", 1, 14, NULL, NULL);
    gm_flow_close(flow);
    if (!(fabs(least / 1.118 - 1) < 0.01)) {
        fail_msg("the Nusselt number at the Rayleigh number 1e3 is %.4f, not 1.118", least);
    }
    flow = open_square(16, 1e4, 0.3);
    const double steady = nusselt(flow, "steady", 1, 14, NULL, NULL),
                 marched = nusselt(flow, "semi-implicit", 0.005, 160, NULL, NULL);
    gm_flow_close(flow);
    if (!(fabs(marched / steady - 1) < 1e-6) || !(fabs(steady / 2.243 - 1) < 0.05)) {
        fail_msg("the Nusselt number at 1e4 is %.8f and %.8f by steps, not 2.243", steady, marched);
    }
}

static double warmth(const void *data, enum gm_given what, double s, const double at[2])
{
    (void)data, (void)s;
    return what == GM_GIVEN_HEAT ? 1 + at[1] : 0;
}

/* A wall that gives the heat 1 across a square where air rests: by conduction the temperature falls by 1, evenly, on
   any mesh. Of heat that varies the wall gives all, at every step, in the same steady state of steps and of Newton's
   method where air moves. */
static void walls_give_heat(void **unused)
{
    (void)unused;
    struct gm_flow *flow = open_square(12, 0, 0.4);
    const struct gm_complex *complex = flow->complex;
    unsigned char *side_of = calloc(complex->boundary, 1);
    double *y = malloc(gm_flow_size(flow) * sizeof *y), *steady = malloc(gm_flow_size(flow) * sizeof *steady);
    assert_true(side_of && y && steady);
    for (size_t b = 0; b < complex->boundary; b++) {
        const double x = complex->point[2 * complex->boundary_vertex[b]],
                     next = complex->point[2 * complex->boundary_vertex[gm_complex_next(complex, b)]];
        side_of[b] = x == 0 && next == 0 ? 1 : x == 1 && next == 1 ? 2 : 0;
    }
    struct gm_side sides[3] = {{.theta_free = true, .temperature_free = true},
                               {.theta_free = true, .temperature_free = true, .heats = true, .heat = 1},
                               {.theta_free = true, .temperature = 0}};
    assert_int_equal(gm_flow_set_sides(flow, side_of, sides, GM_VERTEX_SOFT), GM_BOUNDARY_OK);
    for (int k = 0; k < 2; k++) { /* large steps come to rest, too */
        const double given = nusselt(flow, k ? "semi-implicit" : "steady", 1e3, 12, NULL, y);
        assert_true(fabs(given - 1) < 1e-12);
        for (size_t v = 0; v < complex->vertices; v++) {
            const double *temperature = gm_flow_block(flow, y, GM_FLOW_TEMPERATURE);
            assert_true(fabs(temperature[v] - (1 - complex->point[2 * v])) < 1e-11);
        }
    }
    sides[1].varying = warmth;
    assert_int_equal(gm_flow_set_sides(flow, side_of, sides, GM_VERTEX_SOFT), GM_BOUNDARY_OK);
    flow->buoyancy = 0.71e4;
    flow->reynolds = sqrt(1e4 / 0.71);
    const double given = nusselt(flow, "crank-nicolson", 0.002, 1, NULL, NULL),
                 balanced = nusselt(flow, "steady", 1, 14, NULL, steady);
    nusselt(flow, "semi-implicit", 0.02, 400, NULL, y);
    assert_true(fabs(given - 1.5) < 1e-11 && fabs(balanced - 1.5) < 1e-11);
    assert_true(fabs(gm_flow_heat(flow, steady, 2) + 1.5) < 1e-9);
    const double *here = gm_flow_block(flow, y, GM_FLOW_TEMPERATURE),
                 *there = gm_flow_block(flow, steady, GM_FLOW_TEMPERATURE);
    double warmest = 0;
    for (size_t v = 0; v < complex->vertices; v++) {
        warmest = fmax(warmest, there[v]);
        assert_true(fabs(here[v] - there[v]) < 1e-6);
    }
    /* rising air takes heat away: conduction alone would make it 1.5 or more */
    assert_true(warmest < 1.2 && gm_flow_heated(flow) > warmest / 2 && gm_flow_heated(flow) < 2 * warmest);
    free(side_of);
    free(y);
    free(steady);
    gm_flow_close(flow);
}

/* A fluid in layers, warm above, rests on any mesh: its buoyancy is a gradient, and the pressure alone bears
   it. */
static void layers_rest(void **unused)
{
    (void)unused;
    struct gm_flow *flow = open_square(8, 1e6, 0.4);
    const struct gm_complex *complex = flow->complex;
    for (size_t v = 0; v < complex->vertices; v++) {
        flow->temperature[v] = complex->point[2 * v + 1];
        flow->temperature_fixed[v] = true;
    }
    double *y = malloc(gm_flow_size(flow) * sizeof *y),
           *pressure = malloc(complex->triangles * sizeof *pressure);
    assert_true(y && pressure && gm_flow_start(flow, NULL, y));
    struct gm_problem problem;
    struct gm_run *run = open_run(flow, &problem, "semi-implicit", 0.01, y);
    gm_run_advance(run, 5);
    assert_int_equal(run->status, GM_OK);
    assert_int_equal(run->solves, 5 * 3); /* for the flow two a step, and for the temperature one */
    assert_true(gm_flow_largest_speed(flow, gm_run_state(run)) < 1e-9);
    assert_true(gm_flow_pressure(flow, gm_run_state(run), pressure));
    /* p = buoyancy ((y - 1/2)^2 / 2 - 1/24) */
    for (size_t t = 0; t < complex->triangles; t++) {
        double centre[2], corner[2];
        gm_complex_centre(complex, t, centre);
        gm_complex_centre(complex, 0, corner);
        const double exact = 0.71e6 * (pow(centre[1] - 0.5, 2) - pow(corner[1] - 0.5, 2)) / 2;
        assert_true(fabs(pressure[t] - pressure[0] - exact) < 1e-9 * 0.71e6);
    }
    double above = NAN, below = NAN;
    assert_true(gm_flow_pressure_at(flow, gm_run_state(run), 0.3, 0.8, &above) &&
                gm_flow_pressure_at(flow, gm_run_state(run), 0.6, 0.1, &below));
    assert_true(fabs(above - below - 0.71e6 * (0.3 * 0.3 - 0.4 * 0.4) / 2) < 1e-9 * 0.71e6);
    gm_run_close(run);
    free(y);
    free(pressure);
    gm_flow_close(flow);
}

/* The steady state of a coarse mesh, at the vertices of a finer one: from there Newton's method needs no
   continuation, and four corrections of the fine mesh instead of a dozen. */
static double *coarse_start(struct gm_flow *flow, double rayleigh)
{
    struct gm_flow *coarse = open_square(40, rayleigh, 0);
    const struct gm_complex *complex = flow->complex;
    double *y = malloc(gm_flow_size(coarse) * sizeof *y), *start = malloc(gm_flow_size(flow) * sizeof *start);
    assert_true(y && start && gm_flow_start(flow, NULL, start));
    nusselt(coarse, "steady", 1, 16, NULL, y);
    for (size_t v = 0; v < complex->vertices; v++) {
        struct gm_sample sample;
        assert_true(gm_flow_sample(coarse, y, complex->point[2 * v], complex->point[2 * v + 1], &sample));
        start[v] = flow->kind[v] == GM_VERTEX_FREE ? sample.psi : start[v];
        double *temperature = start + GM_FLOW_TEMPERATURE * complex->vertices + v;
        *temperature = flow->temperature_fixed[v] ? *temperature : sample.temperature;
    }
    gm_flow_vorticity(flow, start, start + GM_FLOW_OMEGA * complex->vertices);
    flow->reynolds = fmin(flow->reynolds, 100);
    free(y);
    gm_flow_close(coarse);
    return start;
}

/* The tables of de Vahl Davis: Nusselt's number and the largest speeds along the middles. */
static void natural_convection(void **unused)
{
    (void)unused;
    static const struct {
        int columns;
        double rayleigh, nusselt, largest[2];
    } table[] = {{80, 1e3, 1.118, {3.649, 3.697}},
                 {80, 1e4, 2.243, {16.178, 19.617}},
                 {160, 1e5, 4.519, {34.73, 68.59}},
                 {160, 1e6, 8.800, {64.63, 219.36}}};
    for (size_t i = 0; i < GM_COUNT(table); i++) {
        struct gm_flow *flow = open_square(table[i].columns, table[i].rayleigh, 0);
        double *state = coarse_start(flow, table[i].rayleigh), largest[2];
        const double number = nusselt(flow, "steady", 1, 16, state, state);
        extremes(flow, state, table[i].columns, largest);
        free(state);
        gm_flow_close(flow);
        print_message("Rayleigh number %g: Nusselt number %.4f (%.4g), speeds %.2f and %.2f (%g, %g)\n",
                      table[i].rayleigh, number, table[i].nusselt, largest[0], largest[1],
                      table[i].largest[0], table[i].largest[1]);
        assert_true(fabs(number / table[i].nusselt - 1) < 0.01);
        for (int k = 0; k < 2; k++) {
            /* at 10^5 v is 69.45, 67.66 and 68.67 with 40, 80 and 160 edges: five reach to the largest speed at 80 */
            assert_true(fabs(largest[k] / table[i].largest[k] - 1) < 0.01);
        }
    }
}

int main(int count, char *words[])
{
    const struct CMUnitTest published[] = {cmocka_unit_test(natural_convection)};
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orders),
        cmocka_unit_test(circulation_is_found),
        cmocka_unit_test(flows_are_shared),
        cmocka_unit_test(pieces_begin_at_the_corner),
        cmocka_unit_test(halves_make_a_whole),
        cmocka_unit_test(budget_closes),
        cmocka_unit_test(pressure_is_single_valued),
        cmocka_unit_test(kelvin),
        cmocka_unit_test(air_rises_at_a_hot_wall),
        cmocka_unit_test(smoke_comes_in),
        cmocka_unit_test(walls_give_heat),
        cmocka_unit_test(layers_rest),
        cmocka_unit_test(pieces_follow_each_other),
        cmocka_unit_test(walls_vary),
    };
    return count > 1 && strcmp(words[1], "numbers") == 0 ? cmocka_run_group_tests(published, NULL, NULL)
                                                         : cmocka_run_group_tests(tests, NULL, NULL);
}
