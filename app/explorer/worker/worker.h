/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_WORKER_WORKER_H
#define GM_APP_EXPLORER_WORKER_WORKER_H

#include "app/explorer/worker/session.h"

/* The thread that steps. It alone touches the lanes: orders go to it through a queue and finished shots come
   back, so that a key never waits for a step and a step never for the terminal. When there is nothing to do
   it sleeps without a deadline. */

struct gm_worker;

/* Opens the lanes and starts the thread; `wake` is an eventfd that it writes to when a shot is finished.
   `first` is obeyed before the first step; NULL: nothing is. NULL with a sentence (GM_MESSAGE bytes). */
struct gm_worker *gm_worker_open(const struct gm_request *request, int wake, const struct gm_order *first,
                                 char *message);
/* Writes the files that were asked for and finishes a movie that is being made; `parting` (GM_MESSAGE bytes) tells of
   the last file and of the movie, or is empty. */
void gm_worker_close(struct gm_worker *worker, char *parting);

/* The same for a scene by its name, or that of a system or a room, with its first `schemes` schemes, that the
   thread makes and opens itself: this never waits. A preview stops at the scene's own end. */
struct gm_worker *gm_worker_open_named(const char *name, size_t schemes, bool preview, int wake,
                                       char *message);
/* Whether opening failed; then with a sentence. */
bool gm_worker_failed(struct gm_worker *worker, char *message);
/* Lets the thread end by itself, whenever that will be, unless it may be making a movie or owes a file: those are
   finished first, and told of as by gm_worker_close. The worker is gone. */
void gm_worker_abandon(struct gm_worker *worker, char *parting);

void gm_worker_order(struct gm_worker *worker, struct gm_order order);

/* Asks for a shot as soon as there is something new; the former one is handed back by this. */
void gm_worker_want(struct gm_worker *worker);
/* The shot that was asked for, or NULL if it is not there yet. It may be read until the next one is asked
   for; its picture may be laid out. */
struct gm_shot *gm_worker_take(struct gm_worker *worker);

#endif
