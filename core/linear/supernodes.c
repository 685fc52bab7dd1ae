/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Triangular solves by supernodes, after E. Ng & B. Peyton, SIAM J. Sci. Comput. 14 (1993) 1034: with x_s the
   columns of a supernode, D its triangle, M what is below it in the rows R,
       L x = b:   x_s = D^-1 b_s,   b_R -= M x_s      from the first supernode on
       L' x = b:  x_s = D^-T (b_s - M' x_R)           from the last one back */
#include "core/linear/supernodes.h"

#include <string.h>

#include "core/clones.h"

#define REAL double
#define LANES 4
#define VALUES wide
#define PASS(name) name##_wide
#include "core/linear/supernodes.loop.h"

#define REAL float
#define LANES 8
#define VALUES narrow
#define PASS(name) name##_narrow
#include "core/linear/supernodes.loop.h"

void gm_supernodes_invert_diagonal(struct gm_supernodes *triangle)
{
    for (size_t s = 0; s < triangle->supernodes; s++) {
        double *at = triangle->wide + triangle->value_start[s];
        const int rows = triangle->row_start[s + 1] - triangle->row_start[s];
        for (int j = triangle->first[s]; j < triangle->first[s + 1]; j++, at += rows + 1) {
            *at = 1 / *at;
        }
    }
}

void gm_supernodes_narrow(struct gm_supernodes *triangle, size_t values)
{
    const double *wide = triangle->wide;
    char *into = (char *)triangle->wide;
    for (size_t i = 0; i < values; i++) {
        const float narrow = (float)wide[i];
        memcpy(into + i * sizeof narrow, &narrow, sizeof narrow);
    }
    triangle->narrow = (float *)(void *)into;
    triangle->wide = NULL;
}

void gm_supernodes_solve(const struct gm_supernodes *triangle, double *x, double *scratch)
{
    if (triangle->wide) {
        forward_wide(triangle, x, scratch);
        backward_wide(triangle, x, scratch);
        return;
    }
    float *narrow = (float *)(void *)scratch;
    for (size_t i = 0; i < triangle->n; i++) {
        narrow[i] = (float)x[i];
    }
    forward_narrow(triangle, narrow, narrow + triangle->n);
    backward_narrow(triangle, narrow, narrow + triangle->n);
    for (size_t i = 0; i < triangle->n; i++) {
        x[i] = (double)narrow[i];
    }
}
