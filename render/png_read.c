/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/png.h"

#include <libdeflate.h>
#include <png.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "render/message.h"

enum { SIGNATURE = 8, LENGTH = 4, TYPE = 4, CHECKSUM = 4 }; /* bytes */

/* The whole file; malloc'ed, NULL if it cannot be read. */
static unsigned char *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rbe");
    if (!file) {
        return NULL;
    }
    struct stat status;
    unsigned char *bytes = NULL;
    if (fstat(fileno(file), &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0) {
        *size = (size_t)status.st_size;
        bytes = malloc(*size);
        if (bytes && fread(bytes, 1, *size, file) != *size) {
            free(bytes);
            bytes = NULL;
        }
    }
    fclose(file);
    return bytes;
}

/* Whether a tEXt chunk's data are this key and this text. */
static bool is_text(const unsigned char *data, size_t size, const char *key, const char *text)
{
    const size_t front = strlen(key) + 1, length = strlen(text);
    return size == front + length && memcmp(data, key, front) == 0 && memcmp(data + front, text, length) == 0;
}

bool gm_png_tells(const char *path, const char *key, const char *text)
{
    size_t size = 0;
    unsigned char *bytes = read_file(path, &size);
    bool told = false, whole = false;
    if (bytes && size >= SIGNATURE && png_sig_cmp(bytes, 0, SIGNATURE) == 0) {
        size_t at = SIGNATURE;
        while (!whole && size - at >= LENGTH + TYPE + CHECKSUM) {
            const size_t length = png_get_uint_32(bytes + at);
            if (length > size - at - (LENGTH + TYPE + CHECKSUM)) {
                break;
            }
            const unsigned char *type = bytes + at + LENGTH, *data = type + TYPE;
            if (libdeflate_crc32(0, type, TYPE + length) != png_get_uint_32(data + length)) {
                break;
            }
            told = told || (memcmp(type, "tEXt", TYPE) == 0 && is_text(data, length, key, text));
            whole = memcmp(type, "IEND", TYPE) == 0;
            at += LENGTH + TYPE + length + CHECKSUM;
        }
    }
    free(bytes);
    return told && whole;
}

bool gm_png_read(const char *path, int width, int height, unsigned char *rgb, char *message)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    if (png_image_begin_read_from_file(&image, path)) {
        if (image.width == (png_uint_32)width && image.height == (png_uint_32)height) {
            image.format = PNG_FORMAT_RGB;
            if (png_image_finish_read(&image, NULL, rgb, 0, NULL)) {
                return true;
            }
        } else {
            snprintf(image.message, sizeof image.message, "it is no picture of %dx%d", width, height);
        }
        png_image_free(&image);
    }
    snprintf(message, GM_MESSAGE, "cannot read %.360s: %.64s", path, image.message);
    return false;
}
