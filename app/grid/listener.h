/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_GRID_LISTENER_H
#define GM_APP_GRID_LISTENER_H

#include <stdbool.h>
#include <stddef.h>

/* Long work tells how far it is, and asks whether to go on. */
struct gm_listener {
    bool (*stopped)(void *self); /* NULL: never */
    /* `what` is under way, `done` of `all` parts are finished and may be looked at; NULL: nobody listens */
    void (*report)(void *self, const char *what, size_t done, size_t all);
    void *self;
};

/* Whether to stop: asked for by the listener, or by a signal. `listener` may be NULL. */
bool gm_listener_stops(const struct gm_listener *listener);
void gm_listener_hears(const struct gm_listener *listener, const char *what, size_t done, size_t all);

/* For commands: a line on standard error if that is a terminal, which gm_terminal_listener_clear removes. */
extern const struct gm_listener gm_terminal_listener;
void gm_terminal_listener_clear(void);

#endif
