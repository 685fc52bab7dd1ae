/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over blocks and steps, included once per family and pass. Before it
       GM_DRIVE     name of the function made here
       GM_ROW       type of the family's row
       GM_STEP      name of its step: mask step(const GM_ROW *, struct block *, double h, const void
   *parameters, bool compensated, bool stiff, struct counts *), the lanes that were solved GM_ABREAST   so
   many blocks make their steps side by side: their chains of operations do not wait for each other Each block
   makes all steps in registers. Whether it failed is asked every GM_BURST steps only; then the burst is made
   again step by step, so the step that failed is found exactly, whoever called how often. */

#define GM_DRIVE_NAME(part) GM_DRIVE_NAME_(GM_DRIVE, part)
#define GM_DRIVE_NAME_(drive, part) GM_DRIVE_NAME__(drive, part)
#define GM_DRIVE_NAME__(drive, part) drive##_##part

/* `count` blocks, a constant, from member `first` on; shortens progress where one fails. */
GM_INLINE void GM_DRIVE_NAME(group)(const struct gm_task *task, const GM_ROW *row, bool compensated,
                                    size_t first, int count, struct gm_progress *progress)
{
    const void *parameters = task->problem->parameters;
    const bool stiff = task->problem->ode->stiff;
    const double h = task->dt;
    struct K(counts) counts[GM_ABREAST];
    struct K(block) block[GM_ABREAST];
#pragma GCC unroll 8
    for (int b = 0; b < count; b++) {
        const size_t rest = task->problem->m - first - (size_t)(b * GM_LANES);
        counts[b] = (struct K(counts)){.lanes = rest < GM_LANES ? (int)rest : GM_LANES,
                                       .continued = task->steps_before > 0};
        K(block_load)(&block[b], task, first + (size_t)(b * GM_LANES));
    }
    long done = 0;
    while (done < progress->done) {
        const long left = progress->done - done;
        const long burst = left < GM_BURST ? left : GM_BURST;
        struct K(counts) counts_before[GM_ABREAST];
        struct K(block) before[GM_ABREAST];
#pragma GCC unroll 8
        for (int b = 0; b < count; b++) {
            before[b] = block[b];
            counts_before[b] = counts[b];
        }
        mask good = K(all)();
        for (long i = 0; i < burst; i++) {
#pragma GCC unroll 8
            for (int b = 0; b < count; b++) {
                good &= GM_STEP(row, &block[b], h, parameters, compensated, stiff, &counts[b]);
                good &= K(within)(&block[b], task->limit);
            }
        }
        if (K(everywhere)(good)) {
            done += burst;
            continue;
        }
#pragma GCC unroll 8
        for (int b = 0; b < count; b++) {
            block[b] = before[b];
            counts[b] = counts_before[b];
        }
        bool failed = false;
        for (long i = 0; i < burst && !failed; i++) {
#pragma GCC unroll 8
            for (int b = 0; b < count && !failed; b++) {
                mask solved = GM_STEP(row, &block[b], h, parameters, compensated, stiff, &counts[b]);
                if (!K(everywhere)(solved) || !K(everywhere)(K(within)(&block[b], task->limit))) {
                    progress->status = K(everywhere)(solved) ? GM_BLOW_UP : GM_NO_CONVERGENCE;
                    failed = true;
                }
            }
            done += failed ? 0 : 1;
        }
        progress->done = done;
    }
#pragma GCC unroll 8
    for (int b = 0; b < count; b++) {
        K(block_store)(&block[b], task, first + (size_t)(b * GM_LANES));
        progress->evaluations += counts[b].evaluations;
        progress->solves += counts[b].solves;
        progress->iterations += counts[b].iterations;
    }
}

GM_INLINE struct gm_progress GM_DRIVE(const struct gm_task *task, const GM_ROW *row, bool compensated) {
    struct gm_progress progress = {.done = task->steps, .status = GM_OK};
    const size_t m = task->problem->m;
    size_t first = 0;
    if (GM_ABREAST > 1) {
        for (; m - first > (size_t)(GM_LANES * (GM_ABREAST - 1)); first += (size_t)(GM_LANES * GM_ABREAST)) {
            GM_DRIVE_NAME(group)(task, row, compensated, first, GM_ABREAST, &progress);
            if (m - first <= (size_t)(GM_LANES * GM_ABREAST)) {
                return progress;
            }
        }
    }
    for (; first < m; first += GM_LANES) {
        GM_DRIVE_NAME(group)(task, row, compensated, first, 1, &progress);
    }
    return progress;
}

#undef GM_DRIVE_NAME
#undef GM_DRIVE_NAME_
#undef GM_DRIVE_NAME__
#undef GM_DRIVE
#undef GM_ROW
#undef GM_STEP
#undef GM_ABREAST
