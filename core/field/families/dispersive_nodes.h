/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_DISPERSIVE_NODES_H
#define GM_CORE_FIELD_FAMILIES_DISPERSIVE_NODES_H

#include "core/field/field.h"

/* The schemes of nodes for equations of first order in time, and their multisymplectic law. */

/* Korteweg-de Vries: the level at t + dt from those at t and t - dt; with `base`, a level of a solution at t,
   of the linearised scheme. All arrays have `points` numbers; flux is scratch. */
void gm_kdv_nodes_step(const struct gm_problem *problem, bool centred, double dt, const double *base,
                       const double *past, const double *now, double *next, double *flux);

/* Schroedinger: a tangent of the solution p^{n-1}, q^n becomes that of p^n, q^{n+1}. */
void gm_nls_nodes_tangent(const struct gm_problem *problem, double dt, const double *p_new, const double *q,
                          double *tangent_p, double *tangent_q);

/* gm_family.form */
double gm_dispersive_nodes_form(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                                const double *y, const double *memory, bool by_differences);

#endif
