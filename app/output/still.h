/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_STILL_H
#define GM_APP_OUTPUT_STILL_H

#include "app/output/printer.h"
#include "app/words/request.h"

/* Paints lanes as they are now into one file that `geomint again` can redo, and makes the folders that it
   lies in. `request` holds the lanes' start and the changes since. False with a sentence (GM_MESSAGE
   bytes). */
bool gm_still_write(struct gm_print *print, const struct gm_request *request,
                    const struct gm_lane *const *lanes, char *message);

#endif
