/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_LINEAR_DIFFERENCES_H
#define GM_CORE_LINEAR_DIFFERENCES_H

#include <stdbool.h>
#include <stddef.h>

/* Derivatives of a map along a direction, by central differences at falling distances, extrapolated. */

/* A map from numbers [from_count] to numbers [to_count]. */
struct gm_map {
    bool (*image)(const void *context, const double *from, double *to); /* false if it fails */
    const void *context;
    size_t from_count, to_count;
};

/* slope := d/de map(from + e direction) at e = 0; good to about 1e-12 of the values if the map is smooth
   over a distance of 0.05 times the direction. If the extrapolation does not settle over that, distances
   are shorter, and round-off grows by the same factor. Returns false when out of memory, or if the map
   fails. */
bool gm_differentiate(const struct gm_map *map, const double *from, const double *direction, double *slope);

#endif
