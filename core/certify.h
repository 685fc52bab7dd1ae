/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_CERTIFY_H
#define GM_CORE_CERTIFY_H

#include <gsl/gsl_odeiv2.h>

#include "core/kind.h"
#include "core/theory/theory.h"

/* Measures what a scheme's row claims. Order is a log-log slope on non-linear problems, against a solution of
   GSL's Prince-Dormand stepper at its tightest tolerance (for a scheme that chooses its order, whose row says
   0, the slope of log error against the logarithm of its tolerance); properties are defects of single steps
   or short runs. Every claim is measured wherever it can be; what is not claimed is told, not judged. */

struct gm_verdict {
    bool claimed;
    bool measured;       /* there was a certification problem that the scheme fits */
    bool holds;          /* measured, and within the tolerance on every problem */
    double defect;       /* the worst over the problems */
    double tolerance;    /* that a claim is held to */
    const char *problem; /* where the worst was seen */
};

/* What was measured, and what the coefficients say: a claim that either refutes is broken. */
struct gm_certificate {
    const struct gm_scheme *scheme;
    double order; /* measured, the lowest over the problems */
    bool order_holds;
    const char *order_problem;
    struct gm_verdict claims[GM_CLAIM_COUNT]; /* by bit number */
    /* Of schemes whose rows are coefficients (gm_family.coefficients_open), else not known. It holds where the
       conditions of the claimed order do, and the algebra of what is claimed of structure. */
    struct gm_theory theory;
    bool theory_holds;
    bool holds; /* the order and every claim, by both */
};

struct gm_certificate gm_certify(const struct gm_scheme *scheme);

/* What theory says of a scheme; not known where its rows are no coefficients, or memory is short. */
struct gm_theory gm_scheme_theory(const struct gm_scheme *scheme);

/* For the wings, whose hook measures (struct gm_kind) and says whether the order holds. */

/* Takes a defect in; of several the worst is kept. */
void gm_certificate_note(struct gm_certificate *certificate, enum gm_claim claim, double defect,
                         const char *problem);
struct gm_verdict *gm_certificate_claim(struct gm_certificate *certificate, enum gm_claim claim);

/* y := the solution at the time `until` of these equations, from y at 0, by GSL's Prince-Dormand stepper with
   this absolute and relative tolerance; false where it finds none or memory is short. */
bool gm_certify_solve(const gsl_odeiv2_system *equations, double tolerance, double until, double *y);

#endif
