/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wing of fields in one space dimension: its facets, and the families of schemes that need them. */
#include "core/field/field.h"

#include "core/field/certify.h"
#include "core/field/families/families.h"

static unsigned facets(const struct gm_problem *problem)
{
    const struct gm_field *field = gm_field_of(problem);
    return (field->form ? GM_NEEDS_FORM : 0) | (field->wave ? GM_NEEDS_WAVE : 0) | field->equation;
}

static const struct gm_facet_words words[] = {
    {GM_NEEDS_BURGERS, "Burgers' equation", "Burgers' equation"},
    {GM_NEEDS_KDV, "the Korteweg-de Vries equation", "the Korteweg-de Vries equation"},
    {GM_NEEDS_NLS, "the nonlinear Schrödinger equation", "the nonlinear Schrödinger equation"},
    {GM_NEEDS_WAVE, "a wave equation", "wave equations"},
    {GM_NEEDS_FORM, "a multisymplectic form", "multisymplectic equations"},
    {0},
};

static const struct gm_family *const families[] = {
#define GM_FAMILY(name) &gm_family_##name,
#include "core/field/families/families.def"
#undef GM_FAMILY
    NULL,
};

const struct gm_kind gm_kind_field = {
    .name = "field",
    .problems = "waves on a line",
    .words = words,
    .facets = facets,
    .certify = gm_certify_field,
    .families = families,
};
