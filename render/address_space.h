/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_ADDRESS_SPACE_H
#define GM_RENDER_ADDRESS_SPACE_H

#include <stdbool.h>
#include <stdlib.h>
#include <sys/resource.h>

/* Whether it has a limit: what is only quicker is then left alone. */
static inline bool gm_address_space_is_limited(void)
{
    struct rlimit space;
    return getrlimit(RLIMIT_AS, &space) != 0 || space.rlim_cur != RLIM_INFINITY;
}

/* Whether the system gives so many bytes. Libraries that are refused memory seldom say that it was memory:
   asked for as much, the program's own malloc finds out, and notes it. */
static inline bool gm_address_space_has(size_t bytes)
{
    void *volatile memory = malloc(bytes); /* volatile: nothing is done with it, but it is to be asked for */
    const bool has = memory != NULL;
    free(memory);
    return has;
}

#endif
