/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Schemes and certificates as JSON. */
#include "app/output/scheme_json.h"

#include <math.h>

#include "app/output/json.h"
#include "core/ode/indicators/tangent.h"
#include "core/ode/ode.h"
#include "core/schemes.h"

void gm_scheme_put(FILE *stream, const struct gm_scheme *scheme)
{
    fprintf(stream, "{");
    gm_json_put_pair(stream, "scheme", scheme->name);
    fprintf(stream, ",");
    gm_json_put_pair(stream, "title", scheme->title);
    fprintf(stream, ",\"order\":%d,", scheme->order);
    gm_json_put_pair(stream, "family", scheme->family->title);
    fprintf(stream, ",");
    gm_json_put_pair(stream, "for", gm_scheme_problems(scheme));
    fprintf(stream, ",\"claims\":[");
    const char *comma = "";
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        if (scheme->claims >> bit & 1) {
            fprintf(stream, "%s\"%s\"", comma, gm_claim_word(bit));
            comma = ",";
        }
    }
    fprintf(stream, "],");
    if (scheme->family->kind == &gm_kind_ode) {
        gm_json_put_pair(stream, "tangent", gm_tangent_word(scheme));
        fputc(',', stream);
    }
    gm_json_put_pair(stream, "formula", scheme->formula);
    fprintf(stream, ",");
    gm_json_put_pair(stream, "reference", scheme->reference);
    fprintf(stream, "}");
}

/* null where nothing is known */
static void put_theory(FILE *stream, const struct gm_theory *theory)
{
    if (!theory->known) {
        fprintf(stream, "null");
        return;
    }
    fprintf(stream, "{\"order\":%d,", theory->order);
    gm_json_put_number_pair(stream, "digits", theory->digits > 0 ? theory->digits : NAN);
    fprintf(stream, ",");
    if (theory->condition[0]) {
        gm_json_put_pair(stream, "failing_condition", theory->condition);
    } else {
        fprintf(stream, "\"failing_condition\":null");
    }
    fprintf(stream, ",");
    gm_json_put_number_pair(stream, "residual", theory->condition[0] ? theory->residual : NAN);
    fprintf(stream, ",\"symplectic\":%s,\"symmetric\":%s,", theory->symplectic ? "true" : "false",
            theory->symmetric ? "true" : "false");
    gm_json_put_number_pair(stream, "error_constant", theory->error_constant);
    fprintf(stream, ",\"stability\":");
    const struct gm_theory_stability *stability = &theory->stability;
    if (!stability->known) {
        fprintf(stream, "null}");
        return;
    }
    fprintf(stream, "{");
    gm_json_put_pair(stream, "of", stability->oscillator ? "oscillator" : "y' = lambda y");
    fprintf(stream, ",");
    gm_json_put_number_pair(stream, "real", stability->real);
    fprintf(stream, ",");
    gm_json_put_number_pair(stream, "imaginary", stability->imaginary);
    if (!stability->oscillator) {
        fprintf(stream, ",\"a_stable\":%s,\"l_stable\":%s", stability->a_stable ? "true" : "false",
                stability->l_stable ? "true" : "false");
    }
    fprintf(stream, "}}");
}

void gm_certificate_put(FILE *stream, const struct gm_certificate *certificate, const char *system)
{
    const struct gm_scheme *scheme = certificate->scheme;
    fprintf(stream, "{");
    gm_json_put_pair(stream, "scheme", scheme->name);
    fprintf(stream, ",");
    gm_json_put_pair(stream, "family", scheme->family->title);
    fprintf(stream, ",");
    gm_json_put_pair(stream, "for", gm_scheme_problems(scheme));
    if (system) {
        fprintf(stream, ",");
        gm_json_put_pair(stream, "system", system);
    }
    fprintf(stream, ",\"order\":%d,\"measured_order\":", scheme->order);
    gm_json_put_number(stream, certificate->order);
    fprintf(stream, ",");
    gm_json_put_pair(stream, "order_problem", certificate->order_problem);
    fprintf(stream, ",\"holds\":%s,\"properties\":{", certificate->holds ? "true" : "false");
    const char *comma = "";
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *measure = &certificate->claims[bit];
        if (measure->claimed || measure->measured || measure->undecided) {
            fprintf(stream, "%s\"%s\":{\"claimed\":%s,\"measured\":%s,\"defect\":", comma, gm_claim_word(bit),
                    measure->claimed ? "true" : "false", measure->measured ? "true" : "false");
            /* null: it was not measured, or a step of the measurement failed */
            gm_json_put_number(stream, measure->measured ? measure->defect : NAN);
            fprintf(stream, ",\"tolerance\":%g,", measure->tolerance);
            gm_json_put_pair(stream, "problem", measure->problem);
            if (measure->reason) {
                fprintf(stream, ",");
                gm_json_put_pair(stream, "reason", measure->reason);
            }
            fprintf(stream, "}");
            comma = ",";
        }
    }
    fprintf(stream, "},\"theory\":");
    put_theory(stream, &certificate->theory);
    fprintf(stream, ",\"measured\":{");
    gm_json_put_number_pair(stream, "order", certificate->order);
    if (certificate->order_reason) {
        fprintf(stream, ",");
        gm_json_put_pair(stream, "order_reason", certificate->order_reason);
    }
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        const struct gm_verdict *measure = &certificate->claims[bit];
        if (measure->measured || (measure->reason && GM_CERTIFIED_ON_SYSTEMS >> bit & 1)) {
            fprintf(stream, ",");
            gm_json_put_number_pair(stream, gm_claim_word(bit), measure->measured ? measure->defect : NAN);
        }
    }
    fprintf(stream, "}}");
}
