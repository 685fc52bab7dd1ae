/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The formulas of a user-defined system, and those that a Lagrangian or a bracket adds to them. */
#ifndef GM_CORE_ODE_USER_FORMULAS_H
#define GM_CORE_ODE_USER_FORMULAS_H

#include <stdint.h>

#include "core/events.h"
#include "core/expression/derivative.h"
#include "core/model/breaks.h"
#include "core/model/facts.h"
#include "core/ode/families/splitting/linear_flow.h"
#include "core/ode/ode.h"

/* The rates of the components, and their Jacobian d rate[row] / d component if the model has one; for all
   values of the parameters, or for the value that a line `compile:` gives to one. */
struct gm_user_rates {
    gm_node_id *nodes;
    struct gm_sparse jacobian;
    gm_node_id *slopes; /* the nodes of the Jacobian */
    size_t parameter;   /* a number of a variable; SIZE_MAX: none */
    double value;
};

/* Functions g(q) of coordinates, and their exact derivatives. */
struct gm_user_functions {
    size_t coordinates, count; /* count: functions, 0: none */
    gm_node_id *nodes;         /* g, the slopes, and the slopes of these */
    struct gm_sparse slopes;   /* dg[row] / dq */
    struct gm_sparse second;   /* the slopes' derivatives over q: row is an entry of slopes */
};

/* A Lagrangian as functions of q, v (stored instead of the momenta) and t. */
struct gm_user_lagrangian {
    size_t half, components; /* half: coordinates; components: 2 half, and one more if the system is timed */
    bool linear;             /* dL/dv is linear in v: one solve finds it */
    gm_node_id *nodes;       /* dL/dv, p' (half each), L */
    struct gm_sparse slopes; /* the slopes of dL/dv and p' over q, v, t */
    gm_node_id *slope_nodes;
    gm_node_id *momenta; /* dL/dv, and the entries of the mass matrix */
    size_t momenta_count;
};

/* The bracket of a Poisson system: its structure, and the pieces of its energy that have exact flows. */
struct gm_user_bracket {
    gm_node_id *gradient;    /* dH/dy, n; NULL: not a Poisson system, or H holds the time */
    struct gm_poisson facet; /* but for the moments of inertia */
    /* A piece of the energy is a function of components that commute, {y_i, y_j} = 0, and so rest in its flow; the
       others move linearly. */
    struct gm_linear_flow *pieces;
};

/* An event, as formulas. */
struct gm_user_event {
    const struct gm_system_item *item;
    enum gm_event_form form;
    bool switches;              /* g is not smooth */
    size_t conditions, changed; /* numbers of these */
    size_t *components;         /* [changed] */
    gm_node_id *nodes;          /* conditions, then new values of these components */
    struct gm_sparse slopes;    /* of g, row 0, and of the new values over components and t */
    gm_node_id *slope_nodes;
};

/* The formulas of a system, for all values of its parameters. They do not change after opening: runs and
   threads share them. */
struct gm_user_model {
    const struct gm_user_system *system;
    struct gm_finding findings[GM_FACTS];
    size_t components;           /* the system's components, and t if it is timed */
    struct gm_user_rates *rates; /* the first for all parameters, then those for a value of one */
    size_t rate_count;
    bool energy_jumps;                    /* gm_ode.energy_jumps */
    bool has_jacobian;                    /* false if the matrix would be too large */
    struct gm_user_lagrangian lagrangian; /* a Lagrangian system's, instead of rates and Jacobian */
    struct gm_user_functions constraints; /* g(q) = 0 */
    struct gm_user_functions
        one_form;                /* theta, n functions, and H; none if the system is timed, or too large */
    gm_node_id monitor, *slopes; /* the density of steps and its gradient over the components; NULL: none */
    struct gm_user_bracket bracket;
    struct gm_user_event *events; /* in the order of the file */
    size_t event_count;
    gm_node_id *surfaces;          /* [event_count], the g that become 0 */
    struct gm_user_frozen *frozen; /* NULL: no breaks are located, and events have no switches */
    const char *names;             /* the components' names, in the format of struct gm_ode */
};

/* The same system with its switches frozen (core/model/breaks.h); it has further variables behind its own. */
struct gm_user_frozen {
    struct gm_user_system system;
    struct gm_user_model model;
    struct gm_break *list;
    size_t breaks, count; /* the first are the switches of rates; others are of events alone */
    gm_node_id *surfaces; /* g of the events of the file, then of each switch */
    bool *inner;          /* [count]: the g of an event holds it */
    gm_node_id *inside;   /* [breaks], above 0 while g has not left the side, or the interval, of its mode */
    struct gm_user_event *events; /* [count], with the slopes of g */
};

/* Derive the formulas of these, in the arena's body, which is left when out of memory; the graph grows. */
void gm_user_lagrangian_derive(struct gm_arena *arena, struct gm_user_lagrangian *model,
                               struct gm_user_system *system);
void gm_user_bracket_derive(struct gm_arena *arena, struct gm_user_bracket *model,
                            struct gm_user_system *system);

#endif
