/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What `again` reads: the texts of a PNG or an SVG, of any bytes, of chunks whose checksums are right or of elements,
   then the request and the changes that they name. Each is read, or refused with a sentence, which holds nothing that
   a terminal would obey once it is tamed. */
#include <libdeflate.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/output/provenance.h"
#include "render/cells/text.h"
#include "render/vector/vector.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool holds)
{
    if (!holds) {
        abort();
    }
}

enum { TEXTS = 5 };

static const char *const keys[TEXTS] = {GM_KEY_ARGUMENTS, GM_KEY_CHANGES, GM_KEY_STEPS, GM_KEY_PICTURE,
                                        GM_KEY_COMMAND};

static void read_request(const char *text, const char *changes)
{
    char message[GM_MESSAGE] = "";
    struct gm_request request;
    struct gm_arguments words = {0};
    require(gm_arguments_split(&words, text));
    if (gm_request_parse(&request, words.count, words.words, 1, message)) {
        if (changes && gm_changes_parse(&request, changes)) {
            for (size_t i = 0; i < request.change_count; i++) {
                require(gm_change_check(&request, &request.changes[i], message) || message[0]);
            }
        }
    } else {
        require(message[0] != '\0' && gm_text_is_plain(gm_text_tame(message)));
    }
    gm_request_close(&request);
    gm_arguments_close(&words);
}

static size_t put_chunk(unsigned char *file, const char *type, const uint8_t *data, size_t size)
{
    const unsigned char length[4] = {0, (unsigned char)(size >> 16), (unsigned char)(size >> 8),
                                     (unsigned char)size};
    memcpy(file, length, 4);
    memcpy(file + 4, type, 4);
    if (size > 0) {
        memcpy(file + 8, data, size);
    }
    const uint32_t checksum = libdeflate_crc32(0, file + 4, 4 + size);
    for (int i = 0; i < 4; i++) {
        file[8 + size + (size_t)i] = (unsigned char)(checksum >> (24 - 8 * i));
    }
    return size + 12;
}

/* A picture of chunks whose checksums are right: each begins with its kind and the key's number, and ends
   with a byte 255. Its size; `file` has room for 32 bytes for each of the data's, and 100 more. */
static size_t make_picture(const uint8_t *data, size_t size, unsigned char *file)
{
    static const char types[4][5] = {"tEXt", "zTXt", "iTXt", "IDAT"};
    static const uint8_t head[13] = {0, 0, 0, 1, 0, 0, 0, 1, 8, 2, 0, 0, 0};
    memcpy(file, "\x89PNG\r\n\x1a\n", 8);
    size_t used = 8 + put_chunk(file + 8, "IHDR", head, sizeof head);
    unsigned char *chunk = malloc(size + 32);
    require(chunk != NULL);
    while (size >= 2) {
        const uint8_t *end = memchr(data + 2, 255, size - 2);
        const size_t length = end ? (size_t)(end - data) - 2 : size - 2;
        const char *key = keys[data[1] % TEXTS];
        const size_t front = strlen(key) + 1;
        memcpy(chunk, key, front);
        memcpy(chunk + front, data + 2, length);
        used += put_chunk(file + used, types[data[0] % 4], chunk, front + length);
        size -= length + 2 + (end != NULL);
        data += length + 2 + (end != NULL);
    }
    free(chunk);
    return used + put_chunk(file + used, "IEND", NULL, 0);
}

/* An SVG with an element for each piece of the data, which begins with the key's number and ends with a byte 255; its
   size. `file` has room for 100 bytes for each of the data's, and 100 more. */
static size_t make_drawing(const uint8_t *data, size_t size, unsigned char *file)
{
    size_t used = (size_t)sprintf((char *)file, "<svg><metadata>");
    while (size >= 1) {
        const uint8_t *end = memchr(data + 1, 255, size - 1);
        const size_t length = end ? (size_t)(end - data) - 1 : size - 1, whole = length + 1 + (end != NULL);
        used += (size_t)sprintf((char *)file + used, "<geomint:text key=\"%s\">", keys[data[0] % TEXTS]);
        memcpy(file + used, data + 1, length);
        used += length;
        used += (size_t)sprintf((char *)file + used, "</geomint:text>");
        data += whole;
        size -= whole;
    }
    return used + (size_t)sprintf((char *)file + used, "</metadata></svg>");
}

typedef bool (*reading)(const char *path, const char *const *keys, char **texts, size_t count, char *message);

/* Reads the texts of a file with these bytes, and what they name. */
static void read_file(reading read_texts, const unsigned char *bytes, size_t size)
{
    static int file = -1;
    char path[64], message[GM_MESSAGE] = "", *texts[TEXTS];
    if (file < 0) {
        file = memfd_create("picture", MFD_CLOEXEC);
    }
    require(file >= 0 && ftruncate(file, 0) == 0 && pwrite(file, bytes, size, 0) == (ssize_t)size);
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    if (!read_texts(path, keys, texts, TEXTS, message)) {
        require(message[0] != '\0');
        return;
    }
    size_t total = 0;
    for (size_t i = 0; i < TEXTS; i++) {
        total += texts[i] ? strlen(texts[i]) : 0;
    }
    require(total <= GM_PNG_TEXTS_MOST);
    if (texts[0] && strlen(texts[0]) < 400) {
        read_request(texts[0], texts[1]);
    }
    for (size_t i = 0; i < TEXTS; i++) {
        free(texts[i]);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    unsigned char *bytes = malloc(100 * size + 100);
    require(bytes != NULL);
    switch (size > 0 ? data[0] : 0) {
    case 0x89: /* a PNG as it is */
        read_file(gm_png_read_texts, data, size);
        break;
    case '<': /* an SVG as it is */
        read_file(gm_svg_read_texts, data, size);
        break;
    case '#':
        read_file(gm_svg_read_texts, bytes, make_drawing(data + 1, size - 1, bytes));
        break;
    default:
        read_file(gm_png_read_texts, bytes, make_picture(data, size, bytes));
    }
    free(bytes);
    return 0;
}
