/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A lane as bytes, for checkpoints and copies. Bytes of a file are accepted only if a lane can have them. */
#include "scenes/common/lane_pack.h"

#include <stdlib.h>
#include <string.h>

/* One walk over the changing state of a lane measures, packs and unpacks it, so that all three agree. */

enum direction { MEASURE, PACK, UNPACK };

struct walk {
    enum direction direction;
    unsigned char *bytes;
    size_t used, size;
    bool damaged;
};

/* Returns the place of the next bytes; NULL when measuring, or behind the end. */
static unsigned char *take(struct walk *walk, size_t size)
{
    unsigned char *place = NULL;
    if (walk->direction != MEASURE) {
        walk->damaged = walk->damaged || size > walk->size - walk->used;
        place = walk->damaged ? NULL : walk->bytes + walk->used;
    }
    walk->used += place || walk->direction == MEASURE ? size : 0;
    return place;
}

static void pass(struct walk *walk, void *data, size_t size)
{
    unsigned char *place = take(walk, size);
    if (place && walk->direction == PACK) {
        memcpy(place, data, size);
    } else if (place) {
        memcpy(data, place, size);
    }
}

/* Passes the number of elements that follow; `bound` is the room for them. */
static void pass_count(struct walk *walk, size_t *count, size_t bound)
{
    size_t value = *count;
    pass(walk, &value, sizeof value);
    if (value > bound) {
        walk->damaged = true;
    } else {
        *count = value;
    }
}

static void pass_run(struct walk *walk, struct gm_run *run)
{
    unsigned char *place = take(walk, gm_run_snapshot_size(run));
    if (place && walk->direction == PACK) {
        gm_run_save(run, place);
    } else if (place) {
        walk->damaged = !gm_run_load(run, place);
    }
}

/* True if the steps of a record ascend and none exceeds `last`; `stride` is in bytes. */
static bool are_steps(const int64_t *steps, size_t count, size_t stride, int64_t last)
{
    int64_t before = 0;
    for (size_t i = 0; i < count; i++) {
        const int64_t step = *(const int64_t *)(const void *)((const char *)steps + i * stride);
        if (step < before || step > last) {
            return false;
        }
        before = step;
    }
    return true;
}

/* True if a number can be doubled or counted up without overflow. */
static bool can_grow(int64_t number)
{
    return number >= 0 && number <= INT64_MAX / 4;
}

static void pass_history(struct walk *walk, struct gm_history *history, int64_t last)
{
    pass_count(walk, &history->count, GM_HISTORY_BINS);
    pass(walk, &history->per_bin, sizeof history->per_bin);
    pass(walk, &history->in_last, sizeof history->in_last);
    pass(walk, history->bins, history->count * history->series * sizeof *history->bins);
    if (walk->direction == UNPACK) {
        history->kept = history->count;
        history->in_kept = history->in_last;
        walk->damaged |= history->per_bin < 1 || !can_grow(history->per_bin) || history->in_last < 0 ||
                         history->in_last > history->per_bin ||
                         !are_steps(&history->bins->step, history->series ? history->count : 0,
                                    history->series * sizeof *history->bins, last);
    }
}

static void pass_entries(struct walk *walk, struct gm_entries *entries, const struct gm_track *track,
                         int64_t last)
{
    pass_count(walk, &entries->count, track->bound);
    pass(walk, &entries->every, sizeof entries->every);
    pass(walk, &entries->skipped, sizeof entries->skipped);
    pass(walk, entries->before, entries->sections * sizeof *entries->before);
    pass(walk, entries->times, entries->count * sizeof *entries->times);
    pass(walk, entries->steps, entries->count * sizeof *entries->steps);
    pass(walk, entries->values, entries->count * entries->width * sizeof *entries->values);
    if (walk->direction == UNPACK) {
        entries->kept = entries->count;
        walk->damaged |= entries->every < 1 || !can_grow(entries->every) || !can_grow(entries->skipped) ||
                         (entries->count == 0 && !track->section) ||
                         !are_steps(entries->steps, entries->count, sizeof *entries->steps, last);
    }
}

static void walk_lane(struct walk *walk, struct gm_lane *lane)
{
    pass_run(walk, lane->run);
    const int64_t last = lane->run->steps;
    pass_history(walk, &lane->history, last);
    for (size_t i = 0; i < lane->scene->track_count; i++) {
        pass_entries(walk, &lane->entries[i], &lane->scene->tracks[i], last);
    }
    pass(walk, lane->angles, lane->scene->observable_count * sizeof *lane->angles);
    if (lane->behind.state) {
        pass(walk, lane->behind.state, gm_active_count(&lane->problem) * sizeof *lane->behind.state);
        pass(walk, &lane->behind.t, sizeof lane->behind.t);
    }
}

size_t gm_lane_pack_size(const struct gm_lane *lane)
{
    struct walk walk = {.direction = MEASURE};
    walk_lane(&walk, (struct gm_lane *)lane); /* measuring does not change it */
    return walk.used;
}

void gm_lane_pack(const struct gm_lane *lane, void *bytes)
{
    struct walk walk = {.direction = PACK, .bytes = bytes, .size = gm_lane_pack_size(lane)};
    walk_lane(&walk, (struct gm_lane *)lane);
}

bool gm_lane_unpack(struct gm_lane *lane, const void *bytes, size_t *size)
{
    struct walk walk = {.direction = UNPACK, .bytes = (unsigned char *)bytes, .size = *size};
    walk_lane(&walk, lane);
    *size = walk.used;
    return !walk.damaged;
}

struct gm_lane *gm_lane_copy(const struct gm_lane *lane)
{
    size_t size = gm_lane_pack_size(lane);
    struct gm_lane *copy = gm_lane_reopen(lane);
    void *bytes = malloc(size);
    bool good = copy && bytes;
    if (good) {
        gm_lane_pack(lane, bytes);
        good = gm_lane_unpack(copy, bytes, &size);
    }
    free(bytes);
    if (!good) {
        gm_lane_close(copy);
        return NULL;
    }
    return copy;
}
