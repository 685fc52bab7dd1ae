/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Numbers of flows by discrete exterior calculus: convergence, the room, the cavity of Ghia, Ghia & Shin
 * (1982). */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "core/schemes.h"
#include "scenes/flow/room_scene.h"

/* A lane of a scene with parameters as they would be typed. */
static struct gm_lane *open_lane(const char *scene_name, const char *scheme, const char *const words[][2])
{
    const struct gm_scene *scene = gm_scene_find(scene_name);
    const struct gm_settings settings = {0};
    char sentence[GM_MESSAGE];
    void *parameters = gm_scene_defaults(scene);
    const char *keys[8];
    size_t count = 0;
    assert_non_null(parameters);
    for (; words[count][0]; count++) {
        const struct gm_parameter *row = gm_scene_parameter(scene, words[count][0]);
        assert_non_null(row);
        assert_true(count < GM_COUNT(keys));
        keys[count] = row->key;
        assert_int_equal(gm_parameter_set(row, parameters, words[count][1]), GM_PARSED);
    }
    assert_true(!scene->settle || scene->settle(parameters, keys, count, sentence));
    struct gm_lane *lane = gm_lane_open(scene, parameters, &settings, gm_scheme_find(scheme), sentence);
    if (!lane) {
        fail_msg("%s", sentence);
    }
    free(parameters);
    return lane;
}

static double observe(const struct gm_lane *lane, const char *key)
{
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        if (strcmp(lane->scene->observables[i].key, key) == 0) {
            return gm_lane_observe(lane, i);
        }
    }
    fail_msg("no observable %s", key);
    return NAN;
}

static double slope(const double *x, const double *e, size_t n)
{
    double mx = 0, me = 0, above = 0, below = 0;
    for (size_t i = 0; i < n; i++) {
        mx += log(x[i]) / (double)n;
        me += log(e[i]) / (double)n;
    }
    for (size_t i = 0; i < n; i++) {
        above += (log(x[i]) - mx) * (log(e[i]) - me);
        below += (log(x[i]) - mx) * (log(x[i]) - mx);
    }
    return above / below;
}

static void expect_near(const char *what, double value, double wanted, double tolerance)
{
    print_message("%-44s %12.6g   (%g within %g)\n", what, value, wanted, tolerance);
    if (!(fabs(value - wanted) <= tolerance)) {
        fail_msg("%s: %.6g, not %.6g within %g", what, value, wanted, tolerance);
    }
}

/* Orders over the seven mean edge lengths of the document, on irregular meshes. */
static void shear_orders(void **unused)
{
    (void)unused;
    enum { MESHES = 7, ERRORS = 5 };
    static const char *const rows[MESHES] = {"11", "19", "45", "67", "90", "113", "135"};
    static const char *const keys[ERRORS] = {"psi_error", "theta_error", "flux_error", "velocity_error",
                                             "pressure_error"};
    static const struct {
        const char *scene;
        double orders[ERRORS];
    } flows[] = {{"couette", {2.10, 2.16, 1.28, 1.06, 0.92}}, {"poiseuille", {2.08, 2.19, 1.32, 1.07, 0.72}}};
    for (size_t f = 0; f < 2; f++) {
        double x[MESHES], e[ERRORS][MESHES];
        for (size_t m = 0; m < MESHES; m++) {
            const char *const words[][2] = {{"rows", rows[m]}, {"irregular", "0.25"}, {NULL, NULL}};
            struct gm_lane *lane = open_lane(flows[f].scene, "steady", words);
            assert_int_equal(gm_run_advance(lane->run, 6), GM_OK);
            assert_true(observe(lane, "divergence") <= 2e-16);
            x[m] = observe(lane, "mean_edge");
            for (size_t k = 0; k < ERRORS; k++) {
                e[k][m] = observe(lane, keys[k]);
            }
            gm_lane_close(lane);
        }
        for (size_t k = 0; k < ERRORS; k++) {
            char name[64];
            snprintf(name, sizeof name, "%s: order of %s", flows[f].scene, keys[k]);
            expect_near(name, slope(x, e[k], MESHES), flows[f].orders[k], 0.2);
        }
    }
}

/* Errors on three meshes that nothing moved, each within what its conditioning allows. */
static void shear_errors(void **unused)
{
    (void)unused;
    enum { NUMBERS = 6 };
    static const char *const keys[NUMBERS] = {"psi_error",      "theta_error",    "flux_error",
                                              "velocity_error", "pressure_error", "mean_edge"};
    static const struct {
        const char *scene, *rows, *columns;
        double number[NUMBERS][2]; /* value, relative tolerance */
    } cases[] = {
        {"couette",
         "6",
         "8",
         {{0.003846544816409577, 1.8e-10},
          {0.00022516907356353628, 5e-10},
          {0.012489611137497886, 3e-11},
          {0.045864705745036836, 1.6e-11},
          {0.35363657974151375, 3.9e-10},
          {0.15984296671656345, 1e-11}}},
        {"couette",
         "12",
         "16",
         {{0.0010737711062316555, 8e-10},
          {4.668795814529764e-05, 1.1000000000000001e-08},
          {0.004084862823958433, 5.2e-11},
          {0.020287429008481885, 1.4e-11},
          {0.17787774663877914, 1.5e-09},
          {0.07907445276238782, 1e-11}}},
        {"couette",
         "24",
         "32",
         {{0.0002726260164783679, 2.0999999999999998e-09},
          {9.148900893858522e-06, 4.9e-08},
          {0.0013549580498787368, 2.1e-10},
          {0.009563015742342413, 1e-11},
          {0.08981064684045603, 1.9e-09},
          {0.039242269175230764, 1e-11}}},
        {"poiseuille",
         "6",
         "8",
         {{0.0041343819060359775, 2.2999999999999998e-10},
          {0.00031710758950352153, 1.5e-10},
          {0.027187344545000554, 4.5e-11},
          {0.08392898113858992, 1.1999999999999999e-11},
          {0.04046635499737795, 2.7e-10},
          {0.15984296671656345, 1e-11}}},
        {"poiseuille",
         "12",
         "16",
         {{0.0011451213204387593, 9.1e-10},
          {5.759246443356416e-05, 1.8e-09},
          {0.008731518570406114, 2.2999999999999998e-10},
          {0.03738859846759641, 2.5e-11},
          {0.027461539132144143, 6.2e-10},
          {0.07907445276238782, 1e-11}}},
        {"poiseuille",
         "24",
         "32",
         {{0.000306333505073674, 9.300000000000001e-10},
          {1.0786650719866303e-05, 1.4e-08},
          {0.0028134014943099854, 2.6e-10},
          {0.017541930340798685, 2.6999999999999997e-11},
          {0.01768134645396799, 1.6e-09},
          {0.039242269175230764, 1e-11}}},
    };
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        const char *const words[][2] = {{"rows", cases[i].rows}, {"columns", cases[i].columns}, {NULL, NULL}};
        struct gm_lane *lane = open_lane(cases[i].scene, "steady", words);
        assert_int_equal(gm_run_advance(lane->run, 8), GM_OK);
        for (size_t k = 0; k < NUMBERS; k++) {
            const double wanted = cases[i].number[k][0];
            expect_near(keys[k], observe(lane, keys[k]), wanted, cases[i].number[k][1] * wanted);
        }
        gm_lane_close(lane);
    }
}

/* What the order of the pressure hangs on: along the walls lies a layer of wrong vorticity, a cell wide. Away
   from it the order is 2; and where convection outweighs viscosity the layer weighs less. */
static void pressure_orders(void **unused)
{
    (void)unused;
    enum { MESHES = 5 };
    static const char *const rows[MESHES] = {"11", "19", "45", "67", "90"};
    static const struct {
        const char *reynolds, *key;
        double low, high;
    } cases[] = {
        {"1", "pressure_error", 0.9, 1.1},
        {"1", "pressure_error_middle", 1.9, 2.1},
        {"100", "pressure_error", 1.35, 1.65},
        {"250", "pressure_error", 1.65, 1.95},
    };
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        double x[MESHES], e[MESHES];
        for (size_t m = 0; m < MESHES; m++) {
            const char *const words[][2] = {{"rows", rows[m]}, {"reynolds", cases[i].reynolds}, {NULL, NULL}};
            struct gm_lane *lane = open_lane("couette", "steady", words);
            assert_int_equal(gm_run_advance(lane->run, 12), GM_OK);
            x[m] = observe(lane, "mean_edge");
            e[m] = observe(lane, cases[i].key);
            gm_lane_close(lane);
        }
        const double order = slope(x, e, MESHES);
        print_message("couette, Re %s: order of %s %.3f\n", cases[i].reynolds, cases[i].key, order);
        assert_true(order >= cases[i].low && order <= cases[i].high);
    }
}

/* The channel's mean errors at 3 L / 4, on two meshes. */
static void channel_errors(void **unused)
{
    (void)unused;
    static const char *const meshes[2][2] = {{"14", "98"}, {"36", "252"}};
    static const double wanted[2][2] = {{5.8e-3, 2.1e-5}, {8.5e-4, 2.1e-5}};
    for (size_t i = 0; i < 2; i++) {
        const char *const words[][2] = {{"rows", meshes[i][0]}, {"columns", meshes[i][1]}, {NULL, NULL}};
        struct gm_lane *lane = open_lane("channel", "steady", words);
        assert_int_equal(gm_run_advance(lane->run, 8), GM_OK);
        expect_near("channel: mean error of u", observe(lane, "u_error"), wanted[i][0], 0.02 * wanted[i][0]);
        expect_near("channel: mean error of theta", observe(lane, "theta_error"), wanted[i][1],
                    0.05 * wanted[i][1]);
        gm_lane_close(lane);
    }
}

/* The room on a coarse mesh, after so many steps. */
static void coarse_room(void **unused)
{
    (void)unused;
    enum { NUMBERS = 12 };
    static const char *const names[NUMBERS] = {
        "scalar total", "its rate",       "convected inflow", "kinetic energy",     "enstrophy", "sum of psi",
        "sum of psi^2", "sum of theta^2", "least psi inside", "largest psi inside", "reaction",  "outflow"};
    static const struct {
        long steps;
        double number[NUMBERS]
                     [2]; /* value, relative tolerance; an outflow of 0: not yet told apart from it */
    } cases[] = {
        {1,
         {{77.77408335914008, 3.6e-11},
          {322.60220030535294, 2.5e-11},
          {562.5, 3.6e-11},
          {0.6327283579673191, 1e-11},
          {6.833270849654464, 1e-11},
          {8.323862249337775, 1e-11},
          {3.990975496480407, 1e-11},
          {65758.92447329918, 4e-11},
          {0.002153976497007023, 1.1999999999999999e-11},
          {0.6645060234038106, 1e-11},
          {-239.89779969464726, 3.2e-10},
          {0.0, 1e-11}}},
        {5,
         {{136.17675396928536, 2.6999999999999997e-11},
          {390.0867375820269, 2.6999999999999997e-11},
          {562.5, 3.6e-11},
          {0.6373189266782129, 1e-11},
          {5.9339455387702635, 1.4e-11},
          {8.286494872428177, 1e-11},
          {3.981412320901441, 1e-11},
          {85571.56982888564, 3.2999999999999996e-11},
          {0.001799196856199951, 1.5e-11},
          {0.6648368584562445, 1e-11},
          {-172.41326241797285, 4.8e-10},
          {0.0, 1e-11}}},
        {20,
         {{430.82152670729755, 2e-11},
          {548.0242945484491, 1.3e-11},
          {562.5, 3.6e-11},
          {0.6735620262336768, 1e-11},
          {5.114444838926643, 5.3999999999999994e-11},
          {8.148837335626663, 2.3e-11},
          {3.9430562287793327, 3.6e-11},
          {309048.98105077737, 2.9000000000000003e-11},
          {0.0008793540877642326, 7e-11},
          {0.6656911909419364, 1e-11},
          {-14.475705451552145, 1.2e-09},
          {0.0, 1e-11}}},
        {500,
         {{9376.013189371813, 4e-11},
          {155.08259512735094, 5.9e-10},
          {562.5, 3.6e-11},
          {1.8889016444093005, 3e-11},
          {8.969216146385254, 5e-11},
          {3.09329062844998, 2.1e-10},
          {3.105708589745553, 2e-10},
          {5780788.047021493, 5.3000000000000004e-11},
          {-0.4207280185342292, 1.2e-10},
          {0.670245731537114, 5.7e-11},
          {-153.6765865944239, 1.2999999999999999e-09},
          {253.7408182782572, 2.8e-10}}},
    };
    const char *const words[][2] = {{"rows", "20"}, {"columns", "28"}, {"tracers", "0"}, {NULL, NULL}};
    struct gm_lane *lane = open_lane("room", "semi-implicit", words);
    const struct gm_flow *flow = gm_flow_of(&lane->problem);
    const struct gm_complex *complex = flow->complex;
    assert_int_equal(complex->vertices, 595);
    assert_int_equal(complex->triangles, 1120);
    expect_near("mean edge", complex->mean_edge, 0.2306586505785794, 1e-11);
    expect_near("smallest angle", complex->smallest_angle, 39.595068000756925, 1e-9);
    expect_near("largest angle", complex->largest_angle, 79.1901360015142, 1e-9);
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        assert_int_equal(gm_run_advance(lane->run, cases[i].steps - lane->run->steps), GM_OK);
        const double *y = gm_run_state(lane->run), *theta = gm_flow_block(flow, y, GM_FLOW_THETA);
        const struct gm_budget budget = gm_flow_budget(flow, y);
        double psi = 0, psi_2 = 0, theta_2 = 0, low = INFINITY, high = -INFINITY;
        for (size_t v = 0; v < complex->vertices; v++) {
            psi += complex->star0[v] * y[v];
            psi_2 += complex->star0[v] * y[v] * y[v];
            theta_2 += complex->star0[v] * theta[v] * theta[v];
            if (flow->kind[v] == GM_VERTEX_FREE) {
                low = fmin(low, y[v]);
                high = fmax(high, y[v]);
            }
        }
        const double mine[NUMBERS] = {gm_flow_scalar_total(flow, y),
                                      budget.rate,
                                      budget.convected,
                                      gm_flow_kinetic_energy(flow, y),
                                      gm_flow_enstrophy(flow, y),
                                      psi,
                                      psi_2,
                                      theta_2,
                                      low,
                                      high,
                                      budget.reaction,
                                      budget.outflow};
        for (size_t k = 0; k < NUMBERS; k++) {
            const double wanted = cases[i].number[k][0];
            expect_near(names[k], mine[k], wanted, wanted == 0 ? 1e-6 : cases[i].number[k][1] * fabs(wanted));
        }
    }
    gm_lane_close(lane);
}

/* The divergence at every step of both flows, marching. */
static void divergence_is_round_off(void **unused)
{
    (void)unused;
    static const char *const scenes[] = {"couette", "poiseuille", "channel"};
    for (size_t i = 0; i < 3; i++) {
        const char *const words[][2] = {{"irregular", "0.25"}, {NULL, NULL}};
        struct gm_lane *lane = open_lane(scenes[i], "semi-implicit", words);
        double largest = 0;
        for (int step = 0; step < 100; step++) {
            assert_int_equal(gm_run_advance(lane->run, 1), GM_OK);
            largest = fmax(largest, observe(lane, "divergence"));
        }
        print_message("%s: divergence %.2g\n", scenes[i], largest);
        assert_true(largest <= 2e-16);
        gm_lane_close(lane);
    }
}

static void room_totals(void **unused)
{
    (void)unused;
    static const double wanted[3][3] = {
        {5899.1, 1.3e-4, 1.510}, {10211.3, 272.1, 2.040}, {11213.9, 392.4, 1.801}};
    static const long steps[3] = {250, 250, 500};
    const char *const words[][2] = {{"irregular", "0.25"}, {NULL, NULL}};
    struct gm_lane *lane = open_lane("room", "semi-implicit", words);
    double divergence = 0, defect = 0;
    for (size_t i = 0; i < 3; i++) {
        for (long done = 0; done < steps[i]; done += 10) {
            assert_int_equal(gm_run_advance(lane->run, 10), GM_OK);
            divergence = fmax(divergence, observe(lane, "divergence"));
            defect = fmax(defect, observe(lane, "budget_defect"));
        }
        expect_near("room: scalar total", observe(lane, "scalar_total"), wanted[i][0], 0.005 * wanted[i][0]);
        /* the front of the pollutant, at .5: two digits are known */
        expect_near("room: outflow of scalar", observe(lane, "scalar_outflow"), wanted[i][1],
                    (i == 0 ? 0.05 : 0.005) * wanted[i][1]);
        expect_near("room: kinetic energy", observe(lane, "kinetic_energy"), wanted[i][2],
                    0.005 * wanted[i][2]);
    }
    print_message("room: divergence %.2g, defect of the budget %.2g\n", divergence, defect);
    assert_true(divergence <= 2e-16);
    assert_true(defect <= 1e-13);
    const double solves = (double)lane->run->factor_solves / (double)lane->run->steps;
    print_message("room: %.2f systems a step with factors that are made once\n", solves);
    assert_true(solves > 1 && solves <= 12);
    gm_lane_close(lane);
}

/* Tables I and II of Ghia, Ghia & Shin without their ends. */
enum { STATIONS = 15 };
static const double stations_y[STATIONS] = {0.9766, 0.9688, 0.9609, 0.9531, 0.8516, 0.7344, 0.6172, 0.5000,
                                            0.4531, 0.2813, 0.1719, 0.1016, 0.0703, 0.0625, 0.0547};
static const double stations_x[STATIONS] = {0.9688, 0.9609, 0.9531, 0.9453, 0.9063, 0.8594, 0.8047, 0.5000,
                                            0.2344, 0.2266, 0.1563, 0.0938, 0.0781, 0.0703, 0.0625};
static const struct {
    const char *reynolds;
    double u[STATIONS], v[STATIONS], psi_min, u_most, v_most;
} ghia[] = {
    {"100",
     {0.84123, 0.78871, 0.73722, 0.68717, 0.23151, 0.00332, -0.13641, -0.20581, -0.21090, -0.15662, -0.10150,
      -0.06434, -0.04775, -0.04192, -0.03717},
     {-0.05906, -0.07391, -0.08864, -0.10313, -0.16914, -0.22445, -0.24533, 0.05454, 0.17527, 0.17507,
      0.16077, 0.12317, 0.10890, 0.10091, 0.09233},
     -0.10342,
     0.0055,
     0.0100},
    {"400",
     {0.75837, 0.68439, 0.61756, 0.55892, 0.29093, 0.16256, 0.02135, -0.11477, -0.17119, -0.32726, -0.24299,
      -0.14612, -0.10338, -0.09266, -0.08186},
     {-0.12146, -0.15663, -0.19254, -0.22847, NAN, -0.44993, -0.38598, 0.05186, 0.30174, 0.30203, 0.28124,
      0.22965, 0.20920, 0.19713, 0.18360},
     -0.11391,
     0.0025,
     0.0050},
    {"1000",
     {0.65928, 0.57492, 0.51117, 0.46604, 0.33304, 0.18719, 0.05702, -0.06080, -0.10648, -0.27805, -0.38289,
      -0.29730, -0.22220, -0.20196, -0.18109},
     {-0.21388, -0.27669, -0.33714, -0.39188, -0.51550, -0.42665, -0.31966, 0.02526, 0.32235, 0.33075,
      0.37095, 0.32627, 0.30353, 0.29012, 0.27485},
     -0.11793,
     0.0055,
     0.0120},
};

static void cavity(void **unused)
{
    (void)unused;
    for (size_t i = 0; i < 3; i++) {
        const char *const words[][2] = {
            {"reynolds", ghia[i].reynolds}, {"columns", "128"}, {"rows", "168"}, {NULL, NULL}};
        struct gm_lane *lane = open_lane("cavity", "steady", words);
        assert_int_equal(gm_run_advance(lane->run, 30), GM_OK);
        assert_true(observe(lane, "change") == 0); /* Newton's method has come to its end */
        double u = 0, v = 0;
        for (size_t k = 0; k < STATIONS; k++) {
            struct gm_sample sample;
            assert_true(gm_flow_sample(gm_flow_of(&lane->problem), gm_run_state(lane->run), 0.5,
                                       stations_y[k], &sample));
            u = fmax(u, fabs(sample.u - ghia[i].u[k]));
            assert_true(gm_flow_sample(gm_flow_of(&lane->problem), gm_run_state(lane->run), stations_x[k],
                                       0.5, &sample));
            v = isnan(ghia[i].v[k]) ? v : fmax(v, fabs(sample.v - ghia[i].v[k]));
        }
        print_message("cavity, Re %s\n", ghia[i].reynolds);
        expect_near("  largest difference of u from Ghia", u, 0, ghia[i].u_most);
        expect_near("  largest difference of v from Ghia", v, 0, ghia[i].v_most);
        expect_near("  stream function's minimum", observe(lane, "psi_min"), ghia[i].psi_min,
                    0.003 * fabs(ghia[i].psi_min));
        gm_lane_close(lane);
    }
}

static double taylor_green_order(const char *domain, const char *irregular)
{
    enum { MESHES = 4 };
    static const char *const columns[MESHES] = {"12", "24", "48", "96"};
    double x[MESHES], e[MESHES];
    for (size_t m = 0; m < MESHES; m++) {
        const char *const words[][2] = {{"domain", domain},       {"columns", columns[m]},
                                        {"irregular", irregular}, {"viscosity", "0.02"},
                                        {"dt", "0.002"},          {NULL, NULL}};
        struct gm_lane *lane = open_lane("taylor-green", "crank-nicolson", words);
        assert_int_equal(gm_run_advance(lane->run, 100), GM_OK);
        x[m] = observe(lane, "mean_edge");
        e[m] = observe(lane, "psi_error");
        gm_lane_close(lane);
    }
    return slope(x, e, MESHES);
}

static void taylor_green(void **unused)
{
    (void)unused;
    expect_near("Taylor-Green, torus: order", taylor_green_order("torus", "0"), 2, 0.1);
    const double box = taylor_green_order("box", "0.25");
    print_message("Taylor-Green, irregular box: order %.3f\n", box);
    assert_true(box >= 1.7);
}

static void ideal_torus(void **unused)
{
    (void)unused;
    static const char *const schemes[] = {"semi-implicit", "crank-nicolson"};
    for (size_t i = 0; i < 2; i++) {
        const char *const words[][2] = {
            {"viscosity", "0"}, {"speed", "1"}, {"irregular", "0.25"}, {NULL, NULL}};
        struct gm_lane *lane = open_lane("taylor-green", schemes[i], words);
        double circulation = 0;
        for (int step = 0; step < 300; step++) {
            assert_int_equal(gm_run_advance(lane->run, 1), GM_OK);
            circulation = fmax(circulation, observe(lane, "circulation_error"));
        }
        expect_near("ideal torus: circulation", circulation, 0, 1e-13);
        if (i == 1) {
            expect_near("ideal torus: enstrophy", observe(lane, "enstrophy_error"), 0, 1e-13);
        }
        gm_lane_close(lane);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shear_orders),    cmocka_unit_test(shear_errors),
        cmocka_unit_test(pressure_orders), cmocka_unit_test(channel_errors),
        cmocka_unit_test(coarse_room),     cmocka_unit_test(divergence_is_round_off),
        cmocka_unit_test(room_totals),     cmocka_unit_test(cavity),
        cmocka_unit_test(taylor_green),    cmocka_unit_test(ideal_torus),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
