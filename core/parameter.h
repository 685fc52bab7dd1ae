/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_PARAMETER_H
#define GM_CORE_PARAMETER_H

#include <stdbool.h>
#include <stddef.h>

#include "core/expression/number.h"

/* A parameter is one row of a table. The row makes the key=value of the command line, the slider of the
   explorer, the help, the axis of a sweep, the text chunk of a PNG and the range that is fuzzed. */

enum gm_type {
    GM_REAL,    /* stored as double */
    GM_INTEGER, /* stored as long */
    GM_CHOICE,  /* stored as int, an index into choices */
    GM_BOOLEAN, /* stored as int, 0 or 1; written no, yes */
    GM_TEXT,    /* stored as char[GM_TEXT_SIZE]; no comma but with `names`, no control character */
};

enum { GM_TEXT_SIZE = 256 };

struct gm_parameter {
    const char *key;
    const char *unit; /* "" without a unit */
    const char *help;
    enum gm_type type;
    size_t offset;          /* offset of the value in the owner's struct */
    const char *standard;   /* the default, as it would be typed ("pi/12") */
    double lowest, highest; /* inclusive range of a real or an integer */
    double least;           /* smallest positive value, if 0 has a meaning of its own; 0: none */
    bool logarithmic;       /* a slider moves by factors */
    bool live;              /* a change acts on the current state; otherwise the run starts again */
    bool looks;             /* no step depends on it: it is constant in a run */
    bool starts;            /* where a coordinate starts: its value in a run is another */
    bool sets_step;         /* dt follows from it, or it from dt, and nothing else does */
    /* The choices of a GM_CHOICE, or the usual words of a GM_TEXT, NULL-terminated; NULL: none. */
    const char *const *choices;
    /* Returns true if a GM_TEXT may have this text, else false with a sentence (GM_MESSAGE bytes); `admitting` is
       its data. NULL: it may have every text. */
    bool (*admits)(const struct gm_parameter *row, const char *text, char *sentence);
    const void *admitting;
    bool file;      /* a text that is the path of a file */
    bool names;     /* commas of the text separate names, not lanes, unless all parts are choices */
    bool automatic; /* a real that may also be "auto": NaN, until its owner settles it */
    bool required;  /* always written: its default is an earlier value, or follows from another */
};

/* Rows of `member` of an owner's struct `own`. A row ends with the help, and further fields may follow:
   GM_REAL_ROW(struct disc, radius, "radius", "0.2", 1e-6, 100, "radius of the disc", .logarithmic = true). */
#define GM_ANY_ROW(own, member, key_, type_, standard_, ...)                                                 \
    .key = key_, .unit = "", .type = type_, .offset = offsetof(own, member), .standard = standard_,          \
    .help = __VA_ARGS__
#define GM_REAL_ROW(own, member, key, standard, low, high, ...)                                              \
    {                                                                                                        \
        GM_ANY_ROW(own, member, key, GM_REAL, standard, __VA_ARGS__), .lowest = low, .highest = high         \
    }
#define GM_INTEGER_ROW(own, member, key, standard, low, high, ...)                                           \
    {                                                                                                        \
        GM_ANY_ROW(own, member, key, GM_INTEGER, standard, __VA_ARGS__), .lowest = low, .highest = high      \
    }
#define GM_CHOICE_ROW(own, member, key, standard, list, ...)                                                 \
    {                                                                                                        \
        GM_ANY_ROW(own, member, key, GM_CHOICE, standard, __VA_ARGS__), .choices = list                      \
    }
#define GM_BOOLEAN_ROW(own, member, key, standard, ...)                                                      \
    {                                                                                                        \
        GM_ANY_ROW(own, member, key, GM_BOOLEAN, standard, __VA_ARGS__), .highest = 1                        \
    }
#define GM_TEXT_ROW(own, member, key, standard, ...)                                                         \
    {                                                                                                        \
        GM_ANY_ROW(own, member, key, GM_TEXT, standard, __VA_ARGS__)                                         \
    }

enum gm_parse {
    GM_PARSED,
    GM_NOT_UNDERSTOOD, /* not a number, not one of the choices */
    GM_OUT_OF_RANGE,   /* below lowest, above highest, or not finite */
};

/* Reads text as a value of row and stores it in owner. owner is unchanged unless GM_PARSED is returned. */
enum gm_parse gm_parameter_set(const struct gm_parameter *row, void *owner, const char *text);

/* The value of row in owner as a double (choices and booleans as their index; of a text a
   number that differs where texts differ). */
double gm_parameter_get(const struct gm_parameter *row, const void *owner);

/* Stores a number in owner as if it had been typed; owner is unchanged unless GM_PARSED is returned. */
enum gm_parse gm_parameter_put(const struct gm_parameter *row, void *owner, double value);

/* Writes the words of a choice, separated by commas; an ellipsis ends a list that has no room. Returns text. */
char *gm_parameter_choices(const struct gm_parameter *row, char *text, size_t size);

/* Writes the value of row in owner as it would be typed. Returns text. */
char *gm_parameter_format(const struct gm_parameter *row, const void *owner, char *text, size_t size);

/* Sets every row of the table to its default. */
void gm_parameters_reset(const struct gm_parameter *rows, size_t count, void *owner);

#endif
