/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Interruptions are counted; whoever works for long looks. */
#include "app/request/interrupt.h"

#include <stddef.h>

volatile sig_atomic_t gm_interrupted;

static void interrupt(int number)
{
    (void)number;
    gm_interrupted = gm_interrupted + 1;
}

void gm_catch_interrupts(void)
{
    struct sigaction action = {.sa_handler = interrupt};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}
