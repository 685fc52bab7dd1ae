/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The speed of the generic core beside loops written by hand, Boost's odeint and GSL, as nanoseconds for a
   step (of one member) and as ratios of one run: the median of rounds in which all take turns. No test:
   nothing fails here. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

#include "core/basics.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/problems/problems.h"
#include "core/ode/user/scheme.h"
#include "core/run.h"
#include "core/schemes.h"
#include "tests/bench/ensembles.h"
#include "tests/bench/ode_by_hand.h"
#include "tests/bench/timing.h"
#include "tests/problems/problems.h"

enum { ROUNDS = 15, MEMBERS = 10000 };

typedef void alone(double *y, double h, long steps);
typedef void together(double *y, size_t m, double h, long steps);

struct line {
    const char *what, *scheme;
    const struct gm_problem *problem;
    const void *parameters;
    double start[12], h;
    size_t m;
    long steps;
    alone *hand, *boost;
    together *ensemble;
    double wanted_ratio, wanted; /* 0: none */
};

static struct gm_run *open_run(const struct gm_problem *problem, const struct line *line, double *y)
{
    for (size_t c = 0; c < problem->n; c++) {
        for (size_t i = 0; i < problem->m; i++) {
            y[c * problem->m + i] = line->start[c] * (1 + 1e-3 * (double)i / (double)problem->m);
        }
    }
    const struct gm_settings settings = {0};
    return gm_run_open(problem, gm_scheme_find_for(line->scheme, problem), &settings, 0, line->h, y);
}

/* The median nanoseconds of a step; NAN: it could not be measured. */
static double measure(const struct line *line)
{
    struct gm_problem problem = *line->problem;
    problem.m = line->m;
    problem.parameters = line->parameters;
    if (problem.m > 1) {
        gm_bench_ensemble(&problem);
    }
    double *y = malloc(problem.n * problem.m * sizeof *y);
    struct gm_run *run = y ? open_run(&problem, line, y) : NULL;
    if (!run) {
        printf("%-34s not enough memory\n", line->what);
        free(y);
        return NAN;
    }
    double core[ROUNDS], hand[ROUNDS], boost[ROUNDS];
    const double unit = 1e-9 * (double)line->steps * (double)line->m;
    for (int round = 0; round < ROUNDS; round++) {
        double start = seconds();
        gm_run_advance(run, line->steps);
        core[round] = (seconds() - start) / unit;
        start = seconds();
        if (line->hand) {
            line->hand(y, line->h, line->steps);
        } else if (line->ensemble) {
            line->ensemble(y, line->m, line->h, line->steps);
        }
        hand[round] = (seconds() - start) / unit;
        start = seconds();
        if (line->boost) {
            line->boost(y, line->h, line->steps);
        }
        boost[round] = (seconds() - start) / unit;
    }
    const double ours = median(core, ROUNDS);
    printf("%-34s %8.2f ns", line->what, ours);
    if (line->wanted > 0) {
        printf(" (at most %g)", line->wanted);
    }
    if (line->hand || line->ensemble) {
        const double theirs = median(hand, ROUNDS);
        printf(", by hand %.2f: ratio %.2f", theirs, ours / theirs);
    }
    if (line->boost) {
        const double theirs = median(boost, ROUNDS);
        printf(", Boost %.2f: ratio %.2f", theirs, ours / theirs);
        if (line->wanted_ratio > 0) {
            printf(" (at most %g)", line->wanted_ratio);
        }
    }
    printf("; %.2f evaluations%s\n", gm_run_per_member(run, run->evaluations) / (double)run->steps,
           run->status == GM_OK ? "" : "  FAILED");
    gm_run_close(run);
    free(y);
    return ours;
}

/* What the midpoint rule keeps, where its equations are solved: the sum of squares. */
static double sum_of_squares(const double *y)
{
    double sum = 0;
    for (int i = 0; i < 8; i++) {
        sum += y[i] * y[i];
    }
    return sum;
}

/* The midpoint rule on four vortices beside SIMD by hand: with the program's own iteration, and with one that is
   shorter. What the sum of squares changed by is said too. */
static void vortices_midpoint(const struct line *line)
{
    struct gm_problem problem = *line->problem;
    problem.parameters = line->parameters;
    double y[8], hand[2][8], taken[3][ROUNDS];
    struct gm_run *run = open_run(&problem, line, y);
    if (!run) {
        return;
    }
    const double squares = sum_of_squares(y);
    memcpy(hand[0], y, sizeof y);
    memcpy(hand[1], y, sizeof y);
    long evaluations[2] = {0};
    const double unit = 1e-9 * (double)line->steps, all = (double)ROUNDS * (double)line->steps;
    for (int round = 0; round < ROUNDS; round++) {
        double start = seconds();
        gm_run_advance(run, line->steps);
        taken[2][round] = (seconds() - start) / unit;
        for (int alike = 0; alike < 2; alike++) {
            start = seconds();
            evaluations[alike] += gm_hand_vortices_midpoint_simd(hand[alike], line->h, line->steps, alike);
            taken[alike][round] = (seconds() - start) / unit;
        }
    }
    const double ours = median(taken[2], ROUNDS);
    printf("%-34s %8.2f ns (at most %g); %.2f evaluations; squares by %.1e\n", line->what, ours, line->wanted,
           (double)run->evaluations / all, sum_of_squares(gm_run_state(run)) - squares);
    for (int alike = 1; alike >= 0; alike--) {
        const double theirs = median(taken[alike], ROUNDS);
        printf("  SIMD by hand, %-19s %8.2f ns: ratio %.2f; %.2f evaluations; squares by %.1e\n",
               alike ? "the same iteration" : "a shorter iteration", theirs, ours / theirs,
               (double)evaluations[alike] / all, sum_of_squares(hand[alike]) - squares);
    }
    gm_run_close(run);
}

/* The oscillator by Verlet in single steps, as a run that is looked at makes them, beside many steps at once
   and beside a plain pass over the same members; with tangent vectors, as the disc has them, which are by hand so
   many members more. */
static void single_steps(size_t m, bool tangent)
{
    const struct line line = {"", "verlet", .start = {0, 1, 1, 0.5}, .h = M_PI / 60, .m = m};
    struct gm_problem problem = tangent ? gm_problem_oscillator_tangent : gm_problem_oscillator;
    problem.m = m;
    if (!tangent) {
        gm_bench_ensemble(&problem);
    }
    double *y = malloc(problem.n * m * sizeof *y);
    struct gm_run *run = y ? open_run(&problem, &line, y) : NULL;
    if (!run) {
        printf("single steps: not enough memory\n");
        free(y);
        return;
    }
    const long steps = m < 100000 ? (long)(4000000 / m) : 40;
    const double unit = 1e-9 * (double)steps * (double)m;
    double single[ROUNDS], at_once[ROUNDS], plain[ROUNDS];
    for (int round = 0; round < ROUNDS; round++) {
        double start = seconds();
        for (long i = 0; i < steps; i++) {
            gm_run_advance(run, 1);
        }
        single[round] = (seconds() - start) / unit;
        start = seconds();
        gm_run_advance(run, steps);
        at_once[round] = (seconds() - start) / unit;
        start = seconds();
        gm_hand_ensemble_oscillator_verlet(y, problem.n / 2 * m, line.h, steps);
        plain[round] = (seconds() - start) / unit;
    }
    const double one = median(single, ROUNDS), many = median(at_once, ROUNDS), pass = median(plain, ROUNDS);
    printf("single steps, %7zu members%s %8.3f ns, many at once %.3f: ratio %.2f, a plain pass %.3f: "
           "ratio %.2f\n",
           m, tangent ? ", disc" : "      ", one, many, one / many, pass, one / pass);
    gm_run_close(run);
    free(y);
}

static int field(double t, const double y[], double f[], void *problem)
{
    (void)t;
    gm_field(problem, y, f, 1);
    return GSL_SUCCESS;
}

static int jacobian(double t, const double y[], double *dfdy, double dfdt[], void *parameters)
{
    (void)t;
    const struct gm_problem *problem = parameters;
    gm_ode_of(problem)->loops[GM_ISA_BASELINE]->jacobian(problem, y, dfdy);
    memset(dfdt, 0, problem->n * sizeof *dfdt);
    return GSL_SUCCESS;
}

/* GSL's implicit midpoint rule on Kepler, at a tolerance near round-off, beside ours. */
static void gsl_midpoint(const double *start, double h, double ours)
{
    struct gm_problem problem = gm_problem_kepler;
    gsl_odeiv2_system system = {field, jacobian, 4, &problem};
    gsl_odeiv2_driver *driver =
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk2imp, h, 1e-14, 1e-14);
    double y[4], error[4];
    memcpy(y, start, sizeof y);
    const long steps = 2000;
    const double before = seconds();
    for (long i = 0; i < steps; i++) {
        gsl_odeiv2_step_apply(driver->s, 0, h, y, error, NULL, NULL, &system);
    }
    const double theirs = (seconds() - before) / 1e-9 / (double)steps;
    printf("%-34s %8.2f ns: %.1f times ours (at least 10)\n", "GSL rk2imp, Kepler", theirs, theirs / ours);
    gsl_odeiv2_driver_free(driver);
}

/* An own step of dopri5, which evaluates the field six times, beside seven evaluations. */
static void dormand_prince(const struct line *line)
{
    enum { EVALUATIONS = 2000000 };
    struct gm_problem problem = *line->problem;
    problem.m = 1;
    problem.parameters = line->parameters;
    double y[12], f[12], ours[ROUNDS], field[ROUNDS];
    struct gm_run *run = open_run(&problem, line, y);
    if (!run) {
        return;
    }
    for (int round = 0; round < ROUNDS; round++) {
        const int64_t before = run->own_steps + run->rejected;
        double start = seconds();
        gm_run_advance(run, line->steps);
        ours[round] = (seconds() - start) / 1e-9 / (double)(run->own_steps + run->rejected - before);
        start = seconds();
        for (int k = 0; k < EVALUATIONS; k++) {
            gm_field(&problem, y, f, 1);
        }
        field[round] = 7 * (seconds() - start) / 1e-9 / EVALUATIONS;
    }
    const double step = median(ours, ROUNDS), seven = median(field, ROUNDS);
    printf("%-34s %8.2f ns, seven evaluations %.2f: ratio %.2f (at most 1.2)%s\n", line->what, step, seven,
           step / seven, run->status == GM_OK ? "" : "  FAILED");
    gm_run_close(run);
}

/* All velocities of 1000 vortices, as ordered pairs a second. */
static void pair_sum(void)
{
    enum { COUNT = 1000, SUMS = 20 };
    static const double strength = 2 * M_PI;
    static double state[2 * COUNT], f[2 * COUNT], by_hand[2 * COUNT];
    struct gm_problem problem = gm_problem_vortices;
    problem.n = 2 * (size_t)COUNT;
    problem.parameters = &strength;
    for (int i = 0; i < COUNT; i++) {
        const double radius = sqrt((i + 0.5) / COUNT), turn = 2.3999632297286533 * i;
        state[i] = radius * cos(turn);
        state[COUNT + i] = radius * sin(turn);
    }
    double core[ROUNDS], hand[ROUNDS], apart = 0;
    const double pairs = (double)SUMS * COUNT * (COUNT - 1);
    for (int round = 0; round < ROUNDS; round++) {
        double start = seconds();
        for (int k = 0; k < SUMS; k++) {
            gm_field(&problem, state, f, 1);
        }
        core[round] = pairs / (seconds() - start);
        start = seconds();
        for (int k = 0; k < SUMS; k++) {
            gm_hand_pair_sum(state, by_hand, COUNT);
        }
        hand[round] = pairs / (seconds() - start);
    }
    for (int i = 0; i < 2 * COUNT; i++) {
        apart = fmax(apart, fabs(f[i] - by_hand[i]));
    }
    const double ours = median(core, ROUNDS), theirs = median(hand, ROUNDS);
    printf("%-34s %8.2e a second, by hand %.2e: ratio %.2f (at least 0.9); apart by %.1e\n",
           "pairs of 1000 vortices", ours, theirs, ours / theirs, apart);
}

/* All velocities of a disc of vortices by moments of cells, against pair by pair. */
static void by_moments(double tolerance)
{
    static const size_t counts[] = {1000, 2000, 4000, 10000, 100000};
    const double parameters[] = {2 * M_PI, tolerance};
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++) {
        const size_t count = counts[c];
        const bool pairs = count <= 10000;
        double *state = malloc(4 * count * sizeof *state), *f = state + 2 * count;
        if (!state) {
            return;
        }
        for (size_t i = 0; i < count; i++) {
            const double radius = sqrt(((double)i + 0.5) / (double)count),
                         turn = 2.3999632297286533 * (double)i;
            state[i] = radius * cos(turn);
            state[count + i] = radius * sin(turn);
        }
        struct gm_problem problems[] = {gm_problem_vortices_multipole, gm_problem_vortices};
        double taken[2][ROUNDS] = {{0}};
        for (int round = 0; round < ROUNDS; round++) {
            for (int k = 0; k < (pairs ? 2 : 1); k++) {
                problems[k].n = 2 * count;
                problems[k].parameters = parameters;
                const double start = seconds();
                gm_field(&problems[k], state, f, 1);
                taken[k][round] = seconds() - start;
            }
        }
        const double ours = median(taken[0], ROUNDS), theirs = median(taken[1], ROUNDS);
        printf("%zu vortices within %g: %.3g ms", count, tolerance, 1e3 * ours);
        if (pairs) {
            printf(", pair by pair %.3g: %.2f\n", 1e3 * theirs, theirs / ours);
        } else {
            printf(", %.1f steps of rk4 a second (at least 5)\n", 1 / (4 * ours));
        }
        free(state);
    }
}

/* Kepler's orbit from its nearest point. */
static void nearest_point(double eccentricity, double y[4])
{
    y[0] = 1 - eccentricity;
    y[1] = y[2] = 0;
    y[3] = sqrt((1 + eccentricity) / (1 - eccentricity));
}

/* The distance of y from the exact position after the time t. */
static double distance(double eccentricity, double t, const double *y)
{
    double start[4], exact[4];
    nearest_point(eccentricity, start);
    gm_problem_kepler.exact->solution(&gm_problem_kepler, t, start, exact, 1);
    return hypot(y[0] - exact[0], y[1] - exact[1]);
}

/* A way to the end of 100 periods: ours with so many steps a period, theirs with a tolerance of 1 / steps. The
   distance from the exact position there; *spent: the time it took. */
struct way {
    const char *scheme; /* NULL: not ours */
    double (*theirs)(double eccentricity, double tolerance, double *spent);
};

static double by_scheme(const char *scheme, double eccentricity, double steps, double *spent)
{
    const struct gm_scheme *row = gm_scheme_find_for(scheme, &gm_problem_kepler);
    const struct gm_settings settings = {0};
    double start[4];
    nearest_point(eccentricity, start);
    struct gm_run *run = gm_run_open(&gm_problem_kepler, row, &settings, 0, 2 * M_PI / steps, start);
    if (!run) {
        return INFINITY;
    }
    const double before = seconds();
    const bool good = gm_run_until(run, 200 * M_PI) == GM_OK;
    *spent = seconds() - before;
    const double error = good ? distance(eccentricity, run->t, gm_run_state(run)) : INFINITY;
    gm_run_close(run);
    return error;
}

/* The same by GSL's Prince-Dormand stepper, which chooses its steps. */
static double by_gsl(double eccentricity, double tolerance, double *spent)
{
    struct gm_problem problem = gm_problem_kepler;
    gsl_odeiv2_system system = {field, NULL, 4, &problem};
    gsl_odeiv2_driver *driver =
        gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, 1e-2, tolerance, tolerance);
    double y[4], t = 0;
    nearest_point(eccentricity, y);
    const double before = seconds();
    const bool good = gsl_odeiv2_driver_apply(driver, &t, 200 * M_PI, y) == GSL_SUCCESS;
    *spent = seconds() - before;
    gsl_odeiv2_driver_free(driver);
    return good ? distance(eccentricity, t, y) : INFINITY;
}

#ifdef GM_HAVE_BOOST
static double by_boost(double eccentricity, double tolerance, double *spent)
{
    double y[4];
    nearest_point(eccentricity, y);
    const double before = seconds();
    gm_boost_kepler_rkf78(y, 200 * M_PI, tolerance);
    *spent = seconds() - before;
    return distance(eccentricity, 200 * M_PI, y);
}
#endif

static double go(const struct way *way, double eccentricity, double steps, double *spent)
{
    return way->scheme ? by_scheme(way->scheme, eccentricity, steps, spent)
                       : way->theirs(eccentricity, 1 / steps, spent);
}

/* A position right to 1e-8 after 100 periods: each with the fewest steps, or the loosest tolerance, that
   reaches it. */
static void kepler_to_eight_digits(double eccentricity)
{
    static const struct {
        const char *what;
        struct way way;
    } lines[] = {
        {"gauss8", {.scheme = "gauss8"}},
        {"kahan-li8", {.scheme = "kahan-li8"}},
        {"blanes-moan-nystrom6", {.scheme = "blanes-moan-nystrom6"}},
        {"controlled-blanes-moan-nystrom6", {.scheme = "controlled-blanes-moan-nystrom6"}},
        {"controlled-kahan-li8", {.scheme = "controlled-kahan-li8"}},
        {"logh-kahan-li8", {.scheme = "logh-kahan-li8"}},
        {"logh-sofroniou-spaletta10", {.scheme = "logh-sofroniou-spaletta10"}},
        {"poincare-gauss8", {.scheme = "poincare-gauss8"}},
        {"GSL rk8pd", {.theirs = by_gsl}},
#ifdef GM_HAVE_BOOST
        {"Boost rkf78", {.theirs = by_boost}},
#endif
    };
    printf("Kepler to 1e-8 after 100 periods, e = %g\n", eccentricity);
    for (size_t i = 0; i < GM_COUNT(lines); i++) {
        const struct way *way = &lines[i].way;
        double steps = way->scheme ? 5 : 1e8, took[ROUNDS], spent, error;
        const double most = way->scheme ? 1e6 : 1e15;
        while ((error = go(way, eccentricity, steps, &spent)) > 1e-8 && steps < most) {
            steps = ceil(steps * (way->scheme ? 1.05 : 1.5));
        }
        for (int round = 0; round < ROUNDS; round++) {
            go(way, eccentricity, steps, &took[round]);
        }
        printf("  %-32s %8.2f ms, error %.1e with %s %.3g\n", lines[i].what, 1e3 * median(took, ROUNDS),
               error, way->scheme ? "steps a period" : "the tolerance", way->scheme ? steps : 1 / steps);
    }
}

static const double strength = GM_HAND_STRENGTH, omega = 50;
#define KEPLER .problem = &gm_problem_kepler, .start = {0.5, 0, 0, 1.7320508075688772}, .h = 2 * M_PI / 100
#define SQUARE                                                                                               \
    .problem = &gm_problem_vortices_four, .parameters = &strength, .start = {1, 0.1, -1, 0, 0, 1, 0, -1},    \
    .h = 0.05

static void adaptive_steps(void)
{
    const struct line adaptive[] = {
        {"Kepler, dopri5", "dopri5", KEPLER, .m = 1, .steps = 40000},
        {"pendulum, dopri5", "dopri5", .problem = &gm_problem_pendulum, .start = {1, 0.5}, .h = 1,
         .steps = 40000},
        {"4 vortices, dopri5", "dopri5", SQUARE, .m = 1, .steps = 100000},
        {"6 springs, dopri5", "dopri5", .problem = &gm_problem_fpu, .parameters = &omega,
         .start = {1, 0, 0, 0.02, 0, 0, 1, 0, 0, 1, 0, 0}, .h = 0.05, .steps = 20000},
    };
    for (size_t i = 0; i < GM_COUNT(adaptive); i++) {
        dormand_prince(&adaptive[i]);
    }
}

static bool bring(const char *word)
{
    struct gm_fault fault;
    const struct gm_user_scheme_source source = {.text = word, .length = strlen(word), .name = word};
    const struct gm_scheme *scheme = gm_user_scheme_open(&source, &fault);
    return scheme && gm_scheme_bring(scheme);
}

/* A scheme that holds the energy beside its base. */
static void held(const char *base, const char *word)
{
    struct line lines[] = {{base, base, KEPLER, .m = 1, .steps = 200000},
                           {word, word, KEPLER, .m = 1, .steps = 200000}};
    const double taken = bring(word) ? measure(&lines[0]) : 0;
    if (taken > 0) {
        printf("  ratio to %s %.2f, at most 6\n", base, measure(&lines[1]) / taken);
    }
}

/* A composition of two schemes in turns beside half a step of each; `steps` for a period. */
static void in_turns(const char *first, const char *second, double steps, size_t m)
{
    char word[100];
    snprintf(word, sizeof word, "composition(%s, %s; 1/2, 1/2)", first, second);
    if (!bring(word)) {
        return;
    }
    struct line lines[] = {{first, first, KEPLER}, {second, second, KEPLER}, {word, word, KEPLER}};
    double taken[GM_COUNT(lines)];
    for (size_t i = 0; i < GM_COUNT(lines); i++) {
        lines[i].m = m;
        lines[i].steps = 100000 / (long)m;
        lines[i].h = 2 * M_PI / (lines[i].scheme == word ? steps : 2 * steps);
        taken[i] = measure(&lines[i]);
    }
    printf("  %zu members: ratio to its parts %.2f\n", m, taken[2] / (taken[0] + taken[1]));
}

static void compositions(void)
{
    static const struct {
        const char *first, *second;
        double steps;
    } pairs[] = {
        {"explicit-euler", "explicit-euler",
         1e5}, /* none of Euler's methods leaves the orbit in these runs */
        {"explicit-euler", "implicit-euler", 1e5},
        {"rk4", "rk4", 100},
        {"rk4", "midpoint", 100},
        {"midpoint", "gauss4", 100},
        {"rk4", "verlet", 100},
    };
    for (size_t i = 0; i < GM_COUNT(pairs); i++) {
        in_turns(pairs[i].first, pairs[i].second, pairs[i].steps, 1);
        in_turns(pairs[i].first, pairs[i].second, pairs[i].steps, 1000);
    }
}

/* With the word "single": single steps of ensembles alone; "adaptive": dopri5 alone; "turns": compositions alone. */
int main(int argc, char *argv[])
{
    printf("instruction set: %s\n", gm_isa_name(gm_isa_best()));
    if (argc > 1 && strcmp(argv[1], "adaptive") == 0) {
        adaptive_steps();
        return 0;
    }
    if (argc > 1 && strcmp(argv[1], "turns") == 0) {
        compositions();
        held("rk4", "projected(rk4; H)");
        held("rk4", "relaxed(rk4; H)");
        return 0;
    }
    for (size_t m = 1000; m <= 1000000; m *= 10) {
        single_steps(m, false);
        single_steps(m, true);
    }
    if (argc > 1 && strcmp(argv[1], "single") == 0) {
        return 0;
    }
#define OSCILLATOR .problem = &gm_problem_oscillator, .start = {0, 1}, .h = M_PI / 60, .m = MEMBERS
#ifdef GM_HAVE_BOOST
#define BOOST(function) .boost = function
#else
#define BOOST(function) .boost = NULL
#endif
    const struct line lines[] = {
        {"Kepler, Verlet", "verlet", KEPLER, .m = 1, .steps = 400000, .hand = gm_hand_kepler_verlet,
         BOOST(gm_boost_kepler_verlet), .wanted_ratio = 1.15},
        {"Kepler, RK4", "rk4", KEPLER, .m = 1, .steps = 200000, .hand = gm_hand_kepler_rk4,
         BOOST(gm_boost_kepler_rk4), .wanted_ratio = 1.15},
        {"4 vortices, RK4", "rk4", SQUARE, .m = 1, .steps = 100000, .hand = gm_hand_vortices_rk4,
         BOOST(gm_boost_vortices_rk4), .wanted_ratio = 1.1},
        {"Kepler, midpoint", "midpoint", KEPLER, .m = 1, .steps = 50000, .wanted = 120},
        {"4 vortices, RK4, SIMD by hand", "rk4", SQUARE, .m = 1, .steps = 100000,
         .hand = gm_hand_vortices_rk4_simd},
        {"Kepler, Kahan-Li 8", "kahan-li8", KEPLER, .m = 1, .steps = 20000},
        {"ensemble, oscillator, Verlet", "verlet", OSCILLATOR, .steps = 200,
         .ensemble = gm_hand_ensemble_oscillator_verlet, .wanted = 0.4},
        {"ensemble, oscillator, RK4", "rk4", OSCILLATOR, .steps = 100,
         .ensemble = gm_hand_ensemble_oscillator_rk4, .wanted = 0.8},
        {"ensemble, Kepler, Verlet", "verlet", KEPLER, .m = MEMBERS, .steps = 50,
         .ensemble = gm_hand_ensemble_kepler_verlet, .wanted = 2.2},
        {"ensemble, Kepler, RK4", "rk4", KEPLER, .m = MEMBERS, .steps = 50},
    };
    double midpoint = NAN;
    for (size_t i = 0; i < GM_COUNT(lines); i++) {
        const double ours = measure(&lines[i]);
        midpoint = lines[i].problem == &gm_problem_kepler && strcmp(lines[i].scheme, "midpoint") == 0
                       ? ours
                       : midpoint;
    }
    vortices_midpoint(
        &(struct line){"4 vortices, midpoint", "midpoint", SQUARE, .m = 1, .steps = 20000, .wanted = 200});
    adaptive_steps();
    compositions();
    gsl_midpoint((const double[]){0.5, 0, 0, 1.7320508075688772}, 2 * M_PI / 100, midpoint);
    pair_sum();
    by_moments(1e-3);
    by_moments(1e-6);
    by_moments(1e-9);
    kepler_to_eight_digits(0.5);
    kepler_to_eight_digits(0.9);
    return 0;
}
