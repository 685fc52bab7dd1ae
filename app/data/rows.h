/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_ROWS_H
#define GM_APP_DATA_ROWS_H

#include <stdint.h>

#include "core/run.h"

/* After which steps a run's history and states have a row, beside its start and its end. */
struct gm_rows {
    int64_t every;   /* every so many steps; 0: see interval */
    double interval; /* the steps next to its multiples of model time, or, where the scheme chooses its step,
                        the first ones that reach them; NAN: every step, unless `every` says otherwise */
};

/* Whether every step has one. */
bool gm_rows_all(const struct gm_rows *rows, const struct gm_run *run);

/* The step of the next row, after the present one. */
int64_t gm_rows_next(const struct gm_rows *rows, const struct gm_run *run);

/* How many rows there will be from the start of the run to its step `last`, both with a row, if nothing comes
   between; 0: the scheme chooses its steps, and nobody knows. */
uint64_t gm_rows_expected(const struct gm_rows *rows, const struct gm_run *run, int64_t last);

/* Whether the present step has a row; `before` is the time before it. */
bool gm_rows_due(const struct gm_rows *rows, const struct gm_run *run, double before);

#endif
