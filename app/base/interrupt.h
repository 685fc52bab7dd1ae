/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_REQUEST_INTERRUPT_H
#define GM_APP_REQUEST_INTERRUPT_H

#include <signal.h>
#include <stdbool.h>

/* How often SIGINT or SIGTERM came; long work looks at it between steps. */
extern volatile sig_atomic_t gm_interrupted;
void gm_catch_interrupts(void);

/* Whether one that is caught ends the process where it is, with status 130: while something takes long that cannot look,
   and nothing else is unfinished. One that came before counts. */
void gm_interrupts_end(bool at_once);

#endif
