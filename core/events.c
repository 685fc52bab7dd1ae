/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The zero of a function along a step, and the events of a step one after the other. */
#include "core/events.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* ---- the zero along a step ---- */

/* A fraction of the step, and its value. */
struct place {
    double s, value;
};

/* Returns the next place as a fraction of the way from the newest place to the other; `third` is the one
   before. Values of 0, of which round-off makes many, give no slope. */
static double next_share(struct place newest, struct place other, struct place third)
{
    const double xi = (newest.s - other.s) / (third.s - other.s),
                 phi = (newest.value - other.value) / (third.value - other.value);
    if (newest.value == 0 || other.value == 0 || !(phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi)) {
        return 0.5;
    }
    return newest.value / (other.value - newest.value) * third.value / (other.value - third.value) +
           (third.s - newest.s) / (other.s - newest.s) * newest.value / (third.value - newest.value) *
               other.value / (third.value - other.value);
}

double gm_zero_beyond(double (*value)(void *data, double s), void *data, double low, double at_low,
                      double at_end)
{
    enum { MOST = 60 };
    const double tolerance = 2.2e-16;
    struct place other = {low, at_low}, newest = {1, at_end}, third = other;
    const bool below = at_end < 0;
    bool failed = isnan(at_low) || isnan(at_end) || (at_low < 0) == below;
    double t = 0.5;
    for (int i = 0; i < MOST && !failed && fabs(newest.s - other.s) > 2 * tolerance; i++) {
        const double s = newest.s + t * (other.s - newest.s);
        const struct place next = {s, value(data, s)};
        failed = isnan(next.value);
        if ((next.value < 0) == (newest.value < 0)) {
            third = newest;
        } else {
            third = other;
            other = newest;
        }
        newest = next;
        const double least = tolerance / fabs(other.s - newest.s);
        t = fmin(fmax(next_share(newest, other, third), least), 1 - least);
    }
    return failed ? NAN : (newest.value < 0) == below ? newest.s : other.s;
}

/* ---- the memory ---- */

/* Signs are first; then counts, the jumps of quantities, and the last event's time with the number of short intervals. */
enum { LAST, SHORT, BEHIND };

static size_t counts_at(const struct gm_problem *problem)
{
    return problem->events->count;
}

/* The number of the first break. */
static size_t first_break(const struct gm_problem *problem)
{
    return problem->events->count - problem->events->breaks;
}

static size_t watched(const struct gm_event_step *step)
{
    return step->locates ? step->problem->events->count : first_break(step->problem);
}

const double *gm_events_modes(const struct gm_problem *problem, const double *memory)
{
    return memory + first_break(problem);
}

static size_t booked_at(const struct gm_problem *problem)
{
    return 2 * problem->events->count;
}

static size_t history_at(const struct gm_problem *problem)
{
    return booked_at(problem) + problem->events->quantities;
}

size_t gm_events_memory(const struct gm_problem *problem)
{
    return problem->events ? history_at(problem) + BEHIND : 0;
}

double gm_events_happened(const struct gm_problem *problem, const double *memory, size_t event)
{
    const double *counts = memory + counts_at(problem);
    double sum = 0;
    for (size_t i = 0; i < first_break(problem); i++) {
        sum += counts[i];
    }
    return event < problem->events->count ? counts[event] : sum;
}

double gm_events_booked(const struct gm_problem *problem, const double *memory, size_t quantity)
{
    return memory[booked_at(problem) + quantity];
}

/* Copies the last member's state, and the time. */
static void look_at(const struct gm_problem *problem, double t, const double *y, double *look)
{
    for (size_t c = 0; c < problem->n; c++) {
        look[c] = y[c * problem->m + problem->m - 1];
    }
    look[problem->n] = t;
}

/* The size of the sign with which an event waits for a motion that rests on g = 0. */
static const double AT_REST = 0.5;

static double sign_of(double value)
{
    return (value > 0) - (value < 0);
}

/* The sign of dg/dt ahead, of the motion with these modes. */
static double sign_of_rate(const struct gm_event_step *step, size_t event, const double *look)
{
    const struct gm_problem *motion = step->motion(step->data, gm_events_modes(step->problem, step->memory));
    const double sign = motion ? sign_of(step->problem->events->rate(step->problem, motion, event, look)) : 0;
    return step->dt < 0 ? -sign : sign;
}

static enum gm_event_form form_of(const struct gm_event_step *step, size_t event)
{
    return step->problem->events->forms[event];
}

static bool is_whole(const struct gm_event_step *step, size_t event)
{
    return form_of(step, event) == GM_AT_WHOLE;
}

/* The value whose sign changes, from that of g. Whole numbers of g are zeros of (g - k)(k + 1 - g), which is above 0 until
   g leaves its interval at either end. A g that jumps to 0 is there. */
static double watched_value(const struct gm_event_step *step, size_t event, double g)
{
    const double k = step->memory[event];
    return is_whole(step, event)                ? (g == k + 1 ? -DBL_MIN : (g - k) * (k + 1 - g))
           : form_of(step, event) == GM_AT_JUMP ? (k * g > 0 ? k : -k)
                                                : g;
}

/* The mode on the side where g is. */
static double mode_at(const struct gm_event_step *step, size_t event, double g)
{
    return is_whole(step, event) ? floor(g) : sign_of(g);
}

/* The mode after g, which is now this, has passed. */
static double mode_beyond(const struct gm_event_step *step, size_t event, double g)
{
    const double mode = step->memory[event];
    return is_whole(step, event)                ? mode + (g - mode < 0.5 ? -1 : 1)
           : form_of(step, event) == GM_AT_JUMP ? sign_of(g)
                                                : -mode;
}

/* The sign with which an event waits. */
static double awaited(const struct gm_event_step *step, size_t event)
{
    return is_whole(step, event) ? 1 : step->memory[event];
}

/* Lets an event wait with the sign of g in this state; on g = 0 the motion decides, by where it leads. If it rests there
   the event waits for its return through g = 0, so that a ball without a rebound does not fall through the ground; a g that
   jumped there first leaves it. At a break it leads to a side that it does not leave at once. */
static void wait_ahead(const struct gm_event_step *step, size_t event, const double *look, double g,
                       double nothing)
{
    double *memory = &step->memory[event];
    if (is_whole(step, event)) {
        const double nearest = round(g), at = fabs(g - nearest) <= nothing ? nearest : g;
        *memory = floor(at);
        *memory -= *memory == at && sign_of_rate(step, event, look) < 0;
    } else if (fabs(g) > nothing) {
        *memory = sign_of(g);
    } else if (form_of(step, event) == GM_AT_JUMP) {
        *memory = 0;
    } else if (event < first_break(step->problem)) {
        const double ahead = sign_of_rate(step, event, look);
        *memory = ahead != 0 ? ahead : sign_of(*memory) * AT_REST;
    } else {
        *memory = 1;
        const double above = sign_of_rate(step, event, look);
        *memory = -1;
        const double below = sign_of_rate(step, event, look);
        *memory = above > 0 || (above < 0 && below > 0) ? 1 : below < 0 ? -1 : 0;
    }
}

static void find_g(const struct gm_event_step *step, const double *look, double *g)
{
    const double *modes = gm_events_modes(step->problem, step->memory);
    step->problem->events->values(step->problem, modes, look, g);
}

/* Lets breaks wait in a look, whose g depend on the modes of those before them; only those whose g is none of `before`, if
   that is given. */
static void settle(const struct gm_event_step *step, const double *look, const double *before, double *g)
{
    /* where g is 0 the modes of all others are needed, and others need its own */
    for (int pass = 0; pass < 3; pass++) {
        for (size_t i = first_break(step->problem); i < watched(step); i++) {
            find_g(step, look, g);
            if ((g[i] == 0) == (pass == 1) && !(before && g[i] == before[i])) {
                wait_ahead(step, i, look, g[i], 0);
            }
        }
    }
}

void gm_events_arm(struct gm_event_step *step)
{
    const struct gm_problem *problem = step->problem;
    double *look = step->scratch, *g = look + problem->n + 1;
    look_at(problem, step->t, step->begin, look);
    settle(step, look, NULL, g);
    find_g(step, look, g);
    for (size_t i = 0; i < first_break(problem) && step->first; i++) {
        wait_ahead(step, i, look, g[i], 0);
    }
}

static bool crosses(double sign, double value)
{
    return fabs(sign) == AT_REST ? value * sign < 0 : sign != 0 && (value < 0) != (sign < 0) && !isnan(value);
}

bool gm_events_near(const struct gm_event_step *step)
{
    const struct gm_events *events = step->problem->events;
    double *look = step->scratch, *g = look + step->problem->n + 1;
    look_at(step->problem, step->end_time, step->end, look);
    find_g(step, look, g);
    bool near = false;
    for (size_t i = 0; i < watched(step); i++) {
        const double sign = awaited(step, i);
        near |= (step->ends || !events->ends[i]) &&
                (sign == 0 ? g[i] != 0 : crosses(sign, watched_value(step, i, g[i])));
    }
    return near;
}

/* ---- the events of a step ---- */

/* The remaining part of a step, from `from` at t on for a time `rest`. */
struct rest {
    struct gm_event_step *step;
    double t, rest;
    size_t event;
    double *from, *to;                  /* states with all that belongs to them; `to`: room for a trial */
    double at;                          /* the time of `to` */
    double *look, *before, *after;      /* looks */
    double *at_begin, *at_end, *values; /* g of all events, at both ends and anywhere */
    double *modes;                      /* of breaks before a change */
    double *sizes;                      /* of the g of all events, at both ends of the step */
    double *jumps;                      /* 1: g jumps past 0 there, which is not an event */
    /* The fraction of `rest` where each event happens; NaN: it does not; infinite: it has. */
    double *places;
};

/* Writes the g of all events. */
static void find_values(struct rest *rest, double t, const double *y, double *values)
{
    look_at(rest->step->problem, t, y, rest->look);
    find_g(rest->step, rest->look, values);
}

/* Writes the state after a fraction of the rest to rest->to. */
static bool make_part(struct rest *rest, double s, bool counted)
{
    struct gm_event_step *step = rest->step;
    if (s == 0) {
        memcpy(rest->to, rest->from, step->size * sizeof *rest->to);
        rest->at = rest->t;
        return true;
    }
    step->parts = true;
    rest->at = step->part(step->data, rest->from, rest->t, s * rest->rest, rest->to, counted);
    return !isnan(rest->at);
}

/* Makes all of the rest, to the step's end. */
static bool make_rest(struct rest *rest)
{
    struct gm_event_step *step = rest->step;
    step->parts = true;
    if (isnan(step->part(step->data, rest->from, rest->t, rest->rest, step->end, true))) {
        return false;
    }
    find_values(rest, step->end_time, step->end, rest->at_end);
    return true;
}

/* The watched value of rest->event after a fraction of the rest; NaN if it cannot be made. */
static double value_after(void *data, double s)
{
    struct rest *rest = data;
    if (!make_part(rest, s, false)) {
        return NAN;
    }
    find_values(rest, rest->at, rest->to, rest->values);
    return watched_value(rest->step, rest->event, rest->values[rest->event]);
}

/* The fraction of the rest just beyond which an event's g passes 0; 0: at once, within the finder's accuracy; NaN: it
   cannot be found. */
static double place_of(struct rest *rest, size_t event)
{
    const double waiting = awaited(rest->step, event), sign = sign_of(waiting), least = 0x1p-51,
                 at_begin = watched_value(rest->step, event, rest->at_begin[event]),
                 at_end = watched_value(rest->step, event, rest->at_end[event]);
    double low = 0, at_low = at_begin;
    rest->event = event;
    /* just after an event g is 0 up to round-off: the motion leaves that, and comes back */
    for (double s = 0.5; sign_of(at_low) != sign && s > least && !isnan(at_low); s /= 2) {
        at_low = value_after(rest, low = s);
    }
    if (!isnan(at_low) && sign_of(at_low) != sign) {
        low = 0;
        at_low = at_begin;
    }
    const bool at_once = crosses(sign, at_low) || (fabs(waiting) == AT_REST && sign_of(at_low) != sign);
    return at_once ? 0 : gm_zero_beyond(value_after, rest, low, at_low, at_end);
}

/* Gives breaks without a side the one where the rest has led, and makes the rest on that side. Returns false if it
   fails. */
static bool take_sides(struct rest *rest)
{
    struct gm_event_step *step = rest->step;
    bool taken = false;
    for (size_t i = first_break(step->problem); i < watched(step); i++) {
        if (awaited(step, i) == 0 && sign_of(rest->at_end[i]) != 0) {
            step->memory[i] = sign_of(rest->at_end[i]);
            taken = true;
        }
    }
    return !taken || make_rest(rest);
}

/* The part of a g's size that is 0, or that a smooth g changes by within the accuracy of the finder. */
static const double NOTHING = 1e-6;

/* Finds where each g passes 0, and where an event whose conditions hold there happens first. Returns the fraction;
   infinity: nothing happens, and all wait with the signs at the end; NaN: it cannot be found. */
static double first_place(struct rest *rest)
{
    struct gm_event_step *step = rest->step;
    const struct gm_events *events = step->problem->events;
    double *signs = step->memory, first = INFINITY;
    const double least = 1e-6;
    for (size_t i = 0; i < watched(step); i++) {
        rest->places[i] = NAN;
        if ((events->ends[i] && !step->ends) ||
            !crosses(awaited(step, i), watched_value(step, i, rest->at_end[i]))) {
            continue;
        }
        const double place = place_of(rest, i);
        if (place == 0 && rest->t != step->t && fabs(rest->rest) < least * fabs(step->dt)) {
            continue; /* too short to leave the surface: the next step decides */
        }
        if (isnan(place) || !make_part(rest, place, false)) {
            return NAN;
        }
        find_values(rest, rest->at, rest->to, rest->values);
        const double g = rest->values[i];
        if (step->first && rest->t == step->t && place < least && i < first_break(step->problem)) {
            signs[i] = mode_beyond(step, i, g);
            continue;
        }
        rest->jumps[i] = form_of(step, i) == GM_AT_ZERO && place > 0 && i < first_break(step->problem) &&
                         (isinf(rest->sizes[i]) || fabs(g) > NOTHING * rest->sizes[i]);
        const bool happens =
            place == 0 || (rest->jumps[i] == 0 && events->change(step->problem, i, rest->look, NULL));
        rest->places[i] = place;
        first = happens ? fmin(first, place) : first;
    }
    for (size_t i = 0; i < watched(step) && first > 1; i++) {
        const bool moves = awaited(step, i) == 0 || !isnan(rest->places[i]);
        signs[i] = moves ? mode_at(step, i, rest->at_end[i]) : signs[i];
    }
    return first;
}

/* Adds the jumps of conserved quantities. */
static void book(struct rest *rest)
{
    const struct gm_problem *problem = rest->step->problem;
    const struct gm_events *events = problem->events;
    double *booked = rest->step->memory + booked_at(problem), *values = rest->values;
    if (events->quantities == 0) {
        return;
    }
    double *after = values + events->quantities;
    events->conserved(problem, rest->before, values);
    events->conserved(problem, rest->after, after);
    for (size_t i = 0; i < events->quantities; i++) {
        booked[i] += after[i] - values[i];
    }
}

/* The sign with which g moves away from a break at which it is. */
static double away(const struct gm_event_step *step, size_t event, double g)
{
    return !is_whole(step, event) ? step->memory[event] : g - step->memory[event] < 0.5 ? 1 : -1;
}

/* Lets another event wait in the state after a change. A g that only jumps has now reached 0, or passed it: the event
   happens at once, unless it has. */
static void wait_after(struct rest *rest, size_t event, double place, double g)
{
    const struct gm_event_step *step = rest->step;
    const bool happens = form_of(step, event) == GM_AT_JUMP && !isinf(rest->places[event]) &&
                         (step->ends || !step->problem->events->ends[event]) &&
                         crosses(awaited(step, event), watched_value(step, event, g));
    if (happens) {
        rest->places[event] = place;
        rest->jumps[event] = 0;
    } else {
        wait_ahead(step, event, rest->after, g, 0);
    }
}

/* Lets an event change the state rest->to at t, or a break the motion; `changed`: an event there has changed the state.
   Returns GM_EVENTS_HAPPENED; GM_EVENTS_FAILED if the scheme cannot start from there. */
static enum gm_event_outcome change(struct rest *rest, double t, size_t event, bool changed)
{
    struct gm_event_step *step = rest->step;
    const struct gm_problem *problem = step->problem;
    const struct gm_events *events = problem->events;
    const double roundoff = 1e-12, place = rest->places[event];
    const bool turns = event >= first_break(problem);
    double *after = rest->values + events->count;
    const double *modes = gm_events_modes(problem, step->memory);
    struct gm_event_part part = {event, rest->look, rest->before, rest->after, NULL, NULL};
    memcpy(rest->modes, modes, events->breaks * sizeof *modes);
    find_values(rest, t, rest->to, rest->values);
    memcpy(rest->before, rest->look, (problem->n + 1) * sizeof *rest->look);
    if (turns) {
        memcpy(rest->after, rest->before, (problem->n + 1) * sizeof *rest->look);
        const double g = rest->values[event];
        step->memory[event] = mode_beyond(step, event, g);
        if (changed) { /* to the side where the motion leads */
            wait_ahead(step, event, rest->before, is_whole(step, event) ? round(g) : 0, 0);
        }
    } else {
        events->change(problem, event, rest->before, rest->to);
        look_at(problem, t, rest->to, rest->after);
        double nothing = 0; /* 0 times a value that is not finite is NaN */
        for (size_t c = 0; c < problem->n; c++) {
            nothing += 0 * rest->after[c];
        }
        if (isnan(nothing)) {
            step->turned = event;
            step->turned_at = t;
            return GM_EVENTS_NO_VALUE;
        }
        rest->places[event] = INFINITY;
        memset(rest->to + step->state, 0, (step->size - step->state) * sizeof *rest->to);
        if (!step->restart(step->data, t, rest->to)) {
            return GM_EVENTS_FAILED;
        }
        find_g(step, rest->after, after);
    }
    step->memory[counts_at(problem) + event]++;
    for (size_t i = 0; i < first_break(problem) && !turns; i++) {
        /* a g that jumps is not 0 just beyond */
        const double size = rest->sizes[i], g = rest->values[i], off = is_whole(step, i) ? g - round(g) : g;
        if (i == event) {
            wait_ahead(step, i, rest->after, after[i], fmin(fabs(off), NOTHING * size) + roundoff * size);
        } else if (after[i] != g) {
            wait_after(rest, i, place, after[i]);
        }
    }
    settle(step, rest->after, rest->values, after);
    for (size_t i = first_break(problem); i < watched(step); i++) { /* g that jumped are not passed here */
        rest->places[i] = i != event && after[i] != rest->values[i] ? NAN : rest->places[i];
    }
    part.ahead = step->motion(step->data, rest->modes);
    part.beyond = step->motion(step->data, modes);
    look_at(problem, rest->t, rest->from, rest->look);
    if (part.ahead && part.beyond) {
        events->carry_within(problem, &part, rest->to);
        look_at(problem, t, rest->to, rest->after);
    }
    if (part.ahead && part.beyond && step->witness.see) {
        step->witness.see(step->witness.data, &part);
    }
    if (!turns) {
        book(rest);
    }
    return GM_EVENTS_HAPPENED;
}

/* Returns true if the intervals between events have become too short to end. */
static bool are_too_short(struct gm_event_step *step, double t)
{
    enum { MOST_SHORT = 50 };
    double *history = step->memory + history_at(step->problem);
    const double interval = fabs(t - history[LAST]);
    history[SHORT] = interval < 1e-9 * fabs(step->dt) ? history[SHORT] + 1 : 0;
    history[LAST] = t;
    return history[SHORT] >= MOST_SHORT;
}

static void note(struct gm_event_step *step, size_t event, double g)
{
    step->turned = event;
    step->turned_at = is_whole(step, event) ? round(g) : 0;
}

/* Makes the rest up to the first events, and their changes; *place: its fraction. */
static enum gm_event_outcome pass_first(struct rest *rest, double place)
{
    struct gm_event_step *step = rest->step;
    const struct gm_events *events = step->problem->events;
    const double together = 4e-15, begin = rest->t;
    bool many = false;
    size_t made = 0;
    if (!make_part(rest, place, true)) {
        return GM_EVENTS_FAILED;
    }
    const double t = step->reached = rest->at;
    for (size_t i = watched(step);
         i-- > 0 && place == 0;) { /* back on g = 0 within the accuracy of the finder */
        if (rest->places[i] == 0) {
            note(step, i, rest->at_begin[i]);
            return i < first_break(step->problem) ? GM_EVENTS_MANY : GM_EVENTS_SLIDE;
        }
    }
    for (size_t i = 0; i < watched(step); i++) {
        if (!(rest->places[i] <= place + together)) {
            continue;
        }
        look_at(step->problem, t, rest->to, rest->look);
        if (rest->places[i] < place - together || rest->jumps[i] != 0 ||
            !events->change(step->problem, i, rest->look, NULL)) {
            find_g(step, rest->look, rest->values); /* passed without its conditions, or by a jump */
            step->memory[i] =
                rest->places[i] <= place ? mode_beyond(step, i, rest->values[i]) : step->memory[i];
            rest->places[i] = INFINITY;
            continue;
        }
        if (events->ends[i]) {
            step->memory[counts_at(step->problem) + i]++;
            return GM_EVENTS_ENDED;
        }
        if (i < first_break(step->problem) && made++ == 0) {
            many = are_too_short(step, t);
        }
        const enum gm_event_outcome outcome = change(rest, t, i, made > 0);
        if (outcome != GM_EVENTS_HAPPENED) {
            return outcome;
        }
        note(step, i, rest->values[i]);
        memcpy(rest->from, rest->to, step->size * sizeof *rest->to);
        rest->t = t;
        i = i < first_break(step->problem) ? SIZE_MAX : i; /* its change may call any other */
    }
    find_values(rest, t, rest->to, rest->values);
    for (size_t i = first_break(step->problem); i < watched(step); i++) {
        const double sign = away(step, i, rest->values[i]);
        if (rest->places[i] <= place + together && sign_of_rate(step, i, rest->look) == -sign) {
            step->reached = place <= together ? begin : t;
            note(step, i, rest->values[i]);
            return GM_EVENTS_SLIDE;
        }
    }
    return many ? GM_EVENTS_MANY : GM_EVENTS_HAPPENED;
}

static size_t aligned(size_t numbers)
{
    const size_t line = 16; /* doubles */
    return (numbers + line - 1) / line * line;
}

size_t gm_events_scratch(const struct gm_problem *problem, size_t size)
{
    const size_t count = problem->events->count, quantities = problem->events->quantities;
    return 2 * aligned(size) + 3 * (problem->n + 1) + 8 * count + 2 * quantities;
}

enum gm_event_outcome gm_events_pass(struct gm_event_step *step)
{
    enum { MOST_IN_A_STEP = 1000 };
    const struct gm_problem *problem = step->problem;
    const size_t count = problem->events->count, width = problem->n + 1;
    double *next = step->scratch + 2 * aligned(step->size);
    struct rest rest = {.step = step,
                        .t = step->t,
                        .rest = step->dt,
                        .from = step->scratch,
                        .to = step->scratch + aligned(step->size),
                        .look = next,
                        .before = next + width,
                        .after = next + 2 * width,
                        .at_begin = next + 3 * width,
                        .at_end = next + 3 * width + count,
                        .places = next + 3 * width + 2 * count,
                        .modes = next + 3 * width + 3 * count,
                        .sizes = next + 3 * width + 4 * count,
                        .jumps = next + 3 * width + 5 * count,
                        .values = next + 3 * width + 6 * count};
    enum gm_event_outcome outcome = GM_EVENTS_NONE;
    if (!gm_events_near(step)) {
        return GM_EVENTS_NONE;
    }
    find_values(&rest, step->end_time, step->end, rest.at_end);
    find_values(&rest, step->t, step->begin, rest.at_begin);
    for (size_t i = 0; i < count; i++) {
        rest.sizes[i] = fabs(rest.at_begin[i]) + fabs(rest.at_end[i]);
    }
    memcpy(rest.from, step->begin, step->size * sizeof *rest.from);
    for (int made = 0; made <= MOST_IN_A_STEP; made++) {
        const double place = take_sides(&rest) ? first_place(&rest) : NAN;
        if (place > 1) {
            return outcome;
        }
        outcome = isnan(place) ? GM_EVENTS_FAILED : pass_first(&rest, place);
        outcome = outcome == GM_EVENTS_HAPPENED && made == MOST_IN_A_STEP ? GM_EVENTS_MANY : outcome;
        if (outcome == GM_EVENTS_FAILED || outcome == GM_EVENTS_NO_VALUE) {
            return outcome;
        }
        const bool ends =
            place == 1 || (step->end_time - rest.t) * step->dt <= 0; /* or beyond, by round-off */
        if (outcome != GM_EVENTS_HAPPENED || ends || step->varies) {
            memcpy(step->end, rest.to, step->size * sizeof *rest.to);
            return outcome;
        }
        rest.rest = step->end_time - rest.t;
        if (!make_rest(&rest)) {
            return GM_EVENTS_FAILED;
        }
        find_values(&rest, rest.t, rest.from, rest.at_begin);
    }
    return outcome;
}
