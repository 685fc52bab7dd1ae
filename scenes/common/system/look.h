/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene of a user-defined system, and the sights of its state. */
#ifndef GM_SCENES_COMMON_SYSTEM_LOOK_H
#define GM_SCENES_COMMON_SYSTEM_LOOK_H

#include <stdint.h>

#include "core/ode/user/problem.h"
#include "core/tape.h"
#include "scenes/common/camera.h"
#include "scenes/common/lane.h"
#include "scenes/common/written.h"

/* The variable of a row without one: a choice, or a row of other systems. */
#define GM_NO_VARIABLE SIZE_MAX

/* A quantity over time: a formula, of which the second output is its condition, if it has two; or a component of
   the state, below n, or its rate, from n on. */
struct gm_curve {
    const char *name;
    const struct gm_tape *tape; /* NULL: a component or a rate */
    size_t number;
    double period; /* period of an angle, which is drawn unwrapped; 0: not an angle */
};

/* A sight of the state: bodies and rods, or one point, in a plane or in space. */
struct gm_sight {
    const char *name;              /* the word of show= */
    size_t dimensions;             /* 2, or 3 in space */
    size_t bodies, rods;           /* a body has `dimensions` numbers, a rod twice as many */
    struct gm_tape tape;           /* these numbers as formulas of all variables */
    const struct gm_curve *curves; /* one per body, over time, instead of the tape; NULL: none */
    bool *fixed;                   /* for each body: it does not move */
    const char *labels[3];         /* labels of the axes; NULL: without names */
    bool over_time;                /* the first axis is the time */
    bool angles[2];                /* an axis is an angle */
    long components[2];            /* the component of the state on an axis; -1: another formula */
};

enum {
    GM_SYSTEM_ROWS = 2, /* dt and until; the system's own follow, then members, spread, shape and show */
    GM_SYSTEM_TIMES     /* dt, until and steps */
};
/* the rows after the system's own */
enum {
    GM_ROW_MEMBERS,
    GM_ROW_SPREAD,
    GM_ROW_SHAPE,
    GM_ROW_SHOW,
    GM_ROW_TRAILS,
    GM_ROW_PORTRAIT,
    GM_ROW_WINDOW,
    GM_COMMON_ROWS
};
enum { GM_SHAPE_DISC, GM_SHAPE_GRID, GM_SHAPE_LINE };
/* The words of show=: all, then the section, then all components over time, then planes, and possibly the
   modified energy. */
enum { GM_SHOW_ALL, GM_SHOW_SECTION };
#define GM_SHOW_OVER_TIME "t:"
enum { GM_TRACK_PAST, GM_TRACK_TRAIL, GM_TRACK_SHAPES, GM_TRACK_MEMBERS, GM_TRACK_SECTION, GM_SYSTEM_TRACKS };
enum { GM_MOST_CONDITIONS = 8, GM_MOST_SIGHTS = 64, GM_MOST_SURFACES = 8, GM_MOST_OVER_TIME = 8 };

struct gm_hook;         /* scenes/common/system/hook.h */
struct gm_system_maker; /* scenes/common/system/variants.h */

/* The source of a system. */
struct gm_system_origin {
    const char *name;         /* of the scene */
    const char *const *words; /* NULL-terminated (struct gm_scene); NULL: it is a scene of the program */
    const char *path;         /* of its file; NULL: none */
    bool typed;               /* its values were given with its formula, so none is a default */
    /* A wave equation is on a moving mesh; an equation that is recognised by its rates has the state of the schemes for
       it. */
    bool elsewhere;
    double until; /* the end that was typed, up to which the motion is stiff or not; 0: none */
};

/* The source of an observable's values. */
struct gm_system_measure {
    struct gm_tape *formula; /* NULL: a function of its own */
    struct gm_tape *terms;   /* of an error: the sum of the magnitudes of its terms; else NULL */
    size_t booked;           /* 1 + the number of the quantity whose jumps at events count; else 0 */
    size_t what, index;      /* of forms: their subject (scenes/form/form.h) */
};

/* The data that follows from a system once. */
struct gm_system_scene {
    struct gm_scene scene;
    struct gm_arena *arena; /* holds all of this, and the system */
    const struct gm_system_maker *maker;
    struct gm_system_origin origin;
    struct gm_user_system system;
    struct gm_user_model model;
    const struct gm_hook *hook;           /* NULL: the file names none */
    struct gm_parameter *rows, *common;   /* all rows, and those after the system's own */
    size_t *variables;                    /* for each row the number of its variable, or GM_NO_VARIABLE */
    size_t row_count, common_count;       /* the end of the system's own rows; of common ones */
    struct gm_system_scene *first, *next; /* systems of one file (variants.h); NULL: it is alone */
    const char **lacks; /* for each row: why this system lacks it, or NULL; NULL: it is alone */
    struct gm_observable *observables;
    struct gm_system_measure *measures; /* for each observable */
    size_t observable_count;
    struct gm_track tracks[GM_SYSTEM_TRACKS];
    struct gm_sight *sights; /* the first is the one of show=all; the last pair_count are planes */
    size_t sight_count, pair_count;
    const char **shows;
    const char **all_shows; /* words of all systems, in the first one; NULL: there is one system */
    struct gm_sight section;
    struct gm_tape where; /* the function that is 0 in the section, or its period, and positive conditions */
    size_t conditions;
    bool has_section, stroboscopic, at_event, turns; /* `turns`: the function is an angle */
    struct gm_tape exact, timing[GM_SYSTEM_TIMES];
    struct gm_tape surfaces;  /* half axes at the start, three per surface */
    struct gm_tape *of_items; /* for each of the system's items that is a text, a requirement or a level */
    size_t disc[2];           /* the components that members differ in */
    size_t centre;            /* 1: the key of members does not count their centre */
    double radian;            /* 1 / the largest frequency at the start */
    bool is_stiff;            /* and the file names neither a step size nor schemes */
    struct gm_work work;
    struct gm_stability stability;
    double values[5];
    const char *work_schemes[GM_MOST_PREFERRED + 1], *stability_schemes[GM_MOST_PREFERRED + 1];
    const char *schemes[GM_MOST_PREFERRED + 1];
    struct gm_system_lane *initial;
};

/* The grid of a field; half its length is among the values. */
struct gm_line_keys {
    int show; /* the content of the surfaces: scenes/field/observed.h; on a moving mesh enum gm_mesh_view */
    long points;
    bool points_given; /* else they may follow from parameters */
    int space;         /* enum gm_derivatives */
    int walls;
    int frame;    /* enum gm_frame_nodes, for the schemes of equations with frames */
    int printed;  /* the convection of Burgers' equation is u D u, not D(u^2/2) */
    double alpha; /* only on a moving mesh */
    double relax;
    char density[GM_TEXT_SIZE], mesh[GM_TEXT_SIZE], cell[GM_TEXT_SIZE];
    char nodes[GM_TEXT_SIZE], between[GM_TEXT_SIZE]; /* only of nodes alone */
};

/* A lane's parameters. */
struct gm_system_lane {
    struct gm_timing timing;
    const struct gm_system_scene *owner;
    long members;
    double spread;
    int shape, portrait;
    char show[GM_TEXT_SIZE], trails[GM_TEXT_SIZE], window[GM_TEXT_SIZE];
    struct gm_camera camera;
    struct gm_line_keys grid;
    int star, interior;                        /* of forms: enum gm_star, enum gm_interior */
    int mesh_grid, dual, streamlines, numbers; /* what is drawn of forms */
    double values[]; /* values of the rows after dt and until; then a byte per row, 1 if it was given */
};

/* Returns true if a row is a parameter of the system. */
bool gm_system_is_parameter(const struct gm_system_scene *system_scene, size_t row);
/* Puts a lane's parameters among the values of all variables. */
void gm_system_put_parameters(const struct gm_system_lane *lane, double *variables);

/* Returns the scene of a view, and the source of the observable that it evaluates. */
const struct gm_system_scene *gm_system_scene_of(const struct gm_view *view);
const struct gm_system_measure *gm_system_measure_of(const struct gm_view *view);

/* Returns the number of common rows that a scene lacks: the rows of members, which its hook places. */
static inline size_t gm_system_skipped(const struct gm_system_scene *system_scene)
{
    return system_scene->hook ? GM_ROW_SHOW : 0;
}

/* Returns the number of the observed member. */
size_t gm_system_centre(const struct gm_view *view);

/* Writes the values of all variables for one member of a view's state; velocities are NaN, and so is the
   exact solution, if it is not requested or not known. */
void gm_system_variables(const struct gm_view *view, size_t member, bool exact, double *variables);
/* Writes the values of a tape for one member of a view's state. */
void gm_system_values(const struct gm_tape *tape, const struct gm_view *view, size_t member, double *values);
/* Writes the first value of a tape after each step of a trace of one member, the last of which is the view's. */
void gm_system_values_along(const struct gm_tape *tape, const struct gm_view *view,
                            const struct gm_trace *trace, double *values);
/* Writes the numbers of a sight for one member of a view's state. */
void gm_sight_values(const struct gm_sight *sight, const struct gm_view *view, size_t member, double *values);
/* The numbers of a sight's bodies in every entry of a track: `width` per entry. */
struct gm_path {
    const double *points, *times; /* two entries at one time: the state jumps */
    size_t count, width;
};
/* Returns the path of a lane's last member in a track of states, or of member `shown` of GM_TRACK_MEMBERS, in the
   picture's memory; empty when out of memory. */
struct gm_path gm_system_path(struct gm_picture *picture, const struct gm_lane *lane, size_t track,
                              size_t shown, const struct gm_sight *sight);
/* The paths of a lane in a sight: of its last member, and, over time, of `member_count` others. */
struct gm_paths {
    const struct gm_sight *sight;
    struct gm_path past, trail, *members;
    size_t member_count;
};
/* Returns the number of members, besides the last, that GM_TRACK_MEMBERS follows: at most 64. */
size_t gm_system_followed(const struct gm_view *view);
/* Returns the number of the followed member `shown` among all members. */
size_t gm_system_followed_member(const struct gm_view *view, size_t shown);
/* Returns the count of numbers that a sight has for a state. */
size_t gm_sight_numbers(const struct gm_sight *sight);
/* Returns the sight that a lane shows. One without bodies and rods is completed by gm_system_curves. */
const struct gm_sight *gm_system_sight(const struct gm_system_lane *lane);

#endif
