/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The rows of variational integrators with a fixed step: a polynomial through control points from 0 to 1, and
   a quadrature; with constraints the control points are those of the quadrature. */
#ifndef GM_CORE_ODE_FAMILIES_VARIATIONAL_DISCRETE_LAGRANGIAN_H
#define GM_CORE_ODE_FAMILIES_VARIATIONAL_DISCRETE_LAGRANGIAN_H

#include "core/ode/kernel/members.h"

enum { GM_VARIATIONAL_POINTS = 4 };

struct gm_variational_row {
    size_t degree, points;
    double control[GM_VARIATIONAL_POINTS]; /* degree + 1 */
    double b[GM_VARIATIONAL_POINTS], c[GM_VARIATIONAL_POINTS];
    bool late;   /* the momenta at the end are not put into the tangent of the constraints: SHAKE */
    bool damped; /* a friction -c p is solved apart */
    /* Writes l_j and l_j' at the points, for these settings, of a discrete Lagrangian that is not the action
       of a polynomial; the tables define the unknowns between q0 and q1. NULL: a polynomial. */
    void (*tables)(const struct gm_settings *settings, double *values, double *slopes);
};

/* The steps of such rows. */
extern const struct gm_member_family gm_variational_members;

#endif
