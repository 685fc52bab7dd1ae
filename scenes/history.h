/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_HISTORY_H
#define GM_SCENES_HISTORY_H

#include <stdbool.h>
#include <stddef.h>

/* The past of a few observables in bounded memory: bins of equally many steps keep the least and the
   greatest value of each; when the bins are full, pairs are merged. */

struct gm_bin {
    double t; /* of the bin's last sample */
    double low, high, last;
};

struct gm_history {
    size_t series;       /* number of observables */
    size_t count;        /* bins in use; the last one may still be filling */
    long per_bin;        /* samples a full bin holds */
    long in_last;        /* samples in the last bin */
    struct gm_bin *bins; /* [bin * series + observable] */
};

enum { GM_HISTORY_BINS = 1024 };

bool gm_history_open(struct gm_history *history, size_t series);
void gm_history_close(struct gm_history *history);
void gm_history_clear(struct gm_history *history);
/* Adds one value per observable at time t. */
void gm_history_add(struct gm_history *history, double t, const double *values);
/* Forgets what is later than t, in the direction of time (dt > 0) or against it (dt < 0). */
void gm_history_cut(struct gm_history *history, double t, double dt);

#endif
