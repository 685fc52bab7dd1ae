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
    bool undecided;      /* there was one where the measurement can tell neither; if it is all there was, the
                            claim is not broken */
    bool holds;          /* measured, and within the tolerance on every problem */
    double defect;       /* the worst over the problems */
    double tolerance;    /* that a claim is held to */
    const char *problem; /* where the worst was seen */
    const char *reason;  /* why nothing was measured on a given system; NULL elsewhere */
};

/* Errors at smaller and smaller steps, whose slope is an order. */
enum { GM_LADDER = 44 };
struct gm_ladder {
    double dt[GM_LADDER], error[GM_LADDER];
    size_t count; /* 0: the order is found otherwise */
    /* two octaves of dt tell the same; else an order lower than that by theory refutes nothing */
    bool settled;
};

/* A scheme that makes the same steps on some problems: the largest difference that was seen, as a part of the state. */
struct gm_sameness {
    const struct gm_scheme *other; /* NULL: there is none on the problems that it is measured on */
    double difference;             /* the largest after a few steps; INFINITY: a step failed */
    const char *problem;           /* where */
    bool holds;
};

/* What was measured, and what the coefficients say: a claim that either refutes is broken. */
struct gm_certificate {
    const struct gm_scheme *scheme;
    /* measured, the lowest over the problems; NaN: on none of them errors stand clear of round-off */
    double order;
    struct gm_ladder ladder; /* of that problem */
    bool order_holds;
    const char *order_problem;
    const char *order_reason; /* why there is none on a given system, or what refutes it there */
    struct gm_verdict claims[GM_CLAIM_COUNT]; /* by bit number */
    /* Of schemes whose rows are coefficients (gm_family.coefficients_open), else not known. It holds where
       the conditions of the claimed order do, and the algebra of what is claimed of structure. */
    struct gm_theory theory;
    bool theory_holds;
    struct gm_sameness same;
    bool holds; /* the order and every claim, by both, and that it is the same as another scheme */
};

struct gm_certificate gm_certify(const struct gm_scheme *scheme);

/* A quantity that the motion keeps. */
struct gm_kept {
    const char *name;
    /* memory: that of the run which has come to y; NULL: there is none */
    double (*value)(const void *data, const double *y, const double *memory);
    const void *data;
};

/* A function of a problem's state, and its value as that of such a quantity. */
struct gm_invariant {
    double (*value)(const struct gm_problem *problem, const double *y);
    const struct gm_problem *problem;
};
double gm_invariant_value(const void *invariant, const double *y, const double *memory);

/* Differences of this many steps, up to 3, of such a quantity from a state of n numbers along a direction, beside the
   size of its values: 0 of a polynomial of lower degree. NaN where memory is short. */
double gm_kept_differences(const struct gm_kept *kept, const double *start, size_t n, int steps,
                           const double *direction);

/* Returns the claims that such a quantity bears on, as bits: it may be linear, quadratic, of the form q' A p, or of the
   form p' x(q) with x affine, the momentum map of the symmetry whose generator is x (Noether's theorem, read backwards).
   Differences along directions of this size decide, in the first `varied` of n numbers. 0: none, or memory is short. */
unsigned gm_kept_claims(const struct gm_kept *kept, const double *start, size_t n, size_t varied,
                        double size);

/* A system on which a scheme is measured that fits it: defects of one step dt from the start, and the order
   by steps from 8 dt on. */
struct gm_certified_system {
    const struct gm_problem *problem; /* of one member */
    const double *start;
    double dt;
    const struct gm_kept *kept; /* beside the energy */
    size_t kept_count;
    /* Of a field on a line: the same with half the step on a grid twice as fine, which may have one finer still; NULL:
       there is none. Node i of the one is node 2 i of the other. */
    const struct gm_certified_system *finer;
    /* How far a state at the time t is from the exact solution; NULL: none is told. */
    double (*error)(const void *data, double t, const double *y);
    const void *error_data;
};

/* What means nothing there is not measured, for a reason that is told, and breaks no claim. */
struct gm_certificate gm_certify_on(const struct gm_scheme *scheme, const struct gm_certified_system *system);

/* What theory says of a scheme; not known where its rows are no coefficients, or memory is short. */
struct gm_theory gm_scheme_theory(const struct gm_scheme *scheme);

/* For the wings, whose hook measures (struct gm_kind) and says whether the order holds. */

/* Takes a defect in; of several the worst is kept. */
void gm_certificate_note(struct gm_certificate *certificate, enum gm_claim claim, double defect,
                         const char *problem);
/* Notes that a problem can tell neither way: steps fail, or differences are lost in round-off. */
void gm_certificate_undecided(struct gm_certificate *certificate, enum gm_claim claim, const char *problem);
/* Tells why nothing was measured of a claim on a given system, where nothing was. */
void gm_certificate_withhold(struct gm_certificate *certificate, enum gm_claim claim, const char *reason);
/* Withholds every one of these claims, bits, for the same reason. */
void gm_certificate_withhold_all(struct gm_certificate *certificate, unsigned claims, const char *reason);
struct gm_verdict *gm_certificate_claim(struct gm_certificate *certificate, enum gm_claim claim);

/* The largest difference. */
double gm_distance(const double *a, const double *b, size_t n);

/* A number of steps of a scheme on a problem. */
struct gm_trial {
    const struct gm_problem *problem;
    const struct gm_scheme *scheme;
    const struct gm_settings *settings;
    double dt;
    int64_t steps;
};

/* The state after them, and where a scheme has a second copy of phase space, that behind it, as in `start`. False if
   one fails: then it is the last good one. */
bool gm_trial_advance(const struct gm_trial *trial, const double *start, double *end);

enum { GM_SAME_STEPS = 9 };

/* Compares so many steps of the certificate's scheme with those of the scheme that is the same on this problem, if there is
   one. */
void gm_certificate_note_same(struct gm_certificate *certificate, const struct gm_trial *trial,
                              const double *start);

/* Writes the state of a run that turns round after its steps and makes as many more: by the step -dt, or with the second
   half of the state, momenta or velocities, reflected. Where it turns, the first component is pushed by `push`, if it
   is not 0. It remembers what the scheme remembers. False if a step fails. */
bool gm_trial_turn(const struct gm_trial *trial, const double *start, bool reflected, double push,
                   double *end);

/* y := the solution at the time `until` of these equations, from y at 0, by GSL's Prince-Dormand stepper with
   this absolute and relative tolerance; false where it finds none or memory is short. */
bool gm_certify_solve(const gsl_odeiv2_system *equations, double tolerance, double until, double *y);

#endif
