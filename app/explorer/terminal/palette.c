/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The colours of a picture in terminals of 256 and of 16 colours. */
#include "app/explorer/terminal/palette.h"

/* Distance that counts a shift of hue four times as much as one of brightness: otherwise every faded colour
   would end among the greys. */
static int shift(struct gm_rgb a, struct gm_rgb b)
{
    int r = a.r - b.r, g = a.g - b.g, blue = a.b - b.b, light = (2 * r + 5 * g + blue) / 8;
    return light * light + 4 * ((r - light) * (r - light) + (blue - light) * (blue - light)) / 2;
}

static struct gm_rgb of_256(int number)
{
    static const uint8_t levels[6] = {0, 95, 135, 175, 215, 255};
    if (number >= 232) {
        uint8_t grey = (uint8_t)(8 + 10 * (number - 232));
        return (struct gm_rgb){grey, grey, grey};
    }
    number -= 16;
    return (struct gm_rgb){levels[number / 36], levels[number / 6 % 6], levels[number % 6]};
}

int gm_palette_256(struct gm_rgb colour)
{
    int best = 16;
    for (int i = 17; i < 256; i++) {
        if (shift(colour, of_256(i)) < shift(colour, of_256(best))) {
            best = i;
        }
    }
    return best;
}

/* The sixteen as terminals usually show them; users' palettes differ, but not in what is red. */
static const struct gm_rgb sixteen[16] = {
    {0, 0, 0},     {205, 0, 0},     {0, 205, 0},     {205, 205, 0},   {0, 0, 238}, {205, 0, 205},
    {0, 205, 205}, {229, 229, 229}, {127, 127, 127}, {255, 0, 0},     {0, 255, 0}, {255, 255, 0},
    {92, 92, 255}, {255, 0, 255},   {0, 255, 255},   {255, 255, 255},
};

static int nearest_16(struct gm_rgb colour)
{
    int best = 0;
    for (int i = 1; i < 16; i++) {
        if (gm_rgb_distance(colour, sixteen[i]) < gm_rgb_distance(colour, sixteen[best])) {
            best = i;
        }
    }
    return best;
}

/* Strong and faded, on black and on white. */
static const uint8_t roles[GM_THEME_COUNT][GM_ROLE_COUNT][2] = {
    [GM_THEME_DARK] = {[GM_PAPER] = {0, 0},
                       [GM_INK] = {15, 7},
                       [GM_SECONDARY] = {7, 7},
                       [GM_GRID] = {8, 8},
                       [GM_INITIAL] = {9, 1},
                       [GM_EXACT] = {7, 8},
                       [GM_OVER] = {15, 7},
                       [GM_LANE + 0] = {14, 6},
                       [GM_LANE + 1] = {11, 3},
                       [GM_LANE + 2] = {10, 2},
                       [GM_LANE + 3] = {13, 5},
                       [GM_LANE + 4] = {12, 4},
                       [GM_LANE + 5] = {15, 7}},
    [GM_THEME_LIGHT] = {[GM_PAPER] = {15, 15},
                        [GM_INK] = {0, 8},
                        [GM_SECONDARY] = {8, 8},
                        [GM_GRID] = {7, 7},
                        [GM_INITIAL] = {1, 9},
                        [GM_EXACT] = {8, 7},
                        [GM_OVER] = {15, 7},
                        [GM_LANE + 0] = {4, 12},
                        [GM_LANE + 1] = {3, 11},
                        [GM_LANE + 2] = {2, 10},
                        [GM_LANE + 3] = {5, 13},
                        [GM_LANE + 4] = {6, 14},
                        [GM_LANE + 5] = {0, 8}},
};

int gm_palette_16(enum gm_theme theme, struct gm_rgb colour, enum gm_role role)
{
    struct gm_rgb paper = gm_theme_colour(theme, GM_PAPER);
    /* distances are squares: below a third of the square is below .58 of the way */
    bool faded = 3 * gm_rgb_distance(colour, paper) < gm_rgb_distance(gm_theme_colour(theme, role), paper);
    return roles[theme][role][faded];
}

int gm_palette_ground(enum gm_theme theme, struct gm_rgb colour)
{
    struct gm_rgb paper = gm_theme_colour(theme, GM_PAPER);
    if (gm_rgb_distance(colour, paper) < 4000) {
        return roles[theme][GM_PAPER][0];
    }
    return nearest_16(colour);
}

bool gm_palette_is_ink(enum gm_theme theme, struct gm_rgb colour)
{
    struct gm_rgb paper = gm_theme_colour(theme, GM_PAPER), ink = gm_theme_colour(theme, GM_INK);
    return 16 * gm_rgb_distance(colour, paper) > gm_rgb_distance(ink, paper);
}
