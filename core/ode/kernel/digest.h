/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_KERNEL_DIGEST_H
#define GM_CORE_ODE_KERNEL_DIGEST_H

#include <stddef.h>
#include <stdint.h>

/* Two sums of Fowler, Noll & Vo's kind, of different multipliers: against accidents, not against malice. */
struct gm_digest {
    uint64_t a, b;
};

static inline struct gm_digest gm_digest_open(void)
{
    return (struct gm_digest){UINT64_C(0xcbf29ce484222325), UINT64_C(0x9e3779b97f4a7c15)};
}

static inline void gm_digest_add(struct gm_digest *digest, const void *bytes, size_t count)
{
    const unsigned char *at = bytes;
    for (size_t i = 0; i < count; i++) {
        digest->a = (digest->a ^ at[i]) * UINT64_C(0x100000001b3);
        digest->b = (digest->b ^ at[i]) * UINT64_C(0xbf58476d1ce4e5b9);
        digest->b ^= digest->b >> 29;
    }
}

#endif
