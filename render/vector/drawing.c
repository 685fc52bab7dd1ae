/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The file of a drawing: made in memory, then written. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "render/files/temporary.h"
#include "render/vector/vector.h"

bool gm_drawing_write(const char *path, struct gm_drawing *drawing, const struct gm_drawer *drawer,
                      char *message)
{
    char *bytes = NULL;
    size_t size = 0;
    const bool opened = gm_page_open(drawer->painter, drawer->pen, drawer->self, drawing->look, message);
    int error = opened ? ENOMEM : errno;
    FILE *out = opened ? open_memstream(&bytes, &size) : NULL;
    bool drawn = out && drawer->draw(drawer->self, drawing, out);
    if (out && fclose(out) != 0) {
        drawn = false;
    }
    gm_page_close(drawer->painter);
    if (drawn && bytes) {
        error = gm_temporary_write(path, bytes, size);
    }
    free(bytes);
    if (error != 0 && opened) {
        gm_temporary_refuse(message, path, strerror(error));
    }
    errno = error;
    return error == 0;
}
