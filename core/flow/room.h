/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_ROOM_H
#define GM_CORE_FLOW_ROOM_H

#include "core/expression/choices.h"
#include "core/flow/boundary.h"
#include "core/flow/gmsh.h"
#include "core/flow/rectangle.h"

/* A room that somebody wrote: lines `word: NAME key = formula key = formula` (core/expression/lines.h), where
   formulas may hold parameters, x, y, of an inlet s, which runs from 0 to 1 along its pieces (core/flow/boundary.h),
   and of what the boundary gives and of the exact solution the time t. */

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
enum { GM_ROOM_NAME = 64, GM_LARGEST_ROOM = 1 << 16, GM_ROOM_SIDES = 255 };

/* Between which its numbers lie, in files as on the command line. */
struct gm_room_range {
    double least, most;
};
static const struct gm_room_range gm_room_dt = {1e-9, 1e6}, gm_room_until = {0, 1e12},
                                  gm_room_viscosity = {1e-12, 1e6}, gm_room_schmidt = {1e-6, 1e6};

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

struct gm_room_parameter {
    char *name, *text, *meaning; /* text: as it is written; "": not given */
    double value, low, high;     /* NAN: it is no number; no range is given */
    size_t place;                /* in the text */
};

/* The value that a parameter or a choice is to have: a number, or of words `text`. */
struct gm_room_given {
    const char *name, *text;
    double value;
};

/* What is known of a room when its flow is there, and a name in formulas that are read then. */
enum gm_room_measure {
    GM_ROOM_PERIMETER,
    GM_ROOM_AREA,
    GM_ROOM_INLET_LENGTH,
    GM_ROOM_UNTIL,
    GM_ROOM_MEASURES
};

struct gm_room {
    char *text; /* that of the file, with the lines that hold for other words of a choice as comments */
    size_t length;
    struct gm_formula graph;
    double *scratch; /* a number for each node of it */
    struct gm_room_line *lines;
    size_t count;
    struct gm_written_choices choices;
    struct gm_room_parameter *parameters;
    size_t parameter_count;
    bool rectangular; /* its mesh is a rectangle, whose edges and strips are the values of these parameters */
    struct gm_rectangle rectangle;
    char edges[GM_ROOM_NAME], strips[GM_ROOM_NAME];
    long multiple;                     /* of which edges are one; 0: of none */
    double fixed[8];                   /* points of the rectangle that are vertices */
    double measures[GM_ROOM_MEASURES]; /* NAN: not known */
    bool from_file; /* a parameter gives another mesh, and those that are called like sides name its groups */
    enum gm_vertex_kind outlet;
    bool unsolved;                      /* the exact solution does not hold */
    char *title, *about, *mesh, *units; /* NULL: not given */
    char *scalar;                       /* what pictures call what is carried; NULL: a concentration */
    double viscosity, diffusivity, reynolds,
        schmidt; /* NAN: not given; the former two are made of the latter */
    bool timed;  /* something that the boundary gives holds t */
    double dt, until;
    struct gm_room_range dt_range;
    double buoyancy, reference_temperature; /* NAN: there is no heat */
};

/* Reads a room's text; it is copied. False with a fault, whose sentence is empty where memory was refused. To
   be closed in both cases. */
bool gm_room_read(struct gm_room *room, const char *text, size_t length, const struct gm_room_given *given,
                  size_t count, struct gm_fault *fault);
void gm_room_close(struct gm_room *room);

/* The value of line number `number`, from 0, of those with a word; false: there are fewer. */
bool gm_room_said(const struct gm_room *room, const char *word, size_t number, struct gm_span *value);
/* Of the pieces of a line behind semicolons, the rest of the one that begins with a word; false: there is none. */
bool gm_room_option(const struct gm_room *room, struct gm_span pieces, const char *word,
                    struct gm_span *value);
/* A number that parameters alone make. */
bool gm_room_number(const struct gm_room *room, struct gm_span span, double *number, struct gm_fault *fault);
/* low .. high */
bool gm_room_range_of(const struct gm_room *room, struct gm_span span, struct gm_room_range *range,
                      struct gm_fault *fault);
/* NULL: there is none of that name. */
const struct gm_room_parameter *gm_room_parameter(const struct gm_room *room, const char *name);

/* A line without a name; NULL: there is none. */
const struct gm_room_line *gm_room_line(const struct gm_room *room, enum gm_room_word word);
/* The value of a key at the part s of a side, the point x, y and the time t; its standard where it is not
   given, or there is no line. */
double gm_room_value(const struct gm_room *room, const struct gm_room_line *line, enum gm_room_key key,
                     const double at[4], double standard);

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
