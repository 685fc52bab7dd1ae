/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The families of this wing as declarations, from the list families.def. */
#ifndef GM_CORE_FIELD_FAMILIES_FAMILIES_H
#define GM_CORE_FIELD_FAMILIES_FAMILIES_H

#include "core/basics.h"
#include "core/field/field.h"

#define GM_FAMILY(name) extern const struct gm_family gm_family_##name;
#include "core/field/families/families.def"
#undef GM_FAMILY

#endif
