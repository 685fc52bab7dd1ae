/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_FAMILIES_ADAPTIVE_VARIATIONAL_TIME_H
#define GM_CORE_ODE_FAMILIES_ADAPTIVE_VARIATIONAL_TIME_H

struct gm_scheme;
struct gm_problem;

/* The memory of schemes with variational time: the next step, the energy they hold to, and, with one degree
   of freedom, the number of restarts. */
enum { GM_VARIATIONAL_TAU, GM_VARIATIONAL_ENERGY, GM_VARIATIONAL_RESTARTS, GM_VARIATIONAL_REMEMBERED };

/* gm_family.lacks, of schemes that choose the length of a step whatever dt is: none of their steps ends at an event. */
const char *gm_lacks_events(const struct gm_scheme *scheme, const struct gm_problem *problem);

#endif
