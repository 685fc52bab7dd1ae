/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MESH_CERTIFY_H
#define GM_CORE_MESH_CERTIFY_H

#include "core/certify.h"

/* Measures a scheme on meshes by one soliton on a few nodes: the order, from differences between runs with
   halved steps; return after a reversed step; the change of dy dp_y + dX dp_X over a step, on the states that
   the mesh constraint allows; the energy; and the defect of the local law of the trapezoidal discrete
   Lagrangian, or on a uniform mesh of that of the midpoint rule where it is less, over all stretches of the
   mesh (not where the step varies). */
void gm_certify_mesh(const struct gm_scheme *scheme, struct gm_certificate *certificate);

#endif
