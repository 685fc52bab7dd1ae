/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINE_H
#define GM_CORE_LINE_H

#include <stddef.h>

/* A grid of equal spacing; node i lies at first + i dx. A periodic field obeys u(x + points dx) = u(x) +
   jump. */
struct gm_line {
    size_t points;
    double dx, first, jump;
};

/* Node i; nodes on both sides of x = 0 are exact opposites where the grid is symmetric. */
static inline double gm_line_node(const struct gm_line *line, size_t i)
{
    return ((double)i + line->first / line->dx) * line->dx;
}

#endif
