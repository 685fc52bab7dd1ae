/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wall clock, for pacing and for durations. */
#include "render/clock.h"

#include <time.h>

static double seconds_of(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double gm_clock_seconds(void)
{
    return seconds_of(CLOCK_MONOTONIC);
}

double gm_clock_processor_seconds(void)
{
    return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

int64_t gm_clock_milliseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}
