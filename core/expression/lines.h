/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_EXPRESSION_LINES_H
#define GM_CORE_EXPRESSION_LINES_H

#include "core/expression/reader.h"

/* Texts of the form `word: value`, one per line; a line that begins with a blank continues the last one, also
   behind empty lines and comments, and # begins a comment. */

struct gm_text_line {
    struct gm_span word, value; /* the value without surrounding blanks and comments */
};

/* Reads the next line from *at, and moves *at past it. False at the end, with an empty sentence, and with a
   fault. */
bool gm_lines_next(const char *text, size_t length, size_t *at, struct gm_text_line *line,
                   struct gm_fault *fault);

/* The identity of lines with one word: one such line, lines that differ by names, or lines that are all
   added. */
enum gm_line_identity { GM_LINE_ONCE, GM_LINE_NAMED, GM_LINE_ADDED };

/* The words of the lines of a file. */
struct gm_line_words {
    const char *kind; /* "a room" */
    const struct gm_line_word {
        const char *word;
        enum gm_line_identity identity;
        unsigned kinds; /* 1 << kind, for each kind of such files that may have the line */
    } * list;
    size_t count;
    const char *help; /* follows "a room has no line "x"" if no word is near */
    unsigned kinds;   /* only words of one of these kinds are known; 0: all words are */
};
/* The index of a word in the list, or their number. */
size_t gm_line_word(const struct gm_line_words *words, const char *text, struct gm_span word);
/* Finds the word of a line. False with a fault: there is no such word, or the line has no value. */
bool gm_line_find(const struct gm_line_words *words, const char *text, const struct gm_text_line *line,
                  size_t *word, struct gm_fault *fault);

/* True if the whole text is UTF-8 without a byte 0, in lines that end with a newline; false with a fault. */
bool gm_lines_are_text(const char *text, size_t length, struct gm_fault *fault);

/* The span without blanks and comments around it. */
struct gm_span gm_span_trimmed(const char *text, struct gm_span span);
/* The offset of the next separator outside of parentheses and brackets, or the end. */
size_t gm_span_until(const char *text, struct gm_span span, const char *separator);
/* Takes the piece before the next separator off the front, trimmed; false, and an empty piece, if the rest is
   empty. */
bool gm_span_take(const char *text, struct gm_span *rest, const char *separator, struct gm_span *piece);
/* True if the span is that word. */
bool gm_span_is(const char *text, struct gm_span span, const char *word);
/* The index of the span in a list of words that ends with NULL, or the list's length. */
size_t gm_span_among(const char *text, struct gm_span span, const char *const *words);
/* The words with one blank between them. The caller frees; NULL when out of memory. */
char *gm_span_words(const char *text, struct gm_span span);

#endif
