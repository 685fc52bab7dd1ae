/* SPDX-License-Identifier: GPL-3.0-or-later */
/* NumPy's archives. APPNOTE.TXT 6.3.10 of PKWARE (the ZIP format), and numpy/lib/format.py (the .npy
   format). */
#include "app/data/format.h"

#include <errno.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "render/cells/text.h"
#include "render/files/deflate.h"

enum { NPY_HEAD = 256 };

struct gm_npz_entry {
    char name[112];       /* the name with its ending */
    uint64_t place, size; /* offset of the header; size of head and numbers */
    uint32_t crc;
    struct gm_npz_shape shape; /* a text has its length, and no axes */
    size_t head;               /* bytes of the head */
};

enum {
    MOST_16 = 0xFFFF, /* a field with this value refers to the 64-bit record */
    LOCAL = 0x04034b50,
    CENTRAL = 0x02014b50,
    END = 0x06054b50,
    END_64 = 0x06064b50,
    LOCATOR_64 = 0x07064b50,
    ZIP_64 = 45,        /* the version needed to read it */
    DAY = 1 << 5 | 1,   /* 1 January 1980: equal data make equal files */
    HEADER_LOCAL = 30,  /* bytes of a local header without the name */
    EXTRA_LOCAL = 20,   /* ... of its 64-bit record: two sizes */
    EXTRA_CENTRAL = 28, /* ... and the place */
};
static const uint32_t most_32 = 0xFFFFFFFF;

/* Numbers are written lowest byte first. */
struct bytes {
    unsigned char at[128];
    size_t count;
};

/* Appends numbers, each with the number of bytes that its digit in `sizes` gives. */
static void put(struct bytes *bytes, const char *sizes, const uint64_t *values)
{
    for (; *sizes; sizes++, values++) {
        for (int i = 0; i < *sizes - '0'; i++) {
            bytes->at[bytes->count++] = (unsigned char)(*values >> (8 * i));
        }
    }
}

static void emit(struct gm_npz *npz, const void *bytes, size_t size)
{
    gm_bytes_write(npz->file, bytes, size, npz->place);
    npz->place += size;
}

static uint32_t low(uint64_t value, bool wide)
{
    return wide ? most_32 : (uint32_t)value;
}

/* Puts the common fields of a local or central header, which follow the versions. */
static void put_entry(struct bytes *bytes, const struct gm_npz_entry *entry, bool wide, size_t extra)
{
    const uint64_t size = low(entry->size, wide);
    /* flags, the method "stored", time, day, ... */
    put(bytes, "222244422",
        (const uint64_t[]){0, 0, 0, DAY, entry->crc, size, size, strlen(entry->name), extra});
}

/* The offset of the head of the .npy file; the header always has the 64-bit record, so this does not
   depend on the entry's size. */
static uint64_t head_place(const struct gm_npz_entry *entry)
{
    return entry->place + HEADER_LOCAL + strlen(entry->name) + EXTRA_LOCAL;
}

static void emit_central(struct gm_npz *npz, const struct gm_npz_entry *entry)
{
    const bool wide = entry->size >= most_32 || entry->place >= most_32;
    struct bytes bytes = {.count = 0};
    put(&bytes, "422", (const uint64_t[]){CENTRAL, ZIP_64, ZIP_64});
    put_entry(&bytes, entry, wide, wide ? EXTRA_CENTRAL : 0);
    /* comment, disk, attributes, and the place */
    put(&bytes, "22244", (const uint64_t[]){0, 0, 0, 0, low(entry->place, wide)});
    emit(npz, bytes.at, bytes.count);
    emit(npz, entry->name, strlen(entry->name));
    if (wide) {
        bytes.count = 0;
        put(&bytes, "22888",
            (const uint64_t[]){1, EXTRA_CENTRAL - 4, entry->size, entry->size, entry->place});
        emit(npz, bytes.at, bytes.count);
    }
}

void gm_npz_close(struct gm_npz *npz)
{
    free(npz->entries);
    npz->entries = NULL;
}

static void add_entry(struct gm_npz *npz, const struct gm_npz_entry *entry)
{
    if (npz->count == npz->capacity) {
        const size_t capacity = npz->capacity ? 2 * npz->capacity : 16;
        struct gm_npz_entry *entries = realloc(npz->entries, capacity * sizeof *entries);
        errno = ENOMEM;
        gm_bytes_note(npz->file, entries);
        npz->capacity = entries ? capacity : npz->capacity;
        npz->entries = entries ? entries : npz->entries;
    }
    if (npz->count < npz->capacity) {
        npz->entries[npz->count++] = *entry;
    }
}

/* The head of an .npy file, a multiple of 64 bytes, `least` at least; its length. */
static size_t head_of(const struct gm_npz_entry *entry, char head[NPY_HEAD], size_t least)
{
    enum { FRONT = 10, ALIGNED = 64 };
    static const char *const types[] = {
        [GM_NPZ_REAL] = "<f8", [GM_NPZ_WHOLE] = "<i8", [GM_NPZ_LETTER] = "<U"};
    char *dictionary = head + FRONT, length[24] = "";
    const struct gm_npz_shape *shape = &entry->shape;
    const size_t capacity = NPY_HEAD - FRONT, axes = shape->axes;
    if (shape->type == GM_NPZ_LETTER) {
        snprintf(length, sizeof length, "%" PRIu64, shape->lengths[0]);
    }
    snprintf(dictionary, capacity, "{'descr': '%s%s', 'fortran_order': False, 'shape': (", types[shape->type],
             length);
    for (size_t i = 0; i < axes; i++) {
        gm_append(dictionary, capacity, "%s%" PRIu64 "%s", i ? " " : "", shape->lengths[i],
                  i + 1 < axes || axes == 1 ? "," : "");
    }
    gm_append(dictionary, capacity, "), }");
    const size_t used = strlen(dictionary);
    size_t size = (FRONT + used + 1 + ALIGNED - 1) / ALIGNED * ALIGNED;
    size = size > least ? size : least;
    memset(dictionary + used, ' ', size - FRONT - used - 1);
    head[size - 1] = '\n';
    memcpy(head, "\x93NUMPY\x01\x00", 8);
    head[8] = (char)((size - FRONT) & 0xFF);
    head[9] = (char)((size - FRONT) >> 8);
    return size;
}

uint64_t gm_npz_length(int file)
{
    static const char mark[] = "'shape': (";
    char front[2 * NPY_HEAD + 1] = "";
    struct gm_bytes bytes = gm_bytes_of(file);
    gm_bytes_read(&bytes, front, 2 * NPY_HEAD, 0);
    const char *shape = memmem(front, 2 * NPY_HEAD, mark, strlen(mark));
    return bytes.why == 0 && shape ? strtoull(shape + strlen(mark), NULL, 10) : 0;
}

/* The bytes of an entry's numbers. */
static uint64_t numbers_of(const struct gm_npz_entry *entry)
{
    const struct gm_npz_shape *shape = &entry->shape;
    if (shape->type == GM_NPZ_LETTER) {
        return shape->lengths[0] * sizeof(uint32_t);
    }
    uint64_t size = sizeof(double);
    for (size_t i = 0; i < shape->axes; i++) {
        size *= shape->lengths[i];
    }
    return size;
}

/* The next entry: its place, and the checksum of its head. */
static struct gm_npz_entry reserve(struct gm_npz *npz, const char *name, const struct gm_npz_shape *shape)
{
    char head[NPY_HEAD];
    struct gm_npz_entry entry = {.place = npz->place, .shape = *shape};
    snprintf(entry.name, sizeof entry.name, "%s.npy", name);
    entry.head = head_of(&entry, head, 0);
    entry.size = entry.head + numbers_of(&entry);
    entry.crc = gm_deflate()->libdeflate_crc32(0, head, entry.head);
    npz->place = head_place(&entry) + entry.size;
    return entry;
}

static void settle(struct gm_npz *npz, const struct gm_npz_entry *entry)
{
    char head[NPY_HEAD];
    const size_t name = strlen(entry->name);
    struct bytes bytes = {.count = 0}, extra = {.count = 0};
    put(&bytes, "42", (const uint64_t[]){LOCAL, ZIP_64});
    put_entry(&bytes, entry, true, EXTRA_LOCAL);
    put(&extra, "2288", (const uint64_t[]){1, EXTRA_LOCAL - 4, entry->size, entry->size});
    gm_bytes_write(npz->file, bytes.at, bytes.count, entry->place);
    gm_bytes_write(npz->file, entry->name, name, entry->place + HEADER_LOCAL);
    gm_bytes_write(npz->file, extra.at, extra.count, entry->place + HEADER_LOCAL + name);
    gm_bytes_write(npz->file, head, head_of(entry, head, entry->head), head_place(entry));
}

void gm_npz_array(struct gm_npz *npz, const char *name, const struct gm_npz_shape *shape, const void *values)
{
    struct gm_npz_entry entry = reserve(npz, name, shape);
    const uint64_t size = numbers_of(&entry);
    entry.crc = gm_deflate()->libdeflate_crc32(entry.crc, values, size);
    gm_bytes_write(npz->file, values, size, head_place(&entry) + entry.head);
    settle(npz, &entry);
    add_entry(npz, &entry);
}

void gm_npz_text(struct gm_npz *npz, const char *name, const char *text)
{
    struct gm_npz_shape shape = {.type = GM_NPZ_LETTER};
    uint32_t *letters = malloc((strlen(text) + 1) * sizeof *letters);
    errno = ENOMEM;
    gm_bytes_note(npz->file, letters);
    if (!letters) {
        return;
    }
    while (*text) {
        letters[shape.lengths[0]++] = gm_text_next(&text);
    }
    gm_npz_array(npz, name, &shape, letters);
    free(letters);
}

uint64_t gm_npz_reserve(struct gm_npz *npz, const char *name, const struct gm_npz_shape *shape, uint32_t *crc)
{
    const struct gm_npz_entry entry = reserve(npz, name, shape);
    add_entry(npz, &entry);
    *crc = entry.crc;
    return head_place(&entry) + entry.head;
}

void gm_npz_settle(struct gm_npz *npz, size_t index, uint32_t crc)
{
    if (npz->file->why == 0) {
        npz->entries[index].crc = crc;
        settle(npz, &npz->entries[index]);
    }
}

void gm_npz_shorten(struct gm_npz *npz, size_t index, uint64_t length)
{
    struct gm_npz_entry *entry = &npz->entries[index];
    char head[NPY_HEAD];
    entry->shape.lengths[0] = length;
    entry->size = entry->head + numbers_of(entry);
    entry->crc = gm_deflate()->libdeflate_crc32(0, head, head_of(entry, head, entry->head));
    gm_bytes_copy(npz->file, head_place(entry) + entry->head, numbers_of(entry), NULL, 0, &entry->crc);
    settle(npz, entry);
}

void gm_npz_include(struct gm_npz *npz, const struct gm_npz *other)
{
    for (size_t i = 0; i < other->count; i++) {
        struct gm_npz_entry entry = other->entries[i];
        entry.place += npz->place;
        add_entry(npz, &entry);
    }
    npz->place += other->place;
}

void gm_npz_finish(struct gm_npz *npz)
{
    const uint64_t contents = npz->place;
    for (size_t i = 0; i < npz->count; i++) {
        emit_central(npz, &npz->entries[i]);
    }
    const uint64_t size = npz->place - contents;
    const bool wide = npz->count >= MOST_16 || contents >= most_32 || size >= most_32;
    struct bytes bytes = {.count = 0};
    if (wide) {
        /* 44: the bytes of this record that follow */
        put(&bytes, "48224488884484",
            (const uint64_t[]){END_64, 44, ZIP_64, ZIP_64, 0, 0, npz->count, npz->count, size, contents,
                               LOCATOR_64, 0, npz->place, 1});
    }
    const uint64_t count = wide ? MOST_16 : npz->count;
    put(&bytes, "42222442",
        (const uint64_t[]){END, 0, 0, count, count, low(size, wide), low(contents, wide), 0});
    emit(npz, bytes.at, bytes.count);
    gm_bytes_truncate(npz->file, npz->place);
}
