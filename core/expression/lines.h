/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_EXPRESSION_LINES_H
#define GM_CORE_EXPRESSION_LINES_H

#include "core/arena.h"
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

/* Choices of a text, whose words decide which lines hold:
       choice: NAME = WORD of WORD, WORD; meaning
       when: NAME = WORD, WORD           the lines below hold for these words alone
       when: always                      the lines below hold for all words
   A line in such a block replaces the lines outside of blocks that begin with its word and, if lines of
   that word differ by names, share one of its names. */

enum { GM_MOST_CHOICES = 8, GM_MOST_CHOICE_WORDS = 16, GM_CHOICE_SIZE = 32 };

struct gm_written_choice {
    char name[GM_CHOICE_SIZE], words[GM_MOST_CHOICE_WORDS][GM_CHOICE_SIZE];
    size_t count, standard, chosen; /* number of words; indices of the default and the chosen one */
    struct gm_span meaning;
    size_t place; /* byte offset of the name */
};

struct gm_written_choices {
    struct gm_written_choice list[GM_MOST_CHOICES];
    size_t count;
};

/* Returns the choice of that name, or NULL. */
const struct gm_written_choice *gm_choice_named(const struct gm_written_choices *choices, const char *name);
/* Chooses a word. Returns false if there is no such choice or it lacks the word. */
bool gm_choices_take(struct gm_written_choices *choices, const char *name, const char *word);

/* A line of a file: its word, by its number, the place of that, and its value. */
struct gm_read_line {
    size_t word, place;
    struct gm_span value;
};

/* The lines of text[begin .. end) that hold. They are read in a body of the arena, which is left with a fault; its
   sentence is empty when out of memory. */
struct gm_read_lines {
    struct gm_arena *arena;
    struct gm_fault *fault;
    const struct gm_line_words *words;
    struct gm_written_choices *choices; /* NULL: such files have none */
    unsigned inside;                    /* kinds of which lines in blocks must have one */
    const char *text;
    struct gm_span span;
    struct gm_read_line *list;
    size_t count;
};
enum { GM_MOST_LINE_WORDS = 128 };
/* Reads the lines choice:, with their default words chosen. */
void gm_choices_read(const struct gm_read_lines *lines);
/* Reads the lines, but choice: and when:, and those that do not hold. Faults: a line whose word is none of these, a
   second one of a word with one line, a line without a value. */
void gm_lines_read(struct gm_read_lines *lines);

#endif
