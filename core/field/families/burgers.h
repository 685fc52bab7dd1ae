/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A step of a scheme for Burgers' equation, and the scheme's coefficients. */
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
    double *scratch; /* [3 * points], for implicit schemes */
};

typedef enum gm_status gm_burgers_method(const struct gm_burgers_step *step, struct gm_progress *progress);

struct gm_burgers_row {
    gm_burgers_method *method;
    bool implicit;
    bool family; /* the frame depends on a and d */
};

/* A projection and a boost (eq. 98), then a scaling, about (t, x) = (0, 0):
       (t, x, u) -> (t/m, (x + a5 t)/m, m u + a4 x + a5),   m = 1 - a4 t
       (t, x, u) -> (s^2 t, s x, u/s) */
struct gm_burgers_symmetry {
    double a4, a5, scale;
};
struct gm_event gm_burgers_carried(const struct gm_burgers_symmetry *symmetry, struct gm_event event);

/* The moving frame of three values h apart about the node in their middle, which becomes 0: eqs. 117 to 119,
   for schemes without a and d with a = -1/2, where both neighbours become the same. */
struct gm_burgers_symmetry gm_burgers_frame(const struct gm_scheme *scheme, const struct gm_burgers *burgers,
                                            double h, const double u[3]);

/* The defect of one step of a scheme under a symmetry from t = 0 on the three nodes x - h, x, x + h: the step
   of the carried data against the carried step. NaN for implicit schemes, whose step three nodes do not
   determine. */
double gm_burgers_defect(const struct gm_scheme *scheme, const struct gm_burgers *burgers, double h, double k,
                         const struct gm_burgers_symmetry *symmetry, double x, const double u[3]);

#endif
