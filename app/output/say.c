/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sentences on standard error, lines on standard output, and whether they arrived. */
#include "app/output/say.h"

#include <errno.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "render/cells/text.h"

static atomic_bool complained_of_memory;

__attribute__((format(printf, 3, 0))) static void put_line(FILE *stream, const char *front,
                                                           const char *format, va_list arguments)
{
    char text[8192]; /* a path may have 4096 bytes */
    vsnprintf(text, sizeof text, format, arguments);
    if (stream == stderr && strstr(text, "not enough memory")) {
        atomic_store(&complained_of_memory, true);
    }
    char *rest = text; /* a place in a text is shown on lines of its own */
    for (char *line; (line = strsep(&rest, "\n")); front = "") {
        fprintf(stream, "%s%s\n", front, gm_text_tame(line));
    }
}

void gm_complain(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    put_line(stderr, "geomint: ", format, arguments);
    va_end(arguments);
}

int gm_give_up(int status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    put_line(stderr, "geomint: ", format, arguments);
    va_end(arguments);
    return status;
}

bool gm_complained_of_memory(void)
{
    return atomic_load(&complained_of_memory);
}

void gm_say(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    put_line(stdout, "", format, arguments);
    va_end(arguments);
}

int gm_finish(int status)
{
    if (fflush(stdout) != 0 || ferror(stdout)) {
        if (errno == EPIPE) {
            return GM_EXIT_PIPE;
        }
        gm_complain("standard output could not be written: %s", strerror(errno));
        return GM_EXIT_FILE;
    }
    return status;
}
