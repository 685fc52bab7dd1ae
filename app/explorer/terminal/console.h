/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_TERMINAL_CONSOLE_H
#define GM_APP_EXPLORER_TERMINAL_CONSOLE_H

#include <stdbool.h>

#include "app/base/interrupt.h"
#include "app/explorer/terminal/terminal.h"

/* The terminal as a device: taken over by ncurses at the start, given back on every way out, its keys and
   signals read. Answers among the keys go to the terminal's answers. */

/* Takes the terminal over. `wake` is an eventfd that signals are announced on. Keys typed before come first.
   False with a sentence (GM_MESSAGE bytes). */
bool gm_console_open(int wake, struct gm_terminal *terminal, char *message);
/* Gives it back. Harmless if it was given back before. Signals are still noted, so that what the explorer has
   to finish is not cut off: SIGINT, SIGTERM and SIGQUIT count as gm_interrupted, the third ends the
   process. */
void gm_console_close(void);
/* Signals do what they did before. */
void gm_console_release(void);

/* The next key of those that have come, as ncurses numbers them; -1 if there is none. */
int gm_console_key(void);
/* How long to wait for the rest of a key or an answer that has begun, in milliseconds; -1 if none has. Then
   gm_console_key takes it as it is. */
int gm_console_patience(void);

/* The signal that asks to leave, or 0. */
int gm_console_leaving(void);
/* Whether the size may have changed since the last call. */
bool gm_console_resized(void);
/* Whether the user asked to suspend (Ctrl-Z) since the last call. */
bool gm_console_stopping(void);
/* Gives the terminal back, stops the process, and takes the terminal over again when it goes on, unless that
   is to leave. */
void gm_console_stop(void);

#endif
