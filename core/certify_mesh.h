/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_CERTIFY_MESH_H
#define GM_CORE_CERTIFY_MESH_H

#include "core/scheme.h"

/* What is measured of a scheme on meshes, on one soliton and a few nodes. Infinite where a run failed. */
struct gm_mesh_measures {
    double order;         /* the exponent of differences between runs with halved steps; NaN: not found */
    double symmetry;      /* |step(-dt) step(dt) - 1| */
    double reversibility; /* the same with the velocities turned round */
    double symplecticity; /* change of dy dp_y + dX dp_X over a step, on the states that the mesh constraint
                             allows */
    double energy;        /* largest relative change of the energy */
    double multisymplecticity; /* defect of the local law of the trapezoidal discrete Lagrangian, over all
                                  stretches of the mesh; NaN on a uniform mesh and where the step varies */
};

struct gm_mesh_measures gm_measure_on_mesh(const struct gm_scheme *scheme);

#endif
