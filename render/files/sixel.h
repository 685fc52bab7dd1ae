/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_SIXEL_H
#define GM_RENDER_FILES_SIXEL_H

#include <stdbool.h>
#include <stddef.h>

/* Sixels: pictures of up to 256 colours for terminals in the tradition of the VT340 (DEC, VT330/VT340
   Programmer Reference Manual, vol. 2, chapter 14). The colours are chosen for each picture. */

struct gm_sixel;

/* NULL when memory is short. */
struct gm_sixel *gm_sixel_open(void);
void gm_sixel_close(struct gm_sixel *sixel);

/* Encodes width x height pixels of 3 bytes each, `stride` bytes from row to row. *bytes belongs to the
   encoder until the next call. False when memory is short. */
bool gm_sixel_encode(struct gm_sixel *sixel, const unsigned char *rgb, size_t stride, int width, int height,
                     const char **bytes, size_t *size);

#endif
