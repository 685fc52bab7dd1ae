/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lanes as they are now, as one picture in a file. */
#include "app/output/still.h"

#include "app/output/folder.h"
#include "app/output/provenance.h"

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
    struct gm_provenance provenance = {0};
    bool good = picture &&
                gm_provenance_make(&provenance, request, &print->look, gm_printer_backend(press)) &&
                gm_provenance_take_lanes(&provenance, lanes, request->count, true);
    if (good) {
        gm_lanes_draw(lanes, request->count, picture);
        good = gm_printer_write(press, print, picture, provenance.texts, provenance.count, message);
    } else {
        gm_refuse(message, "not enough memory for a picture");
    }
    gm_provenance_close(&provenance);
    gm_picture_close(picture);
    gm_printer_close(press);
    return good;
}
