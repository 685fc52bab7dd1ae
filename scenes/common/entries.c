/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The records of a lane: entries of tracks, thinned when full, crossings of a section between two steps, and histories. */
#include "scenes/common/entries.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/events.h"
#include "core/ode/kernel/loops.h"
#include "core/run.h"

struct gm_view gm_view_along(const struct gm_view *view, const struct gm_trace *trace, int64_t k)
{
    struct gm_view there = *view;
    there.state = trace->states + (size_t)k * view->problem->n;
    there.t = trace->times[k];
    there.steps = view->steps - trace->count + k;
    return there;
}

/* ---- entries ---- */

size_t gm_active_count(const struct gm_problem *problem)
{
    return (problem->n - 2 * problem->passive) * problem->m;
}

/* Returns true if the last step of a view's run began in this state. */
static bool is_before(const struct gm_behind *behind, const struct gm_view *view)
{
    const struct gm_run *run = view->run;
    if (behind->traced) {
        return gm_scheme_repeats_steps(run->scheme);
    }
    return behind->t != view->t && run->problem->passive == 0 && gm_run_repeats(run) &&
           memcmp(behind->state, gm_run_before(run), gm_active_count(run->problem) * sizeof *behind->state) ==
               0;
}

/* The values before the step are unknown until the next step. */
static void forget_before(struct gm_entries *entries)
{
    for (size_t i = 0; i < entries->sections; i++) {
        entries->before[i] = NAN;
    }
}

/* Room for steps that are made together: enough that what each call costs is little, and few enough for the cache. */
static void open_trace(struct gm_arena *arena, struct gm_trace *trace, const struct gm_problem *problem)
{
    enum { TOGETHER = 128, NUMBERS = 1 << 14 };
    const size_t most = NUMBERS / (problem->n + 1);
    trace->room = most < 1 ? 1 : most < TOGETHER ? (int64_t)most : TOGETHER;
    if (problem->m == 1) {
        trace->states =
            gm_arena_take(arena, (size_t)(trace->room + 1) * (problem->n + 2), sizeof *trace->states);
        trace->times = trace->states + (size_t)(trace->room + 1) * problem->n;
    }
}

void gm_entries_open(struct gm_arena *arena, struct gm_entries *entries, const struct gm_track *track,
                     const struct gm_view *view, struct gm_behind *behind)
{
    *entries = (struct gm_entries){.every = 1, .sections = track->each ? view->problem->m : 1};
    if (track->section && !behind->state) {
        /* the last state, slopes at both ends, an intermediate state */
        behind->state = gm_arena_take(arena, 4 * gm_active_count(view->problem), sizeof *behind->state);
        open_trace(arena, &behind->trace, view->problem);
    }
    entries->width = track->numbers > 0 ? track->numbers : track->width(view);
    entries->times = gm_arena_take_unset(arena, track->bound, sizeof *entries->times);
    entries->steps = gm_arena_take_unset(arena, track->bound, sizeof *entries->steps);
    entries->values = gm_arena_take_unset(arena, track->bound * entries->width, sizeof *entries->values);
    entries->before = gm_arena_take(arena, entries->sections, sizeof *entries->before);
    forget_before(entries);
}

static double *entry_values(const struct gm_entries *entries, size_t index)
{
    return entries->values + index * entries->width;
}

static void thin(struct gm_entries *entries)
{
    const size_t least = entries->count / 4;
    size_t kept = 0, jumps = 0;
    for (size_t i = 0; i < entries->count; i++) {
        const bool jumped = i > 0 && entries->times[i] == entries->times[i - 1],
                   jumps_next = i + 1 < entries->count && entries->times[i] == entries->times[i + 1];
        /* both sides of a jump stay, unless there are too many */
        jumps += jumped || jumps_next;
        if (i % 2 != 0 && (!(jumped || jumps_next) || jumps > least)) {
            continue;
        }
        entries->times[kept] = entries->times[i];
        entries->steps[kept] = entries->steps[i];
        memmove(entry_values(entries, kept), entry_values(entries, i), entries->width * sizeof(double));
        kept++;
    }
    entries->count = kept;
    entries->every *= 2;
}

/* Drops the older half. */
static void forget(struct gm_entries *entries)
{
    const size_t kept = entries->count / 2, gone = entries->count - kept;
    memmove(entries->times, entries->times + gone, kept * sizeof(double));
    memmove(entries->steps, entries->steps + gone, kept * sizeof *entries->steps);
    memmove(entries->values, entry_values(entries, gone), kept * entries->width * sizeof(double));
    entries->count = kept;
}

static void add_entry(struct gm_entries *entries, const struct gm_track *track, const struct gm_view *view)
{
    entries->times[entries->count] = view->t;
    entries->steps[entries->count] = view->steps;
    track->record(view, entry_values(entries, entries->count));
    entries->kept = ++entries->count;
}

/* The number of whole intervals between t0 and t; one missed by round-off counts. */
static double intervals(const struct gm_view *view, double interval, double t)
{
    return floor(fabs(t - view->t0) / interval * (1 + 1e-12) + 1e-9);
}

/* Computes the slopes at both ends of the step that ended in `view`. */
static void find_slopes(const struct gm_view *view, const struct gm_behind *behind)
{
    const size_t active = gm_active_count(view->problem);
    double *slopes = behind->state + active;
    const struct gm_loops *loops = gm_ode_of(view->problem)->loops[gm_isa_best()];
    loops->field(view->problem, behind->state, slopes, view->problem->m);
    loops->field(view->problem, view->state, slopes + active, view->problem->m);
}

/* A section that was crossed in the last step. */
struct crossing {
    const struct gm_track *track;
    const struct gm_view *view; /* the end of the step */
    const struct gm_behind *behind;
    struct gm_view *there; /* the last place evaluated, of one member if members have their own sections */
    double *storage;       /* of gm_run_part; NULL: the step is not repeated */
};

/* The section's value after a fraction of the step: the scheme repeats it, shorter, so that the place has the scheme's
   accuracy; or the cubic with the field's slopes at both ends, whose error is of order 4 in the step. */
static double value_after(void *data, double s)
{
    const struct crossing *crossing = data;
    const struct gm_view *view = crossing->view;
    const struct gm_behind *behind = crossing->behind;
    const double h = view->t - behind->t, r = 1 - s;
    crossing->there->t = behind->t + s * h;
    if (crossing->storage) {
        crossing->there->state = crossing->storage;
        const double *from = behind->traced ? behind->state : gm_run_before(view->run);
        return gm_run_part(view->run, from, behind->t, s, crossing->storage)
                   ? crossing->track->section(crossing->there)
                   : NAN;
    }
    const size_t active = gm_active_count(view->problem),
                 stride = crossing->track->each ? view->problem->m : 1;
    double *slopes = behind->state + active, *between = slopes + 2 * active;
    for (size_t c = crossing->track->each ? crossing->there->member : 0; c < active; c += stride) {
        between[c] = r * r * (1 + 2 * s) * behind->state[c] + s * s * (3 - 2 * s) * view->state[c] +
                     h * s * r * (r * slopes[c] - s * slopes[active + c]);
    }
    crossing->there->state = between;
    return crossing->track->section(crossing->there);
}

/* Finds the place of a crossing. Returns false if that needs a step that fails. */
static bool find_crossing(struct crossing *crossing, double before, double after)
{
    const double s = gm_zero_beyond(value_after, crossing, 0, before, after);
    return !isnan(value_after(crossing, s));
}

/* Finds it by repeated steps; false also if the last step cannot be repeated, or when out of memory. */
static bool find_again(struct crossing *crossing, double before, double after)
{
    enum { ALIGNMENT = 128 };
    const struct gm_problem *problem = crossing->view->problem;
    const size_t count = problem->n * problem->m, size = 2 * count * sizeof(double);
    crossing->storage = is_before(crossing->behind, crossing->view)
                            ? aligned_alloc(ALIGNMENT, (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT)
                            : NULL;
    const bool found = crossing->storage && find_crossing(crossing, before, after);
    double *between = crossing->behind->state + 3 * gm_active_count(problem);
    if (found) {
        memcpy(between, crossing->storage, gm_active_count(problem) * sizeof *between);
        crossing->there->state = between;
    }
    free(crossing->storage);
    crossing->storage = NULL;
    return found;
}

/* Makes an entry of a section, unless thinning leaves it out. */
static void add_crossing(struct gm_entries *entries, const struct gm_track *track,
                         const struct gm_view *there)
{
    if (entries->count == track->bound) {
        thin(entries);
        entries->skipped = 0;
    }
    if (entries->skipped > 0) {
        entries->skipped--;
        return;
    }
    entries->skipped = entries->every - 1;
    add_entry(entries, track, there);
}

/* Makes an entry for every section crossed in the step that ended in `view`. */
static void record_crossings(struct gm_entries *entries, const struct gm_track *track,
                             const struct gm_view *view, const struct gm_behind *behind)
{
    bool known = false; /* slopes are computed */
    /* an ensemble would repeat the steps of all its members for each of them */
    const bool again = track->again && view->problem->m == 1;
    for (size_t member = 0; member < entries->sections; member++) {
        struct gm_view there = *view;
        there.member = member;
        const double after = track->section(&there), before = entries->before[member];
        /* a start on the section does not cross it, in either direction */
        entries->before[member] = isnan(before) && after == 0 ? NAN : after;
        const bool upwards = before < 0 && after >= 0, downwards = track->admits && before >= 0 && after < 0;
        if (!(upwards || downwards) || behind->t == view->t) {
            continue;
        }
        struct crossing crossing = {track, view, behind, &there, NULL};
        if (!(again && find_again(&crossing, before, after))) {
            if (!known) {
                find_slopes(view, behind);
                known = true;
            }
            find_crossing(&crossing, before, after);
        }
        if (!track->admits || track->admits(&there)) {
            add_crossing(entries, track, &there);
        }
    }
}

/* While time runs backwards, a record of the whole past drops its entries later than t, except the start. */
static void unwind(struct gm_entries *entries, double t)
{
    while (entries->count > 1 && entries->times[entries->count - 1] > t) {
        entries->count--;
    }
}

/* Returns true if an entry of a lane is due at time t. */
static bool is_due(struct gm_entries *entries, const struct gm_track *track, const struct gm_view *view,
                   double t)
{
    if (entries->count == 0) {
        return true;
    }
    const double last = entries->times[entries->count - 1];
    const double interval =
        (track->interval ? track->interval(view->parameters) : 0) * (double)entries->every;
    if (!(interval > 0)) {
        return t != last;
    }
    if (entries->counted != last || entries->interval != interval) {
        entries->counted = last;
        entries->interval = interval;
        entries->intervals = intervals(view, interval, last);
    }
    return intervals(view, interval, t) != entries->intervals;
}

static void make_room(struct gm_entries *entries, const struct gm_track *track)
{
    if (entries->count == track->bound) {
        if (track->recent) {
            forget(entries);
        } else {
            thin(entries);
        }
    }
}

/* ---- entries of steps that were made together ---- */

/* Makes the entries of a section. Only steps in which its sign changes are looked at one by one. */
static void follow_section(struct gm_entries *entries, const struct gm_track *track,
                           const struct gm_view *view, struct gm_behind *behind)
{
    const struct gm_trace *trace = &behind->trace;
    double *values = trace->times + trace->room + 1;
    for (int64_t k = 0; k < trace->count && !track->sections; k++) {
        const struct gm_view there = gm_view_along(view, trace, k + 1);
        values[k] = track->section(&there);
    }
    if (track->sections) {
        track->sections(view, trace, values);
    }
    for (int64_t k = 0; k < trace->count; k++) {
        const double before = entries->before[0];
        if ((before < 0 && values[k] < 0) || (before >= 0 && values[k] >= 0)) {
            entries->before[0] = values[k];
            continue;
        }
        const struct gm_view begin = gm_view_along(view, trace, k), end = gm_view_along(view, trace, k + 1);
        gm_behind_note(behind, &begin);
        record_crossings(entries, track, &end, behind);
    }
}

/* Returns the first step from step k on at which an entry is due, trace->count + 1 without one: what is due then is
   due at all later ones. Steps are equal but for those of adaptive schemes, so the search begins at the step that
   holds the end of the current interval. */
static int64_t next_due(struct gm_entries *entries, const struct gm_track *track, const struct gm_view *view,
                        const struct gm_trace *trace, int64_t k)
{
    int64_t low = k - 1, high = trace->count;
    if (k > high || !is_due(entries, track, view, view->t)) {
        return trace->count + 1;
    }
    const double left = entries->interval * (entries->intervals + 1) - fabs(trace->times[low] - view->t0),
                 steps = left / fabs(trace->times[k] - trace->times[low]);
    int64_t middle = !(steps > 1) ? k : steps < (double)(high - k) ? low + (int64_t)ceil(steps) : high - 1;
    for (int tried = 0; high - low > 1; tried++) {
        if (tried > 1 || middle <= low || middle >= high) {
            middle = (low + high) / 2;
        }
        if (is_due(entries, track, view, trace->times[middle])) {
            high = middle--;
        } else {
            low = middle++;
        }
    }
    return high;
}

/* Makes entries that are the states of `count` steps from step k on. */
static void add_states(struct gm_entries *entries, const struct gm_view *view, const struct gm_trace *trace,
                       int64_t k, size_t count)
{
    const size_t at = entries->count, n = view->problem->n;
    memcpy(entries->times + at, trace->times + k, count * sizeof *entries->times);
    memcpy(entry_values(entries, at), trace->states + (size_t)k * n, count * n * sizeof(double));
    for (size_t i = 0; i < count; i++) {
        entries->steps[at + i] = view->steps - trace->count + k + (int64_t)i;
    }
    entries->kept = entries->count += count;
}

static void record_together(struct gm_entries *entries, const struct gm_track *track,
                            const struct gm_view *view, struct gm_behind *behind)
{
    const struct gm_trace *trace = &behind->trace;
    const bool each = track->is_state && !track->interval && entries->width == view->problem->n;
    entries->kept = entries->count;
    if (track->section) {
        follow_section(entries, track, view, behind);
        return;
    }
    for (int64_t k = 1; (k = next_due(entries, track, view, trace, k)) <= trace->count; k++) {
        make_room(entries, track);
        if (each) {
            const size_t rest = (size_t)(trace->count + 1 - k), room = track->bound - entries->count,
                         count = rest < room ? rest : room;
            add_states(entries, view, trace, k, count);
            k += (int64_t)count - 1;
        } else {
            const struct gm_view there = gm_view_along(view, trace, k);
            add_entry(entries, track, &there);
        }
    }
}

void gm_entries_record(struct gm_entries *entries, const struct gm_track *track, const struct gm_view *view,
                       struct gm_behind *behind)
{
    if (behind->traced) {
        record_together(entries, track, view, behind);
        return;
    }
    if (!track->section && !track->recent && view->dt < 0 && view->t >= view->t0) {
        unwind(entries, view->t);
        return;
    }
    entries->kept = entries->count; /* the run continues from here */
    if (track->section) {
        record_crossings(entries, track, view, behind);
        return;
    }
    if (!is_due(entries, track, view, view->t)) {
        return;
    }
    make_room(entries, track);
    add_entry(entries, track, view);
}

void gm_entries_event(struct gm_entries *entries, const struct gm_track *track, size_t event,
                      const struct gm_view *before, const struct gm_view *after, struct gm_behind *behind)
{
    if (track->section && track->at_event && track->at_event(after, event)) {
        entries->kept = entries->count;
        if (!track->admits || track->admits(after)) {
            add_crossing(entries, track, after);
        }
    } else if (track->section) {
        gm_entries_record(entries, track, before, behind);
        entries->before[0] = track->section(after);
    } else if (track->jumps) {
        entries->kept = entries->count;
        for (int k = 0; k < 2; k++) {
            make_room(entries, track);
            add_entry(entries, track, k ? after : before);
        }
    }
}

void gm_behind_note(struct gm_behind *behind, const struct gm_view *view)
{
    if (behind->state) {
        memcpy(behind->state, view->state, gm_active_count(view->problem) * sizeof *behind->state);
        behind->t = view->t;
    }
}

void gm_entries_show(struct gm_entries *entries, const struct gm_track *track, const struct gm_run *run)
{
    const size_t kept = track->section ? 0 : 1;
    entries->count = entries->kept;
    while (entries->count > kept && entries->steps[entries->count - 1] > run->steps) {
        entries->count--;
    }
    if (run->dt < 0 && !track->section && !track->recent) {
        unwind(entries, run->t);
    }
    forget_before(entries);
}

/* ---- bins of a history: filled, merged in pairs when full, shown as they were ---- */

void gm_history_open(struct gm_arena *arena, struct gm_history *history, size_t series)
{
    *history = (struct gm_history){.series = series, .per_bin = 1};
    history->bins = gm_arena_take_unset(arena, GM_HISTORY_BINS * series, sizeof *history->bins);
}

static void merge_pairs(struct gm_history *history)
{
    for (size_t pair = 0; pair < GM_HISTORY_BINS / 2; pair++) {
        for (size_t s = 0; s < history->series; s++) {
            const struct gm_bin *first = &history->bins[2 * pair * history->series + s];
            const struct gm_bin *second = &history->bins[(2 * pair + 1) * history->series + s];
            history->bins[pair * history->series + s] = (struct gm_bin){
                .t = second->t,
                .step = second->step,
                .low = first->low < second->low ? first->low : second->low,
                .high = first->high > second->high ? first->high : second->high,
                .last = second->last,
            };
        }
    }
    history->count = GM_HISTORY_BINS / 2;
    history->per_bin *= 2;
    history->in_last = history->per_bin;
}

void gm_history_add(struct gm_history *history, double t, int64_t step, const double *values)
{
    if (history->count == GM_HISTORY_BINS && history->in_last == history->per_bin) {
        merge_pairs(history);
    }
    const bool fresh = history->count == 0 || history->in_last >= history->per_bin;
    if (fresh) {
        history->count++;
        history->in_last = 0;
    }
    struct gm_bin *bin = &history->bins[(history->count - 1) * history->series];
    for (size_t s = 0; s < history->series; s++) {
        const double value = values[s];
        if (fresh) {
            bin[s] = (struct gm_bin){.low = value, .high = value};
        }
        bin[s].t = t;
        bin[s].step = step;
        bin[s].low = value < bin[s].low ? value : bin[s].low;
        bin[s].high = value > bin[s].high ? value : bin[s].high;
        bin[s].last = value;
    }
    history->in_kept = ++history->in_last;
    history->kept = history->count;
}

void gm_history_show(struct gm_history *history, int64_t step)
{
    if (history->series == 0) {
        return;
    }
    history->count = history->kept;
    while (history->count > 0 && history->bins[(history->count - 1) * history->series].step > step) {
        history->count--;
    }
    /* every bin but the last one is full */
    history->in_last = history->count == history->kept ? history->in_kept : history->per_bin;
}
