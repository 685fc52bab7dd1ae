/* SPDX-License-Identifier: GPL-3.0-or-later */
/* PNG files: written whole or not at all, and read back with their texts; broken ones are refused. */
#include <fcntl.h>
#include <png.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "core/basics.h"
#include "render/files/images.h"
#include "tests/common/folder.h"

enum { MESSAGE = 512 };

static char folder[200];

static const char *in_folder(const char *name)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static int make_folder(void **state)
{
    (void)state;
    folder_make(folder, sizeof folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    folder_remove(folder);
    return 0;
}

static bool write_png(const char *path, int width, int height, const unsigned char *rgb,
                      const struct gm_png_text *texts, size_t count, char *message)
{
    const struct gm_png image = {
        .width = width, .height = height, .pixels = rgb, .texts = texts, .text_count = count};
    return gm_png_write(path, &image, message);
}

/* Smooth, noisy and constant parts, so that every kind of deflate block occurs. */
static unsigned char *make_pixels(int width, int height)
{
    size_t row = (size_t)width * 3;
    unsigned char *rgb = malloc(row * (size_t)height);
    assert_non_null(rgb);
    uint32_t noise = 12345;
    for (size_t y = 0; y < (size_t)height; y++) {
        for (size_t i = 0; i < row; i++) {
            noise = noise * 1664525 + 1013904223;
            unsigned value = y % 3 == 0 ? noise >> 24 : y % 3 == 1 ? i + y : 250;
            rgb[y * row + i] = (unsigned char)value;
        }
    }
    return rgb;
}

static void check_pixels(const char *path, int width, int height, const unsigned char *rgb)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_int_not_equal(png_image_begin_read_from_file(&image, path), 0);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    assert_int_equal(image.format & PNG_FORMAT_FLAG_ALPHA, 0);
    image.format = PNG_FORMAT_RGB;
    unsigned char *read = malloc(PNG_IMAGE_SIZE(image));
    assert_non_null(read);
    assert_int_not_equal(png_image_finish_read(&image, NULL, read, 0, NULL), 0);
    assert_int_equal(image.warning_or_error, 0);
    assert_memory_equal(read, rgb, (size_t)width * (size_t)height * 3);
    free(read);
}

static void pixels_survive(void **state)
{
    (void)state;
    const int sizes[][2] = {{1, 1}, {1, 7}, {7, 1}, {3, 2}, {255, 33}, {640, 360}, {1279, 719}, {1, 20000}};
    for (size_t i = 0; i < GM_COUNT(sizes); i++) {
        int width = sizes[i][0], height = sizes[i][1];
        unsigned char *rgb = make_pixels(width, height);
        char message[MESSAGE] = "";
        assert_true(write_png(in_folder("a.png"), width, height, rgb, NULL, 0, message));
        check_pixels(in_folder("a.png"), width, height, rgb);
        unsigned char *read = malloc((size_t)width * (size_t)height * 3);
        assert_non_null(read);
        assert_true(gm_png_read(in_folder("a.png"), width, height, read, message));
        assert_memory_equal(read, rgb, (size_t)width * (size_t)height * 3);
        assert_false(gm_png_read(in_folder("a.png"), width + 1, height, read, message));
        assert_non_null(strstr(message, "it is not a picture of"));
        free(read);
        free(rgb);
    }
    assert_int_equal(folder_count(folder), 1);
}

/* Grey, and with an alpha that is opaque. */
static void pixels_of_others_are_read(void **state)
{
    (void)state;
    enum { WIDTH = 5, HEIGHT = 3 };
    const png_uint_32 formats[] = {PNG_FORMAT_GRAY, PNG_FORMAT_GA, PNG_FORMAT_RGBA};
    for (size_t i = 0; i < GM_COUNT(formats); i++) {
        const size_t channels = PNG_IMAGE_SAMPLE_CHANNELS(formats[i]);
        unsigned char given[4 * WIDTH * HEIGHT], read[3 * WIDTH * HEIGHT];
        for (size_t k = 0; k < channels * WIDTH * HEIGHT; k++) {
            given[k] = k % channels == 3 || (channels == 2 && k % 2 == 1) ? 255 : (unsigned char)(7 * k);
        }
        png_image image = {
            .version = PNG_IMAGE_VERSION, .width = WIDTH, .height = HEIGHT, .format = formats[i]};
        assert_int_not_equal(png_image_write_to_file(&image, in_folder("o.png"), 0, given, 0, NULL), 0);
        char message[MESSAGE] = "";
        assert_true(gm_png_read(in_folder("o.png"), WIDTH, HEIGHT, read, message));
        for (size_t k = 0; k < sizeof read; k++) {
            assert_int_equal(read[k], given[k / 3 * channels + (channels == 4 ? k % 3 : 0)]);
        }
    }
}

static const struct gm_png_text texts[] = {
    {"Software", "geomint 0.1.0"},
    {"geomint", "render disc scheme=rk4,midpoint dt=pi/12"},
    {"Title", "Fläche \xce\x94t = \xcf\x80/12, H\xe2\x82\x82"},
    {"Comment", ""},
    {"changes", "0 12 dt=0.1\n1 40 scheme=verlet\n"},
};
enum { TEXTS = GM_COUNT(texts) };

static void texts_survive(void **state)
{
    (void)state;
    unsigned char *rgb = make_pixels(5, 5);
    char message[MESSAGE] = "";
    assert_true(write_png(in_folder("t.png"), 5, 5, rgb, texts, TEXTS, message));
    check_pixels(in_folder("t.png"), 5, 5, rgb);
    for (size_t i = 0; i < TEXTS; i++) {
        char *text = gm_png_read_text(in_folder("t.png"), texts[i].key, message);
        assert_non_null(text);
        assert_string_equal(text, texts[i].text);
        free(text);
    }
    assert_null(gm_png_read_text(in_folder("t.png"), "absent", message));
    assert_non_null(strstr(message, "holds no text \"absent\""));
    free(rgb);
}

static void long_text_survives(void **state)
{
    (void)state;
    size_t length = 1 << 20;
    char *text = malloc(length + 1);
    assert_non_null(text);
    memset(text, 'x', length);
    text[length] = '\0';
    const struct gm_png_text one = {"changes", text};
    const unsigned char rgb[3] = {1, 2, 3};
    char message[MESSAGE] = "";
    assert_true(write_png(in_folder("long.png"), 1, 1, rgb, &one, 1, message));
    char *back = gm_png_read_text(in_folder("long.png"), "changes", message);
    assert_non_null(back);
    assert_string_equal(back, text);
    free(back);
    free(text);
}

/* Other programs write their texts behind the pixels. */
static void text_behind_pixels_is_found(void **state)
{
    (void)state;
    FILE *file = fopen(in_folder("behind.png"), "wb");
    assert_non_null(file);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, 2, 2, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    const unsigned char row[6] = {1, 2, 3, 4, 5, 6};
    png_write_row(png, row);
    png_write_row(png, row);
    char key[] = "geomint", packed[] = "list schemes";
    png_text text = {.compression = PNG_TEXT_COMPRESSION_zTXt, .key = key, .text = packed};
    png_set_text(png, info, &text, 1);
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    fclose(file);

    char message[MESSAGE] = "";
    char *found = gm_png_read_text(in_folder("behind.png"), "geomint", message);
    assert_non_null(found);
    assert_string_equal(found, "list schemes");
    free(found);
}

/* Several texts in one walk; those that the file lacks are NULL. */
static void texts_are_read_at_once(void **state)
{
    (void)state;
    const unsigned char rgb[3] = {1, 2, 3};
    const char *const keys[] = {"changes", "absent", "Title", "Comment"};
    char message[MESSAGE] = "", *read[4];
    assert_true(write_png(in_folder("t.png"), 1, 1, rgb, texts, TEXTS, message));
    assert_true(gm_png_read_texts(in_folder("t.png"), keys, read, 4, message));
    assert_string_equal(read[0], "0 12 dt=0.1\n1 40 scheme=verlet\n");
    assert_null(read[1]);
    assert_string_equal(read[2], texts[2].text);
    assert_string_equal(read[3], "");
    for (size_t i = 0; i < 4; i++) {
        free(read[i]);
    }
}

/* Texts have a limit, one by one and together; what is not asked for does not count. */
static void texts_have_a_limit(void **state)
{
    (void)state;
    const unsigned char rgb[3] = {1, 2, 3};
    const char *const keys[] = {"a", "b", "c"};
    char message[MESSAGE] = "", *read[3], *text = malloc(GM_PNG_TEXTS_MOST + 2);
    assert_non_null(text);
    memset(text, 'x', GM_PNG_TEXTS_MOST + 1);
    for (size_t length = GM_PNG_TEXTS_MOST / 2 - 100; length < GM_PNG_TEXTS_MOST; length += 200) {
        text[length] = '\0';
        const struct gm_png_text two[] = {{"a", text}, {"b", text}};
        assert_true(write_png(in_folder("l.png"), 1, 1, rgb, two, 2, message));
        text[length] = 'x';
        const bool fits = 2 * length < GM_PNG_TEXTS_MOST;
        assert_true(gm_png_read_texts(in_folder("l.png"), keys, read, 3, message) == fits);
        for (size_t i = 0; i < 3; i++) {
            assert_true((read[i] != NULL) == (fits && i < 2));
            free(read[i]);
        }
        if (!fits) {
            assert_non_null(strstr(message, "more than 4 MB"));
            break;
        }
    }
    free(text);
}

static void fails_with(const char *path, const char *reason)
{
    const unsigned char rgb[3] = {1, 2, 3};
    char message[MESSAGE] = "";
    assert_false(write_png(path, 1, 1, rgb, texts, TEXTS, message));
    assert_non_null(strstr(message, path));
    assert_non_null(strstr(message, reason));
}

static void unwritable_places_are_told(void **state)
{
    (void)state;
    fails_with("/dev/full", "No space left on device");
    fails_with("/proc/geomint.png", "No such file or directory");
    fails_with(in_folder("absent/a.png"), "No such file or directory");
    assert_int_equal(mkdir(in_folder("folder.png"), 0777), 0);
    fails_with(in_folder("folder.png"), "Is a directory");
    assert_int_equal(folder_count(folder), 1);
    if (geteuid() != 0) { /* root may write anywhere */
        assert_int_equal(mkdir(in_folder("closed"), 0555), 0);
        fails_with(in_folder("closed/a.png"), "Permission denied");
    }
}

static void name_too_long_is_told(void **state)
{
    (void)state;
    char name[301];
    memset(name, 'n', 300);
    name[300] = '\0';
    const unsigned char rgb[3] = {1, 2, 3};
    char message[MESSAGE] = "";
    assert_false(write_png(in_folder(name), 1, 1, rgb, NULL, 0, message));
    assert_non_null(strstr(message, "File name too long"));
    name[255] = '\0'; /* the longest that there is, so that the temporary one must be cut */
    assert_true(write_png(in_folder(name), 1, 1, rgb, NULL, 0, message));
    assert_int_equal(folder_count(folder), 1);
}

static void impossible_sizes_are_refused(void **state)
{
    (void)state;
    const unsigned char rgb[3] = {1, 2, 3};
    char message[MESSAGE] = "";
    assert_false(write_png(in_folder("a.png"), 0, 5, rgb, NULL, 0, message));
    assert_false(write_png(in_folder("a.png"), 5, -1, rgb, NULL, 0, message));
    assert_int_equal(folder_count(folder), 0);
}

static void devices_are_not_replaced(void **state)
{
    (void)state;
    const unsigned char rgb[3] = {1, 2, 3};
    char message[MESSAGE] = "", link[512];
    struct stat status;
    assert_true(write_png("/dev/null", 1, 1, rgb, NULL, 0, message));
    assert_int_equal(stat("/dev/null", &status), 0);
    assert_true(S_ISCHR(status.st_mode));
    /* as /dev/stdout is one */
    snprintf(link, sizeof link, "%s", in_folder("link.png"));
    assert_int_equal(symlink(in_folder("target.png"), link), 0);
    assert_true(write_png(link, 1, 1, rgb, NULL, 0, message));
    assert_int_equal(lstat(link, &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    check_pixels(in_folder("target.png"), 1, 1, rgb);
}

static void file_size_limit_is_told(void **state)
{
    (void)state;
    unsigned char *rgb = make_pixels(200, 200);
    unsigned char *before = make_pixels(3, 3);
    char message[MESSAGE] = "";
    assert_true(write_png(in_folder("a.png"), 3, 3, before, NULL, 0, message));

    struct rlimit limit, small;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    small = limit;
    small.rlim_cur = 10000;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    bool written = write_png(in_folder("a.png"), 200, 200, rgb, NULL, 0, message);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    signal(SIGXFSZ, handler);

    assert_false(written);
    assert_non_null(strstr(message, "File too large"));
    assert_non_null(strstr(message, "a.png"));
    check_pixels(in_folder("a.png"), 3, 3, before); /* what was there stays */
    assert_int_equal(folder_count(folder), 1);
    free(rgb);
    free(before);
}

static void write_bytes(const char *path, const unsigned char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* Reads a text of a file of these bytes; where one is found it must be a string, which strlen lets ASan
   see. */
static void read_from(const unsigned char *bytes, size_t size)
{
    char message[MESSAGE] = "";
    write_bytes(in_folder("bad.png"), bytes, size);
    char *text = gm_png_read_text(in_folder("bad.png"), "geomint", message);
    if (text) {
        assert_true(strlen(text) < 1 << 24);
    } else {
        assert_non_null(strstr(message, "bad.png"));
        assert_true(strlen(message) < MESSAGE);
    }
    free(text);
}

static void damaged_files_are_survived(void **state)
{
    (void)state;
    unsigned char *rgb = make_pixels(9, 9);
    char message[MESSAGE] = "";
    assert_true(write_png(in_folder("good.png"), 9, 9, rgb, texts, TEXTS, message));
    free(rgb);
    FILE *file = fopen(in_folder("good.png"), "rb");
    assert_non_null(file);
    static unsigned char good[4096], bad[4096];
    size_t size = fread(good, 1, sizeof good, file);
    fclose(file);
    assert_true(size > 100 && size < sizeof good);

    for (size_t cut = 0; cut < size; cut++) {
        read_from(good, cut);
    }
    uint32_t noise = 1;
    for (int i = 0; i < 4000; i++) {
        memcpy(bad, good, size);
        for (int k = 0; k < 1 + i % 4; k++) {
            noise = noise * 1664525 + 1013904223;
            bad[(noise >> 8) % size] = (unsigned char)(noise >> 24);
        }
        read_from(bad, size);
    }
}

static void other_files_are_told(void **state)
{
    (void)state;
    char message[MESSAGE] = "";
    assert_null(gm_png_read_text(in_folder("absent.png"), "geomint", message));
    assert_non_null(strstr(message, "No such file or directory"));
    assert_null(gm_png_read_text(folder, "geomint", message));
    assert_non_null(strstr(message, "Is a directory"));
    write_bytes(in_folder("text.png"), (const unsigned char *)"hello, this is no picture", 25);
    assert_null(gm_png_read_text(in_folder("text.png"), "geomint", message));
    assert_non_null(strstr(message, "not a PNG file"));
    write_bytes(in_folder("empty.png"), (const unsigned char *)"", 0);
    assert_null(gm_png_read_text(in_folder("empty.png"), "geomint", message));
    assert_non_null(strstr(message, "not a PNG file"));
    assert_null(gm_png_read_text("/dev/zero", "geomint", message));
    assert_non_null(strstr(message, "it is a device"));
    assert_int_equal(mkfifo(in_folder("pipe.png"), 0600), 0);
    assert_null(gm_png_read_text(in_folder("pipe.png"), "geomint", message));
    assert_non_null(strstr(message, "it is a pipe"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
        TEST(pixels_survive),
        TEST(pixels_of_others_are_read),
        TEST(texts_survive),
        TEST(long_text_survives),
        TEST(text_behind_pixels_is_found),
        TEST(texts_are_read_at_once),
        TEST(texts_have_a_limit),
        TEST(unwritable_places_are_told),
        TEST(name_too_long_is_told),
        TEST(impossible_sizes_are_refused),
        TEST(devices_are_not_replaced),
        TEST(file_size_limit_is_told),
        TEST(damaged_files_are_survived),
        TEST(other_files_are_told),
    };
    return cmocka_run_group_tests_name("png", tests, NULL, NULL);
}
