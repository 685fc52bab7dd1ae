/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of variational integrators with a fixed step: a polynomial through control points from 0 to 1, and
   a quadrature; with constraints the control points are those of the quadrature. */
#ifndef GM_CORE_ODE_FAMILIES_VARIATIONAL_H
#define GM_CORE_ODE_FAMILIES_VARIATIONAL_H

#include <stdbool.h>
#include <stddef.h>

enum { GM_VARIATIONAL_POINTS = 4 };

struct gm_variational_row {
    size_t degree, points;
    double control[GM_VARIATIONAL_POINTS]; /* degree + 1 */
    double b[GM_VARIATIONAL_POINTS], c[GM_VARIATIONAL_POINTS];
    bool late;   /* the momenta at the end are not put into the tangent of the constraints: SHAKE */
    bool damped; /* a friction -c p is solved apart */
};

#endif
