/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Switches of a system: operations whose value or first derivative jumps where a function g passes 0. Between the jumps
   the formulas are smooth, and each is followed beyond its switch if the switch is frozen there. */
#ifndef GM_CORE_MODEL_BREAKS_H
#define GM_CORE_MODEL_BREAKS_H

#include "core/expression/identity.h"
#include "core/model/system.h"

enum { GM_MOST_BREAKS = 64 };

/* A switch, frozen by the value of a variable, its mode: the sign of g, -1, 0 or 1, or the whole number below g. */
struct gm_break {
    gm_node_id surface; /* g, with the switches in it frozen too, which precede this one */
    size_t variable;
    bool whole;       /* it switches at whole numbers */
    const char *text; /* of g */
};

/* Adds the key to a system with switches that can be located: it has coordinates, or components with rates, no
   constraint, and at most GM_MOST_BREAKS switches. */
void gm_breaks_declare(struct gm_user_system *system);
/* Returns a flag for each node that is not smooth in the state or the time, in the arena. */
const bool *gm_breaks_switches(struct gm_arena *arena, const struct gm_user_system *system);

/* True if the value of an operation jumps, not only a derivative. */
bool gm_operation_jumps(enum gm_operation operation);
/* Derivatives that vanish prove nothing across a jump. Tests at random points of each switch if the sum over i of
   [f_i] (grad g . d) is 0 where g passes 0; [f_i] is the jump of nodes[i]. The direction d has `variables` components;
   NULL: node i moves along variable i, for a divergence. Proved if no node jumps. The node of a switch where the sum is
   not 0 is written to *at. Inside a body of the arena. */
enum gm_identity gm_breaks_pass(struct gm_arena *arena, struct gm_user_system *system,
                                const gm_node_id *nodes, size_t count, const gm_node_id *direction,
                                size_t variables, gm_node_id *at);

/* Nodes in which switches are frozen, with the switches that were found. */
struct gm_freezing {
    struct gm_user_system *system;
    struct gm_break *list; /* [most] */
    size_t count, most;
    bool closed;         /* no further switch is frozen */
    bool full;           /* there are more */
    const bool *varying; /* of gm_formula_dependent, over the components, the time and velocities */
    size_t node_count;   /* its length */
};
/* Rewrites nodes in place; GM_NO_NODE stays. Leaves the arena's body when out of memory. */
void gm_breaks_freeze(struct gm_arena *arena, struct gm_freezing *freezing, gm_node_id *nodes, size_t count);

#endif
