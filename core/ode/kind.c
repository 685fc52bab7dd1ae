/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wing of ordinary differential equations: its facets, and the families of schemes that need them. */
#include "core/ode/ode.h"

#include "core/ode/certify/certify.h"
#include "core/ode/families/families.h"
#include "core/ode/kernel/loops.h"

static unsigned facets(const struct gm_problem *problem)
{
    const struct gm_ode *ode = gm_ode_of(problem);
    const struct gm_split *split = ode->split;
    const struct gm_hamiltonian *hamiltonian = ode->hamiltonian;
    return (split ? GM_NEEDS_SPLIT : 0) | (hamiltonian ? GM_NEEDS_HAMILTONIAN : 0) |
           (ode->lagrangian ? GM_NEEDS_LAGRANGIAN : 0) | (ode->fast_linear ? GM_NEEDS_FAST_LINEAR : 0) |
           (ode->kepler_split ? GM_NEEDS_KEPLER_SPLIT : 0) | (ode->volume ? GM_NEEDS_VOLUME : 0) |
           (ode->quadratic ? GM_NEEDS_QUADRATIC : 0) | (split && split->nystrom ? GM_NEEDS_NYSTROM : 0) |
           (hamiltonian && !split ? GM_NEEDS_INSEPARABLE : 0) |
           (hamiltonian && !hamiltonian->partial ? GM_NEEDS_ENERGY : 0);
}

static const struct gm_facet_words words[] = {
    {GM_NEEDS_VOLUME, "parts without divergence that can be solved", "fields without divergence, in pieces"},
    {GM_NEEDS_KEPLER_SPLIT, "a Kepler part with a perturbation", "perturbed Kepler problems"},
    {GM_NEEDS_FAST_LINEAR, "a stiff part that is linear", "systems with a stiff linear part"},
    {GM_NEEDS_LAGRANGIAN, "a Lagrangian of one degree of freedom", "Lagrangians of one degree of freedom"},
    {GM_NEEDS_INSEPARABLE, "a Hamiltonian that does not fall into T(p) + V(q)",
     "Hamiltonian systems that do not separate"},
    {GM_NEEDS_NYSTROM, "a quadratic kinetic energy T(p)",
     "separable Hamiltonian systems of quadratic kinetic energy"},
    {GM_NEEDS_SPLIT, "a Hamiltonian H = T(p) + V(q)", "separable Hamiltonian systems"},
    {GM_NEEDS_HAMILTONIAN, "a Hamiltonian", "Hamiltonian systems"},
    {GM_NEEDS_ENERGY, "an energy of the whole state", "systems with an energy"},
    {GM_NEEDS_QUADRATIC, "a quadratic field", "quadratic vector fields"},
    {0},
};

static gm_loop *loop(const struct gm_scheme *scheme, const struct gm_problem *problem)
{
    /* the loops of wide registers are for ensembles */
    const struct gm_loops *loops =
        gm_ode_of(problem)->loops[problem->m == 1 ? GM_ISA_BASELINE : gm_isa_best()];
    return loops ? loops->over_kernels[scheme->family->over_kernels] : NULL;
}

static const struct gm_family *const families[] = {
#define GM_FAMILY(name) &gm_family_##name,
#include "core/ode/families/families.def"
#undef GM_FAMILY
    NULL,
};

const struct gm_kind gm_kind_ode = {
    .name = "ode",
    .problems = "ordinary differential equations",
    .words = words,
    .facets = facets,
    .loop = loop,
    .certify = gm_certify_ode,
    .families = families,
};
