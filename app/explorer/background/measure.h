/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_BACKGROUND_MEASURE_H
#define GM_APP_EXPLORER_BACKGROUND_MEASURE_H

#include <sys/types.h>

#include "core/scheme.h"

/* What `geomint certify` measures of a scheme, while the explorer goes on: by a child process, because
   nothing but its end stops certifying when another scheme is asked for. */

struct gm_measure {
    const struct gm_scheme *scheme; /* NULL: none was asked for */
    pid_t child;                    /* 0: none runs */
    int fd;                         /* where it writes; -1: none */
    char *text;                     /* what it has written, line by line */
    size_t length;
};

/* An empty one is {.fd = -1}. Asks for a scheme; another one that still runs is ended. */
void gm_measure_ask(struct gm_measure *measure, const struct gm_scheme *scheme);
/* Reads what has come; true if that was the end. */
bool gm_measure_read(struct gm_measure *measure);
/* The lines about the scheme that was asked for; NULL while they are not complete. */
const char *gm_measure_text(const struct gm_measure *measure);
void gm_measure_close(struct gm_measure *measure);

#endif
