/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MODEL_CHOICES_H
#define GM_CORE_MODEL_CHOICES_H

#include "core/arena.h"
#include "core/expression/lines.h"

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
