/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The headers that every family of this wing includes. */
#ifndef GM_CORE_FIELD_FAMILIES_FAMILY_H
#define GM_CORE_FIELD_FAMILIES_FAMILY_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/field/families/families.h"
#include "core/field_scheme_texts.h"

/* The fields of a family that all have. */
#define GM_FIELD_FAMILY .kind = &gm_kind_field, .schemes = schemes, .count = GM_COUNT(schemes)

#endif
