/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_DATA_BYTES_H
#define GM_APP_DATA_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes at places of open files, all of them or none: false with errno, of a file that is too short EIO. */

bool gm_bytes_write(int file, const void *bytes, size_t size, uint64_t place);
/* As many of them as can be written; with errno, where that is not all. */
size_t gm_bytes_write_most(int file, const void *bytes, size_t size, uint64_t place);
bool gm_bytes_read(int file, void *bytes, size_t size, uint64_t place);

/* Copies bytes to another file, none where `to` is below 0, and goes on with their checksum (CRC-32). */
bool gm_bytes_copy(int from, uint64_t place, uint64_t size, int to, uint64_t there, uint32_t *crc);

/* Zeros. */
bool gm_bytes_clear(int file, uint64_t place, uint64_t size);
/* Moves bytes to a later place of their file, which may overlap with theirs. */
bool gm_bytes_raise(int file, uint64_t place, uint64_t size, uint64_t there);
/* Moves the first bytes of a file to another one, from their end on, which the file loses as they go: no more
   room is needed on the way than before. */
bool gm_bytes_take(int from, uint64_t size, int to, uint64_t there);

#endif
