/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_THREAD_H
#define GM_RENDER_FILES_THREAD_H

#include <pthread.h>

/* Starts a thread that leaves signals to the thread with the terminal, or the one that paints. A SIGPIPE or
   SIGXFSZ becomes an error of its write. A fault of the thread calls a handler of the process, so that even a
   lost process restores the terminal. Returns an errno, 0 if the thread runs. */
int gm_thread_start(pthread_t *thread, void *(*work)(void *), void *self);

#endif
