/* SPDX-License-Identifier: GPL-3.0-or-later */
/* For every family: the declarations of all, the loop over members, the texts of rows. */
#ifndef GM_CORE_ODE_FAMILIES_FAMILY_H
#define GM_CORE_ODE_FAMILIES_FAMILY_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/ode/families/compositions.h"
#include "core/ode/families/families.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/members.h"
#include "core/ode_scheme_texts.h"

#endif
