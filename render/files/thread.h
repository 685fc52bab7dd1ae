/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_THREAD_H
#define GM_RENDER_FILES_THREAD_H

#include <pthread.h>

/* pthread_create, of a thread that leaves signals to the one that has the terminal, or that paints. A SIGPIPE
   or SIGXFSZ becomes an error of its write. Its faults are its own: a handler of theirs is called, so that
   even a process that is lost gives the terminal back. Returns an errno, 0 if the thread runs. */
int gm_thread_start(pthread_t *thread, void *(*work)(void *), void *self);

#endif
