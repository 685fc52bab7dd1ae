/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_MESSAGE_H
#define GM_RENDER_MESSAGE_H

#include <stdbool.h>
#include <stddef.h>

/* Bytes of a message with its final zero: a sentence that states the fault and may quote a path or a
   sentence. */
enum { GM_MESSAGE = 512 };

/* Writes the sentence into a message, cut to its size with the mark … at its end. Returns false, so that a caller can
   return the result. */
__attribute__((format(printf, 2, 3))) bool gm_refuse(char *message, const char *format, ...);
/* Puts … at the end of a text of `size` bytes, of which the rest had no room. */
void gm_message_mark_cut(char *text, size_t size);

#endif
