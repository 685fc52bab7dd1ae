/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_MESSAGE_H
#define GM_RENDER_MESSAGE_H

/* Bytes of a message, the final zero among them: a sentence that says what is wrong, and may quote a path or
   another sentence. */
enum { GM_MESSAGE = 512 };

#endif
