/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Base64, the encoding of pictures for terminals and HTML. */
#include "render/files/images.h"

size_t gm_base64_size(size_t size)
{
    return (size + 2) / 3 * 4;
}

void gm_base64(const unsigned char *bytes, size_t size, char *text)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3, text += 4) {
        unsigned second = i + 1 < size ? bytes[i + 1] : 0, third = i + 2 < size ? bytes[i + 2] : 0;
        unsigned group = (unsigned)bytes[i] << 16 | second << 8 | third;
        text[0] = letters[group >> 18];
        text[1] = letters[group >> 12 & 63];
        text[2] = i + 1 < size ? letters[group >> 6 & 63] : '=';
        text[3] = i + 2 < size ? letters[group & 63] : '=';
    }
}
