/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Threads that leave signals to the one that expects them. */
#include "render/files/thread.h"

#include <signal.h>
#include <stddef.h>

int gm_thread_start(pthread_t *thread, void *(*work)(void *), void *self)
{
    static const int faults[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS};
    sigset_t blocked, before;
    sigfillset(&blocked);
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        sigdelset(&blocked, faults[i]);
    }
    pthread_sigmask(SIG_SETMASK, &blocked, &before);
    const int error = pthread_create(thread, NULL, work, self);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return error;
}
