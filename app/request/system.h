/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Systems that somebody wrote: where they are, and the scenes that are made of them. Sentences may have three
   lines: what is wrong, the text, a caret below the place. */
#ifndef GM_APP_REQUEST_SYSTEM_H
#define GM_APP_REQUEST_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>

struct gm_arguments;
struct gm_own_system;
struct gm_scene;
struct gm_system_value;

extern const char gm_system_typed[]; /* "system": what stands before a formula */

/* Whether a word means a system: a path that ends with .system, or the name of one in the folder of
   GEOMINT_SYSTEMS, else of those that the program brings, or in the user's own ($XDG_CONFIG_HOME/geomint, or
   ~/.config/geomint). Writes its path. */
bool gm_system_path(const char *word, char *path, size_t size);

/* Opens the system of a file. Returns 0, or an exit status with a sentence. To be closed in both cases. */
int gm_system_open(struct gm_own_system *system, const char *path, const struct gm_system_value *values,
                   size_t count, char *message);

/* The same of what words "system H=... key=value ..." say. */
int gm_system_open_typed(struct gm_own_system *system, int count, char *const words[], char *message);

/* Whether the first of some words means a system: one of a file, or `system` with a formula behind it; or a
   room of a file (app/request/room.h), which is opened the same way. */
bool gm_system_is(const char *word);
/* The keys that say, or replace, the formulas of some words whose first means a system, until NULL. */
const char *const *gm_system_keys(const char *word);
/* The scene of the system that words "NAME key=value ..." mean; a parameter that the equations are built on
   has the value that is given there, and formulas behind a file's name take the place of its own. It lives as
   long as the program, and the same words mean the same scene. NULL with a sentence, and then an exit
   status. */
const struct gm_scene *gm_system_scene(int count, char *const words[], int *status, char *message);

/* Where in some words something is wrong. */
struct gm_word_place {
    int word;      /* below 0: nowhere in them */
    size_t offset; /* in bytes */
};

/* A scene of words that are still being typed: nothing is kept of it, unless it was there before. */
struct gm_system_trial {
    const struct gm_scene *scene;
    int status; /* where there is none: an exit status, and a place */
    struct gm_word_place place;
    struct gm_made_system *made; /* its own */
};
/* False with a sentence. To be closed in both cases, before which it may be kept: from then on the same words
   mean this scene, as long as the program lives. */
bool gm_system_try(struct gm_system_trial *trial, int count, char *const words[], char *message);
void gm_system_trial_keep(struct gm_system_trial *trial);
void gm_system_trial_close(struct gm_system_trial *trial);

/* The text of a system's scene with these values of its parameters and its start; malloc'ed, NULL: no
   memory. */
char *gm_system_text(const struct gm_scene *scene, const void *parameters);

/* The formulas of a text as words, "H=p^2/2", as they take the place of its own behind the file's name: H, L,
   rate= and bracket=. False: no memory. */
bool gm_system_formulas(const char *text, struct gm_arguments *words);

/* From now on that word means this text, and no file: as where a picture tells how it was made. False: no
   memory. */
bool gm_system_recall(const char *word, const char *text);

/* Calls `each` for the names of the systems there are. */
void gm_system_each(void (*each)(const char *name, const void *data), const void *data);

/* Of the names of scenes and systems the one that is nearest to a word, written to `near`; NULL: none is
   near. */
enum { GM_NEAR = 64 };
const char *gm_system_near(const char *word, char near[GM_NEAR]);

#endif
