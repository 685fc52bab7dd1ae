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

/* The number of the first switch. */
static size_t first_switch(const struct gm_problem *problem)
{
    return problem->events->written;
}

/* Returns true if a switch is a break of this run. */
static bool is_break(const struct gm_event_step *step, size_t event)
{
    const struct gm_events *events = step->problem->events;
    return step->locates && event >= events->written && event < events->written + events->breaks;
}

static bool is_watched(const struct gm_event_step *step, size_t event)
{
    const struct gm_events *events = step->problem->events;
    return event < events->written ? step->ends || !events->ends[event]
                                   : events->inner[event - events->written] || is_break(step, event);
}

const double *gm_events_modes(const struct gm_problem *problem, const double *memory)
{
    return memory + first_switch(problem);
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
    for (size_t i = 0; i < first_switch(problem); i++) {
        sum += problem->events->ends[i] ? 0 : counts[i];
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
    const double *modes = gm_events_modes(step->problem, step->memory);
    const struct gm_problem *motion = step->motion(step->data, modes);
    const double sign =
        motion ? sign_of(step->problem->events->rate(step->problem, modes, motion, event, look)) : 0;
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
   jumped there first leaves it. At a switch it leads to a side that it does not leave at once. */
static void wait_ahead(const struct gm_event_step *step, size_t event, const double *look, double g,
                       double nothing)
{
    double *memory = &step->memory[event];
    if (is_whole(step, event)) {
        *memory = floor(g);
        *memory -= *memory == g && sign_of_rate(step, event, look) < 0;
    } else if (fabs(g) > nothing) {
        *memory = sign_of(g);
    } else if (form_of(step, event) == GM_AT_JUMP) {
        *memory = 0;
    } else if (event < first_switch(step->problem)) {
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

/* Sets the switches in a look, whose g depend on those before them; only those whose g is none of `before`, if that is
   given. Writes the g of all. */
static void settle(const struct gm_event_step *step, const double *look, const double *before, double *g)
{
    /* where g is 0 the modes of all others are needed, and others need its own */
    for (int pass = 0; pass < 3; pass++) {
        for (size_t i = first_switch(step->problem); i < step->problem->events->count; i++) {
            find_g(step, look, g);
            if (is_watched(step, i) && (g[i] == 0) == (pass == 1) && !(before && g[i] == before[i])) {
                wait_ahead(step, i, look, g[i], 0);
            }
        }
    }
    find_g(step, look, g);
}

void gm_events_arm(struct gm_event_step *step)
{
    const struct gm_problem *problem = step->problem;
    double *look = step->scratch, *g = look + problem->n + 1;
    look_at(problem, step->t, step->begin, look);
    settle(step, look, NULL, g);
    for (size_t i = 0; i < first_switch(problem) && step->first; i++) {
        wait_ahead(step, i, look, g[i], 0);
    }
}

static bool crosses(double sign, double value)
{
    return fabs(sign) == AT_REST ? value * sign < 0 : sign != 0 && (value < 0) != (sign < 0) && !isnan(value);
}

bool gm_events_near(const struct gm_event_step *step)
{
    double *look = step->scratch, *g = look + step->problem->n + 1;
    look_at(step->problem, step->end_time, step->end, look);
    find_g(step, look, g);
    bool near = false;
    for (size_t i = 0; i < step->problem->events->count; i++) {
        const double sign = awaited(step, i);
        near |= is_watched(step, i) && (sign == 0 ? g[i] != 0 : crosses(sign, watched_value(step, i, g[i])));
    }
    return near;
}

/* ---- the events of a step ---- */

/* The remaining part of a step, from `from` at t on for a time `rest`. */
struct rest {
    struct gm_event_step *step;
    double t, rest;
    double low, place; /* the fractions of `rest` up to which all is passed, and where g passes 0 next */
    size_t event;
    double *from, *to;                /* states with all that belongs to them; `to`: room for a trial */
    double at;                        /* the time of `to` */
    double *look, *before, *after;    /* looks */
    double *at_low, *at_end, *values; /* g of all events, at both ends and anywhere */
    double *modes;                    /* of switches before what happens */
    double *sizes;                    /* of the g of all events, at both ends of the step */
    double *places;                   /* the fraction of `rest` where each g passes; NaN: it does not */
    /* The number of the g whose passage lets an event happen here: its own, or that of a switch; `count`: it follows from
       another event. NaN: it does not happen; negative: it has. */
    double *causes;
};
static const double HAS_HAPPENED = -1;

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
    return !isnan(step->part(step->data, rest->from, rest->t, rest->rest, step->end, true));
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

/* The fraction of the rest just beyond which an event's g passes 0; rest->low: at once, within the finder's accuracy; NaN:
   it cannot be found. */
static double place_of(struct rest *rest, size_t event)
{
    const double waiting = awaited(rest->step, event), sign = sign_of(waiting), least = 0x1p-51,
                 at_low = watched_value(rest->step, event, rest->at_low[event]),
                 at_end = watched_value(rest->step, event, rest->at_end[event]);
    double low = rest->low, value = at_low;
    rest->event = event;
    /* just after an event g is 0 up to round-off: the motion leaves that, and comes back */
    for (double s = (1 - low) / 2; sign_of(value) != sign && s > least && !isnan(value); s /= 2) {
        value = value_after(rest, low = rest->low + s);
    }
    if (!isnan(value) && sign_of(value) != sign) {
        low = rest->low;
        value = at_low;
    }
    const bool at_once = crosses(sign, value) || (fabs(waiting) == AT_REST && sign_of(value) != sign);
    return at_once ? rest->low : gm_zero_beyond(value_after, rest, low, value, at_end);
}

/* Gives switches without a side the one where the rest has led, and makes the rest on that side. Returns false if it
   fails. */
static bool take_sides(struct rest *rest)
{
    struct gm_event_step *step = rest->step;
    bool taken = false, made = true;
    find_values(rest, step->end_time, step->end, rest->at_end);
    for (size_t i = first_switch(step->problem); i < step->problem->events->count; i++) {
        if (awaited(step, i) == 0 && sign_of(rest->at_end[i]) != 0) {
            step->memory[i] = sign_of(rest->at_end[i]);
            made = made && (!is_break(step, i) || make_rest(rest));
            taken = true;
        }
    }
    if (taken) {
        find_values(rest, step->end_time, step->end, rest->at_end);
    }
    return made;
}

/* The part of a g's size that is 0, or that a smooth g changes by within the accuracy of the finder. */
static const double NOTHING = 1e-6;

/* The part of a step that is too short for a g to leave 0. */
static const double SHORTEST = 1e-6;

/* Finds where each g passes 0 next. Returns the first of these fractions; infinity: none does; NaN: it cannot be found. */
static double first_place(struct rest *rest)
{
    struct gm_event_step *step = rest->step;
    double first = INFINITY;
    for (size_t i = 0; i < step->problem->events->count; i++) {
        rest->places[i] = NAN;
        if (!is_watched(step, i) || !crosses(awaited(step, i), watched_value(step, i, rest->at_end[i]))) {
            continue;
        }
        const double place = place_of(rest, i);
        if (place == 0 && rest->t != step->t && fabs(rest->rest) < SHORTEST * fabs(step->dt)) {
            continue; /* too short to leave the surface: the next step decides */
        }
        if (isnan(place)) {
            return NAN;
        }
        rest->places[i] = place;
        first = fmin(first, place);
    }
    for (size_t i = 0; i < first_switch(step->problem) && first > 1; i++) {
        step->memory[i] = awaited(step, i) == 0 ? sign_of(rest->at_end[i]) : step->memory[i];
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

/* The sign with which g moves away from a switch at which it is. */
static double away(const struct gm_event_step *step, size_t event, double g)
{
    return !is_whole(step, event) ? step->memory[event] : g - step->memory[event] < 0.5 ? 1 : -1;
}

/* Lets another event wait in the state after a change. A g that only jumps has now reached 0, or passed it: the event
   happens at once, unless it has. One that is about to happen still does. */
static void wait_after(struct rest *rest, size_t event, double g)
{
    const struct gm_event_step *step = rest->step;
    double *cause = &rest->causes[event];
    if (form_of(step, event) == GM_AT_JUMP && isnan(*cause) && is_watched(step, event) &&
        crosses(awaited(step, event), watched_value(step, event, g))) {
        *cause = (double)step->problem->events->count;
    } else if (!(*cause >= 0)) {
        wait_ahead(step, event, rest->after, g, 0);
    }
}

/* Places closer than this are one. */
static const double TOGETHER = 4e-15;

/* Returns true if a g passes 0 in rest->to. */
static bool passes_here(const struct rest *rest, size_t event)
{
    return rest->places[event] <= rest->place + TOGETHER;
}

/* Lets an event change the state rest->to at t, or a break the motion. Returns GM_EVENTS_HAPPENED, GM_EVENTS_NO_VALUE, or
   GM_EVENTS_FAILED if the scheme cannot start from there. */
static enum gm_event_outcome change(struct rest *rest, double t, size_t event)
{
    struct gm_event_step *step = rest->step;
    const struct gm_problem *problem = step->problem;
    const struct gm_events *events = problem->events;
    const double roundoff = 1e-12;
    const bool turns = event >= first_switch(problem);
    double *after = rest->values + events->count;
    const double *modes = gm_events_modes(problem, step->memory);
    struct gm_event_part part = {
        event, (size_t)rest->causes[event], rest->modes, rest->look, rest->before, rest->after, NULL, NULL};
    rest->causes[event] = HAS_HAPPENED;
    memcpy(rest->modes, modes, (events->count - events->written) * sizeof *modes);
    find_values(rest, t, rest->to, rest->values);
    memcpy(rest->before, rest->look, (problem->n + 1) * sizeof *rest->look);
    if (turns) {
        memcpy(rest->after, rest->before, (problem->n + 1) * sizeof *rest->look);
        step->memory[event] = mode_beyond(step, event, rest->values[event]);
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
        memset(rest->to + step->state, 0, (step->size - step->state) * sizeof *rest->to);
        if (!step->restart(step->data, t, rest->to)) {
            return GM_EVENTS_FAILED;
        }
    }
    step->memory[counts_at(problem) + event]++;
    for (size_t i = events->written; i < events->count && !turns; i++) {
        const double g = rest->values[i];
        if (passes_here(rest, i) && sign_of_rate(step, i, rest->after) == -away(step, i, g)) {
            wait_ahead(step, i, rest->after, is_whole(step, i) ? round(g) : 0, 0); /* turned back */
        }
    }
    settle(step, rest->after, rest->values, after);
    for (size_t i = 0; i < events->written && !turns; i++) {
        /* a g that jumps is not 0 just beyond */
        const double size = rest->sizes[i], g = rest->values[i];
        if (i == event) {
            wait_ahead(step, i, rest->after, after[i], fmin(fabs(g), NOTHING * size) + roundoff * size);
        } else if (after[i] != g) {
            wait_after(rest, i, after[i]);
        }
    }
    /* g that jumped are settled, and not passed here */
    for (size_t i = events->written; i < events->count; i++) {
        const bool jumped = after[i] != rest->values[i];
        rest->places[i] = jumped ? NAN : rest->places[i];
        rest->causes[i] = jumped && rest->causes[i] >= 0 ? NAN : rest->causes[i];
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

/* Lets an event wait beyond g, which is now this, without happening. */
static void pass_by(const struct rest *rest, size_t event, double g)
{
    const double nothing = NOTHING * rest->sizes[event];
    if (rest->causes[event] == (double)event && fabs(g) <= nothing) {
        rest->step->memory[event] = mode_beyond(rest->step, event, g);
    } else {
        wait_ahead(rest->step, event, rest->look, g, nothing);
    }
}

/* Turns the switches that pass in rest->to, and finds the causes of what happens there: breaks; events whose g passes 0,
   or jumps to 0, or from 0 before it has passed, or past 0 if it only jumps. Other events pass by. Returns false if nothing
   happens; else breaks are not turned yet. */
static bool find_causes(struct rest *rest)
{
    struct gm_event_step *step = rest->step;
    const struct gm_events *events = step->problem->events;
    double *after = rest->values + events->count;
    const bool begins = step->first && rest->t == step->t && rest->place < SHORTEST;
    size_t turned = SIZE_MAX;
    bool some = false;
    find_values(rest, rest->at, rest->to, rest->values);
    memcpy(rest->modes, step->memory + events->written, (events->count - events->written) * sizeof *after);
    for (size_t i = events->written; i < events->count; i++) {
        const bool passes = passes_here(rest, i), breaks = passes && is_break(step, i);
        rest->causes[i] = breaks ? (double)i : NAN;
        step->memory[i] = passes ? mode_beyond(step, i, rest->values[i]) : step->memory[i];
        turned = passes ? i : turned;
        some |= breaks;
    }
    settle(step, rest->look, rest->values, after);
    for (size_t i = 0; i < events->written; i++) {
        const double g = rest->values[i], size = rest->sizes[i], nothing = NOTHING * fabs(after[i] - g);
        const bool only = form_of(step, i) == GM_AT_JUMP, passes = passes_here(rest, i),
                   jumps = after[i] != g,
                   pole = !only && rest->place > 0 && (isinf(size) || fabs(g) > NOTHING * size),
                   leaps = jumps && (only ? crosses(awaited(step, i), watched_value(step, i, after[i]))
                                          : fabs(after[i]) <= nothing ||
                                                (fabs(g) <= nothing &&
                                                 sign_of_rate(step, i, rest->look) * awaited(step, i) < 0)),
                   happens = is_watched(step, i) && !begins && ((passes && !pole) || leaps);
        rest->causes[i] = passes ? (double)i : happens ? (double)turned : NAN;
        some |= happens && events->change(step->problem, i, rest->look, NULL);
        if (!happens && (passes || jumps)) {
            pass_by(rest, i, after[i]);
            rest->causes[i] = NAN;
        }
    }
    for (size_t i = 0; i < events->written && !some; i++) {
        if (!isnan(rest->causes[i])) {
            pass_by(rest, i, after[i]);
        }
    }
    for (size_t i = events->written; i < events->count && some; i++) {
        step->memory[i] = is_break(step, i) ? rest->modes[i - events->written] : step->memory[i];
    }
    return some;
}

/* Passes what is at rest->place: makes the rest up to it, and the changes there. GM_EVENTS_NONE: nothing happens. */
static enum gm_event_outcome pass_first(struct rest *rest)
{
    struct gm_event_step *step = rest->step;
    const struct gm_events *events = step->problem->events;
    const double begin = rest->t;
    size_t made = 0;
    bool many = false;
    if (!make_part(rest, rest->place, false)) {
        return GM_EVENTS_FAILED;
    }
    const double t = step->reached = rest->at;
    for (size_t i = events->count; i-- > 0 && rest->place == 0 && !(step->first && begin == step->t);) {
        if (rest->places[i] == 0 && (i < events->written || is_break(step, i))) {
            note(step, i < events->written ? SIZE_MAX : i, rest->at_low[i]);
            return i < events->written ? GM_EVENTS_MANY : GM_EVENTS_SLIDE; /* back on g = 0 */
        }
    }
    if (!find_causes(rest)) {
        rest->low = rest->place;
        find_values(rest, t, rest->to, rest->at_low);
        note(step, 0, 0);
        return GM_EVENTS_NONE;
    }
    if (!make_part(rest, rest->place, true)) {
        return GM_EVENTS_FAILED;
    }
    for (size_t k = 0; k < events->count; k++) { /* breaks first */
        const size_t i = (events->written + k) % events->count;
        if (!(rest->causes[i] >= 0)) {
            continue;
        }
        find_values(rest, t, rest->to, rest->values);
        if (i < events->written && !events->change(step->problem, i, rest->look, NULL)) {
            pass_by(rest, i, rest->values[i]);
            rest->causes[i] = HAS_HAPPENED;
            continue;
        }
        if (i < events->written && events->ends[i]) {
            step->memory[counts_at(step->problem) + i]++;
            return GM_EVENTS_ENDED;
        }
        if (i < events->written && made++ == 0) {
            many = are_too_short(step, t);
        }
        note(step, i, rest->values[i]);
        const enum gm_event_outcome outcome = change(rest, t, i);
        if (outcome != GM_EVENTS_HAPPENED) {
            return outcome;
        }
        memcpy(rest->from, rest->to, step->size * sizeof *rest->from);
        rest->t = t;
        k = i < events->written ? events->count - events->written - 1
                                : k; /* its change may call any other event */
    }
    rest->low = 0;
    find_values(rest, t, rest->from, rest->at_low);
    for (size_t i = events->written; i < events->count; i++) {
        const double sign = away(step, i, rest->at_low[i]);
        if (is_break(step, i) && passes_here(rest, i) && sign_of_rate(step, i, rest->look) == -sign) {
            step->reached = rest->place <= TOGETHER ? begin : t;
            note(step, i, rest->at_low[i]);
            return GM_EVENTS_SLIDE;
        }
    }
    if (many) {
        note(step, SIZE_MAX, 0);
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
                        .at_low = next + 3 * width,
                        .at_end = next + 3 * width + count,
                        .places = next + 3 * width + 2 * count,
                        .modes = next + 3 * width + 3 * count,
                        .sizes = next + 3 * width + 4 * count,
                        .causes = next + 3 * width + 5 * count,
                        .values = next + 3 * width + 6 * count};
    if (!gm_events_near(step)) {
        return GM_EVENTS_NONE;
    }
    find_values(&rest, step->end_time, step->end, rest.at_end);
    find_values(&rest, step->t, step->begin, rest.at_low);
    for (size_t i = 0; i < count; i++) {
        rest.sizes[i] = fabs(rest.at_low[i]) + fabs(rest.at_end[i]);
    }
    memcpy(rest.from, step->begin, step->size * sizeof *rest.from);
    bool some = false;
    for (int made = 0; made <= MOST_IN_A_STEP; made++) {
        rest.place = take_sides(&rest) ? first_place(&rest) : NAN;
        if (rest.place > 1) {
            return some ? GM_EVENTS_HAPPENED : GM_EVENTS_NONE;
        }
        enum gm_event_outcome outcome = isnan(rest.place) ? GM_EVENTS_FAILED : pass_first(&rest);
        const bool last = made == MOST_IN_A_STEP && outcome <= GM_EVENTS_HAPPENED;
        outcome = last ? GM_EVENTS_MANY : outcome;
        if (outcome == GM_EVENTS_FAILED || outcome == GM_EVENTS_NO_VALUE) {
            return outcome;
        }
        const bool ends =
            rest.place == 1 || (step->end_time - rest.t) * step->dt <= 0; /* or beyond, by round-off */
        if (outcome > GM_EVENTS_HAPPENED || (outcome == GM_EVENTS_HAPPENED && (ends || step->varies))) {
            memcpy(step->end, rest.to, step->size * sizeof *rest.to);
            return outcome;
        }
        if (outcome == GM_EVENTS_HAPPENED) {
            some = true;
            rest.rest = step->end_time - rest.t;
            if (!make_rest(&rest)) {
                return GM_EVENTS_FAILED;
            }
        }
    }
    return GM_EVENTS_FAILED;
}
