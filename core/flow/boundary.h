/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The boundary of a flow: walls, inlets, outlets, lids, holes, and what they give. */
#ifndef GM_CORE_FLOW_BOUNDARY_H
#define GM_CORE_FLOW_BOUNDARY_H

#include "core/flow/flow.h"

/* The kind of a boundary edge. */
enum gm_edge_kind { GM_EDGE_WALL, GM_EDGE_INLET, GM_EDGE_OUTLET, GM_EDGE_LID, GM_EDGE_SLIP };

/* The values of a side that may vary along it. */
enum gm_given { GM_GIVEN_THETA, GM_GIVEN_TEMPERATURE, GM_GIVEN_TANGENTIAL, GM_GIVEN_HEAT };

/* The values that edges of one name give. Each piece of an inlet or outlet is one opening; pieces follow
   each other counter-clockwise, from the lowest of the wall's leftmost points on. */
struct gm_side {
    enum gm_edge_kind kind;
    /* The flow through all pieces of a side, in through inlets, out through outlets, in proportion to
       their lengths. NAN: an inlet has the flow of its speed; outlets share the remaining flow, in
       proportion to their lengths. */
    double flow;
    /* The largest speed of an inlet, with a parabolic profile; or the speed of a lid towards the side with
       the air on its right hand, clockwise around a room, to +x on top. */
    double speed;
    /* The normal speed at the part s, 0 to 1, of all pieces together, instead of a parabola, scaled if
       `flow` is given. NULL: a parabola. */
    double (*profile)(const void *data, double s, const double at[2]);
    /* The value that varies along the side: replaces theta, temperature, heat, and the speed of a lid. s
       is 0 except in inlets. NULL: the values are constant. */
    double (*varying)(const void *data, enum gm_given what, double s, const double at[2]);
    const void *data;      /* data of both functions */
    bool theta_free;       /* theta has no flux; true of outlets */
    double theta;          /* the value held if theta is not free */
    bool temperature_free; /* temperature has no flux, in flows that carry heat */
    double temperature;
    bool heats;  /* true: a wall without a given temperature gives `heat` */
    double heat; /* heat per unit of length and time, over density and heat capacity */
};

enum gm_boundary_fault {
    GM_BOUNDARY_OK,
    GM_BOUNDARY_NO_INLET, /* an outlet alone */
    GM_BOUNDARY_NO_OUTLET,
    GM_BOUNDARY_SHORT,      /* a piece of an inlet or an outlet of one edge: no vertex inside */
    GM_BOUNDARY_WHOLE,      /* the whole boundary is an inlet or an outlet */
    GM_BOUNDARY_IN_HOLE,    /* an inlet or an outlet on a hole's wall */
    GM_BOUNDARY_UNBALANCED, /* all flows are given, and what enters does not leave */
    GM_BOUNDARY_PROFILE,    /* the net flow of an inlet's profile is not positive */
    GM_BOUNDARY_BACKWARDS,  /* an outlet would have to let air in */
    GM_BOUNDARY_OVERFLOW,   /* the flow overflows a double */
};

/* Sets the boundary of a room, instead of a previous one: side_of[b] is the side of edge
   complex->boundary_edge[b]. A vertex belongs to an inlet (outlet) if both its boundary edges are of the
   same piece. Outlet vertices are of the kind `outlet`. psi is 0 on the wall from which the first outlet
   begins, counter-clockwise; on the walls of holes it is unknown. */
enum gm_boundary_fault gm_flow_set_sides(struct gm_flow *flow, const unsigned char *side_of,
                                         const struct gm_side *sides, enum gm_vertex_kind outlet);

#endif
