/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The colours of roles, for paper and for a screen, and colour maps. */
#include "render/layout/appearance.h"

#include <math.h>
#include <threads.h>

/* ---- roles ---- */

/* The lanes' colours come from a search. They are as far as possible from each other (CIEDE2000) for people
   with normal vision, protanopia and deuteranopia (simulated after Machado, Oliveira & Fernandes, 2009), with
   a contrast of 3 (light) or 4.5 (dark) to the paper, and well away from ink and from the initial state's
   red. The first four stay near the hues blue, orange, green, pink. The least difference of any two is 17.8
   (light) and 18.6 (dark). */
static const struct gm_rgb roles[GM_ROLE_COUNT][GM_THEME_COUNT] = {
    /* light, dark */
    [GM_PAPER] = {{0xfc, 0xfc, 0xfa}, {0x14, 0x16, 0x1b}},
    [GM_INK] = {{0x1d, 0x1f, 0x24}, {0xe8, 0xe8, 0xe4}},
    [GM_SECONDARY] = {{0x6b, 0x6f, 0x78}, {0x8f, 0x94, 0x9e}},
    [GM_GRID] = {{0xe4, 0xe4, 0xdf}, {0x2a, 0x2e, 0x36}},
    [GM_INITIAL] = {{0xd0, 0x2f, 0x2f}, {0xff, 0x5f, 0x57}},
    [GM_EXACT] = {{0xa4, 0xa8, 0xb0}, {0x6c, 0x72, 0x7d}},
    [GM_OVER] = {{0xf4, 0xf4, 0xf2}, {0xf4, 0xf4, 0xf2}},
    [GM_LANE] = {{0x03, 0x79, 0xdb}, {0x83, 0xd1, 0xff}},
    [GM_LANE + 1] = {{0xec, 0x51, 0x00}, {0xff, 0xa2, 0x26}},
    [GM_LANE + 2] = {{0x1a, 0xa7, 0x70}, {0x72, 0xec, 0xb1}},
    [GM_LANE + 3] = {{0xba, 0x27, 0x87}, {0xd8, 0x7f, 0xa7}},
    [GM_LANE + 4] = {{0x7a, 0x01, 0x02}, {0x62, 0x72, 0xfa}},
    [GM_LANE + 5] = {{0x03, 0x62, 0x4a}, {0x87, 0x81, 0x4a}},
};

struct gm_rgb gm_theme_colour(enum gm_theme theme, enum gm_role role)
{
    return roles[role][theme];
}

/* ---- maps ---- */

/* Colour maps are smooth curves through a few points of the OKLab space (B. Ottosson, A perceptual color
   space for image processing, 2020). The lightness is linear along the map, so that equal differences of the
   value look equal and a printout in grey keeps their order. */

enum { TABLE_SIZE = 256, KNOTS = 7 };

struct knot {
    double lightness, chroma, hue; /* hue in degrees */
};

/* Black through violet, red and orange to a pale yellow. */
static const struct knot sequential[KNOTS] = {
    {0.130, 0.020, 285.0}, {0.270, 0.120, 290.0}, {0.410, 0.170, 322.0}, {0.550, 0.195, 358.0},
    {0.690, 0.185, 25.0},  {0.830, 0.135, 65.0},  {0.970, 0.085, 102.0},
};

/* Blue and orange around a middle that recedes into the paper of either theme. */
static const struct knot diverging[GM_THEME_COUNT][KNOTS] = {
    [GM_THEME_LIGHT] = {{0.370, 0.130, 262.0},
                        {0.560, 0.125, 250.0},
                        {0.760, 0.085, 238.0},
                        {0.960, 0.000, 0.0},
                        {0.760, 0.115, 55.0},
                        {0.560, 0.150, 40.0},
                        {0.370, 0.125, 28.0}},
    [GM_THEME_DARK] = {{0.860, 0.085, 225.0},
                       {0.660, 0.130, 240.0},
                       {0.445, 0.125, 255.0},
                       {0.225, 0.000, 0.0},
                       {0.445, 0.125, 30.0},
                       {0.660, 0.160, 45.0},
                       {0.860, 0.115, 75.0}},
};

static struct gm_rgb tables[2][GM_THEME_COUNT][TABLE_SIZE];
static once_flag tables_made = ONCE_FLAG_INIT;

static uint8_t encode(double linear)
{
    const double c = fmin(fmax(linear, 0.0), 1.0);
    const double srgb = c <= 0.0031308 ? 12.92 * c : 1.055 * pow(c, 1.0 / 2.4) - 0.055;
    return (uint8_t)lround(255.0 * srgb);
}

static struct gm_rgb rgb_of_oklab(double lightness, double a, double b)
{
    const double l = pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3.0);
    const double m = pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3.0);
    const double s = pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3.0);
    return (struct gm_rgb){
        encode(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
        encode(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
        encode(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s),
    };
}

/* Cubic through the knots (Catmull-Rom), ends repeated by reflection. */
static double curve(const double *knots, double position)
{
    int i = (int)position;
    i = i > KNOTS - 2 ? KNOTS - 2 : i;
    const double t = position - i;
    const double p1 = knots[i], p2 = knots[i + 1];
    const double p0 = i > 0 ? knots[i - 1] : 2.0 * p1 - p2;
    const double p3 = i + 2 < KNOTS ? knots[i + 2] : 2.0 * p2 - p1;
    return p1 +
           0.5 * t * (p2 - p0 + t * (2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3 + t * (3.0 * (p1 - p2) + p3 - p0)));
}

static double between(const double *knots, double position)
{
    int i = (int)position;
    i = i > KNOTS - 2 ? KNOTS - 2 : i;
    return knots[i] + (position - i) * (knots[i + 1] - knots[i]);
}

static void table_make(const struct knot *knots, struct gm_rgb *table)
{
    double lightness[KNOTS], a[KNOTS], b[KNOTS];
    for (int i = 0; i < KNOTS; i++) {
        const double hue = knots[i].hue * 3.14159265358979323846 / 180.0;
        lightness[i] = knots[i].lightness;
        a[i] = knots[i].chroma * cos(hue);
        b[i] = knots[i].chroma * sin(hue);
    }
    for (int i = 0; i < TABLE_SIZE; i++) {
        const double position = (double)i * (KNOTS - 1) / (TABLE_SIZE - 1);
        table[i] = rgb_of_oklab(between(lightness, position), curve(a, position), curve(b, position));
    }
}

static void make_tables(void)
{
    for (int theme = 0; theme < GM_THEME_COUNT; theme++) {
        table_make(sequential, tables[GM_MAP_SEQUENTIAL][theme]);
        table_make(diverging[theme], tables[GM_MAP_DIVERGING][theme]);
    }
}

struct gm_rgb gm_colour_map_at(enum gm_colour_map map, enum gm_theme theme, double x)
{
    call_once(&tables_made, make_tables);
    const double clamped = x > 0.0 ? fmin(x, 1.0) : 0.0; /* 0 for NaN */
    return tables[map][theme][(int)(clamped * (TABLE_SIZE - 1) + 0.5)];
}
