/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_WORKER_H
#define GM_APP_EXPLORER_WORKER_WORKER_H

#include "app/explorer/worker/session.h"

/* The thread that steps is the only one that touches the lanes. Orders reach it through a queue and
   finished shots come back, so a key never waits for a step and a step never for the terminal. An idle
   thread sleeps without a deadline. */

struct gm_worker;

/* Opens the lanes and starts the thread. Returns the worker, which gm_worker_close frees; on failure fills
   message (GM_MESSAGE bytes) and returns NULL. `wake` is an eventfd, written when a shot is finished;
   with -1 there is no thread, and gm_worker_play does its work. `first` (may be NULL) is obeyed before the first step. */
struct gm_worker *gm_worker_open(const struct gm_request *request, int wake, const struct gm_order *first,
                                 char *message);
/* Writes the requested files, finishes a movie and frees the worker. `parting` (GM_MESSAGE bytes) receives
   a report on them, or "". */
void gm_worker_close(struct gm_worker *worker, char *parting);

/* Like gm_worker_open, for a scene, system or room by name, with its first `schemes` schemes. The thread
   itself opens it, so this never waits. A preview stops at the scene's own end. */
struct gm_worker *gm_worker_open_named(const char *name, size_t schemes, bool preview, int wake,
                                       char *message);
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
