/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_SYSTEM_H
#define GM_APP_WORDS_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>

#include "app/base/files.h"

/* The scenes of user-defined systems and rooms. Sentences may have three lines: the fault, the text, and a
   caret below the place. */

struct gm_arena;
struct gm_arguments;
struct gm_fault;
struct gm_file;
struct gm_user_system;
struct gm_scene;
struct gm_system_value;

extern const char gm_system_typed[]; /* "system": the word before a formula */

/* Opens the system of a file, or without one, of the words "system H=... key=value ...". Returns 0, or an
   exit status with a sentence. The caller closes it in both cases. */
int gm_system_open(struct gm_user_system *system, const struct gm_file *file,
                   const struct gm_arguments *arguments, const struct gm_system_value *values, size_t count,
                   char *message);

/* Returns true if the first word means a system: a file's, or `system` with a formula after it; or a room
   of a file, which is opened the same way. */
bool gm_system_is(const char *word);
/* The scene of that name, in any letter case if no file has the name; or NULL. */
const struct gm_scene *gm_scene_called(const char *word);
/* The keys of formulas that a system's words may set or replace, until NULL; `word` is the first of these
   words. */
const char *const *gm_system_keys(const char *word);
/* The scene of the system or room of the words "NAME key=value ...". Parameters on which the equations are
   built have the given values, and typed formulas replace those of the file. The scene lives as long as
   the program, and the same words give the same scene. Returns NULL with a sentence and an exit status. */
const struct gm_scene *gm_system_scene(int count, char *const words[], int *status, char *message);

/* A scene of words during typing: it is discarded, unless it existed before. */
struct gm_system_trial {
    const struct gm_scene *scene;
    int status; /* the exit status if there is no scene */
    struct gm_word_place place;
    struct gm_made_system *made; /* the trial's scene */
};
/* Returns false with a sentence. The caller closes it in both cases, and may store it before: from then on
   the same words mean this scene, as long as the program lives. */
bool gm_system_try(struct gm_system_trial *trial, int count, char *const words[], char *message);
void gm_system_trial_keep(struct gm_system_trial *trial);
void gm_system_trial_close(struct gm_system_trial *trial);

/* From now on the word means this text instead of a file, for a picture that stores its system. Returns
   false when out of memory. */
bool gm_system_recall(const char *word, const char *text);

/* The text of a system's scene with these values of its parameters and its start; malloc'ed, NULL: no
   memory. */
char *gm_system_now(const struct gm_scene *scene, const void *parameters);

/* The text of a system, as words of a command line write it or replace its formulas. */

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
   L-matrix let mesh. NULL-terminated. */
extern const char *const gm_typed_keys[], *const gm_replacing_keys[];

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
