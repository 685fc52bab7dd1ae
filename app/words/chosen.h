/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_WORDS_CHOSEN_H
#define GM_APP_WORDS_CHOSEN_H

#include "scenes/common/scene.h"

/* Observables that were asked for, by their numbers (gm_scene_observable_at), in the order in which they
   were. */
struct gm_chosen {
    size_t *numbers;
    size_t count;
};

/* Those of these keys, "KEY,KEY"; NULL: all that a scene tells unasked. False with a sentence. To be closed
   in both cases. */
bool gm_chosen_open(struct gm_chosen *chosen, const struct gm_scene *scene, const char *keys, char *message);
void gm_chosen_close(struct gm_chosen *chosen);

/* Refuses an observable that is not there, with the nearest that is. Returns false. */
bool gm_chosen_refuse(const struct gm_scene *scene, const char *key, char *message);

#endif
