/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The motion of a Lagrangian system in coordinates and momenta: at each state the velocities solve dL/dv = p,
   with the mass matrix d2L/dv2 factored there; then q' = v and p' = dL/dq + F. */
#ifndef GM_CORE_ODE_USER_LAGRANGIAN_H
#define GM_CORE_ODE_USER_LAGRANGIAN_H

#include "core/model/system.h"
#include "core/ode/ode.h"
#include "core/tape.h"

/* The formulas of L, derived once: functions of q, v (stored instead of the momenta) and t. */
struct gm_user_lagrangian_model {
    size_t half, components; /* half: coordinates; components: 2 half, and one more if the system is timed */
    bool linear;             /* dL/dv is linear in v: one solve finds it */
    gm_node_id *nodes;       /* dL/dv, p' (half each), L */
    struct gm_sparse slopes; /* the slopes of dL/dv and p' over q, v, t */
    gm_node_id *slope_nodes;
    gm_node_id *momenta; /* dL/dv, and the entries of the mass matrix */
    size_t momenta_count;
};
/* Derives the formulas; the graph of the system grows. The arena owns them; its body is left when out of memory. */
void gm_user_lagrangian_model_open(struct gm_arena *arena, struct gm_user_lagrangian_model *model,
                                   struct gm_user_system *system);

/* Names the tapes of L for the problem's values. */
struct gm_user_data; /* core/ode/user/data.h */
void gm_user_lagrangian_open(struct gm_user_data *data);

/* q' and p' alone if L = T(v) - V(q); the Jacobian by the implicit function theorem for dL/dv(q, v, t) = p. The loops
   and the energy p v - L are not finite if the transform is singular or out of memory, which is noted
   (core/memory.h). A member's bits do not depend on m. */
extern const struct gm_loops gm_user_lagrangian_loops;
void gm_user_lagrangian_energy(const struct gm_problem *problem, const double *y, double *energy, size_t m);
/* gm_action.motion, of at most GM_NEWTON_LARGEST components */
void gm_user_lagrangian_motion(const struct gm_problem *problem, const double *at,
                               const struct gm_motion *motion);

#endif
