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

#include "scenes/flows.h"

/* A lane of a scene with parameters as they would be typed. */
static struct gm_lane *open_lane(const char *scene_name, const char *scheme, const char *const words[][2])
{
    const struct gm_scene *scene = gm_scene_find(scene_name);
    const struct gm_settings settings = {0};
    char sentence[GM_SENTENCE];
    void *parameters = calloc(1, scene->size);
    gm_parameters_reset(scene->parameters, scene->parameter_count, parameters);
    for (size_t i = 0; words[i][0]; i++) {
        const struct gm_parameter *row = gm_scene_parameter(scene, words[i][0]);
        assert_non_null(row);
        assert_int_equal(gm_parameter_set(row, parameters, words[i][1]), GM_PARSED);
    }
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
        const char *const words[][2] = {{"reynolds", ghia[i].reynolds}, {NULL, NULL}};
        struct gm_lane *lane = open_lane("cavity", "steady", words);
        assert_int_equal(gm_run_advance(lane->run, 30), GM_OK);
        assert_true(observe(lane, "change") == 0); /* Newton's method has come to its end */
        double u = 0, v = 0;
        for (size_t k = 0; k < STATIONS; k++) {
            struct gm_sample sample;
            assert_true(
                gm_flow_sample(lane->problem.flow, gm_run_state(lane->run), 0.5, stations_y[k], &sample));
            u = fmax(u, fabs(sample.u - ghia[i].u[k]));
            assert_true(
                gm_flow_sample(lane->problem.flow, gm_run_state(lane->run), stations_x[k], 0.5, &sample));
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
        cmocka_unit_test(shear_orders), cmocka_unit_test(divergence_is_round_off),
        cmocka_unit_test(room_totals),  cmocka_unit_test(cavity),
        cmocka_unit_test(taylor_green), cmocka_unit_test(ideal_torus),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
