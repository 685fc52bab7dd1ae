/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Many values a run: the last ones of a component or an observable, after each step, at each passage of the section, or
   at each maximum, where the parabola through three values has its vertex. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/interrupt.h"
#include "app/grid/sweep.h"
#include "app/words/drive.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/expression/nearest.h"
#include "core/expression/number.h"
#include "core/memory.h"
#include "core/quantity.h"

enum { MOST_VALUES = 1000000, PASSAGES = 16 /* in a step */ };

static const char *const places[] = {"step", "section", "maximum"};

/* The names that values may have: components, then observables. */
struct names {
    struct gm_arena *arena;
    const struct gm_lane *lane;
    size_t components;
};

static const char *name_at(size_t i, const void *data)
{
    const struct names *names = data;
    return i < names->components ? gm_component_name(names->arena, names->lane->run, i)
                                 : gm_scene_observable_at(names->lane->scene, i - names->components)->key;
}

void gm_sweep_read_values(struct gm_sweep *sweep, const char *values, const char *at,
                          const struct gm_lane *lane)
{
    struct gm_arena *arena = sweep->arena;
    const struct gm_scene *scene = lane->scene;
    const size_t length = strcspn(values, ":");
    const struct names names = {arena, lane, lane->problem.n - 2 * lane->problem.passive};
    const size_t count = names.components + scene->observable_count;
    double kept = NAN;
    gm_arena_refuse_if(
        arena,
        !values[length] || !gm_number_parse(values + length + 1, &kept) || !(kept >= 1) ||
            kept > MOST_VALUES || kept != floor(kept),
        "--values %.60s is not NAME:K, the last K values of a component or an observable, K from "
        "1 to 1e6",
        values);
    sweep->values = gm_arena_print(arena, "%s", values);
    sweep->name = gm_arena_print(arena, "%.*s", (int)length, values);
    sweep->kept = (size_t)kept;
    for (sweep->number = 0; sweep->number < count; sweep->number++) {
        if (strcmp(name_at(sweep->number, &names), sweep->name) == 0) {
            break;
        }
    }
    const char *near = sweep->number == count ? gm_nearest(sweep->name, count, name_at, &names) : NULL;
    gm_arena_refuse_if(arena, sweep->number == count,
                       "--values: %.60s is not a component or an observable of %s%s%s", sweep->name,
                       scene->name, near ? "; did you mean " : "", near ? near : "");
    const bool has_section = gm_scene_section(scene) < scene->track_count;
    sweep->place = has_section && fabs(lane->run->dt) != 1 ? GM_AT_SECTION : GM_AT_STEP;
    if (at) {
        size_t place = 0;
        while (place < GM_COUNT(places) && strcmp(places[place], at) != 0) {
            place++;
        }
        gm_arena_refuse_if(arena, place == GM_COUNT(places), "--at %.60s is none of: step, section, maximum",
                           at);
        sweep->place = (enum gm_sweep_place)place;
    }
    gm_arena_refuse_if(arena, sweep->place == GM_AT_SECTION && !has_section,
                       "--at section: %s has no section: in its file", scene->name);
    sweep->at = places[sweep->place];
}

/* Returns the value of a view, of its last member if it is a component. */
static double value_of(const struct gm_sweep *sweep, const struct gm_view *view)
{
    const size_t components = view->problem->n - 2 * view->problem->passive, m = view->problem->m;
    return sweep->number < components
               ? view->state[sweep->number * m + m - 1]
               : gm_observe(gm_scene_observable_at(sweep->scene, sweep->number - components), view);
}

static void record(const struct gm_view *view, double *entry)
{
    memcpy(entry, view->state, gm_active_count(view->problem) * sizeof *entry);
}

struct following {
    const struct gm_sweep *sweep;
    struct gm_drive *drive;
    int64_t steps;
    struct gm_sweep_series *series;
    double last[3][2]; /* t and value of the last steps, the newest first */
};

static void push(const struct following *following, double t, double value)
{
    struct gm_sweep_series *series = following->series;
    double *pair = series->pairs + 2 * (series->count++ % following->sweep->kept);
    pair[0] = t;
    pair[1] = value;
}

/* Takes a maximum at the middle of the last three values. */
static void push_maximum(const struct following *following)
{
    const double(*last)[2] = following->last;
    const double left = last[1][1] - last[2][1], right = last[1][1] - last[0][1], h = last[0][0] - last[1][0];
    if (following->drive->lane->run->steps >= 2 && left > 0 && right >= 0) {
        const double from = (left - right) / (2 * (left + right)); /* of the middle, in steps */
        push(following, last[1][0] + from * h, last[1][1] + from * (left - right) / 4);
    }
}

static void follow(struct gm_arena *arena, void *data)
{
    struct following *following = data;
    const struct gm_sweep *sweep = following->sweep;
    struct gm_lane *lane = following->drive->lane;
    char message[GM_MESSAGE];
    struct gm_track track = {0};
    struct gm_entries entries = {0};
    struct gm_behind behind = {0};
    const struct gm_view start = gm_lane_view(lane);
    if (sweep->place == GM_AT_SECTION) {
        track = sweep->scene->tracks[gm_scene_section(sweep->scene)];
        track.numbers = gm_active_count(&lane->problem);
        track.record = record;
        track.each = false;
        track.bound = PASSAGES;
        gm_entries_open(arena, &entries, &track, &start, &behind);
        gm_entries_record(&entries, &track, &start, &behind);
        gm_behind_note(&behind, &start);
    } else if (sweep->place == GM_AT_STEP && !lane->scheme->family->adaptive &&
               !(lane->problem.events && lane->problem.events->ends_runs)) {
        gm_drive_to(following->drive, following->steps - (int64_t)sweep->kept, false, message);
    }
    following->last[0][0] = lane->run->t;
    following->last[0][1] = value_of(sweep, &start);
    while (lane->run->status == GM_OK && !gm_interrupted &&
           gm_drive_goes_on(following->drive, following->steps) &&
           gm_drive_to(following->drive, lane->run->steps + 1, false, message) &&
           lane->run->status == GM_OK) {
        struct gm_view view = gm_lane_view(lane);
        memmove(following->last[1], following->last[0], 2 * sizeof *following->last);
        following->last[0][0] = view.t;
        following->last[0][1] = value_of(sweep, &view);
        if (sweep->place == GM_AT_STEP) {
            push(following, view.t, following->last[0][1]);
        } else if (sweep->place == GM_AT_MAXIMUM) {
            push_maximum(following);
        } else {
            gm_entries_record(&entries, &track, &view, &behind);
            gm_behind_note(&behind, &view);
            for (size_t i = 0; i < entries.count; i++) {
                view.state = entries.values + i * entries.width;
                view.t = entries.times[i];
                push(following, view.t, value_of(sweep, &view));
            }
            entries.count = 0;
        }
    }
}

bool gm_sweep_follow(const struct gm_sweep *sweep, struct gm_drive *drive, int64_t steps,
                     struct gm_sweep_series *series)
{
    *series = (struct gm_sweep_series){.pairs = calloc(2 * sweep->kept, sizeof *series->pairs)};
    return series->pairs &&
           gm_arena_run_once(
               follow, &(struct following){.sweep = sweep, .drive = drive, .steps = steps, .series = series});
}
