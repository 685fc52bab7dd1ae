/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The systems of one file: one for each of the words of its choices, and of the values of parameters that equations are
   built on. Their tables have the same rows, so that lanes of several are one scene. */
#ifndef GM_SCENES_COMMON_SYSTEM_VARIANTS_H
#define GM_SCENES_COMMON_SYSTEM_VARIANTS_H

#include "scenes/common/system/look.h"

/* The scene of a system while it is made. */
struct gm_system_making {
    struct gm_system_scene *scene; /* zeros, but for its arena, system, maker and origin */
    struct gm_fault *fault;        /* of the system's text; its sentence is "" at first */
    bool unread;                   /* a file that the system names could not be read */
    struct gm_problem problem;     /* of the file's own values: gm_system_open_problem */
};

/* A kind of systems, and how their scenes are made. */
struct gm_system_maker {
    size_t size;  /* of the scene, which begins with a struct gm_system_scene */
    bool rebuilt; /* parameters that equations are built on make other systems, as words of choices do */
    /* Makes the scene, in a body of its arena. */
    void (*make)(struct gm_system_making *making);
};
/* Makers of motions, fields, forms, and rooms; those read a text that was not read before (gm_room_unread). */
extern const struct gm_system_maker gm_system_motions, gm_system_fields, gm_system_forms, gm_system_rooms;

/* Fills what all scenes of files have: names, texts and rows. The title, blurb and time that are given are those of a
   file that has none. */
void gm_system_describe(struct gm_system_scene *system_scene, struct gm_scene scene);
/* Opens the problem of the file's own values, which lasts until the scene is made. */
void gm_system_open_problem(struct gm_system_making *making);

/* The failure of an opening: a fault of the text, or only a sentence. */
struct gm_system_opening {
    struct gm_fault *fault;
    char *sentence; /* GM_MESSAGE bytes */
    bool unread;    /* a file that the system names could not be read */
};

/* Makes the scene of a system opened by gm_equations_open, and takes it: the scene's end, or a failure here, closes it.
   Opens also the systems of all words of its choices, and gives all of them the same rows. Returns NULL on failure. */
const struct gm_scene *gm_system_scene_make(const struct gm_system_maker *maker,
                                            struct gm_user_system *system,
                                            const struct gm_system_origin *origin,
                                            struct gm_system_opening *opening);
/* The same with the maker of the system's kind. */
const struct gm_scene *gm_system_scene_open(struct gm_user_system *system,
                                            const struct gm_system_origin *origin,
                                            struct gm_system_opening *opening);
/* Closes the scene, and the other systems of its file. */
void gm_system_scene_close(const struct gm_scene *scene);

/* Returns why a key has no effect in a lane's system; NULL: it has one. */
const char *gm_system_idle(const void *parameters, const char *key);

#endif
