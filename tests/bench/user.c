/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What it costs to step through a formula instead of the kernel of the same problem: Kepler's, by its
   interpreter, by loops that are compiled of the formula and by its hand-written ones, as nanoseconds for a
   step of one member and as the medians of the ratios of rounds in which all take turns; the same of a
   hundred bodies, a sum over pairs, beside C for them; and how long a formula of 10^5 operations takes to be
   read and derived. No test: nothing fails here. Usage: bench_own SOURCE_FOLDER */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include "app/native/engine.h"
#include "app/output/say.h"
#include "app/words/request.h"
#include "core/basics.h"
#include "core/model/equations.h"
#include "core/ode/families/splitting/kepler.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/user/problem.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/bench/ensembles.h"
#include "tests/bench/timing.h"
#include "tests/problems/problems.h"

enum { ROUNDS = 21 };

static const char kepler[] = "coordinates: q1 q2\nmomenta: p1 p2\n"
                             "H: (p1^2 + p2^2)/2 - 1/sqrt(q1^2 + q2^2)\n"
                             "start: q1 = 0.5, q2 = 0, p1 = 0, p2 = sqrt(3)\n";

static double step_of(const struct gm_problem *problem, const struct gm_scheme *scheme, const double *start,
                      long steps)
{
    const struct gm_settings settings = {0};
    struct gm_run *run = gm_run_open(problem, scheme, &settings, 0, 0.01, start);
    const double before = seconds();
    const bool good = run && gm_run_advance(run, steps) == GM_OK;
    const double took = 1e9 * (seconds() - before) / (double)steps / (double)problem->m;
    gm_run_close(run);
    return good ? took : -1;
}

static bool never(void)
{
    return false;
}

static void tell(const char *sentence)
{
    gm_complain("%s", sentence);
}

static struct gm_lane *open_lane(int count, char **words)
{
    char message[GM_MESSAGE];
    struct gm_request request;
    struct gm_lane *lane = gm_request_parse(&request, count, words, 1, message)
                               ? gm_request_open_lane(&request, 0, message)
                               : NULL;
    gm_request_close(&request);
    return lane;
}

/* A lane with compiled loops for single runs, or for ensembles. */
static struct gm_lane *native_lane(const char *scheme, size_t m)
{
    char by[64], members[32];
    char *words[] = {
        "system", "H=(p1^2 + p2^2)/2 - 1/sqrt(q1^2 + q2^2)", "q1=0.5", "q2=0", "p1=0", "p2=sqrt(3)", by,
        members};
    snprintf(by, sizeof by, "scheme=%s", scheme);
    snprintf(members, sizeof members, "members=%d", m == 1 ? 1 : 8);
    return open_lane(GM_COUNT(words), words);
}

/* `lane` is one with the same problem; NULL: there is none. */
static void against_kernel(struct gm_problem formula, struct gm_problem kernel, const struct gm_lane *lane,
                           const double *state, const char *name, size_t m, long steps)
{
    const struct gm_scheme *scheme = gm_scheme_find(name);
    struct gm_problem compiled = lane ? lane->problem : formula;
    double *start = malloc(kernel.n * m * sizeof *start), own[ROUNDS], hand[ROUNDS], ratio[ROUNDS],
           native[ROUNDS], native_ratio[ROUNDS];
    formula.m = kernel.m = compiled.m = m;
    for (size_t i = 0; start && i < kernel.n * m; i++) {
        start[i] = state[i / m] * (1 + 1e-3 * (double)(i % m) / (double)m);
    }
    for (int round = 0; start && round < ROUNDS; round++) {
        own[round] = step_of(&formula, scheme, start, steps);
        native[round] = lane ? step_of(&compiled, scheme, start, steps) : NAN;
        hand[round] = step_of(&kernel, scheme, start, steps);
        ratio[round] = own[round] / hand[round];
        native_ratio[round] = native[round] / hand[round];
    }
    if (start) {
        printf("%-22s %6zu members  %8.2f ns, by hand %8.2f, ratio %.2f", name, m, median(own, ROUNDS),
               median(hand, ROUNDS), median(ratio, ROUNDS));
        if (lane) {
            printf("; %s %8.2f, ratio %.2f", gm_engine_of(lane), median(native, ROUNDS),
                   median(native_ratio, ROUNDS));
        }
        printf("\n");
    }
    free(start);
}

/* ---- a hundred bodies in the plane that attract each other ---- */

enum { BODIES = 100 };

static const char bodies[] =
    "coordinates: x[1..100] y[1..100]\nmomenta: u[1..100] v[1..100]\n"
    "H: sum(i = 1 .. 100, (u[i]^2 + v[i]^2)/2)\n"
    "   - sum(i = 1 .. 100, j = i+1 .. 100, 1/sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2 + 0.01))/100\n"
    "start: x[i] = sin(i), y[i] = cos(1.7*i), u[i] = 0.3*cos(i), v[i] = 0.2*sin(3*i)\n";

static void velocity(const struct gm_problem *problem, const double *y, double *v, size_t m)
{
    (void)problem;
    memcpy(v, y + 2 * BODIES * m, 2 * BODIES * m * sizeof *v);
}

/* of one member */
static void force(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    (void)problem;
    (void)m;
    memset(f, 0, 2 * BODIES * sizeof *f);
    for (size_t i = 0; i < BODIES; i++) {
        for (size_t j = i + 1; j < BODIES; j++) {
            const double dx = y[i] - y[j], dy = y[BODIES + i] - y[BODIES + j],
                         square = dx * dx + dy * dy + 0.01, weight = 0.01 / (square * sqrt(square));
            f[i] -= weight * dx;
            f[j] += weight * dx;
            f[BODIES + i] -= weight * dy;
            f[BODIES + j] += weight * dy;
        }
    }
}

static void field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    velocity(problem, y, f, m);
    force(problem, y, f + 2 * BODIES, m);
}

static void against_bodies_by_hand(void)
{
    static const struct gm_loops loops = {.field = field, .velocity = velocity, .force = force};
    static const struct gm_split split = {.nystrom = true, .unit_mass = true};
    static const struct gm_ode ode = {.split = &split, .loops = {&loops, &loops, &loops}};
    static const char *const schemes[] = {"verlet", "rk4", "midpoint", "gauss4"};
    const struct gm_problem by_hand = {
        .name = "bodies", .kind = &gm_kind_ode, .n = 4 * BODIES, .m = 1, .facets = &ode};
    struct gm_user_system system;
    struct gm_user_model model = {0};
    struct gm_problem problem = {0};
    struct gm_fault fault;
    const double before = seconds();
    double *start = NULL;
    if (gm_equations_open(&system, bodies, sizeof bodies - 1, NULL, 0, &fault) &&
        (start = gm_equations_start(&system, NULL)) && gm_user_model_open(&model, &system) &&
        gm_user_problem_open(&problem, &model, start)) {
        printf("a hundred bodies: %u nodes, read, derived and made a problem in %.3f s\n", system.graph.count,
               seconds() - before);
        for (size_t i = 0; i < GM_COUNT(schemes); i++) {
            against_kernel(problem, by_hand, NULL, start, schemes[i], 1, 20);
        }
    }
    gm_user_problem_close(&problem);
    gm_system_close(&system);
    free(start);
}

/* ---- a double pendulum of equal masses and rods: implicit, with functions of the library ---- */

static void pendulum_field(const double *y, double *f)
{
    const double g = 9.81, s = sin(y[0] - y[1]), c = cos(y[0] - y[1]), over = 1 / (1 + s * s), a = y[2],
                 b = y[3];
    const double twist = over * s * (a * b - over * c * (a * a + 2 * b * b - 2 * a * b * c));
    f[0] = over * (a - b * c);
    f[1] = over * (2 * b - a * c);
    f[2] = -twist - 2 * g * sin(y[0]);
    f[3] = twist - g * sin(y[1]);
}

/* Gauss's method of order 4 by fixed-point iteration to round-off. */
static void pendulum_gauss4(double *y, double h, long steps)
{
    const double root = sqrt(3) / 6, a[2][2] = {{h / 4, h * (0.25 - root)}, {h * (0.25 + root), h / 4}};
    for (long step = 0; step < steps; step++) {
        double z[2][4] = {{0}}, f[2][4], before = INFINITY, change = 1e300;
        for (int k = 0; k < 100 && change > 0 && (change < before || change > 1e-13); k++) {
            before = change;
            change = 0;
            for (int i = 0; i < 2; i++) {
                double at[4];
                for (int c = 0; c < 4; c++) {
                    at[c] = y[c] + z[i][c];
                }
                pendulum_field(at, f[i]);
            }
            for (int i = 0; i < 2; i++) {
                for (int c = 0; c < 4; c++) {
                    const double next = a[i][0] * f[0][c] + a[i][1] * f[1][c];
                    change += fabs(next - z[i][c]);
                    z[i][c] = next;
                }
            }
        }
        for (int c = 0; c < 4; c++) {
            y[c] += h / 2 * (f[0][c] + f[1][c]);
        }
    }
}

static int gsl_field(double t, const double y[], double f[], void *data)
{
    (void)t;
    (void)data;
    pendulum_field(y, f);
    return GSL_SUCCESS;
}

/* by differences: GSL's Newton asks once a step */
static int gsl_jacobian(double t, const double y[], double *dfdy, double dfdt[], void *data)
{
    (void)t;
    (void)data;
    for (int k = 0; k < 4; k++) {
        double at[4], plus[4], minus[4];
        memcpy(at, y, sizeof at);
        at[k] = y[k] + 1e-6;
        pendulum_field(at, plus);
        at[k] = y[k] - 1e-6;
        pendulum_field(at, minus);
        for (int i = 0; i < 4; i++) {
            dfdy[4 * i + k] = (plus[i] - minus[i]) / 2e-6;
        }
        dfdt[k] = 0;
    }
    return GSL_SUCCESS;
}

static double gsl_step_of(const gsl_odeiv2_step_type *type, const double *start, double h, long steps)
{
    gsl_odeiv2_system system = {gsl_field, gsl_jacobian, 4, NULL};
    gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(&system, type, h, 1e-14, 1e-14);
    double y[4], error[4];
    memcpy(y, start, sizeof y);
    const double before = seconds();
    for (long i = 0; i < steps; i++) {
        gsl_odeiv2_step_apply(driver->s, 0, h, y, error, NULL, NULL, &system);
    }
    const double took = 1e9 * (seconds() - before) / (double)steps;
    gsl_odeiv2_driver_free(driver);
    return took;
}

static void against_pendulum_by_hand(void)
{
    enum { STEPS = 2000 };
    static const double start[] = {2, 2.5, 0, 0};
    char *words[] = {"double-pendulum", "scheme=gauss4", "dt=0.01"};
    struct gm_lane *lane = open_lane(3, words);
    double native[ROUNDS], hand[ROUNDS], gsl2[ROUNDS], gsl4[ROUNDS], ratio[ROUNDS];
    for (int round = 0; lane && round < ROUNDS; round++) {
        double y[4];
        native[round] = step_of(&lane->problem, lane->scheme, start, STEPS);
        memcpy(y, start, sizeof y);
        const double before = seconds();
        pendulum_gauss4(y, 0.01, STEPS);
        hand[round] = 1e9 * (seconds() - before) / STEPS;
        gsl2[round] = gsl_step_of(gsl_odeiv2_step_rk2imp, start, 0.01, STEPS);
        gsl4[round] = gsl_step_of(gsl_odeiv2_step_rk4imp, start, 0.01, STEPS);
        ratio[round] = native[round] / hand[round];
    }
    if (lane) {
        printf(
            "double pendulum, gauss4: %s %.0f ns, by hand %.0f, ratio %.2f; GSL rk2imp %.0f, rk4imp %.0f\n",
            gm_engine_of(lane), median(native, ROUNDS), median(hand, ROUNDS), median(ratio, ROUNDS),
            median(gsl2, ROUNDS), median(gsl4, ROUNDS));
    }
    gm_lane_close(lane);
}

/* ---- two springs, one on either side ---- */

static void springs_force(const double y[2], double f[2])
{
    f[0] = y[1];
    f[1] = -(y[0] > 0 ? 4 : 1) * y[0];
}

static void springs_rk4(double y[2], double h, long steps)
{
    for (long step = 0; step < steps; step++) {
        double k[4][2], at[2];
        springs_force(y, k[0]);
        for (int s = 1; s < 4; s++) {
            for (int c = 0; c < 2; c++) {
                at[c] = y[c] + (s < 3 ? h / 2 : h) * k[s - 1][c];
            }
            springs_force(at, k[s]);
        }
        for (int c = 0; c < 2; c++) {
            y[c] += h / 6 * (k[0][c] + 2 * k[1][c] + 2 * k[2][c] + k[3][c]);
        }
    }
}

/* if() compiled, beside C for it: the ratio is to be 1.1 at most. */
static void against_springs_by_hand(void)
{
    enum { STEPS = 400000 };
    static const double start[] = {0.3, 1};
    char *words[] = {"system", "H=p^2/2 + if(q > 0, 4, 1)*q^2/2", "q=0.3", "p=1", "scheme=rk4", "dt=0.01"};
    struct gm_lane *lane = open_lane(GM_COUNT(words), words);
    double native[ROUNDS], hand[ROUNDS], ratio[ROUNDS];
    for (int round = 0; lane && round < ROUNDS; round++) {
        double y[2];
        native[round] = step_of(&lane->problem, lane->scheme, start, STEPS);
        memcpy(y, start, sizeof y);
        const double before = seconds();
        springs_rk4(y, 0.01, STEPS);
        const double took = 1e9 * (seconds() - before) / STEPS;
        hand[round] = isfinite(y[0]) ? took : NAN; /* y is needed */
        ratio[round] = native[round] / hand[round];
    }
    if (lane) {
        printf("two springs, rk4: %s %.1f ns, by hand %.1f, ratio %.2f\n", gm_engine_of(lane),
               median(native, ROUNDS), median(hand, ROUNDS), median(ratio, ROUNDS));
    }
    gm_lane_close(lane);
}

/* A sum of so many terms, each of which has an angle of its own. */
static void read_large(size_t terms)
{
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) {
        return;
    }
    fprintf(out, "coordinates: a b\nstart: a = 1, b = 2, p_a = 0, p_b = 0\nH: (p_a^2 + p_b^2)/2");
    for (size_t i = 0; i < terms; i++) {
        fprintf(out, " + %zu*sin(a + %zu)*b^2", i + 2, i);
    }
    fprintf(out, "\n");
    fclose(out);
    struct gm_user_system system;
    struct gm_user_model model = {0};
    struct gm_fault fault;
    const double before = seconds();
    const bool good = gm_equations_open(&system, text, size, NULL, 0, &fault);
    const double read = seconds() - before;
    const bool opened = good && gm_user_model_open(&model, &system);
    printf("%u nodes of a formula: read and derived in %.3f s, facts and Jacobian in %.3f s%s\n",
           system.graph.count, read, seconds() - before - read, opened ? "" : " (failed)");
    gm_system_close(&system);
    free(text);
}

/* 200 days of the outer planets: a splitting in Jacobi coordinates beside a compiled scheme of about its error, and the
   flow of one planet. */
static void against_nystrom(void)
{
    enum { STEPS = 20000, PLANETS = 5 };
    char *words[][3] = {{"outer-planets", "scheme=saba2(kepler,interaction)", "dt=200"},
                        {"outer-planets", "scheme=blanes-moan-nystrom6", "dt=100"}};
    struct gm_lane *lanes[] = {open_lane(3, words[0]), open_lane(3, words[1])};
    double took[2][ROUNDS], ratio[ROUNDS], flow[ROUNDS];
    for (size_t round = 0; round < ROUNDS && lanes[0] && lanes[1]; round++) {
        for (long i = 0; i < 2; i++) {
            const double before = seconds();
            gm_run_advance(lanes[i]->run, (i + 1) * STEPS);
            took[i][round] = 1e9 * (seconds() - before) / STEPS;
        }
        ratio[round] = took[0][round] / took[1][round];
        double y[PLANETS][6];
        for (size_t i = 0; i < PLANETS; i++) {
            memcpy(y[i],
                   (const double[6]){5.2 * (double)(i + 1), 0, 0.1, 0, 1.05 / sqrt(5.2 * (double)(i + 1)), 0},
                   sizeof y[i]);
        }
        const double before = seconds();
        for (size_t i = 0; i < PLANETS * STEPS; i++) {
            gm_kepler_flow(3, 1, 1.7, y[i % PLANETS], y[i % PLANETS] + 3);
        }
        flow[round] = 1e9 * (seconds() - before) / (PLANETS * STEPS);
    }
    if (lanes[0] && lanes[1]) {
        printf(
            "outer planets, ns for 200 days: saba2 %.0f; blanes-moan-nystrom6 %s %.0f, ratio %.2f (wanted 0.45)\n",
            median(took[0], ROUNDS), gm_engine_of(lanes[1]), median(took[1], ROUNDS), median(ratio, ROUNDS));
        printf("a Kepler flow, ns: %.0f (wanted 120)\n", median(flow, ROUNDS));
    }
    gm_lane_close(lanes[0]);
    gm_lane_close(lanes[1]);
}

int main(int argc, char *argv[])
{
    const char *source = argc > 1 ? argv[1] : ".";
    gm_engine_choose(GM_ENGINE_NATIVE, source, tell, never);
    if (argc > 2 && strcmp(argv[2], "planets") == 0) {
        against_nystrom();
        return EXIT_SUCCESS;
    }
    static const char *const schemes[] = {"verlet", "yoshida4", "blanes-moan-nystrom6",
                                          "rk4",    "midpoint", "gauss4"};
    struct gm_user_system system;
    struct gm_user_model model = {0};
    struct gm_problem problem = {0};
    struct gm_fault fault;
    double *start = NULL;
    if (gm_equations_open(&system, kepler, sizeof kepler - 1, NULL, 0, &fault) &&
        (start = gm_equations_start(&system, NULL)) && gm_user_model_open(&model, &system) &&
        gm_user_problem_open(&problem, &model, start)) {
        for (size_t i = 0; i < GM_COUNT(schemes); i++) {
            for (size_t m = 1; m <= 10000; m *= 10000) {
                struct gm_lane *lane = native_lane(schemes[i], m);
                struct gm_problem kernel = gm_problem_kepler;
                gm_bench_ensemble(&kernel);
                against_kernel(problem, kernel, lane, start, schemes[i], m, m == 1 ? 30000 : 30);
                gm_lane_close(lane);
            }
        }
    }
    gm_user_problem_close(&problem);
    gm_system_close(&system);
    free(start);
    against_pendulum_by_hand();
    against_springs_by_hand();
    against_bodies_by_hand();
    against_nystrom();
    read_large(10000);
    return EXIT_SUCCESS;
}
