/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_SENTENCE_H
#define GM_CORE_SENTENCE_H

/* Bytes of the sentences that say what is wrong, the final zero among them: one that a scene or the core
   writes, and one that may hold such a one. */
enum { GM_SENTENCE = 256, GM_MESSAGE = 512 };

#endif
