/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_DEFLATE_H
#define GM_RENDER_FILES_DEFLATE_H

#include <libdeflate.h>

#include "loader/library.h"

/* The functions of libdeflate that are in use: gm_deflate()->libdeflate_crc32(...). */
/* clang-format off */
#define GM_DEFLATE_FUNCTIONS(F) \
    F(libdeflate_alloc_compressor) F(libdeflate_alloc_decompressor) F(libdeflate_crc32) \
    F(libdeflate_free_compressor) F(libdeflate_free_decompressor) F(libdeflate_set_memory_allocator) \
    F(libdeflate_zlib_compress) F(libdeflate_zlib_compress_bound) F(libdeflate_zlib_decompress)
/* clang-format on */
GM_LIBRARY_TABLE(gm_deflate, GM_DEFLATE_FUNCTIONS);

#endif
