/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_H
#define GM_APP_EXPLORER_WORKER_H

#include "app/explorer/shot.h"
#include "app/tour.h"
#include "render/theme.h"

/* The thread that steps. It alone touches the lanes: orders go to it through a queue and finished shots come
   back, so that a key never waits for a step and a step never for the terminal. When there is nothing to do
   it sleeps without a deadline. */

enum gm_order_kind {
    GM_ORDER_PAUSE, /* or go on */
    GM_ORDER_FORWARD,
    GM_ORDER_BACK,
    GM_ORDER_RESTART,
    GM_ORDER_SPEED,    /* amount: up or down by one */
    GM_ORDER_SELECT,   /* amount: up or down by one lane */
    GM_ORDER_MOVE,     /* a parameter to its next value; amount: up or down */
    GM_ORDER_STANDARD, /* a parameter to its default */
    GM_ORDER_SWITCH,   /* the selected lane to `scheme` */
    GM_ORDER_ADD,
    GM_ORDER_REMOVE,
    GM_ORDER_SAVE, /* the picture as a PNG */
    GM_ORDER_TOUR, /* a step's agenda; amount: whether it waits at its begin */
    GM_ORDER_RUN,  /* go on if paused */
};

struct gm_order {
    enum gm_order_kind kind;
    int amount;
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
void gm_worker_close(struct gm_worker *worker);

void gm_worker_order(struct gm_worker *worker, struct gm_order order);

/* Asks for a shot as soon as there is something new; the former one is handed back by this. */
void gm_worker_want(struct gm_worker *worker);
/* The shot that was asked for, or NULL if it is not there yet. It may be read until the next one is asked
   for; its picture may be laid out. */
struct gm_shot *gm_worker_take(struct gm_worker *worker);

#endif
