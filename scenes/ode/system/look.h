/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What the scene of a system that somebody wrote consists of, and how its state is looked at. */
#ifndef GM_SCENES_ODE_SYSTEM_LOOK_H
#define GM_SCENES_ODE_SYSTEM_LOOK_H

#include <stdint.h>

#include "core/ode/user/problem.h"
#include "core/tape.h"
#include "scenes/common/camera.h"
#include "scenes/common/lane.h"
#include "scenes/common/written.h"
#include "scenes/ode/hooks/hook.h"

/* Of a row that is no variable of the system: a choice, or a row of others. */
#define GM_NO_VARIABLE SIZE_MAX

/* A way to look at the state: bodies and rods, or one point, in a plane or in space. */
struct gm_sight {
    const char *name;      /* as show= says it */
    size_t dimensions;     /* 2, or 3 in space */
    size_t bodies, rods;   /* as many numbers of a body, then twice as many of a rod */
    struct gm_tape tape;   /* of all variables to these numbers */
    bool *fixed;           /* of each body: it does not move */
    const char *labels[3]; /* of the axes; NULL: they have no names */
    bool over_time;        /* the first axis is the time */
    bool angles[2];        /* an axis is an angle */
    long components[2];    /* an axis is this component of the state; -1: it is none */
};

enum {
    GM_SYSTEM_ROWS =
        2 /* dt and until, then the system's own; members, spread, shape and show are behind those */
};
/* behind the system's own */
enum { GM_ROW_MEMBERS, GM_ROW_SPREAD, GM_ROW_SHAPE, GM_ROW_SHOW, GM_COMMON_ROWS };
enum { GM_SHAPE_DISC, GM_SHAPE_GRID, GM_SHAPE_LINE };
enum { GM_SHOW_ALL, GM_SHOW_SECTION /* then planes, and last the modified energy, where there is one */ };
enum { GM_TRACK_PAST, GM_TRACK_TRAIL, GM_TRACK_SHAPES, GM_TRACK_SECTION, GM_SYSTEM_TRACKS };
enum { GM_MOST_CONDITIONS = 8, GM_MOST_SIGHTS = 64, GM_MOST_PREFERRED = 12, GM_MOST_SURFACES = 8 };

/* What follows from a system once. */
struct gm_system_scene {
    struct gm_scene scene;
    struct gm_user_system system;
    struct gm_user_model model;
    const struct gm_hook *hook;           /* NULL: the file names none */
    struct gm_parameter *rows, *common;   /* all of them, and those behind the system's own */
    size_t *variables;                    /* of each row: its number among the system's, or GM_NO_VARIABLE */
    size_t row_count;                     /* where the system's own end */
    struct gm_system_scene *first, *next; /* of the systems of one file (variants.h); NULL: it is alone */
    const char *words[GM_MOST_CHOICES][GM_MOST_CHOICE_WORDS + 1]; /* of choices, NULL behind the last */
    const char *lacks;                                            /* why it has not what others have */
    struct gm_observable *observables;
    struct gm_tape *formulas; /* of each observable */
    struct gm_tape *terms;    /* of each error: the sum of the magnitudes of its terms */
    size_t observable_count;
    struct gm_track tracks[GM_SYSTEM_TRACKS];
    struct gm_sight *sights; /* the first is what show=all shows; the last pair_count are planes */
    size_t sight_count, pair_count;
    const char **shows;
    const char **all_shows; /* of all systems of the file, in the first one; NULL: there is one system */
    struct gm_sight section;
    struct gm_tape where; /* what becomes 0 there, or its period, and what must be positive */
    size_t conditions;
    bool has_section, stroboscopic, turns; /* what becomes 0 is an angle */
    struct gm_tape stop, exact, timing[3];
    struct gm_tape surfaces;  /* half axes at the start, three of each */
    struct gm_tape *of_items; /* of each of the system's items that is a text, a requirement or a level */
    size_t disc[2];           /* the components that members differ in */
    double radian;            /* 1 / the largest frequency at the start */
    struct gm_figure *figures;
    struct gm_work work;
    struct gm_stability stability;
    double values[5];
    const char *work_schemes[GM_MOST_PREFERRED + 1], *stability_schemes[GM_MOST_PREFERRED + 1];
    const char *schemes[GM_MOST_PREFERRED + 1];
    struct gm_kept_texts texts;
    struct gm_system_lane *initial;
};

/* A lane's parameters. */
struct gm_system_lane {
    struct gm_timing timing;
    const struct gm_system_scene *owner;
    long members;
    double spread;
    int shape, show;
    struct gm_camera camera;
    double values[]; /* of the rows from first_value on; behind them whether each row was given, as bytes */
};

/* Whether a row is a parameter of the system. */
bool gm_system_is_parameter(const struct gm_system_scene *system_scene, size_t row);
/* Puts a lane's parameters among the values of all variables. */
void gm_system_put_parameters(const struct gm_system_lane *lane, double *variables);

/* The scene that a view is of. */
const struct gm_system_scene *gm_system_scene_of(const struct gm_view *view);

/* How many of the common rows a scene is without: those of members, which its hook places. */
static inline size_t gm_system_skipped(const struct gm_system_scene *system_scene)
{
    return system_scene->hook ? GM_ROW_SHOW : 0;
}

/* The number of the member that is looked at. */
size_t gm_system_centre(const struct gm_view *view);

/* The values of all variables for one member of a view's state; velocities are NaN, and so is the exact solution, if it
   is not asked for or not known. */
void gm_system_variables(const struct gm_view *view, size_t member, bool exact, double *variables);
/* The values of a tape for one member of a view's state. */
void gm_system_values(const struct gm_tape *tape, const struct gm_view *view, size_t member, double *values);
/* The same of `count` other states of the last member, each with its time: struct gm_scene, stops. */
void gm_system_values_of(const struct gm_tape *tape, const struct gm_view *view, const double *states,
                         const double *times, size_t count, double *values);
/* The numbers of a sight's bodies in every entry of a track: `width` of each entry. */
struct gm_path {
    const double *points;
    size_t count, width;
};
/* The path of a lane's last member in a track of states; it lies in the picture's memory, and is empty if that is short. */
struct gm_path gm_system_path(struct gm_picture *picture, const struct gm_lane *lane, size_t track,
                              const struct gm_sight *sight);
/* Both of a lane. */
struct gm_paths {
    struct gm_path past, trail;
};
/* How many numbers a sight tells of a state. */
size_t gm_sight_numbers(const struct gm_sight *sight);
/* From which entry of the past on the path of a body is bright: a part of the whole run. */
size_t gm_system_bright_from(const struct gm_lane *lane);
/* What a lane shows of its state. */
const struct gm_sight *gm_system_sight(const struct gm_system_lane *lane);

#endif
