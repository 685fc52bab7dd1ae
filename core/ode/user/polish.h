/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scheme whose coefficients were typed with too few digits, or with a wrong one: the decimals next to these
   that satisfy the order conditions. */
#ifndef GM_CORE_ODE_USER_POLISH_H
#define GM_CORE_ODE_USER_POLISH_H

#include "core/ode/user/scheme.h"

struct gm_polish {
    int order;            /* for which the conditions are solved: the scheme's */
    unsigned claims;      /* whose algebra is solved with them */
    size_t decimals;      /* that may move: what is no exact number */
    size_t conditions;    /* of the order, and of the structure that is claimed */
    double before, after; /* the largest residual, as typed and as solved */
    double change;        /* of the decimal that moves farthest */
    double doubt;         /* of the residuals, for rows of parts that are known to 15 digits */
};

/* The text of the scheme with its decimals to 30 digits, or to the 15 of the rows beside them, its order and its
   claims said: of the solutions the one next to what was typed, so that a family's free parameters stay where they
   are. malloc'ed. NULL with a fault, whose sentence is empty where memory was refused. */
char *gm_user_scheme_polish(const struct gm_user_scheme_source *source, struct gm_polish *polish,
                            struct gm_fault *fault);

#endif
