/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes and certificates as JSON. */
#include "app/output/scheme_json.h"

#include <math.h>

#include "app/output/row.h"
#include "core/ode/indicators/tangent.h"
#include "core/ode/ode.h"
#include "core/schemes.h"

void gm_scheme_put(FILE *stream, const struct gm_scheme *scheme)
{
    struct gm_row row = gm_row_begin(stream);
    gm_row_put(&row, "scheme %s, title %s, order %i, family %s, for %s", scheme->name, scheme->title,
               scheme->order, scheme->family->title, gm_scheme_problems(scheme));
    struct gm_row claims = gm_row_open(&row, "claims", ']');
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (scheme->claims >> bit & 1) {
            gm_row_text(&claims, NULL, gm_claims[bit].key);
        }
    }
    if (scheme->family->kind == &gm_kind_ode) {
        gm_row_put(&row, "tangent %s", gm_tangent_word(scheme));
    }
    gm_row_put(&row, "formula %s, reference %s", scheme->formula, scheme->reference);
    gm_row_close(&row, "");
}

static void put_stability(struct gm_row *theory, const struct gm_theory_stability *stability)
{
    struct gm_row row = gm_row_open(theory, "stability", '}');
    gm_row_put(&row, "of %s, real %.17g, imaginary %.17g",
               stability->oscillator ? "oscillator" : "y' = lambda y", stability->real, stability->imaginary);
    if (!stability->oscillator) {
        gm_row_put(&row, "a_stable %d, l_stable %d", stability->a_stable, stability->l_stable);
    }
}

static void put_theory(struct gm_row *certificate, const struct gm_theory *theory)
{
    struct gm_row row = gm_row_open(certificate, "theory", '}');
    gm_row_put(
        &row,
        "order %i, digits %.17g, failing_condition %s, residual %.17g, symplectic %d, symmetric %d, error_constant %.17g",
        theory->order, theory->digits > 0 ? theory->digits : NAN,
        theory->condition[0] ? theory->condition : NULL, theory->condition[0] ? theory->residual : NAN,
        theory->symplectic, theory->symmetric, theory->error_constant);
    if (theory->stability.known) {
        put_stability(&row, &theory->stability);
    } else {
        gm_row_text(&row, "stability", NULL);
    }
}

void gm_certificate_put(FILE *stream, const struct gm_certificate *certificate, const char *system)
{
    const struct gm_scheme *scheme = certificate->scheme;
    struct gm_row row = gm_row_begin(stream);
    gm_row_put(&row, "scheme %s, family %s, for %s", scheme->name, scheme->family->title,
               gm_scheme_problems(scheme));
    if (system) {
        gm_row_put(&row, "system %s", system);
    }
    gm_row_put(&row, "order %i, measured_order %.17g, order_problem %s, holds %d", scheme->order,
               certificate->order, certificate->order_problem, certificate->holds);
    struct gm_row properties = gm_row_open(&row, "properties", '}');
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *measure = &certificate->claims[bit];
        if (measure->claimed || measure->measured || measure->undecided) {
            struct gm_row claim = gm_row_open(&properties, gm_claims[bit].key, '}');
            gm_row_put(&claim, "claimed %d, measured %d", measure->claimed, measure->measured);
            /* null: it was not measured, or a step of the measurement failed */
            gm_row_put(&claim, "defect %.17g", measure->measured ? measure->defect : NAN);
            fprintf(stream, ",\"tolerance\":%g", measure->tolerance);
            gm_row_put(&claim, "problem %s", measure->problem);
            if (measure->reason) {
                gm_row_put(&claim, "reason %s", measure->reason);
            }
        }
    }
    if (system) {
        struct gm_row list = gm_row_open(&row, "invariants", ']');
        for (size_t i = 0; i < certificate->followed_count; i++) {
            const struct gm_followed *followed = &certificate->followed[i];
            struct gm_row one = gm_row_open(&list, NULL, '}');
            gm_row_put(&one, "name %s, verdict %s, defect %.17g", followed->name, followed->verdict,
                       followed->defect);
            if (followed->status != GM_OK) {
                gm_row_put(&one, "reason %s", gm_status_name(followed->status));
            }
        }
    }
    if (scheme->base) {
        struct gm_row conserves = gm_row_open(&row, "conserves", '}');
        for (size_t i = 0; i < certificate->held_count; i++) {
            const struct gm_verdict *measure = &certificate->held[i].verdict;
            gm_row_number(&conserves, certificate->held[i].name, measure->measured ? measure->defect : NAN,
                          17);
        }
        struct gm_row given_up = gm_row_open(&row, "given_up", ']');
        for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
            if (gm_certificate_given_up(certificate) >> bit & 1) {
                gm_row_text(&given_up, NULL, gm_claims[bit].key);
            }
        }
    }
    if (certificate->same.other) {
        struct gm_row same = gm_row_open(&row, "same_as", '}');
        gm_row_put(&same, "scheme %s, difference %.17g, problem %s", certificate->same.other->name,
                   certificate->same.difference, certificate->same.problem);
    }
    if (certificate->theory.known) {
        put_theory(&row, &certificate->theory);
    } else {
        gm_row_text(&row, "theory", NULL);
    }
    struct gm_row measured = gm_row_open(&row, "measured", '}');
    gm_row_put(&measured, "order %.17g", certificate->order);
    if (certificate->order_reason) {
        gm_row_put(&measured, "order_reason %s", certificate->order_reason);
    }
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *measure = &certificate->claims[bit];
        if (measure->measured || (measure->reason && GM_CERTIFIED_ON_SYSTEMS >> bit & 1)) {
            gm_row_number(&measured, gm_claims[bit].key, measure->measured ? measure->defect : NAN, 17);
        }
    }
    gm_row_close(&row, "");
}
