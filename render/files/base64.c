/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Base64, the encoding of pictures for terminals and HTML. */
#include "render/files/images.h"

void gm_base64_put(const void *data, size_t size, FILE *out)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i += 3) {
        const unsigned second = i + 1 < size ? bytes[i + 1] : 0, third = i + 2 < size ? bytes[i + 2] : 0;
        const unsigned group = (unsigned)bytes[i] << 16 | second << 8 | third;
        const char text[4] = {letters[group >> 18], letters[group >> 12 & 63],
                              i + 1 < size ? letters[group >> 6 & 63] : '=',
                              i + 2 < size ? letters[group & 63] : '='};
        fwrite_unlocked(text, 1, sizeof text, out);
    }
}
