/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What scenes of Hamiltonian systems observe alike. */
#include "scenes/ode/hamiltonian.h"

double gm_hamiltonian_energy(const struct gm_view *view)
{
    double value = 0;
    gm_ode_of(view->problem)->hamiltonian->energy(view->problem, view->state, &value, 1);
    return value;
}
