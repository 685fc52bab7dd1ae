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

/* Sets the message of the status line. */
__attribute__((format(printf, 2, 3))) void gm_play_say(struct gm_play *play, const char *format, ...);

/* ---- time ---- */

/* Returns the model time per second: 1, 2 or 5 times a power of ten. */
double gm_play_speed(const struct gm_play *play);
/* Sets the speed by number (three per decade, 0 is 1 per second), limited to the range. */
void gm_play_set_speed(struct gm_play *play, int number);
/* Resumes model time from t. */
void gm_play_set_clock(struct gm_play *play, double t);
/* Returns the model time that is due. A lane behind the others, such as a new one, is stepped even while
   paused. */
double gm_play_due(const struct gm_play *play);
/* Returns the model time left until t, in the direction in which time runs. */
double gm_play_left_until(const struct gm_play *play, double t);
/* Runs ahead to the time `to` without pausing. */
void gm_play_run_ahead(struct gm_play *play, double to);

/* ---- a round ---- */

/* Restarts all lanes if requested and the last restart is long enough ago, so that several changes make
   one restart. */
void gm_play_restart_if_due(struct gm_play *play);
/* Restarts all lanes at once. */
void gm_play_restart(struct gm_play *play);
/* Steps for some milliseconds; returns false if no step was due. */
bool gm_play_step(struct gm_play *play);
/* Makes the changes that the agenda has due, and stops at the end of a tour's step. Returns true if a
   change was made. */
bool gm_play_keep_agenda(struct gm_play *play);
/* Reports lanes that have failed. */
void gm_play_watch_frozen(struct gm_play *play);
/* Returns the seconds until the next work is due; infinite if none is. */
double gm_play_pause(const struct gm_play *play);

/* ---- a tour ---- */

/* Plays a step of a tour. The session must be at the start of step gm_tour_first(tour, step). If `waits`,
   it pauses there. */
void gm_play_tour_step(struct gm_play *play, const struct gm_tour *tour, size_t step, bool waits);

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

/* Saves the played system to a file if it is user-defined. */
void gm_capture_save_system(struct gm_play *play);
/* Saves the picture as PNG to the working directory. */
void gm_capture_save(struct gm_play *play, enum gm_theme theme);
/* Starts the movie, or finishes it. */
void gm_capture_record(struct gm_capture *capture, struct gm_play *play, enum gm_theme theme);
/* Finishes the movie. Returns true and fills sentence (GM_MESSAGE bytes) if there was one. */
bool gm_capture_stop_recording(struct gm_capture *capture, char *sentence);
/* Records a frame of the movie if one is due. */
void gm_capture_take_frame(struct gm_capture *capture, const struct gm_session *session);
/* Waits until the last frame is painted and passed on. */
void gm_capture_wait(struct gm_capture *capture);
/* Sets the command lines for the current view. */
void gm_capture_tell(struct gm_capture *capture, const struct gm_session *session, enum gm_theme theme);

void gm_order_obey(const struct gm_order *order, struct gm_play *play, struct gm_capture *capture);

#endif
