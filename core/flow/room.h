/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_ROOM_H
#define GM_CORE_FLOW_ROOM_H

#include "core/flow/boundary.h"
#include "core/flow/gmsh.h"
#include "core/flow/rectangle.h"
#include "core/flow/statements.h"

/* A room that somebody wrote: lines `word: NAME key = formula key = formula`, where formulas may hold parameters, x, y,
   of an inlet s, which runs from 0 to 1 along its pieces (core/flow/boundary.h), and of what the boundary gives and of
   the exact solution the time t; and what its other lines say (core/flow/statements.h). */

enum gm_room_word {
    GM_ROOM_INLET,
    GM_ROOM_OUTLET,
    GM_ROOM_WALL,
    GM_ROOM_BOUNDARY, /* the last of those that name a side */
    GM_ROOM_SOURCE,
    GM_ROOM_PROBE,
    GM_ROOM_START,
    GM_ROOM_EXACT
};
enum gm_room_key {
    GM_ROOM_SPEED,
    GM_ROOM_FLOW,
    GM_ROOM_SCALAR,
    GM_ROOM_TEMPERATURE,
    GM_ROOM_TANGENTIAL,
    GM_ROOM_HEAT,
    GM_ROOM_RATE,
    GM_ROOM_X,
    GM_ROOM_Y,
    GM_ROOM_SLIP,
    GM_ROOM_VORTICITY,
    GM_ROOM_STREAM_FUNCTION,
    GM_ROOM_SPEED_X,
    GM_ROOM_SPEED_Y,
    GM_ROOM_TOTAL_PRESSURE,
    GM_ROOM_CENTRE, /* of a parabola the largest speed */
    GM_ROOM_KEYS
};
enum { GM_LARGEST_ROOM = 1 << 16, GM_ROOM_SIDES = 255 };

struct gm_room_line {
    enum gm_room_word word;
    char name[GM_ROOM_NAME]; /* of a group, or its own */
    size_t place;            /* in the text */
    struct gm_room_formula {
        size_t place;     /* 0: not given */
        gm_node_id *part; /* what it is made of, itself the last */
        size_t parts;
    } value[GM_ROOM_KEYS];
};

struct gm_room {
    struct gm_room_names names;
    struct gm_statements said;
    size_t length; /* of the text */
    struct gm_formula graph;
    double *scratch; /* a number for each node of it */
    struct gm_room_line *lines;
    size_t count;
    bool rectangular; /* its mesh is a rectangle, of whose edges a multiple of that is taken; 0: any */
    struct gm_rectangle rectangle;
    long multiple;
    double fixed[2 * GM_ROOM_KEPT]; /* points of the rectangle that are vertices */
    bool from_file; /* a parameter gives another mesh, and those that are called like sides name its groups */
    enum gm_vertex_kind outlet;
    bool unsolved; /* the exact solution does not hold */
    double viscosity, diffusivity;
    bool timed;                             /* something that the boundary gives holds t */
    double buoyancy, reference_temperature; /* NAN: there is no heat */
};

/* Reads a room's text; it is copied. False with a fault, whose sentence is empty where memory was refused. To
   be closed in both cases. */
bool gm_room_read(struct gm_room *room, const char *text, size_t length, const struct gm_room_given *given,
                  size_t count, struct gm_fault *fault);
void gm_room_close(struct gm_room *room);

/* A line without a name; NULL: there is none. */
const struct gm_room_line *gm_room_line(const struct gm_room *room, enum gm_room_word word);
/* The value of a key at the part s of a side, the point x, y and the time t; its standard where it is not
   given, or there is no line. */
double gm_room_value(const struct gm_room *room, const struct gm_room_line *line, enum gm_room_key key,
                     const double at[GM_ROOM_AT], double standard);

/* Where a source or a probe is. */
void gm_room_point(const struct gm_room *room, const struct gm_room_line *line, double point[2]);

/* The flow of the room on its mesh, which it takes; the room has to outlive it. NULL with a fault; `boundary` says what
   is wrong with its flows, where that is what is wrong. */
struct gm_flow *gm_room_flow(struct gm_room *room, struct gm_triangulation *mesh, struct gm_fault *fault,
                             enum gm_boundary_fault *boundary);

/* Why the boundary can give nothing at a time (struct gm_flow, give); the fault's sentence is empty where it
   can, or where `boundary` says it. */
void gm_room_fault(const struct gm_room *room, const struct gm_flow *flow, double t, struct gm_fault *fault,
                   enum gm_boundary_fault *boundary);

/* The name of a hole, from 1: that of the group of its wall, or "hole1". */
const char *gm_room_hole(const struct gm_triangulation *mesh, const struct gm_complex *complex, size_t hole,
                         char *name, size_t size);

#endif
