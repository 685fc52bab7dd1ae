/* SPDX-License-Identifier: GPL-3.0-or-later */
/* geomint render: pictures, frames and movies. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/drive.h"
#include "app/folder.h"
#include "app/provenance.h"
#include "render/canvas.h"
#include "render/sink.h"

/* When the frames are, in model time. */
struct schedule {
    long count;
    double first, last;
};

struct work {
    struct gm_request *request;
    const struct gm_options *options;
    struct gm_drive *drives;
    const struct gm_lane **lanes;
    struct gm_canvas *canvas;
    struct gm_picture *picture;
    struct gm_sink *sink;
    struct schedule schedule;
    bool still; /* one picture, not a sequence */
};

static double end_of(const struct gm_request *request)
{
    double end = -INFINITY;
    for (size_t i = 0; i < request->count; i++) {
        const struct gm_timing *timing = request->lanes[i].parameters;
        const double t0 = gm_scene_t0(request->scene, timing);
        end = fmax(end, t0 + (double)request->lanes[i].steps * timing->dt);
    }
    return end;
}

static bool make_schedule(struct schedule *schedule, bool *still, const struct gm_request *request,
                          const struct gm_options *options, char *message)
{
    const struct gm_timing *timing = request->lanes[0].parameters;
    const double end = end_of(request);
    const double first = isnan(options->from) ? gm_scene_t0(request->scene, timing) : options->from;
    *still = false;
    if (!isnan(options->at)) {
        *schedule = (struct schedule){1, options->at, options->at};
        *still = true;
        return true;
    }
    if (first > end) {
        snprintf(message, GM_MESSAGE, "--from %g lies after the end, t = %g", first, end);
        return false;
    }
    const bool paced = options->movie || !isnan(options->rate) || !isnan(options->fps);
    double count = 1;
    *schedule = (struct schedule){.first = first, .last = end};
    if (options->frames) {
        count = (double)options->frames;
    } else if (options->every) {
        const double interval = (double)options->every * timing->dt;
        count = floor((end - first) / interval * (1 + 1e-12) + 1e-9) + 1;
        schedule->last = first + (count - 1) * interval;
    } else if (paced) {
        const double fps = isnan(options->fps) ? 30 : options->fps;
        /* ten seconds, unless told otherwise */
        const double rate = isnan(options->rate) ? (end - first) / 10 : options->rate;
        count = rate > 0 ? fmax(1, round((end - first) * fps / rate)) + 1 : 2;
    } else {
        *still = true;
    }
    if (!(count <= 1e7)) {
        snprintf(message, GM_MESSAGE, "that makes %.3g frames; 1e7 is the most", count);
        return false;
    }
    schedule->count = (long)count;
    if (schedule->count == 1) {
        schedule->first = schedule->last;
    }
    return true;
}

static double frame_time(const struct schedule *schedule, long frame)
{
    if (frame + 1 >= schedule->count) {
        return schedule->last;
    }
    return schedule->first +
           (schedule->last - schedule->first) * (double)frame / (double)(schedule->count - 1);
}

static void show_progress(const struct schedule *schedule, long frame, double started)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const double elapsed = (double)now.tv_sec + 1e-9 * (double)now.tv_nsec - started;
    const double rate = (double)(frame + 1) / fmax(elapsed, 1e-9);
    enum { WIDTH = 30 };
    const int filled = (int)((double)WIDTH * (double)(frame + 1) / (double)schedule->count);
    char bar[WIDTH + 1];
    for (int i = 0; i < WIDTH; i++) {
        bar[i] = i < filled ? '#' : '.';
    }
    bar[WIDTH] = '\0';
    fprintf(stderr, "\r%s %ld/%ld frames, %.1f a second, %.0f s left  ", bar, frame + 1, schedule->count,
            rate, (double)(schedule->count - frame - 1) / rate);
}

static bool paint_frame(struct work *work, long frame, char *message)
{
    for (size_t i = 0; i < work->request->count; i++) {
        const long steps = work->request->lanes[i].steps;
        struct gm_drive *drive = &work->drives[i];
        long due = 0, before = -1;
        /* where the scheme chooses its step, one after the other until the time is reached */
        do {
            before = drive->lane->run->steps;
            due = gm_drive_step_at(drive, frame_time(&work->schedule, frame));
            if (!gm_drive_to(drive, due < steps ? due : steps, true, message)) {
                return false;
            }
        } while (drive->lane->scheme->family->own_time && drive->lane->run->steps > before);
    }
    if (gm_interrupted) {
        return true;
    }
    unsigned char *rgb = gm_sink_frame(work->sink);
    if (!rgb) {
        return true; /* the sink tells why when it is closed */
    }
    gm_picture_clear(work->picture);
    work->request->scene->draw(work->lanes, work->request->count, work->picture);
    char *steps = gm_provenance_steps(work->lanes, work->request->count);
    if (!steps || !gm_canvas_paint(work->canvas, work->picture, rgb)) {
        free(steps);
        snprintf(message, GM_MESSAGE, "not enough memory to paint");
        return false;
    }
    const struct gm_png_text text = {GM_KEY_STEPS, steps};
    gm_sink_put(work->sink, rgb, frame, &text, 1);
    free(steps);
    return true;
}

/* OUT/NAME.png or OUT/NAME-%06ld.png; a % of the name is doubled. */
static char *pattern_of(const char *out, const char *name, bool still)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    if (!stream) {
        return NULL;
    }
    for (const char *at = out; *at; at++) {
        fputs(*at == '%' ? "%%" : (char[]){*at, '\0'}, stream);
    }
    fprintf(stream, "/%s%s.png", name, still ? "" : "-%06ld");
    fclose(stream);
    return text;
}

static struct gm_sink *open_sink(const struct work *work, const char *name, char *message)
{
    const struct gm_options *options = work->options;
    struct gm_provenance provenance;
    if (!gm_provenance_make(&provenance, work->request, options->width, options->height, options->theme,
                            gm_canvas_backend(work->canvas))) {
        snprintf(message, GM_MESSAGE, "not enough memory");
        return NULL;
    }
    const struct gm_sink_settings settings = {
        .width = options->width,
        .height = options->height,
        .fps = isnan(options->fps) ? 30 : options->fps,
        .texts = provenance.texts,
        .text_count = provenance.count,
    };
    struct gm_sink *sink = NULL;
    if (options->movie) {
        sink = gm_sink_open_movie(options->movie, &settings, message);
    } else {
        const char *out = options->out ? options->out : ".";
        char *pattern = pattern_of(out, name, work->still);
        if (pattern && gm_folder_make(out, message)) {
            sink = gm_sink_open_png(pattern, &settings, message);
        }
        free(pattern);
    }
    gm_provenance_close(&provenance);
    return sink;
}

static bool open_lanes(struct work *work, char *message)
{
    const size_t count = work->request->count;
    work->drives = calloc(count, sizeof *work->drives);
    work->lanes = calloc(count, sizeof *work->lanes);
    work->picture = gm_picture_open();
    if (!work->drives || !work->lanes || !work->picture) {
        snprintf(message, GM_MESSAGE, "not enough memory");
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        struct gm_lane *lane = gm_request_open_lane(work->request, i, message);
        if (!lane) {
            return false;
        }
        work->drives[i] = (struct gm_drive){.lane = lane, .request = work->request, .index = i};
        work->lanes[i] = lane;
    }
    return true;
}

static void close_work(struct work *work)
{
    for (size_t i = 0; work->drives && i < work->request->count; i++) {
        gm_lane_close(work->drives[i].lane);
    }
    free(work->drives);
    free(work->lanes);
    gm_picture_close(work->picture);
    gm_canvas_close(work->canvas);
}

static void say_failures(const struct work *work)
{
    for (size_t i = 0; i < work->request->count; i++) {
        char sentence[GM_SENTENCE];
        gm_failure_sentence(work->lanes[i], sentence, sizeof sentence);
        if (sentence[0]) {
            gm_complain("%s: %s: %s", work->lanes[i]->scheme->name,
                        gm_status_name(work->lanes[i]->run->status), sentence);
        }
    }
}

static bool any_failed(const struct work *work)
{
    for (size_t i = 0; i < work->request->count; i++) {
        if (work->lanes[i]->run->status != GM_OK) {
            return true;
        }
    }
    return false;
}

static int paint_all(struct work *work, const char *name)
{
    char message[GM_MESSAGE];
    work->canvas = gm_canvas_open(work->options->width, work->options->height, work->options->theme, message);
    work->sink = work->canvas ? open_sink(work, name, message) : NULL;
    if (!work->sink) {
        gm_complain("%s", message);
        return GM_EXIT_FILE;
    }
    struct timespec start;
    clock_gettime(CLOCK_MONOTONIC, &start);
    const bool progress = !work->still && isatty(STDERR_FILENO);
    bool good = true;
    for (long frame = 0; frame < work->schedule.count && good && !gm_interrupted; frame++) {
        good = paint_frame(work, frame, message);
        if (progress) {
            show_progress(&work->schedule, frame, (double)start.tv_sec + 1e-9 * (double)start.tv_nsec);
        }
    }
    if (progress) {
        fputc('\n', stderr);
    }
    if (!good) {
        gm_complain("%s", message);
    }
    /* an interrupted movie is finished with the frames it has; only an error gives it up */
    if (!gm_sink_close(work->sink, good, message)) {
        gm_complain("%s", message);
        return GM_EXIT_FILE;
    }
    if (!good) {
        return GM_EXIT_FILE;
    }
    say_failures(work);
    if (gm_interrupted) {
        return GM_EXIT_INTERRUPTED;
    }
    return work->options->strict && any_failed(work) ? GM_EXIT_NUMERICAL : GM_EXIT_OK;
}

int gm_render(struct gm_request *request, const struct gm_options *options, const char *name)
{
    char message[GM_MESSAGE];
    struct work work = {.request = request, .options = options};
    int status = GM_EXIT_USAGE;
    if (!make_schedule(&work.schedule, &work.still, request, options, message) ||
        !open_lanes(&work, message)) {
        gm_complain("%s", message);
    } else {
        status = paint_all(&work, name);
    }
    close_work(&work);
    return status;
}

int gm_command_render(const struct gm_options *options)
{
    char message[GM_MESSAGE], name[128];
    struct gm_request request;
    if (!gm_request_parse(&request, options->word_count, options->words, 3, message)) {
        gm_complain("%s", message);
        return GM_EXIT_USAGE;
    }
    gm_catch_interrupts();
    snprintf(name, sizeof name, "%s-render", request.scene->name);
    const int status = gm_render(&request, options, name);
    gm_request_close(&request);
    return gm_finish(status);
}
