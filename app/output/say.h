/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_SAY_H
#define GM_APP_OUTPUT_SAY_H

#include <stdbool.h>

#include "app/base/interrupt.h"

/* The lines that commands print. */

/* Prints "geomint: sentence" to standard error. Characters that a terminal would obey are replaced:
   sentences quote files and arguments. */
__attribute__((format(printf, 1, 2))) void gm_complain(const char *format, ...);
/* The same at the end of a command: returns the exit status. */
__attribute__((format(printf, 2, 3))) int gm_give_up(int status, const char *format, ...);
/* Returns true if such a sentence has reported a lack of memory. */
bool gm_complained_of_memory(void);
/* The same for a line of standard output, without "geomint: ". */
__attribute__((format(printf, 1, 2))) void gm_say(const char *format, ...);

/* Flushes standard output. Returns the exit status: `status`, or 3 with a complaint if it could not be
   written. */
int gm_finish(int status);

/* Text on standard output, as wide as that is. */

/* Prints text and a newline. Further lines, after words, or after commas in words longer than a line, are
   indented by `indent` columns, fewer if that leaves no room. `before` columns of the first line are
   already filled, the last with a blank; the text follows them, or begins at the indent if that is
   farther. */
void gm_print_wrapped(const char *text, int before, int indent);

#endif
