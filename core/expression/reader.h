/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reader of formulas: text to graph. */
#ifndef GM_CORE_EXPRESSION_READER_H
#define GM_CORE_EXPRESSION_READER_H

#include <string.h>

#include "core/expression/graph.h"

/* Operators by their priority: + and -, * and /, minus before an operand, ^, which binds to the right and may
   be followed by a sign: -x^2 is -(x^2), 2^-1 is 1/2. Numbers are decimals and pi; functions are the rows of
   operations.def; sum(i = 1 .. N, j = i+1 .. N, term) and prod(...) run over the names of lists, q[i]. An
   index is computed while reading: it may hold whole numbers, indices of the loops around it, and names with
   a value in the scope. */

enum {
    GM_FAULT_SENTENCE = 320,
    GM_MOST_INDICES = 8,
    GM_MOST_ARGUMENTS = 8,
    GM_MOST_OPERANDS = 4, /* of a name that the scope calls */
    GM_LARGEST_INDEX = 1000000000
};

/* A fault, with places in bytes from the start of the text. */
struct gm_fault {
    size_t offset, earlier; /* offset of the fault, and of an earlier definition; 0: none */
    char sentence[GM_FAULT_SENTENCE];
};
/* Writes a fault. Returns false. */
__attribute__((format(printf, 3, 4))) bool gm_fail(struct gm_fault *fault, size_t offset, const char *format,
                                                   ...);

/* A name in a formula. */
struct gm_name {
    const char *text;
    size_t length;
    bool indexed;
    long index;   /* index in NAME[index] */
    bool initial; /* the form NAME(0) */
    bool exact;   /* the form exact(NAME) */
    bool fixed;   /* part of an index or a bound: must be a constant */
};

enum gm_meaning {
    GM_UNKNOWN, /* reported by the reader, with the nearest known name */
    GM_KNOWN,
    GM_REFUSED,  /* `sentence` is the reason */
    GM_POSTPONED /* must be read before: the reader stops, without a sentence */
};

/* An index of a loop, with its value in this round. */
struct gm_index {
    const char *text;
    size_t length;
    long value;
};

/* Bytes of a text. */
struct gm_span {
    size_t begin, end;
};

/* A function of the text, NAME(arguments) = body. A call reads the body, and in it an argument reads the
   operand, so that a call makes the nodes of the body written out, in the same order. */
struct gm_definition {
    struct gm_span name, arguments[GM_MOST_ARGUMENTS], body;
    size_t count;
    int64_t least; /* operands that its body has at least; 0: not counted yet */
    bool called;
};

/* The names that a formula may hold. */
struct gm_scope {
    enum gm_meaning (*find)(void *data, const struct gm_name *name, gm_node_id *node, char *sentence);
    /* name i, for proposals; NULL after the last */
    const char *(*known)(size_t i, const void *data);
    /* node for the decimal text[0 .. length) with its value; NULL: a constant */
    gm_node_id (*decimal)(void *data, const char *text, size_t length, double value);
    /* the function of that name, or NULL; the hook may be NULL */
    struct gm_definition *(*definition)(void *data, const char *name, size_t length);
    /* Names that are called with formulas, NAME(a, b): false for others; `call` makes the node. NULL: none. */
    bool (*calls)(const void *data, const struct gm_name *name);
    /* makes the node of a word that is the first operand of what is called; false: it is a formula; NULL: always */
    bool (*word)(void *data, const struct gm_name *called, const struct gm_name *word, gm_node_id *node);
    enum gm_meaning (*call)(void *data, const struct gm_name *name, const gm_node_id *operands, size_t count,
                            gm_node_id *node, char *sentence);
    void *data;
    bool lines;                               /* newlines and comments, # to the end of a line, are blanks */
    bool initial;                             /* NAME(0) has a meaning */
    bool exact;                               /* exact(NAME) has a meaning */
    bool is_condition;                        /* the whole text is a condition: its node is 1 or 0 */
    bool derives;                             /* `below` is a function: for partial derivatives */
    struct gm_index indices[GM_MOST_INDICES]; /* indices that the caller has bound */
    size_t index_count;
};

/* Reads all of text[begin .. end) into the graph. False with a fault; its sentence is empty if a name was
   postponed, or when out of memory (graph->failed). */
bool gm_formula_read(struct gm_formula *graph, const char *text, size_t begin, size_t end,
                     const struct gm_scope *scope, gm_node_id *node, struct gm_fault *fault);

/* Reads the body of a function that no formula calls, for its faults: its arguments are unknown numbers. An index
   that holds one ends the reading, without a fault. */
bool gm_formula_check(struct gm_formula *graph, const char *text, struct gm_definition *definition,
                      const struct gm_scope *scope, struct gm_fault *fault);

/* True if a name is a function, sum, prod or pi. */
bool gm_formula_reserves(const char *text, size_t length);
/* True for a name that other programs give to random numbers. */
#define GM_NO_NOISE "the equations are deterministic; noise is not known"
bool gm_is_random(const char *word);
bool gm_is_letter(char character); /* a letter or _ begins a name */
/* The length in bytes of the name at text[0 .. length); 0: none begins there. */
size_t gm_name_length(const char *text, size_t length);
/* True if two texts of these lengths are the same. */
static inline bool gm_text_same(const char *a, size_t length, const char *b, size_t other)
{
    return length == other && memcmp(a, b, length) == 0;
}
/* The letters of a name that a sentence shows. */
static inline int gm_brief_length(size_t length)
{
    return length < 60 ? (int)length : 60;
}
/* True if a word ends like this and is longer, as the path of such a file. */
bool gm_word_ends(const char *word, const char *ending);

/* The first byte that is not UTF-8, or a NUL; `length` without one. */
size_t gm_text_valid(const char *text, size_t length);
/* True if the text begins with the byte order mark of UTF-8, which some editors write. It has no meaning. */
enum { GM_TEXT_MARK = 3 };
bool gm_text_has_mark(const char *text, size_t length);
/* The line and column of a byte, from 1; columns are characters. */
void gm_text_place(const char *text, size_t offset, size_t *line, size_t *column);

#endif
