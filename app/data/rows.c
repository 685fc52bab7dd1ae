/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The choice of the steps that have a row. */
#include "app/data/save.h"

#include <math.h>

/* Returns true if rows follow the time, and not every step has one. */
static bool is_by_time(const struct gm_rows *rows, const struct gm_run *run)
{
    return rows->every == 0 && !isnan(rows->interval) &&
           (run->scheme->family->adaptive || rows->interval > fabs(run->dt));
}

/* The step next to the first multiple of the interval whose step is not before `step`. */
static double step_from(const struct gm_rows *rows, const struct gm_run *run, double step)
{
    const double steps = rows->interval / fabs(run->dt); /* more than 1 */
    double k = fmax(0, ceil((step - 0.5) / steps) - 1);
    while (round(k * steps) < step) {
        k++;
    }
    return round(k * steps);
}

bool gm_rows_all(const struct gm_rows *rows, const struct gm_run *run)
{
    return !is_by_time(rows, run) && rows->every < 2;
}

int64_t gm_rows_next(const struct gm_rows *rows, const struct gm_run *run)
{
    const int64_t next = run->steps + 1, far = INT64_C(1) << 40;
    if (!is_by_time(rows, run)) {
        return rows->every < 2 ? next : run->steps - run->steps % rows->every + rows->every;
    }
    if (run->scheme->family->adaptive) {
        return next;
    }
    return (int64_t)fmin(step_from(rows, run, (double)next), (double)(next + far));
}

bool gm_rows_due(const struct gm_rows *rows, const struct gm_run *run, double before)
{
    if (!is_by_time(rows, run)) {
        return rows->every < 2 || run->steps % rows->every == 0;
    }
    if (run->scheme->family->adaptive) {
        return floor(run->t / rows->interval) != floor(before / rows->interval);
    }
    return step_from(rows, run, (double)run->steps) == (double)run->steps;
}

uint64_t gm_rows_expected(const struct gm_rows *rows, const struct gm_run *run, int64_t last)
{
    if (run->scheme->family->adaptive || last < 0) {
        return 0;
    }
    if (!is_by_time(rows, run)) {
        const int64_t every = rows->every < 2 ? 1 : rows->every;
        return (uint64_t)(last / every) + (last % every != 0) + 1;
    }
    const double steps = rows->interval / fabs(run->dt), most = (double)(1L << 50);
    const double k = fmin(floor(((double)last + 0.5) / steps), most);
    return (uint64_t)k + (round(k * steps) != (double)last) + 1;
}
