/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CLOCK_H
#define GM_RENDER_CLOCK_H

#include <stdint.h>

/* The clock on the wall since some moment; it never goes back. It paces and tells: no state depends on it. */
double gm_clock_seconds(void);
int64_t gm_clock_milliseconds(void);

/* What this thread has used of a processor. */
double gm_clock_processor_seconds(void);

#endif
