/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wing of flows on complexes: the families of schemes. */
#include "core/flow/flow.h"

#include "core/flow/certify.h"
#include "core/flow/families/families.h"

static const struct gm_family *const families[] = {
#define GM_FAMILY(name) &gm_family_##name,
#include "core/flow/families/families.def"
#undef GM_FAMILY
    NULL,
};

const struct gm_kind gm_kind_flow = {
    .name = "flow",
    .problems = "flows on a mesh",
    .certify = gm_certify_flow,
    .families = families,
};
