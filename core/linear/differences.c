/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Central differences at distances that are halved, extrapolated to 0 by Romberg's scheme. */
#include "core/linear/differences.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"

enum { DISTANCES = 4 };

/* A line through a point, and scratch: `at` on it, `to` its image, and `table`, DISTANCES rows of which the
   last becomes the slope. */
struct line {
    const struct gm_map *map;
    const double *from, *direction;
    double *at, *to, *table;
};

/* Fills the table from the distance `widest` on; *change is the change by the extrapolation's last step,
   relative to the largest slope. Returns false if the map fails. */
static bool extrapolate(const struct line *line, double widest, double *change)
{
    const size_t from_count = line->map->from_count, to_count = line->map->to_count;
    for (int k = 0; k < DISTANCES; k++) {
        const double distance = ldexp(widest, -k);
        double *row = line->table + (size_t)k * to_count;
        memset(row, 0, to_count * sizeof *row);
        for (int side = 1; side >= -1; side -= 2) {
            for (size_t i = 0; i < from_count; i++) {
                line->at[i] = line->from[i] + side * distance * line->direction[i];
            }
            if (!line->map->image(line->map->context, line->at, line->to)) {
                return false;
            }
            for (size_t i = 0; i < to_count; i++) {
                row[i] += side * line->to[i] / (2 * distance);
            }
        }
    }
    double power = 4, last = 0, largest = 0;
    for (int done = 1; done < DISTANCES; done++, power *= 4) {
        for (int k = DISTANCES - 1; k >= done; k--) {
            last = 0;
            for (size_t i = 0; i < to_count; i++) {
                double *fine = &line->table[(size_t)k * to_count + i];
                const double by = (*fine - line->table[(size_t)(k - 1) * to_count + i]) / (power - 1);
                *fine += by;
                last = gm_larger(fabs(by), last);
            }
        }
    }
    for (size_t i = 0; i < to_count; i++) {
        largest = fmax(largest, fabs(line->table[(DISTANCES - 1) * to_count + i]));
    }
    *change = largest > 0 ? last / largest : 0;
    return true;
}

bool gm_differentiate(const struct gm_map *map, const double *from, const double *direction, double *slope)
{
    const double settled = 1e-11, narrowest = 5e-4;
    double *memory = malloc((map->from_count + (1 + DISTANCES) * map->to_count) * sizeof *memory);
    const struct line line = {map,
                              from,
                              direction,
                              .at = memory,
                              .to = memory + map->from_count,
                              .table = memory + map->from_count + map->to_count};
    double best = INFINITY;
    for (double widest = 0.05; memory && best > settled && widest > narrowest; widest /= 4) {
        double change;
        if (extrapolate(&line, widest, &change) && change < best) {
            best = change;
            memcpy(slope, line.table + (DISTANCES - 1) * map->to_count, map->to_count * sizeof *slope);
        }
    }
    free(memory);
    return isfinite(best);
}
