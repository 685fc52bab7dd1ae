/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_NAMES_H
#define GM_APP_WORDS_NAMES_H

#include <stdbool.h>

#include "core/ode/user/scheme.h"
#include "scenes/common/lane.h"
#include "scenes/common/scene.h"

/* The largest number of schemes that fit a scene. */

enum { GM_FITTING_SCHEMES = 256 };

/* Adds a scheme, or NULL, to `*count` of them if it fits a problem, is not among them, and there are less than
   GM_FITTING_SCHEMES. */
void gm_fitting_add(const struct gm_scheme *scheme, const struct gm_problem *problem,
                    const struct gm_scheme **schemes, size_t *count);

/* The schemes that fit a scene at its defaults; returns their number, at most GM_FITTING_SCHEMES. */
size_t gm_fitting_schemes(const struct gm_scene *scene, const struct gm_scheme **schemes);
/* Writes for each of these schemes the one whose steps are the same there at its defaults, or NULL. */
void gm_fitting_same(const struct gm_scene *scene, const struct gm_scheme *const *schemes, size_t count,
                     const struct gm_scheme **same);

/* The same, followed by schemes for the scene's text on another kind of grid. */
size_t gm_fitting_elsewhere(const struct gm_scene *scene, const struct gm_scheme **schemes);

/* Returns true if at least one of these schemes has this parameter, a row of gm_settings_parameters. */
bool gm_fitting_take(const struct gm_scheme *const *schemes, size_t count, const struct gm_parameter *row);

/* Returns false for a parameter that the scene's system refuses to switch on, as a portrait without a plane. */
bool gm_row_is_offered(const struct gm_parameter *row);

/* Requested observables, by their numbers (gm_scene_observable_at), in the requested order. */
struct gm_chosen {
    size_t *numbers;
    size_t count;
};

/* Opens the observables with these keys, "KEY,KEY"; NULL: the scene's default ones. Returns false with a
   sentence. The caller closes it in both cases. */
bool gm_chosen_open(struct gm_chosen *chosen, const struct gm_scene *scene, const char *keys, char *message);
void gm_chosen_close(void *chosen);
/* Returns true if an observable on request is among them. Such observables follow the steps of a run, which must
   all have the same size. */
bool gm_chosen_follows_steps(const struct gm_chosen *chosen, const struct gm_scene *scene);
/* Returns true if all of them follow from the last state alone: a run needs no look at the states before. */
bool gm_chosen_are_of_the_end(const struct gm_chosen *chosen, const struct gm_scene *scene);

/* Refuses an observable that is not there, with the nearest that is. Returns false. */
bool gm_chosen_refuse(const struct gm_scene *scene, const char *key, char *message);

/* The meaning of words. */

/* The own name of the scheme that a word means for a scene; the word itself if it is a file or unknown. */
const char *gm_scheme_own_name(const struct gm_scene *scene, const char *word);

/* Refuses an unknown scheme, with what the word probably means. Returns false. */
bool gm_scheme_refuse(const struct gm_scene *scene, const char *word, char *message);
/* The same, where these schemes fit (NULL: all do); `otherwise` is the way out if the word means none of them. */
bool gm_scheme_refuse_among(const struct gm_scheme *const *fitting, size_t count, const char *word,
                            const char *otherwise, char *message);

/* Writes to `near` the name of a scene, a system or a room that is nearest to an unknown word, else those that
   contain it. Returns false if none is near; the message then names a folder of the environment that could
   not be opened, "" if all could. */
enum { GM_NEAR_NAMES = 256 };
bool gm_system_near(const char *word, char near[GM_NEAR_NAMES], char *message);

/* The scheme of a name, a path or a word. User-defined schemes are made at the first call and live as long
   as the program. Returns NULL with an empty message if there is no such scheme, else with a sentence and,
   on the next two lines, the place of the fault; `unreadable`: a file is the reason. */
const struct gm_scheme *gm_scheme_named(const char *name, bool *unreadable, char *message);

/* The same for a required scheme: NULL always comes with a sentence, which proposes the nearest name, and
   an exit status. */
const struct gm_scheme *gm_scheme_sought(const char *name, int *status, char *message);

/* The text of a user-defined scheme with decimals that satisfy its order conditions
   (core/ode/user/scheme.h). Returns NULL with a sentence, as gm_scheme_named. */
char *gm_scheme_polished(const char *name, struct gm_polish *polish, bool *unreadable, char *message);

/* A request's word from the file at this path: files after "scheme=" are relative to its folder.
   malloc'ed. Returns NULL when out of memory. */
char *gm_scheme_words_from(const char *path, const char *word);

/* Returns true if the name means a scheme; a word is not stored. Returns false with a sentence, and the
   byte of the fault. */
bool gm_scheme_check(const char *name, size_t *at, char *message);

#endif
