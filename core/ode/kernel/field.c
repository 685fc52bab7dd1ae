/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The right-hand side f(y) of a problem, by the loops for this machine: for whoever has no loop over kernels.
   It stands apart from loops.c, which is compiled once for each problem. */
#include "core/ode/kernel/loops.h"

void gm_field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    gm_ode_of(problem)->loops[gm_isa_best()]->field(problem, y, f, m);
}
