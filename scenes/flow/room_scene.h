/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_FLOW_ROOM_SCENE_H
#define GM_SCENES_FLOW_ROOM_SCENE_H

#include "core/arena.h"
#include "core/flow/room.h"
#include "render/picture/picture.h"
#include "scenes/common/system/variants.h"

/* The scene of a room, which solves, in the plane,
       omega_t + u . grad omega = nu Laplace omega,   omega = -Laplace psi,   u = (psi_y, -psi_x)
       theta_t + u . grad theta = kappa Laplace theta
   by discrete exterior calculus (core/flow/flow.h), whose velocity is divergence-free to round-off. */

enum gm_flows_show {
    GM_SHOW_SCALAR,
    GM_SHOW_VORTICITY,
    GM_SHOW_SPEED,
    GM_SHOW_PRESSURE,
    GM_SHOW_NONE,
    GM_SHOW_PROFILES,
    GM_SHOW_CONVERGENCE,
    GM_SHOW_DIVERGENCE,
    GM_SHOW_TEMPERATURE, /* only if heat is carried */
};

enum {
    GM_FLOWS_OWN = 8,  /* most parameters, or choices, of a single file */
    GM_ROOM_ROWS = 40, /* all known rows, and as many as a room can define */
    GM_ROOM_OBSERVED = GM_MOST_OBSERVABLES,
    GM_ROOM_UNIT = 96, /* bytes of a unit */
};

/* The parameters of a lane; a room's table has rows for some. */
struct gm_flows {
    struct gm_timing timing;
    double reynolds, schmidt, viscosity, irregular, own[GM_FLOWS_OWN];
    long rows, columns, tracers, refine;
    char mesh[GM_TEXT_SIZE], inlet[GM_TEXT_SIZE], outlet[GM_TEXT_SIZE], lid[GM_TEXT_SIZE];
    int show, streamlines, arrows, grid, star, smoke, choices[GM_FLOWS_OWN];
    const struct gm_user_room *room;
};

extern const char *const gm_flows_stars[];
/* The possible words of the parameter `outlet`, NULL-terminated. */
extern const char *const gm_flows_outlets[];

/* The subject of an observable of a room. */
struct gm_room_subject {
    const struct gm_room_row *row; /* of an observable that is not of a line or a hole */
    const char *name;              /* the name of a line; NULL: the number is used */
    size_t number;                 /* the number of a hole */
    const struct gm_system_item *profile;
    int what; /* the quantity of the subject (enum local, user_room.c) */
};

struct gm_user_room {
    struct gm_system_scene
        of_file;         /* first: the scene is its first member; its origin has no path if it is built in */
    struct gm_room room; /* the room with its parameters at their defaults */
    struct gm_flows initial;
    const char *mesh;
    const struct gm_built_in *inside; /* the mesh; NULL: it is the file at `mesh` */
    struct gm_room_subject subjects[GM_ROOM_OBSERVED];
    const char *forces
        [2]; /* keys of the forces on the first hole, shown by a room without a scalar; NULL: not shown */
};

static inline const struct gm_user_room *gm_user_room_of(const void *parameters)
{
    return ((const struct gm_flows *)parameters)->room;
}

/* Returns the subject of the observable that a view evaluates. */
static inline const struct gm_room_subject *gm_room_subject_of(const struct gm_view *view)
{
    const struct gm_user_room *user_room = gm_user_room_of(view->parameters);
    return &user_room->subjects[view->observable - user_room->of_file.observables];
}

/* Returns the room of a lane, with its parameters. */
static inline const struct gm_room *gm_room_of(const struct gm_problem *problem)
{
    return gm_flow_of(problem)->given_by;
}

/* Adds an observable, whose subject is this one, while the scene is made. */
void gm_room_observe(struct gm_user_room *user_room, struct gm_observable row,
                     struct gm_room_subject subject);
/* Reads the lines other than the boundary, while the scene is made in its arena. */
void gm_room_take_lines(struct gm_user_room *user_room);
/* Writes rows of CSV: published points, and profiles. */
void gm_room_write_profiles(const struct gm_view *view, const char *front, FILE *stream);
void gm_room_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

/* Powers of the units of length, time and temperature. */
struct gm_powers {
    int of[3];
};
/* Writes a product of powers of the units in the line `units:`, "K m²/s", to GM_ROOM_UNIT bytes; "" if one of them is not
   named. */
const char *gm_room_unit(const struct gm_user_room *user_room, struct gm_powers powers, char *name);
/* Writes " / (m/s)", the unit after a title, to GM_ROOM_UNIT + 8 bytes. */
const char *gm_room_beside_unit(const struct gm_user_room *user_room, struct gm_powers powers, char *text);
/* A row of an observable of flows. */
struct gm_room_row {
    struct gm_observable observable;
    double (*measure)(const struct gm_flow *flow, const double *y); /* its value, if it is a measure */
    const char *of_scalar;                                          /* its title before the scalar's name */
    struct gm_powers powers;                                        /* of its unit */
    bool along;                                                     /* of a profile */
};
/* The rows; those from GM_ROOM_COMMON on are observed of every room, the last one with heat. */
enum { GM_ROOM_COMMON = 13, GM_ROOM_KINDS = 26 };
extern const struct gm_room_row gm_room_rows[GM_ROOM_KINDS];
/* Returns the exact value at a point; NAN if it is not known. */
double gm_room_exact(const struct gm_view *view, enum gm_room_key key, const double at[2]);

/* The value and the key of a quantity: u, v or s (the scalar). */
static inline double gm_room_quantity(const struct gm_sample *sample, char quantity)
{
    return quantity == 'u' ? sample->u : quantity == 'v' ? sample->v : sample->theta;
}
static inline enum gm_room_key gm_room_key_of(char quantity)
{
    return quantity == 'u' ? GM_ROOM_SPEED_X : quantity == 'v' ? GM_ROOM_SPEED_Y : GM_ROOM_SCALAR;
}

/* The look of the field of a flow. */
struct gm_look {
    const char *axes[2];   /* labels of x and y of the field, if one lane is shown; NULL: none are drawn */
    double scalar_high;    /* the scalar's range */
    double temperature[2]; /* the range of the temperature */
    const char *names[GM_SHOW_TEMPERATURE + 1]; /* labels of the colours */
    double vorticity_range;                     /* the end of the colours */
    double speed_high;
    const char *const *sides; /* names of openings, by the number of their side; NULL: "inlet", "outlet" */
    const double *levels;     /* levels of psi; NULL: they are chosen by the flow through */
    size_t level_count;
};

/* Adds a panel of each lane, all with the same colours; `graphs`: graphs have the lanes' colours. */
void gm_flow_draw_fields(struct gm_picture *picture, const struct gm_lane *const *lanes, size_t count,
                         const struct gm_look *look, bool graphs);

/* Draws a panel for each quantity of the profiles, the exact one broad and grey, published points in red. */
void gm_room_draw_profiles(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture,
                           enum gm_place place);

#endif
