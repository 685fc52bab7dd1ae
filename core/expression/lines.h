/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_EXPRESSION_LINES_H
#define GM_CORE_EXPRESSION_LINES_H

#include "core/expression/reader.h"

/* Texts of the form `word: value`, one per line; a line that begins with a blank continues the last one, and
   # begins a comment. */

/* Bytes of a text. */
struct gm_span {
    size_t begin, end;
};

struct gm_text_line {
    struct gm_span word, value; /* the value without surrounding blanks and comments */
};

/* Reads the next line from *at, and moves *at past it. False at the end, with an empty sentence, and with a
   fault. */
bool gm_lines_next(const char *text, size_t length, size_t *at, struct gm_text_line *line,
                   struct gm_fault *fault);

/* True if the whole text is UTF-8 without a byte 0, in lines that end with a newline; false with a fault. */
bool gm_lines_are_text(const char *text, size_t length, struct gm_fault *fault);

/* The span without blanks and comments around it. */
struct gm_span gm_span_trimmed(const char *text, struct gm_span span);
/* The offset of the next separator outside of parentheses and brackets, or the end. */
size_t gm_span_until(const char *text, struct gm_span span, const char *separator);
/* Takes the piece before the next separator off the front, trimmed; false, and an empty piece, if the rest is
   empty. */
bool gm_span_take(const char *text, struct gm_span *rest, const char *separator, struct gm_span *piece);
/* The index of the span in a list of words that ends with NULL, or the list's length. */
size_t gm_span_among(const char *text, struct gm_span span, const char *const *words);
/* The words with one blank between them. The caller frees; NULL when out of memory. */
char *gm_span_words(const char *text, struct gm_span span);

#endif
