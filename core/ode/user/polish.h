/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scheme whose coefficients were typed with too few digits, or with a wrong one: the decimals next to these
   that satisfy the order conditions. */
#ifndef GM_CORE_ODE_USER_POLISH_H
#define GM_CORE_ODE_USER_POLISH_H

#include "core/ode/user/scheme.h"

struct gm_polish {
    int order;            /* the scheme's order, whose conditions are solved */
    unsigned claims;      /* the claims whose equations are solved as well */
    size_t decimals;      /* number of decimals that may move: not exact numbers */
    size_t conditions;    /* number of conditions of the order and of the claimed structure */
    double before, after; /* the largest residual, as typed and as solved */
    double change;        /* the largest change of a decimal */
    double doubt;         /* radius of the residuals, from rows known to 15 digits */
};

/* Returns the text of the scheme with its decimals to 30 digits (15 if rows beside them have 15), its order
   and its claims. The solution nearest to the typed one is used, so that a family's free parameters stay. The
   caller frees. Returns NULL with a fault, whose sentence is empty when out of memory. */
char *gm_user_scheme_polish(const struct gm_user_scheme_source *source, struct gm_polish *polish,
                            struct gm_fault *fault);

#endif
