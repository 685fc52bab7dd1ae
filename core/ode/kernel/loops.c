/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/ode/kernel/loops.h"

void gm_field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    gm_ode_of(problem)->loops[gm_isa_best()]->field(problem, y, f, m);
}
