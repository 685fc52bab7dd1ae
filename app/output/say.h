/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_SAY_H
#define GM_APP_OUTPUT_SAY_H

#include <stdbool.h>

#include "app/base/exit.h"

/* What commands say, line by line. */

/* Prints "geomint: sentence" to standard error. What a terminal would obey instead of showing it is replaced:
   sentences quote files and arguments. */
__attribute__((format(printf, 1, 2))) void gm_complain(const char *format, ...);
/* The same, where that is the end: returns the status to exit with. */
__attribute__((format(printf, 2, 3))) int gm_give_up(int status, const char *format, ...);
/* Whether such a sentence has spoken of memory that there was not. */
bool gm_complained_of_memory(void);
/* The same for a line of standard output, without a front. */
__attribute__((format(printf, 1, 2))) void gm_say(const char *format, ...);

/* Flushes standard output. The status to exit with: `status`, or 3 with a complaint if it could not be
   written. */
int gm_finish(int status);

#endif
