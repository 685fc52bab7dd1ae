/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_WORKER_H
#define GM_APP_EXPLORER_WORKER_WORKER_H

#include "app/lanes/shot.h"
#include "app/tours/tour.h"
#include "render/layout/theme.h"

/* The thread that steps. It alone touches the lanes: orders go to it through a queue and finished shots come
   back, so that a key never waits for a step and a step never for the terminal. When there is nothing to do
   it sleeps without a deadline. */

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
    GM_ORDER_POINT,    /* start again from the point (x, y) of a state's panel, where the scene knows how */
    GM_ORDER_RESTART,
};

struct gm_order {
    enum gm_order_kind kind;
    int amount;
    double value, x, y;
    char text[GM_VALUE_TEXT];
    const struct gm_parameter *row;
    bool of_scheme; /* the row is one of the schemes' parameters */
    const struct gm_scheme *scheme;
    const struct gm_tour *tour; /* outlives the worker */
    size_t step;
};

struct gm_worker;

/* Opens the lanes and starts the thread; `wake` is an eventfd that it writes to when a shot is finished.
   `first` is obeyed before the first step; NULL: nothing is. NULL with a sentence (GM_MESSAGE bytes). */
struct gm_worker *gm_worker_open(const struct gm_request *request, enum gm_theme theme, int wake,
                                 const struct gm_order *first, char *message);
/* Finishes a movie that is being made; `parting` (GM_MESSAGE bytes) tells of it, or is empty. */
void gm_worker_close(struct gm_worker *worker, char *parting);

/* The same for a scene by its name, with its first `schemes` schemes, that the thread opens itself: this
   never waits. A preview stops at the scene's own end. */
struct gm_worker *gm_worker_open_scene(const struct gm_scene *scene, size_t schemes, bool preview,
                                       enum gm_theme theme, int wake, char *message);
/* Whether opening failed; then with a sentence. */
bool gm_worker_failed(struct gm_worker *worker, char *message);
/* Lets the thread end by itself, whenever that will be, unless it may be making a movie: that is finished
   first, and told of as by gm_worker_close. The worker is gone. */
void gm_worker_abandon(struct gm_worker *worker, char *parting);

void gm_worker_order(struct gm_worker *worker, struct gm_order order);

/* Asks for a shot as soon as there is something new; the former one is handed back by this. */
void gm_worker_want(struct gm_worker *worker);
/* The shot that was asked for, or NULL if it is not there yet. It may be read until the next one is asked
   for; its picture may be laid out. */
struct gm_shot *gm_worker_take(struct gm_worker *worker);

#endif
