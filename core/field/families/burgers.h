/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step of a scheme for Burgers' equation, and what its rows say. */
#ifndef GM_CORE_FIELD_FAMILIES_BURGERS_H
#define GM_CORE_FIELD_FAMILIES_BURGERS_H

#include "core/field/field.h"
#include "core/field/problems/burgers.h"

/* One step of length k on nodes h apart, each displaced by sigma. u and out have `points` entries; out[0] and
   out[points - 1] hold the boundary values of the new level already. */
struct gm_burgers_step {
    const struct gm_burgers *burgers;
    size_t points;
    double h, k, sigma;
    const double *u;
    double *out;
    double *scratch; /* 3 points, of implicit schemes */
};

typedef enum gm_status gm_burgers_method(const struct gm_burgers_step *step, struct gm_progress *progress);

struct gm_burgers_row {
    gm_burgers_method *method;
    bool implicit;
    bool invariant;
};

/* Whether the nodes rest in the new frame when this scheme runs. */
bool gm_burgers_fixed(const struct gm_burgers *burgers, const struct gm_scheme *scheme);

/* The defect of one step of a scheme under the projection
       (t, x, u) -> (t / (1 - a t), x / (1 - a t), (1 - a t) u + a x)
   from t = 0 on the three nodes x - h, x, x + h: the step of the projected data against the projected step.
   NaN for implicit schemes, whose step three nodes do not determine. */
double gm_burgers_projection_defect(const struct gm_scheme *scheme, double viscosity, double h, double k,
                                    double a, double x, const double u[3]);

#endif
