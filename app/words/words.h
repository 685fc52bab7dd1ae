/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_WORDS_H
#define GM_APP_WORDS_WORDS_H

#include <stdbool.h>
#include <stddef.h>

#include "app/base/arguments.h"
#include "scenes/common/scene.h"

/* Values between two ends, both included: "0..0.9:10" evenly, "1e-4..1e-1:log7" by equal factors. */

struct gm_range {
    double first, last; /* first < last; for equal factors both have one sign */
    size_t count;       /* number of values, at least 2, at most 1e15 */
    bool logarithmic;
};

/* The length, in bytes, of the first value or range of a list; the sum in sum(i = 1 .. 3, q[i]) is one
   value. */
size_t gm_word_first(const char *value);

/* The words after a scene's name: keys with lists of values, and the choice of lane k among them. */

enum { GM_MOST_WORDS = 32, GM_MOST_PIECES = 64, GM_MOST_REQUESTED = 64 };

/* A piece between two commas: a value, or a range of values. */
struct gm_word_piece {
    const char *text;
    struct gm_range range; /* count 0: none */
};

struct gm_word {
    const char *key;
    struct gm_word_piece pieces[GM_MOST_PIECES];
    size_t piece_count;
    size_t count; /* number of values */
};

struct gm_words {
    struct gm_word list[GM_MOST_WORDS];
    size_t count;
    bool zip;
    char refused[48];       /* the last key that was read, if the words were refused */
    struct gm_arena *arena; /* the texts */
};

/* The keys that every scene has beside its parameters and its schemes'. */
struct gm_common_key {
    const char *name, *value, *help;
    const char *choices[3]; /* NULL-terminated; none: any value */
};
extern const struct gm_common_key gm_common_keys[];
extern const size_t gm_common_key_count;
/* The key with that name, or NULL. */
const struct gm_common_key *gm_common_key_find(const char *name);

/* Reads `count` words "key=value,value" for a scene; without scheme= its first `schemes` preferred ones
   are added. Returns false with a sentence (GM_MESSAGE bytes). The caller closes it in both cases. */
bool gm_words_read(struct gm_words *words, const struct gm_scene *scene, int count, char *const typed[],
                   size_t schemes, char *message);
void gm_words_close(struct gm_words *words);

/* Writes "; did you mean KEY=VALUE" for a word that is a key, or what people call it, or a scheme; else "". */
void gm_words_assignment(const struct gm_scene *scene, const char *key, const char *value, char *text,
                         size_t size);

/* Fills an empty list with a scene's words, "SCENE key=value": the typed words, and those of the text
   `usual` that they neither replace nor disable. Returns false when out of memory. */
bool gm_words_complete(struct gm_arguments *words, const struct gm_scene *scene,
                       const struct gm_arguments *typed, const char *usual);

/* The parameter with that key, of the scene or of schemes, or NULL. */
const struct gm_parameter *gm_word_parameter(const struct gm_scene *scene, const char *key);
/* Returns true if the values of a key are numbers. */
bool gm_word_is_number(const struct gm_scene *scene, const char *key);

/* The word with that key, or NULL. */
const struct gm_word *gm_words_find(const struct gm_words *words, const char *key);

/* Value `index` of a list: as typed, or, for a range, written to `text` (GM_TEXT_SIZE bytes) as it would
   be typed. */
const char *gm_word_value(const struct gm_word *list, size_t index, char *text);
/* The same as a name of it: a value of a range with 6 digits. */
const char *gm_word_name(const struct gm_word *list, size_t index, char *text);

/* Returns true if a common key with choices has the second one: yes, cost. */
bool gm_words_chosen(const struct gm_words *words, const char *key);

/* Returns true if piece `index` of a list and the one before it (for the first: after it) are probably one
   number with a comma as its decimal mark: 0,5 or 1,05. Writes it with a point. */
bool gm_words_decimal_comma(const struct gm_word *list, size_t index, char *number, size_t size);
#define GM_DECIMAL_POINT "the decimal mark is a point (%s), a comma separates the values of a list"

/* Counts the runs: the product of the lists' lengths, or their length with zip. Returns false with a
   sentence, also if there are more than `most`. */
bool gm_words_count(const struct gm_words *words, size_t most, size_t *count, char *message);

/* The index of run `lane`'s value in list i. The first list changes slowest. */
size_t gm_words_choice(const struct gm_words *words, size_t i, size_t lane);

/* "SCENE key=value ..."; malloc'ed. Returns NULL when out of memory. */
char *gm_words_join(const struct gm_scene *scene, const struct gm_words *words);

#endif
