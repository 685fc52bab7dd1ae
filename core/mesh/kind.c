/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wing of fields on moving meshes: the families of schemes. */
#include "core/mesh/moving_mesh.h"

#include "core/mesh/certify.h"
#include "core/mesh/families/families.h"

static const struct gm_family *const families[] = {
#define GM_FAMILY(name) &gm_family_##name,
#include "core/mesh/families/families.def"
#undef GM_FAMILY
    NULL,
};

const struct gm_kind gm_kind_mesh = {
    .name = "mesh",
    .problems = "waves on moving meshes",
    .certify = gm_certify_mesh,
    .families = families,
};
