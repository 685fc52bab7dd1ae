/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_HISTORY_H
#define GM_SCENES_COMMON_HISTORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/arena.h"

/* The past of a few observables in bounded memory: bins with equal numbers of steps hold the least and the
   greatest value of each. When all bins are full, pairs are merged. A history can be shown as it was at an
   earlier step: later bins stay until the next sample. */

struct gm_bin {
    double t;     /* time of the bin's last sample */
    int64_t step; /* step of the bin's last sample */
    double low, high, last;
};

struct gm_history {
    size_t series;       /* number of observables */
    size_t count;        /* bins in use; the last one may still be filling */
    int64_t per_bin;     /* samples a full bin holds */
    int64_t in_last;     /* samples in the last bin */
    size_t kept;         /* bins in memory; count is less while an earlier step is shown */
    int64_t in_kept;     /* samples in the last bin in memory */
    struct gm_bin *bins; /* [bin * series + observable] */
};

enum { GM_HISTORY_BINS = 1024 };

/* Takes the bins from the arena, in a body of it. */
void gm_history_open(struct gm_arena *arena, struct gm_history *history, size_t series);
/* Adds one value per observable at time t, after `step` steps; the record of later steps is dropped. */
void gm_history_add(struct gm_history *history, double t, int64_t step, const double *values);
/* Shows the record up to `step`, which may be earlier or later than the step shown now. */
void gm_history_show(struct gm_history *history, int64_t step);

#endif
