/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_ADAPTIVE_VARIATIONAL_TIME_H
#define GM_CORE_ODE_FAMILIES_ADAPTIVE_VARIATIONAL_TIME_H

/* What the schemes with variational time remember: the step that comes next, the energy they hold to, and,
   those of one degree of freedom, how often they started anew. */
enum { GM_VARIATIONAL_TAU, GM_VARIATIONAL_ENERGY, GM_VARIATIONAL_RESTARTS, GM_VARIATIONAL_REMEMBERED };

#endif
