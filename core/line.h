/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINE_H
#define GM_CORE_LINE_H

#include <stdbool.h>
#include <stddef.h>

/* A grid of equal spacing; node i lies at first + i dx. A periodic field obeys u(x + points dx) = u(x) +
   jump. Between walls, nodes 0 and points / 2, the field is one half of a ring, whose other half is its mirror image:
   node points - i stands where node i does. */
struct gm_line {
    size_t points;
    double dx, first, jump;
    bool walls;
};

/* How many nodes there are between walls, both included, or around the ring. */
static inline size_t gm_line_seen(const struct gm_line *line)
{
    return line->walls ? line->points / 2 + 1 : line->points;
}

/* Node i; nodes on both sides of x = 0 are exact opposites where the grid is symmetric. */
static inline double gm_line_node(const struct gm_line *line, size_t i)
{
    return ((double)(i < gm_line_seen(line) ? i : line->points - i) + line->first / line->dx) * line->dx;
}

/* How much of dx belongs to a node that is seen: of walls a half. */
static inline double gm_line_share(const struct gm_line *line, size_t i)
{
    return line->walls && (i == 0 || 2 * i == line->points) ? 0.5 : 1;
}

#endif
