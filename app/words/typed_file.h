/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The text of a system, as words of a command line write it or replace its formulas. */
#ifndef GM_APP_WORDS_TYPED_FILE_H
#define GM_APP_WORDS_TYPED_FILE_H

#include <stdbool.h>

#include "app/base/files.h"

struct gm_arena;
struct gm_arguments;
struct gm_fault;

/* Bytes of the text from `begin` on: a word's from `value` on, or, with word 0, the file's; with word -1
   the program's. */
struct gm_text_part {
    size_t begin, value, length;
    struct gm_word_place from;
};

struct gm_typed_file { /* {0} is an empty text */
    const char *path;  /* NULL: only words */
    char *source;      /* the file's text; malloc'ed */
    size_t size;
    int count;
    char *const *words; /* "NAME key=value ..." */
    char *text;         /* the text with the lines of the words */
    size_t length;
    struct gm_text_part *parts;
    size_t part_count;
    const char *missing; /* a sentence about names without a value; NULL */
    struct gm_word_place missing_place;
    struct gm_arena *arena;
};
void gm_typed_file_close(struct gm_typed_file *file);

/* Keys without a file: H L rate part coordinates momenta; and those that replace a line: H L V rate bracket S K-matrix
   L-matrix let part mesh. NULL-terminated. */
extern const char *const gm_typed_keys[], *const gm_replacing_keys[];

/* The one of gm_replacing_keys that a word sets; or NULL. */
const char *gm_replacing_key(const char *word);
/* Returns true if a word sets H, L or rate. */
bool gm_typed_is_formula(const char *word);
/* The value of a word that sets this key; NULL if it sets another one. */
const char *gm_word_after(const char *word, const char *key);

/* Writes the text that "system H=... key=value ..." means: the default coordinates are q, or q1, q2 and so
   on, names of the state have their values at the start, others are parameters. Returns false with a
   sentence and, if possible, a place. */
bool gm_typed_file_write(struct gm_typed_file *file, struct gm_word_place *place, char *message);
/* Writes the file's text with the typed formulas instead of its own. Returns false with a sentence. */
bool gm_typed_file_replace(struct gm_typed_file *file, char *message);
/* Returns true if word number `word` is one of the lines. */
bool gm_typed_file_has(const struct gm_typed_file *file, int word);

/* Reports a fault of the text, or, if no word is at fault, what is missing, and sets `place` if it is in one
   of the words. Returns an exit status. */
int gm_typed_file_fault(const struct gm_typed_file *file, const struct gm_fault *fault,
                        struct gm_word_place *place, char *message);

/* The formulas of a text as words that would replace them, "H=p^2/2". Returns false when out of memory. */
bool gm_typed_file_formulas(const char *text, struct gm_arguments *words);

#endif
