/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over blocks and steps, included once per family and pass. Before it
       GM_DRIVE     name of the function made here
       GM_ROW       type of the family's row
       GM_STEP      name of its step: mask step(const GM_ROW *, struct block *, double h, const void
   *parameters, bool compensated, bool stiff, struct counts *), the lanes that were solved Each block makes
   all steps in registers. Whether it failed is asked every GM_BURST steps only; then the burst is made again
   step by step, so the step that failed is found exactly, whoever called how often. */

GM_INLINE struct gm_progress GM_DRIVE(const struct gm_task *task, const GM_ROW *row, bool compensated) {
    struct gm_progress progress = {.done = task->steps, .status = GM_OK};
    const void *parameters = task->problem->parameters;
    const bool stiff = task->problem->ode->stiff;
    const double h = task->dt;
    for (size_t first = 0; first < task->problem->m; first += GM_LANES) {
        const size_t rest = task->problem->m - first;
        struct K(counts)
            counts = {.lanes = rest < GM_LANES ? (int)rest : GM_LANES, .continued = task->steps_before > 0};
        struct K(block) block;
        K(block_load)(&block, task, first);
        long done = 0;
        while (done < progress.done) {
            const long left = progress.done - done;
            const long burst = left < GM_BURST ? left : GM_BURST;
            const struct K(block) before = block;
            const struct K(counts) counts_before = counts;
            mask good = K(all)();
            for (long i = 0; i < burst; i++) {
                good &= GM_STEP(row, &block, h, parameters, compensated, stiff, &counts);
                good &= K(within)(&block, task->limit);
            }
            if (K(everywhere)(good)) {
                done += burst;
                continue;
            }
            block = before;
            counts = counts_before;
            for (long i = 0; i < burst; i++) {
                mask solved = GM_STEP(row, &block, h, parameters, compensated, stiff, &counts);
                if (!K(everywhere)(solved) || !K(everywhere)(K(within)(&block, task->limit))) {
                    progress.status = K(everywhere)(solved) ? GM_BLOW_UP : GM_NO_CONVERGENCE;
                    break;
                }
                done++;
            }
            progress.done = done;
        }
        K(block_store)(&block, task, first);
        progress.evaluations += counts.evaluations;
        progress.solves += counts.solves;
        progress.iterations += counts.iterations;
    }
    return progress;
}

#undef GM_DRIVE
#undef GM_ROW
#undef GM_STEP
