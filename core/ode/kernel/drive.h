/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over blocks and steps, included once per family and pass. Before it are defined
       GM_DRIVE     name of the function made here
       GM_ROW       type of the family's row
       GM_STEP      name of its step, which returns the lanes that were solved:
                        mask step(const GM_ROW *, struct block *, double h, const void *parameters,
                                  bool compensated, bool stiff, struct counts *)
       GM_ABREAST   so many blocks make their steps side by side: their chains of operations do not wait for
                    each other
   Each block makes all steps in registers. Whether it failed is asked every GM_BURST steps only; then the
   burst is made again step by step, so the step that failed is found exactly, whoever called how often. */

#define GM_DRIVE_NAME(part) GM_DRIVE_NAME_(GM_DRIVE, part)
#define GM_DRIVE_NAME_(drive, part) GM_DRIVE_NAME__(drive, part)
#define GM_DRIVE_NAME__(drive, part) drive##_##part

/* A group of blocks from member `first` on; shortens progress where one fails. Blocks beyond the last member
   repeat it and are not stored. */
GM_INLINE void GM_DRIVE_NAME(group)(const struct gm_task *task, const GM_ROW *row, bool compensated,
                                    size_t first, struct gm_progress *progress)
{
    const void *parameters = task->problem->parameters;
    const bool stiff = gm_ode_of(task->problem)->stiff;
    const double h = task->dt;
    struct K(counts) counts[GM_ABREAST];
    struct K(block) block[GM_ABREAST];
#pragma GCC unroll 8
    for (int b = 0; b < GM_ABREAST; b++) {
        const long rest = (long)task->problem->m - (long)first - b * (long)GM_LANES;
        counts[b] = (struct K(counts)){.lanes = rest < 0          ? 0
                                                : rest < GM_LANES ? (int)rest
                                                                  : GM_LANES,
                                       .continued = task->steps_before > 0};
        K(block_load)(&block[b], task, first + (size_t)(b * GM_LANES));
    }
    /* after a failure the burst is one step, until it is found */
    long done = 0, most = GM_BURST;
    while (done < progress->done) {
        const long left = progress->done - done;
        const long burst = left < most ? left : most;
        struct K(counts) counts_before[GM_ABREAST];
        struct K(block) before[GM_ABREAST];
#pragma GCC unroll 8
        for (int b = 0; b < GM_ABREAST; b++) {
            counts_before[b] = counts[b];
        }
        /* what the first burst begins with is in memory as it is: single steps are spared a copy */
        if (done > 0) {
#pragma GCC unroll 8
            for (int b = 0; b < GM_ABREAST; b++) {
                before[b] = block[b];
            }
        }
        mask solved = K(all)(), inside = K(all)();
        for (long i = 0; i < burst; i++) {
#pragma GCC unroll 8
            for (int b = 0; b < GM_ABREAST; b++) {
                solved &= GM_STEP(row, &block[b], h, parameters, compensated, stiff, &counts[b]);
                inside &= K(within)(&block[b], task->limit);
            }
        }
        if (K(everywhere)(solved) && K(everywhere)(inside)) {
            done += burst;
            continue;
        }
        if (burst == 1) {
            progress->status = K(everywhere)(solved) ? GM_BLOW_UP : GM_NO_CONVERGENCE;
            progress->done = done;
            progress->failed_iterations = 0;
            for (int b = 0; b < GM_ABREAST; b++) {
                progress->failed_iterations += counts[b].iterations - counts_before[b].iterations;
            }
        }
#pragma GCC unroll 8
        for (int b = 0; b < GM_ABREAST; b++) {
            if (done > 0) {
                block[b] = before[b];
            } else {
                K(block_load)(&block[b], task, first + (size_t)(b * GM_LANES));
            }
            counts[b] = counts_before[b];
        }
        most = 1;
    }
#pragma GCC unroll 8
    for (int b = 0; b < GM_ABREAST; b++) {
        K(block_store)(&block[b], task, first + (size_t)(b * GM_LANES));
        progress->evaluations += counts[b].evaluations;
        progress->solves += counts[b].solves;
        progress->iterations += counts[b].iterations;
    }
}

GM_INLINE struct gm_progress GM_DRIVE(const struct gm_task *task, const GM_ROW *row, bool compensated) {
    struct gm_progress progress = {.done = task->steps, .status = GM_OK};
    for (size_t first = 0; first < task->problem->m; first += (size_t)(GM_LANES * GM_ABREAST)) {
        GM_DRIVE_NAME(group)(task, row, compensated, first, &progress);
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
