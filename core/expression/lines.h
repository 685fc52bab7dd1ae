/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_EXPRESSION_LINES_H
#define GM_CORE_EXPRESSION_LINES_H

#include "core/expression/reader.h"

/* Texts of the form `word: value`, one a line; a line that begins with a blank goes on with the one before, and #
   begins a comment. */

/* Bytes of a text. */
struct gm_span {
    size_t begin, end;
};

struct gm_text_line {
    struct gm_span word, value; /* the value without blanks and comments around it */
};

/* The next line from *at on, which it moves behind it. False at the end, where the sentence is empty, and with a
   fault. */
bool gm_lines_next(const char *text, size_t length, size_t *at, struct gm_text_line *line,
                   struct gm_fault *fault);

/* Whether the whole text is UTF-8 without a byte 0, in lines that end with a newline; false with a fault. */
bool gm_lines_are_text(const char *text, size_t length, struct gm_fault *fault);

/* Without blanks around it; a comment is blank. */
struct gm_span gm_span_trimmed(const char *text, struct gm_span span);
/* The next separator outside of parentheses and brackets, or the end. */
size_t gm_span_until(const char *text, struct gm_span span, const char *separator);
/* Takes the piece before the next separator off the front, trimmed; false, and an empty piece, where nothing is
   left. */
bool gm_span_take(const char *text, struct gm_span *rest, const char *separator, struct gm_span *piece);
/* Which of some words, NULL behind the last, a span is; their number, if it is none of them. */
size_t gm_span_among(const char *text, struct gm_span span, const char *const *words);
/* Its words with one blank between them; malloc'ed, NULL: out of memory. */
char *gm_span_words(const char *text, struct gm_span span);

#endif
