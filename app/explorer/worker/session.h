/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_SESSION_H
#define GM_APP_EXPLORER_WORKER_SESSION_H

#include "app/runs/session.h"
#include "app/tours/tour.h"
#include "render/layout/appearance.h"

/* A session that is played: model time goes on with the clock on the wall, stops, runs ahead or back home. No
   thread: whoever plays calls in turn. */

struct gm_play {
    struct gm_session session;
    size_t selected;
    bool paused;
    bool behind;    /* the steps cost more than the speed allows */
    bool changed;   /* there is something new to see */
    bool preview;   /* stops at the scene's own end */
    bool homewards; /* time was turned; it stops at the start */
    bool ahead;     /* runs ahead from `ahead_from` to `ahead_to` */
    double ahead_from, ahead_to, ahead_told;
    bool restart; /* is due */
    double restarted;
    double stepped; /* seconds of steps since an engine was last looked for */
    double rate;    /* model time that a second of steps covers, as last measured; 0: not known yet */
    int speed;      /* number of the speed */
    double clock_t, clock_wall; /* model time and wall time at the last change of pace */
    size_t frozen;              /* lanes that are */
    struct gm_agenda agenda;    /* of a tour's step */
    char message[GM_MESSAGE];
    unsigned long message_number; /* changes with every one */
};

/* The session is open: from now on there is something to step, so fast that the scene's own time span takes
   some seconds. */
void gm_play_begin(struct gm_play *play);

/* A sentence for the status line. */
void gm_play_say(struct gm_play *play, const char *sentence);

/* ---- time ---- */

/* Model time per second: 1, 2 or 5 times a power of ten. */
double gm_play_speed(const struct gm_play *play);
/* The speed of that number, or the nearest that there is. */
void gm_play_set_speed(struct gm_play *play, int number);
/* From now on model time goes on from t. */
void gm_play_set_clock(struct gm_play *play, double t);
/* The model time that is due. A lane that lags behind the others, being new, is stepped also when all is
   paused. */
double gm_play_due(const struct gm_play *play);
/* How much model time is left until t, as time runs now. */
double gm_play_left_until(const struct gm_play *play, double t);
/* From here to the time `to` without a pause. */
void gm_play_run_ahead(struct gm_play *play, double to);

/* ---- a round ---- */

/* Starts all lanes again if that was asked for and the last time was long enough ago: changes that come
   together, and those that come soon after, make one restart. */
void gm_play_restart_if_due(struct gm_play *play);
/* The same at once. */
void gm_play_restart(struct gm_play *play);
/* Steps for a while; false if there was nothing to do. */
bool gm_play_step(struct gm_play *play);
/* The agenda: makes the changes that are due, and stops where a tour's step does; true if that was something. */
bool gm_play_keep_agenda(struct gm_play *play);
/* Tells of lanes that have failed. */
void gm_play_watch_frozen(struct gm_play *play);
/* After how many seconds there is something to do again; infinite if there is nothing. */
double gm_play_pause(const struct gm_play *play);

/* ---- a tour ---- */

/* Plays a step of a tour, the session being where step gm_tour_first(tour, step) begins; it waits there. */
void gm_play_tour_step(struct gm_play *play, const struct gm_tour *tour, size_t step, bool waits);

/* What is kept of a session that is played: pictures, a movie, the command lines that redo it. */

/* A thread that paints pictures and hands them to ffmpeg, so that steps do not wait for it. The movie goes with the
   clock on the wall: a picture is held for as long as it was seen, but where nothing changes for no longer than a
   second. */
struct gm_recorder;
/* Seconds of the movie so far. */
double gm_recorder_length(const struct gm_recorder *recorder);

struct gm_capture {
    struct gm_recorder *recorder; /* NULL: no movie is made */
    bool unrecorded;              /* something changed since its last frame */
    char *commands[GM_COMMANDS];  /* of the view at the time they were asked for; NULL: they were not */
    unsigned long command_number; /* changes with every one */
};

/* Ends without a movie: gm_capture_stop_recording comes first. */
void gm_capture_close(struct gm_capture *capture);

/* Writes the system that is played, if it is somebody's own, to a file. */
void gm_capture_save_system(struct gm_play *play);
/* Saves the picture. */
void gm_capture_save(struct gm_play *play, enum gm_theme theme);
/* Begins the movie, or ends it. */
void gm_capture_record(struct gm_capture *capture, struct gm_play *play, enum gm_theme theme);
/* True with a sentence (GM_MESSAGE bytes) if there was a movie. */
bool gm_capture_stop_recording(struct gm_capture *capture, char *sentence);
/* Takes a frame of the movie if one is due. */
void gm_capture_take_frame(struct gm_capture *capture, const struct gm_session *session);
/* Tells the command lines of the view. */
void gm_capture_tell(struct gm_capture *capture, const struct gm_session *session, enum gm_theme theme);

/* What the user can have done to a session that is played. */

enum gm_order_kind {
    /* the clock starts anew after these */
    GM_ORDER_PAUSE, /* or go on */
    GM_ORDER_FORWARD,
    GM_ORDER_BACK,
    GM_ORDER_TURN,   /* time the other way */
    GM_ORDER_VISIT,  /* the snapshots at `value` of model time gone through; amount: or a part up or down */
    GM_ORDER_AHEAD,  /* run ahead to the time `text`, without shots */
    GM_ORDER_HALT,   /* no longer */
    GM_ORDER_SAVE,   /* the picture as a PNG; amount: its theme, also of GM_ORDER_RECORD and GM_ORDER_TELL */
    GM_ORDER_SYSTEM, /* the system of one's own to a file */
    GM_ORDER_RECORD, /* begin a movie of what is seen, or end it */
    GM_ORDER_TOUR,   /* a step's agenda; amount: whether it waits at its begin */
    GM_ORDER_RUN,    /* go on if paused */
    /* it goes on */
    GM_ORDER_SELECT, /* amount: up or down by one lane; 0: lane number `value` */
    GM_ORDER_SWITCH, /* the selected lane to `scheme` */
    GM_ORDER_FORK,   /* the selected lane, with `scheme` */
    GM_ORDER_ADD,
    GM_ORDER_REMOVE,
    GM_ORDER_OVERLAY,
    GM_ORDER_TELL, /* the command lines of the view, with the next shot */
    /* these may come together with a restart that is due */
    GM_ORDER_SPEED,    /* amount: up or down by one */
    GM_ORDER_MOVE,     /* a parameter to its next value; amount: up or down */
    GM_ORDER_NUDGE,    /* the same, to a value near by */
    GM_ORDER_STANDARD, /* a parameter to its default */
    GM_ORDER_TYPE,     /* a parameter to `text` */
    GM_ORDER_SLIDE,    /* a parameter to the part `value` of its range */
    GM_ORDER_LOOK,  /* from a place x degrees further in azimuth, y in elevation, and `value` times as near */
    GM_ORDER_POINT, /* start again from the point (x, y) of a state's panel, where the scene knows how */
    GM_ORDER_RESTART,
};

/* A line that is typed: one byte more than a value may have, so that a longer one is refused, not cut. */
enum { GM_TYPED = GM_TEXT_SIZE + 1 };

struct gm_order {
    enum gm_order_kind kind;
    int amount;
    double value, x, y;
    char text[GM_TYPED];
    const struct gm_parameter *row;
    bool of_scheme; /* the row is one of the schemes' parameters */
    const struct gm_scheme *scheme;
    const struct gm_tour *tour; /* outlives the worker */
    size_t step;
};

void gm_order_obey(const struct gm_order *order, struct gm_play *play, struct gm_capture *capture);

#endif
