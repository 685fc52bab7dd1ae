/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sentence of a refusal, written where the fault is detected. */
#include "render/message.h"

#include <stdarg.h>
#include <stdio.h>

bool gm_refuse(char *message, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, GM_MESSAGE, format, arguments);
    va_end(arguments);
    return false;
}
