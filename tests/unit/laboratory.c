/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Scenes for ordinary differential equations: sections, angles, bounded memory, refusals; linear stability;
   the prices and verdicts of work-precision and stability. */
#include <fcntl.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "app/base/interrupt.h"
#include "app/commands/commands.h"
#include "app/grid/grid.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/flow/flow.h"
#include "core/ode/certify/linear_stability.h"
#include "core/schemes.h"
#include "tests/common/laboratory.h"

static const struct gm_entries *track(const struct gm_trial *trial, const char *key)
{
    const struct gm_scene *scene = trial->request.scene;
    for (size_t i = 0; i < scene->track_count; i++) {
        if (strcmp(scene->tracks[i].key, key) == 0) {
            return &trial->drive.lane->entries[i];
        }
    }
    fail_msg("%s has no track %s", scene->name, key);
    return NULL;
}

/* What is written of an error is whole, and the exact motion keeps only errors. */
static void observables_say_what_they_are(void **unused)
{
    (void)unused;
    for (size_t s = 0; s < gm_scene_count(); s++) {
        const struct gm_scene *scene = gm_scene_at(s);
        assert_non_null(scene->time);
        for (size_t i = 0; i < scene->observable_count; i++) {
            const struct gm_observable *observable = &scene->observables[i];
            assert_true(observable->error == (observable->symbol != NULL));
            assert_true((observable->scale || observable->least > 0) == (observable->scale_text != NULL));
            assert_true(observable->error || (!observable->scale && !observable->kept));
        }
    }
}

/* Crossings of the section agree with those found with steps ten times as short, to the order of the
 * interpolation. */
static void sections_are_interpolated(void **unused)
{
    (void)unused;
    struct gm_trial coarse, fine;
    gm_trial_run(&coarse, "henon-heiles scheme=gauss8 dt=.1 until=200", false);
    gm_trial_run(&fine, "henon-heiles scheme=gauss8 dt=.01 until=200", false);
    const struct gm_entries *some = track(&coarse, "section"), *same = track(&fine, "section");
    assert_true(some->count > 25);
    assert_int_equal(some->count, same->count);
    for (size_t i = 0; i < some->count; i++) {
        assert_true(fabs(some->times[i] - same->times[i]) < 1e-6);
        assert_true(fabs(some->values[2 * i] - same->values[2 * i]) < 1e-6);
        assert_true(fabs(some->values[2 * i + 1] - same->values[2 * i + 1]) < 1e-6);
    }
    gm_trial_close(&coarse);
    gm_trial_close(&fine);
}

/* A lane that went back and on again has the crossings of one that did not, or at most one less. */
static void sections_survive_stepping_back(void **unused)
{
    (void)unused;
    struct gm_trial straight, bent;
    gm_trial_run(&straight, "henon-heiles scheme=verlet dt=.1 until=200", false);
    gm_trial_run(&bent, "henon-heiles scheme=verlet dt=.1 until=100", false);
    struct gm_lane *lane = bent.drive.lane;
    void *snapshot = malloc(gm_run_snapshot_size(lane->run));
    gm_run_save(lane->run, snapshot);
    gm_lane_to(lane, lane->run->steps + 500, INFINITY);
    gm_lane_load(lane, snapshot);
    gm_lane_to(lane, lane->run->steps + 1000, INFINITY);
    free(snapshot);
    const struct gm_entries *first = track(&straight, "section"), *second = track(&bent, "section");
    assert_memory_equal(gm_run_state(straight.drive.lane->run), gm_run_state(lane->run), 4 * sizeof(double));
    assert_true(first->count - second->count <= 1);
    assert_true(first->times[first->count - 1] == second->times[second->count - 1]);
    gm_trial_close(&straight);
    gm_trial_close(&bent);
}

/* The axis of a coarse Verlet orbit turns more than once; the angle printed says so, looked at or not. */
static void angles_are_unwrapped(void **unused)
{
    (void)unused;
    struct gm_trial unseen, seen;
    gm_trial_run(&unseen, "kepler scheme=verlet dt=2*pi/60 until=400*pi", false);
    gm_trial_run(&seen, "kepler scheme=verlet dt=2*pi/60 until=400*pi", true);
    assert_true(gm_trial_end(&unseen, "lrl_angle") < -2 * M_PI);
    assert_true(fabs(gm_trial_end(&unseen, "lrl_angle") - gm_trial_end(&seen, "lrl_angle")) < 1e-12);
    gm_trial_close(&unseen);
    gm_trial_close(&seen);
}

static void memory_is_bounded(void **unused)
{
    (void)unused;
    static const char *const words[] = {"kepler scheme=verlet steps=0",
                                        "vortices scheme=rk2 steps=0 strength=1",
                                        "henon-heiles scheme=verlet steps=0"};
    for (size_t k = 0; k < GM_COUNT(words); k++) {
        struct gm_trial trial;
        gm_trial_run(&trial, words[k], false);
        struct gm_lane *lane = trial.drive.lane;
        for (long i = 0; i < 60000; i++) {
            gm_run_advance(lane->run, 1);
            gm_lane_record(lane);
        }
        assert_true(lane->history.count <= GM_HISTORY_BINS);
        for (size_t i = 0; i < lane->scene->track_count; i++) {
            assert_true(lane->entries[i].count <= lane->scene->tracks[i].bound);
        }
        gm_trial_close(&trial);
    }
}

/* Looking changes nothing, and tracers change no vortex. */
static void looking_changes_nothing(void **unused)
{
    (void)unused;
    struct gm_trial unseen, seen;
    gm_trial_run(&unseen, "vortices scheme=rk4sym steps=500 tracers=100 strength=5", false);
    gm_trial_run(&seen, "vortices scheme=rk4sym steps=500 tracers=100 strength=5", true);
    assert_memory_equal(gm_run_state(unseen.drive.lane->run), gm_run_state(seen.drive.lane->run),
                        4 * sizeof(double));
    gm_trial_close(&seen);
    gm_trial_run(&seen, "vortices scheme=rk4sym steps=500 strength=5", false);
    for (size_t i = 0; i < 4; i++) {
        assert_true(fabs(gm_run_state(unseen.drive.lane->run)[i] - gm_run_state(seen.drive.lane->run)[i]) <
                    1e-10);
    }
    gm_trial_close(&unseen);
    gm_trial_close(&seen);
}

static void refusals(void **unused)
{
    (void)unused;
    static const struct {
        const char *words, *part;
    } rows[] = {
        {"kepler eccentricity=1", "out of range"},
        {"kepler eccentricity=1.5", "out of range"},
        {"kepler q1=1", "q1"},
        {"henon-heiles p1=1", "p1"},
        {"vortices strength=0", "strength"},
        {"vortices configuration=collision distance=0", "coincide"},
        {"vortices configuration=two-turned angle=pi/2", "coincide"},
        {"vortices configuration=reduced angle=-pi/2", "coincide"},
        {"vortices configuration=one-turned angle=pi/2", "coincide"},
        {"vortices configuration=two-turned count=5", "four vortices"},
        {"vortices scheme=verlet", "does not fit"},
        {"vortices scheme=gsl-msbdf configuration=square count=5", "does not fit"},
        {"vortices configuration=random count=20000", "without multipole"},
        {"vortices configuration=random multipole=1e-16", "round-off"},
        {"vortices multipole=1e-9", "four vortices"},
        {"vortices tracers=10 scheme=avf2", "does not fit"},
        {"henon-heiles q2=.9 p2=.5", "no orbit"},
        {"abc scheme=impulse2", "does not fit"},
    };
    char message[GM_MESSAGE];
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        if (!strstr(gm_trial_refusal(rows[i].words, message), rows[i].part)) {
            fail_msg("%s: \"%s\" says nothing of \"%s\"", rows[i].words, message, rows[i].part);
        }
    }
    assert_string_equal(gm_trial_refusal("kepler eccentricity=.5 dt=100", message), "");
}

/* A step longer than an orbit: an honest status, or numbers that say how bad it is. */
/* Chains of every length: force and energy agree, and so do two schemes that share neither force nor start of
   the iteration. */
static void chains_of_every_length(void **unused)
{
    (void)unused;
    for (int springs = 1; springs <= 5; springs++) {
        char words[200];
        double ends[2][20];
        for (int k = 0; k < 2; k++) {
            struct gm_trial trial;
            snprintf(words, sizeof words, "stiff springs=%d omega=20 until=2 scheme=%s dt=%s", springs,
                     k ? "impulse2" : "gauss8", k ? "1e-5" : "1e-3");
            gm_trial_run(&trial, words, false);
            assert_int_equal(trial.drive.lane->problem.n, 4 * springs);
            assert_true(gm_trial_end(&trial, "energy_error") < (k ? 1e-7 : 1e-12));
            memcpy(ends[k], gm_run_state(trial.drive.lane->run), (size_t)springs * 4 * sizeof(double));
            gm_trial_close(&trial);
        }
        for (int c = 0; c < 4 * springs; c++) {
            assert_true(fabs(ends[0][c] - ends[1][c]) < 1e-7);
        }
    }
}

/* The near collision comes with a strength and a step, unless they are given. */
static void a_configuration_brings_its_own(void **unused)
{
    (void)unused;
    static const struct {
        const char *words;
        double strength, dt;
    } rows[] = {
        {"vortices configuration=collision steps=0", 2 * M_PI, 0.5 / 800},
        {"vortices configuration=collision strength=3 steps=0", 3, 0.5 / 800},
        {"vortices dt=.001 configuration=collision steps=0", 2 * M_PI, 0.001},
        {"vortices configuration=square steps=0", 150, 5e-3},
        {"vortices steps=0", 150, 5e-3},
    };
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        struct gm_trial trial;
        gm_trial_run(&trial, rows[i].words, false);
        const struct gm_parameter *strength = gm_scene_parameter(trial.request.scene, "strength");
        assert_true(gm_parameter_get(strength, trial.drive.lane->parameters) == rows[i].strength);
        assert_true(trial.drive.lane->run->dt == rows[i].dt);
        gm_trial_close(&trial);
    }
}

static void step_longer_than_an_orbit(void **unused)
{
    (void)unused;
    struct gm_trial trial;
    gm_trial_run(&trial, "kepler scheme=verlet dt=10 until=1000", false);
    assert_true(trial.drive.lane->run->status != GM_OK || gm_trial_end(&trial, "energy_error") > 0.1);
    gm_trial_close(&trial);
    gm_trial_run(&trial, "kepler scheme=gauss4 dt=10 until=1000", false);
    assert_true(trial.drive.lane->run->status == GM_NO_CONVERGENCE ||
                gm_trial_end(&trial, "position_error") > 0.1);
    gm_trial_close(&trial);
}

/* Stability found by stepping is that of the coefficients, for every scheme whose coefficients are known. */
static void linear_stability(void **unused)
{
    (void)unused;
    size_t compared = 0;
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        const enum gm_linear_test test = gm_linear_test_of(scheme);
        for (int k = 0; k < 6; k++) {
            const double re = test == GM_TEST_PLANE ? (const double[]){-0.5, 0, -1, 0.3, -3, 0}[k] : 0;
            const double im = (const double[]){0.7, 1.5, 0.2, 1, 2, 3.7}[k];
            const double known = gm_linear_growth_known(scheme, re, im);
            if (!isfinite(known) || known > 1e6) {
                continue;
            }
            const double measured = gm_linear_growth(scheme, re, im, 1);
            if (!(fabs(measured - known) < 1e-9 * fmax(1, known))) {
                fail_msg("%s at %g + %g i: %.12g measured, %.12g known", scheme->name, re, im, measured,
                         known);
            }
            compared++;
        }
    }
    assert_true(compared > 150);
    /* RK4 leaves the imaginary axis at 2 sqrt 2; Verlet the circle at 2 */
    const struct gm_scheme *rk4 = gm_scheme_find("rk4"), *verlet = gm_scheme_find("verlet");
    assert_true(gm_linear_growth(rk4, 0, 2.828, 1) < 1 && gm_linear_growth(rk4, 0, 2.829, 1) > 1);
    assert_true(gm_linear_growth(verlet, 0, 1.999, 1) < 1 + 1e-9 &&
                gm_linear_growth(verlet, 0, 2.001, 1) > 1.01);
}

/* Where growth begins: the limits that are known in closed form, and 0 where no step is without growth, |R(i
   y)| = 1 + c y^m with c > 0 from the beginning. */
static void linear_limits(void **unused)
{
    (void)unused;
    static const struct {
        const char *scheme;
        double left, up; /* 6: as far as one looks */
    } known[] = {
        {"explicit-euler", 2, 0}, {"rk2", 2, 0},      {"rk4", 2.785293563, 2.8284271247},
        {"implicit-euler", 6, 6}, {"midpoint", 6, 6}, {"trapezoidal", 6, 6},
        {"gauss8", 6, 6},         {"radau5", 6, 6},   {"sdirk2", 6, 6},
    };
    for (size_t i = 0; i < GM_COUNT(known); i++) {
        const struct gm_scheme *scheme = gm_scheme_find(known[i].scheme);
        const double left = gm_linear_limit(scheme, -1, 0, 6, 1), up = gm_linear_limit(scheme, 0, 1, 6, 1);
        if (!(fabs(left - known[i].left) < 1e-3) || !(fabs(up - known[i].up) < 1e-3)) {
            fail_msg("%s: -%.9g and %.9g i", scheme->name, left, up);
        }
    }
    static const struct {
        const char *scheme;
        double limit;
    } oscillator[] = {{"verlet", 2}, {"symplectic-euler", 2}, {"lobatto4", 2.8284271247}, {"avf2", 6}};
    for (size_t i = 0; i < GM_COUNT(oscillator); i++) {
        const double limit = gm_linear_limit(gm_scheme_find(oscillator[i].scheme), 0, 1, 6, 1);
        if (!(fabs(limit - oscillator[i].limit) < 1e-3)) {
            fail_msg("%s: %.9g", oscillator[i].scheme, limit);
        }
    }
    /* every scheme of known coefficients: nothing grows below the limit, and something does beyond it */
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        const struct gm_scheme *scheme = gm_scheme_at(i);
        if (!isfinite(gm_linear_growth_known(scheme, 0, 0.01))) {
            continue;
        }
        const double limit = gm_linear_limit(scheme, 0, 1, 6, 1);
        const double below = gm_linear_growth_known(scheme, 0, 0.99 * limit);
        double beyond = 0; /* a composition may be stable again soon */
        for (int k = 1; k <= 1000; k++) {
            beyond = fmax(beyond, gm_linear_growth_known(scheme, 0, limit + 5e-5 * k));
        }
        if (!(below <= 1 + 1e-7) || (limit < 6 && !(beyond > 1 + 1e-7))) {
            fail_msg("%s: limit %.6g, growth 1 %+.2g below and 1 %+.2g beyond it", scheme->name, limit,
                     below - 1, beyond - 1);
        }
    }
}

/* The binding that the rows of Tao's schemes say stiff springs bear, 1 / (h Omega)^2 and half of it, keeps
   the energy; four times as much loses it. */
static void bindings_of_stiff_springs(void **unused)
{
    (void)unused;
    static const double steps[] = {0.5, 0.25, 0.15};
    for (int k = 0; k < 12; k++) {
        const bool fourth = k % 2, excessive = k / 6;
        const double step = steps[k / 2 % 3], most = (fourth ? 0.5 : 1) / (step * step);
        char words[160];
        struct gm_trial trial;
        snprintf(words, sizeof words, "stiff scheme=tao%d omega=50 dt=%g binding=%g until=40", fourth ? 4 : 2,
                 step / 50, excessive ? 4 * most : most);
        gm_trial_run(&trial, words, true);
        const bool kept =
            trial.drive.lane->run->status == GM_OK && gm_trial_max(&trial, "energy_error") < 0.2;
        if (kept == excessive) {
            fail_msg("%s: the energy is %s", words, kept ? "kept" : "lost");
        }
        gm_trial_close(&trial);
    }
}

static void prices(void **unused)
{
    (void)unused;
    struct gm_grid_cell points[] = {
        {.error = 1e-2, .seconds = 1e-3, .evaluations = 10},
        {.error = 1e-4, .seconds = 4e-3, .evaluations = 40},
        {.error = NAN, .seconds = 8e-3, .evaluations = 80},
        {.error = 1e-8, .seconds = 16e-3, .evaluations = 160},
    };
    const struct gm_grid_line line = {.cells = points, .count = 4};
    assert_true(fabs(gm_work_price(&line, 1e-3, GM_COST_SECONDS) - 2e-3) < 1e-15);
    assert_true(fabs(gm_work_price(&line, 1e-3, GM_COST_EVALUATIONS) - 20) < 1e-11);
    assert_true(gm_work_price(&line, 1e-1, GM_COST_SECONDS) == 1e-3);
    assert_true(gm_work_price(&line, 1e-6, GM_COST_SECONDS) == 16e-3); /* nothing is known in between */
    assert_true(isnan(gm_work_price(&line, 1e-9, GM_COST_SECONDS)));
    struct gm_grid_cell better[] = {{.error = 1e-5, .seconds = 3e-3, .evaluations = 100}};
    struct gm_grid_line lines[] = {line, {.cells = better, .count = 1}};
    const struct gm_grid table = {.lines = lines, .count = 2, .begun = 2};
    assert_ptr_equal(gm_work_cheapest(&table, 1e-3, GM_COST_SECONDS), &lines[0]);
    assert_ptr_equal(gm_work_cheapest(&table, 1e-5, GM_COST_SECONDS), &lines[1]);
    assert_null(gm_work_cheapest(&table, 1e-12, GM_COST_SECONDS));
}

/* How often a flow was set up: the linker sends all calls of gm_flow_open here. */
static int flows_opened;
struct gm_flow *__real_gm_flow_open(struct gm_complex *complex);
struct gm_flow *__wrap_gm_flow_open(struct gm_complex *complex);

struct gm_flow *__wrap_gm_flow_open(struct gm_complex *complex)
{
    flows_opened++;
    return __real_gm_flow_open(complex);
}

/* Lanes of one problem are asked together; another mesh is another problem. */
static void words_set_up_a_problem_once(void **unused)
{
    (void)unused;
    char message[GM_MESSAGE];
    char *words[] = {(char[]){"couette"}, (char[]){"scheme=steady,semi-implicit"}, (char[]){"rows=6,8"}};
    struct gm_request request;
    flows_opened = 0;
    assert_true(gm_request_parse(&request, 3, words, 1, message));
    assert_int_equal(request.count, 4);
    assert_int_equal(flows_opened, 2);
    gm_request_close(&request);
}

/* Which of all schemes fit is asked of one problem: one set-up for the words, one for the plan. */
static void a_plan_sets_up_once(void **unused)
{
    (void)unused;
    char message[GM_MESSAGE];
    char *words[] = {(char[]){"channel"}};
    struct gm_grid table;
    flows_opened = 0;
    assert_true(gm_grid_open(&table, GM_STUDY_WORK, &(const struct gm_arguments){.words = words, .count = 1},
                             NULL, message));
    assert_true(table.count > 1);
    assert_int_equal(flows_opened, 2);
    gm_grid_close(&table);
}

/* Of all pairs of resolution and step those stay that nothing cheaper beats, by each cost. */
static void best_pairs(void **unused)
{
    (void)unused;
    const struct gm_grid_cell points[] = {
        {.error = NAN, .seconds = 1e-4, .resolution = 15},
        {.error = 1e-1, .seconds = 2e-3, .resolution = 15},
        {.error = 9.9e-2, .seconds = 3e-3, .resolution = 15},
        {.error = 2e-1, .seconds = 4e-3, .resolution = 31},
        {.error = 1e-2, .seconds = 8e-3, .resolution = 31},
        {.error = 1e-3, .seconds = 7e-3, .resolution = 63},
    };
    struct gm_grid_cell best[6];
    assert_int_equal(gm_work_keep_best(points, 6, GM_COST_SECONDS, best), 2);
    assert_true(best[0].error == 1e-1 && best[1].error == 1e-3);
    assert_int_equal(gm_work_keep_best(points, 6, GM_COST_RESOLUTION, best), 3);
    assert_true(best[0].error == 9.9e-2 && best[1].error == 1e-2 && best[2].error == 1e-3);
}

/* What is bounded and wrong is bounded; to be accurate is another question, with a bound of its own. */
static void bounded_is_not_accurate(void **unused)
{
    (void)unused;
    static const struct {
        const char *judge, *question, *word;
        double most;
    } asked[] = {{NULL, "bounded", "bounded", INFINITY},
                 {"accurate", "accurate to 0.1 (energy_error)", "accurate", 0.1},
                 {"accurate=1e-9", "accurate to 1e-09 (energy_error)", "accurate", 1e-9}};
    char *words[] = {(char[]){"system"}, (char[]){"H=p^2/2 + q^4/4"}, (char[]){"q=1"},
                     (char[]){"p=0"},    (char[]){"scheme=verlet"},   (char[]){"until=20"}};
    const struct gm_arguments arguments = {.words = words, .count = 6};
    size_t counts[3] = {0};
    for (size_t i = 0; i < 3; i++) {
        struct gm_grid table;
        char message[GM_MESSAGE], question[GM_TEXT_SIZE];
        assert_true(gm_grid_open(&table, GM_STUDY_STABILITY, &arguments, asked[i].judge, message));
        assert_true(gm_grid_measure(&table, NULL, message));
        assert_string_equal(gm_stability_question(&table, question, sizeof question), asked[i].question);
        for (size_t k = 0; k < table.lines[0].count; k++) {
            const struct gm_grid_cell *cell = &table.lines[0].cells[k];
            assert_true(i > 0 || cell->verdict != GM_WRONG);
            if (cell->verdict == GM_BOUNDED) {
                counts[i]++;
                assert_true(cell->error <= asked[i].most);
                assert_string_equal(gm_cell_word(&table, cell), asked[i].word);
            }
        }
        gm_grid_close(&table);
    }
    assert_true(counts[0] > counts[1] && counts[1] > 0 && counts[2] == 0);
}

/* The map of the stiff springs says how each scheme ends: Verlet at 1.95 and 2.05, RK4 and the implicit
   ones. */
static void verdicts(void **unused)
{
    (void)unused;
    char *words[] = {(char[]){"stiff"}, (char[]){"scheme=verlet,rk4,midpoint"}, (char[]){"until=20"}};
    const struct gm_arguments arguments = {.words = words, .count = 3};
    struct gm_grid table;
    char message[GM_MESSAGE];
    assert_true(gm_grid_open(&table, GM_STUDY_STABILITY, &arguments, NULL, message));
    assert_true(gm_grid_measure(&table, NULL, message));
    const struct gm_stability *plan = table.plan;
    for (size_t s = 0; s < plan->step_count; s++) {
        const size_t fifty = s * plan->value_count + 1;
        assert_true(plan->values[1] == 50);
        const double step = plan->steps[s];
        assert_int_equal(gm_cell_letter(&table.lines[0].cells[fifty]), step < 2 ? '.' : 'B');
        assert_int_equal(gm_cell_letter(&table.lines[1].cells[fifty]), step > 2.9  ? 'B'
                                                                       : step >= 1 ? 'L'
                                                                                   : '.');
        assert_int_equal(gm_cell_letter(&table.lines[2].cells[fifty]), '.');
    }
    assert_true(gm_stability_limit(&table, &table.lines[0]) == 1.95);
    table.lines[0].cells[0].tried = false; /* interrupted: that it is bounded at no step is not known */
    assert_true(isnan(gm_stability_limit(&table, &table.lines[0])));
    gm_grid_close(&table);
    words[0] = (char[]){"disc"};
    assert_false(gm_grid_open(&table, GM_STUDY_STABILITY,
                              &(const struct gm_arguments){.words = words, .count = 1}, NULL, message));
    assert_non_null(strstr(message, "no stability map"));
}

/* The rows of a sweep in the explorer are written whole, or their file counts as failed. */
static void rows_that_cannot_be_read_are_reported(void **unused)
{
    (void)unused;
    char *words[] = {(char[]){"kepler"}, (char[]){"scheme=verlet"}, (char[]){"dt=0.1,0.2"},
                     (char[]){"until=1"}};
    const struct gm_arguments arguments = {.words = words, .count = 4};
    struct gm_grid grid;
    char message[GM_MESSAGE], *text = NULL;
    size_t size = 0, lines = 0;
    FILE *file = open_memstream(&text, &size);
    assert_true(gm_grid_open(&grid, GM_STUDY_SWEEP, &arguments, NULL, message));
    assert_true(gm_grid_measure(&grid, NULL, message));
    assert_true(gm_grid_write(&grid, file));
    fclose(file);
    for (size_t i = 0; i < size; i++) {
        lines += text[i] == '\n';
    }
    assert_int_equal(lines, 3);
    free(text);
    const int unreadable = open("/dev/null", O_WRONLY);
    assert_true(dup2(unreadable, grid.table) >= 0);
    close(unreadable);
    file = fopen("/dev/null", "w");
    assert_false(gm_grid_write(&grid, file));
    fclose(file);
    gm_grid_close(&grid);
}

static bool interrupts; /* a file that is put in its place interrupts the run */

/* Replaces that of the C library. */
int rename(const char *from, const char *to)
{
    gm_interrupted = interrupts ? 1 : gm_interrupted;
    return renameat(AT_FDCWD, from, AT_FDCWD, to);
}

static void run_with_a_checkpoint(struct gm_arena *arena, void *status)
{
    char *words[] = {(char[]){"geomint"},   (char[]){"run"},        (char[]){"kepler"},
                     (char[]){"dt=0.3"},    (char[]){"until=1.05"}, (char[]){"scheme=rk4"},
                     (char[]){"--csv"},     (char[]){"rest.csv"},   (char[]){"--checkpoint"},
                     (char[]){"rest.state"}};
    struct gm_options options;
    char message[GM_MESSAGE];
    assert_true(gm_options_parse(&options, GM_RUN, (int)GM_COUNT(words), words, 2, message));
    gm_arena_keep(arena, &options, gm_options_close);
    options.arena = arena;
    options.end = status;
    *(int *)status = gm_command_run(&options);
    gm_arena_drop(arena, &options);
}

/* A run that is interrupted after its last whole step, while the checkpoint of it is written, has not come to
   its end. */
static void interrupted_before_the_last_part(void **unused)
{
    (void)unused;
    int status = 0;
    char line[512] = "", status_word[32] = "";
    double t = 0;
    interrupts = true;
    struct gm_arena *arena = gm_arena_open();
    assert_true(gm_arena_run(arena, run_with_a_checkpoint, &status));
    gm_arena_close(arena);
    interrupts = false;
    gm_interrupted = 0;
    assert_int_equal(status, GM_EXIT_INTERRUPTED);
    FILE *rows = fopen("rest.csv", "r");
    assert_non_null(rows);
    while (fgets(line, sizeof line, rows)) {
    }
    fclose(rows);
    assert_int_equal(sscanf(line, "kepler,0,rk4,%lf,%31[a-z]", &t, status_word), 2);
    assert_string_equal(status_word, "interrupted");
    assert_true(fabs(t - 0.9) < 1e-12);
    unlink("rest.csv");
    unlink("rest.state");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(observables_say_what_they_are),
        cmocka_unit_test(sections_are_interpolated),
        cmocka_unit_test(rows_that_cannot_be_read_are_reported),
        cmocka_unit_test(interrupted_before_the_last_part),
        cmocka_unit_test(sections_survive_stepping_back),
        cmocka_unit_test(angles_are_unwrapped),
        cmocka_unit_test(memory_is_bounded),
        cmocka_unit_test(looking_changes_nothing),
        cmocka_unit_test(refusals),
        cmocka_unit_test(a_configuration_brings_its_own),
        cmocka_unit_test(chains_of_every_length),
        cmocka_unit_test(step_longer_than_an_orbit),
        cmocka_unit_test(linear_stability),
        cmocka_unit_test(linear_limits),
        cmocka_unit_test(bindings_of_stiff_springs),
        cmocka_unit_test(prices),
        cmocka_unit_test(words_set_up_a_problem_once),
        cmocka_unit_test(a_plan_sets_up_once),
        cmocka_unit_test(best_pairs),
        cmocka_unit_test(verdicts),
        cmocka_unit_test(bounded_is_not_accurate),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
