/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The boundary of a flow: walls, inlet, outlet, lid, and what they give. */
#ifndef GM_CORE_FLOW_BOUNDARY_H
#define GM_CORE_FLOW_BOUNDARY_H

#include "core/flow/flow.h"

/* What a boundary edge is. */
enum gm_edge_kind { GM_EDGE_WALL, GM_EDGE_INLET, GM_EDGE_OUTLET, GM_EDGE_LID, GM_EDGE_SLIP };

enum gm_boundary_fault {
    GM_BOUNDARY_OK,
    GM_BOUNDARY_MEMORY,
    GM_BOUNDARY_LOOPS,    /* a hole: the stream function on its wall is not known */
    GM_BOUNDARY_NO_INLET, /* an outlet alone */
    GM_BOUNDARY_NO_OUTLET,
    GM_BOUNDARY_SEVERAL, /* an inlet or an outlet in several pieces */
    GM_BOUNDARY_SHORT,   /* an inlet or an outlet of one edge: no vertex inside */
    GM_BOUNDARY_WHOLE,   /* nothing but an inlet or an outlet */
};

/* The boundary of a room: edges of complex->boundary_edge in that order. Through the inlet enters, and
   through the outlet leaves, the flow 2/3 speed * length of the inlet with parabolic profile; the lid moves
   clockwise (to +x on top) with this speed; walls stand still. A vertex belongs to the inlet (outlet) if both
   its boundary edges do. Outlet vertices are of the kind `outlet`. theta is held at 0 on walls and lid and at
   `theta` in the inlet, and is free in the outlet. psi is 0 on the wall from which the outlet begins,
   counter-clockwise. */
enum gm_boundary_fault gm_flow_set_boundary(struct gm_flow *flow, const unsigned char *sides, double speed,
                                            enum gm_vertex_kind outlet, double theta);

#endif
