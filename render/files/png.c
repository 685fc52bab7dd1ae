/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG files, made in memory, and read: the texts of any file, the pixels of one that geomint wrote. Files that are read
   are not trusted. */
#include "render/files/images.h"

#include <errno.h>
#include <math.h>
#include <png.h>
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/files/deflate.h"
#include "render/files/regular_file.h"
#include "render/files/temporary.h"
#include "render/message.h"

/* clang-format off */
#define PNG_FUNCTIONS(F) \
    F(png_create_info_struct) F(png_create_read_struct_2) F(png_create_write_struct_2) \
    F(png_destroy_read_struct) F(png_destroy_write_struct) F(png_get_error_ptr) F(png_get_image_height) \
    F(png_get_mem_ptr) F(png_get_rowbytes) F(png_init_io) F(png_longjmp) F(png_read_end) F(png_read_info) \
    F(png_read_row) F(png_read_update_info) F(png_set_IHDR) F(png_set_PLTE) F(png_set_expand) \
    F(png_set_gray_to_rgb) F(png_set_interlace_handling) F(png_set_longjmp_fn) F(png_set_pHYs) \
    F(png_set_scale_16) F(png_set_strip_alpha) F(png_set_tRNS) F(png_set_text) F(png_set_user_limits) \
    F(png_sig_cmp) F(png_write_chunk) F(png_write_info)
/* clang-format on */
static GM_LIBRARY_TABLE(libpng, PNG_FUNCTIONS);
GM_LIBRARY(libpng, "libpng16.so.16", PNG_FUNCTIONS)
GM_LIBRARY(gm_deflate, "libdeflate.so.0", GM_DEFLATE_FUNCTIONS)

/* ---- memory ---- */

/* libpng and libdeflate take the program's memory, where a refusal is noted. libpng's pointer is an int that a refusal
   sets to ENOMEM, because libpng may report another reason. */
static png_voidp take(png_structp png, png_alloc_size_t size)
{
    int *error = libpng()->png_get_mem_ptr(png);
    void *block = malloc(size);
    if (!block) {
        *error = ENOMEM;
    }
    return block;
}

static void give_back(png_structp png, png_voidp block)
{
    (void)png;
    free(block);
}

/* The handlers of libpng's faults, whose pointer is a reason of GM_PNG_REASON bytes. The first jumps to png_jmpbuf. */
static void note_error(png_structp png, png_const_charp text)
{
    snprintf(libpng()->png_get_error_ptr(png), GM_PNG_REASON, "%s", text);
    libpng()->png_longjmp(png, 1);
}

static void ignore_warning(png_structp png, png_const_charp text)
{
    (void)png;
    (void)text;
}

static void let_deflate_take(void)
{
    gm_deflate()->libdeflate_set_memory_allocator(malloc, free);
}

/* Must be called before libdeflate's first allocation. */
static void prepare_deflate(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, let_deflate_take);
}

/* ---- writing ---- */

/* The structure of the file is libpng's, the image data libdeflate's. Measured on plots of 1280x720 pixels
   (curves and text; in brackets: with a field of smooth colours), one core, milliseconds and kilobytes:

       libpng, its defaults                     25.4   117    (85.3   405)
       libpng, level 1, no filter                5.2   114    (15.1   591)
       libdeflate, level 1, no filter            3.7   104    ( 7.9   564)
       libdeflate, level 1, filter up            8.3   129    (10.1   443)
       libdeflate, level 2, no filter            5.2   101    (11.0   545)

   so that a filter would make the usual picture larger and take twice the time. */

enum {
    LEVEL = 1,               /* level of libdeflate for pixels */
    BEST = 9,                /* and for numbered colours */
    LONGEST_CHUNK = 1 << 30, /* the format allows 2^31 - 1 */
};

static bool is_ascii(const char *text)
{
    for (; *text; text++) {
        if ((unsigned char)*text > 126) {
            return false;
        }
    }
    return true;
}

/* Returns the rows, each after its filter's number, in zlib's format; the caller frees them. Rows of a
   palette are differences to the row above, because the fields of colours are smooth. */
static unsigned char *deflate_rows(const struct gm_png *image, size_t *size)
{
    const bool differences = image->palette != NULL;
    const size_t row = (size_t)image->width * (differences ? 1 : 3), height = (size_t)image->height;
    const size_t total = (row + 1) * height;
    unsigned char *rows = malloc(total);
    prepare_deflate();
    struct libdeflate_compressor *compressor =
        gm_deflate()->libdeflate_alloc_compressor(differences ? BEST : LEVEL);
    const size_t bound = compressor ? gm_deflate()->libdeflate_zlib_compress_bound(compressor, total) : 0;
    unsigned char *packed = bound ? malloc(bound) : NULL;
    *size = 0;
    for (size_t y = 0; rows && packed && y < height; y++) {
        const unsigned char *from = image->pixels + y * row, *above = y > 0 ? from - row : from;
        unsigned char *to = rows + y * (row + 1);
        *to++ = differences ? PNG_FILTER_VALUE_UP : PNG_FILTER_VALUE_NONE;
        memcpy(to, from, row);
        for (size_t x = 0; differences && y > 0 && x < row; x++) {
            to[x] = (unsigned char)(from[x] - above[x]);
        }
    }
    if (rows && packed) {
        *size = gm_deflate()->libdeflate_zlib_compress(compressor, rows, total, packed, bound);
    }
    if (compressor) {
        gm_deflate()->libdeflate_free_compressor(compressor);
    }
    free(rows);
    if (*size == 0) {
        free(packed);
        return NULL;
    }
    return packed;
}

static void set_palette(png_structp png, png_infop info, const uint8_t palette[GM_PALETTE][4])
{
    png_color colours[GM_PALETTE];
    png_byte opacities[GM_PALETTE];
    for (size_t i = 0; i < GM_PALETTE; i++) {
        colours[i] = (png_color){palette[i][0], palette[i][1], palette[i][2]};
        opacities[i] = palette[i][3];
    }
    libpng()->png_set_PLTE(png, info, colours, GM_PALETTE);
    libpng()->png_set_tRNS(png, info, opacities, GM_PALETTE, NULL);
}

/* The image data of a file, and the texts as libpng takes them. */
struct contents {
    unsigned char *packed;
    size_t packed_size;
    png_text *texts;
};

/* Only the two structures outlive the jump out of libpng's errors. */
static bool write_structure(FILE *out, const struct gm_png *image, const struct contents *contents,
                            int *error, char *reason)
{
    png_structp png = libpng()->png_create_write_struct_2(PNG_LIBPNG_VER_STRING, reason, note_error,
                                                          ignore_warning, error, take, give_back);
    png_infop info = png ? libpng()->png_create_info_struct(png) : NULL;
    if (!info) {
        libpng()->png_destroy_write_struct(&png, NULL);
        *error = ENOMEM;
        return false;
    }
    if (setjmp(*libpng()->png_set_longjmp_fn(png, longjmp, sizeof(jmp_buf)))) {
        libpng()->png_destroy_write_struct(&png, &info);
        return false;
    }
    libpng()->png_init_io(png, out);
    libpng()->png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    libpng()->png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, 8,
                           image->palette ? PNG_COLOR_TYPE_PALETTE : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                           PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (image->palette) {
        set_palette(png, info, image->palette);
    }
    if (image->dpi > 0) {
        const png_uint_32 per_metre = (png_uint_32)lround(image->dpi / 0.0254);
        libpng()->png_set_pHYs(png, info, per_metre, per_metre, PNG_RESOLUTION_METER);
    }
    libpng()->png_set_text(png, info, contents->texts, (int)image->text_count);
    libpng()->png_write_info(png, info);
    for (size_t at = 0; at < contents->packed_size; at += LONGEST_CHUNK) {
        size_t left = contents->packed_size - at;
        libpng()->png_write_chunk(png, (png_const_bytep) "IDAT", contents->packed + at,
                                  left < LONGEST_CHUNK ? left : LONGEST_CHUNK);
    }
    /* png_write_end fails: libpng itself has written no image data */
    libpng()->png_write_chunk(png, (png_const_bytep) "IEND", NULL, 0);
    libpng()->png_destroy_write_struct(&png, &info);
    return true;
}

unsigned char *gm_png_pack(const struct gm_png *image, size_t *size, char *reason)
{
    struct contents contents = {.texts = calloc(image->text_count + 1, sizeof *contents.texts)};
    int error = 0;
    char *bytes = NULL;
    bool written = false;
    contents.packed = contents.texts ? deflate_rows(image, &contents.packed_size) : NULL;
    for (size_t i = 0; contents.texts && i < image->text_count; i++) {
        const struct gm_png_text *text = &image->texts[i];
        contents.texts[i] = (png_text){
            .compression = is_ascii(text->text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE,
            /* libpng's struct is not const; it copies both */
            .key = (char *)text->key,
            .text = (char *)text->text,
            .text_length = strlen(text->text),
        };
    }
    FILE *out = contents.packed ? open_memstream(&bytes, size) : NULL;
    if (out) {
        written = write_structure(out, image, &contents, &error, reason);
        error = ferror(out) ? ENOMEM : error;
        written = fclose(out) == 0 && written;
    }
    free(contents.packed);
    free(contents.texts);
    if (!out || error) {
        snprintf(reason, GM_PNG_REASON, "%s", strerror(ENOMEM));
    }
    if (!written) {
        free(bytes);
    }
    return written ? (unsigned char *)bytes : NULL;
}

bool gm_png_write(const char *path, const struct gm_png *image, char *message)
{
    char reason[GM_PNG_REASON] = "a picture has at least one pixel, and fits in memory";
    size_t size = 0;
    const bool fits = image->width >= 1 && image->height >= 1 &&
                      (size_t)image->height <= SIZE_MAX / 4 / (size_t)image->width;
    unsigned char *bytes = fits ? gm_png_pack(image, &size, reason) : NULL;
    const int error = bytes ? gm_temporary_write(path, bytes, size) : 0;
    free(bytes);
    return (bytes && error == 0) || gm_temporary_refuse(message, path, error ? strerror(error) : reason);
}

/* ---- reading ---- */

enum {
    SIGNATURE = 8, /* bytes */
    LENGTH = 4,
    TYPE = 4,
    CHECKSUM = 4,
    LARGEST = 1 << 30,     /* the largest picture that is painted has 805 MB of pixels */
    MOST_CHUNKS = 1 << 20, /* libpng writes one for 8 kB of pixels */
};

/* A chunk's data, and the bytes that texts may still have. */
struct chunk {
    const unsigned char *data;
    size_t size, limit;
};

static char *copy_of(const void *bytes, size_t size)
{
    char *text = malloc(size + 1);
    if (text) {
        memcpy(text, bytes, size);
        text[size] = '\0';
    }
    return text;
}

/* Returns a text packed in zlib's format, which the caller frees; NULL if it is damaged or too large. */
static char *unpack(const unsigned char *packed, size_t size, size_t limit)
{
    prepare_deflate();
    struct libdeflate_decompressor *decompressor = gm_deflate()->libdeflate_alloc_decompressor();
    char *bytes = decompressor ? malloc(limit + 1) : NULL, *text = NULL;
    size_t length = 0;
    if (bytes && gm_deflate()->libdeflate_zlib_decompress(decompressor, packed, size, bytes, limit,
                                                          &length) == LIBDEFLATE_SUCCESS) {
        text = copy_of(bytes, length);
        if (text && strlen(text) != length) {
            free(text);
            text = NULL;
        }
    }
    if (decompressor) {
        gm_deflate()->libdeflate_free_decompressor(decompressor);
    }
    free(bytes);
    return text;
}

/* Returns the text after the key of a chunk tEXt, zTXt or iTXt (the PNG specification, 11.3.3), which the
   caller frees; NULL if the chunk is damaged or the text too large. */
static char *text_of(const struct chunk *chunk, const char *type, size_t key)
{
    const unsigned char *at = chunk->data + key + 1, *end = chunk->data + chunk->size;
    bool packed = type[0] == 'z';
    if (packed || type[0] == 'i') {
        const ptrdiff_t front = packed ? 1 : 2; /* the method; in iTXt the flag before it */
        if (end - at < front || at[front - 1] != 0 || (!packed && at[0] > 1)) {
            return NULL;
        }
        packed = packed || at[0] == 1;
        at += front;
    }
    for (int i = 0; i < 2 && type[0] == 'i'; i++) { /* skips the language and the translated key */
        const unsigned char *zero = memchr(at, 0, (size_t)(end - at));
        if (!zero) {
            return NULL;
        }
        at = zero + 1;
    }
    const size_t size = (size_t)(end - at);
    if (packed) {
        return unpack(at, size, chunk->limit);
    }
    return size > chunk->limit || memchr(at, 0, size) ? NULL : copy_of(at, size);
}

/* The texts to find. */
struct search {
    const char *const *keys;
    char **texts;
    size_t count, limit;
    bool all; /* checks all chunks, not only those of texts */
};

static bool is_text(const char *type)
{
    return memcmp(type, "tEXt", TYPE) == 0 || memcmp(type, "zTXt", TYPE) == 0 ||
           memcmp(type, "iTXt", TYPE) == 0;
}

/* Returns the index of a chunk's key among those still missing; their number if it is not among them. */
static size_t wanted(const struct search *search, const unsigned char *data, size_t size)
{
    size_t i = 0;
    for (; i < search->count; i++) {
        const size_t length = strlen(search->keys[i]) + 1;
        if (!search->texts[i] && size >= length && memcmp(data, search->keys[i], length) == 0) {
            break;
        }
    }
    return i;
}

/* Checks a chunk, and reads its text; `length` bytes and a checksum are left of it in the file. */
static bool take_chunk(FILE *file, const char *type, size_t length, struct search *search, char *reason)
{
    errno = 0;
    unsigned char *bytes = malloc(TYPE + length + CHECKSUM);
    bool good = bytes && fread(bytes + TYPE, 1, length + CHECKSUM, file) == length + CHECKSUM;
    if (good) {
        memcpy(bytes, type, TYPE);
        const struct chunk chunk = {bytes + TYPE, length, search->limit};
        const size_t i = is_text(type) ? wanted(search, chunk.data, length) : search->count;
        good =
            gm_deflate()->libdeflate_crc32(0, bytes, TYPE + length) == png_get_uint_32(chunk.data + length);
        if (good && i < search->count) {
            char *text = text_of(&chunk, type, strlen(search->keys[i]));
            good = text != NULL;
            search->texts[i] = text;
            search->limit -= text ? strlen(text) : 0;
        }
    }
    if (!good) {
        snprintf(reason, GM_REGULAR_REASON, "%s",
                 errno == ENOMEM ? strerror(ENOMEM) : "a text of it is damaged or too large");
    }
    free(bytes);
    return good;
}

/* Walks over the chunks. Returns false with a reason. */
static bool find_texts(FILE *file, size_t left, struct search *search, char *reason)
{
    unsigned char head[LENGTH + TYPE];
    size_t unread = GM_PNG_TEXTS_MOST; /* bytes of all texts as they are in the file */
    for (long chunks = 0; left >= sizeof head + CHECKSUM && chunks < MOST_CHUNKS; chunks++) {
        if (fread(head, 1, sizeof head, file) != sizeof head) {
            break;
        }
        left -= sizeof head + CHECKSUM;
        const size_t length = png_get_uint_32(head);
        const char *type = (const char *)head + LENGTH;
        if (length > left || (chunks == 0) != (memcmp(type, "IHDR", TYPE) == 0)) {
            break;
        }
        left -= length;
        const bool text = is_text(type), ends = memcmp(type, "IEND", TYPE) == 0;
        if (text && length > unread) {
            snprintf(reason, GM_REGULAR_REASON, "its texts have more than %d MB", GM_PNG_TEXTS_MOST >> 20);
            return false;
        }
        unread -= text ? length : 0;
        if ((text || search->all) && !take_chunk(file, type, length, search, reason)) {
            return false;
        }
        if (ends) {
            return true;
        }
        if (!text && !search->all && fseeko(file, (off_t)(length + CHECKSUM), SEEK_CUR) != 0) {
            break;
        }
    }
    snprintf(reason, GM_REGULAR_REASON, "it is cut short or damaged");
    return false;
}

static bool read_texts(const char *path, struct search *search, char *message)
{
    char reason[GM_REGULAR_REASON] = "it is not a PNG file";
    unsigned char signature[SIGNATURE];
    size_t size = 0;
    FILE *file = gm_regular_open(path, LARGEST, &size, reason);
    const bool found = file && fread(signature, 1, SIGNATURE, file) == SIGNATURE &&
                       libpng()->png_sig_cmp(signature, 0, SIGNATURE) == 0 &&
                       find_texts(file, size - SIGNATURE, search, reason);
    if (file) {
        fclose(file);
    }
    if (!found) {
        for (size_t i = 0; i < search->count; i++) {
            free(search->texts[i]);
            search->texts[i] = NULL;
        }
        gm_refuse(message, "cannot read %.360s: %s", path, reason);
    }
    return found;
}

bool gm_png_read_texts(const char *path, const char *const *keys, char **texts, size_t count, char *message)
{
    for (size_t i = 0; i < count; i++) {
        texts[i] = NULL;
    }
    return read_texts(path, &(struct search){keys, texts, count, GM_PNG_TEXTS_MOST, false}, message);
}

char *gm_png_read_text(const char *path, const char *key, char *message)
{
    char *text = NULL;
    if (gm_png_read_texts(path, &key, &text, 1, message) && !text) {
        gm_refuse(message, "%.360s holds no text \"%.64s\"", path, key);
    }
    return text;
}

bool gm_png_tells(const char *path, const char *key, const char *text)
{
    char *found = NULL, message[GM_MESSAGE];
    const bool told = read_texts(path, &(struct search){&key, &found, 1, GM_PNG_TEXTS_MOST, true}, message) &&
                      found && strcmp(found, text) == 0;
    free(found);
    return told;
}

/* Only the two structures outlive the jump out of libpng's errors. libpng's simple reader has its own memory
   and reports no refusal. */
static bool read_pixels(FILE *file, int width, int height, unsigned char *rgb, int *error, char *reason)
{
    png_structp png = libpng()->png_create_read_struct_2(PNG_LIBPNG_VER_STRING, reason, note_error,
                                                         ignore_warning, error, take, give_back);
    png_infop info = png ? libpng()->png_create_info_struct(png) : NULL;
    if (!info) {
        libpng()->png_destroy_read_struct(&png, NULL, NULL);
        *error = ENOMEM;
        return false;
    }
    if (setjmp(*libpng()->png_set_longjmp_fn(png, longjmp, sizeof(jmp_buf)))) {
        libpng()->png_destroy_read_struct(&png, &info, NULL);
        return false;
    }
    libpng()->png_init_io(png, file);
    libpng()->png_read_info(png, info);
    libpng()->png_set_expand(png);
    libpng()->png_set_scale_16(png);
    libpng()->png_set_strip_alpha(png);
    libpng()->png_set_gray_to_rgb(png);
    const int passes = libpng()->png_set_interlace_handling(png);
    libpng()->png_read_update_info(png, info);
    const size_t row = 3 * (size_t)width;
    if (libpng()->png_get_image_height(png, info) != (png_uint_32)height ||
        libpng()->png_get_rowbytes(png, info) != row) {
        snprintf(reason, GM_REGULAR_REASON, "it is not a picture of %dx%d", width, height);
        libpng()->png_longjmp(png, 1);
    }
    for (int pass = 0; pass < passes; pass++) {
        for (size_t y = 0; y < (size_t)height; y++) {
            libpng()->png_read_row(png, rgb + y * row, NULL);
        }
    }
    libpng()->png_read_end(png, NULL);
    libpng()->png_destroy_read_struct(&png, &info, NULL);
    return true;
}

bool gm_png_read(const char *path, int width, int height, unsigned char *rgb, char *message)
{
    size_t size = 0;
    char reason[GM_REGULAR_REASON];
    FILE *file = gm_regular_open(path, LARGEST, &size, reason);
    int error = 0; /* errno, when memory is short */
    const bool taken = file && read_pixels(file, width, height, rgb, &error, reason);
    if (file) {
        fclose(file);
    }
    if (!taken) {
        gm_refuse(message, "cannot read %.360s: %s", path, error ? strerror(error) : reason);
    }
    return taken;
}
