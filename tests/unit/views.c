/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Views of a system: names over time, trails, the window and the phase portrait, as marks of a picture. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "app/words/request.h"
#include "core/ode/portrait/portrait.h"

enum { STEPS = 40 };

static void expect_near(double value, double expected, double most)
{
    if (!(fabs(value - expected) <= most)) {
        fail_msg("%.17g, not %.17g", value, expected);
    }
}

/* Lanes of words after STEPS steps, and their picture. */
struct drawn {
    struct gm_request request;
    struct gm_lane *lanes[4];
    struct gm_picture *picture;
};

static void draw(struct drawn *drawn, const char *words)
{
    char message[GM_MESSAGE] = "";
    char text[512], *list[32], *rest = NULL;
    int count = 0;
    snprintf(text, sizeof text, "%s", words);
    for (char *word = strtok_r(text, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        list[count++] = word;
    }
    if (!gm_request_parse(&drawn->request, count, list, 1, message)) {
        fail_msg("%s: %s", words, message);
    }
    for (size_t i = 0; i < drawn->request.count; i++) {
        drawn->lanes[i] = gm_request_open_lane(&drawn->request, i, message);
        assert_non_null(drawn->lanes[i]);
        for (int k = 1; k <= STEPS; k++) {
            gm_lane_to(drawn->lanes[i], k, 1e9);
            gm_lane_record(drawn->lanes[i]);
        }
    }
    drawn->picture = gm_picture_open();
    assert_non_null(drawn->picture);
    gm_lanes_draw((const struct gm_lane *const *)drawn->lanes, drawn->request.count, drawn->picture);
}

static void forget(struct drawn *drawn)
{
    for (size_t i = 0; i < drawn->request.count; i++) {
        gm_lane_close(drawn->lanes[i]);
    }
    gm_picture_close(drawn->picture);
    gm_request_close(&drawn->request);
}

/* Returns the line number `number` of a panel with at least `least` points. */
static const struct gm_mark *line_of(const struct gm_panel *panel, size_t number, size_t least)
{
    for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
        if (mark->kind == GM_MARK_LINE && mark->count >= least && number-- == 0) {
            return mark;
        }
    }
    return NULL;
}

static size_t lines_of(const struct gm_panel *panel, size_t least)
{
    size_t count = 0;
    while (line_of(panel, count, least)) {
        count++;
    }
    return count;
}

static const double *last_of(const struct gm_mark *line)
{
    return line->points + 2 * (line->count - 1);
}

static void test_names_over_time(void **state)
{
    (void)state;
    struct drawn drawn;
    draw(&drawn, "lotka-volterra scheme=midpoint,rk4 show=t:x+y+energy dt=0.05 until=2");
    const struct gm_panel *panel = drawn.picture->first;
    for (size_t i = 0; i < 2; i++, panel = panel->next) {
        const double *y = gm_run_state(drawn.lanes[i]->run);
        const double H = y[0] - log(y[0]) + y[1] - 2 * log(y[1]);
        const double expected[] = {y[0], y[1], H};
        assert_string_equal(panel->x.label, "t");
        expect_near(panel->x.high, 2, 1e-9);
        assert_int_equal(lines_of(panel, STEPS + 1), 3);
        for (size_t k = 0; k < 3; k++) {
            const double *last = last_of(line_of(panel, k, STEPS + 1));
            expect_near(last[0], 2, 1e-9);
            expect_near(last[1], expected[k], 1e-12);
        }
        assert_string_equal(panel->first_key->name, "x");
        assert_string_equal(panel->last_key->name, "energy");
    }
    forget(&drawn);
}

/* The graph of an observable is that of the same components. */
static void test_observables_over_time(void **state)
{
    (void)state;
    struct drawn drawn;
    draw(&drawn, "kepler scheme=rk4 show=t:angular_momentum+p2 dt=0.1 until=4");
    const struct gm_mark *momentum = line_of(drawn.picture->first, 0, STEPS + 1),
                         *p2 = line_of(drawn.picture->first, 1, STEPS + 1);
    const double *y = gm_run_state(drawn.lanes[0]->run);
    expect_near(last_of(momentum)[1], y[0] * y[3] - y[1] * y[2], 1e-12);
    expect_near(momentum->points[1], sqrt(0.75), 1e-12);
    expect_near(last_of(p2)[1], y[3], 1e-15);
    forget(&drawn);
    /* an angle is followed over its jump */
    draw(&drawn, "kepler scheme=rk2 show=t:lrl_angle dt=0.15 until=6");
    const struct gm_mark *angle = line_of(drawn.picture->first, 0, 8);
    for (size_t k = 1; k < angle->count; k++) {
        assert_true(fabs(angle->points[2 * k + 1] - angle->points[2 * k - 1]) < 3);
    }
    forget(&drawn);
}

static void test_all_and_overlay(void **state)
{
    (void)state;
    struct drawn drawn;
    draw(&drawn, "lorenz scheme=rk4 show=t:all dt=0.01 until=0.4");
    assert_int_equal(lines_of(drawn.picture->first, STEPS + 1), 3);
    forget(&drawn);
    draw(&drawn, "lorenz scheme=rk4,rk2 overlay=yes show=t:z dt=0.01 until=0.4");
    assert_int_equal(lines_of(drawn.picture->first, STEPS + 1), 2);
    assert_string_equal(drawn.picture->first->y.label, "z");
    forget(&drawn);
}

/* Of an ensemble the last member is strong, and at most 64 others are thin. */
static void test_members_over_time(void **state)
{
    (void)state;
    static const struct {
        const char *words;
        size_t lines;
    } members[] = {{"members=8", 8}, {"members=400", 65}};
    for (size_t i = 0; i < 2; i++) {
        char words[128];
        struct drawn drawn;
        snprintf(words, sizeof words, "lotka-volterra scheme=rk4 show=t:x dt=0.05 until=2 %s",
                 members[i].words);
        draw(&drawn, words);
        const struct gm_panel *panel = drawn.picture->first;
        const size_t lines = lines_of(panel, STEPS + 1);
        assert_int_equal(lines, members[i].lines);
        const struct gm_mark *first = line_of(panel, 0, STEPS + 1),
                             *last = line_of(panel, lines - 1, STEPS + 1);
        const size_t m = drawn.lanes[0]->problem.m;
        const double *y = gm_run_state(drawn.lanes[0]->run);
        assert_true(first->style.width < last->style.width && first->style.alpha < last->style.alpha);
        assert_true(last_of(first)[1] == y[0]);
        assert_true(last_of(last)[1] == y[m - 1]);
        forget(&drawn);
    }
}

static void test_trails(void **state)
{
    (void)state;
    static const struct {
        const char *words;
        double oldest; /* the first time that is drawn */
    } trails[] = {{"trails=yes", 0}, {"trails=0.4", 0.4}, {"trails=no", 0.8}};
    for (size_t i = 0; i < 3; i++) {
        char words[128];
        struct drawn drawn;
        snprintf(words, sizeof words, "lotka-volterra scheme=rk4 dt=0.02 until=0.8 %s", trails[i].words);
        draw(&drawn, words);
        size_t most = 0;
        for (const struct gm_mark *mark = drawn.picture->first->first; mark; mark = mark->next) {
            most = mark->kind == GM_MARK_LINE && mark->count > most ? mark->count : most;
        }
        const double expected = trails[i].oldest < 0.8 ? (0.8 - trails[i].oldest) / 0.02 + 1 : 0;
        expect_near((double)most, expected, 2);
        forget(&drawn);
    }
}

static void test_portrait(void **state)
{
    (void)state;
    struct drawn drawn;
    draw(&drawn, "lotka-volterra scheme=rk4 dt=0.05 until=2 portrait=yes window=-0.5,4,-0.5,5");
    const struct gm_panel *panel = drawn.picture->first;
    assert_true(panel->x.low == -0.5 && panel->x.high == 4 && panel->y.low == -0.5 && panel->y.high == 5);
    size_t saddles = 0, centres = 0, names = 0, arrows = 0, fewer = 0, few = 0;
    for (const struct gm_mark *mark = panel->first; mark; mark = mark->next) {
        saddles += mark->glyph == GM_HALF_DISC && hypot(mark->points[0], mark->points[1]) < 1e-9;
        centres += mark->glyph == GM_DOTTED_RING && hypot(mark->points[0] - 1, mark->points[1] - 2) < 1e-9;
        names += mark->kind == GM_MARK_TEXT &&
                 (strcmp(mark->text, "x′ = 0") == 0 || strcmp(mark->text, "y′ = 0") == 0);
        const bool is_arrow = mark->kind == GM_MARK_LINE && mark->count == 5;
        arrows += is_arrow && gm_mark_is_shown(mark, 400, 300);
        fewer += is_arrow && gm_mark_is_shown(mark, 80, 60);
        few += is_arrow && gm_mark_is_shown(mark, 26, 32);
        const bool is_nullcline = mark->kind == GM_MARK_LINE && mark->style.role == GM_INK;
        for (size_t i = 0; is_nullcline && i < mark->count; i++) { /* x' = x (2 - y), y' = y (x - 1) */
            const double x = mark->points[2 * i], y = mark->points[2 * i + 1];
            const double zero = mark->style.dash == GM_LONG_DASH ? x * (2 - y) : y * (x - 1);
            expect_near(zero, 0, 1e-3);
        }
    }
    assert_int_equal(saddles, 1);
    assert_int_equal(centres, 1);
    assert_int_equal(names, 2);
    assert_in_range(arrows, 290, 300); /* one less at an equilibrium */
    assert_in_range(fewer, 75, 80);
    assert_in_range(few, 17, 20);
    assert_string_equal(drawn.picture->caption, "◐ saddle  ◌ centre");
    struct gm_portrait portrait;
    assert_true(drawn.lanes[0]->scene->portrait(drawn.lanes[0], &portrait));
    assert_int_equal(portrait.count, 2);
    gm_portrait_close(&portrait);
    forget(&drawn);
    /* without a window: the box of the trajectory, widened by a quarter */
    draw(&drawn, "lotka-volterra scheme=rk4 dt=0.05 until=2 portrait=yes");
    assert_true(drawn.lanes[0]->scene->portrait(drawn.lanes[0], &portrait));
    double low = INFINITY, high = -INFINITY;
    const struct gm_entries *past = &drawn.lanes[0]->entries[0];
    for (size_t k = 0; k < past->count; k++) {
        low = fmin(low, past->values[2 * k]);
        high = fmax(high, past->values[2 * k]);
    }
    expect_near(portrait.window.high[0] - portrait.window.low[0], 1.25 * (high - low), 1e-9);
    gm_portrait_close(&portrait);
    forget(&drawn);
    /* no portrait is drawn over time, or without the key */
    draw(&drawn, "lotka-volterra scheme=rk4 dt=0.05 until=2 portrait=yes show=t:x");
    assert_false(drawn.lanes[0]->scene->portrait(drawn.lanes[0], &portrait));
    forget(&drawn);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_names_over_time), cmocka_unit_test(test_observables_over_time),
        cmocka_unit_test(test_all_and_overlay), cmocka_unit_test(test_members_over_time),
        cmocka_unit_test(test_trails),          cmocka_unit_test(test_portrait),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
