/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wall clock, for pacing and for durations. */
#include "render/clock.h"

#include <stdbool.h>
#include <time.h>

static bool held;
static double held_at; /* seconds */

void gm_clock_hold(double seconds)
{
    held = true;
    held_at = seconds;
}

static double seconds_of(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double gm_clock_seconds(void)
{
    return held ? held_at : seconds_of(CLOCK_MONOTONIC);
}

double gm_clock_processor_seconds(void)
{
    return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

int64_t gm_clock_milliseconds(void)
{
    return (int64_t)(1000 * gm_clock_seconds());
}
