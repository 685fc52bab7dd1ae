/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/kernel/loops.h"

void gm_field(const struct gm_problem *problem, const double *y, double *f, size_t m)
{
    problem->loops[gm_isa_best()]->field(problem, y, f, m);
}
