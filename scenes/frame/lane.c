/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lanes: opened, advanced, looked at, switched and copied, with the bounded records of their past. */
#include "scenes/frame/lane.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "core/ode/kernel/loops.h"
#include "scenes/frame/lane_pack.h"

enum { MOST_OBSERVABLES = 64 };

static const struct gm_timing *timing(const struct gm_lane *lane)
{
    return lane->parameters;
}

struct gm_view gm_lane_view(const struct gm_lane *lane)
{
    return (struct gm_view){
        .parameters = lane->parameters,
        .problem = &lane->problem,
        .scheme = lane->scheme,
        .start = lane->start,
        .state = gm_run_state(lane->run),
        .t0 = lane->t0,
        .t = lane->run->t,
        .dt = lane->run->dt,
        .memory = gm_run_memory(lane->run),
        .tracks = lane->entries,
        .run = lane->run,
    };
}

/* What an error is divided by, and the value at the start. */
static double divisor_of(const struct gm_observable *observable, const struct gm_view *view, double *initial)
{
    struct gm_view before = *view;
    before.state = view->start;
    before.t = view->t0;
    *initial = observable->evaluate(&before);
    const double divisor = fmax(fabs(*initial), observable->scale ? observable->scale(view->parameters) : 0);
    return divisor > 0 ? divisor : 1;
}

/* `near`: where an angle was when it was last looked at */
static double observe(const struct gm_observable *observable, const struct gm_view *view, double near)
{
    const double value = observable->evaluate(view);
    if (observable->period > 0) {
        return value + observable->period * round((near - value) / observable->period);
    }
    if (!observable->error) {
        return value;
    }
    double initial = 0;
    const double divisor = divisor_of(observable, view, &initial);
    return fabs(value - initial) / divisor;
}

double gm_lane_observe(const struct gm_lane *lane, size_t observable)
{
    const struct gm_view view = gm_lane_view(lane);
    const unsigned long refusals = gm_memory_refusals();
    const double value = observe(&lane->scene->observables[observable], &view, lane->angles[observable]);
    return gm_memory_refusals() == refusals ? value : NAN;
}

double gm_lane_divisor(const struct gm_lane *lane, size_t observable)
{
    const struct gm_view view = gm_lane_view(lane);
    double initial = 0;
    return divisor_of(&lane->scene->observables[observable], &view, &initial);
}

long gm_lane_lost(const struct gm_lane *lane)
{
    const struct gm_view view = gm_lane_view(lane);
    double most = 0;
    long lost = -1;
    for (size_t i = 0; lane->run->status == GM_OK && i < lane->scene->observable_count; i++) {
        const struct gm_observable *observable = &lane->scene->observables[i];
        if (!observable->kept) {
            continue;
        }
        double initial = 0;
        const double divisor = divisor_of(observable, &view, &initial), value = observable->evaluate(&view);
        const double error = fabs(value - initial) / divisor;
        /* against a scale above it, what was small at the start may be smaller and no less right */
        const bool decayed = divisor == fabs(initial) && fabs(value) < GM_LOST_BELOW * divisor;
        if ((error > GM_LOST_ABOVE || decayed) && error > most) {
            most = error;
            lost = (long)i;
        }
    }
    return lost;
}

void gm_lane_warning(const struct gm_lane *lane, char *text, size_t size)
{
    const long lost = gm_lane_lost(lane);
    text[0] = '\0';
    if (lost < 0) {
        return;
    }
    const struct gm_observable *observable = &lane->scene->observables[lost];
    const struct gm_view view = gm_lane_view(lane);
    const double error = gm_lane_observe(lane, (size_t)lost);
    if (error > GM_LOST_ABOVE) {
        snprintf(text, size, "%s is %.3g: what the exact motion keeps is lost", observable->key, error);
    } else {
        double initial = 0;
        divisor_of(observable, &view, &initial);
        snprintf(text, size, "%s is %.3g: of what the exact motion keeps a part of %.1e is left",
                 observable->key, error, observable->evaluate(&view) / initial);
    }
}

static double *entry_values(const struct gm_entries *entries, size_t index)
{
    return entries->values + index * entries->width;
}

static void thin(struct gm_entries *entries)
{
    size_t kept = 0;
    for (size_t i = 0; i < entries->count; i += 2, kept++) {
        entries->times[kept] = entries->times[i];
        entries->steps[kept] = entries->steps[i];
        memmove(entry_values(entries, kept), entry_values(entries, i), entries->width * sizeof(double));
    }
    entries->count = kept;
    entries->every *= 2;
}

/* Forgets the older half. */
static void forget(struct gm_entries *entries)
{
    const size_t kept = entries->count / 2, gone = entries->count - kept;
    memmove(entries->times, entries->times + gone, kept * sizeof(double));
    memmove(entries->steps, entries->steps + gone, kept * sizeof *entries->steps);
    memmove(entries->values, entry_values(entries, gone), kept * entries->width * sizeof(double));
    entries->count = kept;
}

/* How many whole intervals lie between t0 and t; a step that misses one by round-off has made it. */
static double intervals(const struct gm_lane *lane, double interval, double t)
{
    return floor(fabs(t - lane->t0) / interval * (1 + 1e-12) + 1e-9);
}

size_t gm_lane_active(const struct gm_lane *lane)
{
    return (lane->problem.n - 2 * lane->problem.passive) * lane->problem.m;
}

/* Makes an entry if the section was passed upwards in the step that ended in `view`. Between the two states
   the cubic is taken that has the field's slopes at both ends; its error is of order 4 in the step. */
static void record_crossing(struct gm_lane *lane, const struct gm_track *track, struct gm_entries *entries,
                            const struct gm_view *view)
{
    const double after = track->section(view), before = entries->before;
    entries->before = after;
    if (!(before < 0 && after >= 0 && lane->t_behind != view->t)) {
        return;
    }
    const size_t active = gm_lane_active(lane);
    double *slopes = lane->behind + active, *between = slopes + 2 * active;
    const double h = view->t - lane->t_behind;
    const struct gm_loops *loops = gm_ode_of(&lane->problem)->loops[gm_isa_best()];
    loops->field(&lane->problem, lane->behind, slopes, lane->problem.m);
    loops->field(&lane->problem, view->state, slopes + active, lane->problem.m);
    struct gm_view there = *view;
    there.state = between;
    double low = 0, high = 1, below = before, above = after;
    /* regula falsi with bisection in between, so that neither end stands still */
    for (int i = 0; i < 60 && high - low > 1e-15; i++) {
        const double secant = low - below * (high - low) / (above - below);
        const double s = i % 3 < 2 && secant > low && secant < high ? secant : (low + high) / 2, r = 1 - s;
        for (size_t c = 0; c < active; c++) {
            between[c] = r * r * (1 + 2 * s) * lane->behind[c] + s * s * (3 - 2 * s) * view->state[c] +
                         h * s * r * (r * slopes[c] - s * slopes[active + c]);
        }
        there.t = lane->t_behind + s * h;
        const double value = track->section(&there);
        if (value == 0) {
            break;
        }
        if (value > 0) {
            high = s;
            above = value;
        } else {
            low = s;
            below = value;
        }
    }
    if (entries->count == track->bound) {
        thin(entries);
        entries->skipped = 0;
    }
    if (entries->skipped > 0) {
        entries->skipped--;
        return;
    }
    entries->skipped = entries->every - 1;
    entries->times[entries->count] = there.t;
    entries->steps[entries->count] = lane->run->steps;
    track->record(&there, entry_values(entries, entries->count));
    entries->kept = ++entries->count;
}

/* While time runs backwards, a record of all the past unwinds: what is later than t is not shown, but for the
   start. */
static void unwind(struct gm_entries *entries, double t)
{
    while (entries->count > 1 && entries->times[entries->count - 1] > t) {
        entries->count--;
    }
}

static void record_tracks(struct gm_lane *lane, const struct gm_view *view)
{
    for (size_t i = 0; i < lane->scene->track_count; i++) {
        const struct gm_track *track = &lane->scene->tracks[i];
        struct gm_entries *entries = &lane->entries[i];
        if (!track->section && !track->recent && view->dt < 0 && view->t >= lane->t0) {
            unwind(entries, view->t);
            continue;
        }
        entries->kept = entries->count; /* the lane goes on from here */
        if (track->section) {
            record_crossing(lane, track, entries, view);
            continue;
        }
        if (entries->count > 0) {
            const double last = entries->times[entries->count - 1];
            const double interval = track->interval(lane->parameters) * (double)entries->every;
            const bool due = interval > 0
                                 ? intervals(lane, interval, view->t) != intervals(lane, interval, last)
                                 : view->t != last;
            if (!due) {
                continue;
            }
        }
        if (entries->count == track->bound) {
            if (track->recent) {
                forget(entries);
            } else {
                thin(entries);
            }
        }
        entries->times[entries->count] = view->t;
        entries->steps[entries->count] = lane->run->steps;
        track->record(view, entry_values(entries, entries->count));
        entries->kept = ++entries->count;
    }
    if (lane->behind) {
        memcpy(lane->behind, view->state, gm_lane_active(lane) * sizeof(double));
        lane->t_behind = view->t;
    }
}

/* An angle is unwrapped from where it was, so it has to be followed. */
static void follow_angles(struct gm_lane *lane, const struct gm_view *view)
{
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        const struct gm_observable *observable = &lane->scene->observables[i];
        if (observable->period > 0) {
            const double angle = observe(observable, view, lane->angles[i]);
            lane->angles[i] = isfinite(angle) ? angle : lane->angles[i];
        }
    }
}

/* A lane stands still where there was no memory to look at it. */
static void settle(struct gm_lane *lane, unsigned long refusals)
{
    if (gm_memory_refusals() != refusals) {
        lane->run->status = GM_OUT_OF_MEMORY;
    }
}

void gm_lane_follow(struct gm_lane *lane)
{
    const struct gm_view view = gm_lane_view(lane);
    const unsigned long refusals = gm_memory_refusals();
    follow_angles(lane, &view);
    record_tracks(lane, &view);
    settle(lane, refusals);
}

enum gm_status gm_lane_advance(struct gm_lane *lane, long steps)
{
    const long follow = lane->scene->follow;
    while (steps > 0 && lane->run->status == GM_OK) {
        const long burst = follow > 0 && follow < steps ? follow : steps;
        gm_run_advance(lane->run, burst);
        steps -= burst;
        if (follow > 0) {
            gm_lane_follow(lane);
        }
    }
    return lane->run->status;
}

void gm_lane_record(struct gm_lane *lane)
{
    const struct gm_view view = gm_lane_view(lane);
    double values[MOST_OBSERVABLES];
    const unsigned long refusals = gm_memory_refusals();
    follow_angles(lane, &view);
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        values[i] = observe(&lane->scene->observables[i], &view, lane->angles[i]);
    }
    gm_history_add(&lane->history, view.t, view.run->steps, values);
    record_tracks(lane, &view);
    settle(lane, refusals);
}

void gm_lane_close(struct gm_lane *lane)
{
    if (!lane) {
        return;
    }
    for (size_t i = 0; lane->entries && i < lane->scene->track_count; i++) {
        free(lane->entries[i].times);
        free(lane->entries[i].steps);
        free(lane->entries[i].values);
    }
    free(lane->entries);
    free(lane->angles);
    free(lane->behind);
    gm_history_close(&lane->history);
    gm_run_close(lane->run);
    if (lane->scene->close) {
        lane->scene->close(&lane->problem);
    }
    free(lane->switches);
    free(lane->start);
    free(lane->parameters);
    free(lane);
}

static bool open_tracks(struct gm_lane *lane)
{
    const struct gm_scene *scene = lane->scene;
    lane->entries = calloc(scene->track_count ? scene->track_count : 1, sizeof *lane->entries);
    lane->angles = calloc(scene->observable_count ? scene->observable_count : 1, sizeof *lane->angles);
    if (!lane->entries || !lane->angles) {
        return false;
    }
    const struct gm_view view = gm_lane_view(lane);
    for (size_t i = 0; i < scene->track_count; i++) {
        struct gm_entries *entries = &lane->entries[i];
        entries->every = 1;
        entries->before = NAN;
        if (scene->tracks[i].section && !lane->behind) {
            /* the state before, slopes at both ends, a state between */
            lane->behind = calloc(4 * gm_lane_active(lane), sizeof *lane->behind);
            if (!lane->behind) {
                return false;
            }
        }
        entries->width = scene->tracks[i].width(&view);
        entries->times = malloc(scene->tracks[i].bound * sizeof(double));
        entries->steps = malloc(scene->tracks[i].bound * sizeof *entries->steps);
        entries->values = malloc(scene->tracks[i].bound * entries->width * sizeof(double));
        if (!entries->times || !entries->steps || !entries->values) {
            return false;
        }
    }
    return true;
}

static bool refuse(char *sentence, const char *text)
{
    snprintf(sentence, GM_SENTENCE, "%s", text);
    return false;
}

static bool check_fit(const struct gm_scene *scene, const struct gm_problem *problem,
                      const struct gm_scheme *scheme, char *sentence)
{
    if (gm_scheme_fits(scheme, problem)) {
        return true;
    }
    const char *lacks = gm_scheme_lacks(scheme, problem);
    snprintf(sentence, GM_SENTENCE, "scheme %s does not fit scene %s: it needs %s, which %s lacks",
             scheme->name, scene->name, lacks ? lacks : "a structure", problem->name);
    return false;
}

static void *copy_of(const void *source, size_t size)
{
    void *copy = malloc(size);
    if (copy) {
        memcpy(copy, source, size);
    }
    return copy;
}

/* A lane up to its run, from a start (t0, y), or from the scene's own start where y is NULL. */
static bool prepare(struct gm_lane *lane, char *sentence)
{
    const struct gm_scene *scene = lane->scene;
    if (!lane->parameters) {
        return refuse(sentence, "not enough memory");
    }
    if (scene->resolve) {
        scene->resolve(lane->parameters);
    }
    if (!scene->setup(lane->parameters, &lane->problem, sentence) ||
        !check_fit(scene, &lane->problem, lane->scheme, sentence)) {
        return false;
    }
    lane->t0 = gm_scene_t0(scene, lane->parameters);
    lane->start = malloc(lane->problem.n * lane->problem.m * sizeof *lane->start);
    if (!lane->start) {
        return refuse(sentence, "not enough memory");
    }
    if (!scene->start_with) {
        scene->start(lane->parameters, &lane->problem, lane->start);
    } else if (!scene->start_with(lane->parameters, &lane->problem, lane->scheme, lane->start, sentence)) {
        return false;
    }
    lane->run =
        gm_run_open(&lane->problem, lane->scheme, &lane->settings, lane->t0, timing(lane)->dt, lane->start);
    if (!lane->run || !gm_history_open(&lane->history, scene->observable_count) || !open_tracks(lane)) {
        return refuse(sentence, "not enough memory");
    }
    return true;
}

struct gm_lane *gm_lane_open(const struct gm_scene *scene, const void *parameters,
                             const struct gm_settings *settings, const struct gm_scheme *scheme,
                             char *sentence)
{
    const unsigned long refusals = gm_memory_refusals();
    struct gm_lane *lane = calloc(1, sizeof *lane);
    if (!lane) {
        refuse(sentence, "not enough memory");
        return NULL;
    }
    lane->scene = scene;
    lane->settings = *settings;
    lane->scheme = lane->first_scheme = scheme;
    gm_lane_show(lane, &(const struct gm_shown){0});
    lane->parameters = copy_of(parameters, scene->size);
    bool good = prepare(lane, sentence);
    if (good) {
        gm_lane_record(lane);
    }
    if (gm_memory_refusals() != refusals) {
        /* whatever was made of it: a start or an observable cannot say so, a search for a mesh found none */
        good = refuse(sentence, "not enough memory");
    }
    if (!good) {
        gm_lane_close(lane);
        return NULL;
    }
    return lane;
}

bool gm_lane_switch(struct gm_lane *lane, const struct gm_scheme *scheme, char *sentence)
{
    if (!check_fit(lane->scene, &lane->problem, scheme, sentence)) {
        return false;
    }
    struct gm_run *run = gm_run_switch(lane->run, scheme);
    if (!run) {
        return refuse(sentence, "not enough memory");
    }
    if (!gm_lane_note_switch(lane, scheme)) {
        gm_run_close(run);
        return refuse(sentence, "not enough memory");
    }
    gm_run_close(lane->run);
    lane->run = run;
    lane->scheme = scheme;
    return true;
}

struct gm_lane *gm_lane_copy(const struct gm_lane *lane)
{
    char sentence[GM_SENTENCE];
    struct gm_timing *forwards = copy_of(lane->parameters, lane->scene->size);
    if (!forwards) {
        return NULL;
    }
    forwards->dt = fabs(forwards->dt); /* the start is one of a run that goes forwards */
    struct gm_lane *copy = gm_lane_open(lane->scene, forwards, &lane->settings, lane->scheme, sentence);
    free(forwards);
    size_t size = gm_lane_pack_size(lane);
    void *bytes = malloc(size);
    if (!copy || !bytes || !gm_lane_copy_switches(copy, lane)) {
        gm_lane_close(copy);
        free(bytes);
        return NULL;
    }
    memcpy(copy->start, lane->start, lane->problem.n * lane->problem.m * sizeof *copy->start);
    ((struct gm_timing *)copy->parameters)->dt = lane->run->dt;
    gm_lane_pack(lane, bytes);
    const bool good = gm_lane_unpack(copy, bytes, &size);
    free(bytes);
    if (!good) {
        gm_lane_close(copy);
        return NULL;
    }
    return copy;
}

void gm_lane_set_step(struct gm_lane *lane, double dt)
{
    ((struct gm_timing *)lane->parameters)->dt = dt;
    gm_run_set_step(lane->run, dt);
}

size_t gm_lane_snapshot_size(const struct gm_lane *lane)
{
    return gm_run_snapshot_size(lane->run);
}

void gm_lane_save(const struct gm_lane *lane, void *snapshot)
{
    gm_run_save(lane->run, snapshot);
}

bool gm_lane_load(struct gm_lane *lane, const void *snapshot)
{
    /* a snapshot from before a switch: its scheme's memory has another shape */
    const struct gm_run *then = snapshot;
    if (then->scheme != lane->run->scheme) {
        struct gm_run *run = gm_run_switch(lane->run, then->scheme);
        if (!run) {
            return false;
        }
        gm_run_close(lane->run);
        lane->run = run;
    }
    if (!gm_run_load(lane->run, snapshot)) {
        return false;
    }
    const long step = lane->run->steps;
    lane->scheme = lane->run->scheme;
    ((struct gm_timing *)lane->parameters)->dt = lane->run->dt;
    gm_lane_show_switches(lane, step);
    gm_history_show(&lane->history, step);
    for (size_t i = 0; i < lane->scene->track_count; i++) {
        struct gm_entries *entries = &lane->entries[i];
        const size_t kept = lane->scene->tracks[i].section ? 0 : 1;
        entries->count = entries->kept;
        while (entries->count > kept && entries->steps[entries->count - 1] > step) {
            entries->count--;
        }
        if (lane->run->dt < 0 && !lane->scene->tracks[i].section && !lane->scene->tracks[i].recent) {
            unwind(entries, lane->run->t);
        }
        /* what the step before was is not known; it is again after the next one */
        entries->before = NAN;
    }
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        const struct gm_history *history = &lane->history;
        if (history->count > 0) {
            lane->angles[i] = history->bins[(history->count - 1) * history->series + i].last;
        }
    }
    return true;
}
