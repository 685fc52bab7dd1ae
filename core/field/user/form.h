/* SPDX-License-Identifier: GPL-3.0-or-later */
/* K z_t + L z_x = grad S(z) with user-defined matrices and function. */
#ifndef GM_CORE_FIELD_USER_FORM_H
#define GM_CORE_FIELD_USER_FORM_H

#include "core/field/field.h"
#include "core/user/line.h"

/* Formulas of a form in its system's graph. */
struct gm_user_form {
    const struct gm_user_system *system;
    gm_node_id hessian[GM_MOST_OF_FORM * GM_MOST_OF_FORM];
    struct gm_line_formulas formulas;
};

/* Derives the formulas into the system's graph; false when out of memory. */
bool gm_user_form_derive(struct gm_user_form *form, struct gm_user_system *system);

/* The problem with these values of all variables (gm_equations_start) on that ring. Returns false when out
   of memory; the caller closes it (gm_user_line_close). */
bool gm_user_form_open(struct gm_problem *problem, const struct gm_user_form *form, const double *values,
                       const struct gm_grid1 *grid);

/* The state at t = 0; potentials (gm_form) are integrated from their slopes, from their value at the left
   end on. */
void gm_user_form_start(const struct gm_problem *problem, double *y);

/* Returns true if neither matrix is 0, the start is finite and closes on the ring up to its jumps and a
   thousandth of its range, and the gradient of S has the period of the jumps. Else the fault has the
   reason. */
bool gm_user_form_closes(const struct gm_problem *problem, struct gm_fault *fault);

/* Returns true if a component follows from the others up to a constant (gm_form). */
bool gm_user_form_is_potential(const struct gm_problem *problem, size_t component);

#endif
