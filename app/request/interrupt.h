/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_REQUEST_INTERRUPT_H
#define GM_APP_REQUEST_INTERRUPT_H

#include <signal.h>

/* How often SIGINT or SIGTERM came; long work looks at it between steps. */
extern volatile sig_atomic_t gm_interrupted;
void gm_catch_interrupts(void);

#endif
