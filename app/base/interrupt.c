/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Counts interruptions; long work checks the count. */
#include "app/base/interrupt.h"

#include <signal.h>
#include <stddef.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "render/files/temporary.h"

enum { PATIENCE = 2 }; /* seconds */

_Static_assert(ATOMIC_INT_LOCK_FREE == 2, "a signal handler may take no lock");
atomic_int gm_interrupted;
static volatile sig_atomic_t ends;
static struct timespec first_came;

static void cut_off(int number)
{
    (void)number;
    gm_temporary_remove_all();
    _exit(GM_EXIT_INTERRUPTED);
}

static void interrupt(int number)
{
    const double together = 0.2; /* seconds */
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (ends) {
        _exit(GM_EXIT_INTERRUPTED);
    }
    if (gm_interrupted == 0) {
        first_came = now;
        alarm(PATIENCE);
    } else if ((double)(now.tv_sec - first_came.tv_sec) + 1e-9 * (double)(now.tv_nsec - first_came.tv_nsec) >
               together) {
        cut_off(number);
    }
    gm_interrupted = gm_interrupted + 1;
}

void gm_interrupts_seen(void)
{
    if (gm_interrupted) {
        alarm(0);
    }
}

void gm_interrupts_end(bool at_once)
{
    ends = at_once;
    if (at_once && gm_interrupted) {
        _exit(GM_EXIT_INTERRUPTED);
    }
}

static void install(void)
{
    struct sigaction action = {.sa_handler = interrupt};
    sigemptyset(&action.sa_mask);
    struct sigaction late = {.sa_handler = cut_off};
    sigemptyset(&late.sa_mask);
    sigaction(SIGALRM, &late, NULL);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

void gm_interrupts_end_reading(void)
{
    ends = 1;
    install();
}

void gm_catch_interrupts(void)
{
    install();
    ends = 0;
}

static const char *over_limit;

static void end_at_limit(int number)
{
    (void)number;
    (void)!write(STDERR_FILENO, over_limit, strlen(over_limit));
    _exit(GM_EXIT_USAGE);
}

void gm_interrupts_limit(rlim_t seconds, const char *sentence)
{
    struct rlimit limit;
    over_limit = sentence;
    getrlimit(RLIMIT_CPU, &limit);
    limit.rlim_cur = seconds < limit.rlim_cur ? seconds : limit.rlim_cur;
    signal(SIGXCPU, end_at_limit);
    setrlimit(RLIMIT_CPU, &limit);
}
