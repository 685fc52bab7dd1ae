/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The wing of ordinary differential equations as the hall sees it: its facets, the families of schemes
   that need them, and what those are certified by: every subject that they fit. */
#include "core/ode/ode.h"

#include <math.h>

#include "core/certify.h"
#include "core/ode/certify/measure.h"
#include "core/ode/certify/quantities.h"
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

static void measure(struct gm_certificate *certificate, const struct gm_subject *subject)
{
    const struct gm_scheme *scheme = certificate->scheme;
    const char *name = subject->problem.name;
    const double order = gm_measure_order(subject, scheme);
    /* what counts is the lowest: before the asymptotic regime an order may look higher than it is */
    if (!certificate->order_problem[0] || !(order >= certificate->order)) {
        certificate->order = order;
        certificate->order_problem = name;
    }
    gm_certificate_note(certificate, GM_SYMMETRIC, gm_symmetry_defect(subject, scheme), name);
    if (subject->hamiltonian) {
        gm_certificate_note(certificate, GM_REVERSIBLE, gm_reversibility_defect(subject, scheme), name);
    }
    if (!scheme->family->own_time) {
        if (subject->hamiltonian) {
            gm_certificate_note(certificate, GM_SYMPLECTIC, gm_symplecticity_defect(subject, scheme), name);
        }
        if (subject->volume) {
            gm_certificate_note(certificate, GM_KEEPS_VOLUME, gm_volume_defect(subject, scheme), name);
        }
    }
    if (subject->hamiltonian) {
        gm_certificate_note(certificate, GM_KEEPS_ENERGY, gm_energy_drift(subject, scheme), name);
    }
    if (subject->linear[0]) {
        gm_certificate_note(certificate, GM_KEEPS_LINEAR,
                            gm_drift(subject, scheme, subject->linear, GM_SUBJECT_INVARIANTS), name);
    }
    if (subject->quadratic[0]) {
        gm_certificate_note(certificate, GM_KEEPS_QUADRATIC,
                            gm_drift(subject, scheme, subject->quadratic, GM_SUBJECT_INVARIANTS), name);
    }
    if (subject->bilinear[0]) {
        gm_certificate_note(certificate, GM_KEEPS_BILINEAR,
                            gm_drift(subject, scheme, subject->bilinear, GM_SUBJECT_INVARIANTS), name);
    }
}

static void certify(const struct gm_scheme *scheme, struct gm_certificate *certificate)
{
    for (size_t i = 0; i < gm_subject_count(); i++) {
        const struct gm_subject subject = gm_subject_at(i);
        if (gm_subject_fits(&subject, scheme)) {
            measure(certificate, &subject);
        }
    }
    /* a scheme that chooses its order has to follow its tolerance */
    certificate->order_holds = scheme->order == 0
                                   ? certificate->order > 0.5
                                   : fabs(certificate->order - scheme->order) < 0.05 * scheme->order;
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
    .certify = certify,
    .families = families,
    .quantities = gm_ode_quantities,
};
