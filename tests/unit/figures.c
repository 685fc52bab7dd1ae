/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Published figures: all are there, what is said of them names lanes and observables that exist, and a scheme
   that does not do what is said of it is told so. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "app/figures/figure.h"
#include "core/count.h"
#include "tests/common/folder.h"

static const struct gm_figure *find(const char *name, const struct gm_scene **of)
{
    for (size_t s = 0; s < gm_scene_count(); s++) {
        const struct gm_scene *scene = gm_scene_at(s);
        for (size_t f = 0; f < scene->figure_count; f++) {
            if (strcmp(scene->figures[f].name, name) == 0) {
                *of = scene;
                return &scene->figures[f];
            }
        }
    }
    return NULL;
}

/* Every figure that a computation made. */
static void none_is_missing(void **unused)
{
    (void)unused;
    static const char *const reviewed[] = {
        "1",  "2",  "3",  "4",  "5",  "6",  "7",  "8",  "9",  "10", "11", "12",         "13",           "16",
        "17", "24", "25", "26", "30", "31", "32", "33", "35", "36", "37", "34-couette", "34-poiseuille"};
    const struct gm_scene *scene = NULL;
    char name[64];
    for (size_t i = 0; i < GM_COUNT(reviewed); i++) {
        snprintf(name, sizeof name, "razafindralandy-%s", reviewed[i]);
        assert_non_null(find(name, &scene));
        assert_non_null(gm_published_find(name));
    }
    for (int i = 2; i <= 14; i++) {
        snprintf(name, sizeof name, "tyranowski-%d", i);
        assert_non_null(find(name, &scene));
        assert_non_null(gm_published_find(name));
    }
}

static void what_is_said_can_be_measured(void **unused)
{
    (void)unused;
    char message[GM_MESSAGE];
    for (size_t i = 0; i < gm_published_count(); i++) {
        const struct gm_scene *scene = NULL;
        const struct gm_figure *figure = find(gm_published_at(i)->figure, &scene);
        if (!figure) {
            fail_msg("%s is no figure", gm_published_at(i)->figure);
        }
        struct gm_figure_job job;
        gm_figure_plan(&job, scene, figure, false);
        if (!gm_figure_check(&job, message)) {
            fail_msg("%s: %s", figure->name, message);
        }
    }
}

/* Of the breakdown of the mesh both strategies' times are judged, as the document has them: 600, told to one
   digit, and beyond 1000. */
static void breakdowns_are_judged(void **unused)
{
    (void)unused;
    const struct gm_published *breakdown = gm_published_find("tyranowski-12-breakdown");
    bool multiplier = false, control = false;
    assert_non_null(breakdown);
    for (size_t i = 0; i < breakdown->count; i++) {
        const struct gm_statement *statement = &breakdown->statements[i];
        if (statement->measure == GM_LASTS && !statement->against) {
            multiplier |= strstr(statement->lanes, "scheme=multiplier") && statement->low == 550 &&
                          statement->high == 650;
            control |= strstr(statement->lanes, "scheme=control") && statement->low == 1000 &&
                       statement->high == INFINITY;
        }
    }
    assert_true(multiplier && control);
}

/* How many lanes a product of lists gives. */
static size_t lane_count(const char *arguments)
{
    size_t product = 1;
    for (const char *word = arguments; *word; word += strspn(word, " ")) {
        size_t values = 1;
        for (; *word && *word != ' '; word++) {
            values += *word == ',';
        }
        product *= values;
    }
    return product;
}

/* Shortened arguments are understood and replace their namesakes; all panels stay, the times that captions
   name, and what is said of the lanes. */
static void quick_figures_are_coarser(void **unused)
{
    (void)unused;
    const struct gm_scene *scene = NULL;
    const struct gm_figure *figure = find("razafindralandy-12", &scene);
    struct gm_figure_job job;
    gm_figure_plan(&job, scene, figure, true);
    assert_true(job.shortened);
    assert_non_null(strstr(job.arguments, "dt=0.2"));
    assert_null(strstr(job.arguments, "dt=0.05"));
    assert_non_null(strstr(job.arguments, "until=500"));
    gm_figure_plan(&job, scene, figure, false);
    assert_false(job.shortened);
    assert_string_equal(job.arguments, figure->arguments);
    for (size_t i = 0; i < gm_published_count(); i++) {
        char message[GM_MESSAGE];
        const char *quick = gm_published_at(i)->quick;
        figure = find(gm_published_at(i)->figure, &scene);
        gm_figure_plan(&job, scene, figure, true);
        if (quick && (strstr(quick, "until=") || strstr(quick, "steps="))) {
            fail_msg("%s ends before its time: %s", figure->name, quick);
        }
        assert_int_equal(lane_count(job.arguments), lane_count(figure->arguments));
        if (!gm_figure_check(&job, message)) {
            fail_msg("%s: %s", figure->name, message);
        }
    }
}

static void what_has_no_number_says_so(void **unused)
{
    (void)unused;
    char text[64];
    gm_verdict_number(INFINITY, -INFINITY, text, sizeof text);
    assert_string_equal(text, "no number");
    gm_verdict_number(NAN, NAN, text, sizeof text);
    assert_string_equal(text, "no number");
    gm_verdict_number(0.25, 0.25, text, sizeof text);
    assert_string_equal(text, "0.25");
    gm_verdict_number(0.25, 0.5, text, sizeof text);
    assert_string_equal(text, "0.25 to 0.5");
}

static void make(const char *arguments, const struct gm_statement *statements, size_t count,
                 struct gm_outcome *outcome)
{
    char folder[256];
    folder_make(folder, sizeof folder);
    const struct gm_figure figure = {.name = "trial", .statement = "", .arguments = arguments};
    const struct gm_published published = {.figure = "trial", .statements = statements, .count = count};
    const struct gm_figure_output output = {.folder = folder, .look = {.width = 160, .height = 90}};
    struct gm_figure_job job;
    gm_figure_plan(&job, gm_scene_find("disc"), &figure, false);
    job.published = &published;
    *outcome = (struct gm_outcome){0};
    gm_figure_make(&job, &output, outcome);
    assert_int_equal(folder_count(folder), 2);
    folder_remove(folder);
    assert_int_equal(outcome->progress, GM_MADE);
    assert_int_equal(outcome->verdict_count, count);
}

/* The same statements of a scheme that keeps the area and of one that does not; the numbers are those of
   explicit Euler, (1 + dt^2)^n and (1 + dt^2)^n - 1, computed here. */
static void a_wrong_scheme_is_caught(void **unused)
{
    (void)unused;
    static const struct gm_statement statements[] = {
        {"the area is kept", .lanes = "", .observable = "area_error", .measure = GM_MAXIMUM, .low = -INFINITY,
         .high = 1e-12},
        {"the energy error is bounded", .lanes = "", .observable = "energy_error", .measure = GM_GROWTH,
         .low = -INFINITY, .high = 1.1},
        {"factor", .lanes = "", .observable = "area", .measure = GM_FACTOR, .low = 0.999, .high = 1.001},
        {"it lasts", .lanes = "", .measure = GM_LASTS, .low = 20, .high = INFINITY},
    };
    struct gm_outcome outcome;
    make("scheme=symplectic-euler dt=0.1 until=20", statements, 4, &outcome);
    for (size_t i = 0; i < 4; i++) {
        assert_true(outcome.verdicts[i].holds);
    }
    make("scheme=explicit-euler dt=0.1 until=20", statements, 4, &outcome);
    for (size_t i = 0; i < 3; i++) {
        assert_false(outcome.verdicts[i].holds);
    }
    assert_true(outcome.verdicts[3].holds);
    const double factor = pow(1.01, 200);
    assert_true(fabs(outcome.verdicts[2].low / factor - 1) < 1e-11);
    assert_true(fabs(outcome.verdicts[0].high / (factor - 1) - 1) < 1e-11);
    assert_true(fabs(outcome.verdicts[1].low / ((factor - 1) / (pow(1.01, 100) - 1)) - 1) < 0.02);
}

/* A run that fails has no number that is small enough, however small it was when it failed. */
static void a_failed_run_holds_nothing_small(void **unused)
{
    (void)unused;
    static const struct gm_statement statements[] = {
        {"small", .lanes = "", .observable = "energy_error", .measure = GM_AT_END, .low = -INFINITY,
         .high = 1e300},
        {"large", .lanes = "", .observable = "energy_error", .measure = GM_AT_END, .low = 1,
         .high = INFINITY},
        {"it lasts", .lanes = "", .measure = GM_LASTS, .low = 999, .high = INFINITY},
    };
    struct gm_outcome outcome;
    make("scheme=explicit-euler dt=2 until=1000", statements, 3, &outcome);
    assert_false(outcome.verdicts[0].holds);
    assert_true(outcome.verdicts[1].holds);
    assert_false(outcome.verdicts[2].holds);
    assert_true(outcome.lanes[0].failure[0]);
}

/* The order of convergence, from a ladder of steps, and a ratio of two lanes: halving the step divides the
   error of a second-order scheme by four. Values in a list each have their lanes; orders divide orders. */
static void orders_and_ratios(void **unused)
{
    (void)unused;
    static const struct gm_statement statements[] = {
        {"order 2", .lanes = "", .observable = "energy_error", .measure = GM_MAXIMUM, .over = "dt",
         .low = 1.95, .high = 2.05},
        {"order 4", .lanes = "", .observable = "energy_error", .measure = GM_MAXIMUM, .over = "dt",
         .low = 3.95, .high = 4.05},
        {"a quarter", .lanes = "dt=0.05", .against = "dt=0.1", .observable = "energy_error",
         .measure = GM_MAXIMUM, .low = 0.24, .high = 0.26},
    };
    struct gm_outcome outcome;
    make("scheme=verlet dt=0.1,0.05,0.025 until=20", statements, 3, &outcome);
    assert_true(outcome.verdicts[0].holds);
    assert_false(outcome.verdicts[1].holds);
    assert_true(outcome.verdicts[2].holds);
    static const struct gm_statement of_two[] = {
        {"fine steps", .lanes = "scheme=yoshida4 dt=0.05,0.025", .observable = "energy_error",
         .measure = GM_MAXIMUM, .over = "dt", .low = 3.95, .high = 4.05},
        {"twice", .lanes = "scheme=yoshida4", .against = "scheme=verlet dt=0.05,0.025",
         .observable = "energy_error", .measure = GM_MAXIMUM, .over = "dt", .low = 1.95, .high = 2.05},
        {"two by two", .lanes = "scheme=yoshida4 dt=0.05,0.025", .against = "scheme=verlet dt=0.05,0.025",
         .observable = "energy_error", .measure = GM_MAXIMUM, .low = 0, .high = 0.1},
    };
    make("scheme=verlet,yoshida4 dt=0.1,0.05,0.025 until=20", of_two, 3, &outcome);
    assert_true(outcome.verdicts[0].holds);
    assert_true(outcome.verdicts[1].holds);
    assert_true(outcome.verdicts[2].holds && outcome.verdicts[2].low < outcome.verdicts[2].high);
}

/* When something is largest, smallest, or first above a level: with explicit Euler the energy error is
   (1 + dt^2)^n - 1, above 1 from the 70th step on, and the area rises; with implicit Euler it falls. */
static void times_are_measured(void **unused)
{
    (void)unused;
    static const struct gm_statement statements[] = {
        {"twice", .lanes = "", .observable = "energy_error", .measure = GM_EXCEEDS, .level = 1, .low = 6.89,
         .high = 7.01},
        {"never", .lanes = "", .observable = "energy_error", .measure = GM_EXCEEDS, .level = 1e3,
         .low = -INFINITY, .high = 1e9},
        {"most", .lanes = "", .observable = "area", .measure = GM_PEAKS, .low = 9.89, .high = 10},
        {"least", .lanes = "", .observable = "area", .measure = GM_DIPS, .low = 0, .high = 0.11},
    };
    struct gm_outcome outcome;
    make("scheme=explicit-euler dt=0.1 until=10", statements, 4, &outcome);
    assert_true(outcome.verdicts[0].holds);
    assert_false(outcome.verdicts[1].holds);
    assert_true(outcome.verdicts[2].holds);
    assert_true(outcome.verdicts[3].holds);
    make("scheme=implicit-euler dt=0.1 until=10", statements, 4, &outcome);
    assert_false(outcome.verdicts[2].holds);
    assert_false(outcome.verdicts[3].holds);
}

static void unknown_names_are_refused(void **unused)
{
    (void)unused;
    static const struct gm_statement wrong[] = {
        {"lane", .lanes = "scheme=rk4", .observable = "area", .measure = GM_AT_END},
        {"key", .lanes = "colour=red", .observable = "area", .measure = GM_AT_END},
        {"observable", .lanes = "", .observable = "volume", .measure = GM_AT_END},
        {"over", .lanes = "", .observable = "area", .measure = GM_AT_END, .over = "nothing"},
    };
    const struct gm_figure figure = {.name = "trial", .statement = "", .arguments = "scheme=verlet"};
    for (size_t i = 0; i < GM_COUNT(wrong); i++) {
        char message[GM_MESSAGE] = "";
        const struct gm_published published = {.figure = "trial", .statements = &wrong[i], .count = 1};
        struct gm_figure_job job;
        gm_figure_plan(&job, gm_scene_find("disc"), &figure, false);
        job.published = &published;
        assert_false(gm_figure_check(&job, message));
        assert_non_null(strstr(message, wrong[i].says));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(none_is_missing),
        cmocka_unit_test(what_is_said_can_be_measured),
        cmocka_unit_test(breakdowns_are_judged),
        cmocka_unit_test(quick_figures_are_coarser),
        cmocka_unit_test(what_has_no_number_says_so),
        cmocka_unit_test(a_wrong_scheme_is_caught),
        cmocka_unit_test(a_failed_run_holds_nothing_small),
        cmocka_unit_test(orders_and_ratios),
        cmocka_unit_test(times_are_measured),
        cmocka_unit_test(unknown_names_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
