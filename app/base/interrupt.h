/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_BASE_INTERRUPT_H
#define GM_APP_BASE_INTERRUPT_H

#include <signal.h>
#include <stdbool.h>

/* How often SIGINT or SIGTERM came; long work looks at it between steps. */
extern volatile sig_atomic_t gm_interrupted;

/* From now on they are counted. Work that does not look at the count for 2 s, in one step or an opening, is cut off: the
   process ends with status 130, without the files that it has not completed. A second signal cuts it off at once,
   unless it comes together with the first one: timeout sends its signal twice. */
void gm_catch_interrupts(void);
/* An interruption was seen: what there is is written now, for as long as it takes. */
void gm_interrupts_seen(void);

/* Whether one that is caught ends the process where it is, with status 130: while something takes long that cannot look,
   and nothing else is unfinished. One that came before counts. */
void gm_interrupts_end(bool at_once);

/* Exit statuses of the program. */
enum {
    GM_EXIT_OK = 0,
    GM_EXIT_USAGE = 1,
    GM_EXIT_NUMERICAL = 2,
    GM_EXIT_FILE = 3,
    GM_EXIT_CLAIM = 4,
    GM_EXIT_MEMORY = 5,
    GM_EXIT_INTERRUPTED = 130,
    GM_EXIT_PIPE = 141,
};

#endif
