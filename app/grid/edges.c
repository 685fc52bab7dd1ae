/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where the cells of a map begin and end. */
#include "app/grid/edges.h"

#include <math.h>

static double on_scale(double value, bool logarithmic)
{
    return logarithmic ? log(value) : value;
}

void gm_edges_of(const double *values, size_t count, bool logarithmic, double *edges)
{
    const double start = on_scale(values[0], logarithmic), end = on_scale(values[count - 1], logarithmic);
    /* a single value has no neighbour to tell the width of its cell */
    const double first = count > 1 ? on_scale(values[1], logarithmic) - start : 1;
    const double last = count > 1 ? end - on_scale(values[count - 2], logarithmic) : 1;
    for (size_t i = 0; i <= count; i++) {
        const double before = i > 0 ? on_scale(values[i - 1], logarithmic) : start - first;
        const double after = i < count ? on_scale(values[i], logarithmic) : end + last;
        const double edge = (before + after) / 2;
        edges[i] = logarithmic ? exp(edge) : edge;
    }
}
