/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The clock on the wall, for pacing and for telling how long something took. */
#include "render/files/clock.h"

#include <time.h>

double gm_clock_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

int64_t gm_clock_milliseconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (int64_t)now.tv_sec * 1000 + now.tv_nsec / 1000000;
}
