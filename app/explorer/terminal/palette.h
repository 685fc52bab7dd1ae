/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_PALETTE_H
#define GM_APP_EXPLORER_TERMINAL_PALETTE_H

#include "render/layout/theme.h"

/* Colours of a picture in terminals that have fewer. */

/* The nearest of the 256 colours of xterm, the first sixteen (which users redefine) left out. */
int gm_palette_256(struct gm_rgb colour);

/* One of the sixteen: a role in its own colour, in the darker one of the pair where it is faded. */
int gm_palette_16(enum gm_theme theme, struct gm_rgb colour, enum gm_role role);
/* The same for a background. */
int gm_palette_ground(enum gm_theme theme, struct gm_rgb colour);

/* Whether a colour counts as ink where there are no colours at all. */
bool gm_palette_is_ink(enum gm_theme theme, struct gm_rgb colour);

#endif
