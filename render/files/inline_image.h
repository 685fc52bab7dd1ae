/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_INLINE_IMAGE_H
#define GM_RENDER_FILES_INLINE_IMAGE_H

#include <stdbool.h>
#include <stddef.h>

/* Pictures of pixels among the text of a terminal, as the bytes it is sent. A picture fills whole character
   cells; of one that was sent before only the parts that changed are sent again. */

enum gm_inline_kind { GM_INLINE_NONE, GM_INLINE_KITTY, GM_INLINE_SIXEL, GM_INLINE_COUNT };

struct gm_inline_place {
    int column, row;             /* of its upper left cell, from 0 on */
    int columns, rows;           /* the cells that it fills */
    int cell_width, cell_height; /* in pixels */
};

/* The picture's size in pixels there. Sixels come in bands of six rows, so up to five rows of pixels above
   the last cells' end stay blank. */
void gm_inline_size(const struct gm_inline_place *place, enum gm_inline_kind kind, int *width, int *height);

struct gm_inline;

/* For one kind and place. The terminal takes no larger image at once than most_width x most_height pixels (0:
   of any size). NULL when memory is short. */
struct gm_inline *gm_inline_open(enum gm_inline_kind kind, const struct gm_inline_place *place,
                                 int most_width, int most_height);
void gm_inline_close(struct gm_inline *image);

/* Encodes a picture of gm_inline_size, 3 bytes a pixel, top row first. `whole` sends all of it, whatever was
   sent before. *bytes belongs to the image until the next call; *size is 0 if nothing changed. The bytes
   leave the cursor anywhere. False when memory is short. */
bool gm_inline_encode(struct gm_inline *image, const unsigned char *rgb, bool whole, const char **bytes,
                      size_t *size);

/* What removes such pictures from a screen; "" where text written over them does. */
const char *gm_inline_removal(enum gm_inline_kind kind);

#endif
