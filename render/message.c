/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sentence of a refusal, written where the fault is detected. */
#include "render/message.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void gm_message_mark_cut(char *text, size_t size)
{
    static const char mark[] = "…";
    size_t at = size > sizeof mark ? size - sizeof mark : 0;
    while (at > 0 && ((unsigned char)text[at] & 0xC0) == 0x80) { /* within a letter */
        at--;
    }
    if (size >= sizeof mark) {
        memcpy(text + at, mark, sizeof mark);
    }
}

bool gm_refuse(char *message, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(message, GM_MESSAGE, format, arguments);
    va_end(arguments);
    if (length >= GM_MESSAGE) {
        gm_message_mark_cut(message, GM_MESSAGE);
    }
    return false;
}
