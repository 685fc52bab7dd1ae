/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_ODE_CERTIFY_MEASURE_H
#define GM_CORE_ODE_CERTIFY_MEASURE_H

#include "core/certify.h"
#include "core/ode/user/model.h"
#include "core/ode/variational/manifold.h"

/* What kind.c certifies by: the problems that schemes are certified on, and the measurements. */

/* Components of any, and of those of which the derivative of a step is taken. */
enum { GM_SUBJECT_COMPONENTS = 4096, GM_SUBJECT_TANGENTS = 64, GM_SUBJECT_INVARIANTS = 2 };

/* A quantity that some schemes keep. */
typedef double gm_invariant(const struct gm_problem *problem, const double *y);

struct gm_subject {
    struct gm_problem problem; /* m = 1 */
    double start[GM_SUBJECT_COMPONENTS];
    double dt;        /* of one step; large enough that RK4 shows a symplecticity defect above 1e-6 */
    double unit;      /* of the times at which the order is measured; 0: 1 */
    double scale;     /* of the components; 0: 1 */
    unsigned only;    /* facets: not for schemes that need none of them; 0: for all */
    bool hamiltonian; /* (q, p), reversible under p -> -p */
    bool uneven;      /* H is another one where p turns round: nothing is reversible */
    double friction;  /* -c p, where it is one; 0: none */
    bool volume;      /* without divergence, to be measured */
    gm_invariant *casimir[GM_SUBJECT_INVARIANTS]; /* of a bracket */
    gm_invariant *linear[GM_SUBJECT_INVARIANTS], *quadratic[GM_SUBJECT_INVARIANTS],
        *bilinear[GM_SUBJECT_INVARIANTS],
        *momentum
            [GM_SUBJECT_INVARIANTS]; /* of symmetries that move q by affine maps; NULL where it has none */
    struct gm_user_system system;    /* that the problem is of, where it is one that was read */
    struct gm_user_model model;
};

size_t gm_subject_count(void);
/* It does not move while it is open. False: out of memory. To be closed in both cases. */
bool gm_subject_open(struct gm_subject *subject, size_t index);
void gm_subject_close(struct gm_subject *subject);
bool gm_subject_fits(const struct gm_subject *subject, const struct gm_scheme *scheme);

/* The components that a scheme maps: the state, or with a second copy of phase space both. */
size_t gm_subject_components(const struct gm_subject *subject, const struct gm_scheme *scheme);
/* Fills them at the start. */
void gm_subject_start(const struct gm_subject *subject, const struct gm_scheme *scheme, double *whole);

/* Makes `steps` steps of m members, whole and end [component * m + member]; false if it fails. */
bool gm_subject_advance(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                        int64_t steps, size_t m, const double *whole, double *end);

/* Where a run that turns round after `steps` steps is after so many more: by the step -dt, or with p
   reflected in every copy of phase space; where it turns, the first component is pushed by `push`, if it is
   not 0. It remembers what the scheme remembers. False if a step fails. */
bool gm_subject_turn(const struct gm_subject *subject, const struct gm_scheme *scheme, double dt,
                     int64_t steps, bool reflected, double push, double *end);

/* The order: the slope of log error against log dt, against GSL's Prince-Dormand stepper at its tightest
   tolerance. NaN if it cannot be measured: then nothing is settled. */
double gm_measure_order(const struct gm_subject *subject, const struct gm_scheme *scheme,
                        struct gm_ladder *ladder);

/* Defects of one step: NaN where it fails, or where a defect beyond the tolerance does not stand clear of the
   error of its own measurement, for this dt and two smaller ones. */

/* |M' J M - J|, under constraints of tangents of their manifold alone, and |det M - 1|, M the derivative of
   one step: central differences at 4 distances, extrapolated by Romberg, all as one ensemble. Error of the
   differences about 1e-13. */
double gm_symplecticity_defect(const struct gm_subject *subject, const struct gm_scheme *scheme,
                               double tolerance);
/* |M' J M - exp(-c dt) J| */
double gm_conformal_defect(const struct gm_subject *subject, const struct gm_scheme *scheme,
                           double tolerance);
/* |M B(y0) M' - B(y1)| */
double gm_poisson_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, double tolerance);
double gm_volume_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, double tolerance);

/* What step(-dt) step(dt), and what R step R step with R: p -> -p, leave of the way back to the start. */
double gm_symmetry_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, double tolerance);
double gm_reversibility_defect(const struct gm_subject *subject, const struct gm_scheme *scheme,
                               double tolerance);

/* The largest relative change of the quantities over many smaller steps; NaN where they fail. */
double gm_drift(const struct gm_subject *subject, const struct gm_scheme *scheme,
                gm_invariant *const *quantities, size_t count);
/* The constraints, and the hidden ones, after as many steps. */
struct gm_manifold_defects gm_constraint_defects(const struct gm_subject *subject,
                                                 const struct gm_scheme *scheme);
double gm_drift_of(const struct gm_subject *subject, const struct gm_scheme *scheme,
                   const struct gm_kept *kept);
/* The change of the same by a hundred times the round-off of the start's largest number, in some direction. */
double gm_round_off_of(const struct gm_subject *subject, const struct gm_kept *kept);
double gm_energy_drift(const struct gm_subject *subject, const struct gm_scheme *scheme);

#endif
