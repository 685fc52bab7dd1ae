/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The families of this wing as declarations, from the list families.def. */
#ifndef GM_CORE_FIELD_FAMILIES_FAMILIES_H
#define GM_CORE_FIELD_FAMILIES_FAMILIES_H

#include "core/basics.h"
#include "core/field/field.h"

#define GM_FAMILY(name) extern const struct gm_family gm_family_##name;
#include "core/field/families/families.def"
#undef GM_FAMILY

/* A row of a family's array `schemes`; the last arguments initialise what the family's rows share. */
#define GM_FIELD_SCHEME(name_, title_, order_, claims_, formula_, reference_, ...)                           \
    {                                                                                                        \
        .name = name_, .title = title_, .formula = formula_, .reference = reference_, .order = order_,       \
        .claims = claims_, __VA_ARGS__                                                                       \
    }
/* The fields of a family that all have. */
#define GM_FIELD_FAMILY .kind = &gm_kind_field, .schemes = schemes, .count = GM_COUNT(schemes)

#endif
