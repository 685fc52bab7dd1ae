/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_SINE_H
#define GM_CORE_LINEAR_SINE_H

#include <stddef.h>

/* sine[i] = sin(x[i]) for |x| <= 1e5, to one unit in the last place of max(|sin x|, 1e-11 |x|); several at a
   time, the same bits on every processor. Meant for fields: larger x lose accuracy, NaN and infinity give
   NaN. */
void gm_sines(const double *x, double *sine, size_t count);

#endif
