/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_SAY_H
#define GM_APP_OUTPUT_SAY_H

#include <stdbool.h>

#include "app/base/interrupt.h"

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

/* Text on standard output, as wide as that is. */

/* Prints text and a newline; between its words, and behind commas in words longer than a line, it goes on in
   further lines that are indented by so many columns, fewer where that would leave no room. `before` columns
   of the first line are filled already, the last with a blank; the text stands behind them, or at the indent
   if that is farther. */
void gm_print_wrapped(const char *text, int before, int indent);

#endif
