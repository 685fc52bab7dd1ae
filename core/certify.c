/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What all certificates have in common: the tolerances, the verdicts, and the call of the wing that
   measures. */
#include "core/certify.h"

#include <math.h>

#include <gsl/gsl_errno.h>

#include "core/memory.h"

static unsigned bit_of(enum gm_claim claim)
{
    unsigned bit = 0;
    while (1u << bit != (unsigned)claim) {
        bit++;
    }
    return bit;
}

struct gm_verdict *gm_certificate_claim(struct gm_certificate *certificate, enum gm_claim claim)
{
    return &certificate->claims[bit_of(claim)];
}

void gm_certificate_note(struct gm_certificate *certificate, enum gm_claim claim, double defect,
                         const char *problem)
{
    struct gm_verdict *verdict = gm_certificate_claim(certificate, claim);
    if (!verdict->measured || !(defect <= verdict->defect)) {
        verdict->defect = defect;
        verdict->problem = problem;
    }
    verdict->measured = true;
}

struct solution {
    const gsl_odeiv2_system *equations;
    double tolerance, until, *y;
};

static bool solve(void *data)
{
    const struct solution *solution = data;
    gsl_odeiv2_driver *driver = gsl_odeiv2_driver_alloc_y_new(solution->equations, gsl_odeiv2_step_rk8pd,
                                                              1e-3, solution->tolerance, solution->tolerance);
    if (!driver) {
        return false;
    }
    double t = 0;
    const int status = gsl_odeiv2_driver_apply(driver, &t, solution->until, solution->y);
    gsl_odeiv2_driver_free(driver);
    return status == GSL_SUCCESS;
}

bool gm_certify_solve(const gsl_odeiv2_system *equations, double tolerance, double until, double *y)
{
    return gm_memory_guard_gsl(solve, &(struct solution){equations, tolerance, until, y});
}

struct gm_theory gm_scheme_theory(const struct gm_scheme *scheme)
{
    struct gm_theory theory = {.known = false};
    struct gm_coefficients coefficients;
    if (scheme->family->coefficients_open && scheme->family->coefficients_open(scheme, &coefficients)) {
        theory = gm_theory_of(&coefficients);
        gm_coefficients_close(&coefficients);
    }
    return theory;
}

static void ask_theory(struct gm_certificate *certificate)
{
    const struct gm_scheme *scheme = certificate->scheme;
    const struct gm_theory theory = gm_scheme_theory(scheme);
    certificate->theory = theory;
    certificate->theory_holds = true;
    if (!theory.known) {
        return;
    }
    certificate->theory_holds = scheme->order <= theory.order &&
                                (theory.symplectic || !(scheme->claims & GM_SYMPLECTIC)) &&
                                (theory.symmetric || !(scheme->claims & GM_SYMMETRIC));
    certificate->order_holds &= certificate->order > 0.95 * theory.order;
}

struct gm_certificate gm_certify(const struct gm_scheme *scheme)
{
    struct gm_certificate certificate = {.scheme = scheme, .order = NAN, .order_problem = ""};
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        certificate.claims[bit].claimed = scheme->claims >> bit & 1;
        certificate.claims[bit].tolerance = 1e-12;
        certificate.claims[bit].problem = "";
    }
    gm_certificate_claim(&certificate, GM_SYMPLECTIC)->tolerance = 1e-10;
    gm_certificate_claim(&certificate, GM_KEEPS_VOLUME)->tolerance = 1e-10;
    scheme->family->kind->certify(scheme, &certificate);
    ask_theory(&certificate);
    certificate.holds = certificate.order_holds && certificate.theory_holds;
    for (unsigned bit = 0; bit < GM_CLAIM_COUNT; bit++) {
        struct gm_verdict *result = &certificate.claims[bit];
        result->holds = result->measured && result->defect <= result->tolerance;
        certificate.holds &= !result->claimed || result->holds;
    }
    return certificate;
}
