/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_SYSTEM_H
#define GM_APP_WORDS_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>

#include "app/base/files.h"

/* The scenes of user-defined systems and rooms. Sentences may have three lines: the fault, the text, and a
   caret below the place. */

struct gm_arguments;
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
/* The scene that the words "NAME key=value ..." begin with, unless one of them replaces a line of its file: the words
   then mean a scene of their own. */
const struct gm_scene *gm_scene_of_words(int count, char *const words[]);
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

/* The text of a system's scene with these values of its parameters and its start, and with this scheme first, unless it
   is NULL; malloc'ed, NULL: no memory. */
char *gm_system_now(const struct gm_scene *scene, const void *parameters, const char *scheme);

#endif
