/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Bytes at places of open files. */
#include "app/data/format.h"

#include <errno.h>
#include <libdeflate.h>
#include <stdlib.h>
#include <unistd.h>

enum { BLOCK = 1 << 18, SMALL_BLOCK = 1 << 14 /* where there may be no room for more */ };

size_t gm_bytes_write_most(int file, const void *bytes, size_t size, uint64_t place)
{
    size_t written = 0;
    while (written < size) {
        const ssize_t done =
            pwrite(file, (const char *)bytes + written, size - written, (off_t)(place + written));
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            break;
        }
        written += (size_t)done;
    }
    return written;
}

bool gm_bytes_write(int file, const void *bytes, size_t size, uint64_t place)
{
    return gm_bytes_write_most(file, bytes, size, place) == size;
}

bool gm_bytes_read(int file, void *bytes, size_t size, uint64_t place)
{
    char *to = bytes;
    while (size > 0) {
        const ssize_t done = pread(file, to, size, (off_t)place);
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            errno = done == 0 ? EIO : errno;
            return false;
        }
        to += done;
        size -= (size_t)done;
        place += (uint64_t)done;
    }
    return true;
}

bool gm_bytes_copy(int from, uint64_t place, uint64_t size, int to, uint64_t there, uint32_t *crc)
{
    unsigned char *block = malloc(BLOCK);
    bool good = block != NULL;
    errno = good ? errno : ENOMEM;
    for (uint64_t at = 0; at < size && good;) {
        const size_t part = size - at < BLOCK ? (size_t)(size - at) : BLOCK;
        good = gm_bytes_read(from, block, part, place + at) &&
               (to < 0 || gm_bytes_write(to, block, part, there + at));
        *crc = libdeflate_crc32(*crc, block, part);
        at += part;
    }
    free(block);
    return good;
}

bool gm_bytes_clear(int file, uint64_t place, uint64_t size)
{
    static const char nothing[SMALL_BLOCK];
    bool good = true;
    for (uint64_t at = 0; at < size && good; at += SMALL_BLOCK) {
        good = gm_bytes_write(file, nothing, size - at < SMALL_BLOCK ? (size_t)(size - at) : SMALL_BLOCK,
                              place + at);
    }
    return good;
}

/* From the end; shorten: the source loses what was moved. */
static bool move(int from, uint64_t place, uint64_t size, int to, uint64_t there, bool shorten)
{
    unsigned char block[SMALL_BLOCK];
    bool good = true;
    while (size > 0 && good) {
        const size_t part = size < SMALL_BLOCK ? (size_t)size : SMALL_BLOCK;
        size -= part;
        good = gm_bytes_read(from, block, part, place + size) &&
               (!shorten || ftruncate(from, (off_t)(place + size)) == 0) &&
               gm_bytes_write(to, block, part, there + size);
    }
    return good;
}

bool gm_bytes_raise(int file, uint64_t place, uint64_t size, uint64_t there)
{
    return move(file, place, size, file, there, false);
}

bool gm_bytes_take(int from, uint64_t size, int to, uint64_t there)
{
    /* the end comes last: until then there is room to spare, as blocks of the disk begin elsewhere in the two */
    unsigned char end[SMALL_BLOCK];
    const size_t part = size < SMALL_BLOCK ? (size_t)size : SMALL_BLOCK;
    size -= part;
    return gm_bytes_read(from, end, part, size) && ftruncate(from, (off_t)size) == 0 &&
           move(from, 0, size, to, there, true) && gm_bytes_write(to, end, part, there + size);
}
