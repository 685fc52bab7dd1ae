/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The data of a user-defined problem, for the files that fill its facets. */
#ifndef GM_CORE_ODE_USER_DATA_H
#define GM_CORE_ODE_USER_DATA_H

#include "core/events.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/user/formulas.h"
#include "core/ode/user/kernel.h"
#include "core/ode/user/lazy_tape.h"

/* The formulas of a problem, behind those of its kernels. */
enum gm_user_formula {
    GM_USER_SLOW_FORCE = GM_KERNEL_FUNCTIONS, /* of q alone; so are the next two */
    GM_USER_ATTRACTION,
    GM_USER_PERTURBATION,
    GM_USER_DRIFT, /* of places and of the time, as the next */
    GM_USER_TURNING,
    GM_USER_DENSITY, /* the monitor's Q, and dQ/dy */
    GM_USER_DENSITY_SLOPES,
    GM_USER_GRADIENT, /* of the energy of a bracket */
    GM_USER_BRACKET,
    GM_USER_MOMENTA, /* of a Lagrangian: dL/dv and the mass matrix, p', L, all slopes */
    GM_USER_RATES,
    GM_USER_ACTION,
    GM_USER_ACTION_SLOPES,
    GM_USER_CONSTRAINTS,
    GM_USER_ONE_FORM,
    GM_USER_SURFACES, /* of components, the time and switches: g of all events and switches */
    GM_USER_BOOKED,   /* what is conserved between events */
    GM_USER_FORMULAS
};

/* A problem's `parameters` and `facets` point into it. */
struct gm_user_data {
    const double *constants[GM_KERNEL_FUNCTIONS]; /* first: the constants of compiled kernels */
    struct gm_ode ode;
    struct gm_loops loops, interpreted, free; /* free: without constraints */
    const struct gm_loops *taken; /* the source of compiled functions in `loops`; NULL: all are interpreted */
    const struct gm_loops *frozen_loops; /* problems with frozen switches take these */
    void *note;                          /* the compiler's note */
    struct gm_split split;
    struct gm_hamiltonian hamiltonian;
    struct gm_volume volume;
    struct gm_magnetic magnetic;
    struct gm_parts parts;
    struct gm_fast_linear fast_linear;
    struct gm_kepler_split kepler_split;
    struct gm_gravity gravity;
    struct gm_lagrangian one_degree;
    struct gm_action action;
    struct gm_monitor monitor;
    struct gm_poisson poisson;
    struct gm_degenerate degenerate;
    struct gm_late_tape tapes[GM_USER_FORMULAS];
    struct gm_events events;
    struct gm_late_tape *changes,
        *event_slopes;           /* of each event: conditions and new values; slopes, also of breaks */
    struct gm_late_tape *rates;  /* one by one, where each component alone has an exact flow; else NULL */
    struct gm_late_tape *pieces; /* of the energy of a bracket: rates and slopes of each */
    double *frequencies;         /* one per coordinate */
    double friction;
    double matrix[9]; /* the matrix of a linear field of three components without divergence */
    double *values;   /* values of the system's variables */
    const struct gm_user_model *model;
    const struct gm_user_rates *formulas; /* of the model: the rates for these values */
    struct gm_arena *arena;               /* owns all of this */
};

/* Not constant: tapes are made later (core/ode/user/lazy_tape.h). */
static inline struct gm_user_data *gm_user_data_of(const struct gm_problem *problem)
{
    return (struct gm_user_data *)problem->parameters;
}

/* Names the formulas of a tape; its inputs are the first variables. */
static inline void gm_user_compile(const struct gm_user_data *data, struct gm_late_tape *tape,
                                   const gm_node_id *nodes, size_t count, size_t inputs)
{
    *tape = (struct gm_late_tape){&data->model->system->graph, nodes, count, inputs, data->values, NULL};
    gm_arena_keep(data->arena, tape, gm_late_tape_close);
}

static inline void gm_user_values(const struct gm_problem *problem, int formula, const double *inputs,
                                  double *values, size_t m)
{
    gm_late_tape_values(&gm_user_data_of(problem)->tapes[formula], inputs, values, m);
}

/* The motion of a Lagrangian system in coordinates and momenta: at each state the velocities solve dL/dv = p, with the
   mass matrix d2L/dv2 factored there; then q' = v and p' = dL/dq + F. The first function names the tapes. q' and p'
   alone if L = T(v) - V(q); the Jacobian by the implicit function theorem. The loops and the energy p v - L are not
   finite if the transform is singular or out of memory, which is noted (core/memory.h). A member's bits do not
   depend on m. */
void gm_user_lagrangian_open(struct gm_user_data *data);
extern const struct gm_loops gm_user_lagrangian_loops;
void gm_user_lagrangian_energy(const struct gm_problem *problem, const double *y, double *energy, size_t m);
/* gm_action.motion, of at most GM_NEWTON_LARGEST components */
void gm_user_lagrangian_motion(const struct gm_problem *problem, const double *at,
                               const struct gm_motion *motion);

/* Opens the events of a problem, if it has any. */
void gm_user_events_open(struct gm_problem *problem);

/* Opens the facet of schemes for brackets, whose flow is NaN where the motion is too fast for its exponential. */
void gm_user_bracket_open(const struct gm_problem *problem);

/* Opens the facet of the parts that have names: lines `part:` and `let:`, and those of the structure. The arena's
   body is left when out of memory. */
void gm_user_parts_open(const struct gm_problem *problem);

/* gm_ode.conserved */
gm_node_id gm_user_conserved(const struct gm_problem *problem, const char *name, struct gm_formula *graph,
                             char *lacks);

#endif
