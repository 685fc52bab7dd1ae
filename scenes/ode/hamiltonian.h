/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_ODE_HAMILTONIAN_H
#define GM_SCENES_ODE_HAMILTONIAN_H

#include "core/ode/ode.h"
#include "scenes/common/scene.h"

/* The energy of the only member of a problem that has a Hamiltonian. */
double gm_hamiltonian_energy(const struct gm_view *view);

#endif
