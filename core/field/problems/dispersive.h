/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equations of first order in time, Korteweg-de Vries and the nonlinear Schroedinger equation: parameters. */
#ifndef GM_CORE_FIELD_PROBLEMS_DISPERSIVE_H
#define GM_CORE_FIELD_PROBLEMS_DISPERSIVE_H

#include "core/field/field.h"
#include "core/field/problems/moving_frames.h"
#include "core/user/line.h"

/* Korteweg-de Vries, u_t + eta u u_x + mu u_xxx = 0, with the state of a wave problem, and its frames of
   reference,
       (t, x, u) -> (t, x + lambda t, u + lambda/eta) */
struct gm_kdv {
    struct gm_framed framed; /* first */
    double eta, mu;
};
static inline const struct gm_kdv *gm_kdv_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

/* Nonlinear Schroedinger, i psi_t + psi_xx + k |psi|^2 psi = 0; the state is Re psi, then Im psi. */
struct gm_nls {
    struct gm_user_line line; /* first; of a file, else empty */
    double k;
};
static inline const struct gm_nls *gm_nls_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

/* The caller sets line, n (kdv: gm_wave_size, nls: 2 points) and parameters (struct gm_kdv; nls: else k = 1). */
extern const struct gm_problem gm_problem_kdv, gm_problem_nls;

#endif
