/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The painter of pixels by its pixels, with each of what draws its triangles. Exact values change with Mesa's
   version, so that only what must be true of any good painting is asked. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/basics.h"
#include "render/layout/panel.h"
#include "render/pixels/canvas.h"

enum { WIDTH = 640, HEIGHT = 600 };

static const char *const painters[] = {"own", "osmesa", "egl"};
enum { PAINTERS = GM_COUNT(painters) };
static const char *painter; /* of the tests that run */

/* A state panel alone, whose box is found from a painted frame: the range is shown around its middle. */
static struct gm_picture *plain_picture(struct gm_panel **panel)
{
    struct gm_picture *picture = gm_picture_open();
    assert_non_null(picture);
    *panel = gm_panel_add(picture, GM_PLACE_STATE, "");
    (*panel)->x = (struct gm_axis){.label = "", .scale = GM_LINEAR, .low = -1, .high = 1};
    (*panel)->y = (struct gm_axis){.label = "", .scale = GM_LINEAR, .low = -1, .high = 1};
    return picture;
}

static unsigned char *paint(struct gm_picture *picture, int width, int height)
{
    char message[GM_MESSAGE] = "";
    const struct gm_appearance look = {.width = width, .height = height, .theme = GM_THEME_DARK};
    struct gm_canvas *canvas = gm_canvas_choose(painter, message) ? gm_canvas_open(&look, message) : NULL;
    if (canvas == NULL) {
        fail_msg("%s", message);
    }
    unsigned char *rgb = malloc((size_t)width * (size_t)height * 3);
    assert_non_null(rgb);
    assert_true(gm_canvas_paint(canvas, picture, rgb));
    gm_canvas_close(canvas);
    return rgb;
}

static struct gm_rgb pixel(const unsigned char *rgb, int x, int y)
{
    const unsigned char *p = rgb + ((size_t)y * WIDTH + (size_t)x) * 3;
    return (struct gm_rgb){p[0], p[1], p[2]};
}

static int distance(struct gm_rgb a, struct gm_rgb b)
{
    return abs(a.r - b.r) + abs(a.g - b.g) + abs(a.b - b.b);
}

static struct gm_rgb role_colour(enum gm_role role)
{
    return gm_theme_colour(GM_THEME_DARK, role);
}

/* How far a pixel is from paper to the role's colour: 0 to 1, by the channel that differs most. */
static double share_of(struct gm_rgb seen, enum gm_role role)
{
    const struct gm_rgb paper = role_colour(GM_PAPER), ink = role_colour(role);
    return (double)distance(seen, paper) / distance(ink, paper);
}

/* Ink in a column of pixels between two rows. */
static double ink_of_column(const unsigned char *rgb, int x, int top, int bottom, enum gm_role role)
{
    double sum = 0.0;
    for (int y = top; y < bottom; y++) {
        sum += share_of(pixel(rgb, x, y), role);
    }
    return sum;
}

static double ink_of_all(const unsigned char *rgb, enum gm_role role)
{
    double sum = 0.0;
    for (int x = 0; x < WIDTH; x++) {
        sum += ink_of_column(rgb, x, 0, HEIGHT, role);
    }
    return sum;
}

/* Pixels for a pixel of a picture 720 high. */
static double scale_of(void)
{
    return fmin(WIDTH / 960.0, HEIGHT / 720.0);
}

static void strokes_have_their_width_colour_and_place(void **state)
{
    (void)state;
    double ink[2];
    for (int k = 0; k < 2; k++) {
        struct gm_panel *panel;
        struct gm_picture *picture = plain_picture(&panel);
        const struct gm_style style = {GM_INITIAL, 1.0, 6.0 * (k + 1), GM_SOLID};
        gm_mark_line(picture, panel, style, (const double[]){-1, 0, 1, 0}, 2, false);
        unsigned char *rgb = paint(picture, WIDTH, HEIGHT);
        ink[k] = ink_of_column(rgb, WIDTH / 2, 0, HEIGHT, GM_INITIAL);
        /* In the middle of the surface there is the line's own colour, and it is level. */
        int row = 0;
        while (row < HEIGHT && share_of(pixel(rgb, WIDTH / 2, row), GM_INITIAL) < 0.99) {
            row++;
        }
        assert_in_range(row, HEIGHT / 2 - 20, HEIGHT / 2 + 20);
        assert_true(distance(pixel(rgb, WIDTH / 2, row), role_colour(GM_INITIAL)) <= 3);
        assert_true(distance(pixel(rgb, WIDTH / 4, row), role_colour(GM_INITIAL)) <= 3);
        assert_int_equal(distance(pixel(rgb, WIDTH / 2, HEIGHT / 4), role_colour(GM_PAPER)), 0);
        free(rgb);
        gm_picture_close(picture);
    }
    assert_float_equal(ink[0], 6.0 * scale_of(), 0.1);
    assert_float_equal(ink[1], 12.0 * scale_of(), 0.1);
}

static void thin_and_slanting_strokes_have_their_width_too(void **state)
{
    (void)state;
    struct gm_panel *panel;
    struct gm_picture *picture = plain_picture(&panel);
    gm_mark_line(picture, panel, (struct gm_style){GM_INK, 1.0, 0.75, GM_SOLID},
                 (const double[]){-1, 0, 1, 0}, 2, false);
    unsigned char *rgb = paint(picture, WIDTH, HEIGHT);
    assert_float_equal(ink_of_column(rgb, WIDTH / 2, 0, HEIGHT, GM_INK), 0.5, 0.03);
    free(rgb);
    gm_picture_close(picture);

    picture = plain_picture(&panel);
    panel->equal = true;
    gm_mark_line(picture, panel, (struct gm_style){GM_INK, 1.0, 6.0, GM_SOLID},
                 (const double[]){-1, -1, 1, 1}, 2, false);
    rgb = paint(picture, WIDTH, HEIGHT);
    assert_float_equal(ink_of_column(rgb, WIDTH / 2, 0, HEIGHT, GM_INK), 4.0 * sqrt(2.0), 0.15);
    free(rgb);
    gm_picture_close(picture);
}

static void discs_and_polygons_have_their_area(void **state)
{
    (void)state;
    const double pi = 3.14159265358979;
    double circle[2 * 256], hook[2 * 256];
    for (int i = 0; i < 256; i++) {
        const double x = 0.5 * cos(i * pi / 128), y = 0.5 * sin(i * pi / 128);
        circle[2 * i] = x;
        circle[2 * i + 1] = y;
        hook[2 * i] = x; /* the same area, not convex */
        hook[2 * i + 1] = y + 3.0 * x * x - 0.4;
    }
    double area[2];
    for (int k = 0; k < 2; k++) {
        struct gm_panel *panel;
        struct gm_picture *picture = plain_picture(&panel);
        panel->equal = true;
        gm_mark_polygon(picture, panel, (struct gm_style){GM_LANE, 1.0, 0.0, GM_SOLID},
                        k == 0 ? circle : hook, 256);
        unsigned char *rgb = paint(picture, WIDTH, HEIGHT);
        area[k] = ink_of_all(rgb, GM_LANE);
        free(rgb);
        gm_picture_close(picture);
    }
    assert_true(area[0] > 10000.0);
    assert_float_equal(area[1], area[0], 0.01 * area[0]); /* edges fade outside by half a pixel on average */
    struct gm_panel *panel;
    struct gm_picture *picture = plain_picture(&panel);
    gm_mark_points(picture, panel, (struct gm_style){GM_LANE, 1.0, 30.0, GM_SOLID},
                   (const double[]){0.1, 0.1}, 1);
    unsigned char *rgb = paint(picture, WIDTH, HEIGHT);
    const double radius = 15.0 * scale_of();
    assert_float_equal(ink_of_all(rgb, GM_LANE), pi * radius * radius, 0.01 * pi * radius * radius);
    free(rgb);
    gm_picture_close(picture);
}

static void polygons_are_even_odd(void **state)
{
    (void)state;
    /* A pentagram: its middle lies outside. */
    double star[10];
    for (int i = 0; i < 5; i++) {
        star[2 * i] = 0.9 * sin(i * 4.0 * 3.14159265358979 / 5.0);
        star[2 * i + 1] = 0.9 * cos(i * 4.0 * 3.14159265358979 / 5.0);
    }
    struct gm_panel *panel;
    struct gm_picture *picture = plain_picture(&panel);
    gm_mark_polygon(picture, panel, (struct gm_style){GM_LANE, 1.0, 0.0, GM_SOLID}, star, 5);
    unsigned char *rgb = paint(picture, WIDTH, HEIGHT);
    assert_int_equal(distance(pixel(rgb, WIDTH / 2, HEIGHT / 2), role_colour(GM_PAPER)), 0);
    int filled = 0; /* the upper ray, above the middle */
    for (int y = 0; y < HEIGHT / 2; y++) {
        filled += distance(pixel(rgb, WIDTH / 2, y), role_colour(GM_LANE)) <= 3;
    }
    assert_true(filled > 50);
    free(rgb);
    gm_picture_close(picture);
}

static void translucent_lines_have_no_knots(void **state)
{
    (void)state;
    /* Sharp and gentle turns, and a crossing: nowhere darker than the line itself. */
    double zigzag[2 * 60];
    for (int i = 0; i < 60; i++) {
        zigzag[2 * i] = -0.9 + 0.03 * i;
        zigzag[2 * i + 1] = 0.8 * sin(2.1 * i);
    }
    for (int dash = GM_SOLID; dash <= GM_LONG_DASH; dash++) {
        struct gm_panel *panel;
        struct gm_picture *picture = plain_picture(&panel);
        gm_mark_line(picture, panel, (struct gm_style){GM_INK, 0.4, 8.0, (enum gm_dash)dash}, zigzag, 60,
                     false);
        unsigned char *rgb = paint(picture, WIDTH, HEIGHT);
        double most = 0.0;
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            most = fmax(most, share_of(pixel(rgb, i % WIDTH, i / WIDTH), GM_INK));
        }
        assert_true(most > 0.38 && most < 0.42);
        free(rgb);
        gm_picture_close(picture);
    }
}

/* As the adiabatic invariant of a stiff chain in a small picture: hundreds of swings in a few columns. */
static void what_zigzags_closely_fills_its_area(void **state)
{
    (void)state;
    enum { TURNS = 2000 };
    double zigzag[2 * TURNS];
    for (int i = 0; i < TURNS; i++) {
        zigzag[2 * i] = -0.5 + (double)i / TURNS;
        zigzag[2 * i + 1] = i % 2 ? 0.5 : -0.5;
    }
    for (double width = 0.5; width < 4.0; width *= 2) {
        struct gm_panel *panel;
        struct gm_picture *picture = plain_picture(&panel);
        gm_mark_line(picture, panel, (struct gm_style){GM_INK, 1.0, width, GM_SOLID}, zigzag, TURNS, false);
        unsigned char *rgb = paint(picture, WIDTH, HEIGHT);
        const double middle = share_of(pixel(rgb, WIDTH / 2, HEIGHT / 2), GM_INK);
        if (!(middle > 0.9)) { /* faint layers on each other end a little before, in 8 bits */
            fail_msg("a stroke of width %g leaves %g of the ground", width, 1 - middle);
        }
        free(rgb);
        gm_picture_close(picture);
    }
}

static void dashes_leave_out_what_they_say(void **state)
{
    (void)state;
    double inks[GM_DASH_COUNT];
    int gaps[GM_DASH_COUNT], row = 0;
    for (int dash = 0; dash < GM_DASH_COUNT; dash++) { /* the solid one first: it tells the row */
        struct gm_panel *panel;
        struct gm_picture *picture = plain_picture(&panel);
        gm_mark_line(picture, panel, (struct gm_style){GM_INK, 1.0, 6.0, (enum gm_dash)dash},
                     (const double[]){-1, 0, 1, 0}, 2, false);
        unsigned char *rgb = paint(picture, WIDTH, HEIGHT);
        inks[dash] = ink_of_all(rgb, GM_INK);
        while (dash == GM_SOLID && row < HEIGHT - 2 && share_of(pixel(rgb, WIDTH / 2, row), GM_INK) < 0.9) {
            row++;
        }
        gaps[dash] = 0;
        for (int x = 60; x < WIDTH - 60; x++) {
            gaps[dash] += share_of(pixel(rgb, x, row + 1), GM_INK) < 0.5 &&
                          share_of(pixel(rgb, x - 1, row + 1), GM_INK) >= 0.5;
        }
        free(rgb);
        gm_picture_close(picture);
    }
    assert_in_range(row, HEIGHT / 3, 2 * HEIGHT / 3);
    assert_int_equal(gaps[GM_SOLID], 0);
    for (int dash = 1; dash < GM_DASH_COUNT; dash++) {
        assert_true(gaps[dash] > 8);
        assert_true(inks[dash] < 0.85 * inks[GM_SOLID] && inks[dash] > 0.25 * inks[GM_SOLID]);
    }
    assert_true(gaps[GM_DOTS] > 2 * gaps[GM_LONG_DASH]);
}

static void marks_stay_in_their_panel(void **state)
{
    (void)state;
    struct gm_panel *panel;
    struct gm_picture *picture = plain_picture(&panel);
    gm_mark_line(picture, panel, (struct gm_style){GM_INK, 1.0, 3.0, GM_SOLID},
                 (const double[]){-1e300, -1e300, 1e300, 1e300, 0, 1e9, 0, -1e9}, 4, false);
    gm_mark_polygon(picture, panel, (struct gm_style){GM_LANE, 1.0, 0.0, GM_SOLID},
                    (const double[]){-50, -50, 50, -50, 50, 50, -50, 50}, 4);
    unsigned char *rgb = paint(picture, WIDTH, HEIGHT);
    for (int x = 0; x < WIDTH; x++) {
        assert_int_equal(distance(pixel(rgb, x, 2), role_colour(GM_PAPER)), 0);
        assert_int_equal(distance(pixel(rgb, x, HEIGHT - 3), role_colour(GM_PAPER)), 0);
    }
    assert_true(distance(pixel(rgb, WIDTH / 2, HEIGHT / 2), role_colour(GM_LANE)) <= 3);
    free(rgb);
    gm_picture_close(picture);
}

static void fields_are_mapped_at_every_pixel(void **state)
{
    (void)state;
    const double corners[] = {-1, -1, 1, -1, 1, 1, -1, 1}, values[] = {0, 1, 1, 0};
    for (int image = 0; image < 2; image++) {
        struct gm_panel *panel;
        struct gm_picture *picture = plain_picture(&panel);
        if (image) {
            gm_mark_image(picture, panel, GM_MAP_SEQUENTIAL, 0, 1, (const double[]){-1, -1, 1, 1},
                          (const double[]){-0.5, 1.5}, 1, 2);
        } else {
            gm_mark_mesh(picture, panel, GM_MAP_SEQUENTIAL, 0, 1, corners, values, 4,
                         (const int[]){0, 1, 2, 0, 2, 3}, 2);
        }
        unsigned char *rgb = paint(picture, WIDTH, HEIGHT);
        /* Half way it has the map's middle colour, not the mean of its ends. */
        const struct gm_rgb middle = gm_colour_map_at(GM_MAP_SEQUENTIAL, GM_THEME_DARK, 0.5);
        assert_true(distance(pixel(rgb, WIDTH / 2, HEIGHT / 2), middle) <= 12);
        assert_true(distance(pixel(rgb, WIDTH / 2, HEIGHT / 3), middle) <= 12);
        assert_true(distance(pixel(rgb, 40, HEIGHT / 2),
                             gm_colour_map_at(GM_MAP_SEQUENTIAL, GM_THEME_DARK, 0.0)) <= 60);
        free(rgb);
        gm_picture_close(picture);
    }
}

static struct gm_picture *full_picture(void)
{
    struct gm_picture *picture = gm_picture_open();
    picture->title = "A disc of initial conditions";
    picture->subtitle = "harmonic oscillator,  Δt = π/12";
    picture->clock = "t = 3π/2";
    for (size_t lane = 0; lane < 4; lane++) {
        struct gm_panel *panel = gm_panel_add(picture, GM_PLACE_STATE, "midpoint");
        panel->title_role = gm_lane_role(lane);
        panel->equal = true;
        panel->x.low = panel->y.low = -1.0;
        double circle[2 * 128];
        for (int i = 0; i < 128; i++) {
            circle[2 * i] = 0.6 * cos(i * 3.14159265358979 / 64);
            circle[2 * i + 1] =
                0.6 * sin(i * 3.14159265358979 / 64) + 0.6 * (double)lane * circle[2 * i] * circle[2 * i];
        }
        gm_mark_polygon(picture, panel, (struct gm_style){gm_lane_role(lane), 0.3, 0, GM_SOLID}, circle, 128);
        gm_mark_line(picture, panel, (struct gm_style){gm_lane_role(lane), 0.7, 2, gm_lane_dash(lane)},
                     circle, 128, true);
        gm_mark_text(picture, panel, (struct gm_style){GM_INK, 1, 1, GM_SOLID}, 0, 0, GM_ANCHOR_CENTRE, "θ");
    }
    struct gm_panel *graph = gm_panel_add(picture, GM_PLACE_GRAPH, "energy error");
    graph->x = (struct gm_axis){.label = "t", .scale = GM_PI, .low = 0, .high = 4.8};
    graph->y = (struct gm_axis){.label = "", .scale = GM_LOG, .low = 1e-16, .high = 1};
    gm_mark_line(picture, graph, (struct gm_style){GM_LANE, 1, 2.4, GM_SOLID},
                 (const double[]){0, 1e-16, 4.8, 1}, 2, false);
    return picture;
}

static void all_painters_paint_the_same(void **state)
{
    (void)state;
    struct gm_picture *picture = full_picture();
    unsigned char *painted[PAINTERS];
    for (int p = 0; p < PAINTERS; p++) {
        painter = painters[p];
        painted[p] = paint(picture, WIDTH, HEIGHT);
        long different = 0, inked = 0;
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            const struct gm_rgb a = pixel(painted[0], i % WIDTH, i / WIDTH),
                                b = pixel(painted[p], i % WIDTH, i / WIDTH);
            different += distance(a, b) > 24;
            inked += distance(a, role_colour(GM_PAPER)) > 24;
        }
        assert_true(inked > WIDTH * HEIGHT / 50);
        assert_true(different < inked / 200);
    }
    for (int p = 0; p < PAINTERS; p++) {
        free(painted[p]);
    }
    gm_picture_close(picture);
}

/* Translucent triangles that lie beside each other, with corners anywhere: what two of them share is painted once,
   neither left out nor painted twice. */
static void triangles_of_a_mesh_meet(void **state)
{
    (void)state;
    enum { SIDE = 40, VERTICES = SIDE * SIDE, TRIANGLES = 2 * (SIDE - 1) * (SIDE - 1) };
    static double points[2 * VERTICES], values[VERTICES];
    static int triangles[3 * TRIANGLES];
    uint32_t noise = 1;
    for (int i = 0; i < VERTICES; i++) {
        for (int k = 0; k < 2; k++) {
            const int place = k == 0 ? i % SIDE : i / SIDE;
            noise = noise * UINT32_C(1664525) + UINT32_C(1013904223);
            const double moved =
                place > 0 && place < SIDE - 1 ? 0.4 * ((double)noise / UINT32_MAX - 0.5) : 0.0;
            points[2 * i + k] = -1.0 + 2.0 * (place + moved) / (SIDE - 1);
        }
    }
    for (int i = 0, n = 0; i < VERTICES; i++) {
        if (i % SIDE < SIDE - 1 && i / SIDE < SIDE - 1) {
            const int cell[] = {i, i + 1, i + SIDE, i + 1, i + SIDE + 1, i + SIDE};
            memcpy(triangles + n, cell, sizeof cell);
            n += 6;
        }
    }
    struct gm_panel *panel;
    struct gm_picture *picture = plain_picture(&panel);
    struct gm_mark *mesh = gm_mark_mesh(picture, panel, GM_MAP_SEQUENTIAL, -1, 0, points, values, VERTICES,
                                        triangles, TRIANGLES);
    mesh->style.alpha = 0.5;
    unsigned char *rgb = paint(picture, WIDTH, HEIGHT);
    const struct gm_rgb middle = pixel(rgb, WIDTH / 2, HEIGHT / 2), paper = role_colour(GM_PAPER);
    assert_true(distance(middle, paper) > 24);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        if (x > WIDTH / 4 && x < 3 * WIDTH / 4 && y > HEIGHT / 4 && y < 3 * HEIGHT / 4) {
            assert_int_equal(distance(pixel(rgb, x, y), middle), 0);
        }
    }
    free(rgb);
    gm_picture_close(picture);
}

static void a_canvas_paints_the_same_twice(void **state)
{
    (void)state;
    char message[GM_MESSAGE];
    assert_true(gm_canvas_choose(painter, message));
    struct gm_canvas *canvas = gm_canvas_open(
        &(struct gm_appearance){.width = WIDTH, .height = HEIGHT, .theme = GM_THEME_LIGHT}, message);
    assert_non_null(canvas);
    assert_ptr_equal(strstr(gm_canvas_backend(canvas), painter), gm_canvas_backend(canvas));
    const size_t size = (size_t)WIDTH * HEIGHT * 3;
    unsigned char *first = malloc(size), *second = malloc(size);
    for (int i = 0; i < 3; i++) {
        struct gm_picture *picture = full_picture();
        assert_true(gm_canvas_paint(canvas, picture, i == 0 ? first : second));
        gm_picture_close(picture);
        assert_true(i == 0 || memcmp(first, second, size) == 0);
    }
    free(first);
    free(second);
    gm_canvas_close(canvas);
}

static void odd_sizes_are_painted(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1},   {4, 1},    {64, 64},    {3, 500},
                                   {5, 500}, {2000, 7}, {16384, 20}, {100, 900}};
    for (size_t i = 0; i < GM_COUNT(sizes); i++) {
        const bool is_narrow =
            sizes[i][0] < 4 && strcmp(painter, "own") == 0; /* it puts four pixels at a time */
        if (is_narrow) {
            char message[GM_MESSAGE] = "";
            assert_true(gm_canvas_choose(painter, message));
            assert_null(gm_canvas_open(&(struct gm_appearance){.width = sizes[i][0], .height = sizes[i][1]},
                                       message));
            assert_non_null(strstr(message, "the width at least 4"));
            continue;
        }
        struct gm_picture *picture = full_picture();
        free(paint(picture, sizes[i][0], sizes[i][1]));
        gm_picture_close(picture);
    }
}

static void what_cannot_be_is_said_in_a_sentence(void **state)
{
    (void)state;
    char message[GM_MESSAGE] = "";
    assert_true(gm_canvas_choose(painter, message));
    assert_null(gm_canvas_open(
        &(struct gm_appearance){.width = 1 << 20, .height = 64, .theme = GM_THEME_DARK}, message));
    assert_non_null(strstr(message, "1048576 x 64"));
    assert_null(
        gm_canvas_open(&(struct gm_appearance){.width = 0, .height = 64, .theme = GM_THEME_DARK}, message));
}

/* What paints a picture, up to its versions. */
static void assert_paints(const char *word, const char *variable, bool live, const char *painter_of_it)
{
    char message[GM_MESSAGE] = "";
    setenv("GEOMINT_PAINTER", variable, 1);
    assert_true(gm_canvas_choose(word, message));
    struct gm_canvas *canvas =
        gm_canvas_open(&(struct gm_appearance){.width = 64, .height = 64, .live = live}, message);
    assert_non_null(canvas);
    const char *backend = gm_canvas_backend(canvas);
    assert_int_equal(strcspn(backend, ","), strlen(painter_of_it));
    assert_memory_equal(backend, painter_of_it, strlen(painter_of_it));
    gm_canvas_close(canvas);
}

static void painters_are_chosen(void **state)
{
    (void)state;
    char message[GM_MESSAGE] = "";
    assert_paints(NULL, "", false, "osmesa");
    assert_paints(NULL, "", true, "own");
    assert_paints(NULL, "auto", false, "osmesa");
    assert_paints(NULL, "own", false, "own");
    assert_paints(NULL, "osmesa", true, "osmesa");
    assert_paints("auto", "own", false, "osmesa");
    assert_paints("egl", "own", false, "egl");
    assert_false(gm_canvas_choose("vulkan", message));
    assert_string_equal(
        message, "\"vulkan\" is not a painter: --painter and GEOMINT_PAINTER take auto, osmesa, egl or own");
    setenv("GEOMINT_PAINTER", "OSMesa", 1);
    assert_false(gm_canvas_choose(NULL, message));
    assert_non_null(strstr(message, "\"OSMesa\" is not a painter"));
    unsetenv("GEOMINT_PAINTER");
    /* a driver for a graphics card, of which OSMesa has none */
    setenv("GALLIUM_DRIVER", "d3d12", 1);
    assert_paints(NULL, "", false, "own");
    assert_false(gm_canvas_choose("osmesa", message));
    assert_non_null(strstr(message, "osmesa cannot be loaded (it has no driver d3d12"));
    unsetenv("GALLIUM_DRIVER");
    unsetenv("GEOMINT_PAINTER");
}

/* One context has canvases of two sizes and themes, and one of them goes. */
static void pictures_of_two_sizes_take_turns(void **state)
{
    (void)state;
    enum { LOOKS = 2, SIZE = WIDTH * HEIGHT * 3 };
    const struct gm_appearance looks[LOOKS] = {
        {.width = WIDTH, .height = HEIGHT, .theme = GM_THEME_DARK},
        {.width = HEIGHT, .height = WIDTH, .theme = GM_THEME_LIGHT},
    };
    for (int p = 1; p < PAINTERS; p++) {
        char message[GM_MESSAGE];
        unsigned char *alone[LOOKS], *rgb = malloc(SIZE);
        struct gm_canvas *canvases[LOOKS];
        struct gm_picture *picture = full_picture();
        gm_mark_image(picture, gm_panel_add(picture, GM_PLACE_STATE, ""), GM_MAP_SEQUENTIAL, 0, 1,
                      (const double[]){-1, -1, 1, 1}, (const double[]){-0.5, 1.5}, 1, 2);
        assert_true(gm_canvas_choose(painters[p], message));
        for (int i = 0; i < LOOKS; i++) {
            alone[i] = malloc(SIZE);
            struct gm_canvas *canvas = gm_canvas_open(&looks[i], message);
            assert_true(gm_canvas_paint(canvas, picture, alone[i]));
            gm_canvas_close(canvas);
        }
        for (int i = 0; i < LOOKS; i++) {
            canvases[i] = gm_canvas_open(&looks[i], message);
            assert_non_null(canvases[i]);
        }
        for (int k = 0; k < 5; k++) {
            const int i = k < 4 ? k % LOOKS : 0;
            if (k == 4) {
                gm_canvas_close(canvases[1]);
            }
            assert_true(gm_canvas_paint(canvases[i], picture, rgb));
            assert_memory_equal(rgb, alone[i], SIZE);
        }
        gm_canvas_close(canvases[0]);
        gm_picture_close(picture);
        free(alone[0]);
        free(alone[1]);
        free(rgb);
    }
}

static int without_screen(void **state)
{
    (void)state;
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strokes_have_their_width_colour_and_place),
        cmocka_unit_test(thin_and_slanting_strokes_have_their_width_too),
        cmocka_unit_test(discs_and_polygons_have_their_area),
        cmocka_unit_test(polygons_are_even_odd),
        cmocka_unit_test(translucent_lines_have_no_knots),
        cmocka_unit_test(what_zigzags_closely_fills_its_area),
        cmocka_unit_test(dashes_leave_out_what_they_say),
        cmocka_unit_test(marks_stay_in_their_panel),
        cmocka_unit_test(fields_are_mapped_at_every_pixel),
        cmocka_unit_test(triangles_of_a_mesh_meet),
        cmocka_unit_test(a_canvas_paints_the_same_twice),
        cmocka_unit_test(odd_sizes_are_painted),
        cmocka_unit_test(what_cannot_be_is_said_in_a_sentence),
    };
    const struct CMUnitTest together[] = {
        cmocka_unit_test(all_painters_paint_the_same),
        cmocka_unit_test(painters_are_chosen),
        cmocka_unit_test(pictures_of_two_sizes_take_turns),
    };
    int failed = cmocka_run_group_tests(together, without_screen, NULL);
    for (int p = 0; p < PAINTERS; p++) {
        painter = painters[p];
        failed += cmocka_run_group_tests_name(painter, tests, without_screen, NULL);
    }
    return failed;
}
