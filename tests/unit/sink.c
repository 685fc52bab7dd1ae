/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Frames to files and movies: complete or not there, and a sentence where one cannot be made. */
#include <malloc.h>
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
#include "render/files/sink.h"
#include "tests/common/folder.h"

enum { MESSAGE = 512 };

static char folder[200];

static const char *in_folder(const char *name)
{
    static char path[4][512];
    static unsigned next;
    char *place = path[next++ % 4];
    snprintf(place, sizeof path[0], "%s/%s", folder, name);
    return place;
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

/* A frame that tells its number: its colour, and a dot that moves. */
static void paint(unsigned char *rgb, int width, int height, long number)
{
    size_t pixels = (size_t)width * (size_t)height;
    for (size_t i = 0; i < pixels; i++) {
        rgb[3 * i] = (unsigned char)(number % 256);
        rgb[3 * i + 1] = (unsigned char)(number / 256);
        rgb[3 * i + 2] = 128;
    }
    rgb[3 * ((size_t)number % pixels) + 2] = 255;
}

static bool put_frame(struct gm_sink *sink, int width, int height, long number)
{
    unsigned char *frame = gm_sink_frame(sink);
    if (!frame) {
        return false;
    }
    paint(frame, width, height, number);
    char time[32];
    snprintf(time, sizeof time, "%ld", number);
    const struct gm_png_text text = {"step", time};
    return gm_sink_put(sink, frame, number, &text, 1);
}

static void check_png(const char *path, int width, int height, long number)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_int_not_equal(png_image_begin_read_from_file(&image, path), 0);
    assert_int_equal(image.width, width);
    assert_int_equal(image.height, height);
    image.format = PNG_FORMAT_RGB;
    unsigned char *read = malloc(PNG_IMAGE_SIZE(image)), *expected = malloc(PNG_IMAGE_SIZE(image));
    assert_non_null(read);
    assert_non_null(expected);
    assert_int_not_equal(png_image_finish_read(&image, NULL, read, 0, NULL), 0);
    paint(expected, width, height, number);
    assert_memory_equal(read, expected, (size_t)width * (size_t)height * 3);
    free(read);
    free(expected);
}

static const struct gm_png_text common[] = {{"Software", "geomint"}, {"geomint", "render disc"}};

static void thousand_frames_arrive(void **state)
{
    (void)state;
    const struct gm_sink_settings settings = {
        .width = 64, .height = 36, .threads = 3, .texts = common, .text_count = 2};
    char message[MESSAGE] = "";
    struct gm_sink *sink = gm_sink_open_png(in_folder("disc-%06ld.png"), &settings, message);
    assert_non_null(sink);
    for (long n = 0; n < 1000; n++) {
        assert_true(put_frame(sink, 64, 36, n));
    }
    assert_true(gm_sink_close(sink, true, message));
    assert_int_equal(folder_count(folder), 1000);
    for (long n = 0; n < 1000; n++) {
        char name[32], step[32];
        snprintf(name, sizeof name, "disc-%06ld.png", n);
        snprintf(step, sizeof step, "%ld", n);
        check_png(in_folder(name), 64, 36, n);
        char *text = gm_png_read_text(in_folder(name), "step", message);
        assert_non_null(text);
        assert_string_equal(text, step);
        free(text);
        text = gm_png_read_text(in_folder(name), "geomint", message);
        assert_non_null(text);
        assert_string_equal(text, "render disc");
        free(text);
    }
}

static void memory_is_bounded(void **state)
{
    (void)state;
    const struct gm_sink_settings settings = {.width = 320, .height = 180, .threads = 2};
    char message[MESSAGE] = "";
    struct gm_sink *sink = gm_sink_open_png(in_folder("one.png"), &settings, message);
    assert_non_null(sink);
    size_t early = 0;
    for (long n = 0; n < 2000; n++) {
        assert_true(put_frame(sink, 320, 180, n));
        if (n == 100) {
            early = mallinfo2().uordblks;
        }
    }
    size_t late = mallinfo2().uordblks;
    /* in between at most one frame and what its encoder uses may differ */
    size_t frame = 320 * 180 * 3;
    assert_true(late < early + 4 * frame);
    assert_true(gm_sink_close(sink, true, message));
    check_png(in_folder("one.png"), 320, 180, 1999);
    assert_int_equal(folder_count(folder), 1);
}

static void pattern_is_the_names_alone(void **state)
{
    (void)state;
    const struct gm_sink_settings settings = {.width = 2, .height = 2};
    const struct {
        const char *pattern, *name;
    } cases[] = {
        {"a%d.png", "a7.png"},          {"a%3ld.png", "a  7.png"},
        {"50%-%02d.png", "50%-07.png"}, {"%d%s%n-%d.png", "%d%s%n-7.png"},
        {"plain%.png", "plain%.png"},   {"%99999999999d.png", "%99999999999d.png"},
    };
    assert_int_equal(mkdir(in_folder("100%d"), 0777), 0);
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        char pattern[64], name[64], message[MESSAGE] = "";
        snprintf(pattern, sizeof pattern, "100%%d/%s", cases[i].pattern);
        snprintf(name, sizeof name, "100%%d/%s", cases[i].name);
        struct gm_sink *sink = gm_sink_open_png(in_folder(pattern), &settings, message);
        assert_non_null(sink);
        assert_true(put_frame(sink, 2, 2, 7));
        assert_true(gm_sink_close(sink, true, message));
        check_png(in_folder(name), 2, 2, 7);
    }
}

static void first_failure_is_told(void **state)
{
    (void)state;
    const struct gm_sink_settings settings = {.width = 64, .height = 64, .threads = 2};
    char message[MESSAGE] = "";
    struct gm_sink *sink = gm_sink_open_png(in_folder("absent/%d.png"), &settings, message);
    assert_non_null(sink);
    long n = 0;
    while (n < 100 && put_frame(sink, 64, 64, n)) {
        n++;
    }
    assert_true(n < 100);
    assert_null(gm_sink_frame(sink));
    assert_false(gm_sink_close(sink, true, message));
    assert_non_null(strstr(message, "absent/"));
    assert_non_null(strstr(message, "No such file or directory"));
}

static void unused_sinks_close(void **state)
{
    (void)state;
    const struct gm_sink_settings settings = {.width = 8, .height = 8};
    char message[MESSAGE] = "";
    struct gm_sink *sink = gm_sink_open_png(in_folder("%d.png"), &settings, message);
    assert_non_null(sink);
    assert_non_null(gm_sink_frame(sink)); /* never put */
    assert_true(gm_sink_close(sink, false, message));
    assert_int_equal(folder_count(folder), 0);
}

/* What ffprobe or another command prints. */
static void output_of(const char *command, char *text, size_t size)
{
    FILE *pipe = popen(command, "r");
    assert_non_null(pipe);
    size_t length = fread(text, 1, size - 1, pipe);
    text[length] = '\0';
    assert_int_equal(pclose(pipe), 0);
}

static double probe(const char *path, const char *entry)
{
    char command[1024], text[256];
    snprintf(command, sizeof command,
             "ffprobe -v error -count_frames -select_streams v -show_entries %s -of default=nk=1:nw=1 '%s'",
             entry, path);
    output_of(command, text, sizeof text);
    return atof(text);
}

static void make_movie(const char *path, int width, int height, double fps, long frames)
{
    const struct gm_sink_settings settings = {.width = width, .height = height, .fps = fps};
    char message[MESSAGE] = "";
    struct gm_sink *sink = gm_sink_open_movie(path, &settings, message);
    assert_non_null(sink);
    for (long n = 0; n < frames; n++) {
        assert_true(put_frame(sink, width, height, n));
    }
    bool closed = gm_sink_close(sink, true, message);
    assert_string_equal(message, "");
    assert_true(closed);
}

static void movies_are_complete(void **state)
{
    (void)state;
    const struct {
        const char *name;
        int width, height, movie_width, movie_height;
        long frames, movie_frames;
    } cases[] = {
        {"a.mp4", 160, 90, 160, 90, 25, 34},   {"b.webm", 160, 90, 160, 90, 25, 34},
        {"c.gif", 160, 90, 160, 90, 25, 25},   {"odd size.mp4", 161, 91, 162, 92, 3, 12},
        {"odd%d.webm", 33, 31, 34, 32, 3, 12}, {"od:d%03d.gif", 33, 31, 33, 31, 3, 3},
        {"UPPER.MP4", 64, 64, 64, 64, 1, 10},
    };
    for (size_t i = 0; i < GM_COUNT(cases); i++) {
        const char *path = in_folder(cases[i].name);
        make_movie(path, cases[i].width, cases[i].height, 10, cases[i].frames);
        assert_int_equal(probe(path, "stream=nb_read_frames"), cases[i].movie_frames);
        assert_int_equal(probe(path, "stream=width"), cases[i].movie_width);
        assert_int_equal(probe(path, "stream=height"), cases[i].movie_height);
        /* the last frame stands for a second */
        double seconds = ((double)cases[i].frames - 1) / 10 + 1;
        double duration = probe(path, "format=duration");
        assert_true(duration > seconds - .06 && duration < seconds + .06);
        assert_int_equal(folder_count(folder), i + 1); /* no log, nothing temporary */
    }
}

/* The first and the last pixel of frame n of a movie. */
static void movie_colours_are_right(void **state)
{
    (void)state;
    const char *const names[] = {"a.mp4", "a.webm", "a.gif"};
    for (size_t i = 0; i < 3; i++) {
        make_movie(in_folder(names[i]), 32, 32, 25, 200);
        char command[1024];
        snprintf(command, sizeof command,
                 "ffmpeg -v error -i '%s' -frames:v 200 -f rawvideo -pix_fmt rgb24 - 2>&1",
                 in_folder(names[i]));
        size_t frame = (size_t)32 * 32 * 3, size = 200 * frame + 1;
        char *rgb = malloc(size);
        assert_non_null(rgb);
        output_of(command, rgb, size);
        for (size_t n = 0; n < 200; n += 9) {
            const unsigned char *last = (unsigned char *)rgb + (n + 1) * frame - 3;
            assert_in_range(last[0] + 10, n, n + 20); /* red is the number; YUV and the palette are coarse */
            assert_in_range(last[1], 0, 10);
            assert_in_range(last[2], 118, 138);
        }
        free(rgb);
    }
}

static void movies_can_be_given_up(void **state)
{
    (void)state;
    const struct gm_sink_settings settings = {.width = 64, .height = 64, .fps = 25};
    const char *const names[] = {"a.mp4", "a.webm", "a.gif"};
    for (size_t i = 0; i < 3; i++) {
        char message[MESSAGE] = "";
        struct gm_sink *sink = gm_sink_open_movie(in_folder(names[i]), &settings, message);
        assert_non_null(sink);
        for (long n = 0; n < 10; n++) {
            assert_true(put_frame(sink, 64, 64, n));
        }
        assert_true(gm_sink_close(sink, false, message));
        assert_int_equal(folder_count(folder), 0);
    }
}

static void movies_without_frames_are_told(void **state)
{
    (void)state;
    const struct gm_sink_settings settings = {.width = 64, .height = 64, .fps = 25};
    char message[MESSAGE] = "";
    struct gm_sink *sink = gm_sink_open_movie(in_folder("a.gif"), &settings, message);
    assert_non_null(sink);
    assert_false(gm_sink_close(sink, true, message));
    assert_non_null(strstr(message, "a.gif"));
    assert_int_equal(access(in_folder("a.gif"), F_OK), -1);
}

static void bad_movie_names_are_told(void **state)
{
    (void)state;
    const struct gm_sink_settings settings = {.width = 64, .height = 64, .fps = 25};
    char message[MESSAGE] = "";
    assert_null(gm_sink_open_movie(in_folder("a.avi"), &settings, message));
    assert_non_null(strstr(message, "a movie is an .mp4, .webm or .gif file"));
    assert_null(gm_sink_open_movie(".mp4", &settings, message));
    assert_null(gm_sink_open_movie(in_folder("absent/a.mp4"), &settings, message));
    assert_non_null(strstr(message, "No such file or directory"));
    assert_int_equal(mkdir(in_folder("folder.mp4"), 0777), 0);
    assert_null(gm_sink_open_movie(in_folder("folder.mp4"), &settings, message));
    assert_non_null(strstr(message, "folder.mp4"));
    assert_int_equal(folder_count(folder), 1);
}

static void missing_ffmpeg_is_told(void **state)
{
    (void)state;
    const struct gm_sink_settings settings = {.width = 64, .height = 64, .fps = 25};
    char message[MESSAGE] = "", *path = strdup(getenv("PATH"));
    setenv("PATH", folder, 1);
    struct gm_sink *sink = gm_sink_open_movie(in_folder("a.mp4"), &settings, message);
    setenv("PATH", path, 1);
    free(path);
    assert_null(sink);
    assert_string_equal(message, "ffmpeg was not found; install it, or leave out --movie to get PNG frames");
    assert_int_equal(folder_count(folder), 0);
}

/* Runs a movie of `frames` big frames with a script in ffmpeg's place. True if it was made. */
static bool run_with_fake(const char *script, long frames, char *message)
{
    const struct gm_sink_settings settings = {.width = 640, .height = 360, .fps = 25};
    char path[1024], *before = strdup(getenv("PATH"));
    assert_int_equal(mkdir(in_folder("bin"), 0777), 0);
    folder_script(in_folder("bin/ffmpeg"), script);
    snprintf(path, sizeof path, "%s:%s", in_folder("bin"), before);
    setenv("PATH", path, 1);
    message[0] = '\0';
    struct gm_sink *sink = gm_sink_open_movie(in_folder("a.mp4"), &settings, message);
    assert_non_null(sink);
    for (long n = 0; n < frames && put_frame(sink, 640, 360, n); n++) {
    }
    bool made = gm_sink_close(sink, true, message);
    setenv("PATH", before, 1);
    free(before);
    /* the folder of the script and, after a failure, the log */
    assert_int_equal(folder_count(folder), 2);
    return made;
}

static void dying_ffmpeg_is_told(void **state)
{
    (void)state;
    char message[MESSAGE];
    assert_false(
        run_with_fake("#!/bin/sh\nhead -c 1000000 >/dev/null\necho first\necho 'the encoder broke' >&2\n"
                      "echo 'Conversion failed!'\nexit 3\n",
                      50, message));
    assert_non_null(strstr(message, "exit status 3"));
    assert_non_null(strstr(message, "the encoder broke"));
    assert_non_null(strstr(message, "a.mp4"));
    assert_int_equal(access(in_folder("a.mp4.log"), R_OK), 0);
}

static void killed_ffmpeg_is_told(void **state)
{
    (void)state;
    char message[MESSAGE];
    assert_false(run_with_fake("#!/bin/sh\nhead -c 1000000 >/dev/null\nkill -9 $$\n", 50, message));
    assert_non_null(strstr(message, "signal (Killed)"));
}

static void ffmpeg_failing_at_the_end_is_told(void **state)
{
    (void)state;
    char message[MESSAGE];
    assert_false(
        run_with_fake("#!/bin/sh\ncat >/dev/null\necho 'No space left on device' >&2\nexit 1\n", 5, message));
    assert_non_null(strstr(message, "No space left on device"));
}

static void talkative_ffmpeg_does_not_hang(void **state)
{
    (void)state;
    char message[MESSAGE];
    /* more than a pipe holds on both of its outputs, and little interest in frames */
    assert_false(run_with_fake("#!/bin/sh\nhead -c 3000000 /dev/zero | tr '\\0' x\n"
                               "head -c 3000000 /dev/zero | tr '\\0' y >&2\nhead -c 10 >/dev/null\nexit 1\n",
                               50, message));
    assert_non_null(strstr(message, "exit status 1")); /* and not that it was given up */
}

static void deaf_ffmpeg_does_not_hang(void **state)
{
    (void)state;
    char message[MESSAGE];
    int before = gm_sink_movie_patience;
    gm_sink_movie_patience = 500;
    assert_false(run_with_fake("#!/bin/sh\nsleep 100000\n", 50, message));
    gm_sink_movie_patience = before;
    assert_non_null(strstr(message, "did nothing any more"));
}

static void endless_ffmpeg_does_not_hang(void **state)
{
    (void)state;
    char message[MESSAGE];
    int before = gm_sink_movie_patience;
    gm_sink_movie_patience = 500;
    assert_false(run_with_fake("#!/bin/sh\ncat >/dev/null\nsleep 100000\n", 5, message));
    gm_sink_movie_patience = before;
    assert_non_null(strstr(message, "did nothing any more"));
}

static void full_disk_under_a_movie_is_told(void **state)
{
    (void)state;
    struct rlimit limit, small;
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    small = limit;
    small.rlim_cur = 2000;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    const struct gm_sink_settings settings = {.width = 640, .height = 360, .fps = 25};
    char message[MESSAGE] = "";
    struct gm_sink *sink = gm_sink_open_movie(in_folder("a.mp4"), &settings, message);
    bool made = false;
    if (sink) {
        for (long n = 0; n < 100 && put_frame(sink, 640, 360, n); n++) {
        }
        made = gm_sink_close(sink, true, message);
    }
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    signal(SIGXFSZ, handler);
    assert_non_null(sink);
    assert_false(made);
    assert_non_null(strstr(message, "a.mp4"));
    assert_int_equal(folder_count(folder), 1); /* the log */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
        TEST(thousand_frames_arrive),
        TEST(memory_is_bounded),
        TEST(pattern_is_the_names_alone),
        TEST(first_failure_is_told),
        TEST(unused_sinks_close),
        TEST(movies_are_complete),
        TEST(movie_colours_are_right),
        TEST(movies_can_be_given_up),
        TEST(movies_without_frames_are_told),
        TEST(bad_movie_names_are_told),
        TEST(missing_ffmpeg_is_told),
        TEST(dying_ffmpeg_is_told),
        TEST(killed_ffmpeg_is_told),
        TEST(ffmpeg_failing_at_the_end_is_told),
        TEST(talkative_ffmpeg_does_not_hang),
        TEST(deaf_ffmpeg_does_not_hang),
        TEST(endless_ffmpeg_does_not_hang),
        TEST(full_disk_under_a_movie_is_told),
    };
    return cmocka_run_group_tests_name("sink", tests, NULL, NULL);
}
