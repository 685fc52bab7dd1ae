/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_THEORY_CERTIFY_H
#define GM_CORE_THEORY_CERTIFY_H

#include <gsl/gsl_odeiv2.h>

#include "core/kind.h"
#include "core/theory/theory.h"

/* Measures what a scheme's row claims. Order is a log-log slope on non-linear problems, against a solution
   of GSL's Prince-Dormand stepper at its tightest tolerance (for a scheme of variable order, whose row has
   0, the slope of log error against the logarithm of its tolerance); properties are defects of single
   steps or short runs. Every claim is measured if it can be; properties that are not claimed are reported,
   not judged. */

struct gm_verdict {
    bool claimed;
    bool measured;       /* there was a certification problem that the scheme fits */
    bool undecided;      /* a problem could not decide; without others, the claim is not broken */
    bool holds;          /* measured, and within the tolerance on every problem */
    double defect;       /* the worst over the problems */
    double tolerance;    /* largest defect of a claim that holds */
    const char *problem; /* problem with the worst defect */
    const char *reason;  /* reason without a measurement on a given system; else NULL */
};

/* An invariant that a scheme holds by name. */
struct gm_held_verdict {
    const char *name;
    struct gm_verdict verdict; /* of its relative change */
};
enum { GM_MOST_HELD_VERDICTS = 8 };

/* An invariant of the system along a run. */
struct gm_followed {
    char name[40];
    const char
        *verdict; /* "conserved", "oscillates", "drifts", or "not measured" if the run fails before its end */
    int64_t steps; /* that were made */
    enum gm_status status;
    double defect; /* the largest |x - x0| / |x0|, or |x - x0| if x0 is round-off */
};
enum { GM_MOST_FOLLOWED = 16 };

/* Errors at smaller and smaller steps, whose slope is an order. */
enum { GM_LADDER = 44 };
struct gm_ladder {
    double dt[GM_LADDER], error[GM_LADDER];
    size_t count; /* entries; 0: the order has another source */
    /* two octaves of dt give the same; else an order below the theoretical one refutes nothing */
    bool settled;
    bool fails; /* no run reached its end, at any step */
    bool large; /* the last error that was measured is as large as the motion */
};

/* A scheme that makes the same steps on some problems: the largest difference that was seen, as a part of the
   state. */
struct gm_sameness {
    const struct gm_scheme *other; /* NULL: none on the measured problems */
    double difference;             /* the largest after a few steps */
    const char *problem;           /* its problem */
    bool holds, undecided;         /* undecided: a difference refutes nothing */
};

/* Measured results, and those of the coefficients: a claim that either refutes is broken. */
struct gm_certificate {
    const struct gm_scheme *scheme;
    /* measured, the lowest over the problems; NaN: round-off hides the errors on all of them */
    double order;
    struct gm_ladder ladder; /* ladder of order_problem */
    bool order_holds;
    const char *order_problem; /* "": a scheme of the user fits no problem */
    const char *order_reason;  /* reason without an order on a given system, or its refutation */
    struct gm_verdict claims[GM_CLAIM_COUNT]; /* verdicts by bit number */
    struct gm_held_verdict held[GM_MOST_HELD_VERDICTS];
    size_t held_count;
    struct gm_followed followed[GM_MOST_FOLLOWED]; /* on a given system */
    size_t followed_count;
    /* The theory of schemes with coefficients (gm_family.coefficients_open), else not known. It holds if
       the conditions of the claimed order and the algebra of the claimed structure hold. */
    struct gm_theory theory;
    bool theory_holds;
    unsigned refuted; /* claims that the coefficients cannot satisfy, as bits */
    struct gm_sameness same;
    bool holds; /* the order, every claim by both, and `same` hold */
};

struct gm_certificate gm_certify(const struct gm_scheme *scheme);
/* Returns the claims that the base of a scheme makes and the scheme does not, but for those that were measured within
   the tolerance, and those that it would make if its text did not list others; 0 without a base. */
unsigned gm_certificate_given_up(const struct gm_certificate *certificate);

/* A quantity that the motion conserves. */
struct gm_kept {
    const char *name;
    /* memory: the memory of the run in the state y, or NULL */
    double (*value)(const void *data, const double *y, const double *memory);
    const void *data;
};

/* A function of a problem's state, and its value as a conserved quantity. */
struct gm_invariant {
    double (*value)(const struct gm_problem *problem, const double *y);
    const struct gm_problem *problem;
};
double gm_invariant_value(const void *invariant, const double *y, const double *memory);

/* Returns the claims that a conserved quantity tests, as bits: it may be linear, quadratic, of the form q'
   A p, or of the form p' x(q) with x affine, the momentum map of the symmetry whose generator is x
   (Noether's theorem, read backwards). Differences along directions of this size, or with `sizes` of one for each number,
   decide, in the first `varied` of n numbers. 0: none, or out of memory. */
unsigned gm_kept_claims(const struct gm_kept *kept, const double *start, size_t n, size_t varied, double size,
                        const double *sizes);

/* A system on which a scheme is measured that fits it: defects of one step dt from the start, and the order
   by steps from 8 dt on. */
struct gm_certified_system {
    const struct gm_problem *problem; /* a problem of one member */
    const double *start;
    double dt;
    const struct gm_kept *kept; /* conserved, besides the energy */
    size_t kept_count;
    /* The same field with half the step on a grid twice as fine, which may have a finer one too; NULL:
       none. Node i of this grid is node 2 i of the finer one. */
    const struct gm_certified_system *finer;
    /* The distance of a state at the time t from the exact solution; NULL: not known. */
    double (*error)(const void *data, double t, const double *y);
    const void *error_data;
};

/* Certifies a scheme on a system. Claims without a meaning have a reason and are not broken. */
struct gm_certificate gm_certify_on(const struct gm_scheme *scheme, const struct gm_certified_system *system);

/* The theory of a scheme; not known without coefficients, or when out of memory. */
struct gm_theory gm_scheme_theory(const struct gm_scheme *scheme);

/* The functions below serve the hooks of kinds (struct gm_kind), which also decide if the order holds. */

/* Notes a defect; the worst of several counts. */
void gm_certificate_note(struct gm_certificate *certificate, enum gm_claim claim, double defect,
                         const char *problem);
void gm_verdict_note(struct gm_verdict *verdict, double defect, const char *problem);
/* Notes that a problem cannot decide: steps fail, or differences are lost in round-off. */
void gm_certificate_undecided(struct gm_certificate *certificate, enum gm_claim claim, const char *problem);
/* Notes the reason why a claim was not measured on a given system, unless it was. */
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

/* Writes the state after a trial's steps and, if the scheme has one, the second copy of phase space.
   Returns false if a step fails; `end` is then the last good state. */
bool gm_trial_advance(const struct gm_trial *trial, const double *start, double *end);

/* Compares steps dt of the certificate's scheme with those of the scheme that is the same on this problem, if
   any. */
void gm_certificate_note_same(struct gm_certificate *certificate, const struct gm_problem *problem,
                              const struct gm_settings *settings, double dt, const double *start);

/* Writes the state of a run that reverses after its steps and makes as many more: with the step -dt, or
   with the second half of the state, momenta or velocities, reflected. `push` is added to the first
   component at the reversal. The run has the scheme's memory. Returns false if a step fails. */
bool gm_trial_turn(const struct gm_trial *trial, const double *start, bool reflected, double push,
                   double *end);

/* y := the solution at the time `until` of these equations, from y at 0, with GSL's Prince-Dormand stepper, this relative
   tolerance, and as an absolute one this, or less where all of y is less than 1. Returns false if it fails, or when out of
   memory. */
bool gm_certify_solve(const gsl_odeiv2_system *equations, double tolerance, double until, double *y);

#endif
