/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_NAMES_H
#define GM_CORE_FLOW_NAMES_H

#include "core/expression/lines.h"

/* The names that formulas of a room may hold: its parameters, measures of its flow, and s, x, y, t. */

enum { GM_ROOM_NAME = 64 };

/* The variables of formulas: the part of an inlet, the place, the time. */
enum gm_room_variable { GM_ROOM_AT_S, GM_ROOM_AT_X, GM_ROOM_AT_Y, GM_ROOM_AT_T, GM_ROOM_AT };

/* A parameter of the room, or a choice of words. */
struct gm_room_parameter {
    char *name, *text, *meaning, *words; /* text: as it is written; "": not given */
    double value, low, high;             /* NAN: it is no number; no range is given */
    size_t place;                        /* of its line in the text */
};

/* The value that a parameter is to have: a number, or of words `text`. */
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

struct gm_room_names {
    char *text; /* that of the file, with the lines that hold for other words of a choice as comments */
    struct gm_room_parameter *parameters;
    size_t count;
    double measures[GM_ROOM_MEASURES]; /* NAN: not known */
};

struct gm_room_range {
    double least, most;
};

/* Adds what a line `parameter:` or `choice:` declares, with the value that is given for it. False with a fault. */
bool gm_room_declare(struct gm_room_names *names, struct gm_span rest, bool choice,
                     const struct gm_room_given *given, size_t count, struct gm_fault *fault);
void gm_room_names_close(struct gm_room_names *names);

/* NULL: there is none of that name. */
const struct gm_room_parameter *gm_room_parameter(const struct gm_room_names *names, const char *name);

/* Whether a span is this word. */
bool gm_room_is_word(const struct gm_room_names *names, struct gm_span span, const char *word);

/* Whether words that commas part hold that one. */
bool gm_room_is_listed(const struct gm_room_names *names, const char *words, struct gm_span word);

/* Reads a formula that may hold the variables of which `may` has the bits into a graph; *timed: it holds t. */
bool gm_room_read_formula(const struct gm_room_names *names, struct gm_span span, unsigned may,
                          struct gm_formula *graph, gm_node_id *node, bool *timed, struct gm_fault *fault);
/* The value of a formula at a place. */
bool gm_room_value_of(const struct gm_room_names *names, struct gm_span span, unsigned may,
                      const double at[GM_ROOM_AT], double *value, struct gm_fault *fault);
/* A number that parameters alone make. */
bool gm_room_number(const struct gm_room_names *names, struct gm_span span, double *number,
                    struct gm_fault *fault);
/* low .. high */
bool gm_room_range_of(const struct gm_room_names *names, struct gm_span span, struct gm_room_range *range,
                      struct gm_fault *fault);

#endif
