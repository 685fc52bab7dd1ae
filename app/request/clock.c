/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The clocks of the program. */
#include "app/request/clock.h"

#include <time.h>

static double seconds_of(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

double gm_wall_seconds(void)
{
    return seconds_of(CLOCK_MONOTONIC);
}

double gm_processor_seconds(void)
{
    return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}
