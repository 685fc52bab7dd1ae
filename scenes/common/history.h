/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_HISTORY_H
#define GM_SCENES_COMMON_HISTORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The past of a few observables in bounded memory: bins of equally many steps keep the least and the
   greatest value of each; when the bins are full, pairs are merged. A history can be looked at as it was at
   an earlier step: what came later stays until the next sample is added. */

struct gm_bin {
    double t;     /* of the bin's last sample */
    int64_t step; /* likewise */
    double low, high, last;
};

struct gm_history {
    size_t series;       /* number of observables */
    size_t count;        /* bins in use; the last one may still be filling */
    int64_t per_bin;     /* samples a full bin holds */
    int64_t in_last;     /* samples in the last bin */
    size_t kept;         /* bins in memory; count is less while an earlier step is looked at */
    int64_t in_kept;     /* samples in the last of these */
    struct gm_bin *bins; /* [bin * series + observable] */
};

enum { GM_HISTORY_BINS = 1024 };

bool gm_history_open(struct gm_history *history, size_t series);
void gm_history_close(struct gm_history *history);
/* Adds one value per observable at time t, after `step` steps; what was recorded of later steps is gone. */
void gm_history_add(struct gm_history *history, double t, int64_t step, const double *values);
/* Shows what was recorded up to `step`, earlier or later than what is shown now. */
void gm_history_show(struct gm_history *history, int64_t step);

#endif
