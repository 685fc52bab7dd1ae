/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_ADAPTIVE_VARIATIONAL_TIME_H
#define GM_CORE_ODE_FAMILIES_ADAPTIVE_VARIATIONAL_TIME_H

/* The memory of schemes with variational time: the next step, the energy they hold to, and, with one degree
   of freedom, the number of restarts. */
enum { GM_VARIATIONAL_TAU, GM_VARIATIONAL_ENERGY, GM_VARIATIONAL_RESTARTS, GM_VARIATIONAL_REMEMBERED };

#endif
