/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_DISPERSIVE_SOLITONS_H
#define GM_TESTS_COMMON_DISPERSIVE_SOLITONS_H

#include "core/field/problems/dispersive.h"
#include "core/field/problems/wave.h"

/* One soliton of Korteweg-de Vries and one of nonlinear Schroedinger, with velocity 1 from x = -5, on a ring
   of length 40. */

static const struct gm_kdv soliton = {
    .initial = GM_KDV_SOLITON, .eta = 1, .mu = 1, .velocity = 1, .position = -5};
static const struct gm_nls bright = {
    .initial = GM_NLS_SOLITON, .amplitude = 1, .velocity = 1, .position = -5};

static inline struct gm_problem kdv_problem(size_t points)
{
    struct gm_problem problem = gm_problem_kdv;
    problem.parameters = &soliton;
    problem.line = (struct gm_grid1){points, 40.0 / (double)points, -20, 0, false};
    problem.n = gm_wave_size(points);
    return problem;
}

static inline struct gm_problem nls_problem(size_t points)
{
    struct gm_problem problem = gm_problem_nls;
    problem.parameters = &bright;
    problem.line = (struct gm_grid1){points, 40.0 / (double)points, -20, 0, false};
    problem.n = 2 * points;
    return problem;
}

#endif
