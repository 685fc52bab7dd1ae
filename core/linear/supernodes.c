/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangular solves by supernodes, after E. Ng & B. Peyton, SIAM J. Sci. Comput. 14 (1993) 1034: with x_s the
   columns of a supernode, D its triangle, M what is below it in the rows R,
       L x = b:   x_s = D^-1 b_s,   b_R -= M x_s      from the first supernode on
       L' x = b:  x_s = D^-T (b_s - M' x_R)           from the last one back */
#include "core/linear/supernodes.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "core/basics.h"

#define REAL double
#define STORED double
#define LANES 4
#define VALUES wide
#define PASS(name) name##_wide
#include "core/linear/supernodes.loop.h"

#define REAL float
#define STORED float
#define LANES 8
#define VALUES narrow
#define PASS(name) name##_narrow
#include "core/linear/supernodes.loop.h"

#define REAL float
#define STORED int16_t
#define LANES 8
#define VALUES whole
#define PASS(name) name##_whole
#include "core/linear/supernodes.loop.h"

void gm_supernodes_invert_diagonal(struct gm_supernodes *triangle)
{
    for (size_t s = 0; s < triangle->supernodes; s++) {
        const double *at = triangle->wide + triangle->value_start[s];
        const int rows = triangle->row_start[s + 1] - triangle->row_start[s];
        for (int j = triangle->first[s]; j < triangle->first[s + 1]; j++, at += rows + 1) {
            triangle->inverse[j] = 1 / *at;
        }
    }
}

/* Writes `count` doubles below a diagonal as integers and returns their unit, for which the largest integer
   has its largest value. Here and below the output overwrites doubles that are not needed any more. */
static double make_whole(size_t count, const double *below, double diagonal, char *into)
{
    double most = 1e-9 * diagonal;
    for (size_t i = 0; i < count; i++) {
        most = fmax(most, fabs(below[i]));
    }
    const double unit = most / INT16_MAX;
    for (size_t i = 0; i < count; i++) {
        const int16_t whole = (int16_t)rint(below[i] / unit);
        memcpy(into + i * sizeof whole, &whole, sizeof whole);
    }
    return unit;
}

static double make_floats(size_t count, const double *below, char *into)
{
    for (size_t i = 0; i < count; i++) {
        const float narrow = (float)below[i];
        memcpy(into + i * sizeof narrow, &narrow, sizeof narrow);
    }
    return 1;
}

size_t gm_supernodes_narrow(struct gm_supernodes *triangle, size_t values)
{
    const size_t in_cache = (size_t)1 << 20; /* these take less time as floats, which need not be converted */
    const bool whole = values > in_cache;
    const size_t bytes = whole ? sizeof *triangle->whole : sizeof *triangle->narrow;
    char *into = (char *)triangle->wide;
    for (size_t s = 0; s < triangle->supernodes; s++) {
        const size_t rows = (size_t)(triangle->row_start[s + 1] - triangle->row_start[s]),
                     start = (size_t)triangle->value_start[s], first = (size_t)triangle->first[s],
                     columns = (size_t)triangle->first[s + 1] - first;
        for (size_t j = 0; j < columns; j++) {
            const size_t at = start + j * rows + j + 1, count = rows - j - 1;
            const double *below = triangle->wide + at;
            double *inverse = triangle->inverse + first + j;
            const double unit = whole ? make_whole(count, below, 1 / *inverse, into + at * bytes)
                                      : make_floats(count, below, into + at * bytes);
            *inverse *= unit;
            triangle->weight[first + j] = 1 / (unit * unit);
        }
    }
    triangle->whole = whole ? (int16_t *)(void *)into : NULL;
    triangle->narrow = whole ? NULL : (float *)(void *)into;
    triangle->wide = NULL;
    return bytes;
}

void gm_supernodes_solve(const struct gm_supernodes *triangle, double *x, double *scratch)
{
    if (triangle->wide) {
        forward_wide(triangle, x, scratch, NULL);
        backward_wide(triangle, x, scratch, NULL);
        return;
    }
    /* M S S M' x = b */
    float *narrow = (float *)(void *)scratch, *panel = narrow + triangle->n,
          *read = panel + triangle->most_rows;
    for (size_t i = 0; i < triangle->n; i++) {
        narrow[i] = (float)x[i];
    }
    (triangle->whole ? forward_whole : forward_narrow)(triangle, narrow, panel, read);
    for (size_t i = 0; i < triangle->n; i++) {
        narrow[i] = (float)(narrow[i] * triangle->weight[i]);
    }
    (triangle->whole ? backward_whole : backward_narrow)(triangle, narrow, panel, read);
    for (size_t i = 0; i < triangle->n; i++) {
        x[i] = (double)narrow[i];
    }
}
