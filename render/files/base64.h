/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_FILES_BASE64_H
#define GM_RENDER_FILES_BASE64_H

#include <stddef.h>

/* The characters that so many bytes become, padded. */
size_t gm_base64_size(size_t size);

/* Writes bytes in base64 (RFC 4648), gm_base64_size characters without an end. */
void gm_base64(const unsigned char *bytes, size_t size, char *text);

#endif
