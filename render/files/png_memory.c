/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The program's allocators and handlers of faults, with the interfaces of libpng and libdeflate. */
#include "render/files/png_memory.h"

#include "render/files/images.h"

#include <errno.h>
#include <libdeflate.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>

png_voidp gm_png_take(png_structp png, png_alloc_size_t size)
{
    int *error = png_get_mem_ptr(png);
    void *block = malloc(size);
    if (!block) {
        *error = ENOMEM;
    }
    return block;
}

void gm_png_give_back(png_structp png, png_voidp block)
{
    (void)png;
    free(block);
}

void gm_png_note_error(png_structp png, png_const_charp text)
{
    snprintf(png_get_error_ptr(png), GM_PNG_REASON, "%s", text);
    png_longjmp(png, 1);
}

void gm_png_ignore_warning(png_structp png, png_const_charp text)
{
    (void)png;
    (void)text;
}

static void let_deflate_take(void)
{
    libdeflate_set_memory_allocator(malloc, free);
}

void gm_deflate_prepare(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, let_deflate_take);
}
