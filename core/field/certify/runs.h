/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FIELD_CERTIFY_RUNS_H
#define GM_CORE_FIELD_CERTIFY_RUNS_H

#include "core/certify.h"
#include "core/run.h"

/* Short runs of a field that measure properties of a scheme. */

enum { GM_FIELD_STEPS = 61 }; /* most steps of a run from a system's own start */

/* An equation on which a scheme is certified. */
struct gm_field_subject {
    struct gm_problem problem;
    const struct gm_scheme *scheme;
    double dt;
    struct gm_run *run; /* opened by gm_field_begin; the caller closes it */
};

/* The largest magnitude of the field; 1 if it is less. */
double gm_field_size(const struct gm_problem *problem, const double *y);

/* Opens a run from the state y at time 0. Returns false when out of memory. */
bool gm_field_begin(struct gm_field_subject *subject, const double *y);

/* Notes the defects of symmetry, after 8 steps forth and 7 back, of numbers of this size, and of the
   multisymplectic law after 25 steps, where the scheme has one. */
void gm_field_note_form(struct gm_certificate *certificate, struct gm_field_subject *subject, const double *y,
                        double size);

/* Notes the relative change of a quantity from the state after one step over 60 more, INFINITY if a step
   fails, under the name of what is kept. Like the law it is withheld where round-off alone may have made
   it. */
void gm_field_note_kept(struct gm_certificate *certificate, enum gm_claim claim,
                        struct gm_field_subject *subject, const double *y, const struct gm_kept *kept,
                        const char *name);

/* The order in time on one grid from the differences between runs with dt, dt/2 and dt/4; NaN: one fails. */
double gm_field_order_in_time(const struct gm_field_subject *subject, const double *y, double until);

/* The order over 16 steps, from a system and its refinements: the slope of the error if the exact solution
   closes on the ring, else of the differences between a run and the next finer one. NaN with *reason if it
   cannot be measured, or is low because the start lacks derivatives. *reason is also set if the exact
   solution alone refutes it; else NULL. */
double gm_field_order(const struct gm_certified_system *system, const struct gm_scheme *scheme,
                      struct gm_ladder *ladder, const char **reason);

#endif
