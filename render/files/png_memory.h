/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_PNG_MEMORY_H
#define GM_RENDER_FILES_PNG_MEMORY_H

#include <png.h>

/* The memory of libpng and libdeflate is the program's, where a refusal is noted. */

/* The allocators for png_create_read_struct_2 and png_create_write_struct_2. Their pointer is an int that a
   refusal sets to ENOMEM, because libpng may report another reason. */
png_voidp gm_png_take(png_structp png, png_alloc_size_t size);
void gm_png_give_back(png_structp png, png_voidp block);

/* The handlers of libpng's faults, whose pointer is a reason of GM_PNG_REASON bytes (images.h). The first jumps to
   png_jmpbuf, the second ignores a warning. */
void gm_png_note_error(png_structp png, png_const_charp text);
void gm_png_ignore_warning(png_structp png, png_const_charp text);

/* Must be called before libdeflate's first allocation. */
void gm_deflate_prepare(void);

#endif
