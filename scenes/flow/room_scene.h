/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_ROOM_SCENE_H
#define GM_SCENES_FLOW_ROOM_SCENE_H

#include "core/arena.h"
#include "core/flow/room.h"
#include "scenes/flow/flows.h"

/* A room's file; `word` is what it was asked for by, NULL where the room is one of the program's scenes. */
struct gm_room_file {
    const char *text;
    size_t length;
    const char *name, *word, *path;
    bool built_in;
};

/* What an observable of a room looks at. */
struct gm_room_subject {
    const char *name; /* of a line; NULL: it is */
    size_t number;    /* of a hole, or of a profile */
    int what;         /* of that it is */
};

enum {
    GM_ROOM_ROWS = 40, /* all that are known, and as many as a room can have of its own */
    GM_ROOM_OBSERVED = GM_MOST_OBSERVABLES,
    GM_ROOM_UNIT = 96, /* bytes of one */
};

/* A line along which quantities are drawn, and written: u, v or s, the scalar. */
struct gm_room_profile {
    struct gm_profile line;
    const char *quantities,
        *label; /* as the letters say; label of the axis of values, NULL: the quantity's name */
    struct gm_room_range range; /* of that axis; NAN: that of the values */
};

/* Published points on a profile: where along its axis, and the first quantity there, which may be NAN. */
struct gm_room_table {
    const char *name;
    const struct gm_room_profile *profile;
    const struct gm_parameter *row; /* they hold where it has that value; NULL: always */
    double value, *points;
    size_t count;
};

struct gm_user_room {
    struct gm_scene scene; /* first: a scene is found to be this */
    struct gm_arena *arena;
    struct gm_room_file file;
    struct gm_fault *wrong; /* while it is made */
    struct gm_room room;    /* with its parameters at their defaults */
    struct gm_flows initial;
    const char *mesh;
    const struct gm_built_in *inside; /* the mesh; NULL: it is the file at `mesh` */
    const char *words[2];
    struct gm_parameter rows[GM_ROOM_ROWS];
    struct gm_observable observables[GM_ROOM_OBSERVED];
    struct gm_room_subject subjects[GM_ROOM_OBSERVED];
    bool overfull;       /* there are more */
    const char *doubled; /* a key that two of them have; NULL: none */
    size_t observable_count;
    const char *forces
        [2]; /* on the first hole: what a room shows where no scalar is brought; NULL: it is, or no hole */
    struct gm_room_profile *profiles;
    struct gm_room_table *tables;
    size_t profile_count, table_count;
    struct gm_work work;
    struct gm_stability stability;
};

static inline const struct gm_user_room *gm_user_room_of(const void *parameters)
{
    return ((const struct gm_flows *)parameters)->room;
}

/* The room of a lane, with its parameters. */
static inline const struct gm_room *gm_room_of(const struct gm_problem *problem)
{
    return gm_flow_of(problem)->given_by;
}

/* Texts that last as long as the scene: words of its file, and others. */
const char *gm_room_keep(struct gm_user_room *user_room, struct gm_span span);
__attribute__((format(printf, 2, 3))) char *gm_room_format(struct gm_user_room *user_room, const char *format,
                                                           ...);
/* A part of a lane's text, for a picture. */
const char *gm_room_text(struct gm_picture *picture, const struct gm_room *room, struct gm_span span);
/* Leaves the arena with what is wrong at a place of the file. */
_Noreturn void gm_room_refuse(struct gm_user_room *user_room, const struct gm_fault *fault);

#endif
