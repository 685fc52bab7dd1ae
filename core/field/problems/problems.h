/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fields on a line that the program's own schemes are for, and their parameters. */
#ifndef GM_CORE_FIELD_PROBLEMS_PROBLEMS_H
#define GM_CORE_FIELD_PROBLEMS_PROBLEMS_H

#include "core/field/field.h"
#include "core/scheme.h"
#include "core/user/line.h"

/* ---- waves ---- */

/* u_tt - u_xx + V'(u) = 0, V = -cos u or V = 0: the caller sets line and n = gm_wave_size(line.points). */
extern const struct gm_problem gm_problem_sine_gordon, gm_problem_wave;

/* The form of every wave equation, in s = (u, u_t, u_x). */
extern const struct gm_form gm_form_of_waves;

/* ---- frames of reference ---- */

/* Equations with frames of reference that move with the velocity lambda: Korteweg and de Vries', and
   on nodes between two ends, of which the first and the last hold exact values,
       Burgers   u_t + u u_x = nu u_xx        (t, x, u) -> (t, x + lambda t, u + lambda)
       heat      u_t = nu u_xx for u > 0      (t, x, u) -> (t, x + lambda t, u exp(-lambda x/(2 nu) - lambda^2 t/(4 nu)))
   with t from the start on. */

/* The nodes of an equation in a frame with the velocity lambda: at rest in that frame, or moving by lambda
   dt per step. */
enum gm_frame_nodes {
    GM_FRAME_EACH, /* moving for invariant schemes, fixed for the others */
    GM_FRAME_FIXED,
    GM_FRAME_MOVING,
};

/* First in the parameters of every equation with frames of reference; the heat equation has no others. */
struct gm_framed {
    struct gm_user_line line; /* first; of a file, else empty. The exact solution is that in the frame */
    double lambda;
    int frame;        /* enum gm_frame_nodes */
    double viscosity; /* nu */
};
static inline const struct gm_framed *gm_framed_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

struct gm_burgers {
    struct gm_framed framed; /* first */
    int printed;             /* the convection is u D u, not D(u^2/2) */
    double a, d;             /* parameters of the family of moving frames (core/field/families/burgers.c) */
};
static inline const struct gm_burgers *gm_burgers_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

/* State of Burgers' equation: u at the nodes; where lambda is not 0 a companion follows, the same run in the frame
   lambda = 0 on as many nodes, and a number, 1 while it is well. Other equations between ends have u alone. */
static inline size_t gm_burgers_size(const struct gm_burgers *burgers, size_t points)
{
    return burgers->framed.lambda != 0 ? 2 * points + 1 : points;
}

/* The caller sets parameters (struct gm_burgers, struct gm_framed), line and n. */
extern const struct gm_problem gm_problem_burgers, gm_problem_heat;

/* Returns true if the nodes rest in the frame when this scheme runs. */
static inline bool gm_frame_rests(const struct gm_framed *framed, const struct gm_scheme *scheme)
{
    return framed->frame == GM_FRAME_FIXED ||
           (framed->frame == GM_FRAME_EACH && !(scheme->claims & GM_EQUIVARIANT));
}

/* ---- dispersive equations ---- */

/* Korteweg-de Vries, u_t + eta u u_x + mu u_xxx = 0, with the state of a wave problem, and its frames of
   reference,
       (t, x, u) -> (t, x + lambda t, u + lambda/eta) */
struct gm_kdv {
    struct gm_framed framed; /* first */
    double eta, mu;
};
static inline const struct gm_kdv *gm_kdv_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

/* Nonlinear Schroedinger, i psi_t + psi_xx + k |psi|^2 psi = 0; the state is Re psi, then Im psi. */
struct gm_nls {
    struct gm_user_line line; /* first; of a file, else empty */
    double k;
};
static inline const struct gm_nls *gm_nls_of(const struct gm_problem *problem)
{
    return problem->parameters;
}

/* The caller sets line, n (kdv: gm_wave_size, nls: 2 points) and parameters (struct gm_kdv; nls: else k = 1). */
extern const struct gm_problem gm_problem_kdv, gm_problem_nls;

#endif
