/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_ROOM_SCENE_H
#define GM_SCENES_FLOW_ROOM_SCENE_H

#include "core/arena.h"
#include "core/flow/room.h"
#include "scenes/flow/flows.h"

/* A room's file; `word` is the word that named it, NULL if the room is one of the program's scenes. */
struct gm_room_file {
    const char *text;
    size_t length;
    const char *name, *word, *path;
    bool built_in;
};

/* The subject of an observable of a room. */
struct gm_room_subject {
    const char *name; /* the name of a line; NULL: the number is used */
    size_t number;    /* the number of a hole, or of a profile */
    int what;         /* the quantity of the subject (enum local, user_room.c) */
};

enum {
    GM_ROOM_ROWS = 40, /* all known rows, and as many as a room can define */
    GM_ROOM_OBSERVED = GM_MOST_OBSERVABLES,
    GM_ROOM_UNIT = 96, /* bytes of a unit */
};

/* A line along which quantities are drawn and written: u, v or s, the scalar. */
struct gm_room_profile {
    struct gm_profile line;
    const char *quantities,
        *label; /* the letters of the quantities; the label of values, NULL: the quantity's name */
    struct gm_room_range range; /* the range of that axis; NAN: the range of the values */
};

/* Published points on a profile: the position along its axis, and the first quantity there, or NAN. */
struct gm_room_table {
    const char *name;
    const struct gm_room_profile *profile;
    const struct gm_parameter *row; /* they hold if the row has that value; NULL: always */
    double value, *points;
    size_t count;
};

struct gm_user_room {
    struct gm_scene scene; /* first, so that a pointer to the scene is one to this */
    struct gm_arena *arena;
    struct gm_room_file file;
    struct gm_room room; /* the room with its parameters at their defaults */
    struct gm_flows initial;
    const char *mesh;
    const struct gm_built_in *inside; /* the mesh; NULL: it is the file at `mesh` */
    const char *words[2];
    struct gm_parameter rows[GM_ROOM_ROWS];
    struct gm_observable observables[GM_ROOM_OBSERVED];
    struct gm_room_subject subjects[GM_ROOM_OBSERVED];
    bool overfull;       /* the room has more observables than fit */
    const char *doubled; /* a key that two observables have; NULL: none */
    size_t observable_count;
    const char *forces
        [2]; /* keys of the forces on the first hole, shown by a room without a scalar; NULL: not shown */
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

/* Returns the room of a lane, with its parameters. */
static inline const struct gm_room *gm_room_of(const struct gm_problem *problem)
{
    return gm_flow_of(problem)->given_by;
}

/* Returns a part of a lane's text, for a picture. */
static inline const char *gm_room_text(struct gm_picture *picture, const struct gm_room *room,
                                       struct gm_span span)
{
    return gm_picture_text(picture, "%.*s", (int)(span.end - span.begin), room->text + span.begin);
}
#endif
