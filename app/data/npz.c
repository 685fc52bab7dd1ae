/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NumPy's archives. APPNOTE.TXT 6.3.10 of PKWARE (the ZIP format), and numpy/lib/format.py (the .npy
   format). */
#include "app/data/npz.h"

#include <errno.h>
#include <inttypes.h>
#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "render/cells/text.h"

struct entry {
    char *name; /* with its ending */
    uint64_t place, size;
    uint32_t crc;
};

struct gm_npz {
    FILE *file;
    struct entry *entries;
    size_t count, room;
    uint64_t place; /* bytes written */
    bool failed;
};

enum {
    BLOCK = 1 << 18,
    MOST_16 = 0xFFFF, /* in their places: look at the 64-bit record */
    LOCAL = 0x04034b50,
    CENTRAL = 0x02014b50,
    END = 0x06054b50,
    END_64 = 0x06064b50,
    LOCATOR_64 = 0x07064b50,
    ZIP_64 = 45,
    ZIP_PLAIN = 20,     /* versions needed to read it */
    DAY = 1 << 5 | 1,   /* 1 January 1980: equal data make equal files */
    CRC_IN_LOCAL = 14,  /* where the checksum stands in a local header */
    EXTRA_LOCAL = 20,   /* bytes of the 64-bit record: two sizes */
    EXTRA_CENTRAL = 28, /* ... and the place */
};
static const uint32_t most_32 = 0xFFFFFFFF;

/* Numbers are written lowest byte first. */
struct bytes {
    unsigned char at[128];
    size_t count;
};

static void put(struct bytes *bytes, uint64_t value, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        bytes->at[bytes->count++] = (unsigned char)(value >> (8 * i));
    }
}

static void emit(struct gm_npz *npz, const void *bytes, size_t size)
{
    if (size > 0 && fwrite(bytes, 1, size, npz->file) != size) {
        npz->failed = true;
    }
    npz->place += size;
}

static uint32_t low(uint64_t value, bool wide)
{
    return wide ? most_32 : (uint32_t)value;
}

/* What a header of an entry says first, local or central; the versions come before it. */
static void put_entry(struct bytes *bytes, const struct entry *entry, bool wide, size_t extra)
{
    put(bytes, 0, 2); /* flags */
    put(bytes, 0, 2); /* stored */
    put(bytes, 0, 2); /* time */
    put(bytes, DAY, 2);
    put(bytes, entry->crc, 4);
    put(bytes, low(entry->size, wide), 4);
    put(bytes, low(entry->size, wide), 4);
    put(bytes, strlen(entry->name), 2);
    put(bytes, extra, 2);
}

static void emit_local(struct gm_npz *npz, const struct entry *entry)
{
    const bool wide = entry->size >= most_32;
    struct bytes bytes = {.count = 0};
    put(&bytes, LOCAL, 4);
    put(&bytes, wide ? ZIP_64 : ZIP_PLAIN, 2);
    put_entry(&bytes, entry, wide, wide ? EXTRA_LOCAL : 0);
    emit(npz, bytes.at, bytes.count);
    emit(npz, entry->name, strlen(entry->name));
    if (wide) {
        bytes.count = 0;
        put(&bytes, 1, 2);
        put(&bytes, EXTRA_LOCAL - 4, 2);
        put(&bytes, entry->size, 8);
        put(&bytes, entry->size, 8);
        emit(npz, bytes.at, bytes.count);
    }
}

static void emit_central(struct gm_npz *npz, const struct entry *entry)
{
    const bool wide = entry->size >= most_32 || entry->place >= most_32;
    struct bytes bytes = {.count = 0};
    put(&bytes, CENTRAL, 4);
    put(&bytes, wide ? ZIP_64 : ZIP_PLAIN, 2);
    put(&bytes, wide ? ZIP_64 : ZIP_PLAIN, 2);
    put_entry(&bytes, entry, wide, wide ? EXTRA_CENTRAL : 0);
    put(&bytes, 0, 2); /* comment */
    put(&bytes, 0, 2); /* disk */
    put(&bytes, 0, 2); /* attributes */
    put(&bytes, 0, 4);
    put(&bytes, low(entry->place, wide), 4);
    emit(npz, bytes.at, bytes.count);
    emit(npz, entry->name, strlen(entry->name));
    if (wide) {
        bytes.count = 0;
        put(&bytes, 1, 2);
        put(&bytes, EXTRA_CENTRAL - 4, 2);
        put(&bytes, entry->size, 8);
        put(&bytes, entry->size, 8);
        put(&bytes, entry->place, 8);
        emit(npz, bytes.at, bytes.count);
    }
}

struct gm_npz *gm_npz_open(FILE *file)
{
    struct gm_npz *npz = calloc(1, sizeof *npz);
    if (!npz) {
        errno = ENOMEM;
        return NULL;
    }
    npz->file = file;
    return npz;
}

static struct entry *add_entry(struct gm_npz *npz, const char *name)
{
    if (npz->count == npz->room) {
        const size_t room = npz->room ? 2 * npz->room : 16;
        struct entry *entries = realloc(npz->entries, room * sizeof *entries);
        if (!entries) {
            npz->failed = true;
            errno = ENOMEM;
            return NULL;
        }
        npz->entries = entries;
        npz->room = room;
    }
    struct entry *entry = &npz->entries[npz->count];
    *entry = (struct entry){.place = npz->place};
    if (asprintf(&entry->name, "%s.npy", name) < 0) {
        npz->failed = true;
        errno = ENOMEM;
        return NULL;
    }
    npz->count++;
    return entry;
}

/* The head of an .npy file, a multiple of 64 bytes; its length. */
static size_t head_of(char head[256], const char *type, const uint64_t *shape, size_t axes)
{
    enum { FRONT = 10, ALIGNED = 64 };
    char *dictionary = head + FRONT;
    const size_t room = 256 - FRONT;
    size_t used =
        (size_t)snprintf(dictionary, room, "{'descr': '%s', 'fortran_order': False, 'shape': (", type);
    for (size_t i = 0; i < axes; i++) {
        used += (size_t)snprintf(dictionary + used, room - used, "%s%" PRIu64 "%s", i ? " " : "", shape[i],
                                 i + 1 < axes || axes == 1 ? "," : "");
    }
    used += (size_t)snprintf(dictionary + used, room - used, "), }");
    const size_t size = (FRONT + used + 1 + ALIGNED - 1) / ALIGNED * ALIGNED;
    memset(dictionary + used, ' ', size - FRONT - used - 1);
    head[size - 1] = '\n';
    memcpy(head, "\x93NUMPY\x01\x00", 8);
    head[8] = (char)((size - FRONT) & 0xFF);
    head[9] = (char)((size - FRONT) >> 8);
    return size;
}

/* Copies `size` bytes from the start of `source`, and goes on with the checksum. */
static uint32_t copy(struct gm_npz *npz, uint32_t crc, int source, uint64_t size)
{
    unsigned char *block = malloc(BLOCK);
    if (!block) {
        npz->failed = true;
        errno = ENOMEM;
    }
    for (uint64_t at = 0; at < size && !npz->failed;) {
        const size_t wanted = size - at < BLOCK ? (size_t)(size - at) : BLOCK;
        const ssize_t got = pread(source, block, wanted, (off_t)at);
        if (got <= 0) {
            errno = got == 0 ? EIO : errno; /* shorter than it was */
            npz->failed = true;
            break;
        }
        crc = libdeflate_crc32(crc, block, (size_t)got);
        emit(npz, block, (size_t)got);
        at += (uint64_t)got;
    }
    free(block);
    return crc;
}

static bool write_array(struct gm_npz *npz, const char *name, const char *type, size_t item,
                        const uint64_t *shape, size_t axes, const void *values, int source)
{
    char head[256];
    const size_t head_size = head_of(head, type, shape, axes);
    uint64_t size = item;
    for (size_t i = 0; i < axes; i++) {
        size *= shape[i];
    }
    struct entry *entry = npz->failed ? NULL : add_entry(npz, name);
    if (!entry) {
        return false;
    }
    entry->size = head_size + size;
    emit_local(npz, entry);
    emit(npz, head, head_size);
    entry->crc = libdeflate_crc32(0, head, head_size);
    if (values) {
        emit(npz, values, size);
        entry->crc = libdeflate_crc32(entry->crc, values, size);
    } else {
        entry->crc = copy(npz, entry->crc, source, size);
    }
    struct bytes crc = {.count = 0};
    put(&crc, entry->crc, 4);
    npz->failed = npz->failed || fseeko(npz->file, (off_t)(entry->place + CRC_IN_LOCAL), SEEK_SET) != 0 ||
                  fwrite(crc.at, 1, crc.count, npz->file) != crc.count ||
                  fseeko(npz->file, (off_t)npz->place, SEEK_SET) != 0;
    return !npz->failed;
}

bool gm_npz_array(struct gm_npz *npz, const char *name, enum gm_npz_type type, const uint64_t *shape,
                  size_t axes, const void *values, int source)
{
    return write_array(npz, name, type == GM_NPZ_REAL ? "<f8" : "<i8", 8, shape, axes, values, source);
}

bool gm_npz_text(struct gm_npz *npz, const char *name, const char *text)
{
    char type[32];
    uint32_t *letters = malloc((strlen(text) + 1) * sizeof *letters);
    if (!letters) {
        errno = ENOMEM;
        return false;
    }
    size_t count = 0;
    while (*text) {
        letters[count++] = gm_text_next(&text);
    }
    snprintf(type, sizeof type, "<U%zu", count);
    const bool good = write_array(npz, name, type, count * sizeof *letters, NULL, 0, letters, -1);
    free(letters);
    return good;
}

static void emit_end(struct gm_npz *npz, uint64_t contents, uint64_t size)
{
    const bool wide = npz->count >= MOST_16 || contents >= most_32 || size >= most_32;
    const uint64_t at = npz->place;
    struct bytes bytes = {.count = 0};
    if (wide) {
        put(&bytes, END_64, 4);
        put(&bytes, 44, 8); /* bytes of this record that follow */
        put(&bytes, ZIP_64, 2);
        put(&bytes, ZIP_64, 2);
        put(&bytes, 0, 4);
        put(&bytes, 0, 4);
        put(&bytes, npz->count, 8);
        put(&bytes, npz->count, 8);
        put(&bytes, size, 8);
        put(&bytes, contents, 8);
        put(&bytes, LOCATOR_64, 4);
        put(&bytes, 0, 4);
        put(&bytes, at, 8);
        put(&bytes, 1, 4);
    }
    put(&bytes, END, 4);
    put(&bytes, 0, 2);
    put(&bytes, 0, 2);
    put(&bytes, wide ? MOST_16 : npz->count, 2);
    put(&bytes, wide ? MOST_16 : npz->count, 2);
    put(&bytes, low(size, wide), 4);
    put(&bytes, low(contents, wide), 4);
    put(&bytes, 0, 2);
    emit(npz, bytes.at, bytes.count);
}

bool gm_npz_close(struct gm_npz *npz)
{
    const uint64_t contents = npz->place;
    for (size_t i = 0; i < npz->count && !npz->failed; i++) {
        emit_central(npz, &npz->entries[i]);
    }
    if (!npz->failed) {
        emit_end(npz, contents, npz->place - contents);
    }
    const bool good = !npz->failed;
    for (size_t i = 0; i < npz->count; i++) {
        free(npz->entries[i].name);
    }
    free(npz->entries);
    free(npz);
    return good;
}
