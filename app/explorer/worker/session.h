/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_SESSION_H
#define GM_APP_EXPLORER_WORKER_SESSION_H

#include "app/runs/session.h"
#include "app/tours/tour.h"
#include "render/layout/appearance.h"

/* A session that is played: model time follows wall time, pauses, runs ahead or back. It has no thread;
   all calls come from one thread at a time. */

struct gm_play {
    struct gm_session session;
    bool paused;
    bool behind;    /* the steps are slower than the speed requires */
    bool changed;   /* a new shot would differ */
    bool preview;   /* the session stops at the scene's own end */
    bool homewards; /* time is reversed; the session stops at the start */
    bool ahead;     /* the session runs ahead from `ahead_from` to `ahead_to` */
    double ahead_from, ahead_to, ahead_told;
    double restarted;
    double stepped;             /* seconds of steps since the last look for an engine */
    double rate;                /* measured model time per second of stepping; 0: not measured */
    int speed;                  /* the number of the speed: see gm_play_set_speed */
    double clock_t, clock_wall; /* model time and wall time (s) at the last change of pace */
    size_t frozen;              /* number of frozen lanes */
    struct gm_agenda agenda;    /* the agenda of the tour's step */
    char verdict[GM_MESSAGE];   /* on the exercise of the tour's step; "": none */
    bool passed;
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
/* Saves the answer to the exercise that is played. */
bool gm_capture_save_answer(const struct gm_play *play, char *sentence);
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
