/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_BASE_INTERRUPT_H
#define GM_APP_BASE_INTERRUPT_H

#include <stdatomic.h>
#include <stdbool.h>
#include <sys/resource.h>

/* The number of signals SIGINT and SIGTERM; long work, in any thread, checks it between steps. */
extern atomic_int gm_interrupted;

/* Until gm_catch_interrupts a signal ends the process at once with status 130: what a command reads and
   proves before its work can take seconds, and no file is open yet. */
void gm_interrupts_end_reading(void);
/* Starts counting signals. Work that does not check the count for 2 s, in one step or an opening, is cut
   off: the process ends with status 130, without its incomplete files. A second signal cuts it off at
   once, unless it comes together with the first one: timeout sends its signal twice. */
void gm_catch_interrupts(void);
/* Notes that an interruption was seen: existing results are now written, without a time limit. */
void gm_interrupts_seen(void);

/* With `at_once` a signal, also an earlier one, ends the process at once with status 130: for long work
   that cannot check the count, while no file is unfinished. */
void gm_interrupts_end(bool at_once);

/* Ends the process with GM_EXIT_USAGE and this sentence on standard error after these seconds of CPU time, or fewer if
   the process has a lower limit (ulimit -S -t): for work that a file of somebody else asks for. */
void gm_interrupts_limit(rlim_t seconds, const char *sentence);

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
