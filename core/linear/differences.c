/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Central differences at distances that are halved, extrapolated to 0 by Romberg's scheme. */
#include "core/linear/differences.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool gm_differentiate(gm_map *map, const void *context, size_t from_count, const double *from,
                      const double *direction, size_t to_count, double *slope)
{
    enum { DISTANCES = 4 };
    double *memory = malloc((from_count + (1 + DISTANCES) * to_count) * sizeof *memory);
    double *at = memory, *to = at + from_count, *table = to + to_count;
    bool good = memory != NULL;
    for (int k = 0; good && k < DISTANCES; k++) {
        const double distance = ldexp(0.05, -k);
        double *row = table + (size_t)k * to_count;
        memset(row, 0, to_count * sizeof *row);
        for (int side = 1; good && side >= -1; side -= 2) {
            for (size_t i = 0; i < from_count; i++) {
                at[i] = from[i] + side * distance * direction[i];
            }
            good = map(context, at, to);
            for (size_t i = 0; good && i < to_count; i++) {
                row[i] += side * to[i] / (2 * distance);
            }
        }
    }
    double power = 4;
    for (int done = 1; good && done < DISTANCES; done++, power *= 4) {
        for (int k = DISTANCES - 1; k >= done; k--) {
            for (size_t i = 0; i < to_count; i++) {
                double *fine = &table[(size_t)k * to_count + i];
                *fine += (*fine - table[(size_t)(k - 1) * to_count + i]) / (power - 1);
            }
        }
    }
    if (good) {
        memcpy(slope, table + (DISTANCES - 1) * to_count, to_count * sizeof *slope);
    }
    free(memory);
    return good;
}
