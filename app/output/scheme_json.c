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
    gm_row_text(&row, "scheme", scheme->name);
    gm_row_text(&row, "title", scheme->title);
    gm_row_count(&row, "order", scheme->order);
    gm_row_text(&row, "family", scheme->family->title);
    gm_row_text(&row, "for", gm_scheme_problems(scheme));
    struct gm_row claims = gm_row_open(&row, "claims", ']');
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (scheme->claims >> bit & 1) {
            gm_row_text(&claims, NULL, gm_claim_key(bit));
        }
    }
    gm_row_close(&claims);
    if (scheme->family->kind == &gm_kind_ode) {
        gm_row_text(&row, "tangent", gm_tangent_word(scheme));
    }
    gm_row_text(&row, "formula", scheme->formula);
    gm_row_text(&row, "reference", scheme->reference);
    gm_row_close(&row);
}

static void put_stability(struct gm_row *theory, const struct gm_theory_stability *stability)
{
    struct gm_row row = gm_row_open(theory, "stability", '}');
    gm_row_text(&row, "of", stability->oscillator ? "oscillator" : "y' = lambda y");
    gm_row_number(&row, "real", stability->real, 17);
    gm_row_number(&row, "imaginary", stability->imaginary, 17);
    if (!stability->oscillator) {
        gm_row_flag(&row, "a_stable", stability->a_stable);
        gm_row_flag(&row, "l_stable", stability->l_stable);
    }
    gm_row_close(&row);
}

static void put_theory(struct gm_row *certificate, const struct gm_theory *theory)
{
    struct gm_row row = gm_row_open(certificate, "theory", '}');
    gm_row_count(&row, "order", theory->order);
    gm_row_number(&row, "digits", theory->digits > 0 ? theory->digits : NAN, 17);
    gm_row_text(&row, "failing_condition", theory->condition[0] ? theory->condition : NULL);
    gm_row_number(&row, "residual", theory->condition[0] ? theory->residual : NAN, 17);
    gm_row_flag(&row, "symplectic", theory->symplectic);
    gm_row_flag(&row, "symmetric", theory->symmetric);
    gm_row_number(&row, "error_constant", theory->error_constant, 17);
    if (theory->stability.known) {
        put_stability(&row, &theory->stability);
    } else {
        gm_row_text(&row, "stability", NULL);
    }
    gm_row_close(&row);
}

void gm_certificate_put(FILE *stream, const struct gm_certificate *certificate, const char *system)
{
    const struct gm_scheme *scheme = certificate->scheme;
    struct gm_row row = gm_row_begin(stream);
    gm_row_text(&row, "scheme", scheme->name);
    gm_row_text(&row, "family", scheme->family->title);
    gm_row_text(&row, "for", gm_scheme_problems(scheme));
    if (system) {
        gm_row_text(&row, "system", system);
    }
    gm_row_count(&row, "order", scheme->order);
    gm_row_number(&row, "measured_order", certificate->order, 17);
    gm_row_text(&row, "order_problem", certificate->order_problem);
    gm_row_flag(&row, "holds", certificate->holds);
    struct gm_row properties = gm_row_open(&row, "properties", '}');
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *measure = &certificate->claims[bit];
        if (measure->claimed || measure->measured || measure->undecided) {
            struct gm_row claim = gm_row_open(&properties, gm_claim_key(bit), '}');
            gm_row_flag(&claim, "claimed", measure->claimed);
            gm_row_flag(&claim, "measured", measure->measured);
            /* null: it was not measured, or a step of the measurement failed */
            gm_row_number(&claim, "defect", measure->measured ? measure->defect : NAN, 17);
            fprintf(stream, ",\"tolerance\":%g", measure->tolerance);
            gm_row_text(&claim, "problem", measure->problem);
            if (measure->reason) {
                gm_row_text(&claim, "reason", measure->reason);
            }
            gm_row_close(&claim);
        }
    }
    gm_row_close(&properties);
    if (certificate->same.other) {
        struct gm_row same = gm_row_open(&row, "same_as", '}');
        gm_row_text(&same, "scheme", certificate->same.other->name);
        gm_row_number(&same, "difference", certificate->same.difference, 17);
        gm_row_text(&same, "problem", certificate->same.problem);
        gm_row_close(&same);
    }
    if (certificate->theory.known) {
        put_theory(&row, &certificate->theory);
    } else {
        gm_row_text(&row, "theory", NULL);
    }
    struct gm_row measured = gm_row_open(&row, "measured", '}');
    gm_row_number(&measured, "order", certificate->order, 17);
    if (certificate->order_reason) {
        gm_row_text(&measured, "order_reason", certificate->order_reason);
    }
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *measure = &certificate->claims[bit];
        if (measure->measured || (measure->reason && GM_CERTIFIED_ON_SYSTEMS >> bit & 1)) {
            gm_row_number(&measured, gm_claim_key(bit), measure->measured ? measure->defect : NAN, 17);
        }
    }
    gm_row_close(&measured);
    gm_row_close(&row);
}
