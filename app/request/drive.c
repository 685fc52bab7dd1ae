/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Lanes driven from outside any scene: steps in bursts, changes in flight, interruption. */
#include "app/request/drive.h"

#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "render/cells/text.h"
#include "render/clock.h"

volatile sig_atomic_t gm_interrupted;

static void interrupt(int number)
{
    (void)number;
    gm_interrupted = gm_interrupted + 1;
}

void gm_catch_interrupts(void)
{
    struct sigaction action = {.sa_handler = interrupt};
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

/* Steps are made in bursts short enough to answer an interruption at once, even for a large ensemble. */
static long burst_of(const struct gm_lane *lane)
{
    const double members = (double)(lane->problem.n * lane->problem.m);
    const double burst = 2e5 / members;
    return burst < 1 ? 1 : burst > 1e5 ? 100000 : (long)burst;
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

/* The step before which the next change is due; `step` if none is. */
static long next_stop(const struct gm_drive *drive, long step)
{
    const struct gm_request *request = drive->request;
    for (size_t i = drive->next_change; i < request->change_count; i++) {
        if (request->changes[i].lane == drive->index) {
            return request->changes[i].step < step ? request->changes[i].step : step;
        }
    }
    return step;
}

static double until_of(const struct gm_lane *lane)
{
    return ((const struct gm_timing *)lane->parameters)->until;
}

bool gm_drive_goes_on(const struct gm_drive *drive, long step)
{
    return gm_run_goes_on(drive->lane->run, step, until_of(drive->lane));
}

/* The system is asked for the time of every step that is long, of short ones after so many seconds of them:
   asking takes longer than a short step. */
static const double unasked = 20e-6;

/* Makes steps up to `stop` in all, which are timed. */
static void advance(struct gm_drive *drive, long stop, bool record)
{
    struct gm_lane *lane = drive->lane;
    const long before = lane->run->steps;
    const bool measured = stop - before > drive->unmeasured;
    const double start = measured ? gm_clock_processor_seconds() : 0;
    if (record) {
        gm_run_to(lane->run, stop, until_of(lane));
    } else {
        /* what it follows on the way costs less than looking at the clock */
        gm_lane_to(lane, stop, until_of(lane));
    }
    const long made = lane->run->steps - before;
    if (measured) {
        const double took = gm_clock_processor_seconds() - start;
        drive->seconds += took;
        drive->each = made > 0 ? took / (double)made : 0;
        drive->unmeasured = drive->each > 0 ? (long)fmin(unasked / drive->each, 1e6) : 0;
    } else {
        drive->seconds += drive->each * (double)made;
        drive->unmeasured -= made;
    }
}

bool gm_drive_to(struct gm_drive *drive, long step, bool record, char *message)
{
    struct gm_lane *lane = drive->lane;
    const long burst = record ? 1 : burst_of(lane);
    while (gm_drive_goes_on(drive, LONG_MAX) && !gm_interrupted) {
        if (!make_changes(drive, message)) {
            return false;
        }
        const long before = lane->run->steps, left = next_stop(drive, step) - before;
        if (left <= 0) {
            break;
        }
        const long stop = before + (left < burst ? left : burst);
        advance(drive, stop, record);
        if (record && lane->run->steps > before) {
            gm_lane_record(lane);
        }
    }
    return true;
}

long gm_drive_step_at(const struct gm_drive *drive, double t)
{
    const struct gm_run *run = drive->lane->run;
    if (run->scheme->family->own_time) {
        return run->steps + (run->t < t ? 1 : 0);
    }
    const double ahead = (t - run->t) / run->dt;
    return run->steps + (long)floor(fmin(ahead * (1 + 1e-12) + 1e-6, (double)GM_MOST_STEPS));
}

__attribute__((format(printf, 3, 0))) static void put_line(FILE *stream, const char *front,
                                                           const char *format, va_list arguments)
{
    char text[8192]; /* a path may have 4096 bytes */
    vsnprintf(text, sizeof text, format, arguments);
    fprintf(stream, "%s%s\n", front, gm_text_tame(text));
}

void gm_complain(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    put_line(stderr, "geomint: ", format, arguments);
    va_end(arguments);
}

void gm_say(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    put_line(stdout, "", format, arguments);
    va_end(arguments);
}

void gm_failure_sentence(const struct gm_lane *lane, char *text, size_t size)
{
    const struct gm_run *run = lane->run;
    text[0] = '\0';
    switch (run->status) {
    case GM_OK:
        return;
    case GM_BLOW_UP:
        snprintf(text, size, "the step after t = %.6g led beyond %.3g, or to no number at all", run->t,
                 run->limit);
        return;
    case GM_NO_CONVERGENCE: {
        const double iterations = gm_run_per_member(run, run->failed_iterations);
        if (iterations < 1) {
            snprintf(
                text, size,
                "the implicit equations of the step after t = %.6g led to no number at the first iteration",
                run->t);
            return;
        }
        snprintf(text, size,
                 "the implicit equations of the step after t = %.6g were not solved to round-off in %.0f "
                 "iteration%s",
                 run->t, iterations, iterations == 1 ? "" : "s");
        return;
    }
    case GM_MESH_CROSSING:
        snprintf(text, size, "the mesh would have tangled in the step after t = %.6g", run->t);
        return;
    case GM_STEP_COLLAPSE:
        snprintf(text, size, "the scheme found no step to continue with after t = %.6g", run->t);
        return;
    case GM_OUT_OF_MEMORY:
        snprintf(text, size, "there was not enough memory to go on from t = %.6g, or to look at it", run->t);
        return;
    }
}

/* By how much a run that is not failed ends after the end that was asked for (before it: negative); 0 for
   round-off. */
static double overshoot(const struct gm_drive *drive)
{
    const struct gm_run *run = drive->lane->run;
    const double until = drive->request->lanes[drive->index].until; /* NAN: not asked for */
    const bool there = !(fabs(run->t - until) > 1e-9 * fmax(fabs(until), fabs(run->dt)));
    return run->status != GM_OK || there ? 0 : run->t - until;
}

void gm_drive_message(const struct gm_drive *drive, char *text, size_t size)
{
    gm_failure_sentence(drive->lane, text, size);
    if (drive->lane->scheme->family->own_time && overshoot(drive) > 0) {
        snprintf(text, size,
                 "the scheme chooses its steps: the first that reaches until = %.10g ends at t = %.10g",
                 drive->request->lanes[drive->index].until, drive->lane->run->t);
    }
}

void gm_drive_warning(const struct gm_drive *drive, char *text, size_t size)
{
    gm_lane_warning(drive->lane, text, size);
    if (!drive->lane->scheme->family->own_time && overshoot(drive) != 0) {
        const size_t used = strlen(text);
        snprintf(text + used, size - used,
                 "%sthe run ends at t = %.10g and not at until = %.10g: that is no whole number of steps",
                 used ? "; " : "", drive->lane->run->t, drive->request->lanes[drive->index].until);
    }
}

int gm_finish(int status)
{
    if (fflush(stdout) != 0 || ferror(stdout)) {
        if (errno == EPIPE) {
            return GM_EXIT_PIPE;
        }
        gm_complain("standard output could not be written: %s", strerror(errno));
        return GM_EXIT_FILE;
    }
    return status;
}
