/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The phase portrait of y' = f(y) in the plane: equilibria in a window, and the values of f from which nullclines are drawn. */
#ifndef GM_CORE_ODE_PORTRAIT_PORTRAIT_H
#define GM_CORE_ODE_PORTRAIT_PORTRAIT_H

#include "core/ode/ode.h"

/* A rectangle of the plane; axis 0 is the first component. */
struct gm_window {
    double low[2], high[2];
};

enum gm_equilibrium_kind {
    GM_SADDLE,
    GM_STABLE_NODE,
    GM_STABLE_FOCUS,
    GM_UNSTABLE_NODE,
    GM_UNSTABLE_FOCUS,
    GM_CENTRE,     /* of the linear field: nonlinear terms may make it a focus */
    GM_DEGENERATE, /* an eigenvalue is 0 */
    GM_NOT_SMOOTH  /* the Jacobian jumps there; eigenvalues are NaN */
};
/* Returns "saddle", "stable node" ... */
const char *gm_equilibrium_kind_name(enum gm_equilibrium_kind kind);

struct gm_equilibrium {
    double at[2];
    enum gm_equilibrium_kind kind;
    double
        eigenvalues[2]
                   [2]; /* real and imaginary part of each; the larger real part, or the upper one, first */
    double jacobian[4]; /* by rows */
};

enum { GM_MOST_EQUILIBRIA = 64, GM_PORTRAIT_COLUMNS = 160, GM_PORTRAIT_ROWS = 120 };

struct gm_portrait {
    struct gm_window window;
    struct gm_equilibrium equilibria[GM_MOST_EQUILIBRIA]; /* by x, then y */
    size_t count;
    /* Each component of f at the corners of a grid of cells, row by row from the lower left; NaN beside a pole or a
       jump, so that the lines on which it changes its sign are the nullclines. One block of memory. */
    double *fields[2];
    /* A sentence about equilibria that are not listed; NULL if the list is complete. */
    const char *missing;
};

/* Opens the portrait of a problem of two components; its m does not matter. Returns false when out of memory. The
   caller closes it in both cases. */
bool gm_portrait_open(struct gm_portrait *portrait, const struct gm_problem *problem,
                      const struct gm_window *window);
void gm_portrait_close(struct gm_portrait *portrait);

#endif
