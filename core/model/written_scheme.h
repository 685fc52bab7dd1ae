/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A scheme as a text: a file, or a word such as composition(verlet; g, 1 - 2*g, g). Every coefficient is read as a
   double and as the ball of numbers that its digits allow. docs/own-schemes.md lists the words. */
#ifndef GM_CORE_MODEL_WRITTEN_SCHEME_H
#define GM_CORE_MODEL_WRITTEN_SCHEME_H

#include "core/expression/lines.h"
#include "core/theory/ball.h"

enum gm_written_kind {
    GM_WRITTEN_RUNGE_KUTTA,
    GM_WRITTEN_EXPLICIT, /* the same, with nothing on or above the diagonal */
    GM_WRITTEN_PARTITIONED,
    GM_WRITTEN_NYSTROM,
    GM_WRITTEN_COMPOSITION,
    GM_WRITTEN_SPLITTING,
    GM_WRITTEN_PROCESSED,
    GM_WRITTEN_ADJOINT,
    GM_WRITTEN_PROJECTED,
    GM_WRITTEN_RELAXED,
    GM_WRITTEN_LIE, /* of parts of the system; so below */
    GM_WRITTEN_STRANG,
    GM_WRITTEN_SPLIT,
    GM_WRITTEN_CALLED, /* the splitting `base` of these parts: saba2(A, B) */
    GM_WRITTEN_KINDS
};

enum gm_scheme_word {
#define GM_SCHEME_WORD(constant, ...) GM_SCHEME_WORD_##constant,
#include "core/model/written_scheme.def"
#undef GM_SCHEME_WORD
    GM_SCHEME_WORDS
};

enum { GM_MOST_STAGES = 16, GM_MOST_SUBSTEPS = 127, GM_MOST_LETS = 64, GM_LARGEST_SCHEME = 1 << 20 };

/* A coefficient: the double that a run takes, and what was written. */
struct gm_written_number {
    double value;
    struct gm_ball ball;
    size_t place, length; /* in the text */
};

struct gm_decimal {
    size_t place, length;
    struct gm_ball ball;
};

/* The decimals of a text that are not exact numbers, with their positions and the digits typed. A line c: that
   repeats the sums of the rows adds none: its numbers follow from A. */
struct gm_decimals {
    size_t count;
    struct gm_decimal *at;
    bool alone; /* the caller needs the decimals and no theory */
    /* The entries of c: that differ from the sums of their rows, with these sums. It is filled if `instead` is
       given; NULL: the caller does not need it. */
    struct gm_row_sums {
        size_t count;
        struct gm_decimal *at;
    } * sums;
    /* Values that replace the decimals, in this order; NULL: the typed ones count and are gathered here. */
    const struct gm_ball *instead;
};

struct gm_written_line {
    bool said;
    struct gm_span value; /* of the text */
    int rows,
        columns; /* shape of its numbers, 0: it has none; columns: the number of schemes that it names */
    struct gm_written_number *numbers;
};

struct gm_written_scheme {
    struct gm_arena *arena; /* owns the numbers */
    const char *text;       /* that it was read from */
    enum gm_written_kind kind;
    struct gm_written_line lines[GM_SCHEME_WORDS]; /* but for LET */
    struct gm_span lets[GM_MOST_LETS];
    int let_count;
    int order;                /* 0: not given */
    bool kick_first, nystrom; /* of a splitting */
};

/* Returns the name of a kind: "runge-kutta". */
const char *gm_written_kind_name(enum gm_written_kind kind);

bool gm_written_is_kind(const char *name);

/* Returns the length of the name, of a kind or of a splitting, that begins a word before its parenthesis; 0: it
   begins none. */
size_t gm_written_word_name(const char *text, size_t length);

/* Reads text[begin .. end): a word, or else the lines of a file. False with a fault, whose sentence is empty
   where memory was refused; to be closed in both cases. The text outlives it. `decimals` may be NULL. */
bool gm_written_open(struct gm_written_scheme *scheme, const char *text, size_t begin, size_t end,
                     struct gm_decimals *decimals, struct gm_fault *fault);
void gm_written_close(void *scheme); /* for arenas too */

/* The word that is read to the same scheme: title, order, claims, lets and coefficients in parentheses behind
   the kind. `schemes` are the words for the schemes that it names, by the word of their line. In memory of
   the arena, whose body runs. */
char *gm_written_word(struct gm_arena *arena, const struct gm_written_scheme *scheme, const char *title,
                      const char *const schemes[GM_SCHEME_WORDS]);

#endif
