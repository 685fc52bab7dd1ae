/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Layouts on surfaces of any size: labels meet no other and stay inside, every lane has its key. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "render/layout/panel.h"
#include "tests/common/layout_faults.h"

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
        panel->x = (struct gm_axis){.label = "q", .scale = GM_LINEAR, .low = -2, .high = 2};
        panel->y = (struct gm_axis){.label = "p", .scale = GM_LINEAR, .low = -1.5, .high = 1.5};
        if (bar) {
            panel->colour_bar = true;
            panel->colour_bar_label = "pollutant";
            gm_mark_image(picture, panel, GM_MAP_SEQUENTIAL, 0, 1000, (const double[]){-2, -1.5, 2, 1.5},
                          (const double[]){0, 1, 2, 3}, 2, 2);
        }
    }
    for (size_t i = 0; i < graphs; i++) {
        struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_GRAPH, "energy error  |H − H₀| / |H₀|");
        panel->x = (struct gm_axis){.label = "t", .scale = GM_PI, .low = 0, .high = 1.5 * 3.14159265358979};
        panel->y =
            (struct gm_axis){.label = "", .scale = i % 2 == 0 ? GM_LOG : GM_LINEAR, .low = 1e-16, .high = 10};
    }
    return picture;
}

static void check_layout(struct gm_picture *picture, struct gm_metrics *metrics)
{
    const char *fault = layout_fault(picture, metrics);
    if (fault) {
        fail_msg("%s", fault);
    }
    metrics->self = metrics;
    const struct gm_layout *layout = gm_layout_make(picture, metrics);
    for (size_t i = 0; i < layout->frame_count; i++) {
        const struct gm_axes *frame = &layout->frames[i];
        assert_true(frame->x_tick_count <= 6 && frame->y_tick_count <= 6);
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
    for (size_t s = 0; s < GM_COUNT(sizes); s++) {
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
    const struct gm_axes *frames = layout->frames;
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
    const struct gm_axes *state_frame = &layout->frames[0], *graph = &layout->frames[1];
    assert_float_equal(gm_axes_x(state_frame, -2), state_frame->box.x, 1e-6);
    assert_float_equal(gm_axes_y(state_frame, -1.5), state_frame->box.y + state_frame->box.height, 1e-6);
    assert_float_equal(gm_axes_y(graph, 10), graph->box.y, 1e-6);
    assert_float_equal(gm_axes_y(graph, 1e-16), graph->box.y + graph->box.height, 1e-6);
    for (size_t i = 0; i < graph->y_tick_count; i++) {
        assert_float_equal(gm_axes_y(graph, graph->y_ticks[i].value), graph->y_ticks[i].position, 1e-6);
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
    const struct gm_axes *frames = layout->frames;
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

/* One that a panel has alone, as where the others have no such law, stands as far from the panel beside it as where
   each has its own. */
static void a_bar_of_one_panel_keeps_off_the_next(void **state)
{
    (void)state;
    for (double width = 640; width <= 1280; width *= 2) {
        struct gm_metrics metrics = metrics_of(width, 0.5625 * width);
        double apart[2];
        for (int alone = 0; alone < 2; alone++) {
            struct gm_picture *picture = picture_of(2, 0, true, true);
            picture->state_columns = 2;
            picture->first->equal = picture->last->equal = false;
            picture->last->colour_bar = !alone;
            check_layout(picture, &metrics);
            const struct gm_layout *layout = gm_layout_make(picture, &metrics);
            const struct gm_box bar = layout->frames[0].colour_bar;
            assert_true(bar.width > 0.0);
            apart[alone] = layout->frames[1].box.x - bar.x - bar.width;
            gm_picture_close(picture);
        }
        assert_float_equal(apart[1], apart[0], 1e-9);
    }
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
                           letters_width(&metrics, GM_TEXT_LABEL, layout->labels[i].text) >
                               letters_width(&metrics, GM_TEXT_LABEL, "─── Ve");
            }
        }
        for (size_t k = 0; k < 3; k++) {
            assert_true(told[k] >= 2); /* a long name may take lines */
        }
        gm_picture_close(picture);
    }
}

/* Names that do not fit side by side stand one below the other, whole. */
static void keys_take_lines(void **state)
{
    (void)state;
    static const char *const names[] = {"explicit Euler", "implicit Euler", "symplectic Euler", "midpoint"};
    struct gm_metrics metrics = metrics_of(960, 540);
    struct gm_picture *picture = picture_of(3, 1, true, false);
    for (struct gm_panel *panel = picture->first; panel; panel = panel->next) {
        panel->note = panel->place == GM_PLACE_STATE ? "" : panel->note;
        for (size_t k = 0; k < 4 && panel->place == GM_PLACE_STATE; k++) {
            const struct gm_style style = {(enum gm_role)(GM_LANE + k), 1, 2, (enum gm_dash)k};
            gm_panel_key(picture, panel, style, names[k]);
        }
    }
    check_layout(picture, &metrics);
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    for (size_t k = 0; k < 4; k++) {
        size_t told = 0;
        for (size_t i = 0; i < layout->label_count; i++) {
            told += layout->labels[i].role >= GM_LANE && strstr(layout->labels[i].text, names[k]) != NULL;
        }
        assert_int_equal(told, 3);
    }
    gm_picture_close(picture);
}

/* What a value is called gives way before it does; a scheme's name goes on below. */
static void keys_keep_their_values(void **state)
{
    (void)state;
    static const struct {
        const char *name, *values;
    } names[] = {{"Verlet, Δt = 0.1", "Verlet, 0.1"},
                 {"symplectic Euler, Δt = pi/12, q0 = 2.5", "symplectic Euler, pi/12, 2.5"},
                 {"Δt = 0.1, blow-up at t = 2.5", "0.1, blow-up at t = 2.5"},
                 {"Δt = 0.05", "0.05"},
                 {"Gauss 4", "Gauss 4"},
                 {"", ""}};
    char text[64];
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        gm_name_without_keys(names[i].name, text, sizeof text);
        assert_string_equal(text, names[i].values);
    }
    for (double width = 260; width <= 1280; width *= 1.3) {
        struct gm_metrics metrics = metrics_of(width, 720);
        struct gm_picture *picture = picture_of(3, 0, false, false);
        picture->state_columns = 3;
        for (struct gm_panel *panel = picture->first; panel; panel = panel->next) {
            panel->note = "";
            for (size_t k = 0; k < 2; k++) {
                const struct gm_style style = {(enum gm_role)(GM_LANE + k), 1, 2, (enum gm_dash)k};
                gm_panel_key(picture, panel, style, names[k].name);
            }
        }
        check_layout(picture, &metrics);
        const struct gm_layout *layout = gm_layout_make(picture, &metrics);
        static const char *const words[] = {"Verlet", "0.1", "symplectic", "Euler", "pi/12", "2.5"};
        for (size_t w = 0; w < GM_COUNT(words); w++) {
            size_t told = 0;
            for (size_t i = 0; i < layout->label_count; i++) {
                const struct gm_label *label = &layout->labels[i];
                told += label->role >= GM_LANE && label->size == GM_TEXT_LABEL &&
                        strstr(label->text, words[w]) != NULL;
                assert_true(label->role < GM_LANE || strstr(label->text, "…") == NULL);
                const size_t length = strlen(label->text); /* a value stands beside its key */
                assert_true(length < 2 || strcmp(label->text + length - 2, " =") != 0);
            }
            assert_int_equal(told, 3);
        }
        gm_picture_close(picture);
    }
}

/* That a lane failed gives way to what it is called, and takes no line of its own. */
static void failures_give_way(void **state)
{
    (void)state;
    static const char *const names[] = {"Δt = 0.1, blow-up at t = 2.5", "Δt = 0.05, lost: energy error 12"};
    struct gm_metrics metrics = metrics_of(300, 200);
    struct gm_picture *picture = picture_of(3, 0, false, false);
    picture->state_columns = 3;
    for (struct gm_panel *panel = picture->first; panel; panel = panel->next) {
        panel->note = "";
        for (size_t k = 0; k < 2; k++) {
            gm_panel_key(picture, panel, (struct gm_style){GM_LANE, 1, 2, GM_SOLID}, names[k]);
        }
    }
    check_layout(picture, &metrics);
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    assert_non_null(find_label(layout, "─── Δt = 0.1"));
    assert_non_null(find_label(layout, "─── Δt = 0.05"));
    gm_picture_close(picture);
}

/* The last words before a number give way to it; no part of a number is ever shown. */
static void numbers_are_whole(void **state)
{
    (void)state;
    static const struct {
        const char *text, *as_long_as, *shown;
    } cases[] = {
        {"energy error 4.2·10⁻¹³", "energy error 4.2·10⁻¹³", "energy error 4.2·10⁻¹³"},
        {"energy error 4.2·10⁻¹³", "energy… 4.2·10⁻¹³", "energy… 4.2·10⁻¹³"},
        {"energy error 4.2·10⁻¹³", "energy… 4.2·10⁻", "4.2·10⁻¹³"},
        {"energy error 4.2·10⁻¹³", "4.2·10⁻", ""},
        {"angle −0.25", "−0.25", "−0.25"},
        {"out of the picture, 12.3 from the sun", "the picture, 12.3", "out of the… 12.3"},
        {"out of the picture, 12.3 from the sun", "out of the picture, 12.3 from",
         "out of the picture, 12.3"},
        {"blow-up at t = 597.25", "blow-up at t = 59", "blow-up"},
        {"converges slowly", "converges", "converge…"},
    };
    struct gm_metrics metrics = metrics_of(960, 540);
    metrics.self = &metrics;
    struct gm_picture *picture = gm_picture_open();
    struct gm_label_list list;
    assert_true(gm_labels_open(&list, picture, &metrics, 8));
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        const double width = letters_width(metrics.self, GM_TEXT_LABEL, cases[i].as_long_as);
        size_t words = SIZE_MAX;
        assert_string_equal(gm_labels_shorten_number(&list, GM_TEXT_LABEL, cases[i].text, width, &words),
                            cases[i].shown);
    }
    /* the title of a state is larger than that of a graph */
    for (size_t graph = 0; graph < 2; graph++) {
        struct gm_panel panel = {.place = graph ? GM_PLACE_GRAPH : GM_PLACE_STATE, .title = "", .note = "a"};
        const double top = gm_border_of(&list, &panel, GM_DETAIL_ALL, true, false).top;
        panel.title = "a title";
        assert_true(fabs(gm_border_of(&list, &panel, GM_DETAIL_ALL, true, false).top - top -
                         metrics.line[graph ? GM_TEXT_LABEL : GM_TEXT_PANEL]) < 1e-9);
    }
    /* nor a part of a bracket */
    const char *const whole = "energy error  |H − H₀| / max(|H₀|, 1/2)";
    const double width = letters_width(metrics.self, GM_TEXT_LABEL, "energy error  |H − H₀| / max(|H₀|, 1");
    assert_string_equal(gm_labels_shorten(&list, GM_TEXT_LABEL, whole, width), "energy error");
    /* nor the name of what is explained after it */
    const char *const levels = "shapes every step;  grey: the circle of radius 1";
    const double narrow = letters_width(metrics.self, GM_TEXT_LABEL, "shapes every step;  grey: the circle");
    assert_string_equal(gm_labels_shorten(&list, GM_TEXT_LABEL, levels, narrow), "shapes every step");
    /* nor the comma before what is left out */
    const char *const mesh = "736 triangles, circumcentric star ≥ 0.056,  Δt = 0.005";
    const double short_of_step = letters_width(metrics.self, GM_TEXT_LABEL, mesh) - 1;
    assert_string_equal(gm_labels_shorten(&list, GM_TEXT_LABEL, mesh, short_of_step),
                        "736 triangles, circumcentric star ≥ 0.056");
    gm_picture_close(picture);
}

/* Titles that share what they begin with are told apart where there is no room for all of them. */
static void titles_are_told_apart(void **state)
{
    (void)state;
    struct gm_metrics metrics = metrics_of(300, 200);
    metrics.self = &metrics;
    struct gm_picture *picture = picture_of(3, 1, false, false);
    static const char *const titles[] = {"variational, rectangle", "variational, midpoint",
                                         "variational, box"};
    size_t k = 0;
    for (struct gm_panel *panel = picture->first; k < 3; panel = panel->next) {
        panel->title = titles[k++];
    }
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    assert_non_null(layout);
    assert_non_null(find_label(layout, "rectangle"));
    assert_non_null(find_label(layout, "midpoint"));
    assert_non_null(find_label(layout, "box"));
    gm_picture_close(picture);
}

/* What is left of a fork's name begins with the scheme at work. */
static void forks_keep_their_heads(void **state)
{
    (void)state;
    for (int wide = 120; wide <= 900; wide += 20) {
        struct gm_metrics metrics = metrics_of(wide, 300);
        metrics.self = &metrics;
        struct gm_picture *picture = picture_of(2, 0, false, false);
        picture->first->title = "midpoint, after explicit Euler";
        picture->first->next->title = "symplectic Euler, after explicit Euler";
        const struct gm_layout *layout = gm_layout_make(picture, &metrics);
        for (size_t i = 0, titles = 0; i < layout->label_count && titles == 0; i++) {
            titles += strstr(layout->labels[i].text, "Euler") || strstr(layout->labels[i].text, "after");
            assert_true(titles == 0 || strncmp(layout->labels[i].text, "mid", 3) == 0 ||
                        strncmp(layout->labels[i].text, "sym", 3) == 0);
        }
        gm_picture_close(picture);
    }
}

/* Two forks of one scheme never have the same name, however little room there is; the scheme before them may be
   named in the same way below. */
static void forks_differ(void **state)
{
    (void)state;
    static const char *const titles[] = {"step = 0.05", "step = 0.0025", "Euler box, after Zabusky-Kruskal",
                                         "projection, after Zabusky-Kruskal",
                                         "Fourier, after Zabusky-Kruskal"};
    for (int wide = 120; wide <= 900; wide += 10) {
        struct gm_metrics metrics = metrics_of(wide, 300);
        metrics.self = &metrics;
        struct gm_picture *picture = picture_of(GM_COUNT(titles), 1, false, false);
        struct gm_panel *panel = picture->first;
        for (size_t i = 0; i < GM_COUNT(titles); i++, panel = panel->next) {
            panel->title = titles[i];
        }
        const struct gm_layout *layout = gm_layout_make(picture, &metrics);
        for (size_t i = 0; i < layout->label_count; i++) {
            const char *text = layout->labels[i].text;
            const bool before = strncmp(text, "Zabusky", 7) == 0;
            for (size_t k = 0; k < i && strstr(text, "…") && !strstr(text, "area") && !before; k++) {
                assert_string_not_equal(layout->labels[k].text, text);
            }
        }
        gm_picture_close(picture);
    }
}

/* The label with a number, and what stands before that. */
static const char *before(const struct gm_layout *layout, const char *number, size_t *length)
{
    for (size_t i = 0; i < layout->label_count; i++) {
        const char *at = strstr(layout->labels[i].text, number);
        if (at) {
            *length = (size_t)(at - layout->labels[i].text);
            return layout->labels[i].text;
        }
    }
    return NULL;
}

/* Notes that tell numbers of one kind lose the same words, the last ones, however long the numbers are. */
static void notes_are_shortened_alike(void **state)
{
    (void)state;
    static const char whole[] = "energy error now ";
    size_t shortened = 0;
    for (int wide = 120; wide <= 900; wide += 10) {
        struct gm_metrics metrics = metrics_of(wide, 300);
        metrics.self = &metrics;
        struct gm_picture *picture = picture_of(2, 0, false, false);
        picture->first->note = "energy error now 0.24";
        picture->first->next->note = "energy error now 5.9·10⁻⁴";
        const struct gm_layout *layout = gm_layout_make(picture, &metrics);
        size_t length = 0, other_length = 0;
        const char *one = before(layout, "0.24", &length), *other = before(layout, "5.9·10⁻⁴", &other_length);
        if (one && other) {
            assert_int_equal(length, other_length);
            assert_memory_equal(one, other, length);
            const char *cut = strstr(one, "…");
            assert_true(length == 0 || strncmp(one, whole, cut ? (size_t)(cut - one) : length) == 0);
            shortened += cut != NULL;
        }
        gm_picture_close(picture);
    }
    assert_true(shortened > 0);
}

/* Titles of narrow panels go on below, as long as that costs less than cutting them; in line, and whole. */
static void titles_go_on_below(void **state)
{
    (void)state;
    struct gm_metrics metrics = metrics_of(420, 480);
    metrics.self = &metrics;
    struct gm_picture *picture = picture_of(3, 0, false, false);
    picture->state_columns = 3;
    static const char *const titles[] = {"one", "a Lobatto scheme of seven stages", "the symplectic Euler"};
    size_t k = 0;
    for (struct gm_panel *panel = picture->first; panel != NULL; panel = panel->next) {
        panel->title = titles[k++];
    }
    check_layout(picture, &metrics);
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    double top = NAN;
    for (k = 0; k < 3; k++) {
        const char *rest = titles[k];
        double y = NAN;
        for (size_t i = 0; i < layout->label_count; i++) {
            const struct gm_label *label = &layout->labels[i];
            const size_t length = strlen(label->text);
            if (*rest == '\0' || strncmp(rest, label->text, length) != 0) {
                continue;
            }
            assert_true(isnan(y) ? isnan(top) || label->y == top : label->y > y);
            top = isnan(y) ? label->y : top;
            y = label->y;
            rest += length + (rest[length] == ' ');
        }
        assert_string_equal(rest, "");
    }
    assert_null(find_label(layout, titles[1])); /* it did not fit into one line */
    gm_picture_close(picture);
}

/* Texts among the marks are labels: of two at one place the second moves. */
static void texts_among_marks_part(void **state)
{
    (void)state;
    struct gm_metrics metrics = metrics_of(640, 360);
    struct gm_picture *picture = picture_of(1, 0, true, false);
    for (int k = 0; k < 2; k++) {
        gm_mark_text(picture, picture->first, (struct gm_style){GM_INK, 1, 1, GM_SOLID}, 2, 0, GM_ANCHOR_LEFT,
                     k ? "second name" : "first name");
    }
    check_layout(picture, &metrics);
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    assert_non_null(find_label(layout, "first name"));
    assert_non_null(find_label(layout, "second name"));
    gm_picture_close(picture);
}

/* Where a text among the marks has no room it goes on below or is left out; it keeps a distance from the axis
   to its left, and half of it is never shown. */
static void notes_stay_in_their_frame(void **state)
{
    (void)state;
    static const char first[] = "Lax-Wendroff,", second[] = "invariant";
    size_t lines[3] = {0};
    for (double width = 70; width <= 1280; width *= 1.15) {
        struct gm_metrics metrics = metrics_of(width, 400);
        struct gm_picture *picture = picture_of(1, 0, false, false);
        picture->first->axes = true;
        picture->first->equal = false;
        gm_mark_text(picture, picture->first, (struct gm_style){GM_INK, 1, 1, GM_SOLID}, 1, 0, GM_ANCHOR_LEFT,
                     "Lax-Wendroff, invariant");
        check_layout(picture, &metrics);
        const struct gm_layout *layout = gm_layout_make(picture, &metrics);
        size_t shown = 0;
        bool parts[2] = {false, false};
        for (size_t i = 0; i < layout->label_count; i++) {
            const struct gm_label *label = &layout->labels[i];
            if (label->among_marks) {
                shown++;
                assert_true(label->x >= layout->frames[0].box.x + 0.25 * metrics.line[GM_TEXT_TICK]);
                parts[0] = parts[0] || strstr(label->text, first) != NULL;
                parts[1] = parts[1] || strstr(label->text, second) != NULL;
            }
        }
        assert_true(shown < 3 && parts[0] == (shown > 0) && parts[1] == (shown > 0));
        lines[shown]++;
        gm_picture_close(picture);
    }
    assert_true(lines[0] > 0 && lines[1] > 0 && lines[2] > 0);
}

/* A name left of a point near the axis moves off the axis; letters stand above the axis below them. */
static void names_keep_off_the_axes(void **state)
{
    (void)state;
    struct gm_metrics metrics = metrics_of(1280, 720);
    struct gm_picture *picture = picture_of(1, 0, true, false);
    gm_mark_text(picture, picture->first, (struct gm_style){GM_INK, 1, 1, GM_SOLID}, -1.9, -1.49,
                 GM_ANCHOR_RIGHT, "SABA 4");
    check_layout(picture, &metrics);
    const struct gm_layout *layout = gm_layout_make(picture, &metrics);
    const struct gm_label *name = find_label(layout, "SABA 4");
    const struct gm_box *box = &layout->frames[0].box;
    assert_non_null(name);
    assert_true(name->x >= box->x + 0.25 * metrics.line[GM_TEXT_TICK]);
    assert_true(name->y + metrics.line[GM_TEXT_TICK] <= box->y + box->height + 1e-9);
    gm_picture_close(picture);
}

/* A colour bar ends in a point where values lie beyond it. */
static void bars_point_at_what_is_beyond(void **state)
{
    (void)state;
    struct gm_metrics metrics = metrics_of(1280, 720);
    metrics.self = &metrics;
    for (int beyond = 0; beyond < 2; beyond++) {
        struct gm_picture *picture = picture_of(1, 0, true, false);
        picture->first->colour_bar = true;
        gm_mark_image(picture, picture->first, GM_MAP_SEQUENTIAL, 0, 1, (const double[]){-2, -1.5, 2, 1.5},
                      (const double[]){0, 0.5, 1, beyond ? 1.2 : 1.001}, 2, 2);
        const struct gm_layout *layout = gm_layout_make(picture, &metrics);
        assert_non_null(layout);
        const struct gm_axes *frame = &layout->frames[0];
        assert_true((frame->bar_tip[1] > 0) == (beyond == 1) && frame->bar_tip[0] == 0);
        assert_float_equal(frame->colour_bar.y - frame->bar_tip[1], frame->box.y, 1e-9);
        gm_picture_close(picture);
    }
}

/* A colour bar that is too short for its label has it smaller, or the symbol alone. */
static void short_bars_say_what_they_show(void **state)
{
    (void)state;
    size_t symbols = 0;
    for (double height = 40; height <= 720; height *= 1.1) {
        struct gm_metrics metrics = metrics_of(1280, height);
        metrics.self = &metrics;
        struct gm_picture *picture = picture_of(1, 0, true, false);
        picture->first->colour_bar = true;
        picture->first->colour_bar_label = "temperature θ";
        gm_mark_image(picture, picture->first, GM_MAP_SEQUENTIAL, 0, 1, (const double[]){-2, -1.5, 2, 1.5},
                      (const double[]){0, 0.5, 1, 1}, 2, 2);
        const struct gm_layout *layout = gm_layout_make(picture, &metrics);
        const bool bar = layout && layout->frame_count > 0 && layout->frames[0].bar_tick_count > 0;
        assert_true(!bar || find_label(layout, "θ"));
        symbols += bar && !find_label(layout, "temperature");
        gm_picture_close(picture);
    }
    assert_true(symbols > 0);
}

/* A note that is wider than the frame is broken where both lines end within the surface, if it can be: not where they
   would fit into the frame from its left end. */
static void notes_are_broken_beside_their_place(void **unused)
{
    (void)unused;
    size_t broken = 0;
    for (double width = 150; width <= 700; width *= 1.03) {
        for (double at = -2; at < 1; at += 0.125) {
            struct gm_metrics metrics = metrics_of(width, 400);
            metrics.self = &metrics;
            struct gm_picture *picture = picture_of(1, 0, false, false);
            picture->first->axes = true;
            picture->first->equal = false;
            gm_mark_text(picture, picture->first, (struct gm_style){GM_INK, 1, 1, GM_SOLID}, at, 0,
                         GM_ANCHOR_LEFT, "aaaaa bbbbb ccccc ddddd");
            const struct gm_layout *layout = gm_layout_make(picture, &metrics);
            const struct gm_axes *axes = &layout->frames[0];
            const double space = metrics.width - 0.3 * metrics.line[GM_TEXT_TICK] - gm_axes_x(axes, at);
            const double two = metrics.measure(&metrics, GM_TEXT_TICK, "aaaaa bbbbb"),
                         three = metrics.measure(&metrics, GM_TEXT_TICK, "aaaaa bbbbb ccccc"),
                         all = metrics.measure(&metrics, GM_TEXT_TICK, "aaaaa bbbbb ccccc ddddd");
            if (all > axes->box.width && three <= axes->box.width && two <= space && three > space) {
                assert_non_null(find_label(layout, "aaaaa bbbbb"));
                assert_non_null(find_label(layout, "ccccc ddddd"));
                broken++;
            }
            gm_picture_close(picture);
        }
    }
    assert_true(broken > 0);
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
        cmocka_unit_test(keys_take_lines),
        cmocka_unit_test(keys_keep_their_values),
        cmocka_unit_test(failures_give_way),
        cmocka_unit_test(numbers_are_whole),
        cmocka_unit_test(notes_are_shortened_alike),
        cmocka_unit_test(forks_keep_their_heads),
        cmocka_unit_test(forks_differ),
        cmocka_unit_test(titles_are_told_apart),
        cmocka_unit_test(titles_go_on_below),
        cmocka_unit_test(texts_among_marks_part),
        cmocka_unit_test(names_keep_off_the_axes),
        cmocka_unit_test(bars_point_at_what_is_beyond),
        cmocka_unit_test(notes_stay_in_their_frame),
        cmocka_unit_test(short_bars_say_what_they_show),
        cmocka_unit_test(notes_are_broken_beside_their_place),
        cmocka_unit_test(a_bar_that_all_share_stands_beside_them),
        cmocka_unit_test(a_bar_of_one_panel_keeps_off_the_next),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
