/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_EXPLORER_H
#define GM_APP_EXPLORER_EXPLORER_H

#include "app/explorer/terminal/device.h"
#include "app/tours/tour.h"
#include "app/words/request.h"

/* The interactive explorer, led by a tour where there is one. A request without a scene (or NULL) begins with the list
   of scenes. Returns an exit status; a signal that asks to leave ends the process as that signal does, the terminal
   restored. */
int gm_explorer(const struct gm_request *request, const struct gm_tour *tour,
                const struct gm_overrides *overrides);

#endif
