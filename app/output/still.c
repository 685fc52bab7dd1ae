/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lanes as they are now, as one picture in a file. */
#include "app/output/still.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/output/folder.h"
#include "app/output/provenance.h"

static bool print_texts(struct gm_printer *press, struct gm_print *print, struct gm_picture *picture,
                        const struct gm_provenance *provenance, char *steps, char *failures, char *message)
{
    struct gm_png_text texts[GM_PROVENANCE_TEXTS + 2];
    size_t count = provenance->count;
    memcpy(texts, provenance->texts, count * sizeof texts[0]);
    texts[count++] = (struct gm_png_text){GM_KEY_STEPS, steps};
    if (failures[0]) {
        texts[count++] = (struct gm_png_text){GM_KEY_FAILURES, failures};
    }
    return gm_printer_write(press, print, picture, texts, count, message);
}

bool gm_still_write(struct gm_print *print, const struct gm_request *request,
                    const struct gm_lane *const *lanes, char *message)
{
    if (!gm_folder_make_for(print->path, message)) {
        return false;
    }
    struct gm_printer *press = gm_printer_open(print, message);
    if (!press) {
        return false;
    }
    struct gm_picture *picture = gm_picture_open();
    char *steps = gm_provenance_steps(lanes, request->count);
    char *failures = gm_provenance_failures(lanes, request->count);
    struct gm_provenance provenance = {0};
    bool good = picture && steps && failures &&
                gm_provenance_make(&provenance, request, &print->look, gm_printer_backend(press));
    if (good) {
        gm_lanes_draw(lanes, request->count, picture);
        good = print_texts(press, print, picture, &provenance, steps, failures, message);
    } else {
        snprintf(message, GM_MESSAGE, "not enough memory for a picture");
    }
    gm_provenance_close(&provenance);
    free(steps);
    free(failures);
    gm_picture_close(picture);
    gm_printer_close(press);
    return good;
}
