/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MEMORY_H
#define GM_CORE_MEMORY_H

#include <stdbool.h>

/* Memory that the system refused. Every malloc, calloc, realloc, aligned_alloc, strdup, strndup, asprintf,
   vasprintf and open_memstream of the program is linked to one that notes a refusal here (core/meson.build),
   so that none can be forgotten: whoever hands out a number, a file or an exit status asks whether memory was
   short. The text of open_memstream is there when the stream is closed, and NULL if memory was refused while
   it grew: never the half of it. */

/* Notes a refusal that a library reports. */
void gm_memory_refused(void);

/* Calls `work`, which uses GSL, and returns what it says; false, and noted, where GSL was refused memory. An
   error of GSL's, which would end the program, does nothing meanwhile; its handler is then again what it was.
   GSL goes on with the null pointer in some places (gsl_odeiv2_control_y_new, gsl_linalg_LU_decomp), so it is
   left by a jump out of its error handler: what it had taken so far is lost, what `work` stored in `data` is
   not. */
bool gm_memory_guard_gsl(bool (*work)(void *data), void *data);

/* How many refusals this thread has met: what was computed between two equal answers is whole. */
unsigned long gm_memory_refusals(void);

/* Whether any thread has met one since the program began, or since that was forgotten. */
bool gm_memory_was_short(void);
void gm_memory_forget(void);

#endif
