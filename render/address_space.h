/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_ADDRESS_SPACE_H
#define GM_RENDER_ADDRESS_SPACE_H

#include <stdbool.h>
#include <stdlib.h>
#include <sys/resource.h>

/* Returns true if the address space is limited; what only saves time is then left out. */
static inline bool gm_address_space_is_limited(void)
{
    struct rlimit space;
    return getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur != RLIM_INFINITY;
}

/* Returns true if the system gives this number of bytes. Libraries that are refused memory seldom report it;
   this allocation goes through the program's malloc, which notes the refusal. */
static inline bool gm_address_space_has(size_t bytes)
{
    void *volatile memory = malloc(bytes); /* volatile: the compiler must keep the allocation */
    const bool has = memory != NULL;
    free(memory);
    return has;
}

#endif
