/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The nonlinear Dirac equation of Soler, Gross and Neveu. */
#ifndef GM_CORE_FIELD_PROBLEMS_DIRAC_H
#define GM_CORE_FIELD_PROBLEMS_DIRAC_H

#include "core/field/field.h"

/* The standing wave of that frequency, 0 < frequency < mass. */
struct gm_dirac {
    double mass, coupling, frequency;
};

/* The state, Re and Im of psi_1, then of psi_2, at a node. */
void gm_dirac_exact(const struct gm_dirac *dirac, double x, double t, double *s);

/* The caller sets line, n = 4 points and parameters (struct gm_dirac). */
extern const struct gm_problem gm_problem_dirac;

#endif
