/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_LIBRARY_HOST_H
#define GM_LIBRARY_HOST_H

#include <locale.h>
#include <stdbool.h>

/* The program that calls the library is left as it was found. */

/* Between these two the calling thread reads and writes numbers with a point, in UTF-8, whatever the host's
   locale is. */
locale_t gm_host_leave_outside(void);
void gm_host_return(locale_t outside);

/* Calls `work` in a thread of the library, with the library's locale. No OpenGL context of the host is current
   there, so none is replaced. Returns false if there is no memory for a thread. */
bool gm_host_spare(void (*work)(void *data), void *data);

#endif
