/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checkpoints: what they keep, and those that were forged, whose checksum is right and which say what cannot
   be. The table of contents of an archive beyond 4 GB. */
#include "app/output/frames.h"

#include <libdeflate.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "app/data/format.h"
#include "app/words/drive.h"
#include "core/basics.h"
#include "render/picture/picture.h"
#include "scenes/common/lane_pack.h"
#include "tests/common/folder.h"

enum { LANES = 1, FRAMES = 4, FRAME = 1 };

static char folder[200], identity[] = "a render";

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

/* A render of one lane that stands behind frame FRAME, and its checkpoint as it lies in the file. */
struct render {
    struct gm_request request;
    struct gm_schedule schedule;
    struct gm_frames frames;
    char path[300];
    struct gm_lane *lane;
    unsigned char *bytes;
    size_t size, body; /* the file's size, and where its packed lane begins */
};

static struct gm_lane *open_lane(struct render *render)
{
    char message[GM_MESSAGE];
    struct gm_lane *lane = gm_request_open_lane(&render->request, 0, message);
    assert_non_null(lane);
    return lane;
}

static void read_bytes(struct render *render)
{
    FILE *file = fopen(render->path, "rb");
    assert_non_null(file);
    render->size = fread(render->bytes, 1, render->size, file);
    fclose(file);
}

static void open_render(struct render *render, char *words[], int count)
{
    char message[GM_MESSAGE];
    *render = (struct render){.size = 1 << 24};
    assert_true(gm_request_parse(&render->request, count, words, 1, message));
    const struct gm_timing *timing = render->request.lanes[0].parameters;
    render->schedule =
        (struct gm_schedule){.count = FRAMES, .last = timing->until, .shard = 1, .shards = 1, .ours = FRAMES};
    render->frames = (struct gm_frames){.schedule = &render->schedule, .identity = identity};
    snprintf(render->path, sizeof render->path, "%s/x.checkpoint", folder);
    render->lane = open_lane(render);
    struct gm_drive drive = {.lane = render->lane, .request = &render->request};
    const double t = gm_schedule_time(&render->schedule, FRAME);
    assert_true(gm_drive_until(&drive, t, true, message));
    assert_true(render->lane->run->steps > 0);
    const struct gm_lane *const lanes[LANES] = {render->lane};
    assert_true(gm_checkpoint_write(render->path, &render->frames, FRAME, lanes, LANES, message));
    render->bytes = malloc(render->size);
    assert_non_null(render->bytes);
    read_bytes(render);
    render->body = render->size - gm_lane_pack_size(render->lane);
}

static void close_render(struct render *render)
{
    gm_lane_close(render->lane);
    gm_request_close(&render->request);
    free(render->bytes);
}

enum {
    HEAD = 48,
    CHECKSUM = HEAD - 2 * sizeof(uint32_t),
    LANE_COUNT = HEAD - sizeof(uint32_t),
    POSITION = 32
};

static void write_bytes(const struct render *render, const unsigned char *bytes)
{
    FILE *file = fopen(render->path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, render->size, file), render->size);
    assert_int_equal(fclose(file), 0);
}

/* Writes the bytes with the checksum that they have: that of what is behind the head, and of the head, in which the
   checksum is 0. */
static void write_forged(const struct render *render, const unsigned char *bytes)
{
    unsigned char *copy = malloc(render->size);
    assert_non_null(copy);
    memcpy(copy, bytes, render->size);
    memset(copy + CHECKSUM, 0, sizeof(uint32_t));
    const uint32_t checksum =
        libdeflate_crc32(libdeflate_crc32(0, copy + HEAD, render->size - HEAD), copy, HEAD);
    memcpy(copy + CHECKSUM, &checksum, sizeof checksum);
    write_bytes(render, copy);
    free(copy);
}

/* Reads what lies in the file into a fresh lane. What is taken can be gone on with and drawn. */
static bool is_taken(struct render *render)
{
    struct gm_lane *lane = open_lane(render);
    long frame = -1;
    bool spoilt = false;
    const bool taken = gm_checkpoint_read(render->path, &render->frames, &frame, &lane, LANES, &spoilt);
    if (taken) {
        for (int i = 0; i < 5; i++) {
            gm_run_advance(lane->run, 1);
            gm_lane_record(lane);
        }
        struct gm_picture *picture = gm_picture_open();
        assert_non_null(picture);
        const struct gm_lane *const lanes[LANES] = {lane};
        gm_lanes_draw(lanes, LANES, picture);
        gm_picture_close(picture);
    }
    gm_lane_close(lane);
    return taken;
}

/* Whether a checkpoint is taken that has `size` other bytes at `place` of its body. */
static bool is_taken_with(struct render *render, size_t place, const void *value, size_t size)
{
    unsigned char *forged = malloc(render->size);
    assert_non_null(forged);
    memcpy(forged, render->bytes, render->size);
    memcpy(forged + render->body + place, value, size);
    write_forged(render, forged);
    free(forged);
    return is_taken(render);
}

static char disc[] = "disc", kepler[] = "kepler", rk4[] = "scheme=rk4", points[] = "points=5",
            collocation[] = "scheme=gauss4", compensated[] = "compensated=yes", section[] = "henon-heiles";

static char *requests[][4] = {
    {disc, rk4, points, NULL}, {kepler, collocation, compensated, NULL}, {section, NULL, NULL, NULL}};
enum { REQUESTS = GM_COUNT(requests) };

static int count_words(char *words[])
{
    int count = 0;
    while (words[count]) {
        count++;
    }
    return count;
}

/* The checksum tells a frame, or a number of lanes, that is not the one that was written. */
static void a_damaged_head_is_refused(void **unused)
{
    (void)unused;
    struct render render;
    open_render(&render, requests[0], count_words(requests[0]));
    const size_t places[] = {POSITION, CHECKSUM, LANE_COUNT, HEAD};
    for (size_t i = 0; i < GM_COUNT(places); i++) {
        render.bytes[places[i]] ^= 3;
        write_bytes(&render, render.bytes);
        assert_false(is_taken(&render));
        render.bytes[places[i]] ^= 3;
    }
    render.bytes[POSITION] = FRAME + 1; /* another frame is taken with its checksum */
    write_forged(&render, render.bytes);
    assert_true(is_taken(&render));
    close_render(&render);
}

static void impossible_runs_are_refused(void **unused)
{
    (void)unused;
    for (size_t r = 0; r < REQUESTS; r++) {
        struct render render;
        open_render(&render, requests[r], count_words(requests[r]));
        assert_true(is_taken(&render));
        write_forged(&render, render.bytes);
        assert_true(is_taken(&render));
        const struct gm_run *run = render.lane->run;
        const double not_a_number = NAN, infinite = INFINITY, other_dt = 2 * run->dt, far = 1e300;
        const long negative = -1, huge = INT64_MAX, one_more = run->steps + 1;
        const int two = 2, minus = -1, unknown = 77, other = !run->settings.compensated;
        const size_t vast = (size_t)1 << 40, none = 0;
        const size_t state = gm_run_snapshot_size(run) - run->half_size;
#define FORGED(member, value)                                                                                \
    assert_false(is_taken_with(&render, offsetof(struct gm_run, member), &(value), sizeof(value)))
        FORGED(current, two);
        FORGED(current, minus);
        FORGED(half_size, vast);
        FORGED(half_size, none);
        FORGED(n, negative);
        FORGED(n, huge);
        FORGED(n, one_more);
        FORGED(steps, negative);
        FORGED(steps, huge);
        FORGED(steps, one_more);
        FORGED(status, unknown);
        FORGED(status, minus);
        FORGED(t, not_a_number);
        FORGED(t, far);
        FORGED(t0, infinite);
        FORGED(t0, far);
        FORGED(dt, other_dt);
        FORGED(dt, not_a_number);
        FORGED(limit, not_a_number);
        FORGED(settings.compensated, other);
        assert_false(is_taken_with(&render, state, &not_a_number, sizeof not_a_number));
        assert_false(is_taken_with(&render, state, &infinite, sizeof infinite));
        close_render(&render);
    }
}

/* Whatever a word of the file says, it is refused, or can be lived with. */
static void any_word_is_survived(void **unused)
{
    (void)unused;
    const uint64_t values[] = {0,
                               1,
                               UINT64_MAX,
                               INT64_MAX,
                               UINT64_C(1) << 63,
                               UINT64_C(0x7fefffffffffffff),
                               UINT64_C(0x7ff0000000000000),
                               UINT64_C(0x7ff8000000000000)};
    for (size_t r = 0; r < REQUESTS; r++) {
        struct render render;
        open_render(&render, requests[r], count_words(requests[r]));
        const size_t words = gm_lane_pack_size(render.lane) / sizeof values[0];
        for (size_t i = 0; i < words; i += i < 64 ? 1 : 1 + words / 100) {
            for (size_t k = 0; k < GM_COUNT(values); k++) {
                is_taken_with(&render, i * sizeof values[0], &values[k], sizeof values[0]);
            }
        }
        close_render(&render);
    }
}

/* A frame that is not of the render, and a file that is none. */
static void other_files_are_refused(void **unused)
{
    (void)unused;
    struct render render;
    open_render(&render, requests[0], 3);
    unsigned char *forged = malloc(render.size);
    assert_non_null(forged);
    const int64_t frames[] = {-1, FRAMES, INT64_MAX, 0};
    for (size_t i = 0; i < GM_COUNT(frames); i++) {
        memcpy(forged, render.bytes, render.size);
        memcpy(forged + 32, &frames[i], sizeof frames[i]);
        write_forged(&render, forged);
        assert_false(is_taken(&render)); /* the state behind FRAME is too late for frame 0 */
    }
    free(forged);
    assert_int_equal(remove(render.path), 0);
    assert_int_equal(mkfifo(render.path, 0600), 0);
    assert_false(is_taken(&render));
    close_render(&render);
}

/* A number of `count` bytes, the lowest first. */
static uint64_t number_at(const unsigned char *bytes, size_t count)
{
    return count == 0 ? 0 : bytes[0] + 256 * number_at(bytes + 1, count - 1);
}

/* The table of contents of an array of 4.8 GB and of one after it, without the arrays: a file with them is too long for
   a test. Sizes and places that need 64 bits are in the extra field (APPNOTE.TXT 6.3.10, 4.3.12 and 4.5.3). */
static void archives_may_be_longer_than_4_gb(void **unused)
{
    (void)unused;
    enum { NUMBERS = 600000000, HEADER = 46, LOCAL = 30 + 20 };
    static const char *const names[] = {"large.npy", "after.npy"};
    char path[300];
    unsigned char table[1024] = {0};
    uint32_t crc;
    snprintf(path, sizeof path, "%s/large.npz", folder);
    FILE *file = fopen(path, "w+");
    assert_non_null(file);
    struct gm_bytes bytes = gm_bytes_of(fileno(file));
    struct gm_npz npz = {.file = &bytes};
    gm_npz_reserve(&npz, "large", &(struct gm_npz_shape){GM_NPZ_REAL, 1, {NUMBERS}}, &crc);
    gm_npz_reserve(&npz, "after", &(struct gm_npz_shape){GM_NPZ_REAL, 1, {3}}, &crc);
    npz.place = 0;
    gm_npz_finish(&npz);
    gm_npz_close(&npz);
    assert_int_equal(bytes.why, 0);
    assert_true(fread(table, 1, sizeof table, file) > 0);
    const unsigned char *at = table;
    uint64_t end = 0; /* of the array before */
    for (size_t i = 0; i < GM_COUNT(names); i++) {
        const size_t name = number_at(at + 28, 2), extra = number_at(at + 30, 2);
        const unsigned char *wide = at + HEADER + name;
        assert_true(number_at(at, 4) == 0x02014b50 && name == strlen(names[i]));
        assert_memory_equal(at + HEADER, names[i], name);
        /* both sizes and the place */
        assert_true(number_at(at + 20, 4) == UINT32_MAX && number_at(at + 24, 4) == UINT32_MAX &&
                    number_at(at + 42, 4) == UINT32_MAX);
        assert_true(number_at(wide, 2) == 1 && number_at(wide + 2, 2) == 3 * 8 && extra == 4 + 3 * 8);
        const uint64_t size = number_at(wide + 4, 8), numbers = i == 0 ? NUMBERS : 3;
        assert_true(size > 8 * numbers && size < 8 * numbers + 256 && number_at(wide + 12, 8) == size);
        assert_true(number_at(wide + 20, 8) == end);
        end += LOCAL + name + size;
        at = wide + extra;
    }
    assert_true(number_at(at, 4) == 0x06054b50);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(remove(path), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define TEST(name) cmocka_unit_test_setup_teardown(name, make_folder, remove_folder)
        TEST(a_damaged_head_is_refused), TEST(impossible_runs_are_refused),      TEST(any_word_is_survived),
        TEST(other_files_are_refused),   TEST(archives_may_be_longer_than_4_gb),
    };
    return cmocka_run_group_tests_name("checkpoint", tests, NULL, NULL);
}
