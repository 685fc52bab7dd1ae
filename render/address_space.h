/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_ADDRESS_SPACE_H
#define GM_RENDER_ADDRESS_SPACE_H

#include <stdbool.h>
#include <stdlib.h>
#include <sys/resource.h>

/* Returns true if the address space is limited: optional work is then left out. */
static inline bool gm_address_space_is_limited(void)
{
    struct rlimit space;
    return getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur != RLIM_INFINITY;
}

/* Returns true if the system gives this number of bytes. Libraries seldom report a refusal of memory; the
   program's malloc, called here, notes it. */
static inline bool gm_address_space_has(size_t bytes)
{
    void *volatile memory = malloc(bytes); /* volatile: the compiler must keep the allocation */
    const bool has = memory != NULL;
    free(memory);
    return has;
}

#endif
