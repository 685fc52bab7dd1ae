/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fields on a line whose rates are a well-known equation (core/model/recognition.h), with the states of the schemes for that
   equation alone. */
#ifndef GM_CORE_FIELD_USER_EQUATION_H
#define GM_CORE_FIELD_USER_EQUATION_H

#include "core/field/field.h"
#include "core/model/recognition.h"
#include "core/user/line.h"

struct gm_user_equation {
    const struct gm_user_system *system;
    struct gm_recognised recognised; /* without a name: none that is known */
    unsigned needs;                  /* its facet; 0: none */
    struct gm_line_formulas formulas;
    size_t outputs; /* of the start: the components, and possibly the rate of the first one */
};

/* Recognises and derives. The graph grows. False when out of memory. */
bool gm_user_equation_derive(struct gm_user_equation *equation, struct gm_user_system *system);
/* Opens the problem with these values of all variables (gm_equations_start). A file with the line "hook: frames" has an
   equation in a frame of the velocity `lambda`, and for the family of frames of Burgers' equation `a` and `d`. Returns false
   when out of memory. The caller closes the problem (gm_user_line_close). */
bool gm_user_equation_open(struct gm_problem *problem, const struct gm_user_equation *equation,
                           const double *values, const struct gm_grid1 *line);

/* Returns the value of a parameter of a file with that hook; `otherwise` without it. */
double gm_frames_number(const struct gm_user_system *system, const double *values, const char *name,
                        double otherwise);

#endif
