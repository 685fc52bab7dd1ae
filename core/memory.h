/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_MEMORY_H
#define GM_CORE_MEMORY_H

#include <stdbool.h>

/* Memory that the system refused. Every malloc, calloc, realloc, aligned_alloc, strdup, strndup, asprintf,
   vasprintf and open_memstream of the program is linked to one that notes a refusal here
   (core/meson.build), so that none can be forgotten: callers check for a refusal before they return a
   number, a file or an exit status. The text of open_memstream exists when the stream is closed, and is
   NULL if memory was refused while it grew: it is never a part. */

/* Notes a refusal that a library reports. */
void gm_memory_refused(void);

/* Calls `work`, which uses GSL, and returns its result; false, with a note, if GSL was refused memory.
   During the call an error of GSL does not end the program; the handler is then restored. GSL continues
   with the null pointer in some places (gsl_odeiv2_control_y_new, gsl_linalg_LU_decomp), so it is left by
   a jump out of its error handler: its allocations so far are lost, `data` is not. */
bool gm_memory_guard_gsl(bool (*work)(void *data), void *data);

/* The number of refusals in this thread: a result computed between two equal counts is complete. */
unsigned long gm_memory_refusals(void);

/* Returns true if a thread was refused memory since the start, or since gm_memory_forget. */
bool gm_memory_was_short(void);
void gm_memory_forget(void);

#endif
