/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A block: GM_LANES members in registers. Loading and storing, compensated addition, the blow-up test. */

/* Components that Runge-Kutta methods process at once: in a single run two, in one register, if n is even,
   and if q and p have an even half each. Without this the compiler takes some singly and others together, and
   a register waits for the values stored singly. It waits too if a kernel's numbers do not fit into
   registers: above 8 components they are taken singly (measured: of 12 a quarter of the time gained or lost).
   */
#undef GM_AT_ONCE
#undef some
#ifdef GM_SEPARABLE
#define GM_TWICE (GM_COMPONENTS % 4 == 0 && GM_COMPONENTS <= 8)
#else
#define GM_TWICE (GM_COMPONENTS % 2 == 0 && GM_COMPONENTS <= 8)
#endif
#if defined(GM_PASS_SCALAR) && GM_TWICE
#define GM_AT_ONCE 2
#define some gm_packed
GM_INLINE gm_packed K(pick_some)(bool choose, gm_packed yes, gm_packed no)
{
    return choose ? yes : no;
}
/* sum + |x|, one component after the other */
GM_INLINE double K(add_magnitudes)(double sum, gm_packed x)
{
    x = (gm_packed)((gm_packed_bits)x & INT64_MAX);
    sum += x[0];
    return sum + x[1];
}
#else
#define GM_AT_ONCE 1
#define some real
GM_INLINE real K(pick_some)(mask choose, real yes, real no)
{
    return K(pick)(choose, yes, no);
}
GM_INLINE real K(add_magnitudes)(real sum, real x)
{
    return sum + K(magnitude)(x);
}
#endif
#undef GM_TWICE
GM_INLINE some K(take)(const real *from)
{
    return *(const some *)from;
}
GM_INLINE void K(put)(real *to, some x)
{
    *(some *)to = x;
}

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
    real carry[GM_COMPONENTS]; /* the rounding errors of y, for compensated summation */
    real force[GM_COMPONENTS]; /* splitting: the last kick's force, while q has not moved since */
    bool force_known;
};

/* The cost of the steps, summed over the lanes that are members. */
struct K(counts) {
    int lanes;      /* members in this block */
    bool continued; /* these are not the run's first steps */
    unsigned long evaluations, solves, iterations;
    struct gm_unsolved unsolved; /* the last lane that was not solved */
};

/* Loads members from `first` on; a block beyond the last member repeats it, which changes nothing. `whole`:
   no block of a group does, so that members are moved by instructions without a branch. */
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

/* Prefetches the numbers 256 members ahead: if an ensemble is larger than the caches, more components are
   read side by side than the machine prefetches. Nothing beyond the last member is read. */
GM_INLINE void K(block_ask_ahead)(const struct gm_task *task, size_t first)
{
    enum { AHEAD = 256, CACHES = 1 << 22 }; /* in numbers */
    const size_t m = task->problem->m;
    for (size_t c = 0; GM_COMPONENTS * m > CACHES && c < GM_COMPONENTS; c++) {
        __builtin_prefetch(task->y + c * m + first + AHEAD);
    }
}

/* y += increment; compensated: the rounding error goes into carry (Kahan; Hairer, Lubich & Wanner VIII.5). */
#define GM_ADD(name, number)                                                                                 \
    GM_INLINE void K(name)(real * at, real * carry_at, number increment, bool compensated)                   \
    {                                                                                                        \
        number *y = (number *)at, *carry = (number *)carry_at;                                               \
        if (!compensated) {                                                                                  \
            *y += increment;                                                                                 \
            return;                                                                                          \
        }                                                                                                    \
        number old = *y;                                                                                     \
        *carry += increment;                                                                                 \
        *y = old + *carry;                                                                                   \
        *carry += old - *y;                                                                                  \
    }
GM_ADD(add, real)
GM_ADD(add_some, some)
#undef GM_ADD

/* Returns, for K(somewhere_beyond), the distance of a block's numbers from 0, by their bits; beyond all limits if a
   surface that the task watches is not ahead of them. */
GM_INLINE mask K(block_distance)(const struct K(block) * block, const struct gm_task *task)
{
    mask farthest = K(distance)(block->y[0], task->limit);
    for (int c = 1; c < GM_COMPONENTS; c++) {
        farthest = K(farther)(farthest, K(distance)(block->y[c], task->limit));
    }
#if defined(GM_SURFACES) && defined(GM_PASS_SCALAR)
    double inside[GM_SURFACES];
    K(surfaces)(block->y, inside, task->problem->parameters);
    for (int i = 0; i < GM_SURFACES; i++) {
        farthest |= task->watches & !(inside[i] > 0);
    }
#endif
    return farthest;
}
