/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Published and independently measured numbers of the scenes for ordinary differential equations. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "tests/common/laboratory.h"

/* `digits` significant digits of the number to match are right to half a unit. */
static void expect(const char *words, const char *what, double value, double expected, double half_a_unit)
{
    if (!(fabs(value - expected) <= half_a_unit)) {
        fail_msg("%s: %s is %.6g, expected %.6g within %.1g", words, what, value, expected, half_a_unit);
    }
}

static void kepler_two_hundred_periods(void **unused)
{
    (void)unused;
    static const char base[] = "kepler eccentricity=.5 dt=2*pi/100 until=400*pi scheme=";
    static const struct {
        const char *scheme, *key;
        bool maximum;
        double value, half_a_unit;
    } rows[] = {
        {"rk2", "energy_error", false, 0.83, 0.005},
        {"rk4", "energy_error", false, 5.9e-3, 0.05e-3},
        {"rk4sym", "energy_error", true, 2.52e-4, 0.005e-4},
        {"gauss4", "energy_error", true, 4.77e-6, 0.005e-6},
        {"rk4sym", "lrl_angle", false, -0.169, 0.0005},
        {"gauss4", "lrl_angle", false, 9.7e-3, 0.05e-3},
        {"rk4sym", "angular_momentum_error", false, 0, 2e-14},
        {"gauss4", "angular_momentum_error", false, 0, 2e-14},
        {"midpoint", "angular_momentum_error", false, 0, 2e-14},
        {"verlet", "angular_momentum_error", false, 0, 2e-14},
        {"verlet", "lrl_angle", false, -3.0, 0.05},
        {"rk4", "angular_momentum_error", false, 9.2e-4, 0.05e-4},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        char words[200];
        struct gm_trial trial;
        snprintf(words, sizeof words, "%s%s", base, rows[i].scheme);
        gm_trial_run(&trial, words, rows[i].maximum);
        expect(words, rows[i].key,
               rows[i].maximum ? gm_trial_max(&trial, rows[i].key) : gm_trial_end(&trial, rows[i].key),
               rows[i].value, rows[i].half_a_unit);
        gm_trial_close(&trial);
    }
}

/* Grows under RK4, stays flat under RK4sym. */
static void kepler_growth(void **unused)
{
    (void)unused;
    double errors[2][2];
    for (int k = 0; k < 4; k++) {
        char words[200];
        struct gm_trial trial;
        snprintf(words, sizeof words, "kepler dt=2*pi/100 until=%d*pi scheme=%s", k % 2 ? 400 : 40,
                 k / 2 ? "rk4sym" : "rk4");
        gm_trial_run(&trial, words, true);
        errors[k / 2][k % 2] = gm_trial_max(&trial, "energy_error");
        gm_trial_close(&trial);
    }
    assert_true(errors[0][1] > 9 * errors[0][0]);
    assert_true(errors[1][1] < 1.01 * errors[1][0]);
}

static void high_eccentricity(void **unused)
{
    (void)unused;
    static const char *const useless[] = {"verlet", "rk4", "kahan-li8"};
    static const double sizes[] = {4e2, 97, 23};
    for (size_t i = 0; i < 3; i++) {
        char words[200];
        struct gm_trial trial;
        snprintf(words, sizeof words, "kepler eccentricity=.99 dt=2*pi/2000 until=40*pi scheme=%s",
                 useless[i]);
        gm_trial_run(&trial, words, true);
        expect(words, "energy_error_max", gm_trial_max(&trial, "energy_error"), sizes[i], 0.03 * sizes[i]);
        gm_trial_close(&trial);
    }
    struct gm_trial trial;
    gm_trial_run(&trial, "kepler eccentricity=.99 scheme=logh2 dt=2*pi/60 until=40*pi", true);
    assert_true(gm_trial_max(&trial, "energy_error") < 1e-12);
    assert_true(fabs(gm_trial_end(&trial, "lrl_angle")) < 1e-14);
    assert_true(trial.drive.lane->run->t >= 40 * M_PI * (1 - 1e-12));
    gm_trial_close(&trial);
}

/* All three invariants of the orbit, at any eccentricity; the time errs by order 2. The perturbing potential
   -e/r^2 only lessens L^2 by 2 e in the radial motion, so that after 100 radial periods of the energy
   -1/2 - e/(1/4) the axis has turned by 100 (2 pi / sqrt(1 - 2 e / L^2) - 2 pi). */
static void levi_civita(void **unused)
{
    (void)unused;
    static const char *const words[] = {"kepler scheme=levi-civita dt=2*pi/60 until=400*pi",
                                        "kepler eccentricity=.99 scheme=levi-civita dt=2*pi/60 until=40*pi"};
    for (size_t i = 0; i < 2; i++) {
        struct gm_trial trial;
        gm_trial_run(&trial, words[i], true);
        assert_true(gm_trial_max(&trial, "energy_error") < 1e-11);
        assert_true(gm_trial_max(&trial, "angular_momentum_error") < 1e-13);
        assert_true(gm_trial_max(&trial, "lrl_angle") < 1e-13);
        gm_trial_close(&trial);
    }
    struct gm_trial trial;
    gm_trial_run(&trial,
                 "kepler perturbation=1e-3 scheme=levi-civita dt=2*pi/200 "
                 "until=200*pi/(1.008*sqrt(1.008))",
                 true);
    const double momentum = 0.75; /* L^2 = 1 - eccentricity^2 */
    assert_true(gm_trial_max(&trial, "angular_momentum_error") < 1e-13);
    assert_true(gm_trial_max(&trial, "energy_error") < 1e-6);
    const double turned = 2 * M_PI / sqrt(1 - 2e-3 / momentum) - 2 * M_PI;
    expect("levi-civita, perturbed", "lrl_angle", gm_trial_end(&trial, "lrl_angle"), 100 * turned, 3e-4);
    gm_trial_close(&trial);
}

static void wisdom_holman(void **unused)
{
    (void)unused;
    static const char *const names[] = {"wisdom-holman2", "kahan-li8"};
    static const double sizes[] = {7.1e-4, 3.4e-5};
    for (size_t i = 0; i < 2; i++) {
        char words[200];
        struct gm_trial trial;
        snprintf(words, sizeof words, "kepler perturbation=1e-3 dt=pi/10 until=40*pi scheme=%s", names[i]);
        gm_trial_run(&trial, words, true);
        expect(words, "energy_error_max", gm_trial_max(&trial, "energy_error"), sizes[i], 0.02 * sizes[i]);
        assert_true(isnan(gm_trial_end(&trial, "position_error")));
        gm_trial_close(&trial);
    }
}

/* The largest difference of coordinates after 200 000 days to a solution of order 8 with small steps. */
static double planets_differ(const double *exact, const char *scheme, int dt)
{
    char words[200];
    struct gm_trial trial;
    double largest = 0;
    snprintf(words, sizeof words, "outer-planets until=200000 dt=%d scheme=%s", dt, scheme);
    gm_trial_run(&trial, words, false);
    const double *y = gm_run_state(trial.drive.lane->run);
    for (size_t i = 0; i < 18; i++) {
        largest = fmax(largest, fabs(y[i] - exact[i]));
    }
    gm_trial_close(&trial);
    return largest;
}

static void outer_planets(void **unused)
{
    (void)unused;
    static const struct {
        const char *scheme;
        int dt;
        double error;
    } rows[] = {
        {"strang(kepler,interaction)", 200, 3.14e-4}, {"strang(kepler,interaction)", 100, 7.82e-5},
        {"saba2(kepler,interaction)", 200, 1.3e-6},   {"saba4(kepler,interaction)", 400, 2.27e-6},
        {"aba864(kepler,interaction)", 500, 8.1e-6},  {"aba1064(kepler,interaction)", 1000, 2.3e-5},
        {"aba1064(kepler,interaction)", 500, 5.5e-8}, {"blanes-moan-nystrom6", 100, 4.7e-7},
    };
    struct gm_trial exact;
    gm_trial_run(&exact, "outer-planets until=200000 dt=40 scheme=kahan-li8", false);
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        const double error = planets_differ(gm_run_state(exact.drive.lane->run), rows[i].scheme, rows[i].dt);
        expect(rows[i].scheme, "error", error, rows[i].error, 0.02 * rows[i].error);
    }
    gm_trial_close(&exact);
}

static void two_turned_vortices(void **unused)
{
    (void)unused;
    struct gm_trial trial;
    const char *words = "vortices configuration=two-turned angle=pi/9 strength=150 steps=500000 scheme=rk4";
    gm_trial_run(&trial, words, false);
    expect(words, "angular_impulse_error", gm_trial_end(&trial, "angular_impulse_error"), 0.11, 0.005);
    gm_trial_close(&trial);
    words = "vortices configuration=two-turned angle=pi/9 strength=150 steps=500000 scheme=rk4sym";
    gm_trial_run(&trial, words, false);
    assert_true(gm_trial_end(&trial, "angular_impulse_error") < 2e-12);
    assert_true(gm_trial_end(&trial, "symmetry_defect") < 1e-12);
    gm_trial_close(&trial);
    words = "vortices configuration=two-turned angle=pi/5 strength=150 steps=500000 scheme=rk4";
    gm_trial_run(&trial, words, false);
    const double chaotic = gm_trial_end(&trial, "angular_impulse_error");
    assert_true(chaotic > 0.075 && chaotic < 0.3);
    gm_trial_close(&trial);
}

/* At pi/5 rounding breaks the symmetry of both schemes at about the same time. */
static void symmetry_breaks_for_both(void **unused)
{
    (void)unused;
    double times[2];
    for (int k = 0; k < 2; k++) {
        char words[200], message[GM_MESSAGE];
        struct gm_trial trial;
        snprintf(words, sizeof words, "vortices configuration=two-turned strength=100 steps=0 scheme=%s",
                 k ? "rk4sym" : "rk4");
        gm_trial_run(&trial, words, false);
        const struct gm_run *run = trial.drive.lane->run;
        while (run->t < 30 && gm_trial_end(&trial, "symmetry_defect") < 0.1) {
            assert_true(gm_drive_to(&trial.drive, run->steps + 1, false, message));
        }
        times[k] = run->t;
        gm_trial_close(&trial);
    }
    assert_true(times[0] > 11 && times[0] < 16);
    assert_true(times[1] > 11 && times[1] < 16);
}

static void reduced_vortices(void **unused)
{
    (void)unused;
    struct gm_trial trial;
    const char *words = "vortices configuration=reduced strength=150 steps=500000 scheme=rk4";
    gm_trial_run(&trial, words, false);
    expect(words, "section_shift", gm_trial_end(&trial, "section_shift"), 2.3e-2, 0.05e-2);
    gm_trial_close(&trial);
    words = "vortices configuration=reduced strength=150 steps=500000 scheme=rk4sym";
    gm_trial_run(&trial, words, false);
    /* 2e-8 by linear interpolation, whose ripple it is; less by the cubic */
    assert_true(fabs(gm_trial_end(&trial, "section_shift")) < 2e-8);
    gm_trial_close(&trial);
}

static void square_of_vortices(void **unused)
{
    (void)unused;
    struct gm_trial trial;
    gm_trial_run(&trial, "vortices configuration=square strength=1 dt=.05 until=100 scheme=gauss8", false);
    assert_true(gm_trial_end(&trial, "position_error") < 1e-12);
    gm_trial_close(&trial);
    gm_trial_run(&trial, "vortices configuration=square count=7 strength=1 dt=.05 until=20 scheme=gauss8",
                 false);
    assert_true(gm_trial_end(&trial, "position_error") < 1e-11);
    gm_trial_close(&trial);
}

/* log-volume after 500 steps */
static void volume(void **unused)
{
    (void)unused;
    static const struct {
        const char *scheme;
        double value, half_a_unit;
    } rows[] = {
        {"volume-splitting1", 0, 1e-7}, {"volume-splitting2", 0, 1e-7}, {"midpoint", -5e-4, 0.5e-4},
        {"rk4", -1.8e-6, 0.1e-6},       {"rk2", 1.5e-3, 0.05e-3},       {"explicit-euler", -1.0, 0.05},
        {"implicit-euler", -2.2, 0.05},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        char words[200];
        struct gm_trial trial;
        snprintf(words, sizeof words, "abc dt=.1 steps=500 scheme=%s", rows[i].scheme);
        gm_trial_run(&trial, words, false);
        expect(words, "log_volume", gm_trial_end(&trial, "log_volume"), rows[i].value, rows[i].half_a_unit);
        gm_trial_close(&trial);
    }
}

/* The greatest change of the energy itself: its error times what that is divided by, on the chain the energy
   of the start, on the pendulum its weight times its length, 1. */
static void stiff_springs(void **unused)
{
    (void)unused;
    static const struct {
        const char *words;
        double divisor, change, within; /* relative */
    } rows[] = {
        {"stiff dt=.03 until=200 scheme=verlet", 2.0006, 0.64, 0.02},
        {"stiff dt=.03 until=200 scheme=rk4", 2.0006, 1.0, 0.01},
        {"stiff dt=.03 until=200 scheme=midpoint", 2.0006, 8.6e-4, 0.01},
        {"stiff dt=.03 until=200 scheme=gauss4", 2.0006, 3.4e-5, 0.02},
        {"stiff dt=.03 until=200 scheme=blanes-moan4", 2.0006, 8.6e-4, 0.01},
        {"stiff dt=pi/100 until=100 scheme=impulse2", 2.0006, 0.015, 0.05},
        {"stiff dt=.98*pi/50 until=100 scheme=impulse2", 2.0006, 0.35, 0.05},
        {"stiff dt=.98*pi/50 until=100 scheme=mollified2", 2.0006, 0.057, 0.05},
        {"stiff dt=pi/100 until=100 scheme=gautschi2", 2.0006, 2.6e-3, 0.05},
        {"stiff system=spring-pendulum dt=.019 until=50 scheme=verlet", 1, 4.6e-3, 0.02},
        {"stiff system=spring-pendulum dt=.1 until=50 scheme=midpoint", 1, 0.058, 0.02},
        {"stiff system=spring-pendulum dt=.1 until=50 scheme=gauss4", 1, 6.3e-4, 0.05},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_trial trial;
        gm_trial_run(&trial, rows[i].words, true);
        assert_int_equal(trial.drive.lane->run->status, GM_OK);
        expect(rows[i].words, "change of energy", rows[i].divisor * gm_trial_max(&trial, "energy_error"),
               rows[i].change, rows[i].within * rows[i].change);
        gm_trial_close(&trial);
    }
}

static void stiff_limits(void **unused)
{
    (void)unused;
    static const struct {
        const char *words;
        enum gm_status status;
    } rows[] = {
        {"stiff dt=.039 until=200 scheme=verlet", GM_OK},
        {"stiff dt=.041 until=200 scheme=verlet", GM_BLOW_UP},
        {"stiff dt=.1 until=200 scheme=rk4", GM_BLOW_UP},
        {"stiff dt=.1 until=200 scheme=midpoint", GM_OK},
        {"stiff dt=.1 until=200 scheme=gauss4", GM_OK},
        {"stiff dt=.98*pi/50 scheme=gautschi2", GM_BLOW_UP},
        {"stiff system=spring-pendulum dt=.021 until=50 scheme=verlet", GM_BLOW_UP},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_trial trial;
        gm_trial_run(&trial, rows[i].words, false);
        if (trial.drive.lane->run->status != rows[i].status) {
            fail_msg("%s: %s", rows[i].words, gm_status_name(trial.drive.lane->run->status));
        }
        gm_trial_close(&trial);
    }
    struct gm_trial trial;
    gm_trial_run(&trial, "stiff dt=.03 until=200 scheme=rk4", false);
    assert_true(gm_trial_end(&trial, "stiff_energy") < 0.01); /* from 1, without a word */
    gm_trial_close(&trial);
}

/* The pair's distance after a close start: RK4 goes wrong without a sound, implicit schemes say when they
 * fail. */
static void vortex_collision(void **unused)
{
    (void)unused;
    static const struct {
        double turn; /* h omega */
        const char *scheme;
        enum gm_status status;
        double least, most; /* of the greatest error of the distance */
    } rows[] = {
        {0.1, "rk4", GM_OK, 0, 3e-3},      {0.5, "rk4", GM_OK, 0.1, 0.3},
        {1, "rk4", GM_OK, 0.4, 0.8},       {3, "rk4", GM_OK, 1, 3},
        {0.5, "midpoint", GM_OK, 0, 0.05}, {1, "midpoint", GM_NO_CONVERGENCE, 0, 1},
        {0.5, "rk4sym", GM_OK, 0, 0.05},   {1, "rk4sym", GM_NO_CONVERGENCE, 0, 1},
        {1, "gauss4", GM_OK, 0, 0.05},     {2, "gauss8", GM_OK, 0, 0.05},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        char words[200];
        struct gm_trial trial;
        snprintf(words, sizeof words,
                 "vortices configuration=collision strength=2*pi dt=%g/800 until=5 scheme=%s", rows[i].turn,
                 rows[i].scheme);
        gm_trial_run(&trial, words, true);
        const double error = gm_trial_max(&trial, "pair_distance_error");
        if (trial.drive.lane->run->status != rows[i].status ||
            !(error >= rows[i].least && error <= rows[i].most)) {
            fail_msg("%s: %s, distance error %.3g", words, gm_status_name(trial.drive.lane->run->status),
                     error);
        }
        gm_trial_close(&trial);
    }
}

static void variational(void **unused)
{
    (void)unused;
    struct gm_trial trial;
    gm_trial_run(&trial, "oscillator scheme=variational-rectangle tau0=.1", false);
    assert_int_equal(trial.drive.lane->run->status, GM_STEP_COLLAPSE);
    expect("variational-rectangle", "t", trial.drive.lane->run->t, 1.01, 0.005);
    gm_trial_close(&trial);
    static const double first[] = {0.1, 0.02, 0.001}, period[] = {0.9285, 0.971, 0.9978},
                        within[] = {0.005, 0.001, 1e-4};
    for (int k = 0; k < 3; k++) {
        char words[200];
        snprintf(words, sizeof words, "oscillator scheme=variational-rectangle-restart tau0=%g until=1000*pi",
                 first[k]);
        gm_trial_run(&trial, words, false);
        assert_true(gm_trial_end(&trial, "energy_error") < 1e-15);
        const double t = trial.drive.lane->run->t;
        expect(words, "mean period / 2 pi", t / (t + gm_trial_end(&trial, "phase_error")), period[k],
               within[k]);
        gm_trial_close(&trial);
    }
}

/* Neither at the defaults of a scene nor in a published figure is anything lost that the exact motion keeps,
   but by explicit Euler in the figure of its error, by implicit Euler on stiff springs, which damps them, and by a box
   past its stability, and on vortices by Tao's schemes, whose two copies part. Flows have no such observable. */
static void good_runs_do_not_warn(void **unused)
{
    (void)unused;
    for (size_t s = 0; s < gm_scene_count(); s++) {
        const struct gm_scene *scene = gm_scene_at(s);
        bool kept = false;
        for (size_t i = 0; i < scene->observable_count; i++) {
            kept |= scene->observables[i].kept;
        }
        for (size_t f = 0; kept && f <= scene->figure_count; f++) {
            const char *words = f < scene->figure_count ? scene->figures[f].arguments : scene->lanes;
            const bool lost =
                f < scene->figure_count && strcmp(scene->figures[f].name, "razafindralandy-5-euler") == 0;
            gm_trial_expect_warning(scene, words ? words : "", lost);
        }
        for (const char *const *name = scene->schemes; kept && *name; name++) {
            char words[96];
            const bool damped = strcmp(*name, "implicit-euler") == 0 && strcmp(scene->name, "stiff") == 0;
            const bool bad = strcmp(*name, "midpoint-box") == 0 && strcmp(scene->name, "sine-gordon") == 0;
            const bool parted = strncmp(*name, "tao", 3) == 0 && strcmp(scene->name, "vortices") == 0;
            snprintf(words, sizeof words, "scheme=%s", *name);
            gm_trial_expect_warning(scene, words, damped || bad || parted);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(good_runs_do_not_warn),
        cmocka_unit_test(kepler_two_hundred_periods),
        cmocka_unit_test(kepler_growth),
        cmocka_unit_test(high_eccentricity),
        cmocka_unit_test(levi_civita),
        cmocka_unit_test(wisdom_holman),
        cmocka_unit_test(outer_planets),
        cmocka_unit_test(two_turned_vortices),
        cmocka_unit_test(symmetry_breaks_for_both),
        cmocka_unit_test(reduced_vortices),
        cmocka_unit_test(square_of_vortices),
        cmocka_unit_test(volume),
        cmocka_unit_test(stiff_springs),
        cmocka_unit_test(stiff_limits),
        cmocka_unit_test(vortex_collision),
        cmocka_unit_test(variational),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
