/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The observables that every scene of ordinary differential equations computes on request. */
#ifndef GM_SCENES_ODE_ASKED_H
#define GM_SCENES_ODE_ASKED_H

#include "scenes/ode/indicators.h"
#include "scenes/ode/modified.h"

/* Errors of modified energies, shown by pictures with GM_SHOW_MODIFIED; what invariants cost, indicators of chaos and of the volume, the last
   of which a hook may have; after those of every scene the action of a ring of members, of systems with momenta. */
enum { GM_INDICATORS = 10, GM_RING_OBSERVABLES = 3, GM_ODE_ASKED = GM_MODIFIED_OBSERVABLES + GM_INDICATORS };
extern const struct gm_observable gm_ode_asked[GM_ODE_ASKED + GM_RING_OBSERVABLES];

/* Members of a scene of Hamiltonian systems that has GM_SHOW_ROW. */
#define GM_ASKED_OF_HAMILTONIAN                                                                              \
    .asked = gm_ode_asked, .asked_count = GM_ODE_ASKED, .asked_shown = gm_modified_shown,                    \
    .draw_asked = gm_draw_modified

#endif
