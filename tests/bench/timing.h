/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all that measures speed shares: processor time, and the median of several times. */
#ifndef GM_TESTS_BENCH_TIMING_H
#define GM_TESTS_BENCH_TIMING_H

#include <stdlib.h>
#include <time.h>

/* Seconds of the processor, user's and system's, that this process has taken so far. */
static inline double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static inline int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The values end in ascending order. */
static inline double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, ascending);
    return values[count / 2];
}

#endif
