/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_OUTPUT_STILL_H
#define GM_APP_OUTPUT_STILL_H

#include "app/request/request.h"
#include "render/layout/theme.h"

/* Paints lanes as they are now into one PNG that `geomint again` can redo. `request` holds the lanes' start
   and the changes since. False with a sentence (GM_MESSAGE bytes). */
bool gm_still_write(const char *path, int width, int height, enum gm_theme theme,
                    const struct gm_request *request, const struct gm_lane *const *lanes, char *message);

#endif
