/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The systems of one file: one for each of the words of its choices, and of the values of parameters that equations are
   built on. Their tables have the same rows, so that lanes of several are one scene. */
#ifndef GM_SCENES_COMMON_SYSTEM_VARIANTS_H
#define GM_SCENES_COMMON_SYSTEM_VARIANTS_H

#include "scenes/common/system/look.h"

/* Opens the scene of a system, which it takes, beside the first one of a file; NULL with a sentence. */
typedef struct gm_system_scene *(*gm_system_opener)(struct gm_user_system *system,
                                                    const struct gm_system_scene *first, char *sentence);

/* Opens the other systems of a file, and takes a fault of its text, or only a sentence. */
struct gm_system_opening {
    gm_system_opener open;
    struct gm_fault *fault;
    char *sentence;
};

/* Opens the systems of all words of the choices, and gives all of them, and the first, the same rows; without an opener the
   first one is alone. Returns the scene of the first; NULL if that is NULL, or with a fault, or only a sentence, and then
   closes it. */
const struct gm_scene *gm_system_unite(struct gm_system_scene *first,
                                       const struct gm_system_opening *opening);
/* Gives a lane the system of its values. False with a sentence on failure. */
bool gm_system_choose(struct gm_system_lane *lane, gm_system_opener open, char *sentence);

#endif
