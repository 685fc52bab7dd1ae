/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_ROOM_H
#define GM_CORE_FLOW_ROOM_H

#include "core/arena.h"
#include "core/flow/boundary.h"
#include "core/form/generators.h"
#include "core/form/gmsh.h"
#include "core/form/program.h"
#include "core/model/system.h"

#include <stdint.h>

/* A room that somebody wrote: lines that core/model reads, and lines `word: NAME key = formula key = formula`, where
   formulas may hold parameters, x, y, of an inlet s, which runs from 0 to 1 along its pieces
   (core/flow/boundary.h), and of what the boundary gives and of the exact solution the time t. */

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
    GM_ROOM_CENTRE, /* largest speed of a parabola */
    GM_ROOM_KEYS
};
enum { GM_ROOM_NAME = 64, GM_LARGEST_ROOM = 1 << 16, GM_ROOM_SIDES = 255 };

/* The range of a number, in files as on the command line. */
struct gm_room_range {
    double least, most;
};
static const struct gm_room_range gm_room_dt = {1e-9, 1e6}, gm_room_until = {0, 1e12},
                                  gm_room_viscosity = {1e-12, 1e6}, gm_room_schmidt = {1e-6, 1e6};

struct gm_room_line {
    enum gm_room_word word;
    char name[GM_ROOM_NAME]; /* name of a group, or of the line */
    size_t place;            /* position in the text */
    struct gm_room_formula {
        size_t place;     /* 0: not given */
        gm_node_id *part; /* nodes of its subexpressions, the whole one last */
        size_t parts;
    } value[GM_ROOM_KEYS];
};

/* A room: a system whose lines have, beside those of systems, these items. Nodes: side: left and right sides of its
   conditions, whose signs are its text; time: the unit; graph: low, high, or none. Values: levels; profile: both
   ends and the number of points, its words are the letters of its quantities and its text is a label; table: positions
   and values on the profile in its words, if the parameter in its text is item.value. colours: the end of the
   colours of `name` is item.value. */
struct gm_room {
    struct gm_user_system system;
    struct gm_read_line *said; /* its lines that hold */
    size_t said_count;
    double *values, *scratch; /* of the system's variables; of the nodes of its graph */
    struct gm_room_line *lines;
    size_t count;
    bool rectangular; /* the mesh is a rectangle; its edges and strips are parameters */
    struct gm_rectangle rectangle;
    char *edges, *strips;
    long multiple;   /* divisor of the number of edges; 0: none */
    double fixed[8]; /* points of the rectangle that are vertices */
    bool from_file;  /* a parameter names the mesh; parameters named like sides name its groups */
    enum gm_vertex_kind outlet;
    bool unsolved; /* the exact solution does not hold */
    double viscosity, diffusivity, reynolds,
        schmidt;                            /* NAN: not given; the first two follow from the others */
    bool timed;                             /* a boundary value depends on t */
    struct gm_form_program observed;        /* its roots: formulas of lines observe: */
    struct gm_flow_forms *forms;            /* their values, once the flow is made (core/flow/observed.h) */
    double buoyancy, reference_temperature; /* NAN: without heat */
};

/* A text, which is copied, and the values that a caller gives. */
struct gm_room_input {
    const char *text;
    size_t length;
    const struct gm_system_value *given; /* of parameters and choices */
    size_t count;
};

/* A system of this text, which gm_room_read reads. */
static inline struct gm_user_system gm_room_unread(const char *text, size_t length)
{
    return (struct gm_user_system){.kind = GM_ROOM, .source = (char *)(uintptr_t)text, .length = length};
}
/* Reads a room in a body of the arena that holds it. A fault leaves the body; its sentence is empty when out
   of memory. */
void gm_room_read(struct gm_arena *arena, struct gm_room *room, const struct gm_room_input *input,
                  struct gm_fault *fault);
/* Opens a room in an arena of its own; NULL with a fault. */
struct gm_room *gm_room_open(const struct gm_room_input *input, struct gm_fault *fault);
/* Closes a room that was opened; it may be NULL. */
void gm_room_close(struct gm_room *room);

/* The first line with this word, or NULL. */
const struct gm_read_line *gm_room_said(const struct gm_room *room, enum gm_system_word word);
/* The parameter of that name, or NULL. Its value is NAN if it is a word; its text may be "". */
const struct gm_system_variable *gm_room_parameter(const struct gm_room *room, const char *name);
/* The number of a line dt: or until:, or `otherwise`. */
double gm_room_timing(const struct gm_room *room, enum gm_system_word word, double otherwise);
/* The value of an item's node; NAN if it needs a measure that is not known yet. */
double gm_room_evaluate(const struct gm_room *room, gm_node_id node);

/* The line with this word and without a name, or NULL. */
const struct gm_room_line *gm_room_line(const struct gm_room *room, enum gm_room_word word);
/* The value of a key at the part s of a side, the point x, y and the time t; `standard` if it is not
   given, or without a line. */
double gm_room_value(const struct gm_room *room, const struct gm_room_line *line, enum gm_room_key key,
                     const double at[4], double standard);

/* The position of a source or a probe. */
void gm_room_point(const struct gm_room *room, const struct gm_room_line *line, double point[2]);

/* The flow of the room on its mesh, which it takes; it is closed with the room. Returns NULL with a fault,
   which may have no place in the text. */
struct gm_flow *gm_room_flow(struct gm_room *room, struct gm_triangulation *mesh, struct gm_fault *fault);
#define GM_ROOM_NOWHERE SIZE_MAX

/* Writes the reason why the boundary is not valid at a time (struct gm_flow, give); the fault's sentence
   is empty if it is valid. */
void gm_room_fault(const struct gm_room *room, const struct gm_flow *flow, double t, struct gm_fault *fault);

/* The name of a hole, from 1: the name of its wall's group, or "hole1". */
const char *gm_room_hole(const struct gm_triangulation *mesh, const struct gm_complex *complex, size_t hole,
                         char *name, size_t size);

#endif
