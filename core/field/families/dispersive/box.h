/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_DISPERSIVE_BOX_H
#define GM_CORE_FIELD_FAMILIES_DISPERSIVE_BOX_H

#include "core/field/multisymplectic.h"

/* The box scheme for equations of first order in time, as functions of gm_family: a loop and its work, which
   gm_two_step_close closes, and the multisymplectic law. */
struct gm_progress gm_dispersive_advance(const struct gm_task *task);
void *gm_dispersive_open(const struct gm_problem *problem);
double gm_dispersive_form(const struct gm_law *law);

/* gm_family.form of the schemes of nodes. */
double gm_nodes_form(const struct gm_law *law);

/* Measures the residual of a local law over the next step of the box in every cell,
       energy     [V(b) - V(a) - (b - a) V'((a + b)/2)] / dt    from a = A_x f^n to b = A_x f^{n+1}
       momentum   the same over dx                              from a = A_t f_i to b = A_t f_{i+1}
   with V' = g, of second order, and round-off for mass or charge. `scheme` is the box. False when out
   of memory or if the step fails. */
bool gm_dispersive_laws(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                        const double *y, enum gm_local_law law, double *residual);

#endif
