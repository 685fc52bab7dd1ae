/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bins of a history: filled, merged in pairs when full, shown as they were. */
#include "scenes/common/history.h"

#include <string.h>

void gm_history_open(struct gm_arena *arena, struct gm_history *history, size_t series)
{
    *history = (struct gm_history){.series = series, .per_bin = 1};
    history->bins = gm_arena_take(arena, GM_HISTORY_BINS * series, sizeof *history->bins);
}

static void merge_pairs(struct gm_history *history)
{
    for (size_t pair = 0; pair < GM_HISTORY_BINS / 2; pair++) {
        for (size_t s = 0; s < history->series; s++) {
            const struct gm_bin *first = &history->bins[2 * pair * history->series + s];
            const struct gm_bin *second = &history->bins[(2 * pair + 1) * history->series + s];
            history->bins[pair * history->series + s] = (struct gm_bin){
                .t = second->t,
                .step = second->step,
                .low = first->low < second->low ? first->low : second->low,
                .high = first->high > second->high ? first->high : second->high,
                .last = second->last,
            };
        }
    }
    history->count = GM_HISTORY_BINS / 2;
    history->per_bin *= 2;
    history->in_last = history->per_bin;
}

void gm_history_add(struct gm_history *history, double t, int64_t step, const double *values)
{
    if (history->count == GM_HISTORY_BINS && history->in_last == history->per_bin) {
        merge_pairs(history);
    }
    const bool fresh = history->count == 0 || history->in_last >= history->per_bin;
    if (fresh) {
        history->count++;
        history->in_last = 0;
    }
    struct gm_bin *bin = &history->bins[(history->count - 1) * history->series];
    for (size_t s = 0; s < history->series; s++) {
        const double value = values[s];
        if (fresh) {
            bin[s] = (struct gm_bin){.low = value, .high = value};
        }
        bin[s].t = t;
        bin[s].step = step;
        bin[s].low = value < bin[s].low ? value : bin[s].low;
        bin[s].high = value > bin[s].high ? value : bin[s].high;
        bin[s].last = value;
    }
    history->in_kept = ++history->in_last;
    history->kept = history->count;
}

void gm_history_show(struct gm_history *history, int64_t step)
{
    if (history->series == 0) {
        return;
    }
    history->count = history->kept;
    while (history->count > 0 && history->bins[(history->count - 1) * history->series].step > step) {
        history->count--;
    }
    /* every bin but the last one is full */
    history->in_last = history->count == history->kept ? history->in_kept : history->per_bin;
}
