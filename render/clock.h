/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_CLOCK_H
#define GM_RENDER_CLOCK_H

#include <stdint.h>

/* The wall clock since an arbitrary moment; it never goes back. It serves pacing and reports: no state
   depends on it. */
double gm_clock_seconds(void);
int64_t gm_clock_milliseconds(void);

/* The CPU time of the calling thread, in seconds. */
double gm_clock_processor_seconds(void);

/* Stops the wall clock at a time in seconds, to which each further call moves it: a script has its own time. */
void gm_clock_hold(double seconds);

#endif
