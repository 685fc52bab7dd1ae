/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The loop over blocks and steps, included once per family and pass. Before it are defined
       GM_DRIVE     name of the function made here
       GM_ROW       type of the family's row
       GM_STEP      name of its step, which returns the lanes that were solved:
                        mask step(const GM_ROW *, struct block *, double h, const void *parameters,
                                  bool compensated, bool stiff, struct counts *)
       GM_ABREAST   number of blocks that make their steps side by side, so that their chains of operations
                    do not wait for each other; 1 if it is not defined
       GM_PRIME     optional: the preparation of a block before its first step:
                        void prime(struct block *, const void *parameters, struct counts *)
       GM_QUICK     defined if a step is short: few steps of an ensemble then have their own function
   Each block makes all steps in registers. Failures are tested every GM_BURST steps only; then the burst is
   repeated step by step, so the step that failed is found exactly, however the calls divide the run. */

#ifndef GM_ABREAST
#define GM_ABREAST 1
#endif
#ifndef GM_PRIME
#define GM_PRIME(block, parameters, counts)
#endif
#define GM_DRIVE_NAME(part) GM_DRIVE_NAME_(GM_DRIVE, part)
#define GM_DRIVE_NAME_(drive, part) GM_DRIVE_NAME__(drive, part)
#define GM_DRIVE_NAME__(drive, part) drive##_##part

/* Advances a group of blocks from member `first` on; shortens progress if one fails. Blocks beyond the last
   member repeat it and are not stored. */
GM_INLINE void GM_DRIVE_NAME(group)(const struct gm_task *task, const GM_ROW *row, bool compensated,
                                    size_t first, struct gm_progress *progress)
{
    const void *parameters = task->problem->parameters;
    const bool stiff = gm_ode_of(task->problem)->stiff;
    const double h = task->dt;
#ifdef GM_PASS_SCALAR
    double *const trace = task->trace;
#endif
    const bool whole = first + (size_t)(GM_LANES * GM_ABREAST) <= task->problem->m;
    struct K(counts) counts[GM_ABREAST];
    struct K(block) block[GM_ABREAST];
    GM_UNROLL
    for (int b = 0; b < GM_ABREAST; b++) {
        const int64_t rest = (int64_t)task->problem->m - (int64_t)first - b * (int64_t)GM_LANES;
        counts[b] = (struct K(counts)){.lanes = rest < 0          ? 0
                                                : rest < GM_LANES ? (int)rest
                                                                  : GM_LANES,
                                       .continued = task->steps_before > 0};
        K(block_load)(&block[b], task, first + (size_t)(b * GM_LANES), compensated, whole);
        GM_PRIME(&block[b], parameters, &counts[b]);
    }
    /* after a failure the burst is one step, until it is found */
    int64_t done = 0, most = GM_BURST;
    while (done < progress->done) {
        const int64_t left = progress->done - done;
        const int64_t burst = left < most ? left : most;
        struct K(counts) counts_before[GM_ABREAST];
        struct K(block) before[GM_ABREAST];
        GM_UNROLL
        for (int b = 0; b < GM_ABREAST; b++) {
            counts_before[b] = counts[b];
        }
        /* the start of the first burst is still in memory: single steps need no copy */
        if (done > 0) {
            GM_UNROLL
            for (int b = 0; b < GM_ABREAST; b++) {
                before[b] = block[b];
            }
        }
        mask solved = K(all)(), farthest = K(other)(solved);
        for (int64_t i = 0; i < burst; i++) {
            GM_UNROLL
            for (int b = 0; b < GM_ABREAST; b++) {
                solved &= GM_STEP(row, &block[b], h, parameters, compensated, stiff, &counts[b]);
                farthest = K(farther)(farthest, K(block_distance)(&block[b], task));
            }
#ifdef GM_PASS_SCALAR
            if (trace) {
                memcpy(trace + (size_t)(done + i) * GM_COMPONENTS, block[0].y, sizeof block[0].y);
            }
#endif
        }
        if (K(everywhere)(solved) && !K(somewhere_beyond)(farthest, task->limit)) {
            done += burst;
            continue;
        }
        if (burst == 1) {
            progress->status = K(everywhere)(solved) ? GM_BLOW_UP : GM_NO_CONVERGENCE;
            progress->done = done;
            progress->unsolved =
                counts[0].unsolved; /* blocks of implicit schemes are not made side by side */
        }
        GM_UNROLL
        for (int b = 0; b < GM_ABREAST; b++) {
            if (done > 0) {
                block[b] = before[b];
            } else {
                K(block_load)(&block[b], task, first + (size_t)(b * GM_LANES), compensated, whole);
                GM_PRIME(&block[b], parameters, &counts[b]);
            }
            counts[b] = counts_before[b];
        }
        most = 1;
    }
    GM_UNROLL
    for (int b = 0; b < GM_ABREAST; b++) {
        K(block_store)(&block[b], task, first + (size_t)(b * GM_LANES), compensated, whole);
        progress->evaluations += counts[b].evaluations;
        progress->solves += counts[b].solves;
        progress->iterations += counts[b].iterations;
    }
}

#if defined(GM_QUICK) && !defined(GM_PASS_SCALAR)
/* Makes the steps of a whole group from member `first` on, at least one, and does not store it. */
GM_INLINE void GM_DRIVE_NAME(few)(const struct gm_task *task, const GM_ROW *row, bool compensated,
                                  size_t first, struct K(block) * block, struct K(counts) * counts,
                                  mask *solved, mask *farthest)
{
    const void *parameters = task->problem->parameters;
    const bool stiff = gm_ode_of(task->problem)->stiff;
    GM_UNROLL
    for (int b = 0; b < GM_ABREAST; b++) {
        K(block_load)(&block[b], task, first + (size_t)(b * GM_LANES), compensated, true);
        K(block_ask_ahead)(task, first + (size_t)(b * GM_LANES));
        GM_PRIME(&block[b], parameters, counts);
    }
    int64_t left = task->steps;
    do {
        GM_UNROLL
        for (int b = 0; b < GM_ABREAST; b++) {
            *solved &= GM_STEP(row, &block[b], task->dt, parameters, compensated, stiff, counts);
            *farthest = K(farther)(*farthest, K(block_distance)(&block[b], task));
        }
    } while (--left > 0);
}

GM_INLINE void GM_DRIVE_NAME(put)(const struct gm_task *task, bool compensated, size_t first,
                                  const struct K(block) * block)
{
    GM_UNROLL
    for (int b = 0; b < GM_ABREAST; b++) {
        K(block_store)(&block[b], task, first + (size_t)(b * GM_LANES), compensated, true);
    }
}

/* Advances all groups, by at most a burst of steps: a copy for a second try takes several times as long as a
   step. The last group shares members with the one before it, so it is made first and stored last: the steps
   may be made in place. After an odd number of steps, stretches of groups are taken from the end, each
   forwards, as memory is prefetched: each single step first reads the data that the last one left in the
   cache. Returns false if a member failed; the stored data are then void. */
GM_INLINE bool GM_DRIVE_NAME(quickly)(const struct gm_task *task, const GM_ROW *row, bool compensated,
                                      struct gm_progress *progress)
{
    /* copies, which no store to the state can change */
    const struct gm_problem problem = *task->problem;
    struct gm_task self = *task;
    self.problem = &problem;
    const size_t size = (size_t)(GM_LANES * GM_ABREAST), m = problem.m, last = m - size, stretch = 512 * size;
    struct K(counts) counts = {.lanes = GM_LANES, .continued = self.steps_before > 0};
    struct K(block) end[GM_ABREAST];
    mask solved = K(all)(), farthest = K(other)(solved);
    GM_DRIVE_NAME(few)(&self, row, compensated, last, end, &counts, &solved, &farthest);
    for (size_t done = 0; done < last; done += stretch) {
        const size_t from = self.steps_before % 2 == 0 ? done : (last - 1) / stretch * stretch - done;
        const size_t to = from + stretch < last ? from + stretch : last;
        for (size_t first = from; first < to; first += size) {
            struct K(block) block[GM_ABREAST];
            GM_DRIVE_NAME(few)(&self, row, compensated, first, block, &counts, &solved, &farthest);
            GM_DRIVE_NAME(put)(&self, compensated, first, block);
        }
    }
    GM_DRIVE_NAME(put)(&self, compensated, last, end);
    if (!K(everywhere)(solved) || K(somewhere_beyond)(farthest, task->limit)) {
        return false;
    }
    progress->evaluations = counts.evaluations / ((m - 1) / size * size + size) * m;
    return true;
}
#endif

GM_INLINE struct gm_progress GM_DRIVE(const struct gm_task *task, const GM_ROW *row, bool compensated) {
    struct gm_progress progress = {.done = task->steps, .status = GM_OK};
#ifdef GM_PASS_SCALAR
    progress.traced = task->trace != NULL;
#endif
#if defined(GM_QUICK) && !defined(GM_PASS_SCALAR)
    if (task->steps <= GM_BURST && task->problem->m >= (size_t)(GM_LANES * GM_ABREAST)) {
        if (GM_DRIVE_NAME(quickly)(task, row, compensated, &progress)) {
            return progress;
        }
        if (task->out == task->y) { /* the start is overwritten: the caller repeats the steps */
            return (struct gm_progress){.status = GM_BLOW_UP};
        }
    }
#endif
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
#undef GM_PRIME
#undef GM_QUICK
