/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_WORKER_H
#define GM_APP_EXPLORER_WORKER_WORKER_H

#include "app/explorer/worker/session.h"

/* The thread that steps is the only one that touches the lanes. Orders reach it through a queue and
   finished shots come back, so a key never waits for a step and a step never for the terminal. An idle
   thread sleeps without a deadline. */

struct gm_worker;

/* The lanes to play: those of a request, or of a scene, system or room by name. */
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
