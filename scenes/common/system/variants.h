/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The systems of one file: one for each of the words of its choices, and of the values of parameters that equations are
   built on. Their tables have the same rows, so that lanes of several are one scene. */
#ifndef GM_SCENES_COMMON_SYSTEM_VARIANTS_H
#define GM_SCENES_COMMON_SYSTEM_VARIANTS_H

#include "scenes/common/system/look.h"

/* The functions that make and close a system. */
struct gm_system_maker {
    /* Makes the scene of the text with these values; NULL with a fault, or only a sentence. */
    struct gm_system_scene *(*make)(const struct gm_system_scene *first, const struct gm_system_value *values,
                                    size_t count, struct gm_fault *fault, char *sentence);
    void (*close)(const struct gm_scene *scene);
};

/* Makes the systems of all words of the choices, and gives all of them, and the first, the same rows. False
   with a fault, or only a sentence. */
bool gm_system_unite(struct gm_system_scene *first, const struct gm_system_maker *maker,
                     struct gm_fault *fault, char *sentence);
/* Gives a lane the system of its values. False with a sentence on failure. */
bool gm_system_choose(struct gm_system_lane *lane, const struct gm_system_maker *maker, char *sentence);

#endif
