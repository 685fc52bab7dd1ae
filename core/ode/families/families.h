/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The families of schemes as declarations, from the list families.def. */
#ifndef GM_CORE_ODE_FAMILIES_FAMILIES_H
#define GM_CORE_ODE_FAMILIES_FAMILIES_H

#include "core/ode/ode.h"

#define GM_FAMILY(name) extern const struct gm_family gm_family_##name;
#include "core/ode/families/families.def"
#undef GM_FAMILY

#endif
