/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What schemes for ordinary differential equations are certified by: every subject that they fit. */
#include "core/ode/certify/certify.h"

#include <math.h>

#include "core/ode/certify/measure.h"

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

void gm_certify_ode(const struct gm_scheme *scheme, struct gm_certificate *certificate)
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
