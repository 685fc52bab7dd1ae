/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_ORDERS_H
#define GM_APP_EXPLORER_WORKER_ORDERS_H

#include "app/explorer/worker/capture.h"

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
