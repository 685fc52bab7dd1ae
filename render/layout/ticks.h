/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_LAYOUT_TICKS_H
#define GM_RENDER_LAYOUT_TICKS_H

#include <stddef.h>

#include "render/picture/picture.h"

/* The round values of an axis, and how they are written. */

enum { GM_TICK_MAX = 12 };

/* The range as the axis shows it: never empty, positive on a log axis. */
void gm_axis_shown(const struct gm_axis *axis, double *low, double *high);

/* Round tick values of a range: at least 3 where possible, at most max <= GM_TICK_MAX. */
size_t gm_ticks(const struct gm_axis *axis, size_t max, double *values);
/* A tick's label: a true minus sign, pi/2, powers of ten with superscripts. `step` is the distance of
   ticks. */
void gm_tick_format(enum gm_scale scale, double value, double step, char *text, size_t size);

#endif
