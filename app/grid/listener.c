/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The listener of long work: a line on standard error, or nothing. */
#include "app/grid/sweep.h"

#include <stdio.h>
#include <unistd.h>

#include "app/base/interrupt.h"

bool gm_listener_stops(const struct gm_listener *listener)
{
    return gm_interrupted || (listener && listener->stopped && listener->stopped(listener->self));
}

void gm_listener_hears(const struct gm_listener *listener, const char *what, size_t done, size_t all)
{
    if (listener && listener->report) {
        listener->report(listener->self, what, done, all);
    }
}

static void write_line(void *self, const char *what, size_t done, size_t all)
{
    (void)self;
    if (isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r%zu/%zu %-28s ", done, all, what);
    }
}

const struct gm_listener gm_terminal_listener = {.report = write_line};

void gm_terminal_listener_clear(void)
{
    if (isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r%60s\r", "");
    }
}
