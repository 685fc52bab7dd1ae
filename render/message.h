/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_MESSAGE_H
#define GM_RENDER_MESSAGE_H

#include <stdbool.h>

/* Bytes of a message with its final zero: a sentence that states the fault and may quote a path or a
   sentence. */
enum { GM_MESSAGE = 512 };

/* Writes the sentence into a message, cut to its size. Returns false, so that a caller can return the
   result. */
__attribute__((format(printf, 2, 3))) bool gm_refuse(char *message, const char *format, ...);

#endif
