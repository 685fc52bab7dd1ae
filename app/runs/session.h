/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_RUNS_SESSION_H
#define GM_APP_RUNS_SESSION_H

#include "app/words/names.h"
#include "app/words/request.h"
#include "core/parameter.h"
#include "render/layout/appearance.h"
#include "scenes/common/lane.h"

/* An exploration: lanes of one scene that advance together in model time, the changes made during the run,
   and snapshots to step back to. It has no threads, clock or terminal. */

enum { GM_MOST_LANES = 24 };

struct gm_tour;

/* Snapshots of one lane in bounded memory. When they are full every other one is dropped, so that the
   whole past stays available: the steps between two snapshots are repeated. */

struct gm_moment {
    int64_t steps;
    double gone; /* model time that the lane has passed, forwards and backwards */
    size_t size;
    void *memory; /* the lane's parameters, then its snapshot */
};

struct gm_past { /* an empty one is {.every = 1} */
    struct gm_moment *moments;
    size_t count;
    size_t bound;      /* the largest count */
    int64_t every;     /* steps between snapshots */
    double gone, from; /* the model time that the lane has passed in both directions: gone + |t - from| */
};

/* The orders that the user can give to a session. */

enum gm_order_kind {
    /* the clock restarts after these */
    GM_ORDER_PAUSE, /* pauses, or resumes */
    GM_ORDER_FORWARD,
    GM_ORDER_BACK,
    GM_ORDER_TURN,  /* reverses time */
    GM_ORDER_VISIT, /* shows the snapshots at `value` of the past in model time, or `amount` twentieths away */
    GM_ORDER_AHEAD,  /* runs ahead to the time `text`, without shots */
    GM_ORDER_HALT,   /* stops running ahead */
    GM_ORDER_SAVE,   /* saves a PNG; amount: the theme, as for GM_ORDER_RECORD and GM_ORDER_TELL */
    GM_ORDER_SYSTEM, /* saves the user-defined system to a file */
    GM_ORDER_ANSWER, /* grades an exercise, and saves its answer to a file */
    GM_ORDER_RECORD, /* starts a movie of the screen, or finishes it */
    GM_ORDER_TOUR,   /* plays a tour's step; amount is 1 if it waits at its start */
    GM_ORDER_RUN,    /* resumes if paused */
    /* the clock continues after these */
    GM_ORDER_SELECT, /* selects a lane: `amount` up or down, or if that is 0 number `value` */
    GM_ORDER_SWITCH, /* switches the selected lane to `scheme` */
    GM_ORDER_FORK,   /* copies the selected lane with `scheme` */
    GM_ORDER_ADD,
    GM_ORDER_REMOVE,
    GM_ORDER_OVERLAY,
    GM_ORDER_TELL, /* sets the command lines of the view in the next shot */
    GM_ORDER_UNDO, /* undoes the last change of a parameter or a scheme */
    /* these may be combined with a restart that is due */
    GM_ORDER_SPEED,    /* changes the speed by `amount` */
    GM_ORDER_MOVE,     /* moves a parameter `amount` values up or down */
    GM_ORDER_NUDGE,    /* moves a parameter to a nearby value */
    GM_ORDER_STANDARD, /* resets a parameter */
    GM_ORDER_TYPE,     /* sets a parameter to `text` */
    GM_ORDER_SLIDE, /* sets a parameter to the part `value` of its range, 0 to 1; amount: 1 if a drag begins */
    GM_ORDER_LOOK,  /* turns the camera by x, y degrees (azimuth, elevation), scales the zoom by `value` */
    GM_ORDER_POINT, /* restarts from the point (x, y) of a state's panel, if the scene supports it */
    GM_ORDER_RESTART,
};

/* size of a typed line in bytes; one more than a value may have, so that a longer one is refused */
enum { GM_TYPED = GM_TEXT_SIZE + 1 };

enum { GM_UNDOS = 32 }; /* changes that can be undone */

struct gm_order {
    enum gm_order_kind kind;
    int amount;
    double value, x, y;
    char text[GM_TYPED];
    const struct gm_parameter *row; /* of the scene or of the schemes */
    const struct gm_scheme *scheme;
    const struct gm_tour *tour; /* the tour outlives the worker */
    size_t step;
};

struct gm_session {
    const struct gm_scene *scene;
    size_t count; /* number of lanes, at least 1 */
    struct gm_lane *lanes[GM_MOST_LANES];
    struct gm_past pasts[GM_MOST_LANES];
    /* The parameters for gm_session_restart; NULL without changes. Until then a lane has those with which
       its problem was made. */
    struct gm_lane_spec wanted[GM_MOST_LANES];
    struct gm_request log;           /* the lanes' starts, and the changes since */
    bool visiting;                   /* an earlier moment is shown; later ones stay until a lane advances */
    bool turned;                     /* time has run backwards since the start */
    size_t selected;                 /* the lane on which orders act */
    bool restart;                    /* a restart is due */
    struct gm_order undos[GM_UNDOS]; /* what undoes the last changes; `value` is the lane, below 0: all */
    size_t undo_count;
};

/* Opens the lanes of a request, which is copied. Returns false with a sentence (GM_MESSAGE bytes). */
bool gm_session_open(struct gm_session *session, const struct gm_request *request, char *message);
void gm_session_close(void *session);

/* Restarts all lanes with their current schemes and the parameters as last set. Returns false with a
   sentence if those contradict each other; the lanes are then unchanged. */
bool gm_session_restart(struct gm_session *session, char *message);

/* ---- time ---- */

/* 1 if time runs forwards, -1 if it runs backwards. */
double gm_session_direction(const struct gm_session *session);
/* The time of the lane that is furthest in that direction, and the nearest time at which a lane that still
   goes makes its next step (infinite, in that direction, if none does). */
double gm_session_time(const struct gm_session *session);
double gm_session_next(const struct gm_session *session);

/* Advances the lane that is furthest behind by steps that end no later than t: one step, or a part of
   many. Returns false if no lane has such a step to make. */
bool gm_session_advance(struct gm_session *session, double t);

/* One step back for the lanes that are ahead; false with a sentence. */
bool gm_session_back(struct gm_session *session, char *message);

/* Lets time run the other way from here, dt to -dt; false with a sentence if a scheme does not know how. */
bool gm_session_turn(struct gm_session *session, char *message);
/* The largest component of the difference of a lane's state from its start. */
double gm_session_from_start(const struct gm_session *session, size_t lane);

/* The model time that the lanes have passed, and the part of it for which there are snapshots. */
double gm_session_gone(const struct gm_session *session);
double gm_session_reach(const struct gm_session *session);
/* The model time of the first snapshot after `gone`; `gone` if there is no such snapshot. */
double gm_session_after(const struct gm_session *session, double gone);
/* Takes the lanes to the snapshots at or before `gone`; later ones stay available until a lane advances.
   Returns false with a sentence if there are no snapshots. */
bool gm_session_visit(struct gm_session *session, double gone, char *message);

/* ---- changes ---- */

/* Sets a parameter of the scene or of the schemes, in every lane, or only in `lane` if lanes differ in it.
   A live one acts at once; otherwise *restart is set, and the change takes effect with gm_session_restart. */
bool gm_session_set(struct gm_session *session, size_t lane, const struct gm_parameter *row, const char *text,
                    bool *restart, char *message);
/* Returns true if the lanes differ in a parameter. */
bool gm_session_differs(const struct gm_session *session, const struct gm_parameter *row);
/* The struct that holds a lane's parameters of the scene or of the schemes, as last set. */
const void *gm_session_owner(const struct gm_session *session, size_t lane, bool of_scheme);

/* Changes the scheme of a lane at its current state. */
bool gm_session_switch(struct gm_session *session, size_t lane, const struct gm_scheme *scheme,
                       char *message);

/* ---- lanes ---- */

/* A further lane with the parameters of `like`, at its start. */
bool gm_session_add(struct gm_session *session, size_t like, const struct gm_scheme *scheme, char *message);
/* Adds a lane with the state and the past of `like`, and another scheme. */
bool gm_session_fork(struct gm_session *session, size_t like, const struct gm_scheme *scheme, char *message);
bool gm_session_remove(struct gm_session *session, size_t lane, char *message);
/* All lanes in one panel, or a panel for each. */
bool gm_session_overlay(struct gm_session *session, char *message);

/* Carries out an order that needs no clock and writes no file. Returns false with a sentence; on success the
   message (GM_MESSAGE bytes) is "" or a report. The caller makes a restart that is then due. */
bool gm_session_obey(struct gm_session *session, const struct gm_order *order, char *message);

/* The fitting schemes, the scene's preferred ones first; returns their number, at most GM_FITTING_SCHEMES. */
size_t gm_session_fits(const struct gm_session *session, const struct gm_scheme **schemes);

/* Command lines: the picture of the lanes as they are, with their changes; the explorer with their present schemes and
   parameters, as if they had been typed. The caller frees them; NULL when out of memory. */
char *gm_session_picture_command(const struct gm_session *session, enum gm_theme theme);
char *gm_session_explorer_command(const struct gm_session *session);

/* A finished look at a session: everything the screen shows, as a copy. The thread that steps fills one while
   the screen shows another, so neither waits for the other. */

enum {
    GM_SHOT_OBSERVABLES = 24,
    GM_SHOT_PARAMETERS = 48,
    GM_SHOT_SCHEMES = GM_FITTING_SCHEMES,
    GM_SPARK = 16, /* places of a tiny graph */
};

/* The command lines of a view: as a picture, and the explorer with these lanes from their start. */
enum { GM_COMMAND_PICTURE, GM_COMMAND_EXPLORER, GM_COMMANDS };

struct gm_spark {
    double low[GM_SPARK], high[GM_SPARK]; /* low > high: no values */
};

struct gm_shot_lane {
    struct gm_shown shown; /* named as at its start */
    const struct gm_scheme *scheme, *first_scheme;
    enum gm_status status;
    long lost; /* the observable that shows a lost quantity (gm_lane_lost); -1: none, or the lane failed */
    double t;
    double from_start; /* largest difference from the start's components */
    double values[GM_SHOT_OBSERVABLES];
    struct gm_spark sparks[GM_SHOT_OBSERVABLES];
};

struct gm_shot_parameter {
    const struct gm_parameter *row;
    bool of_scheme;
    bool differs;    /* lanes differ; the value is the selected one's */
    double position; /* 0 to 1 in its range, or -1 */
    char value[GM_TEXT_SIZE];
};

struct gm_shot {
    const struct gm_scene *scene;
    struct gm_picture *picture;
    size_t lane_count, selected;
    struct gm_shot_lane lanes[GM_MOST_LANES];
    size_t observable_count, measured_count;
    bool measured[GM_SHOT_OBSERVABLES]; /* true for an observable with a meaning in the first lane */
    size_t parameter_count;
    struct gm_shot_parameter parameters[GM_SHOT_PARAMETERS];
    size_t scheme_count;
    const struct gm_scheme *schemes[GM_SHOT_SCHEMES]; /* all that fit, */
    const struct gm_scheme
        *same[GM_SHOT_SCHEMES]; /* the other schemes whose steps are the same here, or NULL */
    double speed;
    double cost;        /* seconds that it took to take it */
    double pace;        /* steps of the selected lane per second at that speed */
    double ahead;       /* time to which running ahead is useful */
    double gone, reach; /* model time passed, and the last snapshot's */
    bool backwards;     /* time runs */
    bool turned;        /* or has run */
    bool overlaid;      /* all lanes are in one panel */
    bool in_space;      /* the picture can be seen from all sides */
    bool drawn;         /* the picture is a new one */
    bool running_ahead; /* nothing is drawn meanwhile */
    double progress;    /* progress of running ahead, 0 to 1 */
    bool paused;
    bool behind; /* the steps cost more than the speed allows */
    char message[GM_MESSAGE];
    unsigned long message_number; /* changes with every message */
    double recorded;              /* seconds of the movie so far; below 0: none is made */
    char verdict[GM_MESSAGE];     /* on the exercise of a tour; "": none */
    bool passed;                  /* the exercise is passed */
    char *commands[GM_COMMANDS];  /* commands that reproduce a view; NULL: out of memory */
    unsigned long command_number; /* changes with every one */
};

bool gm_shot_open(struct gm_shot *shot);
void gm_shot_close(void *shot);

/* Copies the session's data without a change to it. The picture is drawn, or stays. */
void gm_shot_take(struct gm_shot *shot, const struct gm_session *session, bool draw);

/* Returns true if a lane has the scheme. */
bool gm_shot_uses(const struct gm_shot *shot, const struct gm_scheme *scheme);

/* Keys, as ncurses numbers them. */

enum { GM_KEY_ESCAPE = 27, GM_KEY_REDRAW = 'L' - '@' };

/* Returns the key of a name in a script, such as ENTER in any case, of a label in a hint, or of a letter; else 0. */
int gm_key_named(const char *word, size_t length);
/* Returns the name number `index` in a script, or NULL. */
const char *gm_key_name(size_t index);

/* The order that a key gives without a look at the screen. Returns false if it gives none. */
bool gm_key_order(int key, struct gm_order *order);

/* Steps of a parameter by keys: round values, at equal distances or ratios. */

/* The position of the value in its range, 0 to 1; -1 if it has no range to show. */
double gm_slider_position(const struct gm_parameter *row, const void *owner);

/* The value at a place from 0 to 1 in the range, rounded, as it would be typed. Returns false without a
   range. */
bool gm_slider_at(const struct gm_parameter *row, double position, char text[GM_TEXT_SIZE]);

/* The next value up (direction > 0) or down, as it would be typed; a fine step is about ten times smaller.
   Returns false if there is no next value. */
bool gm_slider_next(const struct gm_parameter *row, const void *owner, int direction, bool fine,
                    char text[GM_TEXT_SIZE]);

#endif
