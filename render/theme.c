/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/theme.h"

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
                [GM_LANE] = {0x00, 0x72, 0xb2},
                [GM_LANE + 1] = {0xd5, 0x5e, 0x00},
                [GM_LANE + 2] = {0x00, 0x9e, 0x73},
                [GM_LANE + 3] = {0xb0, 0x47, 0x9b},
                [GM_LANE + 4] = {0x5a, 0x3a, 0x00},
                [GM_LANE + 5] = {0xc8, 0xa0, 0x00},
            },
        [GM_THEME_DARK] =
            {
                [GM_PAPER] = {0x14, 0x16, 0x1b},
                [GM_INK] = {0xe8, 0xe8, 0xe4},
                [GM_SECONDARY] = {0x8f, 0x94, 0x9e},
                [GM_GRID] = {0x2a, 0x2e, 0x36},
                [GM_INITIAL] = {0xff, 0x5f, 0x57},
                [GM_EXACT] = {0x6c, 0x72, 0x7d},
                [GM_LANE] = {0x56, 0xb4, 0xe9},
                [GM_LANE + 1] = {0xff, 0x9f, 0x4a},
                [GM_LANE + 2] = {0x3f, 0xd0, 0xa0},
                [GM_LANE + 3] = {0xe5, 0x8f, 0xce},
                [GM_LANE + 4] = {0xf0, 0xe4, 0x60},
                [GM_LANE + 5] = {0x80, 0x70, 0xe0},
            },
};

struct gm_rgb gm_theme_colour(enum gm_theme theme, enum gm_role role) {
    return roles[theme][role];
}
