/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Symmetries of the heat equation, the moving frame of its invariant schemes, and the symmetries that a
   scheme preserves. */
#ifndef GM_CORE_FIELD_FAMILIES_HEAT_H
#define GM_CORE_FIELD_FAMILIES_HEAT_H

#include "core/field/field.h"
#include "core/field/problems/heat.h"

/* A boost, then a projection, then a scaling, about (t, x) = (0, 0):
       (t, x, u) -> (t, x + b t, u exp(-b x/(2 nu) - b^2 t/(4 nu)))
       (t, x, u) -> (t, x, sqrt(1 - p t) u exp(-p x^2/(4 nu (1 - p t)))) / (1 - p t, 1 - p t, 1)
       (t, x, u) -> (s^2 t, s x, u) */
struct gm_heat_symmetry {
    double boost, projection, scale;
};

/* The groups, as bits. */
enum gm_heat_group { GM_HEAT_SCALINGS = 1, GM_HEAT_BOOSTS = 2, GM_HEAT_PROJECTIONS = 4 };

/* The image of an event under a symmetry; u is NaN if the projection does not exist. */
struct gm_event gm_heat_carried(double diffusivity, const struct gm_heat_symmetry *symmetry,
                                struct gm_event event);

/* The frame of three values h apart about the node in their middle: its boost and, for schemes that
   preserve projections, its projection, after which all three are one. NaN if a value is not positive. */
struct gm_heat_symmetry gm_heat_frame(const struct gm_scheme *scheme, double diffusivity, double h,
                                      const double u[3]);

/* The groups that a scheme claims to commute with. */
unsigned gm_heat_keeps(const struct gm_scheme *scheme);

/* The defect of one step of length k under a symmetry about the middle of the nodes: the step of the
   carried state against the carried step, the largest over all nodes, divided by the value there. The
   carried nodes move, which only invariant schemes take into account. */
double gm_heat_defect(const struct gm_problem *problem, const struct gm_scheme *scheme, double k,
                      const struct gm_heat_symmetry *symmetry, const double *u);

#endif
