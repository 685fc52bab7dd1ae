/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Flows by discrete exterior calculus against operators, fields and totals computed elsewhere, on meshes of
 * Gmsh. */
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
#include "core/flow/boundary.h"
#include "core/form/generators.h"
#include "core/form/gmsh.h"
#include "core/run.h"
#include "core/schemes.h"
#include "core/theory/certify.h"
#include "tests/common/meshes.h"
#include "tests/common/reference.h"

/* of the largest value of a field: what GMRES leaves, above the references' conditioning */
static const double tolerance = 1e-11;

static void expect_field(const char *name, const double *mine, const double *reference, size_t n)
{
    double largest = 0, error = 0;
    for (size_t i = 0; i < n; i++) {
        largest = fmax(largest, fabs(reference[i]));
        error = fmax(error, fabs(mine[i] - reference[i]));
    }
    if (!(error <= tolerance * largest)) {
        fail_msg("%s: error %.2e of its largest value", name, error / largest);
    }
}

static void expect_number(const char *name, double mine, double reference)
{
    if (!(fabs(mine - reference) <= tolerance * fabs(reference))) {
        fail_msg("%s: %.17g, not %.17g", name, mine, reference);
    }
}

/* A block of a state against the reference whose name `format` makes. */
__attribute__((format(printf, 4, 5))) static void
expect_block(const struct gm_flow *flow, const double *y, enum gm_flow_block block, const char *format, ...)
{
    char name[64];
    va_list list;
    va_start(list, format);
    vsnprintf(name, sizeof name, format, list);
    va_end(list);
    const size_t vertices = flow->complex->vertices;
    expect_field(name, gm_flow_block(flow, y, block), reference(name, vertices), vertices);
}

static void expect_whole(const char *name, const int *mine, size_t n)
{
    const double *wanted = reference(name, n);
    for (size_t i = 0; i < n; i++) {
        assert_int_equal(mine[i], (int)wanted[i]);
    }
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

static double *start_at_rest(const struct gm_flow *flow)
{
    double *start = malloc(gm_flow_size(flow) * sizeof *start);
    assert_non_null(start);
    assert_true(gm_flow_start(flow, NULL, start));
    return start;
}

static struct gm_flow *flow_on(const char *file, double speed, enum gm_vertex_kind outlet, double theta)
{
    struct gm_triangulation mesh = mesh_of(file);
    unsigned char *sides = sides_of(&mesh);
    struct gm_flow *flow = gm_flow_open(mesh.complex);
    assert_non_null(flow);
    mesh.complex = NULL;
    gm_triangulation_close(&mesh);
    assert_int_equal(set_boundary(flow, sides, speed, outlet, theta), GM_BOUNDARY_OK);
    free(sides);
    return flow;
}

static void operators_agree(void **unused)
{
    (void)unused;
    struct gm_triangulation mesh = mesh_of("square-small.msh");
    const struct gm_complex *complex = mesh.complex;
    assert_int_equal(complex->vertices, 32);
    assert_int_equal(complex->edges, 79);
    assert_int_equal(complex->triangles, 48);
    assert_int_equal(complex->boundary, 14);
    assert_int_equal(complex->loops, 1);
    expect_whole("square_edges", complex->edge, 158);
    expect_whole("square_triangle_edges", complex->triangle_edge, 144);
    const double *signs = reference("square_triangle_signs", 144);
    for (size_t i = 0; i < 144; i++) {
        assert_int_equal(complex->triangle_sign[i], (int)signs[i]);
    }
    expect_field("star0", complex->star0, reference("square_s0", 32), 32);
    expect_field("star1", complex->star1, reference("square_s1", 79), 79);
    expect_field("weights", complex->weight, reference("square_circumcentre_weights", 144), 144);
    bool boundary[79] = {false};
    for (size_t b = 0; b < complex->boundary; b++) {
        boundary[complex->boundary_edge[b]] = true;
    }
    const double *boundary_edges = reference("square_boundary_edges", 14);
    for (size_t i = 0; i < 14; i++) {
        assert_true(boundary[(size_t)boundary_edges[i]]);
    }
    assert_true(fabs(complex->smallest_angle - 36.59025755886154) < 1e-9);
    assert_true(fabs(complex->largest_angle - 86.33117608439926) < 1e-9);

    /* column by column: the flux of a unit psi, and K of it, which is star0 omega */
    struct gm_flow *flow = gm_flow_open(mesh.complex);
    double fop[79][32], k[32][32];
    for (size_t v = 0; v < 32; v++) {
        double psi[32] = {0}, scratch[48], flux[79], omega[32];
        psi[v] = 1;
        gm_flow_fluxes(complex, psi, scratch, flux);
        gm_flow_vorticity(flow, psi, omega);
        for (size_t e = 0; e < 79; e++) {
            fop[e][v] = flux[e];
            assert_true(fabs(flux[e] - gm_flow_flux(complex, psi, e)) < 1e-15);
        }
        for (size_t w = 0; w < 32; w++) {
            k[w][v] = complex->star0[w] * omega[w];
        }
    }
    const double *fluxes = reference("square_fop", 906), *k_upper = reference("square_k_upper", 333);
    for (size_t i = 0; i < 906; i += 3) {
        double *entry = &fop[(size_t)fluxes[i]][(size_t)fluxes[i + 1]];
        assert_true(fabs(*entry - fluxes[i + 2]) < 1e-13);
        *entry = 0;
    }
    for (size_t i = 0; i < 333; i += 3) {
        const size_t row = (size_t)k_upper[i], column = (size_t)k_upper[i + 1];
        assert_true(fabs(k[row][column] - k_upper[i + 2]) < 1e-13);
        assert_true(fabs(k[column][row] - k_upper[i + 2]) < 1e-13);
        k[row][column] = k[column][row] = 0;
    }
    for (size_t v = 0; v < 32; v++) { /* nothing else is there */
        for (size_t e = 0; e < 79; e++) {
            assert_true(fabs(fop[e][v]) < 1e-15);
        }
        for (size_t w = 0; w < 32; w++) {
            assert_true(fabs(k[w][v]) < 1e-14);
        }
    }
    mesh.complex = NULL;
    gm_triangulation_close(&mesh);
    gm_flow_close(flow);
}

static void meshes_agree(void **unused)
{
    (void)unused;
    static const struct {
        const char *file;
        size_t vertices, edges, triangles;
        double smallest_angle, largest_angle, least_star0, least_star1, area;
    } meshes[] = {{"square-small.msh", 32, 79, 48, 36.59025755886154, 86.33117608439926, 0.013840118658932572,
                   0.03206035879110827, 1.0},
                  {"room-small.msh", 162, 449, 288, 35.511193710702905, 87.64581785573345,
                   0.03040362225276074, 0.028686078583032515, 12.0},
                  {"channel-small.msh", 116, 315, 200, 34.627920704622944, 87.95479060484273,
                   0.00996288520059452, 0.017855403220707243, 3.0},
                  {"lshape.msh", 49, 120, 72, 42.191192571896345, 92.79436205428043, 0.0038029051319451866,
                   0.024404761900706937, 0.75}};
    for (size_t i = 0; i < GM_COUNT(meshes); i++) {
        struct gm_triangulation mesh = mesh_of(meshes[i].file);
        const struct gm_complex *complex = mesh.complex;
        double star0 = INFINITY, star1 = INFINITY;
        for (size_t v = 0; v < complex->vertices; v++) {
            star0 = fmin(star0, complex->star0[v]);
        }
        for (size_t e = 0; e < complex->edges; e++) {
            star1 = fmin(star1, complex->star1[e]);
        }
        assert_int_equal(complex->vertices, meshes[i].vertices);
        assert_int_equal(complex->edges, meshes[i].edges);
        assert_int_equal(complex->triangles, meshes[i].triangles);
        expect_number("smallest angle", complex->smallest_angle, meshes[i].smallest_angle);
        expect_number("largest angle", complex->largest_angle, meshes[i].largest_angle);
        expect_number("smallest star0", star0, meshes[i].least_star0);
        expect_number("smallest star1", star1, meshes[i].least_star1);
        expect_number("area", complex->total_area, meshes[i].area);
        gm_triangulation_close(&mesh);
    }
}

/* The same mesh with scattered tags, blocks in another order and clockwise triangles. */
static void scrambled_is_the_same(void **unused)
{
    (void)unused;
    struct gm_triangulation a = mesh_of("square-small.msh"), b = mesh_of("square-scrambled.msh");
    assert_int_equal(b.complex->vertices, 32);
    assert_int_equal(b.complex->triangles, 48);
    for (size_t v = 0; v < 32; v++) {
        size_t found = 0;
        for (size_t w = 0; w < 32; w++) {
            if (memcmp(a.complex->point + 2 * v, b.complex->point + 2 * w, 2 * sizeof(double)) == 0) {
                assert_true(fabs(a.complex->star0[v] - b.complex->star0[w]) < 1e-16);
                found++;
            }
        }
        assert_int_equal(found, 1);
    }
    assert_int_equal(gm_triangulation_group(&b, "lid"), 2);
    assert_int_equal(gm_triangulation_group(&b, "2"), 2);
    assert_int_equal(gm_triangulation_group(&b, "inlet"), 0);
    gm_triangulation_close(&a);
    gm_triangulation_close(&b);
}

static void expect_pressure(const struct gm_flow *flow, const double *y, const char *name, const char *when)
{
    char whole[64];
    snprintf(whole, sizeof whole, "%s_total_pressure_%s", name, when);
    double *pressure = malloc(flow->complex->triangles * sizeof *pressure);
    assert_non_null(pressure);
    assert_true(gm_flow_pressure(flow, y, pressure));
    expect_field(whole, pressure, reference(whole, flow->complex->triangles), flow->complex->triangles);
    free(pressure);
}

struct cavity {
    const char *file;
    double viscosity, dt;
    const char *name; /* of the references */
    bool with_pressure;
    double energy_5, enstrophy_5, energy_steady, enstrophy_steady, energy_1, enstrophy_1, psi_min_steady;
};

static void cavity_agrees(const struct cavity *cavity)
{
    struct gm_flow *flow = flow_on(cavity->file, 1, GM_VERTEX_FIXED, 0);
    struct gm_problem problem;
    flow->viscosity = cavity->viscosity;
    flow->reynolds = 1 / cavity->viscosity;
    double *start = start_at_rest(flow);
    expect_block(flow, start, GM_FLOW_OMEGA, "%s_omega_start", cavity->name);
    struct gm_run *run = open_run(flow, &problem, "semi-implicit", cavity->dt, start);
    assert_int_equal(gm_run_advance(run, 1), GM_OK);
    expect_block(flow, gm_run_state(run), GM_FLOW_PSI, "%s_psi_1", cavity->name);
    expect_block(flow, gm_run_state(run), GM_FLOW_OMEGA, "%s_omega_1", cavity->name);
    expect_number("kinetic energy", gm_flow_kinetic_energy(flow, gm_run_state(run)), cavity->energy_1);
    expect_number("enstrophy", gm_flow_enstrophy(flow, gm_run_state(run)), cavity->enstrophy_1);
    assert_int_equal(gm_run_advance(run, 4), GM_OK);
    const double *y = gm_run_state(run);
    expect_block(flow, y, GM_FLOW_PSI, "%s_psi_5", cavity->name);
    expect_block(flow, y, GM_FLOW_OMEGA, "%s_omega_5", cavity->name);
    expect_number("kinetic energy", gm_flow_kinetic_energy(flow, y), cavity->energy_5);
    expect_number("enstrophy", gm_flow_enstrophy(flow, y), cavity->enstrophy_5);
    assert_true(gm_flow_divergence(flow, y) < 2e-16);
    if (cavity->with_pressure) {
        expect_pressure(flow, y, cavity->name, "5");
    }
    gm_run_close(run);

    run = open_run(flow, &problem, "steady", 1, start);
    assert_int_equal(gm_run_advance(run, 30), GM_OK);
    y = gm_run_state(run);
    expect_block(flow, y, GM_FLOW_PSI, "%s_psi_steady", cavity->name);
    expect_block(flow, y, GM_FLOW_OMEGA, "%s_omega_steady", cavity->name);
    expect_number("kinetic energy", gm_flow_kinetic_energy(flow, y), cavity->energy_steady);
    expect_number("enstrophy", gm_flow_enstrophy(flow, y), cavity->enstrophy_steady);
    double low = 0;
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        low = fmin(low, y[v]);
    }
    expect_number("least psi", low, cavity->psi_min_steady);
    if (cavity->with_pressure) {
        expect_pressure(flow, y, cavity->name, "steady");
    }
    gm_run_close(run);
    free(start);
    gm_flow_close(flow);
}

static void cavities_agree(void **unused)
{
    (void)unused;
    const struct cavity cavities[] = {
        {"square-small.msh", 0.1, 0.02, "cavity_re_10", false, 0.008079254323588199, 3.6910106331193435,
         0.029311199787695964, 3.20205670100826, 0.0006162789134277685, 4.899051462484847,
         -0.0968120518775512},
        {"square-small.msh", 0.01, 0.1, "cavity_re_100", true, 0.003195418349987838, 4.233861103919766,
         0.02512967695555195, 4.093915871169333, 0.00018344599079373996, 5.192206087454279,
         -0.10869746283656699},
        {"lshape.msh", 0.1, 0.02, "lshape_re_10", false, 0.010404547663752043, 4.926312084938418,
         0.020006010628919282, 4.702053575644528, 0.0012155668393954875, 6.437986045223383,
         -0.07576571631939771},
    };
    for (size_t i = 0; i < GM_COUNT(cavities); i++) {
        cavity_agrees(&cavities[i]);
    }
}

static struct gm_flow *small_room(enum gm_vertex_kind outlet)
{
    struct gm_flow *flow = flow_on("room-small.msh", 1, outlet, 1000);
    flow->viscosity = 0.01;
    flow->diffusivity = 0.02;
    flow->reynolds = 100;
    flow->scalar = true;
    return flow;
}

static void expect_budget(const struct gm_flow *flow, const double *y, double total, double rate,
                          double convected, double reaction, double outflow)
{
    const struct gm_budget budget = gm_flow_budget(flow, y);
    expect_number("total", gm_flow_scalar_total(flow, y), total);
    expect_number("rate", budget.rate, rate);
    expect_number("convected", budget.convected, convected);
    expect_number("reaction", budget.reaction, reaction);
    assert_true(fabs(budget.outflow - outflow) <= 1e-9 * fabs(outflow) + 1e-13);
    assert_true(budget.defect < 1e-13);
}

/* A concentration that cannot be solved for ends a run, though the flow that carries it goes on. */
static void lost_scalars_end_a_run(void **unused)
{
    (void)unused;
    struct gm_flow *flow = small_room(GM_VERTEX_SOFT);
    struct gm_problem problem;
    double *start = start_at_rest(flow);
    size_t inside = 0;
    while (flow->kind[inside] != GM_VERTEX_FREE) {
        inside++;
    }
    start[(size_t)(gm_flow_block(flow, start, GM_FLOW_THETA) - start) + inside] = INFINITY;
    struct gm_run *run = open_run(flow, &problem, "semi-implicit", 0.05, start);
    assert_int_equal(gm_run_advance(run, 1), GM_NO_CONVERGENCE);
    gm_run_close(run);
    free(start);
    gm_flow_close(flow);
}

static void room_agrees(void **unused)
{
    (void)unused;
    struct gm_flow *flow = small_room(GM_VERTEX_SOFT);
    const double *inlet = reference("room_soft_open_inlet_vertices", 2);
    const double *outlet = reference("room_soft_open_outlet_vertices", 2);
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(flow->kind[(size_t)outlet[i]], GM_VERTEX_SOFT);
        assert_int_equal(flow->kind[(size_t)inlet[i]], GM_VERTEX_FIXED);
        assert_true(flow->theta[(size_t)inlet[i]] == 1000);
    }
    struct gm_problem problem;
    double *start = start_at_rest(flow);
    expect_block(flow, start, GM_FLOW_PSI, "room_soft_psi_0");
    struct gm_run *run = open_run(flow, &problem, "semi-implicit", 0.05, start);
    assert_int_equal(gm_run_advance(run, 1), GM_OK);
    expect_block(flow, gm_run_state(run), GM_FLOW_PSI, "room_soft_psi_1");
    expect_block(flow, gm_run_state(run), GM_FLOW_OMEGA, "room_soft_omega_1");
    expect_block(flow, gm_run_state(run), GM_FLOW_THETA, "room_soft_theta_1");
    expect_budget(flow, gm_run_state(run), 95.40222907998886, 296.09920352271985, 489.6219014466583,
                  -172.8936440829783 - 20.629053840959777, 0);
    expect_number("kinetic energy", gm_flow_kinetic_energy(flow, gm_run_state(run)), 0.5493826272839492);
    expect_number("enstrophy", gm_flow_enstrophy(flow, gm_run_state(run)), 5.075107482066613);
    assert_int_equal(gm_run_advance(run, 4), GM_OK);
    expect_block(flow, gm_run_state(run), GM_FLOW_PSI, "room_soft_psi_5");
    expect_block(flow, gm_run_state(run), GM_FLOW_OMEGA, "room_soft_omega_5");
    expect_block(flow, gm_run_state(run), GM_FLOW_THETA, "room_soft_theta_5");
    expect_budget(flow, gm_run_state(run), 159.66005463418296, 336.16658830252334, 489.6219014466583,
                  -132.01073693671833 - 21.444576207417192, 6.343087240079663e-17);
    expect_number("kinetic energy", gm_flow_kinetic_energy(flow, gm_run_state(run)), 0.5532391080906265);
    expect_number("enstrophy", gm_flow_enstrophy(flow, gm_run_state(run)), 4.6913944497008275);
    expect_pressure(flow, gm_run_state(run), "room_soft", "5");
    assert_int_equal(gm_run_advance(run, 15), GM_OK);
    expect_block(flow, gm_run_state(run), GM_FLOW_PSI, "room_soft_psi_20");
    expect_block(flow, gm_run_state(run), GM_FLOW_OMEGA, "room_soft_omega_20");
    expect_block(flow, gm_run_state(run), GM_FLOW_THETA, "room_soft_theta_20");
    expect_budget(flow, gm_run_state(run), 459.76828641141816, 441.4991826907328, 489.6219014466583,
                  -26.495163164174983 - 21.627555591704372, 4.43318487501444e-11);
    expect_number("kinetic energy", gm_flow_kinetic_energy(flow, gm_run_state(run)), 0.5884945796793554);
    expect_number("enstrophy", gm_flow_enstrophy(flow, gm_run_state(run)), 4.539430145888613);
    assert_int_equal(gm_run_advance(run, 180), GM_OK);
    const double *y = gm_run_state(run);
    expect_budget(flow, y, 4045.525390567859, 211.07812270251088, 489.6219014466583,
                  -16.123910637720996 - 151.3773950655572, 111.04247304288081);
    expect_number("kinetic energy", gm_flow_kinetic_energy(flow, y), 1.0528131832903167);
    expect_number("enstrophy", gm_flow_enstrophy(flow, y), 6.790058392140409);
    double psi = 0, psi_2 = 0, theta_2 = 0, low = INFINITY, high = -INFINITY;
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        const double theta = gm_flow_block(flow, y, GM_FLOW_THETA)[v], star = flow->complex->star0[v];
        psi += star * y[v];
        psi_2 += star * y[v] * y[v];
        theta_2 += star * theta * theta;
        low = flow->kind[v] == GM_VERTEX_FREE ? fmin(low, y[v]) : low;
        high = flow->kind[v] == GM_VERTEX_FREE ? fmax(high, y[v]) : high;
    }
    expect_number("sum of psi", psi, 2.7855891252044187);
    expect_number("sum of psi^2", psi_2, 1.6835836526487387);
    expect_number("sum of theta^2", theta_2, 2206458.057161001);
    expect_number("least psi inside", low, -0.15259139986185533);
    expect_number("largest psi inside", high, 0.6758595378559129);
    assert_true(gm_flow_divergence(flow, y) < 2e-16);
    gm_run_close(run);
    free(start);
    gm_flow_close(flow);

    flow = small_room(GM_VERTEX_FIXED);
    start = start_at_rest(flow);
    inlet = reference("room_dirichlet_open_inlet_vertices", 2);
    outlet = reference("room_dirichlet_open_outlet_vertices", 2);
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(flow->kind[(size_t)outlet[i]], GM_VERTEX_FIXED);
        assert_int_equal(flow->kind[(size_t)inlet[i]], GM_VERTEX_FIXED);
    }
    expect_block(flow, start, GM_FLOW_PSI, "room_dirichlet_psi_0");
    run = open_run(flow, &problem, "semi-implicit", 0.05, start);
    assert_int_equal(gm_run_advance(run, 5), GM_OK);
    expect_block(flow, gm_run_state(run), GM_FLOW_PSI, "room_dirichlet_psi_5");
    expect_block(flow, gm_run_state(run), GM_FLOW_OMEGA, "room_dirichlet_omega_5");
    expect_block(flow, gm_run_state(run), GM_FLOW_THETA, "room_dirichlet_theta_5");
    expect_budget(flow, gm_run_state(run), 159.66059873382542, 336.17082075708936, 489.6219014466583,
                  -132.00902003980048 - 21.44206064976749, 6.295521502533307e-17);
    expect_number("kinetic energy", gm_flow_kinetic_energy(flow, gm_run_state(run)), 0.5547365802221229);
    expect_number("enstrophy", gm_flow_enstrophy(flow, gm_run_state(run)), 5.518124366608872);
    gm_run_close(run);
    free(start);
    gm_flow_close(flow);
}

/* With the velocity held on the outlet a fast flow ends in a layer that no mesh resolves: what follows is no
   flow, and the run says so; with the soft outlet it goes on. */
static void artefacts_end_a_run(void **unused)
{
    (void)unused;
    static const enum gm_vertex_kind outlets[] = {GM_VERTEX_FIXED, GM_VERTEX_SOFT};
    for (size_t i = 0; i < 2; i++) {
        struct gm_flow *flow = small_room(outlets[i]);
        struct gm_problem problem;
        flow->viscosity = flow->diffusivity = 1e-3;
        double *start = start_at_rest(flow);
        struct gm_run *run = open_run(flow, &problem, "semi-implicit", 0.05, start);
        const enum gm_status status = gm_run_advance(run, 2000);
        assert_int_equal(status, i == 0 ? GM_BLOW_UP : GM_OK);
        const double energy = gm_flow_kinetic_energy(flow, gm_run_state(run));
        assert_true(energy <= 2 * flow->complex->total_area);
        print_message("%s after %ld steps, energy %.3g\n", gm_status_name(status), run->steps, energy);
        gm_run_close(run);
        free(start);
        gm_flow_close(flow);
    }
}

static void channel_agrees(void **unused)
{
    (void)unused;
    for (int soft = 0; soft < 2; soft++) {
        const char *outlet = soft ? "soft" : "free";
        struct gm_flow *flow = flow_on("channel-small.msh", 1, soft ? GM_VERTEX_SOFT : GM_VERTEX_OPEN, 0);
        const struct gm_complex *complex = flow->complex;
        for (size_t v = 0; v < complex->vertices; v++) {
            flow->theta[v] = flow->theta_fixed[v] && complex->point[2 * v + 1] == 1 ? 20 : 0;
        }
        flow->viscosity = 0.1;
        flow->diffusivity = 0.2;
        flow->reynolds = 10;
        flow->scalar = true;
        struct gm_problem problem;
        double *start = start_at_rest(flow);
        struct gm_run *run = open_run(flow, &problem, "steady", 1, start);
        assert_int_equal(gm_run_advance(run, 20), GM_OK);
        const double *y = gm_run_state(run);
        expect_block(flow, y, GM_FLOW_PSI, "channel_%s_psi_steady", outlet);
        expect_block(flow, y, GM_FLOW_OMEGA, "channel_%s_omega_steady", outlet);
        expect_block(flow, y, GM_FLOW_THETA, "channel_%s_theta_steady", outlet);
        expect_pressure(flow, y, soft ? "channel_soft" : "channel_free", "steady");
        expect_number("outflow", gm_flow_budget(flow, y).outflow,
                      soft ? 5.845547920532039 : 5.879389986377435);
        double away = 0, size = 0;
        for (size_t v = 0; v < complex->vertices; v++) {
            const double z = complex->point[2 * v + 1], exact = 2 * z * z - 4 * z * z * z / 3;
            away += complex->star0[v] * (y[v] - exact) * (y[v] - exact);
            size += complex->star0[v] * exact * exact;
        }
        expect_number("error of psi", sqrt(away / size), soft ? 0.005725699702427246 : 0.005899658168840385);
        expect_number("scalar total", gm_flow_scalar_total(flow, y),
                      soft ? 25.286811501000848 : 25.28808322557179);
        expect_number("kinetic energy", gm_flow_kinetic_energy(flow, y),
                      soft ? 0.7908783073129181 : 0.791373402788283);
        expect_number("enstrophy", gm_flow_enstrophy(flow, y), soft ? 7.983246627196314 : 7.9567653835425585);
        gm_run_close(run);

        /* marching comes to the same state */
        run = open_run(flow, &problem, "semi-implicit", 0.5, start);
        assert_int_equal(gm_run_advance(run, 200), GM_OK);
        expect_block(flow, gm_run_state(run), GM_FLOW_PSI, "channel_%s_psi_steady", outlet);
        expect_block(flow, gm_run_state(run), GM_FLOW_THETA, "channel_%s_theta_steady", outlet);
        gm_run_close(run);
        free(start);
        gm_flow_close(flow);
    }
}

static struct gm_flow *torus(double viscosity)
{
    struct gm_triangulation_fault fault;
    const double *corners = reference("torus_triangles", 480);
    int triangles[480];
    for (size_t i = 0; i < 480; i++) {
        triangles[i] = (int)corners[i];
    }
    struct gm_complex *complex =
        gm_complex_open(&(struct gm_triangles){.points = reference("torus_vertices", 160),
                                               .vertices = 80,
                                               .corners = triangles,
                                               .count = 160,
                                               .period = {1, 1},
                                               .star = GM_STAR_CIRCUMCENTRIC},
                        &fault);
    assert_non_null(complex);
    assert_int_equal(complex->boundary, 0);
    assert_int_equal((long)complex->vertices - (long)complex->edges + (long)complex->triangles, 0);
    struct gm_flow *flow = gm_flow_open(complex);
    assert_non_null(flow);
    flow->viscosity = viscosity;
    return flow;
}

static void torus_agrees(void **unused)
{
    (void)unused;
    struct gm_flow *flow = torus(0.02);
    struct gm_problem problem;
    double omega[80], *start = malloc(gm_flow_size(flow) * sizeof *start);
    for (size_t v = 0; v < 80; v++) {
        const double *p = flow->complex->point + 2 * v;
        omega[v] = 4 * M_PI * sin(2 * M_PI * p[0]) * sin(2 * M_PI * p[1]);
    }
    assert_true(gm_flow_start(flow, omega, start));
    expect_block(flow, start, GM_FLOW_OMEGA, "torus_omega_0");
    expect_block(flow, start, GM_FLOW_PSI, "torus_psi_0");
    struct gm_run *run = open_run(flow, &problem, "semi-implicit", 0.01, start);
    assert_int_equal(gm_run_advance(run, 10), GM_OK);
    expect_block(flow, gm_run_state(run), GM_FLOW_PSI, "torus_psi_10_backward_euler");
    expect_block(flow, gm_run_state(run), GM_FLOW_OMEGA, "torus_omega_10_backward_euler");
    expect_number("kinetic energy", gm_flow_kinetic_energy(flow, gm_run_state(run)), 0.19881792908836643);
    expect_number("enstrophy", gm_flow_enstrophy(flow, gm_run_state(run)), 14.633669918493954);
    gm_run_close(run);
    run = open_run(flow, &problem, "crank-nicolson", 0.01, start);
    assert_int_equal(gm_run_advance(run, 10), GM_OK);
    expect_block(flow, gm_run_state(run), GM_FLOW_PSI, "torus_psi_10_crank_nicolson");
    expect_block(flow, gm_run_state(run), GM_FLOW_OMEGA, "torus_omega_10_crank_nicolson");
    expect_number("kinetic energy", gm_flow_kinetic_energy(flow, gm_run_state(run)), 0.19839164538548865);
    expect_number("enstrophy", gm_flow_enstrophy(flow, gm_run_state(run)), 14.60232181455794);
    gm_run_close(run);
    free(start);
    gm_flow_close(flow);
}

/* Without viscosity circulation stays, and enstrophy with crank-nicolson. */
static void torus_conserves(void **unused)
{
    (void)unused;
    struct gm_flow *flow = torus(0);
    struct gm_problem problem;
    double omega[80] = {0}, *start = malloc(gm_flow_size(flow) * sizeof *start);
    for (size_t v = 0; v < 80; v++) {
        const double *p = flow->complex->point + 2 * v;
        for (size_t m = 0; m < 16; m += 4) {
            const double *mode = reference("torus_inviscid_modes", 16) + m;
            omega[v] += 2 * M_PI * mode[3] * sin(2 * M_PI * (mode[0] * p[0] + mode[1] * p[1]) + mode[2]);
        }
    }
    assert_true(gm_flow_start(flow, omega, start));
    expect_number("enstrophy", gm_flow_enstrophy(flow, start), 35.57150819330606);
    const double energy = gm_flow_kinetic_energy(flow, start);
    expect_number("kinetic energy", energy, 0.290761645779033);
    struct gm_run *run = open_run(flow, &problem, "semi-implicit", 0.01, start);
    assert_int_equal(gm_run_advance(run, 10), GM_OK);
    expect_block(flow, gm_run_state(run), GM_FLOW_PSI, "torus_inviscid_psi_10_backward_euler");
    const double lost = gm_flow_kinetic_energy(flow, gm_run_state(run)) / energy - 1;
    assert_true(fabs(lost - 0.0005309522309473458) < 1e-11);
    const double worn = gm_flow_enstrophy(flow, gm_run_state(run)) / 35.57150819330606 - 1;
    assert_true(fabs(worn - -0.0036105899791436524) < 1e-11);
    assert_true(gm_flow_circulation_error(flow, gm_run_state(run)) < 1e-13);
    gm_run_close(run);
    run = open_run(flow, &problem, "crank-nicolson", 0.01, start);
    assert_int_equal(gm_run_advance(run, 10), GM_OK);
    expect_block(flow, gm_run_state(run), GM_FLOW_PSI, "torus_inviscid_psi_10_crank_nicolson");
    const double kept = gm_flow_kinetic_energy(flow, gm_run_state(run)) / energy - 1;
    assert_true(fabs(kept - 0.0005073135938584716) < 1e-11);
    assert_true(fabs(gm_flow_enstrophy(flow, gm_run_state(run)) / 35.57150819330606 - 1) < 1e-12);
    assert_true(gm_flow_circulation_error(flow, gm_run_state(run)) < 1e-13);
    gm_run_close(run);
    free(start);
    gm_flow_close(flow);
}

/* A run that is saved, resumed elsewhere and cut in pieces has the same bits. */
static void snapshots_resume(void **unused)
{
    (void)unused;
    static const char *const names[] = {"semi-implicit", "crank-nicolson", "steady"};
    struct gm_flow *flow = small_room(GM_VERTEX_SOFT);
    flow->tracers = 20;
    struct gm_problem problem;
    double *start = start_at_rest(flow);
    for (size_t i = 0; i < 3; i++) {
        struct gm_run *whole = open_run(flow, &problem, names[i], 0.05, start);
        struct gm_run *other = open_run(flow, &problem, names[i], 0.05, start);
        void *snapshot = malloc(gm_run_snapshot_size(whole));
        gm_run_advance(whole, 3);
        gm_run_save(whole, snapshot);
        assert_int_equal(gm_run_advance(whole, 5), GM_OK);
        gm_run_load(other, snapshot);
        for (int k = 0; k < 5; k++) {
            assert_int_equal(gm_run_advance(other, 1), GM_OK);
        }
        assert_memory_equal(gm_run_state(whole), gm_run_state(other), problem.n * sizeof(double));
        free(snapshot);
        gm_run_close(whole);
        gm_run_close(other);
    }
    free(start);
    gm_flow_close(flow);
}

/* Tracers are passive: with and without them the flow has the same bits; they stay inside. */
static void tracers_do_not_matter(void **unused)
{
    (void)unused;
    struct gm_flow *flow = small_room(GM_VERTEX_SOFT);
    struct gm_problem with, without;
    double *start = start_at_rest(flow);
    struct gm_run *clean = open_run(flow, &without, "semi-implicit", 0.05, start);
    assert_int_equal(gm_run_advance(clean, 100), GM_OK);
    free(start);
    const size_t n = gm_flow_size(flow);
    double *end = malloc(n * sizeof *end);
    memcpy(end, gm_run_state(clean), n * sizeof *end);
    gm_run_close(clean);
    flow->tracers = 50;
    start = start_at_rest(flow);
    struct gm_run *strewn = open_run(flow, &with, "semi-implicit", 0.05, start);
    assert_int_equal(gm_run_advance(strewn, 100), GM_OK);
    assert_memory_equal(gm_run_state(strewn), end, n * sizeof *end);
    bool came_back = false;
    for (size_t i = 0; i < 50; i++) {
        const double *tracer = gm_flow_tracer(flow, gm_run_state(strewn), i);
        assert_true(tracer[GM_TRACER_X] >= 0 && tracer[GM_TRACER_X] <= 4);
        assert_true(tracer[GM_TRACER_Y] >= 0 && tracer[GM_TRACER_Y] <= 3);
        came_back |= tracer[GM_TRACER_AGE] < 100;
    }
    assert_true(came_back);
    gm_run_close(strewn);
    free(start);
    free(end);
    gm_flow_close(flow);
}

/* Acute at any size, structured or not; everything summed up right. */
static void rectangles_are_acute(void **unused)
{
    (void)unused;
    for (long edges = 3; edges <= 48; edges = edges * 3 / 2 + 1) {
        for (int kind = 0; kind < 8; kind++) {
            struct gm_rectangle rectangle = {.width = 2,
                                             .height = 1,
                                             .edges = edges,
                                             .transposed = kind & 1,
                                             .irregular = kind & 2 ? 0.25 : 0,
                                             .torus = kind & 4};
            rectangle.strips = gm_rectangle_strips(2, 1, edges, rectangle.transposed);
            if (rectangle.strips < 4 || !gm_rectangle_is_acute(&rectangle)) {
                continue;
            }
            struct gm_triangulation_fault fault;
            struct gm_complex *complex = gm_rectangle_open(&rectangle, &fault);
            if (!complex) {
                fail_msg("%ld edges, %ld strips, kind %d: fault %d", edges, rectangle.strips, kind,
                         (int)fault.kind);
            }
            const size_t n = (size_t)edges, m = (size_t)rectangle.strips;
            assert_int_equal(complex->triangles, 2 * n * m);
            assert_int_equal(complex->boundary, rectangle.torus ? 0 : 2 * n + m);
            assert_true(complex->largest_angle <= 88 + 1e-5);
            assert_true(fabs(complex->total_area - 2) < 1e-12);
            double cells = 0;
            for (size_t v = 0; v < complex->vertices; v++) {
                cells += complex->star0[v];
            }
            assert_true(fabs(cells - 2) < 1e-12);
            gm_complex_close(complex);
        }
    }
}

/* The walls lie where they are said to lie, to the last bit, whatever the edges and strips: scenes and the
   moved vertices of irregular meshes go by it. */
static void walls_are_exact(void **unused)
{
    (void)unused;
    for (long edges = 3; edges <= 100; edges++) {
        for (int kind = 0; kind < 4; kind++) {
            struct gm_rectangle rectangle = {.width = 2 * M_PI,
                                             .height = 1,
                                             .edges = edges,
                                             .transposed = kind & 1,
                                             .irregular = kind & 2 ? 0.25 : 0};
            rectangle.strips = gm_rectangle_strips(2 * M_PI, 1, edges, rectangle.transposed);
            struct gm_triangulation_fault fault;
            const bool small = edges * rectangle.strips < 3000;
            struct gm_complex *complex = small && rectangle.strips >= 4 && gm_rectangle_is_acute(&rectangle)
                                             ? gm_rectangle_open(&rectangle, &fault)
                                             : NULL;
            for (size_t b = 0; complex && b < complex->boundary; b++) {
                const double *p = complex->point + 2 * complex->boundary_vertex[b];
                assert_true(p[0] == 0 || p[0] == rectangle.width || p[1] == 0 || p[1] == rectangle.height);
            }
            gm_complex_close(complex);
        }
    }
}

/* On interior dual cells the flux of any psi is free of divergence, obtuse triangles or not. */
static void fluxes_are_closed(void **unused)
{
    (void)unused;
    static const char *const files[] = {"square-small.msh", "lshape.msh", "room-small.msh"};
    for (size_t i = 0; i < 3; i++) {
        struct gm_triangulation mesh = mesh_of(files[i]);
        const struct gm_complex *complex = mesh.complex;
        double psi[200], scratch[400], flux[600], out[200] = {0};
        bool inside[200];
        for (size_t v = 0; v < complex->vertices; v++) {
            psi[v] = sin(3.0 * (double)v * (double)v);
            inside[v] = true;
        }
        gm_flow_fluxes(complex, psi, scratch, flux);
        for (size_t e = 0; e < complex->edges; e++) {
            out[complex->edge[2 * e]] -= flux[e];
            out[complex->edge[2 * e + 1]] += flux[e];
        }
        for (size_t b = 0; b < complex->boundary; b++) {
            inside[complex->boundary_vertex[b]] = false;
        }
        for (size_t v = 0; v < complex->vertices; v++) {
            assert_true(!inside[v] || fabs(out[v]) < 1e-14);
        }
        gm_triangulation_close(&mesh);
    }
}

/* A cubic psi is found again exactly by the fit that profiles are read from. */
static void samples_are_cubic(void **unused)
{
    (void)unused;
    struct gm_flow *flow = small_room(GM_VERTEX_SOFT);
    double *y = calloc(gm_flow_size(flow), sizeof *y);
    for (size_t v = 0; v < flow->complex->vertices; v++) {
        const double x = flow->complex->point[2 * v], z = flow->complex->point[2 * v + 1];
        y[v] = 1 + x * x * z - 2 * z * z * z + x;
    }
    struct gm_sample sample;
    assert_true(gm_flow_sample(flow, y, 1.3, 0.7, &sample));
    assert_true(fabs(sample.psi - (1 + 1.69 * 0.7 - 2 * 0.343 + 1.3)) < 1e-12);
    assert_true(fabs(sample.u - (1.69 - 6 * 0.49)) < 1e-11);
    assert_true(fabs(sample.v + (2 * 1.3 * 0.7 + 1)) < 1e-11);
    free(y);
    gm_flow_close(flow);
}

/* The order that a certificate measures holds for the order that a scheme has, and for no other, whose other claims
   stay. */
static void wrong_orders_are_refuted(void **unused)
{
    (void)unused;
    for (int order = 1; order <= 2; order++) {
        struct gm_scheme scheme = *gm_scheme_find("semi-implicit");
        assert_int_equal(scheme.order, 1);
        scheme.order = order;
        const struct gm_certificate certificate = gm_certify(&scheme);
        assert_true(fabs(certificate.order - 1) < 0.1);
        assert_int_equal(certificate.order_holds, order == 1);
        assert_int_equal(certificate.holds, order == 1);
        for (size_t k = 0; k < GM_CLAIM_COUNT; k++) {
            assert_true(certificate.claims[k].holds || !(scheme.claims & 1u << k));
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(operators_agree),          cmocka_unit_test(meshes_agree),
        cmocka_unit_test(scrambled_is_the_same),    cmocka_unit_test(rectangles_are_acute),
        cmocka_unit_test(walls_are_exact),          cmocka_unit_test(fluxes_are_closed),
        cmocka_unit_test(cavities_agree),           cmocka_unit_test(room_agrees),
        cmocka_unit_test(artefacts_end_a_run),      cmocka_unit_test(lost_scalars_end_a_run),
        cmocka_unit_test(channel_agrees),           cmocka_unit_test(torus_agrees),
        cmocka_unit_test(torus_conserves),          cmocka_unit_test(snapshots_resume),
        cmocka_unit_test(tracers_do_not_matter),    cmocka_unit_test(samples_are_cubic),
        cmocka_unit_test(wrong_orders_are_refuted),
    };
    reference_open("flow.txt");
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    reference_close();
    return failed;
}
