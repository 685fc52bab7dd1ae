/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_CERTIFY_MEASURE_H
#define GM_CORE_ODE_CERTIFY_MEASURE_H

#include "core/events.h"
#include "core/ode/user/model.h"
#include "core/theory/certify.h"

/* The problems that schemes are certified on, and the measurements, for kind.c. */

/* The most components of a subject, and of one whose derivative of a step is taken; the most invariants. */
enum { GM_SUBJECT_COMPONENTS = 4096, GM_SUBJECT_TANGENTS = 64, GM_SUBJECT_INVARIANTS = 3 };

struct gm_subject {
    struct gm_problem problem;      /* m = 1 */
    const struct gm_scheme *scheme; /* that is measured */
    const double *start;
    double dt;                  /* step size; large enough that RK4 shows a symplecticity defect above 1e-6 */
    const double *away;         /* a start from which one step passes no break; NULL: not known */
    double passed;              /* a stretch that passes each located break twice; NaN or 0: none is known */
    double unit;                /* unit of the times at which the order is measured */
    double scale;               /* size of the components */
    const double *sizes;        /* of each, where some are in other units than others; NULL: the scale */
    bool volume;                /* preservation of volume is measured: no energy, no bracket */
    const struct gm_kept *kept; /* invariants beside the energy; a NULL name is the problem's */
    size_t kept_count;
    struct gm_user_system system; /* the problem's system, if it has a file */
    struct gm_user_model model;
};

size_t gm_subject_count(void);
/* Returns true if the scheme is measured on it; false also when out of memory. It does not move while it is
   open, and the caller closes it in all cases. */
bool gm_subject_open(struct gm_subject *subject, size_t index, const struct gm_scheme *scheme);
void gm_subject_close(struct gm_subject *subject);

/* The components that a scheme maps: the state, or with a second copy of phase space both. */
size_t gm_subject_components(const struct gm_subject *subject);
/* Writes the start of the components that a scheme maps. */
void gm_subject_start(const struct gm_subject *subject, double *whole);

/* Returns the size of one of the components that a scheme maps. */
static inline double gm_subject_size(const struct gm_subject *subject, size_t component)
{
    return subject->sizes ? subject->sizes[component % subject->problem.n] : subject->scale;
}

/* Returns the subject without events that change its state. */
static inline struct gm_subject gm_subject_between_events(const struct gm_subject *subject)
{
    struct gm_subject between = *subject;
    if (subject->problem.events && subject->problem.events->changes) {
        between.problem.events = NULL;
    }
    return between;
}

/* Returns the rate c of a friction -c p; 0: no friction. */
double gm_subject_friction(const struct gm_subject *subject);

/* Returns settings whose tau0, for adaptive schemes, is dt. */
struct gm_settings gm_subject_settings(double dt);

/* gm_trial_advance, of the components that the scheme maps. */
bool gm_subject_advance(const struct gm_subject *subject, double dt, int64_t steps, const double *whole,
                        double *end);

/* gm_trial_turn, with p reflected in every copy of phase space. */
bool gm_subject_turn(const struct gm_subject *subject, double dt, int64_t steps, bool reflected, double push,
                     double *end);

/* The order: the slope of log error against log dt, against GSL's Prince-Dormand stepper at its tightest
   tolerance; dt of a scheme by tolerance is the mean length of its own steps. NaN if it cannot be measured: then
   nothing is settled. */
double gm_measure_order(const struct gm_subject *subject, struct gm_ladder *ladder);

/* Returns the defect of a claim; NaN if a step fails, or if a defect beyond the tolerance does not exceed the
   error of its measurement, for this dt and two smaller ones. M is the derivative of one step, by differences
   (core/linear/differences.h).
   Components in different units, 10^4 times as large as others or more, are measured in their sizes.
       GM_SYMPLECTIC         |M' J M - J|, under constraints for tangents of their manifold only; of a degenerate
                             Lagrangian |M' Omega(y1) M - Omega(y0)|
       GM_CONFORMAL          |M' J M - exp(-c dt) J|
       GM_POISSON_MAP        |M B(y0) M' - B(y1)|
       GM_KEEPS_VOLUME       |det M - 1|, of three components
       GM_SYMMETRIC          |step(-dt) step(dt) y0 - y0|
       GM_REVERSIBLE         |R step R step y0 - y0|, R: p -> -p
       GM_KEEPS_ENERGY       gm_drift
       GM_KEEPS_CONSTRAINTS, _HIDDEN  the constraints after as many steps */
double gm_defect(const struct gm_subject *subject, enum gm_claim claim, double tolerance);

/* Returns the difference between one step and two half ones: about the error of a step. NaN if they fail. */
double gm_step_error(const struct gm_subject *subject);

/* Returns the relative change of a quantity over many smaller steps; NaN if they fail, and of an adaptive scheme if
   none is made. */
double gm_drift(const struct gm_subject *subject, const struct gm_kept *kept);
/* Returns the unit of a quantity: 1, or, if that is far from 1, what it changes by if some components alone move as they
   do in a few steps. Its value at the start may be far below that, where its terms cancel. */
double gm_kept_unit(const struct gm_subject *subject, const struct gm_kept *kept);
/* Returns what changes of a quantity are relative to: its value at the start, or its unit if that is larger. */
double gm_kept_size(const struct gm_subject *subject, const struct gm_kept *kept);
/* Returns a quantity's change by a hundred times the round-off of the components' sizes, in some direction. */
double gm_round_off_of(const struct gm_subject *subject, const struct gm_kept *kept);

#endif
