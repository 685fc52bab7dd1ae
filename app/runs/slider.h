/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_RUNS_SLIDER_H
#define GM_APP_RUNS_SLIDER_H

#include "core/parameter.h"

/* How a parameter is moved by keys: along round values, of equal distance or of equal ratio. */

/* Where the value stands in its range, 0 to 1; -1 if it has no range to be shown. */
double gm_slider_position(const struct gm_parameter *row, const void *owner);

/* The value at a place from 0 to 1 in the range, rounded, as it would be typed. False if it has no range. */
bool gm_slider_at(const struct gm_parameter *row, double position, char text[GM_TEXT_SIZE]);

/* The next value up (direction > 0) or down, as it would be typed; a fine one is about ten times nearer.
   False if there is none. */
bool gm_slider_next(const struct gm_parameter *row, const void *owner, int direction, bool fine,
                    char text[GM_TEXT_SIZE]);

#endif
