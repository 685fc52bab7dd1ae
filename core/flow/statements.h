/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_STATEMENTS_H
#define GM_CORE_FLOW_STATEMENTS_H

#include "core/flow/names.h"

/* The lines of a room that say something between semicolons, `word: head; option value; ...`, checked by the table
   core/flow/statements.def. */

enum { GM_ROOM_KEPT = 4 }; /* the most vertices that a rectangle keeps where they are */

enum gm_statement_word {
#define GM_STATEMENT(constant, ...) GM_LINE_##constant,
#define GM_PIECE(...)
#include "core/flow/statements.def"
#undef GM_STATEMENT
#undef GM_PIECE
    GM_LINES
};
enum gm_statement_row {
#define GM_STATEMENT(...)
#define GM_PIECE(line, constant, ...) GM_LINE_##line##_##constant,
#include "core/flow/statements.def"
#undef GM_STATEMENT
#undef GM_PIECE
    GM_ROWS_OF_LINES /* also that of a head */
};

/* What stands between two semicolons, without its option's word. */
struct gm_piece {
    size_t row;
    struct gm_span span;
    char *text;
    double *numbers; /* NULL: it is no list of numbers, or one that needs the flow */
    size_t count;
};

struct gm_statement {
    enum gm_statement_word word;
    size_t place;            /* of its word */
    struct gm_piece *pieces; /* the head first */
    size_t count;
};

struct gm_statements {
    struct gm_statement *list;
    size_t count;
};

/* The line's word; GM_LINES: it is none of these. */
enum gm_statement_word gm_statement_word_of(const struct gm_room_names *names, struct gm_text_line line);
/* The two sides of a condition, x = 0, and the sign between them; '\0': there is none. */
char gm_condition_sign(const char *text, struct gm_span condition, struct gm_span sides[2]);
/* The word itself, NULL behind the last. */
const char *gm_statement_name(size_t word);
/* Between which the number of its head lies. */
struct gm_room_range gm_statement_range(enum gm_statement_word word);
/* Whether such lines say the same for every word of a choice. */
bool gm_statement_is_fixed(enum gm_statement_word word);
/* Adds what a line says. False with a fault. */
bool gm_statement_read(struct gm_statements *statements, struct gm_room_names *names,
                       enum gm_statement_word word, struct gm_text_line line, struct gm_fault *fault);
void gm_statements_close(struct gm_statements *statements);

/* Line number `number` of those with a word; NULL: there are fewer. */
const struct gm_statement *gm_statement(const struct gm_statements *statements, enum gm_statement_word word,
                                        size_t number);
/* A statement's piece; NULL: it has none, or there is no statement. */
const struct gm_piece *gm_statement_piece(const struct gm_statement *statement, enum gm_statement_row row);
/* The first number of that piece. */
double gm_statement_number(const struct gm_statement *statement, enum gm_statement_row row, double otherwise);
/* The text, and the first number, of the head of the first line with a word; NULL, and `otherwise`: there is none. */
const char *gm_statement_text(const struct gm_statements *statements, enum gm_statement_word word);
double gm_statement_value(const struct gm_statements *statements, enum gm_statement_word word,
                          double otherwise);

#endif
