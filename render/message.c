/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sentence of a refusal: written once, by whoever knows what is wrong, for whoever says it. */
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
