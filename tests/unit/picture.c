/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pictures as data: lines that break, level lines, calm ranges, the text of them. */
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
#include "tests/common/picture_text.h"

static const struct gm_style line_style = {GM_LANE + 1, 0.5, 2.4, GM_LONG_DASH};

static size_t marks_of(const struct gm_panel *panel)
{
    size_t count = 0;
    for (const struct gm_mark *mark = panel->first; mark != NULL; mark = mark->next) {
        count++;
    }
    return count;
}

static void lines_break_where_they_cannot_be_drawn(void **state)
{
    (void)state;
    struct gm_picture *picture = gm_picture_open();
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_GRAPH, "");
    panel->y.scale = GM_LOG;
    const double points[] = {0, 1, 1, 2, 2, 0, 3, 4, 4, NAN, INFINITY, 1, 5, 6, 6, 7, 7, -1};
    const struct gm_mark *first = gm_mark_line(picture, panel, line_style, points, 9, false);
    assert_int_equal(marks_of(panel), 3);
    assert_ptr_equal(first, panel->first);
    assert_int_equal(first->count, 2);
    assert_int_equal(first->next->count, 1);
    assert_true(first->next->points[0] == 3.0 && first->next->points[1] == 4.0);
    assert_int_equal(panel->last->count, 2);
    assert_true(panel->last->points[3] == 7.0);

    /* On a linear axis zero and below are values like others. */
    struct gm_panel *linear = gm_panel_add(picture, GM_PLACE_GRAPH, "");
    gm_mark_line(picture, linear, line_style, points, 4, false);
    assert_int_equal(marks_of(linear), 1);
    gm_picture_close(picture);
}

static void closed_lines_open_at_a_gap(void **state)
{
    (void)state;
    struct gm_picture *picture = gm_picture_open();
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
    const double points[] = {0, 0, 1, 0, NAN, 0, 1, 1, 0, 1};
    const struct gm_mark *mark = gm_mark_line(picture, panel, line_style, points, 5, true);
    assert_int_equal(marks_of(panel), 1);
    assert_false(mark->closed);
    assert_int_equal(mark->count, 4);
    assert_true(mark->points[0] == 1.0 && mark->points[1] == 1.0); /* starts after the gap */
    assert_true(mark->points[6] == 1.0 && mark->points[7] == 0.0);
    gm_mark_line(picture, panel, line_style, points, 2, true);
    assert_true(panel->last->closed);
    gm_picture_close(picture);
}

static void nothing_undrawable_reaches_painters(void **state)
{
    (void)state;
    struct gm_picture *picture = gm_picture_open();
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
    const double points[] = {0, 0, 1, NAN, 1, 1, 0, 1}, values[] = {1, 2, INFINITY, 4};
    const int triangles[] = {0, 2, 3, 0, 1, 2, 0, 3, 7, -1, 0, 3, 0, 3, 3};
    assert_int_equal(gm_mark_points(picture, panel, line_style, points, 4)->count, 3);
    assert_int_equal(gm_mark_polygon(picture, panel, line_style, points, 4)->count, 3);
    const struct gm_mark *mesh =
        gm_mark_mesh(picture, panel, GM_MAP_SEQUENTIAL, 0, 0, points, values, 4, triangles, 5);
    assert_int_equal(mesh->triangle_count, 1); /* the last; the others lack a place, a value or a vertex */
    assert_true(mesh->high > mesh->low);
    for (size_t i = 0; i < 4; i++) {
        assert_true(isfinite(mesh->values[i]) && isfinite(mesh->points[2 * i + 1]));
    }
    const struct gm_mark *image =
        gm_mark_image(picture, panel, GM_MAP_DIVERGING, -1, 1, (const double[]){0, 0, 1, 1}, values, 2, 2);
    assert_true(image->values[2] == -1.0);
    const size_t before = marks_of(panel);
    gm_mark_text(picture, panel, line_style, NAN, 0, GM_ANCHOR_LEFT, "nowhere");
    gm_mark_line(picture, panel, line_style, points + 2, 1, false);
    gm_mark_points(picture, panel, line_style, points, 0);
    assert_int_equal(marks_of(panel), before);
    gm_picture_close(picture);
}

static void text_of(const struct gm_picture *picture, char **text)
{
    size_t size;
    FILE *stream = open_memstream(text, &size);
    assert_non_null(stream);
    test_picture_write(picture, stream);
    fclose(stream);
}

static void pictures_are_written_as_text(void **state)
{
    (void)state;
    struct gm_picture *picture = gm_picture_open();
    for (int round = 0; round < 2; round++) { /* clearing leaves nothing behind */
        gm_picture_clear(picture);
        picture->title = "A \"disc\"";
        picture->clock = gm_picture_text(picture, "t = %d", 3);
        struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "midpoint");
        panel->title_role = gm_lane_role(8);
        panel->equal = true;
        panel->x = (struct gm_axis){.label = "q", .scale = GM_PI, .low = -2, .high = 2};
        gm_mark_line(picture, panel, line_style, (const double[]){-0.0, 1.0 / 3.0, 1e-20, 2}, 2, false);
        gm_mark_polygon(picture, panel, (struct gm_style){GM_INITIAL, 1, 0, GM_SOLID},
                        (const double[]){0, 0, 1, 0, 0, 1}, 3);
        gm_mark_text(picture, panel, (struct gm_style){GM_INK, 1, 1, GM_SOLID}, 1, 2, GM_ANCHOR_CENTRE,
                     "inlet");
        struct gm_panel *field = gm_panel_add(picture, GM_PLACE_GRAPH, "");
        field->colour_bar = true;
        gm_mark_mesh(picture, field, GM_MAP_SEQUENTIAL, 0, 2, (const double[]){0, 0, 1, 0, 0, 1},
                     (const double[]){0, 1, 2}, 3, (const int[]){0, 1, 2}, 1);
        gm_mark_image(picture, field, GM_MAP_DIVERGING, -1, 1, (const double[]){0, 0, 1, 1},
                      (const double[]){-1, 1}, 1, 2);
    }
    char *text;
    text_of(picture, &text);
    assert_string_equal(text, "picture \"A \\\"disc\\\"\" \"\" \"t = 3\" \"\"\n"
                              "panel state lane2 \"midpoint\" \"\" equal\n"
                              "x \"q\" pi -2 2\n"
                              "y \"\" linear 0 1\n"
                              "line lane1 0.5 2.4 long-dash open 2 0 0.333333333 1e-20 2\n"
                              "polygon initial 1 0 solid 3 0 0 1 0 0 1\n"
                              "text ink 1 1 solid centre 1 2 \"inlet\"\n"
                              "panel graph ink \"\" \"\" axes colour-bar \"\"\n"
                              "x \"\" linear 0 1\n"
                              "y \"\" linear 0 1\n"
                              "mesh sequential 0 2 3 1 0 0 0 1 0 1 0 1 2 0 1 2\n"
                              "image diverging -1 1 1 2 0 0 1 1 -1 1\n");
    free(text);
    gm_picture_close(picture);
}

/* A square of n x n cells, each two triangles, with values x^2 + y^2 - scale about its middle. */
enum { CELLS = 32, VERTICES = (CELLS + 1) * (CELLS + 1) };

static void level_lines_are_whole_and_in_place(void **state)
{
    (void)state;
    static double points[2 * VERTICES], values[VERTICES];
    static int triangles[6 * CELLS * CELLS];
    size_t triangle_count = 0;
    for (int row = 0; row <= CELLS; row++) {
        for (int column = 0; column <= CELLS; column++) {
            const int v = row * (CELLS + 1) + column;
            points[2 * v] = 2.0 * column / CELLS - 1.0;
            points[2 * v + 1] = 2.0 * row / CELLS - 1.0;
            values[v] = hypot(points[2 * v], points[2 * v + 1]);
            if (row == CELLS || column == CELLS) {
                continue;
            }
            const int cell[6] = {v, v + 1, v + CELLS + 1, v + 1, v + CELLS + 2, v + CELLS + 1};
            memcpy(triangles + 3 * triangle_count, cell, sizeof cell);
            triangle_count += 2;
        }
    }
    struct gm_picture *picture = gm_picture_open();
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
    /* A circle; one that leaves through the four sides; none; and a level that meets vertices exactly. */
    static const struct {
        double level;
        size_t lines;
        bool closed;
    } expected[] = {{0.61, 1, true}, {1.2, 4, false}, {2.0, 0, false}, {0.5, 1, true}};
    for (size_t i = 0; i < GM_COUNT(expected); i++) {
        panel->first = panel->last = NULL;
        gm_mark_level_lines(picture, panel, line_style, points, values, VERTICES, triangles, triangle_count,
                            &expected[i].level, 1);
        assert_int_equal(marks_of(panel), expected[i].lines);
        for (const struct gm_mark *mark = panel->first; mark != NULL; mark = mark->next) {
            assert_int_equal(mark->closed, expected[i].closed);
            for (size_t k = 0; k < mark->count; k++) {
                assert_float_equal(hypot(mark->points[2 * k], mark->points[2 * k + 1]), expected[i].level,
                                   0.01);
            }
        }
    }
    gm_picture_close(picture);
}

static void marks_are_repeated(void **state)
{
    (void)state;
    struct gm_picture *picture = gm_picture_open();
    struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, ""),
                    *other = gm_panel_add(picture, GM_PLACE_STATE, "");
    static const double points[] = {0, 0, 1, 1};
    gm_mark_line(picture, panel, line_style, points, 2, false);
    const struct gm_mark *first = gm_mark_line(picture, panel, line_style, points, 2, true);
    const struct gm_mark *last = gm_mark_text(picture, panel, line_style, 0, 0, GM_ANCHOR_LEFT, "word");
    gm_mark_points(picture, panel, line_style, points, 2);
    gm_mark_points(picture, other, line_style, points, 1);
    gm_marks_repeat(picture, other, NULL, last);
    assert_int_equal(marks_of(other), 1);
    gm_marks_repeat(picture, other, first, last);
    assert_int_equal(marks_of(panel), 4);
    assert_int_equal(marks_of(other), 3);
    assert_true(other->first->next->closed);
    assert_ptr_equal(other->first->next->points, first->points);
    assert_string_equal(other->last->text, "word");
    gm_mark_points(picture, other, line_style, points, 2);
    assert_int_equal(marks_of(other), 4);
    assert_int_equal(marks_of(panel), 4);
    gm_picture_close(picture);
}

static void check_rounded(enum gm_scale scale, double low, double high, double round_low, double round_high)
{
    for (int again = 0; again < 2; again++) { /* rounding twice changes nothing */
        gm_range_round(&low, &high, scale);
        assert_float_equal(low, round_low, 1e-9 * fabs(round_low));
        assert_float_equal(high, round_high, 1e-9 * fabs(round_high));
    }
}

static void ranges_grow_in_calm_steps(void **state)
{
    (void)state;
    double low = 1.0, high = 0.0;
    gm_range_add(&low, &high, NAN);
    assert_true(low > high);
    gm_range_add(&low, &high, 3.0);
    gm_range_add(&low, &high, -INFINITY);
    gm_range_add(&low, &high, -1.5);
    assert_true(low == -1.5 && high == 3.0);
    check_rounded(GM_LINEAR, -1.5, 3.0, -2.0, 4.0);
    check_rounded(GM_LINEAR, 0.0, 9.3, 0.0, 10.0);
    check_rounded(GM_LINEAR, 5.0, 5.0, 4.5, 5.5);
    check_rounded(GM_LINEAR, 1.0, 0.0, 0.0, 1.0);
    check_rounded(GM_LOG, 3e-7, 0.02, 1e-7, 0.1);
    check_rounded(GM_LOG, 0.3, 3.2, 0.2, 5.0);
    check_rounded(GM_LOG, 0.0, 10.0, 1.0, 10.0);

    int changes = 0;
    double before = 0.0;
    for (int i = 1; i <= 1000; i++) {
        double from = 0.0, to = 0.1 * i;
        gm_range_round(&from, &to, GM_LINEAR);
        assert_true(from == 0.0 && to >= 0.1 * i - 1e-9);
        changes += to != before;
        before = to;
    }
    assert_true(changes < 30);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(marks_are_repeated),
        cmocka_unit_test(lines_break_where_they_cannot_be_drawn),
        cmocka_unit_test(closed_lines_open_at_a_gap),
        cmocka_unit_test(nothing_undrawable_reaches_painters),
        cmocka_unit_test(pictures_are_written_as_text),
        cmocka_unit_test(level_lines_are_whole_and_in_place),
        cmocka_unit_test(ranges_grow_in_calm_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
