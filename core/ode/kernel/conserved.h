/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Quantities that the motion of a problem conserves, by their names, with their gradients. */
#ifndef GM_CORE_ODE_KERNEL_CONSERVED_H
#define GM_CORE_ODE_KERNEL_CONSERVED_H

#include "core/expression/reader.h"
#include "core/ode/ode.h"
#include "core/tape.h"

enum { GM_MOST_CONSERVED = 8 };

struct gm_conserved {
    const struct gm_problem *problem;
    size_t count, n;
    size_t energy; /* number of an H without a formula, whose gradient is made of the field; else `count` */
    bool linear;   /* all are linear */
    struct gm_tape values, slopes, both;
};

/* Opens at most GM_MOST_CONSERVED of them; "H" is the energy. Returns false with what the problem lacks, worded
   like a facet, "" when out of memory; then there is nothing to close. */
bool gm_conserved_open(struct gm_conserved *conserved, const struct gm_problem *problem,
                       const char *const *names, size_t count, char lacks[GM_FAULT_SENTENCE]);
void gm_conserved_close(void *conserved); /* for arenas too */

/* Writes the values (count) and gradients (count * n, by rows) at one member's state. */
void gm_conserved_values(const struct gm_conserved *conserved, const double *y, double *values);
void gm_conserved_slopes(const struct gm_conserved *conserved, const double *y, double *slopes);
/* Both in one pass: the gradients, then the values. */
void gm_conserved_both(const struct gm_conserved *conserved, const double *y, double *slopes);

#endif
