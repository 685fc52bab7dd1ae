/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Handles of the library: opened of words, driven, asked for numbers. */
#include "library/handle.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/data/save.h"
#include "app/native/engine.h"
#include "app/output/row.h"
#include "core/arena.h"
#include "core/memory.h"
#include "core/schemes.h"

locale_t gm_library_locale;

/* When the library is loaded. It is never freed: a thread may be in it while the host ends. */
__attribute__((constructor)) static void make_locale(void)
{
    gm_library_locale = newlocale(LC_ALL_MASK, "C.UTF-8", (locale_t)0);
    if (!gm_library_locale) {
        gm_library_locale = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    }
}

const char *geomint_version(void)
{
    return GM_VERSION;
}

const char *geomint_scene_name(size_t index)
{
    return index < gm_scene_count() ? gm_scene_name(index) : NULL;
}

const char *geomint_scheme_name(size_t index)
{
    return index < gm_scheme_count() ? gm_scheme_at(index)->name : NULL;
}

int geomint_status(const geomint *handle)
{
    return handle ? handle->status : GEOMINT_MEMORY;
}

const char *geomint_message(const geomint *handle)
{
    return handle ? handle->message : "there is not enough memory";
}

/* ---- calls ---- */

struct gm_call gm_call_begin(geomint *handle)
{
    if (handle) {
        handle->status = GEOMINT_OK;
        handle->message[0] = '\0';
    }
    return (struct gm_call){handle, uselocale(gm_library_locale), gm_memory_refusals()};
}

bool gm_handle_refuse(geomint *handle, int status, const char *sentence)
{
    if (handle) {
        handle->status = status;
        if (sentence != handle->message) {
            snprintf(handle->message, sizeof handle->message, "%s", sentence);
        }
    }
    return false;
}

int gm_call_end(const struct gm_call *call)
{
    geomint *handle = call->handle;
    if (gm_memory_refusals() != call->refusals) {
        gm_handle_refuse(handle, GEOMINT_MEMORY, "there is not enough memory");
    }
    uselocale(call->outside);
    return geomint_status(handle);
}

bool gm_handle_given(geomint *handle, const void *pointer, const char *name)
{
    char sentence[GM_MESSAGE];
    if (!pointer) {
        gm_refuse(sentence, "%s is NULL", name);
        gm_handle_refuse(handle, GEOMINT_USAGE, sentence);
    }
    return pointer != NULL;
}

/* The same for each of `count` words. */
static bool are_given(geomint *handle, int count, const char *const words[])
{
    for (int i = 0; i < count; i++) {
        if (!gm_handle_given(handle, words, "words") ||
            !gm_handle_given(handle, words[i], "one of the words")) {
            return false;
        }
    }
    return true;
}

bool gm_handle_has(geomint *handle, size_t lane)
{
    if (lane < geomint_lanes(handle)) {
        return true;
    }
    char sentence[GM_MESSAGE];
    snprintf(sentence, sizeof sentence, "there is no lane %zu; there are %zu, counted from 0 on", lane,
             geomint_lanes(handle));
    return gm_handle_refuse(handle, GEOMINT_USAGE, sentence);
}

/* ---- opening and closing ---- */

geomint *gm_handle_open(struct gm_handle_words opening, void (*body)(struct gm_arena *arena, void *opening))
{
    geomint *handle = opening.handle = calloc(1, sizeof *handle);
    if (!handle) {
        return NULL;
    }
    const struct gm_call call = gm_call_begin(handle);
    opening.refusal = GEOMINT_USAGE;
    handle->arena = gm_arena_open();
    if (are_given(handle, opening.count, opening.words) && !gm_arena_run(handle->arena, body, &opening)) {
        handle->lanes = NULL;
        gm_handle_refuse(handle, opening.refusal, gm_arena_reason(handle->arena));
    }
    gm_call_end(&call);
    return handle;
}

/* Finds the quantities of a lane's state, those that change first. */
static void name_quantities(struct gm_arena *arena, struct gm_handle_lane *lane)
{
    const struct gm_run *run = lane->drive.lane->run;
    struct gm_quantity found[GM_QUANTITIES];
    const size_t count = gm_quantities_beside_time(run, false, found);
    size_t most = 0;
    for (int fixed = 0; fixed < 2; fixed++) {
        for (size_t i = 0; i < count; i++) {
            if (found[i].fixed != (fixed == 1)) {
                continue;
            }
            const size_t size = gm_quantity_size(run, &found[i]);
            lane->sizes[lane->quantity_count] = size;
            lane->quantities[lane->quantity_count++] = found[i];
            lane->fixed_count += (size_t)fixed;
            most = found[i].derive && size > most ? size : most;
        }
    }
    lane->scratch = gm_arena_take(arena, most, sizeof *lane->scratch);
}

void gm_handle_read(struct gm_arena *arena, struct gm_handle_words *opening, size_t schemes)
{
    char message[GM_MESSAGE];
    geomint *handle = opening->handle;
    struct gm_request *request = &handle->words;
    struct gm_arguments *typed = gm_arguments_in(arena);
    gm_arena_need(arena, gm_arguments_append(typed, (char *const *)opening->words, opening->count));
    if (!gm_request_parse(request, typed->count, typed->words, schemes, message)) {
        opening->refusal = gm_request_refusal(request);
        gm_arena_refuse(arena, "%s", message);
    }
    handle->request = gm_arena_keep(arena, request, gm_request_close);
    gm_arena_keep(arena, &handle->chosen, gm_chosen_close);
    gm_arena_check(arena, gm_chosen_open(&handle->chosen, request->scene, NULL, message), message);
}

static void open_lanes(struct gm_arena *arena, void *data)
{
    char message[GM_MESSAGE];
    struct gm_handle_words *opening = data;
    geomint *handle = opening->handle;
    gm_handle_read(arena, opening, 1);
    const struct gm_request *request = handle->request;
    handle->lanes = gm_arena_take(arena, request->count, sizeof *handle->lanes);
    for (size_t i = 0; i < request->count; i++) {
        struct gm_handle_lane *lane = &handle->lanes[i];
        lane->drive =
            (struct gm_drive){.lane = gm_lane_in(arena, gm_request_open_lane(request, i, message), message),
                              .request = request,
                              .index = i};
        name_quantities(arena, lane);
    }
}

geomint *geomint_open(int count, const char *const words[])
{
    return gm_handle_open((struct gm_handle_words){.count = count, .words = words}, open_lanes);
}

void geomint_close(geomint *handle)
{
    if (handle) {
        const struct gm_call call = gm_call_begin(handle);
        gm_arena_close(handle->arena);
        gm_canvas_close(handle->kept.canvas);
        free(handle->text);
        gm_call_end(&call);
        free(handle);
    }
}

size_t geomint_lanes(const geomint *handle)
{
    return handle && handle->lanes ? handle->request->count : 0;
}

/* ---- driving ---- */

static const struct gm_run *run_of(const geomint *handle, size_t lane)
{
    return lane < geomint_lanes(handle) ? handle->lanes[lane].drive.lane->run : NULL;
}

/* Sets the status and the message of the handle after steps, and copies the state for the host. */
static void look(geomint *handle, struct gm_handle_lane *lane)
{
    const struct gm_lane *driven = lane->drive.lane;
    if (lane->state) {
        memcpy(lane->state, gm_run_state(driven->run),
               driven->problem.n * driven->problem.m * sizeof *lane->state);
    }
    if (driven->run->status != GM_OK) {
        gm_failure_sentence(driven, handle->message, sizeof handle->message);
        handle->status = driven->run->status == GM_OUT_OF_MEMORY ? GEOMINT_MEMORY : GEOMINT_NUMERICAL;
    }
}

static void show(struct gm_arena *arena, void *data)
{
    geomint *handle = data;
    const struct gm_session *session = handle->session;
    gm_arena_release(arena, handle->mark);
    handle->lanes = gm_arena_take(arena, session->count, sizeof *handle->lanes);
    for (size_t i = 0; i < session->count; i++) {
        handle->lanes[i].drive =
            (struct gm_drive){.lane = session->lanes[i], .request = handle->request, .index = i};
        session->log.lanes[i].steps = session->lanes[i]->run->steps; /* no lane has an end */
        name_quantities(arena, &handle->lanes[i]);
        look(handle, &handle->lanes[i]);
    }
}

void gm_handle_show(geomint *handle)
{
    if (!gm_arena_run(handle->arena, show, handle)) {
        handle->lanes = NULL;
    }
}

/* Makes steps up to the total `steps`, or, with an adaptive scheme, up to the time `until`. */
static void drive_to(geomint *handle, size_t index, int64_t steps, double until)
{
    struct gm_handle_lane *lane = &handle->lanes[index];
    if (handle->session) {
        gm_handle_refuse(handle, GEOMINT_USAGE,
                         "lanes that are explored advance together: use geomint_forward or geomint_advance");
        return;
    }
    lane->drive.stop = &until;
    lane->drive.whole_steps = true;
    if (!gm_drive_to(&lane->drive, steps, false, handle->message)) {
        gm_handle_refuse(handle, GEOMINT_USAGE, handle->message);
    }
    lane->drive.stop = NULL;
    look(handle, lane);
}

int geomint_step(geomint *handle, size_t lane, int64_t steps)
{
    const struct gm_call call = gm_call_begin(handle);
    if (gm_handle_has(handle, lane) && steps > 0) {
        const int64_t made = run_of(handle, lane)->steps;
        drive_to(handle, lane, steps < GM_MOST_STEPS - made ? made + steps : GM_MOST_STEPS, GM_NEVER);
    }
    return gm_call_end(&call);
}

int geomint_change(geomint *handle, size_t lane, int64_t step, const char *text)
{
    const struct gm_call call = gm_call_begin(handle);
    if (gm_handle_has(handle, lane) && gm_handle_given(handle, text, "change")) {
        struct gm_request *request = &handle->words;
        if (handle->session || step < run_of(handle, lane)->steps) {
            gm_handle_refuse(handle, GEOMINT_USAGE,
                             handle->session ? "explored lanes are changed by geomint_set and geomint_switch"
                                             : "the lane has made this step");
        } else if (gm_change_add(request, lane, step, text) &&
                   !gm_change_check(request, &request->changes[request->change_count - 1], handle->message)) {
            request->change_count--;
            free(request->changes[request->change_count].text);
            gm_handle_refuse(handle, GEOMINT_USAGE, handle->message);
        }
    }
    return gm_call_end(&call);
}

int geomint_until(geomint *handle, size_t lane, double t)
{
    const struct gm_call call = gm_call_begin(handle);
    if (!isfinite(t)) {
        gm_handle_refuse(handle, GEOMINT_USAGE, "the time of until must be a finite number");
    } else if (gm_handle_has(handle, lane)) {
        const struct gm_run *run = run_of(handle, lane);
        drive_to(handle, lane, gm_run_steps_at(run, t), t);
    }
    return gm_call_end(&call);
}

double geomint_time(const geomint *handle, size_t lane)
{
    const struct gm_run *run = run_of(handle, lane);
    return run ? run->t : NAN;
}

int64_t geomint_steps(const geomint *handle, size_t lane)
{
    const struct gm_run *run = run_of(handle, lane);
    return run ? run->steps : 0;
}

int64_t geomint_steps_left(const geomint *handle, size_t lane)
{
    const struct gm_run *run = run_of(handle, lane);
    if (!run) {
        return 0;
    }
    const int64_t end = handle->request->lanes[lane].steps;
    return !gm_drive_goes_on(&handle->lanes[lane].drive, end) ? 0
           : run->scheme->family->adaptive                    ? -1
                                                              : end - run->steps;
}

const double *geomint_state(geomint *handle, size_t index, size_t *n, size_t *m)
{
    const struct gm_call call = gm_call_begin(handle);
    const double *state = NULL;
    if (gm_handle_has(handle, index)) {
        struct gm_handle_lane *lane = &handle->lanes[index];
        const struct gm_problem *problem = &lane->drive.lane->problem;
        if (!lane->state) {
            lane->state = gm_arena_take(handle->arena, problem->n * problem->m, sizeof *lane->state);
        }
        if (lane->state) {
            memcpy(lane->state, gm_run_state(lane->drive.lane->run),
                   problem->n * problem->m * sizeof *lane->state);
        }
        state = lane->state;
        if (n) {
            *n = problem->n;
        }
        if (m) {
            *m = problem->m;
        }
    }
    gm_call_end(&call);
    return state;
}

/* ---- rows ---- */

int geomint_observe(geomint *handle, const char *keys)
{
    const struct gm_call call = gm_call_begin(handle);
    struct gm_chosen chosen;
    if (gm_handle_has(handle, 0)) {
        if (gm_chosen_open(&chosen, handle->request->scene, keys, handle->message)) {
            gm_chosen_close(&handle->chosen);
            handle->chosen = chosen;
        } else {
            gm_chosen_close(&chosen);
            gm_handle_refuse(handle, GEOMINT_USAGE, handle->message);
        }
    }
    return gm_call_end(&call);
}

/* The content of a column: a quantity, or an observable. */
struct column {
    const struct gm_quantity *quantity;
    const struct gm_observable *observable;
    size_t number; /* of either */
};

static struct column column_of(const geomint *handle, size_t index, size_t column)
{
    struct column found = {0};
    if (index >= geomint_lanes(handle)) {
        return found;
    }
    const struct gm_handle_lane *lane = &handle->lanes[index];
    const size_t moving = lane->quantity_count - lane->fixed_count, told = handle->chosen.count;
    if (column >= moving && column < moving + told) {
        found.number = handle->chosen.numbers[column - moving];
        found.observable = gm_scene_observable_at(handle->request->scene, found.number);
    } else if (column < lane->quantity_count + told) {
        found.number = column < moving ? column : column - told;
        found.quantity = &lane->quantities[found.number];
    }
    return found;
}

size_t geomint_columns(const geomint *handle, size_t index)
{
    if (index >= geomint_lanes(handle)) {
        return 0;
    }
    const struct gm_handle_lane *lane = &handle->lanes[index];
    return lane->quantity_count - lane->fixed_count + handle->chosen.count;
}

const char *geomint_column_name(const geomint *handle, size_t lane, size_t column)
{
    const struct column found = column_of(handle, lane, column);
    return found.quantity ? found.quantity->name : found.observable ? found.observable->key : NULL;
}

const char *geomint_column_unit(const geomint *handle, size_t lane, size_t column)
{
    const struct column found = column_of(handle, lane, column);
    return found.quantity ? "" : found.observable ? found.observable->unit : NULL;
}

size_t geomint_column_shape(const geomint *handle, size_t lane, size_t column, size_t shape[3])
{
    const struct gm_quantity *quantity = column_of(handle, lane, column).quantity;
    return quantity ? gm_quantity_shape(quantity, handle->lanes[lane].drive.lane->problem.m, shape) : 0;
}

static const double *values_of(const struct gm_handle_lane *lane, size_t quantity)
{
    return gm_quantity_values(lane->drive.lane->run, &lane->quantities[quantity], lane->scratch);
}

int geomint_column(geomint *handle, size_t index, size_t column, double *values)
{
    const struct gm_call call = gm_call_begin(handle);
    if (gm_handle_has(handle, index) && gm_handle_given(handle, values, "values")) {
        const struct gm_handle_lane *lane = &handle->lanes[index];
        const struct column found = column_of(handle, index, column);
        if (found.quantity) {
            memcpy(values, values_of(lane, found.number), lane->sizes[found.number] * sizeof *values);
        } else if (found.observable) {
            *values = gm_lane_observe(lane->drive.lane, found.number);
        } else {
            gm_handle_refuse(handle, GEOMINT_USAGE, "there is no such column");
        }
    }
    return gm_call_end(&call);
}

int geomint_observable(geomint *handle, size_t lane, const char *key, double *value)
{
    const struct gm_call call = gm_call_begin(handle);
    if (gm_handle_has(handle, lane) && gm_handle_given(handle, key, "key") &&
        gm_handle_given(handle, value, "value")) {
        const int found = gm_scene_observable(handle->request->scene, key);
        if (found >= 0) {
            *value = gm_lane_observe(handle->lanes[lane].drive.lane, (size_t)found);
        } else {
            gm_chosen_refuse(handle->request->scene, key, handle->message);
            gm_handle_refuse(handle, GEOMINT_USAGE, handle->message);
        }
    }
    return gm_call_end(&call);
}

size_t geomint_row_size(const geomint *handle, size_t index)
{
    size_t size = 0;
    if (index < geomint_lanes(handle)) {
        const struct gm_handle_lane *lane = &handle->lanes[index];
        size = handle->chosen.count;
        for (size_t i = 0; i < lane->quantity_count - lane->fixed_count; i++) {
            size += lane->sizes[i];
        }
    }
    return size;
}

static double *write_row(const geomint *handle, const struct gm_handle_lane *lane, double *row)
{
    for (size_t i = 0; i < lane->quantity_count - lane->fixed_count; i++) {
        memcpy(row, values_of(lane, i), lane->sizes[i] * sizeof *row);
        row += lane->sizes[i];
    }
    for (size_t i = 0; i < handle->chosen.count; i++) {
        *row++ = gm_lane_observe(lane->drive.lane, handle->chosen.numbers[i]);
    }
    return row;
}

int geomint_row(geomint *handle, size_t lane, double *t, double *values)
{
    const struct gm_call call = gm_call_begin(handle);
    if (gm_handle_has(handle, lane) && gm_handle_given(handle, values, "values")) {
        write_row(handle, &handle->lanes[lane], values);
        if (t) {
            *t = run_of(handle, lane)->t;
        }
    }
    return gm_call_end(&call);
}

static size_t make_rows(geomint *handle, size_t index, int64_t every, size_t rows, double *t, double *values)
{
    struct gm_handle_lane *lane = &handle->lanes[index];
    struct gm_drive *drive = &lane->drive;
    const struct gm_run *run = drive->lane->run;
    const int64_t end = handle->request->lanes[index].steps;
    size_t made = 0;
    while (made < rows && gm_drive_goes_on(drive, end)) {
        const int64_t before = run->steps, left = every - before % every;
        if (!gm_drive_to(drive, end - before < left ? end : before + left, false, handle->message)) {
            gm_handle_refuse(handle, GEOMINT_USAGE, handle->message);
        }
        if (run->steps == before) {
            break;
        }
        t[made++] = run->t;
        values = write_row(handle, lane, values);
    }
    look(handle, lane);
    return made;
}

int geomint_rows(geomint *handle, size_t lane, int64_t every, size_t rows, double *t, double *values,
                 size_t *made)
{
    const struct gm_call call = gm_call_begin(handle);
    size_t count = 0;
    if (every < 1) {
        gm_handle_refuse(handle, GEOMINT_USAGE, "rows lie at least one step apart");
    } else if (gm_handle_has(handle, lane) && gm_handle_given(handle, t, "t") &&
               gm_handle_given(handle, values, "values")) {
        count = make_rows(handle, lane, every, rows, t, values);
    }
    if (made) {
        *made = count;
    }
    return gm_call_end(&call);
}

/* ---- the copies that are drawn ---- */

static void follow(struct gm_arena *arena, void *data)
{
    char message[GM_MESSAGE];
    geomint *handle = data;
    const struct gm_request *request = handle->request;
    const bool fresh = !handle->drawn;
    handle->drawn = fresh ? gm_arena_take(arena, request->count, sizeof *handle->drawn) : handle->drawn;
    for (size_t i = 0; i < request->count; i++) {
        struct gm_drive *drawn = &handle->drawn[i];
        const struct gm_drive *drive = &handle->lanes[i].drive;
        const double never = GM_NEVER;
        if (fresh) {
            *drawn = (struct gm_drive){
                .request = request,
                .index = i,
                .lane = gm_lane_in(arena, gm_request_open_lane(request, i, message), message)};
        }
        drawn->stop = &never;
        drawn->whole_steps = drive->whole_steps;
        /* repeats the step that failed, so that the picture reports it */
        const int64_t more = drive->lane->run->status == GM_OK ? 0 : 1;
        const bool driven = gm_drive_to(drawn, drive->lane->run->steps + more, true, message);
        drawn->stop = NULL;
        if (!driven) {
            gm_arena_refuse(arena, "%s", message);
        }
    }
}

bool gm_handle_follow(geomint *handle)
{
    struct gm_drive *const before = handle->drawn;
    if (gm_arena_run(handle->arena, follow, handle)) {
        return true;
    }
    handle->drawn = before;
    return gm_handle_refuse(handle, GEOMINT_USAGE, gm_arena_reason(handle->arena));
}

/* ---- texts ---- */

/* Writes the lane as one object: the metadata of a file of states, and its cost. */
static bool put_lane(FILE *stream, const struct gm_drive *drive)
{
    const struct gm_run *run = drive->lane->run;
    char sentence[GM_MESSAGE], warning[GM_MESSAGE];
    gm_failure_sentence(drive->lane, sentence, sizeof sentence);
    gm_lane_warning(drive->lane, warning, sizeof warning);
    char *meta = gm_meta_text(drive->lane, gm_status_name(run->status), sentence);
    if (meta) {
        fprintf(stream, "%.*s", (int)strlen(meta) - 1, meta); /* without its last brace */
        struct gm_row row = {.stream = stream, .form = GM_ROW_JSON, .begun = true};
        gm_row_put(&row, "warning %s, evaluations %.0f, solves %.0f", warning,
                   gm_run_per_member(run, run->evaluations), gm_run_per_member(run, run->solves));
        if (gm_engine_of(drive->lane)) {
            gm_row_put(&row, "engine %s", gm_engine_of(drive->lane));
        }
        fputc('}', stream);
    }
    free(meta);
    return meta != NULL;
}

const char *gm_handle_written(geomint *handle, struct gm_text_stream *writing)
{
    free(handle->text);
    return handle->text = gm_stream_end(writing);
}

const char *geomint_text(geomint *handle)
{
    const size_t count = geomint_lanes(handle);
    if (count == 0) { /* a scheme's was made when it was opened */
        return handle ? handle->text : NULL;
    }
    const struct gm_call call = gm_call_begin(handle);
    struct gm_text_stream writing;
    FILE *stream = gm_stream_begin(&writing);
    bool good = stream != NULL;
    for (size_t i = 0; i < count && good; i++) {
        fputc(i > 0 ? ',' : '[', stream);
        good = put_lane(stream, &handle->lanes[i].drive);
    }
    if (stream) {
        fputc(']', stream);
    }
    good = gm_handle_written(handle, &writing) && good;
    gm_call_end(&call);
    return good ? handle->text : NULL;
}
