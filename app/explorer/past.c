/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "app/explorer/past.h"

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

/* Writes the lane into the moment; its memory stays NULL when there is none. */
static void save(const struct gm_lane *lane, struct gm_moment *moment)
{
    size_t size = lane->scene->size + gm_lane_snapshot_size(lane);
    if (moment->size != size) { /* schemes differ in what they keep */
        free(moment->memory);
        moment->memory = malloc(size);
        moment->size = moment->memory ? size : 0;
    }
    if (!moment->memory) {
        return;
    }
    memcpy(moment->memory, lane->parameters, lane->scene->size);
    gm_lane_save(lane, (char *)moment->memory + lane->scene->size);
    moment->steps = lane->run->steps;
    moment->scheme = lane->scheme;
}

void gm_past_note(struct gm_past *past, const struct gm_lane *lane, bool always)
{
    long steps = lane->run->steps;
    if (past->count > 0) {
        struct gm_moment *last = &past->moments[past->count - 1];
        if (last->steps == steps) {
            if (always) {
                save(lane, last);
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
        save(lane, &moment);
    }
    if (moment.memory) {
        past->moments[past->count++] = moment;
    }
}

bool gm_past_return(struct gm_past *past, struct gm_lane *lane, long steps)
{
    char sentence[GM_SENTENCE];
    while (past->count > 0 && past->moments[past->count - 1].steps > steps) {
        free(past->moments[--past->count].memory);
    }
    if (past->count == 0) {
        return false;
    }
    const struct gm_moment *last = &past->moments[past->count - 1];
    if (lane->scheme != last->scheme && !gm_lane_switch(lane, last->scheme, sentence)) {
        return false;
    }
    memcpy(lane->parameters, last->memory, lane->scene->size);
    gm_lane_load(lane, (const char *)last->memory + lane->scene->size);
    return true;
}
