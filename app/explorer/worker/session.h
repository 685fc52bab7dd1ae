/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_SESSION_H
#define GM_APP_EXPLORER_WORKER_SESSION_H

#include "app/runs/session.h"
#include "app/tours/tour.h"
#include "render/layout/appearance.h"

/* The orders that the user can give to a session. */

enum gm_order_kind {
    /* the clock restarts after these */
    GM_ORDER_PAUSE, /* pauses, or resumes */
    GM_ORDER_FORWARD,
    GM_ORDER_BACK,
    GM_ORDER_TURN,   /* reverses time */
    GM_ORDER_VISIT,  /* shows the snapshots at `value` of the past in model time, or moves by `amount` */
    GM_ORDER_AHEAD,  /* runs ahead to the time `text`, without shots */
    GM_ORDER_HALT,   /* stops running ahead */
    GM_ORDER_SAVE,   /* saves a PNG; amount: the theme, as for GM_ORDER_RECORD and GM_ORDER_TELL */
    GM_ORDER_SYSTEM, /* saves the user-defined system to a file */
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

/* A session that is played: model time follows wall time, pauses, runs ahead or back. It has no thread;
   all calls come from one thread at a time. */

struct gm_play {
    struct gm_session session;
    size_t selected;
    bool paused;
    bool behind;    /* the steps are slower than the speed requires */
    bool changed;   /* a new shot would differ */
    bool preview;   /* the session stops at the scene's own end */
    bool homewards; /* time is reversed; the session stops at the start */
    bool ahead;     /* the session runs ahead from `ahead_from` to `ahead_to` */
    double ahead_from, ahead_to, ahead_told;
    bool restart; /* a restart is due */
    double restarted;
    struct gm_order undos[GM_UNDOS]; /* what undoes the last changes; `value` is the lane, below 0: all */
    size_t undo_count;
    double stepped;             /* seconds of steps since the last look for an engine */
    double rate;                /* measured model time per second of stepping; 0: not measured */
    int speed;                  /* the number of the speed: see gm_play_set_speed */
    double clock_t, clock_wall; /* model time and wall time (s) at the last change of pace */
    size_t frozen;              /* number of frozen lanes */
    struct gm_agenda agenda;    /* the agenda of the tour's step */
    char message[GM_MESSAGE];
    unsigned long message_number; /* changes with every message */
};

/* Starts playing an open session, at a speed at which the scene's time span takes some seconds. */
void gm_play_begin(struct gm_play *play);

/* ---- time ---- */

/* Returns the model time per second: 1, 2 or 5 times a power of ten. */
double gm_play_speed(const struct gm_play *play);
/* Returns the model time left until t, in the direction in which time runs. */
double gm_play_left_until(const struct gm_play *play, double t);

/* ---- a round ---- */

/* Restarts all lanes if requested and the last restart is long enough ago, so that several changes make
   one restart. */
void gm_play_restart_if_due(struct gm_play *play);
/* Steps for some milliseconds; returns false if no step was due. */
bool gm_play_step(struct gm_play *play);
/* Makes the changes that the agenda has due, and stops at the end of a tour's step. Returns true if a
   change was made. */
bool gm_play_keep_agenda(struct gm_play *play);
/* Reports lanes that have failed. */
void gm_play_watch_frozen(struct gm_play *play);
/* Returns the seconds until the next work is due; infinite if none is. */
double gm_play_pause(const struct gm_play *play);

/* Pictures, a movie, and command lines that redo a session. */

/* A thread that paints pictures and passes them to ffmpeg, so that steps do not wait. The movie follows
   wall time: each picture lasts as long as it was seen, at most a second. */
struct gm_recorder;
/* Returns the movie's length in seconds. */
double gm_recorder_length(const struct gm_recorder *recorder);

struct gm_capture {
    struct gm_recorder *recorder; /* NULL if no movie is being made */
    bool unrecorded;              /* something changed since the movie's last frame */
    char *commands[GM_COMMANDS];  /* commands for the view when they were requested; NULL before */
    unsigned long command_number; /* changes with every request */
};

/* Frees the commands. Call gm_capture_stop_recording first. */
void gm_capture_close(struct gm_capture *capture);

/* These return false with a sentence (GM_MESSAGE bytes) for the status line, also on success. */
/* Saves the played system to a file; true without a sentence if it is not user-defined. */
bool gm_capture_save_system(const struct gm_play *play, char *sentence);
/* Saves the picture as PNG to the working directory. */
bool gm_capture_save(struct gm_play *play, enum gm_theme theme, char *sentence);
/* Starts the movie, or finishes it. */
bool gm_capture_record(struct gm_capture *capture, const struct gm_session *session, enum gm_theme theme,
                       char *sentence);
/* Finishes the movie. Returns true and fills sentence (GM_MESSAGE bytes) if there was one. */
bool gm_capture_stop_recording(struct gm_capture *capture, char *sentence);
/* Records a frame of the movie if one is due. */
void gm_capture_take_frame(struct gm_capture *capture, const struct gm_session *session);
/* Waits until the last frame is painted and passed on. */
void gm_capture_wait(struct gm_capture *capture);
/* Sets the command lines for the current view. */
void gm_capture_tell(struct gm_capture *capture, const struct gm_session *session, enum gm_theme theme);

void gm_order_obey(const struct gm_order *order, struct gm_play *play, struct gm_capture *capture);

/* The thread that steps is the only one that touches the lanes. Orders reach it through a queue and
   finished shots come back, so a key never waits for a step and a step never for the terminal. An idle
   thread sleeps without a deadline. */

struct gm_worker;

/* The lanes to play come from a request, or from a scene, system or room by name. */
struct gm_worker_plan {
    const struct gm_request *request; /* NULL: the scene of this name, with its first `schemes` schemes */
    const char *name;
    size_t schemes;
    bool preview;                 /* the play stops at the scene's own end */
    const struct gm_order *first; /* obeyed before the first step; NULL: none */
};

/* Opens the lanes and starts the thread, which itself opens a scene that has a name, so that this never waits.
   Returns the worker, which gm_worker_close frees; on failure fills message (GM_MESSAGE bytes) and returns NULL.
   `wake` is an eventfd, written when a shot is finished; with -1 there is no thread, and gm_worker_play does its
   work. */
struct gm_worker *gm_worker_open(const struct gm_worker_plan *plan, int wake, char *message);
/* Writes the requested files, finishes a movie and frees the worker. `parting` (GM_MESSAGE bytes) receives
   a report on them, or "". */
void gm_worker_close(struct gm_worker *worker, char *parting);

/* Returns true and fills message (GM_MESSAGE bytes) if opening failed. */
bool gm_worker_failed(struct gm_worker *worker, char *message);
/* Releases the worker without waiting for its step. If a movie or a file is unfinished, acts like
   gm_worker_close. */
void gm_worker_abandon(struct gm_worker *worker, char *parting);

void gm_worker_order(struct gm_worker *worker, struct gm_order order);

/* Without a thread: carries out the orders and makes the steps that are due by the clock. Returns a shot if one
   is wanted and something has changed, and the first one; else NULL. */
struct gm_shot *gm_worker_play(struct gm_worker *worker, bool wanted);

/* Asks for the next shot with changes, and returns the previous one to the thread. */
void gm_worker_want(struct gm_worker *worker);
/* Returns the requested shot, or NULL if it is not finished. The caller may read it and lay out its
   picture until it asks for the next one. */
struct gm_shot *gm_worker_take(struct gm_worker *worker);

#endif
