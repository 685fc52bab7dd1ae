/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text of a system as it is put together, line by line, and where each part of it came from. */
#ifndef GM_APP_WORDS_LINES_H
#define GM_APP_WORDS_LINES_H

#include <stddef.h>
#include <stdio.h>

#include "app/base/place.h"

struct gm_fault;
struct gm_file;

/* A system as lines: those of a file, of words, or of a file whose formulas words replace; what is wrong with
   them is told where somebody typed it. */

/* A part of the text that is one of some words: `length` bytes from `begin` on. */
struct gm_origin {
    size_t begin, length;
    int word;
    size_t offset; /* in the word */
};

struct gm_system_lines { /* {0} is an empty text */
    const char *path;    /* NULL: of words alone */
    char *text;          /* malloc'ed */
    size_t length;
    struct gm_origin *origins;
    size_t origin_count;
};
void gm_system_lines_close(struct gm_system_lines *written);

/* The whole of a file, or of one that is too large nothing but its length; NULL with a sentence. */
char *gm_system_lines_read(const struct gm_file *file, size_t *length, char *message);

/* Puts a piece of text, or of a word, from `offset` on, behind what `lines` has, which becomes the text. */
void gm_system_lines_put(struct gm_system_lines *written, FILE *lines, const char *text, size_t length);
void gm_system_lines_put_word(struct gm_system_lines *written, FILE *lines, char *const words[], int word,
                              size_t offset, size_t length);

/* Says what is wrong with the value of a word, KEY=value, at this byte of the word. */
void gm_system_word_fault(const char *word, size_t at, const char *sentence, char *message);
/* Says what is wrong with a text, with its place, which is written to `place` where it is in one of the words that
   parts were made of. Returns an exit status. */
int gm_system_lines_fault(const struct gm_system_lines *written, char *const words[],
                          const struct gm_fault *fault, struct gm_word_place *place, char *message);

/* Of a file's line, with those that go on it, the end, behind its newline. */
const char *gm_system_lines_end(const char *line);

/* The value of a word that sets this key; NULL if it sets another one. */
const char *gm_word_after(const char *word, const char *key, size_t length);
/* How long the first value of a list, or of a range, is. */
size_t gm_word_first(const char *value);

#endif
