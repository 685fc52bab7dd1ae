/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_DRAWING_GLYPHS_H
#define GM_RENDER_DRAWING_GLYPHS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Letters: fonts found by fontconfig, drawn by FreeType into one growing image of coverages (the atlas). */

enum gm_font { GM_FONT_SANS, GM_FONT_BOLD, GM_FONT_MONO, GM_FONT_MONO_BOLD, GM_FONT_COUNT };

struct gm_glyphs;

/* Returns NULL on failure, with one sentence in message and errno: ENOMEM, ENOENT without a font, EIO. */
struct gm_glyphs *gm_glyphs_open(char *message, size_t size);
void gm_glyphs_close(struct gm_glyphs *glyphs);

/* The width of a text, and the distances of a font's baseline from the top and bottom of its line; in pixels,
   for letters of `height` pixels (the em). */
double gm_glyphs_width(struct gm_glyphs *glyphs, enum gm_font font, int height, const char *text);
double gm_glyphs_ascent(struct gm_glyphs *glyphs, enum gm_font font, int height);
double gm_glyphs_descent(struct gm_glyphs *glyphs, enum gm_font font, int height);

/* The name of the family, such as "DejaVu Sans", and the file of the font. */
const char *gm_glyphs_family(const struct gm_glyphs *glyphs, enum gm_font font);
const char *gm_glyphs_file(const struct gm_glyphs *glyphs, enum gm_font font);

/* A letter of a text, on a baseline at 0. */
struct gm_letter {
    int x, y, width, height; /* the image, relative to the start of the baseline; y downwards */
    int atlas_x, atlas_y;
};
/* Gives the next letter and advances `text` and `pen`. Returns false at the end; a letter without an image
   has width 0. */
bool gm_glyphs_next(struct gm_glyphs *glyphs, enum gm_font font, int height, const char **text, double *pen,
                    struct gm_letter *letter);

/* Gives the letters that no font had, so that boxes replaced them, in all pictures so far. Returns their
   number, at most GM_LACKING. */
enum { GM_LACKING = 9 };
size_t gm_glyphs_lacking(uint32_t letters[GM_LACKING]);

/* The atlas: rows of `width` bytes. Rows from `changed` on have changed since the last call. It grows only
   downwards, so places in it stay valid. */
struct gm_atlas {
    const unsigned char *pixels;
    int width, height, changed, used;
};
struct gm_atlas gm_glyphs_atlas(struct gm_glyphs *glyphs);

#endif
