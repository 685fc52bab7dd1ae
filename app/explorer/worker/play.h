/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_PLAY_H
#define GM_APP_EXPLORER_WORKER_PLAY_H

#include "app/tours/agenda.h"

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
/* The agenda: makes the changes that are due, and stops where a tour's step does. */
void gm_play_keep_agenda(struct gm_play *play);
/* Tells of lanes that have failed. */
void gm_play_watch_frozen(struct gm_play *play);
/* After how many seconds there is something to do again; infinite if there is nothing. */
double gm_play_pause(const struct gm_play *play);

/* ---- a tour ---- */

/* Plays a step of a tour, the session being where step gm_tour_first(tour, step) begins; it waits there. */
void gm_play_tour_step(struct gm_play *play, const struct gm_tour *tour, size_t step, bool waits);

#endif
