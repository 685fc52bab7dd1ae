/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The boundary of a flow: walls, inlets, outlets, lids, holes, and what they give. */
#ifndef GM_CORE_FLOW_BOUNDARY_H
#define GM_CORE_FLOW_BOUNDARY_H

#include "core/flow/flow.h"

/* What a boundary edge is. */
enum gm_edge_kind { GM_EDGE_WALL, GM_EDGE_INLET, GM_EDGE_OUTLET, GM_EDGE_LID, GM_EDGE_SLIP };

/* What a side may give that is another number at each of its places. */
enum gm_given { GM_GIVEN_THETA, GM_GIVEN_TEMPERATURE, GM_GIVEN_TANGENTIAL, GM_GIVEN_HEAT };

/* What edges of one name give. Each piece of an inlet or outlet is one opening; pieces follow each other
   counter-clockwise, from the lowest of the wall's leftmost points on. */
struct gm_side {
    enum gm_edge_kind kind;
    /* Through all its pieces, in through inlets, out through outlets, in proportion to their lengths; NAN: of
       an inlet what its speed makes, of an outlet what enters and leaves nowhere else, in proportion to the
       lengths. */
    double flow;
    /* Of an inlet the largest one, with a parabolic profile; of a lid to the side that has the air on its
       right hand, clockwise around a room, to +x on top. */
    double speed;
    /* The normal speed at the part s, 0 to 1, of all pieces together, instead of a parabola; scaled where a
       flow is given, too. NULL: none. */
    double (*profile)(const void *data, double s, const double at[2]);
    /* Where it varies along the side: instead of theta, of temperature, of heat, and of speed of a lid; s is 0 but
       of inlets. NULL: it does not. */
    double (*varying)(const void *data, enum gm_given what, double s, const double at[2]);
    const void *data;      /* of both */
    bool theta_free;       /* no flux; of outlets always */
    double theta;          /* else it is held at this */
    bool temperature_free; /* the same of temperature, of flows that carry heat */
    double temperature;
    bool heats;  /* a wall that does not hold a temperature gives this heat, */
    double heat; /* per unit of length and time, over density and heat capacity */
};

enum gm_boundary_fault {
    GM_BOUNDARY_OK,
    GM_BOUNDARY_MEMORY,
    GM_BOUNDARY_NO_INLET, /* an outlet alone */
    GM_BOUNDARY_NO_OUTLET,
    GM_BOUNDARY_SHORT,      /* a piece of an inlet or an outlet of one edge: no vertex inside */
    GM_BOUNDARY_WHOLE,      /* nothing but an inlet or an outlet */
    GM_BOUNDARY_IN_HOLE,    /* an inlet or an outlet on a hole's wall */
    GM_BOUNDARY_UNBALANCED, /* all flows are given, and what enters does not leave */
    GM_BOUNDARY_PROFILE,    /* no more enters by an inlet's profile than leaves by it */
    GM_BOUNDARY_BACKWARDS,  /* an outlet would have to let air in */
    GM_BOUNDARY_OVERFLOW,   /* what enters or leaves is too much for a number */
};

/* The boundary of a room, in place of one that was made before: side_of[b] is the side of edge
   complex->boundary_edge[b]. A vertex belongs to an inlet (outlet) if both its boundary edges are of the same
   piece. Outlet vertices are of the kind `outlet`.
   psi is 0 on the wall from which the first outlet begins, counter-clockwise; on the walls of holes it is
   unknown. */
enum gm_boundary_fault gm_flow_set_sides(struct gm_flow *flow, const unsigned char *side_of,
                                         const struct gm_side *sides, enum gm_vertex_kind outlet);

/* The same of edges of each kind as one side: inlets have this speed, lids move with it; theta is held at 0
   on walls and lids and at `theta` in inlets. */
enum gm_boundary_fault gm_flow_set_boundary(struct gm_flow *flow, const unsigned char *kinds, double speed,
                                            enum gm_vertex_kind outlet, double theta);

#endif
