/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A block: GM_LANES members in registers. Loading and storing, compensated addition, the blow-up test. */

/* Explicit schemes: blocks that advance side by side, as many as the registers hold. */
#ifdef GM_PASS_SCALAR
enum { K(ABREAST) = 1 };
#else
/* numbers of states in registers, of which AVX-512 has 32 and the others 16 */
enum {
    K(HELD) = GM_WIDTH == 8 ? 12 : 8,
    K(ABREAST) = GM_COMPONENTS <= K(HELD) ? K(HELD) / GM_COMPONENTS : 1
};
#endif

struct K(block) {
    real y[GM_COMPONENTS];
    real carry[GM_COMPONENTS]; /* what rounding lost from y, for compensated summation */
    real force[GM_COMPONENTS]; /* splitting: of the last kick, while q has not moved since */
    bool force_known;
};

/* What the steps cost, summed over the lanes that are members. */
struct K(counts) {
    int lanes;      /* members in this block */
    bool continued; /* these are not the run's first steps */
    unsigned long evaluations, solves, iterations;
};

/* Members from `first` on; a block that sticks out repeats the last member, which changes nothing. `whole` says
   of a group of blocks that none does: asked once, what moves them is a row of instructions without a branch. */
GM_INLINE void K(block_load)(struct K(block) * block, const struct gm_task *task, size_t first,
                             bool compensated, bool whole)
{
    size_t m = task->problem->m;
    block->force_known = false;
    for (int c = 0; c < GM_COMPONENTS; c++) {
        block->force[c] = K(constant)(0);
        if (compensated) {
            block->carry[c] = K(constant)(0);
        }
        if (whole || first + GM_LANES <= m) {
            block->y[c] = K(load)(task->y + (size_t)c * m + first);
            if (compensated) {
                block->carry[c] = K(load)(task->carry + (size_t)c * m + first);
            }
            continue;
        }
        for (int l = 0; l < GM_LANES; l++) {
            size_t member = first + (size_t)l < m ? first + (size_t)l : m - 1;
            K(set_lane)(&block->y[c], l, task->y[(size_t)c * m + member]);
            if (compensated) {
                K(set_lane)(&block->carry[c], l, task->carry[(size_t)c * m + member]);
            }
        }
    }
}

GM_INLINE void K(block_store)(const struct K(block) * block, const struct gm_task *task, size_t first,
                              bool compensated, bool whole)
{
    size_t m = task->problem->m;
    if (!whole && first >= m) {
        return;
    }
    for (int c = 0; c < GM_COMPONENTS; c++) {
        double *out = task->out + (size_t)c * m + first;
        double *carry = compensated ? task->carry_out + (size_t)c * m + first : NULL;
        if (whole || first + GM_LANES <= m) {
            K(store)(out, block->y[c]);
            if (carry) {
                K(store)(carry, block->carry[c]);
            }
            continue;
        }
        memcpy(out, &block->y[c], (m - first) * sizeof(double));
        if (carry) {
            memcpy(carry, &block->carry[c], (m - first) * sizeof(double));
        }
    }
}

/* Asks memory for what lies so far beyond a block: where an ensemble is larger than the caches, more components are
   read side by side than the machine follows of itself. Beyond the last member nothing is read. */
GM_INLINE void K(block_ask_ahead)(const struct gm_task *task, size_t first)
{
    enum { AHEAD = 256 }; /* numbers */
    for (int c = 0; c < GM_COMPONENTS; c++) {
        __builtin_prefetch(task->y + (size_t)c * task->problem->m + first + AHEAD);
    }
}

/* y += increment; compensated: the rounding error goes into carry (Kahan; Hairer, Lubich & Wanner VIII.5). */
GM_INLINE void K(add)(real *y, real *carry, real increment, bool compensated)
{
    if (!compensated) {
        *y += increment;
        return;
    }
    real old = *y;
    *carry += increment;
    *y = old + *carry;
    *carry += old - *y;
}

/* What K(somewhere_beyond) asks of a block: how far its numbers are from 0, by their bits. */
GM_INLINE mask K(block_distance)(const struct K(block) * block, double limit)
{
    mask farthest = K(distance)(block->y[0], limit);
    for (int c = 1; c < GM_COMPONENTS; c++) {
        farthest = K(farther)(farthest, K(distance)(block->y[c], limit));
    }
    return farthest;
}
