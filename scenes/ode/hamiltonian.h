/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_HAMILTONIAN_H
#define GM_SCENES_ODE_HAMILTONIAN_H

#include "core/ode/ode.h"
#include "scenes/frame/scene.h"

/* The energy of the only member of a problem that has a Hamiltonian. */
double gm_hamiltonian_energy(const struct gm_view *view);

/* Signed area within a closed smooth edge, given by `count` points x + i y at equal distances of a parameter
   from 0 to 2 pi, and its derivatives there. NaN where points and derivatives part: too few points are left
   between two bends. */
double gm_edge_area(const double _Complex *edge, const double _Complex *derivatives, size_t count);
#define GM_UNRESOLVED_EDGE "the members no longer resolve the edge of the disc"

#endif
