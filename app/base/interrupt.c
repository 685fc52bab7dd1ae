/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interruptions are counted; whoever works for long looks. */
#include "app/base/interrupt.h"

#include <stddef.h>
#include <unistd.h>

#include "app/base/exit.h"

volatile sig_atomic_t gm_interrupted;
static volatile sig_atomic_t ends;

static void interrupt(int number)
{
    (void)number;
    gm_interrupted = gm_interrupted + 1;
    if (ends) {
        _exit(GM_EXIT_INTERRUPTED);
    }
}

void gm_interrupts_end(bool at_once)
{
    ends = at_once;
    if (at_once && gm_interrupted) {
        _exit(GM_EXIT_INTERRUPTED);
    }
}

void gm_catch_interrupts(void)
{
    struct sigaction action = {.sa_handler = interrupt};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}
