/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_GRID1_H
#define GM_CORE_GRID1_H

#include <stdbool.h>
#include <stddef.h>

/* A grid of equal spacing; node i lies at first + i dx. A periodic field obeys u(x + points dx) = u(x) +
   jump. Between walls, nodes 0 and points / 2, the field is one half of a ring, whose other half is its
   mirror image: node points - i is at the place of node i. */
struct gm_grid1 {
    size_t points;
    double dx, first, jump;
    bool walls;
};

/* The number of nodes between walls, both included, or around the ring. */
static inline size_t gm_grid1_seen(const struct gm_grid1 *grid)
{
    return grid->walls ? grid->points / 2 + 1 : grid->points;
}

/* Node i; nodes on both sides of x = 0 are exact opposites where the grid is symmetric. */
static inline double gm_grid1_node(const struct gm_grid1 *grid, size_t i)
{
    return ((double)(i < gm_grid1_seen(grid) ? i : grid->points - i) + grid->first / grid->dx) * grid->dx;
}

/* The part of dx that belongs to a visible node: a half at walls. */
static inline double gm_grid1_share(const struct gm_grid1 *grid, size_t i)
{
    return grid->walls && (i == 0 || 2 * i == grid->points) ? 0.5 : 1;
}

#endif
