/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_FAMILIES_DISPERSIVE_FORM_H
#define GM_CORE_FIELD_FAMILIES_DISPERSIVE_FORM_H

#include "core/field/families/two_step.h"
#include "core/field/multisymplectic.h"

/* The box for equations of first order in time: its loop, its work, which gm_two_step_close closes, and its
   gm_family.form. */
struct gm_progress gm_dispersive_advance(const struct gm_task *task);
void *gm_dispersive_open(const struct gm_problem *problem);
/* One step of the linearised scheme: a tangent at the next level, from that at the present one, both as real
   parts and then imaginary ones; `base` holds the means of the solution in the cells between the two levels,
   likewise. */
enum gm_status gm_dispersive_tangent(struct gm_two_step_work *work, const struct gm_problem *problem,
                                     double dt, const double *base, const double *now, double *next);
double gm_dispersive_form(const struct gm_law *law);

/* What the next step of the box leaves of a local law in every cell,
       energy     [V(b) - V(a) - (b - a) V'((a + b)/2)] / dt    from a = A_x f^n to b = A_x f^{n+1}
       momentum   the same over dx                              from a = A_t f_i to b = A_t f_{i+1}
   with V' = g, of second order, and of mass or charge what rounding leaves. `scheme` is the box. False where
   memory is short or the step fails. */
bool gm_dispersive_laws(const struct gm_problem *problem, const struct gm_scheme *scheme, double dt,
                        const double *y, enum gm_local_law law, double *residual);

#endif
