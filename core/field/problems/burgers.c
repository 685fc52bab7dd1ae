/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/field/problems/burgers.h"

const struct gm_problem gm_problem_burgers = {
    .name = "Burgers",
    .kind = &gm_kind_field,
    .facets = &(const struct gm_field){.equation = GM_NEEDS_BURGERS},
    .m = 1,
    .bound = 1e3,
};
