/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lanes driven from outside any scene: steps in bursts, changes during a run, and sentences on its end. */
#include "app/words/drive.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/base/interrupt.h"
#include "app/native/engine.h"
#include "core/ode/families/invariants/held.h"
#include "core/schemes.h"
#include "render/clock.h"

/* A burst of steps is short enough to answer an interruption at once, even for a large ensemble or long
   formulas; the time of the first step gives its length. Single steps of an ensemble larger than the cache
   would transfer it to and from memory each time. */
static int64_t burst_of(double each)
{
    static const double at_once = 0.02; /* seconds */
    const double burst = each > 0 ? at_once / each : 1;
    return burst < 1 ? 1 : burst > 1e5 ? 100000 : (int64_t)burst;
}

static bool make_changes(struct gm_drive *drive, char *message)
{
    const struct gm_request *request = drive->request;
    while (drive->next_change < request->change_count) {
        const struct gm_change *change = &request->changes[drive->next_change];
        if (change->lane == drive->index && change->step > drive->lane->run->steps) {
            return true;
        }
        if (change->lane == drive->index && !gm_change_apply(drive->lane, change->text, message)) {
            return false;
        }
        drive->next_change++;
    }
    return true;
}

/* The step before which the next change is due, or a last step that may be shortened; `step` if none is. */
static int64_t next_stop(const struct gm_drive *drive, int64_t step)
{
    const struct gm_request *request = drive->request;
    const int64_t last = request->lanes[drive->index].steps - 1;
    step = drive->lane->run->steps < last && last < step ? last : step;
    for (size_t i = drive->next_change; i < request->change_count; i++) {
        if (request->changes[i].lane == drive->index) {
            return request->changes[i].step < step ? request->changes[i].step : step;
        }
    }
    return step;
}

static double until_of(const struct gm_drive *drive)
{
    return drive->stop ? *drive->stop : ((const struct gm_timing *)drive->lane->parameters)->until;
}

bool gm_drive_goes_on(const struct gm_drive *drive, int64_t step)
{
    return gm_run_goes_on(drive->lane->run, step, until_of(drive));
}

int64_t gm_drive_end(const struct gm_drive *drive, int64_t step)
{
    const struct gm_run *run = drive->lane->run;
    const int64_t whole = gm_run_steps_at(run, until_of(drive)),
                  last = drive->request->lanes[drive->index].steps;
    /* a last step that is shortened may be short of half a step */
    const int64_t end = whole == last - 1 && gm_ends_exactly(run->scheme) ? last : whole;
    return end < step ? end : step;
}

/* The clock is read after every slow step, but only once per `unasked` seconds of short ones: reading it
   takes longer than a short step. A step too short to be measured counts as `shortest` seconds. */
static const double unasked = 20e-6, shortest = 20e-9;

/* The time of two readings of the clock, the least of a few attempts: more than a short step's. */
static double asking(void)
{
    static _Thread_local double least = 0;
    if (least == 0) {
        least = INFINITY;
        for (int i = 0; i < 8; i++) {
            const double start = gm_clock_processor_seconds();
            least = fmin(least, gm_clock_processor_seconds() - start);
        }
    }
    return least;
}

double gm_lane_burst(struct gm_lane *lane, int64_t steps, double until, double *each)
{
    const int64_t before = lane->run->steps, left = steps - before, burst = burst_of(*each);
    const double start = gm_clock_processor_seconds();
    gm_lane_to(lane, before + (left < burst ? left : burst), until);
    const double took = gm_clock_processor_seconds() - start;
    const int64_t made = lane->run->steps - before;
    *each = fmax(took / (double)(made > 0 ? made : 1), shortest);
    return took;
}

/* Observables that follow the steps need whole ones. */
static bool has_whole_steps(const struct gm_drive *drive)
{
    return drive->whole_steps || gm_lane_asked_shown(drive->lane) > 0;
}

double gm_drive_rest(const struct gm_drive *drive)
{
    const struct gm_lane_spec *spec = &drive->request->lanes[drive->index];
    const struct gm_run *run = drive->lane->run;
    const double rest = spec->until - run->t, least = 1e-9 * fmax(fabs(spec->until), fabs(run->dt));
    const bool is_next =
        run->steps == spec->steps - 1 && !has_whole_steps(drive) && gm_ends_exactly(run->scheme);
    const bool is_part = fabs(rest) > least && fabs(run->dt) - fabs(rest) > least && rest / run->dt > 0;
    return is_next && is_part ? rest : 0;
}

/* Makes steps up to `stop` in all, which are timed. */
static void advance(struct gm_drive *drive, int64_t stop, bool record)
{
    struct gm_lane *lane = drive->lane;
    const int64_t before = lane->run->steps;
    const bool measured = stop - before > drive->unmeasured;
    const double start = measured ? gm_clock_processor_seconds() : 0;
    if (record) {
        gm_run_to(lane->run, stop, until_of(drive));
    } else if (drive->trace) { /* single steps, with a row after each */
        const struct gm_run *run = lane->run;
        const size_t count = lane->problem.n * lane->problem.m;
        const double until = until_of(drive);
        while (gm_run_goes_on(run, stop, until) && gm_lane_to(lane, run->steps + 1, until) == GM_OK) {
            drive->trace[0] = run->t;
            memcpy(drive->trace + 1, gm_run_state(run), count * sizeof *drive->trace);
            drive->trace += 1 + count;
        }
    } else {
        /* the observers cost less than a reading of the clock */
        gm_lane_to(lane, stop, until_of(drive));
    }
    const int64_t made = lane->run->steps - before;
    if (measured) {
        const double took = fmax(gm_clock_processor_seconds() - start - asking(), 0);
        drive->seconds += took;
        drive->each = made > 0 ? took / (double)made : 0;
        drive->unmeasured = (int64_t)(unasked / fmax(drive->each, shortest));
    } else {
        drive->seconds += drive->each * (double)made;
        drive->unmeasured -= made;
    }
}

/* Steps that take long may be worth compiling. */
static void look_for_engine(struct gm_drive *drive, int64_t step)
{
    static const double often = 0.05; /* seconds */
    const struct gm_run *run = drive->lane->run;
    if (drive->seconds >= drive->looked + often || drive->looked == 0) {
        const bool known = !drive->lane->scheme->family->adaptive;
        const double left = known ? (double)(gm_drive_end(drive, step) - run->steps) : 0;
        gm_engine_look(drive->lane, drive->seconds - drive->looked, drive->each * fmax(left, 0));
        drive->looked = drive->seconds;
    }
}

bool gm_drive_to(struct gm_drive *drive, int64_t step, bool record, char *message)
{
    struct gm_lane *lane = drive->lane;
    while (gm_drive_goes_on(drive, INT64_MAX) && !gm_interrupted) {
        if (!make_changes(drive, message)) {
            return false;
        }
        const int64_t before = lane->run->steps, left = next_stop(drive, step) - before;
        if (left <= 0) {
            break;
        }
        const double each = drive->unmeasured > 0 ? fmax(drive->each, shortest) : drive->each;
        const int64_t burst = record ? 1 : burst_of(each), stop = before + (left < burst ? left : burst);
        const double rest = gm_drive_rest(drive), dt = lane->run->dt;
        if (rest != 0) {
            gm_run_set_step(lane->run, rest);
        }
        lane->run->shortens = lane->scheme->family->adaptive && !has_whole_steps(drive);
        advance(drive, stop, record);
        if (record && lane->run->steps > before) {
            gm_lane_record(lane);
        }
        if (rest != 0) {
            gm_run_set_step(lane->run, dt);
        }
        /* the search makes trial steps, after which the last recorded one is lost */
        look_for_engine(drive, step);
    }
    return true;
}

bool gm_drive_until(struct gm_drive *drive, double t, bool record, char *message)
{
    const struct gm_lane *lane = drive->lane; /* a change of scheme replaces the lane's run */
    const int64_t end = drive->request->lanes[drive->index].steps;
    int64_t before = -1;
    /* repeats until no step is due: step size control, or a change, may have shortened the steps */
    while (lane->run->steps > before) {
        const bool rests = t >= drive->request->lanes[drive->index].until && gm_drive_rest(drive) != 0;
        const int64_t due = gm_run_steps_by(lane->run, t) + (rests ? 1 : 0);
        before = lane->run->steps;
        if (!gm_drive_to(drive, due < end ? due : end, record, message)) {
            return false;
        }
    }
    return true;
}

/* Writes the scene's description of a failed step, `how`, or of a run that has stopped, ""; returns false if it has
   none. */
static bool tell_part(const struct gm_lane *lane, const char *how, char *text, size_t size)
{
    char part[GM_MESSAGE / 2] = "";
    const struct gm_view view = gm_lane_view(lane);
    if (lane->scene->failure) {
        lane->scene->failure(&view, part, sizeof part);
    }
    if (part[0]) {
        snprintf(text, size, *how ? "the step after t = %.6g %s: %s" : "the run ends at t = %.6g%s: %s",
                 view.t, how, part);
    }
    return part[0] != '\0';
}

/* Returns the longest half, quarter and so on of a step without a solution that has one from the same state; 0: not
   known. */
static double solvable_step(const struct gm_run *run)
{
    enum { HALVINGS = 20 };
    bool solved = false;
    double dt = run->dt;
    for (int i = 0; i < HALVINGS && !solved && !run->scheme->family->adaptive; i++) {
        dt /= 2;
        struct gm_run *shorter =
            gm_run_open(run->problem, run->scheme, &run->settings, run->t, dt, gm_run_state(run));
        solved = shorter && gm_run_advance(shorter, 1) == GM_OK;
        gm_run_close(shorter);
    }
    return solved ? fabs(dt) : 0;
}

/* Writes the reason for unsolved implicit equations of a step, and a remedy. */
static void tell_unsolved(const struct gm_run *run, char *text, size_t size)
{
    static const char *const obstacles[] = {
        [GM_NOT_KNOWN] = " to round-off",
        [GM_SINGULAR] = ": its matrix is singular",
        [GM_NOT_FINITE] = ": its iteration leaves the numbers",
        [GM_STILL_LARGE] = ": its iteration still changes by",
        [GM_STAYS_OFF] = " to round-off",
    };
    const struct gm_holding *holding = gm_holding_of(run->scheme);
    const size_t farthest = (size_t)run->unsolved.invariant; /* it may come from a file */
    char change[40] = "", shorter[40] = "a shorter dt";
    const char *const name = run->scheme->name;
    if (run->unsolved.obstacle == GM_STAYS_OFF && holding && farthest < holding->count) {
        snprintf(change, sizeof change,
                 run->unsolved.change <= 1 ? "it stays off by %.2g of its scale" : "the iteration diverges",
                 run->unsolved.change);
        snprintf(
            text, size,
            "the step after t = %.6g found no way back to the value that %s has at the start: %s; take %s",
            run->t, holding->names[farthest], change,
            run->scheme->family->adaptive && gm_holding_base(run->scheme)->order == 1
                ? "a base of order 2 or more: with one of order 1 such a step near dt need not exist"
                : "a shorter dt");
        return;
    }
    if (run->unsolved.obstacle == GM_STILL_LARGE) {
        snprintf(change, sizeof change, " %.2g of the state", run->unsolved.change);
    }
    const bool helps = strcmp(name, "radau5") != 0 && strcmp(name, "sdirk2") != 0 &&
                       gm_scheme_fits(gm_scheme_find_for("radau5", run->problem), run->problem),
               also = gm_scheme_fits(gm_scheme_find("gsl-msbdf"), run->problem);
    const double dt = run->scheme->steady || !also ? 0 : solvable_step(run);
    if (dt > 0) {
        snprintf(shorter, sizeof shorter, "dt below %.2g", dt);
    }
    const char *others = !helps ? "" : dt > 0 ? ", radau5 or gsl-msbdf" : ", or radau5";
    snprintf(text, size, "the implicit step after t = %.6g was not solved%s%s%s%s%s", run->t,
             obstacles[run->unsolved.obstacle], change, run->scheme->steady ? "" : "; take ",
             run->scheme->steady ? "" : shorter, others);
}

void gm_failure_sentence(const struct gm_lane *lane, char *text, size_t size)
{
    /* with the time and, after a blow-up, the limit */
    static const char *const sentences[] = {
        [GM_BLOW_UP] = "the step after t = %.6g led beyond %.3g, or to NaN",
        [GM_MESH_CROSSING] = "the mesh would have tangled in the step after t = %.6g",
        [GM_STEP_COLLAPSE] = "the scheme found no step to continue with after t = %.6g",
        [GM_EVENTS_ACCUMULATE] =
            "events follow each other in ever shorter times, and accumulate at t = %.10g",
        [GM_STEP_TOO_SMALL] =
            "the steps after t = %.6g are too small for the tolerance; a stiff problem needs an "
            "implicit scheme, such as radau5",
        [GM_OUT_OF_MEMORY] = "there was not enough memory to continue from t = %.6g, or to observe it",
    };
    const struct gm_run *run = lane->run;
    const struct gm_events *events = run->problem->events;
    const bool solved = run->status != GM_BLOW_UP && run->status != GM_NO_CONVERGENCE,
               breaks = events && run->turned >= events->written && run->turned < events->count;
    text[0] = '\0';
    const bool tangled = run->status == GM_MESH_CROSSING, ended = run->status == GM_OK && run->stopped;
    if ((!solved || tangled || ended || run->status == GM_STEP_COLLAPSE) &&
        tell_part(lane,
                  ended     ? ""
                  : tangled ? "would have tangled the mesh"
                  : solved  ? "was not found"
                            : "failed",
                  text, size)) {
        return;
    }
    if (run->status == GM_NO_CONVERGENCE) {
        tell_unsolved(run, text, size);
    } else if (breaks && (run->status == GM_SLIDING || run->status == GM_EVENTS_ACCUMULATE)) {
        const char *const sentence =
            run->status == GM_SLIDING
                ? "the motion slides along %.120s = %g from t = %.10g: both rates point at it"
                : "a step passes more than 1000 breaks, up to %.120s = %g at t = %.10g: take a shorter dt";
        snprintf(text, size, sentence, events->surfaces[run->turned - events->written], run->turned_at,
                 run->t);
    } else if (run->status == GM_NO_TANGENT) {
        snprintf(
            text, size,
            "the tangents end at the event at t = %.10g: the motion only touches its surface, or another "
            "event causes it",
            run->turned_at);
    } else if (run->status == GM_EVENTS_ACCUMULATE && run->turned != SIZE_MAX) {
        snprintf(text, size,
                 "a step passes its events more than 1000 times, up to t = %.10g: take a shorter dt", run->t);
    } else if (run->status != GM_OK) {
        snprintf(text, size, sentences[run->status], run->t, run->limit);
    }
}

/* The time from the requested end to the end of a run that is not failed; negative before it; 0 for round-
   off. */
static double overshoot(const struct gm_drive *drive)
{
    const struct gm_run *run = drive->lane->run;
    const double until = drive->request->lanes[drive->index].until; /* NAN: not requested */
    const bool there = !(fabs(run->t - until) > 1e-9 * fmax(fabs(until), fabs(run->dt)));
    return run->status != GM_OK || there || run->stopped ? 0 : run->t - until;
}

void gm_drive_message(const struct gm_drive *drive, char *text, size_t size)
{
    const bool adaptive = drive->lane->scheme->family->adaptive;
    gm_failure_sentence(drive->lane, text, size);
    if (!adaptive && overshoot(drive) != 0) {
        gm_drive_other_end(drive, text, size);
    }
    if (adaptive && overshoot(drive) > 0) {
        snprintf(text, size,
                 "the scheme is adaptive: the first step that reaches until = %.10g ends at t = %.10g",
                 drive->request->lanes[drive->index].until, drive->lane->run->t);
    }
}

void gm_drive_other_end(const struct gm_drive *drive, char *text, size_t size)
{
    const bool adaptive = drive->lane->scheme->family->adaptive;
    const struct gm_run *run = drive->lane->run;
    const double over = overshoot(drive), until = drive->request->lanes[drive->index].until;
    text[0] = '\0';
    if (!adaptive && over != 0) {
        snprintf(text, size, "the run ends at t = %.10g: until = %.10g is not a whole number of steps",
                 run->t, until);
    }
    if (adaptive && over > 0 && over > (until - run->t0) / 2) {
        snprintf(text, size, "the last step leads far beyond until = %.10g, to t = %.10g: dt is too long",
                 until, run->t);
    }
}

void gm_drive_warning(const struct gm_drive *drive, char *text, size_t size)
{
    char end[GM_MESSAGE] = "";
    if (drive->lane->scheme->family->adaptive) {
        gm_drive_other_end(drive, end, sizeof end);
    }
    gm_lane_warning(drive->lane, text, size);
    gm_append(text, size, "%s%s", text[0] && end[0] ? "; " : "", end);
}

double gm_drive_seconds(const struct gm_request *request, size_t index)
{
    static const double enough = 0.2;
    char message[GM_MESSAGE];
    const double started = gm_clock_seconds();
    struct gm_drive drive = {.request = request, .index = index};
    drive.lane = gm_request_open_lane(request, index, message);
    if (!drive.lane) {
        return 0;
    }
    const struct gm_run *state = drive.lane->run;
    const int64_t steps = request->lanes[index].steps;
    const double opening = gm_clock_seconds() - started;
    for (int64_t goal = 1; drive.seconds < enough && gm_drive_goes_on(&drive, steps) && !gm_interrupted;
         goal *= 2) {
        gm_drive_to(&drive, goal < steps ? goal : steps, false, message);
    }
    const double part = (state->t - drive.lane->t0) / (request->lanes[index].end - drive.lane->t0);
    const bool on_the_way = part > 0 && part < 1 && state->status == GM_OK;
    gm_lane_close(drive.lane);
    return opening + (on_the_way ? drive.seconds / part : drive.seconds);
}
