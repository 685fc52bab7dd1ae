/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The way back of a lane: snapshots in bounded memory, thinned when they are full. */
#include "app/runs/past.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_MOMENTS = 4096 };

void gm_past_close(struct gm_past *past)
{
    for (size_t i = 0; i < past->count; i++) {
        free(past->moments[i].memory);
    }
    free(past->moments);
    *past = (struct gm_past){0};
}

void gm_past_set(struct gm_past *past, const struct gm_parameter *row, const char *text)
{
    for (size_t i = 0; i < past->count; i++) {
        gm_parameter_set(row, past->moments[i].memory, text);
    }
}

static void thin(struct gm_past *past)
{
    size_t kept = 0;
    for (size_t i = 0; i < past->count; i++) {
        if (i % 2 == 0) {
            past->moments[kept++] = past->moments[i];
        } else {
            free(past->moments[i].memory);
        }
    }
    past->count = kept;
    past->every *= 2;
}

void gm_past_limit(struct gm_past *past, size_t bound)
{
    past->bound = bound < MOST_MOMENTS ? bound : MOST_MOMENTS;
    while (past->count > past->bound && past->count > 1) {
        thin(past);
    }
}

struct gm_past gm_past_copy(const struct gm_past *past)
{
    struct gm_past copy = {.bound = past->bound, .every = past->every};
    copy.moments = past->count > 0 ? malloc(MOST_MOMENTS * sizeof *copy.moments) : NULL;
    for (size_t i = 0; copy.moments && i < past->count; i++) {
        struct gm_moment *moment = &copy.moments[i];
        *moment = past->moments[i];
        moment->memory = malloc(moment->size);
        if (!moment->memory) {
            gm_past_close(&copy);
            return (struct gm_past){.bound = past->bound, .every = past->every};
        }
        memcpy(moment->memory, past->moments[i].memory, moment->size);
        copy.count++;
    }
    return copy;
}

/* Bytes from a moment's start to its snapshot: the parameters, of any size (a system's texts), and the
   padding for the snapshot's alignment. */
static size_t snapshot_at(const struct gm_lane *lane)
{
    const size_t unit = _Alignof(max_align_t);
    return (lane->scene->size + unit - 1) / unit * unit;
}

/* Writes the lane into the moment; its memory stays NULL when out of memory. */
static void save(const struct gm_lane *lane, double gone, struct gm_moment *moment)
{
    size_t size = snapshot_at(lane) + gm_lane_snapshot_size(lane);
    if (moment->size != size) { /* the size depends on the scheme */
        free(moment->memory);
        moment->memory = malloc(size);
        moment->size = moment->memory ? size : 0;
    }
    if (!moment->memory) {
        return;
    }
    memcpy(moment->memory, lane->parameters, lane->scene->size);
    gm_lane_save(lane, (char *)moment->memory + snapshot_at(lane));
    moment->steps = lane->run->steps;
    moment->gone = gone;
}

void gm_past_note(struct gm_past *past, const struct gm_lane *lane, double gone, bool always)
{
    int64_t steps = lane->run->steps;
    gm_past_forget(past, steps);
    if (past->count > 0) {
        struct gm_moment *last = &past->moments[past->count - 1];
        if (last->steps == steps) {
            if (always) {
                save(lane, gone, last);
            }
            if (!last->memory) {
                past->count--;
            }
            return;
        }
        if (!always && steps - last->steps < past->every) {
            return;
        }
    }
    if (past->bound < 2) { /* an ensemble so large that its budget holds nothing worth having */
        return;
    }
    if (past->count == past->bound) {
        thin(past);
    }
    if (!past->moments) {
        past->moments = malloc(MOST_MOMENTS * sizeof *past->moments);
    }
    struct gm_moment moment = {0};
    if (past->moments) {
        save(lane, gone, &moment);
    }
    if (moment.memory) {
        past->moments[past->count++] = moment;
    }
}

const struct gm_moment *gm_past_return(const struct gm_past *past, struct gm_lane *lane, int64_t steps,
                                       double gone)
{
    size_t count = past->count;
    while (count > 0 && past->moments[count - 1].steps > steps) {
        count--;
    }
    while (count > 1 && past->moments[count - 1].gone > gone) {
        count--;
    }
    const struct gm_moment *moment = count > 0 ? &past->moments[count - 1] : NULL;
    if (!moment || !gm_lane_load(lane, (const char *)moment->memory + snapshot_at(lane))) {
        return NULL;
    }
    memcpy(lane->parameters, moment->memory, lane->scene->size);
    return moment;
}

void gm_past_forget(struct gm_past *past, int64_t steps)
{
    while (past->count > 0 && past->moments[past->count - 1].steps > steps) {
        free(past->moments[--past->count].memory);
    }
}
