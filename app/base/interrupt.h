/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_REQUEST_INTERRUPT_H
#define GM_APP_REQUEST_INTERRUPT_H

#include <signal.h>
#include <stdbool.h>

/* How often SIGINT or SIGTERM came; long work looks at it between steps. */
extern volatile sig_atomic_t gm_interrupted;

/* From now on they are counted. Work that does not look at the count for 2 s, as a step on a fine mesh, is cut off: the process ends
   with status 128 + the signal's number, without the files that it has not completed. So does another signal, if it
   comes not with the first one, as those of timeout do. */
void gm_catch_interrupts(void);
/* An interruption was seen: what there is is written now, for as long as it takes. */
void gm_interrupts_seen(void);

/* Whether one that is caught ends the process where it is, with status 130: while something takes long that cannot look,
   and nothing else is unfinished. One that came before counts. */
void gm_interrupts_end(bool at_once);

#endif
