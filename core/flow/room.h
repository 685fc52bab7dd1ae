/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_ROOM_H
#define GM_CORE_FLOW_ROOM_H

#include "core/arena.h"
#include "core/expression/choices.h"
#include "core/flow/boundary.h"
#include "core/form/generators.h"
#include "core/form/gmsh.h"

#include <stdint.h>

/* A room that somebody wrote: lines `word: NAME key = formula key = formula` (core/expression/lines.h), where
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

struct gm_room_parameter {
    char *name, *text, *meaning; /* text: as it is written; "": not given */
    double value, low, high;     /* NAN: not a number; without a range */
    size_t place;                /* position in the text */
};

/* The measures of a room's flow, which are names in formulas that are evaluated after it is made. */
enum gm_room_measure {
    GM_ROOM_PERIMETER,
    GM_ROOM_AREA,
    GM_ROOM_INLET_LENGTH,
    GM_ROOM_UNTIL,
    GM_ROOM_MEASURES
};

struct gm_room {
    struct gm_arena *arena; /* all that is read */
    struct gm_fault *fault; /* of the text, while it is read or a flow is made */
    char *text;             /* text of the file */
    size_t length;
    struct gm_read_line *said; /* its lines that hold */
    size_t said_count;
    struct gm_formula graph;
    double *scratch; /* a number for each node of the graph */
    struct gm_room_line *lines;
    size_t count;
    struct gm_written_choices choices;
    struct gm_room_parameter *parameters;
    size_t parameter_count;
    bool rectangular; /* the mesh is a rectangle; its edges and strips are parameters */
    struct gm_rectangle rectangle;
    char edges[GM_ROOM_NAME], strips[GM_ROOM_NAME];
    long multiple;                     /* divisor of the number of edges; 0: none */
    double fixed[8];                   /* points of the rectangle that are vertices */
    double measures[GM_ROOM_MEASURES]; /* NAN: not known */
    bool from_file; /* a parameter names the mesh; parameters named like sides name its groups */
    enum gm_vertex_kind outlet;
    bool unsolved;                      /* the exact solution does not hold */
    char *title, *about, *mesh, *units; /* NULL: not given */
    char *scalar;                       /* name of the carried scalar in pictures; NULL: a concentration */
    double viscosity, diffusivity, reynolds,
        schmidt; /* NAN: not given; the first two follow from the others */
    bool timed;  /* a boundary value depends on t */
    double dt, until;
    struct gm_room_range dt_range;
    double buoyancy, reference_temperature; /* NAN: without heat */
};

/* A text, which is copied, and the values that a caller gives. */
struct gm_system_value;
struct gm_room_input {
    const char *text;
    size_t length;
    const struct gm_system_value *given; /* of parameters and choices */
    size_t count;
};

/* Reads a room in a body of the arena that holds it. A fault leaves the body; its sentence is empty when out
   of memory. */
void gm_room_read(struct gm_arena *arena, struct gm_room *room, const struct gm_room_input *input,
                  struct gm_fault *fault);
/* Opens a room in an arena of its own; NULL with a fault. */
struct gm_room *gm_room_open(const struct gm_room_input *input, struct gm_fault *fault);
/* Closes a room that was opened; it may be NULL. */
void gm_room_close(struct gm_room *room);

/* The rest of what is read in the same body: words in the room's memory; a fault, which leaves the body; and
   leaving it if another function has set the fault. */
char *gm_room_keep(const struct gm_room *room, struct gm_span span);
__attribute__((format(printf, 3, 4))) _Noreturn void gm_room_refuse(const struct gm_room *room, size_t place,
                                                                    const char *format, ...);
void gm_room_need(const struct gm_room *room, bool good);

/* The value of line number `number`, from 0, of the lines that begin with `word`; false if there are
   fewer. */
bool gm_room_said(const struct gm_room *room, const char *word, size_t number, struct gm_span *value);
/* The rest of the piece that begins with `word`, after a semicolon of a line; false without one. */
bool gm_room_option(const struct gm_room *room, struct gm_span pieces, const char *word,
                    struct gm_span *value);
/* A number computed from parameters; false with a fault. */
bool gm_room_number(const struct gm_room *room, struct gm_span span, double *number, struct gm_fault *fault);
/* low .. high */
bool gm_room_range_of(const struct gm_room *room, struct gm_span span, struct gm_room_range *range,
                      struct gm_fault *fault);
/* Returns the parameter of that name, or NULL. */
const struct gm_room_parameter *gm_room_parameter(const struct gm_room *room, const char *name);

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
