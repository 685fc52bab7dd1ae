/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "scenes/lane_pack.h"

#include <stdlib.h>
#include <string.h>

/* One walk over everything that a lane becomes in time measures, packs and unpacks it, so that the three
   agree. */

enum direction { MEASURE, PACK, UNPACK };

struct walk {
    enum direction direction;
    unsigned char *bytes;
    size_t used, size;
    bool damaged;
};

static void pass(struct walk *walk, void *data, size_t size)
{
    if (walk->direction != MEASURE) {
        if (walk->damaged || size > walk->size - walk->used) {
            walk->damaged = true;
            return;
        }
        unsigned char *place = walk->bytes + walk->used;
        if (walk->direction == PACK) {
            memcpy(place, data, size);
        } else {
            memcpy(data, place, size);
        }
    }
    walk->used += size;
}

/* A count that says how much follows; `bound` is the room for it. */
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
    const size_t size = gm_run_snapshot_size(run);
    if (walk->direction == MEASURE) {
        walk->used += size;
        return;
    }
    if (walk->damaged || size > walk->size - walk->used) {
        walk->damaged = true;
        return;
    }
    if (walk->direction == PACK) {
        gm_run_save(run, walk->bytes + walk->used);
    } else {
        gm_run_load(run, walk->bytes + walk->used);
    }
    walk->used += size;
}

static void pass_history(struct walk *walk, struct gm_history *history)
{
    pass_count(walk, &history->count, GM_HISTORY_BINS);
    pass(walk, &history->per_bin, sizeof history->per_bin);
    pass(walk, &history->in_last, sizeof history->in_last);
    pass(walk, history->bins, history->count * history->series * sizeof *history->bins);
    if (walk->direction == UNPACK) {
        history->kept = history->count;
        history->in_kept = history->in_last;
    }
}

static void pass_entries(struct walk *walk, struct gm_entries *entries, size_t bound)
{
    pass_count(walk, &entries->count, bound);
    pass(walk, &entries->every, sizeof entries->every);
    pass(walk, &entries->skipped, sizeof entries->skipped);
    pass(walk, &entries->before, sizeof entries->before);
    pass(walk, entries->times, entries->count * sizeof *entries->times);
    pass(walk, entries->steps, entries->count * sizeof *entries->steps);
    pass(walk, entries->values, entries->count * entries->width * sizeof *entries->values);
    if (walk->direction == UNPACK) {
        entries->kept = entries->count;
    }
}

static void walk_lane(struct walk *walk, struct gm_lane *lane)
{
    pass_run(walk, lane->run);
    pass_history(walk, &lane->history);
    for (size_t i = 0; i < lane->scene->track_count; i++) {
        pass_entries(walk, &lane->entries[i], lane->scene->tracks[i].bound);
    }
    pass(walk, lane->angles, lane->scene->observable_count * sizeof *lane->angles);
    if (lane->behind) {
        pass(walk, lane->behind, gm_lane_active(lane) * sizeof *lane->behind);
        pass(walk, &lane->t_behind, sizeof lane->t_behind);
    }
}

size_t gm_lane_pack_size(const struct gm_lane *lane)
{
    struct walk walk = {.direction = MEASURE};
    walk_lane(&walk, (struct gm_lane *)lane); /* only looked at */
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
