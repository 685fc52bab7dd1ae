/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_EXPLORER_H
#define GM_APP_EXPLORER_EXPLORER_H

#include "app/explorer/terminal/device.h"
#include "app/tours/tour.h"
#include "app/words/request.h"

/* Runs the interactive explorer, with a tour if that is not NULL. Without a request or scene it starts
   with the list of scenes. Returns an exit status. A signal that asks to leave restores the terminal, then
   ends the process. */
int gm_explorer(const struct gm_request *request, const struct gm_tour *tour,
                const struct gm_overrides *overrides);

#endif
