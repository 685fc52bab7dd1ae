/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The row of an implicit Runge-Kutta method, which its loops over kernels and its own loop share. */
#ifndef GM_CORE_ODE_FAMILIES_IMPLICIT_RUNGE_KUTTA_H
#define GM_CORE_ODE_FAMILIES_IMPLICIT_RUNGE_KUTTA_H

enum { GM_IMPLICIT_STAGES = 4, GM_IMPLICIT_SUBSTEPS = 32 };

/* An implicit Runge-Kutta method, made `substeps` times in one step with the given fractions of it: so a
   composition of a symmetric method with itself is one row. */
struct gm_implicit_row {
    int stages;
    double a[GM_IMPLICIT_STAGES][GM_IMPLICIT_STAGES];
    double b[GM_IMPLICIT_STAGES];
    int substeps;
    double fractions[GM_IMPLICIT_SUBSTEPS];
};

#endif
