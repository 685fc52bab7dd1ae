/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Names as written in pictures. */
#ifndef GM_SCENES_COMMON_SYMBOL_H
#define GM_SCENES_COMMON_SYMBOL_H

#include "render/picture/picture.h"

/* The label of a parameter's key in lanes and axes: "dt" is "Δt", "lambda" is "λ", any other itself. */
const char *gm_key_symbol(const char *key);

/* Returns names with Greek letters and indices below, powers above, a true minus: "p_x^2" as "pₓ²"; the picture
   owns the text, and the text itself is returned when out of memory. */
const char *gm_typeset(struct gm_picture *picture, const char *text);

#endif
