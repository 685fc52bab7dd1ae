/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The zero of a function along a step, and the events of a step one after the other. */
#include "core/events.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "core/basics.h"

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
    enum { MOST = 100 };
    const double tolerance = 2.2e-16;
    struct place other = {low, at_low}, newest = {1, at_end}, third = other;
    const bool below = at_end < 0;
    if (isnan(at_low) || isnan(at_end) || (at_low < 0) == below) {
        return NAN;
    }
    double t = at_end / (at_end - at_low), width = 1 - low, stride = tolerance;
    for (int i = 0; i < MOST && width > 2 * tolerance; i++) {
        const double least = tolerance / width,
                     s = newest.s + (isnan(t) ? 0.5 : fmin(fmax(t, least), 1 - least)) * (other.s - newest.s);
        const struct place next = {s, value(data, s)};
        if (isnan(next.value)) {
            return NAN;
        }
        const bool same = (next.value < 0) == (newest.value < 0);
        const double moved = fabs(next.s - newest.s);
        third = same ? newest : other;
        other = same ? other : newest;
        newest = next;
        width = fabs(other.s - newest.s);
        t = next_share(newest, other, third);
        /* near the zero the values are round-off, but the other end may still be far: strides that grow lead across the
           zero, and halves follow */
        const bool is_near = newest.value == 0 || other.value == 0 || t * width < tolerance ||
                             (t == 0.5 && moved <= 64 * tolerance);
        stride = !same && stride > tolerance ? 1 : stride;
        if (is_near && stride < width / 2) {
            t = stride / width;
            stride *= 4;
        }
    }
    return (newest.value < 0) == below ? newest.s : other.s;
}

/* ---- the memory ---- */

/* Signs are first; then counts, the jumps of quantities, and the last event's time with the number of short intervals. */
enum { LAST, SHORT, BEHIND };

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
    return memory + problem->events->written;
}

size_t gm_events_memory(const struct gm_problem *problem)
{
    return problem->events ? 2 * problem->events->count + problem->events->quantities + BEHIND : 0;
}

double gm_events_happened(const struct gm_problem *problem, const double *memory, size_t event)
{
    const struct gm_events *events = problem->events;
    const double *counts = memory + events->count;
    double sum = 0;
    for (size_t i = 0; i < events->written; i++) {
        sum += events->ends[i] ? 0 : counts[i];
    }
    return event < events->count ? counts[event] : sum;
}

double gm_events_booked(const struct gm_problem *problem, const double *memory, size_t quantity)
{
    return memory[2 * problem->events->count + quantity];
}

/* Copies the last member of `count` states, with their times. */
static void look_at(const struct gm_problem *problem, const double *times, const double *states, size_t count,
                    double *looks)
{
    for (size_t k = 0; k < count; k++) {
        for (size_t c = 0; c < problem->n; c++) {
            looks[c * count + k] = states[(k * problem->n + c + 1) * problem->m - 1];
        }
        looks[problem->n * count + k] = times[k];
    }
}

/* The size of the sign with which an event waits for a motion that rests on g = 0. */
static const double AT_REST = 0.5;

/* The part of a step that is too short for a g to leave 0. */
static const double SHORTEST = 1e-6;

static double sign_of(double value)
{
    return (value > 0) - (value < 0);
}

/* The sign of dg/dt ahead, of the motion with these modes; `later` after the look, as a part of the step. */
static double sign_of_rate(const struct gm_event_step *step, size_t event, const double *look, double later)
{
    const double *modes = gm_events_modes(step->problem, step->memory);
    const struct gm_problem *motion = step->motion(step->data, modes);
    const double rate =
        motion ? step->problem->events->rate(step->problem, modes, motion, event, look, later * step->dt) : 0;
    return step->dt < 0 ? -sign_of(rate) : sign_of(rate);
}

static enum gm_event_form form_of(const struct gm_event_step *step, size_t event)
{
    return step->problem->events->forms[event];
}

/* The value whose sign changes, from that of g. Whole numbers of g are zeros of (g - k)(k + 1 - g), which is above 0 until
   g leaves its interval at either end. A g that jumps to 0 is there. Where the g of an event has no value, as that of
   sqrt(y) = 0 beyond y = 0, it counts as passed. */
static double watched_value(const struct gm_event_step *step, size_t event, double g)
{
    const double mode = step->memory[event];
    switch (form_of(step, event)) {
    case GM_AT_WHOLE:
        return g == mode + 1 ? -DBL_MIN : (g - mode) * (mode + 1 - g);
    case GM_AT_JUMP:
        return mode * g > 0 ? mode : -mode;
    default:
        return isnan(g) && event < step->problem->events->written ? -mode : g;
    }
}

/* The sign with which an event waits. */
static double awaited(const struct gm_event_step *step, size_t event)
{
    return form_of(step, event) == GM_AT_WHOLE ? 1 : step->memory[event];
}

static bool crosses(double sign, double value)
{
    return fabs(sign) == AT_REST ? value * sign < 0 : sign != 0 && (value < 0) != (sign < 0) && !isnan(value);
}

/* Returns true if g, which is now this, has passed a place where the event happens. */
static bool has_passed(const struct gm_event_step *step, size_t event, double g)
{
    return is_watched(step, event) && crosses(awaited(step, event), watched_value(step, event, g));
}

/* Sets the mode after g, which is now this, has passed. */
static void turn(const struct gm_event_step *step, size_t event, double g)
{
    double *mode = &step->memory[event];
    if (form_of(step, event) == GM_AT_WHOLE) {
        *mode += g - *mode < 0.5 ? -1 : 1;
    } else {
        *mode = -*mode;
    }
}

/* Sets the mode of a switch at g = 0 to the side that the motion does not leave at once. */
static void choose_side(const struct gm_event_step *step, size_t event, const double *look)
{
    double *mode = &step->memory[event];
    *mode = 1;
    const double above = sign_of_rate(step, event, look, 0);
    *mode = -1;
    const double below = sign_of_rate(step, event, look, 0);
    *mode = above > 0 || above * below < 0 ? 1 : fmin(below, 0);
}

/* Returns true if the motion leads back through a switch that g, which is now this, has passed. */
static bool leads_back(const struct gm_event_step *step, size_t event, const double *look, double g)
{
    double away = step->memory[event];
    if (form_of(step, event) == GM_AT_WHOLE) {
        away = g - away < 0.5 ? 1 : -1;
    }
    return sign_of_rate(step, event, look, 0) == -away;
}

/* Lets an event wait with the sign of g in this state; on g = 0 the motion decides, by where it leads. If it rests there
   the event waits for its return through g = 0, so that a ball without a rebound does not fall through the ground; a g that
   jumped there first leaves it. */
static void wait_ahead(const struct gm_event_step *step, size_t event, const double *look, double g,
                       double nothing)
{
    double *mode = &step->memory[event];
    if (form_of(step, event) == GM_AT_WHOLE) {
        *mode = floor(g);
        *mode -= *mode == g && sign_of_rate(step, event, look, 0) < 0;
    } else if (fabs(g) > nothing) {
        *mode = sign_of(g);
    } else if (form_of(step, event) == GM_AT_JUMP) {
        *mode = 0;
    } else if (event >= step->problem->events->written) {
        choose_side(step, event, look);
    } else {
        const double ahead = sign_of_rate(step, event, look, 0);
        *mode = ahead != 0 ? ahead : sign_of(*mode) * AT_REST;
    }
}

/* Writes the g of all events in `count` looks. */
static void find_g(const struct gm_event_step *step, const double *looks, size_t count, double *g)
{
    const double *modes = gm_events_modes(step->problem, step->memory);
    step->problem->events->values(step->problem, modes, looks, count, g);
}

/* Sets the switches in a look, whose g depend on those before them; only those whose g is none of `before`, if that is
   given. Writes the g of all. */
static void settle(const struct gm_event_step *step, const double *look, const double *before, double *g)
{
    /* where g is 0 the modes of all others are needed, and others need its own */
    for (int pass = 0; pass < 3; pass++) {
        for (size_t i = step->problem->events->written; i < step->problem->events->count; i++) {
            find_g(step, look, 1, g);
            if (is_watched(step, i) && (g[i] == 0) == (pass == 1) && !(before && g[i] == before[i])) {
                wait_ahead(step, i, look, g[i], 0);
            }
        }
    }
    find_g(step, look, 1, g);
}

void gm_events_arm(struct gm_event_step *step)
{
    const struct gm_problem *problem = step->problem;
    double *look = step->scratch, *g = look + problem->n + 1;
    look_at(problem, &step->t, step->begin, 1, look);
    settle(step, look, NULL, g);
    for (size_t i = 0; i < problem->events->written && step->first; i++) {
        wait_ahead(step, i, look, g[i], 0);
    }
}

int64_t gm_events_near(const struct gm_event_step *step, const double *states, const double *times,
                       int64_t count)
{
    const size_t most = (size_t)count;
    double *looks = step->scratch, *g = looks + (step->problem->n + 1) * most;
    size_t first = most;
    look_at(step->problem, times, states, most, looks);
    find_g(step, looks, most, g);
    for (size_t i = 0; i < step->problem->events->count; i++) {
        const bool undecided = is_watched(step, i) && awaited(step, i) == 0;
        for (size_t k = 0; k < first; k++) {
            const double value = g[i * most + k];
            first = has_passed(step, i, value) || (undecided && (value > 0 || value < 0)) ? k : first;
        }
    }
    return (int64_t)first;
}

/* ---- the events of a step ---- */

/* The remaining part of a step, from step->from at t on for a time `rest`. */
struct rest {
    struct gm_event_step *step;
    double t, rest;
    double low, place;    /* the fractions of `rest` up to which all is passed, and where g passes 0 next */
    size_t event;         /* whose place is looked for */
    double at;            /* the time of `to` */
    double *look, *after; /* looks */
    double *at_low, *at_end, *values; /* g of all events, at both ends and anywhere */
    double *new_values;               /* g of all events after a change */
    double *modes;                    /* of switches before what happens */
    double *sizes;                    /* of the g of all events, at both ends of the step */
    double *roundoffs;                /* of these g at the start of the run */
    double *places;                   /* the fraction of `rest` where each g passes; NaN: it does not */
    /* The number of the g whose passage lets an event happen here: its own, or that of a switch; `count`: it follows from
       another event. NaN: it does not happen; negative: it has. */
    double *causes;
};
static const double HAS_HAPPENED = -1;

/* Writes the g of all events. */
static void find_values(struct rest *rest, double t, const double *y, double *values)
{
    look_at(rest->step->problem, &t, y, 1, rest->look);
    find_g(rest->step, rest->look, 1, values);
}

/* Writes the state after a fraction of the rest, and its time to rest->at. `counted`: the run takes this part. */
static bool make_part(struct rest *rest, double s, double *to, bool counted)
{
    struct gm_event_step *step = rest->step;
    if (s == 0) {
        memcpy(to, step->from, step->size * sizeof *to);
        rest->at = rest->t;
        return true;
    }
    step->parts = true;
    rest->at = step->part(step->data, step->from, rest->t, s * rest->rest, to, counted);
    return !isnan(rest->at);
}

/* The watched value of rest->event after a fraction of the rest; NaN if it cannot be made. */
static double value_after(void *data, double s)
{
    struct rest *rest = data;
    double *to = rest->step->to;
    if (!make_part(rest, s, to, false)) {
        return NAN;
    }
    find_values(rest, rest->at, to, rest->values);
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
    for (double s = (1 - low) / 2; sign_of(value) != sign && s > least; s /= 2) {
        value = value_after(rest, low = rest->low + s);
        if (isnan(value)) {
            return NAN;
        }
    }
    if (sign_of(value) == sign) {
        return gm_zero_beyond(value_after, rest, low, value, at_end);
    }
    const bool at_once = crosses(sign, at_low) || fabs(waiting) == AT_REST;
    return at_once ? rest->low : gm_zero_beyond(value_after, rest, rest->low, at_low, at_end);
}

/* Gives switches without a side the one where the rest has led, and makes the rest on that side. Returns false if it
   fails. */
static bool take_sides(struct rest *rest)
{
    struct gm_event_step *step = rest->step;
    find_values(rest, step->end_time, step->end, rest->at_end);
    for (size_t i = step->problem->events->written; i < step->problem->events->count; i++) {
        if (awaited(step, i) == 0 && rest->at_end[i] != 0) {
            step->memory[i] = sign_of(rest->at_end[i]);
            if (is_break(step, i) && !make_part(rest, 1, step->end, true)) {
                return false;
            }
            find_values(rest, step->end_time, step->end, rest->at_end);
        }
    }
    return true;
}

/* Places closer than this are one. */
static const double TOGETHER = 4e-15;

/* The part of a g's size that is 0, or that a smooth g changes by within the accuracy of the finder. */
static const double NOTHING = 1e-6;

/* Returns true if the g of rest->event, which has no value at the end, is 0 just before this place. */
static bool ends_at_0(struct rest *rest, double place)
{
    const double before = fmax(place - 2 * TOGETHER, rest->low);
    return !isnan(value_after(rest, before)) &&
           fabs(rest->values[rest->event]) <= NOTHING * rest->sizes[rest->event];
}

/* Finds where each g passes 0 next. Returns the first of these fractions; infinity: none does; NaN: it cannot be found. */
static double first_place(struct rest *rest)
{
    struct gm_event_step *step = rest->step;
    double first = INFINITY;
    for (size_t i = 0; i < step->problem->events->count; i++) {
        rest->places[i] = NAN;
        if (!has_passed(step, i, rest->at_end[i])) {
            continue;
        }
        const double place = place_of(rest, i);
        if (place == 0 && rest->t != step->t && fabs(rest->rest) < SHORTEST * fabs(step->dt)) {
            continue; /* too short to leave the surface: the next step decides */
        }
        if (isnan(place)) {
            return NAN;
        }
        if (isnan(rest->at_end[i]) && !ends_at_0(rest, place)) {
            step->memory[i] = 0;
            continue;
        }
        rest->places[i] = place;
        first = fmin(first, place);
    }
    for (size_t i = 0; i < step->problem->events->written && first > 1; i++) {
        step->memory[i] = awaited(step, i) == 0 ? sign_of(rest->at_end[i]) : step->memory[i];
    }
    return first;
}

/* Adds the jumps of conserved quantities. */
static void book(struct rest *rest)
{
    const struct gm_problem *problem = rest->step->problem;
    const size_t quantities = problem->events->quantities;
    double *booked = rest->step->memory + 2 * problem->events->count, *values = rest->values;
    problem->events->conserved(problem, rest->look, values);
    problem->events->conserved(problem, rest->after, values + quantities);
    for (size_t i = 0; i < quantities; i++) {
        booked[i] += values[quantities + i] - values[i];
    }
}

/* Returns true if a g passes 0 in step->to. */
static bool passes_here(const struct rest *rest, size_t event)
{
    return rest->places[event] <= rest->place + TOGETHER;
}

/* Lets an event wait beyond g, which is now this, without happening. */
static void pass_by(const struct rest *rest, size_t event, double g)
{
    const double nothing = NOTHING * rest->sizes[event];
    if (passes_here(rest, event) && fabs(g) <= nothing && form_of(rest->step, event) != GM_AT_JUMP) {
        turn(rest->step, event, g);
    } else {
        wait_ahead(rest->step, event, rest->look, g, nothing);
    }
}

/* Returns true if an event happens in step->to by what passes there: if its g passes 0, but at no pole; or if a switch in g
   lets it jump to 0, or from 0 before it has passed. A g that only jumps also happens if it jumps past 0. */
static bool is_caused(const struct rest *rest, size_t event)
{
    const struct gm_event_step *step = rest->step;
    const double g = rest->values[event], after = rest->new_values[event], size = rest->sizes[event],
                 nothing = NOTHING * fabs(after - g);
    const bool begins = step->first && rest->t == step->t && rest->place < SHORTEST &&
                        rest->at_low[event] != 0 && fabs(rest->at_low[event]) <= rest->roundoffs[event];
    if (!is_watched(step, event) || begins) {
        return false;
    }
    if (form_of(step, event) == GM_AT_JUMP) {
        return passes_here(rest, event) || (after != g && has_passed(step, event, after));
    }
    const bool pole = rest->place > 0 && (isinf(size) || fabs(g) > NOTHING * size),
               leaves = fabs(g) <= fmax(nothing, isinf(size) ? 0 : NOTHING * size) &&
                        sign_of_rate(step, event, rest->look, 0) * awaited(step, event) < 0;
    return (passes_here(rest, event) && !pole) || (after != g && (fabs(after) <= nothing || leaves));
}

/* Turns the switches that pass in step->to, but breaks, and finds what they and breaks cause. Other events pass by. */
static void find_causes(struct rest *rest)
{
    struct gm_event_step *step = rest->step;
    const struct gm_events *events = step->problem->events;
    const size_t switches = (events->count - events->written) * sizeof *rest->modes;
    size_t turned = events->count;
    find_values(rest, rest->at, step->to, rest->values);
    memcpy(rest->modes, step->memory + events->written, switches);
    for (size_t i = events->written; i < events->count; i++) {
        const bool passes = passes_here(rest, i);
        rest->causes[i] = passes && is_break(step, i) ? (double)i : NAN;
        if (passes) {
            turn(step, i, rest->values[i]);
            turned = i;
        }
    }
    settle(step, rest->look, rest->values, rest->new_values);
    for (size_t i = 0; i < events->written; i++) {
        const bool passes = passes_here(rest, i);
        rest->causes[i] = NAN;
        if (is_caused(rest, i)) {
            rest->causes[i] = (double)(passes ? i : turned);
        } else if (passes || fabs(rest->new_values[i] - rest->values[i]) > NOTHING * rest->sizes[i]) {
            pass_by(rest, i, rest->new_values[i]); /* a g without a jump, as y |y|, still has to leave 0 */
        }
    }
    memcpy(step->memory + events->written, rest->modes,
           step->locates ? events->breaks * sizeof *rest->modes : 0);
}

/* Returns the next event that is caused, breaks first; `count`: none. */
static size_t next_caused(const struct rest *rest)
{
    const struct gm_events *events = rest->step->problem->events;
    size_t k = 0;
    while (k < events->count && !(rest->causes[(events->written + k) % events->count] >= 0)) {
        k++;
    }
    return k < events->count ? (events->written + k) % events->count : k;
}

/* Lets switches that pass in step->to wait on the side of before, if an event has led the motion back. */
static void turn_back(struct rest *rest)
{
    const struct gm_event_step *step = rest->step;
    for (size_t i = step->problem->events->written; i < step->problem->events->count; i++) {
        const double g = rest->values[i];
        if (passes_here(rest, i) && leads_back(step, i, rest->after, g)) {
            wait_ahead(step, i, rest->after, form_of(step, i) == GM_AT_WHOLE ? round(g) : 0, 0);
        }
    }
}

/* Lets an event wait in the state that it has led to. Where g is flat, as y |y| at 0, dg/dt there is round-off: the motion
   is back on the side that it came from if dg/dt has that sign a short time later. A motion that the event has not stopped
   does not rest; the end of the step decides. */
static void wait_beyond(struct rest *rest, size_t event, double g, double nothing)
{
    const struct gm_event_step *step = rest->step;
    double *mode = &step->memory[event];
    const double side = sign_of(*mode);
    wait_ahead(step, event, rest->after, g, nothing);
    if (fabs(g) > nothing || form_of(step, event) == GM_AT_JUMP) {
        return;
    }
    if (fabs(*mode) == AT_REST && sign_of_rate(step, event, rest->look, 0) == 0) {
        *mode = 0;
    } else if (*mode == -side && sign_of_rate(step, event, rest->after, SHORTEST) == side) {
        *mode = side;
    }
}

/* Follows g that have jumped at an event or a break: switches are settled, and not passed here; other events wait in the
   state after an event. A g that only jumps has now reached 0 or passed it: the event happens at once, unless it has. One
   that is about to happen still does. */
static void wait_after(struct rest *rest, size_t event)
{
    const struct gm_event_step *step = rest->step;
    const size_t written = step->problem->events->written, count = step->problem->events->count;
    const double roundoff = 1e-12;
    for (size_t i = 0; i < count; i++) {
        const double g = rest->values[i], after = rest->new_values[i], size = rest->sizes[i];
        double *cause = &rest->causes[i];
        if (i == event && i < written) { /* a g that jumps is not 0 just beyond */
            wait_beyond(rest, i, after, fmin(fabs(g), NOTHING * size) + roundoff * size);
        } else if (i >= written && after != g) {
            rest->places[i] = *cause = NAN;
        } else if (event < written && after != g && !(*cause >= 0)) {
            if (form_of(step, i) == GM_AT_JUMP && isnan(*cause) && has_passed(step, i, after)) {
                *cause = (double)count;
            } else {
                wait_ahead(step, i, rest->after, after, 0);
            }
        }
    }
}

/* Notes the event or break that the step has reached, with its g. */
static void note(struct gm_event_step *step, size_t event, double g)
{
    step->turned = event;
    step->turned_at = form_of(step, event) == GM_AT_WHOLE ? round(g) : 0;
}

/* Lets an event that is caused change the state step->to, or a break the motion; rest->look and rest->values are of that
   state. Returns GM_EVENTS_HAPPENED, GM_EVENTS_NO_VALUE, or GM_EVENTS_FAILED if the scheme cannot start from there. */
static enum gm_event_outcome change(struct rest *rest, size_t event)
{
    struct gm_event_step *step = rest->step;
    const struct gm_problem *problem = step->problem;
    const struct gm_events *events = problem->events;
    const double *modes = gm_events_modes(problem, step->memory);
    struct gm_event_part part = {
        event, (size_t)rest->causes[event], rest->modes, rest->look, rest->after, NULL, NULL};
    rest->causes[event] = HAS_HAPPENED;
    note(step, event, rest->values[event]);
    memcpy(rest->modes, modes, (events->count - events->written) * sizeof *modes);
    if (event >= events->written) {
        turn(step, event, rest->values[event]);
    } else {
        events->change(problem, event, rest->look, step->to);
    }
    look_at(problem, &rest->at, step->to, 1, rest->after);
    if (event < events->written) {
        double nothing = 0; /* 0 times a value that is not finite is NaN */
        for (size_t c = 0; c < problem->n; c++) {
            nothing += 0 * rest->after[c];
        }
        if (isnan(nothing)) {
            step->turned_at = rest->at;
            return GM_EVENTS_NO_VALUE;
        }
        memset(step->to + step->state, 0, (step->size - step->state) * sizeof *step->to);
        if (!step->restart(step->data, rest->at, step->to)) {
            return GM_EVENTS_FAILED;
        }
        turn_back(rest);
    }
    step->memory[events->count + event]++;
    settle(step, rest->after, rest->values, rest->new_values);
    wait_after(rest, event);
    part.ahead = step->motion(step->data, rest->modes);
    part.beyond = step->motion(step->data, modes);
    if (part.ahead && part.beyond) {
        if (!events->carry_within(problem, &part, step->to)) {
            step->turned_at = rest->at;
            return GM_EVENTS_NO_TANGENT;
        }
        look_at(problem, &rest->at, step->to, 1, rest->after);
        if (step->witness.see) {
            step->witness.see(step->witness.data, &part);
        }
    }
    if (event < events->written) {
        book(rest);
    }
    return GM_EVENTS_HAPPENED;
}

/* Finds how far the rounding of the state at the start of the run changes each g: one that is no larger is on its
   surface. A component may be the difference of numbers as large as the largest. */
static void find_roundoffs(struct rest *rest)
{
    const struct gm_event_step *step = rest->step;
    const size_t n = step->problem->n, count = step->problem->events->count;
    double *look = rest->look, largest = 0;
    memset(rest->roundoffs, 0, count * sizeof *rest->roundoffs);
    for (size_t c = 0; c <= n; c++) {
        largest = fmax(largest, fabs(look[c]));
    }
    for (size_t c = 0; c <= n; c++) {
        const double before = look[c];
        look[c] += 16 * DBL_EPSILON * largest;
        find_g(step, look, 1, rest->values);
        look[c] = before;
        for (size_t i = 0; i < count; i++) {
            rest->roundoffs[i] += fabs(rest->values[i] - rest->at_low[i]);
        }
    }
}

/* Returns true if the intervals between events have become too short to end. */
static bool are_too_short(struct gm_event_step *step, double t)
{
    enum { MOST_SHORT = 50 };
    double *history = step->memory + gm_events_memory(step->problem) - BEHIND;
    const double interval = fabs(t - history[LAST]);
    history[SHORT] = interval < 1e-9 * fabs(step->dt) ? history[SHORT] + 1 : 0;
    history[LAST] = t;
    return history[SHORT] >= MOST_SHORT;
}

/* Passes what is at rest->place: makes the rest up to it, and the changes there. GM_EVENTS_NONE: nothing happens. */
static enum gm_event_outcome pass_first(struct rest *rest)
{
    struct gm_event_step *step = rest->step;
    const struct gm_events *events = step->problem->events;
    const double begin = rest->t;
    enum gm_event_outcome outcome = GM_EVENTS_NONE;
    bool changes = false;
    if (!make_part(rest, rest->place, step->to, false)) {
        return GM_EVENTS_FAILED;
    }
    step->reached = rest->at;
    for (size_t i = events->count; i-- > 0 && rest->place == 0 && !(step->first && begin == step->t);) {
        if (rest->places[i] == 0 && (i < events->written || is_break(step, i))) { /* back on g = 0 */
            note(step, i, rest->at_low[i]);
            return i < events->written ? GM_EVENTS_MANY : GM_EVENTS_SLIDE;
        }
    }
    find_causes(rest);
    for (size_t i; (i = next_caused(rest)) < events->count;) {
        const bool written = i < events->written;
        find_values(rest, rest->at, step->to, rest->values);
        if (written && !events->change(step->problem, i, rest->look, NULL)) {
            pass_by(rest, i, rest->values[i]);
            rest->causes[i] = HAS_HAPPENED;
            continue;
        }
        if (outcome == GM_EVENTS_NONE && !make_part(rest, rest->place, step->to, true)) {
            return GM_EVENTS_FAILED;
        }
        if (written && events->ends[i]) {
            step->memory[events->count + i]++;
            return GM_EVENTS_ENDED;
        }
        outcome = change(rest, i);
        if (outcome != GM_EVENTS_HAPPENED) {
            return outcome;
        }
        memcpy(step->from, step->to, step->size * sizeof *step->from);
        rest->t = rest->at;
        changes |= written;
    }
    rest->low = outcome == GM_EVENTS_NONE ? rest->place : 0;
    find_values(rest, rest->at, step->to, rest->at_low);
    for (size_t i = events->written; i < events->count && outcome != GM_EVENTS_NONE; i++) {
        if (is_break(step, i) && passes_here(rest, i) && leads_back(step, i, rest->look, rest->at_low[i])) {
            step->reached = rest->place <= TOGETHER ? begin : rest->at;
            note(step, i, rest->at_low[i]);
            return GM_EVENTS_SLIDE;
        }
    }
    return changes && are_too_short(step, rest->at) ? GM_EVENTS_MANY : outcome;
}

size_t gm_events_scratch(const struct gm_problem *problem)
{
    const size_t count = problem->events->count, together = GM_EVENTS_TOGETHER * (problem->n + 1 + count);
    return together + 2 * (problem->n + 1) + 9 * count + 2 * problem->events->quantities;
}

enum gm_event_outcome gm_events_pass(struct gm_event_step *step)
{
    enum { MOST_IN_A_STEP = 1000 };
    const struct gm_problem *problem = step->problem;
    const size_t count = problem->events->count, width = problem->n + 1;
    struct rest rest = {.step = step, .t = step->t, .rest = step->dt, .look = step->scratch};
    double **const lists[] = {&rest.at_low, &rest.at_end,    &rest.places, &rest.modes,     &rest.sizes,
                              &rest.causes, &rest.roundoffs, &rest.values, &rest.new_values};
    rest.after = rest.look + width;
    for (size_t k = 0; k < GM_COUNT(lists); k++) {
        *lists[k] = rest.look + 2 * width + k * count;
    }
    if (gm_events_near(step, step->end, &step->end_time, 1) == 1) {
        return GM_EVENTS_NONE;
    }
    find_values(&rest, step->end_time, step->end, rest.at_end);
    find_values(&rest, step->t, step->begin, rest.at_low);
    if (step->first) {
        find_roundoffs(&rest);
    }
    for (size_t i = 0; i < count; i++) {
        rest.sizes[i] = fabs(rest.at_low[i]) + (isnan(rest.at_end[i]) ? 0 : fabs(rest.at_end[i]));
    }
    memcpy(step->from, step->begin, step->size * sizeof *step->from);
    enum gm_event_outcome so_far = GM_EVENTS_NONE;
    for (int made = 0;; made++) {
        rest.place = take_sides(&rest) ? first_place(&rest) : NAN;
        if (rest.place > 1) {
            return so_far;
        }
        enum gm_event_outcome outcome = isnan(rest.place) ? GM_EVENTS_FAILED : pass_first(&rest);
        if (outcome == GM_EVENTS_MANY) {
            step->turned = SIZE_MAX;
        } else if (outcome <= GM_EVENTS_HAPPENED && made == MOST_IN_A_STEP) {
            step->turned = outcome == GM_EVENTS_NONE ? 0 : step->turned;
            outcome = GM_EVENTS_MANY;
        }
        const bool ends =
            rest.place == 1 || (step->end_time - rest.t) * step->dt <= 0; /* or beyond, by round-off */
        if (outcome > GM_EVENTS_HAPPENED || (outcome == GM_EVENTS_HAPPENED && (ends || step->varies))) {
            memcpy(step->end, step->to, step->size * sizeof *step->to);
            return outcome;
        }
        if (outcome == GM_EVENTS_HAPPENED) {
            so_far = outcome;
            rest.rest = step->end_time - rest.t;
            if (!make_part(&rest, 1, step->end, true)) {
                return GM_EVENTS_FAILED;
            }
        }
    }
}
