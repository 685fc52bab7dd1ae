/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lanes: opened, advanced, observed, switched and copied, with the bounded records of their past. */
#include "scenes/common/lane.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/kind.h"
#include "core/memory.h"
#include "core/schemes.h"

struct gm_view gm_lane_view(const struct gm_lane *lane)
{
    return (struct gm_view){
        .scene = lane->scene,
        .parameters = lane->parameters,
        .problem = &lane->problem,
        .scheme = lane->scheme,
        .start = lane->start,
        .state = gm_run_state(lane->run),
        .t0 = lane->t0,
        .t = lane->run->t,
        .dt = lane->run->dt,
        .steps = lane->run->steps,
        .memory = gm_run_memory(lane->run),
        .tracks = lane->entries,
        .run = lane->run,
        .worked = lane->worked,
        .initials = lane->initials,
        .cancelled = lane->cancelled,
        .booked = gm_run_events(lane->run),
    };
}

/* ---- observables ---- */

static double initial_of(const struct gm_observable *observable, const struct gm_view *view)
{
    return view->initials[observable - view->scene->observables];
}

/* The divisor of an error. */
static double divisor_of(const struct gm_observable *observable, const struct gm_view *view)
{
    const double divisor = fmax(fabs(initial_of(observable, view)), gm_observable_scale(observable, view));
    return divisor > 0 ? divisor : 1;
}

/* Stops a lane if there was no memory to observe it. */
static void settle(struct gm_lane *lane, unsigned long refusals)
{
    if (gm_memory_refusals() != refusals) {
        lane->run->status = GM_OUT_OF_MEMORY;
    }
}

/* Computes the start values of errors, again for each scheme that continues the lane, as it may use another
   discretisation, and states of its own. Some starts are a difference of large terms: round-off, or little more. */
static void look_at_start(struct gm_lane *lane)
{
    const double most = 1e-8;
    const unsigned long refusals = gm_memory_refusals();
    struct gm_view before = gm_lane_view(lane);
    struct gm_run *begun = before.memory ? gm_run_open(&lane->problem, lane->scheme, &lane->settings,
                                                       lane->t0, lane->run->dt, lane->start)
                                         : NULL;
    before.state = begun && begun->status == GM_OK ? gm_run_state(begun) : lane->start;
    before.t = lane->t0;
    before.memory = begun ? gm_run_memory(begun) : NULL;
    before.booked = NULL;
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        const struct gm_observable *observable = before.observable = &lane->scene->observables[i];
        const double terms = observable->terms ? observable->terms(&before) : 0;
        lane->initials[i] = observable->error ? gm_observe(observable, &before) : 0;
        const bool cancels = terms > 0 && fabs(lane->initials[i]) <= most * terms;
        lane->cancelled[i] = cancels && isfinite(terms) ? terms : 0;
    }
    if (begun) {
        gm_run_close(begun);
    }
    settle(lane, refusals);
}

double gm_view_observe(const struct gm_observable *observable, const struct gm_view *view, double near)
{
    const double value = gm_observe(observable, view);
    if (observable->period > 0) {
        return value + observable->period * round((near - value) / observable->period);
    }
    if (!observable->error) {
        return value;
    }
    return fabs(value - initial_of(observable, view)) / divisor_of(observable, view);
}

double gm_lane_observe(const struct gm_lane *lane, size_t observable)
{
    const struct gm_view view = gm_lane_view(lane);
    const unsigned long refusals = gm_memory_refusals();
    /* observables computed on request are never angles */
    const double near = observable < lane->scene->observable_count ? lane->angles[observable] : 0,
                 value = gm_view_observe(gm_scene_observable_at(lane->scene, observable), &view, near);
    return gm_memory_refusals() == refusals ? value : NAN;
}

const char *gm_lane_missing(const struct gm_lane *lane, size_t observable)
{
    const struct gm_observable *row = gm_scene_observable_at(lane->scene, observable);
    struct gm_view view = gm_lane_view(lane);
    view.observable = row;
    if (row->why || row->missing) {
        return row->why ? row->why(&view) : row->missing;
    }
    const bool measured = !row->kept && gm_lane_measures(lane, observable);
    return measured && !isfinite(gm_lane_observe(lane, observable)) ? "it has no finite value in this state"
                                                                    : NULL;
}

void gm_lane_judge(struct gm_lane *lane, size_t observable, double value)
{
    if (!isfinite(value) && gm_scene_observable_at(lane->scene, observable)->kept &&
        lane->run->status == GM_OK && !gm_lane_missing(lane, observable)) {
        lane->run->status = GM_BLOW_UP;
    }
}

bool gm_lane_measures(const struct gm_lane *lane, size_t observable)
{
    return lane->problem.m > 1 || !gm_scene_observable_at(lane->scene, observable)->of_members;
}

double gm_lane_divisor(const struct gm_lane *lane, size_t observable)
{
    const struct gm_view view = gm_lane_view(lane);
    return divisor_of(&lane->scene->observables[observable], &view);
}

/* The error above which a conserved quantity is lost. A symplectic scheme has only bounded errors, so its
   threshold is smaller; smaller still if it is symplectic on two copies of phase space, which preserve
   neither once they separate. */
static double lost_above(const struct gm_scheme *scheme)
{
    return scheme->family->doubled ? 0.5 : scheme->claims & GM_SYMPLECTIC ? 1 : 10;
}

long gm_lane_lost(const struct gm_lane *lane)
{
    const struct gm_view view = gm_lane_view(lane);
    const double least_left = 0.1;
    double most = 0;
    long lost = -1;
    for (size_t i = 0; lane->run->status == GM_OK && i < lane->scene->observable_count; i++) {
        const struct gm_observable *observable = &lane->scene->observables[i];
        if (!observable->kept) {
            continue;
        }
        const double initial = initial_of(observable, &view), divisor = divisor_of(observable, &view),
                     value = gm_observe(observable, &view);
        const double error = fabs(value - initial) / divisor;
        /* a quantity that starts below its scale may become smaller without a loss */
        const bool decayed = divisor == fabs(initial) && value / initial < least_left;
        if ((error > lost_above(lane->scheme) || decayed) && error > most) {
            most = error;
            lost = (long)i;
        }
    }
    return lost;
}

void gm_lane_warning(const struct gm_lane *lane, char *text, size_t size)
{
    const long lost = gm_lane_lost(lane);
    const struct gm_view view = gm_lane_view(lane);
    text[0] = '\0';
    for (size_t i = 0; lost < 0 && i < lane->scene->observable_count && !text[0]; i++) {
        const struct gm_observable *observable = &lane->scene->observables[i];
        const double value = observable->most > 0 ? gm_observe(observable, &view) : 0;
        if (value > observable->most) {
            snprintf(text, size, "%s is %.3g, above %g: %s", observable->key, value, observable->most,
                     observable->title);
        }
    }
    if (lost < 0) {
        return;
    }
    const struct gm_observable *observable = &lane->scene->observables[lost];
    const double error = gm_lane_observe(lane, (size_t)lost);
    const double left = gm_observe(observable, &view) / initial_of(observable, &view);
    if (error <= lost_above(lane->scheme) && left >= 0) {
        snprintf(text, size,
                 "%s is %.3g: the scheme has %.1e left of a quantity that the exact motion conserves",
                 observable->key, error, left);
    } else {
        snprintf(text, size, "%s is %.3g: the scheme has lost a quantity that the exact motion conserves",
                 observable->key, error);
    }
}

void gm_lane_note(const struct gm_lane *lane, char *sentence)
{
    sentence[0] = '\0';
    if (lane->scene->note) {
        lane->scene->note(&lane->problem, lane->parameters, sentence);
    } else if (lane->problem.events && lane->problem.events->breaks > 0 && !gm_run_locates(lane->run)) {
        snprintf(sentence, GM_MESSAGE, "%s steps across breaks; rk4 and gauss4 locate them, for one member",
                 lane->scheme->name);
    }
}

static void record_tracks(struct gm_lane *lane, const struct gm_view *view)
{
    for (size_t i = 0; i < lane->scene->track_count && !lane->unfollowed; i++) {
        gm_entries_record(&lane->entries[i], &lane->scene->tracks[i], view, &lane->behind);
    }
    if (lane->watch.see) {
        lane->watch.see(lane->watch.data, view);
    }
    gm_behind_note(&lane->behind, view);
}

/* Follows angles, in all steps of a trace or, if that is NULL, in the last one: they are unwrapped from their last value. */
static void follow_angles(struct gm_lane *lane, const struct gm_view *view, const struct gm_trace *trace)
{
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        const struct gm_observable *observable = &lane->scene->observables[i];
        for (int64_t k = 0; observable->period > 0 && k < (trace ? trace->count : 1); k++) {
            const struct gm_view there = trace ? gm_view_along(view, trace, k + 1) : *view;
            const double angle = gm_view_observe(observable, &there, lane->angles[i]);
            lane->angles[i] = isfinite(angle) ? angle : lane->angles[i];
        }
    }
}

/* Takes the current state into tracks only, and follows angles: after every scene->follow steps that are not
   recorded. */
static void follow(struct gm_lane *lane)
{
    const unsigned long refusals = gm_memory_refusals();
    const struct gm_view view = gm_lane_view(lane);
    lane->followed = lane->run->steps;
    follow_angles(lane, &view, lane->behind.traced ? &lane->behind.trace : NULL);
    record_tracks(lane, &view);
    settle(lane, refusals);
}

/* Returns true if the lane's next steps can be followed together: time runs forwards, and the last one was followed. */
static bool is_traced(const struct gm_lane *lane)
{
    const struct gm_run *run = lane->run;
    const struct gm_behind *behind = &lane->behind;
    return lane->scene->follow == 1 && behind->trace.states && gm_run_is_traced(run) && run->dt > 0 &&
           run->t >= lane->t0 && lane->followed == run->steps && behind->t == run->t &&
           memcmp(behind->state, gm_run_state(run), run->problem->n * sizeof *behind->state) == 0;
}

/* Makes steps together, and follows each of them. */
static void follow_together(struct gm_lane *lane, int64_t steps)
{
    gm_run_trace(lane->run, steps, &lane->behind.trace);
    lane->behind.traced = true;
    follow(lane);
    lane->behind.traced = false;
}

enum gm_status gm_lane_to(struct gm_lane *lane, int64_t steps, double until)
{
    if (lane->scene->follow == 0 || (lane->unfollowed && !lane->watch.see)) {
        return gm_run_to(lane->run, steps, until);
    }
    /* one adaptive step may be as long as many others */
    const int64_t most = lane->scheme->family->adaptive ? 1 : lane->scene->follow;
    if (lane->followed > lane->run->steps) { /* the lane was set back */
        lane->followed = lane->run->steps;
    }
    while (gm_run_goes_on(lane->run, steps, until)) {
        const int64_t due = lane->followed + most;
        if (is_traced(lane)) {
            follow_together(lane, steps - lane->run->steps);
            continue;
        }
        gm_run_to(lane->run, due < steps ? due : steps, until);
        if (lane->run->steps >= due || lane->run->status != GM_OK || lane->run->stopped) {
            follow(lane);
        }
    }
    return lane->run->status;
}

size_t gm_lane_asked_shown(const struct gm_lane *lane)
{
    return lane->scene->asked_shown ? lane->scene->asked_shown(lane->scene, lane->parameters) : 0;
}

/* Returns true if two schemes make the same steps on the problems of all lanes. */
static bool are_same(const struct gm_scheme *a, const struct gm_scheme *b, const struct gm_lane *const *lanes,
                     size_t count)
{
    bool same = true;
    for (size_t i = 0; i < count && same; i++) {
        const struct gm_scheme *other_a = gm_scheme_same_as(a, &lanes[i]->problem),
                               *other_b = gm_scheme_same_as(b, &lanes[i]->problem);
        same = (other_a ? other_a : a) == (other_b ? other_b : b);
    }
    return same;
}

/* Adds to the subtitle the first two lanes of schemes with two names that are one method. */
static void note_same(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    for (size_t i = 1; i < count; i++) {
        for (size_t k = 0; k < i; k++) {
            const struct gm_scheme *a = lanes[k]->scheme, *b = lanes[i]->scheme;
            if (a != b && are_same(a, b, lanes, count)) {
                const char *const before = picture->subtitle ? picture->subtitle : "";
                picture->subtitle = gm_picture_text(picture, "%s%s%s and %s are the same method here", before,
                                                    before[0] ? ";  " : "", a->title, b->title);
                return;
            }
        }
    }
}

struct drawn {
    const struct gm_lane *const *lanes;
    size_t count;
};

static void draw(const void *data, struct gm_picture *picture)
{
    const struct drawn *drawn = data;
    drawn->lanes[0]->scene->draw(drawn->lanes, drawn->count, picture);
    note_same(drawn->lanes, drawn->count, picture);
}

void gm_lanes_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture)
{
    gm_picture_draw(picture, draw, &(const struct drawn){lanes, count});
}

void gm_lane_record(struct gm_lane *lane)
{
    double values[GM_MOST_OBSERVABLES];
    const unsigned long refusals = gm_memory_refusals();
    const struct gm_view view = gm_lane_view(lane);
    lane->followed = lane->run->steps;
    follow_angles(lane, &view, NULL);
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        values[i] = gm_view_observe(&lane->scene->observables[i], &view, lane->angles[i]);
    }
    const struct gm_scene *scene = lane->scene;
    const size_t shown = gm_lane_asked_shown(lane);
    for (size_t i = 0; i < scene->asked_count; i++) {
        values[scene->observable_count + i] = i < shown ? gm_view_observe(&scene->asked[i], &view, 0) : NAN;
    }
    gm_history_add(&lane->history, view.t, view.run->steps, values);
    record_tracks(lane, &view);
    settle(lane, refusals);
}

/* ---- names of a lane, also after switches of its scheme ---- */

/* The part of a name "RK4, Δt = 0.1" that equals `front`, or for a parameter begins with it and ends before
   the next comma; NULL without one. */
static const char *part_of(const char *name, const char *front, bool parameter, size_t *length)
{
    const size_t known = strlen(front);
    for (const char *part = name; part; part = strstr(part, ", ")) {
        part += part == name ? 0 : 2;
        *length = known;
        if (strncmp(part, front, known) == 0) {
            *length += parameter ? strcspn(part + known, ",") : 0;
            if (part[*length] == '\0' || part[*length] == ',') {
                return part;
            }
        }
    }
    return NULL;
}

void gm_shown_rename(struct gm_shown *shown, const char *before, const char *after, bool parameter)
{
    char *names[] = {shown->panel_name, shown->colour_name};
    for (size_t k = 0; k < 2; k++) {
        char was[sizeof shown->panel_name];
        size_t length = 0;
        snprintf(was, sizeof was, "%s", names[k]);
        const char *part = part_of(was, before, parameter, &length);
        if (part) {
            snprintf(names[k], sizeof was, "%.*s%s%s", (int)(part - was), was, after, part + length);
        }
    }
}

const struct gm_scheme *gm_lane_scheme_after(const struct gm_lane *lane, size_t switches)
{
    return switches > 0 ? lane->switches[switches - 1].scheme : lane->first_scheme;
}

/* Turns a name of the start, "RK4, Δt = 0.1", into "Gauss 4, Δt = 0.1, after Verlet, RK4": the scheme at work
   is first, and a name that is cut loses the oldest one. At most two earlier schemes are named. */
static void name_switches(const struct gm_lane *lane, char *name, size_t size)
{
    const size_t count = lane->switch_count;
    const char *title = gm_lane_scheme_after(lane, count)->title;
    char was[sizeof lane->schemes];
    size_t length = 0;
    snprintf(was, sizeof was, "%s", name);
    const char *part = part_of(was, lane->first_scheme->title, false, &length);
    size_t used =
        (size_t)(part ? snprintf(name, size, "%.*s%s%s", (int)(part - was), was, title, part + length)
                      : snprintf(name, size, "%s, %s", title, was));
    for (size_t i = count; i-- > 0 && i + 2 >= count && used < size;) {
        used += (size_t)snprintf(name + used, size - used, "%s%s", i + 1 == count ? ", after " : ", ",
                                 gm_lane_scheme_after(lane, i)->title);
    }
    if (count > 2 && used < size) {
        snprintf(name + used, size - used, " …");
    }
}

/* Composes the names that are shown now. */
static void compose(struct gm_lane *lane)
{
    struct gm_shown *shown = &lane->shown;
    *shown = lane->named;
    snprintf(lane->schemes, sizeof lane->schemes, "%s", lane->first_scheme->title);
    if (lane->switch_count == 0) {
        return;
    }
    if (!shown->panel_name[0] && !shown->colour_name[0]) {
        snprintf(shown->panel_name, sizeof shown->panel_name, "%s", lane->first_scheme->title);
    }
    name_switches(lane, lane->schemes, sizeof lane->schemes);
    name_switches(lane, shown->colour_name[0] ? shown->colour_name : shown->panel_name,
                  sizeof shown->panel_name);
}

void gm_lane_show(struct gm_lane *lane, const struct gm_shown *named)
{
    lane->named = *named;
    compose(lane);
}

static bool note_switch(struct gm_lane *lane, const struct gm_scheme *scheme)
{
    const int64_t step = lane->run->steps;
    struct gm_switch *longer =
        gm_arena_resize(lane->arena, lane->switches, lane->switch_count + 1, sizeof *lane->switches);
    if (!longer) {
        return false;
    }
    lane->switches = longer;
    while (lane->switch_count > 0 && longer[lane->switch_count - 1].step >= step) {
        lane->switch_count--;
    }
    const size_t count = lane->switch_count;
    if (step == 0) { /* the scheme before has made no step */
        gm_shown_rename(&lane->named, lane->first_scheme->title, scheme->title, false);
        lane->first_scheme = scheme;
    } else if (scheme != (count > 0 ? longer[count - 1].scheme : lane->first_scheme)) {
        longer[lane->switch_count++] = (struct gm_switch){.scheme = scheme, .step = step, .t = lane->run->t};
    }
    lane->switches_kept = lane->switch_count;
    compose(lane);
    return true;
}

static void show_switches(struct gm_lane *lane, int64_t step)
{
    lane->switch_count = lane->switches_kept;
    while (lane->switch_count > 0 && lane->switches[lane->switch_count - 1].step > step) {
        lane->switch_count--;
    }
    compose(lane);
}

static bool copy_switches(struct gm_lane *lane, const struct gm_lane *from)
{
    lane->switches = gm_arena_take(lane->arena, from->switch_count + 1, sizeof *from->switches);
    if (!lane->switches) {
        return false;
    }
    for (size_t i = 0; i < from->switch_count; i++) {
        lane->switches[i] = from->switches[i];
    }
    lane->switch_count = lane->switches_kept = from->switch_count;
    lane->first_scheme = from->first_scheme;
    gm_lane_show(lane, &from->named);
    return true;
}

/* ---- from open to close ---- */

void gm_lane_close(void *lane)
{
    if (lane) {
        gm_arena_close(((struct gm_lane *)lane)->arena);
    }
}

/* Closes what is not memory of the arena. */
static void close_parts(void *thing)
{
    struct gm_lane *lane = thing;
    for (size_t i = 0; i < GM_WORKED; i++) {
        if (lane->worked[i].data) {
            lane->worked[i].forget(lane->worked[i].data);
        }
    }
    gm_run_close(lane->run);
    if (lane->scene->close) {
        lane->scene->close(&lane->problem);
    }
}

static bool check_fit(const struct gm_scene *scene, const struct gm_problem *problem,
                      const struct gm_scheme *scheme, char *sentence)
{
    if (gm_scheme_fits(scheme, problem)) {
        return true;
    }
    const char *lacks = gm_scheme_lacks(scheme, problem);
    return gm_refuse(sentence, "scheme %s does not fit scene %s: it needs %s, which %s lacks", scheme->name,
                     scene->name, lacks ? lacks : "a structure", problem->name);
}

/* The arguments of a lane that is being opened. */
struct opening {
    const struct gm_scene *scene;
    const void *parameters;
    const struct gm_settings *settings;
    const struct gm_scheme *scheme;
    char *sentence;
    struct gm_lane *lane;
};

/* Opens the problem and its start. */
static void open_start(struct gm_arena *arena, struct gm_lane *lane, char *sentence)
{
    const struct gm_scene *scene = lane->scene;
    gm_arena_check(arena,
                   scene->setup(lane->parameters, &lane->problem, sentence) &&
                       check_fit(scene, &lane->problem, lane->scheme, sentence),
                   sentence);
    if (scene->chosen) {
        scene->chosen(&lane->problem, lane->parameters);
    }
    lane->t0 = gm_scene_t0(scene, lane->parameters);
    lane->start = gm_arena_take(arena, lane->problem.n * lane->problem.m, sizeof *lane->start);
    if (!scene->start_with) {
        scene->start(lane->parameters, &lane->problem, lane->start);
    } else {
        gm_arena_check(
            arena, scene->start_with(lane->parameters, &lane->problem, lane->scheme, lane->start, sentence),
            sentence);
    }
}

static void open_records(struct gm_arena *arena, struct gm_lane *lane)
{
    const struct gm_scene *scene = lane->scene;
    lane->initials = gm_arena_take(arena, 2 * scene->observable_count, sizeof *lane->initials);
    lane->cancelled = lane->initials + scene->observable_count;
    gm_history_open(arena, &lane->history, scene->observable_count + scene->asked_count);
    lane->entries = gm_arena_take(arena, scene->track_count, sizeof *lane->entries);
    lane->angles = gm_arena_take(arena, scene->observable_count, sizeof *lane->angles);
    const struct gm_view view = gm_lane_view(lane);
    for (size_t i = 0; i < scene->track_count; i++) {
        gm_entries_open(arena, &lane->entries[i], &scene->tracks[i], &view, &lane->behind);
    }
}

/* Takes an event of a run that is followed into the tracks. */
static void see_event(void *data, const struct gm_event_part *part)
{
    struct gm_lane *lane = data;
    struct gm_view before = gm_lane_view(lane), after = before;
    if (lane->unfollowed) {
        return;
    }
    before.state = part->before;
    after.state = part->after;
    before.t = after.t = part->before[lane->problem.n];
    for (size_t i = 0; i < lane->scene->track_count; i++) {
        gm_entries_event(&lane->entries[i], &lane->scene->tracks[i], part->event, &before, &after,
                         &lane->behind);
    }
    gm_behind_note(&lane->behind, &after);
}

static void open_lane(struct gm_arena *arena, void *data)
{
    struct opening *opening = data;
    struct gm_lane *lane = opening->lane = gm_arena_keep(arena, calloc(1, sizeof *lane), free);
    const struct gm_scene *scene =
        opening->scene->variant ? opening->scene->variant(opening->parameters) : opening->scene;
    const size_t observables = scene->observable_count + scene->asked_count;
    lane->arena = arena;
    lane->scene = scene;
    lane->settings = *opening->settings;
    lane->scheme = lane->first_scheme = opening->scheme;
    gm_lane_show(lane, &(const struct gm_shown){0});
    lane->parameters = gm_arena_take(arena, 1, opening->scene->size);
    memcpy(lane->parameters, opening->parameters, opening->scene->size);
    lane->worked = gm_arena_take(arena, GM_WORKED, sizeof *lane->worked);
    gm_arena_keep(arena, lane, close_parts);
    if (observables > GM_MOST_OBSERVABLES) {
        gm_arena_refuse(arena, "%zu observables, and a scene has at most %d", observables,
                        GM_MOST_OBSERVABLES);
    }
    open_start(arena, lane, opening->sentence);
    lane->run = gm_run_open(&lane->problem, lane->scheme, &lane->settings, lane->t0,
                            ((const struct gm_timing *)lane->parameters)->dt, lane->start);
    gm_arena_need(arena, lane->run);
    open_records(arena, lane);
    look_at_start(lane);
    lane->run->ends = true;
    lane->run->witness = (struct gm_event_witness){see_event, lane};
    gm_lane_record(lane);
}

struct gm_lane *gm_lane_open(const struct gm_scene *scene, const void *parameters,
                             const struct gm_settings *settings, const struct gm_scheme *scheme,
                             char *sentence)
{
    const unsigned long refusals = gm_memory_refusals();
    struct gm_arena *arena = gm_arena_open();
    struct opening opening = {scene, parameters, settings, scheme, sentence, NULL};
    bool opened =
        gm_arena_run(arena, open_lane, &opening) || gm_refuse(sentence, "%s", gm_arena_reason(arena));
    if (gm_memory_refusals() != refusals) {
        /* some failures go unreported: a start, an observable, or a search for a mesh */
        opened = gm_refuse(sentence, "not enough memory");
    }
    if (!opened) {
        gm_arena_close(arena);
    }
    return opened ? opening.lane : NULL;
}

bool gm_lane_switch(struct gm_lane *lane, const struct gm_scheme *scheme, char *sentence)
{
    if (!check_fit(lane->scene, &lane->problem, scheme, sentence)) {
        return false;
    }
    struct gm_run *run = gm_run_switch(lane->run, scheme);
    if (!run) {
        return gm_refuse(sentence, "not enough memory");
    }
    if (!note_switch(lane, scheme)) {
        gm_run_close(run);
        return gm_refuse(sentence, "not enough memory");
    }
    gm_run_close(lane->run);
    lane->run = run;
    lane->scheme = scheme;
    look_at_start(lane);
    return true;
}

struct gm_lane *gm_lane_reopen(const struct gm_lane *lane)
{
    char sentence[GM_MESSAGE];
    struct gm_timing *forwards = malloc(lane->scene->size);
    if (!forwards) {
        return NULL;
    }
    memcpy(forwards, lane->parameters, lane->scene->size);
    forwards->dt = fabs(forwards->dt); /* a start belongs to a forward run */
    struct gm_lane *other = gm_lane_open(lane->scene, forwards, &lane->settings, lane->scheme, sentence);
    free(forwards);
    if (!other || !copy_switches(other, lane)) {
        gm_lane_close(other);
        return NULL;
    }
    memcpy(other->start, lane->start, lane->problem.n * lane->problem.m * sizeof *other->start);
    look_at_start(other);
    ((struct gm_timing *)other->parameters)->dt = lane->run->dt;
    return other;
}

void gm_lane_set_step(struct gm_lane *lane, double dt)
{
    ((struct gm_timing *)lane->parameters)->dt = dt;
    gm_run_set_step(lane->run, dt);
}

bool gm_lane_load(struct gm_lane *lane, const void *snapshot)
{
    /* the memory of another scheme has another shape */
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
    const int64_t step = lane->run->steps;
    if (lane->scheme != lane->run->scheme) {
        lane->scheme = lane->run->scheme;
        look_at_start(lane);
    }
    ((struct gm_timing *)lane->parameters)->dt = lane->run->dt;
    show_switches(lane, step);
    gm_history_show(&lane->history, step);
    for (size_t i = 0; i < lane->scene->track_count; i++) {
        gm_entries_show(&lane->entries[i], &lane->scene->tracks[i], lane->run);
    }
    for (size_t i = 0; i < lane->scene->observable_count; i++) {
        const struct gm_history *history = &lane->history;
        if (history->count > 0) {
            lane->angles[i] = history->bins[(history->count - 1) * history->series + i].last;
        }
    }
    return true;
}
