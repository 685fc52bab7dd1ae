/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Central differences at distances that are halved, extrapolated to 0 by Romberg's scheme. */
#include "core/linear/differences.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"

enum { DISTANCES = 4 };

/* Fills `table`, DISTANCES rows of which the last is the slope, from `widest` on; *change is the change by
   the extrapolation's last step, relative to the largest slope. Returns false if the map fails. `at` and
   `to` are scratch. */
static bool extrapolate(gm_map *map, const void *context, size_t from_count, const double *from,
                        const double *direction, size_t to_count, double widest, double *at, double *to,
                        double *table, double *change)
{
    for (int k = 0; k < DISTANCES; k++) {
        const double distance = ldexp(widest, -k);
        double *row = table + (size_t)k * to_count;
        memset(row, 0, to_count * sizeof *row);
        for (int side = 1; side >= -1; side -= 2) {
            for (size_t i = 0; i < from_count; i++) {
                at[i] = from[i] + side * distance * direction[i];
            }
            if (!map(context, at, to)) {
                return false;
            }
            for (size_t i = 0; i < to_count; i++) {
                row[i] += side * to[i] / (2 * distance);
            }
        }
    }
    double power = 4, last = 0, largest = 0;
    for (int done = 1; done < DISTANCES; done++, power *= 4) {
        for (int k = DISTANCES - 1; k >= done; k--) {
            last = 0;
            for (size_t i = 0; i < to_count; i++) {
                double *fine = &table[(size_t)k * to_count + i];
                const double by = (*fine - table[(size_t)(k - 1) * to_count + i]) / (power - 1);
                *fine += by;
                last = gm_larger(fabs(by), last);
            }
        }
    }
    for (size_t i = 0; i < to_count; i++) {
        largest = fmax(largest, fabs(table[(DISTANCES - 1) * to_count + i]));
    }
    *change = largest > 0 ? last / largest : 0;
    return true;
}

bool gm_differentiate(gm_map *map, const void *context, size_t from_count, const double *from,
                      const double *direction, size_t to_count, double *slope)
{
    const double settled = 1e-11, narrowest = 5e-4;
    double *memory = malloc((from_count + (1 + DISTANCES) * to_count) * sizeof *memory);
    double *at = memory, *to = at + from_count, *table = to + to_count, best = INFINITY;
    for (double widest = 0.05; memory && best > settled && widest > narrowest; widest /= 4) {
        double change;
        if (extrapolate(map, context, from_count, from, direction, to_count, widest, at, to, table,
                        &change) &&
            change < best) {
            best = change;
            memcpy(slope, table + (DISTANCES - 1) * to_count, to_count * sizeof *slope);
        }
    }
    free(memory);
    return isfinite(best);
}
