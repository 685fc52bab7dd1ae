/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fields between walls: a kink comes back from one as the exact solution does, by every scheme for waves; leapfrog
   takes the steps that ghost nodes written by hand give it; sound is reflected, and what has no mirror image is
   refused. */
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
#include "core/field/families/laws/laws.h"
#include "core/field/user/potential.h"
#include "core/model/equations.h"
#include "core/ode/user/evolution.h"
#include "core/run.h"
#include "core/schemes.h"

static const struct gm_settings no_settings;
static const char *const all[] = {"leapfrog",     "energy-conserving", "box",
                                  "euler-box",    "midpoint-box",      "gauss-box3",
                                  "lobatto-box2", "lobatto-box4",      "lobatto-nystrom4"};

/* A kink of velocity 1/2 that meets its mirror image at x = 10 when t = 8. */
#define KINK                                                                                                 \
    "field: u\nV: 1 - cos(u)\nlet: g = 1/sqrt(1 - 1/4)\nlet: s = -2*sinh(4*g)/cosh(g*(x - 10))\n"            \
    "start: u = 4*atan(s), u_t = 4*g*cosh(4*g)/cosh(g*(x - 10))/(1 + s^2)\n"                                 \
    "exact: u = 4*atan(2*sinh(g*(t - 8)/2)/cosh(g*(x - 10)))\n"

struct walled {
    struct gm_user_system system;
    struct gm_user_wave wave;
    struct gm_problem problem;
};

static struct gm_grid1 between(double half_length, size_t nodes)
{
    return (struct gm_grid1){2 * (nodes - 1), 2 * half_length / (double)(nodes - 1), -half_length, 0, true};
}

static void open_walled(struct walled *walled, const char *text, size_t nodes)
{
    struct gm_fault fault;
    if (!gm_equations_open(&walled->system, text, strlen(text), NULL, 0, &fault)) {
        fail_msg("%s: %s", text, fault.sentence);
    }
    assert_true(gm_user_wave_derive(&walled->wave, &walled->system));
    double *values = gm_equations_start(&walled->system, NULL);
    const struct gm_grid1 grid = between(10, nodes);
    assert_true(gm_user_wave_open(&walled->problem, &walled->wave, values, &grid));
    free(values);
    if (!gm_user_wave_closes(&walled->problem, &fault)) {
        fail_msg("%s", fault.sentence);
    }
}

static void close_walled(struct walled *walled)
{
    gm_user_line_close(&walled->problem);
    gm_system_close(&walled->system);
}

/* The largest distance from the exact solution when the kink is back, and how far its energy was from that of the
   start on the way. */
static double error_of(const char *scheme, size_t nodes, double dt, double *energy)
{
    struct walled walled;
    open_walled(&walled, KINK, nodes);
    const struct gm_grid1 *line = &walled.problem.line;
    double *y = malloc(walled.problem.n * sizeof *y), error = 0;
    gm_user_line_levels(walled.problem.parameters, &walled.problem.line, dt, y);
    struct gm_run *run =
        gm_run_open(&walled.problem, gm_scheme_find_for(scheme, &walled.problem), &no_settings, 0, dt, y);
    assert_non_null(run);
    const double first = gm_wave_energy(&walled.problem, y);
    *energy = 0;
    for (long k = 0; k < lround(16 / dt); k++) {
        assert_int_equal(gm_run_advance(run, 1), GM_OK);
        *energy = fmax(*energy, fabs(gm_wave_energy(&walled.problem, gm_run_state(run)) / first - 1));
    }
    for (size_t i = 0; i < gm_grid1_seen(line); i++) {
        const double x = -10 + (double)i * line->dx;
        error = fmax(
            error, fabs(gm_run_state(run)[i] - gm_user_line_exact(walled.problem.parameters, 0, x, run->t)));
    }
    /* where the nodes of a new level are coupled, every iteration solves their equations */
    const bool coupled = strcmp(scheme, "box") == 0 || strcmp(scheme, "gauss-box3") == 0;
    assert_int_equal(run->solves, coupled ? run->iterations : 0);
    /* it has left the values that it came with by 2 pi on one side, and not on the other */
    assert_true(gm_run_state(run)[gm_grid1_seen(line) - 1] > 6 && y[gm_grid1_seen(line) - 1] < -6);
    gm_run_close(run);
    free(y);
    close_walled(&walled);
    return error;
}

static void a_kink_comes_back_from_a_wall(void **unused)
{
    (void)unused;
    for (size_t s = 0; s < GM_COUNT(all); s++) {
        double energy[2];
        const double coarse = error_of(all[s], 101, 0.08, &energy[0]),
                     fine = error_of(all[s], 201, 0.04, &energy[1]), slope = log2(coarse / fine);
        const bool keeps = strcmp(all[s], "energy-conserving") == 0;
        if (!(slope > 1.8 && fine < 0.1 && (keeps ? energy[1] < 1e-13 : energy[1] < energy[0] / 2.5))) {
            fail_msg("%s: errors %.2e, %.2e, energy %.2e, %.2e", all[s], coarse, fine, energy[0], energy[1]);
        }
    }
}

/* u_0 between a ghost u_{-1} = u_1, and so at the other end. */
static void leapfrog_steps_as_with_ghost_nodes(void **unused)
{
    (void)unused;
    enum { NODES = 101, STEPS = 300 };
    struct walled walled;
    open_walled(&walled, "field: u\nV: (u^2 - 1)^2/4\nstart: u = x/10 + exp(-x^2), u_t = x*exp(-x^2)\n",
                NODES);
    const double dt = 0.05, dx = 0.2;
    double *y = malloc(walled.problem.n * sizeof *y), past[NODES], now[NODES], next[NODES];
    gm_user_line_levels(walled.problem.parameters, &walled.problem.line, dt, y);
    memcpy(past, y, sizeof past);
    memcpy(now, y + walled.problem.line.points, sizeof now);
    struct gm_run *run =
        gm_run_open(&walled.problem, gm_scheme_find_for("leapfrog", &walled.problem), &no_settings, 0, dt, y);
    assert_int_equal(gm_run_advance(run, STEPS), GM_OK);
    for (int k = 1; k < STEPS; k++) {
        for (size_t i = 0; i < NODES; i++) {
            const double left = now[i > 0 ? i - 1 : 1], right = now[i + 1 < NODES ? i + 1 : NODES - 2];
            next[i] = 2 * now[i] - past[i] +
                      dt * dt * ((right - 2 * now[i] + left) / (dx * dx) - now[i] * (now[i] * now[i] - 1));
        }
        memcpy(past, now, sizeof now);
        memcpy(now, next, sizeof now);
    }
    for (size_t i = 0; i < NODES; i++) {
        assert_true(fabs(gm_run_state(run)[i] - now[i]) < 1e-10);
    }
    gm_run_close(run);
    free(y);
    close_walled(&walled);
}

/* The state of rates after t = 16, in which sound runs from wall to wall and back; or the sentence. */
static void evolve(const char *text, double *sound, char *sentence)
{
    enum { NODES = 81 };
    const struct gm_grid1 line = between(4, NODES);
    struct gm_user_system system;
    struct gm_user_evolution evolution;
    struct gm_problem problem;
    struct gm_fault fault;
    if (!gm_equations_open(&system, text, strlen(text), NULL, 0, &fault)) {
        fail_msg("%s: %s", text, fault.sentence);
    }
    assert_true(gm_user_evolution_derive(&evolution, &system));
    double *values = gm_equations_start(&system, NULL);
    assert_true(gm_user_evolution_open(&problem, &evolution, values, &line, GM_SPACE_FOURIER));
    const bool good = gm_user_evolution_closes(&problem, &fault);
    snprintf(sentence, 400, "%s", good ? "" : fault.sentence);
    double *y = malloc(problem.n * sizeof *y);
    for (size_t k = 0; k < 2 && good; k++) {
        gm_user_evolution_start(&problem, y);
        struct gm_run *run =
            gm_run_open(&problem, gm_scheme_find_for("rk4", &problem), &no_settings, 0, 0.01, y);
        assert_int_equal(gm_run_until(run, k == 0 ? 8 : 16), GM_OK);
        sound[k] = 0;
        for (size_t i = 0; i < NODES; i++) {
            const double x = -4 + 0.1 * (double)i, sign = k == 0 ? -1 : 1; /* half way the mirror image */
            sound[k] = fmax(sound[k], fabs(gm_run_state(run)[i] - exp(-4 * pow(sign * x - 0.5, 2))));
        }
        gm_run_close(run);
    }
    free(y);
    free(values);
    gm_user_line_close(&problem);
    gm_system_close(&system);
}

static void sound_is_reflected(void **unused)
{
    (void)unused;
    double sound[2] = {1, 1};
    char sentence[400] = "";
    evolve(
        "field: p q\nrate: p = -q_x\nrate: q = -p_x\nstart: p = exp(-4*(x - 1/2)^2), q = exp(-4*(x - 1/2)^2)\n",
        sound, sentence);
    /* t k^5 dt^4 / 120 of RK4, k = 5 */
    if (!(sound[0] < 5e-6 && sound[1] < 5e-6)) {
        fail_msg("%.2e, %.2e %s", sound[0], sound[1], sentence);
    }
}

static void what_has_no_mirror_image_is_refused(void **unused)
{
    (void)unused;
    static const struct {
        const char *text, *sentence;
    } refused[] = {
        {"field: u\nrate: u = -6*u*u_x - u_xxx\nstart: u = 2/cosh(3*x)^2\n",
         "there are no walls for these rates"},
        {"field: u\nrate: u = u_xx/10\nmass: u + u_x\nstart: u = 2/cosh(3*x)^2\n",
         "there are no walls for these rates"},
        {"field: p q\nrate: p = -q_x\nrate: q = -p_x\nstart: p = 0, q = 1\n", "q is 0 at walls"},
    };
    for (size_t i = 0; i < GM_COUNT(refused); i++) {
        double sound[2];
        char sentence[400] = "";
        evolve(refused[i].text, sound, sentence);
        if (!strstr(sentence, refused[i].sentence)) {
            fail_msg("%s: %s", refused[i].text, sentence);
        }
    }
    /* u u_x with u odd, and what decays */
    char sentence[400] = "";
    double sound[2];
    evolve("field: u\nrate: u = -u*u_x + u_xx/10\nstart: u = sin(pi*x/4)\n", sound, sentence);
    assert_string_equal(sentence, "");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_kink_comes_back_from_a_wall),
        cmocka_unit_test(leapfrog_steps_as_with_ghost_nodes),
        cmocka_unit_test(sound_is_reflected),
        cmocka_unit_test(what_has_no_mirror_image_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
