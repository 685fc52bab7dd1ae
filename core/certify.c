/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "core/certify.h"

#include <math.h>

#include "core/certify_complex.h"
#include "core/certify_field.h"
#include "core/certify_mesh.h"
#include "core/certify_parts.h"

/* keeps the worst */
static void note(struct gm_measure *measure, double defect, const char *problem)
{
    if (!measure->measured || !(defect <= measure->defect)) {
        measure->defect = defect;
        measure->problem = problem;
    }
    measure->measured = true;
}

static unsigned bit_of(enum gm_claim claim)
{
    unsigned bit = 0;
    while (1u << bit != (unsigned)claim) {
        bit++;
    }
    return bit;
}

static void measure(struct gm_certificate *certificate, const struct gm_subject *subject)
{
    const struct gm_scheme *scheme = certificate->scheme;
    const char *name = subject->problem.name;
    struct gm_measure *claims = certificate->claims;
    const double order = gm_measure_order(subject, scheme);
    /* what counts is the lowest: before the asymptotic regime an order may look higher than it is */
    if (!certificate->order_problem[0] || !(order >= certificate->order)) {
        certificate->order = order;
        certificate->order_problem = name;
    }
    if (!scheme->family->own_time) {
        note(&claims[bit_of(GM_SYMMETRIC)], gm_symmetry_defect(subject, scheme), name);
        if (subject->hamiltonian) {
            note(&claims[bit_of(GM_SYMPLECTIC)], gm_symplecticity_defect(subject, scheme), name);
            note(&claims[bit_of(GM_REVERSIBLE)], gm_reversibility_defect(subject, scheme), name);
        }
        if (subject->volume) {
            note(&claims[bit_of(GM_KEEPS_VOLUME)], gm_volume_defect(subject, scheme), name);
        }
    }
    if (subject->hamiltonian) {
        note(&claims[bit_of(GM_KEEPS_ENERGY)], gm_energy_drift(subject, scheme), name);
    }
    if (subject->linear[0]) {
        note(&claims[bit_of(GM_KEEPS_LINEAR)],
             gm_drift(subject, scheme, subject->linear, GM_SUBJECT_INVARIANTS), name);
    }
    if (subject->quadratic[0]) {
        note(&claims[bit_of(GM_KEEPS_QUADRATIC)],
             gm_drift(subject, scheme, subject->quadratic, GM_SUBJECT_INVARIANTS), name);
    }
}

/* Schemes on meshes have a problem of their own. Their equations are solved to 1e-11, no better: multipliers
   carry the round-off of the squared step. */
static void certify_on_mesh(const struct gm_scheme *scheme, struct gm_certificate *certificate,
                            double *farthest)
{
    const struct gm_mesh_measures measures = gm_measure_on_mesh(scheme);
    const struct {
        enum gm_claim claim;
        double defect;
    } list[] = {
        {GM_SYMMETRIC, measures.symmetry},
        {GM_REVERSIBLE, measures.reversibility},
        {GM_SYMPLECTIC, measures.symplecticity},
        {GM_KEEPS_ENERGY, measures.energy},
        {GM_MULTISYMPLECTIC, measures.multisymplecticity},
    };
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        struct gm_measure *measure = &certificate->claims[bit_of(list[i].claim)];
        const bool differentiated = list[i].claim == GM_SYMPLECTIC || list[i].claim == GM_MULTISYMPLECTIC;
        measure->tolerance = differentiated ? 1e-9 : 1e-11;
        if (!isnan(list[i].defect)) {
            note(measure, list[i].defect, "soliton");
        }
    }
    certificate->order = measures.order;
    certificate->order_problem = "soliton";
    *farthest = isnan(measures.order) ? INFINITY : fabs(measures.order - scheme->order);
}

struct gm_certificate gm_certify(const struct gm_scheme *scheme)
{
    struct gm_certificate certificate = {.scheme = scheme, .order = NAN, .order_problem = ""};
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        certificate.claims[bit].claimed = scheme->claims >> bit & 1;
        certificate.claims[bit].tolerance = 1e-12;
        certificate.claims[bit].problem = "";
    }
    certificate.claims[bit_of(GM_SYMPLECTIC)].tolerance = 1e-10;
    certificate.claims[bit_of(GM_KEEPS_VOLUME)].tolerance = 1e-10;
    for (size_t i = 0; i < gm_subject_count(); i++) {
        const struct gm_subject subject = gm_subject_at(i);
        if (gm_subject_fits(&subject, scheme)) {
            measure(&certificate, &subject);
        }
    }
    double farthest = -1;
    gm_certify_field(&certificate, &farthest);
    if (scheme->needs & GM_NEEDS_MOVING_MESH) {
        certify_on_mesh(scheme, &certificate, &farthest);
    }
    /* a scheme that chooses its order has to follow its tolerance */
    certificate.order_holds = farthest >= 0 ? farthest < 0.15
                              : scheme->order == 0
                                  ? certificate.order > 0.5
                                  : fabs(certificate.order - scheme->order) < 0.05 * scheme->order;
    if (scheme->needs & GM_NEEDS_COMPLEX) {
        gm_certify_complex(scheme, &certificate);
    }
    certificate.holds = certificate.order_holds;
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        struct gm_measure *result = &certificate.claims[bit];
        result->holds = result->measured && result->defect <= result->tolerance;
        certificate.holds &= !result->claimed || result->holds;
    }
    return certificate;
}
