/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "render/layout.h"

/* A font whose letters are all 0.6 em wide. */
static double measure(const void *self, enum gm_text_size size, const char *text)
{
    const struct gm_metrics *metrics = self;
    size_t letters = 0;
    for (; *text != '\0'; text++) {
        letters += ((unsigned char)*text & 0xc0) != 0x80;
    }
    return 0.6 / 1.17 * metrics->line[size] * (double)letters;
}

static struct gm_metrics metrics_of(double width, double height)
{
    static const double shares[GM_TEXT_SIZE_COUNT] = {0.036, 0.025, 0.022, 0.021};
    struct gm_metrics metrics = {.width = width, .height = height, .measure = measure};
    metrics.scale = fmin(height / 720.0, width / 960.0);
    metrics.terse = height < 540.0;
    for (int i = 0; i < GM_TEXT_SIZE_COUNT; i++) {
        metrics.line[i] = 1.17 * fmax(9.0, 720.0 * metrics.scale * shares[i]);
    }
    return metrics;
}

static struct gm_picture *picture_of(size_t states, size_t graphs, bool axes, bool bar)
{
    struct gm_picture *picture = gm_picture_open();
    assert_non_null(picture);
    picture->title = "A title that is long enough to meet the clock on narrow surfaces";
    picture->subtitle = "with a subtitle,  Δt = π/12";
    picture->clock = "t = 3π/2";
    picture->caption =
        "A sentence along the bottom, which is long enough to be broken where there is little room.";
    for (size_t i = 0; i < states; i++) {
        struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "symplectic Euler");
        panel->note = "area × 1.000";
        panel->equal = true;
        panel->axes = axes;
        panel->x = (struct gm_axis){"q", GM_LINEAR, -2, 2};
        panel->y = (struct gm_axis){"p", GM_LINEAR, -1.5, 1.5};
        if (bar) {
            panel->colour_bar = true;
            panel->colour_bar_label = "pollutant";
            gm_mark_image(picture, panel, GM_MAP_SEQUENTIAL, 0, 1000, (const double[]){-2, -1.5, 2, 1.5},
                          (const double[]){0, 1, 2, 3}, 2, 2);
        }
    }
    for (size_t i = 0; i < graphs; i++) {
        struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_GRAPH, "energy error  |H − H₀| / |H₀|");
        panel->x = (struct gm_axis){"t", GM_PI, 0, 1.5 * 3.14159265358979};
        panel->y = (struct gm_axis){"", i % 2 == 0 ? GM_LOG : GM_LINEAR, 1e-16, 10};
    }
    return picture;
}

static struct gm_box label_box(const struct gm_metrics *metrics, const struct gm_label *label)
{
    const double width = measure(metrics, label->size, label->text), line = metrics->line[label->size];
    if (label->vertical) {
        return (struct gm_box){label->x, label->y - 0.5 * width, line, width};
    }
    const double share = label->anchor == GM_ANCHOR_LEFT     ? 0.0
                         : label->anchor == GM_ANCHOR_CENTRE ? 0.5
                                                             : 1.0;
    return (struct gm_box){label->x - share * width, label->y, width, line};
}

static bool apart(struct gm_box a, struct gm_box b)
{
    const double touch = 1e-3;
    return a.x + a.width <= b.x + touch || b.x + b.width <= a.x + touch || a.y + a.height <= b.y + touch ||
           b.y + b.height <= a.y + touch;
}

static bool within(const struct gm_metrics *metrics, struct gm_box box)
{
    const double touch = 1e-3;
    return box.x >= -touch && box.y >= -touch && box.x + box.width <= metrics->width + touch &&
           box.y + box.height <= metrics->height + touch && box.width >= 0.0 && box.height >= 0.0;
}

static void check_layout(struct gm_picture *picture, struct gm_metrics *metrics)
{
    metrics->self = metrics;
    const struct gm_layout *layout = gm_layout_make(picture, metrics);
    assert_non_null(layout);
    for (size_t i = 0; i < layout->label_count; i++) {
        const struct gm_box box = label_box(metrics, &layout->labels[i]);
        assert_true(within(metrics, box));
        for (size_t k = 0; k < i; k++) {
            assert_true(apart(box, label_box(metrics, &layout->labels[k])));
        }
    }
    for (size_t i = 0; i < layout->frame_count; i++) {
        const struct gm_frame *frame = &layout->frames[i];
        assert_true(within(metrics, frame->box));
        assert_true(frame->x_tick_count <= 6 && frame->y_tick_count <= 6);
        for (size_t k = 0; k < i; k++) {
            assert_true(apart(frame->box, layout->frames[k].box));
        }
        /* No label but its own colour bar's stands on the data. */
        for (size_t k = 0; k < layout->label_count; k++) {
            assert_true(apart(frame->box, label_box(metrics, &layout->labels[k])));
        }
        if (frame->panel->equal) {
            assert_true(fabs(frame->x_factor + frame->y_factor) <= 1e-9 * fabs(frame->x_factor));
        }
    }
}

static void labels_never_overlap_nor_leave(void **state)
{
    (void)state;
    static const double sizes[][2] = {{1280, 720}, {640, 360},   {1920, 1080}, {3840, 2160}, {800, 600},
                                      {720, 1280}, {1000, 1000}, {540, 540},   {320, 200},   {64, 64},
                                      {1, 1},      {16384, 100}, {100, 16384}, {1280, 8},    {40, 700}};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        struct gm_metrics metrics = metrics_of(sizes[s][0], sizes[s][1]);
        for (size_t states = 0; states <= 24; states += states < 6 ? 1 : 6) {
            for (size_t graphs = 0; graphs <= 4; graphs++) {
                for (int kind = 0; kind < 4; kind++) {
                    struct gm_picture *picture = picture_of(states, graphs, kind & 1, kind & 2);
                    check_layout(picture, &metrics);
                    gm_picture_close(picture);
                }
            }
        }
    }
}

static const struct gm_label *find_label(const struct gm_layout *layout, const char *text)
{
    for (size_t i = 0; i < layout->label_count; i++) {
        if (strstr(layout->labels[i].text, text) != NULL) {
            return &layout->labels[i];
        }
    }
    return NULL;
}

static void a_usual_picture_has_all_its_texts(void **state)
{
    (void)state;
    struct gm_metrics metrics = metrics_of(1280, 720);
    metrics.self = &metrics;
    struct gm_picture *picture = picture_of(4, 2, false, false);
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    assert_non_null(layout);
    assert_int_equal(layout->frame_count, 6);
    size_t titles = 0, x_labels = 0;
    for (size_t i = 0; i < layout->label_count; i++) {
        titles += strcmp(layout->labels[i].text, "symplectic Euler") == 0;
        x_labels += strcmp(layout->labels[i].text, "t") == 0;
    }
    assert_int_equal(titles, 4);
    assert_int_equal(x_labels, 1); /* of the lowest graph alone */
    const struct gm_label *clock = find_label(layout, "t = 3π/2");
    assert_non_null(clock);
    assert_true(clock->mono && clock->anchor == GM_ANCHOR_RIGHT && clock->x > 1200.0);
    assert_non_null(find_label(layout, "with a subtitle"));
    assert_non_null(find_label(layout, "10⁻¹²"));

    /* Two by two states of one size on the left, graphs in line on the right. */
    const struct gm_frame *frames = layout->frames;
    assert_true(frames[1].box.x > frames[0].box.x && frames[2].box.x == frames[0].box.x);
    assert_true(frames[2].box.y > frames[0].box.y && frames[0].box.width == frames[3].box.width);
    assert_true(frames[0].x_factor == frames[3].x_factor);
    assert_true(frames[4].box.x == frames[5].box.x && frames[4].box.width == frames[5].box.width);
    assert_true(frames[4].box.x > frames[1].box.x + frames[1].box.width);
    for (int i = 4; i < 6; i++) {
        assert_true(frames[i].x_tick_count >= 3 && frames[i].y_tick_count >= 3);
    }
    gm_picture_close(picture);
}

static void terse_pictures_keep_one_graph(void **state)
{
    (void)state;
    struct gm_metrics metrics = metrics_of(640, 360);
    metrics.self = &metrics;
    struct gm_picture *picture = picture_of(2, 2, false, false);
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    assert_non_null(layout);
    assert_int_equal(layout->frame_count, 3);
    assert_null(find_label(layout, "with a subtitle"));
    assert_non_null(find_label(layout, "energy"));
    gm_picture_close(picture);
}

static void states_or_graphs_alone_take_the_width(void **state)
{
    (void)state;
    struct gm_metrics metrics = metrics_of(1280, 720);
    metrics.self = &metrics;
    for (int kind = 0; kind < 2; kind++) {
        struct gm_picture *picture = picture_of(kind == 0 ? 2 : 0, kind == 0 ? 0 : 1, false, false);
        const struct gm_layout *layout = gm_layout_make(picture, &metrics);
        assert_non_null(layout);
        const struct gm_box first = layout->frames[0].box, last = layout->frames[layout->frame_count - 1].box;
        assert_true(first.x < 150.0 && last.x + last.width > 1150.0);
        gm_picture_close(picture);
    }
}

static void coordinates_follow_the_axes(void **state)
{
    (void)state;
    struct gm_metrics metrics = metrics_of(1280, 720);
    metrics.self = &metrics;
    struct gm_picture *picture = picture_of(1, 1, true, false);
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    assert_non_null(layout);
    const struct gm_frame *state_frame = &layout->frames[0], *graph = &layout->frames[1];
    assert_float_equal(gm_frame_x(state_frame, -2), state_frame->box.x, 1e-6);
    assert_float_equal(gm_frame_y(state_frame, -1.5), state_frame->box.y + state_frame->box.height, 1e-6);
    assert_float_equal(gm_frame_y(graph, 10), graph->box.y, 1e-6);
    assert_float_equal(gm_frame_y(graph, 1e-16), graph->box.y + graph->box.height, 1e-6);
    for (size_t i = 0; i < graph->y_tick_count; i++) {
        assert_float_equal(gm_frame_y(graph, graph->y_ticks[i].value), graph->y_ticks[i].position, 1e-6);
    }
    gm_picture_close(picture);
}

/* A row of three is better than a grid with a hole, flat graphs below it make it larger, and what one panel
   has to say does not push its title out of line. */
static void three_states_stand_in_a_row(void **state)
{
    (void)state;
    struct gm_metrics metrics = metrics_of(1280, 720);
    metrics.self = &metrics;
    struct gm_picture *picture = picture_of(3, 2, false, false);
    picture->graphs_below = true;
    picture->first->note = "";
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    assert_non_null(layout);
    const struct gm_frame *frames = layout->frames;
    assert_true(frames[0].box.y == frames[1].box.y && frames[1].box.y == frames[2].box.y);
    assert_true(frames[3].box.y > frames[2].box.y + frames[2].box.height);
    assert_true(frames[3].box.y == frames[4].box.y);
    double title = NAN;
    for (size_t i = 0; i < layout->label_count; i++) {
        if (strcmp(layout->labels[i].text, "symplectic Euler") == 0) {
            assert_true(isnan(title) || layout->labels[i].y == title);
            title = layout->labels[i].y;
        }
    }
    assert_false(isnan(title));
    gm_picture_close(picture);

    /* also where a grid would make them a little larger */
    picture = picture_of(3, 1, false, false);
    for (struct gm_panel *panel = picture->first; panel->place == GM_PLACE_STATE; panel = panel->next) {
        panel->x.low = -1.6;
        panel->x.high = 1.6;
    }
    layout = gm_layout_make(picture, &metrics);
    assert_non_null(layout);
    assert_true(layout->frames[0].box.y == layout->frames[2].box.y);
    gm_picture_close(picture);
}

/* One colour bar for all takes its room once. */
static void a_bar_that_all_share_stands_beside_them(void **state)
{
    (void)state;
    struct gm_metrics metrics = metrics_of(1280, 720);
    metrics.self = &metrics;
    double width[2];
    for (int shared = 0; shared < 2; shared++) {
        struct gm_picture *picture = picture_of(2, 0, true, true);
        picture->state_columns = 2;
        picture->first->equal = picture->last->equal = false;
        picture->first->colour_bar = !shared;
        const struct gm_layout *layout = gm_layout_make(picture, &metrics);
        assert_non_null(layout);
        width[shared] = layout->frames[0].box.width;
        assert_true(layout->frames[0].box.width == layout->frames[1].box.width);
        const struct gm_box bar = layout->frames[1].colour_bar;
        assert_true(bar.width > 0.0 && bar.x > layout->frames[1].box.x + layout->frames[1].box.width);
        gm_picture_close(picture);
    }
    assert_true(width[1] > width[0] + 20.0);
}

/* Lanes that share a panel are all told there, however little room there is. */
static void every_key_is_told(void **state)
{
    (void)state;
    static const char *const names[] = {"Verlet", "variational, rectangle rule",
                                        "Δt = 0.1, blow-up at t = 2.5"};
    for (double width = 480; width <= 1920; width *= 2) {
        struct gm_metrics metrics = metrics_of(width, 0.5625 * width);
        struct gm_picture *picture = picture_of(2, 1, true, false);
        for (struct gm_panel *panel = picture->first; panel; panel = panel->next) {
            panel->note = panel->place == GM_PLACE_STATE ? "" : panel->note;
            for (size_t k = 0; k < 3 && panel->place == GM_PLACE_STATE; k++) {
                const struct gm_style style = {(enum gm_role)(GM_LANE + k), 1, 2, (enum gm_dash)k};
                gm_panel_key(picture, panel, style, names[k]);
            }
        }
        check_layout(picture, &metrics);
        const struct gm_layout *layout = gm_layout_make(picture, &metrics);
        size_t told[3] = {0};
        for (size_t i = 0; i < layout->label_count; i++) {
            for (size_t k = 0; k < 3; k++) {
                /* at least the line's sample and a beginning of the name */
                told[k] += layout->labels[i].role == (enum gm_role)(GM_LANE + k) &&
                           measure(&metrics, GM_TEXT_LABEL, layout->labels[i].text) >
                               measure(&metrics, GM_TEXT_LABEL, "─── Ve");
            }
        }
        for (size_t k = 0; k < 3; k++) {
            assert_int_equal(told[k], 2);
        }
        gm_picture_close(picture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(labels_never_overlap_nor_leave),
        cmocka_unit_test(a_usual_picture_has_all_its_texts),
        cmocka_unit_test(terse_pictures_keep_one_graph),
        cmocka_unit_test(states_or_graphs_alone_take_the_width),
        cmocka_unit_test(coordinates_follow_the_axes),
        cmocka_unit_test(three_states_stand_in_a_row),
        cmocka_unit_test(every_key_is_told),
        cmocka_unit_test(a_bar_that_all_share_stands_beside_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
