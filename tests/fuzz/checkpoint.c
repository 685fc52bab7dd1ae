/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checkpoints with a right checksum whose bytes are changed anywhere: the first byte chooses a render, then
   nine bytes each say a place and what is written there. What is taken can be gone on with and drawn. */
#include <libdeflate.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "app/output/frames.h"
#include "app/words/drive.h"
#include "render/picture/picture.h"
#include "scenes/common/lane_pack.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool holds)
{
    if (!holds) {
        abort();
    }
}

enum { FRAMES = 4, FRAME = 1, RENDERS = 12, WORDS = 3 };

static char identity[] = "a render";

struct render {
    struct gm_request request;
    struct gm_schedule schedule;
    struct gm_frames frames;
    unsigned char *bytes; /* of the checkpoint */
    size_t size;
};

static void open_render(struct render *render, char *words[WORDS])
{
    char message[GM_MESSAGE], path[] = "/tmp/fuzz-checkpoint-XXXXXX";
    require(gm_request_parse(&render->request, WORDS, words, 1, message));
    const struct gm_timing *timing = render->request.lanes[0].parameters;
    const double t0 = gm_scene_t0(render->request.scene, timing);
    render->schedule = (struct gm_schedule){
        .count = FRAMES, .first = t0, .last = t0 + 12 * timing->dt, .shard = 1, .shards = 1, .ours = FRAMES};
    render->frames = (struct gm_frames){.schedule = &render->schedule, .identity = identity};
    struct gm_lane *lane = gm_request_open_lane(&render->request, 0, message);
    require(lane != NULL);
    struct gm_drive drive = {.lane = lane, .request = &render->request};
    require(gm_drive_to(&drive, 4, true, message));
    const int file = mkstemp(path);
    require(file >= 0);
    require(
        gm_checkpoint_write(path, &render->frames, FRAME, (const struct gm_lane *const[]){lane}, 1, message));
    close(file);
    FILE *stream = fopen(path, "rb");
    require(stream != NULL && fseek(stream, 0, SEEK_END) == 0);
    render->size = (size_t)ftell(stream);
    rewind(stream);
    render->bytes = malloc(render->size);
    require(render->bytes && fread(render->bytes, 1, render->size, stream) == render->size);
    fclose(stream);
    unlink(path);
    gm_lane_close(lane);
}

static struct render *render_at(size_t i)
{
    static struct render renders[RENDERS];
    static char words[RENDERS][WORDS][40] = {{"disc", "scheme=rk4", "points=8"},
                                             {"kepler", "scheme=gauss4", "eccentricity=0.5"},
                                             {"henon-heiles", "scheme=rk4", "dt=0.1"},
                                             {"kepler", "scheme=levi-civita", "eccentricity=0.5"},
                                             {"oscillator", "scheme=variational-midpoint", "dt=0.1"},
                                             {"sine-gordon", "scheme=leapfrog", "points=40"},
                                             {"kepler", "scheme=dopri5", "eccentricity=0.5"},
                                             {"bouncing-ball", "scheme=gauss4", "dt=0.3"},
                                             {"kdv", "scheme=box", "points=40"},
                                             {"soliton", "scheme=multiplier-lobatto4", "points=15"},
                                             {"room", "rows=10", "tracers=5"},
                                             {"form-heat", "scheme=rk4", "level=1"}};
    struct render *render = &renders[i];
    if (!render->bytes) {
        open_render(render, (char *[]){words[i][0], words[i][1], words[i][2]});
    }
    return render;
}

static void go_on(struct gm_lane *lane)
{
    for (int i = 0; i < 4; i++) {
        gm_run_advance(lane->run, 1);
        gm_lane_record(lane);
    }
    struct gm_picture *picture = gm_picture_open();
    require(picture != NULL);
    const struct gm_lane *const lanes[] = {lane};
    gm_lanes_draw(lanes, 1, picture);
    gm_picture_close(picture);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size == 0) {
        return 0;
    }
    struct render *render = render_at(data[0] % RENDERS);
    unsigned char *forged = malloc(render->size);
    require(forged != NULL);
    memcpy(forged, render->bytes, render->size);
    for (const uint8_t *at = data + 1; data + size - at >= 10; at += 10) {
        size_t place = 8 * (size_t)(at[0] | at[1] << 8);
        /* mostly at its front, where the numbers are that others depend on */
        place = place % (at[1] < 192 ? 1024 : render->size - 8);
        memcpy(forged + (place + 8 <= render->size ? place : 0), at + 2, 8);
    }
    enum { HEAD = 48, CHECKSUM = 40 };
    memset(forged + CHECKSUM, 0, sizeof(uint32_t));
    const uint32_t checksum =
        libdeflate_crc32(libdeflate_crc32(0, forged + HEAD, render->size - HEAD), forged, HEAD);
    memcpy(forged + CHECKSUM, &checksum, sizeof checksum);

    static int file = -1;
    file = file < 0 ? memfd_create("checkpoint", MFD_CLOEXEC) : file;
    char path[64], message[GM_MESSAGE];
    require(file >= 0 && ftruncate(file, 0) == 0 &&
            pwrite(file, forged, render->size, 0) == (ssize_t)render->size);
    free(forged);
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    struct gm_lane *lane = gm_request_open_lane(&render->request, 0, message);
    require(lane != NULL);
    long frame = -1;
    bool spoilt = false;
    if (gm_checkpoint_read(path, &render->frames, &frame, &lane, 1, &spoilt)) {
        require(frame >= 0 && frame < FRAMES);
        go_on(lane);
    }
    gm_lane_close(lane);
    return 0;
}
