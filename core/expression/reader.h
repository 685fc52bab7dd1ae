/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Formulas as people type them: text to graph. */
#ifndef GM_CORE_EXPRESSION_READER_H
#define GM_CORE_EXPRESSION_READER_H

#include "core/expression/graph.h"

/* Operators by their priority: + and -, * and /, minus before an operand, ^, which binds to the right and may
   have a sign behind it: -x^2 is -(x^2), 2^-1 is 1/2. Numbers are decimals and pi; functions are the rows of
   operations.def; sum(i = 1 .. N, j = i+1 .. N, term) and prod(...) run over the names of lists, q[i]. An
   index is computed while reading: it may hold whole numbers, the indices of the loops around it, and what
   the scope knows the value of. */

enum { GM_FAULT_SENTENCE = 320, GM_MOST_INDICES = 8, GM_LARGEST_INDEX = 1000000000 };

/* What is wrong, and where: bytes from the beginning of the text. */
struct gm_fault {
    size_t offset, earlier; /* where the same was said before; 0: it was not */
    char sentence[GM_FAULT_SENTENCE];
};
/* Says what is wrong, and where. Returns false. */
__attribute__((format(printf, 3, 4))) bool gm_fail(struct gm_fault *fault, size_t offset, const char *format,
                                                   ...);

/* The first thing that is wrong with a text; what follows from it is not told. */
struct gm_first_fault {
    struct gm_fault *fault;
    bool failed, no_memory;
};
/* As gm_fail, once. */
__attribute__((format(printf, 3, 4))) bool gm_fail_first(struct gm_first_fault *first, size_t offset,
                                                         const char *format, ...);
/* Memory was refused: a fault without a sentence, unless another one came first. Returns false. */
bool gm_fail_memory(struct gm_first_fault *first);

/* A name as it is used. */
struct gm_name {
    const char *text;
    size_t length;
    bool indexed;
    long index;   /* NAME[index] */
    bool initial; /* NAME(0) */
    bool exact;   /* exact(NAME) */
    bool fixed;   /* it stands in an index or a bound: its value is wanted, as a constant */
};

enum gm_meaning {
    GM_UNKNOWN, /* the reader says so, with the nearest name that is known */
    GM_KNOWN,
    GM_REFUSED,  /* `sentence` says why */
    GM_POSTPONED /* it has to be read before: the reader stops, without a sentence */
};

/* An index of a loop, and its value now. */
struct gm_index {
    const char *text;
    size_t length;
    long value;
};

/* The names that a formula may hold. */
struct gm_scope {
    enum gm_meaning (*find)(void *data, const struct gm_name *name, gm_node_id *node, char *sentence);
    /* for proposals: name i, NULL behind the last */
    const char *(*known)(size_t i, const void *data);
    /* What a decimal stands for, text[0 .. length) with its value; NULL: a constant. */
    gm_node_id (*decimal)(void *data, const char *text, size_t length, double value);
    void *data;
    bool lines;   /* newlines and comments, from # to the end of a line, are blanks */
    bool initial; /* NAME(0) has a meaning */
    bool exact;   /* exact(NAME) has one */
    bool derives; /* `below` is a function: for partial derivatives */
    struct gm_index indices[GM_MOST_INDICES]; /* bound by the caller */
    size_t index_count;
};

/* Reads text[begin .. end), all of it, into the graph. False with a fault, whose sentence is empty where a
   name was postponed or memory was refused (graph->failed). */
bool gm_formula_read(struct gm_formula *graph, const char *text, size_t begin, size_t end,
                     const struct gm_scope *scope, gm_node_id *node, struct gm_fault *fault);

/* Whether a name is that of a function, of sum, prod or pi. */
bool gm_formula_reserves(const char *text, size_t length);
bool gm_is_letter(char character); /* may begin a name: letters and _ */
/* How many bytes the name at text[0 .. length) has; 0: none begins there. */
size_t gm_name_length(const char *text, size_t length);
/* Whether a word ends so, and is more than that: the path of a file of that kind. */
bool gm_word_ends(const char *word, const char *ending);

/* The first byte that is no UTF-8, or a NUL; `length` if there is none. */
size_t gm_text_valid(const char *text, size_t length);
/* Whether the text begins with the mark of UTF-8 that some editors write, of so many bytes: it says
   nothing. */
enum { GM_TEXT_MARK = 3 };
bool gm_text_has_mark(const char *text, size_t length);
/* Line and column, from 1, in characters, of a byte. */
void gm_text_place(const char *text, size_t offset, size_t *line, size_t *column);

#endif
