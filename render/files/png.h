/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG files: written whole or not at all, and read for what they tell of themselves. */
#ifndef GM_RENDER_FILES_PNG_H
#define GM_RENDER_FILES_PNG_H

#include <stdbool.h>
#include <stddef.h>

/* A key and a text of a PNG's text chunks (UTF-8 goes to iTXt). */
struct gm_png_text {
    const char *key, *text;
};

/* Writes rgb (height rows of width * 3 bytes, top first) to path, by way of a temporary name, so that a
   killed program leaves no half file. It tells that it has dpi pixels an inch, 0: nothing of the kind. False
   on failure, with one sentence in message (GM_MESSAGE bytes). */
bool gm_png_write(const char *path, int width, int height, double dpi, const unsigned char *rgb,
                  const struct gm_png_text *texts, size_t count, char *message);

/* Reads the first text of each of these keys, in one walk over the chunks that unpacks nothing else: texts[i]
   is malloc'ed, NULL where there is none. All of them together have at most GM_PNG_TEXTS_MOST bytes. False
   with a sentence, and no text, if the file is no whole PNG, or no file but a device or a pipe. */
enum { GM_PNG_TEXTS_MOST = 1 << 22 };
bool gm_png_read_texts(const char *path, const char *const *keys, char **texts, size_t count, char *message);

/* The same for one key: NULL with a sentence also where the file holds no such text. */
char *gm_png_read_text(const char *path, const char *key, char *message);

/* Whether path is a whole PNG, every chunk's checksum right, that holds this key with this text (ASCII). */
bool gm_png_tells(const char *path, const char *key, const char *text);

/* Reads a PNG of this size into rgb (height rows of width * 3 bytes, top first). False with a sentence. */
bool gm_png_read(const char *path, int width, int height, unsigned char *rgb, char *message);

#endif
