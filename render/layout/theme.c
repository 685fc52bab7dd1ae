/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Colours for paper and for a screen. */
#include "render/layout/appearance.h"

/* The lanes' colours come from a search. They are as far as possible from each other (CIEDE2000) for people
   with normal vision, protanopia and deuteranopia (simulated after Machado, Oliveira & Fernandes, 2009), with
   a contrast of 3 (light) or 4.5 (dark) to the paper, and well away from ink and from the initial state's
   red. The first four stay near the hues blue, orange, green, pink. The least difference of any two is 17.8
   (light) and 18.6 (dark). */
static const struct gm_rgb roles[GM_THEME_COUNT][GM_ROLE_COUNT] =
    {
        [GM_THEME_LIGHT] =
            {
                [GM_PAPER] = {0xfc, 0xfc, 0xfa},
                [GM_INK] = {0x1d, 0x1f, 0x24},
                [GM_SECONDARY] = {0x6b, 0x6f, 0x78},
                [GM_GRID] = {0xe4, 0xe4, 0xdf},
                [GM_INITIAL] = {0xd0, 0x2f, 0x2f},
                [GM_EXACT] = {0xa4, 0xa8, 0xb0},
                [GM_OVER] = {0xf4, 0xf4, 0xf2},
                [GM_LANE] = {0x03, 0x79, 0xdb},
                [GM_LANE + 1] = {0xec, 0x51, 0x00},
                [GM_LANE + 2] = {0x1a, 0xa7, 0x70},
                [GM_LANE + 3] = {0xba, 0x27, 0x87},
                [GM_LANE + 4] = {0x7a, 0x01, 0x02},
                [GM_LANE + 5] = {0x03, 0x62, 0x4a},
            },
        [GM_THEME_DARK] =
            {
                [GM_PAPER] = {0x14, 0x16, 0x1b},
                [GM_INK] = {0xe8, 0xe8, 0xe4},
                [GM_SECONDARY] = {0x8f, 0x94, 0x9e},
                [GM_GRID] = {0x2a, 0x2e, 0x36},
                [GM_INITIAL] = {0xff, 0x5f, 0x57},
                [GM_EXACT] = {0x6c, 0x72, 0x7d},
                [GM_OVER] = {0xf4, 0xf4, 0xf2},
                [GM_LANE] = {0x83, 0xd1, 0xff},
                [GM_LANE + 1] = {0xff, 0xa2, 0x26},
                [GM_LANE + 2] = {0x72, 0xec, 0xb1},
                [GM_LANE + 3] = {0xd8, 0x7f, 0xa7},
                [GM_LANE + 4] = {0x62, 0x72, 0xfa},
                [GM_LANE + 5] = {0x87, 0x81, 0x4a},
            },
};

struct gm_rgb gm_theme_colour(enum gm_theme theme, enum gm_role role)
{
    return roles[theme][role];
}
