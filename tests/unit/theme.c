/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Colours measured: lanes differ for every eye and stand out from paper, maps rise evenly in lightness. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "core/basics.h"
#include "render/layout/appearance.h"

#define PI 3.14159265358979323846

struct lab {
    double l, a, b;
};

static double linear_of(uint8_t value)
{
    const double c = value / 255.0;
    return c <= 0.04045 ? c / 12.92 : pow((c + 0.055) / 1.055, 2.4);
}

static double f_of(double t)
{
    return t > 216.0 / 24389.0 ? cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
}

/* CIELAB (D65) of linear RGB. */
static struct lab lab_of(const double rgb[3])
{
    const double x = 0.4124564 * rgb[0] + 0.3575761 * rgb[1] + 0.1804375 * rgb[2];
    const double y = 0.2126729 * rgb[0] + 0.7151522 * rgb[1] + 0.0721750 * rgb[2];
    const double z = 0.0193339 * rgb[0] + 0.1191920 * rgb[1] + 0.9503041 * rgb[2];
    const double fx = f_of(x / 0.95047), fy = f_of(y), fz = f_of(z / 1.08883);
    return (struct lab){116.0 * fy - 16.0, 500.0 * (fx - fy), 200.0 * (fy - fz)};
}

enum vision { NORMAL, PROTANOPIA, DEUTERANOPIA, VISION_COUNT };

/* Machado, Oliveira & Fernandes, A physiologically-based model for simulation of color vision deficiency
   (2009), severity 1. */
static const double simulations[VISION_COUNT][3][3] = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}},
    {{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}},
};

static struct lab seen(struct gm_rgb colour, enum vision vision)
{
    const double rgb[3] = {linear_of(colour.r), linear_of(colour.g), linear_of(colour.b)};
    double changed[3];
    for (int i = 0; i < 3; i++) {
        const double *row = simulations[vision][i];
        changed[i] = fmin(1.0, fmax(0.0, row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2]));
    }
    return lab_of(changed);
}

static double radians(double degrees)
{
    return degrees * PI / 180.0;
}

static double hue_of(double b, double a)
{
    const double hue = a == 0.0 && b == 0.0 ? 0.0 : atan2(b, a) * 180.0 / PI;
    return hue < 0.0 ? hue + 360.0 : hue;
}

/* CIEDE2000, after Sharma, Wu & Dalal (2005). */
static double difference(struct lab p, struct lab q)
{
    const double pow25 = pow(25.0, 7.0);
    const double c_mean = 0.5 * (hypot(p.a, p.b) + hypot(q.a, q.b)), c7 = pow(c_mean, 7.0);
    const double g = 0.5 * (1.0 - sqrt(c7 / (c7 + pow25)));
    const double a1 = (1.0 + g) * p.a, a2 = (1.0 + g) * q.a;
    const double c1 = hypot(a1, p.b), c2 = hypot(a2, q.b);
    const double h1 = hue_of(p.b, a1), h2 = hue_of(q.b, a2);
    double turn = c1 * c2 == 0.0 ? 0.0 : h2 - h1;
    turn += turn > 180.0 ? -360.0 : turn < -180.0 ? 360.0 : 0.0;
    const double dl = q.l - p.l, dc = c2 - c1, dh = 2.0 * sqrt(c1 * c2) * sin(radians(0.5 * turn));
    const double l = 0.5 * (p.l + q.l), c = 0.5 * (c1 + c2);
    double h = h1 + h2;
    if (c1 * c2 != 0.0) {
        h = fabs(h1 - h2) <= 180.0 ? 0.5 * h : h < 360.0 ? 0.5 * (h + 360.0) : 0.5 * (h - 360.0);
    }
    const double t = 1.0 - 0.17 * cos(radians(h - 30.0)) + 0.24 * cos(radians(2.0 * h)) +
                     0.32 * cos(radians(3.0 * h + 6.0)) - 0.20 * cos(radians(4.0 * h - 63.0));
    const double turned = 30.0 * exp(-pow((h - 275.0) / 25.0, 2.0)), m7 = pow(c, 7.0);
    const double sl = 1.0 + 0.015 * pow(l - 50.0, 2.0) / sqrt(20.0 + pow(l - 50.0, 2.0));
    const double sc = 1.0 + 0.045 * c, sh = 1.0 + 0.015 * c * t;
    const double rt = -sin(radians(2.0 * turned)) * 2.0 * sqrt(m7 / (m7 + pow25));
    const double u = dl / sl, v = dc / sc, w = dh / sh;
    return sqrt(u * u + v * v + w * w + rt * v * w);
}

static void the_difference_is_that_of_the_published_pairs(void **state)
{
    (void)state;
    static const struct {
        struct lab p, q;
        double expected;
    } pairs[] = {
        {{50.0000, 2.6772, -79.7751}, {50.0000, 0.0000, -82.7485}, 2.0425},
        {{50.0000, 2.5000, 0.0000}, {56.0000, -27.0000, -3.0000}, 31.9030},
        {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
        {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
        {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
    };
    for (size_t i = 0; i < GM_COUNT(pairs); i++) {
        assert_float_equal(difference(pairs[i].p, pairs[i].q), pairs[i].expected, 1e-4);
    }
}

static double contrast(struct gm_rgb colour, struct gm_rgb paper)
{
    double y[2];
    const struct gm_rgb both[2] = {colour, paper};
    for (int i = 0; i < 2; i++) {
        y[i] = 0.2126 * linear_of(both[i].r) + 0.7152 * linear_of(both[i].g) + 0.0722 * linear_of(both[i].b);
    }
    return (fmax(y[0], y[1]) + 0.05) / (fmin(y[0], y[1]) + 0.05);
}

static void lanes_differ_for_every_eye(void **state)
{
    (void)state;
    for (int theme = 0; theme < GM_THEME_COUNT; theme++) {
        double least = INFINITY;
        for (int vision = 0; vision < VISION_COUNT; vision++) {
            for (size_t i = 0; i < GM_LANE_COLOURS; i++) {
                for (size_t k = 0; k < i; k++) {
                    const struct gm_rgb a = gm_theme_colour((enum gm_theme)theme, gm_lane_role(i));
                    const struct gm_rgb b = gm_theme_colour((enum gm_theme)theme, gm_lane_role(k));
                    least =
                        fmin(least, difference(seen(a, (enum vision)vision), seen(b, (enum vision)vision)));
                }
            }
        }
        print_message("theme %d: least difference of two lanes %.1f\n", theme, least);
        assert_true(least >= 12.0);
    }
}

static void lanes_and_texts_stand_out_from_the_paper(void **state)
{
    (void)state;
    for (int i = 0; i < GM_THEME_COUNT; i++) {
        const enum gm_theme theme = (enum gm_theme)i;
        const struct gm_rgb paper = gm_theme_colour(theme, GM_PAPER), ink = gm_theme_colour(theme, GM_INK);
        assert_true(contrast(ink, paper) > 12.0);
        assert_true(contrast(gm_theme_colour(theme, GM_SECONDARY), paper) > 4.5);
        assert_true(contrast(gm_theme_colour(theme, GM_INITIAL), paper) > 4.0);
        for (size_t lane = 0; lane < GM_LANE_COLOURS; lane++) {
            const struct gm_rgb colour = gm_theme_colour(theme, gm_lane_role(lane));
            const struct gm_rgb red = gm_theme_colour(theme, GM_INITIAL);
            assert_true(contrast(colour, paper) > 2.95);
            assert_true(difference(seen(colour, NORMAL), seen(ink, NORMAL)) > 12.0);
            assert_true(difference(seen(colour, NORMAL), seen(red, NORMAL)) > 10.0);
        }
    }
}

static double lightness(enum gm_colour_map map, enum gm_theme theme, double x)
{
    return seen(gm_colour_map_at(map, theme, x), NORMAL).l;
}

static void maps_have_monotone_lightness(void **state)
{
    (void)state;
    const double rounding = 0.35; /* of 8 bits a channel, as lightness */
    for (int i = 0; i < GM_THEME_COUNT; i++) {
        const enum gm_theme theme = (enum gm_theme)i;
        const double outwards = theme == GM_THEME_LIGHT ? -1.0 : 1.0; /* from the diverging map's middle */
        for (int k = 1; k <= 255; k++) {
            const double from = (k - 1) / 255.0, to = k / 255.0;
            const double rise =
                lightness(GM_MAP_SEQUENTIAL, theme, to) - lightness(GM_MAP_SEQUENTIAL, theme, from);
            assert_true(rise > -rounding && rise < 1.0);
            const double side = to <= 0.5 ? -outwards : from >= 0.5 ? outwards : 0.0;
            const double step =
                lightness(GM_MAP_DIVERGING, theme, to) - lightness(GM_MAP_DIVERGING, theme, from);
            assert_true(side == 0.0 || side * step > -rounding);
        }
        assert_true(lightness(GM_MAP_SEQUENTIAL, theme, 1.0) - lightness(GM_MAP_SEQUENTIAL, theme, 0.0) >
                    85.0);
        const struct lab middle = seen(gm_colour_map_at(GM_MAP_DIVERGING, theme, 0.5), NORMAL);
        assert_true(hypot(middle.a, middle.b) < 3.0);
        assert_float_equal(lightness(GM_MAP_DIVERGING, theme, 0.0), lightness(GM_MAP_DIVERGING, theme, 1.0),
                           4.0);
        assert_true(fabs(middle.l - lightness(GM_MAP_DIVERGING, theme, 0.0)) > 50.0);
    }
}

static void maps_are_even_and_clamped(void **state)
{
    (void)state;
    for (int map = 0; map < 2; map++) {
        for (int theme = 0; theme < GM_THEME_COUNT; theme++) {
            double least = INFINITY, most = 0.0;
            for (int k = 1; k <= 16; k++) {
                const struct lab a = seen(
                    gm_colour_map_at((enum gm_colour_map)map, (enum gm_theme)theme, (k - 1) / 16.0), NORMAL);
                const struct lab b =
                    seen(gm_colour_map_at((enum gm_colour_map)map, (enum gm_theme)theme, k / 16.0), NORMAL);
                least = fmin(least, difference(a, b));
                most = fmax(most, difference(a, b));
            }
            assert_true(most < 3.5 * least);
            const struct gm_rgb low = gm_colour_map_at((enum gm_colour_map)map, (enum gm_theme)theme, 0.0);
            const struct gm_rgb below = gm_colour_map_at((enum gm_colour_map)map, (enum gm_theme)theme, -7.0);
            const struct gm_rgb none = gm_colour_map_at((enum gm_colour_map)map, (enum gm_theme)theme, NAN);
            assert_memory_equal(&low, &below, sizeof low);
            assert_memory_equal(&low, &none, sizeof low);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_difference_is_that_of_the_published_pairs),
        cmocka_unit_test(lanes_differ_for_every_eye),
        cmocka_unit_test(lanes_and_texts_stand_out_from_the_paper),
        cmocka_unit_test(maps_have_monotone_lightness),
        cmocka_unit_test(maps_are_even_and_clamped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
