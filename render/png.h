/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_PNG_H
#define GM_RENDER_PNG_H

#include <stdbool.h>
#include <stddef.h>

/* A key and a text of a PNG's text chunks (UTF-8 goes to iTXt). */
struct gm_png_text {
    const char *key, *text;
};

/* Writes rgb (height rows of width * 3 bytes, top first) to path, by way of a temporary name, so that a
   killed program leaves no half file. False on failure, with one sentence in message (GM_MESSAGE bytes). */
bool gm_png_write(const char *path, int width, int height, const unsigned char *rgb,
                  const struct gm_png_text *texts, size_t count, char *message);

/* Reads one text chunk; malloc'ed, NULL if there is none or the file is no PNG, with a sentence. */
char *gm_png_read_text(const char *path, const char *key, char *message);

/* Whether path is a whole PNG, every chunk's checksum right, that holds this key with this text (ASCII). */
bool gm_png_tells(const char *path, const char *key, const char *text);

/* Reads a PNG of this size into rgb (height rows of width * 3 bytes, top first). False with a sentence. */
bool gm_png_read(const char *path, int width, int height, unsigned char *rgb, char *message);

#endif
